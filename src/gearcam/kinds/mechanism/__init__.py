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
        returns="a row for each place of the driver: its torque, what loads, masses and springs "
        "contribute, torques of wheels and cams, power.",
        example="""\
>>> import gearcam as gc
>>> load = {"load": [{"on": "ram", "force_n": -20000}]}
>>> study = gc.build(gc.load("profiles/press_ram.toml").with_(load)).study("torque")
>>> round(study.columns["torque_nm"].max())
1975
""",
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
        returns="a row for each place of the driver: its torque with friction, and the force in "
        "each joint and guide; the largest of them and the efficiency as facts.",
        example="""\
>>> import gearcam as gc
>>> load = {"load": [{"on": "ram", "force_n": -20000}]}
>>> study = gc.build(gc.load("profiles/press_ram.toml").with_(load)).study("forces")
>>> round(study.facts["forces.joints.pin.largest_n"])
21213
""",
    ),
    Study(
        name="precision",
        key="precision",
        doc="Compute deviations of outputs by tolerances; write DIR/NAME/precision.csv.",
        done="studied",
        table="precision",
        compute=deferred(f"{_HERE}.precision:study_precision"),
        repeats=("loads-unused",),
        returns="a row for each place of the driver: how far an error of each dimension moves each "
        "output, the worst case and the root of squares; what random machines do, if asked "
        "for, as facts.",
        example="""\
>>> import gearcam as gc
>>> tolerance = {"precision.length_tolerance_mm": 0.02}
>>> study = gc.build(gc.load("profiles/four_bar.toml").with_(tolerance)).study("precision")
>>> round(study.facts["precision.outputs.P_x.worst_case_mm"], 3)
0.143
""",
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
        returns="a row for each place of the driver: shaking force and moment about the origin, "
        "without and with counterweights; their harmonics, the weights and the unbalance of"
        " rotors as facts.",
        example="""\
>>> import gearcam as gc
>>> study = gc.build(gc.load("profiles/nail_machine_flywheel.toml")).study("balance")
>>> list(study.columns)[:3]
['phi1_deg', 'force_x_n', 'force_y_n']
""",
    ),
    dynamics_study(
        f"{_HERE}.dynamics:study_dynamics",
        f"{_HERE}.dynamics:demand",
        speed="drive[0].speed_rpm",
        repeats=("loads-unused",),
        returns="a row for each moment: angle and speed of the driver, inertia at the driver, "
        "torques of motor and loads, power; irregularity, works and the flywheel as facts. "
        "It needs the extra dynamics.",
        example="""\
>>> import gearcam as gc
>>> study = gc.build(gc.load("profiles/nail_machine_flywheel.toml")).study("dynamics")
>>> round(study.facts["dynamics.speed_rpm.min"], 1)
176.7
""",
    ),
    ACCURACY,
)
