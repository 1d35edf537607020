"""Settings of the study of stress of a pair."""

from __future__ import annotations

from dataclasses import dataclass

from gearcam.base.display import ShortRepr
from gearcam.base.quantities import ANGLE, COUNT, LENGTH, LONGEST, TEXT, param
from gearcam.base.rules import distinct


@dataclass(frozen=True, kw_only=True)
class StressSpec(ShortRepr):
    """Phases of the study of stress, what holds the wheels, and which teeth are certified.

    Examples
    --------
    >>> import gearcam as gc
    >>> gc.StressSpec(phases=360)
    StressSpec(phases=360)
    """

    plane: str = param(
        TEXT,
        default="strain",
        choices=("strain", "stress"),
        doc="what is 0 across the wheels: strain, as in wide ones, or stress, as in thin plates",
    )
    held_diameter: tuple[float, float] | None = param(
        LENGTH,
        default=None,
        gt=0,
        le=LONGEST,
        both=True,
        example=[40, 40],
        doc="circle on which each wheel is held; by default its bore, or half its root diameter",
    )
    phases: int | None = param(
        COUNT,
        default=None,
        ge=12,
        le=100000,
        example=360,
        doc="number of phases of the turn, evenly spaced; by default 10 for each tooth",
    )
    alone: bool = param(default=False, doc="whether each pair of teeth has the whole load in turn")
    edges: bool = param(
        default=True, doc="whether teeth that are about to touch may carry on their edges"
    )
    wheel: int | None = param(
        COUNT,
        default=None,
        ge=1,
        le=2,
        example=1,
        doc="wheel whose stress is certified; both by default, with teeth wheel 1",
    )
    teeth: tuple[int, ...] | None = param(
        COUNT,
        default=None,
        ge=1,
        min_length=1,
        example=[18],
        doc="teeth that are certified, at their own worst phases; by default the worst one",
    )
    phi1: float | None = param(
        ANGLE,
        default=None,
        ge=0,
        le=360,
        example=172,
        doc="phase that is certified, in place of the worst ones",
    )
    tolerance: float = param(
        default=0.01, ge=1e-3, le=0.1, doc="relative error of certified stresses"
    )

    rules = (distinct("teeth", "tooth"),)
