"""The kind ``gear-pair``: what a pair of non-circular gears is read from and what is made of it."""

from __future__ import annotations

from typing import Final

from gearcam.base.registry import DeferredMapping, deferred
from gearcam.designs.kind import Main
from gearcam.designs.outputs import FORMATS
from gearcam.gears.subject import KIND as TEETH
from gearcam.kinds.gear_pair.design import (
    NAME,
    RULES,
    GearPairDesign,
    examine_law,
    law_homes,
    law_of,
    law_table,
    law_words,
    planetary,
    problems,
)
from gearcam.meshing.settings import ERRORS
from gearcam.meshing.settings import KIND as MESHING
from gearcam.parts.blank import KIND as PARTS
from gearcam.results.kind import Kind

_HERE: Final = "gearcam.kinds.gear_pair"

KIND: Final = Kind(
    name=NAME,
    doc="a pair of non-circular gears",
    also=("gear", "gears", "wheels", "pair", "gearpair"),
    design=GearPairDesign,
    result=deferred(f"{_HERE}.result:GearPairResult"),
    main=Main(
        title="law",
        examine=examine_law,
        document=law_of,
        table=lambda raw: law_table(raw["type"]),
        homes=law_homes,
        schema=deferred(f"{_HERE}.describe:schema"),
        template=deferred(f"{_HERE}.describe:lines"),
        laws=deferred(f"{_HERE}.describe:laws"),
        words=law_words,
    ),
    required=("pair",),
    rules=RULES,
    problems=problems,
    later=planetary,
    formats=FORMATS,
    check_modules=(
        "gearcam.gears.checks",
        "gearcam.laws.row_checks",
        "gearcam.meshing.checks",
        "gearcam.meshing.error_checks",
        "gearcam.parts.checks",
    ),
    check_groups=(TEETH, "rows of tables", MESHING, ERRORS, PARTS),
    study_tables={"mesh": "meshing", "errors": "errors", "accuracy": "accuracy"},
    example={
        "law": {
            "type": "phases",
            "shape": "cosine",
            "knots_deg": [0, 160, 360],
            "ratios": [1.25, 0.75, 1.25],
        },
        "pair": {"center_distance_mm": 80, "teeth": [32, 32], "face_width_mm": 10},
        "blank": {"bore_diameter_mm": 8},
        "output": {"files": ["dxf", "csv", "report"]},
    },
    shown={
        "goal": {
            "minimize": "pair.center_distance_mm",
            "maximize": "mesh.contact_ratio.forward.least",
        }
    },
    processes={
        "printing": {
            "pair": {"backlash_mm": 0.1, "face_width_mm": 8},
            "blank": {"clearance_mm": 0.05, "clearance_bores": True},
            "output": {"files": ["stl", "report"], "chord_tolerance_mm": 0.01},
        },
        "laser": {
            "pair": {"backlash_mm": 0.1, "face_width_mm": 4},
            "output": {
                "files": ["dxf", "cut-svg", "report"],
                "kerf_mm": 0.15,
                "chord_tolerance_mm": 0.02,
            },
        },
        "wire": {
            "pair": {"backlash_mm": 0.03},
            "output": {"files": ["dxf", "report"], "kerf_mm": 0.3, "chord_tolerance_mm": 0.002},
        },
    },
    notes={
        "law": "the ratio i21 = dphi2/dphi1 over the driver's angle",
        "pair": "give center_distance_mm or module_mm; the other is computed",
    },
    facts=deferred(f"{_HERE}.facts:facts"),
    files=DeferredMapping(f"{_HERE}.files:FILES"),
    charts=DeferredMapping(f"{_HERE}.charts:CHARTS"),
    scene=deferred(f"{_HERE}.scene:scene"),
    advice=deferred(f"{_HERE}.advice:PairAdvice"),
    studies=DeferredMapping(f"{_HERE}.studies:STUDIES"),
    ladders=DeferredMapping(f"{_HERE}.ladder:LADDERS"),
    public=DeferredMapping(f"{_HERE}.public:PUBLIC"),
)
