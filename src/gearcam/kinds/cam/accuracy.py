"""Error estimates of a cam: of lift, profile, area and volume."""

from __future__ import annotations

from collections.abc import Iterator
from dataclasses import replace
from typing import TYPE_CHECKING, Final

import numpy as np

from gearcam.numeric.perturbation import EPS, Perturb, largest_changes, perturbed_sizes
from gearcam.parts.mass import quadrature_error

if TYPE_CHECKING:
    from gearcam.cams.cam import Cam
    from gearcam.kinds.cam.build import CamResult
    from gearcam.laws.program import Program
    from gearcam.numeric.arrays import Array, Ints, Plane
    from gearcam.results.parts import Estimates

_LENGTHS, _ANGLES, _COEFFICIENTS = 4.0 * EPS, 4.0 * EPS, 2.5 * EPS
"""Relative perturbations: of sizes of the follower; of cam angles, since knots are sums; of
coefficients of the lift."""

_PLACES: Final = 256
_FEWEST: Final = 3
"""Number of cam angles over all phases, and least number between cuts of the lift, with ends."""

_ROUNDED: Final = "largest change over the turn if every input changes by its rounding"


def error_rows(result: CamResult) -> Estimates:
    """Return the error estimates of a cam.

    Parameters
    ----------
    result : CamResult
        A built design.

    Returns
    -------
    dict of str to (float, str)
        Estimate and method by name, without those of chords and files.
    """
    unknown = " and the lift by its interpolation error" if any(result.program.errors) else ""
    lift, profile, swept = motion_errors(result.cam)
    name, scale = next(iter(result.cam.motions[0].motion_scales.items()))
    rows = {name: scale * lift, "profile_mm": profile}
    return {
        **{name: (off, _ROUNDED + unknown) for name, off in rows.items()},
        **dict(_sizes(result, swept)),
    }


def motion_errors(cam: Cam) -> tuple[float, float, list[float]]:
    """Return the errors of lift and profiles.

    Parameters
    ----------
    cam : Cam
        All its walls count.

    Returns
    -------
    lift, profile : float, mm or rad, and mm
        Largest error of the lift, and of points of profiles.
    swept : list of float, mm^2
        The area that the errors of each profile cover.
    """
    program, curves = cam.walls[0].program, [wall.curve for wall in cam.walls]
    index, theta = _places(program)
    traces = [curve.trace(theta, *program.lift.on_pieces(index, theta, 1)) for curve in curves]

    def compute(perturb: Perturb) -> list[Array | Plane]:
        places = perturb(theta, _ANGLES * theta)
        exact = program.lift.on_pieces(index, places, 1, lambda v: perturb(v, _COEFFICIENTS * v))
        s, ds = (perturb(*one) for one in zip(exact, program.errors[:2], strict=True))
        moved = [
            replace(
                one,
                follower=perturbed_sizes(one.follower, perturb, _LENGTHS),
                inset=float(perturb(one.inset, _LENGTHS * one.inset)),
            )
            for one in curves
        ]
        points = [one.trace(places, s, ds)[0] for one in moved]
        # only what is across the profile changes its area
        across = [
            (np.conj(tangents) * profile).imag
            for profile, (_, tangents) in zip(points, traces, strict=True)
        ]
        return [s, *points, *across]

    lift, *of_walls = largest_changes(compute)
    profiles, across = of_walls[: len(curves)], of_walls[len(curves) :]
    swept = [
        float(0.5 * (off[1:] + off[:-1]) @ np.abs(np.diff(points)))
        for (points, _), off in zip(traces, across, strict=True)
    ]
    return float(lift.max()), max(float(off.max()) for off in profiles), swept


def _places(program: Program) -> tuple[Ints, Array]:
    """Pieces of the lift, and cam angles in them, at knots once for each side."""
    cuts, knots = program.cuts, program.knots
    index = np.searchsorted(knots, 0.5 * (cuts[:-1] + cuts[1:])) - 1
    # the same number for all phases, so that a divided one leaves enough to the others
    share = np.diff(cuts) / np.diff(knots)[index]
    counts = np.maximum(_FEWEST, (_PLACES // (len(knots) - 1) * share).astype(int))
    stretches = zip(cuts[:-1], cuts[1:], counts, strict=True)
    return np.repeat(index, counts), np.concatenate([np.linspace(*one) for one in stretches])


def _sizes(result: CamResult, swept: list[float]) -> Iterator[tuple[str, tuple[float, str]]]:
    """Yield the errors of areas of walls before clearance, and of the volume of parts."""
    walls = result.cam.walls
    if not result.design.blank.clearance:
        how = "errors of the profile all along it, and quadrature with fewer cells"
        for wall, area in zip(walls, swept, strict=True):
            if wall.program.closed:
                name = f"{wall.key}_area_mm2" if wall.key else "area_mm2"
                yield name, (area + wall.size.area_error, how)
    if result.ordered and result.design.blank.density is not None:
        area = sum(swept) + sum(wall.cubics_missed for wall in walls)
        off = max(quadrature_error(part) + part.width * area for part in result.parts)
        how = "cubics through dense points with halved steps on walls, with doubled steps on all "
        yield "volume_mm3", (off, f"{how}edges; errors of the profile all along it")
