"""The charts of a cam, over cam angle or travel."""

from __future__ import annotations

import math
from functools import partial
from typing import TYPE_CHECKING, Final

import numpy as np

from gearcam.base.findings import limit_of
from gearcam.base.numerals import formatted
from gearcam.cams.checks import KIND, pressure_limits
from gearcam.kinds.cam.build import pressure_column, rho_column
from gearcam.parts import checks  # noqa: F401  (its checks register themselves)
from gearcam.parts.blank import KIND as PARTS_KIND
from gearcam.pictures.charts import Chart, Charts, Limit, Line, MarkedPlace, knot_marks

if TYPE_CHECKING:
    from gearcam.kinds.cam.build import CamResult

_TIMES: Final = 6.0
"""Largest curvature drawn, in curvatures below which nine tenths of all lie, or that of the roller:
an undercut or nearly sharp profile has no largest one, and would leave no room for the rest."""


def places_of(result: CamResult) -> tuple[str, str]:
    """Return the column of cam angles or travels, and its axis label."""
    driver = result.driver
    return driver.column, f"{driver.called} {driver.symbol}, {driver.unit}"


def knots_of(result: CamResult) -> tuple[MarkedPlace, ...]:
    """Return marks at the knots of the motion."""
    driver = result.driver
    return knot_marks(driver.scale * np.asarray(result.program.knots), 0.0, driver.whole)


def _of_time(name: str, result: CamResult) -> Chart | None:
    drive = result.design.drive
    timed = result.cam.motions[0].timed_scales(drive.speed)
    for column in timed:
        if column.startswith(name):
            unit = column.removeprefix(f"{name}_").replace("_", "/", 1)
            places, label = places_of(result)
            table = result.motion_of_turn
            return Chart(
                title=f"{name.capitalize()} of the follower at {drive.named}",
                x=label,
                y=f"{name}, {unit}",
                lines=(Line(label=name, x=table[places], y=table[column]),),
                marks=knots_of(result),
            )
    return None


def _of_lift(name: str, result: CamResult) -> Chart:
    table = result.motion_of_turn
    column = next(column for column in table if column.startswith(name))
    unit = column.removeprefix(f"{name}_").replace("_per_", "/")
    places, label = places_of(result)
    lines = [Line(label=name, x=table[places], y=table[column])]
    given = result.program.given
    if given is not None and name == "lift":
        theta, lift = given.T
        x, y = result.driver.scale * theta, result.follower.lift_unit[0] * lift
        lines.append(Line(label="given points, before smoothing", x=x, y=y, dots=True))
    title, unit = f"{name.capitalize()} of the follower", f"{name}, {unit}"
    return Chart(title=title, x=label, y=unit, lines=(*lines,), marks=knots_of(result))


def _pressure_angle(result: CamResult) -> Chart | None:
    table = result.motion_of_turn
    if not any(np.any(table[pressure_column(one)]) for one in result.cam.motions):
        return None
    given = limit_of(KIND, "pressure-angle", result.design.limits)
    found = pressure_limits(result.follower, given)
    same = found["rise"] == found["return"]
    limits = {"limit" if same else f"limit, {kind}": one for kind, one in found.items()}
    places, label = places_of(result)
    return Chart(
        title="Pressure angle",
        x=label,
        y="pressure angle, deg",
        lines=tuple(
            Line(
                label=f"cam {one.key}" if one.key else "pressure angle",
                x=table[places],
                y=table[column],
            )
            for one in result.cam.motions
            for column in (pressure_column(one),)
        ),
        limits=tuple(
            Limit(label=label, value=sign * math.degrees(one))
            for label, one in limits.items()
            for sign in (1.0, -1.0)
        ),
        marks=knots_of(result),
    )


def _radii(result: CamResult) -> dict[str, str]:
    """Return the columns of radii of the motion's table, by labels."""
    pitches = {
        f"pitch curve{f' of cam {one.key}' if one.key else ''}": rho_column("pitch", one)
        for one in result.cam.motions
    }
    walls = {
        f"{one.called} before trimming": rho_column("profile", one) for one in result.cam.walls
    }
    return pitches | walls


def _curvature(result: CamResult) -> Chart:
    table, radius = result.motion_of_turn, result.follower.radius
    with np.errstate(divide="ignore"):
        lines = {label: 1.0 / table[name] for label, name in _radii(result).items()}
    if not result.follower.has_centre:
        del lines["pitch curve"]
    bent = np.abs(np.concatenate([*lines.values()]))
    bent = bent[np.isfinite(bent) & (bent > 0.0)]
    usual = _TIMES * float(np.percentile(bent, 90)) if bent.size else 0.0
    largest = max(usual, 1.0 / radius if radius else 0.0)
    tool = limit_of(PARTS_KIND, "tool-too-large", result.design.limits)
    limits = []
    if tool and any(math.isfinite(wall.profile_radius[1]) for wall in result.cam.walls):
        label = f"concave limit for a tool of {formatted(tool)} mm"
        limits.append(Limit(label=label, value=-2.0 / tool))
    rollers = {one.side / one.follower.radius: one for one in result.cam.walls if radius}
    for value, wall in rollers.items():
        what = "convex" if wall.side > 0 else "concave"
        limits.append(Limit(label=f"roller ({what} pitch curve)", value=value))
    places, label = places_of(result)
    return Chart(
        title="Curvature (positive: convex)",
        x=label,
        y="curvature, 1/mm",
        lines=tuple(
            Line(
                label=label if seen.all() else f"{label}, peaks outside this chart",
                x=table[places],
                y=np.where(seen, values, np.nan),
            )
            for label, values in lines.items()
            for seen in (np.abs(values) <= largest,)
        ),
        limits=tuple(limits),
        marks=knots_of(result),
    )


_DERIVED: Final = ("velocity", "acceleration", "jerk")


def _sizes(result: CamResult) -> Chart | None:
    if result.solution is None:
        return None
    from gearcam.kinds.cam.solve import region

    return region(result)


CHARTS: Final[Charts] = {
    "sizes": _sizes,
    "lift": partial(_of_lift, "lift"),
    "pressure_angle": _pressure_angle,
    "curvature": _curvature,
    **{name: partial(_of_lift, name) for name in _DERIVED},
    **{f"{name}_in_time": partial(_of_time, name) for name in _DERIVED},
}
"""Functions that return the charts by name; the report leads with the first three."""
