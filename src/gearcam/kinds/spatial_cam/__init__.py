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
    ),
    forces_study("gearcam.kinds.gridded_forces:study_forces"),
    ACCURACY,
)
