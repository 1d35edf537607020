"""A kind of design that only a test knows: spacers, flat rings."""

from __future__ import annotations

from dataclasses import dataclass, field
from functools import cached_property
from typing import Any

import numpy as np

from gearcam.base.adjustments import Adjustment
from gearcam.base.errors import InfeasibleError
from gearcam.base.facts import Fact, Facts
from gearcam.base.findings import Finding
from gearcam.base.quantities import LENGTH, NUMBER, param
from gearcam.designs.design import Design
from gearcam.designs.outputs import OutputSpec, files_param, studies_param
from gearcam.export.table import outline_bytes
from gearcam.pictures.charts import Chart, Line
from gearcam.results.kind import Kind
from gearcam.results.result import Result, StudyResult

FORMATS = ("csv", "outline-txt")


@dataclass(frozen=True, kw_only=True)
class RingSpec:
    bore: float = param(LENGTH, gt=0, le=100, doc="inner diameter")
    width: float = param(LENGTH, default=5.0, gt=0, le=50, doc="of the ring")


@dataclass(frozen=True, kw_only=True)
class WeightSpec:
    density: float = param(NUMBER, default=7.8, gt=0, le=30, doc="g/cm3")


@dataclass(frozen=True, kw_only=True)
class SpacerOutput(OutputSpec):
    files: tuple[str, ...] = files_param(FORMATS, "spacer")
    studies: tuple[str, ...] = studies_param("spacer")


@dataclass(frozen=True, eq=False, kw_only=True)
class SpacerDesign(Design):
    kind = "spacer"

    ring: RingSpec
    output: SpacerOutput = field(default_factory=SpacerOutput)
    weight: WeightSpec = field(default_factory=WeightSpec)


class Spacer(Result):
    stages = {"outline": "outline", "checks": "checked"}  # noqa: RUF012

    @cached_property
    def outline(self) -> np.ndarray[Any, Any]:
        ring = self.design.ring
        if ring.width > ring.bore:
            raise InfeasibleError(
                "the ring is wider than its bore",
                where="ring.width_mm",
                value=ring.width,
                limit=ring.bore,
                unit="mm",
                adjustments=(Adjustment(near={"ring.width_mm": ring.bore}),),
            )
        angle = np.linspace(0.0, 2.0 * np.pi, 90, endpoint=False)
        radius = 0.5 * ring.bore + ring.width
        return radius * np.exp(1j * angle)

    @cached_property
    def checked(self) -> tuple[Finding, ...]:
        return ()


def facts(result: Any) -> Facts:
    ring = result.design.ring
    outer = Fact(ring.bore + 2.0 * ring.width, "outer diameter", shown=True)
    tree = {"ring": {"bore_mm": ring.bore, "outer_mm": outer}}
    return Facts(tree, ["ring.bore_mm"], "spacer")


def _text(result: Any, _: dict[str, Any]) -> dict[str, bytes]:
    return {"spacer.txt": repr(result.outline.tolist()).encode()}


FILES = {
    "csv": lambda result, _: {"spacer.csv": outline_bytes(result.outline)},
    "outline-txt": _text,
}


def _weigh(result: Any, _: Any) -> StudyResult:
    ring = result.design.ring
    area = 0.25 * np.pi * ((ring.bore + 2.0 * ring.width) ** 2 - ring.bore**2)
    mass = float(1e-3 * area * result.design.weight.density)
    return StudyResult(
        result=result,
        study=result.kind.studies["weigh"],
        file="weight.csv",
        table={"mass_g_per_mm": [mass]},
        group={"mass_g_per_mm": Fact(mass, "mass of a thickness of 1 mm", unit="g", shown=True)},
        study_findings=(Finding(code="light", severity="warning", message="It is light."),)
        * (mass < 0.1),
        drawn=lambda: {
            "mass": Chart(
                title="Mass", x="x", y="g", lines=(Line(label="it", x=_ONE[0], y=_ONE[1]),)
            )
        },
    )


_ONE = (np.array([0.0, 1.0]), np.array([0.0, 1.0]))

KIND = Kind(
    name="spacer",
    doc="a spacer, a flat ring",
    design=SpacerDesign,
    result=Spacer,
    required=("ring",),
    example={"ring": {"bore_mm": 20}},
    facts=facts,
    files=FILES,
)
