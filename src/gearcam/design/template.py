"""A design file to start from: every key with its meaning, what may be left out as a comment."""

from __future__ import annotations

import dataclasses
import textwrap
from collections.abc import Iterable, Iterator, Mapping
from typing import Any, Final

from gearcam.design.models import description
from gearcam.design.tables import KIND, REQUIRED, TABLES, Entry, Table, law_table, table
from gearcam.design.wording import show
from gearcam.laws.base import LAWS

_COLUMN: Final = 36
_WIDTH: Final = 96
_LAW: Final = "phases"
_GIVEN: Final[Mapping[str, Mapping[str, Any]]] = {
    "law": {"shape": "cosine", "knots_deg": [0, 160, 360], "ratios": [1.25, 0.75, 1.25]},
    "pair": {"center_distance_mm": 120, "teeth": [48, 48], "face_width_mm": 10},
    "blank": {"bore_diameter_mm": [16, 16]},
    "output": {"files": ["dxf", "csv"]},
}
"""An example that builds without a warning; everything else is shown as a comment."""

_NOTES: Final = {"pair": "exactly one of center_distance_mm and module_mm; the other is solved"}

_EXAMPLES: Final = {
    "module_mm": 2.5,
    "chord_tolerance_mm": 0.001,
    "teeth": [1, 27],
    "center_distance_mm": 120.1,
}
"""Values for comments where a key has no default."""


def template(name: str = "my_gear_pair") -> str:
    """Return the text of a commented design file that builds as it is.

    Parameters
    ----------
    name : str
        The design's name.

    Returns
    -------
    str
        TOML.
    """
    return "\n".join(_lines(name)) + "\n"


def _lines(name: str) -> Iterator[str]:
    yield "# A pair of non-circular gears. Build it with: gearcam build FILE"
    yield "# Lengths are in mm and angles in degrees, as the keys say. What stands behind # is a"
    yield "# comment: keys shown so may be left out; their defaults are given."
    yield f'kind = "{KIND}"'
    yield _line("name", name, "names the folder of the files")
    yield ""
    yield _beside("[law]", "the ratio i21 = dphi2/dphi1 over the driver's angle")
    yield _line("type", _LAW, LAWS[_LAW].doc)
    yield from _entries(law_table(_LAW), _GIVEN["law"])
    yield ""
    yield "# Other laws, to stand in place of the table above:"
    for law_type in LAWS:
        if law_type != _LAW:
            yield from _law_comment(law_type)
    for title in TABLES:
        yield from _table(title, table(title), _GIVEN.get(title, {}))
    yield from _table("limits", table("limits"), {})


def _table(title: str, known: Table, given: Mapping[str, Any]) -> Iterator[str]:
    if known.entries:
        yield ""
        head = f"[{title}]"
        note = _NOTES.get(title, "")
        yield (_beside(head, note) if note else head) if given else f"# {head}"
        yield from _entries(known, given)


def _entries(known: Table, given: Mapping[str, Any]) -> Iterator[str]:
    for key, entry in known.entries.items():
        if key in given:
            yield _line(key, given[key], description(entry))
        else:
            yield "# " + _line(key, _example(entry), description(entry), _COLUMN - 2)


def _example(entry: Entry) -> Any:
    if entry.default is REQUIRED or entry.default is None:
        return _EXAMPLES.get(entry.key, entry.param.ge or entry.param.gt or 1)
    return entry.outward(entry.default)


def _law_comment(law_type: str) -> Iterable[str]:
    entry = LAWS[law_type]
    example: Any = entry.claims()[0].parameters
    values = {item.name: getattr(example, item.name) for item in dataclasses.fields(example)}
    known = law_table(law_type)
    given = known.outward(values)
    yield "#"
    yield "# " + _line("type", law_type, entry.doc, _COLUMN - 2)
    for key, item in known.entries.items():
        if key in given:
            yield "# " + _line(key, given[key], description(item), _COLUMN - 2)
        else:
            yield f"#   or {key}: {item.param.doc}"


def _line(key: str, value: Any, words: str, column: int = _COLUMN) -> str:
    return _beside(f"{key} = {show(_short(value))}", words, column)


def _short(value: Any) -> Any:
    """Write 20.0 as 20 where nothing is lost."""
    if isinstance(value, list):
        return [_short(item) for item in value]
    return int(value) if isinstance(value, float) and value.is_integer() else value


def _beside(text: str, words: str, column: int = _COLUMN) -> str:
    """Write a comment beside a line, continued below itself where it is long."""
    first, *more = textwrap.wrap(words, _WIDTH - _COLUMN) or [""]
    # behind a leading "# " the continuation needs its own
    start = "" if column == _COLUMN else "# "
    rest = [f"{start}{'':<{column - 1}} #   {line}" for line in more]
    return "\n".join([f"{text:<{column - 1}} # {first}", *rest])
