"""Old keys are refused with the new ones, and `migrate` writes them and nothing else."""

from __future__ import annotations

import math
import os
import stat
from pathlib import Path

import pytest

from gearcam.cli import main
from gearcam.designs import load, loads
from gearcam.designs.migrate import migrate
from gearcam.errors import DesignError, Problem, WriteError
from gearcam.export.write import rewrite
from gearcam.kinds.cam.design import CamDesign
from gearcam.kinds.gear_pair.design import GearPairDesign
from helpers_cam_files import ROLLER

HEAD = """\
# a pair
kind = "gear-pair"
name = "good"
[law]
type = "constant"     # circular
[pair]
module_mm = 2
teeth = [40, 40]
"""


def problems(text: str) -> list[Problem]:
    with pytest.raises(DesignError) as caught:
        loads(text)
    return list(caught.value.problems)


FIRST = "kerf_mm = 0.15 under [output] for wheel 1"
SECOND = "kerf_mm = 0.1 under [output] for wheel 2"
EACH = "kerf_mm is one value, so build once for each wheel"
EITHER = "clearance_mm of 0 or more, or kerf_mm of 0 or more under [output]"


@pytest.mark.parametrize(
    ("value", "words", "kept"),
    [
        ("-0.05", "clearance_mm = 0.05 with clearance_bores = true", True),
        ("-1", "clearance_mm = 1 with clearance_bores = true", True),
        ("[-0.1, 0]", "clearance_mm = [0.1, 0] with clearance_bores = true", True),
        ("0.075", "kerf_mm = 0.15 under [output]", True),
        ("[0.075, 0.075]", "kerf_mm = 0.15 under [output]", True),
        ("0", "nothing: leave it out", True),
        ("[0.075, 0.05]", f"{FIRST} and {SECOND}: {EACH}", False),
        ("[0, 0.05]", f"{SECOND}: {EACH}", False),
        (
            "[-0.1, 0.05]",
            f"clearance_mm = [0.1, 0] with clearance_bores = true, and {SECOND}: {EACH}",
            False,
        ),
        *((value, EITHER, False) for value in ('"wide"', "true", "nan", "[1, 2, 3]")),
    ],
)
def test_the_old_key_is_refused_with_what_to_write(value: str, words: str, kept: bool) -> None:
    (found,) = problems(f"{HEAD}[blank]\nbore_diameter_mm = 8\noffset_mm = {value}\n")
    assert (found.line, found.key) == (11, "blank.offset_mm")
    assert found.message.startswith("is now clearance_mm (what is taken off the part) or output.")
    assert found.allowed == words
    assert found.hint == ("the command migrate writes it so" if kept else "")


def test_it_is_refused_beside_everything_else_that_is_wrong() -> None:
    text = f'{HEAD}[blank]\noffset_mm = -1\nbores = 3\nclearance_mm = -1\n[output]\nkerf_mm = "a"\n'
    found = {problem.key: problem for problem in problems(text)}
    assert set(found) == {
        "blank.offset_mm", "blank.bores", "blank.clearance_mm", "output.kerf_mm"
    }  # fmt: skip
    assert "blank.clearance_mm stands there already: keep one" in found["blank.offset_mm"].allowed


def test_the_old_word_for_overclosure_is_refused_with_the_new_one() -> None:
    (found,) = problems(f"{HEAD}[meshing]\nadvance_deg = 0.01\n")
    assert (found.line, found.key) == (10, "meshing.advance_deg")
    assert found.message == "is now overclosure_deg (its value is 0.01)"
    assert found.allowed == "overclosure_deg = 0.01"
    assert found.hint == "the command migrate writes it so"


@pytest.mark.parametrize(
    ("before", "after"),
    [
        (
            "# three\n[helix]\nsteps = 3  # even\noffset_mm = 1.5\n",
            "# three\n[steps]\ncount = 3  # even\noffset_mm = 1.5\n",
        ),
        ("[helix] # of it\nsteps = 3\n", "[steps] # of it\ncount = 3\n"),
        (
            "[helix]\nsteps = 3\n\n[steps]\noffset_mm = 2\n",
            "\n[steps]\noffset_mm = 2\ncount = 3\n",
        ),
    ],
)
def test_a_table_with_another_name_is_moved_with_its_comments(
    before: str, after: str, tmp_path: Path
) -> None:
    file = tmp_path / "old.toml"
    file.write_text(HEAD + before, encoding="utf-8")
    assert {problem.key.partition(".")[0] for problem in problems(HEAD + before)} == {"helix"}
    content, changes = migrate(str(file))
    assert content.decode() == HEAD + after
    assert changes[0] == "helix.steps -> count = 3 under [steps]"
    assert loads(content.decode()).steps.count == 3  # pyright: ignore


def test_a_table_in_braces_with_another_name_is_written_anew(tmp_path: Path) -> None:
    file = tmp_path / "old.toml"
    text = HEAD.replace("[law]", "helix = { steps = 3 }  # three\n[law]", 1)
    file.write_text(text, encoding="utf-8")
    made = migrate(str(file))[0].decode()
    assert "helix" not in made
    assert "# three" in made
    assert made.endswith("[steps]\ncount = 3\n")


def test_offsets_of_other_tables_are_what_they_were() -> None:
    design = loads(ROLLER)
    assert isinstance(design, CamDesign)
    assert design.follower.offset == 8.0


CASES = {
    "a line": (
        "[blank]  # x\n  offset_mm = -0.1   # for printing\n  bolts = 0\n",
        (
            "[blank]  # x\n  clearance_mm = 0.1   # for printing\n  clearance_bores = true\n"
            "  bolts = 0\n"
        ),
    ),
    "the last line": (
        "[blank]\noffset_mm=[-0.1,-0.2]",
        "[blank]\nclearance_mm = [0.1, 0.2]\nclearance_bores = true\n",
    ),
    "braces": (
        "blank = { offset_mm = -0.1, bolts = 0 }  # b\n[output]\n",
        "blank = { clearance_mm = 0.1, clearance_bores = true, bolts = 0 }  # b\n[output]\n",
    ),
    "dots": (
        "blank.offset_mm = -0.1 # c\nblank.bolts = 0\n",
        "blank.clearance_mm = 0.1 # c\nblank.clearance_bores = true\nblank.bolts = 0\n",
    ),
    "kerf": (
        (
            "[output]\n files = [\n  'csv',  # c\n ] # files\n\n# blank\n[blank]\n"
            "offset_mm = 0.05 # half\nbolts = 0\n"
        ),
        (
            "[output]\n files = [\n  'csv',  # c\n ] # files\n kerf_mm = 0.1\n\n# blank\n[blank]\n"
            "# half\nbolts = 0\n"
        ),
    ),
    "kerf without output": (
        "[blank]\noffset_mm = 0.05\nbolts = 0",
        "[blank]\nbolts = 0\n\n[output]\nkerf_mm = 0.1\n",
    ),
    "kerf in an empty table": (
        "[output]  # e\n[blank]\noffset_mm = 0.05\n",
        "[output]  # e\nkerf_mm = 0.1\n[blank]\n",
    ),
    "kerf in braces": (
        "output = { files = ['csv'] }\nblank = { bolts = 0, offset_mm = 0.05 }\n",
        "output = { files = ['csv'], kerf_mm = 0.1 }\nblank = { bolts = 0 }\n",
    ),
    "kerf in empty braces": (
        "output = {}\nblank = { offset_mm = 0.05, bolts = 0 }\n",
        "output = { kerf_mm = 0.1 }\nblank = { bolts = 0 }\n",
    ),
    "kerf with dots": (
        "output.files = ['csv']  # f\n[blank]\n\"offset_mm\" = +5e-2\n",
        "output.files = ['csv']  # f\noutput.kerf_mm = 0.1\n[blank]\n",
    ),
    "overclosure": (
        "[meshing]\nsteps = 90\n  advance_deg = -5e-3  # back\n",
        "[meshing]\nsteps = 90\n  overclosure_deg = -0.005  # back\n",
    ),
    "nothing": ("[blank]\noffset_mm = 0\nbolts = 0\n", "[blank]\nbolts = 0\n"),
}


def placed(text: str) -> str:
    """A design with a text: what stands before its first table goes above all tables."""
    lines = text.splitlines(keepends=True)
    first = next((k for k, line in enumerate(lines) if line[0] == "["), len(lines))
    return HEAD.replace("[law]", "".join(lines[:first]) + "[law]") + "".join(lines[first:])


@pytest.mark.parametrize("newline", ["\n", "\r\n"])
@pytest.mark.parametrize("mark", [b"", b"\xef\xbb\xbf"])
@pytest.mark.parametrize("name", CASES)
def test_a_file_is_rewritten_and_nothing_else_in_it_changes(
    name: str, newline: str, mark: bytes, tmp_path: Path
) -> None:
    old, new = CASES[name]
    file = tmp_path / "x.toml"
    file.write_bytes(mark + placed(old).replace("\n", newline).encode())
    content, changes = migrate(str(file))
    assert content == mark + placed(new).replace("\n", newline).encode()
    assert len(changes) == 1
    retired = "meshing.advance_deg" if name == "overclosure" else "blank.offset_mm"
    assert changes[0].startswith(f"{retired} -> ")
    file.write_bytes(content)
    assert migrate(str(file)) == (content, ())
    design = load(file)
    assert isinstance(design, GearPairDesign)
    taken = {"a line": (0.1, 0.1), "the last line": (0.1, 0.2), "braces": (0.1, 0.1)}
    expected = taken.get(name, (0.1, 0.1) if name == "dots" else (0.0, 0.0))
    assert design.blank.clearance == expected
    assert design.blank.clearance_bores == any(expected)
    assert design.output.kerf == (0.1 if name.startswith("kerf") else 0.0)
    back = math.radians(-0.005)
    assert (design.meshing.overclosure == pytest.approx(back)) == (name == "overclosure")


def test_a_cam_is_rewritten_too(tmp_path: Path) -> None:
    file = tmp_path / "x.toml"
    file.write_text(f"{ROLLER}[blank]\noffset_mm = -0.02\n")
    content, _ = migrate(str(file))
    assert content.decode() == f"{ROLLER}[blank]\nclearance_mm = 0.02\nclearance_bores = true\n"


def test_the_way_of_a_rack_is_its_travel_now(tmp_path: Path) -> None:
    text = HEAD.replace('"constant"', '"rack"').replace("[pair]", 'way = "3*phi1"  # y\n[pair]')
    (found,) = problems(text)
    assert (found.line, found.key) == (6, "law.way")
    assert found.message == 'is now travel: that of the rack (its value is "3*phi1")'
    assert found.allowed == 'travel = "3*phi1"'
    file = tmp_path / "x.toml"
    file.write_text(text)
    content, changes = migrate(str(file))
    assert content.decode() == text.replace("way =", "travel =")
    assert changes == ('law.way -> travel = "3*phi1"',)
    (other,) = problems(HEAD.replace("[pair]", 'way = "3*phi1"\n[pair]'))
    assert not other.message.startswith("is now")


@pytest.fixture
def files(tmp_path: Path) -> dict[str, Path]:
    texts = {
        "old": f"{HEAD}[blank]\noffset_mm = -0.1\n",
        "current": f"{HEAD}[blank]\nclearance_mm = 0.1\n",
        "by hand": f"{HEAD}[blank]\noffset_mm = [0.1, 0.2]\n",
        "wrong besides": f"{HEAD}[blank]\noffset_mm = -0.1\nbores = 2\n",
        "too much": f"{HEAD}[blank]\noffset_mm = 60\n",
        "no toml": "kind = ",
    }
    made = {name: tmp_path / f"{name.replace(' ', '_')}.toml" for name in texts}
    for name, file in made.items():
        file.write_text(texts[name])
    return made


@pytest.mark.parametrize(
    ("name", "code", "words"),
    [
        ("old", 0, "blank.offset_mm -> clearance_mm = 0.1 with clearance_bores = true"),
        ("current", 0, "nothing to change"),
        ("by hand", 2, "build once for each wheel"),
        ("wrong besides", 2, "blank.bores: unknown key"),
        ("too much", 2, "output.kerf_mm: 120 is out of range"),
        ("no toml", 2, "this value cannot be read"),
    ],
)
def test_the_command_says_what_it_did_or_leaves_the_file(
    name: str, code: int, words: str, files: dict[str, Path], capsys: pytest.CaptureFixture[str]
) -> None:
    file = files[name]
    before = file.read_bytes()
    assert main(["migrate", str(file)]) == code
    out, err = capsys.readouterr()
    assert words in (err if code else out)
    assert (file.read_bytes() == before) == (name != "old")
    assert [path for path in file.parent.iterdir() if path.suffix != ".toml"] == []
    if name == "wrong besides":
        assert f"{file}:11: blank.bores" in err
        assert "offset_mm:" not in err


def test_several_files_are_all_tried(
    files: dict[str, Path], capsys: pytest.CaptureFixture[str]
) -> None:
    assert main(["migrate", *(str(files[name]) for name in ("by hand", "old", "current"))]) == 2
    assert "3 files: 2 up to date, 1 refused" in capsys.readouterr().out
    assert "clearance_mm" in files["old"].read_text()


def test_permissions_and_links_stay(files: dict[str, Path], tmp_path: Path) -> None:
    file, link = files["old"], tmp_path / "link.toml"
    file.chmod(0o640)
    link.symlink_to(file)
    assert main(["migrate", str(link)]) == 0
    assert link.is_symlink()
    assert stat.S_IMODE(file.stat().st_mode) == 0o640
    assert "clearance_mm" in file.read_text()


def test_a_disk_that_refuses_leaves_the_file(
    files: dict[str, Path], monkeypatch: pytest.MonkeyPatch
) -> None:
    def full(*_: object) -> None:
        raise OSError(28, "No space left on device")

    before = files["old"].read_bytes()
    monkeypatch.setattr(os, "chmod", full)
    monkeypatch.setattr(Path, "replace", full)
    with pytest.raises(WriteError, match="No space left"):
        rewrite(files["old"], b"other")
    monkeypatch.undo()
    assert files["old"].read_bytes() == before
    assert not list(files["old"].parent.glob("*.tmp"))
