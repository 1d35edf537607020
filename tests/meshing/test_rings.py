"""A wheel within a ring: contact, first touch, play and overlap, as designed and as mounted.

The ring's shaft stands at -A; wheel 1 is turned by -phi1 and the ring by -phi2.
"""

from __future__ import annotations

import math
from dataclasses import replace
from functools import cache

import numpy as np
import pytest
import shapely
from numpy.typing import NDArray

import gearcam as gc
from gearcam.errors import InfeasibleError
from gearcam.findings import run_checks
from gearcam.gears.contact import COAST, DRIVE, flank_pairs
from gearcam.gears.outline import build_outline
from gearcam.gears.pair import Gear
from gearcam.gears.track import Wheel
from gearcam.kinds.gear_pair.build import GearPairResult
from gearcam.meshing.checks import KIND
from gearcam.meshing.contact import contacts
from gearcam.meshing.edges import first_touch, touches
from gearcam.meshing.half_teeth import half_teeth
from gearcam.meshing.numbers import numbers
from gearcam.meshing.overlap import Turning
from gearcam.meshing.settings import MeshingSpec
from gearcam.meshing.study import Meshing, mount, run, study
from gearcam.tolerances import DEFAULT
from helpers_meshing import moved

Array = NDArray[np.float64]
Plane = NDArray[np.complex128]

ALPHA = math.radians(20.0)
OVERCLOSURE = math.radians(0.005)
DEEP = gc.Rack(dedendum=1.5, tip_radius=0.0)
"""Straight flanks so deep that the tips of the rings below keep their full height."""

FOCUS = "22.3517355864508/(22.3517355864508 + 22.87542426332165*(1 + 0.3*cos(phi1)))"
TWO_LOBES = "37.668247881141/(37.668247881141 + 18.96124240457442*(1 + 0.2*cos(2*phi1)))"
ROUND = gc.laws.Constant()
LAWS = {
    "circular": (ROUND, (28, 40), 1.0, DEEP),
    "one lobe": (gc.laws.Formula(ratio=FOCUS), (24, 48), 2.0, gc.Rack()),
    "two lobes": (gc.laws.Formula(ratio=TWO_LOBES), (40, 60), 2.0, gc.Rack()),
    "asymmetric": (
        gc.laws.Formula(ratio="1 + 0.2*cos(phi1) + 0.04*sin(2*phi1)"), (30, 60), 2.0, gc.Rack(),
    ),
}  # fmt: skip
CLEAN = ["circular", "one lobe", "asymmetric"]
"""The tips of the two lobes meet outside the mesh."""


def pair_of(law: object, teeth: tuple[int, int], module: float, rack: gc.Rack) -> GearPairResult:
    spec = gc.PairSpec(type="internal", teeth=teeth, module=module)
    return gc.build(gc.GearPairDesign(name="ring", law=law, pair=spec, rack=rack))  # type: ignore[arg-type]


@cache
def made(name: str) -> GearPairResult:
    return pair_of(*LAWS[name])


@cache
def studied(name: str, more: float = 0.0, steps: int = 120, ahead: float = OVERCLOSURE) -> Meshing:
    distance = made(name).pair.center_distance + more
    spec = MeshingSpec(steps=steps, overclosure=ahead, center_distance=distance)
    return study(made(name).gears, spec)


def codes(meshing: Meshing) -> dict[str, str]:
    return {found.code: found.severity for found in run_checks(KIND, meshing, {})}


def phases(name: str, count: int = 41) -> Array:
    """Driver angles of a turn, clear of knots."""
    return np.linspace(0.05, 2.0 * math.pi + 0.01, count)


def driven_angles(name: str, phi1: Array) -> Array:
    """The driven angle by Gauss-Legendre quadrature of the ratio."""
    nodes, weights = np.polynomial.legendre.leggauss(96)
    law = made(name).law
    half = 0.5 * phi1[:, None]
    return (law.derivatives((half * (1.0 + nodes)).ravel(), 1)[1].reshape(half.size, -1)) @ (
        weights
    ) * half.ravel()


FLANK_POINTS = [
    ("one lobe", 1, 1, 3.0, 0.670422458743, 17.3669675696998 + 1.50032475382222j,
     40.2736992412249 + 1.49456196954045j),
    ("one lobe", 5, 1, 82.847443087281, -2 / 3, 3.13978485125321 + 20.9506597590129j,
     35.4267312088711 + 26.1907893140537j),
    ("one lobe", 5, -1, 62.0, 3.91049855615, 5.76908841828522 + 18.6201588573513j,
     35.6791213785957 + 22.5025153446057j),
    ("one lobe", 13, 1, 182.0, 0.456247828366, -32.0296446730783 - 1.52377105198177j,
     -1.52211673957626 + 54.9191400056075j),
    ("two lobes", 1, 1, 3.0, -0.0736252436139, 31.3533126119044 + 1.5789209538115j,
     50.3294840651883 + 1.57946003539188j),
    ("two lobes", 5, 1, 45.184870469123, -2 / 3, 26.620401290116 + 26.1304226359781j,
     49.5061653300549 + 26.7318093630524j),
    ("two lobes", 13, -1, 104.2020789582, -2 / 3, -10.7888974450768 + 44.7722430322602j,
     22.6275060442496 + 60.9494894166484j),
]  # fmt: skip
"""Tooth, sigma, phi1 deg, u mm, the point on wheel 1 and on the ring: by mpmath, to 25 digits."""


@pytest.mark.parametrize(("name", "tooth", "sigma", "angle", "u", "one", "two"), FLANK_POINTS)
def test_flanks_are_those_of_the_oracle(
    name: str, tooth: int, sigma: int, angle: float, u: float, one: complex, two: complex
) -> None:
    """And their normals are one through the mesh, so that they share tangents."""
    result, phi1 = made(name), np.array([math.radians(angle)])
    first, second = (gear.toothing for gear in result.gears)
    sf = np.array([(tooth - 1) * first.pitch + sigma * first.pitch / 4.0])
    frames = first.frames(phi1), second.frames(phi1)
    assert float(sf[0] - frames[0].s[0]) == pytest.approx(u, abs=1e-9)
    points = first.flank_points(frames[0], sf, sigma), second.flank_points(frames[1], sf, -sigma)
    assert abs(points[0][0] - one) < 1e-9
    assert abs(points[1][0] - two) < 1e-9
    normals = first.normals(frames[0], sigma), second.normals(frames[1], -sigma)
    turned = normals[0] * np.exp(-1j * phi1), normals[1] * np.exp(-1j * driven_angles(name, phi1))
    assert abs(turned[0][0] - turned[1][0]) < 1e-12


@pytest.mark.parametrize("name", LAWS)
@pytest.mark.parametrize("side", [DRIVE, COAST])
def test_a_contact_lies_on_both_flanks_and_nothing_leads(name: str, side: int) -> None:
    """Carried into the ring, a contact lies on its flank, and their tangents are one line."""
    result, phi1 = made(name), phases(name)
    pairs, distance = flank_pairs(result.gears, side), result.pair.center_distance
    found = contacts(pairs, phi1)
    assert np.abs(found.lead).max() < 1e-12
    turn = np.exp(1j * driven_angles(name, phi1))[found.step]
    seen, force = (found.point + distance) * turn, found.force * turn
    toothing, places = pairs.toothings[1], pairs.place(2, found.pair)
    roll = phi1[found.step] - 1e-3  # a poor guess: the flank is searched by its own formula
    for _ in range(8):
        frames = toothing.frames(roll)
        off = seen - toothing.flank_points(frames, places, -side)
        along = toothing.flank_motion(frames, places, -side)
        roll = roll + np.real(off * np.conj(along)) / np.abs(along) ** 2
    assert np.abs(off).max() < 1e-9
    assert np.abs(np.real(force * np.conj(along)) / np.abs(along)).max() < 1e-9
    assert np.bincount(found.step, minlength=len(phi1)).min() >= 1


@pytest.mark.parametrize("name", LAWS)
@pytest.mark.parametrize("side", [DRIVE, COAST])
def test_sliding_is_the_difference_of_the_velocities(name: str, side: int) -> None:
    """Both turn clockwise; what the driver's point has more than the ring's slides, tip outward."""
    result, phi1 = made(name), phases(name)
    found = contacts(flank_pairs(result.gears, side), phi1)
    ratio = result.law.derivatives(phi1, 1)[1][found.step]
    relative = -1j * found.point + 1j * ratio * (found.point + result.pair.center_distance)
    tangent = 1j * found.force
    outward = tangent * np.sign(np.real(tangent * np.conj(found.point)))
    # a point of contact moves on the driver against the driver's own material
    assert found.sliding == pytest.approx(-np.real(relative * np.conj(outward)), abs=1e-9)
    across = np.real(relative * np.conj(found.force))
    assert np.abs(across).max() < 1e-9
    levers = np.imag(np.conj(found.point) * found.force), np.imag(
        np.conj(found.point + result.pair.center_distance) * found.force
    )
    assert found.lever == pytest.approx(np.abs(levers), abs=1e-12)


def test_the_pressure_angle_at_the_pitch_point_is_told_by_the_slope_of_the_centrode() -> None:
    """alpha less the slope on the flanks that drive, and more on the others, as outside."""
    result = made("asymmetric")
    for side, way, sign in ((DRIVE, "forward", -1.0), (COAST, "backward", 1.0)):
        place, most = result.subject.pressure_angles[way]
        phi1 = np.append(np.linspace(0.0, 2.0 * math.pi, 721), place)
        radius = result.pair.rolling.radii(phi1 % (2.0 * math.pi), 1)
        expected = ALPHA + sign * np.arctan(radius[1] / radius[0])
        assert most == pytest.approx(expected.max(), abs=1e-9)
        found = contacts(flank_pairs(result.gears, side), phi1)
        assert found.pressure_angle == pytest.approx(expected[found.step], abs=1e-9)


@pytest.mark.parametrize(
    ("teeth", "ratio"),
    [((28, 37), 2.281837124), ((28, 40), 2.190603171), ((40, 48), 2.10811715),
     ((40, 49), 2.098621311)],
)  # fmt: skip
def test_contact_ratios_of_circular_rings(teeth: tuple[int, int], ratio: float) -> None:
    """000, eq. 4.63: from the tips of both wheels, full height, module 1."""
    result = pair_of(ROUND, teeth, 1.0, DEEP)
    assert result.contact_ratio == pytest.approx(ratio, abs=1e-9)
    assert result.contact_ratios["contact_ratio"] == pytest.approx(ratio, abs=1e-9)


@pytest.mark.parametrize("name", CLEAN)
@pytest.mark.parametrize("ahead", [OVERCLOSURE, -OVERCLOSURE])
def test_a_turn_as_designed_runs_clean(name: str, ahead: float) -> None:
    meshing = studied(name, ahead=ahead)
    found = numbers(meshing)
    assert (found["steps_done"], found["interference_steps"], found["edge_steps"]) == (120, 0, 0)
    assert found["center_distance_mm"] == made(name).pair.center_distance
    assert abs(found["transmission_error"]["mean_lag"]) < 1e-12
    assert found["transmission_error"]["peak_to_peak"] < 1e-12
    assert max(map(abs, found["backlash_mm"].values())) < 1e-10
    assert found["agreement"]["inside"] < 0.02
    assert found["agreement"]["steps_apart"] <= 1
    assert found["agreement"]["clipped_mm2"] < 3e-3
    assert codes(meshing) == {}
    columns = meshing.columns
    assert set(columns["side"].tolist()) == {float(DRIVE if ahead > 0.0 else COAST)}
    carries = columns["carries"] == 1.0
    radii = columns["contact_radius1_mm"][carries], columns["contact_radius2_mm"][carries]
    assert np.all(radii[1] - radii[0] <= made(name).pair.center_distance)
    assert np.all(radii[1] > radii[0])


def involute(angle: float) -> float:
    return math.tan(angle) - angle


@pytest.mark.parametrize("more", [-0.1, -0.3, 0.1])
def test_a_circular_ring_off_its_distance_is_an_involute_ring(more: float) -> None:
    """cos(alpha_w) = cos(alpha)*A/A', and the play 2*A'*(inv(alpha) - inv(alpha_w)) at the ring."""
    result, phi1 = made("circular"), phases("circular")
    distance = result.pair.center_distance + more
    angle = math.acos(math.cos(ALPHA) * result.pair.center_distance / distance)
    leads = []
    for side in (DRIVE, COAST):
        pairs = flank_pairs(result.gears, side, -distance)
        found = contacts(pairs, phi1)
        assert found.pressure_angle == pytest.approx(angle, abs=1e-11)
        leads.append(first_touch(pairs, phi1, found)[0])
    radius = distance * 40 / 12  # the ring's pitch circle as mounted
    play = 2.0 * distance * (involute(ALPHA) - involute(angle)) / radius
    assert leads[1] - leads[0] == pytest.approx(play, abs=1e-12)
    assert np.sign(play) == -np.sign(more)
    meshing = studied("circular", more)
    told = numbers(meshing)
    assert told["center_distance_mm"] == pytest.approx(distance, abs=1e-12)
    assert meshing.every("backlash") == pytest.approx(20.0 * play, abs=1e-11)


@pytest.mark.parametrize("name", ["one lobe", "asymmetric"])
def test_mounted_farther_interferes_and_nearer_plays(name: str) -> None:
    result = made(name)
    far, near = studied(name, 0.1), studied(name, -0.1)
    assert numbers(far)["interference_steps"] == 120
    assert codes(far)["interference"] == "error"
    assert numbers(near)["interference_steps"] == 0
    assert "interference" not in codes(near)
    assert near.every("backlash").min() > 0.0
    assert far.every("backlash").max() < 0.0
    # the force lines of both sides cut the line of centres at alpha +- tilt; what goes with the
    # square of the way falls out of the difference
    phi1 = near.phi1
    tangent = result.pair.rolling.tracks[0].frames(phi1).t * np.exp(-1j * phi1)
    tilt = np.arctan2(tangent.real, tangent.imag)
    expected = 0.02 * (np.tan(ALPHA + tilt) + np.tan(ALPHA - tilt)) * np.cos(tilt)
    both = [studied(name, more).every("backlash") for more in (-0.01, 0.01)]
    assert np.all(np.abs((both[0] - both[1]) / expected - 1.0) < 1e-3)
    # and the outlines say the same: turned by all of the play, the other flanks touch
    turning, lead = near.setup.turning, near.every("lead")
    turns = near.every("backlash") / near.every("along")
    for share, free in ((0.999, True), (1.001, False)):
        found = turning.overlaps(phi1, 0.0, lead + share * turns)
        touched = np.unique(found.step[found.depth > near.setup.noise])
        assert (len(touched) == 0) == free


def dense(gear: Gear, tooth: int, sigma: int) -> Plane:
    """Points of a flank in the wheel's frame, root first."""
    flanks, toothing = gear.profile.flanks, gear.toothing
    number = tooth - 1 + (0 if sigma > 0 else toothing.teeth)
    reach = np.linspace(flanks.lowest[number], flanks.highest[number], 6001)
    sf = flanks.sf[number]
    frames = toothing.frames(toothing.track.angle(sf - sigma * reach))
    return toothing.flank_points(frames, np.full(6001, sf), np.full(6001, float(sigma)))


def dense_touch(name: str, side: int, phi1: float, distance: float) -> float:
    """The turn of the ring at first touch, by dense points of all flanks near the pitch point."""
    gears, pair = made(name).gears, made(name).pair
    near = round(float(pair.rolling.tracks[0].arc_length(phi1)) / gears[0].toothing.pitch)
    driven = float(driven_angles(name, np.array([phi1]))[0])
    ahead = []
    for j in range(near - 2, near + 3):
        one = dense(gears[0], j % pair.teeth[0] + 1, side) * np.exp(-1j * phi1) + distance
        k = j if side > 0 else j - 1
        two = dense(gears[1], k % pair.teeth[1] + 1, -side) * np.exp(-1j * driven)
        order = np.argsort(np.abs(two))
        radius = np.abs(two)[order]
        inside = (np.abs(one) >= radius[0]) & (np.abs(one) <= radius[-1])
        if np.count_nonzero(inside) < 3:
            continue
        gap = np.angle(one[inside]) - np.interp(np.abs(one)[inside], radius, np.angle(two)[order])
        ahead.append((side * gap).max())  # forwards the ring turns clockwise
    return -side * max(ahead)


@pytest.mark.parametrize("name", ["one lobe", "asymmetric"])
@pytest.mark.parametrize("side", [DRIVE, COAST])
@pytest.mark.parametrize("more", [0.0, 0.1, -0.1])
def test_first_touch_is_that_of_dense_points(name: str, side: int, more: float) -> None:
    phi1 = phases(name, 17)
    distance = made(name).pair.center_distance + more
    pairs = flank_pairs(made(name).gears, side, -distance)
    found = touches(pairs, phi1)
    outward = np.full(len(phi1), -np.inf)
    np.maximum.at(outward, found.step, -side * found.turn)
    expected = [dense_touch(name, side, angle, distance) for angle in phi1.tolist()]
    assert -side * outward == pytest.approx(expected, abs=1e-7)
    assert first_touch(pairs, phi1, contacts(pairs, phi1))[0] == pytest.approx(expected, abs=1e-7)


def whole_areas(name: str, distance: float, angles: Array, lead: float) -> list[float]:
    """Overlap of the whole wheel with all that lies outside the ring's outline."""
    areas = []
    for phi1, driven in zip(angles.tolist(), driven_angles(name, angles).tolist(), strict=True):
        one = made(name).gear1.outline @ [1, 1j] * np.exp(-1j * (phi1 + OVERCLOSURE))
        two = made(name).gear2.outline @ [1, 1j] * np.exp(-1j * (driven + lead)) - distance
        wheel, hole = (shapely.Polygon(np.stack([z.real, z.imag], axis=1)) for z in (one, two))
        areas.append(wheel.difference(hole).area)
    return areas


@pytest.mark.parametrize("name", LAWS)
@pytest.mark.parametrize("more", [0.0, 0.03, -0.03, 0.4])
def test_all_overlap_is_that_of_the_whole_outlines(name: str, more: float) -> None:
    """In place, mounted far and near (in modules), and turned by up to half a tooth."""
    result, module = made(name), made(name).pair.module
    first, second = (half_teeth(gear.profile) for gear in result.gears)
    distance = result.pair.center_distance + more * module
    turning = Turning(rolling=result.pair.rolling, driver=first, driven=second, distance=-distance)
    angles = np.radians(np.linspace(0.0, 360.0, 9) + 0.3)
    most = 0.0
    for lead in np.array([0.0, 0.01, -0.01, 0.2, -0.4]) * module / distance:
        found = turning.overlaps(angles, OVERCLOSURE, lead)
        areas = np.bincount(found.step, found.area, minlength=len(angles))
        expected = whole_areas(name, distance, angles, lead)
        assert areas == pytest.approx(expected, rel=1e-9, abs=1e-12 * module**2)
        most = max(most, *expected)
    assert most > 0.1 * module**2


def test_tips_that_meet_far_from_the_mesh_are_found() -> None:
    """28 teeth in 36, full height: corners meet before a quarter of a turn; in 37 they pass."""
    found = {}
    for teeth in (36, 37):
        made_so = pair_of(ROUND, (28, teeth), 1.0, DEEP)
        one, two = made_so.pair.toothings
        gears = (  # as they are cut, whatever a build would take off their tips
            replace(made_so.gear1, profile=build_outline(one, two, 1e-3, DEFAULT, follow=False)),
            replace(made_so.gear2, profile=build_outline(two, one, 1e-3, DEFAULT, follow=False)),
        )
        found[teeth] = study(gears, MeshingSpec())
    assert codes(found[37]) == {}
    (finding,) = (f for f in run_checks(KIND, found[36], {}) if f.code == "interference")
    assert finding.severity == "error"
    rows = found[36].columns
    deepest = int(rows["depth_mm"].filled(0.0).argmax())
    phi1 = rows["phi1_deg"][deepest]
    tooth, space = (int(rows[name][deepest]) for name in ("tooth1", "tooth2"))
    assert f"deepest at phi1 = {phi1:g} deg, tooth {tooth} in tooth {space}" in finding.where
    # tips meet: far from the line of centres, above the mean radius of the wheel's tips
    strange = np.ma.getmaskarray(rows["predicted_mm2"]) & (rows["depth_mm"].filled(0.0) > 1e-3)
    assert np.count_nonzero(strange) > 20
    assert rows["patch_to_mm"][strange].min() > 14.9
    middle = 2.0 * math.pi * (rows["tooth1"][strange].data - 1.0) / 28.0
    away = np.abs(np.angle(np.exp(1j * (middle - np.radians(rows["phi1_deg"][strange])))))
    assert away.min() > math.radians(45.0)


def test_the_tips_of_a_lobed_ring_meet_where_it_is_narrow() -> None:
    """Full height and 20 teeth more on the ring, enough for circles; in some phases tips meet."""
    (finding,) = (f for f in run_checks(KIND, studied("two lobes"), {}) if f.code == "interference")
    found = numbers(studied("two lobes"))
    assert 20 <= found["interference_steps"] <= 60
    assert finding.value > 0.1
    phi1 = np.unique(studied("two lobes").phi1[studied("two lobes").every("interferes")])
    areas = np.array(whole_areas("two lobes", 18.96124240457442, phi1, 0.0))
    assert areas.min() > 1e-4
    clear = studied("two lobes").phi1[~studied("two lobes").every("interferes")]
    explained = 4.0 * OVERCLOSURE * 60.0  # of each pair of flanks: depth times less than 1 mm
    assert max(whole_areas("two lobes", 18.96124240457442, clear, 0.0)) < explained


def about_tooth_1(steps: int, ahead: float) -> MeshingSpec:
    turn = math.radians(12.0)
    return MeshingSpec(start=-turn, end=turn, steps=steps, overclosure=math.radians(ahead))


@pytest.mark.parametrize(("wheel", "tooth"), [(1, 1), (2, 60)])
@pytest.mark.parametrize("by", [1e-3, -1e-3])
def test_a_tooth_moved_by_1_um_is_found(wheel: Wheel, tooth: int, by: float) -> None:
    """By the flanks: as the ring's lag, and as lack of room on the other side."""
    setup = mount(made("asymmetric").gears, about_tooth_1(24, 0.005))
    broken = run(moved(setup, tooth, by, wheel))
    radius = float(np.abs(made("asymmetric").pair.rolling.tracks[1].frames(np.zeros(1)).p[0]))
    if (by < 0.0) == (wheel == 1):  # pressed on the flank that drives; else the others carry
        assert broken.every("lead").max() == pytest.approx(1e-3 / radius, rel=0.1)
    assert broken.every("backlash").min() == pytest.approx(-1e-3, rel=0.15)
    assert codes(broken)["interference"] == "error"


@pytest.mark.parametrize(("wheel", "tooth", "by"), [(1, 1, -1e-3), (2, 60, 1e-3), (2, 60, -1e-3)])
def test_outlines_alone_find_a_tooth_moved_by_1_um(wheel: Wheel, tooth: int, by: float) -> None:
    setup = mount(made("asymmetric").gears, about_tooth_1(8, 4e-4))
    assert codes(run(setup)) == {}
    found = run(replace(moved(setup, tooth, by, wheel), pairs=setup.pairs))
    finding = next(one for one in run_checks(KIND, found, {}) if one.code == "interference")
    assert f"tooth {tooth}" in finding.where
    assert finding.value == pytest.approx(1e-3 * math.cos(ALPHA), abs=4e-4)


def test_distances_at_which_a_ring_does_not_mesh_are_refused() -> None:
    """The key is the distance as measured; what is near 0 has no lower limit."""
    far = made("asymmetric").pair.center_distance + 4.1
    with pytest.raises(InfeasibleError, match="do not mesh") as caught:
        study(made("asymmetric").gears, MeshingSpec(center_distance=far))
    assert caught.value.limit == pytest.approx(far - 0.1, rel=1e-12)
    small = pair_of(ROUND, (60, 63), 1.0, gc.Rack(addendum=0.8))
    with pytest.raises(InfeasibleError, match="between 0 and 3.1 mm"):
        study(small.gears, MeshingSpec(center_distance=5.0))
    assert numbers(study(small.gears, MeshingSpec(center_distance=0.1, steps=4)))["complete"]


def test_columns_of_a_ring() -> None:
    """The pitch point is farther from the ring's shaft by A, and round parts count as concave."""
    result = made("asymmetric")
    table, distance = result.centrodes(361), result.pair.center_distance
    assert table["r2_mm"] - table["r1_mm"] == pytest.approx(distance, abs=1e-12)
    driven = np.radians(table["phi2_deg"])
    points = table["r2_mm"] * np.exp(1j * driven)
    assert table["x2_mm"] + 1j * table["y2_mm"] == pytest.approx(points, abs=1e-12)
    # the geometric curvature, positive where round, by finite differences of the points
    dx, dy = (np.gradient(table[axis], table["s_mm"]) for axis in ("x2_mm", "y2_mm"))
    bend = dx * np.gradient(dy, table["s_mm"]) - dy * np.gradient(dx, table["s_mm"])
    assert (-1.0 / table["rho2_mm"])[3:-3] == pytest.approx(bend[3:-3], abs=3e-4)
    assert bend.max() > 0.02
    found = result.contact(phases("asymmetric"), "drive")
    point = found["x_mm"] + 1j * found["y_mm"]
    assert found["contact_radius2_mm"] == pytest.approx(np.abs(point + distance), abs=1e-12)
    assert np.radians(found["phi2_deg"]) == pytest.approx(
        driven_angles("asymmetric", np.radians(found["phi1_deg"])), abs=1e-12
    )
    assert result.chart("curvature").lines[1].y.min() == pytest.approx(-bend.max(), abs=3e-4)
