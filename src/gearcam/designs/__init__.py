"""Design files: strict reading that reports all mistakes at once, each with its place.

The keys, ranges, schema and messages derive from the parameter classes of laws, racks, pairs,
followers, cams, blanks and checks; this package does not know what they mean. Keys of lengths and
angles end with their unit (``_mm``, ``_deg``); values are converted to mm and rad here. The kinds
of design are in `gearcam.designs.kind.KINDS`.

Refused: unknown keys, wrong types, values out of range, two values where one determines the other,
and kinds of design that this version does not support.
"""

from __future__ import annotations

from gearcam.designs.design import Design, design, document_of, hash_of, load, loads
from gearcam.designs.kind import KINDS

__all__ = ["KINDS", "Design", "design", "document_of", "hash_of", "load", "loads"]
