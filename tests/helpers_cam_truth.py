"""What a cam says of itself beside the truth, by groups of numbers."""

from __future__ import annotations

import math
import random
from collections.abc import Iterator, Mapping
from dataclasses import replace
from functools import partial
from typing import Any

import mpmath
import numpy as np

from witness import cam_numbers as exact
from witness.cam_numbers import Touch
from witness.lifts import Piece, lift

mp: Any = mpmath.mp
Number = Any
Row = tuple[str, float, Number, Number]
"""Name of an estimate, what is told, the truth, and the size of such quantities."""

_NOTHING = 1e-20
"""Part of the largest slope that is rounding."""

_PER_PIECE = 3
_MOST = 80
"""Places at which a design is looked at."""


def extremes(pieces: list[Piece], order: int = 0) -> tuple[Number, Number]:
    """Smallest and largest lift, or derivative of an order up to 2."""
    found = []
    for one in pieces:
        found += [one.shape(one.low)[order], one.shape(one.high)[order]]
        places = [one.low + (one.high - one.low) * k / 17 for k in range(18)]
        slopes = [one.shape(t)[order + 1] for t in places]
        for a, b, low, high in zip(places, places[1:], slopes, slopes[1:], strict=False):
            if low * high < 0 and min(abs(low), abs(high)) > _NOTHING * max(map(abs, slopes)):
                root = _root(partial(_slope, one, order + 1), a, b)
                found.append(one.shape(root)[order])
    return min(found), max(found)


def _root(function: Any, low: Number, high: Number) -> Number:
    """Where a function changes its sign, by halving."""
    falls = function(low) > 0
    for _ in range(70):
        middle = (low + high) / 2
        low, high = (middle, high) if (function(middle) > 0) == falls else (low, middle)
    return low


def _slope(piece: Piece, order: int, theta: Number) -> Number:
    return piece.shape(theta)[order]


def touches(design: Mapping[str, Any], pieces: list[Piece]) -> tuple[list[Touch], list[Touch]]:
    """The followers of the motions of a design, and those of its walls."""
    given, cam = design["follower"], design["cam"]
    form = cam.get("form", "disc")
    swings, flat = given.get("motion") == "oscillating", given["type"] == "flat"
    radius = mp.mpf(given.get("roller_radius_mm") or given.get("dome_radius_mm") or 0)
    arm, pivot = (mp.mpf(given.get(key, 0)) for key in ("arm_mm", "pivot_distance_mm"))
    common: dict[str, Any] = {"flat": flat, "swings": swings, "radius": radius}
    common |= {"arm": arm, "pivot": pivot}
    if form == "translating":
        height = mp.mpf(given.get("pivot_height_mm", 0))
        own = Touch(
            **common,
            slide=1,
            tilt=mp.radians(mp.mpf(given.get("axis_deg", 0))),
            height=height,
            start=-mp.asin(height / arm) if swings else 0,
        )
        if cam.get("walls") != "both":
            return [own], [own]
        wide = radius + mp.mpf(cam.get("roller_clearance_mm", 0)) / 2
        return [own], [replace(own, radius=wide), replace(own, radius=-wide)]
    size = (
        mp.mpf(cam["prime_radius_mm"])
        if "prime_radius_mm" in cam
        else cam["base_radius_mm"] + radius
    )
    e, face = mp.mpf(given.get("offset_mm", 0)), mp.mpf(given.get("face_offset_mm", 0))
    if not swings:
        start = size if flat else mp.sqrt(size**2 - e**2)
    else:
        start = mp.asin((size + face) / pivot) if flat else _angle(pivot, arm, size)
    own = Touch(**common, start=start, offset=e, face=face)
    if form == "groove":
        half = mp.mpf(cam.get("roller_clearance_mm", 0)) / 2
        second = mp.mpf(given.get("roller2_radius_mm", radius))
        return [own], [replace(own, radius=radius + half), replace(own, radius=-(second + half))]
    if form == "conjugate":
        other = _second(design, own, extremes(pieces)[1])
        return [own, other], [own, other]
    return [own], [own]


def _angle(pivot: Number, arm: Number, size: Number) -> Number:
    return mp.acos((pivot**2 + arm**2 - size**2) / (2 * pivot * arm))


def _second(design: Mapping[str, Any], own: Touch, highest: Number) -> Touch:
    """The second roller of conjugate cams: across the axis at the highest lift."""
    given, cam = design["follower"], design["cam"]
    arm = mp.mpf(given.get("arm2_mm", given.get("arm_mm", 0)))
    if "prime_radius2_mm" in cam:
        size = mp.mpf(cam["prime_radius2_mm"])
        below = _angle(own.pivot, arm, size) if own.swings else mp.sqrt(size**2 - own.offset**2)
    else:
        preload = mp.mpf(given.get("preload_mm", 0))
        if own.swings:
            apart = mp.radians(mp.mpf(given["arms_angle_deg"])) + preload / arm
        else:
            apart = mp.mpf(given["roller_distance_mm"]) + preload
        below = apart - own.start - highest
    return replace(
        own,
        start=-highest - below,
        radius=mp.mpf(given.get("roller2_radius_mm", own.radius)),
        arm=arm,
    )


def places(pieces: list[Piece], seed: int) -> list[float]:
    """Cam angles inside pieces, away from knots, where derivatives belong to another piece."""
    draw = random.Random(seed)
    shares = [0.003, 0.49, 0.51, 0.997, *(draw.uniform(0.02, 0.98) for _ in range(_PER_PIECE))]
    found = [
        float(one.low + (one.high - one.low) * share)
        for one in pieces
        if one.high - one.low > 1e-9
        for share in shares
    ]
    return sorted(draw.sample(found, min(len(found), _MOST)))


def rows(result: Any, design: Mapping[str, Any], seed: int = 0) -> Iterator[Row]:
    """Yield everything that is told of a design beside the truth."""
    pieces = lift(design)
    motions, walls = touches(design, pieces)
    theta = places(pieces, seed)
    told, unit = result.motion_at(np.array(theta)), result.follower.lift_unit[1]
    driver = result.driver
    states = [exact.at(pieces, mp.mpf(t)) for t in theta]
    factor = mp.degrees(1) if unit == "deg" else mp.mpf(1)
    names = ("lift_{}", "velocity_{}_per_{}", "acceleration_{}_per_{}2", "jerk_{}_per_{}3")
    for order, name in enumerate(name.format(unit, driver.per) for name in names):
        size = max(abs(state[order]) for state in states) * factor
        for value, state in zip(told[name].tolist(), states, strict=True):
            yield name, value, state[order] * factor, size
        if order < 3:
            ends = [factor * end for end in extremes(pieces, order)]
            yield from zip([name] * 2, _ends(result, order), ends, [size] * 2, strict=True)
    for own, touch in zip(result.cam.motions, motions, strict=True):
        yield from _of_motion(own, touch, (theta, states), told)
        yield from _extremes_of(own, touch, pieces)
    for own, touch in zip(result.cam.walls, walls, strict=True):
        yield from _of_wall(own, touch, (theta, states))
        yield from trimming(result, own, touch, pieces)
        if not own.corners and not own.undercut:
            yield from _sizes(own, touch, pieces)
    yield from play(result, motions[0], walls, pieces)


def _ends(result: Any, order: int) -> list[float]:
    """Both ends of a derivative of the lift, as people are told them."""
    scale = result.follower.lift_unit[0]
    return [scale * end for end in result.program.range_of(order)]


def _extremes_of(own: Any, touch: Touch, pieces: list[Piece]) -> Iterator[Row]:
    """Pressure angles and curvatures that are told as the smallest and the largest."""

    def found(name: str, told: Any, function: Any, size: Number) -> Iterator[Row]:
        for end in (told.low, told.high):
            near = [one for one in pieces if one.low - 1e-9 < end.theta < one.high + 1e-9]
            true = [
                exact.best(partial(function, one), end.theta, (one.low, one.high)) for one in near
            ]
            yield name, end.value, min(true, key=lambda value: abs(value - end.value)), size

    for kind in ("rise", "return"):
        if (told := own.pressure(kind)) is not None:
            degrees = replace_values(told)
            yield from found(
                "pressure_angle_deg",
                degrees,
                lambda one, t: mp.degrees(touch.pressure(one.shape(t))),
                mp.mpf(90),
            )
    if touch.flat:
        told = own.face_radius
        size = max(abs(told.low.value), abs(told.high.value))
        yield from found("radius_mm", told, lambda one, t: touch.room(t, one.shape(t)), size)
    else:
        told = own.pitch_curvature()
        size = max(abs(told.low.value), abs(told.high.value))
        yield from found(
            "curvature_per_mm", told, lambda one, t: touch.curvature(t, one.shape(t)), size
        )


def replace_values(told: Any) -> Any:
    """A range of angles in degrees."""
    low, high = (replace(end, value=math.degrees(end.value)) for end in (told.low, told.high))
    return replace(told, low=low, high=high)


def _ending(one: Any) -> str:
    return f"_{one.key}" if one.key else ""


def _of_motion(own: Any, touch: Touch, at: Any, told: Any) -> Iterator[Row]:
    column = told[f"pressure_angle{_ending(own)}_deg"].tolist()
    for value, state in zip(column, at[1], strict=True):
        yield "pressure_angle_deg", value, mp.degrees(touch.pressure(state)), mp.mpf(90)
    if touch.flat:
        return
    bends = [touch.curvature(mp.mpf(t), state) for t, state in zip(*at, strict=True)]
    size = max(map(abs, bends))
    for value, bend in zip(told[f"rho_pitch{_ending(own)}_mm"].tolist(), bends, strict=True):
        yield "curvature_per_mm", 1.0 / value, bend, size


def _of_wall(own: Any, touch: Touch, at: Any) -> Iterator[Row]:
    theta = at[0]
    left, points, _ = own.places_at(np.array(theta))
    size = mp.mpf(float(np.abs(own.outline).max()))
    for place, point in zip(left.tolist(), points.tolist(), strict=True):
        state = at[1][theta.index(place)]
        true = touch.contact(mp.mpf(place), state)
        if own.clockwise:
            true = -mp.conj(true)
        yield "profile_mm", abs(mp.mpc(point) - true), mp.mpf(0), size
    if touch.flat:
        radii = own.radii(np.array(theta)).tolist()
        true = [touch.room(mp.mpf(t), state) for t, state in zip(*at, strict=True)]
        for value, one in zip(radii, true, strict=True):
            yield "radius_mm", value, one, max(map(abs, true))
        contacts = [touch.place(state) for state in at[1]]
        told = own.curve.contact(np.array(theta), 0).place.c[0]
        for value, one in zip(np.broadcast_to(told, len(theta)).tolist(), contacts, strict=True):
            yield "contact_mm", value, one, max(map(abs, contacts))


def _sizes(own: Any, touch: Touch, pieces: list[Piece]) -> Iterator[Row]:
    prefix, (length, area) = f"{own.key}_" if own.key else "", exact.sizes(touch, pieces)
    yield f"{prefix}perimeter_mm", own.size.perimeter, length, length
    if own.program.closed:
        yield f"{prefix}area_mm2", own.size.area, area, area


def judged(found: Iterator[Row]) -> dict[str, tuple[float, float]]:
    """The largest true error of each family, and its size."""
    made: dict[str, tuple[float, float]] = {}
    for name, value, true, size in found:
        off, before = float(abs(mp.mpf(value) - true)), made.get(name, (0.0, 0.0))
        made[name] = max(off, before[0]), max(float(size), before[1])
    return made


_KNOWN = 1e-11
"""Share of its size by which a number without an estimate may be off."""


def faults(
    told: Mapping[str, float],
    found: Mapping[str, tuple[float, float]],
    most: float = 100.0,
    known: float = _KNOWN,
) -> list[str]:
    """What is not honest: estimates below the true error, or above so many times it.

    Where both are rounding, below 1e-13 of the size, only the first counts. Numbers without an
    estimate may be off by a share of their size, `known`.
    """
    made = []
    for name, (true, size) in found.items():
        if name not in told:
            if true > known * size:
                made.append(f"{name}: off by {true:.3g}, of {size:.3g}")
            continue
        estimate = told[name]
        idle = max(estimate, true) <= 1e-13 * size
        if not (true <= estimate and (idle or estimate <= most * true)):
            made.append(f"{name}: {estimate:.3g} told, {true:.3g} true, of {size:.3g}")
    return made


_AT_KNOT = 1e-9
"""Angle, rad, below which a place is a knot, whose sides are two pieces."""


def inside(pieces: list[Piece], theta: float) -> bool:
    """Whether an angle lies within a piece."""
    return all(min(abs(theta - one.low), abs(theta - one.high)) > _AT_KNOT for one in pieces)


def _room(touch: Touch, piece: Piece, theta: Number) -> Number:
    return touch.room(theta, piece.shape(theta))


def trimming(result: Any, own: Any, touch: Touch, pieces: list[Piece]) -> Iterator[Row]:
    """Yield ends of undercut stretches, the lift that corners cost, and what sizes they leave."""
    driver, (scale, unit) = result.driver, result.follower.lift_unit
    for end in np.unique(own.undercut).tolist():
        if inside(pieces, end):
            piece = exact.piece_at(pieces, end)
            root = mp.findroot(partial(_room, touch, piece), mp.mpf(end))
            yield f"undercut_{driver.unit}", driver.scale * end, driver.scale * root, driver.whole
    told = [(corner.before, corner.after) for corner in own.corners]
    if not told or own.program.hard or not all(inside(pieces, t) for pair in told for t in pair):
        return
    true = [
        exact.crossing(touch, tuple(exact.piece_at(pieces, t) for t in pair), pair)  # type: ignore[arg-type]
        for pair in told
    ]
    size = own.program.range[1] - own.program.range[0]
    for loss, (_, _, point) in zip(own.lost, true, strict=True):
        piece = exact.piece_at(pieces, loss.theta)

        def missing(t: Number, piece: Piece = piece, point: Number = point) -> Number:
            return touch.away * (piece.shape(t)[0] - touch.rested(t, point))

        lost = exact.best(missing, loss.theta, (piece.low, piece.high))
        yield f"lost_lift_{unit}", scale * loss.value, scale * lost, scale * size
    if not touch.flat and own.program.closed:
        prefix = f"{own.key}_" if own.key else ""
        length, area = exact.trimmed_sizes(touch, pieces, [pair[:2] for pair in true])
        yield f"{prefix}perimeter_mm", own.size.perimeter, length, length
        yield f"{prefix}area_mm2", own.size.area, area, area


def play(result: Any, motion: Touch, walls: list[Touch], pieces: list[Piece]) -> Iterator[Row]:
    """Yield the lost motion between two walls without corners, and without a clearance 0."""
    cam, (scale, unit) = result.cam, result.follower.lift_unit
    lost = cam.lost_motion
    if lost is None or any(wall.corners for wall in cam.walls) or not inside(pieces, lost.theta):
        return
    rollers = getattr(cam, "rollers", (cam.motions[0].follower,) * 2)
    radii = [mp.mpf(roller.radius) for roller in rollers]
    insets = [walls[0].radius - radii[0], walls[1].radius + radii[1]]

    def between(t: Number) -> Number:
        return exact.lost_between(motion, pieces, t, insets)

    true = exact.best(between, lost.theta, (mp.mpf(-1), mp.mpf(8)))
    size = cam.motions[0].total_lift.value
    yield f"lost_motion_{unit}", scale * lost.value, scale * true, size
