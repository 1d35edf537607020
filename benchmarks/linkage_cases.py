"""Linkages: one evaluation, and against the package pylinkage."""

from __future__ import annotations

import statistics
import sys
import tempfile
from pathlib import Path

import numpy as np

import own_linkages
import peer_linkages
from measuring import ROOT, Result, Timing, commands, in_turns, measure, show, table

ANGLES = 10_000
PROCESSES = 100, ANGLES
"""Positions of the whole processes."""

AGREE = 1e-9
"""mm: largest difference of positions."""

PAIR = ROOT / "profiles" / "nail_machine_two_phase.toml"
MACHINE = """\
kind = "mechanism"
name = "slide"
drive = [{{ name = "pair", pair = "{pair}", speed_rpm = 180 }}]
crank = [{{ name = "crank", on = "pair.wheel2", joint = "pin", length_mm = 150, angle_deg = 180 }}]
guide = [{{ name = "bed", through = "pair.wheel2" }}]
output = {{ outputs = ["slide", "rod.angle"] }}

[[dyad]]
type = "RRT"
from = "pin"
to = "bed"
joint = "slide"
members = ["rod", "ram"]
lengths_mm = [750, 0]
"""

_STEPS_NOTE = """\
Ten thousand positions of all joints over a turn of the crank. The time of gearcam includes the
search for change points and for where the linkage opens. `step()` computes one position after the
other, in Python, and follows the nearer of two. Positions differ by {apart:.1e} mm at most."""
_PROCESS_NOTE = """\
From the start of Python to the last position with velocities and accelerations. pylinkage uses its
solver compiled by numba, `step_fast_with_kinematics()`, from its cache: the first run, which
compiles, is not timed. Velocities differ by {speed:.1e} mm, accelerations by {bend:.1e} mm."""


def of_linkages() -> list[Result]:
    """(z) to (zc) An evaluation; against `step()`; against the compiled solver; behind a pair."""
    return [_orders(), _against_steps(), _against_compiled(), _behind_pair()]


def _orders() -> Result:
    """(z) A four-bar with three derivatives."""
    made, _ = own_linkages.four_bar()
    q = np.linspace(0.0, 2.0 * np.pi, ANGLES)
    timings = [
        measure(f"{order} derivatives", lambda order=order: made.at(q, order), 15)
        for order in range(4)
    ]
    return Result(
        title="(z) A four-bar at 10 000 angles, with three derivatives of all joints",
        asked="at most 5 ms",
        found=show(timings[-1].median),
        passed=timings[-1].median <= 5e-3,
        body=table(timings),
    )


def _against_steps() -> Result:
    """(za) Positions against `step()` of pylinkage."""
    timings, ratios, apart = [], {}, 0.0
    for name in own_linkages.LINKAGES:
        own = own_linkages.solved(name, ANGLES, 0)[0]
        apart = max(apart, float(np.abs(own - peer_linkages.stepped(name, ANGLES)).max()))
        mine, other = in_turns(
            {
                f"{name}, gearcam": lambda name=name: own_linkages.solved(name, ANGLES, 0),
                f"{name}, step()": lambda name=name: peer_linkages.stepped(name, ANGLES),
            },
            7,
        )
        timings += [mine, other]
        ratios[name] = other.over(mine)
    return Result(
        title="(za) Positions of a four-bar and a six-bar against pylinkage",
        asked="the same to 1e-9 mm; at least 20 times faster than `step()`",
        found=f"{apart:.0e} mm; {_listed(ratios)} times faster",
        passed=apart <= AGREE and min(ratios.values()) >= 20.0,
        body=[*table(timings), "", _STEPS_NOTE.format(apart=apart)],
    )


def _against_compiled() -> Result:
    """(zb) Whole processes against the compiled solver of pylinkage."""
    timings: list[Timing] = []
    ratios: dict[str, float] = {}
    apart = [0.0, 0.0, 0.0]
    for name in own_linkages.LINKAGES:
        pairs = zip(
            own_linkages.solved(name, ANGLES, 2), peer_linkages.compiled(name, ANGLES), strict=True
        )
        for order, (own, other) in enumerate(pairs):
            off = np.abs(own - (other[..., 0] + 1j * other[..., 1])).max()
            apart[order] = max(apart[order], float(off))
        for steps in PROCESSES:
            mine, other = commands(
                {
                    f"{name}, {steps} positions, {who}": [
                        sys.executable,
                        str(ROOT / "benchmarks" / f"{file}_linkages.py"),
                        name,
                        str(steps),
                    ]
                    for who, file in (("gearcam", "own"), ("pylinkage", "peer"))
                },
                5,
            )
            timings += [mine, other]
            ratios[f"{name} {steps}"] = other.over(mine)
    return Result(
        title="(zb) Linkages with velocity and acceleration as whole processes against pylinkage",
        asked="faster than its compiled solver up to 10 000 positions",
        found=f"{_listed(ratios)} times faster",
        passed=apart[0] <= AGREE and min(ratios.values()) > 1.0,
        body=[*table(timings), "", _PROCESS_NOTE.format(speed=apart[1], bend=apart[2])],
    )


def _behind_pair() -> Result:
    """(zc) The table of a machine against that of its pair, as whole processes."""
    with tempfile.TemporaryDirectory() as folder:
        design = Path(folder) / "machine.toml"
        design.write_text(MACHINE.format(pair=PAIR), encoding="utf-8")
        command = [sys.executable, "-m", "gearcam", "build", "--only", "csv", "-o", folder]
        machine, pair = commands(
            {"the machine": [*command, str(design)], "its pair": [*command, str(PAIR)]}, 11
        )
    pairs = zip(machine.samples, pair.samples, strict=True)
    more = statistics.median(mine - theirs for mine, theirs in pairs)
    return Result(
        title="(zc) The csv build of a slide behind a pair, beyond that of the pair",
        asked="at most 30 ms",
        found=show(more),
        passed=more <= 30e-3,
        body=table([machine, pair]),
    )


def _listed(ratios: dict[str, float]) -> str:
    return ", ".join(f"{name} {ratio:.3g}" for name, ratio in ratios.items())
