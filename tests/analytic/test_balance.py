"""Balance of mechanisms: values of another program, closed forms, reactions on the frame."""

from __future__ import annotations

import math
from typing import Any

import numpy as np
import pytest

import gearcam
from gearcam.base.errors import DesignError
from gearcam.kinds.mechanism.loaded import work_of
from gearcam.linkages.balance import counterweights, harmonics, shaking, with_counterweights
from gearcam.linkages.reactions import reactions
from helpers_linkages import agree

EVEN = np.arange(256) / 256.0 * 2.0 * np.pi


def even(speed: float) -> list[dict[str, Any]]:
    return [{"name": "motor", "even": True, "speed_rpm": speed * 30.0 / math.pi}]


def four_bar(**changes: Any) -> Any:
    return machine({
        "drive": even(20.0),
        "joint": [{"name": "D", "at_mm": [110, 0]}],
        "crank": [{"name": "crank", "on": "motor", "joint": "B", "length_mm": 40}],
        "dyad": [{"type": "RRR", "from": "B", "to": "D", "joint": "C",
                  "members": ["coupler", "rocker"], "lengths_mm": [120, 90]}],
        "mass": [{"of": "crank", "mass_kg": 0.5, "at_mm": [15, 0]},
                 {"of": "coupler", "mass_kg": 1.1, "at_mm": [55, 0], "inertia_kg_m2": 0.0019},
                 {"of": "rocker", "mass_kg": 0.9, "at_mm": [40, 0], "inertia_kg_m2": 0.0011}],
        **changes,
    })  # fmt: skip


def slider(offset: float = 20.0, **changes: Any) -> Any:
    return machine({
        "drive": even(25.0),
        "guide": [{"name": "bed", "at_mm": [0, offset]}],
        "crank": [{"name": "crank", "on": "motor", "joint": "B", "length_mm": 60}],
        "dyad": [{"type": "RRT", "from": "B", "to": "bed", "joint": "C",
                  "members": ["rod", "slide"], "lengths_mm": [200, 0]}],
        "mass": [{"of": "crank", "mass_kg": 0.9, "at_mm": [20, 0]},
                 {"of": "rod", "mass_kg": 1.4, "at_mm": [80, 0], "inertia_kg_m2": 0.006},
                 {"of": "slide", "mass_kg": 2.2}],
        **changes,
    })  # fmt: skip


def machine(tables: dict[str, Any]) -> Any:
    return gearcam.build(gearcam.design({"kind": "mechanism", "name": "m", **tables}))


def acting(result: Any) -> Any:
    return work_of(result.design, result.linkage, result.drives)


def shaken(result: Any, q: Any) -> Any:
    work = acting(result)
    return shaking(work.linkage, work.efforts, q, work.speed)


@pytest.mark.parametrize(
    ("result", "crank", "known"),
    [
        (four_bar(), [30, 150], [(40.4217042718, -2.01445908166, -2991.34078541),
                                 (-18.4418742321, 7.84306454676, 803.674787524)]),
        (slider(), [60, 140], [(66.6840225422, 37.0225860118, 300.272037601),
                               (-99.7780400753, 27.4791703141, 2218.07353186)]),
    ],
    ids=["four-bar", "slider"],
)  # fmt: skip
def test_shaking_force_and_moment(result: Any, crank: Any, known: Any) -> None:
    found = shaken(result, np.radians(crank))
    own = np.stack([found.force.real, found.force.imag, found.moment], axis=1)
    agree(own, np.array(known))


def test_harmonics() -> None:
    force = shaken(four_bar(), EVEN).force
    agree(harmonics(force.real, 2)[1:], np.array([[23.5327823691, 10.9101013014],
                                                  [5.47798647633, 10.2625607222]]))  # fmt: skip
    agree(harmonics(force.imag, 2)[1:], np.array([[2.90341496116, 16.0005509642],
                                                  [1.09037731583, -5.47798647633]]))  # fmt: skip
    force = shaken(slider(), EVEN).force
    across = harmonics(force.imag, 4)
    agree(across[1], np.array([0.0, 42.75]), scale=42.75)
    assert np.abs(across[2:]).max() < 1e-11  # there the slide does not move


def test_counterweights_of_a_four_bar_leave_no_force() -> None:
    """The moment grows by the inertia of points at a radius."""
    work, members = acting(four_bar()), ("crank", "rocker")
    force = shaking(work.linkage, work.efforts, EVEN, work.speed).force
    found = counterweights(work.linkage, members, force, EVEN, work.speed)
    agree(found.real, np.array([-94.0 / 3.0, -81.375]))
    assert np.abs(found.imag).max() < 1e-10
    # with 1.5 kg on the rocker as a point, as in the table; the crank turns evenly
    linkage, more = with_counterweights(work.linkage, members, found, 81.375 / 1.5)
    fine = np.linspace(0.0, 2.0 * np.pi, 20001)
    left = shaking(linkage, [*work.efforts, *more], fine, work.speed)
    assert np.abs(left.force).max() < 1e-9
    assert np.abs(left.moment).max() == pytest.approx(4378.17513, rel=1e-6)
    before = shaking(work.linkage, work.efforts, fine, work.speed)
    assert np.abs(before.moment).max() == pytest.approx(3208.03291, rel=1e-6)


def test_a_counterweight_on_the_crank_leaves_no_force_across_the_guide() -> None:
    work = acting(slider())
    force = shaking(work.linkage, work.efforts, EVEN, work.speed).force
    found = counterweights(work.linkage, ["crank"], force, EVEN, work.speed, direction=1j)
    agree(found.real, np.array([-68.4]))
    linkage, more = with_counterweights(work.linkage, ["crank"], found, 50.0)
    left = shaking(linkage, [*work.efforts, *more], np.radians([60.0, 140.0]), work.speed)
    agree(left.force.real, np.array([45.3090225422, -67.0296401319]))
    assert np.abs(left.force.imag).max() < 1e-9
    agree(left.moment, np.array([300.272037601, 2218.07353186]))


def test_the_frame_carries_the_shaking_force_and_the_drive() -> None:
    """Without weights and loads the reactions of the frame are the shaking force, reversed."""
    work = acting(four_bar())
    q = np.radians([20.0, 100.0, 260.0])
    shake = shaking(work.linkage, work.efforts, q, work.speed)
    found = reactions(work.linkage, work.efforts, q, speed=work.speed)
    own = [found.force(one) for one in found.structure.bonds if one.by == "ground"]
    assert np.abs(sum(own) + shake.force).max() < 1e-10


def test_inertia_on_a_shaft_shakes_as_that_of_its_crank() -> None:
    """Behind a pair, where both are hurried alike."""
    moments = []
    for name in ("crank", "pair.wheel2"):
        mass = [{"of": name, "inertia_kg_m2": 0.01}]
        design = gearcam.load("profiles/nail_machine_slide.toml").with_({"mass": mass, "load": []})
        moments.append(gearcam.build(design).study("balance").facts["balance.moment_nm"])
    assert moments[0] == pytest.approx(moments[1], rel=1e-9)
    assert moments[0] > 1.0


def test_the_study_tells_force_harmonics_and_counterweights() -> None:
    asked = {"counterweights": ["crank", "rocker"], "radius_mm": 40}
    study = four_bar(balance=asked).study("balance")
    facts, table = study.facts, study.columns
    assert facts["balance.force_n"] == pytest.approx(np.max(table["force_n"]))
    assert facts["balance.counterweights.crank.unbalance_kg_mm"] == pytest.approx(94.0 / 3.0)
    assert facts["balance.counterweights.crank.angle_deg"] == pytest.approx(180.0)
    assert facts["balance.balanced_n"] == 0.0
    assert np.abs(table["balanced_n"]).max() < 1e-9
    assert facts["balance.harmonics.0.force_x_cos_n"] == pytest.approx(23.5327823691)
    assert {*study.charts} == {"shaking", "shaking_force", "shaking_moment"}
    plain = four_bar().study("balance")
    assert "balanced_n" not in plain.columns
    assert "balance.counterweights" not in plain.facts


@pytest.mark.parametrize(
    ("changes", "words"),
    [
        (
            {"balance": {"counterweights": ["coupler"]}},
            "is no member that turns about a",
        ),
        ({"balance": {"radius_mm": 4}}, "counterweights"),
        ({"mass": []}, "no member has a mass"),
        ({"drive": [{"name": "motor", "even": True}]}, "is missing"),
    ],
)
def test_what_is_refused(changes: Any, words: str) -> None:
    with pytest.raises(DesignError, match=words):
        four_bar(**changes).study("balance")
