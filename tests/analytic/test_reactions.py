"""Forces in the joints of linkages: values of another program, closed forms, another method."""

from __future__ import annotations

import math
from typing import Any

import numpy as np
import pytest

import gearcam
from gearcam.kinds.mechanism.forces import JointForces
from gearcam.linkages.bonds import Hinge, SlidingJoint
from gearcam.linkages.closing import NotClosingError, settled
from gearcam.linkages.coordinates import MemberTurn
from gearcam.linkages.efforts import Effort, InertiaForce, force_on
from gearcam.linkages.elements import MemberPoint
from gearcam.linkages.linkage import Linkage
from gearcam.linkages.reactions import Reactions, reactions
from helpers_linkages import agree
from helpers_random_linkages import drawn
from witness.multipliers import Lumped, multipliers

NEWTON = 9.80665


def joints(document: dict[str, Any]) -> JointForces:
    text = {"kind": "mechanism", "name": "m", **document}
    return JointForces(gearcam.build(gearcam.design(text)))


def even(speed: float) -> list[dict[str, Any]]:
    """A shaft that turns evenly, with so many rad/s."""
    return [{"name": "motor", "even": True, "speed_rpm": speed * 30.0 / math.pi}]


def values(made: JointForces, found: Reactions, name: str) -> Any:
    """The unknowns of a joint, by its name, and that of its member if it has several."""
    (bond,) = (one for one, label in made.labels.items() if label == name)
    return found.of(bond).T


FOUR_BAR: dict[str, Any] = {
    "drive": even(20.0),
    "joint": [{"name": "D", "at_mm": [110, 0]}, {"name": "S", "at_mm": [150, 160]}],
    "crank": [{"name": "crank", "on": "motor", "joint": "B", "length_mm": 40}],
    "dyad": [{"type": "RRR", "from": "B", "to": "D", "joint": "C",
              "members": ["coupler", "rocker"], "lengths_mm": [120, 90]}],
    "point": [{"name": "P", "on": "coupler",
               "at_mm": [60 * math.cos(math.radians(35)), 60 * math.sin(math.radians(35))]}],
    "mass": [{"of": "crank", "mass_kg": 0.5, "at_mm": [15, 0]},
             {"of": "coupler", "mass_kg": 1.1, "at_mm": [55, 12], "inertia_kg_m2": 0.0019},
             {"of": "rocker", "mass_kg": 0.9, "at_mm": [40, 0], "inertia_kg_m2": 0.0011}],
    "gravity": {"direction_deg": -90},
    "load": [{"on": "P", "force_n": [30, -200]}, {"on": "rocker", "torque_nm": -5}],
    "spring": [{"between": ["P", "S"], "stiffness_n_mm": 1.5, "free_length_mm": 50}],
}  # fmt: skip

FOUR_BAR_FORCES = """
30  -267.975234585 -56.2259841882 -265.377158374 -59.6293091882 -124.15951761 -192.186190335
    111.078956116 204.675714836 3305.61936499
150 -181.791532098 -12.2271895792 -184.38960831 -15.6305145792 6.81762882764 -127.288903008
    -3.46086311129 135.417495398 4165.55301399
270 -158.779181184 -59.8219038435 -158.779181184 -67.7252288435 48.2825963253 -131.435268683
    -43.7508229297 143.311566671 -6351.16724735
"""
"""Crank angle, deg; bearing of the crank, B, C, D; the driver's moment."""


def table(text: str, columns: int) -> Any:
    return np.array(text.split(), dtype=float).reshape(-1, columns).T


def test_a_four_bar_with_masses_loads_and_a_spring() -> None:
    angle, *known = table(FOUR_BAR_FORCES, 10)
    made = joints(FOUR_BAR)
    found = made.at(np.radians(angle))
    own = [one for name in ("motor", "B", "C", "D") for one in values(made, found, name)]
    agree(np.array([*own, found.moment]), np.array(known))


def slider(**changes: Any) -> dict[str, Any]:
    """An offset slider-crank with masses, a load against its motion, and a spring."""
    place, load = changes.pop("place", (30, 15)), changes.pop("load", (40, 25))
    return {
        "drive": even(25.0),
        "guide": [{"name": "bed", "at_mm": [0, 20]}],
        "crank": [{"name": "crank", "on": "motor", "joint": "B", "length_mm": 60}],
        "dyad": [{"type": "RRT", "from": "B", "to": "bed", "joint": "C",
                  "members": ["rod", "slide"], "lengths_mm": [200, 0]}],
        "point": [{"name": "L", "on": "slide", "at_mm": list(load)}],
        "mass": [{"of": "crank", "mass_kg": 0.9, "at_mm": [20, 0]},
                 {"of": "rod", "mass_kg": 1.4, "at_mm": [80, 5], "inertia_kg_m2": 0.006},
                 {"of": "slide", "mass_kg": 2.2, "at_mm": list(place)}],
        "gravity": {"direction_deg": -90},
        "load": [{"on": "L", "force_n": 600, "direction_deg": 0, "against": True},
                 {"on": "C", "formula": "-2*(x - 120)"}],
        **changes,
    }  # fmt: skip


RUBBING = {"friction": {"joint": 0.1, "journal_radius_mm": 8, "guide": 0.12, "guide_length_mm": 80}}

SLIDER: dict[str, tuple[dict[str, Any], str, str]] = {
    "without friction": (slider(), "motor B C bed", """
60  -452.961409908 55.3616371261 -447.336409908 56.2784379187 -421.256616557 69.7472490759
    -48.1726190759 16188.977213 25020.8946886
140 -434.718397005 38.3742270698 -443.33639699 36.7796026787 -480.223355049 43.4535221631
    -21.8788921631 14845.7975506 15272.5580241
290 757.524387403 368.943883113 761.372114016 349.546356129 770.873889582 305.765420112
    -284.190790112 -14355.0305798 50160.8324152"""),
    "it tips": (slider(**RUBBING), "motor C bed", """
60  -502.669863914 67.3590421229 -470.965070563 81.7446540727 -60.1700240727 16569.4846688
    28766.8385358
140 -478.000510714 42.2605951223 -523.505468758 47.3398902156 -25.7652602156 14427.3712364
    17533.9024803
290 798.496416179 393.461757456 811.845918358 330.283294456 -308.708664456 -13657.3429253
    54387.331133"""),
    "it does not tip": (slider(place=(0, 0), load=(0, 0), **RUBBING), "motor C bed", """
60  -459.296658055 59.9827526058 -427.591864703 74.3683645556 -52.7937345556 345.485584661
    26221.8111745
290 794.359654831 391.713654901 807.70915701 328.5351919 -306.9605619 694.113046807
    54111.0794754"""),
}  # fmt: skip


@pytest.mark.parametrize("name", SLIDER)
def test_a_slider_crank(name: str) -> None:
    document, bonds, text = SLIDER[name]
    names = bonds.split()
    angle, *known = table(text, 2 + 2 * len(names))
    made = joints(document)
    found = made.at(np.radians(angle))
    own = [one for name in names for one in values(made, found, name)]
    agree(np.array([*own, found.moment]), np.array(known))


def test_the_loss_of_a_slider_crank() -> None:
    made = joints(slider(**RUBBING))
    found = made.at(np.radians([60.0, 140.0, 290.0]))
    agree(found.lost * 25e-3, np.array([93.6485961795, 56.5336114057, 105.662467945]))
    assert found.apart < 1e-13


QUICK_RETURN: dict[str, Any] = {
    "drive": even(2.0 * math.pi),
    "joint": [{"name": "pivot", "at_mm": [0, -150]}],
    "crank": [{"name": "crank", "on": "motor", "joint": "pin", "length_mm": 60}],
    "guide": [{"name": "bed", "at_mm": [0, 150]}],
    "dyad": [
        {"type": "RTR", "from": "pivot", "to": "pin", "joint": "A", "members": ["rocker", "block"]},
        {"type": "RRT", "from": "E", "to": "bed", "joint": "F", "members": ["link", "ram"],
         "lengths_mm": [100, 0]},
    ],
    "point": [{"name": "E", "on": "rocker", "at_mm": [320, 0]},
              {"name": "T", "on": "ram", "at_mm": [120, -60]}],
    "mass": [{"of": "crank", "mass_kg": 2, "at_mm": [10, 0]},
             {"of": "block", "mass_kg": 0.6, "center": "pin", "inertia_kg_m2": 0.0004},
             {"of": "rocker", "mass_kg": 6, "at_mm": [170, 0], "inertia_kg_m2": 0.12},
             {"of": "link", "mass_kg": 1.2, "at_mm": [50, 0], "inertia_kg_m2": 0.0015},
             {"of": "ram", "mass_kg": 12, "at_mm": [80, 30]}],
    "gravity": {"direction_deg": -90},
    "load": [{"on": "T", "formula": "1500*(v < 0)", "direction_deg": 0}],
}  # fmt: skip

QUICK_RETURN_FORCES = """
30  -2479.66286455 739.656207635 -2478.9790783 720.437691811 2578.92215721 -1.88816716234
    949.017606902 -537.685562527 -1523.50995758 119.463778178 -1521.45451223 107.832255096
    9.84754490398 -79941.980633 111974.269087
110 -2228.38940125 -198.231571705 -2228.65944953 -217.102920151 2240.13820211 0.496531300726
    739.060701018 562.684370977 -1491.65783289 285.216192471 -1492.33707289 274.017270137
    -156.337470137 -80815.5038134 130043.423213
260 353.341709937 68.1251241969 353.204602831 47.7342511623 -355.26816507 6.65249145457
    -249.7480876 -6.30339713279 84.5447212442 -10.8179527728 77.1726754801 -19.974221778
    137.654021778 7099.2037356 20338.9217944
"""


def test_a_six_bar() -> None:
    """The load acts while the ram moves to the left: here by two angles of the crank."""
    angle, *known = table(QUICK_RETURN_FORCES, 16)
    load = {"on": "T", "force_n": [1500, 0], "from_deg": 0, "to_deg": 200}
    made = joints(QUICK_RETURN | {"load": [load]})
    found = made.at(np.radians(angle))
    own = [one for name in ("motor", "pin") for one in values(made, found, name)]
    guide = values(made, found, "A")
    # the table tells what the block exerts on the rocker
    own += [-guide[0], -guide[1]]
    own += [one for name in ("pivot", "E", "F", "bed") for one in values(made, found, name)]
    agree(np.array([*own, found.moment]), np.array(known), relative=2e-11)


NAIL = """
60  -4277.89868081 3900.11817239 -3663.22038732 1680.3705402 -2539.54904529 -1159.01119911
    2924.20819911 -876.724150867
120 -7916.9608734 -324.999180918 -7324.07416637 -734.073284406 -5937.91169359 -911.764936534
    2676.96193653 -497.573987139
240 -11970.8342444 2145.83136484 -11103.2585928 1340.05397892 -9044.10035427 579.20850162
    1185.98849838 820.677941702
"""
"""phi1, deg; bearing of the crank, pin, slide, guide, N; moment of the pair's driver, N m."""


def test_a_machine_behind_a_pair() -> None:
    """The nail machine with masses: the crank does not turn evenly.

    The table is of a shaft that is turned by a moment: without the force of teeth.
    """
    angle, *known = table(NAIL, 9)
    profile = gearcam.load("profiles/nail_machine_slide.toml")
    masses = [
        {"of": "crank", "mass_kg": 60, "at_mm": [50, 0], "inertia_kg_m2": 0.55},
        {"of": "rod", "mass_kg": 45, "at_mm": [260, 0], "inertia_kg_m2": 2.8},
        {"of": "ram", "mass_kg": 180},
    ]
    changes = {"mass": masses, "gravity": {"direction_deg": -90}, "load": []}
    made = JointForces(gearcam.build(profile.with_(changes)))
    work, q = made.work, np.radians(angle)
    found = reactions(work.linkage, work.efforts, q, speed=work.speed)
    own = [one for name in ("pair.wheel2", "pin", "slide") for one in values(made, found, name)]
    own += [values(made, found, "bed")[0], 1e-3 * found.moment]
    agree(np.array(own), np.array(known), relative=1e-9)
    agree(made.at(q).moment, found.moment, relative=1e-12)  # teeth change bearings only


def massless(offset: float, rod: float, radius: float, **friction: Any) -> JointForces:
    """A slider-crank under 1000 N against its motion."""
    return joints({
        "drive": [{"name": "motor", "even": True}],
        "guide": [{"name": "bed", "at_mm": [0, offset]}],
        "crank": [{"name": "crank", "on": "motor", "joint": "B", "length_mm": radius}],
        "dyad": [{"type": "RRT", "from": "B", "to": "bed", "joint": "C",
                  "members": ["rod", "slide"], "lengths_mm": [rod, 0]}],
        "load": [{"on": "C", "force_n": 1000, "against": True}],
        **friction,
    })  # fmt: skip


def locked_range(made: JointForces) -> tuple[float, float]:
    """The only range of the crank in which it is locked, deg."""
    study = made.result.study("forces")
    (one,) = (one for one in study.study_findings if one.code == "self-locking")
    low, high = one.where.removeprefix("theta = ").removesuffix(" deg").split(" to ")
    return float(low), float(high)


GUIDE = {"friction": {"guide": 0.4}}
JOURNALS = {"friction": {"guide": 0.4, "joint": 0.1, "journal_radius_mm": 12}}


def test_a_guide_alone_has_the_efficiency_of_its_closed_form() -> None:
    """1 - mu*|tan(alpha)| with the rod's angle to the guide."""
    q = np.radians([30.0, 60.0, 90.0, 135.0, 200.0, 300.0])
    found = massless(0.0, 260.0, 100.0, friction={"guide": 0.12}).at(q)
    alpha = np.arcsin(100.0 * np.sin(q) / 260.0)
    agree(found.work / found.moment, 1.0 - 0.12 * np.abs(np.tan(alpha)), relative=1e-12)


@pytest.mark.parametrize(
    ("friction", "known"),
    [
        (GUIDE, [(0.901109722788, 79247.1452224), (0.112078804246, 161025.34767),
                 (0.346753702382, 485238.734078)]),
        (JOURNALS, [(0.842952715816, 84714.5655068), (0.08476957064, 212901.024317),
                    (0.302817034679, 555643.534912)]),
    ],
)  # fmt: skip
def test_the_efficiency_of_a_slider_crank(friction: Any, known: Any) -> None:
    found = massless(20.0, 125.0, 100.0, **friction).at(np.radians([30.0, 250.0, 300.0]))
    agree(np.stack([found.work / found.moment, found.moment], axis=1), np.array(known))


def test_a_slider_crank_locks_where_its_rod_is_too_steep() -> None:
    made = massless(20.0, 125.0, 100.0, **GUIDE)
    assert locked_range(made) == pytest.approx((253.862173729, 286.137826271), abs=5e-3)
    steepest = math.degrees(math.asin(120.0 / 125.0))
    assert steepest > 68.1985905136 == pytest.approx(math.degrees(math.atan(2.5)))
    share = made.result.study("forces").study_findings[0].message.split(" times")[0].split()[-1]
    assert float(share) == pytest.approx(7.0 / 24.0 / 0.4, rel=2e-3)


def test_journals_make_the_locked_range_lopsided() -> None:
    """Where both ends of the rod turn the same way their friction adds; else it cancels."""
    found = locked_range(massless(20.0, 125.0, 100.0, **JOURNALS))
    assert found == pytest.approx((253.862173729, 287.914814678), abs=5e-3)


def swinging(**friction: Any) -> JointForces:
    """A crank whose block swings a long guide that turns against a torque."""
    return joints({
        "drive": [{"name": "motor", "even": True}],
        "joint": [{"name": "pivot", "at_mm": [0, -66]}],
        "crank": [{"name": "crank", "on": "motor", "joint": "pin", "length_mm": 60}],
        "dyad": [{"type": "RTR", "from": "pivot", "to": "pin", "joint": "A",
                  "members": ["rocker", "block"]}],
        "load": [{"on": "rocker", "torque_nm": 50, "against": True}],
        **friction,
    })  # fmt: skip


def test_a_swinging_guide_locks_where_its_block_is_too_near() -> None:
    """With an arm below 2*r_f/cos(phi_B)."""
    friction = {"friction": {"joint": 0.2, "journal_radius_mm": 20, "guide": 0.2}}
    made = swinging(**friction)
    assert locked_range(made) == pytest.approx((265.180720807, 274.819279193), abs=5e-3)
    found = made.at(np.radians([90.0, 230.0, 255.0]))
    agree(found.moment, np.array([26984.1269841, 37673.3835203, 171722.382103]))
    known = np.array([15.0 / 17.0, 0.398008447288, 0.214249712064])
    agree(found.work / found.moment, known)


def test_bearings_have_their_own_friction() -> None:
    both = massless(20.0, 125.0, 100.0, **JOURNALS).at(np.radians([30.0]))
    single = [{"on": name, "coefficient": 0.1, "radius_mm": 12} for name in ("motor", "B", "C")]
    single.append({"on": "bed", "coefficient": 0.4})
    found = massless(20.0, 125.0, 100.0, bearing=single).at(np.radians([30.0]))
    assert found.moment == pytest.approx(both.moment, rel=1e-13)


def test_what_is_forgotten_or_turned_is_noticed() -> None:
    """Negative controls: reactions feel a lost load and a lost inertia; moments must agree."""
    made = joints(FOUR_BAR)
    work, q = made.work, np.radians([30.0, 150.0])
    whole = reactions(work.linkage, work.efforts, q, speed=work.speed)
    assert whole.apart < 1e-13
    for lost in (made.work.efforts[-1], *(one for one in work.efforts if one.part == "inertia")):
        rest = [one for one in work.efforts if one is not lost]
        found = reactions(work.linkage, rest, q, speed=work.speed)
        assert np.abs(found.values - whole.values).max() > 0.1
        assert np.abs(found.moment - whole.work).max() > 1e-3 or lost.part == "inertia"


def compared(seed: int, index: int) -> float | None:
    """Largest difference from multipliers, over the largest force, of a random machine."""
    drawn_one = drawn(seed, index)
    try:
        linkage = settled(drawn_one.linkage)
    except NotClosingError:
        return None
    rng = np.random.default_rng([seed, index, 7])
    places = {one.name: one.on for one in _points_of(linkage)}
    loads = [
        Lumped(
            on, name, rng.uniform(0.1, 2.0), rng.uniform(1e-4, 2e-3), complex(*rng.normal(0, 50, 2))
        )
        for name, on in places.items()
    ]
    efforts: list[Effort] = []
    for one in loads:
        efforts.append(InertiaForce.of_mass(one.point, one.mass, one.member))
        efforts.append(InertiaForce.of_turn(MemberTurn(one.member), one.inertia, one.member))
        efforts.append(force_on(one.point, one.force))
    q = float(rng.uniform(0.1, 6.1))
    found = reactions(linkage, efforts, np.array([q]), speed=3.0)
    known = multipliers(linkage, loads, q, 3.0)
    most = max(float(np.abs(one).max()) for one in known.values())
    if most > 1e5 * 50.0:  # nearly singular there: differences lose too much
        return None
    off = [
        np.abs(found.of(bond)[0] - known[bond.name, bond.on]).max()
        for bond in found.structure.bonds
        if isinstance(bond, Hinge | SlidingJoint)
    ]
    assert found.apart < 1e-9
    return float(max(off)) / most


def _points_of(linkage: Linkage) -> list[MemberPoint]:
    return [one for one in linkage.elements if isinstance(one, MemberPoint) and one.name[0] == "M"]


def demand_equal(count: int, seed: int) -> None:
    found = [one for one in (compared(seed, index) for index in range(count)) if one is not None]
    assert len(found) > 0.6 * count
    assert max(found) < 1e-4
    assert float(np.median(found)) < 1e-7


def test_random_machines_have_the_forces_of_multipliers() -> None:
    demand_equal(25, 5)


@pytest.mark.slow
def test_hundreds_of_random_machines_have_the_forces_of_multipliers() -> None:
    demand_equal(400, 11)
