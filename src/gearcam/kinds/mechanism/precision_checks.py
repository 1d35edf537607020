"""Checks of deviations by the tolerances of a mechanism."""

from __future__ import annotations

import math
from collections.abc import Iterator
from dataclasses import dataclass
from typing import Final

from gearcam.base.display import ShortRepr
from gearcam.base.findings import Remark, check
from gearcam.base.quantities import LENGTH, Param

CHECKS: Final = "precision of a mechanism"
"""Name of the subject of its checks."""


@dataclass(frozen=True, kw_only=True)
class Deviations(ShortRepr):
    """The largest deviations of the outputs of a mechanism that are lengths.

    Parameters
    ----------
    worst : dict of str to (float, str, str)
        By outputs, mm: the deviation in the worst case, where it is, and the dimension with the
        largest part of it.
    """

    worst: dict[str, tuple[float, str, str]]


_DEVIATION: Final = (
    "deviation",
    Param(LENGTH, ge=0, le=1e4, doc="largest deviation of places and slides; 0: no limit"),
    0.0,
)


@check("deviation", kind=CHECKS, limit=_DEVIATION, relation="at most", unit="mm")
def deviation(found: Deviations, limit: float) -> Iterator[Remark]:
    """Warn of an output whose place is not kept.

    Looks at: deviations of lengths by all tolerances and clearance, in the worst case.
    """
    for name, (most, where, dimension) in found.worst.items():
        if limit and most > limit:
            share = math.floor(100.0 * limit / most)
            yield Remark(
                f"The output may deviate by more than is allowed: {share} % of all tolerances keep "
                f"it. {dimension} has the largest part.",
                f"{name}, {where}",
                most,
            )
