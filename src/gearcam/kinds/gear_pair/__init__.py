"""Pairs of non-circular gears: the kind ``gear-pair``."""
