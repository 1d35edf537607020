"""The checks of a gear pair's teeth; importing this room registers those of its centrodes too.

A check sees a `Subject` and yields findings. Values and limits of findings are in the units of
files.
"""

from __future__ import annotations

import math
from collections.abc import Iterator

import numpy as np

from gearcam.findings import Finding, Severity, check
from gearcam.gears import centrode_checks
from gearcam.gears.pair import Gear
from gearcam.gears.subject import KIND, Subject
from gearcam.quantities import LENGTH, NUMBER, Param

__all__ = ["KIND", "Subject", "centrode_checks", "largest_module", "tooth_ranges"]


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
    """Return the largest module without undercut below the pitch curve, mm.

    ``m = rho_min*sin(alpha)^2/h`` with the depth h of the straight flank in modules, 1 for the
    common rack (0.99997 exactly, which counts as full).

    Parameters
    ----------
    gear : Gear
        The wheel.

    Returns
    -------
    float
        For the same centre distance and other tooth counts.
    """
    cutter, module = gear.toothing.cutter, gear.pair.module
    # As a rack, also under a pinion: at a smaller module the pinion comes closer to it.
    depth = round((cutter.depth + cutter.tip_radius * math.sin(cutter.alpha)) / module, 4)
    return gear.convex_radius * math.sin(cutter.alpha) ** 2 / depth


_CONTACT_RATIO = ("contact_ratio", Param(NUMBER, ge=1, le=3, doc="least contact ratio"), 1.1)


@check(
    "contact-ratio",
    kind=KIND,
    doc="smallest contact ratio of any flank, both sides; phases in which nothing drives",
    limit=_CONTACT_RATIO,
)
def contact_ratio(subject: Subject, limit: float) -> Iterator[Finding]:
    """Warn of a low contact ratio; an error where nothing drives."""
    for side, arcs in zip(("backward", "forward"), subject.arcs, strict=True):
        worst = float(arcs.ratios.min())
        if not arcs.gaps and worst >= limit:
            continue
        tooth = int(arcs.tooth[arcs.ratios.argmin()])
        message = "Few teeth carry at a time; a larger rack.addendum or more teeth help."
        if arcs.gaps:
            places = [math.degrees(float(subject.pair.rolling.angle(s))) for s in arcs.gaps[0]]
            message = (
                f"Nothing drives {side} from phi1 = {places[0]:.6g} to {places[1]:.6g} deg"
                f"{' and in other phases' if len(arcs.gaps) > 1 else ''}."
            )
        yield Finding(
            code="contact-ratio",
            severity="error" if arcs.gaps else "warning",
            message=message,
            value=worst,
            limit=limit,
            where=f"driving {side}, wheel 1, tooth {tooth}",
        )


@check(
    "undercut",
    kind=KIND,
    doc="flanks that turn back on themselves, and whether the pair still drives",
    limit=_CONTACT_RATIO,
)
def undercut(subject: Subject, limit: float) -> Iterator[Finding]:
    """Warn of undercut teeth; an error where they no longer drive well enough."""
    ratio = subject.contact_ratio
    driven = not any(arcs.gaps for arcs in subject.arcs)
    severity: Severity = "warning" if driven and ratio >= limit else "error"
    left = f"the least contact ratio that is left is {ratio:.4g}"
    if not driven:
        left += ", and in some phases nothing drives"
    elif ratio < limit:
        left += f", below the limit {limit:.4g}"
    for gear in subject.gears:
        teeth = gear.profile.undercut_teeth
        if not teeth:
            continue
        flanks, best = gear.profile.flanks, largest_module(gear)
        below = np.isfinite(flanks.cusps.dedendum)
        message = f"Flanks end at a cusp above the pitch curve; {left}."
        if below.any():
            slope = math.sin(gear.toothing.cutter.alpha) * math.cos(gear.toothing.cutter.alpha)
            lost = float((flanks.lowest + gear.toothing.cutter.reach)[below].max()) * slope
            fewest = math.ceil(gear.toothing.teeth * subject.pair.module / best)
            message = (
                f"Undercut takes up to {lost:.4g} mm from the root end of these flanks; {left}. "
                f"Without undercut: a module up to {best:.4f} mm, which is {fewest} teeth or more "
                "on this wheel."
            )
        yield Finding(
            code="undercut",
            severity=severity,
            message=message,
            value=subject.pair.module,
            limit=best if below.any() else None,
            unit="mm",
            where=f"wheel {gear.wheel}, teeth {tooth_ranges(teeth)}",
        )


@check(
    "thin-tip",
    kind=KIND,
    doc="thickness of the teeth at their tips",
    limit=("tip_thickness", Param(NUMBER, ge=0, doc="least tip thickness, in modules"), 0.2),
)
def thin_tip(subject: Subject, limit: float) -> Iterator[Finding]:
    """Warn of thin or pointed teeth."""
    for gear in subject.gears:
        thickness = gear.profile.tip_thickness / subject.pair.module
        thin = np.flatnonzero(thickness < limit)
        if thin.size:
            state = "pointed" if thickness.min() < 1e-9 else "thin"
            yield Finding(
                code="thin-tip",
                severity="warning",
                message=f"Teeth are {state} at the tip; a smaller rack.addendum thickens them.",
                value=float(thickness.min()),
                limit=limit,
                unit="modules",
                where=f"wheel {gear.wheel}, teeth {tooth_ranges([int(k) + 1 for k in thin])}",
            )


@check(
    "short-flank",
    kind=KIND,
    doc="flanks that end before the tip curve",
    limit=("tip_height", Param(NUMBER, ge=0, le=1, doc="least tip height, in addenda"), 0.9),
)
def short_flank(subject: Subject, limit: float) -> Iterator[Finding]:
    """Note flanks that stop well below the tip curve."""
    for gear in subject.gears:
        height = gear.profile.tip_height / gear.toothing.cutter.addendum
        short = np.flatnonzero(height < limit)
        if short.size:
            yield Finding(
                code="short-flank",
                severity="note",
                message="Flanks end below the tip curve: at the end of the mate's flank, at a "
                "cusp, or where the tooth comes to a point.",
                value=float(height.min()),
                limit=limit,
                unit="addenda",
                where=f"wheel {gear.wheel}, teeth {tooth_ranges([int(k) + 1 for k in short])}",
            )


@check(
    "thin-rim",
    kind=KIND,
    doc="rim between bore and root",
    limit=("rim_thickness", Param(NUMBER, ge=0, doc="least rim, in modules"), 2.7),
)
def thin_rim(subject: Subject, limit: float) -> Iterator[Finding]:
    """Warn of a rim below 1.2 tooth depths (2.7 modules for the common rack)."""
    rows = zip(subject.gears, subject.bores, subject.thinner, strict=True)
    for gear, bore, thinner in rows:
        if bore is None:
            continue
        root = gear.least_radius - thinner
        rim = root - 0.5 * bore
        if rim < limit * subject.pair.module:
            largest = 2.0 * (root - limit * subject.pair.module)
            hint = (
                f"a bore up to {largest:.6g} mm keeps the limit" if largest > 0 else "no bore does"
            )
            yield Finding(
                code="thin-rim",
                severity="warning",
                message=f"The rim between bore and root is {rim:.6g} mm thick; {hint}.",
                value=rim / subject.pair.module,
                limit=limit,
                unit="modules",
                where=f"wheel {gear.wheel}",
            )


@check(
    "no-backlash",
    kind=KIND,
    doc="play between the flanks",
    limit=("backlash", Param(LENGTH, ge=0, doc="least backlash that is not reported"), 0.01),
)
def no_backlash(subject: Subject, limit: float) -> Iterator[Finding]:
    """Note that the wheels are made without play."""
    if subject.backlash < limit:
        yield Finding(
            code="no-backlash",
            severity="note",
            message="The wheels are drawn without backlash: printed ones want some, and so do "
            "shafts whose distance is not exact.",
            value=subject.backlash,
            limit=limit,
            unit="mm",
            where="pair",
        )
