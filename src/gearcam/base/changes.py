"""Changes of a design between two ends, with as few digits as they need.

A change is a mapping of values by dotted keys of a design file. What lies between two ends goes in
equal steps (`between`) or, for sizes, through powers of two (`octaves`, `sized`).
"""

from __future__ import annotations

import json
import math
import re
from collections.abc import Iterator, Mapping
from typing import Any, Final

from gearcam.base.errors import Adjustment
from gearcam.base.numerals import formatted, shortened

Changes = Mapping[str, Any]

CLOSE: Final = 0.01
"""Part of a value by which a remedy may be more than the least."""

INSIDE: Final = 1e-3
"""Part of the way by which a limit is kept, and for which digits are left out."""

_GRAIN: Final = 1e-9
"""Part of an octave within which a size is a power of two."""


def text_of(changes: Changes) -> str:
    """Return changes as in a design file: ``pair.x = 0.2 and pair.teeth = [52, 52]``."""
    return " and ".join(f"{key} = {_value(value)}" for key, value in changes.items())


def joined(changes: Changes, way: Adjustment) -> Adjustment:
    """Return a `way` that makes other `changes` too."""
    return Adjustment(
        near={**changes, **way.near} if way.near else {},
        far={**changes, **way.far} if way.far else {},
    )


def together(changes: Changes, more: Changes) -> Changes:
    """Return `changes` with `more` of them; a list that these change as a whole has its items."""
    kept = {key: one for key, one in changes.items() if key.partition("[")[0] not in more}
    return {**kept, **more}


def for_both(way: Adjustment) -> Adjustment | None:
    """Return a `way` of one wheel's blank as one of both; None if it is none."""
    keys = [*way.near, *way.far]
    if not keys or not all(re.fullmatch(r"blank\.\w+\[\d\]", key) for key in keys):
        return None
    near, far = ({key[:-3]: end for key, end in ends.items()} for ends in (way.near, way.far))
    return Adjustment(near=near, far=far)


def ahead(changes: Changes, near: Changes, far: Changes) -> bool:
    """Return whether `changes` of single numbers go from `near` towards `far`."""
    if changes.keys() != far.keys():
        return False
    ends = ((value, near[key], far[key]) for key, value in changes.items())
    return all(isinstance(a, float) and (a - b) * (c - b) > 0.0 for a, b, c in ends)


def alike(some: Changes, others: Changes) -> bool:
    """Return whether the numbers of `some` changes and `others` are nearly the same."""
    pairs = zip(_items(some), _items(others), strict=True)
    return all(abs(a - b) <= CLOSE * abs(a) for a, b in pairs if isinstance(a, float))


def between(near: Changes, far: Changes, share: float) -> Changes:
    """Return values at a `share` of the way from `near` to `far`, rounded towards `far`."""
    return {key: _mixed(value, far.get(key, value), share) for key, value in near.items()}


def octaves(near: Changes, far: Changes) -> Iterator[float]:
    """Yield sizes from the first value of `near` to that of `far`: powers of two, and the last."""
    size, end = (abs(next(iter(ends.values()))) for ends in (near, far))
    side = 1.0 if end > size else -1.0
    while size != end:
        power = side * (math.floor(side * math.log2(size) + _GRAIN) + 1.0)
        size = min(2.0**power, end) if side > 0.0 else max(2.0**power, end)
        yield size


def sized(near: Changes, far: Changes, size: float) -> Changes:
    """Return values between `near` and `far` of which the first has a `size`; in four digits."""
    start, end = (abs(next(iter(ends.values()))) for ends in (near, far))
    share, side = (size - start) / (end - start), end - start
    values = {key: near[key] + share * (far[key] - near[key]) for key in near}
    return {key: shortened(value, side) for key, value in values.items()}


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


def _items(changes: Mapping[str, Any]) -> list[Any]:
    return [
        one for value in changes.values() for one in (value if isinstance(value, list) else [value])
    ]


def _mixed(near: Any, far: Any, share: float) -> Any:
    if isinstance(near, list):
        ends = far if isinstance(far, list) else [far] * len(near)
        # numbers that close together are not rounded each by itself
        alone = sum(not isinstance(one, str) for one in near) == 1
        part = _mixed if alone else _part_way
        return [part(a, b, share) for a, b in zip(near, ends, strict=True)]
    mixed = _part_way(near, far, share)
    if isinstance(far, bool | str) or not isinstance(mixed, float) or near == far or share == 1.0:
        return mixed
    step = 10.0 ** math.floor(math.log10(abs(INSIDE * (far - near))))
    return tidy(step * (math.ceil if far > near else math.floor)(mixed / step))


def _part_way(near: Any, far: Any, share: float) -> Any:
    if isinstance(near, bool | str) or isinstance(far, bool | str):
        return near
    return tidy(float(near + share * (far - near)))
