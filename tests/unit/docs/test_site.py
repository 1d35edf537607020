"""The home page of the docs leads to what it shows, and formulas of the theory are set as such."""

from __future__ import annotations

import importlib.util
import re
from types import ModuleType
from typing import Any

import pytest

import gearcam
from arch import rules

DOCS = rules.ROOT / "docs"
INDEX = (DOCS / "index.md").read_text("utf-8")
LARGEST = 60_000
"""Bytes of a picture."""


@pytest.fixture(scope="module")
def conf() -> ModuleType:
    spec = importlib.util.spec_from_file_location("conf", DOCS / "conf.py")
    assert spec
    assert spec.loader
    module = importlib.util.module_from_spec(spec)
    spec.loader.exec_module(module)
    return module


def test_each_picture_leads_to_the_file_that_made_it(conf: ModuleType) -> None:
    names = conf.examples()
    assert len(names) == len(set(names)) == INDEX.count("](pictures/home/") >= 9
    for name in names:
        assert f"](pictures/home/{name}.png)](../profiles/{name}.toml)" in INDEX
        gearcam.load(rules.ROOT / "profiles" / f"{name}.toml")
        picture = (DOCS / "pictures" / "home" / f"{name}.png").read_bytes()
        assert picture.startswith(b"\x89PNG")
        assert len(picture) < LARGEST
    kept = {one.stem for one in (DOCS / "pictures" / "home").iterdir()}
    assert kept == set(names)


def test_each_kind_of_design_is_shown(conf: ModuleType) -> None:
    shown = {gearcam.load(rules.ROOT / "profiles" / f"{one}.toml").kind for one in conf.examples()}
    assert {"gear-pair", "cam", "spatial-cam", "globoidal-cam", "mechanism"} <= shown


def test_links_of_the_site_lead_to_what_is_written(
    conf: ModuleType, tmp_path: Any, monkeypatch: pytest.MonkeyPatch
) -> None:
    wanted = re.findall(r'href="([^"]+)"', conf.cards(INDEX))
    folder = {f"{conf.EXAMPLES}/{one}.{end}" for one in conf.examples() for end in ("html", "toml")}
    assert set(wanted) == folder
    monkeypatch.setattr(conf, "examples", lambda: ["four_bar"])
    conf.write_examples(tmp_path / conf.EXAMPLES)
    assert {one.name for one in (tmp_path / conf.EXAMPLES).iterdir()} == {
        "four_bar.html",
        "four_bar.toml",
    }
    assert b"Parts in motion" in (tmp_path / conf.EXAMPLES / "four_bar.html").read_bytes()


def test_formulas_of_the_theory_are_set() -> None:
    """What is in backticks is typed into files; signs and lines of code are no formulas."""
    text = (DOCS / "theory.md").read_text("utf-8")
    assert not re.findall(r"^    \S.*$", text, re.MULTILINE)
    typed = re.findall(r"`([^`]+)`", text)
    assert not [one for one in typed if re.search(r"[-+*/^]", one.replace("log-spiral", ""))]
    assert text.count("$$") % 2 == 0
    assert len(re.findall(r"\$\$.+?\$\$", text, re.DOTALL)) >= 6
    inline = re.findall(r"\$([^$]+)\$", text.replace("$$", ""))
    assert len(inline) > 80
    assert all(one.count("{") == one.count("}") for one in inline)
