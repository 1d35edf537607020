"""Texts of translating cams, and how they are read and built."""

from __future__ import annotations

import gearcam
from gearcam.cams.sliding import SlidingCam
from gearcam.designs import loads
from gearcam.kinds.cam.build import CamResult
from gearcam.kinds.cam.design import CamDesign
from helpers_pairs import PROFILES

FILE = (PROFILES / "translating_cam.toml").read_text("utf-8")
ONE = """
kind = "cam"
name = "one"
[[motion]]
type = "rise"
way_mm = 60
law = "3-4-5"
lift_mm = 15
[[motion]]
type = "dwell"
way_mm = 30
[[motion]]
type = "return"
way_mm = 40
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
DEEP = "groove_depth_mm = 8\n"


def read(text: str, *changes: tuple[str, str]) -> CamDesign:
    for old, new in changes:
        assert old in text
        text = text.replace(old, new)
    made = loads(text)
    assert isinstance(made, CamDesign)
    return made


def built(text: str, *changes: tuple[str, str]) -> CamResult:
    made = gearcam.build(read(text, *changes))
    assert isinstance(made, CamResult)
    return made


def cam_of(result: CamResult) -> SlidingCam:
    assert isinstance(result.cam, SlidingCam)
    return result.cam
