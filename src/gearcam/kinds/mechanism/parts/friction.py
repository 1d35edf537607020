"""The table ``[friction]``."""

from __future__ import annotations

import math
from dataclasses import dataclass
from typing import TYPE_CHECKING, Any

from gearcam.base.display import ShortRepr
from gearcam.base.quantities import param, positive_length
from gearcam.base.rules import needs

if TYPE_CHECKING:
    from gearcam.linkages.bonds import Bond
    from gearcam.linkages.friction import Friction


@dataclass(frozen=True, kw_only=True)
class MachineFrictionSpec(ShortRepr):
    """Coefficients of friction of a mechanism, 0 where left out, and sizes of its bearings.

    Of single ones ``[[bearing]]`` gives others.

    Examples
    --------
    >>> import gearcam as gc
    >>> gc.MachineFrictionSpec(joint=0.1, journal_radius=8.0)
    MachineFrictionSpec(joint=0.1, journal_radius=8)
    """

    joint: float = param(
        default=0.0, ge=0, le=2, zero_is_none=True, doc="of the journals of all hinges and shafts"
    )
    guide: float = param(default=0.0, ge=0, le=2, zero_is_none=True, doc="of all straight guides")
    journal_radius: float | None = positive_length(example=8, doc="radius of the journals")
    guide_length: float | None = positive_length(
        example=80, doc="length of what slides in the guides; long if left out"
    )

    rules = (
        needs("joint", "journal_radius"),
        needs("journal_radius", "joint"),
        needs("guide_length", "guide"),
    )

    def of(self, bond: Bond) -> Friction[Any] | None:
        """Return the friction of a hinge or guide; None without."""
        from gearcam.linkages.bonds import Hinge  # only the study of forces has friction
        from gearcam.linkages.friction import GuideFriction, JournalFriction

        if isinstance(bond, Hinge):
            if not self.joint or self.journal_radius is None:
                return None
            return JournalFriction(coefficient=self.joint, radius=self.journal_radius)
        length = math.inf if self.guide_length is None else self.guide_length
        return GuideFriction(coefficient=self.guide, length=length) if self.guide else None
