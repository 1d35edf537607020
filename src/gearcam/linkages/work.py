"""The driver's moment by virtual work: what loads, weights, springs and masses ask of a shaft.

The moment on any other shaft is found in the same way, from the displacement in which this shaft
alone turns: forces and accelerations are those of the true motion (see `efforts`).

Nothing is lost to friction.
"""

from __future__ import annotations

from collections.abc import Mapping, Sequence
from dataclasses import dataclass, replace
from functools import cached_property
from typing import Final

import numpy as np

from gearcam.base.display import ShortRepr
from gearcam.linkages.coordinates import WorkState
from gearcam.linkages.efforts import GRAVITY, INERTIA, LOADS, PARTS, SPRINGS, Effort, InertiaForce
from gearcam.linkages.elements import Dyad, Element, GivenMotion, Law
from gearcam.linkages.linkage import Linkage
from gearcam.linkages.measures import Peak, least_and_largest
from gearcam.numeric.arrays import Array, distinct, snapped
from gearcam.numeric.chebyshev import FIRST_CUTS, NotSmoothError, expand
from gearcam.numeric.gauss import gauss_cells
from gearcam.numeric.jets import Jet
from gearcam.numeric.piecewise import extremes

_BESIDE: Final = 1e-7
"""Distance from a knot at which its sides are compared, as a share of the range."""

_JUMP: Final = 1e-4
"""Difference there, as a share of the largest reduced inertia, that is a jump."""

_CLOSE: Final = 1e-4
"""Distance from a change point within which a displacement is read from a series, rad."""

_NOTHING: Final = 1e-6
"""Moment that is rounding only, N mm."""

_PROBES: Final = 193
"""The driver's angles at which it is looked for."""

_AT_KNOT: Final = 1e-9
"""Distance from a knot, rad, within which a place is called by it."""

_BACK: Final = 1e-7
"""Change of a place or an angle over a cycle, as a share, up to which it is as before."""

_RESOLVED: Final = 1e-7
"""Error of polynomials of degree 8 on cells, over the largest moment."""


@dataclass(frozen=True, eq=False)
class VirtualWork(ShortRepr):
    """The driver's moment, and those on other shafts.

    Parameters
    ----------
    linkage : Linkage
        The linkage.
    efforts : sequence of Effort
        What acts on it.
    speed : float, rad/s, optional
        Of the driver, even; without it masses have their weight only.
    more_knots : sequence of float, rad
        Where efforts are not smooth, besides the ends of where they act.
    """

    linkage: Linkage
    efforts: Sequence[Effort]
    speed: float | None = None
    more_knots: Sequence[float] = ()

    @cached_property
    def knots(self) -> Array:
        """The driver's angles between which the moment is smooth, rad."""
        low, high = self.linkage.span
        more = np.asarray(self.more_knots, dtype=float)
        ends = [one.active.ends(low, high) for one in self.efforts if one.active is not None]
        inner = more[(more > low) & (more < high)]
        return distinct(self.linkage.knots, inner, *ends)

    def parts(self, q: Array, order: int = 0) -> dict[str, Jet]:
        """Return the driver's moment for each sort of effort, N mm.

        Parameters
        ----------
        q : (n,) array, rad
            The driver's angles.
        order : int
            Highest derivative by them.

        Returns
        -------
        dict of str to Jet
            By those of `PARTS` that there are.
        """
        state, found = WorkState(self.linkage, q, order, self.speed), {}
        for effort in self.efforts:
            own = effort.balance(state)
            found[effort.part] = found[effort.part] + own if effort.part in found else own
        return {part: found[part] for part in PARTS if part in found}

    def moment(self, q: Array, order: int = 0) -> Jet:
        """Return the driver's moment, N mm (see `parts`); positive where it must drive."""
        nothing = Jet.variable(q, order) * 0.0
        return sum(self.parts(q, order).values(), start=nothing)

    def on(self, shafts: Mapping[str, float], q: Array) -> Array:
        """Return what a shaft, or a slide, exerts on the linkage.

        Parameters
        ----------
        shafts : mapping of str to float
            Quantities that move in the displacement, and how far each does: the names of one shaft,
            and +1 or -1 for its positive direction.
        q : (n,) array, rad
            The driver's angles.

        Returns
        -------
        (n,) array, N mm or N
            Moment on a shaft, force on a slide, also where it stands still.
        """
        displaced = displaced_by(self.linkage, shafts)
        state = WorkState(self.linkage, q, 0, self.speed, displaced)
        found = (np.asarray(one.balance(state).c[0]) for one in self.efforts)
        return sum(found, start=np.zeros(np.shape(q)))

    def reduced_inertia(self, q: Array, order: int = 0) -> Jet:
        """Return the moment of inertia of all masses at the driver, kg m2 (000, 5.1.1).

        Parameters
        ----------
        q : (n,) array, rad
            The driver's angles.
        order : int
            Highest derivative by them.
        """
        known, whole = self.linkage.at(q, order + 1), Jet.variable(q, order) * 0.0
        for effort in self.efforts:
            if isinstance(effort, InertiaForce):
                whole = whole + effort.reduced(known, order)
        return whole

    @cached_property
    def cells(self) -> Array:
        """The driver's angles, knots among them, between which few points tell all, rad.

        Next to places where members are nearly in line the moment has narrow peaks.
        """
        probes = np.linspace(*self.linkage.span, _PROBES)
        if np.abs(np.asarray(self.moment(probes).c[0])).max() < _NOTHING:  # rounding is not smooth
            return self.knots
        try:
            return expand(lambda q: np.asarray(self.moment(q).c[0]), self.knots, _RESOLVED).knots
        except NotSmoothError:
            return distinct(np.linspace(*self.linkage.span, FIRST_CUTS + 1), self.knots)

    @cached_property
    def _peaks(self) -> tuple[Peak, Peak]:
        places, values = extremes(lambda q: self.moment(q, 1).derivatives(), self.cells, cells=True)
        return least_and_largest((snapped(places, self.knots, _AT_KNOT), values))

    @property
    def largest(self) -> Peak:
        """The largest moment, N mm, and its place: a root of the derivative, or a knot's side."""
        return self._peaks[1]

    @property
    def least(self) -> Peak:
        """The least moment, N mm (see `largest`)."""
        return self._peaks[0]

    @cached_property
    def works(self) -> dict[str, tuple[float, float]]:
        """Work of the driver over its whole range for each sort of effort, N mm.

        Each with the integral of the moment's size, to which an error compares. Over a whole cycle
        weights, springs without dampers, and inertia do no work: what is found is an error.
        """
        places, weights = (one.ravel() for one in gauss_cells(self.cells[:-1], self.cells[1:]))
        found = {part: np.asarray(one.c[0]) for part, one in self.parts(places).items()}
        return {
            part: (float(weights @ values), float(weights @ np.abs(values)))
            for part, values in found.items()
        }

    @cached_property
    def kept(self) -> tuple[str, ...]:
        """What does no work over the whole range: what is there as at the beginning.

        A weight that a turn lifts, or a spring that a turn winds up, does work, and so do masses
        whose velocity jumps; dampers are not looked at.
        """
        state = WorkState(self.linkage, np.array(self.linkage.span), 0, self.speed)
        found = {INERTIA: not self._jolted, GRAVITY: True, SPRINGS: True}
        for effort in self.efforts:
            if effort.part == INERTIA:
                continue
            ends = np.asarray(effort.coordinate.place(state).c[0]) * np.ones(2)
            near = abs(ends[1] - ends[0]) <= _BACK * (1.0 + np.abs(ends).max())
            found[effort.part] = found.get(effort.part, True) and bool(near)
        return tuple(part for part, back in found.items() if back and part != LOADS)

    @cached_property
    def _jolted(self) -> bool:
        """Whether the velocity of a mass jumps at a knot, as at a change point."""
        near = _BESIDE * (self.knots[-1] - self.knots[0])
        before, after = self.knots[1:] - near, self.knots[:-1] + near
        places = np.concatenate([before, np.roll(after, -1)])
        sides = np.asarray(self.reduced_inertia(places).c[0]) * np.ones(places.size)
        apart = np.abs(np.diff(sides.reshape(2, -1), axis=0))
        return bool(apart.max() > _JUMP * np.abs(sides).max())

    @property
    def work(self) -> float:
        """Work of the driver over its whole range, N mm."""
        return sum(one for one, _ in self.works.values())

    @property
    def mean(self) -> float:
        """Mean moment of the driver, N mm."""
        low, high = self.linkage.span
        return self.work / (high - low)


def displaced_by(linkage: Linkage, shafts: Mapping[str, float]) -> Linkage:
    """Return a linkage in which some given motions alone go on from each place, at a constant rate.

    Parameters
    ----------
    linkage : Linkage
        The linkage.
    shafts : mapping of str to float
        Names of given motions, and their derivative by the driver's angle; that of others is 0.

    Returns
    -------
    Linkage
        With the same places at each angle of the driver.
    """

    def held(law: Law, factor: float) -> Law:
        def one(q: Array, order: int) -> Jet:
            return Jet([law(q, 0).c[0], *[factor, *[0.0] * order][:order]])

        return one

    def displaced(one: Element) -> Element:
        if isinstance(one, GivenMotion):
            return replace(one, law=held(one.law, shafts.get(one.name, 0.0)))
        # series about change points would need the derivatives that are held at 0
        return replace(one, reach=min(one.reach, _CLOSE)) if isinstance(one, Dyad) else one

    return replace(linkage, elements=tuple(map(displaced, linkage.elements)))
