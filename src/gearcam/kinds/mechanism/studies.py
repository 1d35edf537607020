"""Studies of mechanisms: the driver's moment under loads."""

from __future__ import annotations

from typing import TYPE_CHECKING, Any, Final

from gearcam.kinds.shared import accuracy_study
from gearcam.results.kind import Study
from gearcam.results.result import StudyResult

if TYPE_CHECKING:
    from gearcam.kinds.mechanism.build import MechanismResult
    from gearcam.results.result import Progress


def _torque(result: MechanismResult, progress: Progress | None) -> StudyResult:
    from gearcam.kinds.mechanism.torque import study_torque

    return study_torque(result, TORQUE, progress)


def _demand(design: Any) -> None:
    from gearcam.kinds.mechanism.torque import demand

    demand(design)


TORQUE: Final = Study(
    name="torque",
    key="torque",
    doc="Compute the driver's moment under loads, masses and springs; write DIR/NAME/torque.csv.",
    done="computed",
    table="torque",
    compute=_torque,
    demand=_demand,
    repeats=("loads-unused",),  # it uses them
)

STUDIES: Final[dict[str, Study]] = {one.name: one for one in (TORQUE, accuracy_study())}
"""The studies by name."""
