"""Published numbers and the oracle's curvatures of pairs; others are those of the gallery."""

from __future__ import annotations

import math
from typing import Any

import numpy as np
import pytest

from gearcam.base.tolerances import DEFAULT
from gearcam.gears.rolling import Rolling, roll
from gearcam.laws.ratio.ellipse import Ellipse
from gearcam.laws.ratio.phases import Phases
from gearcam.laws.ratio.span import Lobes
from witness import laws, oracle

UNDERCUT = math.sin(math.radians(20)) ** 2


def printed(value: float, text: str) -> bool:
    """Whether a number rounds to the digits printed."""
    return abs(value - float(text)) <= 0.5000001 * 10.0 ** -len(text.partition(".")[2])


def pair(law: Any, teeth: int, distance: float) -> Rolling:
    built = law.build(Lobes(1, 1), DEFAULT)
    return roll(
        built, teeth=(teeth, teeth), center_distance=distance, module=None, tolerances=DEFAULT
    )


def nail(phases: int) -> Rolling:
    knots = {2: (0, 160, 360), 3: (0, 160, 270, 360)}[phases]
    ratios = {2: (1.6, 0.4, 1.6), 3: (1.6, 0.4, "solve", 1.6)}[phases]
    law = Phases(shape="cosine", knots=tuple(np.radians(knots)), ratios=ratios)
    return pair(law, 36, 180.0)


def curvatures(rolling: Rolling, wheel: Any) -> np.ndarray:
    return rolling.tracks[wheel - 1].curvature_extremes[1]


@pytest.mark.parametrize(("e", "text"), [(0.0, "17.097"), (0.3, "18.358"), (0.5, "21.297")])
def test_fewest_teeth_of_an_ellipse(e: float, text: str) -> None:
    rolling = pair(Ellipse(eccentricity=e), 41, 2.0)
    assert printed(
        rolling.tracks[0].length * curvatures(rolling, 1).max() / (math.pi * UNDERCUT), text
    )


@pytest.mark.parametrize("wheel", [1, 2])
@pytest.mark.parametrize("phases", [2, 3])
def test_curvature_at_every_place_is_that_of_the_oracle(phases: int, wheel: Any) -> None:
    exact = oracle.Pair({2: laws.NAIL_TWO, 3: laws.NAIL_THREE}[phases], oracle.mp.mpf(180))
    phi = 0.05 + 2 * math.pi * np.arange(24) / 24
    expected = [float(exact.curvature(wheel, oracle.mp.mpf(float(x)))) for x in phi]
    assert nail(phases).tracks[wheel - 1].frames(phi).kappa == pytest.approx(
        expected, rel=1e-11, abs=1e-15
    )


def test_printed_counts_the_digits() -> None:
    assert printed(59.73848, "59.7385")
    assert not printed(59.73844, "59.7385")
