"""The checks of a mechanism's study of forces; importing this module registers them."""

from __future__ import annotations

from collections.abc import Iterator
from dataclasses import dataclass
from typing import Final

from gearcam.base.display import ShortRepr
from gearcam.base.findings import Remark, check
from gearcam.base.numerals import formatted
from gearcam.base.quantities import FORCE, Param

CHECKS: Final = "forces of a mechanism"
"""Name of the subject of the checks."""


@dataclass(frozen=True, kw_only=True)
class JointedMachine(ShortRepr):
    """A mechanism with the forces in its joints.

    Parameters
    ----------
    locked : str
        Where friction locks it, in words; empty if nowhere.
    peak : (float, str)
        The largest moment of the driver, N m, and where it is, in words.
    free : float
        Share of all coefficients of friction up to which it is locked nowhere.
    tipping : mapping of str to str
        Guides in which what slides tips, and where, in words.
    largest : mapping of str to (float, str)
        The largest force, N, of each joint and guide, and where it is, in words.
    pulled : mapping of str to (float, str, bool)
        Cams off which their followers are pulled: the largest such force, N, the ranges, and
        whether another wall holds the follower.
    slack : mapping of str to str
        Chains that would have to push, and where, in words.
    """

    locked: str
    peak: tuple[float, str]
    free: float
    tipping: dict[str, str]
    largest: dict[str, tuple[float, str]]
    pulled: dict[str, tuple[float, str, bool]]
    slack: dict[str, str]


@check("self-locking", kind=CHECKS, severity="error")
def self_locking(machine: JointedMachine, limit: float) -> Iterator[Remark]:  # noqa: ARG001
    """Report where friction locks the machine: no torque of the driver moves it.

    Looks at: the determinant of the equilibrium of all members with friction, which is above 0
    where the machine moves.
    """
    if machine.locked:
        yield Remark(
            f"Friction locks the machine. With up to {formatted(machine.free, 3)} times the "
            "coefficients of friction it moves everywhere, though near that with very large "
            "forces.",
            machine.locked,
        )


@check("edge-contact", kind=CHECKS, severity="note")
def edge_contact(machine: JointedMachine, limit: float) -> Iterator[Remark]:  # noqa: ARG001
    """Note slides that tip in their guides and press at both ends.

    Looks at: the place of the guide's force, where the length of what slides is given.
    """
    for name, where in machine.tipping.items():
        what = "What slides here tips and presses at both ends of its length."
        yield Remark(what, f"{name}, {where}")


@check("contact-reverses", kind=CHECKS, severity="note", unit="N")
def contact_reverses(machine: JointedMachine, limit: float) -> Iterator[Remark]:  # noqa: ARG001
    """Note where the machine pulls a follower off its cam, or onto its other wall.

    Looks at: the normal force between each cam and its follower, without the springs and loads of
    the cam's own design.
    """
    for name, (force, where, held) in machine.pulled.items():
        what = "Here the machine pulls the follower off its cam, with up to this force along the "
        what += "normal: a spring must hold it."
        if held:
            what = "Here the other wall carries, with up to this force along the normal: the load "
            what += "changes its side, across the clearance if there is any."
        yield Remark(what, f"{name}, {where}", force)


@check("slack-chain", kind=CHECKS)
def slack_chain(machine: JointedMachine, limit: float) -> Iterator[Remark]:  # noqa: ARG001
    """Warn of a chain that would have to push.

    Looks at: the tension of chains that swing a lever.
    """
    for name, where in machine.slack.items():
        yield Remark("Here the chain would have to push: it goes slack.", f"{name}, {where}")


@check(
    "joint-force",
    kind=CHECKS,
    limit=(
        "joint_force",
        Param(FORCE, ge=0, le=1e9, doc="largest force in a joint; 0: no limit"),
        0.0,
    ),
    relation="at most",
    unit="N",
)
def joint_force(machine: JointedMachine, limit: float) -> Iterator[Remark]:
    """Warn of a joint or guide with more than the force that is allowed.

    Looks at: the largest force of each joint and guide over the range.
    """
    for name, (force, where) in machine.largest.items():
        if limit and force > limit:
            yield Remark("The force is larger than allowed.", f"{name}, {where}", force)
