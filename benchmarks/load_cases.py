"""Targets of pairs and machines under load: forces, stress of teeth, reactions with friction."""

from __future__ import annotations

import tomllib
from typing import Any

import numpy as np

import gearcam
from cases import NAIL
from gearcam.kinds.gear_pair.elastic_pair import ElasticPair
from gearcam.kinds.gear_pair.forces import PairUnderLoad
from gearcam.kinds.mechanism.forces import JointForces
from measuring import Result, measure, show, table

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


def _target(title: str, most: float, made: Any) -> Result:
    return Result(
        title=title,
        asked=f"at most {show(most)}",
        found=show(made.median),
        passed=made.median <= most,
        body=[*table([made]), "", "What is loaded is made before; no file is written."],
    )
