"""The published numbers of non-circular pairs, to every digit printed."""

from __future__ import annotations

import math
from typing import Any

import numpy as np
import pytest

from gearcam.base.tolerances import DEFAULT
from gearcam.gears.rolling import Rolling, roll
from gearcam.laws.ratio.ellipse import Ellipse
from gearcam.laws.ratio.formula import Formula
from gearcam.laws.ratio.phases import Phases
from gearcam.laws.ratio.span import Lobes
from witness import laws, oracle

UNDERCUT = math.sin(math.radians(20)) ** 2


def printed(value: float, text: str) -> bool:
    """Whether a number rounds to the digits printed."""
    return abs(value - float(text)) <= 0.5000001 * 10.0 ** -len(text.partition(".")[2])


def pair(
    law: Any, teeth: int, *, module: float | None = None, distance: float | None = None
) -> Rolling:
    built = law.build(Lobes(1, 1), DEFAULT)
    return roll(
        built, teeth=(teeth, teeth), center_distance=distance, module=module, tolerances=DEFAULT
    )


def nail(phases: int) -> Rolling:
    knots = {2: (0, 160, 360), 3: (0, 160, 270, 360)}[phases]
    ratios = {2: (1.6, 0.4, 1.6), 3: (1.6, 0.4, "solve", 1.6)}[phases]
    law = Phases(shape="cosine", knots=tuple(np.radians(knots)), ratios=ratios)
    return pair(law, 36, distance=180.0)


def curvatures(rolling: Rolling, wheel: Any) -> np.ndarray:
    return rolling.tracks[wheel - 1].curvature_extremes[1]


# A value of 59.7386 circulates for the driver in three phases: a sample beside the minimum. The
# mpmath witness, and finite differences of positions in 40 digits, give 59.738483.
NAIL = {
    2: ("556.7768355399", "4.9229880875", "68.0793", "144.4514", "29.2869", "3.4259"),
    3: ("561.0187056128", "4.9604944536", "59.7385", "88.9888", "26.0013", "3.0416"),
}


@pytest.mark.parametrize("phases", NAIL)
def test_nail_machine(phases: int) -> None:
    length, module, convex, concave, driven, limit = NAIL[phases]
    rolling = nail(phases)
    assert printed(rolling.tracks[0].length, length)
    assert printed(rolling.tracks[1].length, length)
    assert printed(rolling.tracks[0].length / (36 * math.pi), module)
    assert printed(1 / curvatures(rolling, 1).max(), convex)
    assert printed(-1 / curvatures(rolling, 1).min(), concave)
    assert printed(1 / curvatures(rolling, 2).max(), driven)
    assert printed(UNDERCUT / curvatures(rolling, 2).max(), limit)


def test_three_phases_close_with_the_printed_ratio() -> None:
    solved = nail(3).law.solved
    assert len(solved) == 1
    assert next(iter(solved.values())) == pytest.approx(1.06, abs=1e-14)


@pytest.mark.parametrize(("e", "text"), [(0.3, "41.9606757804"), (0.5, "43.8870922799")])
def test_ellipse(e: float, text: str) -> None:
    rolling = pair(Ellipse(eccentricity=e), 41, module=1.0)
    assert printed(rolling.center_distance, text)
    assert 1 / curvatures(rolling, 1).max() == pytest.approx(
        rolling.center_distance / 2 * (1 - e * e), rel=1e-12
    )
    angle = np.array([1.1])
    exact = 2 * math.atan((1 - e) / (1 + e) * math.tan(0.55))
    assert rolling.law.phi2(angle)[0] == pytest.approx(exact, abs=1e-14)


@pytest.mark.parametrize(("e", "text"), [(0.0, "17.097"), (0.3, "18.358"), (0.5, "21.297")])
def test_fewest_teeth_of_an_ellipse(e: float, text: str) -> None:
    rolling = pair(Ellipse(eccentricity=e), 41, distance=2.0)
    assert printed(
        rolling.tracks[0].length * curvatures(rolling, 1).max() / (math.pi * UNDERCUT), text
    )


def test_two_lobes() -> None:
    rolling = pair(Formula(r1="1/(1 + 0.3*cos(2*phi1))"), 36, module=1.0)
    assert printed(rolling.center_distance, "34.5409988531")


@pytest.mark.parametrize(
    ("offset", "over_radius", "distance"),
    [(0.1, "2.00498446026775", None), (0.3, "2.04379288568712", "24.5255146282")],
)
def test_eccentric_circle(offset: float, over_radius: str, distance: str | None) -> None:
    shape = f"{offset}*cos(phi1) + sqrt(1 - ({offset}*sin(phi1))**2)"
    rolling = pair(Formula(r1=shape), 24, module=1.0)
    # its centrode is a circle of radius R: A/R from the length
    radius = rolling.tracks[0].length / (2 * math.pi)
    assert printed(rolling.center_distance / radius, over_radius)
    if distance is not None:
        assert printed(rolling.center_distance, distance)


@pytest.mark.parametrize("wheel", [1, 2])
@pytest.mark.parametrize("phases", NAIL)
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
