"""A tolerance study of a valve train against the distribution in closed form."""

from __future__ import annotations

import math
import tomllib
from statistics import NormalDist

import numpy as np

import gearcam as gc
from gearcam.sweeps.axes import axes_of
from gearcam.sweeps.plan import Plan
from gearcam.sweeps.rows import measured
from helpers_pairs import PROFILES

FILE = PROFILES / "valve_tolerances.toml"


def test_the_lift_off_speed_of_each_assembly_is_that_of_its_spring_and_mass() -> None:
    axes = axes_of({"spring[0].preload_n": "tolerance(95, 9)", "mass[0].mass_kg": "0.1:0.12"})
    plan = Plan(base=gc.load(FILE), axes=axes, sampling="latin", samples=12)
    # s and s" of a rise 3-4-5 of 9 mm in 75 deg
    x = np.linspace(0.0, 1.0, 200001)[1:]
    s, d2s = 9 * x**3 * (10 - 15 * x + 6 * x**2), 9 * x * (60 - 180 * x + 120 * x**2)
    d2s = d2s / math.radians(75) ** 2
    for number in range(plan.count):
        values = plan.values(number)
        row = measured(plan.base, number, values)
        force = values["spring[0].preload_n"] + 20 * s
        slow = d2s < 0
        square = np.min(force[slow] / (-1e-3 * values["mass[0].mass_kg"] * d2s[slow]))
        speed = math.sqrt(square) * 30 / math.pi
        assert abs(float(row.facts["forces.release_speed_rpm"]) / speed - 1.0) < 1e-6


def test_the_samples_of_the_file_have_the_distribution_that_it_says() -> None:
    table = tomllib.loads(FILE.read_text())["sweep"]
    assert table["latin"] == 400
    plan = Plan(
        base=gc.load(FILE),
        axes=axes_of({"spring[0].preload_n": table["spring[0].preload_n"]}),
        sampling="latin",
        samples=400,
    )
    found = np.sort([plan.values(k)["spring[0].preload_n"] for k in range(400)])
    normal = NormalDist(95, 3)
    share = [(normal.cdf(one) - normal.cdf(86)) / (1 - 2 * normal.cdf(86)) for one in found]
    assert np.abs(np.array(share) - (np.arange(400) + 0.5) / 400).max() <= 0.5 / 400
