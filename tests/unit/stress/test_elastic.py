"""Plane elasticity: what it must give exactly, and what scikit-fem assembles."""

from __future__ import annotations

from dataclasses import replace
from typing import Any

import numpy as np
import pytest

from gearcam.parts.shapes import Circle
from gearcam.stress.elastic import CurvedMesh, ElasticBody, PlaneModuli
from gearcam.stress.mesh import graded
from gearcam.stress.region import Region, curve_of
from helpers_elastic import STEEL, edge_forces, ellipse, floating, square_with

STATE = np.array([2.0, -1.0, 0.7])
"""A uniform stress, MPa."""


@pytest.fixture(scope="module")
def ring() -> CurvedMesh:
    """A disc with an eccentric hole, held there."""
    outer = curve_of(Circle(center=0j, diameter=20.0))
    hole = curve_of(Circle(center=2.0 + 1.0j, diameter=6.0), hole=True, held=True)
    region = Region(outer=outer, holes=(hole,))
    sources = np.array([10.0 + 0j, -1.0 + 1.0j, 5.0 + 1.0j])
    return CurvedMesh.of(graded(region, sources, np.full(3, 0.5), 2.0))


def uniform(z: Any) -> Any:
    return STATE.reshape(3, *np.ones(z.ndim, dtype=int)) * np.ones(z.shape)


@pytest.mark.parametrize("plane", ["strain", "stress"])
def test_a_uniform_stress_is_exact_on_curved_triangles(ring: CurvedMesh, plane: str) -> None:
    moduli = replace(STEEL, plane=plane)
    body = floating(ring, moduli, -10.0, 10.0)
    forces = edge_forces(ring, 0, uniform) + edge_forces(ring, 1, uniform)
    moved = body.displacements(forces[:, None])
    for at_nodes in (False, True):
        stress = body.stress(moved, at_nodes=at_nodes)
        assert stress == pytest.approx(STATE[:, None, None, None] * np.ones(stress.shape), abs=1e-9)


def test_a_motion_as_a_whole_needs_no_force(ring: CurvedMesh) -> None:
    body = ElasticBody(mesh=ring, moduli=STEEL)
    turned = 1e-3j * ring.nodes + (0.3 - 0.2j)
    assert body.stress(turned[:, None]) == pytest.approx(0.0, abs=1e-8)
    unknowns = np.stack([turned.real, turned.imag], axis=1).ravel()
    assert np.abs(body.stiffness @ unknowns).max() < 1e-9 * STEEL.young


def test_a_wheel_is_held_where_its_region_says(ring: CurvedMesh) -> None:
    body = ElasticBody(mesh=ring, moduli=STEEL)
    forces = np.zeros((len(ring.nodes), 1), dtype=complex)
    forces[np.abs(ring.nodes - 10.0).argmin()] = 100.0
    moved = body.displacements(forces)[:, 0]
    on_hole = np.abs(np.abs(ring.nodes - 2.0 - 1.0j) - 3.0) < 1e-9
    assert np.array_equal(moved == 0.0, on_hole)
    assert on_hole.sum() > 20


def test_the_stiffness_is_that_of_scikit_fem(ring: CurvedMesh) -> None:
    """Another assembly of the same form on the same mesh."""
    from skfem import Basis, BilinearForm, ElementTriP2, ElementVector, MeshTri2
    from skfem.helpers import ddot, sym_grad, trace

    @BilinearForm
    def form(u, v, _):
        strain, test = sym_grad(u), sym_grad(v)
        return STEEL.lame * trace(strain) * trace(test) + 2.0 * STEEL.shear * ddot(strain, test)

    plain = MeshTri2.from_mesh(ring._straight)
    places = np.stack([ring.nodes.real, ring.nodes.imag])
    assert np.abs(places - plain.doflocs).max() > 1e-3  # curved
    basis = Basis(replace(plain, doflocs=places), ElementVector(ElementTriP2()), intorder=5)
    theirs = form.assemble(basis).tocsc()
    # their unknowns: two of each corner, then two of each edge, in the order of nodes
    mine = ElasticBody(mesh=ring, moduli=STEEL).stiffness
    assert abs(mine - theirs).max() < 1e-12 * abs(theirs).max()


def test_work_is_mutual(ring: CurvedMesh) -> None:
    """Betti: the work of one load on the displacements of another is that of the other on its."""
    body = ElasticBody(mesh=ring, moduli=STEEL)
    rng = np.random.default_rng(5)
    forces = np.zeros((len(ring.nodes), 3), dtype=complex)
    some = rng.choice(len(ring.nodes), 12, replace=False)
    forces[some] = rng.normal(size=(12, 3)) + 1j * rng.normal(size=(12, 3))
    work = (forces.conj().T @ body.displacements(forces)).real
    assert work == pytest.approx(work.T, rel=1e-9)
    assert np.linalg.eigvalsh(work).min() > 0.0


@pytest.mark.parametrize("plane", ["strain", "stress"])
def test_moduli_agree_with_hookes_law_in_space(plane: str) -> None:
    moduli = PlaneModuli(young=70000.0, poisson=0.33, plane=plane)  # type: ignore[arg-type]
    strain = np.array([1e-3, -4e-4, 3e-4])  # xx, yy, xy
    trace = moduli.lame * (strain[0] + strain[1])
    stress = 2.0 * moduli.shear * strain + np.array([trace, trace, 0.0])
    young, nu = 70000.0, 0.33
    across = nu * (stress[0] + stress[1]) if plane == "strain" else 0.0
    back = [(stress[0] - nu * (stress[1] + across)) / young]
    back += [(stress[1] - nu * (stress[0] + across)) / young, stress[2] * (1.0 + nu) / young]
    assert strain == pytest.approx(back, rel=1e-12)
    assert moduli.energy(stress) == pytest.approx(stress @ (strain * [1.0, 1.0, 2.0]), rel=1e-12)


def test_moduli_along_a_free_edge() -> None:
    for plane, across in (("strain", 0.3), ("stress", 0.0)):
        moduli = PlaneModuli(young=1.0, poisson=0.3, plane=plane)  # type: ignore[arg-type]
        stress = np.array([1.0, 0.0, across])  # along, normal, across
        squares = np.square(stress - np.roll(stress, 1)).sum()
        assert moduli.equivalent == pytest.approx(np.sqrt(0.5 * squares), rel=1e-14)
        assert moduli.along_edge * (1.0 - 0.3 * across) == pytest.approx(1.0, rel=1e-14)


def checked(mesh: CurvedMesh) -> None:
    """That the boundary of a mesh is whole and on its curves."""
    for number, curve in enumerate(mesh.region.curves):
        here = mesh.curve == number
        arcs, nodes = mesh.arcs[here], mesh.nodes[mesh.edges[here]]
        assert np.array_equal(mesh.ends[here, 1], np.roll(mesh.ends[here, 0], -1))
        assert np.array_equal(arcs[:-1, 1], arcs[1:, 0])
        assert arcs[-1, 1] - arcs[0, 0] == pytest.approx(curve.length, rel=1e-12)
        s = np.column_stack([arcs[:, 0], arcs.mean(axis=1), arcs[:, 1]])
        on = curve.at(s.ravel())[0].reshape(nodes.shape)
        assert np.abs(on - nodes).max() < 1e-9
    shapes = mesh.shapes()
    assert shapes.areas.min() > 0.0
    assert shapes.areas.sum() == pytest.approx(mesh.region.area, rel=2e-4)


def test_refined_meshes_stay_on_the_curves() -> None:
    mesh = CurvedMesh.of(
        graded(square_with(ellipse(2.0, 1.0), 5.0), np.array([2.0 + 0j]), np.array([0.3]), 1.5)
    )
    checked(mesh)
    rng = np.random.default_rng(3)
    for _ in range(3):
        count = len(mesh.triangles)
        some = rng.choice(count, count // 5, replace=False)
        finer = mesh.refined(some)
        assert len(finer.triangles) >= count + 3 * len(some)
        checked(finer)
        mesh = finer


def test_places_along_a_boundary_are_found(ring: CurvedMesh) -> None:
    for number, curve in enumerate(ring.region.curves):
        s = np.linspace(-0.3, 1.7, 173) * curve.length
        nodes, shares = ring.along(number, s)
        assert shares.sum(axis=1) == pytest.approx(1.0, abs=1e-13)
        points = (ring.nodes[nodes] * shares).sum(axis=1)
        assert np.abs(points - curve.at(s)[0]).max() < 0.01
