"""The stress in the fillets of one tooth, on a mesh of its own, refined until its error is small.

Triangles are divided where their errors matter to both peaks and to the displacement at the load.
The error of a solution in a triangle is indicated by the difference of the stress from the averages
at the nodes (Zienkiewicz and Zhu, Int. J. Numer. Meth. Engng 24, 1987, 337). What it matters to a
result is indicated by its product with the error of the *dual* solution, that under the load whose
work is the result (Becker and Rannacher, Acta Numerica 10, 2001, 1); for the displacement at the
load the solution is its own dual. Divided are the worst triangles that have a given share of the
sum (Doerfler, SIAM J. Numer. Anal. 33, 1996, 1106).
"""

from __future__ import annotations

from collections.abc import Sequence
from dataclasses import dataclass, field
from typing import Final, NamedTuple

import numpy as np

from gearcam.base.display import ShortRepr
from gearcam.base.errors import InfeasibleError
from gearcam.numeric.arrays import Array, Ints, Plane
from gearcam.stress.elastic import CurvedMesh, ElasticBody, PlaneModuli
from gearcam.stress.fillet import (
    StressPeak,
    edge_stress,
    fillets,
    looked_at,
    mean_stress,
    peak,
    sharp_corners,
)
from gearcam.stress.hertz_load import FlankLoad, deflections, nodal_forces
from gearcam.stress.mesh import graded
from gearcam.stress.region import Region
from gearcam.stress.size_field import LARGEST, outline_sizes

TOLERANCE: Final = 0.01
"""Usual relative error up to which a stress is certified."""

MOST: Final = 300_000
"""Largest number of unknowns: half a minute and some GB."""

_HALF_PLANE: Final = 0.3
"""Largest half-width of a contact, in modules: a wider one is not on a half plane, as Hertz has
it."""

_AT_LOAD: Final = 0.06
"""Least size of triangles at the load, in modules, where the contact is narrower."""

_ACROSS: Final = np.linspace(-1.0, 1.0, 5)
"""Where the size at the load is asked for, in half-widths."""

_AVERAGED: Final = 0.12
"""Half the length along which a dual averages the stress of a peak, in modules."""

_DIVIDED: Final = 0.6
"""Share of the sum of the indicators in the triangles that are divided."""

_SURE: Final = 3.0
"""Estimated error over the changes that it is estimated from: true errors were larger than such
changes, though by less than this."""

_BEFORE: Final = 0.35
"""Share of the change before the last in the next one: the usual convergence."""

_FLOOR: Final = 2e-4
"""Relative error below which no estimate goes."""


@dataclass(frozen=True, eq=False, kw_only=True)
class Certificate(ShortRepr):
    """The largest stresses in the fillets under a load, with the error that they may have.

    Parameters
    ----------
    tension, compression : StressPeak
        The largest of each.
    von_mises : float, MPa
        The larger von Mises stress at these places.
    error : float
        Estimated relative error of tension and compression, the larger one.
    tolerance : float
        What it should be.
    deflection : float, mm
        Mean displacement at the load, in its direction, weighted with its pressure.
    deflection_error : float
        Estimated relative error of it.
    loads : tuple of FlankLoad
        The loads, where they were applied, that of the deflection first.
    corners : (k,) tuple of complex, mm
        Sharp re-entrant corners of the curve with the teeth, near which no stress was looked for.
    unknowns, loops : int
        Unknowns of the last mesh, and the number of times that the first was refined.
    body : ElasticBody
        The wheel on the last mesh.
    moved : (n, 1) complex array, mm
        Displacements of its nodes.
    """

    tension: StressPeak
    compression: StressPeak
    von_mises: float
    error: float
    tolerance: float
    deflection: float
    deflection_error: float
    loads: tuple[FlankLoad, ...]
    corners: tuple[complex, ...]
    unknowns: int
    loops: int
    body: ElasticBody = field(repr=False)
    moved: Plane = field(repr=False)

    @property
    def reached(self) -> bool:
        """Whether the error is within the tolerance."""
        return self.error <= self.tolerance


class _Solved(NamedTuple):
    """Results on one mesh, and what shows where to refine it."""

    body: ElasticBody
    moved: Plane
    tension: StressPeak
    compression: StressPeak
    deflection: float


def certified(
    region: Region,
    module: float,
    load: FlankLoad,
    moduli: PlaneModuli,
    *,
    others: Sequence[FlankLoad] = (),
    within: tuple[float, float] | None = None,
    tolerance: float = TOLERANCE,
    most: int = MOST,
) -> Certificate:
    """Return the largest stresses in the fillets of a wheel under a load, or several.

    The mesh is refined twice at least, then until the estimated error is within the tolerance or
    the next mesh would be too large: `Certificate.reached` says which.

    Parameters
    ----------
    region : Region
        The wheel.
    module : float, mm
        Its module.
    load : FlankLoad
        The load.
    moduli : PlaneModuli
        Elasticity of the wheel.
    others : sequence of FlankLoad
        Loads on other teeth at the same time.
    within : (float, float), optional
        s on the curve with the teeth between which stresses are looked for, such as those of a
        tooth; by default anywhere.
    tolerance : float
        Relative error.
    most : int
        Largest number of unknowns.

    Returns
    -------
    Certificate

    Raises
    ------
    InfeasibleError
        If the contact is too wide for its tooth, or the wheel has no fillets.
    """
    loads = (load, *others)
    widest = max(loads, key=lambda one: one.half_width)
    if widest.half_width > _HALF_PLANE * module:
        share = (_HALF_PLANE * module / widest.half_width) ** 2
        raise InfeasibleError(
            "the force is too large for the flank: the contact is wider than 0.6 modules",
            value=abs(widest.force),
            limit=share * abs(widest.force),
            unit="N/mm",
        )
    mesh, solved, errors = (
        first_mesh(region, module, loads, within),
        list[_Solved](),
        np.full(3, np.inf),
    )
    while not solved or errors[:2].max() > tolerance:
        if solved:
            mesh = _refined(solved[-1], module, load.curve)
            if 2 * len(mesh.nodes) > most:
                break
        solved.append(_solved(ElasticBody(mesh=mesh, moduli=moduli), module, loads, within))
        errors = _errors(solved)
    tension, compression = solved[-1].tension, solved[-1].compression
    corners = region.teeth.at(sharp_corners(region.teeth))[0]
    return Certificate(
        tension=tension,
        compression=compression,
        von_mises=moduli.equivalent * max(abs(tension.stress), abs(compression.stress)),
        error=float(errors[:2].max()),
        tolerance=tolerance,
        deflection=solved[-1].deflection,
        deflection_error=float(errors[2]),
        loads=loads,
        corners=tuple(corners.tolist()),
        unknowns=2 * len(solved[-1].body.mesh.nodes),
        loops=len(solved) - 1,
        body=solved[-1].body,
        moved=solved[-1].moved,
    )


def first_mesh(
    region: Region,
    module: float,
    loads: Sequence[FlankLoad],
    within: tuple[float, float] | None = None,
) -> CurvedMesh:
    """Return a mesh that is small at each load, in the fillets beside it, and in some of a tooth.

    Parameters
    ----------
    region : Region
        The wheel.
    module : float, mm
        Its module.
    loads : sequence of FlankLoad
        The loads.
    within : (float, float), optional
        See `certified`.

    Returns
    -------
    CurvedMesh

    Raises
    ------
    InfeasibleError
        If the wheel has no fillets.
    """
    curve, found = region.teeth, fillets(region.teeth, module)
    if not len(found):
        what = "no stress can be given: the roots of the teeth have no fillets"
        raise InfeasibleError(what, nearest="sharp corners have no limit of stress")
    ends = np.concatenate([found + turn * curve.length for turn in (-1.0, 0.0, 1.0)])
    spans = [
        [ends[ends[:, 1] < one.place, 0].max(), ends[ends[:, 0] > one.place, 1].min()]
        for one in loads
    ]
    if within is not None:
        spans.append([within[0], within[0] + (within[1] - within[0]) % curve.length])
    points, sizes = outline_sizes(region, module, np.array(spans))
    at_loads = [curve.at(one.place + one.half_width * _ACROSS)[0] for one in loads]
    least = [max(one.half_width, _AT_LOAD * module) for one in loads]
    points = np.concatenate([points, *at_loads])
    sizes = np.concatenate([sizes, np.repeat(least, len(_ACROSS))])
    return CurvedMesh.of(graded(region, points, sizes, LARGEST * module))


def _solved(
    body: ElasticBody,
    module: float,
    loads: Sequence[FlankLoad],
    within: tuple[float, float] | None,
) -> _Solved:
    forces = nodal_forces(body.mesh, loads)
    moved = body.displacements(forces.sum(axis=1, keepdims=True))
    edge = edge_stress(body, moved[:, 0], loads[0].curve)
    looked = looked_at(edge, module, loads)
    if within is not None:
        low, high = within
        length = edge.curve.length
        looked &= (edge.s - low) % length <= (high - low) % length
    if not looked.any():
        what = "no stress can be given: all fillets are beside the load or sharp corners"
        raise InfeasibleError(what)
    return _Solved(
        body=body,
        moved=moved,
        tension=peak(edge, looked, 1),
        compression=peak(edge, looked, -1),
        deflection=float(deflections(forces[:, :1], moved)[0, 0]),
    )


def _refined(solved: _Solved, module: float, curve: int) -> CurvedMesh:
    """Return the mesh with the triangles divided that matter most to the results."""
    body, within = solved.body, _AVERAGED * module
    peaks = solved.tension, solved.compression
    works = [mean_stress(body, curve, one.s, within) for one in peaks]
    duals = body.displacements(np.stack(works, axis=1))
    errors = indicators(body, np.concatenate([solved.moved, duals], axis=1))
    products = errors[0] * errors
    matter = (products / products.sum(axis=1, keepdims=True)).sum(axis=0)
    return body.mesh.refined(marked(matter))


def indicators(body: ElasticBody, moved: Plane) -> Array:
    """Return the indicators of the errors of solutions in each triangle.

    Parameters
    ----------
    body : ElasticBody
        The body.
    moved : (n, k) complex array, mm
        Displacements of the nodes under each load.

    Returns
    -------
    (k, t) array, N^(1/2)
        Energy norms, per width, of the stress less its averages at the nodes.
    """
    nodes, values, _, areas = body.shapes
    own = body.stress(moved, at_nodes=True)
    means = body.mesh.averaged(own.reshape(-1, *nodes.shape))
    smooth = (means[:, nodes] @ values).reshape(3, moved.shape[1], *areas.shape)
    squares = body.moduli.energy(smooth - body.stress(moved)) * areas
    made: Array = np.sqrt(squares.sum(axis=-1))
    return made


def marked(matter: Array) -> Ints:
    """Return the fewest triangles that have 0.6 of the sum of `matter`, (t,), not negative."""
    order = np.argsort(-matter, kind="stable")
    sums = np.cumsum(matter[order])
    made: Ints = order[: int(np.searchsorted(sums, _DIVIDED * sums[-1])) + 1]
    return made


def _errors(solved: Sequence[_Solved]) -> Array:
    """Return the estimated relative errors of tension, compression and deflection, (3,).

    From how they changed in the last two refinements, and how well the parabola of a peak fits.
    """
    rows = [[one.tension.stress, one.compression.stress, one.deflection] for one in solved[-3:]]
    if len(rows) < 3:
        return np.full(3, np.inf)
    before, last = np.abs(np.diff(rows, axis=0))
    misfit = [solved[-1].tension.misfit, solved[-1].compression.misfit, 0.0]
    change = np.maximum(np.maximum(last, _BEFORE * before), misfit)
    made: Array = _SURE * change / np.abs(rows[-1]) + _FLOOR
    return made
