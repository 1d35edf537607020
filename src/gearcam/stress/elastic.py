"""Plane elasticity on triangles of six nodes, with curved edges.

Small displacements of an isotropic body, in plane strain or plane stress, per mm of its width:
``stress = lame*trace(strain) + 2*shear*strain``. The nodes are the corners of the triangles and the
middles of their edges; on a boundary edge the middle is on the true curve, so that the error of the
stress falls with the square of the size. The stiffness is factored once, for any number of loads.

Displacements and forces are complex. Unknown ``2*n + k`` is the displacement of node n along x
(k = 0) or y (k = 1). Numbering, refinement and mapping of the triangles are scikit-fem's.
"""

from __future__ import annotations

import math
from collections.abc import Callable
from dataclasses import dataclass, replace
from functools import cached_property
from typing import TYPE_CHECKING, Any, Final, Literal, NamedTuple

import numpy as np

from gearcam.base.display import ShortRepr
from gearcam.numeric.arrays import Array, Ints, Mask, Plane, as_complex, as_pairs, indices_among
from gearcam.stress.region import BoundaryCurve, Region

if TYPE_CHECKING:
    from gearcam.stress.mesh import TriangleMesh

_DEGREE: Final = 5
"""Degree that the quadrature over a triangle integrates exactly. Products of strains are of degree
2 in a straight triangle, those of errors of stress, which are quadratic, of degree 4."""

_NODES: Final = np.array([[0.0, 1.0, 0.0, 0.5, 0.5, 0.0], [0.0, 0.0, 1.0, 0.0, 0.5, 0.5]])
"""Coordinates of the nodes within a triangle: its corners 0, 1, 2, then the middles of its edges
01, 12 and 02."""


@dataclass(frozen=True, kw_only=True)
class PlaneModuli(ShortRepr):
    """Elasticity of a material in the plane.

    Parameters
    ----------
    young : float, MPa
        Young's modulus.
    poisson : float
        Poisson's ratio, below 1/2.
    plane : {"strain", "stress"}
        No strain across the plane, as in a wide wheel, or no stress across it, as in a thin plate.
    """

    young: float
    poisson: float
    plane: Literal["strain", "stress"] = "strain"

    @property
    def shear(self) -> float:
        """Shear modulus ``E/(2*(1 + nu))``, MPa."""
        return 0.5 * self.young / (1.0 + self.poisson)

    @property
    def lame(self) -> float:
        """Lame's first parameter for strains in the plane, MPa.

        ``E*nu/((1 + nu)*(1 - 2*nu))`` in plane strain, ``E*nu/(1 - nu^2)`` in plane stress.
        """
        across = 1.0 - (2.0 if self.plane == "strain" else 1.0) * self.poisson
        return self.young * self.poisson / ((1.0 + self.poisson) * across)

    @property
    def along_edge(self) -> float:
        """Stress over strain along a free edge, MPa: ``E/(1 - nu^2)`` in plane strain, else E."""
        return self.young / (1.0 - self.poisson**2) if self.plane == "strain" else self.young

    @property
    def equivalent(self) -> float:
        """Von Mises stress on a free edge over the stress along it.

        ``sqrt(1 - nu + nu^2)`` in plane strain, where nu times that stress acts across the plane; 1
        in plane stress.
        """
        nu = self.poisson
        return math.sqrt(1.0 - nu + nu * nu) if self.plane == "strain" else 1.0

    def von_mises(self, stress: Array) -> Array:
        """Return the von Mises stress, MPa, of `stress`, (3, ...), MPa, with that across."""
        xx, yy, xy = stress
        across = self.poisson * (xx + yy) if self.plane == "strain" else np.zeros_like(xx)
        squares = (xx - yy) ** 2 + (yy - across) ** 2 + (across - xx) ** 2
        made: Array = np.sqrt(0.5 * squares + 3.0 * xy * xy)
        return made

    def energy(self, stress: Array) -> Array:
        """Return twice the elastic energy per volume, MPa, of `stress`, (3, ...), MPa."""
        xx, yy, xy = stress
        share = 0.5 * self.lame / (self.lame + self.shear)
        squares = xx * xx + yy * yy + 2.0 * xy * xy
        made: Array = (squares - share * (xx + yy) ** 2) / (2.0 * self.shear)
        return made


class Shapes(NamedTuple):
    """Shape functions of the nodes of triangles, at some points of each.

    Attributes
    ----------
    nodes : (t, 6) int array
        Nodes of each triangle.
    values : (6, q) array
        Shape functions.
    slopes : (t, 6, 2, q) array, 1/mm
        Their derivatives by x and y.
    areas : (t, q) array, mm^2
        Weights of the points in an integral over the triangle.
    """

    nodes: Ints
    values: Array
    slopes: Array
    areas: Array


def edge_shapes(x: Array) -> Array:
    """Return the shape functions of an edge's nodes at x from -1 to 1, (k,), as (k, 3)."""
    return np.stack([0.5 * x * (x - 1.0), 1.0 - x * x, 0.5 * x * (x + 1.0)], axis=-1)


def edge_slopes(x: Array) -> Array:
    """Return the derivatives by x of `edge_shapes`, (k, 3)."""
    return np.stack([x - 0.5, -2.0 * x, x + 0.5], axis=-1)


def _keys(pairs: Ints) -> Ints:
    """Return a number for each pair of corners, (k, 2), in whatever order."""
    return (pairs.min(axis=1) << 32) + pairs.max(axis=1)


@dataclass(frozen=True, eq=False, kw_only=True)
class CurvedMesh(ShortRepr):
    """Triangles of six nodes that fill a region.

    Parameters
    ----------
    region : Region
        What is meshed.
    points : (v,) complex array, mm
        Corners of the triangles: the first v nodes.
    triangles : (t, 3) int array
        Corners of each triangle, in either sense.
    ends : (b, 2) int array
        Corners at both ends of each boundary edge, curve by curve, in order along each.
    curve : (b,) int array
        Number of the curve of each boundary edge, rising.
    arcs : (b, 2) array, mm
        s on it at both ends, rising, at most a turn later than at the first edge.
    """

    region: Region
    points: Plane
    triangles: Ints
    ends: Ints
    curve: Ints
    arcs: Array

    @staticmethod
    def of(mesh: TriangleMesh) -> CurvedMesh:
        """Return the triangles of a mesh with six nodes instead of three."""
        return CurvedMesh(
            region=mesh.region,
            points=mesh.points,
            triangles=mesh.triangles,
            ends=mesh.edges,
            curve=mesh.curve,
            arcs=np.column_stack([mesh.start, mesh.end]),
        )

    @cached_property
    def _straight(self) -> Any:
        """The triangles of three nodes in scikit-fem, which numbers their edges."""
        from skfem import MeshTri1

        corners = np.ascontiguousarray(as_pairs(self.points).T)
        return MeshTri1(corners, np.ascontiguousarray(self.triangles.T))

    @cached_property
    def edges(self) -> Ints:
        """Nodes of the boundary edges, (b, 3): one end, the middle, the other end."""
        numbers = indices_among(_keys(self.ends), _keys(self._straight.facets.T.astype(np.int64)))
        return np.column_stack([self.ends[:, 0], len(self.points) + numbers, self.ends[:, 1]])

    def _half_way(self, value: Callable[[BoundaryCurve, Array], Any]) -> Any:
        """Return a value of the curves half-way along the boundary edges."""
        middles = self.arcs.mean(axis=1)
        curves = enumerate(self.region.curves)
        return np.concatenate([value(one, middles[self.curve == number]) for number, one in curves])

    @cached_property
    def middles(self) -> Plane:
        """Points of the curves half-way along the boundary edges, (b,), mm."""
        made: Plane = self._half_way(lambda curve, s: curve.at(s)[0])
        return made

    @cached_property
    def held(self) -> Mask:
        """Whether a boundary edge is held, (b,)."""
        made: Mask = self._half_way(lambda curve, s: curve.held(s))
        return made

    @cached_property
    def _curved(self) -> Any:
        """The triangles of six nodes in scikit-fem."""
        from skfem import MeshTri2

        made = MeshTri2.from_mesh(self._straight)
        made.doflocs[:, self.edges[:, 1]] = as_pairs(self.middles).T
        return made

    @cached_property
    def nodes(self) -> Plane:
        """Places of the nodes, (n,), mm."""
        return as_complex(self._curved.doflocs.T)

    def shapes(self, *, at_nodes: bool = False) -> Shapes:
        """Return the shape functions at the points of the quadrature, or `at_nodes`."""
        from skfem import Basis, ElementTriP2

        rule: Any = {"quadrature": (_NODES, np.ones(6))} if at_nodes else {"intorder": _DEGREE}
        basis = Basis(self._curved, ElementTriP2(), **rule)
        shapes: list[Any] = [shape[0] for shape in basis.basis]
        slopes = np.stack([shape.grad for shape in shapes]).transpose(2, 0, 1, 3)
        return Shapes(
            nodes=basis.element_dofs.T.astype(np.int64),
            values=np.stack([shape[0] for shape in shapes]),
            slopes=np.ascontiguousarray(slopes),
            areas=basis.dx,
        )

    def averaged(self, values: Array) -> Array:
        """Return the means at the nodes, (k, n), of values at the nodes of each triangle.

        Parameters
        ----------
        values : (k, t, 6) array
            Values of k quantities.
        """
        at, count = self.shapes(at_nodes=True).nodes.ravel(), len(self.nodes)
        times = np.bincount(at, minlength=count)
        return np.stack([np.bincount(at, one.ravel(), count) / times for one in values])

    def along(self, curve: int, s: Array) -> tuple[Ints, Array]:
        """Return the nodes of the edges at places of a boundary, and their shape functions there.

        Parameters
        ----------
        curve : int
            Number of the curve.
        s : (k,) array, mm
            Places on it, of any turn.

        Returns
        -------
        nodes, shares : (k, 3) arrays
            At a place, the displacement is the sum of those of the nodes times the shares.
        """
        here = np.flatnonzero(self.curve == curve)
        first = self.arcs[here[0], 0]
        s = first + np.mod(s - first, self.region.curves[curve].length)
        edge = here[np.searchsorted(self.arcs[here, 0], s, side="right") - 1]
        low, high = self.arcs[edge].T
        return self.edges[edge], edge_shapes((2.0 * s - low - high) / (high - low))

    def refined(self, marked: Ints) -> CurvedMesh:
        """Return the mesh with `marked` triangles divided, red-green-blue.

        New corners on the boundary are on the curves, half-way along the edges that they divide.
        """
        fine = self._straight.refined(marked)
        sides = fine.facets[:, fine.boundary_facets()].T.astype(np.int64)  # rising
        sides = sides[sides[:, 1] >= len(self.points)]
        sides = sides[np.argsort(sides[:, 1], kind="stable")]
        # the two neighbours of a new corner on the boundary are the ends of the edge it divides
        divided = indices_among(_keys(sides[:, 0].reshape(-1, 2)), _keys(self.ends))
        corners, points = sides[::2, 1], as_complex(fine.p.T)
        points[corners] = self.middles[divided]
        parts = np.ones(len(self.ends), dtype=np.int64)
        parts[divided] = 2
        second = np.cumsum(parts)[divided] - 1
        ends, arcs = np.repeat(self.ends, parts, axis=0), np.repeat(self.arcs, parts, axis=0)
        ends[second - 1, 1] = ends[second, 0] = corners
        arcs[second - 1, 1] = arcs[second, 0] = self.arcs[divided].mean(axis=1)
        return replace(
            self,
            points=points,
            triangles=fine.t.T.astype(np.int64),
            ends=ends,
            curve=np.repeat(self.curve, parts),
            arcs=arcs,
        )


@dataclass(frozen=True, eq=False, kw_only=True)
class ElasticBody(ShortRepr):
    """An elastic body that is held on a part of its boundary.

    Parameters
    ----------
    mesh : CurvedMesh
        Its mesh.
    moduli : PlaneModuli
        Its elasticity.
    held : (h,) int array, optional
        Unknowns that are 0, enough of them that it cannot move as a whole; by default those of all
        nodes on what the region says is held.
    """

    mesh: CurvedMesh
    moduli: PlaneModuli
    held: Ints | None = None

    @cached_property
    def free(self) -> Ints:
        """Unknowns that are solved for, rising."""
        held = self.held
        if held is None:
            held = (2 * self.mesh.edges[self.mesh.held][..., None] + np.arange(2)).ravel()
        return np.setdiff1d(np.arange(2 * len(self.mesh.nodes)), held)

    @cached_property
    def shapes(self) -> Shapes:
        """Shape functions at the points of the quadrature."""
        return self.mesh.shapes()

    @cached_property
    def stiffness(self) -> Any:
        """Stiffness of all unknowns, a sparse matrix, (2*n, 2*n), MPa: force per width and mm."""
        from scipy.sparse import coo_matrix

        nodes, _, slopes, areas = self.shapes
        count, shear = len(nodes), self.moduli.shear
        slopes = slopes.reshape(count, 12, -1)
        products = (slopes * areas[:, None]) @ slopes.transpose(0, 2, 1)
        products = products.reshape(count, 6, 2, 6, 2)
        # axes: triangle, node and direction of the force, node and direction of the displacement
        blocks = self.moduli.lame * products + shear * products.transpose(0, 1, 4, 3, 2)
        trace = shear * (products[:, :, 0, :, 0] + products[:, :, 1, :, 1])
        for direction in (0, 1):
            blocks[:, :, direction, :, direction] += trace
        unknowns = (2 * nodes[..., None] + np.arange(2)).reshape(count, 12)
        where = np.repeat(unknowns, 12, axis=1).ravel(), np.tile(unknowns, 12).ravel()
        size = 2 * len(self.mesh.nodes)
        return coo_matrix((blocks.ravel(), where), shape=(size, size)).tocsc()

    @cached_property
    def _factors(self) -> Any:
        from scipy.sparse.linalg import splu

        return splu(  # symmetric and positive definite: no pivots need be sought
            self.stiffness[self.free][:, self.free],
            permc_spec="MMD_AT_PLUS_A",
            diag_pivot_thresh=0.0,
            options={"SymmetricMode": True},
        )

    def displacements(self, forces: Plane) -> Plane:
        """Return the displacements of the nodes under loads.

        Parameters
        ----------
        forces : (n, k) complex array, N/mm
            Forces on the nodes per width, of each load. Where the body is held they do nothing.

        Returns
        -------
        (n, k) complex array, mm
        """
        pairs = np.stack([forces.real, forces.imag], axis=1).reshape(-1, forces.shape[1])
        moved = np.zeros(pairs.shape)
        moved[self.free] = self._factors.solve(pairs[self.free])
        made: Plane = moved[::2] + 1j * moved[1::2]
        return made

    def stress(self, moved: Plane, *, at_nodes: bool = False) -> Array:
        """Return the stress in each triangle.

        Parameters
        ----------
        moved : (n, k) complex array, mm
            Displacements of the nodes under each load.
        at_nodes : bool
            Whether at the nodes of each triangle; if not, at the points of the quadrature.

        Returns
        -------
        (3, k, t, q) array, MPa
            xx, yy and xy, of each load, in each triangle, at each of its points.
        """
        nodes, _, slopes, _ = self.mesh.shapes(at_nodes=True) if at_nodes else self.shapes
        count, loads = len(nodes), moved.shape[1]
        by = moved[nodes].transpose(0, 2, 1) @ slopes.reshape(count, 6, -1)
        by_x, by_y = by.reshape(count, loads, 2, -1).transpose(2, 1, 0, 3)
        trace = self.moduli.lame * (by_x.real + by_y.imag)
        shear = self.moduli.shear
        normal = [trace + 2.0 * shear * strain for strain in (by_x.real, by_y.imag)]
        return np.stack([*normal, shear * (by_x.imag + by_y.real)])
