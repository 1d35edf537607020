"""The yoke cam: a plate between two faces or rollers, of constant breadth or diameter."""

from __future__ import annotations

import math
from collections.abc import Sequence
from dataclasses import dataclass, replace
from typing import TYPE_CHECKING, Any, Final

from gearcam.base.adjustments import Adjustment
from gearcam.base.errors import beyond_limit
from gearcam.base.facts import Fact
from gearcam.base.numerals import formatted
from gearcam.base.quantities import fixed
from gearcam.base.rules import excluded
from gearcam.cams.disc import YokeCam, make_yoke
from gearcam.cams.spec import FACE_RULES, GUIDE_RULES, CamSpec, FollowerSpec, form_param
from gearcam.designs.nodes import written
from gearcam.kinds.cam.forms.base import Form
from gearcam.kinds.cam.forms.disc import Plates
from gearcam.laws.half_turns import agreeing, completed, miss
from gearcam.laws.phases_of_lift import fill_half
from gearcam.laws.program import Program, make_program
from gearcam.numeric.pose import Pose
from gearcam.pictures.drawings import FOLLOWER, Feature, placed

if TYPE_CHECKING:
    from gearcam.base.tolerances import Tolerances
    from gearcam.kinds.cam.forms.base import Parts
    from gearcam.kinds.cam.motion import Motion
    from gearcam.numeric.contour import Contour
    from gearcam.pictures.drawings import Drawing

_MISS: Final = 1e-6
"""Largest deviation of two half turns from being opposite, mm: rounding of typed digits."""


@dataclass(frozen=True, kw_only=True)
class YokeFollower(FollowerSpec):
    """A follower with two faces or two rollers, one on each side of the cam's axis.

    Attributes
    ----------
    offset : float, mm
        With one a cam cannot drive two rollers, and offset faces change nothing.

    Examples
    --------
    >>> import gearcam as gc
    >>> gc.YokeFollower(type="flat")
    YokeFollower(type='flat')
    """

    offset: float = fixed(0.0)

    rules = (
        *GUIDE_RULES,
        *FACE_RULES,
        excluded(
            "motion", "oscillating", why="a yoke is a translating follower", allowed='"translating"'
        ),
    )

    def facts_of(self, cam: YokeCam) -> dict[str, Any]:
        """Return the distance of its two faces, or of its rollers, as facts."""
        faces = Fact(cam.breadth, "distance between the faces", shown=True)
        rollers = Fact(cam.breadth, "distance between the centres of the rollers", shown=True)
        return {
            "breadth_mm": faces if self.flat else None,
            "roller_distance_mm": None if self.flat else rollers,
        }


@dataclass(frozen=True, kw_only=True)
class YokeSpec(CamSpec):
    """A cam of the form yoke: a plate that its follower touches on both sides of the axis.

    Examples
    --------
    >>> import gearcam as gc
    >>> gc.YokeSpec(base_radius=30.0)
    YokeSpec(base_radius=30)
    """

    form: str = form_param("yoke")


class Yoke(Plates[YokeCam, YokeSpec, YokeFollower]):
    """A plate with one wall that is touched on both sides of its axis."""

    name = "yoke"
    doc = "a plate between two faces or rollers, of constant breadth or diameter"
    tables = Form.tables | {"follower": YokeFollower, "cam": YokeSpec}
    half_turns = True
    rows = ("cam.breadth_mm", "cam.roller_distance_mm", "cam.face_width_mm")

    def program(self, tolerances: Tolerances) -> Program:
        """Return the lift over a turn: half of it and its opposite, or two opposite half turns."""
        motion = self.design.motion
        if isinstance(motion, Sequence) and fill_half(motion):
            return completed(make_program(motion, tolerances, half=True))
        program = super().program(tolerances)
        _demand_opposite(program, motion)
        return program

    def make(self, program: Program) -> YokeCam:
        """Return the cam."""
        return make_yoke(self.disc(program))

    def picture(self, cam: YokeCam, parts: Parts) -> Drawing:
        """Return the plate, turned, between the two sides of its follower (see `Form.picture`)."""
        from gearcam.kinds.cam.drawings import follower

        (wall,), drawing = cam.walls, super().picture(cam, parts)
        other = follower(wall, self.output.pose + math.pi, wall.contour.reach)
        second = (Feature(layer=FOLLOWER, shape=placed(shape, Pose(math.pi))) for shape in other)
        return replace(drawing, features=(*drawing.features, *second))

    def sizes(self, cam: YokeCam) -> dict[str, Any]:
        """Return the sizes of a `cam`, as facts; its follower has no offset."""
        return {**super().sizes(cam), "offset_mm": None}

    def facts(self, cam: YokeCam, made: Sequence[Contour]) -> dict[str, Any]:
        """Return the facts of a disc cam, and the distance of both sides (see `Form.facts`)."""
        return {
            **super().facts(cam, made),
            **self.follower.facts_of(cam),
            "face_width_mm": cam.face_width and Fact(cam.face_width, "least width of the faces"),
            "least_base_radius_mm": cam.least_base_radius,
        }


def _demand_opposite(program: Program, motion: Motion) -> None:
    """Refuse a turn whose second half is not the opposite of the first."""
    off = miss(program)
    if abs(off.value) <= _MISS:
        return
    rule = "half a turn later the lift must be the total lift less the present one; phases of half "
    rule += "a turn, 180 deg, are enough"
    adjustments: tuple[Adjustment, ...] = ()
    half = agreeing(motion) if isinstance(motion, Sequence) else ()
    if half:
        from gearcam.kinds.cam.motion import MOTION

        phases: Any = written(MOTION, half, dict.fromkeys(("translating", "turning"), ""))
        fitting = ", ".join(f"{one['type']} {formatted(one['angle_deg'])} deg" for one in phases)
        rule += f", and these agree best with the first half: {fitting}"
        adjustments = (Adjustment(near={"motion": phases}),)
    what = "the two half turns of a yoke's lift are not opposite to each other"
    where = f"motion, at {formatted(math.degrees(off.theta))} deg"
    raise beyond_limit(what, where, off.value, _MISS, rule, adjustments=adjustments, unit="mm")


ENTRIES: Final = (Yoke,)
