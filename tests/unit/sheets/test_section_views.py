"""What a section shows: keyways, chamfers and threads, and what points at it."""

from __future__ import annotations

import numpy as np
import pytest

import gearcam as gc
from gearcam.numeric.arrays import Plane
from gearcam.parts.blank import TAPPED, WheelBlank, thread_diameter
from gearcam.parts.make import make_part
from gearcam.parts.openings import Workpiece
from gearcam.parts.solids import solid
from gearcam.pictures.drawings import Path, chains
from gearcam.sheets.sections import Section, mesh_loops
from gearcam.sheets.sheet import Sheet
from gearcam.sheets.wheel import Wheel
from helpers_built import built
from helpers_contour import disc_contour
from helpers_sheets import faults

TOLERANCES = {"drawing.runout_mm": 0.03, "drawing.profile_tolerance_mm": 0.02}


def sheet_of(name: str, number: int = 0, **keys: object) -> Sheet:
    changes = {key.replace("__", "."): value for key, value in keys.items()} | TOLERANCES
    return built(gc.load(f"profiles/{name}.toml").with_(changes)).sheets[number]


def area(loops: list[Plane]) -> float:
    return abs(sum(0.5 * float((np.conj(one) * np.roll(one, -1)).imag.sum()) for one in loops))


def is_metal(sheet: Sheet, points: Plane) -> list[bool]:
    """Whether points of the section, z from its left end and y, lie within its hatch."""
    loops = sheet.hatches[0].loops
    left = min(float(loop.real.min()) for loop in loops)
    found = []
    for point in points + left:
        starts, ends = np.concatenate(loops), np.concatenate([np.roll(one, -1) for one in loops])
        over = (starts.imag > point.imag) != (ends.imag > point.imag)
        first, last = starts[over] - point, ends[over] - point
        x = first.real - first.imag * (last - first).real / (last - first).imag
        found.append(bool((x > 0.0).sum() % 2))
    return found


def from_edge(sheet: Sheet, points: Plane) -> np.ndarray:
    """Distances of points from the edges of the cut metal, mm."""
    loops = sheet.hatches[0].loops
    starts = np.concatenate(loops)
    ways = np.concatenate([np.roll(one, -1) for one in loops]) - starts
    starts, ways = starts[np.abs(ways) > 0.0], ways[np.abs(ways) > 0.0]
    share = ((points[:, None] - starts) / ways).real.clip(0.0, 1.0)
    return np.abs(starts + share * ways - points[:, None]).min(axis=1)


def labels(sheet: Sheet) -> list[str]:
    return [one.label for one in sheet.dimensions]


@pytest.mark.parametrize("keys", [{}, {"keyway_width": 4.0, "keyway_depth": 2.0}])
def test_chamfers_are_cut(keys: dict[str, float]) -> None:
    """In closed form: each of the eight corners lacks a triangle; and as the mesh has them."""
    blank = WheelBlank(bore_diameter=12.0, chamfer=1.0, timing_marks=False, **keys)  # type: ignore[arg-type]
    work = Workpiece(name="the disc", wheel=1, rim=5.4)
    part = make_part("gear1", [disc_contour(30.0, 1e-4)], 10.0, blank, work, lambda: None)  # type: ignore[arg-type,return-value]
    cut = Wheel(part=part).section
    top = 8.0 if keys else 6.0
    assert area(cut.metal) == pytest.approx(10.0 * (60.0 - 6.0 - top) - 8 * 0.5, abs=5e-3)
    turned = Wheel(part=part).shown
    assert area(cut.metal) == pytest.approx(area(mesh_loops(solid(turned))), abs=5e-3)
    ends = {(round(z.real, 3), round(z.imag, 3)) for pair in cut.lines for z in pair}
    assert {(0.0, -29.0), (1.0, -30.0), (0.0, -7.0), (1.0, top), (9.0, top)} <= ends


def test_the_section_of_a_barrel_shows_keyway_screw_and_chamfers() -> None:
    sheet = sheet_of("ordered_drum")
    # the hub is 16 mm at the back, with the screw in its middle and over the keyway
    keyway = [36.0 + 14.0j, 36.0 - 14.0j, 36.0 + 16.5j]
    screw = [8.0 + 18.0j, 8.0 - 18.0j, 11.0 + 18.0j]
    chamfer = [73.9 + 44.8j, 73.3 + 44.8j, 73.9 - 44.8j]
    assert is_metal(sheet, np.array(keyway)) == [False, True, True]
    assert is_metal(sheet, np.array(screw)) == [False, True, True]
    assert is_metal(sheet, np.array(chamfer)) == [False, True, False]
    beside = sheet_of("ordered_drum", blank__set_screw_angle_deg=90)
    assert is_metal(beside, np.array(screw)) == [True, False, True]


def test_the_groove_is_dimensioned_once() -> None:
    for name, words in (
        ("ordered_drum", "groove 16.03 wide, 9.5 deep"),
        ("globoidal_indexer", "groove 16.01 wide, 14.549 deep"),
        ("groove_cam", "groove 12.05 wide"),
    ):
        sheet = sheet_of(name)
        assert labels(sheet).count(words) == 1
        assert not [row for row in sheet.rows if row[0].startswith("groove width")]
        assert any("tolerance: that of its profile" in one.text for one in sheet.texts)
        assert [*faults(sheet)] == []


@pytest.mark.parametrize(
    "name", ["ordered_drum", "cylinder_cam", "globoidal_indexer", "groove_cam"]
)
def test_frames_point_at_what_they_are_about(name: str) -> None:
    """The arrow of run-out touches the section, that of the profile a wall of the groove."""
    sheet = sheet_of(name)
    tips = np.array([fill[0] for fill in sheet.fills])
    edge = from_edge(sheet, tips) < 1e-6
    assert edge.sum() == 1
    if name == "globoidal_indexer":  # its outside is no cylinder: the face
        left = min(float(loop.real.min()) for loop in sheet.hatches[0].loops)
        assert float(tips[edge][0].real) == pytest.approx(left, abs=1e-6)
    else:
        top = max(float(loop.imag.max()) for loop in sheet.hatches[0].loops)
        assert float(tips[edge][0].imag) == pytest.approx(top, abs=0.01)
    layers = {"UPPER", "LOWER", "GROOVE", "OUTER", "INNER"}
    walls = [one.shape for one in sheet.features if one.layer.rpartition("_")[2] in layers]
    points = np.concatenate([points for one in walls for points, _ in chains(one, 1e-3)])
    away = np.abs(tips[:, None] - points).min(axis=1)
    assert (away < 1e-6).sum() == 1


def test_threads_are_thin_lines_outside_their_hole() -> None:
    """M4: at its diameter, the metal cut up to the core hole; where it stands is measured."""
    sheet = sheet_of("gate_rack")
    shapes = [one.shape for one in sheet.features if one.layer == "DIMENSION"]
    thin = [one.points for one in shapes if isinstance(one, Path)]
    left = min(float(loop.real.min()) for loop in sheet.hatches[0].loops)
    lines = [
        one for one in thin if len(one) == 2 and abs(abs(one[0].real - left - 19.5) - 2.0) < 1e-6
    ]
    assert len(lines) == 2
    assert {round(float(one.imag.max()), 6) for one in lines} == {10.0}
    assert is_metal(sheet, np.array([19.5 + 1.6 + 8.0j, 19.5 + 1.7 + 8.0j])) == [False, True]
    assert 4.5 in [one.value for one in sheet.dimensions if one.kind == "linear"]


def test_threads_are_wider_than_their_holes() -> None:
    assert [thread_diameter(one) for one in ("M2.5", "#10-32", "5/16-18")] == pytest.approx(
        [2.5, 4.826, 7.9375]
    )
    for size, drill in TAPPED.items():
        assert 1.1 < thread_diameter(size) / drill < 1.3


def test_the_direction_of_a_keyway_is_dimensioned_from_theta_0() -> None:
    sheet = sheet_of("groove_cam", blank__keyway_angle_deg=200)
    zero = np.degrees(built(gc.load("profiles/groove_cam.toml")).turning(0).zero)
    assert f"{200 - zero:.3f}°" in labels(sheet)
    assert not [row for row in sheet.rows if row[0] == "keyway, direction"]
    assert ("keyway, direction", "0 deg") in sheet_of("ordered_drum").rows
    assert "40°" in labels(sheet_of("ordered_drum", blank__keyway_angle_deg=40))


def test_no_letter_stands_for_section_and_datum() -> None:
    shown = [one.text for one in sheet_of("ordered_drum").texts]
    assert shown.count("A") == 2
    assert shown.count("B") == 3  # at the bore, in both frames


def test_a_section_without_layers_in_the_plane_is_empty() -> None:
    assert Section(layers=[], pockets=[], x=0.0, tolerance=1e-3).metal == []


@pytest.mark.parametrize(
    ("files", "named"),
    [
        (["step", "csv", "drawing-svg"], "walls.csv, cam.step."),
        (["stl", "drawing-svg"], "cam.stl."),
        (["drawing-svg"], "walls.csv (not written with this drawing)."),
    ],
)
def test_the_files_with_the_walls_of_a_cam_are_named(files: list[str], named: str) -> None:
    texts = " ".join(one.text for one in sheet_of("cylinder_cam", output__files=files).texts)
    assert f"Walls: {named}" in texts
