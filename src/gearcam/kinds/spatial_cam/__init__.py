"""Cams in space: a cylinder with a groove or an edge that moves a roller along it."""

from __future__ import annotations

from typing import Final

from gearcam.base.registry import deferred
from gearcam.kinds.shared_studies import ACCURACY, forces_study
from gearcam.results.studies import Study

_HERE: Final = "gearcam.kinds.spatial_cam"

STUDIES: Final = (
    Study(
        name="developed",
        key="developed",
        doc="Compute the error of walls that are constructed in the developed plane; write "
        "DIR/NAME/developed.csv.",
        done="compared",
        table="developed",
        compute=deferred(f"{_HERE}.studies:study_developed"),
        returns="a row for each place of a wall that is constructed in the developed plane: where "
        "it is, and how far it is off the true wall; widest gap and deepest jam as facts.",
        example="""\
>>> import gearcam as gc
>>> study = gc.build(gc.load("profiles/cylinder_cam.toml")).study("developed")
>>> round(study.facts["developed.gap_mm"], 3)
0.188
""",
    ),
    forces_study(
        "gearcam.kinds.gridded_forces:study_forces",
        returns="a row for each angle: load, normal force and the wall that bears it, forces of "
        "guide or pivot and of the bearings, torque of the cam, efficiency, contact "
        "pressure, line load.",
        example="""\
>>> import gearcam as gc
>>> load = {"load": [{"force_n": -100}]}
>>> study = gc.build(gc.load("profiles/cylinder_cam.toml").with_(load)).study("forces")
>>> print(study.columns["normal_n"].max().round(1))
111.2
""",
    ),
    ACCURACY,
)
