"""A wheel within a ring, turned: overlap of outlines, as designed, as mounted, and made wrong."""

from __future__ import annotations

import math
from dataclasses import replace
from functools import cache

import numpy as np
import pytest
import shapely

import gearcam as gc
from gearcam.base.errors import InfeasibleError
from gearcam.base.findings import run_checks
from gearcam.base.tolerances import DEFAULT
from gearcam.gears.contact import COAST, DRIVE
from gearcam.gears.outline import build_outline
from gearcam.gears.track import Wheel
from gearcam.meshing.checks import KIND
from gearcam.meshing.half_teeth import half_teeth
from gearcam.meshing.numbers import numbers
from gearcam.meshing.overlap import Turning
from gearcam.meshing.settings import MeshingSpec
from gearcam.meshing.study import Meshing, mount, run, study
from helpers_pairs import OVERCLOSURE, moved
from helpers_rings import (
    ALPHA,
    CLEAN,
    DEEP,
    LAWS,
    ROUND,
    Array,
    driven_angles,
    made,
    pair_of,
)
from helpers_sampling import few

FEW = 24
"""Steps of a turn that tell how a pair is mounted."""


@cache
def studied(name: str, more: float = 0.0, steps: int = 120, ahead: float = OVERCLOSURE) -> Meshing:
    distance = made(name).pair.center_distance + more
    spec = MeshingSpec(steps=steps, overclosure=ahead, center_distance=distance)
    return study(made(name).gears, spec)


def codes(meshing: Meshing) -> dict[str, str]:
    return {found.code: found.severity for found in run_checks(KIND, meshing, {})}


@pytest.mark.parametrize(
    ("name", "ahead"),
    [
        *few((name, OVERCLOSURE) for name in CLEAN),
        ("asymmetric", -OVERCLOSURE),
        *(pytest.param(name, -OVERCLOSURE, marks=pytest.mark.slow) for name in CLEAN[:-1]),
    ],
)
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


@pytest.mark.parametrize("name", few(["asymmetric", "one lobe"]))
def test_mounted_farther_interferes_and_nearer_plays(name: str) -> None:
    result = made(name)
    far, near = studied(name, 0.1, FEW), studied(name, -0.1, FEW)
    assert numbers(far)["interference_steps"] == FEW
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
    both = [studied(name, more, FEW).every("backlash") for more in (-0.01, 0.01)]
    assert np.all(np.abs((both[0] - both[1]) / expected - 1.0) < 1e-3)
    # and the outlines say the same: turned by all of the play, the other flanks touch
    turning, lead = near.setup.turning, near.every("lead")
    turns = near.every("backlash") / near.every("along")
    for share, free in ((0.999, True), (1.001, False)):
        found = turning.overlaps(phi1, 0.0, lead + share * turns)
        touched = np.unique(found.step[found.depth > near.setup.noise])
        assert (len(touched) == 0) == free


def whole_areas(name: str, distance: complex, angles: Array, lead: float) -> list[float]:
    """Overlap of the whole wheel with all that lies outside the ring's outline."""
    areas = []
    for phi1, driven in zip(angles.tolist(), driven_angles(name, angles).tolist(), strict=True):
        one = made(name).gear1.outline @ [1, 1j] * np.exp(-1j * (phi1 + OVERCLOSURE))
        two = made(name).gear2.outline @ [1, 1j] * np.exp(-1j * (driven + lead)) - distance
        wheel, hole = (shapely.Polygon(np.stack([z.real, z.imag], axis=1)) for z in (one, two))
        areas.append(wheel.difference(hole).area)
    return areas


@pytest.mark.parametrize("name", LAWS)
@pytest.mark.parametrize("more", few([-0.03, 0.0, 0.03, 0.4], 4))
@pytest.mark.parametrize("count", few([3, 9]))
def test_all_overlap_is_that_of_the_whole_outlines(name: str, more: float, count: int) -> None:
    """In place, mounted far and near (in modules), and turned by up to half a tooth."""
    result, module = made(name), made(name).pair.module
    first, second = (half_teeth(gear.profile) for gear in result.gears)
    distance = result.pair.center_distance + more * module
    turning = Turning(rolling=result.pair.rolling, driver=first, driven=second, distance=-distance)
    angles = np.radians(np.arange(count) * 360.0 / count + 0.3)
    most = 0.0
    for lead in np.array([0.0, 0.01, -0.01, 0.2, -0.4]) * module / distance:
        found = turning.overlaps(angles, OVERCLOSURE, lead)
        areas = np.bincount(found.step, found.area, minlength=len(angles))
        expected = whole_areas(name, distance, angles, lead)
        assert areas == pytest.approx(expected, rel=1e-9, abs=1e-12 * module**2)
        most = max(most, *expected)
    assert most > 0.1 * module**2


@pytest.mark.slow
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
        found[teeth] = study(gears, MeshingSpec(steps=120))
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
    meshing = studied("two lobes")
    (finding,) = (f for f in run_checks(KIND, meshing, {}) if f.code == "interference")
    assert finding.value is not None
    assert finding.value > 0.1
    hit = meshing.every("interferes").astype(bool)
    assert 20 <= np.count_nonzero(hit) <= 60
    some, hit = meshing.phi1[::4], hit[::4]
    areas = np.array(whole_areas("two lobes", 18.96124240457442, some, 0.0))
    assert areas[hit].min() > 1e-4
    explained = 4.0 * OVERCLOSURE * 60.0  # of each pair of flanks: depth times less than 1 mm
    assert areas[~hit].max() < explained


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


@pytest.mark.parametrize(
    ("wheel", "tooth", "by"), few([(1, 1, -1e-3), (2, 60, -1e-3), (2, 60, 1e-3)], 3)
)
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
    with pytest.raises(InfeasibleError, match=r"between 0 and 3\.1 mm"):
        study(small.gears, MeshingSpec(center_distance=5.0))
    assert numbers(study(small.gears, MeshingSpec(center_distance=0.1, steps=4)))["complete"]
