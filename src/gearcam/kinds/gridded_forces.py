"""The study of forces of cams in space: what their kinds add to that of all cams."""

from __future__ import annotations

from functools import partial
from typing import TYPE_CHECKING, Any

import numpy as np

from gearcam.base.facts import Fact, extent
from gearcam.kinds.follower_forces import MoreOfForces, forces_of
from gearcam.mechanics.hertz import line_pressure
from gearcam.pictures.charts import Chart, Line
from gearcam.spatial.loaded import ALONG

if TYPE_CHECKING:
    from collections.abc import Mapping

    from gearcam.base.facts import Tree
    from gearcam.kinds.gridded import GriddedCam
    from gearcam.mechanics.force_checks import Loaded
    from gearcam.results.study import Progress, StudyResult


def study_forces(result: GriddedCam, progress: Progress) -> StudyResult:
    """Return the study of the forces of a cam in space (see `gearcam.spatial.loaded`).

    Parameters
    ----------
    result : GriddedCam
        The cam.
    progress : Progress
        Called with what is computed, the number done and their total.

    Returns
    -------
    StudyResult

    Raises
    ------
    InfeasibleError
        If the cam is impossible, a wall is undercut, or no stiffness keeps the follower on the cam.
    """
    more = MoreOfForces(
        findings=tuple,
        columns=_columns,
        charts=partial(_charts, result),
        facts=partial(_facts, result),
    )
    return forces_of(result, progress, more)


def _facts(result: GriddedCam, loaded: Loaded) -> Tree:
    """Return how many rollers carry, and what is taken for granted."""
    carrying = np.zeros(len(loaded.x), dtype=int)
    for number, touch in enumerate(result.touches):
        rows = loaded.statics.carrying == number
        carrying[rows] = touch.rollers(loaded.x[rows])
    most = int(carrying.max())
    label = "rollers that carry at a time"
    tree: Tree = {
        "shared": Fact("shared as by perfect parts", "load along the rollers", shown=True)
    }
    if most > 1:
        tree["rollers"] = Fact(extent(int(carrying[carrying > 0].min()), most), label, shown=True)
    return tree


def _columns(loaded: Loaded) -> dict[str, Any]:
    """Return the line load where the pressure is largest."""
    return {"line_load_n_mm": loaded.statics.force / loaded.statics.width}


def _charts(result: GriddedCam, loaded: Loaded, _: Mapping[str, Any]) -> dict[str, Chart]:
    """Return line load and pressure along the rollers, where the normal force is largest."""
    statics = loaded.statics
    if np.isnan(statics.force).all():
        return {}
    top = int(np.nanargmax(statics.force))
    touch = result.touches[int(statics.carrying[top])]
    pressed = touch.pressed(loaded.x[top : top + 1])
    places, loads, curvature = (one.reshape(-1, ALONG) for one in pressed)
    loads = statics.force[top] * loads
    pressure = line_pressure(loads, curvature, result.design.material)
    rollers = np.flatnonzero(loads.any(axis=1))
    if not rollers.size:
        return {}
    where = f"along the rollers {loaded.at(top)}, where the normal force is largest"

    def chart(title: str, axis: str, values: Any) -> Chart:
        lines = tuple(
            Line(label=f"roller {number}", x=places[one], y=values[one])
            for number, one in enumerate(rollers, start=1)
        )
        return Chart(title=f"{title} {where}", x="place along the roller, mm", y=axis, lines=lines)

    return {
        "line_load": chart("Line load", "line load, N/mm", loads),
        "roller_pressure": chart("Contact pressure", "contact pressure, MPa", pressure),
    }
