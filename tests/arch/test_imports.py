"""Imports go one way, and a build loads only the libraries that its files need."""

from __future__ import annotations

import ast
import graphlib
import json
import os
import re
import shutil
import subprocess
import sys
from collections.abc import Callable
from functools import cache
from importlib.util import find_spec
from pathlib import Path

import pytest

from arch import rules

UNWANTED = (
    *("scipy", "trimesh", "manifold3d", "ezdxf", "plotly", "shapely"),
    *("numpy.ma", "numpy.random", "numpy.polynomial"),
)
LINT = """
import sys
from importlinter import cli
sys.path.insert(0, sys.argv[1])
sys.exit(cli.lint_imports(config_filename=sys.argv[2], no_cache=True))
"""
LOADED = """
import json, sys
from gearcam.cli import main
sys.argv = ["gearcam", *sys.argv[1:]]
try:
    code = main() or 0
except SystemExit as stop:
    code = stop.code or 0
print(json.dumps({"code": code, "modules": sorted(sys.modules)}))
"""


WITH_LINTER = pytest.mark.skipif(
    find_spec("importlinter") is None, reason="import contracts need what `make lint` installs"
)


def _contracts(root: Path) -> subprocess.CompletedProcess[str]:
    """Check the contracts of the project on the sources under `root`."""
    environment = os.environ | {"PYTHONPATH": str(root / "src")}
    return subprocess.run(
        [sys.executable, "-c", LINT, str(root / "src"), str(rules.ROOT / "pyproject.toml")],
        cwd=root,
        env=environment,
        capture_output=True,
        text=True,
        check=False,
    )


@WITH_LINTER
def test_contracts_hold() -> None:
    done = _contracts(rules.ROOT)
    assert done.returncode == 0, done.stdout + done.stderr


def test_no_module_imports_itself_by_way_of_others() -> None:
    graph = rules.imports_of(*rules.python_files(rules.SOURCE), root=rules.SOURCE)
    assert len(graph) > 300
    graphlib.TopologicalSorter(graph).prepare()


def test_a_circle_of_imports_is_seen(tmp_path: Path) -> None:
    for name, line in (("a", "from house import b"), ("b", "def f():\n    from house.c import x")):
        (tmp_path / f"{name}.py").write_text(line + "\n")
    (tmp_path / "c.py").write_text("if TYPE_CHECKING:\n    from house.a import y\n")
    house = tmp_path.rename(tmp_path.with_name("house"))
    graph = rules.imports_of(*rules.python_files(house), root=house)
    with pytest.raises(graphlib.CycleError):
        graphlib.TopologicalSorter(graph).prepare()


WRONG = [
    ("base", "from gearcam import numeric", "One way through the house"),
    ("designs", "from gearcam import export", "One way through the house"),
    ("numeric", "import shapely", "Mathematics needs numpy and nothing else"),
    ("export", "from gearcam import laws", "Exporters see parts"),
    ("parts", "import manifold3d", "manifold3d only in solids"),
    ("parts", "import trimesh", "trimesh (and what it needs) only in export.mesh"),
    ("kinds", "import ezdxf", "ezdxf only where DXF is written and read"),
    ("kinds", "import shapely", "shapely only where regions are cut"),
    ("kinds", "import scipy.optimize", "rich only in console"),
]
"""A room, an import planted there, and the contract that it breaks."""


@pytest.fixture(scope="module")
def broken(tmp_path_factory: pytest.TempPathFactory) -> dict[str, str]:
    """What is said of each broken contract of a copy with all wrong imports."""
    root = tmp_path_factory.mktemp("planted")
    copy = root / "src" / "gearcam"
    shutil.copytree(rules.SOURCE, copy)
    for room, line, _ in WRONG:
        place = copy / room / "planted.py" if (copy / room).is_dir() else copy / f"{room}.py"
        assert place.exists() or place.name == "planted.py"
        with place.open("a", encoding="utf-8") as file:
            file.write(f"\n\ndef planted():\n    {line}\n")
    done = _contracts(root)
    assert done.returncode != 0
    _, _, told = done.stdout.partition("Broken contracts")
    parts = re.split(r"^(\S.*)\n-{5,}\n", told, flags=re.MULTILINE)
    return dict(zip(parts[1::2], parts[2::2], strict=True))


@WITH_LINTER
@pytest.mark.parametrize(("room", "line", "contract"), WRONG)
def test_a_wrong_import_is_caught(
    broken: dict[str, str], room: str, line: str, contract: str
) -> None:
    (told,) = (text for name, text in broken.items() if contract in name)
    guilty = room if (rules.SOURCE / f"{room}.py").exists() else f"{room}.planted"
    what = line.split()[-1] if line.startswith("import") else f"gearcam.{line.split()[-1]}"
    assert re.search(rf"gearcam\.{guilty} -> {what.partition('.optimize')[0]}\b", told), told


def _foreign_to_witnesses(code: str) -> set[str]:
    """What a witness imports beside the standard library and what it may depend on."""
    names: set[str] = set()
    for node in ast.walk(ast.parse(code)):
        if isinstance(node, ast.ImportFrom):
            names.add(node.module or ".")
        elif isinstance(node, ast.Import):
            names.update(name.name for name in node.names)
    return {name.split(".")[0] for name in names} - sys.stdlib_module_names - WITNESSES


WITNESSES = frozenset({"witness", "numpy", "shapely", "mpmath"})


def absent(source: str) -> list[str]:
    """What a file imports from the package though it is not there."""
    found: list[str] = []
    for node in ast.walk(ast.parse(source)):
        if isinstance(node, ast.ImportFrom) and (node.module or "").startswith("gearcam"):
            for name in node.names:
                try:
                    exec(f"from {node.module} import {name.name}", {})
                except ImportError:
                    found.append(f"{node.module}: {name.name}")
    return found


def test_what_benchmarks_and_tools_import_is_there() -> None:
    """They are run rarely, and tools alone are checked for types."""
    files = rules.python_files(rules.ROOT / "benchmarks", rules.ROOT / "tools")
    assert len(files) > 10  # a copy in which the guide is followed has no benchmarks
    assert [name for path in files for name in absent(path.read_text("utf-8"))] == []
    assert absent("from gearcam.kinds.gridded import mesh_from, STEM") == [
        "gearcam.kinds.gridded: mesh_from"
    ]


def test_witnesses_share_no_code_with_the_program() -> None:
    tests = rules.ROOT / "tests"
    files = rules.python_files(tests / "witness")
    assert len(files) > 5
    found = {path.name: _foreign_to_witnesses(path.read_text(encoding="utf-8")) for path in files}
    assert {name: what for name, what in found.items() if what} == {}


@pytest.mark.parametrize(
    ("code", "caught"),
    [
        ("from gearcam.cams.follow import follow\n", {"gearcam"}),
        ("def f():\n    import gearcam.gears\n", {"gearcam"}),
        ("from helpers_cams import cam\n", {"helpers_cams"}),
        ("import math\nfrom witness.cam_sweep import pairs\nimport numpy as np\n", set()),
    ],
)
def test_a_witness_that_imports_the_program_is_caught(code: str, caught: set[str]) -> None:
    assert _foreign_to_witnesses(code) == caught


@pytest.fixture(scope="module")
def modules(tmp_path_factory: pytest.TempPathFactory) -> Callable[..., frozenset[str]]:
    """Names of all modules that a build of a profile loads, in a process of its own."""

    @cache
    def loaded(profile: str, files: str) -> frozenset[str]:
        folder = tmp_path_factory.mktemp(profile)
        found = _loaded("build", f"profiles/{profile}.toml", "--only", files, "-o", str(folder))
        assert list((folder / profile).glob(f"*.{files}"))
        return found

    return loaded


def _loaded(*words: str) -> frozenset[str]:
    """Return the names of all modules that a command loads in a process of its own."""
    done = subprocess.run(
        [sys.executable, "-c", LOADED, *words],
        cwd=rules.ROOT,
        capture_output=True,
        text=True,
        check=False,
    )
    assert done.returncode == 0, done.stderr
    answer = json.loads(done.stdout.splitlines()[-1])
    assert answer["code"] == 0, done.stdout + done.stderr
    return frozenset(answer["modules"])


@pytest.mark.parametrize("word", ["--version", "--help"])
def test_version_and_help_need_no_kind_of_design(word: str) -> None:
    loaded = _loaded(word)
    assert loaded.isdisjoint({"numpy", "rich", "gearcam.designs", "gearcam.results.kind"})
    assert not [name for name in loaded if re.match(r"gearcam\.kinds\.\w+\.", name)]
    assert word != "--version" or "importlib.metadata" not in loaded


@pytest.mark.parametrize("file", ["ellipse", "nail_machine_two_phase", "eccentric_cam"])
def test_a_csv_build_loads_nothing_that_it_does_not_need(
    modules: Callable[..., frozenset[str]], file: str
) -> None:
    """Also of a part with a round bore."""
    loaded = modules(file, "csv")
    assert "numpy" in loaded
    assert loaded.isdisjoint(UNWANTED)


LAWS = {
    ".".join(path.relative_to(rules.SOURCE.parent).with_suffix("").parts)
    for path in (rules.SOURCE / "laws").rglob("*.py")
}
"""All modules of laws and rises, with what they share."""


@pytest.mark.parametrize(
    ("file", "other", "laws"),
    [
        (
            "ellipse",
            "cams",
            {"columns", "displacement", "entry"} | {"ratio.base", "ratio.ellipse", "ratio.span"},
        ),
        (
            "eccentric_cam",
            "gears",
            {
                "displacement",
                "entry",
                "program",
                "phases_of_lift",
                "motion.pieces",
                "motion.simple",
                "motion.base",
            },
        ),
        (
            "measured_cam",
            "gears",
            {"columns", "displacement", "entry", "program", "phases_of_lift"}
            | {"motion_table", "motion.pieces", "motion.base", "row_checks"},
        ),
    ],
)
def test_a_build_loads_its_kind_and_its_law(
    modules: Callable[..., frozenset[str]], file: str, other: str, laws: set[str]
) -> None:
    loaded = modules(file, "csv")
    assert f"gearcam.{other}" not in loaded
    assert {name.removeprefix("gearcam.laws.") for name in loaded & LAWS} == laws


WITHOUT_FORCES = {
    "importlib.metadata",
    "gearcam.linkages.bonds",
    "gearcam.linkages.coordinates",
    "gearcam.linkages.efforts",
    "gearcam.linkages.friction",
    "gearcam.linkages.geneva",
    "gearcam.kinds.mechanism.charts",
    "gearcam.kinds.mechanism.parts.geneva",
    "gearcam.kinds.mechanism.parts.load",
    "gearcam.kinds.mechanism.precision_checks",
    "gearcam.pictures.charts",
}


def test_a_csv_build_of_a_mechanism_loads_nothing_for_forces_and_charts(
    modules: Callable[..., frozenset[str]],
) -> None:
    loaded = modules("press_ram", "csv")
    assert {"gearcam.linkages.linkage", "gearcam.kinds.mechanism.parts.dyad"} <= loaded
    assert not loaded & WITHOUT_FORCES


def test_a_study_of_a_mechanism_loads_what_it_needs(
    modules: Callable[..., frozenset[str]],
) -> None:
    """The control: loads of a machine with a study of its torque."""
    loaded = modules("nail_machine_slide", "csv")
    assert {"gearcam.linkages.efforts", "gearcam.kinds.mechanism.parts.load"} <= loaded


def test_a_drawing_loads_its_writer(modules: Callable[..., frozenset[str]]) -> None:
    """The control: the list of loaded modules does show a library once it is used."""
    assert "ezdxf" in modules("ellipse", "dxf")
