"""The contact pressure is unbounded where the follower rides on an edge, and is told so."""

from __future__ import annotations

import json
import math
from pathlib import Path
from typing import Any

import numpy as np
import pytest

import gearcam as gc
from gearcam.base.errors import InfeasibleError
from gearcam.mechanics.hertz import half_width, line_pressure
from gearcam.numeric.arrays import Mask
from helpers_sampling import chosen

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


@pytest.mark.parametrize("limit", [None, 600.0])
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
