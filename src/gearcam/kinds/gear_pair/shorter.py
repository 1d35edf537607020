"""Remedies for colliding tips of a wheel and a ring: shorter teeth, alone or with more of them."""

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

_STUB: Final = 0.8
"""Addendum tried with more teeth, in modules: that of stub teeth."""

_STEEP: Final = 25.0
"""Pressure angle, deg, also tried if it is larger than the given one: tips are then narrower."""

_TIMES: Final = 4
"""Factor of teeth at which stub teeth are tried first, if more teeth alone are not enough."""


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
    """Find the fewest stub teeth, also with a larger pressure angle.

    Parameters
    ----------
    search : Search
        The search.
    times : float or None
        Factor of teeth that suffices with the given addendum; None if none does.
    """
    result: Any = search.result
    given: tuple[int, int] = result.design.pair.teeth
    rack, common = result.pair.rack, math.gcd(*given)
    if rack.addendum <= _STUB:
        return
    angles: list[Changes] = [{}]
    if math.degrees(rack.pressure_angle) < _STEEP:
        angles.append({"rack.pressure_angle_deg": _STEEP})
    for angle in angles:
        # without another angle no addendum suffices at the given tooth counts
        low, high = common - bool(angle), round((times or _TIMES) * common)

        def stub(k: int, angle: Changes = angle) -> Changes:
            counts = {"pair.teeth": [count // common * k for count in given]} if k > common else {}
            return {**counts, "rack.addendum": _STUB, **angle}

        if not search.cures(stub(high)):
            continue
        while high - low > 1 and not search.over():
            middle = (low + high) // 2
            low, high = (low, middle) if search.cures(stub(middle)) else (middle, high)
        search.keep(stub(high), stub(low) if low >= common else None)
