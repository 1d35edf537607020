"""Mesh files, read by small readers of their own, are closed and hold the part's volume, in mm."""

from __future__ import annotations

import importlib
import io
import json
import math
import struct
import zipfile
from collections import Counter
from collections.abc import Callable, Mapping
from typing import Any

import numpy as np
import pytest

from gearcam.export.mesh import glb_bytes, stl_bytes, threemf_bytes
from gearcam.numeric.contour import Contour
from gearcam.numeric.mesh import Mesh
from gearcam.parts import solids
from gearcam.parts.body import Mark, Part
from gearcam.parts.marks import timing_mark
from gearcam.parts.solids import SolidError, solid, volume_error
from helpers_contour import bore, gear_contour, square_contour

etree: Any = importlib.import_module("lxml.etree")

Corners = list[list[tuple[float, ...]]]
"""Triangles as three corners each: what a file holds when nothing is assumed."""


def read_stl(data: bytes) -> tuple[str, Corners]:
    (count,) = struct.unpack_from("<I", data, 80)
    assert len(data) == 84 + 50 * count
    assert not data.startswith(b"solid")
    corners = [
        [struct.unpack_from("<3f", data, 84 + 50 * k + 12 * j) for j in (1, 2, 3)]
        for k in range(count)
    ]
    return data[:80].rstrip(b"\0").decode(), corners


def read_3mf(data: bytes) -> tuple[str, Corners]:
    with zipfile.ZipFile(io.BytesIO(data)) as archive:
        assert archive.testzip() is None
        relations = etree.fromstring(archive.read("_rels/.rels"))
        target = relations[0].get("Target").lstrip("/")
        model = etree.fromstring(archive.read(target))
    space = {"c": "http://schemas.microsoft.com/3dmanufacturing/core/2015/02"}
    assert model.get("unit") == "millimeter"
    (item,) = model.findall("c:build/c:item", space)
    (found,) = [
        o for o in model.iterfind(".//c:object", space) if o.get("id") == item.get("objectid")
    ]
    numbers = [float(v) for v in item.get("transform", "1 0 0 0 1 0 0 0 1 0 0 0").split()]
    assert numbers == [1, 0, 0, 0, 1, 0, 0, 0, 1, 0, 0, 0]
    places = [
        (float(v.get("x")), float(v.get("y")), float(v.get("z")))
        for v in found.iterfind("c:mesh/c:vertices/c:vertex", space)
    ]
    triangles = found.iterfind("c:mesh/c:triangles/c:triangle", space)
    return found.get("name"), [
        [places[int(t.get(k))] for k in ("v1", "v2", "v3")] for t in triangles
    ]


def read_glb(data: bytes) -> tuple[str, Corners]:
    magic, version, length = struct.unpack_from("<III", data, 0)
    assert (magic, version, length) == (0x46546C67, 2, len(data))
    size, kind = struct.unpack_from("<II", data, 12)
    assert kind == 0x4E4F534A
    tree = json.loads(data[20 : 20 + size])
    binary = data[28 + size :]
    (body,) = tree["meshes"]
    assert tree["scenes"][0]["extras"]["units"] == "mm"
    assert all("matrix" not in node and "scale" not in node for node in tree["nodes"])

    def values(index: int) -> list[tuple[float, ...]]:
        accessor = tree["accessors"][index]
        view = tree["bufferViews"][accessor["bufferView"]]
        code = {5126: "f", 5125: "I", 5123: "H"}[accessor["componentType"]]
        width = {"SCALAR": 1, "VEC3": 3}[accessor["type"]]
        start = view.get("byteOffset", 0) + accessor.get("byteOffset", 0)
        pattern = f"<{accessor['count'] * width}{code}"
        flat: tuple[float, ...] = struct.unpack_from(pattern, binary, start)
        return [flat[k : k + width] for k in range(0, len(flat), width)]

    (primitive,) = body["primitives"]
    assert primitive.get("mode", 4) == 4
    places, index = values(primitive["attributes"]["POSITION"]), values(primitive["indices"])
    named = [node["name"] for node in tree["nodes"] if "mesh" in node]
    assert named == [body["name"]]
    corners = [[places[int(index[k + j][0])] for j in range(3)] for k in range(0, len(index), 3)]
    return body["name"], corners


FORMATS: dict[
    str, tuple[Callable[[Mapping[str, Mesh], str], bytes], Callable[[bytes], tuple[str, Corners]]]
] = {
    "stl": (stl_bytes, read_stl),
    "3mf": (threemf_bytes, read_3mf),
    "glb": (glb_bytes, read_glb),
}


def closed(corners: Corners) -> bool:
    """Each edge once in each direction; corners are the same where their numbers are."""
    edges = Counter((t[k], t[(k + 1) % 3]) for t in corners for k in range(3))
    return all(count == 1 and edges[b, a] == 1 for (a, b), count in edges.items())


def volume(corners: Corners) -> float:
    points = np.array(corners)
    points = points - points.mean(axis=(0, 1))
    return float(np.linalg.det(points).sum() / 6)


@pytest.fixture(scope="module")
def part() -> Part:
    contour = gear_contour(36, 5.0)
    mark = timing_mark(80.0, 0.0, 5.0, 6.25, 50.0, bore_reach=20.0)
    return Part(name="gear1", contours=(contour,), openings=bore(40.0), width=50.0, marks=(mark,))


@pytest.fixture(scope="module")
def mesh(part: Part) -> Mesh:
    return solid(part)


@pytest.mark.parametrize("kind", FORMATS)
def test_a_file_is_closed_named_and_holds_area_times_width(
    kind: str, part: Part, mesh: Mesh
) -> None:
    write, read = FORMATS[kind]
    name, corners = read(write({"gear1": mesh}, "gear1"))
    assert name == ("gearcam gear1 (mm)" if kind == "stl" else "gear1")
    assert closed(corners)
    # Single precision moves a vertex by up to 2^-24 of its size: far below the chords.
    assert volume(corners) == pytest.approx(part.volume, abs=volume_error(part))
    assert volume_error(part) < 2e-4 * part.volume
    box = np.array(corners).reshape(-1, 3)
    outline = part.contour.vertices
    assert box.min(axis=0) == pytest.approx([*outline.min(axis=0), 0.0], abs=1e-5)
    assert box.max(axis=0) == pytest.approx([*outline.max(axis=0), 50.0], abs=1e-5)


@pytest.mark.parametrize("kind", FORMATS)
def test_the_same_mesh_gives_the_same_bytes(kind: str, mesh: Mesh) -> None:
    write, _ = FORMATS[kind]
    assert write({"gear1": mesh}, "gear1") == write({"gear1": mesh}, "gear1")


@pytest.mark.parametrize("kind", FORMATS)
@pytest.mark.parametrize("fault", ["inside out", "hole", "cracked"])
def test_a_broken_mesh_is_refused(kind: str, fault: str, mesh: Mesh) -> None:
    vertices, triangles = mesh.vertices, mesh.triangles
    if fault == "inside out":
        triangles = triangles[:, ::-1]
    elif fault == "hole":
        triangles = triangles[1:]
    else:
        vertices = np.vstack([vertices, vertices[triangles[0, 0]]])
        triangles = triangles.copy()
        triangles[0, 0] = len(vertices) - 1
    with pytest.raises(SolidError, match="not closed"):
        FORMATS[kind][0]({"gear1": Mesh(vertices=vertices, triangles=triangles)}, "gear1")


@pytest.mark.parametrize("triangles", [np.zeros((0, 3), int), np.array([[0, 0, 1]])])
def test_nothing_and_folded_triangles_are_not_closed(triangles: np.ndarray) -> None:
    assert not Mesh(vertices=np.eye(3), triangles=triangles).watertight


@pytest.mark.parametrize("kind", ["stl", "glb"])
def test_vertices_that_fall_together_in_single_precision_stay_closed(kind: str) -> None:
    """A square with a corner cut at 1e-7 mm: two vertices become one."""
    plain = square_contour(200.0)
    corner = plain.points[0]
    points = np.append([corner - 1e-7j, corner - 1e-7], plain.points[1:])
    contour = Contour(dense=plain.dense, points=points, tolerance=1e-3, chord_error=1e-7)
    made = solid(Part(name="plate", contours=(contour,), width=10.0))
    assert len(made.vertices) == 10
    write, read = FORMATS[kind]
    corners = read(write({"plate": made}, "plate"))[1]
    assert len({place for triangle in corners for place in triangle}) == 8
    assert closed(corners)
    assert volume(corners) == pytest.approx(4e5, rel=1e-6)


def test_the_mark_is_blind_and_in_the_upper_face() -> None:
    mark = Mark(center=complex(10.0, 0.0), diameter=3.0, depth=0.5)
    plate = Part(
        name="p", contours=(square_contour(40.0),), openings=bore(8.0), width=6.0, marks=(mark,)
    )
    made = solid(plate)
    floor = made.vertices[np.abs(made.vertices[:, 2] - 5.5) < 1e-9]
    assert np.hypot(floor[:, 0] - 10.0, floor[:, 1]) == pytest.approx(1.5, abs=1e-9)
    bare = solid(Part(name="p", contours=(square_contour(40.0),), openings=bore(8.0), width=6.0))
    assert bare.volume - made.volume == pytest.approx(0.5 * math.pi * 1.5**2, rel=2e-3)
    bottom = made.vertices[made.vertices[:, 2] < 1e-9]
    assert (np.hypot(bottom[:, 0] - 10.0, bottom[:, 1]) > 2).all()


def test_bores_are_round_within_the_tolerance() -> None:
    plate = Part(name="p", contours=(square_contour(40.0),), openings=bore(20.0), width=6.0)
    assert solid(plate).volume == pytest.approx(plate.volume, abs=math.pi * 20 * 1e-3 * 6)
    coarse = Part(name="p", contours=(square_contour(40.0, 0.5),), openings=bore(20.0), width=6.0)
    assert len(solid(coarse).vertices) < 40


def test_a_solid_without_arcs_is_exact() -> None:
    plate = Part(name="p", contours=(square_contour(40.0),), width=6.0)
    made = solid(plate)
    assert made.watertight
    assert len(made.triangles) == 12
    assert made.volume == pytest.approx(9600.0, rel=1e-12)


@pytest.mark.parametrize("width", [1e-4, 1e-5])
def test_foils_are_closed_in_single_precision(width: float) -> None:
    plate = Part(name="p", contours=(square_contour(40.0),), openings=bore(8.0), width=width)
    assert closed(read_stl(stl_bytes({"p": solid(plate)}, "p"))[1])


def test_a_solid_that_lost_volume_is_refused(part: Part, monkeypatch: pytest.MonkeyPatch) -> None:
    whole = solids._mesh

    def half(body: object) -> Mesh:
        made = whole(body)  # type: ignore[arg-type]
        return Mesh(vertices=made.vertices * [1, 1, 0.5], triangles=made.triangles)

    monkeypatch.setattr(solids, "_mesh", half)
    with pytest.raises(SolidError, match="volume"):
        solid(part)
