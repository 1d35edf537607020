"""The witnesses themselves: the oracle gives published numbers, the sweeps the exact involute."""

from __future__ import annotations

from typing import Any

import numpy as np
import pytest
import shapely
from numpy.typing import NDArray

from helpers_sampling import few
from witness import laws, oracle, shaper, sweep
from witness.kinematics import Basic, Rolling
from witness.oracle import mp

UNDERCUT = mp.sin(mp.pi / 9) ** 2
"""Largest module over smallest radius without undercut, 20 degrees, addendum 1."""


def printed(value: object, text: str) -> bool:
    """Whether a number rounds to the digits printed."""
    places = len(text.partition(".")[2])
    return abs(mp.mpf(value) - mp.mpf(text)) <= mp.mpf(10) ** -places / 2


# The table of the source's numbers has 59.7386 for the three-phase driver: a sample beside the
# minimum. Finite differences of positions in 40 digits give 59.738483 at phi1 = 218.259 degrees.
NAIL = {
    "two": (
        laws.NAIL_TWO,
        "556.7768355399",
        "4.9229880875",
        "68.0793",
        "144.4514",
        "29.2869",
        "3.4259",
    ),
    "three": (
        laws.NAIL_THREE,
        "561.0187056128",
        "4.9604944536",
        "59.7385",
        "88.9888",
        "26.0013",
        "3.0416",
    ),
}


@pytest.mark.parametrize("name", few(NAIL))
def test_nail_machine(name: str) -> None:
    law, length, module, convex, concave, driven, limit = NAIL[name]
    pair = oracle.Pair(law, mp.mpf(180))
    assert abs(pair.driven_angle(2 * mp.pi) - 2 * mp.pi) < 1e-30
    assert printed(pair.length, length)
    assert printed(pair.module(36), module)
    assert printed(1 / pair.largest_curvature(1), convex)
    assert printed(1 / pair.largest_curvature(1, -1), concave)
    sharpest = pair.largest_curvature(2)
    assert printed(1 / sharpest, driven)
    assert printed(UNDERCUT / sharpest, limit)


def test_closure_gives_the_third_ratio() -> None:
    assert printed(oracle.closing_ratio([160, 110, 90], [1.6, 0.4, None, 1.6]), "1.06")
    assert printed(oracle.closing_ratio([160, 110, 90], [1.62, 0.4, None, 1.62]), "1.035")


@pytest.mark.parametrize(("e", "text"), few([(0.3, "41.9606757804"), (0.5, "43.8870922799")]))
def test_ellipse(e: float, text: str) -> None:
    pair = oracle.with_module(laws.ellipse(e), 1, 41)
    assert printed(pair.distance, text)
    # tan(phi2/2) = (1-e)/(1+e)*tan(phi1/2), perimeter 4aE(e), smallest radius a(1-e^2), A = 2a
    e_exact, a = mp.mpf(repr(e)), pair.distance / 2
    angle = mp.mpf("1.1")
    exact = 2 * mp.atan((1 - e_exact) / (1 + e_exact) * mp.tan(angle / 2))
    assert abs(pair.driven_angle(angle) - exact) < 1e-28
    assert abs(pair.length - 4 * a * mp.ellipe(e_exact**2)) < 1e-26
    assert abs(1 / pair.largest_curvature(1) - a * (1 - e_exact**2)) < 1e-20


@pytest.mark.parametrize(("e", "text"), few([(0.3, "18.358"), (0.0, "17.097"), (0.5, "21.297")], 3))
def test_fewest_teeth_of_an_ellipse(e: float, text: str) -> None:
    pair = oracle.Pair(laws.ellipse(e), mp.mpf(2))
    assert printed(pair.length * pair.largest_curvature(1) / (mp.pi * UNDERCUT), text)


@pytest.mark.parametrize(
    ("offset", "teeth", "ratio", "distance"),
    few([(0.1, None, "2.00498446026775", None), (0.3, 24, "2.04379288568712", "24.5255146282")]),
)
def test_eccentric_circle(
    offset: float, teeth: int | None, ratio: str, distance: str | None
) -> None:
    shape = laws.eccentric_circle(offset)
    over_radius = oracle.closing_distance(shape, 2.02)
    assert printed(over_radius, ratio)
    if teeth is not None:
        pair = oracle.with_module(laws.from_driver(shape, over_radius), 1, teeth)
        assert printed(pair.distance, distance or "")


def test_two_lobes() -> None:
    shape = laws.lobed(0.3, 2)
    distance = oracle.closing_distance(shape, 2.2)
    pair = oracle.with_module(laws.from_driver(shape, distance), 1, 36)
    assert printed(pair.distance, "34.5409988531")


def test_logarithmic_spiral_length() -> None:
    """A length formula of another kind: (r_b - r_a)*sqrt(1 + k^2)/k for r = exp(k*phi)."""
    k = mp.mpf("0.2")
    law = laws.from_driver(
        lambda phi, lib: (lib.exp(k * phi), k * lib.exp(k * phi), k**2 * lib.exp(k * phi)), 9
    )
    pair = oracle.Pair(law, mp.mpf(9))
    exact = (mp.exp(k * 2) - mp.exp(k)) * mp.sqrt(1 + k * k) / k
    assert abs(pair.arc_length(mp.mpf(2)) - pair.arc_length(mp.mpf(1)) - exact) < 1e-25


@pytest.mark.parametrize("wheel", [1, 2])
def test_kinematics_agree_with_the_oracle(wheel: int) -> None:
    exact = oracle.Pair(laws.NAIL_THREE, mp.mpf(180))
    rolling = Rolling(laws.NAIL_THREE, 180.0)
    for angle in (0.3, 1.7, 4.9):
        phi = mp.mpf(angle)
        radius = exact.driver_radius(phi)[0]
        polar = (radius, phi) if wheel == 1 else (180 - radius, mp.pi - exact.driven_angle(phi))
        point = rolling.frames(wheel, np.array([float(exact.arc_length(phi))])).point[0]
        expected = [polar[0] * mp.cos(polar[1]), polar[0] * mp.sin(polar[1])]
        assert np.allclose(point, [float(x) for x in expected], rtol=0, atol=2e-12)


# --- the sweeps on a circular wheel: z = 20, m = 2 mm -----------------------------------------

BASIC = Basic(2.0)
CIRCLE = Rolling(laws.constant(), 40.0)
PINION = 1 / 30
STEPS = np.array([250, 500, 1000, 2000])


def involute_flank(lowest: float) -> NDArray[np.float64]:
    heights = np.linspace(lowest, 0.7, 800)
    points = [oracle.circular_flank(20, mp.mpf(float(h)), mp.pi / 9) for h in heights]
    return BASIC.module * np.array(points, dtype=float)


def slope(errors: list[float]) -> float:
    return -float(np.polyfit(np.log(STEPS), np.log(errors), 1)[0])


def test_rack_sweep_falls_to_the_involute_with_the_square_of_its_step() -> None:
    flank = involute_flank(-0.95)
    errors = [sweep.farthest(flank, sweep.swept(CIRCLE, 1, 1, BASIC, int(n))) for n in STEPS]
    assert slope(errors) == pytest.approx(2, abs=0.1)
    assert errors[-1] < 2e-5


def test_shaper_falls_to_the_involute_with_the_square_of_its_step() -> None:
    flank = involute_flank(-0.85)  # its fillet begins at 0.869 modules
    strip = sweep.blank(CIRCLE, 1, 1, BASIC)
    cuts = [
        shaper.cut_space(CIRCLE, 1, 1, BASIC, int(n), curvature=PINION, flank_points=1200)
        for n in STEPS
    ]
    errors = [sweep.farthest(flank, shapely.difference(strip, cut)) for cut in cuts]
    assert slope(errors) == pytest.approx(2, abs=0.1)
    assert errors[-1] < 5e-5
    assert shaper.cutter_error(BASIC, PINION, 400, 200) < 5e-6


@pytest.mark.parametrize("cutter", ["rack", "pinion"])
def test_a_flank_off_by_a_micrometre_is_seen(cutter: str) -> None:
    flank = involute_flank(-0.8)
    forward = np.gradient(flank, axis=0)
    normal = np.stack([-forward[:, 1], forward[:, 0]], axis=-1)
    normal /= np.linalg.norm(normal, axis=-1, keepdims=True)
    if cutter == "rack":
        cut = sweep.cut_space(CIRCLE, 1, 1, BASIC, 2000)
    else:
        cut = shaper.cut_space(CIRCLE, 1, 1, BASIC, 2000, curvature=PINION)
    region = shapely.difference(sweep.blank(CIRCLE, 1, 1, BASIC), cut)
    assert sweep.farthest(flank, region) < 5e-5
    assert sweep.farthest(flank + 1e-3 * normal, region) == pytest.approx(1e-3, abs=5e-5)


def test_the_two_wheels_of_a_sweep_do_not_overlap() -> None:
    """Both wheels of an ellipse pair, swept on their own, put together in mesh."""
    pair = oracle.with_module(laws.ellipse(0.3), 2, 40)
    rolling = Rolling(laws.ellipse(0.3), float(pair.distance))
    basic = Basic(2.0)
    at = basic.space(1, 3)
    phi1, phi2 = (float(x) for x in _angles(pair, at))
    first = sweep.swept(rolling, 1, 3, basic, 4000)
    second = shapely.union_all([sweep.swept(rolling, 2, k, basic, 4000) for k in (2, 3)])
    placed = shapely.transform(first, lambda p: p @ _turn(-phi1).T)
    mate = shapely.transform(second, lambda p: p @ _turn(phi2).T + [float(pair.distance), 0.0])
    assert shapely.intersection(placed, mate).area < 1e-5
    pushed = shapely.transform(placed, lambda p: p @ _turn(2e-4).T)
    assert shapely.intersection(pushed, mate).area > 1e-3


def _turn(angle: float) -> NDArray[np.float64]:
    return np.array([[np.cos(angle), -np.sin(angle)], [np.sin(angle), np.cos(angle)]])


def _angles(pair: oracle.Pair, s: float) -> tuple[Any, Any]:
    phi = mp.findroot(lambda x: pair.arc_length(x) - s, s / pair.length * 2 * mp.pi)
    return phi, pair.driven_angle(phi)
