"""Circular wheels with profile shift: active radii and undercut by the textbook (4.58-4.75)."""

from __future__ import annotations

import math
from typing import Any

import numpy as np
import pytest

import gearcam as gc
from gearcam.gears.checks import largest_module
from gearcam.gears.contact import DRIVE, flank_pairs
from gearcam.meshing.contact import contacts
from helpers_built import built

ALPHA, MODULE = math.radians(20), 2.0

STRAIGHT = 1.25 - 0.38 * (1.0 - math.sin(ALPHA))
DEPTH = 1.0
"""Depth of the rack's straight flank h_a0, in modules (0.99997 with the common tip radius 0.38)."""


def circles(z1: int, z2: int, x: float, *, ring: bool) -> Any:
    pair: dict[str, Any] = {"teeth": [z1, z2], "module_mm": MODULE, "x": x}
    if ring:
        pair["type"] = "internal"
    document = {"kind": "gear-pair", "name": "c", "law": {"type": "constant"}, "pair": pair}
    return built(gc.design(document))


def beyond(radius: float, addendum: float) -> float:
    """Distance of the tip from the base circle's tangent point: sqrt(ra^2 - rb^2)."""
    return math.sqrt((radius + addendum * MODULE) ** 2 - (radius * math.cos(ALPHA)) ** 2)


@pytest.mark.parametrize("ring", [False, True])
@pytest.mark.parametrize("x", [0.0, 0.25])
@pytest.mark.parametrize(("z1", "z2"), [(20, 60), (25, 80)])
def test_active_radii_of_shifted_wheels(z1: int, z2: int, x: float, ring: bool) -> None:
    """(4.58), (4.59) of outer and (4.64), (4.65) of inner pairs, within the flanks.

    A ring's tips reach below the flank of the pinion, against (4.75): there the contact ends.
    """
    made = circles(z1, z2, x, ring=ring)
    r1, r2 = 0.5 * MODULE * z1, 0.5 * MODULE * z2
    line = (r2 - r1 if ring else r1 + r2) * math.sin(ALPHA)
    tip1 = beyond(r1, 1.0 + x)
    tip2 = beyond(r2, -(1.0 - x) if ring else 1.0 - x)
    if ring:
        begin = 0.5 * z1 * math.sin(ALPHA) - (STRAIGHT - x) / math.sin(ALPHA)
        lengths = max(tip2 - line, MODULE * begin), line + tip1
    else:
        lengths = line - tip2, line - tip1
    expected = [
        math.hypot(r * math.cos(ALPHA), length) for r, length in zip((r1, r2), lengths, strict=True)
    ]
    pairs = flank_pairs(made.gears, DRIVE)
    start, end = (float(edge[0]) for edge in (pairs.arcs.start, pairs.arcs.end))
    found = contacts(pairs, np.array([start + 1e-12, end - 1e-12]))
    one, two = np.abs(found.point), np.abs(found.point - pairs.distance)
    assert one.min() == pytest.approx(expected[0], rel=1e-9)
    assert (two.max() if ring else two.min()) == pytest.approx(expected[1], rel=1e-9)
    assert min(lengths) > 0.0
    assert made.gear1.profile.undercut_teeth == ()


@pytest.mark.parametrize("x", [-0.2, 0.0, 0.3])
def test_the_fewest_teeth_of_shifted_wheels(x: float) -> None:
    """(4.71), (4.72): z_min = 2*(h_a0 - x)/sin(alpha)^2, as a real number."""
    gear = circles(30, 60, x, ring=False).gear1
    fewest = 30 * gear.pair.module / largest_module(gear)
    assert fewest == pytest.approx(2.0 * (DEPTH - x) / math.sin(ALPHA) ** 2, rel=1e-9)
    assert circles(math.ceil(fewest), 60, x, ring=False).gear1.profile.undercut_teeth == ()
    assert circles(math.floor(fewest), 60, x, ring=False).gear1.profile.undercut_teeth != ()
