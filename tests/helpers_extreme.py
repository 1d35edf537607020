"""The catalogue of stiff and extreme cases: what must happen is told in each file.

The last of the comments that a file begins with is one of::

    # must: be built
    # must: be found tips-collide, contact-ratio
    # must: be refused pair.teeth [41, 41]
    # must: be refused by reading law.formula

A value is the nearest feasible one: it stands in the message, and with it the design is built.
"""

from __future__ import annotations

import json
import re
import tomllib
from contextlib import chdir
from pathlib import Path
from typing import Any, NamedTuple

import gearcam
from gearcam.advice import demand_files
from gearcam.designs.design import path_of
from gearcam.errors import DesignError, InfeasibleError
from helpers_pairs import PROFILES

EXTREME = PROFILES / "extreme"

_MUST = re.compile(
    r"# must: be (?:(built)|(found) ([a-z-]+(?:, [a-z-]+)*)"
    r"|(refused(?: by reading)?) (\S+)(?: (.+))?)"
)


class Must(NamedTuple):
    """What must happen to a design: how it ends, findings at error level, key and value."""

    ending: str
    codes: frozenset[str] = frozenset()
    key: str = ""
    value: str = ""


def must_of(text: str) -> Must:
    """What a design file says of itself."""
    comments = []
    for line in text.splitlines():
        if not line.startswith("#"):
            break
        comments.append(line)
    told = _MUST.fullmatch(comments[-1]) if comments else None
    if told is None:
        raise ValueError(f"what must happen is not told after {comments[-1:]}")
    built, found, codes, refused, key, value = told.groups()
    if refused:
        return Must(refused, key=key, value=value or "")
    return Must(built or found, frozenset(codes.split(", ")) if codes else frozenset())


def misses(path: Path, *, searched: bool = False) -> list[str]:
    """What does not happen to the design of a file as it tells (see `outcome`)."""
    return outcome(path, searched=searched)[0]


def outcome(path: Path, *, searched: bool = False) -> tuple[list[str], Any]:
    """What does not happen to the design of a file as it tells, and its result, None if refused.

    What a refusal does not tell itself stands among the remedies that the command searches and
    tells after it: looked at only if they are to be `searched`.
    """
    must = must_of(path.read_text())
    result: Any = None
    try:
        result = gearcam.build(gearcam.load(path))
        codes = whole(result)
    except DesignError as error:
        words = str(error).replace(str(path), "")  # whose digits are no value
        return _untold(must, "refused by reading", words), None
    except InfeasibleError as error:
        wrong = _untold(must, "refused", str(error))
        if must.ending == "refused" and wrong:
            if not searched:
                return [], None
            found = "".join(f"; {one.text}" for one in gearcam.remedies(result, error).found)
            wrong = _untold(must, "refused", str(error) + found)
        return wrong, None
    ending = "found" if codes else "built"
    wrong = [] if ending == must.ending else [f"{ending}, not {must.ending}"]
    wrong += [] if codes == must.codes else [f"{sorted(codes)}, not {sorted(must.codes)}"]
    return wrong, result


def _untold(must: Must, ending: str, message: str) -> list[str]:
    """What a refusal should tell and does not."""
    wrong = [] if ending == must.ending else [f"{ending}, not {must.ending}: {message}"]
    told = (must.key, must.value)
    return wrong + [f"{text} is not told: {message}" for text in told if text not in message]


def whole(result: Any) -> frozenset[str]:
    """Build all of a result, every fact a number: the codes of its findings at error level."""
    _ = result.parts
    json.dumps(result.facts.document, allow_nan=False)
    demand_files(result)
    return frozenset(one.code for one in result.findings if one.severity == "error")


def with_nearest(path: Path) -> Any:
    """The result of a refused design with the nearest feasible value that it names."""
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
