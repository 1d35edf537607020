"""Parameters of a globoidal indexing cam and its turret as a design gives them.

Refused when a design is read: sizes that contradict each other. Depends on quantities and rules
only.
"""

from __future__ import annotations

import math
from collections.abc import Iterator
from dataclasses import dataclass
from typing import Any

from gearcam.base.display import ShortRepr
from gearcam.base.numerals import formatted
from gearcam.base.quantities import (
    ANGLE,
    COUNT,
    LENGTH,
    REQUIRED,
    TEXT,
    param,
    positive_length,
)
from gearcam.base.rules import Breach, below


@dataclass(frozen=True, kw_only=True)
class IndexSpec(ShortRepr):
    """The motion of a turret in a turn of the cam: it moves by one stop, then it rests.

    Parameters
    ----------
    law : object
        Parameters of a motion law, such as `gearcam.motion_laws.ModifiedSine`.
    angle : float, rad
        Cam angle of the motion.

    Examples
    --------
    >>> import gearcam as gc
    >>> gc.IndexSpec(law=gc.motion_laws.ModifiedSine(), angle=2.0)
    IndexSpec(angle=2, law=ModifiedSine)
    """

    law: Any
    angle: float = param(
        ANGLE,
        ge=1,
        le=350,
        example=120,
        doc="index angle: cam angle in which the turret moves by one stop; it rests for the "
        "remainder of the turn",
    )


@dataclass(frozen=True, kw_only=True)
class TurretSpec(ShortRepr):
    """A turret: a wheel with radial rollers, one for each stop.

    Examples
    --------
    >>> import gearcam as gc
    >>> gc.TurretSpec(stops=8, roller_radius=8.0, roller_length=14.0, reach=58.0).hub
    44.0
    """

    stops: int = param(
        COUNT,
        ge=3,
        le=100,
        example=8,
        doc="number of stops in a turn of the turret, and of its rollers",
    )
    roller_radius: float = positive_length(default=REQUIRED, example=8, doc="radius of a roller")
    roller_length: float = positive_length(
        default=REQUIRED, example=14, doc="length of a roller, outside the body of the turret"
    )
    reach: float = positive_length(
        default=REQUIRED, example=58, doc="distance of the ends of the rollers from its axis"
    )

    rules = (
        below("roller_length", "reach", why="the rollers would begin at the axis of the turret"),
    )

    @property
    def hub(self) -> float:
        """Radius of its body, mm."""
        return self.reach - self.roller_length

    @property
    def pitch(self) -> float:
        """Angle between two rollers, rad."""
        return 2.0 * math.pi / self.stops

    def problems(self) -> Iterator[Breach]:
        """Yield contradictions: field, index, message, what is allowed."""
        most = self.hub * math.sin(0.5 * self.pitch)
        if self.roller_radius >= most:
            rule = f"below {formatted(most)} mm, where they touch at the turret's body"
            yield "roller_radius", None, "neighbouring rollers overlap", rule


@dataclass(frozen=True, kw_only=True)
class GloboidalSpec(ShortRepr):
    """A globoidal cam: where it is, how long, and how much room the rollers have.

    Examples
    --------
    >>> import gearcam as gc
    >>> gc.GloboidalSpec(center_distance=100.0)
    GloboidalSpec(center_distance=100)
    """

    form: str = param(TEXT, default="globoidal", choices=("globoidal",), doc="the form of the cam")
    center_distance: float = positive_length(
        default=REQUIRED, example=100, doc="distance of the cam's axis from that of the turret"
    )
    length: float | None = positive_length(
        example=50,
        doc="length of the cam; if left out the least with which a roller always presses along its "
        "whole length in each direction",
    )
    roller_clearance: float = param(
        LENGTH,
        default=0.0,
        ge=0,
        le=100,
        doc="width of the groove between ribs minus the roller's diameter",
    )
    floor_clearance: float = param(
        LENGTH,
        default=0.0,
        ge=0,
        le=100,
        doc="gap between the core and the ends of the rollers, and between the ribs and the body "
        "of the turret",
    )
    rotation: str = param(
        TEXT,
        default="ccw",
        choices=("ccw", "cw"),
        doc="direction in which the cam turns while the roller in front of it rises, seen from "
        "above; cw is the mirror image of ccw",
    )

    @property
    def clockwise(self) -> bool:
        """Whether it turns clockwise: everything is mirrored then."""
        return self.rotation == "cw"
