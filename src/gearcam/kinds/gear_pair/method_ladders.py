"""Ladders of the stage dynamics: methods of integration over their tolerance."""

from __future__ import annotations

from functools import cache, partial
from typing import TYPE_CHECKING, Any, Final

from gearcam.results.ladders import Ladder, Ladders

if TYPE_CHECKING:
    from gearcam.dynamics.trials import Comparison

_TOLERANCES: Final = (1e-3, 1e-4, 1e-5, 1e-6)

_TRUE_TO: Final = 1e-9
"""Relative error of what counts as true."""

_METHODS: Final = ("auto", "radau", "bdf", "lsoda", "dop853")


@cache
def _comparison() -> Comparison:
    from gearcam.dynamics.trials import Comparison

    return Comparison()


def _ladder(method: str, result: Any) -> Ladder:  # noqa: ARG001 - ladders are those of a result
    from gearcam.dynamics.trials import ORDERS

    compared = _comparison()
    return Ladder(
        refined="tolerance",
        measured=f"lags of four machines by {method}",
        unit="",
        levels=_TOLERANCES,
        own=_TOLERANCES[-1] if method == "auto" else None,
        order=ORDERS[method],
        rounding=_TRUE_TO,
        make=partial(compared.run, method),
        measure=compared.measured,
    )


METHOD_LADDERS: Final[Ladders] = {
    f"dynamics_{method}": partial(_ladder, method) for method in _METHODS
}
"""For designs with a table ``[dynamics]``: the same machines for all of them."""
