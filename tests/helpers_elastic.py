"""Elastic bodies with known stresses, and teeth under load, on meshes of the package."""

from __future__ import annotations

import math
from collections.abc import Callable
from functools import cache
from typing import Any, NamedTuple

import numpy as np

from gearcam.gears.contact import DRIVE, flank_pairs
from gearcam.gears.spec import Rack
from gearcam.laws.ratio.constant import Constant
from gearcam.mechanics.material import MaterialSpec
from gearcam.meshing.contact import Contacts, contacts
from gearcam.stress.elastic import CurvedMesh, ElasticBody, PlaneModuli, edge_shapes, edge_slopes
from gearcam.stress.fillet import StressPeak, edge_stress, peak
from gearcam.stress.hertz_load import FlankLoad, flank_load, hertz_load
from gearcam.stress.influence import Influence
from gearcam.stress.mesh import graded
from gearcam.stress.region import BoundaryCurve, BoundaryRun, Region, arc_run, region_of
from helpers_pairs import job, profile
from witness.elasticity import hole_in_plate

STEEL = PlaneModuli(young=206000.0, poisson=0.3)
UNIT = PlaneModuli(young=1.0, poisson=0.3)

Field = Callable[[Any], Any]
"""Stress xx, yy, xy at points."""


def polygon(*corners: complex) -> BoundaryCurve:
    pairs = zip(corners, [*corners[1:], corners[0]], strict=True)
    return BoundaryCurve(runs=tuple(arc_run(start, end) for start, end in pairs))


def ellipse(a: float, b: float, count: int = 2000) -> BoundaryCurve:
    """An ellipse, counter-clockwise from (a, 0)."""
    t = np.linspace(0.0, 2.0 * np.pi, count + 1)
    points, tangents = a * np.cos(t) + 1j * b * np.sin(t), -a * np.sin(t) + 1j * b * np.cos(t)
    points[-1] = points[0]
    return BoundaryCurve(runs=(BoundaryRun(points=points, tangents=tangents / np.abs(tangents)),))


def square_with(hole: BoundaryCurve, half: float) -> Region:
    corners = half * np.array([-1 - 1j, 1 - 1j, 1 + 1j, -1 + 1j])
    return Region(outer=polygon(*corners.tolist()), holes=(hole.reversed,))


def meshed(region: Region, curve: int, size: float, largest: float) -> CurvedMesh:
    """A mesh of this size along a curve."""
    one = region.curves[curve]
    points = one.at(np.linspace(0.0, one.length, 400))[0]
    return CurvedMesh.of(graded(region, points, np.full(400, size), largest))


def edge_forces(mesh: CurvedMesh, curve: int, field: Field) -> Any:
    """Forces on the nodes of a curve under the tractions of a field of stress."""
    x, weights = np.polynomial.legendre.leggauss(6)
    nodes = mesh.edges[mesh.curve == curve]
    along = mesh.nodes[nodes] @ edge_slopes(x).T
    xx, yy, xy = field(mesh.nodes[nodes] @ edge_shapes(x).T)
    out = -1j * along
    tractions = xx * out.real + xy * out.imag + 1j * (xy * out.real + yy * out.imag)
    made = np.zeros(len(mesh.nodes), dtype=complex)
    np.add.at(made, nodes, (tractions * weights) @ edge_shapes(x))
    return made


def floating(mesh: CurvedMesh, moduli: PlaneModuli, left: complex, right: complex) -> ElasticBody:
    """A body held just so that it cannot move as a whole, at the nodes nearest to two points."""
    one, other = (int(np.abs(mesh.nodes - point).argmin()) for point in (left, right))
    return ElasticBody(
        mesh=mesh, moduli=moduli, held=np.array([2 * one, 2 * one + 1, 2 * other + 1])
    )


def largest_tension(body: ElasticBody, moved: Any, curve: int) -> StressPeak:
    edge = edge_stress(body, moved, curve)
    return peak(edge, np.ones(len(edge.s), dtype=bool), 1)


def plate_with_hole(mesh: CurvedMesh, a: float, b: float) -> tuple[ElasticBody, Any]:
    """A square with an elliptic hole, under the tractions of an infinite plate; displacements."""
    half = mesh.region.outer.length / 8.0
    body = floating(mesh, UNIT, -half, half)
    forces = edge_forces(mesh, 0, lambda z: hole_in_plate(z, a, b))
    return body, body.displacements(forces[:, None])


class Tooth(NamedTuple):
    """A wheel with its module, a place of contact in its frame, and the load there."""

    region: Region
    module: float
    point: complex
    direction: complex
    load: FlankLoad


def _touched(found: Contacts, at: int, phi: float) -> tuple[complex, complex]:
    """A point of contact and the direction of the force on the driver, in the driver's frame."""
    turn = np.exp(1j * phi)
    return complex(found.point[at] * turn), complex(-found.force[at] * turn)


@cache
def nail_tooth() -> Tooth:
    """The driver of the nail machine at 171.796 deg: tooth 18, at half its height."""
    result, phi = profile("nail_machine_two_phase"), math.radians(171.796)
    sides = flank_pairs((result.gear1, result.gear2), DRIVE)
    found = contacts(sides, phi)
    assert sides.wheels[0].number(found.pair).tolist() == [18]
    region, (point, direction) = region_of(result.parts[0]), _touched(found, 0, phi)
    curvature = float(found.curvature[0])
    load = hertz_load(
        region, point, direction, 400.334, curvature=curvature, material=MaterialSpec()
    )
    return Tooth(region, sides.pitch / math.pi, point, direction, load)


@cache
def spur_tooth(teeth: int, tip_radius: float, where: str) -> Tooth:
    """A wheel of module 2 mm on its like, under a unit force along the pitch circle.

    At the outer point of single contact, or 0.03 modules below the tip along the flank.
    """
    rack = Rack(tip_radius=tip_radius)
    result = job(Constant(), (teeth, teeth), module=2.0, tolerance=0.002, rack=rack)
    sides = flank_pairs((result.gear1, result.gear2), DRIVE)
    tooth = teeth // 2
    number, end = int(sides.numbers[tooth]), float(sides.arcs.end[tooth])
    if where == "outer":  # the next tooth comes into contact
        phis = sides.arcs.start[tooth + 1 : tooth + 2] + 1e-9
    else:
        phis = np.linspace(end - 0.05, end, 1000)[:-1]
    found = contacts(sides, phis)
    rows = np.flatnonzero(found.pair == number)
    touched = [_touched(found, int(row), float(phis[found.step[row]])) for row in rows]
    points = np.array([one[0] for one in touched])
    below = np.abs(np.diff(points)).sum() - np.append(0.0, np.abs(np.diff(points)).cumsum())
    asked = 0.0 if where == "outer" else 0.03 * 2.0
    point, direction = touched[int(np.abs(below - asked).argmin())]
    region, force = region_of(result.parts[0]), 1.0 / math.cos(math.radians(20.0))
    load = flank_load(region, point, direction, force, half_width=0.02 * 2.0)
    return Tooth(region, 2.0, point, direction, load)


def remembered(known: Callable[..., Influence]) -> Callable[..., Influence]:
    """A function that returns what it has found before for the same wheel."""

    def found(region: Region, module: float, *rest: Any) -> Influence:
        shape = region.teeth.at(region.teeth.places)[0].tobytes()
        held = tuple(one.length for one in region.holes)
        key = (shape, held, module, *map(_key, rest))
        if key not in _INFLUENCES:
            _INFLUENCES[key] = known(region, module, *rest)
        return _INFLUENCES[key]

    return found


_INFLUENCES: dict[Any, Influence] = {}


def _key(value: Any) -> Any:
    return value.tobytes() if isinstance(value, np.ndarray) else value
