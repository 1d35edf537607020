"""Peaks between jumps are given; jumps too small to matter are named so and change no limit."""

from __future__ import annotations

import csv
import math
import re
from pathlib import Path
from typing import Any

import mpmath
import numpy as np
import pytest

import gearcam as gc

HANDBOOK = (
    (2, -0.17200829622), (6, 0.00382242425), (10, 0.00019658819), (14, 0.00003342253),
    (18, 0.00000919555), (22, 0.00000331329), (26, 0.00000142002), (30, 0.00000068967),
)  # fmt: skip
"""Rothbart, Cam Design Handbook, (13.77): half-waves and coefficients, printed to six digits."""

PRINTED = "x" + "".join(f"{a:+.11f}*sin({k}*pi*x)" for k, a in HANDBOOK)

LIFT, ANGLE = 10.0, math.radians(60.0)


def cam(formula: str, **changes: Any) -> Any:
    """A rise by a formula and a return without jumps, on a roller of 5 mm at 60 mm."""
    dwell = {"type": "dwell", "angle_deg": 120}
    motion = [
        {"type": "rise", "law": "formula", "formula": formula, "angle_deg": 60, "lift_mm": LIFT},
        dwell,
        {"type": "return", "law": "cycloidal", "angle_deg": 60},
        dwell,
    ]
    document = {
        "kind": "cam",
        "name": "jumps",
        "motion": motion,
        "follower": {"type": "roller", "roller_radius_mm": 5},
        "cam": {"prime_radius_mm": 60, "thickness_mm": 5},
    }
    return gc.build(gc.design(document | changes))


def found(result: Any, code: str) -> list[Any]:
    return [one for one in result.findings if one.code == code]


def test_coefficients_that_were_printed_in_six_digits() -> None:
    """The corner of a shock v on a roller r at the radius R turns by ``v/(R - r)``.

    The roller loses ``r*v^2/(8*R*(R - r))`` on it, both for small v.
    """
    result = cam(PRINTED)
    with mpmath.workdps(30):
        slope = 1 + sum(k * mpmath.pi * mpmath.mpf(str(a)) for k, a in HANDBOOK)
        shock = float(slope * LIFT / (mpmath.pi / 3))
        peak = max(
            abs(sum(a * (k * mpmath.pi) ** 2 * mpmath.sin(k * mpmath.pi * x) for k, a in HANDBOOK))
            for x in (mpmath.mpf(n) / 4000 for n in range(1000))
        ) * (LIFT / ANGLE**2)
    first, last = found(result, "velocity-jump")
    assert (first.severity, last.severity) == ("note", "note")
    assert first.value == pytest.approx(shock, rel=1e-6)
    assert last.value == pytest.approx(-shock, rel=1e-6)
    assert "too small to matter" in first.message
    numbers = r"([0-9.e-]+) % of its largest.* by ([0-9.e-]+) deg, by which ([0-9.e-]+) mm"
    ((share, bend, lost),) = re.findall(numbers, first.message)
    assert float(bend) == pytest.approx(math.degrees(-shock / 55.0), rel=5e-3)
    assert float(lost) == pytest.approx(5.0 * shock**2 / (8.0 * 60.0 * 55.0), rel=5e-3)
    largest = result.facts["motion.peak_velocity"]
    assert float(share) == pytest.approx(-100.0 * shock / largest, rel=1e-2)

    assert not found(result, "undercut")
    assert result.facts["cam.undercut"] == []
    assert "cam.lost_lift_mm" not in result.facts
    rho = result.motion(np.radians(np.arange(0.005, 360.0, 0.01)))["rho_profile_mm"]
    convex, concave = (float(one.min()) for one in (rho[rho > 0.0], -rho[rho < 0.0]))
    assert result.facts["cam.curvature.profile_convex_min_mm"] == pytest.approx(convex, rel=1e-4)
    assert result.facts["cam.curvature.profile_concave_min_mm"] == pytest.approx(concave, rel=1e-4)
    record = result.record()
    assert record["motion.peak_acceleration"] == pytest.approx(float(peak), rel=1e-5)
    assert record["motion.peak_jerk"] > 0.0


@pytest.mark.parametrize(("slope", "slight"), [(0.00199, True), (0.00201, False)])
def test_a_thousandth_of_the_largest_velocity_matters(slope: float, slight: bool) -> None:
    """``S' = 1 - a*cos(2*pi*x)`` is 1 - a at the ends and at most 1 + a."""
    a = 1.0 - slope
    result = cam(f"x - {a!r}*sin(2*pi*x)/(2*pi)", drive={"speed_rpm": 60})
    assert slight == (slope / (2.0 - slope) <= 1e-3)
    severities = {one.severity for one in found(result, "velocity-jump")}
    assert severities == ({"note"} if slight else {"warning"})
    convex = result.facts["cam.curvature.profile_convex_min_mm"]
    assert (convex > 0.0) == slight
    # the velocity rises at the start: at the end it falls at once
    assert bool(found(result, "undercut")) != slight
    peak = 2.0 * math.pi * a * LIFT / ANGLE**2
    other = 2.0 * math.pi * LIFT / ANGLE**2  # of the return
    key = "motion.peak_acceleration" + ("" if slight else "_between_jumps")
    record = result.record()
    assert record[key] == pytest.approx(max(peak, other), rel=1e-9)
    assert record[f"{key}_mm_s2"] == pytest.approx(record[key] * (2.0 * math.pi) ** 2, rel=1e-12)
    assert ("motion.peak_acceleration" in record) == slight
    assert "jump" in result.facts.quantity(key).meaning


def test_a_real_jump_of_the_acceleration_is_told_beside_a_slight_one_of_the_velocity() -> None:
    """``S = (1 - e)*(1 - cos(pi*x))/2 + e*x``: the acceleration starts with its largest value."""
    e = 1e-4
    result = cam(f"{1 - e}*(1 - cos(pi*x))/2 + {e}*x")
    assert [one.severity for one in found(result, "velocity-jump")] == ["note", "note"]
    jumps = found(result, "acceleration-jump")
    assert jumps[0].value == pytest.approx((1 - e) * math.pi**2 / 2 * LIFT / ANGLE**2, rel=1e-9)
    assert all("vibrates" in one.message for one in jumps)
    record = result.record()
    assert record["motion.peak_jerk_between_jumps"] > 0.0
    assert "motion.peak_jerk" not in record
    assert "motion.peak_acceleration" in record


@pytest.mark.parametrize(("c", "slight"), [(0.003, True), (0.0033, False)])
def test_jumps_of_the_acceleration_have_the_same_limit(c: float, slight: bool) -> None:
    """``S'' = 2*c`` at the ends, of a largest value of about ``2*pi``."""
    result = cam(f"x - sin(2*pi*x)/(2*pi) + {c}*x**2*(1 - x)**2")
    jumps = found(result, "acceleration-jump")
    assert jumps[0].value == pytest.approx(2.0 * c * LIFT / ANGLE**2, rel=1e-6)
    assert {one.severity for one in jumps} == {"note"}
    assert all(("too small to matter" in one.message) == slight for one in jumps)
    assert ("motion.peak_jerk" in result.record()) == slight
    assert not found(result, "velocity-jump")


@pytest.mark.parametrize(
    "changes",
    [
        {"follower": {"type": "flat"}, "cam": {"base_radius_mm": 90, "thickness_mm": 5}},
        {"follower": {"type": "knife-edge"}},
    ],
    ids=["face", "point"],
)
def test_a_slight_jump_below_other_followers(changes: dict[str, Any]) -> None:
    result = cam(PRINTED, **changes)
    assert not found(result, "undercut")
    assert result.facts["cam.curvature.profile_convex_min_mm"] > 20.0
    assert {one.severity for one in found(result, "velocity-jump")} == {"note"}
    least = result.cam.least_base_radius  # it would be unknown with a corner
    assert (least is not None) == (changes["follower"]["type"] == "flat")
    assert " 0 deg" not in "".join(one.message for one in result.findings)


def test_a_plate_has_its_peaks_and_its_slight_jumps() -> None:
    law = {"law": "formula", "formula": PRINTED, "travel_mm": 60}
    motion = [
        {"type": "rise", "lift_mm": 15, **law},
        {"type": "dwell", "travel_mm": 30},
        {"type": "return", "law": "cycloidal", "travel_mm": 40},
    ]
    design = gc.load("profiles/translating_cam.toml").with_({"motion": motion})
    result = gc.build(design)
    assert {one.severity for one in found(result, "velocity-jump")} == {"note"}
    assert not found(result, "undercut")
    assert {"motion.peak_acceleration", "motion.peak_jerk"} <= set(result.record())
    motion[0] = {"type": "rise", "lift_mm": 15, "law": "constant-velocity", "travel_mm": 60}
    hard = gc.build(design.with_({"motion": motion}))
    assert hard.record()["motion.peak_acceleration_between_jumps"] == pytest.approx(
        2.0 * math.pi * 15.0 / 40.0**2, rel=1e-9
    )


def test_studies_have_their_numbers_at_a_slight_jump(tmp_path: Path) -> None:
    result = cam(PRINTED, load=[{"force_n": 100}], limits={"contact_pressure_mpa": 600})
    forces = result.study("forces")
    assert np.isfinite(np.ma.filled(forces.columns["pressure_mpa"], np.nan)).all()
    assert not forces.study_findings
    assert forces.facts["forces.pressure_mpa"] < 600.0
    result.study("precision").write(tmp_path)
    (path,) = tmp_path.rglob("precision.csv")
    with path.open() as file:
        assert all(cell for row in csv.reader(file) for cell in row)


@pytest.mark.slow
def test_sizes_are_solved_with_a_slight_jump() -> None:
    """The least radius of a face is that of the limit, whatever the corner of the jump."""
    asked = {"base_radius_mm": "solve", "thickness_mm": 5}
    result = cam(PRINTED, follower={"type": "flat"}, cam=asked)
    radius = result.facts["cam.curvature.profile_convex_min_mm"]
    assert radius == pytest.approx(1.0, abs=1e-5)


def test_a_jump_of_the_acceleration_leaves_the_jerk_between_jumps() -> None:
    """Simple harmonic motion: ``S''' = pi^3/2*sin(pi*x)``."""
    motion = [
        {"type": "rise", "law": "harmonic", "angle_deg": 60, "lift_mm": LIFT},
        {"type": "dwell", "angle_deg": 120},
        {"type": "return", "law": "3-4-5", "angle_deg": 120},
        {"type": "dwell", "angle_deg": "rest"},
    ]
    record = cam("x", motion=motion).record()
    expected = math.pi**3 / 2.0 * LIFT / ANGLE**3
    assert record["motion.peak_jerk_between_jumps"] == pytest.approx(expected, rel=1e-9)
    assert "motion.peak_jerk" not in record
