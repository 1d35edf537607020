"""Parallels of outlines: clearance, kerf and tool paths (`moved`), rounded edges (`rounded`).

Both follow a disc that rolls along the outline (see `rolled`). A parallel is the path of its
centre; rounding takes the points that it touches, and an arc of the disc where it touches two
points at once. The results are true parallels of the curve, not of a polygon.

Distances that leave no simple outline are refused; `sized` names the largest found to leave one.

Depends on numeric; shapely inside the functions.
"""

from __future__ import annotations

from collections.abc import Callable, Sequence
from dataclasses import replace
from typing import Any, Final, TypeVar

import numpy as np

from gearcam.base.adjustments import Adjustment
from gearcam.base.errors import InfeasibleError
from gearcam.base.numerals import formatted, rounded_down
from gearcam.numeric.arrays import Mask, Plane, as_complex, as_pairs
from gearcam.numeric.contour import Contour, Run
from gearcam.numeric.hermite import on_cubics
from gearcam.parts.rolled import arc_run, roll, too_far

_Made = TypeVar("_Made")

_DEPTH: Final = 2.0
"""A point is lost if the outline is nearer than the distance by this many chord errors."""

_GRAZE: Final = 1e-9
"""The same in radii of the disc, for outlines without chord error: rounding."""

_VERTICES: Final = 0.95
"""Share of the tolerance for the polygon's chords; the rest is for the dense points."""

_GRAIN: Final = 1e-3
"""Length in tolerances below which a stretch counts as a point, and a parallel as the outline."""

_TURN: Final = 1e-6
"""Change of the tangent, rad, that makes a corner: far above rounding."""

_PLACES: Final = 65
"""Points on each run at which it is tested that a parallel follows it."""

_HALVINGS: Final = 8
"""Bisections of the range of sizes for a refusal."""


def moved(contour: Contour, by: float) -> Contour:
    """Return the parallel of a contour.

    Parameters
    ----------
    contour : Contour
        The outline.
    by : float, mm
        Distance, outwards positive. Corners that open to this side become arcs.

    Returns
    -------
    Contour
        With the same tolerance.

    Raises
    ------
    InfeasibleError
        If no simple outline is left.
    """
    if abs(by) <= _GRAIN * contour.tolerance:
        return contour
    runs = [part.parallel for part, _, _ in roll(contour, by)]
    return _contour(runs, contour, by)


def followed(contour: Contour, by: float) -> Contour:
    """Return a parallel that follows every run of a contour.

    Parameters
    ----------
    contour : Contour
        The outline.
    by : float, mm
        As for `moved`.

    Returns
    -------
    Contour
        With the same tolerance.

    Raises
    ------
    InfeasibleError
        If no simple outline is left, or one that skips a run, such as a keyway's wall.
    """
    made = moved(contour, by)
    for run in contour.runs:
        p, t = run.points, run.tangents
        at = np.linspace(0.0, len(p) - 1.0, _PLACES)
        step = np.minimum(at.astype(np.int64), len(p) - 2)
        points, tangents = on_cubics(p, t, step, at - step)
        if not touches(contour, points, -1j * tangents, by).any():
            raise too_far(contour, by)
    return made


def rounded(contour: Contour, radius: float) -> Contour:
    """Return a contour whose outer edges are rounded.

    Parameters
    ----------
    contour : Contour
        The outline.
    radius : float, mm
        Radius of the rounding.

    Returns
    -------
    Contour
        With arcs of that radius, tangent on both sides, at every convex corner.

    Raises
    ------
    InfeasibleError
        If the radius leaves no simple outline.
    """
    if radius == 0.0:
        return contour
    runs: list[Run] = []
    for one, two, center in roll(contour, -radius):
        if one.corner is None:
            runs.append(one.as_run(0.0))
        if center is not None:
            start, end = one.touched(one.high) - center, two.touched(two.low) - center
            normals = start / abs(start), end / abs(end)
            runs.append(arc_run(center, radius, *normals, contour.tolerance))
    return _contour(runs, contour, -radius)


def sized(make: Callable[[float], _Made], size: float, where: str, what: str) -> _Made:
    """Return what `make` gives for a size.

    Parameters
    ----------
    make : callable
        ``make(size)`` returns `moved` or `rounded` of some contour, or what is made of them.
    size : float, mm
        Given size.
    where : str
        Its key, after the part and a comma if there is a part.
    what : str
        Its name in words.

    Returns
    -------
    Contour, or what else `make` gives

    Raises
    ------
    InfeasibleError
        If the size leaves no simple outline, with a size that does.
    """
    try:
        return make(size)
    except InfeasibleError:
        low, high = 0.0, size
        for _ in range(_HALVINGS):
            middle = 0.5 * (low + high)
            try:
                make(tried := float(rounded_down(middle, 3)))
            except InfeasibleError:
                high = middle
            else:
                low = tried
        key = where.rpartition(", ")[2]
        note = f"a {what} of {formatted(low, 3)} mm leaves one" if low else "leave it out"
        adjustments = (Adjustment(near={key: low} if low else {}, far={key: 0.0}),)
        what = f"this {what} leaves no simple outline"
        raise InfeasibleError(
            what, where=where, value=size, unit="mm", nearest=note, adjustments=adjustments
        ) from None


def _contour(runs: Sequence[Run], old: Contour, by: float) -> Contour:
    """Return the contour of runs, within the tolerance, verified not to cross itself."""
    from shapely import LinearRing, get_coordinates, linestrings, simplify

    real = _joined([piece for run in runs for piece in _cut(run, _GRAIN * old.tolerance)])
    lines: Any = np.array([linestrings(as_pairs(run.points)) for run in real])
    thinned: Any = simplify(lines, _VERTICES * old.tolerance, preserve_topology=False)
    vertices = np.vstack([get_coordinates(line)[:-1] for line in thinned])
    contour = Contour(
        dense=lambda: tuple(real),
        points=as_complex(vertices),
        tolerance=old.tolerance,
        chord_error=_VERTICES * old.tolerance,
    )
    ring: Any = LinearRing(vertices)
    if not ring.is_simple or contour.area <= 0.0:
        raise too_far(old, by)
    return contour


def _cut(run: Run, grain: float) -> list[Run]:
    """Return the pieces of a run between corners, to which arcs of the disc's radius have shrunk.

    A stretch shorter than a `grain`, mm, is a point, and a corner if the tangent turns in it.
    """
    steps = np.abs(np.diff(run.points))
    groups = np.append(0, np.flatnonzero(np.diff(steps > grain)) + 1)
    long = np.add.reduceat(steps, groups) > grain
    kept = np.repeat(long, np.diff(np.append(groups, len(steps))))
    ends = np.flatnonzero(np.diff(np.concatenate([[0], kept, [0]])))
    if not ends.size:
        return []
    low, high, tangents = ends[::2], ends[1::2], run.tangents
    corner = np.abs(np.angle(tangents[low[1:]] * np.conj(tangents[high[:-1]]))) > _TURN
    low, high = low[np.append(True, corner)], high[np.append(corner, True)]
    pieces = []
    for first, last in zip(low.tolist(), high.tolist(), strict=True):
        taken = slice(first, last + 1)
        inside = tuple(joint - first for joint in run.joints if first < joint < last)
        pieces.append(Run(points=run.points[taken], tangents=run.tangents[taken], joints=inside))
    return pieces


def _joined(pieces: Sequence[Run]) -> list[Run]:
    """Return the pieces with ends joined exactly, instead of to within a grain."""
    ends = [piece.points[-1:] for piece in (*pieces[-1:], *pieces[:-1])]
    return [
        replace(piece, points=np.concatenate([end, piece.points[1:]]))
        for piece, end in zip(pieces, ends, strict=True)
    ]


def touches(contour: Contour, points: Plane, normals: Plane, by: float) -> Mask:
    """Return at which of its points a disc can touch an outline.

    Parameters
    ----------
    contour : Contour
        The outline.
    points, normals : (n,) complex arrays
        Points on it, mm, and outward unit normals there.
    by : float, mm
        Radius of the disc, outside positive.

    Returns
    -------
    (n,) bool array
        False where the outline is nearer to the disc's centre than its radius, by more than the
        polygon's chord error.
    """
    from shapely import STRtree, linestrings
    from shapely import points as made_points

    room = abs(by) - _DEPTH * max(contour.chord_error, _GRAZE * abs(by))
    free = np.ones(len(points), dtype=bool)
    if room <= 0.0:
        return free
    ring = contour.vertices
    segments: Any = linestrings(np.stack([ring, np.roll(ring, -1, axis=0)], axis=1))
    tree = STRtree(segments)
    middles = made_points(as_pairs(points + by * normals))
    free[tree.query(middles, predicate="dwithin", distance=room)[0]] = False
    return free
