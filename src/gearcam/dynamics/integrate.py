"""Integration of motions that are smooth between knots and switches.

A *mode* is a form of the equations of motion that holds while some functions of the state are not
negative: teeth in contact or apart, a follower in flight. Where one of these functions becomes
negative the motion *switches* to another mode. Integration starts anew at each knot and each
switch, so that no step crosses one; a step that ends beyond a switch is cut there, by a root of its
dense output. The switch happens a hair beyond the limit, so that the next mode begins within its
own.

The steps are those of scipy's integrators. Which of them, `auto` decides as it goes (see `choice`).
"""

from __future__ import annotations

from collections.abc import Callable, Mapping, Sequence
from dataclasses import dataclass, field, replace
from typing import Any, Final, NamedTuple

import numpy as np
from numpy.typing import ArrayLike

from gearcam.base.display import ShortRepr
from gearcam.base.errors import InfeasibleError
from gearcam.dynamics.choice import MethodChoice
from gearcam.numeric.arrays import Array

METHODS: Final = ("auto", "radau", "bdf", "lsoda", "dop853")
"""Methods by name: `auto` is DOP853 or LSODA, whichever is faster there."""

_CLASSES: Final = {"radau": "Radau", "bdf": "BDF", "lsoda": "LSODA", "dop853": "DOP853"}

_MOST: Final = 1_000_000
"""Largest number of switches."""

_BETWEEN: Final = (0.25, 0.5, 0.75)
"""Where within a step a mode is looked at: it may end and come back in one step."""

_SLIGHTLY: Final = 1e-6
"""Part of a step in which a condition is linear."""

_NEAR: Final = 1e-2
"""Largest part of a step by which a switch is corrected."""

_ROUNDING: Final = 1e-12
"""Rounding of a place."""

_ROUNDINGS: Final = 8.0
"""Rounding of a knot, over that of the number: knots are repeated with the turn."""

_HERMITE: Final = np.array(
    [
        [(1 + 2 * s) * (1 - s) ** 2, s * (1 - s) ** 2, s * s * (3 - 2 * s), s * s * (s - 1)]
        for s in (0.0, *_BETWEEN, 1.0)
    ]
)
"""Weights of the cubic through states and rates at the ends of a step."""

Rate = Callable[[float, Any], Sequence[float]]
"""``rate(x, y)``: derivatives of the state."""


class Switch(NamedTuple):
    """An end of a mode.

    Attributes
    ----------
    holds : callable
        ``holds(x, y)`` is not negative while the mode goes on.
    to : str
        Name of the mode that follows.
    hair : float
        How far below 0 it falls before the switch: rounding of the function.
    dips : bool
        Whether it may fall below 0 and come back within a step.
    """

    holds: Callable[[float, Any], float]
    to: str
    hair: float
    dips: bool = True


@dataclass(frozen=True, eq=False)
class Mode(ShortRepr):
    """Equations of motion, and where they cease to hold.

    Parameters
    ----------
    rate : callable
        ``rate(x, y)`` returns the derivatives of the state, as a list of floats.
    switches : tuple of Switch
        Its ends.
    pace : callable or None
        ``pace(x, y)``: size of the largest eigenvalue, a natural frequency in most cases, per unit
        of x; None if nothing is stiff.
    last : bool
        Whether the motion ends where it begins.
    """

    rate: Rate
    switches: tuple[Switch, ...] = ()
    pace: Callable[[float, Any], float] | None = None
    last: bool = False


class MotionPiece(NamedTuple):
    """A step of a motion.

    Attributes
    ----------
    low, high : float
        Its ends; it may have been cut at a switch.
    mode : str
        Name of its mode.
    at : callable
        ``at(x)`` returns the state, (m, n) at places (n,).
    """

    low: float
    high: float
    mode: str
    at: Callable[[Array], Array]


@dataclass(frozen=True, eq=False, kw_only=True)
class Motion(ShortRepr):
    """A motion that was integrated.

    Parameters
    ----------
    place : float
        Where it ends.
    end : (m,) array
        The state there.
    mode : str
        The mode there.
    pieces : list of MotionPiece
        Its last steps, from where on they were kept.
    switches : list of (float, str, str)
        Place of each switch, and the modes before and after it.
    evaluations, steps : int
        Number of evaluations of the equations, and of steps.
    """

    place: float
    end: Array
    mode: str
    pieces: list[MotionPiece] = field(repr=False)
    switches: list[tuple[float, str, str]] = field(repr=False)
    evaluations: int
    steps: int

    def at(self, x: ArrayLike) -> Array:
        """Return the state, (m, n), at places `x`, (n,), among its pieces; at a switch after it.

        Raises
        ------
        ValueError
            If a place is not among them.
        """
        x = np.asarray(x, dtype=float)
        near = _ROUNDING * max(1.0, abs(self.place))
        if x.size and not self.pieces[0].low - near <= x.min() <= x.max() <= self.place + near:
            raise ValueError(f"kept from {self.pieces[0].low} to {self.place} only")
        number = self._number(x)
        order = np.argsort(number, kind="stable")
        found = np.empty((len(self.end), x.size))
        starts = np.flatnonzero(np.diff(number[order], prepend=-1))
        for own in np.split(order, starts[1:]) if x.size else ():
            found[:, own] = self.pieces[int(number[own[0]])].at(x[own])
        return found

    def modes(self, x: ArrayLike) -> list[str]:
        """Return the mode at places `x`, (n,); at a switch that after it."""
        return [self.pieces[one].mode for one in self._number(np.asarray(x, dtype=float))]

    def _number(self, x: Array) -> Any:
        inner = np.array([one.low for one in self.pieces[1:]])
        return np.searchsorted(inner, x, side="right")


@dataclass(frozen=True, kw_only=True)
class Integrator(ShortRepr):
    """How motions are integrated.

    Parameters
    ----------
    method : str
        Of `METHODS`.
    rtol : float
        Tolerance of a step, relative to the state.
    atol : tuple of float
        The same, absolute, for each part of the state.
    widest : float
        Largest step: within wider ones of DOP853 the state is less exact than at their ends.
    """

    method: str
    rtol: float
    atol: tuple[float, ...]
    widest: float = np.inf

    def __call__(
        self,
        modes: Mapping[str, Mode],
        start: tuple[str, ArrayLike],
        knots: Sequence[float],
        *,
        keep: float = -np.inf,
        passed: Callable[[float], None] = lambda _: None,
    ) -> Motion:
        """Return the motion from the first to the last knot.

        Parameters
        ----------
        modes : mapping of str to Mode
            The modes by name.
        start : (str, (m,) array)
            The first mode, and the state at the first knot.
        knots : sequence of float
            Rising: where the equations are not smooth.
        keep : float
            From where on the steps are kept.
        passed : callable
            Called with each knot that is reached.

        Returns
        -------
        Motion

        Raises
        ------
        InfeasibleError
            If the motion switches without end, or a step becomes too small.
        """
        mode, state = start
        y = np.asarray(state, dtype=float)
        run = _Run(self, modes, keep)
        place = float(knots[0])
        run.begin(mode, place, y)
        for high in map(float, knots[1:]):
            place, mode, y = run.stretch(mode, y, place, high)
            if modes[mode].last:
                break
            passed(high)
        return Motion(
            place=place,
            end=y,
            mode=mode,
            pieces=run.pieces,
            switches=run.switches,
            evaluations=run.evaluations,
            steps=run.steps,
        )


class _Run:
    """An integration and what it has found so far."""

    def __init__(self, integrator: Integrator, modes: Mapping[str, Mode], keep: float) -> None:
        from scipy import integrate

        self._made = {name: getattr(integrate, one) for name, one in _CLASSES.items()}
        self._choice = MethodChoice() if integrator.method == "auto" else None
        self._integrator, self._modes, self._keep = integrator, modes, keep
        self.pieces: list[MotionPiece] = []
        self.switches: list[tuple[float, str, str]] = []
        self.evaluations = self.steps = 0
        self._width: float | None = None

    def stretch(self, mode: str, y: Array, low: float, high: float) -> tuple[float, str, Array]:
        """Return place, mode and state at the end of a stretch between knots."""
        x, inner = low, _inner(low, high)
        while x < high and not self._modes[mode].last:
            x, y, after = self._smooth(mode, y, x, high, inner)
            if after != mode:
                self.switches.append((x, mode, after))
                if len(self.switches) > _MOST:
                    what = f"{_MOST} switches between {mode} and {after} up to {x:.6g} rad"
                    raise InfeasibleError(what, where="dynamics", nearest="more damping")
                mode = after
                self.begin(mode, x, y)
        return x, mode, y

    def begin(self, name: str, x: float, y: Array) -> None:
        """Begin a mode that may be much faster than the one before with a short step."""
        mode = self._modes[name]
        if mode.pace:
            self._width = min(self._width or np.inf, 1.0 / mode.pace(x, y))

    def _smooth(
        self, name: str, y: Array, x: float, end: float, inner: tuple[float, float]
    ) -> tuple[float, Array, str]:
        """Integrate in one mode by one method; return place, state and mode at the end of it."""
        mode, choice = _within(self._modes[name], *inner), self._choice
        solver = self._solver(mode, x, y, end)
        longest = 0.0  # the last step may have been cut
        try:
            while solver.status == "running":
                solver.step()
                self.steps += 1
                if solver.status == "failed":
                    if choice and choice.fails():
                        return float(solver.t), solver.y, name
                    what = f"the motion cannot be integrated beyond {solver.t:.6g} rad"
                    raise InfeasibleError(what, where="dynamics.tolerance", nearest="a larger one")
                cut = self._kept(solver, name, mode)
                if cut is not None:
                    return cut
                if choice and mode.pace and choice.changes(solver, mode.pace(solver.t, solver.y)):
                    return float(solver.t), solver.y, name
                longest = max(float(solver.step_size), 0.5 * longest)
        finally:
            self.evaluations += solver.nfev
            self._width = 0.5 * max(longest, float(solver.step_size or 0.0)) or self._width
        return end, solver.y, name

    def _solver(self, mode: Mode, x: float, y: Array, end: float) -> Any:
        """Return an integrator that begins with steps as long as the last ones."""
        given, method = self._integrator, self._choice.method if self._choice else None
        method = method or given.method
        width = None if self._width is None else min(self._width, end - x)
        settings = {"rtol": given.rtol, "atol": given.atol, "max_step": given.widest}
        return self._made[method](mode.rate, x, y, end, first_step=width, **settings)

    def _kept(self, solver: Any, name: str, mode: Mode) -> tuple[float, Array, str] | None:
        """Keep the last step; return where it switches, the state there and the next mode."""
        low, high = float(solver.t_old), float(solver.t)
        wanted = high >= self._keep
        likely = [one for one in mode.switches if _may_end(one, solver)]
        if not likely and not wanted:
            return None
        at = solver.dense_output()
        first: tuple[float, Switch] | None = None
        for switch in likely:
            place = _crossing(switch, at, low, high)
            if place is not None and (first is None or place < first[0]):
                first = place, switch
        if (first[0] if first else high) >= self._keep:
            self.pieces.append(MotionPiece(low, first[0] if first else high, name, at))
        if first is None:
            return None
        if not hasattr(solver, "K"):
            return first[0], at(first[0]), first[1].to
        return self._again(solver, mode.rate, *first)

    def _again(
        self, solver: Any, rate: Rate, place: float, switch: Switch
    ) -> tuple[float, Array, str]:
        """Return place, state and mode of a switch, by a step that ends there.

        The dense output of DOP853 is less accurate than its steps, and what is missed at each of
        many switches does not fall with the tolerance.
        """
        low, high = float(solver.t_old), float(solver.t)
        if place <= low:  # it began there
            return low, solver.y_old, switch.to
        step = type(solver)(
            rate, low, solver.y_old, place, rtol=1.0, atol=np.inf, first_step=place - low
        )
        step.step()
        self.evaluations += step.nfev
        left = switch.holds(place, step.y) + switch.hair
        width = _SLIGHTLY * (high - low)
        slope = (switch.holds(place + width, step.y + width * step.f) - left + switch.hair) / width
        more = -left / slope if slope else 0.0
        more = more if abs(more) <= _NEAR * (high - low) and place + more > low else 0.0
        return place + more, step.y + more * step.f, switch.to


def _inner(low: float, high: float) -> tuple[float, float]:
    """Return the ends of a stretch, moved inwards by more than their rounding.

    At a knot, functions may have the value of the other side.
    """
    rounding = _ROUNDINGS * float(np.spacing(max(abs(low), abs(high))))
    middle = 0.5 * (low + high)
    return min(low + rounding, middle), max(high - rounding, middle)


def _within(mode: Mode, low: float, high: float) -> Mode:
    """Return a mode whose rates are taken between two places."""

    def rate(x: float, y: Any) -> Sequence[float]:
        return mode.rate(low if x < low else high if x > high else float(x), y)

    return replace(mode, rate=rate)


def _may_end(switch: Switch, solver: Any) -> bool:
    """Return whether a mode may end in the last step.

    Of DOP853, whose dense output costs a quarter of a step, by the cubic over the step: not if the
    function changes by less than its least value.
    """
    if not switch.dips:
        return switch.holds(float(solver.t), solver.y) < -switch.hair
    if not hasattr(solver, "K"):
        return True
    low, width = solver.t_old, solver.t - solver.t_old
    ends = (solver.y_old, width * solver.K[0], solver.y, width * solver.f)
    states = _HERMITE @ np.array(ends)
    values = [
        switch.holds(low + share * width, state)
        for share, state in zip((0.0, *_BETWEEN, 1.0), states.tolist(), strict=True)
    ]
    least = min(values)
    return least <= max(values) - least


def _crossing(
    switch: Switch, at: Callable[[float], Array], low: float, high: float
) -> float | None:
    """Return the first place in a step at which a mode ceases to hold, or None."""

    def left(x: float) -> float:
        return switch.holds(x, at(x)) + switch.hair

    before = low
    for share in (*_BETWEEN, 1.0):
        after = low + share * (high - low)
        if left(after) < 0.0:
            return _root(left, before, after)
        before = after
    return None


def _root(function: Callable[[float], float], low: float, high: float) -> float:
    """Return a place just beyond the root of a function that falls below 0 between two places."""
    from scipy.optimize import brentq

    if function(low) <= 0.0:  # it begins to fall at once
        return high
    found, _ = brentq(
        function,
        low,
        high,
        xtol=4e-16 * max(abs(low), abs(high), 1e-300),
        rtol=np.float64(8.9e-16),
        full_output=True,
    )
    return float(found)
