"""Machines on which methods of integration are compared: error against run time.

Four that differ in what they ask of a method: a vibration without damping (50 periods), teeth that
rattle in their backlash (20 impacts), a machine with a changing ratio and stiffness over 60
degrees, and the same turning so slowly that its vibrations die away (about a thousand periods).
"""

from __future__ import annotations

import math
from collections.abc import Callable
from typing import Final, NamedTuple

import numpy as np

from gearcam.dynamics.stiff import StiffPair, StiffRun, StiffState
from gearcam.dynamics.tabled import Tabled
from gearcam.numeric.arrays import Array

_TURN: Final = 2.0 * math.pi

_K, _J1, _J2, _W = 4.3e6, 0.2, 0.3, 6.0 * math.pi
"""N m/rad, kg m2, and 180 rpm in rad/s: those of a nail-making machine."""

_PERIODS, _IMPACTS = 50, 20

_BACKLASH, _ENTERING = 2e-4, 0.5
"""Backlash, rad, and speed in it, rad/s."""

_DAMPING, _TEETH, _LOAD = 0.05, 36, 500.0

_SLOWER: Final = 18.0

_TRUE: Final = 1e-11
"""Tolerance of the run that counts as true, by DOP853."""

_PLACES: Final = 200

ORDERS: Final = {"auto": 8.0, "radau": 5.0, "bdf": 5.0, "lsoda": 8.0, "dop853": 8.0}
"""Expected orders in the number of evaluations; of those that change it, the largest in use."""


class Trial(NamedTuple):
    """A machine and a stretch of its motion.

    Attributes
    ----------
    pair : StiffPair
        The machine.
    start : StiffState
        Its start.
    end : float, rad
        Driver angle at the end.
    """

    pair: StiffPair
    start: StiffState
    end: float

    def run(self, method: str, rtol: float) -> StiffRun:
        """Return the motion by a `method`, to a tolerance `rtol`."""
        return self.pair.run(self.start, self.end, method=method, rtol=rtol)

    def lags(self, run: StiffRun) -> Array:
        """Return the lags of a motion at even places."""
        width = run.motion.place - self.start.phi1
        return run.states(self.start.phi1 + width * np.linspace(0.02, 1.0, _PLACES))[2]

    def true(self) -> Array:
        """Return the lags of a motion that is as good as exact."""
        return self.lags(self.run("dop853", _TRUE))


def trials() -> dict[str, Trial]:
    """Return the machines by name."""
    omega = math.sqrt(_K * (1.0 / _J1 + 1.0 / _J2))
    half = math.pi / omega + _BACKLASH / _ENTERING
    driven = _machine(lambda _, w: 60.0 * (_W - w))
    slow = _machine(lambda _, w: 1e3 * (_W / _SLOWER - w))
    return {
        "free": Trial(_even(0.0), StiffState(0.0, _W, 1e-4), _W * _PERIODS * _TURN / omega),
        "rattle": Trial(
            _even(_BACKLASH), StiffState(0.0, _W, 0.5 * _BACKLASH, _ENTERING), _W * _IMPACTS * half
        ),
        "driven": Trial(driven, driven.resting(0.0, _W), _TURN / 6.0),
        "slow": Trial(slow, slow.resting(0.0, _W / _SLOWER), _TURN / 6.0),
    }


def _even(backlash: float) -> StiffPair:
    table = _table(lambda _: [1.0, 0.0, _K, 0.0, backlash, 0.0])
    return StiffPair(
        table=table,
        inertia=(_J1, _J2),
        damping=0.0,
        motor=lambda _, __: 0.0,
        load=lambda _, __: 0.0,
    )


def _machine(motor: Callable[[float, float], float]) -> StiffPair:
    def rows(x: Array) -> list[Array | float]:
        swing = 0.15 * _K
        return [
            1.0 + 0.4 * np.cos(x),
            -0.4 * np.sin(x),
            _K + swing * np.cos(_TEETH * x),
            -_TEETH * swing * np.sin(_TEETH * x),
            0.0,
            0.0,
        ]

    return StiffPair(
        table=_table(rows),
        inertia=(20.0, _J2),
        damping=2.0 * _DAMPING * math.sqrt(_K / (1.0 / _J1 + 1.0 / _J2)),
        motor=motor,
        load=lambda _, __: _LOAD,
    )


def _table(rows: Callable[[Array], list[Array | float]]) -> Tabled:
    def functions(x: Array) -> Array:
        return np.array([np.broadcast_to(one, x.shape) for one in rows(x)])

    return Tabled(functions, np.array([0.0, _TURN]), 1e-12)


class Comparison:
    """Errors and work of methods on all trials."""

    def __init__(self) -> None:
        self.trials = trials()
        self._true = {name: trial.true() for name, trial in self.trials.items()}

    def run(self, method: str, rtol: float) -> dict[str, StiffRun]:
        """Return the motions by a `method`, to a tolerance `rtol`, by trial."""
        return {name: trial.run(method, rtol) for name, trial in self.trials.items()}

    def error(self, name: str, run: StiffRun) -> float:
        """Return the error of a motion.

        Parameters
        ----------
        name : str
            Of the trial.
        run : StiffRun
            Its motion.

        Returns
        -------
        float
            In the mean square of the lag, over the largest lag.
        """
        true = self._true[name]
        missed = self.trials[name].lags(run) - true
        return float(np.sqrt(np.mean(missed**2)) / np.abs(true).max())

    def measured(self, runs: dict[str, StiffRun]) -> tuple[float, int]:
        """Return the largest error of the motions, and the number of evaluations of all."""
        errors = [self.error(name, run) for name, run in runs.items()]
        return max(errors), sum(run.motion.evaluations for run in runs.values())
