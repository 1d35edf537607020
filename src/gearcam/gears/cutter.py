"""The cutter of a wheel: a rack, or for a concave centrode a pinion conjugate to that rack.

A straight rack cannot cut a concave centrode: it would remove parts of the flanks. A pinion cutter
(shaper) of pitch curvature ``kc > max(-kappa)`` can, and it cuts the same flanks since it is
conjugate to the rack. The rack is the pinion with ``kc = 0``; every formula here has that limit.
"""

from __future__ import annotations

import math
from collections.abc import Sequence
from dataclasses import dataclass, replace
from functools import cached_property

import numpy as np

from gearcam.base.display import ShortRepr
from gearcam.base.errors import beyond_limit
from gearcam.gears.spec import BasicRack
from gearcam.numeric.arrays import Array
from gearcam.numeric.roots import largest_fitting

_CONCAVE_MARGIN = 1.15
"""kc over the largest concave curvature: leaves clearance, with a cutter as large as possible."""

_FLAT = 1e-9
"""Curvature times module below which a centrode counts as straight, not concave (rounding)."""

_HALVINGS = 60
"""Relative tolerance, at rounding, in the search for the largest size that fits."""

_LAND = 1e-9
"""Share of half a space by which a cutter's tooth may miss its land: rounding of the search."""


@dataclass(frozen=True, kw_only=True)
class Cutter(ShortRepr):
    """Dimensions of a cutter, mm (see `choose_cutter`).

    Parameters
    ----------
    alpha : float, rad
        Pressure angle.
    addendum, dedendum, tip_radius : float, mm
        Height of the wheel's teeth above the pitch curve, depth below it, and tip radius of the
        cutter.
    kc : float, 1/mm
        Curvature of the cutter's pitch circle; 0 for the rack.
    half_space : float, mm
        Half the width of a space on the pitch curve: pi*m/4, less by the profile shift, more by
        the backlash.
    pitch : float, mm
        pi*m.
    """

    alpha: float
    addendum: float
    dedendum: float
    tip_radius: float
    kc: float
    half_space: float
    pitch: float

    @property
    def kind(self) -> str:
        """``rack`` or ``pinion``."""
        return "pinion" if self.kc > 0.0 else "rack"

    @property
    def teeth(self) -> float:
        """Number of teeth of the pinion; infinite for the rack."""
        return 2.0 * math.pi / (self.kc * self.pitch) if self.kc > 0.0 else math.inf

    @property
    def depth(self) -> float:
        """Distance of the tip arc's centre below the pitch curve, mm."""
        return self.dedendum - self.tip_radius

    @cached_property
    def reach(self) -> float:
        """Roll from the pitch point of a flank to its form point, where its fillet begins, mm.

        Rack: ``(d/sin(alpha) + rho)/cos(alpha)``. Pinion: ``(t + rho)/cos(alpha)`` with
        ``t = R*sin(alphaR) - sin(alpha)/kc``, ``R = 1/kc + d``, ``cos(alphaR) =
        cos(alpha)/(kc*R)``; written as ``t = d*(2 + kc*d)/(root + sin(alpha))`` with ``root^2 =
        sin(alpha)^2 + kc*d*(2 + kc*d)``, which has the rack as its limit without cancellation.
        """
        sine, d, kc = math.sin(self.alpha), self.depth, self.kc
        root = math.sqrt(sine * sine + kc * d * (2.0 + kc * d))
        t = d * (2.0 + kc * d) / (root + sine)
        return (t + self.tip_radius) / math.cos(self.alpha)

    @cached_property
    def offset(self) -> float:
        """Distance of the tip arc's centre from the flank along the pitch curve, mm.

        Rack: ``rho/cos(alpha) + d*tan(alpha)``. Pinion: ``(inv(alphaR) - inv(alpha))/kc`` in place
        of the second term.
        """
        d, kc = self.depth, self.kc
        edge = self.tip_radius / math.cos(self.alpha)
        if kc * self.half_space < _FLAT:
            return edge + d * math.tan(self.alpha)
        angle = math.acos(math.cos(self.alpha) / (1.0 + kc * d))
        rise = (math.tan(angle) - angle) - (math.tan(self.alpha) - self.alpha)
        return edge + rise / kc

    def gap(self, x: Array, depth: Array, middle: Array) -> Array:
        """Return distances of points from a tooth of the cutter, not positive inside it.

        Parameters
        ----------
        x, depth : (n,) arrays, mm
            Coordinates from the pitch point: along the common tangent, and below it.
        middle : (n,) array, mm
            Arc length from the pitch point to the middle of the tooth.

        Returns
        -------
        (n,) array, mm
            Infinite above the wheel's addendum, and within a pinion's base circle.

        Notes
        -----
        Involutes of one base circle are parallel curves: a point offset from a flank by an arc v
        of the pitch circle is ``v*cos(alpha)`` away, as with the rack.
        """
        kc, slope, tip = self.kc, math.tan(self.alpha), self.offset - self.half_space
        # components from the centre of the tip arc
        if kc * self.half_space < _FLAT:
            down, aside, lean = depth, np.abs(x - middle), self.alpha
            narrower = down * slope
            across, along = aside + tip, down - self.depth
        else:
            radius = np.hypot(x, 1.0 / kc + depth)
            down = radius - 1.0 / kc
            aside = np.abs(np.arctan2(x, 1.0 / kc + depth) / kc - middle)
            over = kc * radius / math.cos(self.alpha)
            roll = np.sqrt(np.maximum(over * over - 1.0, 0.0))
            rise = roll - np.arctan(roll) - (slope - self.alpha)
            narrower = np.where(over < 1.0, math.inf, rise / kc)
            center, turned = 1.0 / kc + self.depth, kc * (aside + tip)
            across, along = radius * np.sin(turned), radius * np.cos(turned) - center
            lean = math.acos(math.cos(self.alpha) / (kc * center))
        flank = (aside - self.half_space + narrower) * math.cos(self.alpha)
        arc = (across > 0.0) & (along * math.cos(lean) > across * math.sin(lean))
        round_tip = np.hypot(across, along) - self.tip_radius
        gap = np.where(arc, round_tip, np.maximum(flank, down - self.dedendum))
        return np.where(down < -self.addendum, math.inf, gap)

    @property
    def fits(self) -> bool:
        """Whether its teeth reach the depth of the dedendum before they become pointed."""
        return self.offset <= self.half_space * (1.0 + _LAND)

    @cached_property
    def least_concave_radius(self) -> float:
        """Smallest concave radius, mm, for which a sharp-cornered pinion's teeth keep a land."""
        most = largest_fitting(
            lambda kc: replace(self, kc=kc).offset <= self.half_space, self.kc, _HALVINGS
        )
        return _CONCAVE_MARGIN / most if most > 0.0 else math.inf


def choose_cutter(
    rack: BasicRack,
    module: float,
    concave_curvature: float,
    *,
    pinions: Sequence[float] = (),
    shift: float = 0.0,
    backlash: float = 0.0,
    clearance: float = 0.0,
) -> Cutter:
    """Choose the cutter of a wheel.

    Parameters
    ----------
    rack : BasicRack
        Heights in modules.
    module : float, mm
        Module.
    concave_curvature : float, 1/mm
        Largest ``-kappa`` of the centrode; not positive for a convex one.
    pinions : sequence of float, 1/mm
        Curvatures of candidate pinions for a concave centrode: the first whose teeth fit is taken,
        or else the last. By default 1.15 times the concave curvature.
    shift : float
        Profile shift of this wheel, in modules.
    backlash : float, mm
        Along the pitch curve; each wheel gives half of it.
    clearance : float, mm
        Material removed from the toothed edge along its normal, as by a cutter larger by that.

    Returns
    -------
    Cutter
        The rack for a convex centrode, else a pinion; see `Cutter.fits`.
    """
    straight = Cutter(
        alpha=rack.pressure_angle,
        addendum=(rack.addendum + shift) * module,
        dedendum=(rack.dedendum - shift) * module,
        tip_radius=rack.tip_radius * module,
        kc=0.0,
        half_space=(0.25 * math.pi - shift * math.tan(rack.pressure_angle)) * module
        + 0.25 * backlash,
        pitch=math.pi * module,
    )
    if not concave_curvature * module > _FLAT:
        return widened(straight, clearance)
    cutters = [
        _blunt(replace(straight, kc=kc)) for kc in pinions or (_CONCAVE_MARGIN * concave_curvature,)
    ]
    return widened(next((cutter for cutter in cutters if cutter.fits), cutters[-1]), clearance)


def ring_pinions(
    concave_curvature: float, mate_curvature: float, module: float, teeth: float | None
) -> tuple[float, ...]:
    """Return the curvatures of pinion cutters for a ring, the preferred one first.

    Parameters
    ----------
    concave_curvature : float, 1/mm
        Largest ``-kappa`` of the ring's centrode.
    mate_curvature : float, 1/mm
        Least curvature of the mate's centrode.
    module : float, mm
        Module.
    teeth : float or None
        Number of teeth of the cutter, if given.

    Returns
    -------
    tuple of float, 1/mm
        1.15 times the ring's, but at least the mate's: then the mate's tips clear the fillets, and
        the cutter can be withdrawn without cutting the ring's tips. Second, in case its teeth are
        pointed, 1.15 times the ring's.

    Raises
    ------
    InfeasibleError
        If a cutter with the given number of teeth does not fit into the ring.
    """
    if teeth is None:
        least = _CONCAVE_MARGIN * concave_curvature
        return max(least, mate_curvature), least
    most = 2.0 / (module * concave_curvature)
    if not teeth < most:
        what = "the pinion cutter is too large for the ring where the ring is narrowest"
        where = "ring.cutter_teeth"
        note = "the limit is the number of teeth that just fits"
        raise beyond_limit(
            what, where, teeth, most, note, near=most / _CONCAVE_MARGIN, more_teeth=teeth / most
        )
    return (2.0 / (module * teeth),)


def widened(cutter: Cutter, by: float) -> Cutter:
    """Return a cutter enlarged all around: it cuts a parallel of the outline that `cutter` cuts.

    Parameters
    ----------
    cutter : Cutter
        The cutter.
    by : float, mm
        Enlargement along the normal of its edge. The flanks move by ``by/cos(alpha)`` along the
        pitch line; the tip arcs keep their centres.

    Returns
    -------
    Cutter
    """
    return replace(
        cutter,
        addendum=cutter.addendum - by,
        dedendum=cutter.dedendum + by,
        tip_radius=cutter.tip_radius + by,
        half_space=cutter.half_space + by / math.cos(cutter.alpha),
    )


def _blunt(cutter: Cutter) -> Cutter:
    """Reduce the tip radius, to 0 at least, until the pinion's narrower tooth has a land."""
    if cutter.offset <= cutter.half_space:
        return cutter
    most = largest_fitting(
        lambda radius: replace(cutter, tip_radius=radius).offset <= cutter.half_space,
        cutter.tip_radius,
        _HALVINGS,
    )
    return replace(cutter, tip_radius=most)
