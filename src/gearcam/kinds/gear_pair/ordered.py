"""From wheels to parts: what a design orders beyond the teeth, and what that does to the flanks."""

from __future__ import annotations

import math
from dataclasses import replace
from typing import TYPE_CHECKING

import numpy as np

from gearcam.gears.pair import Gear
from gearcam.numeric.arrays import Array
from gearcam.parts.body import Mark, Part
from gearcam.parts.checks import PartsSubject
from gearcam.parts.make import make_part
from gearcam.parts.marks import timing_mark
from gearcam.parts.openings import Workpiece

if TYPE_CHECKING:
    from gearcam.kinds.gear_pair.build import GearPairResult


_PLACES = 65
"""Places on each flank at which it is asked whether a cutter gets there."""


def make_parts(result: GearPairResult) -> tuple[Part, Part]:
    """Return both wheels as parts.

    Parameters
    ----------
    result : GearPairResult
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
    first, second = (_part(result, number) for number in (1, 2))
    return first, second


def _part(result: GearPairResult, number: int) -> Part:
    gear = result.gears[number - 1]
    contours = [gears[number - 1].profile.contour for gears in result.steps]
    rack = gear.toothing.track.slides
    travel = None
    if not result.law.lobes.closed and not rack:
        travel = result.law.lobes.period if number == 1 else result.law.lobes.advance
    blank = result.design.blank.wheel(number)
    if rack:
        blank = replace(
            blank, bore_diameter=0.0, bolts=0, hub_diameter=0.0, lightening_holes=0, stop_pin=0.0
        )
    return make_part(
        gear.name,
        contours,
        result.design.pair.face_width,
        blank,
        Workpiece(wheel=number, module=result.pair.module, travel=travel),
        None if rack else lambda: _mark(result, gear),
    )


def _mark(result: GearPairResult, gear: Gear) -> Mark:
    frames = gear.toothing.frames(np.zeros(1))
    radius = complex(frames.p[0])
    normal = complex(frames.t[0]) * gear.toothing.turn
    blank = result.design.blank.wheel(gear.wheel).widened
    return timing_mark(
        abs(radius),
        0.0 if gear.wheel == 1 else math.pi,
        result.pair.module,
        gear.toothing.cutter.dedendum,
        result.design.pair.face_width,
        bore_reach=max(blank.bore_reach, 0.5 * blank.hub_diameter),
        tilt=abs(float(np.angle(normal / radius))),
        diameter=blank.mark_diameter,
    )


def parts_subject(result: GearPairResult) -> PartsSubject:
    """Return what the checks of parts look at: the `result`'s parts, and where a cutter gets to."""
    kerf = result.design.output.kerf
    uncut = tuple(bool(kerf) and _uncut(result, number, kerf) for number in (1, 2))
    return PartsSubject(parts=result.parts, kerf=kerf, uncut=uncut)


def _uncut(result: GearPairResult, number: int, kerf: float) -> bool:
    """Return whether a cutter does not get to some place of a wheel's flanks as made."""
    from gearcam.parts.parallel import touches

    gear = result.gears[number - 1]
    low, high = gear.profile.flanks.lowest, gear.profile.flanks.highest
    kept = gear.toothing.whole_flanks & (high > low)
    reach = low + np.linspace(0.0, 1.0, _PLACES)[:, None] * (high - low)
    points, normals = gear.profile.flank_places(np.where(kept, reach, 0.0))
    contour = result.parts[number - 1].contour
    return not touches(contour, points[:, kept].ravel(), normals[:, kept].ravel(), 0.5 * kerf).all()


def inspection_rows(result: GearPairResult) -> dict[str, Array]:
    """Return the points of an inspection, by column.

    Parameters
    ----------
    result : GearPairResult
        With its wheels and steps.

    Returns
    -------
    dict of str to (n,) array
        Both wheels, every step, every whole tooth, both sides, from root to tip: points of the
        flanks as made and the outward normals of the metal, in the wheel's frame.
    """
    share = np.linspace(0.0, 1.0, result.design.output.inspection_points)[:, None]
    blocks: list[list[Array]] = []
    for step, gears in enumerate(result.steps, start=1):
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
