"""The force of a contact on a flank, spread as Hertz has it.

The pressure of a line contact is a semi-ellipse, ``p = p0*sqrt(1 - (s/a)^2)`` with ``p0 =
2*F/(pi*a)``, of half-width a along the flank (Johnson, Contact Mechanics, 1985, section 4.2(c)). It
acts along the common normal of both flanks at the point of contact. The forces on the nodes are
integrals by a rule of its own, not that of the mesh, so that their sum is the force on any mesh.

Where less than a half-width is left to the end of a flank, the place is moved in until the arc ends
there.
"""

from __future__ import annotations

import math
from collections.abc import Sequence
from dataclasses import dataclass
from typing import Final

import numpy as np

from gearcam.base.display import ShortRepr
from gearcam.base.errors import InfeasibleError
from gearcam.mechanics import hertz
from gearcam.mechanics.material import MaterialSpec
from gearcam.numeric.arrays import Array, Plane
from gearcam.stress.elastic import CurvedMesh
from gearcam.stress.region import BoundaryCurve, Region

_POINTS: Final = 400
"""Places along the arc at which the pressure is taken."""

SIDE: Final = 1e-9
"""Distance of both sides of a corner from it, over the length of the curve: rounding."""

_ASKEW: Final = 20.0
"""Largest angle between a force and the inward normal, deg: on an edge that slides along a flank
they differ by some degrees, on the wrong flank by far more."""


@dataclass(frozen=True, kw_only=True)
class FlankLoad(ShortRepr):
    """A force on a boundary, spread over an arc.

    Parameters
    ----------
    curve : int
        Number of the curve in the region.
    place, half_width : float, mm
        s of the middle of the arc, and half its length.
    force : complex, N/mm
        The force per width.
    moved : float, mm
        By how much the place was moved along s from the point of contact; 0 away from the ends of
        flanks.
    """

    curve: int
    place: float
    half_width: float
    force: complex
    moved: float = 0.0

    @property
    def pressure(self) -> float:
        """Largest force per area, MPa."""
        return 2.0 * abs(self.force) / (math.pi * self.half_width)


def hertz_load(
    region: Region,
    point: complex,
    direction: complex,
    force: float,
    *,
    curvature: float,
    material: MaterialSpec,
    friction: float = 0.0,
) -> FlankLoad:
    """Return the force of a contact, spread over the arc that Hertz gives it.

    Parameters
    ----------
    region, point, direction, force, friction
        See `flank_load`.
    curvature : float, 1/mm
        Relative curvature of the flanks, above 0.
    material : MaterialSpec
        Of both wheels.

    Returns
    -------
    FlankLoad
    """
    width = hertz.half_width(np.array([force]), np.array([curvature]), material)
    return flank_load(
        region, point, direction, force, half_width=float(width[0]), friction=friction
    )


def flank_load(
    region: Region,
    point: complex,
    direction: complex,
    force: float,
    *,
    half_width: float,
    friction: float = 0.0,
) -> FlankLoad:
    """Return a force on a flank, spread over an arc about the point of contact.

    At a corner the nearest point of the boundary may be on the tip: the flank is that whose inward
    normal is the direction of the force.

    Parameters
    ----------
    region : Region
        The wheel.
    point, direction : complex, mm and 1
        Point of contact, and unit direction of the normal force on this wheel, in its frame.
    force : float, N/mm
        Normal force per width, above 0.
    half_width : float, mm
        Half the length of the arc.
    friction : float
        Force along the flank over the normal force, positive towards rising s.

    Returns
    -------
    FlankLoad

    Raises
    ------
    InfeasibleError
        If the flank is shorter than the arc.
    ValueError
        If no flank at the point has a normal near the direction.
    """
    place, low, high = _on_flank(region.teeth, point, direction, half_width)
    if 2.0 * half_width > high - low:
        raise InfeasibleError(
            "a contact is wider than its flank",
            value=half_width,
            limit=0.5 * (high - low),
            unit="mm",
            nearest="these are half-widths: the force is too large",
        )
    moved = min(max(place, low + half_width), high - half_width)
    return FlankLoad(
        curve=region.toothed,
        place=moved % region.teeth.length,
        half_width=half_width,
        force=force * direction * (1.0 - 1j * friction),
        moved=moved - place,
    )


def _on_flank(
    curve: BoundaryCurve, point: complex, direction: complex, reach: float
) -> tuple[float, float, float]:
    """Return s of a point of contact, and of the corners before and after it, mm."""
    length, corners = curve.length, curve.corners
    s = curve.nearest(np.array([point]))
    reach += 2.0 * float(np.abs(curve.at(s)[0] - point)[0])
    # within reach of a corner the point may belong to either side of it
    near = corners[np.abs(past(corners, float(s[0]), curve.length)) <= reach]
    places = np.concatenate([s, near, near])
    inside = places + SIDE * length * np.repeat([0.0, -1.0, 1.0], [1, len(near), len(near)])
    off = np.abs(np.angle(1j * curve.at(inside)[1] / direction))
    best = int(off.argmin())
    if math.degrees(off[best]) > _ASKEW:
        askew = f"{math.degrees(off[best]):.3g} deg off the normal of its flank"
        raise ValueError(f"a force at {point:.6g} mm is {askew}")
    if not len(corners):
        return float(s[0]), -math.inf, math.inf
    place = float(inside[best])
    low = max(corner for corner in (*corners, *(corners - length)) if corner <= place)
    high = min(corner for corner in (*corners, *(corners + length)) if corner > place)
    return float(places[best]), float(low), float(high)


def past(s: Array, place: float | Array, length: float) -> Array:
    """Return by how much `s` is past a `place` of a closed curve, mm, the shorter way round.

    Parameters
    ----------
    s, place : float, mm
        Arc lengths.
    length : float, mm
        Length of the curve.
    """
    half = 0.5 * length
    made: Array = (s - place + half) % length - half
    return made


def nodal_forces(mesh: CurvedMesh, loads: Sequence[FlankLoad]) -> Plane:
    """Return the forces on the nodes of a mesh under each of some loads.

    The semi-ellipse is the weight of the Gauss-Chebyshev rule of the second kind (Abramowitz and
    Stegun, 25.4.40), whose weights add up exactly.

    Parameters
    ----------
    mesh : CurvedMesh
        The mesh.
    loads : sequence of k FlankLoad
        The loads.

    Returns
    -------
    (n, k) complex array, N/mm
    """
    angle = np.pi * np.arange(1, _POINTS + 1) / (_POINTS + 1)
    weights = 2.0 / (_POINTS + 1) * np.sin(angle) ** 2
    made = np.zeros((len(mesh.nodes), len(loads)), dtype=np.complex128)
    for number, load in enumerate(loads):
        nodes, shares = mesh.along(load.curve, load.place + load.half_width * np.cos(angle))
        np.add.at(made[:, number], nodes, load.force * weights[:, None] * shares)
    return made


def deflections(forces: Plane, moved: Plane) -> Array:
    """Return the mean displacement at each load, in its direction, weighted with its pressure.

    Parameters
    ----------
    forces : (n, k) complex array, N/mm
        Forces of each load on the nodes.
    moved : (n, m) complex array, mm
        Displacements of the nodes under other loads, or the same.

    Returns
    -------
    (k, m) array, mm
        At each load, under each of the others.
    """
    made: Array = (forces.conj().T @ moved).real / np.abs(forces.sum(axis=0))[:, None]
    return made
