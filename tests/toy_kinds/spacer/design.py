from __future__ import annotations

from dataclasses import dataclass, field
from functools import partial

from gearcam.base.quantities import LENGTH, param
from gearcam.designs.design import Design
from gearcam.designs.kind import DesignKind
from gearcam.designs.outputs import OutputSpec, files_param
from gearcam.designs.table import table_of

FORMATS = ("csv", "outline-txt")


@dataclass(frozen=True, kw_only=True)
class RingSpec:
    bore: float = param(LENGTH, gt=0, le=100, doc="inner diameter")
    width: float = param(LENGTH, default=5.0, gt=0, le=50, doc="of the ring")


@dataclass(frozen=True, kw_only=True)
class SpacerOutput(OutputSpec):
    files: tuple[str, ...] = files_param(FORMATS)


@dataclass(frozen=True, eq=False, kw_only=True)
class SpacerDesign(Design):
    kind = "spacer"

    ring: RingSpec
    output: SpacerOutput = field(default_factory=SpacerOutput)


KIND = DesignKind(
    name="spacer",
    doc="a spacer, a flat ring",
    design=SpacerDesign,
    tables={
        "ring": partial(table_of, "ring", RingSpec),
        "output": partial(table_of, "output", SpacerOutput),
    },
    required=("ring",),
    formats=FORMATS,
    example={"ring": {"bore_mm": 20}},
)
