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
until this is within the tolerance. So nothing is cut deeper than that.

Refused: tools wider than the groove, and cones of another angle. Source: derived here. Depends on
cam and tool; numpy only.
"""

from __future__ import annotations

import math
from collections.abc import Callable
from dataclasses import dataclass
from functools import cached_property
from itertools import pairwise
from typing import Final

import numpy as np

from gearcam.base.display import ShortRepr
from gearcam.base.errors import ABOVE, InfeasibleError, beyond_limit
from gearcam.numeric.arrays import Array, Ints, Mask
from gearcam.spatial.cam import SpatialCam
from gearcam.spatial.tool import MillSpec

_WIDEST_STEP: Final = math.radians(15.0)
"""Largest turn in one move, rad."""

_BETWEEN: Final = np.arange(1, 8) / 8.0
"""Places in a step at which its straight line is compared with the true path."""

_OVERLAP: Final = 0.8
"""Distance of paths side by side over the diameter of the tool's end."""

_MOST_TURNS: Final = 1000
"""Largest number of turns round the cam."""

_SAME: Final = 1e-9
"""Difference of radii, mm, below which a tool is as wide as the groove."""

PLUNGE: Final = 1.0 / 3.0
"""Feed of a move into the metal over that along the path."""

Lane = tuple[tuple[int, float], ...]
"""Sides and shares: where across the groove the tool runs, 1 at a wall; share 0: in the middle."""


@dataclass(frozen=True, eq=False, kw_only=True)
class RotaryPath(ShortRepr):
    """The path of a tool on a machine with a rotary axis.

    Parameters
    ----------
    moves : (n, 4) array, mm and rad
        X, Y, Z and A at the end of each move; A never falls.
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
        Largest thickness that is left on a wall, and largest distance of the moves from the path.
    """

    moves: Array
    turn: Ints
    rapid: Mask
    layers: int
    tool: tuple[float, float]
    radius: float
    rest: float
    chord: float

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
        Bound of what the moves are off the path, and of what they leave on the walls.

    Returns
    -------
    RotaryPath

    Raises
    ------
    InfeasibleError
        If the tool is wider than the groove, or has another angle than the roller.
    """
    mill = _Mill(cam=cam, spare=_spare(cam, tool, tolerance))
    layers = mill.layers(tool.depth or 0.5 * (tool.diameter or 2.0 * mill.outer), tolerance)
    parts = [_part(mill, lanes, layers, tolerance) for lanes in mill.groups]
    high = cam.outer_radius + tool.clearance_height
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
    return RotaryPath(
        moves=joined,
        turn=np.concatenate(turn),
        rapid=np.concatenate(rapid),
        layers=len(layers),
        tool=(mill.radius_at(cam.floor, layers[-1]), mill.outer),
        radius=cam.outer_radius,
        rest=max(mill.rest(layer) for layer in layers),
        chord=max(chord for *_, chord in parts),
    )


def _spare(cam: SpatialCam, tool: MillSpec, tolerance: float) -> float:
    """Return the radius of the roller less that of the tool; refuses tools that do not fit."""
    widest, taper = cam.tool.radius_at(cam.outer_radius), math.tan(cam.tool.half_angle)
    reach = cam.outer_radius - cam.floor
    own = cam.tool.half_angle if tool.cone is None else tool.cone
    if reach * abs(math.tan(own) - taper) > tolerance:
        what = "an end mill of another angle than the roller cannot cut true walls"
        value, limit = math.degrees(own), math.degrees(cam.tool.half_angle)
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
    least = 2.0 * reach * taper
    if tool.diameter <= least:
        what = "an end mill of the roller's angle comes to its tip above the floor of the groove"
        near = ABOVE * least
        raise beyond_limit(what, "tool.diameter_mm", tool.diameter, least, near=near)
    return max(0.0, widest - 0.5 * tool.diameter)


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
    """A cam and the tool that cuts it."""

    cam: SpatialCam
    spare: float

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
        if cam.apart or len(cam.sides) == 1:
            return [[((side, 1.0),)] for side in cam.sides]
        radius = cam.tool.radius_at(cam.floor) - self.spare
        count = 1 + max(1, math.ceil(self.spare / (_OVERLAP * radius) - _SAME))
        return [[((1, share), (-1, 1.0 - share)) for share in np.linspace(0.0, 1.0, count)]]

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
        ends = np.linspace(cam.outer_radius, cam.floor, count + 1).tolist()
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
        low, high = self._angles(theta, layer, side)
        off = 1.0 - np.cos(0.5 * (high - low))
        worst = np.zeros(len(theta))
        for x in (layer.low, layer.high):
            roller, tool = self.cam.tool.radius_at(x), self.radius_at(x, layer)
            left = np.sqrt(tool**2 + 2.0 * roller * layer.spare * off) - tool
            worst = np.maximum(worst, left)
        return worst[:, None]

    def _angles(self, theta: Array, layer: _Layer, side: int) -> tuple[Array, Array]:
        """Return the directions of the contact at both ends of a layer, rad, from +-z to y."""
        ends = np.array([[layer.low, layer.high]]) * np.ones((len(theta), 1))
        _, y, z = _unturned(self.cam.contact(theta, ends, side).radial, theta)
        return tuple(np.arctan2(side * y, side * z).T)  # pyright: ignore

    def place(self, theta: Array, lane: Lane, layer: _Layer) -> Array:
        """Return y and z of the tool's axis beside the roller's azimuth, (n, 2), mm."""
        axis = self.cam.axis(theta, lane[0][0])
        place = _unturned(axis.point[0][:, None], theta)[1:, :, 0]
        for side, share in lane:
            if share:
                low, high = self._angles(theta, layer, side)
                middle = 0.5 * (low + high)
                beside = side * np.array([np.sin(middle), np.cos(middle)])
                place = place + share * layer.spare * beside
        return place.T


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
) -> tuple[Array, Ints, float]:
    """Return points, numbers of turns, and the chord error of what is cut without lifting."""
    points, numbers, worst, number = [], [], 0.0, 0
    for k, layer in enumerate(layers):
        for lane in lanes[:: -1 if k % 2 else 1]:
            turn, chord = _turn(mill, lane, layer, tolerance)
            if points:
                points.append(points[-1][-1:] * [0, 0, 1, 0] + turn[:1] * [1, 1, 0, 0])
                points[-1][0, 3] = 2.0 * math.pi * number
                numbers.append([0])
            points.append(_ahead(turn, 2.0 * math.pi * number))
            number += 1
            numbers.append([0, *[number] * (len(turn) - 1)])
            worst = max(worst, chord)
    joined, counts = np.concatenate(points), np.concatenate(numbers)
    moved = np.r_[True, np.any(np.diff(joined, axis=0) != 0.0, axis=1)]
    return joined[moved], counts[moved], worst


def _turn(mill: _Mill, lane: Lane, layer: _Layer, tolerance: float) -> tuple[Array, float]:
    """Return X, Y, Z and A over one turn round the cam, and the chord error."""
    cam = mill.cam
    knots = cam.program.cuts_between(0.0, cam.program.period)
    theta, chord = _steps(lambda at: mill.place(at, lane, layer), knots, tolerance)
    y, z = mill.place(theta, lane, layer).T
    turn = np.stack([z, y, np.full_like(y, layer.low), theta], axis=1)
    if not cam.clockwise:
        turn[:, 1:] *= [-1.0, 1.0, -1.0]
        turn = _ahead(turn[::-1], theta[-1])
    return turn + 0.0, chord  # no minus zero


def _steps(place: Callable[[Array], Array], knots: Array, tolerance: float) -> tuple[Array, float]:
    """Return angles between which a path is straight within the tolerance, and its error."""
    counts = np.maximum(1, np.ceil(np.diff(knots) / _WIDEST_STEP - _SAME)).astype(int)
    parts = [
        np.linspace(left, right, count, endpoint=False)
        for (left, right), count in zip(pairwise(knots), counts, strict=True)
    ]
    theta = np.append(np.concatenate(parts), knots[-1])
    while True:
        left, right = theta[:-1, None], theta[1:, None]
        between = left + (right - left) * _BETWEEN
        true = place(between.ravel()).reshape(*between.shape, 2)
        at = place(theta)[:, None]
        straight = at[:-1] + (at[1:] - at[:-1]) * _BETWEEN[:, None]
        errors = np.linalg.norm(true - straight, axis=-1).max(axis=1)
        wide = errors > tolerance
        if not wide.any():
            return theta, float(errors.max())
        theta = np.sort(np.append(theta, 0.5 * (left + right)[wide, 0]))
