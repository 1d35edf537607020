"""The kind ``mechanism``: what a mechanism is read from and what is made of it."""

from __future__ import annotations

from collections.abc import Iterator, Mapping
from typing import TYPE_CHECKING, Any, Final

from gearcam.base.registry import DeferredMapping, deferred
from gearcam.kinds.mechanism import drives, names
from gearcam.kinds.mechanism.asked import TABLES
from gearcam.kinds.mechanism.design import FORMATS, NAME, STUDIES, MechanismDesign
from gearcam.results.kind import Kind

if TYPE_CHECKING:
    from gearcam.designs.faults import Fault
    from gearcam.designs.kind import Examined

_HERE: Final = "gearcam.kinds.mechanism"


def _problems(document: Mapping[str, Any], found: Examined) -> Iterator[Fault]:
    faults = [*drives.problems(found), *names.problems(document, found)]
    faults += names.unasked(document, found)
    yield from faults
    yield from names.unfit(found, faults)


KIND: Final = Kind(
    name=NAME,
    doc="a linkage that a pair, a cam or an even shaft drives",
    also=("linkage", "linkages", "four-bar", "machine"),
    design=MechanismDesign,
    result=deferred(f"{_HERE}.result:MechanismResult"),
    required=("drive",),
    problems=_problems,
    formats=FORMATS,
    check_modules=("gearcam.linkages.checks", f"{_HERE}.torque"),
    check_groups=("mechanisms", TABLES, "torque of a mechanism"),
    study_tables={name: name for name in STUDIES},
    example={
        "drive": [{"name": "motor", "even": True, "speed_rpm": 60}],
        "joint": [{"name": "D", "at_mm": [110, 0]}],
        "crank": [{"name": "crank", "on": "motor", "joint": "B", "length_mm": 30}],
        "dyad": [
            {
                "type": "RRR",
                "from": "B",
                "to": "D",
                "joint": "C",
                "members": ["coupler", "rocker"],
                "lengths_mm": [100, 90],
            }
        ],
        "point": [{"name": "P", "on": "coupler", "at_mm": [49, 34]}],
        "output": {"files": ["csv", "report"]},
    },
    shown={
        "goal": {"minimize": "outputs.P_x.acceleration_mm_s2", "maximize": "outputs.P_x.stroke_mm"}
    },
    facts=deferred(f"{_HERE}.shown:facts"),
    files=DeferredMapping(f"{_HERE}.shown:FILES"),
    charts=DeferredMapping(f"{_HERE}.shown:CHARTS"),
    scene=deferred(f"{_HERE}.drawn:scene"),
    studies=DeferredMapping(f"{_HERE}.torque:STUDIES"),
    ladders=DeferredMapping(f"{_HERE}.drawn:LADDERS"),
    public=DeferredMapping(f"{_HERE}.public:PUBLIC"),
    cut=False,
)
