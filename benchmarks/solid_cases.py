"""Steps of a meshing study with solids against the intersections in them."""

from __future__ import annotations

from dataclasses import dataclass
from functools import partial
from typing import Any

import numpy as np

import gearcam
from cases import ELLIPSE, NAIL, load
from gearcam.meshing.settings import MeshingSpec
from gearcam.meshing.solids import Bodies
from gearcam.meshing.study import BLOCK, Condition, mount
from gearcam.parts.solids import Prisms
from measuring import Result, in_turns, table

STEPS = 24, 96
NOTE = """\
A step finds the half-teeth that are close to each other, moves and intersects them, and reads the
overlap's volume and vertices; that of manifold3d alone is the same motions, intersections and
volumes. Steps in blocks, as in the study. Times of that: {listed}."""


@dataclass(frozen=True)
class Recorded:
    """Prisms that record which of them are intersected, and in which position."""

    prisms: Prisms
    calls: list[tuple[int, int, Any]]

    def overlap(self, one: int, two: int, motion: Any) -> tuple[float, Any]:
        """Return the overlap (see `Prisms`)."""
        self.calls.append((one, two, motion))
        return self.prisms.overlap(one, two, motion)


def against_booleans(tries: int = 7) -> Result:
    """(s) A step with solids against its calls of manifold3d."""
    designs = {
        "nail machine": gearcam.load(NAIL),
        "ellipse": load(ELLIPSE.format(teeth=40, tolerance="0.001")),
    }
    rows, ratios, linear = [], {}, []
    for name, design in designs.items():
        bodies = _bodies(design)
        phases = {n: np.linspace(0.0, 2.0 * np.pi, n, endpoint=False) for n in STEPS}
        calls: list[tuple[int, int, Any]] = []
        recorded = Bodies(
            turning=bodies.turning,
            prisms=Recorded(bodies.prisms, calls),  # type: ignore[arg-type]
            tilt=bodies.tilt,
            reach=bodies.reach,
        )
        _steps(recorded, phases[STEPS[0]])
        *mine, alone = in_turns(
            {
                **{
                    f"gearcam, {name}, {n} steps": partial(_steps, bodies, p)
                    for n, p in phases.items()
                },
                f"manifold3d alone, {name}, {STEPS[0]} steps": partial(
                    _alone, bodies.prisms, calls
                ),
            },
            tries,
        )
        rows += [*mine, alone]
        ratios[name] = mine[0].over(alone)
        linear.append(mine[1].over(mine[0]))
    worst = max(ratios.values())
    return Result(
        title="(s) A step with solids against its intersections alone",
        asked="at most 1.3 times the time; linear in steps",
        found=f"{worst:.2f} times; 4 times the steps take at most {max(linear):.1f} times as long",
        passed=worst <= 1.3 and max(linear) <= 4.8,
        body=[
            *table(rows),
            "",
            NOTE.format(listed=", ".join(f"{name} {ratio:.2f}" for name, ratio in ratios.items())),
        ],
    )


def _bodies(design: Any) -> Any:
    result = gearcam.build(design)
    half = 0.5 * design.pair.face_width
    condition = Condition(prisms=Prisms, low=-half, high=half)
    return mount(result.gears, MeshingSpec(), (), condition).bodies


def _steps(bodies: Any, phases: Any) -> None:
    overclosure = MeshingSpec().overclosure
    for first in range(0, len(phases), BLOCK):
        bodies.overlaps(phases[first : first + BLOCK], overclosure, 0.0)


def _alone(prisms: Prisms, calls: list[tuple[int, int, Any]]) -> None:
    for one, two, motion in calls:
        shared = prisms.solid("first", one).transform(motion) ^ prisms.solid("second", two)
        shared.volume()
