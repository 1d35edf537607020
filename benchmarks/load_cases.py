"""Targets of pairs and machines under load: forces, stress of teeth, reactions with friction."""

from __future__ import annotations

import tomllib
from typing import Any

import numpy as np

import gearcam
from cases import NAIL
from gearcam.dynamics.follower_motion import settle
from gearcam.gears.contact import COAST, DRIVE, flank_pairs
from gearcam.kinds.cam.moving import MovingCam
from gearcam.kinds.gear_pair.dynamics import motion_of
from gearcam.kinds.gear_pair.elastic_pair import ElasticPair
from gearcam.kinds.gear_pair.forces import PairUnderLoad
from gearcam.kinds.mechanism.dynamics import study_dynamics
from gearcam.kinds.mechanism.forces import JointForces
from gearcam.meshing.assembly import Assembly, random_assemblies
from gearcam.meshing.edges import touches
from gearcam.meshing.errors import Runs, cycle
from gearcam.results.study import silent
from measuring import Result, in_turns, measure, show, table

LOAD = {"load": [{"torque_nm": 2365.275}], "stress": {"phases": 360}}
PHASES = np.radians(np.arange(360) + 0.5)


def loaded() -> Any:
    """Return the result of the nail machine's wheels under load, both wheels and parts made."""
    made = gearcam.build(gearcam.design(tomllib.loads(NAIL.read_text("utf-8")) | LOAD))
    _ = made.parts, made.subject.sides[1].arcs
    return made


def of_loads() -> list[Result]:
    """(zf) Forces; (zg) a certified tooth; (zh) the cycle with all roots."""
    result = loaded()
    under, pair = PairUnderLoad(result), ElasticPair(result)
    forces = measure("forces of 360 phases", lambda: under.loaded(PHASES), 15)
    entries = pair.entries(PHASES)
    worst = entries.worst[0]
    entry, column = np.unravel_index(int(worst.argmax()), worst.shape)
    number = int(entries.numbers[0][column])
    tooth = measure("a tooth", lambda: pair.certified(entries, 1, number, int(entry)), 7)
    cycle = measure("360 phases", lambda: ElasticPair(result).entries(PHASES), 3)
    return [
        _target("(zf) Forces of a pair at 360 phases", 0.1, forces),
        _target("(zg) A certified tooth of the nail machine", 0.9, tooth),
        _target("(zh) Shares, lag and all roots of the nail machine at 360 phases", 12.0, cycle),
    ]


def of_assemblies() -> Result:
    """(zx) Random assemblies against the search of first contact along the flanks of each."""
    tolerances = {
        "eccentricity_tolerance_mm": 0.03,
        "center_tolerance_mm": 0.02,
        "tilt_tolerance_deg": [0.02, 0.02],
        "pitch_tolerance_mm": 0.005,
        "trials": 20,
    }
    design = gearcam.design({
        "kind": "gear-pair",
        "name": "assembled",
        "law": {"type": "ellipse", "eccentricity": 0.3},
        "pair": {"teeth": [31, 31], "module_mm": 2, "backlash_mm": 0.12, "face_width_mm": 12},
        "errors": tolerances,
    })  # fmt: skip
    result: Any = gearcam.build(design)
    gears, spec = result.gears, result.design.errors
    phi1 = cycle(gears, spec.steps, alike=False)
    assemblies = list(random_assemblies(spec, gears, Assembly()))
    width, shift = result.design.pair.face_width, gears[0].pair.shift

    def together() -> None:
        runs = Runs(steps=[gears], width=width, phi1=phi1)
        for one in assemblies:
            runs.of(one)

    def along() -> None:
        for one in assemblies:
            for mounting in one.mountings(shift, -0.5 * width, 0.5 * width):
                for side in (DRIVE, COAST):
                    touches(flank_pairs(gears, side, mounting), phi1)

    once, each = in_turns({"together": together, "along the flanks of each": along}, 3)
    gain = each.over(once)
    return Result(
        title="(zx) Twenty random assemblies against searches along the flanks of each",
        asked="at least 6 times as fast",
        found=f"{gain:.1f} times; an assembly in {show(once.median / len(assemblies))}",
        passed=gain >= 6.0,
        body=[
            *table([once, each]),
            "",
            "What is the same for all assemblies is computed in each run. Both sides, both faces.",
        ],
    )


def of_machines() -> list[Result]:
    """(zi) Forces in all joints of the press ram, with friction."""
    design = gearcam.load(NAIL.parent / "press_ram.toml").with_({
        "load": [{"on": "ram", "force_n": -20000}],
        "friction": {"joint": 0.1, "journal_radius_mm": 20, "guide": 0.1, "guide_length_mm": 200},
    })  # fmt: skip
    joints = JointForces(gearcam.build(design))
    q = np.linspace(*joints.work.linkage.span, 361)[:-1]
    made = measure("360 places", lambda: joints.at(q), 15)
    return [_target("(zi) Forces in the joints of the press with friction, 360 places", 0.05, made)]


def of_dynamics() -> list[Result]:
    """(zj) The regime of the nail machine; (zk) three turns of elastic teeth; (zl) a cam's turn."""
    folder = NAIL.parent
    design = gearcam.load(folder / "nail_machine_flywheel.toml")
    machine = gearcam.build(design.with_({"motor.flywheel_kg_m2": 0}))
    _ = machine.linkage
    pair = gearcam.build(gearcam.load(folder / "rattling_pair.toml"))
    elastic: Any = motion_of(pair, silent)
    start = elastic.pair.resting(0.0, float(elastic.rigid.speed(np.zeros(1))[0]))
    settings = {"knots": elastic.machine.knots, "rtol": 1e-6}
    end = 3.0 * elastic.machine.period
    cam = MovingCam(gearcam.build(gearcam.load(folder / "elastic_valve_train.toml")))
    follower, begin = cam.follower, cam.turn.start[1][:-2]
    return [
        _target(
            "(zj) The regime of the nail machine in motion",
            0.5,
            measure("machine and regime", lambda: study_dynamics(machine, silent), 5),
        ),
        _target(
            "(zk) Three turns of a pair with elastic teeth",
            0.9,
            measure("three turns", lambda: elastic.pair.run(start, end, **settings), 5),
        ),
        _target(
            "(zl) A turn of an elastic follower",
            0.2,
            measure("a turn", lambda: settle(follower, begin, turns=1), 5),
        ),
    ]


def _target(title: str, most: float, made: Any) -> Result:
    return Result(
        title=title,
        asked=f"at most {show(most)}",
        found=show(made.median),
        passed=made.median <= most,
        body=[*table([made]), "", "What is loaded is made before; no file is written."],
    )
