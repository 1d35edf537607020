"""Hubs, keyways, screws, holes, marks and chamfers: volumes of solids against closed forms.

Meshes and STEP solids are made in different ways; both must have the volume that the sizes give.
"""

from __future__ import annotations

import math
from dataclasses import replace
from functools import lru_cache
from typing import Any

import numpy as np
import pytest

import gearcam as gc
from gearcam.parts.body import Part
from gearcam.parts.solids import SolidError, demand_volume, solid, volume_error
from helpers_pairs import PROFILES

SIZES: dict[str, Any] = {
    "blank.bore_diameter_mm": 10,
    "blank.keyway_width_mm": 3,
    "blank.keyway_depth_mm": 1.4,
    "blank.hub_diameter_mm": 22,
    "blank.hub_front_mm": 9,
}
SCREW = SIZES | {"blank.set_screw": "M4"}
DRILL = 3.3

DRUM: dict[str, Any] = {
    "blank.keyway_width_mm": 8,
    "blank.keyway_depth_mm": 3.3,
    "blank.hub_diameter_mm": 60,
    "blank.hub_front_mm": 14,
    "blank.hub_back_mm": 5,
    "blank.set_screw": "M6",
    "blank.chamfer_mm": 0.8,
    "blank.rotation_arrow": True,
    "blank.zero_mark": True,
    "blank.bolts": 3,
    "blank.bolt_circle_mm": 66,
    "blank.bolt_diameter_mm": 4,
    "output.wall_step_deg": 2.0,
    "output.wall_points": 5,
}


@lru_cache(maxsize=16)
def _built(name: str, changes: tuple[tuple[str, Any], ...] = ()) -> Any:
    return gc.build(gc.load(PROFILES / f"{name}.toml").with_(dict(changes)))


def _part(name: str, changes: dict[str, Any]) -> Part:
    return _built(name, tuple(changes.items())).parts[0]


def _screw_volume(outer: float, inner: float, drill: float) -> float:
    """Return the volume of a radial hole from a plane or a cylinder `inner` to a cylinder."""
    y = np.linspace(-0.5 * drill, 0.5 * drill, 200001)
    chord = 2.0 * np.sqrt(np.maximum((0.5 * drill) ** 2 - y**2, 0.0))
    return float(np.trapezoid(chord * (np.sqrt(outer**2 - y**2) - inner), y))


@pytest.mark.parametrize("angle", [0.0, 90.0, 45.0])
def test_a_set_screw_goes_from_the_hub_to_the_bore(angle: float) -> None:
    changes = {**SCREW, "blank.keyway_width_mm": 0, "blank.keyway_depth_mm": 0}
    changes["blank.set_screw_angle_deg"] = angle
    part = _part("plate_cam_offset_roller", changes)
    assert part.screw is not None
    y = np.linspace(-0.5 * DRILL, 0.5 * DRILL, 200001)
    chord = 2.0 * np.sqrt(np.maximum((0.5 * DRILL) ** 2 - y**2, 0.0))
    true = np.trapezoid(chord * (np.sqrt(11.0**2 - y**2) - np.sqrt(5.0**2 - y**2)), y)
    assert part.screw.height * part.screw.moments.area == pytest.approx(true, abs=1e-5)
    way = part.screw.moments.first
    assert math.degrees(math.atan2(way.imag, way.real)) == pytest.approx(angle)
    bare = replace(part, screw=None)
    cut = solid(bare).volume - solid(part).volume
    assert cut == pytest.approx(true, rel=2e-3)


def test_a_set_screw_over_a_keyway_ends_in_its_floor() -> None:
    part = _part("plate_cam_offset_roller", SCREW | {"blank.keyway_width_mm": 4})
    assert part.screw is not None
    true = _screw_volume(11.0, 6.4, DRILL)
    assert part.screw.height * part.screw.moments.area == pytest.approx(true, abs=1e-3)
    cut = solid(replace(part, screw=None)).volume - solid(part).volume
    assert cut == pytest.approx(true, rel=2e-3)


def test_a_chamfer_takes_what_cones_and_steiner_say() -> None:
    size = 0.5
    round_hub = {**SIZES, "blank.keyway_width_mm": 0, "blank.keyway_depth_mm": 0}
    part = _part("plate_cam_offset_roller", round_hub | {"blank.chamfer_mm": size})

    def ring(radius: float, outwards: float) -> float:
        """Return the volume between a cylinder and a cone at 45 deg."""
        return math.pi * size**2 * (radius - outwards * size / 3.0)

    length = part.contour.length
    steiner = 0.5 * size**2 * length - math.pi * size**3 / 3.0  # a convex edge without corners
    expected = 2.0 * steiner + 2.0 * ring(5.0, -1.0) + ring(11.0, 1.0)
    taken = sum(one.height * one.moments.area for one in part.bevels)
    assert taken == pytest.approx(expected, rel=2e-5)
    bare = replace(part, bevels=())
    assert solid(bare).volume - solid(part).volume == pytest.approx(expected, rel=2e-3)
    # a chamfer that is left out, or is of another size, is seen
    with pytest.raises(SolidError):
        demand_volume(part, solid(bare).volume, volume_error(part))


def test_teeth_have_chamfers_at_both_faces() -> None:
    part = _part("ellipse", {"blank.chamfer_mm": 0.3})
    assert [(one.up, one.hollow) for one in part.bevels] == [(False, False), (True, False)]
    mesh = solid(part)  # its volume is compared with that of the part
    z = mesh.vertices[:, 2]
    faces = [mesh.vertices[np.abs(z - level) < 1e-9] for level in (0.0, part.width)]
    reach = [float(np.hypot(*one[:, :2].T).max()) for one in faces]
    assert part.contour.reach - 0.45 < min(reach) <= max(reach) < part.contour.reach - 0.2


@pytest.mark.parametrize(
    ("name", "changes"),
    [
        ("cylinder_cam", {}),
        ("globoidal_indexer", {"blank.hub_diameter_mm": 44, "blank.bolt_circle_mm": 0,
                               "blank.bolts": 0, "blank.bolt_diameter_mm": 0,
                               "blank.chamfer_mm": 0}),
    ],
)  # fmt: skip
def test_a_cam_in_space_has_what_its_core_has(name: str, changes: dict[str, Any]) -> None:
    coarse = {key: value for key, value in DRUM.items() if key.startswith("output")}
    bare = _built(name, tuple((coarse | {"blank.bore_diameter_mm": 0}).items()))
    made = _built(name, tuple((DRUM | changes).items()))
    radius, _, length = made.core_size
    change = made.core.volume - math.pi * radius**2 * length
    assert made.mesh.watertight
    assert made.mesh.volume - bare.mesh.volume == pytest.approx(change, abs=2e-4 * abs(change))
    # the face in front is turned as the cam is
    assert (made.core.arrow is None) == ("rotation_arrow" not in str(DRUM))


def test_a_mirrored_cam_keeps_the_direction_of_its_keyway() -> None:
    turned = {**DRUM, "blank.keyway_angle_deg": 90}
    meshes = [
        _built("cylinder_cam", tuple({**turned, "cam.rotation": way}.items())).mesh
        for way in ("ccw", "cw")
    ]
    for mesh in meshes:
        top = mesh.vertices[mesh.vertices[:, 2] > mesh.vertices[:, 2].max() - 1e-6]
        along = top[(np.abs(top[:, 0]) < 5.0) & (np.abs(top[:, 1]) < 25.0), 1]
        assert along.max() == pytest.approx(23.3 + 0.8, abs=1e-3)  # the floor with its chamfer
        assert along.min() == pytest.approx(-20.8, abs=1e-3)


def test_a_thin_wall_and_a_wide_hub_of_a_drum_are_told() -> None:
    design = gc.load(PROFILES / "ordered_drum.toml")
    bolts = {"blank.bolts": 3, "blank.bolt_circle_mm": 58, "blank.bolt_angle_deg": 60}
    found = gc.build(design.with_(bolts | {"blank.bolt_diameter_mm": 12})).findings
    (thin,) = [one for one in found if one.code == "thin-wall"]
    assert thin.value == pytest.approx(35.5 - 29 - 6, abs=1e-3)
    assert "floor of the groove" in thin.message
    with pytest.raises(gc.InfeasibleError, match="the hub reaches the floor of the groove"):
        _ = gc.build(design.with_({"blank.hub_diameter_mm": 75})).findings


@pytest.mark.parametrize("height", [4, 7])
def test_a_bar_that_is_too_low_gets_a_height_for_its_holes(height: float) -> None:
    design = gc.load(PROFILES / "gate_rack.toml").with_(
        {"bar.height_mm": height, "blank.chamfer_mm": 0, "output.files": ["csv"]}
    )
    with pytest.raises(gc.InfeasibleError):
        _ = gc.build(design).parts
    (found,) = gc.remedies(gc.build(design)).found
    rack = gc.build(design.with_(found.changes)).parts[1]
    assert rack.size[0] == pytest.approx(found.changes["bar.height_mm"])
    assert height < rack.size[0] < 20.0
    assert len(rack.openings) == 4
