"""A kind of design that only a test knows: spacers, flat rings."""
