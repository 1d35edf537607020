"""No warning of a library reaches the user, and none is raised behind his back."""

from __future__ import annotations

import os
import subprocess
import sys
from importlib.util import find_spec
from pathlib import Path

import pytest

from arch import rules
from helpers_pairs import PROFILES

GEARS = "dxf,cut-svg,svg,stl,3mf,glb,csv,drawing-dxf,drawing-svg,inspection"
STEP = ",step" if find_spec("OCP") else ""

PLANTED = """
import logging, sys, warnings
import numpy as np
from gearcam import cli, console
def noisy(*_):
    warnings.warn("a library is cross", UserWarning)
    np.array([1.0]) / 0.0
    logging.getLogger("ezdxf").warning("a library is cross")
    raise KeyError("an error")
cli.load = noisy
sys.argv = ["gearcam", *sys.argv[1:]]
sys.exit(cli.main())
"""


def run(*words: str, debug: str = "") -> subprocess.CompletedProcess[str]:
    environment = os.environ | {"PYTHONPATH": str(rules.SOURCE.parent), "GEARCAM_DEBUG": debug}
    return subprocess.run(
        [sys.executable, *words], capture_output=True, text=True, env=environment, check=False
    )


def strictly(folder: Path, *words: str) -> None:
    """Run a command with every warning an error; logs go to stderr by themselves."""
    done = run("-W", "error", "-m", "gearcam", *words, "-o", str(folder))
    assert (done.returncode in (0, 1), done.stderr) == (True, "")


@pytest.mark.parametrize(
    ("name", "files"),
    [
        pytest.param("shop_order", GEARS, marks=pytest.mark.slow),
        ("log_spiral", GEARS + STEP),
        pytest.param("feeder", GEARS, marks=pytest.mark.slow),
        pytest.param(
            "plate_cam_offset_roller", GEARS + ",tool-path,curvature", marks=pytest.mark.slow
        ),
        ("flat_follower", GEARS + ",curvature"),
    ],
)
def test_designs_of_all_kinds_are_built_quietly(tmp_path: Path, name: str, files: str) -> None:
    strictly(tmp_path, "build", str(PROFILES / f"{name}.toml"), "--only", files)


@pytest.mark.parametrize("name", ["ellipse", "log_spiral"])
def test_a_study_is_quiet(tmp_path: Path, name: str) -> None:
    strictly(tmp_path, "mesh", str(PROFILES / f"{name}.toml"), "--steps", "24")


def test_followers_and_files_read_back_are_quiet(tmp_path: Path) -> None:
    cam = str(PROFILES / "eccentric_cam.toml")
    strictly(tmp_path, "build", cam, "--only", "dxf,csv")
    for profile in ("cam.dxf", "profile.csv"):
        strictly(tmp_path, "follow", cam, str(tmp_path / "eccentric_cam" / profile))


def test_what_libraries_say_is_kept_and_errors_are_not() -> None:
    told = run("-c", PLANTED, "check", "any.toml")
    assert told.returncode == 4
    assert "an error" in told.stderr
    assert "cross" not in told.stderr
    assert "RuntimeWarning" not in told.stderr


def test_who_looks_for_faults_hears_everything() -> None:
    assert run("-c", PLANTED, "check", "any.toml", debug="1").stderr.count("a library is cross") > 1
    assert "is cross" in run("-W", "error", "-c", PLANTED, "check", "any.toml").stderr
