"""Numbers that the gallery must show: closed forms, roots and integrals of raw laws by mpmath."""

from __future__ import annotations

import cmath
import math
import re
from collections.abc import Callable, Iterable, Mapping, Sequence
from functools import cache
from itertools import pairwise
from typing import Any, Final

import mpmath
import numpy as np

mp: Any = mpmath
DEGREE = mp.pi / 180
DEG = math.degrees(1.0)

Number = tuple[float | Callable[[], float], float]
"""A value, or a function that computes it when it is needed, and how far off it may be."""


def length(ratio: Callable[[Any], Any], breaks: Sequence[Any], mate: int = 1) -> float:
    """Length of the driver's centrode for A = 1, from the ratio and its numerical derivative."""
    with mp.workdps(20):

        def share(phi: Any) -> Any:
            value = ratio(phi)
            return value / (1 + mate * value)

        def speed(phi: Any) -> Any:
            step = mp.mpf(10) ** -6
            slope = (share(phi + step) - share(phi - step)) / (2 * step)
            return mp.sqrt(share(phi) ** 2 + slope**2)

        parts = [mp.linspace(a, b, 5) for a, b in pairwise(breaks)]
        return float(sum(mp.quadgl(speed, part) for part in parts))


def by_module(ratio: Callable[[Any], Any], breaks: Sequence[Any], size: float) -> float:
    """Centre distance where the centrode is pi*`size` long, size = m*z."""
    return math.pi * size / length(ratio, breaks)


TURN = (0, mp.pi, 2 * mp.pi)


def limacon_distance() -> float:
    """L = 4*(1 + e)*E(4*e/(1 + e)^2); c from (c/k)^2 = (c - 1)^2 - e^2 with k = 1.5."""
    e, k = 0.25, 1.5
    b = (1 + k * math.sqrt(1 + (k * k - 1) * e * e)) / (k * k - 1)
    unit = 4 * (1 + e) * float(mp.ellipe(4 * e / (1 + e) ** 2))
    return (b + 1) * math.pi * 45 / unit


def lobed_ratio(phi: Any) -> Any:
    """r/(c - r) with r = 1 + 0.1*cos(2*phi) and c = 1 + b in closed form for 2 : 3 lobes."""
    return (1 + mp.cos(2 * phi) / 10) / (LOBED_B - mp.cos(2 * phi) / 10)


LOBED_B = (1 + math.sqrt(1 + (25 / 9 - 1) * (1 + 25 / 9 * 0.01))) / (25 / 9 - 1)


def spiral_distance() -> float:
    """L = (r_b - r_a)*sqrt(1 + k^2)/k, r from A/3 to 2*A/3 over 200 degrees."""
    k = math.log(2) / math.radians(200)
    return math.pi * 48 / (math.sqrt(1 + k * k) / (3 * k))


def nautilus_distance() -> float:
    """The spiral's length as above; on the return over t, with r1/A = u = (1 - h')/2.

    Written as h' = s*(p1 + p3*s^2 + p5*s^4), s = t/half, with the conditions at s = 1 solved by
    elimination: value v, slope d, second derivative b.
    """
    with mp.workdps(25):
        half = mp.mpf("95.386") * DEGREE / 2
        c = mp.log(2) / (2 * mp.pi - 2 * half)
        v, d = mp.mpf(1) / 3, -c * half * 8 / 9
        b = 2 * c * half * v * d
        p5 = (b - 3 * d + 3 * v) / 8
        p3 = (d - v) / 2 - 2 * p5
        p1 = v - p3 - p5

        def speed(s: Any) -> Any:
            g, slope = s * (p1 + s * s * (p3 + s * s * p5)), p1 + 3 * p3 * s**2 + 5 * p5 * s**4
            return mp.sqrt(((1 - g * g) / 2) ** 2 + (slope / (2 * half)) ** 2)

        turn = half * mp.quadgl(speed, mp.linspace(-1, 1, 5))
        return float(mp.pi * mp.mpf("76.8") / (mp.sqrt(1 + c * c) / (3 * c) + turn))


def spline_ratio(phi: Any) -> Any:
    """The spline rises by (3*t - t^3)/15 over a quarter; c by 30-digit quadrature."""
    t = phi / (mp.pi / 2)
    quarter, t = int(mp.floor(t)) % 4, t - mp.floor(t)
    t = 1 - t if quarter % 2 else t
    radius = 1 + (1 if quarter < 2 else -1) * (3 * t - t**3) / 15
    return radius / (mp.mpf("2.01705534812207634097601527257") - radius)


def two_speeds_ratio(phi: Any) -> Any:
    """0.8 for 120 degrees, 1.2 for another 120, quintics of 60 between."""
    x = phi / DEGREE
    if x <= 120 or x >= 360:
        return mp.mpf("0.8")
    if 180 <= x <= 300:
        return mp.mpf("1.2")
    t = (x - 120) / 60 if x < 180 else (360 - x) / 60
    return mp.mpf("0.8") + mp.mpf("0.4") * t**3 * (10 - 15 * t + 6 * t * t)


def polynomial_ratio(phi: Any) -> Any:
    """003 Table 2.6 as printed, a = 0.4."""
    u, v, w = 160 * DEGREE, 270 * DEGREE, 2 * mp.pi
    b = POLYNOMIAL_B
    if phi <= u:
        return 2 * (b - 0.4) / u**3 * phi**3 - 3 * (b - 0.4) / u**2 * phi**2 + b
    if phi <= v:
        return 0.4 + POLYNOMIAL_P * (phi - u) ** 2 / (2 * (v - u))
    return b - POLYNOMIAL_P * (w - phi) ** 2 / (2 * (w - v))


def _polynomial_p() -> float:
    u, v = math.radians(160), math.radians(270)
    below = 16 * math.pi**2 - 4 * math.pi * v + 2 * u * v - 6 * math.pi * u - u * u
    return 24 * math.pi * 0.6 / below


POLYNOMIAL_P = _polynomial_p()
POLYNOMIAL_B = 0.4 + 0.5 * POLYNOMIAL_P * (2 * math.pi - math.radians(160))


def door_ratio(phi: Any) -> Any:
    """003 (3.1) with i_max = 2, phi_v = 60 degrees."""
    return 1 + mp.sin(1.5 * phi) if phi < 60 * DEGREE else mp.mpf(2)


DOOR_KNOT = ((math.pi - 2) * 60 + math.pi * 300) / (2 * math.pi)
"""003 (3.12), degrees."""


def play_apart() -> float:
    """Backlash of two wheels of 24 teeth of module 2 and backlash 0.1, 0.03 mm too far apart."""
    base = 24 * mp.cos(mp.radians(20))
    angle = mp.acos(2 * base / mp.mpf("48.03"))
    involute = [mp.tan(one) - one for one in (angle, mp.radians(20))]
    return float(mp.mpf("0.1") + 4 * base * (involute[0] - involute[1]) / mp.cos(mp.radians(20)))


def feeder_scale() -> float:
    """S of r = S*(1 + 0.2*cos(2*phi)), whose length is pi*m*z = 80*pi."""

    def speed(phi: Any) -> Any:
        return mp.hypot(1 + mp.cos(2 * phi) / 5, 2 * mp.sin(2 * phi) / 5)

    return 80 * math.pi / float(mp.quad(speed, mp.linspace(0, 2 * mp.pi, 17)))


def ellipse_distance(module_times_teeth: int, eccentricity: str) -> float:
    """Centre distance of a pair of ellipses about their foci."""
    with mp.workdps(30):
        e = mp.mpf(eccentricity)
        return float(mp.pi * module_times_teeth / (2 * mp.ellipe(e**2)))


def keyed_area(radius: int, width: int, depth: str) -> float:
    """Bore with a keyway: the circle, and what of the keyway lies beyond its arc."""
    with mp.workdps(30):
        half, floor = mp.mpf(width) / 2, radius + mp.mpf(depth)
        angle = mp.asin(half / radius)
        under = radius**2 * angle + half * mp.sqrt(radius**2 - half**2)
        return float(mp.pi * radius**2 + 2 * half * floor - under)


def flat_area(radius: str, away: str) -> float:
    """Circle less the segment beyond a chord at a distance from its middle."""
    with mp.workdps(30):
        r, d = mp.mpf(radius), mp.mpf(away)
        return float(mp.pi * r**2 - r**2 * mp.acos(d / r) + d * mp.sqrt(r**2 - d**2))


def uneven_ratio(phi: Any) -> Any:
    """From 0.58 to 0.42 over 140 degrees and back over 220, by quintics."""
    knot = 140 * DEGREE
    t = phi / knot if phi < knot else (2 * mp.pi - phi) / (2 * mp.pi - knot)
    return mp.mpf("0.58") - mp.mpf("0.16") * t**3 * (10 - 15 * t + 6 * t * t)


@cache
def uneven_length() -> float:
    """Length of its driver's centrode."""
    return 40 * length(uneven_ratio, (0, 140 * DEGREE, 2 * mp.pi), -1)


NUMBERS: dict[str, dict[str, Number]] = {
    "ring_ellipse": {
        # found in 40 digits
        "pair.center_distance_mm": (22.87542426332165, 1e-12),
        "pair.ratio.max": (0.58261456842243, 1e-13),
        "gears[1].centrode.max_concave_curvature_per_mm": (0.03166779578069, 1e-13),
    },
    "ring_uneven": {
        "pair.solved.ratios[1]": (0.42, 1e-14),
        "pair.module_mm": (lambda: uneven_length() / (32 * math.pi), 1e-8),
        "gears[1].centrode.length_mm": (lambda: 2 * uneven_length(), 1e-6),
    },
    "furnace_door": {
        # printed lengths over A, and (3.26); the driven wheel's smallest radius
        "pair.solved.knots_deg[3]": (171.65, 1e-11),
        "pair.center_distance_mm": (5 * math.pi * 29 / 1.935834337285, 1e-9),
        "gears[1].centrode.min_convex_radius_mm": (27.7494, 5e-5),
    },
    "furnace_door_two_phase": {
        "pair.solved.knots_deg[2]": (DOOR_KNOT, 1e-11),
        "pair.center_distance_mm": (
            lambda: by_module(door_ratio, (0, 60 * DEGREE, DOOR_KNOT * DEGREE), 160),
            1e-6,
        ),
    },
    "nail_machine_polynomial": {
        "pair.solved.ratios[0]": (POLYNOMIAL_B, 1e-12),
        "pair.module_mm": (
            lambda: (
                180
                * length(polynomial_ratio, (0, 160 * DEGREE, 270 * DEGREE, 2 * mp.pi))
                / math.pi
                / 60
            ),
            1e-6,
        ),
    },
    "circular": {
        "pair.center_distance_mm": (49.0, 1e-12),
        "gears[0].centrode.min_convex_radius_mm": (14.0, 1e-12),
        "gears[1].centrode.min_convex_radius_mm": (35.0, 1e-12),
    },
    "two_lobed_ellipse": {
        "pair.center_distance_mm": (34.5409988531, 1e-10),
        "pair.ratio.max": (1.3 / 0.7, 1e-12),
    },
    "eccentric_circle": {
        "pair.center_distance_mm": (24.5255146282, 1e-10),
        "gears[0].centrode.min_convex_radius_mm": (12.0, 1e-11),
    },
    "limacon": {
        "pair.center_distance_mm": (limacon_distance, 1e-10),
        "gears[1].centrode.length_mm": (math.pi * 90, 1e-10),
    },
    "lobed": {
        "pair.center_distance_mm": (lambda: by_module(lobed_ratio, TURN, 80), 1e-8),
        "pair.ratio.max": (1.1 / (LOBED_B - 0.1), 1e-12),
    },
    "log_spiral": {
        "pair.center_distance_mm": (spiral_distance, 1e-10),
        "pair.solved.growth_per_rad": (math.log(2) / math.radians(200), 1e-13),
    },
    "nautilus": {
        "pair.center_distance_mm": (nautilus_distance, 1e-10),
        "pair.solved.growth_per_rad": (math.log(2) / math.radians(360 - 95.386), 1e-13),
    },
    "bspline": {
        "pair.center_distance_mm": (
            lambda: by_module(spline_ratio, [k * mp.pi / 2 for k in range(5)], 80),
            1e-6,
        ),
        "pair.solved.center_distance_over_scale": (2.01705534812207634, 1e-13),
    },
    "rounded_square": {
        # Zarebski and Salacinski print a module of 4.91; these are by 30-digit quadrature
        "pair.module_mm": (4.92310306992003616, 1e-11),
        "gears[0].centrode.min_convex_radius_mm": (25.0, 1e-10),
        "pair.solved.side_distance_over_center_distance": (0.448203891095789116, 1e-14),
    },
    "two_speeds": {
        "pair.solved.ratios[1]": (1.2, 1e-13),
        "pair.center_distance_mm": (
            lambda: by_module(two_speeds_ratio, [k * DEGREE for k in (0, 120, 180, 300, 360)], 144),
            1e-6,
        ),
    },
    "harmonics": {
        "pair.center_distance_mm": (
            lambda: by_module(
                lambda phi: 1 + mp.cos(phi) / 5 + mp.cos(2 * phi) / 10 + mp.sin(phi) / 20, TURN, 100
            ),
            1e-8,
        ),
        "gears[0].centrode.length_mm": (math.pi * 100, 1e-10),
    },
    "measured": {
        # the table holds phi1 - 0.2*sin(phi1) in steps of 10 degrees: ratio within 4e-4
        "pair.ratio.min": (0.8, 4e-4),
        "pair.ratio.max": (1.2, 4e-4),
        "pair.center_distance_mm": (
            lambda: by_module(lambda phi: 1 - mp.cos(phi) / 5, TURN, 90),
            1e-3,
        ),
    },
    "indexing_table": {
        "pair.ratio.max": (1.4 / 1.2, 1e-12),
        "pair.center_distance_mm": (
            lambda: by_module(lambda phi: (1 + 0.4 * phi / mp.pi) / mp.mpf("1.2"), (0, mp.pi), 60),
            1e-8,
        ),
    },
    "press": {
        # the slide's way is that of a crank at phi1 + 0.3*sin(phi1)
        "pair.ratio.min": (0.7, 1e-11),
        "pair.ratio.max": (1.3, 1e-11),
        "pair.center_distance_mm": (
            lambda: by_module(lambda phi: 1 + 3 * mp.cos(phi) / 10, TURN, 132),
            1e-8,
        ),
    },
    "feeder": {
        "pair.travel_per_turn_mm": (lambda: 2 * math.pi * feeder_scale(), 1e-9),
        "pair.radius_mm.max": (lambda: 1.2 * feeder_scale(), 1e-10),
    },
    "gate_rack": {
        "pair.travel_per_turn_mm": (2 * math.pi * 20, 1e-9),
        # whole teeth: 40 pitches long, the height of the bar
        "gears[1].size_mm[1]": (40 * 2 * math.pi, 1e-9),
        "gears[1].size_mm[0]": (20.0, 1e-9),
    },
    "loaded_nail_machine": {
        "pair.module_mm": (4.9229880875, 1e-10),
        "gears[0].centrode.length_mm": (556.7768355399, 1e-10),
    },
    "rattling_pair": {
        "pair.module_mm": (4.9229880875, 1e-10),
        "gears[0].centrode.length_mm": (556.7768355399, 1e-10),
    },
    "askew_pair": {
        "errors.alone.center.backlash_mm.min": (play_apart, 1e-9),
        # 2*e/(r*cos(alpha)); between phases of 10 degrees at most 0.4 % of it are missed
        "errors.alone.eccentricity1.transmission_error_rad.peak_to_peak": (
            0.04 / (24 * math.cos(math.radians(20))),
            5e-3 * 0.04 / 24,
        ),
    },
    "shop_order": {
        # about its focus: A = 2a with the perimeter 4*a*E(e) = pi*m*z
        "pair.center_distance_mm": (ellipse_distance(3 * 32, "0.25"), 1e-9),
        # bore, and a slot of 6 x 12.8 from the axis less half a circle's segment within it
        "gears[0].openings[0].area_mm2": (keyed_area(10, 6, "2.8"), 1e-10),
        "gears[1].openings[0].area_mm2": (keyed_area(8, 5, "2.3"), 1e-10),
        "gears[1].openings[1].center_mm[0]": (18.0, 1e-12),
    },
    "inch_pair": {
        # 36 teeth of 12 diametral pitch: the curve of an ordinary wheel of 3 in is as long
        "pair.center_distance_mm": (ellipse_distance(3, "0.25") * 25.4, 1e-9),
        # in units of 1/16 in
        "gears[0].openings[0].area_mm2": (keyed_area(4, 2, "1") * 1.5875**2, 1e-9),
    },
    "stepped_ellipse": {
        "pair.center_distance_mm": (ellipse_distance(2 * 24, "0.3"), 1e-9),
        "steps.moved_mm[3]": (1.5 * math.pi, 1e-12),
        # a circle of 8.2 mm less the segment beyond the flat, 3.1 mm from the axis
        "gears[0].openings[0].area_mm2": (flat_area("4.1", "3.1"), 1e-10),
    },
}


def look_up(summary: Any, path: str) -> Any:
    """Follow a path such as ``gears[0].centrode.length_mm``; a whole key may hold brackets."""
    if isinstance(summary, dict) and path in summary:
        return summary[path]
    head, rest = re.fullmatch(r"(\w+|\[\d+\])\.?(.*)", path).groups()  # type: ignore[union-attr]
    value = summary[int(head[1:-1])] if head.startswith("[") else summary[head]
    return look_up(value, rest) if rest else value


def misses(summary: Any, numbers: Mapping[str, Number]) -> Iterable[str]:
    """Numbers that are not as expected."""
    for path, (known, error) in numbers.items():
        value = known() if callable(known) else known
        found = look_up(summary, path)
        if not abs(found - value) <= error:
            yield f"{path} = {found!r}, expected {value!r} within {error}"


@cache
def _undercut() -> tuple[float, float, float]:
    """Largest pressure angle, and both ends of the undercut, of 10 mm cycloidal in 40 deg, deg."""
    with mp.workdps(30):
        width = mp.radians(40)

        def lift(t: Any) -> Any:
            return 10 * (t / width - mp.sin(2 * mp.pi * t / width) / (2 * mp.pi))

        def alpha(t: Any) -> Any:
            return mp.atan(mp.diff(lift, t) / (30 + lift(t)))

        def room(t: Any) -> Any:
            """Radius of curvature of the pitch curve, polar form, less the roller's."""
            r, dr, ddr = 30 + lift(t), mp.diff(lift, t), mp.diff(lift, t, 2)
            return (r * r + dr * dr) ** mp.mpf(1.5) / (r * r + 2 * dr * dr - r * ddr) - 14

        peak = mp.findroot(lambda t: mp.diff(alpha, t), mp.radians(19))
        ends = [mp.findroot(room, mp.radians(guess)) for guess in (25.5, 36)]
        return tuple(float(mp.degrees(value)) for value in (alpha(peak), *ends))  # type: ignore[return-value]


def _scca_speed(b: float, c: float, d: float) -> float:
    """Peak velocity of the SCCA family on the unit square."""
    pi = math.pi
    peak = 4 * pi**2 / ((pi**2 - 8) * (b**2 - d**2) - 2 * pi * (pi - 2) * b + pi**2)
    return peak * ((b + d) / pi + c / 2)


READ: Final = math.radians(110)
"""Angle of the rise of 12 mm, 4-5-6-7, that is read with up to 4 um of noise."""

HIGHEST = math.hypot(10, math.sqrt(60**2 - 10**2) + 27.6) - 8

OPENING = 75 / 360 * 60 / 2600
"""Seconds that the valve of the train takes to open."""


def _preload(mass: float, stiffness: float, lift: float, time: float) -> float:
    """Least preload below a rise 3-4-5: where the derivative of m*s'' + k*s has a root."""
    rise = np.polynomial.Polynomial([0, 0, 0, 10, -15, 6]) * lift
    force = 1e-3 * mass / time**2 * rise.deriv(2) + stiffness * rise
    roots = force.deriv().roots()
    inside = roots[(abs(roots.imag) < 1e-9) & (roots.real > 0) & (roots.real < 1)].real
    return -float(force(inside).min())


PRELOAD = _preload(0.11, 20, 9, OPENING)


def _release(preload: float) -> float:
    """Speed, rpm, at which the valve train of 20 N/mm needs a preload."""
    low, high = 1000.0, 10000.0
    for _ in range(60):
        middle = 0.5 * (low + high)
        needed = _preload(0.11, 20, 9, 75 / 360 * 60 / middle)
        low, high = (middle, high) if needed < preload else (low, middle)
    return low


def _rigid_jump() -> float:
    """Lowest speed, rpm, at which 200 N and 10 N/mm lose 0.7 kg on a cycloidal rise of 10 mm."""
    width = math.pi / 2

    def square(t: Any) -> Any:
        lift = 10 * (t - mp.sin(2 * mp.pi * t) / (2 * mp.pi))
        falling = -10 * 2 * mp.pi * mp.sin(2 * mp.pi * t) / width**2
        return (200 + 10 * lift) / (0.7e-3 * falling)

    with mp.workdps(25):
        place = mp.findroot(lambda t: mp.diff(square, t), 0.74)
        return float(mp.sqrt(square(place))) * 30 / math.pi


def _edge(angle: float, lift: float, limit: float) -> float:
    """Largest s'/tan(limit) - s of a cycloidal rise: where s'' = s'*tan(limit); deg, mm."""
    beta, slope = math.radians(angle), math.tan(math.radians(limit))
    x = 2.0 * math.atan(2.0 * math.pi / (beta * slope))
    return lift * ((1.0 - math.cos(x)) / (beta * slope) - (x - math.sin(x)) / (2.0 * math.pi))


PACKING = [_edge(angle, 40.0, 32.0) for angle in (130.0, 100.0)]
PACKING_OFFSET = 0.5 * (PACKING[0] - PACKING[1]) * math.tan(math.radians(32.0))


def _steepest_on_cone(lift: float, angle: float, x: float, radius: float, taper: float) -> float:
    """Largest pressure angle of a cone of a radius at x, modified sine, deg."""
    speed = lift / math.radians(angle) * 4.0 * math.pi / (4.0 + math.pi)
    eta = math.atan(speed / (x + radius * taper))
    return math.degrees(math.acos(math.cos(math.atan(taper)) * math.cos(eta)))


def _left_by_mill(low: float, high: float, roller: float, tool: float) -> float:
    """What an end mill leaves at both ends of a pass, cycloidal 12 mm in 160 deg, by search, mm."""
    worst = 0.0
    for k in range(20001):
        speed = 12.0 / math.radians(160.0) * (1.0 - math.cos(2.0 * math.pi * k / 20000))
        half = 0.5 * (math.atan(speed / low) - math.atan(speed / high))
        aside = (roller - tool) * math.sin(half)
        ahead = roller - (roller - tool) * math.cos(half)
        worst = max(worst, math.hypot(aside, ahead) - tool)
    return worst


MODIFIED_SINE = 4.0 * math.pi / (4.0 + math.pi)
"""Largest velocity of this law over the mean one."""

CAM_NUMBERS: dict[str, dict[str, Number]] = {
    "packaging_cam": {
        # the corner of the lines of the pressure angle on the rise and on the return
        "cam.prime_radius_mm": (math.hypot(0.5 * sum(PACKING), PACKING_OFFSET), 1e-5),
        "cam.offset_mm": (PACKING_OFFSET, 1e-5),
    },
    "plate_cam_offset_roller": {
        "cam.pressure_angle_deg.rise_max": (15.466010, 5e-7),
        "cam.pressure_angle_deg.rise.max": (7.969733, 5e-7),
        "cam.pressure_angle_deg.return.min": (-31.810726, 5e-7),
        "cam.pressure_angle_deg.return.max": (-11.617196, 5e-7),
        "cam.curvature.pitch_rise_min_mm": (22.670419, 5e-7),
        "motion.peak_velocity": (2 * 10 / (math.pi / 2), 1e-12),
    },
    "cylinder_cam": {
        # the normal of a cone with tan g = 0.11 is tilted by g; its contact is turned by eta,
        # tan(eta) = s'/(x + r*tan(g)), r with the clearance
        "cam.pressure_angle_deg.return_max": (_steepest_on_cone(60, 140, 82, 9.045, 0.11), 1e-9),
        "cam.pressure_angle_deg.rise_max": (_steepest_on_cone(60, 150, 82, 9.045, 0.11), 1e-9),
        "cam.groove_width_mm.floor": (2 * (11.025 - 18.5 * 0.11), 1e-12),
    },
    "rotary_axis_cam": {
        # cycloidal: 2*h/beta at the middle of both strokes, over the inner end of 15 mm
        "cam.pressure_angle_deg.max": (DEG * math.atan(2 * 12 / math.radians(160) / 15), 1e-9),
        # a pass of 5.5/4 mm above the floor: the tool 3 mm in the groove of 4.025 mm
        "tool_path.rest_mm": (lambda: _left_by_mill(14.5, 14.5 + 5.5 / 4, 4.025, 3.0), 1e-7),
    },
    "ordered_drum": {
        # modified sine, over the inner end of the roller at 36 mm
        "cam.pressure_angle_deg.max": (
            DEG * math.atan(24 / math.radians(130) * MODIFIED_SINE / 36),
            1e-9,
        ),
        "cam.groove_width_mm.floor": (2 * 8.015, 1e-12),
    },
    "globoidal_indexer": {
        # modified sine: 4*pi/(4 + pi) of the mean rate of 45 deg in 120 deg, at the middle of the
        # index, where a roller is on the line of centres and its end 42 mm from the cam's axis
        "cam.pressure_angle_deg.max": (
            DEG * math.atan(0.375 * 4 * math.pi / (4 + math.pi) * 58 / 42),
            1e-8,
        ),
        "motion.peak_velocity_deg_s": (360 * 0.375 * 4 * math.pi / (4 + math.pi), 1e-9),
        "cam.core_radius_mm": (99.5 - math.hypot(58, 8), 1e-12),
    },
    "carton_pusher": {
        "motion.peak_velocity_mm_s": (60 / math.radians(140) * MODIFIED_SINE * 4 * math.pi, 1e-9),
        "cam.groove_width_mm.floor": (2 * (11.025 - 18.5 * 0.11), 1e-12),
    },
    "rotary_table": {
        "motion.peak_velocity_deg_s": (360 * 0.375 * MODIFIED_SINE, 1e-9),
        "cam.core_radius_mm": (99.5 - math.hypot(58, 8), 1e-12),
    },
    "groove_cam": {
        # the walls are parallels of a pitch curve of 221.58887350723 mm, 12.05 mm apart
        "cam.groove.inner.perimeter_mm": (221.58887350723 - math.pi * 12.05, 1e-10),
        "cam.groove.outer.perimeter_mm": (221.58887350723 + math.pi * 12.05, 1e-10),
        "cam.pressure_angle_deg.return_max": (31.810726, 5e-7),
        "cam.groove.inner.radius_mm.min": (30 - 6.025, 1e-12),
    },
    "yoke_cam": {
        # Barbier: pi times the breadth of 2*40 + 20
        "cam.profile.perimeter_mm": (math.pi * 100, 1e-12),
        "cam.breadth_mm": (100.0, 1e-12),
        "cam.face_width_mm": (2 * 2 * 20 / (2 * math.pi / 3), 1e-12),
        "cam.profile.area_mm2": (7795.0873093058, 1e-9),
    },
    "conjugate_cams": {
        # arms 90 and 85 at prime radii 40 and 38, a lift of 20 deg between them; 0.02 mm on an arm
        "cam.arms_angle_deg": (65.386022742032 - DEG * 0.02 / 85, 1e-10),
        "cam.cam2.profile.radius_mm.min": (38 - 8, 1e-12),
        "cam.cam2.pressure_angle_deg.return_max": (31.8045503326, 1e-9),
        "cam.pressure_angle_deg.rise_max": (33.5573097724, 1e-9),
    },
    "translating_cam": {
        # 3-4-5 over 60 mm and cycloidal over 40 mm, both 15 mm: 15/8 and 2 of the mean slope
        "cam.pressure_angle_deg.rise_max": (DEG * math.atan(15 / 8 * 15 / 60), 1e-11),
        "cam.pressure_angle_deg.return_max": (DEG * math.atan(2 * 15 / 40), 1e-11),
        "cam.groove.lower.curvature.profile_convex_min_mm": (19.64980578843 - 6.025, 1e-10),
        "cam.groove.lower.curvature.profile_concave_min_mm": (19.64980578843 + 6.025, 1e-10),
        "cam.travel_mm": (170.0, 1e-12),
        "motion.peak_velocity": (0.75, 1e-12),
    },
    "plate_cam_oscillating": {
        "cam.start_angle_deg": (DEG * math.acos((100**2 + 90**2 - 40**2) / 18000), 1e-12),
        # modified sine has the lower peak acceleration, 3-4-5 the higher peak velocity
        "motion.peak_acceleration": (10 / math.sqrt(3) * 20 / (2 * math.pi / 3) ** 2, 1e-11),
        "motion.peak_velocity": (1.875 * 20 / (2 * math.pi / 3), 1e-12),
    },
    "flat_follower": {
        "cam.profile.perimeter_mm": (282.743338823, 5e-10),
        "cam.profile.area_mm2": (6328.539219167, 5e-10),
        "cam.contact_mm.max": (12.732395447, 5e-10),
        "cam.curvature.profile_min_mm": (23.573687214, 5e-10),
    },
    "eccentric_cam": {
        "cam.profile.perimeter_mm": (62 * math.pi, 1e-12),
        "cam.profile.area_mm2": (31**2 * math.pi, 1e-11),
        "cam.curvature.profile_min_mm": (31.0, 1e-12),
        "cam.contact_mm.max": (6.0, 1e-13),
    },
    "undercut_cam": {
        "cam.pressure_angle_deg.rise_max": (lambda: _undercut()[0], 1e-11),
        "cam.undercut[0][0]": (lambda: _undercut()[1], 1e-10),
        "cam.undercut[0][1]": (lambda: _undercut()[2], 1e-10),
        "cam.undercut[1][0]": (lambda: 180 - _undercut()[2], 1e-10),
        "cam.base_radius_mm": (16.0, 1e-14),
    },
    "lathe_slide": {
        "motion.peak_velocity": (2 * 27.6 / math.radians(105), 1e-12),
        "motion.lift.max": (27.6, 1e-13),
        "cam.profile.radius_mm.max": (HIGHEST, 1e-12),
        "cam.profile.radius_mm.min": (52.0, 1e-12),
    },
    "valve_train": {
        "motion.peak_velocity_mm_s": (15 / 8 * 9 / OPENING, 1e-12),
        "forces.spring.preload_n": (PRELOAD, 1e-8),
    },
    "polydyne_cam": {
        "motion.lift.max": (10 * (1 + 10 / 2000), 1e-6),
        "dynamics.natural_frequency_hz[0]": (math.sqrt(2010 / 0.5e-3) / (2 * math.pi), 1e-10),
    },
    "elastic_valve_train": {
        "dynamics.jump_rpm.rigid": (_rigid_jump, 1e-8),
        "dynamics.jump_rpm.elastic": (1131.858, 2e-3),  # apart from the project, by samples
        "dynamics.natural_frequency_hz[0]": (1908.90150566 / (2 * math.pi), 1e-8),
        "dynamics.natural_frequency_hz[1]": (10506.0028099 / (2 * math.pi), 1e-8),
    },
    "valve_tolerances": {
        "motion.peak_velocity_mm_s": (15 / 8 * 9 / OPENING, 1e-12),
        "forces.release_speed_rpm": (lambda: _release(95), 1e-6),
    },
    "valve_lever": {
        "cam.start_angle_deg": (DEG * math.asin(51 / 70), 1e-12),
        "motion.peak_acceleration": (6 * 10 / math.radians(70) ** 2, 1e-11),
    },
    "measured_cam": {
        "motion.deviation": (0.0, 0.006),
        "motion.lift.max": (12.0, 0.006 + 0.004),
        "motion.lift.min": (0.0, 0.006 + 0.004),
        "motion.peak_velocity": (35 / 16 * 12 / READ, 0.03),
        "motion.peak_acceleration": (84 * math.sqrt(5) / 25 * 12 / READ**2, 0.3),
        "motion.peak_jerk": (52.5 * 12 / READ**3, 2.0),
    },
    "caliper_cam": {
        # 4-5-6-7 by 18 deg, read to 0.01 mm with a scatter of 4 um, smoothed by 0.02 mm at most
        "motion.measured.largest_mm": (0.0, 0.02),
        "motion.total_lift": (18.0, 0.03),
        "motion.peak_velocity": (35 / 16 * 18 / math.radians(120), 0.1),
        "motion.peak_acceleration": (84 * math.sqrt(5) / 25 * 18 / math.radians(120) ** 2, 0.8),
        "cam.start_angle_deg": (DEG * math.acos((78**2 + 70**2 - 45**2) / (2 * 78 * 70)), 1e-12),
    },
    "tappet": {
        "cam.base_radius_mm": (35.0, 1e-13),
        # 15, -24, 10 of the fourth to sixth power: 60*x^3*(1 - x)^2 is largest at 3/5
        "motion.peak_velocity": (
            max(
                2.0736 * 9 / math.radians(110),
                _scca_speed(0.25, 0.25, 0.5) * 9 / math.radians(100),
            ),
            1e-12,
        ),
    },
}


@cache
def _five_bar() -> tuple[float, float]:
    """Least and largest y of the joint of two rods between cranks on both wheels, by sampling.

    The ratio falls from 1.6 to 0.4 by a cosine over 160 deg and rises again over 200 deg.
    """
    q = np.linspace(0.0, 2 * math.pi, 400_001)
    knot = math.radians(160.0)

    def turned(x: Any, width: float) -> Any:
        return x + 0.6 * width / math.pi * np.sin(math.pi * x / width)

    back = q - knot
    width = 2 * math.pi - knot
    rising = back - 0.6 * width / math.pi * np.sin(math.pi * back / width)
    phi2 = np.where(q < knot, turned(q, knot), knot + rising)
    first = 45 * np.exp(1j * (math.pi / 2 - q))
    last = 180 + 50 * np.exp(1j * (math.pi / 2 + phi2))
    base = abs(last - first)
    corner = np.arccos((150**2 + base**2 - 160**2) / (300 * base))
    joint = first + 150 * (last - first) / base * np.exp(1j * corner)
    return float(joint.imag.min()), float(joint.imag.max())


def _angle_between(one: float, two: float, opposite: float) -> float:
    """Angle of a triangle between two sides, deg."""
    return DEG * math.acos((one**2 + two**2 - opposite**2) / (2 * one * two))


def _pushed(lift: float) -> float:
    """Place of a slide 180 mm beside a drum, by a rod of 150 mm and a lever of 320 mm.

    The lever turns about (-159, h), and carries a roller at 160 mm, which is 27 mm high where the
    lever is 10 deg below the horizontal, at the lift 0.
    """
    pivot = complex(-159, 27 + 160 * math.sin(math.radians(10)))
    end = pivot + 320 * cmath.exp(1j * math.radians(lift - 10))
    return end.imag + math.sqrt(150**2 - (180 - end.real) ** 2)


MACHINE_NUMBERS: dict[str, dict[str, Number]] = {
    "drum_pusher": {
        "outputs.pusher.least_mm": (_pushed(0), 1e-9),
        "outputs.pusher.stroke_mm": (_pushed(20) - _pushed(0), 1e-9),
        "outputs.lever.stroke_deg": (20.0, 1e-9),
    },
    "four_bar": {
        # between the crank stretched and folded onto the coupler; at crank 0 the shortest diagonal
        "outputs.rocker.stroke_deg": (
            _angle_between(90, 110, 160) - _angle_between(90, 110, 80),
            1e-9,
        ),
        "machine.dyads.C.pressure_angle_deg": (90 - _angle_between(120, 90, 70), 1e-9),
        "paths.P.length_mm": (235.975413454, 1e-4),  # for P at 60 mm and 35 deg
    },
    "nail_machine_flywheel": {
        # by another integrator, with the ratio by single points
        "dynamics.flywheel_kg_m2": (19.807, 1e-3),
        # of the press force over its travel, and of what acts against the driver
        "dynamics.works_j.motor": (35.435 * 13.559405924468404 + 60 * 2 * math.pi, 1e-5),
        "outputs.slide.stroke_mm": (300.0, 1e-10),
    },
    "nail_machine_slide": {
        "outputs.slide.stroke_mm": (300.0, 1e-10),
        "outputs.slide.acceleration_mm_per_rad2": (150 * (1 - 150 / 750) * 1.6**2, 1e-9),
        "outputs.slide.velocity_mm_per_rad": (-203.736787041, 1e-9),
        "compare.three_phases.slide.velocity_mm_per_rad": (185.094888691, 1e-9),
        "compare.without_a_pair.slide.acceleration_mm_per_rad2": (-180.0, 1e-9),
        "torque.torque_nm.max": (556.765815074, 1e-9),
        "torque.work_j": (35.435 * 3.7734375, 1e-9),
    },
    "press_ram": {
        "outputs.ram.stroke_mm": (160.0, 1e-9),
        "outputs.ram.acceleration_mm_per_rad2": (-80 * (1 + 80 / 240) * 1.3**2, 1e-6),
    },
    "quick_return": {
        "outputs.ram.stroke_mm": (256.0, 1e-9),
        "outputs.rocker.stroke_deg": (2 * DEG * math.asin(60 / 150), 1e-9),
        "outputs.ram.least_mm": (-28.225721319, 1e-9),
    },
    "whitworth": {
        "outputs.ram.stroke_mm": (2 * 70.0, 1e-9),
        "machine.dyads.block_pin.guide_distance_mm": (100.0 - 40.0, 1e-9),
        "outputs.guide_arm.stroke_deg": (360.0, 1e-9),
    },
    "oscillating_cylinder": {
        "outputs.body.stroke_deg": (
            _angle_between(math.hypot(250, 150), 320, 400)
            - _angle_between(math.hypot(250, 150), 320, 300),
            1e-9,
        ),
        "machine.dyads.eye.pressure_angle_deg": (
            90 - _angle_between(400, 320, math.hypot(250, 150)),
            1e-9,
        ),
    },
    "furnace_door_lift": {
        "outputs.door.stroke_mm": (100 * math.radians(308.3), 1e-9),
        # a cosine from 1 to 2 over 50 deg
        "outputs.door.acceleration_mm_per_rad2": (100 * 0.5 * math.pi / math.radians(50), 1e-9),
        "machine.to_deg": (171.65, 1e-9),
    },
    "furnace_door_hinged": {
        "outputs.door.stroke_deg": (45.0, 1e-9),
        # the hook moves on an arc of 45 deg from straight below the hinge
        "outputs.hook_y.stroke_mm": (1735.30026219493 * (1 - math.cos(math.pi / 4)), 1e-9),
        # the centre of the door is half way to the hook
        "torque.works_j.gravity": (9.80665 * 867.65013109746 * (1 - math.cos(math.pi / 4)), 1e-8),
    },
    "geared_five_bar": {
        "outputs.B_y.least_mm": (lambda: _five_bar()[0], 1e-7),
        "outputs.B_y.largest_mm": (lambda: _five_bar()[1], 1e-7),
    },
    "lathe_levers": {
        "outputs.slide.stroke_mm": (3.71617428011, 1e-5),
        "outputs.slide.least_mm": (329.392408969, 1e-4),
    },
    "geneva": {
        # lambda = sin(30 deg): fastest lambda/(1 - lambda)
        "outputs.wheel.stroke_deg": (60.0, 1e-9),
        "outputs.wheel.velocity_rad_per_rad": (-1.0, 1e-9),
    },
    "straight_line": {
        "stretches[0].deviation_mm": (0.5 * 0.975373308636, 1e-9),
        "stretches[0].length_mm": (362.651605874, 1e-8),
    },
    "dwell_linkage": {
        "stretches[0].distance_mm.min": (378.728715219, 1e-8),
        "stretches[0].distance_mm.max": (379.63797181, 1e-7),
    },
    "two_cam_table": {
        "paths.table.area_mm2": (math.pi * 12 * 8, 1e-5),
        "outputs.table_x.stroke_mm": (24.0, 1e-6),
        "outputs.table_y.stroke_mm": (16.0, 1e-6),
    },
}
"""Machines: closed forms, and values by mpmath of positions in closed form."""

CAM_NUMBERS |= {
    f"table_cam_{way}": {
        # pitch curve r = r0 + h*cos: tan(alpha) = h/sqrt(r0^2 - h^2)
        "cam.pressure_angle_deg.max": (DEG * math.atan(h / math.sqrt(r0**2 - h**2)), 1e-5),
        "motion.peak_velocity": (float(h), 1e-5),
    }
    for way, h, r0 in (("x", 12, 52), ("y", 8, 48))
}
