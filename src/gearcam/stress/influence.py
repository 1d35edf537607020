"""What a force anywhere on the flanks of a wheel does: displacements, and stress in the fillets.

A wheel is meshed once, all teeth alike. Unit forces along the inward normals of the flanks act at a
few places of each, spread over the same short arc, and one factorization gives all displacements.
Their work on each other is the *compliance*, the stress along the fillets the *influence* on the
roots; both are smooth along a flank, and between the places they are interpolated by polynomials.
So any number of phases costs no more than interpolation.
"""

from __future__ import annotations

from dataclasses import dataclass
from typing import TYPE_CHECKING, Final

import numpy as np

from gearcam.base.display import ShortRepr
from gearcam.numeric.arrays import Array, Ints, Plane
from gearcam.stress.elastic import CurvedMesh, ElasticBody, PlaneModuli
from gearcam.stress.fillet import edge_stress, in_fillets
from gearcam.stress.hertz_load import FlankLoad, nodal_forces, past
from gearcam.stress.mesh import graded
from gearcam.stress.region import Region
from gearcam.stress.size_field import LARGEST, outline_sizes

if TYPE_CHECKING:
    from gearcam.gears.pair import Gear

SPREAD: Final = 0.16
"""Half the length of the arc that a unit force is spread over, in modules, and the size of the
triangles on the flanks."""

_END: Final = 0.05
"""Distance of the first and last place from the ends of a flank, in modules. Beside an end the arc
is as much shorter."""

_FILLET: Final = 0.25
"""Size of the triangles in the fillets, in modules."""

_PLACES: Final = 7
"""Places on each flank."""

_BLOCK: Final = 128
"""Forces whose displacements are computed at once: some ten MB."""


@dataclass(frozen=True, eq=False, kw_only=True)
class Influence(ShortRepr):
    """What unit forces on the flanks of one side of a wheel's teeth do; t teeth, p places on each.

    Parameters
    ----------
    body : ElasticBody
        The meshed wheel.
    module : float, mm
        Its module.
    numbers : (t,) int array
        Tooth numbers, in order along the boundary.
    ends : (t, 2) array, mm
        s on the curve with the teeth between which each flank can be loaded, rising.
    spread : float, mm
        Half the length of the arc that a unit force is spread over.
    compliance : (t*p, t*p) array, mm^2/N
        Mean displacement at a place, along the inward normal, under 1 N/mm at another. Beside the
        ends of a flank as if the arc were as long there.
    root_s, root_tooth : (g,) arrays, mm and int
        Gauss points of the edges in fillets, by tooth: s, and the row of the tooth.
    roots : (g, t*p) array, 1/mm
        Stress along the edge there under 1 N/mm at each place.
    """

    body: ElasticBody
    module: float
    numbers: Ints
    ends: Array
    spread: float
    compliance: Array
    root_s: Array
    root_tooth: Ints
    roots: Array

    @property
    def length(self) -> float:
        """Length of the curve with the teeth, mm."""
        return self.body.mesh.region.teeth.length

    def placed(self, row: Ints, points: Plane) -> Array:
        """Return s of points on flanks, (n,), mm, moved in where a flank ends.

        Parameters
        ----------
        row : (n,) int array
            Rows of the teeth.
        points : (n,) complex array, mm
            Points of contact, in the wheel's frame.
        """
        low, high = self.ends[row].T
        s = self.body.mesh.region.teeth.nearest(points)
        middle = 0.5 * (low + high)
        return np.clip(middle + past(s, middle, self.length), low, high)

    def shares(self, row: Ints, s: Array) -> tuple[Ints, Array]:
        """Return between which places values are interpolated.

        Parameters
        ----------
        row : (n,) int array
            Rows of the teeth.
        s : (n,) array, mm
            Places on their flanks.

        Returns
        -------
        places, shares : (n, p) arrays
            The places, and the share of the value at each: polynomials of Lagrange.
        """
        low, high = self.ends[row].T
        x = (2.0 * s - low - high) / (high - low)
        nodes = _nodes()
        apart = x[:, None] - nodes
        others = np.where(np.eye(_PLACES, dtype=bool), 1.0, apart[:, None])
        scale = np.where(np.eye(_PLACES, dtype=bool), 1.0, nodes[:, None] - nodes).prod(axis=1)
        return row[:, None] * _PLACES + np.arange(_PLACES), others.prod(axis=2) / scale


def _nodes() -> Array:
    """Return the places on a flank, from -1 to 1: Chebyshev's, with both ends."""
    return -np.cos(np.pi * np.arange(_PLACES) / (_PLACES - 1))


def loaded_flanks(region: Region, gear: Gear, sigma: int, numbers: Ints) -> Array:
    """Return where the flanks of one side lie on the boundary of a wheel.

    Parameters
    ----------
    region : Region
        Of the wheel's part.
    gear : Gear
        The wheel.
    sigma : {-1, +1}
        Side of the flanks.
    numbers : (t,) int array
        Numbers of their teeth.

    Returns
    -------
    (t, 2) array, mm
        s at both ends, rising, the second at most half a turn later.
    """
    toothing, flanks, curve = gear.toothing, gear.profile.flanks, region.teeth
    row = numbers - toothing.numbers[0] + (0 if sigma > 0 else len(toothing.numbers))
    ends = []
    for reach in (flanks.lowest[row], flanks.highest[row]):
        frames = toothing.frames(toothing.track.angle(flanks.sf[row] - sigma * reach))
        ends.append(curve.nearest(toothing.flank_points(frames, flanks.sf[row], sigma)))
    way = past(ends[1], ends[0], curve.length)
    first = np.where(way > 0.0, ends[0], ends[0] + way)
    return np.column_stack([first, first + np.abs(way)])


def influence(
    region: Region,
    module: float,
    numbers: Ints,
    spans: Array,
    flanks: Array,
    moduli: PlaneModuli,
) -> Influence:
    """Return what unit forces on flanks of a wheel do.

    Parameters
    ----------
    region : Region
        The wheel.
    module : float, mm
        Its module.
    numbers : (t,) int array
        Tooth numbers, in order along the boundary.
    spans : (t, 2) array, mm
        s from the middle of the root before each tooth to that after it.
    flanks : (t, 2) array, mm
        s of both ends of the flank of each that is loaded, rising.
    moduli : PlaneModuli
        Elasticity.

    Returns
    -------
    Influence
    """
    spread = SPREAD * module
    ends = flanks + _END * module * np.array([1.0, -1.0])
    half, middle = 0.5 * np.diff(ends, axis=1), ends.mean(axis=1, keepdims=True)
    along = middle + half * _nodes()
    to_end = np.minimum(along - flanks[:, :1], flanks[:, 1:] - along)
    places, widths = along.ravel(), np.minimum(to_end, spread).ravel()
    points, tangents = region.teeth.at(places)
    outline, sizes = outline_sizes(region, module, spans, fillet=_FILLET, flank=SPREAD)
    sources = np.concatenate([outline, points]), np.concatenate([sizes, widths])
    mesh = CurvedMesh.of(graded(region, *sources, LARGEST * module))
    body = ElasticBody(mesh=mesh, moduli=moduli)
    loads = [
        FlankLoad(curve=region.toothed, place=float(s), half_width=float(width), force=force)
        for s, width, force in zip(places, widths, (1j * tangents).tolist(), strict=True)
    ]
    forces = nodal_forces(mesh, loads)
    root_s, at_root, root_tooth = _roots(body, module, spans)
    compliance = np.empty((len(loads), len(loads)))
    roots = np.empty((len(root_s), len(loads)))
    loaded = np.flatnonzero(forces.any(axis=1))
    work = forces[loaded].conj().T
    for first in range(0, len(loads), _BLOCK):
        some = slice(first, first + _BLOCK)
        moved = body.displacements(forces[:, some])
        compliance[:, some] = (work @ moved[loaded]).real
        for number, one in enumerate(moved.T, start=first):
            roots[:, number] = edge_stress(body, one, region.toothed).stress[at_root]
    compliance = 0.5 * (compliance + compliance.T)
    # a shorter arc moves more at its own place, as on a half plane
    own = 2.0 / (np.pi * moduli.along_edge) * np.log(widths / spread)
    compliance[np.diag_indices(len(own))] += own
    return Influence(
        body=body,
        module=module,
        numbers=numbers,
        ends=ends,
        spread=spread,
        compliance=compliance,
        root_s=root_s,
        root_tooth=root_tooth,
        roots=roots,
    )


def _roots(body: ElasticBody, module: float, spans: Array) -> tuple[Array, Ints, Ints]:
    """Return s of the Gauss points in fillets, their indices, and the rows of their teeth."""
    region = body.mesh.region
    edge = edge_stress(body, np.zeros(len(body.mesh.nodes), dtype=np.complex128), region.toothed)
    at = np.flatnonzero(in_fillets(edge, module))
    length = region.teeth.length
    beyond = (edge.s[at, None] - spans[:, 0]) % length
    tooth = np.argmin(beyond, axis=1)  # that whose span begins last before it
    inside = beyond[np.arange(len(at)), tooth] < spans[tooth, 1] - spans[tooth, 0]
    at, tooth = at[inside], tooth[inside]
    order = np.lexsort((edge.s[at], tooth))
    return edge.s[at[order]], at[order], tooth[order]
