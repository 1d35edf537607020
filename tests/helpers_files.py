"""Files that go in and come out: texts of designs, changed, read, refused and built; tables."""

from __future__ import annotations

import csv
import io

import numpy as np
import pytest

from gearcam.base.errors import DesignError, Problem
from gearcam.cams.translating import TranslatingCam
from gearcam.designs import loads
from gearcam.kinds.cam.design import CamDesign
from gearcam.kinds.cam.result import CamResult
from helpers_built import built as shared
from helpers_pairs import PROFILES

PAIR = """\
kind = "gear-pair"
name = "good"

[law]
type = "phases"
knots_deg = [0, 160, 360]
ratios = [1.6, 0.4, 1.6]

[pair]
center_distance_mm = 180
teeth = [36, 36]

[output]
files = ["csv"]
"""

ROLLER = """\
kind = "cam"
name = "plate_cam_offset_roller"

[[motion]]
type = "rise"
law = "cycloidal"
angle_deg = 90
lift_mm = 10
[[motion]]
type = "dwell"
angle_deg = 90
[[motion]]
type = "return"
law = "cycloidal"
angle_deg = 90
[[motion]]
type = "dwell"
angle_deg = 90

[follower]
type = "roller"                        # point, roller, flat, domed
motion = "translating"                 # or oscillating
roller_radius_mm = 6
offset_mm = 8

[cam]
form = "disc"                          # or groove, conjugate, yoke, translating
prime_radius_mm = 30                   # to the roller centre at zero lift
thickness_mm = 12

[output]
files = ["dxf", "stl", "csv"]
"""

SWINGING = """\
kind = "cam"
name = "plate_cam_oscillating"

[[motion]]
type = "rise"
law = "modified-sine"
angle_deg = 120
lift_deg = 20
[[motion]]
type = "dwell"
angle_deg = 60
[[motion]]
type = "return"
law = "3-4-5"
angle_deg = 120
[[motion]]
type = "dwell"
angle_deg = 60

[follower]
type = "roller"
motion = "oscillating"
roller_radius_mm = 8
arm_mm = 90
pivot_distance_mm = 100                # the start angle follows from prime_radius_mm

[cam]
form = "disc"
prime_radius_mm = 40
thickness_mm = 12

[output]
files = ["dxf", "csv"]
"""

RISE = 'type = "rise"\nlaw = "cycloidal"\nangle_deg = 90\nlift_mm = 10\n'
FLAT = ROLLER.replace("prime_radius", "base_radius").replace('"roller"', '"flat"')
FLAT = FLAT.replace("roller_radius_mm = 6\noffset_mm = 8\n", "")


PLATE = (PROFILES / "translating_cam.toml").read_text("utf-8")
"""A plate that slides, with a groove."""
DEEP = "groove_depth_mm = 8\n"
"""A line of `PLATE`."""
EDGE = """
kind = "cam"
name = "one"
[[motion]]
type = "rise"
travel_mm = 60
law = "3-4-5"
lift_mm = 15
[[motion]]
type = "dwell"
travel_mm = 30
[[motion]]
type = "return"
travel_mm = 40
law = "cycloidal"
[follower]
type = "roller"
roller_radius_mm = 6
[cam]
form = "translating"
run_in_mm = 20
run_out_mm = 20
thickness_mm = 10
[blank]
height_mm = 40
"""
"""A bar that slides, with one wall."""


def read(text: str, *changes: tuple[str, str], file: str = "") -> CamDesign:
    """The design of a text in which words, which must be there, are replaced."""
    for old, new in changes:
        assert old in text
        text = text.replace(old, new)
    design = loads(text, file=file)
    assert isinstance(design, CamDesign)
    return design


def built(text: str, *changes: tuple[str, str]) -> CamResult:
    """The shared result of a text in which words are replaced."""
    return shared(read(text, *changes))


def sliding_of(result: CamResult) -> TranslatingCam:
    """The cam of a result, which slides."""
    assert isinstance(result.cam, TranslatingCam)
    return result.cam


def refused(text: str, *changes: tuple[str, str]) -> dict[str, str]:
    """What is wrong with a text, and what is allowed, by its key."""
    with pytest.raises(DesignError) as caught:
        read(text, *changes)
    return {one.key: f"{one.message}; {one.allowed}" for one in caught.value.problems}


def problems(text: str, file: str = "design.toml") -> list[Problem]:
    with pytest.raises(DesignError) as caught:
        loads(text, file=file)
    return list(caught.value.problems)


def only(text: str) -> Problem:
    """The one problem of a text."""
    found = problems(text)
    assert len(found) == 1, "\n".join(map(str, found))
    return found[0]


def changed(old: str, new: str, text: str = ROLLER) -> str:
    """A text with the first of a few words replaced."""
    assert old in text
    return text.replace(old, new, 1)


def table(data: bytes) -> dict[str, np.ndarray]:
    """Columns of numbers by the standard library's reader; NaN where a cell is empty."""
    rows = list(csv.DictReader(io.StringIO(data.decode("ascii"))))
    return {name: np.array([float(row[name] or "nan") for row in rows]) for name in rows[0]}
