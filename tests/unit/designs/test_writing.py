"""Designs written as TOML: read again they are the same, and nothing can be left out."""

from __future__ import annotations

import tomllib
from dataclasses import replace
from pathlib import Path

import pytest

import gearcam
from gearcam.base.errors import DesignError
from gearcam.designs.writing import least_document, toml_text
from helpers_pairs import PROFILES
from helpers_sampling import few

FILES = ["conjugate_cams", "plate_cam_offset_roller", "ellipse", "groove_cam"]


@pytest.mark.parametrize("name", few(FILES))
def test_a_written_design_is_the_same(name: str) -> None:
    design = gearcam.load(PROFILES / f"{name}.toml")
    text = toml_text(least_document(design), ["a comment"])
    assert text.startswith("# a comment\n")
    assert gearcam.design(tomllib.loads(text)) == design


def test_no_key_is_written_that_need_not_be() -> None:
    design = gearcam.load(PROFILES / "plate_cam_offset_roller.toml")
    document = least_document(design)
    for title in ("follower", "cam", "output"):
        for key in document[title]:
            left = {name: value for name, value in document[title].items() if name != key}
            try:
                assert gearcam.design({**document, title: left}) != design
            except DesignError:
                continue
    assert {"kind", "name", "motion", "follower", "cam", "output"} == set(document)


def test_texts_and_numbers_are_written_as_toml_has_them() -> None:
    document = {"a": 'x "y" \\ ü', "b": 1e-7, "c": True, "t": {"d": [1.5, 2]}, "m": [{"e": 90.0}]}
    assert tomllib.loads(toml_text(document)) == document


def test_a_name_with_signs_is_kept() -> None:
    design = replace(gearcam.load(PROFILES / "ellipse.toml"), name="a-b_c")
    assert gearcam.loads(toml_text(least_document(design))).name == "a-b_c"


def test_files_are_named_from_the_root(tmp_path: Path, monkeypatch: pytest.MonkeyPatch) -> None:
    monkeypatch.chdir(PROFILES)
    design = gearcam.load("measured_cam.toml")
    (tmp_path / "saved.toml").write_text(toml_text(least_document(design)))
    monkeypatch.chdir(tmp_path)
    assert gearcam.load("saved.toml") == gearcam.load(PROFILES / "measured_cam.toml")
