"""The score of random designs: its table is right, and nothing else of the page is touched."""

from __future__ import annotations

import re
from collections.abc import Callable, Iterable, Iterator
from datetime import date
from pathlib import Path
from types import SimpleNamespace

import pytest

import gearcam
from arch import rules
from fuzz.campaign import Campaign, Case, Catch
from fuzz.command import main
from fuzz.outcome import BUILT, FAILED, LATE, REFUSED, WRONG, Failure, Outcome, Task
from fuzz.score import ALL, BEGIN, COLUMNS, END, Score, publish, with_block
from gearcam.base.errors import WriteError
from random_designs.designs import MAKERS

VALIDATION = rules.ROOT / "docs" / "validation.md"
PAGE = f"# Page\r\n\nwords\n\n{BEGIN}\nold\n{END}\n\n| {ALL} | 9 |\nno last line end"
KINDS = ("cam", "gear-pair")
ENDS: tuple[tuple[str, str], ...] = (
    (BUILT, ""), (BUILT, ""), (BUILT, ""), (REFUSED, ""), (WRONG, ""), (FAILED, "polygon"),
    (FAILED, "contradiction"), (FAILED, "remedy"), (FAILED, LATE), (FAILED, "crash"),
    (FAILED, "memory"), (BUILT, ""),
)  # fmt: skip
"""How designs of each kind end: 4 right, 2 refused, 3 wrong, 1 out of time, 2 crashed."""


def table(page: str) -> dict[str, list[int]]:
    """Numbers of the rows between the marks, by name."""
    lines = page.partition(BEGIN)[2].partition(END)[0].splitlines()
    rows = [
        [cell.strip() for cell in line.strip("| ").split("|")] for line in lines if line[:1] == "|"
    ]
    assert rows[0] == ["designs", "tried", *COLUMNS]
    assert {*rows[1]} == {"---", "---:"}
    return {row[0]: [*map(int, row[1:])] for row in rows[2:]}


def made_up() -> Score:
    """The score of a campaign that nobody ran."""
    cases = [Case(kind=kind, seed=7, index=index) for kind in KINDS for index in range(len(ENDS))]
    campaign = Campaign(cases=cases, pool=SimpleNamespace())  # type: ignore[arg-type]
    for case in cases:
        end, kind = ENDS[case.index]
        failure = Failure(kind=kind, words="a | b") if kind else None
        campaign._take(case, Outcome(end=end, failure=failure, doubted=case.index == 0))
        if failure is not None:
            campaign.found.append(Catch(case=case, failure=failure, files=case.drawn.files))
    return Score(campaign=campaign, version="9.8.7", commit="abc", day=date(2031, 2, 3))


def test_the_table_is_that_of_the_campaign() -> None:
    made = made_up()
    found = table(with_block(PAGE, made.block()))
    assert found.pop(ALL) == [24, 8, 4, 6, 2, 4]
    for kind in KINDS:
        parts = [row for name, row in found.items() if name.startswith(f"{kind}, ")]
        assert [*map(sum, zip(*parts, strict=True))] == [12, 4, 2, 3, 1, 2]
    broken = [case for case in made.campaign.cases if case.drawn.broken]
    assert broken
    assert sum(row[0] for name, row in found.items() if name.endswith("error")) == len(broken)


def test_the_caption_says_of_what_and_the_list_how_to_repeat() -> None:
    text = made_up().block()
    told = (
        "gearcam 9.8.7, commit abc, 2031-02-03: 24 designs, seed 7;", "at most 90 s", "4 GiB",
        "other methods: 2.", "Remedies built: 0.", "`make fuzz MORE=",
    )  # fmt: skip
    assert [one for one in told if one not in text] == []
    listed = re.findall(
        r"^- (\S+): `make fuzz MORE='--kind (\S+) --seed 7 --only (\d+)'`$", text, re.MULTILINE
    )
    wanted = [(end[1], kind, str(at)) for kind in KINDS for at, end in enumerate(ENDS) if end[1]]
    assert listed == wanted


def test_the_rest_of_the_page_is_kept_to_the_byte(tmp_path: Path) -> None:
    path = tmp_path / "page.md"
    path.write_bytes(PAGE.encode())
    block = made_up().block()
    publish(path, block)
    publish(path, block)
    before, after = PAGE.split("old\n")
    assert path.read_bytes().decode() == f"{before}\n{block}\n{after}"
    assert [*tmp_path.iterdir()] == [path]


def test_a_page_that_cannot_be_written_is_as_it_was(
    tmp_path: Path, monkeypatch: pytest.MonkeyPatch
) -> None:
    def full(path: Path, content: bytes) -> int:
        with path.open("wb") as stream:
            stream.write(content[:50])
        raise OSError(28, "No space left on device")

    path = tmp_path / "page.md"
    path.write_bytes(PAGE.encode())
    monkeypatch.setattr(Path, "write_bytes", full)
    with pytest.raises(WriteError, match="No space"):
        publish(path, "new")
    assert path.read_bytes().decode() == PAGE
    assert [*tmp_path.iterdir()] == [path]


@pytest.mark.parametrize(
    "page", ["", BEGIN, END, f"{END}\n{BEGIN}", f"{BEGIN}\n{END}\n{BEGIN}\n{END}"]
)
def test_a_page_without_a_pair_of_marks_is_refused_before_anything_is_tried(
    page: str, tmp_path: Path, capsys: pytest.CaptureFixture[str]
) -> None:
    path = tmp_path / "page.md"
    path.write_text(page)
    with pytest.raises(ValueError, match="pair of lines"):
        with_block(page, "new")
    for named in (path, tmp_path / "none.md"):
        with pytest.raises(SystemExit, match="2"):
            main(["--count", "5", "--score", str(named)])
        assert f"{named}: " in capsys.readouterr().err
    assert path.read_text() == page


# --- the command --------------------------------------------------------------------------------


class Everywhere:
    """Instead of processes: the outcome of each design, as a function says."""

    def __init__(self, work: Callable[[Task, Path], Outcome], *_: object) -> None:
        self._work = work

    def __enter__(self) -> Everywhere:
        return self

    def __exit__(self, *_: object) -> None:
        """Nothing is left."""

    def each(self, tasks: Iterable[tuple[int, Task]]) -> Iterator[tuple[int, Outcome]]:
        for number, task in tasks:
            yield number, self._work(task, Path())


@pytest.fixture
def page(tmp_path: Path, monkeypatch: pytest.MonkeyPatch) -> Path:
    path = tmp_path / "page.md"
    path.write_bytes(PAGE.encode())
    monkeypatch.setattr("fuzz.command.Pool", Everywhere)
    monkeypatch.setattr("fuzz.command.tried", lambda *_: Outcome(end=BUILT))
    return path


def test_a_campaign_of_all_kinds_is_published(page: Path) -> None:
    words = ["--count", "10", "--seed", "3", "--score", str(page)]
    assert main(words) == 0
    text = page.read_bytes().decode()
    assert table(text)[ALL] == [10, 10, 0, 0, 0, 0]
    assert "10 designs, seed 3;" in text
    assert f"gearcam {gearcam.__version__}, commit " in text


@pytest.mark.parametrize(
    "words", [["--quick"], ["--only", "1"], ["--kind", "cam", "--count", "5"], ["--count", "4"]]
)
def test_a_part_of_a_campaign_is_not(
    words: list[str], page: Path, capsys: pytest.CaptureFixture[str]
) -> None:
    assert main([*words, "--score", str(page)]) == 0
    assert page.read_bytes().decode() == PAGE
    assert f"{page}: not changed; " in capsys.readouterr().out


def test_an_interrupted_campaign_keeps_the_score(
    page: Path, monkeypatch: pytest.MonkeyPatch, capsys: pytest.CaptureFixture[str]
) -> None:
    left = iter(range(7))

    def work(*_: object) -> Outcome:
        if next(left, None) is None:
            raise KeyboardInterrupt
        return Outcome(end=BUILT)

    monkeypatch.setattr("fuzz.command.tried", work)
    with pytest.raises(KeyboardInterrupt):
        main(["--count", "10", "--score", str(page)])
    assert page.read_bytes().decode() == PAGE
    assert "failures: 0" in capsys.readouterr().out


# --- what is committed --------------------------------------------------------------------------


def faults(page: str) -> list[str]:
    """What is wrong with the score of a page."""
    rows = table(page)
    total = rows.pop(ALL)
    told = [name for name, row in [*rows.items(), (ALL, total)] if row[0] != sum(row[1:])]
    if [*map(sum, zip(*rows.values(), strict=True))] != total:
        told.append("sum of rows")
    head = page.partition(BEGIN)[2].partition(END)[0]
    caption = re.search(
        r"^gearcam \d\S+, commit [0-9a-f]{12}, (\d{4}-\d\d-\d\d): (\d+) designs, seed \d+;",
        head,
        re.MULTILINE,
    )
    if caption is None or int(caption[2]) != total[0] or not date.fromisoformat(caption[1]):
        told.append("caption")
    if {name.partition(",")[0] for name in rows} != {*MAKERS}:
        told.append("kinds")
    if head.count("\n- ") != sum(total[3:]):
        told.append("failures")
    return told


def test_the_committed_score_agrees_with_itself() -> None:
    assert faults(VALIDATION.read_text("utf-8")) == []


def test_a_score_that_disagrees_is_seen() -> None:
    text = VALIDATION.read_text("utf-8")
    count = table(text)[ALL][0]
    row = re.search(r"^\| cam, buildable \| (\d+) \| (\d+)", text, re.MULTILINE)
    assert row is not None
    more = f"| cam, buildable | {int(row[1]) + 1} | {int(row[2]) + 1}"
    assert faults(text.replace(row[0], more)) == ["sum of rows"]
    assert faults(text.replace(row[0], f"| cam, buildable | {int(row[1]) + 1} | {row[2]}")) == [
        "cam, buildable",
        "sum of rows",
    ]
    assert faults(text.replace(f": {count} designs", f": {count + 1} designs")) == ["caption"]
    assert faults(text.replace("| cam, buildable", "| cams, buildable")) == ["kinds"]
    assert faults(text.replace(f"\n{END}", f"- crash: x\n{END}")) == ["failures"]


def undated(page: str) -> list[str]:
    """Bounds of the table of claims with a figure found, but not the day on which it was."""
    rows = [line.split(" | ") for line in page.splitlines() if line.startswith("| ")]
    bounds = [row[2] for row in rows if len(row) == 4]
    found = [one for bound in bounds for one in re.findall(r"\((\d[^)]*)\)", bound)]
    assert len(found) > 10
    return [one for one in found if not re.search(r", \d{4}-\d\d-\d\d$", one)]


def test_every_figure_found_has_its_day() -> None:
    text = VALIDATION.read_text("utf-8")
    assert undated(text) == []
    assert undated(text.replace("(4e-15, 2026-11-21)", "(4e-15)")) == ["4e-15"]
