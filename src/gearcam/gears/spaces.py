"""The chain of curves around a wheel, space by space, with loops taken out.

Between two teeth run five curves: flank, fillet, root land, fillet, flank; over a tooth runs the
tip. Where nothing is undercut they join smoothly. An undercut flank crosses its fillet, sharp
roots let fillets cross each other, a root curvature below the dedendum makes the land cross
itself: then the chain has loops, which the cutter has swept away. `untangle` finds each crossing
on the true curves and takes the loop out.
"""

from __future__ import annotations

from dataclasses import dataclass, replace

import numpy as np
from numpy.typing import NDArray

from gearcam.gears.flank import Curve, Rows, Toothing, trace
from gearcam.gears.tips import TipEnds
from gearcam.gears.undercut import Undercut
from gearcam.numeric.arrays import Plane

Array = NDArray[np.float64]
Index = NDArray[np.int64]

ROWS_PER_TOOTH = 6
_TOUCH = 1e-9
"""Length of a loop over the length of its space below which it is none."""

_SAMPLES = 49
_CELLS = 16
_LEVELS = 8
"""Each level narrows a crossing 8 times and interpolates in it; eight reach rounding."""


@dataclass(frozen=True, kw_only=True)
class Crossing:
    """Two curves that cross.

    Parameters
    ----------
    before, after : int
        Rows that are left and entered.
    leaves, enters : float, rad
        Driver angle of the crossing on each.
    """

    before: int
    leaves: float
    after: int
    enters: float


def regular_rows(toothing: Toothing, tips: TipEnds) -> Rows:
    """Return the rows of a wheel as if nothing were undercut: five a space and one a tip.

    Parameters
    ----------
    toothing : Toothing
        The wheel.
    tips : TipEnds
        Ends of its flanks: the sigma = +1 flanks of all teeth, then the sigma = -1 flanks.

    Returns
    -------
    Rows
        Row ``6*j + k`` is curve k of the space after the tooth formed as number j; k = 5 is the
        tip of the tooth after it.
    """
    cutter, z, places = toothing.cutter, len(toothing.numbers), toothing.tooth_places
    half = toothing.half_tooth
    # Flank and tip ends are known for all teeth; a closed wheel's last space ends at its first
    # tooth, one turn on, an open one's at its last tooth.
    following, count = np.append(np.arange(1, z), 0), z
    wrap, around = np.zeros(z), np.zeros(z)
    if toothing.closed:
        wrap[-1] = toothing.track.around
        around[-1] = toothing.length
    else:
        following, wrap, around, count = following[:-1], wrap[:-1], around[:-1], z - 1
    plus = places[:count] + half
    minus = places[following] + around - half
    joints = toothing.track.angle(
        np.stack(
            [
                plus + cutter.reach,
                plus + cutter.offset,
                minus - cutter.offset,
                minus - cutter.reach,
            ]
        )
    )
    top_plus = tips.phi[:count]
    top_minus = tips.phi[z + following] + wrap
    tip_start, tip_end = tips.foot[z + following] + wrap, tips.foot[following] + wrap
    zero, one = np.zeros(count), np.ones(count)
    land = np.full(count, -cutter.dedendum)
    number = np.array(toothing.numbers)
    table = {
        "kind": [Curve.FLANK, Curve.FILLET, Curve.LAND, Curve.FILLET, Curve.FLANK, Curve.TIP],
        "sf": [plus, plus, zero, minus, minus, zero],
        "sigma": [one, one, zero, -one, -one, zero],
        "start": [top_plus, joints[0], joints[1], joints[2], joints[3], tip_start],
        "end": [joints[0], joints[1], joints[2], joints[3], top_minus, tip_end],
        "low": [zero, zero, land, zero, zero, tips.height[z + following]],
        "high": [zero, zero, land, zero, zero, tips.height[following]],
        "corner": [True, False, False, False, False, True],
        "tooth": [*[number[:count]] * 3, *[number[following]] * 3],
    }
    columns = {
        name: np.stack([np.broadcast_to(value, count) for value in values], axis=1).ravel()
        for name, values in table.items()
    }
    return Rows(**columns)


def entangled(toothing: Toothing, rows: Rows, cusps: Undercut) -> Index:
    """Return the spaces (from 0) whose chain of curves may have loops.

    Parameters
    ----------
    toothing : Toothing
        The wheel.
    rows : Rows
        From `regular_rows`.
    cusps : Undercut
        Cusps of the sigma = +1 flanks, then of the sigma = -1 flanks.

    Returns
    -------
    (k,) int array
        Spaces with an undercut flank, with a root sharper than the dedendum, or without a land.
    """
    z = len(toothing.numbers)
    undercut = np.isfinite(cusps.dedendum)
    loops = undercut[:z] | np.roll(undercut[z:], -1)
    loops = loops if toothing.closed else loops[:-1]
    kappa = toothing.track.curvature_extremes[1]
    if kappa.max() * toothing.cutter.dedendum >= 0.9:
        start, end = rows.start[1::ROWS_PER_TOOTH], rows.end[3::ROWS_PER_TOOTH]
        steps = start + (end - start) * np.linspace(0.0, 1.0, 65)[:, None]
        sharp = toothing.frames(steps).kappa * toothing.cutter.dedendum >= 0.9
        loops = loops | sharp.any(axis=0)
    return np.flatnonzero(loops)


def untangle(toothing: Toothing, rows: Rows, spaces: Index) -> list[tuple[Rows, list[Crossing]]]:
    """Take the loops out of spaces.

    Parameters
    ----------
    toothing : Toothing
        The wheel.
    rows : Rows
        From `regular_rows`.
    spaces : (k,) int array
        Which spaces, from 0.

    Returns
    -------
    list of (Rows, list of Crossing)
        For each space the curves that are left, with the tip behind them, and the crossings found,
        in order; none where the chain has no loop.
    """
    phi, index = _sample(rows, spaces)
    points, _ = trace(toothing, rows, index.ravel(), phi.ravel())
    found: list[tuple[int, float, float]] = []
    for number, chain in enumerate(points.reshape(phi.shape)):
        found += [(number, before, after) for before, after in _walk(chain)]
    crossings: list[list[Crossing]] = [[] for _ in spaces]
    if found:
        number, *places = np.array(found).T
        number = number.astype(np.int64)
        ends = [_bracket(rows, index[number], phi[number], place) for place in places]
        refined = _refine(toothing, rows, *ends)
        for k, crossing in zip(number, refined, strict=True):
            crossings[k].append(crossing)
    return [
        (_cut(rows, int(space), chain), chain)
        for space, chain in zip(spaces, crossings, strict=True)
    ]


def _cut(rows: Rows, space: int, crossings: list[Crossing]) -> Rows:
    """Return the rows of a space, changing over at each crossing."""
    row = ROWS_PER_TOOTH * space
    last = row + ROWS_PER_TOOTH - 1
    start, after_corner = float(rows.start[row]), True
    pieces: list[tuple[int, float, float, bool]] = []

    def travel(stop: int, leaves: float) -> None:
        for number in range(row, stop + 1):
            begin = start if number == row else float(rows.start[number])
            finish = leaves if number == stop else float(rows.end[number])
            corner = after_corner if number == row else bool(rows.corner[number])
            pieces.append((number, begin, finish, corner))

    for crossing in crossings:
        travel(crossing.before, crossing.leaves)
        row, start = crossing.after, crossing.enters
    travel(last, float(rows.end[last]))
    number, begin, end, corner = (np.array(column) for column in zip(*pieces, strict=True))
    return replace(select(rows, number), start=begin, end=end, corner=corner)


def select(rows: Rows, index: Index) -> Rows:
    """Return some rows, in the order of `index`."""
    return Rows(**{name: getattr(rows, name)[index] for name in Rows.__dataclass_fields__})


def join(parts: list[Rows]) -> Rows:
    """Return rows one after the other."""
    return Rows(
        **{
            name: np.concatenate([getattr(part, name) for part in parts])
            for name in Rows.__dataclass_fields__
        }
    )


def _sample(rows: Rows, spaces: Index) -> tuple[Array, Index]:
    """Sample the five curves of spaces, ever denser towards the joints, where loops can be tiny.

    Returns driver angles and row numbers, a space a line.
    """
    t = np.linspace(0.0, 1.0, _SAMPLES)
    towards_start, towards_end = t**3, 1.0 - (1.0 - t) ** 3
    grading = [towards_end, towards_start[1:], t[1:], towards_end[1:], towards_start[1:]]
    curve = np.concatenate([np.full(len(values), k) for k, values in enumerate(grading)])
    index = ROWS_PER_TOOTH * spaces[:, None] + curve
    return rows.start[index] + (rows.end - rows.start)[index] * np.concatenate(grading), index


def _bracket(rows: Rows, index: Index, phi: Array, place: Array) -> tuple[Index, Array, Array]:
    """Row, and driver angles around places on sampled chains (one a line of samples)."""
    line, segment = np.arange(len(place)), np.floor(place).astype(np.int64)
    segment = np.minimum(segment, phi.shape[1] - 2)
    row = index[line, segment + 1]
    low = np.where(index[line, segment] == row, phi[line, segment], rows.start[row])
    step = phi[line, segment + 1] - low
    middle = low + (place - segment) * step
    return row, middle - 0.25 * step, middle + 0.25 * step


def _side(p: Plane, q: Plane, x: Plane) -> Array:
    return np.imag(np.conj(q - p) * (x - p))


def _cross(a: Plane, b: Plane, c: Plane, d: Plane) -> NDArray[np.bool_]:
    """Whether segments a-b and c-d cross or touch."""
    return (_side(a, b, c) * _side(a, b, d) <= 0.0) & (_side(c, d, a) * _side(c, d, b) <= 0.0)


def _crossing_segments(points: Plane, others: Plane) -> tuple[Index, Index]:
    """Segments of one polyline that cross segments of another: numbers of both."""

    def boxes(chain: Plane) -> list[Array]:
        pairs = [np.stack([v[:-1], v[1:]]) for v in (chain.real, chain.imag)]
        return [pairs[0].min(0), pairs[0].max(0), pairs[1].min(0), pairs[1].max(0)]

    left, right, low, high = (v[:, None] for v in boxes(points))
    left2, right2, low2, high2 = boxes(others)
    near = (left <= right2) & (left2 <= right) & (low <= high2) & (low2 <= high)
    i, j = np.nonzero(near)
    hit = _cross(points[i], points[i + 1], others[j], others[j + 1])
    hit &= (points[i] != points[i + 1]) & (others[j] != others[j + 1])
    return i[hit], j[hit]


def _walk(points: Plane) -> list[tuple[float, float]]:
    """Walk a polyline from its start and leave it at each crossing for its later branch.

    Returns the places of leaving and entering: segment number and share of it.
    """
    i, j = _crossing_segments(points, points)
    first, second = _chord_crossing(points[i], points[i + 1], points[j], points[j + 1])
    leaves, enters = i + np.clip(first, 0.0, 1.0), j + np.clip(second, 0.0, 1.0)
    along = np.concatenate([[0.0], np.cumsum(np.abs(np.diff(points)))])
    # Where a land has no length its neighbours touch, and that is no loop.
    later = (j > i + 1) & (along[j] - along[np.minimum(i + 1, j)] > _TOUCH * along[-1])
    leaves, enters = leaves[later], enters[later]
    result, position = [], -1.0
    while (leaves > position).any():
        ahead = np.flatnonzero(leaves > position)
        next_one = ahead[leaves[ahead].argmin()]
        result.append((float(leaves[next_one]), float(enters[next_one])))
        position = enters[next_one]
    return result


def _refine(
    toothing: Toothing,
    rows: Rows,
    one: tuple[Index, Array, Array],
    other: tuple[Index, Array, Array],
) -> list[Crossing]:
    """Narrow crossings on the true curves: (row, low, high) of both.

    The cell in which the chords cross is kept with its neighbours, since the curves may cross just
    beside it; where they do not cross at all inside, the brackets are widened again.
    """
    row = np.stack([one[0], other[0]])
    low, high = np.stack([one[1], other[1]]), np.stack([one[2], other[2]])
    ends = np.sort(np.stack([rows.start[row], rows.end[row]]), axis=0)
    middle = 0.5 * (low + high)
    for _ in range(_LEVELS):
        step = (high - low) / _CELLS
        grid = np.clip(
            low[..., None] + step[..., None] * np.arange(-1, _CELLS + 2),
            ends[0][..., None],
            ends[1][..., None],
        )
        index = np.broadcast_to(row[..., None], grid.shape)
        a, b = trace(toothing, rows, index.ravel(), grid.ravel())[0].reshape(grid.shape)
        a, b = a[:, :, None], b[:, None, :]
        hit = _cross(a[:, :-1], a[:, 1:], b[:, :, :-1], b[:, :, 1:])
        hit &= (a[:, :-1] != a[:, 1:]) & (b[:, :, :-1] != b[:, :, 1:])
        found = hit.any(axis=(1, 2))
        first = hit.reshape(len(hit), -1).argmax(axis=1)
        cell = np.stack(np.divmod(first, grid.shape[2] - 1))
        near = np.take_along_axis(grid, cell[..., None], axis=2)[..., 0]
        far = np.take_along_axis(grid, cell[..., None] + 1, axis=2)[..., 0]
        corners = [
            np.take_along_axis(curve.reshape(len(hit), -1), (c + k)[:, None], axis=1)[:, 0]
            for curve, c in ((a, cell[0]), (b, cell[1]))
            for k in (0, 1)
        ]
        share = np.clip(np.stack(_chord_crossing(*corners)), 0.0, 1.0)
        middle = np.where(found, near + share * (far - near), middle)
        low = np.where(found, near - 0.5 * step, low - 4.0 * step)
        high = np.where(found, far + 0.5 * step, high + 4.0 * step)
    return [
        Crossing(before=int(r[0]), leaves=float(m[0]), after=int(r[1]), enters=float(m[1]))
        for r, m in zip(row.T, middle.T, strict=True)
    ]


def _chord_crossing(a: Plane, b: Plane, c: Plane, d: Plane) -> tuple[Array, Array]:
    """Where the lines a-b and c-d cross, as shares of both."""
    area = np.imag(np.conj(b - a) * (d - c))
    with np.errstate(divide="ignore", invalid="ignore"):
        first = np.imag(np.conj(c - a) * (d - c)) / area
        second = np.imag(np.conj(c - a) * (b - a)) / area
    return np.nan_to_num(first, nan=0.5), np.nan_to_num(second, nan=0.5)
