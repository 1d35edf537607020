"""Labels of keys and facts on the page of a sweep: words with units, each once.

A fact has its meaning as in a report; a key, and a fact without a meaning, has its name in words.
Of names with the same label each also has what tells it from the others: *least contact ratio,
forward*.
"""

from __future__ import annotations

import re
from collections import defaultdict
from collections.abc import Iterable, Mapping, Sequence
from itertools import pairwise
from typing import Final

from gearcam.base.facts import Facts, NamedFact

_ENDS: Final = {"min": "least", "least": "least", "max": "largest", "mean": "mean"}
"""Words of the ends of ranges."""

_EXTREMES: Final = ("least ", "smallest ", "largest ")
"""Beginnings of meanings that say which end of a range they mean."""

_STEP: Final = re.compile(r"[^.\[\]]+")
"""A part of a dotted name: ``phases[1].to_deg`` has three."""


def labels(facts: Facts, names: Iterable[str]) -> dict[str, tuple[str, str]]:
    """Return label and unit by name.

    Parameters
    ----------
    facts : Facts
        Of a design of the sweep; empty if none can be made.
    names : iterable of str
        Dotted names of keys and facts, as in rows of a sweep.

    Returns
    -------
    dict of str to (str, str)
        No two are the same; units are empty for plain numbers.
    """
    known = {one.name: one for one in facts.quantities()}
    found = {name: _labelled(known, name) for name in names}
    same = defaultdict[tuple[str, str], list[str]](list)
    for name, one in found.items():
        same[one].append(name)
    for (label, unit), alike in same.items():
        if len(alike) > 1:
            for name, more in _differences(alike).items():
                found[name] = (f"{label}, {more}" if more else label), unit
    return found


def _labelled(known: Mapping[str, NamedFact], name: str) -> tuple[str, str]:
    """Return label and unit of one name, which may be an end or an item of a fact."""
    if name in known:
        return _meant(name, known[name])
    whole, _, end = name.rpartition(".")
    if whole not in known:
        return _of_key(name)
    meaning, unit = _meant(whole, known[whole])
    if end not in _ENDS:
        return f"{meaning}, {int(end) + 1 if end.isdigit() else end}", unit
    for word in _EXTREMES:
        if meaning.startswith(word) and end in ("least", "mean"):
            return f"{_ENDS[end]} {meaning.removeprefix(word)}", unit
    return f"{_ENDS[end]} {meaning}", unit


def _meant(name: str, fact: NamedFact) -> tuple[str, str]:
    """Return meaning and unit of a fact, which may be those of a quantity above it.

    ``cam.pressure_angle_deg.max`` is the largest pressure angle.
    """
    *above, last = _STEP.findall(name)
    quantity, outer = _plain(above[-1]) if above else ("", "")
    unit = fact.unit or ("" if isinstance(fact.value, str) else outer)
    if not outer or fact.meaning != _plain(last)[0]:
        return fact.meaning, unit
    return (f"{_ENDS[last]} {quantity}" if last in _ENDS else f"{quantity}, {fact.meaning}"), unit


def _of_key(name: str) -> tuple[str, str]:
    """Return label and unit of a key: *crank 1, length* of ``linkage.cranks[0].length_mm``."""
    steps = _STEP.findall(name) or [""]
    if steps[-1].isdigit() and len(steps) > 1:
        label, unit = _plain(steps[-2])
        return f"{label}, {int(steps[-1]) + 1}", unit
    label, unit = _plain(steps[-1])
    for before, step in pairwise(steps):
        if step.isdigit():
            label = f"{before.removesuffix('s').replace('_', ' ')} {int(step) + 1}, {label}"
    return label, unit


def _plain(step: str) -> tuple[str, str]:
    """Return label and unit of a part of a name."""
    (one,) = Facts({"_": {step: 0.0}}).quantities()
    return one.meaning, one.unit


def _differences(names: Sequence[str]) -> dict[str, str]:
    """Return what tells each name from the others; at most one has nothing."""
    steps = {name: _STEP.findall(name) for name in names}
    every = set.intersection(*(set(one) for one in steps.values()))
    told = {name: ", ".join(_told(one, every)) for name, one in steps.items()}
    return told if len(set(told.values())) == len(told) else {name: name for name in names}


def _told(steps: Sequence[str], every: set[str]) -> list[str]:
    """Return the parts of a name that not all have, in words; wheels by their numbers."""
    words = []
    for before, step in pairwise(["", *steps]):
        if step in every:
            continue
        if step.isdigit():
            words.append(f"{'wheel ' if before == 'gears' else ''}{int(step) + 1}")
        else:
            words.append(step.replace("_", " "))
    return words
