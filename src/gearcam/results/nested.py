"""Nested designs in the result of the design around them: their refusals and findings.

A kind of design that uses another takes its result by `gearcam.build` and what is public of it. The
places in refusals and findings, and the keys of remedies, are those of the nested design: here they
become those of the design around it.
"""

from __future__ import annotations

import re
from collections.abc import Iterable, Iterator, Mapping
from contextlib import contextmanager
from dataclasses import replace
from functools import lru_cache
from typing import Any, Final

from gearcam.base.errors import InfeasibleError
from gearcam.base.findings import Finding
from gearcam.base.tolerances import Tolerances
from gearcam.results.kind import kind_of

_KEPT: Final = 8
"""Results of nested designs that are kept."""


def nested_result(design: Any, tolerances: Tolerances) -> Any:
    """Return the result of a nested design; while the design stays the same, so does the result.

    In searches, sweeps and the live view the machine around it changes more often.

    Parameters
    ----------
    design : Design
        The nested design; with other rows in its CSV files it is another one.
    tolerances : Tolerances
        Internal accuracy.
    """
    return _kept(design, design.source, tolerances)


@lru_cache(_KEPT)
def _kept(design: Any, _source: str, tolerances: Tolerances) -> Any:
    """Return a result; findings have the source of a design, in which equal designs differ."""
    return kind_of(design).result(design, tolerances)


@contextmanager
def within(key: str) -> Iterator[None]:
    """Return a context whose refusals become those of the design around the one at a `key`.

    Raises
    ------
    InfeasibleError
        With the key in its place and in the keys of its adjustments.
    """
    try:
        yield
    except InfeasibleError as error:
        raise InfeasibleError(
            error.what,
            where=_placed(key, error.where),
            value=error.value,
            limit=error.limit,
            unit=error.unit,
            nearest=error.nearest,
            adjustments=[
                replace(
                    way,
                    near=keyed(key, way.near),
                    far=keyed(key, way.far),
                    steps=[keyed(key, step) for step in way.steps],
                )
                for way in error.adjustments
            ],
        ) from error


def placed(
    key: str, findings: Iterable[Finding], titles: Iterable[str] = ()
) -> tuple[Finding, ...]:
    """Return the findings of the design at a key with the key in their places.

    Parameters
    ----------
    key : str
        Dotted key of the design, such as ``drive.pair``.
    findings : iterable of Finding
        Its own.
    titles : iterable of str
        Its titles, if it is written in the design around it: then keys in messages begin with them,
        and are those of the design around it. Those of a design in a file are keys of that file.

    Returns
    -------
    tuple of Finding
    """
    words = "|".join(map(re.escape, titles))
    own = re.compile(rf"(?<![\w.\]])(?=(?:{words})(?:\[\d+\])?\.[a-z])" if words else r"(?!)")
    return tuple(
        replace(one, where=_placed(key, one.where), message=own.sub(f"{key}.", one.message))
        for one in findings
    )


def _placed(key: str, where: str) -> str:
    return f"{key}: {where}" if where else key


def keyed(key: str, changes: Mapping[str, object]) -> dict[str, object]:
    """Return `changes` of the design at a `key` as changes of the design around it."""
    return {f"{key}.{name}": value for name, value in changes.items()}
