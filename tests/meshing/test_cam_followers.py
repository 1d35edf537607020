"""From a motion to a profile and back: the follower on the finished cam moves as it was asked to.

On the exact curve the witness, which sees the points of its smooth pieces only, repeats the lift
within 1e-9 mm; on the polygon the program does within the chord tolerance: a profile that is off by
d along its normal lifts the follower by ``d/cos(alpha)``, over its lever if it swings. On an
undercut cam the witness does so wherever it does not rest on a corner, and there it loses what the
cam says.
"""

from __future__ import annotations

import math
from collections.abc import Callable
from dataclasses import replace
from functools import cache
from typing import Any

import numpy as np
import pytest

from gearcam.cams.disc import DiscCam
from gearcam.cams.follow import follow
from helpers_cams import (
    KINDS,
    TURN,
    Array,
    angles,
    cam,
    corners_of,
    lever,
    pieces_of,
    resting,
    sizes_of,
    stiffness,
    witness_of,
)
from helpers_sampling import few
from witness.cam_sweep import Exact, Follower, Motion, dot, mp
from witness.follower import rest

DEGREES = (80.0, 70.0, 110.0, 100.0)
CHORD = 1e-3
EXACT = 1e-9
THETA = angles(180)


def missing(made: DiscCam, follower: Follower, theta: Array, **changed: float) -> Array:
    """Lift asked for less that found by the witness on the exact curve, mm or rad.

    `changed` are other sizes of the follower, which begins at the place of this one all the same.
    """
    position = rest(pieces_of(made), replace(follower, **changed), theta).position
    return made.program.derivatives(theta, 0)[0] - (position - float(follower.start(mp)))


@pytest.mark.parametrize("clockwise", [False, True])
@pytest.mark.parametrize("kind", few(KINDS))
def test_the_exact_profile_gives_the_lift_asked_for(kind: str, clockwise: bool) -> None:
    made = cam(kind, "3-4-5", 8.0, DEGREES, clockwise=clockwise, tolerance=3e-4)
    assert made.corners == ()
    assert np.abs(missing(made, witness_of(kind), THETA)).max() * lever(made) < EXACT


@pytest.mark.parametrize("clockwise", [False, True])
@pytest.mark.parametrize("kind", KINDS)
def test_the_polygon_gives_it_within_the_tolerance(kind: str, clockwise: bool) -> None:
    made = cam(kind, "3-4-5", 8.0, DEGREES, clockwise=clockwise, tolerance=CHORD)
    found = follow(corners_of(made), made.follower, THETA)
    asked = made.program.derivatives(THETA, 0)[0]
    # in mm along the normal; the contact moves by half a chord, and alpha with it by a few percent
    off = (found.lift - asked) / stiffness(made, THETA)
    assert np.abs(off).max() <= 1.05 * made.contour.chord_error
    assert np.abs(off).max() >= 0.5 * made.contour.chord_error
    # a vertex lies on the curve: the follower falls between them, or is lifted on concave parts
    assert off.min() < 0.0


@pytest.mark.parametrize("kind", few(KINDS, 3))
def test_a_cam_read_backwards_is_seen(kind: str) -> None:
    made = cam(kind, "3-4-5", 8.0, DEGREES)
    follower, pieces = witness_of(kind), [-np.conj(piece) for piece in pieces_of(made)]
    lift = rest(pieces, follower, THETA).position - float(follower.start(mp))
    off = lift - made.program.derivatives(THETA, 0)[0]
    assert np.abs(off).max() * lever(made) > 1.0


@pytest.mark.parametrize("kind", ["point", "roller, offset", "roller, offset back", "domed"])
def test_the_sign_of_the_offset_is_seen(kind: str) -> None:
    made = cam(kind, "3-4-5", 8.0, DEGREES)
    follower = witness_of(kind)
    assert np.abs(missing(made, follower, THETA, offset=-follower.offset)).max() > 0.5


@pytest.mark.parametrize("kind", ["swinging face, near", "swinging face, far"])
def test_the_sign_of_the_face_offset_is_seen(kind: str) -> None:
    made = cam(kind, "3-4-5", 8.0, DEGREES)
    follower = witness_of(kind)
    assert np.abs(missing(made, follower, THETA, face=-follower.face)).max() * lever(made) > 5.0


@pytest.mark.parametrize(
    ("kind", "size"),
    [
        ("roller", "radius"),
        ("roller, offset", "radius"),
        ("domed", "radius"),
        ("swinging roller", "radius"),
        ("swinging dome", "radius"),
        ("swinging face", "face"),
        ("swinging face, far", "face"),
    ],
)
def test_a_micrometre_is_seen(kind: str, size: str) -> None:
    """A face that is 1 um larger lifts by 1 um over cos(alpha), to first order."""
    made = cam(kind, "3-4-5", 8.0, DEGREES)
    follower = witness_of(kind)
    rise = -missing(made, follower, THETA, **{size: getattr(follower, size) + CHORD})
    np.testing.assert_allclose(rise, CHORD * stiffness(made, THETA), rtol=2e-3)


# --- undercut ------------------------------------------------------------------------------------

Case = tuple[str, str, float, tuple[float, float, float, float], dict[str, Any]]
STEEP = (60.0, 90.0, 60.0, 150.0)

UNDERCUT: dict[str, Case] = {
    "roller": ("roller, offset", "cycloidal", 10.0, STEEP, {"roller_radius": 22.0}),
    "roller larger than the curve": ("roller", "cycloidal", 10.0, STEEP, {"roller_radius": 29.0}),
    "face": ("flat", "cycloidal", 10.0, STEEP, {"base_radius": 20.0}),
    "swinging roller": (
        "swinging roller",
        "cycloidal",
        12.0,
        (45.0, 90.0, 45.0, 180.0),
        {"roller_radius": 25.0},
    ),
    "swinging face": ("swinging face", "cycloidal", 12.0, STEEP, {"base_radius": 40.0}),
    "swinging face, near": ("swinging face, near", "cycloidal", 14.0, STEEP, {"base_radius": 40.0}),
}
CORNERS: dict[str, Case] = {
    "roller at a shock": ("roller, offset back", "constant-velocity", 10.0, STEEP, {}),
    "face at a shock": ("flat", "constant-velocity", 10.0, STEEP, {}),
    "swinging roller at a shock": ("swinging roller", "constant-velocity", 12.0, STEEP, {}),
    "swinging face at a shock": ("swinging face, far", "constant-velocity", 12.0, STEEP, {}),
}


@cache
def built(name: str, clockwise: bool = False) -> DiscCam:
    kind, law, lift, degrees, changed = {**UNDERCUT, **CORNERS}[name]
    tolerance = 3e-5 if name == "roller larger than the curve" else 1e-4
    return cam(kind, law, lift, degrees, tolerance=tolerance, clockwise=clockwise, **changed)


def margin(case: Case) -> Callable[[Any], Any]:
    """Negative where undercut, by differences: 000 (3.11), with ``0 < rho < r``, and (3.13)."""
    kind, law, lift, degrees, changed = case
    exact = Exact(
        witness_of(kind, **changed), Motion(law, lift, degrees, kind.startswith("swinging"))
    )

    def face(theta: Any) -> Any:
        tangent = exact.follower.normal(exact.position(theta), mp) * mp.exp(-1j * theta) / 1j
        return dot(tangent, mp.diff(exact.contact, theta))

    def circle(theta: Any) -> Any:
        return 1 / mp.mpf(exact.follower.radius) - exact.curvature(exact.pitch, theta)

    return face if exact.follower.flat else circle


@pytest.mark.parametrize("name", few(UNDERCUT, 3))
def test_undercut_is_where_the_radius_changes_its_sign(name: str) -> None:
    """Sign changes of a fine scan, bisected to 1e-10 rad."""
    case = UNDERCUT[name]
    made, up, down = built(name), math.radians(case[3][0]), math.radians(sum(case[3][:3]))
    with mp.workdps(16):
        far = margin(case)
        ends = []
        for low, high in ((0.0, up), (math.radians(sum(case[3][:2])), down)):
            grid = np.linspace(low + 1e-3, high - 1e-3, 11)
            signs = [far(mp.mpf(float(t))) > 0 for t in grid]
            changes = [k for k in range(len(grid) - 1) if signs[k] != signs[k + 1]]
            ends += [bisected(far, grid[k], grid[k + 1]) for k in changes]
    found = [end for stretch in made.undercut for end in stretch]
    assert len(ends) == 2 * len(made.undercut) >= 2
    assert found == pytest.approx(ends, abs=1e-9)


def bisected(far: Callable[[Any], Any], low: float, high: float) -> float:
    above = far(mp.mpf(low)) > 0
    while high - low > 1e-10:
        middle = 0.5 * (low + high)
        low, high = (middle, high) if (far(mp.mpf(middle)) > 0) == above else (low, middle)
    return 0.5 * (low + high)


@pytest.mark.parametrize("name", CORNERS)
def test_a_velocity_that_falls_undercuts_at_a_point(name: str) -> None:
    """Where the rise ends and where the return begins; where it grows the follower rolls."""
    case = CORNERS[name]
    made = built(name)
    falls = [math.radians(case[3][0]), math.radians(sum(case[3][:2]))]
    assert made.undercut == [pytest.approx((at, at), abs=1e-14) for at in falls]
    assert len(made.corners) == 2
    for corner, at in zip(made.corners, falls, strict=True):
        assert corner.before < at < corner.after


@pytest.mark.parametrize(
    ("name", "clockwise"),
    [
        *few([(name, False) for name in (*UNDERCUT, *CORNERS)], 3),
        ("roller", True),
        ("swinging face", True),
    ],
)
def test_a_trimmed_cam_loses_what_it_says(name: str, clockwise: bool) -> None:
    made, case = built(name, clockwise), {**UNDERCUT, **CORNERS}[name]
    follower = witness_of(case[0], **case[4])
    off, rests = missing(made, follower, THETA) * lever(made), resting(made, THETA)
    assert rests.any()
    assert np.abs(off[~rests]).max() < EXACT
    assert off.min() > -EXACT
    lost = [loss.value * lever(made) for loss in made.lost]
    assert off.max() <= max(lost) + EXACT
    assert max(lost) == pytest.approx(made.shortfall * lever(made), rel=1e-15)
    at = np.array([loss.theta for loss in made.lost])
    np.testing.assert_allclose(
        missing(made, follower, at) * lever(made), lost, rtol=0.0, atol=EXACT
    )
    # it is the largest: the lift beside it is lost less
    for turn in (-1e-3, 1e-3):
        assert np.all(missing(made, follower, at + turn) * lever(made) < np.array(lost))


@pytest.mark.parametrize("name", [*UNDERCUT, *CORNERS])
def test_a_corner_is_drawn_from_both_its_sides(name: str) -> None:
    """At both angles the follower of the lift asked for touches the corner, and nothing is lost."""
    made = built(name)
    m = sizes_of(made.follower)
    for corner in made.corners:
        both = np.array([corner.before, corner.after])
        position = m.start + made.program.derivatives(both, 0)[0]
        seen = corner.point * np.exp(1j * both)
        if m.flat:
            turned = seen * np.exp(1j * position) if m.oscillating else seen
            height = m.pivot * np.sin(position) - m.face_offset if m.oscillating else position
            gap = height - turned.imag
        else:
            centre = (
                m.pivot - m.arm * np.exp(-1j * position)
                if m.oscillating
                else m.offset + 1j * position
            )
            gap = np.abs(seen - centre) - m.radius
        assert np.abs(gap).max() < 1e-10
        assert 0.0 < (corner.after - corner.before) % TURN < math.pi


def test_an_undercut_cam_is_smaller_than_its_curve() -> None:
    """The control: without trimming, the loops would count twice or negatively."""
    made = built("roller")
    assert made.contour.polygon.is_valid
    assert made.size.area == pytest.approx(made.contour.moments.area, rel=1e-9)
    assert made.profile_radius[0] == 0.0
