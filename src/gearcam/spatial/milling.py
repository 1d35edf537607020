"""Paths of an end mill that cuts a cylinder cam on a milling machine with a rotary axis.

Machine: the axis of the cam lies along X and turns about it by A; the axis of the tool is vertical,
along Z, and so parallel to that of the roller. Zero is on the axis of the cam, X at its lower face.
X grows towards the upper face, Z away from the axis; Y completes a right-handed frame. A is the
azimuth of the tool on the cam, by the right hand about X, so that the tool runs round the cam as A
grows and the cam itself turns the other way, as ISO 841 has it. With the cam angle theta, A is
-theta, and theta of a cam that turns clockwise. Z is the height of the tool's end.

A tool as wide as the groove is the roller: its axis follows that of the roller, the walls are true.

A smaller tool stays inside the roller. Both are cylinders, or cones of the same angle, about
parallel axes; their radii differ by the *spare* d everywhere. Moved by d from the axis of the
roller in the direction m of a contact, the tool touches the roller from inside along the line of
this direction, and it reaches nothing that the roller does not reach: it never cuts a wall. This
needs a move across the axis of the cam, the axis Y. A tool whose axis meets that of the cam could
not do it: at a contact its axis is perpendicular to the normal of the wall only at the azimuth of
the roller itself.

The direction m depends on the place x along the roller, by the angle eta(x) about its axis, so the
tool touches the wall at one x in each pose, that of its own direction eta_0. Elsewhere it leaves a
*rest*: the point of the wall is at R*m(x) from the axis of the roller, the axis of the tool at
d*m_0, so that the distance from the tool, r = R - d, is in the same pose ::

    sqrt(r^2 + 2*R*d*(1 - cos(eta - eta_0))) - r

and other poses of the tool can only come nearer. The groove is cut in several passes in depth, each
of which takes the middle of eta at its upper and lower end: the rest falls with the square of the
number of passes. As many are taken as keep it within the tolerance.

Between two points a controller moves X, Y, Z and A in proportion. The turn is then exact, and the
tool off its true place by what a straight line is off the functions X(A) and Y(A): steps are halved
until this is within the tolerance. The ends of the moves are the rounded numbers of a program. What
is left on a wall and cut into it follows from both, with p the place of the tool's axis beside that
of the roller: the tool is off the point of the wall in the direction m by ::

    sqrt(R^2 - 2*R*(p . m) + p^2) - r

LinuxCNC moves no slower than 0.1 mm/min along X, Y and Z, A in its time. Where these move less in
a step, at the ends of dwells, they are kept until it is more.

Refused: tools wider than the groove, and cones of another angle. Source: derived here. Depends on
cam and tool; numpy only.
"""

from __future__ import annotations

import math
from collections.abc import Sequence
from dataclasses import dataclass
from functools import cached_property
from itertools import pairwise
from typing import Final

import numpy as np

from gearcam.base.display import ShortRepr
from gearcam.base.errors import ABOVE, InfeasibleError, beyond_limit
from gearcam.numeric.arrays import Array, Ints, Mask, distinct, divided
from gearcam.spatial.cam import SpatialCam
from gearcam.spatial.tool import MillSpec

_WIDEST_STEP: Final = math.radians(15.0)
"""Largest turn in one move, rad."""

_ALONG: Final = np.arange(9) / 8.0
"""Places in a step at which its straight line is compared with the true path."""

_SEEN: Final = 0.98
"""Least share of the largest error that one of them shows; of a parabola or a cubic 0.988."""

DECIMALS: Final = (4, 4, 4, 5)
"""Decimals of X, Y and Z, mm, and of A, deg, in a program."""

_SLOWEST: Final = 0.11
"""Least speed of X, Y and Z together, mm/min, in a move that also turns."""

_OVERLAP: Final = 0.8
"""Distance of paths side by side over the diameter of the tool's end."""

_MOST_TURNS: Final = 1000
"""Largest number of turns round the cam."""

_SAME: Final = 1e-9
"""Difference of radii, mm, below which a tool is as wide as the groove."""

PLUNGE: Final = 1.0 / 3.0
"""Feed of a move into the metal over that along the path."""

_MINUTE: Final = 60.0

Lane = tuple[tuple[int, float], ...]
"""Sides and shares: where across the groove the tool runs, 1 at a wall; share 0: in the middle."""


@dataclass(frozen=True, eq=False, kw_only=True)
class RotaryPath(ShortRepr):
    """The path of a tool on a machine with a rotary axis.

    Parameters
    ----------
    moves : (n, 4) array, mm and rad
        X, Y, Z and A at the end of each move, rounded as in a program; A never falls.
    turn : (n,) array of int
        Number of the turn round the cam, from 1; 0 of moves between turns.
    rapid : (n,) array of bool
        Moves in the air. The first one starts above the first point.
    layers : int
        Number of passes in depth.
    tool : (float, float), mm
        Radius of the tool at its end, and where it is at the outside of the cam.
    radius : float, mm
        Radius of the cam, at which feeds are measured.
    rest, chord : float, mm
        What a tool smaller than the roller leaves on a wall where it is on its path, and largest
        distance of the moves from the path.
    left, cut : float, mm
        The whole: most that is left on a wall, and most that is cut into one.
    """

    moves: Array
    turn: Ints
    rapid: Mask
    layers: int
    tool: tuple[float, float]
    radius: float
    rest: float
    chord: float
    left: float
    cut: float

    @property
    def crosswise(self) -> bool:
        """Whether the machine needs the axis Y."""
        return bool(np.abs(self.moves[:, 1]).max() > 0.0)

    @property
    def turns(self) -> int:
        """Number of turns round the cam."""
        return int(self.turn.max())

    @cached_property
    def lengths(self) -> Array:
        """Lengths of the moves at the outside of the cam, (n,), mm; 0 of the first one."""
        steps = np.diff(self.moves, axis=0, prepend=self.moves[:1])
        return np.linalg.norm(steps * [1.0, 1.0, 1.0, self.radius], axis=1)

    def times(self, tool: MillSpec) -> Array:
        """Return the durations of the moves, (n,), s; 0 of rapid moves.

        Parameters
        ----------
        tool : MillSpec
            Its feed is along the path, at the outside of the cam; into the metal it is `PLUNGE` of
            that.
        """
        plunging = self.moves[:, 2] < np.roll(self.moves[:, 2], 1)
        speed = tool.feed * np.where(plunging, PLUNGE, 1.0)
        return np.where(self.rapid, 0.0, self.lengths / speed)


def rotary_path(cam: SpatialCam, tool: MillSpec, tolerance: float) -> RotaryPath:
    """Return the path of a tool that cuts the walls of a cam.

    Parameters
    ----------
    cam : SpatialCam
        The cam; its walls must not be undercut.
    tool : MillSpec
        The end mill.
    tolerance : float, mm
        Bound of what the moves are off the path, and of what a smaller tool leaves beside that.

    Returns
    -------
    RotaryPath

    Raises
    ------
    InfeasibleError
        If the tool is wider than the groove, or has another angle than the roller.
    """
    mill = _Mill(cam=cam, spare=_spare(cam, tool, tolerance), feed=_MINUTE * tool.feed)
    layers = mill.layers(tool.depth or 0.5 * (tool.diameter or 2.0 * mill.outer), tolerance)
    parts = [_part(mill, lanes, layers, tolerance) for lanes in mill.groups]
    high = round(cam.outer_radius + tool.clearance_height, DECIMALS[2])
    moves, turn, rapid, begun, turned = [], [], [], 0, 0.0
    for points, numbers, _ in parts:
        shifted = _ahead(points, turned)
        above, after = shifted[:1].copy(), shifted[-1:].copy()
        above[:, 2] = after[:, 2] = high
        moves += [above, shifted, after]
        turn += [[0], np.where(numbers > 0, numbers + begun, 0), [0]]
        rapid += [[True], np.zeros(len(points), dtype=bool), [True]]
        begun, turned = begun + int(numbers.max()), float(after[0, 3])
    joined = np.concatenate(moves)
    joined[:, 3] = np.maximum.accumulate(joined[:, 3])  # whole turns are off by rounding
    left, cut, chord = np.max([errors for *_, errors in parts], axis=0).tolist()
    thinner = _thinner(cam, tool)
    return RotaryPath(
        moves=joined,
        turn=np.concatenate(turn),
        rapid=np.concatenate(rapid),
        layers=len(layers),
        tool=(mill.radius_at(cam.floor, layers[-1]), mill.outer),
        radius=cam.outer_radius,
        rest=max(mill.rest(layer) for layer in layers),
        chord=chord,
        left=left + max(0.0, thinner),
        cut=cut + max(0.0, -thinner),
    )


def _spare(cam: SpatialCam, tool: MillSpec, tolerance: float) -> float:
    """Return the radius of the roller less that of the tool; refuses tools that do not fit."""
    widest, taper = cam.tool.radius_at(cam.outer_radius), math.tan(cam.tool.half_angle)
    if tool.cone is not None and abs(_thinner(cam, tool)) > tolerance:
        what = "an end mill of another angle than the roller cannot cut true walls"
        value, limit = math.degrees(tool.cone), math.degrees(cam.tool.half_angle)
        note = "the limit is half the angle of the roller's cone"
        raise beyond_limit(what, "tool.cone_deg", value, limit, note, near=limit, unit="deg")
    if tool.diameter is None:
        return 0.0
    if tool.diameter > 2.0 * (widest + _SAME):
        what = "the tool is wider than the groove"
        note = "the limit is the width of the groove at the outside"
        raise beyond_limit(
            what, "tool.diameter_mm", tool.diameter, 2.0 * widest, note, near=2.0 * widest
        )
    least = 2.0 * (cam.outer_radius - cam.floor) * taper
    if tool.diameter <= least:
        what = "an end mill of the roller's angle comes to its tip above the floor of the groove"
        near = ABOVE * least
        raise beyond_limit(what, "tool.diameter_mm", tool.diameter, least, near=near)
    return max(0.0, widest - 0.5 * tool.diameter)


def _thinner(cam: SpatialCam, tool: MillSpec) -> float:
    """Return how much thinner a tool of another angle than the roller is at its end, mm."""
    roller = cam.tool.half_angle
    own = roller if tool.cone is None else tool.cone
    return (cam.outer_radius - cam.floor) * (math.tan(own) - math.tan(roller))


@dataclass(frozen=True)
class _Layer:
    """A pass in depth: the wall between `low` and `high` becomes true, with the tool's end at low.

    `spare`: the radius of the roller less that of the tool, at any place.
    """

    low: float
    high: float
    spare: float


@dataclass(frozen=True, eq=False)
class _Mill:
    """A cam and the tool that cuts it; `feed` along the path in mm/min."""

    cam: SpatialCam
    spare: float
    feed: float

    @property
    def outer(self) -> float:
        """Radius of the tool at the outside of the cam, when it is at the floor."""
        return self.cam.tool.radius_at(self.cam.outer_radius) - self.spare

    def radius_at(self, x: float, layer: _Layer) -> float:
        """Return the radius of the tool at a place along the roller."""
        return self.cam.tool.radius_at(x) - layer.spare

    @property
    def groups(self) -> list[list[Lane]]:
        """Where across the groove the tool runs, in the parts that are cut without lifting it."""
        cam = self.cam
        if self.spare < _SAME:
            return [[((side, 0.0),)] for side in (cam.sides if cam.apart else cam.sides[:1])]
        radius = cam.tool.radius_at(cam.floor) - self.spare
        count = 1 + max(1, math.ceil(self.spare / (_OVERLAP * radius) - _SAME))
        # the whole way of each roller is cut, also beside a single wall
        return [
            [((side, share), (-side, 1.0 - share)) for share in np.linspace(0.0, 1.0, count)]
            for side in (cam.sides if cam.apart else cam.sides[:1])
        ]

    def layers(self, most: float, tolerance: float) -> list[_Layer]:
        """Return the passes in depth: none deeper than `most`, rests within the tolerance."""
        count = math.ceil((self.cam.outer_radius - self.cam.floor) / most - _SAME)
        while True:
            if count * sum(map(len, self.groups)) > _MOST_TURNS:
                what = f"the tool would need more than {_MOST_TURNS} turns round the cam"
                near = "a wider tool, or a larger output.path_tolerance_mm or tool.depth_mm"
                raise InfeasibleError(what, where="tool", nearest=near)
            layers = self._divided(count)
            # most is left near the floor, where the direction changes most: it is looked at first
            excess = self.rest(layers[-1]) / tolerance
            if excess <= 1.0 and all(self.rest(layer) <= tolerance for layer in layers):
                return layers
            count = max(count + 1, math.floor(count * math.sqrt(excess)))

    def _divided(self, count: int) -> list[_Layer]:
        cam, taper = self.cam, math.tan(self.cam.tool.half_angle)
        ends = np.linspace(cam.outer_radius, cam.floor, count + 1).round(DECIMALS[2]).tolist()
        # a cone is thinner at a place while its end is higher
        return [
            _Layer(low, high, self.spare + (low - cam.floor) * taper)
            for high, low in pairwise(ends)
        ]

    def rest(self, layer: _Layer) -> float:
        """Return the largest thickness that a pass leaves on its part of the walls, mm."""
        if self.spare < _SAME:
            return 0.0

        def kept(theta: Array, _: Array) -> Array:
            return -np.max([self._left(theta, layer, side) for side in self.cam.sides], axis=0)

        return -self.cam.least(kept, (0.0, 0.0)).value

    def _left(self, theta: Array, layer: _Layer, side: int) -> Array:
        """Return what is left at the worse end of a layer, (n, 1)."""
        ends = (layer.low, layer.high)
        angles = self._angles(theta, ends, side)
        beside = layer.spare * side * _direction(0.5 * angles.sum(axis=1))
        return self._off(beside, angles, ends, layer, side).max(axis=1, keepdims=True)

    def _angles(self, theta: Array, places: Sequence[float], side: int) -> Array:
        """Return the directions of the contact at places on the roller, rad, from +-z to y."""
        x = np.array([places]) * np.ones((len(theta), 1))
        _, y, z = _unturned(self.cam.contact(theta, x, side).radial, theta)
        return np.arctan2(side * y, side * z)

    def _off(
        self, beside: Array, angles: Array, places: Sequence[float], layer: _Layer, side: int
    ) -> Array:
        """Return how far the tool, `beside` the roller's axis, is off the wall, (n, k), mm."""
        x = np.array(places)
        roller = self.cam.tool.radii(x)
        towards = side * np.einsum("nj,nkj->nk", beside, _direction(angles))
        square = np.sum(beside**2, axis=1, keepdims=True)
        return np.sqrt(roller**2 - 2.0 * roller * towards + square) - (roller - layer.spare)

    def errors(self, theta: Array, placed: Array, lane: Lane, layer: _Layer) -> tuple[float, float]:
        """Return what a tool at places (n, 2) leaves on the walls, and cuts into them, at most."""
        left = cut = 0.0
        sides, top = self._finished(lane, layer)
        for side in sides:
            beside = placed - self.center(theta, side)
            places = (layer.low, top, self.cam.outer_radius)
            angles = self._angles(theta, places, side)
            off = self._off(beside, angles, places, layer, side)
            own = np.arctan2(*(side * beside).T)
            # nearest to the wall where the contact has the direction of the tool's axis
            within = (own - angles[:, 0]) * (own - angles[:, 2]) < 0.0
            deepest = np.where(within, layer.spare - np.hypot(*beside.T), off[:, ::2].min(axis=1))
            left = max(left, float(off[:, :2].max()))
            cut = max(cut, -float(deepest.min()))
        return left, cut

    def _finished(self, lane: Lane, layer: _Layer) -> tuple[tuple[int, ...], float]:
        """Return the sides of the walls that become true in a turn, and up to which place."""
        sides = (lane[0][0],) if self.cam.apart else self.cam.sides
        if self.spare >= _SAME:
            return tuple(side for side, share in lane if share == 1.0 and side in sides), layer.high
        if layer.low > round(self.cam.floor, DECIMALS[2]):
            return (), layer.high  # the last pass makes the whole wall
        return sides, self.cam.outer_radius

    def center(self, theta: Array, side: int) -> Array:
        """Return y and z of the roller's axis beside its azimuth, (n, 2), mm."""
        axis = self.cam.axis(theta, side)
        return _unturned(axis.point[0][:, None], theta)[1:, :, 0].T

    def place(self, theta: Array, lane: Lane, layer: _Layer) -> Array:
        """Return y and z of the tool's axis beside the roller's azimuth, (n, 2), mm."""
        place = self.center(theta, lane[0][0])
        for side, share in lane:
            if share:
                angles = self._angles(theta, (layer.low, layer.high), side)
                place = place + share * layer.spare * side * _direction(0.5 * angles.sum(axis=1))
        return place

    def steps(self, lane: Lane, layer: _Layer, tolerance: float) -> tuple[Array, Array, Array]:
        """Return cam angles, places (n, 2) between which a path is straight, and its errors.

        Errors: what is left on walls, what is cut into them, the distance from the path.
        """
        cam = self.cam
        knots = cam.program.cuts_between(0.0, cam.program.period)
        counts = np.maximum(1, np.ceil(np.diff(knots) / _WIDEST_STEP - _SAME)).astype(int)
        theta = _rounded(divided(knots, counts))
        while True:
            placed = self._kept(theta, self.place(theta, lane, layer).round(DECIMALS[0]))
            between = theta[:-1, None] + np.diff(theta)[:, None] * _ALONG
            reached = placed[:-1, None] + np.diff(placed, axis=0)[:, None] * _ALONG[:, None]
            at, straight = between.ravel(), reached.reshape(-1, 2)
            off = np.linalg.norm(straight - self.place(at, lane, layer), axis=1)
            off = off.reshape(between.shape).max(axis=1)
            wide = off > _SEEN * tolerance
            if not wide.any():
                left, cut = self.errors(at, straight, lane, layer)
                return theta, placed, np.array([left, cut, off.max()]) / _SEEN
            middle = _rounded(0.5 * (theta[:-1] + theta[1:])[wide])
            theta = distinct(theta, middle)

    def _kept(self, theta: Array, placed: Array) -> Array:
        """Return places in which those stay the same that are reached too slowly."""
        share, kept = _SLOWEST / self.feed, [placed[0]]
        for place, length in zip(placed[1:], self.cam.outer_radius * np.diff(theta), strict=True):
            step = math.hypot(*(place - kept[-1]))
            kept.append(kept[-1] if step < share * math.hypot(step, length) else place)
        return np.array(kept)


def _direction(angles: Array) -> Array:
    """Return directions across the roller at angles from z to y, as y and z."""
    return np.stack([np.sin(angles), np.cos(angles)], axis=-1)


def _rounded(angles: Array) -> Array:
    """Return angles, rad, as a program states them."""
    return np.radians(np.degrees(angles).round(DECIMALS[3]))


def _ahead(points: Array, angle: float) -> Array:
    """Return X, Y, Z and A with A an angle ahead."""
    return points + np.array([0.0, 0.0, 0.0, angle])


def _unturned(vectors: Array, theta: Array) -> Array:
    """Return vectors of the cam's frame in the fixed frame, (3, n, k)."""
    c, s = np.cos(theta)[:, None], np.sin(theta)[:, None]
    x, y, z = np.moveaxis(vectors, -1, 0)
    return np.array([c * x - s * y, s * x + c * y, z])


def _part(
    mill: _Mill, lanes: list[Lane], layers: list[_Layer], tolerance: float
) -> tuple[Array, Ints, Array]:
    """Return points, numbers of turns, and the errors of what is cut without lifting."""
    points, numbers, errors, number = [], [], [], 0
    for k, layer in enumerate(layers):
        for lane in lanes[:: -1 if k % 2 else 1]:
            turn, off = _turn(mill, lane, layer, tolerance)
            if points:
                points.append(points[-1][-1:] * [0, 0, 1, 0] + turn[:1] * [1, 1, 0, 0])
                points[-1][0, 3] = 2.0 * math.pi * number
                numbers.append([0])
            points.append(_ahead(turn, 2.0 * math.pi * number))
            number += 1
            numbers.append([0, *[number] * (len(turn) - 1)])
            errors.append(off)
    joined, counts = np.concatenate(points), np.concatenate(numbers)
    moved = np.r_[True, np.any(np.diff(joined, axis=0) != 0.0, axis=1)]
    return joined[moved], counts[moved], np.max(errors, axis=0)


def _turn(mill: _Mill, lane: Lane, layer: _Layer, tolerance: float) -> tuple[Array, Array]:
    """Return X, Y, Z and A over one turn round the cam, and its errors (see `_Mill.steps`)."""
    theta, placed, errors = mill.steps(lane, layer, tolerance)
    y, z = placed.T
    turn = np.stack([z, y, np.full_like(y, layer.low), theta], axis=1)
    if not mill.cam.clockwise:
        turn[:, 1:] *= [-1.0, 1.0, -1.0]
        turn = _ahead(turn[::-1], theta[-1])
    return turn + 0.0, errors  # no minus zero
