"""Charts as data, and their drawing with matplotlib.

A *chart* has one horizontal axis, *lines* over it, *limits* for their values, and *marked places*
on the axis, such as the knots of a law. Either axis can be logarithmic; what is not positive is not
drawn there. The folder of each kind of design defines its charts (see `gearcam.designs.kind`).
Drawing needs matplotlib, which the extra ``plot`` installs.
"""

from __future__ import annotations

import math
from collections.abc import Callable, Mapping, Sequence
from dataclasses import dataclass
from typing import TYPE_CHECKING, Any, Final

import numpy as np

from gearcam.base.errors import MissingExtraError
from gearcam.base.numerals import formatted
from gearcam.numeric.arrays import Array

if TYPE_CHECKING:
    from matplotlib.axes import Axes

_FAR: Final = 1.5
"""Largest distance of a limit drawn from the lines, relative to their range."""

_MARGIN: Final = 0.06
"""Margin above and below the lines, and beside dots, relative to the range."""

_DECADES: Final = 1.2
"""Least number of decades on a logarithmic axis, so that noise does not fill the chart."""

_SMALL: Final = 3.0
"""Width of axes, inches, below which a legend would cover too much of them."""

_MOST_KNOTS: Final = 36
"""Largest number of knots that are marked: one in ten degrees."""

_SHORT: Final = 2.5
"""Number of decades up to which a logarithmic axis has labels between powers of ten."""


@dataclass(frozen=True, eq=False, kw_only=True)
class Line:
    """A line of a chart.

    Parameters
    ----------
    label : str
        Name in the legend.
    x, y : (n,) arrays
        Coordinates in the units of the axes; NaN interrupts the line.
    dots : bool
        Whether to draw single points instead of a line.
    """

    label: str
    x: Array
    y: Array
    dots: bool = False


@dataclass(frozen=True, kw_only=True)
class Limit:
    """A limit for the values of the lines.

    Parameters
    ----------
    label : str
        Name in the legend.
    value : float
        In the unit of the vertical axis.
    """

    label: str
    value: float


@dataclass(frozen=True, kw_only=True)
class MarkedPlace:
    """A place on the horizontal axis.

    Parameters
    ----------
    label : str
        Name in the legend, the same for all places of one sort.
    value : float
        In the unit of the horizontal axis.
    """

    label: str
    value: float


@dataclass(frozen=True, kw_only=True)
class Handle:
    """A place on a chart that numbers of the design file set: the live view drags it.

    Parameters
    ----------
    x, y : float
        In the units of the axes.
    keys : mapping of str to (float, float)
        By key the change of each number, in its unit, as it moves by a unit of the horizontal and
        of the vertical axis.
    """

    x: float
    y: float
    keys: Mapping[str, tuple[float, float]]


@dataclass(frozen=True, eq=False, kw_only=True)
class Chart:
    """A chart: lines over an angle or a number, with limits.

    Parameters
    ----------
    title : str
        Title of the chart.
    x, y : str
        Labels of the axes, with units.
    lines : tuple of Line
        At least one line.
    limits : tuple of Limit
        Limits for the lines.
    marks : tuple of MarkedPlace
        Marked places on the horizontal axis.
    log : str
        Logarithmic axes: ``x``, ``y`` or ``xy``.
    equal : bool
        Whether both axes have one scale, as of a curve in the plane.
    handles : tuple of Handle
        Places that numbers of the design file set.
    """

    title: str
    x: str
    y: str
    lines: tuple[Line, ...]
    limits: tuple[Limit, ...] = ()
    marks: tuple[MarkedPlace, ...] = ()
    log: str = ""
    equal: bool = False
    handles: tuple[Handle, ...] = ()

    def __repr__(self) -> str:
        return f"<Chart of {self.title}: {', '.join(line.label for line in self.lines)}>"

    def draw(self, ax: Axes | None = None) -> Axes:
        """Draw the chart with matplotlib.

        Parameters
        ----------
        ax : Axes, optional
            Axes to draw into; a new figure by default.

        Returns
        -------
        Axes
            With title, labels, limits, marked places and legend, which is beside small axes: a
            figure with ``layout="constrained"`` makes room for it.

        Raises
        ------
        MissingExtraError
            If matplotlib is not installed.
        """
        ax = _new_axes() if ax is None else ax
        if self.log:
            _set_logarithmic(ax, self.log)
        for line in self.lines:
            ax.plot(line.x, line.y, label=line.label, **(_dots(len(line.x)) if line.dots else {}))
        low, high = self.range
        for limit in self.limits:
            text = f"{limit.label}: {formatted(limit.value)}"
            if low <= limit.value <= high:
                ax.axhline(limit.value, color="0.35", ls="--", lw=1.0, label=text)
            else:
                ax.plot([], [], color="0.35", ls=" ", label=f"{text}, outside this chart")
        named: set[str] = set()
        for mark in self.marks:  # one legend entry for each sort
            label = None if mark.label in named else mark.label
            ax.axvline(mark.value, color="0.5", ls=":", lw=0.8, label=label)
            named.add(mark.label)
        ax.set(title=self.title, xlabel=self.x, ylabel=self.y, xlim=self.ends[0], ylim=self.ends[1])
        if self.equal:
            ax.set_aspect("equal", adjustable="datalim")
        ax.grid(visible=True, alpha=0.3)
        if self.limits or self.marks or len(self.lines) > 1:
            small = ax.get_window_extent().width < _SMALL * ax.figure.dpi
            beside = {"loc": "upper left", "bbox_to_anchor": (1.0, 1.0)} if small else {}
            ax.legend(fontsize="small", **beside)
        return ax

    @property
    def range(self) -> tuple[float, float]:
        """Smallest and largest value of all lines and of the limits near them.

        The range of a constant line is widened.
        """
        low, high = ends = _range([line.y for line in self.lines], "y" in self.log)
        least, most = _extended(ends, _FAR, "y" in self.log)
        seen = [limit.value for limit in self.limits if least <= limit.value <= most]
        return min(low, *seen, low), max(high, *seen, high)

    @property
    def ends(self) -> tuple[tuple[float, float], tuple[float, float]]:
        """The ends of the horizontal and of the vertical axis: the ranges with their margins."""
        across = _range([line.x for line in self.lines], "x" in self.log)
        dots = any(line.dots for line in self.lines)
        return (
            _extended(across, _MARGIN if dots else 0.0, "x" in self.log),
            _extended(self.range, _MARGIN, "y" in self.log),
        )


def _range(columns: Sequence[Array], log: bool) -> tuple[float, float]:
    """Return the smallest and the largest of values on an axis, apart from each other."""
    values = np.concatenate(columns)
    values = values[np.isfinite(values) & (values > (0.0 if log else -math.inf))]
    low, high = (float(values.min()), float(values.max())) if values.size else (1.0 * log,) * 2
    if log:
        factor = math.sqrt(max(1.0, 10.0**_DECADES * low / high))
        return low / factor, high * factor
    room = 0.0 if high - low > 1e-9 * max(abs(low), abs(high)) else 0.05 * abs(high) or 1.0
    return low - room, high + room


def _extended(ends: tuple[float, float], share: float, log: bool) -> tuple[float, float]:
    """Return a range extended on both sides by a `share` of its length on the axis."""
    low, high = ends
    if log:
        factor = (high / low) ** share
        return low / factor, high * factor
    return low - share * (high - low), high + share * (high - low)


def knot_marks(knots: Array, low: float, high: float) -> tuple[MarkedPlace, ...]:
    """Return marks at the `knots` between `low` and `high` on an axis; none if too many."""
    inside = knots[(knots > low) & (knots < high)]
    seen = inside.tolist() if len(inside) <= _MOST_KNOTS else []
    return tuple(MarkedPlace(label="knots", value=value) for value in seen)


Charts = Mapping[str, Callable[[Any], Chart | None]]
"""Functions that return the charts of a result, by name: None where a chart would say nothing."""


def _dots(count: int) -> dict[str, Any]:
    """Return the style of dots: small if many, large if one, which marks one of others."""
    size = 14.0 if count == 1 else min(9.0, max(3.0, 120.0 / max(count, 1)))
    return {"ls": "", "marker": ".", "ms": size, "zorder": 1.9}  # below the lines


def _set_logarithmic(ax: Axes, log: str) -> None:
    """Set logarithmic scales, with ticks at powers of ten and their double and fivefold."""
    from matplotlib.ticker import LogFormatterSciNotation

    for name in log:
        set_scale, axis = (ax.set_xscale, ax.xaxis) if name == "x" else (ax.set_yscale, ax.yaxis)
        set_scale("log", subs=(2, 5), nonpositive="mask")
        axis.set_minor_formatter(LogFormatterSciNotation(minor_thresholds=(_SHORT, _SHORT)))


def _new_axes() -> Axes:
    try:
        import matplotlib.pyplot as plt
    except ImportError as error:
        raise MissingExtraError("charts", "plot") from error
    _, ax = plt.subplots(layout="constrained")
    return ax
