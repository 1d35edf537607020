"""Pairs on their shafts that are made wrong on purpose."""

from __future__ import annotations

from dataclasses import replace

import numpy as np

from gearcam.gears.contact import DRIVE
from gearcam.gears.track import Wheel
from gearcam.meshing.study import Setup


def moved(setup: Setup, tooth: int, by: float, wheel: Wheel = 1) -> Setup:
    """The pair with a tooth of a closed wheel moved along its pitch curve, outline and flanks."""
    turning, toothing = setup.turning, setup.pairs[DRIVE].toothings[wheel - 1]
    halves = turning.driver if wheel == 1 else turning.driven
    place = toothing.track.angle(toothing.tooth_places[tooth - 1 : tooth])
    angle = by / float(np.abs(toothing.frames(place).p[0]))
    points = halves.points.copy()
    for half in np.flatnonzero(halves.teeth == tooth):
        own = slice(halves.starts[half], halves.starts[half + 1])
        points[own] *= np.exp(-1j * angle if toothing.track.clockwise else 1j * angle)
    name, wheels = "driver" if wheel == 1 else "driven", [*setup.pairs[DRIVE].flanks]
    sf = wheels[wheel - 1].sf.copy()
    sf[[tooth - 1, toothing.teeth + tooth - 1]] += by
    wheels[wheel - 1] = replace(wheels[wheel - 1], sf=sf)
    pairs = {side: replace(found, flanks=tuple(wheels)) for side, found in setup.pairs.items()}
    made = replace(turning, **{name: replace(halves, points=points)})
    return replace(setup, pairs=pairs, turning=made)
