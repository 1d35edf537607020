"""The nearest feasible design: how many teeth a pair needs that was refused.

A wheel whose law bends too sharply for its teeth can be made with more of them: at a given centre
distance that is a smaller module, at a given module a larger wheel. The fewest are found by
building: doubled until it works, then halved down to the last step that does not.
"""

from __future__ import annotations

import math
import time
from collections.abc import Callable
from dataclasses import dataclass

from gearcam.errors import InfeasibleError
from gearcam.gears.pair import lobes_of

_MOST = 400
"""Most teeth of a wheel that are tried: beyond them nobody is helped."""

_PATIENCE = 6.0
"""Seconds after which the search is given up."""


@dataclass(frozen=True)
class Fewest:
    """Tooth counts that work.

    Parameters
    ----------
    teeth : (int, int)
        For both wheels.
    exact : bool
        Whether one step fewer is refused; else fewer may do.
    """

    teeth: tuple[int, int]
    exact: bool


def fewest_teeth(
    teeth: tuple[int, int], factor: float, attempt: Callable[[tuple[int, int]], object]
) -> Fewest | None:
    """Find the fewest teeth, in the same ratio, for which a pair can be made.

    Parameters
    ----------
    teeth : (int, int)
        Tooth counts that were refused.
    factor : float
        How many times more are likely needed.
    attempt : callable
        Builds the pair with other tooth counts, or raises `InfeasibleError`.

    Returns
    -------
    Fewest or None
        None if no number was found within the time.
    """
    lobes, start = lobes_of(teeth), time.perf_counter()

    def counts(k: int) -> tuple[int, int]:
        return lobes.n1 * k, lobes.n2 * k

    def builds(k: int) -> bool:
        try:
            attempt(counts(k))
        except InfeasibleError:
            return False
        return True

    low = teeth[0] // lobes.n1
    most = _MOST // max(lobes.n1, lobes.n2)
    high = max(low + 1, math.ceil(low * factor * (1.0 - 1e-9)))
    if high > most:
        return None
    while not builds(high):
        if high == most or time.perf_counter() - start > _PATIENCE:
            return None
        low, high = high, min(2 * high, most)
    middle = high - 1  # the guess is often right
    while high - low > 1:
        if time.perf_counter() - start > _PATIENCE:
            return Fewest(counts(high), exact=False)
        low, high = (low, middle) if builds(middle) else (middle, high)
        middle = (low + high) // 2
    return Fewest(counts(high), exact=True)


def largest_eccentricity(given: float, attempt: Callable[[float], object]) -> float | None:
    """Find the largest eccentricity for which a pair can be made.

    Parameters
    ----------
    given : float
        The eccentricity that was refused.
    attempt : callable
        Builds the pair with another, or raises `InfeasibleError`.

    Returns
    -------
    float or None
        Rounded down to what builds; 0.1 % beyond it is refused. None if circular wheels are
        refused too, or the time was over.
    """
    start = time.perf_counter()

    def builds(e: float) -> bool:
        try:
            attempt(e)
        except InfeasibleError:
            return False
        return True

    low, high = 0.0, given
    if not builds(low):
        return None
    while high - low > 1e-3 * high:
        if time.perf_counter() - start > _PATIENCE:
            return None
        middle = float(f"{0.5 * (low + high):.6g}")
        low, high = (middle, high) if builds(middle) else (low, middle)
    return low


def advice(error: InfeasibleError, found: Fewest | None, e: float | None) -> InfeasibleError:
    """Return a refusal with what would work.

    Parameters
    ----------
    error : InfeasibleError
        The refusal, remedied by more teeth.
    found : Fewest or None
        From `fewest_teeth`.
    e : float or None
        From `largest_eccentricity`.

    Returns
    -------
    InfeasibleError
        To be raised.
    """
    words, suggested = [], {}
    if found is not None:
        suggested["pair.teeth"] = found.teeth
        text = f"{found.teeth[0]} : {found.teeth[1]}"
        words.append(
            f"the fewest teeth with which the pair can be made are {text}"
            if found.exact
            else f"with {text} teeth the pair can be made (fewer may do)"
        )
    if e is not None:
        suggested["law.eccentricity"] = e
        words.append(f"with these teeth the largest eccentricity is {e:.6g}")
    return InfeasibleError(
        error.what,
        where=error.where,
        value=error.value,
        limit=error.limit,
        unit=error.unit,
        nearest="; ".join([*words, error.nearest]),
        suggested=suggested,
    )
