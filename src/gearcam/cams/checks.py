"""The checks of cams: pressure angles, undercut, shocks, sharp profiles, coarse rows.

Importing this room registers them. A check sees a `DiscCam` and yields findings.
"""

from __future__ import annotations

import math
from collections.abc import Iterator
from typing import Final

from gearcam.cams.disc import DiscCam
from gearcam.cams.mechanism import Mechanism
from gearcam.cams.spec import KIND
from gearcam.findings import Remark, check
from gearcam.numerals import shown
from gearcam.quantities import ANGLE, LENGTH, Param

PRESSURE: Final = {False: math.radians(30.0), True: math.radians(45.0)}
"""Largest pressure angle by custom, rad: of translating followers, whose guides jam, and of
oscillating ones."""

_TURN: Final = 2.0 * math.pi


def pressure_limit(mechanism: Mechanism, given: float) -> float:
    """Return the largest pressure angle of a `mechanism`, rad: as `given`, by custom where nan."""
    return PRESSURE[mechanism.oscillating] if math.isnan(given) else given


def _deg(theta: float) -> str:
    return f"{shown(math.degrees(theta))} deg"


@check(
    "pressure-angle",
    kind=KIND,
    limit=(
        "pressure_angle",
        Param(ANGLE, gt=0, lt=90, doc="largest pressure angle; 30 translating, 45 oscillating"),
        math.nan,
    ),
)
def pressure_angle(cam: DiscCam, limit: float) -> Iterator[Remark]:
    """Warn of large pressure angles on rises and returns.

    Looks at: the pressure angle: beyond its limit a translating follower jams in its guide.
    """
    limit = pressure_limit(cam.mechanism, limit)
    for kind in ("rise", "return"):
        found = cam.pressure(kind)
        if found is None or found.largest <= limit:
            continue
        worst = max(found.low, found.high, key=lambda end: abs(end.value))
        yield Remark(
            f"The pressure angle on the {kind} reaches {_deg(worst.value)}.",
            f"{kind}, at {_deg(worst.theta)}",
            math.degrees(abs(worst.value)),
            limit=math.degrees(limit),
        )


@check(
    "undercut",
    kind=KIND,
    limit=("lost_lift", Param(LENGTH, ge=0, doc="lift that trimming may cost"), 0.01),
)
def undercut(cam: DiscCam, limit: float) -> Iterator[Remark]:
    """Tell where a profile is undercut, and the lift that its trimming costs.

    Looks at: stretches on which the follower would cut away what it needs elsewhere; they
    are trimmed.
    """
    left = cam.undercut_ranges
    lever = cam.mechanism.lever
    for corner, loss in zip(cam.corners, cam.lost, strict=True):
        low, high = corner.before, corner.after
        inside = [pair for pair in left if _within(pair, low, high)]
        left = [pair for pair in left if pair not in inside]
        lost = loss.value * lever
        angle = f" ({shown(math.degrees(loss.value), 4)} deg)" if cam.mechanism.oscillating else ""
        yield Remark(
            f"The profile is {_stretches(inside)}. Trimmed, it has a corner on which the "
            f"follower rests from {_deg(low)} to {_deg(high)}: it loses up to {shown(lost, 4)} mm"
            f"{angle} of lift.",
            f"at {_deg(loss.theta)}",
            lost,
            severity="error" if lost > limit else "warning",
        )
    for pair in left:
        yield Remark(
            f"The profile is {_stretches([pair])}, so little that trimming costs nothing.",
            f"at {_deg(pair[0])}",
        )


def _within(pair: tuple[float, float], low: float, high: float) -> bool:
    """Whether a stretch begins within a turn's part that may go over its end."""
    return (pair[0] - low) % _TURN <= (high - low) % _TURN


def _stretches(pairs: list[tuple[float, float]]) -> str:
    if not pairs:
        return "cut by the follower at another angle"
    words = (
        f"from {_deg(low)} to {_deg(high)}" if high > low else f"at {_deg(low)}"
        for low, high in pairs
    )
    return "undercut " + " and ".join(words)


def _shocks(cam: DiscCam, order: int) -> Iterator[tuple[str, float, str]]:
    """Yield place, jump and unit of every knot whose derivative of this order jumps."""
    swings = cam.mechanism.oscillating
    unit = ("deg/rad" if swings else "mm/rad") + ("2" if order == 2 else "")
    for jump in cam.program.jumps:
        if jump.order == order:
            by = jump.after - jump.before
            yield f"at {_deg(jump.theta)}", math.degrees(by) if swings else by, unit


@check("hard-shock", kind=KIND)
def hard_shock(cam: DiscCam, limit: float) -> Iterator[Remark]:  # noqa: ARG001
    """Warn of every knot where the velocity jumps.

    Looks at: knots where the velocity jumps.
    """
    for where, by, unit in _shocks(cam, 1):
        yield Remark(
            f"The velocity jumps by {shown(by)} {unit}: the follower strikes or leaves the "
            "cam, but at crawling speed.",
            where,
            by,
            unit=unit,
        )


@check("soft-shock", kind=KIND, severity="note")
def soft_shock(cam: DiscCam, limit: float) -> Iterator[Remark]:  # noqa: ARG001
    """Note every knot where the acceleration jumps.

    Looks at: knots where the acceleration jumps.
    """
    for where, by, unit in _shocks(cam, 2):
        yield Remark(
            f"The acceleration jumps by {shown(by)} {unit}: vibration at high speed.",
            where,
            by,
            unit=unit,
        )


@check(
    "sharp-profile",
    kind=KIND,
    limit=("profile_radius", Param(LENGTH, ge=0, doc="least convex radius of the profile"), 1.0),
)
def sharp_profile(cam: DiscCam, limit: float) -> Iterator[Remark]:
    """Warn of a sharp profile.

    Looks at: the smallest convex radius of an untrimmed profile: sharp ones wear and pit.
    """
    convex, _ = cam.profile_radius
    if not cam.corners and convex < limit:
        yield Remark(
            f"The smallest convex radius of the profile is {shown(convex, 4)} mm.", value=convex
        )


@check("coarse-rows", kind=KIND, unit="mm")
def coarse_rows(cam: DiscCam, limit: float) -> Iterator[Remark]:  # noqa: ARG001
    """Warn of a motion that is known less well than the profile is cut.

    Looks at: the estimated error of the lift between the rows of its table.
    """
    error = cam.program.error * cam.mechanism.lever
    if error > cam.tolerance:
        yield Remark(
            f"Between the rows of its table the lift is known to {shown(error, 3)} mm, the profile "
            f"is cut to {shown(cam.tolerance, 3)} mm: the rows are coarse, or they scatter.",
            "motion",
            error,
            limit=cam.tolerance,
        )
