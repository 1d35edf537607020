"""How exact the numbers of a pair are: estimates of their errors, each with how it is known.

Nothing here is a constant times a size unless rounding is all there is, and then it knows by what
rounding grows: places by the driver angle's own rounding where the centrode moves and turns fast,
directions by it where the centrode bends, reaches by how flanks run out at their tips.

Depends on the subject of checks.
"""

from __future__ import annotations

import math
from typing import Final

import numpy as np

from gearcam.gears.bends import EPS, FEW, bends_of, systematic_errors
from gearcam.gears.flank import Curve
from gearcam.gears.outline import Outline
from gearcam.gears.pair import Gear, GearPair
from gearcam.gears.rolling import Rolling
from gearcam.gears.subject import Subject
from gearcam.gears.tip_pass import TipPass
from gearcam.numeric.arrays import Array
from gearcam.numeric.bulges import as_complex
from gearcam.numeric.sampling import MARGIN

_PLACES: Final = 721
"""Places of a lobe at which the centrodes' farthest point and fastest place are looked for."""

Estimates = dict[str, tuple[float, str]]
"""Estimated error and how it is known, by name."""


def estimates(subject: Subject) -> Estimates:
    """Return estimated errors of what a summary tells of a pair.

    Parameters
    ----------
    subject : Subject
        The pair as built.

    Returns
    -------
    dict
        The unit is the last part of a name; ratios have none.
    """
    pair, gears = subject.pair, subject.gears
    rolling, law = pair.rolling, pair.law
    steepest = [place for place, _ in subject.pressure_angles.values()]
    function = ", and the Python function against its expansion" if law.function_error else ""
    far, rounding = size_of(rolling)
    flank = flank_error(pair, far, rounding)
    reaches, thicknesses = zip(*(tip_errors(gear, rounding) for gear in gears), strict=True)
    passed = subject.tip_pass
    return {
        "law": (
            law.error,
            "rad of the driven angle: against Gauss-Legendre quadrature" + function,
        ),
        "closure_rad": (abs(law.closure_error), "miss of the driven angle over a lobe"),
        "ratio": (
            ratio_error(rolling),
            "closure, and rounding as it shows and where the radius nears the distance",
        ),
        "acceleration_per_rad": (
            acceleration_error(subject),
            "scatter of the ratio's slope, and the rounding of driver angle and knots" + function,
        ),
        "arc_length_mm": (
            rolling.arc_error,
            "against Gauss-Legendre quadrature, and rounding" + function,
        ),
        **_bend_errors(rolling, function),
        "size": (rolling.size_error, "share of module and centre distance: the arc length's"),
        "flank_mm": (
            flank,
            "arc length, driven angle and directions, with the rounding of the driver angle",
        ),
        "pressure_angle_deg": (
            math.degrees(float(direction_error(rolling, np.array(steepest)).max())),
            "directions of the centrode, with the rounding of the driver angle",
        ),
        "contact_ratio": (
            sum(reaches) / pair.toothings[0].pitch,
            "flanks at their tips, by the angle at which they end",
        ),
        "tip_thickness_mm": (
            max(thicknesses),
            "both flanks of the thinnest tooth at its tip",
        ),
        **({} if passed is None else _pass_error(passed, sum(reaches) + flank)),
        "backlash_mm": (FEW * EPS * pair.toothings[0].pitch, "rounding of the pitch"),
        "root_radius_mm": (
            max(root_radius_error(gear) for gear in gears) + flank,
            "roots and rims: how far chords and the curve come beyond vertices, and flank_mm",
        ),
        "area_mm2": (
            max(area_error(gear) for gear in gears),
            "chords times the height of their bows",
        ),
    }


def _pass_error(passed: TipPass, corners: float) -> Estimates:
    """Return the error of the tip-pass margin, by what the places of both corners are off, mm."""
    how = "flanks at both tips and flank_mm, along the centrode and as the corner's way runs away"
    return {"tip_pass_margin_mm": ((1.0 + passed.slope) * corners, how)}


def _bend_errors(rolling: Rolling, function: str) -> Estimates:
    """Return the errors of the least radii of centrodes, the larger of both."""
    bends = [bends_of(track) for track in rolling.tracks]
    how = "scatter beside extremes, ratio and two derivatives at knots, closure, size" + function
    return {
        "convex_radius_mm": (max(one.radius_error for one in bends), how),
        "concave_curvature_per_mm": (max(one.concave_error for one in bends), how),
    }


def ratio_error(rolling: Rolling) -> float:
    """Return the error of ratios: with ``i = u/(1 - w*u)`` that of u, times ``1 + w*i``.

    A law that was solved so that it closes shares its miss, as a centre distance's, all around; a
    Python function's own is in it, and the rounding that the extremes show.
    """
    law = rolling.law
    (low, _), (high, largest) = law.ratio_range
    shared = (1.0 + abs(law.mate) * largest) * (FEW * EPS + law.solved_error)
    shown = float(law.scatter(np.array([low, high]))[0].max())
    return largest * shared + shown + law.function_errors[1]


def acceleration_error(subject: Subject) -> float:
    """Return the error of the largest acceleration, 1/rad (of a rack over its mean speed).

    That of the ratio's slope, and the rounding of the driver angle where the slope changes.
    """
    law, (places, values) = subject.pair.law, subject.accelerations
    jerk = np.abs(law.ratio.derivatives(places, 2)[2])
    each = systematic_errors(law, places)[1] + law.scatter(places)[1] + EPS * law.period * jerk
    sizes = np.abs(values)
    # another extreme may be the largest only if it comes up to it
    return float((each / subject.pair.rolling.mean_radius - (sizes.max() - sizes)).max())


def direction_error(rolling: Rolling, phi: Array) -> Array:
    """Return errors of the centrode's directions at driver angles of the first lobe, rad.

    Parameters
    ----------
    rolling : Rolling
        The centrodes.
    phi : (n,) array, rad
        Driver angles.

    Returns
    -------
    (n,) array
        Of the slope psi of the radius, ``tan(psi) = r'/r = i'/(i*(1 + w*i))``: rounding, that of
        the driver angle where psi changes fast, that which the ratio's slope shows, and what the
        expansion of a Python function misses.
    """
    law = rolling.law
    r, dr, ddr = rolling.radii(phi, 2)
    square = r * r + dr * dr
    ratio = law.ratio(phi)
    slope = law.function_errors[2] + law.scatter(phi)[1]
    own = slope * r * r / (square * ratio * (1.0 + law.mate * ratio))
    return EPS * (FEW + law.period * np.abs(ddr * r - dr * dr) / square) + own


def size_of(rolling: Rolling) -> tuple[float, float]:
    """Return how far the centrodes go from their shafts, mm, and how points on them are rounded.

    By what they are as far off as, as long as the centrode, and as fast as it runs with the driver
    angle, mm.
    """
    law = rolling.law
    phi = _places(rolling)
    frames = [track.frames(phi, curved=False) for track in rolling.tracks]
    far = max(float(np.abs(frame.p).max()) for frame in frames)
    long = 0.5 * rolling.tracks[0].length + law.period * float(frames[0].speed.max())
    return far, EPS * (FEW * far + long)


def _places(rolling: Rolling) -> Array:
    """Return driver angles all over a lobe, and those at which a centrode bends most, rad."""
    extremes = [places for places, _ in rolling.curvature_extremes]
    return np.concatenate([np.linspace(0.0, rolling.law.period, _PLACES), *extremes])


def own_error(pair: GearPair, phi: Array, rounding: float) -> Array:
    """Return errors of points on flanks against their own wheel's teeth and tips, mm.

    Parameters
    ----------
    pair : GearPair
        The pair.
    phi : (n,) array, rad
        Driver angles in the first lobe.
    rounding : float, mm
        Of points on the centrode.

    Returns
    -------
    (n,) array
        That, and of the direction of the normal along the way to the flank.
    """
    cutters = [toothing.cutter for toothing in pair.toothings]
    way = max(max(one.addendum, one.dedendum) / math.sin(one.alpha) for one in cutters)
    turned = EPS * pair.law.period + direction_error(pair.rolling, phi)
    return way * turned + rounding


def flank_error(pair: GearPair, far: float, rounding: float) -> float:
    """Return the error of points on flanks, mm, in the wheels' frames.

    Parameters
    ----------
    pair : GearPair
        The pair.
    far, rounding : float, mm
        As `size_of` returns them.

    Returns
    -------
    float
        That of their own teeth's, of arc lengths, and of the driven wheel's angle.
    """
    rolling, law = pair.rolling, pair.law
    phi = _places(rolling)
    own = own_error(pair, phi[(phi >= 0.0) & (phi <= law.period)], rounding)
    lever = rolling.center_distance if pair.on_rack else far
    return float(rolling.arc_error + lever * law.integral_error + own.max())


def tip_errors(gear: Gear, rounding: float) -> tuple[float, float]:
    """Return the errors of the reach of flanks at their tips and of the thinnest tip, mm.

    Parameters
    ----------
    gear : Gear
        The wheel.
    rounding : float, mm
        Of points on the centrode.

    Returns
    -------
    reach : float, mm
        More where points hardly move along a flank, if it ends where it crosses another curve.
    thickness : float, mm
        That of both flanks of the thinnest tooth.
    """
    flanks, toothing = gear.profile.flanks, gear.toothing
    own = own_error(gear.pair, _in_lobe(gear, flanks.tips.phi), rounding)
    thinnest = gear.profile.tip_thickness.argmin()
    thickness = float(toothing.of_teeth(own)[:, thinnest].sum())
    high, low = np.split(flanks.tips.foot, 2)
    crossed = flanks.tips.full | np.tile(high <= low, 2)
    regular = toothing.regularity(toothing.frames(flanks.tips.phi), flanks.sf, flanks.sigma)
    run = np.where(crossed, np.maximum(regular, math.sqrt(EPS)), 1.0)
    return float((own / run)[toothing.whole_flanks].max()), thickness


def _in_lobe(gear: Gear, phi: Array) -> Array:
    """Return the driver angles of the first lobe, or of an open pair's travel, next to some."""
    law = gear.pair.law
    return np.mod(phi, law.period) if law.closed else np.clip(phi, 0.0, law.period)


def root_radius_error(gear: Gear) -> float:
    """Return by how much a wheel's curve may be nearer to its shaft than its vertices, mm.

    A curve is as near its chords as they were measured, or not much farther; chords may be nearer
    than their ends. Of a ring, whose roots are its farthest places, ends are as far as chords.
    """
    beside = gear.profile.chord_error / MARGIN
    if gear.ring:
        return beside
    ends = as_complex(gear.outline)
    chords = np.roll(ends, -1) - ends
    length = np.maximum(np.abs(chords), np.finfo(float).tiny)
    along = np.clip(-(ends * np.conj(chords)).real / length, 0.0, length)
    nearest = np.abs(ends + along * chords / length).min()
    return gear.least_radius - float(nearest) + beside


def area_error(gear: Gear) -> float:
    """Return a bound of the area between an outline's chords and its curve, mm^2.

    A bow is smaller than its chord times its height, by half for flat ones. What is left out where
    the curve is convex and what is taken in where it is hollow add up. Of a body that joins the
    ends of an open wheel the dense points are taken.
    """
    sampler = gear.profile.sampler
    places, points, _ = sampler.chords
    ends = np.append(points, points[:1]) if sampler.closed else points
    away = sampler.at(0.5 * (places[:-1] + places[1:]))[0] - ends[:-1]
    left_out = float(np.abs((np.conj(np.diff(ends)) * away).imag).sum())
    for run in gear.profile.body:
        dense = as_complex(run.points)
        sparse = np.append(dense[:: gear.profile.oversampling], dense[-1:])
        swept = [float((np.conj(p[:-1]) * p[1:]).imag.sum()) for p in (dense, sparse)]
        left_out += 0.5 * abs(swept[0] - swept[1])
    return left_out


def kink_error(outline: Outline) -> float:
    """Return a bound of the area that cubics miss at bends of tips, mm^2.

    Where a tooth's tip rises along the centrode, a jump of the curvature bends it by an angle,
    ``delta``. Dense points have one tangent there, so that a cubic of the length l beside it is off
    by ``delta*l^2/12``.
    """
    curves, rows = outline.sampler.curves, outline.rows
    row, place = curves.breaks
    rising = (rows.kind[row] == Curve.TIP) & (rows.low[row] != rows.high[row])
    row, place = row[rising], place[rising]
    points, after = curves.at(row, place)
    _, before = curves.at(row, place - FEW * EPS * (1.0 + np.abs(place)))
    bends = np.abs(np.angle(after * np.conj(before)))
    dense = np.concatenate([as_complex(run.points) for run in outline.dense_teeth])
    area = 0.0
    for point, bend in zip(points, bends, strict=True):
        near = int(np.abs(dense - point).argmin())
        longest = np.abs(np.diff(dense[max(near - 1, 0) : near + 2])).max()
        area += float(bend * longest**2) / 12.0
    return area
