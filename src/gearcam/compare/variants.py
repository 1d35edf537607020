"""Variants: designs to compare, from files and settings."""

from __future__ import annotations

import itertools
import math
from collections.abc import Iterator, Mapping, Sequence
from dataclasses import dataclass
from typing import Any, Final

from gearcam import build
from gearcam.base.display import ShortRepr
from gearcam.base.errors import DesignError, GearcamError, Problem
from gearcam.base.inches import told
from gearcam.designs import Design, load
from gearcam.designs.design import path_of
from gearcam.designs.faults import show
from gearcam.designs.settings import listed_twice, setting_of, values_of
from gearcam.pictures.scenes import Scene
from gearcam.results.result import Result

MOST: Final = 12
"""Largest number of variants that a table can show."""

_SET: Final = "--set"
_FORM: Final = "KEY=VALUE,VALUE,... such as law.eccentricity=0.1,0.2 or pair.teeth=[20,20],[24,24]"

Settings = Mapping[str, Sequence[Any]]
"""Values by dotted key of a design file."""


@dataclass(frozen=True, kw_only=True)
class Variant(ShortRepr):
    """A design with its result.

    Parameters
    ----------
    label : str
        Label that distinguishes it from the others.
    result : Result
        The result, with computed facts and findings if it can be made.
    scene : Scene, optional
        The scene; None if it cannot be made.
    refusal : GearcamError, optional
        The error if it cannot be made.
    """

    label: str
    result: Result
    scene: Scene | None = None
    refusal: GearcamError | None = None


def settings_of(texts: Sequence[str]) -> dict[str, list[Any]]:
    """Return the settings in `texts` as typed; raise `DesignError` if one cannot be read."""
    settings: dict[str, list[Any]] = {}
    for text in texts:
        found = setting_of(text)
        if found is None:
            raise _wrong(f"{show(text)} is not KEY=VALUE,...")
        key, values = found[0], values_of(found[1])
        if key in settings:
            raise _wrong(f"{key} is set twice", "all values of a key in one list")
        if not values:
            raise _wrong(f"{key} has no value")
        if twice := listed_twice(values):
            raise _wrong(f"{key}: {show(twice[0])} is listed twice", "each value once")
        settings[key] = values
    return settings


def _wrong(message: str, allowed: str = _FORM) -> DesignError:
    return DesignError.of(message, key=_SET, allowed=allowed)


def variants_of(files: Sequence[str], settings: Settings) -> tuple[Variant, ...]:
    """Return the variants of design files with settings.

    Parameters
    ----------
    files : sequence of str
        Design files of one kind.
    settings : mapping
        Values by key; each file is combined with each value, or with each combination of values of
        several keys.

    Returns
    -------
    tuple of Variant
        From two to `MOST`.

    Raises
    ------
    DesignError
        If the number of variants is not allowed, the designs are of different kinds, or a file or
        setting has mistakes.
    """
    count = len(files) * math.prod(map(len, settings.values()))
    if count < 2:
        allowed = f"two design files or more, or {_SET} with two values or more"
        raise DesignError.of("there is nothing to compare with", allowed=allowed)
    if count > MOST:
        message, allowed = f"{count} variants are too many to compare", f"at most {MOST}"
        raise DesignError.of(message, allowed=allowed)
    designs = [load(file) for file in files]
    _demand_one_kind(designs)
    names = [design.name for design in designs]
    names = names if len({*names}) == len(names) else list(files)
    if len({*names}) < len(names):
        raise DesignError([Problem("a file is given twice", allowed="each file once")])
    heads = names if len(names) > 1 else [""]
    changed = [
        (" ".join(filter(None, (head, words))), design, changes)
        for head, design in zip(heads, designs, strict=True)
        for words, changes in _combinations(settings)
    ]
    made = _changed([(design, changes) for _, design, changes in changed])
    return tuple(_built(label, design) for (label, *_), design in zip(changed, made, strict=True))


def _demand_one_kind(designs: Sequence[Design]) -> None:
    first = designs[0].kind
    message = f"designs of different kinds cannot be compared: the first is a {first}"
    problems = [
        Problem(message, one.source, key="kind", value=one.kind, allowed=f'"{first}"')
        for one in designs
        if one.kind != first
    ]
    if problems:
        raise DesignError(problems)


def _combinations(settings: Settings) -> Iterator[tuple[str, dict[str, Any]]]:
    """Yield a label and values for each combination of values."""
    last = [str(path_of(key)[-1]) for key in settings]
    short = len({*last}) == len(last) and not any(word.isdigit() for word in last)
    names = last if short else list(settings)
    for values in itertools.product(*settings.values()):
        words = [f"{name}={show(value)}" for name, value in zip(names, values, strict=True)]
        yield ", ".join(words), dict(zip(settings, values, strict=True))


def _changed(wanted: Sequence[tuple[Design, Mapping[str, Any]]]) -> list[Design]:
    """Return the changed designs; raise `DesignError` with all mistakes, each once."""
    designs, problems = [], {}
    for design, changes in wanted:
        try:
            designs.append(design.with_(changes) if changes else design)
        except DesignError as error:
            problems |= {str(one): one for one in error.problems}
    if problems:
        raise DesignError(problems.values())
    return designs


def _built(label: str, design: Design) -> Variant:
    result = build(design)
    try:
        _ = result.facts, result.findings
        scene = result.scene()
    except GearcamError as error:
        return Variant(label=label, result=result, refusal=told(error, design.units))
    return Variant(label=label, result=result, scene=scene)
