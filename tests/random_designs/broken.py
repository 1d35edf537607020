"""Designs with an error: wrong values, types, keys, tables, formulas or text."""

from __future__ import annotations

import copy
import math
from collections.abc import Callable, Mapping
from typing import Any, Final

from gearcam.designs.writing import toml_text
from random_designs.draw import Draw, short

Document = dict[str, Any]
Place = tuple[dict[str, Any] | list[Any], Any]

_STRANGE: Final = (
    *(math.nan, math.inf, -math.inf, 0, -1, 1e-300, 1e300, -0.0, 10**30, 0.1 + 0.2, 2**53 + 1),
    *("", "x", "1,5", "solve", "rest", "../../x", "\u00e4 \U0001f600", "a" * 300),
    *(True, [], [[]], [1, "a"], {}, {"a": 1}, [0.0] * 40),
)
"""Values of any type."""

_FORMULAS: Final = (
    *(
        "1/(x - x)",
        "1/sin({})",
        "tan({})",
        "log({} - 1)",
        "sqrt({} - 2)",
        "sqrt({})",
        "abs({} - 1)",
    ),
    *("9**9**9", "{}**-1", "({} - 3)**0.5", "0*{}", "1e308*{}*1e308", "exp(exp(exp({})))"),
    *("(" * 300 + "{}" + ")" * 300, "-" * 500 + "{}", "1 +", "sin", "{} {}", "__import__('os')"),
    *("1 + 0.1*sign(sin({}))", "floor({})", "max({}, 1)", "1 + 1e-9*sin(1000*{})", "asin({})"),
)
"""Formulas with poles, corners and errors; braces stand for a variable."""

_VARIABLES: Final = ("phi1", "x", "theta", "u", "y")


def broken(d: Draw, document: Document, tables: Mapping[str, str]) -> dict[str, Any]:
    """Return a design with an error.

    Parameters
    ----------
    d : Draw
        Random numbers of this design.
    document : dict
        Content of the design file.
    tables : mapping of str to str
        Texts of its CSV files by file name.

    Returns
    -------
    dict
        ``files`` and ``broken``, the arguments of `random_designs.designs.Drawn`.
    """
    made, ways = copy.deepcopy(document), [*_WAYS, *_OF_TEXTS]
    weights = [_WAYS.get(way, 1) for way in ways]
    drawn = d.random.choices(ways, weights)[0]
    if drawn in _WAYS:
        drawn(d, made)
    texts = {f"{document['name']}.toml": toml_text(made), **tables}
    if drawn in _OF_TEXTS:
        one = d.pick([*texts])
        texts[one] = drawn(d, texts[one])
    return {"files": texts, "broken": drawn.__name__.strip("_").replace("_", " ")}


def _places(node: Any) -> list[Place]:
    """Return all keys of tables and indices of lists, at any depth."""
    found: list[Place] = []
    items = node.items() if isinstance(node, dict) else enumerate(node)
    for key, item in items:
        if key not in ("kind", "name"):
            found.append((node, key))
        if isinstance(item, dict | list):
            found += _places(item)
    return found


def _chosen(d: Draw, document: Document, wanted: Callable[[Any], bool]) -> Place:
    """Return a random place whose value is wanted; any place if there is none."""
    known = _places(document)
    return d.pick([one for one in known if wanted(one[0][one[1]])] or known)


def _is_number(item: Any) -> bool:
    return isinstance(item, int | float) and not isinstance(item, bool)


def _number_scaled(d: Draw, document: Document) -> None:
    table, key = _chosen(d, document, _is_number)
    if _is_number(table[key]):
        table[key] = short(table[key] * d.sign() * d.log(1e-4, 1e4))


def _strange_value(d: Draw, document: Document) -> None:
    table, key = d.pick(_places(document))
    table[key] = d.pick(_STRANGE)


def _missing_key(d: Draw, document: Document) -> None:
    table, key = d.pick(_places(document))
    del table[key]


def _unknown_key(d: Draw, document: Document) -> None:
    table, key = _chosen(d, document, lambda item: not isinstance(item, list))
    if isinstance(table, dict):
        cut = d.whole(0, max(len(key) - 1, 0))
        table[key[:cut] + key[cut + 1 :]] = d.pick([table.pop(key), 1.0])


def _list_changed(d: Draw, document: Document) -> None:
    table, key = _chosen(d, document, lambda item: isinstance(item, list))
    items = table[key]
    if not isinstance(items, list):
        return
    changes: tuple[Callable[[], Any], ...] = (
        items.clear, items.reverse, lambda: items.append(copy.deepcopy(items[-1:])),
        lambda: items.extend(copy.deepcopy(items)), lambda: items.insert(0, 0.0),
        lambda: items.__delitem__(slice(0, 1)), lambda: items.__delitem__(slice(1, None)),
        lambda: items.extend(copy.deepcopy(items[-1:])),
    )  # fmt: skip
    d.pick(changes)()


def _formula_with_poles(d: Draw, document: Document) -> None:
    table, key = _chosen(d, document, lambda item: isinstance(item, str) and "*" in item)
    table[key] = d.pick(_FORMULAS).format(*[d.pick(_VARIABLES)] * 2)


def _text_cut(d: Draw, text: str) -> str:
    return text[: d.whole(0, len(text))]


def _text_without_a_sign(d: Draw, text: str) -> str:
    place = int(d.random.random() * len(text))
    return text[:place] + text[place + 1 :]


def _text_with_a_sign(d: Draw, text: str) -> str:
    place = int(d.random.random() * len(text))
    return (
        text[:place]
        + d.pick(["\0", '"', "[", "=", ",", ";", "\n", "\t", "9", "-", "\ufeff"])
        + text[place:]
    )


def _lines_changed(d: Draw, text: str) -> str:
    lines = text.splitlines(keepends=True)
    one, two = (int(d.random.random() * len(lines)) for _ in "ab")
    if d.chance(0.5):
        lines[one], lines[two] = lines[two], lines[one]
    else:
        lines.insert(one, lines[two])
    return "".join(lines)


_WAYS: Final[dict[Callable[[Draw, Document], None], int]] = {
    _number_scaled: 3,
    _strange_value: 3,
    _missing_key: 1,
    _unknown_key: 1,
    _list_changed: 2,
    _formula_with_poles: 2,
}
"""Changes of a document, with their relative frequencies."""

_OF_TEXTS: Final = (_text_cut, _text_without_a_sign, _text_with_a_sign, _lines_changed)
"""Changes of the text of a file."""
