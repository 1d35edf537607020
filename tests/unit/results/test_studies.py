"""Studies that a design asks for: in facts, findings, charts, scene, files, summary and hash."""

from __future__ import annotations

import json
import pickle
from dataclasses import replace
from pathlib import Path
from typing import Any

import numpy as np
import pytest

import gearcam
from gearcam.base.errors import DesignError
from gearcam.cli import main
from gearcam.results.kind import KINDS
from gearcam.results.studies import Study

PROFILES = Path(__file__).parents[3] / "profiles"
CENTER = {"meshing.center_distance_mm": 42.2, "meshing.steps": 96}


@pytest.fixture(scope="module")
def plain() -> Any:
    return gearcam.load(PROFILES / "ellipse.toml").with_(CENTER)


@pytest.fixture(scope="module")
def asked(plain: Any) -> Any:
    return gearcam.build(plain.with_({"output.studies": ["mesh"], "output.files": ["csv"]}))


def test_every_kind_names_its_studies_alike() -> None:
    for kind in KINDS.values():
        output = kind.table("output").entries["studies"].param.choices
        assert output is not None
        assert set(kind.studies) == set(kind.study_tables) == set(output)
        for name, study in kind.studies.items():
            assert study.name == name
            assert kind.study_tables[name] == study.table
            assert study.table in kind.tables


def test_its_facts_stand_beside_those_of_the_design(asked: Any, plain: Any) -> None:
    alone = gearcam.build(plain)
    study = alone.mesh()
    assert "meshing" not in alone.facts.document
    assert asked.facts.document["meshing"] == study.facts.document["meshing"]
    assert asked.facts["meshing.center_distance_mm"] == 42.2
    assert asked.facts.document["mesh"] == alone.facts.document["mesh"]


def test_it_is_computed_once(asked: Any) -> None:
    assert asked.study("mesh") is asked.studies["mesh"] is asked.mesh()
    assert asked.mesh(steps=3) is not asked.mesh()


def test_its_charts_are_charts_of_the_result(asked: Any, plain: Any) -> None:
    """The mounted transmission error: peak to peak as in the facts, unlike that of the design."""
    assert "mesh.transmission_error" in asked.charts
    line = asked.chart("mesh.transmission_error").lines[0]
    assert np.ptp(line.y) == pytest.approx(
        asked.facts["meshing.transmission_error.peak_to_peak"], rel=1e-9
    )
    assert np.ptp(line.y) > 1e-4
    designed = asked.chart("transmission_error").lines[0]
    assert np.ptp(designed.y) < 1e-9
    with pytest.raises(DesignError):
        gearcam.build(plain).chart("mesh.transmission_error")


def test_a_chart_is_drawn_once_for_each_setting(asked: Any) -> None:
    """The patches of the design depend on the overclosure of the study."""
    chart = asked.chart("contact_patch")
    assert asked.chart("contact_patch") is chart
    other = asked.mesh(overclosure_deg=0.1).result.chart("contact_patch")
    assert "0.1 deg" in other.title
    assert other.title != chart.title


def test_its_charts_are_drawn_when_they_are_read(
    plain: Any, monkeypatch: pytest.MonkeyPatch
) -> None:
    from gearcam.kinds.gear_pair import studies

    drawn, draw = [], studies._charts

    def counted(*given: Any) -> Any:
        drawn.append(given)
        return draw(*given)

    monkeypatch.setattr(studies, "_charts", counted)
    study = gearcam.build(plain).mesh(steps=12)
    assert study.to_dict()["meshing"]
    assert drawn == []
    copy = pickle.loads(pickle.dumps(study))
    assert [*copy.charts] == [*study.charts] == ["transmission_error", "contact_patch"]
    assert len(drawn) == 1
    line, same = (one.charts["contact_patch"].lines[0] for one in (study, copy))
    assert np.array_equal(line.y, same.y, equal_nan=True)


def test_the_patches_that_are_shown_are_those_of_the_outlines(asked: Any) -> None:
    """Two methods: overlap of outlines, and the integral over the exact flanks."""
    measured, exact = asked.chart("mesh.contact_patch").lines
    both = np.isfinite(measured.y) & np.isfinite(exact.y) & (exact.y > 0.0)
    assert both.sum() > 120
    assert np.median(np.abs(measured.y[both] / exact.y[both] - 1.0)) < 0.02  # chords


def test_points_of_contact_as_mounted_move_with_the_scene(asked: Any) -> None:
    """At a larger centre distance a pair of wheels touches farther out on the line of centres."""
    scene = asked.scene(360)
    found = scene.contacts["as mounted"]
    assert found.start[-1] == len(found.point) > 360
    rows = asked.study("mesh").columns
    k = 90
    here = (rows["phi1_deg"] == scene.places[k]) & (rows["carries"] == 1.0)
    there = np.abs(found.point[found.start[k] : found.start[k + 1]])
    np.testing.assert_allclose(
        np.sort(there), np.sort(rows["contact_radius1_mm"][here]), rtol=1e-12
    )


def test_a_finding_that_the_study_repeats_is_given_once(plain: Any) -> None:
    """Mounted so far apart that the contact ratio is too small: the design alone is not."""
    far = plain.with_({"meshing.center_distance_mm": 43.6, "output.studies": ["mesh"]})
    result = gearcam.build(far)
    low = gearcam.build(far.with_({"limits.contact_ratio": 1.99}))
    assert "contact-ratio" in [one.code for one in low.checked]
    for one in (result, low):
        found = [finding for finding in one.findings if finding.code == "contact-ratio"]
        assert found
        assert found == [f for f in one.study("mesh").study_findings if f.code == "contact-ratio"]


def test_the_hash_depends_on_what_is_asked_for(plain: Any, asked: Any) -> None:
    other = plain.with_({"meshing.steps": 36})
    assert gearcam.build(plain).design_hash == gearcam.build(other).design_hash
    also = asked.design.with_({"meshing.steps": 36})
    hashes = {gearcam.build(one).design_hash for one in (plain, asked.design, also)}
    assert len(hashes) == 3


def test_a_build_writes_it_and_its_report_shows_it(
    tmp_path: Path, capsys: pytest.CaptureFixture[str]
) -> None:
    file = tmp_path / "mine.toml"
    text = (PROFILES / "ellipse.toml").read_text()
    text += "\n[meshing]\ncenter_distance_mm = 42.2\nsteps = 60\n"
    assert "[output]" in text
    head = text.replace("[output]", '[output]\nstudies = ["mesh"]')
    file.write_text(head)
    assert main(["build", str(file), "--only", "report", "-o", str(tmp_path)]) == 0
    out = capsys.readouterr().out
    assert "phases studied" in out
    assert "meshing.csv" in out
    folder = tmp_path / "ellipse"
    summary = json.loads((folder / "summary.json").read_text())
    assert summary["meshing"]["steps_done"] == 60
    page = (folder / "report.html").read_text()
    assert "Transmission error, as mounted" in page
    assert "as mounted" in page


def test_a_search_for_remedies_does_without_it(asked: Any, monkeypatch: pytest.MonkeyPatch) -> None:
    def never(*_: Any) -> None:
        raise AssertionError("a study was computed")

    monkeypatch.setattr(Study, "compute", property(lambda _: never), raising=False)
    wide = asked.design.with_({"blank.bore_diameter_mm": 60})
    assert gearcam.remedies(gearcam.build(wide), patience=3.0).builds > 0


def test_a_study_may_use_the_scene_of_its_design(
    asked: Any, monkeypatch: pytest.MonkeyPatch
) -> None:
    """Without itself in it."""
    usual = asked.study("mesh")

    def compute(result: Any, _: Any) -> Any:
        assert "as mounted" not in result.scene(12).contacts
        return usual

    studies = KINDS["gear-pair"].studies
    monkeypatch.setattr(studies, "own", {"mesh": replace(studies["mesh"], compute=compute)})
    result = gearcam.build(asked.design)
    assert result.study("mesh") is usual
    assert "as mounted" in result.scene(12).contacts


def test_follow_is_asked_for_with_a_profile(tmp_path: Path) -> None:
    design = gearcam.load(PROFILES / "eccentric_cam.toml")
    with pytest.raises(DesignError, match=r"follow\.file"):
        design.with_({"output.studies": ["follow"]})
    result = gearcam.build(design)
    name = tmp_path / "measured.csv"
    rows = "\n".join(f"{x!r},{y!r}" for x, y in result.profile.vertices.tolist())
    name.write_text(f"x_mm,y_mm\n{rows}\n")
    other = design.with_({"output.studies": ["follow"], "follow.file": str(name)})
    found = gearcam.build(other).facts
    assert abs(found["followed.largest_difference"]) <= found["followed.error"]


def test_a_study_that_no_kind_has_is_refused(plain: Any) -> None:
    with pytest.raises(DesignError, match="mehs"):
        plain.with_({"output.studies": ["mehs"]})
    with pytest.raises(DesignError, match="twice"):
        plain.with_({"output.studies": ["mesh", "mesh"]})
    with pytest.raises(DesignError, match="mesh"):
        gearcam.build(plain).study("mehs")
