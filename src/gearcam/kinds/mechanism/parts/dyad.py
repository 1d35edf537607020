"""The table ``[[dyad]]``."""

from __future__ import annotations

import math
from collections.abc import Iterator, Mapping
from dataclasses import dataclass, replace
from typing import TYPE_CHECKING, Any, Final

import numpy as np

from gearcam.base.adjustments import Adjustment
from gearcam.base.errors import InfeasibleError
from gearcam.base.facts import Fact
from gearcam.base.numerals import formatted
from gearcam.base.quantities import COUNT, LENGTH, LONGEST, TEXT, param
from gearcam.base.rules import Breach
from gearcam.kinds.mechanism.asked import DEG, Output, coordinates
from gearcam.kinds.mechanism.keys import NameUse, Sort, angle_param, named, point_param
from gearcam.kinds.mechanism.parts.part import MachinePart, Setting, Tree, in_degrees, not_closing
from gearcam.linkages.dyads import DYADS, DyadType, Lengths
from gearcam.linkages.elements import BRANCH, MOTION, Dyad, Element

if TYPE_CHECKING:
    from gearcam.kinds.mechanism.parts.picture import Picture
    from gearcam.linkages.closing import Closing, NotClosingError
    from gearcam.linkages.coordinates import PointWay
    from gearcam.linkages.linkage import Linkage
    from gearcam.linkages.transmission import Transmission

_SHOWN: Final = 4
"""Dyads of which something is always shown."""

_FURTHER: Final = 2.0
"""How many times further than the least change a length is changed in the search for remedies."""

_BARREL: Final = 0.8
"""Length of a cylinder's barrel, relative to the cylinder at its shortest."""

_CYLINDER: Final = "RTRR"
"""An RRR whose first length a drive gives."""

TYPES: Final = (*dict.fromkeys(name.rstrip("12") for name in DYADS), _CYLINDER)
"""Types of dyads: R is a hinge, T a slide."""

_CALLED: Final = {
    "RRR": "coupler and rocker",
    "RRT": "rod and slide",
    "TRR": "rod and slide",
    "RTR": "swinging guide",
    "RTRR": "cylinder",
    "TRT": "table between slides",
    "RTT": "cross slide",
    "TTR": "cross slide",
}
"""What the members of each are called."""

BRANCHES: Final = tuple(dict.fromkeys(name for one in DYADS.values() for name in one.branches))


@dataclass(frozen=True, kw_only=True)
class DyadSpec(MachinePart):
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
    joint: str = named(gives=Sort.JOINT, doc="name of the joint between its members", example="C")
    members: tuple[str, str] = named(
        gives=Sort.MEMBER,
        turns=True,
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
        needs=Sort.WAY,
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
        if self.beta and self.kind.guiding is None:
            yield "beta", None, f"does not apply to {self.type}", "with type RTR, RTT or TTR"
        if self.slide_on == 2 and self.type != "RTR":
            yield "slide_on", None, f"does not apply to {self.type}", "with type RTR"
        guide = self.kind.guiding
        if guide is not None and self.lengths[guide]:
            what = f"{self.members[guide]} is the guide: its length has no effect"
            near = "0; beside its hinge a guide lies by the other length, with beta_deg = 90"
            yield "lengths", guide, what, near
        for number, gamma in enumerate(self.gammas):
            if gamma and not self.kind.guides[number]:
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
    def kind(self) -> DyadType:
        """What is the same of all dyads of its type."""
        return DYADS[self.formula]

    @property
    def branches(self) -> tuple[str, ...]:
        """Names of its positions."""
        return self.kind.branches

    @property
    def rods(self) -> tuple[int, ...]:
        """Which of its lengths must be above 0."""
        return self.kind.rods[1:] if self.type == _CYLINDER else self.kind.rods

    @property
    def _crossed(self) -> int | None:
        """The member that slides on a guide and on the other member."""
        both = (k for k in (0, 1) if {f"guide{k + 1}", f"member{k + 1}"} <= {*self.kind.slides})
        return next(both, None)

    # --- the linkage -----------------------------------------------------------------------------

    def needed(self) -> Iterator[NameUse]:
        """Yield the names that it needs: its type says whether it begins at joints or guides."""
        yield from super().needed()
        ends = zip((self.first, self.last), ("from", "to"), self.kind.guides, strict=True)
        for name, key, guided in ends:
            yield NameUse(name, Sort.GUIDE if guided else Sort.JOINT, (key,))

    def elements(self, setting: Setting, where: str) -> Iterator[Dyad]:
        """Yield the dyad (see `MachinePart`)."""
        yield Dyad(
            self.formula,
            self.first,
            self.last,
            self.joint,
            self.members,
            Lengths(*self.lengths, self.beta, *self.gammas),
            -1.0 if self.branch in self.branches[1:] else 1.0,
            self.driven,
            self.change,
        )

    def chosen(self, element: Element, linkage: Linkage, q: float) -> Element:
        """Return it in the position that is nearer to the given place (see `MachinePart`)."""
        if self.near is None or not isinstance(element, Dyad):
            return element
        known, wanted = linkage.at(np.array([q]), 0, element), complex(*self.near)
        both = [replace(element, sign=sign) for sign in (1.0, -1.0)]
        places = [complex(np.asarray(one.solution(known).joint.c[0])[0]) for one in both]
        apart = [abs(place - wanted) for place in places]
        return both[int(np.argmin(apart))] if np.isfinite(apart).all() else element

    def refusal(self, error: NotClosingError, linkage: Linkage, where: str) -> InfeasibleError:
        """Return why it does not close, and which lengths would make it (see `MachinePart`)."""
        found, what = error.closing, not_closing(error)
        if found.least > -1e-9:
            at = in_degrees(found.place)
            what = f"{self.joint} is singular at {at} deg: {_singular(found)} there"
        if error.resolved:
            at = in_degrees(found.unresolved.place if found.unresolved else found.place)
            own, least = (self._rest(one) for one in error.resolved)
            how = f"{_singular(found)} there but for {own}"
            what = f"{self.joint} is nearly singular at {at} deg: {how}"
            note = f"its motion is resolved from {least} on; 0 is singular"
            return InfeasibleError(what, where=where, nearest=note)
        if not error.nearest:
            return InfeasibleError(what, where=where)
        ways = [self._lengthened(where, one) for one in error.nearest]
        near = self._keyed(where, error.nearest[0])
        names = [self.members[k] for k in error.nearest[0]]
        if len(names) > 1:
            both = zip(near.items(), names, strict=True)
            told = " and ".join(
                f"{key} = {formatted(value)} ({name})" for (key, value), name in both
            )
            note = f"neither length alone does it; with {told} it closes"
            return InfeasibleError(what, where=where, nearest=note, adjustments=ways)
        ((key, value),), (k,) = near.items(), error.nearest[0]
        return InfeasibleError(
            what,
            where=key,
            value=self.lengths[k],
            limit=value,
            unit="mm",
            nearest=f"length of {names[0]}; just inside the limit, where both positions meet",
            adjustments=ways,
        )

    def _rest(self, left: float) -> str:
        """Return as text how far it is from where it is singular, mm or rad."""
        if self.formula == "TRT":
            return f"{formatted(math.degrees(left), 3)} deg"
        return f"{formatted(left, 3)} mm"

    def _keyed(self, where: str, lengths: Mapping[int, float]) -> dict[str, float]:
        """Return lengths by their keys."""
        return {f"{where}.lengths_mm[{k}]": float(formatted(one, 6)) for k, one in lengths.items()}

    def _lengthened(self, where: str, lengths: Mapping[int, float]) -> Adjustment:
        """Return a change of lengths, from the nearest ones on in the same direction."""
        near, far = self._keyed(where, lengths), {}
        for k, (key, value) in zip(lengths, near.items(), strict=True):
            own = self.lengths[k]
            further = value + _FURTHER * abs(value - own) * (1.0 if value >= own else -0.1)
            far[key] = float(formatted(max(further, 0.5 * value), 6))
        return Adjustment(near=near, far=far)

    # --- what may be asked -----------------------------------------------------------------------

    @property
    def moves(self) -> str:
        """Name of the place of its joint on a guide, if it slides on one that is given."""
        slides = [one for one in self.kind.slides if one.startswith("guide")]
        return f"{self.joint}.{slides[0]}" if len(slides) == 1 else ""

    def outputs(self) -> Mapping[str, tuple[Output, ...]]:
        """Return the place of its joint on a guide, or its coordinates."""
        place = Output(self.joint, self.joint, self.moves, False)
        return {self.joint: (place,) if self.moves else coordinates(self.joint)}

    def usual(self, *, last: bool) -> Iterator[tuple[int, str]]:
        """Yield the place of its joint on a guide; the direction of the last member."""
        yield from super().usual(last=last)
        if last:
            yield 1, f"{self.members[1]}.angle"

    def facts(self, result: Any, number: int) -> Iterator[tuple[str, str, Tree]]:
        """Yield position, transmission, and Grashof's class of a four-bar (see `MachinePart`)."""
        places = [one.joint for one in result.linkage.dyads]
        own = result.linkage.dyads[places.index(self.joint)]
        tree: Tree = {
            "type": self.type,
            "solved": 1 + places.index(self.joint),
            "branch": self.branches[0 if own.sign > 0.0 else 1] if self.branches else None,
        }
        for worst in result.transmissions:
            if worst.dyad.joint == self.joint:
                tree |= self._transmission(result, worst, shown=number < _SHOWN)
        yield "dyads", self.joint, tree
        yield from self._four_bar(result)

    def _transmission(self, result: Any, worst: Transmission, *, shown: bool) -> Tree:
        if worst.pressure_angle is not None:
            peak = worst.pressure_angle
            label, value = f"largest pressure angle of {self.joint}", DEG * peak.value
            fact = Fact(value, label, place=result.at(peak), shown=shown, noise=1e-9)
            return {"pressure_angle_deg": fact, "pressure_angle_at_deg": DEG * peak.place}
        if worst.distance is not None:
            peak = worst.distance
            label = f"least distance of the block of {self.joint} from the guide's pivot"
            fact = Fact(peak.value, label, place=result.at(peak))
            return {"guide_distance_mm": fact, "guide_distance_at_deg": DEG * peak.place}
        return {}

    def _four_bar(self, result: Any) -> Iterator[tuple[str, str, Tree]]:
        """Yield Grashof's class of an RRR dyad between a crank and a joint that stands still."""
        cranks = {one.joint: one for one in result.design.crank}
        fixed = {one.name: complex(*one.at) for one in result.design.joint}
        ends, lengths = (self.first, self.last), self.lengths
        if self.first not in cranks:
            ends, lengths = ends[::-1], lengths[::-1]
        if self.type != "RRR" or ends[0] not in cranks or ends[1] not in fixed:
            return
        crank = cranks[ends[0]]
        if crank.on.endswith(".follower"):  # which swings: its class says nothing
            return
        base = abs(fixed[ends[1]] - result.linkage.shaft_of(crank.name))
        if base:
            from gearcam.linkages.grashof import FourBarLengths, grashof

            found = grashof(FourBarLengths(crank.length, lengths[0], lengths[1], base))
            label = f"Grashof's class of {self.joint}"
            tree: Tree = {"class": Fact(found.name, label), "meaning": found.meaning}
            yield "four_bars", self.joint, tree

    def called(self) -> str:
        """Return what its members are."""
        return _CALLED[self.type]

    # --- what acts on it -------------------------------------------------------------------------

    def ways(self) -> Mapping[str, PointWay]:
        """Return the way of its joint, if it slides along a guide that is given."""
        from gearcam.linkages.coordinates import PointWay

        if not self.moves:
            return {}
        guide = self.last if self.moves.endswith("2") else self.first
        return {self.joint: PointWay(self.joint, guide, slide=self.moves)}

    def unturned(self) -> Mapping[str, str]:
        """Return the member that slides along a guide, of RRT and TRR."""
        number = {"RRT": 1, "TRR": 0}.get(self.type)
        return {} if number is None else {self.members[number]: self.joint}

    # --- pictures --------------------------------------------------------------------------------

    def sizes(self) -> tuple[float, ...]:
        """Return its lengths above 0."""
        return tuple(length for length in self.lengths if length > 0.0)

    def guided(self) -> Iterator[tuple[str, str]]:
        """Yield the guides at which its members begin, and the places of its joint on them."""
        for k, name in enumerate((self.first, self.last)):
            if self.kind.guides[k]:
                yield name, f"{self.joint}.guide{k + 1}"

    def draw(self, picture: Picture) -> None:
        """Draw its members; one whose length a drive changes is a cylinder."""
        for k in (0, 1):
            if k or self.driven is None:
                self._draw_member(picture, k)
            else:
                picture.cylinder(self.members[0], self.joint, _BARREL)

    def _draw_member(self, picture: Picture, k: int) -> None:
        own, other = f"member{k + 1}", f"member{2 - k}"
        blocks = [(0j, -self.gammas[k])] if self.kind.guides[k] else []
        if own in self.kind.slides:
            along = picture.turn(f"{self.joint}.{own}")
            bar = picture.reach(float(along.min()), float(along.max()))
            picture.member(self.members[k], 0j, blocks=blocks, bars=[bar])
            return
        end = complex(self.lengths[k])
        if other in self.kind.slides:
            blocks.append((end, (self.beta, -self.beta)[k]))
        picture.member(self.members[k], *([0j, end] if end else [0j]), blocks=blocks)


def _singular(found: Closing) -> str:
    """Return how the parts of a dyad stand where it is singular."""
    element = found.element
    if not isinstance(element, Dyad) or element.type == "TRT":
        return "its guides are parallel"
    ends = f"{element.first} and {element.second}"
    if found.meets:
        return f"{ends} meet"
    if not element.type.startswith("RTR"):
        return "its members are in line"
    arm = element.lengths.second if element.type == "RTR1" else element.lengths.first
    if not arm * math.sin(element.lengths.beta):
        return f"{ends} meet"
    return f"the guide is at right angles to the way between {ends}"
