"""Name and unit of the angle or travel of a cam in output.

Depends on numerals only.
"""

from __future__ import annotations

from dataclasses import dataclass

from gearcam.base.display import ShortRepr
from gearcam.base.numerals import FEW, formatted, in_range


@dataclass(frozen=True, kw_only=True)
class DriverAxis(ShortRepr):
    """Name and unit of a cam's angle or travel in output.

    Parameters
    ----------
    column : str
        The name of its column.
    symbol, unit, per : str
        Symbol and unit of angle or travel; unit of the variable of
        derivatives.
    called : str
        Its name in words.
    scale : float
        Unit in output, per rad or mm of the driver position.
    whole : float
        Whole turn or travel, in the unit.
    """

    column: str
    symbol: str
    unit: str
    per: str
    called: str
    scale: float
    whole: float

    @property
    def label(self) -> str:
        """The label of its axis."""
        return f"{self.called} {self.symbol}, {self.unit}"

    def text(self, theta: float) -> str:
        """Return a driver position as text with its unit, with rounding shown as 0."""
        return f"{formatted(self.scale * theta, FEW, scale=self.whole)} {self.unit}"

    def place(self, theta: float) -> str:
        """Return a position as text: of a turn its end is its begin."""
        if self.unit != "deg":
            return f"at {self.text(theta)}"
        return f"at {in_range(self.scale * theta, 0.0, self.whole, scale=self.whole)} deg"
