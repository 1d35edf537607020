"""The charts of a mechanism, over the master's angle."""

from __future__ import annotations

from typing import TYPE_CHECKING, Final

from gearcam.pictures.charts import Chart, Charts, Line

if TYPE_CHECKING:
    from gearcam.kinds.mechanism.build import MechanismResult


def _place(result: MechanismResult) -> Chart:
    table = result.motion()
    driver, *_ = table
    lines = tuple(
        Line(label=one.stem, x=table[driver], y=table[f"{one.stem}_{one.unit[1]}"])
        for one in result.outputs
    )
    return Chart(title="Motion", x=f"{result.driver[1]}, deg", y="place, mm", lines=lines)


CHARTS: Final[Charts] = {"motion": _place}
"""Charts by name; the report leads with the first three."""
