"""Mass, centroid, unbalance and inertia: closed forms, and the mass properties of the mesh."""

from __future__ import annotations

import math
from collections.abc import Callable
from functools import cache
from itertools import pairwise

import numpy as np
import pytest
import trimesh

from gearcam.numeric.contour import Contour
from gearcam.parts.blank import WheelBlank
from gearcam.parts.body import Hub, Mark, Opening, Part
from gearcam.parts.make import make_part
from gearcam.parts.mass import mass_properties
from gearcam.parts.openings import Workpiece
from gearcam.parts.shapes import Circle
from gearcam.parts.solids import solid
from helpers_contour import arc, bore, contour_of, disc_contour, square_contour
from helpers_pairs import profile

STEEL = 7850.0
EXACT = 1e-9
"""Of the dense points: they stand for curves to a part in 1e9."""


def hole(x: float, y: float, diameter: float) -> Opening:
    return Opening(kind="HOLE", shape=Circle(center=complex(x, y), diameter=diameter), name="hole")


def cylinder(diameter: float, low: float, high: float, at: complex = 0j) -> np.ndarray:
    """Volume, first moments x, y, z and polar moment about the axis of a cylinder along z."""
    area, height = math.pi * diameter**2 / 4, high - low
    polar = area * (diameter**2 / 8 + abs(at) ** 2)
    middle = (low + high) / 2
    return area * height * np.array([1.0, at.real, at.imag, middle, polar / area])


def plate(side: float, height: float) -> np.ndarray:
    return side**2 * height * np.array([1.0, 0.0, 0.0, height / 2, side**2 / 6])


def demand(part: Part, wanted: np.ndarray, within: float = EXACT, density: float = STEEL) -> None:
    """Compare with volume, first moments and polar moment."""
    made = mass_properties(part, density)
    volume, *first, polar = wanted
    size = math.sqrt(polar / volume)
    assert made.volume == pytest.approx(volume, rel=within)
    assert part.volume == pytest.approx(volume, rel=within)
    assert made.mass == pytest.approx(density * volume * 1e-9, rel=within)
    assert np.array(made.centroid) == pytest.approx(np.array(first) / volume, abs=within * size)
    assert made.inertia == pytest.approx(density * polar * 1e-9, rel=within)
    off = math.hypot(first[0], first[1])
    assert made.unbalance == pytest.approx(
        density * off * 1e-6, abs=within * size * made.mass * 1e3
    )


def test_a_steel_disc_of_a_known_weight() -> None:
    """100 mm across and 10 mm thick, 7850 kg/m^3: 0.61654 kg, m*r^2/2 about the axis."""
    made = mass_properties(Part(name="p", contours=(disc_contour(50.0),), width=10.0), STEEL)
    assert made.mass == pytest.approx(0.6165375582669, rel=EXACT)
    assert made.inertia == pytest.approx(0.6165375582669 * 2500 / 2, rel=EXACT)
    assert made.unbalance < 1e-6
    assert made.centroid[2] == 5.0


def test_a_disc_with_everything() -> None:
    """Bore, hub on both sides, a hole beside the hub, one through it, and a mark."""
    part = Part(
        name="p",
        contours=(disc_contour(50.0),),
        width=12.0,
        openings=(*bore(20.0), hole(30.0, -10.0, 9.0), hole(0.0, 14.0, 4.0)),
        hub=Hub(diameter=40.0, front=7.0, back=3.0),
        marks=(Mark(center=complex(-38.0, 2.0), diameter=3.0, depth=0.5),),
    )
    wanted = cylinder(100.0, 0.0, 12.0) + cylinder(40.0, 12.0, 19.0) + cylinder(40.0, -3.0, 0.0)
    wanted -= cylinder(20.0, -3.0, 19.0) + cylinder(4.0, -3.0, 19.0, 14j)
    wanted -= cylinder(9.0, 0.0, 12.0, 30 - 10j) + cylinder(3.0, 11.5, 12.0, -38 + 2j)
    demand(part, wanted)


def test_a_hole_that_is_forgotten_is_found() -> None:
    """The control: a hole of a millimetre in a plate of 100."""
    part = Part(name="p", contours=(disc_contour(50.0),), width=12.0, openings=(hole(30, 0, 1.0),))
    demand(part, cylinder(100.0, 0.0, 12.0) - cylinder(1.0, 0.0, 12.0, 30 + 0j))
    with pytest.raises(AssertionError):
        demand(part, cylinder(100.0, 0.0, 12.0))


@pytest.mark.parametrize("angle", [0.0, 2.0])
def test_a_keyway_is_off_the_axis(angle: float) -> None:
    """Bore 20, keyway 6 x 2.8: rectangle less the bore's own segment, moments of both."""
    blank = WheelBlank(
        bore_diameter=20.0, keyway_width=6.0, keyway_depth=2.8, keyway_angle=angle,
        timing_marks=False,
    )  # fmt: skip
    place = Workpiece(name="wheel 1", wheel=1, rim=5.4)
    part = make_part("p", [disc_contour(50.0)], 8.0, blank, place)
    r, h, floor = 10.0, 3.0, 12.8
    # beyond the bore's circle: integral of x over the strip abs(y) < h from the circle to the floor
    under = h * math.sqrt(r**2 - h**2) + r**2 * math.asin(h / r)
    area = 2 * h * floor - under
    first = h * floor**2 - (r**2 * h - h**3 / 3)
    x2 = 2 * h * floor**3 / 3 - simpson(lambda y: 2 * (r**2 - y**2) ** 1.5 / 3, 0.0, h)
    y2 = 2 * floor * h**3 / 3 - simpson(lambda y: 2 * y**2 * np.sqrt(r**2 - y**2), 0.0, h)
    cut = np.array([area, first * math.cos(angle), first * math.sin(angle), 4.0 * area, x2 + y2])
    demand(part, cylinder(100.0, 0.0, 8.0) - cylinder(20.0, 0.0, 8.0) - 8.0 * cut)
    made = mass_properties(part, STEEL)
    assert math.cos(made.direction - angle) == pytest.approx(-1.0, abs=1e-9), "away from the keyway"
    assert made.unbalance == pytest.approx(8.0 * first * STEEL * 1e-6, rel=1e-6)


def simpson(function: Callable[[np.ndarray], np.ndarray], low: float, high: float) -> float:
    """Integral by 200 parabolas."""
    x = np.linspace(low, high, 401)
    y = function(x)
    return float((high - low) / 1200 * (y[0] + y[-1] + 4 * y[1::2].sum() + 2 * y[2:-1:2].sum()))


@pytest.mark.parametrize("steps", [1, 2, 5])
def test_steps_stand_one_above_the_other(steps: int) -> None:
    """Square plates of growing sides: a pyramid of steps."""
    sides = [10.0 * (k + 1) for k in range(steps)]
    height = 15.0 / steps
    part = Part(name="p", contours=tuple(square_contour(s) for s in sides), width=15.0)
    wanted = np.zeros(5)
    for k, side in enumerate(sides):
        one = plate(side, height)
        one[3] += one[0] * k * height
        wanted += one
    demand(part, wanted, 1e-12)


def eccentric(radius: float, away: complex) -> Contour:
    thirds = [2 * math.pi * k / 3 for k in range(4)]
    return contour_of([arc(away, radius, a, b) for a, b in pairwise(thirds)], 1e-3)


@pytest.mark.parametrize("away", [1 + 0j, -3 + 4j, 0.001j])
def test_an_eccentric_disc_is_unbalanced_by_mass_times_eccentricity(away: complex) -> None:
    part = Part(name="p", contours=(eccentric(30.0, away),), width=6.0)
    made = mass_properties(part, STEEL)
    grams = math.pi * 30**2 * 6 * STEEL * 1e-6
    assert made.mass * 1e3 == pytest.approx(grams, rel=EXACT)
    assert made.unbalance == pytest.approx(grams * abs(away), rel=1e-6, abs=grams * 1e-7)
    assert made.eccentricity == pytest.approx(abs(away), abs=1e-7)
    assert made.direction == pytest.approx(math.atan2(away.imag, away.real), abs=1e-4)
    assert made.inertia == pytest.approx(grams * 1e-3 * (450 + abs(away) ** 2), rel=EXACT)


def test_a_toothed_eccentric_circle_is_off_by_its_eccentricity() -> None:
    """The teeth are those of a circular wheel, nearly: the same part of the radius all around."""
    made = profile("eccentric_circle")
    radii = np.abs(made.gear1.outline @ [1, 1j])
    away = (radii.max() - radii.min()) / 2
    properties = mass_properties(
        Part(name="p", contours=(made.gear1.profile.contour,), width=5.0), STEEL
    )
    centre = made.pair.rolling.tracks[0].frames(np.linspace(0, 2 * math.pi, 721)).p
    pitch = 0.5 * (centre.real.max() + centre.real.min())
    assert properties.centroid[0] == pytest.approx(pitch, abs=0.05 * abs(pitch))
    assert abs(properties.centroid[1]) < 0.05 * abs(pitch)
    assert properties.unbalance == pytest.approx(
        properties.mass * 1e3 * abs(complex(*properties.centroid[:2])), rel=1e-12
    )
    assert away > 0.5 * abs(pitch)


@cache
def wheel(tolerance: float | None = None) -> Part:
    """A non-circular wheel with a hub, a keyway, holes and a mark."""
    made = profile("bspline", tolerance)
    blank = WheelBlank(
        bore_diameter=14.0, keyway_width=5.0, keyway_depth=2.3, keyway_angle=0.4,
        hub_diameter=22.0, hub_front=6.0, hub_back=2.0, bolts=3, bolt_circle=30.0,
        bolt_diameter=3.0, bolt_angle=0.3, clearance=0.05, clearance_bores=True,
    )  # fmt: skip
    mark = Mark(center=complex(0.0, -18.0), diameter=1.5, depth=0.6)
    return make_part(
        "g",
        [made.gear1.profile.contour],
        9.0,
        blank,
        Workpiece(name="wheel 1", wheel=1, rim=5.4),
        lambda: mark,
    )


def of_mesh(part: Part) -> trimesh.Trimesh:
    made = solid(part)
    return trimesh.Trimesh(vertices=made.vertices, faces=made.triangles, process=False)


def test_a_wheel_weighs_what_its_mesh_does() -> None:
    """Chords bound what the mesh misses: error times boundary, at most the outer radius away."""
    part = wheel()
    mesh, made = of_mesh(part), mass_properties(part, STEEL)
    assert mesh.is_watertight
    edges = part.contour.polygon.length + sum(o.shape.length for o in part.openings)
    edges += math.pi * 22.0 + math.pi * 1.5
    missed = edges * part.tolerance * part.thickness
    far = float(np.hypot(*part.contour.vertices.T).max())
    assert made.volume == pytest.approx(mesh.volume, abs=missed)
    away = np.array(made.centroid) * made.volume - mesh.center_mass * mesh.volume
    assert np.abs(away).max() < missed * far
    # trimesh gives inertia about the origin by the parallel axis theorem, density 1
    about = mesh.moment_inertia[2, 2] + mesh.volume * float(np.hypot(*mesh.center_mass[:2])) ** 2
    assert made.inertia / (STEEL * 1e-9) == pytest.approx(about, abs=missed * far**2)
    # much nearer than the bound: chords miss less than a tolerance, inside and outside alike
    assert made.volume == pytest.approx(mesh.volume, rel=1e-4)
    assert np.array(made.centroid) == pytest.approx(mesh.center_mass, abs=2e-3)
    assert made.inertia / (STEEL * 1e-9) == pytest.approx(about, rel=2e-4)


def test_a_wheel_weighs_what_its_curves_enclose_not_its_chords() -> None:
    """With chords 16 times nearer the mesh misses much less, and the wheel weighs the same."""
    coarse, fine = (wheel(tolerance) for tolerance in (0.032, 0.002))
    volumes = [mass_properties(part, STEEL).volume for part in (coarse, fine)]
    assert volumes[0] == pytest.approx(volumes[1], rel=1e-8)
    missed = [of_mesh(part).volume - volumes[1] for part in (coarse, fine)]
    assert 0.2 * abs(missed[0]) > abs(missed[1]) > 1e-5 * volumes[1]


def test_the_mesh_finds_a_missing_bolt_hole() -> None:
    """The control of the comparison with the mesh."""
    part = wheel()
    fewer = tuple(o for o in part.openings if o.name != "bolt hole 2")
    other = Part(
        name="g", contours=part.contours, width=part.width, openings=fewer, hub=part.hub,
        marks=part.marks,
    )  # fmt: skip
    mesh, made = of_mesh(part), mass_properties(other, STEEL)
    assert abs(made.volume - mesh.volume) > 1e-3 * mesh.volume
    assert np.abs(np.array(made.centroid) - mesh.center_mass).max() > 1e-2


def test_density_scales_mass_and_inertia_only() -> None:
    one, three = (mass_properties(wheel(), density) for density in (1000.0, 3000.0))
    assert three.mass == pytest.approx(3 * one.mass, rel=1e-14)
    assert three.inertia == pytest.approx(3 * one.inertia, rel=1e-14)
    assert three.unbalance == pytest.approx(3 * one.unbalance, rel=1e-14)
    assert (three.volume, three.centroid) == (one.volume, one.centroid)
    made = one.as_dict()
    assert made["unbalance_g_mm"] == pytest.approx(
        1e3 * made["mass_kg"] * math.hypot(*made["centroid_mm"][:2])
    )
    assert math.radians(made["unbalance_direction_deg"]) == pytest.approx(one.direction)
