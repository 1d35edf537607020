"""Changes that may help if a gear pair is refused or has errors: teeth, law, edges."""

from __future__ import annotations

import math
from collections.abc import Iterator
from contextlib import suppress
from dataclasses import replace
from types import MappingProxyType
from typing import TYPE_CHECKING, Any, Final

from gearcam.base.errors import Adjustment, InfeasibleError
from gearcam.base.findings import limit_of
from gearcam.designs.design import value_at
from gearcam.gears.subject import KIND
from gearcam.laws.ratio.base import milder
from gearcam.results.advice import Advice, kerf_paths

if TYPE_CHECKING:
    from gearcam.results.advice import Changes, Remedy, Search

_MOST: Final = 400
"""Largest number of teeth that is tried."""

_LIKELY: Final = 1.5
"""How many times more teeth are tried first if the error does not say."""

_OF_TEETH: Final = frozenset({"contact-ratio", "undercut", "tips-collide"})
"""Findings that more teeth or a smaller swing of the ratio may remove."""

_USUAL: Final = 1.5
"""How many times more teeth are acceptable with the given addendum."""

_TIMES: Final = (1, 2, 4)
"""Multiples of the wheel's teeth that are tried with a larger ring."""

_EDGES: Final = (
    Adjustment(far={"blank.tip_rounding_mm": 0.0}),
    Adjustment(far={"blank.clearance_mm": 0.0}),
)
"""Ways to edges without rounding and clearance."""

_LOW: Final = 0.3
"""Lowest addendum to try, in modules: lower ones do not mesh."""

_FINE: Final = 0.005
"""Tolerance of the largest addendum at the given tooth counts, in modules."""

_STUB: Final = 0.8
"""Addendum tried with more teeth, in modules: that of stub teeth."""

_STEEP: Final = 25.0
"""Pressure angle, deg, also tried if it is larger than the given one: tips are then narrower."""

_FIRST: Final = 4
"""Factor of teeth at which stub teeth are tried first, if more teeth alone are not enough."""


class PairAdvice(Advice):
    """Remedies of pairs: tooth numbers, changes that a refusal names, a milder law."""

    file_demands = MappingProxyType({"dxf": kerf_paths, "cut-svg": kerf_paths})

    def seek(self, search: Search, refusal: InfeasibleError | None) -> None:
        """Guide a `search`: tooth numbers, changes that a `refusal` names, a milder law."""
        factor = refusal.more_teeth if refusal else _LIKELY * bool(search.codes & _OF_TEETH)
        collide = "tips-collide" in search.codes
        if collide:
            search.follow(_lower(search))
        lowered = bool(search.found)
        times = _more_teeth(search, factor) if factor else None
        if collide and not lowered and (times is None or times > _USUAL):
            _shorter(search, times)
            search.found.sort(key=_count)
        search.follow(
            [*(refusal.adjustments if refusal else ()), *_others(search, refusal, factor)]
        )
        if all(key.startswith("law.") for remedy in search.found for key in remedy.changes):
            any(search.along(step) for step in _larger_ring(search))

    def hopeless(self, result: Any) -> bool:
        """Return whether the flanks of a `result` alone exclude a contact ratio of 1."""
        from gearcam.gears.rack_limits import contact_bound

        return contact_bound(*result.pair.toothings) < 1.0

    def moves(self, design: Any, other: Any) -> bool:
        """Return whether the `other` design has another law or mean ratio than the `design`."""
        (a, b), (z1, z2) = design.pair.teeth, other.pair.teeth
        return bool(design.law != other.law or a * z2 != b * z1)


def _count(remedy: Remedy) -> int:
    """Return the sum of the tooth numbers of a remedy."""
    design: Any = remedy.design
    return sum(design.pair.teeth)


def _more_teeth(search: Search, factor: float) -> float | None:
    """Find the fewest teeth in the same ratio, beginning with `factor` times as many.

    Return how many times more they are, None if no number is enough.
    """
    given: tuple[int, int] = search.result.design.pair.teeth
    common = math.gcd(*given)

    def teeth(k: int) -> Changes:
        return {"pair.teeth": [count // common * k for count in given]}

    low, most = common, _MOST * common // max(given)
    # the number that an error names is enough, and may be beyond the largest that is tried
    high = max(low + 1, min(math.ceil(low * factor * (1.0 - 1e-9)), most))
    while high <= most and not search.over() and not search.cures(teeth(high)):
        low, high = high, min(2 * high, most) if high < most else most + 1
    if high > most or search.over():
        return None
    middle = high - 1  # the first number is often right
    while high - low > 1 and not search.over():
        low, high = (low, middle) if search.cures(teeth(middle)) else (middle, high)
        middle = (low + high) // 2
    search.keep(teeth(high), teeth(low))
    module = search.result.design.pair.module
    if module is not None and not search.over():
        small = {"pair.module_mm": float(f"{module * common / high:.6g}")}
        if search.cures({**teeth(high), **small}):
            search.keep({**teeth(high), **small})
    return high / common


def _others(search: Search, refusal: InfeasibleError | None, factor: float) -> Iterator[Adjustment]:
    """Yield adjustments other than more teeth and those that a refusal names."""
    yield from _usual_cutter(search)
    if refusal is None:
        yield from _of_errors(search)
    elif not refusal.adjustments and not factor:
        yield from _other_ratios(search)
        yield from _EDGES
    if factor or search.result.design.pair.type == "internal":
        z1, z2 = search.result.design.pair.teeth
        yield from milder(search.result.design.law, z1 / z2)


def _lower(search: Search) -> Iterator[Adjustment]:
    """Yield the largest addendum with which tips clear each other at the given tooth counts."""
    result: Any = search.result
    limit = limit_of(KIND, "tips-collide", result.design.limits)

    def passes(addendum: float) -> bool:
        try:
            found = search.alone({"rack.addendum": addendum}).subject.tip_pass
        except InfeasibleError:
            return False
        return found is None or found.margin >= limit

    low, high = round(_LOW / _FINE), math.floor(result.pair.rack.addendum / _FINE)
    if low >= high or not passes(_LOW):
        return
    while high - low > 1 and not search.over():
        middle = (low + high) // 2
        low, high = (middle, high) if passes(middle * _FINE) else (low, middle)
    yield Adjustment(near={"rack.addendum": low * _FINE})


def _shorter(search: Search, times: float | None) -> None:
    """Find the fewest stub teeth, also with a larger pressure angle.

    Enough with the given addendum are `times` as many teeth; None if no number is.
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
        low, high = common - bool(angle), round((times or _FIRST) * common)

        def stub(k: int, angle: Changes = angle) -> Changes:
            counts = {"pair.teeth": [count // common * k for count in given]} if k > common else {}
            return {**counts, "rack.addendum": _STUB, **angle}

        if not search.cures(stub(high)):
            continue
        while high - low > 1 and not search.over():
            middle = (low + high) // 2
            low, high = (low, middle) if search.cures(stub(middle)) else (middle, high)
        search.keep(stub(high), stub(low) if low >= common else None)


def _larger_ring(search: Search) -> Iterator[Adjustment]:
    """Yield rings with the next multiple of the wheel's teeth, which have more room."""
    pair = search.result.design.pair
    z1, z2 = pair.teeth
    if pair.type == "internal" and z1 < z2:
        for times in _TIMES:
            yield Adjustment(near={"pair.teeth": [times * z1, (z2 // z1 + 1) * times * z1]})


def _usual_cutter(search: Search) -> Iterator[Adjustment]:
    """Yield the cutter that a ring has by default."""
    result: Any = search.result
    ring = result.design.ring
    if ring.cutter_teeth is None:
        return
    free = replace(result.design, ring=replace(ring, cutter_teeth=None))
    with suppress(InfeasibleError):
        cutter = type(result)(free, result.tolerances).pair.toothings[1].cutter
        if cutter.kc:
            yield Adjustment(near={"ring.cutter_teeth": round(cutter.teeth, 3)})


def _other_ratios(search: Search) -> Iterator[Adjustment]:
    """Yield the nearest tooth numbers with a whole-number ratio."""
    pair = search.result.design.pair
    (z1, z2), internal = pair.teeth, pair.type == "internal"
    yield Adjustment(near={"pair.teeth": [z1, max(1 + internal, round(z2 / z1)) * z1]})
    if not internal:  # a ring has more teeth than its wheel
        yield Adjustment(near={"pair.teeth": [max(1, round(z1 / z2)) * z2, z2]})


def _of_errors(search: Search) -> Iterator[Adjustment]:
    """Yield adjustments for findings of a pair that are errors."""
    addendum = value_at(search.document, "rack.addendum")
    if search.codes & _OF_TEETH and addendum is not None and addendum < 1.0:
        yield Adjustment(far={"rack.addendum": 1.0})
    if search.codes & _OF_TEETH:
        if search.document["pair"]["x"]:
            yield Adjustment(far={"pair.x": 0.0})
        yield from _EDGES
    if "wide-kerf" in search.codes:
        kerfs = [one for one in search.result.checked if one.code == "wide-kerf"]
        widest = min(one.limit for one in kerfs if one.limit is not None)
        yield Adjustment(near={"output.kerf_mm": widest}, far={"output.kerf_mm": 0.0})
