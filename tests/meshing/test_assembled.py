"""First contact of many assemblies is that of each of them alone, searched in full."""

from __future__ import annotations

from dataclasses import replace

import numpy as np
import pytest

from gearcam.gears.contact import COAST, DRIVE, flank_pairs
from gearcam.meshing.assembled import AssembledSide
from gearcam.meshing.assembly import Assembly
from gearcam.meshing.contact import contacts
from gearcam.meshing.edges import first_touch, known_to
from helpers_pairs import profile
from helpers_sampling import few

NAMES = (
    "ellipse",
    "nautilus",  # open, with backlash
    "nail_machine_two_phase",  # the curvature jumps
    "rounded_square",  # it jumps so that an end touches before a common normal
    "ring_uneven",
    "feeder",  # a rack
)
FACTOR = 8.0
"""How far leads may be apart, in what each of them is known to: both have some roundings."""


def assemblies(name: str, size: float) -> list[Assembly]:
    """Return random assemblies with errors of a `size`, mm."""
    random = np.random.default_rng(3)
    gears = profile(name).gears

    def errors(number: int) -> dict[int, float]:
        numbers = gears[number].toothing.numbers
        return dict(zip(numbers, random.uniform(-0.2, 0.2, len(numbers)) * size, strict=True))

    found = []
    for _ in range(3):
        one, two = size * np.exp(2j * np.pi * random.random(2))
        every = Assembly(
            center=float(size * random.uniform(-0.5, 0.5)),
            eccentric=(complex(one), 0j if gears[0].pair.on_rack else complex(two)),
            pitch=(errors(0), errors(1)),
        )
        found += [every, replace(every, pitch=({}, {})), replace(every, eccentric=(0j, 0j))]
    return [*found, Assembly(center=size), Assembly()]


@pytest.mark.parametrize(
    ("name", "side"),
    few((name, (DRIVE, COAST)[(k + j) % 2]) for k, name in enumerate(NAMES) for j in (0, 1)),
)
def test_leads_of_many_assemblies_are_those_searched_in_full(name: str, side: int) -> None:
    gears = profile(name).gears
    pairs = flank_pairs(gears, side)
    phi1 = np.linspace(0.0, pairs.travel, 45, endpoint=not pairs.closed)
    phases = AssembledSide(gears=gears, side=side, phi1=phi1)
    for size in (0.02, 0.1, 0.4):  # of the largest every phase is searched in full
        for one in assemblies(name, size):
            mounting = one.mounting(gears[0].pair.shift)
            alone = flank_pairs(gears, side, mounting)
            expected = first_touch(alone, phi1, contacts(alone, phi1))[0]
            found = phases.leads(mounting)
            touching = np.isfinite(expected)
            assert (np.isfinite(found) == touching).all()
            apart = np.abs(found - expected)[touching]
            assert (apart <= FACTOR * known_to(alone, phi1)[touching]).all(), size


def test_leads_are_not_searched_in_full_where_errors_are_small(
    monkeypatch: pytest.MonkeyPatch,
) -> None:
    gears = profile("ellipse").gears
    phases = AssembledSide(gears=gears, side=DRIVE, phi1=np.linspace(0.0, 6.0, 45))
    one, *_ = assemblies("ellipse", 0.03)
    mounting = one.mounting(gears[0].pair.shift)
    first = phases.leads(mounting)

    def fail(*_: object) -> None:
        raise AssertionError

    monkeypatch.setattr("gearcam.meshing.assembled.contacts", fail)
    assert (phases.leads(mounting) == first).all()
