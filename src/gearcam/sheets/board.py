"""The board: a sheet under construction, and the free space for its dimensions.

Drawn lines occupy cells of a grid of half millimetres of paper, texts those of another. A text is
placed where both grids are free; leaders never cross a text, and as few lines as possible. *Levels*
are the distances of linear dimensions from the view, short ones nearest, so that they do not
overlap.

Depends on drawings and sheets.
"""

from __future__ import annotations

import math
from collections.abc import Iterable, Sequence
from dataclasses import dataclass
from functools import cached_property
from typing import Final

import numpy as np

from gearcam.numeric.arrays import Array, Ints, Mask, Plane, as_pairs, lengths_along
from gearcam.pictures.drawings import Circle, Feature, Path, Shape, chains
from gearcam.sheets.dimensions import SHELF, UPRIGHT, Measure, arrow_head, leader, linear, shelf
from gearcam.sheets.sheet import CENTERLINE, Box, Hatch, Sheet, SheetDimension, Text

CELL: Final = 0.5
"""Cell size of the grids, mm of paper."""

LEVEL: Final = 8.0
FIRST_LEVEL: Final = 11.0
"""Distance of dimension lines, and of the first from the view, mm of paper."""

CLEAR: Final = 1.0
"""Clear margin around a text, mm of paper."""

BESIDE: Final = 4.0
"""That beside a text, which is not to read on as another, over the one above it."""

OVERHANG: Final = 3.0
"""Extension of centre lines beyond their circle, mm of paper."""

CROSSING: Final = 6.0
"""Penalty of a crossed line, as length of a leader, mm of paper."""

STEEP: Final = 15.0
"""Penalty of an upright leader, as its length: programs that draw dimensions anew turn texts along
the leader, mm of paper."""

MOST: Final = 20
"""Largest number of a leader's cells on lines: more means that it runs along one."""

_REACHES: Final = np.concatenate([np.arange(5.0, 30.0, 2.5), np.arange(30.0, 160.0, 6.0)])
"""Lengths of leaders to try, mm of paper."""

AROUND: Final = np.radians(np.arange(7.5, 367.5, 7.5))
"""Directions to try for a leader that may have any."""


@dataclass(frozen=True, eq=False, kw_only=True)
class Board(Sheet):
    """A sheet under construction.

    Parameters
    ----------
    title : str
        Empty until it is finished.
    area : complex, complex, mm of the part
        Area for the texts of the views, lower left and upper right corner.
    """

    title: str = ""
    area: Box

    @cached_property
    def _grids(self) -> Mask:
        """The cells of lines, and those of texts."""
        size = (self.area[1] - self.area[0]) * self.scale / CELL
        return np.zeros((2, math.ceil(size.real) + 1, math.ceil(size.imag) + 1), dtype=bool)

    def draw(self, layer: str, shape: Shape) -> None:
        """Draw a `shape` on a `layer`."""
        self.features.append(Feature(layer=layer, shape=shape))
        for points, closed in chains(shape, 0.08 * CELL * self.unit):
            self._ink(np.append(points, points[:1]) if closed else points)

    def line(self, layer: str, *points: complex, closed: bool = False) -> None:
        """Draw straight lines on a `layer` between `points`, mm of the part, back if `closed`."""
        self.draw(layer, Path(points=np.array(points, dtype=np.complex128), closed=closed))

    def hatch(self, loops: Sequence[Plane]) -> None:
        """Draw cut metal within closed `loops`, mm of the part; no text has space on it."""
        if loops:
            made = Hatch(loops=tuple(loops))
            self.hatches.append(made)
            for line in made.lines(2.0 * self.unit):
                self._ink(line)

    def arrow(self, tip: complex, way: complex, size: float = 1.0) -> None:
        """Draw an arrow head of a `size`, 1 is usual, at `tip`, mm, along the unit vector `way`."""
        self.fills.append(arrow_head(tip, way, size * self.unit))

    def centre(self, circle: Circle) -> None:
        """Draw centre lines over a circle."""
        arm, middle = 0.5 * circle.diameter + OVERHANG * self.unit, circle.center
        self.line(CENTERLINE, middle - arm, middle + arm)
        self.line(CENTERLINE, middle - 1j * arm, middle + 1j * arm)

    def write(self, text: Text) -> None:
        """Write a text at its place."""
        self.texts.append(text)
        self.take(*text.box(self.unit))

    def first_free(self, texts: Iterable[Text]) -> None:
        """Write the first of several `texts` that has space, or else the first."""
        given = list(texts)
        boxes = [one.box(self.unit) for one in given]
        free = self._empty(np.array([low for low, _ in boxes]), np.array([b for _, b in boxes]))
        self.write(given[int(np.argmax(free))])

    def measure(
        self, measures: Sequence[Measure], at: float, *, side: int = -1, vertical: bool = False
    ) -> None:
        """Draw linear dimensions along x or y, each on a level, short ones nearest.

        Parameters
        ----------
        measures : sequence of Measure
            What to measure.
        at : float, mm
            y of the edge of the view, x if `vertical`.
        side : {-1, 1}
            Whether the levels are below or left of it, or above or right of it.
        vertical : bool
            Whether they are measured along y.
        """
        beyond = max((end for one in measures for end in one.ends(vertical)), default=0.0)
        for number, one in enumerate(sorted(measures, key=lambda one: one.length(vertical))):
            level = at + side * (FIRST_LEVEL + LEVEL * number) * self.unit
            self.add(linear(one, level, self.unit, beyond, vertical=vertical))

    def add(self, dimension: SheetDimension) -> None:
        """Draw a dimension."""
        self.dimensions.append(dimension)
        for line in dimension.lines:
            self._ink(line)
        self.take(*dimension.text.box(self.unit))

    def callout(
        self,
        circle: Circle,
        text: str,
        kind: str = "diameter",
        *,
        angles: Array | None = None,
        row: tuple[str, str] | None = None,
    ) -> bool:
        """Draw a diameter, a radius, or a text with a leader, where there is space.

        Parameters
        ----------
        circle : Circle
            What the arrow points to.
        text : str
            The text.
        kind : {"diameter", "radius", "label"}
            What it is.
        angles : (n,) array, rad, optional
            Allowed directions of the arrow; any by default.
        row : (str, str), optional
            What the table says instead if there is no space.

        Returns
        -------
        bool
            Whether there is space.
        """
        reaches = np.concatenate([_REACHES, -_REACHES]) if kind == "radius" else _REACHES
        found = self.place(circle, complex(shelf(text), SHELF), angles, reaches)
        if found:
            self.add(leader(circle, *found, text, kind, self.unit))
        elif row:
            self.rows.append(row)
        return found is not None

    def label(
        self,
        point: complex,
        text: str,
        row: tuple[str, str] | None = None,
        *,
        angles: Array | None = None,
    ) -> bool:
        """Return whether a `text` with a leader to a `point`, mm, is drawn (see `callout`)."""
        spot = Circle(center=point, diameter=0.02 * self.unit)
        return self.callout(spot, text, "label", row=row, angles=angles)

    def place(
        self, circle: Circle, size: complex, angles: Array | None = None, reaches: Array = _REACHES
    ) -> tuple[float, float] | None:
        """Return where the leader to a circle bends below a box; None without space for it.

        Parameters
        ----------
        circle : Circle
            What the arrow points to.
        size : complex, mm of paper
            Width and height of the box, which lies on the leader's shelf.
        angles : (n,) array, rad, optional
            Allowed directions of the arrow; any by default.
        reaches : (n,) array, mm of paper
            Allowed lengths of the leader; negative ones lie within the circle.

        Returns
        -------
        (float, float) or None
            Its direction, rad, and the distance of the bend from the centre, mm.
        """
        radius = 0.5 * circle.diameter
        grid = np.meshgrid(AROUND if angles is None else angles, reaches, indexing="ij")
        angle, reach = (axis.ravel() for axis in grid)
        spokes: Plane = np.exp(1j * angle)
        knees = radius + reach * self.unit
        at = np.asarray(circle.center + knees * spokes, dtype=np.complex128)
        left = reach * spokes.real <= UPRIGHT
        low = at - size.real * self.unit * left
        good = self._empty(low, low + size * self.unit) & (knees > 0.0)
        best, least = None, math.inf
        for index in np.argsort(np.abs(reach), kind="stable").tolist():
            if abs(reach[index]) >= least:
                break
            if good[index]:
                edge = circle.center + radius * complex(spokes[index])
                cost = abs(reach[index]) + STEEP * abs(float(spokes[index].imag))
                cost += CROSSING * self._crossed(edge, complex(at[index]))
                if cost < least:
                    best, least = index, cost
        return None if best is None else (float(angle[best]), float(knees[best]))

    def _crossed(self, start: complex, end: complex) -> float:
        """Return the number of lines a leader crosses; infinite along one, or through a text."""
        way = end - start
        length = abs(way)
        skip = min(1.0, 2.0 * CELL * self.unit / length)
        count = max(2, math.ceil(length * self.scale / CELL))
        on_way = np.linspace(skip, 1.0, count) * way
        cells, inside = self._cells(np.asarray(start + on_way, dtype=np.complex128))
        if not inside.all():
            return math.inf
        hits, texts = self._grids[:, cells[:, 0], cells[:, 1]].sum(axis=1).tolist()
        return float(hits) if hits <= MOST and not texts else math.inf

    def _cells(self, points: Plane) -> tuple[Ints, Mask]:
        """Return the cells of points, (n, 2), and which of them lie on the grid."""
        places = as_pairs(points - self.area[0]) * self.scale / CELL
        cells = np.floor(places).astype(np.int64)
        inside = np.logical_and.reduce((cells >= 0) & (cells < self._grids.shape[1:]), axis=1)
        return cells, inside

    def _empty(self, low: Plane, high: Plane) -> Mask:
        """Return which of n boxes, from corner to corner, are empty and lie in the area."""
        edge = CLEAR * self.unit * (1.0 + 1j)
        first, inside = self._cells(low - edge)
        last, also = self._cells(high + edge)
        sums = np.pad(self._grids.any(axis=0).cumsum(axis=0).cumsum(axis=1), ((1, 0), (1, 0)))
        limit = np.array(sums.shape) - 2
        (i, j), (k, m) = np.clip(first, 0, limit).T, np.clip(last, 0, limit).T + 1
        held = sums[k, m] - sums[i, m] - sums[k, j] + sums[i, j]
        return inside & also & (held == 0)

    def _ink(self, chain: Plane) -> None:
        ways = lengths_along(chain)
        count = max(2, math.ceil(ways[-1] * self.scale / (0.8 * CELL)) + 1)
        points = np.interp(np.linspace(0.0, ways[-1], count), ways, chain)
        cells, inside = self._cells(points)
        self._grids[0, cells[inside, 0], cells[inside, 1]] = True

    def take(self, low: complex, high: complex) -> None:
        """Keep texts and leaders from a box.

        Parameters
        ----------
        low, high : complex, mm
            Its lower left and its upper right corner.
        """
        size = high - low
        edge = CLEAR * self.unit * (BESIDE + 1j if size.real > size.imag else 1.0 + BESIDE * 1j)
        corners, _ = self._cells(np.array([low - edge, high + edge]))
        (i, j), (k, m) = np.clip(corners, 0, None)
        self._grids[1, i : k + 1, j : m + 1] = True
