"""The page for coding assistants is of this version, and its examples do what they show."""

from __future__ import annotations

import contextlib
import io
import re
from collections.abc import Iterator
from pathlib import Path

import pytest

from gearcam.cli import main
from gearcam.commands import EXIT_CODES
from gearcam.laws.motion import MOTION_LAWS
from gearcam.laws.ratio import LAWS
from gearcam.results.kind import KINDS
from gearcam.version import __version__

BLOCK = re.compile(r"^```(toml|console|python)\n(.*?)^```$", re.DOTALL | re.MULTILINE)


@pytest.fixture(scope="module")
def page() -> str:
    printed = io.StringIO()
    with contextlib.redirect_stdout(printed):
        assert main(["skill"]) == 0
    return printed.getvalue()


def steady(text: str) -> str:
    """Without times and sizes of files, which differ from run to run."""
    return re.sub(r"in [\d.]+ s$| +[\d.]+ k?B$", "#", text, flags=re.MULTILINE)


def told(words: list[str]) -> tuple[int, str]:
    printed = io.StringIO()
    with contextlib.redirect_stdout(printed), contextlib.redirect_stderr(printed):
        code = main(words)
    return code, printed.getvalue()


def examples(text: str) -> Iterator[tuple[str, str]]:
    return ((found[1], found[2]) for found in BLOCK.finditer(text))


def test_its_examples_do_what_they_show(
    page: str, tmp_path: Path, monkeypatch: pytest.MonkeyPatch
) -> None:
    monkeypatch.chdir(tmp_path)
    codes = []
    for kind, text in examples(page):
        if kind == "toml":
            name = text.partition("\n")[0].removeprefix("# ")
            (tmp_path / name).write_text(text, encoding="utf-8")
        elif kind == "console":
            command, _, shown = text.partition("\n")
            code, answer = told(command.split()[2:])
            assert steady(answer) == steady(shown)
            codes.append(code)
        else:
            printed = io.StringIO()
            with contextlib.redirect_stdout(printed):
                exec(compile(text, "skill.md", "exec"), {})
            assert "ratio i21" in printed.getvalue()
            assert list((tmp_path / "output" / "quick_return").glob("*.dxf"))
    assert codes == [0, 0, 2, 3, 0]
    assert page.count("\n## Example ") == 3


def test_it_is_of_this_version_and_knows_all_there_is(page: str) -> None:
    assert f"\nversion: {__version__}\n" in page
    assert f"# gearcam {__version__}\n" in page
    assert page.startswith("---\nname: gearcam\ndescription: ")
    assert "@@" not in page
    for name in (*KINDS, *LAWS, *MOTION_LAWS):
        assert f"`{name}`" in page
    for code, meaning in EXIT_CODES.items():
        assert f"| {code} | {meaning} |" in page
    for name in ("build", "sweep", "mesh", "stress", "torque"):
        assert f"- `gearcam {name}`: " in page


def test_it_is_written_into_a_new_file_only(tmp_path: Path, page: str) -> None:
    file = tmp_path / "SKILL.md"
    assert told(["skill", str(file)])[0] == 0
    assert file.read_text(encoding="utf-8").rstrip("\n") == page.rstrip("\n")
    file.write_text("mine", encoding="utf-8")
    assert told(["skill", str(file)])[0] == 2
    assert file.read_text(encoding="utf-8") == "mine"
