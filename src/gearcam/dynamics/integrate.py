"""Integration of motions that are smooth between knots and switches.

A *mode* is a form of the equations of motion that holds while some functions of the state are not
negative: teeth in contact, in play, a follower in flight. Where one of these functions becomes
negative the motion *switches* to another mode. Integration starts anew at each knot and each
switch, so that no step crosses one; a step that ends beyond a switch is cut there, by a root of its
dense output. The switch happens a hair beyond the limit, so that the next mode begins within its
own.

The steps are those of scipy's integrators.
"""

from __future__ import annotations

from collections.abc import Callable, Mapping, Sequence
from dataclasses import dataclass, field, replace
from itertools import pairwise
from typing import Any, Final, NamedTuple

import numpy as np
from numpy.typing import ArrayLike

from gearcam.base.display import ShortRepr
from gearcam.base.errors import InfeasibleError
from gearcam.numeric.arrays import Array

METHODS: Final = ("radau", "bdf", "lsoda", "dop853")
"""Integrators by name."""

_CLASSES: Final = {"radau": "Radau", "bdf": "BDF", "lsoda": "LSODA", "dop853": "DOP853"}

_MOST: Final = 1_000_000
"""Largest number of switches."""

_BETWEEN: Final = (0.25, 0.5, 0.75)
"""Where within a step a mode is looked at: it may end and come back in one step."""

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
    last : bool
        Whether the motion ends where it begins.
    """

    rate: Rate
    switches: tuple[Switch, ...] = ()
    last: bool = False


class Piece(NamedTuple):
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
    end : (m,) array
        The state at the end.
    mode : str
        The mode there.
    pieces : list of Piece
        Its last steps, from where on they were kept.
    switches : list of (float, str, str)
        Place of each switch, and the modes before and after it.
    evaluations, steps : int
        Number of evaluations of the equations, and of steps.
    """

    end: Array
    mode: str
    pieces: list[Piece] = field(repr=False)
    switches: list[tuple[float, str, str]] = field(repr=False)
    evaluations: int
    steps: int

    def at(self, x: ArrayLike) -> Array:
        """Return the state, (m, n), at places `x`, (n,), among its pieces; at a switch after it."""
        x = np.asarray(x, dtype=float)
        number = self._number(x)
        found = np.empty((len(self.end), x.size))
        for one in np.unique(number).tolist():
            own = number == one
            found[:, own] = self.pieces[one].at(x[own])
        return found

    def modes(self, x: ArrayLike) -> list[str]:
        """Return the mode at places `x`, (n,); at a switch that after it."""
        return [self.pieces[one].mode for one in self._number(np.asarray(x, dtype=float))]

    def _number(self, x: Array) -> Any:
        inner = np.array([one.low for one in self.pieces[1:]])
        return np.searchsorted(inner, x, side="right")

    def then(self, later: Motion) -> Motion:
        """Return this motion with one that follows it."""
        return replace(
            later,
            pieces=self.pieces + later.pieces,
            switches=self.switches + later.switches,
            evaluations=self.evaluations + later.evaluations,
            steps=self.steps + later.steps,
        )


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
        Largest step: within wider ones the state may be known less well than at their ends.
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
        for low, high in pairwise(knots):
            mode, y = run.stretch(mode, y, float(low), float(high))
            if modes[mode].last:
                break
            passed(float(high))
        return Motion(
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

        self._made = getattr(integrate, _CLASSES[integrator.method])
        self._integrator, self._modes, self._keep = integrator, modes, keep
        self.pieces: list[Piece] = []
        self.switches: list[tuple[float, str, str]] = []
        self.evaluations = self.steps = 0
        self._width: float | None = None

    def stretch(self, mode: str, y: Array, low: float, high: float) -> tuple[str, Array]:
        """Return mode and state at the end of a stretch between knots."""
        x = low
        while x < high and not self._modes[mode].last:
            x, y, after = self._until_switch(mode, y, x, high)
            if after != mode:
                self.switches.append((x, mode, after))
                if len(self.switches) > _MOST:
                    what = f"{_MOST} switches between {mode} and {after} up to {x:.6g} rad"
                    raise InfeasibleError(what, where="dynamics", nearest="more damping")
                mode = after
        return mode, y

    def _until_switch(self, name: str, y: Array, x: float, end: float) -> tuple[float, Array, str]:
        """Integrate in one mode; return place, state and mode at its end or at the knot."""
        mode, given = self._modes[name], self._integrator
        width = None if self._width is None else min(self._width, end - x)
        tolerances = {"rtol": given.rtol, "atol": given.atol, "max_step": given.widest}
        solver = self._made(mode.rate, x, y, end, first_step=width, **tolerances)
        try:
            while solver.status == "running":
                solver.step()
                self.steps += 1
                if solver.status == "failed":
                    what = f"the motion cannot be integrated beyond {solver.t:.6g} rad"
                    raise InfeasibleError(what, where="dynamics.tolerance", nearest="a larger one")
                cut = self._kept(solver, name, mode)
                if cut is not None:
                    return cut
        finally:
            self.evaluations += solver.nfev
            self._width = solver.step_size or self._width
        return end, solver.y, name

    def _kept(self, solver: Any, name: str, mode: Mode) -> tuple[float, Array, str] | None:
        """Keep the last step; return where it switches, the state there and the next mode."""
        low, high = float(solver.t_old), float(solver.t)
        watched = [
            one for one in mode.switches if one.dips or one.holds(high, solver.y) < -one.hair
        ]
        if not watched and high < self._keep:
            return None
        at = solver.dense_output()
        first: tuple[float, Switch] | None = None
        for switch in watched:
            place = _crossing(switch, at, low, high)
            if place is not None and (first is None or place < first[0]):
                first = place, switch
        if (first[0] if first else high) >= self._keep:
            self.pieces.append(Piece(low, first[0] if first else high, name, at))
        return None if first is None else (first[0], at(first[0]), first[1].to)


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
        rtol=8.9e-16,
        full_output=True,
    )
    return float(found)
