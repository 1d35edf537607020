"""Parallels and rounded edges are those of the true curve: closed forms, and shapely's buffers."""

from __future__ import annotations

import cmath
import math
from functools import cache

import numpy as np
import pytest
import shapely
from hypothesis import assume, example, given, settings
from hypothesis import strategies as st

from gearcam.base.errors import InfeasibleError
from gearcam.numeric.contour import Contour, Run
from gearcam.parts.parallel import moved, rounded
from helpers_contour import (
    Curve,
    arc,
    as_pairs,
    contour_of,
    disc_contour,
    gear_contour,
    line,
    square_contour,
)
from helpers_pairs import profile
from helpers_sampling import few
from witness.distance import distances

TOLERANCE = 1e-3


def chain(corners: list[complex]) -> list[Curve]:
    """Straight pieces from corner to corner, and back."""
    return [line(a, b) for a, b in zip(corners, corners[1:] + corners[:1], strict=True)]


def finer(contour: Contour, count: int = 60) -> Contour:
    """The same contour with points within its straight runs."""
    u = np.linspace(0.0, 1.0, count)
    runs = [
        Run(
            points=run.points[0] + u * (run.points[-1] - run.points[0]),
            tangents=np.repeat(run.tangents[:1], count),
        )
        if len(run.points) == 2
        else run
        for run in contour.runs
    ]
    return Contour(
        dense=lambda: tuple(runs),
        points=contour.points,
        tolerance=contour.tolerance,
        chord_error=contour.chord_error,
    )


@cache
def gear() -> Contour:
    """A squashed wheel: corners of both kinds, curves of both kinds."""
    return finer(gear_contour(12, 5.0))


def wheel(name: str, number: int) -> Contour:
    """The outline of a non-circular wheel as it is cut."""
    made = profile(name)
    return (made.gear1, made.gear2)[number - 1].profile.contour


def buffered(contour: Contour, by: float) -> shapely.Polygon:
    """Shapely's parallel of the polygon, arcs within a sixth of the tolerance."""
    count = math.pi / 4 / math.sqrt(2 * contour.tolerance / 6 / abs(by))
    return contour.polygon.buffer(by, quad_segs=max(2, math.ceil(count)))


def dense(contour: Contour) -> np.ndarray:
    """All dense points, complex."""
    return np.concatenate([run.points[:-1] for run in contour.runs])


def joins(contour: Contour) -> tuple[np.ndarray, np.ndarray]:
    """Gap and turn of the tangent between each run and the next."""
    after = contour.runs[1:] + contour.runs[:1]
    gaps = [abs(b.points[0] - a.points[-1]) for a, b in zip(contour.runs, after)]  # noqa: B905
    turns = [
        cmath.phase(b.tangents[0] / a.tangents[-1])
        for a, b in zip(contour.runs, after)  # noqa: B905
    ]
    return np.array(gaps), np.array(turns)


def demand_same(made: Contour, wanted: shapely.Polygon, blunt: float = 1.0) -> None:
    """Both polygons are the same but for the chords of both, over the sine of half a corner."""
    allowed = 2 * made.tolerance / blunt
    assert wanted.geom_type == "Polygon"
    assert made.polygon.is_valid
    assert made.polygon.hausdorff_distance(wanted) < allowed
    between = made.polygon.symmetric_difference(wanted).area
    assert between < 0.75 * made.tolerance * made.polygon.length


def demand_true(made: Contour, allowed: float | None = None) -> None:
    """Runs join, tangents are those of the curve, the polygon is within its tolerance."""
    gaps, _ = joins(made)
    assert gaps.max() < (made.tolerance / 10 if allowed is None else allowed)
    off = distances(as_pairs(dense(made)), made.polygon.boundary)
    assert off.max() <= made.tolerance
    for run in made.runs:
        points, units = run.points, run.tangents
        assert np.abs(units) == pytest.approx(np.ones(len(units)), abs=1e-12)
        way = np.diff(points)
        long = np.abs(way) > 1e-3
        mean = np.sqrt(units[1:] / units[:-1]) * units[:-1]
        assert np.abs(np.angle(way / mean))[long].max(initial=0.0) < 0.02


@pytest.mark.parametrize("by", [-9.0, -0.5, -1e-4, 1e-4, 0.5, 30.0])
def test_a_disc_becomes_a_disc(by: float) -> None:
    made = moved(disc_contour(10.0), by)
    assert np.abs(dense(made)) == pytest.approx(10 + by, abs=1e-9)
    assert made.moments.area == pytest.approx(math.pi * (10 + by) ** 2, rel=1e-9)
    demand_true(made)


@pytest.mark.parametrize("by", [0.01, 1.0, 7.0])
def test_a_square_grows_by_sides_and_corners(by: float) -> None:
    made = moved(square_contour(20.0), by)
    assert made.moments.area == pytest.approx(400 + 80 * by + math.pi * by**2, rel=1e-9)
    assert len(made.runs) == 8
    assert np.abs(joins(made)[1]).max() < 1e-9
    demand_true(made)


@pytest.mark.parametrize("by", [0.01, 1.0, 7.0, 9.9])
def test_a_square_shrinks_to_a_square(by: float) -> None:
    """Its sides are runs of two points: a straight run has nothing else to say."""
    made = moved(square_contour(20.0), -by)
    assert made.moments.area == pytest.approx((20 - 2 * by) ** 2, rel=1e-9)
    assert len(made.runs) == 4


@pytest.mark.parametrize("radius", [0.01, 1.0, 7.0, 9.9])
def test_a_rounded_square(radius: float) -> None:
    made = rounded(square_contour(20.0), radius)
    assert made.moments.area == pytest.approx(400 - (4 - math.pi) * radius**2, rel=1e-9)
    assert np.abs(joins(made)[1]).max() < 1e-6
    demand_true(made)


@pytest.mark.parametrize(
    ("by", "sign"),
    few([(1e-3, 1), (1e-3, -1), (0.3, -1), (0.3, 1), (1.0, 1), (1.0, -1), (2.5, -1), (2.5, 1)], 5),
)
def test_a_wheel_moves_as_a_buffer_does(by: float, sign: int) -> None:
    contour = gear()
    made = moved(contour, sign * by)
    # where nothing but the flanks is left of a tooth, they meet under twice 20 degrees
    demand_same(made, buffered(contour, sign * by), math.sin(math.radians(20)) if by > 2 else 1.0)
    demand_true(made)
    # what is added ends in arcs at outer corners, and in crossings at inner ones; or the reverse
    _, turns = joins(made)
    assert (sign * turns).max() < 1e-4


@pytest.mark.parametrize("radius", few([0.3, 0.5, 1.0], 3))
def test_a_wheel_is_rounded_as_an_opening_does(radius: float) -> None:
    contour = gear()
    made = rounded(contour, radius)
    opened = buffered(contour, -radius).buffer(radius, quad_segs=48)
    demand_same(made, opened)
    demand_true(made)
    assert joins(made)[1].max() < 1e-3, "an outer corner is left, or an arc is not tangent"
    for run in made.runs:
        turn = np.angle(np.diff(run.tangents) / (run.tangents)[1:] + 1)
        length = np.abs(np.diff(run.points))
        bend = turn[length > 1e-4] / length[length > 1e-4]
        assert bend.max(initial=0.0) < 1.01 / radius


@pytest.mark.parametrize(
    ("name", "number", "modules"),
    few([("ellipse", 1, 0.45), ("ellipse", 1, 0.05), ("ellipse", 1, -0.05), ("bspline", 2, 0.45)]),
)
def test_a_real_wheel_moves_as_a_buffer_does(name: str, number: int, modules: float) -> None:
    """0.45 modules are more than the fillets' radius: their parallels have swallow-tails."""
    contour = wheel(name, number)
    by = modules * profile(name).pair.module
    made = moved(contour, by)
    demand_same(made, buffered(contour, by))
    demand_true(made)


@pytest.mark.slow
@pytest.mark.parametrize(
    ("name", "number", "modules"),
    [
        ("formula", 2, -0.1),
        ("formula", 2, -0.2),
        ("nail_machine_two_phase", 2, -0.2),
        ("two_lobed_ellipse", 1, -0.35),
        ("feeder", 1, -0.35),
        ("feeder", 2, -0.05),
        ("log_spiral", 1, -0.05),
        ("indexing_table", 1, 0.05),
        ("two_speeds", 1, 0.45),
    ],
)
def test_every_wheel_of_the_profiles_can_be_moved(name: str, number: int, modules: float) -> None:
    """Open wheels have straight runs of two points; some flanks lose less than a step.

    0.45 modules leave one place of the roots of the two-speed wheel that the disc reaches.
    """
    contour = wheel(name, number)
    by = modules * profile(name).pair.module
    demand_same(moved(contour, by), buffered(contour, by))


def test_the_wrong_side_is_found() -> None:
    """The control: half a tolerance too much on one side, and the other side."""
    contour = gear()
    wanted = buffered(contour, 0.3)
    for wrong in (-0.3, 0.3 + 4 * TOLERANCE, 0.3 - 4 * TOLERANCE):
        with pytest.raises(AssertionError):
            demand_same(moved(contour, wrong), wanted)


@pytest.mark.parametrize("by", [1.5, 2.0, 4.0])
def test_a_disc_that_is_too_large_for_a_fillet_leaves_a_corner(by: float) -> None:
    """An L with a fillet of 1 grows as the L without it: sides, five outer corners, one inner."""
    pieces = chain([0j, 30 + 0j, 30 + 10j, 11 + 10j])[:3]
    pieces += [arc(11 + 11j, 1.0, -math.pi / 2, -math.pi)]
    pieces += [line(10 + 11j, 10 + 30j), line(10 + 30j, 30j), line(30j, 0j)]
    made = moved(finer(contour_of(pieces, TOLERANCE)), by)
    assert made.moments.area == pytest.approx(500 + 120 * by + 1.25 * math.pi * by**2 - by**2)
    _, turns = joins(made)
    assert turns.min() == pytest.approx(-math.pi / 2, abs=1e-3)
    assert (turns < -1e-3).sum() == 1
    demand_true(made)


def test_what_is_left_joins_where_arcs_are_too_short_to_be_drawn() -> None:
    bent = contour_of(chain([0j, 10 + 0j, 10 + 10j, 5 + 10.005j, 10j]), TOLERANCE)
    gaps, turns = joins(moved(bent, 1e-4))  # the arc about the blunt corner: 2e-7 mm
    assert len(turns[turns > 1e-6]) == 1
    assert gaps.max() == 0.0


def test_arcs_of_the_disc_s_own_radius_become_corners() -> None:
    """The smooth outline of a rounded square is one run; moved by its radius it has four."""
    smooth = rounded(square_contour(40.0), 3.0)
    points = np.concatenate([run.points[:-1] for run in smooth.runs] + [smooth.runs[0].points[:1]])
    tangents = np.concatenate(
        [run.tangents[:-1] for run in smooth.runs] + [smooth.runs[0].tangents[:1]]
    )
    whole = Run(points=points, tangents=tangents)
    one = Contour(
        dense=lambda: (whole,),
        points=smooth.points,
        tolerance=smooth.tolerance,
        chord_error=smooth.chord_error,
    )
    made = moved(one, -3.0)
    assert len(made.runs) in (4, 5)  # the first corner may be where it begins
    for run in made.runs:
        way = np.diff(run.points)
        way /= np.abs(way)
        assert np.abs(run.tangents[:-1] - way).max() < 1e-9
        assert np.abs(run.tangents[1:] - way).max() < 1e-9


@pytest.mark.parametrize("by", [0.6, 0.9, 3.0])
def test_a_slot_narrower_than_the_disc_closes(by: float) -> None:
    """Of a slot 1 mm wide and 9 mm deep only the dent between the arcs of its mouth is left."""
    corners = [-15 - 10j, 15 - 10j, 15 + 10j, 0.5 + 10j, 0.5 + 1j, -0.5 + 1j, -0.5 + 10j, -15 + 10j]
    made = moved(finer(contour_of(chain(corners), TOLERANCE), 400), by)
    # integral of by - sqrt(by**2 - t**2) over both halves of the mouth
    t = 0.5
    dent = 2 * t * by - (t * math.sqrt(by**2 - t**2) + by**2 * math.asin(t / by))
    whole = 600 + 100 * by + math.pi * by**2
    assert made.moments.area == pytest.approx(whole - dent, abs=5e-4)
    demand_true(made)


def stadium() -> Contour:
    """Two runs, each a straight piece, a half circle and a straight piece that join smoothly."""
    runs, vertices = [], []
    for turn in (1, -1):
        parts = []
        for piece, count in (
            (line(-5j, 6 - 5j), 20), (arc(6 + 0j, 5.0, -math.pi / 2, math.pi / 2), 900),
            (line(6 + 5j, 5j), 20),
        ):  # fmt: skip
            points, slopes = piece(np.linspace(0.0, 1.0, count + 1))
            parts.append((turn * points, turn * slopes / np.abs(slopes)))
        points = np.concatenate([p[:-1] for p, _ in parts] + [parts[-1][0][-1:]])
        units = np.concatenate([t[:-1] for _, t in parts] + [parts[-1][1][-1:]])
        runs.append(Run(points=points, tangents=units, joints=(20, 920)))
        vertices.append(points[:-1])
    return Contour(
        dense=lambda: tuple(runs),
        points=np.concatenate(vertices),
        tolerance=TOLERANCE,
        chord_error=1e-5,
    )


@pytest.mark.parametrize("by", [-4.9, -1.0, 2.0])
def test_joints_stay_where_curves_change(by: float) -> None:
    made = moved(stadium(), by)
    for run, turn in zip(made.runs, (1, -1), strict=True):
        places = [complex(run.points[joint]) for joint in run.joints]
        assert places == pytest.approx([turn * (6 - (5 + by) * 1j), turn * (6 + (5 + by) * 1j)])
        assert [len(piece.points) for piece in run.pieces] == [21, 901, 21]


def test_joints_stay_where_rounding_cuts_runs() -> None:
    """Straight and arc in one run, its start cut off by a rounded corner."""
    u = np.linspace(0.0, 1.0, 81)
    straight, curved = line(0j, 20 + 0j)(u), arc(20 + 10j, 10.0, -math.pi / 2, 0.0)(u)
    points = np.concatenate([straight[0], curved[0][1:]])
    units = np.concatenate([np.exp(1j * np.angle(z[1])) for z in (straight, curved)])
    units = np.delete(units, 81)
    first = Run(points=points, tangents=units, joints=(80,))
    rest = finer(contour_of([line(30 + 10j, 30j), line(30j, 0j)], TOLERANCE))
    whole = Contour(
        dense=lambda: (first, *rest.runs),
        points=np.concatenate([points[:-1], rest.points]),
        tolerance=TOLERANCE,
        chord_error=TOLERANCE,
    )
    made = rounded(whole, 2.0)
    kept = [run for run in made.runs if run.joints]
    assert len(kept) == 1
    assert kept[0].points[kept[0].joints[0]] == pytest.approx(20.0, abs=1e-12)
    assert kept[0].points[0] == pytest.approx(2.0, abs=1e-4)


@pytest.mark.parametrize("radius", [0.05, 0.02])
def test_chords_follow_arcs_that_grow(radius: float) -> None:
    """A rounded corner that is then moved far is an arc of another size: within its tolerance."""
    made = moved(rounded(finer(square_contour(20.0), 400), radius), 2.0)
    corner = made.points - (10 - radius) * (1 + 1j)
    corner = corner[(corner.real > 1e-6) & (corner.imag > 1e-6)]
    middles = 0.5 * (corner[1:] + corner[:-1])
    assert np.abs(corner) == pytest.approx(2 + radius, abs=1e-4)
    assert 2 + radius - np.abs(middles).min() <= TOLERANCE


@pytest.mark.parametrize(
    ("contour", "least", "most"),
    [(disc_contour(10.0), 9.9, 10.1), (finer(square_contour(20.0), 400), 9.9, 10.1)],
)
def test_what_leaves_nothing_is_refused(contour: Contour, least: float, most: float) -> None:
    assert moved(contour, -least).area > 0
    for make, by in ((moved, -most), (rounded, most)):
        with pytest.raises(InfeasibleError, match="leaves no simple outline") as caught:
            make(contour, by)
        assert caught.value.value == pytest.approx(most)


def test_a_neck_that_comes_apart_is_refused() -> None:
    """Two squares and a bar of 2 mm between them: moved inwards by more than 1 mm they part."""
    corners = [-20 - 5j, -8 - 5j, -8 - 1j, 8 - 1j, 8 - 5j, 20 - 5j]
    contour = finer(contour_of(chain([*corners, *(-z for z in corners)]), TOLERANCE), 300)
    # four inner corners become arcs, between which and the bar's end there is a spandrel
    wanted = 2 * 10.2 * 8.2 + 17.8 * 0.2 + 4 * 0.9**2 * (1 - math.pi / 4)
    assert moved(contour, -0.9).moments.area == pytest.approx(wanted)
    with pytest.raises(InfeasibleError, match="no simple outline"):
        moved(contour, -1.1)


def test_nothing_is_done_for_nothing() -> None:
    contour = gear()
    assert moved(contour, 0.0) is contour
    assert rounded(contour, 0.0) is contour


@settings(max_examples=4, deadline=None, derandomize=True)
@given(by=st.floats(-2.4, 2.4))
@example(by=-0.05)
def test_any_distance_gives_the_points_at_that_distance(by: float) -> None:
    demand_distance(by)


@pytest.mark.slow
@settings(max_examples=40, deadline=None, derandomize=True)
@given(by=st.floats(-2.4, 2.4))
def test_forty_distances_give_the_points_at_that_distance(by: float) -> None:
    demand_distance(by)


def demand_distance(by: float) -> None:
    assume(abs(by) > 1e-6)
    contour = gear()
    made = moved(contour, by)
    off = distances(as_pairs(dense(made)), contour.polygon.boundary)
    assert off == pytest.approx(np.full(len(off), abs(by)), abs=2 * TOLERANCE)
    wanted = buffered(contour, by)
    assert made.area == pytest.approx(wanted.area, abs=1.5 * TOLERANCE * wanted.length)


@pytest.mark.parametrize("by", [5e-10, -5e-10])
def test_a_parallel_within_a_thousandth_of_the_tolerance_is_the_outline(by: float) -> None:
    wheel = gear_contour(12)
    assert moved(wheel, by) is wheel
    assert moved(wheel, by * 1e4) is not wheel
