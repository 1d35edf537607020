"""How profiles are followed: nothing higher is missed, and what cannot be followed is refused."""

from __future__ import annotations

import math
from dataclasses import replace
from itertools import pairwise

import numpy as np
import pytest
from numpy.typing import NDArray

from gearcam.base.errors import InfeasibleError
from gearcam.cams.carriers import Sliding
from gearcam.cams.follow import follow, profile_points
from gearcam.cams.followers import Arm
from gearcam.numeric.arrays import as_pairs
from helpers_cams import Sizes
from helpers_curves import distances
from helpers_sampling import few

Array = NDArray[np.float64]
Plane = NDArray[np.complex128]

FLAT = Sizes(flat=True, oscillating=False, start=30.0)
ROLLER = Sizes(flat=False, oscillating=False, start=36.0, radius=6.0, offset=4.0)
SWINGING = Sizes(flat=False, oscillating=True, start=0.4, pivot=100.0, arm=90.0, radius=8.0)


def circle(count: int, radius: float = 30.0, middle: complex = 0.0) -> Plane:
    u = np.arange(count, dtype=np.float64) * (2.0 * math.pi / count)
    return np.asarray(middle + radius * np.exp(1j * u), dtype=np.complex128)


def wavy(count: int, seed: int) -> Plane:
    """A star-shaped profile with hollows, points at uneven steps."""
    rng = np.random.default_rng(seed)
    u = (np.arange(count) + rng.uniform(-0.45, 0.45, count)) * (2.0 * math.pi / count)
    size = np.full(count, 40.0)
    for k in range(1, 8):
        size += rng.normal() * 8.0 / k * np.cos(k * u + rng.uniform(0.0, 6.0))
    return np.maximum(size, 10.0) * np.exp(1j * u)


def followers(seed: int, size: float) -> list[Sizes]:
    """One of each kind, with random numbers."""
    rng = np.random.default_rng(seed)
    offset, radius, face = rng.uniform(-9.0, 9.0), rng.uniform(0.5, 20.0), rng.uniform(-15.0, 15.0)
    moving = {"oscillating": False, "start": 0.0}
    swinging = {"oscillating": True, "start": 0.0}
    return [
        Sizes(flat=True, **moving),
        Sizes(flat=False, radius=radius, offset=offset, **moving),
        Sizes(flat=False, radius=500.0, offset=offset, **moving),
        Sizes(flat=False, offset=offset, **moving),
        Sizes(flat=True, pivot=1.5 * size, face_offset=face, **swinging),
        Sizes(flat=False, pivot=1.5 * size, arm=1.4 * size, radius=radius, **swinging),
        Sizes(flat=False, pivot=2.0 * size, arm=2.5 * size, radius=3.0 * size, **swinging),
        Sizes(flat=False, pivot=1.5 * size, arm=1.4 * size, **swinging),
        # pivots as near as they may be
        Sizes(flat=True, pivot=1.01 * size + abs(face), face_offset=face, **swinging),
        Sizes(flat=False, pivot=1.51 * size, arm=2.5 * size, radius=3.0 * size, **swinging),
    ]


def highest(points: Plane, mechanism: Sizes, theta: float, parts: int) -> float:
    """Highest touch over the points of the polygon and of each chord's `parts`, one by one."""
    share = np.arange(parts) / parts
    z = (points[:, None] + share * (np.roll(points, -1) - points)[:, None]).ravel()
    z = z * np.exp(1j * theta)
    x, y = z.real - mechanism.offset, z.imag
    if not mechanism.oscillating:
        if mechanism.flat:
            return float(y.max())
        if mechanism.radius == 0.0:
            after, top = np.roll(x, -1), np.roll(y, -1)
            cross = x * after < 0.0
            return float((y + (top - y) * x / (x - after))[cross].max())
        near = np.abs(x) <= mechanism.radius
        return float((y[near] + np.sqrt(mechanism.radius**2 - x[near] ** 2)).max())
    far = np.abs(z - mechanism.pivot)
    psi = np.arctan2(y, mechanism.pivot - z.real)
    if mechanism.flat:
        return float((psi + np.arcsin(mechanism.face_offset / far)).max())
    if mechanism.radius == 0.0:
        miss, after = far - mechanism.arm, np.roll(far, -1) - mechanism.arm
        cross = miss * after < 0.0
        share = miss / (miss - after)
        return float((psi + (np.roll(psi, -1) - psi) * share)[cross].max())
    cosine = (mechanism.arm**2 + far**2 - mechanism.radius**2) / (2.0 * mechanism.arm * far)
    near = np.abs(cosine) <= 1.0
    return float((psi[near] + np.arccos(cosine[near])).max())


@pytest.mark.parametrize("seed", few(range(24), 5))
def test_nothing_higher_is_missed(seed: int) -> None:
    """Against every chord of the profile, in parts: only blocks that cannot matter are left out."""
    points = wavy((8, 30, 150, 700)[seed % 4], seed)
    size = float(np.abs(points).max())
    theta = np.random.default_rng(seed).uniform(0.0, 2.0 * math.pi, 9)
    parts = 200
    step = float(np.abs(np.roll(points, -1) - points).max()) / parts
    for mechanism in followers(seed, size):
        lift = follow(points, mechanism.follower, theta).lift
        brute = np.array([highest(points, mechanism, float(t), parts) for t in theta])
        lever = (mechanism.arm or size) if mechanism.oscillating else 1.0
        # where the path of a swinging point crosses is interpolated
        off = step**2 if mechanism.arm and not mechanism.radius else 1e-9
        assert np.all(lift >= brute - off / lever)
        # between two parts a round face dips by step^2/(8*r), more where the touch is oblique
        dip = 2.0 * step**2 / mechanism.radius if mechanism.radius else off
        assert np.all(lift <= brute + (dip + 1e-9) / lever)


@pytest.mark.parametrize("mechanism", [ROLLER, SWINGING])
def test_the_roller_touches_and_does_not_overlap(mechanism: Sizes) -> None:
    """Distance of its centre from the whole profile: its radius, reached at the contact."""
    points, theta = wavy(400, 3), np.linspace(0.0, 6.0, 60)
    followed = follow(points, mechanism.follower, theta)
    position = followed.lift + mechanism.start
    if mechanism.oscillating:
        fixed = mechanism.pivot - mechanism.arm * np.exp(-1j * position)
    else:
        fixed = mechanism.offset + 1j * position
    centre = np.asarray(fixed * np.exp(-1j * theta), dtype=np.complex128)
    away = distances(centre, points, np.zeros(len(points)))
    assert away == pytest.approx(np.full(60, mechanism.radius), abs=1e-10)
    assert np.abs(centre - followed.contact) == pytest.approx(
        np.full(60, mechanism.radius), abs=1e-10
    )
    assert distances(followed.contact, points, np.zeros(len(points))) == pytest.approx(
        np.zeros(60), abs=1e-10
    )


def test_two_contacts_at_once() -> None:
    """A roller over the notch between two discs rests on both."""
    apart, radius = 20.0, 30.0
    half = math.acos(apart / radius)
    right = apart + radius * np.exp(1j * np.linspace(half - math.pi, math.pi - half, 4001))
    points = np.concatenate([right[:-1], -right[:-1]])
    roller = Sizes(flat=False, oscillating=False, start=0.0, radius=10.0)
    theta = np.array([-0.1, -1e-7, 0.0, 1e-7, 0.1])
    middle = np.asarray(apart * np.exp(1j * np.abs(theta)), dtype=np.complex128)
    exact = middle.imag + np.sqrt((radius + 10.0) ** 2 - middle.real**2)
    followed = follow(points, roller.follower, theta)
    assert followed.lift == pytest.approx(exact, abs=3e-5)
    sides = (followed.contact * np.exp(1j * theta)).real
    assert sides[0] < -1.0
    assert sides[-1] > 1.0


def test_order_repeats_and_shape_of_the_points_do_not_matter() -> None:
    points, theta = wavy(300, 5), np.linspace(0.0, 6.0, 25)
    lift = follow(points, ROLLER.follower, theta).lift
    closed = np.append(points, points[0])
    for same in (
        points[::-1],
        np.roll(points, 100),
        closed,
        np.repeat(points, 2),
        as_pairs(points),
    ):
        assert follow(same, ROLLER.follower, theta).lift == pytest.approx(lift, abs=1e-9)


def test_the_stated_error_holds_on_a_coarse_ellipse() -> None:
    u = np.arange(60) * (2.0 * math.pi / 60)
    theta = np.linspace(0.0, math.pi, 400)
    exact = np.sqrt((50.0 * np.sin(theta)) ** 2 + (35.0 * np.cos(theta)) ** 2) - 30.0
    followed = follow(50.0 * np.cos(u) + 35.0j * np.sin(u), FLAT.follower, theta)
    off = np.abs(followed.lift - exact)
    assert 1e-8 < off.max() < 0.1
    assert np.all(off <= 1.1 * followed.error)
    assert followed.error.max() < 2.0 * off.max()


def test_one_angle_and_none() -> None:
    assert follow(circle(100), FLAT.follower, 0.0).lift == pytest.approx([0.0], abs=1e-9)
    assert follow(circle(100), FLAT.follower, []).lift.shape == (0,)


@pytest.mark.parametrize(
    ("points", "words"),
    [
        (circle(7), "too few points; value 7 points, limit 8 points"),
        (np.repeat(circle(7), 3), "too few points; value 7"),
        (np.append(circle(9), np.nan), "not finite (point 9)"),
        (np.append(circle(9), complex(0.0, np.inf)), "not finite (point 9)"),
        (circle(50, middle=31.0), "does not go around the cam's axis once; value"),
        (circle(50) ** 2, "does not go around the cam's axis once; value 2 turns"),
        (np.concatenate([circle(50)[10:], [0.0]]), "does not go around the cam's axis once"),
    ],
)
def test_what_is_no_profile_is_refused(points: Plane, words: str) -> None:
    with pytest.raises(InfeasibleError) as caught:
        follow(points, FLAT.follower, [0.0])
    assert words in str(caught.value)


def test_a_follower_that_meets_nothing_is_refused_at_its_angle() -> None:
    """Its axis passes beside the cam, but for the tip of it."""
    beside = Sizes(flat=False, oscillating=False, start=0.0, radius=2.0, offset=45.0)
    points = circle(200, 30.0, 15.0)
    assert follow(points, beside.follower, [0.0]).lift[0] < 20.0
    with pytest.raises(InfeasibleError, match=r"meets no point.*\(cam angle\); value 90 deg"):
        follow(points, beside.follower, np.radians([0.0, 90.0, 180.0]))


@pytest.mark.parametrize(
    ("mechanism", "limit"),
    [
        (Sizes(flat=True, oscillating=True, start=0, pivot=33, face_offset=4), 29.0),
        (Sizes(flat=False, oscillating=True, start=0, pivot=20, arm=15, radius=6), 29.0),
    ],
)
def test_a_cam_that_reaches_past_the_pivot_is_refused(mechanism: Sizes, limit: float) -> None:
    with pytest.raises(InfeasibleError, match="past the follower's pivot") as caught:
        follow(circle(100), mechanism.follower, [0.0])
    assert caught.value.value == pytest.approx(30.0)
    assert caught.value.limit == pytest.approx(limit)


def test_heights_over_chords_are_those_of_a_circle() -> None:
    points = profile_points(circle(500))
    assert points.sagitta == pytest.approx(
        np.full(500, 30.0 * (1.0 - math.cos(math.pi / 500))), rel=1e-4
    )


def test_of_both_ends_the_larger_curvature_counts() -> None:
    """Chords beside a corner of a square: its turn over a chord's length, times length^2/8."""
    side = np.linspace(-30.0, 30.0, 5)[:-1] - 30.0j
    points = np.concatenate([side, 1j * side, -side, -1j * side]).astype(np.complex128)
    beside = 15.0 * (0.5 * math.pi) / 8.0
    assert profile_points(points).sagitta == pytest.approx(np.tile([beside, 0, 0, beside], 4))


def test_a_gap_in_the_points_stands_off_as_its_circle() -> None:
    """A long chord whose turns are larger than those beside it is bent."""
    points = profile_points(np.delete(circle(500), np.s_[1:8]))
    assert points.sagitta.max() == pytest.approx(
        30.0 * (1.0 - math.cos(math.pi * 8 / 500)), rel=0.1
    )


def test_a_long_chord_between_even_turns_is_straight() -> None:
    """A stadium: its sides stand off no more than the chords of its ends."""
    end = 30.0 + 20.0 * np.exp(1j * np.linspace(-0.5 * math.pi, 0.5 * math.pi, 60))
    sagitta = 20.0 * (1.0 - math.cos(math.pi / 118))
    points = profile_points(np.concatenate([end, -end]))
    assert np.abs(points.chords).max() == pytest.approx(60.0)
    assert points.sagitta.max() == pytest.approx(sagitta, rel=0.01)


@pytest.mark.parametrize("mechanism", [ROLLER, SWINGING, replace(ROLLER, offset=-9.0)])
def test_a_roller_within_a_wall_of_circles(mechanism: Sizes) -> None:
    """Its centre stands on a smaller circle, by the law of cosines; the far side does not count."""
    middle, size = 3.0 - 2.0j, 60.0
    theta = np.linspace(0.0, 2.0 * math.pi, 60)
    m = mechanism
    seen = follow(circle(20000, size, middle), m.follower, theta, side=-1)
    place, reach = middle * np.exp(1j * theta), size - mechanism.radius
    if m.oscillating:
        toward = m.pivot - place
        cosine = (m.arm**2 + np.abs(toward) ** 2 - reach**2) / (2.0 * m.arm * np.abs(toward))
        expected = np.arccos(cosine) - np.angle(toward)
    else:
        expected = place.imag + np.sqrt(reach**2 - (m.offset - place.real) ** 2)
    np.testing.assert_allclose(seen.lift, expected - m.start, atol=2e-6)
    assert np.all(np.abs(seen.lift - (expected - m.start)) <= 1.1 * seen.error)
    np.testing.assert_allclose(np.abs(seen.contact - middle), size, atol=2e-6)
    np.testing.assert_allclose(seen.theta, theta)


@pytest.mark.parametrize("radius", [0.0, 4.0])
def test_an_arm_does_not_rest_on_what_lies_behind_its_pivot(radius: float) -> None:
    """The end of a plate slides past the pivot, which stands lower: it counts before it only."""
    follower = Arm(start=0.0, pivot=-66.0 - 40.0j, arm=56.0, radius=radius, hand=-1)
    corners = np.array([110.0, -300.0, -300.0 - 120.0j, 110.0 - 120.0j, 110.0])
    edge = np.concatenate([np.linspace(*ends, 5)[:-1] for ends in pairwise(corners)])
    seen = follow(edge, follower, np.linspace(0.0, 9.0, 9), carrier=Sliding(200.0))
    np.testing.assert_allclose(seen.lift, math.asin((40.0 + radius) / 56.0), atol=1e-12)


def test_every_chord_is_in_a_disc_around_its_block() -> None:
    points = profile_points(wavy(333, 8))
    index, middle, radius = points.blocks
    assert set(index.ravel()) == set(range(333))
    for place in (points.points, points.points + points.chords):
        assert np.all(np.abs(place[index] - middle[:, None]) <= radius[:, None])
