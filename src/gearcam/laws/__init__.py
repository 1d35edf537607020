"""Transmission-ratio laws and rises: what motion is wanted, as piecewise analytic functions.

The registries `gearcam.laws.base.LAWS` and `gearcam.laws.rises.RISES` load a law when it is asked
for. Depends on numpy alone.
"""
