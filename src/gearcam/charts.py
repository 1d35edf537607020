"""Charts: what is drawn over an angle, as data, and their drawing.

A *chart* has one horizontal axis, *lines* over it, the *limits* that they are held against, and
*marked places* on the axis, such as the knots of a law. The folder of a kind makes its charts from
the arrays of a result (see `gearcam.designs.kind`); nothing here knows what they tell of. Drawing
needs matplotlib, which the extra ``plot`` brings.
"""

from __future__ import annotations

from collections.abc import Callable, Mapping
from dataclasses import dataclass
from typing import TYPE_CHECKING, Any, Final

import numpy as np

from gearcam.errors import MissingExtraError
from gearcam.numerals import shown
from gearcam.numeric.arrays import Array

if TYPE_CHECKING:
    from matplotlib.axes import Axes

_FAR: Final = 1.5
"""How far outside the lines a limit may be drawn, in their range: beyond, it would flatten them."""

_MARGIN: Final = 0.06
"""Share of the range that is left free above and below, and beside dots."""


@dataclass(frozen=True, eq=False, kw_only=True)
class Line:
    """Values over the horizontal axis.

    Parameters
    ----------
    label : str
        What they are.
    x, y : (n,) arrays
        In the units of the chart's axes; not-a-number breaks the line.
    dots : bool
        Whether they are single values that nothing joins.
    """

    label: str
    x: Array
    y: Array
    dots: bool = False


@dataclass(frozen=True, kw_only=True)
class Limit:
    """A level that lines are held against.

    Parameters
    ----------
    label : str
        Whose.
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
        What is there; the same for all places of a sort.
    value : float
        In the unit of the horizontal axis.
    """

    label: str
    value: float


@dataclass(frozen=True, eq=False, kw_only=True)
class Chart:
    """Lines over an angle or a number, with limits.

    Parameters
    ----------
    title : str
        What is told.
    x, y : str
        What the axes are, with their units.
    lines : tuple of Line
        At least one.
    limits : tuple of Limit
        Those that hold for the lines.
    marks : tuple of MarkedPlace
        Places within the lines.
    """

    title: str
    x: str
    y: str
    lines: tuple[Line, ...]
    limits: tuple[Limit, ...] = ()
    marks: tuple[MarkedPlace, ...] = ()

    def __repr__(self) -> str:
        return f"<Chart of {self.title}: {', '.join(line.label for line in self.lines)}>"

    def draw(self, ax: Axes | None = None) -> Axes:
        """Draw the chart.

        Parameters
        ----------
        ax : Axes, optional
            Where; a new figure where left out.

        Returns
        -------
        Axes
            Of matplotlib, with title, labels, limits, marked places and legend.

        Raises
        ------
        MissingExtraError
            If matplotlib is not installed.
        """
        ax = _new_axes() if ax is None else ax
        for line in self.lines:
            style: dict[str, Any] = {"ls": "", "marker": ".", "ms": 3.0} if line.dots else {}
            ax.plot(line.x, line.y, label=line.label, **style)
        low, high = self.range
        for limit in self.limits:
            text = f"{limit.label}: {shown(limit.value)}"
            if low <= limit.value <= high:
                ax.axhline(limit.value, color="0.35", ls="--", lw=1.0, label=text)
            else:
                ax.plot([], [], color="0.35", ls=" ", label=f"{text}, beyond this chart")
        told: set[str] = set()
        for mark in self.marks:  # a legend names each sort once
            label = None if mark.label in told else mark.label
            ax.axvline(mark.value, color="0.5", ls=":", lw=0.8, label=label)
            told.add(mark.label)
        free = _MARGIN * (high - low)
        ax.set(title=self.title, xlabel=self.x, ylabel=self.y, ylim=(low - free, high + free))
        ax.margins(x=_MARGIN if any(line.dots for line in self.lines) else 0.0)
        ax.grid(visible=True, alpha=0.3)
        if self.limits or self.marks or len(self.lines) > 1:
            ax.legend(fontsize="small")
        return ax

    @property
    def range(self) -> tuple[float, float]:
        """Smallest and largest value of all lines and of the limits that are near them.

        Of a level line some room about it.
        """
        values = np.concatenate([line.y[np.isfinite(line.y)] for line in self.lines])
        low, high = (float(values.min()), float(values.max())) if values.size else (0.0, 0.0)
        room = 0.0 if high - low > 1e-9 * max(abs(low), abs(high)) else 0.05 * abs(high) or 1.0
        low, high = low - room, high + room
        levels = [limit.value for limit in self.limits]
        near = _FAR * (high - low)
        seen = [one for one in levels if low - near <= one <= high + near]
        return min(low, *seen, low), max(high, *seen, high)


def knot_marks(knots: Array, low: float, high: float) -> tuple[MarkedPlace, ...]:
    """Return the `knots` of a law, in the unit of an axis, between its ends `low` and `high`."""
    inside = knots[(knots > low) & (knots < high)]
    return tuple(MarkedPlace(label="knots", value=value) for value in inside.tolist())


Charts = Mapping[str, Callable[[Any], Chart]]
"""What makes each chart of a kind from its result, by name."""


def _new_axes() -> Axes:
    try:
        import matplotlib.pyplot as plt
    except ImportError as error:
        raise MissingExtraError("charts", "plot") from error
    _, ax = plt.subplots(layout="constrained")
    return ax
