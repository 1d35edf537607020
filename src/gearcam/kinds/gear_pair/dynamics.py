"""The study of the motion of a pair under its motor and load."""

from __future__ import annotations

from typing import TYPE_CHECKING, Any

from gearcam.base.errors import DesignError, MissingExtraError, Problem
from gearcam.dynamics.settings import START
from gearcam.kinds.gear_pair.drawn import DRIVER
from gearcam.kinds.gear_pair.forces import PairUnderLoad
from gearcam.kinds.gear_pair.pair_motion import PairRun, inertias, machine_of
from gearcam.kinds.machine_motion import demand as demand_run
from gearcam.kinds.machine_motion import usual_speed
from gearcam.laws.ratio.span import angle_text
from gearcam.results.study import StudyResult

if TYPE_CHECKING:
    from gearcam.kinds.gear_pair.result import GearPairResult
    from gearcam.results.study import Progress


def demand(design: Any) -> None:
    """Refuse a run that cannot be (see `gearcam.kinds.machine_motion.demand`).

    Parameters
    ----------
    design : GearPairDesign
        The design.

    Raises
    ------
    DesignError
        If the run is unfit, or what turns has no inertia.
    MissingExtraError
        If a library is not installed.
    """
    demand_run(design, design.drive.speed, "drive.speed_rpm")
    key, source = "dynamics.inertia_kg_m2", design.source
    if design.law_type == "rack":
        what = "the motion of a pair with a rack is not available"
        raise DesignError([Problem(what, file=source, key="law.type", allowed="two wheels")])
    for number, load in enumerate(design.load):
        if load.on == "wheel1":
            what = '"wheel1": the torque of the driver follows from the motor'
            problem = Problem(
                what, file=source, key=f"load[{number}].on", allowed="wheel2, and [motor]"
            )
            raise DesignError([problem])
    dense = all(design.blank.wheel(number).density is not None for number in (1, 2))
    needed = design.dynamics.elastic or not design.motor.turns_evenly
    if design.dynamics.inertia is None and not dense and needed:
        what = "is missing: the wheels have no density either"
        near = "moments of inertia of both shafts, or blank.density_kg_m3"
        raise DesignError([Problem(what, file=source, key=key, allowed=near)])
    if design.dynamics.elastic:
        _demand_elastic(design)


def _demand_elastic(design: Any) -> None:
    """Refuse elastic teeth that start from rest, turn nothing, or lack what computes them."""
    spec, source = design.dynamics, design.source
    if spec.run == START:
        what, near = '"start": elastic teeth begin at a speed', '"turns", or rigid = true'
        raise DesignError([Problem(what, file=source, key="dynamics.run", allowed=near)])
    if design.steps.count > 1:
        what, near = "elastic teeth of stepped wheels are not computed", "1, or rigid = true"
        raise DesignError([Problem(what, file=source, key="steps.count", allowed=near)])
    motor = design.motor
    turned = motor.turns_evenly or motor.flywheel
    if spec.inertia is not None and not (spec.inertia[1] and (spec.inertia[0] or turned)):
        what, key = "0: a shaft of elastic teeth has no inertia", "dynamics.inertia_kg_m2"
        raise DesignError([Problem(what, file=source, key=key, allowed="above 0 for both shafts")])
    if spec.finite_elements:
        MissingExtraError.unless("skfem", what="stiffness by finite elements", extra="stress")


def motion_of(result: GearPairResult, progress: Progress) -> PairRun:
    """Return a pair with the motor and the run of its design.

    Parameters
    ----------
    result : GearPairResult
        The pair.
    progress : Progress
        Called with what is computed, the number done and their total.

    Returns
    -------
    PairRun

    Raises
    ------
    DesignError
        If a load does not fit.
    InfeasibleError
        If the wheels are impossible, or friction locks the pair.
    """
    design = result.design
    progress("machine", 0, 2)
    under, inertia = PairUnderLoad(result), inertias(result)
    _ = under.sides  # timed separately
    with result.stage("machine"):
        machine = machine_of(under, inertia, usual_speed(design.motor, design.drive.speed))
    settings: dict[str, Any] = {
        "machine": machine,
        "design": design,
        "speed": design.drive.speed,
        "place": angle_text,
        "axis": DRIVER,
        "symbol": "phi1",
        "result": result,
    }
    if design.dynamics.elastic:
        from gearcam.kinds.gear_pair.elastic_motion import ElasticRun

        return ElasticRun(**settings, progress=progress)
    return PairRun(**settings)


def study_dynamics(result: GearPairResult, progress: Progress) -> StudyResult:
    """Return the study of the motion of a pair.

    Parameters
    ----------
    result : GearPairResult
        The pair.
    progress : Progress
        Called with what is computed, the number done and their total.

    Returns
    -------
    StudyResult
        Its rows are those of ``dynamics.csv``.

    Raises
    ------
    DesignError
        If a load does not fit.
    InfeasibleError
        If the wheels are impossible, the pair has no regime, or friction locks it.
    """
    run = motion_of(result, progress)
    progress("motion", 1, 2)
    return run.study(result, {})
