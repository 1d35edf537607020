"""The tables ``[[mass]]`` and ``[gravity]``."""

from __future__ import annotations

import cmath
from collections.abc import Iterator
from dataclasses import dataclass

from gearcam.base.display import ShortRepr
from gearcam.base.quantities import (
    ACCELERATION,
    ANGLE,
    INERTIA,
    LENGTH,
    LONGEST,
    MASS,
    TEXT,
    param,
)
from gearcam.base.rules import Breach, needs

G = 9.80665
"""Standard acceleration of gravity, m/s2."""


@dataclass(frozen=True, kw_only=True)
class MassSpec(ShortRepr):
    """The mass of the follower with all that moves with it.

    Examples
    --------
    >>> import gearcam as gc
    >>> gc.MassSpec(mass=0.35)
    MassSpec(mass=0.35)
    """

    of: str = param(TEXT, default="follower", choices=("follower",), doc="member that has the mass")
    mass: float | None = param(MASS, default=None, gt=0, le=1e6, example=0.35, doc="mass")
    inertia: float | None = param(
        INERTIA,
        default=None,
        gt=0,
        le=1e9,
        example=0.0004,
        doc="moment of inertia of an oscillating follower about its pivot",
    )
    center: float | None = param(
        LENGTH,
        default=None,
        ge=-LONGEST,
        le=LONGEST,
        example=30,
        doc="centre of mass of an oscillating follower, from its pivot towards the contact",
    )

    rules = (needs("center", "mass"),)

    def problems(self) -> Iterator[Breach]:
        """Yield contradictions: field, index, message, what is allowed."""
        if self.mass is None and self.inertia is None:
            yield "mass", None, "is missing", "mass_kg, or inertia_kg_m2 about a pivot"

    def allowed_on(self, *, oscillating: bool) -> Iterator[Breach]:
        """Yield what does not suit the follower."""
        if oscillating and self.inertia is None:
            yield "inertia", None, "is missing for an oscillating follower", "inertia_kg_m2"
        for name in () if oscillating else ("inertia", "center"):
            if getattr(self, name) is not None:
                yield name, None, "does not apply to a translating follower", "mass_kg alone"


@dataclass(frozen=True, kw_only=True)
class GravitySpec(ShortRepr):
    """The direction in which gravity pulls; none without it.

    Examples
    --------
    >>> import gearcam as gc
    >>> import math
    >>> gc.GravitySpec(direction=math.radians(-90.0)).given
    True
    """

    direction: float | None = param(
        ANGLE,
        default=None,
        ge=-360,
        le=360,
        example=-90,
        doc="direction of the pull, from the x axis of the assembled cam, or of the machine; of a "
        "cam in space from y towards z, the cam's axis, of a globoidal cam from x towards z",
    )
    g: float = param(ACCELERATION, default=G, ge=0, le=1000, doc="acceleration")

    rules = (needs("g", "direction"),)

    @property
    def given(self) -> bool:
        """Whether gravity acts."""
        return self.direction is not None

    @property
    def pull(self) -> complex:
        """Acceleration, m/s2, in the frame of its direction; 0 where none is given."""
        return 0j if self.direction is None else cmath.rect(self.g, self.direction)
