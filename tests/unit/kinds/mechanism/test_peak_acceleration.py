"""What a pair makes worse, also where an even shaft would not accelerate at all."""

from __future__ import annotations

from typing import Any

import gearcam as gc
from helpers_machines import MACHINES, PAIR


def told(document: dict[str, Any]) -> list[str]:
    result = gc.build(gc.design({"kind": "mechanism", "name": "told", **document}))
    return [one.message for one in result.findings if one.code == "peak-acceleration"]


def test_a_factor_is_told() -> None:
    (message,) = told(MACHINES["slide behind a pair"])
    assert "times that behind an even shaft" in message


def test_a_shaft_that_an_even_drive_does_not_accelerate() -> None:
    crank = {"name": "crank", "on": "pair.wheel2", "joint": "B", "length_mm": 40}
    document = {"drive": [{"name": "pair", "pair": PAIR}], "crank": [crank]}
    (message,) = told(document | {"output": {"files": ["csv"], "outputs": ["crank.angle"]}})
    assert message == "The pair accelerates crank; an even shaft would not."
