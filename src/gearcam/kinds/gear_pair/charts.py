"""The charts of a gear pair: over a turn of the driver, or its travel, and over its teeth."""

from __future__ import annotations

import math
from dataclasses import replace
from functools import partial
from typing import TYPE_CHECKING, Final

import numpy as np

from gearcam.charts import Chart, Charts, Limit, Line, with_both_sides
from gearcam.findings import limit_of
from gearcam.gears.checks import KIND, undercut_curvatures
from gearcam.gears.contact import COAST, DRIVE
from gearcam.kinds.gear_pair.columns import centrode_columns
from gearcam.numeric.arrays import Array

if TYPE_CHECKING:
    from gearcam.kinds.gear_pair.build import GearPairResult

DRIVER: Final = "driver angle phi1, deg"
"""What charts and scenes call the driver's place."""

_APART: Final = 1.5
"""Steps between points of contact of a pair that is not in contact between them."""

_SIDES: Final = {"drive": "flanks that drive", "coast": "flanks that hold back"}


def _phases(result: GearPairResult) -> Array:
    """Return driver angles, rad, of one turn or the whole travel, at both sides of all knots."""
    lobes, period = result.law.lobes, result.law.period
    phi1 = result.centrode_angles()
    knots = np.asarray(result.law.knots, dtype=float)
    if lobes.closed:
        phi1 = phi1[phi1 <= lobes.n1 * period]
        knots = np.concatenate([knots + lobe * period for lobe in range(lobes.n1)])
    return with_both_sides(phi1, knots)


def _of_centrodes(
    title: str, unit: str, names: dict[str, str], result: GearPairResult, *, bend: bool = False
) -> Chart:
    table = centrode_columns(result, _phases(result))
    with np.errstate(divide="ignore"):
        lines = tuple(
            Line(label=label, x=table["phi1_deg"], y=1.0 / table[name] if bend else table[name])
            for name, label in names.items()
            if name in table
        )
    return Chart(title=title, x=DRIVER, y=unit, lines=lines)


def _ratio(result: GearPairResult) -> Chart:
    if result.pair.on_rack:
        table = result.motion(_phases(result))
        line = Line(label="rack", x=table["phi1_deg"], y=table["velocity_mm_per_rad"])
        title, unit = "Velocity of the rack", "velocity, mm/rad"
        return Chart(title=title, x=DRIVER, y=unit, lines=(line,))
    return _of_centrodes("Transmission ratio", "ratio i21", {"ratio": "ratio i21"}, result)


def _curvature(result: GearPairResult) -> Chart:
    names = {"rho1_mm": "driver", "rho2_mm": "driven"}
    chart = _of_centrodes(
        "Curvature of the centrodes, positive where convex towards the tips",
        "curvature, 1/mm",
        names,
        result,
        bend=True,
    )
    found: dict[float, Limit] = {}
    for gear in result.gears:
        convex, concave = undercut_curvatures(gear)
        for value, what in ((convex, "convex"), (-concave, "concave")):
            found.setdefault(value, Limit(label=f"{what}, free of undercut", value=value))
    return replace(chart, limits=tuple(found.values()))


def _pressure_angle(result: GearPairResult) -> Chart:
    phi1, pair = _phases(result), result.pair
    r, slope = pair.rolling.radii(phi1 % result.law.period if pair.closed else phi1, 1)
    lean, alpha = np.arctan(slope / r), pair.rack.pressure_angle
    limit = limit_of(KIND, "pressure-angle", result.design.limits)
    return Chart(
        title="Pressure angle of the tooth force at the pitch point",
        x=DRIVER,
        y="pressure angle, deg",
        lines=tuple(
            Line(label=f"driving {way}", x=np.degrees(phi1), y=np.degrees(alpha + sign * lean))
            for way, sign in (("forward", -1.0), ("backward", 1.0))
        ),
        limits=(Limit(label="limit", value=math.degrees(limit)),),
    )


def _contact_ratio(result: GearPairResult) -> Chart:
    table = result.contact_ratios
    limit = limit_of(KIND, "contact-ratio", result.design.limits)
    lines = []
    for side, label in zip((DRIVE, COAST), _SIDES.values(), strict=True):
        own = table["side"] == side
        x, y = (table[name][own].astype(float) for name in ("tooth1", "contact_ratio"))
        lines.append(Line(label=label, x=x, y=y, dots=True))
    return Chart(
        title="Contact ratio by pair of teeth, as designed",
        x="tooth of the driver",
        y="contact ratio",
        lines=tuple(lines),
        limits=(Limit(label="limit", value=limit),),
    )


def _sliding(result: GearPairResult) -> Chart:
    phi1 = _phases(result)
    apart = _APART * math.degrees(np.diff(phi1).max())
    lines = []
    for side, label in _SIDES.items():
        found = result.contact(phi1, side)  # pyright: ignore[reportArgumentType]
        x, y, tooth = (found[name] for name in ("phi1_deg", "sliding_mm_per_rad", "tooth1"))
        order = np.lexsort([x, tooth])
        x, y = x[order], y[order]
        # a line for each pair of teeth; one that is in contact at 0 deg is met at both ends
        cuts = np.flatnonzero((np.diff(tooth[order]) != 0) | (np.diff(x) > apart)) + 1
        lines.append(Line(label=label, x=np.insert(x, cuts, np.nan), y=np.insert(y, cuts, np.nan)))
    return Chart(
        title="Sliding on the driver's flank, tip outward, as designed",
        x=DRIVER,
        y="sliding over the driver's speed, mm/rad",
        lines=tuple(lines),
    )


CHARTS: Final[Charts] = {
    "ratio": _ratio,
    "radii": partial(
        _of_centrodes,
        "Radii of the centrodes",
        "radius, mm",
        {"r1_mm": "driver", "r2_mm": "driven"},
    ),
    "curvature": _curvature,
    "pressure_angle": _pressure_angle,
    "contact_ratio": _contact_ratio,
    "sliding": _sliding,
}
"""What makes each chart."""
