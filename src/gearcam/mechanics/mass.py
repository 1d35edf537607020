"""The tables ``[[mass]]`` and ``[gravity]``."""

from __future__ import annotations

from collections.abc import Iterator
from dataclasses import dataclass

from gearcam.base.display import ShortRepr
from gearcam.base.quantities import INERTIA, LENGTH, LONGEST, MASS, TEXT, param
from gearcam.base.rules import Breach, needs


@dataclass(frozen=True, kw_only=True)
class MassSpec(ShortRepr):
    """The mass of the follower, or of what moves with it behind an elastic train.

    Examples
    --------
    >>> import gearcam as gc
    >>> gc.MassSpec(mass=0.35)
    MassSpec(mass=0.35)
    """

    of: str = param(
        TEXT,
        default="follower",
        choices=("follower", "train"),
        doc="member that has the mass; train: behind the elastic train of `gearcam dynamics`",
    )
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

    def acting(self, *, oscillating: bool) -> float:
        """Return its mass, N s2/mm, or of what swings (`oscillating`) its inertia, N mm s2."""
        return 1e3 * (self.inertia or 0.0) if oscillating else 1e-3 * (self.mass or 0.0)

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
