"""Forces of contacts: where they act, over which arc, and what the nodes get of them."""

from __future__ import annotations

from typing import Any

import numpy as np
import pytest

from gearcam.base.errors import InfeasibleError
from gearcam.mechanics.material import MaterialSpec
from gearcam.stress.elastic import CurvedMesh
from gearcam.stress.hertz_load import deflections, flank_load, hertz_load, nodal_forces
from gearcam.stress.mesh import graded
from gearcam.stress.region import Region
from helpers_elastic import nail_tooth, polygon

SQUARE = Region(outer=polygon(0j, 10.0 + 0j, 10.0 + 10.0j, 10.0j))
"""Sides at s = 0 to 10 (below), to 20 (right), to 30 (above), to 40."""


def test_a_contact_is_that_of_hertz() -> None:
    """Reference values of the nail machine's tooth 18, from another program."""
    load = nail_tooth().load
    assert load.half_width == pytest.approx(0.234428, rel=1e-5)
    assert load.pressure == pytest.approx(1087.16, rel=1e-5)
    assert abs(load.force) == pytest.approx(400.334, rel=1e-12)
    assert load.moved == 0.0


def test_the_force_acts_at_its_place_along_the_normal() -> None:
    tooth = nail_tooth()
    point, tangent = tooth.region.teeth.at(np.array([tooth.load.place]))
    assert abs(point[0] - tooth.point) < 1e-6
    assert tooth.load.force / abs(tooth.load.force) == pytest.approx(1j * tangent[0], abs=1e-6)


@pytest.mark.parametrize("size", [0.3, 3.0])
def test_the_nodes_get_the_whole_force_and_its_moments(size: float) -> None:
    mesh = CurvedMesh.of(graded(SQUARE, np.array([10.0 + 4.0j]), np.array([size]), 4.0))
    a = 0.37
    load = flank_load(SQUARE, 10.0 + 4.2j, -1.0, 30.0, half_width=a, friction=0.2)
    forces = nodal_forces(mesh, [load, load])
    assert np.array_equal(forces[:, 0], forces[:, 1])
    assert forces.sum(axis=0) == pytest.approx(30.0 * (-1.0 + 0.2j), rel=1e-13)
    y = mesh.nodes.imag - 4.2
    assert (forces[:, 0] * y).sum() == pytest.approx(0.0, abs=1e-10)
    # quadratics are exact on an edge of three nodes: that of a semi-ellipse is a^2/4
    assert (forces[:, 0].real * y**2).sum() == pytest.approx(-30.0 * a * a / 4.0, rel=1e-4)


def test_at_a_corner_the_flank_is_that_of_the_force() -> None:
    """The nearest point of the boundary is the same for both sides."""
    near = 10.0 + 10.0j
    right = flank_load(SQUARE, near, -1.0, 1.0, half_width=0.5)
    above = flank_load(SQUARE, near, -1.0j, 1.0, half_width=0.5)
    assert (right.place, right.moved) == pytest.approx((19.5, -0.5), abs=1e-6)
    assert (above.place, above.moved) == pytest.approx((20.5, 0.5), abs=1e-6)


def test_a_point_on_the_wrong_side_of_a_corner_is_on_its_flank_all_the_same() -> None:
    load = flank_load(SQUARE, 9.9 + 10.0j, -1.0, 1.0, half_width=0.5)
    assert load.place == pytest.approx(19.5, abs=1e-6)


def test_a_point_off_the_boundary_by_more_than_the_contact_is_wide_is_on_its_flank_too() -> None:
    """As on a wheel from whose outline a clearance was taken."""
    load = flank_load(SQUARE, 9.7 + 10.2j, -1.0, 1.0, half_width=0.1)
    assert load.place == pytest.approx(19.9, abs=1e-6)


@pytest.mark.parametrize("point", [0j, 0.2 + 0j, 0.2j])
def test_the_corner_at_the_start_of_a_curve_is_like_others(point: complex) -> None:
    below = flank_load(SQUARE, point, 1.0j, 1.0, half_width=0.5)
    left = flank_load(SQUARE, point, 1.0, 1.0, half_width=0.5)
    assert below.place == pytest.approx(0.5, abs=1e-6)
    assert left.place == pytest.approx(39.5, abs=1e-6)


def test_a_contact_wider_than_its_flank_is_refused() -> None:
    with pytest.raises(InfeasibleError, match="wider than its flank") as told:
        flank_load(SQUARE, 10.0 + 5.0j, -1.0, 1.0, half_width=5.01)
    assert (told.value.value, told.value.limit) == pytest.approx((5.01, 5.0))
    assert flank_load(SQUARE, 10.0 + 5.0j, -1.0, 1.0, half_width=4.99).place == pytest.approx(15.0)


@pytest.mark.parametrize("turn", [-21.0, 21.0, 180.0])
def test_a_force_askew_is_refused(turn: float) -> None:
    direction = -np.exp(1j * np.radians(turn))
    with pytest.raises(ValueError, match="off the normal of its flank"):
        flank_load(SQUARE, 10.0 + 5.0j, complex(direction), 1.0, half_width=0.1)


def test_half_widths_grow_with_the_root_of_the_force() -> None:
    loads = [
        hertz_load(SQUARE, 10.0 + 5.0j, -1.0, force, curvature=0.1, material=MaterialSpec())
        for force in (100.0, 400.0)
    ]
    assert loads[1].half_width == pytest.approx(2.0 * loads[0].half_width, rel=1e-12)
    assert loads[1].pressure == pytest.approx(2.0 * loads[0].pressure, rel=1e-12)


def test_a_deflection_is_weighted_with_the_pressure() -> None:
    mesh = CurvedMesh.of(graded(SQUARE, np.array([10.0 + 4.0j]), np.array([0.3]), 4.0))
    load = flank_load(SQUARE, 10.0 + 4.2j, -1.0, 30.0, half_width=0.37)
    forces = nodal_forces(mesh, [load])
    along: Any = np.stack([-0.01 * np.ones(len(mesh.nodes)), 0.02j * mesh.nodes], axis=1)
    # a push of 0.01, and a turn by 0.02, which moves the place by -0.02*y along x
    assert deflections(forces, along) == pytest.approx(np.array([[0.01, 0.02 * 4.2]]), rel=1e-9)
