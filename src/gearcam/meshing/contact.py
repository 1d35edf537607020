"""Points of contact at given phases, with sliding, relative curvature and direction of force.

For wheels as designed or as mounted (see `gearcam.gears.contact`).
"""

from __future__ import annotations

from collections.abc import Sequence
from dataclasses import dataclass, fields

import numpy as np
from numpy.typing import ArrayLike

from gearcam.gears.contact import FlankPairs, FlankPositions, normals, touch
from gearcam.numeric.arrays import Array, Ints, Mask, Plane

_NEAR, _FARTHER = 0.5, 20.0
"""Near a jump of the curvature flanks may touch at more than one place: within this many pitches of
it, and within this multiple of their distance at the nominal contact."""

_ROUNDING = 1e-9
"""Offset of the two sides of a jump, as a share of that range."""

_DIGITS = 12
"""Decimal places of leads, rad or mm, above rounding."""


@dataclass(frozen=True, eq=False, kw_only=True)
class Contacts:
    """Points of contact, one entry each.

    Parameters
    ----------
    step : (n,) int array
        Number of the phase.
    pair : (n,) int array
        j.
    lead : (n,) array, rad
        Angle of the driven wheel from its nominal position when this pair touches; for a rack mm.
    drift : (n,) array
        Derivative of the lead by the phase: by so much the ratio differs from the nominal one.
    point, force : (n,) complex arrays, mm and 1
        The point, and the unit direction of the driver's force.
    pressure_angle : (n,) array, rad
        Between the force and the perpendicular to the line of centres; positive if the force
        separates the teeth: it pushes the shafts apart, those of a ring and its wheel together.
    sliding : (n,) array, mm/rad
        Sliding speed along the driver's flank, towards its tip, per rad of the driver: driver's
        arc less driven arc.
    specific : (2, n) array
        Specific sliding of both wheels: the difference of the arcs over the wheel's own arc
        (000, eqs. 4.84, 4.85).
    curvature : (n,) array, 1/mm
        Relative curvature of the flanks.
    lever : (2, n) array, mm
        Distance of the line of force from both shafts; of a rack the cosine of its angle to the
        travel.
    """

    step: Ints
    pair: Ints
    lead: Array
    drift: Array
    point: Plane
    force: Plane
    pressure_angle: Array
    sliding: Array
    specific: Array
    curvature: Array
    lever: Array

    def take(self, index: Ints | Mask) -> Contacts:
        """Return some of the points of contact."""
        return Contacts(**{one.name: getattr(self, one.name)[..., index] for one in fields(self)})

    @staticmethod
    def joined(found: Sequence[Contacts]) -> Contacts:
        """Return the points of contact of all `found`, one after the other."""
        values = {one.name: [getattr(each, one.name) for each in found] for one in fields(Contacts)}
        return Contacts(**{name: np.concatenate(each, axis=-1) for name, each in values.items()})


def contacts(pairs: FlankPairs, phi1: ArrayLike) -> Contacts:
    """Return every point of contact of a side at phases.

    Parameters
    ----------
    pairs : FlankPairs
        The side.
    phi1 : (n,) array, rad
        Phases.

    Returns
    -------
    Contacts
        Ordered by phase, then by pair.

    Notes
    -----
    A contact at the rolls ``u = sf - s`` of both flanks moves along them by ``dS1 = -g1*ds1`` and
    ``dS2 = g2*ds2`` with ``g1 = sigma*sin(alpha) + u1*kappa1*cos(alpha)`` and ``g2 =
    -sigma*sin(alpha) + u2*kappa2*cos(alpha)``; as designed ds1 = ds2. Flanks have the curvatures
    kappa/g.
    """
    phi1 = np.atleast_1d(np.asarray(phi1, dtype=float))
    side = pairs.side
    step, pair, limits = sought(pairs, phi1, FlankPositions(phi1, phi1, phi1, np.zeros(phi1.shape)))
    positions, at, touching = touch(pairs, phi1[step], pairs.separation(pair), limits=limits)
    rolled = [
        wheel.sigma * (wheel.place(pair) - pairs.track.arc_length(angle))
        for wheel, angle in zip(pairs.wheels, (positions.one, positions.two), strict=True)
    ]
    for wheel, w in zip(pairs.wheels, rolled, strict=True):
        low, high = wheel.reach(pair)
        touching = touching & (w >= low) & (w <= high)
    kept = outermost(step, pair, -side * positions.lead, touching)
    step, pair, positions, at = step[kept], pair[kept], positions.take(kept), at.take(kept)
    first, second = at.frames
    one, two = (wheel.toothing for wheel in pairs.wheels)
    sf = [wheel.place(pair) for wheel in pairs.wheels]
    normal = at.normal[0]
    point = at.foot[0] + one.ahead(first, sf[0]) * normal
    by_one, by_two, drift = at.rates
    g1 = side * one.regularity(first, sf[0], side)
    g2 = -side * two.regularity(second, sf[1], -side)
    way1, way2 = g1 * by_one * first.speed, g2 * by_two * second.speed
    force = side * normal
    own = np.imag(np.conj(point) * force)
    lever = np.abs(np.stack([own, pairs.guide.lever(point - pairs.distance, force)]))
    with np.errstate(divide="ignore", invalid="ignore"):
        specific = np.stack([(way1 + way2) / way1, (way1 + way2) / way2])
        curvature = side * (first.kappa / g1 - second.kappa / g2)
    return Contacts(
        step=step,
        pair=pair,
        lead=positions.lead,
        drift=drift,
        point=point,
        force=force,
        pressure_angle=np.arctan2(force.real, side * force.imag),
        sliding=-(way1 + way2),
        specific=specific,
        curvature=curvature,
        lever=lever,
    )


def sought(
    pairs: FlankPairs, phi1: Array, nominal: FlankPositions
) -> tuple[Ints, Ints, tuple[Array, Array] | None]:
    """Return the intervals in which to search for common normals of flanks.

    Near a jump of the curvature flanks mounted at another distance may have more than one, and
    Newton's method may find none: there each side of the jump is searched too.

    Parameters
    ----------
    pairs : FlankPairs
        The side.
    phi1 : (n,) array, rad
        Phases.
    nominal : FlankPositions
        Start of the search.

    Returns
    -------
    step, pair : (k,) int arrays
        Numbers of phases, and j; some more than once.
    limits : ((k,) array, (k,) array) or None
        Driver angles, rad, that bound the rolls; None if no jump is near.
    """
    step, pair = pairs.beside(phi1)
    track, speed = pairs.track, pairs.track.frames(phi1, curved=False).speed
    reach = _NEAR * pairs.pitch / speed
    near, knot = track.jumps_between(phi1 - reach, phi1 + reach, pairs.pitch)
    if not near.size:
        return step, pair, None
    some, first = np.unique(step, return_index=True)
    at = normals(pairs, nominal.take(some), pairs.separation(pair[first]))
    apart = np.zeros(phi1.shape)
    apart[some] = np.abs(at.equations[1:]).max(axis=0)
    # the jump nearest to each phase
    away = np.abs(knot - phi1[near]) * speed[near]
    nearest = np.argsort(away, kind="stable")
    nearest = nearest[(away <= _FARTHER * apart[near])[nearest]]
    which, first = np.unique(near[nearest], return_index=True)
    knot, beside = knot[nearest[first]], _ROUNDING * reach[which]
    low, high = np.full(phi1.shape, np.nan), np.full(phi1.shape, np.nan)
    low[which], high[which] = knot + beside, knot - beside
    again = np.flatnonzero(np.isfinite(low[step]))
    wide = np.full(len(step), np.inf)
    ends = [np.concatenate([-wide, low[step[again]], -wide[again]])]
    ends += [np.concatenate([wide, wide[again], high[step[again]]])]
    rows = np.concatenate([np.arange(len(step)), again, again])
    return step[rows], pair[rows], (ends[0], ends[1])


def outermost(step: Ints, pair: Ints, outward: Array, touching: Mask) -> Ints:
    """Return for each pair at each phase the normal at which the driver pushes furthest.

    Parameters
    ----------
    step, pair : (n,) int arrays
        Numbers of phases, and j.
    outward : (n,) array
        Push at each normal: a lead, rad or mm, or a depth, mm.
    touching : (n,) bool array
        Mask of the candidates.

    Returns
    -------
    (k,) int array
        Indices, ordered by phase, then by pair.
    """
    at = np.flatnonzero(touching)
    at = at[np.lexsort((-np.round(outward[at], _DIGITS), pair[at], step[at]))]
    again = (np.diff(step[at]) == 0) & (np.diff(pair[at]) == 0)
    return at[np.append(True, ~again)[: len(at)]]


def contact_columns(found: Contacts, distance: complex) -> dict[str, Array]:
    """Return the table columns of points of contact.

    Parameters
    ----------
    found : Contacts
        The points.
    distance : complex, mm
        Mounted distance (see `FlankPairs`).

    Returns
    -------
    dict of str to (n,) array
        Columns by name; entries that are not finite do not exist.
    """
    return {
        "contact_radius1_mm": np.abs(found.point),
        "contact_radius2_mm": np.abs(found.point - distance),
        "pressure_angle_deg": np.degrees(found.pressure_angle),
        "sliding_mm_per_rad": found.sliding,
        "specific_sliding1": found.specific[0],
        "specific_sliding2": found.specific[1],
        "relative_curvature_per_mm": found.curvature,
    }
