"""The kind ``globoidal-cam``: what an indexing cam is read from and what is made of it."""

from __future__ import annotations

from typing import Final

from gearcam.base.registry import DeferredMapping, deferred
from gearcam.designs.kind import Main
from gearcam.kinds.globoidal_cam.design import (
    GLOBOIDAL_FORMATS,
    GloboidalCamDesign,
    not_made,
)
from gearcam.kinds.globoidal_cam.index import (
    NAME,
    TITLE,
    examine_index,
    homes,
    index_document,
    known,
    words,
)
from gearcam.results.kind import Kind

_HERE: Final = "gearcam.kinds.globoidal_cam"

KIND: Final = Kind(
    name=NAME,
    doc="a globoidal indexing cam with its turret",
    design=GloboidalCamDesign,
    result=deferred(f"{_HERE}.build:GloboidalCamResult"),
    main=Main(
        title=TITLE,
        examine=examine_index,
        document=index_document,
        table=known,
        homes=homes,
        schema=deferred(f"{_HERE}.describe:schema"),
        template=deferred(f"{_HERE}.describe:lines"),
        laws=deferred(f"{_HERE}.describe:laws"),
        words=words,
    ),
    required=("turret", "cam"),
    later=not_made,
    formats=GLOBOIDAL_FORMATS,
    check_modules=("gearcam.spatial.globoidal_checks", "gearcam.laws.row_checks"),
    check_groups=("globoidal cams", "rows of tables", "solids of globoidal cams"),
    study_tables={"accuracy": "accuracy"},
    example={
        "index": {"law": "modified-sine", "angle_deg": 120},
        "turret": {"stops": 8, "roller_radius_mm": 6, "roller_length_mm": 11, "reach_mm": 47},
        "cam": {
            "form": "globoidal",
            "center_distance_mm": 84,
            "roller_clearance_mm": 0.05,
            "floor_clearance_mm": 0.5,
        },
        "blank": {"bore_diameter_mm": 20},
        "output": {"files": ["stl", "csv", "report"]},
    },
    shown={"goal": {"minimize": "cam.pressure_angle_deg.max", "maximize": "cam.least_rib_mm"}},
    processes={
        "printing": {
            "cam": {"roller_clearance_mm": 0.06, "floor_clearance_mm": 0.5},
            "output": {"files": ["stl", "report"], "wall_step_deg": 1},
        },
    },
    notes={
        "index": "In each turn of the cam the turret moves by one stop, then it rests.",
        "turret": "a wheel with a roller for each stop",
    },
    facts=deferred(f"{_HERE}.facts:facts"),
    files=DeferredMapping(f"{_HERE}.files:FILES"),
    charts=DeferredMapping(f"{_HERE}.charts:CHARTS"),
    scene=deferred(f"{_HERE}.scene:scene"),
    studies=DeferredMapping(f"{_HERE}.studies:STUDIES"),
    ladders=DeferredMapping(f"{_HERE}.ladder:LADDERS"),
    public=DeferredMapping(f"{_HERE}.public:PUBLIC"),
)
