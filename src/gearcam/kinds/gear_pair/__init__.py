"""Pairs of non-circular gears: the kind ``gear-pair``."""

from __future__ import annotations

from typing import Final

from gearcam.base.registry import deferred
from gearcam.kinds.shared_studies import ACCURACY, dynamics_study
from gearcam.results.studies import Study

_HERE: Final = "gearcam.kinds.gear_pair"

STUDIES: Final = (
    Study(
        name="mesh",
        key="meshing",
        doc="Study the meshing of gear pairs step by step; write DIR/NAME/meshing.csv.",
        done="meshed",
        table="meshing",
        compute=deferred(f"{_HERE}.studies:study_mesh"),
        options={"center_distance_mm": "center"},
        repeats=("contact-ratio",),  # the study checks the drive as mounted
    ),
    Study(
        name="errors",
        key="errors",
        doc="Study errors of mounting and making of gear pairs; write DIR/NAME/errors.csv, and "
        "errors_trials.csv with a row for each random assembly.",
        done="studied",
        table="errors",
        compute=deferred(f"{_HERE}.errors:study_errors"),
        options={"eccentricity_deg": "eccentricity-angle", "file": "pitch"},
        parallel=True,
    ),
    Study(
        name="forces",
        key="forces",
        doc="Compute forces, torque, efficiency and contact pressure; write DIR/NAME/forces.csv.",
        done="computed",
        table="forces",
        compute=deferred(f"{_HERE}.forces:study_forces"),
        demand=deferred(f"{_HERE}.forces:demand"),
    ),
    Study(
        name="stress",
        key="stress",
        doc="Compute stress in tooth roots, shares and lag under load; write DIR/NAME/stress.csv.",
        done="computed",
        table="stress",
        compute=deferred(f"{_HERE}.stress:study_stress"),
        demand=deferred(f"{_HERE}.stress:demand"),
        options={"teeth": "tooth"},
        repeats=("contact-pressure",),  # with the true shares
    ),
    dynamics_study(
        f"{_HERE}.dynamics:study_dynamics", f"{_HERE}.dynamics:demand", speed="drive.speed_rpm"
    ),
    ACCURACY,
)
