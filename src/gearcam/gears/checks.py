"""The checks of a gear pair. Each looks at one thing; together they are the table in the README.

A check sees a `Subject` and yields findings. Values and limits of findings are in the units of
files.
"""

from __future__ import annotations

import math
from collections.abc import Iterator
from dataclasses import dataclass
from functools import cached_property

import numpy as np

from gearcam.findings import Finding, Severity, check
from gearcam.gears.pair import ContactArcs, Gear, GearPair, contact_arcs
from gearcam.laws.base import angle_text
from gearcam.quantities import ANGLE, COUNT, LENGTH, NUMBER, Param

KIND = "gear-pair"

CLOSURE = math.radians(1e-7)
"""Default closure error: 0.006 micrometres at 200 mm."""

_ANY_RADIUS = 1e6
"""Default of the concave radius: every concave part is reported, mm."""


@dataclass(frozen=True, eq=False, kw_only=True)
class Subject:
    """A pair as built, for checks.

    Parameters
    ----------
    pair : GearPair
        Centrodes and cutters.
    gears : (Gear, Gear)
        Both wheels.
    bores : (float or None, float or None), mm
        Bore diameters.
    backlash : float, mm
        Backlash along the pitch curve.
    """

    pair: GearPair
    gears: tuple[Gear, Gear]
    bores: tuple[float | None, float | None]
    backlash: float

    @cached_property
    def arcs(self) -> tuple[ContactArcs, ContactArcs]:
        """Contact arcs of both sides."""
        return contact_arcs(*self.gears, 1), contact_arcs(*self.gears, -1)

    @property
    def contact_ratio(self) -> float:
        """Smallest contact ratio of any flank, both sides."""
        return min(float(arcs.ratios.min()) for arcs in self.arcs)


def _teeth(numbers: tuple[int, ...] | list[int]) -> str:
    """Return tooth numbers as ranges: ``15, 17-18``."""
    spans: list[list[int]] = []
    for number in numbers:
        if spans and number == spans[-1][1] + 1:
            spans[-1][1] = number
        else:
            spans.append([number, number])
    return ", ".join(f"{a}" if a == b else f"{a}-{b}" for a, b in spans)


@check(
    "closure",
    kind=KIND,
    doc="miss of the driven angle over a lobe",
    limit=("closure", Param(ANGLE, ge=0, le=1, doc="largest closure error"), CLOSURE),
)
def closure(subject: Subject, limit: float) -> Iterator[Finding]:
    """Warn if the law closes only roughly: ratios typed with too few digits."""
    miss = abs(subject.pair.law.closure_error)
    if miss > limit:
        yield Finding(
            code="closure",
            severity="warning",
            message="The law does not close exactly: give the ratios with more digits, or leave "
            'one to "solve".',
            value=math.degrees(miss),
            limit=math.degrees(limit),
            unit="deg",
            where="law",
        )


@check(
    "ratio-positive",
    kind=KIND,
    doc="smallest ratio, and largest as its inverse",
    limit=("ratio_swing", Param(NUMBER, gt=1, doc="largest i21 or 1/i21"), 10.0),
)
def ratio_positive(subject: Subject, limit: float) -> Iterator[Finding]:
    """Warn if the ratio comes near to zero (the driven wheel stands still) or grows very large."""
    (low_place, low), (high_place, high) = subject.pair.law.ratio_range
    for place, value, swing in ((low_place, low, 1.0 / low), (high_place, high, high)):
        if swing > limit:
            yield Finding(
                code="ratio-positive",
                severity="warning",
                message=f"The ratio is {value:.6g} here: one wheel hardly moves, and its centrode "
                "comes close to the other's shaft.",
                value=swing,
                limit=limit,
                where=angle_text(place),
            )


@check(
    "ratio-continuity",
    kind=KIND,
    doc="order to which the ratio is continuous at its knots",
    limit=("ratio_continuity", Param(COUNT, ge=1, le=3, doc="least order of continuity"), 1.0),
)
def ratio_continuity(subject: Subject, limit: float) -> Iterator[Finding]:
    """Warn at knots where a derivative jumps that the limit wants continuous."""
    law = subject.pair.law
    for number, order in enumerate(law.ratio.continuity, start=1):
        if order < limit:
            yield Finding(
                code="ratio-continuity",
                severity="warning",
                message=f"The ratio is C{order} here; its derivative of order {order + 1} jumps.",
                value=float(order),
                limit=limit,
                where=angle_text(float(law.knots[number])),
            )


@check(
    "concave",
    kind=KIND,
    doc="concave parts of the centrodes",
    limit=(
        "concave_radius",
        Param(LENGTH, gt=0, doc="concave radii below this are reported"),
        _ANY_RADIUS,
    ),
)
def concave(subject: Subject, limit: float) -> Iterator[Finding]:
    """Note a concave part, which a rack or hob cannot cut."""
    for gear in subject.gears:
        curvature = gear.concave_curvature
        if gear.toothing.cutter.kc > 0.0 and 1.0 / curvature < limit:
            place = float(gear.curvature_places[np.argmin(gear.curvatures)])
            cutter = 2.0 / (gear.toothing.cutter.kc * subject.pair.module)
            yield Finding(
                code="concave",
                severity="note",
                message="The centrode is concave here: no rack or hob can cut this wheel; its "
                f"fillets are those of a pinion cutter with up to {cutter:.3g} teeth.",
                value=1.0 / curvature,
                limit=limit if limit < _ANY_RADIUS else None,
                unit="mm",
                where=f"wheel {gear.wheel}, {angle_text(place)}",
            )


@check(
    "sharp",
    kind=KIND,
    doc="smallest convex radius of the centrodes",
    limit=("convex_radius", Param(NUMBER, gt=0, doc="least convex radius, in modules"), 2.5),
)
def sharp(subject: Subject, limit: float) -> Iterator[Finding]:
    """Warn where a centrode bends so sharply that teeth have hardly a root."""
    for gear in subject.gears:
        radius = gear.convex_radius / subject.pair.module
        if radius < limit:
            place = float(gear.curvature_places[np.argmax(gear.curvatures)])
            yield Finding(
                code="sharp",
                severity="warning",
                message=f"The centrode bends with a radius of {gear.convex_radius:.6g} mm here; "
                "take more teeth or a smaller swing of the ratio.",
                value=radius,
                limit=limit,
                unit="modules",
                where=f"wheel {gear.wheel}, {angle_text(place)}",
            )


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
    depth = round(-cutter.joint_height / module, 4)
    return gear.convex_radius * math.sin(cutter.alpha) ** 2 / depth


@check(
    "undercut",
    kind=KIND,
    doc="flanks that turn back on themselves, and whether the pair still drives",
    limit=(
        "contact_ratio",
        Param(NUMBER, ge=1, le=3, doc="least contact ratio of a pair with undercut"),
        1.1,
    ),
)
def undercut(subject: Subject, limit: float) -> Iterator[Finding]:
    """Warn of undercut teeth; an error where they no longer drive well enough."""
    ratio = subject.contact_ratio
    driven = not any(arcs.gaps for arcs in subject.arcs)
    severity: Severity = "warning" if driven and ratio >= limit else "error"
    for gear in subject.gears:
        teeth = gear.profile.undercut_teeth
        if not teeth:
            continue
        flanks = gear.profile.flanks
        lost = (flanks.lowest + gear.toothing.cutter.reach)[np.isfinite(flanks.cusps.dedendum)]
        slope = math.sin(gear.toothing.cutter.alpha) * math.cos(gear.toothing.cutter.alpha)
        depth = float(lost.max(initial=0.0)) * slope
        message = (
            f"Undercut takes up to {depth:.4g} mm from the root end of these flanks; the least "
            f"contact ratio that is left is {ratio:.4g}"
            + ("." if driven else ", and in some phases nothing drives.")
        )
        best = largest_module(gear)
        if np.isfinite(flanks.cusps.dedendum).any():
            fewest = math.ceil(gear.pair.teeth[gear.wheel - 1] * subject.pair.module / best)
            message += (
                f" Without undercut: a module up to {best:.4f} mm, which is {fewest} teeth or more "
                "on this wheel."
            )
        yield Finding(
            code="undercut",
            severity=severity,
            message=message,
            value=subject.pair.module,
            limit=best,
            unit="mm",
            where=f"wheel {gear.wheel}, teeth {_teeth(teeth)}",
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
                where=f"wheel {gear.wheel}, teeth {_teeth([int(k) + 1 for k in thin])}",
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
        z, tips = gear.toothing.teeth, gear.profile.flanks.tips
        height = np.minimum(tips.height[:z], tips.height[z:]) / gear.toothing.cutter.addendum
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
                where=f"wheel {gear.wheel}, teeth {_teeth([int(k) + 1 for k in short])}",
            )


@check(
    "thin-rim",
    kind=KIND,
    doc="rim between bore and root",
    limit=("rim_thickness", Param(NUMBER, ge=0, doc="least rim, in modules"), 2.7),
)
def thin_rim(subject: Subject, limit: float) -> Iterator[Finding]:
    """Warn of a rim below 1.2 tooth depths (2.7 modules for the common rack)."""
    for gear, bore in zip(subject.gears, subject.bores, strict=True):
        if bore is None:
            continue
        rim = gear.least_radius - 0.5 * bore
        if rim < limit * subject.pair.module:
            largest = 2.0 * (gear.least_radius - limit * subject.pair.module)
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
    "remote-cutter",
    kind=KIND,
    doc="pinion cutter that reaches a remote part of its wheel",
)
def remote_cutter(subject: Subject, limit: float) -> Iterator[Finding]:  # noqa: ARG001
    """Warn if the pinion cutter would cut a tooth far from the space it is in."""
    for gear in subject.gears:
        cutter = gear.toothing.cutter
        if cutter.kc == 0.0:
            continue
        length, count = gear.pair.rolling.length(gear.wheel), 180
        s = length * np.arange(count) / count
        frames = gear.toothing.frames(gear.pair.rolling.angle(s))
        center = frames.p + gear.toothing.turn * frames.t / cutter.kc
        steps = np.arange(count)
        ahead = frames.p[(steps[:, None] + steps) % count]
        clear = np.abs(ahead - center[:, None]) - (1.0 / cutter.kc + cutter.dedendum)
        # Once the centrode has left the cutter on either way round it must not come back to it.
        half = count // 2
        for way in (1, -1):
            path = clear[:, way * np.arange(half)]
            again = np.where(np.maximum.accumulate(path, axis=1) > 0.0, path, np.inf)
            if again.min() < 0.0:
                row, column = np.unravel_index(int(again.argmin()), again.shape)
                places = s[[row, (row + way * column) % count]]
                teeth = np.floor(places / gear.toothing.pitch).astype(int) % gear.toothing.teeth + 1
                yield Finding(
                    code="remote-cutter",
                    severity="warning",
                    message="A pinion cutter in this space would also cut the other tooth: laser, "
                    "wire or printer can make the wheel, a shaper cannot.",
                    value=float(-again.min()),
                    limit=0.0,
                    unit="mm",
                    where=f"wheel {gear.wheel}, space after tooth {teeth[0]} and tooth {teeth[1]}",
                )
                break


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
