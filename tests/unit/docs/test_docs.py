"""What the pages in docs/ show of commands and of Python is what the program prints now."""

from __future__ import annotations

import math
import os
import re
import shlex
import shutil
import subprocess
import sys
import tomllib
import types
from collections.abc import Collection, Iterator
from functools import partial
from pathlib import Path
from typing import Any

import numpy as np
import pytest

import gearcam
from arch import rules
from claims.laws import LAW_CLAIMS
from claims.motion import MOTION_CLAIMS
from gearcam.base.tolerances import DEFAULT
from gearcam.cli import main
from gearcam.designs import KINDS
from gearcam.laws.motion import MOTION_LAWS
from gearcam.laws.ratio import LAWS
from gearcam.laws.ratio.span import Lobes
from helpers_built import built
from helpers_sampling import chosen, few
from helpers_tables import law_table, phase_table, rise_table, turn_tables
from random_designs.law_draw import LawDraw
from random_designs.laws import parameters, random_law, random_motion_law

PAGES = [rules.ROOT / "README.md", *sorted((rules.ROOT / "docs").glob("*.md"))]
FENCE = re.compile(r"^```(\w+)\n(.*?)^```$", re.DOTALL | re.MULTILINE)
SUMMARY = (rules.ROOT / "docs" / "summary.md").read_text("utf-8")
NAMED = ("design", "files", "how", "solved", "outdated", "contents", "timings_s", "versions")
"""Keys of the summary whose entries are names, not keys."""
LONG = {"start.md", "gear-pairs.md"}
SHOWN = [page for page in PAGES if "\n```console\n" in page.read_text("utf-8")]


def like(shown: str, printed: str) -> bool:
    """Whether a text is as shown; a line of dots stands for any lines, times may differ."""
    lines = [line.rstrip() for line in printed.splitlines()]
    pieces: list[list[str]] = [[]]
    for line in shown.splitlines():
        if line.strip() == "...":
            pieces.append([])
        else:
            timed = re.sub(r"\d+\\\.\d+\\ s\b", r"[\\d.]+ s", re.escape(line.rstrip()))
            pieces[-1].append(timed)
    at = 0
    for number, piece in enumerate(pieces):
        last = len(lines) - len(piece)
        first = last if number and number == len(pieces) - 1 else at
        starts = range(first, last + 1 if number else 1)
        found = [k for k in starts if all(map(re.fullmatch, piece, lines[k : k + len(piece)]))]
        if not found or last < at:
            return False
        at = found[0] + len(piece)
    return at == len(lines)


def commands(block: str) -> list[tuple[str, str]]:
    """Commands of a console block, each with the output shown below it."""
    pieces = re.split(r"^\$ ", block, flags=re.MULTILINE)
    assert not pieces[0]
    return [(line, shown) for line, _, shown in (piece.partition("\n") for piece in pieces[1:])]


def run_page(text: str, capsys: pytest.CaptureFixture[str]) -> list[tuple[str, str, str]]:
    """Run a page's commands in order: each with what the page shows and what was printed.

    A TOML block that begins with ``# NAME.toml`` is the file of that name from there on.
    """
    answers = []
    for language, block in FENCE.findall(text):
        name = re.match(r"# (\S+\.toml)\n", block)
        if language == "toml" and name:
            Path(name[1]).write_text(block, "utf-8")
        if language == "console":
            for line, shown in commands(block):
                program, *arguments = shlex.split(line)
                assert program == "gearcam", line
                capsys.readouterr()
                main(arguments)
                answers.append((line, shown, "".join(capsys.readouterr())))
    return answers


@pytest.mark.parametrize(
    "page",
    chosen(SHOWN, *(one for one in SHOWN if one.name not in LONG)),
    ids=lambda page: page.name,
)
def test_commands_print_what_is_shown(
    page: Path,
    tmp_path: Path,
    monkeypatch: pytest.MonkeyPatch,
    capsys: pytest.CaptureFixture[str],
) -> None:
    (tmp_path / "profiles").symlink_to(rules.ROOT / "profiles")
    monkeypatch.chdir(tmp_path)
    answers = run_page(page.read_text("utf-8"), capsys)
    assert answers
    for line, shown, printed in answers:
        assert like(shown, printed), f"{line}\n{printed}"


def test_another_answer_is_seen(
    tmp_path: Path, monkeypatch: pytest.MonkeyPatch, capsys: pytest.CaptureFixture[str]
) -> None:
    monkeypatch.chdir(tmp_path)
    text = "```console\n$ gearcam new gear-pair x.toml\nx.toml: written; ...\n```\n"
    ((_, shown, printed),) = run_page(text, capsys)
    assert printed.startswith("x.toml: ")
    assert not like(shown, printed)
    assert like("a\n...\nbuilt in 0.2 s\n", "a\nb\nc\nbuilt in 1.31 s\n")
    assert not like("a\n...\nbuilt in 0.2 mm\n", "a\nb\nc\nbuilt in 1.31 mm\n")


def keys(document: Any) -> Iterator[str]:
    """Every key of a document, lists of entries included; walls have names, not keys."""
    if isinstance(document, dict):
        for key, value in document.items():
            yield key
            yield from keys(value) if key not in NAMED else ()
    elif isinstance(document, list):
        for value in document:
            yield from keys(value)


def unknown(summary: dict[str, Any], page: str) -> set[str]:
    """Keys of a summary that a page does not name."""
    names = set(re.findall(r"\w+", " ".join(re.findall(r"`([^`]+)`", page))))
    walls = r"(?:inner|outer|lower|upper|relief|1|2)_"
    parts = {*summary.get("solids", {}), *summary["accuracy"].get("dxf_mm", {})}
    own = summary.get("precision", {}).get("outputs", {})  # names of the design's own
    parts |= {*summary.get("forces", {}).get("joints", {}), *own}
    parts |= {name for one in own.values() for name in one["dimensions"]}
    balance = summary.get("balance", {})
    parts |= {*balance.get("counterweights", {}), *balance.get("rotors", {})}
    found = {re.sub(f"^{walls}", "", key) for key in keys(summary)} - parts
    units = {key: re.sub(r"per_mm(\d?)$", r"per_rad\1", key) for key in found}
    return {key for key, name in units.items() if not {key, name.replace("deg", "mm")} & names}


@pytest.mark.parametrize(
    "name",
    few([
        "shop_order", "ring_ellipse", "stepped_ellipse", "undercut_cam", "feeder",
        "nail_machine_two_phase", "plate_cam_offset_roller", "measured_cam", "groove_cam",
        "conjugate_cams", "yoke_cam", "translating_cam", "valve_lever",
    ]),
)  # fmt: skip
def test_every_key_of_the_summary_is_described(name: str, tmp_path: Path) -> None:
    result = built(rules.ROOT / "profiles" / f"{name}.toml")
    files = ["dxf", "csv", "stl"] if name in {"ring_ellipse", "plate_cam_offset_roller"} else []
    written = result.write(tmp_path, files=files)
    assert unknown(written.summary, SUMMARY) == set()


STUDIES: dict[tuple[str, str], tuple[str, dict[str, Any]]] = {
    ("gear-pair", "mesh"): ("ellipse", {"meshing.steps": 24}),
    ("gear-pair", "forces"): ("loaded_nail_machine", {"forces.steps": 24}),
    ("gear-pair", "stress"): (
        "circular",
        {
            "load": [{"torque_nm": 5}],
            "pair.teeth": [14, 14],
            "stress.phases": 12,
            "stress.wheel": 1,
        },
    ),
    ("gear-pair", "dynamics"): ("loaded_nail_machine", {"dynamics.inertia_kg_m2": 0.2}),
    ("gear-pair", "errors"): ("ellipse", {"errors.steps": 24}),
    ("cam", "forces"): ("valve_lever", {"forces.steps": 24}),
    ("cam", "dynamics"): ("elastic_valve_train", {"drive.speed_rpm": 1200, "dynamics.turns": 2}),
    ("cam", "follow"): ("tappet", {"follow.file": "profile.csv"}),
    ("cam", "precision"): ("plate_cam_offset_roller", {}),
    ("spatial-cam", "developed"): ("cylinder_cam", {"developed.steps": 24}),
    ("spatial-cam", "forces"): ("carton_pusher", {"forces.steps": 24}),
    ("globoidal-cam", "forces"): (
        "rotary_table",
        {"forces.steps": 24, "output.wall_step_deg": 3},
    ),
    ("mechanism", "torque"): ("nail_machine_slide", {"compare": []}),
    ("mechanism", "dynamics"): ("nail_machine_flywheel", {}),
    ("mechanism", "balance"): (
        "quick_return",
        {
            "mass": [{"of": "crank", "mass_kg": 2, "at_mm": [10, 0]}],
            "balance": {"counterweights": ["crank"], "radius_mm": 30},
            "rotor": [
                {
                    "name": "shaft",
                    "parts": ["crank"],
                    "places_mm": [10],
                    "planes_mm": [0, 40],
                    "radius_mm": 30,
                }
            ],
        },
    ),
    ("mechanism", "precision"): (
        "four_bar",
        {"precision.length_tolerance_mm": 0.1, "precision.trials": 2},
    ),
    ("mechanism", "forces"): (
        "nail_machine_slide",
        {"compare": [], "friction.guide": 0.1, "forces.steps": 24},
    ),
}
"""A design for each study, and what is changed in it."""


def test_every_study_but_accuracy_has_a_design() -> None:
    every = {(kind.name, study) for kind in KINDS.values() for study in kind.studies}
    assert set(STUDIES) == {one for one in every if one[1] != "accuracy"}


@pytest.mark.parametrize("case", STUDIES, ids=lambda case: case[1])
def test_every_key_of_studies_is_described(
    case: tuple[str, str], tmp_path: Path, monkeypatch: pytest.MonkeyPatch
) -> None:
    kind, name = case
    profile, changes = STUDIES[case]
    design = gearcam.load(rules.ROOT / "profiles" / f"{profile}.toml")
    monkeypatch.chdir(tmp_path)
    if name == "follow":
        Path("profile.csv").write_bytes(gearcam.build(design).files("csv")["profile.csv"])
    written = gearcam.build(design.with_(changes)).study(name).write(tmp_path)
    group = written.summary[KINDS[kind].studies[name].key]
    assert group
    assert unknown({"accuracy": {}, name: group}, SUMMARY) == set()
    if name == "mesh":
        rows = (tmp_path / profile / "meshing.csv").read_text("ascii")
        assert [one for one in rows.split("\n")[0].split(",") if f"`{one}`" not in SUMMARY] == []


def test_a_key_that_is_not_described_is_seen() -> None:
    assert unknown({"accuracy": {}, "new_key": 1}, SUMMARY) == {"new_key"}


GUIDE = (rules.ROOT / "docs" / "contributing.md").read_text("utf-8")
BLOCKS = [block for language, block in FENCE.findall(GUIDE) if language == "python"]
"""What docs/contributing.md adds: a ratio law and its claims, a motion law and its claims."""


def _added(name: str, number: int, monkeypatch: pytest.MonkeyPatch) -> Any:
    """A law of the guide with its claims: a module in which its registry finds it."""
    registry, known = ((LAWS, LAW_CLAIMS), (MOTION_LAWS, MOTION_CLAIMS))[number // 2]
    module = types.ModuleType(name)
    monkeypatch.setitem(sys.modules, name, module)
    for block in BLOCKS[number : number + 2]:
        exec(compile(block, "law.py", "exec"), vars(module))
    homes = {**registry._homes, **{one.name: name for one in module.ENTRIES}}
    monkeypatch.setattr(registry, "_homes", homes)
    monkeypatch.setattr(registry, "_entries", {**registry})
    (added,) = module.CLAIMS
    assert [*registry][-1] == added
    monkeypatch.setitem(known, added, module.CLAIMS[added])
    return module


@pytest.fixture
def joint(monkeypatch: pytest.MonkeyPatch) -> Any:
    """The ratio law of the guide."""
    return _added("gearcam.laws.ratio.joint", 0, monkeypatch)


@pytest.fixture
def double(monkeypatch: pytest.MonkeyPatch) -> Any:
    """The motion law of the guide."""
    return _added("gearcam.laws.motion.double", 2, monkeypatch)


@pytest.mark.usefixtures("joint", "double")
def test_random_members_of_the_laws_of_the_guide_are_made() -> None:
    for seed in "12345":
        law, teeth = random_law(LawDraw(seed), "universal-joint")
        common = math.gcd(*teeth)
        built = parameters(law).build(Lobes(teeth[0] // common, teeth[1] // common), DEFAULT)
        c = math.cos(math.radians(law["shaft_angle_deg"]))
        assert float(built.ratio(0.0)) == pytest.approx(c * teeth[0] / teeth[1])
        rise = parameters(random_motion_law(LawDraw(seed), "double-harmonic"))
        assert float(rise.build(DEFAULT).function(0.5)) == pytest.approx(0.25)


def _with_line(path: Path, before: str, line: str) -> None:
    """Add a line to a file before a text that it has once."""
    head, tail = path.read_text("utf-8").split(before)
    path.write_text(f"{head}{line}\n{before}{tail}", encoding="utf-8")


@pytest.mark.slow
def test_the_guide_is_followed_to_its_end(tmp_path: Path) -> None:
    """In a copy of the checkout, with the lines that it asks for and the tests that it names."""
    for name in ("src", "tests", "docs", "profiles", "tools"):
        left_out = shutil.ignore_patterns("__pycache__")
        shutil.copytree(rules.ROOT / name, tmp_path / name, ignore=left_out)
    for name in ("pyproject.toml", "README.md"):
        shutil.copy(rules.ROOT / name, tmp_path / name)
    for number, (kind, module, last) in enumerate(
        (
            ("ratio", "joint", "    from gearcam.laws.ratio.table import TableLaw"),
            ("motion", "double", "    from gearcam.laws.motion.formula import FormulaRise"),
        )
    ):
        law = tmp_path / "src" / "gearcam" / "laws" / kind
        claims = tmp_path / "tests" / "claims" / ("laws", "motion")[number]
        for folder, block in zip((law, claims), BLOCKS[2 * number :], strict=False):
            path = folder / f"{module}.py"
            assert f"`{path.relative_to(tmp_path)}`" in GUIDE
            path.write_text(block, encoding="utf-8")
        (home,) = re.findall(rf'`("{module}": .*?)`', GUIDE)
        _with_line(law / "__init__.py", f'    }},\n    "{kind}_laws"', f"        {home}")
        (line,) = re.findall(rf"`(from gearcam.laws.{kind}.{module} import .*)`", GUIDE)
        _with_line(law / "__init__.py", last, f"    {line}")
    commands = re.findall(r"^    \.venv/bin/python -m (pytest .*)$", GUIDE, re.MULTILINE)
    tested = [one for command in commands for one in shlex.split(command) if "tests/" in one]
    run = partial(subprocess.run, check=False, cwd=tmp_path, capture_output=True, text=True)
    here = {**os.environ, "PYTHONPATH": str(tmp_path / "src")}
    tests = ["-m", "pytest", "-q", "-m", "not slow", *dict.fromkeys(tested)]
    for arguments in (["tools/reference.py"], tests):
        done = run([sys.executable, *arguments], env=here)
        assert done.returncode == 0, done.stdout[-2000:]


def test_the_motion_law_of_the_contributing_page_is_the_double_harmonic(double: Any) -> None:
    module = double
    rise = module.DoubleHarmonic().build(DEFAULT).function
    phi = np.linspace(0.0, 1.0, 41)
    expected = (1 - np.cos(np.pi * phi)) / 2 - (1 - np.cos(2 * np.pi * phi)) / 8
    np.testing.assert_allclose(rise(phi), expected, atol=1e-15)
    (claim,) = module.CLAIMS["double-harmonic"].values
    for place, value in claim.values.items():
        assert float(rise(place)) == pytest.approx(value, abs=1e-15)
    velocity, acceleration = (
        np.abs(d).max() for d in rise.derivatives(np.append(phi, 2 / 3), 2)[1:]
    )
    assert velocity == pytest.approx(claim.peak_velocity, rel=1e-14)
    assert acceleration == pytest.approx(claim.peak_acceleration, rel=1e-14)


def test_the_law_of_the_contributing_page_is_that_of_the_joint(joint: Any) -> None:
    """With cos(b) = c: ``tan(phi2) = c*tan(phi1)`` in each lobe."""
    angle = math.radians(30.0)
    c, lobes = math.cos(angle), Lobes(2, 3)
    law = joint.UniversalJoint(shaft_angle=angle).build(lobes, DEFAULT)
    for phi in (0.0, 0.3, 0.7):
        assert float(law.phi2(phi)) == pytest.approx(
            math.atan(c * math.tan(2 * phi)) / 3, abs=1e-14
        )
    (_, low), (_, high) = law.ratio_range
    assert (low, high) == pytest.approx((2 * c / 3, 2 / (3 * c)), rel=1e-13)


def test_the_claims_of_the_contributing_page_hold(joint: Any) -> None:
    (claims,) = joint.CLAIMS.values()
    for claim in claims.values:
        law = claim.parameters.build(claim.lobes, DEFAULT)
        for phi, ratio in claim.ratio.items():
            assert float(law.ratio(phi)) == pytest.approx(ratio, abs=1e-14)
        for phi, driven in claim.driven.items():
            assert float(law.phi2(phi)) == pytest.approx(driven, abs=2e-14)
        phi = np.linspace(0.0, law.period, 9)
        expected = claims.ratio(claim.parameters, claim.lobes, phi, np)
        np.testing.assert_allclose(law.ratio(phi), expected, rtol=1e-13)


def test_the_pair_of_the_contributing_page_has_the_size_shown() -> None:
    law = gearcam.laws.Formula(ratio="1/(1 - 0.25*sin(phi1)**2)")  # the joint's, up to a factor
    pair = gearcam.PairSpec(teeth=(40, 40), module=2.0)
    result = gearcam.build(gearcam.GearPairDesign(name="joint", law=law, pair=pair))
    distance = result.facts.quantity("pair.center_distance_mm").text
    assert f"`centre distance {distance}`" in GUIDE


def misspelt(document: dict[str, Any], kind: str) -> list[str]:
    """Keys of a document, whole or a part of one, that a kind of design does not know."""
    known: Collection[str]
    found = []
    for title, table in document.items():
        if not isinstance(table, dict | list):
            continue  # kind and name
        for one in table if isinstance(table, list) else [table]:
            if title == "law":
                known = law_table(one["type"]).entries
            elif title == "motion" and "type" in one:
                rise = rise_table(one["law"]).entries if "law" in one else {}
                known = {**phase_table(one["type"]).entries, **rise}
            elif title == "motion":
                known = {key for turn in turn_tables() for key in turn.entries}
            else:
                known = KINDS[kind].table(title).entries
            found += [f"{title}.{key}" for key in one if key not in {"type", "law", *known}]
    return found


@pytest.mark.parametrize(("name", "kind"), [("gear-pairs", "gear-pair"), ("cams", "cam")])
def test_examples_of_tables_have_keys_that_exist(name: str, kind: str) -> None:
    page = (rules.ROOT / "docs" / f"{name}.md").read_text("utf-8")
    blocks = [block for language, block in FENCE.findall(page) if language == "toml"]
    assert len(blocks) > 5
    for block in blocks:
        assert misspelt(tomllib.loads(block), kind) == [], block
    assert misspelt({"output": {"kerf": 1}, "name": "x"}, kind) == ["output.kerf"]  # a control
