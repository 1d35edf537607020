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
from gearcam.parts.body import Bevel, Opening, Part, ScrewHole
from gearcam.parts.shapes import Circle, Loop, true_points
from gearcam.pictures.drawings import BORE, HOLE, Drawing, Path, chains, placed
from gearcam.sheets.dimensions import diameter_text
from gearcam.sheets.sections import Section, chain_crossings, crossings
from gearcam.sheets.sheet import fine, length_text
from gearcam.sheets.spec import DrawingNotes

SAME: Final = 1e-6
"""Sizes, mm, and angles, rad, that differ by less are equal."""

_PLANES: Final = 10
"""Places of the section that are tried, with both ends."""

UP: Final = 0.5 * math.pi


@dataclass(frozen=True, eq=False, kw_only=True)
class Sense:
    """How a cam turns: its angle is 0 in the direction `zero`, rad; if `clockwise`, it says so."""

    zero: float
    clockwise: bool


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
    """

    loops: Sequence[Plane]
    drawing: Drawing
    title: str
    note: str


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

    @cached_property
    def bore(self) -> Opening | None:
        """The bore."""
        return next((one for one in self.part.openings if one.kind == BORE), None)

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
    def screwed(self) -> tuple[float, float]:
        """Where the section shows the set screw: above the axis, or beside a keyway below; from.

        The side, 1 or -1, and the distance of the bore from the axis there, mm.
        """
        if self.keyed is None or self.part.screw is None:
            return 1.0, self.radius
        floor = complex(floor_of(self.keyed)[1].mean())
        way = cmath.rect(1.0, self.part.screw.angle)
        over = abs(cmath.phase(floor * way.conjugate())) < 0.1
        return (1.0, abs(floor)) if over else (-1.0, self.radius)

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
    def plane(self) -> float:
        """Where the section is, x, mm; without axis and holes where it cuts most metal."""
        if self.turns:
            return 0.0
        even = np.linspace(self.low.real, self.high.real, _PLANES)[1:-1]
        tried = [one.center.real for one in holes_of(self.part)][:1] or even.tolist()
        edge, tolerance = self.part.contours[-1], self.part.tolerance
        return max(tried, key=lambda x: float(np.diff(crossings(edge, x, tolerance))[::2].sum()))

    @cached_property
    def section(self) -> Section:
        """What the plane cuts, a keyway or flat turned into it."""
        part = self.part
        if self.keyed is not None:
            turn = Pose(UP - cmath.phase(complex(floor_of(self.keyed)[1].mean())))
            turned = replace(cast("Opening", self.bore), shape=placed(self.keyed, turn))
            others = (turned if one is self.bore else one for one in part.openings)
            part = replace(part, openings=tuple(others))
        # a note states chamfers; a set screw is turned into the plane
        pockets = [one for one in part.pockets if not isinstance(one, Bevel | ScrewHole)]
        return Section(
            layers=part.layers,
            pockets=pockets,
            x=self.plane,
            tolerance=part.tolerance,
            teeth=[(root, tip) for _, root, tip in self.cut_teeth],
        )

    @cached_property
    def cut_teeth(self) -> list[tuple[float, float, float]]:
        """Where the plane crosses pitch curve, roots and tips (see `Teeth.at`)."""
        return self.teeth.at(self.plane) if self.teeth else []


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
    if notes.runout and not any(one.kind == BORE for part in parts for one in part.openings):
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
