"""The followers of a design, at zero lift on their cams.

The *position* of a follower at zero lift, to which the lift is added, is:

==================== ==========================================================
translating round    height of the centre, ``s0 = sqrt(prime^2 - e^2)``
translating flat     height of the face, the base radius
oscillating round    ``Psi0 = arccos((d^2 + l^2 - prime^2)/(2*d*l))``
oscillating flat     ``Psi0 = arcsin((base + f)/d)``, the face f nearer the cam
over a plate         0 of a translating follower; ``Psi0 = -arcsin(p/l)``, p the pivot's height
==================== ==========================================================

Refused: followers that cannot touch the cam at zero lift.

Sources: 000 section 3.4.2 (3.14), (3.15); section 3.4.3 (3.28).
"""

from __future__ import annotations

import math
from collections.abc import Mapping
from typing import Any

import numpy as np

from gearcam.base.adjustments import Adjustment
from gearcam.base.errors import InfeasibleError, beyond_limit
from gearcam.base.numerals import formatted
from gearcam.cams.followers import Arm, FlatArm, FlatStem, Follower, Round, Stem
from gearcam.cams.spec import CamSpec, FollowerSpec, PlateFollower
from gearcam.numeric.arrays import Array


def make_follower(follower: FollowerSpec, cam: CamSpec) -> Follower:
    """Return a follower on a cam that turns.

    Parameters
    ----------
    follower : FollowerSpec
        The follower.
    cam : CamSpec
        The cam, with the prime or base radius that the follower needs.

    Returns
    -------
    Follower

    Raises
    ------
    InfeasibleError
        If the follower cannot touch the cam at zero lift.
    """
    if not follower.flat:
        return make_round_follower(follower, cam)
    base = _given(cam.base_radius, "a base radius")
    if not follower.oscillating:
        return FlatStem(start=base, offset=follower.offset)
    pivot, offset = _given(follower.pivot_distance, "a pivot distance"), follower.face_offset
    if not abs(base + offset) < pivot:
        what, parts = "the face cannot touch the base circle", "pivot and face offset"
        limits, straight = (-pivot - offset, pivot - offset), {"follower.face_offset_mm": 0.0}
        adjustment = Adjustment(far=straight)
        raise _out_of_reach(what, "cam.base_radius_mm", parts, base, limits, adjustment)
    return FlatArm(start=0.0, pivot=pivot, offset=offset).starting_at(base)


def make_round_follower(follower: FollowerSpec, cam: CamSpec) -> Round:
    """Return a round follower on a cam that turns (see `make_follower`).

    Parameters
    ----------
    follower : FollowerSpec
        The follower, not flat.
    cam : CamSpec
        The cam, with its prime or base radius.

    Returns
    -------
    Round

    Raises
    ------
    InfeasibleError
        If the follower cannot touch the cam at zero lift.
    """
    radius, size = follower.radius, cam.prime_radius
    if size is None:
        size = _given(cam.base_radius, "a prime or base radius") + radius
    if follower.oscillating:
        pivot = _given(follower.pivot_distance, "a pivot distance")
        return _arm(pivot, _given(follower.arm, "an arm"), radius, size)
    offset = follower.offset
    if not abs(offset) < size:
        what, key = "the follower's axis misses the prime circle", "follower.offset_mm"
        rule = "the offset, to either side, must be below the prime radius"
        near = math.copysign(size, offset)
        raise beyond_limit(what, key, abs(offset), size, rule, near=near, far=0.0)
    return Stem(start=0.0, radius=radius, offset=offset).starting_at(size)


def make_follower_over_plate(follower: PlateFollower) -> Round:
    """Return a round follower over a cam that slides.

    Parameters
    ----------
    follower : PlateFollower
        The follower.

    Returns
    -------
    Round

    Raises
    ------
    InfeasibleError
        If the arm does not reach the height of zero lift.
    """
    if not follower.oscillating:
        return Stem(start=0.0, radius=follower.radius, tilt=follower.axis)
    arm, height = _given(follower.arm, "an arm"), follower.pivot_height
    if not abs(height) < arm:
        what = f"the arm does not reach {'down' if height > 0.0 else 'up'} to zero lift"
        key, limit = "follower.pivot_height_mm", math.copysign(arm, height)
        rule = "the pivot height must be below the arm length, the limit"
        raise beyond_limit(what, key, height, limit, rule, far=0.0)
    pivot = complex(-_given(follower.pivot_distance, "a pivot distance"), height)
    start = -math.asin(height / arm)
    return Arm(start=start, radius=follower.radius, arm=arm, pivot=pivot, hand=-1)


def followers_of(spec: FollowerSpec, sizes: Mapping[str, Array]) -> tuple[Follower, Array]:
    """Return the followers of candidates as one with arrays, and how far they are out of reach.

    Parameters
    ----------
    spec : FollowerSpec
        The kind of follower, and the offset of its face.
    sizes : mapping of str to (n,) array, mm
        ``radius``, the prime radius or the base radius of a flat follower, ``offset``, ``pivot``,
        ``arm``, ``roller``.

    Returns
    -------
    follower : Follower
        Its sizes are (n, 1) arrays.
    reach : (n,) array
        An excess: above 0 where it cannot touch the cam at zero lift.
    """
    column: dict[str, Any] = {name: np.asarray(value)[:, None] for name, value in sizes.items()}
    radius, roller = column["radius"], column["roller"]
    if spec.flat and not spec.oscillating:
        return FlatStem(start=radius), np.full(len(radius), -1.0)
    if spec.flat:
        sine = (radius + spec.face_offset) / column["pivot"]
        start = np.arcsin(np.clip(sine, -1.0, 1.0))
        face = FlatArm(start=start, pivot=column["pivot"], offset=spec.face_offset)
        return face, (np.abs(sine) - 1.0)[:, 0]
    inside = roller / radius - 1.0
    if not spec.oscillating:
        room = (radius - column["offset"]) * (radius + column["offset"])
        start = np.sqrt(np.maximum(room, 0.0))
        stem = Stem(start=start, radius=roller, offset=column["offset"])
        return stem, np.maximum(np.abs(column["offset"]) / radius - 1.0, inside)[:, 0]
    pivot, arm = column["pivot"], column["arm"]
    cosine = (pivot**2 + arm**2 - radius**2) / (2.0 * pivot * arm)
    start = np.arccos(np.clip(cosine, -1.0, 1.0))
    swing = Arm(start=start, radius=roller, arm=arm, pivot=pivot + 0j)
    return swing, np.maximum(np.abs(cosine) - 1.0, inside)[:, 0]


def _arm(pivot: float, arm: float, radius: float, size: float) -> Arm:
    follower = Arm(start=0.0, radius=radius, arm=arm, pivot=complex(pivot))
    limits = follower.nearest, follower.farthest
    if not limits[0] < size < limits[1]:
        what, parts = "the arm cannot reach the prime circle", "arm and pivot"
        key, least = "follower.pivot_distance_mm", abs(arm - size)
        near = least if pivot <= least else arm + size
        adjustment = Adjustment(near={key: near}, far={key: max(arm, size)})
        raise _out_of_reach(what, "cam.prime_radius_mm", parts, size, limits, adjustment)
    return follower.starting_at(size)


def _out_of_reach(
    what: str,
    key: str,
    parts: str,
    size: float,
    limits: tuple[float, float],
    adjustment: Adjustment,
) -> InfeasibleError:
    """Return the error for a size that is not between the limits that the parts allow."""
    (low, high), least = limits, max(limits[0], 0.0)
    rule = f"{parts} allow sizes between {formatted(least)} and {formatted(high)} mm"
    adjustments = (adjustment,)
    if high > 0.0:  # from the limit that the size exceeds to the middle of the allowed range
        near = least if size <= least else high
        adjustments = (Adjustment(near={key: near}, far={key: 0.5 * (least + high)}), adjustment)
    return beyond_limit(
        what, key, size, low if size <= low else high, rule, adjustments=adjustments
    )


def _given(value: float | None, what: str) -> float:
    if value is None:
        raise ValueError(f"this follower needs {what}")
    return value
