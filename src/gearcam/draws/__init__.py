"""Random designs: draws of one seed, and what kinds of design make of them."""
