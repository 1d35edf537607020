"""Whatever a file is or holds: a message, exit code 2, no traceback, and nothing is written."""

from __future__ import annotations

import os
import signal
import time
import tracemalloc
from collections.abc import Callable, Iterator
from pathlib import Path
from types import FrameType

import pytest

import gearcam
from gearcam.base.errors import MOST_LISTED, DesignError
from gearcam.base.reading import UnreadableError, read
from gearcam.cli import main
from gearcam.designs import loads, reader
from gearcam.laws import columns
from helpers_interrupts import PAIR

GOOD = PAIR.format(eccentricity=0.2, bore=8, files='["csv"]')
HUGE = 100_000_000

COMMANDS: dict[str, tuple[str, ...]] = {
    "build": ("build", "FILE"),
    "check": ("check", "FILE"),
    "compare": ("compare", "good.toml", "FILE"),
    "view": ("view", "--no-browser", "FILE"),
    "mesh": ("mesh", "FILE"),
    "accuracy": ("accuracy", "FILE"),
    "follow": ("follow", "FILE", "profile.csv"),
}


@pytest.fixture
def desk(tmp_path: Path, monkeypatch: pytest.MonkeyPatch) -> Iterator[Path]:
    """A folder with a good design; whoever waits for ever is called back."""

    def call_back(*_: int | FrameType | None) -> None:
        raise TimeoutError("nothing came of it for 20 s")

    monkeypatch.chdir(tmp_path)
    Path("good.toml").write_text(GOOD)
    before = signal.signal(signal.SIGALRM, call_back)
    signal.alarm(20)
    yield tmp_path
    signal.alarm(0)
    signal.signal(signal.SIGALRM, before)


def huge(file: Path) -> None:
    with file.open("wb") as stream:
        stream.truncate(HUGE)


NO_FILES: dict[str, tuple[Callable[[Path], object], str]] = {
    "missing": (lambda _: None, "there is no such file"),
    "below a file": (lambda file: file.with_suffix("").write_bytes(b""), "there is no such file"),
    "folder": (Path.mkdir, "this is a folder, not a file"),
    "pipe": (os.mkfifo, "this is a pipe or a device, not a file"),
    "device": (lambda file: file.symlink_to("/dev/zero"), "this is a pipe or a device, not a file"),
    "link to itself": (lambda file: file.symlink_to(file), "cannot be read: Too many levels"),
    "link to nothing": (lambda file: file.symlink_to("nowhere"), "there is no such file"),
    "huge": (huge, "has 100 MB, but files of at most 2 MB are read"),
}


@pytest.mark.parametrize("kind", NO_FILES)
@pytest.mark.parametrize("command", COMMANDS)
def test_what_is_no_file_that_could_be_read(
    desk: Path, command: str, kind: str, capsys: pytest.CaptureFixture[str]
) -> None:
    make, words = NO_FILES[kind]
    name = "bad/x.toml" if kind == "below a file" else "bad.toml"
    make(desk / ("bad.toml" if kind == "below a file" else name))
    start = time.process_time()
    there = set(desk.rglob("*"))
    assert main([name if word == "FILE" else word for word in COMMANDS[command]]) == 2
    err = capsys.readouterr().err
    assert f"{name}: {words}" in err
    assert "Traceback" not in err
    assert set(desk.rglob("*")) == there
    assert time.process_time() - start < 5.0


@pytest.mark.parametrize("name", ["good", "./good", "sub/good", "good/"])
def test_a_design_without_its_extension(desk: Path, name: str) -> None:
    (desk / "sub").mkdir()
    with pytest.raises(DesignError) as caught:
        gearcam.load(name)
    near = "did you mean good.toml?" if "sub" not in name else ""
    assert caught.value.problems[0].hint == near


def test_a_huge_file_is_refused_before_it_is_read(
    desk: Path, monkeypatch: pytest.MonkeyPatch
) -> None:
    huge(desk / "huge.toml")
    huge(desk / "huge.csv")
    tracemalloc.start()
    try:
        for file, most in (("huge.toml", reader.LARGEST), ("huge.csv", columns.LARGEST)):
            with pytest.raises(UnreadableError, match="has 100 MB"):
                read(file, most)
        # one that grows, or whose size the system does not tell
        told = (desk / "good.toml").stat()
        with monkeypatch.context() as patch:
            patch.setattr("os.stat", lambda _: told)
            with pytest.raises(UnreadableError, match="is larger, but files of at most 1 kB are"):
                read("huge.csv", 1000)
        assert tracemalloc.get_traced_memory()[1] < 100_000
    finally:
        tracemalloc.stop()
    (desk / "just.csv").write_bytes(bytes(1000))
    assert len(read("just.csv", 1000)) == 1000
    with pytest.raises(UnreadableError, match="has 1 kB"):
        read("just.csv", 999)


@pytest.mark.parametrize("name", ["a\0b", "\udcff\ud800"])
def test_what_can_be_no_name(name: str) -> None:
    with pytest.raises(UnreadableError, match="this is not a possible file name"):
        read(name, 1)
    with pytest.raises(DesignError, match="this is not a possible file name"):
        gearcam.load(name)


@pytest.mark.usefixtures("desk")
def test_a_file_that_may_not_be_read(monkeypatch: pytest.MonkeyPatch) -> None:
    def deny(file: object, *_: object, **__: object) -> None:
        raise PermissionError(13, "Permission denied", file)

    monkeypatch.setattr("builtins.open", deny)
    with pytest.raises(DesignError, match=r"good\.toml: cannot be read: Permission denied"):
        gearcam.load("good.toml")


def number(value: str) -> bytes:
    return GOOD.replace("module_mm = 2", f"module_mm = {value}").encode()


DEEP = "lists or tables are nested too deep"
NUMBER = "allowed: a number from 0.001"
CONTENTS: dict[str, tuple[bytes, str]] = {
    "empty": (b"", ":1: kind: is missing"),
    "bytes": (bytes(range(256)) * 20, ":2: the byte 0x80 is not UTF-8"),
    "latin-1": (GOOD.encode() + "# räder".encode("latin-1"), "the byte 0xe4 is not UTF-8"),
    "UTF-16": (GOOD.encode("utf-16"), ":1: the file is UTF-16\n    "),
    "zero byte": (GOOD.encode() + b"# \0", "Found invalid character"),
    "lists in lists": (b"a = " + b"[" * 200_000, DEEP),
    "closed lists": (b"a = " + b"[" * 100 + b"]" * 100, DEEP),
    "tables in tables": (b"[" + b".".join([b"a"] * 60) + b"]\n" + GOOD.encode(), DEEP),
    "dotted keys": (b".".join([b"a"] * 900_000) + b" = 1\n", DEEP),
    "quoted keys": (b' . '.join([b'"a b"'] * 200_000) + b" = 1\n", DEEP),
    "braces": (b"a = " + b"{a = " * 60 + b"1" + b"}" * 60 + b"\n" + GOOD.encode(), DEEP),
    "digits": (number("9" * 5000), ":7: a number has too many digits"),
    "digits apart": (number("1" + "_1" * 5000), ":7: a number has too many digits"),
    "hexadecimal digits": (number("0x" + "f" * 5000), "a very large number is out of range"),
    "not a number": (number("nan"), "nan is not a finite number"),
    "infinite": (number("1e999"), "inf is not a finite number"),
    "nothing below zero": (number("-0.0"), "-0.0 is out of range"),
    "nearly nothing": (number("1e-18"), "1e-18 is out of range"),
    "how near": (number("1e-18"), "allowed: a number from 0.001 to 1000 mm"),
    "date": (number("2026-01-02"), "2026-01-02 is not a number"),
    "time": (number("07:30:00"), "07:30:00 is not a number"),
    "key twice": (number("2\nmodule_mm = 3"), "the key module_mm is given twice"),
    "table twice": (GOOD.encode() + b"[pair]\n", "the table [pair] is given twice"),
    "no kind": (GOOD.partition("\n")[2].encode(), "kind: is missing"),
    "kind unknown": (GOOD.replace("gear-pair", "linkage").encode(), "is not a kind of design"),
    "kind no text": (b"kind = [1]", "[1] is not a kind of design"),
    "dotted in quotes": (GOOD.encode() + b'"pair.x" = 1\n', 'output."pair.x": unknown key'),
    "steering": (GOOD.encode() + b'"\\u001b[31m" = 1\n', 'output."\\u001b[31m": unknown key'),
    "many": (GOOD.encode() + b"".join(b"k%d = 1\n" % k for k in range(200)), "  and 100 more\n"),
}  # fmt: skip


@pytest.mark.parametrize("case", CONTENTS)
def test_what_is_no_design(desk: Path, case: str, capsys: pytest.CaptureFixture[str]) -> None:
    content, words = CONTENTS[case]
    Path("bad.toml").write_bytes(content)
    start = time.process_time()
    for command in ("check", "compare"):
        assert main(["bad.toml" if word == "FILE" else word for word in COMMANDS[command]]) == 2
        err = capsys.readouterr().err
        assert words in err
        assert "Traceback" not in err
        assert "\x1b" not in err
        assert err.count("unknown key") <= 100
    assert {path.name for path in desk.iterdir()} == {"bad.toml", "good.toml"}
    assert time.process_time() - start < 5.0


@pytest.mark.parametrize("at", ["[law]\n", "module_mm"])
def test_what_was_meant_is_sought_for_no_more_keys_than_are_told(at: str) -> None:
    """A search takes longer than all else that is done with an unknown key."""
    keys = "".join(f"teeth{k} = 1\n" for k in range(MOST_LISTED + 5))
    with pytest.raises(DesignError) as caught:
        loads(GOOD.replace(at, keys + at))
    hints = [bool(one.hint) for one in caught.value.problems]
    assert hints == [True] * MOST_LISTED + [False] * 5


@pytest.mark.parametrize("sign", [1, -1])
def test_numbers_too_long_to_be_written_are_refused(sign: int) -> None:
    with pytest.raises(DesignError, match="a very large number"):
        loads(GOOD).with_({"pair.module_mm": sign * 10**5000})


@pytest.mark.usefixtures("desk")
def test_a_mark_before_utf_8_is_no_fault() -> None:
    Path("good.toml").write_bytes(b"\xef\xbb\xbf" + GOOD.encode())
    assert gearcam.load("good.toml").name == "pair"


def test_a_design_in_python_is_not_deeper_than_one_in_a_file() -> None:
    endless: dict[str, object] = {"kind": "gear-pair", "name": "x"}
    endless["law"] = [endless, endless]
    with pytest.raises(DesignError, match=DEEP):
        gearcam.design(endless)


NAMES = [
    *("", ".", "..", "a/b", "/a", "a\\b", "..\\a", "a\nb", "a\tb", "a\x07", "a\x7f", "a\0", "a."),
    *("a b", " a", "-rf", "~", "con", "NUL.txt", "com1", "LPT9.x", "\u202ecba", "e\u0301"),
    *("a" * 101, "a" * 300, "\u8f2e" * 67, "\ufeffa", "a\u200bb", "\U0001f600", "a:b", "a*", "<a>"),
]


@pytest.mark.parametrize("name", NAMES)
def test_names_that_name_no_folder(name: str) -> None:
    document = gearcam.loads(GOOD).to_dict() | {"name": name}
    with pytest.raises(DesignError) as refused:
        gearcam.design(document)
    (problem,) = refused.value.problems
    assert problem.key == "name"
    assert "it names the output folder" in problem.allowed


@pytest.mark.parametrize("name", ["\u8f2e" * 66, "r\xe4der_1.2-b", "a" * 100, "1"])
def test_names_that_name_a_folder(name: str, tmp_path: Path) -> None:
    document = gearcam.loads(GOOD).to_dict() | {"name": name}
    assert gearcam.design(document).name == name
    (tmp_path / name).mkdir()


def test_a_name_is_proposed_only_if_it_will_do(
    desk: Path, capsys: pytest.CaptureFixture[str]
) -> None:
    text = GOOD.replace('name = "pair"\n', "")
    for stem, hint in (("two words", 'add name = "two_words"'), ("con", ""), ("\u8f2e" * 80, "")):
        (desk / f"{stem}.toml").write_text(text)
        assert main(["check", f"{stem}.toml"]) == 2
        err = capsys.readouterr().err
        assert hint in err
        assert ("add name" in err) == bool(hint)
        if hint:
            (desk / f"{stem}.toml").write_text(text.replace("[law]", f"{hint[4:]}\n[law]"))
            assert main(["check", f"{stem}.toml"]) == 0


TABLE = "phi1_deg,ratio\n" + "".join(
    f"{30 * k},{1 + 0.1 * (k % 12 in (1, 2, 3, 4, 5))}\n" for k in range(13)
)
BY_TABLE = GOOD.replace('type = "ellipse"', 'type = "table"').replace(
    "eccentricity = 0.2", 'file = "bad.csv"'
)
TABLES: dict[str, tuple[bytes, str]] = {
    "empty": (b"", "is empty"),
    "head": (b"phi1_deg,ratio\n", "has 0 rows"),
    "bytes": (bytes(range(256)), "cannot be read: it is not a text file in UTF-8"),
    "UTF-16": (TABLE.encode("utf-16"), "cannot be read: it is in UTF-16: save it in UTF-8"),
    "zero byte": (TABLE.replace("60,", "6\0,").encode(), r"line 4: '6\\x00' is not a number"),
    "long cell": ((TABLE + "1" * 200_000 + ",1\n").encode(), "line 15: no row of a table"),
    "digits": (TABLE.replace("60,", "6" * 5000 + ",").encode(), f"'{'6' * 40}...' is not finite"),
    "infinite": (TABLE.replace("60,", "inf,").encode(), "'inf' is not finite"),
}


@pytest.mark.parametrize("case", TABLES)
def test_what_is_no_table(desk: Path, case: str, capsys: pytest.CaptureFixture[str]) -> None:
    content, words = TABLES[case]
    Path("bad.csv").write_bytes(content)
    Path("good.toml").write_text(BY_TABLE)
    assert main(["check", "good.toml"]) == 2
    err = capsys.readouterr().err
    assert "good.toml:5: law.file" in err
    assert words.replace("\\\\", "\\") in err
    assert not (desk / "output").exists()


@pytest.mark.parametrize("kind", NO_FILES)
def test_what_is_no_table_that_could_be_read(
    desk: Path, kind: str, capsys: pytest.CaptureFixture[str]
) -> None:
    make, words = NO_FILES[kind]
    make(desk / "bad.csv")
    Path("good.toml").write_text(
        BY_TABLE.replace("bad.csv", "bad/x.csv" if "below" in kind else "bad.csv")
    )
    assert main(["check", "good.toml"]) == 2
    err = capsys.readouterr().err
    assert "good.toml:5: law.file" in err
    assert words.replace("2 MB", "16 MB").removeprefix("cannot be read: ") in err


@pytest.mark.usefixtures("desk")
def test_marks_and_ends_of_lines_of_tables_are_no_fault() -> None:
    Path("good.toml").write_text(BY_TABLE)
    found = []
    for content in (
        TABLE,
        "\ufeff" + TABLE,
        TABLE.replace("\n", "\r\n"),
        TABLE.replace("\n", "\r"),
    ):
        Path("bad.csv").write_bytes(content.encode())
        found.append(gearcam.build(gearcam.load("good.toml")).design_hash)
    assert len(set(found)) == 1


@pytest.mark.parametrize(
    ("setting", "words"),
    [
        ("law.eccentricity=" + "[" * 5000, "is not a number"),
        ("law.eccentricity=" + "9" * 5000 + ",1", "is not a number"),
        ("law.eccentricity=" + "[" * 99 + "]" * 99 + ",1", DEEP),
        (f"pair.teeth[{'9' * 5000}]=1,2", "there is no such key or index"),
        ("pair.teeth[\u00b2]=1,2", "there is no such key or index"),
        ("pair.teeth[\u0663]=1,2", "there is no such key or index"),
        ("[]=1,2", "is not KEY=VALUE"),
        (".=1,2", "is not KEY=VALUE"),
    ],
)
@pytest.mark.usefixtures("desk")
def test_settings_that_cannot_be(
    setting: str, words: str, capsys: pytest.CaptureFixture[str]
) -> None:
    assert main(["compare", "good.toml", "--set", setting, "--set", "pair.x=0,0.1"]) == 2
    assert words in capsys.readouterr().err
