"""Certified stresses: refusals, findings, and where meshes are refined."""

from __future__ import annotations

from dataclasses import replace
from typing import Any

import numpy as np
import pytest

from gearcam.base.errors import InfeasibleError
from gearcam.stress.certify import certified, first_mesh, indicators, marked
from gearcam.stress.elastic import CurvedMesh
from gearcam.stress.hertz_load import flank_load
from gearcam.stress.mesh import graded
from gearcam.stress.region import Region
from helpers_elastic import STEEL, edge_forces, floating, nail_tooth, polygon, spur_tooth


def test_the_fewest_triangles_that_matter_are_divided() -> None:
    matter = np.array([0.1, 5.0, 0.0, 3.0, 1.9])
    assert sorted(marked(matter)) == [1, 3]  # 8 of 10; 5 of 10 is too little
    assert marked(np.array([7.0, 2.0, 1.0])).tolist() == [0]
    assert sorted(marked(np.ones(10))) == [0, 1, 2, 3, 4, 5]


def test_a_stress_that_is_exact_has_no_indicated_error() -> None:
    """Bending: the stress is linear in y, and its averages are itself."""
    region = Region(outer=polygon(-1j, 4 - 1j, 4 + 1j, 1j))
    mesh = CurvedMesh.of(graded(region, np.empty(0, dtype=complex), np.empty(0), 0.7))
    body = floating(mesh, STEEL, 0.0, 4.0)

    def field(z: Any) -> Any:
        return np.array([100.0 * z.imag, 0.0 * z.real, 0.0 * z.real])

    moved = body.displacements(edge_forces(mesh, 0, field)[:, None])
    size = np.sqrt((STEEL.energy(body.stress(moved)[:, 0]) * body.shapes.areas).sum())
    assert indicators(body, moved).max() < 1e-9 * size
    bumped = moved.copy()
    bumped[np.abs(mesh.nodes - 2.0).argmin()] += 1e-5
    shown = indicators(body, bumped)[0]
    middles = mesh.points[mesh.triangles].mean(axis=1)
    assert abs(middles[shown.argmax()] - 2.0) < 1.0


def test_the_first_mesh_is_fine_where_it_matters() -> None:
    tooth = nail_tooth()
    mesh = first_mesh(tooth.region, tooth.module, [tooth.load])
    edges = np.abs(np.diff(mesh.arcs, axis=1))[:, 0]
    s = mesh.arcs.mean(axis=1)
    near = (mesh.curve == 0) & (np.abs(s - tooth.load.place) < tooth.load.half_width)
    assert edges[near].max() < 1.3 * max(tooth.load.half_width, 0.06 * tooth.module)
    assert 2 * len(mesh.nodes) < 16_000


def test_a_force_too_large_for_its_flank_is_refused() -> None:
    tooth = nail_tooth()
    wide = replace(tooth.load, half_width=0.36 * tooth.module)
    with pytest.raises(InfeasibleError, match="the force is too large") as told:
        certified(tooth.region, tooth.module, wide, STEEL)
    # at the limit the half-width, which goes with the root of the force, is 0.3 modules
    assert told.value.limit == pytest.approx(abs(wide.force) * (0.3 / 0.36) ** 2)


def test_the_widest_of_several_contacts_is_told() -> None:
    tooth = nail_tooth()
    wide = replace(tooth.load, half_width=0.36 * tooth.module, force=3.0 * tooth.load.force)
    with pytest.raises(InfeasibleError, match="the force is too large") as told:
        certified(tooth.region, tooth.module, tooth.load, STEEL, others=[wide])
    assert told.value.value == pytest.approx(abs(wide.force))


def test_two_loads_of_half_the_force_are_the_whole() -> None:
    tooth = spur_tooth(20, 0.38, "outer")
    whole = certified(tooth.region, tooth.module, tooth.load, STEEL)
    half = replace(tooth.load, force=0.5 * tooth.load.force)
    both = certified(tooth.region, tooth.module, half, STEEL, others=[half])
    assert both.tension.stress == pytest.approx(whole.tension.stress, rel=1e-9)
    assert both.compression.stress == pytest.approx(whole.compression.stress, rel=1e-9)
    assert both.deflection == pytest.approx(whole.deflection, rel=1e-9)
    alone = certified(tooth.region, tooth.module, half, STEEL)
    assert alone.tension.stress == pytest.approx(0.5 * whole.tension.stress, rel=1e-9)


def test_a_wheel_without_fillets_is_refused() -> None:
    square = Region(outer=polygon(0j, 10.0 + 0j, 10.0 + 10.0j, 10.0j))
    load = flank_load(square, 10.0 + 5.0j, -1.0, 1.0, half_width=0.1)
    with pytest.raises(InfeasibleError, match="have no fillets"):
        certified(square, 1.0, load, STEEL)


def test_a_tolerance_that_is_not_reached_is_told() -> None:
    tooth = spur_tooth(20, 0.38, "outer")
    short = certified(tooth.region, tooth.module, tooth.load, STEEL, most=10_500, tolerance=1e-3)
    assert not short.reached
    assert short.error > short.tolerance == 1e-3
    assert short.unknowns <= 10_500
    assert short.loops >= 2
    one = certified(tooth.region, tooth.module, tooth.load, STEEL, most=8_000)
    assert one.error == np.inf  # nothing to compare with
    assert not one.reached


def test_results_belong_to_the_mesh_that_is_told() -> None:
    tooth = spur_tooth(20, 0.38, "outer")
    found = certified(tooth.region, tooth.module, tooth.load, STEEL)
    assert found.reached
    assert found.loads[0] == tooth.load
    assert found.corners == ()
    assert found.von_mises == pytest.approx(
        STEEL.equivalent * max(found.tension.stress, -found.compression.stress)
    )
    curve = tooth.region.teeth
    for one in (found.tension, found.compression):
        assert abs(one.point - curve.at(np.array([one.s]))[0][0]) < 1e-12
        assert abs(one.point) < abs(tooth.point)
    # on both sides of the tooth, the tension on that of the load
    away = [(one.s - tooth.load.place + 0.5 * curve.length) % curve.length - 0.5 * curve.length
            for one in (found.tension, found.compression)]  # fmt: skip
    assert away[0] * away[1] < 0.0
    assert abs(away[0]) < abs(away[1])
