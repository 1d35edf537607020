"""A build's files are written whole or not at all, and stale ones go."""

from __future__ import annotations

import errno
import json
import os
import resource
from pathlib import Path

import pytest

from gearcam.base.errors import WriteError
from gearcam.export.listing import listing
from gearcam.export.write import is_plain, rewrite, writing
from helpers_folder import put


def summary(*names: object) -> bytes:
    return json.dumps({"format": 1, "files": {str(name): "of a design" for name in names}}).encode()


def build(folder: Path, files: dict[str, bytes]) -> tuple[str, ...]:
    return put(folder, files).removed


def state(folder: Path) -> dict[str, bytes]:
    """Every file of a folder, hidden ones too."""
    return {place.name: place.read_bytes() for place in folder.iterdir() if place.is_file()}


def beside(folder: Path) -> dict[str, bytes]:
    """Every file of a folder but its summary, which is there."""
    found = state(folder)
    del found["summary.json"]
    return found


def test_files_are_written_into_a_new_folder(tmp_path: Path) -> None:
    folder = tmp_path / "a" / "b"
    assert build(folder, {"one.dxf": b"1", "two.csv": b"\x00\r\n"}) == ()
    assert beside(folder) == {"one.dxf": b"1", "two.csv": b"\x00\r\n"}
    assert list(listing(folder).made) == ["one.dxf", "two.csv"]


def test_files_have_ordinary_permissions(tmp_path: Path) -> None:
    build(tmp_path, {"one.dxf": b"1"})
    (tmp_path / "plain").write_bytes(b"")
    assert (tmp_path / "one.dxf").stat().st_mode == (tmp_path / "plain").stat().st_mode


def test_stale_files_are_removed_and_others_left(tmp_path: Path) -> None:
    build(tmp_path, {"one.dxf": b"1", "two.dxf": b"2", "three.stl": b"3"})
    (tmp_path / "mine.txt").write_bytes(b"keep")
    (tmp_path / "two.dxf").unlink()
    assert build(tmp_path, {"one.dxf": b"new"}) == ("three.stl",)
    assert beside(tmp_path) == {"one.dxf": b"new", "mine.txt": b"keep"}
    assert list(listing(tmp_path).made) == ["one.dxf"]


ELSEWHERE = ["../mine.txt", "/etc/hosts", "sub/mine.txt", "..", ".", "", ".hidden", 7, None]
STRANGE = {
    "empty": b"",
    "cut": b"{",
    "list": b"[]",
    "null": b"null",
    "number": b'{"format": 1, "files": 3}',
    "mapping": b'{"format": 1, "files": {"mine.txt": 1}}',
    "of another program": b'{"files": ["mine.txt"]}',
    "of another program, mapping": b'{"format": "x", "files": {"mine.txt": "1"}}',
    "no text": b"\xff\xfe",
    "deep": b"[" * 100_000,
    "elsewhere": summary(*ELSEWHERE),
    "names alone": json.dumps({"format": 1, "files": ["mine.txt"]}).encode(),
    "name too long": summary("a" * 5000),
}


@pytest.mark.parametrize("content", STRANGE.values(), ids=STRANGE)
def test_a_strange_summary_removes_nothing(tmp_path: Path, content: bytes) -> None:
    folder = tmp_path / "out"
    (folder / "sub").mkdir(parents=True)
    for place in (
        tmp_path / "mine.txt",
        folder / "mine.txt",
        folder / "sub" / "mine.txt",
        folder / ".hidden",
    ):
        place.write_bytes(b"keep")
    (folder / "summary.json").write_bytes(content)
    assert build(folder, {"one.dxf": b"1"}) == ()
    assert (tmp_path / "mine.txt").exists()
    assert (folder / "sub" / "mine.txt").exists()
    assert state(folder).keys() == {"one.dxf", "summary.json", "mine.txt", ".hidden"}


def test_stale_links_are_left_and_listed_no_more(tmp_path: Path) -> None:
    folder, outside = tmp_path / "out", tmp_path / "outside.txt"
    outside.write_bytes(b"1")
    build(folder, {"one.dxf": b"1", "link.dxf": b"1", "dangling.dxf": b"1", "folder": b"1"})
    for name in ("link.dxf", "dangling.dxf", "folder"):
        (folder / name).unlink()
    (folder / "link.dxf").symlink_to(outside)
    (folder / "folder").mkdir()
    (folder / "dangling.dxf").symlink_to(tmp_path / "nowhere")
    plan = put(folder, {"one.dxf": b"1"})
    assert (plan.removed, plan.kept) == ((), ("link.dxf", "dangling.dxf"))
    assert outside.read_bytes() == b"1"
    assert (folder / "folder").is_dir()
    assert (folder / "link.dxf").is_symlink()
    assert put(folder, {"one.dxf": b"1"}).kept == ()


def test_a_link_in_the_way_is_renamed_but_not_followed(tmp_path: Path) -> None:
    """Whatever it leads to: here the same content."""
    folder, outside = tmp_path / "out", tmp_path / "outside.txt"
    outside.write_bytes(b"1")
    folder.mkdir()
    (folder / "one.dxf").symlink_to(outside)
    build(folder, {"one.dxf": b"1"})
    assert outside.read_bytes() == b"1"
    assert (folder / "one.dxf").read_bytes() == b"1"
    assert not (folder / "one.dxf").is_symlink()
    assert (folder / "one.1.dxf").readlink() == outside


@pytest.mark.parametrize("error", [OSError(28, "No space left on device"), KeyboardInterrupt()])
@pytest.mark.parametrize("after", range(9))
@pytest.mark.parametrize("existing", [True, False])
def test_a_failure_at_any_move_leaves_everything_as_it_was(
    tmp_path: Path,
    monkeypatch: pytest.MonkeyPatch,
    error: BaseException,
    after: int,
    existing: bool,
) -> None:
    """Four files moved into place, before that three old ones and a stale one; one was edited."""
    folder = tmp_path / "out"
    before: dict[str, bytes] = {}
    if existing:
        build(folder, {"one.dxf": b"1", "two.dxf": b"2", "stale.dxf": b"s"})
        (folder / "two.dxf").write_bytes(b"mine")
        before = state(folder)
    real, calls = os.replace, []

    def failing(source: str, target: str) -> None:
        calls.append(target)
        if len(calls) == after + 1:
            raise error
        real(source, target)

    monkeypatch.setattr(os, "replace", failing)
    new = {"one.dxf": b"one", "two.dxf": b"two", "new.dxf": b"new"}
    moves = 8 if existing else 4
    if after >= moves:
        build(folder, new)
        mine = {"two.1.dxf": b"mine"} if existing else {}
        assert beside(folder) == {**new, **mine}
        return
    with pytest.raises((WriteError, KeyboardInterrupt)):
        build(folder, new)
    if existing:
        assert state(folder) == before
    else:
        assert not folder.exists()


def test_a_link_in_the_way_is_put_back_as_a_link(
    tmp_path: Path, monkeypatch: pytest.MonkeyPatch
) -> None:
    folder, outside = tmp_path / "out", tmp_path / "outside.txt"
    outside.write_bytes(b"keep")
    folder.mkdir()
    (folder / "one.dxf").symlink_to(outside)
    real = os.replace

    def failing(source: Path, target: Path) -> None:
        real(source, target)
        if target == folder / "two.dxf":
            raise KeyboardInterrupt

    monkeypatch.setattr(os, "replace", failing)
    with pytest.raises(KeyboardInterrupt):
        build(folder, {"one.dxf": b"1", "two.dxf": b"2"})
    assert (folder / "one.dxf").readlink() == outside
    assert [place.name for place in folder.iterdir()] == ["one.dxf"]


def test_the_summary_is_replaced_last(tmp_path: Path, monkeypatch: pytest.MonkeyPatch) -> None:
    build(tmp_path, {"one.dxf": b"1", "stale.dxf": b"s"})
    real, moved = os.replace, []

    def watching(source: Path, target: Path) -> None:
        moved.append(Path(source).name)
        real(source, target)

    monkeypatch.setattr(os, "replace", watching)
    build(tmp_path, {"one.dxf": b"1", "two.dxf": b"2"})
    assert moved == ["stale.dxf", "one.dxf", "one.dxf", "two.dxf", *["summary.json"] * 2]


def test_a_new_name_may_differ_from_a_stale_one_in_case_only(
    tmp_path: Path, monkeypatch: pytest.MonkeyPatch
) -> None:
    """Where case does not matter, both names are those of the same file, and the new one stays."""
    build(tmp_path, {"One.dxf": b"1"})
    real = os.path.lexists

    def lexists(place: Path) -> bool:
        lower = {path.name.lower() for path in Path(place).parent.iterdir()}
        return real(place) or Path(place).name.lower() in lower

    monkeypatch.setattr(os.path, "lexists", lexists)
    assert build(tmp_path, {"one.dxf": b"new"}) == ("One.dxf",)
    assert state(tmp_path).keys() == {"one.dxf", "summary.json"}


def test_a_disk_that_refuses_leaves_everything_as_it_was(tmp_path: Path) -> None:
    """A real refusal half way through the second file, by the limit of a file's size."""
    build(tmp_path, {"one.dxf": b"1"})
    before, limits = state(tmp_path), resource.getrlimit(resource.RLIMIT_FSIZE)
    resource.setrlimit(resource.RLIMIT_FSIZE, (100_000, limits[1]))
    try:
        with pytest.raises(WriteError, match=r"cannot write to .*two\.dxf: "):
            build(tmp_path, {"one.dxf": b"new", "two.dxf": bytes(200_000)})
    finally:
        resource.setrlimit(resource.RLIMIT_FSIZE, limits)
    assert state(tmp_path) == before


def test_a_file_in_place_of_the_folder(tmp_path: Path) -> None:
    (tmp_path / "out").write_bytes(b"keep")
    for folder in (tmp_path / "out", tmp_path / "out" / "deeper"):
        with pytest.raises(WriteError, match="cannot write to"):
            build(folder, {"one.dxf": b"1"})
    assert state(tmp_path) == {"out": b"keep"}


def test_a_folder_in_place_of_a_file(tmp_path: Path) -> None:
    (tmp_path / "two.dxf").mkdir()
    with pytest.raises(WriteError, match=r"two\.dxf: there is a folder of this name"):
        build(tmp_path, {"one.dxf": b"1", "two.dxf": b"2"})
    assert state(tmp_path) == {}


def test_a_folder_that_may_not_be_written(tmp_path: Path, monkeypatch: pytest.MonkeyPatch) -> None:
    if os.geteuid() == 0:  # the superuser may write everywhere: the disk says no by itself

        def deny(path: object, *_: object, **__: object) -> None:
            raise PermissionError(errno.EACCES, "Permission denied", str(path))

        monkeypatch.setattr(os, "mkdir", deny)
    tmp_path.chmod(0o500)
    try:
        with pytest.raises(WriteError, match=f"cannot write to {tmp_path}: Permission denied"):
            build(tmp_path, {"one.dxf": b"1"})
    finally:
        tmp_path.chmod(0o700)
    assert list(tmp_path.iterdir()) == []


@pytest.mark.parametrize(
    "name", ["", ".", "..", "a/b", "a\\b", "../x", "/x", "c:x", ".hidden", "a\0b"]
)
def test_names_that_are_not_plain_are_refused(tmp_path: Path, name: str) -> None:
    assert not is_plain(name)
    with pytest.raises(ValueError, match="plain"), writing(tmp_path) as replace:
        replace({name: b""})


def test_previous_files_are_those_that_are_there(tmp_path: Path) -> None:
    listed = {
        "format": 1,
        "files": {"a.dxf": "1", "gone.dxf": "1", "summary.json": "1", "wrong.dxf": 1},
        "outdated": {"b.dxf": "2", "c.dxf": None, "folder": "2"},
    }
    for name in ("a.dxf", "b.dxf", "c.dxf", "mine.txt", "wrong.dxf"):
        (tmp_path / name).write_bytes(b"")
    (tmp_path / "folder").mkdir()
    (tmp_path / "summary.json").write_text(json.dumps(listed), encoding="utf-8")
    assert listing(tmp_path).made == {"a.dxf": "1", "b.dxf": "2"}
    assert listing(tmp_path / "none").made == {}


def test_what_is_not_as_it_was_written_is_neither_removed_nor_written_over(tmp_path: Path) -> None:
    """Edited, edited and of the same size, not listed; and each of them when it is not made."""
    build(tmp_path, {"cut.dxf": b"12", "same.dxf": b"12", "ours.dxf": b"12", "stale.dxf": b"12"})
    mine = {"cut.dxf": b"1", "same.dxf": b"21", "other.dxf": b"12", "stale.dxf": b"21"}
    for name, content in mine.items():
        (tmp_path / name).write_bytes(content)
    new = {f"{name}.dxf": b"new" for name in ("cut", "same", "ours", "other")}
    plan = put(tmp_path, new)
    renamed = {name: name.replace(".", ".1.") for name in ("cut.dxf", "same.dxf", "other.dxf")}
    assert (plan.removed, plan.kept, plan.renamed) == ((), ("stale.dxf",), renamed)
    kept = {renamed.get(name, name): content for name, content in mine.items()}
    assert beside(tmp_path) == {**new, **kept}
    assert listing(tmp_path).made.keys() == listing(tmp_path).contents.keys() == new.keys()
    plan = put(tmp_path, dict.fromkeys(new, b"newer"))
    assert (plan.removed, plan.kept, plan.renamed) == ((), (), {})
    (tmp_path / "cut.dxf").write_bytes(b"mine")
    plan = put(tmp_path, {"cut.dxf": b"newest"})
    assert plan.removed == ("same.dxf", "ours.dxf", "other.dxf")
    assert plan.renamed == {"cut.dxf": "cut.2.dxf"}
    assert beside(tmp_path) == {"cut.dxf": b"newest", "cut.2.dxf": b"mine", **kept}


def test_the_same_content_again_moves_nothing(tmp_path: Path) -> None:
    build(tmp_path, {"one.dxf": b"1"})
    for name in ("one.dxf", "two.dxf"):
        (tmp_path / name).write_bytes(b"new")
    assert put(tmp_path, {"one.dxf": b"new", "two.dxf": b"new"}).renamed == {}
    assert build(tmp_path, {}) == ("one.dxf", "two.dxf")


def test_a_study_in_between_does_not_hide_what_was_edited(tmp_path: Path) -> None:
    """It leaves the others as they are, and knows of each what gearcam wrote."""
    build(tmp_path, {"one.dxf": b"1", "two.dxf": b"2", "three.dxf": b"3"})
    for name in ("one.dxf", "two.dxf"):
        (tmp_path / name).write_bytes(b"mine")
    for version in ("of a design", "of another"):
        assert put(tmp_path, {"forces.csv": b"4"}, version, keep=True).renamed == {}
    plan = put(tmp_path, {"one.dxf": b"new"}, "of another")
    assert (plan.removed, plan.kept) == (("three.dxf",), ("two.dxf",))
    assert plan.renamed == {"one.dxf": "one.1.dxf"}
    assert beside(tmp_path).keys() == {"one.dxf", "one.1.dxf", "two.dxf", "forces.csv"}


def test_what_an_earlier_version_wrote_may_have_been_edited(tmp_path: Path) -> None:
    """Its summary tells nothing about contents."""
    for name in ("one.dxf", "two.dxf"):
        (tmp_path / name).write_bytes(b"1")
    (tmp_path / "summary.json").write_bytes(summary("one.dxf", "two.dxf"))
    plan = put(tmp_path, {"one.dxf": b"new"})
    assert (plan.removed, plan.kept, plan.renamed) == ((), ("two.dxf",), {"one.dxf": "one.1.dxf"})
    assert build(tmp_path, {}) == ("one.dxf",)


def test_a_design_file_that_nobody_edited_is_replaced_but_not_removed(tmp_path: Path) -> None:
    put(tmp_path, {"fitted.toml": b"1"}, keep=True)
    assert put(tmp_path, {"one.dxf": b"1"}).kept == ()
    assert put(tmp_path, {"fitted.toml": b"2"}, keep=True).renamed == {}
    plan = put(tmp_path, {"one.dxf": b"1"}, "of another")
    assert (plan.removed, plan.kept) == ((), ("fitted.toml",))
    assert beside(tmp_path) == {"one.dxf": b"1", "fitted.toml": b"2"}


def test_of_a_link_the_file_is_rewritten_with_its_permissions(tmp_path: Path) -> None:
    file, link = tmp_path / "pair.toml", tmp_path / "link.toml"
    file.write_bytes(b"old")
    file.chmod(0o640)
    link.symlink_to(file)
    rewrite(link, b"new")
    assert link.is_symlink()
    assert (file.read_bytes(), file.stat().st_mode & 0o777) == (b"new", 0o640)
