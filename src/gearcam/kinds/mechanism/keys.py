"""Keys that several tables of a mechanism have: points, angles, ends of ranges, and names.

A key with a name says in the class of its table what the name is, or must be.
"""

from __future__ import annotations

import dataclasses
import math
from collections.abc import Iterator
from enum import StrEnum
from functools import cache
from typing import TYPE_CHECKING, Any, Final, NamedTuple

from gearcam.base.display import ShortRepr
from gearcam.base.numerals import formatted
from gearcam.base.quantities import ANGLE, LENGTH, LONGEST, TEXT, param

if TYPE_CHECKING:
    from gearcam.designs.lines import Path

NAME: Final = "mechanism"
"""The kind, as in a file."""

_TURN_DEG: Final = 36000.0
"""Largest angle."""

_ROUNDING: Final = 1e-9
"""Share of a turn that is none."""


def point_param(*, doc: str, word: str = "at", **rest: Any) -> Any:
    """Return a dataclass field of a point: two lengths, x and y.

    Parameters
    ----------
    doc : str
        Its meaning.
    word : str
        The word of its key; empty for the name of the field.
    rest
        As for `gearcam.base.quantities.param`.
    """
    bounds = {"ge": -LONGEST, "le": LONGEST, "order": "x, y"}
    return param(LENGTH, word=word, doc=doc, **bounds, **rest)


def angle_param(*, doc: str, **rest: Any) -> Any:
    """Return a dataclass field of an angle of either sign, or of two.

    Parameters
    ----------
    doc : str
        Its meaning.
    rest
        As for `gearcam.base.quantities.param`.
    """
    return param(ANGLE, ge=-_TURN_DEG, le=_TURN_DEG, doc=doc, **rest)


def sweep_param(*, doc: str, **rest: Any) -> Any:
    """Return a dataclass field of an angle above 0 (see `angle_param`)."""
    return param(ANGLE, gt=0, le=_TURN_DEG, doc=doc, **rest)


def later(start: float, end: float) -> str:
    """Return what an end that is not above its start may be.

    Parameters
    ----------
    start, end : float, rad
        As given.

    Returns
    -------
    str
    """
    turns = math.floor((start - end) / math.tau + _ROUNDING) + 1
    place = formatted(math.degrees(end) + 360.0 * turns, 8)
    return f"a later angle: {place} is the same place of the next turn"


# --- names ---------------------------------------------------------------------------------------


class Sort(StrEnum):
    """What a name is."""

    SHAFT = "shaft"
    WAY = "slide"
    JOINT = "joint"
    MEMBER = "member"
    GUIDE = "guide"
    ANY = ""
    """That of a drive before its other keys are known: it may turn or slide."""


STANDING: Final = "joint that stands still, or shaft"
"""What a name must be that stands for a place."""

GIVES, NEEDS = "gives", "needs"
"""What a table does with a name."""


def named(
    *,
    doc: str,
    gives: Sort | None = None,
    needs: str | None = None,
    still: bool = False,
    turns: bool = False,
    **rest: Any,
) -> Any:
    """Return a dataclass field of a name, or of several.

    Parameters
    ----------
    doc : str
        Its meaning.
    gives : Sort, optional
        What the name is, if the table gives it to something.
    needs : str, optional
        What it must be, if something else gives it: one of several, with "or" between.
    still, turns : bool
        Whether what the table gives it to stands still, or has a direction that changes.
    rest
        As for `gearcam.base.quantities.param`.
    """
    made = param(TEXT, min_length=1, doc=doc, **rest)
    said = {GIVES: gives, NEEDS: needs, "how": (still, turns)}
    return dataclasses.field(default=made.default, metadata={**made.metadata, **said})


class NameUse(NamedTuple):
    """A name that a table gives or needs.

    Attributes
    ----------
    name : str
        The name.
    sort : str
        What it is, or must be: one of several, with "or" between.
    path : tuple
        Where it stands: in its table, or in the design.
    still, turns : bool
        Whether what has the name stands still, or has a direction that changes.
    """

    name: str
    sort: str
    path: Path
    still: bool = False
    turns: bool = False

    def at(self, title: str, number: int) -> NameUse:
        """Return the same with its path in the design, from that in a table."""
        return self._replace(path=(title, number, *self.path))


@cache
def name_keys(owner: type, use: str) -> tuple[tuple[str, NameUse], ...]:
    """Return the fields of a table with names, and what these are or must be, without a name.

    Parameters
    ----------
    owner : type
        The class of the table.
    use : str
        `GIVES` or `NEEDS`.

    Returns
    -------
    tuple of (str, NameUse)
        The path of each is its key.
    """
    found = ((one.name, one.metadata) for one in dataclasses.fields(owner))
    return tuple(
        (name, NameUse("", said[use], (said["param"].key(name),), *said["how"]))
        for name, said in found
        if said.get(use) is not None
    )


def placed(value: Any, at: Path) -> list[tuple[Path, Any]]:
    """Return a value, or those of a list, with their places.

    Parameters
    ----------
    value : object
        As given.
    at : tuple
        Its place.
    """
    if isinstance(value, list | tuple):
        return [((*at, k), one) for k, one in enumerate(value)]
    return [(at, value)]


class WithNames(ShortRepr):
    """A table that may be given several times, and whose keys may have names."""

    def given(self) -> Iterator[NameUse]:
        """Yield the names that it gives, each with its place in the table."""
        yield from self.written(GIVES)

    def needed(self) -> Iterator[NameUse]:
        """Yield the names that it needs (see `given`)."""
        yield from self.written(NEEDS)

    def written(self, use: str) -> Iterator[NameUse]:
        """Yield the names in its keys of one use: `GIVES` or `NEEDS`."""
        for field, key in name_keys(type(self), use):
            for place, name in placed(getattr(self, field), key.path):
                if name is not None:
                    yield key._replace(name=name, path=place)


def center_of(shaft: str) -> str:
    """Return the name of the joint in which a `shaft` of a drive turns."""
    return f"{shaft}.center"


def way_of(slide: str) -> str:
    """Return the name of the guide along which a `slide` of a drive goes."""
    return f"{slide}.way"
