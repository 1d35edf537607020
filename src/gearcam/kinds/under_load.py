"""A cam under its loads: where it is studied, and the forces and the contact pressure there."""

from __future__ import annotations

import math
from functools import partial
from typing import TYPE_CHECKING, Any, Final

import numpy as np

from gearcam.base.errors import DesignError, InfeasibleError, Problem, beyond_limit
from gearcam.base.numerals import formatted
from gearcam.mechanics.follower_loads import Loads
from gearcam.mechanics.hertz import line_pressure
from gearcam.mechanics.statics import Statics, solve
from gearcam.numeric import narrowing
from gearcam.numeric.arrays import distinct
from gearcam.numeric.piecewise import with_both_sides

if TYPE_CHECKING:
    from collections.abc import Callable

    from gearcam.kinds.loaded_cam import LoadedCam
    from gearcam.numeric.arrays import Array, Ints

_TOLD: Final = 0.1
"""Least share of the largest power at which the efficiency counts: near rest it is always 0."""

_CLOSE: Final = 1e-12
"""Distance of both sides of a change of what carries, over the turn or travel."""

_NARROW: Final = 1e-9
"""Width, over the turn or travel, to which an extreme is narrowed."""

_SCALES: Final = 2
"""Number of positions that give the scale of what is rounding, before those asked for."""

_ROUNDING: Final = 1e-12
"""Share of a sampled extreme by which a narrowed one is larger, or they are one."""


def demand(design: Any) -> None:
    """Refuse a design whose masses, springs or dampers need a speed that is missing.

    Raises
    ------
    DesignError
        If it is missing.
    """
    if design.drive.speed is not None:
        return
    key = "drive." + design.drive.key
    solved = any(one.solved for one in design.spring)
    if design.mass and (solved or not design.gravity.given):
        what = "is missing: a mass acts by its inertia, which depends on the speed"
        near = "a speed above 0, or [gravity] for the weight alone"
        if solved:
            what, near = "is missing: a spring is solved for a speed", "a speed above 0"
        problem = Problem(what, file=design.source, key=key, allowed=near)
        raise DesignError([problem])
    if any(one.drag for one in design.spring):
        what, near = "is missing: a damper acts by the speed", "a speed above 0"
        raise DesignError([Problem(what, file=design.source, key=key, allowed=near)])


def loads_of(result: LoadedCam) -> Loads:
    """Return what acts on the follower of a cam, its `result`, beside the cam.

    Raises
    ------
    DesignError
        If it needs a speed, and none is given.
    InfeasibleError
        If no stiffness of a spring keeps the follower on the cam.
    """
    demand(result.design)
    _demand_pin(result)
    design, motion = result.design, result.cam.motions[0]
    pull = design.gravity.pull
    follower, highest = motion.follower, motion.program.range[1]
    loads = Loads(
        program=motion.program,
        follower=follower,
        support=follower.held(design.friction, highest),
        speed=design.drive.speed,
        springs=design.spring,
        given=design.load,
        masses=design.mass,
        pull=-pull.conjugate() if motion.clockwise else pull,
        friction=design.friction,
        side=-1.0 if len(result.touches) == 1 and result.touches[0].above else 1.0,
    )
    if math.isinf(loads.solved.get("stiffness", 0.0)):
        raise _no_stiffness(loads)
    return loads


def _demand_pin(result: LoadedCam) -> None:
    """Refuse a pin that is not thinner than its roller."""
    friction, design = result.design.friction, result.design
    if not friction.roller or getattr(result.follower_spec, "type", "roller") != "roller":
        return
    pin, least = friction.journal_radius[1], min(one.radius for one in result.touches)
    if pin >= least:
        key, near = "friction.journal_radius_mm[1]", f"below {formatted(least)} mm"
        what = f"{formatted(pin)} mm: the pin is not thinner than its roller"
        raise DesignError([Problem(what, file=design.source, key=key, allowed=near)])


def _no_stiffness(loads: Loads) -> InfeasibleError:
    """Return the error for a spring that has no force where it is needed, at zero lift."""
    number = next(k for k, one in enumerate(loads.springs) if one.rate == "solve")
    spring = loads.springs[number]
    given = spring.force if isinstance(spring.force, float) else 0.0
    scale, unit, suffix = loads.follower.load_unit
    what = "no stiffness keeps the follower on the cam: at zero lift only a preload does"
    needed = scale * (given + loads.preload_at_rest)
    where, rule = f"spring[{number}].preload_{suffix}", "the limit is the least preload"
    return beyond_limit(what, where, scale * given, needed, rule, unit=unit)


class UnderLoad:
    """A cam under its loads.

    Parameters
    ----------
    result : LoadedCam
        The cam.

    Raises
    ------
    DesignError, InfeasibleError
        As `loads_of` does.
    """

    def __init__(self, result: LoadedCam) -> None:
        self.result = result
        self.loads = loads_of(result)

    def places(self) -> Array:
        """Return the positions of the driver that are studied; they rise.

        Beside even steps these are both sides of knots of the lift and of the loads, and of places
        where another wall or an edge begins to carry, or the follower begins to lift off or is
        locked; and where forces and contact pressure are largest and least. A cam that slides comes
        back through them.
        """
        program, design = self.result.program, self.result.design
        period, count = program.period, design.forces.steps
        even = period * np.arange(count + 1.0) / count
        even[-1] = np.nextafter(period, 0.0)
        knots = [program.knots, *(one.knots for one in design.load)]
        knots += [touch.edges for touch in self.result.touches]
        x = with_both_sides(even, np.concatenate(knots))
        x = distinct(x, self._changes(x))
        return distinct(x, self._extremes(x))  # which may lie beside changes

    def to_and_fro(self, x: Array) -> tuple[Array, Array]:
        """Return positions `x` in the order of the motion, and the way of each."""
        ways = self.loads.ways
        return np.concatenate([x[:: int(one)] for one in ways]), np.repeat(ways, len(x))

    def statics(self, x: Array, way: Array) -> Statics:
        """Return the forces at positions `x` of the driver, and each `way`."""
        design = self.result.design
        dragged = partial(self.result.follower_spec.dragged, design.friction)
        return solve(self.result.touches, self.loads, self.loads.motion(x, way), dragged)

    def pressure(self, statics: Statics) -> Array:
        """Return the contact pressure, MPa; infinite where an edge of cam or follower carries."""
        material = self.result.design.material
        return line_pressure(statics.force / statics.width, statics.curvature, material)

    def _changes(self, x: Array) -> Array:
        """Return both sides of where something else carries, between positions `x`."""
        x, way = self.to_and_fro(x)

        def states(statics: Statics) -> Array:
            on_edge = np.isinf(self.pressure(statics))
            return 4.0 * statics.carrying + 2.0 * statics.locked + on_edge

        sampled = self.statics(x, way)
        at = np.flatnonzero((np.diff(states(sampled)) != 0.0) & (np.diff(way) == 0.0))
        beside = self._beside(x, way, sampled, at)

        def function(places: Array, rows: Ints) -> Array:
            return states(beside(places, rows))[_SCALES:].reshape(places.shape)

        tolerance = _CLOSE * self.result.program.period
        return np.concatenate(narrowing.changes(function, x[at], x[at + 1], tolerance))

    def _extremes(self, x: Array) -> Array:
        """Return where the quantities of the facts are largest, or least, near positions `x`."""
        x, way = self.to_and_fro(x)

        def sought(statics: Statics) -> Array:
            pressure, force = self.pressure(statics), statics.force
            least = (force, statics.torque, statics.reserve, efficiency_away_from_rest(statics))
            held = (np.abs(one) for one in (statics.bearing, *statics.reactions.values()))
            most = (force, statics.torque, np.where(np.isinf(pressure), np.nan, pressure), *held)
            found = np.stack([*(-one for one in least), *most])
            return np.where(np.isnan(found), -np.inf, found)

        sampled = self.statics(x, way)
        found = sought(sampled)
        turns = np.flatnonzero(np.diff(way, prepend=0.0, append=0.0))
        which, at = narrowing.highest(found, turns)
        beside = self._beside(x, way, sampled, at)

        def function(places: Array, rows: Ints) -> Array:
            values = sought(beside(places, rows))[:, _SCALES:].reshape(-1, *places.shape)
            return values[which[rows], np.arange(len(rows))]

        ends = x[np.maximum(at - 1, 0)], x[np.minimum(at + 1, len(x) - 1)]
        narrow = _NARROW * self.result.program.period
        found_at, values = narrowing.peaks(function, *ends, narrow)
        kept = []
        for number, largest in enumerate(found.max(axis=1)):
            own = np.flatnonzero(which == number)
            best = max(own, key=values.__getitem__, default=None)
            if best is not None and values[best] > largest + _ROUNDING * abs(largest):
                kept.append(found_at[best])
        return np.array(kept)

    def _beside(
        self, x: Array, way: Array, sampled: Statics, at: Ints
    ) -> Callable[[Array, Ints], Statics]:
        """Return the forces at places in brackets, each on the way of the known position in `at`.

        The first two are those at the largest load and at the largest power, with which rounding
        and rest are compared.

        Parameters
        ----------
        x, way : (m,) arrays
            Known positions and ways.
        sampled : Statics
            The forces there.
        at : (n,) int array
            A position of each bracket.

        Returns
        -------
        callable
            ``function(places, rows)`` of (m, k) places, in each bracket's row.
        """
        scales = [int(np.argmax(np.abs(one))) for one in (sampled.against, sampled.useful)]

        def function(places: Array, rows: Ints) -> Statics:
            ways = np.repeat(way[at[rows]], places.shape[1])
            more = np.concatenate([x[scales], places.ravel()])
            return self.statics(more, np.concatenate([way[scales], ways]))

        return function


def largest_pressure(result: LoadedCam) -> float:
    """Return the largest contact pressure of a cam, MPa; 0 without any contact under load.

    It is infinite where an edge of the cam or the follower carries.

    Parameters
    ----------
    result : LoadedCam
        The cam.

    Raises
    ------
    DesignError, InfeasibleError
        As those of the study.
    """
    under = UnderLoad(result)
    statics = under.statics(*under.to_and_fro(under.places()))
    return float(np.nanmax(under.pressure(statics), initial=0.0))


def efficiency_away_from_rest(statics: Statics) -> Array:
    """Return the efficiency where the cam drives with a tenth of its most work or more; else nan.

    Parameters
    ----------
    statics : Statics
        Forces at n positions, the most work among them.

    Returns
    -------
    (n,) array
    """
    strong = statics.useful > _TOLD * np.nanmax(np.abs(statics.useful), initial=0.0)
    return np.where(statics.driven & strong, statics.efficiency, np.nan)
