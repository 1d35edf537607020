"""The best of families of real designs against all their designs, built one by one.

Cams whose rise and return share 240 degrees: the angle of the rise in whole steps, one of two laws
and the prime radius, a real number. A large cam has small pressure angles; findings of the pressure
angle forbid the smallest cams.

Pairs of ellipses: their numbers of teeth, pressure angle and addendum. More teeth, and longer ones,
have a higher contact ratio; findings of undercut forbid some.
"""

from __future__ import annotations

import itertools
from collections.abc import Iterator
from contextlib import suppress
from dataclasses import dataclass
from functools import cached_property
from pathlib import Path
from typing import Any

import numpy as np
import pytest

import gearcam as gc
from gearcam.numeric.arrays import Array
from gearcam.sweeps.axes import axes_of
from gearcam.sweeps.log import Log
from gearcam.sweeps.methods import Quest, Spent, minimized, usual
from gearcam.sweeps.optimum import Trials
from gearcam.sweeps.plan import Plan
from gearcam.sweeps.rows import Built, measured


@dataclass
class Family:
    """Designs: goals with their signs, and by keys what a search gets and what the grid has."""

    text: str
    goals: dict[str, float]
    sought: dict[str, Any]
    built: dict[str, Any]

    def of(self, row: Built) -> list[float]:
        """The goals of a row, which are to be least."""
        return [sign * float(row.facts[name]) for name, sign in self.goals.items()]

    @cached_property
    def grid(self) -> dict[tuple[int, ...], list[float]]:
        """The goals of all designs that may be taken, by places in the grid."""
        base, found, count = gc.loads(self.text), {}, 0
        for places in itertools.product(*(range(len(values)) for values in self.built.values())):
            count += 1
            row = measured(base, 0, self.values(places))
            if row.made and not row.errors and not row.warnings:
                found[places] = self.of(row)
        assert 0 < len(found) < count
        return found

    def values(self, places: tuple[int, ...]) -> dict[str, Any]:
        return {key: one[k] for (key, one), k in zip(self.built.items(), places, strict=True)}

    def steps(self) -> Iterator[Array]:
        """By how much goals differ between neighbours along the real numbers."""
        real = [k for k, one in enumerate(self.sought.values()) if one.count(":") == 1]
        for places, k in itertools.product(self.grid, real):
            beside = (*places[:k], places[k] + 1, *places[k + 1 :])
            if beside in self.grid:
                yield np.abs(np.subtract(self.grid[beside], self.grid[places]))

    def searched(self, folder: Path, trials: int, method: str | None = None) -> list[Built]:
        """The best that a search finds."""
        ends = {1.0: "minimize", -1.0: "maximize"}
        goals = {end: [name for name in self.goals if self.goals[name] == sign]
                 for sign, end in ends.items()}  # fmt: skip
        given = {f"goal.{end}": names for end, names in goals.items() if names}
        base: Any = gc.loads(self.text).with_(given | {"goal.findings": "warning"})
        plan = Plan(base=base, axes=axes_of(self.sought), sampling="random", samples=trials)
        search = Quest(plan.axes, len(self.goals), trials, seed=1)
        with Log(folder, plan.head) as log:
            found = Trials(
                plan=plan,
                signs=base.goal.signs,
                warnings=True,
                most=trials,
                log=log,
                build=lambda jobs: (measured(base, number, values) for number, values in jobs),
            )
            with suppress(Spent):
                minimized(method or usual(search, 0.0)[0], search, found.evaluate)
        assert len(found.rows) == trials
        assert not any(one.errors or one.warnings for one in found.best())
        return found.best()


SIZE = "cam.profile.radius_mm.max"
CAMS = Family(
    """
kind = "cam"
name = "cam"
[[motion]]
type = "rise"
law = "cycloidal"
angle_deg = 100
lift_mm = 20
[[motion]]
type = "return"
law = "3-4-5"
angle_deg = "rest"
[[motion]]
type = "dwell"
angle_deg = 120
[follower]
type = "roller"
roller_radius_mm = 5
offset_mm = 6
[cam]
prime_radius_mm = 40
[output]
files = ["csv"]
""",
    {SIZE: 1.0, "cam.pressure_angle_deg.max": 1.0},
    {
        "motion[0].angle_deg": "70:100:5",
        "motion[0].law": "cycloidal,modified-sine",
        "cam.prime_radius_mm": "24:48",
    },
    {
        "motion[0].angle_deg": range(70, 101, 5),
        "motion[0].law": ["cycloidal", "modified-sine"],
        "cam.prime_radius_mm": range(24, 49, 2),
    },
)
PAIRS = Family(
    """
kind = "gear-pair"
name = "pair"
[law]
type = "ellipse"
eccentricity = 0.4
[pair]
module_mm = 1
teeth = [24, 24]
[output]
files = ["csv"]
""",
    {"pair.center_distance_mm": 1.0, "mesh.contact_ratio.forward.least": -1.0},
    {
        "pair.teeth": ",".join(f"[{z},{z}]" for z in range(18, 31, 2)),
        "rack.pressure_angle_deg": "15:28",
        "rack.addendum": "0.8:1.1",
    },
    {
        "pair.teeth": [[z, z] for z in range(18, 31, 2)],
        "rack.pressure_angle_deg": range(15, 29),
        "rack.addendum": [0.8, 0.9, 1.0, 1.1],
    },
)


@pytest.mark.slow
@pytest.mark.parametrize(("method", "trials"), [(None, 96), ("scipy", 144)])
def test_the_smallest_cam_is_at_least_as_small_as_every_one_of_the_grid(
    tmp_path: Path, method: str | None, trials: int
) -> None:
    least, where = min((goals[0], places) for places, goals in CAMS.grid.items())
    assert 0 < where[0] < len(CAMS.built["motion[0].angle_deg"]) - 1  # neither end of the angles
    family = Family(CAMS.text, {SIZE: 1.0}, CAMS.sought, CAMS.built)
    (found,) = family.searched(tmp_path, trials, method)
    step = 2.0  # of the radius; it changes the size as much
    assert least - step < family.of(found)[0] <= least


@pytest.mark.slow
def test_the_smallest_cam_is_that_of_its_solved_sizes(tmp_path: Path) -> None:
    text = CAMS.text.replace('angle_deg = "rest"', "angle_deg = 80")
    text = text.replace("angle_deg = 120", 'angle_deg = "rest"')
    sought = {"cam.prime_radius_mm": "20:100", "follower.offset_mm": "-20:20"}
    (found,) = Family(text, {SIZE: 1.0}, sought, {}).searched(tmp_path, 150)
    solved = gc.build(gc.loads(text).with_(dict.fromkeys(sought, "solve"))).facts
    assert solved[SIZE] <= float(found.facts[SIZE]) < solved[SIZE] * (1.0 + 3e-3)


def area(front: Array, corner: Array) -> float:
    """The area of the goals that a front surpasses, up to a corner (its hypervolume)."""
    total, height = 0.0, corner[1]
    for x, y in sorted(front.tolist()):
        if x < corner[0] and y < height:
            total, height = total + (corner[0] - x) * (height - y), y
    return total


@pytest.mark.parametrize(
    ("family", "trials"),
    [pytest.param(CAMS, 192, id="cams"), pytest.param(PAIRS, 576, id="pairs")],
)
@pytest.mark.slow
def test_the_front_of_two_goals_is_that_of_the_grid(
    family: Family, trials: int, tmp_path: Path
) -> None:
    goals = np.array(list(family.grid.values()))
    found = np.array([family.of(one) for one in family.searched(tmp_path, trials)])
    step = np.max(list(family.steps()), axis=0)
    for one in found:
        assert not np.any(np.all(goals + step < one, axis=1))
    corner = goals.max(axis=0)
    assert area(found, corner) > 0.95 * area(goals, corner)
    assert area(found[::6], corner) < 0.95 * area(goals, corner)  # a control: with fewer points
