"""Parts: wheels as they are ordered. Outlines with openings, hubs, marks, moved and rounded edges.

`blank` says what a design wants, `make` puts a part together out of `shapes`, `openings`, `marks`
and `parallel`s; `mass` weighs it, `tools` finds the largest cutter or wire that can make it.
Exporters and solids see parts, never laws. Parts know nothing of teeth but their outlines: they
serve cams too.
"""

from gearcam.parts.blank import Blank, WheelBlank
from gearcam.parts.make import make_part
from gearcam.parts.marks import timing_mark
from gearcam.parts.mass import mass_properties
from gearcam.parts.openings import Place
from gearcam.parts.part import Hub, Mark, Opening, Part
from gearcam.parts.shapes import Circle, Loop, circle_points, circle_segments

__all__ = [
    "Blank",
    "Circle",
    "Hub",
    "Loop",
    "Mark",
    "Opening",
    "Part",
    "Place",
    "WheelBlank",
    "circle_points",
    "circle_segments",
    "make_part",
    "mass_properties",
    "timing_mark",
]
