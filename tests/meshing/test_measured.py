"""Measured outlines: against exact flanks, whole polygons, and outlines that are wrong."""

from __future__ import annotations

import math
from collections.abc import Callable
from functools import cache
from itertools import product
from pathlib import Path
from typing import Any

import numpy as np
import pytest
import shapely

import gearcam as gc
from gearcam.base.errors import DesignError, InfeasibleError
from gearcam.gears.contact import COAST, DRIVE, Mounting, flank_pairs
from gearcam.meshing.assembly import Assembly
from gearcam.meshing.errors import cycle
from gearcam.meshing.half_teeth import HalfTeeth, half_teeth
from gearcam.meshing.measured import as_half_teeth, chord_error, demand_near, outline_leads
from gearcam.meshing.overlap import Turning
from helpers_built import built
from helpers_pairs import profile, run
from helpers_sampling import chosen, few

CHORD = 1e-3
ROUND: dict[str, Any] = {
    "kind": "gear-pair",
    "name": "round",
    "law": {"type": "constant"},
    "pair": {"teeth": [20, 30], "module_mm": 2, "backlash_mm": 0.1},
    "output": {"files": ["csv"], "chord_tolerance_mm": CHORD},
}
MANY = {**ROUND, "pair": {"teeth": [120, 120], "module_mm": 2, "backlash_mm": 0.1}}
MANY["output"] = {"files": ["csv"], "chord_tolerance_mm": 3e-3}
ELLIPSE = {**ROUND, "name": "swing", "law": {"type": "ellipse", "eccentricity": 0.3}}
ELLIPSE["pair"] = {"teeth": [20, 20], "module_mm": 2, "backlash_mm": 0.1}


@cache
def made(name: str) -> Any:
    if name in ("round", "swing"):
        return built(gc.design(ROUND if name == "round" else ELLIPSE))
    return profile(name)


def complex_of(points: np.ndarray) -> np.ndarray:
    return points @ np.array([1, 1j])


def halves(gear: Any, change: Callable[[np.ndarray], np.ndarray] = lambda z: z) -> HalfTeeth:
    return as_half_teeth(change(complex_of(gear.outline)), half_teeth(gear.profile), CHORD)


def mating(name: str, mounting: Mounting | None = None) -> tuple[Any, Turning]:
    gears = made(name).gears
    distance = gears[0].pair.shift if mounting is None else mounting.distance
    one, two = (halves(gear) for gear in gears)
    rolling = made(name).pair.rolling
    return gears, Turning(rolling=rolling, driver=one, driven=two, distance=distance)


@pytest.mark.parametrize("name", ["ellipse", "ring_ellipse", "feeder"])
def test_whole_outlines_touch_at_the_lead_of_their_half_teeth(name: str) -> None:
    """At the lead the wheels are within rounding of each other; a little further they overlap."""
    gears, turning = mating(name)
    for side in (DRIVE, COAST):
        pairs = flank_pairs(gears, side)
        phi1 = np.linspace(0.3, 0.9, 4) * pairs.travel
        lead = outline_leads(turning, pairs, phi1)
        apart = turning.flank_distance(side, phi1, 0.0, lead)
        assert np.isfinite(lead).all()
        assert apart.max() < 1e-9
        for more, touching in ((1e-6, False), (-1e-6, True)):
            moved = lead - side * more * (1.0 if pairs.guide.unit == "mm" else 0.02)
            distance = turning.flank_distance(side, phi1, 0.0, moved)
            assert np.all((distance == 0.0) == touching)


@pytest.mark.parametrize(
    ("name", "written"),
    chosen(product(("round", "swing"), ("csv", "dxf")), ("swing", "csv")),
)
def test_a_wheels_own_outline_has_no_error(name: str, written: str, tmp_path: Path) -> None:
    result = made(name)
    keys = {}
    if written == "dxf":
        result.write(tmp_path, files=["dxf"])
    for number, gear in enumerate(result.gears, start=1):
        file = tmp_path / f"{number}.{written}"
        if written == "csv":
            rows = "\n".join(f"{x!r},{y!r}" for x, y in gear.outline.tolist())
            file.write_text(f"x_mm,y_mm\n{rows}\n", "utf-8")
        else:
            file = next(tmp_path.rglob(f"gear{number}.dxf"))
        keys[f"errors.outline{number}"] = str(file)
    study = gc.build(result.design.with_({**keys, "errors.steps": 12})).study("errors")
    radius = 0.5 * result.pair.center_distance
    facts = study.to_dict()
    found, own = facts["errors"], facts["errors"]["without"]
    # with backlash, the driven wheel of an ellipse lags by a varying angle
    error, usual = (one["transmission_error_rad"]["peak_to_peak"] for one in (found, own))
    assert abs(error - usual) * radius < 2.0 * CHORD
    assert found["alone"]["outline1"]["size_mm"] < 2.0 * CHORD
    assert found["backlash_mm"]["min"] == pytest.approx(own["backlash_mm"]["min"], abs=5 * CHORD)


def test_a_measured_tooth_that_is_ahead_leads_by_its_error() -> None:
    """As much as the exact flanks of a wheel with this error of pitch."""
    gears, error, radius = made("round").gears, 0.005, 30.0
    own = half_teeth(gears[0].profile)
    ahead = own.moved(gears[0].toothing, {7: error}, 0j)
    phi1 = np.linspace(0.0, 2.0 * math.pi, 180, endpoint=False)
    exact = run([gears], 10.0, Assembly(pitch=({7: error}, {})), phi1)
    found = run([gears], 10.0, Assembly(outlines=(ahead, None)), phi1)
    assert np.abs(found.lead - exact.lead).max() * radius < 2.0 * CHORD
    assert exact.peak_to_peak * radius > 0.8 * error


def test_an_outline_off_its_shaft_runs_as_an_eccentric_wheel() -> None:
    gears, offset = made("round").gears, 0.03 + 0.02j
    phi1 = np.linspace(0.0, 2.0 * math.pi, 90, endpoint=False)
    exact = run([gears], 10.0, Assembly(eccentric=(offset, 0j)), phi1)
    measured = halves(gears[0], lambda z: z + offset)
    found = run([gears], 10.0, Assembly(outlines=(measured, None)), phi1)
    assert np.abs(found.lead - exact.lead).max() * 30.0 < 2.0 * CHORD
    assert np.abs(found.backlash - exact.backlash).max() < 5.0 * CHORD
    assert found.contact_ratio is None


def away(outline: np.ndarray) -> np.ndarray:
    """Return an outline without its last tenth."""
    return outline[: -len(outline) // 10]


def crossed(outline: np.ndarray) -> np.ndarray:
    found = outline.copy()
    found[[100, 140]] = found[[140, 100]]
    return found


WRONG: dict[str, tuple[Callable[[np.ndarray], np.ndarray], str]] = {
    "open": (away, "is open: its last point is .* mm from its first"),
    "crossed": (crossed, "crosses itself: .* at \\("),
    "inches": (lambda z: z / 25.4, "is in inches: it is 0.0394 times as large"),
    "metres": (lambda z: 1e-3 * z, "is 0.001 times as large"),
    "scaled": (lambda z: 1.1 * z, "is 1.1 times as large"),
    "off centre": (lambda z: z + 3.0 - 2.0j, "is off centre by x = 3, y = -2 mm"),
    "turned": (lambda z: z * np.exp(1j * math.radians(100)), "is turned by 100 deg"),
    "turned the other way": (lambda z: z * np.exp(-0.5j), "is turned by -28.6 deg"),
    "both": (lambda z: z * 1j + 2.0, "is off centre by x = 2, y = .* mm and turned by 90 deg"),
    "symmetric": (lambda z: np.conj(z) * np.exp(2j), "is turned by 115 deg"),
}


@pytest.mark.parametrize("fault", chosen(list(WRONG), *list(WRONG)[:6], "symmetric"))
@pytest.mark.parametrize("chord", few([3e-3, 1e-3]))
def test_a_wrong_outline_is_refused_with_its_cause(fault: str, chord: float) -> None:
    """However far apart its points are: a wheel that is symmetric is not called mirrored."""
    change, message = WRONG[fault]
    output = {**ELLIPSE["output"], "chord_tolerance_mm": chord}
    own = complex_of(built(gc.design({**ELLIPSE, "output": output})).gear1.outline)
    with pytest.raises(InfeasibleError, match=message):
        demand_near(change(own), own, 2.0, "errors.outline1")


def test_a_wheel_without_symmetry_may_be_mirrored() -> None:
    result = profile("nail_machine_three_phase")
    own = complex_of(result.gear1.outline)
    with pytest.raises(InfeasibleError, match=r"is mirrored: .* from the other side"):
        demand_near(np.conj(own) * np.exp(2j), own, result.pair.module, "errors.outline1")


def test_a_round_wheel_is_turned_by_less_than_half_a_pitch_however_many_teeth_it_has() -> None:
    own = complex_of(built(gc.design(MANY)).gear1.outline)
    for change, message in (
        (lambda z: z * np.exp(1j * math.radians(1.4)), "is turned by 1.4 deg"),
        (lambda z: z + 3.0 - 2.0j, r"is off centre by x = 3, y = -2 mm \("),
    ):
        with pytest.raises(InfeasibleError, match=message):
            demand_near(change(own), own, 2.0, "errors.outline1")


@pytest.mark.parametrize("name", ["nautilus", "furnace_door_two_phase", "ring_ellipse", "feeder"])
def test_own_outlines_touch_where_flanks_do(name: str) -> None:
    """Also where lands are oblique to the circle about the driven shaft; chords of 1 um."""
    gears = profile(name).gears
    phi1 = cycle(gears, 40, alike=True)
    exact = run([gears], 10.0, Assembly(), phi1)
    found = run([gears], 10.0, Assembly(outlines=(half_teeth(gears[0].profile), None)), phi1)
    assert not found.jams
    assert found.backlash == pytest.approx(exact.backlash, abs=5e-3)
    assert exact.interference is None


@pytest.mark.parametrize("turned", few([-7.5, 3.0]))
def test_a_round_outline_is_turned_by_less_than_half_a_pitch(turned: float) -> None:
    own = complex_of(made("round").gear1.outline)
    with pytest.raises(InfeasibleError, match=f"is turned by {turned:g} deg"):
        demand_near(own * np.exp(1j * math.radians(turned)), own, 2.0, "errors.outline1")


def test_thinned_points_say_how_well_they_are_known() -> None:
    gear = made("round").gear1
    own = complex_of(gear.outline)
    circle: Any = 100.0 * np.exp(2j * math.pi * np.arange(40000) / 40000)
    sagitta = 100.0 * (1.0 - math.cos(math.pi / 400))
    assert chord_error(circle[::100], circle) == pytest.approx(sagitta, rel=1e-3)
    thin = chord_error(own[::6], own)
    assert thin > 10.0 * chord_error(own, own)
    phi1 = np.linspace(0.0, 2.0 * math.pi, 60, endpoint=False)
    halves = as_half_teeth(own[::6], half_teeth(gear.profile), thin)
    running = run([made("round").gears], 10.0, Assembly(outlines=(halves, None)), phi1)
    assert np.ptp(running.lead) < 3.0 * running.known_to
    assert not running.jams


def test_an_outline_with_another_number_of_teeth_is_refused() -> None:
    own, other = (complex_of(made("round").gears[k].outline) for k in (0, 1))
    with pytest.raises(InfeasibleError, match="has 30 teeth; that of the wheel has 20"):
        demand_near(other, own, 2.0, "errors.outline1")


def test_a_missing_tooth_is_refused() -> None:
    gear = made("round").gear1
    whole: Any = shapely.Polygon(gear.outline)
    tip = complex(half_teeth(gear.profile).tips[12])
    less = whole - shapely.Point(tip.real, tip.imag).buffer(4.8)
    own = complex_of(gear.outline)
    with pytest.raises(
        InfeasibleError, match=r"has 19 teeth|lacks a part near x = |not that of this wheel, at x"
    ):
        demand_near(complex_of(np.array(less.exterior.coords)[:-1]), own, 2.0, "errors.outline1")


def test_an_outline_within_its_errors_is_taken() -> None:
    own = complex_of(made("round").gear1.outline)
    off = demand_near(own + (0.05 + 0j), own, 2.0, "errors.outline1")
    assert off == pytest.approx(0.05, rel=0.05)


@pytest.mark.parametrize(("name", "content"), [("x.csv", "a,b\n1,2\n"), ("none.csv", None)])
def test_a_file_that_cannot_be_read_is_named(
    name: str, content: str | None, tmp_path: Path
) -> None:
    file = tmp_path / name
    if content is not None:
        file.write_text(content, "utf-8")
    result = gc.build(gc.design(ROUND).with_({"errors.outline1": str(file)}))
    with pytest.raises(DesignError, match="not an outline"):
        result.study("errors")


def test_another_content_is_another_design(tmp_path: Path) -> None:
    file = tmp_path / "a.csv"
    file.write_text("x_mm,y_mm\n0,0\n", "utf-8")
    keys = {"errors.outline1": str(file), "output.studies": ["errors"]}
    before = gc.build(gc.design(ROUND).with_(keys)).design_hash
    file.write_text("x_mm,y_mm\n0,1\n", "utf-8")
    assert gc.build(gc.design(ROUND).with_(keys)).design_hash != before
