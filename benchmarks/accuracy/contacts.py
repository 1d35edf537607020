"""Contact patches and contact ratios of circular wheels, whose flanks are involutes."""

from __future__ import annotations

import math
from dataclasses import replace
from functools import partial
from typing import Any

import mpmath
import numpy as np
import shapely

import gearcam
from gearcam.gears.contact import DRIVE, flank_pairs
from gearcam.meshing.half_teeth import half_teeth
from gearcam.meshing.overlap import Turning
from gearcam.meshing.patches import patches
from methods import Case, Method
from wheels import ALPHA, CIRCULAR, MODULE, TEETH

mp: Any = mpmath.mp
AHEAD = "0.002"
"""Angle by which the driver is ahead, degrees."""
PHASES = 24
MIDDLE = 0.75
"""Phase at which the flanks of pair 1 touch at the pitch point, in pitches."""
ADVANCES = (0.04, 0.02, 0.01, 0.005, 0.0025)
TOLERANCES = (3e-4, 1e-4, 3e-5, 1e-5, 3e-6, 1e-6)


def lens(rho: Any, ahead: Any) -> Any:
    """Return the overlap of two involutes, mm2, if the driver is `ahead`, rad.

    Both involutes start at base circles on either side of the line of action, which is the y-axis
    here; `rho` is the radius of curvature of the driver at the contact without overlap, mm.
    """
    alpha = mp.radians(mp.mpf(ALPHA))
    radius = mp.mpf(MODULE) * TEETH / 2
    base, line = radius * mp.cos(alpha), 2 * radius * mp.sin(alpha)

    def unwound(start: Any, turned: Any) -> tuple[Any, Any]:
        # of a circle about (-base, 0), and its derivative by the angle turned
        e = mp.exp(1j * turned)
        left = start - base * turned
        return base * (e - 1) + 1j * left * e, -left * e

    def one(t: Any) -> tuple[Any, Any]:
        z, dz = unwound(rho + base * ahead, t)
        return z - 1j * rho, dz

    def two(t: Any) -> tuple[Any, Any]:
        z, dz = unwound(line - rho, t)
        return 1j * (line - rho) - z, -dz

    bend = 1 / rho + 1 / (line - rho)
    half = mp.sqrt(2 * base * ahead / bend)
    corners = []
    for sign in (1, -1):
        start = (-sign * half / rho, sign * half / (line - rho))
        found = mp.findroot(
            lambda a, b: [(one(a)[0] - two(b)[0]).real, (one(a)[0] - two(b)[0]).imag], start
        )
        corners.append((found[0], found[1]))

    def below(curve: Any, ends: Any) -> Any:
        return mp.quad(lambda t: curve(t)[0].imag * curve(t)[1].real, ends)

    (a, b), (c, d) = corners
    return abs(below(one, [c, a]) - below(two, [d, b]))


def _truth(phi: Any) -> Any:
    """Return areas at phases, mm2, of the pair that passes the pitch point at `MIDDLE`."""
    with mp.workdps(30):
        alpha = mp.radians(mp.mpf(ALPHA))
        radius = mp.mpf(MODULE) * TEETH / 2
        base, ahead = radius * mp.cos(alpha), mp.radians(mp.mpf(AHEAD))
        middle = 2 * mp.pi / TEETH * MIDDLE
        rho = [radius * mp.sin(alpha) + base * (mp.mpf(one) - middle) for one in phi.tolist()]
        return np.array([float(lens(one, ahead)) for one in rho])


def patch() -> Case:
    """Return the case of contact patches with one pair of teeth in contact."""
    result = gearcam.build(gearcam.loads(CIRCULAR))
    gears, pair = result.gears, result.pair
    pairs, ahead = flank_pairs(gears, DRIVE), math.radians(float(AHEAD))
    pitch, width = 2.0 * math.pi / TEETH, 0.1
    middle = MIDDLE * pitch
    phi = middle + pitch * width * np.linspace(-0.5, 0.5, PHASES)
    truth = _truth(phi)

    def exact(_: float, closed: bool = False) -> Any:
        found = patches(pairs, phi, ahead)
        assert len(found.step) == PHASES  # the same pair at each phase
        return found.closed if closed else found.area

    def profiles(tolerance: float) -> Any:
        return [replace(gear.profile, tolerance=tolerance) for gear in gears]

    def halves(tolerance: float) -> Any:
        driver, driven = map(half_teeth, profiles(tolerance))
        turning = Turning(
            rolling=pair.rolling, driver=driver, driven=driven, distance=pair.center_distance
        )
        found = turning.overlaps(phi, ahead)
        return np.bincount(found.step, found.area, PHASES)

    def whole(tolerance: float) -> Any:
        one, two = (profile.points for profile in profiles(tolerance))
        areas = []
        for angle in phi:
            turned = one * np.exp(-1j * (angle + ahead)), two * np.exp(1j * angle)
            placed = turned[0], turned[1] + pair.center_distance
            regions = [shapely.Polygon(np.stack([z.real, z.imag], axis=1)) for z in placed]
            areas.append(regions[0].intersection(regions[1]).area)
        return np.array(areas)

    name, level = "exact flanks", "chord tolerance, mm"
    return Case(
        name="contact_patch",
        title="Contact patches",
        what="the area",
        unit="mm2",
        methods=[
            Method(f"{name}, by quadrature", "", (1.0,), exact),
            Method(f"{name}, in closed form", "", (1.0,), partial(exact, closed=True)),
            Method("half-teeth that face each other", level, TOLERANCES, halves, -1.0),
            Method("whole outlines", level, TOLERANCES, whole, -1.0),
        ],
        own=name,
        error=lambda found: float(np.abs(found - truth).max()),
        rounding=1e-13,
        note=f"{TEETH} teeth, module {MODULE:g} mm, the driver {AHEAD} degrees ahead, at {PHASES} "
        "phases with one pair in contact; against the involutes in 30 digits. The meshing study "
        "also reports the overlap of half-teeth, which does not assume which flanks touch; its "
        "chord tolerance is 1/200 of the penetration.",
    )


def advance() -> Case:
    """Return the case of the area against the angle by which the driver is ahead."""
    pairs = flank_pairs(gearcam.build(gearcam.loads(CIRCULAR)).gears, DRIVE)
    phi = np.array([2.0 * math.pi / TEETH * MIDDLE])
    with mp.workdps(30):
        middle = mp.mpf(MODULE) * TEETH / 2 * mp.sin(mp.radians(mp.mpf(ALPHA)))
        truth = {one: float(lens(middle, mp.radians(mp.mpf(str(one))))) for one in ADVANCES}

    def exact(ahead: float, closed: bool = False) -> float:
        found = patches(pairs, phi, math.radians(ahead))
        area = found.closed if closed else found.area
        return float(area[found.pair == 1][0]) / truth[ahead] - 1.0

    name, level = "exact flanks", "driver ahead, degrees"
    return Case(
        name="contact_advance",
        title="Contact patches against the advance of the driver",
        what="the area",
        unit="relative",
        methods=[
            Method(f"{name}, by quadrature", level, ADVANCES, exact),
            Method(f"{name}, in closed form", level, ADVANCES, partial(exact, closed=True), -1.0),
        ],
        own=name,
        error=abs,
        rounding=1e-12,
        note="The same wheels, in contact at the pitch point. The closed form assumes the "
        "curvature of that point everywhere; its error is proportional to the advance.",
    )


def ratio() -> Case:
    """Return the case of the mean contact ratio."""
    result = gearcam.build(gearcam.loads(CIRCULAR))
    pairs = flank_pairs(result.gears, DRIVE)
    with mp.workdps(30):
        alpha = mp.radians(mp.mpf(ALPHA))
        radius = mp.mpf(MODULE) * TEETH / 2
        tip = mp.sqrt((radius + MODULE) ** 2 - (radius * mp.cos(alpha)) ** 2)
        length = 2 * (tip - radius * mp.sin(alpha))
        truth = float(length / (mp.pi * MODULE * mp.cos(alpha)))

    def arcs(_: float) -> float:
        return float(np.mean(flank_pairs(result.gears, DRIVE).arcs.ratios))

    def counted(steps: float) -> float:
        # shifted, so that no phase is at an end of contact
        phi = 2.0 * math.pi / TEETH * (np.arange(steps) + 1.0 / 3.0) / steps
        return float(np.mean(pairs.arcs.carrying(phi)))

    return Case(
        name="contact_ratio",
        title="Contact ratio",
        what="the mean contact ratio",
        unit="1",
        methods=[
            Method("ends of the arcs of contact", "", (1.0,), arcs),
            Method("pairs counted at phases", "phases per pitch", (10, 100, 1000, 10000), counted),
        ],
        own="ends",
        error=lambda found: abs(found - truth),
        rounding=1e-14,
        note="The same wheels, against the closed form in 30 digits.",
    )


def cases() -> list[Case]:
    """Return all cases."""
    return [patch(), advance(), ratio()]
