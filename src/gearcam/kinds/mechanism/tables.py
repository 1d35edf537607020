"""The tables of a mechanism: what drives it, its joints, members and dyads, and its output.

Directions and angles are counter-clockwise from the x axis of the machine, which points to the
right; a point of a member is given in the member's frame, with the origin in its first joint and x
towards its second one.
"""

from __future__ import annotations

import cmath
import math
from collections.abc import Iterator
from dataclasses import dataclass
from typing import Final

from gearcam.base.display import ShortRepr
from gearcam.base.numerals import formatted
from gearcam.base.quantities import (
    ANGLE,
    COUNT,
    LENGTH,
    LONGEST,
    REQUIRED,
    RPM,
    TEXT,
    fixed,
    nested,
    param,
    positive_length,
)
from gearcam.base.rules import Breach, distinct, exactly_one
from gearcam.designs.design import Design
from gearcam.designs.outputs import OutputSpec, files_param, pose_param, studies_param
from gearcam.kinds.mechanism.keys import angle_param, later, point_param, sweep_param
from gearcam.kinds.mechanism.name_keys import (
    ANY,
    GUIDE,
    JOINT,
    MEMBER,
    SHAFT,
    STANDING,
    WAY,
    named,
)
from gearcam.linkages.dyads import DYADS
from gearcam.linkages.elements import BRANCH, GROUND, MOTION
from gearcam.linkages.geneva import SLOTS

FORMATS: Final = ("csv", "dxf", "svg", "report")
"""What ``output.files`` may list."""

STUDIES: Final = ("torque", "accuracy")
"""Its studies, and the titles of the tables of their settings."""


class WrittenDrive(ShortRepr):
    """What moves a mechanism, as tables say it: a pair, a cam, or a shaft that turns evenly."""

    pair: Design | None
    cam: Design | None
    even: bool | None

    @property
    def key(self) -> str:
        """The key that says what it is: ``pair``, ``cam``, ``even``, ``slide``; empty if none."""
        given = (key for key in ("pair", "cam", "even", "slide") if getattr(self, key, None))
        return next(given, "")

    def problems(self) -> Iterator[Breach]:
        """Yield ``even = false``: field, index, message, what is allowed."""
        if self.even is False:
            yield "even", None, "is no drive", "true, or the key left out"


@dataclass(frozen=True, kw_only=True)
class CompareSpec(WrittenDrive):
    """Another drive in the place of the first one, to compare the same mechanism behind both.

    Examples
    --------
    >>> import gearcam as gc
    >>> gc.CompareSpec(name="without_a_pair", even=True)
    CompareSpec(name='without_a_pair', even=True)
    """

    name: str = named(doc="name of the comparison in tables and charts", example="without_a_pair")
    pair: Design | None = nested(
        "gear-pair", default=None, example="pair.toml", doc="the pair that drives it"
    )
    cam: Design | None = nested(
        "cam", default=None, example="cam.toml", doc="the cam whose follower drives it"
    )
    even: bool | None = param(
        default=None, example=True, doc="true: a shaft that turns with the driver itself"
    )

    rules = (exactly_one("pair", "cam", "even"),)


@dataclass(frozen=True, kw_only=True)
class MachineDrive(WrittenDrive):
    """A drive of a mechanism; the first one is the master, whose angle all motion is given over.

    The wheels of a pair, the follower of a cam or a slide move as their designs say; an even drive
    turns with the master. A drive stands in its own frame, which may be moved in the machine.

    Examples
    --------
    >>> import gearcam as gc
    >>> gc.MachineDrive(name="motor", even=True)
    MachineDrive(name='motor', even=True)
    """

    name: str = named(
        gives=ANY, doc="its name; cranks and slides name a shaft of it", example="pair"
    )
    pair: Design | None = nested(
        "gear-pair", default=None, example="pair.toml", doc="the pair: its wheels or its rack move"
    )
    cam: Design | None = nested(
        "cam", default=None, example="cam.toml", doc="the cam: its follower moves"
    )
    even: bool | None = param(
        default=None, example=True, doc="true: a shaft that turns with the master"
    )
    slide: str | None = param(
        TEXT,
        default=None,
        example="20*sin(q)",
        doc="place of a slide, mm, as a formula in the master's angle q, rad",
    )
    speed: float | None = param(
        RPM, default=None, gt=0, le=1e6, example=180, doc="mean speed of the driver, of the master"
    )
    ratio: int = param(
        COUNT, default=1, ge=-100, le=100, doc="turns of this drive's driver per turn of the master"
    )
    phase: float = angle_param(doc="angle of this drive's driver at the master's zero", default=0.0)
    span: tuple[float, float] | None = angle_param(
        default=None,
        word="range",
        order="first and last",
        example=[-60, 60],
        doc="first and last angle of a master that does not turn all the way",
    )
    at: tuple[float, float] = point_param(doc="where its frame stands", default=(0.0, 0.0))
    turn: float = angle_param(doc="direction of its x axis", default=0.0)
    mirror: bool = param(
        default=False, doc="whether it is reflected in its x axis: all turns are reversed"
    )

    rules = (exactly_one("pair", "cam", "even", "slide"),)

    def problems(self) -> Iterator[Breach]:
        """Yield contradictions: field, index, message, what is allowed."""
        yield from super().problems()
        if not self.ratio:
            yield "ratio", None, "is 0", "a whole number, negative for the other sense of rotation"
        if self.span is not None and self.slide is not None:
            yield "span", None, "is not of a drive that turns", "a pair, a cam or even = true"
        if self.span is not None and self.span[0] >= self.span[1]:
            yield "span", 1, "is not above the first angle", "rising angles"
        if self.slide is not None:
            yield from _formula_problems(self.slide)

    @property
    def shafts(self) -> dict[str, str]:
        """What it moves, a shaft or a slide, by the words behind the name of the drive."""
        if self.pair is not None:
            rack = _moves_a_rack(self.pair)
            return {"wheel1": SHAFT} | ({"rack": WAY} if rack else {"wheel2": SHAFT})
        if self.cam is not None:
            follower = getattr(self.cam, "follower", None)
            swings = getattr(follower, "motion", "") == "oscillating"
            return {"shaft": SHAFT, "follower": SHAFT if swings else WAY}
        return {"shaft": SHAFT} if self.even else {"slide": WAY}


def _moves_a_rack(pair: Design) -> bool:
    from gearcam.laws.ratio.formula import RackLaw

    return isinstance(getattr(pair, "law", None), RackLaw)


def _formula_problems(text: str) -> Iterator[Breach]:
    from gearcam.laws.formula_syntax import FormulaError, parse

    try:
        parse(text, "q")
    except FormulaError as error:
        yield error.breach("slide")


@dataclass(frozen=True, kw_only=True)
class JointSpec(ShortRepr):
    """A joint that stands still.

    Examples
    --------
    >>> import gearcam as gc
    >>> gc.JointSpec(name="D", at=(110.0, 0.0))
    JointSpec(name='D', at=(110, 0))
    """

    name: str = named(gives=JOINT, doc="its name", example="D")
    at: tuple[float, float] = point_param(doc="where it stands", example=[110, 0])


@dataclass(frozen=True, kw_only=True)
class CrankSpec(ShortRepr):
    """A member on a shaft that turns.

    Examples
    --------
    >>> import gearcam as gc
    >>> gc.CrankSpec(name="crank", on="motor", joint="B", length=40.0)
    CrankSpec(name='crank', on='motor', joint='B', length=40)
    """

    name: str = named(gives=MEMBER, doc="its name", example="crank")
    on: str = named(
        needs=SHAFT,
        doc="the shaft: the name of an even drive, pair.wheel2, cam.follower",
        example="motor",
    )
    joint: str = named(gives=JOINT, doc="name of its joint", example="B")
    length: float = positive_length(default=REQUIRED, example=40, doc="from the shaft to the joint")
    angle: float | None = angle_param(
        doc="its direction at the drive's zero; 0 if left out", default=None, example=0
    )
    arm_angle: float | None = angle_param(
        doc="its direction at the drive's zero, from the arm of an oscillating follower",
        default=None,
        example=90,
    )
    at: str | None = named(
        needs=JOINT,
        doc="joint in which the shaft stands, if not that of the drive",
        default=None,
        example="A",
    )

    def problems(self) -> Iterator[Breach]:
        """Yield two directions: field, index, message, what is allowed."""
        if self.angle is not None and self.arm_angle is not None:
            yield "arm_angle", None, "is given beside angle_deg", "angle_deg or arm_angle_deg"


@dataclass(frozen=True, kw_only=True)
class SlideSpec(ShortRepr):
    """A member that a drive pushes along a straight guide: a follower, a rack, a slide.

    Examples
    --------
    >>> import gearcam as gc
    >>> gc.SlideSpec(name="tool", on="cam.follower", joint="T")
    SlideSpec(name='tool', on='cam.follower', joint='T')
    """

    name: str = named(gives=MEMBER, doc="its name", example="tool")
    on: str = named(
        needs=WAY,
        doc="what pushes it: cam.follower, pair.rack, or the name of a slide",
        example="cam.follower",
    )
    joint: str = named(gives=JOINT, doc="name of its joint", example="T")
    at: tuple[float, float] = point_param(
        doc="the joint in the frame of the follower's end, the rack or the slide, x along its way",
        default=(0.0, 0.0),
    )


@dataclass(frozen=True, kw_only=True)
class GuideSpec(ShortRepr):
    """A straight guide on the ground or on a member.

    Examples
    --------
    >>> import gearcam as gc
    >>> gc.GuideSpec(name="bed", at=(180.0, 0.0))
    GuideSpec(name='bed', at=(180, 0))
    """

    name: str = named(gives=GUIDE, doc="its name", example="bed")
    on: str = named(needs=MEMBER, doc="the member that carries it", default="ground")
    at: tuple[float, float] = point_param(
        doc="a point of it, from which places count, in the member's frame", default=(0.0, 0.0)
    )
    through: str | None = named(
        needs=STANDING,
        doc="a joint that stands still, or a shaft, from which at_mm counts",
        default=None,
        example="pair.wheel2",
    )
    direction: float = angle_param(doc="its direction in the member's frame", default=0.0)

    def problems(self) -> Iterator[Breach]:
        """Yield a joint of the ground for a guide on a member."""
        if self.through is not None and self.on != GROUND:
            yield "through", None, f"is given beside on = {self.on!r}", "a guide on the ground"


_CYLINDER: Final = "RTRR"
"""An RRR whose first length a drive gives."""

TYPES: Final = (*dict.fromkeys(name.rstrip("12") for name in DYADS), _CYLINDER)
"""Types of dyads: R is a hinge, T a slide."""

BRANCHES: Final = tuple(dict.fromkeys(name for one in DYADS.values() for name in one.branches))


@dataclass(frozen=True, kw_only=True)
class DyadSpec(ShortRepr):
    """Two members and three joints that close a loop.

    Member 1 begins at the joint or guide `first`, member 2 at `last`; both meet in the `joint`.

    Examples
    --------
    >>> import gearcam as gc
    >>> gc.DyadSpec(type="RRT", first="B", last="bed", joint="C", members=("rod", "ram"),
    ...             lengths=(120.0, 0.0))
    DyadSpec(type='RRT', first='B', last='bed', joint='C', members=('rod', 'ram'), lengths=(120, 0))
    """

    type: str = param(
        TEXT, choices=TYPES, doc="its joints in order: R a hinge, T a slide", example="RRR"
    )
    first: str = named(doc="joint or guide at which member 1 begins", word="from", example="B")
    last: str = named(doc="joint or guide at which member 2 begins", word="to", example="D")
    joint: str = named(gives=JOINT, doc="name of the joint between its members", example="C")
    members: tuple[str, str] = named(
        gives=MEMBER,
        doc="names of its members",
        order="first and second",
        example=["coupler", "rocker"],
    )
    lengths: tuple[float, float] = param(
        LENGTH,
        default=(0.0, 0.0),
        ge=0,
        le=LONGEST,
        order="first and second",
        example=[120, 90],
        doc="from the beginning of each member to the joint; of a slide on its guide 0",
    )
    beta: float = angle_param(doc="from member 1 to member 2, of RTR, RTT and TTR", default=0.0)
    gammas: tuple[float, float] = angle_param(
        doc="from the guide to the member that slides on it",
        default=(0.0, 0.0),
        order="first and second",
    )
    slide_on: int = param(COUNT, default=1, ge=1, le=2, doc="the member that is the guide, of RTR")
    branch: str | None = param(
        TEXT,
        default=None,
        choices=BRANCHES,
        example="left",
        doc="which of its positions: of RRR the joint to the left or right of the line from first "
        "to last, else ahead or behind in the guide's direction; left or ahead if left out",
    )
    near: tuple[float, float] | None = point_param(
        word="",
        default=None,
        example=[80, 60],
        doc="where the joint is at the master's zero, roughly, instead of branch",
    )
    change: str = param(
        TEXT,
        default=BRANCH,
        choices=(BRANCH, MOTION),
        doc="what it keeps at a change point, where both positions meet",
    )
    driven: str | None = named(
        needs=WAY,
        doc="the slide that is added to the first length, of RTRR",
        default=None,
        example="cylinder",
    )

    def problems(self) -> Iterator[Breach]:
        """Yield contradictions: field, index, message, what is allowed."""
        allowed = self.branches
        if self.branch is not None and self.near is not None:
            yield "near", None, "is given beside branch", "branch or near_mm"
        if self.branch is not None and self.branch not in allowed:
            words = " or ".join(allowed) or f"no branch: {self.type} has one position"
            yield "branch", None, f"is not of {self.type}", words
        if (self.driven is None) == (self.type == _CYLINDER):
            what = "is missing" if self.driven is None else f"does not apply to {self.type}"
            yield "driven", None, what, "the name of a slide, with type RTRR"
        yield from self._idle()
        yield from self._missing_lengths()
        if self.first == self.last:
            yield "last", None, "is also where it comes from", "another joint or guide"
        for number, gamma in enumerate(self.gammas):
            if self._crossed == number and abs(math.sin(gamma)) < 1e-3:
                yield (
                    "gammas",
                    number,
                    "leaves the slides parallel",
                    "90 for a right angle, not 0 or 180 deg",
                )

    def _idle(self) -> Iterator[Breach]:
        """Yield what has no effect in a dyad of this type."""
        dyad = DYADS[self.formula]
        if self.beta and not {"member1", "member2"} & {*dyad.slides}:
            yield "beta", None, f"does not apply to {self.type}", "with type RTR, RTT or TTR"
        if self.slide_on == 2 and self.type != "RTR":
            yield "slide_on", None, f"does not apply to {self.type}", "with type RTR"
        for number, gamma in enumerate(self.gammas):
            if gamma and not dyad.guides[number]:
                what = f"{self.members[number]} slides on no guide in {self.type}"
                yield "gammas", number, what, "0"
        for name in () if self.branches else ("near", "change"):
            if getattr(self, name) not in (None, BRANCH):
                yield name, None, f"{self.type} has one position", "leave it out"

    def _missing_lengths(self) -> Iterator[Breach]:
        """Yield lengths that the type asks for, by the names of their members."""
        missing = [number for number in self.rods if self.lengths[number] <= 0.0]
        rods = " and ".join(self.members[number] for number in self.rods)
        if missing and not any(self.lengths):
            what = f"dyad {self.joint} has no lengths"
            yield "lengths", None, what, f"lengths of {rods} above 0, in {self.type}"
            return
        for number in missing:
            what = f"the length of {self.members[number]} in dyad {self.joint} is 0"
            yield "lengths", number, what, f"above 0 in {self.type}"

    @property
    def formula(self) -> str:
        """Its type as in `gearcam.linkages.dyads.DYADS`."""
        if self.type == _CYLINDER:
            return "RRR"
        return self.type if self.type in DYADS else f"{self.type}{self.slide_on}"

    @property
    def branches(self) -> tuple[str, ...]:
        """Names of its positions."""
        return DYADS[self.formula].branches

    @property
    def rods(self) -> tuple[int, ...]:
        """Which of its lengths must be above 0."""
        found = DYADS[self.formula].rods
        return found[1:] if self.type == _CYLINDER else found

    @property
    def _crossed(self) -> int | None:
        """The member that slides on a guide and on the other member."""
        slides = DYADS[self.formula].slides
        both = (k for k in (0, 1) if {f"guide{k + 1}", f"member{k + 1}"} <= {*slides})
        return next(both, None)


@dataclass(frozen=True, kw_only=True)
class PointSpec(ShortRepr):
    """A point of a member, whose path is wanted or to which others are joined.

    Examples
    --------
    >>> import gearcam as gc
    >>> gc.PointSpec(name="P", on="coupler", at=(50.0, 35.0))
    PointSpec(name='P', on='coupler', at=(50, 35))
    """

    name: str = named(gives=JOINT, doc="its name", example="P")
    on: str = named(needs=MEMBER, doc="the member", example="coupler")
    at: tuple[float, float] = point_param(doc="the point in its frame", example=[50, 35])


@dataclass(frozen=True, kw_only=True)
class ChainSpec(ShortRepr):
    """A chain on a wheel that swings a lever, as of a door.

    Examples
    --------
    >>> import gearcam as gc
    >>> gc.ChainSpec(on="pair.wheel2", at=(600.0, 300.0), radius=100.0, joint="B", lever="door",
    ...              length=1735.3, start=-1.5707963, range=(-1.5707963, -0.52359878)).lever
    'door'
    """

    on: str = named(needs=SHAFT, doc="the wheel's shaft", example="pair.wheel2")
    at: tuple[float, float] = point_param(doc="the wheel's centre", example=[600, 300])
    radius: float = positive_length(
        default=REQUIRED, example=100, doc="of the wheel, to the chain's middle"
    )
    wind: str = param(
        TEXT, default="ccw", choices=("ccw", "cw"), doc="turn of the wheel that winds the chain up"
    )
    joint: str = named(gives=JOINT, doc="name of the joint at the chain's end", example="B")
    lever: str = named(gives=MEMBER, doc="name of the lever", example="door")
    hinge: tuple[float, float] = point_param(
        word="",
        default=(0.0, 0.0),
        doc="where the lever is hinged",
    )
    length: float = positive_length(
        default=REQUIRED, example=1735, doc="from the hinge to the joint"
    )
    start: float = angle_param(doc="the lever's direction at the drive's zero", example=-90)
    range: tuple[float, float] = angle_param(
        doc="the lever's least and largest direction", order="least and largest", example=[-90, -30]
    )

    def problems(self) -> Iterator[Breach]:
        """Yield a start beyond the range: field, index, message, what is allowed."""
        low, high = self.range
        if low >= high:
            yield "range", 1, "is not above the least direction", "rising directions"
        elif not low <= self.start <= high:
            yield "start", None, "is beyond range_deg", "a direction of the range"
        else:
            yield from self._inside_its_wheel()

    def _inside_its_wheel(self) -> Iterator[Breach]:
        """Yield the end of the range at which the joint would be inside the wheel."""
        way = complex(*self.at) - complex(*self.hinge)
        apart, lever = abs(way), self.length
        # by the cosine law of the triangle of hinge, wheel and joint
        share = (lever**2 + apart**2 - self.radius**2) / max(2.0 * lever * apart, 1e-300)
        if share >= 1.0:
            return
        half, toward = math.acos(max(-1.0, share)), cmath.phase(way)
        off = math.remainder(toward - self.start, 2.0 * math.pi)
        if abs(off) <= half:
            what = f"puts the joint {self.joint} inside the wheel"
            yield "start", None, what, "a direction in which it is outside"
            return
        above = self.start + off % (2.0 * math.pi) - half
        below = self.start - (-off) % (2.0 * math.pi) + half
        for side, limit, word in ((0, below, "above"), (1, above, "below")):
            if (self.range[side] >= limit) if side else (self.range[side] <= limit):
                what = f"the joint {self.joint} would be inside the wheel"
                yield "range", side, what, f"{word} {formatted(math.degrees(limit), 8)}"


@dataclass(frozen=True, kw_only=True)
class HoistSpec(ShortRepr):
    """What a wheel lifts by a chain or a rope, straight along a guide.

    Examples
    --------
    >>> import gearcam as gc
    >>> gc.HoistSpec(name="door", on="pair.wheel2", joint="hook", radius=100.0)
    HoistSpec(name='door', on='pair.wheel2', joint='hook', radius=100)
    """

    name: str = named(gives=MEMBER, doc="name of what is lifted", example="door")
    on: str = named(needs=SHAFT, doc="the wheel's shaft", example="pair.wheel2")
    joint: str = named(gives=JOINT, doc="name of its joint, where the chain ends", example="hook")
    radius: float = positive_length(
        default=REQUIRED, example=100, doc="of the wheel, to the chain's middle"
    )
    wind: str = param(
        TEXT, default="ccw", choices=("ccw", "cw"), doc="turn of the wheel that winds the chain up"
    )
    at: tuple[float, float] = point_param(
        doc="the joint where the wheel's turn is 0", default=(0.0, 0.0)
    )
    direction: float = angle_param(doc="in which it is lifted", default=math.radians(90.0))


@dataclass(frozen=True, kw_only=True)
class GenevaSpec(ShortRepr):
    """A Geneva wheel: the pin of a crank turns it by one slot, then it rests.

    Examples
    --------
    >>> import gearcam as gc
    >>> gc.GenevaSpec(name="wheel", on="motor", slots=6, length=60.0)
    GenevaSpec(name='wheel', on='motor', slots=6, length=60)
    """

    name: str = named(gives=MEMBER, doc="name of the wheel", example="wheel")
    on: str = named(needs=SHAFT, doc="the crank's shaft", example="motor")
    at: str | None = named(
        needs=JOINT,
        doc="joint in which the shaft stands, if not that of the drive",
        default=None,
        example="A",
    )
    slots: int = param(COUNT, ge=SLOTS[0], le=SLOTS[1], doc="number of slots", example=6)
    length: float = positive_length(default=REQUIRED, example=60, doc="from the shaft to the pin")
    angle: float = angle_param(doc="the crank's direction at the drive's zero", default=0.0)
    direction: float = angle_param(doc="from the crank's shaft to the wheel's", default=0.0)
    internal: bool = param(default=False, doc="whether the wheel surrounds the crank")


@dataclass(frozen=True, kw_only=True)
class StretchSpec(ShortRepr):
    """A stretch of a point's path that is to be straight or round.

    Examples
    --------
    >>> import gearcam as gc
    >>> gc.StretchSpec(on="P", start=1.0, end=2.0, shape="line")
    StretchSpec(on='P', start=1, end=2, shape='line')
    """

    on: str = named(doc="the point", example="P")
    start: float = angle_param(doc="the master's angle where it begins", word="from", example=100)
    end: float = angle_param(
        doc="the master's angle where it ends, above 360 over the end of a turn",
        word="to",
        example=260,
    )
    shape: str = param(
        TEXT,
        choices=("line", "circle"),
        example="line",
        doc="what is fitted to it, by the least deviation",
    )

    center: tuple[float, float] | None = point_param(
        word="",
        default=None,
        example=[300, 827],
        doc="a point whose distances from the stretch are wanted too",
    )

    def problems(self) -> Iterator[Breach]:
        """Yield an end that is not above the start."""
        if self.end <= self.start:
            yield "end", None, "is not above from_deg", later(self.start, self.end)


@dataclass(frozen=True, kw_only=True)
class IntervalSpec(ShortRepr):
    """The last bit of an output's travel before a dead centre: when it begins, and how fast.

    Examples
    --------
    >>> import gearcam as gc
    >>> gc.IntervalSpec(on="slide", travel=4.0)
    IntervalSpec(on='slide', travel=4)
    """

    on: str = named(doc="the output", example="slide")
    travel: float | None = positive_length(example=4, doc="travel before the dead centre")
    travel_angle: float | None = sweep_param(
        default=None, word="travel", example=22, doc="the same of an angle"
    )
    before: str = param(
        TEXT,
        default="outer",
        choices=("inner", "outer"),
        doc="the dead centre with the smallest or the largest value",
    )

    rules = (exactly_one("travel", "travel_angle"),)


@dataclass(frozen=True, kw_only=True)
class DwellSpec(ShortRepr):
    """A dwell that an output is to have: the longest range in which it hardly moves.

    Examples
    --------
    >>> import gearcam as gc
    >>> gc.DwellSpec(on="slide", within=0.1)
    DwellSpec(on='slide', within=0.1)
    """

    on: str = named(doc="the output", example="slide")
    within: float | None = positive_length(example=0.1, doc="how much it may move")
    within_angle: float | None = sweep_param(
        default=None, word="within", example=0.5, doc="the same of an angle"
    )
    least: float = sweep_param(
        default=math.radians(10.0),
        doc="the master's angle over which it must last",
    )

    rules = (exactly_one("within", "within_angle"),)


@dataclass(frozen=True, kw_only=True)
class MechanismOutput(OutputSpec):
    """Which files of a mechanism are written, and what is in them (see `OutputSpec`).

    Parameters
    ----------
    pose : float, rad
        The master's angle in the picture.
    studies : tuple of str
        Its studies.
    kerf, dxf_curves, dxf_version
        Nothing is cut out.

    Examples
    --------
    >>> import gearcam as gc
    >>> gc.MechanismOutput(files=("csv", "svg"), outputs=("slide", "rod.angle"))
    MechanismOutput(files=('csv', 'svg'), outputs=('slide', 'rod.angle'))
    """

    files: tuple[str, ...] = files_param(FORMATS)
    studies: tuple[str, ...] = studies_param(STUDIES)
    outputs: tuple[str, ...] | None = param(
        TEXT,
        default=None,
        min_length=1,
        example=["slide", "rod.angle"],
        doc="joints that slide, points or one coordinate as P.x, and directions as member.angle; "
        "if left out every slide and point, or without any the direction of the last member",
    )
    step: float = param(
        ANGLE,
        default=math.radians(1.0),
        gt=0,
        le=90,
        doc="step of the master's angle in motion.csv",
    )
    pose: float = pose_param("q", "the master's angle in the picture")
    chord_tolerance: float | None = param(
        LENGTH,
        default=None,
        ge=1e-6,
        example=0.01,
        doc="largest distance of a drawn path from the true one; 0.01 mm if left out",
    )

    kerf: float = fixed(0.0)
    dxf_curves: str = fixed("lines")
    dxf_version: str | None = fixed(None)

    rules = (
        distinct("files", "format"),
        distinct("studies", "study"),
        distinct("outputs", "output"),
    )
