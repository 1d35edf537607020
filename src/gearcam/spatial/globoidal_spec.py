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
    INERTIA,
    LENGTH,
    REQUIRED,
    TEXT,
    fixed,
    param,
    positive_length,
)
from gearcam.base.rules import Breach, below, exactly_one, needs
from gearcam.mechanics.load import LoadSpec
from gearcam.mechanics.mass import MassSpec
from gearcam.spatial.friction import SpaceFrictionSpec


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

    def without_friction(self, friction: SpaceFrictionSpec) -> list[str]:
        """Return the coefficients that it needs and `friction` leaves out."""
        needed = ("roller", "flank", "joint")
        return [name for name in needed if not getattr(friction, name)]

    def dragged(self, friction: SpaceFrictionSpec, radius: float) -> float:
        """Return tangential over normal force at a roller of a `radius`, mm, by its `friction`."""
        return friction.rolling(radius)

    def problems(self) -> Iterator[Breach]:
        """Yield contradictions: field, index, message, what is allowed."""
        most = self.hub * math.sin(0.5 * self.pitch)
        if self.roller_radius >= most:
            rule = f"below {formatted(most)} mm, where they touch at the turret's body"
            yield "roller_radius", None, "neighbouring rollers overlap", rule


@dataclass(frozen=True, kw_only=True)
class TurretLoadSpec(LoadSpec):
    """A torque on the turret, positive against its motion (see `LoadSpec`).

    Attributes
    ----------
    force : float, N
        It turns.

    Examples
    --------
    >>> import gearcam as gc
    >>> gc.TurretLoadSpec(torque=4000.0).on  # N mm
    'turret'
    """

    on: str = param(TEXT, default="turret", choices=("turret",), doc="member that is loaded")
    force: float | None = fixed(None)

    rules = (exactly_one("torque", "formula", "table"), *LoadSpec.rules[1:])


@dataclass(frozen=True, kw_only=True)
class TurretMassSpec(MassSpec):
    """The mass of the turret with all that turns with it.

    Attributes
    ----------
    center : float, mm
        It is on the axis.

    Examples
    --------
    >>> import gearcam as gc
    >>> gc.TurretMassSpec(inertia=0.02)
    TurretMassSpec(inertia=0.02)
    """

    of: str = param(TEXT, default="turret", choices=("turret",), doc="member that has the mass")
    inertia: float | None = param(
        INERTIA,
        default=None,
        gt=0,
        le=1e9,
        example=0.02,
        doc="moment of inertia about the axis of the turret",
    )
    center: float | None = fixed(None)

    rules = ()


@dataclass(frozen=True, kw_only=True)
class TurretFrictionSpec(SpaceFrictionSpec):
    """Coefficients of friction of a globoidal cam, 0 where left out, and sizes of bearings.

    Attributes
    ----------
    guide, guide_length, guide_at, guide_distance
        A turret turns.

    Examples
    --------
    >>> import gearcam as gc
    >>> gc.TurretFrictionSpec(joint=0.1, journal_radius=(12.0, 4.0))
    TurretFrictionSpec(joint=0.1, journal_radius=(12, 4))
    """

    guide: float = fixed(0.0)
    guide_length: float | None = fixed(None)
    guide_at: float | None = fixed(None)
    guide_distance: float | None = fixed(None)

    rules = (
        needs("joint", "journal_radius"),
        needs("roller", "journal_radius"),
        needs("journal_radius", "joint", "roller", one=True),
    )


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
