"""The flanks of the two wheels touch through the mesh, with phi2 and s from the mpmath oracle.

Twenty contacts of each law, spread over the turn, both tooth sides. The flank of wheel 1 is carried
into wheel 2 by the motion that the oracle gives, and held against wheel 2's own flank.
"""

from __future__ import annotations

from functools import cache
from typing import Any, NamedTuple

import numpy as np
import pytest

from gearcam.base.tolerances import DEFAULT
from gearcam.gears.cutter import choose_cutter
from gearcam.gears.flank import Toothing
from gearcam.gears.rolling import roll
from gearcam.gears.spec import BasicRack
from gearcam.gears.track import Wheel
from gearcam.laws.ratio.ellipse import Ellipse
from gearcam.laws.ratio.formula import Formula
from gearcam.laws.ratio.phases import Phases
from gearcam.laws.ratio.span import Lobes
from helpers_sampling import few
from witness import laws, oracle
from witness.oracle import mp

COUNT = 20
ALLOWED = 1e-9
SHIFT = 1e-3


class Case(NamedTuple):
    law: Any
    exact: laws.Law
    distance: float
    module: float


CASES = {
    "two phases": Case(
        Phases(shape="cosine", knots=tuple(np.radians([0, 160, 360])), ratios=(1.6, 0.4, 1.6)),
        laws.NAIL_TWO,
        180.0,
        4.923,
    ),
    "three phases": Case(
        Phases(
            shape="cosine",
            knots=tuple(np.radians([0, 160, 270, 360])),
            ratios=(1.6, 0.4, "solve", 1.6),
        ),
        laws.NAIL_THREE,
        180.0,
        4.9605,
    ),
    "ellipse": Case(Ellipse(eccentricity=0.3), laws.ellipse(0.3), 80.0, 2.0),
    "formula": Case(Formula(phi2="phi1 - 0.08*sin(2*phi1)"), laws.wave(0.08, 2), 36.0, 1.5),
}


class Contact(NamedTuple):
    """A contact of the pair: driver angle, driven angle, arc length, flank, side."""

    phi: float
    driven: float
    s: float
    reach: float
    side: int


@cache
def contacts(name: str) -> tuple[Contact, ...]:
    case = CASES[name]
    pair = oracle.Pair(case.exact, mp.mpf(case.distance))
    found = []
    for j in range(COUNT):
        phi = mp.mpf(repr(0.07 + j * 2 * np.pi / COUNT))
        side = 1 if j % 2 else -1
        reach = case.module * (-1.8 + 3.6 * ((j * 7) % COUNT) / COUNT)
        driven, s = float(pair.driven_angle(phi)), float(pair.arc_length(phi))
        found.append(Contact(float(phi), driven, s, reach, side))
    return tuple(found)


@cache
def wheels(name: str) -> tuple[Toothing, Toothing]:
    case = CASES[name]
    rolling = roll(
        case.law.build(Lobes(1, 1), DEFAULT),
        teeth=(36, 36),
        center_distance=case.distance,
        module=None,
        tolerances=DEFAULT,
    )
    cutter = choose_cutter(BasicRack(), case.module, 0.0)
    first, second = (
        Toothing(track=rolling.tracks[number - 1], wheel=number, teeth=36, cutter=cutter)
        for number in (1, 2)
    )
    return first, second


def flank(toothing: Toothing, place: float, side: int, phi: float | np.ndarray) -> np.ndarray:
    angle = np.atleast_1d(np.asarray(phi, dtype=float))
    sf, sigma = np.full_like(angle, place), np.full_like(angle, side)
    return toothing.flank_points(toothing.frames(angle), sf, sigma)


def gap(toothing: Toothing, place: float, side: int, phi: float, point: complex) -> float:
    """Signed distance of a point from a flank, along the normal at its nearest point."""
    near = phi
    for _ in range(8):
        step = 1e-5
        before, here, after = flank(toothing, place, side, near + step * np.array([-1, 0, 1]))
        slope = (after - before) / (2 * step)
        near += float(np.real(np.conj(slope) * (point - here))) / abs(slope) ** 2
    before, here, after = flank(toothing, place, side, near + 1e-5 * np.array([-1, 0, 1]))
    forward = (after - before) / abs(after - before)
    return float(np.imag(np.conj(forward) * (point - here)))


def gaps(name: str, shift: float = 0.0, wheel: Wheel = 2) -> np.ndarray:
    """Gap at each contact; one wheel's flank moved by `shift` along its normal."""
    first, second = wheels(name)
    distance = CASES[name].distance
    along = shift / float(mp.cos(mp.pi / 9))
    result = []
    for phi, driven, s, reach, side in contacts(name):
        place = s + reach
        moved = [place + (along if number == wheel else 0.0) for number in (1, 2)]
        point = flank(first, moved[0], side, phi)[0]
        assembled = point * np.exp(-1j * phi)
        in_second = (assembled - distance) * np.exp(-1j * driven)
        result.append(gap(second, moved[1], -side, phi, in_second))
    return np.array(result)


@pytest.mark.parametrize("name", few(CASES, 4))
def test_flanks_touch_through_the_mesh(name: str) -> None:
    assert np.abs(gaps(name)).max() < ALLOWED


@pytest.mark.parametrize("name", few(CASES))
@pytest.mark.parametrize("wheel", [1, 2])
def test_a_flank_shifted_by_a_micrometre_shows_as_a_micrometre(name: str, wheel: Wheel) -> None:
    assert np.abs(gaps(name, SHIFT, wheel)) == pytest.approx(SHIFT, rel=1e-3)


@pytest.mark.parametrize("name", CASES)
def test_the_contact_lies_on_the_line_of_action(name: str) -> None:
    """Wheel 1 alone against the oracle: pitch point plus reach along the rack's normal."""
    first, _ = wheels(name)
    pair = oracle.Pair(CASES[name].exact, mp.mpf(CASES[name].distance))
    for phi, _, s, reach, side in contacts(name):
        point = flank(first, s + reach, side, phi)[0] * np.exp(-1j * phi)
        radius, slope, _ = (complex(x) for x in pair.driver_radius(mp.mpf(phi)))
        tangent = (slope + 1j * radius) / abs(slope + 1j * radius)
        normal = tangent * np.exp(-1j * side * np.pi / 9)
        assert abs(point - radius - reach * np.cos(np.pi / 9) * normal) < ALLOWED
