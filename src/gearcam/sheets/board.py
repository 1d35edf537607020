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
from gearcam.numeric.arrays import Array, Ints, Mask
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


def _resampled(points: Array, step: float, closed: bool) -> Array:
    """Return points at most `step` apart along a chain, (n, 2), mm."""
    chain = np.vstack([points, points[:1]]) if closed else points
    ways = np.concatenate([[0.0], np.cumsum(np.hypot(*np.diff(chain, axis=0).T))])
    count = max(2, math.ceil(ways[-1] / step) + 1)
    at = np.linspace(0.0, ways[-1], count)
    return np.column_stack([np.interp(at, ways, chain[:, k]) for k in (0, 1)])


@dataclass(eq=False, kw_only=True)
class Board:
    """A sheet under construction.

    Parameters
    ----------
    scale : float
        Millimetres of paper over millimetres of the part.
    area : (2,) array, (2,) array, mm of the part
        Area for the texts of the views, lower left and upper right corner.
    paper : str
        Its paper, such as ``A4``.
    corner : (2,) array, mm of the part
        Lower left corner of the paper.
    features, dimensions, texts, rows : list
        As in `Sheet`.
    """

    scale: float
    area: Box
    paper: str = ""
    corner: Array = field(default_factory=lambda: np.zeros(2))
    features: list[Feature] = field(default_factory=list)
    dimensions: list[Dimension] = field(default_factory=list)
    texts: list[Text] = field(default_factory=list)
    rows: list[tuple[str, str]] = field(default_factory=list)

    def __post_init__(self) -> None:
        size = np.ceil((self.area[1] - self.area[0]) * self.scale / CELL).astype(int) + 1
        self._lines = np.zeros(size, dtype=bool)
        self._taken = np.zeros(size, dtype=bool)
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

    def line(self, layer: str, start: tuple[float, float], end: tuple[float, float]) -> None:
        """Draw a straight line on a `layer` from `start` to `end`, mm of the part."""
        self.draw(layer, Path(points=np.array([start, end], dtype=np.float64), closed=False))

    def centre(self, place: Array, radius: float, gap: tuple[float, float] | None = None) -> None:
        """Draw centre lines over a circle.

        Parameters
        ----------
        place : (2,) array, mm
            Its centre.
        radius : float, mm
            Its radius.
        gap : (float, float), mm of paper, optional
            Range from the centre where the upright line is left out, for a text.
        """
        (x, y), arm = place.tolist(), radius + OVERHANG * self.unit
        if gap is None:
            self.line(CENTERLINE, (x - arm, y), (x + arm, y))
            self.line(CENTERLINE, (x, y - arm), (x, y + arm))
            return
        low, high = (y + value * self.unit for value in gap)
        self.line(CENTERLINE, (x, y - arm), (x, low))
        if high < y + arm:
            self.line(CENTERLINE, (x, high), (x, y + arm))

    def write(self, text: Text) -> None:
        """Write a text at its place."""
        self.texts.append(text)
        self._take(text)

    def linear(
        self,
        first: tuple[float, float] | Array,
        second: tuple[float, float] | Array,
        at: float,
        *,
        vertical: bool = False,
        prefix: str = "",
    ) -> None:
        """Draw a linear dimension along x or y.

        Parameters
        ----------
        first, second : (2,) array, mm
            The points.
        at : float, mm
            y of the dimension line, x of a vertical one.
        vertical : bool
            Whether it is measured along y.
        prefix : str
            Before the number.
        """
        ends = np.array([first, second], dtype=np.float64)
        along = int(vertical)
        low, high = np.sort(ends[:, along])
        wide = text_width(prefix + decimal(float(high - low))) * self.unit
        place = np.full(2, at)
        place[1 - along] += (GAP + 0.5 * HEIGHT) * self.unit * (-1.0 if vertical else 1.0)
        place[along] = 0.5 * (low + high)
        if wide + 2 * GAP * self.unit > high - low:
            behind = TAIL if high - low < ARROW_ROOM * self.unit else GAP
            place[along] = high + (behind + GAP) * self.unit + 0.5 * wide
        line = np.full(2, at)
        line[along] = low
        self._measure(
            LinearDimension(
                first=ends[0], second=ends[1], line=line, place=place, vertical=vertical,
                prefix=prefix,
            )
        )  # fmt: skip

    def round(self, made: RoundDimension, angles: Array | None = None) -> bool:
        """Draw a diameter or radius where there is space.

        Parameters
        ----------
        made : RoundDimension
            The dimension; its arrow and its knee are placed here.
        angles : (n,) array, rad, optional
            Allowed directions of the arrow; any by default.

        Returns
        -------
        bool
            False if there is no space: nothing is drawn, and the table must contain it.
        """
        found: RoundDimension | None = made
        if not (made.diameter and angles is None and self._fits_inside(made)):
            reaches = _REACHES if made.diameter else np.concatenate([_REACHES, -_REACHES])
            found = self._search(made, AROUND if angles is None else angles, reaches)
        if found is not None:
            self._measure(found)
        return found is not None

    def label(self, point: Array, text: str) -> bool:
        """Write a text with a leader.

        Parameters
        ----------
        point : (2,) array, mm
            Point of the leader's arrow.
        text : str
            The text.

        Returns
        -------
        bool
            False if there is no space: nothing is drawn.
        """
        made = RoundDimension(center=point, radius=0.1 * self.unit, words=text)
        found = self._search(made, AROUND, _REACHES)
        if found is None:
            return False
        drawn = as_drawn(found, self.unit)
        leader, shelf = drawn.lines
        self.draw(DIMENSION, Path(points=np.vstack([leader, shelf[1:]]), closed=False))
        self.draw(DIMENSION, Path(points=drawn.heads[0][[1, 0, 2]], closed=False))
        self.write(drawn.text)
        return True

    def _fits_inside(self, made: RoundDimension) -> bool:
        """Return whether a diameter's text has space in the middle of its circle."""
        if 2.0 * made.radius * self.scale - text_width(made.label) <= TIGHT:
            return False
        low, high = text_box(as_drawn(made, self.unit).text, self.unit)
        return bool(self._empty(low[None, :], high[None, :])[0])

    def _search(self, made: RoundDimension, angles: Array, reaches: Array) -> RoundDimension | None:
        """Return the dimension with the best knee; None if there is no space for its text."""
        angle, reach = (axis.ravel() for axis in np.meshgrid(angles, reaches, indexing="ij"))
        spokes = np.column_stack([np.cos(angle), np.sin(angle)])
        knees = made.radius + reach * self.unit
        at = made.center + knees[:, None] * spokes
        left = reach * spokes[:, 0] <= 0.0
        wide = text_width(made.label) * self.unit
        low = np.column_stack([at[:, 0] - wide * left, at[:, 1]])
        high = low + np.array([wide, (HEIGHT + GAP) * self.unit])
        good = self._empty(low, high) & (knees > 0.0)
        best, least = None, math.inf
        for index in np.argsort(np.abs(reach), kind="stable").tolist():
            if abs(reach[index]) >= least:
                break
            if good[index]:
                edge = made.center + made.radius * spokes[index]
                cost = abs(reach[index]) + CROSSING * self._crossed(edge, at[index])
                if cost < least:
                    best, least = index, cost
        if best is None:
            return None
        return replace(made, angle=float(angle[best]), knee=float(knees[best]))

    def _crossed(self, start: Array, end: Array) -> float:
        """Return the number of lines a leader crosses; infinite along one, or through a text."""
        way = end - start
        length = float(np.hypot(*way))
        skip = min(1.0, 2.0 * CELL * self.unit / length)
        count = max(2, math.ceil(length * self.scale / CELL))
        cells, inside = self._cells(start + np.linspace(skip, 1.0, count)[:, None] * way)
        if not inside.all() or self._taken[cells[:, 0], cells[:, 1]].any():
            return math.inf
        hits = int(self._lines[cells[:, 0], cells[:, 1]].sum())
        return float(hits) if hits <= MOST else math.inf

    def _cells(self, points: Array) -> tuple[Ints, Mask]:
        """Return the cells of points, and which of them lie on the grid."""
        cells = np.floor((points - self.area[0]) * self.scale / CELL).astype(np.int64)
        inside = np.logical_and.reduce((cells >= 0) & (cells < self._lines.shape), axis=1)
        return cells, inside

    def _empty(self, low: Array, high: Array) -> Mask:
        """Return which of some boxes, (n, 2) each, are empty and lie in the area."""
        edge = CLEAR * self.unit
        first, inside = self._cells(low - edge)
        last, also = self._cells(high + edge)
        sums = np.zeros(np.add(self._lines.shape, 1), dtype=np.int64)
        sums[1:, 1:] = (self._lines | self._taken).cumsum(axis=0).cumsum(axis=1)
        limit = np.array(self._lines.shape) - 1
        (i, j), (k, m) = np.clip(first, 0, limit).T, np.clip(last, 0, limit).T + 1
        held = sums[k, m] - sums[i, m] - sums[k, j] + sums[i, j]
        return inside & also & (held == 0)

    def _ink(self, points: Array, closed: bool) -> None:
        cells, inside = self._cells(_resampled(points, self._step, closed))
        self._lines[cells[inside, 0], cells[inside, 1]] = True

    def _take(self, text: Text) -> None:
        low, high = text_box(text, self.unit)
        edge = CLEAR * self.unit
        corners, _ = self._cells(np.array([low - edge, high + edge]))
        (i, j), (k, m) = np.clip(corners, 0, None)
        self._taken[i : k + 1, j : m + 1] = True

    def _measure(self, dimension: Dimension) -> None:
        self.dimensions.append(dimension)
        drawn = as_drawn(dimension, self.unit)
        for line in drawn.lines:
            self._ink(line, closed=False)
        self._take(drawn.text)
