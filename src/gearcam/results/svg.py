"""Charts with two logarithmic axes in one SVG file, drawn without matplotlib.

Points without a logarithm, such as an error of exactly 0, are left out.
"""

from __future__ import annotations

import math
from collections.abc import Iterator, Sequence
from functools import partial
from typing import Final
from xml.sax.saxutils import escape

import numpy as np

from gearcam.base.numerals import decimal
from gearcam.numeric.arrays import Array
from gearcam.pictures.charts import Chart, Line
from gearcam.pictures.markup import CENTRODE_INK, GROUND, TEXT_INK, svg_document

COLUMNS: Final = 2
"""Number of charts in a row."""

_WIDE, _HIGH = 480.0, 360.0
"""Width and height of a chart with its labels, pixels."""

_LEFT, _RIGHT, _ABOVE, _BELOW = 78.0, 16.0, 34.0, 48.0
"""Margins around the axes, pixels."""

_ROW: Final = 15.0
"""Height of a row of the legend, pixels."""

_INKS: Final = ("#27598c", "#c0562b", "#3c8043", "#8c3a7a", "#9a7b16", "#3f3f3f", "#2b8a97")
"""Colours of lines that remain distinct in print."""

_MOST_TICKS: Final = 8
"""Largest number of powers of ten on an axis."""

_SHORT: Final = 2
"""Number of decades up to which an axis has labels between powers of ten."""

_LEAST: Final = 1.2
"""Least number of decades on an axis, so that noise in run times does not fill the chart."""

_number: Final = partial(decimal, decimals=2)


def log_charts(title: str, charts: Sequence[Chart]) -> bytes:
    """Draw charts with two logarithmic axes.

    Parameters
    ----------
    title : str
        Title of the file.
    charts : sequence of Chart
        `COLUMNS` in a row; a line of one point is drawn as a single mark.

    Returns
    -------
    bytes
        SVG, UTF-8.
    """
    columns = min(COLUMNS, len(charts))
    wide, high = _WIDE * columns, _HIGH * math.ceil(len(charts) / columns)
    size = f'viewBox="0 0 {_number(wide)} {_number(high)}" width="{wide:.0f}" height="{high:.0f}"'
    font = f'font-family="sans-serif" font-size="12" fill="{TEXT_INK}"'
    drawn = [f'<rect width="{wide:.0f}" height="{high:.0f}" fill="{GROUND}"/>', f"<g {font}>"]
    for number, chart in enumerate(charts):
        row, column = divmod(number, columns)
        drawn.append(f'<g transform="translate({_number(column * _WIDE)} {_number(row * _HIGH)})">')
        drawn += [*_chart(chart), "</g>"]
    return svg_document(f'{size} role="img"', title, [*drawn, "</g>"])


def _chart(chart: Chart) -> Iterator[str]:
    seen = [_seen(line) for line in chart.lines]
    x, y = (np.concatenate([points[axis] for points in seen]) for axis in (0, 1))
    across = _Axis(x, _LEFT, _WIDE - _RIGHT)
    top = _ABOVE + (_ROW * len(chart.lines) if len(chart.lines) > 1 else 0.0)
    up = _Axis(y, _HIGH - _BELOW, top)
    yield _text(_LEFT, 20.0, chart.title, 'font-weight="bold"')
    yield _text(0.5 * (_LEFT + _WIDE - _RIGHT), _HIGH - 10.0, chart.x, 'text-anchor="middle"')
    turn = f'text-anchor="middle" transform="rotate(-90 14 {_number(0.5 * _HIGH)})"'
    yield _text(14.0, 0.5 * _HIGH, chart.y, turn)
    for tick in across.ticks:
        place = across(tick)
        yield _grid(place, top, place, _HIGH - _BELOW)
        yield _text(place, _HIGH - _BELOW + 16.0, _label(tick), 'text-anchor="middle"')
    for tick in up.ticks:
        place = up(tick)
        yield _grid(_LEFT, place, _WIDE - _RIGHT, place)
        yield _text(_LEFT - 6.0, place + 4.0, _label(tick), 'text-anchor="end"')
    for number, (line, points) in enumerate(zip(chart.lines, seen, strict=True)):
        ink = _INKS[number % len(_INKS)]
        places = [(across(a), up(b)) for a, b in points.T.tolist()]
        if not line.dots and len(places) > 1:
            path = " ".join(f"{_number(a)} {_number(b)}" for a, b in places)
            yield f'<path fill="none" stroke="{ink}" stroke-width="1.5" d="M{path}"/>'
        for a, b in places:
            mark = f'cx="{_number(a)}" cy="{_number(b)}"'
            yield f'<circle {mark} r="{6 if line.dots else 3}" {_fill(line, ink)}/>'
    if len(chart.lines) > 1:
        yield from _legend(chart.lines)


def _legend(lines: Sequence[Line]) -> Iterator[str]:
    """Yield the legend, above the axes."""
    for number, line in enumerate(lines):
        y, ink = _ABOVE + _ROW * number, _INKS[number % len(_INKS)]
        x = _LEFT + 6.0
        yield _text(x + 10.0, y + 4.0, line.label, f'style="fill:{ink}"')
        yield f'<circle cx="{_number(x)}" cy="{_number(y)}" r="4" {_fill(line, ink)}/>'


def _fill(line: Line, ink: str) -> str:
    """Return the style of marks: filled on a line, rings around single values."""
    return f'fill="none" stroke="{ink}" stroke-width="1.5"' if line.dots else f'fill="{ink}"'


class _Axis:
    """A logarithmic axis from `first` to `last`, pixels, that spans the `values`."""

    def __init__(self, values: Array, first: float, last: float) -> None:
        ends = np.log10([values.min(), values.max()]) if values.size else np.array([0.0, 1.0])
        low, high = ends.tolist()
        free = max(0.06 * (high - low), 0.5 * (_LEAST - (high - low)))
        self._low, self._high = low - free, high + free
        self._first, self._last = first, last

    def __call__(self, value: float) -> float:
        share = (math.log10(value) - self._low) / (self._high - self._low)
        return self._first + share * (self._last - self._first)

    @property
    def ticks(self) -> list[float]:
        """Powers of ten, few enough to label; on a short axis also times 2 and 5."""
        low, high = math.floor(self._low), math.floor(self._high)
        if high - low <= _SHORT:
            made = [
                part * 10.0**power for power in range(low, high + 1) for part in (1.0, 2.0, 5.0)
            ]
        else:
            step = math.ceil((high - low + 1) / _MOST_TICKS)
            made = [10.0**power for power in range(low, high + 1, step)]
        return [tick for tick in made if self._low <= math.log10(tick) <= self._high]


def _label(tick: float) -> str:
    mantissa, power = f"{tick:.0e}".split("e")
    return f"{mantissa}e{int(power)}"


def _seen(line: Line) -> Array:
    """Return the points of a line that have logarithms, (2, n)."""
    points = np.array([line.x, line.y], dtype=float)
    return points[:, np.all(np.isfinite(points) & (points > 0.0), axis=0)]


def _grid(x1: float, y1: float, x2: float, y2: float) -> str:
    ends = f'x1="{_number(x1)}" y1="{_number(y1)}" x2="{_number(x2)}" y2="{_number(y2)}"'
    return f'<line {ends} stroke="{CENTRODE_INK}" stroke-opacity="0.25"/>'


def _text(x: float, y: float, text: str, more: str = "") -> str:
    return f'<text x="{_number(x)}" y="{_number(y)}" {more}>{escape(text)}</text>'
