"""Machines behind a wheel and a rack: they move as far as the rack has teeth."""

from __future__ import annotations

from typing import Any

import numpy as np
import pytest

import gearcam as gc

PAIR = {
    "kind": "gear-pair",
    "name": "feed",
    "law": {"type": "rack", "r1": "1 + 0.1*cos(2*phi1)"},
    "pair": {"module_mm": 3, "teeth": [16, 40]},
}


def machine(**more: object) -> Any:
    tables = {
        "drive": [{"name": "pair", "pair": PAIR}],
        "slide": [{"name": "table", "on": "pair.rack", "joint": "T"}],
        **more,
    }
    made = gc.design({"kind": "mechanism", "name": "mine", **tables})
    assert isinstance(made, gc.MechanismDesign)
    return made


def test_the_wheel_turns_as_far_as_the_rack_has_teeth() -> None:
    made = gc.build(machine())
    assert not made.linkage.closed
    low, high = made.linkage.span
    assert (low, high) == pytest.approx((0.0, 2.5 * 2.0 * np.pi))
    # the teeth are along the centrode, whose length gives its size
    phi = np.linspace(0.0, 2.0 * np.pi, 1001)[:-1]
    r, slope = 1.0 + 0.1 * np.cos(2.0 * phi), -0.2 * np.sin(2.0 * phi)
    size = 16 * np.pi * 3 / (2.0 * np.pi * np.hypot(r, slope).mean())
    phi = np.linspace(low, high, 7)
    travel = size * (phi + 0.05 * np.sin(2.0 * phi))
    assert made.output("table", phi)["table_mm"] == pytest.approx(-travel, abs=1e-9)


def test_an_even_drive_in_its_place_moves_as_far() -> None:
    made = gc.build(machine(compare=[{"name": "even", "even": True}]))
    (other,) = made.compared.values()
    assert other.linkage.span == pytest.approx(made.linkage.span)
    q = np.array([1.0, 2.0])
    size = made.output("table", made.linkage.knots[-1:])["table_mm"] / made.linkage.span[1]
    assert other.output("table", q)["table_mm"] == pytest.approx(size * q, rel=1e-12)
