"""Error estimates of a pair's driven angle, flanks, contact ratios and areas.

All but areas are found by perturbing the law and the arc length of the centrodes.

Depends on subject.
"""

from __future__ import annotations

import math
from dataclasses import dataclass, replace
from typing import Final

import numpy as np
from numpy.typing import ArrayLike

from gearcam.gears.flank import Toothing
from gearcam.gears.outline import Flanks
from gearcam.gears.pair import Gear
from gearcam.gears.rolling import Rolling
from gearcam.gears.subject import CheckedPair
from gearcam.gears.track import Frames
from gearcam.gears.track_table import TabledCentrode
from gearcam.numeric.arrays import Array, Plane
from gearcam.numeric.perturbation import EPS, Perturb, largest_changes
from gearcam.numeric.piecewise import Piecewise

_PLACES: Final = 181
"""Driver angles spread over a lobe."""

_ROUNDINGS: Final = 4.0 * EPS
"""Relative perturbation of ratios and of the parameters of their pieces."""


_OF_PROBES: Final = 1.5
"""Largest error of a table over those at its probes."""


@dataclass(frozen=True, eq=False, kw_only=True)
class _PerturbedRatio(Piecewise):
    """A ratio whose parameters and values are perturbed anew at every place.

    Parameters
    ----------
    perturb : callable
        See `gearcam.numeric.perturbation`.
    off : tuple of float
        Errors of the ratio and its derivatives beyond rounding.
    """

    perturb: Perturb
    off: tuple[float, ...]

    def derivatives(self, x: ArrayLike, order: int) -> list[Array]:
        """Return perturbed values at places (n,) (see `Piecewise.derivatives`)."""
        x = np.asarray(x)
        index = np.searchsorted(self.knots[1:-1], x, side="right")
        found = self.on_pieces(index, x, order, lambda v: self.perturb(v, _ROUNDINGS * v))
        off = np.array(self.off[: order + 1])[:, None]
        return list(self.perturb(found, off + _ROUNDINGS * np.abs(found)))


def pair_errors(subject: CheckedPair) -> tuple[float, float, float]:
    """Return the errors of a pair's main numbers.

    Parameters
    ----------
    subject : CheckedPair
        The pair as built.

    Returns
    -------
    driven, flank, contact_ratio : float
        Largest errors of the driven angle, rad (of a rack's travel in the unit of its law), of
        points of flanks in their wheels' frames, mm, and of contact ratios.
    """
    pair, law = subject.pair, subject.pair.law
    places = [np.linspace(0.0, law.period, _PLACES)]
    places += [phi for phi, _ in pair.rolling.curvature_extremes]
    phi = np.concatenate(places)
    phi = phi[(phi >= 0.0) & (phi <= law.period)]

    def compute(perturb: Perturb) -> list[Array | Plane]:
        rolling = _perturbed(pair.rolling, perturb)
        results: list[Array | Plane] = [rolling.law.driven(perturb(phi, EPS * law.period))]
        for gear, track in zip(subject.gears, rolling.tracks, strict=True):
            tips, toothing = gear.profile.flanks.tips, replace(gear.toothing, track=track)
            places = np.concatenate([phi, tips.phi, tips.foot])
            frames = toothing.frames(perturb(places, EPS * track.around))
            at, first = len(phi), len(phi) + len(tips.phi)
            s = gear.toothing.track.arc_length(phi)
            results.append(_points(toothing, frames.some(slice(at)), s))
            ends = frames.some(slice(at, first)), frames.some(slice(first, None))
            results.append(_reaches(toothing, gear.profile.flanks, *ends))
        return results

    driven, *of_wheels = (float(change.max()) for change in largest_changes(compute))
    of_table = max(_off_by_table(gear.toothing) for gear in subject.gears)
    reach = sum(of_wheels[1::2]) + sum(_off_at_tips(gear) for gear in subject.gears)
    return driven, max(of_wheels[::2]) + of_table, reach / pair.toothings[0].pitch


def _off_by_table(toothing: Toothing) -> float:
    """Return how far the table of a centrode moves points of flanks, mm; 0 without one."""
    track, exact = toothing.track, toothing.track.exact
    if not isinstance(track, TabledCentrode) or track.source.table is None:
        return 0.0
    phi = track.source.table.probes
    s = exact.arc_length(phi)
    own, wanted = (
        _points(one, one.frames(phi), s) for one in (toothing, replace(toothing, track=exact))
    )
    return _OF_PROBES * float(np.abs(own - wanted).max())


def _off_at_tips(gear: Gear) -> float:
    """Return how far the reach of flanks is from that on the exact centrode, mm."""
    flanks, track = gear.profile.flanks, gear.toothing.track.exact
    tips, exact = flanks.tips, replace(gear.toothing, track=track)
    wanted = _reaches(exact, flanks, exact.frames(tips.phi), exact.frames(tips.foot))
    found = flanks.sigma * (flanks.sf - track.arc_length(tips.phi))
    return float(np.abs(np.where(wanted, found - wanted, 0.0)).max())


def _perturbed(rolling: Rolling, perturb: Perturb) -> Rolling:
    law, arc = rolling.law, rolling.arc
    ratio = _PerturbedRatio(
        knots=law.ratio.knots,
        pieces=law.ratio.pieces,
        offsets=law.ratio.offsets,
        perturb=perturb,
        off=law.function_errors[1:],
    )
    driven = law.driven.shifted(float(perturb(0.0, law.error)))
    return replace(
        rolling,
        law=replace(law, ratio=ratio, driven=driven),
        arc=replace(
            arc,
            unit=arc.unit.shifted(float(perturb(0.0, rolling.arc_error / arc.size))),
            size=float(perturb(arc.size, EPS * arc.size)),
        ),
    )


def _points(toothing: Toothing, frames: Frames, s: Array) -> Plane:
    """Return the ends of the longest flanks that touch in frames where the exact arc is `s`."""
    cutter = toothing.cutter
    height = max(cutter.addendum, cutter.dedendum)
    reach = height / (math.sin(cutter.alpha) * math.cos(cutter.alpha))
    return np.array(
        [
            toothing.flank_points(frames, s + side * reach, sigma)
            for side in (-1.0, 1.0)
            for sigma in (-1.0, 1.0)
        ]
    )


def _reaches(toothing: Toothing, flanks: Flanks, ends: Frames, feet: Frames) -> Array:
    """Return the reach of flanks that end where they cross the addendum curve or each other, mm.

    By a step of Newton's method from the crossing of the exact curves; 0 for other flanks.
    """
    tips, sf, sigma = flanks.tips, flanks.sf, flanks.sigma
    points = toothing.flank_points(ends, sf, sigma)
    forward = -sigma * toothing.turn * toothing.normals(ends, sigma)
    high, low = np.split(tips.foot, 2)
    pointed, teeth = np.tile(high <= low, 2), len(high)
    top = feet.p + toothing.cutter.addendum * toothing.turn * feet.t
    gap = np.where(pointed, np.roll(points, teeth), top) - points
    along = np.conj(np.where(pointed, np.roll(forward, teeth), feet.t))
    # near a cusp a flank hardly moves
    regular = np.maximum(toothing.regularity(ends, sf, sigma), math.sqrt(EPS))
    roll = ends.s + (along * gap).imag / ((along * forward).imag * regular)
    crossed = (tips.full | pointed) & toothing.whole_flanks
    return np.where(crossed, sigma * (sf - roll), 0.0)
