"""The checks of random assemblies; importing this module registers them."""

from __future__ import annotations

import math
from collections.abc import Iterator
from typing import TYPE_CHECKING

from gearcam.base.findings import Remark, check
from gearcam.base.numerals import formatted
from gearcam.meshing.settings import TRIALS

if TYPE_CHECKING:
    from gearcam.kinds.gear_pair.error_trials import AssemblyTrials


@check("assemblies-jam", kind=TRIALS, relation="at least", unit="mm")
def assemblies_jam(trials: AssemblyTrials, limit: float) -> Iterator[Remark]:  # noqa: ARG001
    """Warn of random assemblies that jam: their backlash is negative.

    It says how many do, and about how much more backlash they need.

    Looks at: least backlash of each assembly over the cycle.
    """
    jammed = [number for number, one in enumerate(trials.outcomes) if one.jams]
    if not jammed:
        return
    worst = min(jammed, key=lambda number: trials.outcomes[number].backlash)
    least = trials.outcomes[worst].backlash
    many = f"{len(jammed)} of {trials.done} random assemblies jam"
    help_ = f"about {_rounded_up(-least)} mm more backlash frees them"
    if trials.measured:  # backlash changes no measured outline
        help_ = "how much more backlash frees measured outlines is not known"
    yield Remark(
        f"{many}: {help_}; the centre distance that does is not computed.",
        f"assembly {worst + 1}",
        least,
        limit=0.0,
    )


def _rounded_up(size: float) -> str:
    """Return a size in two digits, rounded up: a smaller one would not be enough."""
    unit = 10.0 ** (math.floor(math.log10(size)) - 1)
    return formatted(math.ceil(size / unit) * unit, 2)
