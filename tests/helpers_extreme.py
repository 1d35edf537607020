"""The stiff and extreme cases: each file states the expected outcome.

The last comment at the top of a file is one of::

    # expected: built
    # expected: errors tips-collide, contact-ratio
    # expected: refused, pair.teeth = [41, 41]
    # expected: invalid, law.formula

A value is the nearest feasible one: the message contains it, and with it the design is built.
"""

from __future__ import annotations

import json
import re
import tomllib
from contextlib import chdir
from pathlib import Path
from typing import Any, NamedTuple

import gearcam
from gearcam.base.errors import DesignError, InfeasibleError
from gearcam.designs.design import path_of
from gearcam.results.advice import demand_files
from helpers_pairs import PROFILES

EXTREME = PROFILES / "extreme"

_MUST = re.compile(
    r"# expected: (?:(built)|(errors) ([a-z-]+(?:, [a-z-]+)*)"
    r"|(refused|invalid), (\S+)(?: = (.+))?)"
)


class Must(NamedTuple):
    """The expected outcome of a design: its end, codes of error findings, key and value."""

    ending: str
    codes: frozenset[str] = frozenset()
    key: str = ""
    value: str = ""


def must_of(text: str) -> Must:
    """The expected outcome that a design file states."""
    comments = []
    for line in text.splitlines():
        if not line.startswith("#"):
            break
        comments.append(line)
    told = _MUST.fullmatch(comments[-1]) if comments else None
    if told is None:
        raise ValueError(f"no expected outcome in {comments[-1:]}")
    built, found, codes, refused, key, value = told.groups()
    if refused:
        return Must(refused, key=key, value=value or "")
    return Must(built or found, frozenset(codes.split(", ")) if codes else frozenset())


def misses(path: Path, *, searched: bool = False) -> list[str]:
    """How the outcome of a design file differs from the expected one (see `outcome`)."""
    return outcome(path, searched=searched)[0]


def outcome(path: Path, *, searched: bool = False) -> tuple[list[str], Any]:
    """How the outcome differs from the expected one, and the result, None if refused.

    A value that is not in the message of a refusal is among the remedies that the command prints;
    these are computed only if `searched`.
    """
    must = must_of(path.read_text())
    result: Any = None
    try:
        result = gearcam.build(gearcam.load(path))
        codes = whole(result)
    except DesignError as error:
        words = str(error).replace(str(path), "")  # whose digits are no value
        return _untold(must, "invalid", words), None
    except InfeasibleError as error:
        wrong = _untold(must, "refused", str(error))
        if must.ending == "refused" and wrong:
            if not searched:
                return [], None
            found = "".join(f"; {one.text}" for one in gearcam.remedies(result, error).found)
            wrong = _untold(must, "refused", str(error) + found)
        return wrong, None
    ending = "errors" if codes else "built"
    wrong = [] if ending == must.ending else [f"{ending}, not {must.ending}"]
    wrong += [] if codes == must.codes else [f"{sorted(codes)}, not {sorted(must.codes)}"]
    return wrong, result


def _untold(must: Must, ending: str, message: str) -> list[str]:
    """What is missing in the message of a refusal."""
    wrong = [] if ending == must.ending else [f"{ending}, not {must.ending}: {message}"]
    told = (must.key, must.value)
    return wrong + [f"{text} is missing: {message}" for text in told if text not in message]


def whole(result: Any) -> frozenset[str]:
    """Build all of a result, every fact a number: the codes of its findings at error level."""
    _ = result.parts
    json.dumps(result.facts.document, allow_nan=False)
    demand_files(result)
    return frozenset(one.code for one in result.findings if one.severity == "error")


def with_nearest(path: Path) -> Any:
    """The result of a refused design with the nearest feasible value of its message."""
    text = path.read_text()
    must = must_of(text)
    document = {"name": path.stem} | tomllib.loads(text)
    *way, last = path_of(must.key)
    table: Any = document
    for step in way:
        table = table.setdefault(step, {}) if isinstance(table, dict) else table[step]
    table[last] = tomllib.loads(f"value = {must.value}")["value"]
    with chdir(path.parent):
        return gearcam.build(gearcam.design(document))
