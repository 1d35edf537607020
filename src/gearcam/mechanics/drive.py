"""The table ``[drive]``: the speed of the driver."""

from __future__ import annotations

from dataclasses import dataclass
from typing import ClassVar

from gearcam.base.display import ShortRepr
from gearcam.base.numerals import FEW, formatted
from gearcam.base.quantities import RPM, SPEED, Quantity, param, params_of


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

    effort: ClassVar[tuple[str, float]] = ("torque_nm", 1e-3)
    """What the driver exerts: its name in output, and its unit there over that inside."""

    @property
    def quantity(self) -> Quantity:
        """Unit of the speed."""
        return params_of(type(self))["speed"].quantity

    @property
    def key(self) -> str:
        """Key of the speed in files."""
        return f"speed{self.quantity.suffix}"

    @property
    def named(self) -> str:
        """The speed in words; empty if none is given."""
        return self.words(self.speed)

    def words(self, speed: float | None) -> str:
        """Return a `speed`, rad/s or mm/s, in words; empty for None."""
        unit = self.quantity
        return "" if speed is None else f"{formatted(speed / unit.factor, FEW)} {unit.unit}"


@dataclass(frozen=True, kw_only=True)
class CamDriveSpec(DriveSpec):
    """The speed of a cam that turns, and whether its lift is corrected for it.

    Examples
    --------
    >>> import gearcam as gc
    >>> gc.CamDriveSpec(speed=30.0, polydyne=True).named
    '286.48 rpm'
    """

    polydyne: bool = param(
        default=False,
        doc="whether the cam's lift is corrected so that the mass of an elastic follower makes the "
        "motion of the design at this speed",
    )


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

    effort: ClassVar[tuple[str, float]] = ("drive_n", 1.0)
