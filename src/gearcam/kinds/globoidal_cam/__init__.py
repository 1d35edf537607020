"""Globoidal indexing cams with their turrets."""

from __future__ import annotations

from typing import Final

from gearcam.kinds.shared_studies import ACCURACY, forces_study

STUDIES: Final = (
    forces_study("gearcam.kinds.gridded_forces:study_forces"),
    ACCURACY,
)
