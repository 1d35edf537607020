"""The phases of a study: evenly spaced over its range, or those of some teeth."""

from __future__ import annotations

import numpy as np

from gearcam.base.errors import InfeasibleError
from gearcam.base.numerals import shown
from gearcam.gears.contact import FlankPairs
from gearcam.meshing.settings import MeshingSpec
from gearcam.numeric.arrays import Array

_BESIDE = 0.15
"""Range studied with `teeth`, before and after the teeth's arcs of contact, in pitches."""

_STOP = 1e-7
"""Share of the travel by which given degrees may pass a stop: rounding."""


def stretch(spec: MeshingSpec, pairs: FlankPairs) -> tuple[float, float]:
    """Return the first and last driver angle of a study, rad.

    Parameters
    ----------
    spec : MeshingSpec
        Settings.
    pairs : FlankPairs
        Either side.

    Returns
    -------
    start, end : float, rad
    """
    if spec.end is not None:
        return spec.start, spec.end
    return spec.start, pairs.travel + (spec.start if pairs.closed else 0.0)


def phases(spec: MeshingSpec, pairs: FlankPairs) -> Array:
    """Return the phases of a study, rad.

    Parameters
    ----------
    spec : MeshingSpec
        Settings.
    pairs : FlankPairs
        The side pressed together.

    Returns
    -------
    (n,) array
        All phases, or with `teeth` those with these teeth in or near contact.

    Raises
    ------
    InfeasibleError
        If there are none, or the range leaves the travel of open wheels or a rack.
    """
    first, last = stretch(spec, pairs)
    if not last > first:
        raise InfeasibleError(
            f"the study ends at {shown(np.degrees(last))} deg before it begins",
            where="meshing.from_deg",
            nearest=f"give a start below {shown(np.degrees(last))} deg",
        )
    phi1 = np.linspace(first, last, spec.steps, endpoint=not pairs.closed)
    if not pairs.closed:
        _demand_travel(first, last, pairs.travel)
    if spec.teeth is None:
        return phi1
    track = pairs.track
    wanted = np.isin(pairs.tooth(1, pairs.numbers), spec.teeth)
    start, end = (track.arc_length(edge[wanted]) for edge in pairs.arcs)
    apart = track.arc_length(phi1)[:, None] - start
    margin = _BESIDE * pairs.pitch
    if pairs.closed:
        apart = np.mod(apart + margin, track.length) - margin
    inside = (apart >= -margin) & (apart <= end - start + margin)
    chosen = phi1[inside.any(axis=1)]
    if not chosen.size:
        angles = np.degrees(track.angle(0.5 * (start + end)))
        raise InfeasibleError(
            "these teeth are in contact in none of the phases",
            where="meshing.teeth",
            nearest="they are in contact near phi1 = "
            + ", ".join(f"{shown(angle, 4)}" for angle in angles)
            + " deg; use more steps or another range",
        )
    return chosen


def _demand_travel(first: float, last: float, travel: float) -> None:
    """Refuse phases beyond the ends of travel of open wheels and racks."""
    early = first < -_STOP * travel
    if early or last > (1.0 + _STOP) * travel:
        raise InfeasibleError(
            "the study leaves the travel of the pair",
            where=f"meshing.{'from' if early else 'to'}_deg",
            value=float(np.degrees(first if early else last)),
            limit=0.0 if early else float(np.degrees(travel)),
            unit="deg",
            nearest=f"the travel lies between 0 and {shown(np.degrees(travel), 8)} deg",
        )
