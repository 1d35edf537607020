"""Measures that people write as text, answered with their value in the unit of the key.

Depends on units and numerals.
"""

from __future__ import annotations

import math
import re
import unicodedata
from collections.abc import Callable
from typing import Final

from gearcam.base.numerals import formatted
from gearcam.base.units import factor, measured_by

TYPESET: Final = {
    **dict.fromkeys("\u201c\u201d\u201e\u201f\u00ab\u00bb\u2033", '"'),
    **dict.fromkeys("\u2018\u2019\u201a\u201b\u2032\u00b4`", "'"),
    **dict.fromkeys("\u2010\u2011\u2012\u2013\u2014\u2212", "-"),
    **dict.fromkeys("\u00a0\u2002\u2003\u2007\u2009\u202f\u3000", " "),
    **dict.fromkeys("\u200b\u200c\u200d\u2060\ufeff", ""),
}
"""Characters of typesetting, and what is typed in their place."""

_CLEARANCE: Final = {
    1.6: 1.8, 2: 2.4, 2.5: 2.9, 3: 3.4, 3.5: 3.9, 4: 4.5, 5: 5.5, 6: 6.6, 7: 7.6, 8: 9, 10: 11,
    12: 13.5, 14: 15.5, 16: 17.5, 18: 20, 20: 22, 22: 24, 24: 26, 27: 30, 30: 33, 33: 36, 36: 39,
}  # fmt: skip
"""Clearance holes of metric screws, mm, by nominal diameter, mm: ISO 273, medium series."""

_SCREW: Final = re.compile(r"[Mm]\s?(\d+(?:\.\d+)?)(?:\s?[xX*]\s?[\d.]+)?")
_FRACTION: Final = r"(?:(?P<whole>\d+)[ -])?(?P<over>\d+)/(?P<under>0|[1-9]\d*)"
_INCH_SCREW: Final = re.compile(
    rf"(?:(?:#|[Nn]o\.? ?)(?P<number>1?\d)|{_FRACTION}(?: ?(?:\"|in))?(?= ?-))"
    r"(?: ?- ?(?P<threads>\d+))?(?: ?UN[CF])?"
)
"""A screw of the United States, such as 1/4-20 or #8: its size, and its threads per inch."""

_MEASURE: Final = re.compile(
    r"(?:(?P<across>[Øø⌀Dd]|[Dd]ia\.?)|(?P<radius>[Rr]))?\s*"
    r"(?P<size>(?P<sign>[+-]?)"
    rf"(?:{_FRACTION}|(?P<plain>(?:\d+(?:[.,]\d*)?|[.,]\d+)(?:[eE][+-]?\d+)?))"
    r"(?:\s*(?P<unit>[^\d\s].*?))??)"
    r"(?:(?:\s+|(?<=\d))(?P<fit>(?:[A-HJKMNPR-VYZ]|JS|CD|EF|FG|Z[ABC])(?:1[0-8]|[1-9])))?",
    re.IGNORECASE | re.ASCII,
)
"""A number or a fraction, such as 1 1/4: with a unit, the sign of a diameter or a radius before it,
a fit of ISO 286 behind it, or none of these."""

_OF_SHAFT: Final = re.compile(r"(?<=\d)\s*/\s*[a-z]{1,2}\d{1,2}$")
"""The class of the shaft in a fit such as 25 H7/g6."""

_VULGAR: Final = re.compile("[\u00bc-\u00be\u2150-\u215e]")


def measure_hint(
    text: str,
    unit: str,
    fits: Callable[[float], bool] = math.isfinite,
    key: str = "",
    *,
    classes: bool = False,
) -> str:
    """Return how to write a measure, or a screw's size, as a number; empty if it is neither.

    Parameters
    ----------
    text : str
        As in the file, such as ``1/4 in`` or ``M3``.
    unit : str
        The unit of the key; empty if it has none.
    fits : callable
        ``fits(number)`` tells whether the key allows a number: no other is proposed.
    key : str
        The key, which may say that it is a radius or a diameter.
    classes : bool
        Whether the key takes classes of ISO 286 for holes.
    """
    text, of_length = typed(text.strip()), unit in ("mm", "in")
    text = _OF_SHAFT.sub("", text) if classes else text
    if of_length and (screw := _SCREW.fullmatch(text)):
        nominal = float(screw[1])
        size, hole = f"M{formatted(nominal)}", _CLEARANCE.get(nominal)
        means = {hole: f"the hole for {size} (ISO 273, medium)"} if hole else {}
        means |= {nominal: "its nominal diameter"}
        return _screw_hint(size, means, unit, fits, key)
    if of_length and (screw := _INCH_SCREW.fullmatch(text)) and screw["under"] != "0":
        return _screw_hint(text, _of_inch_screw(screw), unit, fits, key)
    found = _MEASURE.fullmatch(text)
    if found is None or found["under"] == "0":
        return ""
    given = found["unit"] or ""
    rate = factor(given, unit) if given not in ("", unit) else 1.0
    if rate is None or not (of_length or found["across"] is found["radius"] is found["fit"]):
        return _alone(given, unit)
    if classes and found["fit"]:
        size = formatted(_number(found) * rate, 10)
        return f'write "{size} {found["fit"].upper()}"' if fits(float(size)) else ""
    return _as_number(found, _number(found) * rate, unit, fits, key)


def typed(text: str) -> str:
    """Return a text with what a keyboard has in place of typeset characters and fractions."""
    plain = text.translate(str.maketrans(TYPESET)).replace("''", '"')

    def fraction(found: re.Match[str]) -> str:
        return " " + unicodedata.normalize("NFKC", found[0]).replace("\u2044", "/")

    return _VULGAR.sub(fraction, plain).strip()


def _as_number(
    found: re.Match[str], size: float, unit: str, fits: Callable[[float], bool], key: str
) -> str:
    """Return how to write a measure of a size, in the unit of its key."""
    written, value, reasons = found["size"].strip(), formatted(size, 10), list[str]()
    converted = f"{written} is {value} {unit}".rstrip()
    other = found["unit"] not in (None, unit) and factor(found["unit"], unit) != 1.0
    if found["unit"]:
        reasons.append(converted if other else "the number alone, without its unit")
    if found["across"] or found["radius"]:
        across, share = (size, "half the diameter") if found["across"] else (2.0 * size, "")
        values = {"radius": formatted(0.5 * across, 10), "diameter": formatted(across, 10)}
        wanted = next((name for name in values if name in key), "")
        if not wanted:
            offered = [f"{one}, the {name}" for name, one in values.items() if fits(float(one))]
            return f"write {', or '.join(offered)}" if offered else ""
        same = value == values[wanted]
        value = values[wanted]
        reasons.append(f"the {wanted}" if same else share or "twice the radius")
    if found["fit"]:
        reasons.append(f"the fit {found['fit']} has no key")
    if not fits(float(value)):
        return converted if found["over"] or other else ""
    if reasons:
        return f"write {value}: {'; '.join(reasons)}"
    inches = 25.4 * size
    if found["over"] and unit == "mm" and fits(inches):
        return f"write {value}, or {formatted(inches, 10)} if it is in inches"
    comma = ", with a decimal point" * ("," in written)
    return f"write {value}{comma}" + " without quotes" * (value == written)


def _alone(given: str, unit: str) -> str:
    """Return how to write a number behind which there is what is no unit of its key."""
    word = re.fullmatch(r"[^\W\d_]+|[%°]", given)
    if not unit:
        return "write the number alone, without its unit" * bool(word)
    kind, wanted = measured_by(given), measured_by(unit)
    if kind and wanted:
        return f"{given} is a unit of {kind.split(' ', 1)[1]}: write {wanted} in {unit}"
    return f"{given} is no unit that is known: " * bool(word) + f"write the number alone, in {unit}"


def _screw_hint(
    size: str, means: dict[float, str], unit: str, fits: Callable[[float], bool], key: str
) -> str:
    """Return the diameters, mm, that a screw's size may stand for; for a radius half of them."""
    share, half = (0.5, "half of ") if "radius" in key else (1.0, "")
    if unit == "in":
        means = {value / 25.4: what.replace("in mm ", "") for value, what in means.items()}
    named = [
        f"{formatted(share * value, 10)}, {half}{what}"
        for value, what in means.items()
        if fits(share * value)
    ]
    return f"{size}: write {', or '.join(named)}" if named else ""


def _of_inch_screw(screw: re.Match[str]) -> dict[float, str]:
    """Return the major diameter of a screw of the United States, mm, and what it is in words."""
    threads = f"; {screw['threads']} is its threads per inch" if screw["threads"] else ""
    if screw["number"]:
        inches, how = 0.060 + 0.013 * int(screw["number"]), f"0.060 + 0.013 x {screw['number']} in"
    else:
        inches = int(screw["whole"] or 0) + int(screw["over"]) / int(screw["under"])
        how = f"{formatted(inches, 10)} in"
    return {25.4 * inches: f"its major diameter in mm ({how}{threads})"}


def _number(found: re.Match[str]) -> float:
    """Return the number of a measure."""
    if found["over"]:
        size = float(found["whole"] or 0) + int(found["over"]) / int(found["under"])
    else:
        size = float(found["plain"].replace(",", "."))
    return -size if found["sign"] == "-" else size
