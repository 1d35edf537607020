"""The motion of a follower over a turn of its cam, integrated, with flights."""

from __future__ import annotations

import math
from dataclasses import dataclass, replace
from functools import cached_property
from typing import Any, Final

import numpy as np
from numpy.typing import ArrayLike

from gearcam.base.display import ShortRepr
from gearcam.base.errors import InfeasibleError
from gearcam.dynamics.follower import CONTACT, ElasticFollower
from gearcam.dynamics.integrate import Integrator, Motion
from gearcam.numeric.arrays import Array, Mask

FOLLOWED: Final = 300.0
"""Natural periods in a turn up to which "auto" follows each with dop853: beyond, radau is faster;
with flights it is not up to about 1000, without them beyond 100 already."""

_WIDEST: Final = 0.25
"""Largest step of dop853 in fastest natural periods: between its ends wider ones are not exact."""

_FINER: Final = 0.1
"""Tolerance of the run that tells the error, over that of the motion."""

_NARROWER: Final = 0.75
"""The same of the largest step: by the order of dop853, 8, a tenth of the error."""

_RELAXED: Final = 0.1
"""What the first spring of a follower that flies is still bent by when it counts as relaxed, over
the largest bend and the tolerance. A hundredth of it dop853, at the limit of its steps, would not
come down to."""

_MOST: Final = 1e7
"""Largest number of natural vibrations that are followed each."""

_EACH: Final = 8e-4
"""What one takes dop853, s."""

_PATIENCE: Final = 5
"""Turns that may bring a motion no nearer to one that repeats, before it is given up."""

_SAME: Final = 10.0
"""What two turns may differ by to be one, in tolerances."""

_COMPARED: Final = 721
"""Number of angles at which both are compared."""


@dataclass(frozen=True, kw_only=True)
class Flight(ShortRepr):
    """An arc in which the follower is off its cam.

    Parameters
    ----------
    start, end : float, rad
        Where it leaves the cam, and where it meets it again; that may be less.
    impact : float, mm/s or rad/s
        Speed at which both meet; nan if they do not within the turn.
    """

    start: float
    end: float
    impact: float


@dataclass(frozen=True, eq=False, kw_only=True)
class Turn(ShortRepr):
    """The last of some turns of a cam.

    Parameters
    ----------
    follower : ElasticFollower
        The follower.
    motion : Motion
        Its motion over the turn.
    start : (str, (m,) array)
        Mode and state at its beginning.
    method : str
        What integrated it.
    tolerance : float
        As it was asked for.
    turns : int
        Number of turns.
    repeats : bool
        Whether the last ended as it had begun, within the tolerance.
    """

    follower: ElasticFollower
    motion: Motion
    start: tuple[str, Array]
    method: str
    tolerance: float
    turns: int
    repeats: bool

    def states(self, x: ArrayLike) -> tuple[Array, Mask]:
        """Return states, (m, n), at angles (n,) of the turn, and where there is contact."""
        x = np.asarray(x, dtype=float)
        return self.motion.at(x), np.array([one == CONTACT for one in self.motion.modes(x)])

    def contact_force(self, x: ArrayLike) -> Array:
        """Return the contact force along the lift at angles (n,), 0 in flight."""
        states, contact = self.states(x)
        return np.where(contact, self.follower.contact_force(states), 0.0)

    @cached_property
    def flights(self) -> tuple[Flight, ...]:
        """Where it is off the cam, in the order of the landings."""
        low, high = (float(one) for one in self.follower.knots[[0, -1]])
        leaving = [x for x, before, _ in self.motion.switches if before == CONTACT]
        landing = {x: before for x, before, after in self.motion.switches if after == CONTACT}
        if self.start[0] != CONTACT:  # it left in the turn before, as in this one if they repeat
            back = leaving[-1] if self.motion.mode != CONTACT and leaving else low
            leaving = [back, *(one for one in leaving if one != back)]
        ends = [*landing, *[high] * (len(leaving) - len(landing))]
        return tuple(
            Flight(start=start, end=end, impact=self._impact(end, landing.get(end)))
            for start, end in zip(leaving, ends, strict=True)
        )

    def _impact(self, x: float, mode: str | None) -> float:
        """Return the speed at which a follower that flies in a mode meets the cam at an angle."""
        if mode is None:
            return math.nan
        (state,) = self.motion.at([x]).T
        flying = self.follower.modes(_RELAXED * self.tolerance)[mode].rate(x, state)
        return abs(float(flying[2 * len(self.follower.masses)])) * self.follower.speed

    @cached_property
    def energy_residue(self) -> float:
        """What the energies at steps of the turn do not balance by, over their largest change."""
        x = np.array([one.low for one in self.motion.pieces])
        states, contact = self.states(x)
        energy = self.follower.energy(x, states, contact)
        put = states[-1] - states[-1, 0]
        scale = max(float(np.ptp(energy)), float(np.ptp(put)), np.finfo(float).tiny)
        return float(np.abs(energy - energy[0] - put).max()) / scale

    @cached_property
    def error(self) -> tuple[float, float]:
        """Largest differences of contact force and place of the last mass to a finer run.

        That run has a tenth of the tolerance, and begins the turn in the same state.
        """
        tolerance = _FINER * self.tolerance
        motion = _turn(self.follower, self.method, tolerance, self.start, _NARROWER * _WIDEST)
        finer, last = replace(self, motion=motion), self.follower.last
        x = np.linspace(self.follower.knots[0], self.follower.knots[-1], _COMPARED)[:-1]
        force = self.contact_force(x) - finer.contact_force(x)
        place = self.motion.at(x)[last] - motion.at(x)[last]
        return float(np.abs(force).max()), float(np.abs(place).max())


def settle(
    follower: ElasticFollower,
    start: Array,
    *,
    turns: int = 20,
    method: str = "auto",
    tolerance: float = 1e-6,
) -> Turn:
    """Return the turn of a follower after which it repeats itself, or the last of some turns.

    Once five turns have brought it no nearer to repeating itself, none follows.

    Parameters
    ----------
    follower : ElasticFollower
        The follower.
    start : (2*masses,) array
        Lags and their derivatives at the beginning of the first turn, in turn; it begins in
        contact.
    turns : int
        Largest number of turns.
    method : str
        One of `gearcam.dynamics.integrate.METHODS`, or "auto".
    tolerance : float
        Of a step, relative to the largest lag; and what two turns may differ by.

    Returns
    -------
    Turn

    Raises
    ------
    InfeasibleError
        If it cannot be integrated, or not in a sensible time.
    """
    method = chosen(follower, method)
    vibrations = turns * follower.periods
    if method == "dop853" and vibrations > _MOST:
        what = f"{vibrations:.2g} natural vibrations take dop853 about {_EACH * vibrations:.2g} s"
        raise InfeasibleError(what, where="dynamics.method", nearest='"auto" or "radau"')
    state: tuple[str, Array] = CONTACT, np.append(start, [0.0, 0.0])
    scales, number, nearest, reached = _scales(follower), 0, math.inf, 0
    while True:
        motion = _turn(follower, method, tolerance, state)
        number += 1
        apart = float((np.abs(motion.end - state[1])[:-1] / scales[:-1]).max())
        if apart < nearest:
            nearest, reached = apart, number
        repeats = motion.mode == state[0] and apart <= _SAME * tolerance
        if repeats or number == min(turns, reached + _PATIENCE):
            break
        state = motion.mode, np.append(motion.end[:-1], 0.0)
    return Turn(
        follower=follower, motion=motion, start=state, method=method, tolerance=tolerance,
        turns=number, repeats=repeats,
    )  # fmt: skip


def chosen(follower: ElasticFollower, method: str) -> str:
    """Return the `method` of an integration, for "auto" that which is faster for a `follower`."""
    if method != "auto":
        return method
    return "dop853" if follower.periods <= FOLLOWED else "radau"


def _turn(
    follower: ElasticFollower,
    method: str,
    tolerance: float,
    start: tuple[str, Array],
    widest: float = _WIDEST,
) -> Motion:
    """Return the motion over a turn."""
    atol: Any = tuple((tolerance * _scales(follower)).tolist())
    widest = widest * 2.0 * math.pi / follower.periods if method == "dop853" else math.inf
    integrate = Integrator(method=method, rtol=tolerance, atol=atol, widest=widest)
    return integrate(follower.modes(_RELAXED * tolerance), start, follower.knots.tolist())


def _scales(follower: ElasticFollower) -> Array:
    """Return sizes of the parts of a state: what the loads bend springs by, and work."""
    load, size = follower.sizes
    bent = load * np.cumsum([1.0 / one for one in follower.stiffness])
    rates = bent * float(follower.frequencies[0]) / follower.speed
    both = np.column_stack([bent, rates]).ravel()
    return np.array([*both, bent[0], load * max(size, float(bent[-1]))])
