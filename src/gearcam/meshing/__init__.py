"""Meshing: exact contact of the flanks, and a stepwise check of the outlines.

`contact` computes for any phase where flanks touch, how they slide and roll, and which pairs carry
load; `edges` turns the driven wheel until flanks or their ends touch, at the design centre distance
or another: transmission error and backlash; `about_to_touch` has the gaps of tips about to touch;
`forces` has the forces of a pair under load; `patches` predicts how flanks overlap when the driver
is turned ahead. These are exact and need numpy only. `overlap` turns the outlines of the pair step
by step, cut into `half_teeth`, and intersects them. `study` compares the three.
"""
