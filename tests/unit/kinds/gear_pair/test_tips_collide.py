"""What is said of tips that collide, and the ways out: each followed."""

from __future__ import annotations

import math

import pytest

import gearcam
from gearcam.base.findings import Finding
from gearcam.kinds.gear_pair.result import GearPairResult
from helpers_pairs import profile
from helpers_rings import highest_on_circles, overlap, ring

COLLIDES = (28, 33)
PATIENCE = 60.0


def collision(result: GearPairResult) -> Finding | None:
    return next((one for one in result.findings if one.code == "tips-collide"), None)


def margin(result: GearPairResult) -> float:
    found = result.subject.tip_pass
    assert found is not None
    return found.margin


def test_it_tells_tooth_angle_and_margin() -> None:
    result = ring({"type": "constant"}, COLLIDES)
    found, passed = collision(result), result.subject.tip_pass
    assert found is not None
    assert passed is not None
    assert found.severity == "error"
    assert found.value == passed.margin < 0.0
    assert (found.limit, found.unit) == (0.0, "mm")
    assert found.where.startswith("wheel 1, tooth 1, phi1 = 75.85")
    assert "Tips collide" in found.message
    assert overlap(result, passed.phi1) > 0.0


def test_a_wheel_without_room_in_its_ring_is_told_so() -> None:
    """Its centrode crosses the ring's far from the mesh: no tooth is as wide as the margin."""
    found = collision(ring({"type": "ellipse", "eccentricity": 0.8}, (24, 48)))
    assert found is not None
    assert found.severity == "error"
    assert found.value is not None
    assert found.value < -0.5 * math.pi
    assert "does not fit into its ring" in found.message


def test_a_margin_below_its_limit_is_a_warning() -> None:
    free = ring({"type": "constant"}, (28, 40))
    assert collision(free) is None
    found = collision(
        ring({"type": "constant"}, (28, 40), limits={"tip_pass_mm": margin(free) + 1e-9})
    )
    assert found is not None
    assert found.severity == "warning"
    assert "pass each other" in found.message


def test_the_fact() -> None:
    result = ring({"type": "constant"}, (28, 40))
    assert result.facts["mesh.tip_pass_margin_mm"] == margin(result)
    assert "mesh.tip_pass_margin_mm" not in profile("ellipse").facts


def test_stepped_wheels_are_looked_at_step_by_step() -> None:
    result = ring({"type": "constant"}, COLLIDES, steps={"count": 2})
    places = [one.where for one in result.findings if one.code == "tips-collide"]
    assert sorted(place.split(",")[0] for place in places) == ["step 2", "wheel 1"]


def test_the_largest_addendum_and_the_fewest_teeth_are_ways_out() -> None:
    result = ring({"type": "constant"}, COLLIDES)
    found = gearcam.remedies(result, patience=PATIENCE).found
    changes = {key: value for one in found for key, value in one.changes.items()}
    highest = highest_on_circles(*COLLIDES)
    assert changes["rack.addendum"] == pytest.approx(math.floor(highest / 0.005) * 0.005)
    for remedy in found:
        other = gearcam.build(remedy.design)
        assert isinstance(other, GearPairResult)
        assert collision(other) is None
        assert overlap(other) == 0.0
        if remedy.less:
            less = gearcam.build(result.design.with_(remedy.less))
            assert isinstance(less, GearPairResult)
            assert collision(less) is not None


def contact_on_circles(z1: int, z2: int, addendum: float) -> float:
    """Contact ratio of circles inside each other, module 1: between both addendum circles."""
    alpha = math.radians(20)
    out, back = (
        math.sqrt((0.5 * z + height) ** 2 - (0.5 * z * math.cos(alpha)) ** 2)
        for z, height in ((z1, addendum), (z2, -addendum))
    )
    return (out - back + 0.5 * (z2 - z1) * math.sin(alpha)) / (math.pi * math.cos(alpha))


STUB = 0.8


@pytest.mark.slow
def test_fewer_teeth_do_with_a_shorter_addendum() -> None:
    """The fewest stub teeth whose tips pass where flanks still touch for 1.1 pitches."""
    given = (16, 18)
    found = gearcam.remedies(ring({"type": "constant"}, given), patience=PATIENCE).found
    taken = [one for one in found if set(one.changes) == {"pair.teeth", "rack.addendum"}]
    fewest = min(
        k
        for k in range(3, 10)
        if highest_on_circles(8 * k, 9 * k) >= STUB
        and contact_on_circles(8 * k, 9 * k, STUB) >= 1.1
    )
    assert [one.changes["pair.teeth"] for one in taken] == [[8 * fewest, 9 * fewest]]
    assert taken[0].changes["rack.addendum"] == STUB
    assert taken[0].less["pair.teeth"] == [8 * (fewest - 1), 9 * (fewest - 1)]
    (more,) = (one for one in found if [*one.changes] == ["pair.teeth"])
    assert given[0] < 8 * fewest < more.changes["pair.teeth"][0]  # type: ignore[index]
    other = gearcam.build(taken[0].design)
    assert isinstance(other, GearPairResult)
    assert collision(other) is None
    assert overlap(other) == 0.0


@pytest.mark.slow
def test_where_teeth_and_addendum_do_not_help_the_ring_is_made_larger() -> None:
    result = ring({"type": "formula", "ratio": "1 + 0.02*cos(5*phi1)"}, (40, 48))
    assert collision(result) is not None
    found = gearcam.remedies(result, patience=PATIENCE).found
    assert [one.changes for one in found] == [{"pair.teeth": [40, 80]}]
    other = gearcam.build(found[0].design)
    assert isinstance(other, GearPairResult)
    assert overlap(other) == 0.0
