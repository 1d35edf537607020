"""Ways out where tips of a wheel and a ring collide: a shorter addendum, alone or with more teeth.

Tips pass each other the better the shorter they are, and flanks touch the longer the higher they
are: at enough teeth some addendum does both.
"""

from __future__ import annotations

import math
from collections.abc import Iterator
from typing import TYPE_CHECKING, Any, Final

from gearcam.errors import InfeasibleError, Way
from gearcam.findings import limit_of
from gearcam.gears.subject import KIND

if TYPE_CHECKING:
    from gearcam.advice import Changes, Search

_LOW: Final = 0.3
"""Lowest addendum, in modules, that is tried: lower ones do not mesh."""

_FINE: Final = 0.005
"""Step to which the largest one is found at the teeth that are wanted, in modules."""

_STEP: Final = 0.05
"""Step of those that are tried with more teeth, in modules."""

_STEEP: Final = 25.0
"""Pressure angle, deg, that is tried too where it is larger: tips are narrower then."""

_TIMES: Final = 4
"""How many times more teeth are tried with a shorter addendum, if fewer do not do."""


def lower(search: Search) -> Iterator[Way]:
    """Yield the largest addendum with which tips pass each other at the teeth that are wanted."""
    result: Any = search.result
    limit = limit_of(KIND, "tips-collide", result.design.limits)

    def passes(addendum: float) -> bool:
        try:
            found = search.changed({"rack.addendum": addendum}).subject.tip_pass
        except InfeasibleError:
            return False
        return found is None or found.margin >= limit

    low, high = round(_LOW / _FINE), math.floor(result.pair.rack.addendum / _FINE)
    if low >= high or not passes(_LOW):
        return
    while high - low > 1 and not search.over():
        middle = (low + high) // 2
        low, high = (middle, high) if passes(middle * _FINE) else (low, middle)
    yield Way(near={"rack.addendum": low * _FINE})


def shorter(search: Search, times: float | None) -> None:
    """Find the fewest teeth with a shorter addendum, and still fewer with a larger pressure angle.

    Parameters
    ----------
    search : Search
        The search.
    times : float or None
        How many times more teeth do with the addendum that is wanted; None if none do.
    """
    result: Any = search.result
    teeth: tuple[int, int] = result.design.pair.teeth
    common = math.gcd(*teeth)
    sure, high = times is not None, round((times or _TIMES) * common) + (times is None)
    angles: list[Changes] = [{}]
    if math.degrees(result.pair.rack.pressure_angle) < _STEEP:
        angles.append({"rack.pressure_angle_deg": _STEEP})
    for angle in angles:
        low = common - bool(angle)  # no addendum does at the teeth that are wanted
        middle = (low + high) // 2 if sure else high - 1
        best, less = None, None
        while high - low > 1 and not search.over():
            counts = {"pair.teeth": [count // common * middle for count in teeth]}
            tried, does = _meshing(search, {**(counts if middle > common else {}), **angle})
            best, less = (tried, less) if does else (best, tried)
            low, high = (low, middle) if does else (middle, high)
            middle = (low + high) // 2
        if best:
            search.keep(_highest(search, best), less)
            sure = True


def _meshing(search: Search, others: Changes) -> tuple[dict[str, Any], bool]:
    """Look for an addendum that does with `others`; return the last tried, and whether it does."""
    result: Any = search.result
    low, high = round(_LOW / _STEP), math.floor(result.pair.rack.addendum / _STEP) + 1
    tried = {**others}
    while high - low > 1 and not search.over():
        middle = (low + high) // 2
        tried["rack.addendum"] = round(middle * _STEP, 3)
        left = search.left(tried)
        if left is not None and not left:
            return tried, True
        collide = left is not None and "tips-collide" in left
        if collide and left != {"tips-collide"}:
            break  # lower ones touch for less, higher ones collide
        low, high = (low, middle) if collide else (middle, high)
    return tried, False


def _highest(search: Search, best: dict[str, Any]) -> Changes:
    """Raise the addendum of changes that do, as far as they still do."""
    while not search.over():
        higher = {**best, "rack.addendum": round(best["rack.addendum"] + _STEP, 3)}
        if not search.cures(higher):
            break
        best = higher
    return best
