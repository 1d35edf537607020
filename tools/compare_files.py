"""Compares what two programs have written and told of the same design.

Numbers may differ by `RELATIVE` of their scale: of the column, of the part, of the numbers beside
them. Rounded numbers may differ by one unit of the last place that their file shows. Arcs may lie
elsewhere within their tolerance. Everything else is the same or a difference.
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
"""Difference of numbers over their scale that is rounding."""

SINGLE: Final = 1e-6
"""The same for numbers of 32 bits."""

TOLD: Final = 1e-5
"""The same for numbers in texts, which have six digits."""

MORE: Final = "told by tree only"
"""Words of a difference that is more told."""

_FINER: Final = 0.01
"""How much finer than an outline's tolerance its curves are compared."""

NOISE: Final = ("timings_s", "versions", "design", "hash", "files", "findings", "format")
"""Keys of a summary that tell of the run, or that are compared elsewhere."""

_COMPARED: Final = ("severity", "where", "value", "limit", "unit")
"""What is told beside words."""

_NUMBER = re.compile(r"[-+]?(?:\d+\.?\d*|\.\d+)(?:[eE][-+]?\d+)?")
_PLACES = re.compile(r"\.(\d+)(?![\deE])")


@dataclass(frozen=True)
class Difference:
    """Where two sides differ.

    Parameters
    ----------
    place : str
        A file with its key or column, or a finding.
    size : float
        Over the scale; infinite where it is not of numbers.
    words : str
        Both values.
    """

    place: str
    size: float
    words: str

    @property
    def pattern(self) -> str:
        """The place without numbers, to count what belongs together."""
        return re.sub(r"\d+", "#", self.place)


def folders(
    first: Path, second: Path, tolerance: float, names: Mapping[str, str] | None = None
) -> Iterator[Difference]:
    """Yield where the files of two folders differ.

    Parameters
    ----------
    first, second : Path
        Folders that both sides have written.
    tolerance : float, mm
        How far arcs may lie from their curve.
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
    """Return a `text` with other `names`, whole words, the old ones by the new ones."""
    for new, old in names.items():
        text = re.sub(rf"(?<![\w-]){re.escape(old)}(?![\w-])", new, text)
    return text


def _names(folder: Path) -> dict[str, Path]:
    """Return the files of a folder and of those in it, which bear the names of designs."""
    found = folder.rglob("*") if folder.exists() else ()
    return {path.name: path for path in found if path.is_file()}


def files(name: str, before: bytes, after: bytes, tolerance: float) -> Iterator[Difference]:
    """Yield where two files of the same name differ, by their kind (see `folders`).

    Parameters
    ----------
    name : str
        With its ending.
    before, after : bytes
        What they hold.
    tolerance : float, mm
        How far arcs may lie from their curve.
    """
    kind = name.rpartition(".")[2]
    if kind == "html":
        return  # a page draws and tells what the others hold, and how long it took
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
    elif kind == "step":  # its lines break where digits make them long
        yield from _texts(name, *("".join(side.decode().split()) for side in (before, after)))
    else:
        found = [*_texts(name, before.decode(), after.decode())]
        curves = name.endswith("cut.svg") or (kind == "dxf" and "_drawing" not in name)
        if found and not (
            curves and farthest(kind, before, after, _FINER * tolerance) <= 2.0 * tolerance
        ):
            yield from found


def _numbers(place: str, one: Array, two: Array, scale: Any, allowed: Any) -> Iterator[Difference]:
    """Yield the largest difference of numbers, over their scale, where one is above `allowed`."""
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
    """Yield the largest difference of the numbers in two texts, or the first of their words."""
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
    """Yield the numbers of a text that are no whole ones: those may count things."""
    yield from (float(one) for one in _NUMBER.findall(text) if "." in one)


def _tables(name: str, before: str, after: str) -> Iterator[Difference]:
    """Compare columns; the scale is that of all columns of their unit."""
    one, two = (text.splitlines() for text in (before, after))
    if one[0] != two[0] or len(one) != len(two):
        heads = "" if one[0] == two[0] else f": {one[0]} | {two[0]}"
        yield Difference(name, math.inf, f"{len(one)} | {len(two)} lines{heads}")
        return
    head = one[0].split(",")
    cells = [[line.split(",") for line in lines[1:]] for lines in (one, two)]
    numbers: dict[str, list[Array]] = {}
    columns = [zip(*rows, strict=True) for rows in cells]
    for column, *pair in zip(head, *columns, strict=False):  # no columns where there are no rows
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
    """Compare numbers of 32 bits; as such whole numbers are next to zero, and must be the same."""
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
        return facets["corners"][:, 3:].astype(float).ravel()  # the normals follow from them
    # GLB: the length of its JSON stands at byte 12; the numbers come after it and a head
    start = 20 + int.from_bytes(content[12:16], "little") + 8
    return np.frombuffer(content[start:], dtype="<f4").astype(float)


# --- what is told -----------------------------------------------------------------------------


def summaries(
    name: str, before: Mapping[str, Any], after: Mapping[str, Any], noise: Iterable[str] = NOISE
) -> Iterator[Difference]:
    """Yield the keys in which two summaries differ, or which only one has.

    Parameters
    ----------
    name : str
        Of the file.
    before, after : mapping
        What it holds.
    noise : iterable of str
        Keys at the top that are left out.
    """
    one, two = (dict(_leaves("", _plain(side), 0.0)) for side in (before, after))
    skipped = tuple(f".{key}" for key in noise)
    for key in dict.fromkeys([*one, *two]):
        if re.match(r"\.\w+", key)[0] in skipped:  # type: ignore[index]
            continue
        place = f"{name}:{key[1:]}"
        if key not in one or key not in two:
            yield Difference(place, math.inf, "told by base only" if key in one else MORE)
            continue
        (a, near), (b, _) = one[key], two[key]
        if isinstance(a, float) and isinstance(b, float):
            scale = max(near, abs(a), abs(b), 360.0 * ("_deg" in key), ".accuracy" in key)
            yield from _numbers(place, np.array([a]), np.array([b]), scale, RELATIVE * scale)
        elif a != b:
            yield Difference(place, math.inf, f"{a!r} | {b!r}")


def _plain(node: Any) -> Any:
    """Write directions as vectors: that of nothing is any."""
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
    """Yield the values of a tree by their paths, with the largest number beside each."""
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
    """Yield in what two lists of findings or refusals differ.

    Parameters
    ----------
    title : str
        What they are.
    before, after : sequence of mapping
        Each with its value, limit, unit, place, and words.
    messages : bool
        Whether words are compared too.
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
        for a in one:  # in any order: each has its like, or what is left over differs
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
    """Whether two texts differ by the last digits of their numbers at most."""
    if _NUMBER.sub("#", one) != _NUMBER.sub("#", two):
        return False
    first, second = (np.array(_NUMBER.findall(text), dtype=float) for text in (one, two))
    return bool(np.all(np.abs(first - second) <= TOLD * np.maximum(abs(first), abs(second))))
