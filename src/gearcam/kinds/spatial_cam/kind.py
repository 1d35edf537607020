"""The kind ``spatial-cam``: what a cam in space is read from and what is made of it."""

from __future__ import annotations

from typing import Final

from gearcam.base.registry import DeferredMapping, deferred
from gearcam.kinds.cam.public import MOTION
from gearcam.kinds.spatial_cam.design import (
    NAME,
    SPATIAL_FORMATS,
    SpatialCamDesign,
)
from gearcam.results.kind import Kind

_HERE: Final = "gearcam.kinds.spatial_cam"

KIND: Final = Kind(
    name=NAME,
    doc="a cam in space with its roller",
    design=SpatialCamDesign,
    result=deferred(f"{_HERE}.build:SpatialCamResult"),
    main=MOTION,
    required=("follower", "cam"),
    formats=SPATIAL_FORMATS,
    check_modules=("gearcam.spatial.checks", "gearcam.laws.row_checks"),
    check_groups=("cams in space", "rows of tables", "solids of cams in space"),
    study_tables={name: name for name in ("developed", "accuracy")},
    example={
        "motion": [
            {"type": "rise", "angle_deg": 150, "law": "cycloidal", "lift_mm": 25},
            {"type": "dwell", "angle_deg": 30},
            {"type": "return", "angle_deg": 150, "law": "cycloidal"},
            {"type": "dwell", "angle_deg": "rest"},
        ],
        "follower": {"motion": "translating", "roller_radius_mm": 8},
        "cam": {
            "form": "cylinder",
            "outer_diameter_mm": 100,
            "length_mm": 60,
            "lowest_mm": 17,
            "groove_depth_mm": 12,
            "roller_clearance_mm": 0.05,
            "floor_clearance_mm": 0.5,
        },
        "blank": {"bore_diameter_mm": 20},
        "output": {"files": ["stl", "csv", "report"]},
    },
    shown={
        "goal": {
            "minimize": "cam.pressure_angle_deg.max",
            "maximize": "cam.largest_roller_mm.in_space",
        }
    },
    processes={
        "printing": {
            "cam": {"roller_clearance_mm": 0.08, "floor_clearance_mm": 0.5},
            "output": {"files": ["stl", "report"], "wall_step_deg": 1},
        },
        "milling": {
            "cam": {"roller_clearance_mm": 0.05, "floor_clearance_mm": 0.5},
            "tool": {"diameter_mm": 10},
            "output": {"files": ["gcode", "tool-path", "report"]},
        },
    },
    notes={"motion": "Phases of the motion, one after the other, 360 deg in all."},
    facts=deferred(f"{_HERE}.facts:facts"),
    files=DeferredMapping(f"{_HERE}.files:FILES"),
    charts=DeferredMapping(f"{_HERE}.charts:CHARTS"),
    scene=deferred(f"{_HERE}.scene:scene"),
    studies=DeferredMapping(f"{_HERE}.studies:STUDIES"),
    ladders=DeferredMapping(f"{_HERE}.ladder:LADDERS"),
    public=DeferredMapping(f"{_HERE}.public:PUBLIC"),
)
