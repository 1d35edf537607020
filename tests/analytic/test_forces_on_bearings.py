"""Forces of teeth and cams on bearings and guides of mechanisms, against those of their own kinds.

A pair's study of forces finds each contact of two flanks, a cam's the statics of its follower: both
know nothing of mechanisms.
"""

from __future__ import annotations

import cmath
import math
from typing import Any

import numpy as np
import pytest

import gearcam as gc
from gearcam.gears.contact import COAST, DRIVE, flank_pairs
from gearcam.kinds.mechanism.forces import JointForces
from gearcam.linkages.bonds import Hinge, SlidingJoint
from gearcam.linkages.known import GROUND
from gearcam.linkages.reactions import Reactions
from gearcam.mechanics.friction import WheelFrictionSpec
from gearcam.meshing.forces import tooth_forces
from gearcam.numeric.arrays import Array, Plane
from helpers_machines import LEVER, TAPPET
from helpers_pairs import PROFILES

FRAMES: dict[str, dict[str, Any]] = {
    "as it is": {},
    "turned": {"at_mm": [30, -40], "turn_deg": 35},
    "mirrored": {"at_mm": [5, 10], "turn_deg": -120, "mirror": True},
}


def joints(drive: dict[str, Any], **tables: Any) -> JointForces:
    """A mechanism behind a drive."""
    drives = [{"name": "d", **drive}, *tables.pop("drives", [])]
    text = {"kind": "mechanism", "name": "m", "drive": drives, **tables}
    return JointForces(gc.build(gc.design(text)))


def directed(ways: Plane, frame: dict[str, Any]) -> Plane:
    """Directions in the frame of a drive, in the machine."""
    seen = ways.conj() if frame.get("mirror") else ways
    return seen * cmath.exp(1j * math.radians(frame.get("turn_deg", 0)))


def located(points: Plane, frame: dict[str, Any]) -> Plane:
    return complex(*frame.get("at_mm", (0, 0))) + directed(points, frame)


def force(made: JointForces, found: Reactions, name: str) -> Plane:
    """The force in a joint or a guide, on what it holds."""
    (bond,) = (one for one, label in made.joints.items() if label == name)
    return found.force(bond)


def unknown(made: JointForces, found: Reactions, name: str) -> Array:
    """The only unknown of a drive, or the couple of a guide."""
    (bond,) = (one for one, label in made.labels.items() if label == name)
    return found.of(bond)[:, -1]


def close(found: Any, known: Any, least: float = 0.0) -> None:
    """Assert that forces agree, to rounding of the largest, or of the `least` if that is more."""
    most = max(least, float(np.abs(known).max()))
    assert most > 0.0
    assert np.abs(found - known).max() <= 1e-9 * most


# --- pairs ------------------------------------------------------------------------------------

WAIST = {"type": "formula", "ratio": "1 + 0.3*cos(phi1)"}
BENT = {"type": "formula", "ratio": "1 + 0.65*cos(2*phi1)"}

PAIRS: dict[str, Any] = {
    "ellipse": {"law": {"type": "ellipse", "eccentricity": 0.3},
                "pair": {"teeth": [41, 41], "module_mm": 3}},
    "shifted": {"law": {"type": "ellipse", "eccentricity": 0.3},
                "pair": {"teeth": [41, 41], "module_mm": 3, "x": 0.2},
                "rack": {"pressure_angle_deg": 25}},
    "nail machine": str(PROFILES / "nail_machine_two_phase.toml"),
    "open": str(PROFILES / "log_spiral.toml"),
    "stepped": {"law": {"type": "ellipse", "eccentricity": 0.3}, "steps": {"count": 3},
                "pair": {"teeth": [41, 41], "module_mm": 3}},
    "ring": {"law": WAIST, "pair": {"type": "internal", "teeth": [36, 72], "module_mm": 2}},
    "ring, uneven": str(PROFILES / "ring_uneven.toml"),
    "concave": {"law": BENT, "pair": {"teeth": [60, 60], "module_mm": 2}},
    "rack": str(PROFILES / "feeder.toml"),
}  # fmt: skip


def by_teeth(made: JointForces, q: Array, load: Array) -> Plane:
    """Force of the frame on the driver's shaft, in the frame of the pair, from each contact."""
    pair = made.result.drives[0].result
    sides = [pair.subject.sides]
    sides += [(flank_pairs(one, COAST), flank_pairs(one, DRIVE)) for one in pair.steps[1:]]
    friction = WheelFrictionSpec()
    return tooth_forces(sides, q, load, on_driver=False, friction=friction).bearing


@pytest.mark.parametrize("frame", FRAMES)
@pytest.mark.parametrize("name", PAIRS)
def test_bearings_of_a_pair_carry_its_teeth(name: str, frame: str) -> None:
    """Behind a load that drives and holds back: on drive and coast flanks."""
    where = FRAMES[frame]
    crank = {"name": "handle", "on": "d.wheel1", "joint": "H", "length_mm": 20}
    if name == "rack":
        more: dict[str, Any] = {
            "slide": [{"name": "out", "on": "d.rack", "joint": "P"}],
            "load": [{"on": "out", "formula": "100*cos(3*q)"}],
        }
    else:
        more = {"load": [{"on": "out", "formula": "10*cos(3*q)"}]}
        more["crank"] = [{"name": "out", "on": "d.wheel2", "joint": "P", "length_mm": 20}]
    more["crank"] = [crank, *more.get("crank", [])]
    made = joints({"pair": PAIRS[name], **where}, **more)
    low, high = made.result.linkage.span
    q = np.linspace(low, high, 48)[1:-1]
    found = made.at(q)
    driven = "d.rack" if name == "rack" else "d.wheel2"
    bonds = {label: bond for bond, label in made.labels.items()}
    drive = unknown(made, found, f"{driven}_drive")
    close(drive, -(100.0 if name == "rack" else 1e4) * np.cos(3.0 * q))
    assert bonds[f"{driven}_drive"].on == "out"
    falls = name.startswith(("ring", "rack"))
    sense = (-1.0 if falls else 1.0) * (-1.0 if where.get("mirror") and name != "rack" else 1.0)
    known = directed(by_teeth(made, q, sense * drive), where)
    there = np.isfinite(known)  # undercut takes some contacts
    assert there.mean() > 0.9
    close(force(made, found, "d.wheel1")[there], known[there])
    if name != "rack":
        close(force(made, found, "d.wheel2")[there], -known[there])
        return
    along = directed(np.array([1j]), where)
    across = known - along * np.real(np.conj(along) * known)
    close(force(made, found, "d.rack")[there], -across[there])


# --- cams -------------------------------------------------------------------------------------

GROOVE = gc.load(PROFILES / "groove_cam.toml").to_dict()
CONJUGATE = gc.load(PROFILES / "conjugate_cams.toml").to_dict()
DRUM: dict[str, Any] = {
    "kind": "cam", "name": "drum",
    "motion": [
        {"type": "rise", "law": "modified-sine", "angle_deg": 150, "lift_mm": 60},
        {"type": "dwell", "angle_deg": 40},
        {"type": "return", "law": "cycloidal", "angle_deg": 140},
        {"type": "dwell", "angle_deg": "rest"},
    ],
    "follower": {"roller_radius_mm": 11},
    "cam": {"form": "cylinder", "outer_diameter_mm": 200, "length_mm": 110, "lowest_mm": 25,
            "groove_depth_mm": 18},
}  # fmt: skip
SWING: dict[str, Any] = {
    **DRUM,
    "motion": [{"type": "rise", "law": "modified-sine", "angle_deg": 150, "lift_deg": 20},
               *DRUM["motion"][1:]],
    "follower": {"roller_radius_mm": 11, "motion": "oscillating", "arm_mm": 160, "start_deg": -7,
                 "pivot_distance_mm": 158.5},
    "cam": {**DRUM["cam"], "length_mm": 130, "lowest_mm": 35},
}  # fmt: skip

CAMS: dict[str, tuple[dict[str, Any], tuple[float, ...]]] = {
    "tappet": (gc.load(TAPPET).to_dict(), (1.0,)),
    "flat": (gc.load(PROFILES / "flat_follower.toml").to_dict(), (1.0,)),
    "groove": (GROOVE, (1.0, -1.0)),
    "conjugate": (CONJUGATE, (1.0, -1.0)),
    "lever": (gc.load(LEVER).to_dict(), (1.0,)),
    "drum": (DRUM, (1.0, -1.0)),
    "arm of a drum": (SWING, (1.0, -1.0)),
    "turret": (gc.load(PROFILES / "globoidal_indexer.toml").to_dict(), (1.0, -1.0)),
}
"""Each with the walls that are asked for: that which lifts, and the other."""

CASES = [(name, side) for name, (_, sides) in CAMS.items() for side in sides]


@pytest.mark.parametrize("frame", FRAMES)
@pytest.mark.parametrize("rotation", ["ccw", "cw"])
@pytest.mark.parametrize(("name", "side"), CASES)
def test_what_holds_a_follower_carries_its_cam(
    name: str, side: float, rotation: str, frame: str
) -> None:
    where, cam = FRAMES[frame], CAMS[name][0]
    cam = {key: one for key, one in cam.items() if key not in ("spring", "mass", "load", "gravity")}
    cam["cam"] = {**cam["cam"], "rotation": rotation}
    space = cam["cam"]["form"] in ("cylinder", "globoidal")
    plane, word = not space, "turret" if name == "turret" else "follower"
    swings = word == "turret" or cam["follower"].get("motion") == "oscillating"
    alone = {**cam, "load": [{"torque_nm": 20 * side} if swings else {"force_n": 200 * side}]}
    if word == "turret":
        alone["load"][0]["on"] = "turret"
    own = gc.build(gc.design(alone)).study("forces").columns
    theta, size = np.radians(own["theta_deg"]), 2e4 if swings else 200.0
    hand = -1.0 if rotation == "cw" else 1.0
    seen = -1.0 if where.get("mirror") else 1.0
    # a turret is indexed clockwise on both hands, an arm lifted as the design says
    sense = -1.0 if word == "turret" else hand * _lifting(cam)
    out = {"name": "out", "on": f"d.{word}", "joint": "P"}
    handle = {"name": "handle", "on": "d.shaft", "joint": "H", "length_mm": 20}
    cranks = [handle] if plane else []
    load: dict[str, Any] = {"on": "out", "force_n": -size * side}
    slides = [] if swings else [out]
    if swings:
        cranks = [*cranks, {**out, "length_mm": 30}]
        load = {"on": "out", "torque_nm": -1e-3 * size * side * sense * seen}
    made = joints({"cam": cam, **where}, slide=slides, crank=cranks, load=[load])
    found = made.at(theta)
    close(found.contacts["d"], side * own["normal_n"])
    if swings:
        up = "z" if space else "y"
        across = "y" if name == "arm of a drum" else "x"
        pivot = own[f"pivot_{across}_n"] + 1j * own[f"pivot_{up}_n"]
        close(force(made, found, f"d.{word}"), directed(pivot, where))
    elif plane:
        held = made.result.drives[0].result.follower.held(
            made.result.drives[0].result.design.friction, _highest(cam)
        )
        right = -1j * held.direction
        middle = held.middle if rotation == "ccw" else -held.middle.conjugate()
        assert right == pytest.approx(1.0)
        holding = directed(own["guide_n"] * right, where)
        close(force(made, found, "d.follower"), holding, size)  # a flat one has none
        arm = found.known.place("P") - located(np.array([middle]), where)
        moment = unknown(made, found, "d.follower") + np.imag(np.conj(arm) * holding)
        close(moment, seen * own["guide_moment_nmm"])
    if plane:
        bearing = force(made, found, "d.shaft")
        close(np.abs(bearing), own["bearing_n"])
        close(bearing, -force(made, found, f"d.{word}") + _along(made, found, swings))


def _along(made: JointForces, found: Reactions, swings: bool) -> Any:
    """Force of a slide's cam along its guide."""
    if swings:
        return 0.0
    return unknown(made, found, "d.follower_drive") * found.known.direction("d.follower.way")


def _highest(cam: dict[str, Any]) -> float:
    return float(gc.build(gc.design(cam)).program.range[1])


def _lifting(cam: dict[str, Any]) -> float:
    """+1 if lift turns the arm of a cam that turns counter-clockwise by itself, else -1."""
    made: Any = gc.build(gc.design(cam))
    return float(np.sign(made.follower.held(made.design.friction, 0.0).spin)) if hasattr(
        made.follower.held(made.design.friction, 0.0), "spin"
    ) else 1.0


# --- whole machines ---------------------------------------------------------------------------


def on_the_machine(made: JointForces, found: Reactions, loads: dict[str, complex]) -> tuple[Any, Any]:
    """Force and moment about the origin of all that the frame and loads exert, but the driver's."""
    total, moment = np.zeros(found.moment.shape, dtype=complex), np.zeros(found.moment.shape)
    for bond in found.structure.bonds:
        if isinstance(bond, Hinge | SlidingJoint) and bond.by == GROUND:
            own, point = found.force(bond), found.known.place(bond.place)
            total, moment = total + own, moment + np.imag(np.conj(point) * own)
            if isinstance(bond, SlidingJoint):
                moment = moment + found.of(bond)[:, 1]
    for joint, own in loads.items():
        total, moment = total + own, moment + np.imag(np.conj(found.known.place(joint)) * own)
    return total, moment
