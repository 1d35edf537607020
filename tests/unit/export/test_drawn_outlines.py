"""Outlines as other programs draw them: loose lines and arcs, blocks, other units."""

from __future__ import annotations

import io
import math
import random
from collections.abc import Callable
from typing import Any

import ezdxf
import numpy as np
import pytest
from ezdxf.math import Matrix44

from gearcam.export.dxf_read import DxfError, read_outline
from gearcam.numeric.bulges import farthest, flatten_bulges

RADIUS, HALF = 12.0, 20.0
"""A slot's shape, mm: two half circles, whose centres are 40 mm apart, and two lines."""

AREA = math.pi * RADIUS**2 + 4 * RADIUS * HALF

Draw = Callable[[Any], object]


def drawing(draw: Draw, unit: int = 4) -> bytes:
    """The bytes of a file whose model space is drawn, in a unit by its number in DXF files."""
    document = ezdxf.new("R2010")  # pyright: ignore[reportPrivateImportUsage]
    document.header["$INSUNITS"] = unit
    draw(document.modelspace())
    stream = io.StringIO()
    document.write(stream)
    return stream.getvalue().encode()


def area(data: bytes) -> float:
    """The area within an outline, by chords within 1e-7 mm."""
    points = flatten_bulges(*read_outline(data), 1e-7)
    return abs(0.5 * float(np.sum((np.conj(points) * np.roll(points, -1)).imag)))


def slot(
    space: Any, scale: float = 1.0, digits: int = 12, layers: tuple[str, str] = ("", "")
) -> None:
    """Draw the slot of loose lines and arcs, in no order and in both directions."""
    r, h = (round(scale * value, digits) for value in (RADIUS, HALF))
    lines = [((-h, -r), (h, -r)), ((-h, r), (h, r))]
    arcs = [((h, 0), 270, 90), ((-h, 0), 90, 270)]
    parts = [("l", one) for one in lines] + [("a", one) for one in arcs]
    random.Random(5).shuffle(parts)
    for kind, one in parts:
        if kind == "l":
            space.add_line(*one, dxfattribs={"layer": layers[0] or "0"})
        else:
            space.add_arc(one[0], r, *one[1:], dxfattribs={"layer": layers[1] or "0"})


def open_polyline(space: Any) -> None:
    bent = [(HALF, -RADIUS, 1.0), (HALF, RADIUS, 0), (-HALF, RADIUS, 1.0), (-HALF, -RADIUS, 0)]
    space.add_lwpolyline([*bent, bent[0]], format="xyb")


def many_chords(space: Any) -> None:
    u = np.radians(np.arange(0.0, 360.0, 0.5)).tolist()
    ends = [(40 * math.cos(x), 30 * math.sin(x)) for x in u]
    for a, b in zip(ends, [*ends[1:], ends[0]], strict=True):
        space.add_line(a, b)


def blocks(space: Any) -> None:
    """A slot in a block, mirrored and turned in another, on layer 0 of a placed block."""
    inner, outer = (space.doc.blocks.new(name) for name in ("INNER", "WHOLE"))
    slot(inner)
    attributes = {"xscale": -1, "yscale": 1, "rotation": 30}
    outer.add_blockref("INNER", (5, 7), dxfattribs=attributes)
    space.add_blockref("WHOLE", (100, -50), dxfattribs={"layer": "PROFILE"})
    space.add_lwpolyline([(0, 0), (9, 0), (0, 9)], close=True)  # another, not on that layer


def stretched(space: Any) -> None:
    block = space.doc.blocks.new("ROUND")
    block.add_circle((0, 0), 10)
    space.add_blockref("ROUND", (3, 3), dxfattribs={"xscale": 4, "yscale": 3})


def spline(space: Any) -> None:
    """The same ellipse as one long span of a rational spline."""
    space.add_ellipse((0, 0), (40, 0), 0.75).to_spline()


def beside_circles(space: Any) -> None:
    slot(space)
    for x in (-15, 15):
        space.add_circle((x, 0), 3)
    space.add_text("12 H7")


def with_a_spur(space: Any) -> None:
    slot(space)
    space.add_line((-HALF, RADIUS), (0, 0))


def mirrored_axis(space: Any) -> None:
    """Half of the slot drawn in a frame whose z-axis points down, as a mirrored copy is."""
    space.add_line((-HALF, RADIUS), (HALF, RADIUS))
    space.add_line((-HALF, -RADIUS), (HALF, -RADIUS))
    space.add_arc((HALF, 0), RADIUS, 270, 90)
    copy = space.add_arc((HALF, 0), RADIUS, 270, 90)
    copy.transform(Matrix44.scale(-1, 1, 1))
    assert copy.dxf.extrusion.z == -1


@pytest.mark.parametrize(
    ("draw", "unit", "expected", "within"),
    [
        (slot, 4, AREA, 1e-4),
        (lambda space: slot(space, layers=("LINES", "ARCS")), 4, AREA, 1e-4),
        (lambda space: slot(space, 1 / 25.4), 1, AREA, 1e-4),
        (
            lambda space: slot(space, 1 / 25.4, digits=4),
            1,
            AREA,
            0.5e-4 * 25.4 * (2 * math.pi * RADIUS + 4 * (HALF + RADIUS)),
        ),
        (lambda space: slot(space, 0.1), 5, AREA, 1e-4),
        (lambda space: slot(space, 1e-3), 6, AREA, 1e-4),
        (lambda space: slot(space, 1000), 13, AREA, 1e-4),
        (slot, 0, AREA, 1e-4),
        (open_polyline, 4, AREA, 1e-4),
        (blocks, 4, AREA, 1e-4),
        (mirrored_axis, 4, AREA, 1e-4),
        (beside_circles, 4, AREA, 1e-4),
        (many_chords, 4, 360 * 40 * 30 * math.sin(math.radians(0.5)), 1e-4),
        (with_a_spur, 4, AREA, 1e-4),
        (stretched, 4, math.pi * 40 * 30, 2e-3),
        (lambda space: space.add_ellipse((9, 9), (0, 40), 0.75), 4, math.pi * 40 * 30, 2e-3),
        (spline, 4, math.pi * 40 * 30, 2e-3),
        (lambda space: space.add_circle((4, 0), 25), 4, math.pi * 25**2, 1e-4),
    ],
)
def test_what_meets_is_one_outline(draw: Draw, unit: int, expected: float, within: float) -> None:
    assert area(drawing(draw, unit)) == pytest.approx(expected, abs=within)


def test_a_gap_is_joined_up_to_the_tolerance_and_told_beyond() -> None:
    def gap(width: float) -> bytes:
        return drawing(
            lambda space: [
                space.add_line((0, 0), (30, 0)),
                space.add_line((30, width), (30, 20)),
                space.add_lwpolyline([(30, 20), (0, 20), (0, 0)]),
                space.add_circle((10, 10), 2),
            ]
        )

    assert area(gap(0.0049)) == pytest.approx(600.0, abs=0.1)
    words = r"holds 2 LINE, 1 LWPOLYLINE, 1 CIRCLE.* 0\.0051 mm from .* up to 0\.005 mm apart"
    with pytest.raises(DxfError, match=words):
        read_outline(gap(0.0051))


def two_slots(space: Any) -> None:
    slot(space)
    space.add_lwpolyline([(0, 0), (9, 0), (0, 8)], close=True, dxfattribs={"layer": "OTHER"})


def crossing(space: Any) -> None:
    slot(space)
    space.add_line((-HALF, RADIUS), (HALF, -RADIUS))


def two_bulged(space: Any) -> None:
    """A segment of a circle, clockwise, and three quarters of one, cut off straight."""
    space.add_lwpolyline([(0, 0, -0.5), (10, 0, 0)], format="xyb", close=True)
    bulge = math.tan(3 * math.pi / 8)
    space.add_lwpolyline([(4, 0, bulge), (0, -4, 0)], format="xyb", close=True)


def cam_in_stock(space: Any) -> None:
    space.add_circle((0, -10), 30, dxfattribs={"layer": "CAM"})
    space.add_ellipse((0, 0), (45, 0), 0.9, dxfattribs={"layer": "STOCK"})


def two_profiles(space: Any) -> None:
    on = {"layer": "PROFILE"}
    space.add_circle((0, -10), 30, dxfattribs=on)
    space.add_lwpolyline([(4, 0, 1), (-4, 0, 1)], format="xyb", close=True, dxfattribs=on)


def bore_beside_layers(space: Any) -> None:
    slot(space, layers=("LINES", "ARCS"))
    space.add_circle((0, 0), 3, dxfattribs={"layer": "HOLES"})


def bore_beside_a_gap(space: Any) -> None:
    space.add_lwpolyline([(0, 0), (30, 0), (30, 20), (0, 20), (0, 0.1)])
    space.add_circle((10, 10), 2, dxfattribs={"layer": "HOLES"})


@pytest.mark.parametrize(
    ("draw", "unit", "words"),
    [
        (two_slots, 4, r"holds 2: layer 0, 64 x 24 mm; layer OTHER, 9 x 8 mm\. Put .*PROFILE"),
        (crossing, 4, r"more than two lines meet at x = -?20, y = -?12 mm"),
        (slot, 19, "is in lightyears: save it in millimetres or inches"),
        (slot, 77, r"an unknown unit, \$INSUNITS = 77"),
        (lambda space: space.add_text("slot"), 4, "holds 1 TEXT"),
        (lambda _: None, 4, r"\(it holds nothing\)"),
        (two_bulged, 4, r"holds 2: layer 0, 10 x 2\.5 mm; layer 0, 8 x 8 mm\. Put"),
        (cam_in_stock, 4, "holds 2: layer CAM, 60 x 60 mm; layer STOCK, 90 x 81 mm"),
        (two_profiles, 4, "holds 2: layer PROFILE, 60 x 60 mm; layer PROFILE, 8 x 8 mm"),
        (bore_beside_layers, 4, "holds 2: layer HOLES, 6 x 6 mm; 64 x 24 mm"),
        (bore_beside_a_gap, 4, r"holds 1 LWPOLYLINE, 1 CIRCLE\): .* 0\.1 mm from the next end"),
        (lambda space: [space.add_circle((0, 0), r) for r in (3, 9)], 4, "holds 2: layer 0, 6 x 6"),
    ],
)
def test_what_is_no_single_outline_is_listed(draw: Draw, unit: int, words: str) -> None:
    with pytest.raises(DxfError, match=words):
        read_outline(drawing(draw, unit))


def hidden(space: Any, left: bool = True) -> None:
    """A circle beside outlines on layers that are off or frozen."""
    space.doc.layers.add("OFF").off()
    space.doc.layers.add("Frozen").freeze()
    if left:
        space.add_circle((4, 0), 25)
        space.add_lwpolyline([(0, 0), (99, 0), (0, 99)], close=True, dxfattribs={"layer": "off"})
    slot(space, layers=("Frozen", "Frozen"))


def test_layers_off_or_frozen_are_left_out_if_there_are_others() -> None:
    assert area(drawing(hidden)) == pytest.approx(math.pi * 25**2, abs=1e-4)
    assert area(drawing(lambda space: hidden(space, left=False))) == pytest.approx(AREA, abs=1e-4)


def test_a_circle_beside_what_is_no_edge_is_the_outline() -> None:
    def noted(space: Any) -> None:
        space.add_circle((4, 0), 25)
        space.add_point((4, 0))
        space.add_text("D50 h6")

    assert area(drawing(noted)) == pytest.approx(math.pi * 25**2, abs=1e-4)


@pytest.mark.parametrize(
    ("degree", "knots", "weights"),
    [
        (3, np.arange(-3.0, 16.0), None),
        (3, np.arange(19.0), None),  # as set_closed of ezdxf has them
        (2, np.r_[-3.0, -1.3, 0.0, 1.5, np.arange(2.0, 11.0), 11.7, 13.0, 14.5, 15.0], None),
        (3, np.arange(19.0), np.tile([1.0, 2.0, 0.5], 4)),
    ],
)
def test_a_periodic_spline_is_run_over_its_domain(
    degree: int, knots: np.ndarray, weights: np.ndarray | None
) -> None:
    from scipy.interpolate import BSpline

    u = np.arange(12 + degree) * math.pi / 6
    x, y = 30 * np.cos(u), 30 * np.sin(u) - 10
    heavy = np.ones(len(u)) if weights is None else np.resize(weights, len(u))

    def draw(space: Any) -> None:
        made = space.add_spline()
        made.control_points = np.column_stack([x, y, 0 * x])
        made.knots = knots
        made.weights = [] if weights is None else heavy
        made.dxf.degree, made.dxf.flags = degree, 11

    points, bulges = read_outline(drawing(draw))
    places = np.linspace(knots[degree], knots[12 + degree], 2000)
    true = BSpline(knots, np.column_stack([x * heavy, y * heavy, heavy]), degree)(places)
    assert true[0] == pytest.approx(true[-1], abs=1e-12)  # it is periodic
    assert farthest((true[:, 0] + 1j * true[:, 1]) / true[:, 2], points, bulges) < 1.1e-5


TILTED = {"extrusion": (0, 1, 1)}


def tilted_block(space: Any) -> None:
    space.doc.blocks.new("ROUND").add_lwpolyline([(0, 0), (9, 0), (0, 8)], close=True)
    space.add_blockref("ROUND", (0, 0), dxfattribs={**TILTED, "layer": "PROFILE"})


def rising_spline(space: Any) -> None:
    space.add_open_spline([(0, 0, 0), (9, 0, 0), (9, 9, 0), (0, 9, 0.02)])


@pytest.mark.parametrize(
    ("draw", "words"),
    [
        (lambda space: space.add_circle((0, -10), 30, dxfattribs=TILTED), r"CIRCLE.* is 0, 1, 1\)"),
        (
            lambda space: space.add_arc(
                (0, 0), 9, 0, 180, dxfattribs={"extrusion": (0, -1, 0), "layer": "FRONT"}
            ),
            r"the ARC on layer FRONT does not lie in .* xy \(its extrusion is 0, -1, 0\)",
        ),
        (
            lambda space: space.add_lwpolyline([(0, 0), (9, 0), (0, 8)], dxfattribs=TILTED),
            r"LWPOLYLINE.* is 0, 1, 1\)",
        ),
        (
            lambda space: space.add_polyline2d([(0, 0), (9, 0), (0, 8)], dxfattribs=TILTED),
            r"POLYLINE.* is 0, 1, 1\)",
        ),
        (tilted_block, r"the LWPOLYLINE on layer PROFILE .* is 0, 0\.707, 0\.707\)"),
        (
            lambda space: space.add_ellipse((0, 0), (9, 0), 0.5, dxfattribs=TILTED),
            r"ELLIPSE.* is 0, 1, 1\)",
        ),
        (rising_spline, r"the SPLINE on layer 0 .* \(it rises by 0\.02 mm\)"),
        (lambda space: space.add_line((0, 0, 0), (9, 0, -0.3)), r"LINE.* rises by 0\.3 mm"),
        (lambda space: space.add_polyline3d([(0, 0, 0), (9, 0, 3)]), r"POLYLINE.* rises by 3 mm"),
    ],
)
def test_what_is_tilted_is_refused_by_name(draw: Draw, words: str) -> None:
    with pytest.raises(DxfError, match=words):
        read_outline(drawing(draw))


def test_what_is_level_is_read_at_any_height() -> None:
    """A line's extrusion does not tilt it, and one that points down may hold rounding."""

    def draw(space: Any) -> None:
        for a, b in (((-3, -6), (-3, 6)), ((-3, 6), (-9, 6)), ((-9, -6), (-3, -6))):
            space.add_line((*a, 7), (*b, 7.001), dxfattribs=TILTED)
        down = {"extrusion": (1e-7, 0, -1)}
        space.add_arc((9, 0), 6, 270, 90, dxfattribs=down)

    assert area(drawing(draw)) == pytest.approx(18 * math.pi + 72, abs=1e-4)
