"""The page of a sweep: every variant in linked charts, and its design file at a click.

The page holds the columns of values and facts that differ, the text of a design file in which the
values of a variant are put, and small pictures of the best variants, or of some if there are no
goals. So it needs nothing but itself, whatever the number of variants. Rows are read once, one by
one.
"""

from __future__ import annotations

import base64
import math
import re
from array import array
from collections import Counter
from collections.abc import Iterable, Mapping, Sequence
from typing import Any, Final

import numpy as np

from gearcam.base.facts import Facts, text_of
from gearcam.base.readable import scale_of
from gearcam.designs.design import Design, path_of
from gearcam.designs.writing import least_document, toml_text, value_text
from gearcam.pictures.scenes import Scene
from gearcam.report.page import sweep_page
from gearcam.results.result import Result
from gearcam.sweeps.rows import Built
from gearcam.sweeps.small_pictures import PLACES, pictures
from gearcam.sweeps.words import labels

PAGE: Final = "sweep.html"
"""Name of the file."""

_PICKED: Final = 12
"""Largest number of parallel axes at first."""

_REASONS: Final = 20
"""Largest number of reasons at the top."""

_NUMBER: Final = re.compile(r"(?<![\w.])[-+]?\d+(\.\d+)?([eE][-+]?\d+)?")
"""A number in a reason: reasons that differ in nothing else are counted together."""

_MARK: Final = re.compile(r'"@@(\w+)@@"')
"""The place of a value in the text of a design file."""

_PICTURED: Final = 12
"""Largest number of pictures: each variant that has one is built again."""

_SHARES: Final = (5, 50, 95)
"""Percentiles of the time that are told."""


class _Column:
    """Values of a key or a fact, in little memory.

    Parameters
    ----------
    name : str
        Of the key or fact.
    given : bool
        Whether it is a key.
    """

    def __init__(self, name: str, *, given: bool = False) -> None:
        self.name, self.given = name, given
        self._numbers = array("d")
        self._texts: dict[int, str] = {}

    def add(self, place: int, value: Any) -> None:
        """Put the value of the row at a place; places before it without a value stay empty."""
        number = isinstance(value, int | float) and not isinstance(value, bool)
        self._fill(place)
        self._numbers.append(value if number and math.isfinite(value) else math.nan)
        if not number:
            self._texts[place] = value_text(value) if self.given else str(value)

    def _fill(self, count: int) -> None:
        self._numbers.extend([math.nan] * (count - len(self._numbers)))

    def content(self, count: int) -> dict[str, Any]:
        """Return the column of a number of rows for the page.

        ``words`` are the values if some are no numbers; the data are their places then. ``size`` is
        the largest magnitude of the data.
        """
        self._fill(count)
        words: list[str] = []
        values: Any = self._numbers
        if self._texts:
            texts = [self._text(place) for place in range(count)]
            places = {text: place for place, text in enumerate(dict.fromkeys(filter(None, texts)))}
            words, values = list(places), [places.get(text, math.nan) for text in texts]
        data = np.asarray(values, dtype="<f8" if self.given else "<f4")
        there = data[np.isfinite(data)]
        column = {"name": self.name, "input": self.given, "words": words}
        column["differs"] = bool(there.size and there.min() < there.max())
        if there.size and not column["differs"]:
            column["value"] = words[0] if words else text_of(float(there[0]))
        column["size"] = float(np.abs(there).max(initial=0.0))
        return column | {"data": base64.b64encode(data.tobytes()).decode()}

    def written(self, place: int) -> str:
        """Return the value of a row as a design file has it."""
        number = self._numbers[place]
        whole = math.isfinite(number) and number.is_integer()
        return self._texts.get(place) or value_text(int(number) if whole else number)

    def value(self, place: int) -> float:
        """Return the number of a row, nan of one without."""
        return self._numbers[place] if place < len(self._numbers) else math.nan

    def _text(self, place: int) -> str:
        number = self._numbers[place]
        return self._texts.get(place) or ("" if math.isnan(number) else value_text(number))


class _Rows:
    """What a page needs of the rows of a sweep."""

    def __init__(self, rows: Iterable[Built]) -> None:
        self.columns: dict[str, _Column] = {}
        self.numbers, self.errors = array("q"), array("q")
        self.reasons, self.findings = dict[str, int](), dict[str, int]()
        self.refused, self.found = array("q"), array("q")
        self.times = array("d")
        for place, row in enumerate(rows):
            self._add(place, row)

    def _add(self, place: int, row: Built) -> None:
        for name, value in {**row.values, **row.facts, **row.values}.items():
            given = name in row.values
            if name not in self.columns:
                self.columns[name] = _Column(name, given=given)
            self.columns[name].add(place, value)
        self.numbers.append(row.number)
        self.errors.append(row.errors)
        self.times.append(row.time_s)
        self.refused.append(_place(self.reasons, row.refusal))
        self.found.append(_place(self.findings, " ".join(row.findings)))

    def contents(self) -> list[dict[str, Any]]:
        """Return the columns: keys, then facts."""
        columns = [one.content(len(self.numbers)) for one in self.columns.values()]
        return sorted(columns, key=lambda one: not one["input"])

    def best(self, goals: Mapping[str, float]) -> list[int]:
        """Return the places of the rows that none surpasses in all goals, by the first of them."""
        columns = [(self.columns[name], sign) for name, sign in goals.items()]
        good = [
            (values, place)
            for place, (refused, errors) in enumerate(zip(self.refused, self.errors, strict=True))
            if refused < 0 and not errors
            for values in [tuple(sign * one.value(place) for one, sign in columns)]
            if all(map(math.isfinite, values))
        ]
        front = list[tuple[tuple[float, ...], int]]()
        for values, place in sorted(good):  # a later one never surpasses an earlier one
            if not any(
                other != values and all(a <= b for a, b in zip(other, values, strict=True))
                for other, _ in front
            ):
                front.append((values, place))
        return [place for _, place in front]

    def counted(self) -> list[tuple[str, int]]:
        """Return reasons with their numbers, the most frequent first."""
        counts = Counter[str]()
        for place, count in Counter(self.refused).items():
            if place >= 0:
                counts[_NUMBER.sub("…", list(self.reasons)[place])] += count
        most = counts.most_common()
        rest = sum(count for _, count in most[_REASONS:])
        return [*most[:_REASONS], *([("other reasons", rest)] if rest else [])]

    def time(self) -> str:
        """Return a line about the time."""
        values = np.percentile(np.asarray(self.times), _SHARES)
        pairs = zip(_SHARES, values, strict=True)
        return "time: " + ", ".join(f"{p} % up to {1e3 * value:.3g} ms" for p, value in pairs)


def _place(places: dict[str, int], text: str) -> int:
    """Return the place of a text among those that are there, -1 of none."""
    return places.setdefault(text, len(places)) if text else -1


def page(
    base: Design,
    rows: Iterable[Built],
    lines: Sequence[str],
    goals: Mapping[str, float] | None = None,
) -> bytes:
    """Return the page of a sweep.

    Parameters
    ----------
    base : Design
        The design.
    rows : iterable of Built
        Its variants, at least one, all with the same keys.
    lines : sequence of str
        What is said at the top.
    goals : mapping of str to float, optional
        1 of facts that should be small, -1 of those that should be large.

    Returns
    -------
    bytes
        HTML, UTF-8, with all that it needs.
    """
    known = _Rows(rows)
    columns = known.contents()
    varied = [one for one in columns if one["differs"]]
    keys = [one["name"] for one in columns if one["input"]]
    inputs = [one["name"] for one in varied if one["input"]]
    facts = [one["name"] for one in varied if not one["input"] and not one["words"]]
    sought = [name for name in goals or {} if name in facts]
    text = file_text(base, keys)
    scenes = _scenes(known, text, keys, {name: (goals or {})[name] for name in sought})
    given = _result(base)
    words = labels(given.facts if given else Facts({}), [one["name"] for one in columns])
    for one in columns:
        one["label"], one["unit"] = words[one["name"]]
        if one["differs"] and not one["input"] and not one["words"]:
            scale = scale_of(one["size"], one["unit"])
            one["unit"], one["factor"] = scale.unit, scale.factor
    first = _leading(given, set(facts)) or facts or inputs
    plane = sought if len(sought) > 1 else [*inputs[:1], *sought, *first]
    content = {
        "name": base.name,
        "numbers": list(known.numbers),
        "columns": [one for one in columns if one["differs"] or one["input"]],
        "refused": list(known.refused),
        "reasons": list(known.reasons),
        "errors": list(known.errors),
        "found": list(known.found),
        "findings": list(known.findings),
        "file": text,
        "pictures": pictures(scenes),
        "goals": {name: str(round(sign)) for name, sign in (goals or {}).items()},
        "picked": list(dict.fromkeys([*inputs, *(goals or {}), *first]))[:_PICKED],
        "x": (plane or [""])[0],
        "y": next((one for one in plane[1:] if one in facts), (plane or [""])[-1]),
        "ink": next((one for one in inputs if one not in plane[:1]), ""),
    }
    constant = [
        f"{one['label']} = {one['value']} {one['unit']}".rstrip()
        for one in columns
        if "value" in one
    ]
    count = len(known.numbers)
    return sweep_page(
        f"{base.name}, {count} variant{'s' if count > 1 else ''}",
        {
            "lines": [*lines, known.time()],
            "reasons": known.counted(),
            "constant": constant,
            "sought": bool(sought),
        },
        content,
    )


def _result(design: Design) -> Result | None:
    """Return the result of a design; None if it cannot be made, as the one that is varied may."""
    from gearcam.base.errors import GearcamError
    from gearcam.kinds import build

    try:
        result = build(design)
        return result if result.facts else None
    except GearcamError:
        return None


def _leading(result: Result | None, known: set[str]) -> list[str]:
    """Return the names of facts that are always shown, as far as they differ; of studies first."""
    if result is None:
        return []
    leading = [one.name for one in result.facts.leading()]
    studies = tuple(f"{one.study.key}." for one in result.studies.values())
    leading.sort(key=lambda name: not name.startswith(studies))
    return [name for one in leading for name in (one, f"{one}.max", f"{one}.min") if name in known]


def _scenes(
    rows: _Rows, text: str, keys: Sequence[str], goals: Mapping[str, float]
) -> dict[int, Scene]:
    """Return scenes of some variants by their places: of the best, or of some that can be made."""
    from gearcam.base.errors import GearcamError
    from gearcam.designs import loads
    from gearcam.kinds import build

    made = [place for place, reason in enumerate(rows.refused) if reason < 0]
    places = rows.best(goals) if goals else made
    some = np.linspace(0, len(places) - 1, min(len(places), _PICTURED)).round().astype(int)
    found = dict[int, Scene]()
    for place in (places[k] for k in some.tolist()):
        values = [rows.columns[key].written(place) for key in keys]
        try:
            scene = build(loads(_filled(text, values))).scene(PLACES)
        except GearcamError:  # a table of the design may have gone
            continue
        if scene is not None:
            found[place] = scene
    return found


def _filled(text: str, values: Sequence[str]) -> str:
    """Return the text of a design file with values, as written there, in the places of marks."""
    marks = {str(k): value for k, value in enumerate(values)} | {"name": value_text("variant")}
    return _MARK.sub(lambda found: marks[found[1]], text)


def file_text(base: Design, keys: Sequence[str]) -> str:
    """Return the text of a design file with marks in the places of values.

    It builds wherever it is saved (see `least_document`).

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
            if not _has(place, step) or not isinstance(place[step], dict | list):
                place[step] = inner  # also of a pair that is written as one value
            place, whole = place[step], inner
        place[last] = f"@@{number}@@"
    return toml_text(document)


def _has(place: Any, step: str | int) -> bool:
    return step < len(place) if isinstance(step, int) else step in place
