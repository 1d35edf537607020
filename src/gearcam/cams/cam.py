"""A cam, whatever its form: the walls that touch its follower, and the pitch motions they are of.

A *motion* is a lift program that moves a follower; a *wall* is where one side of such a motion cuts
the metal, trimmed. A disc cam has one motion and one wall, a groove two walls of one motion,
conjugate cams two motions of one follower with a wall each. Where there are several, each has a
*key*, with which names of its files and facts end, and a name for people.

Motions and walls are told each in the frame of its own follower, counter-clockwise (see
`mechanism`).

Depends on wall.
"""

from __future__ import annotations

from abc import abstractmethod
from functools import cached_property

import numpy as np

from gearcam.cams.measures import Extreme
from gearcam.cams.wall import PitchMotion, Wall
from gearcam.display import Displayed
from gearcam.numeric.arrays import Array


class Cam(Displayed):
    """What a form makes of a lift program and a follower; forms add what is theirs."""

    @property
    @abstractmethod
    def walls(self) -> tuple[Wall, ...]:
        """What can be cut, at least one wall; the first carries the follower as it rises."""

    @property
    def motions(self) -> tuple[PitchMotion, ...]:
        """What the walls are of, at least one motion; the first has the lift asked for."""
        return self.walls

    @cached_property
    def lost_motion(self) -> Extreme | None:
        """Largest lost motion between walls, mm or rad; None where nothing holds the follower."""
        return None

    @property
    def face_width(self) -> float | None:
        """Least width of the faces, mm, of a follower that needs two; None of others."""
        return None

    @property
    def least_base_radius(self) -> float | None:
        """Least base radius without undercut, mm, of translating flat followers; None of others."""
        return None

    @property
    def outline(self) -> Array:
        """Vertices of the first wall, (n, 2), mm, counter-clockwise, in the cam's frame."""
        return self.walls[0].outline

    def picture(self) -> str:
        """Return a picture of the walls and their pitch curves, SVG, in the cam's frame."""
        from gearcam.markup import outlines

        inside = [wall for wall in self.walls if wall.side > 0]
        pitches = [
            np.vstack([wall.pitch_contour.vertices, wall.pitch_contour.vertices[:1]])
            for wall in inside
            if wall.pitch_contour is not wall.contour
        ]
        return outlines(self.facts.headline, [wall.outline for wall in self.walls], pitches)
