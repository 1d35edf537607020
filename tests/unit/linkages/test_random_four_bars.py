"""Measures of crank-rockers of any lengths against closed forms and dense sums."""

from __future__ import annotations

from functools import partial

import numpy as np
import pytest

from gearcam.linkages.grashof import FourBarLengths, turns_fully
from gearcam.linkages.paths import PointPath
from gearcam.numeric.arrays import Array, Plane
from helpers_measured import TURN, four_bar, measures


def _crank_rocker(seed: int) -> tuple[FourBarLengths, complex]:
    random = np.random.default_rng(seed)
    while True:
        crank, *others = np.sort(random.uniform(10.0, 100.0, 4)).tolist()
        lengths = FourBarLengths(crank, *random.permutation(others).tolist())
        if turns_fully(lengths):
            return lengths, complex(*random.uniform(-150.0, 150.0, 2))


@pytest.mark.parametrize("seed", range(20))
def test_limits_of_the_rocker(seed: int) -> None:
    lengths, _ = _crank_rocker(seed)
    crank, coupler, rocker, base = lengths
    found = measures(four_bar(base, lengths[:3]), "rocker.angle").dead_centers
    reach = np.array([coupler + crank, coupler - crank])
    cosine = (base**2 + rocker**2 - reach**2) / (2.0 * base * rocker)
    limits = np.sort(np.pi - np.arccos(cosine))
    assert [one.value for one in sorted(found)] == pytest.approx(limits, abs=1e-12)
    # the crank is in line with the coupler there
    along = (base**2 + reach**2 - rocker**2) / (2.0 * base * reach)
    turned = np.arccos(along) + np.array([0.0, np.pi])
    assert sorted(one.place for one in found) == pytest.approx(turned, abs=1e-7)


def _crossings(points: Plane) -> int:
    """Return how often a closed polygon crosses itself, each chord against all."""
    begin, end = points, np.roll(points, -1)
    one, two = np.triu_indices(points.size, 2)

    def side(p: Plane, q: Plane, r: Plane) -> Array:
        return np.imag(np.conj(q - p) * (r - p))

    parts = side(begin[one], end[one], begin[two]) * side(begin[one], end[one], end[two])
    other = side(begin[two], end[two], begin[one]) * side(begin[two], end[two], end[one])
    return int(np.count_nonzero((parts < 0.0) & (other < 0.0)))


@pytest.mark.parametrize("seed", range(20))
def test_length_area_and_crossings_of_coupler_curves(seed: int) -> None:
    lengths, point = _crank_rocker(seed)
    linkage = four_bar(lengths.base, lengths[:3], point)
    path = PointPath(partial(linkage.track, "P"), TURN)
    q = np.linspace(0.0, 2.0 * np.pi, 4096, endpoint=False)
    points, speeds = linkage.track("P", q, 1).derivatives()
    assert path.length.value == pytest.approx(2.0 * np.pi * np.abs(speeds).mean(), rel=1e-10)
    swept = np.pi * np.imag(np.conj(points) * speeds).mean()
    assert path.area is not None
    assert path.area.value == pytest.approx(swept, rel=1e-10, abs=1e-9)
    assert len(path.crossings) == _crossings(points[::4].astype(complex))
    for one in path.crossings:
        both = linkage.track("P", np.array(one[:2]), 0).derivatives()[0]
        assert abs(both[0] - both[1]) < 1e-12 * 300.0
