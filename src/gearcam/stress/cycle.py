"""A pair under load over a cycle: forces of all teeth, lag, stiffness, stress in every root.

Flanks in contact, and those about to touch on an edge, share the load of each phase (see
`sharing`); the forces then stress all roots of both wheels (see `influence`).
"""

from __future__ import annotations

from dataclasses import dataclass
from functools import cached_property
from typing import TYPE_CHECKING, Any

import numpy as np
from numpy.typing import NDArray

from gearcam.base.display import ShortRepr
from gearcam.mechanics import hertz
from gearcam.numeric.arrays import Array, Ints, Mask, Plane, indices_among
from gearcam.stress.fillet import BESIDE
from gearcam.stress.hertz_load import past
from gearcam.stress.influence import Influence
from gearcam.stress.sharing import ContactWidths, Sharing, share

if TYPE_CHECKING:
    from gearcam.gears.contact import FlankPairs
    from gearcam.meshing.about_to_touch import EdgeGaps
    from gearcam.meshing.contact import Contacts


@dataclass(frozen=True, eq=False, kw_only=True)
class TouchingTeeth(ShortRepr):
    """The k contacts of one side that may carry, by phase.

    Parameters
    ----------
    step : (k,) int array
        Phase of each.
    teeth : (2, k) int array
        Numbers of the teeth of driver and driven wheel.
    points : (2, k) complex array, mm
        The point of contact in each wheel's own frame.
    directions : (2, k) complex array
        Unit direction of the normal force on each wheel, in its own frame.
    lever, gain : (k,) arrays, mm
        Lever of the normal about the driven shaft, above 0, and of the force with friction.
    gap : (k,) array, mm
        Gap between the flanks, 0 where they touch.
    curvature : (k,) array, 1/mm
        Relative curvature, above 0.
    friction : (k,) array
        Force along the flank over the normal force (see `LoadedTeeth.friction`).
    edge : (k,) bool array
        Whether the end of a flank touches.
    """

    step: Ints
    teeth: Ints
    points: Plane
    directions: Plane
    lever: Array
    gain: Array
    gap: Array
    curvature: Array
    friction: Array
    edge: Mask

    @cached_property
    def column(self) -> Ints:
        """Number of each contact among those of its phase."""
        made: Ints = np.arange(len(self.step)) - np.searchsorted(self.step, self.step)
        return made

    def padded(self, values: NDArray[Any], count: int, fill: float = 0.0) -> NDArray[Any]:
        """Return `values` of contacts, (k, ...), in rows of `count` phases, `fill` for none."""
        most = int(self.column.max(initial=0)) + 1
        made = np.full((count, most, *values.shape[1:]), fill, dtype=values.dtype)
        made[self.step, self.column] = values
        return made


@dataclass(frozen=True, eq=False, kw_only=True)
class RootStress(ShortRepr):
    """Largest stress in the roots of t teeth of a wheel at n phases.

    Parameters
    ----------
    numbers : (t,) int array
        Tooth numbers.
    tension, compression : (n, t) arrays, MPa
        Along the edge of both fillets of each; 0 at least and at most.
    """

    numbers: Ints
    tension: Array
    compression: Array


@dataclass(frozen=True, eq=False, kw_only=True)
class LoadedCycle(ShortRepr):
    """A pair under load at n phases.

    Parameters
    ----------
    touching : TouchingTeeth
        Its contacts.
    sharing : Sharing
        Forces, lag and stiffness.
    force : (k,) array, N/mm
        Normal force of each contact.
    half_width : (k,) array, mm
        Hertz's half-width of each.
    roots : (RootStress, RootStress)
        Of driver and driven wheel.
    """

    touching: TouchingTeeth
    sharing: Sharing
    force: Array
    half_width: Array
    roots: tuple[RootStress, RootStress]


def touching_teeth(
    pairs: FlankPairs,
    phi1: Array,
    found: Contacts,
    gain: Array,
    friction: Array,
    about: EdgeGaps | None,
) -> TouchingTeeth:
    """Return the contacts of one side that may carry.

    Parameters
    ----------
    pairs : FlankPairs
        The side.
    phi1 : (n,) array, rad
        Phases.
    found : Contacts
        Its flank contacts at them.
    gain, friction : (k,) arrays, mm and 1
        Levers of their forces with friction, and the force along the flank over the normal force.
    about : EdgeGaps or None
        Pairs about to touch on an edge; these are without friction.

    Returns
    -------
    TouchingTeeth
    """
    edges = [] if about is None else [about]
    parts = [found, *edges]

    def joined(name: str) -> NDArray[Any]:
        return np.concatenate([getattr(one, name) for one in parts], axis=-1)

    step, pair = joined("step"), joined("pair")
    order = np.lexsort((pair, step))
    step, pair = step[order], pair[order]
    point, force = joined("point")[order], joined("force")[order]
    on_edges = [one.lever for one in edges]
    gaps = [np.zeros(len(found.step)), *(one.gap for one in edges)]
    # all touch at the lead of the phase, but for gaps that are small beside the wheels
    lead = np.zeros(len(phi1))
    lead[found.step] = found.lead
    origins, turns = pairs.frames(phi1[step], (pairs.guide.nominal(phi1) + lead)[step])
    return TouchingTeeth(
        step=step,
        teeth=np.stack([wheel.number(pair) for wheel in pairs.wheels]),
        points=(point - origins) * turns,
        directions=np.stack([-force, force]) * turns,
        lever=np.concatenate([found.lever[1], *on_edges])[order],
        gain=np.concatenate([gain, *on_edges])[order],
        gap=np.concatenate(gaps)[order],
        curvature=joined("curvature")[order],
        friction=np.concatenate([friction, np.zeros(len(step) - len(friction))])[order],
        edge=np.repeat([False, True], [len(found.step), len(step) - len(found.step)])[order],
    )


def loaded_cycle(
    wheels: tuple[Influence, Influence],
    touching: TouchingTeeth,
    load: Array,
    widths: ContactWidths,
) -> LoadedCycle:
    """Return a pair under load.

    Parameters
    ----------
    wheels : (Influence, Influence)
        Driver and driven wheel.
    touching : TouchingTeeth
        The contacts; each phase has one at least.
    load : (n,) array, N mm/mm
        Torque of the driven shaft per width, above 0.
    widths : ContactWidths
        Of the contacts.

    Returns
    -------
    LoadedCycle
    """
    count = len(load)
    found = [
        _interpolated(wheel, teeth, points)
        for wheel, teeth, points in zip(wheels, touching.teeth, touching.points, strict=True)
    ]
    compliance = np.zeros(1)
    for wheel, (_, at, shares) in zip(wheels, found, strict=True):
        columns, parts = touching.padded(at, count), touching.padded(shares, count)
        work = wheel.compliance[columns[:, :, None, :, None], columns[:, None, :, None, :]]
        made = np.einsum("nip,njq,nijpq->nij", parts, parts, work, optimize=True)
        # along a flank the displacement under the force itself is smooth, that beside it has a peak
        own = np.einsum("nip,nip->ni", parts, np.diagonal(wheel.compliance)[columns])
        contact = np.arange(own.shape[1])
        made[:, contact, contact] = own
        compliance = compliance + made
    curvature = touching.padded(touching.curvature, count, 1.0)
    sharing = share(
        compliance,
        touching.padded(touching.lever, count),
        touching.padded(touching.gain, count),
        touching.padded(touching.gap, count),
        curvature,
        load,
        widths,
    )
    force = sharing.force[touching.step, touching.column]
    half_width = hertz.half_width(force, touching.curvature, widths.material)
    roots = [
        _root_stress(wheel, touching, one, force, half_width, count)
        for wheel, one in zip(wheels, found, strict=True)
    ]
    return LoadedCycle(
        touching=touching,
        sharing=sharing,
        force=force,
        half_width=half_width,
        roots=(roots[0], roots[1]),
    )


Interpolated = tuple[Array, Ints, Array]
"""s of contacts, (k,), and between which places of an influence they are, with shares, (k, p)."""


def _interpolated(wheel: Influence, teeth: Ints, points: Plane) -> Interpolated:
    """Return where contacts are on the flanks of a wheel."""
    row = indices_among(teeth, wheel.numbers)
    s = wheel.placed(row, points)
    return s, *wheel.shares(row, s)


def _root_stress(
    wheel: Influence,
    touching: TouchingTeeth,
    interpolated: Interpolated,
    force: Array,
    half_width: Array,
    count: int,
) -> RootStress:
    """Return the stress in the roots of a wheel under the forces of its contacts."""
    s, at, shares = interpolated
    loads = np.zeros((wheel.roots.shape[1], count))
    np.add.at(loads, (at, touching.step[:, None]), shares * force[:, None])
    stress = wheel.roots @ loads
    # beside a load the pressure itself stresses the edge
    reach = touching.padded(BESIDE[0] * half_width + BESIDE[1] * wheel.module, count)
    places = touching.padded(s, count)
    for place, near in zip(places.T, reach.T, strict=True):
        away = np.abs(past(wheel.root_s[:, None], place, wheel.length))
        stress[away < near] = 0.0
    first = np.flatnonzero(np.diff(wheel.root_tooth, prepend=-1))
    rows = wheel.root_tooth[first]
    made = np.zeros((2, count, len(wheel.numbers)))
    made[0][:, rows] = np.maximum.reduceat(stress, first).T
    made[1][:, rows] = np.minimum.reduceat(stress, first).T
    return RootStress(
        numbers=wheel.numbers,
        tension=np.maximum(made[0], 0.0),
        compression=np.minimum(made[1], 0.0),
    )
