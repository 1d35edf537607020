"""Design files: what is asked for, read strictly, every error at once with its place.

The keys, ranges, schema and messages of a file follow from the parameters of laws, racks, pairs,
followers, cams, blanks and checks; nothing here knows what they mean. Lengths and angles carry
their unit in the file's keys (``_mm``, ``_deg``) and become mm and rad at this door. The kinds of
design are found by `gearcam.designs.kind.KINDS`.

Refused: unknown keys, wrong types, values out of range, two values where one decides the other,
kinds of design that this version does not build.
"""

from __future__ import annotations

from gearcam.designs.design import Design, demand_kind, design, document_of, hash_of
from gearcam.designs.kind import KINDS
from gearcam.designs.reader import load, loads

__all__ = ["KINDS", "Design", "demand_kind", "design", "document_of", "hash_of", "load", "loads"]
