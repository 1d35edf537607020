"""Stress along the edge: where it is looked at, and how its peaks are found."""

from __future__ import annotations

from dataclasses import replace
from itertools import pairwise
from typing import Any

import numpy as np
import pytest

from gearcam.parts.shapes import Circle
from gearcam.stress.elastic import CurvedMesh, ElasticBody
from gearcam.stress.fillet import (
    EdgeStress,
    edge_stress,
    fillets,
    in_fillets,
    looked_at,
    mean_stress,
    peak,
    sharp_corners,
)
from gearcam.stress.hertz_load import flank_load
from gearcam.stress.mesh import graded
from gearcam.stress.region import BoundaryCurve, Region, arc_run, curve_of
from helpers_elastic import STEEL, nail_tooth, polygon, spur_tooth

CIRCLE = curve_of(Circle(center=0j, diameter=20.0 / np.pi))
"""A curve of length 20."""


def on_circle(stress: Any, s: Any) -> EdgeStress:
    return EdgeStress(CIRCLE, s, stress)


def everywhere(s: Any) -> Any:
    return np.ones(len(s), dtype=bool)


@pytest.mark.parametrize("sign", [1, -1])
@pytest.mark.parametrize("top", [7.03, 0.04, 19.97])
def test_the_top_of_a_parabola_is_found_anywhere_on_a_closed_curve(sign: int, top: float) -> None:
    s = np.sort(np.random.default_rng(2).uniform(0.0, 20.0, 200))
    past = (s - top + 10.0) % 20.0 - 10.0
    found = peak(on_circle(sign * (50.0 - 3.0 * past**2), s), everywhere(s), sign)
    assert (found.stress, found.s) == pytest.approx((sign * 50.0, top), abs=1e-9)
    assert found.misfit < 1e-9
    assert abs(found.point - CIRCLE.at(np.array([top]))[0][0]) < 1e-9


def test_scatter_is_told_as_misfit() -> None:
    s = np.linspace(0.0, 20.0, 200, endpoint=False)
    rough = np.where(np.arange(200) % 2, 0.1, -0.1)
    found = peak(on_circle(50.0 - 0.3 * (s - 10.0) ** 2 + rough, s), everywhere(s), 1)
    assert found.stress == pytest.approx(50.0, abs=0.06)
    assert found.misfit == pytest.approx(0.1, rel=0.1)


def test_at_the_end_of_what_is_looked_at_the_point_itself_counts() -> None:
    s = np.linspace(0.0, 20.0, 200, endpoint=False)
    looked = s < 10.0
    found = peak(on_circle(s**2, s), looked, 1)
    assert (found.stress, found.s) == pytest.approx((9.9**2, 9.9))


def test_what_is_not_looked_at_does_not_bend_the_parabola() -> None:
    s = np.linspace(0.0, 20.0, 200, endpoint=False)
    stress = 50.0 - 3.0 * (s - 7.0) ** 2
    stress[s < 6.95] = 1e6
    assert peak(on_circle(stress, s), s > 6.95, 1).stress == pytest.approx(50.0, abs=1e-9)


@pytest.mark.parametrize("side", [-1.0, 1.0])
def test_nor_what_is_looked_at_beyond_a_gap(side: float) -> None:
    s = np.linspace(0.0, 20.0, 200, endpoint=False)
    past = side * (s - 7.0)
    stress = np.where(past > 0.15, -1e6, 50.0 - 3.0 * past**2)
    looked = (past < 0.05) | (past > 0.15)
    found = peak(on_circle(stress, s), looked, 1)
    assert (found.stress, found.s) == pytest.approx((50.0, 7.0), abs=0.1)


def test_a_point_that_juts_out_of_a_valley_counts_itself() -> None:
    s = np.linspace(0.0, 20.0, 200, endpoint=False)
    stress = np.where(np.abs(s - 7.0) < 0.35, 100.0 * (s - 7.0) ** 2, 0.0)
    stress[70] = 10.0
    found = peak(on_circle(stress, s), everywhere(s), 1)
    assert (found.stress, found.s) == pytest.approx((10.0, 7.0))


@pytest.fixture(scope="module")
def held_disc() -> ElasticBody:
    hole = curve_of(Circle(center=0j, diameter=6.0), hole=True, held=True)
    region = Region(outer=curve_of(Circle(center=0j, diameter=20.0)), holes=(hole,))
    mesh = CurvedMesh.of(graded(region, np.array([10.0 + 0j]), np.array([0.3]), 2.0))
    return ElasticBody(mesh=mesh, moduli=STEEL)


def test_a_swollen_disc_is_stressed_along_its_edge(held_disc: ElasticBody) -> None:
    """Radial displacement of a share of the radius is a strain of that share."""
    edge = edge_stress(held_disc, 1e-3 * held_disc.mesh.nodes, 0)
    assert edge.stress == pytest.approx(1e-3 * 206000.0 / 0.91, rel=1e-12)
    assert np.all(np.diff(edge.s) > 0.0)


def test_the_mean_stress_is_the_work_of_a_load(held_disc: ElasticBody) -> None:
    rng = np.random.default_rng(4)
    moved: Any = rng.normal(size=len(held_disc.mesh.nodes)) * (1.0 + 0.5j)
    edge = edge_stress(held_disc, moved, 0)
    length = edge.curve.length
    for s, within in ((31.0, 1e-9), (0.0, 2.0), (length - 0.1, 1.0)):
        force = mean_stress(held_disc, 0, s, within)
        away = np.abs((edge.s - s + 0.5 * length) % length - 0.5 * length)
        near = away <= max(within, away.min())
        spans = np.repeat(np.diff(held_disc.mesh.arcs[held_disc.mesh.curve == 0]), 2)[near]
        wanted = (edge.stress[near] * spans).sum() / spans.sum()
        assert (force.conj() @ moved).real == pytest.approx(wanted, rel=1e-9)


def test_each_root_of_a_wheel_is_looked_at() -> None:
    tooth = spur_tooth(20, 0.38, "outer")
    found = fillets(tooth.region.teeth, tooth.module)
    pitch = tooth.region.teeth.length / 20.0
    # one stretch a root, or both fillets of a root apart from its land
    assert len(found) in (20, 40)
    assert np.all(np.diff(found, axis=1) > 0.5 * tooth.module)
    assert np.diff(found, axis=1).sum() < 20.0 * 0.6 * pitch
    middles = np.abs(tooth.region.teeth.at(found.mean(axis=1))[0])
    assert np.all(middles < (0.5 * 20 - 0.9) * tooth.module)


def notched(bulge: float) -> BoundaryCurve:
    """A rectangle with a half circle of radius 1 in its upper side, in which s begins."""
    corners = (-1.0 + 0j, -9.0 + 0j, -9.0 - 9.0j, 9.0 - 9.0j, 9.0 + 0j, 1.0 + 0j)
    lines = [arc_run(start, end) for start, end in pairwise(corners)]
    return BoundaryCurve(
        runs=(arc_run(-1j, -1.0 + 0j, bulge), *lines, arc_run(1.0 + 0j, -1j, bulge))
    )


def test_fillets_around_the_start_are_one() -> None:
    curve = notched(-np.tan(np.pi / 8.0))
    whole = 0.5 * np.pi + 0.35
    assert fillets(curve, 1.0) == pytest.approx(np.array([[-whole, whole]]), abs=0.03)
    assert not len(fillets(curve, 0.2))  # 5 modules are too flat
    s = np.linspace(0.0, curve.length, 5000)
    assert not in_fillets(EdgeStress(curve, s, s), 0.2).any()
    found = s[in_fillets(EdgeStress(curve, s, s), 1.0)]
    assert found.min() == 0.0
    assert (found.max() - found[found < 20.0].max()) > 20.0


def test_sharp_corners_are_told_and_left_out() -> None:
    corners = (0j, 10.0 + 0j, 10.0 + 4.0j, 4.0 + 4.0j, 4.0 + 10.0j, 10.0j)
    curve = polygon(*corners)
    assert sharp_corners(curve) == pytest.approx([20.0])  # at 4 + 4j
    held = BoundaryCurve(runs=tuple(replace(run, held=True) for run in curve.runs))
    assert not len(sharp_corners(held))
    # nothing is looked at within 0.35 modules, though a fillet be beside it
    notch = notched(-np.tan(np.pi / 16.0))  # two arcs of a quarter circle that meet at a corner
    assert sharp_corners(notch) == pytest.approx([0.0])
    s = np.linspace(0.0, 0.5 * notch.length, 5000)
    found = s[in_fillets(EdgeStress(notch, s, s), 1.0)]
    assert found.min() == pytest.approx(0.35, abs=0.01)


def test_nothing_is_looked_at_beside_the_load() -> None:
    tooth = nail_tooth()
    curve = tooth.region.teeth
    s = np.linspace(0.0, curve.length, 20000)
    edge = EdgeStress(curve, s, s)
    whole = in_fillets(edge, tooth.module)
    assert np.array_equal(looked_at(edge, tooth.module, [tooth.load]), whole)  # far from fillets
    middle = float(fillets(curve, tooth.module)[5].mean())
    point, tangent = curve.at(np.array([middle]))
    load = flank_load(
        tooth.region, complex(point[0]), complex(1j * tangent[0]), 1.0, half_width=0.1
    )
    left_out = whole & ~looked_at(edge, tooth.module, [load])
    beside = 1.6 * 0.1 + 0.15 * tooth.module
    assert np.ptp(s[left_out]) == pytest.approx(2.0 * beside, abs=0.1)
    assert s[left_out].mean() == pytest.approx(middle, abs=0.05)
