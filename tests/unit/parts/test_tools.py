"""The largest round tool: closed forms, and the closing of the outline by a disc of that size."""

from __future__ import annotations

import cmath
import math

import numpy as np
import pytest

from gearcam.numeric.contour import Contour
from gearcam.parts.tools import ToolLimits, tool_limits
from helpers_contour import (
    Curve,
    arc,
    contour_of,
    disc_contour,
    gear_contour,
    line,
    plate,
    square_contour,
)

TOLERANCE = 1e-3


def u_slot(width: float, depth: float) -> Contour:
    """A slot with a half circle at its bottom."""
    half = width / 2
    foot = (20 - depth) * 1j
    return plate(
        [
            line(half + 20j, half + foot),
            arc(foot, half, 0.0, -math.pi),
            line(-half + foot, -half + 20j),
        ],
        half,
    )


def square_slot(width: float, depth: float) -> Contour:
    """A slot with sharp inner corners."""
    half, foot = width / 2, (20 - depth) * 1j
    cut = [
        line(half + 20j, half + foot),
        line(half + foot, -half + foot),
        line(-half + foot, -half + 20j),
    ]
    return plate(cut, half)


def keyhole_cut(entrance: float, radius: float, top: float, depth: float) -> list[Curve]:
    """An entrance of parallel walls, `depth` deep, into a round chamber; from right to left."""
    half = entrance / 2
    open_half = math.asin(half / radius)
    foot = (top - depth) * 1j
    centre = foot - 1j * radius * math.cos(open_half)
    around = arc(centre, radius, math.pi / 2 - open_half, open_half - 1.5 * math.pi)
    return [line(half + top * 1j, half + foot), around, line(-half + foot, -half + top * 1j)]


def keyhole(entrance: float, radius: float, depth: float) -> Contour:
    """A keyhole in the square plate."""
    return plate(keyhole_cut(entrance, radius, 20.0, depth), entrance / 2)


def slit_disc(radius: float, entrance: float, chamber: float) -> Contour:
    """A disc with a keyhole: a C where the chamber is about the disc's middle."""
    beside = math.asin(entrance / 2 / radius)
    top = radius * math.cos(beside)
    depth = top - chamber * math.cos(math.asin(entrance / 2 / chamber))
    outside = arc(0j, radius, math.pi / 2 + beside, 2.5 * math.pi - beside)
    return contour_of([*keyhole_cut(entrance, chamber, top, depth), outside], TOLERANCE)


def groove(angle: float, radius: float) -> Contour:
    """A V of straight walls with a rounded bottom: no slot, since its walls hardly face."""
    half = angle / 2
    centre = 8j
    right = centre + radius * cmath.exp(-1j * half)
    up = 1j * cmath.exp(-1j * half)
    mouth = right + up * (20 - right.imag) / up.imag
    mirrored = [-z.conjugate() for z in (right, mouth)]
    cut = [
        line(mouth, right),
        arc(centre, radius, -half, half - math.pi),
        line(mirrored[0], mirrored[1]),
    ]
    return plate(cut, mouth.real)


def closing(contour: Contour, diameter: float) -> float:
    """Part of the outline's area that a disc cannot reach from outside."""
    region, radius = contour.polygon, 0.5 * diameter
    closed = region.buffer(radius, quad_segs=720).buffer(-radius, quad_segs=720)
    return float(closed.difference(region).area / region.area)


def test_a_slot_with_a_round_bottom() -> None:
    limits = tool_limits(u_slot(4.0, 8.0))
    assert limits.slot == pytest.approx(4.0, abs=1e-7)
    assert limits.inner_radius == pytest.approx(2.0, rel=1e-5)
    assert limits.diameter == pytest.approx(4.0, rel=1e-5)
    assert limits.slot_place is not None
    assert limits.slot_place.real == pytest.approx(0.0, abs=1e-9)
    assert 12.0 - 1e-6 <= limits.slot_place.imag <= 20.0 + 1e-6
    assert limits.inner_place is not None
    assert abs(limits.inner_place - 12j) == pytest.approx(2.0, abs=1e-4)
    assert limits.inner_place.imag < 12.0


@pytest.mark.parametrize("depth", [0.01, 1.0, 4.0, 15.0])
def test_a_keyhole_s_entrance(depth: float) -> None:
    limits = tool_limits(keyhole(3.0, 2.0, depth))
    assert limits.inner_radius == pytest.approx(2.0, rel=1e-5)
    assert limits.slot == pytest.approx(3.0, abs=1e-9)
    assert limits.diameter == pytest.approx(3.0, abs=1e-9)
    assert limits.slot_place is not None
    x, y = limits.slot_place.real, limits.slot_place.imag
    assert x == pytest.approx(0.0, abs=1e-9)
    assert 20 - depth - 1e-9 <= y <= 20.0 + 1e-9


@pytest.mark.parametrize("chamber", [2.0, 12.0])
@pytest.mark.parametrize("radius", [20.0, 60.0])
def test_a_keyhole_in_a_dense_outline(radius: float, chamber: float) -> None:
    """Between the two walls of the entrance there are thousands of points, either way round."""
    limits = tool_limits(slit_disc(radius, 3.0, chamber))
    assert limits.inner_radius == pytest.approx(chamber, rel=1e-5)
    assert limits.slot == pytest.approx(3.0, abs=1e-3)
    assert limits.slot_place is not None
    assert limits.slot_place.real == pytest.approx(0.0, abs=1e-3)


@pytest.mark.parametrize("contour", [square_slot(4.0, 8.0), gear_contour(12)])
def test_an_inner_corner_takes_no_round_tool(contour: Contour) -> None:
    limits = tool_limits(contour)
    assert limits.inner_radius == 0.0
    assert limits.diameter == 0.0
    assert limits.inner_place is not None


def test_an_inner_corner_has_its_place() -> None:
    limits = tool_limits(square_slot(4.0, 8.0))
    assert limits.inner_place is not None
    assert abs(limits.inner_place.real) == pytest.approx(2.0, abs=1e-9)
    assert limits.inner_place.imag == pytest.approx(12.0, abs=1e-9)


@pytest.mark.parametrize("width", [0.5, 4.0])
def test_the_walls_of_a_square_slot_face_each_other(width: float) -> None:
    """Walls of two points each: they face along their whole length, not only where they begin."""
    assert tool_limits(square_slot(width, 8.0)).slot == pytest.approx(width, abs=1e-9)


def test_the_sharpest_place_of_a_bottom_that_is_an_ellipse() -> None:
    """Half axes 4 across and 6 down: at the lowest point the radius is 4**2/6, at the sides 9."""

    def bottom(u: np.ndarray) -> tuple[np.ndarray, np.ndarray]:
        turn = -math.pi * u
        return 10j + 4 * np.cos(turn) + 6j * np.sin(turn), 4 * np.sin(turn) - 6j * np.cos(turn)

    limits = tool_limits(plate([line(4 + 20j, 4 + 10j), bottom, line(-4 + 10j, -4 + 20j)], 4.0))
    assert limits.inner_radius == pytest.approx(16 / 6, rel=1e-3)
    assert limits.inner_place == pytest.approx(4j, abs=0.05)
    assert limits.diameter == pytest.approx(32 / 6, rel=1e-3)


@pytest.mark.parametrize("teeth", [12, 36])
def test_a_wheel_s_spaces_are_slots(teeth: int) -> None:
    """The root corners of a space are its narrowest place that faces; radial walls part outwards.

    Unsquashed, the walls stand symmetrically about the space and lean outwards by half its angle.
    """
    contour = gear_contour(teeth, 5.0, squash=(1.0, 1.0), angle=0.0)
    root, alpha = (teeth / 2 - 1.25) * 5.0, math.radians(20.0)
    base = teeth * 2.5 * math.cos(alpha)
    grow = math.tan(math.acos(base / root)) - math.acos(base / root) if root > base else 0.0
    half_tooth = math.pi / (2 * teeth) + math.tan(alpha) - alpha - grow
    space = 2 * root * math.sin(math.pi / teeth - half_tooth)
    limits = tool_limits(contour)
    # the disc that touches a wall in its corner passes the other: a little wider than the corners
    assert space <= limits.slot <= 1.3 * space
    assert limits.slot_place is not None
    assert root - space < abs(limits.slot_place) < root + 2 * space


@pytest.mark.parametrize("contour", [disc_contour(10.0), square_contour(20.0)])
def test_convex_outlines_limit_no_tool(contour: Contour) -> None:
    limits = tool_limits(contour)
    assert limits == ToolLimits(
        inner_radius=math.inf, inner_place=None, slot=math.inf, slot_place=None
    )
    assert limits.as_dict() == {}


@pytest.mark.parametrize("radius", [0.5, 2.0])
def test_a_rounded_groove(radius: float) -> None:
    limits = tool_limits(groove(math.radians(80.0), radius))
    assert limits.inner_radius == pytest.approx(radius, rel=1e-4)
    assert limits.diameter == pytest.approx(2 * radius, rel=2e-3)
    assert limits.inner_place is not None
    assert abs(limits.inner_place - 8j) == pytest.approx(radius, abs=1e-3)


@pytest.mark.parametrize(
    "contour",
    [
        u_slot(4.0, 8.0),
        keyhole(3.0, 2.0, 4.0),
        groove(math.radians(80.0), 2.0),
        slit_disc(20.0, 3.0, 2.0),
    ],
    ids=["slot", "keyhole", "groove", "slit disc"],
)
def test_a_disc_of_that_size_passes_and_a_larger_one_does_not(contour: Contour) -> None:
    """The sharpest place is the closing's: chords of the polygon alone leave less than 1e-6."""
    diameter = tool_limits(contour).diameter
    assert closing(contour, 0.999 * diameter) < 2e-6
    assert closing(contour, 1.02 * diameter) > 1e-5


def three_slots() -> Contour:
    """Three round-bottomed slots, of which the middle one is the narrowest."""
    pieces: list[Curve] = [line(-20 - 20j, 20 - 20j), line(20 - 20j, 20 + 20j)]
    at = 20.0
    for centre, half in ((12.0, 3.0), (0.0, 1.25), (-12.0, 2.0)):
        pieces += [
            line(at + 20j, centre + half + 20j),
            line(centre + half + 20j, centre + half + 10j),
            arc(centre + 10j, half, 0.0, -math.pi),
            line(centre - half + 10j, centre - half + 20j),
        ]
        at = centre - half
    pieces += [line(at + 20j, -20 + 20j), line(-20 + 20j, -20 - 20j)]
    return contour_of(pieces, TOLERANCE)


def test_the_smallest_of_many_radii_is_found() -> None:
    limits = tool_limits(three_slots())
    assert limits.inner_radius == pytest.approx(1.25, rel=1e-4)
    assert limits.inner_place is not None
    assert abs(limits.inner_place.real) <= 1.25


def test_the_narrowest_of_many_slots_is_found() -> None:
    limits = tool_limits(three_slots())
    assert limits.slot == pytest.approx(2.5, abs=1e-7)
    assert limits.slot_place is not None
    assert limits.slot_place.real == pytest.approx(0.0, abs=1e-9)


def test_what_is_told_of_a_tool() -> None:
    made = tool_limits(u_slot(4.0, 8.0)).as_dict()
    assert list(made) == [
        "largest_diameter_mm", "inner_radius_mm", "at_mm", "slot_mm", "slot_at_mm",
    ]  # fmt: skip
    assert made["largest_diameter_mm"] == min(2 * made["inner_radius_mm"], made["slot_mm"])
    only = ToolLimits(inner_radius=1.0, inner_place=1.0 + 2.0j, slot=math.inf, slot_place=None)
    assert only.as_dict() == {
        "largest_diameter_mm": 2.0, "inner_radius_mm": 1.0, "at_mm": [1.0, 2.0]
    }  # fmt: skip
    assert np.isinf(only.slot)
