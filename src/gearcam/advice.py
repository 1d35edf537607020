"""Remedies: changes of a design with which it was built, and nothing was refused or an error.

What a refusal or a finding suggests is not told before it has been followed: each change is made
in the design's own keys, the design is built through the same steps, wheels, checks and parts, and
the change is kept if neither it nor a file that it asks for is refused, what was an error is gone,
and no other error has come.
"""

from __future__ import annotations

import json
import math
import re
import time
from collections.abc import Iterable, Mapping
from dataclasses import dataclass, field
from functools import cached_property
from typing import TYPE_CHECKING, Any, Final

from gearcam.designs.design import Design, document_of, value_at
from gearcam.designs.kind import KINDS
from gearcam.display import Brief
from gearcam.errors import DesignError, InfeasibleError, Way
from gearcam.numerals import shown

if TYPE_CHECKING:
    from gearcam.findings import Finding
    from gearcam.result import Result

Changes = Mapping[str, object]

PATIENCE: Final = 6.0
"""Seconds after which a search is given up, on a usual machine."""

_PACE: Final = 10.0
"""Designs that a usual machine builds in a second, about. A search counts what it builds, not the
time, so that its answers are the same everywhere."""

_SLACK: Final = 10.0
"""How many times longer than on a usual machine a search may take: some wheels take long."""

_STEP: Final = 1.0 / 40.0
"""Part of a way that is one step of the search."""

_CLOSE: Final = 0.01
"""Part of a value by which a remedy may be more than what would do."""

_INSIDE: Final = 1e-3
"""Part of the way by which a limit is kept, and for which digits are left out."""


@dataclass(frozen=True, kw_only=True)
class Remedy(Brief):
    """A change with which a design was built, free of errors.

    Parameters
    ----------
    changes : mapping of str to value
        Values by dotted keys of the design file, in its units.
    less : mapping of str to value
        The next smaller change, with which it was not; empty where none was tried.
    design : Design
        The changed design.
    """

    changes: Changes
    less: Changes = field(default_factory=dict)
    design: Design

    @property
    def text(self) -> str:
        """The changes as a design file holds them: ``pair.x = 0.2 and pair.teeth = [52, 52]``."""
        return _text(self.changes)

    @property
    def next_less(self) -> str:
        """The next smaller change in the same way; nothing where none was tried."""
        return _text(self.less)


@dataclass(frozen=True, kw_only=True)
class Remedies(Brief):
    """What a search for remedies found.

    Parameters
    ----------
    found : tuple of Remedy
        Each another way out.
    tried : tuple of str
        Keys that were changed in the search.
    gave_up : bool
        Whether it was ended before all ways were tried to their end.
    builds : int
        How many designs were tried.
    """

    found: tuple[Remedy, ...] = ()
    tried: tuple[str, ...] = ()
    gave_up: bool = False
    builds: int = 0


def remedies(
    result: Result, refusal: InfeasibleError | None = None, *, patience: float = PATIENCE
) -> Remedies:
    """Search for changes that make a design buildable and free of errors.

    Parameters
    ----------
    result : Result
        The result of the design.
    refusal : InfeasibleError, optional
        How it, or one of its files, was refused; where left out its parts are built, and no file.
    patience : float, s
        Time after which no other build is begun on a usual machine: as many are counted.

    Returns
    -------
    Remedies
        Empty where the design is not refused and has no error; without a `refusal` searched once.
    """
    if refusal is not None:
        return _sought(result, refusal, patience)
    if patience not in result.sought:
        result.sought[patience] = _sought(result, None, patience)
    return result.sought[patience]


def _sought(result: Result, refusal: InfeasibleError | None, patience: float) -> Remedies:
    """Return what a search finds (see `remedies`)."""
    errors: list[Finding] = []
    if refusal is None:
        try:
            errors = [finding for finding in result.findings if finding.severity == "error"]
        except InfeasibleError as error:
            refusal = error
    elif not refusal.ways and not refusal.more_teeth and _builds(result):
        return Remedies()  # a study was refused, not the design
    if refusal is None and not errors:
        return Remedies()
    search = Search(result, refusal, frozenset(error.code for error in errors), patience)
    search.advice.seek(search, refusal)
    return Remedies(
        found=tuple(search.found),
        tried=tuple(search.tried),
        gave_up=search.gave_up,
        builds=search.builds,
    )


def _text(changes: Changes) -> str:
    return " and ".join(f"{key} = {_value(value)}" for key, value in changes.items())


def _value(value: object) -> str:
    if isinstance(value, list):
        return f"[{', '.join(map(_value, value))}]"
    if isinstance(value, float):
        return shown(value, 10)
    return json.dumps(value)


def kerf_paths(result: Any) -> object:
    """Return what paths with a kerf are made from, or raise what refuses them.

    Parameters
    ----------
    result : Result
        Of a design whose parts may be cut.
    """
    return result.design.output.kerf and result.to_cut


def demand_files(result: Result) -> None:
    """Raise what refuses files that a design asks for, where its parts can be made.

    Parameters
    ----------
    result : Result
        Of the design.

    Raises
    ------
    InfeasibleError
        If one of the files cannot be made.
    """
    demands = KINDS[result.design.kind].room("advice").FILE_DEMANDS
    for kind in result.design.output.files:
        if kind in demands:
            demands[kind](result)


def _builds(result: Result) -> bool:
    """Whether the design is not refused when it is built."""
    try:
        _ = result.findings
    except InfeasibleError:
        return False
    return True


class Search:
    """A search within a number of builds: what was tried, and what was found.

    Parameters
    ----------
    result : Result
        Of the design that is to be changed.
    refusal : InfeasibleError or None
        How it was refused.
    codes : frozenset of str
        Findings that are to go.
    patience : float, s
        Time after which no other build is begun on a usual machine.
    """

    def __init__(
        self,
        result: Result,
        refusal: InfeasibleError | None,
        codes: frozenset[str],
        patience: float,
    ) -> None:
        self.result, self.refusal, self.codes = result, refusal, codes
        self.advice = KINDS[result.design.kind].room("advice")
        self.most, self.builds = round(_PACE * patience), 0
        self.until = time.perf_counter() + _SLACK * patience
        self.found: list[Remedy] = []
        self.tried: dict[str, None] = {}
        self.gave_up = False
        self.second: InfeasibleError | None = None

    @cached_property
    def document(self) -> dict[str, Any]:
        """What a file of the design would hold."""
        return document_of(self.result.design)

    def over(self) -> bool:
        """Whether enough was built; then a search is given up."""
        over = self.builds >= self.most or time.perf_counter() > self.until
        self.gave_up |= over
        return over

    def changed(self, changes: Changes) -> Any:
        """Return the result of the changed design; counted."""
        self.builds += 1
        design = self.result.design.with_(changes)
        self.tried |= dict.fromkeys(changes)
        return type(self.result)(design, self.result.tolerances)

    def left(self, changes: Changes) -> frozenset[str] | None:
        """Return what is left of the errors of the changed design, others too; None if refused.

        What it is refused for is kept, if that is another thing than the design was.
        """
        self.second = None
        try:
            other = self.changed(changes)
            if self.advice.hopeless(other):
                return None
            findings = other.findings
            demand_files(other)
        except InfeasibleError as error:
            if self.refusal is None or error.what != self.refusal.what:
                self.second = error
            return None
        except DesignError:
            return None
        return frozenset(
            finding.code
            for finding in findings
            if finding.severity == "error" or finding.code in self.codes
        )

    def cures(self, changes: Changes) -> bool:
        """Whether the changed design builds, without the errors and without others."""
        return self.left(changes) == frozenset()

    def keep(self, changes: Changes, less: Changes | None = None) -> None:
        """Write a remedy down: its `changes`, and the next smaller ones, `less`."""
        design = self.result.design.with_(changes)
        self.found.append(Remedy(changes=changes, less=less or {}, design=design))

    def along(self, way: Way) -> bool:
        """Find the smallest change along a way; whether there is one."""
        if self.over():
            return False
        near = {key: way.near.get(key, value_at(self.document, key)) for key in way.far or way.near}
        if any(value is None for value in near.values()):
            return False
        if way.far and _between(near, way.far, 1.0) == _between(near, {}, 0.0):
            return False  # it is there already
        if way.near:
            first = _between(near, way.far, _INSIDE) if way.far else _tidy(near)
            if self.cures(first):
                self.keep(first)
                return True
        told = any(_ahead(remedy.changes, near, way.far) for remedy in self.found)
        return bool(way.far) and not told and self._least(near, way.far)

    def _least(self, near: Changes, far: Changes) -> bool:
        """Find the smallest change between two ends; whether there is one."""
        low, high = 0.0, 1.0
        while self.over() or not self.cures(_between(near, far, high)):
            high *= 0.5
            if high < _STEP or self.over():
                return False
        while True:
            ends = [_between(near, far, share) for share in (high, low)]
            fine = high - low <= _INSIDE or (high - low <= _STEP and _alike(*ends))
            if fine or self.over():
                self.keep(ends[0], ends[1] if low else None)
                return True
            middle = 0.5 * (low + high)
            does = self.cures(_between(near, far, middle))
            low, high = (low, middle) if does else (middle, high)

    def follow(self, ways: Iterable[Way]) -> None:
        """Follow `ways`, each for one wheel and, where that does not do, for both.

        Where a changed design is refused for something else, ways out of that are followed too.
        """
        for way in ways:
            if self.along(way):
                continue
            if (both := _for_both(way)) is not None:
                self.along(both)
            elif way.near and not self.over() and self.left(_tidy(way.near)) is None:
                for other in self.second.ways if self.second else ():
                    self.along(_joined(way.near, other))


def _joined(changes: Changes, way: Way) -> Way:
    """Return a way that makes other changes too."""
    return Way(
        near={**changes, **way.near} if way.near else {},
        far={**changes, **way.far} if way.far else {},
    )


def _for_both(way: Way) -> Way | None:
    """Return a way of one wheel's blank as one of both, None where it is none."""
    keys = [*way.near, *way.far]
    if not keys or not all(re.fullmatch(r"blank\.\w+\[\d\]", key) for key in keys):
        return None
    near, far = ({key[:-3]: end for key, end in ends.items()} for ends in (way.near, way.far))
    return Way(near=near, far=far)


def _ahead(changes: Changes, near: Mapping[str, Any], far: Mapping[str, Any]) -> bool:
    """Whether `changes` go the way of these ends, that of single numbers."""
    if changes.keys() != far.keys():
        return False
    ends = ((value, near[key], far[key]) for key, value in changes.items())
    return all(isinstance(a, float) and (a - b) * (c - b) > 0.0 for a, b, c in ends)


def _alike(some: Changes, others: Changes) -> bool:
    """Whether the numbers of two changes of the same keys are nearly the same."""
    pairs = zip(_items(some), _items(others), strict=True)
    return all(abs(a - b) <= _CLOSE * abs(a) for a, b in pairs if isinstance(a, float))


def _items(changes: Mapping[str, Any]) -> list[Any]:
    return [
        one for value in changes.values() for one in (value if isinstance(value, list) else [value])
    ]


def _between(near: Changes, far: Changes, share: float) -> dict[str, object]:
    """Return values between two ends, with as few digits as the way asks for."""
    return {key: _mixed(value, far.get(key, value), share) for key, value in near.items()}


def _tidy(value: Any) -> Any:
    """Write numbers in ten digits."""
    if isinstance(value, Mapping):
        return {key: _tidy(item) for key, item in value.items()}
    if isinstance(value, list):
        return [_tidy(item) for item in value]
    return float(f"{value:.10g}") if isinstance(value, float) else value


def _mixed(near: Any, far: Any, share: float) -> Any:
    if isinstance(near, list):
        ends = far if isinstance(far, list) else [far] * len(near)
        # numbers that close together are not rounded each by itself
        return [_part_way(a, b, share) for a, b in zip(near, ends, strict=True)]
    mixed = _part_way(near, far, share)
    if isinstance(far, bool | str) or not isinstance(mixed, float) or near == far or share == 1.0:
        return mixed
    step = 10.0 ** math.floor(math.log10(abs(_INSIDE * (far - near))))
    return _tidy(step * (math.ceil if far > near else math.floor)(mixed / step))


def _part_way(near: Any, far: Any, share: float) -> Any:
    if isinstance(near, bool | str) or isinstance(far, bool | str):
        return near
    return _tidy(float(near + share * (far - near)))
