"""The charts of a globoidal cam, over the cam angle."""

from __future__ import annotations

import math
from functools import partial
from typing import TYPE_CHECKING, Final

import numpy as np

from gearcam.base.findings import limit_of
from gearcam.pictures.charts import Chart, Charts, Limit, Line, knot_marks
from gearcam.spatial.globoidal_checks import KIND

if TYPE_CHECKING:
    from gearcam.kinds.globoidal_cam.build import GloboidalCamResult
    from gearcam.pictures.charts import MarkedPlace

DRIVER: Final = "cam angle theta, deg"
"""Label of the axis of cam angles."""


def _knots(result: GloboidalCamResult) -> tuple[MarkedPlace, ...]:
    return knot_marks(np.degrees(np.asarray(result.program.knots)), 0.0, 360.0)


def _of_turret(name: str, title: str, result: GloboidalCamResult) -> Chart:
    table = result.motion()
    column = next(one for one in table if one.startswith(name))
    unit = column.removeprefix(f"{name}_").replace("_per_", "/")
    return Chart(
        title=title,
        x=DRIVER,
        y=f"{'angle' if name == 'turret' else name}, {unit}",
        lines=(Line(label=name, x=table["theta_deg"], y=table[column]),),
        marks=_knots(result),
    )


def _pressure(result: GloboidalCamResult) -> Chart:
    table = result.motion()
    limit = limit_of(KIND, "pressure-angle", result.design.limits)
    labels = {"top": "at the tops of the ribs", "mean": "in the middle", "end": "at its end"}
    return Chart(
        title="Pressure angle of the roller nearest to the middle",
        x=DRIVER,
        y="pressure angle, deg",
        lines=tuple(
            Line(label=label, x=table["theta_deg"], y=table[f"pressure_angle_{word}_deg"])
            for word, label in labels.items()
        ),
        limits=(Limit(label="limit", value=math.degrees(limit)),),
        marks=_knots(result),
    )


def _spread(result: GloboidalCamResult) -> Chart:
    theta, cam = result.angles, result.cam
    lines = []
    for wall in cam.walls:
        for label, x in (("end of the roller", cam.reach), ("top of the rib", cam.top)):
            spread = wall.contact(theta, np.full((len(theta), 1), x)).spread[:, 0]
            lines.append(Line(label=f"{wall.key} wall, {label}", x=np.degrees(theta), y=spread))
    return Chart(
        title="Spread of the walls at the roller nearest to the middle: undercut below 0",
        x=DRIVER,
        y="spread, mm",
        lines=tuple(lines),
        limits=(Limit(label="undercut", value=0.0),),
        marks=_knots(result),
    )


CHARTS: Final[Charts] = {
    "turret": partial(_of_turret, "turret", "Angle of the turret"),
    "pressure_angle": _pressure,
    "spread": _spread,
    "velocity": partial(_of_turret, "velocity", "Velocity of the turret"),
    "acceleration": partial(_of_turret, "acceleration", "Acceleration of the turret"),
    "jerk": partial(_of_turret, "jerk", "Jerk of the turret"),
}
"""Charts by name; the report leads with the first three."""
