"""Cams whose design gives a density act in a mechanism by their mass, as wheels do."""

from __future__ import annotations

from math import pi
from typing import Any

import numpy as np
import pytest

import gearcam as gc
from gearcam.base.errors import InfeasibleError
from helpers_linkages import agree
from helpers_rotors import Point, prisms, shaft_frame, shaken

RPM = 300.0
SPEED = RPM * pi / 30.0
DENSITY = 7850

CAMS: dict[str, tuple[str, dict[str, Any]]] = {
    "disc": ("valve_lever", {}),
    "disc, clockwise": ("valve_lever", {"cam.rotation": "cw"}),
    "groove": ("groove_cam", {}),
    "conjugate": ("conjugate_cams", {}),
    "conjugate, clockwise": ("conjugate_cams", {"cam.rotation": "cw"}),
    "yoke": ("yoke_cam", {}),
}

PLACED: dict[str, dict[str, Any]] = {
    "as it is": {},
    "mirrored": {"mirror": True, "turn_deg": 20, "at_mm": [30, -50]},
}


def cam_of(name: str, density: float | None = DENSITY) -> Any:
    profile, changes = CAMS[name]
    given = {} if density is None else {"blank.density_kg_m3": density}
    return gc.load(f"profiles/{profile}.toml").with_(changes | given)


def machine(name: str, density: float | None = DENSITY, **changes: Any) -> Any:
    """A cam behind an even shaft, in another frame and with another ratio where it is placed."""
    placed = changes.pop("placed", {})
    drives = [
        {"name": "motor", "even": True, "speed_rpm": RPM},
        {"name": "cam", "cam": cam_of(name, density), **placed},
    ]
    crank = [{"name": "crank", "on": "motor", "joint": "B", "length_mm": 40}]
    tables = {"kind": "mechanism", "name": "m", "drive": drives, "crank": crank, **changes}
    return gc.build(gc.design(tables))


def cam_points(result: Any, placed: dict[str, Any], drive: int = 1) -> list[Point]:
    """Its cams as points, turned as conventions say."""
    own, design = result.drives[drive].result, result.design.drive[drive]
    side = -1.0 if own.design.cam.rotation == "cw" else 1.0
    rate, phase = placed.get("ratio", 1.0), np.radians(placed.get("phase_deg", 0.0))
    path = shaft_frame(placed, lambda q: side * (rate * q + phase))
    gap = 0.0 if len(own.parts) == 1 else design.cam.cam.thickness + design.cam.cam.gap
    over = -1.0 if placed.get("mirror") else 1.0
    return [
        Point(mass, path(center), over * (z + number * gap))
        for number, part in enumerate(own.parts)
        for mass, center, z in prisms(part, DENSITY)
    ]


@pytest.mark.parametrize("placed", PLACED)
@pytest.mark.parametrize("name", CAMS)
def test_the_frame_is_shaken_by_the_cam(name: str, placed: str) -> None:
    """Force and moment are those of its polygon, by differences of its places."""
    how = {**PLACED[placed], "ratio": -2.0, "phase_deg": 50.0}
    result = machine(name, placed=how)
    found = result.study("balance").columns
    rows = slice(0, None, 40)
    q = np.radians(found["theta_deg"][rows])
    wanted = shaken(cam_points(result, how), q, SPEED)
    top = np.abs(wanted[:, :2]).max()
    assert top > 1.0
    own = np.stack([found["force_x_n"], found["force_y_n"], 1e3 * found["moment_nm"]], axis=1)
    off = np.abs(own[rows] - wanted[:, [0, 1, 5]]).max(axis=0)
    assert (off < 1e-4 * top * np.array([1.0, 1.0, 100.0])).all()


@pytest.mark.parametrize("name", ["disc, clockwise", "conjugate"])
def test_the_driver_lifts_the_weight_of_the_cam(name: str) -> None:
    """Its moment is the slope of the work that lifts the centre of mass."""
    how, down = PLACED["mirrored"], {"gravity": {"direction_deg": -90}}
    load = [{"of": "crank", "inertia_kg_m2": 1e-3}]
    heavy, light = (machine(name, one, placed=how, mass=load, **down) for one in (DENSITY, None))
    both = [one.study("torque").columns for one in (heavy, light)]
    q = np.radians(both[0]["theta_deg"])[::60]
    more = (both[0]["torque_nm"] - both[1]["torque_nm"])[::60]
    step, found = 1e-4, 0.0 * q
    for mass, path, _ in cam_points(heavy, how):
        rise = (path(q + step).imag - path(q - step).imag) / (2.0 * step)
        found = found + 9.80665e-3 * mass * rise
    assert np.abs(found).max() > 0.01
    assert np.abs(more - found).max() < 1e-4 * np.abs(found).max()
    assert "cam.shaft" in heavy.study("torque").facts["torque.assumptions"]
    assert "cam.shaft" not in light.study("torque").facts["torque.assumptions"]


def test_the_bearing_carries_the_cam() -> None:
    """Nothing is on its follower, which presses on it with no force."""
    how, load = PLACED["mirrored"], [{"of": "crank", "inertia_kg_m2": 1e-3}]
    result = machine("groove", placed=how, mass=load)
    forces = result.study("forces")
    q = np.radians(forces.columns["theta_deg"])
    wanted = shaken(cam_points(result, how), q, SPEED)
    size = np.abs(wanted[:, :2]).max()
    for axis, name in enumerate("xy"):
        off = forces.columns[f"cam.shaft_{name}_n"] + wanted[:, axis]
        assert np.abs(off).max() < 1e-4 * size
    plain = machine("groove", None, placed=how, mass=load).study("forces")
    assert "cam.shaft_x_n" not in plain.columns


def test_a_cam_alone_has_a_mass() -> None:
    cam = cam_of("yoke")
    tables = {"kind": "mechanism", "name": "m"}
    drive = {"name": "cam", "cam": cam, "speed_rpm": RPM}
    result = gc.build(gc.design({**tables, "drive": [drive]}))
    facts = gc.build(cam).facts
    wanted = 1e-6 * facts["part.mass.unbalance_g_mm"] * SPEED**2
    agree(result.study("balance").facts["balance.force_n"], wanted)
    light = gc.design({**tables, "drive": [{**drive, "cam": cam_of("yoke", None)}]})
    with pytest.raises(gc.DesignError, match="density_kg_m3 of wheels or cams"):
        gc.build(light).study("balance")


def test_a_cam_that_cannot_be_made_is_told_with_its_drive() -> None:
    cam = cam_of("disc").with_({"blank.bore_diameter_mm": 90, "blank.hub_diameter_mm": 0})
    drive = {"name": "cam", "cam": cam, "speed_rpm": RPM}
    result = gc.build(gc.design({"kind": "mechanism", "name": "m", "drive": [drive]}))
    with pytest.raises(InfeasibleError) as caught:
        result.study("balance")
    assert caught.value.where.startswith("drive[0].cam: cam, ")
