"""Links as symbols, mirror images of shapes, and names that do not cover each other."""

from __future__ import annotations

import math
from typing import Any

import numpy as np
import pytest
import shapely

from gearcam.numeric.arrays import as_pairs
from gearcam.numeric.contour import Contour
from gearcam.numeric.pose import Pose
from gearcam.parts.shapes import Circle, Loop
from gearcam.pictures.drawings import MEMBER, Cross, Path, chains, mirrored
from gearcam.pictures.labels import Label, labelled
from gearcam.pictures.links import block, guide, link, pivot


def area(shape: Any, sagitta: float = 1e-4) -> Any:
    (points, closed), *_ = chains(shape, sagitta)
    assert closed
    return shapely.Polygon(as_pairs(points))


@pytest.mark.parametrize("pins", [(0j, 50 + 0j), (0j, 50 + 0j, 20 + 30j), (5j,)])
def test_a_link_is_everything_within_half_a_width_of_its_joints(pins: tuple[complex, ...]) -> None:
    edge, *holes = link(pins, 4.0)
    hull = shapely.MultiPoint(as_pairs(np.array(pins, dtype=complex))).convex_hull
    true = hull.buffer(4.0, quad_segs=200)
    assert area(edge.shape).symmetric_difference(true).area < 0.005 * true.area
    assert len(holes) == len(pins)
    assert edge.layer == MEMBER


def test_a_block_lies_along_its_way() -> None:
    edge, hole = (one.shape for one in block(3 + 4j, math.radians(30.0), 2.0))
    assert isinstance(edge, Path)
    assert isinstance(hole, Circle)
    back = Pose(0.0, -(3 + 4j)).apply(edge.points) * np.exp(-1j * math.radians(30.0))
    assert np.ptp(back.real) > np.ptp(back.imag) > 4.0
    assert abs(back.sum()) < 1e-12
    assert hole.center == 3 + 4j


def test_guides_and_pivots_are_below() -> None:
    line, *hatching = guide((0.0, 100.0), 2.0)
    shape: Any = line.shape
    assert (shape.points.imag < 0.0).all()
    assert shape.points.real.min() < 0.0 < 100.0 < shape.points.real.max()
    for one in hatching:
        ends: Any = one.shape
        assert ends.points[1].imag < shape.points[0].imag
    foot, *_ = pivot(7 + 1j, 2.0)
    triangle: Any = foot.shape
    assert triangle.points[0] == 7 + 1j
    assert (triangle.points[1:].imag < 1.0).all()


def test_mirror_images() -> None:
    loop = Loop(points=np.array([0j, 4 + 0j, 4 + 3j]), bulges=np.array([0.3, 0.0, 0.1]))
    seen: Any = mirrored(loop)
    assert isinstance(seen, Loop)  # counter-clockwise, or it would be refused
    own = shapely.affinity.scale(area(loop), 1.0, -1.0, origin=(0, 0))
    assert area(seen).symmetric_difference(own).area < 1e-3
    circle: Any = mirrored(Circle(center=1 + 2j, diameter=3.0))
    assert (circle.center, circle.diameter) == (1 - 2j, 3.0)
    cross: Any = mirrored(Cross(center=2j, size=1.0))
    assert cross.center == -2j
    line: Any = mirrored(Path(points=np.array([1j, 1 + 2j]), closed=False))
    assert (line.points.tolist(), line.closed) == ([-1j, 1 - 2j], False)
    corners = np.array([0j, 4 + 0j, 4 + 3j])
    contour = Contour(dense=tuple, points=corners, tolerance=1e-3, chord_error=0.0)
    assert area(mirrored(contour)).exterior.is_ccw


def test_names_keep_clear_of_lines_and_of_each_other() -> None:
    wanted = [(name, complex(k, 0.3 * k)) for k, name in enumerate(("A", "crank", "B", "coupler"))]
    lines: Any = np.linspace(-20.0, 20.0, 400) + 0j
    found = labelled(wanted, lines, 1.0, 0.5)
    ends = [one.corners for one in found]
    boxes = [shapely.box(low.real, low.imag, high.real, high.imag) for low, high in ends]
    for k, one in enumerate(boxes):
        assert not any(one.intersects(other) for other in boxes[:k])
        assert shapely.distance(one, shapely.points(as_pairs(lines))).min() > 0.0
    for label, (name, at) in zip(found, wanted, strict=True):
        assert label.text == name
        assert abs(label.center - at) < 6.0


def test_names_in_a_crowd_are_still_all_there() -> None:
    crowd: Any = (np.arange(-40, 40) * 0.1)[:, None] + 1j * (np.arange(-40, 40) * 0.1)
    found = labelled([("one", 0j), ("two", 0j)], crowd.ravel(), 1.0, 0.5)
    assert [one.text for one in found] == ["one", "two"]
    assert isinstance(found[0], Label)
