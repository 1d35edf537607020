"""A guide whose pivot is passed closely turns half a turn there, every time it is passed."""

from __future__ import annotations

import math
from functools import partial

import pytest

from gearcam.linkages.dyads import Lengths
from gearcam.linkages.elements import Crank, Dyad, GivenMotion, MemberPoint
from gearcam.linkages.linkage import Linkage
from gearcam.linkages.measures import TrackMeasures
from gearcam.linkages.narrow import with_narrow_places
from gearcam.numeric.arrays import Array
from gearcam.numeric.jets import Jet
from helpers_measured import TURN, even

CRANK = 100.0


def _twice(q: Array, order: int) -> Jet:
    return Jet.variable(q, order) * 2.0


@pytest.mark.parametrize("gap", [1.0, 0.01, 1e-4])
def test_a_pin_that_passes_the_pivot_twice(gap: float) -> None:
    """The pin goes round the pivot twice in a turn; the pivot is nearer to it the second time."""
    linkage = Linkage(
        [
            GivenMotion("fast", _twice),
            GivenMotion("slow", even),
            MemberPoint("O", 0j),
            Crank("crank", "fast", "O", "A", CRANK, 0.3137),
            MemberPoint("Q", complex(gap - CRANK)),
            Crank("wobble", "slow", "Q", "P", 0.49 * gap, 1.234),
            Dyad("RTR1", "P", "A", "B", ("rocker", "block"), Lengths(0.0, 0.0)),
        ],
        TURN,
    )
    found = with_narrow_places(linkage)
    angle = TrackMeasures(partial(found.real_track, "rocker.angle"), found.knots)
    assert angle.rise == pytest.approx(4.0 * math.pi, rel=1e-12)
    assert angle.dead_centers == ()
