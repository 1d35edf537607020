"""What lift a profile gives, against profiles whose lift is known in closed form.

The witness of followers is held against the same: it reads points as a smooth curve.
"""

from __future__ import annotations

import math
from collections.abc import Callable
from itertools import pairwise

import numpy as np
import pytest
from numpy.typing import NDArray

from gearcam.cams.follow import Followed, follow
from gearcam.numeric.bulges import flatten_bulges
from helpers_cams import Sizes
from helpers_sampling import few
from witness.cam_sweep import Follower
from witness.follower import Rest, rest

Array = NDArray[np.float64]
Plane = NDArray[np.complex128]

THETA = np.linspace(0.0, 2.0 * math.pi, 361)[:-1] + 1e-3
DENSE = 20000
RADIUS, MIDDLE = 40.0, 7.0 * np.exp(0.4j)

FOLLOWERS = {
    "flat": Sizes(flat=True, oscillating=False, start=33.0),
    "roller": Sizes(flat=False, oscillating=False, start=41.0, radius=8.0, offset=5.0),
    "needle": Sizes(flat=False, oscillating=False, start=33.0, radius=1e-4, offset=5.0),
    "point": Sizes(flat=False, oscillating=False, start=33.0, offset=-5.0),
    "dome": Sizes(flat=False, oscillating=False, start=333.0, radius=300.0, offset=5.0),
    "swinging face": Sizes(flat=True, oscillating=True, start=0.3, pivot=100.0, face_offset=6.0),
    "face off the pivot": Sizes(
        flat=True, oscillating=True, start=0.3, pivot=100.0, face_offset=-6.0
    ),
    "swinging roller": Sizes(
        flat=False, oscillating=True, start=0.4, pivot=100.0, arm=90.0, radius=8.0
    ),
    "swinging point": Sizes(flat=False, oscillating=True, start=0.4, pivot=100.0, arm=90.0),
    "swinging dome": Sizes(
        flat=False, oscillating=True, start=0.4, pivot=100.0, arm=120.0, radius=135.0
    ),
    "pivot within the cam": Sizes(
        flat=False, oscillating=True, start=0.4, pivot=25.0, arm=60.0, radius=8.0
    ),
}


def witness_of(m: Sizes) -> Follower:
    """The same follower for the witness; its size is not asked for."""
    return Follower(0.0, m.flat, m.oscillating, m.radius, m.offset, m.arm, m.pivot, m.face_offset)


def smooth(follower: Sizes, theta: Array, *pieces: Plane) -> Rest:
    """Where the witness rests on smooth pieces."""
    return rest(pieces, witness_of(follower), theta)


def lapped(points: Plane) -> Plane:
    """A smooth closed curve as one piece, its ends over each other."""
    return np.append(points, points[:8])


def turns(count: int, uneven: bool = False) -> Array:
    """Angles over a turn; uneven ones by up to 0.8 of a step."""
    u = np.arange(count, dtype=np.float64) + 0.3
    if uneven:
        u += np.random.default_rng(7).uniform(-0.4, 0.4, count)
    return u * (2.0 * math.pi / count)


def on_circle(follower: Sizes, theta: Array) -> Array:
    """Lift on a circle about MIDDLE, from where its middle stands."""
    middle = MIDDLE * np.exp(1j * theta)
    f, d, arm = follower, follower.pivot, follower.arm
    if not f.oscillating:
        if f.flat:
            return middle.imag + RADIUS - f.start
        return (
            middle.imag
            + np.sqrt((RADIUS + f.radius) ** 2 - (middle.real - f.offset) ** 2)
            - (f.start)
        )
    off = middle - d
    if f.flat:
        # the middle is C beyond the face: -X*sin(Psi) - Y*cos(Psi) = C, by t = tan(Psi/2)
        c = RADIUS + f.face_offset
        root = np.sqrt(np.abs(off) ** 2 - c**2)
        psi = np.stack([2.0 * np.arctan2(off.real + s * root, off.imag - c) for s in (-1, 1)])
        ahead = (off * np.conj(-np.exp(-1j * psi))).real > 0.0
        assert np.all(ahead.sum(axis=0) == 1)
        psi = np.where(ahead[0], psi[0], psi[1])
        return np.angle(np.exp(1j * psi)) - f.start
    # where two circles cross: along the line of their middles, then across it
    far = np.abs(off)
    along = (arm**2 + far**2 - (RADIUS + f.radius) ** 2) / (2.0 * far)
    across = np.sqrt(arm**2 - along**2)
    centre = d + off / far * (along - 1j * across)
    return np.arctan2(centre.imag, d - centre.real) - f.start


def in_mm(follower: Sizes, found: Followed | Rest, lift: Array) -> float:
    """Largest difference of lifts at the roller or, of a face, 100 mm from its pivot."""
    arm = (follower.arm or 100.0) if follower.oscillating else 1.0
    mine = found.lift if isinstance(found, Followed) else found.position - follower.start
    return float(np.abs(mine - lift).max()) * arm


@pytest.mark.parametrize("uneven", few([True, False]))
@pytest.mark.parametrize("name", few(FOLLOWERS, 3))
def test_a_smooth_circle_is_followed_to_rounding(name: str, uneven: bool) -> None:
    follower = FOLLOWERS[name]
    points = MIDDLE + RADIUS * np.exp(1j * turns(DENSE, uneven))
    found = smooth(follower, THETA, lapped(points))
    assert in_mm(follower, found, on_circle(follower, THETA)) < 1e-11
    assert np.abs(found.contact - MIDDLE) == pytest.approx(np.full(len(THETA), RADIUS), abs=1e-9)


@pytest.mark.parametrize("name", few(FOLLOWERS))
def test_a_polygon_converges_to_its_circle_with_the_second_order(name: str) -> None:
    follower, exact = FOLLOWERS[name], on_circle(FOLLOWERS[name], THETA)
    counts, errors = (250, 500, 1000, 2000), []
    for count in counts:
        points = MIDDLE + RADIUS * np.exp(1j * turns(count))
        followed = follow(points, follower.follower, THETA)
        # never too high: the polygon is within the circle
        assert np.max(followed.lift - exact) < 1e-12
        assert np.all(np.abs(followed.lift - exact) <= 1.02 * followed.error)
        errors.append(float(np.sqrt(np.mean((followed.lift - exact) ** 2))))
        assert followed.error.max() < 1.2 * np.abs(followed.lift - exact).max()
    slope = np.polyfit(np.log(counts), np.log(errors), 1)[0]
    assert slope == pytest.approx(-2.0, abs=0.1)


@pytest.mark.parametrize(("exact", "count", "within"), [(True, DENSE, 1e-11), (False, 4000, 5e-5)])
def test_an_ellipse_under_a_flat_face(exact: bool, count: int, within: float) -> None:
    a, b = 50.0, 20.0
    points = a * np.cos(turns(count)) + 1j * b * np.sin(turns(count))
    follower = Sizes(flat=True, oscillating=False, start=b)
    if exact:
        found = smooth(follower, THETA, lapped(points))
        lift, contact = found.position - b, found.contact
    else:
        followed = follow(points, follower.follower, THETA)
        lift, contact = followed.lift, followed.contact
    support = np.sqrt((a * np.sin(THETA)) ** 2 + (b * np.cos(THETA)) ** 2)
    assert np.abs(lift - (support - b)).max() < within
    # it touches where the ellipse's normal (x/a^2, y/b^2) is upright
    normal = (contact.real / a**2 + 1j * contact.imag / b**2) * np.exp(1j * THETA)
    allowed = 1e-7 if exact else 4.0 * math.pi / count * a / b
    assert np.abs(np.angle(normal / 1j)).max() < allowed


def square(half: float, count: int, shift: float) -> Plane:
    """Points on a square, `count` a side; its corners are among them if `shift` is 0."""
    corners = np.array([1 - 1j, 1 + 1j, -1 + 1j, -1 - 1j], dtype=np.complex128) * half
    way = (np.arange(4 * count) + shift) / count
    side, part = np.floor(way).astype(int), np.mod(way, 1.0)
    return corners[side] + part * (np.roll(corners, -1) - corners)[side]


def on_square(half: float, radius: float | None, theta: Array) -> Array:
    """Position of a flat face, or of a roller above the axis."""
    turned = np.abs(np.mod(theta + math.pi / 4, math.pi / 2) - math.pi / 4)
    if radius is None:
        return half * (np.cos(turned) + np.sin(turned))
    corner = half * math.sqrt(2.0) * np.exp(1j * (math.pi / 4 + turned))
    edge = corner.imag + np.sqrt(np.maximum(radius**2 - corner.real**2, 0.0))
    on_side = (half + radius) * np.tan(turned) <= half
    return np.where(on_side, (half + radius) / np.cos(turned), edge)


@pytest.mark.parametrize("radius", [None, 0.0, 5.0, 200.0])
@pytest.mark.parametrize(("exact", "count"), [(False, 2), (False, 50), (True, 50)])
def test_a_square_with_its_corners(radius: float | None, exact: bool, count: int) -> None:
    follower = Sizes(flat=radius is None, oscillating=False, start=30.0, radius=radius or 0.0)
    theta = np.append(THETA, [0.0, math.pi / 4, math.pi / 2])
    points = square(30.0, count, 0.0)
    if exact:
        sides = np.append(points, points[0])
        pieces = [sides[k * count : (k + 1) * count + 1] for k in range(4)]
        lift = smooth(follower, theta, *pieces).position - 30.0
    else:
        lift = follow(points, follower.follower, theta).lift
    assert lift == pytest.approx(on_square(30.0, radius, theta) - 30.0, abs=1e-11)


def test_corners_without_points_are_cut_off_a_polygon() -> None:
    """The control of the test above: the same points, read as a polygon, lose the corners."""
    followed = follow(square(30.0, 50, 0.5), FOLLOWERS["flat"].follower, THETA)
    assert np.abs(followed.lift + 33.0 - on_square(30.0, None, THETA)).max() > 0.1


# --- polylines with bulges ---------------------------------------------------------------------


@pytest.mark.parametrize("name", few(FOLLOWERS))
def test_two_arcs_are_a_circle(name: str) -> None:
    follower, exact = FOLLOWERS[name], on_circle(FOLLOWERS[name], THETA)
    ends = np.array([MIDDLE + RADIUS, MIDDLE - RADIUS])
    sagitta = 1e-4
    points = flatten_bulges(ends, np.ones(2), sagitta)
    chords = follow(points, follower.follower, THETA)
    off = in_mm(follower, chords, exact)
    assert 0.1 * sagitta < off < 5.0 * sagitta
    assert in_mm(follower, smooth(follower, THETA, lapped(points)), exact) < 1e-9


def nose(base: float, tip: float, apart: float) -> tuple[Plane, Array]:
    """A cam of two arcs and two straight flanks: corners and bulges."""
    beta = math.acos((base - tip) / apart)
    corners = [base * np.exp(-1j * beta), apart + tip * np.exp(-1j * beta)]
    corners += [np.conj(corner) for corner in reversed(corners)]
    bulges = [0.0, math.tan(beta / 2), 0.0, math.tan((math.pi - beta) / 2)]
    return np.array(corners), np.array(bulges)


def on_nose(base: float, tip: float, apart: float, radius: float, theta: Array) -> Array:
    """Position of a roller above the axis of such a cam."""
    place = apart * np.exp(1j * theta)
    room = (tip + radius) ** 2 - place.real**2
    result = np.where(room >= 0.0, place.imag + np.sqrt(np.maximum(room, 0.0)), 0.0)
    beta, length = (
        math.acos((base - tip) / apart),
        apart * math.sqrt(1 - ((base - tip) / apart) ** 2),
    )
    for side in (-1, 1):
        upright, aside = np.sin(theta + side * beta), -side * np.cos(theta + side * beta)
        with np.errstate(divide="ignore"):
            height = (base + radius) / upright
        # the foot of the centre on the flank, from where it leaves the base circle
        way = height * aside
        result = np.where(
            (upright > 0.0) & (way >= 0.0) & (way <= length), np.maximum(result, height), result
        )
    return np.maximum(result, base + radius)


@pytest.mark.parametrize("radius", [None, 0.0, 6.0, 500.0])
def test_arcs_and_straight_flanks(radius: float | None) -> None:
    """Jumps of the curvature, at points as a polyline has them."""
    shape = (30.0, 8.0, 35.0)
    corners, bulges = nose(*shape)
    follower = Sizes(flat=radius is None, oscillating=False, start=30.0, radius=radius or 0.0)
    if radius is None:
        exact = np.maximum(shape[0], shape[2] * np.sin(THETA) + shape[1])
    else:
        exact = on_nose(*shape, radius, THETA)
    points = flatten_bulges(corners, bulges, 1e-4, least=8)
    lift = follow(points, follower.follower, THETA).lift
    assert -5e-4 < np.min(lift + 30.0 - exact) < -1e-6
    assert np.max(lift + 30.0 - exact) < 1e-11
    z = points
    cuts = [int(np.abs(z - corner).argmin()) for corner in corners] + [len(z)]
    z = np.append(z, z[0])
    pieces = [z[low : high + 1] for low, high in pairwise(cuts)]
    assert np.abs(smooth(follower, THETA, *pieces).position - exact).max() < 1e-9


# --- cams that were made for a lift --------------------------------------------------------------


def parabolas(x: Array) -> tuple[Array, Array]:
    """Constant acceleration and deceleration: the curvature of the cam jumps."""
    late = x >= 0.5
    return np.where(late, 1 - 2 * (1 - x) ** 2, 2 * x**2), np.where(late, 4 * (1 - x), 4 * x)


def polynomial(x: Array) -> tuple[Array, Array]:
    """The 3-4-5 polynomial: the derivative of the curvature jumps."""
    return 10 * x**3 - 15 * x**4 + 6 * x**5, 30 * x**2 - 60 * x**3 + 30 * x**4


MotionFunction = Callable[[Array], tuple[Array, Array]]


def rise_and_return(rise: MotionFunction, theta: Array) -> tuple[Array, Array]:
    """10 mm up in 80 degrees, dwell to 150, down to 270, dwell; with the derivative."""
    theta = np.mod(theta, 2.0 * math.pi)
    knots = np.radians([0.0, 80.0, 150.0, 270.0])
    up = rise(np.clip(theta / knots[1], 0.0, 1.0))
    down = rise(np.clip((knots[3] - theta) / (knots[3] - knots[2]), 0.0, 1.0))
    rising = theta < knots[2]
    lift = 10.0 * np.where(rising, up[0], down[0])
    return lift, 10.0 * np.where(rising, up[1] / knots[1], -down[1] / (knots[3] - knots[2]))


def made_for(rise: MotionFunction, follower: Sizes, theta: Array) -> Plane:
    """The cam by its envelope: the contact of a flat face, or the inner parallel of the centres."""
    lift, slope = rise_and_return(rise, theta)
    if follower.flat:
        return np.exp(-1j * theta) * (slope + 1j * (follower.start + lift))
    centre = follower.offset + 1j * (follower.start + lift)
    way = 1j * slope - 1j * centre
    return np.exp(-1j * theta) * (centre - follower.radius * 1j * way / np.abs(way))


def share(uneven: bool) -> Array:
    """Places over a piece, its ends among them."""
    count = DENSE // 6
    u = turns(count, uneven) / (2.0 * math.pi)
    return np.concatenate([[0.0], u, [1.0]])


MADE = [
    Sizes(flat=True, oscillating=False, start=40.0),
    Sizes(flat=False, oscillating=False, start=29.0, radius=6.0, offset=8.0),
    Sizes(flat=False, oscillating=False, start=29.0, offset=8.0),
]


@pytest.mark.parametrize("follower", few(MADE))
@pytest.mark.parametrize("rise", few([parabolas, polynomial]))
@pytest.mark.parametrize("uneven", few([True, False]))
def test_a_cam_gives_the_lift_it_was_made_for(
    rise: MotionFunction, follower: Sizes, uneven: bool
) -> None:
    """At every degree, and at the knots and close to them, where no point lies."""
    near = np.random.default_rng(3).uniform(-1e-3, 1e-3, 100)
    knots = np.radians([0.0, 40.0, 80.0, 150.0, 210.0, 270.0])
    theta = np.concatenate([np.radians(np.arange(360.0)), (knots[:, None] + near).ravel()])
    ends = np.append(knots, 2.0 * math.pi)
    pieces = [
        made_for(rise, follower, np.clip(low + (high - low) * share(uneven), low, high - 1e-15))
        for low, high in pairwise(ends)
    ]
    lift = smooth(follower, theta, *pieces).position - follower.start
    assert np.abs(lift - rise_and_return(rise, theta)[0]).max() < 1e-11


@pytest.mark.parametrize("follower", MADE)
def test_a_mirrored_cam_and_a_wrong_direction_are_seen(follower: Sizes) -> None:
    """The control: rise and return differ, so that each mistake is far off."""
    exact = rise_and_return(polynomial, THETA)[0]
    points = made_for(polynomial, follower, turns(2000))
    assert np.abs(follow(points, follower.follower, THETA).lift - exact).max() < 1e-4
    mirrored = follow(np.conj(points), follower.follower, THETA).lift
    backwards = follow(points, follower.follower, -THETA).lift
    assert np.abs(mirrored - exact).max() > 1.0
    assert np.abs(backwards - exact).max() > 1.0
