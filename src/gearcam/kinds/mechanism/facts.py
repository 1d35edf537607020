"""Facts of a mechanism: what the console, the report and ``summary.json`` show."""

from __future__ import annotations

import math
from typing import TYPE_CHECKING, Any

from gearcam.base.facts import Fact, Facts

if TYPE_CHECKING:
    from gearcam.kinds.mechanism.build import MechanismResult

Tree = dict[str, Any]


def facts(result: MechanismResult) -> Facts:
    """Return the facts of a mechanism, its `result`."""
    low, high = result.linkage.span
    tree: Tree = {
        "drive": {
            one.name: {
                "kind": "even"
                if one.even
                else "slide"
                if one.slide
                else "pair"
                if one.pair
                else "cam"
            }
            for one in result.design.drive
        },
        "range_deg": Fact(math.degrees(high - low), "range of the master", shown=True),
        "dyads": {one.joint: one.type for one in result.design.dyad},
    }
    return Facts(tree, ["range_deg"], "mechanism")
