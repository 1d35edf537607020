"""Which integrator is faster there: the explicit DOP853, or LSODA with its implicit formulas.

DOP853 follows vibrations with least work. Once they have died away it is still bound to steps of
about a natural period, beyond which it is not stable; implicit formulas then take steps as long as
what happens allows. So DOP853 goes on until its steps are as long as stability allows; then LSODA
is tried, and goes on while it costs less for the way that it makes. A trial that fails is repeated
after twice as many steps, so that all trials together cost little.

Radau in its place would be as fast for a loose tolerance, but takes two to three times as long for
a tolerance of 1e-6 (see `trials`).

Work is counted in evaluations with fixed weights, not in seconds: the same on every machine.
"""

from __future__ import annotations

from typing import Any, Final

EXPLICIT, IMPLICIT = "dop853", "lsoda"

_STABLE: Final = 4.0
"""Steps of DOP853, in rad of the natural vibration, from where on it may be stability that binds:
the limit is about 6."""

_FIRST: Final = 8
"""Number of such steps, one after the other, before the first trial."""

_SETTLED: Final = 40
"""Steps in which LSODA, which begins with order 1, reaches its length of steps."""

_WINDOW: Final = 20
"""Steps over which its work is looked at."""

_WEIGHT: Final = 2.0
"""Time of an evaluation in LSODA, with all that belongs to it, over that in DOP853: 1.0 to 1.9."""


class MethodChoice:
    """The method in use, and when it changes."""

    def __init__(self) -> None:
        self.method = EXPLICIT
        self._wait = _FIRST
        self._explicit = 0.0  # evaluations of DOP853 for a rad of the vibration
        self._solver: Any = None
        self._seen = 0
        self._restart()

    def _restart(self, settling: int = 0) -> None:
        self._steps, self._work, self._way = -settling, 0, 0.0

    def changes(self, solver: Any, pace: float) -> bool:
        """Return whether another method goes on after a step.

        Parameters
        ----------
        solver : OdeSolver
            The integrator that made it.
        pace : float
            Of the mode (see `Mode`).
        """
        if solver is not self._solver:
            self._solver, self._seen = solver, 0
        way, work = float(solver.step_size) * pace, solver.nfev - self._seen
        self._seen = solver.nfev
        self._steps += 1
        if self._steps > 0:
            self._work += work
            self._way += way
        return self._to_implicit(way) if self.method == EXPLICIT else self._to_explicit()

    def _to_implicit(self, way: float) -> bool:
        if way < _STABLE:
            self._restart()
        elif self._steps >= self._wait:
            self.method, self._explicit = IMPLICIT, self._work / self._way
            self._restart(_SETTLED)
            return True
        return False

    def _to_explicit(self) -> bool:
        if self._steps < _WINDOW:
            return False
        slower = _WEIGHT * self._work > self._explicit * self._way
        self._restart()
        if not slower:
            self._wait = _FIRST
        return slower and self.fails()

    def fails(self) -> bool:
        """Go back to the explicit method; return whether it was not in use."""
        was_implicit = self.method == IMPLICIT
        self.method, self._wait = EXPLICIT, 2 * self._wait
        self._restart()
        return was_implicit
