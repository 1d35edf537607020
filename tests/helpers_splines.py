"""For tests of splines: the Bezier points of a B-spline's cubics."""

from __future__ import annotations

import numpy as np
from numpy.typing import NDArray

from gearcam.numeric.splines import Spline


def cubics(spline: Spline) -> NDArray[np.float64]:
    """Bezier points of the cubics of a spline with double knots, (k, 4, 2), mm."""
    steps = np.diff(spline.breaks)[:, None]
    first, second = spline.poles[1:-1:2], spline.poles[2::2]
    share = steps[:-1] / (steps[:-1] + steps[1:])
    joints = second[:-1] + share * (first[1:] - second[:-1])
    ends = np.vstack([spline.poles[:1], joints, spline.poles[-1:]])
    return np.stack([ends[:-1], first, second, ends[1:]], axis=1)
