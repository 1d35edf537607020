"""How teeth that touch together share the load, and how far the driven wheel lags.

The normals of all contacts of a phase pass through one pitch point, so one condition of equilibrium
is enough: ``sum F_i*g_i = T``, with the levers g_i of the forces about the driven shaft, friction
included. With the lag e of the driven wheel behind the place at which flanks touch, each contact
closes by ``a_i*e``, with the lever a_i of the normal, and its bodies take this::

    sum_j C_ij*F_j + local_i(F_i) + gap_i = a_i*e   where F_i > 0, and >= where F_i = 0

C is the compliance of both wheels under loads that are spread over a known arc of half-width b. The
contact itself is narrower, by a ratio that depends on its force: what the half planes add is
``F*(1/2 + 2*ln(b/a))/(pi*E')`` in each wheel, with Hertz's half-width a (from Johnson, Contact
Mechanics, 1985, section 5.6: two spreads of one force on a half plane differ at a distance by
nothing).

All phases are solved at once by Newton's method with active contacts.
"""

from __future__ import annotations

from dataclasses import dataclass
from typing import Final

import numpy as np

from gearcam.base.display import ShortRepr
from gearcam.base.errors import InfeasibleError
from gearcam.mechanics.hertz import half_width
from gearcam.mechanics.material import MaterialSpec
from gearcam.numeric.arrays import Array

_STEPS: Final = 60
"""Largest number of Newton steps: a dozen is usual."""

_SMALL: Final = 1e-12
"""Relative change of the forces at which they are known."""

_LEAST: Final = 1e-9
"""Least force of a contact that carries, over the mean one: below it the logarithm is not taken."""


@dataclass(frozen=True, eq=False, kw_only=True)
class Sharing(ShortRepr):
    """Forces and lags at n phases with up to m contacts.

    Parameters
    ----------
    force : (n, m) array, N/mm
        Normal forces per width; 0 where a contact does not carry.
    lag : (n,) array, rad or mm
        Lag of the driven element.
    stiffness : (n,) array, N mm/(mm rad)
        Derivative of the load by the lag, per width.
    """

    force: Array
    lag: Array
    stiffness: Array


@dataclass(frozen=True, kw_only=True)
class ContactWidths(ShortRepr):
    """What makes the half-widths of contacts, and what they add to the compliance.

    Parameters
    ----------
    material : MaterialSpec
        Of both wheels.
    local : float, mm^2/N
        ``1/(pi*E1') + 1/(pi*E2')``, E' the modulus along a free edge.
    spread : float, mm
        Half-width b over which the loads of the compliance are spread, of both wheels.
    """

    material: MaterialSpec
    local: float
    spread: float

    def closed(self, force: Array, curvature: Array) -> tuple[Array, Array]:
        """Return by what contacts close beside the compliance, mm, and its slope, mm^2/N.

        Parameters
        ----------
        force : array, N/mm
            Forces per width.
        curvature : array, 1/mm
            Relative curvatures.
        """
        width = half_width(force, curvature, self.material)
        shared = self.local * (0.5 + 2.0 * np.log(self.spread / width))
        return force * shared, shared - self.local


def share(
    compliance: Array,
    lever: Array,
    gain: Array,
    gap: Array,
    curvature: Array,
    load: Array,
    widths: ContactWidths,
) -> Sharing:
    """Return how contacts share loads.

    Parameters
    ----------
    compliance : (n, m, m) array, mm^2/N
        Of both wheels together, symmetric.
    lever : (n, m) array, mm
        Levers of the normals about the driven shaft, above 0; 0 where there is no such contact.
    gain : (n, m) array, mm
        Levers of the forces with friction: of equilibrium, above 0.
    gap : (n, m) array, mm
        Distance of the flanks along their normal, 0 of those that touch.
    curvature : (n, m) array, 1/mm
        Relative curvatures, above 0.
    load : (n,) array, N mm/mm
        Torques of the driven shaft per width, above 0.
    widths : ContactWidths
        Of the contacts.

    Returns
    -------
    Sharing

    Raises
    ------
    InfeasibleError
        If no shares were found.
    """
    count, most = lever.shape
    there = lever > 0.0
    first = np.where(there, gap / np.where(there, lever, 1.0), np.inf)
    carries = there & (first <= first.min(axis=1, keepdims=True))
    force = load[:, None] * np.where(carries, gain, 0.0)
    force /= (force * gain).sum(axis=1, keepdims=True) / load[:, None]
    scale = load / gain.max(axis=1)
    lag = np.zeros(count)
    diagonal = np.arange(most)
    system = np.zeros((count, most + 1, most + 1))
    for _ in range(_STEPS):
        held = np.maximum(force, _LEAST * scale[:, None])
        extra, slope = widths.closed(held, curvature)
        closing = np.einsum("nij,nj->ni", compliance, force) + np.where(carries, extra, 0.0) + gap
        system[:, :most, :most] = compliance
        system[:, diagonal, diagonal] += slope
        # a contact that does not carry has the equation F = 0
        system[:, :most][~carries] = 0.0
        system[:, diagonal, diagonal] = np.where(carries, system[:, diagonal, diagonal], 1.0)
        system[:, :most, most] = np.where(carries, -lever, 0.0)
        system[:, most, :most] = np.where(there, gain, 0.0)
        system[:, most, most] = 0.0
        left = np.where(carries, lever * lag[:, None] - closing, -force)
        rest = load - (force * gain).sum(axis=1)
        step = np.linalg.solve(system, np.column_stack([left, rest])[..., None])[..., 0]
        moved, lag = force + step[:, :most], lag + step[:, most]
        pressed = there & np.where(carries, moved > 0.0, lever * lag[:, None] > closing)
        force = np.where(carries & pressed, moved, 0.0)
        same = (pressed == carries).all()
        carries = pressed
        if same and (np.abs(step[:, :most]) <= _SMALL * scale[:, None]).all():
            break
    else:
        raise InfeasibleError("how the teeth share the load was not found", where="load")
    # the last unknown is the lag: its change under a unit of load is the compliance of the pair
    compliance = np.asarray(np.linalg.inv(system)[:, most, most], dtype=np.float64)
    return Sharing(force=force, lag=lag, stiffness=1.0 / compliance)
