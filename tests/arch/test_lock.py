"""The lock holds what pyproject.toml asks for, by hashes, and the Makefile takes what it needs."""

from __future__ import annotations

import re
import tomllib
from collections.abc import Iterator
from typing import Any, NamedTuple

import pytest
from packaging.requirements import Requirement
from packaging.utils import canonicalize_name
from packaging.version import Version

from arch import rules

LOCK = (rules.ROOT / "requirements.lock").read_text(encoding="utf-8")
MAKEFILE = (rules.ROOT / "Makefile").read_text(encoding="utf-8")
PROJECT: dict[str, Any] = tomllib.loads((rules.ROOT / "pyproject.toml").read_text("utf-8"))
WANTED: dict[str, list[str]] = {
    "run": PROJECT["project"]["dependencies"],
    **PROJECT["project"]["optional-dependencies"],
    **PROJECT["dependency-groups"],
}
"""What is asked for, by the section that holds it."""


class Locked(NamedTuple):
    """A package as locked."""

    pin: Requirement
    hashes: list[str]

    @property
    def version(self) -> Version:
        (only,) = self.pin.specifier
        assert only.operator == "=="
        return Version(only.version)


def sections(lock: str) -> dict[str, list[Locked]]:
    """The packages of each section."""
    parts = re.split(r"^# for (\w+)\n", lock, flags=re.MULTILINE)
    return {
        name: [read(entry) for entry in re.split(r"\n(?=\w)", text.strip()) if entry]
        for name, text in zip(parts[1::2], parts[2::2], strict=True)
    }


def read(entry: str) -> Locked:
    """A pin, and its hashes on lines of their own."""
    first, *hashes = entry.split(" \\\n    --hash=")
    return Locked(Requirement(first), hashes)


def taken(target: str) -> list[str]:
    """The sections that the environment of a target takes, as the Makefile says."""
    named = dict(re.findall(r"^(RUN|TEST)\s*:= (.+)$", MAKEFILE, re.MULTILINE))
    (call,) = re.findall(
        rf"^\$\(VENV\)/\.{target}:.*\n\t\$\(call locked,(.+)\)$", MAKEFILE, re.MULTILINE
    )
    while "$(" in call:
        call = re.sub(r"\$\((\w+)\)", lambda found: named[found[1]], call)
    return call.split()


def unmet(wanted: list[str], locked: list[Locked]) -> Iterator[str]:
    """What is asked for and not locked at an allowed version."""
    versions = {canonicalize_name(one.pin.name): one.version for one in locked}
    for line in wanted:
        requirement = Requirement(line)
        version = versions.get(canonicalize_name(requirement.name))
        if version is None or version not in requirement.specifier:
            yield f"{line}: {version}"


def test_make_help_lists_each_target_in_one_line() -> None:
    head = MAKEFILE.partition("\n\n")[0]
    listed = re.findall(r"^# make (\w+)  +\S", head, re.MULTILINE)
    (targets,) = re.findall(r"^\.PHONY: (.+)$", MAKEFILE, re.MULTILINE)
    assert sorted(listed) == sorted(targets.split())


SECTIONS = sections(LOCK)


@pytest.mark.parametrize("name", list(WANTED))
def test_what_is_asked_for_is_locked(name: str) -> None:
    before = list(SECTIONS)[: list(SECTIONS).index(name) + 1]
    locked = [package for section in before for package in SECTIONS[section]]
    assert list(unmet(WANTED[name], locked)) == []


def test_what_builds_gearcam_is_locked() -> None:
    assert set(PROJECT["build-system"]["requires"]) <= set(WANTED["install"])


def test_the_lowest_versions_are_the_bounds() -> None:
    locked = {one.pin.name: one.version for one in SECTIONS["lowest"]}
    extras = ("run", "step", "plot", "sweep", "optimize", "stress", "dynamics")
    asked = [Requirement(line) for name in extras for line in WANTED[name]]
    for requirement in asked:
        (bound,) = [one.version for one in requirement.specifier if one.operator == ">="]
        assert locked[requirement.name] == Version(bound), requirement
    assert list(unmet(WANTED["install"] + WANTED["test"], SECTIONS["lowest"])) == []


def test_every_package_has_hashes_and_comes_from_nowhere_in_particular() -> None:
    for package in (one for packages in SECTIONS.values() for one in packages):
        assert package.hashes, package.pin
        assert all(re.fullmatch(r"sha256:[0-9a-f]{64}", one) for one in package.hashes), package.pin
        assert package.pin.url is None
    assert "://" not in LOCK
    assert re.findall(r"^-.*", LOCK, re.MULTILINE) == []


def test_each_package_has_one_version_on_every_machine() -> None:
    locked = [one for name, packages in SECTIONS.items() if name != "lowest" for one in packages]
    assert len({one.pin.name for one in locked}) == len(locked)


def test_each_target_takes_its_sections_and_no_other() -> None:
    assert taken("run") == ["run", "install"]
    assert taken("test") == [
        "run",
        "install",
        "step",
        "plot",
        "sweep",
        "optimize",
        "stress",
        "dynamics",
        "test",
    ]
    assert taken("lint") == [*taken("test"), "lint"]
    assert taken("bench") == [*taken("test"), "bench"]
    assert taken("docs") == [*taken("test"), "docs"]
    assert taken("lock") == ["lock"]
    ends = ("lint", "bench", "docs", "lock")
    assert set(SECTIONS) == {"lowest"}.union(*map(taken, ends))


def test_types_are_checked_for_the_oldest_python() -> None:
    oldest = PROJECT["project"]["requires-python"]
    assert oldest == f">={PROJECT['tool']['pyright']['pythonVersion']}"
    supported = re.findall(
        r'^supported="(.+)"', (rules.ROOT / "tools/matrix").read_text(), re.MULTILINE
    )
    assert supported[0].split()[0] == oldest.removeprefix(">=")


@pytest.mark.parametrize(
    ("wanted", "found"),
    [
        ("numpy>=2.0", []),
        ("numpy>=99", ["numpy>=99: 2.4"]),
        ("nothing>=1", ["nothing>=1: None"]),
        ("NumPy[some]>=2,<2.1", ["NumPy[some]>=2,<2.1: 2.4"]),
    ],
)
def test_what_is_not_locked_is_seen(wanted: str, found: list[str]) -> None:
    locked = sections("# for run\nnumpy==2.4 \\\n    --hash=sha256:00\n")["run"]
    assert list(unmet([wanted], locked)) == found
