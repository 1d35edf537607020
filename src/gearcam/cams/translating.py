"""A translating cam: a plate that slides past its follower, with one wall or with a groove.

The rotation of a disc cam is a translation here (see `carriers`). A wall is open and is closed by
its plate: beyond its ends the outline continues level, then down (or up) to the straight edge of
the metal. The groove is closed at both ends by the roller's circle, so that the plate stays in one
piece.

Frame: output is the mirror image, as for a cam that turns clockwise: the cam moves by u along
``+x``, a follower's centre is at ``(-u, s)`` in the cam's frame.

A *stretch* is a part of a contour: runs, and the vertices of its polygon.

Refused: arms that get perpendicular to the travel, plates that are too small for their walls, walls
that are narrower than their chord error.

Depends on cam, followers, lost_motion, trim, wall and numeric.
"""

from __future__ import annotations

import math
from collections.abc import Sequence
from dataclasses import dataclass, replace
from functools import cached_property
from itertools import pairwise

import numpy as np

from gearcam.base.display import ShortRepr, renderer
from gearcam.base.errors import InfeasibleError, beyond_limit
from gearcam.cams.cam import Cam
from gearcam.cams.carriers import Sliding
from gearcam.cams.followers import Round
from gearcam.cams.lost_motion import Rest, largest_lost_motion
from gearcam.cams.measures import Extreme
from gearcam.cams.touch import WallTouch
from gearcam.cams.trim import crossing_chords
from gearcam.cams.wall import CHORD_TOLERANCE, OVERSAMPLING, PitchMotion, Wall
from gearcam.laws.program import Program
from gearcam.numeric.arrays import Array, Plane
from gearcam.numeric.contour import Contour, Run

_DENSE = 1 / 40
"""Chord error of dense points over the tolerance."""

_FEWEST = 8
"""Fewest chords of an arc."""

_ALIKE = 1e-11
"""Distance of corners, in sizes of the plate, below which they are merged: rounding."""

Stretch = tuple[tuple[Run, ...], Plane]
"""Runs of a part of a contour, and its points, (n,), complex, mm, without the last."""

_FAR = 3.0
"""Size of a plate in remedies, over the least: bolts need space next to the groove."""


@dataclass(frozen=True, kw_only=True)
class Plate(ShortRepr):
    """The plate from which a translating cam is cut, mm, in the cam's frame.

    Parameters
    ----------
    left, right : float
        Its ends.
    low, high : float
        Its lower and upper edge; a cam with one wall has no upper edge.
    """

    left: float
    right: float
    low: float
    high: float

    @property
    def corners(self) -> tuple[complex, complex, complex, complex]:
        """Its corners, counter-clockwise, from the lower left one."""
        low, high = 1j * self.low, 1j * self.high
        return self.left + low, self.right + low, self.right + high, self.left + high


@dataclass(frozen=True, eq=False, kw_only=True)
class TranslatingWall(Wall):
    """An open wall; its contour is that of the metal behind it.

    Parameters
    ----------
    plate : Plate
        The plate from which it is cut.
    """

    plate: Plate

    @cached_property
    def line(self) -> Plane:
        """Points of the wall, complex, mm, from the beginning of the travel to its end."""
        return self.sampler.chords[1]

    @cached_property
    def pitch_line(self) -> Plane:
        """Points of the pitch curve, complex, mm, from the beginning of the travel to its end."""
        return self._pitch_sampler.chords[1]

    def stretch(self, *, reverse: bool = False) -> Stretch:
        """Return the wall as a part of a contour, from right to left, or in `reverse`."""
        runs = self.sampler.dense(OVERSAMPLING).runs(reverse)
        return runs, (self.line[::-1] if reverse else self.line)[:-1]

    @cached_property
    def contour(self) -> Contour:
        """Outline of the metal behind the wall, counter-clockwise, verified to be simple."""
        steps = np.diff(self.line.real)
        seen_whole = bool(np.all(steps > 0.0) or np.all(steps < 0.0))
        if not seen_whole and not self._metal.polygon.is_valid:
            raise crossing_chords(
                self.called,
                self.sampler,
                lambda finer: replace(self, tolerance=finer.tolerance)._metal,
            )
        return self._metal

    @cached_property
    def _metal(self) -> Contour:
        plate, lower = self.plate, self.side > 0
        left, last = self._level(-1, plate.left)
        right, first = self._level(0, plate.right)
        far = plate.corners[:2] if lower else plate.corners[:1:-1]
        ends = complex(plate.left, last.imag), complex(plate.right, first.imag)
        corners = np.array([last, ends[0], *far, ends[1], first])
        if lower:
            around = [self.stretch(), *left, straight(corners), *_turned(right)]
        else:  # the metal lies above, the wall runs from left to right
            back = straight(corners[::-1])
            around = [self.stretch(reverse=True), *right, back, *_turned(left)]
        return joined(around, self)

    def _level(self, which: int, limit: float) -> tuple[list[Stretch], complex]:
        """Return the continuation from an end of the wall, and the point where it is level.

        It follows the roller's circle where that reaches farther than the wall, up to a limit.
        """
        center, start = (complex(line[which]) for line in (self.pitch_line, self.line))
        outwards = -1.0 if which else 1.0
        far = outwards * min(outwards * center.real, outwards * limit)
        if not outwards * (far - start.real) > _ALIKE * (self.plate.right - self.plate.left):
            return [], start
        aside = far - center.real
        deep = math.sqrt((self.follower.radius - aside) * (self.follower.radius + aside))
        end = complex(far, center.imag - self.side * deep)
        turn = float(np.angle((end - center) / (start - center)))
        return [arc(self, center, start, turn)], end


@dataclass(frozen=True, eq=False, kw_only=True)
class TranslatingCam(ShortRepr, Cam):
    """A translating cam.

    Parameters
    ----------
    motion : PitchMotion
        Motion of its follower.
    roller : Round
        That follower.
    lower : TranslatingWall
        The wall below the follower.
    upper : TranslatingWall or None
        For a groove: the wall above it.
    """

    title = "translating cam"

    motion: PitchMotion
    roller: Round
    lower: TranslatingWall
    upper: TranslatingWall | None = None

    @property
    def walls(self) -> tuple[TranslatingWall, ...]:
        """The wall below the follower, and for a groove also that above it."""
        return (self.lower,) if self.upper is None else (self.lower, self.upper)

    @property
    def touches(self) -> tuple[WallTouch, ...]:
        """Its walls (see `Cam.touches`)."""
        return tuple(WallTouch(wall=wall, end=self.roller, key=wall.key) for wall in self.walls)

    @property
    def motions(self) -> tuple[PitchMotion, ...]:
        """The motion of the follower."""
        return (self.motion,)

    @property
    def travel(self) -> float:
        """Travel, mm."""
        return self.motion.program.period

    @property
    def width(self) -> float:
        """Width of the groove, mm."""
        return 2.0 * self.lower.follower.radius

    @property
    def clearance(self) -> float | None:
        """Width of the groove less the roller's diameter, mm; None for a cam with one wall."""
        return None if self.upper is None else self.width - 2.0 * self.roller.radius

    @property
    def plate(self) -> Plate:
        """The plate from which it is cut."""
        return self.lower.plate

    @cached_property
    def lost_motion(self) -> Extreme | None:
        """Largest lost motion in a groove, mm or rad."""
        if self.upper is None:
            return None
        lower, upper = (Rest(wall=wall, roller=self.roller) for wall in self.walls)
        return largest_lost_motion(lower, upper)

    @cached_property
    def edge(self) -> Contour:
        """The plate's outline, including the wall of a cam with one wall."""
        if self.upper is None:
            return self.lower.contour
        corners = self.plate.corners
        return joined([straight(np.array([*corners, corners[0]]))], self.lower)

    @cached_property
    def groove(self) -> Contour | None:
        """The outline of the groove, with half-round ends; None for a cam with one wall."""
        lower, upper = self.lower, self.upper
        if upper is None:
            return None
        right, left = lower.pitch_line[[0, -1]].tolist()
        start, end = complex(lower.line[0]), complex(upper.line[-1])
        stretches = [
            lower.stretch(reverse=True),
            arc(lower, right, start, math.pi),
            upper.stretch(),
            arc(lower, left, end, math.pi),
        ]
        return joined(stretches, lower)

    def picture(self) -> str:
        """Return a drawing of plate, groove and pitch curve, SVG, in the cam's frame."""
        groove = [] if self.groove is None else [self.groove.points]
        edges = [self.edge.points, *groove]
        return renderer().outlines(self.facts.headline, edges, [self.lower.pitch_line])


def make_translating(
    program: Program,
    follower: Round,
    *,
    height: float,
    length: float | None = None,
    groove: bool = False,
    clearance: float = 0.0,
    tolerance: float = CHORD_TOLERANCE,
) -> TranslatingCam:
    """Return a translating cam, verified for its follower and its plate.

    Parameters
    ----------
    program : Program
        The lift, open.
    follower : Round
        The follower.
    height : float, mm
        Height of the plate; for a cam with one wall at the highest lift.
    length : float, mm, optional
        Length of the plate; by default that of its wall, or of the groove and half its width beyond
        both ends.
    groove : bool
        Whether a second wall holds the roller from above.
    clearance : float, mm
        Width of the groove less the roller's diameter.
    tolerance : float, mm
        Chord error of its contours.

    Returns
    -------
    TranslatingCam

    Raises
    ------
    InfeasibleError
        If one of them is impossible.
    """
    follower.demand(program)
    carrier = Sliding(program.period)
    common = {"program": program, "carrier": carrier, "clockwise": True, "tolerance": tolerance}
    motion = PitchMotion(follower=follower, **common)
    wide = replace(follower, radius=follower.radius + (0.5 * clearance if groove else 0.0))
    plate = _plate(motion, wide, height, length, groove)

    def wall(side: int, key: str, called: str) -> TranslatingWall:
        place = {"side": side, "of": motion, "key": key, "called": called}
        return TranslatingWall(follower=wide, plate=plate, **place, **common)

    if not groove:
        return TranslatingCam(motion=motion, roller=follower, lower=wall(1, "", "profile"))
    lower, upper = wall(1, "lower", "lower wall"), wall(-1, "upper", "upper wall")
    return TranslatingCam(motion=motion, roller=follower, lower=lower, upper=upper)


def _plate(
    motion: PitchMotion, wide: Round, height: float, length: float | None, groove: bool
) -> Plate:
    """Return the plate of a cam, with a follower as `wide` as its groove."""
    radius, program = wide.radius, motion.program
    theta = np.array([0.0, program.period])
    s, ds = program.derivatives(theta, 1)

    def ends(inset: float) -> Array:
        return -replace(motion.pitch_curve, inset=inset).trace(theta, s, ds)[0].real

    drawn = [ends(radius)]
    if groove:  # its ends are round
        drawn += [ends(-radius), ends(0.0) - 2.0 * radius, ends(0.0) + 2.0 * radius]
    left, right = float(np.min(drawn)) + 0.0, float(np.max(drawn)) + 0.0
    bare = right - left - (2.0 * radius if groove else 0.0)
    if length is not None:
        if not (length > bare if groove else length >= bare):
            raise _too_small("length_mm", "long", length, bare)
        left, right = (0.5 * (left + right + move) for move in (-length, length))
    positions = np.array(program.range) + wide.start
    bottom, top = wide.centre(positions).imag.tolist()
    least = top - bottom + (2.0 * radius if groove else 0.0)
    if not height > least:
        raise _too_small("height_mm", "high", height, least)
    high = 0.5 * (top + bottom + height) if groove else top - radius
    return Plate(left=left, right=right, low=high - height, high=high)


def _too_small(key: str, word: str, value: float, limit: float) -> InfeasibleError:
    what, rule = (
        f"the plate is not {word} enough for the cam",
        "at the limit no metal is left there",
    )
    return beyond_limit(what, f"blank.{key}", value, limit, rule, far=_FAR * limit)


def _turned(stretches: Sequence[Stretch]) -> list[Stretch]:
    """Return stretches in the opposite sense."""
    turned = []
    for runs, points in stretches:
        back = tuple(run.reversed for run in reversed(runs))
        turned.append((back, np.append(back[0].points[:1], points[:0:-1])))
    return turned


def straight(corners: Plane) -> Stretch:
    """Return straight runs.

    Parameters
    ----------
    corners : (n,) complex array, mm
        Corners in order; there is no run between merged ones.

    Returns
    -------
    Stretch
    """
    runs, alike = [], _ALIKE * float(max(np.ptp(corners.real), np.ptp(corners.imag)))
    for start, end in pairwise(corners.tolist()):
        length = abs(end - start)
        if length > alike:
            slope = (end - start) / length
            runs.append(Run(points=np.array([start, end]), tangents=np.array([slope, slope])))
    return tuple(runs), np.array([run.points[0] for run in runs])


def arc(wall: Wall, center: complex, start: complex, turn: float) -> Stretch:
    """Return an arc.

    Parameters
    ----------
    wall : Wall
        With the tolerance.
    center, start : complex, mm
        Its centre and its beginning.
    turn : float, rad
        Angle from there to its end, counter-clockwise positive.

    Returns
    -------
    Stretch
    """
    spoke = start - center

    def points(sagitta: float) -> Plane:
        chord = 2.0 * math.acos(max(0.0, 1.0 - sagitta / abs(spoke)))
        count = max(_FEWEST, math.ceil(abs(turn) / chord))
        return spoke * np.exp(1j * turn * np.linspace(0.0, 1.0, count + 1))

    dense = points(_DENSE * wall.tolerance)
    tangents = math.copysign(1.0, turn) * 1j * dense / abs(spoke)
    run = Run(points=center + dense, tangents=tangents)
    return (run,), center + points(wall.tolerance)[:-1]


def joined(stretches: Sequence[Stretch], wall: Wall) -> Contour:
    """Return the contour of stretches.

    Parameters
    ----------
    stretches : sequence of Stretch
        In order, counter-clockwise, each beginning where the one before it ends.
    wall : Wall
        With the tolerance, and the largest chord error.

    Returns
    -------
    Contour
    """
    return Contour(
        dense=lambda: tuple(run for runs, _ in stretches for run in runs),
        points=np.concatenate([points for _, points in stretches]),
        tolerance=wall.tolerance,
        chord_error=wall.sampler.chords[2],
    )
