"""From wheels to parts: what a design orders beyond the teeth, and what that does to the flanks."""

from __future__ import annotations

import math
from dataclasses import replace
from typing import TYPE_CHECKING

import numpy as np
from numpy.typing import NDArray

from gearcam.gears.pair import Gear
from gearcam.parts.checks import PartsSubject
from gearcam.parts.make import make_part
from gearcam.parts.marks import timing_mark
from gearcam.parts.openings import Place
from gearcam.parts.part import Mark, Part

if TYPE_CHECKING:
    from gearcam.jobs.gear_pair import GearPairJob

Array = NDArray[np.float64]

_PLACES = 65
"""Places on each flank at which it is asked whether a cutter gets there."""


def make_parts(job: GearPairJob) -> tuple[Part, Part]:
    """Return both wheels as parts.

    Parameters
    ----------
    job : GearPairJob
        With its wheels, and with the steps of stepped ones.

    Returns
    -------
    (Part, Part)
        Driver first.

    Raises
    ------
    InfeasibleError
        If what the design orders has no room.
    """
    first, second = (_part(job, number) for number in (1, 2))
    return first, second


def _part(job: GearPairJob, number: int) -> Part:
    gear = job.gears[number - 1]
    contours = [gears[number - 1].profile.contour for gears in job.steps]
    rack = gear.toothing.track.slides
    travel = None
    if not job.law.lobes.closed and not rack:
        travel = job.law.lobes.period if number == 1 else job.law.lobes.advance
    blank = job.design.blank.wheel(number)
    if rack:
        blank = replace(
            blank, bore_diameter=0.0, bolts=0, hub_diameter=0.0, lightening_holes=0, stop_pin=0.0
        )
    return make_part(
        gear.name,
        contours,
        job.design.pair.face_width,
        blank,
        Place(wheel=number, module=job.pair.module, travel=travel),
        None if rack else lambda: _mark(job, gear),
    )


def _mark(job: GearPairJob, gear: Gear) -> Mark:
    frames = gear.toothing.frames(np.zeros(1))
    radius = complex(frames.p[0])
    normal = complex(frames.t[0]) * gear.toothing.turn
    blank = job.design.blank.wheel(gear.wheel).widened
    return timing_mark(
        abs(radius),
        0.0 if gear.wheel == 1 else math.pi,
        job.pair.module,
        gear.toothing.cutter.dedendum,
        job.design.pair.face_width,
        bore_reach=max(blank.bore_reach, 0.5 * blank.hub_diameter),
        tilt=abs(float(np.angle(normal / radius))),
        diameter=blank.mark_diameter,
    )


def parts_subject(job: GearPairJob) -> PartsSubject:
    """Return what the checks of parts look at: the `job`'s parts, and where a cutter gets to."""
    kerf = job.design.output.kerf
    uncut = tuple(bool(kerf) and _uncut(job, number, kerf) for number in (1, 2))
    return PartsSubject(parts=job.parts, kerf=kerf, uncut=uncut)


def _uncut(job: GearPairJob, number: int, kerf: float) -> bool:
    """Return whether a cutter does not get to some place of a wheel's flanks as made."""
    from gearcam.parts.parallel import touches

    gear = job.gears[number - 1]
    low, high = gear.profile.flanks.lowest, gear.profile.flanks.highest
    kept = gear.toothing.whole_flanks & (high > low)
    reach = low + np.linspace(0.0, 1.0, _PLACES)[:, None] * (high - low)
    points, normals = gear.profile.flank_places(np.where(kept, reach, 0.0))
    contour = job.parts[number - 1].contour
    return not touches(contour, points[:, kept].ravel(), normals[:, kept].ravel(), 0.5 * kerf).all()


def inspection_rows(job: GearPairJob) -> dict[str, Array]:
    """Return the points of an inspection, by column.

    Parameters
    ----------
    job : GearPairJob
        With its wheels and steps.

    Returns
    -------
    dict of str to (n,) array
        Both wheels, every step, every whole tooth, both sides, from root to tip: points of the
        flanks as made and the outward normals of the metal, in the wheel's frame.
    """
    share = np.linspace(0.0, 1.0, job.design.output.inspection_points)[:, None]
    blocks: list[list[Array]] = []
    for step, gears in enumerate(job.steps, start=1):
        for gear in gears:
            flanks = gear.profile.flanks
            low, high = flanks.lowest, flanks.highest
            reach = low + share * (high - low)
            kept = gear.toothing.whole_flanks & (high > low)
            reach = np.where(kept, reach, 0.0)
            points, normals = gear.profile.flank_places(reach)
            points = points[:, kept].T.ravel()
            normals, count = normals[:, kept].T.ravel(), len(share)
            tooth = np.tile(np.array(gear.toothing.numbers), 2)[kept]
            order = np.lexsort((-flanks.sigma[kept], tooth))
            rows = (order[:, None] * count + np.arange(count)).ravel()
            columns = [
                np.full(points.size, gear.wheel),
                np.full(points.size, step),
                np.repeat(tooth, count),
                np.repeat(flanks.sigma[kept], count),
                np.tile(np.arange(1, count + 1), int(kept.sum())),
                points.real,
                points.imag,
                normals.real,
                normals.imag,
            ]
            blocks.append([np.asarray(column, dtype=np.float64)[rows] for column in columns])
    names = ("wheel", "step", "tooth", "side", "point", "x_mm", "y_mm", "nx", "ny")
    return {name: np.concatenate([block[k] for block in blocks]) for k, name in enumerate(names)}
