"""The blank of a cam: like that of a wheel, or a plate with a row of bolts."""

from __future__ import annotations

from collections.abc import Iterator
from dataclasses import dataclass, field
from typing import Any

from gearcam.base.quantities import LENGTH, LONGEST, param
from gearcam.base.rules import Breach, needs
from gearcam.parts.blank import SHAFT_RULES, WheelBlank


def _size(*, example: float, doc: str) -> Any:
    return param(LENGTH, default=None, gt=0, le=LONGEST, example=example, doc=doc)


@dataclass(frozen=True, kw_only=True)
class CamBlank(WheelBlank):
    """Bore, hub, holes, density of a cam; of a translating cam its plate and a row of bolts.

    Parameters
    ----------
    timing_marks : bool
        A cam has none.

    Examples
    --------
    >>> import gearcam as gc
    >>> gc.CamBlank(length=120.0, height=40.0)
    CamBlank(length=120, height=40)
    """

    timing_marks: bool = field(default=False)
    length: float | None = _size(
        example=150,
        doc="length of a translating cam's plate; as long as its profile needs if left out",
    )
    height: float | None = _size(
        example=40, doc="height of a translating cam's plate; with one wall, up to the largest lift"
    )
    bolt_spacing: float | None = _size(
        example=60,
        doc="distance of the bolts in the row of a translating cam, centred on the plate",
    )
    bolt_height: float | None = _size(
        example=10, doc="from the lower edge of a translating cam's plate to the row of bolts"
    )

    rules = (*SHAFT_RULES, needs("bolts", "bolt_diameter"))

    def problems(self) -> Iterator[Breach]:
        """Yield faults of the given values: field, None, message, allowed."""
        yield from super().problems()
        plate = not {self.length, self.height, self.bolt_spacing, self.bolt_height} <= {None}
        if not plate and self.bolts and not self.bolt_circle:
            rule = "bolts with bolt_circle_mm and bolt_diameter_mm"
            yield "bolt_circle", None, "is missing beside bolts", rule
        if plate and self.bolts:
            rule = "bolts with bolt_diameter_mm, bolt_spacing_mm and bolt_height_mm"
            for name in ("bolt_spacing", "bolt_height"):
                if getattr(self, name) is None and (name == "bolt_height" or self.bolts > 1):
                    yield name, None, "is missing beside bolts", rule
