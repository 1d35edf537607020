"""Tables of a gear pair over driver angles, as columns for files and data.

`gearcam.kinds.gear_pair.result` documents the columns.
"""

from __future__ import annotations

from typing import Final

import numpy as np

from gearcam.base.quantities import RPM
from gearcam.gears.contact import COAST, FlankPairs
from gearcam.gears.pair import GearPair
from gearcam.meshing.contact import Contacts, contact_columns
from gearcam.numeric.arrays import Array
from gearcam.numeric.columns import Columns

_TIMED_ANGLE: Final = ("speed_rpm", "acceleration_rad_s2", "jerk_rad_s3")
_TIMED_TRAVEL: Final = ("velocity_mm_s", "acceleration_mm_s2", "jerk_mm_s3")

POINTS: Final = ("x1_mm", "y1_mm", "x2_mm", "y2_mm")
"""Columns of points, which are not in the file of the centrodes."""


def centrode_columns(pair: GearPair, phi1: Array) -> Columns:
    """Return both centrodes of a `pair` at driver angles `phi1`, rad."""
    phi2, ratio = pair.law.derivatives(phi1, 1)
    one, two = (track.frames(phi1) for track in pair.rolling.tracks)
    driven = {
        "phi2_deg": np.degrees(phi2 - phi2[0]),
        "ratio": ratio,
        "r1_mm": np.abs(one.p),
        "r2_mm": np.abs(two.p),
    }
    if pair.on_rack:
        driven = {"travel_mm": two.p.imag, "r1_mm": np.abs(one.p)}
    return Columns(
        {
            "phi1_deg": np.degrees(phi1),
            **driven,
            "s_mm": one.s - one.s[0],
            "rho1_mm": _radii(one.kappa),
            "rho2_mm": _radii(two.kappa),
            **dict(zip(POINTS, (one.p.real, one.p.imag, two.p.real, two.p.imag), strict=True)),
        }
    )


def _radii(curvature: Array) -> Array:
    """Return radii of curvature; +infinity where straight."""
    with np.errstate(divide="ignore"):
        return np.where(curvature == 0.0, np.inf, 1.0 / curvature)


def motion_columns(pair: GearPair, phi1: Array, speed: float | None = None) -> Columns:
    """Return the motion of the driven element of a `pair` at driver angles.

    Parameters
    ----------
    pair : GearPair
        The pair.
    phi1 : (n,) array, rad
        Driver angles.
    speed : float or None, rad/s
        Speed of the driver; with one there are columns of the motion in time.
    """
    place, *slopes = pair.law.derivatives(phi1, 3)
    names = ("ratio", "acceleration_per_rad", "jerk_per_rad2")
    first = {"phi2_deg": np.degrees(place)}
    if pair.on_rack:
        names = ("velocity_mm_per_rad", "acceleration_mm_per_rad2", "jerk_mm_per_rad3")
        size = pair.center_distance
        first, slopes = {"travel_mm": size * place}, [size * slope for slope in slopes]
    columns = {"phi1_deg": np.degrees(phi1), **first, **dict(zip(names, slopes, strict=True))}
    if speed is not None:
        rates = [slope * speed**order for order, slope in enumerate(slopes, start=1)]
        columns |= zip(_TIMED_TRAVEL if pair.on_rack else _TIMED_ANGLE, rates, strict=True)
        if not pair.on_rack:
            columns["speed_rpm"] = columns["speed_rpm"] / RPM.factor
    return Columns(columns)


def contact_rows(pair: GearPair, pairs: FlankPairs, phi1: Array, points: Contacts) -> Columns:
    """Return the table of contact `points` of flanks `pairs` of a `pair` at `phi1`, rad."""
    guide = pair.rolling.guide
    moved = np.degrees(guide.nominal(phi1)) if guide.turns else guide.nominal(phi1)
    return Columns(
        {
            "phi1_deg": np.degrees(phi1)[points.step],
            "phi2_deg" if guide.turns else "travel_mm": moved[points.step],
            "tooth1": pairs.wheels[0].number(points.pair),
            "tooth2": pairs.wheels[1].number(points.pair),
            "side": np.full(points.pair.shape, pairs.side),
            "pairs": np.bincount(points.step, minlength=len(phi1))[points.step],
            "x_mm": points.point.real,
            "y_mm": points.point.imag,
            "force_x": points.force.real,
            "force_y": points.force.imag,
            **contact_columns(points, pairs.distance),
            f"lag_{guide.unit}": -points.lead,
        }
    )


def contact_ratio_columns(sides: tuple[FlankPairs, ...]) -> Columns:
    """Return the contact ratio of every pair of flanks of both `sides`, driving side first."""
    blocks = []
    for pairs in sorted(sides, key=lambda pairs: pairs.side == COAST):
        start, end = pairs.arcs.start, pairs.arcs.end
        touching = start < end
        blocks.append(
            {
                "tooth1": pairs.wheels[0].number(pairs.numbers),
                "tooth2": pairs.wheels[1].number(pairs.numbers),
                "side": np.full(pairs.numbers.shape, pairs.side),
                "contact_ratio": pairs.arcs.ratios,
                "from_deg": np.degrees(np.where(touching, start, np.nan)),
                "to_deg": np.degrees(np.where(touching, end, np.nan)),
            }
        )
    return Columns({name: np.concatenate([one[name] for one in blocks]) for name in blocks[0]})
