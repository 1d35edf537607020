"""The contact pressure is unbounded where the follower rides on an edge, and a finding says so."""

from __future__ import annotations

import json
import math
import re
from pathlib import Path
from typing import Any

import numpy as np
import pytest

import gearcam as gc
from gearcam.base.errors import InfeasibleError
from gearcam.mechanics.hertz import half_width, line_pressure
from gearcam.numeric.arrays import Mask
from helpers_sampling import chosen, few

LOAD = {"load": [{"force_n": 100}]}


def shock(unit: str = "lift_mm", lift: float = 10.0, way: str = "angle_deg", at: Any = 160) -> Any:
    """A motion whose velocity falls at once at the top, where trimming leaves a corner."""
    law = {"law": "constant-velocity"}
    rest = "rest" if way == "angle_deg" else at
    return [{"type": "rise", way: at, unit: lift, **law}, {"type": "return", way: rest, **law}]


FORMS: dict[str, tuple[str, dict[str, Any]]] = {
    "roller": ("plate_cam_offset_roller", {"motion": shock(), **LOAD}),
    "face": ("flat_follower", {"motion": shock(lift=3.0), **LOAD}),
    "dome": (
        "flat_follower",
        {"motion": shock(lift=3.0), "follower": {"type": "domed", "dome_radius_mm": 5}, **LOAD},
    ),
    "groove": ("groove_cam", {"motion": shock(), **LOAD}),
    "conjugate": ("conjugate_cams", {"motion": shock("lift_deg"), "load": [{"torque_nm": 5}]}),
    "yoke": ("yoke_cam", {"cam.base_radius_mm": 8, "blank": {}, **LOAD}),
    "plate": ("translating_cam", {"motion": shock(lift=8.0, way="travel_mm", at=60), **LOAD}),
}


def study(name: str, **more: Any) -> Any:
    profile, changes = FORMS[name]
    return gc.build(gc.load(f"profiles/{profile}.toml").with_(changes | more)).study("forces")


def pressed(found: Any) -> tuple[Mask, Mask]:
    """Which rows press, and which of them on an edge, by what trimming leaves of each wall."""
    cam, driver = found.result.cam, found.result.driver
    x = found.columns[driver.column] / driver.scale
    on_edge = np.zeros(len(x), dtype=bool)
    for number, touch in enumerate(cam.touches, start=1):
        at = (x + touch.across) % touch.wall.program.period if touch.across else x
        on_edge |= (found.columns["wall"] == number) & ~touch.wall.touched(at)
    return found.columns["normal_n"] > 1e-9, on_edge


@pytest.mark.parametrize("limit", few([None, 600.0]))
@pytest.mark.parametrize("name", chosen(list(FORMS), "roller", "groove", "plate"))
def test_no_number_is_given_on_an_edge(name: str, limit: float | None, tmp_path: Path) -> None:
    found = study(name, **({"limits.contact_pressure_mpa": limit} if limit else {}))
    carries, on_edge = pressed(found)
    assert (carries & on_edge).any()
    for column in ("pressure_mpa", "half_width_mm"):
        values = found.columns[column]
        assert np.isnan(values[carries & on_edge]).all()
        # but at the sides of a corner, which may be either
        given = np.isfinite(values[carries & ~on_edge])
        assert np.count_nonzero(~given) <= 4
    facts = found.facts["forces"]
    assert "pressure_mpa" not in facts
    most = np.nanmax(np.ma.filled(found.columns["pressure_mpa"], np.nan))
    assert facts["pressure_off_edges_mpa"] == pytest.approx(most, rel=1e-12)
    one = next(one for one in found.study_findings if one.code == "contact-pressure")
    assert one.severity == ("warning" if limit else "note")
    assert "unbounded" in one.message
    assert ("beyond the limit of 600 MPa" in one.message) == bool(limit)
    found.write(tmp_path)
    (path,) = tmp_path.rglob("summary.json")
    json.loads(path.read_text(), parse_constant=pytest.fail)
    for chart in found.charts.values():
        assert not any(np.isinf(line.y).any() for line in chart.lines)
    for curve in found.result.scene(90).coloured:
        assert not any(np.isinf(values).any() for values in curve.values.values())


def test_off_its_edges_the_pressure_of_a_face_is_the_closed_form() -> None:
    """``p = sqrt(F*E/(w*pi*rho))`` with the radius ``rho = base + s + s''`` of the profile."""
    found = study("face", material={"name": ["steel"]})
    design, columns = found.result.design, found.columns
    base, width = design.cam.base_radius, design.cam.thickness
    modulus = 206000.0 / (2 * (1 - 0.3**2))
    radius = base + found.result.program.derivatives(np.radians(columns["theta_deg"]), 0)[0]
    expected = np.sqrt(100.0 / width * modulus / (math.pi * radius))
    given = np.isfinite(columns["pressure_mpa"])
    assert columns["pressure_mpa"][given] == pytest.approx(expected[given], rel=1e-9)
    assert found.facts["forces.pressure_off_edges_mpa"] == pytest.approx(expected[0], rel=1e-9)


STEEL = 206000.0 / (2 * (1 - 0.3**2))
"""``1/E = (1 - nu1^2)/E1 + (1 - nu2^2)/E2`` of steel on steel, MPa."""


def below_a_face(base: float, back: float, up: float = 100, **more: Any) -> Any:
    """A face pressed by a spring, 100 N and 5 N/mm, on a cam 10 mm wide."""
    changes = {
        "motion": [
            {"type": "rise", "angle_deg": up, "lift_mm": 10, "law": "cycloidal"},
            {"type": "return", "angle_deg": back, "law": "3-4-5"},
            {"type": "dwell", "angle_deg": "rest"},
        ],
        "cam": {"base_radius_mm": base, "thickness_mm": 10},
        "blank": {},
        "spring": [{"stiffness_n_mm": 5, "preload_n": 100}],
        "material": {"name": ["steel"]},
        "limits": {"profile_radius_mm": 1e-4, "contact_pressure_mpa": 9e4},
    }
    return gc.build(gc.load("profiles/flat_follower.toml").with_(changes | more))


def under_a_face(result: Any, theta: Any, base: float) -> Any:
    """Hertz of the spring on a profile of the radius ``base + s + s''``, MPa."""
    s, _, d2s = result.program.derivatives(np.asarray(theta), 2)
    return np.sqrt((100.0 + 5.0 * s) / 10.0 * STEEL / (math.pi * (base + s + d2s)))


@pytest.mark.parametrize(("base", "back"), [(11.39, 101.3), (10.5, 80.0)])
def test_the_pressure_is_largest_at_the_end_of_a_corner(base: float, back: float) -> None:
    result = below_a_face(base, back)
    found, ends = result.study("forces"), [(c.before, c.after) for c in result.cam.edges]
    # off the corners, at their ends too
    theta = np.linspace(0.0, 2.0 * math.pi, 20001)
    off = ~np.any([(low <= theta) & (theta <= high) for low, high in ends], axis=0)
    expected = under_a_face(result, np.concatenate([theta[off], np.ravel(ends)]), base).max()
    assert found.facts["forces.pressure_off_edges_mpa"] == pytest.approx(expected, rel=1e-9)
    one = next(one for one in found.study_findings if one.code == "contact-pressure")
    low, high = (math.degrees(angle) for angle in ends[0])
    assert one.where.startswith(f"theta = {low:.5g} to {high:.5g} deg")


@pytest.mark.parametrize(("base", "back", "up"), [(11.66, 101.3, 100), (8.6169, 103.0, 140)])
def test_a_sharp_peak_of_the_pressure_is_found(base: float, back: float, up: float) -> None:
    """The radius of the profile is least, a few hundredths of a mm, between two steps."""
    result = below_a_face(base, back, up)
    assert not result.cam.edges
    theta = np.linspace(0.0, 2.0 * math.pi, 400_001)
    values = under_a_face(result, theta, base)
    pressure = result.study("forces").facts["forces.pressure_mpa"]
    assert pressure == pytest.approx(values.max(), rel=1e-6)
    # the steps alone do not have it
    even = under_a_face(result, np.radians(np.arange(0.0, 360.0, 0.5)), base)
    assert even.max() < 0.999 * values.max()


@pytest.mark.slow
def test_a_solved_size_keeps_the_limit_at_a_sharp_peak() -> None:
    solve = {"base_radius_mm": "solve", "thickness_mm": 10}
    limits = {"profile_radius_mm": 1e-4, "contact_pressure_mpa": 5000}
    result = below_a_face(0.0, 103.0, 140, cam=solve, limits=limits)
    base = result.solution.sizes["cam.base_radius_mm"]
    theta = np.linspace(0.0, 2.0 * math.pi, 400_001)
    assert 0.99 * 5000 < under_a_face(result, theta, base).max() <= 5000 * (1.0 + 1e-6)


@pytest.mark.parametrize(("second", "share"), [({"roller2_radius_mm": 5}, 0.5), ({}, 1.0)])
def test_each_of_two_rollers_has_half_the_depth_of_the_groove(
    second: dict[str, float], share: float
) -> None:
    follower = {"type": "roller", "roller_radius_mm": 6, "offset_mm": 4} | second
    load = {"force_n": 200, "against": True}
    changes = {"follower": follower, "load": [load], "material": {"name": ["steel"]}}
    result = gc.build(gc.load("profiles/groove_cam.toml").with_(changes))
    columns, cam = result.study("forces").columns, result.cam
    theta, outer = np.radians(columns["theta_deg"]), columns["wall"] == 2
    assert 0.1 < outer.mean() < 0.9
    radius = np.where(outer, follower.get("roller2_radius_mm", 6.0), 6.0)
    wall = np.where(outer, *(one.radii(theta) for one in cam.walls[::-1]))
    width, bent = share * result.design.cam.groove_depth, 1.0 / wall + 1.0 / radius
    load_per_width = columns["normal_n"] / width
    pressure = np.sqrt(load_per_width * STEEL * bent / math.pi)
    half = np.sqrt(4.0 * load_per_width / (math.pi * bent * STEEL))
    given = np.isfinite(np.ma.filled(columns["pressure_mpa"], np.nan))
    assert given.mean() > 0.5
    assert columns["pressure_mpa"][given] == pytest.approx(pressure[given], rel=1e-9)
    assert columns["half_width_mm"][given] == pytest.approx(half[given], rel=1e-9)
    # the step of the groove is as deep
    recesses = result.part.recesses
    assert recesses[0].high - recesses[0].low == pytest.approx(width, rel=1e-12)


def test_a_wall_of_a_plate_is_on_its_edge_only_while_it_carries() -> None:
    """From where the load changes its sign to where the roller leaves the corner."""
    phases = [
        {"type": "rise", "travel_mm": 20, "law": "3-4-5", "lift_mm": 15},
        {"type": "dwell", "travel_mm": 10},
        {"type": "return", "travel_mm": 15, "law": "cycloidal", "lift_mm": 8},
    ]
    changes = {
        "motion": phases,
        "follower": {"type": "roller", "roller_radius_mm": 12},
        "cam": {
            "form": "translating", "walls": "both", "roller_clearance_mm": 0.05, "run_in_mm": 20,
            "run_out_mm": 20, "thickness_mm": 12, "groove_depth_mm": 5,
        },
        "blank": {"height_mm": 100},
        "drive": {"speed_mm_s": 500},
        "mass": [{"mass_kg": 1.5}],
        "load": [{"force_n": 20}],
    }  # fmt: skip
    result = gc.build(gc.load("profiles/translating_cam.toml").with_(changes))
    found = result.study("forces")
    u = np.linspace(38.0, 41.0, 300001)
    load = 20.0 + 1.5e-3 * 500.0**2 * result.program.derivatives(u, 2)[2]
    change = float(u[np.flatnonzero(np.diff(np.sign(load)))[0]])
    upper = result.cam.walls[0].edges
    leaves = next(one.after for one in upper if one.before < change < one.after)
    (one,) = (one for one in found.study_findings if one.code == "contact-pressure")
    low, high = re.findall(r"u = ([\d.]+) to ([\d.]+) mm on the way forward", one.where)[0]
    ends = sorted((change, leaves))
    assert [float(low), float(high)] == pytest.approx(ends, abs=6e-4)
    assert found.facts["forces.normal_n.min"] == pytest.approx(0.0, abs=1e-8)


def test_a_corner_between_two_steps_is_seen() -> None:
    """A face loses 2e-9 mm: it rides on the corner for less than the steps of the study."""
    rise = {"angle_deg": 65, "law": "4-5-6-7"}
    motion = [{"type": "rise", "lift_mm": 10, **rise}, {"type": "return", **rise}]
    motion.append({"type": "dwell", "angle_deg": "rest"})
    changes = {"motion": motion, "forces.steps": 36, "blank": {}, **LOAD}

    def made(base: float) -> Any:
        return gc.build(
            gc.load("profiles/flat_follower.toml").with_({"cam.base_radius_mm": base, **changes})
        )

    least = made(60.0).cam.least_base_radius
    found = made(least - 0.01).study("forces")
    corner = found.result.cam.corners[0]
    assert corner.after - corner.before < math.radians(5.0)
    assert [one.code for one in found.study_findings] == ["contact-pressure"]
    assert "pressure_mpa" in made(least + 0.01).study("forces").facts["forces"]


@pytest.mark.parametrize("limit", [None, 600.0])
def test_a_pointed_follower_presses_without_bound(limit: float | None) -> None:
    point = {"follower": {"type": "knife-edge"}, "cam": {"prime_radius_mm": 40, "thickness_mm": 5}}
    design = gc.load("profiles/eccentric_cam.toml").with_(point | LOAD)
    design = design.with_({"limits.contact_pressure_mpa": limit}) if limit else design
    found = gc.build(design).study("forces")
    (one,) = found.study_findings
    assert (one.code, one.severity) == ("contact-pressure", "warning" if limit else "note")
    assert "the follower is pointed" in one.message
    assert not [name for name in found.facts["forces"] if "pressure" in name]
    assert np.isnan(np.ma.filled(found.columns["pressure_mpa"], np.nan)).all()


def test_no_size_of_a_cam_under_a_point_keeps_a_contact_pressure() -> None:
    asked = {"prime_radius_mm": "solve", "thickness_mm": 5}
    design = gc.load("profiles/eccentric_cam.toml").with_(
        {"follower": {"type": "knife-edge"}, "cam": asked, **LOAD}
    )
    with pytest.raises(InfeasibleError, match="pointed follower is unbounded"):
        _ = gc.build(design.with_({"limits.contact_pressure_mpa": 600})).cam
    assert gc.build(design).cam.outline.size  # without a limit any size will do


def test_hertz_on_an_edge() -> None:
    design: Any = gc.load("profiles/valve_train.toml")
    material = design.material
    bent = np.array([0.1, math.inf, math.inf, -0.1])
    force = np.array([10.0, 10.0, 0.0, 10.0])
    pressure = line_pressure(force, bent, material)
    assert np.isfinite(pressure[0])
    assert np.isposinf(pressure[1])
    assert np.isnan(pressure[2:]).all()
    assert half_width(force, bent, material)[1] == 0.0
