"""What undercut costs and what lies between two walls, beside the truth."""

from __future__ import annotations

from collections.abc import Iterator
from functools import partial
from typing import Any

import mpmath
import numpy as np

from witness import cam_numbers as exact
from witness.cam_numbers import Touch
from witness.lifts import Piece

mp: Any = mpmath.mp
Number = Any
Row = tuple[str, Any, Number, Number]

_AT_KNOT = 1e-9
"""Angle, rad, below which a place is a knot, whose sides are two pieces."""


def inside(pieces: list[Piece], theta: float) -> bool:
    """Whether an angle lies within a piece."""
    return all(min(abs(theta - one.low), abs(theta - one.high)) > _AT_KNOT for one in pieces)


def _room(touch: Touch, piece: Piece, theta: Number) -> Number:
    return touch.room(theta, piece.shape(theta))


def trimming(result: Any, own: Any, touch: Touch, pieces: list[Piece]) -> Iterator[Row]:
    """Yield ends of undercut stretches, the lift that corners cost, and what sizes they leave."""
    driver, (scale, unit) = result.mechanism.driver, result.mechanism.outward
    for end in np.unique(own.undercut).tolist():
        if inside(pieces, end):
            piece = exact.piece_at(pieces, end)
            root = mp.findroot(partial(_room, touch, piece), mp.mpf(end))
            yield f"undercut_{driver.unit}", driver.scale * end, driver.scale * root, driver.turn
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
    cam, (scale, unit) = result.cam, result.mechanism.outward
    lost = cam.lost_motion
    if lost is None or any(wall.corners for wall in cam.walls) or not inside(pieces, lost.theta):
        return
    second = getattr(cam, "radius2", None)
    radii = [motion.radius, motion.radius if second is None else mp.mpf(second)]
    insets = [walls[0].radius - radii[0], walls[1].radius + radii[1]]

    def between(t: Number) -> Number:
        return exact.lost_between(motion, pieces, t, insets)

    true = exact.best(between, lost.theta, (mp.mpf(-1), mp.mpf(8)))
    size = cam.motions[0].total_lift.value
    yield f"lost_motion_{unit}", scale * lost.value, scale * true, size
