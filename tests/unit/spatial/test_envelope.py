"""The kernel: walls, spread and pressure angles against values from elsewhere and differences."""

from __future__ import annotations

import math
from dataclasses import replace

import numpy as np
import pytest

from gearcam.numeric.roots import bracketed_root
from gearcam.spatial.cam import SpatialCam
from gearcam.spatial.envelope import Roller, touched
from gearcam.spatial.guides import RollerGuide, Straight, SwingArm, Turret, carried
from helpers_sampling import few
from helpers_spatial import SPANS, program, reference, swinging
from witness.roller_in_space import Mechanism, cycloidal

deg = math.radians


def height(cam: SpatialCam, radius: float, azimuth: float, side: int) -> float:
    """The wall at a radius and an azimuth, rad, of a wall that is given over theta and x."""
    (wall,) = (
        one for one in replace(cam, outer_radius=radius, floor=20.0).walls if one.side == side
    )

    def point(theta: np.ndarray) -> np.ndarray:
        return wall.contact(theta, wall.edge(theta)[:, None]).points[:, 0]

    def off(theta: np.ndarray) -> np.ndarray:
        x, y, _ = point(theta).T
        return np.angle(np.exp(1j * (np.arctan2(y, x) - azimuth)))

    (theta,) = bracketed_root(off, [-azimuth + 0.8], [-azimuth - 0.8], 1e-15)
    return float(point(np.array([theta]))[0, 2])


STRAIGHT = [  # azimuth, radius, upper, lower: found by a search in 30 digits
    (-20, 40, 9.021239313424, -7.242896047387),
    (-20, 34, 9.101014759292, -7.276057815514),
    (-20, 28.5, 9.254327902867, -7.320349012757),
    (-60, 40, 24.81436181155, 5.185638188447),
    (-60, 28.5, 26.21826964006, 3.781730359941),
    (-95, 40, 36.59363201777, 20.01630208363),
    (-215, 34, 34.70709367215, 16.50600923239),
    (-260, 28.5, 16.45278093509, -3.696188507334),
]
CONE = [
    (-60, 40, 24.75946608031, 5.240533919691),
    (-60, 28.5, 23.34268904083, 6.65731095917),
    (-95, 34, 35.56501312994, 21.00753609808),
    (-215, 28.5, 32.68619597975, 18.54527057607),
    (-260, 34, 14.26032998544, -2.118054146382),
    (-150, 34, 36.94203811575, 23.05796188425),
]
APEX = [
    (-60, 40, 24.752370446, 5.247629554004),
    (-60, 28.5, 22.96099051647, 7.039009483526),
    (-95, 34, 35.41778765282, 21.16230874538),
    (-215, 28.5, 32.38084877685, 18.89688733714),
    (-150, 28.5, 35.7, 24.3),
]
ARM = [
    (-20, 40, -6.099734036253, -22.57516038416),
    (-60, 40, 10.17225574563, -8.932337657582),
    (-60, 28.5, 11.52597973859, -10.05443271375),
    (-95, 34, 21.49235801286, 4.430810665343),
    (-215, 40, 19.231112019, 1.162839536436),
    (-260, 28.5, 1.051729219132, -18.27476805365),
    (-150, 40, 23.52914270615, 7.529142706151),
]


@pytest.mark.parametrize(
    ("cam", "values"),
    few(
        [
            (reference(), STRAIGHT),
            (reference(math.radians(10.0)), CONE),
            (reference(math.atan(0.2)), APEX),
            (swinging(), ARM),
        ]
    ),
    ids=["cylinder", "cone", "cone with its tip on the axis", "arm"],
)
def test_walls_are_where_a_search_finds_them(
    cam: SpatialCam, values: list[tuple[float, float, float, float]]
) -> None:
    for azimuth, radius, upper, lower in values:
        assert height(cam, radius, deg(azimuth), 1) == pytest.approx(upper, abs=1e-9)
        assert height(cam, radius, deg(azimuth), -1) == pytest.approx(lower, abs=1e-9)


def test_the_witness_finds_the_same_walls() -> None:
    lift = Mechanism(lambda t: (0.0 * t, cycloidal(t, 30.0, SPANS)), 8.0, 40.0, math.radians(10.0))
    for azimuth, radius, upper, lower in CONE:
        assert lift.wall(radius, deg(azimuth), 1) == pytest.approx(upper, abs=1e-9)
        assert lift.wall(radius, deg(azimuth), -1) == pytest.approx(lower, abs=1e-9)


def turret(t: float, theta: float, side: int) -> tuple[np.ndarray, float]:
    """A point of a globoidal cam: centre distance 80, roller 10, index 60 deg in 120 deg."""
    index = program(deg(60.0), "modified-sine", oscillating=True)
    at = np.array([deg(theta)])
    axis = carried(Turret(distance=80.0, start=-deg(30.0)), at, *index.derivatives(at, 2))
    contact = touched(axis, Roller(radius=10.0), np.array([[t]]), side)
    return contact.points[0, 0], float(contact.pressure[0, 0])


@pytest.mark.parametrize(
    ("t", "theta", "eta", "plus", "minus"),
    [
        (40, 30, 26.99799582, (36.6460938688, -15.9157613031, -7.4057389183),
         (38.1290237295, -27.255672971, -23.8132775025)),
        (40, 60, 41.34137321, (25.7204786937, -31.3382962377, 7.50787351298),
         (14.2795213063, -37.9437360651, -7.50787351298)),
        (50, 60, 55.7071125, (22.154826856, -21.8499209022, 5.63423495674),
         (7.84517314401, -30.1116033248, -5.63423495674)),
        (45, 100, 20.59857328, (-4.23886749671, -44.3002228593, 29.0283686188),
         (-9.67154407021, -34.5896413636, 12.4093845264)),
    ],
)  # fmt: skip
def test_points_of_a_globoidal_cam(
    t: float, theta: float, eta: float, plus: tuple[float, ...], minus: tuple[float, ...]
) -> None:
    found = [turret(t, theta, side) for side in (1, -1)]
    for wanted in (plus, minus):
        assert min(np.abs(point - wanted).max() for point, _ in found) < 1e-9
    assert math.degrees(found[0][1]) == pytest.approx(eta, abs=1e-8)


@pytest.mark.parametrize(
    ("cam", "values"),
    [
        (
            reference(),
            [(40, 35, 1, 36.7304014586284), (30, 80, -1, 29.7530815502333),
             (28, 97, 1, 39.6059274221649), (35, 200, 1, 43.8176123000212),
             (28, 260, -1, 41.3138409169729)],
        ),
        (
            swinging(),
            [(40, 35, 1, 35.7114299046739), (30, 80, -1, 34.1539799563663),
             (28, 97, 1, 40.703682504248), (35, 200, 1, 42.9764155441619)],
        ),
    ],
    ids=["straight", "arm"],
)  # fmt: skip
def test_the_spread_of_walls(
    cam: SpatialCam, values: list[tuple[float, float, int, float]]
) -> None:
    for x, theta, side, wanted in values:
        found = cam.contact(np.array([deg(theta)]), np.array([[float(x)]]), side).spread
        assert float(found[0, 0]) == pytest.approx(wanted, rel=1e-12)


GUIDES = [
    Straight(height=3.0),
    SwingArm(length=60.0, distance=58.0, start=-0.3, height=5.0),
    Turret(distance=80.0, start=-0.5),
]


@pytest.mark.parametrize("guide", GUIDES, ids=lambda guide: type(guide).__name__)
@pytest.mark.parametrize("half_angle", [0.0, 0.2, -0.3])
@pytest.mark.parametrize("side", [1, -1])
def test_walls_touch_the_roller_and_the_spread_is_their_area(
    guide: RollerGuide, half_angle: float, side: int
) -> None:
    """By central differences: the normal is across both tangents, their area is the spread."""
    lift = program() if isinstance(guide, Straight) else program(0.9, oscillating=True)
    roller = Roller(radius=8.0, at=44.0, half_angle=half_angle)

    def contact(x: float, theta: float) -> tuple[np.ndarray, np.ndarray, float]:
        at = np.array([theta])
        axis = carried(guide, at, *lift.derivatives(at, 2))
        found = touched(axis, roller, np.array([[x]]), side)
        return found.points[0, 0], found.normals[0, 0], float(found.spread[0, 0])

    h = 1e-4
    for x, theta in ((40.0, 0.5), (44.0, 1.2), (47.0, 3.7)):
        _, normal, spread = contact(x, theta)
        by_x = (contact(x + h, theta)[0] - contact(x - h, theta)[0]) / (2.0 * h)
        by_theta = (contact(x, theta + h)[0] - contact(x, theta - h)[0]) / (2.0 * h)
        area = np.cross(by_x, by_theta)
        assert abs(by_x @ normal) < 1e-7
        assert abs(by_theta @ normal) < 1e-4
        assert -side * (area @ normal) == pytest.approx(spread, rel=1e-6)
        assert np.linalg.norm(normal) == pytest.approx(1.0, abs=1e-14)
