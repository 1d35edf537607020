"""Classes of four-bars against where the linkage itself closes, and known examples."""

from __future__ import annotations

from itertools import permutations

import numpy as np
import pytest

from gearcam.linkages.closing import NotClosingError, settled
from gearcam.linkages.grashof import FourBarLengths, grashof, turns_fully
from helpers_measured import four_bar, measures
from helpers_sampling import few


@pytest.mark.parametrize(
    ("lengths", "name", "turning", "spare"),
    [
        ((40, 120, 90, 110), "crank-rocker", ("driver",), 40),
        ((90, 120, 40, 110), "rocker-crank", ("follower",), 40),
        ((110, 90, 120, 40), "double crank", ("driver", "coupler", "follower"), 40),
        ((120, 40, 90, 110), "double rocker", ("coupler",), 40),
        ((80, 60, 70, 100), "triple rocker", (), -10),
        ((80, 120, 90, 110), "change point", ("driver",), 0),
        ((50, 120, 50, 120), "change point", ("driver", "follower"), 0),
    ],
)
def test_classes(
    lengths: tuple[float, ...], name: str, turning: tuple[str, ...], spare: float
) -> None:
    found = grashof(FourBarLengths(*lengths))
    assert (found.name, found.turning) == (name, turning)
    assert found.spare == pytest.approx(spare)


@pytest.mark.parametrize("whole", list(permutations((4, 6, 7, 9))))
def test_rounding_does_not_change_a_class(whole: tuple[int, ...]) -> None:
    tenths = FourBarLengths(*(one / 10 for one in whole))
    exact = FourBarLengths(*whole)
    assert grashof(tenths) == grashof(exact)
    assert grashof(tenths).name == "change point"
    assert turns_fully(tenths) == turns_fully(exact)


def _turns(lengths: FourBarLengths) -> bool:
    driver, coupler, follower, base = lengths
    try:
        settled(four_bar(base, (driver, coupler, follower)))
    except NotClosingError:
        return False
    return True


def test_the_longest_driver_that_turns() -> None:
    for driver, turns in ((79.0, True), (80.0, True), (81.0, False)):
        lengths = FourBarLengths(driver, 120.0, 90.0, 110.0)
        assert turns_fully(lengths) is _turns(lengths) is turns


@pytest.mark.parametrize("seed", few(range(60), 3))
def test_the_class_says_what_the_linkage_does(seed: int) -> None:
    values = np.random.default_rng(seed).uniform(20.0, 100.0, 4)
    lengths = FourBarLengths(*values.tolist())
    if 2.0 * max(lengths) >= sum(lengths):
        with pytest.raises(ValueError, match="the other three do not reach"):
            grashof(lengths)
        return
    found = grashof(lengths)
    back = lengths._replace(driver=lengths.follower, follower=lengths.driver)
    assert ("driver" in found.turning) == turns_fully(lengths) == _turns(lengths)
    assert ("follower" in found.turning) == turns_fully(back) == _turns(back)
    if "driver" in found.turning:
        linkage = four_bar(lengths.base, lengths[:3])
        rocker, coupler = (measures(linkage, f"{name}.angle") for name in ("rocker", "coupler"))
        assert ("follower" in found.turning) == (rocker.rise != 0.0)
        assert ("coupler" in found.turning) == (coupler.rise != 0.0)


def test_what_is_no_four_bar_is_refused() -> None:
    with pytest.raises(ValueError, match="follower 0 mm: must be above 0"):
        grashof(FourBarLengths(1.0, 1.0, 0.0, 1.0))
    with pytest.raises(
        ValueError, match="base 400 mm: the other three do not reach; it must be below 300 mm"
    ):
        grashof(FourBarLengths(100.0, 100.0, 100.0, 400.0))
