"""The assembled pair in files: two named bodies at their places, turned as the angle asks."""

from __future__ import annotations

import importlib
import io
import json
import math
import struct
import zipfile
from dataclasses import replace
from functools import cache
from typing import Any

import numpy as np
import pytest
from ezdxf.filemanagement import read as read_dxf

from gearcam.designs.outputs import MESHES
from gearcam.kinds.gear_pair.design import PairOutputSpec
from gearcam.kinds.gear_pair.result import GearPairResult
from gearcam.numeric.pose import Pose
from gearcam.parts.blank import Blank
from gearcam.parts.mass import mass_properties
from helpers_pairs import profile
from helpers_sampling import few

etree: Any = importlib.import_module("lxml.etree")
PHI1 = math.radians(40.0)


@cache
def job(name: str = "ellipse") -> GearPairResult:
    output = PairOutputSpec(files=("stl",), chord_tolerance=0.005, pose=PHI1)
    blank = Blank(bore_diameter=(5.0, 6.0), hub_diameter=(9.0, 0.0), hub_back=(2.0, 0.0))
    return GearPairResult(replace(profile(name).design, output=output, blank=blank))


@cache
def files(kind: str) -> dict[str, bytes]:
    return job().files(kind)


def centroid(corners: np.ndarray) -> tuple[float, np.ndarray]:
    """Volume and centre of mass of triangles (n, 3, 3)."""
    volume = np.linalg.det(corners) / 6
    return float(volume.sum()), (volume[:, None] * corners.sum(axis=1)).sum(axis=0) / 4 / float(
        volume.sum()
    )


def expected(number: int) -> tuple[float, np.ndarray]:
    """Volume and centre of a wheel in the assembly, by its own properties and phi2's closed form.

    Ellipse about its focus: ``tan(phi2/2) = (1 - e)/(1 + e)*tan(phi1/2)``; wheel 1 turns by -phi1.
    """
    found = mass_properties(job().parts[number], 1.0)
    angle = -PHI1
    if number == 1:
        angle = 2 * math.atan(0.7 / 1.3 * math.tan(PHI1 / 2))
    x, y, z = found.centroid
    place = complex(x, y) * np.exp(1j * angle)
    return found.volume, np.array([place.real + number * job().pair.center_distance, place.imag, z])


def bodies(kind: str) -> dict[str, np.ndarray]:
    """Triangles of each body by small readers of their own."""
    data = files(kind)[f"pair.{kind}"]
    if kind == "stl":
        (count,) = struct.unpack_from("<I", data, 80)
        rows = np.frombuffer(data[84:], dtype=np.dtype([("v", "<f4", (4, 3)), ("a", "<u2")]))
        assert len(rows) == count
        first = struct.unpack_from("<I", files(kind)["gear1.stl"], 80)[0]
        corners = rows["v"][:, 1:].astype(float)
        return {"gear1": corners[:first], "gear2": corners[first:]}
    if kind == "3mf":
        with zipfile.ZipFile(io.BytesIO(data)) as archive:
            model = etree.fromstring(archive.read("3D/3dmodel.model"))
        assert model.get("unit") == "millimeter"
        space = {"c": "http://schemas.microsoft.com/3dmanufacturing/core/2015/02"}
        made = {}
        for body in model.iterfind(".//c:object", space):
            if body.find("c:mesh", space) is None:
                continue
            places = [[float(v.get(k)) for k in "xyz"] for v in body.iterfind(".//c:vertex", space)]
            index = [
                [int(t.get(k)) for k in ("v1", "v2", "v3")]
                for t in body.iterfind(".//c:triangle", space)
            ]
            made[body.get("name")] = np.array(places)[np.array(index)]
        return made
    return glb_bodies(data)


def glb_bodies(data: bytes) -> dict[str, np.ndarray]:
    (size,) = struct.unpack_from("<I", data, 12)
    tree, binary = json.loads(data[20 : 20 + size]), data[28 + size :]
    assert tree["scenes"][0]["extras"]["units"] == "mm"

    def values(number: int) -> np.ndarray:
        accessor = tree["accessors"][number]
        view = tree["bufferViews"][accessor["bufferView"]]
        kind = {5126: "<f4", 5125: "<u4", 5123: "<u2"}[accessor["componentType"]]
        width = {"SCALAR": 1, "VEC3": 3}[accessor["type"]]
        start = view.get("byteOffset", 0) + accessor.get("byteOffset", 0)
        return np.frombuffer(binary, kind, accessor["count"] * width, start).reshape(-1, width)

    made = {}
    for node in tree["nodes"]:
        if "mesh" in node:
            (part,) = tree["meshes"][node["mesh"]]["primitives"]
            index = values(part["indices"]).ravel()
            places = values(part["attributes"]["POSITION"]).astype(float)
            made[node["name"]] = places[index.reshape(-1, 3)]
    return made


@pytest.mark.parametrize("kind", MESHES)
def test_both_bodies_stand_where_they_belong(kind: str) -> None:
    found = bodies(kind)
    assert list(found) == ["gear1", "gear2"]
    for number, corners in enumerate(found.values()):
        volume, place = centroid(corners)
        wanted, center = expected(number)
        assert volume == pytest.approx(wanted, rel=2e-3)
        assert place == pytest.approx(center, abs=0.01)


def test_a_pair_that_is_not_turned_stands_elsewhere() -> None:
    """Control: the wheels' own frames are not the assembly."""
    plain = replace(job().design, output=replace(job().design.output, pose=0.0))
    assert GearPairResult(plain).poses == (Pose(), Pose(shift=job().pair.shift))
    _, place = centroid(bodies("stl")["gear1"])
    own = mass_properties(job().parts[0], 1.0).centroid
    assert math.dist(place, own) > 1.0


@pytest.mark.parametrize("degrees", few([77.7, 301.0]))
def test_the_drawn_pair_does_not_overlap_at_any_angle(degrees: float) -> None:
    from shapely import Polygon

    output = PairOutputSpec(
        files=("dxf",), dxf_curves="lines", chord_tolerance=0.005, pose=math.radians(degrees)
    )
    made = GearPairResult(replace(profile("ellipse").design, output=output))
    document = read_dxf(io.StringIO(made.files("dxf")["pair.dxf"].decode()))
    drawn: Any = document.modelspace()
    one, two = (
        Polygon([(place.x, place.y) for line in drawn.query(f'POLYLINE[layer=="{layer}"]')
                 for place in line.points()])
        for layer in ("GEAR1_OUTLINE", "GEAR2_OUTLINE")
    )  # fmt: skip
    assert one.intersection(two).area < 0.01
    assert one.distance(two) < 0.01
