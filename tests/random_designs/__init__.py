"""Random designs: reproducible random numbers, and designs drawn from them."""
