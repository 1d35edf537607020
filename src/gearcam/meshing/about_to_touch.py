"""Pairs of teeth just outside their contact arcs: how far an edge stands before the mate's flank.

A pair whose flanks do not touch touches next, or has touched last, at an end of a flank: at its
tip, an edge. Under load the driven wheel lags, the gap closes, and the edge carries a part. The
edge lies at a known height relative to the driven wheel's guide, and so does the point of the
mate's flank that it meets (see `gearcam.meshing.edges`); the turn between them is the lead of the
driven wheel at which the pair touches.

Where a flank ends at its root before the mate's tip is reached, the mate would touch a fillet:
such pairs are left out. A tip's rounding is not followed: its edge is the end of the flank, and the
gap too large by the radius times the relative curvature, some per cent of it.
"""

from __future__ import annotations

from dataclasses import dataclass

import numpy as np
from numpy.typing import ArrayLike

from gearcam.base.display import ShortRepr
from gearcam.gears.contact import FlankPairs, touch
from gearcam.meshing.contact import Contacts, outermost
from gearcam.meshing.edges import Facing, ends_of, facing, of_leading_pair
from gearcam.numeric.arrays import Array, Ints, Mask, Plane


@dataclass(frozen=True, eq=False, kw_only=True)
class EdgeGaps(ShortRepr):
    """Pairs whose edges stand before the mate's flanks, one entry each, by phase, then by pair.

    Parameters
    ----------
    step, pair : (k,) int arrays
        Number of the phase; j.
    edge_of : (k,) int array
        Wheel whose tip is the edge: 1 or 2.
    turn : (k,) array, rad, for a rack mm
        Lag of the driven wheel behind its place at first contact at which the pair touches; not
        negative.
    gap : (k,) array, mm
        `turn` times `lever`.
    point : (k,) complex array, mm
        Where the edge touches then, the driver's shaft at 0.
    force : (k,) complex array
        Unit direction of the driver's force: the normal of the flank on which the edge slides, when
        it touches (cf. `Contacts.force`).
    lever : (k,) array, mm, for a rack 1
        Distance of the line of force from the driven shaft: what the gap closes by per turn.
    curvature : (k,) array, 1/mm
        Relative curvature, as if the flank at its edge went on: that of the flanks where they meet,
        which near a knot of the law may be 0 or less, and so no less than that of the flank contact
        with which the arc ends at this edge. If undercut of the mate has removed it: the sum of the
        curvatures without their signs.
    """

    step: Ints
    pair: Ints
    edge_of: Ints
    turn: Array
    gap: Array
    point: Plane
    force: Plane
    lever: Array
    curvature: Array


def about_to_touch(pairs: FlankPairs, phi1: ArrayLike, found: Contacts, largest: float) -> EdgeGaps:
    """Return the pairs of a side that do not touch at phases, but whose edges nearly do.

    Parameters
    ----------
    pairs : FlankPairs
        The side.
    phi1 : (n,) array, rad
        Phases.
    found : Contacts
        The side's contacts at them.
    largest : float, mm
        Largest gap.

    Returns
    -------
    EdgeGaps
        Where no flanks touch at a phase, gaps are those behind the edge that touches first.

    Notes
    -----
    Without a common normal the turn between two flanks changes monotonically over their common
    heights, so that the pair touches at one end of these.
    """
    phi1 = np.atleast_1d(np.asarray(phi1, dtype=float))
    faced, heights = facing(pairs, phi1)
    apart = ~_among(faced, found)
    met = ends_of(faced.select(apart), heights[..., apart])
    some, edge_of, angles, tip = met.faced, met.edge_of, met.angles, met.tip
    (one, _), (along, other) = met.points, met.directions
    lead = met.turn
    outward = -pairs.side * lead
    first = outermost(some.step, some.pair, outward, np.ones(len(lead), dtype=bool))
    ahead = np.maximum(
        of_leading_pair(pairs.side, len(phi1), found.step, found.lead),
        of_leading_pair(pairs.side, len(phi1), some.step[first], lead[first]),
    )
    turn = ahead[some.step] - outward
    # directions along flanks are their normals, turned as the toothing is
    driver, driven = (wheel.toothing for wheel in pairs.wheels)
    turned = np.exp(1j * pairs.guide.turns * lead)
    normal = np.where(edge_of == 1, other * turned / driven.turn, along / driver.turn)
    force = pairs.side * normal
    lever = -pairs.side * pairs.guide.lever(one, force)
    gap = turn * lever
    kept = first[(tip & (lever > 0.0) & (gap <= largest))[first]]
    return EdgeGaps(
        step=some.step[kept],
        pair=some.pair[kept],
        edge_of=edge_of[kept],
        turn=turn[kept],
        gap=gap[kept],
        point=one[kept] + pairs.distance,
        force=force[kept],
        lever=lever[kept],
        curvature=_curvature(some.select(kept), edge_of[kept], angles[:, kept]),
    )


def _among(faced: Facing, found: Contacts) -> Mask:
    """Return which pairs are in contact at their phases, (n,)."""
    place = np.concatenate([faced.pair, found.pair])
    place -= place.min(initial=0)
    key = np.concatenate([faced.step, found.step]) * (place.max(initial=0) + 1) + place
    return np.isin(key[: len(faced.pair)], key[len(faced.pair) :])


def _curvature(some: Facing, edge_of: Ints, angles: Array) -> Array:
    """Return the relative curvature, 1/mm, of pairs whose edges touch (see `EdgeGaps`).

    `angles` are the driver angles, rad, of the points on both flanks, (2, n).
    """
    pairs = some.pairs
    there = _curvatures(some, angles)
    own = np.where(edge_of == 1, *angles)
    positions, _, found = touch(pairs, own, pairs.separation(some.pair), edge_of)
    ending = _curvatures(some, np.stack([positions.one, positions.two])).sum(axis=0)
    with_arc = np.maximum(there.sum(axis=0), ending)
    return np.where(found & (ending > 0.0), with_arc, np.abs(there).sum(axis=0))


def _curvatures(some: Facing, angles: Array) -> Array:
    """Return the curvatures, 1/mm, of both flanks at driver angles, (2, n): positive if convex."""
    found = []
    for flanks, sf, angle in zip(some.pairs.wheels, some.sf, angles, strict=True):
        frames = flanks.toothing.frames(angle)
        with np.errstate(divide="ignore"):
            found.append(frames.kappa / flanks.toothing.regularity(frames, sf, flanks.sigma))
    return np.stack(found)
