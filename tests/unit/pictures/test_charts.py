"""Charts: what they draw is what the facts tell, and where nothing can be drawn they say so."""

from __future__ import annotations

import math
import sys
from pathlib import Path
from typing import Any

import matplotlib as mpl
import numpy as np
import pytest

import gearcam
from arch import rules
from gearcam.base.errors import DesignError, MissingExtraError
from gearcam.compare.page import joined
from gearcam.compare.variants import Variant
from gearcam.designs.design import loads
from gearcam.numeric.piecewise import with_both_sides
from gearcam.pictures.charts import Chart, Limit, Line, MarkedPlace
from helpers_built import built
from helpers_sampling import few

mpl.use("Agg")
PROFILES = sorted((rules.ROOT / "profiles").glob("*.toml"))
PAIR, CAM = (
    rules.ROOT / "profiles" / f"{name}.toml"
    for name in ("nail_machine_two_phase", "plate_cam_offset_roller")
)


def chart(path: Path, name: str) -> Chart:
    return built(path).chart(name)


@pytest.mark.parametrize("path", few(PROFILES[1:], 12), ids=lambda path: path.stem)
def test_every_chart_of_every_design_is_drawn(path):
    import matplotlib.pyplot as plt

    result = built(path)
    for name in result.charts:
        made = result.chart(name)
        ax = result.plot(name)
        assert ax.get_xlabel() == made.x
        assert ax.get_ylabel() == made.y
        assert all(np.isfinite(line.y).any() for line in made.lines)
        assert all(line.x.shape == line.y.shape for line in made.lines)
        # all that is drawn is seen
        low, high = ax.get_ylim()
        values = np.concatenate([line.y for line in made.lines])
        assert low < np.nanmin(values)
        assert np.nanmax(values) < high
        left, right = ax.get_xlim()
        assert all(left < min(line.x) and max(line.x) < right for line in made.lines if line.dots)
        plt.close("all")


def test_a_legend_is_beside_small_axes():
    import matplotlib.pyplot as plt

    _, small = plt.subplots(2, 4, layout="constrained")
    for ax, name, beside in ((small[0, 1], "ratio", True), (None, "pressure_angle", False)):
        ax = built(PAIR).plot(name, ax=ax)
        ax.figure.canvas.draw()
        legend, axes = ax.get_legend().get_window_extent(), ax.get_window_extent()
        assert bool(legend.x0 >= axes.x1) is beside
        assert bool(axes.contains(*legend.min)) is not beside
    plt.close("all")


def test_a_smoothed_lift_is_drawn_with_the_points_that_were_given():
    import matplotlib.pyplot as plt

    path = rules.ROOT / "profiles" / "measured_cam.toml"
    given = np.loadtxt(path.with_suffix(".csv"), delimiter=",", skiprows=2)
    result = built(path)
    made = result.chart("lift")
    curve, points = made.lines
    assert points.dots
    assert points.label == "given points, before smoothing"
    np.testing.assert_allclose(points.x, given[:, 0], atol=1e-12)
    np.testing.assert_allclose(points.y, given[:, 1], atol=1e-12)
    off = np.interp(points.x, curve.x, curve.y) - points.y
    assert 0.004 < np.abs(off).max() < 0.0061  # near the tolerance, 0.006 mm
    legend = result.plot("lift").get_legend()
    assert "given points, before smoothing" in [text.get_text() for text in legend.get_texts()]
    plt.close("all")
    text = path.read_text().replace("smoothing_tolerance_mm = 0.006", "")
    exact = loads(text, file=str(path))  # through the points
    assert len(gearcam.build(exact).chart("lift").lines) == 1
    assert len(result.chart("velocity").lines) == 1


@pytest.mark.parametrize("path", few(PROFILES, 7), ids=lambda path: path.stem)
def test_extremes_are_those_of_the_facts(path):
    result = built(path)
    facts, steps = result.facts, 1e-3
    if result.design.kind in ("spatial-cam", "globoidal-cam"):
        steepest = max(line.y.max() for line in result.chart("pressure_angle").lines)
        assert steepest == pytest.approx(facts["cam.pressure_angle_deg.max"], rel=steps)
        turret = result.design.kind == "globoidal-cam"
        moved = result.chart("turret" if turret else "lift").lines[0].y
        told = facts["indexer.step_deg" if turret else "motion.total_lift"]
        assert np.ptp(moved) == pytest.approx(told, rel=steps)
        return
    if result.design.kind == "mechanism":
        for one in result.outputs:
            word = "direction" if one.angle else "motion"
            lines = result.chart(word).lines
            stroke = facts[f"outputs.{one.stem}.stroke_{one.unit[1]}"]
            known = [line for line in lines if line.label == one.stem] or lines[:1]
            assert np.ptp(known[0].y) == pytest.approx(stroke, rel=steps)
        return
    if result.design.kind == "cam":
        lift = result.chart("lift").lines[0].y
        assert np.ptp(lift) == pytest.approx(facts["motion.total_lift"], rel=steps)
        told = facts["cam.pressure_angle_deg"]
        drawn = "pressure_angle" in result.charts
        steepest = np.abs(result.chart("pressure_angle").lines[0].y).max() if drawn else 0.0
        ends = [max(map(abs, told[kind].values())) for kind in ("rise", "return") if kind in told]
        assert steepest == pytest.approx(max(ends), rel=steps, abs=1e-9)
        return
    steepest = max(line.y.max() for line in result.chart("pressure_angle").lines)
    assert steepest == pytest.approx(facts["mesh.pressure_angle_max_deg"], rel=steps)
    least = min(line.y.min() for line in result.chart("contact_ratio").lines)
    assert least == pytest.approx(result.contact_ratio, rel=1e-12)
    if not result.pair.on_rack:
        ratios = result.chart("ratio").lines[0].y
        told = facts["pair.ratio"]
        assert (ratios.min(), ratios.max()) == pytest.approx((told["min"], told["max"]), rel=steps)
        one, two = (line.y for line in result.chart("radii").lines)
        assert (two + result.pair.rolling.mate * one) == pytest.approx(
            result.pair.center_distance, rel=1e-12
        )


def test_both_sides_of_a_knot_are_drawn():
    # a cycloidal rise of h over beta ends with the jerk h*4*pi^2/beta^3, a dwell has none
    line = chart(CAM, "jerk").lines[0]
    design: Any = gearcam.load(CAM)
    rise = design.motion[0]
    jerk = rise.lift * 4.0 * math.pi**2 / rise.angle**3
    at = np.flatnonzero(np.isclose(line.x, math.degrees(rise.angle), atol=1e-9))
    assert line.y[at] == pytest.approx([jerk, 0.0])


def test_curvature_is_held_against_the_limit_of_undercut():
    found = chart(PAIR, "curvature")
    # a straight flank of a module below the pitch line: sin(alpha)^2/m
    module = built(PAIR).pair.module
    limit = math.sin(math.radians(20.0)) ** 2 / module
    assert [one.value for one in found.limits] == pytest.approx([limit, -limit], rel=1e-3)
    # the driven wheel of this pair is undercut, the driver is not
    above = [line.y.max() > limit for line in found.lines]
    result = built(PAIR)
    assert above == [bool(gear.profile.undercut_teeth) for gear in result.gears] == [False, True]


def test_the_roller_limits_the_pitch_curve():
    limits = {one.label: one.value for one in chart(CAM, "curvature").limits}
    design: Any = gearcam.load(CAM)
    assert limits["roller (convex pitch curve)"] == pytest.approx(
        1.0 / design.follower.roller_radius
    )
    # a wire of 0.3 mm does not get into a concave place that bends more; this profile has none
    label = "concave limit for a tool of 0.3 mm"
    assert label not in limits
    groove = chart(PAIR.with_name("groove_cam.toml"), "curvature").limits
    assert [one.value for one in groove if one.label == label] == pytest.approx([-1.0 / 0.15])


def test_charts_that_say_nothing_are_left_out():
    flat, roller = (built(PAIR.with_name(f"{name}.toml")) for name in ("flat_follower", CAM.stem))
    assert flat.charts == tuple(name for name in roller.charts if name != "pressure_angle")
    with pytest.raises(DesignError, match="lift, curvature, velocity") as refused:
        flat.plot("pressure_angle")
    assert "there is no such chart here" in str(refused.value)
    assert not any("tool" in one.label for one in flat.chart("curvature").limits)  # convex
    variants = [Variant(label=one.design.name, result=one) for one in (roller, flat)]
    assert len(joined("pressure_angle", variants).lines) == 1


def test_a_nearly_sharp_place_leaves_room_for_the_rest_of_the_curvature():
    (line,) = chart(PAIR.parent / "extreme" / "cam_face_at_limit.toml", "curvature").lines
    assert line.label == "profile before trimming, peaks outside this chart"
    assert np.isfinite(line.y).mean() > 0.9
    assert np.nanmax(line.y) < 12.0 * np.nanmedian(line.y)  # 2000 times at the sharpest place


def test_pressure_angles_are_held_against_the_limit_on_both_sides():
    assert [one.value for one in chart(CAM, "pressure_angle").limits] == pytest.approx([30, -30])


def test_an_undercut_profile_is_drawn_as_far_as_the_chart_goes():
    pitch, profile = chart(PAIR.with_name("undercut_cam.toml"), "curvature").lines
    # it bends without limit where it turns back: nothing is drawn there, and no bridge
    assert np.isnan(profile.y).any()
    assert not np.isnan(pitch.y).any()
    assert profile.y[np.isfinite(profile.y)].min() < -0.2 < 0.3 < np.nanmax(profile.y)
    assert not (profile.y == 0.0).any()


def test_charts_of_several_lobes_repeat():
    law = {"type": "phases", "knots_deg": [0, 70, 180], "ratios": [2.4, "solve", 2.4]}
    pair = {"module_mm": 2, "teeth": [72, 36]}
    made = gearcam.design({"kind": "gear-pair", "name": "twice", "law": law, "pair": pair})
    line = gearcam.build(made).chart("pressure_angle").lines[0]
    first = line.x <= 180.0
    later = np.interp(line.x[first] + 180.0, line.x, line.y)
    assert later == pytest.approx(line.y[first], abs=1e-3)
    assert np.ptp(line.y) > 10.0


def test_a_pair_of_teeth_is_one_line_of_sliding_without_bridges():
    line = chart(PAIR, "sliding").lines[0]
    assert np.nanmax(np.abs(np.diff(line.x))) < 1.0
    # at the pitch point flanks only roll: each line goes through zero
    pieces = np.split(line.y, np.flatnonzero(np.isnan(line.y)))
    long = [piece[np.isfinite(piece)] for piece in pieces if len(piece) > 20]
    assert len(long) > 30
    assert all(piece.min() < 0.0 < piece.max() for piece in long)


def test_the_ratio_is_the_slope_of_the_position():
    for path, scale in ((PAIR, 1.0), (PAIR.with_name("feeder.toml"), math.degrees(1.0))):
        result = built(path)
        place, ratio = (result.chart(name).lines[0] for name in ("position", "ratio"))
        x = 0.5 * (place.x[1:] + place.x[:-1])
        long = np.diff(place.x) > 0.1
        slope = scale * np.diff(place.y)[long] / np.diff(place.x)[long]
        assert slope == pytest.approx(np.interp(x[long], ratio.x, ratio.y), rel=1e-4)
    assert place.x[-1] == 540.0  # 60 teeth of the rack under a wheel of 40


@pytest.mark.parametrize(
    ("name", "knots"),
    [
        ("nail_machine_two_phase", [160.0]),
        ("plate_cam_offset_roller", [90.0, 180.0, 270.0]),
        ("translating_cam", [20.0, 80.0, 110.0, 150.0]),  # ways, mm
        ("feeder", [360.0]),
        ("ellipse", []),
    ],
)
def test_knots_are_marked(name, knots):
    result = built(PAIR.with_name(f"{name}.toml"))
    over = result.charts[0]
    for chart in map(result.chart, result.charts):
        if chart.x != result.chart(over).x or "patch" in chart.title or "Sliding" in chart.title:
            continue
        assert [one.value for one in chart.marks] == pytest.approx(knots)
        assert {one.label for one in chart.marks} <= {"knots"}


def test_contact_patches_are_those_of_a_study():
    # the closed form of a study is that of the exact depth, the chart's that of the lever
    result = built(PAIR.with_name("ellipse.toml"))
    each, together = result.chart("contact_patch").lines
    table = result.mesh(steps=24).columns
    known = np.isfinite(table["closed_mm2"])
    met = 0
    for x, area in zip(table["phi1_deg"][known], table["closed_mm2"][known], strict=True):
        here = each.y[np.abs(each.x - x) < 1e-9]
        met += here.size > 0
        assert not here.size or np.abs(here / area - 1.0).min() < 2e-3
        assert together.y[np.searchsorted(together.x, x - 1e-9)] >= 0.998 * area
    assert met > 20
    # at one moment it is what all pairs have together: one or two, over a turn
    counts = set()
    for x, area in zip(together.x[1:40], together.y[1:40], strict=True):
        own = each.y[each.x == x]
        counts.add(len(own))
        assert area == pytest.approx(own.sum())
    assert counts == {1, 2}


def test_transmission_errors_are_those_of_a_study():
    # backlash lets the driven wheel lag, by more where it is small
    result = built(PAIR.with_name("shop_order.toml"))
    told = result.mesh(steps=72).facts["meshing.transmission_error"]
    drive, coast = result.chart("transmission_error").lines
    assert np.ptp(drive.y) == pytest.approx(told["peak_to_peak"], rel=1e-3)
    assert abs(drive.y.mean()) < 1e-3 * np.ptp(drive.y)
    # held back, the wheel is ahead; as it is behind where it is driven
    for line, side, sign in ((drive, "drive", 1.0), (coast, "coast", -1.0)):
        lags = [result.contact(math.radians(x), side)["lag_rad"][0] for x in (0.0, 180.0)]
        assert all(sign * lag > 0.0 for lag in lags)
        shown = np.interp([0.0, 180.0], line.x, line.y)
        assert np.diff(shown) == pytest.approx(np.diff(lags), rel=1e-6)
    # without backlash there is none
    assert not np.any(built(PAIR).chart("transmission_error").lines[0].y)


@pytest.mark.parametrize(
    ("name", "ends", "limits"),
    [
        # half the groove's width, 12.05 mm, on either side of the pitch curve
        ("groove_cam", ("inner wall", "outer wall"), (1.0 / 6.025, -1.0 / 6.025)),
        ("translating_cam", ("lower wall", "upper wall"), (1.0 / 6.025, -1.0 / 6.025)),
        ("conjugate_cams", ("cam 1", "cam 2"), (1.0 / 8.0,)),
        ("yoke_cam", ("profile",), ()),
    ],
)
def test_all_walls_have_their_curvature_and_their_roller(name, ends, limits):
    found = chart(PAIR.with_name(f"{name}.toml"), "curvature")
    walls = [one.label for one in found.lines if not one.label.startswith("pitch curve")]
    assert [wall.split(" of ")[-1] for wall in walls] == list(ends)  # nothing is trimmed
    rollers = [one.value for one in found.limits if one.label.startswith("roller")]
    assert rollers == pytest.approx(list(limits))


def test_pressure_angles_of_both_conjugate_cams():
    path = PAIR.with_name("conjugate_cams.toml")
    result = built(path)
    for line, told in zip(
        result.chart("pressure_angle").lines,
        (result.facts["cam.pressure_angle_deg"], result.facts["cam.cam2.pressure_angle_deg"]),
        strict=True,
    ):
        largest = max(abs(value) for kind in ("rise", "return") for value in told[kind].values())
        assert np.abs(line.y).max() == pytest.approx(largest, rel=1e-3)


def test_marked_places_are_drawn_and_told_once():
    line = Line(label="values", x=np.arange(3.0), y=np.array([0.0, 1.0, 2.0]))
    marks = tuple(MarkedPlace(label="knots", value=value) for value in (0.5, 1.5))
    ax = Chart(title="t", x="x", y="y", lines=(line,), marks=marks).draw()
    drawn = [
        float(np.asarray(one.get_xdata())[0]) for one in ax.lines if one.get_linestyle() == ":"
    ]
    assert drawn == [0.5, 1.5]
    legend = ax.get_legend()
    assert legend is not None
    assert [text.get_text() for text in legend.get_texts()] == ["values", "knots"]


def test_far_limits_are_told_not_drawn():
    line = Line(label="values", x=np.arange(3.0), y=np.array([0.0, 1.0, 2.0]))
    limits = (Limit(label="near", value=3.0), Limit(label="far", value=100.0))
    ax = Chart(title="t", x="x", y="y", lines=(line,), limits=limits).draw()
    assert 3.0 < ax.get_ylim()[1] < 4.0
    legend = ax.get_legend()
    assert legend is not None
    told = [text.get_text() for text in legend.get_texts()]
    assert told == ["values", "near: 3", "far: 100, outside this chart"]


def test_axes_may_be_given_and_level_lines_have_room():
    import matplotlib.pyplot as plt

    _, ax = plt.subplots()
    line = Line(label="level", x=np.arange(3.0), y=np.full(3, 7.0))
    assert Chart(title="t", x="x", y="y", lines=(line,)).draw(ax) is ax
    low, high = ax.get_ylim()
    assert low < 6.8 < 7.2 < high
    plt.close("all")


def log_chart(x, y, **more):
    line = Line(label="errors", x=np.array(x), y=np.array(y), dots=True)
    return Chart(title="t", x="s", y="mm", lines=(line,), log="xy", **more)


def test_margins_of_logarithmic_axes_are_shares_of_their_decades():
    found = log_chart([1e-3, 1e-1], [1e-12, 1e-2])
    assert found.range == pytest.approx((1e-12, 1e-2))
    assert np.log10(found.ends) == pytest.approx(np.array([[-3.12, -0.88], [-12.6, -1.4]]))
    far = tuple(Limit(label="", value=value) for value in (1e-20, 1e-30, 0.0, -1.0))
    assert log_chart([1e-3, 1e-1], [1e-12, 1e-2], limits=far).range[0] == pytest.approx(1e-20)


def test_a_logarithmic_axis_has_a_decade_or_more_and_positive_values_only():
    found = log_chart([2.0, 2.0, 2.0], [0.0, 3.0, -1.0])
    low, high = found.range
    assert (math.log10(high / low), low * high) == (pytest.approx(1.2), pytest.approx(9.0))
    assert log_chart([1.0], [0.0]).range[0] > 0.0


def test_a_curve_in_the_plane_has_axes_of_one_scale():
    turn = np.linspace(0.0, 6.28, 60)
    line = Line(label="circle", x=3.0 * np.cos(turn), y=5.0 + 3.0 * np.sin(turn))
    for equal in (True, False):
        ax = Chart(title="t", x="N", y="N", lines=(line,), equal=equal).draw()
        ax.figure.canvas.draw()
        (left, low), (right, top) = ax.transData.transform([[-3.0, 2.0], [3.0, 8.0]])
        assert ((right - left) == pytest.approx(top - low)) == equal


def test_logarithmic_axes_are_drawn():
    ax = log_chart([1e-3, 0.0, 1e-1], [1e-12, 1.0, 1e-2]).draw()
    assert (ax.get_xscale(), ax.get_yscale()) == ("log", "log")
    assert ax.get_xlim()[0] == pytest.approx(10**-3.12)
    assert ax.get_ylim()[1] == pytest.approx(10**0.72)


def test_a_short_logarithmic_axis_has_numbers_between_powers_of_ten():
    ax = log_chart([1e-3, 2e-2], [1e-12, 1e-2]).draw()
    ax.figure.canvas.draw()
    x, y = (
        [text.get_text() for text in axis.get_minorticklabels() if text.get_text()]
        for axis in (ax.xaxis, ax.yaxis)
    )
    assert "$\\mathdefault{2\\times10^{-3}}$" in x
    assert y == []


def test_places_of_knots():
    turn, knots = np.linspace(0.0, 2.0, 101), np.array([-1.0, 0.503, 1.003, 2.0, 9.0])
    places = with_both_sides(turn, knots)
    before = np.nextafter([0.503, 1.003], -np.inf)
    assert places.tolist() == sorted([*turn, *before, 0.503, 1.003])


@pytest.mark.parametrize("count", [1, 100, 3000])
def test_between_knots_that_are_near_each_other_a_curve_has_places(count: int) -> None:
    knots = 0.3 + 1e-3 * np.linspace(0.0, 1.0, count + 1)
    turn = np.linspace(0.0, 1.0, 5001)
    places = with_both_sides(turn, knots)
    between = np.diff(np.searchsorted(places, knots)).min()
    assert between >= min(24, 2400 // (count + 3))
    assert places.size <= turn.size + 2 * knots.size + 2400


def test_a_chart_shows_what_happens_in_a_degree() -> None:
    short = Path("profiles") / "extreme" / "cam_one_degree.toml"
    result = built(short)
    low, high = result.chart("velocity").range
    peak = result.facts.quantity("motion.peak_velocity").value
    assert high == pytest.approx(peak, rel=0.01)
    assert low == pytest.approx(-peak, rel=0.01)


def test_unknown_charts_are_refused_with_the_known_ones():
    result = built(CAM)
    with pytest.raises(DesignError, match="speed") as refused:
        result.plot("speed")
    assert all(name in str(refused.value) for name in result.charts)


def test_without_matplotlib_the_extra_is_named(monkeypatch):
    result = built(CAM)
    monkeypatch.setitem(sys.modules, "matplotlib.pyplot", None)
    with pytest.raises(MissingExtraError, match="plot"):
        result.plot("lift")
