"""Ladders of the dynamics of elastic wheels: methods of integration over their tolerance."""

from __future__ import annotations

from dataclasses import dataclass
from functools import cache, partial
from typing import TYPE_CHECKING, Final

from gearcam.base.errors import MissingExtraError
from gearcam.results.ladders import Ladder, Ladders

if TYPE_CHECKING:
    from gearcam.dynamics.trials import Comparison
    from gearcam.kinds.gear_pair.design import GearPairDesign
    from gearcam.kinds.gear_pair.result import GearPairResult

_TOLERANCES: Final = (1e-3, 1e-4, 1e-5, 1e-6)

_TRUE_TO: Final = 1e-9
"""Relative error of what counts as true."""

_METHODS: Final = ("auto", "radau", "bdf", "lsoda", "dop853")


@cache
def _comparison() -> Comparison:
    from gearcam.dynamics.trials import Comparison

    return Comparison()


@dataclass(frozen=True)
class MethodLadder:
    """A method on four machines, which are the same for all designs (see `dynamics.trials`)."""

    method: str

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
        from gearcam.dynamics.trials import ORDERS

        compared = _comparison()
        return Ladder(
            refined="tolerance",
            measured=f"lags of four machines by {self.method}",
            unit="",
            levels=_TOLERANCES,
            own=_TOLERANCES[-1] if self.method == "auto" else None,
            order=ORDERS[self.method],
            rounding=_TRUE_TO,
            make=partial(compared.run, self.method),
            measure=compared.measured,
        )


METHOD_LADDERS: Final[Ladders] = {f"dynamics_{method}": MethodLadder(method) for method in _METHODS}
