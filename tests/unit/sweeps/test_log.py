"""The log of a sweep: what it has is kept, whatever ended the program."""

from __future__ import annotations

import re
from pathlib import Path

import pytest

from gearcam.base.errors import DesignError, WriteError
from gearcam.sweeps.log import LOG, Log
from gearcam.sweeps.rows import Built

HEAD = {"sweep": "abc", "file": "a.toml", "variants": 9, "varied": ["c=1"]}


def row(number: int) -> Built:
    return Built(
        number=number,
        values={"law.eccentricity": 0.1 + 0.2 * number, "pair.teeth": [20, 20]},
        facts={"size_mm": 1.0 / 3.0, "cutter": "rack"},
        findings=("undercut",),
        errors=1,
        time_s=0.02,
    )


def test_rows_are_there_again_to_the_last_bit(tmp_path: Path) -> None:
    with Log(tmp_path, HEAD) as log:
        for number in (3, 0, 2):
            log.append(row(number))
    with Log(tmp_path, HEAD) as log:
        assert len(log) == 3
        assert [number in log for number in range(4)] == [True, False, True, True]
        assert list(log.rows()) == [row(0), row(2), row(3)]
        log.append(row(1))
        assert [one.number for one in log.rows()] == [0, 1, 2, 3]


@pytest.mark.parametrize("cut", range(1, 60, 7))
def test_a_line_that_was_cut_off_is_dropped(tmp_path: Path, cut: int) -> None:
    with Log(tmp_path, HEAD) as log:
        for number in range(3):
            log.append(row(number))
    file = tmp_path / LOG
    file.write_bytes(file.read_bytes()[:-cut])
    with Log(tmp_path, HEAD) as log:
        assert [one.number for one in log.rows()] == [0, 1]
        log.append(row(2))
    with Log(tmp_path, HEAD) as log:
        assert list(log.rows()) == [row(0), row(1), row(2)]


def test_a_log_whose_first_line_was_cut_off_begins_anew(tmp_path: Path) -> None:
    (tmp_path / LOG).write_text('{"sweep": "a')
    with Log(tmp_path, HEAD) as log:
        log.append(row(0))
    with Log(tmp_path, HEAD) as log:
        assert list(log.rows()) == [row(0)]


@pytest.mark.parametrize(
    ("text", "words"),
    [
        (
            '{"sweep": "x", "file": "b.toml", "variants": 3, "varied": ["c=1", "d=2"]}\n',
            r"another sweep \(file: b.toml; variants: 3; varied: c=1, d=2\)",
        ),
        (
            '{"sweep": "x", "file": "a.toml", "variants": 9, "varied": ["c=1"]}\n',
            r"another sweep \(another design or seed\)",
        ),
        ("a letter\n", "another sweep$"),
    ],
)
def test_the_log_of_another_sweep_is_refused_and_kept(
    tmp_path: Path, text: str, words: str
) -> None:
    (tmp_path / LOG).write_text(text)
    with pytest.raises(DesignError) as caught:
        Log(tmp_path, HEAD)
    assert re.search(words, caught.value.problems[0].message)
    assert (tmp_path / LOG).read_text() == text


def test_a_folder_that_is_a_file_is_named(tmp_path: Path) -> None:
    (tmp_path / "out").touch()
    with pytest.raises(WriteError, match="out: "):
        Log(tmp_path / "out", HEAD)
