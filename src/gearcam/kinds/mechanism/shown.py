"""What is shown of a mechanism: facts, charts, and files.

Velocities and what follows are by time if the master has a speed, else by its angle. Where drives
are compared, every output has a line for each of them.
"""

from __future__ import annotations

import math
from collections import Counter
from collections.abc import Callable, Iterator, Mapping
from functools import partial
from typing import TYPE_CHECKING, Any, Final

import numpy as np

from gearcam.base.facts import Fact, Facts, extent
from gearcam.base.numerals import formatted
from gearcam.kinds.mechanism.asked import DEG, RATES
from gearcam.kinds.mechanism.names import tables_of, told_parts
from gearcam.linkages.measures import STILL
from gearcam.linkages.transmission import ADMISSIBLE, pressure_angle
from gearcam.numeric.piecewise import with_both_sides
from gearcam.pictures.charts import Chart, Charts, Limit, Line, MarkedPlace, knot_marks
from gearcam.report.file import report_files

if TYPE_CHECKING:
    from gearcam.kinds.mechanism.asked import Output, StretchSpec
    from gearcam.kinds.mechanism.result import MechanismResult
    from gearcam.linkages.measures import Peak, TrackMeasures
    from gearcam.linkages.path_fits import CircleFit, LineFit
    from gearcam.linkages.paths import PointPath
    from gearcam.numeric.arrays import Array

Tree = dict[str, Any]

Files = dict[str, bytes]

_DIGITS: Final = 10
"""Decimals of a place in degrees above rounding."""

_SHOWN: Final = 4
"""Outputs of which something is always shown."""

_STEPS: Final = 720
"""Steps of a turn of the master in a chart."""

_MOST: Final = 9
"""Most lines of a chart of several drives."""

_STEADY: Final = 1e-9
"""Range of a pressure angle that does not change, rad."""

_WORDS: Final = ("place", *RATES)


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
        "accuracy": {
            "lengths_mm": result.closure_error,
            "how": {"lengths_mm": "largest difference of a length of a member from the one it has"},
        },
    }
    first = next(iter(result.outputs))
    return Facts(tree, (f"outputs.{first.stem}.stroke_{first.unit[1]}",), _called(result))


def _called(result: MechanismResult) -> str:
    """Return what the mechanism is, by its dyads and its drives."""
    parts = (part.called() for *_, part in told_parts(tables_of(result.design)))
    groups = " + ".join(name for name in parts if name) or "linkage"
    drives = []
    for key, number in Counter(one.key for one in result.design.drive).items():
        one, several = {"even": ("an even shaft", "even shafts")}.get(key, (f"a {key}", f"{key}s"))
        drives.append(one if number == 1 else f"{number} {several}")
    return f"{groups} behind {' and '.join(drives)}"


def _machine(result: MechanismResult) -> Tree:
    """Return its range, and what its parts tell: how dyads stand, and the positions of chains."""
    low, high = result.linkage.span
    groups: dict[str, Tree] = {}
    for _, number, part in told_parts(tables_of(result.design)):
        for group, name, facts in part.facts(result, number):
            groups.setdefault(group, {})[name] = facts
    return {
        "from_deg": DEG * low,
        "to_deg": DEG * high,
        "closed": result.linkage.closed,
        "mobility": 1,
        **groups,
    }


def _path(path: PointPath) -> Tree:
    """Return length and area of a point's path, its cusps and its crossings."""
    area = path.area
    return {
        "length_mm": path.length.value,
        "area_mm2": None if area is None else area.value,
        "cusps_deg": [DEG * one.place for one in path.cusps] or None,
        "crossings": [
            {
                "first_deg": DEG * one.first,
                "second_deg": DEG * one.second,
                "x_mm": one.point.real,
                "y_mm": one.point.imag,
            }
            for one in path.crossings
        ]
        or None,
    }


def _where(
    result: MechanismResult, measures: TrackMeasures, peak: Peak
) -> tuple[str, float | None]:
    """Return the place of a peak as text and in degrees; none of what stands still."""
    return ("", None) if measures.still else (result.at(peak), DEG * peak.place)


def _dead_centers(measures: TrackMeasures) -> list[float]:
    """Return where the motion ends before it reverses, within the range, deg."""
    low, high = (round(DEG * end, _DIGITS) for end in measures.span)
    places = [round(DEG * one.place, _DIGITS) for one in measures.dead_centers]
    if measures.closed:
        places = [low + (one - low) % (high - low) for one in places]
    return sorted(places)


def _output(result: MechanismResult, output: Output, number: int) -> Tree:
    """Return range, stroke, dead centres and peaks of an output, of which one stands first."""
    measures, (scale, unit) = result.measures[output.stem], output.unit
    least, largest = measures.least(), measures.largest()
    ratio = measures.time_ratio
    tree: Tree = {}
    for word, peak in (("least", least), ("largest", largest)):
        place, at = _where(result, measures, peak)
        value = scale * peak.value if abs(peak.value) > STILL else 0.0
        tree[f"{word}_{unit}"] = Fact(value, f"{output.stem}, {word}", place=place)
        tree[f"{word}_at_deg"] = at
    return tree | {
        f"stroke_{unit}": Fact(
            scale * measures.stroke,
            f"{'turn' if measures.rise and output.angle else 'stroke'} of {output.stem}",
            shown=number < _SHOWN,
            noise=1e-9,
        ),
        "dead_centers_deg": _dead_centers(measures) or None,
        "time_ratio": None
        if ratio is None
        else Fact(
            ratio.ratio, f"forward over return time of {output.stem}", unit="", shown=not number
        ),
        **_peaks(result, output, shown=not number),
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
            **_fitted(result.paths[one.on], one, fit),
        }
        for one, fit in zip(result.design.stretch, result.stretches, strict=True)
    ] or None


def _fitted(path: PointPath, one: StretchSpec, fit: LineFit | CircleFit) -> Tree:
    """Return the length of a line, or radius and centre of a circle; distances from a point."""
    from gearcam.linkages.path_fits import LineFit, distances_from

    if isinstance(fit, LineFit):
        tree: Tree = {"length_mm": fit.length}
    else:
        tree = {"radius_mm": fit.radius, "center_mm": [fit.center.real, fit.center.imag]}
    if one.center is not None:
        ends = distances_from(path, complex(*one.center), one.start, one.end)
        tree["distance_mm"] = extent(*(end.value for end in ends))
    return tree


def _between(begin: float, end: float) -> str:
    return f"{formatted(DEG * begin, 6)} to {formatted(DEG * end, 6)} deg"


def _intervals(result: MechanismResult) -> list[Tree] | None:
    speed = result.speed
    return [
        {
            "on": one.on,
            "before": one.before,
            "from_deg": DEG * found.begin,
            "to_deg": DEG * found.end,
            "angle_deg": Fact(
                DEG * found.length,
                f"last {one.told} of {one.on} before its {one.before} dead centre",
                place=_between(found.begin, found.end),
                shown=True,
            ),
            "time_s": None if speed is None else found.length / speed,
            f"velocity_{per_rad}": rate,
            f"velocity_{per_s}": None if speed is None else rate * speed,
        }
        for one, found, rate in zip(
            result.design.interval, result.intervals, result.interval_velocities, strict=True
        )
        for per_rad, per_s in [result.output_of(one).rate_keys(1)]
    ] or None


def _dwells(result: MechanismResult) -> list[Tree] | None:
    return [
        {
            "on": one.on,
            "from_deg": DEG * found.begin,
            "to_deg": DEG * found.end,
            "angle_deg": Fact(
                DEG * found.length,
                f"longest dwell of {one.on} within {one.told}",
                place=_between(found.begin, found.end),
                shown=True,
            ),
        }
        for one, found in zip(result.design.dwell, result.dwells, strict=True)
    ] or None


# --- charts ---------------------------------------------------------------------------------------


def _angles(result: MechanismResult) -> Array:
    """Return the master's angles of a chart, rad, with both sides of knots."""
    low, high = result.linkage.span
    turns = max(1, round((high - low) / math.tau))
    return with_both_sides(np.linspace(low, high, _STEPS * turns + 1), result.linkage.knots)


def _marks(result: MechanismResult) -> tuple[MarkedPlace, ...]:
    """Return knots, and where intervals that the design asks for begin and end."""
    low, high = result.linkage.span
    ends = [
        MarkedPlace(
            label=f"last bit of {one.on}",
            # one over the end of a cycle ends in the next
            value=DEG * (value if value <= high else value - (high - low)),
        )
        for one, found in zip(result.design.interval, result.intervals, strict=True)
        for value in (found.begin, found.end)
    ]
    return (*knot_marks(DEG * result.linkage.knots, DEG * low, DEG * high), *ends)


def _chart(angle: bool, order: int, result: MechanismResult) -> Chart | None:
    """Return the chart of a derivative of all outputs that are angles, or lengths."""
    drives = result.machines if result.compared else {"": result}
    outputs = [one for one in result.outputs if one.angle == angle]
    outputs = outputs[: max(1, _MOST // len(drives))]
    if not outputs:
        return None
    lines = [line for name, other in drives.items() for line in _lines(other, name, outputs, order)]
    names = ", ".join(
        dict.fromkeys(one.name.removesuffix(".angle").removesuffix(".turn") for one in outputs)
    )
    word = "direction" if angle and not order else _WORDS[order]
    called = f"Angular {word}" if angle and order else word.capitalize()
    return Chart(
        title=f"{called} of {names}",
        x=result.axis,
        y=f"{called.lower()}, {_unit(angle, order, timed=result.speed is not None)}",
        lines=tuple(lines),
        marks=_marks(result),
    )


def _unit(angle: bool, order: int, *, timed: bool) -> str:
    """Return the unit of a derivative by time, or by the master's angle."""
    if not order:
        return "deg" if angle else "mm"
    power = "" if order == 1 else f"^{order}"
    return f"{'rad' if angle else 'mm'}/{'s' if timed else 'rad'}{power}"


def _lines(result: MechanismResult, name: str, outputs: list[Output], order: int) -> Iterator[Line]:
    q = _angles(result)
    for one in outputs:
        values = result.track(one)(q, order).derivatives()[order]
        scale = (result.speed or 1.0) ** order if order else one.unit[0]
        own = one.stem if len(outputs) > 1 or not name else ""
        yield Line(
            label=", ".join(word for word in (own, name) if word), x=DEG * q, y=scale * values
        )


def _path_chart(result: MechanismResult) -> Chart | None:
    """Return the paths of points in the plane."""
    names = [*result.paths]
    if not names:
        return None
    q = _angles(result)
    lines = []
    for name in names:
        points = np.broadcast_to(np.asarray(result.linkage.track(name, q, 0).c[0]), q.shape)
        lines.append(Line(label=name, x=np.real(points) + 0.0, y=np.imag(points) + 0.0))
    return Chart(title=f"Path of {', '.join(names)}", x="x, mm", y="y, mm", lines=tuple(lines))


def _transmission_chart(result: MechanismResult) -> Chart | None:
    """Return the pressure angles of the dyads in which they change."""
    q = _angles(result)
    known = result.linkage.at(q, 0)
    dyads = [one.dyad for one in result.transmissions if one.pressure_angle is not None]
    dyads = [one for one in dyads if np.ptp(pressure_angle(known, one)) > _STEADY]
    if not dyads:
        return None
    lines = [
        Line(label=one.joint, x=DEG * q, y=DEG * pressure_angle(known, one) + np.zeros(q.shape))
        for one in dyads
    ]
    given: Any = result.design.limits.get("pressure_angle")
    types = {one.type for one in dyads} & {*ADMISSIBLE}
    limits = {f"limit of {one}": ADMISSIBLE[one].pressure_angle[0] for one in sorted(types)}
    limits = limits if given is None else {"limit": given}
    return Chart(
        title="Pressure angle: 90 deg less the transmission angle",
        x=result.axis,
        y="pressure angle, deg",
        lines=tuple(lines),
        limits=tuple(Limit(label=name, value=DEG * one) for name, one in limits.items()),
        marks=_marks(result),
    )


CHARTS: Final[Charts] = {
    "motion": partial(_chart, False, 0),
    "velocity": partial(_chart, False, 1),
    "acceleration": partial(_chart, False, 2),
    "direction": partial(_chart, True, 0),
    "angular_velocity": partial(_chart, True, 1),
    "angular_acceleration": partial(_chart, True, 2),
    "pressure_angle": _transmission_chart,
    "path": _path_chart,
    "jerk": partial(_chart, False, 3),
    "angular_jerk": partial(_chart, True, 3),
}
"""Charts by name; the report leads with the first three."""


# --- files ----------------------------------------------------------------------------------------


def _tables(result: MechanismResult, _: Any) -> Files:
    """Return the motion as a table.

    Files: motion.csv, comparison.csv, intervals.csv.

    The master's angle in degrees, and for each output its value and its derivatives by that angle,
    in rad; with a speed also those by time. Where drives are compared, strokes, largest velocities,
    accelerations and jerks behind each. The intervals that are asked for, behind each drive.
    """
    from gearcam.export.table import table_bytes

    files = {"motion.csv": table_bytes(result.motion())}
    if result.design.compare:
        files["comparison.csv"] = table_bytes(result.masked_comparison())
    if result.design.interval:
        files["intervals.csv"] = table_bytes(result.interval_table())
    return files


def _dxf(result: MechanismResult, _: Any) -> Files:
    """Return the paths of points as DXF.

    Files: paths.dxf.

    The paths of the points, and of the joints that are asked for, 1:1 in mm and within the chord
    tolerance, each on a layer of its own, NAME_PATH; with the machine at its pose: members, drawn
    symbolically, on MEMBER and MEMBER_BORE, guides and pivots on GROUND, the wheels or the cam on
    theirs. All is grey, for reference: widths and bores of members are not for cutting, and the
    wheels are those of the pair without their kerf.
    """
    from gearcam.export.dxf import DxfStyle, dxf_bytes
    from gearcam.kinds.mechanism.drawn import CHORDS, paths_drawing

    tolerance = result.design.output.chord_tolerance or CHORDS
    style = DxfStyle(tolerance=tolerance, curves="lines", version="R2010")
    return {"paths.dxf": dxf_bytes(paths_drawing(result), style)}


def _svg(result: MechanismResult, _: Any) -> Files:
    """Return a picture of the machine.

    Files: poses.svg.

    The machine at its pose with the names of joints and members, the paths of its points, dashed,
    and its members at other angles of the master, which are written beside them; not for cutting.
    """
    from gearcam.export.svg import svg_bytes
    from gearcam.kinds.mechanism.drawn import legend, picture, shown_at

    drawing, labels = picture(result)
    place = f"{result.driver[0]} = {formatted(math.degrees(shown_at(result)))} deg"
    notes = (*result.facts.headline, f"drawn at {place}")
    data = svg_bytes(
        drawing, title=result.design.name, notes=notes, labels=labels, legend=legend(result)
    )
    return {"poses.svg": data}


FILES: Final[Mapping[str, Callable[..., Files]]] = {
    "csv": _tables,
    "dxf": _dxf,
    "svg": _svg,
    "report": report_files,
}
"""What makes the files of each format: contents by name."""
