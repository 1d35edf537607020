"""The study of curvature from three neighbouring points, on a cam's own curve."""

from __future__ import annotations

from collections.abc import Sequence
from functools import partial
from typing import Any

import numpy as np

from gearcam.base.errors import InfeasibleError
from gearcam.cams.measures import undercut
from gearcam.cams.three_points import curvature_study
from gearcam.cams.wall import PitchMotion
from gearcam.numeric.arrays import Array, Plane


def pitch_points(motion: PitchMotion, theta: Array) -> Plane:
    """Return points of the pitch curve, or of the profile below a face, counter-clockwise.

    Parameters
    ----------
    motion : PitchMotion
        The motion.
    theta : (n,) array, rad or mm
        Cam angles or travels.

    Returns
    -------
    (n,) complex array, mm
    """
    s, ds = motion.program.derivatives(theta, 1)
    return np.conj(motion.pitch_curve.trace(theta, s, ds)[0])


def curvature_at(motion: PitchMotion, theta: Array) -> Array:
    """Return the exact curvature of this curve, (n,) 1/mm (see `pitch_points`)."""
    contact = motion.pitch_curve.contact(theta, 0)
    return np.asarray(contact.turning.c[0] / contact.pitch_speed.c[0]) + np.zeros_like(theta)


def curvature_columns(
    motion: PitchMotion, counts: Sequence[int]
) -> tuple[dict[str, Array], dict[str, Any]]:
    """Return the error of three-point curvature over the spacing of the points.

    Parameters
    ----------
    motion : PitchMotion
        Its pitch curve is studied, or for a flat follower its profile.
    counts : sequence of int
        Numbers of points, at even cam angles or travels.

    Returns
    -------
    columns : dict of str to (n,) array
        For ``curvature.csv``.
    facts : dict
        For the summary: the order of convergence of the mean error, if there is an error.

    Raises
    ------
    InfeasibleError
        If the profile has cusps, where there is no curvature.
    """
    curve = motion.pitch_curve
    cusps = (low < high or not motion.program.slight(low) for low, high in undercut(curve))
    if any(cusps):  # only of the profile below a face, which is its own pitch curve
        what = "the profile is undercut and has cusps, where there is no curvature to study"
        note = "leave out the curvature study, or remove the undercut"
        raise InfeasibleError(what, where="output.files", nearest=note)

    points, exact = partial(pitch_points, motion), partial(curvature_at, motion)
    period, closed = motion.program.period, motion.program.closed
    study = curvature_study(points, exact, counts, period, closed)
    columns = {
        "points": study.count.astype(np.float64),
        "spacing_mm": study.spacing,
        "largest_error_per_mm": study.largest,
        "rms_error_per_mm": study.rms,
    }
    facts: dict[str, Any] = {"points": list(counts)}
    if np.all(study.rms > 0.0):  # all points may lie on a straight part before a short phase
        order = np.polyfit(np.log(study.spacing), np.log(study.rms), 1)[0]
        facts["order_of_rms"] = float(order)
    return columns, facts
