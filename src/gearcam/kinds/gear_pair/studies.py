"""Studies of gear pairs: the meshing step by step."""

from __future__ import annotations

from typing import TYPE_CHECKING, Final

from gearcam.base.findings import run_checks
from gearcam.kinds.shared import accuracy_study
from gearcam.results.study import Study, StudyResult

if TYPE_CHECKING:
    from gearcam.kinds.gear_pair.build import GearPairResult
    from gearcam.results.result import Progress


def _mesh(result: GearPairResult, progress: Progress | None) -> StudyResult:
    """Return the meshing of a pair as mounted; incomplete if it was interrupted."""
    from gearcam.kinds.gear_pair.facts import meshing_facts
    from gearcam.meshing.checks import KIND
    from gearcam.meshing.numbers import numbers
    from gearcam.meshing.study import study

    design = result.design
    gears = result.steps[design.meshing.step - 1]
    with result.stage("meshing"):
        designed = result.subject.sides if gears is result.steps[0] else ()
        meshing = study(gears, design.meshing, progress, designed)
    if not meshing.blocks:
        raise KeyboardInterrupt
    with result.stage("checks"):
        found = run_checks(KIND, meshing, design.limits)
    done = f"{len(meshing.phi1)} of {meshing.asked} steps"
    return StudyResult(
        result=result,
        study=MESH,
        file="meshing.csv",
        table=meshing.columns,
        group=meshing_facts(numbers(meshing)),
        found=found,
        interrupted="" if meshing.complete else done,
    )


MESH: Final = Study(
    name="mesh",
    key="meshing",
    doc="Study the meshing of gear pairs step by step; write DIR/NAME/meshing.csv.",
    done="meshed",
    table="meshing",
    compute=_mesh,
    options={"center_distance_mm": "center"},
    repeats=("contact-ratio",),  # the study checks the drive as mounted
)

STUDIES: Final[dict[str, Study]] = {one.name: one for one in (MESH, accuracy_study())}
"""The studies by name."""
