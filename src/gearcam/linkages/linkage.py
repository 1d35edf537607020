"""A linkage: its parts, each behind those that it needs, evaluated at any angle of the driver."""

from __future__ import annotations

import math
from collections.abc import Iterable, Sequence
from dataclasses import dataclass
from functools import cached_property
from typing import Final

import numpy as np

from gearcam.base.display import ShortRepr
from gearcam.linkages.elements import Dyad, Element
from gearcam.linkages.known import GROUND, Known
from gearcam.linkages.plane import conjugate, imaginary, real, rotation
from gearcam.numeric.arrays import Array, distinct
from gearcam.numeric.jets import Jet

_DENSE: Final = 1441
"""Angles of the driver at which turns of members are counted."""

_SPARE: Final = 9
"""Derivatives more with which a dyad that has change points is solved: one that its passage costs,
and those of the series from there."""


class UnreachedError(ValueError):
    """Parts that need names which nothing gives, or each other.

    Parameters
    ----------
    missing : dict of str to tuple of str
        What each part that cannot be solved gives first, and the names it waits for.
    """

    def __init__(self, missing: dict[str, tuple[str, ...]]) -> None:
        self.missing = missing
        super().__init__(
            ", ".join(f"{name} waits for {', '.join(w)}" for name, w in missing.items())
        )


def in_order(elements: Iterable[Element]) -> tuple[Element, ...]:
    """Return the parts of a linkage in an order in which they can be solved.

    Parameters
    ----------
    elements : iterable of Element
        In any order.

    Returns
    -------
    tuple of Element

    Raises
    ------
    UnreachedError
        If some need what nothing gives.
    """
    known, left, ordered = {GROUND}, list(elements), []
    while left:
        ready = [one for one in left if known.issuperset(one.needs)]
        if not ready:
            missing = {
                one.gives[0]: tuple(name for name in one.needs if name not in known) for one in left
            }
            raise UnreachedError(missing)
        ordered += ready
        known.update(name for one in ready for name in one.gives)
        left = [one for one in left if one not in ready]
    return tuple(ordered)


@dataclass(frozen=True, eq=False)
class Linkage(ShortRepr):
    """A linkage of mobility 1.

    Parameters
    ----------
    elements : sequence of Element
        Its parts, each behind those that it needs (see `in_order`).
    knots : (k,) array, rad
        The driver's angles from the first to the last one; between them everything is smooth.
    closed : bool
        Whether the motion repeats with every turn of the driver.
    """

    elements: Sequence[Element]
    knots: Array
    closed: bool = True

    @property
    def span(self) -> tuple[float, float]:
        """First and last angle of the driver, rad."""
        return float(self.knots[0]), float(self.knots[-1])

    def even_places(self, steps: int) -> Array:
        """Return angles of the driver at even steps, rad: the last is just before the end."""
        low, high = self.span
        made = np.linspace(low, high, steps + 1)
        made[-1] = np.nextafter(high, low)
        return made

    @cached_property
    def _angles(self) -> dict[str, tuple[Array, Array]]:
        return {}

    @cached_property
    def dyads(self) -> tuple[Dyad, ...]:
        """Its dyads, in order."""
        return tuple(one for one in self.elements if isinstance(one, Dyad))

    def shaft_of(self, crank: str) -> complex:
        """Return where the shaft of a `crank` stands, by its name, mm."""
        frame = self.at(self.knots[:1], 0).frame(crank)
        return complex(np.asarray(frame.origin.c[0])[0])

    def at(self, q: Array, order: int, upto: Element | None = None) -> Known:
        """Solve the linkage.

        Parameters
        ----------
        q : (n,) array, rad
            Angles of the driver.
        order : int
            Highest derivative by the driver's angle.
        upto : Element, optional
            Solve only the parts before this one.

        Returns
        -------
        Known
            Joints, members and quantities by name.
        """
        spare = _SPARE * sum(bool(one.changes) for one in self.dyads)
        known = Known(np.asarray(q, dtype=float), order + spare)
        for element in self.elements:
            if element is upto:
                break
            element.solve(known)
        return known

    def track(self, name: str, q: Array, order: int) -> Jet:
        """Return one quantity.

        Parameters
        ----------
        name : str
            A joint, with ``.x`` or ``.y`` one of its coordinates; a member with ``.angle``; a
            slide's place; a shaft.
        q : (n,) array, rad
            Angles of the driver.
        order : int
            Highest derivative.

        Returns
        -------
        Jet
            Of complex numbers for a joint. Angles are within half a turn.
        """
        return _of(self.at(q, order), name, order)

    def real_track(self, name: str, q: Array, order: int) -> Jet:
        """Return one quantity whose angles have no jumps (see `real_tracks`)."""
        return self.real_tracks([name], q, order)[0]

    def real_tracks(self, names: Iterable[str], q: Array, order: int) -> list[Jet]:
        """Return quantities whose angles have no jumps (see `track`).

        Parameters
        ----------
        names : iterable of str
            As for `track`, no joints without a coordinate.
        q : (n,) array, rad
            Angles of the driver.
        order : int
            Highest derivative.

        Returns
        -------
        list of Jet
            An angle is within half a turn at the first angle of the driver.
        """
        known = self.at(q, order)
        return [self._without_jumps(name, q, _of(known, name, order)) for name in names]

    def _without_jumps(self, name: str, q: Array, found: Jet) -> Jet:
        if not name.endswith(".angle"):
            return found
        places, angles = self._dense(name)
        turns, within = in_cycle(q, self.span) if self.closed else (0.0, q)
        near = np.interp(within, places, angles) + turns * (angles[-1] - angles[0])
        whole = np.round((near - found.c[0]) / (2.0 * math.pi))
        return Jet([found.c[0] + 2.0 * math.pi * whole, *found.c[1:]])

    def miss(self, q: Array) -> float:
        """Return how far members are from their lengths.

        Parameters
        ----------
        q : (n,) array, rad
            Angles of the driver.

        Returns
        -------
        float, mm
            The largest distance of a dyad's joint from where one of its members ends.
        """
        known, worst = self.at(q, 0), 0.0
        for dyad in self.dyads:
            solved, sizes = known.solved[dyad.joint], dyad.sizes(known)
            for number, frame in enumerate(solved.frames):
                way = (solved.joint - frame.origin) * conjugate(frame.direction)
                if f"member{number + 1}" in solved.slides:
                    off = imaginary(way)
                else:
                    off = way - sizes[number]
                worst = max(worst, float(np.abs(np.asarray(off.c[0])).max()))
        return worst

    def _dense(self, name: str) -> tuple[Array, Array]:
        """Return the driver's angles, close together, and an angle there without jumps."""
        if name not in self._angles:
            places = distinct(np.linspace(*self.span, _DENSE), self.knots)
            values = np.asarray(self.track(name, places, 0).c[0])
            self._angles[name] = places, np.unwrap(values)
        return self._angles[name]


def _of(known: Known, name: str, order: int) -> Jet:
    """Return one quantity of a linkage that is solved."""
    found = value(known, name)
    # of what stands still the derivatives are single zeros
    return Jet([one + np.zeros(known.q.shape) for one in found.c[: order + 1]])


def in_cycle(q: Array, span: tuple[float, float]) -> tuple[Array, Array]:
    """Return whole cycles before angles of the driver, and the angles within the first one.

    Parameters
    ----------
    q : (n,) array, rad
        Angles of the driver.
    span : (float, float), rad
        Its first and last angle.

    Returns
    -------
    cycles, within : (n,) arrays
    """
    low, high = span
    cycles = np.floor((q - low) / (high - low))
    return cycles, q - cycles * (high - low)


def value(known: Known, name: str) -> Jet:
    """Return one quantity of a solved linkage by its name (see `Linkage.track`)."""
    if name in known.given:
        return known.jet(name)
    owner, _, what = name.rpartition(".")
    if what == "angle":
        return rotation(known.frame(owner).direction)
    part = {"x": real, "y": imaginary}[what]
    return part(known.jet(owner))
