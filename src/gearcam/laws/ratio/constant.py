"""Constant ratio: circular wheels."""

from __future__ import annotations

from dataclasses import dataclass
from typing import Final

from gearcam.base.tolerances import Tolerances
from gearcam.laws.entry import LawEntry
from gearcam.laws.ratio.base import RatioLaw, make_law
from gearcam.laws.ratio.span import Lobes
from gearcam.numeric.piecewise import Piece


@dataclass(frozen=True, kw_only=True)
class Constant:
    """No parameters: the tooth counts give the ratio.

    Examples
    --------
    >>> import gearcam as gc
    >>> law = gc.laws.Constant()
    >>> pair = gc.PairSpec(teeth=(20, 40), module=2.0)
    >>> result = gc.build(gc.GearPairDesign(name="round", law=law, pair=pair))
    >>> result.motion([0.0, 1.0])["ratio"].round(4)
    array([0.5, 0.5])
    """

    def build(self, lobes: Lobes, tolerances: Tolerances) -> RatioLaw:
        """Return i21 = z1/z2 for `lobes`, to `tolerances`."""
        ratio = lobes.advance / lobes.period
        piece = Piece(lambda x: 0.0 * x + ratio, lambda x: ratio * x)
        return make_law(lobes, [0.0, lobes.period], [piece], tolerances)


ENTRIES: Final = (
    LawEntry(
        name="constant",
        example=Constant(),
        doc="constant ratio z1/z2: circular wheels",
        continuity="analytic",
        source="by definition",
    ),
)
