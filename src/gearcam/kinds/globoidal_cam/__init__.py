"""Globoidal indexing cams with their turrets."""

from __future__ import annotations

from typing import Final

from gearcam.kinds.shared_studies import ACCURACY, forces_study

STUDIES: Final = (
    forces_study(
        "gearcam.kinds.gridded_forces:study_forces",
        returns="a row for each angle: load, normal force and the wall that bears it, forces of "
        "guide or pivot and of the bearings, torque of the cam, efficiency, contact "
        "pressure, line load.",
        example="""\
>>> import gearcam as gc
>>> load = {"load": [{"torque_nm": -10}]}
>>> design = gc.load("profiles/globoidal_indexer.toml").with_(load)
>>> study = gc.build(design).study("forces")
>>> print(study.columns["normal_n"].max().round(1))
239.7
""",
    ),
    ACCURACY,
)
