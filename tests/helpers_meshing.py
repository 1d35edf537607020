"""Pairs on their shafts that are made wrong on purpose."""

from __future__ import annotations

from dataclasses import replace

import numpy as np

from gearcam.gears.contact import DRIVE
from gearcam.meshing.study import Setup


def moved(setup: Setup, tooth: int, by: float) -> Setup:
    """The pair with a tooth of the driver moved along the pitch curve, outline and flanks."""
    halves, count = setup.turning.driver, setup.turning.driver.count
    angle = by / float(np.abs(setup.turning.rolling.tracks[0].frames(np.array([0.0])).p[0]))
    points = halves.points.copy()
    for half in (2 * tooth - 2, (2 * tooth - 3) % count):
        points[halves.starts[half] : halves.starts[half + 1]] *= np.exp(1j * angle)
    driver = replace(halves, points=points)
    sf = setup.pairs[DRIVE].flanks[0].sf.copy()
    sf[[tooth - 1, count // 2 + tooth - 1]] += by
    pairs = {
        side: replace(found, flanks=(replace(found.flanks[0], sf=sf), found.flanks[1]))
        for side, found in setup.pairs.items()
    }
    turning = replace(setup.turning, driver=driver)
    return replace(setup, pairs=pairs, turning=turning)
