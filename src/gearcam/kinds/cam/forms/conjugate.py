"""Conjugate cams: two plates on one shaft, each driving its own roller of one follower."""

from __future__ import annotations

import math
from collections.abc import Iterator, Mapping, Sequence
from dataclasses import dataclass, replace
from typing import TYPE_CHECKING, Any, Final

from gearcam.base.facts import Fact
from gearcam.base.quantities import ANGLE, LENGTH, LONGEST, NONE, param, positive_length
from gearcam.base.rules import Breach, only_with
from gearcam.cams.conjugate import ConjugateCam, SecondRoller, make_conjugate
from gearcam.cams.placing import make_round_follower
from gearcam.cams.spec import (
    SECOND_ROLLER,
    CamSpec,
    FollowerSpec,
    form_param,
)
from gearcam.designs.faults import Fault
from gearcam.kinds.cam.forms.base import Form
from gearcam.kinds.cam.forms.disc import Plates
from gearcam.kinds.cam.wall_facts import curvature, pressure, size, start_angle, trimming

if TYPE_CHECKING:
    from gearcam.kinds.cam.forms.base import Parts
    from gearcam.laws.program import Program
    from gearcam.numeric.contour import Contour
    from gearcam.parts.body import Part
    from gearcam.pictures.drawings import Drawing

_OF_SECOND = (
    "prime_radius_mm",
    "base_radius_mm",
    "roller_radius_mm",
    "arm_mm",
    "pressure_angle_deg.rise_max",
    "pressure_angle_deg.return_max",
)
"""Facts of the second cam that replace those of the first in the table of its drawing."""


@dataclass(frozen=True, kw_only=True)
class ConjugateFollower(FollowerSpec):
    """A follower with two rollers, one on each of conjugate cams.

    Examples
    --------
    >>> import gearcam as gc
    >>> gc.ConjugateFollower(type="roller", roller_radius=8.0, roller_distance=90.0)
    ConjugateFollower(type='roller', roller_radius=8, roller_distance=90)
    """

    roller2_radius: float | None = positive_length(example=6, doc=SECOND_ROLLER)
    arm2: float | None = positive_length(
        example=60,
        doc="distance from the pivot to the roller on the second of conjugate cams; arm_mm if left "
        "out",
    )
    roller_distance: float | None = positive_length(
        example=85, doc="distance of the two rollers of a translating follower on conjugate cams"
    )
    arms_angle: float | None = param(
        ANGLE,
        default=None,
        gt=0,
        lt=360,
        example=80,
        doc="angle between the two arms of an oscillating follower on conjugate cams",
    )
    preload: float = param(
        LENGTH,
        default=0.0,
        ge=0,
        le=10,
        doc="how much closer than nominal the rollers of conjugate cams are mounted, so that "
        "they are pressed apart when fitted",
    )

    rules = (
        *FollowerSpec.rules,
        only_with(
            ("arms_angle", "arm2"), "motion", "oscillating", why="does not apply to a {} follower"
        ),
        only_with(
            ("roller_distance",), "motion", "translating", why="does not apply to an {} follower"
        ),
    )

    @property
    def apart(self) -> float | None:
        """Distance of the rollers, mm, or angle between their arms, rad, if it is given."""
        return self.arms_angle if self.oscillating else self.roller_distance

    @property
    def apart_key(self) -> str:
        """The key of this distance or angle."""
        return "arms_angle_deg" if self.oscillating else "roller_distance_mm"

    def second(self, prime: float | None) -> SecondRoller:
        """Return the second roller, with the `prime` radius of its cam, mm, if that is given."""
        return SecondRoller(
            radius=self.roller2_radius or self.radius,
            arm=(self.arm2 or self.arm or 0.0) if self.oscillating else 0.0,
            prime=prime,
            apart=self.apart,
            preload=self.preload,
        )

    def facts_of(self, cam: ConjugateCam) -> dict[str, Any]:
        """Return the distance of the rollers, or the angle between their arms, as facts."""
        distance = Fact(cam.apart, "distance between the centres of the rollers", shown=True)
        angle = Fact(math.degrees(cam.apart), "angle between the arms", unit="deg", shown=True)
        return {
            "roller_distance_mm": None if self.oscillating else distance,
            "arms_angle_deg": angle if self.oscillating else None,
        }

    def problems(self) -> Iterator[Breach]:
        """Yield contradictions: field, index, message, what is allowed."""
        yield from super().problems()
        if self.type != "roller":
            yield "type", None, "conjugate cams drive two rollers", '"roller"'


@dataclass(frozen=True, kw_only=True)
class ConjugateSpec(CamSpec):
    """Cams of the form conjugate: two plates on one shaft.

    Examples
    --------
    >>> import gearcam as gc
    >>> gc.ConjugateSpec(prime_radius=40.0, prime_radius2=45.0, gap=2.0)
    ConjugateSpec(prime_radius=40, prime_radius2=45, gap=2)
    """

    form: str = form_param("conjugate")
    prime_radius2: float | None = positive_length(
        example=45,
        doc="from the axis to the centre of conjugate cams' second roller, at the highest lift",
    )
    gap: float = param(LENGTH, default=0.0, ge=0, le=LONGEST, doc="gap between conjugate cams")


class Conjugate(Plates[ConjugateCam, ConjugateSpec, ConjugateFollower]):
    """Two plates, each with one wall."""

    name = "conjugate"
    doc = "two plates on one shaft, each with a roller of one follower"
    tables = Form.tables | {
        "follower": ConjugateFollower,
        "cam": ConjugateSpec,
    }
    rows = ("cam.roller_distance_mm", "cam.arms_angle_deg", "cam.preload_mm")

    @classmethod
    def faults(cls, parts: Mapping[str, Any], document: Mapping[str, Any]) -> Iterator[Fault]:
        """Yield contradictions between the tables of a design (see `Form.faults`)."""
        yield from super().faults(parts, document)
        prime, follower = parts["cam"].prime_radius2, parts["follower"]
        if prime is None and follower.apart is None:
            rule = f"cam.prime_radius2_mm or follower.{follower.apart_key}"
            yield Fault(("cam", "prime_radius2_mm"), "is missing for a conjugate cam", allowed=rule)
        elif prime is not None and follower.apart is not None:
            rule = f"one of cam.prime_radius2_mm and follower.{follower.apart_key}"
            message = "is given beside cam.prime_radius2_mm"
            yield Fault(("follower", follower.apart_key), message, allowed=rule)

    def make(self, program: Program) -> ConjugateCam:
        """Return the cams."""
        return make_conjugate(
            program,
            make_round_follower(self.follower, self.given),
            self.follower.second(self.given.prime_radius2),
            clockwise=self.given.clockwise,
            tolerance=self.chord_tolerance,
        )

    def parts(self, cam: ConjugateCam) -> tuple[Part, ...]:
        """Return both plates in one frame, with hubs on their outer faces only."""
        blanks = [replace(self.blank, **{inner: 0.0}) for inner in ("hub_front", "hub_back")]
        return tuple(
            self.plate(
                f"cam{wall.key}",
                wall,
                blank
                if blank.hub_front or blank.hub_back
                else replace(blank, hub_diameter=0.0, set_screw=NONE),
            )
            for wall, blank in zip(cam.walls, blanks, strict=True)
        )

    def heights(self) -> tuple[float, ...]:
        """Return 0 and the height of the second plate, which is above the first one and the gap."""
        return 0.0, self.given.thickness + self.given.gap

    def primes(self, cam: ConjugateCam) -> tuple[float, float]:
        """Return the prime radii of both cams, mm; the second is that at the highest lift."""
        return cam.first.follower.prime_radius, cam.prime2

    def picture(self, cam: ConjugateCam, parts: Parts) -> Drawing:
        """Return both plates, turned, with their follower (see `Form.picture`)."""
        from gearcam.kinds.cam.drawings import follower, plate
        from gearcam.pictures.drawings import CENTER, FOLLOWER, Drawing

        pose, reach = self.output.pose, max(wall.contour.reach for wall in cam.walls)
        plates, others = [], []
        for part, wall, prime in zip(parts, cam.walls, self.primes(cam), strict=True):
            shapes = follower(wall, pose, reach)
            for feature in plate(part, wall, prime, shapes, angle=wall.hand * pose).features:
                if feature.layer in (CENTER, FOLLOWER):
                    others.append(feature)
                else:
                    plates.append(replace(feature, layer=f"{part.name.upper()}_{feature.layer}"))
        return Drawing(name="cams", features=(*plates, *others))

    def facts(self, cam: ConjugateCam, made: Sequence[Contour]) -> dict[str, Any]:
        """Return the place of the second roller, and both cams (see `Form.facts`)."""
        second = cam.second.follower
        first_facts, second_facts = (
            {
                "curvature": curvature(wall),
                "start_angle_deg": start_angle(wall),
                **trimming(wall),
                "profile": size(wall, finished, self.blank.clearance),
            }
            for wall, finished in zip(cam.walls, made, strict=True)
        )
        own = {
            "prime_radius_mm": Fact(cam.prime2, "prime radius"),
            "base_radius_mm": Fact(cam.prime2 - second.radius, "base radius"),
            "roller_radius_mm": second.radius,
            "arm_mm": self.follower.second(None).arm or None,
            "pressure_angle_deg": pressure(cam.second, self.design.limits),
        }
        return {
            "gap_mm": self.given.gap,
            **self.follower.facts_of(cam),
            "preload_mm": self.follower.preload or None,
            "cam1": first_facts,
            "cam2": own | second_facts,
        }

    def rows_of(self, number: int) -> Sequence[str]:
        """Return the facts in the table of a plate's drawing."""
        cam, own = f"cam.cam{number + 1}.", [f"cam.{name}" for name in _OF_SECOND]
        names = (name.replace("cam.profile.", f"{cam}profile.") for name in super().rows_of(number))
        own_names = (
            name.replace("cam.", cam) if name in own and number else name for name in names
        )
        return [name.replace("part.", f"part.{number}.") for name in own_names]


ENTRIES: Final = (Conjugate,)
