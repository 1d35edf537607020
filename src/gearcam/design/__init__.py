"""Design files: what is asked for, read strictly, every error at once with its place.

The keys, ranges, schema and messages of a file follow from the parameters of laws, racks, pairs,
blanks and checks; nothing here knows what they mean. Lengths and angles carry their unit in the
file's keys (``_mm``, ``_deg``) and become mm and rad at this door.

Refused: unknown keys, wrong types, values out of range, two values where one decides the other,
kinds of design that this version does not build.
"""

from gearcam.design.reader import load, loads
from gearcam.design.spec import GearPairDesign, document_of, with_meshing
from gearcam.design.tables import FORMATS, KIND, OutputSpec

__all__ = [
    "FORMATS",
    "KIND",
    "GearPairDesign",
    "OutputSpec",
    "document_of",
    "load",
    "loads",
    "with_meshing",
]
