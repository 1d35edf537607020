"""A wheel's curves as what vertices are spread over: over driver angles, with the law's knots."""

from __future__ import annotations

from dataclasses import dataclass

import numpy as np
from numpy.typing import NDArray

from gearcam.gears.flank import Curve, Rows, Toothing, trace
from gearcam.gears.track import Plane

Array = NDArray[np.float64]
Index = NDArray[np.int64]
Mask = NDArray[np.bool_]


@dataclass(frozen=True, eq=False, kw_only=True)
class WheelCurves:
    """The rows of a wheel, as `gearcam.numeric.sampling.Curves` over the driver angle, rad.

    Parameters
    ----------
    toothing : Toothing
        The wheel.
    rows : Rows
        Its curves, in order.
    """

    toothing: Toothing
    rows: Rows

    @property
    def start(self) -> Array:
        """Driver angle at which each row begins, (n,), rad."""
        return self.rows.start

    @property
    def end(self) -> Array:
        """Driver angle at which each row ends, (n,), rad."""
        return self.rows.end

    @property
    def corner(self) -> Mask:
        """Whether a corner precedes each row, (n,)."""
        return self.rows.corner

    @property
    def breaks(self) -> tuple[Index, Array]:
        """Rows and driver angles, rad, of the law's knots inside rows."""
        rows = self.rows
        low, high = np.minimum(rows.start, rows.end), np.maximum(rows.start, rows.end)
        phi = self.toothing.track.knots_near(0.5 * (low + high))
        curved = rows.kind != Curve.ROUND  # an arc knows nothing of the law
        row, knot = np.nonzero((phi >= low[:, None]) & (phi < high[:, None]) & curved[:, None])
        return row, phi[row, knot]

    def at(self, index: Index, parameter: Array) -> tuple[Plane, Plane]:
        """Return points, mm, and forward unit tangents of rows at driver angles, rad."""
        return trace(self.toothing, self.rows, index, parameter)
