"""A job computes what it is asked for and no more, and leaves its folder right."""

from __future__ import annotations

import csv
import json
import math
import time
from pathlib import Path
from typing import Any

import numpy as np
import pytest

from gearcam.base.errors import InfeasibleError
from gearcam.designs import document_of
from gearcam.gears.rolling import Centrode
from gearcam.gears.spec import Rack
from gearcam.kinds.gear_pair.result import GearPairResult
from gearcam.laws.ratio.constant import Constant
from gearcam.laws.ratio.ellipse import Ellipse
from gearcam.laws.ratio.formula import Formula
from gearcam.laws.ratio.phases import Phases
from gearcam.numeric.arrays import as_pairs
from gearcam.numeric.contour import polygon_area
from helpers_built import fresh
from helpers_pairs import job, profile
from helpers_sampling import few

TOP = [
    "format", "name", "kind", "pair", "mesh", "gears", "accuracy", "hash", "files",
    "contents", "findings", "timings_s", "versions", "design",
]  # fmt: skip
"""Keys of every summary; ``solids`` comes with meshes, ``stale`` with old files."""

PAIR = {"center_distance_mm", "module_mm", "teeth", "face_width_mm", "ratio", "solved"}
PAIR |= {"type", "x", "backlash_mm", "rack"}
CENTRODE = {"length_mm", "min_convex_radius_mm", "max_concave_curvature_per_mm", "closed"}
GEAR = {"cutter", "undercut_teeth", "tip_thickness_min_mm", "outline"}
OUTLINE = {"vertices", "area_mm2", "chord_error_mm"}
ACCURACY = {"driven_angle_rad", "flank_mm", "contact_ratio", "area_mm2", "chord_mm"}


def small(**given: Any) -> GearPairResult:
    """A small pair, quick to cut."""
    law = given.pop("law", Ellipse(eccentricity=0.2))
    sizes = {} if "distance" in given or "module" in given else {"module": 2.0}
    return job(law, given.pop("teeth", (22, 22)), **{"tolerance": 0.01, **sizes, **given})


GIVEN = ("design", "tolerances", "timings", "sizes", "sought", "_studied", "_running", "_drawn")
"""What a job has from the beginning."""


def computed(made: GearPairResult) -> set[str]:
    """What a job has computed so far."""
    return {name for name in vars(made) if name not in GIVEN}


def contents(folder: Path) -> dict[str, bytes]:
    """Files of a folder, by name."""
    return {path.name: path.read_bytes() for path in folder.iterdir()} if folder.exists() else {}


def rows_of(path: Path) -> tuple[list[str], np.ndarray]:
    """Header and numbers of a CSV file."""
    with path.open(newline="") as stream:
        header, *rows = list(csv.reader(stream))
    return header, np.array([[float(value) for value in row] for row in rows])


# Laziness


def test_a_fresh_job_has_computed_nothing(monkeypatch: pytest.MonkeyPatch) -> None:
    calls: list[int] = []
    build = Ellipse.build

    def counted(self: Ellipse, *given: Any) -> Any:
        calls.append(1)
        return build(self, *given)

    monkeypatch.setattr(Ellipse, "build", counted)
    made = fresh(small())
    assert calls == []
    assert computed(made) == set()
    assert made.timings == {}
    assert made.law is made.law
    assert calls == [1]


def test_each_stage_brings_only_what_it_needs() -> None:
    """A stage is on the clock by itself: all together are not more than the whole."""
    made, start = fresh(small()), time.perf_counter()
    stages = [
        ("law", {"law"}),
        ("pair", {"law", "centrodes"}),
        ("gear2", {"law", "centrodes", "gear2"}),
        ("gear1", {"law", "centrodes", "gear1", "gear2"}),
        ("findings", {"law", "centrodes", "gear1", "gear2", "checks"}),
    ]
    for name, timed in stages:
        getattr(made, name)
        assert set(made.timings) == timed
        whole = time.perf_counter() - start
        assert 0.0 < sum(made.timings.values()) <= whole
    assert "parts" not in computed(made)


def test_a_stage_is_computed_once() -> None:
    made = fresh(small())
    first = made.gear1, made.findings
    before = dict(made.timings)
    assert (made.gear1, made.findings) == first
    assert made.timings == before


def test_a_job_with_a_bad_law_says_so_when_asked_and_not_before() -> None:
    made = small(law=Phases(knots=(0.0, 3.0, 2 * math.pi), ratios=(1.5, 0.9, 1.5)))
    with pytest.raises(InfeasibleError, match="do not close"):
        _ = made.gear1
    assert computed(made) == set()


# Summary


def test_a_summary_holds_what_is_promised(tmp_path: Path) -> None:
    made = small()
    summary = made.write(tmp_path, files=["csv"]).summary
    assert list(summary) == TOP
    assert summary["format"] == 1
    assert (summary["name"], summary["kind"]) == ("sample", "gear-pair")
    assert set(summary["pair"]) == PAIR
    assert summary["pair"]["teeth"] == [22, 22]
    assert summary["design"] == document_of(made.design)
    assert set(summary["files"].values()) == {made.design_hash} == {summary["hash"]}
    assert [gear["name"] for gear in summary["gears"]] == ["gear1", "gear2"]
    for gear in summary["gears"]:
        assert set(gear["centrode"]) == CENTRODE
        assert set(gear) >= GEAR
        assert set(gear["outline"]) >= OUTLINE
        assert gear["centrode"]["closed"] is True
    accuracy = summary["accuracy"]
    assert set(accuracy) - {"how"} == set(accuracy["how"]) == ACCURACY
    assert all(accuracy["how"].values())
    assert set(summary["versions"]) >= {"gearcam", "python", "numpy", "shapely"}
    assert {finding["code"] for finding in summary["findings"]} == {"no-backlash"}
    for finding in summary["findings"]:
        assert {"code", "severity", "message"} <= set(finding)
        assert set(finding) <= {
            *("code", "severity", "message", "value", "limit", "relation", "unit", "where")
        }


def test_a_summary_is_json_without_nan_and_reads_back_the_same() -> None:
    for made in (small(), small(law=Constant(), teeth=(5, 40))):
        summary = made.facts.document
        text = json.dumps(summary, allow_nan=False)
        assert json.loads(text) == summary


@pytest.mark.parametrize(
    ("given", "solved"),
    [({"module": 2.0}, "center_distance_mm"), ({"distance": 44.0}, "module_mm")],
)
def test_what_was_left_to_the_program_is_named(given: dict[str, float], solved: str) -> None:
    pair = small(**given).facts.document["pair"]
    assert set(pair["solved"]) == {solved, "center_distance_over_semi_latus_rectum"}
    assert pair["solved"][solved] == pair[solved]


def test_a_solved_ratio_and_a_factor_are_named() -> None:
    turn = 2 * math.pi
    phases = Phases(
        knots=(0.0, math.radians(160), 1.5 * math.pi, turn), ratios=(1.2, 0.8, "solve", 1.2)
    )
    solved = small(law=phases).facts.document["pair"]["solved"]
    # 160/360*(1.2 + 0.8)/2 + 110/360*(0.8 + x)/2 + 90/360*(x + 1.2)/2 = 1
    assert solved["ratios[2]"] == pytest.approx((720 - 320 - 88 - 108) / 200, rel=1e-14)
    factor = small(law=Formula(ratio="2 + 0.4*cos(phi1)")).facts.document["pair"]["solved"]
    assert factor["ratio_factor"] == pytest.approx(0.5, rel=1e-14)


def test_the_chord_error_in_the_summary_covers_both_wheels_between_places_too() -> None:
    summary = small().facts.document
    errors = [gear["outline"]["chord_error_mm"] for gear in summary["gears"]]
    assert summary["accuracy"]["chord_mm"] == pytest.approx(max(errors) / 0.97, rel=1e-12)
    assert 0.0 < max(errors) <= 0.01


# Files


def test_a_build_writes_what_the_design_lists(tmp_path: Path) -> None:
    written = small(files=("csv", "svg")).write(tmp_path)
    assert written.directory == tmp_path / "sample"
    assert set(written.files) == {
        "gear1_outline.csv",
        "gear2_outline.csv",
        "centrodes.csv",
        "pair.svg",
        "summary.json",
    }
    assert set(contents(written.directory)) == set(written.files)
    summary = json.loads((written.directory / "summary.json").read_text())
    assert summary == written.summary
    assert set(summary["files"]) == set(written.files) - {"summary.json"}
    assert {"csv", "svg"} <= set(summary["timings_s"])


def test_files_can_be_chosen_for_one_build(tmp_path: Path) -> None:
    made = small(files=("csv", "svg"))
    assert set(made.write(tmp_path / "one", files=["svg"]).files) == {"pair.svg", "summary.json"}
    assert set(made.write(tmp_path / "none", files=[]).files) == {"summary.json"}


def test_progress_names_every_stage_in_order(tmp_path: Path) -> None:
    told: list[tuple[str, int, int]] = []
    small().write(tmp_path, files=["csv"], progress=lambda *step: told.append(step))
    names = [name for name, _, _ in told]
    assert names == ["law", "centrodes", "gear 1", "gear 2", "checks", "csv", "writing"]
    assert [number for _, number, _ in told] == list(range(len(names)))
    assert {count for _, _, count in told} == {len(names)}


def test_a_build_removes_the_files_it_no_longer_writes(tmp_path: Path) -> None:
    made = small()
    folder = made.write(tmp_path, files=["csv", "svg"]).directory
    (folder / "notes.txt").write_text("mine")
    written = made.write(tmp_path, files=["csv"])
    assert written.removed == ("pair.svg",)
    assert set(contents(folder)) == {*written.files, "notes.txt"}


def test_a_check_removes_nothing_and_keeps_the_list(tmp_path: Path) -> None:
    made = small()
    built = made.write(tmp_path, files=["csv", "svg"])
    before = contents(built.directory)
    checked = made.check(tmp_path)
    assert checked.files == ("summary.json",)
    assert checked.removed == ()
    after = contents(built.directory)
    assert set(after) == set(before)
    assert {name: after[name] for name in after if name != "summary.json"} == {
        name: before[name] for name in before if name != "summary.json"
    }
    assert checked.summary["files"] == built.summary["files"]
    assert json.loads(after["summary.json"])["files"] == built.summary["files"]


def test_a_check_of_a_new_design_writes_the_summary_only(tmp_path: Path) -> None:
    checked = small().check(tmp_path)
    assert set(contents(checked.directory)) == {"summary.json"}
    assert checked.summary["files"] == {}


REFUSED: dict[str, tuple[dict[str, Any], str]] = {
    "bore larger than the root": ({"bores": (40.0, 8.0)}, "bore"),
    "tolerance coarser than m/50": ({"distance": 44.0, "tolerance": 0.05}, "too coarse"),
    "tip radius too large": ({"rack": Rack(dedendum=1.25, tip_radius=0.5)}, "tip radius"),
    "rack deeper than its point": ({"rack": Rack(dedendum=2.4, tip_radius=0.0)}, "pointed"),
    "no closure": (
        {"law": Phases(knots=(0.0, 3.0, 2 * math.pi), ratios=(1.5, 0.9, 1.5))},
        "do not close",
    ),
    "lobes": ({"teeth": (20, 40), "law": Ellipse(eccentricity=0.1, lobes=(2, 3))}, "in the ratio"),
    "ratio not positive": ({"law": Formula(ratio="0.9 + cos(phi1)")}, "positive"),
}


@pytest.mark.parametrize("case", REFUSED)
@pytest.mark.parametrize("way", ["write", "check"])
def test_a_refused_design_writes_and_removes_nothing(case: str, way: str, tmp_path: Path) -> None:
    given, words = REFUSED[case]
    small().write(tmp_path, files=["csv", "svg"])
    before = contents(tmp_path / "sample")
    for place in (tmp_path, tmp_path / "new"):
        with pytest.raises(InfeasibleError, match=words) as caught:
            getattr(small(**given), way)(place)
        assert caught.value.what
    assert contents(tmp_path / "sample") == before
    assert not (tmp_path / "new").exists()


# Tables


def test_the_outline_tables_hold_the_outlines(tmp_path: Path) -> None:
    made = small()
    folder = made.write(tmp_path).directory
    for gear in made.gears:
        header, rows = rows_of(folder / f"{gear.name}_outline.csv")
        assert header == ["x_mm", "y_mm"]
        assert np.array_equal(rows, gear.outline)
        assert polygon_area(rows @ [1, 1j]) > 0.0
        assert not np.array_equal(rows[0], rows[-1])


COLUMNS = ["phi1_deg", "phi2_deg", "ratio", "r1_mm", "r2_mm", "s_mm", "rho1_mm", "rho2_mm"]


@pytest.mark.parametrize("teeth", few([((24, 24),), ((20, 30),), ((30, 20),), ((12, 36),)]))
def test_the_table_of_centrodes_agrees_with_itself(teeth: tuple[int, int], tmp_path: Path) -> None:
    common = math.gcd(*teeth)
    made = small(law=Formula(ratio=f"1 + 0.1*cos({teeth[0] // common}*phi1)"), teeth=teeth)
    header, rows = rows_of(made.write(tmp_path).directory / "centrodes.csv")
    assert header == COLUMNS
    phi1, phi2, ratio, r1, r2, s, rho1, rho2 = rows.T
    distance = made.pair.center_distance
    assert np.all(np.diff(phi1) > 0)
    assert r1 + r2 == pytest.approx(np.full_like(r1, distance), rel=1e-14)
    assert r1 / r2 == pytest.approx(ratio, rel=1e-13)
    assert 1 / rho1 + 1 / rho2 == pytest.approx(
        distance / (r2 * np.hypot(r1, np.gradient(r1, np.radians(phi1), edge_order=2))), rel=2e-3
    )
    turns = phi1[-1] / 360
    assert np.array([phi1[0], phi2[0], s[0]]) == pytest.approx(np.zeros(3), abs=1e-12)
    assert phi2[-1] == pytest.approx(360 * turns * teeth[0] / teeth[1], rel=1e-14)
    assert s[-1] == pytest.approx(math.pi * 2.0 * teeth[0] * turns, rel=1e-13)
    # Both wheels come round.
    assert turns == pytest.approx(round(turns))
    assert phi2[-1] / 360 == pytest.approx(round(phi2[-1] / 360))


def test_the_table_of_centrodes_has_signed_radii(tmp_path: Path) -> None:
    made = profile("nail_machine_two_phase", 0.05)
    _, rows = rows_of(made.write(tmp_path, files=["csv"]).directory / "centrodes.csv")
    rho1, rho2 = rows[:, 6], rows[:, 7]
    # The extremes lie between the half degrees of the table, or on the far side of a knot.
    for found, extreme in (
        (-rho1[rho1 < 0].max(), 144.4514),
        (rho1[rho1 > 0].min(), 68.0793),
        (rho2[rho2 > 0].min(), 29.2869),
    ):
        assert extreme - 1e-4 <= found <= 1.003 * extreme


def test_a_straight_part_has_an_infinite_radius(
    tmp_path: Path, monkeypatch: pytest.MonkeyPatch
) -> None:
    made = fresh(small())
    _ = made.gears
    frames = Centrode.frames
    straight = slice(3, 9)

    def flattened(self: Centrode, phi: Any, **given: bool) -> Any:
        found = frames(self, phi, **given)
        if not found.kappa.size:
            return found
        kappa = found.kappa.copy()
        kappa[straight] = -0.0 if self.wheel == 2 else 0.0
        return found._replace(kappa=kappa)

    monkeypatch.setattr(Centrode, "frames", flattened)
    path = made.write(tmp_path).directory / "centrodes.csv"
    with path.open(newline="") as stream:
        rows = list(csv.DictReader(stream))
    for name in ("rho1_mm", "rho2_mm"):
        assert {row[name] for row in rows[straight]} == {"inf"}
        assert all(math.isfinite(float(row[name])) for row in rows[9:])


# Parts


@pytest.mark.parametrize("bores", [None, (8.0, 12.0)])
def test_timing_marks_face_each_other_at_zero(bores: tuple[float, float] | None) -> None:
    made = small(bores=bores)
    one, two = (part.marks for part in made.parts)
    assert (len(one), len(two)) == (1, 1)
    distance = made.pair.center_distance
    pitch = abs(made.pair.rolling.tracks[0].frames(np.zeros(1)).p[0])
    first, second = one[0].center, two[0].center + distance
    assert (first.imag, second.imag) == (0.0, pytest.approx(0.0, abs=1e-14))
    assert 0.0 < first.real < pitch < second.real < distance
    for part, mark, bore in zip(made.parts, (one[0], two[0]), bores or (0.0, 0.0), strict=True):
        assert mark.diameter > 0.0
        assert abs(mark.center) - 0.5 * mark.diameter > 0.5 * bore
        assert part.contour.polygon.contains(part.contour.polygon.__class__(_ring(mark)))
    if bores is None:
        assert pitch - first.real == pytest.approx(second.real - pitch, rel=1e-12)


def _ring(mark: Any) -> np.ndarray:
    angle = np.linspace(0.0, 2 * np.pi, 65)[:-1]
    return as_pairs(mark.center + 0.5 * mark.diameter * np.exp(1j * angle))


@pytest.mark.parametrize("bores", [None, (8.0, 12.0)])
def test_a_part_weighs_what_its_solid_weighs(bores: tuple[float, float] | None) -> None:
    from gearcam.parts.solids import solid, volume_error

    made = small(bores=bores, tolerance=0.001)
    for part, gear in zip(made.parts, made.gears, strict=True):
        width = made.design.pair.face_width
        hole = sum(opening.shape.moments.area for opening in part.openings)
        dimple = 0.25 * math.pi * part.marks[0].diameter ** 2 * part.marks[0].depth
        assert hole == pytest.approx(0.25 * math.pi * (bores or (0, 0))[gear.wheel - 1] ** 2)
        by_hand = (gear.profile.contour.area - hole) * width - dimple
        assert part.volume == pytest.approx(by_hand, abs=volume_error(part))
        assert abs(solid(part).volume - part.volume) <= volume_error(part) <= 1e-3 * part.volume
