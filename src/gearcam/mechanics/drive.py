"""The table ``[drive]``: the speed of the driver."""

from __future__ import annotations

from dataclasses import dataclass

from gearcam.base.display import ShortRepr
from gearcam.base.numerals import formatted
from gearcam.base.quantities import RPM, SPEED, Quantity, param


@dataclass(frozen=True, kw_only=True)
class DriveSpec(ShortRepr):
    """The speed of a driver that turns, rad/s; in files rpm.

    Derivatives by the driver's angle become velocities, accelerations and jerks through it.

    Examples
    --------
    >>> import gearcam as gc
    >>> design = gc.load("profiles/eccentric_cam.toml").with_({"drive.speed_rpm": 300})
    >>> round(gc.build(design).facts["motion.peak_velocity_mm_s"], 6)
    188.495559
    """

    speed: float | None = param(
        RPM, default=None, gt=0, le=1e6, example=300, doc="mean speed of the driver"
    )

    @property
    def named(self) -> str:
        """The speed in words; empty if none is given."""
        return _named(self.speed, RPM)


@dataclass(frozen=True, kw_only=True)
class SlideDriveSpec(DriveSpec):
    """The speed of a driver that slides, mm/s.

    Examples
    --------
    >>> import gearcam as gc
    >>> gc.SlideDriveSpec(speed=250.0).named
    '250 mm/s'
    """

    speed: float | None = param(
        SPEED, default=None, gt=0, le=1e6, example=250, doc="mean speed of a driver that slides"
    )

    @property
    def named(self) -> str:
        """The speed in words; empty if none is given."""
        return _named(self.speed, SPEED)


def _named(speed: float | None, quantity: Quantity) -> str:
    return "" if speed is None else f"{formatted(speed / quantity.factor)} {quantity.unit}"
