"""Cross-checks of a mechanism: its tables by definition, its derivatives by integrals.

No formula of a dyad is used: members have their lengths, slides are on their guides, angles between
members are those of the file, shafts turn as the pair or the cam itself says.
"""

from __future__ import annotations

import cmath
from collections.abc import Iterator
from typing import Any, Final

import numpy as np

from gearcam.kinds.mechanism.parts import DyadSpec
from gearcam.kinds.mechanism.result import MechanismResult
from gearcam.linkages.linkage import value
from gearcam.linkages.measures import TrackMeasures
from gearcam.numeric.arrays import Array

_ANGLES: Final = 11
"""Number of the master's angles at which lengths and angles are compared."""

_EXACT: Final = 1e-9
"""Allowed difference, relative to the size of the machine."""

_HALF: Final = 1e-3
"""Half the range over which derivatives are integrated, rad."""

_SMOOTH: Final = 1e-6
"""Allowed difference of an integral, relative to the derivative's size."""

_DENSE: Final = 4001
"""Number of the master's angles among which extremes are looked for."""

_TURNS: Final = 13.0
"""Longest range of the master in which dwells are looked for by steps, rad."""

_GAUSS: Final = np.polynomial.legendre.leggauss(6)

_CHANGED: Final = 1e-5
"""The same next to places where a dyad is nearly singular and positions are less exact."""

Doubts = Iterator[tuple[str, str]]


def doubts(result: MechanismResult) -> Doubts:
    """Yield places where a mechanism is not what its tables say.

    Parameters
    ----------
    result : MechanismResult
        The result to check.

    Yields
    ------
    place, words : str
        Place and description of a contradiction.
    """
    yield from _drives(result)
    yield from _members(result)
    yield from _returns(result)
    yield from _outputs(result)
    yield from _asked(result)


def _angles(result: MechanismResult) -> Array:
    low, high = result.linkage.span
    return low + (high - low) * (np.arange(float(_ANGLES)) + 0.371) / _ANGLES


# --- drives and members -------------------------------------------------------------------------


def _drives(result: MechanismResult) -> Doubts:
    """Compare the shafts with the motion that the pair and the cam give by themselves."""
    q = _angles(result)
    for number, drive in enumerate(result.drives):
        spec, name = drive.spec, drive.spec.name
        own = spec.ratio * q + spec.phase if number else q
        mirrored = -1.0 if spec.mirror else 1.0
        wanted: dict[str, Array] = {}
        if spec.pair is not None:
            wanted = _of_pair(drive.result, own, mirrored)
        elif spec.cam is not None:
            places = drive.own(q) if spec.slide is not None else own
            wanted = _of_cam(drive.result, places, mirrored)
        elif spec.even:
            wanted = {"shaft": mirrored * own}
        for word, values in wanted.items():
            found = np.asarray(value(result.linkage.at(q, 0), f"{name}.{word}").c[0])
            yield from _compared("drive", f"{name}.{word}", found, values, result)


def _of_pair(result: Any, own: Array, mirrored: float) -> dict[str, Array]:
    driven = result.motion(own)
    if "travel_mm" in driven:
        return {"wheel1": -mirrored * own, "rack": -driven["travel_mm"]}
    side = -mirrored if result.pair.internal else mirrored
    return {"wheel1": -mirrored * own, "wheel2": side * np.radians(driven["phi2_deg"])}


def _of_cam(result: Any, own: Array, mirrored: float) -> dict[str, Array]:
    moved = result.motion(own)
    if "turret_deg" in moved:
        return {"turret": -mirrored * np.radians(moved["turret_deg"])}
    if "lift_mm" in moved:
        return {"follower": moved["lift_mm"]}
    del mirrored  # in which sense a follower swings is seen by its distance from the cam
    return {}


def _compared(
    place: str, name: str, found: Array, wanted: Array, result: MechanismResult
) -> Doubts:
    off = float(np.abs(found - wanted).max())
    size = _size(result) + float(np.abs(wanted).max())
    if not off <= _EXACT * size:
        yield place, f"{name} is off by {off}"


def _size(result: MechanismResult) -> float:
    known = result.linkage.at(result.linkage.knots[:1], 0)
    ends = [abs(_at(known, one.joint)[0]) for one in result.design.dyad]
    return 1.0 + max(ends, default=0.0)


def _at(known: Any, name: str) -> Array:
    return np.asarray(value(known, name).c[0]) + 0j * known.q


def _frame(known: Any, name: str) -> tuple[Array, Array]:
    frame = known.frame(name)
    return tuple(np.asarray(one.c[0]) + 0j * known.q for one in frame)  # pyright: ignore[reportReturnType]


def _members(result: MechanismResult) -> Doubts:
    """Check lengths, guides and angles of all dyads, and the branches."""
    q = _angles(result)
    known = result.linkage.at(q, 0)
    changes = {one.joint: one.changes for one in result.linkage.dyads}
    room = _EXACT * _size(result)
    for spec in result.design.dyad:
        allowed = _CHANGED * _size(result) if changes[spec.joint] else room
        for what, off in _misses(known, spec):
            worst = float(np.abs(off).max())
            if not worst <= allowed:
                yield "member", f"{spec.joint}: {what} is off by {worst}"
        if spec.near is None and not changes[spec.joint]:
            yield from _branch(known, spec)


def _misses(known: Any, spec: DyadSpec) -> Iterator[tuple[str, Array]]:
    """Yield by how much a dyad misses what its table says, mm or rad."""
    joint = _at(known, spec.joint)
    lengths = [np.full(known.q.shape, one) for one in spec.lengths]
    if spec.driven is not None:
        lengths[0] = lengths[0] + np.real(_at(known, spec.driven))
    frames = [_frame(known, name) for name in spec.members]
    for k, (name, kind) in enumerate(zip((spec.first, spec.last), spec.formula[::2], strict=False)):
        origin, way = frames[k]
        guided = kind == "T" if len(spec.formula) == 3 else False
        if guided:
            start, along = _frame(known, name)
            yield f"the guide {name}", np.imag((origin - start) / along)
            turn = cmath.exp(1j * spec.gammas[k])
            yield f"the angle of {spec.members[k]}", np.abs(way - along * turn)
        else:
            yield f"the joint {name}", np.abs(origin - _at(known, name))
        local = (joint - origin) / way
        if _slides(spec, k):
            yield f"the slide on {spec.members[k]}", np.imag(local)
        else:
            yield f"the length of {spec.members[k]}", np.abs(local - lengths[k])
    if spec.type in ("RTR", "RTT", "TTR"):
        between = frames[1][1] / frames[0][1]
        yield "beta_deg", np.abs(between - cmath.exp(1j * spec.beta))


def _slides(spec: DyadSpec, k: int) -> bool:
    """Return whether the joint slides along member `k`."""
    if spec.type == "RTR":
        return spec.slide_on == k + 1
    return (spec.type, k) in (("RTT", 1), ("TTR", 0))


def _branch(known: Any, spec: DyadSpec) -> Doubts:
    joint = _at(known, spec.joint)
    if not spec.branches:
        return
    sign = -1.0 if spec.branch in ("right", "behind") else 1.0
    if spec.type in ("RRR", "RTRR"):
        one, two = _at(known, spec.first), _at(known, spec.last)
        ahead = np.imag((joint - one) / (two - one))
    elif spec.type == "RTR":
        k = spec.slide_on - 1
        origin, way = _frame(known, spec.members[k])
        foot = _at(known, (spec.last, spec.first)[k])
        ahead = np.real((foot - origin) / way)
    else:
        k = 0 if spec.type == "RRT" else 1
        foot = _at(known, (spec.first, spec.last)[k])
        ahead = np.real((joint - foot) / _frame(known, (spec.last, spec.first)[k])[1])
    if not np.all(sign * ahead >= 0.0):
        yield "branch", f"{spec.joint} is not {spec.branch or spec.branches[0]}"


def _returns(result: MechanismResult) -> Doubts:
    """Check that all is back where it began after a cycle."""
    linkage = result.linkage
    if not linkage.closed:
        return
    first, last = (linkage.at(linkage.knots[[k]], 0) for k in (0, -1))
    joints = [one.joint for one in (*result.design.dyad, *result.design.crank)]
    for name in joints:
        off = abs(_at(first, name)[0] - _at(last, name)[0])
        if not off <= 1e-6 * _size(result):
            yield "cycle", f"{name} is {off} mm off after a cycle"


# --- outputs ------------------------------------------------------------------------------------


def _outputs(result: MechanismResult) -> Doubts:
    q = _inner(result)
    table = result.motion(q)
    for name in dict.fromkeys(one.name for one in result.outputs):
        own = result.output(name, q)
        for key in own:
            if not np.array_equal(own[key], table[key]):
                yield "motion", f"{key} of motion.csv is not that of the output"
    for one in result.outputs:
        yield from _integrated(result, one, q)
        yield from _extremes(result, one)


def _inner(result: MechanismResult) -> Array:
    """Return angles of the master that are not next to a knot."""
    q, knots = _angles(result), result.linkage.knots
    away = np.abs(q[:, None] - knots).min(axis=1) > 2.0 * _HALF
    return q[away]


def _integrated(result: MechanismResult, one: Any, q: Array) -> Doubts:
    """Compare differences of an output and its derivatives with integrals of the next one."""
    if not q.size:
        return
    nodes, weights = _GAUSS
    track = result.track(one)
    ends = [track(q + side, 3).derivatives() for side in (-_HALF, _HALF)]
    inner = track((q[:, None] + _HALF * nodes).ravel(), 3).derivatives()
    for order in (1, 2, 3):
        rates = (np.asarray(inner[order]) + 0.0 * inner[0]).reshape(q.size, -1)
        way = np.asarray(ends[1][order - 1]) - np.asarray(ends[0][order - 1])
        off = np.abs(_HALF * rates @ weights - way) / (2.0 * _HALF)
        values = np.abs(np.asarray(ends[0][order - 1])).max()
        allowed = _SMOOTH * np.abs(rates).max() + 1e-8 * values + 1e-9 * _size(result)
        if not np.all(off <= allowed):
            yield "derivative", f"derivative {order} of {one.stem} is off by {off.max()}"


def _extremes(result: MechanismResult, one: Any) -> Doubts:
    """Compare the least and the largest value with those of many."""
    low, high = result.linkage.span
    values = np.asarray(result.track(one)(np.linspace(low, high, _DENSE), 1).derivatives()[:2])
    found: TrackMeasures = result.measures[one.stem]
    step = (high - low) / _DENSE * (np.abs(values[1]).max() + 1e-12)
    least, largest = found.least().value, found.largest().value
    small = 1e-9 * (1.0 + np.abs(values[0]).max())
    for word, beyond in (
        ("least", least - values[0].min()),
        ("largest", values[0].max() - largest),
    ):
        if not -step - small <= beyond <= small:
            yield "extreme", f"the {word} {one.stem} is off by {beyond}"


def _asked(result: MechanismResult) -> Doubts:
    """Check that dwells and intervals are what they are asked for."""
    for one, found in zip(result.design.dwell, result.dwells, strict=True):
        output = result.output_of(one)
        amount = one.amount(angle=output.angle)
        values = _over(result, output, found.begin, found.end)
        if not np.ptp(values) <= amount * (1.0 + 1e-6) + 1e-9:
            yield "dwell", f"{output.stem} moves by {np.ptp(values)} in its dwell"
        yield from _longer(result, output, amount, found.length)
    for one, found in zip(result.design.interval, result.intervals, strict=True):
        output = result.output_of(one)
        travel = one.amount(angle=output.angle)
        values = _over(result, output, found.begin, found.end)
        if not abs(abs(values[-1] - values[0]) - travel) <= 1e-6 * travel + 1e-9:
            yield "interval", f"{output.stem} travels {values[-1] - values[0]} in its interval"


def _over(result: MechanismResult, output: Any, begin: float, end: float) -> Array:
    q: Array = np.linspace(begin, end, 501, dtype=np.float64)
    return np.asarray(result.track(output)(q, 0).c[0]) + 0.0 * q


def _longer(result: MechanismResult, output: Any, amount: float, length: float) -> Doubts:
    """Yield a dwell that is longer than the one found, by steps."""
    low, high = result.linkage.span
    count, turns = 720, 2 if result.linkage.closed else 1
    if high - low > _TURNS:  # whose steps would be too long
        return
    step = (high - low) / count
    q = np.asarray(low + step * np.arange(count * turns + 1), dtype=np.float64)
    values = np.asarray(result.track(output)(q, 0).c[0] + 0.0 * q, dtype=np.float64)
    last, best = 0, 0
    for first in range(count + 1):
        last = max(last, first)
        while last + 1 < len(q) and np.ptp(values[first : last + 2]) <= amount:
            last += 1
        best = max(best, min(last - first, count))
    if best * step > length + 1e-6:
        yield "dwell", f"{output.stem} has a dwell of {best * step} rad, not {length}"
