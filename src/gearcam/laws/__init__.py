"""Transmission-ratio laws, rises and lift programs: what displacement is wanted.

The registries `gearcam.laws.ratio.base.LAWS` and `gearcam.laws.rises.base.RISES` load a law when
it is asked for. Depends on numpy alone.
"""
