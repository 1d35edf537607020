"""Conjugate cams: two plates on one shaft, each driving its own roller of one follower."""

from __future__ import annotations

import math
from collections.abc import Iterator, Mapping
from dataclasses import replace
from typing import TYPE_CHECKING, Any

import numpy as np

from gearcam.base.facts import Fact
from gearcam.cams.conjugate import ConjugateCam, SecondRoller, make_conjugate
from gearcam.cams.disc import CHORD_TOLERANCE
from gearcam.cams.placing import make_round_follower
from gearcam.designs.faults import Fault, show
from gearcam.kinds.cam.facts import pressure
from gearcam.kinds.cam.forms.base import FORMS, plate_keys
from gearcam.kinds.cam.forms.disc import TOOL_PATH, Disc, plate_part
from gearcam.kinds.cam.wall_facts import curvature, size, trimming

if TYPE_CHECKING:
    from gearcam.cams.spec import CamSpec, FollowerSpec
    from gearcam.kinds.cam.build import CamResult
    from gearcam.kinds.cam.design import CamDesign
    from gearcam.laws.program import Program
    from gearcam.numeric.contour import Contour
    from gearcam.parts.body import Part
    from gearcam.pictures.drawings import Drawing

_SECOND = ("roller2_radius", "arm2", "roller_distance", "arms_angle", "preload")

_OF_SECOND = (
    "prime_radius_mm", "base_radius_mm", "roller_radius_mm", "arm_mm",
    "pressure_angle_deg.rise_max", "pressure_angle_deg.return_max",
)  # fmt: skip
"""Facts of the second cam that replace those of the first in the table of its drawing."""


class Conjugate(Disc):
    """Two plates, each with one wall."""

    name = "conjugate"
    doc = "two plates on one shaft, each with a roller of one follower"
    takes = plate_keys(cam=("prime_radius2", "gap"), follower=_SECOND)
    assembly = "cams"
    rows = ("cam.roller_distance_mm", "cam.arms_angle_deg", "cam.preload_mm")

    def faults(self, parts: Mapping[str, Any]) -> Iterator[Fault]:
        """Yield what is wrong with the two rollers of the follower."""
        follower, cam = parts["follower"], parts["cam"]
        if follower.type != "roller":
            message = f"{show(follower.type)}: conjugate cams drive two rollers"
            yield Fault(("follower", "type"), message, follower.type, '"roller"')
        own, other = ("arms_angle", "roller_distance")[:: 1 if follower.oscillating else -1]
        keys = {"arms_angle": "arms_angle_deg", "roller_distance": "roller_distance_mm"}
        article = "an oscillating" if follower.oscillating else "a translating"
        if getattr(follower, other) is not None:
            message = f"does not apply to {article} follower"
            yield Fault(("follower", keys[other]), message, allowed=f"{keys[own]} instead")
        if follower.arm2 is not None and not follower.oscillating:
            message = "does not apply to a translating follower"
            yield Fault(("follower", "arm2_mm"), message, allowed='with motion = "oscillating"')
        yield from _place_faults(cam.prime_radius2, getattr(follower, own), keys[own])

    def make(self, design: CamDesign, program: Program) -> ConjugateCam:
        """Return the cams."""
        follower, cam = design.follower, design.cam
        return make_conjugate(
            program,
            make_round_follower(follower, cam),
            _second(follower, cam),
            clockwise=cam.clockwise,
            tolerance=design.output.chord_tolerance or CHORD_TOLERANCE,
        )

    def parts(self, result: CamResult) -> tuple[Part, ...]:
        """Return both plates in one frame, with hubs on their outer faces only."""
        thickness = result.design.cam.thickness
        blank = result.design.blank
        hubs = ({"hub_front": 0.0}, {"hub_back": 0.0})
        own = [replace(blank, **outer) for outer in hubs]
        bare = {"hub_diameter": 0.0}
        return tuple(
            plate_part(
                result,
                f"cam{wall.key}",
                profile,
                thickness,
                each if each.hub_front or each.hub_back else replace(each, **bare),
            )
            for wall, profile, each in zip(result.cam.walls, result.profiles, own, strict=True)
        )

    def heights(self, result: CamResult) -> tuple[float, ...]:
        """Return 0 and the height of the second plate, which is above the first one and the gap."""
        cam = result.design.cam
        return 0.0, cam.thickness + (cam.gap or 0.0)

    def drawings(self, result: CamResult) -> tuple[Drawing, ...]:
        """Return each plate with its pitch curve and prime circle."""
        from gearcam.kinds.cam.drawn import plate

        rows = zip(result.parts, result.cam.walls, _primes(result), strict=True)
        return tuple(plate(part, wall, prime=prime) for part, wall, prime in rows)

    def picture(self, result: CamResult) -> Drawing:
        """Return both plates, turned, with their follower."""
        from gearcam.kinds.cam.drawn import follower, plate
        from gearcam.pictures.drawings import CENTER, FOLLOWER, Drawing

        pose = result.design.output.pose
        reach = max(float(np.hypot(*one.vertices.T).max()) for one in result.profiles)
        plates, others = [], []
        for part, wall, prime in zip(result.parts, result.cam.walls, _primes(result), strict=True):
            side = -1.0 if wall.clockwise else 1.0
            shapes = follower(wall, pose, reach)
            for one in plate(part, wall, shapes, angle=side * pose, prime=prime).features:
                if one.layer in (CENTER, FOLLOWER):
                    others.append(one)
                else:
                    plates.append(replace(one, layer=f"{part.name.upper()}_{one.layer}"))
        return Drawing(name=self.assembly, features=(*plates, *others))

    def paths(self, result: CamResult, radius: float | None) -> Mapping[str, Contour]:
        """Return the path around each plate; the cutter's default `radius` is the roller's."""
        from gearcam.kinds.cam.drawn import cutter_way

        return {
            f"{TOOL_PATH}_{wall.key}": cutter_way(part.contour, radius or wall.follower.radius)
            for wall, part in zip(result.cam.walls, result.parts, strict=True)
        }

    def facts(self, result: CamResult) -> dict[str, Any]:
        """Return the place of the second roller, and both cams."""
        cam, design = _cam(result), result.design
        second, swings = cam.second.follower, cam.first.follower.angular
        clearance = design.blank.clearance
        told = [
            {
                "curvature": curvature(wall),
                **trimming(wall),
                "profile": size(wall, made, clearance),
            }
            for wall, made in zip(cam.walls, result.contours, strict=True)
        ]
        own = {
            "prime_radius_mm": Fact(cam.prime2, "prime radius"),
            "base_radius_mm": Fact(cam.prime2 - second.radius, "base radius"),
            "roller_radius_mm": second.radius,
            "arm_mm": second.lever if swings else None,
            "pressure_angle_deg": pressure(result, cam.second),
        }
        return {
            "gap_mm": design.cam.gap or 0.0,
            "roller_distance_mm": None
            if swings
            else Fact(cam.apart, "distance between the centres of the rollers", shown=True),
            "arms_angle_deg": Fact(
                math.degrees(cam.apart), "angle between the arms", unit="deg", shown=True
            )
            if swings
            else None,
            "preload_mm": design.follower.preload or None,
            "cam1": told[0],
            "cam2": own | told[1],
        }

    def rows_of(self, number: int, rows: tuple[str, ...]) -> tuple[str, ...]:
        """Return the facts in the table of a plate's drawing."""
        cam, own = f"cam.cam{number + 1}.", [f"cam.{name}" for name in _OF_SECOND]
        found = [
            name.replace("cam.", cam) if name in own and number else name
            for name in (name.replace("cam.profile.", f"{cam}profile.") for name in rows)
        ]
        return (*(name.replace("part.", f"part.{number}.") for name in found), *self.rows)


def _place_faults(prime: float | None, apart: float | None, key: str) -> Iterator[Fault]:
    if prime is None and apart is None:
        rule = f"cam.prime_radius2_mm or follower.{key}"
        yield Fault(("cam", "prime_radius2_mm"), "is missing for a conjugate cam", allowed=rule)
    elif prime is not None and apart is not None:
        rule = f"one of cam.prime_radius2_mm and follower.{key}"
        yield Fault(("follower", key), "is given beside cam.prime_radius2_mm", allowed=rule)


def _second(follower: FollowerSpec, cam: CamSpec) -> SecondRoller:
    swings = follower.oscillating
    return SecondRoller(
        radius=follower.roller2_radius or follower.radius,
        arm=(follower.arm2 or follower.arm or 0.0) if swings else 0.0,
        prime=cam.prime_radius2,
        apart=follower.arms_angle if swings else follower.roller_distance,
        preload=follower.preload or 0.0,
    )


def _cam(result: CamResult) -> ConjugateCam:
    """Return the cams, which are of this form."""
    cam = result.cam
    if not isinstance(cam, ConjugateCam):
        raise TypeError(f"{cam!r} is not a pair of conjugate cams")
    return cam


def _primes(result: CamResult) -> tuple[float, float]:
    cam = _cam(result)
    return cam.first.follower.prime_radius, cam.prime2


FORMS.register(Conjugate())
