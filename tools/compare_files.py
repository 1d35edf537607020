"""Compares the files and messages of two versions of gearcam for the same design.

Numbers may differ by `RELATIVE` of their scale: of the column, the part, or the numbers nearby.
Rounded numbers may differ by one unit in the last place of the file. Arcs may differ within their
tolerance. Everything else must be equal.
"""

from __future__ import annotations

import io
import json
import math
import re
import zipfile
from collections import defaultdict
from collections.abc import Iterable, Iterator, Mapping, Sequence
from dataclasses import dataclass
from pathlib import Path
from typing import Any, Final

import numpy as np
from numpy.typing import NDArray

from compare_curves import dxf_size, farthest

Array = NDArray[np.float64]

RELATIVE: Final = 1e-12
"""Rounding errors of numbers relative to their scale."""

SINGLE: Final = 1e-6
"""The same for 32-bit numbers."""

TOLD: Final = 1e-5
"""The same for numbers in texts, which have six digits."""

MORE: Final = "in tree only"
"""Description of a key that only the tree has."""

_FINER: Final = 0.01
"""Chord error of the comparison relative to the tolerance of the outlines."""

NOISE: Final = ("timings_s", "versions", "design", "hash", "files", "findings", "format")
"""Keys of a summary that depend on the run, or that are compared elsewhere."""

_COMPARED: Final = ("severity", "where", "value", "limit", "unit")
"""Fields of a finding that are always compared."""

_NUMBER = re.compile(r"[-+]?(?:\d+\.?\d*|\.\d+)(?:[eE][-+]?\d+)?")
_PLACES = re.compile(r"\.(\d+)(?![\deE])")


@dataclass(frozen=True)
class Difference:
    """A difference between the two sides.

    Parameters
    ----------
    place : str
        A file with a key or column, or a finding.
    size : float
        Relative to the scale; infinite if it is not between numbers.
    words : str
        Both values.
    """

    place: str
    size: float
    words: str

    @property
    def pattern(self) -> str:
        """The place without numbers, to group differences."""
        return re.sub(r"\d+", "#", self.place)


def folders(
    first: Path, second: Path, tolerance: float, names: Mapping[str, str] | None = None
) -> Iterator[Difference]:
    """Yield the differences between the files of two folders.

    Parameters
    ----------
    first, second : Path
        Output folders of both sides.
    tolerance : float, mm
        Tolerance of arcs.
    names : mapping of str to str, optional
        Names of the first by those of the second (see `called`).
    """
    one, two = (_names(folder) for folder in (first, second))
    for name in sorted(one.keys() ^ two.keys()):
        yield Difference(name, math.inf, f"only in {'base' if name in one else 'tree'}")
    for name in sorted(one.keys() & two.keys()):
        before, after = one[name].read_bytes(), two[name].read_bytes()
        if names and name.endswith((".csv", ".json")):
            before = called(before.decode(), names).encode()
        if before != after:
            yield from files(name, before, after, tolerance)


def called(text: str, names: Mapping[str, str]) -> str:
    """Return a `text` in which old names are replaced; `names` maps new names to old ones."""
    for new, old in names.items():
        text = re.sub(rf"(?<![\w-]){re.escape(old)}(?![\w-])", new, text)
    return text


def _names(folder: Path) -> dict[str, Path]:
    """Return the files in a folder and its subfolders by name."""
    found = folder.rglob("*") if folder.exists() else ()
    return {path.name: path for path in found if path.is_file()}


def files(name: str, before: bytes, after: bytes, tolerance: float) -> Iterator[Difference]:
    """Yield the differences between two files of the same name (see `folders`).

    Parameters
    ----------
    name : str
        File name with its extension.
    before, after : bytes
        Contents.
    tolerance : float, mm
        Tolerance of arcs.
    """
    kind = name.rpartition(".")[2]
    if kind == "html":
        return  # a page shows what the other files contain, and run times
    if kind == "json":
        yield from summaries(name, json.loads(before), json.loads(after))
    elif kind == "csv":
        yield from _tables(name, before.decode(), after.decode())
    elif kind == "3mf":
        one, two = (zipfile.ZipFile(io.BytesIO(content)) for content in (before, after))
        if one.namelist() != two.namelist():
            yield Difference(name, math.inf, f"holds {one.namelist()} | {two.namelist()}")
            return
        for member in one.namelist():
            pair = (archive.read(member).decode() for archive in (one, two))
            yield from _texts(f"{name}/{member}", *pair)
    elif kind in ("stl", "glb"):
        yield from _meshes(name, before, after)
    elif kind == "step":  # line breaks depend on the digits
        yield from _texts(name, *("".join(side.decode().split()) for side in (before, after)))
    else:
        found = [*_texts(name, before.decode(), after.decode())]
        curves = name.endswith("cut.svg") or (kind == "dxf" and "_drawing" not in name)
        if found and not (
            curves and farthest(kind, before, after, _FINER * tolerance) <= 2.0 * tolerance
        ):
            yield from found


def _numbers(place: str, one: Array, two: Array, scale: Any, allowed: Any) -> Iterator[Difference]:
    """Yield the largest relative difference of numbers if one exceeds `allowed`."""
    with np.errstate(invalid="ignore"):
        apart = np.where(one == two, 0.0, np.abs(one - two))
    apart = np.where(np.isnan(one) & np.isnan(two), 0.0, apart)
    size = np.nan_to_num(apart / np.maximum(scale, 1e-300), nan=math.inf)
    worst = int(np.argmax(np.where(apart <= allowed, 0.0, size)))
    if not apart[worst] <= np.broadcast_to(allowed, apart.shape)[worst]:
        yield Difference(
            place, float(size[worst]), f"{float(one[worst])!r} | {float(two[worst])!r}"
        )


def _texts(name: str, before: str, after: str) -> Iterator[Difference]:
    """Yield the largest difference between numbers in two texts, or the first between words."""
    words = [_NUMBER.sub("#", text) for text in (before, after)]
    if words[0] != words[1]:
        at = next((n for n, (a, b) in enumerate(zip(*words, strict=False)) if a != b), -1)
        shown = " | ".join(repr(text[max(0, at - 20) : at + 20]) for text in words)
        yield Difference(name, math.inf, shown if at >= 0 else "one is longer")
        return
    one, two = (np.array(_NUMBER.findall(text), dtype=float) for text in (before, after))
    dxf = name.endswith(".dxf")
    scale = dxf_size(before) if dxf else max([1e-300, *map(abs, _parted(before))])
    places = [len(found) for text in (before, after) for found in _PLACES.findall(text)]
    last = 1.01 * 10.0 ** -max(places) if places else 0.0
    yield from _numbers(name, one, two, scale, max(RELATIVE * scale, last))


def _parted(text: str) -> Iterator[float]:
    """Yield the numbers of a text with a decimal point; others may be counts."""
    yield from (float(one) for one in _NUMBER.findall(text) if "." in one)


def _tables(name: str, before: str, after: str) -> Iterator[Difference]:
    """Compare columns; all columns with the same unit have the same scale."""
    one, two = (text.splitlines() for text in (before, after))
    if one[0] != two[0] or len(one) != len(two):
        heads = "" if one[0] == two[0] else f": {one[0]} | {two[0]}"
        yield Difference(name, math.inf, f"{len(one)} | {len(two)} lines{heads}")
        return
    head = one[0].split(",")
    cells = [[line.split(",") for line in lines[1:]] for lines in (one, two)]
    numbers: dict[str, list[Array]] = {}
    columns = [zip(*rows, strict=True) for rows in cells]
    for column, *pair in zip(head, *columns, strict=False):  # a table may have no rows
        try:
            numbers[column] = [np.array([cell or "nan" for cell in side], float) for side in pair]
        except ValueError:
            if pair[0] != pair[1]:
                row = next(n for n, (a, b) in enumerate(zip(*pair, strict=True)) if a != b)
                yield Difference(f"{name}:{column}", math.inf, f"{pair[0][row]} | {pair[1][row]}")
    scales: dict[str, float] = defaultdict(float)
    for column, pair in numbers.items():
        largest = np.nanmax(np.abs(pair), initial=0.0, where=np.isfinite(pair))
        scales[_unit(column)] = max(scales[_unit(column)], float(largest))
    for column, (first, second) in numbers.items():
        scale = scales[_unit(column)]
        yield from _numbers(f"{name}:{column}", first, second, scale, RELATIVE * scale)


def _unit(column: str) -> str:
    return column.rpartition("_")[2] if "_" in column else column


def _meshes(name: str, before: bytes, after: bytes) -> Iterator[Difference]:
    """Compare 32-bit numbers; integers, read as floats, are tiny and must be equal."""
    if len(before) != len(after):
        yield Difference(name, math.inf, f"{len(before)} | {len(after)} bytes")
        return
    one, two = (_singles(name, content) for content in (before, after))
    large = [np.where(np.abs(side) > 1e-30, side, 0.0) for side in (one, two)]
    scale = float(np.nanmax(np.abs(large[0][np.isfinite(large[0])]), initial=0.0))
    whole = np.where((np.abs(one) <= 1e-30) & (np.abs(two) <= 1e-30) & (one != two), math.inf, 0.0)
    yield from _numbers(name, large[0] + whole, large[1], scale, SINGLE * scale)


def _singles(name: str, content: bytes) -> Array:
    if name.endswith(".stl"):
        facets = np.frombuffer(content[84:], dtype=[("corners", "<f4", 12), ("end", "<u2")])
        return facets["corners"][:, 3:].astype(float).ravel()  # without normals
    # GLB: byte 12 has the length of the JSON chunk; the numbers follow it and a chunk header
    start = 20 + int.from_bytes(content[12:16], "little") + 8
    return np.frombuffer(content[start:], dtype="<f4").astype(float)


# --- summaries and messages --------------------------------------------------------------------


def summaries(
    name: str, before: Mapping[str, Any], after: Mapping[str, Any], noise: Iterable[str] = NOISE
) -> Iterator[Difference]:
    """Yield the keys whose values differ in two summaries, or that only one has.

    Parameters
    ----------
    name : str
        File name.
    before, after : mapping
        Contents.
    noise : iterable of str
        Top-level keys to ignore.
    """
    one, two = (dict(_leaves("", _plain(side), 0.0)) for side in (before, after))
    skipped = tuple(f".{key}" for key in noise)
    for key in dict.fromkeys([*one, *two]):
        if re.match(r"\.\w+", key)[0] in skipped:  # type: ignore[index]
            continue
        place = f"{name}:{key[1:]}"
        if key not in one or key not in two:
            yield Difference(place, math.inf, "in base only" if key in one else MORE)
            continue
        (a, near), (b, _) = one[key], two[key]
        if isinstance(a, float) and isinstance(b, float):
            scale = max(near, abs(a), abs(b), 360.0 * ("_deg" in key), ".accuracy" in key)
            yield from _numbers(place, np.array([a]), np.array([b]), scale, RELATIVE * scale)
        elif a != b:
            yield Difference(place, math.inf, f"{a!r} | {b!r}")


def _plain(node: Any) -> Any:
    """Return a tree with directions as vectors, since the direction of zero is arbitrary."""
    if isinstance(node, list):
        return [_plain(one) for one in node]
    if not isinstance(node, Mapping):
        return node
    plain = {key: _plain(one) for key, one in node.items()}
    turned = plain.pop("unbalance_direction_deg", None)
    if turned is not None:
        size, angle = plain["unbalance_g_mm"], math.radians(turned)
        plain["unbalance_at"] = [size * math.cos(angle), size * math.sin(angle)]
    return plain


def _leaves(path: str, node: Any, near: float) -> Iterator[tuple[str, tuple[Any, float]]]:
    """Yield the values of a tree by their paths, with the largest number of their group."""
    if isinstance(node, Mapping):
        beside = [
            item for one in node.values() for item in (one if isinstance(one, list) else [one])
        ]
        near = max((abs(one) for one in beside if _is_number(one)), default=0.0)
        for key, one in node.items():
            yield from _leaves(f"{path}.{key}", one, near)
    elif isinstance(node, list):
        yield f"{path}.length", (len(node), near)
        for number, one in enumerate(node):
            yield from _leaves(f"{path}[{number}]", one, near)
    else:
        yield path, (float(node) if isinstance(node, float) else node, near)


def _is_number(value: Any) -> bool:
    return isinstance(value, int | float) and not isinstance(value, bool)


def told(
    title: str,
    before: Sequence[Mapping[str, Any]],
    after: Sequence[Mapping[str, Any]],
    *,
    messages: bool,
) -> Iterator[Difference]:
    """Yield the differences between two lists of findings or refusals.

    Parameters
    ----------
    title : str
        Word for them in messages.
    before, after : sequence of mapping
        Entries with value, limit, unit, place, and message.
    messages : bool
        Whether to compare the words of messages.
    """
    sides = [defaultdict(list), defaultdict(list)]
    for side, entries in zip(sides, (before, after), strict=True):
        for entry in entries:
            side[entry.get("code", "")].append(entry)
    for code in dict.fromkeys([*sides[0], *sides[1]]):
        one, two = (side[code] for side in sides)
        place = f"{title}:{code}" if code else title
        if len(one) != len(two):
            shown = [", ".join(str(e.get("where", "")) for e in side) for side in (one, two)]
            yield Difference(place, math.inf, f"{len(one)} ({shown[0]}) | {len(two)} ({shown[1]})")
            continue
        rest, alone = list(two), []
        for a in one:  # the order does not matter
            like = (b for b in rest if not any(_entry(place, a, b, messages=messages)))
            found = next(like, None)
            (alone.append(a) if found is None else rest.remove(found))
        for a, b in zip(alone, rest, strict=True):
            yield from _entry(place, a, b, messages=messages)


def _entry(
    place: str, one: Mapping[str, Any], two: Mapping[str, Any], *, messages: bool
) -> Iterator[Difference]:
    scale = max(abs(entry.get(key) or 0.0) for entry in (one, two) for key in ("value", "limit"))
    for key in dict.fromkeys([*one, *two]):
        a, b = one.get(key), two.get(key)
        if a == b:
            continue
        if _is_number(a) and _is_number(b):
            first, second = np.array([a], float), np.array([b], float)
            yield from _numbers(f"{place}.{key}", first, second, scale, RELATIVE * scale)
        elif (key in _COMPARED or messages) and not _said_alike(str(a), str(b)):
            yield Difference(f"{place}.{key}", math.inf, f"{a!r} | {b!r}")


def _said_alike(one: str, two: str) -> bool:
    """Return whether two texts are equal except for the last digits of numbers."""
    if _NUMBER.sub("#", one) != _NUMBER.sub("#", two):
        return False
    first, second = (np.array(_NUMBER.findall(text), dtype=float) for text in (one, two))
    return bool(np.all(np.abs(first - second) <= TOLD * np.maximum(abs(first), abs(second))))
