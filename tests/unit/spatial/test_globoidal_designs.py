"""Designs of globoidal cams: what is read, refused, found, and written."""

from __future__ import annotations

import csv
import io
import math
import subprocess
import sys
from pathlib import Path
from typing import Any

import numpy as np
import pytest

import gearcam as gc
from gearcam.base.errors import DesignError, InfeasibleError
from gearcam.designs.writing import toml_text
from helpers_globoidal import DESIGN
from helpers_pairs import PROFILES
from helpers_sampling import few

TEXT = (PROFILES / "globoidal_indexer.toml").read_text("utf-8")


def built(**changes: Any) -> Any:
    return gc.build(DESIGN.with_({key.replace("__", "."): one for key, one in changes.items()}))


def codes(result: Any) -> list[tuple[str, str]]:
    return [(one.severity, one.code) for one in result.findings]


@pytest.mark.parametrize(
    ("change", "words"),
    [
        (('"modified-sine"', '"modified-sin"'), "did you mean modified-sine?"),
        (("angle_deg = 120", "angle_dg = 120"), "did you mean angle_deg?"),
        (("[index]", "[[index]]"), "is not a table"),
        (("angle_deg = 120", "angle_deg = 360"), "from 1 to 350"),
        (("roller_radius_mm = 8", "roller_radius_mm = 20"), "neighbouring rollers overlap"),
        (("reach_mm = 58", "reach_mm = 14"), "begin at the axis of the turret"),
        (("stops = 8", "stops = 2"), "from 3 to 100"),
        (('"svg", "report"', '"dxf"'), "cannot be unrolled into a plane"),
        (('"svg", "report"', '"step"'), "made of triangles"),
        (('"svg", "report"', '"tool-path"'), "motion.csv has the angles of cam and turret"),
        (('"globoidal"', '"globoid"'), "did you mean globoidal?"),
    ],
)
def test_mistakes_are_told(change: tuple[str, str], words: str) -> None:
    assert change[0] in TEXT
    with pytest.raises(DesignError) as caught:
        gc.loads(TEXT.replace(*change))
    assert words in str(caught.value)


@pytest.mark.parametrize(
    ("changes", "words"),
    [
        ({"cam__center_distance_mm": 70}, "core of the cam is not thicker than the bore"),
        ({"cam__floor_clearance_mm": 20}, "outside the reach of the rollers"),
        ({"cam__roller_clearance_mm": 30}, "grooves of neighbouring rollers would meet"),
        ({"cam__length_mm": 95}, "beyond the body of the turret"),
        ({"turret__roller_radius_mm": 16.2}, "cut through the rib"),
    ],
)
def test_the_nearest_value_is_named_and_can_be_built(changes: dict[str, Any], words: str) -> None:
    with pytest.raises(InfeasibleError, match=words) as caught:
        _ = built(**changes).cam
    near = caught.value.adjustments[0].near
    given = {key.replace("__", "."): one for key, one in changes.items()}
    _ = gc.build(DESIGN.with_({**given, **near})).cam


def test_few_stops_cannot_be_held() -> None:
    with pytest.raises(InfeasibleError, match="so few stops"):
        _ = built(turret__stops=3, index__angle_deg=200).cam
    with pytest.raises(InfeasibleError, match="velocity jumps"):
        _ = built(index__law="constant-velocity").cam


def test_laws_with_parameters() -> None:
    ends = {"start": [0, 0], "end": [0, 0]}  # velocity and acceleration
    shape = {"law": "polynomial", "angle_deg": 120, **ends}
    polynomial = gc.build(DESIGN.with_({"index": shape}))
    other = built(index__law="3-4-5")
    assert polynomial.cam.pressure.value == pytest.approx(other.cam.pressure.value, rel=1e-12)
    again = gc.loads(toml_text(polynomial.design.to_dict()))
    assert gc.build(again).design_hash == polynomial.design_hash


def test_findings() -> None:
    assert codes(built()) == []
    assert codes(built(index__angle_deg=100)) == [("warning", "pressure-angle")]
    assert codes(built(cam__length_mm=43)) == [("warning", "loose-turret")]
    assert codes(built(cam__length_mm=30)) == [("error", "loose-turret")]
    assert codes(built(cam__roller_clearance_mm=0.08)) == [("warning", "lost-motion")]
    assert codes(built(cam__roller_clearance_mm=0)) == [("note", "no-clearance")]
    assert codes(built(cam__floor_clearance_mm=0)) == [("note", "no-clearance")]
    assert codes(built(index__law="harmonic")) == [("note", "acceleration-jump")] * 2
    assert codes(built(limits__wall_thickness_mm=16)) == [("warning", "thin-wall")]
    assert codes(built(blank__bore_diameter_mm=80)) == [("warning", "thin-wall")]


@pytest.mark.parametrize(
    ("changes", "code", "key"),
    few(
        [
            ({"index__angle_deg": 100}, "pressure-angle", "cam.center_distance_mm"),
            ({"cam__length_mm": 30}, "loose-turret", "cam.length_mm"),
            (
                {"cam__center_distance_mm": 75},
                "undercut",
                "turret.roller_radius_mm",
            ),
        ]
    ),
)
def test_values_that_findings_name_help(changes: dict[str, Any], code: str, key: str) -> None:
    before = built(**changes)
    (found, *_) = (one for one in before.findings if one.code == code)
    word = key.rpartition(".")[2]
    said = found.message.partition(word)[2]
    value = float(next(part for part in said.replace("=", " ").split() if part[0].isdigit()))
    given = {name.replace("__", "."): one for name, one in changes.items()}
    after = gc.build(DESIGN.with_({**given, key: value}))
    assert code not in [one.code for one in after.findings]


def rows(result: Any, name: str) -> dict[str, list[str]]:
    text = result.files("csv")[name].decode()
    table = list(csv.DictReader(io.StringIO(text)))
    return {key: [row[key] for row in table] for key in table[0]}


def test_walls_in_the_table_are_on_the_cam() -> None:
    result = built(output__wall_step_deg=5, output__wall_points=5, cam__rotation="cw")
    table = rows(result, "walls.csv")
    points, normals = (
        np.array([table[key] for key in keys], dtype=float).T
        for keys in ("XYZ", ("nx", "ny", "nz"))
    )
    assert np.linalg.norm(normals, axis=1) == pytest.approx(np.ones(len(normals)))
    assert np.abs(points[:, 2]).max() <= result.cam.half_length
    theta = np.radians(np.array(table["theta_deg"], dtype=float))
    x, number = (np.array(table[key], dtype=float) for key in ("x_mm", "roller"))
    assert ((theta >= 0.0) & (theta < 2.0 * math.pi)).all()
    assert set(table["wall"]) == {"upper", "lower"}
    # the roller of that number stands a roller's radius from the point; all is mirrored
    psi = result.cam.angle(theta) + number * result.cam.pitch
    c, s = np.cos(theta), -np.sin(theta)
    fixed = c * points[:, 0] - s * points[:, 1], s * points[:, 0] + c * points[:, 1], points[:, 2]
    away = np.hypot(fixed[1], (fixed[0] - 100.0) * np.sin(psi) + fixed[2] * np.cos(psi))
    assert away == pytest.approx(np.full(len(away), 8.005), abs=1e-9)
    along = (100.0 - fixed[0]) * np.cos(psi) + fixed[2] * np.sin(psi)
    assert along == pytest.approx(x, abs=1e-9)


def test_the_motion_in_the_table() -> None:
    table = rows(built(), "motion.csv")
    theta, turret = (np.array(table[key], dtype=float) for key in ("theta_deg", "turret_deg"))
    assert (theta[-1], turret[0], turret[-1]) == (360.0, 0.0, 45.0)
    assert turret[theta == 60.0] == pytest.approx([22.5])
    speed = np.array(table["velocity_deg_s"], dtype=float)
    assert speed.max() == pytest.approx(360 * 0.375 * 4 * math.pi / (4 + math.pi))  # 60 rpm
    worst = max(float(one) for one in table["pressure_angle_end_deg"])
    assert worst == pytest.approx(math.degrees(built().cam.pressure.value))


@pytest.mark.parametrize("rotation", ["ccw", "cw"])
def test_after_a_turn_the_turret_stands_where_its_next_roller_stood(rotation: str) -> None:
    result = built(cam__rotation=rotation)
    turret = result.in_space(np.array([0.0, 2.0 * math.pi]))["turret"].matrix
    pitch = math.pi / 4
    c, s = math.cos(pitch), math.sin(pitch)
    step = np.array([[c, 0, s], [0, 1, 0], [-s, 0, c]])  # about y, which is mirrored on itself
    assert turret[1, :3, :3] == pytest.approx(turret[0, :3, :3] @ step, abs=1e-12)
    assert turret[:, :3, 3] == pytest.approx(np.array([[100.0, 0, 0]] * 2))


def test_the_scene_moves_rollers_along_the_grooves() -> None:
    """On the sheet a roller's centre keeps half a groove from both edges, in a dwell exactly."""
    scene = built().scene(360)
    cam, turret = scene.bodies
    grooves = [one.shape for one in cam.features if one.layer == "GROOVE"]
    assert len(grooves) >= 2
    middle = 51.25
    at = complex(turret.pose.shift[200])
    centre = 1j * middle * math.pi / 8 + (100.0 - middle) * math.radians(160.0)
    assert at == pytest.approx(centre)
    edges: Any = np.concatenate([one.points for one in grooves])
    edges = edges[edges.imag < at.imag]  # the upper ones are beyond the face
    half = middle * math.atan2(8.005, middle)
    assert np.abs(edges - at).min() == pytest.approx(half, rel=0.02)


@pytest.mark.slow
def test_tables_import_no_other_kind_and_make_no_solid(tmp_path: Path) -> None:
    text = TEXT.replace("density_kg_m3 = 7850", "")
    design = tmp_path / "plain.toml"
    design.write_text(text.replace(', "stl", "svg", "report"', ""), "utf-8")
    code = (
        "import sys, gearcam as gc\n"
        f"cylinder = gc.load({str(PROFILES / 'cylinder_cam.toml')!r})\n"
        "result = gc.build(cylinder.with_({'output.files': ['csv'], 'output.studies': []}))\n"
        f"result.write({str(tmp_path / 'cylinder')!r})\n"
        "print([name for name in sys.modules if 'globoid' in name or 'indexing' in name])\n"
        f"gc.build(gc.load({str(design)!r})).write({str(tmp_path)!r})\n"
        "print([name for name in ('manifold3d', 'trimesh', 'shapely') if name in sys.modules])"
    )
    found = subprocess.run([sys.executable, "-c", code], capture_output=True, text=True, check=True)
    assert found.stdout.strip().splitlines()[-2:] == ["[]", "[]"]
    assert (tmp_path / "plain" / "walls.csv").exists()


def test_a_cam_without_a_whole_rib_has_facts() -> None:
    """So short that no point of a wall is on it: there is no least spread."""
    turret = {"stops": 6, "roller_radius_mm": 30, "roller_length_mm": 30, "reach_mm": 100}
    size = {"form": "globoidal", "center_distance_mm": 200, "length_mm": 2}
    result = gc.build(DESIGN.with_({"turret": turret, "cam": size, "index.angle_deg": 100}))
    walls = result.facts.document["cam"]["walls"]
    assert "least_spread_mm" not in walls["lower"]
