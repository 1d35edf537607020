"""The stages of a gear pair at rising resolution (see `gearcam.results.ladders`)."""

from __future__ import annotations

from dataclasses import replace
from typing import TYPE_CHECKING, Final

import numpy as np

from gearcam.gears.pair import COARSEST, FINEST, FLANK_POINTS, make_gear
from gearcam.gears.track import WHEELS
from gearcam.numeric.arrays import Array, Plane
from gearcam.numeric.piecewise import Piecewise
from gearcam.numeric.sampling import Sampler
from gearcam.results.ladders import (
    CHORD_ORDER,
    COARSER,
    ROUNDING,
    Ladder,
    Ladders,
    integral_ladder,
    limit_ladder,
    outline_ladder,
    solid_ladder,
    tolerances_around,
)

if TYPE_CHECKING:
    from gearcam.kinds.gear_pair.result import GearPairResult

_FLANKS: Final = (2, 3, 5, 9, FLANK_POINTS, 33, 65, 129)
"""Points on a flank: each number includes the points of the one before."""

_PHASES: Final = 24
"""Number of phases at which outlines are intersected."""


def _law(result: GearPairResult) -> Ladder:
    law = result.law
    return integral_ladder(
        law.ratio,
        law.ratio.knots,
        law.driven if isinstance(law.driven, Piecewise) else None,
        size=1.0,
        measured="rack travel" if result.pair.on_rack else "driven angle",
        unit="" if result.pair.on_rack else "rad",
    )


def _centrode(result: GearPairResult) -> Ladder:
    arc = result.pair.rolling.arc
    return integral_ladder(
        arc.speed,
        result.law.ratio.knots,
        None,
        size=arc.size,
        measured="arc length",
        unit="mm",
    )


def _flank(result: GearPairResult) -> Ladder:
    """Return the chord errors of polygons through points on the exact flanks, by their number."""
    gears = result.gears

    def points(count: float) -> list[Plane]:
        tables = [gear.flank_points(int(count)) for gear in gears]
        return [(one["x_mm"] + 1j * one["y_mm"]).reshape(-1, int(count)) for one in tables]

    fine = points(2 * _FLANKS[-1] - 1)

    def measure(coarse: list[Plane]) -> tuple[float, int]:
        largest = 0.0
        for ends, exact in zip(coarse, fine, strict=True):
            skip = (exact.shape[1] - 1) // (ends.shape[1] - 1)
            middles = exact[:, skip // 2 :: skip]
            chord = np.diff(ends, axis=1)
            offset = (middles - ends[:, :-1]) * np.conj(chord)
            largest = max(largest, float((np.abs(offset.imag) / np.abs(chord)).max()))
        return largest, sum(one.size for one in coarse)

    return Ladder(
        refined="points on a flank",
        measured="chords of flanks",
        unit="mm",
        levels=_FLANKS,
        own=FLANK_POINTS,
        order=CHORD_ORDER,
        rounding=ROUNDING * max(gear.largest_radius for gear in gears),
        make=points,
        measure=measure,
    )


def _outline(result: GearPairResult) -> Ladder:
    pair, ring, inner = result.pair, result.design.ring, result.tolerances

    def samplers(tolerance: float) -> list[Sampler]:
        gears = [make_gear(pair, wheel, tolerance, inner, ring) for wheel in WHEELS]
        for gear in gears:
            _ = gear.outline  # computed on demand
        return [gear.profile.sampler for gear in gears]

    reach = max(gear.largest_radius for gear in result.gears)
    used, levels = _tolerances(result)
    return outline_ladder(used, levels, samplers, measured="chords of outlines", reach=reach)


def _solid(result: GearPairResult) -> Ladder:
    used, levels = _tolerances(result)
    return solid_ladder(result, used, levels[:-1])


def _contact(result: GearPairResult) -> Ladder:
    """Return areas of overlap of the outlines pressed together, by phase, as in a meshing study."""
    from gearcam.meshing.half_teeth import half_teeth
    from gearcam.meshing.study import SHARE, mount, run

    gears, chords = result.gears, result.pair.chord_tolerance(None)
    setup = mount(gears, replace(result.design.meshing, steps=_PHASES))
    used = min(SHARE * setup.penetration, chords)

    def make(tolerance: float) -> tuple[Array, int]:
        profiles = [replace(gear.profile, tolerance=tolerance) for gear in gears]
        driver, driven = map(half_teeth, profiles)
        turning = replace(setup.turning, driver=driver, driven=driven)
        meshing = run(replace(setup, turning=turning))
        rows = meshing.columns
        phase = np.asarray(rows["step"], dtype=np.int64)
        areas = np.bincount(phase, np.ma.filled(rows["area_mm2"], 0.0), len(meshing.phi1))
        return areas.astype(np.float64), sum(len(profile.points) for profile in profiles)

    return limit_ladder(
        used,
        make,
        levels=[part * used for part in COARSER[:4]],
        measured="overlap of a phase",
        unit="mm2",
        beyond=1.0 / 16.0,
    )


def _tolerances(result: GearPairResult) -> tuple[float, list[float]]:
    """Return the chord tolerance of the design, mm, and those of a ladder around it."""
    pair = result.pair
    used = pair.chord_tolerance(result.design.output.chord_tolerance)
    return used, tolerances_around(used, FINEST * pair.module / 64.0, COARSEST * pair.module)


LADDERS: Final[Ladders] = {
    "law": _law,
    "centrode": _centrode,
    "flank": _flank,
    "outline": _outline,
    "solid": _solid,
    "contact": _contact,
}
