"""Checks of continuous drive: of a pair as designed and, in a study, as mounted.

A check takes an object with `sides`, the pairs of flanks of the coast and driving side. Importing
this module registers the checks.
"""

from __future__ import annotations

import math
from collections.abc import Iterator
from typing import Protocol

from gearcam.base.findings import Remark, Severity, check
from gearcam.base.numerals import FEW, formatted
from gearcam.base.readable import readable
from gearcam.gears.contact import DRIVE, FlankPairs
from gearcam.gears.subject import CONTACT_RATIO
from gearcam.gears.subject import KIND as PAIR_KIND
from gearcam.meshing.edges import NonContact, non_contact
from gearcam.meshing.settings import KIND
from gearcam.numeric.arrays import Array, Mask, runs_of

_SHOWN = 3
"""Largest number of driver-angle ranges that a finding lists."""

_FEW = "Too few tooth pairs are in contact at a time."


class Sided(Protocol):
    """Input of these checks."""

    @property
    def sides(self) -> tuple[FlankPairs, ...]:
        """The pairs of flanks of each side."""
        ...


def ranges_text(ranges: list[tuple[float, float]]) -> str:
    """Return ranges of driver angles, rad, as text in degrees; with the number of those omitted."""
    degrees = [(math.degrees(a), math.degrees(b)) for a, b in ranges[:_SHOWN]]
    named = [
        f"{formatted(a, FEW)}" if a == b else f"{formatted(a, FEW)} to {formatted(b, FEW)}"
        for a, b in degrees
    ]
    more = f" and {len(ranges) - _SHOWN} more" if len(ranges) > _SHOWN else ""
    return f"phi1 = {', '.join(named)} deg{more}"


def rows_text(phi1: Array, mask: Mask) -> str:
    """Return as text the ranges of driver angles where a mask holds.

    Parameters
    ----------
    phi1 : (n,) array, rad
        Driver angles, ascending.
    mask : (n,) bool array
        Where it holds; neighbouring rows are one range.
    """
    return ranges_text([(float(phi1[first]), float(phi1[last])) for first, last in runs_of(mask)])


def arcs_text(found: list[NonContact]) -> str:
    """Return the stretches as text."""
    return ranges_text([(each.start, each.end) for each in found])


def side_name(pairs: FlankPairs) -> str:
    """Return the driving direction of a side, as text."""
    return "driving forward" if pairs.side == DRIVE else "driving backward"


def _repeats(pairs: FlankPairs) -> str:
    return ", in each lobe" if pairs.closed and pairs.even and pairs.track.periods > 1 else ""


@check(
    "contact-ratio",
    kind=(PAIR_KIND, KIND),
    limit=CONTACT_RATIO,
    relation="at least",
    severity=("warning", "error"),
)
def contact_ratio(subject: Sided, limit: float) -> Iterator[Remark]:
    """Warn of a low contact ratio.

    It is an error below 1, or where no flanks touch. `gearcam mesh` checks the pair as mounted.
    Equal values for both directions are reported once.

    Looks at: smallest contact ratio of any flank, both sides; stretches without contact of flanks.
    """
    places_by_message: dict[str, list[tuple[float, str]]] = {}
    for pairs in subject.sides:
        worst, gaps = float(pairs.arcs.ratios.min()), non_contact(pairs)
        if worst >= limit and not gaps:
            continue
        tooth = int(pairs.wheels[0].number(pairs.numbers)[pairs.arcs.weakest])
        message = _FEW
        if gaps and all(stretch.edges for stretch in gaps):
            apart = max(stretch.apart for stretch in gaps)
            off = readable(apart, "mm", digits=3)
            message = (
                f"No flanks touch at {arcs_text(gaps)}{_repeats(pairs)}. There tooth edges drive: "
                f"they scrape, and the driven wheel is up to {off} off its position along the "
                "pitch curve."
            )
        elif gaps:
            message = (
                f"No flanks touch at {arcs_text(gaps)}{_repeats(pairs)}, and in part of this "
                "range nothing drives at all."
            )
        elif worst < 1.0:
            message = "This flank is in contact for less than a pitch; then its neighbours drive."
        place = f"{side_name(pairs)}, wheel 1, tooth {tooth}"
        places_by_message.setdefault(message, []).append((worst, place))
    for message, sides in places_by_message.items():
        where = "; ".join(place for _, place in sides)
        severity: Severity = "warning" if message == _FEW else "error"
        worst = min(sides)[0]
        # even with a contact ratio above 1 some phases may have no contact
        yield Remark(message, where, worst, severity, limit=limit if worst < limit else math.inf)


@check("nothing-drives", kind=KIND, severity="error", unit="deg")
def nothing_drives(subject: Sided, limit: float) -> Iterator[Remark]:  # noqa: ARG001
    """Report the arcs on which neither flanks nor tooth edges touch.

    Looks at: arcs of the driver's turn without any contact.
    """
    for pairs in subject.sides:
        empty = [stretch for stretch in non_contact(pairs) if not stretch.edges]
        if empty:
            yield Remark(
                "On parts of these arcs neither flanks nor tooth edges reach the mate: "
                "the pair jumps or stops there.",
                f"{side_name(pairs)}, {arcs_text(empty)}{_repeats(pairs)}",
                math.degrees(sum(stretch.end - stretch.start for stretch in empty)),
            )
