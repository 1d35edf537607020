"""Keys that several tables of a mechanism have: points, angles, and ends of ranges."""

from __future__ import annotations

import math
from typing import Any, Final

from gearcam.base.numerals import formatted
from gearcam.base.quantities import ANGLE, LENGTH, LONGEST, param

NAME: Final = "mechanism"
"""The kind, as in a file."""

_TURN_DEG: Final = 36000.0
"""Largest angle."""

_ROUNDING: Final = 1e-9
"""Share of a turn that is none."""


def point_param(*, doc: str, word: str = "at", **rest: Any) -> Any:
    """Return a dataclass field of a point: two lengths, x and y.

    Parameters
    ----------
    doc : str
        Its meaning.
    word : str
        The word of its key; empty for the name of the field.
    rest
        As for `gearcam.base.quantities.param`.
    """
    bounds = {"ge": -LONGEST, "le": LONGEST, "order": "x, y"}
    return param(LENGTH, word=word, doc=doc, **bounds, **rest)


def angle_param(*, doc: str, **rest: Any) -> Any:
    """Return a dataclass field of an angle of either sign, or of two.

    Parameters
    ----------
    doc : str
        Its meaning.
    rest
        As for `gearcam.base.quantities.param`.
    """
    return param(ANGLE, ge=-_TURN_DEG, le=_TURN_DEG, doc=doc, **rest)


def sweep_param(*, doc: str, **rest: Any) -> Any:
    """Return a dataclass field of an angle above 0 (see `angle_param`)."""
    return param(ANGLE, gt=0, le=_TURN_DEG, doc=doc, **rest)


def later(start: float, end: float) -> str:
    """Return what an end that is not above its start may be.

    Parameters
    ----------
    start, end : float, rad
        As given.

    Returns
    -------
    str
    """
    turns = math.floor((start - end) / math.tau + _ROUNDING) + 1
    place = formatted(math.degrees(end) + 360.0 * turns, 8)
    return f"a later angle: {place} is the same place of the next turn"
