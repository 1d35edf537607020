"""Gear pairs: centrodes, cutters, flanks, outlines, the pair, and the checks of a pair.

`spec`, `rolling`, `cutter` and `flank` need numpy only; `outline` proves its polygons with shapely.
Curves in the plane are complex arrays ``x + 1j*y`` in mm inside this package.
"""
