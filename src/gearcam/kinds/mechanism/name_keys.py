"""Keys with names: each says what its name is, or must be, in the class of its table."""

from __future__ import annotations

import dataclasses
from functools import cache
from typing import Any, Final, NamedTuple

from gearcam.base.quantities import TEXT, param

SHAFT, WAY, JOINT, MEMBER, GUIDE = "shaft", "slide", "joint", "member", "guide"
STANDING: Final = "joint that stands still, or shaft"
"""What a name can be, or must be."""

ANY: Final = ""
"""What the name of a drive is before its other keys are known: it may turn or slide."""

GIVES, NEEDS = "gives", "needs"
"""What a table does with a name."""


def named(*, doc: str, gives: str | None = None, needs: str | None = None, **rest: Any) -> Any:
    """Return a dataclass field of a name, or of several.

    Parameters
    ----------
    doc : str
        Its meaning.
    gives : str, optional
        What the name is, if the table gives it to something.
    needs : str, optional
        What it must be, if something else gives it: one of several, with "or" between.
    rest
        As for `gearcam.base.quantities.param`.
    """
    made = param(TEXT, min_length=1, doc=doc, **rest)
    sorts = {GIVES: gives, NEEDS: needs}
    return dataclasses.field(default=made.default, metadata={**made.metadata, **sorts})


class NameKey(NamedTuple):
    """A key with a name, or with several.

    Attributes
    ----------
    field, key : str
        In the class of its table, and in a file.
    sort : str
        What its name is, or must be.
    """

    field: str
    key: str
    sort: str


@cache
def name_keys(owner: type, use: str) -> tuple[NameKey, ...]:
    """Return the keys of a table with names.

    Parameters
    ----------
    owner : type
        The class of the table.
    use : str
        `GIVES` or `NEEDS`.
    """
    found = ((one, one.metadata.get(use)) for one in dataclasses.fields(owner))
    return tuple(
        NameKey(one.name, one.metadata["param"].key(one.name), sort)
        for one, sort in found
        if sort is not None
    )
