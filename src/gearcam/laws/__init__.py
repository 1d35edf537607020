"""Transmission-ratio laws: what motion is wanted, as piecewise analytic functions.

Depends on numpy alone. Importing this package fills the registry `gearcam.laws.base.LAWS`.
"""

from gearcam.laws import constant, ellipse, formula, phases

__all__ = ["constant", "ellipse", "formula", "phases"]
