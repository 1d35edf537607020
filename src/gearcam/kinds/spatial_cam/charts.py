"""The charts of a cam in space, over the cam angle."""

from __future__ import annotations

import math
from functools import partial
from typing import TYPE_CHECKING, Final

import numpy as np

from gearcam.pictures.charts import Chart, Charts, Limit, Line, knot_marks
from gearcam.spatial import checks

if TYPE_CHECKING:
    from gearcam.kinds.spatial_cam.build import SpatialCamResult
    from gearcam.pictures.charts import MarkedPlace

DRIVER: Final = "cam angle theta, deg"
"""Label of the axis of cam angles."""


def _knots(result: SpatialCamResult) -> tuple[MarkedPlace, ...]:
    return knot_marks(np.degrees(np.asarray(result.program.knots)), 0.0, 360.0)


def _of_lift(name: str, result: SpatialCamResult) -> Chart:
    table = result.motion()
    column = next(one for one in table if one.startswith(name))
    unit = column.removeprefix(f"{name}_").replace("_per_", "/")
    return Chart(
        title=f"{name.capitalize()} of the follower",
        x=DRIVER,
        y=f"{name}, {unit}",
        lines=(Line(label=name, x=table["theta_deg"], y=table[column]),),
        marks=_knots(result),
    )


def _pressure(result: SpatialCamResult) -> Chart:
    table, cam = result.motion(), result.cam
    limit = checks.allowed_pressure(cam, result.design.limits)
    labels = {"inner": "at the roller's inner end", "mean": "in the middle", "outer": "outside"}
    return Chart(
        title="Pressure angle",
        x=DRIVER,
        y="pressure angle, deg",
        lines=tuple(
            Line(label=label, x=table["theta_deg"], y=table[f"pressure_angle_{word}_deg"])
            for word, label in labels.items()
        ),
        limits=(Limit(label="limit", value=math.degrees(limit)),),
        marks=_knots(result),
    )


def _spread(result: SpatialCamResult) -> Chart:
    theta, cam = result.angles, result.cam
    lines = []
    for wall in cam.walls:
        for label, x in (("floor", cam.floor), ("outside", cam.outer_radius)):
            spread = wall.contact(theta, np.full((len(theta), 1), x)).spread[:, 0]
            lines.append(Line(label=f"{wall.key} wall, {label}", x=np.degrees(theta), y=spread))
    return Chart(
        title="Spread of the walls: undercut below 0",
        x=DRIVER,
        y="spread, mm",
        lines=tuple(lines),
        limits=(Limit(label="undercut", value=0.0),),
        marks=_knots(result),
    )


CHARTS: Final[Charts] = {
    "lift": partial(_of_lift, "lift"),
    "pressure_angle": _pressure,
    "spread": _spread,
    "velocity": partial(_of_lift, "velocity"),
    "acceleration": partial(_of_lift, "acceleration"),
    "jerk": partial(_of_lift, "jerk"),
}
"""Charts by name; the report leads with the first three."""
