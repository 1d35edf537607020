"""The table ``[[chain]]``: a chain on a wheel that swings a lever."""

from __future__ import annotations

import cmath
import math
from collections.abc import Iterator
from dataclasses import dataclass, replace
from typing import TYPE_CHECKING, Any, Final

import numpy as np

from gearcam.base.adjustments import Adjustment
from gearcam.base.errors import InfeasibleError
from gearcam.base.facts import Fact
from gearcam.base.findings import Remark, check
from gearcam.base.numerals import formatted
from gearcam.base.quantities import REQUIRED, TEXT, param, positive_length
from gearcam.base.rules import Breach
from gearcam.kinds.mechanism.asked import TABLES
from gearcam.kinds.mechanism.keys import Sort, angle_param, center_of, named, point_param
from gearcam.kinds.mechanism.parts.part import MachinePart, Setting, Tree, not_closing
from gearcam.linkages.chain import LeverChain, roots_in

if TYPE_CHECKING:
    from gearcam.kinds.mechanism.parts.picture import Picture
    from gearcam.linkages.closing import NotClosingError
    from gearcam.linkages.known import Known
    from gearcam.linkages.linkage import Linkage

NEAR: Final = 1e-3
"""Distance, relative to the wheel's radius, that is none: places are rounded in design files."""

_WIDER: Final = (5.0, 15.0, 45.0, 90.0)
"""By how much the range of a lever is widened in the search for one that is wide enough, deg."""

_SAME_DEG: Final = 1e-7
"""Distance of two directions of a lever that are the same, deg."""

_BACK: Final = 1e-5
"""How far from where it was a shaft may be after a cycle, rad: the error of its law."""


class WoundPart(MachinePart):
    """A part that a wheel moves by a chain.

    Parameters
    ----------
    on, wind : str
        The wheel's shaft, and its turn that winds the chain up: ``ccw`` or ``cw``.
    """

    on: str
    wind: str

    @property
    def side(self) -> float:
        """+1 if turning counter-clockwise winds the chain up, -1 if clockwise."""
        return 1.0 if self.wind == "ccw" else -1.0

    def demand(self, linkage: Linkage, where: str) -> None:
        """Refuse a chain on a shaft that turns without end (see `MachinePart`).

        Raises
        ------
        InfeasibleError
            If it does.
        """
        if not linkage.closed:
            return
        first, last = np.asarray(linkage.track(self.on, linkage.knots[[0, -1]], 0).c[0])
        if abs(last - first) > _BACK:
            raise InfeasibleError(
                "its chain is not back after a turn of the master",
                where=where,
                nearest="give drive[0].range_deg, over which it winds up and off",
            )


@dataclass(frozen=True, kw_only=True)
class ChainSpec(WoundPart):
    """A chain on a wheel that swings a lever, as of a door.

    Examples
    --------
    >>> import gearcam as gc
    >>> gc.ChainSpec(on="pair.wheel2", at=(600.0, 300.0), radius=100.0, joint="B", lever="door",
    ...              length=1735.3, start=-1.5707963, range=(-1.5707963, -0.52359878)).lever
    'door'
    """

    on: str = named(needs=Sort.SHAFT, doc="the wheel's shaft", example="pair.wheel2")
    at: tuple[float, float] = point_param(doc="the wheel's centre", example=[600, 300])
    radius: float = positive_length(
        default=REQUIRED, example=100, doc="of the wheel, to the chain's middle"
    )
    wind: str = param(
        TEXT, default="ccw", choices=("ccw", "cw"), doc="turn of the wheel that winds the chain up"
    )
    joint: str = named(gives=Sort.JOINT, doc="name of the joint at the chain's end", example="B")
    lever: str = named(gives=Sort.MEMBER, turns=True, doc="name of the lever", example="door")
    hinge: tuple[float, float] = point_param(
        word="", default=(0.0, 0.0), doc="where the lever is hinged"
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

    @property
    def _chain(self) -> LeverChain:
        return LeverChain(
            self.lever,
            self.joint,
            self.on,
            complex(*self.hinge),
            complex(*self.at),
            self.radius,
            self.length,
            self.start,
            self.range,
            self.side,
        )

    def elements(self, setting: Setting, where: str) -> Iterator[LeverChain]:
        """Yield lever and chain (see `MachinePart`)."""
        yield self._chain

    def refusal(self, error: NotClosingError, linkage: Linkage, where: str) -> InfeasibleError:
        """Return which limit the lever reaches, and which would do (see `MachinePart`)."""
        chain, known = (
            self._chain,
            linkage.at(np.array([error.closing.place]), 0, error.closing.element),
        )
        side = int(np.argmin([float(np.asarray(one.c[0])[0]) for one in chain.room(known)]))
        what = not_closing(error)
        limit, reached = math.degrees(chain.limits[side]), math.degrees(chain.stretch[side])
        if abs(limit - reached) > _SAME_DEG:
            place = formatted(reached, 8)
            note = (
                f"at {place} deg of the lever its chain turns back: a wider range_deg does not help"
            )
            return InfeasibleError(what, where=where, nearest=note)
        key = f"{where}.range_deg[{side}]"
        wanted = _angle_within_wider(chain, side, known)
        note = f"the lever reaches {key} = {formatted(limit, 8)}"
        if wanted is None:
            return InfeasibleError(what, where=key, nearest=note)
        steps = 100.0 * math.degrees(wanted)
        value = (math.ceil(steps + 0.1) if side else math.floor(steps - 0.1)) / 100.0
        return InfeasibleError(
            what,
            where=key,
            value=limit,
            limit=value,
            unit="deg",
            nearest=note,
            adjustments=[Adjustment(near={key: value})],
        )

    def usual(self, *, last: bool) -> Iterator[tuple[int, str]]:
        """Yield the direction of the lever."""
        yield 1, f"{self.lever}.angle"

    def facts(self, result: Any, number: int) -> Iterator[tuple[str, str, Tree]]:
        """Yield how many positions the lever has within its range (see `MachinePart`)."""
        label = f"positions of {self.lever} within its range"
        yield "chains", self.lever, {"positions": Fact(roots_in(self._chain, 0.0), label, unit="")}

    def sizes(self) -> tuple[float, ...]:
        """Return the lever's length."""
        return (self.length,)

    def draw(self, picture: Picture) -> None:
        """Draw the lever, the chain and its wheel."""
        picture.member(self.lever, 0j, complex(self.length))
        center, end = complex(*self.at), picture.place(self.joint)
        way = end - center
        seen = np.angle(way) + self.side * np.arccos(self.radius / np.abs(way))
        picture.chain_wheel(self.on, center, self.radius)
        start = np.asarray(center + self.radius * np.exp(1j * seen), dtype=np.complex128)
        picture.chain(start, end)

    def stand(self, picture: Picture) -> None:
        """Draw the lever's hinge."""
        picture.pivot(complex(*self.hinge))


def _angle_within_wider(chain: LeverChain, side: int, known: Known) -> float | None:
    """Return the lever's angle, rad, if its range were wide enough for what is `known`."""
    for wider in map(math.radians, _WIDER):
        limits = list(chain.limits)
        limits[side] += wider if side else -wider
        longer = replace(chain, limits=(limits[0], limits[1]))
        rooms = [float(np.asarray(one.c[0])[0]) for one in longer.room(known)]
        if min(rooms) >= 0.0:  # and not NaN, where the joint would be inside the wheel
            longer.solve(known)
            way = complex(np.asarray(known.frame(chain.name).direction.c[0])[0])
            return chain.start + cmath.phase(way * cmath.exp(-1j * chain.start))
    return None


# --- chains on wheels ----------------------------------------------------------------------------


def shaft_place(result: Any, shaft: str) -> complex:
    """Return where a `shaft` is in a `result`, mm."""
    start = np.array([result.linkage.span[0]])
    return complex(np.asarray(result.linkage.at(start, 0).jet(center_of(shaft)).c[0]).flat[0])


def numbers(place: complex) -> str:
    """Return a place, mm, as text."""
    return f"{formatted(place.real + 0.0, 8)}, {formatted(place.imag + 0.0, 8)}"


@check("wheel-apart", kind=TABLES, severity="note", unit="mm")
def wheel_apart(result: Any, limit: float) -> Iterator[Remark]:  # noqa: ARG001
    """Note the wheel of a lever's chain that is not where its shaft is.

    Looks at: the distance of the wheel from its shaft.
    """
    for number, one in enumerate(result.design.chain):
        shaft, wheel = shaft_place(result, one.on), complex(*one.at)
        if abs(wheel - shaft) > NEAR * one.radius:
            yield Remark(
                f"The chain wheel is not on the shaft {one.on}, which is at ({numbers(shaft)}) mm: "
                "it is taken to turn with that shaft, by what is no part of the machine.",
                f"chain[{number}].at_mm",
                abs(wheel - shaft),
            )
