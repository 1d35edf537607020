"""Cams with their followers: the kind ``cam``."""

from __future__ import annotations

from typing import Final

from gearcam.base.registry import deferred
from gearcam.kinds.shared_studies import ACCURACY, dynamics_study, forces_study
from gearcam.results.studies import Study

_HERE: Final = "gearcam.kinds.cam"

STUDIES: Final = (
    Study(
        name="follow",
        key="followed",
        doc="Compute the follower motion on a given profile; write DIR/NAME/followed.csv. With "
        "--fit find the design that moves like this; write DIR/NAME/fitted.toml too.",
        done="followed",
        table="follow",
        compute=deferred(f"{_HERE}.given_profile:study_follow"),
        argument="file",
        metavar="PROFILE",
        demand=deferred(f"{_HERE}.given_profile:demand"),
        many=False,
    ),
    forces_study(f"{_HERE}.forces:study_forces"),
    dynamics_study(
        f"{_HERE}.dynamics:study_dynamics",
        f"{_HERE}.moving:demand",
        speed="drive.speed_rpm",
        options={"stiffness_n_mm": "train-stiffness", "stiffness_nm_rad": "swing-stiffness"},
    ),
    Study(
        name="precision",
        key="precision",
        doc="Compute how errors of sizes move the follower; write DIR/NAME/precision.csv.",
        done="studied",
        table="precision",
        options={"lift_error_deg": "swing-error"},
        compute=deferred(f"{_HERE}.precision:study_precision"),
    ),
    ACCURACY,
)
