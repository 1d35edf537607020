"""Adjustments: changes of a design that may cure what is wrong, and the least that does.

An *adjustment* goes from the values that a design has, or from the smallest change that may help,
to the largest. On its way lie *places*, in their order. Their numbers are short decimals, but
where they have to fit together, and those of sizes are the same wherever a design starts: so what
is printed is what was built, and it does not depend on the start. `least` finds the first place
that cures; whether one does, a function says that builds it.
"""

from __future__ import annotations

import json
import math
import re
from bisect import bisect_left, bisect_right
from collections.abc import Callable, Iterable, Mapping, Sequence
from dataclasses import dataclass, field, replace
from typing import Any, Final

from gearcam.base.numerals import DIGITS, formatted

Changes = Mapping[str, Any]
"""Values by dotted keys of a design file, in its units."""

INSIDE: Final = 1e-3
"""Part of the way by which a limit is kept, and for which digits are left out."""

_FEWEST: Final = 100
"""Least number of even steps of a way."""

_TOGETHER: Final = 128
"""Number of places of a way of numbers that have to fit together."""

_HALVES: Final = 6
"""Places looked at from the end on, each half as far as the one before."""

_APART: Final = ("1.0000", "2.0000", "5.0000")
"""First digits of sizes that are looked at in turn."""

_NEXT: Final = 25
"""The size that is looked at before those: a fifth larger or smaller."""

_PLAIN: Final = 6
_NOISE: Final = 1e-9
"""Digits of steps after which only rounding is left, and part of a step that is rounding."""


@dataclass(frozen=True, kw_only=True)
class Adjustment:
    """A change of a design that may remove an error; building it shows whether it does.

    Parameters
    ----------
    near : mapping of str to value
        The smallest change that may help: values by dotted keys of the design file, in its units;
        empty: the values that the design has.
    far : mapping of str to value
        The largest change, with the same keys; empty if `near` is the only one.
    size : bool
        Whether the first value is a size, of which larger or smaller ones are looked at in turn:
        a fifth more, then 1, 2, 5, 10 and so on. Else the far end is looked at first.
    guess : float
        How far on the way a formula says the least change is, from 0 to 1: looked at first; 0
        without a formula.
    steps : sequence of mapping of str to value
        All changes that may help, the least first, in place of those between two ends.
    """

    near: Changes = field(default_factory=dict)
    far: Changes = field(default_factory=dict)
    size: bool = False
    guess: float = 0.0
    steps: Sequence[Changes] = ()


class Scale:
    """Positive decimals of few digits, by their index.

    Parameters
    ----------
    digits : int
        All decimals with so many digits; 0: of those with three as many as are 0.5 to 1 % apart.
    """

    def __init__(self, digits: int = 0) -> None:
        self._digits = digits or 3
        self._unit = 10 ** (self._digits - 1)
        spread = [*range(100, 200), *range(200, 500, 2), *range(500, 1000, 5)]
        self._decade = range(self._unit, 10 * self._unit) if digits else spread

    def value(self, index: int) -> float:
        """Return the decimal at an index."""
        power, place = divmod(index, len(self._decade))
        return float(f"{self._decade[place]}e{power - self._digits + 1}")

    def index(self, value: float) -> int:
        """Return the index of the largest decimal that is not above a positive `value`."""
        power = math.floor(math.log10(value) + _NOISE)
        place = value / 10.0**power * self._unit * (1.0 + _NOISE)
        return power * len(self._decade) + bisect_right(self._decade, place) - 1


def least(
    cures: Callable[[int], bool],
    looks: Iterable[int],
    *,
    guessed: bool = False,
    over: Callable[[], bool] = lambda: False,
) -> tuple[int, int] | None:
    """Return the least place that cures, and the largest before it that does not.

    Parameters
    ----------
    cures : callable
        Whether a place, 1 or more, cures; place 0 does not.
    looks : iterable of int
        Where to look first, until one cures.
    guessed : bool
        Whether the first look is about the least: others are then sought next to it.
    over : callable
        Whether the search must end.

    Returns
    -------
    (int, int) or None
        None where no look cures. The least only where all places beyond it cure too, and where the
        search has not ended early.
    """
    low, step = 0, int(guessed)
    failed: list[int] = []
    for high in looks:
        if over():
            return None
        if cures(high):
            break
        failed.append(high)
        step = 0
    else:
        return None
    low = max((place for place in failed if place < high), default=0)
    while high - low > 1 and not over():
        middle = max(high - step, low + 1) if step else (low + high) // 2
        if cures(middle):
            high, step = middle, 2 * step
        else:
            low, step = middle, 0
    return high, low


@dataclass(frozen=True, eq=False)
class Way:
    """The places of an adjustment.

    Parameters
    ----------
    near, far : mapping of str to value
        Values at its ends, with the same keys; one number of `far` may stand for a list.
    shares : sequence of float
        How far each place is on the way, from above 0 to 1.
    looks : sequence of int
        Places to look at first, counted from 1.
    size : bool
        See `Adjustment`.
    exact : bool
        Whether the numbers change in proportion, and are not rounded each by itself.
    """

    near: Changes
    far: Changes
    shares: Sequence[float]
    looks: Sequence[int]
    size: bool = False
    exact: bool = False

    def at(self, place: int) -> Changes:
        """Return the values at a place, 0 at the start."""
        share = self.shares[place - 1] if place else 0.0
        if self.exact:
            ends = ((key, one, self.far.get(key, one)) for key, one in self.near.items())
            return {key: tidy(_part_way(start, end, share)) for key, start, end in ends}
        return between(self.near, self.far, share, size=self.size)

    @property
    def first(self) -> Changes:
        """The smallest change: just beyond the start, of whole numbers the start itself."""
        return tidy(self.near) if self.exact else between(self.near, self.far, INSIDE)

    def from_guess(self, guess: float) -> list[int]:
        """Return the places to look at from a guess on (see `Adjustment`)."""
        count = len(self.shares)
        first = min(bisect_left(self.shares, guess - _NOISE) + 1, count)
        return [first, *(first + one for one in _doubled(count - first))]


def way(near: Changes, far: Changes, *, size: bool = False) -> Way:
    """Return the way between two ends.

    Parameters
    ----------
    near, far : mapping of str to value
        See `Way`.
    size : bool
        See `Adjustment`.

    Returns
    -------
    Way
        Without places where the ends are the same.
    """
    changing = [
        [pair for pair in _numbers(start, far.get(key, start)) if pair[0] != pair[1]]
        for key, start in near.items()
    ]
    first = next((pairs for pairs in changing if pairs), [])
    if not first:
        return Way(near, far, (), ())
    start, end = first[0]
    pairs = [pair for one in changing for pair in one]
    if all(isinstance(one, int) for pair in pairs for one in pair):
        count = math.gcd(*(b - a for a, b in pairs))
        shares = [k / count for k in range(1, count + 1)]
        return Way(near, far, shares, _doubled(count), exact=True)
    if len({*first}) > 1:
        shares = [k / _TOGETHER for k in range(1, _TOGETHER + 1)]
    elif size and start * end > 0.0:
        # what shrinks in proportion, such as lifts that return to 0, stays so
        alike = len(pairs) > 1 and all(math.isclose(a * end, b * start) for a, b in pairs)
        low, high = (1.0, end / start) if alike else (start, end)
        sizes = _sizes(low, high)
        apart = [k for k, one in enumerate(sizes, 1) if f"{abs(one):e}".startswith(_APART)]
        looks = sorted({min(_NEXT, len(sizes)), *apart, len(sizes)}) if sizes else []
        shares = [(one - low) / (high - low) for one in sizes]
        return Way(near, far, shares, looks, size=True, exact=alike)
    else:
        shares = [(one - start) / (end - start) for one in _even(start, end)]
    return Way(near, far, shares, [len(shares) >> k for k in range(_HALVES) if len(shares) >> k])


def between(near: Changes, far: Changes, share: float, *, size: bool = False) -> Changes:
    """Return values on the way between two ends, rounded towards the far one.

    Parameters
    ----------
    near, far : mapping of str to value
        See `Way`.
    share : float
        How far they are on the way, from 0 to 1.
    size : bool
        Whether they are rounded to four digits, or to a thousandth of the way or less.
    """
    return {key: _mixed(value, far.get(key, value), share, size) for key, value in near.items()}


def _sizes(start: float, end: float) -> list[float]:
    """Return the sizes from one of a sign to another, without the first."""
    scale, (low, high) = Scale(), sorted((abs(start), abs(end)))
    sizes = [scale.value(k) for k in range(scale.index(low), scale.index(high) + 1)]
    inside = (one for one in sizes if low <= one <= high and one != abs(start))
    found = [math.copysign(one, start) for one in inside]
    return found if abs(start) < abs(end) else found[::-1]


def _even(start: float, end: float) -> list[float]:
    """Return multiples of 1, 2 or 5 times a power of ten between two numbers, and the end."""
    widest = abs(end - start) / _FEWEST
    power = 10.0 ** math.floor(math.log10(widest) + _NOISE)
    step = max((k * power for k in (2, 5) if k * power <= widest * (1.0 + _NOISE)), default=power)
    low, high = sorted((start / step, end / step))
    numbers = range(math.floor(low + _NOISE) + 1, math.ceil(high - _NOISE))
    values = [float(f"{number * step:.10g}") for number in numbers]
    return [*(values if start < end else values[::-1]), end]


def _doubled(count: int) -> list[int]:
    """Return 1, 2, 4 and so on below a count, and the count."""
    return [*(2**k for k in range(count.bit_length()) if 2**k < count), count] if count else []


def _numbers(near: Any, far: Any) -> list[tuple[Any, Any]]:
    """Return the numbers at both ends of a value."""
    if isinstance(near, list):
        return [
            pair for a, b in zip(near, _ends(near, far), strict=True) for pair in _numbers(a, b)
        ]
    plain = all(isinstance(one, int | float) and not isinstance(one, bool) for one in (near, far))
    return [(near, far)] if plain else []


def text_of(changes: Changes) -> str:
    """Return changes as in a design file: ``pair.x = 0.2 and pair.teeth = [52, 52]``."""
    return " and ".join(f"{key} = {_value(value)}" for key, value in changes.items())


def joined(changes: Changes, other: Adjustment) -> Adjustment:
    """Return the `other` adjustment with `changes` made too."""
    return replace(
        other,
        near={**changes, **other.near},
        far={**changes, **other.far} if other.far else {},
        steps=[{**changes, **step} for step in other.steps],
    )


def for_both(one: Adjustment) -> Adjustment | None:
    """Return an adjustment of one wheel's blank as that of both; None if it is none."""
    keys = [*one.near, *one.far]
    if not keys or not all(re.fullmatch(r"blank\.\w+\[\d\]", key) for key in keys):
        return None
    near, far = ({key[:-3]: end for key, end in ends.items()} for ends in (one.near, one.far))
    return Adjustment(near=near, far=far)


def together(changes: Changes, more: Changes) -> Changes:
    """Return `changes` with `more` of them; a list that these change as a whole has its items."""
    kept = {key: one for key, one in changes.items() if key.partition("[")[0] not in more}
    return {**kept, **more}


def ahead(changes: Changes, near: Changes, far: Changes) -> bool:
    """Return whether `changes` of single numbers go from `near` towards `far`."""
    if changes.keys() != far.keys():
        return False
    ends = ((value, near[key], far[key]) for key, value in changes.items())
    return all(isinstance(a, float) and (a - b) * (c - b) > 0.0 for a, b, c in ends)


def tidy(value: Any) -> Any:
    """Return a `value` with its numbers in ten digits."""
    if isinstance(value, Mapping):
        return {key: tidy(item) for key, item in value.items()}
    if isinstance(value, list):
        return [tidy(item) for item in value]
    return float(f"{value:.10g}") if isinstance(value, float) else value


def _value(value: object) -> str:
    if isinstance(value, list):
        return f"[{', '.join(map(_value, value))}]"
    if isinstance(value, float):
        return formatted(value, 10)
    return json.dumps(value)


def _mixed(near: Any, far: Any, share: float, size: bool) -> Any:
    # different numbers have to fit together, and are not rounded each by itself
    if len({*_numbers(near, far)}) > 1:
        return tidy(_part_way(near, far, share))
    if isinstance(near, list):
        return [_mixed(a, b, share, size) for a, b in zip(near, _ends(near, far), strict=True)]
    mixed = _part_way(near, far, share)
    if not isinstance(mixed, float) or near == far or share == 1.0:
        return tidy(mixed)
    finest = abs(mixed) * 10.0 ** (1 - DIGITS) if size else abs(INSIDE * (far - near))
    step = 10.0 ** math.floor(math.log10(finest) + _NOISE)
    number = round(mixed / step, _PLAIN)
    return tidy(step * (math.ceil if far > near else math.floor)(number))


def _part_way(near: Any, far: Any, share: float) -> Any:
    if isinstance(near, list):
        return [_part_way(a, b, share) for a, b in zip(near, _ends(near, far), strict=True)]
    if not _numbers(near, far):
        return near
    mixed = near + share * (far - near)
    return round(mixed) if isinstance(near, int) and isinstance(far, int) else float(mixed)


def _ends(near: list[Any], far: Any) -> list[Any]:
    """Return the far end of each item of a list."""
    return far if isinstance(far, list) else [far] * len(near)
