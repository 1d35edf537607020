"""Errors of mounting and making: against closed forms of involutes and independent searches."""

from __future__ import annotations

import math
from collections.abc import Mapping
from pathlib import Path
from typing import Any

import numpy as np
import pytest
import shapely

import gearcam as gc
from gearcam.base.errors import DesignError, InfeasibleError
from gearcam.gears.contact import COAST, DRIVE, Mounting, flank_pairs
from gearcam.meshing.assembly import Assembly
from gearcam.meshing.contact import contacts
from gearcam.meshing.edges import first_touch, touches
from gearcam.meshing.errors import cycle, largest, of_error
from gearcam.meshing.half_teeth import half_teeth
from gearcam.meshing.overlap import Turning
from helpers_built import built
from helpers_pairs import profile, run
from helpers_sampling import few

ALPHA = math.radians(20)
MODULE, TEETH = 2.0, (20, 30)
ROUND: dict[str, Any] = {
    "kind": "gear-pair",
    "name": "round",
    "law": {"type": "constant"},
    "pair": {"teeth": [*TEETH], "module_mm": MODULE, "backlash_mm": 0.1},
}
ELLIPSE: dict[str, Any] = {
    "kind": "gear-pair",
    "name": "ellipse",
    "law": {"type": "ellipse", "eccentricity": 0.4},
    "pair": {"teeth": [24, 24], "module_mm": MODULE, "backlash_mm": 0.1},
}
BASE2 = 0.5 * MODULE * TEETH[1] * math.cos(ALPHA)


def with_errors(errors: Mapping[str, Any], **pair: Any) -> gc.Design:
    return gc.design({**ROUND, "pair": ROUND["pair"] | pair, "errors": dict(errors)})


def pressed(assembly: Assembly, document: Mapping[str, Any] = ROUND, steps: int = 160) -> Any:
    gears = built(gc.design(dict(document))).gears
    return run([gears], 10.0, assembly, cycle(gears, steps, alike=assembly.alike)), gears


@pytest.mark.parametrize(("wheel", "order"), [(0, 1.0), (1, 2 / 3)])
def test_an_eccentric_involute_runs_with_the_error_of_its_closed_form(
    wheel: int, order: float
) -> None:
    """Amplitude e/(r2*cos(alpha)), once a turn of the wheel; what is left falls with e^2."""
    missed = []
    for size in (0.04, 0.01):
        offset = (size + 0j, 0j) if wheel == 0 else (0j, size * 1j)
        running, gears = pressed(Assembly(eccentric=offset))
        first, *_ = of_error(running, gears)
        assert isinstance(first, dict)
        assert first["order"] == pytest.approx(order)
        missed.append(abs(first["amplitude"] * BASE2 / size - 1.0))
    # which tooth leads depends on the size of the error, so that no power of it is exact
    assert missed[0] < 1e-3
    assert missed[1] < 0.3 * missed[0]


def test_an_eccentric_wheel_leaves_the_backlash_of_its_closed_form() -> None:
    """Radial offset e changes the backlash along the pitch circles by 2*e*tan(alpha)."""
    size = 0.02
    running, _ = pressed(Assembly(eccentric=(size + 0j, 0j)), steps=360)
    change = 2.0 * size * math.tan(ALPHA)
    found = running.backlash.min(), running.backlash.max()
    assert found == pytest.approx((0.1 - change, 0.1 + change), abs=0.02 * change)


@pytest.mark.parametrize("direction", [1.0 + 0j, 0.6 - 0.8j])
def test_a_small_error_turns_the_driven_wheel_by_its_part_along_the_normal(
    direction: complex,
) -> None:
    """Central differences of the exact contact, against the normal and lever without error."""
    gears, size = profile("ellipse").gears, 1e-4
    phi1 = np.linspace(0.05, 6.2, 37)
    plain, more, less = (
        contacts(
            flank_pairs(
                gears, DRIVE, Mounting(distance=gears[0].pair.shift, eccentric=(e * direction, 0j))
            ),
            phi1,
        )
        for e in (0.0, size, -size)
    )
    rates = {}
    for step, pair, high, low in zip(more.step, more.pair, more.lead, less.lead, strict=True):
        rates[step, pair] = (high - low) / (2.0 * size)
    moved = direction * np.exp(-1j * phi1[plain.step])
    expected = (np.conj(plain.force) * moved).real / plain.lever[1]
    found = [rates[key] for key in zip(plain.step, plain.pair, strict=True)]
    assert np.array(found) == pytest.approx(expected, rel=1e-6, abs=1e-9)


@pytest.mark.parametrize(("wheel", "sign"), [(1, -1.0), (2, 1.0)])
def test_an_error_of_pitch_moves_a_tooth_towards_the_next_number(wheel: int, sign: float) -> None:
    """All teeth moved alike: the driver turns against its numbers, and lags, the mate leads."""
    errors = dict.fromkeys(range(1, TEETH[wheel - 1] + 1), 0.01)
    running, _ = pressed(Assembly(pitch=(errors, {}) if wheel == 1 else ({}, errors)), steps=24)
    without, _ = pressed(Assembly(), steps=24)
    radius = 0.5 * MODULE * TEETH[1]
    assert radius * (running.lead[:24] - without.lead) == pytest.approx(sign * 0.01, rel=1e-6)


def test_a_tooth_ahead_leads_by_its_error() -> None:
    running, _ = pressed(Assembly(pitch=({3: 0.01}, {})))
    assert running.peak_to_peak == pytest.approx(0.01 / (0.5 * MODULE * TEETH[1]), rel=1e-6)
    behind, _ = pressed(Assembly(pitch=({3: -0.01}, {})))
    # its neighbours carry instead, except where it would be alone in contact
    assert 0.0 < behind.peak_to_peak <= running.peak_to_peak * (1 + 1e-6)


def test_the_backlash_grows_with_the_centre_distance() -> None:
    more = 0.05
    running, _ = pressed(Assembly(center=more))
    base1, distance = 0.5 * MODULE * TEETH[0] * math.cos(ALPHA), 0.5 * MODULE * sum(TEETH)
    angle = math.acos(distance * math.cos(ALPHA) / (distance + more))

    def inv(x: float) -> float:
        return math.tan(x) - x

    # normal play of two involutes over the pitch line's lever arm
    play = 0.1 * math.cos(ALPHA) + 2.0 * (base1 + BASE2) * (inv(angle) - inv(ALPHA))
    assert running.backlash == pytest.approx(play / math.cos(ALPHA), abs=1e-9)


MOUNTINGS = {
    "eccentric": Mounting(distance=0j, eccentric=(0.03 - 0.02j, 0.01j)),
    "aside": Mounting(distance=0.05 + 0.1j),
    "pitch": Mounting(distance=0.02, pitch=({2: 0.004}, {5: -0.006})),
}


def mounted(name: str, shift: float) -> Mounting:
    one = MOUNTINGS[name]
    return Mounting(distance=shift + one.distance, eccentric=one.eccentric, pitch=one.pitch)


@pytest.mark.parametrize("name", MOUNTINGS)
@pytest.mark.parametrize("design", ["ellipse", "ring_ellipse"])
@pytest.mark.parametrize("side", [DRIVE, COAST])
def test_common_normals_and_the_search_by_heights_agree(name: str, design: str, side: int) -> None:
    gears = profile(design).gears
    pairs = flank_pairs(gears, side, mounted(name, gears[0].pair.shift))
    phi1 = np.linspace(0.05, 6.2, 31)
    exact, found = contacts(pairs, phi1), touches(pairs, phi1)
    smooth = ~found.edge
    both = dict(zip(zip(exact.step, exact.pair, strict=True), exact.lead, strict=True))
    compared = [
        (both[step, pair], turn)
        for step, pair, turn in zip(
            found.step[smooth], found.pair[smooth], found.turn[smooth], strict=True
        )
        if (step, pair) in both
    ]
    assert len(compared) > 20
    one, two = np.array(compared).T
    assert one == pytest.approx(two, abs=1e-11)


@pytest.mark.parametrize("name", MOUNTINGS)
def test_outlines_touch_where_the_flanks_do(name: str) -> None:
    """The moved outlines, intersected, know nothing of common normals."""
    made = gc.build(gc.load("profiles/ellipse.toml").with_({"output.chord_tolerance_mm": 1e-4}))
    gears = made.gears
    mounting = mounted(name, gears[0].pair.shift + 0.05)
    pairs = flank_pairs(gears, DRIVE, mounting)
    phi1 = np.linspace(0.1, 6.1, 23)
    lead, _ = first_touch(pairs, phi1, contacts(pairs, phi1))
    driver, driven = (
        half_teeth(gear.profile).moved(gear.toothing, errors, offset)
        for gear, errors, offset in zip(gears, mounting.pitch, mounting.eccentric, strict=True)
    )
    turning = Turning(
        rolling=made.pair.rolling, driver=driver, driven=driven, distance=mounting.distance
    )
    gap = turning.flank_distance(DRIVE, phi1, 0.0, lead)
    assert gap.max() < 5e-4
    # driven ahead a little, the driven wheel is clear of the driver everywhere; back, they overlap
    back = turning.flank_distance(DRIVE, phi1, 0.0, lead + 5e-5)
    assert back.min() > 6e-4
    ahead = turning.overlaps(phi1, 0.0, lead - 5e-5)
    assert np.array_equal(np.unique(ahead.step[ahead.facing]), np.arange(len(phi1)))


def test_the_largest_errors_are_those_of_the_closed_forms() -> None:
    design = with_errors({"eccentricity_mm": [0.05, 0], "steps": 60})
    study = built(design).study("errors")
    whole = study.to_dict()["errors"]["transmission_error_rad"]["peak_to_peak"]
    assert whole == pytest.approx(2.0 * 0.05 / BASE2, rel=5e-3)
    facts = study.group["alone"]["eccentricity1"]
    limit = math.radians(600 / 3600)
    assert facts["largest_transmission_mm"].value == pytest.approx(0.5 * limit * BASE2, rel=5e-3)
    jam = 0.1 / (2.0 * math.tan(ALPHA))
    assert facts["largest_free_running_mm"].value == pytest.approx(jam, rel=0.03)


def test_steps_too_few_for_harmonics_give_the_number_that_is_enough() -> None:
    document = {**ROUND, "pair": ROUND["pair"] | {"teeth": [12, 18]}}
    assembly = Assembly(eccentric=(0.05 + 0j, 0j))
    told = of_error(*pressed(assembly, document, steps=90))
    assert told == "7.5 steps per tooth, needed: 8; steps = 96"
    first, *_ = of_error(*pressed(assembly, document, steps=96))
    assert isinstance(first, dict)
    assert first["order"] == 1


def test_no_error_is_allowed_that_jams_the_pair() -> None:
    """Involutes closer together keep their ratio: only their backlash limits how close."""
    result = gc.build(with_errors({"center_mm": -0.01, "steps": 24}))
    found = result.study("errors").to_dict()["errors"]["alone"]["center"]
    assert found["largest_transmission_mm"] == found["largest_free_running_mm"]
    assert found["largest_free_running_mm"] == pytest.approx(
        -0.05 / math.tan(ALPHA), rel=0.02
    )  # backlash 2*a*tan(alpha)


@pytest.mark.parametrize(
    ("root", "factor"), [(1e-5, 1e-5), (0.37, 0.37), (700.0, 700.0), (2000.0, math.inf)]
)
def test_the_largest_factor_is_a_root(root: float, factor: float) -> None:
    found = largest(lambda x: (x / root) ** 3 - 1.0)
    assert found is not None
    assert found == factor if math.isinf(factor) else 0.998 * factor < found <= factor
    assert largest(lambda x: 0.0 * x) is None
    assert largest(lambda x: 1.0 if x else -1.0) == 0.0


@pytest.mark.parametrize("count", few([20, 50]))
def test_random_assemblies_have_the_percentiles_of_quadrature(count: int) -> None:
    """Equal wheels: the two eccentricities add as vectors of any direction."""
    tolerance = 0.02
    errors = {"eccentricity_tolerance_mm": tolerance, "trials": count, "steps": 12}
    facts = built(with_errors(errors, teeth=[20, 20])).study("errors").group["trials"]
    base = 0.5 * MODULE * 20 * math.cos(ALPHA)
    share = (np.arange(60) + 0.5) / 60
    one, two, turn = np.meshgrid(share, share, 2.0 * math.pi * share)
    size = np.sort(np.abs(one + two * np.exp(1j * turn)).ravel()) * tolerance
    room = 3.0 * math.sqrt(0.25 / count)
    for percent in (50, 90):
        low, high = (
            2.0 / base * size[int(np.clip(percent / 100 + sign * room, 0, 0.9999) * size.size)]
            for sign in (-1, 1)
        )
        assert low < facts["transmission_error_rad"][f"p{percent}"].value < high
    some = {**errors, "trials": 3}
    one, again = (gc.build(with_errors(some, teeth=[20, 20])).study("errors") for _ in range(2))
    assert one.group["trials"] == again.group["trials"]


@pytest.mark.slow
def test_a_study_is_written(tmp_path: Path) -> None:
    (tmp_path / "pitch.csv").write_text("wheel,tooth,pitch_mm\n1,3,0.01\n2,7,-0.005\n", "utf-8")
    text = """
    kind = "gear-pair"
    law = { type = "constant" }
    pair = { teeth = [20, 30], module_mm = 2, backlash_mm = 0.1 }
    errors = { center_mm = 0.02, tilt_deg = [0.1, 0.05], file = "pitch.csv", steps = 12 }
    output = { files = ["report"], studies = ["errors"] }
    """
    (tmp_path / "made.toml").write_text(text, "utf-8")
    result = gc.build(gc.load(tmp_path / "made.toml"))
    found = result.study("errors")
    assert {*found.group["alone"]} == {"center", "pitch1", "pitch2", "tilt"}
    assert "lag_tilt_rad" in found.columns
    assert len(found.columns["phi1_deg"]) == 12 * 3
    assert "transmission_error" in found.charts
    written = result.write(tmp_path / "out")
    page = (Path(written.directory) / "report.html").read_text("utf-8")
    assert "Transmission error with errors of mounting and making" in page
    assert result.facts["errors.contact_ratio"] == pytest.approx(1.6, abs=0.05)


@pytest.mark.parametrize(
    ("errors", "message"),
    [
        ({"file": "3,1,0.1"}, "line 2: no tooth 1 of a wheel 3"),
        ({"file": "1,1.5,0.1"}, "line 2: no tooth 1.5 of a wheel 1"),
        ({"file": "1,1,0.1\n1,1,0.2"}, "line 3: a second error of tooth 1"),
        ({"eccentricity_mm": -1}, "-1"),
        ({"distribution": "gauss"}, "normal"),
        ({"trials": 5}, "trials: 5: needs a tolerance"),
    ],
)
def test_errors_that_cannot_be_read_are_refused(
    errors: dict[str, Any], message: str, tmp_path: Path
) -> None:
    if "file" in errors:
        path = tmp_path / "pitch.csv"
        path.write_text("wheel,tooth,pitch_mm\n" + errors["file"] + "\n", "utf-8")
        errors = {"file": str(path)}
    with pytest.raises(DesignError, match=message):
        with_errors(errors)


def test_errors_that_a_pair_cannot_have_are_refused(tmp_path: Path) -> None:
    path = tmp_path / "pitch.csv"
    path.write_text("wheel,tooth,pitch_mm\n2,31,0.01\n", "utf-8")
    with pytest.raises(InfeasibleError, match="wheel 2 does not have") as caught:
        built(with_errors({"file": str(path)})).study("errors")
    assert "its teeth are 1 to 30" in str(caught.value)
    path.write_text("wheel,tooth,pitch_mm\n2,3,4\n", "utf-8")
    with pytest.raises(InfeasibleError, match="larger than a quarter of the pitch"):
        built(with_errors({"file": str(path)})).study("errors")
    with pytest.raises(InfeasibleError, match="do not reach each other"):
        built(with_errors({"center_mm": 20})).study("errors")


@pytest.mark.parametrize(
    ("size", "codes"), few([(0.3, {"jams", "transmission-error"}), (0.01, set())])
)
def test_jamming_and_a_large_error_are_found(size: float, codes: set[str]) -> None:
    found = built(with_errors({"eccentricity_mm": size, "steps": 12})).study("errors")
    assert {one.code for one in found.study_findings} == codes


@pytest.mark.slow
@pytest.mark.parametrize("name", few(["round", "ellipse"]))
def test_without_backlash_wheels_further_apart_run_free(name: str) -> None:
    document = ROUND if name == "round" else ELLIPSE
    errors = {"center_mm": 0.01, "eccentricity_mm": 0.01, "steps": 12}
    pair = document["pair"] | {"backlash_mm": 0, "teeth": [20, 20]}
    found = built(gc.design({**document, "pair": pair, "errors": errors})).study("errors").to_dict()
    alone = found["errors"]["alone"]
    assert alone["center"]["largest_free_running_mm"] > 0.5
    assert alone["eccentricity1"]["largest_free_running_mm"] == 0.0


@pytest.mark.slow
def test_tips_do_not_reach_into_roots() -> None:
    """With much backlash the clearance of the rack, 0.25 modules, is what limits."""
    errors = {"center_mm": -0.44, "steps": 48}
    found = built(with_errors(errors, backlash_mm=1.0)).study("errors")
    assert "interference" not in {one.code for one in found.study_findings}
    most = found.to_dict()["errors"]["alone"]["center"]["largest_free_running_mm"]
    assert -0.5 < most < -0.44
    errors["center_mm"] = -0.52
    found = built(with_errors(errors, backlash_mm=1.0)).study("errors")
    assert "interference" in {one.code for one in found.study_findings}


@pytest.mark.slow
def test_interference_is_found_where_outlines_overlap() -> None:
    """Non-circular wheels, whose common normal is inclined to the line of centres."""
    document = {**ELLIPSE, "pair": ELLIPSE["pair"] | {"backlash_mm": 1.0}}
    made = built(gc.design(document))
    for center, hits in ((-0.45, False), (-0.56, True)):
        errors = {"center_mm": center, "steps": 36}
        found = built(gc.design({**document, "errors": errors})).study("errors")
        seen = {one.code for one in found.study_findings}
        assert ("interference" in seen) == hits
        assert (overlap(made, center, 36) > 0.01) == hits


def overlap(made: Any, center: float, steps: int) -> float:
    """Largest overlap of the outlines, mm2, in the middle of their backlash."""
    worst = 0.0
    phi1 = np.linspace(0.0, 2.0 * math.pi, steps, endpoint=False)
    running = run([made.gears], 10.0, Assembly(center=center), phi1)
    radius = np.abs(made.pair.rolling.tracks[1].frames(phi1).p)
    turn = running.lead + 0.5 * running.backlash / radius
    for phi, lead in zip(phi1, turn, strict=True):
        one, two = (
            shapely.Polygon(np.stack([z.real, z.imag], axis=1))
            for z in (
                made.gear1.outline @ [1, 1j] * np.exp(-1j * phi),
                made.gear2.outline @ [1, 1j] * np.exp(1j * (made.law.phi2(phi) + lead))
                + made.pair.center_distance
                + center,
            )
        )
        worst = max(worst, one.intersection(two).area)
    return worst


def test_only_wheel_2_makes_turns_differ() -> None:
    gears = built(gc.design(ROUND)).gears
    error = {7: 0.01}
    for assembly, turns in (
        (Assembly(pitch=(error, {}), eccentric=(0.01 + 0j, 0j)), 1),
        (Assembly(pitch=({}, error)), 3),
        (Assembly(eccentric=(0j, 0.01j)), 3),
    ):
        phi1 = cycle(gears, 90, alike=assembly.alike)
        assert len(phi1) == 90 * turns
    once, whole = (
        run([gears], 10.0, Assembly(pitch=(error, {})), cycle(gears, 90, alike=alike)).lead
        for alike in (True, False)
    )
    assert np.tile(once, 3) == pytest.approx(whole, abs=1e-13)


def test_a_percentile_is_kept_by_so_many_assemblies() -> None:
    """Also where some of them do not touch everywhere."""
    errors = {"center_tolerance_mm": 6.0, "trials": 12, "steps": 24}
    found = built(with_errors(errors)).study("errors").to_dict()["errors"]["trials"]
    assert found["count"] == 12
    assert 0 < found["apart"] < 6
    assert "p50" in found["transmission_error_rad"]
    assert "p99" not in found["transmission_error_rad"]


def test_an_error_of_pitch_of_a_rack_or_a_step_counts() -> None:
    stepped = gc.load("profiles/stepped_ellipse.toml")
    made = gc.build(stepped)
    assert len(made.steps) > 1
    phi1 = np.linspace(0.0, 2.0 * math.pi, 96, endpoint=False)
    ahead = Assembly(pitch=({3: -0.05}, {}))
    leads = [run([gears], 10.0, ahead, phi1).lead for gears in made.steps]
    every = run(made.steps, 10.0, ahead, phi1).lead
    assert every == pytest.approx(np.max(leads, axis=0), abs=1e-15)
    assert np.abs(leads[0] - leads[1]).max() > 1e-4


def test_a_rack_has_no_tolerance_of_eccentricity() -> None:
    design = gc.load("profiles/feeder.toml").with_(
        {"errors.eccentricity_tolerance_mm": [0.01, 0.01], "errors.trials": 2}
    )
    with pytest.raises(InfeasibleError, match="a rack has no shaft"):
        gc.build(design).study("errors")
