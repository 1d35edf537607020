"""Harmonics of a lead or a lag over whole turns of the driver."""

from __future__ import annotations

from typing import Final

import numpy as np

from gearcam.base.numerals import formatted
from gearcam.numeric.arrays import Array

LEAST_STEPS: Final = 8
"""Steps per tooth needed."""

MOST_ORDERS: Final = 3
"""Number of harmonics, in multiples of the tooth frequency."""


def too_few(steps: int, teeth: int) -> str:
    """Return why steps are too few for harmonics; an empty string if they are enough.

    Parameters
    ----------
    steps : int
        The setting that is too small or not.
    teeth : int
        Teeth of the driver that pass in these steps.

    Returns
    -------
    str
        Reason and remedy.
    """
    if steps >= LEAST_STEPS * teeth:
        return ""
    return (
        f"{formatted(steps / teeth, 3)} steps per tooth, needed: {LEAST_STEPS}; "
        f"steps = {LEAST_STEPS * teeth}"
    )


def harmonics(
    values: Array, start: float, turns: int, teeth: int, least: float, *, between: bool = False
) -> list[dict[str, float]]:
    """Return the harmonics of the driver's turn in `values`, up to three of the teeth.

    Parameters
    ----------
    values : (n,) array
        At even steps over whole turns of the driver, without their end.
    start : float, rad
        Driver angle of the first of them.
    turns : int
        Number of turns.
    teeth : int
        Of the driver.
    least : float
        Rounding of `values`: smaller harmonics are left out.
    between : bool
        Whether also those of the whole cycle, between those of a turn.

    Returns
    -------
    list of dict
        ``order`` per turn, ``amplitude`` in the unit of `values`, ``phase_deg``: the values are
        their mean and the sum of ``amplitude*cos(order*phi1 + phase)``.
    """
    step = 1 if between else turns
    cycles = np.arange(step, MOST_ORDERS * teeth * turns + 1, step)
    orders = cycles / turns
    parts = 2.0 / len(values) * np.fft.rfft(values)[cycles] * np.exp(-1j * orders * start)
    return [
        {
            "order": int(order) if order == int(order) else float(order),
            "amplitude": float(abs(part)),
            "phase_deg": float(np.degrees(np.angle(part))),
        }
        for order, part in zip(orders, parts, strict=True)
        if abs(part) > least
    ]
