"""The same by a pinion cutter (shaper), which also reaches into concave parts.

The pinion is conjugate to the basic rack: its teeth have involute flanks of base circle
cos(alpha)/kc, kc the curvature of its pitch circle, and rounded tips that go as deep as the rack's.
Its pitch circle rolls outside on the centrode. The cutter's outline is a polygon with its corners
on the true curves, so it is too thin by its own chord error, given by `cutter_error`.
"""

from __future__ import annotations

from typing import Any

import numpy as np
import shapely
from numpy.typing import NDArray

from witness.kinematics import Basic, Rolling
from witness.sweep import REACH, positions

Array = NDArray[np.floating[Any]]
Region = Any
"""A shapely geometry; the stubs cannot tell one from an array of them."""


def pinion_tooth(basic: Basic, curvature: float, flank_points: int, arc_points: int) -> Array:
    """One cutter tooth, (n, 2): radius in mm, and angle from the tooth's middle in rad."""
    m, alpha, pitch = basic.module, basic.alpha, 1 / curvature
    base = pitch * np.cos(alpha)
    rounding = basic.tip_radius * m
    centre_radius = pitch + (basic.dedendum - basic.tip_radius) * m
    # An involute is followed by the length of its tangent to the base circle: its offset by d is
    # the involute whose tangent is d longer or shorter, turned by d/base.
    centre_tangent = np.sqrt(centre_radius**2 - base**2)
    half = np.pi * m / 4 / pitch + _involute(alpha)

    def flank_angle(tangent: Array) -> Array:
        return half - _involute(np.arctan(tangent / base))

    centre_angle = half - rounding / base - _involute(np.arccos(base / centre_radius))
    if centre_angle < 0:
        raise ValueError("the tip arcs of the pinion overlap")
    tangent = np.linspace(1e-3 * base, centre_tangent + rounding, flank_points)
    flank = np.stack([np.hypot(base, tangent), flank_angle(tangent)], axis=-1)
    # radially inward below the base circle, where it is clear of the wheel
    foot = np.array([[pitch - (basic.addendum + 1.0) * m, flank[0, 1]]])
    centre = centre_radius * np.array([np.cos(centre_angle), np.sin(centre_angle)])
    joint = flank[-1, 0] * np.array([np.cos(flank[-1, 1]), np.sin(flank[-1, 1])])
    start = np.arctan2(*(joint - centre)[::-1])
    turn = np.linspace(start, centre_angle, arc_points)[1:]
    arc = centre + rounding * np.stack([np.cos(turn), np.sin(turn)], axis=-1)
    tip = np.stack([np.linalg.norm(arc, axis=-1), np.arctan2(arc[:, 1], arc[:, 0])], axis=-1)
    land = np.linspace(tip[-1, 1], 0, arc_points // 4)[1:]
    top = np.stack([np.full_like(land, pitch + basic.dedendum * m), land], axis=-1)
    right = np.concatenate([foot, flank, tip, top])
    return np.concatenate([right, right[-2::-1] * [1, -1]])


def cut_space(
    rolling: Rolling,
    wheel: int,
    k: int,
    basic: Basic,
    steps: int,
    *,
    curvature: float,
    flank_points: int = 400,
    arc_points: int = 200,
    reach: float = REACH,
) -> Region:
    """What the pinion's tooth takes out of the plane around the space that follows tooth k.

    It is followed over `reach`, in modules, on either side.
    """
    tooth = pinion_tooth(basic, curvature, flank_points, arc_points)
    middle = basic.space(wheel, k)
    s = positions(rolling.length, middle, reach * basic.module, steps)
    at = rolling.frames(wheel, s)
    angle = tooth[None, :, 1] + (middle - s[:, None]) * curvature
    radius = tooth[None, :, 0]
    along = radius * np.sin(angle)
    out = 1 / curvature - radius * np.cos(angle)
    rings = (
        at.point[:, None]
        + along[..., None] * at.tangent[:, None]
        + out[..., None] * at.normal[:, None]
    )
    return shapely.union_all(shapely.make_valid(shapely.polygons(rings)))


def cutter_error(basic: Basic, curvature: float, flank_points: int, arc_points: int) -> float:
    """Largest chord error of the cutter's outline between foot and tip, mm."""
    coarse = _plane(pinion_tooth(basic, curvature, flank_points, arc_points)[1:])
    fine = _plane(pinion_tooth(basic, curvature, 8 * flank_points, 8 * arc_points)[1:])
    line = shapely.linestrings(coarse[:-1])
    return float(shapely.distance(shapely.points(fine[:-1]), line).max())


def _plane(polar: Array) -> Array:
    return polar[:, :1] * np.stack([np.cos(polar[:, 1]), np.sin(polar[:, 1])], axis=-1)


def _involute(alpha: Array | float) -> Array:
    return np.asarray(np.tan(alpha) - alpha)
