"""The charts of a globoidal cam, over the cam angle."""

from __future__ import annotations

from functools import partial
from typing import TYPE_CHECKING, Final

from gearcam.base.findings import limit_of
from gearcam.kinds.gridded_charts import motion_chart, pressure_chart, spread_chart
from gearcam.pictures.charts import Chart, Charts
from gearcam.spatial.globoidal_checks import KIND

if TYPE_CHECKING:
    from gearcam.kinds.globoidal_cam.build import GloboidalCamResult


def _angle(result: GloboidalCamResult) -> Chart:
    return motion_chart(result, "turret", "Angle of the turret", "angle")


def _of_turret(name: str, result: GloboidalCamResult) -> Chart:
    return motion_chart(result, name, f"{name.capitalize()} of the turret")


def _pressure(result: GloboidalCamResult) -> Chart:
    labels = {"top": "at the tops of the ribs", "mean": "in the middle", "end": "at its end"}
    limit = limit_of(KIND, "pressure-angle", result.design.limits)
    title = "Pressure angle of the roller nearest to the middle"
    return pressure_chart(result, title, labels, limit)


def _spread(result: GloboidalCamResult) -> Chart:
    places = {"end of the roller": result.cam.reach, "top of the rib": result.cam.top}
    title = "Spread of the walls at the roller nearest to the middle: undercut below 0"
    return spread_chart(result, title, places)


CHARTS: Final[Charts] = {
    "turret": _angle,
    "pressure_angle": _pressure,
    "spread": _spread,
    "velocity": partial(_of_turret, "velocity"),
    "acceleration": partial(_of_turret, "acceleration"),
    "jerk": partial(_of_turret, "jerk"),
}
"""Charts by name; the report leads with the first three."""
