"""The charts of a cam in space, over the cam angle."""

from __future__ import annotations

from functools import partial
from typing import TYPE_CHECKING, Final

from gearcam.kinds.gridded_charts import motion_chart, pressure_chart, spread_chart
from gearcam.pictures.charts import Chart, Charts
from gearcam.spatial import checks

if TYPE_CHECKING:
    from gearcam.kinds.spatial_cam.build import SpatialCamResult


def _of_lift(name: str, result: SpatialCamResult) -> Chart:
    return motion_chart(result, name, f"{name.capitalize()} of the follower")


def _pressure(result: SpatialCamResult) -> Chart:
    labels = {"inner": "at the roller's inner end", "mean": "in the middle", "outer": "outside"}
    limit = checks.allowed_pressure(result.cam, result.design.limits)
    return pressure_chart(result, "Pressure angle", labels, limit)


def _spread(result: SpatialCamResult) -> Chart:
    places = {"floor": result.cam.floor, "outside": result.cam.outer_radius}
    return spread_chart(result, "Spread of the walls: undercut below 0", places)


CHARTS: Final[Charts] = {
    "lift": partial(_of_lift, "lift"),
    "pressure_angle": _pressure,
    "spread": _spread,
    "velocity": partial(_of_lift, "velocity"),
    "acceleration": partial(_of_lift, "acceleration"),
    "jerk": partial(_of_lift, "jerk"),
}
"""Charts by name; the report leads with the first three."""
