"""A design's follower on a profile from a file: its lift is the one that was asked for."""

from __future__ import annotations

import math
from pathlib import Path

import numpy as np
import pytest

from gearcam.base.errors import DesignError
from gearcam.kinds.cam.result import CamResult
from helpers_built import built
from helpers_files import table
from helpers_pairs import PROFILES
from helpers_sampling import few


def made(name: str) -> CamResult:
    return built(PROFILES / f"{name}.toml")


@pytest.mark.parametrize("file", few(["profile.csv", "cam.dxf"]))
@pytest.mark.parametrize(
    ("name", "highest", "unit"),
    [("plate_cam_offset_roller", 10.0, "mm"), ("plate_cam_oscillating", 20.0, "deg")],
)
def test_a_cam_s_own_files_move_its_follower_as_asked(
    name: str, highest: float, unit: str, file: str, tmp_path: Path
) -> None:
    result = made(name)
    written = result.write(tmp_path, files=["csv", "dxf"])
    told: list[tuple[str, int, int]] = []
    study = result.follow(written.directory / file, progress=lambda *step: told.append(step))
    assert told == [("profile", 0, 2), ("follow", 1, 2)]
    found = study.write(tmp_path)
    assert "followed.csv" in found.files
    summary = found.summary["followed"]
    rows = table((found.directory / "followed.csv").read_bytes())
    np.testing.assert_array_equal(rows["theta_deg"], np.arange(361.0))
    assert summary["unit"] == unit
    # a chord tolerance of 1 um on a lever of more than 50 mm is less than 2 um or its angle
    allowed = 2e-3 if unit == "mm" else math.degrees(2e-3 / 50.0)
    assert rows["s"].max() == pytest.approx(highest, abs=allowed)
    assert rows["s_asked"].max() == pytest.approx(highest, rel=1e-12)
    np.testing.assert_allclose(rows["s"], rows["s_asked"], atol=allowed)
    off = rows["s"] - rows["s_asked"]
    np.testing.assert_allclose(rows["difference"], off, atol=1e-12)
    worst = np.abs(off).argmax()
    assert summary["largest_difference"] == pytest.approx(off[worst], abs=1e-12)
    assert summary["at_deg"] == pytest.approx(float(worst))
    assert summary["rms_difference"] == pytest.approx(math.sqrt((off**2).mean()), abs=1e-12)


def test_a_file_that_holds_no_profile_is_refused(tmp_path: Path) -> None:
    path = tmp_path / "nothing.dxf"
    path.write_text("nothing\n", encoding="ascii")
    with pytest.raises(DesignError, match="not a profile"):
        made("eccentric_cam").follow(path)
    with pytest.raises(DesignError, match="not a profile"):
        made("eccentric_cam").follow(tmp_path / "missing.csv")
