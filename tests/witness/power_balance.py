"""The driver's moment of a loaded mechanism by its power balance, from positions alone.

The power of the driver is that of all loads, dampers and springs and of what lifts and speeds up
masses. Positions come from the mechanism; all else is read from its design and computed here, by
differences of five places: no derivative of the program is used.
"""

from __future__ import annotations

import math
from collections.abc import Callable, Iterator
from functools import cached_property
from typing import Any, Final

import numpy as np
from numpy.typing import NDArray

Array = NDArray[np.float64]

_STEP: Final = 2e-3
"""Between neighbouring places, rad."""

_DENSE: Final = 20001
"""Places among which the ends of a way are looked for."""

_PLACES: Final = _STEP * np.arange(-2.0, 3.0)
_FIRST: Final = np.array([1.0, -8.0, 0.0, 8.0, -1.0]) / (12.0 * _STEP)
_SECOND: Final = np.array([-1.0, 16.0, -30.0, 16.0, -1.0]) / (12.0 * _STEP**2)

Way = Callable[[Array], Any]


class PowerBalance:
    """A loaded mechanism.

    Parameters
    ----------
    result : MechanismResult
        Its result; wheels have no density.
    """

    def __init__(self, result: Any) -> None:
        self.design, self.linkage = result.design, result.linkage
        self.speed = self.design.drive[0].speed or 0.0

    @property
    def reach(self) -> float:
        """How far the places of a difference are apart from its angle, rad."""
        return 2.0 * _STEP

    def moment(self, q: float) -> float:
        """Return the driver's moment at an angle, N mm, away from knots and from ends of loads."""
        parts = (self._loads(q), self._masses(q), self._springs(q))
        return sum(sum(one) for one in parts)

    # --- positions and their differences ---------------------------------------------------------

    def _joint(self, name: str) -> Way:
        pushed = {one.name: one.joint for one in (*self.design.slide, *self.design.hoist)}
        return lambda q: np.asarray(self.linkage.track(pushed.get(name, name), q, 0).c[0]) + 0j * q

    def _angle(self, name: str) -> Way:
        def angle(q: Array) -> Array:
            if name == "ground":
                return 0.0 * q
            return np.asarray(self.linkage.real_track(f"{name}.angle", q, 0).c[0]) + 0.0 * q

        return angle

    def _quantity(self, name: str) -> Way:
        return lambda q: np.asarray(self.linkage.track(name, q, 0).c[0]) + 0.0 * q

    @cached_property
    def _slides(self) -> dict[str, tuple[str, str, str]]:
        """Joint, place and guide of each slide."""
        found = {}
        for one in self.design.dyad:
            if one.type in ("RRT", "RTT"):
                found[one.joint] = (one.joint, f"{one.joint}.guide2", one.last)
            if one.type in ("TRR", "TTR"):
                found[one.joint] = (one.joint, f"{one.joint}.guide1", one.first)
        for one in self.design.slide:
            found[one.name] = found[one.joint] = (one.joint, one.on, f"{one.on}.way")
        for one in self.design.hoist:
            place = (one.joint, one.way, one.guide)
            found[one.name] = found[one.joint] = place
        return found

    @cached_property
    def _members(self) -> set[str]:
        design = self.design
        members = [name for one in design.dyad for name in one.members]
        members += [one.name for one in (*design.crank, *design.geneva)]
        return {*members, *(one.lever for one in design.chain)}

    # --- what acts -------------------------------------------------------------------------------

    def _loads(self, q: float) -> Iterator[float]:
        at = q + _PLACES
        for load in self.design.load:
            if not self._acts(load, q):
                continue
            if load.force is not None and len(load.force) == 2:
                slope = _FIRST @ self._joint(load.on)(at)
                yield -(load.force[0] * slope.real + load.force[1] * slope.imag)
                continue
            place, slope = self._way(load, q)
            size = self._size(load, q, place, slope * self.speed)
            yield abs(size * slope) if load.against else -size * slope

    def _way(self, load: Any, q: float) -> tuple[float, float]:
        """Return the place of what is loaded, and its derivative in the load's direction."""
        at = q + _PLACES
        if load.direction is not None:
            along = self._joint(load.on)(at) * np.exp(-1j * load.direction)
            return float(along[2].real), float((_FIRST @ along).real)
        if load.on in self._slides:
            joint, place, guide = self._slides[load.on]
            turn = np.exp(-1j * self._angle(guide)(at[2:3])[0])
            slope = float((turn * (_FIRST @ self._joint(joint)(at))).real)
            return float(self._quantity(place)(at[2:3])[0]), slope
        way = self._angle(load.on) if load.on in self._members else self._quantity(load.on)
        return float(way(at)[2]), float(_FIRST @ way(at))

    def _size(self, load: Any, q: float, place: float, velocity: float) -> float:
        slides = load.on in self._slides or load.direction is not None
        turns = load.on in self._members or not (slides or self._along(load.on))
        unit = 1e3 if turns else 1.0
        if load.formula is not None:
            names = {"q": q, "x": place, "v": velocity, "pi": math.pi, **vars(math)}
            return unit * float(eval(load.formula, {"__builtins__": {}}, names))  # noqa: S307
        if load.table is not None and load.place is not None:
            turn = load.place[-1] - load.place[0]
            over = q if turn < 6.28 else (q - load.place[0]) % turn + load.place[0]
            return unit * float(np.interp(over, load.place, load.table))
        if load.table is not None:
            return unit * float(np.interp(place, load.way, load.table))
        return load.torque if load.force is None else load.force[0]

    def _along(self, name: str) -> bool:
        drive, _, word = name.rpartition(".")
        if word in ("rack", "slide"):
            return True
        cams = [one.cam for one in self.design.drive if one.name == drive]
        if word == "follower":
            return cams[0].follower.motion != "oscillating"
        return any(one.name == name and one.slide is not None for one in self.design.drive)

    def _acts(self, load: Any, q: float) -> bool:
        if load.travel is not None:
            if load.on in self._slides:
                way = self._quantity(self._slides[load.on][1])
            else:
                way = self._quantity(load.on)
            low, high = self.linkage.span
            every = way(np.linspace(low, high, _DENSE))
            here, slope = float(way(np.array([q]))[0]), float(_FIRST @ way(q + _PLACES))
            if load.before == "outer":
                return bool(slope > 0.0 and here > every.max() - load.travel)
            return bool(slope < 0.0 and here < every.min() + load.travel)
        if load.start is None:
            return True
        low, high = self.linkage.span
        turn = high - low if load.end > 2.0 * math.pi else 2.0 * math.pi
        if not self.linkage.closed:
            return bool(load.start <= q < load.end)
        return bool((q - load.start) % turn < load.end - load.start)

    def _masses(self, q: float) -> Iterator[float]:
        at, pull = q + _PLACES, self.design.gravity.pull
        for mass in self.design.mass:
            center = self._center(mass)
            if mass.mass is not None and center is not None:
                places = center(at)
                slope, second = _FIRST @ places, _SECOND @ places
                yield 1e-3 * self.speed**2 * mass.mass * float((slope.conjugate() * second).real)
                yield -mass.mass * float((np.conj(pull) * slope).real)
            turns = mass.of in self._members or mass.of in self._slides
            angle = (self._angle if turns else self._quantity)(mass.of)(at)
            yield 1e3 * self.speed**2 * mass.inertia * float((_FIRST @ angle) * (_SECOND @ angle))

    def _center(self, mass: Any) -> Way | None:
        if mass.at is not None:

            def place(q: Array) -> Any:
                frame = self.linkage.at(q, 0).frame(mass.of)
                origin, axis = (np.asarray(one.c[0]) + 0j * q for one in frame)
                return origin + axis * complex(*mass.at)

            return place
        if mass.center is not None:
            return self._joint(mass.center)
        slides = {one.members[1]: one.joint for one in self.design.dyad if one.type == "RRT"}
        slides |= {one.members[0]: one.joint for one in self.design.dyad if one.type == "TRR"}
        return self._joint(slides.get(mass.of, mass.of)) if mass.mass is not None else None

    def _springs(self, q: float) -> Iterator[float]:
        low, high = self.linkage.span
        at, zero = q + _PLACES, np.array([min(max(0.0, low), high)])
        for spring in self.design.spring:
            way = self._stretched(spring)
            ways, first = way(at), float(way(zero)[0])
            if spring.torsion or spring.moment or spring.swing_damping:
                rate, pull, damping = spring.torsion, spring.moment, spring.swing_damping
                free = first
            else:
                rate, pull, damping = spring.stiffness, spring.preload, spring.damping
                free = first if spring.length is None else spring.length
            energy = 0.5 * rate * (ways - free) ** 2 + pull * (ways - free)
            yield float(_FIRST @ energy) + damping * self.speed * float(_FIRST @ ways) ** 2

    def _stretched(self, spring: Any) -> Way:
        if spring.between is not None:
            first, second = spring.between
            if {first, second} & (self._members | {"ground"}):
                return lambda q: self._angle(second)(q) - self._angle(first)(q)
            return lambda q: np.abs(self._joint(second)(q) - self._joint(first)(q))
        if spring.on in self._slides:
            return self._quantity(self._slides[spring.on][1])
        return (self._angle if spring.on in self._members else self._quantity)(spring.on)
