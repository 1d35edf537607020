"""Biarcs stay within the tolerance, keep tangents, and distances to arcs are exact."""

from __future__ import annotations

import math
from collections.abc import Callable
from typing import Any

import numpy as np
import pytest

from gearcam.numeric.arcs import fit_arcs, fit_closed
from gearcam.numeric.bulges import deviation, farthest, flatten_bulges
from gearcam.numeric.contour import Run
from gearcam.numeric.splines import Spline, fit_splines
from helpers_contour import arc, disc_contour, gear_contour, line, sample, squashed
from helpers_curves import cubics, distances

TOLERANCE = 1e-3


def spiral(growth: float = 0.3) -> Run:
    """A logarithmic spiral: its curvature changes all along."""

    def curve(u: np.ndarray) -> tuple[np.ndarray, np.ndarray]:
        points = 20 * np.exp((growth + 1j) * 2 * u)
        return points, points * (growth + 1j)

    return sample(curve, TOLERANCE / 50)[0]


def wave() -> Run:
    """Two inflections: y = 2 sin(x), x from 0 to 3 pi."""

    def curve(u: np.ndarray) -> tuple[np.ndarray, np.ndarray]:
        x = 3 * np.pi * u
        return x + 2j * np.sin(x), 1 + 2j * np.cos(x)

    return sample(curve, TOLERANCE / 50)[0]


def end_tangents(points: np.ndarray, bulges: np.ndarray) -> tuple[np.ndarray, np.ndarray]:
    """Unit tangents at both ends of each arc, from its bulge."""
    chord = np.diff(points)
    half = 2 * np.arctan(bulges)
    unit = chord / np.abs(chord)
    return unit * np.exp(-1j * half), unit * np.exp(1j * half)


@pytest.mark.parametrize("run", [spiral(), spiral(-0.5), wave()], ids=["out", "in", "wave"])
def test_the_fit_stays_within_the_tolerance_and_uses_it(run: Run) -> None:
    points, bulges = fit_arcs([run], TOLERANCE)[0]
    there = distances(run.points, points, bulges, closed=False).max()
    places = flatten_bulges(points, bulges, math.inf, closed=False, least=20)
    back = distances(places, run.points, np.zeros(len(run.points) - 1), closed=False).max()
    assert 0.8 * TOLERANCE < there <= TOLERANCE * (1 + 1e-9)
    assert back <= 1.03 * TOLERANCE


@pytest.mark.parametrize("run", [spiral(), spiral(-0.5), wave()], ids=["out", "in", "wave"])
def test_the_fit_is_tangent_continuous_and_ends_with_the_run(run: Run) -> None:
    points, bulges = fit_arcs([run], TOLERANCE)[0]
    first, last = end_tangents(points, bulges)
    assert np.abs(np.angle(first[1:] / last[:-1])).max() < 1e-9
    assert abs(np.angle(first[0] / run.tangents[0])) < 1e-9
    assert abs(np.angle(last[-1] / run.tangents[-1])) < 1e-9
    assert (points[[0, -1]] == run.points[[0, -1]]).all()


def test_the_number_of_arcs_grows_with_the_cube_root_of_the_exactness() -> None:
    run = sample(
        lambda u: (20 * np.exp((0.3 + 1j) * 2 * u), np.exp((0.3 + 1j) * 2 * u) * (0.3 + 1j)), 2e-9
    )
    counts = [len(fit_arcs([run[0]], tolerance)[0][1]) for tolerance in (1e-3, 1e-6)]
    assert counts[1] / counts[0] == pytest.approx(10, rel=0.35)


def test_a_circle_becomes_few_exact_arcs() -> None:
    contour = disc_contour(50.0)
    points, bulges = fit_closed(contour.runs, TOLERANCE)
    assert len(bulges) == 6
    angles = np.degrees(4 * np.arctan(bulges))
    assert angles.sum() == pytest.approx(360, abs=1e-9)
    dense = flatten_bulges(points, bulges, 1e-4)
    assert np.abs(dense) == pytest.approx(50.0, abs=1e-9)


def test_a_straight_run_is_one_straight_piece() -> None:
    run, _ = sample(line(1 + 1j, 30 - 7j), 1e-5)
    many = Run(
        points=np.linspace(run.points[0], run.points[-1], 50),
        tangents=np.repeat(run.tangents[:1], 50),
    )
    for straight in (run, many):
        points, bulges = fit_arcs([straight], TOLERANCE)[0]
        assert bulges.tolist() == [0.0]
        assert (points == run.points[[0, -1]]).all()


def test_repeated_points_do_no_harm() -> None:
    run = spiral()
    doubled = Run(points=np.repeat(run.points, 2), tangents=np.repeat(run.tangents, 2))
    assert (fit_arcs([doubled], TOLERANCE)[0][0] == fit_arcs([run], TOLERANCE)[0][0]).all()


def test_a_run_that_comes_back_by_rounding_does_no_harm() -> None:
    """At a knee far from the origin: forth by a last digit, back to the very point, and on."""
    bend = spiral()
    at, tangents = bend.points + 1e5 * (1 + 1j), bend.tangents
    forth = at[0] + 3e-11 * tangents[0]
    at = np.insert(at, 0, [at[0], forth])
    tangents = np.insert(tangents, 0, np.repeat(tangents[:1], 2))
    for count in (3, 4, 5, 8, 20, len(at)):
        run = Run(points=at[:count], tangents=tangents[:count])
        points, bulges = fit_arcs([run], TOLERANCE)[0]
        assert distances(run.points, points, bulges, closed=False).max() < 1.1 * TOLERANCE


def test_a_mirrored_run_mirrors_the_bulges() -> None:
    run = wave()
    _, bulges = fit_arcs([run], TOLERANCE)[0]
    _, mirrored = fit_arcs(
        [Run(points=np.conj(run.points), tangents=np.conj(run.tangents))], TOLERANCE
    )[0]
    assert mirrored == pytest.approx(-bulges, abs=1e-12)
    assert (bulges < 0).any()
    assert (bulges > 0).any()


def test_what_cannot_be_fitted_is_refused() -> None:
    run = spiral()
    with pytest.raises(ValueError, match="positive"):
        fit_arcs([run], 0.0)
    with pytest.raises(ValueError, match="two different points"):
        fit_arcs([Run(points=run.points[:1], tangents=run.tangents[:1])], TOLERANCE)
    with pytest.raises(ValueError, match="finite"):
        fit_arcs([Run(points=run.points * np.nan, tangents=run.tangents)], TOLERANCE)
    with pytest.raises(ValueError, match="do not join"):
        fit_closed([run], TOLERANCE)


def test_a_wheel_takes_far_fewer_arcs_than_chords() -> None:
    contour = gear_contour(36, 5.0, TOLERANCE)
    points, bulges = fit_closed(contour.runs, 0.96 * TOLERANCE)
    assert len(points) < len(contour.points) / 3
    dense = np.concatenate([run.points[:-1] for run in contour.runs])
    assert 0.8 * TOLERANCE < deviation(points, bulges, dense) <= TOLERANCE


@pytest.mark.parametrize("flat_radius", [60.0, 250.0])
def test_a_flat_step_beside_a_sharp_bend_is_checked_within(flat_radius: float) -> None:
    """A sharp arc runs smoothly into a flat one whose points lie far apart, as a fillet does.

    An arc that carries on the bend's curvature leaves the curve most between two points of the
    flat part; so it is measured against the true curve, not its points.
    """
    x = np.linspace(0.0, 2.5, 4000)
    true = x + 1j * (np.sqrt(flat_radius**2 - x**2) - flat_radius)
    flat, _ = sample(
        arc(-1j * flat_radius, flat_radius, np.pi / 2, np.pi / 2 - 3 / flat_radius), TOLERANCE / 50
    )
    worst = 0.0
    for angle in np.linspace(0.3, 1.5, 60)[50:]:
        bend, _ = sample(arc(3j, 3.0, -np.pi / 2 - angle, -np.pi / 2), TOLERANCE / 50)
        run = Run(
            points=np.concatenate([bend.points, flat.points[1:]]),
            tangents=np.concatenate([bend.tangents, flat.tangents[1:]]),
        )
        points, bulges = fit_arcs([run], TOLERANCE)[0]
        worst = max(worst, distances(true, points, bulges, closed=False).max())
    assert 0.4 * TOLERANCE < worst < 1.02 * TOLERANCE


@pytest.mark.parametrize("short", [0.01, 0.05])
@pytest.mark.parametrize("fit", [fit_arcs, fit_splines], ids=["arcs", "splines"])
def test_a_long_step_is_checked_within_though_short_ones_lead_to_the_bend(
    fit: Callable[..., Any], short: float
) -> None:
    """A straight side ends in short steps, still straight; a wide bend follows.

    One curve over the side and part of the bend leaves the side most in the middle of its long
    step, where nothing bends nearby.
    """
    side = np.append(0.0, 10.0 + short * np.arange(6)) + 0j
    worst = 0.0
    for radius in np.geomspace(5.0, 500.0, 12):
        bend, _ = sample(
            arc(side[-1] + 1j * radius, radius, -np.pi / 2, -np.pi / 2 + 0.1), TOLERANCE / 50
        )
        run = Run(
            points=np.append(side, bend.points[1:]),
            tangents=np.append(np.repeat(bend.tangents[:1], 6), bend.tangents),
        )
        worst = max(worst, off_run(fit([run], TOLERANCE)[0], run))
    assert 0.2 * TOLERANCE < worst < 1.05 * TOLERANCE


def off_run(fitted: Spline | tuple[np.ndarray, np.ndarray], run: Run) -> float:
    """The largest distance of many places of arcs, or of a spline, to the run's chords."""
    if isinstance(fitted, Spline):
        share, poles = np.linspace(0.0, 1.0, 101)[:, None], cubics(fitted)
        weights = [math.comb(3, i) * share**i * (1 - share) ** (3 - i) for i in range(4)]
        places = np.sum([weights[i] * poles[:, i] for i in range(4)], axis=0).ravel()
    else:
        points, bulges = fitted
        places = flatten_bulges(points, bulges, math.inf, closed=False, least=100)
    return distances(places, run.points, np.zeros(len(run.points) - 1), closed=False).max()


def test_between_coarse_points_the_tangents_tell_the_curve() -> None:
    angle = np.linspace(0.0, np.pi / 2, 7)
    spokes = np.exp(1j * angle)
    run = Run(points=10 * spokes, tangents=1j * spokes)
    _, bulges = fit_arcs([run], TOLERANCE)[0]
    assert bulges == pytest.approx([np.tan(np.pi / 8)], abs=1e-9)


@pytest.mark.parametrize("fault", ["sign", "dropped", "scaled", "shifted"])
def test_the_measured_deviation_sees_a_fault(fault: str) -> None:
    contour = gear_contour(12, 5.0, TOLERANCE)
    points, bulges = fit_closed(contour.runs, TOLERANCE)
    dense = np.concatenate([run.points[:-1] for run in contour.runs])
    good = deviation(points, bulges, dense)
    longest = int(np.argmax(np.abs(bulges * np.diff(points, append=points[:1]))))
    if fault == "sign":
        bulges = bulges.copy()
        bulges[longest] *= -1
    elif fault == "dropped":
        points, bulges = np.delete(points, longest), np.delete(bulges, longest)
    elif fault == "scaled":
        points = points / 25.4
    else:
        points = points + 2e-3
    assert good <= 1.03 * TOLERANCE
    assert deviation(points, bulges, dense) > 1.5 * TOLERANCE


def test_an_arc_that_only_the_polyline_has_is_seen() -> None:
    """Every dense point lies on the polyline, but the polyline also goes elsewhere."""
    square = np.array([0j, 10.0, 10 + 10j, 10j])
    spur = np.concatenate([square[:1], [5.0, 5 - 3j, 5.0], square[1:]])
    assert distances(square, spur, np.zeros(7)).max() == 0
    assert deviation(spur, np.zeros(7), square) == pytest.approx(3.0, rel=0.2)


@pytest.mark.parametrize("bulge", [0.0, 1e-12, -1e-5, 0.3, -0.3, 1.0, -1.0, 2.5, -2.5])
def test_distances_to_one_arc_are_exact(bulge: float) -> None:
    """Against a brute search over a fine subdivision of the arc, made by another formula."""
    z, w = 1 + 2j, 4 - 2j
    points = np.random.default_rng(1).uniform(-8, 8, (200, 2)).view(complex).ravel()
    found = distances(points, np.array([z, w]), np.array([bulge]), closed=False)
    if abs(bulge) < 1e-9:
        places = z + (w - z) * np.linspace(0, 1, 40001)
    else:
        centre = 0.5 * (z + w) + 0.5j * (w - z) * (1 - bulge**2) / (2 * bulge)
        places = centre + (z - centre) * np.exp(4j * np.arctan(bulge) * np.linspace(0, 1, 40001))
    assert places[-1] == pytest.approx(w, abs=1e-6)
    brute = np.abs(points[:, None] - places).min(axis=1)
    assert found == pytest.approx(brute, abs=2e-5)


def test_distances_do_not_depend_on_the_blocks() -> None:
    contour = gear_contour(12, 5.0, 1e-2)
    points, bulges = fit_closed(contour.runs, 1e-2)
    targets = np.random.default_rng(2).uniform(-40, 40, (300, 2)).view(complex).ravel()
    together = distances(targets, points, bulges)
    alone = [distances(targets[[k]], points, bulges)[0] for k in range(300)]
    each = [
        min(
            distances(
                targets[[number]], points[[k, (k + 1) % len(points)]], bulges[k : k + 1], False
            )[0]
            for k in range(len(points))
        )
        for number in range(10)
    ]
    assert together == pytest.approx(np.array(alone), abs=1e-13)
    assert together[:10] == pytest.approx(np.array(each), abs=1e-13)


def test_flattening_keeps_the_sagitta_and_the_area() -> None:
    quarter = math.tan(math.pi / 8)
    corners = 10 * np.array([1.0, 1j, -1.0, -1j])
    bulges = np.full(4, quarter)
    points = flatten_bulges(corners, bulges, 1e-3)
    assert np.abs(points) == pytest.approx(10.0, abs=1e-12)
    middles = 0.5 * (points + np.roll(points, -1))
    sagitta = 10 - np.abs(middles).min()
    assert 0.8e-3 < sagitta <= 1e-3
    x, y = points.real, points.imag
    assert 0.5 * np.sum(x * np.roll(y, -1) - y * np.roll(x, -1)) == pytest.approx(
        100 * np.pi, rel=2e-4
    )


def test_an_open_polyline_keeps_its_last_point() -> None:
    run = sample(squashed(arc(0, 10, 0, 1), (1, 0.5), 0.2), 1e-5)[0]
    points, bulges = fit_arcs([run], TOLERANCE)[0]
    flat = flatten_bulges(points, bulges, 1e-4, closed=False)
    assert flat[-1] == run.points[-1]
    with pytest.raises(ValueError, match="bulges"):
        flatten_bulges(points, bulges, 1e-4, closed=True)


@pytest.mark.parametrize("shape", ["gear", "disc", "spur"])
def test_the_farthest_point_is_that_of_exact_distances(shape: str) -> None:
    """Also where the way downhill from the place of the same length ends at a corner."""
    if shape == "spur":
        dense = np.array([0j, 10.0, 10 + 10j, 5 + 1j, 10j])
        points: Any = 1.01 * np.roll(dense, 2)
        bulges = np.array([0.0, 0.1, -0.2, 0.0, 0.9])
    else:
        contour = gear_contour(12, 5.0, 1e-2) if shape == "gear" else disc_contour(50.0)
        points, bulges = fit_closed(contour.runs, 1e-2)
        dense = np.concatenate([run.points[:-1] for run in contour.runs])
        dense = dense + np.random.default_rng(4).normal(0.0, 1e-3, (len(dense), 2)) @ [1, 1j]
    exact = distances(dense, points, bulges).max()
    assert farthest(dense, points, bulges) == pytest.approx(exact, rel=1e-12)


def test_runs_fitted_side_by_side_are_those_fitted_alone() -> None:
    runs = [spiral(), wave(), spiral(-0.5)]
    together = fit_arcs(runs, TOLERANCE)
    for (points, bulges), run in zip(together, runs, strict=True):
        ((alone, bends),) = fit_arcs([run], TOLERANCE)
        assert (points == alone).all()
        assert bulges == pytest.approx(bends, abs=1e-14)


def test_a_chain_of_one_place_is_as_far_as_that_place() -> None:
    """As a pitch curve that is smaller than its tolerance."""
    place, dense = np.array([1 + 2j]), np.array([1 + 2j, 4 + 6j, 1 + 2j])
    assert farthest(dense, place, np.zeros(1)) == 5.0
