"""The table ``[[spring]]``: a spring that presses the follower onto the cam."""

from __future__ import annotations

from collections.abc import Iterator, Mapping
from dataclasses import dataclass, replace
from typing import Final

from gearcam.base.display import ShortRepr
from gearcam.base.quantities import (
    DAMPING,
    DAMPING_PER_RAD,
    FORCE,
    STIFFNESS,
    STIFFNESS_PER_RAD,
    TEXT,
    TORQUE,
    Solve,
    param,
)
from gearcam.base.rules import Breach

_STRAIGHT: Final = ("stiffness", "preload", "damping")
_SWINGING: Final = ("torsion", "moment", "torsion_damping")
"""Fields of a straight spring, and the same of one about a pivot."""


@dataclass(frozen=True, kw_only=True)
class SpringSpec(ShortRepr):
    """A spring between frame and follower; of an oscillating follower about its pivot.

    Its force is the preload, at zero lift, and the stiffness times the lift; with a damper beside
    it also the damping times the velocity, which opposes the motion. One of preload and stiffness
    may be ``"solve"``: the least that keeps the follower on the cam at the speed of the drive.

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
    damping: float | None = param(
        DAMPING, default=None, ge=0, le=1e9, example=0.05, doc="force of its damper over velocity"
    )
    torsion_damping: float | None = param(
        DAMPING_PER_RAD,
        default=None,
        ge=0,
        le=1e9,
        word="damping",
        example=0.01,
        doc="the same of a spring about the pivot",
    )

    def problems(self) -> Iterator[Breach]:
        """Yield contradictions: field, index, message, what is allowed."""
        straight = [one for one in _STRAIGHT if getattr(self, one) is not None]
        swinging = [one for one in _SWINGING if getattr(self, one) is not None]
        if straight and swinging:
            what = "does not go with stiffness_n_mm, preload_n or damping_n_s_mm"
            yield (
                swinging[0],
                None,
                what,
                "either the keys of a straight spring, or of one about a pivot",
            )
        elif not straight and not swinging:
            yield "stiffness", None, "is missing", "a stiffness, a preload, or both"
        if [self.rate, self.force].count("solve") > 1:
            name = "preload" if straight else "moment"
            yield name, None, 'stiffness and preload are both "solve"', "a number for one of them"

    def allowed_on(self, *, oscillating: bool) -> Iterator[Breach]:
        """Yield keys that do not suit the follower."""
        wrong, right = _STRAIGHT, "stiffness_nm_rad, preload_nm and damping_nm_s_rad"
        if not oscillating:
            wrong, right = _SWINGING, "stiffness_n_mm, preload_n and damping_n_s_mm"
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

    @property
    def drag(self) -> float:
        """Damping, N s/mm or N mm s/rad."""
        return (self.torsion_damping if self.damping is None else self.damping) or 0.0

    def with_solved(self, solved: Mapping[str, float]) -> SpringSpec:
        """Return it with what is solved for: ``preload`` or ``stiffness``, N or N mm, and so on."""
        straight = self.stiffness is not None or self.preload is not None
        names = _STRAIGHT if straight else _SWINGING
        found = {names[what == "preload"]: value for what, value in solved.items()}
        return replace(self, **{k: v for k, v in found.items() if getattr(self, k) == "solve"})
