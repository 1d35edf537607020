"""Whatever the disk or the terminal refuses: a message, exit code 2, all files old or all new."""

from __future__ import annotations

import errno
import json
import os
import pty
import subprocess
import sys
import tempfile
import threading
from collections.abc import Callable
from pathlib import Path
from typing import Any

import pytest

import gearcam
from gearcam.base.errors import WriteError
from gearcam.cli import main
from gearcam.console import visible
from gearcam.export import write
from gearcam.export.listing import listing, planned
from gearcam.export.write import rewrite, write_new, writing
from helpers_folder import put
from helpers_interrupts import PAIR, state
from helpers_processes import ENVIRONMENT
from helpers_sampling import few

GOOD = PAIR.format(eccentricity=0.2, bore=8, files='["csv"]')
NAMES = ("one.dxf", "two.dxf", "three.dxf")


def files_of(word: str, names: tuple[str, ...] = NAMES) -> dict[str, bytes]:
    """Files that all hold a word."""
    return {name: word.encode() for name in names}


def full(*_: object, **__: object) -> None:
    raise OSError(errno.ENOSPC, "No space left on device")


@pytest.mark.parametrize("existing", [True, False])
@pytest.mark.parametrize("after", range(5))
@pytest.mark.parametrize("cut", [True, False])
def test_a_disk_that_is_full_at_any_write(
    tmp_path: Path, monkeypatch: pytest.MonkeyPatch, after: int, existing: bool, cut: bool
) -> None:
    """Four files: each whole, or half of it, when the disk has no more room."""
    folder = tmp_path / "out" / "design"
    if existing:
        put(folder, files_of("old", (*NAMES, "stale.dxf")))
    before, real, calls = state(tmp_path), Path.write_bytes, list[Path]()

    def write(self: Path, content: bytes) -> int:
        calls.append(self)
        if len(calls) == after + 1:
            if cut:
                real(self, content[: len(content) // 2])
            full()
        return real(self, content)

    monkeypatch.setattr(Path, "write_bytes", write)
    if after == 4:
        put(folder, files_of("new"))
        assert state(folder).keys() == {*NAMES, "summary.json"}
        return
    with pytest.raises(WriteError, match=r"cannot write to .*/design/.*: No space left on device"):
        put(folder, files_of("new"))
    assert state(tmp_path) == before
    assert (tmp_path / "out").exists() == existing


def test_no_folder_is_left_above_one_that_cannot_be(tmp_path: Path) -> None:
    with pytest.raises(WriteError, match="File name too long"):
        put(tmp_path / "new" / "deeper" / ("a" * 300), files_of("new"))
    assert not (tmp_path / "new").exists()


@pytest.mark.parametrize("name", ["a\0b", "\udcff\ud800"])
def test_what_can_be_no_folder(tmp_path: Path, name: str) -> None:
    with pytest.raises(WriteError, match="this is not a possible name"):
        put(tmp_path / name, files_of("new"))
    with pytest.raises(WriteError, match="this is not a possible name"):
        write_new(tmp_path / name, "")
    assert list(tmp_path.iterdir()) == []


def test_a_new_file_is_whole_or_not_there(tmp_path: Path, monkeypatch: pytest.MonkeyPatch) -> None:
    import resource

    limits = resource.getrlimit(resource.RLIMIT_FSIZE)
    resource.setrlimit(resource.RLIMIT_FSIZE, (100_000, limits[1]))
    try:
        with pytest.raises(WriteError, match="File too large"):
            write_new(tmp_path / "new.toml", "x" * 200_000)
        (tmp_path / "mine.toml").write_bytes(b"mine")
        with pytest.raises(WriteError, match="File too large"):
            rewrite(tmp_path / "mine.toml", bytes(200_000))
    finally:
        resource.setrlimit(resource.RLIMIT_FSIZE, limits)
    assert state(tmp_path) == {"mine.toml": b"mine".hex()}
    monkeypatch.setattr("os.replace", full)
    with pytest.raises(WriteError, match="No space left on device"):
        rewrite(tmp_path / "mine.toml", b"other")
    assert state(tmp_path) == {"mine.toml": b"mine".hex()}


def test_what_a_killed_writer_left_is_removed_and_nothing_else(tmp_path: Path) -> None:
    left = Path(tempfile.mkdtemp(".tmp", ".gearcam-", tmp_path))
    mine = {".gearcam-mine.tmp", ".gearcam-", "x.tmp", f"x{left.name}"}
    for name in mine:
        (tmp_path / name).mkdir()
    (left / "half.dxf").write_bytes(b"")
    put(tmp_path, files_of("new"))
    assert {path.name for path in tmp_path.iterdir()} == {*mine, *NAMES, "summary.json"}


def test_two_builds_write_one_after_the_other(
    tmp_path: Path, monkeypatch: pytest.MonkeyPatch
) -> None:
    """The second knows what the first has written, however they come."""
    waits, seen = threading.Event(), list[tuple[str, ...]]()

    def sleep(_: float) -> None:
        waits.set()
        os.sched_yield()

    monkeypatch.setattr(write.time, "sleep", sleep)
    put(tmp_path, files_of("first", ("old.dxf",)))
    thread = threading.Thread(
        target=lambda: seen.append(put(tmp_path, files_of("second", ("other.dxf",))).removed)
    )
    with writing(tmp_path) as replace:
        thread.start()
        assert waits.wait(20.0), "the second does not wait"
        plan = planned(tmp_path, files_of("first"), "first", keep=False)
        summary = json.dumps({"format": 1, **plan.about}).encode()
        replace({**files_of("first"), "summary.json": summary}, plan.removed)
    thread.join()
    assert seen == [NAMES]
    assert state(tmp_path).keys() == {"other.dxf", "summary.json"}


def test_a_writer_that_does_not_end_is_not_waited_for_for_ever(
    tmp_path: Path, monkeypatch: pytest.MonkeyPatch
) -> None:
    monkeypatch.setattr(write, "_PATIENCE", 0.1)

    with writing(tmp_path) as replace:
        with pytest.raises(WriteError, match="another gearcam has been writing to it for"):
            put(tmp_path, files_of("new"))
        replace(files_of("first"))
    assert (tmp_path / NAMES[0]).read_bytes() == b"first"


@pytest.mark.parametrize(
    ("call", "error"), [("fcntl.flock", OSError(errno.ENOTSUP, "")), ("os.open", PermissionError())]
)
def test_a_disk_that_knows_no_locks(
    tmp_path: Path, monkeypatch: pytest.MonkeyPatch, call: str, error: OSError
) -> None:
    """Nobody knows whose the temporary files are, then."""

    real = os.open

    def none(place: object, *rest: Any, **more: Any) -> int:
        if call == "os.open" and place != tmp_path:
            return real(place, *rest, **more)  # type: ignore[call-overload]
        raise error

    monkeypatch.setattr(call, none)
    left = Path(tempfile.mkdtemp(".tmp", ".gearcam-", tmp_path))
    put(tmp_path, files_of("new"))
    assert {path.name for path in tmp_path.iterdir()} == {left.name, *NAMES, "summary.json"}


@pytest.fixture
def desk(tmp_path: Path, monkeypatch: pytest.MonkeyPatch) -> Path:
    monkeypatch.chdir(tmp_path)
    Path("good.toml").write_text(GOOD)
    return tmp_path


OUTPUTS: dict[str, tuple[Callable[[], object], str]] = {
    "file": (lambda: Path("out").write_bytes(b"mine"), "cannot write to out/pair: Not a directory"),
    "link to nothing": (lambda: Path("out").symlink_to("x"), "it is a broken link"),
    "link to itself": (lambda: Path("out").symlink_to("out"), "it is a broken link"),
    "device": (lambda: Path("out").symlink_to("/dev/null"), "Not a directory"),
    "linked folder": (
        lambda: (Path("mine").mkdir(), Path("out").mkdir(), Path("out/pair").symlink_to("../mine")),
        "cannot write to out/pair: it is a link: remove it",
    ),
    "file of its name": (
        lambda: (Path("out").mkdir(), Path("out/pair").write_bytes(b"mine")),
        "cannot write to out/pair: it is a file, not a folder",
    ),
    "folder of a file's name": (
        lambda: Path("out/pair/summary.json").mkdir(parents=True),
        "cannot write to out/pair/summary.json: there is a folder of this name",
    ),
}  # fmt: skip


@pytest.mark.parametrize("case", OUTPUTS)
@pytest.mark.parametrize("command", few(["build", "check"]))
def test_what_is_no_folder_to_write_to(
    desk: Path, command: str, case: str, capsys: pytest.CaptureFixture[str]
) -> None:
    make, words = OUTPUTS[case]
    make()
    before = sorted(desk.rglob("*")), state(desk)
    assert main([command, "good.toml", "-o", "out"]) == 2
    err = capsys.readouterr().err
    assert words in err
    assert "Traceback" not in err
    assert (sorted(desk.rglob("*")), state(desk)) == before


def test_links_and_pipes_are_renamed_and_never_read_or_written_through(desk: Path) -> None:
    """A folder that the user names may be a link; what lies in it gets new names."""
    (desk / "precious.txt").write_bytes(b"precious")
    place = desk / "elsewhere" / "pair"
    place.mkdir(parents=True)
    (desk / "out").symlink_to("elsewhere")
    for name in ("summary.json", "gear1_outline.csv"):
        (place / name).symlink_to(desk / "precious.txt")
    os.mkfifo(place / "centrodes.csv")
    (place / "gear2_outline.csv").write_bytes(b"old")
    (place / "gear2_outline.csv").chmod(0o400)
    assert main(["build", "good.toml", "-o", "out"]) == 0
    found = json.loads((place / "summary.json").read_bytes())
    mine = {"gear1_outline.1.csv", "gear2_outline.1.csv", "centrodes.1.csv"}
    assert {path.name for path in place.iterdir()} == {*found["files"], *mine, "summary.json"}
    made = [path for path in place.iterdir() if path.name not in mine]
    assert all(path.is_file() and not path.is_symlink() for path in made)
    assert (place / "gear1_outline.1.csv").readlink() == desk / "precious.txt"
    assert (place / "centrodes.1.csv").is_fifo()
    assert (place / "gear2_outline.1.csv").read_bytes() == b"old"
    assert (desk / "precious.txt").read_bytes() == b"precious"


@pytest.mark.parametrize(
    "summary",
    [
        b'{"files": {"mine.dxf": "1"}, "format": 1' + b" " * 10_000_000 + b"}",  # huge
        b'{"files": {"mine.dxf": "1"}, "format": "1"}',
        b'{"files": ["mine.dxf"], "name": "package"}',
        b"\xff\xfe\x00",
        b"{",
    ],
    ids=["huge", "foreign", "package", "bytes", "cut"],
)
def test_a_summary_that_is_not_ours_removes_nothing(desk: Path, summary: bytes) -> None:
    place = desk / "output" / "pair"
    place.mkdir(parents=True)
    (place / "mine.dxf").write_bytes(b"mine")
    (place / "summary.json").write_bytes(summary)
    assert listing(place).made == {}
    assert main(["build", "good.toml"]) == 0
    assert (place / "mine.dxf").read_bytes() == b"mine"


def test_a_summary_that_is_a_pipe_is_not_waited_for(tmp_path: Path) -> None:
    os.mkfifo(tmp_path / "summary.json")
    found: list[object] = []
    thread = threading.Thread(target=lambda: found.append(listing(tmp_path).made), daemon=True)
    thread.start()
    thread.join(20.0)
    assert found == [{}]


def test_what_python_is_told_of_the_disk(tmp_path: Path) -> None:
    result = gearcam.build(gearcam.loads(GOOD))
    (tmp_path / "file").write_bytes(b"")
    with pytest.raises(WriteError, match="cannot write to"):
        result.write(tmp_path / "file")
    with pytest.raises(WriteError, match="this is not a possible name"):
        result.check("a\0b")


def test_what_steers_a_terminal_is_shown(capsys: pytest.CaptureFixture[str]) -> None:
    assert visible("a\tb\nr\xe4der \u2014 \u8f2e") == "a\tb\nr\xe4der \u2014 \u8f2e"
    assert main(["check", "\x1b[2J\x07\x9b\u202e.toml"]) == 2
    err = capsys.readouterr().err
    assert "\\x1b[2J\\x07\\x9b\\u202e.toml: there is no such file" in err
    assert not set(err) & set("\x1b\x07\x9b\u202e")


def run(words: str, place: Path) -> subprocess.CompletedProcess[bytes]:
    """Run a command in a shell, in which COMMAND stands for gearcam."""
    words = words.replace("COMMAND", f"'{sys.executable}' -m gearcam")
    return subprocess.run(
        words, shell=True, cwd=place, env=ENVIRONMENT, capture_output=True, check=False, timeout=60
    )


@pytest.mark.parametrize(
    ("words", "code", "told"),
    [
        *few([
            ("COMMAND check good.toml >/dev/full", 2, b"cannot write to the standard output"),
            ("COMMAND new cam >/dev/full", 2, b"cannot write to the standard output: No space"),
            ("COMMAND check none.toml 2>/dev/full", 2, b""),
            ("COMMAND --help >/dev/full", 2, b"cannot write to the standard output: No space"),
            ("COMMAND check good.toml >&- 2>&- <&-", 0, b""),
            ("COMMAND check none.toml 2>&-", 2, b""),
            ("COMMAND new cam | true", 0, b""),
        ]),
    ],
)  # fmt: skip
def test_streams_that_are_full_closed_or_gone(
    desk: Path, words: str, code: int, told: bytes
) -> None:
    done = run(words, desk)
    assert (done.returncode, done.stdout) == (code, b"")
    assert told in done.stderr
    assert bool(told) == bool(done.stderr)
    assert b"Traceback" not in done.stderr
    assert b"Exception" not in done.stderr
    good = "good.toml" in words
    assert (desk / "output" / "pair" / "summary.json").exists() == good


def test_a_name_that_the_system_cannot_write(desk: Path) -> None:
    """Where names of files are ASCII, an umlaut in the design's is no fault of the program."""
    (desk / "good.toml").write_text(GOOD.replace('"pair"', '"r\xe4der"'), encoding="utf-8")
    ascii_only = "LC_ALL=C PYTHONUTF8=0 PYTHONCOERCECLOCALE=0"
    done = run(f"{ascii_only} COMMAND check good.toml", desk)
    assert done.returncode == 2
    assert b"cannot write to 'output/r\\xe4der': this is not a possible name" in done.stderr
    assert not (desk / "output").exists()


def test_a_name_that_looks_like_markup_is_shown_on_a_terminal(desk: Path) -> None:
    (desk / "x[").mkdir()
    (desk / "x[" / "b].toml").write_text(GOOD)
    terminal, end = pty.openpty()
    command = [sys.executable, "-m", "gearcam", "check", "x[/b].toml"]
    done = subprocess.run(
        command, cwd=desk, env=ENVIRONMENT, stdout=subprocess.PIPE, stderr=end, check=False
    )
    os.close(end)
    told = os.read(terminal, 100_000)
    os.close(terminal)
    assert done.returncode == 0, told
    assert done.stdout.startswith(b"x[/b].toml: checked")
