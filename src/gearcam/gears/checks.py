"""The checks of a gear pair: of its law and centrodes, then of its teeth.

A check takes a `CheckedPair` and yields findings. Values and limits of findings are in the units of
design files.
"""

from __future__ import annotations

import math
from collections.abc import Iterator

import numpy as np

from gearcam.base.findings import ROUNDING, Remark, Severity
from gearcam.base.numerals import FEW, formatted, rounded_down
from gearcam.base.quantities import ANGLE, COUNT, LENGTH, NUMBER, Param
from gearcam.base.readable import readable
from gearcam.gears.cutter import Cutter
from gearcam.gears.pair import Gear
from gearcam.gears.subject import CONTACT_RATIO, CheckedPair, pair_check
from gearcam.laws.ratio.span import angle_text

_POINTED = 1e-9
"""Thickness of a tip, in modules, below which the tooth counts as pointed."""

CLOSURE = math.radians(1e-7)
"""Default closure error: 0.006 micrometres at 200 mm."""

_ANY_RADIUS = 1e6
"""Default of the concave radius, mm: every concave part is reported."""

_CUTTER_TEETH = (
    "cutter_teeth",
    Param(NUMBER, ge=0, doc="fewest teeth of a pinion cutter"),
    12.0,
)
"""Limit of the number of teeth of a pinion cutter, in concave parts and in rings."""


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


@pair_check(
    "closure",
    limit=("closure", Param(ANGLE, ge=0, le=1, doc="largest closure error"), CLOSURE),
    relation="at most",
)
def closure(subject: CheckedPair, limit: float) -> Iterator[Remark]:
    """Warn if the law does not close exactly, as its ratios have too few digits.

    Beyond 1e-6 rad the design is refused.

    Looks at: the error of the driven angle over one lobe.
    """
    law = subject.pair.law
    miss, over = abs(law.closure_error), "one lobe" if law.closed else "the travel"
    if miss > limit:
        yield Remark(
            f"The law does not close exactly: this is the error of the driven angle over {over}.",
            "law",
            math.degrees(miss),
        )


@pair_check(
    "ratio-positive",
    limit=("ratio_swing", Param(NUMBER, gt=1, doc="largest i21 or 1/i21"), 10.0),
    relation="at most",
)
def ratio_positive(subject: CheckedPair, limit: float) -> Iterator[Remark]:
    """Warn if the ratio comes close to zero or becomes very large.

    Looks at: the largest ratio and the inverse of the smallest, relative to the mean.
    """
    law = subject.pair.law
    (low_place, low), (high_place, high) = law.ratio_range
    mean = subject.pair.rolling.mean_radius
    low, high = low / mean, high / mean
    for place, value, swing in ((low_place, low, 1.0 / low), (high_place, high, high)):
        if swing > limit:
            yield Remark(
                f"The ratio is {formatted(value, FEW)} here: one wheel hardly turns, and its "
                "centrode comes close to the shaft of the other.",
                angle_text(place),
                swing,
            )


@pair_check(
    "ratio-continuity",
    limit=("ratio_continuity", Param(COUNT, ge=1, le=3, doc="least order of continuity"), 1.0),
    relation="at least",
)
def ratio_continuity(subject: CheckedPair, limit: float) -> Iterator[Remark]:
    """Warn of a knot at which a derivative of the ratio jumps, up to the order of the limit.

    Looks at: the order to which the ratio is continuous at its knots.
    """
    law = subject.pair.law
    for jump in law.jumps:
        order = jump.order - 2  # of the ratio, which is a derivative itself
        if order < limit:
            yield Remark(
                f"The ratio is C{order} here: its derivative of order {order + 1} jumps.",
                angle_text(jump.theta or law.period),
                float(order),
            )


@pair_check(
    "concave",
    limit=(
        "concave_radius",
        Param(LENGTH, gt=0, doc="concave radii below this are reported"),
        _ANY_RADIUS,
    ),
    relation="at least",
    severity="note",
)
def concave(subject: CheckedPair, limit: float) -> Iterator[Remark]:
    """Note a concave part of a centrode: no rack or hob can cut that wheel.

    Looks at: the radius of concave parts of the centrodes, except those of a ring.
    """
    for gear in subject.gears:
        cutter, (place, radius) = gear.toothing.cutter, gear.toothing.track.concave
        if gear.ring:
            continue
        if cutter.kind == "pinion" and radius < limit:
            yield Remark(
                "The centrode is concave here: no rack or hob can cut this wheel. Its fillets are "
                f"those of a pinion cutter with up to {formatted(cutter.teeth, 3)} teeth.",
                f"wheel {gear.wheel}, {angle_text(place)}",
                radius,
                limit=limit if limit < _ANY_RADIUS else math.inf,
            )


@pair_check(
    "sharp",
    limit=("convex_radius", Param(NUMBER, gt=0, doc="least convex radius, in modules"), 2.5),
    relation="at least",
    unit="modules",
)
def sharp(subject: CheckedPair, limit: float) -> Iterator[Remark]:
    """Warn of a sharp bend of a centrode, where teeth have hardly any root.

    Looks at: the smallest convex radius of the centrodes.
    """
    for gear in subject.gears:
        place, radius = gear.toothing.track.convex
        modules = radius / subject.pair.module
        if modules < limit * (1.0 - ROUNDING):
            yield Remark(
                f"The centrode has a radius of only {formatted(radius, FEW)} mm here. "
                f"With pair.teeth = {subject.teeth(limit / modules)} or more the limit is kept.",
                f"wheel {gear.wheel}, {angle_text(place)}",
                modules,
            )


@pair_check("concave-teeth", limit=_CUTTER_TEETH, relation="at least", unit="teeth")
def concave_teeth(subject: CheckedPair, limit: float) -> Iterator[Remark]:
    """Warn of a concave part into which only a pinion cutter with few teeth fits.

    Looks at: the number of teeth of the largest pinion cutter that fits into the concave parts.
    """
    for gear in subject.gears:
        count, (place, radius) = gear.toothing.cutter.teeth, gear.toothing.track.concave
        if count < limit and not gear.ring:
            yield Remark(
                "The teeth are large for this concave part, which has a radius of "
                f"{formatted(radius, FEW)} mm. With pair.teeth = {subject.teeth(limit / count)} or "
                "more the limit is kept.",
                f"wheel {gear.wheel}, {angle_text(place)}",
                count,
            )


@pair_check("small-cutter", limit=_CUTTER_TEETH, relation="at least", severity="note", unit="teeth")
def small_cutter(subject: CheckedPair, limit: float) -> Iterator[Remark]:
    """Note that the pinion cutter of a ring has few teeth.

    Looks at: the number of teeth of the pinion cutter of a ring.
    """
    for gear in subject.gears:
        count = gear.toothing.cutter.teeth
        if gear.ring and count < limit:
            yield Remark(
                "The pinion cutter of the ring has few teeth: there may be no shaper cutter of "
                "this size, for which the fillets are drawn.",
                f"wheel {gear.wheel}",
                count,
            )


@pair_check(
    "pressure-angle",
    limit=(
        "pressure_angle",
        Param(ANGLE, gt=0, le=90, doc="largest pressure angle of the tooth force"),
        math.radians(50.0),
    ),
    relation="at most",
)
def pressure_angle(subject: CheckedPair, limit: float) -> Iterator[Remark]:
    """Warn of a tooth force that loads the bearings more than it turns the wheel.

    Looks at: the angle between the tooth force and the motion of the pitch point, driving forward
    and backward.
    """
    steep = {side: ends for side, ends in subject.pressure_angles.items() if ends[1] > limit}
    if steep:
        where = (f"driving {side}, {angle_text(place)}" for side, (place, _) in steep.items())
        largest = max(angle for _, angle in steep.values())
        does = (
            "no longer turns the wheel" if largest >= 0.5 * math.pi else "mostly loads the bearings"
        )
        yield Remark(
            f"The tooth force {does}: the slope of the centrode adds to the rack's pressure angle "
            f"of {formatted(math.degrees(subject.pair.rack.pressure_angle), FEW)} deg.",
            "; ".join(where),
            math.degrees(largest),
        )


@pair_check(
    "self-crossing",
    limit=(
        "end_gap",
        Param(ANGLE, ge=0, le=360, doc="least angle between the ends"),
        math.radians(10.0),
    ),
    relation="at least",
)
def self_crossing(subject: CheckedPair, limit: float) -> Iterator[Remark]:
    """Warn of an open wheel whose ends nearly meet; a wheel whose ends meet is refused.

    Looks at: the angle between the ends of an open wheel.
    """
    for gear in subject.gears:
        track = gear.toothing.track
        if track.closed or track.slides:
            continue
        # a centrode given by its radius over a rising angle crosses itself only beyond a full turn
        gap = 2.0 * math.pi - float(np.ptp(track.rotation(track.angle(gear.toothing.ends))))
        if gap < limit:
            yield Remark(
                "There is little room between the first and the last tooth.",
                f"wheel {gear.wheel}",
                math.degrees(gap),
            )


@pair_check(
    "acceleration",
    limit=("acceleration_ratio", Param(NUMBER, gt=0, doc="largest d(i21)/dphi1"), 2.0),
    relation="at most",
)
def acceleration(subject: CheckedPair, limit: float) -> Iterator[Remark]:
    """Warn of a large acceleration of the driven wheel at constant speed of the driver.

    Looks at: `d(i21)/dphi1`, the acceleration of the driven wheel divided by the square of the
    driver's speed.
    """
    places, values = subject.accelerations
    worst = int(np.argmax(np.abs(values)))
    if abs(float(values[worst])) > limit:
        yield Remark(
            "The ratio changes fast here: with the driver at n revolutions per second the angular "
            "acceleration of the driven wheel is this number times (2*pi*n)^2 rad/s2.",
            angle_text(float(places[worst])),
            abs(float(values[worst])),
        )


@pair_check("remote-cutter", relation="at most", unit="mm")
def remote_cutter(subject: CheckedPair, limit: float) -> Iterator[Remark]:  # noqa: ARG001
    """Warn of a pinion cutter that would cut another part of the wheel too.

    Looks at: the distance of the pinion cutter from parts of the wheel that it does not cut.
    """
    for gear in subject.gears:
        cutter = gear.toothing.cutter
        if cutter.kind != "pinion" or not gear.toothing.closed:
            continue
        length, count = gear.toothing.track.length, 180
        s = length * np.arange(count) / count
        frames = gear.toothing.frames(gear.toothing.track.angle(s))
        center = frames.p + gear.toothing.turn * frames.t / cutter.kc
        steps = np.arange(count)
        ahead = frames.p[(steps[:, None] + steps) % count]
        clear = np.abs(ahead - center[:, None]) - (1.0 / cutter.kc + cutter.dedendum)
        # once the centrode has left the cutter, in either direction, it must not return to it
        half = count // 2
        for sense in (1, -1):
            path = clear[:, sense * np.arange(half)]
            again = np.where(np.maximum.accumulate(path, axis=1) > 0.0, path, np.inf)
            if again.min() < 0.0:
                row, column = np.unravel_index(int(again.argmin()), again.shape)
                places = s[[row, (row + sense * column) % count]]
                teeth = np.floor(places / gear.toothing.pitch).astype(int) % gear.toothing.teeth + 1
                yield Remark(
                    "A pinion cutter in this tooth space would also cut into the other tooth: the "
                    "wheel cannot be shaped, but it can be cut by laser or wire, or printed.",
                    f"wheel {gear.wheel}, space after tooth {teeth[0]} and tooth {teeth[1]}",
                    float(-again.min()),
                    limit=0.0,
                )
                break


@pair_check(
    "undercut",
    limit=CONTACT_RATIO,
    relation="at least",
    severity=("warning", "error"),
    unit="teeth",
)
def undercut(subject: CheckedPair, limit: float) -> Iterator[Remark]:
    """Warn of undercut flanks.

    An error if there are phases without contact of flanks, or if the remaining contact ratio is
    below the limit.

    Looks at: flanks cut away by the cutter, and the remaining contact ratio.
    """
    ratio = subject.contact_ratio
    driven = subject.driven
    severity: Severity = "warning" if driven and ratio >= limit else "error"
    left = f"the least remaining contact ratio is {formatted(ratio, 4)}"
    if not driven:
        left += ", and there are phases in which no flanks touch"
    elif ratio < limit:
        left += f", below the limit {formatted(limit, 4)}"
    for gear in subject.gears:
        teeth = gear.profile.undercut_teeth
        if not teeth:
            continue
        flanks, best = gear.profile.flanks, largest_module(gear)
        below = np.isfinite(flanks.cusps.dedendum)
        message = f"Undercut removes flanks from above the pitch curve; {left}."
        factor = subject.pair.module / best
        about = " : ".join(map(str, subject.teeth(factor)))
        fewest = math.ceil(gear.toothing.teeth * factor * (1.0 - ROUNDING))
        if below.any():
            slope = math.sin(gear.toothing.cutter.alpha) * math.cos(gear.toothing.cutter.alpha)
            lost = float((flanks.lowest + gear.toothing.cutter.reach)[below].max()) * slope
            depth = readable(lost, "mm")
            message = f"Undercut removes up to {depth} of these flanks at the root; {left}."
        yield Remark(
            f"{message} With about {about} teeth this wheel has none.",
            f"wheel {gear.wheel}, teeth {tooth_ranges(teeth)}",
            gear.toothing.teeth,
            severity=severity,
            limit=fewest,
            relation="about",
        )


@pair_check(
    "thin-tip",
    limit=("tip_thickness", Param(NUMBER, ge=0, doc="least tip thickness, in modules"), 0.2),
    relation="at least",
    unit="modules",
)
def thin_tip(subject: CheckedPair, limit: float) -> Iterator[Remark]:
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
    relation="at least",
    severity="note",
    unit="addenda",
)
def short_flank(subject: CheckedPair, limit: float) -> Iterator[Remark]:
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


@pair_check("measuring-pin", severity="note")
def measuring_pin(subject: CheckedPair, limit: float) -> Iterator[Remark]:  # noqa: ARG001
    """Note a pin that is no simple size, or with which not all tooth spaces can be measured.

    Only where something is measured: with the files ``inspection`` or those of drawings, or a pin
    in the design.

    Looks at: whether the pin touches both flanks, stands out of the tips and clears the root.
    """
    for gear, asked in zip(subject.gears, subject.pins or (), strict=False):
        measuring = gear.measuring
        diameter, pins = measuring.pins(asked)
        size, where = readable(diameter, "mm"), f"wheel {gear.wheel}"
        if asked is None and not measuring.over.simple:
            text = "No pin of a simple size touches all flanks near their middle; this one is "
            yield Remark(f"{text}{size} thick. output.pin_diameter_mm sets another.", where)
        missed = ~pins.measured
        if missed.any():
            spaces = tooth_ranges(measuring.numbers[: len(missed)][missed].tolist())
            best = readable(measuring.over.recommended, "mm")
            yield Remark(
                f"A pin of {size} cannot be measured in the spaces after these teeth: it does not "
                "touch both flanks, does not stand out of the tips, or meets the root"
                + ("." if asked is None else f". The recommended pin has {best}."),
                f"{where}, teeth {spaces}",
            )


@pair_check(
    "tips-collide",
    limit=("tip_pass", Param(LENGTH, ge=0, doc="least margin by which tips pass each other"), 0.0),
    relation="at least",
    severity=("error", "warning"),
)
def tips_collide(subject: CheckedPair, limit: float) -> Iterator[Remark]:
    """Report tip interference of an internal pair: tips that collide outside the mesh.

    A warning if they pass each other by less than the limit.

    Looks at: the tips of wheel 1 as they enter and leave the ring.
    """
    passing = subject.tip_pass
    if passing is None or passing.margin >= limit:
        return
    message = "Tips pass each other by little outside the mesh."
    if passing.margin < 0.0:
        message = (
            "Tips collide outside the mesh: as it enters or leaves the ring, a tip corner of wheel "
            f"1 overlaps a tooth of the ring by {readable(-passing.margin, 'mm')} along the pitch "
            "curve."
        )
    if passing.margin < -0.5 * subject.pair.toothings[1].pitch:  # no tooth is as wide
        message = (
            "The wheel does not fit into its ring: outside the mesh a tip corner of wheel 1 passes "
            "through the ring's teeth into its rim."
        )
    yield Remark(
        message,
        f"wheel 1, tooth {passing.tooth}, {angle_text(passing.phi1)}",
        passing.margin,
        severity="error" if passing.margin < 0.0 else "warning",
    )


@pair_check(
    "thin-rim",
    limit=("rim_thickness", Param(NUMBER, ge=0, doc="least rim, in modules"), 2.7),
    relation="at least",
    unit="modules",
)
def thin_rim(subject: CheckedPair, limit: float) -> Iterator[Remark]:
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
                across = 2.0 * (gear.largest_radius + least)
                key, size = ("outer_diameter", across) if subject.across else ("rim", least)
                hint = f"ring.{key}_mm = {formatted(size, 12)} keeps the limit"
            elif largest >= 0.5 * given:
                hint = (
                    f"a bore up to {rounded_down(largest)} mm across, keyway included, keeps the "
                    "limit"
                )
            yield Remark(
                f"The rim {what} is {readable(rim, 'mm')} thick; {hint}.",
                f"wheel {gear.wheel}",
                rim / subject.pair.module,
            )


@pair_check(
    "no-backlash",
    limit=("backlash", Param(LENGTH, ge=0, doc="least backlash that is not reported"), 0.01),
    relation="at least",
    severity="note",
)
def no_backlash(subject: CheckedPair, limit: float) -> Iterator[Remark]:
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
