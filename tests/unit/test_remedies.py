"""Every kind of remedy, followed in a real design file: built, the finding gone, no error new."""

from __future__ import annotations

import math
import re
from collections.abc import Mapping
from functools import cache
from pathlib import Path
from typing import Any

import pytest

import gearcam
from gearcam.cli import main
from gearcam.console import remedy_lines
from gearcam.errors import DesignError, InfeasibleError
from gearcam.gears.bound import contact_bound
from gearcam.gears.checks import Subject
from gearcam.jobs.remedies import Remedies
from gearcam.laws.constant import Constant
from helpers_documents import followed, job_of, written
from helpers_pairs import job

ELLIPSE = {"type": "ellipse", "eccentricity": 0.2}
CIRCLE = {"type": "constant"}
DOOR = {
    "type": "phases",
    "knots_deg": [0, 60, "solve"],
    "ratios": [1, 1.4, 1.4],
    "driven_travel_deg": 200,
}


def pair(law: Mapping[str, Any], teeth: list[int], **tables: Any) -> dict[str, Any]:
    """A pair that is cut as it is, coarse enough to be quick."""
    sizes = {"module_mm": 2, "teeth": teeth} | tables.pop("pair", {})
    output = {"files": ["csv"], "chord_tolerance_mm": 0.01} | tables.pop("output", {})
    return {
        "kind": "gear-pair", "name": "p", "law": dict(law), "pair": sizes, "output": output,
        **tables,
    }  # fmt: skip


def by_distance(law: Mapping[str, Any], teeth: list[int], distance: float) -> dict[str, Any]:
    made = pair(law, teeth)
    del made["pair"]["module_mm"]
    made["pair"]["center_distance_mm"] = distance
    return made


def cam(follower: dict[str, Any], size: dict[str, Any], lift: float = 10, **more: Any) -> Any:
    """A cam that rises, rests and returns."""
    unit = "deg" if follower.get("motion") == "oscillating" else "mm"
    angles = more.pop("angles", [90, 90, 90, 90])
    phases = [
        {"type": kind, "angle_deg": angle}
        for kind, angle in zip(["rise", "dwell", "return", "dwell"], angles, strict=True)
    ]
    for phase in phases:
        if phase["type"] != "dwell":
            phase |= {"law": "3-4-5", f"lift_{unit}": lift}
    output = {"files": ["csv"]}
    return {
        "kind": "cam", "name": "c", "motion": phases, "follower": follower, "cam": size,
        "output": output, **more,
    }  # fmt: skip


ROLLER = {"type": "roller", "roller_radius_mm": 6}
ARM = {"type": "roller", "roller_radius_mm": 6, "motion": "oscillating", "arm_mm": 60}
ARM["pivot_distance_mm"] = 80
FACE = {"type": "flat", "motion": "oscillating", "pivot_distance_mm": 80}

REFUSED: dict[str, tuple[dict[str, Any], set[str]]] = {
    "concave part too tight": (
        pair({"type": "limacon", "eccentricity": 0.7}, [20, 20]),
        {"pair.teeth", "law.eccentricity", "pair.module_mm"},
    ),
    "the same at a centre distance": (
        by_distance({"type": "limacon", "eccentricity": 0.7}, [20, 20], 60),
        {"pair.teeth", "law.eccentricity"},
    ),
    "teeth cut off": (
        pair(
            {"type": "ellipse", "eccentricity": 0.8},
            [8, 8],
            rack={"dedendum": 1.9, "tip_radius": 0},
        ),
        {"pair.teeth", "pair.module_mm"},
    ),
    "bore": (
        pair(CIRCLE, [20, 20], blank={"bore_diameter_mm": 38}, output={"files": ["stl"]}),
        {"blank.bore_diameter_mm"},
    ),
    "hub": (
        pair(CIRCLE, [20, 20], blank={"bore_diameter_mm": 10, "hub_diameter_mm": 36,
             "hub_front_mm": 5, "timing_marks": False}),
        {"blank.hub_diameter_mm"},
    ),
    "no room for marks": (
        # between the root where the mark would be and that which the hub may not reach
        pair({"type": "ellipse", "eccentricity": 0.3}, [21, 21], blank={"bore_diameter_mm": 10,
             "hub_diameter_mm": [25.15, 20], "hub_front_mm": 5}),
        {"blank.timing_marks"},
    ),
    "large marks": (
        pair(CIRCLE, [20, 20], blank={"bore_diameter_mm": 10, "mark_diameter_mm": 9}),
        {"blank.mark_diameter_mm", "blank.timing_marks"},
    ),
    "mark meets a bolt": (
        pair(CIRCLE, [40, 40], blank={"bolts": 4, "bolt_circle_mm": 70, "bolt_diameter_mm": 4}),
        {"blank.timing_marks"},
    ),
    "bolts meet the outline": (
        pair(CIRCLE, [40, 40], blank={"bolts": 4, "bolt_circle_mm": 74, "bolt_diameter_mm": 6,
             "timing_marks": False}),
        {"blank.bolt_diameter_mm", "blank.bolt_circle_mm"},
    ),
    "lightening holes": (
        pair(CIRCLE, [40, 40], blank={"lightening_holes": 5, "rim_mm": 40}),
        {"blank.lightening_holes"},
    ),
    "stop pin of a closed pair": (
        pair(CIRCLE, [20, 20], blank={"stop_pin_mm": [3, 0]}),
        {"blank.stop_pin_mm[0]"},
    ),
    "wide stop pin": (
        pair(DOOR, [30, 30], blank={"stop_pin_mm": [40, 0], "timing_marks": False}),
        {"blank.stop_pin_mm[0]"},
    ),
    "coarse": (
        by_distance(CIRCLE, [40, 40], 40) | {"output": {"chord_tolerance_mm": 0.1}},
        {"output.chord_tolerance_mm"},
    ),
    "play": (pair(CIRCLE, [20, 20], pair={"backlash_mm": 4}), {"pair.backlash_mm"}),
    "shift": (
        pair(CIRCLE, [40, 40], pair={"x": 0.9}, rack={"addendum": 0.8}), {"pair.x"}
    ),
    "shallow": (
        pair(CIRCLE, [40, 40], rack={"addendum": 1.2, "dedendum": 1}),
        {"rack.dedendum", "rack.addendum"},
    ),
    "pointed rack": (pair(CIRCLE, [40, 40], rack={"dedendum": 2.4}), {"rack.dedendum"}),
    "tip radius": (
        pair(CIRCLE, [40, 40], rack={"tip_radius": 0.5, "dedendum": 1.25}), {"rack.tip_radius"}
    ),
    "ratios that do not close": (
        pair({"type": "phases", "knots_deg": [0, 120, 240, 360], "ratios": [1.2, 0.8, 1.1, 1.2]},
             [40, 40]),
        {"law.ratios[0]", "law.ratios[1]", "law.ratios[2]", "law.ratios[3]"},
    ),
    "knots that miss a lobe": (
        pair({"type": "phases", "knots_deg": [0, 160, 350], "ratios": [1.2, 0.8, 1.2]}, [40, 40]),
        {"law.knots_deg"},
    ),
    "knots of three phases": (
        pair({"type": "three-phase-polynomial", "knots_deg": [0, 160, 270, 350], "lowest": 0.8},
             [40, 40]),
        {"law.knots_deg[3]"},
    ),
    "lowest ratio": (
        pair({"type": "three-phase-polynomial", "knots_deg": [0, 160, 270, 360], "lowest": 1.2},
             [40, 40]),
        {"law.lowest"},
    ),
    "harmonics": (
        pair({"type": "fourier", "cosines": [0.9, -0.4], "sines": [0.3]}, [40, 40]),
        {"law.cosines", "law.sines"},
    ),
    "corner radius": (
        pair({"type": "rounded-polygon", "corners": 4, "corner_radius": 0.6}, [60, 60]),
        {"law.corner_radius"},
    ),
    "corners": (
        pair({"type": "rounded-polygon", "corners": 3, "corner_radius": 0.25}, [80, 40]),
        {"law.corners"},
    ),
    "lobes": (
        pair({"type": "lobed", "eccentricity": 0.1, "lobes": [3, 2]}, [40, 40]), {"law.lobes"}
    ),
    "one lobe": (pair({"type": "limacon", "eccentricity": 0.1}, [40, 60]), {"pair.teeth"}),
    "a crank's teeth": (
        pair({"type": "motion", "slide": "1 - cos(phi1)", "rod": 4}, [40, 60]), {"pair.teeth"}
    ),
    "teeth of an open pair": (pair(DOOR, [30, 36]), {"pair.teeth"}),
    "a long way": (pair(DOOR | {"driven_travel_deg": 300, "ratios": [1, 0.6, 0.6]}, [40, 40]),
                   {"law.driven_travel_deg"}),
    "steps of an open pair": (pair(DOOR, [30, 30], helix={"steps": 3}), {"helix.steps"}),
    "follower's offset": (cam(ROLLER | {"offset_mm": 35}, {"prime_radius_mm": 30}),
                          {"follower.offset_mm", "cam.prime_radius_mm"}),
    "lift below the axis": (
        cam(ROLLER, {"prime_radius_mm": 20}) | {"motion": [
            {"type": "segment", "angle_deg": 180, "to_mm": -25},
            {"type": "segment", "angle_deg": 180, "to_mm": 0},
        ]},
        {"cam.prime_radius_mm", "motion[0].to_mm"},
    ),
    "arm": (cam(ARM, {"prime_radius_mm": 15}), {"cam.prime_radius_mm"}),
    "arm's swing": (
        cam(ARM, {"prime_radius_mm": 60}, lift=150), {"motion[0].lift_deg", "motion[2].lift_deg"}
    ),
    "face": (cam(FACE, {"base_radius_mm": 90}), {"cam.base_radius_mm"}),
    "face's swing": (
        cam(FACE, {"base_radius_mm": 40}, lift=25, angles=[90, 90, 40, 140]),
        {"motion[0].lift_deg", "motion[2].lift_deg"},
    ),
}  # fmt: skip
"""Design files that are refused, and keys of which some must be in a remedy."""

ERRORS: dict[str, tuple[dict[str, Any], set[str], set[str]]] = {
    "undercut that leaves nothing to drive": (
        pair({"type": "ellipse", "eccentricity": 0.6}, [12, 12]),
        {"contact-ratio", "undercut"},
        {"pair.teeth", "pair.module_mm"},
    ),
    "unequal lobes": (
        pair({"type": "ellipse", "eccentricity": 0.3}, [16, 8]),
        {"contact-ratio", "undercut"},
        {"pair.teeth", "pair.module_mm"},
    ),
    "short teeth": (
        pair(CIRCLE, [40, 40], rack={"addendum": 0.5}),
        {"contact-ratio"},
        {"rack.addendum"},
    ),
    "rounded tips": (
        pair(
            CIRCLE,
            [12, 12],
            rack={"pressure_angle_deg": 28},
            blank={"tip_rounding_mm": 1},
        ),
        {"lost-flank"},
        {"blank.tip_rounding_mm"},
    ),
    "undercut cam": (
        cam(
            ROLLER | {"roller_radius_mm": 20}, {"prime_radius_mm": 30}, 20, angles=[60, 60, 60, 180]
        ),
        {"undercut"},
        {"cam.prime_radius_mm", "follower.roller_radius_mm"},
    ),
}
"""Design files that build with errors, those, and keys of which some must be in a remedy."""

DESIGNS = {name: (made[0], made[-1]) for name, made in (REFUSED | ERRORS).items()}


@cache
def search(name: str, folder: Path) -> Remedies:
    """What the search finds, with time for slow machines."""
    return gearcam.remedies(job_of(DESIGNS[name][0], folder), patience=20.0)


@pytest.fixture(scope="module")
def folder(tmp_path_factory: pytest.TempPathFactory) -> Path:
    return tmp_path_factory.mktemp("remedies")


def errors(document: Mapping[str, Any], folder: Path) -> set[str]:
    """Codes of the errors of a design, ``refused`` where it is."""
    try:
        findings = job_of(document, folder).findings
    except (InfeasibleError, DesignError):
        return {"refused"}
    return {finding.code for finding in findings if finding.severity == "error"}


LONG = {
    "the same at a centre distance",
    "teeth cut off",
    "bolts meet the outline",
    "a crank's teeth",
    "a long way",
    "rounded tips",
}


@pytest.mark.parametrize(
    "name", [pytest.param(name, marks=[pytest.mark.slow] * (name in LONG)) for name in DESIGNS]
)
def test_what_a_search_names_is_true_when_followed(name: str, folder: Path) -> None:
    document, keys = DESIGNS[name]
    before = errors(document, folder)
    assert before == (ERRORS[name][1] if name in ERRORS else {"refused"})
    found = search(name, folder)
    assert found.found
    assert {key for remedy in found.found for key in remedy.changes} & keys
    for remedy in found.found:
        made = job_of(followed(document, remedy.changes), folder)
        assert not {finding.code for finding in made.findings if finding.severity == "error"}
        assert not {finding.code for finding in made.findings} & before
        assert remedy.design.name == document["name"]


@pytest.mark.parametrize("name", ["concave part too tight", "bore", "short teeth", "harmonics"])
def test_the_next_smaller_change_does_not_do(name: str, folder: Path) -> None:
    document, _ = DESIGNS[name]
    smaller = [remedy.less for remedy in search(name, folder).found if remedy.less]
    before = errors(document, folder)
    for less in smaller:
        made = followed(document, less)
        found = errors(made, folder)
        if not found:
            found = {finding.code for finding in job_of(made, folder).findings} & before
        assert found
    assert smaller or name == "bore"


def told_teeth(message: str) -> list[int]:
    """The tooth counts that a warning names."""
    found = re.search(r"With pair\.teeth = \[(\d+), (\d+)\] or more", message)
    assert found, message
    return [int(count) for count in found.groups()]


UNDER = pair({"type": "ellipse", "eccentricity": 0.3}, [30, 15])
NAIL = by_distance(
    {"type": "phases", "knots_deg": [0, 160, 360], "ratios": [1.6, 0.4, 1.6]}, [36, 36], 180
)
WARNED = {
    "undercut": (UNDER, "undercut"),
    "undercut at a centre distance": (NAIL, "undercut"),
    "undercut of a shifted wheel": (
        pair({"type": "ellipse", "eccentricity": 0.2}, [20, 20], pair={"x": -0.3}), "undercut"
    ),
    "undercut above and below": (
        pair({"type": "formula", "r1": "1 + 0.3*cos(2*phi1)"}, [40, 40]), "undercut"
    ),
    "sharp": (
        pair({"type": "ellipse", "eccentricity": 0.4}, [40, 20], limits={"convex_radius": 9}),
        "sharp",
    ),
    "wide": (
        pair({"type": "formula", "r1": "1 + 0.3*cos(2*phi1)"}, [40, 40],
             limits={"cutter_teeth": 50}),
        "concave-teeth",
    ),
}  # fmt: skip
"""Design files with warnings that name tooth counts."""


@pytest.mark.parametrize("name", WARNED)
def test_tooth_counts_of_warnings_keep_the_lobes_and_are_true(name: str, folder: Path) -> None:
    document, code = WARNED[name]
    told = [found for found in job_of(document, folder).findings if found.code == code]
    assert told
    z1, z2 = document["pair"]["teeth"]
    for finding in told:
        wheel, teeth = finding.where.split(",")[0], told_teeth(finding.message)
        assert teeth[0] * z2 == teeth[1] * z1
        common = math.gcd(z1, z2)
        step = [z1 // common, z2 // common]
        more = [2 * teeth[0], 2 * teeth[1]]
        for counts, gone in (
            (teeth, True),
            (more, True),
            ([a - b for a, b in zip(teeth, step, strict=True)], code == "undercut"),
        ):
            left = job_of(followed(document, {"pair.teeth": counts}), folder).findings
            there = any(f.code == code and f.where.startswith(wheel) for f in left)
            assert there != gone or (code == "undercut" and counts not in (teeth, more))


def test_a_bore_that_a_thin_rim_names_keeps_the_limit_with_its_keyway(folder: Path) -> None:
    blank = {"bore_diameter_mm": 31, "keyway_width_mm": 8, "keyway_depth_mm": 3}
    document = pair(CIRCLE, [22, 22], blank=blank)
    (finding, _) = (f for f in job_of(document, folder).findings if f.code == "thin-rim")
    found = re.search(r"up to ([\d.]+) mm across, keyway included", finding.message)
    assert found
    # half a bore, and the corner of a keyway as deep beyond it as before
    half = math.sqrt((float(found.group(1)) / 2) ** 2 - 16) - 3
    for over, there in ((0.0, False), (0.01, True)):
        changes = {"blank.bore_diameter_mm": 2 * half + over}
        left = job_of(followed(document, changes), folder).findings
        assert any(f.code == "thin-rim" for f in left) == there


def test_a_search_that_takes_too_long_is_given_up_and_says_so(folder: Path) -> None:
    made = job_of(DESIGNS["concave part too tight"][0], folder)
    found = gearcam.remedies(made, patience=0.0)
    assert found.gave_up
    assert not found.found
    assert [*remedy_lines(found)] == ["the search for a remedy was given up after 0 s"]


def test_a_refusal_comes_without_a_search(folder: Path, monkeypatch: pytest.MonkeyPatch) -> None:
    monkeypatch.setattr("gearcam.jobs.remedies.remedies", None)
    with pytest.raises(InfeasibleError):
        _ = job_of(DESIGNS["concave part too tight"][0], folder).findings


def test_a_sound_design_needs_no_remedy(folder: Path) -> None:
    found = gearcam.remedies(job_of(pair(CIRCLE, [20, 20]), folder))
    assert found == Remedies()
    assert [*remedy_lines(found)] == []


def test_the_command_tells_what_was_built(folder: Path, capsys: pytest.CaptureFixture[str]) -> None:
    file = folder / "told.toml"
    file.write_text(written(DESIGNS["shift"][0]), encoding="utf-8")
    assert main(["check", str(file), "-o", str(folder)]) == 3
    told = capsys.readouterr().err
    assert "built without errors with one of these:\n    pair.x = 0." in told
    file.write_text(written(DESIGNS["short teeth"][0]), encoding="utf-8")
    assert main(["check", str(file), "-o", str(folder)]) == 1
    assert "    rack.addendum = 0." in capsys.readouterr().out


@pytest.mark.parametrize("teeth", [(40, 40), (25, 60)])
def test_flanks_alone_give_circular_wheels_their_contact_ratio(teeth: tuple[int, int]) -> None:
    alpha, radii = math.radians(20), [0.5 * z for z in teeth]
    length = sum(
        math.sqrt((r + 1) ** 2 - (r * math.cos(alpha)) ** 2) - r * math.sin(alpha) for r in radii
    )
    made = job(Constant(), teeth)
    ratio = length / (math.pi * math.cos(alpha))
    assert contact_bound(*made.pair.toothings) == pytest.approx(ratio, abs=1e-9)


def test_flanks_alone_bound_the_contact_ratio_and_refuse_what_cannot_drive(folder: Path) -> None:
    for document in (NAIL, UNDER):
        made = job_of(document, folder)
        subject = Subject(pair=made.pair, gears=made.gears, bores=(None, None), backlash=0.0)
        assert subject.contact_ratio <= contact_bound(*made.pair.toothings) + 1e-9
    tight = {"type": "phases", "knots_deg": [0, 60, 360], "ratios": [1.8, 0.2, 1.8]}
    with pytest.raises(InfeasibleError, match="touch for less than a pitch") as caught:
        _ = job_of(pair(tight, [30, 30]), folder).pair
    assert caught.value.value is not None
    assert caught.value.value < 1.0 == caught.value.limit
    with pytest.raises(InfeasibleError, match=r"would allow a contact ratio of 1\.44$"):
        _ = job_of(pair(tight, [46, 46]), folder).pair
