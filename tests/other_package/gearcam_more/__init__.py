"""A package that is not gearcam's: a law of each sort, a part, a format and a study."""
