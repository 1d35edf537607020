"""No warning of a library reaches the user, and none is raised behind his back."""

from __future__ import annotations

import logging
import subprocess
import sys
import warnings
from collections.abc import Callable
from importlib.util import find_spec
from pathlib import Path
from typing import Any

import pytest

from gearcam import general_commands
from gearcam.cli import main
from gearcam.commands import FINDINGS, GOOD
from gearcam.designs import load
from helpers_pairs import PROFILES
from helpers_processes import ENVIRONMENT

GEARS = "dxf,cut-svg,svg,stl,3mf,glb,csv,drawing-dxf,drawing-svg,inspection"
STEP = ",step" if find_spec("OCP") else ""

PLANTED = """
import logging, sys, warnings
import numpy as np
from gearcam import cli, console, general_commands
def noisy(*_):
    warnings.warn("a library is cross", UserWarning)
    np.array([1.0]) / 0.0
    logging.getLogger("ezdxf").warning("a library is cross")
    raise KeyError("an error")
general_commands.load = noisy
sys.argv = ["gearcam", *sys.argv[1:]]
sys.exit(cli.main())
"""


def run(*words: str, debug: str = "") -> subprocess.CompletedProcess[str]:
    environment = ENVIRONMENT | {"GEARCAM_DEBUG": debug}
    return subprocess.run(
        [sys.executable, *words], capture_output=True, text=True, env=environment, check=False
    )


@pytest.fixture
def strictly(
    tmp_path: Path, capfd: pytest.CaptureFixture[str], caplog: pytest.LogCaptureFixture
) -> Callable[..., None]:
    """Run a command with every warning an error, and see that neither it nor a log complains."""

    def strict(*words: str) -> None:
        with warnings.catch_warnings():
            warnings.simplefilter("error")
            code = main([*words, "-o", str(tmp_path)])
        logged = [one.getMessage() for one in caplog.records if one.levelno >= logging.WARNING]
        complaints = capfd.readouterr().err + "".join(logged)
        assert not complaints, complaints
        assert code in (GOOD, FINDINGS)

    return strict


@pytest.mark.parametrize("files", [GEARS, pytest.param(GEARS + STEP, marks=pytest.mark.slow)])
def test_libraries_are_loaded_quietly(files: str, tmp_path: Path) -> None:
    """In a process of its own, since some warn only where they are imported."""
    text = (PROFILES / "log_spiral.toml").read_text("utf-8")
    coarse = tmp_path / "coarse.toml"
    coarse.write_text(text.replace("[output]", "[output]\nchord_tolerance_mm = 0.02"), "utf-8")
    words = "build", str(coarse), "--only", files, "-o", str(tmp_path)
    done = run("-W", "error", "-m", "gearcam", *words)
    assert (done.returncode in (GOOD, FINDINGS), done.stderr) == (True, "")


@pytest.mark.parametrize(
    ("name", "files"),
    [
        pytest.param("shop_order", GEARS, marks=pytest.mark.slow),
        pytest.param("feeder", GEARS, marks=pytest.mark.slow),
        pytest.param(
            "plate_cam_offset_roller", GEARS + ",tool-path,curvature", marks=pytest.mark.slow
        ),
        ("flat_follower", GEARS + ",curvature"),
    ],
)
def test_designs_of_all_kinds_are_built_quietly(
    strictly: Callable[..., None], name: str, files: str
) -> None:
    strictly("build", str(PROFILES / f"{name}.toml"), "--only", files)


@pytest.mark.parametrize("name", ["ellipse", "log_spiral"])
def test_a_study_is_quiet(strictly: Callable[..., None], name: str) -> None:
    strictly("mesh", str(PROFILES / f"{name}.toml"), "--steps", "24")


def test_followers_and_files_read_back_are_quiet(
    strictly: Callable[..., None], tmp_path: Path
) -> None:
    cam = str(PROFILES / "eccentric_cam.toml")
    strictly("build", cam, "--only", "dxf,csv")
    for profile in ("cam.dxf", "profile.csv"):
        strictly("follow", cam, str(tmp_path / "eccentric_cam" / profile))


@pytest.mark.parametrize("noise", ["warning", "log"])
def test_a_noise_is_heard(
    strictly: Callable[..., None], noise: str, monkeypatch: pytest.MonkeyPatch
) -> None:
    """The control: what a library says in the middle of a command makes these tests fail."""

    def noisy(*given: Any) -> Any:
        if noise == "warning":
            warnings.warn("a library is cross", UserWarning, stacklevel=1)
        logging.getLogger("ezdxf").warning("a library is cross")
        return load(*given)

    monkeypatch.setattr(general_commands, "load", noisy)
    with pytest.raises(AssertionError, match="a library is cross"):
        strictly("check", str(PROFILES / "eccentric_cam.toml"))


def test_what_libraries_say_is_kept_and_errors_are_not() -> None:
    told = run("-c", PLANTED, "check", "any.toml")
    assert told.returncode == 4
    assert "an error" in told.stderr
    assert "cross" not in told.stderr
    assert "RuntimeWarning" not in told.stderr


def test_who_looks_for_faults_hears_everything() -> None:
    assert run("-c", PLANTED, "check", "any.toml", debug="1").stderr.count("a library is cross") > 1
    assert "is cross" in run("-W", "error", "-c", PLANTED, "check", "any.toml").stderr
