"""A kind of design that only a test knows: slider-cranks."""
