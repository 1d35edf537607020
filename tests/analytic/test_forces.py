"""Forces of cams obey virtual work, keep the balance of power, and agree with closed forms."""

from __future__ import annotations

import math
from functools import cache
from typing import Any

import numpy as np
import pytest

import gearcam as gc
from gearcam.kinds.under_load import UnderLoad, loads_of
from gearcam.mechanics.follower_loads import Loads
from gearcam.mechanics.statics import Statics
from gearcam.mechanics.supports import StraightGuide
from helpers_sampling import few

CAM = """
kind = "cam"
name = "held"
motion = [
    { type = "rise", angle_deg = 120, law = "LAW", lift_mm = 12 },
    { type = "dwell", angle_deg = 40 },
    { type = "return", angle_deg = 130, law = "LAW" },
    { type = "dwell", angle_deg = "rest" },
]
follower = { FOLLOWER }
cam = { prime_radius_mm = 40 }
"""

ROLLER = 'type = "roller", roller_radius_mm = 9, offset_mm = 5'
FLAT = 'type = "flat"'
KNIFE = 'type = "point"'
SWINGS = 'motion = "oscillating", pivot_distance_mm = 70'
ARM = f'type = "roller", roller_radius_mm = 9, arm_mm = 62, {SWINGS}'
SWUNG = f'type = "flat", {SWINGS}'

FRICTION = {
    "friction.joint": 0.1,
    "friction.guide": 0.12,
    "friction.roller": 0.15,
    "friction.flank": 0.1,
    "friction.journal_radius_mm": [8, 4],
    "friction.guide_length_mm": 50,
}

PROFILES = (
    "plate_cam_offset_roller", "plate_cam_oscillating", "groove_cam", "conjugate_cams", "yoke_cam",
    "flat_follower", "tappet", "translating_cam", "eccentric_cam", "valve_lever",
)  # fmt: skip


def held(follower: str, law: str = "3-4-5", /, **changes: Any) -> Any:
    text = CAM.replace("FOLLOWER", follower).replace("LAW", law)
    if "oscillating" in follower:
        text = text.replace("lift_mm = 12", "lift_deg = 11")
    if "flat" in follower:
        text = text.replace("prime_radius_mm = 40", "base_radius_mm = 40")
    return gc.build(gc.loads(text).with_(changes))


@cache
def profile(name: str) -> Any:
    return gc.load(f"profiles/{name}.toml")


def loaded(name: str, **friction: float) -> Any:
    """A profile that works against a force or torque that changes over its lift."""
    design = profile(name)
    swings = design.follower.oscillating
    changes = {"load": [{"formula": "2 + 3*s" if swings else "80 + 5*s"}], **friction}
    slides = design.form == "translating"
    return gc.build(design.with_(changes | {"drive": {f"speed_{'mm_s' if slides else 'rpm'}": 90}}))


def studied(result: Any) -> tuple[Statics, Loads, np.ndarray]:
    under = UnderLoad(result)
    x, way = under.to_and_fro(under.places())
    return under.statics(x, way), under.loads, x


@pytest.mark.parametrize("name", PROFILES)
def test_without_friction_the_driver_does_the_virtual_work(name: str) -> None:
    found, _, _ = studied(loaded(name))
    assert not found.lifted.any()
    assert found.torque == pytest.approx(found.useful, abs=1e-10 * abs(found.useful).max())


@pytest.mark.parametrize("name", few(PROFILES))
def test_power_in_is_power_out_and_losses(name: str) -> None:
    found, _, _ = studied(loaded(name, **FRICTION))
    moved = found.carrying >= 0
    assert moved.mean() > 0.95
    out = found.useful + sum(found.lost.values())
    assert found.torque[moved] == pytest.approx(out[moved], abs=1e-9 * abs(out[moved]).max())
    assert all((values[moved] >= 0.0).all() for values in found.lost.values())
    assert sum(values[moved].sum() for values in found.lost.values()) > 0.0


@pytest.mark.parametrize("name", few(PROFILES, 3))
def test_efficiencies_lie_between_0_and_1(name: str) -> None:
    found, _, _ = studied(loaded(name, **FRICTION))
    told = found.efficiency[np.isfinite(found.efficiency)]
    assert told.size > 50
    assert ((told > 0.0) & (told < 1.0)).all()


@pytest.mark.parametrize(("at", "length"), [(60.0, 120.0), (150.0, 30.0)])
def test_a_stem_with_a_roller_by_the_textbook(at: float, length: float) -> None:
    """000 eqs. (3.67) and (3.69): both cases of the guide."""
    friction = {"guide": 0.15, "guide_length_mm": length, "guide_at_mm": at}
    result = held(ROLLER, friction=friction, load=[{"force_n": 200}])
    found, _, x = studied(result)
    motion = result.motion(x)
    alpha = np.radians(np.abs(motion["pressure_angle_deg"]))
    sense = np.sign(motion["velocity_mm_per_rad"])
    height = math.sqrt(40.0**2 - 5.0**2) + motion["lift_mm"]
    # the contact is below the centre, on the normal: the arm of the force is that of the centre
    arm = np.abs(at - height)
    tipping = arm > 0.5 * length
    assert tipping.all() if length < 100 else not tipping.any()
    mu = 0.15 * np.where(tipping, 2.0 * arm / length, 1.0)
    expected = 200.0 / (np.cos(alpha) * (1.0 - sense * mu * np.tan(alpha)))
    moving = np.abs(motion["velocity_mm_per_rad"]) > 1e-6
    assert found.force[moving] == pytest.approx(expected[moving], rel=1e-9)


def test_a_flat_face_by_the_textbook() -> None:
    """000 eq. (3.109)."""
    friction = {"guide": 0.15, "guide_length_mm": 60}
    result = held(FLAT, friction=friction, load=[{"force_n": 200}])
    found, _, x = studied(result)
    velocity = result.motion(x)["velocity_mm_per_rad"]
    moving = np.abs(velocity) > 1e-6
    expected = 200.0 / (1.0 - 2.0 * 0.15 * velocity / 60.0)
    assert found.force[moving] == pytest.approx(expected[moving], rel=1e-9)
    assert found.reactions["guide_n"] == pytest.approx(0.0, abs=1e-9)
    assert found.reactions["guide_moment_nmm"] == pytest.approx(-found.force * velocity, abs=1e-7)


def test_an_arm_on_its_pin() -> None:
    """The moment of the normal force less that of the circle of friction is the load's."""
    friction = {"joint": 0.2, "journal_radius_mm": [9, 1]}
    result = held(ARM, friction=friction, load=[{"torque_nm": 3.0}])
    found, _, x = studied(result)
    motion = result.motion(x)
    alpha = np.radians(motion["pressure_angle_deg"])
    circle = 9.0 * math.sin(math.atan(0.2))
    sense = np.sign(motion["velocity_deg_per_rad"])
    moving = np.abs(motion["velocity_deg_per_rad"]) > 1e-6
    expected = 3000.0 / (62.0 * np.cos(alpha) - sense * circle)
    assert found.force[moving] == pytest.approx(expected[moving], rel=1e-9)
    assert found.reactions["pivot_n"] == pytest.approx(found.force, rel=1e-12)


@pytest.mark.parametrize("follower", [ROLLER, KNIFE])
def test_a_stem_locks_at_the_angle_of_the_textbook(follower: str) -> None:
    """000 eq. (3.82): ``tan(alpha + phi) = 1/mu``, here of a guide that does not tip."""
    steep = follower.replace("offset_mm = 5", "offset_mm = 0")
    mu = 0.6
    friction = {"guide": mu, "guide_length_mm": 2000, "guide_at_mm": 50, "flank": 0.3}
    small = {"cam.prime_radius_mm": 10, "follower.roller_radius_mm": 2} if "roller" in steep else {}
    small |= {"cam.prime_radius_mm": 10}
    text = CAM.replace("FOLLOWER", steep).replace("LAW", "3-4-5")
    text = text.replace("lift_mm = 12", "lift_mm = 60")
    design = gc.loads(text).with_({**small, "friction": friction, "load": [{"force_n": 10}]})
    result = gc.build(design)
    found, _, x = studied(result)
    motion = result.motion(x)
    alpha = np.radians(motion["pressure_angle_deg"])
    phi = 0.0 if "roller" in follower else math.atan(0.3)
    rising = motion["velocity_mm_per_rad"] > 1e-9
    expected = rising & (np.tan(alpha + phi) >= 1.0 / mu)
    expected |= rising & (alpha + phi >= 0.5 * math.pi)
    assert 0 < expected.sum() < rising.sum()
    certain = np.abs(found.reserve) > 2e-6  # at the limit forces are a million times the load
    assert certain.mean() > 0.95
    assert (found.locked == expected)[certain].all()


def test_the_spring_of_a_harmonic_motion_by_its_closed_form() -> None:
    """``m*h/2*(pi*w/beta)^2`` at the top, where the stiffness gives its share."""
    speed, mass, stiffness = 1800.0 * math.pi / 30.0, 0.4, 8.0
    changes = {
        "mass": [{"mass_kg": mass}],
        "spring": [{"stiffness_n_mm": stiffness, "preload_n": "solve"}],
        "drive": {"speed_rpm": 1800},
    }
    result = held(ROLLER, "harmonic", **changes)
    loads = loads_of(result)
    rate = math.pi / math.radians(120.0) * speed
    inertia = 1e-3 * mass * 6.0 * rate**2
    assert loads.solved["preload"] == pytest.approx(inertia - stiffness * 12.0, rel=1e-9)
    # with the solved preload it lets go at that very speed
    assert loads.release is not None
    assert loads.release[0] == pytest.approx(speed, rel=1e-9)
    changes["spring"] = [{"stiffness_n_mm": "solve", "preload_n": 100}]
    assert loads_of(held(ROLLER, "harmonic", **changes)).solved["stiffness"] == pytest.approx(
        (inertia - 100.0) / 12.0, rel=1e-9
    )


@pytest.mark.parametrize("law", ["cycloidal", "3-4-5", "modified-sine"])
def test_a_solved_spring_just_holds(law: str) -> None:
    spring = [{"stiffness_n_mm": 3.0, "preload_n": "solve"}]
    changes = {"mass": [{"mass_kg": 0.4}], "drive": {"speed_rpm": 900}, "spring": spring}
    found, loads, _ = studied(held(ROLLER, law, **changes))
    assert not found.lifted.any()
    assert 0.0 <= np.nanmin(found.force) < 1e-3 * np.nanmax(found.force)
    spring[0]["preload_n"] = 0.999 * loads.solved["preload"]
    assert studied(held(ROLLER, law, **changes))[0].lifted.any()


RUBS = {"friction.guide": 0.8, "friction.guide_length_mm": 50}


def test_the_spring_of_a_stem_that_rubs_by_its_closed_form() -> None:
    """The weight of a stem across its guide holds it up on a return, by ``mu*m*g``."""
    rpm, mass, stiffness = 700.0, 3.0, 8.0
    changes: dict[str, Any] = {
        "mass": [{"mass_kg": mass}],
        "gravity": {"direction_deg": 0},
        "spring": [{"stiffness_n_mm": stiffness, "preload_n": "solve"}],
        "drive": {"speed_rpm": rpm},
        **RUBS,
    }
    loads = loads_of(held(ROLLER, "harmonic", **changes))
    inertia = 6e-3 * mass * (math.pi / math.radians(130.0) * rpm * math.pi / 30.0) ** 2
    drag = 0.8 * mass * 9.80665
    assert loads.solved["preload"] == pytest.approx(inertia - stiffness * 12.0 + drag, rel=1e-6)
    assert loads.release is not None
    assert loads.release[0] == pytest.approx(rpm * math.pi / 30.0, rel=1e-6)
    assert loads.release[1] == pytest.approx(math.radians(160.0), abs=1e-6)
    changes["spring"] = [{"stiffness_n_mm": "solve", "preload_n": 100}]
    found = loads_of(held(ROLLER, "harmonic", **changes)).solved["stiffness"]
    assert found == pytest.approx((inertia - 100.0 + drag) / 12.0, rel=1e-6)
    # slowly, without a stiffness, it is the end of the return that needs it
    changes["drive"] = {"speed_rpm": 1}
    changes["spring"] = [{"stiffness_n_mm": 0, "preload_n": "solve"}]
    slow = loads_of(held(ROLLER, "harmonic", **changes)).solved["preload"]
    assert slow == pytest.approx(drag + inertia / rpm**2, rel=1e-6)


@pytest.mark.parametrize("pull", [-90.0, 20.0])
@pytest.mark.parametrize("law", ["cycloidal", "3-4-5"])
def test_the_release_of_an_arm_that_rubs_by_its_balance_of_moments(law: str, pull: float) -> None:
    """Moments about the pivot at many places, with accelerations by differences."""
    mass, inertia, preload = 2.5, 0.004, 1.8
    arm = {"mass_kg": mass, "inertia_kg_m2": inertia, "center_mm": 25}
    changes = {"mass": [arm], "gravity": {"direction_deg": pull}, "drive": {"speed_rpm": 60}}
    pin = {"friction.joint": 0.4, "friction.journal_radius_mm": [14, 1]}
    spring = [{"preload_nm": preload, "stiffness_nm_rad": 2}]
    result = held(ARM, law, **changes, **pin, spring=spring)
    program, start = result.program, result.follower.start
    x = (np.arange(60000) + 0.5) / 60000 * 2.0 * math.pi
    s, ds, d2s = program.derivatives(x, 2)

    def centre(x: np.ndarray) -> np.ndarray:
        return -25.0 * np.exp(-1j * (start + program.derivatives(x, 0)[0]))

    step = 1e-4
    hurry = 1e-3 * mass * (centre(x + step) - 2.0 * centre(x) + centre(x - step)) / step**2
    weight = mass * 9.80665 * np.exp(1j * math.radians(pull))
    # a rise turns the arm clockwise: its weight is against it where it turns it back
    against = 1e3 * preload + 2e3 * s + (np.conj(centre(x)) * weight).imag
    sense = np.where(np.abs(ds) < 1e-9, 0.0, np.sign(ds))
    circle = 14.0 * math.sin(math.atan(0.4))

    def holds(speed: float) -> bool:
        moment = against + 1e3 * inertia * speed**2 * d2s
        return bool((moment + sense * circle * np.abs(weight - speed**2 * hurry) >= 0.0).all())

    low, high = 0.0, 1e4
    assert holds(low)
    for _ in range(60):
        middle = 0.5 * (low + high)
        low, high = (middle, high) if holds(middle) else (low, middle)
    loads = loads_of(result)
    assert loads.release is not None
    assert loads.release[0] == pytest.approx(low, rel=1e-5)
    # and the preload that is just enough at a higher speed
    design = result.design.with_({"drive.speed_rpm": 1.3 * low * 30.0 / math.pi})
    against -= 1e3 * preload
    square = (1.3 * low) ** 2
    needed = against + 1e3 * inertia * square * d2s
    needed += sense * circle * np.abs(weight - square * hurry)
    solved = loads_of(gc.build(design.with_({"spring[0].preload_nm": "solve"}))).solved
    assert solved["preload"] == pytest.approx(-needed.min(), rel=1e-5)
    lack = loads_of(gc.build(design)).lack
    assert lack == pytest.approx(-needed.min() - 1e3 * preload, rel=1e-4)


@pytest.mark.parametrize("follower", [ROLLER, ARM, SWUNG])
def test_a_solved_spring_just_holds_a_follower_that_rubs(follower: str) -> None:
    swings = "oscillating" in follower
    mass = {"mass_kg": 3.0} | ({"inertia_kg_m2": 0.004, "center_mm": 40} if swings else {})
    key = "preload_nm" if swings else "preload_n"
    changes: dict[str, Any] = {
        "mass": [mass], "drive": {"speed_rpm": 200}, "gravity": {"direction_deg": 15}, **FRICTION,
    }  # fmt: skip
    found, loads, _ = studied(held(follower, "harmonic", **changes, spring=[{key: "solve"}]))
    assert not found.lifted.any()
    scale = 1e-3 if swings else 1.0
    less = [{key: 0.999 * scale * loads.solved["preload"]}]
    assert studied(held(follower, "harmonic", **changes, spring=less))[0].lifted.any()


def test_no_speed_is_named_where_the_lowest_lift_the_follower_off() -> None:
    """A load that pulls it off as a rise begins, where a fast cam presses the follower on."""
    spring = [{"stiffness_n_mm": 20, "preload_n": 40}]
    changes: dict[str, Any] = {"mass": [{"mass_kg": 0.4}], "spring": spring}
    pulled = [{"force_n": -41, "from_deg": 0.5, "to_deg": 3}]
    for load, drive, off in ((-41, 5, True), (-41, 600, False), (-39, 600, None)):
        pulled[0]["force_n"] = load
        result = held(ROLLER, "harmonic", load=pulled, drive={"speed_rpm": drive}, **changes)
        found = result.study("forces")
        # held at rest by 40 - 41 N and 20 N/mm times a lift of at most 0.02 mm
        inertia = 0.4e-3 * 6.0 * (1.5 * drive * math.pi / 30.0) ** 2
        lifted = inertia + load + 40.0 < 0.0
        assert found.facts["forces.lifted"] == lifted == bool(off)
        messages = [one.message for one in found.study_findings if one.code == "lift-off"]
        assert any("lowest speeds" in one for one in messages) == (off is not None)
        assert not any("up to" in one for one in messages)
        if off is None:
            assert "lifted_at_rest" not in found.group
            assert found.facts["forces.release_speed_rpm"] > 600
        else:
            assert found.facts["forces.lifted_at_rest"] is True
            assert "forces.release_speed_rpm" not in found.facts


def test_a_follower_without_a_load_is_off_at_any_speed() -> None:
    changes = {"mass": [{"mass_kg": 0.4}], "drive": {"speed_rpm": 5}}
    group = held(ROLLER, "harmonic", **changes).study("forces").group
    assert group["lifted_at_rest"].value is True
    assert "release_speed_rpm" not in group


def lift_at(result: Any, degrees: float) -> float:
    return float(result.program.derivatives(np.radians([degrees]), 0)[0][0])


@pytest.mark.parametrize("follower", [ROLLER, ARM])
@pytest.mark.parametrize("steps", [12, 720])
def test_a_load_between_two_angles_is_seen_at_its_ends(follower: str, steps: int) -> None:
    swings = "oscillating" in follower
    key, size = ("torque_nm", 18.0) if swings else ("force_n", 300.0)
    ends = [50.1234, 50.1334]
    load = {key: size, "from_deg": ends[0], "to_deg": ends[1]}
    result = held(follower, load=[load], forces={"steps": steps})
    alpha = np.radians(result.motion(np.radians(ends))["pressure_angle_deg"])
    force = 1e3 * size / 62.0 if swings else size
    most = (force / np.cos(alpha)).max()
    group = result.study("forces").group
    assert group["normal_n"].value["max"] == pytest.approx(most, rel=1e-9)


@pytest.mark.parametrize("steps", [12, 720])
def test_a_table_of_loads_is_seen_at_its_places(steps: int) -> None:
    table = {"table": [0, 300, 0, 0], "at_deg": [0, 77.777, 77.9, 360]}
    result = held(ROLLER, load=[table], forces={"steps": steps})
    alpha = np.radians(result.motion(np.radians([77.777]))["pressure_angle_deg"])
    group = result.study("forces").group
    expected = 300.0 / math.cos(alpha[0])
    assert group["normal_n"].value["max"] == pytest.approx(expected, rel=1e-9)


def test_the_spring_is_solved_for_loads_that_jump() -> None:
    """The load is extreme as it ends, as it begins, and as another that presses has ended."""
    drive = {"speed_rpm": 60}
    spring = [{"preload_n": "solve"}]
    rising = {"formula": "-s", "from_deg": 20, "to_deg": 70.1234}
    falling = {"formula": "s - 12", "from_deg": 20.4321, "to_deg": 120}
    pressing = {"force_n": 100, "from_deg": 0, "to_deg": 70.1234}
    for load, place, sign in (
        ([rising], 70.1234, -1.0),
        ([falling], 20.4321, 1.0),
        ([falling, pressing], 70.1234, 1.0),
    ):
        result = held(ROLLER, load=load, drive=drive, spring=spring)
        lift = lift_at(result, place)
        needed = lift if sign < 0.0 else 12.0 - lift
        assert loads_of(result).solved["preload"] == pytest.approx(needed, rel=1e-9)
        assert not result.study("forces").facts["forces.lifted"]
    short = [{"force_n": -30, "from_deg": 50.1234, "to_deg": 50.1235}]
    result = held(ROLLER, load=short, drive=drive, spring=spring)
    assert loads_of(result).solved["preload"] == pytest.approx(30.0, rel=1e-12)


def test_a_table_of_loads_may_jump() -> None:
    table = {"table": [-5, -5, -25, -5, -5], "at_deg": [0, 33.333, 33.3331, 33.3331, 360]}
    changes = {"drive": {"speed_rpm": 60}, "spring": [{"preload_n": "solve"}]}
    result = held(ROLLER, load=[table], **changes)
    assert loads_of(result).solved["preload"] == pytest.approx(25.0, rel=1e-9)
    assert not result.study("forces").facts["forces.lifted"]


def test_gravity_weighs_a_follower() -> None:
    """A stem that stands weighs m*g; an arm at an angle the moment of its centre of mass."""
    changes = {"mass": [{"mass_kg": 2.0}], "gravity": {"direction_deg": -90}}
    found, _, _ = studied(held(ROLLER, **changes))
    assert found.against == pytest.approx(2.0 * 9.80665)
    arm = {"mass": [{"mass_kg": 2.0, "inertia_kg_m2": 0.01, "center_mm": 30}]}
    result = held(ARM, **(changes | arm))
    found, loads, x = studied(result)
    p = result.follower.start + loads.motion(x).s
    assert found.against == pytest.approx(2.0 * 9.80665 * 30.0 * np.cos(p))


@pytest.mark.parametrize("follower", [ROLLER, ARM, SWUNG, FLAT])
def test_weight_and_inertia_load_the_support_and_its_friction(follower: str) -> None:
    """A closed solution still balances if other forces press on guide or pivot."""
    mass: dict[str, float] = {"mass_kg": 1.5}
    mass |= {"inertia_kg_m2": 0.004, "center_mm": 40} if "oscillating" in follower else {}
    changes = {"mass": [mass], "gravity": {"direction_deg": -40}, "drive": {"speed_rpm": 60}}
    spring = {"preload_nm": 9.0} if "oscillating" in follower else {"preload_n": 90.0}
    found, _, _ = studied(held(follower, **changes, **FRICTION, spring=[spring]))
    assert not found.lifted.any()
    assert not found.locked.any()
    out = found.useful + sum(found.lost.values())
    assert found.torque == pytest.approx(out, abs=1e-9 * abs(out).max())


@pytest.mark.parametrize("name", ["groove_cam", "conjugate_cams", "yoke_cam"])
def test_the_sign_of_the_load_tells_the_wall_that_carries(name: str) -> None:
    result = gc.build(profile(name).with_({"load": [{"formula": "100*cos(theta)"}]}))
    found, _, _ = studied(result)
    assert set(found.carrying) == {0, 1}
    assert ((found.against > 0.0) == (found.carrying == 0)).all()
    assert (found.force >= 0.0).all()


def balanced(
    pushed: list[Any], total_load: tuple[float, complex, float], support: Any, friction: Any
) -> tuple[int, float]:
    """The touch and its normal force, by bisection of the balance of forces at one place.

    `pushed` holds point of contact and unit force of each touch; `total_load` load, force on the
    support, sign of the velocity.
    """
    made, (against, resultant, sense) = [], total_load
    for number, (at, unit) in enumerate(pushed):

        def left(force: float, at: complex = at, unit: complex = unit) -> float:
            press = force * unit + resultant
            if isinstance(support, StraightGuide):
                along = (force * unit * np.conj(support.direction)).real
                across = abs((press * np.conj(1j * support.direction)).real)
                tip = abs((np.conj(at - support.middle) * unit).imag * force)
                drag = friction.guide * max(across, 2.0 * tip / friction.guide_length)
            else:
                along = (np.conj(at - support.at) * force * unit).imag * support.spin
                drag = friction.journal * math.sin(math.atan(friction.joint)) * abs(press)
            return along - against - sense * drag

        ends = 0.0, 1e7
        if left(0.0) * left(ends[1]) <= 0.0:
            for _ in range(100):
                middle = 0.5 * sum(ends)
                same = left(middle) * left(ends[1]) > 0.0
                ends = (ends[0], middle) if same else (middle, ends[1])
            made.append((number, ends[0]))
    assert len(made) == 1
    return made[0]


@pytest.mark.parametrize("follower", [ROLLER, ARM])
@pytest.mark.parametrize("pull", [-8.0, 170.0])
def test_the_wall_that_carries_has_a_positive_force_with_friction(
    follower: str, pull: float
) -> None:
    """A heavy follower, whose weight rubs in its support, against a small load of both signs."""
    mass = {"mass_kg": 20.0}
    load = [{"formula": "60*cos(3*theta)"}]
    if "oscillating" in follower:
        mass |= {"inertia_kg_m2": 0.04, "center_mm": 1}
        load = [{"formula": "0.3*cos(3*theta)"}]
    groove = {"cam.form": "groove", "cam.outer_diameter_mm": 160, "cam.groove_depth_mm": 5}
    changes = {"mass": [mass], "gravity": {"direction_deg": pull}, "drive": {"speed_rpm": 6}}
    friction = {**FRICTION, "friction.journal_radius_mm": [12, 4], "friction.joint": 0.2}
    result = held(follower, load=load, **groove, **changes, **friction)
    found, loads, x = studied(result)
    motion = loads.motion(x)
    total_load, given = loads.total_load(motion), result.design.friction
    share = result.design.follower.dragged(given, result.follower.radius)
    pushes = [touch.push(motion, loads.support, share)[0] for touch in result.cam.touches]
    assert not found.lifted.any()
    assert not found.locked.any()
    assert set(found.carrying) == {0, 1}
    for k in range(0, len(x), 7):
        pushed = [(one.at[k], one.unit[k]) for one in pushes]
        here = (total_load.against[k], total_load.resultant[k], total_load.sense[k])
        number, force = balanced(pushed, here, loads.support, given)
        assert found.force[k] == pytest.approx(force, rel=1e-9, abs=1e-6)
        assert force < 1e-6 or found.carrying[k] == number


def test_the_pivot_by_the_law_of_newton() -> None:
    """Its force, that of the cam and the weight accelerate the centre of mass, by differences."""
    mass, speed = 1.5, 60 * math.pi / 30
    arm = {"mass_kg": mass, "inertia_kg_m2": 0.004, "center_mm": 40}
    changes = {"mass": [arm], "gravity": {"direction_deg": -40}, "drive": {"speed_rpm": 60}}
    result = held(ARM, "cycloidal", **changes, spring=[{"preload_nm": 9}], **FRICTION)
    found, _, x = studied(result)
    program, start = result.program, result.follower.start

    def centre(x: np.ndarray) -> np.ndarray:  # the arm points from (70, 0) towards the cam
        return 70.0 - 40.0 * np.exp(-1j * (start + program.derivatives(x, 0)[0]))

    step, inside = 1e-4, (x > 0.1) & (x < 2.0)
    x = x[inside]
    second = (centre(x + step) - 2.0 * centre(x) + centre(x - step)) / step**2
    weight = mass * 9.80665 * np.exp(-1j * math.radians(40.0))
    pivot = found.reactions["pivot_x_n"] + 1j * found.reactions["pivot_y_n"]
    forces = pivot + found.bearing + weight
    needed = 1e-3 * mass * speed**2 * second
    assert np.abs(needed).max() > 0.05
    assert np.abs(forces[inside] - needed).max() < 1e-4 * np.abs(needed).max()


def test_a_mirrored_cam_has_the_same_forces() -> None:
    changes = {"load": [{"force_n": 50}], **FRICTION}
    one, other = (
        gc.build(held(ROLLER, **changes, **{"cam.rotation": way}).design) for way in ("ccw", "cw")
    )
    first, second = (one.study("forces").columns, other.study("forces").columns)
    for name, values in first.items():
        sign = (
            -1.0 if name in ("guide_n", "guide_moment_nmm", "guide_low_n", "guide_high_n") else 1.0
        )
        assert values == pytest.approx(sign * second[name], nan_ok=True)


PLATE = """
kind = "cam"
name = "plate"
motion = [
    { type = "rise", travel_mm = 60, law = "LAW", lift_mm = 15 },
    { type = "dwell", travel_mm = 30 },
    { type = "return", travel_mm = 40, law = "LAW" },
]
follower = { type = "roller", roller_radius_mm = 6 }
cam = { form = "translating", walls = "WALLS", run_in_mm = 20, run_out_mm = 10, thickness_mm = 12 }
blank = { height_mm = 60 }
output = { studies = ["forces"] }
"""


def plate(law: str, walls: str = "lower", /, **changes: Any) -> Any:
    return gc.build(gc.loads(PLATE.replace("LAW", law).replace("WALLS", walls)).with_(changes))


def test_a_plate_presses_hardest_on_its_steeper_way() -> None:
    """Ramps of 15 mm in 60 and in 40 mm: the second lifts as the plate comes back."""
    mu = 0.2
    friction = {"guide": mu, "guide_length_mm": 400, "guide_at_mm": 30, "roller": 0.15}
    friction |= {"journal_radius_mm": [8, 3]}
    result = plate("constant-velocity", friction=friction, load=[{"force_n": 200}])
    found = result.study("forces")
    # all friction of the roller acts at its circumference
    phi = math.atan(result.design.friction.rolling(6.0))

    def force(rise: float, run: float, sense: float) -> float:
        alpha = math.atan(rise / run) + sense * phi
        # the normal force, of the whole force 1/cos(phi) times as large
        return 200.0 * math.cos(phi) / (math.cos(alpha) - sense * mu * math.sin(alpha))

    columns = found.columns
    travel, way, normal = (columns[one] for one in ("travel_mm", "direction", "normal_n"))
    for low, high, run, sense in ((21, 79, 60, 1), (111, 149, 40, -1)):
        inside = (low < travel) & (travel < high)
        for one in (1, -1):
            expected = force(15, run, one * sense)
            assert normal[inside & (way == one)] == pytest.approx(expected, rel=1e-9)
    assert found.facts["forces.normal_n.max"] == pytest.approx(force(15, 40, 1), rel=1e-9)
    assert force(15, 40, 1) > 1.05 * force(15, 60, 1)
    assert "on the way back" in found.group["normal_n"].place
    # where the velocity falls at once the plate has corners, of which nothing is said
    most = found.facts["forces.pressure_off_edges_mpa"]
    assert most == pytest.approx(float(np.nanmax(columns["pressure_mpa"][way == -1])))
    chart = found.charts["normal"]
    assert [one.label for one in chart.lines] == ["normal force, forward", "normal force, back"]
    (colours,) = result.scene(90).coloured
    assert np.nanmax(colours.values["normal force, N"]) == pytest.approx(force(15, 40, 1))


@pytest.mark.parametrize("walls", ["lower", "both"])
def test_the_way_back_is_the_way_forward_over_the_mirrored_plate(walls: str) -> None:
    changes: dict[str, Any] = {
        "mass": [{"mass_kg": 2.0}], "gravity": {"direction_deg": -90},
        "drive": {"speed_mm_s": 300}, **FRICTION,
        "spring": [{"stiffness_n_mm": 2, "preload_n": 60}],
        "load": [{"force_n": 40, "against": True}],
    }  # fmt: skip
    one = plate("3-4-5", walls, **changes).study("forces")
    mirrored = [
        {"type": "rise", "travel_mm": 40, "law": "3-4-5", "lift_mm": 15},
        {"type": "dwell", "travel_mm": 30},
        {"type": "return", "travel_mm": 60, "law": "3-4-5"},
    ]
    runs = {"cam.run_in_mm": 10, "cam.run_out_mm": 20}
    other = plate("3-4-5", walls, motion=mirrored, **runs, **changes).study("forces")
    for way in (1, -1):
        mine, there = (
            {name: np.ma.filled(values, np.nan)[study.columns["direction"] == sign]
             for name, values in study.columns.items()}
            for study, sign in ((one, way), (other, -way))
        )  # fmt: skip
        for name in ("normal_n", "drive_n", "bearing_n", "power_w", "losses_w", "wall", "load_n"):
            at = 160.0 - there["travel_mm"]
            expected = np.interp(mine["travel_mm"], at[::way], there[name][::way])
            inner = np.min(np.abs(mine["travel_mm"] - np.array([[20, 80, 110, 150]]).T), axis=0) > 1
            scale = np.nanmax(np.abs(expected))
            assert mine[name][inner] == pytest.approx(expected[inner], abs=2e-3 * scale)


def test_a_solved_spring_holds_a_plate_on_both_ways() -> None:
    """With a weight across the guide both ways have returns: the harder of them counts."""
    changes: dict[str, Any] = {
        "mass": [{"mass_kg": 3.0}], "drive": {"speed_mm_s": 400}, "gravity": {"direction_deg": 0},
        "friction": {"guide": 0.6, "guide_length_mm": 50}, "spring": [{"preload_n": "solve"}],
    }  # fmt: skip
    result = plate("harmonic", **changes)
    loads = loads_of(result)
    # the steeper ramp is a return forward: at its top inertia and friction lift the follower
    top = 3e-3 * 7.5 * (math.pi / 40.0 * 400.0) ** 2 + 0.6 * 3.0 * 9.80665
    assert loads.solved["preload"] == pytest.approx(top, rel=1e-6)
    motion = [
        {"type": "rise", "travel_mm": 40, "law": "harmonic", "lift_mm": 15},
        {"type": "dwell", "travel_mm": 30},
        {"type": "return", "travel_mm": 60, "law": "harmonic"},
    ]
    back = plate("harmonic", motion=motion, **changes)
    assert loads_of(back).solved["preload"] == pytest.approx(top, rel=1e-6)
    release = back.study("forces").group["release_speed_mm_s"]
    assert release.value == pytest.approx(400.0, rel=1e-6)
    assert release.place.endswith("on the way back")
    assert not back.study("forces").facts["forces.lifted"]


def test_forces_at_the_ends_of_a_phase_are_those_within() -> None:
    """Where the pressure angle is 0: the spring, and the weight that rubs in the guide."""
    weight = {"mass": [{"mass_kg": 3.0}], "gravity": {"direction_deg": 0}}
    friction = {"guide": 0.3, "guide_length_mm": 50}
    spring = [{"preload_n": 100}]
    columns = plate("cycloidal", **weight, friction=friction, spring=spring).study("forces").columns
    travel, way = columns["travel_mm"], columns["direction"]
    drag = 0.3 * 3.0 * 9.80665
    for low, high, lifts in ((20.0, 80.0, 1), (110.0, 150.0, -1)):
        for one in (1, -1):
            rows = np.flatnonzero((low <= travel) & (travel < high) & (way == one))
            ends = columns["normal_n"][rows[[0, -1]]]
            assert ends == pytest.approx(100.0 + one * lifts * drag, rel=1e-9)
            before, after = rows[0] - 1, rows[-1] + 1
            assert columns["normal_n"][[before, after]] == pytest.approx(100.0, rel=1e-9)
