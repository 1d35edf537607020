"""The yoke cam: a plate between two faces or rollers, of constant breadth or diameter."""

from __future__ import annotations

import math
from collections.abc import Iterator, Mapping, Sequence
from dataclasses import replace
from typing import TYPE_CHECKING, Any, ClassVar, Final

import numpy as np

from gearcam.base.errors import Adjustment, beyond_limit
from gearcam.base.facts import Fact
from gearcam.base.numerals import formatted
from gearcam.cams.disc import YokeCam, make_yoke
from gearcam.designs.faults import Fault, show
from gearcam.kinds.cam.forms.base import FORMS, PLATE, Keys
from gearcam.kinds.cam.forms.disc import Disc, disc_cam
from gearcam.laws.half_turns import agreeing, completed, miss
from gearcam.laws.phases_of_lift import fill_half
from gearcam.laws.program import Program, make_program
from gearcam.numeric.pose import Pose
from gearcam.pictures.drawings import FOLLOWER, Feature, placed

if TYPE_CHECKING:
    from gearcam.base.tolerances import Tolerances
    from gearcam.kinds.cam.build import CamResult
    from gearcam.kinds.cam.design import CamDesign
    from gearcam.kinds.cam.motion import Motion
    from gearcam.pictures.drawings import Drawing

_MISS: Final = 1e-6
"""Largest deviation of two half turns from being opposite, mm: rounding of typed digits."""


class Yoke(Disc):
    """A plate with one wall that is touched on both sides of its axis."""

    name = "yoke"
    doc = "a plate between two faces or rollers, of constant breadth or diameter"
    # with an offset one cam cannot drive two rollers, and offset faces change nothing
    takes: ClassVar[Keys] = {
        **PLATE, "follower": tuple(name for name in PLATE["follower"] if name != "offset")
    }  # fmt: skip
    half_turns = True
    rows = ("cam.breadth_mm", "cam.roller_distance_mm", "cam.face_width_mm")

    def faults(self, parts: Mapping[str, Any]) -> Iterator[Fault]:
        """Yield what is wrong with the follower of a yoke cam."""
        follower = parts["follower"]
        if follower.oscillating:
            message = f"{show(follower.motion)}: a yoke is a translating follower"
            rule = '"translating"'
            yield Fault(("follower", "motion"), message, follower.motion, rule)

    def program(self, design: CamDesign, tolerances: Tolerances) -> Program:
        """Return the lift over a turn: half of it and its opposite, or two opposite half turns."""
        motion = design.motion
        if isinstance(motion, Sequence) and fill_half(motion):
            return completed(make_program(motion, tolerances, half=True))
        made = super().program(design, tolerances)
        _demand_opposite(made, motion)
        return made

    def make(self, design: CamDesign, program: Program) -> YokeCam:
        """Return the cam."""
        return make_yoke(disc_cam(design, program))

    def picture(self, result: CamResult) -> Drawing:
        """Return the plate, turned, between the two sides of its follower."""
        from gearcam.kinds.cam.drawn import follower

        (wall,), pose = result.cam.walls, result.design.output.pose
        reach = float(np.hypot(*result.profile.vertices.T).max())
        other = follower(wall, pose + math.pi, reach)
        drawing = super().picture(result)
        second = (Feature(layer=FOLLOWER, shape=placed(shape, Pose(math.pi))) for shape in other)
        return replace(drawing, features=(*drawing.features, *second))

    def facts(self, result: CamResult) -> dict[str, Any]:
        """Return the facts of a disc cam, and the distance of both sides of the follower."""
        cam, flat = result.cam, not result.follower.has_centre
        if not isinstance(cam, YokeCam):
            raise TypeError(f"{cam!r} is not a yoke cam")
        return {
            **super().facts(result),
            "breadth_mm": Fact(cam.breadth, "distance between the faces", shown=True)
            if flat
            else None,
            "face_width_mm": cam.face_width and Fact(cam.face_width, "least width of the faces"),
            "least_base_radius_mm": cam.least_base_radius,
            "roller_distance_mm": None
            if flat
            else Fact(cam.breadth, "distance between the centres of the rollers", shown=True),
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
        from gearcam.kinds.cam.motion import motion_of

        phases: Any = motion_of(half, ("translating", "turning"))
        told = ", ".join(f"{one['type']} {formatted(one['angle_deg'])} deg" for one in phases)
        rule += f", and these agree best with the first half: {told}"
        adjustments = (Adjustment(near={"motion": phases}),)
    what = "the two half turns of a yoke's lift are not opposite to each other"
    where = f"motion, at {formatted(math.degrees(off.theta))} deg"
    raise beyond_limit(what, where, off.value, _MISS, rule, adjustments=adjustments, unit="mm")


FORMS.register(Yoke())
