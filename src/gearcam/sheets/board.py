"""The board: a sheet under construction, and the free space for its dimensions.

Drawn lines occupy cells of a grid of half millimetres of paper, texts those of another. A text is
placed where both grids are free; leaders never cross a text, and as few lines as possible. *Levels*
are the distances of linear dimensions from the view, so that they do not overlap.

Depends on drawings and sheets.
"""

from __future__ import annotations

import math
from dataclasses import dataclass, field, replace
from typing import Final

import numpy as np

from gearcam.base.numerals import decimal
from gearcam.numeric.arrays import Array, Ints, Mask, Plane, as_pairs, lengths_along
from gearcam.pictures.drawings import Feature, Path, Shape, chains
from gearcam.sheets.sheet import (
    ARROW_ROOM,
    CENTERLINE,
    DIMENSION,
    GAP,
    HEIGHT,
    TAIL,
    Box,
    Dimension,
    LinearDimension,
    RoundDimension,
    Text,
    along,
    as_drawn,
    text_box,
    text_width,
)

CELL: Final = 0.5
"""Cell size of the grids, mm of paper."""

LEVEL: Final = 9.0
FIRST_LEVEL: Final = 11.0
"""Distance of dimension lines, and of the first from the view, mm of paper."""

CLEAR: Final = 1.0
"""Clear margin around a text, mm of paper."""

TIGHT: Final = 2.0
"""Least difference between a circle's diameter and the text within, mm of paper."""

OVERHANG: Final = 3.0
"""Extension of centre lines beyond their circle, mm of paper."""

CROSSING: Final = 6.0
"""Penalty of a crossed line, as length of a leader, mm of paper."""

MOST: Final = 20
"""Largest number of a leader's cells on lines: more means that it runs along one."""

_REACHES: Final = np.concatenate([np.arange(5.0, 30.0, 2.5), np.arange(30.0, 160.0, 6.0)])
"""Lengths of leaders to try, mm of paper."""

AROUND: Final = np.radians(np.arange(7.5, 367.5, 7.5))
"""Directions to try for a leader that may have any."""


def _resampled(points: Plane, step: float, closed: bool) -> Plane:
    """Return points at most `step` apart along a chain, complex, mm."""
    chain = np.append(points, points[:1]) if closed else points
    ways = lengths_along(chain)
    count = max(2, math.ceil(ways[-1] / step) + 1)
    return np.interp(np.linspace(0.0, ways[-1], count), ways, chain)


@dataclass(eq=False, kw_only=True)
class Board:
    """A sheet under construction.

    Parameters
    ----------
    scale : float
        Millimetres of paper over millimetres of the part.
    area : complex, complex, mm of the part
        Area for the texts of the views, lower left and upper right corner.
    paper : str
        Its paper, such as ``A4``.
    corner : complex, mm of the part
        Lower left corner of the paper.
    features, dimensions, texts, rows : list
        As in `Sheet`.
    """

    scale: float
    area: Box
    paper: str = ""
    corner: complex = 0j
    features: list[Feature] = field(default_factory=list)
    dimensions: list[Dimension] = field(default_factory=list)
    texts: list[Text] = field(default_factory=list)
    rows: list[tuple[str, str]] = field(default_factory=list)

    def __post_init__(self) -> None:
        size = (self.area[1] - self.area[0]) * self.scale / CELL
        cells = math.ceil(size.real) + 1, math.ceil(size.imag) + 1
        self._lines = np.zeros(cells, dtype=bool)
        self._taken = np.zeros(cells, dtype=bool)
        self._step = 0.8 * CELL * self.unit

    @property
    def unit(self) -> float:
        """Millimetres of the part in a millimetre of paper."""
        return 1.0 / self.scale

    def draw(self, layer: str, shape: Shape) -> None:
        """Draw a `shape` on a `layer`."""
        self.features.append(Feature(layer=layer, shape=shape))
        for points, closed in chains(shape, 0.1 * self._step):
            self._ink(points, closed)

    def line(self, layer: str, start: complex, end: complex) -> None:
        """Draw a straight line on a `layer` from `start` to `end`, mm of the part."""
        self.draw(layer, Path(points=np.array([start, end], dtype=np.complex128), closed=False))

    def centre(self, place: complex, radius: float, gap: tuple[float, float] | None = None) -> None:
        """Draw centre lines over a circle.

        Parameters
        ----------
        place : complex, mm
            Its centre.
        radius : float, mm
            Its radius.
        gap : (float, float), mm of paper, optional
            Range from the centre where the upright line is left out, for a text.
        """
        arm = radius + OVERHANG * self.unit
        if gap is None:
            self.line(CENTERLINE, place - arm, place + arm)
            self.line(CENTERLINE, place - 1j * arm, place + 1j * arm)
            return
        low, high = (value * self.unit for value in gap)
        self.line(CENTERLINE, place - 1j * arm, place + 1j * low)
        if high < arm:
            self.line(CENTERLINE, place + 1j * high, place + 1j * arm)

    def write(self, text: Text) -> None:
        """Write a text at its place."""
        self.texts.append(text)
        self._take(text)

    def linear(
        self,
        first: complex,
        second: complex,
        at: float,
        *,
        vertical: bool = False,
        prefix: str = "",
    ) -> None:
        """Draw a linear dimension along x or y.

        Parameters
        ----------
        first, second : complex, mm
            The points.
        at : float, mm
            y of the dimension line, x of a vertical one.
        vertical : bool
            Whether it is measured along y.
        prefix : str
            Before the number.
        """
        low, high = sorted((along(first, vertical), along(second, vertical)))
        wide = text_width(prefix + decimal(high - low)) * self.unit
        middle = 0.5 * (low + high)
        if wide + 2 * GAP * self.unit > high - low:
            behind = TAIL if high - low < ARROW_ROOM * self.unit else GAP
            middle = high + (behind + GAP) * self.unit + 0.5 * wide
        above = (GAP + 0.5 * HEIGHT) * self.unit
        place = complex(at - above, middle) if vertical else complex(middle, at + above)
        line = complex(at, low) if vertical else complex(low, at)
        self._measure(
            LinearDimension(
                first=first,
                second=second,
                line=line,
                place=place,
                vertical=vertical,
                prefix=prefix,
            )
        )

    def round(self, dimension: RoundDimension, angles: Array | None = None) -> bool:
        """Draw a diameter or radius where there is space.

        Parameters
        ----------
        dimension : RoundDimension
            The dimension; its arrow and its knee are placed here.
        angles : (n,) array, rad, optional
            Allowed directions of the arrow; any by default.

        Returns
        -------
        bool
            False if there is no space: nothing is drawn, and the table must contain it.
        """
        placed: RoundDimension | None = dimension
        if not (dimension.diameter and angles is None and self._fits_inside(dimension)):
            reaches = _REACHES if dimension.diameter else np.concatenate([_REACHES, -_REACHES])
            placed = self._search(dimension, AROUND if angles is None else angles, reaches)
        if placed is not None:
            self._measure(placed)
        return placed is not None

    def label(self, point: complex, text: str) -> bool:
        """Write a text with a leader.

        Parameters
        ----------
        point : complex, mm
            Point of the leader's arrow.
        text : str
            The text.

        Returns
        -------
        bool
            False if there is no space: nothing is drawn.
        """
        wanted = RoundDimension(center=point, radius=0.1 * self.unit, words=text)
        placed = self._search(wanted, AROUND, _REACHES)
        if placed is None:
            return False
        drawn = as_drawn(placed, self.unit)
        leader, shelf = drawn.lines
        self.draw(DIMENSION, Path(points=np.append(leader, shelf[1:]), closed=False))
        self.draw(DIMENSION, Path(points=drawn.heads[0][[1, 0, 2]], closed=False))
        self.write(drawn.text)
        return True

    def _fits_inside(self, dimension: RoundDimension) -> bool:
        """Return whether a diameter's text has space in the middle of its circle."""
        if 2.0 * dimension.radius * self.scale - text_width(dimension.label) <= TIGHT:
            return False
        low, high = text_box(as_drawn(dimension, self.unit).text, self.unit)
        return bool(self._empty(np.array([low]), np.array([high]))[0])

    def _search(
        self, dimension: RoundDimension, angles: Array, reaches: Array
    ) -> RoundDimension | None:
        """Return the dimension with the best knee; None if there is no space for its text."""
        angle, reach = (axis.ravel() for axis in np.meshgrid(angles, reaches, indexing="ij"))
        spokes: Plane = np.exp(1j * angle)
        knees = dimension.radius + reach * self.unit
        at = np.asarray(dimension.center + knees * spokes, dtype=np.complex128)
        left = reach * spokes.real <= 0.0
        wide = text_width(dimension.label) * self.unit
        low = at - wide * left
        high = low + complex(wide, (HEIGHT + GAP) * self.unit)
        good = self._empty(low, high) & (knees > 0.0)
        best, least = None, math.inf
        for index in np.argsort(np.abs(reach), kind="stable").tolist():
            if abs(reach[index]) >= least:
                break
            if good[index]:
                edge = dimension.center + dimension.radius * complex(spokes[index])
                cost = abs(reach[index]) + CROSSING * self._crossed(edge, complex(at[index]))
                if cost < least:
                    best, least = index, cost
        if best is None:
            return None
        return replace(dimension, angle=float(angle[best]), knee=float(knees[best]))

    def _crossed(self, start: complex, end: complex) -> float:
        """Return the number of lines a leader crosses; infinite along one, or through a text."""
        way = end - start
        length = abs(way)
        skip = min(1.0, 2.0 * CELL * self.unit / length)
        count = max(2, math.ceil(length * self.scale / CELL))
        leader = np.linspace(skip, 1.0, count) * way
        cells, inside = self._cells(np.asarray(start + leader, dtype=np.complex128))
        if not inside.all() or self._taken[cells[:, 0], cells[:, 1]].any():
            return math.inf
        hits = int(self._lines[cells[:, 0], cells[:, 1]].sum())
        return float(hits) if hits <= MOST else math.inf

    def _cells(self, points: Plane) -> tuple[Ints, Mask]:
        """Return the cells of points, (n, 2), and which of them lie on the grid."""
        places = as_pairs(points - self.area[0]) * self.scale / CELL
        cells = np.floor(places).astype(np.int64)
        inside = np.logical_and.reduce((cells >= 0) & (cells < self._lines.shape), axis=1)
        return cells, inside

    def _empty(self, low: Plane, high: Plane) -> Mask:
        """Return which of n boxes, from corner to corner, are empty and lie in the area."""
        edge = CLEAR * self.unit * (1.0 + 1j)
        first, inside = self._cells(low - edge)
        last, also = self._cells(high + edge)
        sums = np.zeros(np.add(self._lines.shape, 1), dtype=np.int64)
        sums[1:, 1:] = (self._lines | self._taken).cumsum(axis=0).cumsum(axis=1)
        limit = np.array(self._lines.shape) - 1
        (i, j), (k, m) = np.clip(first, 0, limit).T, np.clip(last, 0, limit).T + 1
        held = sums[k, m] - sums[i, m] - sums[k, j] + sums[i, j]
        return inside & also & (held == 0)

    def _ink(self, points: Plane, closed: bool) -> None:
        cells, inside = self._cells(_resampled(points, self._step, closed))
        self._lines[cells[inside, 0], cells[inside, 1]] = True

    def _take(self, text: Text) -> None:
        low, high = text_box(text, self.unit)
        edge = CLEAR * self.unit * (1.0 + 1j)
        corners, _ = self._cells(np.array([low - edge, high + edge]))
        (i, j), (k, m) = np.clip(corners, 0, None)
        self._taken[i : k + 1, j : m + 1] = True

    def _measure(self, dimension: Dimension) -> None:
        self.dimensions.append(dimension)
        drawn = as_drawn(dimension, self.unit)
        for line in drawn.lines:
            self._ink(line, closed=False)
        self._take(drawn.text)
