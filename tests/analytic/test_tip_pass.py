"""Tips that pass outside the mesh: the closed form of circles, reference values, whole outlines."""

from __future__ import annotations

import math

import pytest

from gearcam.base.tolerances import DEFAULT
from gearcam.gears.outline import Outline, build_outline
from gearcam.gears.pair import GearPair
from gearcam.gears.tip_pass import TipPass, tip_pass
from gearcam.kinds.gear_pair.result import GearPairResult
from helpers_rings import driver, overlap, passed_on_circles, ring
from helpers_sampling import few

CONSTANT = {"type": "constant"}
TRACED = 1e-4

DEEP = {"dedendum": 1.6, "tip_radius": 0.0}
"""Roots so deep that full flanks of rings touch flanks."""


def full(pair: GearPair) -> tuple[Outline, Outline]:
    """Both outlines with flanks up to the addendum curves, whatever the mates' roots leave."""
    wheel, hole = (build_outline(each, None, TRACED, DEFAULT) for each in pair.toothings)
    return wheel, hole


def passed(result: GearPairResult) -> TipPass:
    return tip_pass(*full(result.pair))


RADIANS = {
    (20, 36): 0.012900139,
    (28, 35): -0.004738053,
    (28, 36): -0.001012712,
    (28, 37): 0.001820801,
    (28, 40): 0.007196889,
    (40, 47): -0.002921914,
    (40, 48): -0.000269353,
    (40, 49): 0.001770222,
}
"""Margins of circular pairs by an independent program, rad of the ring."""


@pytest.mark.parametrize(("teeth", "margin"), RADIANS.items())
def test_circles(teeth: tuple[int, int], margin: float) -> None:
    found = passed(ring(CONSTANT, teeth))
    assert found.margin == pytest.approx(passed_on_circles(*teeth), abs=1e-11)
    assert found.margin / (0.5 * teeth[1]) == pytest.approx(margin, abs=6e-10)
    assert found.tooth == 1


@pytest.mark.parametrize("teeth", [(28, 33), (28, 34), (28, 40), (40, 49)])
def test_tips_that_end_below_the_addendum_curve(teeth: tuple[int, int]) -> None:
    result = ring(CONSTANT, teeth)
    height = float(result.gear2.profile.tip_height.min())
    assert height < 0.9
    found = result.subject.tip_pass
    assert found is not None
    assert found.margin == pytest.approx(passed_on_circles(*teeth, 1.0, height), abs=1e-11)


def test_the_angle_at_which_a_corner_leaves() -> None:
    found = passed(ring(CONSTANT, (28, 36)))
    # tooth 3 of the reference at 90.740 degrees
    assert math.degrees(found.phi1) + 2 * 360 / 28 == pytest.approx(90.740, abs=5e-4)


@pytest.mark.parametrize(
    ("e", "lobes", "teeth", "addendum", "margin", "worst"),
    [
        (0.01, (4, 5), (40, 50), 1.0, -0.007106, (2, 1.0, -48.684)),
        (0.01, (5, 6), (40, 48), 1.0, -0.127467, (8, -1.0, 127.161)),
        (0.01, (5, 6), (40, 48), 0.8, -0.026170, (8, -1.0, 119.573)),
        (0.015, (3, 4), (36, 48), 0.9, 0.091096, None),
    ],
)
def test_lobes(
    e: float,
    lobes: tuple[int, int],
    teeth: tuple[int, int],
    addendum: float,
    margin: float,
    worst: tuple[int, float, float] | None,
) -> None:
    result = ring(driver(e, *lobes), teeth, rack={"addendum": addendum})
    found = passed(result)
    assert found.margin == pytest.approx(margin, abs=6e-7)
    assert 0.0 <= found.phi1 < 2.0 * math.pi
    if worst is None:
        return
    # a symmetric law has the same on the other side of a lobe
    (tooth, sigma, phi1), count, lobe = worst, teeth[0] // lobes[0], 360.0 / lobes[0]
    other = (1 - tooth) % count + 1
    tooth, phi1 = (tooth, phi1) if found.sigma == sigma else (other, -phi1)
    assert (found.tooth - tooth) % count == 0
    assert (math.degrees(found.phi1) - phi1 + 1e-3) % lobe < 2e-3


@pytest.mark.parametrize("teeth", [*list(RADIANS)[1:], (28, 30)])
def test_the_sign_is_that_of_whole_outlines(teeth: tuple[int, int]) -> None:
    """The first of the circles interferes in the roots, and is left out."""
    result = ring(CONSTANT, teeth, rack=DEEP)
    outlines = full(result.pair)
    found = tip_pass(*outlines)
    assert (overlap(result, found.phi1, outlines) > 0.0) == (found.margin < 0.0)


@pytest.mark.parametrize(
    ("e", "lobes", "teeth", "addendum"),
    [
        (0.01, (4, 5), (40, 50), 1.0),
        (0.01, (5, 6), (40, 48), 0.8),
        (0.015, (3, 4), (36, 48), 0.9),
    ],
)
def test_the_sign_with_lobes(
    e: float, lobes: tuple[int, int], teeth: tuple[int, int], addendum: float
) -> None:
    result = ring(driver(e, *lobes), teeth, rack={"addendum": addendum} | DEEP)
    outlines = full(result.pair)
    found = tip_pass(*outlines)
    assert (overlap(result, found.phi1, outlines) > 0.0) == (found.margin < 0.0)


@pytest.mark.parametrize("scale", [0.1, 20.0])
def test_it_grows_with_the_module(scale: float) -> None:
    law = {"type": "fourier", "cosines": [0.06], "sines": [0.0, 0.02]}
    one, other = (
        passed(ring(law, (20, 30), pair={"module_mm": module})) for module in (1.0, scale)
    )
    assert other.margin == pytest.approx(scale * one.margin, rel=1e-10)
    assert other[1:3] == one[1:3]
    assert other.phi1 == pytest.approx(one.phi1, abs=1e-11)


def test_a_corner_that_never_leaves_the_ring_collides() -> None:
    found = passed(ring(CONSTANT, (28, 29)))
    assert found.margin < 0.0
    assert math.degrees(found.phi1) == pytest.approx(180.0, abs=360 / 28)


def test_moved_teeth_of_circles_pass_alike() -> None:
    result = ring(CONSTANT, (28, 36), steps={"count": 3})
    margins = [tip_pass(one.profile, two.profile).margin for one, two in result.steps]
    assert margins == pytest.approx([margins[0]] * 3, abs=1e-11)


def test_a_mirrored_law_has_mirrored_tips() -> None:
    one, other = (
        passed(ring({"type": "fourier", "sines": [e, 0.3 * e], "cosines": [0.02]}, (20, 30)))
        for e in (0.06, -0.06)
    )
    assert other.margin == pytest.approx(one.margin, abs=1e-11)
    assert other.sigma == -one.sigma
    assert all(0.0 <= found.phi1 < 2.0 * math.pi for found in (one, other))
    assert (other.phi1 + one.phi1 + 1e-9) % math.pi == pytest.approx(0.0, abs=2e-9)


def test_tips_that_collide_do_not_shorten_flanks() -> None:
    result = ring({"type": "formula", "ratio": "1 + 0.02*cos(3*phi1)"}, (36, 48))
    found = result.subject.tip_pass
    assert found is not None
    assert found.margin < 0.0
    for number, gear in enumerate(result.gears):
        mate = result.pair.toothings[1 - number]
        free = build_outline(gear.toothing, mate, TRACED, DEFAULT, follow=False)
        assert gear.profile.flanks.highest == pytest.approx(free.flanks.highest, abs=1e-12)


def test_a_ring_tip_grazes_no_fillet() -> None:
    """A convex part of a ring has corners whose paths bend less than a fillet of small radius.

    Followed they are shortened; their paths against the whole outlines show nothing.
    """
    law = {"type": "formula", "ratio": "1 + 0.09981*cos(2*phi1)"}
    rack = {"addendum": 1.0, "dedendum": 1.02, "tip_radius": 0.2}
    fine = {"chord_tolerance_mm": 1e-4}
    result = ring(law, (34, 85), rack=rack, ring={"cutter_teeth": 24}, output=fine)
    own = result.gear2.profile.flanks
    assert (own.highest < result.gear1.toothing.cutter.reach - 1e-3).any()
    assert overlap(result) == 0.0
    assert overlap(result, math.radians(85.29)) == 0.0


def test_tips_of_the_wheel_stay_out_of_fillets_of_a_ring() -> None:
    """A wheel flatter in places than the ring's cutter; of its flanks little is lost."""
    law = {"type": "formula", "ratio": "1 + 0.24891*cos(phi1)"}
    rack = {"addendum": 1.0, "dedendum": 1.02, "tip_radius": 0.1}
    result = ring(law, (15, 45), rack=rack, output={"chord_tolerance_mm": TRACED})
    wheel, mate = result.gear1.profile, result.pair.toothings[1]
    free = build_outline(wheel.toothing, mate, TRACED, DEFAULT, follow=False)
    lost = free.flanks.highest - wheel.flanks.highest
    assert 1e-4 < lost.max() < 0.05 * mate.cutter.reach
    assert overlap(result, outlines=(free, result.gear2.profile)) > 0.0
    assert overlap(result) == 0.0


@pytest.mark.parametrize(
    "teeth", [(13, 31), (17, 60), (20, 36), (28, 33), (28, 34), (28, 40), (40, 48), (60, 72)]
)
def test_the_margin_on_circles_is_exact_to_rounding(teeth: tuple[int, int]) -> None:
    result = ring(CONSTANT, teeth)
    found = result.subject.tip_pass
    assert found is not None
    height = float(result.gear2.profile.tip_height.min())
    true = abs(found.margin - passed_on_circles(*teeth, 1.0, height))
    assert true <= 1e-13 * math.pi * teeth[1]


@pytest.mark.parametrize("swing", few([0.03, 0.01, 0.06], 3))
def test_a_mirror_changes_the_margin_by_rounding_only(swing: float) -> None:
    """The same wheels with other numbers."""
    margins = [
        ring({"type": "fourier", "cosines": [swing], "sines": [0.0, sign * 0.02]}, (20, 30)).facts[
            "mesh.tip_pass_margin_mm"
        ]
        for sign in (1.0, -1.0)
    ]
    assert 0.0 < abs(margins[0] - margins[1]) < 1e-11
