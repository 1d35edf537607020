"""Transmission-ratio laws: what motion is wanted, as piecewise analytic functions.

Depends on numpy alone. Importing this package fills the registry `gearcam.laws.base.LAWS`.
"""

from gearcam.laws import (
    centrodes,
    constant,
    ellipse,
    formula,
    motion,
    phases,
    programs,
    rack,
    shapes,
    spiral,
    table,
)

__all__ = [
    "centrodes",
    "constant",
    "ellipse",
    "formula",
    "motion",
    "phases",
    "programs",
    "rack",
    "shapes",
    "spiral",
    "table",
]
