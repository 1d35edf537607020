"""How far the outputs of a linkage deviate by errors of its dimensions, and by loose joints.

The driver is held at an angle. A dimension that is larger by one moves each output by its
*sensitivity*: the derivative, which the formulas of the positions give as they give those by the
driver's angle. Errors of several dimensions add up, in the worst case with their sizes, or as the
root of their squares, which independent ones rarely exceed.

Clearance in a joint displaces its members along its reaction. By virtual work it moves the output
by the force that a unit of force on the output makes there, times the clearance: in the worst
direction by its size. So a pin that carries much of the output's force spoils much of its place.

Source: 000, section 2.3.
"""

from __future__ import annotations

from collections.abc import Sequence
from typing import Final

import numpy as np

from gearcam.linkages.bonds import Bond
from gearcam.linkages.coordinates import WorkCoordinate
from gearcam.linkages.efforts import AppliedForce
from gearcam.linkages.elements import Dimension
from gearcam.linkages.linkage import Linkage, value
from gearcam.linkages.reactions import reactions
from gearcam.linkages.work import displaced_by
from gearcam.numeric.arrays import Array
from gearcam.numeric.jets import Jet

_TURN: Final = 2.0 * np.pi


def dimensions_of(linkage: Linkage) -> tuple[Dimension, ...]:
    """Return all dimensions of a linkage, in order."""
    return tuple(one for element in linkage.elements for one in element.dimensions())


def deviated(linkage: Linkage, dimension: Dimension, by: Jet | float) -> Linkage:
    """Return a linkage with an error of one of its dimensions.

    Parameters
    ----------
    linkage : Linkage
        The linkage.
    dimension : Dimension
        One of `dimensions_of`.
    by : Jet or float, mm or rad
        The error.
    """
    elements = tuple(
        one.deviated(dimension, by) if dimension in tuple(one.dimensions()) else one
        for one in linkage.elements
    )
    return Linkage(elements, linkage.knots, linkage.closed)


def sensitivities(
    linkage: Linkage, quantities: Sequence[str], q: Array
) -> dict[str, dict[str, Array]]:
    """Return the derivatives of quantities by all dimensions, with the driver held.

    Parameters
    ----------
    linkage : Linkage
        The linkage.
    quantities : sequence of str
        See `Linkage.track`.
    q : (n,) array, rad
        The driver's angles.

    Returns
    -------
    dict of str to dict of str to (n,) array
        By names of dimensions, then of quantities: in mm or rad, per mm or rad.
    """
    held, found = displaced_by(linkage, {}), dict[str, dict[str, Array]]()
    unit = Jet([np.zeros(q.shape), 1.0])
    for dimension in dimensions_of(linkage):
        known = deviated(held, dimension, unit).at(q, 1)
        found[dimension.name] = {
            name: np.asarray(value(known, name).c[1]) + np.zeros(q.shape) for name in quantities
        }
    return found


def clearance(linkage: Linkage, output: WorkCoordinate, q: Array) -> dict[Bond, Array]:
    """Return how far clearance of one in each joint and guide moves an output, at most.

    Parameters
    ----------
    linkage : Linkage
        The linkage.
    output : WorkCoordinate
        The output.
    q : (n,) array, rad
        The driver's angles.

    Returns
    -------
    dict of Bond to (n,) array
        In mm or rad, per mm.
    """
    found = reactions(linkage, [AppliedForce(output, lambda _: 1.0)], q)
    return {bond: np.abs(found.force(bond)) for bond in found.structure.joints}


def places(linkage: Linkage, quantities: Sequence[str], q: Array) -> Array:
    """Return quantities, (k, n), mm or rad, of a linkage whose dimensions may deviate.

    Parameters
    ----------
    linkage : Linkage
        The linkage.
    quantities : sequence of str
        See `Linkage.track`.
    q : (n,) array, rad
        The driver's angles.
    """
    known = linkage.at(q, 0)
    return np.stack(
        [np.asarray(value(known, name).c[0]) + np.zeros(q.shape) for name in quantities]
    )


def apart(one: Array, other: Array, angle: Array) -> Array:
    """Return differences of quantities; of angles those within half a turn.

    Parameters
    ----------
    one, other : (k, n) arrays, mm or rad
        The quantities.
    angle : (k,) bool array
        Which are angles.
    """
    found = one - other
    whole: Array = np.where(angle[:, None], found - _TURN * np.round(found / _TURN), found)
    return whole
