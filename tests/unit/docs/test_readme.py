"""What the README and docs/ say is true: the example runs, links lead on, tables are whole."""

from __future__ import annotations

import contextlib
import io
import math
import re
import struct
import tomllib
from pathlib import Path
from typing import Any, NamedTuple

import pytest

import gearcam
import picture
from arch import rules
from gearcam.designs import document_of, loads
from gearcam.kinds.gear_pair.design import GearPairDesign
from gearcam.parts.mass import mass_properties

ROOT = rules.ROOT
README = (ROOT / "README.md").read_text(encoding="utf-8")
PAGES = [
    *sorted(ROOT.glob("*.md")),
    *sorted((ROOT / "docs").rglob("*.md")),
    *sorted((ROOT / "benchmarks" / "results").glob("*.md")),
]
PROFILE = ROOT / "profiles" / "nail_machine_two_phase.toml"
WRITTEN_LATER = {
    "tests/claims/laws/joint.py",
    "tests/claims/motion/double.py",
    "benchmarks/results/performance.md",
}


def block(language: str, number: int = 0) -> str:
    """A code block of the README by its language: the first one, or another."""
    found = re.findall(rf"^```{language}\n(.*?)^```$", README, re.DOTALL | re.MULTILINE)
    return found[number]


def anchors(text: str) -> set[str]:
    """What a git host calls the headings of a page: in small letters, spaces as hyphens."""
    found: list[str] = []
    plain = re.sub(r"^```.*?^```$", "", text, flags=re.DOTALL | re.MULTILINE)
    for title in re.findall(r"^#+ (.+)$", plain, re.MULTILINE):
        words = re.sub(r"\]\([^)]*\)|[^\w\- ]", "", title.strip()).lower().replace(" ", "-")
        count = sum(re.fullmatch(rf"{re.escape(words)}(-\d+)?", one) is not None for one in found)
        found.append(f"{words}-{count}" if count else words)
    return set(found)


def dead_links(page: Path, text: str) -> list[str]:
    """Relative links and pictures that lead nowhere, and anchors that are not on their page."""
    dead = []
    for link in re.findall(r"\]\(([^)\s]+)\)", text):
        target, _, anchor = link.partition("#")
        there = page.parent / target if target else page
        if "://" in link or (there.exists() and not anchor):
            continue
        known = text if not target else there.read_text("utf-8") if there.is_file() else ""
        if anchor not in anchors(known):
            dead.append(link)
    return dead


class Run(NamedTuple):
    """What the Python example printed, left behind as names, and wrote."""

    printed: str
    names: dict[str, Any]
    folder: Path


@pytest.fixture(scope="module")
def example(tmp_path_factory: pytest.TempPathFactory) -> Run:
    """Run the example as printed, in an empty folder from which the profiles can be reached."""
    place = tmp_path_factory.mktemp("reader")
    (place / "profiles").symlink_to(ROOT / "profiles")
    stream, names = io.StringIO(), {}
    with contextlib.chdir(place), contextlib.redirect_stdout(stream):
        exec(compile(block("python"), "README.md", "exec"), names)
    return Run(stream.getvalue(), names, place / "output" / "nail_machine_two_phase")


def test_the_python_example_prints_what_is_shown(example: Run) -> None:
    assert example.printed == block("text")
    names = example.printed.splitlines()[-1].split(", ")
    assert "gear1.dxf" in names
    assert all((example.folder / name).stat().st_size > 1000 for name in names)


def test_the_module_shown_is_the_length_over_the_teeth() -> None:
    """L = 556.7768355399 mm, from the law in high precision."""
    module = float(block("text").split()[1])
    assert module == pytest.approx(556.7768355399 / (36 * math.pi), abs=5e-7)


def test_the_accuracy_is_as_told(example: Run) -> None:
    accuracy = example.names["written"].summary["accuracy"]
    assert math.ulp(2.0 * math.pi) < accuracy["driven_angle_rad"] < 2e-14
    assert math.ulp(100.0) < accuracy["flank_mm"] < 1e-11
    assert 0 < max(accuracy["chord_mm"], *accuracy["dxf_mm"].values()) < 1e-3


def test_the_example_is_about_ten_lines() -> None:
    assert 8 <= len(block("python").strip().splitlines()) <= 14


def test_the_design_file_shown_is_the_profile() -> None:
    shown = tomllib.loads(block("toml"))
    assert shown == tomllib.loads(PROFILE.read_text(encoding="utf-8"))
    assert loads(block("toml")).name == "nail_machine_two_phase"


def test_the_cam_shown_is_the_profile() -> None:
    profile = gearcam.load(ROOT / "profiles" / "plate_cam_offset_roller.toml")
    assert document_of(loads(block("toml", 1))) == document_of(profile)


def test_the_blank_shown_is_one_that_can_be_made() -> None:
    page = (ROOT / "docs" / "gear-pairs.md").read_text(encoding="utf-8")
    (blank,) = re.findall(r"^```toml\n(\[blank\]\n.*?)^```$", page, re.DOTALL | re.MULTILINE)
    text = block("toml").replace("[blank]\nbore_diameter_mm = [40, 40]\n", blank)
    assert text != block("toml")
    design = loads(text)
    assert isinstance(design, GearPairDesign)
    job = gearcam.build(design)
    heavy, light = (mass_properties(part, 7850.0).mass for part in job.parts)
    assert 0.0 < heavy < light  # the driver has holes
    assert not [finding for finding in job.findings if finding.severity == "error"]


def test_the_bar_shown_suits_the_rack_above_it() -> None:
    page = (ROOT / "docs" / "gear-pairs.md").read_text(encoding="utf-8")
    rack, bar = re.findall(
        r'^```toml\n(\[law\]\ntype = "rack".*?|\[bar\].*?)^```$', page, re.DOTALL | re.MULTILINE
    )
    job = gearcam.build(loads(f'kind = "gear-pair"\nname = "r"\n{rack}\n{bar}'))
    assert [one.name for one in job.parts[1].openings] == [f"bolt hole {k}" for k in (1, 2, 3, 4)]
    assert not [finding for finding in job.findings if finding.severity == "error"]


def test_the_drawing_shown_is_one_that_can_be_made() -> None:
    page = (ROOT / "docs" / "drawings.md").read_text(encoding="utf-8")
    (shown,) = re.findall(r"^```toml\n(.*?)^```$", page, re.DOTALL | re.MULTILINE)
    text = block("toml").partition("[output]")[0] + shown
    written = gearcam.build(loads(text)).sheets[0].words
    assert {"G-1024-1", "ISO 2768-mK", "2030-01-31"} <= {one.text for one in written}


def test_the_readme_is_short_and_in_order() -> None:
    assert len(README.encode()) <= 9000
    titles = re.findall(r"^## (.+)$", README, re.MULTILINE)
    assert titles == ["Start", "A pair of gears", "In Python", "A cam", "What works", "Read on"]


@pytest.mark.parametrize("page", PAGES, ids=lambda page: str(page.relative_to(ROOT)))
def test_links_lead_somewhere(page: Path) -> None:
    assert dead_links(page, page.read_text(encoding="utf-8")) == []


def test_a_dead_link_and_a_dead_anchor_are_seen() -> None:
    text = "[x](docs/conventions.md#units) [y](docs/none.md) [z](docs/conventions.md#none)"
    text += " [a](#here) [b](#there-1) [c](#there-2)"
    text += "\n# Here\n## There\n```\n## There\n```\n## `There`\n"
    dead = ["docs/none.md", "docs/conventions.md#none", "#there-2"]
    assert dead_links(ROOT / "README.md", text) == dead


def test_the_index_lists_every_page_once() -> None:
    """The menu of the site is made from it (docs/conf.py)."""
    text = (ROOT / "docs" / "index.md").read_text("utf-8")
    listed = re.findall(r"^- .*?\]\(([\w/-]+\.md)\)", text, re.MULTILINE)
    pages = {str(page.relative_to(ROOT / "docs")) for page in (ROOT / "docs").rglob("*.md")}
    assert sorted(listed) == sorted(pages - {"index.md"})


def test_files_named_are_there() -> None:
    for page in PAGES:
        named = r"`((?:docs|benchmarks|tests|profiles|laws|gears|kinds|designs)/[\w./]+)`"
        names = re.findall(named, page.read_text("utf-8"))
        for name in set(names) - WRITTEN_LATER:
            assert any((base / name).exists() for base in (ROOT, ROOT / "src" / "gearcam")), name


def test_targets_that_pages_name_are_those_of_the_makefile() -> None:
    makefile = (ROOT / "Makefile").read_text(encoding="utf-8")
    pages = [page.read_text("utf-8") for page in PAGES]
    named = {name for text in pages for name in re.findall(r"`make ([a-z]+)", text)}
    (phony,) = re.findall(r"^\.PHONY: (.+)$", makefile, re.MULTILINE)
    targets = set(re.findall(r"^(\w+):", makefile, re.MULTILINE))
    assert named <= set(phony.split()) <= targets


def test_the_picture_is_that_of_the_tool() -> None:
    data = picture.PICTURE.read_bytes()
    assert f"]({picture.PICTURE.relative_to(ROOT)})" in README.partition("\n\n")[2]
    assert data[:8] == b"\x89PNG\r\n\x1a\n"
    assert struct.unpack(">II", data[16:24]) == picture.SIZE
    assert picture.PROFILE == PROFILE
    assert "report" in gearcam.load(PROFILE).output.files
