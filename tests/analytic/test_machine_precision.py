"""Deviations of mechanisms by errors of dimensions and by clearance: values, and differences."""

from __future__ import annotations

import math
from functools import cache
from typing import Any

import numpy as np
import pytest

import gearcam
from gearcam.base.errors import DesignError
from gearcam.kinds.mechanism.precision import Tolerated
from gearcam.linkages.closing import NotClosingError, settled
from gearcam.linkages.deviations import deviated, dimensions_of, places, sensitivities
from helpers_linkages import agree
from helpers_random_linkages import drawn


def machine(document: dict[str, Any]) -> Any:
    return gearcam.build(gearcam.design({"kind": "mechanism", "name": "m", **document}))


MOTOR = [{"name": "motor", "even": True}]
LENGTHS = ("crank.length", "coupler.length", "rocker.length", "D.x")


def four_bar(**changes: Any) -> Any:
    ahead = [60 * math.cos(math.radians(35)), 60 * math.sin(math.radians(35))]
    return machine({
        "drive": MOTOR,
        "joint": [{"name": "D", "at_mm": [110, 0]}],
        "crank": [{"name": "crank", "on": "motor", "joint": "B", "length_mm": 40}],
        "dyad": [{"type": "RRR", "from": "B", "to": "D", "joint": "C",
                  "members": ["coupler", "rocker"], "lengths_mm": [120, 90]}],
        "point": [{"name": "P", "on": "coupler", "at_mm": ahead}],
        "output": {"outputs": ["rocker.angle", "P.x"]},
        **changes,
    })  # fmt: skip


FOUR_BAR = {
    ("rocker", 30): (-0.017067185747, -0.017103199897, 0.0130024096456, 0.0142259504492, 0, 0,
                     0.175894449911, 0.088542308616),
    ("P_x", 30): (1.37986861775, 0.545210389166, -0.717162628003, -0.194857624893, 0.362944257156,
                  -55.9086511938, 0.257581180216, 0.129363604531),
    ("P_x", 150): (-0.485139088981, 0.0247935826028, -0.454242648969, 0.206101417298,
                   0.420848369824, -54.4278599489, 0.174550791476, 0.103337879564),
}  # fmt: skip
"""By l1, l2, l3, l4, BP and its angle; worst case and root of squares for 0.05 mm and 0.1 deg."""


@pytest.mark.parametrize(("stem", "crank"), FOUR_BAR)
def test_a_four_bar(stem: str, crank: int) -> None:
    known = FOUR_BAR[stem, crank]
    made = Tolerated(four_bar())
    found = {name: float(one[0]) for name, one in made.at(np.radians([crank]))[stem].items()}
    ahead = np.exp(1j * math.radians(35))
    at = found["P.x"] + 1j * found["P.y"]  # polar coordinates of the point, as in the table
    polar = (np.conj(at) * ahead).real, 60.0 * (np.conj(at) * ahead * 1j).real
    own = np.array([*(found[name] for name in LENGTHS), *polar])
    agree(own, np.array(known[:6]))
    parts = np.abs(own) * np.array([0.05] * 5 + [math.radians(0.1)])
    scale = math.degrees(1.0) if stem == "rocker" else 1.0
    agree(scale * np.array([parts.sum(), np.hypot.reduce(parts)]), np.array(known[6:]))


def slider(**changes: Any) -> Any:
    return machine({
        "drive": MOTOR,
        "guide": [{"name": "bed", "at_mm": [0, -25]}],
        "crank": [{"name": "crank", "on": "motor", "joint": "B", "length_mm": 100}],
        "dyad": [{"type": "RRT", "from": "B", "to": "bed", "joint": "C",
                  "members": ["rod", "ram"], "lengths_mm": [300, 0]}],
        "output": {"outputs": ["C"]},
        **changes,
    })  # fmt: skip


SLIDER = {
    60: (0.152921135723, 1.07731996982, -0.400772151441, 1.63101325698, 1.15957815972),
    200: (-0.950188473696, 1.00047076037, 0.0306878209208, 1.98134705499, 1.3801237699),
}
"""By crank, rod, and offset; worst case and root of squares for 1 mm each."""


@pytest.mark.parametrize("crank", SLIDER)
def test_a_slider_crank(crank: int) -> None:
    names = ("crank.length", "rod.length", "bed.y")
    tolerances = [{"of": name, "tolerance_mm": 1} for name in names]
    made = Tolerated(slider(tolerance=tolerances))
    found = made.at(np.radians([float(crank)]))
    own = found["C"]
    by = [float(own[name][0]) for name in names]
    agree(np.array([by[0], by[1], -by[2]]), np.array(SLIDER[crank][:3]))
    sums = [float(one[0]) for one in (made.worst(found, "C"), made.rooted(found, "C"))]
    agree(np.array(sums), np.array(SLIDER[crank][3:]))


def test_clearance_along_the_reaction() -> None:
    """The share of the output's force that a joint carries: of both pins, and of the guide."""
    found = Tolerated(slider()).at(np.radians([60.0]))["C"]
    agree(found["B.clearance"], np.array([1.07731996982]))
    agree(found["C.clearance"], np.array([1.07731996982]))
    agree(found["bed.clearance"], np.array([0.400772151441]))


def quantities(linkage: Any) -> list[str]:
    return [name for one in linkage.dyads for name in (f"{one.joint}.x", f"{one.members[1]}.angle")]


def test_random_linkages_have_the_sensitivities_of_differences() -> None:
    compared = 0
    for index in range(20):
        try:
            linkage = settled(drawn(17, index).linkage)
        except NotClosingError:
            continue
        names, q = quantities(linkage), np.array([0.4, 2.9])
        found = sensitivities(linkage, names, q)
        for dimension in dimensions_of(linkage):
            h = 1e-6 if dimension.angle else 1e-4
            ends = [places(deviated(linkage, dimension, end), names, q) for end in (h, -h)]
            known = (ends[0] - ends[1] + np.pi) % (2.0 * np.pi) - np.pi
            own = np.stack([found[dimension.name][name] for name in names])
            if np.abs(own).max() < 1e4:  # not nearly singular
                assert known / (2.0 * h) == pytest.approx(own, rel=1e-5, abs=2e-5)
                compared += 1
    assert compared > 150


@cache
def tolerated() -> Any:
    return four_bar(
        precision={"length_tolerance_mm": 0.05, "angle_tolerance_deg": 0.1, "clearance_mm": 0.02},
        limits={"deviation_mm": 0.2},
    ).study("precision")


def test_facts_are_the_largest_of_the_columns() -> None:
    facts, table = tolerated().facts, tolerated().columns
    for stem, unit in (("P_x", "mm"), ("rocker", "deg")):
        own = facts[f"precision.outputs.{stem}"]
        for how in ("worst_case", "root_of_squares"):
            most = np.max(table[f"{stem}_{how}_{unit}"])
            assert most <= own[f"{how}_{unit}"] <= most * 1.001
        largest = [one[f"deviation_{unit}"] for one in own["dimensions"].values()]
        assert largest == sorted(largest, reverse=True)


def test_a_deviation_that_is_not_wanted_is_told_with_a_share_that_keeps_it() -> None:
    (one,) = (one for one in tolerated().study_findings if one.code == "deviation")
    share = float(one.message.split(" % of all")[0].split()[-1]) / 100.0
    some = {"length_tolerance_mm": 0.05 * share, "angle_tolerance_deg": 0.1 * share,
            "clearance_mm": 0.02 * share}  # fmt: skip
    kept = four_bar(precision=some, limits={"deviation_mm": 0.2}).study("precision")
    assert not [one for one in kept.study_findings if one.code == "deviation"]
    more = {key: 1.02 * value for key, value in some.items()}
    again = four_bar(precision=more, limits={"deviation_mm": 0.2}).study("precision")
    assert [one for one in again.study_findings if one.code == "deviation"]


def test_random_machines_have_the_percentiles_of_one_error() -> None:
    """A rod alone: the deviation is even from 0 to its largest."""
    spec = {"tolerance": [{"of": "rod.length", "tolerance_mm": 0.1}],
            "precision": {"trials": 2000, "steps": 72}}  # fmt: skip
    study = slider(**spec).study("precision")
    own = study.facts["precision.outputs.C"]
    for percent in (50, 90, 99):
        expected = 0.01 * percent * own["worst_case_mm"]
        assert own[f"p{percent}_mm"] == pytest.approx(expected, abs=0.035 * own["worst_case_mm"])
    assert study.facts["precision.trials.open"] == 0


def test_without_tolerances_there_are_sensitivities() -> None:
    study = slider().study("precision")
    assert "C_worst_case_mm" not in study.columns
    assert study.facts["precision.outputs.C.dimensions.rod_length.sensitivity_mm_per_mm"] > 1.0
    assert {*study.charts} == {"precision_C"}


@pytest.mark.parametrize(
    ("tolerance", "words"),
    [
        ({"of": "rod.lenght", "tolerance_mm": 1}, "did you mean rod.length"),
        ({"of": "rod.length", "tolerance_deg": 1}, "rod.length is a length"),
        ({"of": "crank.angle", "tolerance_mm": 1}, "crank.angle is an angle"),
        ({"of": "rod.length"}, "tolerance"),
    ],
)
def test_what_is_refused(tolerance: Any, words: str) -> None:
    with pytest.raises(DesignError, match=words):
        slider(tolerance=[tolerance]).study("precision")


def test_a_dimension_has_one_tolerance() -> None:
    twice = [{"of": "rod.length", "tolerance_mm": one} for one in (1, 2)]
    with pytest.raises(DesignError, match="has a tolerance before"):
        slider(tolerance=twice).study("precision")


def test_trials_and_limits_without_tolerances_are_refused() -> None:
    with pytest.raises(DesignError, match="has no tolerances to try"):
        slider(precision={"trials": 10}).study("precision")
    with pytest.raises(DesignError, match=r"limits\.deviation_mm.*has no tolerances to judge"):
        slider(limits={"deviation_mm": 0.1}).study("precision")


def test_the_shaft_of_a_drive_by_its_other_name_has_a_place_too() -> None:
    crank = [{"name": "crank", "on": "motor.shaft", "joint": "B", "length_mm": 100}]
    spec = {"length_tolerance_mm": 0.1}
    made = [slider(precision=spec), slider(precision=spec, crank=crank)]
    worst = [one.study("precision").facts["precision.outputs.C.worst_case_mm"] for one in made]
    assert worst[0] == pytest.approx(worst[1])


def test_clearance_of_a_geneva_wheel_moves_it() -> None:
    geneva = gearcam.load("profiles/geneva.toml").with_({"precision.clearance_mm": 0.1})
    study = gearcam.build(geneva).study("precision")
    worst = [np.max(one) for name, one in study.columns.items() if "worst_case" in name]
    assert worst
    assert min(worst) > 0.0
