"""The regime of a machine, whose speed repeats with every turn, and its flywheel (000, 5.1.4).

The speed after a turn less that before it falls as the latter rises, if the motor's torque falls
with the speed: its largest root is the regime. It is bracketed with a coarse tolerance, from above,
and found with the fine one. A motor of an even torque has no regime of its own: then the mean speed
is given, and the torque is that which keeps it.
"""

from __future__ import annotations

import math
from collections.abc import Callable
from dataclasses import dataclass, replace
from functools import cache, partial
from typing import Final

import numpy as np

from gearcam.base.errors import InfeasibleError
from gearcam.base.numerals import formatted, shortened
from gearcam.dynamics.machine import Machine
from gearcam.dynamics.motors import ConstantMotor
from gearcam.dynamics.rigid import RigidMotion, RigidRun
from gearcam.numeric.roots import largest_fitting

_COARSE: Final = 1e-4
"""Tolerance with which a root is bracketed."""

_NEAR: Final = 5e-4
"""Half-width of the bracket around a coarse root, over it."""

_EXACT: Final = 1e-13
"""Relative width to which roots are narrowed."""

_DOWN: Final = 0.85
"""Factor of the speeds at which a turn is tried, from above."""

_UP: Final = 1.25
"""The same where the load drives."""

_FALLEN: Final = 0.01
"""Error allowed of the speed after a turn, over it."""

_LEAST: Final = 0.02
"""Least speed at which a turn is tried, over the usual one."""

_LARGEST: Final = 1e3
"""Largest one, where the load drives."""

_SAME: Final = 1e-6
"""Difference of speeds, over them, up to which a turn is found; also the width of a bracket, over
the first one, up to which all below a place stops."""

_ROUGH: Final = 1e-6
"""Tolerance of the motion with which the speed at an even torque is bracketed."""

_CLOSE: Final = 5e-3
"""Error of a mean speed found with it, over it: the least speed depends much on the energy."""

_STOPS: Final = 2.0
"""Irregularity of a machine whose least speed is 0."""

_HEAVIEST: Final = 1e4
"""Heaviest flywheel with which a machine is tried that stops without one, over a usual inertia."""

_TRIED: Final = 8
"""Number of flywheels tried that carry a machine through its load, each four times the last."""

_SHARES: Final = 12
"""Halvings of the share of the load that has a regime."""


def _root(
    function: Callable[[float], float], low: float, high: float, exact: float = _EXACT
) -> float:
    """Return the root of a function that changes its sign between two places."""
    from scipy.optimize import brentq

    width, relative = exact * max(abs(low), abs(high)), np.float64(exact)
    found, _ = brentq(function, low, high, xtol=width, rtol=relative, full_output=True)
    return float(found)


def _widened(function: Callable[[float], float], middle: float, near: float) -> tuple[float, float]:
    """Return a bracket of the root of a function around a place near it."""
    while near < 1.0:
        low, high = middle * (1.0 - near), middle * (1.0 + near)
        if function(low) * function(high) <= 0.0:
            return low, high
        near *= 4.0
    what = f"no regime near a speed of {formatted(middle)} rad/s"
    raise InfeasibleError(what, where="dynamics", nearest='run = "start"')


def _gain(run: RigidRun, omega: float) -> float:
    """Return by how much the speed at the first angle rises in a turn, rad/s."""
    return run.speed_after_turn(omega) - omega


def _bracket(gain: Callable[[float], float], run: RigidRun) -> tuple[float, float] | None:
    """Return speeds at the first angle between which the regime is; None if there is none.

    Of two motions the faster one stays the faster: no speed repeats between one and that to which
    it falls in a turn, and if the machine stops from one, it stops from all below.
    """
    high, scale, bends = run.scale, run.scale, run.motor.bends
    while gain(high) > 0.0:
        high = min([_UP * high, *(one for one in bends if one > high)])
        if high > _LARGEST * scale:
            return None
    while True:
        high = min(high, (1.0 + _FALLEN) * (high + gain(high)))
        low = max([_DOWN * high, *(one for one in bends if one < high)])
        if low < _LEAST * scale:
            return None
        if gain(low) > 0.0:
            return low, high
        high = low


def regime(run: RigidRun) -> RigidMotion:
    """Return a turn of a machine in its regime.

    Parameters
    ----------
    run : RigidRun
        A closed machine, with a motor whose torque falls with the speed.

    Returns
    -------
    RigidMotion

    Raises
    ------
    InfeasibleError
        If the motor is too weak, or too weak a brake for a load that drives.
    """
    coarse = replace(run, rtol=_COARSE)
    roughly, gain = cache(partial(_gain, coarse)), cache(partial(_gain, run))
    bracket = _bracket(roughly, run)
    if bracket is None:
        raise _runaway() if roughly(run.scale) > 0.0 else _too_weak(coarse)
    near = _root(roughly, *bracket, _COARSE)
    return run.from_speed(_root(gain, *_widened(gain, near, _NEAR)))


def _runaway() -> InfeasibleError:
    """Return the error for a load that drives more than the motor brakes."""
    what = "the load drives the machine ever faster: no speed repeats after a turn"
    return InfeasibleError(what, where="motor", nearest="a motor that brakes more, or less load")


def _too_weak(coarse: RigidRun) -> InfeasibleError:
    """Return the error for a load without a regime, with the largest share of it that has one."""
    share = largest_fitting(
        lambda one: _runs(coarse, replace(coarse.machine, share=one)), 1.0, _SHARES
    )
    what = "the motor does not turn this load: the machine stops within a turn, from any speed"
    nearest = coarse.machine.lighter.format(formatted(shortened(share, -1e-2 * share, 2)))
    if share <= 0.0:
        nearest = "a stronger motor"
    heavy = _carrying(coarse)
    if heavy:
        nearest += f"; with a flywheel of {formatted(heavy)} kg m2 all of it runs"
    return InfeasibleError(what, where="motor", nearest=nearest)


def _carrying(coarse: RigidRun) -> float:
    """Return a flywheel, kg m2, that carries a machine through its load; 0 if none does."""
    (_, low), (_, high) = coarse.machine.inertia_ends
    sizes = 0.5 * (low + high) * 4.0 ** np.arange(1, _TRIED + 1)
    tried = [shortened(one, 0.025 * one, 2) for one in sizes.tolist()]
    if not _runs(coarse, coarse.machine.with_flywheel(tried[-1])):
        return 0.0
    return next(one for one in tried if _runs(coarse, coarse.machine.with_flywheel(one)))


def _runs(coarse: RigidRun, machine: Machine) -> bool:
    """Return whether a machine has a regime with the motor of a run."""
    run = replace(coarse, machine=machine)
    return _bracket(cache(partial(_gain, run)), run) is not None


def even_torque(run: RigidRun, mean: float) -> RigidMotion:
    """Return a turn of a machine under the even torque that keeps a mean speed.

    Parameters
    ----------
    run : RigidRun
        A closed machine; its motor is not used.
    mean : float, rad/s
        The mean speed, half the sum of the least and the largest.

    Returns
    -------
    RigidMotion

    Raises
    ------
    InfeasibleError
        If the machine stops within a turn.

    Notes
    -----
    From a given speed the energy gained in a turn rises with the torque, and the mean speed of the
    turn that gains none rises with the given speed: both roots are bracketed, above what stops.
    Loads that do not depend on the speed have one torque for all speeds.
    """
    machine = run.machine
    even = RigidMotion(machine=machine, motor=None, knots=machine.knots, even=mean)
    torque = (even.works[1] + even.works[2]) / machine.period
    row = machine.rows.at(machine.rows.edges)
    loads = [machine.load(row, share * mean) for share in (1.0, 2.0)]
    fixed = not even.works[2] and np.array_equal(*loads)
    coarse = _EvenTorque(replace(run, rtol=_ROUGH), mean, torque, fixed, _COARSE)
    near = coarse.speed(mean, 1.0 - _DOWN)
    if coarse.off(near) <= _CLOSE * mean:
        fine = _EvenTorque(run, mean, torque, fixed, _EXACT)
        found = fine.repeated(fine.speed(near, 10.0 * _COARSE))
        if found is not None and found.mean_speed - mean <= _SAME * mean:
            return found
    what = "the machine stops within a turn at this mean speed"
    raise InfeasibleError(what, where="drive.speed_rpm", nearest="a flywheel, or more speed")


@dataclass(frozen=True)
class _EvenTorque:
    """Turns that repeat under an even torque, about a mean speed.

    Parameters
    ----------
    run : RigidRun
        The machine.
    mean : float, rad/s
        The mean speed.
    torque : float, N m
        That torque, or about that.
    fixed : bool
        Whether it is that.
    exact : float
        Relative width to which roots are narrowed.
    """

    run: RigidRun
    mean: float
    torque: float
    fixed: bool
    exact: float

    def repeated(self, omega: float) -> RigidMotion | None:
        """Return the turn that gains no energy from a speed `omega`, rad/s, at the first angle.

        None if a torque that does not stop within the turn gains some.
        """
        low = float(self.run.machine.knots[0])
        usual, torque = self.run.energy(low, omega), self.torque

        @cache
        def turn(size: float) -> RigidMotion:
            return replace(self.run, motor=ConstantMotor(size)).from_speed(omega)

        def gained(size: float) -> float:
            motion = turn(size)
            return motion.gained if motion.stopped is None else -math.inf

        first = gained(torque)
        if self.fixed:
            return None if math.isinf(first) else turn(torque)
        step = max(min(abs(first), usual), _COARSE * usual) / self.run.machine.period
        if math.isinf(first):
            step = max(step, abs(torque))
        ends = _beside(
            gained, torque, lambda x: 2.0 * x - torque - step, lambda x: 2.0 * x - torque + step
        )
        found, steady = _rising_root(gained, *ends, self.exact)
        return turn(found) if steady else None

    def off(self, omega: float) -> float:
        """Return by how much its mean speed is above the one that is wanted; -inf if it stops."""
        motion = self.repeated(omega)
        return -math.inf if motion is None else motion.mean_speed - self.mean

    def speed(self, near: float, part: float) -> float:
        """Return the speed at the first angle, rad/s, at which nothing is off, or the least one."""
        off, down = cache(self.off), 1.0 - part
        ends = _beside(off, near, lambda x: down * x, lambda x: x / down)
        return _rising_root(off, *ends, self.exact)[0]


def _rising_root(
    rising: Callable[[float], float], low: float, high: float, exact: float
) -> tuple[float, bool]:
    """Return the root of a function that is -inf up to some place and rises from there.

    If it is above 0 there, the place and False.
    """
    least = max(exact, _SAME) * (high - low)
    while math.isinf(rising(low)):
        if high - low <= least:
            return high, False
        middle = 0.5 * (low + high)
        low, high = (low, middle) if rising(middle) > 0.0 else (middle, high)
    return _root(rising, low, high, exact), True


def _beside(
    rising: Callable[[float], float],
    place: float,
    down: Callable[[float], float],
    up: Callable[[float], float],
) -> tuple[float, float]:
    """Return a bracket of the root of a rising function, in steps from a place."""
    low = high = place
    if rising(place) > 0.0:
        while rising(low) > 0.0:
            low, high = down(low), low
    else:
        while rising(high) < 0.0:
            low, high = high, up(high)
    return low, high


def flywheel(
    motion_with: Callable[[float], RigidMotion], wanted: float, usual: float
) -> tuple[float, RigidMotion]:
    """Return the least flywheel that keeps an irregularity, and the motion with it.

    Parameters
    ----------
    motion_with : callable
        ``motion_with(inertia)`` returns the regime with a flywheel, kg m2.
    wanted : float
        The irregularity.
    usual : float, kg m2
        Moment of inertia from which flywheels are tried where the machine stops without one.

    Returns
    -------
    float, kg m2
        0 if none is needed.
    RigidMotion

    Raises
    ------
    InfeasibleError
        If the machine has no regime with any of them.

    Notes
    -----
    The first guess is (5.39), ``J = J0*(delta0/wanted)``. The irregularity falls as the flywheel
    grows: of all machines that were tried, also where the inertia balances the load.
    """

    @cache
    def moved(size: float) -> RigidMotion | None:
        try:
            return motion_with(size)
        except InfeasibleError:
            return None

    def over(size: float) -> float:
        motion = moved(size)  # if it stops: none is more irregular
        return (_STOPS if motion is None else motion.irregularity) - wanted

    low, high, without = 0.0, usual, moved(0.0)
    if without is None:
        while moved(high) is None:
            low, high = high, 4.0 * high
            if high > _HEAVIEST * usual:
                motion_with(0.0)  # refuses it
    elif over(0.0) <= 0.0:
        return 0.0, without
    else:
        inertia = without.machine.inertia(without.rows(without.knots))
        high = float(np.mean(inertia)) * (without.irregularity / wanted)
    while over(high) > 0.0:
        low, high = high, 2.0 * high
    found = _root(over, low, high)
    return found, motion_with(found)
