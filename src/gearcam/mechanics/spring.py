"""The table ``[[spring]]``: a spring that presses the follower onto the cam."""

from __future__ import annotations

from collections.abc import Iterator
from dataclasses import dataclass

from gearcam.base.display import ShortRepr
from gearcam.base.quantities import (
    FORCE,
    STIFFNESS,
    STIFFNESS_PER_RAD,
    TEXT,
    TORQUE,
    Solve,
    param,
)
from gearcam.base.rules import Breach


@dataclass(frozen=True, kw_only=True)
class SpringSpec(ShortRepr):
    """A spring between frame and follower; of an oscillating follower about its pivot.

    Its force is the preload, at zero lift, and the stiffness times the lift. One of both may be
    ``"solve"``: the least that keeps the follower on the cam at the speed of the drive.

    Examples
    --------
    >>> import gearcam as gc
    >>> gc.SpringSpec(stiffness=12.0, preload="solve")
    SpringSpec(stiffness=12, preload='solve')
    """

    on: str = param(TEXT, default="follower", choices=("follower",), doc="member that is loaded")
    stiffness: float | Solve | None = param(
        STIFFNESS, default=None, ge=0, le=1e9, example=12, doc="stiffness of a straight spring"
    )
    preload: float | Solve | None = param(
        FORCE, default=None, ge=0, le=1e9, example=150, doc="its force at zero lift"
    )
    torsion: float | Solve | None = param(
        STIFFNESS_PER_RAD,
        default=None,
        ge=0,
        le=1e9,
        word="stiffness",
        example=8,
        doc="stiffness of a spring about the pivot of an oscillating follower",
    )
    moment: float | Solve | None = param(
        TORQUE, default=None, ge=0, le=1e9, word="preload", example=4, doc="its torque at zero lift"
    )

    def problems(self) -> Iterator[Breach]:
        """Yield contradictions: field, index, message, what is allowed."""
        straight = self.stiffness is not None or self.preload is not None
        swinging = self.torsion is not None or self.moment is not None
        if straight and swinging:
            what = "does not go with stiffness_n_mm or preload_n"
            name = "moment" if self.torsion is None else "torsion"
            yield name, None, what, "either the keys of a straight spring, or of one about a pivot"
        elif not straight and not swinging:
            yield "stiffness", None, "is missing", "a stiffness, a preload, or both"
        if [self.rate, self.force].count("solve") > 1:
            name = "preload" if straight else "moment"
            yield name, None, 'stiffness and preload are both "solve"', "a number for one of them"

    def allowed_on(self, *, oscillating: bool) -> Iterator[Breach]:
        """Yield keys that do not suit the follower."""
        wrong, right = ("stiffness", "preload"), "stiffness_nm_rad and preload_nm"
        if not oscillating:
            wrong, right = ("torsion", "moment"), "stiffness_n_mm and preload_n"
        for name in wrong:
            if getattr(self, name) is not None:
                what = "an oscillating" if oscillating else "a translating"
                yield name, None, f"does not suit {what} follower", right

    @property
    def solved(self) -> bool:
        """Whether its stiffness or preload is solved for."""
        return "solve" in (self.rate, self.force)

    @property
    def rate(self) -> float | Solve:
        """Stiffness, N/mm or N mm/rad, or "solve"."""
        return (self.torsion if self.stiffness is None else self.stiffness) or 0.0

    @property
    def force(self) -> float | Solve:
        """Preload, N or N mm, or "solve"."""
        return (self.moment if self.preload is None else self.preload) or 0.0
