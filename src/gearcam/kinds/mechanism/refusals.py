"""Why a mechanism does not move over its master's whole range, and what would make it."""

from __future__ import annotations

import cmath
import math
from collections.abc import Sequence
from dataclasses import replace
from typing import TYPE_CHECKING, Final

import numpy as np

from gearcam.base.errors import Adjustment, InfeasibleError
from gearcam.base.numerals import formatted
from gearcam.designs.design import document_of, value_at
from gearcam.linkages.chain import HoistChain
from gearcam.linkages.closing import Closing, NotClosingError
from gearcam.linkages.elements import Dyad, Element
from gearcam.linkages.linkage import Linkage

if TYPE_CHECKING:
    from gearcam.kinds.mechanism.design import MechanismDesign


def refusal(design: MechanismDesign, error: NotClosingError) -> InfeasibleError:
    """Return why a mechanism does not move over its master's whole range.

    Parameters
    ----------
    design : MechanismDesign
        The design.
    error : NotClosingError
        What its linkage tells.
    """
    found, element = error.closing, error.closing.element
    title, number = _table(design, element)
    name = element.gives[0]
    what = f"{name} does not close over the whole range: {_ranges(found.ranges)}"
    if found.least > -1e-9:
        at = _in_degrees(found.place)
        what = f"{name} is singular at {at} deg: {_singular(found)} there"
    where = f"{title}[{number}]"
    if error.resolved:
        at = _in_degrees(found.unresolved.place if found.unresolved else found.place)
        own, least = (_rest(element, one) for one in error.resolved)
        what = f"{name} is nearly singular at {at} deg: {_singular(found)} there but for {own}"
        note = f"its motion is resolved from {least} on; 0 is singular"
        return InfeasibleError(what, where=where, nearest=note)
    if not error.nearest:
        return InfeasibleError(what, where=where)
    keyed = [_keyed(where, one) for one in error.nearest]
    ways, spec = [_lengthened(design, one) for one in keyed], design.dyad[number]
    names = [spec.members[k] for k in error.nearest[0]]
    if len(names) > 1:
        both = zip(keyed[0].items(), names, strict=True)
        told = " and ".join(f"{key} = {formatted(value)} ({name})" for (key, value), name in both)
        note = f"one length alone cannot do it; with {told} it closes"
        return InfeasibleError(what, where=where, nearest=note, adjustments=ways)
    ((key, value),), (k,) = keyed[0].items(), error.nearest[0]
    return InfeasibleError(
        what,
        where=key,
        value=spec.lengths[k],
        limit=value,
        unit="mm",
        nearest=f"length of {names[0]}; just inside the limit, where both positions meet",
        adjustments=ways,
    )


_WIDER: Final = (5.0, 15.0, 45.0, 90.0)
"""By how much the range of a lever is widened in the search for one that is wide enough, deg."""


def chain_refusal(
    design: MechanismDesign, chain: HoistChain, error: NotClosingError, linkage: Linkage
) -> InfeasibleError:
    """Return which limit of its range a lever reaches, and which range would be wide enough.

    Parameters
    ----------
    design : MechanismDesign
        The design.
    chain : HoistChain
        The chain that does not reach.
    error : NotClosingError
        What the linkage tells.
    linkage : Linkage
        The linkage.
    """
    found, number = error.closing, _table(design, chain)[1]
    known = linkage.at(np.array([found.place]), 0, chain)
    side = int(np.argmin([float(np.asarray(one.c[0])[0]) for one in chain.room(known)]))
    what = f"{chain.name} does not close over the whole range: {_ranges(found.ranges)}"
    limit, reached = math.degrees(chain.limits[side]), math.degrees(chain.stretch[side])
    if abs(limit - reached) > _SAME_DEG:
        place = formatted(reached, 8)
        note = f"at {place} deg of the lever its chain turns back: a wider range_deg does not help"
        return InfeasibleError(what, where=f"chain[{number}]", nearest=note)
    key = f"chain[{number}].range_deg[{side}]"
    wanted = _angle_within_wider(chain, side, linkage, found.place)
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


_SAME_DEG: Final = 1e-7
"""Distance of two directions of a lever that are the same, deg."""


def _angle_within_wider(chain: HoistChain, side: int, linkage: Linkage, q: float) -> float | None:
    """Return the lever's angle at an angle of the master if its range were wide enough, rad."""
    for wider in map(math.radians, _WIDER):
        limits = list(chain.limits)
        limits[side] += wider if side else -wider
        longer = replace(chain, limits=(limits[0], limits[1]))
        known = linkage.at(np.array([q]), 0, chain)
        rooms = [float(np.asarray(one.c[0])[0]) for one in longer.room(known)]
        if min(rooms) >= 0.0:  # and not NaN, where the joint would be inside the wheel
            longer.solve(known)
            way = complex(np.asarray(known.frame(chain.name).direction.c[0])[0])
            return chain.start + cmath.phase(way * cmath.exp(-1j * chain.start))
    return None


def _rest(element: Element, left: float) -> str:
    """Return as text how far a dyad is from where it is singular, mm or rad."""
    if isinstance(element, Dyad) and element.type == "TRT":
        return f"{formatted(math.degrees(left), 3)} deg"
    return f"{formatted(left, 3)} mm"


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


_FURTHER: Final = 2.0
"""How many times further than the least change a length is changed in the search for remedies."""


def _keyed(where: str, lengths: dict[int, float]) -> dict[str, float]:
    """Return the lengths of a table by their keys."""
    return {f"{where}.lengths_mm[{k}]": float(formatted(one, 6)) for k, one in lengths.items()}


def _lengthened(design: MechanismDesign, near: dict[str, float]) -> Adjustment:
    """Return a change of lengths, from the nearest ones on in the same direction."""
    far = {}
    for key, value in near.items():
        own = value_at(document_of(design), key)
        further = value + _FURTHER * abs(value - own) * (1.0 if value >= own else -0.1)
        far[key] = float(formatted(max(further, 0.5 * value), 6))
    return Adjustment(near=near, far=far)


def _table(design: MechanismDesign, element: Element) -> tuple[str, int]:
    """Return the title and the number of the table that an element was made from."""
    name = element.gives[0]
    for title, key in (("dyad", "joint"), ("chain", "lever")):
        for number, one in enumerate(getattr(design, title)):
            if getattr(one, key) == name:
                return title, number
    return "drive", 0


def _ranges(ranges: Sequence[tuple[float, float]]) -> str:
    if not ranges:
        return "at no angle of the master"
    pairs = [[_in_degrees(end) for end in one] for one in ranges]
    return "it does from " + ", and from ".join(f"{a} to {b} deg" for a, b in pairs)


def _in_degrees(angle: float) -> str:
    """Return an angle as text in degrees; what is left of 0 by rounding is 0."""
    found = math.degrees(angle)
    return formatted(0.0 if abs(found) < 1e-6 else found, 8)
