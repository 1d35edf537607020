"""The table ``[[bearing]]``: friction of single joints."""

from __future__ import annotations

import math
from collections.abc import Iterator
from dataclasses import dataclass
from typing import TYPE_CHECKING, Any

from gearcam.base.quantities import LENGTH, LONGEST, param
from gearcam.base.rules import Breach
from gearcam.kinds.mechanism.keys import Sort, WithNames, named
from gearcam.linkages.bonds import Bond, Hinge
from gearcam.linkages.friction import Friction, GuideFriction, JournalFriction

if TYPE_CHECKING:
    from gearcam.kinds.mechanism.parts.friction import MachineFrictionSpec


@dataclass(frozen=True, kw_only=True)
class BearingSpec(WithNames):
    """Friction of one hinge or guide, instead of that in ``[friction]``.

    Examples
    --------
    >>> import gearcam as gc
    >>> gc.BearingSpec(on="B", coefficient=0.1, radius=8.0)
    BearingSpec(on='B', coefficient=0.1, radius=8)
    """

    on: str = named(
        needs=f"{Sort.JOINT} or {Sort.GUIDE} or {Sort.SHAFT} or {Sort.WAY} or {Sort.MEMBER}",
        example="B",
        doc="a joint, a guide, the shaft or slide of a drive, or a member: the lever of a chain, "
        "what a hoist lifts, a Geneva wheel",
    )
    coefficient: float | None = param(
        default=None, ge=0, le=2, example=0.1, doc="of friction; that in [friction] if left out"
    )
    radius: float | None = param(
        LENGTH,
        default=None,
        gt=0,
        le=LONGEST,
        example=8,
        doc="radius of the journal of a hinge; as in [friction] if left out",
    )
    length: float | None = param(
        LENGTH,
        default=None,
        gt=0,
        le=LONGEST,
        example=80,
        doc="length of what slides in a guide; long if left out",
    )

    def problems(self) -> Iterator[Breach]:
        """Yield contradictions: field, index, message, what is allowed."""
        if self.radius is not None and self.length is not None:
            yield "length", None, "is given beside radius_mm", "radius_mm of a hinge, or length_mm"

    def of(self, bond: Bond, general: MachineFrictionSpec) -> Friction[Any]:
        """Return its friction.

        Parameters
        ----------
        bond : Bond
            A hinge or guide.
        general : MachineFrictionSpec
            What holds where nothing is given.

        Raises
        ------
        ValueError
            If something is missing, or is that of the other sort.
        """
        hinged = isinstance(bond, Hinge)
        usual = general.joint if hinged else general.guide
        coefficient = self.coefficient if self.coefficient is not None else usual
        if hinged:
            radius = self.radius or general.journal_radius
            if self.length is not None:
                raise ValueError("is a hinge, which has a radius_mm and no length_mm")
            if radius is None:
                raise ValueError("is a hinge, and its radius_mm is missing")
            return JournalFriction(coefficient=coefficient, radius=radius)
        if self.radius is not None:
            raise ValueError("is a guide, which has a length_mm and no radius_mm")
        return GuideFriction(
            coefficient=coefficient, length=self.length or general.guide_length or math.inf
        )
