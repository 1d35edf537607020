"""The live view follows a file, keeps what was good, tries numbers and writes them."""

from __future__ import annotations

import hashlib
import json
import os
import threading
import tomllib
from collections.abc import Iterator
from dataclasses import replace
from pathlib import Path
from typing import Any

import pytest

from gearcam import build, load
from gearcam.base.errors import DesignError, InfeasibleError
from gearcam.cli import main
from gearcam.view import watch, work
from gearcam.view.command import reporter
from gearcam.view.session import RequestError, Session, State, _Newest
from gearcam.view.watch import Watch
from helpers_pairs import PROFILES
from helpers_solids import bodies_of
from helpers_view import DESIGN, SECONDS, Shown, shown

NAIL = PROFILES / "nail_machine_two_phase.toml"


@pytest.fixture
def file(tmp_path: Path) -> Path:
    made = tmp_path / "wheels.toml"
    made.write_text(DESIGN)
    return made


@pytest.fixture
def view(file: Path) -> Iterator[Shown]:
    with shown(file) as made:
        made.refresh()
        yield made


def save(session: Session, **changes: float) -> None:
    named = {key.replace("__", "."): value for key, value in changes.items()}
    session.save({"changes": named, "made": session.state.made})


def test_a_bad_file_keeps_the_last_good_page_and_tells_all_that_is_wrong(
    view: Shown, file: Path, capsys: pytest.CaptureFixture[str]
) -> None:
    good = view.session.state
    file.write_text(DESIGN.replace("module_mm = 2.0", "module_mm = -2\nwheels = 3"))
    bad = view.refresh()
    assert bad.document is good.document
    assert bad.number > good.number
    assert bad.error.count(f"{file}:") == 3
    main(["check", str(file)])
    assert bad.error.replace("nothing was updated", "nothing was checked") == (
        capsys.readouterr().err.rstrip()
    )
    file.write_text(DESIGN)
    assert view.refresh().error == ""


def test_a_design_that_cannot_be_made_is_told_with_its_remedies(view: Shown, file: Path) -> None:
    file.write_text(DESIGN + "[blank]\nbore_diameter_mm = 40\n")
    bad = view.refresh()
    assert "cannot be made, nothing was updated" in bad.error
    assert "the bore reaches the root of the teeth" in bad.error
    found = view.after(bad.number)
    assert found.error.startswith(bad.error)
    assert "built without errors:" in found.error
    assert found.document is not None


def test_a_refused_number_is_answered_with_remedies_that_build(view: Shown) -> None:
    changes = {"blank.bore_diameter_mm": 40}
    text = DESIGN + "[blank]\nbore_diameter_mm = 5\n"
    Path(view.session.file).write_text(text)
    view.refresh()
    reply = view.session.remedies({"changes": changes})
    assert reply is not None
    assert reply["error"] == ""
    assert "was built without errors:" in reply["lines"]
    (remedy,) = reply["found"]
    assert remedy["text"] in reply["lines"]
    ((key, value),) = remedy["changes"].items()
    shown = json.loads(work.follow(text, "a.toml", {key: value}, key, exact=True))
    assert shown["error"] == ""


def test_solids_are_made_when_they_are_asked_for_of_the_numbers_in_the_page(view: Shown) -> None:
    views = []
    for changes in ({}, {"pair.face_width_mm": 7}):
        reply = view.session.solids({"changes": changes})
        assert reply is not None
        assert reply["error"] == ""
        views.append(bodies_of(reply["view"]))
    assert [sorted(one) for one in views] == 2 * [["gear1", "gear2"]]
    assert [one["gear1"].bounds[1][2] for one in views] == [5.0, 7.0]
    with pytest.raises(RequestError, match="wheels is not a number of the file"):
        view.session.solids({"changes": {"pair.wheels": 3}})
    reply = view.session.solids({"changes": {"pair.face_width_mm": -7}})
    assert reply is not None
    assert "face_width_mm" in reply["error"]


def test_the_terminal_repeats_no_error_when_remedies_come(
    capsys: pytest.CaptureFixture[str],
) -> None:
    report = reporter("a.toml")
    good = State(document={}, news=None)
    for error in ("bad\n  why", "bad\n  why\n  a remedy", "worse", "worse"):
        report(State(error=error))
    assert capsys.readouterr().err == "bad\n  why\n  a remedy\nworse\nworse\n"
    report(replace(good, news=good.document))
    report(State(error="worse"))
    assert capsys.readouterr() == ("a.toml: view updated\n", "worse\n")


def test_a_fault_of_the_program_is_told(view: Shown, monkeypatch: pytest.MonkeyPatch) -> None:
    def broken(*_: Any) -> None:
        raise RuntimeError("in a cog")

    monkeypatch.setattr(work, "document", broken)
    assert "this is a bug in gearcam" in view.refresh().error


def test_a_draft_comes_before_the_whole_and_leaves_the_others_as_they_are(
    view: Shown, file: Path
) -> None:
    before, told = view.session.state, len(view.states)
    file.write_text(DESIGN.replace("2.0", "2.5"))
    after = view.refresh()
    states = view.states[told:]
    assert states[-1] is after
    assert len(states) <= 2
    assert before.document is not None
    for draft in states[:-1]:
        assert draft.news is not None
        assert "charts" not in draft.news
        assert draft.document is not None
        drawn = draft.document["charts"]
        assert [one["name"] for one in drawn] == [one["name"] for one in before.document["charts"]]
        assert drawn[:3] == draft.news["leading"] != before.document["charts"][:3]
        assert drawn[3:] == before.document["charts"][3:]
        assert "leading" not in draft.document
        assert draft.document["blocks"].keys() == before.document["blocks"].keys()
        assert draft.made == before.made
    assert after.made == hashlib.sha256(file.read_bytes()).hexdigest()


def test_an_older_build_does_not_replace_a_newer_one(view: Shown) -> None:
    session, number = view.session, view.session.state.number
    old = session._turn
    view.refresh()
    late: Any = type("Done", (), {"result": lambda _: {"error": "late", "document": {}}})()
    state = session.state
    session._take(old, b"", late)
    session._take_draft(old, late)
    session._take_remedies(old, late)
    assert session.state is state
    assert state.number > number


def test_saving_changes_the_number_and_nothing_else(view: Shown, file: Path) -> None:
    save(view.session, pair__module_mm=2.5, **{"pair.teeth[1]": 14, "pair.teeth[0]": 13})
    wanted = DESIGN.replace("2.0 ", "2.5 ").replace("[ 12 , 12 ]", "[ 13 , 14 ]")
    assert file.read_text() == wanted
    assert [path.name for path in file.parent.iterdir()] == [file.name]


def test_saving_keeps_line_ends_the_mark_and_the_mode(view: Shown, file: Path) -> None:
    content = b"\xef\xbb\xbf" + DESIGN.replace("\n", "\r\n").encode()
    file.write_bytes(content)
    file.chmod(0o640)
    view.refresh()
    save(view.session, pair__module_mm=3)
    assert file.read_bytes() == content.replace(b"2.0 ", b"3.0 ")
    assert file.stat().st_mode & 0o777 == 0o640


def test_saving_is_refused_where_the_file_has_changed_since(view: Shown, file: Path) -> None:
    file.write_text(DESIGN + "# mine\n")
    with pytest.raises(RequestError, match=r"nothing was written: .* has changed since"):
        save(view.session, pair__module_mm=2.5)
    assert file.read_text() == DESIGN + "# mine\n"


@pytest.mark.parametrize("value", [-1, 0, 1e9])
def test_saving_is_refused_where_no_design_would_be_left(
    view: Shown, file: Path, value: float
) -> None:
    with pytest.raises(
        RequestError, match=r"nothing was written: .*wheels.toml:10: pair.module_mm"
    ):
        save(view.session, pair__module_mm=value)
    assert file.read_text() == DESIGN


def test_saving_is_refused_where_the_file_has_gone(view: Shown, file: Path) -> None:
    file.unlink()
    with pytest.raises(RequestError, match="there is no such file"):
        save(view.session, pair__module_mm=2.5)
    assert not file.exists()


def test_saving_what_does_not_stand_in_the_file_is_refused(view: Shown, file: Path) -> None:
    for key in ("pair.x", "pair.teeth", "name", "pair"):
        with pytest.raises(RequestError):
            save(view.session, **{key: 1})
    assert file.read_text() == DESIGN


FOLLOWED = [
    ("law.ratios[1]", 0.41, {"law.ratios[0]": 1.59, "law.ratios[2]": 1.59}),
    ("law.ratios[0]", 1.61, {"law.ratios[1]": 0.39, "law.ratios[2]": 1.61}),
    ("pair.teeth[0]", 38, {"pair.teeth[1]": 38}),
    ("law.knots_deg[1]", 165.0, {}),
    ("pair.center_distance_mm", 190.5, {}),
]
"""A number of the nail machine, and what has to follow: by hand, as the cosine of two phases has
the mean of its ends, ratios[0] + ratios[1] = 2 closes it."""


@pytest.mark.parametrize(("key", "value", "others"), FOLLOWED)
def test_what_has_to_follow_follows(key: str, value: float, others: dict[str, float]) -> None:
    reply = json.loads(work.follow(NAIL.read_text(), str(NAIL), {key: value}, [key], False))
    assert reply["error"] == ""
    assert reply["changes"] == {key: value, **others}


def test_what_nothing_can_follow_is_refused_as_it_is_built() -> None:
    key = "blank.bore_diameter_mm[0]"
    reply = json.loads(work.follow(NAIL.read_text(), str(NAIL), {key: 200.0}, [key], False))
    assert "the bore reaches the root of the teeth" in reply["error"]
    assert "document" not in reply


def test_of_what_follows_the_cause_that_is_left_is_told() -> None:
    """The last ratio follows the first and the second closes the law, which then has no teeth."""
    key, followed = "law.ratios[0]", {"law.ratios[1]": 0.04, "law.ratios[2]": 1.96}
    reply = json.loads(work.follow(NAIL.read_text(), str(NAIL), {key: 1.96}, [key], False))
    assert reply["refused"]
    assert reply["changes"] == {key: 1.96, **followed}
    design = load(NAIL).with_(reply["changes"])
    with pytest.raises(InfeasibleError) as refused:
        _ = build(design).findings
    assert refused.value.what in " ".join(reply["error"].split())


def test_no_remedy_undoes_a_change() -> None:
    """The second ratio was moved: the law closes by the others, or by going back."""
    text = NAIL.read_text().replace("0.4", "0.43", 1)
    assert tomllib.loads(text)["law"]["ratios"] == [1.6, 0.43, 1.6]
    whole, kept = (work.seek(text, str(NAIL), old) for old in (None, {"law.ratios[1]": 0.4}))
    back = {"law.ratios[1]": 0.4}
    assert back in [one["changes"] for one in whole["found"]]
    assert kept["found"] == [one for one in whole["found"] if one["changes"] != back]
    assert "law.ratios[1] = 0.4" not in kept["lines"]


def test_small_teeth_are_drawn_with_their_own_chords() -> None:
    text = DESIGN.replace("2.0", "0.5")  # m/50 is finer than a draft's chords
    key = "pair.module_mm"
    reply = json.loads(work.follow(text, "a.toml", {key: 0.51}, [key], False))
    assert reply["error"] == ""


def test_the_newest_goes_next_and_who_waited_is_sent_off() -> None:
    newest, begun, go = _Newest(1), threading.Event(), threading.Event()
    found: dict[str, bytes | None] = {}

    def slow() -> bytes:
        begun.set()
        assert go.wait(SECONDS)
        return b"first"

    def ask(name: str, work: Any) -> threading.Thread:
        def run() -> None:
            found[name] = newest.run(work)

        thread = threading.Thread(target=run)
        thread.start()
        return thread

    first = ask("first", slow)
    assert begun.wait(SECONDS)
    second = ask("second", lambda: b"second")
    while newest._asked < 2:
        pass
    third = ask("third", lambda: b"third")
    second.join(SECONDS)
    assert found == {"second": None}
    go.set()
    first.join(SECONDS)
    third.join(SECONDS)
    assert found == {"first": b"first", "second": None, "third": b"third"}


def test_a_place_is_free_again_after_a_fault() -> None:
    newest = _Newest(1)
    for _ in range(2):
        with pytest.raises(ZeroDivisionError):
            newest.run(lambda: bytes(1 // 0))
    assert newest.run(lambda: b"good") == b"good"


def changes(one: Watch, times: int = 1) -> list[bool]:
    return [one.look()[0] for _ in range(times)]


def test_the_watch_sees_each_save_once(file: Path) -> None:
    one = Watch(str(file))
    assert changes(one, 3) == [True, False, False]
    file.write_text(DESIGN + "# a\n")
    assert changes(one, 3) == [True, False, False]
    os.utime(file)
    assert changes(one) == [False]
    assert one.look()[1] == file.read_bytes()


def test_the_watch_sees_a_save_of_the_same_size_and_time(file: Path) -> None:
    one = Watch(str(file))
    changes(one)
    time = file.stat().st_mtime_ns
    file.write_text(DESIGN.replace("2.0", "2.1"))
    os.utime(file, ns=(time, time))
    assert changes(one, 2) == [True, False]


def test_what_is_saved_while_the_watch_looks_is_not_missed(
    file: Path, monkeypatch: pytest.MonkeyPatch
) -> None:
    one = Watch(str(file))
    changes(one)
    read = watch._content

    def slow(name: str, most: int) -> bytes | None:
        content = read(name, most)
        monkeypatch.setattr(watch, "_content", read)
        file.write_text(DESIGN + "# second\n")
        return content

    file.write_text(DESIGN + "# first\n")
    monkeypatch.setattr(watch, "_content", slow)
    seen = [content for changed, content in (one.look() for _ in range(3)) if changed]
    assert seen[-1] == file.read_bytes()


def test_the_watch_looks_at_tables(tmp_path: Path) -> None:
    table, file = tmp_path / "measured.csv", tmp_path / "measured.toml"
    rows = (PROFILES / "measured.csv").read_text()
    table.write_text(rows)
    file.write_text((PROFILES / "measured.toml").read_text())
    one = Watch(str(file))
    assert changes(one, 2) == [True, False]
    table.write_text(rows + "# more\n")
    assert changes(one, 2) == [True, False]
    file.write_text("[bad")  # the tables stay those of the last that could be read
    assert changes(one, 2) == [True, False]
    table.unlink()
    assert changes(one, 2) == [True, False]
    table.write_text(rows)
    assert changes(one, 2) == [True, False]


def test_the_watch_waits_for_a_file_that_is_being_saved(file: Path) -> None:
    one = Watch(str(file))
    changes(one)
    file.write_text("")
    assert changes(one, 2) == [False, False]
    file.write_text(DESIGN)
    assert changes(one) == [False]
    file.unlink()
    assert changes(one, watch._GONE) == [False] * watch._GONE
    assert one.look() == (True, None)
    assert changes(one, 3) == [False, False, False]
    file.write_text(DESIGN)
    assert changes(one, 2) == [True, False]


def test_tables_are_named_beside_the_file_wherever_they_stand() -> None:
    text = 'a = [{file = "one.csv"}, {file = 3}]\nfile = ""\n[b.c]\nfile = "d/two.csv"\n'
    assert watch.tables(text.encode(), "x/y.toml", []) == ["x/one.csv", "x/d/two.csv"]
    assert watch.tables(b"[", "x", ["kept"]) == ["kept"]


def test_a_file_that_is_not_there_is_refused(tmp_path: Path) -> None:
    assert main(["view", str(tmp_path / "none.toml"), "--no-browser"]) == 2


def test_what_was_saved_reads_as_it_was_meant(view: Shown, file: Path) -> None:
    save(view.session, pair__face_width_mm=7.25)
    assert tomllib.loads(file.read_text())["pair"]["face_width_mm"] == 7.25
    assert view.refresh().sliders[-1]["value"] == 7.25


def test_a_session_refuses_before_there_is_a_design(tmp_path: Path) -> None:
    with shown(tmp_path / "x.toml") as made, pytest.raises(RequestError):
        made.session.save({"changes": {"a": 1}, "made": ""})
    with pytest.raises(DesignError):
        work.content_of(str(tmp_path / "x.toml"))
