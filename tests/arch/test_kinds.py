"""A kind of design is one folder: nothing outside names one, and a new one works by being there."""

from __future__ import annotations

import ast
import json
import math
import re
import tomllib
from collections.abc import Iterable, Mapping
from pathlib import Path

import numpy as np
import pytest

import gearcam
from arch import rules
from gearcam import kinds
from gearcam.base.errors import DesignError, InfeasibleError
from gearcam.cli import main
from gearcam.designs import KINDS, loads
from gearcam.designs.schema import schema
from gearcam.designs.template import template
from gearcam.report.file import framed, report_files

TOY = Path(__file__).parents[1] / "toy_kinds"
HOME = rules.SOURCE / "kinds"
NAMES = sorted(folder.name for folder in HOME.iterdir() if (folder / "design.py").exists())
NAMED = re.compile(
    rf"""["'](?:{"|".join({*NAMES, *(name.replace("_", "-") for name in NAMES)})})["']"""
    rf"""|\bkinds\.(?:{"|".join(NAMES)})\b|\b(?:GearPair|Cam)(?:Design|Result)\b"""
)
"""A kind's name as a text of its own, its package, its classes."""


EXAMPLE = re.compile(r"\s*(?:>>>|\.\.\.) ")
"""A line of an example in a docstring, which users follow and the program does not."""


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
        if NAMED.search(line) and not EXAMPLE.match(line)
    ]
    assert named == []


def uses(folder: Path, others: Iterable[str]) -> tuple[set[str], list[str]]:
    """The other kinds that a kind imports or nests, and its imports of what is not public."""
    used, wrong, known = set(), [], tuple(others)
    for path in rules.python_files(folder):
        for node in ast.walk(rules.parse(path)):
            if isinstance(node, ast.ImportFrom):
                names = [f"{node.module}.{one.name}" for one in node.names]
            elif isinstance(node, ast.Import):
                names = [one.name for one in node.names]
            else:
                names = []
            for name in names:
                other, _, part = name.removeprefix("gearcam.kinds.").partition(".")
                if name.startswith("gearcam.kinds.") and other in known:
                    used.add(other)
                    wrong += [name] if not part.startswith("public.") else []
            if isinstance(node, ast.Call) and ast.unparse(node.func).endswith("nested"):
                named = {str(one.value) for one in node.args if isinstance(one, ast.Constant)}
                used |= {one.replace("-", "_") for one in named} & set(known)
    return used, wrong


def in_circles(used: Mapping[str, set[str]]) -> set[str]:
    """The kinds that use each other in a circle, and those that use one of them."""
    left = dict(used)
    while free := [name for name, below in left.items() if not below & left.keys()]:
        for name in free:
            del left[name]
    return set(left)


def test_kinds_use_the_public_parts_of_others_in_one_direction() -> None:
    homes = {name: HOME / name for name in NAMES}
    homes |= {folder.name: folder for folder in TOY.iterdir() if (folder / "design.py").exists()}
    found = {name: uses(home, homes.keys() - {name}) for name, home in homes.items()}
    assert {name: wrong for name, (_, wrong) in found.items() if wrong} == {}
    assert in_circles({name: used for name, (used, _) in found.items()}) == set()
    assert found["slider_crank"][0] == {"gear_pair", "cam"}


@pytest.mark.parametrize(
    ("line", "used", "wrong"),
    [
        ("from gearcam.kinds.cam.public import CamDesign", {"cam"}, 0),
        ("from gearcam.kinds.cam.result import CamResult", {"cam"}, 1),
        ("from gearcam.kinds.cam import forms", {"cam"}, 1),
        ("import gearcam.kinds.cam.shown", {"cam"}, 1),
        ("from gearcam.kinds.shared import AccuracySpec", set(), 0),
        ('x = quantities.nested("cam", doc="a cam")', {"cam"}, 0),
    ],
)
def test_the_use_of_another_kind_is_seen(
    tmp_path: Path, line: str, used: set[str], wrong: int
) -> None:
    (tmp_path / "design.py").write_text(line + "\n")
    found = uses(tmp_path, NAMES)
    assert (found[0], len(found[1])) == (used, wrong)


def test_a_circle_of_kinds_is_seen() -> None:
    assert in_circles({"a": {"b"}, "b": {"c"}, "c": set()}) == set()
    assert in_circles({"a": {"b"}, "b": {"c"}, "c": {"b"}, "d": set()}) == {"a", "b", "c"}


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
    html = report_files(result, {})["report.html"].decode()
    for part in ('id="parts"', 'href="#motion"', 'id="solids"', 'href="#accuracy"', "const CYCLE"):
        assert part not in html
    assert ('href="#charts"' in html) == bool(studies)
    assert "outer diameter" in html
    assert framed(result).startswith('<iframe title="thin"')


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


def slider_crank(drive: str, crank: float = 20, rod: float = 70, more: str = "") -> str:
    """The text of a slider-crank behind the file of a drive."""
    key = "pair" if "ellipse" in drive else "cam"
    return (
        f'kind = "slider-crank"\nname = "machine"\n[drive]\n{key} = "{drive}"\n'
        f"[crank]\nlength_mm = {crank}\n[rod]\nlength_mm = {rod}\n{more}"
    )


PROFILES = rules.ROOT / "profiles"


@pytest.mark.usefixtures("toy")
def test_a_kind_uses_another_and_its_slider_moves_as_by_hand() -> None:
    ellipse = PROFILES / "ellipse.toml"
    result = gearcam.build(loads(slider_crank(str(ellipse))))
    phi1 = np.linspace(0.0, 2.0 * np.pi, 37)
    along, rate, angle, _ = result.slide(np.degrees(phi1))
    turned = np.radians(gearcam.build(gearcam.load(ellipse)).motion(phi1)["phi2_deg"])
    expected = 20 * np.cos(turned) + np.sqrt(70**2 - (20 * np.sin(turned)) ** 2)
    assert along == pytest.approx(expected, abs=1e-9)
    assert 70 * np.sin(angle) == pytest.approx(-20 * np.sin(turned), abs=1e-9)
    step = 1e-5
    ahead, behind = (result.slide(np.degrees(phi1[1:-1] + s * step))[0] for s in (1, -1))
    assert rate[1:-1] == pytest.approx((ahead - behind) / (2 * step), abs=1e-6)
    assert result.facts["slider.stroke_mm"] == pytest.approx(40.0, abs=1e-3)


@pytest.mark.parametrize(
    "drive",
    [
        "ellipse.toml", "ring_ellipse.toml", "plate_cam_oscillating.toml", "eccentric_cam.toml",
        "translating_cam.toml", "groove_cam.toml", "cw",
    ],
)  # fmt: skip
@pytest.mark.usefixtures("toy")
def test_a_slider_crank_runs_behind_any_drive(drive: str, tmp_path: Path) -> None:
    file = PROFILES / drive
    if drive == "cw":  # the shaft of its follower is on the other side
        text = (PROFILES / "plate_cam_oscillating.toml").read_text("utf-8")
        file = tmp_path / "cw.toml"
        file.write_text(text.replace("[cam]", '[cam]\nrotation = "cw"'), "utf-8")
    result = gearcam.build(loads(slider_crank(str(file), 10, 200)))
    scene = result.scene(24)
    bodies = {body.name: body for body in scene.bodies}
    unit = np.radians(1.0) if scene.driver.endswith("deg") else 1.0
    step = 1e-4
    inner = scene.places[1:-1] + 1e-3 * np.ptp(scene.places)  # not at a knot
    ahead, behind = (result.slide(inner + s * step)[0] for s in (1, -1))
    expected = (ahead - behind) / (2 * step * unit)
    assert result.slide(inner)[1] == pytest.approx(expected, rel=1e-4, abs=1e-4)
    rod, slider = bodies["rod"], bodies["slider"]
    pin, end = rod.pose.shift, rod.pose.shift + 200 * np.exp(1j * rod.pose.turn)
    assert end == pytest.approx(slider.pose.shift, abs=1e-9)  # the rod joins the pin and the slider
    assert np.ptp(slider.pose.shift.imag) == 0.0
    carried = bodies["gear2" if "gear2" in bodies else "follower"]
    fixed = (pin - carried.pose.shift) * np.exp(-1j * carried.pose.turn)
    assert fixed == pytest.approx(np.full(25, fixed[0]), abs=1e-9)  # the pin moves with its carrier


def test_a_slider_crank_is_built_studied_and_refused_on_the_command_line(
    toy: Path, capsys: pytest.CaptureFixture[str]
) -> None:
    (toy / "ellipse.toml").write_bytes((PROFILES / "ellipse.toml").read_bytes())
    more = '[output]\nfiles = ["csv", "report"]\nstudies = ["slide"]\n'
    (toy / "machine.toml").write_text(slider_crank("ellipse.toml", more=more))
    assert main(["build", "machine.toml"]) == 0
    out = capsys.readouterr().out
    assert "slider-crank, stroke 40 mm" in out
    assert "drive.pair: pair" in out  # the finding of the nested design
    folder = toy / "output" / "machine"
    summary = json.loads((folder / "summary.json").read_text())
    assert summary["design"]["drive"]["pair"]["kind"] == "gear-pair"
    assert summary["stroke"]["rows"] == 361
    assert len((folder / "slider.csv").read_text().splitlines()) == 362
    page = (folder / "report.html").read_text()
    assert 'id="solids-view"' in page
    assert all(word in page for word in ('"crank"', '"rod"', '"slider"', "Rate of the slider"))
    assert main(["slide", "machine.toml", "--step", "10"]) == 0
    assert len((folder / "slider.csv").read_text().splitlines()) == 38
    capsys.readouterr()
    (toy / "short.toml").write_text(slider_crank("ellipse.toml", rod=15))
    assert main(["build", "short.toml"]) == 3
    told = capsys.readouterr().err
    assert "the rod is too short to reach the guide" in told
    assert "rod.length_mm = 20.2" in told
    wrong = (toy / "ellipse.toml").read_text().replace("eccentricity = 0.3", "eccentricity = 4")
    (toy / "ellipse.toml").write_text(wrong)
    assert main(["build", "machine.toml"]) == 2
    assert "ellipse.toml:6: law.eccentricity: 4 is out of range" in capsys.readouterr().err


@pytest.mark.usefixtures("toy")
def test_a_refusal_of_a_nested_design_has_its_place() -> None:
    design = loads(slider_crank(str(PROFILES / "ellipse.toml")))
    broken = design.with_(
        {"drive.pair.pair.teeth": [5, 5], "drive.pair.blank.bore_diameter_mm": 60}
    )
    with pytest.raises(InfeasibleError) as caught:
        _ = gearcam.build(broken).checked
    assert caught.value.where.startswith("drive.pair")
    assert all(
        key.startswith("drive.pair.") for way in caught.value.adjustments for key in way.near
    )


@pytest.mark.usefixtures("toy")
@pytest.mark.parametrize(
    ("changes", "key"),
    [
        pytest.param(  # more teeth
            {"law.eccentricity": 0.7, "pair.teeth": [12, 12]},
            "drive.pair.pair.teeth",
            marks=pytest.mark.slow,
        ),
        pytest.param(  # a finding
            {"pair.teeth": [9, 9], "rack.addendum": 0.7},
            "drive.pair.pair.teeth",
            marks=pytest.mark.slow,
        ),
        (
            {"blank.bore_diameter_mm": 60},
            "drive.pair.blank.bore_diameter_mm",
        ),  # as the refusal says
    ],
)
def test_remedies_of_a_nested_design_are_those_of_its_kind(
    changes: dict[str, object], key: str
) -> None:
    design = loads(slider_crank(str(PROFILES / "ellipse.toml")))
    broken = design.with_({f"drive.pair.{name}": value for name, value in changes.items()})
    result = gearcam.build(broken)
    remedies = gearcam.remedies(result)
    assert key in {name for remedy in remedies.found for name in remedy.changes}
    assert remedies.builds > 0
    for remedy in remedies.found:
        assert remedy.design == broken.with_(remedy.changes)
        findings = gearcam.build(remedy.design).checked
        assert "error" not in {finding.severity for finding in findings}
