"""Meshing: does the pair run? The exact contact of the flanks, and the stepwise proof.

`contact` says for any phase where flanks touch, how they slide and roll, and which pairs carry;
`edges` turns the driven wheel until flanks or their ends touch, at the designed centre distance or
off it: the transmission error and the backlash; `patches` predicts how flanks overlap as the driver
is turned ahead. These are exact and need numpy only. `overlap` turns the outlines of the pair step
by step, cut into `half_teeth`, and intersects them. `study` puts the three side by side.
"""
