"""Settings of the study of dynamics of pairs and mechanisms."""

from __future__ import annotations

from collections.abc import Iterator
from dataclasses import dataclass
from typing import Final

from gearcam.base.display import ShortRepr
from gearcam.base.quantities import COUNT, INERTIA, TEXT, Quantity, param
from gearcam.base.rules import Breach

DYNAMICS: Final = "dynamics of a machine"
"""The checks of machines in motion."""

VIBRATION: Final = "vibration of teeth"
"""The checks of elastic teeth in motion."""

REGIME, START, TURNS, COAST = "regime", "start", "turns", "coast"

TOOTH_STIFFNESS: Final = Quantity("_n_mm_um", 1.0, "N/(mm um)", least=1e-9)


@dataclass(frozen=True, kw_only=True)
class DynamicsSpec(ShortRepr):
    """Which motion is computed: the regime, from rest, from a speed, or coasting.

    Examples
    --------
    >>> import gearcam as gc
    >>> gc.DynamicsSpec(run="start", turns=10)
    DynamicsSpec(run='start', turns=10)
    """

    run: str = param(
        TEXT,
        default=REGIME,
        choices=(REGIME, START, TURNS, COAST),
        doc="regime: the turn that repeats; start: from rest; turns: from drive.speed_rpm; coast: "
        "from there without a motor",
    )
    turns: int | None = param(
        COUNT,
        default=None,
        ge=1,
        le=100_000,
        example=10,
        doc="number of turns of a run that is no regime, or has elastic wheels; 3 by default, "
        "coasting 100, of an open machine its travel",
    )
    steps: int = param(
        COUNT,
        default=360,
        ge=12,
        le=100_000,
        doc="number of even steps of a turn in dynamics.csv, 100 000 in all at most; both sides of "
        "knots are added",
    )
    tolerance: float = param(
        default=1e-6,
        ge=1e-12,
        le=1e-3,
        doc="relative tolerance of the integration; rigid machines, which cost little, have a "
        "thousandth of it, 1e-12 at least",
    )

    def problems(self) -> Iterator[Breach]:
        """Yield contradictions: field, index, message, what is allowed."""
        if self.turns is not None and self.run == REGIME and not self._settles:
            near = f'left out, or run = "{START}", "{TURNS}" or "{COAST}"'
            yield "turns", None, "has no effect: a regime is one turn, which repeats", near

    @property
    def _settles(self) -> bool:
        """Whether a regime is what has settled after some turns."""
        return False


@dataclass(frozen=True, kw_only=True)
class PairDynamicsSpec(DynamicsSpec):
    """Which motion of a pair is computed, what turns with its shafts, and how its teeth give.

    Examples
    --------
    >>> import gearcam as gc
    >>> gc.PairDynamicsSpec(inertia=(0.18, 0.18), stiffness=14.0)
    PairDynamicsSpec(inertia=(0.18, 0.18), stiffness=14)
    """

    inertia: tuple[float, float] | None = param(
        INERTIA,
        default=None,
        ge=0,
        le=1e9,
        both=True,
        example=[0.18, 0.18],
        doc="moments of inertia of all that turns with each shaft; by default those of wheels that "
        "have a density",
    )
    stiffness: float | None = param(
        TOOTH_STIFFNESS,
        default=None,
        gt=0,
        le=1e6,
        example=14,
        doc="stiffness of a pair of teeth per width: the wheels are then elastic, not rigid",
    )
    finite_elements: bool = param(
        default=False, doc="whether they are elastic as in the study of stress"
    )
    damping_ratio: float = param(
        default=0.06, ge=0, lt=1, doc="damping of the vibration of elastic wheels, of critical"
    )
    rigid: bool = param(default=False, doc="whether wheels are rigid in spite of a stiffness")
    method: str = param(
        TEXT,
        default="auto",
        choices=("auto", "radau", "bdf", "lsoda", "dop853"),
        doc="integrator of elastic wheels; auto: that which costs least",
    )

    def problems(self) -> Iterator[Breach]:
        """Yield contradictions: field, index, message, what is allowed."""
        yield from super().problems()
        if self.stiffness is not None and self.finite_elements:
            what = "is given beside finite_elements"
            yield "stiffness", None, what, "stiffness_n_mm_um, or finite_elements = true"
        if self.inertia is not None and not any(self.inertia):
            yield "inertia", None, "nothing has inertia", "a value above 0 for either shaft"

    @property
    def _settles(self) -> bool:
        """Whether it does, if the wheels are elastic."""
        return self.stiffness is not None or self.finite_elements

    @property
    def elastic(self) -> bool:
        """Whether the wheels are elastic."""
        return (self.stiffness is not None or self.finite_elements) and not self.rigid
