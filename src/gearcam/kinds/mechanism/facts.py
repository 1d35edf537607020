"""Facts of a mechanism: what the console, the report and ``summary.json`` show."""

from __future__ import annotations

import math
from typing import TYPE_CHECKING, Any, Final

from gearcam.base.facts import Fact, Facts, extent
from gearcam.base.numerals import formatted
from gearcam.kinds.mechanism.outputs import RATES
from gearcam.linkages.chain import HoistChain, roots_in
from gearcam.linkages.grashof import FourBarLengths, grashof
from gearcam.linkages.measures import STILL

if TYPE_CHECKING:
    from gearcam.kinds.mechanism.build import MechanismResult
    from gearcam.kinds.mechanism.outputs import Output
    from gearcam.kinds.mechanism.tables import StretchSpec
    from gearcam.linkages.measures import Peak, TrackMeasures
    from gearcam.linkages.path_fits import CircleFit, LineFit
    from gearcam.linkages.paths import PointPath
    from gearcam.linkages.transmission import Transmission

Tree = dict[str, Any]

_DEG: Final = math.degrees(1.0)

_DIGITS: Final = 10
"""Decimals of a place in degrees above rounding."""

_SHOWN: Final = 4
"""Outputs, and dyads, of which something is always shown."""


def facts(result: MechanismResult) -> Facts:
    """Return the facts of a mechanism, its `result`."""
    outputs = {one.stem: _output(result, one, k) for k, one in enumerate(result.outputs)}
    tree: Tree = {
        "machine": _machine(result),
        "outputs": outputs,
        "paths": {name: _path(path) for name, path in result.paths.items()} or None,
        "stretches": _stretches(result),
        "intervals": _intervals(result),
        "dwells": _dwells(result),
        "compare": {
            name: {one.stem: _peaks(other, one) for one in other.outputs}
            for name, other in result.compared.items()
        }
        or None,
        "accuracy": _accuracy(result),
    }
    first = next(iter(result.outputs))
    return Facts(tree, (f"outputs.{first.stem}.stroke_{first.unit[1]}",), _called(result))


def _called(result: MechanismResult) -> str:
    """Return what the mechanism is, by its dyads and its drives."""
    groups = " + ".join(one.type for one in result.design.dyad) or "linkage"
    keys = [one.key for one in result.design.drive]
    drives = (_counted(keys.count(key), key) for key in dict.fromkeys(keys))
    return f"{groups} behind {' and '.join(drives)}"


def _counted(number: int, key: str) -> str:
    """Return how many drives of a sort there are, in words."""
    one, several = {"even": ("an even shaft", "even shafts")}.get(key, (f"a {key}", f"{key}s"))
    return one if number == 1 else f"{number} {several}"


def _machine(result: MechanismResult) -> Tree:
    """Return its range, its dyads in the order in which they are solved, and their positions."""
    linkage, (low, high) = result.linkage, result.linkage.span
    signs = {one.joint: one.sign for one in linkage.dyads}
    solved = {one.joint: number for number, one in enumerate(linkage.dyads, start=1)}
    worst = {one.dyad.joint: one for one in result.transmissions}
    return {
        "from_deg": _DEG * low,
        "to_deg": _DEG * high,
        "closed": linkage.closed,
        "mobility": 1,
        "dyads": {
            one.joint: {
                "type": one.type,
                "solved": solved[one.joint],
                "branch": one.branches[0 if signs[one.joint] > 0.0 else 1]
                if one.branches
                else None,
                **_transmission(result, worst[one.joint], one.joint, number < _SHOWN),
            }
            for number, one in enumerate(result.design.dyad)
        }
        or None,
        "four_bars": _four_bars(result) or None,
        "chains": {
            one.name: {
                "positions": Fact(
                    roots_in(one, 0.0), f"positions of {one.name} within its range", unit=""
                )
            }
            for one in linkage.elements
            if isinstance(one, HoistChain)
        }
        or None,
    }


def _transmission(result: MechanismResult, worst: Transmission, joint: str, shown: bool) -> Tree:
    if worst.pressure_angle is not None:
        peak = worst.pressure_angle
        label, value = f"largest pressure angle of {joint}", _DEG * peak.value
        fact = Fact(value, label, place=_place(result, peak), shown=shown, noise=1e-9)
        return {"pressure_angle_deg": fact, "pressure_angle_at_deg": _DEG * peak.place}
    if worst.distance is not None:
        label = f"least distance of the block of {joint} from the guide's pivot"
        fact = Fact(worst.distance.value, label, place=_place(result, worst.distance))
        return {"guide_distance_mm": fact, "guide_distance_at_deg": _DEG * worst.distance.place}
    return {}


def _four_bars(result: MechanismResult) -> Tree:
    """Return Grashof's class of each RRR dyad between a crank and a joint that stands still."""
    design, found = result.design, {}
    cranks = {one.joint: one for one in design.crank}
    fixed = {one.name: complex(*one.at) for one in design.joint}
    for dyad in design.dyad:
        ends = (dyad.first, dyad.last) if dyad.first in cranks else (dyad.last, dyad.first)
        one, two = dyad.lengths if dyad.first in cranks else dyad.lengths[::-1]
        if dyad.type != "RRR" or ends[0] not in cranks or ends[1] not in fixed:
            continue
        crank = cranks[ends[0]]
        if crank.on.endswith(".follower"):  # which swings: its class says nothing
            continue
        shaft = result.linkage.shaft_of(crank.name)
        base = abs(fixed[ends[1]] - shaft)
        if base:
            grashof_class = grashof(FourBarLengths(crank.length, one, two, base))
            found[dyad.joint] = {
                "class": Fact(grashof_class.name, f"Grashof's class of {dyad.joint}"),
                "meaning": grashof_class.meaning,
            }
    return found


def _path(path: PointPath) -> Tree:
    """Return length and area of a point's path, its cusps and its crossings."""
    area = path.area
    return {
        "length_mm": path.length.value,
        "area_mm2": None if area is None else area.value,
        "cusps_deg": [_DEG * one.place for one in path.cusps] or None,
        "crossings": [
            {"first_deg": _DEG * one.first, "second_deg": _DEG * one.second,
             "x_mm": one.point.real, "y_mm": one.point.imag}
            for one in path.crossings
        ] or None,
    }  # fmt: skip


def _place(result: MechanismResult, peak: Peak) -> str:
    return f"at {result.degrees(peak.place)} deg"


def _where(
    result: MechanismResult, measures: TrackMeasures, peak: Peak
) -> tuple[str, float | None]:
    """Return the place of a peak as text and in degrees; none of what stands still."""
    return ("", None) if measures.still else (_place(result, peak), _DEG * peak.place)


def _dead_centers(measures: TrackMeasures) -> list[float]:
    """Return where the motion ends before it reverses, within the range, deg."""
    low, high = (round(_DEG * end, _DIGITS) for end in measures.span)
    places = [round(_DEG * one.place, _DIGITS) for one in measures.dead_centers]
    if measures.closed:
        places = [low + (one - low) % (high - low) for one in places]
    return sorted(places)


def _output(result: MechanismResult, one: Output, number: int) -> Tree:
    """Return range, stroke, dead centres and peaks of an output, of which one stands first."""
    measures, (scale, unit) = result.measures[one.stem], one.unit
    least, largest = measures.least(), measures.largest()
    ratio = measures.time_ratio
    tree: Tree = {}
    for word, peak in (("least", least), ("largest", largest)):
        place, at = _where(result, measures, peak)
        value = scale * peak.value if abs(peak.value) > STILL else 0.0
        tree[f"{word}_{unit}"] = Fact(value, f"{one.stem}, {word}", place=place)
        tree[f"{word}_at_deg"] = at
    return tree | {
        f"stroke_{unit}": Fact(
            scale * measures.stroke,
            f"{'turn' if measures.rise and one.angle else 'stroke'} of {one.stem}",
            shown=number < _SHOWN,
            noise=1e-9,
        ),
        "dead_centers_deg": _dead_centers(measures) or None,
        "time_ratio": None
        if ratio is None
        else Fact(
            ratio.ratio, f"forward over return time of {one.stem}", unit="", shown=not number
        ),
        **_peaks(result, one, shown=not number),
    }


def _peaks(result: MechanismResult, one: Output, *, shown: bool = False) -> Tree:
    """Return the derivatives of an output furthest from 0; the velocity may be shown."""
    measures: TrackMeasures = result.measures[one.stem]
    speed, tree = result.speed, {}
    for order, word in enumerate(RATES, start=1):
        peak, (per_rad, per_s) = measures.size(order), one.rate_keys(order)
        seen, label = shown and order == 1, f"largest {word} of {one.stem}"
        place, at = _where(result, measures, peak)
        told = seen and speed is None
        tree[f"{word}_{per_rad}"] = Fact(peak.value, label, place=place, shown=told, noise=1e-9)
        if speed is not None:
            value = peak.value * speed**order
            tree[f"{word}_{per_s}"] = Fact(value, label, place=place, shown=seen, noise=1e-9)
        tree[f"{word}_at_deg"] = at
    return tree


def _stretches(result: MechanismResult) -> list[Tree] | None:
    return [
        {
            "on": one.on,
            "shape": one.shape,
            "deviation_mm": Fact(
                fit.deviation,
                f"deviation of {one.on} from the {one.shape}",
                place=_between(one.start, one.end),
                shown=True,
            ),
            **_fitted(fit),
            **_distance(result.paths[one.on], one),
        }
        for one, fit in zip(result.design.stretch, result.stretches, strict=True)
    ] or None


def _distance(path: PointPath, one: StretchSpec) -> Tree:
    """Return the smallest and the largest distance of a stretch from a point that is given."""
    if one.center is None:
        return {}
    from gearcam.linkages.path_fits import distances_from

    ends = distances_from(path, complex(*one.center), one.start, one.end)
    return {"distance_mm": extent(*(end.value for end in ends))}


def _fitted(fit: LineFit | CircleFit) -> Tree:
    """Return the length of a line, or radius and centre of a circle."""
    from gearcam.linkages.path_fits import LineFit

    if isinstance(fit, LineFit):
        return {"length_mm": fit.length}
    return {"radius_mm": fit.radius, "center_mm": [fit.center.real, fit.center.imag]}


def _amount(length: float | None, angle: float | None) -> str:
    """Return a length, mm, or an angle, rad, as text, whichever is given."""
    if length is not None:
        return f"{formatted(length)} mm"
    return f"{formatted(_DEG * (angle or 0.0))} deg"


def _between(begin: float, end: float) -> str:
    return f"{formatted(_DEG * begin, 6)} to {formatted(_DEG * end, 6)} deg"


def _intervals(result: MechanismResult) -> list[Tree] | None:
    speed = result.speed
    return [
        {
            "on": one.on,
            "before": one.before,
            "from_deg": _DEG * found.begin,
            "to_deg": _DEG * found.end,
            "angle_deg": Fact(
                _DEG * found.length,
                f"last {_amount(one.travel, one.travel_angle)} of {one.on} "
                f"before its {one.before} dead centre",
                place=_between(found.begin, found.end),
                shown=True,
            ),
            "time_s": None if speed is None else found.length / speed,
            f"velocity_{per_rad}": rate,
            f"velocity_{per_s}": None if speed is None else rate * speed,
        }
        for number, (one, found, rate) in enumerate(
            zip(result.design.interval, result.intervals, result.interval_velocities, strict=True)
        )
        for per_rad, per_s in [result.asked("interval", number)[0].rate_keys(1)]
    ] or None


def _dwells(result: MechanismResult) -> list[Tree] | None:
    return [
        {
            "on": one.on,
            "from_deg": _DEG * found.begin,
            "to_deg": _DEG * found.end,
            "angle_deg": Fact(
                _DEG * found.length,
                f"longest dwell of {one.on} within {_amount(one.within, one.within_angle)}",
                place=_between(found.begin, found.end),
                shown=True,
            ),
        }
        for one, found in zip(result.design.dwell, result.dwells, strict=True)
    ] or None


def _accuracy(result: MechanismResult) -> Tree:
    return {
        "lengths_mm": result.closure_error,
        "how": {"lengths_mm": "largest difference of a length of a member from the one it has"},
    }
