"""Constant ratio: circular wheels, the limit that every formula of the others must meet."""

from __future__ import annotations

import math
from dataclasses import dataclass

from gearcam.laws.base import LAWS, Claim, LawEntry, RatioLaw, make_law
from gearcam.laws.span import Lobes
from gearcam.numeric.piecewise import Piece
from gearcam.tolerances import Tolerances


@dataclass(frozen=True, kw_only=True)
class Constant:
    """No parameters: the tooth counts give the ratio."""

    def build(self, lobes: Lobes, tolerances: Tolerances) -> RatioLaw:
        """Return i21 = z1/z2 for `lobes`, to `tolerances`."""
        ratio = lobes.advance / lobes.period
        piece = Piece(lambda x: 0.0 * x + ratio, lambda x: ratio * x)
        return make_law(lobes, [0.0, lobes.period], [piece], tolerances)


def _claims() -> tuple[Claim, ...]:
    return (
        Claim(
            parameters=Constant(),
            lobes=Lobes(2, 3),
            ratio={0.0: 2 / 3, 1.0: 2 / 3},
            motion={3 * math.pi: 2 * math.pi, 1.5: 1.0},
            continuity=3,
        ),
    )


LAWS.hang(
    LawEntry(
        name="constant",
        parameters=Constant,
        doc="constant ratio z1/z2: circular wheels",
        continuity="analytic",
        source="definition",
        claims=_claims,
    )
)
