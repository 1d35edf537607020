"""Programs of indexing drives: in each turn of the cam a step forward, then a dwell.

The driven element does not come back: over the turn it gains one step, its *advance* (see
`gearcam.laws.displacement`).

Depends on programs and their phases; numpy only.
"""

from __future__ import annotations

from dataclasses import dataclass, fields
from typing import Any

from gearcam.base.tolerances import Tolerances
from gearcam.laws.phases_of_lift import TURN, DwellPhase, RisePhase
from gearcam.laws.program import Program, make_program


@dataclass(frozen=True, eq=False, kw_only=True)
class IndexProgram(Program):
    """The angle of a turret over a turn of the cam, with knots where it begins and ends to move.

    Parameters
    ----------
    step : float, rad
        What it gains in each turn.
    """

    step: float

    @property
    def advance(self) -> float:
        """The step, rad."""
        return self.step


def index_program(law: Any, angle: float, step: float, tolerances: Tolerances) -> IndexProgram:
    """Return a program that moves by a step at the beginning of the turn, and then rests.

    Parameters
    ----------
    law : object
        Parameters of a motion law, such as `gearcam.motion_laws.ModifiedSine`.
    angle : float, rad
        Cam angle of the motion, below a turn.
    step : float, rad
        The step.
    tolerances : Tolerances
        Accuracy of expansions of laws.

    Raises
    ------
    InfeasibleError
        If the law has no value.
    """
    phases = RisePhase(angle=angle, law=law, lift=step), DwellPhase(angle=TURN - angle)
    made = make_program(phases, tolerances, oscillating=True, closed=False)
    # of a turn that repeats: both of its ends are one knot
    given: dict[str, Any] = {one.name: getattr(made, one.name) for one in fields(Program)}
    given["open"] = False
    return IndexProgram(**given, step=step)
