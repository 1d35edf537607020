"""The regime of a machine, whose speed repeats with every turn, and its flywheel (000, 5.1.4).

The speed after a turn less that before it falls as the latter rises, if the motor's torque falls
with the speed: its largest root is the regime. It is bracketed with a coarse tolerance, from above,
and found with the fine one. A motor of an even torque has no regime of its own: then the mean speed
is given, and the torque is that which keeps it.
"""

from __future__ import annotations

from collections.abc import Callable
from dataclasses import replace
from functools import cache, partial
from typing import Any, Final

import numpy as np

from gearcam.base.errors import InfeasibleError
from gearcam.base.numerals import formatted, shortened
from gearcam.dynamics.motors import ConstantMotor
from gearcam.dynamics.rigid import RigidMotion, RigidRun

_COARSE: Final = 1e-4
"""Tolerance with which a root is bracketed."""

_NEAR: Final = 5e-4
"""Half-width of the bracket around a coarse root, over it."""

_EXACT: Final = 1e-13
"""Relative width to which roots are narrowed."""

_DOWN: Final = 0.85
"""Factor of the speeds at which a turn is tried, from above."""

_LEAST: Final = 0.02
"""Least speed at which a turn is tried, over the highest."""

_TRIED: Final = 8
"""Number of flywheels tried that carry a machine through its load, each four times the last."""

_DOUBLINGS: Final = 24
"""Number of times a flywheel is doubled."""

_SHARES: Final = 12
"""Halvings of the share of the load that has a regime."""


def _root(
    function: Callable[[float], float], low: float, high: float, exact: float = _EXACT
) -> float:
    """Return the root of a function that changes its sign between two places."""
    from scipy.optimize import brentq

    tolerance: Any = exact
    found = brentq(function, low, high, xtol=exact * high, rtol=tolerance)
    return float(found)  # type: ignore[arg-type]


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


def _bracket(gain: Callable[[float], float], scale: float) -> tuple[float, float] | None:
    """Return speeds at the first angle between which the regime is; None if there is none."""
    high = scale
    while gain(high) > 0.0:
        high *= 1.25
    low = _DOWN * high
    while gain(low) <= 0.0:
        high, low = low, _DOWN * low
        if low < _LEAST * scale:
            return None
    return low, high


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
        If the motor is too weak.
    """
    coarse = replace(run, rtol=_COARSE)
    roughly, gain = cache(partial(_gain, coarse)), cache(partial(_gain, run))
    bracket = _bracket(roughly, run.scale)
    if bracket is None:
        raise _too_weak(coarse)
    near = _root(roughly, *bracket, _COARSE)
    return run.from_speed(_root(gain, *_widened(gain, near, _NEAR)))


def _too_weak(coarse: RigidRun) -> InfeasibleError:
    """Return the error for a load without a regime, with the largest share of it that has one."""
    share, step = 0.0, 1.0
    for _ in range(_SHARES):
        step *= 0.5
        machine = replace(coarse.machine, share=share + step)
        gain = partial(_gain, replace(coarse, machine=machine))
        if _bracket(gain, coarse.scale) is not None:
            share += step
    what = "the motor does not turn this load: the machine stops within a turn, from any speed"
    nearest = f"a load of up to {formatted(shortened(share, -1e-2 * share, 2))} times this one runs"
    if share <= 0.0:
        nearest = "a stronger motor"
    heavy = _carrying(coarse)
    if heavy:
        nearest += f"; with a flywheel of {formatted(heavy)} kg m2 all of it does"
    return InfeasibleError(what, where="motor", nearest=nearest)


def _carrying(coarse: RigidRun) -> float:
    """Return a flywheel, kg m2, that carries a machine through its load; 0 if none does."""
    own = coarse.machine.inertia(coarse.machine.rows.at(coarse.machine.knots))
    size = float(np.mean(own))
    for _ in range(_TRIED):
        size = shortened(4.0 * size, 0.1 * size, 2)
        gain = partial(_gain, replace(coarse, machine=coarse.machine.with_flywheel(size)))
        if _bracket(gain, coarse.scale) is not None:
            return size
    return 0.0


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
    """
    even = RigidMotion(machine=run.machine, motor=None, knots=run.machine.knots, even=mean)
    torque = (even.works[1] + even.works[2]) / run.machine.period
    roughly = cache(lambda omega: _repeated(replace(run, rtol=_COARSE), omega, torque))
    exactly = cache(lambda omega: _repeated(run, omega, torque))

    def off(repeated: Callable[[float], RigidMotion]) -> Callable[[float], float]:
        def found(omega: float) -> float:
            try:
                return repeated(omega).mean_speed - mean
            except InfeasibleError:  # it stops: too slow
                return -mean

        return found

    near = _root(off(roughly), *_widened(off(roughly), mean, 0.02), _COARSE)
    return exactly(_root(off(exactly), *_widened(off(exactly), near, _NEAR)))


def _repeated(run: RigidRun, omega: float, torque: float) -> RigidMotion:
    """Return a turn from a speed, rad/s, under the even torque, near another, that repeats it."""

    @cache
    def turn(size: float) -> RigidMotion:
        motion = replace(run, motor=ConstantMotor(size)).from_speed(omega)
        if motion.stopped is not None:
            what = "the machine stops within a turn at this mean speed"
            raise InfeasibleError(
                what, where="drive.speed_rpm", nearest="a flywheel, or more speed"
            )
        return motion

    def gained(size: float) -> float:
        return turn(size).gained

    if abs(gained(torque)) <= run.rtol * run.energy(0.0, omega):  # nothing depends on the speed
        return turn(torque)
    return turn(_root(gained, *_widened(gained, torque, 1e-2)))


def _or_none(motion_with: Callable[[float], RigidMotion], inertia: float) -> RigidMotion | None:
    """Return the regime with a flywheel, kg m2; None if there is none."""
    try:
        return motion_with(inertia)
    except InfeasibleError:
        return None


def flywheel(
    motion_with: Callable[[float], RigidMotion], wanted: float, inertia: float = 1.0
) -> tuple[float, RigidMotion]:
    """Return the least flywheel that keeps an irregularity, and the motion with it.

    Parameters
    ----------
    motion_with : callable
        ``motion_with(inertia)`` returns the regime with a flywheel, kg m2.
    wanted : float
        The irregularity.
    inertia : float, kg m2
        Of the machine; the first flywheel that is tried if it does not run without one.

    Returns
    -------
    float, kg m2
        0 if none is needed.
    RigidMotion

    Raises
    ------
    InfeasibleError
        If the motor is too weak with any flywheel.

    Notes
    -----
    The first guess is (5.39), ``J = J0*(delta0/wanted)``; the irregularity falls as the flywheel
    grows.
    """
    without = _or_none(motion_with, 0.0)
    if without is not None and without.irregularity <= wanted:
        return 0.0, without
    if without is None:  # without a flywheel it does not run through the load
        high = inertia
    else:
        own = without.machine.inertia(without.rows(without.knots))
        high = float(np.mean(own)) * (without.irregularity / wanted)

    @cache
    def over(size: float) -> float:
        motion = _or_none(motion_with, size)
        return 2.0 if motion is None else motion.irregularity - wanted

    low = 0.0
    for _ in range(_DOUBLINGS):
        if over(high) <= 0.0:
            break
        low, high = high, 2.0 * high
    else:
        motion_with(high)  # which may say why
        what = f"no flywheel up to {formatted(high, 3)} kg m2 keeps this irregularity"
        raise InfeasibleError(what, where="motor.irregularity", nearest="a larger one")
    found = _root(over, low, high)
    return found, motion_with(found)
