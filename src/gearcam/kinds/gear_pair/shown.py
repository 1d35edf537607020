"""What is shown of a gear pair: its facts, and its files, one function a format."""

from __future__ import annotations

import math
from collections.abc import Callable, Iterator, Mapping
from typing import TYPE_CHECKING, Final

import numpy as np

from gearcam.base.facts import Fact, Facts, Tree, extent
from gearcam.base.findings import limit_of
from gearcam.base.numerals import FEW, formatted
from gearcam.base.quantities import RPM
from gearcam.designs.outputs import DRAWINGS, MESHES
from gearcam.gears.pair import gear_tree
from gearcam.gears.subject import KIND, CheckedPair
from gearcam.kinds.gear_pair.tables import POINTS
from gearcam.laws.ratio.span import angle_text
from gearcam.meshing.drive_checks import side_name
from gearcam.numeric.arrays import distinct, first_least
from gearcam.parts.mass import part_facts, size_fact
from gearcam.report.file import report_files
from gearcam.results.parts import Files, Measured, part_files

if TYPE_CHECKING:
    from gearcam.gears.contact import FlankPairs
    from gearcam.gears.pair import Gear
    from gearcam.kinds.gear_pair.result import GearPairResult

_ALIKE: Final = 1e-9
"""Tips whose thickness differs by less than this, in modules, are equal."""


def facts(result: GearPairResult) -> Facts:
    """Return the facts of a pair, its `result`."""
    kerf, leads = result.design.output.kerf, result.leads
    tree: Tree = {
        "pair": _pair(result),
        "mesh": _mesh(result),
        "kerf_mm": kerf or None,
        "gears": [_gear(result, gear) for gear in result.gears],
        "steps": {"count": Fact(len(leads), "steps"), "moved_mm": list(leads)}
        if len(leads) > 1
        else None,
    }
    size = "travel_per_turn_mm" if result.pair.on_rack else "center_distance_mm"
    headline = [f"pair.{name}" for name in (size, "module_mm", "teeth")]
    return Facts(tree, headline, "wheel and rack" if result.pair.on_rack else "")


def _pair(result: GearPairResult) -> Tree:
    pair, spec = result.pair, result.design.pair
    law = pair.law
    (_, low), (_, high) = law.ratio_range
    size, solved = pair.center_distance, dict(law.solved)
    given = getattr(result.design.law, "driven_travel", None)
    as_given = isinstance(given, float) and math.isclose(given, law.advance)
    if not (law.closed or as_given):
        solved["driven_travel_deg"] = math.degrees(law.advance)
    shown = [*solved]
    size_facts: Tree = {
        "center_distance_mm": Fact(size, "centre distance"),
        "ratio": Fact(extent(low, high), "ratio i21", shown=True),
    }
    if pair.on_rack:
        size_facts = {
            "travel_per_turn_mm": Fact(size * law.lobes.advance, "rack travel per turn"),
            "radius_mm": Fact(extent(low, high, size), "pitch radius", shown=True),
        }
        solved["mm_per_unit_of_r1"] = size
    elif spec.center_distance is None:
        solved["center_distance_mm"] = size
    else:
        solved["module_mm"] = pair.module
    return {
        "type": None if pair.on_rack else spec.type,
        "module_mm": Fact(pair.module, "module"),
        "teeth": list(pair.teeth),
        "face_width_mm": spec.face_width,
        "x": Fact(spec.x, "profile shift", unit="modules"),
        "backlash_mm": Fact(spec.backlash, "backlash, given"),
        "rack": _rack(result),
        "assembly": Fact("along the axis", "the wheel goes into its ring", shown=True)
        if pair.internal
        else None,
        **size_facts,
        **_timed(result),
        "solved": {
            name: _solved(name, value, shown=name in shown) for name, value in solved.items()
        },
    }


def _timed(result: GearPairResult) -> Tree:
    """Return speed and largest acceleration of what is driven; empty without a speed."""
    drive, pair, subject = result.design.drive, result.pair, result.subject
    if drive.speed is None:
        return {}
    (_, low), (_, high) = pair.law.ratio_range
    steepest = pair.rolling.mean_radius * float(np.abs(subject.accelerations[1]).max())
    what, key, unit = "driven wheel", "driven_speed_rpm", "driven_acceleration_max_rad_s2"
    speed, rate = drive.speed / RPM.factor, drive.speed**2
    if pair.on_rack:
        what, key, unit = "rack", "rack_velocity_mm_s", "rack_acceleration_max_mm_s2"
        speed, rate = pair.center_distance * drive.speed, pair.center_distance * rate
    place = f"at {drive.named}"
    return {
        key: Fact(extent(low, high, speed), f"speed of the {what}", place=place, shown=True),
        unit: Fact(rate * steepest, f"largest acceleration of the {what}", place=place),
    }


def _solved(name: str, value: float, *, shown: bool) -> Fact:
    """Return what was left to the program: named in words, or by its place in a list."""
    kind, _, place = name.partition("[")
    meaning, unit = _SOLVED[kind]
    words = f"{meaning} {int(place[:-1]) + 1} (solved)" if place else meaning
    return Fact(value, words, unit=unit, shown=shown)


def _rack(result: GearPairResult) -> Tree:
    """Return the basic rack as used, and the defaults that were changed to suit given values."""
    rack = result.pair.rack
    yielded = rack.yielded(result.design.rack)

    def height(name: str) -> Fact:
        gave = name in yielded
        place = f"changed from the default {formatted(yielded[name], FEW)}" if gave else ""
        return Fact(getattr(rack, name), place=place, unit="modules", shown=gave)

    return {
        "pressure_angle_deg": math.degrees(rack.pressure_angle),
        **{name: height(name) for name in ("addendum", "dedendum", "tip_radius")},
        "yielded": yielded or None,
    }


def _mesh(result: GearPairResult) -> Tree:
    """Return the numbers of the mesh at the designed distance, with their limits."""
    subject, limits, module = result.subject, result.design.limits, result.pair.module
    least = limit_of(KIND, "contact-ratio", limits)
    thin = limit_of(KIND, "thin-tip", limits) * module
    tips = np.concatenate([gear.profile.tip_thickness for gear in result.gears])
    thinnest = first_least(tips, _ALIKE * module)
    teeth = len(result.gears[0].profile.tip_thickness)
    wheel, tooth = (1, thinnest + 1) if thinnest < teeth else (2, thinnest - teeth + 1)
    # where both directions are equal by symmetry: the first, not the one that rounding makes larger
    direction, (phi1, angle) = max(
        subject.pressure_angles.items(), key=lambda item: round(item[1][1], 9)
    )
    places, values = subject.accelerations
    worst = int(np.argmax(np.abs(values)))
    return {
        "contact_ratio": dict(_contact_ratios(subject.sides, least)),
        "pressure_angle_max_deg": Fact(
            math.degrees(angle),
            "largest pressure angle",
            at_most=math.degrees(limit_of(KIND, "pressure-angle", limits)),
            place=f"driving {direction}, {angle_text(phi1)}",
            shown=True,
        ),
        "tip_thickness_min_mm": Fact(
            float(tips.min()),
            "thinnest tip",
            at_least=thin,
            place=f"wheel {wheel}, tooth {tooth}",
            shown=True,
        ),
        "rim_min_mm": _rim(subject, limit_of(KIND, "thin-rim", limits) * module),
        "tip_pass_margin_mm": _tip_pass(result),
        "backlash_mm": Fact(
            max(subject.backlash, 0.0), "backlash of the wheels", place=_parted(result), shown=True
        ),
        "acceleration_max": Fact(
            abs(float(values[worst])),
            "largest acceleration d(i21)/dphi1",
            at_most=limit_of(KIND, "acceleration", limits),
            place=angle_text(float(places[worst])),
            unit="1/rad",
            shown=True,
        ),
    }


def _parted(result: GearPairResult) -> str:
    """Return in words which part of the backlash comes from clearance, if any."""
    if not any(result.design.blank.wheel(number).clearance for number in (1, 2)):
        return ""
    backlash = result.design.pair.backlash
    more = result.subject.backlash - backlash
    return f"backlash_mm {formatted(backlash, FEW)} + {formatted(more, FEW)} from clearance_mm"


def _contact_ratios(sides: tuple[FlankPairs, ...], limit: float) -> Iterator[tuple[str, Fact]]:
    """Yield the contact ratio of each side; one line is shown if both are equal."""
    rows = []
    for pairs in reversed(sides):
        ratios = pairs.arcs.ratios
        rows.append((pairs, {"least": float(ratios.min()), "mean": float(ratios.mean())}))
    alike = all(
        math.isclose(rows[0][1][name], rows[1][1][name], rel_tol=1e-9) for name in ("least", "mean")
    )
    for number, (pairs, value) in enumerate(rows):
        side = side_name(pairs)
        yield (
            side.rpartition(" ")[2],
            Fact(
                value,
                "least contact ratio" if alike else f"least contact ratio, {side}",
                at_least=limit,
                place="both ways" if alike else "",
                shown=not (alike and number),
            ),
        )


def _tip_pass(result: GearPairResult) -> Fact | None:
    tip_pass = result.subject.tip_pass
    if tip_pass is None:
        return None
    return Fact(
        tip_pass.margin,
        "distance by which tips pass outside the mesh",
        at_least=limit_of(KIND, "tips-collide", result.design.limits),
        place=f"wheel 1, tooth {tip_pass.tooth}, {angle_text(tip_pass.phi1)}",
        shown=True,
    )


def _rim(subject: CheckedPair, limit: float) -> Fact | None:
    rims = [(rim, gear.wheel) for rim, gear in subject.rims]
    if not rims:
        return None
    rim, wheel = min(rims)
    return Fact(rim, "thinnest rim", at_least=limit, place=f"wheel {wheel}", shown=True)


_SOLVED: Mapping[str, tuple[str, str]] = {
    "ratios": ("ratio", ""),
    "knots_deg": ("angle of knot", "deg"),
    "p": ("coefficient p of the parabolas", ""),
    "center_distance_mm": ("centre distance", "mm"),
    "module_mm": ("module", "mm"),
    "center_distance_over_scale": ("centre distance in the unit of r1", ""),
    "center_distance_over_semi_latus_rectum": (
        "centre distance over radius at focus",
        "",
    ),
    "side_distance_over_center_distance": ("distance of a side over centre distance", ""),
    "mm_per_unit_of_r1": ("unit of r1", "mm"),
    "growth_per_rad": ("growth of the spiral", "1/rad"),
    "driver_travel_deg": ("travel of the driver", "deg"),
    "driven_travel_deg": ("travel of the driven wheel", "deg"),
    "ratio_factor": ("factor of the given ratio", ""),
    "k1_deg_per_x": ("driver angle per unit of x", "deg"),
    "k2_deg_per_y": ("driven angle per unit of y", "deg"),
    "crank_radius_over_slide_unit": ("crank radius in the unit of the slide", ""),
    "crank_angle_at_start_deg": ("crank angle at the start", "deg"),
}
"""Labels and units of what was left to the program, by the names without places in lists."""


def _gear(result: GearPairResult, gear: Gear) -> Tree:
    blank = result.design.blank.wheel(gear.wheel)
    shift = result.design.pair.x if gear.wheel == 1 else -result.design.pair.x
    return {
        **gear_tree(gear),
        "profile_shift": Fact(shift, unit="modules") if shift else None,
        "bore_diameter_mm": blank.bore if result.bores[gear.wheel - 1] else None,
        "clearance_mm": blank.clearance or None,
        "tip_rounding_mm": blank.tip_rounding or None,
        **_part(result, gear),
        "measuring": _measuring(gear, result.pins[gear.wheel - 1]) if result.pins else None,
    }


_MEASURED: Final = {
    "center_radius_mm": "pin's centre from the axis",
    "over_pins_mm": "",
    "chord_mm": "pitch chord, all teeth",
    "chord_depth_mm": "pitch chord, depth",
    "constant_chord_mm": "constant chord",
    "constant_chord_depth_mm": "constant chord, depth",
}
"""Columns of what is measured whose ends are facts, with their labels: that over pins depends on
what the pins are held against."""


def _measuring(gear: Gear, asked: float | None) -> Tree:
    """Return what is measured on a wheel with a pin of the diameter `asked`, or recommended, mm."""
    table = gear.measuring.table(asked)
    tree: Tree = {"pin_diameter_mm": Fact(float(table["pin_diameter_mm"][0]), "measuring pin")}
    over = "over one pin and the back" if gear.toothing.track.slides else "over pins, all spaces"
    over = "between two pins" if gear.ring else over
    for name, meaning in _MEASURED.items():
        there = table[name][np.isfinite(table[name])]
        if there.any():
            tree[name] = Fact(extent(float(there.min()), float(there.max())), meaning or over)
    return {**tree, "spans": [*_spans(gear)] or None}


def _spans(gear: Gear) -> Iterator[Tree]:
    """Yield of each place with steady spans that which is touched nearest to the flanks' middle."""
    spans, places = gear.measuring.spans, dict[int, int]()
    anywhere = len(distinct(spans.first[spans.place < 0])) == len(gear.measuring.numbers)
    for number, place in enumerate(spans.place.tolist()):
        places.setdefault(place, number)
    for number in places.values():
        first, last, teeth = (int(one[number]) for one in (spans.first, spans.last, spans.teeth))
        where = f"over {teeth} teeth" if anywhere else f"teeth {first} to {last}"
        span = Fact(float(spans.reading[number]), f"span {where}")
        yield {"first": first, "last": last, "teeth": teeth, "span_mm": span}


def _part(result: GearPairResult, gear: Gear) -> Tree:
    """Return the overall size of a wheel and, if parts are ordered, the facts of the part."""
    number = gear.wheel - 1
    name = "the rack" if gear.toothing.track.slides else f"wheel {gear.wheel}"
    if not result.ordered:
        if gear.hollow or len(result.leads) > 1:
            return {}  # its outside, or its other steps, are not made
        extents = (*np.ptp(gear.outline, axis=0), result.design.pair.face_width)
        return {"size_mm": size_fact(extents, name)}
    part, tools = result.parts[number], result.parts_subject.tools[number]
    density = result.design.blank.wheel(gear.wheel).density
    area = {"part": {"area_mm2": part.steps[0].moments.area}}
    return area | part_facts(part, name, tools, density)


def _tables(result: GearPairResult, _: Measured) -> Files:
    """Return the outlines and the centrodes as tables.

    Files: gear1_outline.csv, gear2_outline.csv, centrodes.csv.

    Vertices of the outlines; angles, ratio, radii, arc lengths and radii of curvature of both
    centrodes.
    """
    from gearcam.export.table import outline_bytes, table_bytes

    columns = result.centrodes()
    centrodes = {name: values for name, values in columns.items() if name not in POINTS}
    files = {
        f"{gear.name}_outline.csv": outline_bytes(gear.profile.points) for gear in result.gears
    }
    return files | {"centrodes.csv": table_bytes(centrodes)}


def _inspection(result: GearPairResult, _: Measured) -> Files:
    """Return the points for inspection, and what is measured by hand.

    Files: inspection.csv, measures.csv.

    Points on every flank with their normals, for a measuring machine; tooth by tooth the measures
    over pins, chords and spans of the finished wheels.
    """
    from gearcam.export.table import table_bytes
    from gearcam.kinds.gear_pair.parts import inspection_rows, measure_rows

    rows = inspection_rows(result.steps, result.design.output.inspection_points)
    measures = measure_rows(result.steps, result.pins or (None, None))
    missing = {name: np.ma.masked_invalid(values) for name, values in measures.items()}
    for name in ("opposite", "span_teeth"):
        there = missing[name]
        missing[name] = np.ma.array(there.filled(0.0).astype(int), mask=there.mask)
    return {"inspection.csv": table_bytes(rows), "measures.csv": table_bytes(missing)}


_SOLIDS: Final = """
    Files: gear1.{format}, gear2.{format}, pair.{format}.

    Closed solids in mm: each wheel, and the assembled pair as two bodies, named except in STL."""

_SHEETS: Final = """
    Files: gear1_drawing.{format}, gear2_drawing.{format}, pair_drawing.{format}.

    Workshop drawings with views, dimensions and a table of data."""

_OF_PARTS: Final = {
    "dxf": """
    Files: gear1.dxf, gear2.dxf, pair.dxf; of stepped wheels gear1_step1.dxf and so on.

    Outlines in mm. A wheel lies in its own frame, on the layers OUTLINE, BORE, HOLE, SLOT and MARK;
    the assembled pair has the same layers with GEAR1_ or GEAR2_ before their names, CENTRODE and
    CENTER. With `kerf_mm` the files of the wheels hold paths of the cutter, on layers whose names
    end in _KERF.""",
    "cut-svg": """
    Files: gear1_cut.svg, gear2_cut.svg, cut.svg; of stepped wheels gear1_step1_cut.svg and so on.

    For laser programs, 1:1 in mm: marks to engrave in blue, then inner edges, then outlines in red;
    one file for each part, and cut.svg with all parts side by side and labelled.""",
    "svg": """
    Files: pair.svg.

    A picture of the assembled pair, not for cutting.""",
    **dict.fromkeys(MESHES, _SOLIDS),
    "step": """
    Files: gear1.step, gear2.step, pair.step.

    Exact solids for CAD: one spline face for each flank, fillet, land and tip, planes and cylinders
    elsewhere. Needs `pip install "gearcam[step]"`.""",
    **dict.fromkeys(DRAWINGS, _SHEETS),
    "print-pdf": """
    Files: gear1_print.pdf, gear2_print.pdf; of stepped wheels gear1_step1_print.pdf and so on.

    Outlines at full size on A4 pages, with cross marks where these overlap, to glue on plywood.""",
}

FILES: Final[Mapping[str, Callable[..., Files]]] = {
    **part_files(_OF_PARTS),
    "csv": _tables,
    "inspection": _inspection,
    "report": report_files,
}
"""What makes the files of each format: contents by name; what is measured on them is recorded."""
