"""The table ``[friction]``: coefficients, and the sizes of bearings that friction needs."""

from __future__ import annotations

import math
from dataclasses import dataclass
from typing import Any

from gearcam.base.display import ShortRepr
from gearcam.base.quantities import LENGTH, LONGEST, param, positive_length
from gearcam.base.rules import needs


def coefficient(*, doc: str) -> Any:
    """Return the field of a coefficient of friction with its meaning, 0 where left out."""
    return param(default=0.0, ge=0, le=2, zero_is_none=True, doc=doc)


@dataclass(frozen=True, kw_only=True)
class FrictionSpec(ShortRepr):
    """Coefficients of friction, 0 where left out, and sizes of bearings.

    Examples
    --------
    >>> import gearcam as gc
    >>> friction = gc.FrictionSpec(roller=0.1, journal_radius=(10.0, 3.0))
    >>> round(friction.rolling(8.0), 6)  # of a roller of 8 mm, at its circumference
    0.03734
    """

    joint: float = coefficient(doc="of journals: shaft of the cam, pivot of a follower")
    guide: float = coefficient(doc="of straight guides")
    roller: float = coefficient(doc="of a roller on its pin")
    flank: float = coefficient(doc="of surfaces that slide on each other")
    journal_radius: tuple[float, float] | None = param(
        LENGTH,
        default=None,
        gt=0,
        le=LONGEST,
        both=True,
        order="shaft and pin",
        example=[10, 3],
        doc="radius of the journals of shaft and pivot, and that of a roller's pin",
    )
    guide_length: float | None = positive_length(
        example=40, doc="length of the guide of a translating follower"
    )
    guide_at: float | None = param(
        LENGTH,
        default=None,
        ge=-LONGEST,
        le=LONGEST,
        example=90,
        doc="middle of the guide, along the follower from the cam's axis; if left out the guide "
        "begins where the follower's end is at the highest lift",
    )

    rules = (
        needs("joint", "journal_radius"),
        needs("roller", "journal_radius"),
        needs("guide", "guide_length"),
        needs("journal_radius", "joint", "roller", one=True),
    )

    @property
    def journal(self) -> float:
        """Radius of shaft and pivot, mm; 0 if none is given."""
        return 0.0 if self.journal_radius is None else self.journal_radius[0]

    @property
    def circle(self) -> float:
        """Radius of the friction circle of shaft and pivot, mm."""
        return self.journal * math.sin(math.atan(self.joint))

    def rolling(self, radius: float) -> float:
        """Return the share of its load that turns a roller, at its circumference.

        Parameters
        ----------
        radius : float, mm
            Of the roller.
        """
        if not self.roller or self.journal_radius is None:
            return 0.0
        share = self.journal_radius[1] / radius * math.sin(math.atan(self.roller))
        return math.tan(math.asin(min(share, 1.0)))


@dataclass(frozen=True, kw_only=True)
class WheelFrictionSpec(ShortRepr):
    """Coefficients of friction of a pair, 0 where left out, and sizes of its bearings.

    Examples
    --------
    >>> import gearcam as gc
    >>> friction = gc.WheelFrictionSpec(joint=0.1, journal_radius=(12.0, 8.0))
    >>> [round(arm, 6) for arm in friction.journals]  # mm
    [1.194045, 0.79603]
    """

    joint: float = coefficient(doc="of the journals of both shafts")
    flank: float = coefficient(doc="of flanks that slide on each other")
    rolling: float = param(
        LENGTH, default=0.0, ge=0, le=LONGEST, doc="arm of rolling resistance of the flanks"
    )
    journal_radius: tuple[float, float] | None = param(
        LENGTH,
        default=None,
        gt=0,
        le=LONGEST,
        both=True,
        example=[10, 12],
        doc="radius of the journals of driver and driven wheel",
    )

    rules = (needs("joint", "journal_radius"), needs("journal_radius", "joint"))

    @property
    def journals(self) -> tuple[float, float]:
        """Radii of the friction circles of both shafts, mm (000, eq. 2.90)."""
        one, two = self.journal_radius or (0.0, 0.0)
        share = math.sin(math.atan(self.joint))
        return one * share, two * share

    @property
    def left_out(self) -> list[str]:
        """What has no friction, in words."""
        named = {"flanks": self.flank, "rolling": self.rolling, "journals": self.joint}
        return [name for name, coefficient in named.items() if not coefficient]
