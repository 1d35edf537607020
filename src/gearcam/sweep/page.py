"""The page of a sweep: every variant in linked charts, and its design file at a click.

The page holds the columns of values and facts that differ, and the text of a design file in which
the values of a variant are put. So it needs nothing but itself, whatever the number of variants.
"""

from __future__ import annotations

from collections import Counter
from collections.abc import Mapping, Sequence
from typing import Any, Final

from gearcam.designs.design import Design, path_of
from gearcam.designs.writing import least_document, toml_text
from gearcam.report.page import sweep_page
from gearcam.sweep.rows import Built

PAGE: Final = "sweep.html"
"""Name of the file."""

_PICKED: Final = 12
"""Largest number of parallel axes at first."""

_DIGITS: Final = 7
"""Digits of facts in the page."""


def page(
    base: Design,
    rows: Sequence[Built],
    lines: Sequence[str],
    goals: Mapping[str, float] | None = None,
) -> bytes:
    """Return the page of a sweep.

    Parameters
    ----------
    base : Design
        The design.
    rows : sequence of Built
        Its variants, at least one.
    lines : sequence of str
        What is said at the top.
    goals : mapping of str to float, optional
        1 of facts that should be small, -1 of those that should be large.

    Returns
    -------
    bytes
        HTML, UTF-8, with all that it needs.
    """
    keys = list(rows[0].values)
    given = {key: [row.values[key] for row in rows] for key in keys}
    facts: dict[str, None] = {}
    for row in rows:
        facts |= dict.fromkeys(name for name in row.facts if name not in given)
    columns = [_column(key, values, given=True) for key, values in given.items()]
    columns += [_column(name, [row.facts.get(name) for row in rows]) for name in facts]
    varied = [one for one in columns if one is not None and _differs(one["values"])]
    numbers = {one["name"] for one in varied}
    texts = [name for name in facts if name not in numbers]
    shown = _shown(base, numbers)
    names = [one["name"] for one in varied]
    inputs = [one["name"] for one in varied if one["input"]]
    first = shown or [name for name in names if name not in inputs] or inputs
    reasons = Counter(row.refusal for row in rows if row.refusal)
    known = {reason: place for place, reason in enumerate(reasons)}
    content = {
        "name": base.name,
        "numbers": [row.number for row in rows],
        "keys": keys,
        "given": given,
        "columns": varied,
        "refused": [known.get(row.refusal, -1) for row in rows],
        "reasons": list(known),
        "errors": [row.errors for row in rows],
        "findings": [" ".join(row.findings) for row in rows],
        "file": file_text(base, keys),
        "goals": {name: str(round(sign)) for name, sign in (goals or {}).items()},
        "picked": [*inputs, *first][:_PICKED],
        "x": (inputs or first or [""])[0],
        "y": next(iter(goals or first), ""),
        "ink": inputs[1] if len(inputs) > 1 else "",
    }
    return sweep_page(
        f"{base.name}, {len(rows)} variants",
        {"lines": lines, "reasons": reasons.most_common(), "constant": texts},
        content,
    )


def _column(name: str, values: list[Any], *, given: bool = False) -> dict[str, Any] | None:
    """Return a column of numbers; None if it has none."""
    numbers = [one if _is_number(one) else None for one in values]
    if not any(one is not None for one in numbers):
        return None
    short = [None if one is None else float(f"{one:.{_DIGITS}g}") for one in numbers]
    return {"name": name, "label": name, "input": given, "values": short}


def _is_number(value: Any) -> bool:
    return isinstance(value, int | float) and not isinstance(value, bool)


def _differs(values: Sequence[float | None]) -> bool:
    there = [one for one in values if one is not None]
    return min(there) < max(there)


def _shown(base: Design, known: set[str]) -> list[str]:
    """Return the names of facts that are always shown, as far as they differ; of studies first."""
    from gearcam import build
    from gearcam.base.errors import GearcamError

    result = build(base)
    try:
        leading = [one.name for one in result.facts.leading()]
        studies = tuple(f"{one.study.key}." for one in result.studies.values())
    except GearcamError:
        return []
    leading.sort(key=lambda name: not name.startswith(studies))
    return [name for one in leading for name in (one, f"{one}.max", f"{one}.min") if name in known]


def file_text(base: Design, keys: Sequence[str]) -> str:
    """Return the text of a design file with marks in the places of values.

    Parameters
    ----------
    base : Design
        The design.
    keys : sequence of str
        Dotted keys: the value of the k-th is the text ``@@k@@``, that of the name ``@@name@@``.
    """
    document = least_document(base)
    document["name"] = "@@name@@"
    full = base.to_dict()
    for number, key in enumerate(keys):
        place: Any = document
        whole: Any = full
        *steps, last = path_of(key)
        for step in steps:
            inner = whole[step] if _has(whole, step) else {}
            if not _has(place, step):
                place[step] = inner
            place, whole = place[step], inner
        place[last] = f"@@{number}@@"
    return toml_text(document)


def _has(place: Any, step: str | int) -> bool:
    return step < len(place) if isinstance(step, int) else step in place
