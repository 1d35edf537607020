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
from gearcam.mechanics.follower_loads import DrivenMotion
from gearcam.mechanics.friction import WheelFrictionSpec
from gearcam.meshing.forces import tooth_forces
from gearcam.numeric.arrays import Array, Plane
from gearcam.numeric.roots import bracketed_root
from helpers_machines import DRUM, FRAMES, LEVER, SWING, TAPPET
from helpers_pairs import PROFILES
from helpers_sampling import few


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
BENT = {"type": "formula", "ratio": "1 + 0.5*cos(2*phi1)"}

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
    "concave": {"law": BENT, "pair": {"teeth": [120, 120], "module_mm": 1}},
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
    cutters = {one.cutter.kind for one in made.result.drives[0].result.pair.toothings}
    assert "pinion" in cutters or not name.startswith(("ring", "concave"))
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

WAYS = [
    ("ccw", "as it is"), ("cw", "as it is"), ("cw", "turned"),
    ("ccw", "turned"), ("ccw", "mirrored"), ("cw", "mirrored"),
]  # fmt: skip

CASES = [(name, side) for name, (_, sides) in CAMS.items() for side in sides]


@pytest.mark.parametrize(  # each case and each way is run each time
    ("name", "side", "rotation", "frame"),
    few(((*case, *way) for case in CASES for way in WAYS), 5),
)
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
    return (
        float(np.sign(made.follower.held(made.design.friction, 0.0).spin))
        if hasattr(made.follower.held(made.design.friction, 0.0), "spin")
        else 1.0
    )


# --- whole machines ---------------------------------------------------------------------------


def on_the_machine(found: Reactions, loads: dict[str, complex]) -> tuple[Any, Any]:
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


def _slider(begin: str, x: float) -> dict[str, Any]:
    """A slider-crank behind a joint."""
    return {
        "guide": [{"name": "bed", "at_mm": [x, 10], "direction_deg": 20}],
        "dyad": [{"type": "RRT", "from": begin, "to": "bed", "joint": "C",
                  "members": ["rod", "ram"], "lengths_mm": [150, 0]}],
    }  # fmt: skip


def _behind(shaft: str, x: float) -> dict[str, Any]:
    crank = {"name": "out", "on": shaft, "joint": "B", "length_mm": 35}
    return {"crank": [crank], **_slider("B", x)}


CONE = {**DRUM, "follower": {**DRUM["follower"], "cone_deg": "apex"}}

WHOLE: dict[str, tuple[dict[str, Any], dict[str, Any]]] = {
    "pair": ({"pair": PAIRS["ellipse"]}, _behind("d.wheel2", 120)),
    "ring": ({"pair": PAIRS["ring"]}, _behind("d.wheel2", 0)),
    "ring, mirrored": ({"pair": PAIRS["ring"], **FRAMES["mirrored"]}, _behind("d.wheel2", 0)),
    "rack": (
        {"pair": PAIRS["rack"], **FRAMES["turned"]},
        {"slide": [{"name": "out", "on": "d.rack", "joint": "C", "at_mm": [10, 5]}]},
    ),
    "follower": (
        {"cam": TAPPET, **FRAMES["mirrored"]},
        {"slide": [{"name": "out", "on": "d.follower", "joint": "C", "at_mm": [10, 5]}]},
    ),
    "lever": ({"cam": LEVER, **FRAMES["turned"]}, _behind("d.follower", 150)),
}
"""A drive whose both shafts hold members, and what it moves."""


@pytest.mark.parametrize("name", WHOLE)
def test_the_frame_and_the_loads_hold_a_machine(name: str) -> None:
    """Forces between wheels, or cam and follower, are within it: the frame holds it as a whole."""
    drive, tables = WHOLE[name]
    shaft = "d.wheel1" if "pair" in drive else "d.shaft"
    handle = {"name": "handle", "on": shaft, "joint": "H", "length_mm": 20}
    loads = {"H": 30 - 50j, "C": 200 + 90j}
    made = joints(
        drive, **tables | {"crank": [handle, *tables.get("crank", [])]},
        load=[{"on": on, "force_n": [one.real, one.imag]} for on, one in loads.items()],
    )  # fmt: skip
    low, high = made.result.linkage.span
    found = made.at(np.linspace(low, high, 30)[1:-1])
    total, moment = on_the_machine(found, loads)
    assert np.abs(total).max() < 1e-9
    moment = moment + found.moment / found.known.rate(shaft)
    assert np.abs(moment).max() < 1e-9 * np.abs(found.moment).max()


def test_a_shaft_without_members_is_that_of_a_crank_that_turns_with_it() -> None:
    """Two cams on one shaft press on the same bearing."""
    tables = {
        "drives": [{"name": "e", "cam": LEVER, "turn_deg": 100, "phase_deg": 40}],
        "slide": [{"name": "a", "on": "d.follower", "joint": "A"}],
        "crank": [
            {"name": "handle", "on": "d.shaft", "joint": "H", "length_mm": 20},
            {"name": "b", "on": "e.follower", "joint": "B", "length_mm": 40},
        ],
    }
    loads = {"A": -30 - 500j, "B": 90 + 200j}
    made = joints(
        {"cam": TAPPET}, **tables,
        load=[{"on": on, "force_n": [one.real, one.imag]} for on, one in loads.items()],
    )  # fmt: skip
    found = made.at(np.linspace(0.0, 6.0, 30))
    total, moment = on_the_machine(found, loads)
    assert np.abs(total).max() < 1e-9
    assert np.abs(moment + found.moment).max() < 1e-9 * np.abs(found.moment).max()


def test_a_crank_that_turns_as_a_wheel_does_for_an_instant_is_not_on_its_shaft() -> None:
    crank = {"name": "beside", "on": "e", "joint": "B", "length_mm": 20}
    bucket = {"name": "bucket", "on": "d.wheel2", "joint": "K", "radius_mm": 15, "at_mm": [300, 0]}
    made = joints(
        {"pair": PAIRS["ellipse"], "range_deg": [0, 350]},
        drives=[{"name": "e", "even": True, "at_mm": [_distance(PAIRS["ellipse"]), 0]}],
        crank=[crank], hoist=[bucket], load=[{"on": "bucket", "force_n": 60}],
    )  # fmt: skip
    track = made.result.linkage.track
    rates = [lambda q, name=name: track(name, q, 1).derivatives()[1] for name in ("d.wheel2", "e")]
    q = bracketed_root(lambda q: rates[0](q) - rates[1](q), np.array([0.1]), np.array([3.0]), 1e-14)
    assert rates[0](q) == pytest.approx(rates[1](q), abs=1e-12)
    found = made.at(q)
    assert np.abs(found.contacts["d"]).min() > 1.0
    assert np.abs(force(made, found, "e")).max() == 0.0


def _distance(pair: dict[str, Any]) -> float:
    """The centre distance of a pair."""
    made: Any = gc.build(gc.design({"kind": "gear-pair", "name": "p", **pair}))
    return made.pair.center_distance


def test_a_plate_is_held_against_its_follower() -> None:
    """The force that moves the plate acts at its joint."""
    plate = str(PROFILES / "translating_cam.toml")
    travel = gc.build(gc.load(plate)).program.period  # pyright: ignore[reportAttributeAccessIssue]
    loads = {"P": -90 + 20j, "F": 40 - 300j}
    made = joints(
        {"even": True},
        drives=[{"name": "c", "cam": plate, "slide": f"{0.45 * travel}*(1.1 - cos(q))",
                 "at_mm": [20, 10], "turn_deg": 25}],
        slide=[{"name": "low", "on": "c.plate", "joint": "P"},
               {"name": "high", "on": "c.follower", "joint": "F"}],
        load=[{"on": on, "force_n": [one.real, one.imag]} for on, one in loads.items()],
    )  # fmt: skip
    found = made.at(np.linspace(0.2, 2.9, 30))
    pushing = found.moment / found.known.rate("c.plate") * found.known.direction("c.plate.way")
    total, moment = on_the_machine(found, loads)
    assert np.abs(total + pushing).max() < 1e-9
    moment = moment + np.imag(np.conj(found.known.place("P")) * pushing)
    assert np.abs(moment).max() < 1e-9 * np.abs(found.moment).max()


@pytest.mark.parametrize("rotation", ["ccw", "cw"])
@pytest.mark.parametrize("cam", [DRUM, CONE], ids=["cylinder", "cone"])
def test_a_guide_along_a_drum_carries_its_roller(cam: dict[str, Any], rotation: str) -> None:
    """In the plane of the follower: all normals meet the roller's axis, also of a cone."""
    cam = {**cam, "cam": {**cam["cam"], "rotation": rotation}}
    slide = {"name": "out", "on": "d.follower", "joint": "P"}
    made = joints({"cam": cam}, slide=[slide], load=[{"on": "out", "force_n": -200}])
    q = np.linspace(0.1, 2.5, 9)
    drum, found = made.result.drives[0].result, made.at(q)
    s, ds, d2s = drum.program.derivatives(q, 2)
    support = drum.cam.guide.support(drum.design.friction)
    (push,) = (
        one
        for touch in drum.touches
        if ((one := touch.push(DrivenMotion(q, s, ds, d2s), support, 0.0)[0]).plain > 0.0).all()
    )
    hand = 1.0 if rotation == "ccw" else -1.0
    close(force(made, found, "d.follower"), -200.0 * hand * push.force[:, 1] / push.plain)
    assert push.moment[:, 0] == pytest.approx(0.0, abs=1e-12)
    assert unknown(made, found, "d.follower") == pytest.approx(0.0, abs=1e-9)


# --- which flank or wall, with friction and several members -------------------------------------


def test_the_shaft_has_what_all_its_members_and_loads_ask_of_it() -> None:
    """Two cranks, a hoist, whose drum is on no member, a torque: their sum by virtual work."""
    tables = {
        "crank": [{"name": "one", "on": "d.wheel2", "joint": "A", "length_mm": 20},
                  {"name": "two", "on": "d.wheel2", "joint": "B", "length_mm": 30}],
        "hoist": [{"name": "bucket", "on": "d.wheel2", "joint": "K", "radius_mm": 15,
                   "at_mm": [300, 0]}],
        "load": [{"on": "A", "force_n": [50, 10]}, {"on": "B", "force_n": [0, -190]},
                 {"on": "bucket", "force_n": 60}, {"on": "d.wheel2", "torque_nm": 1.5}],
    }  # fmt: skip
    made = joints({"pair": PAIRS["ellipse"], "range_deg": [0, 350]}, **tables)
    q = np.linspace(0.1, 6.0, 25)
    found, work = made.at(q), made.work.on({"d.wheel2": 1.0}, q)
    hinges = [force(made, found, f"d.wheel2_{one}") for one in ("one", "two")]
    known = -by_teeth(made, q, work)
    close(hinges[0] + 50 + 10j, known)
    close(hinges[1], np.full(q.shape, 190j))
    assert (work > 0.0).any()
    assert (work < 0.0).any()


def test_with_friction_the_flanks_that_carry_are_those_of_all_moments() -> None:
    """Where a load hardly drives, friction of the bearing turns it into one that is driven."""
    tables = {
        "crank": [{"name": "out", "on": "d.wheel2", "joint": "P", "length_mm": 20}],
        "load": [{"on": "out", "formula": "10*cos(3*q)"}],
        "mass": [{"of": "out", "mass_kg": 100, "at_mm": [0, 0]}],
        "gravity": {"direction_deg": -90},
        "friction": {"joint": 0.2, "journal_radius_mm": 30},
    }
    made = joints({"pair": PAIRS["ellipse"]}, **tables)
    q = np.linspace(0.1, 6.0, 60)
    found, smooth = made.at(q), made.at(q, 0.0)
    drive, bearing = unknown(made, found, "d.wheel2_drive"), force(made, found, "d.wheel2")
    alone = unknown(made, smooth, "d.wheel2_drive")
    assert ((alone < 0.0) & (drive > 0.0)).sum() > 3  # other flanks carry
    assert ((alone < 0.0) & (drive < 0.0)).sum() > 3
    known = 100 * 9.80665j - by_teeth(made, q, drive)
    close(bearing, known)
    arm = 30.0 * math.sin(math.atan(0.2))
    close(drive, -1e4 * np.cos(3.0 * q) + arm * np.abs(bearing))
    assert found.apart < 1e-9
