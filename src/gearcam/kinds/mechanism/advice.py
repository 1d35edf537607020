"""What helps a mechanism that is refused: changes that the refusal names, then shorter cranks."""

from __future__ import annotations

from typing import TYPE_CHECKING, Any, Final

from gearcam.base.adjustments import Adjustment
from gearcam.results.advice import Advice

if TYPE_CHECKING:
    from gearcam.base.adjustments import Changes
    from gearcam.base.errors import InfeasibleError
    from gearcam.results.advice import Search

_SHORTEST: Final = 0.05
"""How much of a crank is left in the search."""

_STILL: Final = (
    "output", "limits", "torque", "load", "mass", "spring", "gravity", "interval", "dwell",
    "stretch",
)  # fmt: skip
"""Tables that change no motion."""


class MechanismAdvice(Advice):
    """Remedies of mechanisms."""

    def seek(self, search: Search, refusal: InfeasibleError | None) -> None:
        """Guide a `search`; a `refusal` of a loop to close may end with a shorter crank."""
        super().seek(search, refusal)
        if refusal is not None and refusal.where.startswith("dyad["):
            search.follow(
                Adjustment(far={f"crank[{k}].length_mm": _SHORTEST * one["length_mm"]}, size=True)
                for k, one in enumerate(search.document.get("crank", ()))
            )

    def moves(self, changes: Changes, design: Any) -> bool:  # noqa: ARG002
        """Return whether a `design` moves differently with `changes`."""
        return not all(key.startswith(_STILL) for key in changes)
