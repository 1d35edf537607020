"""Messages for machines that do not close, for drives that cannot be compared, and for chains."""

from __future__ import annotations

import re
from pathlib import Path

import pytest

import gearcam as gc
from gearcam.base.errors import DesignError, InfeasibleError
from helpers_pairs import PROFILES

FOUR_BAR = gc.load(PROFILES / "four_bar.toml")
SLIDE = gc.load(PROFILES / "nail_machine_slide.toml")
PAIR = {"kind": "gear-pair", "law": {"type": "ellipse", "eccentricity": 0.3},
        "pair": {"teeth": [32, 32], "module_mm": 2}}  # fmt: skip


def refusal(changes: dict[str, object], design: gc.Design = FOUR_BAR) -> InfeasibleError:
    with pytest.raises(InfeasibleError) as caught:
        _ = gc.build(design.with_(changes)).checked
    return caught.value


def test_a_rod_too_short_is_offered_lengths_that_build() -> None:
    short = FOUR_BAR.with_({"dyad[0].lengths_mm": [120, 45]})
    # the longest distance of the pins is 110 + 40, the shortest 110 - 40
    assert refusal({"dyad[0].lengths_mm": [120, 45]}).limit == pytest.approx(120 - 70, rel=2e-3)
    found = gc.remedies(gc.build(short)).found
    lengths = {key: value for one in found for key, value in one.changes.items()}
    # 110 - crank is at least 120 - 45; the crank is found in steps of a hundredth
    least = {"dyad[0].lengths_mm[0]": 115, "dyad[0].lengths_mm[1]": 50, "crank[0].length_mm": 35}
    assert lengths.keys() == least.keys()
    for key, length in lengths.items():
        assert length == pytest.approx(least[key], rel=1e-2 if "crank" in key else 3e-3)


def test_where_one_length_cannot_do_it_two_are_named() -> None:
    told = refusal({"dyad[0].lengths_mm": [10, 20]})
    assert told.limit is None
    assert "neither length alone does it" in str(told)
    (way,) = told.adjustments
    both = gc.build(FOUR_BAR.with_(way.near))
    assert both.linkage.closed


def test_a_drive_without_the_shafts_of_the_first_is_not_compared() -> None:
    with pytest.raises(DesignError, match="does not have the shafts of motor: shaft"):
        FOUR_BAR.with_({"compare": [{"name": "other", "pair": PAIR}]})
    with pytest.raises(DesignError, match="cannot replace the first drive, which is not a pair"):
        FOUR_BAR.with_({"compare": [{"name": "other", "even": True}]})
    both = SLIDE.with_({"compare": [{"name": "other", "pair": PAIR}]})
    assert set(gc.build(both).compared) == {"other"}


def test_a_chain_on_a_shaft_that_turns_on_needs_a_range() -> None:
    hoist = {"name": "door", "on": "motor", "joint": "hook", "radius_mm": 100}
    told = refusal({"hoist": [hoist], "output.outputs": ["door"]})
    assert "not back after a turn" in str(told)
    ranged = FOUR_BAR.with_(
        {"hoist": [hoist], "output.outputs": ["door"], "drive[0].range_deg": [0, 90]}
    )
    assert gc.build(ranged).facts["outputs.door.stroke_mm"] == pytest.approx(157.07963267948966)


def test_a_pair_may_turn_over_a_part_of_its_turn() -> None:
    part = gc.build(SLIDE.with_({"drive[0].range_deg": [0, 90], "interval": []}))
    assert part.facts["machine.to_deg"] == pytest.approx(90.0)
    assert not part.linkage.closed


def test_rounding_is_no_jump_and_no_stroke() -> None:
    rods = FOUR_BAR.with_(
        {"crank[0].length_mm": 50, "dyad[0].lengths_mm": [120, 50], "joint[0].at_mm": [120, 0],
         "dyad[0].change": "motion", "output.outputs": ["rocker.angle", "coupler.angle"]}
    )  # fmt: skip
    codes = {finding.code for finding in gc.build(rods).checked}
    assert "change-point" in codes
    assert not codes & {"velocity-jump", "acceleration-jump"}


def test_a_dead_center_that_is_reached_twice_is_told() -> None:
    turning = FOUR_BAR.with_(
        {"guide": [{"name": "bed"}], "output.outputs": ["S"],
         "interval": [{"on": "S", "travel_mm": 5, "before": "outer"}],
         "dyad": [{"type": "RRT", "from": "B", "to": "bed", "joint": "S", "lengths_mm": [120, 0],
                   "members": ["rod", "ram"]}],
         "point": [], "joint": [], "drive[0].ratio": 1}
    )  # fmt: skip
    assert "second-dead-center" not in {one.code for one in gc.build(turning).checked}
    twice = turning.with_(
        {"drive": [{"name": "master", "even": True}, {"name": "motor", "even": True, "ratio": 2}]}
    )
    assert "second-dead-center" in {one.code for one in gc.build(twice).checked}


def test_rates_of_angles_have_their_units() -> None:
    result = gc.build(FOUR_BAR)
    units = {one.name: one.unit for one in result.facts.quantities()}
    assert units["outputs.rocker.velocity_rad_s"] == "rad/s"
    assert units["outputs.rocker.velocity_rad_per_rad"] == "rad/rad"
    assert units["outputs.P_x.velocity_mm_per_rad"] == "mm/rad"


def test_the_key_in_a_finding_of_a_cam_is_that_of_the_machine(tmp_path: Path) -> None:
    """In a table of the machine, as it is followed here; in a file of its own that of the file."""
    cam = PROFILES / "plate_cam_offset_roller.toml"
    machine = {
        "kind": "mechanism", "name": "mine", "drive": [{"name": "cam", "cam": None}],
        "slide": [{"name": "rod", "on": "cam.follower", "joint": "R"}],
        "output": {"files": ["csv"]},
    }  # fmt: skip
    given = {**machine, "drive": [{"name": "cam", "cam": gc.load(cam).to_dict()}]}
    design = gc.design(given)
    (finding,) = gc.build(design).findings
    change = re.search(r"has (drive\[0\]\.cam\.cam\.prime_radius_mm) = ([\d.]+)\.", finding.message)
    assert finding.code == "pressure-angle"
    assert change is not None
    assert gc.build(design.with_({change[1]: float(change[2])})).findings == ()
    file = tmp_path / "mine.toml"
    file.write_text(
        f"""kind = "mechanism"
        [[drive]]
        name = "cam"
        cam = "{cam}"
        [[slide]]
        name = "rod"
        on = "cam.follower"
        joint = "R"
        """
    )
    (finding,) = gc.build(gc.load(file)).findings
    assert "limit has cam.prime_radius_mm = " in finding.message
