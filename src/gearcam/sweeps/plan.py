"""Which variants a sweep has: all combinations of values, or samples.

Samples are drawn from a generator with a seed: random ones, or a Latin hypercube, of which each
axis has one sample in each of n equal parts of its range. The same seed gives the same variants.
"""

from __future__ import annotations

import hashlib
import json
import math
from collections.abc import Mapping, Sequence
from dataclasses import dataclass, replace
from functools import cached_property
from typing import Any, Final, Literal

import numpy as np

from gearcam.base.display import ShortRepr
from gearcam.base.errors import DesignError, Problem
from gearcam.base.inches import key_mm
from gearcam.base.two_names import key_of
from gearcam.designs.design import Design, document_of, own_document, value_at
from gearcam.designs.kind import KINDS
from gearcam.numeric.arrays import Array
from gearcam.sweeps.axes import Varied

MANY: Final = 1_000_000
"""Number of variants above which a sweep has to be confirmed."""

_LOOKS: Final = (0.0, 0.25, 0.5, 0.75, 1.0 - 1e-9)
"""Shares of a range at which it is tried whether a value is allowed."""

_ROUNDING: Final = 1e-9
"""By how much an end of a range may miss a whole number."""

Sampling = Literal["grid", "random", "latin"]


@dataclass(frozen=True, eq=False, kw_only=True)
class Plan(ShortRepr):
    """The variants of a sweep.

    Parameters
    ----------
    base : Design
        The design.
    axes : sequence of Varied
        What is given to its keys; at least one.
    sampling : {"grid", "random", "latin"}
        All combinations, or samples.
    samples : int
        Number of samples.
    seed : int
        Of the generator.

    Raises
    ------
    DesignError
        If an axis of a grid has no step, or no value of a key is allowed.
    """

    base: Design
    axes: Sequence[Varied]
    sampling: Sampling = "grid"
    samples: int = 0
    seed: int = 1

    def __post_init__(self) -> None:
        # a fact that repeats a key stands for it
        axes = tuple(replace(one, key=key_of(self.repeated, one.key)) for one in self.axes)
        object.__setattr__(self, "axes", axes)
        problems = [
            Problem(
                f"{axis.text} has no step",
                key=axis.key,
                allowed="from:to:step, or samples: random or latin (--random N, --latin N)",
            )
            for axis in self.axes
            if self.sampling == "grid" and axis.sampled
        ]
        if problems:
            raise DesignError(problems)
        for axis in self.axes:
            self._demand_whole(axis)
        self._demand_keys()

    @property
    def repeated(self) -> Mapping[str, str]:
        """Keys of the design that facts repeat, by these facts."""
        return KINDS[self.base.kind].repeated

    @property
    def count(self) -> int:
        """Number of variants."""
        if self.sampling == "grid":
            return math.prod(len(axis.values) for axis in self.axes)
        return self.samples

    def values(self, number: int) -> dict[str, Any]:
        """Return the values of a variant by keys."""
        if self.sampling == "grid":
            values = {}
            for axis in reversed(self.axes):  # the last one changes fastest
                number, place = divmod(number, len(axis.values))
                values[axis.key] = axis.values[place]
            return {axis.key: values[axis.key] for axis in self.axes}
        return self.at(self._shares[number])

    def at(self, point: Array) -> dict[str, Any]:
        """Return the values at a point (axes,) of the unit cube, by keys."""
        shares = zip(self.axes, point.tolist(), strict=True)
        return {axis.key: self._value(axis, u) for axis, u in shares}

    def _value(self, axis: Varied, u: float) -> Any:
        """Return the value at a share of an axis, whole for keys of whole numbers."""
        value = axis.at(u)
        if axis.key not in self._wholes:
            return value
        least, largest = self._wholes[axis.key]
        return min(max(round(value), least), largest)

    def _demand_whole(self, axis: Varied) -> None:
        """Refuse a range of whole numbers without one."""
        least, largest = self._wholes.get(axis.key, (0, 0))
        if least > largest:
            message = f"there is no whole number in {axis.text}"
            raise DesignError.of(message, key=axis.key, allowed="a wider range")

    def _demand_keys(self) -> None:
        """Refuse keys of which no value is allowed: they do not exist, or their values are wrong.

        Values that are allowed together are enough, as one may need another: a centre distance
        instead of a module. Otherwise some value of each key has to be allowed alone.
        """
        spelt: dict[str, str] = {}
        for axis in self.axes:
            other = spelt.setdefault(key_mm(axis.key), axis.key)
            if other != axis.key:
                message = f"is given beside {other}"
                raise DesignError.of(message, key=axis.key, allowed="one of them")
        together = self._refusal(self.axes)
        if together is not None and any(self._refusal([axis]) for axis in self.axes):
            raise together

    def _refusal(self, axes: Sequence[Varied]) -> DesignError | None:
        """Return why the first values of some axes are refused; None if others are allowed."""
        first: DesignError | None = None
        for u in _LOOKS:
            try:
                self.base.with_({axis.key: self._value(axis, u) for axis in axes})
            except DesignError as error:
                first = first or error
            else:
                return None
        return first

    @cached_property
    def _wholes(self) -> dict[str, tuple[int, int]]:
        """The least and the largest value of ranges of whole numbers by their keys."""
        document = own_document(self.base)
        return {
            axis.key: (math.ceil(axis.at(0.0) - _ROUNDING), math.floor(axis.at(1.0) + _ROUNDING))
            for axis in self.axes
            if axis.sampled and type(value_at(document, axis.key)) is int
        }

    @cached_property
    def _shares(self) -> Array:
        if self.sampling == "latin":
            return latin_hypercube(self.samples, len(self.axes), self.seed)
        return np.random.default_rng(self.seed).random((self.samples, len(self.axes)))

    @property
    def head(self) -> dict[str, Any]:
        """The first line of its log."""
        return {
            "sweep": self.mark,
            "file": self.base.source,
            "variants": self.count,
            "varied": [f"{axis.key}={axis.text}" for axis in self.axes],
        }

    @cached_property
    def mark(self) -> str:
        """What tells this sweep from others: a hash of design and variants."""
        content = {
            "design": document_of(self.base),
            "axes": [(axis.key, axis.whole or axis.text) for axis in self.axes],
            "sampling": (self.sampling, self.samples, self.seed),
        }
        text = json.dumps(content, sort_keys=True, default=_told)
        return hashlib.sha256(text.encode()).hexdigest()[:16]


def _told(function: Any) -> list[str]:
    """Return what tells a Python function of a design from others: its name and what it does."""
    code = getattr(function, "__code__", None)
    name = [str(getattr(function, part, "")) for part in ("__module__", "__qualname__")]
    if code is None:
        return name
    numbers = [repr(one) for one in code.co_consts if isinstance(one, int | float | str)]
    return [*name, code.co_code.hex(), *code.co_names, *numbers]


def latin_hypercube(count: int, axes: int, seed: int) -> Array:
    """Return points (count, axes) of the unit cube: one in each of equal parts of each axis.

    Parameters
    ----------
    count : int
        Number of points.
    axes : int
        Number of axes.
    seed : int
        Of the generator.
    """
    random = np.random.default_rng(seed)
    places = np.array([random.permutation(count) for _ in range(axes)]).T
    return (places + random.random(places.shape)) / count


def flattened(table: Mapping[str, Any]) -> dict[str, Any]:
    """Return a table with dotted keys instead of tables in tables."""
    flat: dict[str, Any] = {}
    for key, value in table.items():
        if isinstance(value, Mapping):
            flat |= {f"{key}.{inner}": one for inner, one in flattened(value).items()}
        else:
            flat[key] = value
    return flat
