"""The study of walls made in the developed plane, and the solid at rising resolution."""

from __future__ import annotations

import math
from collections.abc import Mapping
from typing import TYPE_CHECKING, Any, Final

import numpy as np

from gearcam.base.facts import Fact
from gearcam.base.numerals import formatted
from gearcam.pictures.charts import Chart, Line
from gearcam.results.ladders import Ladder, Ladders, grid_ladder
from gearcam.results.study import StudyResult
from gearcam.spatial.developed import developed
from gearcam.spatial.extremes import Spot

if TYPE_CHECKING:
    from gearcam.kinds.spatial_cam.result import SpatialCamResult
    from gearcam.spatial.developed import Developed


def study_developed(result: SpatialCamResult, progress: Any) -> StudyResult:  # noqa: ARG001
    """Return the errors of the developed plane.

    Parameters
    ----------
    result : SpatialCamResult
        The cam.
    progress : callable
        Not told anything: it takes a moment.

    Returns
    -------
    StudyResult
    """
    settings = result.design.developed
    theta = np.linspace(0.0, 2.0 * math.pi, settings.steps, endpoint=False)
    cam = result.cam
    with result.stage("developed"):
        walls = {wall.key: developed(wall, theta, settings.radii) for wall in cam.walls}
    columns: dict[str, list[Any]] = {}
    for key, found in walls.items():
        shape = found.error.shape
        rows = {
            "wall": np.full(shape, key),
            "theta_deg": np.degrees(found.theta)[:, None] * np.ones(shape),
            "radius_mm": found.radius * np.ones(shape),
            "azimuth_deg": cam.hand * np.degrees(found.azimuth),
            "z_mm": found.height,
            "error_mm": found.error,
        }
        for name, values in rows.items():
            columns.setdefault(name, []).append(values.ravel())
    return StudyResult(
        result=result,
        study=result.kind.studies["developed"],
        file="developed.csv",
        table={name: np.concatenate(values) for name, values in columns.items()},
        group=_facts(walls),
        study_findings=(),
        drawn=lambda: _charts(walls),
    )


def _facts(walls: Mapping[str, Developed]) -> dict[str, Any]:
    """Return the widest gap and the deepest overlap with the roller."""
    tree: dict[str, Any] = {}
    for name, sign, meaning in (
        ("gap_mm", 1.0, "widest gap between the roller and a wall of the developed plane"),
        ("jam_mm", -1.0, "deepest such wall inside the roller"),
    ):
        key, found = max(walls.items(), key=lambda item: float((sign * item[1].error).max()))
        k, j = np.unravel_index(np.argmax(sign * found.error), found.error.shape)
        most = max(0.0, float(sign * found.error[k, j]))
        spot = Spot(theta=float(found.theta[k]), x=float(found.radius[j]), value=most)
        tree[name] = Fact(spot.value, meaning, place=f"{key} wall, {spot.place}", shown=True)
    largest = max(float(np.abs(one.error).max()) for one in walls.values())
    return {"largest_mm": Fact(largest, "largest error of the developed plane"), **tree}


def _charts(walls: Mapping[str, Developed]) -> dict[str, Chart]:
    """Return the errors over the cam angle, at floor, mean radius and outside."""
    lines = [
        Line(
            label=f"{key} wall, at {formatted(float(found.radius[j]), 4)} mm",
            x=np.degrees(found.theta),
            y=found.error[:, j],
        )
        for key, found in walls.items()
        for j in (0, len(found.radius) // 2, len(found.radius) - 1)
    ]
    return {
        "error": Chart(
            title="Error of walls constructed in the developed plane: a gap above 0, a jam below",
            x="cam angle theta, deg",
            y="error, mm",
            lines=tuple(lines),
        )
    }


_LEAST: Final = 24
"""Least number of cam angles of a level."""


def _solid(result: SpatialCamResult) -> Ladder:
    """Return the error of the volume; a carved solid, which takes long, is not made finer."""
    return grid_ladder(result, _LEAST, finer=not result.carved)


LADDERS: Final[Ladders] = {"solid": _solid}
"""What `gearcam accuracy` can measure."""
