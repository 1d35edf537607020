"""Units in which people write lengths, angles and other quantities, and their conversion.

A file that says its unit is converted; what a design file wants in mm is answered in mm.

Depends on nothing.
"""

from __future__ import annotations

import math
from typing import Final

_TURN: Final = 2.0 * math.pi
_DEG: Final = _TURN / 360.0

_GROUPS: Final = {
    "a length": {
        "um": 1e-3,
        "µm": 1e-3,
        "mm": 1.0,
        "cm": 10.0,
        "dm": 100.0,
        "m": 1000.0,
        "mil": 0.0254,
        "thou": 0.0254,
        "in": 25.4,
        "inch": 25.4,
        "inches": 25.4,
        '"': 25.4,
        "ft": 304.8,
        "foot": 304.8,
        "feet": 304.8,
        "'": 304.8,
        "yd": 914.4,
    },
    "an angle": {
        "deg": _DEG,
        "degree": _DEG,
        "degrees": _DEG,
        "°": _DEG,
        "rad": 1.0,
        "radians": 1.0,
        "mrad": 1e-3,
        "arcmin": _DEG / 60.0,
        "'": _DEG / 60.0,
        "arcsec": _DEG / 3600.0,
        '"': _DEG / 3600.0,
    },
    "a speed of rotation": {"rpm": 1.0, "1/min": 1.0, "rad/s": 60.0 / _TURN},
    "a speed": {
        "mm/s": 1.0,
        "cm/s": 10.0,
        "m/s": 1000.0,
        "in/s": 25.4,
        "mm/min": 1.0 / 60.0,
        "m/min": 1000.0 / 60.0,
        "in/min": 25.4 / 60.0,
    },
    "a force": {"N": 1.0, "kN": 1000.0, "lbf": 4.4482216152605},
    "a torque": {
        "N m": 1.0,
        "Nm": 1.0,
        "N mm": 1e-3,
        "Nmm": 1e-3,
        "kN m": 1000.0,
        "kNm": 1000.0,
    },
    "a stiffness": {"N/mm": 1.0, "N/m": 1e-3, "kN/m": 1.0, "kN/mm": 1000.0},
    "a mass": {"kg": 1.0, "g": 1e-3, "t": 1000.0, "lb": 0.45359237},
    "a pressure": {"MPa": 1.0, "N/mm2": 1.0, "GPa": 1000.0, "psi": 4.4482216152605 / 645.16},
    "a density": {"kg/m3": 1.0, "g/cm3": 1000.0},
    "an acceleration": {"m/s2": 1.0, "mm/s2": 1e-3},
}
"""Units of each quantity, with their factors to one of them."""


def factor(unit: str, wanted: str) -> float | None:
    """Return the size of a unit in another; None if they measure different things.

    Parameters
    ----------
    unit, wanted : str
        Their names.

    Examples
    --------
    >>> from gearcam.base.units import factor
    >>> factor("in", "mm"), factor("mm", "mm"), factor("deg", "mm")
    (25.4, 1.0, None)
    """
    for group in _GROUPS.values():
        if unit in group and wanted in group:
            return group[unit] / group[wanted]
    return None


def measured_by(unit: str) -> str:
    """Return what a unit measures, such as ``a length``; empty if it is not known."""
    return next((name for name, group in _GROUPS.items() if unit in group), "")


def like(unit: str) -> tuple[str, ...]:
    """Return the units with which the name of a column can end that measure what `unit` does."""
    group = _GROUPS.get(measured_by(unit), {})
    return tuple(name for name in group if name.isascii() and name.isalpha())
