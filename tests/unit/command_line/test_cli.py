"""The command line: exit codes, plain words, and nothing on the screen that was not asked for."""

from __future__ import annotations

import io
import json
import subprocess
import sys
from dataclasses import dataclass, field
from pathlib import Path
from typing import Any, ClassVar

import pytest

from gearcam.base.errors import InfeasibleError, WriteError
from gearcam.base.facts import Fact, Facts
from gearcam.base.findings import Finding
from gearcam.cli import main
from gearcam.designs import KINDS, load
from gearcam.kinds.gear_pair.design import GearPairDesign
from gearcam.results.advice import Remedies, Remedy
from helpers_processes import ENVIRONMENT

GOOD = """\
kind = "gear-pair"
name = "{name}"
[law]
type = "constant"
[pair]
module_mm = 2
teeth = [20, 20]
[output]
files = ["csv"]
"""


TREE = {"size_mm": Fact(40.0, "centre distance"), "module_mm": 2.0, "teeth": [20, 20]}


@dataclass
class BuildOutput:
    directory: Path
    files: tuple[str, ...] = ()
    removed: tuple[str, ...] = ()
    kept: tuple[str, ...] = ()
    facts: Facts = field(default_factory=lambda: Facts(TREE, list(TREE)))
    summary: dict[str, Any] = field(default_factory=dict)
    findings: tuple[Finding, ...] = ()
    former: dict[str, str] = field(default_factory=dict)
    interrupted: str = ""
    table: tuple[str, ...] = ()


CURED = Remedies(found=(Remedy(changes={"pair.x": 0.06}, design=None),))  # type: ignore[arg-type]


class Result:
    """Stands for the real job: does what the design's name says."""

    calls: ClassVar[list[tuple[Any, ...]]] = []

    def __init__(self, design: GearPairDesign) -> None:
        self.design = design
        self.outcome = design.name.partition("-")[0]

    @property
    def findings(self) -> tuple[Finding, ...]:
        made = {
            "error": Finding(
                code="tips", severity="error", message="too thin", value=0.1, unit="mm"
            ),
            "warning": Finding(
                code="undercut", severity="warning", message="Teeth are undercut.",
                value=4.92, limit=3.4259, relation="at most", unit="mm", where="gear 2",
            ),
        }  # fmt: skip
        if self.outcome == "warning":
            return (made["warning"],)
        return (made["error"], made["warning"]) if self.outcome == "error" else ()

    def _write(self, directory: str, names: tuple[str, ...]) -> BuildOutput:
        raised = {
            "impossible": InfeasibleError(
                "the phases do not close", where="law.ratios", value=350, limit=360, unit="deg",
                nearest="it closes with one of: a; b",
            ),
            "disk": WriteError("no space left"),
            "fault": ZeroDivisionError("division by zero"),
            "stop": KeyboardInterrupt(),
        }  # fmt: skip
        if self.outcome in raised:
            raise raised[self.outcome]
        folder = Path(directory) / self.design.name
        folder.mkdir(parents=True, exist_ok=True)
        for name in names:
            (folder / name).write_text("x" * 1234)
        return BuildOutput(folder, names, ("old.stl",), findings=self.findings)

    def write(self, directory: str, files: Any = None, progress: Any = None) -> BuildOutput:
        self.calls.append(("write", directory, files, progress))
        return self._write(directory, ("gear1_outline.csv", "summary.json"))

    def check(self, directory: str) -> BuildOutput:
        self.calls.append(("check", directory))
        return self._write(directory, ("summary.json",))


@pytest.fixture
def desk(tmp_path: Path, monkeypatch: pytest.MonkeyPatch) -> Path:
    monkeypatch.setattr("gearcam.commands.build", Result)
    monkeypatch.setattr("gearcam.commands.remedies", lambda *_: CURED)
    monkeypatch.chdir(tmp_path)
    monkeypatch.delenv("GEARCAM_DEBUG", raising=False)
    Result.calls.clear()
    return tmp_path


def design(name: str) -> str:
    file = f"{name}.toml"
    Path(file).write_text(GOOD.format(name=name), encoding="utf-8")
    return file


@pytest.mark.parametrize(
    ("outcome", "code"),
    [
        *(("good", 0), ("warning", 0), ("error", 1), ("disk", 2), ("impossible", 3)),
        *(("fault", 4), ("stop", 130)),
    ],
)
@pytest.mark.parametrize("command", ["build", "check"])
@pytest.mark.usefixtures("desk")
def test_every_outcome_has_its_exit_code(command: str, outcome: str, code: int) -> None:
    assert main([command, design(outcome)]) == code


def test_all_files_are_tried_and_the_largest_code_is_returned(
    desk: Path, capsys: pytest.CaptureFixture[str]
) -> None:
    (desk / "bad.toml").write_text("kind = 3\n[law]\n[pair]\n")
    files = [design("impossible"), "bad.toml", design("error"), design("good")]
    assert main(["build", *files]) == 3
    assert (desk / "output" / "good" / "summary.json").exists()
    out, err = capsys.readouterr()
    assert "4 files: 2 built, 2 refused" in out
    assert err.index("impossible.toml: cannot be made") < err.index("bad.toml: ")
    assert main(["build", "bad.toml", design("fault"), design("good")]) == 4
    capsys.readouterr()
    assert main(["build", design("fault"), design("stop"), design("good-2")]) == 130
    assert "interrupted: no file was left half-written" in capsys.readouterr().err
    assert not (desk / "output" / "good-2").exists()


def test_a_refused_file_prints_its_problems_to_stderr_and_nothing_else(
    desk: Path, capsys: pytest.CaptureFixture[str]
) -> None:
    (desk / "bad.toml").write_text(GOOD.format(name="x").replace("module_mm", "module"))
    assert main(["build", "bad.toml"]) == 2
    out, err = capsys.readouterr()
    assert out == ""
    assert "bad.toml: 1 problem, nothing was built" in err
    assert "bad.toml:6: pair.module: unknown key (its value is 2)" in err
    assert "did you mean module_mm?" in err
    assert not (desk / "output").exists()
    assert "Traceback" not in err


@pytest.mark.parametrize("name", ["none.toml", ".", "latin.toml"])
def test_a_file_that_cannot_be_read_is_code_2(
    desk: Path, name: str, capsys: pytest.CaptureFixture[str]
) -> None:
    (desk / "latin.toml").write_bytes(b"\xff")
    assert main(["build", name]) == 2
    assert "Traceback" not in capsys.readouterr().err


@pytest.mark.usefixtures("desk")
def test_what_was_built_is_told_with_sizes_time_and_findings(
    capsys: pytest.CaptureFixture[str],
) -> None:
    assert main(["build", design("error"), "-o", "there"]) == 1
    out, err = capsys.readouterr()
    assert err == ""
    lines = out.splitlines()
    assert lines[0].startswith("error.toml: built in ")
    assert lines[1] == "  centre distance 40 mm, module 2 mm, teeth 20 : 20"
    table = lines[3:7:2]
    assert table == [
        "    error    tips              0.1 mm",
        "    warning  undercut  gear 2  4.92 mm  at most 3.4259 mm",
    ]
    assert lines[6] == "        Teeth are undercut."
    assert f"  written to {Path('there/error')}" in lines
    assert "    gear1_outline.csv     1.2 kB" in lines
    assert any(line.startswith("    old.stl") and "removed" in line for line in lines)


@pytest.mark.usefixtures("desk")
def test_an_unknown_key_is_answered_first_with_the_likely_one(
    capsys: pytest.CaptureFixture[str],
) -> None:
    Path("slip.toml").write_text(f"{GOOD.format(name='slip')}[blank]\nbore_mm = 1\n", "utf-8")
    assert main(["build", "slip.toml"]) == 2
    meant, allowed, *rest = capsys.readouterr().err.splitlines()[2:]
    assert meant == "      did you mean bore_diameter_mm?"
    assert allowed.startswith("      allowed: bore_diameter_mm, shaft, keyway, ")
    assert rest
    assert max(map(len, (allowed, *rest))) < 100
    assert all(line.startswith(" " * 10) for line in rest)


@pytest.mark.usefixtures("desk")
def test_an_impossible_design_tells_numbers_and_the_way_out(
    capsys: pytest.CaptureFixture[str],
) -> None:
    assert main(["build", design("impossible")]) == 3
    err = capsys.readouterr().err
    for words in (
        "the phases do not close",
        "value 350 deg, limit 360 deg",
        "\n  b\n",
        "this change was built without errors:\n    pair.x = 0.06\n",
    ):
        assert words in err


@pytest.mark.usefixtures("desk")
def test_a_fault_of_the_program_hides_its_traceback_until_asked(
    capsys: pytest.CaptureFixture[str], monkeypatch: pytest.MonkeyPatch
) -> None:
    file = design("fault")
    assert main(["build", file]) == 4
    err = capsys.readouterr().err
    assert "bug in gearcam" in err
    assert "ZeroDivisionError" in err
    assert "report" in err
    assert "Traceback" not in err
    assert main(["build", "--debug", file]) == 4
    assert "Traceback" in capsys.readouterr().err
    monkeypatch.setenv("GEARCAM_DEBUG", "1")
    assert main(["build", file]) == 4
    assert "Traceback" in capsys.readouterr().err


@pytest.mark.usefixtures("desk")
def test_only_overrides_the_files_of_the_design(capsys: pytest.CaptureFixture[str]) -> None:
    file = design("good")
    assert main(["build", file, "--only", "dxf, csv", "--only", "csv"]) == 0
    assert main(["build", file]) == 0
    assert [call[2] for call in Result.calls] == [("dxf", "csv"), None]
    capsys.readouterr()
    Result.calls.clear()
    assert main(["build", file, "--only", "dfx"]) == 2
    assert "did you mean dxf?" in capsys.readouterr().err
    assert main(["build", file, "--only", ","]) == 2
    assert Result.calls == []


def test_two_designs_of_one_name_do_not_overwrite_each_other(
    desk: Path, capsys: pytest.CaptureFixture[str]
) -> None:
    first = design("good")
    (desk / "copy.toml").write_text(GOOD.format(name="GOOD"))
    assert main(["build", first, "copy.toml"]) == 2
    assert 'name: the design of good.toml has the same name, "GOOD"' in capsys.readouterr().err
    assert main(["build", first, first]) == 0


@pytest.mark.usefixtures("desk")
def test_no_progress_is_drawn_where_nobody_looks() -> None:
    assert main(["build", design("good")]) == 0
    assert Result.calls[0][3] is None
    assert "rich" not in sys.modules or not hasattr(sys.stderr, "isatty") or not sys.stderr.isatty()


@pytest.mark.usefixtures("desk")
def test_progress_is_drawn_on_a_terminal(monkeypatch: pytest.MonkeyPatch) -> None:
    monkeypatch.setattr(sys.stderr, "isatty", lambda: True, raising=False)
    assert main(["build", design("good")]) == 0
    advance = Result.calls[0][3]
    assert callable(advance)


@pytest.mark.parametrize(
    "arguments",
    [["build"], ["bild"], ["build", "--no-such"], ["new"], ["new", "x"], []],
)
def test_wrong_usage_is_code_2(arguments: list[str], capsys: pytest.CaptureFixture[str]) -> None:
    assert main(arguments) == 2
    out, err = capsys.readouterr()
    assert out + err
    assert "Traceback" not in err


def test_help_and_version_are_good(capsys: pytest.CaptureFixture[str]) -> None:
    assert main(["--help"]) == 0
    assert main(["build", "--help"]) == 0
    out = capsys.readouterr().out
    assert out.isascii()
    assert all(name in "".join(out.split()) for kind in KINDS.values() for name in kind.formats)


def test_new_writes_a_design_that_reads_and_overwrites_nothing(
    desk: Path, capsys: pytest.CaptureFixture[str]
) -> None:
    assert main(["new", "gear-pair", "räder 1.toml"]) == 0
    assert load("räder 1.toml").name == "my_gear_pair"
    assert main(["new", "gear-pair", "mine.toml"]) == 0
    assert load("mine.toml").name == "mine"
    (desk / "mine.toml").write_text("precious")
    capsys.readouterr()
    assert main(["new", "gear-pair", "mine.toml"]) == 2
    assert "not overwritten" in capsys.readouterr().err
    assert (desk / "mine.toml").read_text() == "precious"
    assert main(["new", "gear-pair", "no/such/folder.toml"]) == 2
    assert main(["new", "gear-pair"]) == 0
    Path("printed.toml").write_text(
        capsys.readouterr().out.rpartition("# A pair")[2].join(["# ", ""])
    )
    assert load("printed.toml")


def test_the_new_design_builds_and_only_a_note_is_found(
    tmp_path: Path, monkeypatch: pytest.MonkeyPatch, capsys: pytest.CaptureFixture[str]
) -> None:
    monkeypatch.chdir(tmp_path)
    assert main(["new", "gear-pair", "mine.toml"]) == 0
    assert main(["build", "mine.toml", "--only", "csv"]) == 0
    out = capsys.readouterr().out
    assert "warning" not in out
    summary = json.loads((tmp_path / "output" / "mine" / "summary.json").read_text("utf-8"))
    assert {finding["severity"] for finding in summary["findings"]} <= {"note"}
    for name in summary["files"]:
        assert name in out


@pytest.mark.usefixtures("desk")
def test_new_knows_every_kind_and_what_was_meant(capsys: pytest.CaptureFixture[str]) -> None:
    for kind in KINDS:
        assert main(["new", kind, f"{kind}.toml"]) == 0
        assert load(f"{kind}.toml").kind == kind
    assert main(["new", "gearpair"]) == 2
    assert "did you mean gear-pair?" in capsys.readouterr().err


def test_schema_is_json(capsys: pytest.CaptureFixture[str]) -> None:
    assert main(["schema"]) == 0
    out = capsys.readouterr().out
    assert out.isascii()
    made = json.loads(out)
    assert made["$schema"].endswith("2020-12/schema")
    for name, kind in KINDS.items():
        files = made["$defs"][f"{name}-output"]["properties"]["files"]
        assert files["items"]["enum"] == list(kind.formats)


def test_the_module_runs_as_a_command_and_a_poor_terminal_is_no_fault(tmp_path: Path) -> None:
    file = tmp_path / "räder.toml"
    file.write_text('kind = "gear-pair"\nname = "rä der"\n', encoding="utf-8")
    done = subprocess.run(
        [sys.executable, "-m", "gearcam", "build", file.name],
        cwd=tmp_path,
        env={**ENVIRONMENT, "PYTHONIOENCODING": "ascii", "PYTHONUTF8": "0"},
        capture_output=True,
        text=True,
        check=False,
    )
    assert done.returncode == 2
    assert "r\\xe4der.toml" in done.stderr
    assert done.stdout == ""


def test_a_poor_terminal_is_no_fault_of_what_is_written(
    desk: Path, monkeypatch: pytest.MonkeyPatch
) -> None:
    shown = io.BytesIO()
    monkeypatch.setattr(sys, "stdout", io.TextIOWrapper(shown, encoding="ascii"))
    assert main(["new", "gear-pair", "ä.toml"]) == 0
    assert shown.getvalue().startswith(b"\\xe4.toml: written")
    assert (desk / "ä.toml").is_file()


def test_a_reader_that_leaves_early_is_no_fault(tmp_path: Path) -> None:
    process = subprocess.Popen(
        [sys.executable, "-m", "gearcam", "laws"],
        cwd=tmp_path,
        env=ENVIRONMENT,
        stdout=subprocess.PIPE,
        stderr=subprocess.PIPE,
    )
    assert process.stdout
    assert process.stderr
    process.stdout.close()
    complaint = process.stderr.read()
    process.stderr.close()
    assert process.wait() == 0
    assert complaint == b""


def test_a_study_of_several_kinds_has_the_options_of_each(
    capsys: pytest.CaptureFixture[str],
) -> None:
    main(["dynamics", "--help"])
    rows = capsys.readouterr().out.splitlines()
    for option in ("--train-stiffness", "--damping-ratio", "--inertia", "--run"):
        assert len([row for row in rows if row.startswith(f"  {option} ")]) == 1
    told = " ".join(" ".join(rows).split())
    assert "--turns N cam: largest number" in told
    assert "; gear-pair or mechanism: number of turns" in told
