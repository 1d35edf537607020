"""Numbers only: jets, piecewise functions, bracketed roots, arcs and contours.

Depends on numpy alone. Nothing here is specific to gears or cams.
"""
