"""Design files: what is asked for, read strictly, every error at once with its place.

The keys, ranges, schema and messages of a file follow from the parameters of laws, racks, pairs,
followers, cams, blanks and checks; nothing here knows what they mean. Lengths and angles carry
their unit in the file's keys (``_mm``, ``_deg``) and become mm and rad at this door. Each kind of
design is an entry of the registry `gearcam.design.kinds.KINDS`.

Refused: unknown keys, wrong types, values out of range, two values where one decides the other,
kinds of design that this version does not build.
"""

from gearcam.design.gear_pair import GearPairDesign, with_meshing

# isort: split
from gearcam.design.cam import CamDesign  # the kinds hang themselves in, in this order
from gearcam.design.kinds import KINDS
from gearcam.design.outputs import CamOutputSpec, OutputSpec
from gearcam.design.reader import Design, load, loads
from gearcam.design.spec import document_of

FORMATS = tuple(dict.fromkeys(name for kind in KINDS.values() for name in kind.formats))
"""Every kind of file that a design of some kind can give."""

__all__ = [
    "FORMATS",
    "KINDS",
    "CamDesign",
    "CamOutputSpec",
    "Design",
    "GearPairDesign",
    "OutputSpec",
    "document_of",
    "load",
    "loads",
    "with_meshing",
]
