"""The tables of what drives a mechanism: drives, and others in the place of the first."""

from __future__ import annotations

from collections.abc import Iterator
from dataclasses import dataclass
from typing import TYPE_CHECKING, Final

from gearcam.base.numerals import formatted
from gearcam.base.quantities import NUMBER, RPM, TEXT, nested, param
from gearcam.base.rules import Breach, exactly_one
from gearcam.designs.design import Design
from gearcam.designs.faults import Fault, show
from gearcam.kinds.mechanism.keys import NameUse, Sort, WithNames, angle_param, named, point_param
from gearcam.laws.ratio import LAWS

if TYPE_CHECKING:
    from gearcam.designs.kind import Examined


_DENOMINATOR: Final = 12
"""Largest denominator of a drive's ratio: turns of the master in a cycle."""

_SUCH: Final = 'the plate\'s place in mm as a formula in q, such as "50*(1 - cos(q))"'
"""What moves a plate."""

_SAME_RATIO: Final = 1e-6
"""Difference of a ratio from a fraction of which it is the decimals."""


class WrittenDrive(WithNames):
    """What moves a mechanism, as tables say it: a pair, a cam, or a shaft that turns evenly."""

    pair: Design | None
    cam: Design | None
    even: bool | None

    @property
    def key(self) -> str:
        """The key that says what it is: ``pair``, ``cam``, ``even``, ``slide``; empty if none."""
        given = (key for key in ("pair", "cam", "even", "slide") if getattr(self, key, None))
        return next(given, "")

    @property
    def in_space(self) -> bool:
        """Whether it is a cam in space, whose shaft lies in the plane of the mechanism."""
        return self.cam is not None and self.cam.kind != "cam"

    @property
    def slides(self) -> bool:
        """Whether it is a plate that slides: a cam without an angle."""
        return getattr(getattr(self.cam, "cam", None), "form", "") == "translating"

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
        "cam",
        "spatial-cam",
        "globoidal-cam",
        default=None,
        example="cam.toml",
        doc="the cam whose follower or turret drives it",
    )
    even: bool | None = param(
        default=None, example=True, doc="true: a shaft that turns with the driver itself"
    )

    rules = (exactly_one("pair", "cam", "even"),)


@dataclass(frozen=True, kw_only=True)
class MachineDrive(WrittenDrive):
    """A drive of a mechanism; the first one is the master, whose angle all motion is given over.

    The wheels of a pair, the follower of a cam or a slide move as their designs say; an even drive
    turns with the master, and a plate slides by a formula. A drive stands in its own frame, which
    may be moved in the machine.

    Examples
    --------
    >>> import gearcam as gc
    >>> gc.MachineDrive(name="motor", even=True)
    MachineDrive(name='motor', even=True)
    """

    name: str = named(
        gives=Sort.ANY, doc="its name; cranks and slides name a shaft of it", example="pair"
    )
    pair: Design | None = nested(
        "gear-pair", default=None, example="pair.toml", doc="the pair: its wheels or its rack move"
    )
    cam: Design | None = nested(
        "cam",
        "spatial-cam",
        "globoidal-cam",
        default=None,
        example="cam.toml",
        doc="the cam: its follower moves, or its turret",
    )
    even: bool | None = param(
        default=None, example=True, doc="true: a shaft that turns with the master"
    )
    slide: str | None = param(
        TEXT,
        default=None,
        example="20*sin(q)",
        doc="place of a slide, or of a cam of the form translating, mm, as a formula in the "
        "master's angle q, rad",
    )
    speed: float | None = param(
        RPM, default=None, gt=0, le=1e6, example=180, doc="mean speed of the driver, of the master"
    )
    ratio: float = param(
        NUMBER,
        default=1.0,
        ge=-100,
        le=100,
        doc="turns per turn of the master: a fraction of small whole numbers",
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

    rules = (
        exactly_one(
            "pair",
            "cam",
            "even",
            "slide",
            note="slide also beside a cam of the form translating",
            both=("cam", "slide"),
        ),
    )

    @property
    def fraction(self) -> tuple[int, int]:
        """The fraction that is nearest to its ratio: turns, in so many turns of the master."""
        cycles = range(1, _DENOMINATOR + 1)
        # the first of those that are equally near is the one in lowest terms
        cycle = min(cycles, key=lambda one: abs(self.ratio - round(self.ratio * one) / one))
        return round(self.ratio * cycle), cycle

    @property
    def rate(self) -> float:
        """Turns of its driver per turn of the master, of which a ratio in the file is rounded."""
        turns, cycle = self.fraction
        return turns / cycle

    def problems(self) -> Iterator[Breach]:
        """Yield contradictions: field, index, message, what is allowed."""
        yield from super().problems()
        if not self.ratio:
            yield "ratio", None, "is 0", "a number, negative for the other sense of rotation"
        elif abs(self.ratio - self.rate) > _SAME_RATIO:
            turns, cycle = self.fraction
            words = f"{turns}/{cycle}" if cycle > 1 else f"{turns}"
            near = f"{formatted(self.rate, 8)}, which is {words}: the cycle has to end"
            yield "ratio", None, "is no fraction of small whole numbers", near
        if self.span is not None and self.slide is not None:
            yield "span", None, "is not of a drive that turns", "a pair, a cam or even = true"
        if self.span is not None and self.span[0] >= self.span[1]:
            yield "span", 1, "is not above the first angle", "rising angles"
        if self.cam is not None and self.slides == (self.slide is None):
            what, allowed = "is not of a cam that turns", "a cam of the form translating"
            if self.slides:
                what, allowed = "is missing: a plate moves by it", _SUCH
            yield "slide", None, what, allowed
        if self.slide is not None:
            from gearcam.laws.formula import formula_problems

            yield from formula_problems("slide", self.slide, "q")

    @property
    def shafts(self) -> dict[str, Sort]:
        """What it moves, a shaft or a slide, by the words behind the name of the drive."""
        if self.pair is not None:
            law = getattr(self.pair, "law", None)
            rack = law is not None and LAWS.name_of(law) == "rack"
            return {"wheel1": Sort.SHAFT} | ({"rack": Sort.WAY} if rack else {"wheel2": Sort.SHAFT})
        if self.cam is not None:
            if (follower := getattr(self.cam, "follower", None)) is None:
                return {"turret": Sort.SHAFT}
            own = {"plate": Sort.WAY} if self.slides else {"shaft": Sort.SHAFT}
            swings = getattr(follower, "motion", "") == "oscillating"
            moved = {"follower": Sort.SHAFT if swings else Sort.WAY}
            return moved if self.in_space else own | moved
        return {"shaft": Sort.SHAFT} if self.even else {"slide": Sort.WAY}

    def names_of(self, word: str) -> Iterator[str]:
        """Yield the names of what it moves, by its `word`: the only thing has that of the drive."""
        yield f"{self.name}.{word}"
        if self.key in ("even", "slide"):
            yield self.name

    @property
    def shaftless(self) -> str:
        """Why nothing can be on the shaft of its cam; empty if it has one, or no cam."""
        if self.slides:
            return "a plate slides: it has no shaft"
        return "it lies in the plane, across which all shafts stand" if self.in_space else ""

    def given(self) -> Iterator[NameUse]:
        """Yield the names of what it moves."""
        for word, sort in self.shafts.items():
            for name in self.names_of(word):
                yield NameUse(name, sort, ("name",))


# --- drives that cannot be the master or replace another one, and keys that they have in vain -----


def is_read(title: str, found: Examined) -> bool:
    """Return whether the names in the tables of a title are known from the valid tables.

    Parameters
    ----------
    title : str
        The title.
    found : Examined
        The valid tables.
    """
    told = (one.path[0] for one in found.faults if one.path)
    # what a drive moves depends on several keys, which may contradict each other
    return title in found.parts and not (title == "drive" and title in told)


def problems(found: Examined) -> Iterator[Fault]:
    """Yield what is wrong with the drives of a mechanism, and with those to compare.

    Parameters
    ----------
    found : Examined
        The valid tables.
    """
    drives, compared = (found.parts.get(title, ()) for title in ("drive", "compare"))
    for number, one in enumerate(drives):
        yield from _without_effect(number, one)
    if drives and drives[0].slide is not None:
        what = f"{show(drives[0].slide)} has no angle over which the motion could be given"
        behind = "plate" if drives[0].slides else "slide"
        allowed = f"a first drive with pair, cam or even = true, and the {behind} behind it"
        yield Fault(("drive", 0, "slide"), what, drives[0].slide, allowed)
    if drives and is_read("drive", found):
        for number, one in enumerate(compared):
            yield from _not_comparable(number, one, drives[0])


def _without_effect(number: int, one: MachineDrive) -> Iterator[Fault]:
    """Yield keys that a drive is given in vain."""
    if not number or one.slide is not None:
        why = "the first drive is the master" if not number else "its formula is in the master's q"
        for key, value, usual in (("ratio", one.ratio, 1.0), ("phase_deg", one.phase, 0.0)):
            if value != usual:
                yield Fault(("drive", number, key), f"has no effect: {why}", value, f"{usual:g}")
    if number and one.speed is not None:
        what = "has no effect: the speed is that of the first drive"
        yield Fault(("drive", number, "speed_rpm"), what, None, "the key in the first drive")


def _not_comparable(number: int, one: CompareSpec, master: MachineDrive) -> Iterator[Fault]:
    """Yield that a drive to compare does not have the shafts of the first drive."""
    if one.even:
        if master.pair is None:
            what = "cannot replace the first drive, which is not a pair"
            yield Fault(("compare", number, "even"), what, True, "where a pair is the master")
        return
    if one.slides:
        what = f"the cam {show(getattr(one.cam, 'name', ''))} slides: it has no angle"
        yield Fault(("compare", number, "cam"), what, None, "a cam that turns")
        return
    own = MachineDrive(name=master.name, pair=one.pair, cam=one.cam)
    if one.key and own.shafts != master.shafts:
        what = f"does not have the shafts of {master.name}: {', '.join(master.shafts)}"
        allowed = "a drive of the same sort; an even shaft stands beside a pair with even = true"
        yield Fault(("compare", number, one.key), what, allowed=allowed)
