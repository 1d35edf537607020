"""Sections cut what the part is: areas in closed form, and those of its mesh."""

from __future__ import annotations

import math
from dataclasses import replace

import numpy as np
import pytest

from gearcam.numeric.arrays import Plane
from gearcam.parts.body import Hub, Layer, Opening, Part, Recess
from gearcam.parts.shapes import Circle
from gearcam.parts.solids import solid
from gearcam.sheets.sections import Section, mesh_loops
from gearcam.sheets.sheet import Hatch
from helpers_contour import disc_contour, gear_contour


def area(loops: list[Plane]) -> float:
    """Of loops that may run either way, holes the other way than what they are in."""
    return abs(sum(0.5 * float((np.conj(one) * np.roll(one, -1)).imag.sum()) for one in loops))


def section(part: Part, x: float = 0.0) -> Section:
    return Section(layers=part.layers, pockets=part.pockets, x=x, tolerance=part.tolerance)


BORE = Opening(kind="BORE", shape=Circle(center=0j, diameter=12.0), name="bore")
HOLE = Opening(kind="HOLE", shape=Circle(center=20j, diameter=8.0), name="hole")
DISC = Part(
    name="disc",
    contours=(disc_contour(30.0, 1e-5),),
    width=10.0,
    openings=(BORE, HOLE),
    hub=Hub(diameter=20.0, front=6.0),
    recesses=(
        Recess(
            edge=Circle(center=0j, diameter=56.0),
            openings=(Opening(kind="INNER", shape=Circle(center=0j, diameter=50.0), name="i"),),
            low=7.0,
            high=10.0,
            width=3.0,
            place=0j,
        ),
    ),
)


@pytest.mark.parametrize("x", [0.0, 3.0])
def test_the_area_of_a_section_is_that_of_its_parts(x: float) -> None:
    def chord(diameter: float) -> float:
        return 2.0 * math.sqrt(0.25 * diameter**2 - x**2)

    plate = 10.0 * (chord(60.0) - chord(12.0) - chord(8.0))
    hub = 6.0 * (chord(20.0) - chord(12.0))
    groove = 3.0 * (chord(56.0) - chord(50.0))
    assert area(section(DISC, x).metal) == pytest.approx(plate + hub - groove, abs=2e-2)


def test_a_section_beside_a_hole_does_not_show_it() -> None:
    ends = section(DISC, 4.5).slabs[0][0]
    assert ends.shape == (2, 4)  # two pairs: beside the bore, not the hole


@pytest.mark.parametrize("make", [lambda: DISC, lambda: Part(
    name="g", contours=(gear_contour(24, 2.0),), width=9.0, openings=(BORE,)
)])  # fmt: skip
def test_the_mesh_has_the_same_section(make) -> None:
    part = make()
    loops = mesh_loops(solid(part))
    assert area(loops) == pytest.approx(area(section(part).metal), rel=1e-4)
    assert max(float(one.real.max()) for one in loops) == pytest.approx(part.ends[1])


def test_visible_edges_are_those_of_faces_and_steps() -> None:
    """Of a disc with a bore: both faces, the outside above and below, the bore above and below."""
    plain = replace(DISC, openings=(BORE,), hub=None, recesses=())
    lines = sorted({(round(a.real, 3), round(a.imag, 3)) for a, _ in section(plain).lines})
    assert lines == [(0.0, -30.0), (0.0, -6.0), (0.0, 6.0), (0.0, 30.0), (10.0, -30.0)]
    upright = [(a, b) for a, b in section(plain).lines if a.real == b.real]
    assert sum(abs(b - a) for a, b in upright) == pytest.approx(2 * 60.0, abs=1e-3)


def test_no_edge_is_seen_within_the_metal_between_plate_and_hub() -> None:
    plain = replace(DISC, openings=(BORE,), recesses=())
    at_hub = [(a, b) for a, b in section(plain).lines if a.real == b.real == 10.0]
    reach = sorted((round(a.imag, 3), round(b.imag, 3)) for a, b in at_hub)
    assert reach == [(-30.0, -10.0), (10.0, 30.0)]


def test_a_hatch_covers_its_loops() -> None:
    """The lengths of lines a gap apart, times the gap, are the area."""
    square = np.array([0.0, 40.0, 40.0 + 30.0j, 30.0j])
    island = np.array([10.0 + 10.0j, 20.0 + 10.0j, 20.0 + 20.0j, 10.0 + 20.0j])
    lines = [*Hatch(loops=(square, island)).lines(0.05)]
    length = sum(abs(line[1] - line[0]) for line in lines)
    assert 0.05 * length == pytest.approx(40.0 * 30.0 - 100.0, rel=1e-3)
    assert np.angle(lines[7][1] - lines[7][0]) % np.pi == pytest.approx(np.pi / 4)


def test_a_layer_between_two_heights_is_cut_once() -> None:
    layer = Layer(edge=Circle(center=0j, diameter=10.0), low=2.0, high=5.0)
    cut = Section(layers=[layer], pockets=[], x=0.0, tolerance=1e-6)
    assert cut.heights == [2.0, 5.0]
    assert area(cut.metal) == pytest.approx(30.0, abs=1e-4)
