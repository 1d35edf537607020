"""Machines on which methods of integration are compared: error against run time.

Four that differ in what they ask of a method: a vibration without damping (50 periods), teeth that
rattle in their backlash (20 impacts), a machine with a changing ratio and stiffness over 60
degrees, and the same turning so slowly that its vibrations die away (about a thousand periods).
"""

from __future__ import annotations

import math
from collections.abc import Callable
from dataclasses import dataclass
from functools import cached_property
from typing import Final

import numpy as np

from gearcam.dynamics.machine import TURN
from gearcam.dynamics.stiff import StiffPair, StiffRun, StiffState
from gearcam.dynamics.tabled import Tabled
from gearcam.numeric.arrays import Array

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


@dataclass(frozen=True, eq=False)
class Trial:
    """A machine and a stretch of its motion.

    Parameters
    ----------
    what : str
        What it is.
    pair : StiffPair
        The machine.
    start : StiffState
        Its start.
    end : float, rad
        Driver angle at the end.
    """

    what: str
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

    @cached_property
    def _true(self) -> Array:
        return self.lags(self.run("dop853", _TRUE))

    def measured(self, run: StiffRun) -> tuple[float, int]:
        """Return the error of a motion, and its number of evaluations.

        The error is the root mean square of that of the lag, over the largest lag.
        """
        missed = self.lags(run) - self._true
        error = np.sqrt(np.mean(missed**2)) / np.abs(self._true).max()
        return float(error), run.motion.evaluations


def trials() -> dict[str, Trial]:
    """Return the machines by name."""
    omega = math.sqrt(_K * (1.0 / _J1 + 1.0 / _J2))
    free = _W * _PERIODS * TURN / omega
    rattle = _W * _IMPACTS * (math.pi / omega + _BACKLASH / _ENTERING)
    plain, parting = _even(0.0), _even(_BACKLASH)
    driven = _machine(lambda _, w: 60.0 * (_W - w))
    slow = _machine(lambda _, w: 1e3 * (_W / _SLOWER - w))
    return {
        "free": Trial("50 free periods", plain, StiffState(0.0, _W, 1e-4), free),
        "rattle": Trial(
            "20 impacts", parting, StiffState(0.0, _W, 0.5 * _BACKLASH, _ENTERING), rattle
        ),
        "driven": Trial("180 rpm, 60 deg", driven, driven.resting(0.0, _W), TURN / 6.0),
        "slow": Trial("10 rpm, 60 deg", slow, slow.resting(0.0, _W / _SLOWER), TURN / 6.0),
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

    return Tabled(functions, np.array([0.0, TURN]), 1e-12)
