"""Measures that people write as text, answered with their value in the unit of the key.

Depends on units and numerals.
"""

from __future__ import annotations

import re
from collections.abc import Callable
from typing import Final

from gearcam.base.numerals import formatted
from gearcam.base.units import factor

_CLEARANCE: Final = {
    1.6: 1.8, 2: 2.4, 2.5: 2.9, 3: 3.4, 3.5: 3.9, 4: 4.5, 5: 5.5, 6: 6.6, 7: 7.6, 8: 9, 10: 11,
    12: 13.5, 14: 15.5, 16: 17.5, 18: 20, 20: 22, 22: 24, 24: 26, 27: 30, 30: 33, 33: 36, 36: 39,
}  # fmt: skip
"""Clearance holes of metric screws, mm, by nominal diameter, mm: ISO 273, medium series."""

_SCREW: Final = re.compile(r"[Mm]\s?(\d+(?:\.\d+)?)(?:\s?[xX*]\s?[\d.]+)?")
_MEASURE: Final = re.compile(
    r"(?P<sign>[+-]?)(?:(?P<whole>\d+)[ -])?"
    r"(?:(?P<over>\d+)/(?P<under>0|[1-9]\d*)|(?P<plain>\d*[.,]?\d+)\.?)"
    r"\s*(?P<unit>[^\d\s].*)?"
)
"""A number or a fraction, such as 1 1/4, with or without a unit."""


def measure_hint(text: str, unit: str, fits: Callable[[float], bool] = lambda _: True) -> str:
    """Return how to write a measure, or a screw's size, as a number; empty if it is neither.

    Parameters
    ----------
    text : str
        As in the file, such as ``1/4 in`` or ``M3``.
    unit : str
        The unit of the key; empty if it has none.
    fits : callable
        ``fits(number)`` tells whether the key allows a number: no other is proposed.
    """
    text = text.strip()
    screw = _SCREW.fullmatch(text)
    if screw and unit == "mm":
        return _screw_hint(float(screw[1]), fits)
    found = _MEASURE.fullmatch(text)
    if found is None or found["under"] == "0":
        return ""
    given, number = (found["unit"] or "").strip(), _number(found)
    rate = factor(given, unit) if given else 1.0
    if rate is None:
        where = f", in {unit}," if unit else ","
        return f"write the number alone{where} without its unit and without quotes"
    value = formatted(number * rate, 10)
    if not fits(float(value)):
        return f"{text} is {value} {unit}".rstrip() if found["over"] or rate != 1.0 else ""
    if given and rate == 1.0:
        return f"write {value}: the number alone, without its unit and without quotes"
    if given:
        return f"write {value}: {text} is {value} {unit}"
    inches = f", or {formatted(25.4 * number, 10)} if it is in inches" if unit == "mm" else ""
    return f"write {value}{inches}" if found["over"] else "write the number without quotes"


def _screw_hint(nominal: float, fits: Callable[[float], bool]) -> str:
    """Return the diameters that a screw's size may stand for."""
    size, hole = f"M{formatted(nominal)}", _CLEARANCE.get(nominal)
    means = {hole: f"the hole for {size} (ISO 273, medium)", nominal: "its nominal diameter"}
    named = [
        f"{formatted(value)}, {what}" for value, what in means.items() if value and fits(value)
    ]
    return f"{size}: write {', or '.join(named)}" if named else ""


def _number(found: re.Match[str]) -> float:
    """Return the number of a measure."""
    if found["over"]:
        size = float(found["whole"] or 0) + int(found["over"]) / int(found["under"])
    else:
        size = float(found["plain"].replace(",", "."))
    return -size if found["sign"] == "-" else size
