"""What a design says of a follower and its cam.

A *roller* turns on a pin, a *domed* follower has a fixed round face, a *point* is a dome of radius
zero: all three are *round*. A *flat* follower has a straight face. A *translating* follower moves
along ``+y`` at ``x = offset``; an *oscillating* one swings about a pivot on the ``x`` axis, and its
lift turns the arm away from the cam.

Refused by reading: sizes that the kind of follower does not have, and missing ones.

Depends on quantities only.
"""

from __future__ import annotations

from collections.abc import Iterator
from dataclasses import dataclass
from typing import Any, Final

from gearcam.display import Brief
from gearcam.numerals import shown
from gearcam.quantities import ANGLE, LENGTH, TEXT, param

KIND: Final = "cams"
"""The checks of cams."""

FOLLOWED: Final = "followed profiles"
"""The checks of profiles that a follower was put on."""

Problem = tuple[str, int | None, str, str]
"""Field, number of an item, what is wrong, what is allowed."""

POINTED: Final = ("knife-edge", "point")
"""Two words for a follower without a radius."""

_ROUND: Final = {"roller": "roller_radius", "domed": "dome_radius"}
"""The sizes of round followers."""


def _size(*, doc: str) -> Any:
    """Return a length that a follower or cam may have."""
    return param(LENGTH, default=None, gt=0, le=1e6, doc=doc)


def _run(*, doc: str) -> Any:
    """Return a length of standstill."""
    return param(LENGTH, default=None, ge=0, le=1e6, doc=doc)


def _aside(*, doc: str) -> Any:
    """Return a length to either side."""
    return param(LENGTH, default=0.0, ge=-1e6, le=1e6, doc=doc)


@dataclass(frozen=True, kw_only=True)
class FollowerSpec(Brief):
    """A follower: what touches the cam, and how it is guided.

    Examples
    --------
    >>> import gearcam as gc
    >>> gc.FollowerSpec(type="roller", roller_radius=8.0)
    FollowerSpec(type='roller', roller_radius=8)
    """

    type: str = param(
        TEXT,
        choices=(*POINTED, "roller", "flat", "domed"),
        doc="what touches the cam; a knife edge is a point",
    )
    motion: str = param(
        TEXT, default="translating", choices=("translating", "oscillating"), doc="how it moves"
    )
    roller_radius: float | None = _size(doc="radius of the roller")
    roller2_radius: float | None = _size(
        doc="radius of a second roller: on the same pin, for the outer wall of a groove, or on the "
        "second of conjugate cams; that of the first when left out"
    )
    dome_radius: float | None = _size(doc="radius of a domed face")
    offset: float = _aside(
        doc="of a translating follower's axis from the cam's; positive makes the rise easier"
    )
    arm: float | None = _size(doc="from the pivot to the roller's centre")
    pivot_distance: float | None = _size(doc="from the cam's axis to the pivot")
    arm2: float | None = _size(
        doc="from the pivot to the roller on the second of conjugate cams; as arm when left out"
    )
    roller_distance: float | None = _size(
        doc="between both rollers of a translating follower on conjugate cams"
    )
    arms_angle: float | None = param(
        ANGLE,
        default=None,
        gt=0,
        lt=360,
        doc="between both arms of an oscillating follower on conjugate cams",
    )
    preload: float | None = param(
        LENGTH,
        default=None,
        ge=0,
        le=10,
        doc="by how much conjugate cams press their rollers apart; 0 when left out",
    )
    face_offset: float = _aside(
        doc="of an oscillating flat follower: how far its face stands off the pivot to the cam"
    )

    axis: float | None = param(
        ANGLE, default=None, ge=-80, le=80,
        doc="of a translating follower over a translating cam: how far its way leans in the "
        "direction in which the cam moves",
    )  # fmt: skip
    pivot_height: float | None = param(
        LENGTH,
        default=None,
        ge=-1e6,
        le=1e6,
        doc="of an oscillating follower over a translating cam: its pivot above the roller's "
        "centre at zero lift",
    )

    @property
    def oscillating(self) -> bool:
        """Whether it swings about a pivot; its lift is then an angle."""
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
        """Yield what is wrong by reading: field, index, message, allowed."""
        for kind, name in _ROUND.items():
            given = getattr(self, name) is not None
            if given and self.type != kind:
                yield name, None, f"a {self.type} follower has none", f'with type = "{kind}"'
            if not given and self.type == kind:
                yield name, None, f"is missing for a {kind} follower", "a radius above 0"
        swinging = {"pivot_distance": True, "arm": not self.flat}
        for name, asked in swinging.items():
            given = getattr(self, name) is not None
            if given and not self.oscillating:
                yield name, None, "a translating follower has none", 'with motion = "oscillating"'
            elif given and not asked:
                yield name, None, "a flat face has none", "leave it out"
            elif self.oscillating and asked and not given:
                yield name, None, "is missing for an oscillating follower", "a length above 0"
        if self.offset and self.oscillating:
            yield "offset", None, "an oscillating follower has none", "leave it out"
        if self.face_offset and not (self.flat and self.oscillating):
            rule = "with an oscillating flat follower"
            yield "face_offset", None, "only an oscillating flat follower has one", rule


@dataclass(frozen=True, kw_only=True)
class CamSpec(Brief):
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
        doc="from the cam's axis to the centre of a round follower at zero lift"
    )
    base_radius: float | None = _size(
        doc="from the cam's axis to a flat face at zero lift; of round followers the prime "
        "radius less the roller's"
    )
    thickness: float = param(LENGTH, default=10.0, gt=0, le=1e5, doc="of the plate")
    rotation: str = param(
        TEXT,
        default="ccw",
        choices=("ccw", "cw"),
        doc="direction in which the cam turns; cw gives the mirror image of ccw",
    )
    prime_radius2: float | None = _size(
        doc="from the axis to the second roller's centre at the highest lift, of conjugate cams"
    )
    gap: float | None = param(
        LENGTH, default=None, ge=0, le=1e5, doc="between conjugate cams; 0 when left out"
    )
    outer_diameter: float | None = _size(doc="diameter of the disc that a groove is cut into")
    groove_depth: float | None = _size(doc="depth of a groove, below the thickness")
    roller_clearance: float | None = param(
        LENGTH, default=None, ge=0, le=100,
        doc="width of a groove less the roller's diameter; 0 when left out",
    )  # fmt: skip
    side: str | None = param(
        TEXT, default=None, choices=("front", "back"),
        doc="the face that a groove is cut into: front is +z, as when left out",
    )  # fmt: skip

    walls: str | None = param(
        TEXT, default=None, choices=("lower", "both"),
        doc="of a translating cam: the wall below the follower, as when left out, or a groove",
    )  # fmt: skip
    run_in: float | None = _run(doc="way of a translating cam before its motion, at zero lift")
    run_out: float | None = _run(doc="way of a translating cam after its motion, at the last lift")

    @property
    def runs(self) -> tuple[float, float]:
        """Ways of a translating cam before and after its motion, mm."""
        return self.run_in or 0.0, self.run_out or 0.0

    @property
    def clockwise(self) -> bool:
        """Whether it turns clockwise: everything is then mirrored at the y axis."""
        return self.rotation == "cw"


def size_problems(follower: FollowerSpec, cam: CamSpec) -> Iterator[Problem]:
    """Yield what is wrong with a cam's size for its follower.

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
            yield "prime_radius", None, "a flat follower has no centre", "base_radius_mm instead"
        elif base is None:
            yield "base_radius", None, "is missing for a flat follower", "a radius above 0"
    elif prime is None and base is None:
        rule = "prime_radius_mm or base_radius_mm"
        yield "prime_radius", None, "is missing", rule
    elif prime is not None and base is not None:
        rule = "one of prime_radius_mm and base_radius_mm"
        yield "base_radius", None, "prime_radius_mm is given too", rule
    elif prime is not None and prime <= follower.radius:
        rule = f"above the follower's radius of {shown(follower.radius)} mm"
        yield "prime_radius", None, "leaves no cam below the follower", rule
