"""Targets of cams, measured in one run."""

from __future__ import annotations

import math
from typing import Any

import numpy as np
import shapely

import gearcam
from cases import load, slope
from measuring import Result, in_turns, measure, show, table

CAM = """
kind = "cam"
name = "offset_roller"
follower = {{ type = "roller", roller_radius_mm = 6, offset_mm = 8 }}
cam = {{ prime_radius_mm = 30 }}
output = {{ chord_tolerance_mm = {tolerance} }}
motion = [
    {{ type = "rise", law = "cycloidal", angle_deg = 90, lift_mm = 10 }},
    {{ type = "dwell", angle_deg = 90 }},
    {{ type = "return", law = "cycloidal", angle_deg = 90 }},
    {{ type = "dwell", angle_deg = 90 }},
]
"""
GROOVE = 'form = "groove", outer_diameter_mm = 110, thickness_mm = 20, groove_depth_mm = 12, '
RADIUS = 6.0
ALLOWED = 1e-3
NOTE = """\
The cam is the reference cam with an offset roller. From a blank of radius 60 mm a roller of
{segments} chords is subtracted at {steps} even angles; both numbers are the smallest of those tried
whose boundary deviates by at most 1 um from a profile with chords of 1 nm: {error:.2f} um
(gearcam's chords: {mine:.2f} um). One difference for each angle is the obvious loop with a boolean
kernel; one union of all rollers and one difference is the fastest way found: {union:.0f} times
gearcam's time. No time includes reading the design."""


def profile(design: Any) -> Any:
    """Return the polygon of the profile of a new result."""
    return gearcam.build(design).profile.vertices


def walls(design: Any) -> Any:
    """Return the polygons of all walls of a new result."""
    return [wall.contour.vertices for wall in gearcam.build(design).cam.walls]


def groove_against_disc(tries: int = 25) -> Result:
    """(r) Both walls of a groove against the disc cam with the same motion."""
    disc = load(CAM.format(tolerance=ALLOWED))
    groove = load(CAM.format(tolerance=ALLOWED).replace("cam = {", "cam = { " + GROOVE))
    made = in_turns({"groove": lambda: walls(groove), "disc": lambda: walls(disc)}, tries)
    found = made[0].over(made[1])
    return Result(
        title="(r) A groove against the disc cam with the same motion",
        asked="at most 2.2 times the time at 1 um",
        found=f"{found:.2f} times",
        passed=found <= 2.2,
        body=[*table(made), "", "The walls of the reference cam as polygons, from the design."],
    )


def blank() -> Any:
    """Return a disc that contains the cam."""
    return shapely.Point(0.0, 0.0).buffer(60.0, quad_segs=180)


def rollers(job: Any, steps: int, segments: int) -> Any:
    """Return the roller at even angles, in the frame of the cam."""
    theta = np.arange(steps) * (2.0 * math.pi / steps)
    centers, _ = job.cam.pitch_curve.trace(theta, *job.program.derivatives(theta, 1))
    made = shapely.points(centers.real, centers.imag)
    return shapely.buffer(made, RADIUS, quad_segs=segments // 4)


def united(job: Any, steps: int, segments: int) -> Any:
    """Return the cam by one union of all rollers and one difference."""
    return _cam(blank().difference(shapely.union_all(rollers(job, steps, segments))))


def one_by_one(job: Any, steps: int, segments: int) -> Any:
    """Return the cam by a difference for each roller."""
    left = blank()
    for roller in rollers(job, steps, segments):
        left = left.difference(roller)
    return _cam(left)


def _cam(left: Any) -> Any:
    return next(part for part in shapely.get_parts(left) if part.covers(shapely.Point(0.0, 0.0)))


def against_subtraction(tries: int = 15) -> Result:
    """(f) A profile at 1 um against the boolean subtraction of the roller."""
    design = load(CAM.format(tolerance=ALLOWED))
    job = gearcam.build(design)
    truth = shapely.LinearRing(profile(load(CAM.format(tolerance=1e-6))))
    for steps in range(800, 4000, 100):
        segments = 4 * round(0.08 * steps)
        corners = shapely.points(np.asarray(united(job, steps, segments).exterior.coords))
        error = float(shapely.distance(corners, truth).max())
        if error <= ALLOWED:
            break
    mine, loop, union = in_turns(
        {
            "gearcam, 1 um": lambda: profile(design),
            "one difference for each angle": lambda: one_by_one(job, steps, segments),
            "one union, one difference": lambda: united(job, steps, segments),
        },
        tries,
    )
    ratio = loop.median / mine.median
    return Result(
        title="(f) A cam against the boolean subtraction of its roller",
        asked="at least 50 times faster at an error of 1 um",
        found=f"{ratio:.0f} times; {union.median / mine.median:.0f} times one union of all rollers",
        passed=ratio >= 50,
        body=[
            *table([mine, loop, union]),
            "",
            NOTE.format(
                segments=segments,
                steps=steps,
                error=1e3 * error,
                mine=1e3 * job.profile.chord_error,
                union=union.median / mine.median,
            ),
        ],
    )


def cam_growth() -> Result:
    """(g) Time against the number of points, from 1 um to 10 pm."""
    rows, counts, medians = [], [], []
    for power in range(3, 9):
        design = load(CAM.format(tolerance=f"1e-{power}"))
        counts.append(len(profile(design)))
        timing = measure("", lambda d=design: profile(d), 7)
        medians.append(timing.median)
        raw = ", ".join(show(sample) for sample in timing.samples)
        rows.append(f"| 1e-{power} mm | {counts[-1]} | {show(timing.median)} | {raw} |")
    found = slope(counts, medians)
    last = medians[-1] / medians[-2]
    return Result(
        title="(g) A cam from 1 um to 10 pm",
        asked="time grows at most linearly in the number of points",
        found=f"time as n^{found:.2f}; the last {counts[-1] / counts[-2]:.2f} times the points "
        f"take {last:.2f} times as long",
        passed=found <= 1.0 and last <= 1.1 * counts[-1] / counts[-2],
        body=["| tolerance | points | median | samples |", "|---|---|---|---|", *rows],
    )
