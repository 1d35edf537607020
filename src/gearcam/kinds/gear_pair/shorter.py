"""Remedies for colliding tips of a wheel and a ring: a shorter addendum, alone or with more teeth.

Shorter tips leave more clearance, higher ones a larger contact ratio: with enough teeth some
addendum satisfies both.
"""

from __future__ import annotations

import math
from collections.abc import Iterator
from typing import TYPE_CHECKING, Any, Final

from gearcam.base.errors import InfeasibleError, Way
from gearcam.base.findings import limit_of
from gearcam.gears.subject import KIND

if TYPE_CHECKING:
    from gearcam.results.advice import Changes, Search

_LOW: Final = 0.3
"""Lowest addendum to try, in modules: lower ones do not mesh."""

_FINE: Final = 0.005
"""Tolerance of the largest addendum at the given tooth counts, in modules."""

_STEP: Final = 0.05
"""Step of those to try with more teeth, in modules."""

_STEEP: Final = 25.0
"""Pressure angle, deg, also tried if it is larger than the given one: tips are then narrower."""

_TIMES: Final = 4
"""Largest factor of teeth to try with a shorter addendum."""


def lower(search: Search) -> Iterator[Way]:
    """Yield the largest addendum with which tips clear each other at the given tooth counts."""
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
    """Yield the fewest teeth with a shorter addendum, and still fewer with a larger pressure angle.

    Parameters
    ----------
    search : Search
        The search.
    times : float or None
        Factor of teeth that suffices with the given addendum; None if none does.
    """
    result: Any = search.result
    teeth: tuple[int, int] = result.design.pair.teeth
    common = math.gcd(*teeth)
    sure, high = times is not None, round((times or _TIMES) * common) + (times is None)
    angles: list[Changes] = [{}]
    if math.degrees(result.pair.rack.pressure_angle) < _STEEP:
        angles.append({"rack.pressure_angle_deg": _STEEP})
    for angle in angles:
        low = common - bool(angle)  # no addendum suffices at the given tooth counts
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
    """Return the last addendum tried with `others`, and whether it suffices."""
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
            break  # lower ones have less contact, higher ones collide
        low, high = (low, middle) if collide else (middle, high)
    return tried, False


def _highest(search: Search, best: dict[str, Any]) -> Changes:
    """Return changes that suffice with their addendum raised as far as possible."""
    while not search.over():
        higher = {**best, "rack.addendum": round(best["rack.addendum"] + _STEP, 3)}
        if not search.cures(higher):
            break
        best = higher
    return best
