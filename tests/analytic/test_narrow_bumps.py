"""A bump of the ratio narrower than a degree is seen by all that looks for extremes.

``ratio = s*(1 + a*b)`` with ``b = exp(-k*sin((phi1 - c)/2)^2)``, whose mean over a turn is
``exp(-k/2)*I0(k/2)``; at c its slope is 0 and its second derivative -k/2.
"""

from __future__ import annotations

import math
from typing import Any

import mpmath
import pytest

from gearcam.base.errors import InfeasibleError
from gearcam.kinds.gear_pair.result import GearPairResult
from gearcam.laws.ratio.formula import Formula
from helpers_pairs import job

mp: Any = mpmath

CENTERS = [1.0, 1.8, 3.6]
WIDTHS = {"half a degree": (2e4, 1e-3), "0.06 degrees": (2e6, 1e-5)}
"""k and a."""


def bump(k: float, a: float, c: float) -> GearPairResult:
    ratio = f"1 + {a!r}*exp(-{k!r}*sin((phi1 - {c!r})/2)**2)"
    return job(Formula(ratio=ratio), (300, 300), distance=300.0, tolerance=0.01)


def highest(k: float, a: float) -> tuple[float, float]:
    """The ratio at c, and its second derivative."""
    scale = 1 / (1 + a * float(mp.exp(-mp.mpf(k) / 2) * mp.besseli(0, mp.mpf(k) / 2)))
    return scale * (1 + a), -0.5 * scale * a * k


@pytest.mark.parametrize("width", WIDTHS)
@pytest.mark.parametrize("center", CENTERS)
def test_the_sharpest_places_of_both_centrodes(width: str, center: float) -> None:
    k, a = WIDTHS[width]
    made = bump(k, a, center)
    (i, bend), size = highest(k, a), 300.0
    r, ddr = size * i / (1 + i), size * bend / (1 + i) ** 2
    convex = (r - ddr) / r**2
    first, second = made.pair.rolling.tracks
    assert first.convex.radius == pytest.approx(1 / convex, rel=1e-9)
    assert second.concave.radius == pytest.approx(1 / (convex - (1 + i) / r), rel=1e-9)
    assert math.isclose(second.concave.phi, center, abs_tol=1e-6)
    assert made.pair.toothings[1].cutter.kind == "pinion"


@pytest.mark.parametrize("center", CENTERS)
def test_the_largest_ratio_pressure_angle_and_acceleration(center: float) -> None:
    """Beside its top, at u = phi1 - c, the bump is ``exp(-k*u^2/4)`` to ``k*u^4/48``."""
    k, a = WIDTHS["half a degree"]
    made = bump(k, a, center)
    i, bend = highest(k, a)
    steepest = -bend * math.sqrt(2 / k) * math.exp(-0.5)
    assert made.law.ratio_range[1] == pytest.approx((center, i), rel=1e-8)
    assert made.subject.accelerations[1].max() == pytest.approx(steepest, rel=1e-4)
    # tan(psi) = r1'/r1 = i'/(i*(1 + i))
    slope = math.atan(steepest / 2)
    assert made.subject.slopes[1].max() == pytest.approx(slope, rel=1e-3)


@pytest.mark.parametrize("center", CENTERS)
def test_a_ratio_below_zero_in_a_narrow_dip_is_refused(center: float) -> None:
    with pytest.raises(InfeasibleError, match="positive"):
        _ = bump(2e4, -1.01, center).law
