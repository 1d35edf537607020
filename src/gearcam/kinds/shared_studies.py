"""Studies that several kinds of design have."""

from __future__ import annotations

from typing import Any, Final

from gearcam.base.registry import deferred
from gearcam.results.studies import Study


def forces_study(compute: str, **more: Any) -> Study:
    """Return the study of the forces of a cam.

    Parameters
    ----------
    compute : str
        What computes it, as `deferred` names it.
    **more
        What else its entry has (see `Study`).
    """
    return Study(
        name="forces",
        key="forces",
        doc="Compute forces, torque, efficiency and contact pressure; write DIR/NAME/forces.csv.",
        done="computed",
        table="forces",
        compute=deferred(compute),
        demand=deferred("gearcam.kinds.under_load:demand"),
        **more,
    )


def dynamics_study(compute: str, demand: str, *, speed: str, **more: Any) -> Study:
    """Return the study of what is in motion: a machine, teeth, a follower.

    Parameters
    ----------
    compute, demand : str
        What computes it, and what refuses designs without it, as `deferred` names them.
    speed : str
        Dotted key of the speed of the driver.
    **more
        What else its entry has (see `Study`).
    """
    return Study(
        name="dynamics",
        key="dynamics",
        doc="Compute a machine, teeth or a follower in motion; write DIR/NAME/dynamics.csv.",
        done="computed",
        table="dynamics",
        compute=deferred(compute),
        demand=deferred(demand),
        alike=False,
        elsewhere={"speed": speed},
        **more,
    )


ACCURACY: Final = Study(
    name="accuracy",
    key="convergence",
    doc="Measure accuracy against run time; write DIR/NAME/accuracy.csv and accuracy.html.",
    done="measured",
    table="accuracy",
    compute=deferred("gearcam.kinds.shared:study_accuracy"),
    demand=deferred("gearcam.kinds.shared:demand_stages"),
    many=False,
    returns="a row for each level of each stage: how fine it is, its error, which order it falls "
    "with, and its time; order and error of the level that is used as facts.",
    example="""\
>>> import gearcam as gc
>>> design = gc.load("profiles/ellipse.toml").with_({"accuracy.stage": ["law"]})
>>> study = gc.build(design).study("accuracy")
>>> bool(study.columns["error"].min() < 1e-9)
True
""",
)
"""The study of error against run time (see `gearcam.results.accuracy`)."""
