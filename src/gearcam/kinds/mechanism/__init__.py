"""The kind ``mechanism``: a linkage that a pair, a cam or an even shaft drives."""

from __future__ import annotations

from typing import Final

from gearcam.base.registry import deferred
from gearcam.kinds.shared_studies import ACCURACY, dynamics_study
from gearcam.results.studies import Study

_HERE: Final = "gearcam.kinds.mechanism"

STUDIES: Final = (
    Study(
        name="torque",
        key="torque",
        doc="Compute the driver's moment under loads, masses and springs; "
        "write DIR/NAME/torque.csv.",
        done="computed",
        table="torque",
        compute=deferred(f"{_HERE}.torque:study_torque"),
        demand=deferred(f"{_HERE}.torque:demand"),
        repeats=("loads-unused",),  # it uses them
    ),
    Study(
        name="forces",
        key="forces",
        doc="Compute the forces in joints and guides, with friction; write DIR/NAME/forces.csv.",
        done="computed",
        table="forces",
        compute=deferred(f"{_HERE}.forces:study_forces"),
        demand=deferred(f"{_HERE}.torque:demand"),
        repeats=("loads-unused",),
    ),
    Study(
        name="precision",
        key="precision",
        doc="Compute deviations of outputs by tolerances; write DIR/NAME/precision.csv.",
        done="studied",
        table="precision",
        compute=deferred(f"{_HERE}.precision:study_precision"),
        repeats=("loads-unused",),
    ),
    Study(
        name="balance",
        key="balance",
        doc="Compute shaking force and moment, and weights against them; "
        "write DIR/NAME/balance.csv.",
        done="computed",
        table="balance",
        compute=deferred(f"{_HERE}.balance:study_balance"),
        demand=deferred(f"{_HERE}.balance:demand"),
        repeats=("loads-unused",),
    ),
    dynamics_study(
        f"{_HERE}.dynamics:study_dynamics",
        f"{_HERE}.dynamics:demand",
        speed="drive[0].speed_rpm",
        repeats=("loads-unused",),
    ),
    ACCURACY,
)
