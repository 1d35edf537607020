"""A part with what its sheet needs: its true points, its bore, its axis, its section.

Depends on parts, drawings and sheets.
"""

from __future__ import annotations

import cmath
import math
from collections.abc import Mapping, Sequence
from dataclasses import dataclass, replace
from functools import cached_property
from typing import Any, Final, cast

import numpy as np

from gearcam.base.errors import InfeasibleError
from gearcam.numeric.arrays import Plane, bounds
from gearcam.numeric.pose import Pose
from gearcam.parts.body import Layer, Opening, Part, ScrewHole
from gearcam.parts.shapes import Circle, Loop, true_points
from gearcam.pictures.drawings import GROOVE, HOLE, Drawing, Path, chains, placed
from gearcam.sheets.dimensions import diameter_text
from gearcam.sheets.sections import Section, chain_crossings, crossings
from gearcam.sheets.sheet import fine, length_text
from gearcam.sheets.spec import DrawingNotes

SAME: Final = 1e-6
"""Sizes, mm, and angles, rad, that differ by less are equal."""

_PLANES: Final = 10
"""Places of the section that are tried, with both ends."""

UP: Final = 0.5 * math.pi

_ALONG: Final = 0.25
"""Cosine of the angle between a direction and the section below which they are one line."""

_OVER: Final = 0.995
"""Cosine of the angle between a set screw and a keyway that it is over."""


@dataclass(frozen=True, eq=False, kw_only=True)
class Sense:
    """How a cam turns: its angle is 0 in the direction `zero`, rad; if `clockwise`, it says so."""

    zero: float
    clockwise: bool

    @property
    def upright(self) -> bool:
        """Whether the direction is that of the section."""
        return abs(math.cos(self.zero)) < _ALONG


@dataclass(frozen=True, eq=False, kw_only=True)
class GrooveSizes:
    """The groove of a cam in space.

    Parameters
    ----------
    width, depth : float, mm
        Its width, 0 if it has one wall, and its depth.
    floor : float, mm
        Least radius of its floor.
    clearance : float, mm
        Its width less the diameter of the roller.
    """

    width: float
    depth: float
    floor: float
    clearance: float


@dataclass(frozen=True, eq=False, kw_only=True)
class Teeth:
    """The teeth of a wheel, in its frame.

    Parameters
    ----------
    pitch, root, tip : Path
        Its pitch curve, and the parallels of that at the roots and the tips.
    first : complex, mm
        Middle of the tip of tooth 1.
    """

    pitch: Path
    root: Path
    tip: Path
    first: complex

    def at(self, x: float) -> list[tuple[float, float, float]]:
        """Return where the plane at `x` crosses pitch curve, roots and tips: y, mm."""
        ways = []
        for path in (self.pitch, self.root, self.tip):
            ((points, closed),) = chains(path, 0.0)
            ways.append(chain_crossings(np.append(points, points[:1]) if closed else points, x))
        # where it runs along them it crosses some of them only
        if len({len(found) for found in ways}) > 1:
            return []
        return [(y, root, tip) for y, root, tip in zip(*map(np.ndarray.tolist, ways), strict=True)]


@dataclass(frozen=True, eq=False, kw_only=True)
class Unrolled:
    """What the sheet of a cam in space shows beside its blank.

    Parameters
    ----------
    loops : sequence of (n,) complex array, mm
        What the section cuts of its solid: z and y, with z = 0 at the back.
    drawing : Drawing
        Its outside unrolled, the lower left corner at 0.
    title : str
        What is written above that.
    note : str
        Where its walls are given.
    groove : GrooveSizes
        The sizes of its groove.
    """

    loops: Sequence[Plane]
    drawing: Drawing
    title: str
    note: str
    groove: GrooveSizes


@dataclass(frozen=True, eq=False, kw_only=True)
class Wheel:
    """A part with the data of its sheet; points are on the true curves.

    `teeth` are those of a gear or a rack; `unrolled` is what is shown of a cam in space, of which
    the part is the blank.
    """

    part: Part
    teeth: Teeth | None = None
    unrolled: Unrolled | None = None

    @cached_property
    def points(self) -> Plane:
        """Points of the outline."""
        return true_points(self.part.contours[-1:])

    @cached_property
    def low(self) -> complex:
        """Lower left corner of the outline, mm."""
        return bounds(self.points)[0]

    @cached_property
    def high(self) -> complex:
        """Upper right corner of the outline, mm."""
        return bounds(self.points)[1]

    @cached_property
    def round(self) -> bool:
        """Whether the outline is a circle around the axis, as for most rings and groove cams."""
        return float(np.ptp(np.abs(self.points))) < SAME

    @cached_property
    def turns(self) -> bool:
        """Whether the axis lies within the outline; racks have no axis."""
        corners = self.part.contours[-1].polyline(self.part.tolerance)
        if not (self.part.turns and corners.all()):
            return False
        turn = float(np.angle(np.roll(corners, -1) / corners).sum())
        return abs(turn) > math.pi

    @cached_property
    def tips(self) -> float:
        """Radius of the circle about the axis on which the tips of a wheel lie; 0 without one."""
        pitch = self.teeth.pitch if self.teeth else None
        if pitch is None or not pitch.closed or np.ptp(np.abs(pitch.points)) > SAME:
            return 0.0
        inner = self.part.inner[-1:]
        return float(np.abs(true_points(inner)).min() if inner else np.abs(self.points).max())

    @property
    def placed(self) -> bool:
        """Whether hole positions refer to an origin that is not an axis."""
        within = min((-self.low).real, (-self.low).imag, self.high.real, self.high.imag) > -SAME
        return within and not self.turns and bool(holes_of(self.part))

    @property
    def origin(self) -> complex:
        """From where hole positions count, mm: axis, cross, or a lower corner that is there."""
        if self.turns or self.placed:
            return 0j
        right = complex(self.high.real, self.low.imag)
        cut = float(np.abs(self.points - self.low).min()) > SAME  # by teeth, as of a rack
        return right if cut else self.low

    @property
    def bore(self) -> Opening | None:
        """The bore."""
        return self.part.bore

    @property
    def fits(self) -> Mapping[str, Any]:
        """Sizes of the bore that have tolerance classes."""
        return self.bore.fits if self.bore else {}

    @property
    def bore_text(self) -> str:
        """Diameter of the bore with tolerance class and limits."""
        return fitted(diameter_text(2.0 * self.radius), self.fits.get("diameter"))

    @property
    def floor_text(self) -> str:
        """Width of the keyway with tolerance class and limits; of a flat its width."""
        _, (start, end) = floor_of(cast("Loop", self.keyed))
        return fitted(length_text(float(abs(end - start))), self.fits.get("keyway"))

    @property
    def keyed(self) -> Loop | None:
        """The bore if it is not round."""
        shape = self.bore.shape if self.bore else None
        return shape if isinstance(shape, Loop) else None

    @property
    def radius(self) -> float:
        """Radius of the bore, with a keyway or a flat that of the arc, mm; 0 without a bore."""
        if self.keyed is not None:
            return float(abs(self.keyed.points[0]))
        return self.bore.shape.reach if self.bore else 0.0

    @property
    def bore_top(self) -> float:
        """How far up from the axis the section shows the bore, mm."""
        return self.radius if self.keyed is None else float(abs(floor_of(self.keyed)[1].mean()))

    @property
    def plane(self) -> float:
        """Where the section is, x, mm; without axis and holes where it cuts most metal."""
        if self.turns:
            return 0.0
        even = np.linspace(self.low.real, self.high.real, _PLANES)[1:-1]
        tried = [one.center.real for one in holes_of(self.part)][:1] or even.tolist()
        edge, tolerance = self.part.contours[-1], self.part.tolerance
        return max(tried, key=lambda x: float(np.diff(crossings(edge, x, tolerance))[::2].sum()))

    @cached_property
    def shown(self) -> Part:
        """The part as its section shows it (see `upright`)."""
        return upright(self.part)

    @cached_property
    def section(self) -> Section:
        """What the plane cuts."""
        part = self.shown
        return Section(
            layers=part.layers,
            pockets=[_hole_of(one) if isinstance(one, ScrewHole) else one for one in part.pockets],
            x=self.plane,
            tolerance=part.tolerance,
            teeth=[(root, tip) for _, root, tip in self.cut_teeth],
        )

    @cached_property
    def cut_teeth(self) -> list[tuple[float, float, float]]:
        """Where the plane crosses pitch curve, roots and tips (see `Teeth.at`)."""
        return self.teeth.at(self.plane) if self.teeth else []

    @property
    def grooved(self) -> bool:
        """Whether it has a groove for a roller."""
        if self.unrolled is not None:
            return self.unrolled.groove.width > 0.0
        return bool(self.part.recesses) or any(one.kind == GROOVE for one in self.part.openings)

    @property
    def cut(self) -> Sequence[Plane]:
        """The cut metal as closed loops, z and y, mm, from the back of the plate."""
        return self.section.metal if self.unrolled is None else self.unrolled.loops

    @cached_property
    def edges(self) -> tuple[Plane, Plane]:
        """Middles of the straight edges of the cut metal, and the way along each, mm."""
        starts = np.concatenate(self.cut)
        ways = np.concatenate([np.roll(loop, -1) for loop in self.cut]) - starts
        return starts + 0.5 * ways, ways


def upright(part: Part) -> Part:
    """Return a part as its section shows it.

    A keyway or flat is turned to the top, and a set screw too, or to the bottom if it is beside it.
    """
    bore = part.bore
    if bore is None:
        return part
    turn, aside = Pose(0.0), False
    if isinstance(bore.shape, Loop):
        way = cmath.phase(complex(floor_of(bore.shape)[1].mean()))
        turn = Pose(UP - way)
        aside = part.screw is not None and math.cos(part.screw.angle - way) < _OVER
    there = replace(bore, shape=placed(bore.shape, turn))
    bevels = [
        replace(one, edge=there.shape, face=placed(one.face, turn))
        if one.edge is bore.shape
        else one
        for one in part.bevels
    ]
    return replace(
        part,
        openings=tuple(there if one is bore else one for one in part.openings),
        bevels=tuple(bevels),
        screw=part.screw and replace(part.screw, angle=-UP if aside else UP),
    )


def _hole_of(screw: ScrewHole) -> Layer:
    """Return the hole of a screw that is turned up or down, as what a section cuts from a part."""
    side = math.copysign(1.0, screw.angle)
    half, end = side * screw.drill, 1j * side * screw.edge.reach
    corners = np.array([-half, half, half + end, end - half])
    return Layer(edge=Loop(points=corners, bulges=np.zeros(4)), low=screw.low, high=screw.high)


def check_runout(notes: DrawingNotes, parts: Sequence[Part]) -> None:
    """Refuse run-out in the `notes` of a drawing without a bore.

    Parameters
    ----------
    notes : DrawingNotes
        What the drawing says.
    parts : sequence of Part
        What it shows.

    Raises
    ------
    InfeasibleError
        If none of them has a bore.
    """
    if notes.runout and not any(part.bore for part in parts):
        what = "run-out is about a bore, and no part has one"
        nearest = "blank.bore_diameter_mm or blank.shaft gives one; else leave runout_mm out"
        raise InfeasibleError(what, where="drawing.runout_mm", nearest=nearest)


def holes_of(part: Part) -> list[Circle]:
    """Return the round holes of a part."""
    shapes = [one.shape for one in part.openings if one.kind == HOLE]
    return [one for one in shapes if isinstance(one, Circle)]


BORES: Final = {3: ("flat", [0, -1]), 4: ("flats", [0, 1]), 5: ("keyway", [-2, -1])}
"""What a bore that is not round has, and where its floor ends, by the corners of its loop."""


def floor_of(keyed: Loop) -> tuple[str, Plane]:
    """Return what a `keyed` bore has, and both ends of the floor of it, or of its first flat."""
    kind, ends = BORES[len(keyed.points)]
    return kind, keyed.points[ends]


def fitted(words: str, fit: Any) -> str:
    """Return `words`, a size, with tolerance class and limits of its `fit`, a FitSize or None."""
    if fit is None:
        return words
    limits = f"±{fine(fit.upper)}"
    if fit.lower != -fit.upper:
        limits = "/".join(f"{'+' * (one > 0)}{fine(one)}" for one in (fit.upper, fit.lower))
    return f"{words} {fit.tolerance_class} ({limits})"
