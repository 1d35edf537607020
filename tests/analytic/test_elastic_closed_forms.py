"""Stresses and displacements of elastic bodies in closed form: holes, a membrane, rollers."""

from __future__ import annotations

import math
from typing import Any

import numpy as np
import pytest

from gearcam.parts.shapes import Circle
from gearcam.stress.certify import indicators, marked
from gearcam.stress.elastic import CurvedMesh, ElasticBody, PlaneModuli, edge_shapes, edge_slopes
from gearcam.stress.fillet import StressPeak, edge_stress, mean_stress, peak
from gearcam.stress.hertz_load import deflections, flank_load, nodal_forces
from gearcam.stress.mesh import graded
from gearcam.stress.region import BoundaryCurve, Region, arc_run, curve_of
from helpers_elastic import (
    UNIT,
    edge_forces,
    ellipse,
    floating,
    largest_tension,
    plate_with_hole,
    square_with,
)
from witness.elasticity import disc_approach, hole_in_plate


def right_peak(body: ElasticBody, moved: Any) -> StressPeak:
    """The largest tension on the right half of a hole."""
    edge = edge_stress(body, moved, 1)
    return peak(edge, edge.curve.at(edge.s)[0].real > 0.0, 1)


def factor_at_hole(a: float, size: float, within: float, most: int) -> float:
    """The stress at the end of a hole of half-axes a and 1, the mesh refined for it."""
    region = square_with(ellipse(a, 1.0), 5.0 * a)
    mesh = CurvedMesh.of(graded(region, np.array([a + 0j]), np.array([size]), a))
    found = math.nan
    while 2 * len(mesh.nodes) <= most:
        body, moved = plate_with_hole(mesh, a, 1.0)
        top = right_peak(body, moved[:, 0])
        found = top.stress
        dual = body.displacements(mean_stress(body, 1, top.s, within)[:, None])
        errors = indicators(body, np.concatenate([moved, dual], axis=1))
        mesh = mesh.refined(marked(errors[0] * errors[1]))
    return found


def test_the_witness_of_holes_is_free_of_traction_and_kirschs() -> None:
    t = np.linspace(0.05, 6.3, 40)
    for a, b in ((1.0, 1.0), (3.0, 1.0), (1.0, 2.0)):
        z, out = a * np.cos(t) + 1j * b * np.sin(t), b * np.cos(t) + 1j * a * np.sin(t)
        xx, yy, xy = hole_in_plate(z, a, b)
        assert np.abs(xx * out.real + xy * out.imag).max() < 1e-12
        assert np.abs(xy * out.real + yy * out.imag).max() < 1e-12
        peak_of = hole_in_plate(np.array([a + 0j]), a, b)[1, 0]
        assert peak_of == pytest.approx(1.0 + 2.0 * a / b, rel=1e-12)
    xx, yy, _ = hole_in_plate(np.array([1j, 2.0 + 0j]), 1.0, 1.0)
    assert xx[0] == pytest.approx(-1.0)
    assert yy[1] == pytest.approx(1.0 + 0.5 / 4.0 + 1.5 / 16.0)  # Kirsch


def test_a_round_hole_triples_the_stress() -> None:
    """Kirsch 1898."""
    assert factor_at_hole(1.0, 0.1, 0.05, 5_000) == pytest.approx(3.0, abs=1.5e-3)


@pytest.mark.slow
@pytest.mark.parametrize("a", [1.0, 2.0, 3.0, 5.0])
def test_elliptic_holes_have_the_stress_of_inglis(a: float) -> None:
    exact = 1.0 + 2.0 * a
    assert factor_at_hole(a, 0.2 / a, 0.05 / a, 60_000) == pytest.approx(exact, rel=1e-4)


def test_an_elliptic_hole_has_the_stress_of_inglis() -> None:
    """With a third of the slow test's unknowns, and within 1e-3."""
    assert factor_at_hole(3.0, 0.06, 0.02, 8_500) == pytest.approx(7.0, rel=1e-3)


def membrane(pull: float) -> float:
    """NAFEMS' membrane between two ellipses, all around, pulled outwards at its edge, MPa."""
    steel = PlaneModuli(young=210e3, poisson=0.3, plane="stress")
    region = Region(outer=ellipse(3.25, 2.75), holes=(ellipse(2.0, 1.0).reversed,))
    mesh = CurvedMesh.of(graded(region, np.array([2.0 + 0j, -2.0]), np.full(2, 0.02), 0.4))
    body = floating(mesh, steel, -3.25, 3.25)

    def outwards(z: Any) -> Any:
        return np.stack([pull + 0.0 * z.real, pull + 0.0 * z.real, 0.0 * z.real])

    moved = body.displacements(edge_forces(mesh, 0, outwards)[:, None])[:, 0]
    return largest_tension(body, moved, 1).stress


def test_nafems_membrane() -> None:
    """Benchmark LE1 (NAFEMS, The Standard NAFEMS Benchmarks, 1990): 92.7 MPa at D."""
    assert membrane(10.0) == pytest.approx(92.7, rel=1e-3)


def loaded_disc(a: float, size: float, finer: int = 0) -> tuple[ElasticBody, Any, Any]:
    """A disc of radius 1 between two unit forces of this half-width: forces, displacements.

    Triangles are of a size beside the forces, in half-widths, and divided `finer` times near one.
    """
    region = Region(outer=curve_of(Circle(center=0j, diameter=2.0)))
    ends = ((1j, -1j), (-1j, 1j))
    loads = [flank_load(region, point, way, 1.0, half_width=a) for point, way in ends]
    across = np.linspace(-1.0, 1.0, 9) * a
    sources = np.concatenate([region.outer.at(load.place + across)[0] for load in loads])
    mesh = CurvedMesh.of(graded(region, sources, np.full(len(sources), size * a), 0.2))
    for _ in range(finer):
        middles = mesh.points[mesh.triangles].mean(axis=1)
        mesh = mesh.refined(np.flatnonzero(np.abs(middles - 1j) < 1.5 * a))
    body = floating(mesh, UNIT, -1.0, 1.0)
    forces = nodal_forces(mesh, loads)
    return body, forces, body.displacements(forces.sum(axis=1, keepdims=True))


@pytest.mark.parametrize("a", [0.1, 0.05, 0.02, 0.01])
def test_a_disc_gives_way_as_johnson_has_it(a: float) -> None:
    """The middle of Hertz's arc sinks by F*(1 - nu^2)/(2*pi*E) more than the mean under it."""
    body, forces, moved = loaded_disc(a, 0.25)
    mean = deflections(forces, moved).mean()
    assert mean + 0.91 / (2.0 * math.pi) == pytest.approx(disc_approach(a, 0.3), rel=5e-4)
    nodes = body.mesh.nodes[body.shapes.nodes[:, :3]].mean(axis=1)
    middle = body.stress(moved)[:, 0, int(np.abs(nodes).argmin())].mean(axis=1)
    assert middle == pytest.approx([1.0 / math.pi, -3.0 / math.pi, 0.0], abs=0.012)


def test_below_a_line_contact_the_stress_is_that_of_huber_and_fuchs() -> None:
    """Largest von Mises stress 0.5575 p0, 0.704 a deep (Poisson's ratio 0.3, plane strain)."""
    a = 0.01
    body, _, moved = loaded_disc(a, 0.25, finer=2)
    nodes, values, _, _ = body.shapes
    z = body.mesh.nodes[nodes] @ values
    near = (np.abs(z.real) < 0.1 * a) & (z.imag > 0.0)
    xx, yy, xy = body.stress(moved)[:, 0][:, near]
    across = 0.3 * (xx + yy)
    mises = np.sqrt(0.5 * ((xx - yy) ** 2 + (yy - across) ** 2 + (across - xx) ** 2) + 3.0 * xy**2)
    pressure = 2.0 / (math.pi * a)
    assert mises.max() / pressure == pytest.approx(0.557516, rel=0.01)
    deep = 1.0 - z.imag[near][mises.argmax()]
    assert deep / a == pytest.approx(0.704, abs=0.1)


def half_disc(a: float) -> tuple[ElasticBody, Any]:
    """The lower half of a disc of radius 1, held at its diameter; nodes that may touch a flat."""
    outer = BoundaryCurve(runs=(arc_run(-1.0 + 0j, 1.0 + 0j, 1.0), arc_run(1.0 + 0j, -1.0 + 0j)))
    sources = -1j * np.exp(1.6j * a * np.linspace(-1.0, 1.0, 33))
    mesh = CurvedMesh.of(graded(Region(outer=outer), sources, np.full(33, 0.05 * a), 0.2))
    diameter = np.flatnonzero(np.abs(mesh.nodes.imag) < 1e-12)
    middle = diameter[np.abs(mesh.nodes[diameter]).argmin()]
    held = np.append(2 * diameter + 1, 2 * middle)
    edge = np.unique(mesh.edges[np.abs(mesh.nodes[mesh.edges] + 1j).max(axis=1) < 1.5 * a])
    return ElasticBody(mesh=mesh, moduli=UNIT, held=held), edge


def pressed(body: ElasticBody, edge: Any, sunk: float) -> Any:
    """Forces on nodes that a rigid flat pushes up by `sunk` at the lowest: contact, no tension."""
    forces = np.zeros((len(body.mesh.nodes), len(edge)), dtype=complex)
    forces[edge, np.arange(len(edge))] = 1j
    gives = body.displacements(forces)[edge].imag
    wanted = sunk - (body.mesh.nodes[edge].imag + 1.0)
    touching, force = np.ones(len(edge), dtype=bool), np.zeros(len(edge))
    for _ in range(30):
        force = np.zeros(len(edge))
        force[touching] = np.linalg.solve(gives[np.ix_(touching, touching)], wanted[touching])
        new = np.where(touching, force > 0.0, wanted - gives @ force > 0.0)
        if np.array_equal(new, touching):
            return force
        touching = new
    raise AssertionError("contact was not found")


def test_a_disc_on_a_rigid_flat_has_the_pressure_of_hertz() -> None:
    """Force, half-width and largest pressure, none of them assumed, from how far it sinks."""
    a, give = 0.03, 4.0 * 0.91 / math.pi
    body, edge = half_disc(a)
    force = pressed(body, edge, a * a / give * disc_approach(a, 0.3))
    total, x = force.sum(), body.mesh.nodes[edge].real
    assert total == pytest.approx(a * a / give, rel=5e-4)
    width = math.sqrt(give * total)
    assert 2.0 * math.sqrt((force * x * x).sum() / total) == pytest.approx(width, rel=1e-3)
    # the pressure of which the forces are the integrals with the shape functions
    mesh, (at, weights) = body.mesh, np.polynomial.legendre.leggauss(4)
    mass = np.zeros((len(edge), len(edge)))
    for nodes in mesh.edges[np.isin(mesh.edges, edge).all(axis=1)]:
        rows = np.searchsorted(edge, nodes)
        speed = np.abs(edge_slopes(at) @ mesh.nodes[nodes])
        mass[np.ix_(rows, rows)] += (edge_shapes(at).T * weights * speed) @ edge_shapes(at)
    pressure = np.linalg.solve(mass, force)
    inner = np.abs(x) < 0.5 * width
    shape = pressure[inner] / np.sqrt(1.0 - (x[inner] / width) ** 2)
    assert shape.mean() == pytest.approx(2.0 * total / (math.pi * width), rel=1e-3)
    assert shape == pytest.approx(shape.mean(), rel=0.01)
