"""Texts of cam designs, and how they are read and refused."""

from __future__ import annotations

import pytest

from gearcam.base.errors import DesignError, Problem
from gearcam.designs import loads
from gearcam.kinds.cam.design import CamDesign

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


def read(text: str, file: str = "") -> CamDesign:
    design = loads(text, file=file)
    assert isinstance(design, CamDesign)
    return design


def problems(text: str) -> list[Problem]:
    with pytest.raises(DesignError) as caught:
        loads(text, file="cam.toml")
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
