from __future__ import annotations

from collections.abc import Mapping
from typing import Any

from gearcam.base.facts import Fact, Facts


def facts(result: Any, measured: Mapping[str, Any]) -> Facts:
    ring = result.design.ring
    outer = Fact(ring.bore + 2.0 * ring.width, "outer diameter", shown=True)
    tree = {"ring": {"bore_mm": ring.bore, "outer_mm": outer}, **measured}
    return Facts(tree, ["ring.bore_mm"], "spacer")
