"""A part of a large wheel: a tooth with its neighbours, held where it is cut from the rest.

Good for stress alone: of 40 teeth, with two neighbours on each side and five modules below the
roots, the tension in the fillet is 0.2 % too large, but the deflection 17 % too small.
"""

from __future__ import annotations

import math
from itertools import pairwise
from typing import Final

import numpy as np

from gearcam.stress.region import BoundaryCurve, BoundaryRun, Region, arc_run

_THIN: Final = 0.4
"""Least share of the depth of a sector that openings must leave."""

_BESIDE: Final = 0.55
"""Share of a sector's angle, on either side of its middle, in which openings count."""

_SHORT: Final = 1e-9
"""Shortest piece of a cut run, of the curve: rounding."""


def sector(region: Region, start: float, end: float, depth: float) -> Region:
    """Return the part of a region at some of its teeth, held where it is cut.

    The cuts run along rays from the axis to an arc about it.

    Parameters
    ----------
    region : Region
        A wheel or ring.
    start, end : float, mm
        s on the curve with the teeth at which it is cut, `end` after `start`: in roots.
    depth : float, mm
        Metal below the roots. Above an opening, or where the region itself is held, there is less.

    Returns
    -------
    Region
        Without holes.

    Raises
    ------
    ValueError
        If an opening that is not held leaves less than two fifths of the depth: the whole region is
        needed.
    """
    runs = _between(region.teeth, start, end)
    points = np.concatenate([run.points for run in runs])
    turn = float(np.angle(points[1:] / points[:-1]).sum())
    outward = math.copysign(1.0, turn)  # teeth that run clockwise are those of a ring
    roots = float((outward * np.abs(points)).min())
    middle = points[0] * np.exp(0.5j * turn)

    def reach(held: bool, floor: float) -> float:
        """Return the height of held or free curves below the teeth, at least `floor`."""
        for curve in region.curves:
            if curve is not region.teeth and curve.runs[0].held == held:
                others = curve.at(curve.places)[0]
                below = others[np.abs(np.angle(others / middle)) < _BESIDE * abs(turn)]
                floor = float((outward * np.abs(below)).max(initial=floor))
        return floor

    lowest = reach(held=True, floor=roots - depth)
    height = reach(held=False, floor=lowest)
    if height > max(lowest, roots - _THIN * depth):
        raise ValueError("an opening is too near to the teeth for a sector")
    feet = outward * height * points[[-1, 0]] / np.abs(points[[-1, 0]])
    last, first = complex(points[-1]), complex(points[0])
    cut = (
        arc_run(last, complex(feet[0]), held=True),
        arc_run(complex(feet[0]), complex(feet[1]), -math.tan(0.25 * turn), held=True),
        arc_run(complex(feet[1]), first, held=True),
    )
    return Region(outer=BoundaryCurve(runs=(*runs, *cut)))


def _between(curve: BoundaryCurve, start: float, end: float) -> tuple[BoundaryRun, ...]:
    """Return the runs of a curve from one s to another."""
    first, span = start % curve.length, (end - start) % curve.length
    turn = np.append(curve.starts, curve.length)
    edges = np.concatenate([turn, turn[1:] + curve.length])
    kept = []
    for number, ends in enumerate(pairwise(edges)):
        low, high = max(ends[0], first), min(ends[1], first + span)
        if high - low > _SHORT * curve.length:
            run = curve.runs[number % len(curve.runs)]
            kept.append(run.part(low - edges[number], min(high - edges[number], run.length)))
    return tuple(kept)
