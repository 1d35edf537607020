"""The kerf moves the paths of files to be cut, and nothing else; clearance changes the part."""

from __future__ import annotations

import io
import math
from dataclasses import replace
from functools import cache
from typing import Any

import numpy as np
import pytest
import shapely
import trimesh
from ezdxf.entities.circle import Circle as DxfCircle
from ezdxf.entities.lwpolyline import LWPolyline

import gearcam
from gearcam.base.errors import DesignError, InfeasibleError
from gearcam.base.quantities import LEAST_ALLOWANCE
from gearcam.designs import load, loads
from gearcam.export.dxf_read import DxfError, read_dxf, read_outline
from gearcam.kinds.cam.result import CamResult
from gearcam.kinds.gear_pair.design import PairOutputSpec
from gearcam.kinds.gear_pair.result import GearPairResult
from gearcam.parts.blank import Blank, WheelBlank
from gearcam.parts.body import Part
from gearcam.parts.make import make_part
from gearcam.parts.openings import Workpiece
from gearcam.pictures.drawings import cut_drawing, wheel_drawing
from helpers_contour import contour_of, disc_contour, line
from helpers_files import ROLLER, read
from helpers_pairs import PROFILES, profile
from helpers_sampling import few
from witness.distance import distances

TOLERANCE = 0.005
KERF = 0.2

ORDER = Blank(
    bore_diameter=(6.0, 8.0), keyway_width=(2.0, 0.0), keyway_depth=(1.0, 0.0),
    bore_flat=(0.0, 7.0), bolts=(2, 0), bolt_circle=(12.0, 0.0), bolt_diameter=(2.0, 0.0),
    density=(1000.0, 1000.0),
)  # fmt: skip


@cache
def job(kerf: float = 0.0, **sizes: Any) -> GearPairResult:
    output = PairOutputSpec(files=("dxf",), chord_tolerance=TOLERANCE, kerf=kerf)
    design = profile("ellipse").design
    pair = replace(design.pair, module=1.5, teeth=(19, 19))
    blank = replace(ORDER, **sizes)
    return GearPairResult(replace(design, pair=pair, output=output, blank=blank))


@cache
def files(kind: str, kerf: float = 0.0, **sizes: Any) -> dict[str, bytes]:
    extras: dict[str, Any] = {}
    made = job(kerf, **sizes).files(kind, extras)
    if kind == "dxf":
        assert max(extras["accuracy"]["dxf_mm"].values()) <= TOLERANCE
    return made


def arc(start: complex, end: complex, bulge: float) -> np.ndarray:
    """Points of an arc that turns by 4*atan(bulge), its end left out."""
    half = 2 * math.atan(bulge)
    if half == 0.0:
        return np.array([start])
    center = start + (end - start) / 2 * (1 + 1j / math.tan(half))
    count = math.ceil(abs(2 * half) * math.sqrt(abs(start - center) / 8e-4)) + 1  # within 1e-4
    return center + (start - center) * np.exp(2j * half * np.arange(count) / count)


def regions(data: bytes) -> dict[str, list[shapely.Polygon]]:
    """What each layer encloses, as ezdxf reads it, arcs by chords within 1e-4 mm."""
    found: dict[str, list[shapely.Polygon]] = {}
    for entity in read_dxf(data).modelspace():
        here = found.setdefault(entity.dxf.layer, [])
        if isinstance(entity, DxfCircle):
            x, y, _ = entity.dxf.center
            here.append(shapely.Point(x, y).buffer(entity.dxf.radius, quad_segs=512))
        elif isinstance(entity, LWPolyline) and entity.closed:
            rows = [(complex(x, y), b) for x, y, b in entity.get_points("xyb")]
            ends = [place for place, _ in rows[1:] + rows[:1]]
            arcs = [arc(a, z, b) for (a, b), z in zip(rows, ends, strict=True)]
            here.append(shapely.Polygon([(z.real, z.imag) for z in np.concatenate(arcs)]))
    return found


@pytest.mark.parametrize("kind", ["stl", "svg", "csv", "inspection"])
def test_the_kerf_changes_no_file_of_the_part(kind: str) -> None:
    assert files(kind, KERF) == files(kind)


def test_drawings_say_only_that_the_file_of_the_outline_is_that_of_a_cut() -> None:
    for plain, cut in zip(job().sheets, job(KERF).sheets, strict=True):
        assert cut.rows == plain.rows
        assert [one.label for one in cut.dimensions] == [one.label for one in plain.dimensions]
        moved = "moved by half the kerf" in " ".join(text.text for text in cut.texts)
        assert moved == (plain.name != "pair")


def test_the_pair_is_drawn_as_it_is_whatever_the_kerf() -> None:
    plain, cut = files("dxf"), files("dxf", KERF)
    assert cut["pair.dxf"] == plain["pair.dxf"]
    assert cut["gear1.dxf"] != plain["gear1.dxf"]
    assert cut["gear2.dxf"] != plain["gear2.dxf"]


def test_what_is_said_of_the_part_is_the_same_but_for_the_kerf() -> None:
    plain, cut = job().facts.document, job(KERF).facts.document
    assert cut.pop("kerf_mm") == KERF
    assert cut == plain
    assert all("mass" in gear for gear in plain["gears"])


@pytest.mark.parametrize("name", few(["gear1", "gear2"]))
def test_paths_keep_half_the_kerf_from_the_edges(name: str) -> None:
    """Against shapely's buffer of the file without a kerf: outlines larger, openings smaller."""
    plain = regions(files("dxf")[f"{name}.dxf"])
    cut = regions(files("dxf", KERF)[f"{name}.dxf"])
    kinds = {"OUTLINE": 0.5 * KERF, "BORE": -0.5 * KERF, "HOLE": -0.5 * KERF}
    wanted = {f"{kind}_KERF" for kind in kinds if kind in plain} | ({"MARK"} & set(plain))
    assert set(cut) == wanted
    for kind, by in kinds.items():
        edges, paths = plain.get(kind, []), cut.get(f"{kind}_KERF", [])
        assert len(edges) == len(paths)
        for edge, path in zip(edges, paths, strict=True):
            moved = edge.buffer(by, quad_segs=64)
            for one, other in ((path, moved), (moved, path)):
                points = shapely.get_coordinates(one)
                assert distances(points, other.boundary).max() < 3 * TOLERANCE
            assert path.symmetric_difference(moved).area < TOLERANCE * path.length
    for edge, same in zip(plain.get("MARK", []), cut.get("MARK", []), strict=True):
        assert same.equals(edge)


def test_holes_are_narrower_by_the_kerf_to_the_last_digit() -> None:
    radii = [
        [one.dxf.radius for one in read_dxf(data).modelspace() if one.dxf.layer.startswith("HOLE")]
        for data in (files("dxf")["gear1.dxf"], files("dxf", KERF)["gear1.dxf"])
    ]
    assert radii[0] == pytest.approx([1.0, 1.0], abs=1e-15)
    assert radii[1] == pytest.approx([0.9, 0.9], abs=1e-15)


@pytest.mark.parametrize("curves", few(["splines", "lines"]))
def test_paths_are_measured_however_they_are_drawn(curves: str) -> None:
    made = job(KERF)
    output = replace(made.design.output, dxf_curves=curves)
    other = GearPairResult(replace(made.design, output=output))
    extras: dict[str, Any] = {}
    data = other.files("dxf", extras)["gear1.dxf"]
    assert 0.05 * TOLERANCE < extras["accuracy"]["dxf_mm"]["gear1.dxf"] <= TOLERANCE
    layers = {entity.dxf.layer for entity in read_dxf(data).modelspace()}
    assert layers == {"OUTLINE_KERF", "BORE_KERF", "HOLE_KERF", "MARK"}


def cam(kerf: float = 0.0, clearance: float = 0.0, **blank: Any) -> CamResult:
    design = read(ROLLER)
    return CamResult(
        replace(
            design,
            output=replace(design.output, kerf=kerf),
            blank=WheelBlank(clearance=clearance, **blank),
        )
    )


def test_a_cam_s_path_has_the_area_that_steiner_says() -> None:
    """A parallel at d of a closed curve: A + L*d + pi*d^2, A and L by quadrature."""
    made, d = cam(kerf=0.3), 0.15
    ((path,),) = (regions(made.files("dxf", {})["cam.dxf"])["PROFILE_KERF"],)
    size = made.cam.walls[0].size
    wanted = size.area + size.perimeter * d + math.pi * d**2
    assert path.area == pytest.approx(wanted, abs=size.perimeter * 1e-3)
    (true, *_) = cut_drawing(wheel_drawing(made.part), 0.3).contours
    assert true.moments.area == pytest.approx(wanted, rel=1e-9)
    assert abs(path.area - size.area) > 20.0
    assert made.files("csv", {}) == cam().files("csv", {})
    assert made.files("stl", {}) == cam().files("stl", {})


KERFED = {
    "disc": (PROFILES / "eccentric_cam.toml", {"cam"}),
    "conjugate": (PROFILES / "conjugate_cams.toml", {"cam1", "cam2"}),
    "yoke": (PROFILES / "yoke_cam.toml", {"cam"}),
}
SHOWN = {"PITCH", "PRIME", "CENTER"}


@pytest.mark.parametrize("name", KERFED)
def test_a_cam_s_file_to_be_cut_holds_cuts_alone_and_another_one_the_part(name: str) -> None:
    path, stems = KERFED[name]
    plain = load(path).with_({"output.kerf_mm": 0.0})
    cut = plain.with_({"output.kerf_mm": 0.2})
    before, after = gearcam.build(plain).files("dxf"), gearcam.build(cut).files("dxf")
    assert set(before) == {f"{stem}.dxf" for stem in stems}
    assert set(after) == set(before) | {f"{stem}_reference.dxf" for stem in stems}
    for stem in stems:
        layers = {one.dxf.layer for one in read_dxf(after[f"{stem}.dxf"]).modelspace()}
        assert layers
        assert all(layer.endswith("_KERF") for layer in layers)
        # without a kerf the same curves are there as ever, and the reference is that file
        assert {one.dxf.layer for one in read_dxf(before[f"{stem}.dxf"]).modelspace()} & SHOWN
        assert after[f"{stem}_reference.dxf"] == before[f"{stem}.dxf"]


def test_clearance_makes_another_part() -> None:
    """Volume and profile of a cam by Steiner's formula; every file follows."""
    made, c = cam(clearance=0.25), 0.25
    size, width = made.cam.walls[0].size, made.design.cam.thickness
    area = size.area - size.perimeter * c + math.pi * c**2
    mesh = trimesh.load(io.BytesIO(made.files("stl", {})["cam.stl"]), file_type="stl")
    assert isinstance(mesh, trimesh.Trimesh)
    assert mesh.volume == pytest.approx(area * width, abs=size.perimeter * width * 2e-3)
    found = made.facts.document["cam"]["profile"]
    assert found["area_mm2"] == pytest.approx(area, rel=1e-9)
    assert found["clearance_mm"] == c
    assert "perimeter_mm" not in found
    rows = made.files("csv", {})["profile.csv"].decode().splitlines()[1:]
    ring = shapely.Polygon([tuple(map(float, row.split(","))) for row in rows])
    assert ring.area == pytest.approx(area, abs=size.perimeter * 1e-3)
    ((drawn,),) = (regions(made.files("dxf", {})["cam.dxf"])["PROFILE"],)
    assert drawn.area == pytest.approx(area, abs=size.perimeter * 1e-3)
    points = np.genfromtxt(
        io.BytesIO(made.files("inspection", {})["inspection.csv"]), delimiter=",", names=True
    )
    away = shapely.distance(drawn.boundary, shapely.points(points["x_mm"], points["y_mm"]))
    assert len(points) == made.design.output.inspection_points
    assert away.max() < 2e-3


def test_clearance_is_in_all_that_is_said_of_a_wheel() -> None:
    plain, clear = (
        job().facts.document["gears"][0],
        job(0.0, clearance=(0.1, 0.0)).facts.document["gears"][0],
    )
    other = job(0.0, clearance=(0.1, 0.0)).facts.document["gears"][1]
    assert clear["clearance_mm"] == 0.1
    assert plain["root_radius_min_mm"] - clear["root_radius_min_mm"] == pytest.approx(0.1, abs=5e-3)
    ring = job().gear1.profile.contour.polygon.buffer(-0.1)
    assert clear["outline"]["area_mm2"] == pytest.approx(ring.area, abs=TOLERANCE * ring.length)
    assert clear["mass"]["mass_kg"] < plain["mass"]["mass_kg"] - 1e-5
    # tips of the same height over the pitch curve less the clearance, which flanks also lose
    assert clear["tip_thickness_min_mm"] < plain["tip_thickness_min_mm"] - 0.1
    assert other["tip_thickness_min_mm"] == pytest.approx(plain["tip_thickness_min_mm"], rel=1e-9)
    outlines = [files("csv", 0.0, **sizes) for sizes in ({}, {"clearance": (0.1, 0.0)})]
    assert outlines[0]["gear1_outline.csv"] != outlines[1]["gear1_outline.csv"]
    assert outlines[0]["gear2_outline.csv"] == outlines[1]["gear2_outline.csv"]


def test_a_path_is_no_profile_to_follow() -> None:
    data = cam(kerf=0.3).files("dxf", {})["cam.dxf"]
    with pytest.raises(DxfError, match="PROFILE_KERF holds the path of a cutter"):
        read_outline(data)
    assert len(read_outline(cam().files("dxf", {})["cam.dxf"])[0]) > 10


def part(**sizes: Any) -> Part:
    place = Workpiece(name="wheel 1", wheel=1, rim=5.4, travel=1.5)
    return make_part("g", [disc_contour(50.0)], 5.0, WheelBlank(timing_marks=False, **sizes), place)


@pytest.mark.parametrize(
    ("sizes", "closed"),
    [
        ({"bore_diameter": 8.0}, 8.0),
        ({"bolts": 2, "bolt_circle": 40.0, "bolt_diameter": 4.0}, 4.0),
        pytest.param({"stop_pin": 5.0}, 5.0, marks=pytest.mark.slow),
        ({"bore_diameter": 20.0, "keyway_width": 6.0, "keyway_depth": 8.0}, 6.0),
        ({"bore_diameter": 20.0, "bore_flat": 17.0}, 17.0),
    ],
    ids=["bore", "bolts", "slot", "keyway", "flat"],
)
def test_a_kerf_that_leaves_nothing_of_an_opening_is_refused(
    sizes: dict[str, Any], closed: float
) -> None:
    """Of a keyway its walls, of a D-bore its flat: as wide as they are, no more."""
    drawing = wheel_drawing(part(**sizes))
    assert len(cut_drawing(drawing, 0.98 * closed).features) == len(drawing.features)
    with pytest.raises(InfeasibleError) as caught:
        cut_drawing(drawing, 1.002 * closed)
    assert "g, output.kerf_mm" in caught.value.where
    words = caught.value.nearest.replace("a kerf below", "").replace("a kerf of", "").split()
    assert 0.98 * closed < float(words[0]) <= closed
    cut_drawing(drawing, 0.999999 * float(words[0]))


@pytest.mark.parametrize("kerf", [7e-9, 0.99 * LEAST_ALLOWANCE])
def test_a_kerf_is_none_or_that_of_a_machine(kerf: float) -> None:
    text = (PROFILES / "ellipse.toml").read_text("utf-8")
    for good in (0.0, LEAST_ALLOWANCE):
        assert loads(text.replace("[output]", f"[output]\nkerf_mm = {good}")).output.kerf == good
    with pytest.raises(DesignError, match=r"too small(.|\n)*0 or a number from 1e-06"):
        loads(text.replace("[output]", f"[output]\nkerf_mm = {kerf}"))


def test_a_chamber_whose_mouth_the_kerf_closes_is_refused_with_a_kerf_that_does_not() -> None:
    """A square of 20 mm with a chamber of 8 mm behind a mouth of 1 mm."""
    corners = [0, 9.5, 9.5 + 6j, 6 + 6j, 6 + 14j, 14 + 14j, 14 + 6j, 10.5 + 6j, 10.5, 20, 20 + 20j,
               20j]  # fmt: skip
    pieces = [line(a, b) for a, b in zip(corners, corners[1:] + corners[:1], strict=True)]
    plain, place = WheelBlank(timing_marks=False), Workpiece(name="wheel 1", wheel=1, rim=2.7)
    made = make_part("g", [contour_of(pieces, 1e-3)], 5.0, plain, place)
    with pytest.raises(InfeasibleError, match="this kerf leaves no simple outline") as caught:
        cut_drawing(wheel_drawing(made), 1.2)
    named = float(caught.value.nearest.split()[3])
    assert 0.98 < named <= 1.0
    (path,) = cut_drawing(wheel_drawing(made), named).contours
    assert path.area > 400.0 - 70.0


def test_flanks_that_a_kerf_leaves_uncut_are_an_error() -> None:
    """Spaces of module 1.5 are 2.36 mm wide at the pitch curve: 2.6 mm do not get in."""
    levels = {}
    for kerf in (0.1, 1.6, 2.6):
        found = [one for one in job(kerf).findings if one.code == "wide-kerf"]
        levels[kerf] = {one.severity for one in found}
    assert levels == {0.1: set(), 1.6: {"warning"}, 2.6: {"error"}}
