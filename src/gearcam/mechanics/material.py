"""The table ``[material]``: elasticity and strength of both parts of a contact."""

from __future__ import annotations

from dataclasses import dataclass
from typing import Any, Final

from gearcam.base.display import ShortRepr
from gearcam.base.quantities import DENSITY, MPA, NUMBER, TEXT, param

MATERIALS: Final[dict[str, tuple[float, float]]] = {
    "steel": (206000.0, 0.3),
    "cast-iron": (105000.0, 0.26),
    "bronze": (110000.0, 0.34),
    "pom": (2800.0, 0.37),
    "pla": (3300.0, 0.36),
    "petg": (2000.0, 0.38),
}
"""Young's modulus, MPa, and Poisson's ratio by names: usual values of handbooks (metals) and of
data sheets (plastics, solid, at room temperature). Strength depends on the grade: not listed."""


def _both(quantity: Any, example: Any, *, doc: str, **bounds: Any) -> Any:
    more = {"both": True, "order": "first part and second part", "example": example}
    return param(quantity, default=None, doc=doc, **more, **bounds)


@dataclass(frozen=True, kw_only=True)
class MaterialSpec(ShortRepr):
    """Materials of cam and roller, or of driver and driven wheel: one for both, or two.

    Values that are given take the place of those of the name.

    Examples
    --------
    >>> import gearcam as gc
    >>> round(gc.MaterialSpec().contact_modulus)  # steel on steel
    113187
    >>> round(gc.MaterialSpec(name=("pom", "steel")).contact_modulus)
    3198
    """

    name: tuple[str, ...] = param(
        TEXT,
        default=("steel",),
        choices=tuple(MATERIALS),
        min_length=1,
        doc="material of both parts, or of each",
    )
    young_modulus: tuple[float, float] | None = _both(
        MPA, [206000, 206000], doc="Young's modulus", gt=0, le=1e7
    )
    poisson: tuple[float, float] | None = _both(
        NUMBER, [0.3, 0.3], doc="Poisson's ratio", ge=0, le=0.49
    )
    yield_strength: tuple[float, float] | None = param(
        MPA,
        default=None,
        both=True,
        order="first part and second part",
        word="yield",
        gt=0,
        le=1e5,
        example=[800, 900],
        doc="yield stress",
    )
    density: tuple[float, float] | None = _both(
        DENSITY, [7850, 7850], doc="density", gt=0, le=30000
    )

    @property
    def elasticity(self) -> tuple[tuple[float, float], tuple[float, float]]:
        """Young's modulus, MPa, and Poisson's ratio of the first part and of the second."""
        first, second = MATERIALS[self.name[0]], MATERIALS[self.name[-1]]
        young = self.young_modulus or (first[0], second[0])
        poisson = self.poisson or (first[1], second[1])
        return (young[0], poisson[0]), (young[1], poisson[1])

    @property
    def contact_modulus(self) -> float:
        """``1/((1 - nu1^2)/E1 + (1 - nu2^2)/E2)``, MPa."""
        return 1.0 / sum((1.0 - poisson**2) / young for young, poisson in self.elasticity)
