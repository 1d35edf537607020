"""From the tables of a mechanism to its linkage."""

from __future__ import annotations

import cmath
import math
from collections.abc import Iterator, Sequence
from dataclasses import replace
from functools import partial
from typing import TYPE_CHECKING, Final

import numpy as np

from gearcam.base.errors import Adjustment, InfeasibleError
from gearcam.base.numerals import formatted
from gearcam.base.quantities import LONGEST
from gearcam.designs.design import document_of, value_at
from gearcam.kinds.mechanism.drives import PlacedDrive, center_of, way_of
from gearcam.kinds.mechanism.names import PARTS, needed
from gearcam.linkages.chain import HoistChain
from gearcam.linkages.closing import NotClosingError, settled
from gearcam.linkages.dyads import Lengths
from gearcam.linkages.elements import (
    MOTION,
    Crank,
    Dyad,
    Element,
    GuideLine,
    MemberPoint,
    PushedSlide,
    WoundWay,
)
from gearcam.linkages.geneva import GenevaWheel
from gearcam.linkages.linkage import Linkage, in_order
from gearcam.numeric.arrays import Array

if TYPE_CHECKING:
    from gearcam.kinds.mechanism.design import MechanismDesign
    from gearcam.kinds.mechanism.tables import CrankSpec, DyadSpec, GuideSpec

_TURN: Final = 2.0 * math.pi

_CYCLES: Final = 100
"""Largest number of turns of the master after which a mechanism repeats."""

_WHOLE: Final = 1e-7
"""How far from whole turns a shaft may be after a cycle, rad: the error of its law."""

_PLACES: Final = 9
"""Places at which a slide is compared with itself after a cycle."""

_FORMULA: Final = 721
"""Places at which the formula of a slide must be finite."""

_SAME: Final = 1e-9
"""Knots closer than this are one, rad."""


def make_linkage(design: MechanismDesign, drives: Sequence[PlacedDrive]) -> Linkage:
    """Return the linkage of a mechanism over one cycle of its master.

    Parameters
    ----------
    design : MechanismDesign
        The design.
    drives : sequence of PlacedDrive
        Its drives with their laws.

    Returns
    -------
    Linkage

    Raises
    ------
    InfeasibleError
        If it does not close over the master's whole range.
    """
    (low, high), closed = _span(drives, _indexed(design))
    inner = [one.knots_in(low, high, not number) for number, one in enumerate(drives)]
    knots = _apart(np.unique(np.concatenate([[low, high], *inner])))
    parts = list(in_order(_elements(design, drives)))
    linkage = _with_rests(Linkage(parts, knots, closed))
    _demand_part(design, linkage)
    knots = linkage.knots
    for number, dyad in enumerate(parts):
        wanted = _near(design, dyad)
        if wanted is not None and isinstance(dyad, Dyad):
            parts[number] = _nearer(linkage, dyad, wanted, min(max(0.0, low), high))
            linkage = Linkage(tuple(parts), knots, closed)
    try:
        return _whole_cycle(linkage)
    except NotClosingError as error:
        if isinstance(error.closing.element, HoistChain):
            raise _chain_refusal(design, error.closing.element, error, linkage) from None
        raise _refusal(design, error) from None


def _whole_cycle(linkage: Linkage) -> Linkage:
    """Return a settled linkage over a cycle after which its dyads are in their first positions.

    A dyad that goes through an odd number of change points in a cycle is in its other position at
    the end: it repeats after two.
    """
    found = settled(linkage)
    turned = (one for one in found.dyads if one.keeps == MOTION and len(one.changes) % 2)
    if not linkage.closed or next(turned, None) is None:
        return found
    knots = linkage.knots
    twice = np.concatenate([knots, knots[1:] + (knots[-1] - knots[0])])
    return settled(replace(linkage, knots=twice))


def _with_rests(linkage: Linkage) -> Linkage:
    """Return a linkage with the knots at which Geneva wheels begin and end to turn."""
    for one in linkage.elements:
        if isinstance(one, GenevaWheel):
            shaft = partial(linkage.track, one.shaft)
            linkage = replace(linkage, knots=one.knots(shaft, linkage.knots))
    return linkage


def _indexed(design: MechanismDesign) -> int:
    """Return after how many turns of their cranks all Geneva wheels that move others are back."""
    parts = {title: getattr(design, title) for title in PARTS}
    used = {one.name for one in needed(parts)}
    return math.lcm(*(one.slots for one in design.geneva if one.name in used))


def _span(drives: Sequence[PlacedDrive], least: int) -> tuple[tuple[float, float], bool]:
    """Return the master's first and last angle, and whether the motion repeats after them."""
    _demand_finite(drives)
    master = drives[0]
    if not master.closed or master.spec.span is not None:
        part = _part_of(master)
        _demand_inside(drives, part)
        return part, False
    for number, drive in enumerate(drives[1:], start=1):
        if not drive.closed:
            raise InfeasibleError(
                f"{drive.spec.name} does not turn all the way, as the master does",
                where=f"drive[{number}]",
                nearest="only the first drive may be open",
            )
    late = 0
    for turns in range(least, _CYCLES * least + 1, least):
        found = (number for number, one in enumerate(drives) if not _back(one, number, turns))
        late = next(found, -1)
        if late < 0:
            return (0.0, turns * _TURN), True
    raise InfeasibleError(
        f"{drives[late].spec.name} does not return within {_CYCLES} turns of the master",
        where=f"drive[{late}]",
    )


def _part_of(master: PlacedDrive) -> tuple[float, float]:
    """Return the master's first and last angle where it does not turn all the way."""
    low, high = float(master.knots[0]), float(master.knots[-1])
    asked = master.spec.span
    if asked is None:
        return low, high
    beyond = [k for k in (0, 1) if not low <= asked[k] <= high and not master.closed]
    if beyond:
        raise InfeasibleError(
            "the pair does not turn as far",
            where=f"drive[0].range_deg[{beyond[0]}]",
            value=math.degrees(asked[beyond[0]]),
            limit=math.degrees((low, high)[beyond[0]]),
            unit="deg",
        )
    return asked


def _demand_inside(drives: Sequence[PlacedDrive], part: tuple[float, float]) -> None:
    """Refuse open drives that a range of the master takes beyond their ends."""
    for number, drive in enumerate(drives[1:], start=1):
        own = sorted(drive.spec.ratio * q + drive.spec.phase for q in part)
        ends = float(drive.knots[0]), float(drive.knots[-1])
        if not drive.closed and (own[0] < ends[0] - _WHOLE or own[1] > ends[1] + _WHOLE):
            goes, allowed = ([formatted(math.degrees(q), 6) for q in two] for two in (own, ends))
            raise InfeasibleError(
                f"{drive.spec.name} would turn from {goes[0]} to {goes[1]} deg, beyond its ends",
                where=f"drive[{number}]",
                nearest=f"it turns from {allowed[0]} to {allowed[1]} deg: another phase_deg or "
                "range_deg of the first drive",
            )


def _demand_part(design: MechanismDesign, linkage: Linkage) -> None:
    """Refuse chains on shafts that turn without end."""
    if not linkage.closed:
        return
    pulled = [(f"hoist[{number}]", one.on) for number, one in enumerate(design.hoist)]
    pulled += [(f"chain[{number}]", one.on) for number, one in enumerate(design.chain)]
    for where, shaft in pulled:
        first, last = np.asarray(linkage.track(shaft, linkage.knots[[0, -1]], 0).c[0])
        if abs(last - first) > _WHOLE * _CYCLES:
            raise InfeasibleError(
                "its chain is not back after a turn of the master",
                where=where,
                nearest="give drive[0].range_deg, over which it winds up and off",
            )


def _back(drive: PlacedDrive, number: int, turns: int) -> bool:
    """Return whether a drive is where it was after some turns of the master."""
    if drive.spec.slide is not None:  # a formula in the master's angle may repeat later
        q = np.linspace(0.0, _TURN, _PLACES)
        moved = [one.law(np.stack([q, q + turns * _TURN]), 0).c[0] for one in drive.moved.values()]
        places = np.asarray(moved)
        return bool(np.ptp(places, axis=1).max() <= _WHOLE * turns * (1.0 + np.abs(places).max()))
    ratio = drive.spec.ratio if number else 1
    ends = np.array([0.0, ratio * turns * _TURN])
    shafts = [one.law for one in drive.moved.values() if not one.along]
    found = [float(np.diff(np.asarray(law(ends, 0).c[0]))[0]) for law in shafts]
    return all(abs(math.remainder(end, _TURN)) < _WHOLE * turns for end in found)


def _demand_finite(drives: Sequence[PlacedDrive]) -> None:
    """Refuse slides whose formulas have no place somewhere in the master's range."""
    whole = drives[0].closed and drives[0].spec.span is None
    q = np.linspace(*((0.0, _TURN) if whole else _part_of(drives[0])), _FORMULA)
    for number, drive in enumerate(drives):
        if drive.spec.slide is None:
            continue
        with np.errstate(all="ignore"):
            found = drive.moved["slide"].law(q, 3).derivatives()
        bad = ~np.all([np.isfinite(one + 0.0 * q) for one in found], axis=0)
        bad |= np.abs(found[0] + 0.0 * q) > LONGEST
        if bad.any():
            at = formatted(math.degrees(q[bad][0]), 6)
            raise InfeasibleError(
                f"the place or its derivatives are not finite at {at} deg",
                where=f"drive[{number}].slide",
            )


def _apart(knots: Array) -> Array:
    """Return rising angles without those that are the same but for rounding, rad."""
    kept = knots[np.concatenate([[True], np.diff(knots) > _SAME])]
    kept[-1] = knots[-1]
    return kept


def _elements(design: MechanismDesign, drives: Sequence[PlacedDrive]) -> Iterator[Element]:
    for number, drive in enumerate(drives):
        yield from drive.elements(not number)
    for joint in design.joint:
        yield MemberPoint(joint.name, complex(*joint.at))
    for number, crank in enumerate(design.crank):
        start = _start(crank, number, drives)
        center = crank.at or center_of(crank.on)
        yield Crank(crank.name, crank.on, center, crank.joint, crank.length, start)
    for slide in design.slide:
        if not any(slide.at):
            yield PushedSlide(slide.name, slide.on, way_of(slide.on), slide.joint)
        else:
            hidden = f"{slide.name}.end"
            yield PushedSlide(slide.name, slide.on, way_of(slide.on), hidden)
            yield MemberPoint(slide.joint, complex(*slide.at), slide.name)
    for guide in design.guide:
        yield _guide(guide, design, drives)
    for dyad in design.dyad:
        yield _dyad(dyad)
    for point in design.point:
        yield MemberPoint(point.name, complex(*point.at), point.on)
    yield from _pulled(design)


def _guide(spec: GuideSpec, design: MechanismDesign, drives: Sequence[PlacedDrive]) -> GuideLine:
    """Return a guide through its point, or through a joint or a shaft that stands still."""
    at = complex(*spec.at)
    if spec.through is not None:
        at += _standing(spec.through, design, drives)
    return GuideLine(spec.name, at, spec.direction, spec.on)


def _standing(name: str, design: MechanismDesign, drives: Sequence[PlacedDrive]) -> complex:
    """Return where a joint that stands still, or a shaft of a drive, is."""
    for joint in design.joint:
        if joint.name == name:
            return complex(*joint.at)
    drive, moved = next(
        (drive, one)
        for drive in drives
        for word, one in drive.moved.items()
        if name in (drive.spec.name, f"{drive.spec.name}.{word}")
    )
    return drive.machine(moved.at)


def _pulled(design: MechanismDesign) -> Iterator[Element]:
    """Yield what wheels pull by chains: straight, and levers."""
    for hoist in design.hoist:
        way, guide = f"{hoist.name}.way", f"{hoist.name}.guide"
        radius = hoist.radius if hoist.wind == "ccw" else -hoist.radius
        yield WoundWay(way, hoist.on, radius)
        yield GuideLine(guide, complex(*hoist.at), hoist.direction)
        yield PushedSlide(hoist.name, way, guide, hoist.joint)
    for wheel in design.geneva:
        center = wheel.at or center_of(wheel.on)
        yield GenevaWheel(
            wheel.name, wheel.on, center, wheel.length, wheel.slots, wheel.direction, wheel.angle,
            wheel.internal,
        )  # fmt: skip
    for chain in design.chain:
        yield HoistChain(
            chain.lever,
            chain.joint,
            chain.on,
            complex(*chain.hinge),
            complex(*chain.at),
            chain.radius,
            chain.length,
            chain.start,
            chain.range,
            1.0 if chain.wind == "ccw" else -1.0,
        )


def _start(crank: CrankSpec, number: int, drives: Sequence[PlacedDrive]) -> float:
    """Return a crank's direction at the drive's zero, rad."""
    if crank.arm_angle is None:
        return crank.angle or 0.0
    name, _, word = crank.on.rpartition(".")
    drive = next((one for one in drives if one.spec.name == name), None)
    arm = math.nan if drive is None else drive.moved[word].arm
    if drive is None or math.isnan(arm):
        raise InfeasibleError(
            f"{crank.on} has no arm from which it could count",
            where=f"crank[{number}].arm_angle_deg",
            nearest="angle_deg instead",
        )
    turn = -crank.arm_angle if drive.spec.mirror else crank.arm_angle
    return cmath.phase(drive.vector(cmath.exp(1j * arm))) + turn


def _dyad(spec: DyadSpec) -> Dyad:
    lengths = Lengths(*spec.lengths, spec.beta, *spec.gammas)
    second = spec.branch in ("right", "behind")
    return Dyad(
        spec.formula,
        spec.first,
        spec.last,
        spec.joint,
        spec.members,
        lengths,
        -1.0 if second else 1.0,
        spec.driven,
        spec.change,
    )


def _near(design: MechanismDesign, dyad: Element) -> complex | None:
    specs = (one for one in design.dyad if one.joint == dyad.gives[0])
    spec = next(specs, None) if isinstance(dyad, Dyad) else None
    return None if spec is None or spec.near is None else complex(*spec.near)


def _nearer(linkage: Linkage, dyad: Dyad, wanted: complex, q: float) -> Dyad:
    """Return a dyad in the position that is nearer to a place at an angle of the master, rad."""
    known = linkage.at(np.array([q]), 0, dyad)
    both = [replace(dyad, sign=sign) for sign in (1.0, -1.0)]
    apart = [abs(complex(np.asarray(one.solution(known).joint.c[0])[0]) - wanted) for one in both]
    return both[int(np.argmin(apart))] if np.isfinite(apart).all() else dyad


def _refusal(design: MechanismDesign, error: NotClosingError) -> InfeasibleError:
    """Return why a mechanism does not move over its master's whole range."""
    found, element = error.closing, error.closing.element
    title, number = _table(design, element)
    name = element.gives[0]
    what = f"{name} does not close over the whole range: {_ranges(found.ranges)}"
    if found.least > -1e-9:
        at = formatted(math.degrees(found.place), 8)
        what = f"{name} is singular at {at} deg: its guides or members are in line there"
    lengths = [_keyed(title, number, one) for one in error.nearest]
    if not lengths:
        return InfeasibleError(what, where=f"{title}[{number}]")
    ways = [_lengthened(design, one) for one in lengths]
    key, value = next(iter(lengths[0].items()))
    if len(lengths[0]) > 1:
        both = " and ".join(
            f"{k} = {formatted(v)} ({_member(element, k)})" for k, v in lengths[0].items()
        )
        note = f"one length alone cannot do it; with {both} it closes"
        return InfeasibleError(what, where=f"{title}[{number}]", nearest=note, adjustments=ways)
    return InfeasibleError(
        what,
        where=key,
        value=float(element.lengths[int(key[-2])]),  # pyright: ignore[reportAttributeAccessIssue]
        limit=value,
        unit="mm",
        nearest=f"length of {_member(element, key)}; just inside the limit, where both positions "
        "meet",
        adjustments=ways,
    )


def _member(dyad: Element, key: str) -> str:
    """Return the member whose length a key gives."""
    return dyad.members[int(key[-2])]  # pyright: ignore[reportAttributeAccessIssue]


_WIDER: Final = (5.0, 15.0, 45.0, 90.0)
"""By how much the range of a lever is widened in the search for one that is wide enough, deg."""


def _chain_refusal(
    design: MechanismDesign, chain: HoistChain, error: NotClosingError, linkage: Linkage
) -> InfeasibleError:
    """Return which limit of its range a lever reaches, and which range would be wide enough."""
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


_FURTHER: Final = 2.0
"""How many times further than the least change a length is changed in the search for remedies."""


def _keyed(title: str, number: int, lengths: dict[int, float]) -> dict[str, float]:
    """Return lengths by their keys."""
    return {
        f"{title}[{number}].lengths_mm[{k}]": float(formatted(value, 6))
        for k, value in lengths.items()
    }


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
