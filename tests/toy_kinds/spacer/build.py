from __future__ import annotations

from functools import cached_property
from typing import Any

import numpy as np

from gearcam.base.errors import InfeasibleError, Way
from gearcam.base.findings import Finding
from gearcam.results.result import Result


class Spacer(Result):
    stages = {"outline": "outline", "checks": "findings"}  # noqa: RUF012

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
                ways=(Way(near={"ring.width_mm": ring.bore}),),
            )
        angle = np.linspace(0.0, 2.0 * np.pi, 90, endpoint=False)
        radius = 0.5 * ring.bore + ring.width
        return radius * np.column_stack([np.cos(angle), np.sin(angle)])

    @cached_property
    def findings(self) -> tuple[Finding, ...]:
        return ()


def build(design: Any) -> Spacer:
    return Spacer(design)
