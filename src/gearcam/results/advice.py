"""Remedies: changes of a design with which it builds without errors.

A change that a refusal or a finding suggests is reported only after it has been tried: the design
is changed in its own keys and built with the same law, outlines, checks and parts. The change is
a remedy if neither the design nor one of its files is refused and no error is left.
"""

from __future__ import annotations

import re
import time
from collections.abc import Callable, Iterable, Mapping
from contextlib import suppress
from dataclasses import dataclass, field, replace
from functools import cached_property
from types import MappingProxyType
from typing import TYPE_CHECKING, Any, Final

from gearcam.base.adjustments import (
    Adjustment,
    Changes,
    ahead,
    for_both,
    joined,
    least,
    text_of,
    tidy,
    together,
    way,
)
from gearcam.base.display import ShortRepr
from gearcam.base.errors import DesignError, InfeasibleError
from gearcam.base.inches import changes_in, changes_mm, key_mm, told, value_in
from gearcam.base.numerals import shortened
from gearcam.designs.design import Design, document_of, nested_designs, value_at
from gearcam.designs.faults import dotted
from gearcam.parts.fits import in_class_of, without_class
from gearcam.results.kind import kind_of
from gearcam.results.nested import keyed

if TYPE_CHECKING:
    from gearcam.base.findings import Finding
    from gearcam.results.result import Result

_FEW: Final = 2
"""Remedies that keep the motion from which on others are not sought."""

PATIENCE: Final = 6.0
"""Seconds after which a search ends, on a usual machine."""

_PACE: Final = 10.0
"""Designs per second that a usual machine builds, roughly. A search counts designs, not time, so
that its answers are the same everywhere."""

_SLACK: Final = 10.0
"""How many times longer than on a usual machine a search may take: some designs build slowly."""

MOST: Final = 4
"""Largest number of remedies that are offered."""


@dataclass(frozen=True, kw_only=True)
class Remedy(ShortRepr):
    """A change with which a design was built without errors.

    Parameters
    ----------
    changes : mapping of str to value
        Values by dotted keys of the design file, in its units.
    less : mapping of str to value
        The largest smaller change that was not enough; empty if none was tried.
    remaining : tuple of str
        Codes of the warnings of the changed design.
    moves : bool
        Whether the changed design moves otherwise: by another law, lift or mean ratio.
    resized : bool
        Whether it has another size.
    design : Design
        The changed design.
    """

    changes: Changes
    less: Changes = field(default_factory=dict)
    remaining: tuple[str, ...] = ()
    moves: bool = False
    resized: bool = False
    design: Design

    @property
    def text(self) -> str:
        """The changes as in a design file: ``pair.x = 0.2 and pair.teeth = [52, 52]``."""
        return text_of(self._written(self.changes))

    @property
    def next_less(self) -> str:
        """What still fails of the largest smaller change; empty where none was tried."""
        differing = {key: value for key, value in self.less.items() if value != self.changes[key]}
        text = text_of(self._written(differing))
        return text.partition(" = ")[2] if len(differing) == 1 == len(self.changes) else text

    def _written(self, changes: Changes) -> Changes:
        """Return changes as a file has them: both values of what has two, lists that are whole."""
        written = dict[str, Any]()
        for key, value in changes.items():
            found = re.fullmatch(r"([^\[]+)\[(\d+)\]", key)
            name, index = found.groups() if found else (key, "")
            items = value_at(document_of(self.design), key_mm(name)) if found else None
            if isinstance(items, list) and (
                len(items) == 2 or all(f"{name}[{one}]" in changes for one in range(len(items)))
            ):
                own = value_in(key_mm(name), items) if key_mm(name) != name else items
                written.setdefault(name, list(own))[int(index)] = value
            else:
                written[key] = value
        return written

    @property
    def notes(self) -> str:
        """What else to know, in brackets: what it changes, what remains, what still fails."""
        count = len(self.remaining)
        notes = [
            "changes the motion" if self.moves else "",
            f"{count} warnings remain" if count > 1 else "1 warning remains" if count else "",
            f"{self.next_less} still fails" if self.next_less else "",
        ]
        text = "; ".join(note for note in notes if note)
        return f"({text})" if text else ""


@dataclass(frozen=True, kw_only=True)
class Remedies(ShortRepr):
    """The result of a search for remedies.

    Parameters
    ----------
    found : tuple of Remedy
        The remedies, four at most; each is enough by itself. First those that keep motion and
        size, then those that keep the motion; of each sort first those with fewer warnings.
    tried : tuple of str
        Keys that were changed in the search.
    nearly : mapping of str to tuple of str
        Codes of the errors that remain with a change that lifts the refusal only, by its text.
    gave_up : bool
        Whether the search ended before all changes were tried.
    builds : int
        Number of designs that were built.
    """

    found: tuple[Remedy, ...] = ()
    tried: tuple[str, ...] = ()
    nearly: Mapping[str, tuple[str, ...]] = field(default_factory=dict)
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
        Why it or one of its files was refused; if left out, its parts are built and no file.
    patience : float, s
        Time after which no other build is begun on a usual machine; counted in designs.

    Returns
    -------
    Remedies
        Empty if the design is not refused and has no error. Without a `refusal` searched once.
    """
    if refusal is not None:
        return _sought(result, refusal, patience)
    if patience not in result.sought:
        result.sought[patience] = _sought(result, None, patience)
    return result.sought[patience]


def _sought(
    result: Result, refusal: InfeasibleError | None, patience: float, *, last: bool = False
) -> Remedies:
    """Return what a search finds (see `remedies`), going on from what it finds unless `last`."""
    errors: list[Finding] = []
    if refusal is None:
        refusal, errors = _examined(result)
    elif not refusal.adjustments and not refusal.more_teeth:
        with suppress(InfeasibleError):
            _ = result.checked_without_hints
            return Remedies()  # a study was refused, not the design
    if refusal is None and not errors:
        return Remedies()
    search = Search(result, refusal, frozenset(error.code for error in errors), patience)
    search.seek()
    if not last:
        search.go_on()
    order = sorted(search.found, key=lambda one: (one.moves, one.resized, len(one.remaining)))
    return Remedies(
        found=tuple(order[:MOST]),
        tried=tuple(search.tried),
        nearly={
            text: tuple(dict.fromkeys(search.seen[text]["error"]))
            for text in map(text_of, search.first)
            if refusal is not None and text in search.seen
        },
        gave_up=search.gave_up,
        builds=search.builds,
    )


def _examined(result: Result) -> tuple[InfeasibleError | None, list[Finding]]:
    """Return why a design is refused, or its findings that are errors."""
    try:
        found = result.checked_without_hints
        return None, [finding for finding in found if finding.severity == "error"]
    except InfeasibleError as error:
        return error, []


def kerf_paths(result: Any) -> object:
    """Return the drawings from which paths with a kerf are made, or refuse them.

    Parameters
    ----------
    result : Result
        Result of a design whose parts are cut.
    """
    return result.design.output.kerf and result.to_cut


def demand_files(result: Result) -> None:
    """Refuse files of a design that cannot be made although its parts can.

    Parameters
    ----------
    result : Result
        Of the design.

    Raises
    ------
    InfeasibleError
        If one of the files cannot be made.
    """
    demands = kind_of(result.design).advice().file_demands
    for kind in result.design.output.files:
        if kind in demands:
            demands[kind](result)


class Advice:
    """How remedies are searched for in designs of one kind; a kind overrides what it knows."""

    file_demands: Mapping[str, Callable[[Any], object]] = MappingProxyType({})
    """Functions by format that refuse a file of a result although all parts can be made."""

    def seek(self, search: Search, refusal: InfeasibleError | None) -> None:
        """Guide a `search` for remedies of a `refusal`, or of findings that are errors."""
        search.follow(refusal.adjustments if refusal else ())

    def hopeless(self, result: Any) -> bool:  # noqa: ARG002
        """Return whether a changed `result` is known not to help before it is built completely."""
        return False

    def moves(self, changes: Changes, design: Any) -> bool:  # noqa: ARG002
        """Return whether a `design` moves differently with `changes`."""
        return False

    def resized(self, changes: Changes, design: Any) -> bool:  # noqa: ARG002
        """Return whether a `design` has another size with `changes`."""
        return False


class Search:
    """A search with a limited number of builds: what was tried and what was found.

    Parameters
    ----------
    result : Result
        Result of the design to change.
    refusal : InfeasibleError or None
        Why it was refused.
    codes : frozenset of str
        Codes of its errors.
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
        self.advice = kind_of(result.design).advice()
        self.most, self.builds = round(_PACE * patience), 0
        self.until = time.perf_counter() + _SLACK * patience
        self.found: list[Remedy] = []
        self.first: list[Changes] = []
        self.tried: dict[str, None] = {}
        self.gave_up = False
        self.refused: dict[str, InfeasibleError | None] = {}
        self.seen: dict[str, dict[str, tuple[str, ...]]] = {}

    def seek(self) -> None:
        """Search as the advice of the kind knows; first, so for each nested design at fault."""
        for path, design in nested_designs(self.result.design):
            key = dotted(path)
            result: Result = kind_of(design).result(design, self.result.tolerances)
            refusal, errors = _examined(result)
            if refusal is not None or errors:
                nested = _NestedSearch(self, key, result, refusal)
                nested.seek()
                nested.hand_over()
        if not self.found:
            self.advice.seek(self, self.refusal)

    @cached_property
    def document(self) -> dict[str, Any]:
        """The design as a document in mm."""
        return document_of(self.result.design)

    def in_class(self, changes: Changes) -> Changes:
        """Return `changes` in which sizes keep the tolerance classes that the design gives them."""
        in_mm = changes_mm(changes)
        given = {key: value_at(self.document, key) for key in in_mm}
        return self.own({key: in_class_of(given[key], value) for key, value in in_mm.items()})

    def number(self, key: str) -> Any:
        """Return what the design has at a key of the file, sizes with a class as numbers."""
        in_mm = key_mm(key)
        return self.own({in_mm: without_class(value_at(self.document, in_mm))})[key]

    def own(self, changes: Changes) -> Changes:
        """Return changes in the units of the file."""
        return changes_in(changes) if self.result.design.units == "inch" else changes

    def over(self) -> bool:
        """Return whether the search must end: enough designs were built."""
        over = self.builds >= self.most or time.perf_counter() > self.until
        self.gave_up |= over
        return over

    def changed(self, changes: Changes) -> Any:
        """Return the result of the changed design; counted."""
        self.builds += 1
        changes = self.own(changes)
        design = self.result.design.with_(changes)
        self.tried |= dict.fromkeys(changes)
        return type(self.result)(design, self.result.tolerances)

    def alone(self, changes: Changes) -> Any:
        """Return the result of the changed design without one around it; counted."""
        return self.changed(changes)

    def hopeless(self, other: Any) -> bool:
        """Return whether a changed result is known not to help before it is built completely."""
        return self.advice.hopeless(other)

    def left(self, changes: Changes) -> frozenset[str] | None:
        """Return the codes of all errors of the changed design; None if it is refused.

        Changes are built once: a refusal is kept in `refused` if its reason is not that of the
        design, the codes of errors and warnings in `seen`.
        """
        changes = self.own(changes)
        text = text_of(changes)
        if text not in self.seen and text not in self.refused:
            self._build(changes, text)
        return frozenset(self.seen[text]["error"]) if text in self.seen else None

    def _build(self, changes: Changes, text: str) -> None:
        self.refused[text] = None
        try:
            other = self.changed(changes)
            if self.hopeless(other):
                return
            findings = other.checked_without_hints
            demand_files(other)
        except InfeasibleError as error:
            if self.refusal is None or error.what != self.refusal.what:
                self.refused[text] = error
            return
        except DesignError:
            return
        self.seen[text] = {
            word: tuple(finding.code for finding in findings if finding.severity == word)
            for word in ("error", "warning")
        }

    def cures(self, changes: Changes) -> bool:
        """Return whether the changed design builds without errors."""
        return self.left(changes) == frozenset()

    def keep(self, changes: Changes, less: Changes | None = None) -> None:
        """Add a remedy: its `changes`, and the largest smaller ones that are not enough, `less`."""
        design, changes = self.result.design, self.own(changes)
        self.found.append(
            Remedy(
                changes=changes,
                less=less or {},
                remaining=self.seen[text_of(changes)]["warning"],
                moves=self.advice.moves(changes_mm(changes), design),
                resized=self.advice.resized(changes_mm(changes), design),
                design=design.with_(changes),
            )
        )

    @property
    def keeping(self) -> int:
        """Number of remedies found that keep the motion."""
        return sum(not one.moves for one in self.found)

    def along(self, adjustment: Adjustment) -> bool:
        """Find the least change of an adjustment that cures; return whether there is one."""
        if self.over():
            return False
        changed = adjustment.far or adjustment.near or next(iter(adjustment.steps), {})
        adjustment = self._told(adjustment)
        if self.keeping >= _FEW and self.advice.moves(changed, self.result.design):
            return False
        if adjustment.steps:
            steps = adjustment.steps
            every = [self.in_class(one) for one in steps]
            return self._least(lambda place: every[place - 1], range(1, len(steps) + 1))
        far = adjustment.far
        near = {
            key: adjustment.near.get(key, self.number(key)) for key in {**adjustment.near, **far}
        }
        if any(value is None for value in near.values()):
            return False
        places = way(near, far, size=adjustment.size)
        if adjustment.near:
            first = self.in_class(places.first if far else tidy(near))
            if self.cures(first):
                self.keep(first)
                return True
            if not far or text_of(first) in self.seen:  # it can be made, but has other errors
                self.first.append(first)
        if not far or any(ahead(remedy.changes, near, far) for remedy in self.found):
            return False
        guess = adjustment.guess
        looks = places.from_guess(guess) if guess else places.looks
        return self._least(lambda one: self.in_class(places.at(one)), looks, guessed=bool(guess))

    def _told(self, adjustment: Adjustment) -> Adjustment:
        """Return an adjustment in the units of the file; lengths in inches are rounded.

        Several lengths are so only where that cures: they may have to fit together.
        """
        own = told(adjustment, self.result.design.units)
        if own is adjustment or own.far or own.near == adjustment.near:
            return own
        near = {key: self._rounded(key, value) for key, value in own.near.items()}
        return replace(own, near=near) if len(near) == 1 or self.cures(near) else own

    def _rounded(self, key: str, value: Any) -> Any:
        """Return a length with few digits, farther from that of the design; others as they are."""
        given = self.number(key)
        if not isinstance(value, float) or not isinstance(given, float) or value in (0.0, given):
            return value
        return shortened(value, abs(value) - abs(given))

    def _least(
        self, at: Callable[[int], Changes], looks: Iterable[int], *, guessed: bool = False
    ) -> bool:
        """Keep the least of the places that cures; return whether one does (see `least`)."""
        found = least(lambda place: self.cures(at(place)), looks, guessed=guessed, over=self.over)
        if found is not None:
            high, low = found
            self.keep(at(high), at(low) if low else None)
        return found is not None

    def go_on(self) -> None:
        """Search on from designs that have other errors after one change."""
        for changes in self.first:
            if self.found or self.over():
                return
            left = (self.most - self.builds) / _PACE
            try:
                changed = self.changed(changes)
            except DesignError:
                continue  # beyond what the keys allow
            other = _sought(changed, None, left, last=True)
            self.builds += other.builds
            self.tried |= dict.fromkeys(other.tried)
            design = self.result.design
            for remedy in other.found:
                both = together(changes, remedy.changes)
                self.found.append(
                    replace(
                        remedy,
                        changes=both,
                        less=together(changes, remedy.less) if remedy.less else {},
                        moves=remedy.moves or self.advice.moves(changes_mm(changes), design),
                        resized=remedy.resized or self.advice.resized(changes_mm(changes), design),
                        design=design.with_(both),
                    )
                )

    def follow(self, adjustments: Iterable[Adjustment]) -> None:
        """Follow `adjustments`, each for one wheel and, where that does not help, for both.

        Where a changed design is refused for another reason, its adjustments are followed too.
        """
        for adjustment in adjustments:
            if self.keeping >= MOST:
                return
            if self.along(adjustment):
                continue
            near = tidy(self.own(adjustment.near))
            if (both := for_both(adjustment)) is not None:
                self.along(both)
            elif near and not self.over() and self.left(near) is None:
                second = self.refused[text_of(near)]
                for other in second.adjustments if second else ():
                    self.along(joined(adjustment.near, other))


class _NestedSearch(Search):
    """The search for changes of a nested design with which the design around it has no errors.

    Its changes and remedies are those of the nested design until it hands them over.
    """

    def __init__(
        self, outer: Search, key: str, result: Result, refusal: InfeasibleError | None
    ) -> None:
        super().__init__(result, refusal, outer.codes, 0.0)
        self.outer, self.key = outer, key

    def over(self) -> bool:
        """Return whether the outer search must end."""
        return self.outer.over()

    def changed(self, changes: Changes) -> Any:
        """Return the result of the outer design with `changes` of the nested one; counted there."""
        return self.outer.changed(self.keyed(changes))

    def keyed(self, changes: Changes) -> Changes:
        """Return `changes` of the nested design as those of the outer one, in its units."""
        return self.outer.own(changes_mm(keyed(self.key, changes)))

    def alone(self, changes: Changes) -> Any:
        """Return the result of the nested design with `changes`; counted by the outer search."""
        self.outer.builds += 1
        return type(self.result)(self.result.design.with_(changes), self.result.tolerances)

    def hopeless(self, other: Any) -> bool:  # noqa: ARG002
        """Return False: what is known of the nested design says nothing of the `other` result."""
        return False

    def hand_over(self) -> None:
        """Give the outer search what was found, as changes of its design."""
        outer = self.outer
        for changes in self.first:
            outer.first.append(self.keyed(changes))
            if text_of(changes) in self.seen:
                outer.seen[text_of(self.keyed(changes))] = self.seen[text_of(changes)]
        for remedy in self.found:
            changes = self.keyed(remedy.changes)
            design = outer.result.design.with_(changes)
            less = self.keyed(remedy.less)
            outer.found.append(replace(remedy, changes=changes, less=less, design=design))
