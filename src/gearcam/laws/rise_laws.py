"""All rises: importing this module fills the registry `gearcam.laws.rises.RISES`."""

from __future__ import annotations

from gearcam.laws import (
    rise_formula,
    rise_points,
    rise_polynomials,
    rise_scca,
    rise_simple,
    rise_trapezoids,
)

__all__ = [
    "rise_formula",
    "rise_points",
    "rise_polynomials",
    "rise_scca",
    "rise_simple",
    "rise_trapezoids",
]
