"""A file of the ratio of a pair, and a study of how far it swings."""

from __future__ import annotations

from dataclasses import dataclass
from typing import Any

import numpy as np

from gearcam.base.facts import Fact
from gearcam.base.quantities import COUNT, param
from gearcam.results.result import StudyResult
from gearcam.results.studies import Study


def ratio_text(result: Any, _: dict[str, Any]) -> dict[str, bytes]:
    """Return the ratio over the driver's turn.

    Files: ratio.txt

    A line for each of 361 angles: phi1 in degrees and the ratio.
    """
    rows = zip(*_ratio(result, 361), strict=True)
    return {"ratio.txt": "".join(f"{phi:.1f} {ratio:.12g}\n" for phi, ratio in rows).encode()}


@dataclass(frozen=True, kw_only=True)
class SwingSpec:
    """Settings of the study."""

    steps: int = param(COUNT, default=100, ge=4, le=10000, doc="number of steps of the turn")


def _swing(result: Any, _: Any) -> StudyResult:
    phi, ratio = _ratio(result, result.design.swing.steps)
    swing = float(ratio.max() - ratio.min())
    return StudyResult(
        result=result,
        study=SWING,
        file="swing.csv",
        table={"phi1_deg": phi, "ratio": ratio},
        group={"swing": Fact(swing, "largest less smallest ratio", unit="", shown=True)},
        study_findings=(),
        drawn=dict,
    )


def _ratio(result: Any, count: int) -> tuple[Any, Any]:
    phi = np.linspace(0.0, 360.0, count)
    return phi, result.motion(np.radians(phi))["ratio"]


SWING = Study(
    name="swing",
    key="swing",
    doc="Measure how far the ratio swings; write DIR/NAME/swing.csv.",
    done="measured",
    table="swing",
    compute=_swing,
    settings=SwingSpec,
)
