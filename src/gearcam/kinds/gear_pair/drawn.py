"""What is drawn of a gear pair: charts over driver angles, and its scene."""

from __future__ import annotations

import math
from collections.abc import Iterator, Mapping, Sequence
from dataclasses import replace
from typing import TYPE_CHECKING, Final, get_args

import numpy as np

from gearcam.base.findings import limit_of
from gearcam.base.numerals import FEW, formatted
from gearcam.gears.checks import undercut_curvatures
from gearcam.gears.contact import COAST, DRIVE, FlankPairs
from gearcam.gears.pair import Gear
from gearcam.gears.subject import KIND
from gearcam.kinds.gear_pair.result import CENTRODE_POINTS, Side
from gearcam.laws.ratio.phases import Phases
from gearcam.meshing.contact import contacts
from gearcam.meshing.edges import first_touch, known_to
from gearcam.meshing.patches import closed_area
from gearcam.numeric.arrays import Array
from gearcam.numeric.columns import Columns
from gearcam.numeric.pose import Pose
from gearcam.parts.body import Part
from gearcam.pictures.charts import Chart, Charts, Handle, Limit, Line, knot_marks
from gearcam.pictures.drawings import (
    CENTER,
    CENTRODE,
    CROSS_SIZE,
    Cross,
    Feature,
    Path,
    part_features,
)
from gearcam.pictures.scenes import PLACES, ContactPoints, MovingBody, Scene, still

if TYPE_CHECKING:
    from gearcam.kinds.gear_pair.result import GearPairResult

DRIVER: Final = "driver angle phi1, deg"
"""Axis label of charts and scenes."""

_APART: Final = 1.5
"""Steps between points of contact above which a pair is not in contact between them."""

_SIDES: Final = {"drive": "driving flanks", "coast": "coast flanks"}


_NOISE: Final = 1e-12
"""Share of a turn by which a knot may lie before its end: rounding."""


def _chart(
    result: GearPairResult,
    title: str,
    y: str,
    phi1: Array,
    lines: Mapping[str, Array],
    limits: Sequence[Limit] = (),
) -> Chart:
    """Return a chart over driver angles, degrees, with the lines by label and the knots."""
    end = float(result.phases[-1]) * (1.0 - _NOISE)
    return Chart(
        title=title,
        x=DRIVER,
        y=y,
        lines=tuple(Line(label=label, x=phi1, y=values) for label, values in lines.items()),
        limits=tuple(limits),
        marks=knot_marks(np.degrees(result.knots), 0.0, math.degrees(end)),
    )


def _position(result: GearPairResult) -> Chart:
    table = result.motion(result.phases)
    driven, y, column = "driven wheel", "driven angle phi2, deg", "phi2_deg"
    if result.pair.on_rack:
        driven, y, column = "rack", "travel, mm", "travel_mm"
    lines = {driven: table[column]}
    return _chart(result, f"Position of the {driven}", y, table["phi1_deg"], lines)


def _ratio(result: GearPairResult) -> Chart:
    if result.pair.on_rack:
        table = result.motion(result.phases)
        line = {"rack": table["velocity_mm_per_rad"]}
        return _chart(result, "Velocity of the rack", "velocity, mm/rad", table["phi1_deg"], line)
    table = result.centrodes_of_phases
    line = {"ratio i21": table["ratio"]}
    chart = _chart(result, "Transmission ratio", "ratio i21", table["phi1_deg"], line)
    return replace(chart, handles=(*_ratio_handles(result.design.law),))


def _ratio_handles(law: object) -> Iterator[Handle]:
    """Yield handles at the knots of a law that is given by ratios there."""
    if isinstance(law, Phases):
        for k, (knot, ratio) in enumerate(zip(law.knots, law.ratios, strict=True)):
            if isinstance(knot, float | int) and isinstance(ratio, float | int):
                keys = {f"law.ratios[{k}]": (0.0, 1.0)}
                if 0 < k < len(law.knots) - 1:  # the ends of a turn stay
                    keys[f"law.knots_deg[{k}]"] = (1.0, 0.0)
                yield Handle(x=math.degrees(knot), y=float(ratio), keys=keys)


def _radii(result: GearPairResult) -> Chart:
    table = result.centrodes_of_phases
    lines = {"driver": table["r1_mm"]}
    if not result.pair.on_rack:
        lines["driven"] = table["r2_mm"]
    return _chart(result, "Radii of the centrodes", "radius, mm", table["phi1_deg"], lines)


def _curvature(result: GearPairResult) -> Chart:
    table = result.centrodes_of_phases
    with np.errstate(divide="ignore"):
        lines = {"driver": 1.0 / table["rho1_mm"], "driven": 1.0 / table["rho2_mm"]}
    limits: dict[float, Limit] = {}
    for gear in result.gears:
        convex, concave = undercut_curvatures(gear)
        for value, side in ((convex, "convex"), (-concave, "concave")):
            limits.setdefault(value, Limit(label=f"limit of undercut, {side}", value=value))
    title = "Curvature of the centrodes (positive: convex towards the tips)"
    phi1 = table["phi1_deg"]
    return _chart(result, title, "curvature, 1/mm", phi1, lines, [*limits.values()])


def _pressure_angle(result: GearPairResult) -> Chart:
    phi1, pair = result.phases, result.pair
    r, slope = pair.rolling.radii(phi1 % result.law.period if result.law.lobes.closed else phi1, 1)
    angles = result.subject.pressure_at(np.arctan(slope / r))
    lines = {f"driving {direction}": np.degrees(angle) for direction, angle in angles.items()}
    limit = math.degrees(limit_of(KIND, "pressure-angle", result.design.limits))
    limits = [Limit(label="limit", value=limit)]
    title, y = "Pressure angle at the pitch point", "pressure angle, deg"
    return _chart(result, title, y, np.degrees(phi1), lines, limits)


def _contact_ratio(result: GearPairResult) -> Chart:
    table = result.contact_ratios
    limit = limit_of(KIND, "contact-ratio", result.design.limits)
    lines = []
    for side, label in zip((DRIVE, COAST), _SIDES.values(), strict=True):
        rows = table["side"] == side
        x, y = (table[name][rows].astype(float) for name in ("tooth1", "contact_ratio"))
        lines.append(Line(label=label, x=x, y=y, dots=True))
    return Chart(
        title="Contact ratio of each pair of teeth, as designed",
        x="tooth of the driver",
        y="contact ratio",
        lines=tuple(lines),
        limits=(Limit(label="limit", value=limit),),
    )


def _by_pair(result: GearPairResult, table: Columns, y: Array, label: str) -> Line:
    """Return one line for each pair of teeth from values at points of contact."""
    apart = _APART * math.degrees(np.diff(result.phases).max())
    x, tooth = table["phi1_deg"], table["tooth1"]
    order = np.lexsort([x, tooth])
    x, y, tooth = x[order], y[order], tooth[order]
    # a pair in contact at 0 deg appears at both ends
    cuts = np.flatnonzero((np.diff(tooth) != 0) | (np.diff(x) > apart)) + 1
    return Line(label=label, x=np.insert(x, cuts, np.nan), y=np.insert(y, cuts, np.nan))


def _sliding(result: GearPairResult) -> Chart:
    tables = result.paths_of_contact.items()
    return Chart(
        title="Sliding on the driver's flank, as designed (positive: towards the tip)",
        x=DRIVER,
        y="sliding per driver angle, mm/rad",
        lines=tuple(
            _by_pair(result, table, table["sliding_mm_per_rad"], _SIDES[side])
            for side, table in tables
        ),
    )


def _contact_patch(result: GearPairResult) -> Chart:
    """Return the areas of contact patches in closed form: 003, figs. 2.34 to 2.38."""
    ahead = result.design.meshing.overclosure
    table = result.paths_of_contact["drive" if ahead > 0.0 else "coast"]
    lever = np.abs(table["x_mm"] * table["force_y"] - table["y_mm"] * table["force_x"])
    area = closed_area(abs(ahead) * lever, table["relative_curvature_per_mm"])
    x, phase = np.unique(table["phi1_deg"], return_inverse=True)
    # their sum; the mean of both sides of a knot, which may be one number in degrees
    total = np.bincount(phase, area * table["pairs"]) / np.bincount(phase)
    together = Line(label="all pairs of teeth", x=x, y=total)
    return Chart(
        title=f"Contact patches, driver advanced by {formatted(math.degrees(ahead), FEW)} deg",
        x=DRIVER,
        y="area of overlap, mm2",
        lines=(_by_pair(result, table, area, "each pair of teeth"), together),
    )


def _transmission_error(result: GearPairResult) -> Chart:
    leads = []
    for side, points in result.touching.items():
        pairs = result.flanks_of(side)
        leads.append((pairs, first_touch(pairs, result.phases, points)[0]))
    return transmission_chart(result, "as designed", result.phases, leads)


def transmission_chart(
    result: GearPairResult,
    how: str,
    phi1: Array,
    leads: Sequence[tuple[FlankPairs, Array]],
) -> Chart:
    """Return the chart of the lag of the driven element, minus its mean.

    Parameters
    ----------
    result : GearPairResult
        The pair.
    how : str
        How it is mounted, in words.
    phi1 : (n,) array, rad
        Driver angles.
    leads : sequence of (FlankPairs, (n,) array)
        Sides as mounted, with leads of the driven element at first contact, rad or mm; infinite
        without contact.

    Returns
    -------
    Chart
    """
    lines: dict[str, Array] = {}
    for pairs, lead in leads:
        lag = np.where(np.isfinite(lead), -lead, np.nan)
        error = lag - float(np.nanmean(lag))
        error[np.abs(error) <= known_to(pairs, phi1)] = 0.0
        lines[_SIDES["drive" if pairs.side == DRIVE else "coast"]] = error
    driven, unit = "rack" if result.pair.on_rack else "driven wheel", result.pair.rolling.guide.unit
    title = f"Transmission error, {how} (lag minus its mean)"
    return _chart(result, title, f"lag of the {driven}, {unit}", np.degrees(phi1), lines)


CHARTS: Final[Charts] = {
    "ratio": _ratio,
    "pressure_angle": _pressure_angle,
    "contact_ratio": _contact_ratio,
    "position": _position,
    "radii": _radii,
    "curvature": _curvature,
    "sliding": _sliding,
    "contact_patch": _contact_patch,
    "transmission_error": _transmission_error,
}
"""Functions that return the charts by name; the report leads with the first three."""


def scene(result: GearPairResult, places: int = PLACES) -> Scene:
    """Return both wheels with their centrodes, points of contact, and the pitch point.

    Parameters
    ----------
    result : GearPairResult
        The pair; of stepped wheels the lowest step is on top, with its points of contact.
    places : int
        Steps of the driver.

    Returns
    -------
    Scene
        As designed: finished teeth in contact, the driven element behind by the lag of `contact`.
    """
    guide, pose = result.pair.rolling.guide, result.design.output.pose
    phi1 = result.turn(places)
    end = float(phi1[-1])
    names = ("driver", "rack" if result.pair.on_rack else "driven wheel")
    poses = result.pair.rolling.poses(phi1)
    wheels = zip(result.gears, result.parts, names, result.centrode_paths, poses, strict=True)
    bodies = [_stepped(*wheel) for wheel in wheels]
    size = CROSS_SIZE * (abs(result.pair.shift) or float(np.ptp(result.gear1.outline)))
    shafts = (0.0, result.pair.shift) if guide.turns else (0.0,)
    crosses = tuple(Feature(layer=CENTER, shape=Cross(center=x, size=size)) for x in shafts)
    lowest = [steps[0] for steps in bodies]
    behind = [step for steps in bodies for step in steps[:0:-1]]
    radius = result.pair.rolling.tracks[0].frames(phi1).p
    return Scene(
        title=result.design.name,
        driver=DRIVER,
        places=np.degrees(phi1),
        closed=result.pair.closed,
        start=float(np.degrees(pose % end if result.pair.closed else min(max(pose, 0.0), end))),
        bodies=(*behind, *(lowest[::-1] if result.pair.internal else lowest), still(crosses, phi1)),
        contacts={side: _contacts(result, phi1, side) for side in get_args(Side)},
        pitch=radius * np.exp(-1j * phi1),
    )


def _stepped(gear: Gear, part: Part, called: str, path: Path, pose: Pose) -> list[MovingBody]:
    """Return the steps of a wheel as bodies that move together, the lowest with its teeth."""
    # the toothed edge first: for a ring the inner one
    lowest = sorted(part_features(part), key=lambda one: one.shape is not part.contour)
    first = MovingBody(
        name=part.name,
        called=called,
        features=(*lowest, Feature(layer=CENTRODE, shape=path)),
        pose=pose,
        teeth=gear.profile.teeth[1],
    )
    others = [
        MovingBody(
            name=part.name,
            called=f"{called}, step {step + 1}",
            features=part_features(part, step),
            pose=pose,
        )
        for step in range(1, len(part.contours))
    ]
    return [first, *others]


def _contacts(result: GearPairResult, phi1: Array, side: Side) -> ContactPoints:
    """Return points of contact on one side of the driver's teeth, from charts if computed."""
    pairs, at = result.flanks_of(side), np.arange(len(phi1))
    if len(phi1) == CENTRODE_POINTS + 1:
        touching, at = result.touching[side], np.searchsorted(result.phases, phi1)
    else:
        touching = contacts(pairs, phi1)
    chosen = np.isin(touching.step, at)
    j, first = touching.pair[chosen], [gear.profile.teeth[0][0] for gear in result.gears]
    return ContactPoints(
        start=np.searchsorted(touching.step[chosen], np.append(at, at[-1] + 1)),
        point=touching.point[chosen],
        force=touching.force[chosen],
        teeth=np.column_stack([wheel.number(j) for wheel in pairs.wheels]) - first + 1,
    )
