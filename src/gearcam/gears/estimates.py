"""Error estimates of the numbers of a pair, each with its method.

Where rounding is the only error, the estimate includes what amplifies it: the driver angle's
rounding moves points where the centrode runs or turns fast, changes directions where it bends, and
changes a flank's reach where the flank meets the addendum curve at a small angle.

Depends on subject.
"""

from __future__ import annotations

import math
from typing import Final

import numpy as np

from gearcam.gears.flank import Curve
from gearcam.gears.outline import Outline
from gearcam.gears.pair import Gear, GearPair
from gearcam.gears.rolling import EPS, FEW, Rolling, systematic_errors
from gearcam.gears.subject import Subject
from gearcam.numeric.arrays import Array
from gearcam.numeric.bulges import as_complex
from gearcam.numeric.sampling import MARGIN

_PLACES: Final = 721
"""Points per lobe in the search for the centrodes' farthest point and largest speed."""

Estimates = dict[str, tuple[float, str]]
"""Estimated error and its method, by name."""


def estimates(subject: Subject) -> Estimates:
    """Return estimated errors of the numbers in a pair's summary.

    Parameters
    ----------
    subject : Subject
        The pair as built.

    Returns
    -------
    dict
        Estimate and method by name. Names end with the unit; ratios have none.
    """
    pair, gears = subject.pair, subject.gears
    rolling, law = pair.rolling, pair.law
    steepest = [place for place, _ in subject.pressure_angles.values()]
    function = ", plus the expansion error of the Python function" if law.function_error else ""
    far, rounding = size_of(rolling)
    flank = flank_error(pair, far, rounding)
    reaches, thicknesses = zip(*(tip_errors(gear, rounding) for gear in gears), strict=True)
    bends = [track.bends for track in rolling.tracks]
    bent = "scatter near extremes, ratio and derivatives at knots, closure, size" + function
    passing: Estimates = {}
    if (passed := subject.tip_pass) is not None:
        how = "position errors of both tip corners, projected on the centrode"
        passing["tip_pass_margin_mm"] = ((1.0 + passed.slope) * (sum(reaches) + flank), how)
    return {
        "law": (
            law.error,
            "rad of the driven angle: comparison with Gauss-Legendre quadrature" + function,
        ),
        "closure_rad": (abs(law.closure_error), "residual of the driven angle over a lobe"),
        "ratio": (
            ratio_error(rolling),
            "closure and rounding, amplified where the radius nears the centre distance",
        ),
        "acceleration_per_rad": (
            acceleration_error(subject),
            "scatter of the ratio's slope, rounding of driver angle and knots" + function,
        ),
        "arc_length_mm": (
            rolling.arc_error,
            "comparison with Gauss-Legendre quadrature, and rounding" + function,
        ),
        "convex_radius_mm": (max(one.radius_error for one in bends), bent),
        "concave_curvature_per_mm": (max(one.concave_error for one in bends), bent),
        "size": (rolling.size_error, "relative error of the arc length, module, centre distance"),
        "flank_mm": (
            flank,
            "errors of arc length, driven angle and directions, rounding of the driver angle",
        ),
        "pressure_angle_deg": (
            math.degrees(float(direction_error(rolling, np.array(steepest)).max())),
            "direction of the centrode, rounding of the driver angle",
        ),
        "contact_ratio": (
            sum(reaches) / pair.toothings[0].pitch,
            "error of flank points over the angle at which the flank meets the addendum curve",
        ),
        "tip_thickness_mm": (
            max(thicknesses),
            "errors of both flanks at the tip of the thinnest tooth",
        ),
        **passing,
        "backlash_mm": (FEW * EPS * pair.toothings[0].pitch, "rounding of the pitch"),
        "root_radius_mm": (
            max(root_radius_error(gear) for gear in gears) + flank,
            "distance of chords and curve beyond the vertices, plus flank_mm",
        ),
        "area_mm2": (
            max(area_error(gear) for gear in gears),
            "chord lengths times chord errors",
        ),
    }


def ratio_error(rolling: Rolling) -> float:
    """Return the error of ratios: with ``i = u/(1 - w*u)`` that of u, times ``1 + w*i``.

    A law solved to close spreads its residual, as if the centre distance were off by it. Includes
    the expansion error of a Python function, and rounding as seen at the extremes.
    """
    law = rolling.law
    (low, _), (high, largest) = law.ratio_range
    shared = (1.0 + abs(law.mate) * largest) * (FEW * EPS + law.solved_error)
    shown = float(law.scatter(np.array([low, high]))[0].max())
    return largest * shared + shown + law.function_errors[1]


def acceleration_error(subject: Subject) -> float:
    """Return the error of the largest acceleration, 1/rad (for a rack over its mean speed).

    Error of the ratio's slope, plus the rounding of the driver angle where the slope changes.
    """
    law, (places, values) = subject.pair.law, subject.accelerations
    jerk = np.abs(law.ratio.derivatives(places, 2)[2])
    each = systematic_errors(law, places)[1] + law.scatter(places)[1] + EPS * law.period * jerk
    sizes = np.abs(values)
    # another extreme counts only if its error bound exceeds the largest
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
        Error of the slope psi of the radius, ``tan(psi) = r'/r = i'/(i*(1 + w*i))``: rounding, also
        of the driver angle where psi changes fast, scatter of the ratio's slope, and the expansion
        error of a Python function.
    """
    law = rolling.law
    r, dr, ddr = rolling.radii(phi, 2)
    square = r * r + dr * dr
    ratio = law.ratio(phi)
    slope = law.function_errors[2] + law.scatter(phi)[1]
    own = slope * r * r / (square * ratio * (1.0 + law.mate * ratio))
    return EPS * (FEW + law.period * np.abs(ddr * r - dr * dr) / square) + own


def size_of(rolling: Rolling) -> tuple[float, float]:
    """Return the largest distance of the centrodes from their shafts and their rounding, both mm.

    Rounding grows with distance, with the length of the centrode, and with its speed over the
    driver angle.
    """
    law = rolling.law
    phi = _places(rolling)
    frames = [track.frames(phi, curved=False) for track in rolling.tracks]
    far = max(float(np.abs(frame.p).max()) for frame in frames)
    long = 0.5 * rolling.tracks[0].length + law.period * float(frames[0].speed.max())
    return far, EPS * (FEW * far + long)


def _places(rolling: Rolling) -> Array:
    """Return driver angles spread over a lobe, and at the extremes of curvature, rad."""
    extremes = [places for places, _ in rolling.curvature_extremes]
    return np.concatenate([np.linspace(0.0, rolling.law.period, _PLACES), *extremes])


def own_error(pair: GearPair, phi: Array, rounding: float) -> Array:
    """Return errors of flank points relative to their own wheel's teeth and tips, mm.

    Parameters
    ----------
    pair : GearPair
        The pair.
    phi : (n,) array, rad
        Driver angles in the first lobe.
    rounding : float, mm
        Rounding of points on the centrode.

    Returns
    -------
    (n,) array
        Rounding plus the error of the normal's direction over the distance to the flank.
    """
    cutters = [toothing.cutter for toothing in pair.toothings]
    way = max(max(one.addendum, one.dedendum) / math.sin(one.alpha) for one in cutters)
    turned = EPS * pair.law.period + direction_error(pair.rolling, phi)
    return way * turned + rounding


def flank_error(pair: GearPair, far: float, rounding: float) -> float:
    """Return the error of flank points in the wheels' frames, mm.

    Parameters
    ----------
    pair : GearPair
        The pair.
    far, rounding : float, mm
        As `size_of` returns them.

    Returns
    -------
    float
        Error relative to their teeth, plus those of arc length and of the driven angle.
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
        Rounding of points on the centrode.

    Returns
    -------
    reach : float, mm
        Larger where a flank crosses the curve that ends it at a small angle.
    thickness : float, mm
        Sum over both flanks of the thinnest tooth.
    """
    flanks, toothing = gear.profile.flanks, gear.toothing
    law, phi = gear.pair.law, flanks.tips.phi
    in_lobe = np.mod(phi, law.period) if law.closed else np.clip(phi, 0.0, law.period)
    own = own_error(gear.pair, in_lobe, rounding)
    thinnest = gear.profile.tip_thickness.argmin()
    thickness = float(toothing.of_teeth(own)[:, thinnest].sum())
    high, low = np.split(flanks.tips.foot, 2)
    crossed = flanks.tips.full | np.tile(high <= low, 2)
    regular = toothing.regularity(toothing.frames(flanks.tips.phi), flanks.sf, flanks.sigma)
    run = np.where(crossed, np.maximum(regular, math.sqrt(EPS)), 1.0)
    return float((own / run)[toothing.whole_flanks].max()), thickness


def root_radius_error(gear: Gear) -> float:
    """Return by how much a wheel's curve may come nearer to its shaft than its vertices, mm.

    The curve is off its chords by the measured chord error, and chords may be nearer to the shaft
    than their ends; not so for a ring, whose roots are its farthest points.
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

    A segment's area is less than its chord times its height. Areas at convex and at concave parts
    are added, not set off. For the body that joins the ends of an open wheel the dense points are
    used.
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
    """Return a bound of the area error of cubics at kinks of tips, mm^2.

    Where a tip rises along the centrode, a jump of the curvature gives it a kink of an angle
    ``delta``. Dense points have a single tangent there: a cubic of length l next to it is off by
    ``delta*l^2/12``.
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
