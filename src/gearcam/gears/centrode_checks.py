"""Checks of a pair's law and centrodes (see `checks` for those of the teeth)."""

from __future__ import annotations

import math
from collections.abc import Iterator

import numpy as np

from gearcam.findings import ROUNDING, Remark
from gearcam.gears.subject import Subject, pair_check
from gearcam.laws.ratio.span import angle_text
from gearcam.numerals import shown
from gearcam.quantities import ANGLE, COUNT, LENGTH, NUMBER, Param

CLOSURE = math.radians(1e-7)
"""Default closure error: 0.006 micrometres at 200 mm."""

_ANY_RADIUS = 1e6
"""Default of the concave radius: every concave part is reported, mm."""

_CUTTER_TEETH = (
    "cutter_teeth",
    Param(NUMBER, ge=0, doc="fewest teeth of a pinion cutter"),
    12.0,
)
"""Limit of a pinion cutter's teeth, in concave parts and in rings."""


@pair_check(
    "closure", limit=("closure", Param(ANGLE, ge=0, le=1, doc="largest closure error"), CLOSURE)
)
def closure(subject: Subject, limit: float) -> Iterator[Remark]:
    """Warn if the law does not close exactly: its ratios were typed with too few digits.

    Beyond 1e-6 rad the design is refused.

    Looks at: the error of the driven angle over one lobe.
    """
    miss = abs(subject.pair.law.closure_error)
    if miss > limit:
        yield Remark(
            "The law does not close exactly: over a lobe the driven angle is off by this.",
            "law",
            math.degrees(miss),
        )


@pair_check(
    "ratio-positive", limit=("ratio_swing", Param(NUMBER, gt=1, doc="largest i21 or 1/i21"), 10.0)
)
def ratio_positive(subject: Subject, limit: float) -> Iterator[Remark]:
    """Warn if the ratio comes near to zero (the driven wheel stands still) or grows very large.

    Looks at: the largest ratio and the inverse of the smallest, over their mean.
    """
    law = subject.pair.law
    (low_place, low), (high_place, high) = law.ratio_range
    mean = subject.pair.rolling.mean_radius
    low, high = low / mean, high / mean
    for place, value, swing in ((low_place, low, 1.0 / low), (high_place, high, high)):
        if swing > limit:
            yield Remark(
                f"The ratio is {shown(value)} here: one wheel hardly moves, and its "
                "centrode comes close to the other's shaft.",
                angle_text(place),
                swing,
            )


@pair_check(
    "ratio-continuity",
    limit=("ratio_continuity", Param(COUNT, ge=1, le=3, doc="least order of continuity"), 1.0),
)
def ratio_continuity(subject: Subject, limit: float) -> Iterator[Remark]:
    """Warn of a knot at which a derivative of the ratio jumps, up to the order of the limit.

    Looks at: the order to which the ratio is continuous at its knots.
    """
    law = subject.pair.law
    for jump in law.jumps:
        order = jump.order - 2  # of the ratio, which is a derivative itself
        if order < limit:
            yield Remark(
                f"The ratio is C{order} here; its derivative of order {order + 1} jumps.",
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
    severity="note",
)
def concave(subject: Subject, limit: float) -> Iterator[Remark]:
    """Note a concave part of a centrode: no rack or hob can cut that wheel.

    Looks at: the radius of concave parts of the centrodes; not of a ring, which is concave by
    nature.
    """
    for gear in subject.gears:
        cutter, (place, radius) = gear.toothing.cutter, gear.toothing.track.concave
        if gear.ring:
            continue
        if cutter.kind == "pinion" and radius < limit:
            yield Remark(
                "The centrode is concave here: no rack or hob can cut this wheel; its "
                f"fillets are those of a pinion cutter with up to {shown(cutter.teeth, 3)} teeth.",
                f"wheel {gear.wheel}, {angle_text(place)}",
                radius,
                limit=limit if limit < _ANY_RADIUS else math.inf,
            )


@pair_check(
    "sharp",
    limit=("convex_radius", Param(NUMBER, gt=0, doc="least convex radius, in modules"), 2.5),
    unit="modules",
)
def sharp(subject: Subject, limit: float) -> Iterator[Remark]:
    """Warn where a centrode is curved so sharply that teeth have hardly any root.

    Looks at: the smallest convex radius of the centrodes.
    """
    for gear in subject.gears:
        place, radius = gear.toothing.track.convex
        modules = radius / subject.pair.module
        if modules < limit * (1.0 - ROUNDING):
            yield Remark(
                f"The centrode bends with a radius of {shown(radius)} mm here. "
                f"{subject.with_teeth(limit / modules)} the limit is kept.",
                f"wheel {gear.wheel}, {angle_text(place)}",
                modules,
            )


@pair_check("concave-teeth", limit=_CUTTER_TEETH, unit="teeth")
def concave_teeth(subject: Subject, limit: float) -> Iterator[Remark]:
    """Warn where the teeth are too wide for a concave part: only a tiny pinion cutter fits into it.

    Looks at: the teeth of the largest pinion cutter that fits into the concave parts.
    """
    for gear in subject.gears:
        count, (place, radius) = gear.toothing.cutter.teeth, gear.toothing.track.concave
        if count < limit and not gear.ring:
            yield Remark(
                "The teeth are wide for this concave part, whose radius is "
                f"{shown(radius)} mm. {subject.with_teeth(limit / count)} the limit is kept.",
                f"wheel {gear.wheel}, {angle_text(place)}",
                count,
            )


@pair_check("cutter-small", limit=_CUTTER_TEETH, severity="note", unit="teeth")
def cutter_small(subject: Subject, limit: float) -> Iterator[Remark]:
    """Note that the pinion cutter of a ring has few teeth.

    Looks at: teeth of the pinion cutter of a ring.
    """
    for gear in subject.gears:
        count = gear.toothing.cutter.teeth
        if gear.ring and count < limit:
            yield Remark(
                "The pinion cutter of the ring has few teeth: a shaper may have none so small, "
                "and the fillets are those of a cutter of this size.",
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
)
def pressure_angle(subject: Subject, limit: float) -> Iterator[Remark]:
    """Warn where the tooth force pushes the shafts apart rather than turns the wheel.

    Looks at: the angle of the tooth force to the motion of the pitch point, driving forward and
    backward.
    """
    found = {way: ends for way, ends in subject.pressure_angles.items() if ends[1] > limit}
    if found:
        where = (f"driving {way}, {angle_text(place)}" for way, (place, _) in found.items())
        largest = max(angle for _, angle in found.values())
        does = (
            "no longer turns the wheel" if largest >= 0.5 * math.pi else "mostly loads the bearings"
        )
        yield Remark(
            f"The tooth force stands so steep that it {does}: the rack's "
            f"{shown(math.degrees(subject.pair.rack.pressure_angle))} deg and the slope of "
            "the centrode add up.",
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
)
def self_crossing(subject: Subject, limit: float) -> Iterator[Remark]:
    """Warn if the ends of an open wheel nearly meet; ends that meet are refused.

    Looks at: what an open wheel leaves of a full turn.
    """
    for gear in subject.gears:
        track = gear.toothing.track
        if track.closed or track.slides:
            continue
        # a centrode given by its radius over a rising angle crosses itself only beyond a full turn
        gap = 2.0 * math.pi - float(np.ptp(track.rotation(track.angle(gear.toothing.ends))))
        if gap < limit:
            yield Remark(
                "Little is left between the first and the last tooth.",
                f"wheel {gear.wheel}",
                math.degrees(gap),
            )


@pair_check(
    "acceleration",
    limit=("acceleration_ratio", Param(NUMBER, gt=0, doc="largest d(i21)/dphi1"), 2.0),
)
def acceleration(subject: Subject, limit: float) -> Iterator[Remark]:
    """Warn of a motion that shakes the machine although the driver turns steadily.

    Looks at: `d(i21)/dphi1`: the acceleration of the driven wheel over the square of the driver's
    speed.
    """
    places, values = subject.accelerations
    worst = int(np.argmax(np.abs(values)))
    if abs(float(values[worst])) > limit:
        yield Remark(
            "The ratio changes fast here: at n turns a second of the driver the driven "
            "wheel's angular acceleration is this number times (2*pi*n)^2 rad/s2.",
            angle_text(float(places[worst])),
            abs(float(values[worst])),
        )


@pair_check("remote-cutter", unit="mm")
def remote_cutter(subject: Subject, limit: float) -> Iterator[Remark]:  # noqa: ARG001
    """Warn if the pinion cutter, standing in one tooth space, would cut a tooth farther away.

    Looks at: pinion cutter that reaches a remote part of its wheel.
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
        # Once the centrode has left the cutter on either way round it must not come back to it.
        half = count // 2
        for way in (1, -1):
            path = clear[:, way * np.arange(half)]
            again = np.where(np.maximum.accumulate(path, axis=1) > 0.0, path, np.inf)
            if again.min() < 0.0:
                row, column = np.unravel_index(int(again.argmin()), again.shape)
                places = s[[row, (row + way * column) % count]]
                teeth = np.floor(places / gear.toothing.pitch).astype(int) % gear.toothing.teeth + 1
                yield Remark(
                    "A pinion cutter in this space would also cut the other tooth: laser, "
                    "wire or printer can make the wheel, a shaper cannot.",
                    f"wheel {gear.wheel}, space after tooth {teeth[0]} and tooth {teeth[1]}",
                    float(-again.min()),
                    limit=0.0,
                )
                break
