"""A wheel within a ring: contact, sliding, first touch and play by the exact flanks."""

from __future__ import annotations

import math

import numpy as np
import pytest

from gearcam.gears.contact import COAST, DRIVE, flank_pairs
from gearcam.laws.ratio.constant import Constant
from gearcam.meshing.contact import contacts
from gearcam.meshing.edges import first_touch, touches
from gearcam.meshing.numbers import numbers
from gearcam.meshing.settings import MeshingSpec
from gearcam.meshing.study import study
from helpers_pairs import dense_touch, job
from helpers_rings import (
    ALPHA,
    DEEP,
    LAWS,
    ROUND,
    Array,
    Plane,
    driven_angles,
    involute,
    made,
    pair_of,
    phases,
)
from helpers_sampling import few

FLANK_POINTS = [
    ("one lobe", 1, 1, 3.0, 0.670422458743, 17.3669675696998 + 1.50032475382222j,
     40.2736992412249 + 1.49456196954045j),
    ("one lobe", 5, 1, 82.847443087281, -2 / 3, 3.13978485125321 + 20.9506597590129j,
     35.4267312088711 + 26.1907893140537j),
    ("one lobe", 5, -1, 62.0, 3.91049855615, 5.76908841828522 + 18.6201588573513j,
     35.6791213785957 + 22.5025153446057j),
    ("one lobe", 13, 1, 182.0, 0.456247828366, -32.0296446730783 - 1.52377105198177j,
     -1.52211673957626 + 54.9191400056075j),
    ("two lobes", 1, 1, 3.0, -0.0736252436139, 31.3533126119044 + 1.5789209538115j,
     50.3294840651883 + 1.57946003539188j),
    ("two lobes", 5, 1, 45.184870469123, -2 / 3, 26.620401290116 + 26.1304226359781j,
     49.5061653300549 + 26.7318093630524j),
    ("two lobes", 13, -1, 104.2020789582, -2 / 3, -10.7888974450768 + 44.7722430322602j,
     22.6275060442496 + 60.9494894166484j),
]  # fmt: skip
"""Tooth, sigma, phi1 deg, u mm, the point on wheel 1 and on the ring: by mpmath, to 25 digits."""


@pytest.mark.parametrize(("name", "tooth", "sigma", "angle", "u", "one", "two"), FLANK_POINTS)
def test_flanks_are_those_of_the_oracle(
    name: str, tooth: int, sigma: int, angle: float, u: float, one: complex, two: complex
) -> None:
    """And their normals are one through the mesh, so that they share tangents."""
    result, phi1 = made(name), np.array([math.radians(angle)])
    first, second = (gear.toothing for gear in result.gears)
    sf = np.array([(tooth - 1) * first.pitch + sigma * first.pitch / 4.0])
    frames = first.frames(phi1), second.frames(phi1)
    assert float(sf[0] - frames[0].s[0]) == pytest.approx(u, abs=1e-9)
    points = first.flank_points(frames[0], sf, sigma), second.flank_points(frames[1], sf, -sigma)
    assert abs(points[0][0] - one) < 1e-9
    assert abs(points[1][0] - two) < 1e-9
    normals = first.normals(frames[0], sigma), second.normals(frames[1], -sigma)
    turned = normals[0] * np.exp(-1j * phi1), normals[1] * np.exp(-1j * driven_angles(name, phi1))
    assert abs(turned[0][0] - turned[1][0]) < 1e-12


@pytest.mark.parametrize("name", LAWS)
@pytest.mark.parametrize("side", [DRIVE, COAST])
def test_a_contact_lies_on_both_flanks_and_nothing_leads(name: str, side: int) -> None:
    """Carried into the ring, a contact lies on its flank, and their tangents are one line."""
    result, phi1 = made(name), phases()
    pairs, distance = flank_pairs(result.gears, side), result.pair.center_distance
    found = contacts(pairs, phi1)
    assert np.abs(found.lead).max() < 1e-12
    turn = np.exp(1j * driven_angles(name, phi1))[found.step]
    seen, force = (found.point + distance) * turn, found.force * turn
    toothing, places = pairs.wheels[1].toothing, pairs.wheels[1].place(found.pair)

    def apart(roll: Array) -> tuple[Plane, Plane]:
        frames = toothing.frames(roll)
        off = seen - toothing.flank_points(frames, places, -side)
        return off, toothing.flank_motion(frames, places, -side)

    roll = phi1[found.step] - 1e-3  # a poor guess: the flank is searched by its own formula
    for _ in range(8):
        off, along = apart(roll)
        roll = roll + np.real(off * np.conj(along)) / np.abs(along) ** 2
    off, along = apart(roll)
    assert np.abs(off).max() < 1e-9
    assert np.abs(np.real(force * np.conj(along)) / np.abs(along)).max() < 1e-9
    assert np.bincount(found.step, minlength=len(phi1)).min() >= 1


@pytest.mark.parametrize("name", LAWS)
@pytest.mark.parametrize("side", [DRIVE, COAST])
def test_sliding_is_the_difference_of_the_velocities(name: str, side: int) -> None:
    """Both turn clockwise; what the driver's point has more than the ring's slides, tip outward."""
    result, phi1 = made(name), phases()
    found = contacts(flank_pairs(result.gears, side), phi1)
    ratio = result.law.derivatives(phi1, 1)[1][found.step]
    relative = -1j * found.point + 1j * ratio * (found.point + result.pair.center_distance)
    tangent = 1j * found.force
    outward = tangent * np.sign(np.real(tangent * np.conj(found.point)))
    # a point of contact moves on the driver against the driver's own material
    assert found.sliding == pytest.approx(-np.real(relative * np.conj(outward)), abs=1e-9)
    across = np.real(relative * np.conj(found.force))
    assert np.abs(across).max() < 1e-9
    levers = (
        np.imag(np.conj(found.point) * found.force),
        np.imag(np.conj(found.point + result.pair.center_distance) * found.force),
    )
    assert found.lever == pytest.approx(np.abs(levers), abs=1e-12)


def test_the_pressure_angle_at_the_pitch_point_is_told_by_the_slope_of_the_centrode() -> None:
    """alpha less the slope on the flanks that drive, and more on the others, as outside."""
    result = made("asymmetric")
    for side, way, sign in ((DRIVE, "forward", -1.0), (COAST, "backward", 1.0)):
        place, most = result.subject.pressure_angles[way]
        phi1 = np.append(np.linspace(0.0, 2.0 * math.pi, 721), place)
        radius = result.pair.rolling.radii(phi1 % (2.0 * math.pi), 1)
        expected = ALPHA + sign * np.arctan(radius[1] / radius[0])
        assert most == pytest.approx(expected.max(), abs=1e-9)
        found = contacts(flank_pairs(result.gears, side), phi1)
        assert found.pressure_angle == pytest.approx(expected[found.step], abs=1e-9)


@pytest.mark.parametrize(
    ("teeth", "ratio"),
    [
        ((28, 37), 2.281837124),
        ((28, 40), 2.190603171),
        ((40, 48), 2.10811715),
        ((40, 49), 2.098621311),
    ],
)
def test_contact_ratios_of_circular_rings(teeth: tuple[int, int], ratio: float) -> None:
    """000, eq. 4.63: from the tips of both wheels, full height, module 1."""
    result = pair_of(ROUND, teeth, 1.0, DEEP)
    assert result.contact_ratio == pytest.approx(ratio, abs=1e-9)
    assert result.contact_ratios["contact_ratio"] == pytest.approx(ratio, abs=1e-9)


@pytest.mark.parametrize("more", [-0.1, -0.3, 0.1])
def test_a_circular_ring_off_its_distance_is_an_involute_ring(more: float) -> None:
    """cos(alpha_w) = cos(alpha)*A/A', and the play 2*A'*(inv(alpha) - inv(alpha_w)) at the ring."""
    result, phi1 = made("circular"), phases()
    distance = result.pair.center_distance + more
    angle = math.acos(math.cos(ALPHA) * result.pair.center_distance / distance)
    leads = []
    for side in (DRIVE, COAST):
        pairs = flank_pairs(result.gears, side, -distance)
        found = contacts(pairs, phi1)
        assert found.pressure_angle == pytest.approx(angle, abs=1e-11)
        leads.append(first_touch(pairs, phi1, found)[0])
    radius = distance * 40 / 12  # the ring's pitch circle as mounted
    play = 2.0 * distance * (involute(ALPHA) - involute(angle)) / radius
    assert leads[1] - leads[0] == pytest.approx(play, abs=1e-12)
    assert np.sign(play) == -np.sign(more)
    meshing = study(result.gears, MeshingSpec(steps=12, center_distance=distance))
    told = numbers(meshing)
    assert told["center_distance_mm"] == pytest.approx(distance, abs=1e-12)
    assert meshing.every("backlash") == pytest.approx(20.0 * play, abs=1e-11)


def test_backlash_as_made_is_taken_up() -> None:
    """Driven it is behind, held back ahead; the levers of both sides are r2*cos(alpha -+ psi)."""
    law, teeth, module, rack = LAWS["asymmetric"]
    result = job(law, teeth, module=module, rack=rack, internal=True, backlash=0.005)
    leads = []
    for side in (DRIVE, COAST):
        pairs = flank_pairs(result.gears, side)
        leads.append(first_touch(pairs, phases(), contacts(pairs, phases()))[0])
    assert leads[0].max() < 0.0 < leads[1].min()
    one, two = (track.frames(phases()) for track in result.pair.rolling.tracks)
    psi = np.arctan(np.real(np.conj(one.p) * one.t) / np.imag(np.conj(one.p) * one.t))
    play = 0.005 / (1.0 - (np.tan(ALPHA) * np.tan(psi)) ** 2)
    along = np.imag(np.conj(two.p) * two.t)  # mm that a turn of 1 moves along the pitch line
    assert (leads[1] - leads[0]) * along == pytest.approx(play, rel=1e-3)
    found = numbers(study(result.gears, MeshingSpec(steps=12)))["backlash_mm"]
    assert (found["min"], found["max"]) == pytest.approx((play.min(), play.max()), rel=0.01)


@pytest.mark.parametrize("name", ["one lobe", "asymmetric"])
@pytest.mark.parametrize("side", [DRIVE, COAST])
@pytest.mark.parametrize("more", few([0.1, 0.0, -0.1]))
@pytest.mark.parametrize("every", few([2, 1]))
def test_first_touch_is_that_of_dense_points(name: str, side: int, more: float, every: int) -> None:
    phi1 = phases(5)[::every]
    distance = made(name).pair.center_distance + more
    pairs = flank_pairs(made(name).gears, side, -distance)
    found = touches(pairs, phi1)
    outward = np.full(len(phi1), -np.inf)
    np.maximum.at(outward, found.step, -side * found.turn)
    driven = driven_angles(name, phi1)
    expected = [
        dense_touch(made(name), side, *angles, distance, internal=True)
        for angles in zip(phi1.tolist(), driven.tolist(), strict=True)
    ]
    assert -side * outward == pytest.approx(expected, abs=1e-7)
    assert first_touch(pairs, phi1, contacts(pairs, phi1))[0] == pytest.approx(expected, abs=1e-7)


def test_columns_of_a_ring() -> None:
    """The pitch point is farther from the ring's shaft by A, and round parts count as concave."""
    result = made("asymmetric")
    table, distance = result.centrodes(361), result.pair.center_distance
    assert table["r2_mm"] - table["r1_mm"] == pytest.approx(distance, abs=1e-12)
    driven = np.radians(table["phi2_deg"])
    points = table["r2_mm"] * np.exp(1j * driven)
    assert table["x2_mm"] + 1j * table["y2_mm"] == pytest.approx(points, abs=1e-12)
    # the geometric curvature, positive where round, by finite differences of the points
    dx, dy = (np.gradient(table[axis], table["s_mm"]) for axis in ("x2_mm", "y2_mm"))
    bend = dx * np.gradient(dy, table["s_mm"]) - dy * np.gradient(dx, table["s_mm"])
    assert (-1.0 / table["rho2_mm"])[3:-3] == pytest.approx(bend[3:-3], abs=3e-4)
    assert bend.max() > 0.02
    found = result.contact(phases(), "drive")
    point = found["x_mm"] + 1j * found["y_mm"]
    assert found["contact_radius2_mm"] == pytest.approx(np.abs(point + distance), abs=1e-12)
    assert np.radians(found["phi2_deg"]) == pytest.approx(
        driven_angles("asymmetric", np.radians(found["phi1_deg"])), abs=1e-12
    )
    assert result.chart("curvature").lines[1].y.min() == pytest.approx(-bend.max(), abs=3e-4)


def test_flanks_that_hug_each_other_do_not_interfere() -> None:
    """In a large ring of nearly as many teeth a patch is a strip as long as its flanks."""
    made = job(Constant(), (200, 250), module=2.0, backlash=0.1, internal=True)
    found = study(made.gears, MeshingSpec(steps=6))
    assert not found.every("interferes").any()
    assert numbers(found)["pairs_in_contact"]["min"] >= 3
