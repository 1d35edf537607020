"""A bump of the ratio narrower than a degree is seen by all that looks for extremes.

``ratio = s*(1 + a*b)`` with ``b = exp(-k*sin((phi1 - c)/2)^2)``, whose mean over a turn is
``exp(-k/2)*I0(k/2)``; at c its slope is 0 and its second derivative -k/2.
"""

from __future__ import annotations

import math
from functools import partial
from typing import Any

import mpmath
import pytest

import gearcam as gc
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


SLID = {
    # formula: the peaks of its derivatives, place in rad and value
    "20*sin(q) + 0.01*exp(-5000*(1 - cos(q - 1)))": (1.0, 5000.0, 0.01, 20.0),
    "20*sin(q) + 0.01*exp(-20000*(1 - cos(q - 1)))": (1.0, 20000.0, 0.01, 20.0),
    "0*sin(q) + 10*exp(-200*(1 - cos(q)))": (0.0, 200.0, 10.0, 0.0),
}
"""Where the bump is, its sharpness, its height, and the wave below it."""


def document(drive: dict[str, Any], **tables: Any) -> dict[str, Any]:
    rod = {"name": "rod", "on": "m", "joint": "J"}
    return {
        "kind": "mechanism", "name": "bumps", "drive": [{"name": "even", "even": True}, drive],
        "slide": [rod], "output": {"files": ["csv"], "outputs": ["rod"]}, **tables,
    }  # fmt: skip


def peak(order: int, place: float, sharp: float, height: float, wave: float) -> tuple[float, float]:
    """The largest derivative of an order of wave and bump beside the bump, from its next roots."""

    def lift(x: Any) -> Any:
        return wave * mp.sin(x) + height * mp.exp(-sharp * (1 - mp.cos(x - place)))

    starts = [place + k / math.sqrt(sharp) for k in (-1.73, -0.742, 0.0, 0.742, 1.73)]
    with mp.workdps(40):
        step = mp.mpf(0.01) / mp.sqrt(sharp)
        slope = partial(mp.diff, lift, n=order + 1)
        roots = [mp.findroot(slope, (one, one + step), verify=False) for one in starts]
        values = [(float(x), float(mp.diff(lift, x, order))) for x in roots]
    return max(values, key=lambda one: abs(one[1]))


@pytest.mark.parametrize("formula", SLID)
def test_a_machine_sees_a_narrow_bump_of_a_slide(formula: str) -> None:
    drive = {"name": "m", "slide": formula}
    facts = gc.build(gc.design(document(drive))).facts
    for order, name in ((2, "acceleration"), (3, "jerk")):
        place, value = peak(order, *SLID[formula])
        found = facts[f"outputs.rod.{name}_mm_per_rad{order}"]
        assert abs(found) == pytest.approx(abs(value), rel=1e-9)
        at = math.radians(facts[f"outputs.rod.{name}_at_deg"])
        assert math.cos(at - SLID[formula][0]) == pytest.approx(
            math.cos(place - SLID[formula][0]), abs=1e-9
        )
    stroke = facts["outputs.rod.stroke_mm"]
    assert stroke == pytest.approx(40.0 if SLID[formula][3] else 10.0, abs=1e-9)


def test_a_machine_sees_a_narrow_bump_behind_a_cam_and_behind_a_pair() -> None:
    lift = "10*exp(-200*(1 - cos(theta)))"
    cam = {
        "kind": "cam", "name": "c", "motion": {"lift": lift},
        "follower": {"type": "roller", "roller_radius_mm": 2}, "cam": {"prime_radius_mm": 200},
    }  # fmt: skip
    rod = {"name": "rod", "on": "m.follower", "joint": "J"}
    made = gc.build(gc.design(document({"name": "m", "cam": cam}, slide=[rod])))
    assert made.facts["outputs.rod.stroke_mm"] == pytest.approx(10.0, abs=1e-9)
    assert made.facts["outputs.rod.acceleration_mm_per_rad2"] == pytest.approx(-2000.0, rel=1e-12)
    k, a = 2e4, 1e-3
    pair = bump(k, a, 1.8).design.to_dict()
    crank = {"name": "crank", "on": "m.wheel2", "joint": "B", "length_mm": 40}
    asked = {"files": ["csv"], "outputs": ["crank.angle"]}
    turned = document({"name": "m", "pair": pair}, crank=[crank], slide=[], output=asked)
    facts = gc.build(gc.design(turned)).facts
    steepest = -highest(k, a)[1] * math.sqrt(2 / k) * math.exp(-0.5)
    found = abs(facts["outputs.crank.acceleration_rad_per_rad2"])
    assert found == pytest.approx(steepest, rel=1e-4)


@pytest.mark.parametrize("width", [0.1, 0.05, 0.01])
def test_a_bump_in_one_turn_only_does_not_repeat(width: float) -> None:
    drive = {"name": "m", "slide": f"20*sin(q) + 10*exp(-((q - 2)/{width})**2)"}
    with pytest.raises(InfeasibleError, match="does not return within 100 turns"):
        _ = gc.build(gc.design(document(drive))).linkage


def test_a_bump_in_the_second_turn_is_seen() -> None:
    drive = {"name": "m", "slide": "20*sin(q) + 10*exp(-400*(1 - cos(q/2 - 4)))"}
    low, high = gc.build(gc.design(document(drive))).linkage.span
    assert high - low == pytest.approx(4 * math.pi)


def test_a_slide_with_a_corner_is_refused() -> None:
    drive = {"name": "m", "slide": "sqrt((q - 3)**2)*sin(q)"}
    with pytest.raises(InfeasibleError, match="not smooth") as caught:
        _ = gc.build(gc.design(document(drive))).linkage
    assert caught.value.where == "drive[1].slide"
