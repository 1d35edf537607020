"""Parameters of a cam and its follower as a design gives them.

A *roller* turns on a pin, a *domed* follower has a fixed round face, a *point* (knife edge) is a
dome of radius zero: all three are *round*. A *flat* follower has a straight face. A *translating*
follower moves along ``+y`` at ``x = offset``; an *oscillating* one swings about a pivot on the
``x`` axis, and its lift turns the arm away from the cam.

Refused when a design is read: sizes that such a follower does not have, and missing ones.

Depends on quantities and rules only.
"""

from __future__ import annotations

import math
from collections.abc import Iterator
from dataclasses import dataclass
from typing import Any, ClassVar, Final, TypeGuard

from gearcam.base.display import ShortRepr
from gearcam.base.numerals import formatted
from gearcam.base.quantities import ANGLE, LENGTH, LONGEST, TEXT, fixed, param, positive_length
from gearcam.base.rules import Breach, Rule, exactly_one, excluded, needed_with, only_with
from gearcam.mechanics.friction import FrictionSpec

KIND: Final = "cams"
"""The checks of cams."""

FOLLOWED: Final = "followed profiles"
"""The checks of given profiles that a follower was put on."""

PRECISION: Final = "precision of cams"
"""The checks of the errors that tolerances make."""

FITTED: Final = "fitted lifts"
"""The checks of lifts whose motion laws were found."""

POINTED: Final = ("knife-edge", "point")
"""Two words for a follower without a radius."""

FOLLOWERS: Final = {
    **dict.fromkeys(POINTED, "a point: it wears fast, so for light loads and slow cams"),
    "roller": "a roller on a pin: the usual one",
    "flat": "a straight face; only a convex profile is touched everywhere",
    "domed": "a fixed round face",
}
"""What touches the cam."""


SECOND_ROLLER: Final = (
    "radius of the second roller: on the same pin, for the outer wall of a groove, or on the "
    "second of conjugate cams; roller_radius_mm if left out"
)
ROLLER_CLEARANCE: Final = "width of a groove minus the roller's diameter"
GROOVE_SIDE: Final = "face that a groove is cut into; front (+z) if left out"
"""Meanings of keys that several forms have."""


def form_param(name: str) -> Any:
    """Return the field of the form of a cam, which has this `name`."""
    return param(TEXT, default=name, doc="the form of the cam")


def _aside(**rest: Any) -> Any:
    """Return a length to either side."""
    return param(LENGTH, default=0.0, ge=-LONGEST, le=LONGEST, **rest)


_NO_TYPE: Final = "does not apply to a {} follower"
_NO_ARM: Final = "does not apply to an {} follower"

GUIDE_RULES: Final = (
    only_with(("roller_radius",), "type", "roller", why=_NO_TYPE),
    needed_with(("roller_radius",), "type", "roller", why="is missing for a {} follower"),
    only_with(("dome_radius",), "type", "domed", why=_NO_TYPE),
    needed_with(("dome_radius",), "type", "domed", why="is missing for a {} follower"),
    only_with(("arm", "pivot_distance"), "motion", "oscillating", why=_NO_TYPE),
    needed_with(("pivot_distance",), "motion", "oscillating", why="is missing for an {} follower"),
)
"""Rules for the contact element and the guide of followers of all forms."""

FACE_RULES: Final = (
    only_with(("face_offset",), "motion", "oscillating", why=_NO_TYPE),
    only_with(("face_offset",), "type", "flat", why=_NO_TYPE),
)
"""Rules for the offset of a face."""


@dataclass(frozen=True, kw_only=True)
class FollowerSpec(ShortRepr):
    """A follower: its contact element, and how it is guided.

    Forms of cams with other followers have their own classes, such as `GrooveFollower`.

    Examples
    --------
    >>> import gearcam as gc
    >>> gc.FollowerSpec(type="roller", roller_radius=8.0)
    FollowerSpec(type='roller', roller_radius=8)
    """

    type: str = param(
        TEXT,
        choices=tuple(FOLLOWERS),
        doc="contact element of the follower; a knife edge is the same as a point",
    )
    motion: str = param(
        TEXT,
        default="translating",
        choices=("translating", "oscillating"),
        doc="motion of the follower",
    )
    roller_radius: float | None = positive_length(doc="radius of the roller", solvable=True)
    dome_radius: float | None = positive_length(
        example=60, doc="radius of the face of a domed follower"
    )
    offset: float = _aside(
        solvable=True,
        doc="offset of a translating follower's line of motion from the cam's axis; a positive one "
        "lowers the pressure angle of the rise",
    )
    arm: float | None = positive_length(
        example=60,
        solvable=True,
        doc="distance from the pivot of an oscillating follower to its roller's centre",
    )
    pivot_distance: float | None = positive_length(
        example=70,
        solvable=True,
        doc="distance from the cam's axis to the pivot of an oscillating follower",
    )
    face_offset: float = _aside(
        doc="offset of the face of an oscillating flat follower from its pivot, towards the cam"
    )

    @property
    def oscillating(self) -> bool:
        """Whether it swings about a pivot; its lift is an angle then."""
        return self.motion == "oscillating"

    @property
    def flat(self) -> bool:
        """Whether its face is straight."""
        return self.type == "flat"

    @property
    def radius(self) -> float:
        """Radius of its round face, mm; 0 of a point."""
        return self.roller_radius or self.dome_radius or 0.0

    def without_friction(self, friction: FrictionSpec) -> list[str]:
        """Return the coefficients that it needs and `friction` leaves out."""
        ends = "roller" if self.type == "roller" else "flank"
        needed = (ends, "joint") if self.oscillating else (ends, "guide", "joint")
        return [name for name in needed if not getattr(friction, name)]

    def dragged(self, friction: FrictionSpec, radius: float) -> float:
        """Return tangential over normal force at the contact.

        Parameters
        ----------
        friction : FrictionSpec
            Coefficients: of a roller on its pin, and of surfaces that slide.
        radius : float, mm
            Of its end.
        """
        return friction.rolling(radius) if self.type == "roller" else friction.flank

    @property
    def named(self) -> str:
        """It in words, with its article."""
        return f"{'an' if self.oscillating else 'a'} {self.motion} {self.type} follower"

    @property
    def size_keys(self) -> tuple[str, str]:
        """The key of the size that the cam has for it, and the key of the other size."""
        keys = "base_radius_mm", "prime_radius_mm"
        return keys if self.flat else (keys[1], keys[0])

    @property
    def placement(self) -> dict[str, float | None]:
        """Its place beside the axis of the cam as facts, where that applies to it."""
        return {"offset_mm": None if self.oscillating else self.offset}

    rules = (
        *GUIDE_RULES,
        *FACE_RULES,
        only_with(("offset",), "motion", "translating", why=_NO_ARM),
    )

    def problems(self) -> Iterator[Breach]:
        """Yield contradictions: field, index, message, what is allowed."""
        if self.flat and self.arm is not None:
            yield "arm", None, "does not apply to a flat follower", "leave it out"
        if self.oscillating and not self.flat and self.arm is None:
            yield "arm", None, "is missing for an oscillating follower", "a length above 0"


@dataclass(frozen=True, kw_only=True)
class PlateFollower(FollowerSpec):
    """A round follower over a translating cam.

    Attributes
    ----------
    offset, face_offset : float, mm
        It has none.

    Examples
    --------
    >>> import gearcam as gc
    >>> gc.PlateFollower(type="roller", roller_radius=8.0, axis=0.1)
    PlateFollower(type='roller', roller_radius=8, axis=0.1)
    """

    offset: float = fixed(0.0)
    face_offset: float = fixed(0.0)
    axis: float = param(
        ANGLE,
        default=0.0,
        ge=-80,
        le=80,
        doc="inclination of a translating follower on a translating cam, towards the direction in "
        "which the cam moves",
    )
    pivot_height: float = _aside(
        doc="of an oscillating follower on a translating cam: height of its pivot above the "
        "roller's centre at zero lift"
    )

    @property
    def placement(self) -> dict[str, float | None]:
        """Its place over the plate as facts (see `FollowerSpec.placement`)."""
        return {
            "axis_deg": math.degrees(self.axis) or None,
            "pivot_height_mm": self.pivot_height if self.oscillating else None,
        }

    rules = (
        *GUIDE_RULES,
        excluded(
            "type",
            "flat",
            why="over a translating cam a flat face envelops no profile",
            allowed='"roller", "domed" or "point"',
        ),
        only_with(("axis",), "motion", "translating", why=_NO_ARM),
        only_with(
            ("pivot_height",), "motion", "oscillating", why="a translating follower has no pivot"
        ),
    )


@dataclass(frozen=True, kw_only=True)
class CamSpec(ShortRepr):
    """A cam: its form, its size, its direction of turning.

    Forms with other sizes have their own classes, such as `GrooveSpec`.

    Examples
    --------
    >>> import gearcam as gc
    >>> cam = gc.CamSpec(prime_radius=40.0, thickness=12.0, rotation="cw")
    >>> cam.clockwise
    True
    """

    form: str = form_param("disc")
    prime_radius: float | None = positive_length(
        solvable=True,
        doc="prime radius: from the cam's axis to the centre of a round follower at zero lift",
    )
    base_radius: float | None = positive_length(
        example=34,
        solvable=True,
        doc="base radius: from the cam's axis to the profile at zero lift; give it instead of "
        "prime_radius_mm, and always with a flat follower",
    )
    thickness: float = positive_length(default=10.0, doc="thickness of the plate")
    rotation: str = param(
        TEXT,
        default="ccw",
        choices=("ccw", "cw"),
        doc="direction in which the cam turns; cw is the mirror image of ccw",
    )

    rules: ClassVar[tuple[Rule, ...]] = (exactly_one("prime_radius", "base_radius"),)

    @property
    def clockwise(self) -> bool:
        """Whether it turns clockwise: everything is mirrored at the y axis then."""
        return self.rotation == "cw"


def _is_number(value: Any) -> TypeGuard[float]:
    """Return whether a size is given, and not to be solved for."""
    return isinstance(value, float)


def size_problems(follower: FollowerSpec, cam: CamSpec) -> Iterator[Breach]:
    """Yield what is wrong with the size of a cam for its follower.

    Parameters
    ----------
    follower : FollowerSpec
        The follower.
    cam : CamSpec
        The cam.

    Yields
    ------
    tuple
        Field of `cam`, None, message, allowed.
    """
    prime = cam.prime_radius
    if follower.flat:
        if prime is not None:
            message = "does not apply to a flat follower, which has no centre"
            yield "prime_radius", None, message, "base_radius_mm instead"
    elif _is_number(prime) and _is_number(follower.radius) and prime <= follower.radius:
        rule = f"above the follower's radius of {formatted(follower.radius)} mm"
        yield "prime_radius", None, "is not larger than the follower's radius", rule
