"""Bodies that no design makes yet: a ring with inner teeth, and one that is no prism at all."""

from __future__ import annotations

import math
from dataclasses import dataclass, replace
from importlib.util import find_spec
from xml.etree import ElementTree as ET

import numpy as np
import pytest
import shapely

from gearcam.export.cut_svg import cut_svg
from gearcam.export.dxf import DxfStyle, dxf_bytes
from gearcam.export.dxf_read import measure_dxf, read_dxf
from gearcam.export.laser_sheet import labelled, nested
from gearcam.export.mesh import glb_bytes, stl_bytes, threemf_bytes
from gearcam.export.sheet_dxf import sheet_dxf
from gearcam.export.sheet_svg import sheet_svg
from gearcam.export.svg import svg_bytes
from gearcam.kinds.gear_pair.drawings import pair_drawing
from gearcam.numeric.mesh import Mesh
from gearcam.numeric.moments import Moments
from gearcam.parts.body import Mark, Opening, Part
from gearcam.parts.mass import mass_properties, volume_moments
from gearcam.parts.shapes import Circle
from gearcam.parts.solids import solid, volume_error
from gearcam.pictures.drawings import cut_drawing, wheel_drawing
from helpers_contour import disc_contour, gear_contour, layers
from helpers_sheets import sheet_of

TEETH = gear_contour(30, 2.0)
ROUND = disc_contour(90.0)
WIDTH = 8.0
HOLE = Opening(
    kind="HOLE", shape=Circle(center=complex(0.0, 39.0), diameter=4.0), name="bolt hole 1"
)
MARK = Mark(center=complex(39.0, 0.0), diameter=2.0, depth=0.5)
STYLE = DxfStyle(tolerance=1e-3)


def ring(steps: int = 1) -> Part:
    """A ring of one or more steps; the teeth of each stand a little further round."""
    turned = [gear_contour(30, 2.0, squash=(1.0, 1.0 - 0.01 * k)) for k in range(steps)]
    return Part(
        name="gear2",
        contours=(ROUND,) * steps,
        inner=(TEETH, *turned[1:]),
        width=WIDTH,
        openings=(HOLE,),
        marks=(MARK,),
    )


def exact_area() -> float:
    return ROUND.moments.area - TEETH.moments.area - 4.0 * math.pi


def test_a_ring_is_what_lies_between_its_edges() -> None:
    part = ring()
    assert part.steps[0].moments.area == pytest.approx(exact_area(), rel=1e-13)
    assert part.volume == pytest.approx(WIDTH * exact_area() - 0.5 * math.pi, rel=1e-13)
    assert [len(part.region.interiors), part.thickness] == [2, WIDTH]
    inertia = ROUND.moments.polar - TEETH.moments.polar - 4.0 * math.pi * (39.0**2 + 2.0)
    dimple = math.pi * 0.5 * (39.0**2 + 0.5)
    made = mass_properties(part, 1e9)
    assert made.inertia == pytest.approx(WIDTH * inertia - dimple, rel=1e-12)


def test_each_step_of_a_ring_has_its_own_teeth() -> None:
    part = ring(2)
    first, second = part.steps
    assert first.openings[0].shape is TEETH
    assert second.openings[0].shape is part.inner[1]
    teeth = sum(contour.moments.area for contour in part.inner)
    assert part.volume == pytest.approx(
        WIDTH * (ROUND.moments.area - 0.5 * teeth - 4.0 * math.pi) - 0.5 * math.pi, rel=1e-12
    )
    with pytest.raises(ValueError, match="inner edge"):
        replace(part, inner=(TEETH,))


@pytest.mark.parametrize("steps", [1, 2])
def test_the_mesh_of_a_ring_is_closed_and_hollow(steps: int) -> None:
    part = ring(steps)
    made = solid(part)
    assert made.watertight
    assert abs(made.volume - part.volume) <= volume_error(part) < 1e-3 * part.volume
    assert stl_bytes({"gear2": made}, "gear2")
    assert threemf_bytes({"gear2": made}, "gear2")
    assert glb_bytes({"gear2": made}, "gear2")


def test_drawings_of_a_ring_hold_both_edges() -> None:
    drawing = wheel_drawing(ring())
    assert layers(drawing) == ["OUTLINE", "INNER", "HOLE", "MARK"]
    assert drawing.contours == (ROUND, TEETH)
    data = dxf_bytes(drawing, STYLE)
    assert measure_dxf(data, drawing.contours) <= 1e-3
    assert {one.dxf.layer for one in read_dxf(data).modelspace()} == set(layers(drawing))
    pair = pair_drawing([replace(ring(), name="gear1"), ring()], 0.0)
    assert b'class="gear2-inner" fill="#ffffff"' in svg_bytes(pair, title="ring")


def test_a_cutter_stays_in_the_waste_of_a_ring() -> None:
    """Half a kerf outside the outline, and half a kerf within the teeth."""
    kerf = 0.2
    outer, inner = cut_drawing(wheel_drawing(ring()), kerf).contours
    assert outer.moments.area == pytest.approx(math.pi * (90.0 + 0.5 * kerf) ** 2, rel=1e-9)
    path, edge = shapely.LinearRing(inner.vertices), shapely.LinearRing(TEETH.vertices)
    assert shapely.Polygon(edge).contains(path)
    away = shapely.distance(shapely.points(inner.vertices), edge)
    assert away.min() == pytest.approx(0.5 * kerf, abs=2e-3)
    sheet = ET.fromstring(cut_svg(nested([labelled(wheel_drawing(ring()))]), "ring"))
    names = [group.get("id") for group in sheet if group.get("id")]
    assert names == ["engrave", "cut-inner", "cut-outer"]


def test_a_ring_has_a_sheet() -> None:
    part = ring(2)
    made = sheet_of(part)
    kinds = [feature.kind for feature in made.features]
    assert kinds.count("INNER") == 1
    assert len(made.hatches) == 1
    assert b'class="inner" stroke-width="0.5"' in sheet_svg(made)
    assert b"INNER" in sheet_dxf(made, STYLE)


@pytest.mark.skipif(find_spec("OCP") is None, reason="needs the extra for STEP files")
def test_a_ring_is_a_step_solid() -> None:
    from gearcam.export.step_shapes import properties, solids_of

    part = ring()
    (made,) = solids_of(part, 1e-5)
    assert properties(made).Mass() == pytest.approx(part.volume, rel=1e-6)


@dataclass(frozen=True, kw_only=True)
class Cone:
    """A body that is no stack of layers."""

    name: str
    radius: float
    height: float
    tolerance: float = 1e-3

    @property
    def volume(self) -> float:
        return math.pi * self.radius**2 * self.height / 3.0


@solid.register
def _(cone: Cone) -> Mesh:
    count = 400
    angle = 2.0 * math.pi * np.arange(count) / count
    rim = cone.radius * np.column_stack([np.cos(angle), np.sin(angle), 0.0 * angle])
    ends = [[0.0, 0.0, 0.0], [0.0, 0.0, cone.height]]
    k = np.arange(count)
    after = (k + 1) % count
    base, tip = np.full(count, count), np.full(count, count + 1)
    sides = [np.column_stack([k, after, tip]), np.column_stack([after, k, base])]
    return Mesh(vertices=np.vstack([rim, ends]), triangles=np.vstack(sides))


@volume_moments.register
def _(cone: Cone) -> tuple[Moments, float]:
    polar = 0.3 * cone.volume * cone.radius**2
    moments = Moments(area=cone.volume, first=0j, polar=polar)
    return moments, cone.volume * cone.height / 4.0


def test_a_body_need_not_be_a_prism() -> None:
    cone = Cone(name="cone", radius=10.0, height=20.0)
    made = solid(cone)
    assert made.watertight
    assert made.volume == pytest.approx(cone.volume, rel=1e-4)
    assert len(stl_bytes({cone.name: made}, cone.name)) == 84 + 50 * 800
    found = mass_properties(cone, 1e9)
    assert found.mass == pytest.approx(cone.volume, rel=1e-14)
    assert found.centroid[2] == pytest.approx(5.0, rel=1e-14)
    with pytest.raises(TypeError, match="Circle makes no solid"):
        solid(Circle(center=0j, diameter=1.0))  # type: ignore[arg-type]
