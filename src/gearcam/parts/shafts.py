"""What a bore fits on: keys by DIN 6885-1, and the shafts of common motors.

Sources: the keys stand in Flender's catalogue MD 10.1 (Siemens, 2015, page 15/3) over 8 mm, and up
to 44 mm in the Standard Parts Catalogue of Berger Tools, page 2079. No standard has the flats of
the motors' shafts: the sizes are usual ones (see docs/sources.md), and a shaft should be measured.

Depends on fits only.
"""

from __future__ import annotations

from bisect import bisect_left
from collections.abc import Mapping
from typing import Final, NamedTuple

from gearcam.parts.fits import FitSize

DIN_6885: Final = "DIN 6885"
"""As in a file."""

SMALLEST: Final = 6.0
"""Least bore with a key by DIN 6885-1, mm."""


class Keyway(NamedTuple):
    """A keyway with a parallel key by DIN 6885-1.

    Attributes
    ----------
    largest : float, mm
        Largest bore that has it; the least is that of the row before.
    width, height : float, mm
        Of the key.
    shaft_depth, hub_depth : float, mm
        Depths of the keyways from the shaft's circle, t1 and t2, at their middle.
    """

    largest: float
    width: float
    height: float
    shaft_depth: float
    hub_depth: float

    @property
    def hub_width(self) -> FitSize:
        """The width of the keyway in the hub, for a key that slides in."""
        return FitSize(f"{self.width} JS9")

    @property
    def tolerance(self) -> float:
        """How much deeper both keyways may be, mm."""
        return 0.1 if self.width <= 6.0 else 0.2 if self.width <= 32.0 else 0.3


KEYWAYS: Final = tuple(
    Keyway(*row)
    for row in (
        (8, 2, 2, 1.2, 1), (10, 3, 3, 1.8, 1.4), (12, 4, 4, 2.5, 1.8), (17, 5, 5, 3, 2.3),
        (22, 6, 6, 3.5, 2.8), (30, 8, 7, 4, 3.3), (38, 10, 8, 5, 3.3), (44, 12, 8, 5, 3.3),
        (50, 14, 9, 5.5, 3.8), (58, 16, 10, 6, 4.3), (65, 18, 11, 7, 4.4), (75, 20, 12, 7.5, 4.9),
        (85, 22, 14, 9, 5.4), (95, 25, 14, 9, 5.4), (110, 28, 16, 10, 6.4), (130, 32, 18, 11, 7.4),
        (150, 36, 20, 12, 8.4), (170, 40, 22, 13, 9.4), (200, 45, 25, 15, 10.4),
        (230, 50, 28, 17, 11.4),
    )
)  # fmt: skip
"""From the smallest bore up."""


def keyway_of(bore: float) -> Keyway | None:
    """Return the keyway of a `bore`, mm; None below `SMALLEST` and above all rows."""
    row = bisect_left(KEYWAYS, bore, key=lambda one: one.largest)
    return KEYWAYS[row] if bore >= SMALLEST and row < len(KEYWAYS) else None


MOTOR_SHAFTS: Final[Mapping[str, Mapping[str, float]]] = {
    "28BYJ-48": {"bore_diameter": 5.0, "bore_across_flats": 3.0},
    "N20": {"bore_diameter": 3.0, "bore_flat": 2.5},
    "TT": {"bore_diameter": 5.4, "bore_across_flats": 3.7},
    "NEMA 17": {"bore_diameter": 5.0, "bore_flat": 4.5},
    "NEMA 23": {"bore_diameter": 6.35, "bore_flat": 5.85},
}
"""Sizes of bores, mm, by the motor."""
