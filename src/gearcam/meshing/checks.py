"""The checks of a meshing study; importing this module registers them.

A check takes a `Meshing` and yields findings. Values and limits are in the units of design files.
"""

from __future__ import annotations

import math
from collections.abc import Iterator

import numpy as np

from gearcam.base.findings import Remark, check
from gearcam.base.numerals import FEW, formatted
from gearcam.base.quantities import NUMBER, Param
from gearcam.gears.contact import DRIVE
from gearcam.meshing import drive_checks
from gearcam.meshing.settings import KIND
from gearcam.meshing.study import Meshing, explained
from gearcam.numeric.arrays import Array, Mask

_CLEARANCE = (
    "tip_clearance",
    Param(NUMBER, ge=0, le=1, doc="least clearance of tips from the mate's root, in modules"),
    0.1,
)
_UNPREDICTED = 0.5
"""Share of the penetration from which an overlap that no flank predicts is reported."""

_PASSED = 1e-9
"""Share of the travel by which rounding may move a tooth beyond its end."""


def spans(angles: Array, step: float) -> str:
    """Return phases as ranges in degrees, with the number of ranges omitted.

    Parameters
    ----------
    angles : (n,) array, rad
        Rising.
    step : float, rad
        Difference between successive phases.

    Returns
    -------
    str
    """
    cuts = np.flatnonzero(np.diff(angles) > 1.5 * step)
    starts, ends = np.append(0, cuts + 1), np.append(cuts, len(angles) - 1)
    return drive_checks.ranges_text(list(zip(angles[starts], angles[ends], strict=True)))


def _at(meshing: Meshing, chosen: Mask) -> str:
    start, end = meshing.setup.stretch
    return spans(meshing.phi1[chosen], (end - start) / meshing.setup.spec.steps)


@check("interference", kind=KIND, relation="at most", severity="error", unit="mm")
def interference(meshing: Meshing, limit: float) -> Iterator[Remark]:
    """Report outlines that overlap where they should not.

    Looks at: overlap away from the contact, or deeper than the overclosure explains.
    """
    hit = meshing.every("interferes").astype(bool)
    if not hit.any():
        return
    backlash = meshing.every("backlash")
    worst = int(np.where(np.isfinite(backlash), backlash, np.inf).argmin())
    deepest = -float(backlash[worst])
    limit = meshing.setup.noise
    angle = formatted(math.degrees(meshing.phi1[worst]), FEW)
    where = f"flanks of both sides overlap, phi1 = {angle} deg"
    for block in meshing.blocks:
        overlaps, turning = block.overlaps, meshing.setup.turning
        most = explained(meshing.setup, overlaps)
        bad = np.where(overlaps.depth > most, overlaps.depth, 0.0)
        if bad.size and bad.max() > deepest:
            k = int(bad.argmax())
            deepest, limit = float(bad[k]), float(most[k])
            one, two = (
                f"tooth {tooth}" if tooth is not np.ma.masked else "the body"
                for tooth in (
                    turning.driver.tooth(overlaps.half[0])[k],
                    turning.driven.tooth(overlaps.half[1])[k],
                )
            )
            angle = math.degrees(block.phi1[overlaps.step[k]])
            where = f"deepest at phi1 = {formatted(angle, FEW)} deg, {one} in {two}"
    yield Remark(
        f"The wheels overlap at {_at(meshing, hit)}.",
        where,
        deepest,
        limit=limit,
    )


@check("edge-contact", kind=KIND, unit="phases")
def edge_contact(meshing: Meshing, limit: float) -> Iterator[Remark]:  # noqa: ARG001
    """Warn of phases in which a tooth edge touches first and positions the driven wheel.

    Looks at: phases in which an edge touches before the flanks do.
    """
    edge = meshing.every("edge").astype(bool)
    if edge.any():
        yield Remark(
            "A tooth edge touches before the flanks do: it scrapes, and the motion differs from "
            "that of the law.",
            _at(meshing, edge),
            float(np.count_nonzero(edge)),
        )


@check("fillet-interference", kind=KIND, unit="phases")
def fillet_interference(meshing: Meshing, limit: float) -> Iterator[Remark]:  # noqa: ARG001
    """Warn of outlines that touch on a fillet or a tip.

    Looks at: contact of the outlines outside the active flanks.
    """
    least = max(_UNPREDICTED * meshing.setup.penetration, meshing.setup.noise)
    rows = meshing.columns
    strange = meshing.on_side & np.ma.getmaskarray(rows["predicted_mm2"])
    strange &= rows["depth_mm"].filled(0.0) > least
    off = np.zeros(len(meshing.phi1), dtype=bool)
    off[rows["step"].data[strange].astype(np.int64)] = True
    if off.any():
        yield Remark(
            "The outlines touch outside the active flanks: on a fillet or a tip.",
            _at(meshing, off),
            float(np.count_nonzero(off)),
        )


@check("tip-clearance", kind=KIND, limit=_CLEARANCE, relation="at least", unit="modules")
def tip_clearance(meshing: Meshing, limit: float) -> Iterator[Remark]:
    """Warn of tips that come close to the root of the mate.

    Looks at: the smallest distance of the middle of a tip from the root of the mate as the tooth
    passes the pitch point.
    """
    module = meshing.setup.pairs[DRIVE].pitch / math.pi
    for wheel, distances in enumerate(clearances(meshing), start=1):
        least = float(distances.min()) / module
        if least < limit:
            yield Remark(
                "The tip comes this close to the root of the mate, or touches it.",
                f"wheel {wheel}, tooth {int(distances.argmin()) + 1}",
                least,
            )


def clearances(meshing: Meshing) -> list[Array]:
    """Return the distances of the middles of tips from the outlines of their mates.

    Parameters
    ----------
    meshing : Meshing
        A study.

    Returns
    -------
    list of (z1,) and (z2,) array, mm
        For each whole tooth of both wheels, at the phase at which its middle passes the pitch
        point; 0 inside the mate. Of a closed wheel on a rack only the teeth that pass it.
    """
    turning, pairs = meshing.setup.turning, meshing.setup.pairs[DRIVE]
    result = []
    for own, mate, toothing in (
        (turning.driver, turning.driven, pairs.wheels[0].toothing),
        (turning.driven, turning.driver, pairs.wheels[1].toothing),
    ):
        places = toothing.tooth_places[toothing.whole]
        phi1 = turning.rolling.arc.angle(places)
        passed = phi1 <= pairs.travel * (1.0 + _PASSED)
        phi1 = phi1[passed]
        pose = turning.pose(phi1, 0.0)
        # a half-tooth begins in the middle of its tip
        numbers = np.array(toothing.numbers)[toothing.whole][passed]
        tips = own.tips[np.searchsorted(own.teeth, numbers)]
        pose = pose if toothing.wheel == 1 else pose.inverse
        result.append(mate.distance(pose.apply(tips)))
    return result
