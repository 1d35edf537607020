"""Disc cams: from a lift program and a follower to a profile that can be cut.

`spec` holds the settings of a design, `followers` what touches the cam, `carriers` the motion of
the cam beneath it, `curve` pitch curve and profile with exact derivatives; `trim` removes the parts
that the follower itself would cut off, `disc` and others build the cam; `follow` is the inverse,
from points of a profile to the motion.

All computations are for a cam that turns counter-clockwise by theta; a cam for the other direction
is the mirror image.
"""
