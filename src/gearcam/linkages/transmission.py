"""How well each dyad passes on a force: pressure angle, or how near a swinging guide is to its jam.

The transmission angle is 90 degrees less the pressure angle. Both are between 0 and 90 degrees:

======== =========================================================================================
dyad     pressure angle
======== =========================================================================================
RRR      90 degrees less the angle between its members
RRT, TRR between its rod and the guide
RTR      none: the distance of its outer joints along the member that is a guide, ``l0``
TRT      90 degrees less the angle between its guides
RTT, TTR 90 degrees less the angle between the guide and the member that is one; a constant
======== =========================================================================================

Where a pressure angle is 90 degrees, or the distance 0, the dyad is singular.
"""

from __future__ import annotations

import math
from collections.abc import Callable, Mapping
from typing import Final, NamedTuple

import numpy as np

from gearcam.linkages.dyads import rtr_reach
from gearcam.linkages.elements import Dyad
from gearcam.linkages.known import Known
from gearcam.linkages.linkage import Linkage
from gearcam.linkages.measures import Peak, TrackMeasures
from gearcam.linkages.plane import cross, dot, square
from gearcam.numeric.arrays import Array
from gearcam.numeric.jets import Jet


class Admissible(NamedTuple):
    """What 000, 2.2 allows: the safe and the last value.

    Attributes
    ----------
    pressure_angle : (float, float), rad
        Largest pressure angle; nan for RTR.
    distance : (float, float)
        Least distance ``l0`` of a swinging guide, as a share of its crank's length; nan for others.
    """

    pressure_angle: tuple[float, float]
    distance: tuple[float, float] = (math.nan, math.nan)


_ROD: Final = Admissible((math.radians(30.0), math.radians(45.0)))
_GUIDE: Final = Admissible((math.nan, math.nan), (0.2, 0.1))

ADMISSIBLE: Final[Mapping[str, Admissible]] = {
    "RRR": Admissible((math.radians(45.0), math.radians(60.0))),
    "RRT": _ROD,
    "TRR": _ROD,
    "RTR1": _GUIDE,
    "RTR2": _GUIDE,
}
"""By the type of a dyad, as 000, 2.2 gives it: RRR as in a four-bar or with a cylinder, RRT as in
a crank-slider, RTR as in a swinging guide. It says nothing of the others."""


_LINES: Final[Mapping[str, Callable[[Dyad], tuple[str, str]]]] = {
    "RRR": lambda dyad: dyad.members,
    "RRT": lambda dyad: (dyad.second, dyad.members[0]),
    "TRR": lambda dyad: (dyad.first, dyad.members[1]),
    "TRT": lambda dyad: (dyad.first, dyad.second),
    "RTT": lambda dyad: (dyad.second, dyad.members[1]),
    "TTR": lambda dyad: (dyad.first, dyad.members[0]),
}
"""The two members or guides between which the angle of each type of dyad is."""


class Transmission(NamedTuple):
    """The worst place of a dyad.

    Attributes
    ----------
    dyad : Dyad
        The dyad.
    pressure_angle : Peak or None
        The largest pressure angle, rad, and the driver's angle; none for RTR.
    distance : Peak or None
        For RTR the least ``l0 = sqrt(D^2 - (l*sin(beta))^2)``, mm (000, 2.2).
    share : float
        What is left before the dyad is singular, 0 to 1: the cosine of the pressure angle, or
        ``l0/D``.
    """

    dyad: Dyad
    pressure_angle: Peak | None
    distance: Peak | None
    share: float


def pressure_angle(known: Known, dyad: Dyad) -> Array:
    """Return the pressure angle of a dyad that is not RTR.

    Parameters
    ----------
    known : Known
        The solved linkage.
    dyad : Dyad
        Of the linkage.

    Returns
    -------
    (n,) array, rad
        From 0 to pi/2.

    Raises
    ------
    ValueError
        For RTR: it always passes forces at right angles to its guide.
    """
    if dyad.type not in _LINES:
        raise ValueError(f"{dyad.type} has no pressure angle; allowed are {', '.join(_LINES)}")
    across, along = _parts(known, dyad)
    return _angle(np.asarray(across.c[0]), np.asarray(along.c[0]))


def guide_distance(known: Known, dyad: Dyad) -> Jet:
    """Return the squared distance ``l0^2 = D^2 - (l*sin(beta))^2`` of an RTR dyad.

    Parameters
    ----------
    known : Known
        The solved linkage.
    dyad : Dyad
        Of type RTR1 or RTR2.

    Returns
    -------
    Jet, mm2
    """
    reach = rtr_reach(known.solved[dyad.joint], dyad.sizes(known))
    return reach * reach


def guide_distances(linkage: Linkage, dyad: Dyad) -> TrackMeasures:
    """Return measures of the squared distance of an RTR `dyad` of a `linkage`, mm2."""
    return _measures(linkage, lambda known: guide_distance(known, dyad))


def transmissions(linkage: Linkage) -> tuple[Transmission, ...]:
    """Return the worst place of each dyad of a linkage.

    Parameters
    ----------
    linkage : Linkage
        One that closes over its whole range.

    Returns
    -------
    tuple of Transmission
        In the order of its dyads.
    """
    return tuple(transmission_of(linkage, dyad) for dyad in linkage.dyads)


def transmission_of(linkage: Linkage, dyad: Dyad) -> Transmission:
    """Return the worst place of one `dyad` of a `linkage` (see `transmissions`)."""
    if dyad.type in ("RTR1", "RTR2"):
        least = guide_distances(linkage, dyad).least()
        known = linkage.at(np.array([least.place]), 0)
        whole = np.asarray(square(known.jet(dyad.second) - known.jet(dyad.first)).c[0])
        distance = math.sqrt(max(least.value, 0.0))
        share = distance / float(np.sqrt(whole[0]))
        return Transmission(dyad, None, Peak(distance, least.place), share)
    # extremes of the sine are those of the angle, and its jet is smooth at change points too
    sine = _measures(linkage, lambda known: _parts(known, dyad)[0])
    place = max(sine.least(), sine.largest(), key=lambda one: abs(one.value)).place
    known = linkage.at(np.array([place]), 0)
    across, along = (np.asarray(one.c[0]) for one in _parts(known, dyad))
    largest = Peak(float(_angle(across, along)[0]), place)
    return Transmission(dyad, largest, None, float(np.abs(along[0])))


def _measures(linkage: Linkage, of: Callable[[Known], Jet]) -> TrackMeasures:
    def track(q: Array, order: int) -> Jet:
        return of(linkage.at(q, order)).upto(order)

    return TrackMeasures(track, linkage.knots, linkage.closed, highest=0)


def _parts(known: Known, dyad: Dyad) -> tuple[Jet, Jet]:
    """Return sine and cosine, but for their signs, of a dyad's pressure angle."""
    lines = [known.frame(name).direction for name in _LINES[dyad.type](dyad)]
    sine, cosine = cross(*lines), dot(*lines)
    return (sine, cosine) if dyad.type in ("RRT", "TRR") else (cosine, sine)


def _angle(across: Array, along: Array) -> Array:
    return np.arctan2(np.abs(across), np.abs(along))
