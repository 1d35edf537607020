"""Parallels of outlines: kerf and clearance (`moved`), rounded edges (`rounded`).

Both follow a disc that rolls along the outline (see `rolled`). Moving takes the way of its middle;
rounding takes what it touches, and an arc of the disc wherever it touches two places at once. The
results are true parallels of the curve, not those of a polygon.

Refused: distances that leave no simple outline.

Depends on numeric; shapely inside the functions.
"""

from __future__ import annotations

from collections.abc import Sequence
from typing import Any, Final

import numpy as np
from numpy.typing import NDArray

from gearcam.numeric.bulges import Complex, as_pairs
from gearcam.numeric.contour import Contour, Run
from gearcam.parts.rolled import Stretch, arc_run, roll, too_far

Array = NDArray[np.float64]
Mask = NDArray[np.bool_]

_DEPTH: Final = 2.0
"""A place is lost where the outline comes nearer than the distance by this many chord errors."""

_VERTICES: Final = 0.95
"""Part of the tolerance that the polygon's chords may take; the rest covers the dense points."""

_POINT: Final = 1e-9
"""Length in tolerances below which a stretch is a point."""


def moved(contour: Contour, by: float) -> Contour:
    """Return the parallel of a contour.

    Parameters
    ----------
    contour : Contour
        The outline.
    by : float, mm
        How far, outwards positive. Corners on the opening side become arcs.

    Returns
    -------
    Contour
        With the same tolerance.

    Raises
    ------
    InfeasibleError
        If no simple outline is left.
    """
    if by == 0.0:
        return contour
    runs = [stretch.as_run(stretch.by) for stretch, _, _ in roll(contour, by).pairs]
    return _contour(runs, contour, by)


def rounded(contour: Contour, radius: float) -> Contour:
    """Return a contour whose outer edges are rounded.

    Parameters
    ----------
    contour : Contour
        The outline.
    radius : float, mm
        Of the rounding.

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
    for one, two, center in roll(contour, -radius).pairs:
        if one.corner is None:
            runs.append(one.as_run(0.0))
        if center is not None:
            start, end = (place - center for place in _ends(one, two))
            normals = start / abs(start), end / abs(end)
            runs.append(arc_run(center, radius, *normals, contour.tolerance))
    return _contour(runs, contour, -radius)


def _ends(one: Stretch, two: Stretch) -> tuple[complex, complex]:
    return one.touched(one.high), two.touched(two.low)


def _contour(runs: Sequence[Run], old: Contour, by: float) -> Contour:
    """Put runs together, drawn within the tolerance, and prove that they do not cross."""
    from shapely import LinearRing, get_coordinates, linestrings, simplify

    real = [run for run in runs if float(np.ptp(run.points, axis=0).max()) > _POINT * old.tolerance]
    lines: Any = np.array([linestrings(run.points) for run in real])
    thinned: Any = simplify(lines, _VERTICES * old.tolerance, preserve_topology=False)
    vertices = np.vstack([get_coordinates(line)[:-1] for line in thinned])
    contour = Contour(
        dense=lambda: tuple(real),
        vertices=vertices,
        tolerance=old.tolerance,
        chord_error=_VERTICES * old.tolerance,
    )
    ring: Any = LinearRing(vertices)
    if not ring.is_simple or contour.area <= 0.0:
        raise too_far(old, by)
    return contour


def touches(contour: Contour, points: Complex, normals: Complex, by: float) -> Mask:
    """Return whether a disc can touch an outline at some of its points.

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
        False where the outline comes nearer to the disc's middle than its radius, by more than the
        polygon's chords explain.
    """
    from shapely import STRtree, linestrings
    from shapely import points as made_points

    room = abs(by) - _DEPTH * max(contour.chord_error, 1e-9 * abs(by))
    free = np.ones(len(points), dtype=bool)
    if room <= 0.0:
        return free
    ring = contour.vertices
    segments: Any = linestrings(np.stack([ring, np.roll(ring, -1, axis=0)], axis=1))
    tree = STRtree(segments)
    middles = made_points(as_pairs(points + by * normals))
    free[tree.query(middles, predicate="dwithin", distance=room)[0]] = False
    return free
