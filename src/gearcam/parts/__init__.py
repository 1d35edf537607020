"""Parts: wheels as ordered. Outlines with openings, hubs, marks, clearance and rounded edges.

`blank` holds the settings of a design, `make` builds a part from `shapes`, `openings`, `marks` and
`parallel`s; `mass` computes its mass properties, `tools` the largest cutter or wire that can make
it. Exporters and solids use parts, never laws. Of teeth a part has the outlines only, so that
parts serve cams too.
"""
