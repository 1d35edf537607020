"""Forces of the teeth of a pair under load: tooth forces, bearings, losses, efficiency.

A load acts on the driven element, or the driver's torque is given; both wheels are in equilibrium
at every phase. Flanks press on each other along their common normal, and rub against the sliding.
Which flanks carry follows from the load: the driving side where it resists, the coast side where
it pulls the driven element ahead. All forces of a phase are in proportion to the load, so nothing
is iterated. Teeth that carry together share the load; equally, where no stiffness is known.

Directions, levers and losses are taken from the velocities of both flanks at the point of contact,
per rad of the driver. So wheels, rings and racks are alike, and arms of friction have their signs.

Sources: 000, section 4.1.3.9, eqs. 4.88 to 4.97, for round wheels; journals 000, eq. 2.90.
"""

from __future__ import annotations

from collections.abc import Sequence
from dataclasses import dataclass, field, replace
from functools import cached_property
from typing import TYPE_CHECKING, Any, Final

import numpy as np
from numpy.typing import NDArray

from gearcam.base.display import ShortRepr
from gearcam.gears.contact import FlankPairs
from gearcam.meshing.contact import Contacts, contacts
from gearcam.numeric.arrays import Array, Ints, Mask, Plane

if TYPE_CHECKING:
    from gearcam.mechanics.friction import WheelFrictionSpec

_REST: Final = 1e-12
"""Sliding, relative to the speeds of both flanks, that is none: its direction would be rounding."""


@dataclass(frozen=True, eq=False, kw_only=True)
class LoadedTeeth(ShortRepr):
    """The k contacts of flanks that carry, by phase, and what a unit of tooth force does there.

    Parameters
    ----------
    points : Contacts
        The contacts; their `step` is the number of the phase.
    level : (k,) int array
        Step of stepped wheels, from 0.
    teeth : (2, k) int array
        Numbers of the teeth of driver and driven element.
    ratio : (k,) array
        Derivative of the driven element's turn by phi1.
    share : (k,) array
        Share of the load.
    push : (k,) complex array
        Force on the driven element per normal force, friction included.
    gain : (2, k) array, mm or 1
        Work of it per rad of the driver, and per turn of the driven element.
    lost : (2, k) array, mm
        Work lost per rad of the driver by sliding and by rolling.
    smooth : (k,) array, mm
        Work of the normal force alone per rad of the driver.
    """

    points: Contacts
    level: Ints
    teeth: Ints
    ratio: Array
    share: Array
    push: Plane
    gain: Array
    lost: Array
    smooth: Array

    @property
    def friction(self) -> Array:
        """Force along the flank over the normal force, (k,), against the sliding.

        Positive if it is the normal force turned clockwise, on either wheel.
        """
        made: Array = -np.imag(self.push / self.points.force)
        return made

    def summed(self, values: NDArray[Any], count: int) -> NDArray[Any]:
        """Return sums of `values` of contacts over `count` phases, by shares; nan without any."""
        found = np.full(count, np.nan, dtype=values.dtype)
        found[self.points.step] = 0.0
        np.add.at(found, self.points.step, self.share * values)
        return found


@dataclass(frozen=True, eq=False, kw_only=True)
class ToothForces(ShortRepr):
    """A pair under load at n phases of the driver.

    Parameters
    ----------
    phi1 : (n,) array, rad
        Phases.
    phi2, ratio : (n,) array
        Turn of the driven element, rad or mm, backlash taken up, and its derivative by phi1; where
        no flanks touch the nominal turn, and nan.
    load : (n,) array, N mm or N
        On the driven element, against its motion.
    torque : (n,) array, N mm
        Of the driver, in the sense of its motion.
    force : (n,) array, N
        Sum of the normal forces; nan where no flanks touch or friction locks the pair.
    back : (n,) bool array
        Where the coast flanks carry: the load turns the driver.
    bearing : (n,) complex array, N
        Force of the frame on the driver's shaft; that on the driven element is opposite.
    reserve : (n,) array
        Share of the power of the normal forces that friction leaves for the driven element, or,
        where the coast flanks carry, for the driver; nan where no flanks touch.
    losses : mapping of str to (n,) array, N mm
        Work lost per rad of the driver at ``flanks`` (sliding), by ``rolling`` and in ``journals``.
    teeth : LoadedTeeth
        The contacts: of the driving flanks, or of the coast flanks where these carry.
    """

    phi1: Array
    phi2: Array
    ratio: Array
    load: Array
    torque: Array
    force: Array
    back: Mask
    bearing: Plane
    reserve: Array
    losses: dict[str, Array] = field(repr=False)
    teeth: LoadedTeeth = field(repr=False)

    @cached_property
    def driven(self) -> Mask:
        """Where flanks of the side that carries touch, (n,)."""
        return np.isfinite(self.reserve)

    @property
    def locked(self) -> Mask:
        """Where friction locks the pair, (n,): no tooth force balances the load."""
        return self.driven & np.isnan(self.force)

    @cached_property
    def of_teeth(self) -> Array:
        """Normal force of each contact, (k,), N."""
        return self.force[self.teeth.points.step] * self.teeth.share

    @property
    def out(self) -> Array:
        """Work that the driven element delivers per rad of the driver, (n,), N mm."""
        return self.load * self.ratio

    @cached_property
    def lost(self) -> Array:
        """All work lost per rad of the driver, (n,), N mm."""
        return np.sum([*self.losses.values()], axis=0)

    def largest(self, values: Array) -> Array:
        """Return the largest of `values` of the contacts at each phase, (n,); nan without any."""
        found = np.full(len(self.phi1), np.nan)
        np.fmax.at(found, self.teeth.points.step, values)
        return found

    @cached_property
    def efficiency(self) -> Array:
        """Power that leaves over the power that enters, (n,); nan where none leaves."""
        into, out = self.torque, self.out
        forward, backward = (into > 0.0) & (out > 0.0), (into < 0.0) & (out < 0.0)
        found = np.full(into.shape, np.nan)
        np.divide(out, into, out=found, where=forward)
        np.divide(into, out, out=found, where=backward)
        return found

    @cached_property
    def balance(self) -> float:
        """Largest difference of the powers that enter, leave and are lost, over the largest one.

        Losses of sliding come from the arcs that both flanks pass in contact, not from forces: the
        difference is an error estimate of all of them.
        """
        apart = np.abs(self.torque - self.out - self.lost)
        largest = np.nanmax(np.abs([self.torque, self.out]), initial=0.0)
        return float(np.nanmax(apart, initial=0.0) / largest) if largest else 0.0


def tooth_forces(
    sides: Sequence[tuple[FlankPairs, FlankPairs]],
    phi1: Array,
    given: Array,
    *,
    on_driver: bool,
    friction: WheelFrictionSpec,
) -> ToothForces:
    """Return the forces of a pair.

    Parameters
    ----------
    sides : sequence of (FlankPairs, FlankPairs)
        Coast and driving flanks, of each step of stepped wheels.
    phi1 : (n,) array, rad
        Phases.
    given : (n,) array
        The load on the driven element, N mm or N, against its motion; or the driver's torque.
    on_driver : bool
        Whether it is the driver's torque.
    friction : WheelFrictionSpec
        Coefficients and bearings.

    Returns
    -------
    ToothForces

    Notes
    -----
    With the velocities v1 and v2 of both flanks per rad of the driver and the unit normal n, a unit
    of normal force acts on the driven element as ``g = n + mu*(v1 - v2)/|v1 - v2|``. The driver's
    torque is the work of g on v1, the load the work of g on v2 per turn. Rolling adds a couple
    against the relative rotation, each journal one of ``r*sin(atan(mu))`` times its force.
    """
    guide = sides[0][0].guide
    nominal, _ = guide.motion(phi1)
    arms = friction.journals[0], abs(guide.turns) * friction.journals[1]
    back = given < 0.0
    teeth = _loaded_teeth(sides, phi1, (back, ~back), friction)
    by_driver, by_driven, sliding, rolling, smooth, ratio, lead = (
        teeth.summed(values, len(phi1))
        for values in (*teeth.gain, *teeth.lost, teeth.smooth, teeth.ratio, teeth.points.lead)
    )
    bearing = teeth.summed(teeth.push, len(phi1))
    held = np.abs(bearing)
    by_driver, by_driven = by_driver + arms[0] * held, by_driven - arms[1] * held
    by = by_driver if on_driver else by_driven
    carries = (by * given > 0.0) & (back | (by_driven > 0.0))
    force = np.where(np.isnan(by) | ((given != 0.0) & ~carries), np.nan, 0.0)
    np.divide(given, by, out=force, where=carries)
    known = np.where(np.isnan(force), np.nan, given)
    return ToothForces(
        phi1=phi1,
        phi2=nominal + np.nan_to_num(lead),
        ratio=ratio,
        load=force * by_driven if on_driver else known,
        torque=known if on_driver else force * by_driver,
        force=force,
        back=back,
        bearing=force * bearing,
        reserve=np.where(back, -by_driver, by_driven * ratio) / np.abs(smooth),
        losses={
            "flanks": force * sliding,
            "rolling": force * rolling,
            "journals": force * held * (arms[0] + arms[1] * np.abs(ratio)),
        },
        teeth=teeth,
    )


def _loaded_teeth(
    sides: Sequence[tuple[FlankPairs, FlankPairs]],
    phi1: Array,
    carrying: tuple[Mask, Mask],
    friction: WheelFrictionSpec,
) -> LoadedTeeth:
    """Return the contacts of those flanks that are `carrying` at phases `phi1`, on either side."""
    found, level, teeth = [], [], []
    for number, both in enumerate(sides):
        for pairs, mask in zip(both, carrying, strict=True):
            rows = np.flatnonzero(mask)
            each = contacts(pairs, phi1[rows])
            found.append(replace(each, step=rows[each.step]))
            level.append(np.full(each.step.shape, number))
            teeth.append(np.stack([wheel.number(each.pair) for wheel in pairs.wheels]))
    order = np.argsort(np.concatenate([each.step for each in found]), kind="stable")
    points = Contacts.joined(found).take(order)
    guide, distance = sides[0][0].guide, sides[0][0].distance
    ratio = guide.motion(phi1[points.step])[1] + points.drift
    one, per_turn = -1j * points.point, guide.carried(points.point - distance)
    two = ratio * per_turn
    slip = one - two
    speed = np.abs(slip)
    moving = speed > _REST * (np.abs(one) + np.abs(two))
    way = np.zeros(slip.shape, dtype=np.complex128)
    np.divide(slip, speed, out=way, where=moving)
    push = points.force + friction.flank * way
    # the couple of rolling is against the rotation of the flanks on each other
    turned = -1.0 - ratio * guide.turns
    couple = friction.rolling * np.sign(turned)
    return LoadedTeeth(
        points=points,
        level=np.concatenate(level)[order],
        teeth=np.concatenate(teeth, axis=1)[:, order],
        ratio=ratio,
        share=1.0 / np.bincount(points.step)[points.step],
        push=push,
        gain=np.stack([_work(one, push) - couple, _work(per_turn, push) + couple * guide.turns]),
        lost=np.stack([friction.flank * np.abs(points.sliding), couple * turned]),
        smooth=_work(one, points.force),
    )


def _work(velocity: Plane, force: Plane) -> Array:
    """Return the work of forces, per unit of what the velocities are per."""
    return np.real(np.conj(velocity) * force)
