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
from gearcam.charts import Chart, Limit, Line, MarkedPlace
from gearcam.errors import DesignError, MissingExtraError
from gearcam.numeric.piecewise import with_both_sides

mpl.use("Agg")
PROFILES = sorted((rules.ROOT / "profiles").glob("*.toml"))
PAIR, CAM = (
    rules.ROOT / "profiles" / f"{name}.toml"
    for name in ("nail_machine_two_phase", "plate_cam_offset_roller")
)


def chart(path: Path, name: str) -> Chart:
    return gearcam.build(gearcam.load(path)).chart(name)


@pytest.mark.parametrize("path", PROFILES, ids=lambda path: path.stem)
def test_every_chart_of_every_design_is_drawn(path):
    import matplotlib.pyplot as plt

    result = gearcam.build(gearcam.load(path))
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


@pytest.mark.parametrize("path", PROFILES, ids=lambda path: path.stem)
def test_extremes_are_those_of_the_facts(path):
    result = gearcam.build(gearcam.load(path))
    facts, steps = result.facts, 1e-3
    if result.design.kind == "cam":
        lift = result.chart("lift").lines[0].y
        assert np.ptp(lift) == pytest.approx(facts["motion.total_lift"], rel=steps)
        steepest = np.abs(result.chart("pressure_angle").lines[0].y).max()
        told = facts["cam.pressure_angle_deg"]
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
    module = gearcam.build(gearcam.load(PAIR)).pair.module
    limit = math.sin(math.radians(20.0)) ** 2 / module
    assert [one.value for one in found.limits] == pytest.approx([limit, -limit], rel=1e-3)
    # the driven wheel of this pair is undercut, the driver is not
    above = [line.y.max() > limit for line in found.lines]
    result = gearcam.build(gearcam.load(PAIR))
    assert above == [bool(gear.profile.undercut_teeth) for gear in result.gears] == [False, True]


def test_the_roller_limits_the_pitch_curve():
    limits = {one.label: one.value for one in chart(CAM, "curvature").limits}
    design: Any = gearcam.load(CAM)
    assert limits["roller, convex pitch curve"] == pytest.approx(
        1.0 / design.follower.roller_radius
    )
    # a wire of 0.3 mm does not get into a concave place that bends more
    assert limits["tool at hand, concave profile"] == pytest.approx(-1.0 / 0.15)


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


def test_far_limits_are_told_not_drawn():
    line = Line(label="values", x=np.arange(3.0), y=np.array([0.0, 1.0, 2.0]))
    limits = (Limit(label="near", value=3.0), Limit(label="far", value=100.0))
    ax = Chart(title="t", x="x", y="y", lines=(line,), limits=limits).draw()
    assert 3.0 < ax.get_ylim()[1] < 4.0
    legend = ax.get_legend()
    assert legend is not None
    told = [text.get_text() for text in legend.get_texts()]
    assert told == ["values", "near: 3", "far: 100, beyond this chart"]


def test_axes_may_be_given_and_level_lines_have_room():
    import matplotlib.pyplot as plt

    _, ax = plt.subplots()
    line = Line(label="level", x=np.arange(3.0), y=np.full(3, 7.0))
    assert Chart(title="t", x="x", y="y", lines=(line,)).draw(ax) is ax
    low, high = ax.get_ylim()
    assert low < 6.8 < 7.2 < high
    plt.close("all")


def test_places_of_knots():
    places = with_both_sides(np.array([0.0, 1.0, 2.0]), np.array([-1.0, 0.5, 1.0, 2.0, 9.0]))
    before = np.nextafter([0.5, 1.0], -np.inf)
    assert places.tolist() == [0.0, before[0], 0.5, before[1], 1.0, 2.0]


def test_unknown_charts_are_refused_with_the_known_ones():
    result = gearcam.build(gearcam.load(CAM))
    with pytest.raises(DesignError, match="speed") as refused:
        result.plot("speed")
    assert all(name in str(refused.value) for name in result.charts)


def test_without_matplotlib_the_extra_is_named(monkeypatch):
    result = gearcam.build(gearcam.load(CAM))
    monkeypatch.setitem(sys.modules, "matplotlib.pyplot", None)
    with pytest.raises(MissingExtraError, match="plot"):
        result.plot("lift")
