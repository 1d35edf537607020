"""Design files: what is asked for, read strictly, every error at once with its place.

The keys, ranges, schema and messages of a file follow from the parameters of laws, racks, pairs,
followers, cams, blanks and checks; nothing here knows what they mean. Lengths and angles carry
their unit in the file's keys (``_mm``, ``_deg``) and become mm and rad at this door. Each kind of
design is an entry of the registry `gearcam.design.kinds.KINDS`.

Refused: unknown keys, wrong types, values out of range, two values where one decides the other,
kinds of design that this version does not build.
"""

from __future__ import annotations

import importlib
from typing import TYPE_CHECKING, Any, Final

from gearcam.design.kinds import KINDS
from gearcam.design.outputs import FORMATS, CamOutputSpec, OutputSpec
from gearcam.design.reader import load, loads
from gearcam.design.spec import demand_kind, document_of, hash_of

if TYPE_CHECKING:
    from gearcam.design.cam import CamDesign
    from gearcam.design.designs import Design
    from gearcam.design.gear_pair import GearPairDesign, with_meshing

__all__ = [
    "FORMATS",
    "KINDS",
    "CamDesign",
    "CamOutputSpec",
    "Design",
    "GearPairDesign",
    "OutputSpec",
    "demand_kind",
    "document_of",
    "hash_of",
    "load",
    "loads",
    "with_meshing",
]

_HOMES: Final = {
    "CamDesign": "cam",
    "Design": "designs",
    "GearPairDesign": "gear_pair",
    "with_meshing": "gear_pair",
}
"""What only one kind of design needs is loaded when it is asked for."""


def __getattr__(name: str) -> Any:
    if name not in _HOMES:
        raise AttributeError(f"module {__name__!r} has no attribute {name!r}")
    return getattr(importlib.import_module(f"{__name__}.{_HOMES[name]}"), name)
