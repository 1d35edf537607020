"""Refusals, findings and remedies of designs in inches, as printed and followed in their files."""

from __future__ import annotations

import re
import tomllib
from pathlib import Path
from typing import Any

import pytest

import gearcam
from gearcam.base.errors import InfeasibleError
from gearcam.base.inches import customary, told
from gearcam.cli import main
from gearcam.designs.writing import toml_text
from helpers_pairs import PROFILES
from helpers_remedies import ERRORS, REFUSED, followed
from helpers_sampling import chosen

DESIGNS = {name: made[0] for name, made in (REFUSED | ERRORS).items()}
QUICK = ("bore", "large marks", "play", "coarse", "follower's offset", "a kerf too wide for flanks")


def in_inches(document: dict[str, Any], file: Path) -> dict[str, Any]:
    made = customary(document | {"units": "inch", "name": file.stem})
    file.write_text(toml_text(made), encoding="utf-8")
    return made


@pytest.mark.parametrize("document", chosen(DESIGNS, *QUICK))
def test_remedies_work_as_they_are_printed(
    document: dict[str, Any], tmp_path: Path, capsys: pytest.CaptureFixture[str],
    monkeypatch: pytest.MonkeyPatch,
) -> None:  # fmt: skip
    monkeypatch.chdir(tmp_path)
    file = tmp_path / "d.toml"
    made = in_inches(document, file)
    assert main(["build", "d.toml"]) in (1, 3)
    printed = "".join(capsys.readouterr())
    assert not re.search(r"(?<!N )(?<![\w/])mm\b|(?<!_n)_mm\b", printed)
    lines = re.search(r"built without errors:\n((?: {4,}.*\n)+)", printed)
    assert lines
    texts = re.sub(r"\n {6,}", " ", lines[1]).splitlines()
    for text in texts:
        pairs = text.partition("  (")[0].partition(" (")[0].strip().split(" and ")
        changes = {
            key: tomllib.loads(f"value = {value}")["value"]
            for key, value in (pair.split(" = ") for pair in pairs)
        }
        (tmp_path / "e.toml").write_text(toml_text(followed(made, changes)), encoding="utf-8")
        assert main(["build", "e.toml", "-q"]) == 0, text


def test_a_refusal_has_the_key_and_the_numbers_of_the_file(tmp_path: Path) -> None:
    in_inches(DESIGNS["bore"], tmp_path / "d.toml")
    design = gearcam.load(tmp_path / "d.toml")
    with pytest.raises(InfeasibleError) as caught:
        _ = gearcam.build(design).parts
    error = told(caught.value, design.units)
    assert error.where == "wheels 1 and 2, blank.bore_diameter_in"
    assert error.unit == "in"
    assert error.value == pytest.approx(38 / 25.4, rel=1e-12)
    assert error.limit == pytest.approx(caught.value.limit / 25.4, rel=1e-12)  # type: ignore[operator]
    assert "takes less than 1.378" in error.nearest
    assert told(caught.value, "mm") is caught.value
    assert told(error, "inch").adjustments == error.adjustments  # nothing is left to translate


@pytest.mark.parametrize(
    ("name", "text"),
    [
        ("bore", "blank.bore_diameter_in = 0.9523"),
        ("large marks", "blank.mark_diameter_in = 0.1624"),
        ("play", "pair.backlash_in = 0.1235"),
        (
            "bolts within the teeth of a thin rim",
            (
                "blank.bolt_circle_in = [0, 4.272] and ring.rim_in = 0.2976 "
                "and blank.timing_marks = false"
            ),
        ),
    ],
)
def test_remedies_are_round_in_inches(name: str, text: str, tmp_path: Path) -> None:
    in_inches(DESIGNS[name], tmp_path / "d.toml")
    found = gearcam.remedies(gearcam.build(gearcam.load(tmp_path / "d.toml"))).found
    assert text in [one.text for one in found]


def test_remedies_keep_the_class_of_a_size(tmp_path: Path) -> None:
    document = in_inches(DESIGNS["bore"], tmp_path / "d.toml")
    document["blank"]["bore_diameter_in"] = "1.5 H7"
    found = gearcam.remedies(gearcam.build(gearcam.design(document))).found
    assert [one.text for one in found] == ['blank.bore_diameter_in = "0.9523 H7"']


def test_findings_are_told_in_inches(
    tmp_path: Path, capsys: pytest.CaptureFixture[str], monkeypatch: pytest.MonkeyPatch
) -> None:
    monkeypatch.chdir(tmp_path)
    in_inches(DESIGNS["undercut cam"], tmp_path / "d.toml")
    assert main(["check", "d.toml"]) == 1
    printed = capsys.readouterr().out
    assert "With cam.prime_radius_in = 2.0759715 it keeps all limits" in " ".join(printed.split())
    assert "at most 0.0003937 in" in printed


@pytest.mark.parametrize("units", ["mm", "inch"])
def test_changes_of_a_whole_list_can_be_copied_as_one(units: str) -> None:
    pair = gearcam.load(PROFILES / "inch_pair.toml").with_({"output.files": ["inspection"]})
    wide = pair.with_({"output.pin_diameter_in": 0.9}).with_({"units": units})
    (remedy, *_) = gearcam.remedies(gearcam.build(wide)).found
    (key, value), *others = tomllib.loads(f"{remedy.text}").get("output", {}).items()
    assert not others
    assert key == ("pin_diameter_in" if units == "inch" else "pin_diameter_mm")
    assert len(value) == 2
    assert remedy.design == wide.with_(remedy.changes)


def test_measuring_pins_have_simple_sizes_in_inches() -> None:
    design = gearcam.load(PROFILES / "inch_pair.toml").with_({"output.files": ["inspection"]})
    for pitch, size in ((7, 0.25), (12, 5 / 32), (24, 5 / 64)):
        result = gearcam.build(design.with_({"pair.diametral_pitch": pitch}))
        found = result.files("inspection")["measures.csv"].decode().splitlines()
        column = found[0].split(",").index("pin_diameter_in")
        assert {row.split(",")[column] for row in found[1:]} == {repr(size)}
        assert not [one for one in result.findings if one.code == "measuring-pin"]
