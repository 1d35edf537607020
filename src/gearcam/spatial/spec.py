"""Parameters of a cam in space and its follower as a design gives them.

Refused when a design is read: sizes that contradict each other. Depends on quantities and rules
only.
"""

from __future__ import annotations

import math
from collections.abc import Iterator
from dataclasses import dataclass
from typing import Literal

from gearcam.base.display import ShortRepr
from gearcam.base.numerals import formatted
from gearcam.base.quantities import (
    ANGLE,
    LENGTH,
    LONGEST,
    REQUIRED,
    TEXT,
    param,
    positive_length,
)
from gearcam.base.rules import Breach, below, needed_with, only_with
from gearcam.spatial.friction import SpaceFrictionSpec

Apex = Literal["apex"]
"""In place of an angle: the tip of the cone is on the cam's axis."""

WALLS = {"both": (1, -1), "upper": (1,), "lower": (-1,), "rib": (1, -1)}
"""Sides of the walls by their word in a design."""

_NO_ARM = "does not apply to a {} follower"


@dataclass(frozen=True, kw_only=True)
class SpatialFollower(ShortRepr):
    """A roller, a cylinder or a cone, and how it is guided along a cam in space.

    Examples
    --------
    >>> import gearcam as gc
    >>> gc.SpatialFollower(roller_radius=8.0, cone="apex")
    SpatialFollower(roller_radius=8, cone='apex')
    """

    type: str = param(
        TEXT, default="roller", choices=("roller",), doc="contact element of the follower"
    )
    motion: str = param(
        TEXT,
        default="translating",
        choices=("translating", "oscillating"),
        doc="motion of the follower: along the cam's axis, or about a pivot",
    )
    roller_radius: float = positive_length(
        default=REQUIRED, example=8, doc="radius of the roller; of a cone at the outside of the cam"
    )
    cone: float | Apex = param(
        ANGLE,
        default=0.0,
        ge=0,
        lt=60,
        doc='half angle of a conical roller, which is thinner inside; "apex": its tip is on the '
        "axis of the cam, so that it rolls without slip",
    )
    roller_length: float | None = positive_length(
        example=12,
        doc="how deep the roller reaches into the cam; the depth of the groove if left out",
    )
    arm: float | None = positive_length(
        example=60, doc="distance from the pivot of an oscillating follower to its roller"
    )
    pivot_distance: float | None = positive_length(
        example=59,
        doc="distance of the pivot from the plane of the cam's axis and the roller at azimuth 0; "
        "if left out so that the roller stays near it: arm*(1 + cos(lift/2))/2",
    )
    start: float | None = param(
        ANGLE,
        default=None,
        ge=-80,
        le=80,
        example=-15,
        doc="angle of the arm at zero lift, from the horizontal upwards; minus half the lift if "
        "left out",
    )

    rules = (
        only_with(("arm", "pivot_distance", "start"), "motion", "oscillating", why=_NO_ARM),
        needed_with(("arm",), "motion", "oscillating", why="is missing for an {} follower"),
    )

    @property
    def oscillating(self) -> bool:
        """Whether it swings about a pivot; its lift is an angle then."""
        return self.motion == "oscillating"

    def without_friction(self, friction: SpaceFrictionSpec) -> list[str]:
        """Return the coefficients that it needs and `friction` leaves out."""
        needed = ("roller", "flank", *(() if self.oscillating else ("guide",)), "joint")
        return [name for name in needed if not getattr(friction, name)]

    def dragged(self, friction: SpaceFrictionSpec, radius: float) -> float:
        """Return tangential over normal force at a roller of a `radius`, mm, by its `friction`."""
        return friction.rolling(radius)

    @property
    def named(self) -> str:
        """It in words, with its article."""
        shape = "conical roller" if self.cone else "roller"
        return f"{'an' if self.oscillating else 'a'} {self.motion} {shape} follower"

    def half_angle(self, radius: float) -> float:
        """Return half the angle of its cone, rad, on a cam of an outer `radius`, mm."""
        if isinstance(self.cone, str):
            return math.atan(self.roller_radius / radius)
        return self.cone


@dataclass(frozen=True, kw_only=True)
class CylinderSpec(ShortRepr):
    """A cylinder cam: the cylinder, and the groove or the edge that moves the roller.

    Examples
    --------
    >>> import gearcam as gc
    >>> gc.CylinderSpec(outer_diameter=80.0, length=70.0, lowest=20.0, groove_depth=12.0).floor
    28.0
    """

    form: str = param(TEXT, default="cylinder", choices=("cylinder",), doc="the form of the cam")
    outer_diameter: float = positive_length(
        default=REQUIRED, example=80, doc="diameter of the cylinder", solvable=True
    )
    length: float = positive_length(default=REQUIRED, example=70, doc="length of the cylinder")
    lowest: float = param(
        LENGTH,
        ge=0,
        le=LONGEST,
        example=20,
        doc="height of the roller's axis, or of the middle of a rib, at zero lift above the lower "
        "face",
    )
    groove_depth: float = positive_length(
        default=REQUIRED, example=12, doc="depth of the groove, less than the cylinder's radius"
    )
    roller_clearance: float = param(
        LENGTH,
        default=0.0,
        ge=0,
        le=100,
        doc="width of a groove minus the roller's diameter; of a rib, of its two rollers together",
    )
    floor_clearance: float = param(
        LENGTH, default=0.0, ge=0, le=100, doc="gap between the floor and the end of the roller"
    )
    walls: str = param(
        TEXT,
        default="both",
        choices=tuple(WALLS),
        doc="walls of the cam: both of a groove; the one above or below the roller, as of an end "
        "cam; or a rib, embraced by two rollers of a translating follower",
    )
    rib: float | None = positive_length(
        example=8, doc="thickness of a rib at the outside, where the follower rests"
    )
    rotation: str = param(
        TEXT,
        default="ccw",
        choices=("ccw", "cw"),
        doc="direction in which the cam turns, seen from above; cw is the mirror image of ccw",
    )

    rules = (
        only_with(("rib",), "walls", "rib", why="is given, but the walls are {}"),
        needed_with(("rib",), "walls", "rib", why="is missing for a {}"),
        only_with(
            ("roller_clearance",),
            "walls",
            "both",
            "rib",
            why="the follower rests on the {} wall, without clearance",
        ),
        below(
            "groove_depth",
            "outer_diameter",
            why="the groove would cut through the cylinder",
        ),
    )

    @property
    def clockwise(self) -> bool:
        """Whether it turns clockwise: everything is mirrored then."""
        return self.rotation == "cw"

    @property
    def asks(self) -> bool:
        """Whether its diameter is to be found."""
        return isinstance(self.outer_diameter, str)

    @property
    def outer_radius(self) -> float:
        """Radius of the cylinder, mm."""
        return 0.5 * self.outer_diameter

    @property
    def floor(self) -> float:
        """Radius of the groove's floor, mm."""
        return self.outer_radius - self.groove_depth - self.floor_clearance

    def problems(self) -> Iterator[Breach]:
        """Yield contradictions: field, index, message, what is allowed."""
        if not self.asks and self.floor <= 0.0:
            name, other = "groove_depth", self.floor_clearance
            if other >= self.outer_radius:
                name, other = "floor_clearance", self.groove_depth
            rule = f"below {formatted(self.outer_radius - other)} mm"
            if other >= self.outer_radius:
                name, rule = (
                    "outer_diameter",
                    f"above {formatted(2.0 * (other + self.floor_clearance))} mm",
                )
            rule += ": depth and clearance of the floor are less than the cylinder's radius"
            yield name, None, "the groove reaches the cam's axis", rule
