"""Files of internal pairs, read back by readers that know nothing of the program."""

from __future__ import annotations

import io
import math
from collections import Counter
from importlib.util import find_spec
from typing import Any
from xml.etree import ElementTree as ET

import numpy as np
import pytest
import shapely
import trimesh
from ezdxf import filemanagement
from ezdxf import path as ezpath

from gearcam.export.step import step_bytes
from gearcam.gears.spec import RingSpec, StepsSpec
from gearcam.kinds.gear_pair.design import PairOutputSpec
from gearcam.kinds.gear_pair.result import GearPairResult
from gearcam.kinds.gear_pair.shown import FILES
from gearcam.numeric.arrays import as_pairs
from gearcam.numeric.pose import UNMOVED
from gearcam.parts.blank import Blank
from helpers_rings import WAIST, ring_job, turned
from helpers_sampling import few

BOLTS: dict[str, Any] = {
    "bolts": (0, 5), "bolt_diameter": (0, 3), "bolt_circle": (0, 120), "bolt_angle": (0.0, 0.3),
}  # fmt: skip
POSE = 1.0


@pytest.fixture(scope="module")
def made() -> GearPairResult:
    """A ring that is not symmetric, with a round outside, bolts and marks, drawn at 1 rad."""
    return ring_job(
        ring=RingSpec(outer_diameter=130.0),
        blank=Blank(bore_diameter=(10.0, 0.0), **BOLTS),
        output=PairOutputSpec(pose=POSE),
    )


@pytest.fixture(scope="module")
def waist() -> GearPairResult:
    """A ring in two steps whose outside follows its roots, with play, moved teeth and edges."""
    return ring_job(
        WAIST,
        {"teeth": (24, 48), "x": 0.2, "backlash": 0.1},
        ring=RingSpec(outer="follow", rim=7.0),
        blank=Blank(clearance=(0.05, 0.08), tip_rounding=(0.2, 0.3)),
        steps=StepsSpec(count=2),
        output=PairOutputSpec(pose=-2.0, chord_tolerance=2e-3),
    )


def files(made: GearPairResult, kind: str) -> dict[str, bytes]:
    return FILES[kind](made, {})


def dxf(data: bytes) -> Any:
    return filemanagement.read(io.StringIO(data.decode())).modelspace()


def outline(entity: Any) -> shapely.Polygon:
    """The area inside a closed entity, flattened by ezdxf."""
    points = [(p.x, p.y) for p in ezpath.make_path(entity).flattening(1e-4)]
    return shapely.Polygon(points)


def by_layer(data: bytes) -> dict[str, list[Any]]:
    found: dict[str, list[Any]] = {}
    for entity in dxf(data):
        found.setdefault(entity.dxf.layer, []).append(entity)
    return found


def test_a_ring_in_dxf_has_its_teeth_inside_and_a_circle_outside(made: GearPairResult) -> None:
    layers = by_layer(files(made, "dxf")["gear2.dxf"])
    count = {name: len(entities) for name, entities in layers.items()}
    assert count == {"OUTLINE": 1, "INNER": 1, "HOLE": 5, "MARK": 1}
    (outside,), (teeth,) = layers["OUTLINE"], layers["INNER"]
    assert (outside.dxftype(), outside.dxf.radius) == ("CIRCLE", 65.0)
    assert teeth.closed
    hole = outline(teeth)
    assert hole.exterior.is_ccw
    edge = shapely.Polygon(made.gear2.outline)
    assert hole.area == pytest.approx(edge.area, abs=1e-3 * edge.length)
    holes = [outline(entity) for entity in layers["HOLE"]]
    metal = outline(outside).difference(hole)
    assert all(metal.contains(one) for one in holes)
    (mark,) = layers["MARK"]
    x, y, _ = mark.dxf.center
    assert y == pytest.approx(0.0, abs=1e-12)
    assert metal.contains(shapely.Point(x, 0.0).buffer(mark.dxf.radius))


@pytest.mark.parametrize("name", few(["made", "waist"]))
def test_the_assembled_pair_meshes_in_dxf(name: str, request: pytest.FixtureRequest) -> None:
    """At any angle the wheel lies in the hole and touches it; turned otherwise it does not."""
    result: GearPairResult = request.getfixturevalue(name)
    layers = by_layer(files(result, "dxf")["pair.dxf"])
    wheel, hole = outline(layers["GEAR1_OUTLINE"][0]), outline(layers["GEAR2_INNER"][0])
    assert wheel.difference(hole).area < 1e-3
    gap = result.design.pair.backlash + sum(result.design.blank.clearance)
    assert wheel.boundary.distance(hole.boundary) < 1e-3 + gap
    shaft = -result.pair.center_distance
    other = shapely.affinity.rotate(hole, 2.0, origin=(shaft, 0.0))
    assert wheel.difference(other).area > 0.5


def phi2(result: GearPairResult) -> float:
    """The driven angle by quadrature of the law's ratio: Gauss on 32 panels."""
    nodes, weights = np.polynomial.legendre.leggauss(20)
    ends = np.linspace(0.0, result.design.output.pose, 33)
    half = 0.5 * np.diff(ends)
    phi = ends[:-1, None] + half[:, None] * (1.0 + nodes)
    ratio = result.law.derivatives(phi.ravel(), 1)[1].reshape(phi.shape)
    return float(half @ ratio @ weights)


def test_csv_holds_the_edge_of_the_hole(made: GearPairResult) -> None:
    data = files(made, "csv")["gear2_outline.csv"].decode().splitlines()
    points = np.array([[float(cell) for cell in row.split(",")] for row in data[1:]])
    assert points.shape == made.gear2.outline.shape
    assert shapely.LinearRing(points).is_ccw
    ring = turned(points, -phi2(made), -made.pair.center_distance)
    wheel = turned(made.gear1.outline, -POSE, 0.0)
    assert wheel.difference(ring).area < 1e-3


@pytest.mark.parametrize(
    ("name", "kind"),
    [
        ("made", "stl"),
        pytest.param("made", "3mf", marks=pytest.mark.slow),
        pytest.param("made", "glb", marks=pytest.mark.slow),
        ("waist", "stl"),
        pytest.param("waist", "3mf", marks=pytest.mark.slow),
        pytest.param("waist", "glb", marks=pytest.mark.slow),
    ],
)
def test_solids_of_rings_are_closed_and_hollow(
    name: str, kind: str, request: pytest.FixtureRequest
) -> None:
    result: GearPairResult = request.getfixturevalue(name)
    found = files(result, kind)
    part, width = result.parts[1], result.design.pair.face_width
    mesh: Any = trimesh.load(io.BytesIO(found["gear2." + kind]), file_type=kind, force="mesh")
    mesh.merge_vertices()
    assert mesh.is_watertight
    assert mesh.euler_number == 2 - 2 * (1 + len(part.openings))
    outer = [shapely.Polygon(as_pairs(edge.polyline(1e-4))).area for edge in part.contours]
    holes = [shapely.Polygon(gears[1].outline).area for gears in result.steps]
    area = float(np.mean(outer) - np.mean(holes)) - len(part.openings) * math.pi * 1.5**2
    (mark,) = part.marks
    volume = width * area - mark.depth * math.pi * (0.5 * mark.diameter) ** 2
    assert mesh.volume == pytest.approx(volume, rel=2e-4)
    pair: Any = trimesh.load(io.BytesIO(found["pair." + kind]), file_type=kind, force="mesh")
    pair.merge_vertices()
    low, high = pair.bounds
    if name == "made":
        assert 0.5 * (low + high)[0] == pytest.approx(-result.pair.center_distance, abs=2e-3)
        wheel: Any = trimesh.load(io.BytesIO(found["gear1." + kind]), file_type=kind, force="mesh")
        assert pair.volume == pytest.approx(wheel.volume + mesh.volume, rel=1e-6)


def test_inspection_points_look_to_the_shaft(waist: GearPairResult) -> None:
    """They lie on the edge; out along the normal there is no metal, against it there is."""
    lines = files(waist, "inspection")["inspection.csv"].decode().splitlines()
    names = lines[0].split(",")
    rows = np.array([[float(cell) for cell in line.split(",")] for line in lines[1:]])
    at = {name: rows[:, k] for k, name in enumerate(names)}
    for step in (1, 2):
        here = (at["wheel"] == 2) & (at["step"] == step)
        assert here.sum() == 2 * 48 * 9
        metal = shapely.Polygon(
            as_pairs(waist.parts[1].contours[0].polyline(1e-3)), [waist.steps[step - 1][1].outline]
        )
        points = np.column_stack([at["x_mm"], at["y_mm"]])[here]
        normals = np.column_stack([at["nx"], at["ny"]])[here]
        away = shapely.distance(shapely.points(points), metal.boundary)
        assert away.max() < 2e-3
        inner = np.tile(np.arange(9) % 9, here.sum() // 9)
        middle = (inner > 0) & (inner < 8)  # at its ends a flank meets other curves
        for side, expected in ((0.02, False), (-0.02, True)):
            moved = shapely.points(points[middle] + side * normals[middle])
            assert (shapely.contains(metal, moved) == expected).all()


def test_a_cutter_burns_only_waste(made: GearPairResult) -> None:
    """The path of the teeth lies within the hole and that of the outside around it."""
    kerf = 0.3
    other = ring_job(
        ring=made.design.ring,
        blank=made.design.blank,
        output=PairOutputSpec(kerf=kerf, chord_tolerance=2e-3),
    )
    layers = by_layer(files(other, "dxf")["gear2.dxf"])
    assert set(layers) == {"OUTLINE_KERF", "INNER_KERF", "HOLE_KERF", "MARK"}
    assert layers["OUTLINE_KERF"][0].dxf.radius == pytest.approx(65.0 + 0.5 * kerf, rel=1e-14)
    assert layers["HOLE_KERF"][0].dxf.radius == pytest.approx(1.5 - 0.5 * kerf, rel=1e-14)
    path, hole = outline(layers["INNER_KERF"][0]), shapely.Polygon(made.gear2.outline)
    assert hole.contains(path)
    away = shapely.distance(shapely.points(np.array(path.exterior.coords)), hole.boundary)
    assert away == pytest.approx(np.full(away.shape, 0.5 * kerf), abs=6e-3)
    sheet = ET.fromstring(files(other, "cut-svg")["gear2_cut.svg"])
    assert [g.get("id") for g in sheet if g.get("id")] == ["engrave", "cut-inner", "cut-outer"]


def test_in_a_picture_the_wheel_lies_on_top_of_its_ring(made: GearPairResult) -> None:
    picture = ET.fromstring(files(made, "svg")["pair.svg"])
    order = [element.get("class") for element in picture.iter() if element.get("class")]
    assert order.index("gear2-outline") < order.index("gear2-inner") < order.index("gear1-outline")


def text_of(data: bytes) -> list[str]:
    return [element.text or "" for element in ET.fromstring(data).iter() if element.text]


def test_the_sheet_of_a_ring_tells_its_outside_and_its_teeth(made: GearPairResult) -> None:
    words = text_of(files(made, "drawing-svg")["gear2_drawing.svg"])
    reach = np.hypot(*made.gear2.outline.T)
    assert "Ø130" in words
    for radius, which in ((reach.max(), "max"), (reach.min(), "min")):
        (told,) = [word for word in words if word.startswith("(R") and word.endswith(f"{which})")]
        assert float(told[2:].split()[0]) == pytest.approx(radius, abs=2e-3)
    assert any(word.startswith("5 x Ø3") for word in words)


def test_the_sheet_of_an_internal_pair_has_its_centre_distance(made: GearPairResult) -> None:
    words = text_of(files(made, "drawing-svg")["pair_drawing.svg"])
    assert f"{made.pair.center_distance:.3f}".rstrip("0") in words
    # r1 at 1 rad, by A*i/(1 - i)
    i = float(made.law.derivatives(np.array(POSE), 1)[1])
    radius = f"{made.pair.center_distance * i / (1.0 - i):.3f}".rstrip("0")
    assert f"({radius})" in words
    assert {"gear1", "gear2", "pitch point"} <= set(words)


@pytest.mark.slow
@pytest.mark.skipif(find_spec("OCP") is None, reason="needs the extra for STEP files")
def test_rings_are_exact_step_solids() -> None:
    from helpers_step import read_step

    made = ring_job(
        pair={"teeth": (12, 24)},
        ring=RingSpec(outer_diameter=70.0),
        blank=Blank(bolts=(0, 3), bolt_diameter=(0, 2), bolt_circle=(0, 64), timing_marks=False),
        output=PairOutputSpec(pose=POSE, chord_tolerance=5e-3),
    )
    found = files(made, "step")
    (ring,) = read_step(found["gear2.step"])
    assert ring.volume == pytest.approx(made.parts[1].volume, rel=1e-6)
    assert ring.faces["cylinder"] == 1 + 3
    assert ring.bounds[1][0] == pytest.approx(35.0, abs=1e-6)
    one, two = read_step(found["pair.step"])
    assert [one.name, two.name] == ["gear1", "gear2"]
    assert one.volume == pytest.approx(made.parts[0].volume, rel=1e-6)
    middle = 0.5 * (np.array(two.bounds[0]) + two.bounds[1])
    assert middle[:2] == pytest.approx([-made.pair.center_distance, 0.0], abs=1e-6)


@pytest.mark.skipif(find_spec("OCP") is None, reason="needs the extra for STEP files")
@pytest.mark.slow
def test_a_ring_that_follows_its_roots_is_a_step_solid() -> None:
    from helpers_step import read_step

    made = ring_job(
        pair={"teeth": (12, 24)},
        ring=RingSpec(outer="follow"),
        blank=Blank(timing_marks=False),
        steps=StepsSpec(count=2),
        output=PairOutputSpec(chord_tolerance=5e-3),
    )
    part = made.parts[1]
    solids = read_step(step_bytes([(part, UNMOVED)], "ring", 2e-6))
    assert len(solids) == 2
    assert sum(solid.volume for solid in solids) == pytest.approx(part.volume, rel=1e-6)


def test_the_mass_of_a_ring_is_that_of_its_metal() -> None:
    """Moments of polygons with a hole, by shapely; the asymmetric ring has its centroid off."""
    result = ring_job(
        ring=RingSpec(outer_diameter=130.0),
        blank=Blank(density=(7800.0, 7800.0), timing_marks=False),
        output=PairOutputSpec(chord_tolerance=1e-4),
    )
    told = result.facts.document["gears"][1]
    circle = shapely.Point(0.0, 0.0).buffer(65.0, quad_segs=2000)
    metal = shapely.Polygon(circle.exterior, [result.gear2.outline])
    assert told["part"]["area_mm2"] == pytest.approx(metal.area, rel=1e-5)
    assert told["mass"]["mass_kg"] == pytest.approx(metal.area * 10.0 * 7.8e-6, rel=1e-5)
    assert told["mass"]["centroid_mm"][:2] == pytest.approx(
        [metal.centroid.x, metal.centroid.y], abs=1e-4
    )
    assert Counter(one["kind"] for one in told.get("openings", ())) == {}
