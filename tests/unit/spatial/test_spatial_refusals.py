"""What is refused of cylinder cams, and that the values that refusals name can be built."""

from __future__ import annotations

from typing import Any

import pytest

import gearcam as gc
from gearcam.base.errors import DesignError, InfeasibleError
from helpers_pairs import PROFILES

DESIGN = gc.load(PROFILES / "cylinder_cam.toml").with_({"output.files": ["csv"]})
SWINGING = DESIGN.with_(
    {
        "motion": [
            {"type": "rise", "law": "modified-sine", "angle_deg": 150, "lift_deg": 30},
            {"type": "return", "law": "modified-sine", "angle_deg": "rest"},
        ],
        "follower": {"motion": "oscillating", "roller_radius_mm": 11, "arm_mm": 120},
    }
)


@pytest.mark.parametrize(
    ("design", "key", "value", "words"),
    [
        (DESIGN, "cam.length_mm", 80.0, "leaves the upper face"),
        (DESIGN, "cam.lowest_mm", 8.0, "leaves the lower face"),
        (DESIGN, "follower.roller_length_mm", 20.0, "deeper than the groove"),
        (SWINGING, "follower.pivot_distance_mm", 90.0, "does not stay on the middle"),
        (SWINGING, "follower.pivot_distance_mm", 140.0, "does not stay on the middle"),
    ],
)
def test_the_nearest_value_is_named_and_can_be_built(
    design: gc.Design, key: str, value: float, words: str
) -> None:
    with pytest.raises(InfeasibleError, match=words) as caught:
        _ = gc.build(design.with_({key: value})).cam
    assert caught.value.where.endswith(key)
    near = caught.value.adjustments[0].near
    assert near[key] != value
    _ = gc.build(design.with_(near)).cam


def test_a_rib_that_its_rollers_cut_through() -> None:
    thin = {
        "cam.walls": "rib",
        "cam.rib_mm": 0.5,
        "cam.lowest_mm": 30,
        "cam.roller_clearance_mm": 0,
    }
    with pytest.raises(InfeasibleError, match="cut through the rib") as caught:
        _ = gc.build(DESIGN.with_(thin)).cam
    near = caught.value.adjustments[0].near
    least = gc.build(DESIGN.with_({**thin, **near})).cam.least_rib
    assert least is not None
    assert least.value > 0.0


@pytest.mark.parametrize(
    ("changes", "words"),
    [
        ({"motion": [{"type": "rise", "law": "constant-velocity", "angle_deg": 180, "lift_mm": 9},
                     {"type": "return", "law": "cycloidal", "angle_deg": "rest"}]},
         "the velocity jumps"),
        ({"cam.groove_depth_mm": 81.0}, "inside the bore"),
    ],
)  # fmt: skip
def test_what_cannot_be_is_refused(changes: dict[str, Any], words: str) -> None:
    with pytest.raises(InfeasibleError, match=words):
        _ = gc.build(DESIGN.with_(changes)).cam


def test_a_bore_that_leaves_no_room_for_a_groove_is_named() -> None:
    wide = {"blank.bore_diameter_mm": 900.0}
    with pytest.raises(InfeasibleError, match="inside the bore") as caught:
        _ = gc.build(DESIGN.with_(wide)).cam
    assert (caught.value.limit or 0.0) > 0.0
    near = caught.value.adjustments[0].near
    assert [*near] == ["blank.bore_diameter_mm"]
    assert gc.build(DESIGN.with_({**wide, **near})).cam.walls


def test_an_arm_that_swings_too_far() -> None:
    wide = SWINGING.with_(
        {
            "motion": [
                {"type": "rise", "law": "cycloidal", "angle_deg": 180, "lift_deg": 80},
                {"type": "return", "law": "cycloidal", "angle_deg": "rest"},
            ],
            "follower.roller_radius_mm": 2,
            "cam.length_mm": 400,
            "cam.lowest_mm": 60,
        }
    )
    with pytest.raises(InfeasibleError, match="swings so far"):
        _ = gc.build(wide).cam


def test_a_misspelt_form_is_judged_as_what_was_meant() -> None:
    text = (PROFILES / "cylinder_cam.toml").read_text("utf-8").replace('"cylinder"', '"cylindr"')
    with pytest.raises(DesignError) as caught:
        gc.loads('name = "mine"\n' + text)
    (problem,) = caught.value.problems
    assert problem.key == "cam.form"
    assert "did you mean cylinder" in problem.hint
