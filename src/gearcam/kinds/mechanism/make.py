"""From the tables of a mechanism to its linkage."""

from __future__ import annotations

import cmath
import math
from collections.abc import Iterator, Sequence
from dataclasses import replace
from typing import TYPE_CHECKING, Final

import numpy as np

from gearcam.base.errors import InfeasibleError
from gearcam.kinds.mechanism.cycle import (
    cycle_of,
    demand_part,
    indexed,
    whole_cycle,
    with_rests,
)
from gearcam.kinds.mechanism.drives import PlacedDrive, center_of, way_of
from gearcam.kinds.mechanism.refusals import chain_refusal, refusal
from gearcam.linkages.chain import HoistChain
from gearcam.linkages.closing import NotClosingError
from gearcam.linkages.dyads import Lengths
from gearcam.linkages.elements import (
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
from gearcam.linkages.narrow import with_cells
from gearcam.numeric.arrays import apart

if TYPE_CHECKING:
    from gearcam.kinds.mechanism.design import MechanismDesign
    from gearcam.kinds.mechanism.tables import CrankSpec, DyadSpec, GuideSpec

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
    (low, high), closed = cycle_of(drives, indexed(design))
    inner = [one.knots_in(low, high) for one in drives]
    knots = apart(np.unique(np.concatenate([[low, high], *inner])), _SAME)
    knots[-1] = high  # rather than one that differs by rounding
    knots = with_cells([one.cells_in(low, high) for one in drives], knots)
    parts = list(in_order(_elements(design, drives)))
    linkage = with_rests(Linkage(parts, knots, closed))
    demand_part(design, linkage)
    knots = linkage.knots
    for number, dyad in enumerate(parts):
        wanted = _near(design, dyad)
        if wanted is not None and isinstance(dyad, Dyad):
            parts[number] = _nearer(linkage, dyad, wanted, min(max(0.0, low), high))
            linkage = Linkage(tuple(parts), knots, closed)
    try:
        return whole_cycle(linkage)
    except NotClosingError as error:
        if isinstance(error.closing.element, HoistChain):
            raise chain_refusal(design, error.closing.element, error, linkage) from None
        raise refusal(design, error) from None


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
    yield from _indexed_and_pulled(design)


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


def _indexed_and_pulled(design: MechanismDesign) -> Iterator[Element]:
    """Yield what shafts index, and what wheels pull by chains: straight, and levers."""
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
    second = spec.branch in spec.branches[1:]
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
