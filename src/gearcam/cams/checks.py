"""The checks of cams: pressure angles, undercut, shocks, sharp profiles, coarse rows.

Importing this module registers them. A check looks at all motions or walls of a `Cam` and yields
findings; where there are several, the place of a finding names which. The check of a followed
profile looks at the wall that it was taken for and at the motion that was found, that of
precision at the largest deviation by the tolerances.
"""

from __future__ import annotations

import math
from collections.abc import Callable, Iterator
from typing import TYPE_CHECKING, Final, NamedTuple

import numpy as np

from gearcam.base.findings import ROUNDING, Remark, check
from gearcam.base.numerals import FEW, formatted, rounded_down, settled, shortened
from gearcam.base.quantities import ANGLE, LENGTH, Param
from gearcam.base.readable import readable
from gearcam.cams.cam import Cam
from gearcam.cams.followers import Follower
from gearcam.cams.spec import FITTED, FOLLOWED, KIND, PRECISION
from gearcam.cams.wall import PitchMotion, Wall
from gearcam.laws.displacement import Jump
from gearcam.laws.motion import MOTION_LAWS
from gearcam.mechanics.clearance import without_clearance

if TYPE_CHECKING:
    from gearcam.cams.follow import Followed
    from gearcam.cams.precision import LiftError
    from gearcam.laws.lift_fit import FittedLift

_MISSED: Final = 0.1
"""Part of the whole lift by which wear cannot change the lift of a cam's own profile."""

_UNLIKE: Final = 2.0
"""Residual of a fitted phase over the noise, both as root mean square, that is no chance."""


def pressure_limits(
    follower: Follower | type[Follower], given: float | tuple[float, ...]
) -> dict[str, float]:
    """Return the largest pressure angles of a follower on rises and returns, rad.

    Parameters
    ----------
    follower : Follower
        The follower, or its class.
    given : float or (float, float), rad
        For both or each; nan: the default of the follower.

    Returns
    -------
    dict of str to float, rad
        By the kinds of phases, ``rise`` and ``return``.
    """
    pair = np.broadcast_to(given, 2).tolist()
    return {
        kind: follower.pressure_limit if math.isnan(one) else one
        for kind, one in zip(("rise", "return"), pair, strict=True)
    }


def driven(cam: Cam, motion: PitchMotion) -> tuple[str, ...]:
    """Return the kinds of phases in which the walls of a motion push the follower.

    Of a cam that comes back the same way returns push too.

    Parameters
    ----------
    cam : Cam
        With the walls.
    motion : PitchMotion
        One of its motions.

    Returns
    -------
    tuple of str
        ``rise``, ``return`` or both.
    """
    if motion.carrier.returns:
        return "rise", "return"
    walls = (wall for wall in cam.walls if motion in (wall, wall.of))
    return tuple("rise" if wall.curve.lift_sign > 0 else "return" for wall in walls)


def _at(motion: PitchMotion, place: str) -> str:
    """Return a place on a motion or wall, named where a cam has several."""
    return f"{motion.called}, {place}" if motion.key else place


@check(
    "pressure-angle",
    kind=KIND,
    limit=(
        "pressure_angle",
        Param(
            ANGLE,
            gt=0,
            lt=90,
            both=True,
            order="rise and return",
            example=30,
            doc="largest pressure angle of rises and returns; 30 translating, 45 oscillating",
        ),
        math.nan,
    ),
    relation="at most",
)
def pressure_angle(cam: Cam, limit: float | tuple[float, ...]) -> Iterator[Remark]:
    """Warn of large pressure angles on rises and returns.

    Looks at: the pressure angle: the larger it is, the larger is the side force on the follower.
    """
    for motion in cam.motions:
        for kind, largest in pressure_limits(motion.follower, limit).items():
            yield from _steep(motion, (kind,), largest)


@check(
    "jamming",
    kind=KIND,
    severity="error",
    limit=(
        "jamming_angle",
        Param(
            ANGLE,
            gt=0,
            le=90,
            example=65,
            doc="pressure angle that jams; 65 translating, 80 oscillating",
        ),
        math.nan,
    ),
    relation="at most",
)
def jamming(cam: Cam, limit: float) -> Iterator[Remark]:
    """Report pressure angles at which friction blocks the follower.

    Looks at: the pressure angle where the cam drives the follower: on rises, and on returns under a
    second wall or of a plate, which slides back. With friction of 0.15 a stem with an overhang as
    long as its guide jams from 65.8 degrees, an arm on a pin with a radius of a tenth of its length
    from 80.6 degrees.
    """
    for motion in cam.motions:
        largest = motion.follower.jamming_limit if math.isnan(limit) else limit
        for remark in _steep(motion, driven(cam, motion), largest):
            yield remark._replace(
                message=f"{remark.message[:-1]}: friction can block the follower, whatever "
                "the torque on the cam."
            )


def _steep(motion: PitchMotion, kinds: tuple[str, ...], largest: float) -> Iterator[Remark]:
    """Yield the phases of some kinds whose pressure angle exceeds the largest, rad."""
    for kind in kinds:
        angles = motion.pressure(kind)
        if angles is None or angles.largest <= largest:
            continue
        worst = max(angles.low, angles.high, key=lambda end: abs(end.value))
        angle = math.degrees(abs(worst.value))
        yield Remark(
            f"The pressure angle on the {kind} reaches {readable(angle, 'deg')}.",
            _at(motion, f"{kind}, {motion.carrier.driver.place(worst.theta)}"),
            angle,
            limit=math.degrees(largest),
        )


@check(
    "undercut",
    kind=KIND,
    limit=("lost_lift", Param(LENGTH, ge=0, doc="largest lift that trimming may lose"), 0.01),
    relation="at most",
    severity=("warning", "error"),
)
def undercut(cam: Cam, limit: float) -> Iterator[Remark]:
    """Warn of an undercut profile, which is trimmed.

    It is an error where trimming costs more lift than the limit.

    Looks at: the parts of a profile that the follower cuts away from other places, and the lift
    lost.
    """
    for wall in cam.walls:
        yield from _undercut(wall, limit)


def _undercut(wall: Wall, limit: float) -> Iterator[Remark]:
    left = wall.undercut_ranges
    follower, text = wall.follower, wall.carrier.driver.text
    for corner, loss in zip(wall.edges, wall.lost, strict=True):
        low, high = corner.before, corner.after
        inside = [pair for pair in wall.undercut_at(corner) if pair in left]
        left = [pair for pair in left if pair not in inside]
        lost = loss.value * follower.lever
        angle = f" ({formatted(math.degrees(loss.value), 4)} deg)" if follower.angular else ""
        cut, much = _stretches(inside, text), f"{readable(lost, 'mm')}{angle}"
        yield Remark(
            f"The {wall.called} is {cut}. After trimming it has a corner, on which the follower "
            f"rides from {text(low)} to {text(high)}: "
            + (f"up to {much} of lift is lost." if wall.side > 0 else f"it goes {much} too far."),
            _at(wall, f"at {text(loss.theta)}"),
            lost,
            severity="error" if lost > limit else "warning",
        )
    for pair in left:
        cut = _stretches([pair], text)
        yield Remark(
            f"The {wall.called} is {cut}, so little that trimming loses no lift.",
            _at(wall, f"at {text(pair[0])}"),
        )


def _stretches(pairs: list[tuple[float, float]], text: Callable[[float], str]) -> str:
    if not pairs:
        return "cut away by the follower at another angle"
    words = (
        f"from {text(low)} to {text(high)}" if high > low else f"at {text(low)}"
        for low, high in pairs
    )
    return "undercut " + " and ".join(words)


def _shocks(cam: Cam, order: int, harm: str) -> Iterator[Remark]:
    """Yield the remarks on knots whose derivative of this order jumps, with the harm that does."""
    lead, name = cam.motions[0], ("velocity", "acceleration")[order - 1]
    driver, (scale, unit) = lead.carrier.driver, lead.follower.lift_unit
    unit = f"{unit}/{driver.per}{order if order > 1 else ''}"
    for jump in lead.program.jumps:
        if jump.order != order:
            continue
        by = scale * (jump.after - jump.before)
        told = f"{jump.small}. {_bent(cam, jump)}".rstrip() if jump.slight else f": {harm}"
        yield Remark(
            f"The {name} jumps by {formatted(by, FEW)} {unit}{told}",
            f"at {driver.text(jump.theta)}",
            by,
            severity="note" if jump.slight else None,
            unit=unit,
        )


def _bent(cam: Cam, jump: Jump) -> str:
    """Return what a velocity jump too small to matter does to the profiles, in words."""
    found = [
        wall.bent_by(own)
        for wall in cam.walls
        for own in wall.program.hard
        if own.theta == jump.theta and jump.order == 1
    ]
    bend, lost = (max(one) for one in zip((0.0, 0.0), *found, strict=True))
    if not bend:
        return ""  # a straight piece below a face
    lead = cam.motions[0]
    lost = settled(lost, lead.follower.lever * lead.program.range[1])
    loses = f", by which {readable(lost, 'mm', digits=3)} of lift is lost" if lost else ""
    return f"It bends the profile by {formatted(math.degrees(bend), 3)} deg{loses}."


@check("velocity-jump", kind=KIND, severity=("warning", "note"))
def velocity_jump(cam: Cam, limit: float) -> Iterator[Remark]:  # noqa: ARG001
    """Warn of a knot at which the velocity jumps.

    A note if it jumps by no more than a thousandth of the largest velocity, as by coefficients
    that were printed in few digits: then its corner counts neither as undercut nor as a radius.

    Looks at: knots where the velocity jumps.
    """
    yield from _shocks(
        cam, 1, "except at very low speed the follower strikes the cam or leaves it."
    )


@check("acceleration-jump", kind=KIND, severity="note")
def acceleration_jump(cam: Cam, limit: float) -> Iterator[Remark]:  # noqa: ARG001
    """Note a knot at which the acceleration jumps, and whether it is too little to matter.

    Looks at: knots where the acceleration jumps.
    """
    yield from _shocks(cam, 2, "the follower vibrates at high speed.")


@check(
    "sharp-profile",
    kind=KIND,
    limit=("profile_radius", Param(LENGTH, ge=0, doc="least convex radius of the profile"), 1.0),
    relation="at least",
)
def sharp_profile(cam: Cam, limit: float) -> Iterator[Remark]:
    """Warn of a sharp profile.

    Looks at: the smallest convex radius of the profile, which wears and pits if it is sharp.
    Trimmed profiles are left out.
    """
    for wall in cam.walls:
        convex, _ = wall.profile_radius
        if not wall.edges and convex < limit:
            base, hint = cam.least_base_radius, ""
            if base is not None:
                base = shortened(base + limit, 1.0)
                hint = f" With cam.base_radius_mm = {formatted(base, FEW)} it keeps the limit."
            yield Remark(
                f"The smallest convex radius of the {wall.called} is {formatted(convex, 4)} "
                f"mm.{hint}",
                wall.called if wall.key else "",
                value=convex,
            )


@check("coarse-rows", kind=KIND, relation="at most", unit="mm")
def coarse_rows(cam: Cam, limit: float) -> Iterator[Remark]:  # noqa: ARG001
    """Warn of a motion table whose rows do not give the lift as accurately as the profile is cut.

    The rows are too coarse, or they were measured and are not smoothed.

    Looks at: the estimated error of the lift against `chord_tolerance_mm`.
    """
    lead = cam.motions[0]
    error = lead.program.errors[0] * lead.follower.lever
    if error > lead.tolerance:
        known, cut = (readable(one, "mm", digits=3) for one in (error, lead.tolerance))
        yield Remark(
            f"Between the rows of its table the lift is known to {known}, the profile is cut to "
            f"{cut}: the rows are coarse, or they scatter.",
            "motion",
            error,
            limit=lead.tolerance,
        )


@check(
    "lost-motion",
    kind=KIND,
    limit=("lost_motion", Param(LENGTH, ge=0, doc="largest lost motion between two walls"), 0.1),
    relation="at most",
)
def lost_motion(cam: Cam, limit: float) -> Iterator[Remark]:
    """Warn of a follower that can move between the two walls of a groove.

    Looks at: how far the follower can move while the cam does not.
    """
    most, lead = cam.lost_motion, cam.motions[0]
    if most is None:
        return
    lost = most.value * lead.follower.lever
    angle = f" ({formatted(math.degrees(most.value), 4)} deg)" if lead.follower.angular else ""
    if lost > limit:
        yield Remark(
            f"Between its walls the follower has {readable(lost, 'mm')}{angle} of lost motion.",
            lead.carrier.driver.place(most.theta),
            lost,
        )


@check("no-clearance", kind=KIND, severity="note", unit="mm")
def no_clearance(cam: Cam, limit: float) -> Iterator[Remark]:  # noqa: ARG001
    """Note a roller without clearance in its groove.

    Looks at: `cam.roller_clearance_mm`; two rollers in steps of a groove each touch one wall and
    need none.
    """
    if cam.clearance is not None:
        yield from without_clearance(cam.clearance)


@check("face-width", kind=KIND, severity="note")
def face_width(cam: Cam, limit: float) -> Iterator[Remark]:  # noqa: ARG001
    """Note how wide the faces of a yoke must be: twice the farthest contact from their middle.

    Looks at: the largest distance of the contact from the middle of a face.
    """
    if cam.face_width is not None:
        yield Remark(
            f"The contact moves up to {readable(0.5 * cam.face_width, 'mm')} from the middle of "
            f"each face: faces must be wider than {readable(cam.face_width, 'mm')}.",
            value=cam.face_width,
            unit="mm",
        )


@check("other-profile", kind=FOLLOWED, relation="at most")
def other_profile(followed: tuple[Wall, Followed], limit: float) -> Iterator[Remark]:  # noqa: ARG001
    """Warn if a followed profile is probably not that of the design.

    The lift differs by more than a tenth from that of the design.

    Looks at: the difference between the lift of a followed profile and that of the design.
    """
    wall, motion = followed
    low, high = wall.program.range
    scale, unit = wall.follower.lift_unit
    off = np.abs(motion.lift - wall.program.derivatives(motion.theta, 0)[0])
    worst, most = int(off.argmax()), _MISSED * (high - low)
    if off[worst] > most:
        yield Remark(
            f"The lift differs by up to {formatted(scale * float(off[worst]), 4)} {unit} from that "
            f"of the design, {formatted(scale * (high - low), FEW)} {unit}: the profile belongs to "
            "another wall or another cam, is in another frame, or its file is not in mm and states "
            "no unit.",
            _at(wall, f"at {wall.carrier.driver.text(float(motion.theta[worst]))}"),
            scale * float(off[worst]),
            unit=unit,
            limit=scale * most,
        )


@check("lift-error", kind=PRECISION, relation="at most")
def lift_error(deviation: LiftError, limit: float) -> Iterator[Remark]:  # noqa: ARG001
    """Warn if the tolerances let the lift deviate by more than is wanted.

    Looks at: the largest deviation of the lift over the cycle, with all tolerances.
    """
    found, wanted, combined = deviation
    scale, unit = found.wall.follower.lift_unit
    if found.value > wanted * (1.0 + ROUNDING):
        share = rounded_down(100.0 * wanted / found.value, 3)
        yield Remark(
            f"With its tolerances the lift may deviate by {formatted(scale * found.value, 4)} "
            f"{unit} ({combined.replace('-', ' ')}): more than is wanted. With {share} % of each "
            "tolerance it keeps that.",
            found.place,
            scale * found.value,
            unit=unit,
            limit=scale * wanted,
        )


class FittedMotion(NamedTuple):
    """What the checks of a fit look at.

    Parameters
    ----------
    wall : Wall
        The wall whose lift was measured.
    lift : FittedLift
        What was found.
    of_profile : bool
        Whether the lift is that of a measured profile, and not given itself.
    """

    wall: Wall
    lift: FittedLift
    of_profile: bool


@check("unknown-law", kind=FITTED, relation="at most")
def unknown_law(fitted: FittedMotion, limit: float) -> Iterator[Remark]:  # noqa: ARG001
    """Warn if no motion law moves as a measured lift does.

    The residual of a rise or return is more than twice the noise, both as root mean square.

    Looks at: each rise and return of a fitted lift.
    """
    (scale, unit), lift = fitted.wall.follower.lift_unit, fitted.lift
    sizes = (
        "Offset, roller, arm and pivot are taken from the design: one of them may be another. "
        if fitted.of_profile
        else ""  # a lift that was given does not depend on them
    )
    for k in range(len(lift.model.laws)):
        residual = float(np.sqrt(np.mean(lift.missed[lift.on(k)] ** 2)))
        if residual > _UNLIKE * lift.rows.noise:
            word = "return" if lift.model.falling(k) else "rise"
            yield Remark(
                f"No motion law moves like this {word}: the nearest one misses it by "
                f"{formatted(scale * residual, 3)} {unit} (rms), and the noise is "
                f"{formatted(scale * lift.rows.noise, 3)} {unit}. {sizes}To copy the lift as it "
                f"is, give its rows as [motion] with smoothing_tolerance_{unit}.",
                _measured(fitted, k),
                scale * residual,
                unit=unit,
                limit=scale * _UNLIKE * lift.rows.noise,
            )


@check("laws-alike", kind=FITTED, severity="note")
def laws_alike(fitted: FittedMotion, limit: float) -> Iterator[Remark]:  # noqa: ARG001
    """Say which motion laws cannot be distinguished in a measured lift.

    Their sums of squares differ by less than 16 variances of the noise.

    Looks at: each rise and return of a fitted lift.
    """
    lift = fitted.lift
    for k, others in enumerate(lift.alike):
        if others:
            names = [MOTION_LAWS.name_of(one.law) for one in others]
            yield Remark(
                "Cannot be distinguished at this noise: "
                f"{MOTION_LAWS.name_of(lift.model.laws[k])}, {', '.join(names)}.",
                _measured(fitted, k),
            )


def _measured(fitted: FittedMotion, k: int) -> str:
    """Return where a move is, in the angles of what was measured."""
    wall, model = fitted.wall, fitted.lift.model
    driver, turn = wall.carrier.driver, 2.0 * math.pi
    start, end = (driver.text(float(one[k]) % turn) for one in (model.starts, model.ends))
    word = "return" if model.falling(k) else "rise"
    return _at(wall, f"{word} from {start} to {end}")
