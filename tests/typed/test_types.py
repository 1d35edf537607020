"""Type checkers find nothing in right uses of the package, and every wrong use."""

from __future__ import annotations

import ast
import json
import subprocess
import sys
from importlib.util import find_spec
from pathlib import Path

import matplotlib as mpl
import numpy as np
import pytest

import gearcam as gc
from arch import rules
from typed import user_code

mpl.use("Agg")
WRONG = """
import gearcam as gc

pair = gc.PairSpec(teeth=(20, 20), module="2")  # wrong
law = gc.laws.Elipse(eccentricity=0.3)  # wrong
gc.motion_laws.Cycloid()  # wrong
gc.Gearpair  # wrong
design = gc.GearPairDesign(name="mine", law=gc.laws.Constant(), pairs=pair)  # wrong
cam = gc.CamDesign(name=3, motion=gc.MotionFormula(lift="1"), follower=1, cam=2)  # wrong
gc.build(design).cam  # wrong
gc.build(cam).gear1  # wrong
gc.build("pair.toml")  # wrong
design.with_({"law.eccentricity": 0.4}).motion  # wrong
gc.build(design).contact(0.1, side="left")  # wrong
gc.load(["pair.toml"])  # wrong
gc.build(design).write(files="dxf", folder="output")  # wrong
"""
"""Each marked line is an error, and no other line is."""

WITH_CHECKER = pytest.mark.skipif(
    find_spec("pyright") is None, reason="types are checked by what `make lint` installs"
)


@pytest.fixture(scope="module")
def faults(tmp_path_factory: pytest.TempPathFactory) -> dict[str, set[int]]:
    """Lines with errors, by file, in a folder of a user who checks strictly."""
    folder = tmp_path_factory.mktemp("user")
    settings = {"typeCheckingMode": "strict", "extraPaths": [str(rules.SOURCE.parent)]}
    (folder / "pyrightconfig.json").write_text(json.dumps(settings))
    (folder / "right.py").write_text(Path(user_code.__file__).read_text("utf-8"), "utf-8")
    (folder / "wrong.py").write_text(WRONG)
    done = subprocess.run(
        [sys.executable, "-m", "pyright", "--outputjson", "--pythonpath", sys.executable],
        cwd=folder,
        capture_output=True,
        text=True,
        check=False,
    )
    told = json.loads(done.stdout)
    assert told["summary"]["filesAnalyzed"] == 2
    found: dict[str, set[int]] = {"right.py": set(), "wrong.py": set()}
    for one in told["generalDiagnostics"]:
        found[Path(one["file"]).name].add(one["range"]["start"]["line"] + 1)
    return found


@pytest.mark.slow
@WITH_CHECKER
def test_strict_user_code_has_no_faults(faults: dict[str, set[int]]) -> None:
    assert faults["right.py"] == set()


@pytest.mark.slow
@WITH_CHECKER
def test_each_wrong_use_is_found(faults: dict[str, set[int]]) -> None:
    lines = enumerate(WRONG.splitlines(), start=1)
    marked = {number for number, line in lines if line.endswith("# wrong")}
    assert len(marked) > 10
    assert faults["wrong.py"] == marked


def test_the_user_code_runs(tmp_path: Path, monkeypatch: pytest.MonkeyPatch) -> None:
    import matplotlib.pyplot as plt

    monkeypatch.chdir(tmp_path)
    _, ax = plt.subplots()
    assert user_code.of_pairs(user_code.pair_of(0.3), ax).shape[1] == 2
    plt.close("all")
    theta = np.radians(np.arange(0.0, 360.0, 5.0))
    result = user_code.cams(theta, 10.0 * np.sin(0.5 * theta) ** 2)
    written = result.write(tmp_path, files=["csv"])
    design = written.directory / "design.toml"
    design.write_text('kind = "cam"\n')
    assert user_code.from_elsewhere(str(design)) is None
    for path in ("ellipse", "eccentric_cam"):
        found = user_code.from_elsewhere(str(rules.ROOT / "profiles" / f"{path}.toml"))
        assert found is not None
        assert len(found) > 100
    told = user_code.show(result, result.motion(), result.facts)
    assert told.startswith("rows: 0 errors")
    assert len(user_code.laws_of_other_kinds()) > 5


def test_type_checkers_are_told_of_every_name() -> None:
    """What is lazy is listed for them: the lists are whole."""
    for package, path in ((gc.laws, "ratio"), (gc.motion_laws, "motion")):
        tree = rules.parse(rules.SOURCE / "laws" / path / "__init__.py")
        block = next(node for node in tree.body if isinstance(node, ast.If))
        imports = [node for node in block.body if isinstance(node, ast.ImportFrom)]
        names = sorted(name.asname or "" for node in imports for name in node.names)
        assert names == package.__all__ == dir(package)
    rooms = (rules.SOURCE / "kinds").glob("*/public.py")
    listed = (rules.SOURCE / "kinds" / "__init__.py").read_text("utf-8")
    assert all(f"from gearcam.kinds.{room.parent.name}.public import *" in listed for room in rooms)
