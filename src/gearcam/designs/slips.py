"""Suggestions for misspelt words and keys of a design file.

Keys are compared word by word in one spelling, the first word counting twice: ``bore_mm`` is nearer
to ``bore_diameter_mm`` than to ``bore_flat_mm``, though it shares more letters with the latter.
"""

from __future__ import annotations

import difflib
import re
from collections.abc import Callable, Collection, Iterable, Iterator, Mapping
from functools import lru_cache
from itertools import islice
from typing import Any, Final

from gearcam.base.errors import MOST_LISTED
from gearcam.base.numerals import formatted
from gearcam.base.quantities import ANGLE, LENGTH
from gearcam.base.units import factor, like
from gearcam.designs.table import Key

STRONG: Final = 0.75
"""Similarity from which a key is suggested rather than the same key of another table, and from
which words may differ in the first letter, which is rare in misspellings."""

SURE: Final = 0.9
"""Similarity from which a key of another table is suggested."""

_WEAK: Final = 0.55
_LEAST_WORD: Final = 0.8
"""Least similarity of keys, and of their words, for a suggestion."""

_ABBREVIATED: Final = 0.95
"""Similarity of a word to its abbreviation, and of a radius to a diameter."""

_OTHER_UNIT: Final = 0.15
"""Reduction of the similarity for a unit of another quantity."""

_LONGEST: Final = 100
"""Largest length of a key with suggestions, characters."""

_EQUAL: Final = 1e-9
_MOST: Final = 4
"""Largest number of keys suggested for one."""

_UNITS: Final = {unit: wanted for wanted in ("mm", "deg") for unit in like(wanted)}
"""Unit suffixes of keys: the corresponding unit in files."""

_ENDING: Final = re.compile(f"(.+?)(?:_({'|'.join(_UNITS)})(?:_per_rad2?)?)?", re.DOTALL)

_SPELLINGS: Final[Mapping[str, str]] = {
    **dict.fromkeys(("centre",), "center"),
    **dict.fromkeys(("tooth", "z"), "teeth"),
    **dict.fromkeys(("m",), "module"),
    **dict.fromkeys(("dia", "diam"), "diameter"),
    **dict.fromkeys(("radii",), "radius"),
    **dict.fromkeys(("shaft",), "bore"),
    **dict.fromkeys(("shift",), "x"),
    **dict.fromkeys(("direction",), "rotation"),
    **dict.fromkeys(("hole",), "bolt"),
    **dict.fromkeys(("holes", "screws"), "bolts"),
    **dict.fromkeys(("finish", "roughness", "texture"), "surface"),
}
"""Other spellings of words of keys, and other words for the same thing."""

_NAMES: Final[Mapping[str, tuple[str, ...]]] = {
    "thickness": ("face_width",),
    **dict.fromkeys(("diametral_pitch", "dp"), ("module",)),
    **dict.fromkeys(("fit", "bore_fit", "bore_tolerance"), ("bore_diameter",)),
    **dict.fromkeys(("bcd", "pcd", "pitch_circle"), ("bolt_circle",)),
    **dict.fromkeys(("bolt_pitch", "hole_pitch"), ("bolt_spacing",)),
    "holes": ("bolts", "lightening_holes"),
    "spokes": ("lightening_holes",),
    **dict.fromkeys(("mark", "marks", "zero_mark", "zero_marks"), ("timing_marks", "zero_mark")),
    **dict.fromkeys(("bevel", "edge_break"), ("chamfer",)),
    "grub_screw": ("set_screw",),
    **dict.fromkeys(("title", "name", "number", "drawing_number", "id"), ("part_number",)),
    **dict.fromkeys(("hardness", "hardening", "hardened"), ("heat_treatment",)),
    **dict.fromkeys(("ra", "rz"), ("surface",)),
    **dict.fromkeys(
        ("tolerance", "tolerances"), ("general_tolerances", "chord_tolerance", "bore_diameter")
    ),
    **dict.fromkeys(("checked_by", "checked", "checker"), ("approved_by",)),
    **dict.fromkeys(("drawn_by", "designed_by", "made_by", "designer", "creator"), ("author",)),
    **dict.fromkeys(("company", "firm", "organization"), ("owner",)),
}
"""Other names of keys, without units."""

_RELATED: Final = ({"radius", "diameter"}, {"width", "thickness"})
_SYNONYMS: Final[Mapping[str, tuple[str, ...]]] = {
    **dict.fromkeys(("up", "raise", "lift"), ("rise",)),
    **dict.fromkeys(("fall", "down", "lower"), ("return",)),
    **dict.fromkeys(("pause", "hold", "stay", "rest", "wait"), ("dwell",)),
    **dict.fromkeys(("barrel", "drum", "cylindrical", "axial"), ("cylinder",)),
    **dict.fromkeys(("plate", "radial", "disk"), ("disc",)),
    **dict.fromkeys(("roller-gear", "indexing", "indexer"), ("globoidal",)),
    **dict.fromkeys(("face", "track"), ("groove", "flat")),
    **dict.fromkeys(("linear", "wedge", "reciprocating", "sliding"), ("translating",)),
    **dict.fromkeys(
        ("swinging", "swing", "rocking", "rocker", "pivoting", "pivoted", "rotating"),
        ("oscillating",),
    ),
    **dict.fromkeys(("flat-faced", "flat-face"), ("flat",)),
    **dict.fromkeys(("mushroom", "spherical", "curved"), ("domed",)),
    **dict.fromkeys(("knife", "edge"), ("knife-edge",)),
    **dict.fromkeys(("nc", "cnc", "ngc", "g-code"), ("gcode", "milling")),
    **dict.fromkeys(("print", "printing"), ("stl", "3mf")),
    **dict.fromkeys(("3d", "3d-print"), ("stl", "3mf", "printing")),
    **dict.fromkeys(("ring", "annulus"), ("internal",)),
    **dict.fromkeys(("edm", "wire-edm"), ("wire",)),
    "pdf": ("drawing-pdf", "print-pdf"),
    **dict.fromkeys(("drawing", "drawings", "sheet", "blueprint"), ("drawing-pdf", "drawing")),
    **dict.fromkeys(("dwg", "cad"), ("dxf",)),
    **dict.fromkeys(("svg-cut", "laser-svg"), ("cut-svg",)),
    **dict.fromkeys(("measures", "measuring"), ("inspection",)),
    **dict.fromkeys(("rackbar", "rack_bar", "rack-bar", "rail"), ("bar",)),
    **dict.fromkeys(("title_block", "titleblock"), ("drawing",)),
}
"""Other words that people use: phases of a motion, forms of cams, followers, files, tables."""

_SLIDES: Final = {
    name.replace("t", "p"): name for name in ("rrt", "trr", "rtr", "trt", "rtt", "ttr", "rtrr")
}
"""Types of dyads with P for a joint that slides, as others write them."""

_OF_CAMS = re.compile(r"(?<=.)[-_ ]?(cam|follower)s?$")
"""The end of a word such as ``barrel-cam``."""

_BETWEEN = re.compile(r"[-_ ]+")
"""What is between the parts of a word such as ``swinging roller``."""

_FILLERS: Final = frozenset({"number", "num", "no", "n", "of", "the", "size", "value"})
_SIZES: Final = frozenset({"diameter", "radius", "width", "distance"})
"""Words that are often left out or added."""


@lru_cache(maxsize=4096)
def _letters(word: str, other: str) -> float:
    """Return the number of letters that two words share over their mean length."""
    return difflib.SequenceMatcher(None, word, other).ratio()


def nearest(word: str, known: Iterable[str]) -> str:
    """Return the most similar known word, or an empty text."""
    return next(iter(_meant(word, known)), "")


def _meant(word: str, known: Iterable[str]) -> list[str]:
    """Return the known words that a word may mean: itself, other words for it, or the nearest."""
    by_lower = {name.lower(): name for name in known}
    if word in by_lower.values():
        return [word]
    for one in dict.fromkeys((word.lower(), cam_of(word.lower()))):
        close = [name for name in _SYNONYMS.get(one, ()) if name in by_lower]
        close = close or _similar(_SLIDES.get(one, one), by_lower)[:1]
        if close:
            return [by_lower[name] for name in close]
    return []


def cam_of(word: str) -> str:
    """Return a word such as ``barrel-cam`` without its end."""
    return _OF_CAMS.sub("", word)


def _similar(word: str, known: Iterable[str]) -> list[str]:
    """Return the known words that a word is similar to, the best first."""
    names = list(known)
    close = difflib.get_close_matches(word, names, n=1, cutoff=STRONG)
    near = [one for one in difflib.get_close_matches(word, names) if one[0] == word[0]]
    return close + sorted(near, key=lambda one: not word.startswith(one))  # M3x5 is no M5


def did_you_mean(word: Any, known: Iterable[str]) -> str:
    """Return the hint ``did you mean ...?`` with the nearest known word, or an empty text."""
    near = _meant(word, known) if isinstance(word, str) else []
    note = " (T is a slide)" if near and near[0].lower() == _SLIDES.get(word.lower()) else ""
    return f"did you mean {' or '.join(near)}?{note}" if near else ""


def keyed(word: Any, values: Mapping[str, Collection[str]]) -> str:
    """Return keys and values that a `word` names, or an empty text.

    Parameters
    ----------
    word : object
        A word at a place that does not have it, such as ``swinging``.
    values : mapping of str to collection of str
        The words that keys may have.

    Returns
    -------
    str
        In words: ``follower.motion = "oscillating"``. The parts of a word such as ``swinging
        roller`` may be values of several keys.
    """
    if not isinstance(word, str) or len(word) > _LONGEST:
        return ""
    whole = _keyed(word, values)
    parts = [whole] if whole else [_keyed(one, values) for one in _BETWEEN.split(word)]
    return " and ".join(dict.fromkeys(filter(None, parts)))


def _keyed(word: str, values: Mapping[str, Collection[str]]) -> str:
    """Return the keys whose values have a word or, if none has, another word for it."""
    plain = cam_of(word.lower())
    for names in ((word,), (plain, *_SYNONYMS.get(plain, ()))):
        found = [
            f'{key} = "{one}"' for key, known in values.items() for one in names if one in known
        ]
        if found:
            return " or ".join(found)
    return ""


def meant_by(key: str, known: Mapping[str, Key], least: float = _WEAK) -> list[Key]:
    """Return suggestions for a key that is not `known`.

    Parameters
    ----------
    key : str
        The key as written.
    known : mapping of str to Key
        The keys of its table.
    least : float
        Least similarity, 0 to 1.

    Returns
    -------
    list of Key
        The most similar keys; several if they are equally similar, none below `least`.
    """
    near = known.items() if len(key) <= _LONGEST else ()
    scores = {name: _likeness(key, entry) for name, entry in near}
    best = max(scores.values(), default=0.0)
    likely = [known[name] for name, score in scores.items() if score > best - _EQUAL]
    return likely[:_MOST] if best >= least else []


def same_unit(key: str, entry: Key) -> bool:
    """Return whether a key as written has the unit of an entry, or none."""
    unit = _split(key)[1]
    return not unit or f"_{unit}" == entry.param.quantity.suffix


def _likeness(key: str, entry: Key) -> float:
    """Return the similarity of a written `key` to an entry, 0 to 1."""
    stem, unit = _split(key)
    quantity = entry.param.quantity
    names = {entry.key.removesuffix(quantity.suffix), entry.name}
    written = [_words(one) for one in _NAMES.get(stem.lower(), (stem,))]
    # a key that is called like another word for something else is that key
    known = [[name] if name in _SPELLINGS else _words(name) for name in names]
    likeness = (_words_likeness(one, other) for one in written for other in known)
    score = 1.0 if stem in names else max(likeness)
    other = unit and not quantity.unit.startswith(_UNITS[unit])
    return score - _OTHER_UNIT if other else score


def _split(key: str) -> tuple[str, str]:
    """Return a key without its unit suffix, and the suffix or an empty text."""
    match = _ENDING.fullmatch(key)
    return (match[1], match[2] or "") if match else (key, "")


def _words(name: str) -> list[str]:
    """Return the words of a key in standard spelling, without fillers."""
    words = [word for word in name.lower().split("_") if word]
    words = [_SPELLINGS.get(word, word) for word in words]
    return [word for word in words if word not in _FILLERS] or words


def _words_likeness(written: list[str], known: list[str]) -> float:
    left, extra = _weighed(known), []
    gained = total = 0.0
    for word, weight in _weighed(written):
        near = max(left, key=lambda one, word=word: _alike(word, one[0]), default=("", 0.0))
        alike = _alike(word, near[0])
        if alike:
            left.remove(near)
            gained += alike * (weight + near[1])
            total += weight + near[1]
        else:
            extra.append((word, weight))
    easily = () if left and extra else _SIZES
    total += sum(0.5 * weight if word in easily else weight for word, weight in left + extra)
    letters = _letters("".join(written), "".join(known))
    if gained and letters < 1.0:
        return gained / total
    close = letters >= STRONG or (letters >= _WEAK and written[0][:1] == known[0][:1])
    return letters if close else 0.0


def _weighed(words: list[str]) -> list[tuple[str, float]]:
    return [(word, 1.0 if number else 2.0) for number, word in enumerate(words)]


def _alike(word: str, other: str) -> float:
    """Return the similarity of two words of keys; 0 for different words."""
    if word == other:
        return 1.0
    if {word, other} in _RELATED or (len(word) > 2 and other.startswith(word)):
        return _ABBREVIATED
    letters = _letters(word, other)
    return letters if letters >= _LEAST_WORD else 0.0


def key_hint(key: str, known: Mapping[str, Key] | Iterable[str], least: float = _WEAK) -> str:
    """Return the hint for an unknown key: the nearest keys, with a conversion of the unit.

    Parameters
    ----------
    key : str
        The key as written.
    known : mapping of str to Key, or iterable of str
        The keys of its table.
    least : float
        As for `meant_by`.
    """
    if not isinstance(known, Mapping):
        return did_you_mean(key, known)
    meant = meant_by(key, known, least)
    if not meant:
        return ""
    *most, last = [entry.key for entry in meant]
    offered = f"{', '.join(most)} or {last}" if most else last
    notes = {_unit_words(key, entry) + _size_words(key, entry) for entry in meant}
    return f"did you mean {offered}?" + (notes.pop() if len(notes) == 1 else "")


def _unit_words(key: str, entry: Key) -> str:
    quantity, unit = entry.param.quantity, _split(key)[1]
    if unit and not quantity.suffix:
        return " (it has no unit)"
    if entry.param.fit and re.search("fit|tolerance", key):
        return ' (size and class: "25 H7")'
    if quantity not in (ANGLE, LENGTH) or key.endswith(quantity.suffix):
        return ""
    what = "angles" if quantity is ANGLE else "lengths"
    size = factor(unit, quantity.unit)
    if size is not None and size != 1.0:
        return f" ({what} are in {quantity.unit}: 1 {unit} = {formatted(size, 8)} {quantity.unit})"
    return f" ({what} are in {quantity.unit}, and their keys end in {quantity.suffix})"


def _size_words(key: str, entry: Key) -> str:
    words, known = _words(_split(key)[0]), entry.key + entry.param.doc
    if "diameter" in words and "radius" in entry.key:
        return " (half the diameter)"
    return " (twice the radius)" if "radius" in words and "diameter" in known else ""


def misspelt(raw: Mapping[str, Any], known: Mapping[str, Key]) -> frozenset[str]:
    """Return the known keys that are suggested for unknown ones in a table `raw`."""
    unknown = islice((key for key in raw if key not in known), MOST_LISTED)
    return frozenset(entry.key for key in unknown for entry in meant_by(key, known))


def hinted(unknown: Iterable[str], hint: Callable[[str], str]) -> Iterator[tuple[str, str]]:
    """Yield `unknown` keys with their `hint`; only the first ones have hints, to save time."""
    for number, key in enumerate(unknown):
        yield key, hint(key) if number < MOST_LISTED else ""
