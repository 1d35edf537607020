"""Numbers only: jets, piecewise functions, bracketed roots, arcs and contours.

Depends on numpy alone. Nothing here knows what a gear is.
"""
