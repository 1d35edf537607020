"""A kind of design is one folder: nothing outside names one, and a new one works by being there."""

from __future__ import annotations

import json
import math
import re
import tomllib
from pathlib import Path

import pytest

import gearcam
from arch import rules
from gearcam import kinds
from gearcam.base.errors import DesignError
from gearcam.cli import main
from gearcam.designs import KINDS, loads
from gearcam.designs.schema import schema
from gearcam.designs.template import template

TOY = Path(__file__).parents[1] / "toy_kinds"
HOME = rules.SOURCE / "kinds"
NAMES = sorted(folder.name for folder in HOME.iterdir() if (folder / "kind.py").exists())
NAMED = re.compile(
    rf"""["'](?:{"|".join({*NAMES, *(name.replace("_", "-") for name in NAMES)})})["']"""
    rf"""|\bkinds\.(?:{"|".join(NAMES)})\b|\b(?:GearPair|Cam)(?:Design|Result)\b"""
)
"""A kind's name as a text of its own, its package, its classes."""


def outside() -> list[Path]:
    return [path for path in rules.python_files(rules.SOURCE) if HOME not in path.parents]


def test_there_are_kinds() -> None:
    assert tuple(name.replace("_", "-") for name in NAMES) == tuple(KINDS)
    assert len(NAMES) >= 2


def test_no_kind_is_named_outside_its_folder() -> None:
    named = [
        f"{path.name}:{number}: {line.strip()}"
        for path in outside()
        for number, line in enumerate(path.read_text("utf-8").splitlines(), start=1)
        if NAMED.search(line)
    ]
    assert named == []


def test_kinds_do_not_know_each_other() -> None:
    for name in NAMES:
        others = "|".join(other for other in NAMES if other != name)
        for path in rules.python_files(HOME / name):
            assert not re.search(rf"\bkinds\.(?:{others})\b", path.read_text("utf-8")), path


@pytest.mark.parametrize(
    "line", ['if kind == "cam":', "from gearcam.kinds.gear_pair import build", "x: CamDesign"]
)
def test_a_name_would_be_seen(line: str) -> None:
    assert NAMED.search(line)


@pytest.fixture
def toy(monkeypatch: pytest.MonkeyPatch, tmp_path: Path) -> Path:
    """A folder to work in while one kind more is there."""
    monkeypatch.setattr(kinds, "__path__", [*kinds.__path__, str(TOY)])
    monkeypatch.chdir(tmp_path)
    return tmp_path


GOOD = 'kind = "spacer"\nname = "thin"\n[ring]\nbore_mm = 20\nwidth_mm = 2\n'


def test_another_kind_is_found_read_built_and_written(toy: Path) -> None:
    assert "spacer" in KINDS
    design = loads(GOOD)
    written = gearcam.build(design).write(toy, files=["csv", "outline-txt"])
    assert written.files == ("spacer.csv", "spacer.txt", "summary.json")
    assert written.summary["design"]["ring"] == {"bore_mm": 20.0, "width_mm": 2.0}
    assert written.summary["ring"]["outer_mm"] == 24.0
    rows = (toy / "thin" / "spacer.csv").read_text().splitlines()
    assert len(rows) == 91


@pytest.mark.usefixtures("toy")
def test_another_kind_has_messages_schema_and_a_template() -> None:
    with pytest.raises(DesignError) as caught:
        loads(GOOD.replace("width_mm", "widht_mm").replace("20", "200"))
    told = str(caught.value)
    assert "did you mean width_mm?" in told
    assert "from 0.001 to 100 mm" in told
    made = schema()
    assert "spacer" in made["properties"]["kind"]["enum"]
    assert made["$defs"]["spacer-ring"]["properties"]["bore_mm"]["minimum"] == 0.001
    document = tomllib.loads(template("spacer", "mine"))
    assert document == {"kind": "spacer", "name": "mine", "ring": {"bore_mm": 20}}


@pytest.mark.usefixtures("toy")
@pytest.mark.parametrize("studies", ["", '[output]\nstudies = ["weigh"]\n'])
def test_a_report_needs_no_scene_no_solids_and_no_charts(studies: str) -> None:
    result = gearcam.build(loads(GOOD + studies))
    html = result.files("report")["report.html"].decode()
    for part in ('id="parts"', 'href="#motion"', 'id="solids"', 'href="#accuracy"', "const CYCLE"):
        assert part not in html
    assert ('href="#charts"' in html) == bool(studies)
    assert "outer diameter" in html
    assert result._repr_html_().startswith('<iframe title="thin"')


def test_another_kind_works_on_the_command_line(
    toy: Path, capsys: pytest.CaptureFixture[str]
) -> None:
    assert main(["new", "spacer", "mine.toml"]) == 0
    assert main(["build", "mine.toml", "--only", "csv,outline-txt"]) == 0
    out = capsys.readouterr().out
    assert "spacer, bore 20 mm" in out
    assert "outer diameter  30 mm" in out
    assert main(["weigh", "mine.toml", "--density", "2.7"]) == 0
    folder = toy / "output" / "mine"
    rows = (folder / "weight.csv").read_text().split()
    assert float(rows[1]) == pytest.approx(2.7e-3 * 0.25 * math.pi * (30**2 - 20**2))
    assert json.loads((folder / "summary.json").read_text())["weight"]["mass_g_per_mm"] > 1.0
    assert main(["--help"]) == 0
    assert "Weigh a spacer." in capsys.readouterr().out
    (toy / "wide.toml").write_text(GOOD.replace("width_mm = 2", "width_mm = 30"))
    assert main(["build", "wide.toml"]) == 3
    assert "ring.width_mm = 20" in capsys.readouterr().err
    (toy / "pair.toml").write_text(template("gear-pair"))
    assert main(["weigh", "pair.toml"]) == 2
