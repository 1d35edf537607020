"""A cam of any form: the walls that touch its follower, and their pitch motions.

A *motion* is a lift program that moves a follower; a *wall* is the trimmed edge that one side of
such a motion cuts. A disc cam has one motion and one wall, a groove two walls of one motion,
conjugate cams two motions of one follower with one wall each. If there are several, each has a
*key*, the ending of names of files and facts, and a name for messages.

Each motion and wall is given in the frame of its own follower, counter-clockwise (see `followers`).

Depends on wall.
"""

from __future__ import annotations

from abc import abstractmethod
from functools import cached_property
from typing import ClassVar

import numpy as np

from gearcam.base.display import NotebookView, renderer
from gearcam.base.facts import Fact, Facts
from gearcam.cams.measures import Extreme
from gearcam.cams.touch import WallTouch
from gearcam.cams.wall import PitchMotion, Wall
from gearcam.numeric.arrays import Array


class Cam(NotebookView):
    """A cam made from a lift program and a follower; each form adds its own properties."""

    title: ClassVar[str]
    """The form in words."""

    @property
    @abstractmethod
    def walls(self) -> tuple[Wall, ...]:
        """The walls to be cut, at least one; the first lifts the follower."""

    @property
    def motions(self) -> tuple[PitchMotion, ...]:
        """The motions of the walls, at least one; the first has the given lift."""
        return self.walls

    def linked(self, wall: Wall) -> dict[str, float]:  # noqa: ARG002
        """Return the lift per unit of each size between the first roller and that on a wall."""
        return {}

    @property
    def touches(self) -> tuple[WallTouch, ...]:
        """Where it can press on its follower: by default at each wall."""
        return tuple(WallTouch(wall=wall, end=wall.follower, key=wall.key) for wall in self.walls)

    @cached_property
    def lost_motion(self) -> Extreme | None:
        """Largest lost motion between walls, mm or rad; None with one wall only."""
        return None

    @property
    def clearance(self) -> float | None:
        """Width of the groove less the diameter of the one roller that fills it, mm; else None."""
        return None

    @property
    def face_width(self) -> float | None:
        """Least width of the faces, mm, of a follower with two; None for others."""
        return None

    @property
    def least_base_radius(self) -> float | None:
        """Least base radius without undercut, mm, of translating flat followers; None of others."""
        return None

    @property
    def outline(self) -> Array:
        """Vertices of the first wall, (n, 2), mm, counter-clockwise, in the cam's frame."""
        return self.walls[0].outline

    @cached_property
    def facts(self) -> Facts:
        """Facts of the cam: lift, walls, lost motion; its result has more."""
        motion, lost, sizes = self.motions[0], self.lost_motion, {}
        for wall in self.walls:
            prefix = f"{wall.key}_" if wall.key else ""
            sizes[f"{prefix}perimeter_mm"] = wall.size.perimeter
            sizes[f"{prefix}area_mm2"] = wall.size.area if wall.program.closed else None
        scale, unit = motion.follower.lift_unit
        motion_lost = None if lost is None else Fact(scale * lost.value, "lost motion", unit=unit)
        chord = max(wall.contour.chord_error for wall in self.walls)
        tree = {"total_lift": motion.total_lift, **sizes, "lost_motion": motion_lost}
        tree |= {"vertices": len(self.outline), "chord_error_mm": chord}
        return Facts(tree, ("total_lift",), self.title)

    def picture(self) -> str:
        """Return a drawing of the walls and their pitch curves, SVG, in the cam's frame."""
        inside = [wall for wall in self.walls if wall.side > 0]
        pitches = [
            np.append(wall.pitch_contour.points, wall.pitch_contour.points[:1])
            for wall in inside
            if wall.pitch_contour is not wall.contour
        ]
        return renderer().outlines(
            self.facts.headline, [wall.contour.points for wall in self.walls], pitches
        )
