"""Followers of one or two masses on springs, on a cam that turns evenly.

    cam --(k1, c1)-- m1 --(k2, c2)-- m2 --(ks, cs)-- frame

The first spring only presses, unless the cam holds its follower from both sides: of one mass it is
the train between cam and mass, of two the contact; then the train is between the masses. Loads act
against a rise. With x the place of a mass in its way of a lift y, the *lag* is ``r = x - y``: the
forces follow from it without cancellation, however stiff the train is. At the speed W of the cam

    m1*(r1'' + y'')*W^2 = N - G - F1                    N = -k1*r1 - c1*W*r1'
    m2*(r2'' + y'')*W^2 = G - F2 - ks*x2 - cs*W*x2'     G = k2*(r1 - r2) + c2*W*(r1' - r2')

with derivatives by the cam's angle. N is the contact force along the lift, and the springs are at
rest where all x and y are 0. Where N falls to 0 the follower flies: the end of the first spring,
which has no mass, relaxes as its damper lets it, at q above the cam, until it meets the cam again.
That is soon done, at a rate far above all frequencies: from then on the end goes with the mass.

Units: loads in N or N mm, lifts in mm or rad, masses in N s2/mm or N mm s2.
"""

from __future__ import annotations

import math
from collections.abc import Callable, Sequence
from dataclasses import dataclass
from functools import cached_property
from itertools import pairwise
from typing import Any, Final

import numpy as np

from gearcam.base.display import ShortRepr
from gearcam.dynamics.integrate import Mode, Switch
from gearcam.dynamics.tabled import Tabled
from gearcam.numeric.arrays import Array, Mask, Plane

CONTACT: Final = "contact"
FLIGHT: Final = "flight"
RELAXED: Final = "flight, relaxed"

_TABLED: Final = 1e-12
"""Error of tabled lifts and loads, relative."""

_HAIR: Final = 1e-12
"""What is rounding of a contact force or a gap, relative."""


def damping_of(ratio: float, stiffness: float, mass: float) -> float:
    """Return the damping of a spring with a `mass` behind it, by its damping `ratio`.

    Parameters
    ----------
    ratio : float
        Over the damping at which the mass would not swing.
    stiffness, mass : float
        Of both.
    """
    return 2.0 * ratio * math.sqrt(stiffness * mass)


@dataclass(frozen=True, eq=False, kw_only=True)
class ElasticFollower(ShortRepr):
    """A follower on its cam.

    Parameters
    ----------
    masses : tuple of float
        One or two, from the cam on.
    stiffness, damping : tuple of float
        Of the springs before them.
    spring, damper : float
        Stiffness and damping between the last mass and the frame.
    speed : float, rad/s
        Of the cam.
    lift : callable
        ``lift(x, order)`` returns lift and derivatives by the angle, at angles (n,).
    loads : callable
        ``loads(x)`` returns what acts against a rise on each mass, (masses, n).
    knots : (k,) array, rad
        Rising, both ends of the turn included: between them lift and loads are smooth.
    side : {1, -1}
        Whether the cam presses from below or from above.
    held : bool
        Whether it holds the follower from both sides, so that contact is never lost.
    """

    masses: tuple[float, ...]
    stiffness: tuple[float, ...]
    damping: tuple[float, ...]
    spring: float = 0.0
    damper: float = 0.0
    speed: float
    lift: Callable[[Array, int], Sequence[Array]]
    loads: Callable[[Array], Array]
    knots: Array
    side: float = 1.0
    held: bool = False

    @property
    def mass(self) -> float:
        """Both masses together."""
        return sum(self.masses)

    @property
    def last(self) -> int:
        """The row of the lag of its last mass in a state."""
        return 2 * len(self.masses) - 2

    @cached_property
    def matrices(self) -> tuple[Array, Array, Array]:
        """Masses, (n,), damping and stiffness, (n, n), of the follower in contact."""

        def chain(first: Sequence[float], last: float) -> Array:
            if len(self.masses) == 1:
                return np.array([[first[0] + last]])
            one, two = first
            return np.array([[one + two, -two], [-two, two + last]])

        damping = chain(self.damping, self.damper)
        return np.array(self.masses), damping, chain(self.stiffness, self.spring)

    @cached_property
    def frequencies(self) -> Array:
        """Natural frequencies in contact without damping, rad/s, rising."""
        masses, _, stiffness = self.matrices
        root = 1.0 / np.sqrt(masses)
        squares = np.linalg.eigvalsh(stiffness * np.outer(root, root))
        return np.sqrt(np.asarray(squares, dtype=float))

    @cached_property
    def system(self) -> Array:
        """Matrix of lags, and their derivatives by time over the highest frequency, by time."""
        masses, damping, stiffness = self.matrices
        count, unit = len(masses), float(self.frequencies[-1])
        found = np.zeros((2 * count, 2 * count))
        found[:count, count:] = np.eye(count) * unit
        found[count:, :count] = -stiffness / (masses[:, None] * unit)
        found[count:, count:] = -damping / masses[:, None]
        return found

    @cached_property
    def roots(self) -> Plane:
        """Roots of its vibrations in contact, 1/s, complex."""
        return np.asarray(np.linalg.eigvals(self.system), dtype=complex)

    @property
    def periods(self) -> float:
        """Periods of the fastest natural vibration in a turn."""
        return float(self.frequencies[-1]) / self.speed

    @property
    def rest_share(self) -> float:
        """Share of a slow lift that arrives at the last mass, of which the spring takes none."""
        return 1.0 / (1.0 + self.spring * sum(1.0 / one for one in self.stiffness))

    def rest(self, x: Array) -> Array:
        """Return the lags of a very slow cam at angles x, (masses, n)."""
        loads = self.loads(x).copy()
        loads[-1] += self.spring * self.lift(x, 0)[0]
        return np.asarray(np.linalg.solve(self.matrices[2], -loads), dtype=float)

    def rigid_force(self, x: Array, speed: float | None = None) -> Array:
        """Return the contact force along the lift of a rigid follower, (n,).

        Parameters
        ----------
        x : (n,) array, rad
            Angles.
        speed : float, optional
            Of the cam, rad/s; by default its own.
        """
        speed = self.speed if speed is None else speed
        y, v, a = self.lift(x, 2)
        inertia = self.mass * speed**2 * a
        return self.loads(x).sum(axis=0) + self.spring * y + self.damper * speed * v + inertia

    @cached_property
    def tabled(self) -> Tabled:
        """Lift, velocity, acceleration by the angle, and the loads."""

        def every(x: Array) -> Array:
            return np.vstack([*self.lift(x, 2), self.loads(x)])

        return Tabled(every, self.knots, _TABLED)

    @cached_property
    def samples(self) -> Array:
        """Angles between the knots, rad."""
        parts = (np.linspace(*ends, 65)[1:-1] for ends in pairwise(self.knots.tolist()))
        return np.concatenate(list(parts))

    @cached_property
    def sizes(self) -> tuple[float, float]:
        """The largest load of a rigid follower, and the largest lift."""
        x = self.samples
        return float(np.abs(self.rigid_force(x)).max()), float(np.abs(self.lift(x, 0)[0]).max())

    def contact_force(self, states: Array) -> Array:
        """Return N of states, (m, n), as if in contact."""
        return -self.stiffness[0] * states[0] - self.damping[0] * self.speed * states[1]

    def accelerations(self, x: Array, states: Array, contact: Mask) -> Array:
        """Return the accelerations of the masses by the angle, (masses, n).

        Parameters
        ----------
        x : (n,) array, rad
            Angles.
        states : (m, n) array
            Lags and their derivatives there, in turn.
        contact : (n,) bool array
            Whether the follower is on the cam.
        """
        y, v, a = self.lift(x, 2)
        force = np.where(contact, self.contact_force(states), 0.0)
        rates = self._behind()([y, v, a, *self.loads(x)], states, force, 0.0, 0.0)
        return a + np.array(rates[1 : 2 * len(self.masses) : 2])

    def energy(self, x: Array, states: Array, contact: Mask) -> Array:
        """Return kinetic energy and that of the springs, (n,) (see `accelerations`)."""
        y, v = self.lift(x, 1)
        count = len(self.masses)
        lags, rates = states[0 : 2 * count : 2], states[1 : 2 * count : 2]
        bent = np.where(contact, 0.0, states[2 * count]) - lags[0]
        found = self.stiffness[0] * bent**2 + self.spring * (y + lags[-1]) ** 2
        if count == 2:
            found = found + self.stiffness[1] * (lags[0] - lags[1]) ** 2
        moving = np.array(self.masses) @ (v + rates) ** 2
        return 0.5 * (found + self.speed**2 * moving)

    def modes(self, relaxed: float) -> dict[str, Mode]:
        """Return its equations of motion over the angle.

        The state has lag and its derivative of each mass, q, and the work that is put in: that of
        the cam less what loads and dampers take.

        Parameters
        ----------
        relaxed : float
            What the first spring is bent by, over what the largest load does, when it counts as
            relaxed.
        """
        read = self.tabled
        count, k1, c1 = len(self.masses), self.stiffness[0], self.damping[0] * self.speed
        relaxing = -k1 / c1 if c1 else 0.0
        behind = self._behind()

        def contact(x: float, state: Any) -> list[float]:
            place = read(x)
            r, rate = state[0], state[1]
            force = -k1 * r - c1 * rate
            put = force * place[1] - c1 * rate * rate
            return behind(place, state.tolist(), force, 0.0, put)

        def flight(x: float, state: Any) -> list[float]:
            r, rate, q = state[0], state[1], state[2 * count]
            back = relaxing * (q - r)
            return behind(read(x), state.tolist(), 0.0, rate + back, -c1 * back * back)

        def loose(x: float, state: Any) -> list[float]:
            return behind(read(x), state.tolist(), 0.0, state[1], 0.0)

        if self.held:
            return {CONTACT: Mode(contact)}
        side, (load, size) = self.side, self.sizes
        still = relaxed * load / k1
        lost = Switch(lambda _, s: side * (-k1 * s[0] - c1 * s[1]), FLIGHT, _HAIR * load)
        met = Switch(lambda _, s: side * s[2 * count], CONTACT, _HAIR * size)
        bent = Switch(lambda _, s: abs(s[2 * count] - s[0]) - still, RELAXED, 0.0, dips=False)
        return {
            CONTACT: Mode(contact, (lost,)),
            FLIGHT: Mode(flight, (met, bent)),
            RELAXED: Mode(loose, (met,)),
        }

    def _behind(self) -> Callable[..., list[Any]]:
        """Return what gives the derivatives of a state from the contact force."""
        masses = [one * self.speed**2 for one in self.masses]
        stiffness = [*self.stiffness[1:], self.spring]  # behind each of them
        damping = [one * self.speed for one in (*self.damping[1:], self.damper)]
        links, last = list(zip(masses, stiffness, damping, strict=True)), len(masses) - 1

        def behind(place: list[Any], state: Any, force: Any, gap: Any, put: Any) -> list[Any]:
            y, v, a = place[:3]
            found: list[Any] = []
            for number, (mass, k, c) in enumerate(links):
                r, rate = state[2 * number : 2 * number + 2]
                load = place[3 + number]
                bent, bending = y + r, v + rate
                put = put - load * bending
                if number < last:
                    bent, bending = r - state[2 * number + 2], rate - state[2 * number + 3]
                passed = k * bent + c * bending
                put = put - c * bending * bending
                found += (rate, (force - passed - load) / mass - a)
                force = passed
            return [*found, gap, put]

        return behind
