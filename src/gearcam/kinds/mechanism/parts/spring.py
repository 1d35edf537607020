"""The table ``[[spring]]``."""

from __future__ import annotations

import math
from collections.abc import Iterator
from dataclasses import dataclass
from typing import TYPE_CHECKING, Final

import numpy as np

from gearcam.base.errors import InfeasibleError
from gearcam.base.numerals import formatted
from gearcam.base.quantities import (
    DAMPING,
    DAMPING_PER_RAD,
    FORCE,
    LENGTH,
    LONGEST,
    STIFFNESS,
    STIFFNESS_PER_RAD,
    TORQUE,
    param,
)
from gearcam.base.rules import Breach, exactly_one
from gearcam.designs.faults import Fault
from gearcam.kinds.mechanism.keys import Sort, named
from gearcam.kinds.mechanism.parts.acted import Acted, LoadedLinkage
from gearcam.kinds.mechanism.parts.action import MOST, MOVING, MachineAction
from gearcam.linkages.coordinates import (
    JointDistance,
    MemberTurn,
    NamedCoordinate,
    PointWay,
    WorkCoordinate,
    WorkState,
)
from gearcam.linkages.efforts import SPRINGS, AppliedForce, Effort, ForceLaw
from gearcam.linkages.known import GROUND
from gearcam.numeric.piecewise import places_between

if TYPE_CHECKING:
    from gearcam.linkages.coordinates import Acting
    from gearcam.linkages.linkage import Linkage
    from gearcam.mechanics.gravity import GravitySpec
    from gearcam.numeric.jets import Jet

_SLACK: Final = 1e-9
"""Distance of joints that meet, as a share of their places."""

_STRAIGHT: Final = ("stiffness", "preload", "damping")
_ANGULAR: Final = ("torsion", "moment", "swing_damping")
"""Values of a straight spring, and of one about an angle."""


@dataclass(frozen=True, kw_only=True)
class MachineSpring(MachineAction):
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
        needs=MOVING,
        default=None,
        example="slide",
        doc="a slide that is joined to its guide, or a member or shaft that is joined to the frame",
    )
    between: tuple[str, str] | None = named(
        needs=f"{Sort.JOINT} or {Sort.MEMBER}",
        default=None,
        order="first and second",
        example=["P", "D"],
        doc="the two joints between which it is, or the two members, one of which may be "
        f"{GROUND!r}",
    )
    stiffness: float = param(
        STIFFNESS, default=0.0, ge=0, le=MOST, doc="stiffness of a straight spring"
    )
    preload: float = param(FORCE, default=0.0, ge=-MOST, le=MOST, doc="its pull at the free length")
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
        DAMPING, default=0.0, ge=0, le=MOST, doc="force against the velocity, over it"
    )
    torsion: float = param(
        STIFFNESS_PER_RAD,
        default=0.0,
        ge=0,
        le=MOST,
        word="stiffness",
        doc="stiffness of a spring about an angle",
    )
    moment: float = param(
        TORQUE,
        default=0.0,
        ge=-MOST,
        le=MOST,
        word="preload",
        doc="its torque at the master's zero, against counter-clockwise turns",
    )
    swing_damping: float = param(
        DAMPING_PER_RAD,
        default=0.0,
        ge=0,
        le=MOST,
        word="damping",
        doc="torque against the angular velocity, over it",
    )

    rules = (exactly_one("on", "between"),)

    def problems(self) -> Iterator[Breach]:
        """Yield contradictions: field, index, message, what is allowed."""
        straight, angular = self.straight, self.angular
        if straight and angular:
            name = next(name for name in _ANGULAR if getattr(self, name))
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
        return any(getattr(self, name) for name in _STRAIGHT)

    @property
    def angular(self) -> bool:
        """Whether it has keys of a spring about an angle."""
        return any(getattr(self, name) for name in _ANGULAR)

    @property
    def damped(self) -> bool:
        """Whether it has a damper, which needs a speed."""
        return bool(self.damping or self.swing_damping)

    def unfit(self, acted: Acted) -> Iterator[Fault]:
        """Yield ends that do not suit each other or its keys."""
        if self.between is not None:
            ends, key, wanted = self.between, "between", "two joints, or two members"
        else:
            ends, key, wanted = (self.on or "",), "on", "a slide, a member or a shaft"
        turns = {acted.turns(name) for name in ends}
        if len(turns) > 1:
            yield Fault((key,), "joins a joint to a member", list(ends), wanted)
        elif key == "on" and acted.sorts[ends[0]] == Sort.JOINT:
            yield Fault((key,), "slides along no guide", ends[0], wanted)
        elif turns == {True} and self.straight:
            what = "has the keys of a straight spring about an angle"
            yield Fault((key,), what, list(ends), "stiffness_nm_rad, or two joints")
        elif turns == {False} and self.angular:
            what = "has the keys of a spring about an angle along a line"
            yield Fault((key,), what, list(ends), "stiffness_n_mm, or two members")

    def needs_speed(self, gravity: GravitySpec) -> str:
        """Return that it has a damper, if it has."""
        return "a damper depends on the speed" if self.damped else ""

    def efforts(self, on: LoadedLinkage, number: int) -> Iterator[Effort]:
        """Yield its force or torque (see `MachineAction`)."""
        (low, high), joined = on.linkage.span, self._joined(on.acted)
        if isinstance(joined, JointDistance):
            _demand_apart(on.linkage, joined, f"spring[{number}].between")
        start = WorkState(on.linkage, np.array([min(max(0.0, low), high)]), 0, on.speed)
        at = float(np.asarray(joined.place(start).c[0])[0])
        yield AppliedForce(joined, self._law(at), SPRINGS)

    def _joined(self, acted: Acted) -> WorkCoordinate:
        if self.between is None:
            on = acted.coordinate(self.on or "")
            # between the slide and its guide, which may move
            return NamedCoordinate(on.slide) if isinstance(on, PointWay) else on
        first, second = self.between
        if acted.sorts[first] == Sort.MEMBER:
            return MemberTurn(second, first)
        return JointDistance(acted.joint(first), acted.joint(second))

    def _law(self, start: float) -> ForceLaw:
        """Return its force or torque; `start` is its length or angle at the zero."""
        if self.angular:
            rate, preload, damping, free = self.torsion, self.moment, self.swing_damping, start
        else:
            rate, preload, damping = self.stiffness, self.preload, self.damping
            free = start if self.length is None else self.length

        def law(acting: Acting) -> Jet:
            pull = (acting.place - free) * rate + preload
            return -(pull + acting.velocity * damping)

        return law


def _demand_apart(linkage: Linkage, on: JointDistance, where: str) -> None:
    """Refuse a spring whose ends meet: it has no direction there."""
    q = places_between(linkage.knots).ravel()
    known = linkage.at(q, 0)
    first, second = (np.asarray(known.jet(one).c[0]) for one in (on.first, on.second))
    apart = np.abs(second - first)
    if apart.min() <= _SLACK * max(1.0, float(np.abs(first).max())):
        place = formatted(math.degrees(float(q[int(apart.argmin())])), 6)
        what = f"{on.first} and {on.second} are in one place at {place} deg of the master"
        raise InfeasibleError(what, where=where)
