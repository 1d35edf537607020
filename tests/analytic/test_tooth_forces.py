"""Tooth forces, bearings and losses of pairs, against values computed to 30 digits elsewhere."""

from __future__ import annotations

from functools import cache
from typing import Any

import numpy as np
import pytest

import gearcam
from gearcam.mechanics.friction import WheelFrictionSpec
from gearcam.meshing import forces
from gearcam.meshing.forces import ToothForces, tooth_forces
from helpers_built import built
from helpers_pairs import PROFILES

ELLIPSE = {
    "kind": "gear-pair", "name": "e", "law": {"type": "ellipse", "eccentricity": 0.3},
    "pair": {"module_mm": 1, "teeth": [41, 41]},
}  # fmt: skip
CIRCLES = {
    "kind": "gear-pair", "name": "c", "law": {"type": "constant"},
    "pair": {"module_mm": 3, "teeth": [24, 36]},
}  # fmt: skip

# phi1, deg; normal forces together, N; force on the driver's shaft without friction and with it;
# the driver's torque with friction, N mm; efficiency
NON_CIRCULAR: dict[str, tuple[float, float, list[tuple[float, ...]]]] = {
    "ellipse": (10_000.0, 5.0, [
        (7, 386.72589724, 121.981791137, -366.984144381, 124.956633104, -375.934003403,
         5774.44483163, 0.934964807243),
        (77, 416.752177175, 34.0466674208, -415.359123672, 0.830415384787, -424.460823902,
         7810.66301324, 0.951103575744),
        (90, 438.008049427, 25.2192751745, -437.281419137, 25.9181301924, -449.398988413,
         8857.08524884, 0.942592694849),
        (247, 618.831492651, 375.612081608, -491.800752792, 390.487915999, -511.278152244,
         11453.5767799, 0.928643701515),
        (300, 468.76968468, 253.458428979, -394.339754596, 216.087885447, -403.736124042,
         6941.04060175, 0.943196123687),
    ]),
    "nail machine": (2_365_275.0, 20.0, [
        (40, 36035.725415, 16845.7402866, -31855.8399729, 17532.6011165, -33154.7160276,
         3602573.88496, 0.935102596837),
        (100, 32656.4965437, 22918.3075504, -23263.6614817, 27819.4112519, -24059.3173712,
         1965402.12682, 0.927130403414),
        (172, 18827.4933879, 3298.86290231, -18536.2350768, 1820.38609544, -18845.9237715,
         1026991.27887, 0.945721092094),
        (200, 19916.4711661, -750.095080402, -19902.3410954, 854.303136207, -20251.8167911,
         1280052.02239, 0.950856977598),
        (240, 23847.0326035, 349.857994249, -23844.4660954, 359.169566224, -24479.0934754,
         2040961.82558, 0.944029855449),
    ]),
}  # fmt: skip

# of 24 and 36 teeth, reach of the first contact, mm: the same, the load 100 N m; the efficiency
# with a rolling arm of 0.02 mm too
CIRCULAR = [
    (-1.2, 2084.5486675, 869.664434067, -1901.79838979, 71161.8550813, 0.936831489152,
     0.935892611771),
    (0.7, 1962.05121926, 523.563035035, -1897.40993548, 70766.8941928, 0.942060089355,
     0.941168526983),
    (-7.0, 2032.72272481, 695.232117679, -1910.1345446, 71912.1090143, 0.92705759267,
     0.926157113144),
]  # fmt: skip

_DIGITS = 1e-10
"""The values have twelve digits."""


@cache
def sides(name: str) -> list[Any]:
    if name == "nail machine":
        return [built(PROFILES / "nail_machine_two_phase.toml").subject.sides]
    document = {"ellipse": ELLIPSE, "circles": CIRCLES}[name]
    return [gearcam.build(gearcam.design(document)).subject.sides]


def under(
    name: str, phi1: Any, load: float, friction: WheelFrictionSpec, *, on_driver: bool = False
) -> ToothForces:
    phases = np.atleast_1d(np.asarray(phi1, dtype=float))
    given = np.full(phases.shape, load)
    return tooth_forces(sides(name), phases, given, on_driver=on_driver, friction=friction)


def rubbing(radius: float, rolling: float = 0.0) -> WheelFrictionSpec:
    return WheelFrictionSpec(
        flank=0.08, joint=0.1, journal_radius=(radius, radius), rolling=rolling
    )


@pytest.mark.parametrize("name", NON_CIRCULAR)
def test_forces_of_non_circular_pairs(name: str) -> None:
    load, radius, rows = NON_CIRCULAR[name]
    angles, force, x, y, rubbed_x, rubbed_y, torque, efficiency = np.array(rows).T
    phi1 = np.radians(angles)
    free = under(name, phi1, load, WheelFrictionSpec())
    assert free.force == pytest.approx(force, rel=_DIGITS)
    # a component is known to a part of its force
    assert np.abs(free.bearing - (x + 1j * y)).max() < _DIGITS * force.max()
    made = under(name, phi1, load, rubbing(radius))
    assert np.abs(made.bearing - (rubbed_x + 1j * rubbed_y)).max() < _DIGITS * force.max()
    assert made.torque == pytest.approx(torque, rel=_DIGITS)
    assert made.efficiency == pytest.approx(efficiency, rel=_DIGITS)
    assert made.balance < 1e-13
    back = under(name, phi1, 1.0, rubbing(radius), on_driver=True)
    assert back.force * made.torque == pytest.approx(made.force, rel=1e-13)


def test_forces_of_round_wheels() -> None:
    """Equations 4.88 to 4.97 of the textbook, both with one pair in contact and with two."""
    reach, force, x, y, torque, efficiency, rolled = np.array(CIRCULAR).T
    pitch, radius = 3.0 * np.pi, 36.0
    phi1 = (reach / np.cos(np.radians(20.0)) + 0.75 * pitch) / radius
    made = under("circles", phi1, 100_000.0, rubbing(12.0))
    assert np.bincount(made.teeth.points.step).tolist() == [1, 1, 2]
    normal = made.teeth.summed(np.ones(4), 3) * made.force
    assert normal == pytest.approx(force, rel=1e-9)
    assert np.abs(made.bearing - (x + 1j * y)).max() < 1e-9 * force.max()
    assert made.torque == pytest.approx(torque, rel=1e-9)
    assert made.efficiency == pytest.approx(efficiency, rel=1e-9)
    with_rolling = under("circles", phi1, 100_000.0, rubbing(12.0, 0.02))
    assert with_rolling.efficiency == pytest.approx(rolled, rel=1e-9)


@pytest.mark.parametrize("place", [0.3, 3.4, 5.1])
def test_arms_of_friction_have_signs(place: float) -> None:
    """With absolute arms, as for round wheels, the efficiency of the nail machine differs."""
    made = under("nail machine", place, 2_365_275.0, WheelFrictionSpec(flank=0.08))
    points = made.teeth.points
    pushed = made.teeth.push - points.force
    distance = sides("nail machine")[0][0].distance
    arms = (
        np.imag(np.conj(points.point) * pushed),
        np.imag(np.conj(points.point - distance) * pushed),
    )
    lost = made.force * made.teeth.summed(arms[0] * -1.0 - arms[1] * made.teeth.ratio, 1)
    assert made.losses["flanks"] == pytest.approx(lost, rel=1e-9)


def test_coast_flanks_carry_a_load_that_pulls() -> None:
    """The driver brakes; the losses then lessen what it must hold."""
    free = under("ellipse", [0.4, 2.0], -10_000.0, WheelFrictionSpec())
    made = under("ellipse", [0.4, 2.0], -10_000.0, rubbing(5.0))
    assert made.back.all()
    assert (made.torque > free.torque).all()
    assert (made.torque < 0.0).all()
    assert (made.efficiency < 1.0).all()
    assert made.balance < 1e-13
    assert (made.teeth.points.force.imag > 0.0).all()  # against the motion, which is downwards


def test_friction_locks_a_pair() -> None:
    made = under("ellipse", [0.4, 2.0], 10_000.0, rubbing(60.0))
    rough = WheelFrictionSpec(flank=2.0, joint=2.0, journal_radius=(60.0, 60.0))
    locked = under("ellipse", [0.4, 2.0], 10_000.0, rough)
    assert not made.locked.any()
    assert locked.locked.all()
    assert np.isnan(locked.torque).all()
    assert (locked.reserve <= 0.0).all()


def test_negative_controls(monkeypatch: pytest.MonkeyPatch) -> None:
    """The values and the powers show a turned normal and friction of the wrong sign."""
    load, radius, rows = NON_CIRCULAR["ellipse"]
    phi1 = np.radians([row[0] for row in rows])
    right = np.array([row[-1] for row in rows])
    real = forces.contacts

    def turned(pairs: Any, places: Any) -> Any:
        found = real(pairs, places)
        return forces.replace(found, force=found.force * np.exp(1j * np.radians(5.0)))

    monkeypatch.setattr(forces, "contacts", turned)
    made = under("ellipse", phi1, load, rubbing(radius))
    assert np.abs(made.efficiency - right).min() > 1e-4
    assert made.balance > 1e-3
    monkeypatch.setattr(forces, "contacts", real)
    wrong = WheelFrictionSpec(flank=0.08, joint=0.1, journal_radius=(radius, radius))
    object.__setattr__(wrong, "flank", -0.08)
    made = under("ellipse", phi1, load, wrong)
    assert np.abs(made.efficiency - right).min() > 1e-4


def test_backlash_changes_the_ratio_a_little(monkeypatch: pytest.MonkeyPatch) -> None:
    """The lag changes with the phase: powers balance with the true ratio only."""
    document = ELLIPSE | {"pair": {"module_mm": 1, "teeth": [41, 41], "backlash_mm": 0.2}}
    flanks = [gearcam.build(gearcam.design(document)).subject.sides]
    phi1 = np.linspace(0.0, 6.0, 50)

    def balance() -> float:
        given = np.full(phi1.shape, 1e4)
        return tooth_forces(flanks, phi1, given, on_driver=False, friction=rubbing(5.0)).balance

    assert balance() < 1e-13
    real = forces.contacts

    def nominal(pairs: Any, places: Any) -> Any:
        found = real(pairs, places)
        return forces.replace(found, drift=0.0 * found.drift)

    monkeypatch.setattr(forces, "contacts", nominal)
    assert balance() > 1e-4
