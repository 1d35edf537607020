"""Where linkages close: what is refused, and what is offered instead."""

from __future__ import annotations

from typing import Any

import numpy as np
import pytest

from gearcam.linkages.closing import NotClosingError, settled
from gearcam.linkages.dyads import Lengths
from gearcam.linkages.elements import Dyad, MemberPoint
from gearcam.linkages.plane import conjugate, imaginary, real
from gearcam.numeric.jets import Jet
from helpers_linkages import four_bar, linkage, swinging_guide


def test_rods_that_fold_onto_one_place_lose_it() -> None:
    """A kite: there both rods may have any direction, so that no branch tells where they go."""
    with pytest.raises(NotClosingError) as caught:
        settled(four_bar(50.0, 90.0, 90.0, 50.0))
    assert caught.value.closing.changes == pytest.approx((0.0,), abs=1e-9)
    assert not caught.value.nearest  # other lengths do not close at all


def test_nearly_a_kite_closes_if_its_rods_differ_less_than_their_ends() -> None:
    settled(four_bar(50.0, 90.0, 90.0, 50.001))
    with pytest.raises(NotClosingError):
        settled(four_bar(50.0, 90.002, 90.0, 50.001))


@pytest.mark.parametrize("size", [1.0, 100.0])
def test_pin_in_the_pivot_of_its_guide(size: float) -> None:
    """Where the pin is exactly in the pivot, and where it is there but for rounding."""
    with pytest.raises(NotClosingError):
        settled(swinging_guide(size, size))
    made = settled(swinging_guide(size, size * 1.001))
    fastest = made.track("guide.angle", np.array([1.5 * np.pi]), 1).derivatives()[1]
    assert fastest == pytest.approx(-1000.0, rel=1e-9)


def test_pin_in_the_pivot_at_the_start() -> None:
    dyad = Dyad("RTR1", "D", "B", "block", ("guide", "slide"), Lengths(0.0, 0.0))
    parts = four_bar(base=40.0).elements
    made = linkage(*(one for one in parts if "C" not in one.gives and "P" not in one.gives), dyad)
    with pytest.raises(NotClosingError) as caught:
        settled(made)
    assert caught.value.closing.changes == pytest.approx((0.0,), abs=1e-9)


def test_coefficients_that_all_points_have() -> None:
    """A jet may hold one number for all points, which is complex here."""
    coefficients: list[Any] = [np.array([1 + 2j]), 3 + 4j, 5.0]
    z = Jet(coefficients)
    assert [np.ravel(part)[0] for part in real(z).c] == [1.0, 3.0, 5.0]
    assert [np.ravel(part)[0] for part in imaginary(z).c] == [2.0, 4.0, 0.0]
    assert [np.ravel(part)[0] for part in conjugate(z).c] == [1 - 2j, 3 - 4j, 5.0]


def test_a_joint_that_stands_still_is_a_point_of_the_ground() -> None:
    made = linkage(MemberPoint("A", 3 + 4j))
    assert made.track("A", np.zeros(2), 1).derivatives()[0] == pytest.approx(3 + 4j)


@pytest.mark.parametrize(
    ("rods", "offered"),
    [
        ((60.0, 70.0), [{0: 80.0 * 1.001}, {1: 90.0 * 1.001}]),  # too short together
        ((170.0, 60.0), [{1: 100.0 * 1.001}, {0: 130.0 * 0.999}]),  # too different
        ((60.0, 170.0), [{0: 100.0 * 1.001}, {1: 130.0 * 0.999}]),
        ((20.0, 300.0), [{0: 230.0 * 1.001}]),
    ],
)
def test_offered_rods(rods: tuple[float, float], offered: list[dict[int, float]]) -> None:
    """The ends of the rods come as near as 70 mm and go as far as 150 mm."""
    with pytest.raises(NotClosingError) as caught:
        settled(four_bar(40.0, *rods, 110.0))
    found = caught.value.nearest
    assert [one.keys() for one in found] == [one.keys() for one in offered]
    for one, other in zip(found, offered, strict=True):
        assert one == pytest.approx(other)
        lengths = {0: rods[0], 1: rods[1]} | one
        settled(four_bar(40.0, lengths[0], lengths[1], 110.0))


def test_both_rods_are_offered_where_one_does_not_do() -> None:
    """Ends between 10 mm and 210 mm apart."""
    with pytest.raises(NotClosingError) as caught:
        settled(four_bar(100.0, 60.0, 55.0, 110.0))
    (found,) = caught.value.nearest
    assert found == pytest.approx({0: 105.105 + 2.5, 1: 105.105 - 2.5})
    settled(four_bar(100.0, found[0], found[1], 110.0))
