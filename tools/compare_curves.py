"""Distances between the curves of two drawings: DXF files, or SVG files of arcs and lines."""

from __future__ import annotations

import cmath
import io
import math
import re
from collections.abc import Callable, Iterator
from itertools import permutations
from typing import Any

import numpy as np
from numpy.typing import NDArray

Array = NDArray[np.float64]

_PATH = re.compile(r'class="(\w+)"[^>]*? d="([^"]*)"')
_COMMAND = re.compile(r"([MLAZ]?)([^MLAZ]*)")


def farthest(kind: str, before: bytes, after: bytes, fine: float) -> float:
    """Return the largest distance between the curves of two drawings, layer by layer.

    Parameters
    ----------
    kind : str
        ``dxf`` or ``svg``.
    before, after : bytes
        The files.
    fine : float, mm
        Chord error with which curves are approximated.

    Returns
    -------
    float, mm
        Infinite if the drawings have different layers, or other entities differ.
    """
    read: Callable[[str, float], dict[str, list[Array]]] = _dxf if kind == "dxf" else _svg
    one, two = (read(content.decode(), fine) for content in (before, after))
    if not one or one.keys() != two.keys():
        return math.inf
    apart = (_apart(a, b) for layer in one for a, b in permutations((one[layer], two[layer])))
    return max(apart) + 2.0 * fine


def _apart(one: list[Array], two: list[Array]) -> float:
    """Return the largest distance of the chains of `one` from those of `two`."""
    import shapely

    chains = [chain for chain in two if len(chain)]
    if not chains:
        return math.inf if any(map(len, one)) else 0.0
    sides = np.concatenate(
        [np.stack([c, np.roll(c, -1, axis=0)], axis=1)[: len(c) - 1 or 1] for c in chains]
    )
    lines: Any = shapely.linestrings(sides)
    tree = shapely.STRtree(lines)
    points = shapely.points(np.concatenate([chain for chain in one if len(chain)]))
    return float(np.max(tree.query_nearest(points, return_distance=True, all_matches=False)[1]))


def dxf_size(text: str) -> float:
    """Return the largest coordinate of the entities in a DXF file."""
    lines = text.partition("ENTITIES")[2].split("\n")[1:]
    pairs = zip(lines[::2], lines[1::2], strict=False)
    return max(
        (abs(float(value)) for code, value in pairs if code.strip() in ("10", "20")), default=1.0
    )


def _dxf(text: str, fine: float) -> dict[str, list[Array]]:
    import ezdxf

    found: dict[str, list[Array]] = {}
    for entity in ezdxf.read(io.StringIO(text)).modelspace():  # pyright: ignore[reportPrivateImportUsage]
        points = [(p.x, p.y) for p in _flat(entity, fine)]
        found.setdefault(f"{entity.dxf.layer} {entity.dxftype()}", []).append(np.array(points))
    return found


def _flat(entity: Any, fine: float) -> Iterator[Any]:
    """Yield points on an entity; none for text."""
    if entity.dxftype() in ("LWPOLYLINE", "POLYLINE"):
        for part in entity.virtual_entities():
            yield from _flat(part, fine)
    elif entity.dxftype() == "LINE":
        yield from (entity.dxf.start, entity.dxf.end)
    elif hasattr(entity, "flattening"):
        yield from entity.flattening(fine)


def _svg(text: str, fine: float) -> dict[str, list[Array]]:
    found: dict[str, list[Array]] = {}
    for layer, data in _PATH.findall(text):
        for loop in filter(None, data.split("M")):
            points = [(z.real, z.imag) for z in _walked("M" + loop, fine)]
            found.setdefault(layer, []).append(np.array(points))
    return found


def _walked(data: str, fine: float) -> Iterator[complex]:
    here = first = 0j
    for command, words in _COMMAND.findall(data):
        numbers = [float(word) for word in re.split(r"[\s,]+", words.strip()) if word]
        if command == "A":
            for k in range(0, len(numbers), 7):
                radius, _, _, large, sweep, x, y = numbers[k : k + 7]
                yield from _arc(here, complex(x, y), radius, large != sweep, sweep, fine)
                here = complex(x, y)
        else:
            for x, y in zip(numbers[::2], numbers[1::2], strict=True):
                here = complex(x, y)
                first = here if command == "M" else first
                yield here
        if command == "Z":
            yield first


def _arc(
    start: complex, end: complex, radius: float, left: bool, sweep: float, fine: float
) -> Iterator[complex]:
    """Yield points of an arc after its start; `left`: its centre is left of the chord."""
    chord = end - start
    if chord == 0:
        return
    off = math.sqrt(max(radius**2 - 0.25 * abs(chord) ** 2, 0.0)) * (1 if left else -1)
    middle = start + 0.5 * chord + off * 1j * chord / abs(chord)
    turn = cmath.phase((end - middle) / (start - middle)) % math.tau - math.tau * (not sweep)
    count = math.ceil(abs(turn) / math.sqrt(8.0 * min(1.0, fine / radius)))
    for k in range(1, count + 1):
        yield middle + (start - middle) * cmath.exp(1j * turn * k / count)
