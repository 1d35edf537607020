"""The profile of a cam by closed form and boolean sweep, and its curvature from three points."""

from __future__ import annotations

from dataclasses import replace
from typing import Any

import mpmath
import numpy as np
import shapely

from gearcam.cams.three_points import three_point_curvature
from helpers_cams import cam, corners_of, witness_of
from methods import Case, Method
from witness.cam_sweep import Exact, Motion, pairs, swept
from witness.distance import distances

mp: Any = mpmath.mp
KIND, LAW, LIFT, DEGREES = "roller, offset", "3-4-5", 8.0, (60.0, 90.0, 60.0, 150.0)
TOLERANCES = (1e-2, 1e-3, 1e-4, 1e-5, 1e-6)
REFERENCES = 47
"""Number of cam angles of the reference: a prime, so that it does not divide those of the sweep."""
SHARE = "0.3"
"""Shift of these angles relative to their step, so that none is at a knot."""


def _witness() -> tuple[Exact, list[Any]]:
    exact = Exact(witness_of(KIND), Motion(LAW, LIFT, DEGREES))
    step = 2 * mp.pi / REFERENCES
    return exact, [(k + mp.mpf(SHARE)) * step for k in range(REFERENCES)]


def profile() -> Case:
    """Return the case of the profile of a cam with an offset roller."""
    made = cam(KIND, LAW, LIFT, DEGREES)
    with mp.workdps(50):
        exact, angles = _witness()
        contacts = [exact.contact(theta) for theta in angles]
    points = pairs(np.array([complex(z) for z in contacts]))
    follower, motion = witness_of(KIND), Motion(LAW, LIFT, DEGREES)

    def analytic(tolerance: float) -> Any:
        return corners_of(replace(made, tolerance=tolerance))

    def closed(count: float) -> Any:
        theta = (np.arange(count) + float(SHARE)) * (2.0 * np.pi / count)
        return made.places_at(theta)[1]

    def boolean(count: float) -> Any:
        theta = np.arange(count) * (2.0 * np.pi / count)
        lift = motion(theta, np)
        return swept(follower, theta, lift, float(np.hypot(*points.T).max()) + 5.0, int(4 * count))

    def off(edge: Any) -> float:
        return float(distances(points, edge).max())

    def of_points(found: Any) -> float:
        # radii only, since a cam with the other direction of rotation is mirrored
        return float(np.abs(np.abs(found) - np.hypot(*points.T)).max())

    return Case(
        name="cam_profile",
        title="Profile of a cam",
        what="the profile",
        unit="mm",
        methods=[
            Method("closed form, the points", "points", (REFERENCES,), closed, error=of_points),
            Method(
                "closed form, chords between", "chord tolerance, mm", TOLERANCES, analytic, -1.0,
                error=lambda z: off(shapely.LinearRing(pairs(z))),
            ),
            Method(
                "boolean sweep", "cam angles", (90, 180, 360, 720), boolean, 2.0,
                error=lambda region: off(region.exterior),
            ),
        ],
        own="closed form",
        error=lambda _: np.nan,
        rounding=1e-13,
        note="Offset roller, 3-4-5 rises of 8 mm in 60 degrees; against the envelope by "
        f"differences in 50 digits at {REFERENCES} cam angles. The roller of the sweep is a "
        "polygon with four vertices per cam angle.",
    )  # fmt: skip


def curvature() -> Case:
    """Return the case of the curvature of its pitch curve."""
    made = cam(KIND, LAW, LIFT, DEGREES)
    with mp.workdps(50):
        exact, angles = _witness()
        truth = np.array([float(exact.curvature(exact.pitch, theta)) for theta in angles])
    places = np.array([float(theta) for theta in angles])

    def closed(_: float) -> Any:
        found = made.curve.contact(places, 0)
        return np.asarray(found.turning.c[0] / found.pitch_speed.c[0]) + 0.0 * places

    def three(count: float) -> Any:
        step = 2.0 * np.pi / count
        theta = (places[:, None] + step * np.array([-1.0, 0.0, 1.0])).ravel()
        s, ds = made.program.derivatives(theta, 1)
        z = np.conj(made.curve.trace(theta, s, ds, 0.0)[0]).reshape(-1, 3)
        return np.array([three_point_curvature(row, closed=False)[0] for row in z])

    counts = (45, 90, 180, 360, 720, 1440, 5760, 23040, 368640)
    return Case(
        name="cam_curvature",
        title="Curvature of a cam's pitch curve",
        what="the curvature",
        unit="1/mm",
        methods=[
            Method("closed form", "", (1.0,), closed),
            Method("three points", "points per turn", counts, three, 2.0),
        ],
        own="closed form",
        error=lambda found: float(np.abs(found - truth).max()),
        rounding=1e-14,
        note=f"At the same {REFERENCES} cam angles, against derivatives in 50 digits; the "
        "distance of three points is that of so many points in a turn.",
    )


def cases() -> list[Case]:
    """Return all cases."""
    return [profile(), curvature()]
