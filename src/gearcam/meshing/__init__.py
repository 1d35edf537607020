"""Meshing: does the pair run? The exact contact of the flanks, and the stepwise proof.

`contact` says for any phase where flanks touch, how they slide and roll, and which pairs carry;
`gap` turns the driven wheel until flanks touch, at the designed centre distance or off it: the
transmission error and the backlash; both are exact and need numpy only. `overlap` turns the
outlines of the pair step by step and intersects them, in `halves` of teeth. `study` puts the three
side by side.
"""
