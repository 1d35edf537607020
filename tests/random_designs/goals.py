"""Goals of random designs: by their number, so that they draw nothing."""

from __future__ import annotations

from typing import Any

from gearcam.kinds.shared import METHODS


def seek(made: dict[str, Any], index: int, *facts: str) -> None:
    """Give every eleventh design a table ``[goal]`` if it has none, with one of some `facts`."""
    if index % 11 == 5 and "goal" not in made:
        name = facts[index % len(facts)]
        made["goal"] = {
            ("minimize", "maximize")[index // 11 % 2]: [name] if index % 2 else name,
            "method": METHODS[index // 11 % len(METHODS)],
            "trials": 10 + index,
            "seed": index,
            "findings": ("error", "warning")[index % 2],
        }
