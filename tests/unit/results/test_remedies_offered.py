"""What is offered keeps the motion where it can, in its order, and is what was built."""

from __future__ import annotations

import re
from pathlib import Path
from typing import Any

import pytest

import gearcam
from gearcam.base.errors import InfeasibleError
from gearcam.results.advice import Remedies
from helpers_remedies import CIRCLE, RING, cam, followed, job_of, pair
from helpers_sampling import few

SLOW = {"type": "multispeed", "ratios": [0.3, "solve"], "angles_deg": [60, 60]}
SLOW["transition_deg"] = 120
CLEAR = {"clearance_mm": 0.05}


def slow(teeth: int, distance: float) -> dict[str, Any]:
    """A pair that turns slowly for a sixth of a turn, with a clearance."""
    made = pair(SLOW, [teeth, teeth], blank=CLEAR, pair={"backlash_mm": 0.2})
    del made["pair"]["module_mm"]
    made["pair"]["center_distance_mm"] = distance
    return made


def sought(document: dict[str, Any], folder: Path) -> Remedies:
    return gearcam.remedies(job_of(document, folder))


@pytest.mark.slow
def test_teeth_keep_a_ratio_that_another_law_would_change(tmp_path: Path) -> None:
    """Two teeth more are enough, and many more are not: between them is no error."""
    found = sought(slow(60, 100.0), tmp_path).found
    assert found
    assert not any(one.moves for one in found)
    (teeth,) = (one for one in found if "pair.teeth" in one.changes)
    assert teeth.changes == {"pair.teeth": [62, 62]}
    assert teeth.less == {"pair.teeth": [61, 61]}
    assert not teeth.resized  # at a given centre distance
    assert "[61, 61] still fails" in teeth.notes


@pytest.mark.slow
def test_other_teeth_do_not_change_a_motion_with_many_decimals(tmp_path: Path) -> None:
    law = {"type": "multispeed", "ratios": [2, "solve"], "transition_deg": 70}
    law["angles_deg"] = [73.33333333333, 146.66666666667]
    found = sought(pair(law, [40, 40]), tmp_path).found
    moves = {key: one.moves for one in found for key in one.changes}
    assert moves == {"pair.teeth": False, "law.ratios": True}


RACKS: dict[str, tuple[dict[str, Any], str, float]] = {
    "a steep ring": (
        pair(CIRCLE, [20, 40], pair=RING | {"module_mm": 0.8, "backlash_mm": 0.05},
             rack={"pressure_angle_deg": 32, "dedendum": 1.23}),
        "rack.dedendum", 1.1,
    ),
    "eight teeth": (pair(CIRCLE, [8, 8]), "rack.pressure_angle_deg", 28.0),
}  # fmt: skip


@pytest.mark.parametrize("name", RACKS)
def test_another_rack_is_tried(name: str, tmp_path: Path) -> None:
    document, key, value = RACKS[name]
    found = sought(document, tmp_path).found
    assert {k: v for one in found for k, v in one.changes.items()}[key] == value
    order = [(one.moves, one.resized, len(one.remaining)) for one in found]
    assert order == sorted(order)
    assert len(found) <= 4


def test_the_default_dedendum_yields_to_the_cutter_of_a_ring(tmp_path: Path) -> None:
    """As it does to a rack's tip: the deepest in hundredths whose cutter has no pointed teeth."""
    document, _, _ = RACKS["a steep ring"]
    free = document | {"rack": {"pressure_angle_deg": 32}}
    made: Any = job_of(free, tmp_path)
    depth = made.pair.rack.dedendum
    assert made.pair.toothings[1].cutter.fits
    assert made.pair.rack.yielded(made.design.rack)["dedendum"] == 1.25
    assert 1.0 <= depth < 1.23
    with pytest.raises(InfeasibleError, match="would have pointed teeth"):
        _ = job_of(followed(free, {"rack.dedendum": depth + 0.01}), tmp_path).findings


def test_a_cam_with_a_corner_is_made_large_enough_for_its_limit(tmp_path: Path) -> None:
    """The corner of a velocity stays undercut, and loses less lift than the limit."""
    document = cam({"type": "roller", "roller_radius_mm": 3}, {"base_radius_mm": 8}, 14,
                   angles=[115, 40, 115, 90])  # fmt: skip
    for phase in document["motion"]:
        if phase["type"] != "dwell":
            phase["law"] = "constant-velocity"
    found = sought(document, tmp_path).found
    (size,) = (one for one in found if [*one.changes] == ["cam.base_radius_mm"])
    assert size.resized
    assert "undercut" in size.remaining
    lost = job_of(followed(document, size.changes), tmp_path).findings
    assert {one.severity for one in lost if one.code == "undercut"} == {"warning"}


CONES = {"a cone": 15.0, "a thick cone": 25.0, "a cylinder": 0.0}


@pytest.mark.parametrize("name", CONES)
def test_the_diameter_named_for_a_roller_keeps_the_limit(name: str, tmp_path: Path) -> None:
    """And the next smaller one in the digits printed does not."""
    document = {
        "kind": "spatial-cam",
        "name": "cone",
        "motion": [
            {"type": "rise", "law": "cycloidal", "angle_deg": 120, "lift_mm": 60},
            {"type": "dwell", "angle_deg": 60},
            {"type": "return", "law": "cycloidal", "angle_deg": 120},
            {"type": "dwell", "angle_deg": "rest"},
        ],
        "follower": {"roller_radius_mm": 10, "cone_deg": CONES[name]},
        "cam": {"form": "cylinder", "outer_diameter_mm": 110, "length_mm": 120, "lowest_mm": 25,
                "groove_depth_mm": 8},
        "output": {"files": ["csv"]},
    }  # fmt: skip

    def steep(diameter: float) -> list[str]:
        other = followed(document, {"cam.outer_diameter_mm": diameter})
        found = job_of(other, tmp_path).findings
        return [one.message for one in found if one.code == "pressure-angle"]

    (message,) = steep(110.0)
    told = re.search(r"With cam\.outer_diameter_mm = ([\d.]+) it keeps the limit", message)
    assert told
    size = float(told[1])
    assert not steep(size)
    assert steep(size - 0.1)


@pytest.mark.parametrize("name", few(["tall", "steep"]))
def test_about_so_many_teeth_have_no_undercut(name: str, tmp_path: Path) -> None:
    """Clearances do not shrink with the teeth: the number is not exact, but near."""
    document = slow(32, 80.0) if name == "tall" else slow(44, 100.0)
    told = [one for one in job_of(document, tmp_path).findings if one.code == "undercut"]
    assert told
    for one in told:
        wheel = one.where.split(",")[0]
        about = re.search(r"With about (\d+) : \d+ teeth this wheel has none", one.message)
        assert about
        for share, there in ((0.95, True), (1.05, False)):
            count = round(share * int(about[1]))
            found = job_of(followed(document, {"pair.teeth": [count, count]}), tmp_path)
            left = [x for x in found.findings if x.code == "undercut"]
            assert any(x.where.startswith(wheel) for x in left) == there


def test_a_shorter_crank_lets_a_loop_close(tmp_path: Path) -> None:
    """Of the four bars of a machine any may be the one to change."""
    document = {
        "kind": "mechanism",
        "name": "bars",
        "drive": [{"name": "motor", "even": True, "speed_rpm": 10, "at_mm": [41, 37.5]}],
        "joint": [{"name": "D", "at_mm": [1.65, 13.22]}],
        "crank": [{"name": "crank", "on": "motor", "joint": "B", "length_mm": 45.59347760370994,
                   "angle_deg": -128.7854136529591}],
        "dyad": [{"type": "RRR", "from": "B", "to": "D", "joint": "C",
                  "members": ["coupler", "rocker"],
                  "lengths_mm": [43.47092936664686, 43.86735688413424], "branch": "left"}],
        "output": {"files": ["csv"]},
    }  # fmt: skip
    result = job_of(document, tmp_path)
    with pytest.raises(InfeasibleError, match="neither length alone does it"):
        _ = result.findings
    found = sought(document, tmp_path).found
    (crank,) = (one for one in found if [*one.changes] == ["crank[0].length_mm"])
    assert crank.moves
    # the longest side at most: l1 + l2 > distance + crank fails where a triangle is flat
    distance = abs(complex(41 - 1.65, 37.5 - 13.22))
    longest = 43.47092936664686 + 43.86735688413424 - distance
    (value,) = crank.changes.values()
    assert longest / 1.01 <= value <= longest
