"""Every kind of remedy, followed in a real design file: built, the finding gone, no error new."""

from __future__ import annotations

import math
import re
from collections.abc import Mapping
from dataclasses import replace
from functools import cache
from itertools import count
from pathlib import Path
from types import SimpleNamespace
from typing import Any

import pytest

import gearcam
from gearcam.base.errors import DesignError, InfeasibleError
from gearcam.cli import main
from gearcam.console import remedy_lines, wrapped
from gearcam.designs.writing import toml_text
from gearcam.gears.checks import largest_module
from gearcam.gears.rack_limits import contact_bound
from gearcam.gears.subject import CheckedPair
from gearcam.gears.track import LeastRadius
from gearcam.laws.ratio.constant import Constant
from gearcam.laws.ratio.ellipse import Ellipse
from gearcam.results.advice import Remedies, Remedy
from gearcam.sweeps.rows import measured
from helpers_built import fresh
from helpers_pairs import PROFILES, job
from helpers_remedies import (
    CIRCLE,
    ERRORS,
    NAIL,
    REFUSED,
    ROLLER,
    UNDER,
    WARNED,
    cam,
    followed,
    job_of,
    pair,
)
from helpers_sampling import chosen, few

DESIGNS = {name: (made[0], made[-1]) for name, made in (REFUSED | ERRORS).items()}


@cache
def search(name: str, folder: Path) -> Remedies:
    """What the search finds, with as many builds as it wants."""
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


def moved(document: Mapping[str, Any], changes: Mapping[str, Any]) -> bool:
    """Whether changes of a design change its law, its lift or its mean ratio."""
    z1, z2 = document.get("pair", {}).get("teeth", (1, 1))
    a, b = changes.get("pair.teeth", (z1, z2))
    # a ring turns the same way as its wheel, another wheel the other way
    titles = ("law.", "motion", "pair.type")
    return a * z2 != b * z1 or any(key.startswith(titles) for key in changes)


OTHER_RATIO = {
    *("one lobe", "a crank's teeth", "teeth of an open pair", "the ring first", "an equal ring"),
    *("one lobe in a ring", "teeth of a closed spiral"),
}
"""Designs whose tooth counts are refused for their ratio."""

SOON = (
    *("corner radius", "one lobe in a ring", "bore", "a travel that a formula misses"),
    *("stop pin of a closed pair", "tip radius"),
)
"""Designs that are searched each time."""


@pytest.mark.parametrize("name", chosen([*DESIGNS], *SOON))
def test_what_a_search_names_is_true_when_followed(name: str, folder: Path) -> None:
    document, keys = DESIGNS[name]
    before = errors(document, folder)
    assert before == (ERRORS[name][1] if name in ERRORS else {"refused"})
    found = search(name, folder)
    assert found.found
    assert {key for remedy in found.found for key in remedy.changes} & keys
    for remedy in found.found:
        if name not in OTHER_RATIO and "pair.teeth" in remedy.changes:
            (a, b), (z1, z2) = remedy.changes["pair.teeth"], document["pair"]["teeth"]  # type: ignore[misc]
            assert a * z2 == b * z1
        made = job_of(followed(document, remedy.changes), folder)
        assert not {finding.code for finding in made.findings if finding.severity == "error"}
        warnings = tuple(one.code for one in made.findings if one.severity == "warning")
        assert remedy.remaining == warnings
        assert remedy.moves == moved(document, remedy.changes)
        assert remedy.design.name == document["name"]
    order = [(remedy.moves, remedy.resized, len(remedy.remaining)) for remedy in found.found]
    assert order == sorted(order)
    assert len(order) <= 4


@pytest.mark.parametrize(
    "name", few(["bore", "concave part too tight", "short teeth", "harmonics"])
)
def test_the_next_smaller_change_does_not_do(name: str, folder: Path) -> None:
    document, _ = DESIGNS[name]
    smaller = [remedy.less for remedy in search(name, folder).found if remedy.less]
    for less in smaller:
        assert errors(followed(document, less), folder)
    assert smaller or name == "bore"


@pytest.mark.parametrize(
    "name",
    few(["play", "undercut cam", "follower's offset", "hub", "shallow", "pointed rack", "arm"], 4),
)
def test_remedies_are_short_and_nearly_the_least(name: str, folder: Path) -> None:
    found = search(name, folder).found
    # a change that both the refusal and the usual adjustments name is listed once
    assert len({tuple(remedy.changes) for remedy in found}) == len(found)
    for remedy in found:
        for key, value in remedy.changes.items():
            assert isinstance(value, float)
            assert len(f"{value:.10g}".lstrip("-0.").replace(".", "")) <= 5
            if remedy.less:
                assert value == pytest.approx(remedy.less[key], rel=0.013)  # 1 %, and rounding


@pytest.mark.slow
def test_remedies_of_both_wheels_are_nearly_the_least(folder: Path) -> None:
    blank = {"bore_diameter_mm": 12, "bolts": 6, "bolt_circle_mm": 18, "bolt_diameter_mm": 8}
    document = pair(CIRCLE, [24, 24], blank=blank | {"timing_marks": False})
    (found,) = (
        remedy
        for remedy in gearcam.remedies(job_of(document, folder)).found
        if "blank.bolt_diameter_mm" in remedy.changes
    )
    (widest, same), (wider, _) = (
        made["blank.bolt_diameter_mm"] for made in (found.changes, found.less)
    )  # type: ignore[misc]
    assert widest == same <= 6.0  # 9 mm from the axis beside a bore of 12 mm
    assert widest == pytest.approx(wider, rel=0.011)
    assert len(f"{widest:.10g}") <= 5
    assert wider > 5.9


def told_teeth(message: str) -> list[int]:
    """The tooth counts that a warning names."""
    found = re.search(r"With (?:pair\.teeth = \[|about )(\d+)(?:,| :) (\d+)", message)
    assert found, message
    return [int(count) for count in found.groups()]


@pytest.mark.parametrize("name", few(WARNED, 6))
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


def test_concave_parts_count_in_the_largest_module_without_undercut() -> None:
    gear = job(Constant(), (20, 30)).gear1
    track = SimpleNamespace(convex=LeastRadius(0.0, math.inf), concave=LeastRadius(0.0, 9.0))
    toothing = SimpleNamespace(track=track, cutter=gear.toothing.cutter)
    hollow = SimpleNamespace(wheel=1, toothing=toothing, pair=gear.pair)
    # the mate's straight flank is one module deep
    assert largest_module(hollow) == pytest.approx(9 * math.sin(math.radians(20)) ** 2)  # type: ignore[arg-type]


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
    assert [*remedy_lines(found)] == ["the search for a remedy was ended after 0 designs"]


@pytest.mark.slow
def test_a_slow_machine_finds_the_same(folder: Path, monkeypatch: pytest.MonkeyPatch) -> None:
    made = fresh(job_of(DESIGNS["short teeth"][0], folder))
    found = gearcam.remedies(made)
    early = gearcam.remedies(made, patience=0.3)
    assert (early.builds, early.gave_up) == (3, True)
    clock = count(step=0.9)
    monkeypatch.setattr("gearcam.results.advice.time", SimpleNamespace(perf_counter=clock.__next__))
    assert gearcam.remedies(fresh(made)) == found
    assert found.found


def test_what_was_tried_is_told_only_where_nothing_was_found() -> None:
    remedy = Remedy(changes={"pair.teeth": [30, 30]}, design=None)  # type: ignore[arg-type]
    found = Remedies(found=(remedy,), tried=("pair.teeth",))
    assert [*remedy_lines(found)] == [
        "this change was built without errors:",
        "  pair.teeth = [30, 30]",
    ]
    (line,) = remedy_lines(Remedies(tried=("pair.teeth", "law.eccentricity")))
    assert line == "no remedy was found by changing pair.teeth, law.eccentricity"


@pytest.mark.parametrize(
    ("remaining", "moves", "notes"),
    [
        ((), False, ""),
        (("thin-rim",), False, "  (1 warning remains)"),
        (("thin-rim", "thin-rim"), True, "  (changes the motion; 2 warnings remain)"),
    ],
)
def test_a_remedy_says_what_remains(remaining: tuple[str, ...], moves: bool, notes: str) -> None:
    made: Any = None
    remedy = Remedy(changes={"law.e": 0.1}, remaining=remaining, moves=moves, design=made)
    assert [*remedy_lines(Remedies(found=(remedy,)))][1] == f"  law.e = 0.1{notes}"


def test_a_remedy_of_one_wheel_is_told_as_a_file_has_it(folder: Path) -> None:
    remedies = search("bolts of a ring, but not of its pinion", folder)
    (line,) = [*remedy_lines(remedies)][1:]
    assert line.strip() == "blank.bolts = [0, 6]"
    assert remedies.found[0].changes == {"blank.bolts[0]": 0}


def test_a_path_longer_than_a_line_is_not_broken() -> None:
    path = "/".join(["folder-with-hyphens"] * 8)
    assert wrapped(f"is not in {path} today").splitlines() == [
        "    is not in",
        f"    {path}",
        "    today",
    ]


def test_a_refusal_comes_without_a_search(folder: Path, monkeypatch: pytest.MonkeyPatch) -> None:
    monkeypatch.setattr("gearcam.results.advice.remedies", None)
    with pytest.raises(InfeasibleError):
        _ = fresh(job_of(DESIGNS["concave part too tight"][0], folder)).findings


LARGE_BORE = {"bore_diameter_mm": 90}
GROOVE = {"prime_radius_mm": 60, "form": "groove", "outer_diameter_mm": 180, "groove_depth_mm": 5}
NARROW = {"bore_diameter_mm": [60, 0], "bolts": [0, 3], "bolt_circle_mm": [0, 20]}

LATE = {
    "a bolt no wider than the kerf": (
        pair(CIRCLE, [20, 20], blank=NARROW | {"bolt_diameter_mm": [0, 0.3]}),
        {"files": ["dxf"], "kerf_mm": 0.4},
        "blank.bore_diameter_mm[0]",
    ),
    "a bore no wider than the kerf": (
        cam(ROLLER, {"prime_radius_mm": 40}, blank=LARGE_BORE),
        {"files": ["cut-svg"], "kerf_mm": 75},
        "blank.bore_diameter_mm",
    ),
    "a cutter wider than the groove": (
        cam(ROLLER, GROOVE, blank={"bore_diameter_mm": 120}),
        {"files": ["tool-path"], "tool_radius_mm": 6.1},
        "blank.bore_diameter_mm",
    ),
    "no curvature at cusps": (
        cam({"type": "flat"}, {"base_radius_mm": 12}, blank=LARGE_BORE, limits={"lost_lift_mm": 9}),
        {"files": ["curvature"]},
        "blank.bore_diameter_mm",
    ),
}
"""Designs without and with a file that is refused though the parts are made, and what helped."""


@pytest.mark.slow
@pytest.mark.parametrize("name", list(LATE))
def test_a_remedy_makes_all_files_that_are_asked_for(name: str, folder: Path) -> None:
    document, output, key = LATE[name]

    def helpful(asked: Mapping[str, Any]) -> set[str]:
        document_of_all = document | {"output": document["output"] | asked}
        found = gearcam.remedies(job_of(document_of_all, folder)).found
        for remedy in found:
            assert gearcam.build(remedy.design).files(remedy.design.output.files[0])
        return {" and ".join(remedy.changes) for remedy in found}  # each is enough by itself

    assert key in helpful({})
    assert key not in helpful(output)


def test_of_a_kerf_that_closes_a_keyway_the_widest_is_told(folder: Path) -> None:
    keyed = {"bore_diameter_mm": 10, "keyway_width_mm": 3, "keyway_depth_mm": 1.4}
    design = pair(CIRCLE, [12, 12], blank=keyed, output={"files": ["dxf"], "kerf_mm": 3.5})
    with pytest.raises(InfeasibleError, match="this kerf leaves no simple outline") as caught:
        job_of(design, folder).files("dxf")
    ((way,),) = [caught.value.adjustments]
    assert 2.9 < way.near["output.kerf_mm"] < 3.0  # type: ignore[operator]  # of a keyway of 3 mm
    assert job_of(followed(design, way.near), folder).files("dxf")


def test_of_a_cutter_too_wide_only_the_cutter_is_changed(folder: Path) -> None:
    output = {"files": ["tool-path"], "tool_radius_mm": 7}
    result = job_of(cam(ROLLER, GROOVE, output=output), folder)
    with pytest.raises(InfeasibleError, match="wider than the groove") as caught:
        result.files("tool-path")
    found = gearcam.remedies(result, caught.value).found
    assert [remedy.changes for remedy in found] == [{"output.tool_radius_mm": 6.0}]


def test_a_sound_design_needs_no_remedy(folder: Path) -> None:
    found = gearcam.remedies(job_of(pair(CIRCLE, [20, 20]), folder))
    assert found == Remedies()
    assert [*remedy_lines(found)] == []


def test_the_command_tells_what_was_built(folder: Path, capsys: pytest.CaptureFixture[str]) -> None:
    file = folder / "told.toml"
    file.write_text(toml_text(DESIGNS["shift"][0]), encoding="utf-8")
    assert main(["check", str(file), "-o", str(folder)]) == 3
    told = capsys.readouterr().err
    assert "was built without errors:\n    pair.x = 0." in told
    file.write_text(toml_text(DESIGNS["short teeth"][0]), encoding="utf-8")
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


@pytest.mark.parametrize("x", [-0.9, 0.3, 0.6, 0.9])
def test_flanks_alone_know_how_far_the_mates_of_shifted_teeth_go(x: float) -> None:
    made = job(Ellipse(eccentricity=0.3), (41, 41), x=x)
    assert contact_bound(*made.pair.toothings) == pytest.approx(made.contact_ratio, abs=1e-9)


def test_flanks_alone_bound_the_contact_ratio_and_refuse_what_cannot_drive(folder: Path) -> None:
    for document in (NAIL, UNDER):
        made = job_of(document, folder)
        subject = CheckedPair(pair=made.pair, gears=made.gears, bores=(None, None))
        assert subject.contact_ratio <= contact_bound(*made.pair.toothings) + 1e-9
    tight = {"type": "phases", "knots_deg": [0, 60, 360], "ratios": [1.8, 0.2, 1.8]}
    with pytest.raises(InfeasibleError, match="in contact for less than one pitch") as caught:
        _ = job_of(pair(tight, [30, 30]), folder).pair
    assert caught.value.value is not None
    assert caught.value.value < 1.0 == caught.value.limit
    with pytest.raises(InfeasibleError, match=r"allow a contact ratio of at most 1\.44$"):
        _ = job_of(pair(tight, [46, 46]), folder).pair


@pytest.mark.slow
def test_a_larger_cam_is_no_remedy_for_chords_that_are_too_fine(tmp_path: Path) -> None:
    """Whether its profile can be drawn is asked where any file is, not when it is written."""
    follower = {"type": "domed", "dome_radius_mm": 500.0}
    document = cam(follower, {"base_radius_mm": 2000.0}, 400)
    document["output"]["chord_tolerance_mm"] = 1e-9
    made = job_of(document, tmp_path)
    with pytest.raises(InfeasibleError, match="chords") as refused:
        made.write(tmp_path / "out")
    found = gearcam.remedies(made, refused.value, patience=20.0).found
    assert [set(one.changes) for one in found] == [{"output.chord_tolerance_mm"}]
    gearcam.build(found[0].design).write(tmp_path / "out")


@pytest.mark.slow
def test_no_values_that_help_are_sought_for_candidates(monkeypatch: pytest.MonkeyPatch) -> None:
    """Searches and records look at codes and numbers of findings, which are the same without."""
    design = gearcam.load(PROFILES / "undercut_cam.toml")
    told = gearcam.build(design)
    assert "it keeps all limits" in " ".join(one.message for one in told.findings)
    plain = [replace(one, message="") for one in told.findings]

    def never(*_: Any) -> None:
        raise AssertionError("hints were sought")

    monkeypatch.setattr("gearcam.kinds.cam.hints.hinted", never)
    result = gearcam.build(design)
    assert [replace(one, message="") for one in result.findings_without_hints] == plain
    assert gearcam.remedies(result, patience=1.0).found
    assert result.record()["findings.warnings"] == sum(one.severity == "warning" for one in plain)
    assert measured(design, 0, {}).errors == sum(one.severity == "error" for one in plain)
    with pytest.raises(AssertionError):
        _ = result.findings
