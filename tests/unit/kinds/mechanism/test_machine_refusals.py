"""What is said to machines that are wrong or cannot move: what, where, what is allowed instead."""

from __future__ import annotations

import copy
import math
import re
from pathlib import Path
from typing import Any

import numpy as np
import pytest

import gearcam as gc
from gearcam.base.adjustments import Adjustment
from gearcam.cli import main
from gearcam.designs.writing import toml_text
from helpers_sampling import few
from random_designs.designs import design as random_design

PROFILES = Path(__file__).parents[4] / "profiles"

BASE: dict[str, Any] = {
    "kind": "mechanism",
    "name": "mine",
    "drive": [{"name": "motor", "even": True, "speed_rpm": 60}],
    "joint": [{"name": "D", "at_mm": [110, 0]}],
    "guide": [{"name": "bed", "at_mm": [0, -20]}],
    "crank": [{"name": "crank", "on": "motor", "joint": "B", "length_mm": 40}],
    "dyad": [
        {
            "type": "RRR", "from": "B", "to": "D", "joint": "C", "members": ["coupler", "rocker"],
            "lengths_mm": [120, 90],
        },
        {
            "type": "RRT", "from": "C", "to": "bed", "joint": "S", "members": ["rod", "ram"],
            "lengths_mm": [200, 0],
        },
    ],
    "point": [{"name": "P", "on": "coupler", "at_mm": [49, 34]}],
    "output": {"files": ["csv"], "outputs": ["S", "P"]},
}  # fmt: skip

SLIDER = {
    "type": "RTT", "from": "C", "to": "bed", "joint": "S", "members": ["rod", "ram"],
}  # fmt: skip

TRIAD = [
    {
        "type": "RRR", "from": "X", "to": "D", "joint": "Y", "members": ["m1", "m2"],
        "lengths_mm": [100, 100],
    },
    {
        "type": "RRR", "from": "Y", "to": "D", "joint": "X", "members": ["m3", "m4"],
        "lengths_mm": [100, 100],
    },
]  # fmt: skip

CHAIN = {
    "on": "motor", "at_mm": [600, 300], "radius_mm": 100, "joint": "h", "lever": "door",
    "length_mm": 1735, "start_deg": -90, "range_deg": [-90, -30],
}  # fmt: skip

PLATE = gc.load(PROFILES / "translating_cam.toml").to_dict()
FLAT = gc.load(PROFILES / "valve_lever.toml").to_dict()
LIFTED = gc.load(PROFILES / "lathe_slide.toml").to_dict()
OPEN = gc.load(PROFILES / "log_spiral.toml").to_dict()

GLOBOID = gc.load(PROFILES / "globoidal_indexer.toml").to_dict()
DRUM = {**gc.load(PROFILES / "cylinder_cam.toml").to_dict(), "kind": "cam"}

Document = dict[str, Any]
Path_ = tuple[str | int, ...]


def edited(path: Path_, value: Any) -> Document:
    """The four-bar with a slide, with one value changed."""
    document = copy.deepcopy(BASE)
    node: Any = document
    for key in path[:-1]:
        node = node[key]
    node[path[-1]] = value
    return document


def longer(**tables: list[Document]) -> Document:
    """The same with more rows of tables."""
    document = copy.deepcopy(BASE)
    for title, rows in tables.items():
        document[title] = document.get(title, []) + rows
    return document


def on_cam(cam: Document, **crank: Any) -> Document:
    """The same with a crank on the follower of another cam."""
    row = {"name": "k", "on": "cam.follower", "joint": "K", "length_mm": 40, **crank}
    return longer(drive=[{"name": "cam", "cam": cam}], crank=[row])


def slid(formula: str) -> Document:
    """The same with a slide that moves by a formula."""
    rows = {"drive": [{"name": "cyl", "slide": formula}]}
    return longer(**rows, slide=[{"name": "z", "on": "cyl", "joint": "Z"}])


DYAD = ("dyad", 0)

KEYS = (
    "type, from, to, joint, members, lengths_mm, beta_deg, gammas_deg, slide_on, branch, near_mm, "
    "change, driven"
)

WRONG: dict[str, tuple[Document, str, str, str, str]] = {
    # name: document, key, message, what is allowed, hint
    "unknown joint": (
        edited((*DYAD, "from"), "b"), "dyad[0].from", '"b": nothing has this name',
        "a joint: B, D, P, S", "did you mean B?",
    ),
    "unknown shaft": (
        edited(("crank", 0, "on"), "moter"), "crank[0].on", '"moter": nothing has this name',
        "a shaft: motor, motor.shaft", "did you mean motor?",
    ),
    "unknown member": (
        edited(("point", 0, "on"), "couple"), "point[0].on", '"couple": nothing has this name',
        "a member: coupler, crank, ground, ram, rocker, rod", "did you mean coupler?",
    ),
    "name twice": (
        edited(("dyad", 1, "members"), ["rod", "crank"]), "dyad[1].members[1]",
        'the name "crank" is given twice, first by crank[0].name', "a name for one thing", "",
    ),
    "member twice": (
        edited(("dyad", 1, "members"), ["rod", "rod"]), "dyad[1].members[1]",
        'the name "rod" is given twice, first by dyad[1].members[0]', "a name for one thing", "",
    ),
    "name of the ground": (
        edited(("crank", 0, "name"), "ground"), "crank[0].name",
        'the name "ground" is given twice, first to the frame', "a name for one thing", "",
    ),
    "comparison twice": (
        {**longer(compare=[{"name": "x", "even": True}, {"name": "x", "even": True}]),
         "drive": [{"name": "motor", "pair": OPEN}], "crank": [], "dyad": [], "point": [],
         "output": {"files": ["csv"]}},
        "compare[1].name", 'the name "x" is given twice, first by compare[0].name',
        "a name for one thing", "",
    ),
    "no name": (
        edited(("crank", 0, "name"), "my crank"), "crank[0].name", '"my crank" is no name',
        "letters, digits, _ and -, the first a letter", "",
    ),
    "guide for a joint": (
        edited((*DYAD, "to"), "bed"), "dyad[0].to", '"bed" is a guide',
        "a joint: B, D, P, S", "",
    ),
    "joint for a guide": (
        edited(("dyad", 1, "to"), "D"), "dyad[1].to", '"D" is a joint', "a guide: bed", "",
    ),
    "member for a joint": (
        edited((*DYAD, "to"), "crank"), "dyad[0].to", '"crank" is a member',
        "a joint: B, D, P, S", "",
    ),
    "one joint at both ends": (
        edited((*DYAD, "to"), "B"), "dyad[0].to", '"B": is also where it comes from',
        "another joint or guide", "",
    ),
    "guide through what moves": (
        edited(("guide", 0, "through"), "B"), "guide[0].through", '"B" moves',
        "a joint that stands still, or shaft: D, motor, motor.shaft", "",
    ),
    "crank on a follower that slides": (
        on_cam(LIFTED), "crank[1].on", '"cam.follower" is a slide',
        "a shaft: cam.shaft, motor, motor.shaft", "",
    ),
    "slide on a shaft": (
        longer(slide=[{"name": "z", "on": "motor", "joint": "Z"}]), "slide[0].on",
        '"motor" is a shaft', "the name of a slide", "",
    ),
    "branch of another type": (
        edited((*DYAD, "branch"), "ahead"), "dyad[0].branch", '"ahead": is not of RRR',
        "left or right", "",
    ),
    "branch of one position": (
        edited(("dyad", 1), {**SLIDER, "gammas_deg": [0, 90], "branch": "left"}),
        "dyad[1].branch", '"left": is not of RTT', "no branch: RTT has one position", "",
    ),
    "parallel slides": (
        edited(("dyad", 1), {**SLIDER, "gammas_deg": [0, 180]}), "dyad[1].gammas_deg[1]",
        "180: leaves the slides parallel", "90 for a right angle, not 0 or 180 deg", "",
    ),
    "no length": (
        edited((*DYAD, "lengths_mm"), [120, 0]), "dyad[0].lengths_mm[1]",
        "0: the length of rocker in dyad C is 0", "above 0 in RRR", "",
    ),
    "mistyped key": (
        edited((*DYAD, "lenghts_mm"), [1, 2]), "dyad[0].lenghts_mm",
        "unknown key (its value is [1, 2])",
        KEYS, "did you mean lengths_mm?",
    ),
    "slide as master": (
        {**BASE, "drive": [{"name": "cyl", "slide": "20*sin(q)"}], "crank": [], "dyad": [],
         "point": [], "slide": [{"name": "z", "on": "cyl", "joint": "Z"}],
         "output": {"files": ["csv"]}},
        "drive[0].slide", '"20*sin(q)" has no angle over which the motion could be given',
        "a first drive with pair, cam or even = true, and the slide behind it", "",
    ),
    "plate without its place": (
        longer(drive=[{"name": "plate", "cam": PLATE}]), "drive[1].slide",
        "is missing: a plate moves by it",
        'the plate\'s place in mm as a formula in q, such as "50*(1 - cos(q))"', "",
    ),
    "place of a cam that turns": (
        longer(drive=[{"name": "drum", "cam": DRUM, "slide": "q"}]), "drive[1].slide",
        '"q": is not of a cam that turns', "a cam of the form translating", "",
    ),
    "place of an even shaft": (
        longer(drive=[{"name": "even", "even": True, "slide": "q"}]), "drive[1].slide",
        '"q": is given beside even = true',
        "exactly one of pair, cam, even and slide; slide also beside a cam of the form translating",
        "",
    ),
    "plate as the master": (
        {**BASE, "drive": [{"name": "motor", "cam": PLATE, "slide": "q"}], "crank": [],
         "dyad": [], "point": [], "output": {"files": ["csv"]}},
        "drive[0].slide", '"q" has no angle over which the motion could be given',
        "a first drive with pair, cam or even = true, and the plate behind it", "",
    ),
    "plate to compare": (
        {**longer(compare=[{"name": "x", "cam": PLATE}]),
         "drive": [{"name": "motor", "cam": LIFTED}],
         "crank": [], "dyad": [], "point": [], "output": {"files": ["csv"]}},
        "compare[0].cam", 'the cam "translating_cam" slides: it has no angle',
        "a cam that turns", "",
    ),
    "ratio of a plate": (
        longer(drive=[{"name": "plate", "cam": PLATE, "slide": "q", "ratio": 2}]),
        "drive[1].ratio", "has no effect: its formula is in the master's q", "1", "",
    ),
    "crank on the shaft of a cam in space": (
        longer(drive=[{"name": "drum", "cam": DRUM}],
               crank=[{"name": "k", "on": "drum.shaft", "joint": "K", "length_mm": 40}]),
        "crank[1].on", '"drum.shaft": it lies in the plane, across which all shafts stand',
        "a shaft: motor, motor.shaft", "",
    ),
    "crank on the shaft of a plate": (
        longer(drive=[{"name": "p", "cam": PLATE, "slide": "q"}],
               crank=[{"name": "k", "on": "p.shaft", "joint": "K", "length_mm": 40}]),
        "crank[1].on", '"p.shaft": a plate slides: it has no shaft',
        "a shaft: motor, motor.shaft", "",
    ),
    "slide on a turret": (
        longer(drive=[{"name": "g", "cam": GLOBOID}],
               slide=[{"name": "z", "on": "g.turret", "joint": "Z"}]),
        "slide[0].on", '"g.turret" is a shaft', "the name of a slide", "",
    ),
    "no driven length": (
        edited(("dyad", 1), {**SLIDER, "type": "RTRR", "to": "D", "lengths_mm": [9, 9]}),
        "dyad[1].driven", "is missing", "the name of a slide, with type RTRR", "",
    ),
    "wheel over the joint of its chain": (
        longer(chain=[{**CHAIN, "at_mm": [0, 0], "radius_mm": 500, "length_mm": 100}]),
        "chain[0].start_deg", "-90: puts the joint h inside the wheel",
        "a direction in which it is outside", "",
    ),
    "load on what stands still": (
        longer(load=[{"on": "D", "force_n": [0, 1]}]), "load[0].on",
        '"D" stands still: what acts on it does no work', "the name of what moves", "",
    ),
    "mass of the ground": (
        longer(mass=[{"of": "ground", "mass_kg": 1}]), "mass[0].of",
        '"ground" stands still: what acts on it does no work', "the name of what moves", "",
    ),
    "stretch over the end of a turn": (
        longer(stretch=[{"on": "P", "from_deg": 280, "to_deg": 100, "shape": "line"}]),
        "stretch[0].to_deg", "100: is not above from_deg",
        "a later angle: 460 is the same place of the next turn", "",
    ),
    "load over no turn": (
        longer(load=[{"on": "S", "force_n": 1, "from_deg": 370, "to_deg": 10}]),
        "load[0].to_deg", "10: is not above from_deg",
        "a later angle: 730 is the same place of the next turn", "",
    ),
    "no number": (
        edited(("crank", 0, "length_mm"), -40), "crank[0].length_mm", "-40 is out of range",
        "a number from 0.001 to 100000 mm", "",
    ),
}  # fmt: skip
"""Documents with one mistake: each is said once, without what follows from it."""


@pytest.mark.parametrize("name", WRONG)
def test_a_mistake_is_said_once_with_its_place_and_what_is_allowed(name: str) -> None:
    document, key, message, allowed, hint = WRONG[name]
    with pytest.raises(gc.DesignError) as caught:
        gc.design(document)
    (found,) = caught.value.problems
    assert (found.key, found.message, found.allowed, found.hint) == (key, message, allowed, hint)


def test_parts_that_wait_for_each_other_are_named() -> None:
    with pytest.raises(gc.DesignError) as caught:
        gc.design(longer(dyad=TRIAD))
    told = {one.key: one.message for one in caught.value.problems}
    assert told == {
        "dyad[2]": "waits for X, which waits for it: no order solves both",
        "dyad[3]": "waits for Y, which waits for it: no order solves both",
    }


ASKED: dict[str, tuple[Document, str, str, str]] = {
    "output": (
        edited(("output", "outputs"), ["rocker"]), "output.outputs[0]",
        '"rocker": nothing moves by this name', "did you mean rocker.angle?",
    ),
    "what stands still": (
        edited(("output", "outputs"), ["S", "D"]), "output.outputs[1]",
        '"D": nothing moves by this name', "D stands still",
    ),
    "dwell of nothing": (
        longer(dwell=[{"on": "s", "within_mm": 1}]), "dwell[0].on",
        '"s": nothing moves by this name', "did you mean S?",
    ),
    "dwell of a point": (
        longer(dwell=[{"on": "P", "within_mm": 1}]), "dwell[0].on",
        '"P" is a point, with two coordinates', "",
    ),
    "dwell of a length in deg": (
        longer(dwell=[{"on": "S", "within_deg": 1}]), "dwell[0].within_deg", "S is a length", "",
    ),
    "interval of an angle in mm": (
        longer(interval=[{"on": "rocker.angle", "travel_mm": 1}]), "interval[0].travel_mm",
        "rocker.angle is an angle", "",
    ),
    "stretch of nothing": (
        longer(stretch=[{"on": "C", "from_deg": 0, "to_deg": 9, "shape": "line"}]), "stretch[0].on",
        '"C" is not a point that is asked for', "add it to output.outputs",
    ),
}  # fmt: skip


@pytest.mark.parametrize("name", ASKED)
def test_what_is_asked_for_must_move(name: str) -> None:
    document, key, message, hint = ASKED[name]
    with pytest.raises(gc.DesignError) as caught:
        gc.design(document)
    (found,) = caught.value.problems
    assert (found.key, found.message, found.hint) == (key, message, hint)
    assert found.allowed


RANGED = {**BASE, "drive": [{"name": "motor", "even": True, "range_deg": [50, 90]}]}

IMPOSSIBLE: dict[str, tuple[Document, str, str]] = {
    "no arm on an even shaft": (
        edited(("crank", 0, "arm_angle_deg"), 30), "crank[0].arm_angle_deg",
        "motor has no arm from which it could count",
    ),
    "no arm of a flat follower": (
        on_cam(FLAT, arm_angle_deg=20), "crank[1].arm_angle_deg",
        "cam.follower has no arm from which it could count",
    ),
    "interval beyond the stroke": (
        longer(interval=[{"on": "S", "travel_mm": 5000}]), "interval[0].travel_mm",
        "S does not travel as far",
    ),
    "interval of what does not move": (
        {**edited(("dyad", 1), {**SLIDER, "gammas_deg": [0, 90]}),
         "interval": [{"on": "rod.angle", "travel_deg": 1}]},
        "interval[0].travel_deg", "rod.angle does not move",
    ),
    "interval before the range": (
        {**RANGED, "interval": [{"on": "S", "travel_mm": 1, "before": "outer"}]},
        "interval[0].travel_mm", "S does not travel as far before its outer dead centre",
    ),
    "interval of what turns on": (
        longer(interval=[{"on": "crank.angle", "travel_deg": 5}]), "interval[0].on",
        "crank.angle turns on and has no dead centre",
    ),
    "open drive behind a closed one": (
        longer(drive=[{"name": "spiral", "pair": OPEN}]), "drive[1]",
        "spiral does not turn all the way, as the master does",
    ),
    "slide that goes on": (
        slid("20*q"), "drive[1]", "cyl does not return within 100 turns of the master",
    ),
    "slide without a place": (
        slid("sqrt(q - 3)"), "drive[1].slide",
        "the place or its derivatives are not finite at 0 deg",
    ),
    "slide without an end": (
        slid("1/q"), "drive[1].slide", "the place or its derivatives are not finite at 0 deg",
    ),
    "chain without an end": (
        longer(chain=[CHAIN]), "chain[0]", "its chain is not back after a turn of the master",
    ),
    "circle through a line": (
        {**longer(stretch=[{"on": "C", "from_deg": 0, "to_deg": 9, "shape": "circle"}]),
         "dyad": [{**SLIDER, "from": "B", "joint": "C", "gammas_deg": [0, 90]}],
         "point": [{"name": "P", "on": "ground", "at_mm": [3, 4]}],
         "stretch": [{"on": "P", "from_deg": 0, "to_deg": 9, "shape": "circle"}],
         "output": {"files": ["csv"], "outputs": ["P"]}},
        "stretch[0].shape", "the stretch is a point: no circle is nearest to it; take a line",
    ),
}  # fmt: skip


def test_a_stretch_beyond_an_open_range_names_both() -> None:
    stretch = {"on": "P", "from_deg": 60, "to_deg": 100, "shape": "line"}
    result = gc.build(gc.design({**RANGED, "stretch": [stretch]}))
    told = "stretch.0..to_deg: 100 is beyond the master's range"
    with pytest.raises(gc.DesignError, match=told):
        _ = result.stretches


def guided(arm: float, across: float) -> Document:
    """A crank whose block slides on a guide."""
    dyad = {
        "type": "RTR", "from": "D", "to": "B", "joint": "C", "members": ["rocker", "block"],
        "lengths_mm": [0, arm], "beta_deg": across,
    }  # fmt: skip
    return {
        **edited(("crank", 0, "length_mm"), 110 - arm),
        "dyad": [dyad],
        "point": [],
        "output": {},
    }


@pytest.mark.parametrize(
    ("arm", "told"),
    [(0, "D and B meet there"), (30, "at right angles to the way between D and B there")],
)
def test_how_a_guide_is_singular(arm: float, told: str) -> None:
    with pytest.raises(gc.InfeasibleError, match=f"C is singular at (0|360) deg: .*{told}"):
        _ = gc.build(gc.design(guided(arm, 90))).linkage


@pytest.mark.parametrize("name", IMPOSSIBLE)
def test_what_cannot_be_is_refused_with_its_place(name: str, tmp_path: Path) -> None:
    document, where, what = IMPOSSIBLE[name]
    with pytest.raises(gc.InfeasibleError) as caught:
        gc.build(gc.design(document)).write(tmp_path)
    assert (caught.value.where, caught.value.what) == (where, what)


@pytest.mark.slow
def test_remedies_of_a_ring_are_found_in_its_machine() -> None:
    ring = {
        "kind": "gear-pair", "name": "wheels",
        "law": {"type": "limacon", "eccentricity": 0.332499},
        "pair": {"teeth": [10, 20], "center_distance_mm": 124.361, "type": "internal"},
    }  # fmt: skip
    drive = {"name": "pair", "pair": ring}
    made = gc.build(gc.design({"kind": "mechanism", "name": "mine", "drive": [drive]}))
    found = gc.remedies(made).found
    assert found
    assert all(key.startswith("drive[0].pair.") for one in found for key in one.changes)


def test_a_remedy_that_its_key_does_not_allow_is_none() -> None:
    made = gc.build(gc.design(longer(interval=[{"on": "S", "travel_mm": 5000}])))
    change = {"interval[0].travel_mm": 1e-9}
    told = gc.InfeasibleError("too far", adjustments=[Adjustment(near=change)])
    assert not gc.remedies(made, told).found


def test_a_drive_alone_shows_how_it_moves() -> None:
    drive = {"name": "pair", "pair": OPEN}
    made = gc.build(gc.design({"kind": "mechanism", "name": "mine", "drive": [drive]}))
    assert [one.name for one in made.outputs] == ["pair.wheel2"]


def test_a_slide_may_repeat_after_several_turns() -> None:
    made = gc.build(gc.design(slid("20*sin(q/3)")))
    assert made.linkage.span == pytest.approx((0.0, 6.0 * math.pi))


def test_a_dwell_that_is_not_there_is_told() -> None:
    made = gc.build(gc.design(longer(dwell=[{"on": "S", "within_mm": 0.001, "least_deg": 100}])))
    (found,) = (one for one in made.findings if one.code == "no-dwell")
    assert (found.limit, found.unit) == (pytest.approx(100.0), "deg")
    assert found.value is not None
    assert 0.0 < found.value < 100.0


# --- what does not close ------------------------------------------------------------------------

SHORT = edited((*DYAD, "lengths_mm"), [100, 40])
LINED = edited((*DYAD, "lengths_mm"), [100, 50])
"""The rods reach the largest distance of their ends, 150 mm, not quite and just so."""


def test_the_range_and_the_nearest_length_are_told_and_help(
    tmp_path: Path, capsys: pytest.CaptureFixture[str]
) -> None:
    (tmp_path / "mine.toml").write_text(toml_text(SHORT))
    assert main(["build", str(tmp_path / "mine.toml"), "-o", str(tmp_path)]) == 3
    told = " ".join(capsys.readouterr().err.split())
    # the law of cosines for a distance of 140 mm
    end = math.degrees(math.acos((110**2 + 40**2 - 140**2) / (2 * 110 * 40)))
    assert f"it does from -{end:.5f}" in told
    assert "at dyad[0].lengths_mm[1] value 40 mm, limit 50.05 mm" in told
    assert "without errors: dyad[0].lengths_mm[1] = 50.08 (" in told
    assert "Traceback" not in told
    assert not re.search(r"\b(None|nan)\b", told)


def test_a_machine_is_not_changed_unasked(tmp_path: Path) -> None:
    made: Any = gc.design(SHORT)
    with pytest.raises(gc.InfeasibleError):
        gc.build(made).write(tmp_path)
    assert made.dyad[0].lengths == (100.0, 40.0)
    assert made.to_dict()["dyad"][0]["lengths_mm"] == [100, 40]
    assert not [*tmp_path.rglob("*.csv")]


def test_three_joints_in_a_line_keep_what_the_file_says() -> None:
    found = gc.build(gc.design(LINED))
    assert found.linkage.dyads[0].changes == pytest.approx([math.pi])
    q = np.radians([170.0, 190.0])
    for change, sides in (("branch", (1.0, 1.0)), ("motion", (1.0, -1.0))):
        document = copy.deepcopy(LINED)
        document["dyad"][0]["change"] = change
        known = gc.build(gc.design(document)).linkage.at(q, 0)
        b, c = (np.asarray(known.jet(name).c[0]) for name in "BC")
        assert tuple(np.sign(np.imag((c - b) / (110.0 - b)))) == sides


def _refused_ones() -> list[Any]:
    """Random four-bars and sliders that do not close everywhere, but somewhere."""
    rng = np.random.default_rng(3)
    made = []
    for number in range(24):
        document = copy.deepcopy(BASE)
        dyad = document["dyad"]
        if number % 2:
            dyad[0]["lengths_mm"] = rng.uniform(60, 75, 2).round(3).tolist()
            document["dyad"] = dyad[:1]
        else:
            dyad[1] |= {"from": "B", "lengths_mm": [round(float(rng.uniform(25, 55)), 3), 0]}
            document["dyad"] = dyad[1:]
        document["point"], document["output"] = [], {"files": ["csv"]}
        made.append(gc.design(document))
    return made


@pytest.mark.parametrize("number", few(range(24), 5))
def test_the_range_that_is_told_is_the_one_in_which_it_closes(number: int) -> None:
    made = _refused_ones()[number]
    with pytest.raises(gc.InfeasibleError) as caught:
        _ = gc.build(made).linkage
    told = [
        tuple(map(float, one)) for one in re.findall(r"from (\S+) to (\S+) deg", str(caught.value))
    ]
    assert told
    for low, high in told:
        gap = 1e-4 * (high - low)

        def closes(first: float, last: float) -> bool:
            try:
                _ = gc.build(made.with_({"drive[0].range_deg": [first, last]})).linkage
            except gc.InfeasibleError:
                return False
            return True

        assert closes(low + gap, high - gap)
        assert not closes(low - gap, high - gap)
        assert not closes(low + gap, high + gap)
    for adjustment in caught.value.adjustments:
        way: dict[str, Any] = dict(adjustment.near)
        assert gc.build(made.with_(way)).linkage.closed
        # the nearest one: nearer by more than what is left spare it does not close
        nearer = {
            key: value * (1.0 - 3e-3 if value > old else 1.0 + 3e-3)
            for key, value in way.items()
            if (old := made.dyad[0].lengths[int(key[-2])]) != value
        }
        if len(way) == 1:
            with pytest.raises(gc.InfeasibleError):
                _ = gc.build(made.with_(nearer)).linkage


def _told(path: Path) -> gc.DesignError | gc.InfeasibleError | None:
    """Why a design is not built."""
    try:
        gc.build(gc.load(path)).write(path.parent / "out")
    except (gc.DesignError, gc.InfeasibleError) as error:
        return error
    return None


@pytest.mark.parametrize("number", [4, pytest.param(60, marks=pytest.mark.slow)])
def test_random_machines_are_built_or_refused_with_reasons(number: int, tmp_path: Path) -> None:
    """Campaigns of `make fuzz` build more."""
    ends = {"built": 0, "refused": 0, "wrong": 0}
    for index in range(number):
        told = _told(random_design("mechanism", 9, index).write(tmp_path / str(index)))
        if isinstance(told, gc.InfeasibleError):
            assert told.where, index
            assert not re.search(r"\b(None|nan)\b", str(told)), index
        elif told is not None:
            assert all(one.message for one in told.problems), index
        end = {None: "built", gc.InfeasibleError: "refused"}.get(told and type(told), "wrong")
        ends[end] += 1
    assert min(ends.values()) > 0 or number < 30
    assert ends["built"] > 0.6 * number
