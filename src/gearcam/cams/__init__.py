"""Disc cams: from a lift program and a follower to a profile that can be cut.

`spec` says what a design wants, `mechanism` fixes the numbers of a follower, `curve` traces pitch
curve and profile with exact derivatives, `trim` takes away what the follower itself would cut off,
`disc` puts it together; `follow` goes the other way, from points of a profile to the motion.

The cam turns counter-clockwise by theta; everything is computed so, and a cam for the other
direction is the mirror image.
"""
