"""The tables of what a mechanism works against: loads, masses, springs; and of the study.

Forces are positive in the direction in which the place of a slide counts, torques counter-clockwise
as seen in the machine.
"""

from __future__ import annotations

import math
from collections.abc import Iterator, Mapping
from dataclasses import dataclass
from typing import ClassVar, Final

from gearcam.base.display import ShortRepr
from gearcam.base.quantities import (
    COUNT,
    DAMPING,
    DAMPING_PER_RAD,
    FORCE,
    INERTIA,
    LENGTH,
    LONGEST,
    MASS,
    STIFFNESS,
    STIFFNESS_PER_RAD,
    TEXT,
    TORQUE,
    Row,
    param,
)
from gearcam.base.rules import Breach, exactly_one, needs
from gearcam.kinds.mechanism.keys import angle_param, later, point_param
from gearcam.kinds.mechanism.name_keys import JOINT, MEMBER, SHAFT, WAY, named
from gearcam.linkages.elements import GROUND
from gearcam.mechanics.load import WrittenLoad

_MOST: Final = 1e9
_MOVING: Final = f"{JOINT} or {MEMBER} or {SHAFT} or {WAY}"

INNER, OUTER = "inner", "outer"
"""Dead centres, where a slide's place is least, and where it is largest."""


@dataclass(frozen=True, kw_only=True)
class MachineLoad(ShortRepr, WrittenLoad):
    """A load on a mechanism: a force on a point or a slide, or a torque on a member.

    It may be constant, a formula in the master's angle q, rad, in the place x of the slide or
    member, mm or rad, or in its velocity v, mm/s or rad/s, or rows that are joined by straight
    lines.

    Examples
    --------
    >>> import gearcam as gc
    >>> gc.MachineLoad(on="slide", force=(-35435.0,), travel=4.0, before="outer")
    MachineLoad(on='slide', force=(-35435,), travel=4, before='outer')
    """

    _variables: ClassVar[Mapping[str, str]] = {"q": "q", "x": "the place x", "v": "the velocity v"}
    _from: ClassVar[float] = math.inf

    on: str = named(
        needs=_MOVING,
        example="slide",
        doc="what is loaded: a joint, a point, a slide, a member, or a shaft such as pair.wheel2",
    )
    force: Row | None = param(
        FORCE,
        default=None,
        ge=-_MOST,
        le=_MOST,
        min_length=1,
        alone=True,
        example=-500,
        doc="force: of a slide along its guide; of a point in direction_deg, or two values, x and "
        "y in the machine's frame",
    )
    torque: float | None = param(
        TORQUE, default=None, ge=-_MOST, le=_MOST, example=-2, doc="torque on a member or a shaft"
    )
    formula: str | None = param(
        TEXT,
        default=None,
        example="-200 - 3*x",
        doc="force, N, or torque, N m, as a formula in the master's angle q, rad, in the place x, "
        "mm or rad, or in the velocity v, mm/s or rad/s",
    )
    table: Row | None = param(
        default=None,
        ge=-_MOST,
        le=_MOST,
        min_length=2,
        example=[0, -250, 0],
        doc="forces, N, or torques, N m, at the places of `at`, with straight lines between",
    )
    place: Row | None = angle_param(
        default=None,
        min_length=2,
        word="at",
        example=[0, 180, 360],
        doc="the master's angles of the table; over 360 deg they repeat with each turn",
    )
    way: Row | None = param(
        LENGTH,
        default=None,
        ge=-LONGEST,
        le=LONGEST,
        min_length=2,
        word="at",
        example=[600, 750, 900],
        doc="places of a slide instead; beyond them the table keeps its end values",
    )
    direction: float | None = angle_param(
        default=None, doc="direction of the force on a point, in the machine", example=-90
    )
    start: float | None = angle_param(
        default=None,
        doc="the master's angle at which the load begins, in each turn",
        word="from",
        example=150,
    )
    end: float | None = angle_param(default=None, doc="where it ends", word="to", example=200)
    travel: float | None = param(
        LENGTH,
        default=None,
        gt=0,
        le=LONGEST,
        example=4,
        doc="the load acts over this last bit of a slide's travel, each time that it arrives",
    )
    before: str | None = param(
        TEXT,
        default=None,
        choices=(INNER, OUTER),
        example=OUTER,
        doc="before which dead centre: that of its least, or of its largest place",
    )
    against: bool = param(default=False, doc="whether the load always opposes the motion")

    rules = (
        exactly_one("force", "torque", "formula", "table"),
        needs("table", "place", "way", one=True),
        needs("place", "table"),
        needs("way", "table"),
        needs("start", "end"),
        needs("end", "start"),
        needs("travel", "before"),
        needs("before", "travel"),
    )

    def problems(self) -> Iterator[Breach]:
        """Yield contradictions: field, index, message, what is allowed."""
        yield from super().problems()
        if self.table is not None and self.way is not None:
            if self.place is not None:
                yield "way", None, "is given beside at_deg", "at_deg or at_mm"
            yield from self._row_problems("way", self.table, self.way)
        if self.travel is not None and self.start is not None:
            yield "travel", None, "is given beside from_deg", "from_deg and to_deg, or travel_mm"
        if self.start is not None and self.end is not None and self.start >= self.end:
            yield "end", None, "is not above from_deg", later(self.start, self.end)
        if self.force is not None:
            yield from self._force_problems(self.force)

    def _force_problems(self, force: Row) -> Iterator[Breach]:
        if len(force) > 2:
            yield "force", None, f"has {len(force)} values", "one value, or two: x and y"
        if len(force) == 2 and self.direction is not None:
            yield "direction", None, "is given beside a force of two values", "one of both"
        if len(force) == 2 and self.against:
            yield "against", None, "is given with a force of two values", "a force of one value"

    @property
    def key(self) -> str:
        """Key of its size in files."""
        for name in ("force", "torque", "formula"):
            if getattr(self, name) is not None:
                return {"force": "force_n", "torque": "torque_nm"}.get(name, name)
        return "table"

    @property
    def of_velocity(self) -> bool:
        """Whether it is a formula in the velocity."""
        return self.formula is not None and self.read(self.formula)[0] == "v"

    @property
    def has_direction(self) -> bool:
        """Whether it says where it points: two values, or an angle."""
        return self.direction is not None or (self.force is not None and len(self.force) == 2)


@dataclass(frozen=True, kw_only=True)
class MemberMass(ShortRepr):
    """The mass of a member; its weight where there is gravity, its inertia at a speed.

    Examples
    --------
    >>> import gearcam as gc
    >>> gc.MemberMass(of="rod", mass=45.0, at=(260.0, 0.0), inertia=2.8)
    MemberMass(of='rod', mass=45, at=(260, 0), inertia=2.8)
    """

    of: str = named(needs=f"{MEMBER} or {SHAFT}", example="rod", doc="the member, or a shaft")
    mass: float | None = param(MASS, default=None, gt=0, le=1e9, example=0.35, doc="its mass")
    center: str | None = named(
        needs=JOINT, default=None, example="G", doc="joint or point in its centre of mass"
    )
    at: tuple[float, float] | None = point_param(
        default=None,
        example=[60, 0],
        doc="the centre of mass in the member's frame, instead of center",
    )
    inertia: float = param(
        INERTIA, default=0.0, ge=0, le=1e9, doc="moment of inertia about the centre of mass"
    )

    def problems(self) -> Iterator[Breach]:
        """Yield contradictions: field, index, message, what is allowed."""
        placed = [name for name in ("center", "at") if getattr(self, name) is not None]
        if self.mass is None and not self.inertia:
            yield "mass", None, "is missing", "mass_kg, or inertia_kg_m2"
        if self.mass is None and placed:
            yield "mass", None, "is missing for a centre of mass", "mass_kg"
        if len(placed) > 1:
            yield "at", None, "is given beside center", "center or at_mm"


@dataclass(frozen=True, kw_only=True)
class MachineSpring(ShortRepr):
    """A spring or a damper: between joints or members, on a slide, on a member or a shaft.

    A straight spring pulls its ends together with the preload and the stiffness times what it is
    longer than its free length; negative, it pushes. One about an angle pulls the second member
    back to the first with the preload and the stiffness times the angle since the master's zero.

    Examples
    --------
    >>> import gearcam as gc
    >>> gc.MachineSpring(between=("P", "D"), stiffness=3.0, length=80.0)
    MachineSpring(between=('P', 'D'), stiffness=3, length=80)
    """

    on: str | None = named(
        needs=_MOVING,
        default=None,
        example="slide",
        doc="a slide that is joined to its guide, or a member or shaft that is joined to the frame",
    )
    between: tuple[str, str] | None = named(
        needs=f"{JOINT} or {MEMBER}",
        default=None,
        order="first and second",
        example=["P", "D"],
        doc="the two joints between which it is, or the two members, one of which may be "
        f"{GROUND!r}",
    )
    stiffness: float = param(
        STIFFNESS, default=0.0, ge=0, le=_MOST, doc="stiffness of a straight spring"
    )
    preload: float = param(
        FORCE, default=0.0, ge=-_MOST, le=_MOST, doc="its pull at the free length"
    )
    length: float | None = param(
        LENGTH,
        default=None,
        ge=-LONGEST,
        le=LONGEST,
        word="free_length",
        example=80,
        doc="free length, of a slide the place where only the preload is left; that at the "
        "master's zero if left out",
    )
    damping: float = param(
        DAMPING, default=0.0, ge=0, le=_MOST, doc="force against the velocity, over it"
    )
    torsion: float = param(
        STIFFNESS_PER_RAD,
        default=0.0,
        ge=0,
        le=_MOST,
        word="stiffness",
        doc="stiffness of a spring about an angle",
    )
    moment: float = param(
        TORQUE,
        default=0.0,
        ge=-_MOST,
        le=_MOST,
        word="preload",
        doc="its torque at the master's zero, against counter-clockwise turns",
    )
    swing_damping: float = param(
        DAMPING_PER_RAD,
        default=0.0,
        ge=0,
        le=_MOST,
        word="damping",
        doc="torque against the angular velocity, over it",
    )

    rules = (exactly_one("on", "between"),)

    def problems(self) -> Iterator[Breach]:
        """Yield contradictions: field, index, message, what is allowed."""
        straight, angular = self.straight, self.angular
        if straight and angular:
            name = next(name for name in ANGULAR if getattr(self, name))
            what = "does not go with the keys of a straight spring"
            yield name, None, what, "either the keys of a straight spring, or of one about an angle"
        elif not straight and not angular:
            yield "stiffness", None, "is missing", "a stiffness, a preload, or a damping"
        if angular and self.length is not None:
            yield "length", None, "does not apply to a spring about an angle", "preload_nm"
        if self.between is not None and self.between[0] == self.between[1]:
            yield "between", 1, "is the first one again", "two different joints or members"

    @property
    def straight(self) -> bool:
        """Whether it has keys of a straight spring."""
        return any(getattr(self, name) for name in STRAIGHT)

    @property
    def angular(self) -> bool:
        """Whether it has keys of a spring about an angle."""
        return any(getattr(self, name) for name in ANGULAR)

    @property
    def damped(self) -> bool:
        """Whether it has a damper, which needs a speed."""
        return bool(self.damping or self.swing_damping)


STRAIGHT: Final = ("stiffness", "preload", "damping")
ANGULAR: Final = ("torsion", "moment", "swing_damping")
"""Values of a straight spring, and of one about an angle."""


@dataclass(frozen=True, kw_only=True)
class TorqueSpec(ShortRepr):
    """Places at which the study ``torque`` computes moments.

    Examples
    --------
    >>> import gearcam as gc
    >>> gc.TorqueSpec(steps=360)
    TorqueSpec(steps=360)
    """

    steps: int = param(
        COUNT,
        default=720,
        ge=12,
        le=100000,
        doc="number of even steps of the master's range; both sides of knots and of the ends of "
        "loads are added",
    )
