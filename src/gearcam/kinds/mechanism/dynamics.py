"""The study of the motion of a mechanism under its motor."""

from __future__ import annotations

from dataclasses import replace
from typing import TYPE_CHECKING, Any, Final

import numpy as np

from gearcam.base.errors import InfeasibleError
from gearcam.base.facts import Fact
from gearcam.dynamics.machine import ReducedMachine
from gearcam.dynamics.tabled import Tabled
from gearcam.kinds.machine_motion import MachineRun, speed_powers, usual_speed
from gearcam.kinds.machine_motion import demand as demand_run
from gearcam.kinds.mechanism.loaded import work_of
from gearcam.linkages.efforts import INERTIA
from gearcam.linkages.work import VirtualWork
from gearcam.numeric.chebyshev import NotSmoothError
from gearcam.results.study import StudyResult

if TYPE_CHECKING:
    from gearcam.kinds.mechanism.result import MechanismResult
    from gearcam.numeric.arrays import Array
    from gearcam.results.study import Progress

_NM: Final = 1e-3
"""N m of a N mm."""

_EXACT: Final = 1e-11
"""Error of tables over the largest value."""

_PROBES: Final = 97
"""Places at which their degree is looked for."""


def demand(design: Any) -> None:
    """Refuse a run that cannot be (see `gearcam.kinds.machine_motion.demand`)."""
    demand_run(design, design.drive[0].speed, "drive[0].speed_rpm")


def machine_of(work: VirtualWork, speed: float) -> ReducedMachine:
    """Return a mechanism reduced to its driver.

    Parameters
    ----------
    work : VirtualWork
        What acts on it.
    speed : float, rad/s
        A usual speed of the driver.

    Raises
    ------
    InfeasibleError
        If loads are no polynomial of the speed, or not smooth.
    """

    def moment(q: Array, omega: float) -> Array:
        parts = replace(work, speed=omega).parts(q)
        whole = (np.asarray(one.c[0]) for part, one in parts.items() if part != INERTIA)
        return _NM * sum(whole, start=np.zeros(q.shape))

    places = np.linspace(*work.linkage.span, _PROBES)
    coefficients = speed_powers(moment, places, speed)

    def rows(q: Array) -> Array:
        inertia = work.reduced_inertia(q, 1).derivatives()
        return np.stack([*(one + np.zeros(q.shape) for one in inertia), *coefficients(q)])

    largest = np.abs(rows(places)).max(axis=1)
    # of an even inertia the derivative is rounding, and the moment of loads that do no work
    usual = largest[0] * speed ** (4.0 - np.arange(len(largest)))
    sizes = np.where(largest <= _EXACT * usual, usual, 0.0)
    sizes[:2] = 0.0, largest[0]
    try:
        tabled = Tabled(rows, work.knots, _EXACT, closed=work.linkage.closed, sizes=sizes)
    except NotSmoothError as error:
        what = f"what acts on the mechanism is {'not smooth' if error.finite else 'not finite'}"
        where = f"{np.degrees(error.place):.6g} deg"
        raise InfeasibleError(f"{what} at {where}", where="load") from error
    return ReducedMachine(rows=tabled, knots=work.knots)


def study_dynamics(result: MechanismResult, progress: Progress) -> StudyResult:
    """Return the study of the motion of a mechanism.

    Parameters
    ----------
    result : MechanismResult
        The mechanism.
    progress : Progress
        Called with what is computed, the number done and their total.

    Returns
    -------
    StudyResult
        Its rows are those of ``dynamics.csv``.

    Raises
    ------
    InfeasibleError
        If the mechanism does not close, it has no regime, or a load is not finite.
    """
    design = result.design
    progress("machine", 0, 2)
    with result.stage("machine"):
        work = work_of(design, result.linkage, result.drives)
        speed = design.drive[0].speed
        machine = machine_of(work, usual_speed(design.motor, speed))
    run = MachineRun(
        machine=machine,
        design=design,
        speed=speed,
        place=result.place,
        axis=result.axis,
        symbol=result.driver[0],
    )
    progress("motion", 1, 2)
    assumed = Fact("no friction", "assumed", shown=True)
    return run.study(result, {"assumptions": assumed})
