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
        returns="a row for each phase and pair of half-teeth that touch or should: overlap and its "
        "area, as found and as predicted, contact, sliding, lag of the driven wheel, "
        "backlash; contact ratio, transmission error and its harmonics as facts.",
        example="""\
>>> import gearcam as gc
>>> design = gc.load("profiles/ellipse.toml").with_({"meshing.steps": 12})
>>> study = gc.build(design).study("mesh")
>>> print(study.facts["meshing.steps_done"], study.columns["area_mm2"].max().round(6))
12 0.000365
""",
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
        returns="a row for each driver angle: the lag of the driven wheel without errors, with all "
        'of them, with each alone, and the backlash; tables["trials"] has a row for each '
        "random assembly: its errors, transmission error, least backlash, whether it jams; "
        "percentiles as facts.",
        example="""\
>>> import gearcam as gc
>>> errors = {"errors.center_tolerance_mm": 0.02, "errors.steps": 72, "pair.backlash_mm": 0.1}
>>> study = gc.build(gc.load("profiles/ellipse.toml").with_(errors)).study("errors")
>>> found = study.tables["trials"]["transmission_error_rad"]
>>> p90 = study.facts["errors.trials.transmission_error_rad.p90"]
>>> len(found), int((found <= p90).sum())
(100, 90)
""",
    ),
    Study(
        name="forces",
        key="forces",
        doc="Compute forces, torque, efficiency and contact pressure; write DIR/NAME/forces.csv.",
        done="computed",
        table="forces",
        compute=deferred(f"{_HERE}.forces:study_forces"),
        demand=deferred(f"{_HERE}.forces:demand"),
        returns="a row for each phase and pair of teeth that carries: normal force, its share, "
        "sliding, contact pressure, torque of the driver, forces of the bearings, "
        "efficiency.",
        example="""\
>>> import gearcam as gc
>>> study = gc.build(gc.load("profiles/loaded_nail_machine.toml")).study("forces")
>>> round(study.columns["normal_n"].max())
19531
""",
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
        returns="a row for each phase and pair of teeth that carries: share of the force, contact "
        "pressure, tension and compression at both roots; the most loaded root with its "
        "error and safety as facts. It needs the extra stress.",
        example="""\
>>> import gearcam as gc
>>> load = {"load": [{"torque_nm": 2}], "stress.phases": 12, "stress.teeth": [1]}
>>> study = gc.build(gc.load("profiles/ellipse.toml").with_(load)).study("stress")
>>> round(study.facts["stress.gears.0.root.tension_mpa"])
17
""",
    ),
    dynamics_study(
        f"{_HERE}.dynamics:study_dynamics",
        f"{_HERE}.dynamics:demand",
        speed="drive.speed_rpm",
        returns="a row for each moment: angles and speeds of the shafts, torques of motor and load;"
        " with elastic teeth their torque, normal force, lag and whether they touch; "
        "irregularity, works and powers as facts. It needs the extra dynamics.",
        example="""\
>>> import gearcam as gc
>>> study = gc.build(gc.load("profiles/rattling_pair.toml")).study("dynamics")
>>> round(study.facts["dynamics.speed_rpm.mean"], 1)
186.3
""",
    ),
    ACCURACY,
)
