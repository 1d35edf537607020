"""Random assemblies of a pair: rows, percentiles, processes, interruptions."""

from __future__ import annotations

import csv
from pathlib import Path
from typing import Any

import numpy as np
import pytest

import gearcam as gc
from gearcam.base import processes
from gearcam.base.errors import DesignError
from gearcam.base.findings import run_checks
from gearcam.kinds.gear_pair.error_trials import AssemblyTrials, Outcome
from gearcam.meshing.settings import TRIALS
from gearcam.results.study import StudyResult
from helpers_built import built

ERRORS = {
    "eccentricity_tolerance_mm": [0.03, 0.02],
    "center_tolerance_mm": 0.02,
    "pitch_tolerance_mm": 0.004,
    "trials": 12,
    "steps": 24,
    "percentiles": [25, 99.9],
}
DOCUMENT: dict[str, Any] = {
    "kind": "gear-pair",
    "name": "tried",
    "law": {"type": "ellipse", "eccentricity": 0.3},
    "pair": {"teeth": [20, 20], "module_mm": 2, "backlash_mm": 0.1},
    "errors": ERRORS,
}


def studied(**errors: Any) -> StudyResult:
    return built(gc.design({**DOCUMENT, "errors": ERRORS | errors})).study("errors")


def test_every_assembly_is_a_row_with_its_errors() -> None:
    study = studied()
    table = study.tables["trials"]
    assert table["number"].tolist() == list(range(1, 13))
    assert np.ptp(table["center_mm"]) > 0.01
    assert (np.abs(table["center_mm"]) <= 0.02).all()
    assert (table["eccentricity1_mm"] <= 0.03).all()
    assert table["eccentricity1_mm"].max() > 0.02
    assert not table["tilt_across_deg"].any()
    pitches = [name for name in table if name.startswith("pitch2_tooth")]
    assert len(pitches) == 20
    assert np.ptp(table[pitches[7]]) > 0.0


def test_a_row_runs_as_a_pair_with_its_errors() -> None:
    """The errors of a row, given to a design, have its transmission error and backlash."""
    table = studied(pitch_tolerance_mm=0.0).tables["trials"]
    row = {name: float(values[4]) for name, values in table.items()}
    alone = {
        "center_mm": row["center_mm"],
        "eccentricity_mm": [row["eccentricity1_mm"], row["eccentricity2_mm"]],
        "eccentricity_deg": [row["eccentricity1_deg"], row["eccentricity2_deg"]],
        "steps": 24,
    }
    facts = built(gc.design({**DOCUMENT, "errors": alone})).study("errors").facts
    error = facts["errors.transmission_error_rad.peak_to_peak"]
    assert row["transmission_error_rad"] == pytest.approx(error, rel=1e-9)
    least, _ = facts["errors.backlash_mm"].values()
    assert row["least_backlash_mm"] == pytest.approx(least, rel=1e-9)


def test_percentiles_are_those_asked_for() -> None:
    study = studied()
    errors = np.sort(study.tables["trials"]["transmission_error_rad"])
    found = study.facts["errors.trials.transmission_error_rad"]
    assert dict(found) == {"p25": errors[2], "p99_9": errors[-1]}


def test_assemblies_that_jam_are_a_warning_with_the_backlash_that_frees_them() -> None:
    pair = DOCUMENT["pair"]
    study = built(gc.design({**DOCUMENT, "pair": pair | {"backlash_mm": 0.01}})).study("errors")
    table = study.tables["trials"]
    jam = int(table["jams"].sum())
    assert 0 < jam < 12
    (found,) = study.study_findings
    assert (found.code, found.severity, found.relation) == ("assemblies-jam", "warning", "at least")
    assert found.message.startswith(f"{jam} of 12 random assemblies jam: about ")
    assert found.value == table["least_backlash_mm"].min() < found.limit == 0.0
    assert found.where == f"assembly {table['least_backlash_mm'].argmin() + 1}"
    # percentiles count all of them, and say so
    errors = np.sort(table["transmission_error_rad"])
    p25 = study.facts.quantity("errors.trials.transmission_error_rad.p25")
    assert p25.value == errors[2]
    assert "(those that jam too)" in p25.meaning
    more = float(found.message.partition("about ")[2].split()[0])
    assert -found.value <= more <= -1.1 * found.value
    freed = gc.design({**DOCUMENT, "pair": pair | {"backlash_mm": 0.01 + more}})
    study = built(freed).study("errors")
    assert not study.tables["trials"]["jams"].any()
    assert study.study_findings == ()
    assert "jam" not in study.facts.quantity("errors.trials.transmission_error_rad.p25").meaning


def test_of_measured_outlines_no_backlash_is_told() -> None:
    jammed = [Outcome(1e-3, -0.2, jams=True), Outcome(1e-3, 0.1, jams=False)]
    trials = AssemblyTrials(assemblies=(), outcomes=jammed, unit="rad", measured=True)
    (found,) = run_checks(TRIALS, trials, {})
    assert found.message.startswith("1 of 2 random assemblies jam: how much more backlash")
    assert "is not known" in found.message


@pytest.mark.parametrize("wrong", [[0], [101], [], [50, 50]])
def test_wrong_percentiles_are_refused(wrong: list[float]) -> None:
    with pytest.raises(DesignError, match="percentiles"):
        gc.design({**DOCUMENT, "errors": ERRORS | {"percentiles": wrong}})


def test_every_row_is_in_a_file(tmp_path: Path) -> None:
    study = studied()
    study.write(tmp_path)
    with (tmp_path / "tried" / "errors_trials.csv").open() as file:
        rows = list(csv.DictReader(file))
    table = study.tables["trials"]
    assert list(rows[0]) == list(table)
    assert [float(row["least_backlash_mm"]) for row in rows] == table["least_backlash_mm"].tolist()


def test_an_assembly_without_contact_has_empty_cells() -> None:
    """Teeth that reach 4.5 mm into each other, moved apart by up to 6 mm."""
    study = studied(
        center_tolerance_mm=6.0, pitch_tolerance_mm=0.0, trials=8, eccentricity_tolerance_mm=[0, 0]
    )
    table = study.tables["trials"]
    lost = np.isnan(table["transmission_error_rad"])
    assert 0 < lost.sum() < 8
    assert study.facts["errors.trials.apart"] == lost.sum()
    assert (np.isnan(table["transmission_error_rad"])[table["center_mm"] > 5.0]).all()


def test_several_processes_give_the_same_rows() -> None:
    design = gc.design(DOCUMENT)
    alone, together = gc.build(design).study("errors"), gc.build(design).study("errors", jobs=2)
    for name, column in alone.tables["trials"].items():
        assert (together.tables["trials"][name] == column).all(), name


def test_a_function_that_cannot_be_sent_is_refused() -> None:
    law = gc.laws.Formula(ratio=lambda phi1: 1.0 + 0.1 * np.cos(phi1))
    pair = gc.PairSpec(teeth=(20, 20), module=2.0)
    errors = gc.ErrorsSpec(center_tolerance=0.01, trials=4, steps=24)
    design = gc.GearPairDesign(name="mine", law=law, pair=pair, errors=errors)
    with pytest.raises(DesignError, match="def in a module"):
        gc.build(design).study("errors", jobs=2)


@pytest.mark.parametrize(
    ("name", "jobs"), [("mesh", 2), ("errors", 0), ("errors", 1.5), ("errors", True)]
)
def test_numbers_of_processes_are_checked(name: str, jobs: Any) -> None:
    with pytest.raises(DesignError, match="jobs"):
        built(gc.design(DOCUMENT)).study(name, jobs=jobs)


def test_an_interruption_keeps_the_rows_that_are_done() -> None:
    def interrupted(stage: str, done: int, total: int) -> None:
        if stage == "errors" and done == total - 5:
            raise KeyboardInterrupt

    study = gc.build(gc.design(DOCUMENT)).study("errors", interrupted)
    assert study.interrupted == "7 of 12 trials"
    assert len(study.tables["trials"]["number"]) == 7
    assert study.facts["errors.trials.count"] == 7


def test_a_process_that_reads_an_unguarded_script_ends(monkeypatch: pytest.MonkeyPatch) -> None:
    monkeypatch.setattr(processes, "current_process", lambda: type("P", (), {"_inheriting": True}))
    with pytest.raises(SystemExit):
        gc.build(gc.design(DOCUMENT)).study("errors", jobs=2)
