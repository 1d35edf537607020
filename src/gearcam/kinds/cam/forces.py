"""The study of forces of a plane cam: contact pressure along its walls, sizes that keep a limit."""

from __future__ import annotations

from functools import partial
from typing import TYPE_CHECKING, Any

import numpy as np

from gearcam.kinds.cam.hints import enlarged
from gearcam.kinds.follower_forces import MoreOfForces, forces_of, on_each_way
from gearcam.pictures.charts import Chart, Line

if TYPE_CHECKING:
    from collections.abc import Mapping

    from gearcam.kinds.cam.result import CamResult
    from gearcam.mechanics.force_checks import Loaded
    from gearcam.results.study import Progress, StudyResult


def study_forces(result: CamResult, progress: Progress) -> StudyResult:
    """Return the study of the forces of a cam (see `forces_of`).

    Parameters
    ----------
    result : CamResult
        The cam.
    progress : Progress
        Called with what is computed, the number done and their total.

    Returns
    -------
    StudyResult

    Raises
    ------
    InfeasibleError
        If the cam is impossible, or no stiffness keeps the follower on it.
    """
    more = MoreOfForces(partial(enlarged, result), partial(_along, result))
    return forces_of(result, progress, more)


def _along(result: CamResult, loaded: Loaded, columns: Mapping[str, Any]) -> dict[str, Chart]:
    """Return the chart of the contact pressure along each wall."""
    pressure = np.ma.filled(columns["pressure_mpa"], np.nan)
    if not np.isfinite(pressure).any():
        return {}
    lines = tuple(
        Line(
            label=(f"{touch.key} wall" if touch.key else "profile") + way,
            x=touch.along(loaded.x[rows]),
            y=np.where(columns["wall"] == number, pressure, np.nan)[rows],
        )
        for number, touch in enumerate(result.cam.touches, start=1)
        for way, rows in on_each_way(loaded)
    )
    where, title = "from the contact at the start, mm", "Contact pressure along the profile"
    chart = Chart(title=title, x=f"arc length {where}", y="contact pressure, MPa", lines=lines)
    return {"profile_pressure": chart}
