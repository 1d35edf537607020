"""Corners of internal pairs: seen to stay where a cutter was, or followed against an outline."""

from __future__ import annotations

import math
from dataclasses import replace

import numpy as np
import pytest
import shapely

from gearcam.base.tolerances import DEFAULT
from gearcam.gears import corners
from gearcam.gears.corners import highest_corners
from gearcam.gears.cutter import Cutter
from gearcam.gears.flank import Toothing
from gearcam.gears.flank_ends import find_tips
from gearcam.gears.outline import Outline, build_outline
from gearcam.laws.ratio.centrodes import LogSpiral
from gearcam.numeric.arrays import Array, Mask, Plane, as_pairs
from helpers_built import fresh
from helpers_pairs import job
from helpers_rings import CHORDS, random_ring, ring
from helpers_sampling import few

RACK = Cutter(
    alpha=math.radians(20),
    addendum=1.0,
    dedendum=1.25,
    tip_radius=0.3,
    kc=0.0,
    half_space=0.25 * math.pi,
    pitch=math.pi,
)
PLACE = 0.4
"""Where the tooth stands along the pitch line."""

CLEAR = {
    "24 : 48": ((24, 48), {"type": "formula", "ratio": "1 + 0.25*cos(phi1)"}),
    "40 : 60": (
        (40, 60),
        {"type": "fourier", "of": "ratio", "cosines": [0.03], "sines": [0.0, 0.02]},
    ),
    "40 : 90": ((40, 90), {"type": "constant"}),
}
"""Rings whose corners come deep, but touch nothing."""

LOWERED = [16, 177, 258]
"""Random rings of which some corners would run into the mate."""


def tooth(cutter: Cutter) -> shapely.Polygon:
    """The tooth as a polygon with the tip up, rounded by what a disc fills of a sharp one."""
    if cutter.kc == 0.0:
        heights = np.linspace(-1.0, cutter.dedendum, 2)
        half = cutter.half_space - heights * math.tan(cutter.alpha)
        right = np.stack([half + PLACE, heights], axis=1)
        left = np.stack([PLACE - half, heights], axis=1)
    else:
        pitch = 1.0 / cutter.kc
        base = pitch * math.cos(cutter.alpha)
        most = math.sqrt(((pitch + cutter.dedendum) / base) ** 2 - 1.0)
        unwound = np.linspace(0.0, most, 2001)
        radius = base * np.sqrt(1.0 + unwound**2)
        at_pitch = math.tan(cutter.alpha) - cutter.alpha
        angle = cutter.half_space / pitch + at_pitch - (unwound - np.arctan(unwound))
        tip = np.linspace(angle[-1], -angle[-1], 2001)[1:-1]
        edges = [
            (radius, PLACE / pitch + angle),
            (np.full(tip.shape, radius[-1]), PLACE / pitch + tip),
            (radius[::-1], PLACE / pitch - angle[::-1]),
        ]
        radii, angles = np.concatenate(edges, axis=1)
        right = np.stack([radii * np.sin(angles), radii * np.cos(angles) - pitch], axis=1)
        left = np.empty((0, 2))
    sharp = shapely.Polygon(np.concatenate([right, left[::-1]]))
    return sharp.buffer(-cutter.tip_radius, 256).buffer(cutter.tip_radius, 256)


@pytest.mark.parametrize("teeth", [math.inf, 60.0, 24.0])
@pytest.mark.parametrize("tip_radius", few([0.3, 0.1]))
def test_the_gap_to_a_cutters_tooth_is_the_distance_from_it(
    teeth: float, tip_radius: float
) -> None:
    cutter = replace(RACK, kc=2.0 / teeth, tip_radius=tip_radius)
    # not about the corners of its other end, which the disc leaves out too
    x, depth = np.meshgrid(np.linspace(-1.0, 2.0, 61), np.linspace(0.0, 1.6, 33))
    x, depth = x.ravel(), depth.ravel()
    points = shapely.points(x, depth)
    shape = tooth(cutter)
    gap = cutter.gap(x, depth, np.full(x.shape, PLACE))
    outside = shapely.distance(shape, points)
    assert np.maximum(gap, 0.0) == pytest.approx(outside, abs=1e-5)
    edge = shapely.distance(shape.exterior, points)
    assert np.all(gap[shapely.contains(shape, points) & (edge > 1e-5)] < 0.0)
    assert outside.max() > 0.5
    above = cutter.gap(np.full(9, PLACE), np.linspace(-2.0, -1.01, 9), np.full(9, PLACE))
    assert np.all(above == math.inf)


def highest(
    of: Toothing, mate: Toothing, outline: Outline | None, chords: float = 1e-3
) -> tuple[Array, Array]:
    """How high flanks may go and would, the mate's outline being one or never asked for."""

    def asked() -> Plane:
        assert outline is not None, "the outline is made"
        return outline.points

    sf, sigma = of.flanks
    tips = find_tips(of, sf, sigma, np.full(sf.shape, mate.cutter.reach))
    reach = sigma * (sf - of.track.arc_length(tips.phi))
    return highest_corners(of, mate, asked, chords, (sf, sigma), reach), reach


@pytest.mark.parametrize("name", CLEAR)
def test_corners_that_touch_nothing_need_no_outline_and_stay_as_they_are(name: str) -> None:
    teeth, law = CLEAR[name]
    one, two = ring(law, teeth, pair={"module_mm": 2.0}).pair.toothings
    for wheel, mate in ((one, two), (two, one)):
        allowed, reach = highest(wheel, mate, None)
        assert np.array_equal(allowed, reach)


def runs_in(of: Toothing, mate: Outline, reach: Array) -> Mask:
    """Whether corners of a reach go deeper than they may into metal below the mate's centrode."""
    sf, sigma = of.flanks
    ends = of.frames(of.track.angle(sf - sigma * reach))
    phi = of.track.angle(sf[:, None] + of.pitch * np.linspace(-1.25, 1.25, 121))
    own, other = of.frames(phi), mate.toothing.frames(phi)
    away = of.flank_points(ends, sf, sigma)[:, None] - own.p
    path = other.p + other.t / own.t * away
    turn = np.linspace(0.0, mate.toothing.track.around, 10001)[1:]
    curve = mate.toothing.frames(turn).p
    ring, centrode = mate.toothing.track.ring, shapely.Polygon(np.stack([curve.real, curve.imag]).T)
    less = 2.0 * mate.tolerance
    body = shapely.Polygon(as_pairs(mate.points)).buffer(less if ring else -less)
    metal, below = (shapely.contains_xy(each, path.real, path.imag) for each in (body, centrode))
    return np.any((metal != ring) & (below != ring), axis=1)


@pytest.mark.parametrize("seed", few(LOWERED, 3))
def test_corners_are_lowered_as_far_as_the_mates_whole_outline_asks_and_no_further(
    seed: int,
) -> None:
    pair, changed = random_ring(seed).pair, 0
    one, two = pair.toothings
    chords = CHORDS * pair.module
    for wheel, mate in ((one, two), (two, one)):
        outline = build_outline(mate, wheel, chords, DEFAULT, follow=False)
        allowed, reach = highest(wheel, mate, outline, chords)
        lower = allowed < reach
        assert not runs_in(wheel, outline, allowed).any()
        assert np.array_equal(lower, runs_in(wheel, outline, reach))
        assert runs_in(wheel, outline, allowed + reach / 2**13)[lower].all()
        demand_ends(build_outline(wheel, mate, chords, DEFAULT), allowed)
        changed += np.count_nonzero(lower)
    assert changed > 0


def test_tips_that_meet_above_the_rings_centrode_are_not_what_lowers_corners() -> None:
    pair = random_ring(59).pair
    wheel, mate = pair.toothings
    chords = CHORDS * pair.module
    outline = build_outline(mate, wheel, chords, DEFAULT, follow=False)
    allowed, reach = highest(wheel, mate, outline, chords)
    lower = allowed < reach
    assert np.count_nonzero(lower) == 3  # of three lobes
    # where the centrode runs is known roughly
    assert runs_in(wheel, outline, 1.01 * allowed)[lower].all()


def demand_ends(outline: Outline, allowed: Array) -> None:
    """Demand that flanks end where they are allowed to, and ends are told as they are."""
    toothing, tips = outline.toothing, outline.flanks.tips
    sf, sigma = toothing.flanks
    reach = sigma * (sf - toothing.track.arc_length(tips.phi))
    assert np.all(reach <= allowed + 1e-9)
    base = toothing.frames(tips.foot)
    away = toothing.flank_points(toothing.frames(tips.phi), sf, sigma) - base.p
    seen = np.conj(toothing.turn * base.t) * away
    assert seen.real == pytest.approx(tips.height, abs=1e-9)
    assert seen.imag == pytest.approx(0.0, abs=1e-9)
    assert np.array_equal(tips.full, tips.height == toothing.cutter.addendum)


def test_nothing_is_seen_of_corners_where_an_open_mate_has_no_space() -> None:
    law = LogSpiral(ratios=(0.25, 0.5), driven_travel=math.log(1.5))
    one, two = job(law, (20, 20), module=1.0, internal=True).pair.toothings
    sf, sigma = one.flanks
    paths = corners._Paths(
        toothing=one,
        mate=two,
        sf=sf,
        sigma=sigma,
        outline=lambda: np.empty(0, dtype=complex),
        tolerance=1e-3,
    )
    every, short = np.arange(len(sf)), np.full(len(sf), 0.5)
    teeth = np.tile(one.tooth_places, 2)
    # the first and the last tooth formed stand outside the blank
    outside = (teeth < two.ends[0]) | (teeth > two.ends[1])
    assert np.count_nonzero(outside) == 4
    assert np.array_equal(paths.doubtful(every, short), every[outside])


def test_crossings_that_are_not_wanted_are_given_up(monkeypatch: pytest.MonkeyPatch) -> None:
    """A flank of this ring may never come to its addendum curve: Newton's steps go anywhere."""
    teeth, law = CLEAR["24 : 48"]
    one, two = fresh(ring(law, teeth, pair={"module_mm": 2.0})).pair.toothings
    sf, sigma = two.flanks
    asked: list[int] = []
    plain = Toothing.frames

    def counted(toothing: Toothing, phi: Array, *, curved: bool = True) -> object:
        asked.append(np.size(phi))
        return plain(toothing, phi, curved=curved)

    monkeypatch.setattr(Toothing, "frames", counted)
    tips = find_tips(two, sf, sigma, np.full(sf.shape, one.cutter.reach))
    assert 0 < np.count_nonzero(tips.full) < len(sf) // 2
    assert len(asked) < 20
