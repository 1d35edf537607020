"""What is shown of a mechanism: facts and files.

Velocities that lines of text show are by time if the master has a speed, else by its angle.
"""

from __future__ import annotations

import math
from collections import Counter
from collections.abc import Callable, Mapping
from typing import TYPE_CHECKING, Any, Final

from gearcam.base.facts import Fact, Facts, extent
from gearcam.base.numerals import FEW, formatted
from gearcam.kinds.mechanism.asked import DEG, RATES
from gearcam.kinds.mechanism.names import tables_of, told_parts
from gearcam.linkages.measures import STILL
from gearcam.report.file import report_files

if TYPE_CHECKING:
    from gearcam.kinds.mechanism.asked import Output, StretchSpec
    from gearcam.kinds.mechanism.result import MechanismResult
    from gearcam.linkages.measures import Peak, TrackMeasures
    from gearcam.linkages.path_fits import CircleFit, LineFit
    from gearcam.linkages.paths import PointPath

Tree = dict[str, Any]

Files = dict[str, bytes]

_DRIVES: Final = {
    "even": ("an even shaft", "even shafts"),
    "pair": ("a gear pair", "gear pairs"),
}
"""What drives are called, one and several."""

_DIGITS: Final = 10
"""Decimals of a place in degrees above rounding."""

_SHOWN: Final = 4
"""Outputs of which something is always shown."""


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
    }
    first = next(iter(result.outputs))
    return Facts(tree, (f"outputs.{first.stem}.stroke_{first.unit[1]}",), _called(result))


def _called(result: MechanismResult) -> str:
    """Return what the mechanism is, by its dyads and its drives."""
    parts = (part.called() for *_, part in told_parts(tables_of(result.design)))
    groups = " + ".join(name for name in parts if name) or "linkage"
    drives = []
    for key, number in Counter(one.key for one in result.design.drive).items():
        one, several = _DRIVES.get(key, (f"a {key}", f"{key}s"))
        drives.append(one if number == 1 else f"{number} {several}")
    return f"{groups} driven by {' and '.join(drives)}"


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
    return f"{formatted(DEG * begin, FEW)} to {formatted(DEG * end, FEW)} deg"


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
    place = f"{result.driver[0]} = {formatted(math.degrees(shown_at(result)), FEW)} deg"
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
