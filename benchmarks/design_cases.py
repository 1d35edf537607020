"""Sizes of cams that are solved for, their forces; what is measured on the wheels of a pair."""

from __future__ import annotations

from functools import partial
from pathlib import Path
from typing import Any

import gearcam
from measuring import Result, in_turns, table

PROFILES = Path(__file__).parents[1] / "profiles"

SOLVE, STUDY, MEASURED = 0.3, 0.02, 0.2
"""Targets, s."""


def of_cams(tries: int = 9) -> Result:
    """(t) A cam with two sizes solved for, and a study of forces."""
    packing = gearcam.load(PROFILES / "packaging_cam.toml")
    train = gearcam.load(PROFILES / "valve_train.toml")
    rows = in_turns(
        {
            "two sizes, packaging_cam": partial(_solution, packing),
            "forces, valve_train": partial(_forces, gearcam.build(train)),
        },
        tries,
    )
    solve, forces = (row.median for row in rows)
    return Result(
        title="(t) Sizes of a cam that are solved for, and forces",
        asked=f"at most {SOLVE} s and {1e3 * STUDY:.0f} ms",
        found=f"{solve:.2f} s and {1e3 * forces:.0f} ms",
        passed=solve <= SOLVE and forces <= STUDY,
        body=[*table(rows), "", "The lift is computed before the forces, not before the sizes."],
    )


def of_measures(tries: int = 9) -> Result:
    """(zy) Over pins, chords and spans of both wheels of a pair, whose outlines are finished."""
    gears = gearcam.build(gearcam.load(PROFILES / "nail_machine_two_phase.toml")).gears

    def measure() -> None:
        for gear in gears:
            vars(gear).pop("measuring", None)
            gear.measuring.table()

    rows = in_turns({"both wheels of nail_machine_two_phase": measure}, tries)
    (found,) = (row.median for row in rows)
    return Result(
        title="(zy) Over pins, chords and spans of a pair",
        asked=f"at most {MEASURED} s",
        found=f"{found:.3f} s",
        passed=found <= MEASURED,
        body=[*table(rows), "", "The outlines are finished before."],
    )


def _solution(design: Any) -> object:
    return gearcam.build(design).solution


def _forces(result: Any) -> object:
    return result.kind.studies["forces"].compute(result, lambda *_: None)
