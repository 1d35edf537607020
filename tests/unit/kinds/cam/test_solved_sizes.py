"""Sizes that are solved for: against another optimiser, random tries, and the checks themselves."""

from __future__ import annotations

import math
import re
from collections.abc import Mapping
from itertools import pairwise
from pathlib import Path
from typing import Any

import numpy as np
import pytest

import gearcam as gc
from gearcam.base.errors import DesignError, InfeasibleError
from gearcam.cli import main
from gearcam.designs.writing import toml_text
from gearcam.kinds.cam.solve import Task, solved
from gearcam.laws.motion import MOTION_LAWS
from helpers_built import built
from helpers_sampling import chosen, few
from random_designs.cam import motion_by_phases, motion_of_turn
from random_designs.draw import Draw

THETA = np.linspace(0.0, 2.0 * math.pi, 721)[:-1] + 1e-9
PROGRAMS: dict[str, tuple[tuple[float, float, float], str, str, float]] = {
    "cycloidal": ((100, 80, 80), "cycloidal", "cycloidal", 20.0),
    "modified sine": ((120, 30, 150), "modified-sine", "modified-sine", 12.0),
    "polynomial": ((60, 40, 90), "3-4-5", "cycloidal", 6.0),
    "no dwell": ((180, 0, 180), "cycloidal", "3-4-5", 25.0),
    "quick return": ((200, 60, 60), "modified-sine", "3-4-5", 8.0),
}


def motion(name: str, *, swing: bool = False) -> list[dict[str, Any]]:
    (up, dwell, down), rise, back, lift = PROGRAMS[name]
    size = {"lift_deg": 1.2 * lift} if swing else {"lift_mm": lift}
    phases: list[dict[str, Any]] = [{"type": "rise", "angle_deg": up, "law": rise, **size}]
    phases += [{"type": "dwell", "angle_deg": dwell}] if dwell else []
    phases.append({"type": "return", "angle_deg": down, "law": back})
    rest = 360 - up - dwell - down
    return phases + ([{"type": "dwell", "angle_deg": "rest"}] if rest else [])


def stem(name: str, **tables: Any) -> dict[str, Any]:
    follower = {"type": "roller", "roller_radius_mm": 5, "offset_mm": "solve"}
    cam = {"prime_radius_mm": "solve"}
    return {
        "kind": "cam",
        "name": "c",
        "motion": motion(name),
        "follower": follower,
        "cam": cam,
    } | tables


def arm(name: str, **tables: Any) -> dict[str, Any]:
    follower = {
        "type": "roller", "motion": "oscillating", "roller_radius_mm": 5, "arm_mm": 70,
        "pivot_distance_mm": "solve",
    }  # fmt: skip
    cam = {"prime_radius_mm": "solve"}
    return {
        "kind": "cam",
        "name": "c",
        "motion": motion(name, swing=True),
        "follower": follower,
        "cam": cam,
    } | tables


def witness(result: Any, sizes: Mapping[str, float]) -> tuple[float, float]:
    """Return size and largest excess of a cam, from its pitch curve as a curve of dense points."""
    follower = result.design.follower
    s = result.program.derivatives(THETA, 0)[0]
    prime, roller, limit = sizes["prime"], follower.roller_radius, math.radians(30.0)
    if follower.oscillating:
        pivot, length, limit = sizes["pivot"], follower.arm, math.radians(45.0)
        cosine = (pivot**2 + length**2 - prime**2) / (2.0 * pivot * length)
        if abs(cosine) >= 1.0:
            return math.inf, 1.0
        angle = math.acos(cosine) + s
        if angle.max() >= math.pi:
            return math.inf, 1.0
        centre, direction = pivot - length * np.exp(-1j * angle), 1j * np.exp(-1j * angle)
    else:
        if abs(sizes["offset"]) >= prime:
            return math.inf, 1.0
        height = math.sqrt(prime**2 - sizes["offset"] ** 2) + s
        centre, direction = sizes["offset"] + 1j * height, np.full(len(s), 1j)
    turned = np.exp(-1j * THETA)
    path = centre * turned
    step = THETA[1] - THETA[0]
    tangent = derivative(path, step)
    normal = 1j * tangent / np.abs(tangent)  # outward of a clockwise curve
    pressure = np.abs(np.angle(normal / (direction * turned)))
    bend = -(derivative(np.unwrap(np.angle(tangent)) + THETA, step) - 1.0) / np.abs(tangent)
    size = float(np.abs(path).max()) - roller
    excess = [
        math.tan(min(pressure.max(), 1.57)) / math.tan(limit) - 1.0,
        float(bend.max()) * (roller + 1.0) - 1.0,
        float(-bend.min()) * (0.15 - roller) - 1.0,
    ]
    if follower.oscillating:
        excess.append(size / sizes["pivot"] - 1.0)
    return size, max(excess)


def derivative(values: np.ndarray, step: float) -> np.ndarray:
    """Return central differences of the fourth order of a periodic function."""
    one, two = (np.roll(values, -k) - np.roll(values, k) for k in (1, 2))
    return (8.0 * one - two) / (12.0 * step)


def evolved(cost: Any, bounds: list[tuple[float, float]]) -> float:
    """Return the least cost found by differential evolution (Storn and Price, 1997)."""
    random = np.random.default_rng(1)
    low, high = np.array(bounds).T
    points = random.uniform(low, high, (20, len(low)))
    costs = np.array([cost(one) for one in points])
    for _ in range(40):
        for k in range(len(points)):
            a, b, c = points[random.permutation(len(points))[:3]]
            tried = np.where(random.random(len(low)) < 0.8, a + 0.7 * (b - c), points[k])
            value = cost(np.clip(tried, low, high))
            if value < costs[k]:
                points[k], costs[k] = np.clip(tried, low, high), value
    return float(costs.min())


CASES = [*((stem, name) for name in PROGRAMS), *((arm, name) for name in PROGRAMS)]


@pytest.mark.slow
@pytest.mark.parametrize(("make", "name"), chosen(CASES, (arm, "polynomial")))
def test_no_other_optimiser_finds_a_smaller_cam(make: Any, name: str) -> None:
    result = built(gc.design(make(name)))
    found = result.solution
    second = "pivot" if make is arm else "offset"
    key = "follower.pivot_distance_mm" if make is arm else "follower.offset_mm"
    own = {"prime": found.sizes["cam.prime_radius_mm"], second: found.sizes[key]}
    size, excess = witness(result, own)
    assert excess < 1e-3  # of dense points
    assert size == pytest.approx(result.facts["cam.profile.radius_mm.max"], rel=1e-6)

    def cost(x: np.ndarray) -> float:
        other, beyond = witness(result, {"prime": x[0], second: x[1]})
        return other + 1e3 * beyond if beyond > 0.0 else other

    around = [(0.5 * own["prime"], 1.6 * own["prime"]), (0.5 * own[second], 1.5 * own[second])]
    if make is stem:
        around[1] = (-own["prime"], own["prime"])
    best = evolved(cost, around)
    assert size * (1.0 - 1e-3) < best < size * (1.0 + 2e-2)


@pytest.mark.parametrize(("make", "name"), few(CASES[::3], 3))
def test_random_tries_find_no_smaller_cam(make: Any, name: str) -> None:
    result = built(gc.design(make(name)))
    task = Task(result)
    random = np.random.default_rng(3)
    count = 10_000
    sizes = {name: np.full(count, value) for name, value in task.known.items()}
    for key, one in task.names.items():
        middle = result.solution.sizes[key]
        reach = abs(result.solution.sizes["cam.prime_radius_mm"])
        sizes[one] = middle + random.uniform(-0.8, 0.8, count) * reach
    found = task.sizing.measured(sizes, coarse=True)
    kept = found.worst <= 0.0
    assert kept.sum() > 50
    size = result.facts["cam.profile.radius_mm.max"]
    smaller = kept & (found.goal < size)  # as far as some places of the lift tell
    exact = task.sizing.measured({name: one[smaller] for name, one in sizes.items()})
    assert not (exact.worst <= 0.0).any()


# program, arm, roller, prime radius, pivot distance, limits of the pressure angle and the profile
KNOWN = [
    ("polynomial", 69.5, 4.06, 60.0, 80.8, 28.835, 37.5352),
    ("polynomial", 93.8, 2.41, 65.9, 115.4, 19.344, 39.8348),
    ("quick return", 101.1, 5.17, 81.1, 148.4, 31.291, 45.5643),
]


@pytest.mark.parametrize("known", few(((one,) for one in KNOWN), 3))
def test_a_cam_that_is_known_to_keep_its_limits_is_not_smaller_than_the_solution(
    known: tuple[str, float, float, float, float, float, float],
) -> None:
    name, length, roller, prime, pivot, angle, convex = known
    document = arm(name, limits={"pressure_angle_deg": angle, "profile_radius_mm": convex})
    document["follower"] |= {"arm_mm": length, "roller_radius_mm": roller}
    sizes = {"cam.prime_radius_mm": prime, "follower.pivot_distance_mm": pivot}
    given = gc.build(gc.design(document).with_(sizes))
    found = gc.build(gc.design(document))
    assert not given.findings
    assert not found.findings
    size = "cam.profile.radius_mm.max"
    assert found.facts[size] <= given.facts[size]


@pytest.mark.parametrize(("make", "name"), few(CASES, 3))
def test_a_solved_cam_has_no_finding_and_decides_by_its_limits(make: Any, name: str) -> None:
    result = built(gc.design(make(name)))
    assert not {one.code for one in result.findings} & {
        "pressure-angle", "jamming", "sharp-profile", "undercut",
    }  # fmt: skip
    assert result.solution.deciding


def test_a_wedge_of_two_pressure_angles_is_the_closed_form() -> None:
    """000, fig. 3.41: s0 >= (s' - e)/tan(a) - s on rises, (e - s')/tan(a) - s on returns."""
    result = built(gc.design(stem("cycloidal")))
    theta = np.linspace(0.0, 2.0 * math.pi, 200_001)
    s, ds = result.program.derivatives(theta, 1)
    slope = math.tan(math.radians(30.0))
    rise = np.max(ds / slope - s)  # s0 + e/tan(a) on its line
    back = np.max(-ds / slope - s)
    height, offset = 0.5 * (rise + back), 0.5 * (rise - back) * slope
    sizes = result.solution.sizes
    assert sizes["follower.offset_mm"] == pytest.approx(offset, abs=2e-5)
    assert sizes["cam.prime_radius_mm"] == pytest.approx(math.hypot(height, offset), abs=2e-5)
    assert result.solution.deciding == (
        "pressure angle on the rise", "pressure angle on the return",
    )  # fmt: skip


def test_a_solved_design_is_a_file_that_builds(tmp_path: Path) -> None:
    document = stem("modified sine", output={"files": ["csv"]})
    result = gc.build(gc.design(document))
    written = result.write(tmp_path)
    assert "solved.toml" in written.files
    file = tmp_path / "c" / "solved.toml"
    again = gc.build(gc.load(file))
    assert again.solution is None
    again.write(tmp_path)  # into a folder of its own
    assert file.exists()
    assert again.design.name == "c_solved"
    assert again.findings == result.findings
    assert again.facts["cam.prime_radius_mm"] == result.facts["cam.prime_radius_mm"]
    assert result.facts["solution.prime_radius_mm"] == result.facts["cam.prime_radius_mm"]


def test_a_roller_is_as_large_as_the_profile_or_half_the_cam_allows() -> None:
    document = stem("cycloidal", cam={"prime_radius_mm": 60})
    document["follower"] = {"type": "roller", "roller_radius_mm": "solve", "offset_mm": 2}
    half = gc.build(gc.design(document))
    assert half.solution.sizes["follower.roller_radius_mm"] == pytest.approx(30.0, abs=1e-5)
    assert half.solution.deciding == ("roller of half the prime radius",)
    document["bounds"] = {"roller_radius_mm": [5, 60]}
    result = gc.build(gc.design(document))
    assert result.facts["cam.curvature.profile_convex_min_mm"] == pytest.approx(1.0, abs=1e-5)


def test_flat_followers_are_solved_for() -> None:
    document = {
        "kind": "cam", "name": "c", "motion": motion("polynomial"), "follower": {"type": "flat"},
        "cam": {"base_radius_mm": "solve"}, "limits": {"profile_radius_mm": 3},
    }  # fmt: skip
    result = gc.build(gc.design(document))
    theta = np.linspace(0.0, 2.0 * math.pi, 400_001)
    s, _, second = result.program.derivatives(theta, 2)
    assert result.facts["cam.base_radius_mm"] == pytest.approx(3.0 - (s + second).min(), abs=1e-5)


def flat(number: int, unit: str = "mm", **follower: Any) -> dict[str, Any]:
    """A flat follower with a random motion."""
    d = Draw(f"flat {number}")
    law, lift = [*MOTION_LAWS][number % len(MOTION_LAWS)], d.log(1, 30)
    phased = d.chance(0.7)
    moved = motion_by_phases(d, law, lift, unit) if phased else motion_of_turn(d, lift, unit)
    return {
        "kind": "cam", "name": "c", "motion": moved, "follower": {"type": "flat"} | follower,
        "cam": {"base_radius_mm": "solve"}, "limits": {"profile_radius_mm": d.pick([0, 1, 5])},
    }  # fmt: skip


def falls(program: Any) -> bool:
    """Whether the velocity falls at once somewhere: every profile is undercut there."""
    return any(jump.after < jump.before for jump in program.hard)


def least_base(program: Any, radius: float) -> float:
    """The closed form: base + s + s'' is the radius of the profile, places on all pieces alike."""
    inside = np.concatenate(
        [np.linspace(low, high, 2003)[1:-1] for low, high in pairwise(program.cuts)]
    )
    s, _, second = program.derivatives(inside, 2)
    at_ends = program.survey.values[[0, 2]][:, :, [0, -1]].sum(axis=0)
    return radius - float(min((s + second).min(), at_ends.min()))


@pytest.mark.slow
@pytest.mark.parametrize(
    "numbers", chosen([range(4), *(range(k, k + 10) for k in range(0, 400, 10))], range(4))
)
def test_base_radii_of_random_flat_followers_are_the_closed_form(numbers: range) -> None:
    met = 0
    for number in numbers:
        document = flat(number)
        result = gc.build(gc.design(document))
        if falls(Task(result).program):
            continue
        found = result.solution
        if not any("default range" in one for one in found.deciding):
            met += 1
            wanted = least_base(result.program, document["limits"]["profile_radius_mm"])
            assert found.sizes["cam.base_radius_mm"] == pytest.approx(wanted, rel=1e-5), number
    assert met > len(numbers) // 5


@pytest.mark.parametrize("number", chosen(range(24), 8))
def test_no_smaller_swinging_flat_cam_keeps_its_limits(number: int) -> None:
    """By the checks of the cams themselves."""
    document = flat(number, "deg", motion="oscillating", pivot_distance_mm=80.0)
    design = gc.design(document)
    result = gc.build(design)
    task = Task(result, advise=False)
    if falls(task.program):
        return

    def keeps(base: float) -> bool:
        return task.keeps(gc.build(design.with_({"cam.base_radius_mm": base})))

    try:
        base = result.solution.sizes["cam.base_radius_mm"]
    except InfeasibleError:
        assert not any(keeps(one) for one in np.geomspace(0.5, 150.0, 40))
        return
    assert keeps(base)
    if not any("default range" in one for one in result.solution.deciding):
        assert not keeps(base * (1.0 - 1e-4))
        assert not any(keeps(one) for one in np.geomspace(0.5, base, 12)[:-1])


def test_the_radius_that_a_flat_cam_can_have_is_named_and_can_be_kept() -> None:
    document = {
        "kind": "cam", "name": "c", "motion": motion("polynomial"), "follower": {"type": "flat"},
        "cam": {"base_radius_mm": "solve"}, "bounds": {"base_radius_mm": [5, 30]},
        "limits": {"profile_radius_mm": 40},
    }  # fmt: skip
    with pytest.raises(InfeasibleError, match="least convex radius of the profile") as caught:
        _ = gc.build(gc.design(document)).solution
    plain = gc.design(document | {"bounds": {}, "cam": {"base_radius_mm": 30}})
    wanted = 30.0 - least_base(gc.build(plain).program, 0.0)
    assert caught.value.value == pytest.approx(wanted, abs=2e-3)
    document["limits"]["profile_radius_mm"] = caught.value.value
    assert not gc.build(gc.design(document)).findings


@pytest.mark.parametrize("follower", [{"type": "flat"}, {"type": "roller", "roller_radius_mm": 5}])
def test_a_velocity_that_falls_at_once_is_named(follower: dict[str, Any]) -> None:
    phases = motion("cycloidal")
    phases[0]["law"] = "constant-velocity"
    document = {
        "kind": "cam", "name": "c", "motion": phases, "follower": follower,
        "cam": {"base_radius_mm": "solve"},
    }  # fmt: skip
    with pytest.raises(InfeasibleError, match=r"velocity falls at once.*100 deg"):
        _ = gc.build(gc.design(document)).solution
    given = gc.build(gc.design(document).with_({"cam.base_radius_mm": 1e4}))
    assert "undercut" in {one.code for one in given.findings}


@pytest.mark.parametrize("dome", [14.848, 15.3, 20.0])
def test_a_dome_about_the_axis_is_told_from_one_beside_it(dome: float) -> None:
    """The least prime radius is the dome's own, which no cam may have: a millionth more."""
    rise = {"type": "rise", "law": "cycloidal", "angle_deg": 150, "lift_mm": 1}
    document = {
        "kind": "cam", "name": "c",
        "motion": [rise, {"type": "return", "law": "cycloidal", "angle_deg": 210}],
        "follower": {"type": "domed", "dome_radius_mm": dome},
        "cam": {"prime_radius_mm": "solve"}, "limits": {"profile_radius_mm": 0},
    }  # fmt: skip
    found = gc.build(gc.design(document)).solution
    assert found.sizes["cam.prime_radius_mm"] == pytest.approx(dome + 1e-6, abs=1e-9)
    assert "reach of the follower" in found.deciding


def test_rows_that_turn_within_a_cell_are_solved() -> None:
    """A least lift just beside a row: the phase before it has no cell of its own."""
    result = gc.build(gc.design(flat(2)))
    program = Task(result).program
    widths = [high - low for kind in ("rise", "return") for low, high in program.phases(kind)]
    assert min(widths) < 1e-6
    assert result.solution.sizes["cam.base_radius_mm"] > 0.0


def test_a_bore_and_bounds_are_kept() -> None:
    document = stem("polynomial", blank={"bore_diameter_mm": 60}, limits={"wall_mm": 4})
    result = gc.build(gc.design(document))
    assert result.facts["cam.base_radius_mm"] == pytest.approx(34.0, abs=2e-3)
    assert "wall around the bore" in result.solution.deciding
    document = stem("cycloidal", bounds={"offset_mm": [0, 10]})
    assert gc.build(gc.design(document)).solution.sizes["follower.offset_mm"] >= 0.0


def test_another_goal_is_reached() -> None:
    document = stem(
        "cycloidal",
        bounds={"prime_radius_mm": [30, 60]},
        goal={"minimize": "cam.pressure_angle_deg.max"},
    )
    result = gc.build(gc.design(document))
    assert result.solution.sizes["cam.prime_radius_mm"] == pytest.approx(60.0, abs=1e-5)
    rise, back = (result.facts[f"cam.pressure_angle_deg.{one}_max"] for one in ("rise", "return"))
    assert rise == pytest.approx(back, rel=1e-5)


def test_the_limit_that_has_to_give_is_named_and_works() -> None:
    document = stem("cycloidal", bounds={"prime_radius_mm": [20, 30]})
    with pytest.raises(InfeasibleError, match="pressure angle would be") as caught:
        _ = gc.build(gc.design(document)).solved
    error = caught.value
    assert error.where == "limits.pressure_angle_deg"
    assert error.value is not None
    eased = gc.design(document).with_({"limits.pressure_angle_deg": error.value})
    assert gc.build(eased).solution.sizes["cam.prime_radius_mm"] <= 30.0
    tighter = gc.design(document).with_({"limits.pressure_angle_deg": error.value - 0.01})
    with pytest.raises(InfeasibleError):
        _ = gc.build(tighter).solved


@pytest.mark.parametrize(
    ("change", "message"),
    [
        ({"cam.form": "yoke", "cam.prime_radius_mm": "solve"}, "not available for a yoke cam"),
        ({"bounds.offset_mm": [3, 2]}, "is an empty range"),
        ({"bounds.arm_mm": [3, 4]}, "not solved for"),
        ({"bounds.roller_radius_mm": [3, 4]}, "not solved for.*\n.*prime_radius_mm"),
        ({"goal.minimize": "mass"}, "radius_mm.max"),
        ({"cam.prime_radius_mm": "solv"}, "did you mean solve"),
    ],
)
def test_mistakes_are_named(change: dict[str, Any], message: str) -> None:
    with pytest.raises(DesignError, match=message):
        gc.design(stem("cycloidal")).with_(change)


def test_a_swinging_follower_without_a_length_is_refused() -> None:
    document = arm("cycloidal")
    document["follower"] |= {"arm_mm": "solve"}
    with pytest.raises(DesignError, match="a shorter arm always makes a smaller cam"):
        gc.design(document)
    document["bounds"] = {"arm_mm": [40, 90]}
    result = gc.build(gc.design(document))
    assert result.solution.sizes["follower.arm_mm"] == 40.0
    assert "arm_mm at its bound 40 mm" in result.solution.deciding
    document["follower"]["roller_radius_mm"] = "solve"
    with pytest.raises(InfeasibleError, match="no length of the swinging follower"):
        _ = solved(gc.build(gc.design(document)))


def test_a_range_of_one_value_is_that_value() -> None:
    document = stem("cycloidal", bounds={"prime_radius_mm": [52, 52]})
    found = gc.build(gc.design(document)).solution
    assert found.sizes["cam.prime_radius_mm"] == 52.0
    assert "prime_radius_mm at its bound 52 mm" in found.deciding


@pytest.mark.parametrize("radius", few(["solve", 35.0, 90.0], 3))
def test_the_range_that_an_arm_needs_is_named_and_works(radius: Any) -> None:
    document = arm("polynomial", cam={"prime_radius_mm": radius})
    document["follower"]["arm_mm"] = "solve"
    with pytest.raises(DesignError) as caught:
        gc.design(document)
    (ends,) = re.findall(r"arm_mm = \[([0-9.]+), ([0-9.]+)\]", str(caught.value))
    document["bounds"] = {"arm_mm": [float(end) for end in ends]}
    assert not gc.build(gc.design(document)).findings


def test_an_end_of_the_default_range_is_told() -> None:
    document = stem("polynomial", cam={"prime_radius_mm": 60.0})
    document["follower"] = {"type": "roller", "roller_radius_mm": "solve"}
    document["goal"] = {"maximize": "cam.curvature.profile_convex_min_mm"}
    found = gc.build(gc.design(document)).solution
    assert found.deciding == ("the default range of roller_radius_mm ([bounds] sets another)",)


# some starts of the search press almost at a right angle, or are out of reach
STEEP = [
    (arm, {"prime_radius_mm": 90.0}, {}),
    (arm, {"prime_radius_mm": 90.0}, {"maximize": "cam.pressure_angle_deg.max"}),
    (arm, {"prime_radius_mm": 60.0}, {"minimize": "cam.pressure_angle_deg.rise_max"}),
]


@pytest.mark.parametrize(("make", "cam", "goal"), few(STEEP))
def test_a_search_passes_steep_starts(make: Any, cam: dict[str, Any], goal: dict[str, Any]) -> None:
    result = gc.build(gc.design(make("polynomial", cam=cam, goal=goal)))
    assert not result.findings
    free = goal.get("minimize") is not None
    assert (result.solution.deciding == ("the goal alone",)) == free


def test_a_goal_that_only_the_default_range_limits_is_refused_with_a_range_that_works() -> None:
    document = stem("cycloidal", goal={"minimize": "cam.pressure_angle_deg.max"})
    with pytest.raises(InfeasibleError, match="the best cam is the largest") as caught:
        _ = gc.build(gc.design(document)).solution
    low, high = re.findall(r"prime_radius_mm = \[([0-9.]+), ([0-9.]+)\]", str(caught.value))[0]
    document["bounds"] = {"prime_radius_mm": [float(low), float(high)]}
    assert not gc.build(gc.design(document)).findings


@pytest.mark.slow
def test_a_refused_solution_is_told_without_other_remedies(
    tmp_path: Path, capsys: pytest.CaptureFixture[str]
) -> None:
    text = toml_text(stem("cycloidal", limits={"pressure_angle_deg": 5}, bounds=BOUNDS))
    (tmp_path / "c.toml").write_text(text)
    assert main(["build", str(tmp_path / "c.toml"), "-o", str(tmp_path)]) == 3
    said = capsys.readouterr().err
    assert "no sizes keep all limits: the pressure angle would be" in said
    assert "bug" not in said


BOUNDS = {"prime_radius_mm": [20, 30]}


@pytest.mark.slow
def test_a_wall_that_has_to_give_is_named_and_can_be_kept() -> None:
    document = stem("cycloidal", bounds={"prime_radius_mm": [25, 45]}, limits={"wall_mm": 9})
    document["blank"] = {"bore_diameter_mm": 70}
    with pytest.raises(InfeasibleError, match="wall around the bore would be") as caught:
        _ = gc.build(gc.design(document)).solution
    document["limits"]["wall_mm"] = caught.value.value
    assert not gc.build(gc.design(document)).findings


def test_a_wall_that_no_size_changes_leaves_room_for_the_others() -> None:
    document = stem("cycloidal", cam={"prime_radius_mm": 52}, limits={"wall_mm": 9})
    document["blank"] = {"bore_diameter_mm": 80}
    with pytest.raises(InfeasibleError, match="wall around the bore would be") as caught:
        _ = gc.build(gc.design(document)).solution
    assert caught.value.value == pytest.approx(7.0, abs=2e-3)  # 52 - 5 - 40, less a chord
    document["limits"]["wall_mm"] = caught.value.value
    result = gc.build(gc.design(document))
    assert not result.findings
    assert "wall around the bore" in result.solution.deciding


def test_the_name_of_a_solved_file_is_another_however_long_it_is() -> None:
    document = stem("cycloidal") | {"name": "c" * 100}
    (text,) = gc.build(gc.design(document)).more_files.values()
    assert f'name = "{"c" * 90}_solved"' in text.decode()


def test_a_solved_file_has_no_ranges_without_an_effect() -> None:
    document = stem("cycloidal", bounds={"prime_radius_mm": [52, 52]})
    (text,) = gc.build(gc.design(document)).more_files.values()
    assert "bounds" not in text.decode()


def test_a_flat_follower_has_no_prime_radius_to_solve_for() -> None:
    document = stem("cycloidal", follower={"type": "flat"})
    with pytest.raises(DesignError, match="does not apply to a flat follower"):
        gc.design(document)


def test_a_finding_about_a_radius_names_sizes_that_keep_all_limits() -> None:
    cam, limits = {"prime_radius_mm": 40}, {"profile_radius_mm": 12}
    document = stem("cycloidal", cam=cam, limits=limits)
    document["follower"] = {"type": "roller", "roller_radius_mm": 21, "offset_mm": -2.8}
    design = gc.design(document)
    (finding,) = (one for one in gc.build(design).findings if one.code == "sharp-profile")
    named = dict(re.findall(r"(\w+\.\w+_mm) = ([\d.]+)", finding.message))
    assert {*named} == {"cam.prime_radius_mm", "follower.roller_radius_mm"}
    for key, value in named.items():
        assert gc.build(design.with_({key: float(value)})).findings == ()
    shy = float(named["follower.roller_radius_mm"]) + 1e-3
    again = gc.build(design.with_({"follower.roller_radius_mm": shy})).findings
    assert [one.code for one in again] == ["sharp-profile"]


def test_a_pivot_that_is_solved_for_stands_beside_the_cam() -> None:
    result = built(gc.design(arm("cycloidal")))
    task = Task(result)
    sizes = {**task.known, "radius": 60.0, "pivot": 50.0}
    found = task.measured(sizes)
    given = {"cam.prime_radius_mm": 60.0, "follower.pivot_distance_mm": 50.0}
    radius = gc.build(result.design.with_(given)).facts["cam.profile.radius_mm.max"]
    assert float(found.excess["pivot"][0, 0]) == pytest.approx(radius / 50.0 - 1.0, rel=1e-6)


def loaded(document: dict[str, Any], most: float, **tables: Any) -> dict[str, Any]:
    spring = {"stiffness_n_mm": 8, "preload_n": 120}
    mass = {"mass_kg": 1.2}
    if document["follower"].get("motion") == "oscillating":
        spring = {"stiffness_nm_rad": 40, "preload_nm": 9}
        mass = {"mass_kg": 0.8, "center_mm": 50, "inertia_kg_m2": 0.003}
    return document | {
        "spring": [spring], "mass": [mass], "drive": {"speed_rpm": 200},
        "limits": {"contact_pressure_mpa": most},
    } | tables  # fmt: skip


@pytest.mark.slow
def test_the_base_radius_of_a_face_under_a_contact_pressure_is_the_closed_form() -> None:
    document = stem("cycloidal", cam={"base_radius_mm": "solve", "thickness_mm": 12.0})
    document["follower"] = {"type": "flat"}
    result = gc.build(gc.design(loaded(document, 300.0)))
    theta = np.linspace(0.0, 2.0 * math.pi, 200001)[:-1]
    s, _, d2s = result.program.derivatives(theta, 2)
    force = 120.0 + 8.0 * s + 1.2e-3 * (200.0 * math.pi / 30.0) ** 2 * d2s
    modulus = 0.5 * 206000.0 / (1.0 - 0.3**2)
    # p^2 = N*E/(pi*b*rho) of the radius of curvature rho = base + s + s"
    base = float(np.max(force * modulus / (math.pi * 12.0 * 300.0**2) - s - d2s))
    assert result.solution.sizes["cam.base_radius_mm"] == pytest.approx(base, abs=2e-3)
    assert result.solution.deciding == ("contact pressure",)


@pytest.mark.parametrize(
    "ends", few([([30.001, 30.002],), ([0.0, 100.0],), ([100.0, 100.001],)], 3)
)
def test_a_load_between_two_angles_is_seen_at_its_ends(ends: list[float]) -> None:
    """A short one, at its ends; and one that ends where a phase does."""
    document = stem("cycloidal", cam={"base_radius_mm": "solve", "thickness_mm": 12.0})
    document["follower"] = {"type": "flat"}
    modulus = 0.5 * 206000.0 / (1.0 - 0.3**2)
    load = [{"force_n": 4880, "from_deg": ends[0], "to_deg": ends[1]}]
    result = gc.build(gc.design(loaded(document, 400.0, load=load)))
    theta = np.radians(np.linspace(ends[0], ends[1], 20001))
    s, _, d2s = result.program.derivatives(theta, 2)
    force = 5000.0 + 8.0 * s + 1.2e-3 * (200.0 * math.pi / 30.0) ** 2 * d2s
    base = float(np.max(force * modulus / (math.pi * 12.0 * 400.0**2) - s - d2s))
    assert result.solution.sizes["cam.base_radius_mm"] == pytest.approx(base, abs=2e-3)


FRICTION = {
    "guide": 0.1, "guide_length_mm": 50, "joint": 0.08, "roller": 0.05,
    "journal_radius_mm": [10, 2], "flank": 0.1,
}  # fmt: skip


INCLINED = {"gravity": {"direction_deg": -60}}


@pytest.mark.slow
@pytest.mark.parametrize("gravity", [{}, INCLINED])
@pytest.mark.parametrize("kind", ["stem", "arm", "dome", "swinging face"])
def test_the_contact_pressure_of_a_solved_cam_is_at_its_limit(
    kind: str, gravity: dict[str, Any]
) -> None:
    document = stem("modified sine") if kind in ("stem", "dome") else arm("modified sine")
    if kind == "dome":
        document["follower"] = {"type": "domed", "dome_radius_mm": 9, "offset_mm": "solve"}
    if kind == "swinging face":
        document["follower"] = {
            "type": "flat", "motion": "oscillating", "pivot_distance_mm": 130,
        }  # fmt: skip
        document["cam"] = {"base_radius_mm": "solve"}
    tables = {"friction": FRICTION} | gravity
    free = gc.build(gc.design(loaded(document, 0.0, **tables)))
    most = round(0.87 * free.study("forces").facts["forces.pressure_mpa"], 1)
    result = gc.build(gc.design(loaded(document, most, **tables)))
    assert "contact pressure" in result.solution.deciding
    assert not result.findings
    found = result.study("forces").facts["forces.pressure_mpa"]
    assert most * (1.0 - 1e-3) < found <= most
    size = "cam.profile.radius_mm.max"
    assert result.facts[size] > free.facts[size]


def test_pressure_angles_of_rises_and_returns_have_limits_of_their_own() -> None:
    limits = {"pressure_angle_deg": [24, 38], "profile_radius_mm": 1}
    result = gc.build(gc.design(stem("cycloidal", limits=limits)))
    facts = result.facts
    assert facts["cam.pressure_angle_deg.rise_max"] == pytest.approx(24.0, abs=1e-3)
    assert facts["cam.pressure_angle_deg.return_max"] == pytest.approx(38.0, abs=1e-3)
    assert not result.findings
    swapped = result.solved.with_({"limits.pressure_angle_deg": [38, 24]})
    (finding,) = gc.build(swapped).findings
    assert finding.limit == pytest.approx(24.0)
    assert "return" in finding.where


def test_the_pressure_angle_that_has_to_give_is_named_alone() -> None:
    document = stem("cycloidal", limits={"pressure_angle_deg": [12, 40]})
    document["cam"] = {"prime_radius_mm": 38.0}
    with pytest.raises(InfeasibleError, match="pressure angle of rises would be") as caught:
        _ = gc.build(gc.design(document)).solution
    (near,) = re.findall(r"pressure_angle_deg = (\[[^]]*\])", str(caught.value))
    assert near.endswith(", 40]")
    document["limits"] = {"pressure_angle_deg": [float(one) for one in near[1:-1].split(",")]}
    assert not gc.build(gc.design(document)).findings


@pytest.mark.slow
def test_a_contact_pressure_that_has_to_give_is_named_and_works() -> None:
    document = loaded(stem("polynomial"), 400.0, bounds={"prime_radius_mm": [12, 16]})
    with pytest.raises(InfeasibleError, match="contact pressure would be") as caught:
        _ = gc.build(gc.design(document)).solution
    (near,) = re.findall(r"contact_pressure_mpa = ([0-9.]+)", str(caught.value))
    document["limits"]["contact_pressure_mpa"] = float(near)
    assert not gc.build(gc.design(document)).findings


@pytest.mark.slow
def test_a_finding_about_contact_pressure_names_the_cam_that_keeps_it() -> None:
    document = loaded(stem("cycloidal"), 450.0)
    document["follower"]["offset_mm"] = 2.0
    document["cam"] = {"prime_radius_mm": 24.0}
    document["limits"]["pressure_angle_deg"] = 60.0
    document["output"] = {"studies": ["forces"], "files": ["csv"]}
    result = gc.build(gc.design(document))
    (finding,) = result.study("forces").findings
    (radius,) = re.findall(r"cam.prime_radius_mm = ([0-9.]+)", finding.message)
    for factor, left in ((1.0, 0), (0.98, 1)):
        other = result.design.with_({"cam.prime_radius_mm": factor * float(radius)})
        assert len(gc.build(other).study("forces").findings) == left


@pytest.mark.parametrize("kind", few(["rise", "return"]))
def test_the_pressure_angle_of_rises_or_returns_is_a_goal(kind: str) -> None:
    goal = {"minimize": f"cam.pressure_angle_deg.{kind}_max"}
    document = stem("cycloidal", goal=goal, bounds={"prime_radius_mm": [30, 45]})
    found = gc.build(gc.design(document))
    both = gc.build(gc.design(document | {"goal": {"minimize": "cam.pressure_angle_deg.max"}}))
    assert found.facts[f"{goal['minimize']}"] < both.facts[goal["minimize"]]
    assert found.facts["cam.pressure_angle_deg.max"] > both.facts["cam.pressure_angle_deg.max"]
