"""Numbers in the files of cams, against shapes that are known by hand."""

from __future__ import annotations

import math
from dataclasses import replace
from typing import Any

import numpy as np
import pytest

import gearcam
from gearcam.base.errors import InfeasibleError
from gearcam.kinds.cam.result import CamResult
from helpers_files import FLAT, ROLLER, read, table
from helpers_pairs import PROFILES


def made(text: str, **output: Any) -> CamResult:
    design = read(text)
    return CamResult(replace(design, output=replace(design.output, **output)))


def eccentric(**output: Any) -> CamResult:
    """A disc of radius 31 mm, its centre 6 mm from the axis."""
    design = gearcam.load(PROFILES / "eccentric_cam.toml")
    return CamResult(replace(design, output=replace(design.output, **output)))


def test_the_curvature_from_three_points_of_a_circle_is_exact() -> None:
    """A wrong sign would make errors of 2/31 per mm."""
    rows = table(eccentric().files("curvature")["curvature.csv"])
    assert np.all(np.diff(rows["points"]) > 0)
    np.testing.assert_allclose(
        rows["spacing_mm"], 2 * 31.0 * np.sin(math.pi / rows["points"]), rtol=1e-9
    )
    assert rows["largest_error_per_mm"].max() < 1e-6
    assert np.all(rows["rms_error_per_mm"] <= rows["largest_error_per_mm"])


def test_an_undercut_profile_has_no_curvature_study() -> None:
    steep = FLAT.replace("base_radius_mm = 30", "base_radius_mm = 5")
    assert made(steep).cam.walls[0].undercut
    with pytest.raises(InfeasibleError, match="cusps"):
        made(steep).files("curvature")


def test_the_tool_path_of_a_disc_is_a_larger_circle() -> None:
    rows = table(eccentric(tool_radius=4.0).files("tool-path")["tool_path.csv"])
    place = rows["x_mm"] + 1j * rows["y_mm"]
    area = 0.5 * float((np.conj(place) * np.roll(place, -1)).imag.sum())
    assert area == pytest.approx(math.pi * 35.0**2, rel=1e-3)
    center = 0.5 * complex(np.ptp(place.real), np.ptp(place.imag))
    assert (center.real, center.imag) == (
        pytest.approx(35.0, abs=2e-3), pytest.approx(35.0, abs=2e-3)
    )  # fmt: skip
    middle = complex(
        0.5 * (place.real.max() + place.real.min()), 0.5 * (place.imag.max() + place.imag.min())
    )
    assert abs(middle) == pytest.approx(6.0, abs=2e-3)
    np.testing.assert_allclose(np.abs(place - middle), 35.0, atol=2e-3)


def test_the_tool_of_a_roller_s_size_runs_where_the_roller_does() -> None:
    """Without a radius of its own; farthest out it stands at the roller's highest place."""
    rows = table(made(ROLLER).files("tool-path")["tool_path.csv"])
    far = np.hypot(rows["x_mm"], rows["y_mm"])
    rest = math.sqrt(30.0**2 - 8.0**2)
    assert far.min() == pytest.approx(30.0, abs=2e-3)
    assert far.max() == pytest.approx(math.hypot(8.0, rest + 10.0), abs=2e-3)


def test_a_face_without_a_tool_radius_has_no_tool_path() -> None:
    with pytest.raises(InfeasibleError, match="needs the cutter's radius"):
        eccentric(tool_radius=None).files("tool-path")
