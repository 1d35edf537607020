"""Changes that may help if a gear pair is refused or has errors: teeth, rack, law, edges."""

from __future__ import annotations

import math
from collections.abc import Iterable, Iterator
from contextlib import suppress
from dataclasses import replace
from types import MappingProxyType
from typing import TYPE_CHECKING, Any, Final

import numpy as np

from gearcam.base.adjustments import Adjustment, least
from gearcam.base.errors import InfeasibleError
from gearcam.base.findings import limit_of
from gearcam.designs.design import value_at
from gearcam.gears.spec import BasicRack
from gearcam.gears.subject import KIND
from gearcam.laws.ratio.base import milder
from gearcam.results.advice import Advice, kerf_paths

if TYPE_CHECKING:
    from gearcam.results.advice import Changes, Search

_MOST_TIMES: Final = 3
_MOST_TEETH: Final = 400
"""How many times more teeth are tried, or up to how many."""

_OF_TEETH: Final = frozenset({"contact-ratio", "undercut", "tips-collide"})
"""Findings that other teeth or a smaller swing of the ratio may remove."""

_ANGLES: Final = (20.0, 25.0, 28.0, 30.0)
"""Pressure angles of tools, deg."""

_HEIGHTS: Final = (0.9, 0.8)
_DEPTHS: Final = (1.1, 1.0)
_SHIFTS: Final = (0.2, 0.4)
"""Addenda and dedenda below the usual ones, and profile shifts, in modules."""

_EDGES: Final = (
    Adjustment(far={"blank.tip_rounding_mm": 0.0}),
    Adjustment(far={"blank.clearance_mm": 0.0}),
)
"""Ways to edges without rounding and clearance."""

_LOW: Final = 0.3
"""Lowest addendum to try, in modules: lower ones do not mesh."""

_FINE: Final = 0.005
"""Tolerance of the largest addendum at the given tooth counts, in modules."""

_RINGS: Final = (1, 2, 4)
"""Multiples of the wheel's teeth that are tried with a larger ring."""

_ROUNDING: Final = 1e-9
"""Part of a factor of teeth that is rounding."""


class PairAdvice(Advice):
    """Remedies of pairs: what a refusal names, another rack, more teeth, a milder law."""

    file_demands = MappingProxyType({"dxf": kerf_paths, "cut-svg": kerf_paths})

    def seek(self, search: Search, refusal: InfeasibleError | None) -> None:
        """Guide a `search` for remedies of a `refusal`, the gentlest changes first."""
        factor = refusal.more_teeth if refusal else 0.0
        of_teeth = bool(factor or search.codes & _OF_TEETH)
        search.follow([*(refusal.adjustments if refusal else ()), *_usual_cutter(search)])
        if of_teeth:
            if factor <= _MOST_TIMES:  # no rack cures what needs even more teeth
                search.follow(_racks(search))
            search.follow(_more_teeth(search, factor))
        elif refusal is None:
            search.follow(_narrower(search))
        elif not refusal.adjustments:
            search.follow([*_other_ratios(search), *_EDGES])
        pair = search.result.design.pair
        if of_teeth or pair.type == "internal":
            search.follow(milder(search.result.design.law, pair.teeth[0] / pair.teeth[1]))
        if not (of_teeth or search.found) and _is_narrow(refusal):
            search.follow(_more_teeth(search, 0.0))
        if all(key.startswith("law.") for remedy in search.found for key in remedy.changes):
            any(search.along(step) for step in _larger_ring(search))

    def hopeless(self, result: Any) -> bool:
        """Return whether the flanks of a `result` alone exclude a contact ratio of 1."""
        from gearcam.gears.rack_limits import contact_bound

        return contact_bound(*result.pair.toothings) < 1.0

    def moves(self, changes: Changes, design: Any) -> bool:
        """Return whether a `design` has another law or mean ratio with `changes`."""
        (a, b), (z1, z2) = design.pair.teeth, changes.get("pair.teeth", design.pair.teeth)
        others = any(key.startswith(("law.", "pair.type")) for key in changes)
        return others or bool(a * z2 != b * z1)

    def resized(self, changes: Changes, design: Any) -> bool:
        """Return whether a `design` has another centre distance with `changes`."""
        by_module = design.pair.module is not None and "pair.module_mm" not in changes
        return by_module and "pair.teeth" in changes


def _is_narrow(refusal: InfeasibleError | None) -> bool:
    """Return whether a `refusal` is of a wheel that has too little room in it."""
    changes = [{**one.near, **one.far} for one in refusal.adjustments] if refusal else []
    return any(key.startswith("blank.") for one in changes for key in one)


def _racks(search: Search) -> Iterator[Adjustment]:
    """Yield other teeth, as many as before: edges, addendum, dedendum, angle, shift."""
    rack, given = BasicRack(), search.document["rack"]
    height, depth = given.get("addendum", rack.addendum), given.get("dedendum", rack.dedendum)
    if "tips-collide" in search.codes:
        yield from _lower(search)
    yield from (one for one in _EDGES if np.any(value_at(search.document, *one.far)))
    if height < rack.addendum:
        yield Adjustment(far={"rack.addendum": rack.addendum})
    angle = _angle(search)
    yield _steps("rack.pressure_angle_deg", [one for one in _ANGLES if one > angle])
    yield _steps("rack.pressure_angle_deg", [one for one in _ANGLES[::-1] if one < angle])
    yield _steps("rack.dedendum", [one for one in _DEPTHS if height <= one < depth])
    if not any("rack.addendum" in one.changes for one in search.found):
        yield _steps("rack.addendum", [one for one in _HEIGHTS if one < height])
    if search.document["pair"]["x"]:
        yield Adjustment(far={"pair.x": 0.0})
    else:
        yield _steps("pair.x", _SHIFTS)
        yield _steps("pair.x", [-one for one in _SHIFTS])


def _angle(search: Search) -> float:
    angle: float = search.document["rack"]["pressure_angle_deg"]
    return angle


def _steps(key: str, values: Iterable[float]) -> Adjustment:
    return Adjustment(steps=[{key: value} for value in values])


def _more_teeth(search: Search, factor: float) -> Iterator[Adjustment]:
    """Yield more teeth in the same ratio, also with stub teeth and with a smaller module.

    A refusal says `factor` times as many are needed, 0 if it does not say.
    """
    design = search.result.design
    given: tuple[int, int] = design.pair.teeth
    common, before = math.gcd(*given), len(search.found)

    def teeth(k: int) -> dict[str, list[int]]:
        return {"pair.teeth": [count // common * k for count in given]}

    named = common * factor * (1.0 - _ROUNDING)
    most = max(_MOST_TIMES * common, _MOST_TEETH * common // max(given))
    guess = max(1.0, named - common) / (most - common) if factor else 0.0
    yield Adjustment(far=teeth(most), guess=guess)
    more = search.found[before:]
    if more and design.pair.module is not None:
        counts = more[0].changes["pair.teeth"]
        module = float(f"{design.pair.module * given[0] / counts[0]:.6g}")  # type: ignore[index]
        yield Adjustment(steps=[{"pair.teeth": counts, "pair.module_mm": module}])
    height, stub = search.document["rack"].get("addendum", math.inf), _HEIGHTS[-1]
    if "tips-collide" in search.codes:
        lowered = any("rack.addendum" in one.changes for one in search.found)
        if height > stub and not lowered:
            short = {"rack.addendum": stub}
            yield Adjustment(near=teeth(common + 1) | short, far=teeth(most) | short)
    elif not search.found and factor <= _MOST_TIMES and _angle(search) < _ANGLES[1]:
        steep = {"rack.pressure_angle_deg": _ANGLES[1]}
        yield Adjustment(near=teeth(common + 1) | steep, far=teeth(most) | steep)


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

    top, bottom = math.ceil(result.pair.rack.addendum / _FINE), round(_LOW / _FINE)
    looks = [top - bottom] if top > bottom else []
    found = least(lambda less: passes((top - less) * _FINE), looks, over=search.over)
    if found is not None:
        yield Adjustment(near={"rack.addendum": (top - found[0]) * _FINE})


def _larger_ring(search: Search) -> Iterator[Adjustment]:
    """Yield rings with the next multiple of the wheel's teeth, which have more room."""
    pair = search.result.design.pair
    z1, z2 = pair.teeth
    if pair.type == "internal" and z1 < z2:
        for times in _RINGS:
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


def _narrower(search: Search) -> Iterator[Adjustment]:
    """Yield a narrower kerf where one is too wide."""
    kerfs = [one for one in search.result.checked if one.code == "wide-kerf"]
    widest = min((one.limit for one in kerfs if one.limit is not None), default=None)
    if "wide-kerf" in search.codes:
        yield Adjustment(near={"output.kerf_mm": widest}, far={"output.kerf_mm": 0.0})
