"""Remedies do not depend on where a design starts, and go on where one change is not enough."""

from __future__ import annotations

import math
from pathlib import Path
from typing import Any

import pytest

import gearcam
from gearcam.base.adjustments import between, together
from gearcam.base.errors import InfeasibleError
from gearcam.console import remedy_lines
from helpers_remedies import ARM, CIRCLE, ROLLER, cam, followed, job_of, pair
from helpers_sampling import few

STEEP = [30, 60, 60, 210]
LIFT = 20.0


def values(document: dict[str, Any], key: str, folder: Path) -> list[float]:
    """What the remedies of a design say of a key."""
    found = gearcam.remedies(job_of(document, folder)).found
    told = [remedy.changes[key] for remedy in found if list(remedy.changes) == [key]]
    return [float(value) for value in told]  # type: ignore[arg-type]


def face(base: float, limit: float = 0.01) -> dict[str, Any]:
    made = cam({"type": "flat"}, {"base_radius_mm": base}, LIFT, angles=STEEP)
    for phase in made["motion"]:
        if phase["type"] != "dwell":
            phase["law"] = "cycloidal"
    return made | {"limits": {"lost_lift_mm": limit}}


def test_a_face_keeps_its_least_profile_radius_from_a_base_radius_on(tmp_path: Path) -> None:
    """``base + s + s'' >= 1``: of a cycloidal rise in closed form, wherever the search begins."""
    b = math.radians(STEEP[0])
    turns = [k / 10000 for k in range(10001)]
    least = 1.0 + max(
        -LIFT * (u - math.sin(2 * math.pi * u) / (2 * math.pi))
        - LIFT * 2 * math.pi / b**2 * math.sin(2 * math.pi * u)
        for u in turns
    )
    told = {values(face(base), "cam.base_radius_mm", tmp_path)[0] for base in (8, 300)}
    (value,) = told
    assert least <= value <= least * (1 + 1e-3)
    made = job_of(followed(face(8), {"cam.base_radius_mm": value}), tmp_path)
    assert not {one.code for one in made.findings} & {"undercut", "sharp-profile"}
    (sharp,) = (
        one for one in job_of(face(least - 0.5), tmp_path).findings if one.code == "sharp-profile"
    )
    assert sharp.value == pytest.approx(0.5, abs=1e-5)
    assert f"With cam.base_radius_mm = {value:g} it keeps the limit." in sharp.message


STARTS: dict[str, tuple[Any, str, tuple[float, ...]]] = {
    "a roller's cam": (
        lambda size: cam(ROLLER, {"prime_radius_mm": size}, 30, angles=[8, 60, 60, 232],
                         limits={"jamming_angle_deg": 90}),
        "cam.prime_radius_mm",
        (7.0, 20.0, 60.0),
    ),
    "a roller": (
        lambda size: cam(ROLLER | {"roller_radius_mm": size}, {"prime_radius_mm": 70}, 20,
                         angles=[60, 60, 60, 180]),
        "follower.roller_radius_mm",
        (69.0, 50.0),
    ),
    "an arm's cam": (
        lambda size: cam(ARM | {"roller_radius_mm": 15}, {"prime_radius_mm": size}, 15,
                         angles=[30, 60, 30, 240]),
        "cam.prime_radius_mm",
        (24.0, 36.0, 60.0),
    ),
}  # fmt: skip


@pytest.mark.slow
@pytest.mark.parametrize(
    "name",
    list(STARTS),
)
def test_the_remedy_does_not_depend_on_the_start(name: str, tmp_path: Path) -> None:
    make, key, starts = STARTS[name]
    told = [values(make(size), key, tmp_path) for size in starts]
    assert all(len(one) == 1 for one in told), told
    sizes = [value for (value,) in told]
    assert max(sizes) <= min(sizes) * 1.011


@pytest.mark.slow
def test_where_a_ratio_that_closes_is_not_enough_the_search_goes_on(tmp_path: Path) -> None:
    law = {"type": "phases", "knots_deg": [0, 120, 360], "ratios": [0.5, 2, 0.5]}
    document = pair(law, [12, 12])
    result = job_of(document, tmp_path)
    with pytest.raises(InfeasibleError, match=r"it closes with ratios\[1\] = 1\.5$"):
        _ = result.law
    found = gearcam.remedies(result).found
    assert found
    for remedy in found:
        assert remedy.changes["law.ratios[1]"] == 1.5
        assert remedy.changes["pair.teeth"] != [12, 12]
        made = job_of(followed(document, remedy.changes), tmp_path)
        assert not [one for one in made.findings if one.severity == "error"]


def test_a_list_that_is_changed_as_a_whole_stands_alone() -> None:
    more = {"pair.x": 0.2, "law.ratios": [0.6, 1.4, 0.6]}
    assert together({"law.ratios[1]": 1.5}, more) == more
    assert together({"law.shape[0]": 1}, {"pair.x": 0.2}) == {"law.shape[0]": 1, "pair.x": 0.2}


def test_what_is_listed_as_a_remedy_is_not_listed_as_tried(tmp_path: Path) -> None:
    document = pair(CIRCLE, [40, 40], rack={"addendum": 0.5})
    found = gearcam.remedies(job_of(document, tmp_path))
    lines = [*remedy_lines(found)]
    assert found.tried
    assert not any("no remedy" in line for line in lines)
    assert [line for line in lines if "still fails)" in line]


def bored(law: dict[str, Any], teeth: list[int], bore: Any, **more: Any) -> dict[str, Any]:
    return pair(law, teeth, blank={"bore_diameter_mm": bore, "timing_marks": False} | more)


def refusal(document: dict[str, Any], folder: Path) -> InfeasibleError:
    with pytest.raises(InfeasibleError) as caught:
        _ = job_of(document, folder).gears
    return caught.value


@pytest.mark.parametrize(("rim", "largest"), [(2.7, 35 - 2 * 2.7 * 2), (0.0, 35.0), (10.0, 35.0)])
def test_a_bore_that_no_wheel_can_take_is_refused_once(
    rim: float, largest: float, tmp_path: Path
) -> None:
    """A root circle is ``m*(z - 2*1.25)`` across; the smaller one counts for both.

    The bore that is named keeps the limit of the rim, in modules, if one does.
    """
    document = bored(CIRCLE, [20, 24], 60) | {"limits": {"rim_thickness": rim}}
    error = refusal(document, tmp_path)
    assert error.where == "wheels 1 and 2, blank.bore_diameter_mm"
    # chords of 0.01 mm move the radius by that
    assert (error.value, error.limit) == (60.0, pytest.approx(2 * (20 - 2.5), abs=0.02))
    for words in (
        "wheel 1 takes less than 35",
        "wheel 2 takes less than 43",
        "both take less than 35",
    ):
        assert words in error.nearest
    found = gearcam.remedies(job_of(document, tmp_path)).found
    assert [set(one.changes) for one in found] == [{"blank.bore_diameter_mm"}]
    bore = float(found[0].changes["blank.bore_diameter_mm"])  # type: ignore[arg-type]
    assert largest - 0.2 < bore < largest
    assert ("thin-rim" in found[0].remaining) == (rim > 9.0)


def test_only_the_wheel_that_cannot_take_its_bore_is_named(tmp_path: Path) -> None:
    for bores, wheel in (([60, 8], 1), ([8, 60], 2), ([36, 36], 1)):
        error = refusal(bored(CIRCLE, [20, 24], bores), tmp_path)
        assert error.where == f"wheel {wheel}, blank.bore_diameter_mm[{wheel - 1}]"
        assert "both" not in error.nearest
    error = refusal(bored(CIRCLE, [20, 24], [60, 50]), tmp_path)
    assert set(error.adjustments[0].near) == {
        "blank.bore_diameter_mm[0]",
        "blank.bore_diameter_mm[1]",
    }


def test_where_the_law_brings_the_root_to_the_axis_its_place_is_named(tmp_path: Path) -> None:
    """Radii of an ellipse about its focus: nearest at phi1 = 180 deg or 0, ratios 7/3 and 3/7."""
    error = refusal(bored({"type": "ellipse", "eccentricity": 0.4}, [40, 40], 60), tmp_path)
    assert "at phi1 = 0 deg, where the law's ratio is 0.428571" in error.nearest
    assert "at phi1 = 180 deg, where the law's ratio is 2.33333" in error.nearest
    assert "phi1" not in refusal(bored(CIRCLE, [20, 20], 60), tmp_path).nearest


def test_limits_of_bores_count_their_keyways(tmp_path: Path) -> None:
    keyway = {"keyway_width_mm": 8, "keyway_depth_mm": 3}
    document = bored(CIRCLE, [20, 20], 60, **keyway)
    assert "circle around bore and keyway" in refusal(document, tmp_path).nearest
    (remedy,) = gearcam.remedies(job_of(document, tmp_path)).found
    assert not job_of(followed(document, remedy.changes), tmp_path).gears[0].ring
    assert "keyway" not in refusal(bored(CIRCLE, [20, 20], 60), tmp_path).nearest


SPEEDS = {"type": "multispeed", "angles_deg": [100, 200], "transition_deg": 30}
TWICE = {"type": "phases", "knots_deg": [0, 80, 180, 260, 360]}
CLOSING = {
    # transitions have the mean of both ratios: 130 deg at the first, 230 deg at the second
    "speeds": (SPEEDS | {"ratios": [1.5, 0.6]}, [60, 60], ["ratios[0] = 1.707692308",
               "ratios[1] = 0.7173913043"]),
    "two lobes": (TWICE | {"ratios": [2.2, 2, 2.2, 2, 2.2]}, [160, 80],
                  ["ratios[0] = ratios[2] = ratios[4] = 2", "ratios[1] = ratios[3] = 1.8"]),
}  # fmt: skip


@pytest.mark.parametrize("name", CLOSING)
def test_ratios_that_close_a_law_are_those_of_the_file(name: str, tmp_path: Path) -> None:
    law, teeth, named = CLOSING[name]
    error = refusal(pair(law, teeth), tmp_path)
    assert error.nearest == f"it closes with {' or '.join(named)}"
    for way in error.adjustments:
        _ = job_of(followed(pair(law, teeth), dict(way.near)), tmp_path).law


@pytest.mark.slow
@pytest.mark.parametrize(
    "law",
    few([
        {"type": "phases", "knots_deg": [0, 180, 360], "ratios": [3, "solve", 3]},
        SPEEDS | {"ratios": [5, "solve"]},
    ]),
)  # fmt: skip
def test_where_no_positive_ratio_closes_smaller_ones_are_tried(law: Any, tmp_path: Path) -> None:
    document = pair(law, [60, 60])
    (remedy,) = gearcam.remedies(job_of(document, tmp_path)).found
    assert "law.ratios[0]" in remedy.changes
    made = job_of(followed(document, remedy.changes), tmp_path)
    assert not [one for one in made.findings if one.severity == "error"]


def test_a_number_that_stands_alone_in_a_list_is_short() -> None:
    ends = ({"law.ratios": [0.4, "solve"]}, {"law.ratios": [1.0, "solve"]})
    assert between(*ends, 0.123456789) == {"law.ratios": [0.4741, "solve"]}
    pairs = ({"law.ratios": [0.4, 1.6]}, {"law.ratios": [1.0, 1.0]})
    first, second = between(*pairs, 0.123456789)["law.ratios"]
    assert first + second == pytest.approx(2.0, abs=1e-9)  # as a law that closes needs them


@pytest.mark.parametrize(("rim", "named"), [(4.9, True), (5.1, False)])
def test_a_rim_that_allows_no_bore_of_use_asks_for_more_teeth(
    rim: float, named: bool, tmp_path: Path
) -> None:
    """A root circle of 35 mm leaves half of a bore of 30 mm with a rim of 5 modules of 2 mm."""
    document = pair(CIRCLE, [20, 20], blank={"bore_diameter_mm": 30})
    made = job_of(document | {"limits": {"rim_thickness": rim}}, tmp_path)
    for finding in (one for one in made.findings if one.code == "thin-rim"):
        assert ("a bore up to" in finding.message) == named
        assert ("more teeth (a smaller module)" in finding.message) != named


@pytest.mark.slow
def test_a_change_that_leaves_errors_is_not_listed_as_tried_in_vain(tmp_path: Path) -> None:
    """A smaller cutter fits the groove, whose walls lose the corners of a jump of the velocity."""
    motion = [
        {"type": "rise", "law": "constant-velocity", "angle_deg": 8, "lift_mm": 20},
        {"type": "return", "law": "cycloidal", "angle_deg": "rest"},
    ]
    groove = {"form": "groove", "prime_radius_mm": 30, "outer_diameter_mm": 150}
    groove |= {"thickness_mm": 20, "groove_depth_mm": 10}
    document = {"kind": "cam", "name": "groove", "motion": motion, "cam": groove}
    document |= {"follower": {"type": "roller", "roller_radius_mm": 6}}
    document |= {"output": {"files": ["tool-path"], "tool_radius_mm": 7}}
    document |= {"limits": {"lost_lift_mm": 0}}  # a corner of the velocity loses some
    design = gearcam.design(document)
    with pytest.raises(InfeasibleError, match="wider than the groove") as refused:
        gearcam.build(design).write(tmp_path)
    found = gearcam.remedies(gearcam.build(design), refused.value)
    ((text, codes),) = found.nearly.items()
    key, value = text.split(" = ")
    made = gearcam.build(design.with_({key: float(value)})).findings
    assert (
        {one.code for one in made if one.severity == "error"} == {*codes} == {"jamming", "undercut"}
    )
    lines = [*remedy_lines(found)]
    assert lines[0] == f"with {text} it can be made, but has errors: jamming, undercut"
    assert "tool_radius" not in lines[1]


@pytest.mark.slow
def test_a_bore_that_a_cam_cannot_take_leaves_its_wall(tmp_path: Path) -> None:
    """A concentric circle of 2*(40 - 6) mm is nearest; 3 mm of wall on both sides."""
    made = cam(ROLLER, {"prime_radius_mm": 40}, blank={"bore_diameter_mm": 90})
    made["limits"] = {"wall_mm": 3}
    (bore,) = values(made, "blank.bore_diameter_mm", tmp_path)
    assert 61.9 < bore <= 62.0
    left = job_of(followed(made, {"blank.bore_diameter_mm": bore}), tmp_path).findings
    assert "thin-wall" not in {one.code for one in left}
