"""Each study says what it returns, in help and docs, with an example that does what it shows."""

from __future__ import annotations

import doctest
from pathlib import Path

import pytest

import gearcam as gc
from arch import rules
from gearcam.base.kinds import kind_names, kind_studies
from gearcam.results.studies import Study

STUDIES = {
    f"{kind} {study.name}": study
    for kind in kind_names()
    for study in kind_studies(kind).own.values()
}
DEAR = ("gear-pair stress", "gear-pair dynamics", "mechanism dynamics")
"""Studies that take more than a second."""


@pytest.fixture(autouse=True)
def folder(tmp_path: Path, monkeypatch: pytest.MonkeyPatch) -> None:
    """An empty folder with the profiles beside it."""
    (tmp_path / "profiles").symlink_to(rules.ROOT / "profiles")
    monkeypatch.chdir(tmp_path)


@pytest.mark.parametrize(
    "name",
    [pytest.param(one, marks=pytest.mark.slow if one in DEAR else ()) for one in STUDIES],
)
def test_an_example_does_what_it_shows(name: str) -> None:
    study = STUDIES[name]
    assert study.returns.endswith(".")
    assert f'study("{study.name}")' in study.example
    example = doctest.DocTestParser().get_doctest(study.example, {}, name, None, None)
    told: list[str] = []
    doctest.DocTestRunner(verbose=False).run(example, out=told.append)
    assert told == []


@pytest.mark.parametrize("name", STUDIES)
def test_the_help_of_results_tells_of_their_studies(name: str) -> None:
    kind, _, word = name.partition(" ")
    results = {
        "cam": gc.CamResult,
        "gear-pair": gc.GearPairResult,
        "globoidal-cam": gc.GloboidalCamResult,
        "mechanism": gc.MechanismResult,
        "spatial-cam": gc.SpatialCamResult,
    }[kind]
    text = results.study.__doc__ or ""
    assert f"\n{word}: " in text
    assert STUDIES[name].example.splitlines()[-1] in text
    assert f"[{STUDIES[name].table}]" in text
    assert "jobs : int" in text


def test_a_study_without_words_has_a_help_too() -> None:
    study = Study(
        name="plain", key="plain", doc="Does it.", done="done", table="plain", compute=print
    )
    assert study.help.startswith("plain: Does it.")
