"""Errors of plane elasticity fall as theory says, towards solutions in closed form."""

from __future__ import annotations

from typing import Any

import numpy as np
import pytest

from gearcam.stress.certify import indicators
from gearcam.stress.elastic import CurvedMesh, ElasticBody, PlaneModuli
from gearcam.stress.mesh import graded
from gearcam.stress.region import Region
from helpers_elastic import (
    UNIT,
    edge_forces,
    ellipse,
    floating,
    meshed,
    plate_with_hole,
    polygon,
    square_with,
)
from witness.elasticity import cantilever, hole_in_plate

YOUNG, POISSON = 3.0, 0.3


def finer(mesh: CurvedMesh) -> CurvedMesh:
    return mesh.refined(np.arange(len(mesh.triangles)))


def energy_errors(body: ElasticBody, moved: Any) -> tuple[float, float]:
    """The relative error in the energy norm, and the indicated over the true one."""
    nodes, values, _, areas = body.shapes
    exact = hole_in_plate(body.mesh.nodes[nodes] @ values, 1.0, 1.0)
    off = (UNIT.energy(body.stress(moved)[:, 0] - exact) * areas).sum()
    whole = (UNIT.energy(exact) * areas).sum()
    return np.sqrt(off / whole), np.sqrt((indicators(body, moved)[0] ** 2).sum() / off)


def plate_slope(mesh: CurvedMesh) -> float:
    errors = []
    for level in (mesh, finer(mesh)):
        error, shown = energy_errors(*plate_with_hole(level, 1.0, 1.0))
        assert 0.65 < shown < 1.0, "Zienkiewicz and Zhu's indicator is off"
        errors.append(error)
    return float(np.log2(errors[0] / errors[1]))


def test_stress_around_a_hole_converges_with_the_square_of_the_size() -> None:
    mesh = meshed(square_with(ellipse(1.0, 1.0), 5.0), 1, 0.1, 1.0)
    assert plate_slope(mesh) == pytest.approx(2.0, abs=0.1)


def test_with_middle_nodes_on_chords_it_does_not(monkeypatch: pytest.MonkeyPatch) -> None:
    monkeypatch.setattr(
        CurvedMesh, "middles", property(lambda mesh: mesh.points[mesh.ends].mean(axis=1))
    )
    mesh = meshed(square_with(ellipse(1.0, 1.0), 5.0), 1, 0.1, 1.0)
    slopes = []
    for level in (mesh, finer(mesh)):
        body, moved = plate_with_hole(level, 1.0, 1.0)
        slopes.append(energy_errors(body, moved)[0])
    assert np.log2(slopes[0] / slopes[1]) < 1.7


def cantilever_error(mesh: CurvedMesh) -> float:
    """The error of displacement in the mean square, relative, less a motion as a whole."""
    moduli = PlaneModuli(young=YOUNG, poisson=POISSON, plane="stress")
    body = floating(mesh, moduli, 0.0, 8.0)
    forces = edge_forces(mesh, 0, lambda z: cantilever(z, 1.0, YOUNG, POISSON)[0])
    moved = body.displacements(forces[:, None])[:, 0]
    nodes, values, _, areas = body.shapes
    z, weight = (mesh.nodes[nodes] @ values).ravel(), np.sqrt(areas.ravel())
    exact = cantilever(z, 1.0, YOUNG, POISSON)[1]
    off = (moved[nodes] @ values).ravel() - exact
    whole = np.stack([np.ones_like(z), 1j * np.ones_like(z), 1j * z], axis=1) * weight[:, None]
    both = np.concatenate([whole.real, whole.imag])
    rows = np.concatenate([(off * weight).real, (off * weight).imag])
    rows = rows - both @ np.linalg.lstsq(both, rows, rcond=None)[0]
    return float(np.linalg.norm(rows) / np.linalg.norm(exact * weight))


def test_displacements_of_a_cantilever_converge_with_the_cube() -> None:
    region = Region(outer=polygon(-1j, 8 - 1j, 8 + 1j, 1j))
    mesh = CurvedMesh.of(graded(region, np.empty(0, dtype=complex), np.empty(0), 1.0))
    errors = [cantilever_error(level) for level in (mesh, finer(mesh), finer(finer(mesh)))]
    assert errors[0] < 1e-3
    assert np.log2(errors[1] / errors[2]) == pytest.approx(3.0, abs=0.1)
