"""Parts: wheels as they are ordered. Outlines with openings, hubs, marks, moved and rounded edges.

`blank` says what a design wants, `make` puts a part together out of `shapes`, `openings`, `marks`
and `parallel`s; `mass` weighs it, `tools` finds the largest cutter or wire that can make it.
Exporters and solids see parts, never laws. Parts know nothing of teeth but their outlines: they
serve cams too.
"""
