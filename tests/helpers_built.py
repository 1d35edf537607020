"""Results that the tests of a process share: each design is computed once.

Not for tests that count work, measure time, replace functions of the package or change a result:
these call `gearcam.build`, or `fresh`.
"""

from __future__ import annotations

import pickle
from collections import OrderedDict
from dataclasses import fields
from functools import cache
from os import PathLike
from pathlib import Path
from typing import Any, Final

import gearcam
from arch import rules
from gearcam.base.errors import GearcamError
from gearcam.designs import Design
from gearcam.designs.design import hash_of

_KEPT: Final = 200
"""Results kept at a time, those used last."""

_results: OrderedDict[tuple[str, bytes], Any] = OrderedDict()


def built(asked: Design | str | PathLike[str]) -> Any:
    """The result of a design or a design file, the same one for the same design.

    Designs are the same if their hashes are, and all other values, such as names, limits and
    files, to the last digit.
    """
    design = asked if isinstance(asked, Design) else _loaded(Path(asked))
    try:
        values = pickle.dumps([getattr(design, one.name) for one in fields(design)])
        key = hash_of(design), values
    except (GearcamError, pickle.PicklingError, AttributeError):
        return gearcam.build(design)  # a file that has gone, or a function without a name
    result = _results.pop(key, None) or gearcam.build(design)
    _results[key] = result
    if len(_results) > _KEPT:
        _results.popitem(last=False)
    return result


def _loaded(file: Path) -> Design:
    """The design in a file, read once if it is one of the gallery, which no test changes."""
    return _of_gallery(file) if file.parent == rules.ROOT / "profiles" else gearcam.load(file)


@cache
def _of_gallery(file: Path) -> Design:
    return gearcam.load(file)


def fresh(result: Any) -> Any:
    """The result of the same design, of which nothing has been computed."""
    return gearcam.build(result.design, result.tolerances)
