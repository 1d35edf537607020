"""Parameters of a cam and its follower as a design gives them.

A *roller* turns on a pin, a *domed* follower has a fixed round face, a *point* (knife edge) is a
dome of radius zero: all three are *round*. A *flat* follower has a straight face. A *translating*
follower moves along ``+y`` at ``x = offset``; an *oscillating* one swings about a pivot on the
``x`` axis, and its lift turns the arm away from the cam.

Refused when a design is read: sizes that such a follower does not have, and missing ones.

Depends on quantities only.
"""

from __future__ import annotations

from collections.abc import Iterator
from dataclasses import dataclass
from typing import Any, Final

from gearcam.base.display import ShortRepr
from gearcam.base.numerals import formatted
from gearcam.base.quantities import ANGLE, LENGTH, LONGEST, TEXT, param

KIND: Final = "cams"
"""The checks of cams."""

FOLLOWED: Final = "followed profiles"
"""The checks of given profiles that a follower was put on."""

Problem = tuple[str, int | None, str, str]
"""Field, number of an item, what is wrong, what is allowed."""

POINTED: Final = ("knife-edge", "point")
"""Two words for a follower without a radius."""

FOLLOWERS: Final = {
    **dict.fromkeys(POINTED, "a point: it wears fast, so for light loads and slow cams"),
    "roller": "a roller on a pin: the usual one",
    "flat": "a straight face; only a convex profile is touched everywhere",
    "domed": "a fixed round face",
}
"""What touches the cam."""

_ROUND: Final = {"roller": "roller_radius", "domed": "dome_radius"}
"""The radii of round followers."""


def _size(*, example: float | None = None, doc: str) -> Any:
    """Return a length that a follower or cam may have."""
    return param(LENGTH, default=None, gt=0, le=LONGEST, example=example, doc=doc)


def _run(*, example: float | None = None, doc: str) -> Any:
    """Return a length before or after the motion."""
    return param(LENGTH, default=None, ge=0, le=LONGEST, example=example, doc=doc)


def _aside(*, doc: str) -> Any:
    """Return a length to either side."""
    return param(LENGTH, default=0.0, ge=-LONGEST, le=LONGEST, doc=doc)


@dataclass(frozen=True, kw_only=True)
class FollowerSpec(ShortRepr):
    """A follower: its contact element, and how it is guided.

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
    roller_radius: float | None = _size(doc="radius of the roller")
    roller2_radius: float | None = _size(
        example=6,
        doc="radius of the second roller: on the same pin, for the outer wall of a groove, or on "
        "the second of conjugate cams; roller_radius_mm if left out",
    )
    dome_radius: float | None = _size(example=60, doc="radius of the face of a domed follower")
    offset: float = _aside(
        doc="offset of a translating follower's line of motion from the cam's axis; a positive one "
        "lowers the pressure angle of the rise"
    )
    arm: float | None = _size(
        example=60, doc="distance from the pivot of an oscillating follower to its roller's centre"
    )
    pivot_distance: float | None = _size(
        example=70, doc="distance from the cam's axis to the pivot of an oscillating follower"
    )
    arm2: float | None = _size(
        example=60,
        doc="distance from the pivot to the roller on the second of conjugate cams; arm_mm if left "
        "out",
    )
    roller_distance: float | None = _size(
        example=85, doc="distance of the two rollers of a translating follower on conjugate cams"
    )
    arms_angle: float | None = param(
        ANGLE,
        default=None,
        gt=0,
        lt=360,
        example=80,
        doc="angle between the two arms of an oscillating follower on conjugate cams",
    )
    preload: float | None = param(
        LENGTH,
        default=None,
        ge=0,
        le=10,
        example=0.02,
        doc="how much closer than nominal the rollers of conjugate cams are mounted, so that "
        "they are pressed apart when fitted; 0 if left out",
    )
    face_offset: float = _aside(
        doc="offset of the face of an oscillating flat follower from its pivot, towards the cam"
    )

    axis: float | None = param(
        ANGLE, default=None, ge=-80, le=80,
        example=10,
        doc="inclination of a translating follower on a translating cam, towards the direction in "
        "which the cam moves; 0 if left out",
    )  # fmt: skip
    pivot_height: float | None = param(
        LENGTH,
        default=None,
        ge=-LONGEST,
        le=LONGEST,
        example=0,
        doc="of an oscillating follower on a translating cam: height of its pivot above the "
        "roller's centre at zero lift; 0 if left out",
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

    def problems(self) -> Iterator[Problem]:
        """Yield contradictions: field, index, message, what is allowed."""
        for kind, name in _ROUND.items():
            given = getattr(self, name) is not None
            if given and self.type != kind:
                yield (
                    name,
                    None,
                    f"does not apply to a {self.type} follower",
                    f'with type = "{kind}"',
                )
            if not given and self.type == kind:
                yield name, None, f"is missing for a {kind} follower", "a radius above 0"
        swinging = {"pivot_distance": True, "arm": not self.flat}
        for name, asked in swinging.items():
            given = getattr(self, name) is not None
            if given and not self.oscillating:
                yield (
                    name,
                    None,
                    "does not apply to a translating follower",
                    'with motion = "oscillating"',
                )
            elif given and not asked:
                yield name, None, "does not apply to a flat follower", "leave it out"
            elif self.oscillating and asked and not given:
                yield name, None, "is missing for an oscillating follower", "a length above 0"
        if self.offset and self.oscillating:
            yield "offset", None, "does not apply to an oscillating follower", "leave it out"
        if self.face_offset and not (self.flat and self.oscillating):
            rule = "with an oscillating flat follower"
            yield "face_offset", None, "applies to an oscillating flat follower only", rule


@dataclass(frozen=True, kw_only=True)
class CamSpec(ShortRepr):
    """A cam: its form, its size, its direction of turning.

    Examples
    --------
    >>> import gearcam as gc
    >>> cam = gc.CamSpec(prime_radius=40.0, thickness=12.0, rotation="cw")
    >>> cam.clockwise
    True
    """

    form: str = param(
        TEXT,
        default="disc",
        choices=("disc", "groove", "conjugate", "yoke", "translating"),
        doc="the form of the cam",
    )
    prime_radius: float | None = _size(
        doc="prime radius: from the cam's axis to the centre of a round follower at zero lift"
    )
    base_radius: float | None = _size(
        example=34,
        doc="base radius: from the cam's axis to the profile at zero lift; give it instead of "
        "prime_radius_mm, and always with a flat follower",
    )
    thickness: float = param(LENGTH, default=10.0, gt=0, le=LONGEST, doc="thickness of the plate")
    rotation: str = param(
        TEXT,
        default="ccw",
        choices=("ccw", "cw"),
        doc="direction in which the cam turns; cw is the mirror image of ccw",
    )
    prime_radius2: float | None = _size(
        example=45,
        doc="from the axis to the centre of conjugate cams' second roller, at the highest lift",
    )
    gap: float | None = param(
        LENGTH,
        default=None,
        ge=0,
        le=LONGEST,
        example=2,
        doc="gap between conjugate cams; 0 if left out",
    )
    outer_diameter: float | None = _size(example=130, doc="diameter of the disc of a groove cam")
    groove_depth: float | None = _size(example=6, doc="depth of a groove, less than the thickness")
    roller_clearance: float | None = param(
        LENGTH, default=None, ge=0, le=100,
        example=0.05,
        doc="width of a groove minus the roller's diameter; 0 if left out",
    )  # fmt: skip
    side: str | None = param(
        TEXT, default=None, choices=("front", "back"),
        example="front", doc="face that a groove is cut into; front (+z) if left out",
    )  # fmt: skip

    walls: str | None = param(
        TEXT, default=None, choices=("lower", "both"),
        example="lower",
        doc="walls of a translating cam: the lower one (if left out), or both walls of a groove",
    )  # fmt: skip
    run_in: float | None = _run(
        example=10, doc="length of a translating cam before its motion, at zero lift; 0 if left out"
    )
    run_out: float | None = _run(
        example=10,
        doc="length of a translating cam after its motion, at the last lift; 0 if left out",
    )

    @property
    def runs(self) -> tuple[float, float]:
        """Lengths of a translating cam before and after its motion, mm."""
        return self.run_in or 0.0, self.run_out or 0.0

    @property
    def clockwise(self) -> bool:
        """Whether it turns clockwise: everything is mirrored at the y axis then."""
        return self.rotation == "cw"


def size_problems(follower: FollowerSpec, cam: CamSpec) -> Iterator[Problem]:
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
    prime, base = cam.prime_radius, cam.base_radius
    if follower.flat:
        if prime is not None:
            yield (
                "prime_radius",
                None,
                "does not apply to a flat follower, which has no centre",
                "base_radius_mm instead",
            )
        elif base is None:
            yield "base_radius", None, "is missing for a flat follower", "a radius above 0"
    elif prime is None and base is None:
        rule = "prime_radius_mm or base_radius_mm"
        yield "prime_radius", None, "is missing", rule
    elif prime is not None and base is not None:
        rule = "one of prime_radius_mm and base_radius_mm"
        yield "base_radius", None, "is given beside prime_radius_mm", rule
    elif prime is not None and prime <= follower.radius:
        rule = f"above the follower's radius of {formatted(follower.radius)} mm"
        yield "prime_radius", None, "is not larger than the follower's radius", rule
