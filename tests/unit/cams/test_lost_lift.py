"""The lift of a follower that rests on a point of the cam, against fifty digits."""

from __future__ import annotations

import math
from typing import Any

import mpmath
import pytest

from gearcam.base.errors import InfeasibleError
from gearcam.cams.carriers import ROTATING
from gearcam.cams.curve import CamCurve
from gearcam.cams.placing import make_follower
from gearcam.cams.spec import CamSpec, FollowerSpec
from gearcam.cams.trim import Corner, lost_lift, resting
from gearcam.numeric.jets import Jet
from helpers_cams import follower_of, there_and_back


@pytest.mark.parametrize("radius", [5.0, 1e-3, 1e-8])
def test_an_arm_with_a_tiny_dome_rests_where_its_triangle_says(radius: float) -> None:
    """By the cosine of the angle at the pivot a dome of 1e-8 of the arm would be lost."""
    follower = FollowerSpec(
        type="domed", motion="oscillating", dome_radius=radius, arm=60.0, pivot_distance=80.0
    )
    arm: Any = make_follower(follower, CamSpec(base_radius=40.0))
    # a point that the dome reaches: 0.6 of its radius beyond the arm's end, seen from the pivot
    reach = 60.0 + 0.6 * radius
    point = complex(80.0 - reach * math.cos(0.3), reach * math.sin(0.3))
    lift = resting(arm, ROTATING, point)(Jet.variable(0.0, 0)).c[0]
    with mpmath.workdps(50):
        away = mpmath.sqrt(mpmath.mpf(80.0 - point.real) ** 2 + mpmath.mpf(point.imag) ** 2)
        r, length = mpmath.mpf(arm.radius), mpmath.mpf(arm.arm)
        inside = mpmath.acos((away**2 + length**2 - r**2) / (2 * length * away))
        seen = mpmath.atan2(mpmath.mpf(point.imag), mpmath.mpf(80.0 - point.real))
        exact = seen + inside - mpmath.mpf(arm.start)
        assert abs(lift - float(exact)) < 1e-15


def test_a_corner_out_of_reach_is_refused() -> None:
    swinging = follower_of("swinging roller")
    program = there_and_back("cycloidal", 10.0, swings=True)
    corner = Corner(point=complex(1e4, 1e4), before=0.1, after=0.3)
    with pytest.raises(InfeasibleError, match="cannot rest"):
        lost_lift(CamCurve(program=program, follower=swinging, carrier=ROTATING, inset=8.0), corner)
