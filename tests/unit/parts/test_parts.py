"""Parts have the area and volume of what is cut, and timing marks lie on solid metal."""

from __future__ import annotations

import cmath
import math
from dataclasses import fields

import numpy as np
import pytest

from gearcam.base.errors import InfeasibleError
from gearcam.base.quantities import params_of
from gearcam.kinds.gear_pair.drawings import pair_drawing
from gearcam.numeric.arrays import as_pairs
from gearcam.numeric.contour import Contour, Run
from gearcam.numeric.pose import Pose
from gearcam.parts.blank import Blank
from gearcam.parts.body import Hub, Mark, Opening, Part
from gearcam.parts.marks import timing_mark
from gearcam.parts.shapes import Loop
from gearcam.pictures.drawings import Circle, Cross, Path, chains, placed, wheel_drawing
from helpers_contour import bore, gear_contour, layers, square_contour


def reverse(contour: Contour) -> Contour:
    """The same curve, clockwise."""
    runs = tuple(Run(points=r.points[::-1], tangents=-r.tangents[::-1]) for r in contour.runs[::-1])
    return Contour(dense=lambda: runs, points=contour.points[::-1], tolerance=1e-3, chord_error=0.0)


def test_area_and_volume_of_a_square_plate() -> None:
    mark = Mark(center=complex(12.0, 0.0), diameter=2.0, depth=0.5)
    part = Part(
        name="plate",
        contours=(square_contour(30.0),),
        openings=bore(10.0),
        width=8.0,
        marks=(mark,),
    )
    assert part.steps[0].moments.area == pytest.approx(900 - 25 * math.pi, rel=1e-14)
    assert part.volume == pytest.approx((900 - 25 * math.pi) * 8 - 0.5 * math.pi, rel=1e-14)
    assert part.region.area == pytest.approx(part.steps[0].moments.area, rel=1e-4)
    assert len(part.region.interiors) == 1


def test_a_part_without_bore_has_none() -> None:
    part = Part(name="plate", contours=(square_contour(30.0),), width=8.0)
    assert part.steps[0].moments.area == pytest.approx(900, rel=1e-14)
    assert len(part.region.interiors) == 0
    assert layers(wheel_drawing(part)) == ["OUTLINE"]


def test_a_hub_has_the_holes_that_lie_within_it() -> None:
    """The bore goes through the hub; a bolt hole outside of it does not, nor one on its edge."""
    holes = tuple(
        Opening(kind="HOLE", shape=Circle(center=complex(x, 0.0), diameter=2.0), name=f"hole {x}")
        for x in (9.5, 13.0)
    )
    part = Part(
        name="plate",
        contours=(square_contour(30.0),),
        openings=bore(10.0) + holes,
        width=8.0,
        hub=Hub(diameter=20.0, front=3.0, back=4.0),
    )
    assert [(one.low, one.high) for one in part.bosses] == [(-4.0, 0.0), (8.0, 11.0)]
    assert all([o.name for o in one.openings] == ["bore"] for one in part.bosses)
    plate, boss = 900 - 27 * math.pi, 75 * math.pi
    assert part.volume == pytest.approx(8 * plate + 7 * boss, rel=1e-14)
    assert part.thickness == pytest.approx(15.0)


def test_wrong_parts_are_refused() -> None:
    contour = square_contour(30.0)
    with pytest.raises(ValueError, match="counter-clockwise"):
        Part(name="p", contours=(reverse(contour),), width=8.0)
    with pytest.raises(ValueError, match="width"):
        Part(name="p", contours=(contour,), width=0.0)
    with pytest.raises(ValueError, match="diameter must be positive"):
        bore(-1.0)


def test_the_blank_is_a_parameter_set() -> None:
    assert Blank().bore_diameter is None
    assert [f.name for f in fields(Blank)] == list(params_of(Blank))
    assert params_of(Blank)["bore_diameter"].key("bore_diameter") == "bore_diameter_mm"


def test_the_marks_face_each_other_on_the_line_of_centres() -> None:
    first = timing_mark(100.0, 0.0, 5.0, 6.25, 50.0, bore_reach=20.0)
    second = timing_mark(80.0, math.pi, 5.0, 6.25, 50.0, bore_reach=20.0)
    assert first.diameter == second.diameter == pytest.approx(2.0)
    assert first.depth == 0.5
    assert first.center == pytest.approx(100 - 6.25 - 1 - 1, abs=1e-12)
    assert second.center == pytest.approx(-(80 - 6.25 - 1 - 1), abs=1e-12)


def test_a_mark_lies_in_its_direction() -> None:
    center = timing_mark(100.0, 2.0, 5.0, 6.25, 50.0).center
    assert cmath.polar(center) == pytest.approx((91.75, 2.0))


def test_a_thin_wheel_gets_a_shallow_mark() -> None:
    assert timing_mark(100.0, 0.0, 5.0, 6.25, 2.0).depth == pytest.approx(0.2)


@pytest.mark.parametrize("rim", [0.01, 0.3, 1.0, 2.9, 3.1, 50.0])
@pytest.mark.parametrize("tilt", [0.0, 0.6])
def test_a_mark_lies_between_bore_and_root(rim: float, tilt: float) -> None:
    """Distances to the root along the centrode's normal, to the bore along the radius."""
    hole = 2 * (100 - (6.25 + rim) / math.cos(tilt))
    mark = timing_mark(100.0, 0.0, 5.0, 6.25, 10.0, bore_reach=hole / 2, tilt=tilt)
    to_bore = mark.center.real - hole / 2 - mark.diameter / 2
    to_root = (100 - mark.center.real) * math.cos(tilt) - 6.25 - mark.diameter / 2
    assert to_bore > 0.2 * rim
    assert to_root > min(0.9, 0.3 * rim)
    assert 0 < mark.diameter <= 2.0


def test_no_rim_no_mark() -> None:
    with pytest.raises(InfeasibleError, match="no room for a timing mark") as caught:
        timing_mark(100.0, 0.0, 5.0, 6.25, 10.0, bore_reach=93.75)
    assert caught.value.limit == pytest.approx(187.5)
    assert "limit 187.5 mm" in str(caught.value)
    with pytest.raises(InfeasibleError, match="reach the axis there") as caught:
        timing_mark(6.2, 0.0, 5.0, 6.25, 10.0)
    assert (caught.value.value, caught.value.limit) == (None, None)
    assert [way.near for way in caught.value.adjustments] == [{"blank.timing_marks": False}]


def test_circle_points_keep_the_sagitta() -> None:
    points = Circle(center=complex(1.0, 2.0), diameter=40.0).polyline(1e-3)
    assert np.abs(points - (1 + 2j)) == pytest.approx(20.0, abs=1e-12)
    middles = 0.5 * (points + np.roll(points, -1)) - (1 + 2j)
    sagitta = 20 - np.abs(middles).min()
    assert 0.9e-3 < sagitta <= 1e-3


def test_placing_turns_then_shifts() -> None:
    contour = gear_contour(8, 3.0)
    moved = placed(contour, Pose(0.4, 10.0 - 3.0j))
    assert isinstance(moved, Contour)
    c, s = math.cos(0.4), math.sin(0.4)
    turn = np.array([[c, -s], [s, c]])
    assert moved.vertices == pytest.approx(contour.vertices @ turn.T + [10, -3], abs=1e-12)
    before, after = (as_pairs(one.runs[3].points) for one in (contour, moved))
    assert after == pytest.approx(before @ turn.T + [10, -3], abs=1e-12)
    before, after = (as_pairs(one.runs[3].tangents) for one in (contour, moved))
    assert after == pytest.approx(before @ turn.T, abs=1e-12)
    assert moved.area == pytest.approx(contour.area, rel=1e-12)
    circle = placed(Circle(center=complex(1.0, 0.0), diameter=2.0), Pose(math.pi / 2, 5.0))
    assert isinstance(circle, Circle)
    assert circle.center == pytest.approx(5.0 + 1.0j, abs=1e-15)
    assert placed(contour, Pose()) is contour


def test_the_pair_drawing_puts_wheel_two_at_the_centre_distance() -> None:
    contour = gear_contour(8, 3.0)
    part = Part(name="g", contours=(contour,), openings=bore(6.0), width=5.0)
    centrode = Path(points=np.array([12.0, 9.0j, -12.0]))
    drawing = pair_drawing([part, part], 24.0, [centrode, centrode])
    first, second = drawing.contours
    assert second.vertices - first.vertices == pytest.approx(
        np.tile([24.0, 0.0], (len(first.vertices), 1))
    )
    paths = [f.shape for f in drawing.features if isinstance(f.shape, Path)]
    assert paths[1].points[0] == 36.0
    assert layers(drawing) == [
        "GEAR1_OUTLINE", "GEAR1_BORE", "GEAR2_OUTLINE", "GEAR2_BORE", "CENTRODE", "CENTER",
    ]  # fmt: skip
    with pytest.raises(ValueError, match="two parts"):
        pair_drawing([part], 24.0)


@pytest.mark.parametrize("center", [(0.0, 0.0), (7.0, -3.0), (0.5, 0.2)])
def test_a_loop_reaches_as_far_as_its_arcs(center: tuple[float, float]) -> None:
    """A circle of two half circles: its reach is that of the circle, between the vertices."""
    x, y = center
    loop = Loop(points=complex(x, y) + np.array([2.0 + 0j, -2.0]), bulges=np.ones(2))
    assert loop.reach == pytest.approx(math.hypot(x, y) + 2.0, rel=1e-14)
    for height, reach in ((5.0, 7.0), (-5.0, math.hypot(2.0, 5.0))):
        half = np.array([complex(2.0, height), complex(-2.0, height)])  # the upper half of a disc
        assert Loop(points=half, bulges=np.array([1.0, 0.0])).reach == pytest.approx(reach)


def test_chains_of_a_cross_on_the_axis_are_complex() -> None:
    """Its centre may be a real number; a chain of real numbers would lose its heights."""
    across, up = (points for points, _ in chains(Cross(center=3.0, size=2.0), 1e-3))
    assert (across.dtype, up.dtype) == (np.complex128, np.complex128)
    assert across.tolist() == [2.0, 4.0]
    assert up.tolist() == [3.0 - 1.0j, 3.0 + 1.0j]
