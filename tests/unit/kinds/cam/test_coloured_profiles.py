"""What profiles are coloured by: values and points, held against formulas and written files."""

from __future__ import annotations

import csv
import math
from pathlib import Path
from typing import Any

import numpy as np
import pytest

import gearcam as gc
from gearcam.cli import main
from gearcam.pictures.scenes import ColouredCurve

ANGLE, FORCE, PRESSURE = "pressure angle, deg", "normal force, N", "contact pressure, MPa"
FORCES = {"output.studies": ["forces"]}
BOTH_WAYS = {"load": [{"force_n": 100, "against": True}], **FORCES}
"""A load that the follower meets on its way up and down."""


def built(name: str, /, **changes: Any) -> Any:
    return gc.build(gc.load(f"profiles/{name}.toml").with_(changes))


def curves(result: Any, places: int = 360) -> tuple[ColouredCurve, ...]:
    return result.scene(places).coloured


def fixed(curve: ColouredCurve) -> Any:
    """Return the points of a curve of a disc that turns counter-clockwise, in the fixed frame."""
    return curve.points * np.exp(1j * np.radians(curve.places))


def test_pressure_angle_and_points_of_a_translating_roller_follower() -> None:
    """tan(alpha) = (s' - e) / (s0 + s) for a cycloidal rise of 10 mm over 90 deg and its return."""
    result = built("plate_cam_offset_roller")
    (curve,) = curves(result)
    assert list(curve.values) == [ANGLE]
    assert curve.body == result.parts[0].name
    theta, turn, start = np.radians(curve.places), math.pi / 2, math.sqrt(30**2 - 8**2)
    share = np.where(theta < math.pi, theta / turn, 3.0 - theta / turn).clip(0.0, 1.0)
    lift = 10.0 * (share - np.sin(2.0 * math.pi * share) / (2.0 * math.pi))
    speed = 10.0 / turn * (1.0 - np.cos(2.0 * math.pi * share))
    speed *= np.where(theta < math.pi, 1.0, -1.0)
    expected = np.degrees(np.arctan2(speed - 8.0, start + lift))
    assert curve.values[ANGLE] == pytest.approx(np.abs(expected), abs=1e-9)
    towards = 8.0 + 1j * (start + lift) - fixed(curve)  # from the point to the centre
    assert np.abs(towards) == pytest.approx(np.full(len(theta), 6.0), abs=1e-9)
    leaning = np.degrees(np.arctan2(np.abs(towards.real), towards.imag))
    assert leaning == pytest.approx(np.abs(expected), abs=1e-6)
    assert "forces" not in result.timings


def test_force_and_pressure_are_those_of_the_written_study(tmp_path: Path) -> None:
    """And the pressure is that of Hertz for a line contact with a flat face."""
    assert main(["forces", "profiles/valve_train.toml", "-o", str(tmp_path)]) == 0
    with (tmp_path / "valve_train" / "forces.csv").open() as file:
        rows = list(csv.DictReader(file))
    result = built("valve_train")
    (curve,) = curves(result)  # a flat face has no pressure angle
    assert list(curve.values) == [FORCE, PRESSURE]
    for column, values in (
        ("theta_deg", curve.places),
        ("normal_n", curve.values[FORCE]),
        ("pressure_mpa", curve.values[PRESSURE]),
    ):
        assert values == pytest.approx([float(row[column]) for row in rows], rel=1e-12)
    theta = np.radians(curve.places)
    radius = result.motion(theta)["rho_profile_mm"]
    softness = (1 - 0.26**2) / 105e3 + (1 - 0.3**2) / 206e3
    hertz = np.sqrt(curve.values[FORCE] / 14.0 / (math.pi * radius * softness))
    inner = np.abs(curve.places % 75.0) > 1e-6  # at knots the curvature jumps
    assert curve.values[PRESSURE][inner] == pytest.approx(hertz[inner], rel=1e-9)


@pytest.mark.parametrize(
    ("name", "bodies"), [("groove_cam", ["cam", "cam"]), ("conjugate_cams", ["cam1", "cam2"])]
)
def test_each_wall_has_the_force_where_it_carries(name: str, bodies: list[str]) -> None:
    load = BOTH_WAYS
    if name == "conjugate_cams":
        load = {"load": [{"torque_nm": 5, "against": True}], **FORCES}
    result = built(name, **load)
    found, columns = curves(result), result.study("forces").columns
    assert [one.body for one in found] == bodies
    assert {1, 2} <= set(columns["wall"].tolist())
    for number, (curve, wall) in enumerate(zip(found, result.cam.walls, strict=True), start=1):
        carries = columns["wall"] == number
        for label, column in ((FORCE, "normal_n"), (PRESSURE, "pressure_mpa")):
            expected = np.where(carries, columns[column], np.nan)
            assert curve.values[label] == pytest.approx(expected, nan_ok=True)
        assert not np.isnan(curve.values[ANGLE]).any()
        contact = result.contact(np.radians(curve.places), wall.key)
        points = contact["x_mm"] + 1j * contact["y_mm"]
        assert np.abs(curve.points - points).max() < 1e-6


def test_a_yoke_is_coloured_on_the_side_that_carries() -> None:
    """Above and below, as its points of contact."""
    result = built("yoke_cam", **BOTH_WAYS)
    scene = result.scene(720)
    wall = result.study("forces").columns["wall"]
    for number, side in enumerate(("upper side", "lower side"), start=1):
        curve = scene.coloured[number - 1]
        near = np.searchsorted(curve.places, scene.places[:-1] - 1e-6)
        found = fixed(curve)[near]
        assert np.abs(found - scene.contacts[side].point[:-1]).max() < 1e-6
        carries = ~np.isnan(curve.values[FORCE])
        assert carries.tolist() == (wall == number).tolist()
        assert carries.any()


def test_nothing_is_coloured_that_says_nothing() -> None:
    assert curves(built("flat_follower")) == ()
    result = built("valve_train", **{"output.studies": []})
    assert curves(result) == ()
    assert "forces" not in result.timings


def test_values_end_where_trimming_leaves_a_corner() -> None:
    """Between the angles that the finding tells."""
    (curve,) = curves(built("undercut_cam"))
    left = ~np.isnan(curve.values[ANGLE])
    assert not left[(curve.places > 20.8) & (curve.places < 40.4)].any()
    assert left[(curve.places < 20.6) | ((curve.places > 40.6) & (curve.places < 139.0))].all()
    assert np.isnan(curve.points[~left]).all()


def test_curves_are_cut_where_the_velocity_jumps() -> None:
    """The arc that joins both sides has no values; those at its ends stay."""
    law = {"motion[2].law": "constant-velocity"}  # the return, which ends at 270 deg
    (curve,) = curves(built("plate_cam_offset_roller", **law))
    cut = np.flatnonzero(np.isnan(curve.places))[-1]
    assert np.isnan(curve.points[cut])
    assert curve.places[[cut - 1, cut + 1]] == pytest.approx([270.0, 270.0])
    last, first = curve.values[ANGLE][[cut - 1, cut + 1]]
    start, speed = math.sqrt(30**2 - 8**2), 10.0 / (math.pi / 2)
    assert last == pytest.approx(math.degrees(math.atan((speed + 8.0) / start)))
    assert first == pytest.approx(math.degrees(math.atan(8.0 / start)))
