"""Stiffness and backlash of a mesh over the driver's angle, as smooth functions.

Where pairs of teeth come and go, the sum of ``k*a^2`` over the pairs that touch, with levers a
about the driven shaft, jumps. Under load it does not: a pair whose flanks are still a gap apart
carries as soon as the driven wheel lags by its *touch angle* ``tau = gap/a``::

    Q(e) = sum of k*a^2*max(0, e - tau)

The stiffness at a nominal load is Q/e where Q is that load.
"""

from __future__ import annotations

from collections.abc import Sequence
from dataclasses import dataclass, field
from typing import Any, Final

import numpy as np
from numpy.typing import ArrayLike

from gearcam.base.display import ShortRepr
from gearcam.base.errors import InfeasibleError
from gearcam.gears.contact import FlankPairs
from gearcam.laws.ratio.span import angle_text
from gearcam.meshing.about_to_touch import about_to_touch
from gearcam.meshing.contact import contacts
from gearcam.meshing.edges import first_touch
from gearcam.numeric.arrays import Array, Ints

_NEAR: Final = 0.05
"""Largest gap at which edges are looked for at first, in pitches: doubled while the lag is more."""

_FAR: Final = 1.0
"""Gap, in pitches, beyond which they are not."""

_KILO: Final = 1e3
"""N mm in a N m, and micrometres in a mm."""


@dataclass(frozen=True, eq=False)
class Smooth(ShortRepr):
    """A function through samples, with two continuous derivatives.

    Parameters
    ----------
    places : (n,) array
        Places of the samples, rising; between them it is a cubic.
    samples : (n,) array
        Values.
    period : float or None
        After which it repeats; the last place is then less than a period from the first.
    positive : bool
        Whether it stays above 0, as its samples do: its logarithm is the cubic.
    """

    places: Array
    samples: Array
    period: float | None
    positive: bool = False
    _spline: Any = field(init=False, repr=False)

    def __post_init__(self) -> None:
        object.__setattr__(self, "_spline", self._through(slice(None)))

    def _through(self, kept: slice) -> Any:
        """Return the cubic through some of the samples."""
        samples = np.log(self.samples) if self.positive else self.samples
        return _cubic(self.places[kept], samples[kept], self.period)

    @property
    def knots(self) -> Array:
        """Places at which the third derivative jumps; of one period with its end."""
        return np.asarray(self._spline.x, dtype=float)

    def __call__(self, x: ArrayLike, order: int = 0) -> Array:
        """Return the values at `x`, or those of a derivative.

        Parameters
        ----------
        x : (n,) array
            Places.
        order : int
            Of the derivative, 0 for the function; of a positive one 1 at most.
        """
        x = np.asarray(x, dtype=float)
        return self._values(self._spline, x, order)

    def _values(self, spline: Any, x: Array, order: int = 0) -> Array:
        found = np.asarray(spline(x, order), dtype=float)
        if not self.positive:
            return found
        value = np.exp(np.asarray(spline(x), dtype=float))
        return value * found if order else value

    @property
    def error(self) -> float:
        """By how much the function through every second sample misses the others, at most.

        That through all has less: a sixteenth where the function is smooth, half at a corner.
        """
        coarse = self._through(slice(None, None, 2))
        inner = slice(1, None, 2) if self.period or len(self.places) % 2 else slice(1, -1, 2)
        found = self._values(coarse, self.places[inner])
        return float(np.abs(found - self.samples[inner]).max())


def _cubic(places: Array, samples: Array, period: float | None) -> Any:
    from scipy.interpolate import CubicSpline

    if period is None:
        return CubicSpline(places, samples)
    ends = np.append(places, places[0] + period), np.append(samples, samples[0])
    return CubicSpline(*ends, bc_type="periodic")


def secant_stiffness(
    step: Ints, lever: Array, gap: Array, stiffness: float, load: Array
) -> tuple[Array, Array]:
    """Return the stiffness of a mesh at loads, and the lags.

    Parameters
    ----------
    step : (k,) int array
        Phase of each pair of teeth, rising.
    lever, gap : (k,) arrays, mm
        Lever of its normal about the driven shaft, above 0, and its gap.
    stiffness : float, N/mm
        Of each pair along its normal.
    load : (n,) array, N mm
        Of the driven shaft at each phase, above 0.

    Returns
    -------
    stiffness, lag : (n,) arrays, N mm/rad and rad
        Load over lag, and the lag; 0 and infinite where no pair can touch.
    """
    count = len(load)
    column = np.arange(len(step)) - np.searchsorted(step, step)
    most = int(column.max(initial=0)) + 1
    touch, own = np.full((count, most), np.inf), np.zeros((count, most))
    touch[step, column] = gap / lever
    own[step, column] = stiffness * lever**2
    order = np.argsort(touch, axis=1)
    touch, own = np.take_along_axis(touch, order, 1), np.take_along_axis(own, order, 1)
    closed = np.cumsum(own * np.where(np.isfinite(touch), touch, 0.0), axis=1)
    with np.errstate(divide="ignore"):
        lags = (load[:, None] + closed) / np.cumsum(own, axis=1)
    # a pair more takes load only if the lag reaches its touch angle: the least lag is the true one
    lag = lags.min(axis=1)
    return load / lag, lag


def mesh_stiffness(
    pairs: FlankPairs, phi1: Array, stiffness: float, width: float, load: ArrayLike
) -> Array:
    """Return the stiffness of a side from that of a pair of teeth.

    Parameters
    ----------
    pairs : FlankPairs
        The side.
    phi1 : (n,) array, rad
        Phases.
    stiffness : float, N/(mm um)
        Of a pair of teeth along its normal, per width.
    width : float, mm
        Of the teeth.
    load : float or (n,) array, N m
        Nominal torque on the driven shaft, above 0.

    Returns
    -------
    (n,) array, N m/rad

    Raises
    ------
    InfeasibleError
        If no teeth touch at a phase.
    """
    torque = np.asarray(np.broadcast_to(load, phi1.shape), dtype=float) * _KILO
    found, own = contacts(pairs, phi1), stiffness * width * _KILO
    near, closed = 0.5 * _NEAR * pairs.pitch, np.inf
    made = np.zeros(phi1.shape)
    while closed > near and near < _FAR * pairs.pitch:
        near *= 2.0
        about = about_to_touch(pairs, phi1, found, near)
        step = np.concatenate([found.step, about.step])
        order = np.argsort(step, kind="stable")
        step = step[order]
        lever = np.concatenate([found.lever[1], about.lever])[order]
        gap = np.concatenate([np.zeros(len(found.step)), about.gap])[order]
        made, lag = secant_stiffness(step, lever, gap, own, torque)
        alone = np.flatnonzero(~np.isfinite(lag))
        if alone.size:
            where = angle_text(float(phi1[alone[0]]))
            raise InfeasibleError("no teeth touch: the mesh has no stiffness", where=where)
        closed = float((lag[step] * lever).max())
    return made / _KILO


def backlash_angle(sides: Sequence[FlankPairs], phi1: Array) -> Array:
    """Return the angle, rad, that the driven wheel turns between its flanks, (n,).

    Parameters
    ----------
    sides : (FlankPairs, FlankPairs)
        Coast and driving flanks.
    phi1 : (n,) array, rad
        Phases.
    """
    ahead, behind = (first_touch(one, phi1, contacts(one, phi1))[0] for one in sides)
    return np.maximum(ahead - behind, 0.0)
