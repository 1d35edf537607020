"""From the tables of a mechanism to its linkage, over a cycle of its master."""

from __future__ import annotations

import math
from collections.abc import Sequence
from dataclasses import replace
from typing import TYPE_CHECKING, Final

import numpy as np

from gearcam.base.errors import InfeasibleError
from gearcam.base.numerals import formatted
from gearcam.base.quantities import LONGEST
from gearcam.kinds.mechanism.names import needed, parts_of, standing_places, told_parts
from gearcam.kinds.mechanism.parts.setting import Setting
from gearcam.linkages.closing import NotClosingError, settled
from gearcam.linkages.elements import MOTION
from gearcam.linkages.linkage import Linkage, in_order
from gearcam.linkages.narrow import with_cells
from gearcam.numeric.arrays import Array, apart, distinct

if TYPE_CHECKING:
    from gearcam.kinds.mechanism.names import Tables
    from gearcam.kinds.mechanism.placed import PlacedDrive

_SAME: Final = 1e-9
"""Knots closer than this are one, rad."""

_TURN: Final = 2.0 * math.pi

_CYCLES: Final = 100
"""Largest number of turns of the master after which a mechanism repeats."""

_WHOLE: Final = 1e-7
"""How far from whole turns a shaft may be after a cycle, rad: the error of its law."""

_FORMULA: Final = 721
"""Places at which the formula of a slide must be finite."""


def make_linkage(tables: Tables, drives: Sequence[PlacedDrive]) -> Linkage:
    """Return the linkage of a mechanism over one cycle of its master.

    Parameters
    ----------
    tables : mapping of str to tables
        Of its design, by title.
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
    parts = {f"{title}[{number}]": part for title, number, part in parts_of(tables)}
    (low, high), closed = _cycle_of(drives, _period(tables))
    _demand_on_plates(drives, (low, high))
    inner = [one.knots_in(low, high) for one in drives]
    knots = apart(distinct(*inner, [low, high]), _SAME)
    knots[-1] = high  # rather than one that differs by rounding
    knots = with_cells([one.cells_in(low, high) for one in drives], knots)
    setting = Setting(standing_places(tables), drives)
    found = [one for number, drive in enumerate(drives) for one in drive.elements(not number)]
    owners = {}
    for where, part in parts.items():
        own = list(part.elements(setting, where))
        found += own
        owners |= {one.gives[0]: where for one in own}
    linkage = Linkage(in_order(found), knots, closed)
    for one in linkage.elements:
        linkage = replace(linkage, knots=one.knots_with(linkage.track, linkage.knots))
    for title, number, part in told_parts(tables):
        part.demand(linkage, f"{title}[{number}]")
    for number, one in enumerate(linkage.elements):
        if one.gives[0] in owners:
            part = parts[owners[one.gives[0]]]
            elements = list(linkage.elements)
            elements[number] = part.chosen(one, linkage, min(max(0.0, low), high))
            linkage = replace(linkage, elements=tuple(elements))
    try:
        return _whole_cycle(linkage)
    except NotClosingError as error:
        where = owners[error.closing.element.gives[0]]
        raise parts[where].refusal(error, linkage, where) from None


def _period(tables: Tables) -> int:
    """Return after how many turns of their shafts all parts that move others are back."""
    used, parts = {one.name for one in needed(tables)}, (part for *_, part in parts_of(tables))
    return math.lcm(*(one.period() for one in parts if used & {use.name for use in one.given()}))


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


def _cycle_of(drives: Sequence[PlacedDrive], least: int) -> tuple[tuple[float, float], bool]:
    """Return the master's first and last angle, and whether the motion repeats after them.

    Parameters
    ----------
    drives : sequence of PlacedDrive
        The master first.
    least : int
        Turns of the master of which the cycle is a multiple.

    Returns
    -------
    (float, float), bool
        Angles in rad.

    Raises
    ------
    InfeasibleError
        If a drive turns beyond its ends, does not return, or has no place somewhere.
    """
    _demand_smooth(drives)
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
        found = (number for number, one in enumerate(drives) if not _back(one, turns))
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
        if drive.closed:
            continue
        own = sorted(drive.own(np.array(part)))
        ends = float(drive.knots[0]), float(drive.knots[-1])
        if own[0] < ends[0] - _WHOLE or own[1] > ends[1] + _WHOLE:
            goes, allowed = ([formatted(math.degrees(q)) for q in two] for two in (own, ends))
            raise InfeasibleError(
                f"{drive.spec.name} would turn from {goes[0]} to {goes[1]} deg, beyond its ends",
                where=f"drive[{number}]",
                nearest=f"it turns from {allowed[0]} to {allowed[1]} deg: another phase_deg or "
                "range_deg of the first drive",
            )


def _back(drive: PlacedDrive, turns: int) -> bool:
    """Return whether a drive is where it was after some turns of the master."""
    if drive.spec.slide is not None:  # a formula in the master's angle may repeat later
        end = turns * _TURN
        # first where it moves in a turn, then in all turns and the next ones
        return _repeats(drive, drive.places, end) and _repeats(
            drive, drive.places_in(0.0, 2.0 * end) % end, end
        )
    ends = np.array([0.0, drive.spec.rate * turns * _TURN])
    shafts = [one.law for one in drive.moved.values() if not one.along]
    found = [float(np.diff(np.asarray(law(ends, 0).c[0]))[0]) for law in shafts]
    # the shaft of a cam in space is not among what it moves
    return all(abs(math.remainder(end, _TURN)) < _WHOLE * turns for end in (ends[1], *found))


def _repeats(drive: PlacedDrive, q: Array, period: float) -> bool:
    """Return whether a slide or a plate is at the same places a period later."""
    places = drive.own(np.stack([q, q + period]))
    allowed = _WHOLE * (period / _TURN) * (1.0 + np.abs(places).max())
    return bool(np.ptp(places, axis=0).max() <= allowed)


def _demand_smooth(drives: Sequence[PlacedDrive]) -> None:
    """Refuse slides and plates whose formulas have no place in the master's range, or jump."""
    whole = drives[0].closed and drives[0].spec.span is None
    ends = (0.0, _TURN) if whole else _part_of(drives[0])
    q = np.linspace(*ends, _FORMULA)
    for number, drive in enumerate(drives):
        if drive.spec.slide is None:
            continue
        with np.errstate(all="ignore"):
            found = drive.place(q, 3).derivatives()
        bad = ~np.all([np.isfinite(one + 0.0 * q) for one in found], axis=0)
        bad |= np.abs(found[0] + 0.0 * q) > LONGEST
        if bad.any():
            at = formatted(math.degrees(q[bad][0]))
            raise InfeasibleError(
                f"the place or its derivatives are not finite at {at} deg",
                where=f"drive[{number}].slide",
            )
        try:
            drive.turns_in(*ends)
        except InfeasibleError as error:
            what, where = f"{error.what} at {error.where}", f"drive[{number}].slide"
            raise InfeasibleError(what, where=where, nearest=error.nearest) from error
    _demand_on_plates(drives, ends)


def _demand_on_plates(drives: Sequence[PlacedDrive], part: tuple[float, float]) -> None:
    """Refuse plates that a range of the master takes beyond their travel."""
    for number, drive in enumerate(drives):
        if drive.spec.slide is None or drive.result is None:
            continue
        from gearcam.cams.carriers import ROUNDING

        q, places = drive.turns_in(*part)
        beyond = np.maximum(-places, places - drive.period)
        worst = int(beyond.argmax())
        if beyond[worst] > ROUNDING * drive.period:
            at, angle = formatted(places[worst]), formatted(math.degrees(q[worst]))
            raise InfeasibleError(
                f"the plate would be at {at} mm at {angle} deg, beyond its travel",
                where=f"drive[{number}].slide",
                nearest=f"places from 0 to {formatted(drive.period)} mm",
            )
