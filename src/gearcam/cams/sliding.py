"""A translating cam: a plate that slides past its follower, with one wall or with a groove.

Everything that turns for a disc cam slides here (see `mechanism`). A wall is open; its plate closes
it: beyond its ends it goes on level, down (or up) to the straight edge of the metal. The groove is
closed at both ends by the roller's circle, so that the plate stays in one piece.

Frame: people see the mirror image, as of a cam that turns clockwise: the cam moves by u along
``+x``, a follower's centre stands at ``(-u, s)`` in the cam's frame.

Refused: arms that stand upright, plates that do not hold their walls.

Depends on cam, lost_motion, wall and mechanism.
"""

from __future__ import annotations

import math
from collections.abc import Sequence
from dataclasses import dataclass, replace
from functools import cached_property
from itertools import pairwise

import numpy as np

from gearcam.cams.cam import Cam
from gearcam.cams.lost_motion import Rest, largest_lost_motion
from gearcam.cams.measures import Extreme
from gearcam.cams.mechanism import Mechanism
from gearcam.cams.wall import CHORD_TOLERANCE, OVERSAMPLING, PitchMotion, Wall
from gearcam.display import Brief
from gearcam.errors import InfeasibleError, Way
from gearcam.facts import Fact, Facts
from gearcam.laws.program import Program
from gearcam.numeric.arrays import Array, Plane
from gearcam.numeric.bulges import as_complex, as_pairs
from gearcam.numeric.contour import Contour, Run

_UPRIGHT = 0.5 * math.pi
"""Angle of an arm over a sliding cam, rad, at which its roller no longer goes along the cam."""

_DENSE = 1 / 40
"""Chord error of dense points over the tolerance."""

_FEWEST = 8
"""Fewest chords of an arc."""

_COVERED = 2.0
"""Chord errors by which a wall may come nearer to the follower's first and last place than it is
wide."""

_ALIKE = 1e-9
"""Distance of corners, mm, below which they are one: rounding."""

Stretch = tuple[tuple[Run, ...], Array]
"""Runs of a part of a contour, and its vertices, (n, 2), but for the last, mm."""


@dataclass(frozen=True, kw_only=True)
class Plate(Brief):
    """The plate that a translating cam is cut from, mm, in the cam's frame.

    Parameters
    ----------
    left, right : float
        Its ends.
    low, high : float
        Its edges; a cam with one wall has no upper one.
    """

    left: float
    right: float
    low: float
    high: float


@dataclass(frozen=True, eq=False, kw_only=True)
class SlidingWall(Wall):
    """An open wall; its contour is that of the metal behind it.

    Parameters
    ----------
    plate : Plate
        What it is cut from.
    """

    plate: Plate

    @cached_property
    def line(self) -> Array:
        """Vertices of the wall, (n, 2), mm, from the beginning of the way to its end."""
        points = self.sampler.chords[1]
        centers = as_complex(self.pitch_line[[0, -1]])
        room = np.abs(points[:, None] - centers).min(axis=0)
        covered = room < self.mechanism.radius - _COVERED * self.tolerance
        if covered.any():
            key = "cam.run_in_mm" if covered[0] else "cam.run_out_mm"
            lack = 2.0 * self.mechanism.radius
            end = "begins" if covered[0] else "ends"
            raise InfeasibleError(
                f"where its way {end} the follower cuts away what it needs elsewhere: the "
                f"{self.called} is undercut there",
                where=key,
                value=float(room[covered].min()),
                limit=self.mechanism.radius,
                unit="mm",
                nearest="these are distances from the follower's centre",
                ways=(Way(far={key: lack}),),
            )
        return as_pairs(points)

    @cached_property
    def pitch_line(self) -> Array:
        """Vertices of the pitch curve, (n, 2), mm, from the beginning of the way to its end."""
        return as_pairs(self._pitch_sampler.chords[1])

    def stretch(self, *, reverse: bool = False) -> Stretch:
        """Return the wall as a part of a contour, from right to left, or in `reverse`."""
        runs = self.sampler.runs(OVERSAMPLING, reverse=reverse)
        return runs, (self.line[::-1] if reverse else self.line)[:-1]

    @cached_property
    def contour(self) -> Contour:
        """The metal behind the wall, counter-clockwise."""
        plate = self.plate
        edge = plate.low if self.side > 0 else plate.high
        left, last = self._level(-1, plate.left)
        right, first = self._level(0, plate.right)
        corners = np.array([
            last, (plate.left, last[1]), (plate.left, edge),
            (plate.right, edge), (plate.right, first[1]), first,
        ])  # fmt: skip
        if self.side > 0:
            around = [self.stretch(), *left, straight(corners), *_turned(right)]
        else:  # the metal lies above, the wall runs from left to right
            back = straight(corners[::-1])
            around = [self.stretch(reverse=True), *right, back, *_turned(left)]
        return joined(around, self)

    def _level(self, which: int, limit: float) -> tuple[list[Stretch], Array]:
        """Return the way on from an end of the wall, and where it has become level.

        It follows the roller's circle where that reaches farther than the wall, up to a limit.
        """
        center, start = (complex(*line[which]) for line in (self.pitch_line, self.line))
        outwards = -1.0 if which else 1.0
        far = outwards * min(outwards * center.real, outwards * limit)
        if not outwards * (far - start.real) > _ALIKE:
            return [], self.line[which]
        aside = far - center.real
        deep = math.sqrt((self.mechanism.radius - aside) * (self.mechanism.radius + aside))
        end = complex(far, center.imag - self.side * deep)
        arc = _arc(self, center, start, float(np.angle((end - center) / (start - center))))
        return [arc], np.array([end.real, end.imag])


def _turned(stretches: Sequence[Stretch]) -> list[Stretch]:
    """Return stretches the other way."""
    made = []
    for runs, vertices in stretches:
        back = tuple(run.reversed for run in reversed(runs))
        made.append((back, np.vstack([back[0].points[:1], vertices[:0:-1]])))
    return made


def straight(corners: Array) -> Stretch:
    """Return straight runs from corner to corner, (n, 2), mm; of no length there are none."""
    made = []
    for one, two in pairwise(corners):
        length = float(np.hypot(*(two - one)))
        if length > _ALIKE:
            slope = (two - one) / length
            made.append(Run(points=np.array([one, two]), tangents=np.array([slope, slope])))
    return tuple(made), np.array([run.points[0] for run in made])


def _arc(wall: Wall, center: complex, start: complex, turn: float) -> Stretch:
    """Return an arc about a centre from its beginning, by a turn, rad."""
    spoke = start - center

    def points(sagitta: float) -> Plane:
        chord = 2.0 * math.acos(max(0.0, 1.0 - sagitta / abs(spoke)))
        count = max(_FEWEST, math.ceil(abs(turn) / chord))
        return spoke * np.exp(1j * turn * np.linspace(0.0, 1.0, count + 1))

    dense = points(_DENSE * wall.tolerance)
    tangents = math.copysign(1.0, turn) * 1j * dense / abs(spoke)
    run = Run(points=as_pairs(center + dense), tangents=as_pairs(tangents))
    return (run,), as_pairs(center + points(wall.tolerance))[:-1]


def joined(stretches: Sequence[Stretch], wall: Wall) -> Contour:
    """Return the contour of stretches in order, with the accuracy of a `wall`."""
    return Contour(
        dense=lambda: tuple(run for runs, _ in stretches for run in runs),
        vertices=np.vstack([vertices for _, vertices in stretches]),
        tolerance=wall.tolerance,
        chord_error=wall.sampler.chords[2],
    )


@dataclass(frozen=True, eq=False, kw_only=True)
class SlidingCam(Brief, Cam):
    """A translating cam.

    Parameters
    ----------
    motion : PitchMotion
        Of its follower.
    lower : SlidingWall
        The wall below the follower.
    upper : SlidingWall or None
        That above it, of a groove.
    """

    motion: PitchMotion
    lower: SlidingWall
    upper: SlidingWall | None = None

    @property
    def walls(self) -> tuple[SlidingWall, ...]:
        """The wall below the follower, of a groove also that above it."""
        return (self.lower,) if self.upper is None else (self.lower, self.upper)

    @property
    def motions(self) -> tuple[PitchMotion, ...]:
        """The motion of the follower."""
        return (self.motion,)

    @property
    def way(self) -> float:
        """How far it slides, mm."""
        return self.motion.mechanism.driver.turn

    @property
    def width(self) -> float:
        """Of the groove, mm."""
        return 2.0 * self.lower.mechanism.radius

    @property
    def plate(self) -> Plate:
        """What it is cut from."""
        return self.lower.plate

    @cached_property
    def lost_motion(self) -> Extreme | None:
        """Largest lost motion in a groove, mm or rad."""
        if self.upper is None:
            return None
        radius = self.motion.mechanism.radius
        lower, upper = (Rest(wall=wall, radius=radius) for wall in self.walls)
        return largest_lost_motion(lower, upper)

    @cached_property
    def edge(self) -> Contour:
        """The plate's edge, of a cam with one wall with that wall."""
        plate = self.plate
        if self.upper is None:
            return self.lower.contour
        corners = [(plate.left, plate.low), (plate.right, plate.low), (plate.right, plate.high)]
        return joined(
            [straight(np.array([*corners, (plate.left, plate.high), corners[0]]))], self.lower
        )

    @cached_property
    def groove(self) -> Contour | None:
        """The edge of the groove, its ends half circles; None of a cam with one wall."""
        lower, upper = self.lower, self.upper
        if upper is None:
            return None
        right, left = as_complex(lower.pitch_line[[0, -1]]).tolist()
        start, end = complex(*lower.line[0]), complex(*upper.line[-1])
        stretches = [
            lower.stretch(reverse=True), _arc(lower, right, start, math.pi),
            upper.stretch(), _arc(lower, left, end, math.pi),
        ]  # fmt: skip
        return joined(stretches, lower)

    def picture(self) -> str:
        """Return a picture of plate, groove and pitch curve, SVG, in the cam's frame."""
        from gearcam.markup import outlines

        groove = [] if self.groove is None else [self.groove.vertices]
        pitch = [self.lower.pitch_line]
        return outlines(self.facts.headline, [self.edge.vertices, *groove], pitch)

    @cached_property
    def facts(self) -> Facts:
        """What the cam knows of itself; the facts of its result tell more."""
        low, high = self.motion.program.range
        swings = self.motion.mechanism.oscillating
        scale, unit = (math.degrees(1.0), "deg") if swings else (1.0, "mm")
        tree = {
            "total_lift": Fact(scale * (high - low), "lift", unit=unit),
            "way_mm": Fact(self.way, "way"),
            "area_mm2": self.edge.moments.area,
        }
        return Facts(tree, ("total_lift", "way_mm"), "translating cam")


def make_sliding(
    program: Program,
    mechanism: Mechanism,
    *,
    height: float,
    length: float | None = None,
    groove: bool = False,
    clearance: float = 0.0,
    tolerance: float = CHORD_TOLERANCE,
) -> SlidingCam:
    """Return a translating cam after proving that its follower and its plate can be.

    Parameters
    ----------
    program : Program
        The lift, open.
    mechanism : Mechanism
        The follower of a cam that slides.
    height : float, mm
        Of the plate; that of a cam with one wall is highest where the lift is.
    length : float, mm, optional
        Of the plate; where left out as long as its wall, or with half the groove's width beyond
        the groove at both ends.
    groove : bool
        Whether a second wall holds the roller from above.
    clearance : float, mm
        Width of the groove less the roller's diameter.
    tolerance : float, mm
        Chord error of its contours.

    Returns
    -------
    SlidingCam

    Raises
    ------
    InfeasibleError
        If they cannot.
    """
    if mechanism.oscillating:
        _demand_swing(program, mechanism)
    common = {"program": program, "clockwise": True, "tolerance": tolerance}
    wide = replace(mechanism, radius=mechanism.radius + (0.5 * clearance if groove else 0.0))
    plate = _plate(program, wide, height, length, groove)

    def wall(side: int, key: str, called: str) -> SlidingWall:
        return SlidingWall(mechanism=wide, plate=plate, side=side, key=key, called=called, **common)

    motion = PitchMotion(mechanism=mechanism, **common)
    if not groove:
        return SlidingCam(motion=motion, lower=wall(1, "", "profile"))
    lower, upper = (
        wall(*told) for told in ((1, "lower", "lower wall"), (-1, "upper", "upper wall"))
    )
    return SlidingCam(motion=motion, lower=lower, upper=upper)


def _demand_swing(program: Program, mechanism: Mechanism) -> None:
    """Refuse an arm that stands upright, or nearly so."""
    low, high = (mechanism.start + lift for lift in program.range)
    if not -_UPRIGHT < low <= high < _UPRIGHT:
        past = low if low <= -_UPRIGHT else high
        raise InfeasibleError(
            "the arm swings too far: it stands upright on the cam",
            where="motion",
            value=math.degrees(past - mechanism.start),
            limit=math.degrees(math.copysign(_UPRIGHT, past) - mechanism.start),
            unit="deg",
            nearest="these are lifts",
        )


def _plate(
    program: Program, mechanism: Mechanism, height: float, length: float | None, groove: bool
) -> Plate:
    """Return the plate of a cam, of a mechanism with half the groove's width."""
    radius, sides = mechanism.radius, (1.0, -1.0) if groove else (1.0,)
    theta = np.array([0.0, 2.0 * math.pi])
    s, ds = program.derivatives(theta, 1)
    curve = PitchMotion(program=program, mechanism=mechanism).curve
    drawn = [-curve.trace(theta, s, ds, side * radius)[0].real for side in sides]
    if groove:  # its ends are round
        middle = -curve.pitch(theta, s).real
        drawn += [middle - 2.0 * radius, middle + 2.0 * radius]
    left, right = float(np.min(drawn)) + 0.0, float(np.max(drawn)) + 0.0
    bare = right - left - (2.0 * radius if groove else 0.0)
    if length is not None:
        if not (length > bare if groove else length >= bare):
            raise _too_small("length_mm", "long", length, bare)
        left, right = (0.5 * (left + right + way) for way in (-length, length))
    positions = np.array(program.range) + mechanism.start
    bottom, top = mechanism.sliding_centre(positions).imag.tolist()
    least = top - bottom + (2.0 * radius if groove else 0.0)
    if not height > least:
        raise _too_small("height_mm", "high", height, least)
    high = 0.5 * (top + bottom + height) if groove else top - radius
    return Plate(left=left, right=right, low=high - height, high=high)


def _too_small(key: str, word: str, value: float, limit: float) -> InfeasibleError:
    where = f"blank.{key}"
    return InfeasibleError(
        f"the plate is not {word} enough for what is cut into it",
        where=where,
        value=value,
        limit=limit,
        unit="mm",
        nearest="a plate just above the limit has no metal left there",
        ways=(Way(near={where: limit}, far={where: 1.5 * limit}),),
    )
