"""What the inertia of a linkage exerts on its frame, and counterweights against it.

The *shaking force* is the sum of the inertia forces of all members, the *shaking moment* their
moment about the machine's origin; weights, loads and springs are left out, which do not change
with the speed or act between members and frame.

A counterweight on a member that turns about a fixed hinge adds a force in proportion to its mass
times its distance from the hinge, so that the best ones are found by linear least squares over a
cycle. For a four-bar with counterweights on both members at the frame the shaking force vanishes;
for a slider-crank, its component across the guide with one on the crank (000, eqs. 5.65 and 5.69).

A rotor whose unbalances are in several planes across its axis is balanced by weights in any two:
together they have the sum of the unbalances, and their moment about any point.

Source: 000, section 5.2.
"""

from __future__ import annotations

from collections.abc import Sequence
from dataclasses import dataclass
from typing import Final

import numpy as np

from gearcam.base.display import ShortRepr
from gearcam.linkages.coordinates import WorkState
from gearcam.linkages.efforts import Effort, InertiaForce
from gearcam.linkages.elements import MemberPoint
from gearcam.linkages.known import GROUND
from gearcam.linkages.linkage import Linkage
from gearcam.linkages.reactions import Structure
from gearcam.numeric.arrays import Array, Plane

MILLI: Final = 1e-3
"""N over kg mm/s2."""


@dataclass(frozen=True, eq=False, kw_only=True)
class Shaking(ShortRepr):
    """What inertia exerts on the frame, at n angles of the driver.

    Parameters
    ----------
    force : (n,) complex array, N
        The shaking force.
    moment : (n,) array, N mm
        The shaking moment about the machine's origin.
    """

    force: Plane
    moment: Array


def shaking(linkage: Linkage, efforts: Sequence[Effort], q: Array, speed: float) -> Shaking:
    """Return what the masses of a linkage exert on its frame.

    Parameters
    ----------
    linkage : Linkage
        The linkage.
    efforts : sequence of Effort
        What acts on it; of these the inertia forces count.
    q : (n,) array, rad
        The driver's angles.
    speed : float, rad/s
        Of the driver, even.
    """
    structure, state = Structure.of(linkage), WorkState(linkage, q, 0, speed)
    held = structure.held(state.known)
    force, moment = np.zeros(q.shape, dtype=complex), np.zeros(q.shape)
    for effort in efforts:
        if isinstance(effort, InertiaForce):
            acting = effort.acting(state)
            parts = list(effort.coordinate.wrenches(held, acting))
            if not parts:  # what turns with a shaft
                moment = moment + acting.real
            for member, wrench in parts:
                if member != GROUND:
                    force, moment = force + wrench.force, moment + wrench.moment
    return Shaking(force=force, moment=moment)


def harmonics(values: Array, highest: int) -> Array:
    """Return amplitudes of values at even steps of a cycle.

    Parameters
    ----------
    values : (n,) array
        Without the last place of the cycle.
    highest : int
        Number of the highest harmonic, below n/2.

    Returns
    -------
    (highest + 1, 2) array
        Factors of the cosine and of the sine of each harmonic, the mean first.
    """
    count = len(values)
    angle = 2.0 * np.pi / count * np.outer(np.arange(highest + 1), np.arange(count))
    parts: Array = np.stack([np.cos(angle) @ values, np.sin(angle) @ values], axis=1) * (
        2.0 / count
    )
    parts[0] *= 0.5
    return parts


def counterweights(
    linkage: Linkage,
    members: Sequence[str],
    force: Plane,
    q: Array,
    speed: float,
    *,
    direction: complex | None = None,
) -> Plane:
    """Return the counterweights that leave the least shaking force, in the mean of its square.

    Parameters
    ----------
    linkage : Linkage
        The linkage.
    members : sequence of str
        Members that turn about the origin of their frame, which stands still.
    force : (n,) complex array, N
        The shaking force.
    q : (n,) array, rad
        The driver's angles, at even steps of a cycle.
    speed : float, rad/s
        Of the driver.
    direction : complex, optional
        Of size 1: only the component of the force in this direction counts.

    Returns
    -------
    (m,) complex array, kg mm
        Mass times place in each member's frame.
    """
    known = linkage.at(q, 2)
    columns = []
    for name in members:
        direction_of = known.frame(name).direction.derivatives()
        turned = -MILLI * speed**2 * np.asarray(direction_of[2])
        columns += [turned, 1j * turned]  # along x and along y of the member
    system: Plane = np.stack(columns, axis=1)
    right = -force
    if direction is None:
        rows, wanted = np.concatenate([system.real, system.imag]), [right.real, right.imag]
        found = np.linalg.lstsq(rows, np.concatenate(wanted))[0]
    else:
        turn = np.conj(direction)
        found = np.linalg.lstsq((system * turn).real, (right * turn).real)[0]
    made: Plane = found[::2] + 1j * found[1::2]
    return made


def with_counterweights(
    linkage: Linkage, members: Sequence[str], unbalances: Plane, radius: float
) -> tuple[Linkage, list[InertiaForce]]:
    """Return a linkage with counterweights as points, and their inertia forces.

    Parameters
    ----------
    linkage : Linkage
        The linkage.
    members : sequence of str
        The members that have them.
    unbalances : (m,) complex array, kg mm
        Mass times place of each.
    radius : float, mm
        Distance of all of them from their hinges.
    """
    points, forces = [], []
    for member, one in zip(members, unbalances.tolist(), strict=True):
        if one:
            name = f"{member}.counterweight"
            points.append(MemberPoint(name, radius * one / abs(one), member))
            forces.append(InertiaForce.of_mass(name, abs(one) / radius, member))
    return Linkage((*linkage.elements, *points), linkage.knots, linkage.closed), forces


def two_planes(unbalance: complex, lever: complex, planes: Sequence[float]) -> tuple[complex, ...]:
    """Return what two planes carry of the unbalance of a rotor: weights opposite to it balance it.

    Parameters
    ----------
    unbalance : complex, kg mm
        Sum of the unbalances of its parts in its frame.
    lever : complex, kg mm2
        Sum of each of them times its place along the axis.
    planes : two float, mm
        Places of the planes along the axis, apart.

    Returns
    -------
    two complex, kg mm
        With the sum and the lever of the parts.
    """
    first, second = planes
    width = second - first
    return (second * unbalance - lever) / width, (lever - first * unbalance) / width
