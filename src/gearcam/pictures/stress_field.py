"""The picture of a stressed tooth: colours inside, the stress along its outline, the worst places.

Inside is the von Mises stress; outside the outline the stress along the edge is drawn as a band,
as wide as the stress is large. What exceeds the scale, beside the contact, has its last colour.

Depends on markup.
"""

from __future__ import annotations

from collections.abc import Iterable, Sequence
from dataclasses import dataclass
from typing import Final

import numpy as np

from gearcam.base.display import ShortRepr
from gearcam.base.numerals import decimal, formatted
from gearcam.numeric.arrays import Array, Plane
from gearcam.pictures.markup import GLYPH, TEXT_INK, picture

COLOURS: Final = (
    "#f3f6fb", "#dbe8f6", "#bcd7ee", "#9cc6e6", "#86bfc9", "#8fc69a", "#b6cf72", "#e0cf5b",
    "#f2b84b", "#ee9440", "#e0693a", "#c73a34", "#9b1b30",
)  # fmt: skip
"""Colours of rising stress, of rising darkness at both ends: they can be told apart in grey."""

TENSION, COMPRESSION = "#b3202c", "#1f5fa8"
"""Bands along the outline."""

_BAND: Final = 0.07
"""Width of the band of the largest stress, over the size of the picture."""

_BAR: Final = 0.035
"""Width of the bar of colours, over the size of the picture."""


@dataclass(frozen=True, eq=False, kw_only=True)
class StressField(ShortRepr):
    """The stress in a part of a wheel.

    Parameters
    ----------
    triangles : (t, 3) complex array, mm
        Triangles of the part.
    von_mises : (t,) array, MPa
        Mean von Mises stress in each.
    edges : (b, 2) complex array, mm
        Edges of its outline, the metal to their left.
    along : (b, 2) array, MPa
        Stress along the edge at both ends of each.
    marked : sequence of (complex, str)
        Worst places, with words.
    loads : (k, 2) complex array
        Places, mm, and unit directions of the forces.
    """

    triangles: Plane
    von_mises: Array
    edges: Plane
    along: Array
    marked: Sequence[tuple[complex, str]]
    loads: Plane

    def svg(self, lines: Sequence[str]) -> bytes:
        """Return the picture as SVG, with `lines` of a caption, the first its title."""
        most = max(float(np.abs(self.along).max()), 1e-9)
        points = self.triangles.ravel()
        low = complex(points.real.min(), points.imag.min())
        high = complex(points.real.max(), points.imag.max())
        size = (high - low).real
        room = _BAND * size

        def elements(pixel: float) -> Iterable[str]:
            yield from self._inside(most, pixel)
            yield from self._bands(most, room)
            edge = "".join(f"M{_place(a)}L{_place(b)}" for a, b in self.edges.tolist())
            yield f'<path fill="none" stroke="{TEXT_INK}" d="{edge}"/>'
            yield from _arrows(self.loads, 0.1 * size, pixel)
            yield from self._marks(pixel)
            yield from _bar(complex(high.real + 1.2 * room, low.imag), high.imag, most, size, pixel)

        corners = low - complex(room, 0.2 * room), high + complex(0.2 * size, room)
        return picture(lines, corners, elements).encode()

    def _inside(self, most: float, pixel: float) -> Iterable[str]:
        step = np.minimum(self.von_mises / most * len(COLOURS), len(COLOURS) - 1).astype(int)
        for number, colour in enumerate(COLOURS):
            some = self.triangles[step == number].tolist()
            if some:
                shape = "".join(f"M{' '.join(map(_place, corners))}Z" for corners in some)
                line = f'stroke="{colour}" stroke-width="{decimal(0.6 * pixel, 4)}"'
                yield f'<path fill="{colour}" {line} d="{shape}"/>'

    def _bands(self, most: float, room: float) -> Iterable[str]:
        way = np.diff(self.edges, axis=1)
        outward = -1j * way / np.maximum(np.abs(way), 1e-300)
        far = self.edges + outward * np.abs(self.along) / most * room
        tension = self.along.mean(axis=1) > 0.0
        for mask, colour in ((tension, TENSION), (~tension, COMPRESSION)):
            shapes = zip(self.edges[mask].tolist(), far[mask].tolist(), strict=True)
            shape = "".join(f"M{' '.join(map(_place, (a, b, d, c)))}Z" for (a, b), (c, d) in shapes)
            if shape:
                yield f'<path fill="{colour}" fill-opacity="0.45" stroke="none" d="{shape}"/>'

    def _marks(self, pixel: float) -> Iterable[str]:
        font = f'font-family="sans-serif" font-size="{decimal(17 * pixel, 4)}" fill="{TEXT_INK}"'
        for place, words in self.marked:
            x, y = place.real, -place.imag
            centre = f'cx="{decimal(x, 4)}" cy="{decimal(y, 4)}" r="{decimal(6 * pixel, 4)}"'
            yield f'<circle {centre} fill="none" stroke="{TEXT_INK}"/>'
            left = words.startswith("compression")
            side = -1.0 if left else 1.0
            anchor = "end" if left else "start"
            at = f'x="{decimal(x + side * 11 * pixel, 4)}" y="{decimal(y + 26 * pixel, 4)}"'
            yield f'<text {at} {font} text-anchor="{anchor}">{words}</text>'


def _place(point: complex) -> str:
    return f"{decimal(point.real)} {decimal(-point.imag)}"


def _arrows(loads: Plane, length: float, pixel: float) -> Iterable[str]:
    """Yield arrows that end at the contacts."""
    for place, direction in loads.tolist():
        tail, head = place - length * direction, place - 0.3 * length * direction
        side = 0.12j * length * direction
        line = f'stroke="{TEXT_INK}" stroke-width="{decimal(2.4 * pixel, 4)}"'
        yield f'<path fill="none" {line} d="M{_place(tail)}L{_place(head)}"/>'
        tip = f"M{_place(place)}L{_place(head + side)}L{_place(head - side)}Z"
        yield f'<path fill="{TEXT_INK}" stroke="none" d="{tip}"/>'


def _bar(foot: complex, top: float, most: float, size: float, pixel: float) -> Iterable[str]:
    """Yield the bar of colours with its numbers."""
    step = (top - foot.imag) / len(COLOURS)
    for number, colour in enumerate(COLOURS):
        at = f'x="{decimal(foot.real, 4)}" y="{decimal(-(foot.imag + (number + 1) * step), 4)}"'
        box = f'width="{decimal(_BAR * size, 4)}" height="{decimal(step, 4)}"'
        yield f'<rect {at} {box} fill="{colour}" stroke="none"/>'
    font = f'font-family="sans-serif" font-size="{decimal(16 * pixel, 4)}" fill="{TEXT_INK}"'
    x = decimal(foot.real + 1.3 * _BAR * size, 4)
    for share in (0.0, 0.25, 0.5, 0.75, 1.0):
        y = decimal(-(foot.imag + share * (top - foot.imag)) + 5 * pixel, 4)
        yield f'<text x="{x}" y="{y}" {font}>{formatted(share * most, 3)}</text>'
    words, height = "von Mises, MPa", decimal(-top - 14 * pixel, 4)
    left = decimal(foot.real + _BAR * size - GLYPH * 16 * pixel * len(words) / 2, 4)
    yield f'<text x="{left}" y="{height}" {font}>{words}</text>'
