"""From wheels to parts: what a design orders beyond the teeth, and what that does to the flanks."""

from __future__ import annotations

import math
from dataclasses import replace

import numpy as np

from gearcam.gears.pair import Gear
from gearcam.kinds.gear_pair.design import GearPairDesign
from gearcam.numeric.arrays import Array, Mask, Plane
from gearcam.parts.body import Mark, Part
from gearcam.parts.checks import PartsSubject
from gearcam.parts.make import make_part
from gearcam.parts.marks import timing_mark
from gearcam.parts.openings import Workpiece

Steps = tuple[tuple[Gear, Gear], ...]

_PLACES = 65
"""Places on each flank at which it is asked whether a cutter gets there."""


def make_parts(steps: Steps, design: GearPairDesign) -> tuple[Part, Part]:
    """Return both wheels as parts.

    Parameters
    ----------
    steps : tuple of (Gear, Gear)
        Both wheels of each step, from below.
    design : GearPairDesign
        What is ordered.

    Returns
    -------
    (Part, Part)
        Driver first.

    Raises
    ------
    InfeasibleError
        If what the design orders has no room.
    """
    first, second = (_part([pair[k] for pair in steps], design) for k in (0, 1))
    return first, second


def _part(gears: list[Gear], design: GearPairDesign) -> Part:
    gear = gears[0]
    lobes, rack = gear.pair.law.lobes, gear.toothing.track.slides
    travel = None
    if not lobes.closed and not rack:
        travel = lobes.period if gear.wheel == 1 else lobes.advance
    blank = design.blank.wheel(gear.wheel)
    if rack:
        blank = replace(
            blank, bore_diameter=0.0, bolts=0, hub_diameter=0.0, lightening_holes=0, stop_pin=0.0
        )
    wheel = gear.wheel
    work = Workpiece(name=f"wheel {wheel}", module=gear.pair.module, travel=travel, wheel=wheel)
    contours = [one.profile.contour for one in gears]
    marker = None if rack else lambda: _mark(gear, design)
    return make_part(gear.name, contours, design.pair.face_width, blank, work, marker)


def _mark(gear: Gear, design: GearPairDesign) -> Mark:
    frames = gear.toothing.frames(np.zeros(1))
    radius = complex(frames.p[0])
    normal = complex(frames.t[0]) * gear.toothing.turn
    blank = design.blank.wheel(gear.wheel).widened
    return timing_mark(
        abs(radius),
        0.0 if gear.wheel == 1 else math.pi,
        gear.pair.module,
        gear.toothing.cutter.dedendum,
        design.pair.face_width,
        bore_reach=max(blank.bore_reach, 0.5 * blank.hub_diameter),
        tilt=abs(float(np.angle(normal / radius))),
        diameter=blank.mark_diameter,
    )


def parts_subject(parts: tuple[Part, Part], gears: tuple[Gear, Gear], kerf: float) -> PartsSubject:
    """Return what checks of `parts` look at: where a cutter with a `kerf`, mm, gets on `gears`."""
    pairs = zip(parts, gears, strict=True)
    uncut = tuple(bool(kerf) and _uncut(part, gear, kerf) for part, gear in pairs)
    return PartsSubject(parts=parts, kerf=kerf, uncut=uncut)


def _uncut(part: Part, gear: Gear, kerf: float) -> bool:
    """Return whether a cutter does not get to some place of a wheel's flanks as made."""
    from gearcam.parts.parallel import touches

    kept, points, normals = _places(gear, _PLACES)
    found = touches(part.contour, points[:, kept].ravel(), normals[:, kept].ravel(), 0.5 * kerf)
    return not found.all()


def _places(gear: Gear, count: int) -> tuple[Mask, Plane, Plane]:
    """Return which flanks of whole teeth there are, and places on all, root to tip, normals."""
    flanks = gear.profile.flanks
    kept = gear.toothing.whole_flanks & (flanks.highest > flanks.lowest)
    share = np.linspace(0.0, 1.0, count)[:, None]
    reach = flanks.lowest + share * (flanks.highest - flanks.lowest)
    return kept, *gear.profile.flank_places(np.where(kept, reach, 0.0))


def inspection_rows(steps: Steps, count: int) -> dict[str, Array]:
    """Return the points of an inspection, by column.

    Parameters
    ----------
    steps : tuple of (Gear, Gear)
        Both wheels of each step, from below.
    count : int
        Points on each flank.

    Returns
    -------
    dict of str to (n,) array
        Both wheels, every step, every whole tooth, both sides, from root to tip: points of the
        flanks as made and the outward normals of the metal, in the wheel's frame.
    """
    blocks: list[list[Array]] = []
    for step, gears in enumerate(steps, start=1):
        for gear in gears:
            kept, points, normals = _places(gear, count)
            points, normals = points[:, kept].T.ravel(), normals[:, kept].T.ravel()
            tooth = np.tile(np.array(gear.toothing.numbers), 2)[kept]
            side = gear.profile.flanks.sigma[kept]
            order = np.lexsort((-side, tooth))
            rows = (order[:, None] * count + np.arange(count)).ravel()
            columns = [
                np.full(points.size, gear.wheel),
                np.full(points.size, step),
                np.repeat(tooth, count),
                np.repeat(side, count),
                np.tile(np.arange(1, count + 1), int(kept.sum())),
                points.real,
                points.imag,
                normals.real,
                normals.imag,
            ]
            blocks.append([np.asarray(column, dtype=np.float64)[rows] for column in columns])
    names = ("wheel", "step", "tooth", "side", "point", "x_mm", "y_mm", "nx", "ny")
    return {name: np.concatenate([block[k] for block in blocks]) for k, name in enumerate(names)}
