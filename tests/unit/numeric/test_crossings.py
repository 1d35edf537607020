"""Crossings of parametric curves against closed forms."""

from __future__ import annotations

import math
from dataclasses import dataclass, field

import numpy as np
import pytest
from numpy.typing import NDArray

from gearcam.numeric.crossings import Chain, remaining, rows_between

Array = NDArray[np.float64]
Index = NDArray[np.int64]
Mask = NDArray[np.bool_]

TURN = 2.0 * math.pi


@dataclass(frozen=True)
class Parallel:
    """The inner parallel of an ellipse with the half axes 2 and 1, in two curves."""

    distance: float
    start = np.array([0.0, 2.0])
    end = np.array([2.0, TURN])
    corner: Mask = field(default_factory=lambda: np.array([False, False]))
    breaks = (np.array([], dtype=np.int64), np.array([]))

    def at(
        self, index: Index, parameter: Array
    ) -> tuple[NDArray[np.complex128], NDArray[np.complex128]]:
        del index
        tangents = -2.0 * np.sin(parameter) + 1j * np.cos(parameter)
        tangents /= np.abs(tangents)
        return 2.0 * np.cos(parameter) + 1j * np.sin(parameter) + 1j * self.distance * tangents, (
            tangents
        )

    def chain(self, count: int) -> Chain:
        places = [np.linspace(*ends, count + 1) for ends in zip(self.start, self.end, strict=True)]
        low, high = (np.concatenate([p[k : k + count] for p in places]) for k in (0, 1))
        curve = np.repeat([0, 1], count)
        return Chain(curve=curve, low=low, high=high, points=self.at(curve, low)[0])


@pytest.mark.parametrize(("count", "cornered"), [(40, False), (1000, False), (40, True)])
def test_a_parallel_too_far_in_loses_its_loops(count: int, cornered: bool) -> None:
    # it crosses the long axis where 1 + 3*sin(t)^2 is (2*distance)^2
    curves = Parallel(0.8, np.array([False, cornered]))
    ((ring,),) = remaining(curves, [curves.chain(count)])
    angle = math.asin(math.sqrt((1.6**2 - 1.0) / 3.0))
    ends = sorted((branch.begin.parameter, branch.end.parameter) for branch in ring.branches)
    wanted = [(angle, math.pi - angle), (math.pi + angle, TURN - angle)]
    assert np.abs(np.array(ends) - wanted).max() < 1e-14
    assert ring.crossed
    assert ring.gap < 1e-15
    assert ring.area > 0.0
    index, start, end, corner = rows_between(curves, ring.branches)
    rows = sorted(zip(start.tolist(), end.tolist(), index.tolist(), corner.tolist(), strict=True))
    assert [(row[2], row[3]) for row in rows] == [(0, True), (1, cornered), (1, True)]
    assert rows[0][1] == rows[1][0] == 2.0


def test_a_simple_curve_stays() -> None:
    curves = Parallel(0.4)
    ((ring,),) = remaining(curves, [curves.chain(100)])
    assert not ring.crossed
    assert ring.branches == (((0, 0.0), (1, TURN)),)
