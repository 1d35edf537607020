"""The same pair a million times smaller or larger is the same pair.

All lengths of a design are scaled, its tolerances too: outlines and facts scale with them, areas
and volumes by their powers. Lengths are told against the size of the pair: places are rounded so.
Edges are sharp: along outlines without a corner rounding tells where vertices lie.
"""

from __future__ import annotations

import re
from collections.abc import Iterator, Mapping
from functools import cache
from typing import Any

import numpy as np
import pytest

import gearcam
from helpers_sampling import few

MODULE = 0.01
"""Of the pairs that are scaled, mm: a decade above the least that files allow."""

SAME = 1e-12

ROUND = {"face_width_mm": 0.1, "backlash_mm": 5e-4}
EDGES = {
    "bore_diameter_mm": [0.08, 0.1],
    "density_kg_m3": 7850,
    "clearance_mm": 1e-3,
    "timing_marks": False,
}
SPIRAL = {"type": "formula", "ratio": "exp(phi1/3)", "driver_travel_deg": 200}
ONE = {"type": "ellipse", "eccentricity": 0.5}

PAIRS: dict[str, tuple[dict[str, Any], list[int], dict[str, Any]]] = {
    "ellipse": (ONE, [41, 41], {}),
    "as made": (ONE, [41, 41], {"pair": ROUND, "blank": EDGES}),
    "undercut": ({"type": "constant"}, [8, 30], {"pair": {"x": 0.2}}),
    "concave": ({"type": "limacon", "eccentricity": 0.6}, [40, 40], {}),
    "rack": ({"type": "rack", "r1": "1 + 0.2*cos(phi1)"}, [40, 60], {}),
    "open": (SPIRAL | {"driven_travel_deg": 200}, [29, 29], {}),
    "ring": (
        {"type": "ellipse", "eccentricity": 0.1},
        [24, 60],
        # a mark is half a millimetre deep whatever it is in
        {"pair": {"type": "internal"}, "blank": {"timing_marks": False}},
    ),
}


@cache
def made(name: str, scale: float) -> Any:
    law, teeth, tables = PAIRS[name]
    pair = {"module_mm": MODULE, "teeth": teeth, "face_width_mm": 0.1} | tables.get("pair", {})
    output = {"files": ["csv"], "chord_tolerance_mm": 0.01 * MODULE}
    document: Any = {"kind": "gear-pair", "name": "scaled", "law": law} | tables
    document |= {"pair": pair, "output": output}
    return gearcam.build(gearcam.design(scaled(document, scale)))


def scaled(value: Any, scale: float, key: str = "") -> Any:
    """What a design file holds, with all its lengths times `scale`."""
    if isinstance(value, dict):
        return {name: scaled(one, scale, name) for name, one in value.items()}
    if isinstance(value, list):
        return [scaled(one, scale, key) for one in value]
    return value * scale if key.endswith("_mm") else value


def numbers(value: Any, name: str = "") -> Iterator[tuple[str, Any]]:
    """All that facts tell, by name."""
    items = value.items() if isinstance(value, Mapping) else enumerate(value)
    for key, one in items:
        if isinstance(one, Mapping | list | tuple):
            yield from numbers(one, f"{name}.{key}" if isinstance(key, str) else name)
        else:
            yield f"{name}.{key}" if isinstance(key, str) else f"{name}[{key}]", one


def power(name: str) -> int:
    """With which power of the scale a fact goes, by the unit in its name."""
    for part in reversed(re.sub(r"\[\d+\]", "", name).split(".")):
        if part.startswith("mm_per_"):
            return 1
        if told := re.search(r"_(per_mm|kg_mm2|g_mm|kg|mm[23]?|deg|rad)$", part):
            powers = {"per_mm": -1, "mm": 1, "mm2": 2, "mm3": 3, "kg": 3, "g_mm": 4, "kg_mm2": 5}
            return powers.get(told[1], 0)
    return 0


@pytest.mark.parametrize("scale", few([1e4, 1e2]))
@pytest.mark.parametrize("name", few(PAIRS))
def test_a_pair_scales(name: str, scale: float) -> None:
    one, other = made(name, 1.0), made(name, scale)
    size = max(float(np.abs(gear.outline).max()) for gear in one.gears)
    for first, second in zip(one.gears, other.gears, strict=True):
        assert first.outline.shape == second.outline.shape
        assert np.abs(second.outline / scale - first.outline).max() <= SAME * size
    own, its = (dict(numbers(result.facts.document)) for result in (one, other))
    assert own.keys() == its.keys()
    assert [name for name in own if differs(name, own[name], its[name], scale, size)] == []


def differs(name: str, one: Any, other: Any, scale: float, size: float) -> bool:
    if not isinstance(one, float):
        return bool(one != other)
    if re.search(r"tool\.(slot_)?at_mm", name):
        return False  # of places that are alike rounding tells which is named
    p = power(name)
    if name.startswith(".accuracy."):
        known = 0.1 if re.search("chord|area", name) else 0.5  # the largest of a few random trials
        return not abs(other / scale**p - one) <= known * one
    if name.endswith("_deg"):
        return not abs((other - one + 180.0) % 360.0 - 180.0) <= SAME * 360.0
    about = max(abs(one), size**p if p > 0 else 0.0)
    return not abs(other / scale**p - one) <= SAME * about


@pytest.mark.parametrize("scale", [1e2, 1e4])
def test_volumes_of_solids_scale(scale: float) -> None:
    one, other = made("ring", 1.0).solids, made("ring", scale).solids
    for name, solid in one.items():
        assert other[name].is_watertight
        assert other[name].volume / scale**3 == pytest.approx(solid.volume, rel=SAME)


def test_a_length_that_does_not_scale_is_seen() -> None:
    assert differs("pair.module_mm", 1.0, 1e6 * (1 + 2e-12), 1e6, 1.0)
    assert differs("gears.area_mm2", 1.0, 1e6, 1e6, 1.0)
    assert not differs("gears.area_mm2", 1.0, 1e12, 1e6, 1.0)
    assert differs("mesh.contact_ratio.min", 1.5, 1.5 + 2e-12, 1e6, 1.0)
