"""True errors of a pair's numbers, against 30 digits, beside their estimates if they have any."""

from __future__ import annotations

import math
from dataclasses import dataclass, field
from itertools import pairwise
from typing import Any

import numpy as np

import gearcam
from claims.claim import ExactCase
from gearcam.base.errors import InfeasibleError
from gearcam.base.tolerances import DEFAULT
from gearcam.gears.estimates import pair_errors
from gearcam.gears.pair import GearPair
from gearcam.gears.rolling import Rolling, roll
from gearcam.gears.track import WHEELS, Wheel
from witness.exact import Exact, Number, mp

gc: Any = gearcam
MODULE = 2.0
RING_TYPE = {1: "external", 0: "external", -1: "internal"}
ROUNDING = 1e-13
KNOWN = 1e-11
"""Share of its size by which a number without an estimate may be off."""


@dataclass(frozen=True)
class Row:
    """A number's error: true, estimated or not, and the size of what it is made of."""

    name: str
    true: float
    told: float | None
    scale: float

    @property
    def honest(self) -> bool:
        return self.true <= (KNOWN * self.scale if self.told is None else self.told)

    def tight(self, factor: float) -> bool:
        return self.told is None or self.told <= max(factor * self.true, ROUNDING * self.scale)


def off(found: Any, true: Any) -> float:
    """Largest distance of numbers from the true ones."""
    return max(
        float(abs(mp.mpmathify(complex(a) if np.iscomplexobj(a) else float(a)) - b))
        for a, b in zip(found, true, strict=True)
    )


def places(case_law: Any) -> np.ndarray:
    """Driver angles in a lobe: all around, where the ratio is largest and where it is steep."""
    period = case_law.period
    grid = np.linspace(0.0, period, 4001)[1:-1]
    ratio, slope = np.abs(case_law.ratio.derivatives(grid, 1))
    steep = np.cumsum(slope) + 1e-9 * np.arange(grid.size)
    among = np.interp(np.linspace(0.0, steep[-1], 9)[1:-1], steep, grid)
    even = period * (np.arange(9) + 0.37) / 9.0
    return np.unique(np.concatenate([among, even, grid[[ratio.argmax(), slope.argmax()]]]))


def largest(function: Any, place: float, knots: np.ndarray, width: float) -> Number:
    """Largest value of a function near a place, by golden section, never across a knot."""
    ends = [place - width, *(k for k in knots if abs(k - place) < width), place + width]
    low_end, high_end = float(knots[0]), float(knots[-1])
    ends = sorted({min(max(end, low_end), high_end) for end in ends})
    return max(largest_between(function, mp.mpf(a), mp.mpf(b)) for a, b in pairwise(ends))


def largest_between(function: Any, low: Number, high: Number) -> Number:
    """Largest value of a function between two places, by golden section, or at an end."""
    golden = (mp.sqrt(5) - 1) / 2
    ends = [function(low), function(high)]
    for _ in range(60):
        step = golden * (high - low)
        one, two = high - step, low + step
        low, high = (low, two) if function(one) > function(two) else (one, high)
    return max(*ends, function((low + high) / 2))


def of_the_law(case: ExactCase, law: Any, exact: Exact, rolling: Rolling, told: float) -> list[Row]:
    """Driven angle, arc length, size."""
    x = places(law)
    truth = [exact.integral(mp.mpf(float(place))) for place in x]
    size = mp.mpf(rolling.center_distance)
    advance, length = exact.integral(exact.period)
    lobes = max(track.length for track in rolling.tracks) / rolling.arc.length
    turned = off([*law.phi2(x), law.travelled], [*(phi2 for phi2, _ in truth), advance])
    # at the same size, that only the expansions err; a turn is all its lobes
    arcs = off(
        [*rolling.arc.at(np.zeros(x.shape), x), rolling.arc.length],
        [*(size * arc for _, arc in truth), size * length],
    )
    true_size = mp.mpf(MODULE) * mp.pi * case.teeth[0] / (length * law.lobes.n1)
    return [
        Row("law", turned, told, law.advance),
        Row("arc_length_mm", arcs * lobes, None, rolling.arc.length * lobes),
        Row("size", float(abs(size / true_size - 1)), None, 1.0),
    ]


def of_ratios(law: Any, exact: Exact) -> Row:
    (least, low), (most, high) = law.ratio_range
    width = 1e-3 * law.period

    def ratio(x: Number) -> Number:
        return exact.ratio(x).v

    truth = (
        -largest(lambda x: -ratio(x), least, law.knots, width),
        largest(ratio, most, law.knots, width),
    )
    return Row("ratio", off((low, high), truth), None, high * (1.0 + high))


def of_curvatures(case: ExactCase, rolling: Rolling, exact: Exact) -> list[Row]:
    """Least convex radius and largest concave curvature of both centrodes, each near its place.

    At a knot of both pieces; those of the spirals beyond an open pair's ends are left out.
    """
    law = rolling.law
    length = exact.integral(exact.period)[1] * law.lobes.n1
    size = mp.mpf(MODULE) * mp.pi * case.teeth[0] / length
    # of differences of knots and of ratios
    near, finest = 1e-3 * law.period, law.period / np.diff(law.knots).min()

    def most_bent(track: Any, sign: int) -> tuple[Number, float] | None:
        """What it bends to one side by, and what that is made of: both bends add up."""
        phi, kappa = track.curvature_extremes
        place, found = float(phi[(sign * kappa).argmax()]), []
        for low, high, function in exact.pieces:
            first, last = max(low, place - near), min(high, place + near)
            if first < last and 0.0 <= place <= law.period:
                bent = lambda x, f=function: sign * exact.bends(f, x)[track.wheel - 1]  # noqa: E731
                both = sum(map(abs, exact.bends(function, (first + last) / 2)))
                found.append((largest_between(bent, first, last) / size, float(both / size)))
        return max(found, default=None)

    radii, concave = [], []
    # a second derivative has fewer digits, most of all that of a Python function
    finest *= 1e3 if law.function_error else 10.0
    for track in rolling.tracks:
        radius, hollow = track.convex.radius, 1.0 / track.concave.radius
        if (true := most_bent(track, 1)) and radius < 1e12 * track.length:
            radii.append((float(abs(mp.mpf(radius) - 1 / true[0])), radius**2 * true[1] * finest))
        if true := most_bent(track, -1):
            concave.append((float(abs(mp.mpf(hollow) - max(true[0], 0))), true[1] * finest))
    named = ("convex_radius_mm", radii), ("concave_curvature_per_mm", concave)
    return [
        Row(name, max(off for off, _ in rows), None, max(size for _, size in rows))
        for name, rows in named
        if rows
    ]


def of_flanks(case: ExactCase, pair: GearPair, exact: Exact, told: float) -> Row:
    """Points on flanks beside places of a turn, and the pitch point's own flank."""
    law, worst, far = pair.law, 0.0, 0.0
    length = exact.integral(exact.period)[1] * law.lobes.n1
    size = mp.mpf(MODULE) * mp.pi * case.teeth[0] / length
    pitch, alpha = mp.mpf(MODULE) * mp.pi, mp.mpf(pair.rack.pressure_angle)
    x = places(law)
    phi = x + law.period * (np.arange(x.size) * 7 % law.lobes.n1)
    for toothing in pair.toothings:
        wheel = toothing.wheel
        arcs = toothing.track.arc_length(phi)
        for number, (place, s) in enumerate(zip(phi.tolist(), arcs.tolist(), strict=True)):
            sigma = 1 - 2 * (number % 2)
            tooth = round(s / toothing.pitch + (1.2 if number % 3 else -1.2))
            middle = mp.mpf(2 * tooth + wheel - 1) / 2
            sf = toothing.pitch * float(middle) + sigma * toothing.half_tooth
            frames = toothing.frames(np.array([place]))
            found = toothing.flank_points(frames, np.array([sf]), sigma)
            true_sf = (middle + mp.mpf(sigma) / 4) * pitch
            true = exact.flank_point(wheel, mp.mpf(place), size, true_sf, sigma, alpha)
            worst, far = max(worst, off(found, [true])), max(far, abs(complex(frames.p[0])))
    return Row("flank_mm", worst, told, far)


def of_accelerations(result: Any, exact: Exact) -> Row:
    """The largest slope of the ratio, near its place."""
    law, (places, values) = result.law, result.subject.accelerations
    worst = int(np.argmax(np.abs(values)))
    place, sign = float(places[worst]), math.copysign(1.0, float(values[worst]))

    def slope(x: Number) -> Number:
        return mp.mpf(sign) * exact.ratio(x).d

    true = largest(slope, place, law.knots, 1e-3 * law.period)
    size = mp.mpf(law.lobes.advance) / mp.mpf(law.lobes.period) if exact.mate == 0 else mp.mpf(1)
    found = mp.mpf(abs(float(values[worst])))
    # of differences of knots and of ratios
    high = law.ratio_range[1][1] / result.pair.rolling.mean_radius
    made_of = (float(found) * law.period + high) / np.diff(law.knots).min()
    return Row("acceleration_per_rad", float(abs(found - true / size)), None, made_of)


def of_pressure_angles(result: Any, exact: Exact) -> Row:
    subject, worst = result.subject, 0.0
    law = result.law
    for way, sign in (("forward", -1), ("backward", 1)):
        place, found = subject.pressure_angles[way]

        def angle(x: Number, sign: int = sign) -> Number:
            r = exact.radius(exact.ratio(x))
            return mp.mpf(subject.pair.rack.pressure_angle) + sign * mp.atan2(r.d, r.v)

        true = largest(angle, place, law.knots, 1e-3 * law.period)
        worst = max(worst, float(abs(mp.mpf(found) - true)))
    return Row("pressure_angle_deg", math.degrees(worst), None, math.degrees(1.0))


def true_tip(
    toothing: Any, exact: Exact, size: Number, middle: Number, sigma: int, near: tuple[float, float]
) -> tuple[Number, Number]:
    """Return the place where a flank meets the addendum curve, and the point, in 30 digits.

    By Newton's method with slopes in double precision: each step gains a dozen digits.
    """
    pitch, alpha = mp.mpf(MODULE) * mp.pi, mp.mpf(toothing.cutter.alpha)
    sf, height = (middle + mp.mpf(sigma) / 4) * pitch, mp.mpf(toothing.cutter.addendum)
    frames = toothing.frames(np.array(near))
    one = complex(toothing.flank_motion(frames, np.array([float(sf)] * 2), sigma)[0])
    slide = frames.speed[1] * (1.0 + frames.kappa[1] * float(height)) * frames.t[1]
    matrix = np.array([[one.real, -slide.real], [one.imag, -slide.imag]])
    (x, y), miss = (mp.mpf(value) for value in near), mp.inf
    for _ in range(4):
        point = exact.flank_point(toothing.wheel, x, size, sf, sigma, alpha)
        miss = point - exact.tip_point(toothing.wheel, y, size, height)
        # of a miss as small as this only its digits count
        scale = max(abs(miss), mp.mpf(10) ** -28)
        step = np.linalg.solve(matrix, [float(miss.real / scale), float(miss.imag / scale)])
        x, y = x - scale * mp.mpf(step[0]), y - scale * mp.mpf(step[1])
    assert abs(miss) < 1e-22
    return x, exact.flank_point(toothing.wheel, x, size, sf, sigma, alpha)


@dataclass(frozen=True, eq=False)
class Tips:
    """True tips of a result's flanks, each found once."""

    result: Any
    exact: Exact
    size: Number
    known: dict[tuple[int, int, int], Any] = field(default_factory=dict)

    def of(self, wheel: Wheel, tooth: int, sigma: int) -> Any:
        """Reach and point of a flank's tip; None where it does not end at the addendum curve."""
        key = wheel, tooth, sigma
        if not _inside(self.result.pair, wheel, tooth):
            return None
        if key not in self.known:
            self.known[key] = self._found(*key)
        return self.known[key]

    def _found(self, wheel: Wheel, tooth: int, sigma: int) -> Any:
        toothing = self.result.pair.toothings[wheel - 1]
        tips, count = self.result.gears[wheel - 1].profile.flanks.tips, len(toothing.numbers)
        index = list(toothing.numbers).index(tooth) + (0 if sigma > 0 else count)
        if not tips.full[index]:
            return None
        middle = mp.mpf(2 * tooth - 3 + wheel) / 2
        near = float(tips.phi[index]), float(tips.foot[index])
        x, point = true_tip(toothing, self.exact, self.size, middle, sigma, near)
        sf = (middle + mp.mpf(sigma) / 4) * mp.mpf(MODULE) * mp.pi
        return sigma * (sf - self.size * self.exact.frame(wheel, x)[3]), point


def of_contact(tips: Tips, told: float) -> list[Row]:
    """Contact ratios of a few pairs of flanks that end at both tips."""
    worst, pair = -1.0, tips.result.pair
    for pairs in tips.result.subject.sides:
        order = np.argsort(pairs.arcs.ratios)
        for j in order[[0, len(order) // 2, -1]]:
            ends = [
                tips.of(wheel, int(flanks.number(pairs.numbers[[j]])[0]), flanks.sigma)
                for wheel, flanks in zip(WHEELS, pairs.wheels, strict=True)
            ]
            if None in ends:
                continue
            true = sum(end[0] for end in ends) / (mp.mpf(MODULE) * mp.pi)
            error = float(abs(mp.mpf(float(pairs.arcs.ratios[j])) - true))
            if error < 1e-6:  # else roots end it
                worst = max(worst, error)
    return [Row("contact_ratio", worst, told, pair.teeth[0])] if worst >= 0.0 else []


def of_thickness(tips: Tips) -> list[Row]:
    """The thinnest tip of each wheel, where its flanks end at the addendum curve."""
    worst = -1.0
    for gear in tips.result.gears:
        toothing, thickness = gear.toothing, gear.profile.tip_thickness
        thinnest = int(thickness.argmin())
        tooth = list(toothing.numbers)[toothing.whole][thinnest]
        both = [tips.of(toothing.wheel, tooth, sigma) for sigma in (1, -1)]
        if None not in both:
            true = abs(both[0][1] - both[1][1])
            worst = max(worst, float(abs(mp.mpf(float(thickness[thinnest])) - true)))
    far = max(gear.largest_radius for gear in tips.result.gears)
    return [Row("tip_thickness_mm", worst, None, far)] if worst >= 0.0 else []


def _inside(pair: GearPair, wheel: Wheel, tooth: int) -> bool:
    """Whether a tooth lies on the law itself, not beyond the ends of an open one."""
    toothing = pair.toothings[wheel - 1]
    return pair.law.closed or 3 < tooth < toothing.teeth - 2


def rows_of(case: ExactCase) -> list[Row]:
    """Return all rows of a design; of one that no teeth fit those of its centrodes."""
    law = case.law.build(case.lobes, DEFAULT)
    exact = case.exact(law)
    rolling = roll(law, teeth=case.teeth, center_distance=None, module=MODULE, tolerances=DEFAULT)
    spec = gc.PairSpec(teeth=case.teeth, module=MODULE, type=RING_TYPE[case.mate])
    of_centrodes = [of_ratios(law, exact), *of_curvatures(case, rolling, exact)]
    try:
        result = gc.build(gc.GearPairDesign(name="one", law=case.law, pair=spec))
        driven, flank, contact_ratio = pair_errors(result.subject)
    except InfeasibleError:
        return [*of_centrodes, *of_the_law(case, law, exact, rolling, law.error)]
    length = exact.integral(exact.period)[1] * law.lobes.n1
    tips = Tips(result, exact, mp.mpf(MODULE) * mp.pi * case.teeth[0] / length)
    return [
        *of_centrodes,
        *of_the_law(case, law, exact, rolling, driven),
        of_flanks(case, result.pair, exact, flank),
        of_accelerations(result, exact),
        of_pressure_angles(result, exact),
        *of_contact(tips, contact_ratio),
        *of_thickness(tips),
    ]
