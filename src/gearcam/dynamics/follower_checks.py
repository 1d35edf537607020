"""The checks of a follower in motion; importing this module registers them."""

from __future__ import annotations

from collections.abc import Iterator, Sequence
from dataclasses import dataclass
from typing import Final

from gearcam.base.display import ShortRepr
from gearcam.base.findings import Remark, check
from gearcam.base.numerals import formatted
from gearcam.base.quantities import NUMBER, Param

MOVING: Final = "followers in motion"
"""The checks of a study of dynamics of a cam."""

_BALANCED: Final = 100.0
"""Energy residue over the tolerance of a step above which a motion is not trusted."""


@dataclass(frozen=True, eq=False, kw_only=True)
class MovingFollower(ShortRepr):
    """What is checked of an elastic follower in motion.

    Parameters
    ----------
    flights : sequence of str
        Arcs in which it is off its cam, in words.
    impact : float or None
        Largest speed at which it meets the cam again; None if it does not within the turn.
    unit : str
        Of that speed.
    stays : str
        Up to which speed it stays on its cam, in words; empty if unknown.
    least : float
        Least contact force over the mean one; nan where the cam holds it from both sides.
    least_at : str
        Where that is, in words.
    residual : float
        Largest vibration in a dwell over the lift; 0 without dwells.
    residual_at : str
        The dwell, in words.
    restless : int
        Number of turns after which they do not repeat yet; 0 if they do.
    energy_residue : float
        What the energies of a turn do not balance by.
    tolerance : float
        Of a step.
    """

    flights: Sequence[str]
    impact: float | None
    unit: str
    stays: str
    least: float
    least_at: str
    residual: float
    residual_at: str
    restless: int
    energy_residue: float
    tolerance: float


@check("jump", kind=MOVING)
def jump(moving: MovingFollower, limit: float) -> Iterator[Remark]:  # noqa: ARG001
    """Warn where a follower leaves its cam, and meets it again with an impact.

    Looks at: arcs without contact of the integrated motion, over its last turn.
    """
    if not moving.flights:
        return
    message = "The follower leaves the cam and meets it again with an impact: a stiffer spring, "
    message += "more preload, or a lower speed keeps it there"
    message += f"; it stays there up to {moving.stays}." if moving.stays else "."
    if moving.restless:
        message += (
            f" After {moving.restless} turns it does not repeat itself yet: other turns have "
        )
        message += "other arcs."
    where, more = moving.flights[0], len(moving.flights) - 1
    yield Remark(message, f"{where}, and {more} more" if more else where, moving.impact,
                 unit=moving.unit)  # fmt: skip


_LEAST: Final = (
    "contact_force",
    Param(NUMBER, ge=0, lt=1, doc="least contact force of a moving follower over the mean one"),
    0.1,
)


@check("near-jump", kind=MOVING, limit=_LEAST, relation="at least")
def near_jump(moving: MovingFollower, limit: float) -> Iterator[Remark]:
    """Warn if a follower nearly leaves its cam: a little more speed or friction, and it does.

    Looks at: least contact force of the moving follower along the lift, over the mean one. A spring
    that is solved for keeps this limit.
    """
    if not moving.flights and moving.least < limit:
        message = "The follower nearly leaves the cam: a stiffer spring or more preload holds it"
        message += f"; it stays there up to {moving.stays}." if moving.stays else "."
        yield Remark(message, moving.least_at, moving.least)


_SWINGS: Final = (
    "residual_vibration",
    Param(NUMBER, ge=0, le=10, doc="largest vibration of a follower in a dwell, over the lift"),
    0.01,
)


@check("residual-vibration", kind=MOVING, limit=_SWINGS, relation="at most")
def residual_vibration(moving: MovingFollower, limit: float) -> Iterator[Remark]:
    """Warn if a follower swings on in a dwell, where it should stand.

    Looks at: largest distance of the last mass from its place of rest in each dwell, over the lift.
    """
    if moving.residual > limit:
        message = "The follower swings on in a dwell: a stiffer train, a lower speed, or a law "
        message += "whose chart of residual vibrations is lower there lessens it."
        yield Remark(message, moving.residual_at, moving.residual)


@check("energy", kind=MOVING, severity="warning")
def energy(moving: MovingFollower, limit: float) -> Iterator[Remark]:  # noqa: ARG001
    """Warn if the energies of the integrated motion do not balance.

    Looks at: energy at the steps of the turn less the work put in, over the largest change of
    energy, against a hundred times the tolerance.
    """
    most = _BALANCED * moving.tolerance
    if moving.energy_residue > most:
        message = f"The energies of the turn balance only to {formatted(moving.energy_residue)}: "
        yield Remark(message + "a smaller dynamics.tolerance makes the motion exact.")
