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

import numpy as np
import pytest

import gearcam
import picture
from gearcam.cli import main
from gearcam.designs import KINDS, document_of, loads
from gearcam.findings import CHECKS
from gearcam.kinds.cam.motion import rise_table
from gearcam.kinds.gear_pair.design import GearPairDesign, law_table
from gearcam.laws.ratio.base import LAWS
from gearcam.laws.rises.base import RISES
from gearcam.parts.mass import mass_properties
from gearcam.quantities import Param

ROOT = Path(__file__).parents[2]
README = (ROOT / "README.md").read_text(encoding="utf-8")
PAGES = [
    ROOT / "README.md",
    ROOT / "CHANGELOG.md",
    *sorted((ROOT / "docs").glob("*.md")),
    *sorted((ROOT / "benchmarks" / "results").glob("*.md")),
]
PROFILE = ROOT / "profiles" / "nail_machine_two_phase.toml"
WRITTEN_LATER = {"benchmarks/results/performance.md"}


def block(language: str, number: int = 0) -> str:
    """A code block of the README by its language: the first one, or another."""
    found = re.findall(rf"^```{language}\n(.*?)^```$", README, re.DOTALL | re.MULTILINE)
    return found[number]


def section(title: str) -> str:
    return README.partition(f"\n## {title}\n")[2].partition("\n## ")[0]


def rows(text: str) -> list[list[str]]:
    """Cells of a section's tables, without heads."""
    lines = [line for line in text.splitlines() if line.startswith("|")]
    cells = [[cell.strip() for cell in line.strip("|").split("|")] for line in lines]
    rules = [k for k, row in enumerate(cells) if set("".join(row)) <= set("-:")]
    heads = {k - 1 for k in rules} | set(rules)
    return [row for k, row in enumerate(cells) if k not in heads]


def quoted(text: str) -> list[str]:
    return re.findall(r"`([^`]+)`", text)


def dead_links(page: Path, text: str) -> list[str]:
    """Relative links and pictures that lead nowhere."""
    targets = re.findall(r"\]\(([^)\s]+)\)", text)
    local = [target.partition("#")[0] for target in targets if "://" not in target]
    return [target for target in local if target and not (page.parent / target).exists()]


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
    assert math.ulp(2.0 * math.pi) < accuracy["law"] < 2e-14
    assert math.ulp(100.0) < accuracy["flank_mm"] < 1e-11
    assert 0 < max(accuracy["chord_mm"], *accuracy["dxf_mm"].values()) < 1e-3


def test_the_example_is_about_ten_lines() -> None:
    assert 8 <= len(block("python").strip().splitlines()) <= 14


def test_the_law_by_a_function_prints_what_is_shown() -> None:
    """The centre distance is ``module*pi*z`` over the length of the centrode for distance 1."""
    stream = io.StringIO()
    with contextlib.redirect_stdout(stream):
        exec(compile(block("python", 1), "README.md", "exec"), {})
    assert stream.getvalue() == block("text", 1)
    phi, weights = np.polynomial.legendre.leggauss(200)
    phi = math.pi * (1.0 + phi)
    ratio, slope = 1.0 - 0.3 * np.cos(phi), 0.3 * np.sin(phi)
    length = math.pi * weights @ (np.hypot(ratio, slope / (1.0 + ratio)) / (1.0 + ratio))
    shown = float(block("text", 1).split()[2])
    assert shown == pytest.approx(2.0 * math.pi * 40 / length, abs=5e-7)


def test_the_design_file_shown_is_the_profile() -> None:
    shown = tomllib.loads(block("toml"))
    assert shown == tomllib.loads(PROFILE.read_text(encoding="utf-8"))
    assert loads(block("toml")).name == "nail_machine_two_phase"


def test_the_cam_shown_is_the_profile() -> None:
    profile = gearcam.load(ROOT / "profiles" / "plate_cam_offset_roller.toml")
    assert document_of(loads(block("toml", 1))) == document_of(profile)


def test_the_blank_shown_is_one_that_can_be_made() -> None:
    text = block("toml").replace("[blank]\nbore_diameter_mm = [40, 40]\n", block("toml", 2))
    assert text != block("toml")
    design = loads(text)
    assert isinstance(design, GearPairDesign)
    job = gearcam.build(design)
    heavy, light = (mass_properties(part, 7850.0).mass for part in job.parts)
    assert 0.0 < heavy < light  # the driver has holes
    assert not [finding for finding in job.findings if finding.severity == "error"]


@pytest.mark.parametrize("page", PAGES, ids=lambda page: page.name)
def test_links_lead_somewhere(page: Path) -> None:
    assert dead_links(page, page.read_text(encoding="utf-8")) == []


def test_a_dead_link_is_seen() -> None:
    assert dead_links(PAGES[0], "[x](docs/conventions.md#units) [y](docs/none.md)") == [
        "docs/none.md"
    ]


def test_files_named_are_there() -> None:
    for page in PAGES:
        named = r"`((?:docs|benchmarks|tests|profiles|laws|gears|kinds|designs)/[\w./]+)`"
        names = re.findall(named, page.read_text("utf-8"))
        for name in set(names) - WRITTEN_LATER:
            assert any((base / name).exists() for base in (ROOT, ROOT / "src" / "gearcam")), name


def test_the_laws_are_those_of_the_registry() -> None:
    law_rows = rows(section("Laws"))
    assert {quoted(row[0])[0] for row in law_rows} == set(LAWS)
    for row in law_rows:
        name = quoted(row[0])[0]
        assert set(law_table(name).entries) <= set(quoted(row[1]))
        assert row[2] == LAWS[name].continuity
    (status,) = [row for row in rows(section("Status")) if row[0].startswith("laws ")]
    assert set(quoted(status[0])) == set(LAWS)
    assert status[1] == "works"


def test_the_rises_are_those_of_the_registry() -> None:
    shown = {name: row for row in rows(section("Cams")) for name in quoted(row[0])}
    assert set(shown) == set(RISES)
    for name, row in shown.items():
        assert set(rise_table(name).entries) <= set(quoted(row[1])), name


@pytest.mark.parametrize("name", list(KINDS))
def test_the_checks_are_those_of_the_registry(name: str) -> None:
    KINDS[name].load_checks()
    checks = {check.code: check for check in CHECKS.values() if check.kind in KINDS[name].checks}
    pairs, _, cams = section("Checks").partition("\nAnd of cams:\n")
    told = {"gear-pair": pairs, "cam": cams}[name]
    shown = {code: row[2] for row in rows(told) for code in quoted(row[0])}
    assert set(shown) == set(checks)
    for code, check in checks.items():
        if shown[code] == "as above":
            above = [other.limit for (_, known), other in CHECKS.items() if known == code]
            assert set(above) == {check.limit}
        else:
            assert_limit(shown[code], check.limit)


def assert_limit(shown: str, limit: tuple[str, Param, float] | None) -> None:
    if limit is None:
        assert shown == "none"
        return
    name, made, default = limit
    key, value = re.fullmatch(r"`(\w+)` = ([\d.e-]+)(?: .+)?", shown).groups()  # type: ignore[union-attr]
    assert key == made.key(name)
    if math.isnan(default):  # the design decides, and the check's own words say how
        assert shown.partition(" = ")[2] in made.doc
    else:
        assert float(value) * made.quantity.factor == pytest.approx(default, rel=1e-12)


def test_severities_are_as_they_come(example: Run) -> None:
    shown = {quoted(row[0])[0]: row[1] for row in rows(section("Checks"))}
    found = example.names["result"].findings
    assert {finding.severity for finding in found} == {"warning", "note"}
    for finding in found:
        assert finding.severity in shown[finding.code].split(", or ")


def test_every_kind_of_file_is_described() -> None:
    shown = {name for row in rows(section("Files")) for name in quoted(row[0])}
    assert shown == set(KINDS["gear-pair"].formats)


def test_every_command_and_option_is_named(capsys: pytest.CaptureFixture[str]) -> None:
    main(["--help"])
    listed = capsys.readouterr().out.partition("commands:\n")[2].partition("\n\n")[0]
    commands = [line.split()[0] for line in listed.splitlines()]
    assert {"build", "check", "laws", "new", "schema"} <= set(commands)
    start = section("Start")
    for command in commands:
        assert f"`gearcam {command}" in start
        main([command, "--help"])
        options = set(re.findall(r"--[a-z]+", capsys.readouterr().out)) - {"--help", "--output"}
        assert options <= set(re.findall(r"--[a-z]+", start)), command


def test_the_makefile_has_the_targets() -> None:
    makefile = (ROOT / "Makefile").read_text(encoding="utf-8")
    named = {
        name
        for page in PAGES
        for name in re.findall(r"make (\w+)  |`make (\w+)`", page.read_text("utf-8"))
    }
    targets = {first or second for first, second in named}
    (phony,) = re.findall(r"^\.PHONY: (.+)$", makefile, re.MULTILINE)
    assert set(phony.split()) == targets
    for target in targets:
        assert re.search(rf"^{target}:", makefile, re.MULTILINE), target
        assert re.search(rf"make {target}\b", section("Start")), target


def test_the_picture_is_that_of_the_tool() -> None:
    data = picture.PICTURE.read_bytes()
    assert f"]({picture.PICTURE.relative_to(ROOT)})" in README.partition("\n\n")[2]
    assert data[:8] == b"\x89PNG\r\n\x1a\n"
    assert struct.unpack(">II", data[16:24]) == picture.SIZE
    assert picture.PROFILE == PROFILE
    assert "report" in gearcam.load(PROFILE).output.files
