"""The kind ``cam``: what a cam with its follower is read from and what is made of it."""

from __future__ import annotations

from typing import Final

from gearcam.base.registry import DeferredMapping, deferred
from gearcam.cams.spec import FITTED, FOLLOWED, FORCES, PRECISION
from gearcam.cams.spec import KIND as CAM
from gearcam.kinds.cam.design import NAME, RULES, CamDesign, problems
from gearcam.kinds.cam.forms.base import VARIANTS
from gearcam.kinds.cam.main import MOTION
from gearcam.kinds.cam.tables import CAM_FORMATS
from gearcam.parts.blank import KIND as PARTS
from gearcam.results.kind import Kind

_HERE: Final = "gearcam.kinds.cam"

KIND: Final = Kind(
    name=NAME,
    doc="a cam with its follower",
    design=CamDesign,
    result=deferred(f"{_HERE}.build:CamResult"),
    main=MOTION,
    variants=VARIANTS,
    required=("follower", "cam"),
    rules=RULES,
    problems=problems,
    formats=CAM_FORMATS,
    check_modules=(
        "gearcam.cams.checks",
        "gearcam.laws.row_checks",
        "gearcam.cams.force_checks",
        "gearcam.parts.checks",
    ),
    check_groups=(CAM, "rows of tables", PARTS, FOLLOWED, FITTED, FORCES, PRECISION),
    study_tables={name: name for name in ("follow", "forces", "precision", "accuracy")},
    example={
        "motion": [
            {"type": "rise", "angle_deg": 120, "law": "cycloidal", "lift_mm": 10},
            {"type": "dwell", "angle_deg": 60},
            {"type": "return", "angle_deg": 120, "law": "cycloidal"},
            {"type": "dwell", "angle_deg": "rest"},
        ],
        "follower": {"type": "roller", "motion": "translating", "roller_radius_mm": 8},
        "cam": {"prime_radius_mm": 42, "thickness_mm": 10},
        "blank": {"bore_diameter_mm": 8},
        "output": {"files": ["dxf", "csv", "report"]},
    },
    shown={
        "goal": {
            "minimize": "cam.profile.radius_mm.max",
            "maximize": "cam.curvature.profile_convex_min_mm",
        }
    },
    processes={
        "printing": {
            "cam": {"thickness_mm": 8},
            "blank": {"clearance_mm": 0.05, "clearance_bores": True},
            "output": {"files": ["stl", "report"], "chord_tolerance_mm": 0.01},
        },
        "laser": {
            "cam": {"thickness_mm": 4},
            "output": {
                "files": ["dxf", "cut-svg", "report"],
                "kerf_mm": 0.15,
                "chord_tolerance_mm": 0.02,
            },
        },
        "wire": {
            "output": {"files": ["dxf", "report"], "kerf_mm": 0.3, "chord_tolerance_mm": 0.002}
        },
    },
    notes={
        "motion": "Phases of the motion, one after the other, 360 deg in all.",
        "cam": "give prime_radius_mm or base_radius_mm; with a flat follower base_radius_mm",
    },
    facts=deferred(f"{_HERE}.facts:facts"),
    files=DeferredMapping(f"{_HERE}.files:FILES"),
    charts=DeferredMapping(f"{_HERE}.charts:CHARTS"),
    scene=deferred(f"{_HERE}.scene:scene"),
    advice=deferred(f"{_HERE}.advice:CamAdvice"),
    studies=DeferredMapping(f"{_HERE}.studies:STUDIES"),
    ladders=DeferredMapping(f"{_HERE}.ladder:LADDERS"),
    public=DeferredMapping(f"{_HERE}.public:PUBLIC"),
)
