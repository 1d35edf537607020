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
        returns="a row for each angle of the given profile: how far it moves the follower, how far "
        "that is from the lift asked for, and the point of contact; a file is not needed by"
        " result.follow(outline).",
        example="""\
>>> import gearcam as gc
>>> result = gc.build(gc.load("profiles/eccentric_cam.toml"))
>>> written = result.write("cut", files=["dxf"])
>>> file = "cut/eccentric_cam/cam.dxf"
>>> study = gc.build(result.design.with_({"follow.file": file})).study("follow")
>>> abs(study.facts["followed.largest_difference"]) < 0.002
True
""",
    ),
    forces_study(
        f"{_HERE}.forces:study_forces",
        returns="a row for each angle: load, normal force and the wall that bears it, forces of "
        "guide or pivot and of the bearing, torque of the cam, efficiency, contact "
        "pressure.",
        example="""\
>>> import gearcam as gc
>>> study = gc.build(gc.load("profiles/valve_train.toml")).study("forces")
>>> round(study.facts["forces.efficiency.overall"], 3)
0.672
""",
    ),
    dynamics_study(
        f"{_HERE}.dynamics:study_dynamics",
        f"{_HERE}.moving:demand",
        speed="drive.speed_rpm",
        options={"stiffness_n_mm": "train-stiffness", "stiffness_nm_rad": "swing-stiffness"},
        returns="a row for each moment of a turn: motion of the elastic follower, load, contact "
        "force, torque, pressure; the speeds at which it jumps, natural frequencies, what "
        "is left in dwells as facts. It needs the extra dynamics.",
        example="""\
>>> import gearcam as gc
>>> study = gc.build(gc.load("profiles/elastic_valve_train.toml")).study("dynamics")
>>> round(study.facts["dynamics.jump_rpm.elastic"])
1132
""",
    ),
    Study(
        name="precision",
        key="precision",
        doc="Compute how errors of sizes move the follower; write DIR/NAME/precision.csv.",
        done="studied",
        table="precision",
        options={"lift_error_deg": "swing-error"},
        compute=deferred(f"{_HERE}.precision:study_precision"),
        returns="a row for each angle: how far an error of each size moves the follower, per mm or "
        "degree of it; the largest of them, and deviations within tolerances, as facts.",
        example="""\
>>> import gearcam as gc
>>> study = gc.build(gc.load("profiles/eccentric_cam.toml")).study("precision")
>>> round(study.facts["precision.sizes.axis.sensitivity_mm_per_deg"], 4)
0.1047
""",
    ),
    ACCURACY,
)
