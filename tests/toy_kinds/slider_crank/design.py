"""A kind of design that only a test knows: a slider-crank behind a gear pair or a cam.

The crank is fixed to the driven wheel or to the shaft of an oscillating follower; the rod joins its
pin and a slider. A translating follower carries the pin itself. The guide of the slider is parallel
to x; the origin is the shaft of the crank.
"""

from __future__ import annotations

from dataclasses import dataclass, field
from functools import cached_property
from typing import Any

import numpy as np

import gearcam
from gearcam.base.adjustments import Adjustment
from gearcam.base.errors import InfeasibleError
from gearcam.base.facts import Fact, Facts, extent
from gearcam.base.findings import Finding, in_order
from gearcam.base.quantities import ANGLE, LENGTH, nested, param
from gearcam.base.rules import exactly_one
from gearcam.designs.design import Design
from gearcam.designs.outputs import OutputSpec, files_param, studies_param
from gearcam.export.table import table_bytes
from gearcam.numeric.arrays import Array, Plane
from gearcam.numeric.pose import Pose
from gearcam.pictures.charts import Chart, Line
from gearcam.pictures.drawings import CENTER, FOLLOWER, Cross, Feature, Path
from gearcam.pictures.scenes import PLACES, MovingBody, Scene, still
from gearcam.report.file import report_files
from gearcam.results.kind import Kind
from gearcam.results.nested import placed, within
from gearcam.results.result import Result, StudyResult

FORMATS = ("csv", "report")
STEEPEST = 45.0
"""Angle between rod and guide from which a finding warns, deg."""


@dataclass(frozen=True, kw_only=True)
class DriveSpec:
    pair: Design | None = nested(
        "gear-pair", default=None, example="pair.toml", doc="the pair whose wheel 2 has the crank"
    )
    cam: Design | None = nested(
        "cam", default=None, example="cam.toml", doc="the cam whose follower has the crank"
    )

    rules = (exactly_one("pair", "cam"),)

    @property
    def key(self) -> str:
        return "pair" if self.pair is not None else "cam"


@dataclass(frozen=True, kw_only=True)
class CrankSpec:
    length: float = param(LENGTH, gt=0, le=1000, doc="from the shaft to the pin")
    angle: float = param(ANGLE, default=0.0, ge=-360, le=360, doc="at the drive's zero")


@dataclass(frozen=True, kw_only=True)
class RodSpec:
    length: float = param(LENGTH, gt=0, le=10000, doc="from pin to slider")
    offset: float = param(LENGTH, default=0.0, ge=-1000, le=1000, doc="of the guide, towards +y")


@dataclass(frozen=True, kw_only=True)
class StrokeSpec:
    step: float = param(ANGLE, default=np.radians(1.0), gt=0, le=90, doc="step of the table")


@dataclass(frozen=True, kw_only=True)
class SliderOutput(OutputSpec):
    files: tuple[str, ...] = files_param(FORMATS, "slider-crank")
    studies: tuple[str, ...] = studies_param("slider-crank")


@dataclass(frozen=True, eq=False, repr=False, kw_only=True)
class SliderCrankDesign(Design):
    kind = "slider-crank"

    drive: DriveSpec
    crank: CrankSpec
    rod: RodSpec
    output: SliderOutput = field(default_factory=SliderOutput)
    stroke: StrokeSpec = field(default_factory=StrokeSpec)


class SliderCrank(Result):
    stages = {"drive": "places", "motion": "motion", "checks": "checked"}  # noqa: RUF012

    @property
    def at(self) -> str:
        return f"drive.{self.design.drive.key}"

    @cached_property
    def driven(self) -> Any:
        drive = self.design.drive
        return gearcam.build(drive.pair or drive.cam)

    @cached_property
    def places(self) -> Array:
        """Places of the driver in the unit of its axis."""
        with within(self.at):
            return next(iter(self.driven.motion().values()))

    @property
    def slides(self) -> bool:
        cam = self.design.drive.cam
        return cam is not None and cam.follower.motion == "translating"

    def pin(self, places: Array) -> tuple[Plane, Plane]:
        """The pin at places of the driver, and its derivative by the driver's angle or travel."""
        drive, crank = self.design.drive, self.design.crank
        over = places if drive.cam is not None and "travel_mm" in self.driven.motion() else None
        with within(self.at):
            found = self.driven.motion(np.radians(places) if over is None else over)
        _, moved, rate, *_ = found.values()
        arm = crank.length * np.exp(1j * crank.angle)
        if self.slides:
            return arm + 1j * moved, 1j * rate + 0.0 * arm
        if "travel_mm" in found:
            raise InfeasibleError("a rack does not turn a crank", where="drive.pair")
        if drive.pair is not None:
            side = -1.0 if drive.pair.pair.type == "internal" else 1.0
        else:
            side = 1.0 if self.driven.design.cam.rotation == "cw" else -1.0
            rate = np.radians(rate)
        pin = arm * np.exp(1j * side * np.radians(moved))
        return pin, 1j * side * rate * pin

    def slide(self, places: Array) -> tuple[Array, Array, Array, Plane]:
        """Slider, its derivative, the rod's angle, rad, and the pin, at places of the driver."""
        rod = self.design.rod
        pin, rate = self.pin(places)
        height = rod.offset - pin.imag
        worst = int(np.argmax(np.abs(height)))
        if abs(height[worst]) >= rod.length:
            least = float(abs(height[worst]))
            raise InfeasibleError(
                "the rod is too short to reach the guide",
                where=f"rod.length_mm, driver at {places[worst]:.6g}",
                value=rod.length,
                limit=least,
                unit="mm",
                adjustments=(
                    Adjustment(
                        near={"rod.length_mm": 1.01 * least}, far={"rod.length_mm": 4 * least}
                    ),
                ),
            )
        angle = np.arcsin(height / rod.length)
        along = pin.real + rod.length * np.cos(angle)
        return along, rate.real + np.tan(angle) * rate.imag, angle, pin

    @cached_property
    def motion(self) -> dict[str, Array]:
        along, rate, angle, _ = self.slide(self.places)
        name, *_ = self.driven.motion()
        return {name: self.places, "slider_mm": along, "rate": rate, "rod_deg": np.degrees(angle)}

    def standing(self, chords: float = 0.0) -> dict[str, Any]:
        with within(self.at):
            return self.driven.standing(chords)

    @cached_property
    def checked(self) -> tuple[Finding, ...]:
        with within(self.at):
            below = placed(self.at, self.driven.checked)
        steepest = float(np.abs(self.motion["rod_deg"]).max())
        own = Finding(
            code="rod-angle",
            severity="warning",
            message="The rod presses the slider hard against its guide.",
            value=steepest,
            limit=STEEPEST,
            unit="deg",
        )
        return in_order((*below, *((own,) if steepest > STEEPEST else ())))


def facts(result: Any) -> Facts:
    along, rate = result.motion["slider_mm"], result.motion["rate"]
    low, high = float(along.min()), float(along.max())
    tree = {
        "drive": {"kind": result.driven.design.kind, "name": result.driven.design.name},
        "slider": {
            "stroke_mm": Fact(high - low, "stroke", shown=True),
            "place_mm": extent(low, high),
            "rate_max": Fact(float(np.abs(rate).max()), "largest rate", unit="mm per driver"),
        },
    }
    return Facts(tree, ["slider.stroke_mm"], "slider-crank")


def motion_chart(result: Any) -> Chart:
    places, along, *_ = result.motion.values()
    driver = result.driven.scene(4).driver
    line = Line(label="slider", x=places, y=along)
    return Chart(title="Place of the slider", x=driver, y="x, mm", lines=(line,))


def scene(result: Any, places: int = PLACES) -> Scene:
    with within(result.at):
        around = result.driven.scene(places)
    along, _, angle, pin = result.slide(around.places)
    design = result.design
    if design.drive.pair is not None:
        shaft = next(one.pose.shift[0] for one in around.bodies if one.name == "gear2")
    else:
        by = design.drive.cam
        height = getattr(by.follower, "pivot_height", None) or 0.0
        shaft = complex(by.follower.pivot_distance or 0.0, height)
        if by.cam.rotation == "cw":  # the mirror image of a cam that turns counter-clockwise
            shaft = -shaft.conjugate()
    size = 0.25 * design.crank.length
    fixed = np.zeros(len(around.places), dtype=np.complex128) + shaft
    turn, flat = np.unwrap(np.angle(pin)), np.zeros(len(along))
    box = size * np.array([-1.5 - 1j, 1.5 - 1j, 1.5 + 1j, -1.5 + 1j])
    made = [
        _body("rod", [0.0, design.rod.length], 0.2 * size, angle, pin + shaft),
        _body("slider", box, 0.0, flat, along + 1j * design.rod.offset + shaft),
    ]
    if not result.slides:
        made.insert(0, _body("crank", [0.0, design.crank.length], 0.3 * size, turn, fixed))
    cross = Cross(center=shaft, size=size)
    made.append(still((Feature(layer=CENTER, shape=cross),), around.places))
    return Scene(
        title=design.name,
        driver=around.driver,
        places=around.places,
        closed=around.closed,
        start=around.start,
        bodies=(*around.bodies, *made),
        contacts=around.contacts,
        pitch=around.pitch,
    )


def _body(name: str, points: Any, half: float, turn: Array, shift: Plane) -> MovingBody:
    """A bar with rounded ends between two points, or a polygon, drawn as a follower is."""
    if half:
        bend = half * np.exp(1j * np.linspace(-0.5 * np.pi, 0.5 * np.pi, 13))
        points = np.concatenate([points[1] + bend, points[0] - bend])
    path = Path(points=np.asarray(points, dtype=np.complex128))
    shape = (Feature(layer=FOLLOWER, shape=path),)
    return MovingBody(name=name, called=name, features=shape, pose=Pose(turn, shift))


def _stroke(result: Any, _: Any) -> StudyResult:
    places = result.places
    count = max(2, round(np.radians(places[-1] - places[0]) / result.design.stroke.step) + 1)
    asked = np.linspace(places[0], places[-1], count)
    along, rate, angle, _ = result.slide(asked)
    name, *_ = result.driven.motion()
    at = int(np.argmax(np.abs(rate)))
    fast = Fact(float(rate[at]), "fastest", unit="mm per driver", place=f"{asked[at]:.6g}")
    return StudyResult(
        result=result,
        study=result.kind.studies["slide"],
        file="slider.csv",
        table={name: asked, "slider_mm": along, "rate": rate, "rod_deg": np.degrees(angle)},
        group={"rows": count, "fastest": fast},
        drawn=lambda: {
            "rate": Chart(
                title="Rate of the slider", x=result.driven.scene(4).driver, y="dx, mm per driver",
                lines=(Line(label="slider", x=asked, y=rate),),
            )
        },
    )  # fmt: skip


KIND = Kind(
    name="slider-crank",
    doc="a slider-crank behind a gear pair or a cam",
    design=SliderCrankDesign,
    result=SliderCrank,
    required=("drive", "crank", "rod"),
    example={
        "drive": {
            "pair": {
                "law": {"type": "ellipse", "eccentricity": 0.3},
                "pair": {"teeth": [32, 32], "module_mm": 2},
            }
        },
        "crank": {"length_mm": 30},
        "rod": {"length_mm": 120},
    },
    facts=facts,
    files={
        "csv": lambda result, _: {"motion.csv": table_bytes(result.motion)},
        "report": report_files,
    },
    charts={"motion": motion_chart},
    scene=scene,
)
