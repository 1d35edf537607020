"""Where a follower jams, and the radius that a finding about a pressure angle names."""

from __future__ import annotations

import math
import re
from pathlib import Path
from typing import Any

import numpy as np
import pytest

import gearcam
from gearcam.base.findings import Finding, run_checks
from gearcam.cams.cam import Cam
from gearcam.cams.disc import make_cam
from gearcam.cams.followers import Arm, Stem
from gearcam.cams.groove import make_groove
from gearcam.cams.spec import KIND
from helpers_cams import follower_of, there_and_back
from helpers_remedies import ARM, FACE, ROLLER, cam, followed, job_of, plate
from helpers_sampling import few

GROOVE = {"form": "groove", "outer_diameter_mm": 130, "groove_depth_mm": 5}
TWO = {"form": "conjugate", "prime_radius2_mm": 30}
STEEP = [40, 100, 50, 170]
SUDDEN = [0.05, 100, 50, 209.95]

CASES: dict[str, Any] = {
    "roller": cam(ROLLER, {"prime_radius_mm": 20}, 15, angles=STEEP),
    "given by its base": cam(ROLLER, {"base_radius_mm": 14}, 15, angles=STEEP),
    "beside the axis": cam(ROLLER | {"offset_mm": 8}, {"prime_radius_mm": 25}, angles=STEEP),
    "knife edge": cam({"type": "knife-edge"}, {"prime_radius_mm": 20}, 15, angles=STEEP),
    "arm": cam(ARM, {"prime_radius_mm": 30}, 15, angles=STEEP),
    "groove": cam(ROLLER, {"prime_radius_mm": 40} | GROOVE, 12, angles=STEEP),
    "conjugate": cam(ROLLER, {"prime_radius_mm": 25} | TWO, angles=STEEP),
    "conjugate by a distance": cam(
        ROLLER | {"roller_distance_mm": 70},
        {"prime_radius_mm": 25, "form": "conjugate"},
        angles=STEEP,
    ),
    "conjugate by an angle": cam(
        ARM | {"arms_angle_deg": 50},
        {"prime_radius_mm": 35, "form": "conjugate"},
        15,
        angles=STEEP,
    ),
    "yoke": cam(ROLLER, {"form": "yoke", "prime_radius_mm": 20}, angles=[60, 120, 60, 120]),
}


def changes_of(message: str) -> dict[str, Any]:
    """The changes that a finding names."""
    found = re.findall(r"((?:cam|follower)\.\w+) = ([\d.]+\d)", message)
    assert found, message
    return {key: float(value) for key, value in found}


def steep(document: Any, folder: Path, motion: str = "") -> list[Any]:
    """The findings about the pressure angles of a design, of one motion."""
    codes = ("pressure-angle", "jamming")
    found = [one for one in job_of(document, folder).findings if one.code in codes]
    return [one for one in found if one.where.startswith(motion)]


@pytest.mark.parametrize("name", few(CASES, 4))
def test_the_radius_that_is_named_is_the_smallest_that_keeps_the_limit(
    name: str, tmp_path: Path
) -> None:
    document = CASES[name]
    found = steep(document, tmp_path)
    assert found
    for finding in found:
        motion = finding.where.split(", ")[0] if name.startswith("conjugate") else ""
        changes = changes_of(finding.message)
        left = steep(followed(document, changes), tmp_path, motion)
        assert [one for one in left if one.code == finding.code] == []
        key = next(iter(changes))
        # one less in the last of four digits; keys that follow from the radius have other digits
        last = 10.0 ** (math.floor(math.log10(changes[key])) - 3)
        less = {**changes, key: changes[key] - last * (1.0 if "prime_radius" in key else 4.0)}
        left = steep(followed(document, less), tmp_path, motion)
        assert [one for one in left if one.code == finding.code] != []


def test_the_least_prime_radius_of_a_ramp_is_that_of_its_formula(tmp_path: Path) -> None:
    """``tan(alpha) = s'/prime`` is largest where a knife edge begins a ramp."""
    document = cam({"type": "knife-edge"}, {"prime_radius_mm": 10}, 12, angles=[60, 60, 120, 120])
    for phase in document["motion"]:
        if phase["type"] != "dwell":
            phase["law"] = "constant-velocity"
    least = 12 / math.radians(60) / math.tan(math.radians(30))
    (finding, *_) = steep(document, tmp_path)
    (value,) = changes_of(finding.message).values()
    assert least <= value <= least * (1 + 1e-3)


def test_the_radius_does_not_depend_on_the_one_that_is_given(tmp_path: Path) -> None:
    told = set()
    for given in (7.0, 40.0):
        document = cam(ROLLER, {"prime_radius_mm": given}, 20, angles=STEEP)
        told |= {changes_of(one.message)["cam.prime_radius_mm"] for one in steep(document, tmp_path)
                 if one.code == "pressure-angle"}  # fmt: skip
    assert len(told) == 1


def test_a_plate_jams_on_its_way_back_too(tmp_path: Path) -> None:
    """What is a return as it slides forth lifts the follower as it slides back."""
    document: Any = plate() | {"blank": {"height_mm": 60}}
    document["cam"]["walls"] = "lower"
    document["motion"][2]["travel_mm"] = 12
    found = [one for one in steep(document, tmp_path) if one.code == "jamming"]
    assert [one.where.split(",")[0] for one in found] == ["return"]


TOO_HIGH: dict[str, Any] = {
    "few radii keep it": ({"arm_mm": 32, "pivot_distance_mm": 66}, 92, 27, 21.314, 50.82),
    "the least is the roller": (
        {"arm_mm": 60, "pivot_distance_mm": 60, "roller_radius_mm": 15}, 108, 10, 60, 15.0),
}  # fmt: skip
"""Arm, prime radius, lift in degrees and limit; the least radius, by a scan of the formula."""


@pytest.mark.parametrize("name", TOO_HIGH)
def test_the_radii_of_an_arm_lie_between_two(name: str, tmp_path: Path) -> None:
    arm, size, lift, limit, least = TOO_HIGH[name]
    document = cam(ARM | arm, {"prime_radius_mm": size}, lift, angles=[90, 60, 90, 120])
    document |= {"limits": {"pressure_angle_deg": limit}}
    (finding, *_) = steep(document, tmp_path)
    changes = changes_of(finding.message)
    assert changes["cam.prime_radius_mm"] == pytest.approx(least, rel=2e-3)
    assert steep(followed(document, changes), tmp_path) == []


def test_a_groove_keeps_its_rim(tmp_path: Path) -> None:
    (finding, *_) = steep(CASES["groove"], tmp_path)
    changes = changes_of(finding.message)
    more = changes["cam.outer_diameter_mm"] - 130
    assert more == pytest.approx(2 * (changes["cam.prime_radius_mm"] - 40), abs=1e-6)


@pytest.mark.parametrize(
    ("document", "words"),
    [
        pytest.param(
            cam(ROLLER, {"prime_radius_mm": 20}, angles=SUDDEN), "No prime radius up",
            marks=pytest.mark.slow,
        ),
        (cam(ROLLER | {"offset_mm": 5}, {"prime_radius_mm": 20}, angles=SUDDEN),
         "or a smaller offset."),
        (cam(ARM, {"prime_radius_mm": 30}, 80, angles=STEEP), "or another arm or pivot distance."),
        (cam(FACE | {"face_offset_mm": 40}, {"base_radius_mm": 20}, 8), "A smaller face offset"),
        (plate(), "A smaller lift or a longer travel"),
    ],
)  # fmt: skip
def test_where_no_radius_helps_something_else_is_named(
    document: Any, words: str, tmp_path: Path
) -> None:
    document = document | {"limits": {"pressure_angle_deg": 20}}
    (finding, *_) = steep(document, tmp_path)
    assert words in finding.message


def test_only_steep_cams_are_searched(tmp_path: Path, monkeypatch: pytest.MonkeyPatch) -> None:
    monkeypatch.setattr("gearcam.kinds.cam.hints.hinted", None)
    document = cam(ROLLER, {"prime_radius_mm": 60})
    assert gearcam.build(job_of(document, tmp_path).design).findings == ()
    assert np.degrees(job_of(document, tmp_path).cam.motions[0].pressure("rise").largest) < 30


def found_by(made: Cam, code: str, **limits: float) -> list[Finding]:
    return [one for one in run_checks(KIND, made, limits) if one.code == code]


GUIDES = [(0.15, 1.0, 0.0, 65.8), (0.15, 0.5, 0.15, 64.8)]
"""Friction in the guide, its overhang over its length, friction at the cam; and where it jams."""


@pytest.mark.parametrize(("friction", "overhang", "contact", "degrees"), GUIDES)
def test_a_stem_jams_where_no_force_along_it_is_left(
    friction: float, overhang: float, contact: float, degrees: float
) -> None:
    """Statics: a unit force at the tip, two normal forces at the ends of the guide, friction."""
    jams = []
    for angle in np.radians(np.arange(60.0, 70.0, 0.1)):
        pushed = angle + math.atan(contact)
        # moments about the lower and the upper end of a guide of length 1
        upper = overhang * math.sin(pushed)
        lower = (1.0 + overhang) * math.sin(pushed)
        if math.cos(pushed) <= friction * (upper + lower):
            jams.append(math.degrees(angle))
    assert min(jams) == pytest.approx(degrees, abs=0.15)
    assert math.degrees(Stem.jamming_limit) == pytest.approx(degrees, abs=1.0)


def test_an_arm_jams_where_no_moment_is_left() -> None:
    """A unit force at the end of an arm of length 1, on a pin of a tenth of it."""
    friction, pin = math.atan(0.15), 0.1
    angles = np.radians(np.arange(70.0, 90.0, 0.1))
    left = np.cos(angles + friction) - pin * math.sin(friction)
    first = math.degrees(angles[left <= 0.0][0])
    assert first == pytest.approx(80.6, abs=0.15)
    assert math.degrees(Arm.jamming_limit) == pytest.approx(first, abs=1.0)


def test_a_follower_that_a_spring_returns_cannot_jam_there() -> None:
    """What the wall pushes counts: rises, and returns of a follower that two walls hold."""
    lift = there_and_back("cycloidal", 20.0, (170.0, 10.0, 20.0, 160.0))
    steep = make_cam(lift, follower_of("roller", prime_radius=30.0))
    (found,) = found_by(steep, "pressure-angle", pressure_angle=math.radians(65.0))
    assert found.where.startswith("return, ")
    assert found_by(steep, "jamming") == []
    held = make_groove(lift, follower_of("roller", prime_radius=30.0))
    (jammed,) = found_by(held, "jamming")
    assert (jammed.where, jammed.value) == (found.where, pytest.approx(found.value))
