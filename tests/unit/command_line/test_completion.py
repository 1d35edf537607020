"""Completion in shells: every command, option and word of the parsers, offered where it belongs."""

from __future__ import annotations

import argparse
import shutil
import subprocess
from collections.abc import Iterator
from pathlib import Path

import pytest

from gearcam.cli import main, parsers
from gearcam.completion import SHELLS, script
from gearcam.results.kind import KINDS

BASH = shutil.which("bash")


@pytest.fixture(scope="module")
def every() -> list[argparse.ArgumentParser]:
    return list(parsers())


def options(parser: argparse.ArgumentParser) -> Iterator[str]:
    return (name for one in parser._actions for name in one.option_strings)


def section(text: str, shell: str, command: str) -> str:
    """What a script says of the options of a command."""
    lines = text.splitlines()
    if shell == "fish":
        start = f"complete -c gearcam -n '__fish_seen_subcommand_from {command}'"
        return "\n".join(line for line in lines if line.startswith(start))
    if shell == "bash":
        return "\n".join(
            line for line in lines if line.startswith(f"            {command}) words=")
        )
    first = lines.index(f"    {command})")
    return "\n".join(lines[first : lines.index("      ;;", first)])


@pytest.mark.parametrize("shell", SHELLS)
def test_every_option_of_every_command_is_offered(
    shell: str, every: list[argparse.ArgumentParser]
) -> None:
    text = script(shell, every)
    for parser in every:
        command = parser.prog.split()[1]
        said = section(text, shell, command)
        for name in options(parser):
            word = name
            if shell == "fish":
                word = f"-l {name[2:]}" if name.startswith("--") else f"-s {name[1:]}"
            assert word in said, (command, name)
        assert command in text


def bash_offers(text: str, folder: Path, *words: str) -> list[str]:
    assert BASH
    asked = (
        '; COMP_WORDS=("$@"); COMP_CWORD=$(($# - 1)); _gearcam; printf "%s\\n" "${COMPREPLY[@]}"'
    )
    (folder / "script.sh").write_text(text, encoding="utf-8")
    command = [BASH, "--norc", "-c", f". ./script.sh{asked}", "bash", *words]
    done = subprocess.run(command, cwd=folder, capture_output=True, text=True, check=True)
    assert done.stderr == ""
    return [line for line in done.stdout.splitlines() if line]


@pytest.mark.skipif(BASH is None, reason="there is no bash")
def test_bash_offers_what_belongs(tmp_path: Path, every: list[argparse.ArgumentParser]) -> None:
    text = script("bash", every)
    (tmp_path / "two words.toml").touch()
    (tmp_path / "table.csv").touch()
    (tmp_path / "folder").mkdir()

    def offers(*words: str) -> list[str]:
        return bash_offers(text, tmp_path, "gearcam", *words)

    assert offers("bu") == ["build"]
    assert {"--version", "--help"} == {*offers("--")}
    assert offers("build", "") == ["two words.toml", "folder"]
    assert offers("build", "two") == ["two words.toml"]
    assert offers("build", "--o") == ["--output", "--only"]
    assert offers("build", "--only", "st") == ["stl", "step"]
    assert offers("build", "-o", "") == ["folder"]
    assert offers("sweep", "--seed", "") == []  # a number
    assert offers("new", "") == list(KINDS)
    assert offers("new", "cam", "") == ["two words.toml", "folder"]
    assert offers("completion", "z") == ["zsh"]
    assert "radau" in offers("dynamics", "--method", "")


@pytest.mark.parametrize("shell", ["zsh", "fish"])
def test_the_shells_themselves_can_read_their_scripts(
    shell: str, every: list[argparse.ArgumentParser], tmp_path: Path
) -> None:
    """Where they are installed; elsewhere quotes are counted."""
    text = script(shell, every)
    program = shutil.which(shell)
    if program:
        (tmp_path / "script").write_text(text, encoding="utf-8")
        done = subprocess.run(
            [program, "-n", str(tmp_path / "script")], capture_output=True, text=True, check=False
        )
        assert (done.returncode, done.stderr) == (0, "")
    plain = text.replace("\\\\", "").replace("\\'", "")
    assert all(line.count("'") % 2 == 0 for line in plain.splitlines())


def test_the_command_prints_the_script(
    capsys: pytest.CaptureFixture[str], every: list[argparse.ArgumentParser]
) -> None:
    assert main(["completion", "bash"]) == 0
    assert capsys.readouterr().out.rstrip("\n") == script("bash", every)
    assert main(["completion", "tcsh"]) == 2
    assert "'bash', 'zsh', 'fish'" in capsys.readouterr().err.replace('"', "'")
