"""Ladders of the dynamics of elastic wheels: methods of integration over their tolerance."""

from __future__ import annotations

from dataclasses import dataclass
from functools import cache, partial
from typing import TYPE_CHECKING, Final

from gearcam.base.errors import MissingExtraError
from gearcam.results.ladders import Ladder, Ladders

if TYPE_CHECKING:
    from gearcam.dynamics.trials import Trial
    from gearcam.kinds.gear_pair.design import GearPairDesign
    from gearcam.kinds.gear_pair.result import GearPairResult

_TOLERANCES: Final = (1e-3, 1e-4, 1e-5, 1e-6)

_TRUE_TO: Final = 1e-9
"""Relative error of what counts as true."""

_OWN: Final = "auto"

_OTHERS: Final = ("radau", "lsoda", "dop853")
"""BDF is left out: for the same error it is slower than each of them in all cases."""


@cache
def _trials() -> dict[str, Trial]:
    from gearcam.dynamics.trials import trials

    return trials()


@dataclass(frozen=True)
class MethodLadder:
    """Methods on a machine that is the same for all designs (see `dynamics.trials`).

    Parameters
    ----------
    trial : str
        Name of the machine.
    """

    trial: str

    def suits(self, design: GearPairDesign) -> bool:
        """Return whether a design has elastic wheels in motion."""
        return design.dynamics.elastic

    def __call__(self, _: GearPairResult) -> Ladder:
        """Return the ladder.

        Raises
        ------
        MissingExtraError
            If scipy is not installed.
        """
        MissingExtraError.unless("scipy", what="dynamics", extra="dynamics")
        trial = _trials()[self.trial]
        return Ladder(
            refined="tolerance",
            measured=f"lag, over the largest lag; {trial.what}",
            unit="",
            levels=_TOLERANCES,
            own=_TOLERANCES[-1],
            order=None,
            rounding=_TRUE_TO,
            make=partial(trial.run, _OWN),
            measure=trial.measured,
            by=_OWN,
            others={one: partial(trial.run, one) for one in _OTHERS},
        )


METHOD_LADDERS: Final[Ladders] = {
    f"dynamics_{name}": MethodLadder(name) for name in ("free", "rattle", "driven", "slow")
}
