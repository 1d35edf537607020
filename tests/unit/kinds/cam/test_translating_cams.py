"""Translating cams: reading, refusals, parts, Python."""

from __future__ import annotations

import math

import numpy as np
import pytest
import shapely

import gearcam
from gearcam.base.errors import DesignError, InfeasibleError
from gearcam.designs import loads
from gearcam.numeric.arrays import as_pairs
from gearcam.results.advice import Search
from helpers_files import DEEP, EDGE, PLATE, built, read, refused, sliding_of
from helpers_sampling import few
from helpers_step import read_step


@pytest.mark.parametrize(
    ("text", "old", "new", "key", "words"),
    [
        (PLATE, "travel_mm = 30", "angle_deg = 30", "motion[1].angle_deg", "cam slides; travel_mm"),
        (PLATE, "travel_mm = 30", "travel_mm = 'rest'", "motion[1].travel_mm", "not a number"),
        (PLATE, "travel_mm = 30\n", "", "motion[1].travel_mm", "is missing"),
        (PLATE, 'form = "translating"', 'form = "disc"', "motion[0].travel_mm", "turns; angle_deg"),
        (EDGE, 'type = "roller"\nroller_radius_mm = 6', 'type = "flat"', "follower.type",
         "envelops no profile"),
        (PLATE, "height_mm = 60\n", "", "blank.height_mm", "is missing"),
        (PLATE, "height_mm = 60", "height_mm = 60\nbore_diameter_mm = 9", "blank.bore_diameter_mm",
         "does not apply to a translating cam"),
        (PLATE, "travel_mm = 80", "theta_deg = 80", "output.theta_deg",
         "does not apply to a translating cam"),
        (PLATE, "[cam]", "[cam]\nprime_radius_mm = 40", "cam.prime_radius_mm", "does not apply to"),
        (PLATE, DEEP, "groove_depth_mm = 12\n", "cam.groove_depth_mm", "no floor"),
        (PLATE, DEEP, 'side = "front"\n', "cam.groove_depth_mm", "is missing beside side"),
        (PLATE, 'walls = "both"\n', "", "cam.groove_depth_mm", "not apply to a cam with one wall"),
        (PLATE, "bolt_height_mm = 8\n", "", "blank.bolt_height_mm", "is missing beside bolts"),
        (PLATE, "[output]", "[output]\nkerf_mm = 0.2", "output.kerf_mm", "milled"),
        (PLATE, "density", "clearance_mm = 0.1\ndensity", "blank.clearance_mm", "roller_clearance"),
        (EDGE, "[cam]", "pivot_height_mm = 5\n[cam]", "follower.pivot_height_mm", "no pivot"),
        (EDGE, "law = \"3-4-5\"\nlift_mm = 15", "law = \"3-4-5\"", "motion[0].lift_mm", "missing"),
    ],
)  # fmt: skip
def test_what_is_wrong_by_reading(text: str, old: str, new: str, key: str, words: str) -> None:
    assert words in refused(text, (old, new))[key]


def test_a_turn_is_no_way() -> None:
    text = EDGE[: EDGE.index("[[motion]]")] + EDGE[EDGE.index("[follower]") :]
    with pytest.raises(DesignError, match="is given over a turn"):
        loads(text + '[motion]\nlift = "theta"\n')


@pytest.mark.parametrize(
    ("text", "change", "where", "limit"),
    [
        (EDGE, ("height_mm = 40", "height_mm = 14.9"), "blank.height_mm", 15.0),
        (PLATE, ("height_mm = 60", "height_mm = 27"), "blank.height_mm", 27.05),
        (EDGE, ("height_mm = 40", "height_mm = 40\nlength_mm = 169"), "blank.length_mm", 170.0),
        (
            PLATE,
            ("height_mm = 60", "height_mm = 60\nlength_mm = 182"),
            "blank.length_mm",
            182.05,
        ),
    ],
)
def test_plates_that_are_too_small(
    text: str, change: tuple[str, str], where: str, limit: float
) -> None:
    with pytest.raises(InfeasibleError) as caught:
        _ = built(text, change).cam
    assert caught.value.where == where
    assert caught.value.limit == pytest.approx(limit)
    key, value = change[1].rsplit(" = ", 1)[0], math.nextafter(limit, math.inf)
    assert sliding_of(built(text, (change[0], f"{key} = {value!r}"))).walls


def test_arms_that_cannot() -> None:
    arm = "arm_mm = 70\npivot_distance_mm = 65\npivot_height_mm = {}\n[cam]"
    swing = (
        ("[follower]", '[follower]\nmotion = "oscillating"'),
        ("lift_mm = 15", "lift_deg = 12"),
    )
    with pytest.raises(InfeasibleError, match="does not reach down") as caught:
        _ = built(EDGE, *swing, ("[cam]", arm.format(70))).cam
    assert caught.value.limit == pytest.approx(70.0)
    high = (("lift_mm = 15", "lift_deg = 120"), swing[0], ("[cam]", arm.format(25)))
    with pytest.raises(InfeasibleError, match="perpendicular to the cam's travel") as caught:
        _ = built(EDGE, *high).cam
    assert caught.value.limit == pytest.approx(90.0 + math.degrees(math.asin(25.0 / 70.0)))


def test_a_wall_that_is_undercut_where_its_way_begins() -> None:
    steep = (("radius_mm = 6", "radius_mm = 12"), ("travel_mm = 60", "travel_mm = 20"))
    with pytest.raises(InfeasibleError, match="beginning or end of its travel") as caught:
        _ = sliding_of(built(PLATE, *steep, ("run_in_mm = 20\n", ""))).groove
    (way,) = caught.value.adjustments
    run = way.far["cam.run_in_mm"]
    made = sliding_of(built(PLATE, *steep, ("run_in_mm = 20", f"run_in_mm = {run}")))
    assert made.groove is not None
    assert made.walls[1].corners


def test_the_motion_is_told_along_the_way() -> None:
    result = built(EDGE)
    table = result.motion()
    assert table["travel_mm"][[0, -1]].tolist() == [0.0, 170.0]
    middle = result.motion([50.0])
    assert middle["velocity_mm_per_mm"][0] == pytest.approx(1.875 * 15.0 / 60.0)
    assert middle["lift_mm"][0] == pytest.approx(7.5)
    half = result.motion([20.0 + 1e-9])["jerk_mm_per_mm3"][0]
    assert half == pytest.approx(60.0 * 15.0 / 60.0**3, rel=1e-6)
    assert result.facts["motion.peak_velocity"] == pytest.approx(0.75)


@pytest.mark.parametrize("adjustments", [-1e-3, [0.0, 170.001], math.inf])
def test_ways_beyond_the_cam_are_refused(adjustments: float | list[float]) -> None:
    result = built(EDGE)
    for table in (result.motion, result.contact):
        with pytest.raises(DesignError, match="mm, from 0 to 170"):
            table(adjustments)
    np.testing.assert_array_equal(result.motion([0.0, 170.0 + 1e-12])["lift_mm"], 0.0)


def test_contact_in_both_frames() -> None:
    result = built(PLATE)
    for wall, side in (("lower", 1.0), ("upper", -1.0)):
        table = result.contact(np.linspace(0.0, 170.0, 18), wall=wall)
        np.testing.assert_allclose(
            table["fixed_x_mm"], table["x_mm"] + table["travel_mm"], atol=1e-12
        )
        lift = result.motion(table["travel_mm"])["lift_mm"]
        np.testing.assert_allclose(
            np.hypot(table["fixed_x_mm"], table["fixed_y_mm"] - lift), 6.025, atol=1e-12
        )
        assert np.all(side * table["ny"] > 0.5)


def test_charts_go_along_the_way() -> None:
    result = built(PLATE)
    for name in result.charts:
        chart = result.chart(name)
        assert chart.x == "travel u, mm"
        assert chart.lines[0].x[-1] == pytest.approx(170.0)


@pytest.mark.slow
@pytest.mark.parametrize("depth", few([8.0, None]))
def test_the_solid_is_the_plate_less_its_groove(depth: float | None) -> None:
    result = built(PLATE, *([] if depth else [(DEEP, "")]))
    (mesh,) = result.solids.values()
    cam = sliding_of(result)
    assert cam.groove is not None
    bolts = 2.0 * 0.25 * math.pi * 6.6**2
    plate = 12.0 * (194.1 * 60.0 - bolts)
    expected = plate - cam.groove.moments.area * (depth or 12.0)
    assert mesh.is_watertight
    places = [one["center_mm"] for one in result.facts["part.openings"] if one["kind"] == "hole"]
    np.testing.assert_allclose(places, [[-165.0, -14.5], [-5.0, -14.5]])
    assert mesh.volume == pytest.approx(expected, abs=10.0)
    assert result.part.volume == pytest.approx(expected, rel=1e-9)
    (solid,) = read_step(result.files("step")["cam.step"])
    assert solid.volume == pytest.approx(expected, rel=1e-6)


def test_one_wall_is_the_edge_of_its_plate() -> None:
    result = built(EDGE, ("height_mm = 40", "height_mm = 40\nlength_mm = 180"))
    cam = sliding_of(result)
    x, y = cam.edge.vertices.T
    assert (x.min(), x.max()) == (-175.0, 5.0)
    assert (y.min(), y.max()) == pytest.approx((-31.0, 9.0), abs=1e-3)
    # below the pitch curve, where both laws rise by half on the mean, less the roller's strip
    under = 170.0 * 31.0 + 15.0 * (0.5 * 60.0 + 30.0 + 0.5 * 40.0)
    expected = under - 6.0 * cam.lower.size.perimeter + 10.0 * 25.0
    assert cam.edge.moments.area == pytest.approx(expected, rel=1e-9)
    (mesh,) = result.solids.values()
    assert mesh.volume == pytest.approx(10.0 * cam.edge.moments.area, rel=1e-5)


@pytest.mark.parametrize("walls", ["lower", "both"])
def test_beyond_a_slope_the_plate_follows_the_roller(walls: str) -> None:
    """The way ends on a rise or on a return: the roller there must not meet the plate."""
    text = EDGE[: EDGE.index("[[motion]]")] + EDGE[EDGE.index("[follower]") :]
    for law, lift in (("rise", 9.0), ("return", 9.0)):
        motion = f'[[motion]]\ntype = "{law}"\ntravel_mm = 20\nlaw = "constant-velocity"\n'
        runs = "run_in_mm = 20\nrun_out_mm = 20\n"
        cam = sliding_of(
            built(
                text.replace("[follower]", f"{motion}lift_mm = {lift}\n[follower]"),
                (runs, f'walls = "{walls}"\n'),
                ("height_mm = 40", "height_mm = 40\nlength_mm = 60"),
            )
        )
        rollers = [
            shapely.Point(point).buffer(6.0, quad_segs=256)
            for point in as_pairs(cam.lower.pitch_line)
        ]
        taken = shapely.union_all(rollers)
        for wall in cam.walls:
            assert shapely.intersection(wall.contour.polygon, taken).area < 0.02


def test_clearance_is_taken_off_the_wall_alone() -> None:
    result = built(EDGE, ("height_mm = 40", "height_mm = 40\nclearance_mm = 0.5"))
    x, y = result.contour.vertices.T
    assert (x.min(), x.max(), y.min()) == (-170.0, 0.0, -31.0)
    wall = shapely.LineString(as_pairs(sliding_of(result).lower.line))
    points = shapely.points(result.contour.vertices[(y > -7.0) & (x > -169.0) & (x < -1.0)])
    np.testing.assert_allclose(shapely.distance(points, wall), 0.5, atol=2e-3)
    rows = result.files("inspection")["inspection.csv"].decode().splitlines()
    table = np.loadtxt(rows, delimiter=",", skiprows=1)
    on = shapely.distance(shapely.points(table[:, 1:3]), result.contour.polygon.boundary)
    assert on.max() < 2e-3


@pytest.mark.parametrize(
    ("key", "value"),
    few(
        [
            ("blank.height_mm", 20),  # its bolts need room besides
            ("blank.bolt_height_mm", 20),
            ("blank.bolt_spacing_mm", 200),
        ],
        3,
    ),
)
def test_what_the_plate_has_no_room_for_is_moved(key: str, value: float) -> None:
    result = gearcam.build(read(PLATE).with_({key: value}))
    with pytest.raises(InfeasibleError) as caught:
        _ = result.parts
    search = Search(result, None, frozenset(), 60.0)
    search.follow(caught.value.adjustments)
    found = {tuple(remedy.changes): remedy.design for remedy in search.found}
    assert gearcam.build(found[key,]).parts


def test_findings_are_told_along_the_way() -> None:
    result = built(PLATE, ("pressure_angle_deg = 37", "pressure_angle_deg = 30"))
    (found,) = [one for one in result.findings if one.code == "pressure-angle"]
    assert found.where == "return, at 130 mm"
    sharp = built(EDGE, ("radius_mm = 6", "radius_mm = 22"))
    cut = [one for one in sharp.findings if one.code == "undercut"]
    assert len(cut) == 1
    assert cut[0].where.endswith(" mm")
    hard = built(EDGE, ('"cycloidal"', '"constant-velocity"'))
    (first, second) = [one for one in hard.findings if one.code == "velocity-jump"]
    assert (first.where, second.where) == ("at 110 mm", "at 150 mm")
    assert first.unit == "mm/mm"
    assert first.value == pytest.approx(-15.0 / 40.0)


def test_a_cam_made_in_python_is_the_one_of_the_file() -> None:
    phases = [
        gearcam.RisePhase(angle=60.0, law=gearcam.motion_laws.Polynomial345(), lift=15.0),
        gearcam.DwellPhase(angle=30.0),
        gearcam.ReturnPhase(angle=40.0, law=gearcam.motion_laws.Cycloidal()),
    ]
    design = gearcam.CamDesign(
        name="one",
        motion=phases,
        follower=gearcam.FollowerSpec(type="roller", roller_radius=6.0),
        cam=gearcam.PlateSpec(run_in=20.0, run_out=20.0),
        blank=gearcam.PlateBlank(height=40.0),
    )
    assert design == read(EDGE)
