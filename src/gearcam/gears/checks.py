"""The checks of a gear pair's teeth; importing this module registers those of its centrodes too.

A check takes a `Subject` and yields findings. Values and limits of findings are in the units of
design files.
"""

from __future__ import annotations

import math
from collections.abc import Iterator

import numpy as np

from gearcam.base.findings import ROUNDING, Remark, Severity
from gearcam.base.numerals import rounded_down, shown
from gearcam.base.quantities import LENGTH, NUMBER, Param
from gearcam.gears import centrode_checks
from gearcam.gears.cutter import Cutter
from gearcam.gears.pair import Gear
from gearcam.gears.subject import CONTACT_RATIO, KIND, Subject, pair_check
from gearcam.laws.ratio.span import angle_text

__all__ = [
    "KIND", "Subject", "centrode_checks", "largest_module", "tooth_ranges", "undercut_curvatures",
]  # fmt: skip

_POINTED = 1e-9
"""Thickness of a tip, in modules, below which the tooth counts as pointed."""


def tooth_ranges(numbers: tuple[int, ...] | list[int]) -> str:
    """Return tooth numbers as ranges: ``15, 17-18``."""
    spans: list[list[int]] = []
    for number in numbers:
        if spans and number == spans[-1][1] + 1:
            spans[-1][1] = number
        else:
            spans.append([number, number])
    return ", ".join(f"{a}" if a == b else f"{a}-{b}" for a, b in spans)


def largest_module(gear: Gear) -> float:
    """Return the largest module without undercut, on either side of the pitch curve, mm.

    ``m = rho_min*sin(alpha)^2/h`` on convex parts with the depth h of the straight flank in
    modules, 1 for the common rack (0.99997 exactly, which counts as full), and on concave parts
    with the depth to which the mate's flanks reach. This is sufficient; a flank may end sooner.

    Parameters
    ----------
    gear : Gear
        The wheel.

    Returns
    -------
    float
        For the same centre distance and other tooth counts.
    """
    track, (convex, concave) = gear.toothing.track, undercut_curvatures(gear)
    return gear.pair.module * min(convex * track.convex.radius, concave * track.concave.radius)


def undercut_curvatures(gear: Gear) -> tuple[float, float]:
    """Return the largest curvatures of its centrode without undercut (see `largest_module`).

    Parameters
    ----------
    gear : Gear
        The wheel.

    Returns
    -------
    convex, concave : float, 1/mm
        Both positive.
    """
    own, mate = gear.toothing.cutter, gear.pair.toothings[2 - gear.wheel].cutter
    factor = math.sin(own.alpha) ** 2 / gear.pair.module
    return factor / _straight_depth(own), factor / _straight_depth(mate)


def _straight_depth(cutter: Cutter) -> float:
    """Depth of a rack's straight flank, modules; a pinion cutter's at a small module."""
    depth = cutter.depth + cutter.tip_radius * math.sin(cutter.alpha)
    return math.ceil(depth * math.pi / cutter.pitch * 1e4 - 0.5) / 1e4


@pair_check("undercut", limit=CONTACT_RATIO, severity=("warning", "error"), unit="teeth")
def undercut(subject: Subject, limit: float) -> Iterator[Remark]:
    """Warn of undercut flanks.

    An error if there are phases without contact of flanks, or if the remaining contact ratio is
    below the limit.

    Looks at: flanks cut away by the cutter, and the remaining contact ratio.
    """
    ratio = subject.contact_ratio
    driven = subject.driven
    severity: Severity = "warning" if driven and ratio >= limit else "error"
    left = f"the least remaining contact ratio is {shown(ratio, 4)}"
    if not driven:
        left += ", and there are phases in which no flanks touch"
    elif ratio < limit:
        left += f", below the limit {shown(limit, 4)}"
    for gear in subject.gears:
        teeth = gear.profile.undercut_teeth
        if not teeth:
            continue
        flanks, best = gear.profile.flanks, largest_module(gear)
        below = np.isfinite(flanks.cusps.dedendum)
        message = f"Undercut removes flanks from above the pitch curve; {left}."
        factor = subject.pair.module / best
        fewest = math.ceil(gear.toothing.teeth * factor * (1.0 - ROUNDING))
        if below.any():
            slope = math.sin(gear.toothing.cutter.alpha) * math.cos(gear.toothing.cutter.alpha)
            lost = float((flanks.lowest + gear.toothing.cutter.reach)[below].max()) * slope
            message = (
                f"Undercut removes up to {shown(lost, 4)} mm of these flanks at the root; {left}."
            )
        yield Remark(
            f"{message} {subject.with_teeth(factor)} this wheel has no undercut.",
            f"wheel {gear.wheel}, teeth {tooth_ranges(teeth)}",
            gear.toothing.teeth,
            severity=severity,
            limit=fewest,
        )


@pair_check(
    "thin-tip",
    limit=("tip_thickness", Param(NUMBER, ge=0, doc="least tip thickness, in modules"), 0.2),
    unit="modules",
)
def thin_tip(subject: Subject, limit: float) -> Iterator[Remark]:
    """Warn of teeth with thin or pointed tips.

    Looks at: the thickness of the teeth at their tips.
    """
    for gear in subject.gears:
        thickness = gear.profile.tip_thickness / subject.pair.module
        thin = np.flatnonzero(thickness < limit)
        if thin.size:
            state = "pointed" if thickness.min() < _POINTED else "thin"
            yield Remark(
                f"The tips of these teeth are {state}.",
                f"wheel {gear.wheel}, teeth {tooth_ranges([int(k) + 1 for k in thin])}",
                float(thickness.min()),
            )


@pair_check(
    "short-flank",
    limit=("tip_height", Param(NUMBER, ge=0, le=1, doc="least tip height, in addenda"), 0.9),
    severity="note",
    unit="addenda",
)
def short_flank(subject: Subject, limit: float) -> Iterator[Remark]:
    """Note flanks that end well below the addendum curve.

    Looks at: the height at which flanks end.
    """
    for gear in subject.gears:
        height = gear.profile.tip_height / gear.toothing.cutter.addendum
        short = np.flatnonzero(height < limit)
        if short.size:
            yield Remark(
                "These flanks end below the addendum curve: where the mate's flank ends, at an "
                "undercut, or because the tooth is pointed.",
                f"wheel {gear.wheel}, teeth {tooth_ranges([int(k) + 1 for k in short])}",
                float(height.min()),
            )


@pair_check(
    "tips-collide",
    limit=("tip_pass", Param(LENGTH, ge=0, doc="least margin by which tips pass each other"), 0.0),
    severity=("error", "warning"),
)
def tips_collide(subject: Subject, limit: float) -> Iterator[Remark]:
    """Report tip interference of an internal pair: tips that collide outside the mesh.

    A warning if they pass each other by less than the limit.

    Looks at: the tips of wheel 1 as they enter and leave the ring.
    """
    found = subject.tip_pass
    if found is None or found.margin >= limit:
        return
    message = "Tips pass each other by little outside the mesh."
    if found.margin < 0.0:
        message = (
            "Tips collide outside the mesh: as it enters or leaves the ring, a tip corner of wheel "
            f"1 overlaps a tooth of the ring by {shown(-found.margin)} mm along the pitch curve."
        )
    if found.margin < -0.5 * subject.pair.toothings[1].pitch:  # no tooth is as wide
        message = (
            "The wheel does not fit into its ring: outside the mesh a tip corner of wheel 1 passes "
            "through the ring's teeth into its rim."
        )
    yield Remark(
        message,
        f"wheel 1, tooth {found.tooth}, {angle_text(found.phi1)}",
        found.margin,
        severity="error" if found.margin < 0.0 else "warning",
    )


@pair_check(
    "thin-rim",
    limit=("rim_thickness", Param(NUMBER, ge=0, doc="least rim, in modules"), 2.7),
    unit="modules",
)
def thin_rim(subject: Subject, limit: float) -> Iterator[Remark]:
    """Warn of a thin rim; the default limit is 1.2 depths of a standard tooth.

    Looks at: the metal between bore and root, or outside the roots of a ring.
    """
    least = limit * subject.pair.module
    more = "more teeth (a smaller module) or a larger centre distance leave more metal"
    for rim, gear in subject.rims:
        if rim < least * (1.0 - ROUNDING):  # the bore or rim that is named passes
            largest, given = 2.0 * (gear.least_radius - least), 2.0 * (gear.least_radius - rim)
            what, hint = "between bore and root", more
            if gear.ring:
                what = "outside the roots"
                across = shown(2.0 * (gear.largest_radius + least), 12)
                hint = f"ring.rim_mm = {shown(least, 12)} keeps the limit, or for a round outside "
                hint += f"ring.outer_diameter_mm = {across}"
            elif largest >= 0.5 * given:
                hint = (
                    f"a bore up to {rounded_down(largest)} mm across, keyway included, keeps the "
                    "limit"
                )
            yield Remark(
                f"The rim {what} is {shown(rim)} mm thick; {hint}.",
                f"wheel {gear.wheel}",
                rim / subject.pair.module,
            )


@pair_check(
    "no-backlash",
    limit=("backlash", Param(LENGTH, ge=0, doc="least backlash that is not reported"), 0.01),
    severity="note",
)
def no_backlash(subject: Subject, limit: float) -> Iterator[Remark]:
    """Note that the wheels have no backlash.

    Looks at: the backlash between flanks, including that of `blank.clearance_mm`.
    """
    if subject.backlash < limit * (1.0 - ROUNDING):
        yield Remark(
            "The wheels have no backlash: printed wheels need some, and so does any error of the "
            "centre distance.",
            "pair",
            max(subject.backlash, 0.0),
        )
