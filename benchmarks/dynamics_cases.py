"""Machines in motion against openTorsion (natural frequencies) and EXUDYN (a follower that flies).

Each comparison is made once more with a wrong number, which it must reject.
"""

from __future__ import annotations

import math
from typing import Any

import numpy as np
from numpy.typing import NDArray

import gearcam
import peer_dynamics
import peers
from gearcam.kinds.cam.moving import MovingCam
from gearcam.kinds.gear_pair.dynamics import motion_of
from gearcam.results.study import silent
from measuring import ROOT, Result, in_turns, table
from peer_dynamics import LastTurn, Train

Array = NDArray[np.float64]

PAIR = ROOT / "profiles" / "rattling_pair.toml"
CAM = ROOT / "profiles" / "elastic_valve_train.toml"

WRONG = 1.01
"""Factor of the number that is wrong."""

FREQUENCY = 1e-11
"""Largest difference allowed, over the frequency."""

FORCE, ANGLE, IMPACT = 1e-5, 1e-4, 1e-4
"""The same over the largest contact force; in degrees; over the speed of impact."""

RPM = 1250
"""Beyond 1132 rpm, at which the follower jumps: it leaves the cam three times in a turn."""

TURNS, TOLERANCE = 8, 1e-8
"""Turns of EXUDYN, after which the motion repeats, and the tolerance of both."""

BESIDE = 1e-3
"""deg: from a landing, where the force jumps."""

_FREQUENCY_NOTE = """\
Shafts of 0.2 and 0.3 kg m2 and the teeth of the nail machine at 512 angles, the ratio by its
formula, the stiffness of the teeth (2.5e6 to 2.4e7 N m/rad) as gearcam has it; and the two masses
of an elastic valve train with their three springs. The least and largest frequencies that gearcam
prints differ by {pair:.0e} and {chain:.0e} of them; with a ratio and a spring 1 % larger by
{wrong_pair:.0e} and {wrong_chain:.0e}."""
_FLIGHT_NOTE = """\
The valve train at {rpm} rpm, contact stiffness 20 000 N/mm, until the motion repeats: {turns} turns
of gearcam; {peer_turns} of EXUDYN, from rest. EXUDYN (explicit, DOPRI5, tolerance {tolerance:g})
has masses, springs and dampers of its own; the lift, the spring that only presses and its end that
relaxes in flight are functions in Python, which take most of its time. In its last turn, at {steps}
steps, the contact force differs by {force:.1e} of the largest, the angles of {flights} losses and
landings by {angle:.1e} deg, the speeds of impact by {impact:.1e} of them. With a contact 1 %
stiffer: {wrong_force:.1e}, {wrong_angle:.1e} deg, {wrong_impact:.1e}."""


def against_peers() -> list[Result]:
    """(zm) Natural frequencies against openTorsion; (zn) a flying follower against EXUDYN."""
    return [_frequencies(), _flights()]


def _relative(own: Any, other: Any) -> float:
    return float(np.abs(np.asarray(other) / np.asarray(own) - 1.0).max())


def _frequencies() -> Result:
    """(zm) Natural frequencies of elastic teeth and of an elastic train."""
    made = gearcam.build(gearcam.load(PAIR))
    told = made.study("dynamics").facts
    pair: Any = motion_of(made, silent)
    pair = pair.pair
    ratios = peers.nail_machine(0.0).derivatives(pair.places)[1]
    stiffness = pair.table.at(pair.places)[2]

    def by_peer(factor: float) -> Array:
        each = zip(factor * ratios, stiffness, strict=True)
        return np.array([peer_dynamics.pair_frequency((0.2, 0.3), *one) for one in each])

    own = [math.tau * told[f"dynamics.natural_frequency_hz.{end}"] for end in ("min", "max")]
    off, wrong = (
        _relative(own, (found.min(), found.max())) for found in (by_peer(1.0), by_peer(WRONG))
    )
    train = gearcam.build(gearcam.load(CAM)).study("dynamics").facts
    own = math.tau * np.array(train["dynamics.natural_frequency_hz"])
    chain, wrong_chain = (
        _relative(own, peer_dynamics.chain_frequencies((2e-4, 5e-4), (factor * 2e4, 2e3, 10.0)))
        for factor in (1.0, WRONG)
    )
    mine, other = in_turns(
        {
            "512 angles, gearcam": lambda: pair.frequency(pair.places),
            "512 angles, openTorsion": lambda: by_peer(1.0),
        },
        5,
    )
    note = _FREQUENCY_NOTE.format(pair=off, chain=chain, wrong_pair=wrong, wrong_chain=wrong_chain)
    return Result(
        title="(zm) Natural frequencies of elastic teeth and trains against openTorsion",
        asked="the same to 1e-11",
        found=f"{max(off, chain):.0e}",
        passed=max(off, chain) <= FREQUENCY < 1e-6 < min(wrong, wrong_chain),
        body=[*table([mine, other]), "", note],
    )


def lift(angle: float) -> tuple[float, float]:
    """Return lift and derivative: cycloidal rise of 10 mm, dwell, return, dwell of 90 deg each."""
    phase, part = divmod(angle % math.tau / (0.5 * math.pi), 1.0)
    if phase % 2:
        return (10.0 if phase == 1 else 0.0), 0.0
    s = 10.0 * (part - math.sin(math.tau * part) / math.tau)
    slope = 10.0 * (1.0 - math.cos(math.tau * part)) / (0.5 * math.pi)
    return (s, slope) if phase == 0 else (10.0 - s, -slope)


def _train(stiffer: float = 1.0) -> Train:
    """Return the train of the profile, dampers of 0.1 and 0.05 of the critical ones."""
    contact, behind, masses = stiffer * 2e4, 2e3, (2e-4, 5e-4)
    return Train(
        masses=masses,
        stiffness=(contact, behind),
        damping=(0.2 * math.sqrt(2e4 * masses[0]), 0.1 * math.sqrt(behind * masses[1])),
        spring=10.0,
        preload=200.0,
        lift=lift,
        speed=RPM * math.pi / 30.0,
    )


def _apart(moving: MovingCam, peer: LastTurn) -> tuple[float, float, float]:
    """Return the differences of contact force, angles in deg, and impacts; inf if flights lack."""
    flights = sorted(moving.turn.flights, key=lambda one: one.start)
    if not len(flights) == len(peer.left) == len(peer.met):
        return (math.inf,) * 3
    inside = peer.angle < math.tau - 1e-9
    for one in flights:
        inside &= np.abs(peer.angle - one.end) > math.radians(BESIDE)
    own, other = moving.at(peer.angle[inside]).normal, peer.force[inside]
    force = float(np.abs(own - other).max() / own.max())
    angles = np.array([(one.start, one.end) for one in flights]).T
    angle = float(np.degrees(np.abs(angles - [peer.left, peer.met]).max()))
    return force, angle, _relative([one.impact for one in flights], peer.impact)


def _flights() -> Result:
    """(zn) A follower beyond the speed at which it jumps."""
    changes = {"drive.speed_rpm": RPM, "dynamics.tolerance": TOLERANCE}
    result, train = gearcam.build(gearcam.load(CAM).with_(changes)), _train()
    moving, peer = MovingCam(result), peer_dynamics.flown(train, TURNS, TOLERANCE)
    apart = _apart(moving, peer)
    wrong = _apart(moving, peer_dynamics.flown(_train(WRONG), TURNS, TOLERANCE))
    bounds = FORCE, ANGLE, IMPACT
    mine, other = in_turns(
        {
            "gearcam": lambda: MovingCam(result).turn,
            "EXUDYN": lambda: peer_dynamics.flown(train, TURNS, TOLERANCE),
        },
        3,
    )
    names = ("force", "angle", "impact")
    note = _FLIGHT_NOTE.format(
        rpm=RPM, turns=moving.turn.turns, peer_turns=TURNS, tolerance=TOLERANCE,
        steps=len(peer.angle), flights=2 * len(peer.left),
        **dict(zip(names, apart, strict=True)),
        **{f"wrong_{name}": one for name, one in zip(names, wrong, strict=True)},
    )  # fmt: skip
    return Result(
        title="(zn) A follower that leaves its cam against EXUDYN",
        asked="the force to 1e-5, angles to 1e-4 deg, impacts to 1e-4",
        found=f"{apart[0]:.0e}, {apart[1]:.0e} deg, {apart[2]:.0e}",
        passed=all(off <= most < bad for off, most, bad in zip(apart, bounds, wrong, strict=True)),
        body=[*table([mine, other]), "", note],
    )
