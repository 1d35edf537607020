"""The table ``[motor]``: what drives the driver, and the flywheel on its shaft."""

from __future__ import annotations

from collections.abc import Iterator, Mapping
from dataclasses import dataclass
from typing import Final

import numpy as np

from gearcam.base.display import ShortRepr
from gearcam.base.quantities import (
    INERTIA,
    RPM,
    STIFFNESS_PER_RAD,
    TEXT,
    TORQUE,
    Row,
    Solve,
    param,
)
from gearcam.base.rules import Breach
from gearcam.mechanics.load import MOST

_NEEDED: Final[Mapping[str, tuple[str, ...]]] = {
    "none": (),
    "speed": (),
    "constant": (),
    "spring": ("torque", "stiffness"),
    "linear": ("start_torque", "idle"),
    "asynchronous": ("breakdown_torque", "breakdown_slip", "synchronous"),
    "table": ("torque", "rpm"),
}
"""Fields of each type of motor that must be given."""

_ALLOWED: Final[Mapping[str, tuple[str, ...]]] = {**_NEEDED, "constant": ("torque",)}

_OF_TYPES: Final = tuple(dict.fromkeys(name for names in _ALLOWED.values() for name in names))


@dataclass(frozen=True, kw_only=True)
class MotorSpec(ShortRepr):
    """What turns the driver, with torques and speeds at the driver's shaft.

    Examples
    --------
    >>> import gearcam as gc
    >>> gc.MotorSpec(type="linear", start_torque=14588.0, idle=19.63)
    MotorSpec(type='linear', start_torque=14588, idle=19.63)
    """

    type: str = param(
        TEXT,
        default="speed",
        choices=tuple(_NEEDED),
        doc="speed: the driver turns evenly, at drive.speed_rpm; constant: an even torque; linear: "
        "a torque that falls with the speed; asynchronous; table; spring: a torque that falls with "
        "the angle; none: the machine coasts",
    )
    torque: Row | None = param(
        TORQUE,
        default=None,
        ge=-MOST,
        le=MOST,
        min_length=1,
        alone=True,
        example=50,
        doc="torque: constant, of a spring at the start, or a list at the speeds `rpm`; of a "
        "constant one left out: the mean of the load",
    )
    stiffness: float | None = param(
        STIFFNESS_PER_RAD,
        default=None,
        gt=0,
        le=1e9,
        example=0.2,
        doc="by how much the torque of a spring falls per rad of the driver",
    )
    start_torque: float | None = param(
        TORQUE, default=None, gt=0, le=MOST, example=400, doc="torque of a linear motor at rest"
    )
    idle: float | None = param(
        RPM, default=None, gt=0, le=1e6, example=190, doc="its speed without load"
    )
    breakdown_torque: float | None = param(
        TORQUE,
        default=None,
        gt=0,
        le=MOST,
        example=120,
        doc="largest torque of an asynchronous motor",
    )
    breakdown_slip: float | None = param(
        default=None, gt=0, le=1, example=0.2, doc="its slip there, as a share"
    )
    synchronous: float | None = param(
        RPM, default=None, gt=0, le=1e6, example=1500, doc="its synchronous speed"
    )
    rpm: Row | None = param(
        default=None,
        ge=0,
        le=1e6,
        min_length=2,
        example=[0, 150, 200],
        doc="speeds of the driver, rpm, at which a table has its torques; a smooth curve between",
    )
    flywheel: float | Solve = param(
        INERTIA,
        default=0.0,
        ge=0,
        le=1e9,
        doc='moment of inertia of a flywheel on the driver\'s shaft; "solve": the least for the '
        "wanted irregularity",
    )
    irregularity: float | None = param(
        default=None,
        gt=0,
        le=1,
        example=0.05,
        doc="largest irregularity of the speed, (max - min)/mean",
    )

    def problems(self) -> Iterator[Breach]:
        """Yield contradictions: field, index, message, what is allowed."""
        kind = self.type
        for name in _OF_TYPES:
            given, allowed = getattr(self, name) is not None, name in _ALLOWED[kind]
            if given and not allowed:
                own = [one for one, names in _ALLOWED.items() if name in names]
                yield name, None, f'does not apply to type = "{kind}"', f"with {' or '.join(own)}"
            elif name in _NEEDED[kind] and not given:
                yield name, None, f'is missing for type = "{kind}"', "a value"
        if self.flywheel == "solve" and self.irregularity is None:
            yield "irregularity", None, 'is missing: flywheel_kg_m2 = "solve" needs it', "0.05, say"
        yield from self._row_problems()

    def _row_problems(self) -> Iterator[Breach]:
        torque, rpm = self.torque or (), self.rpm or ()
        if self.type == "table" and rpm and len(torque) != len(rpm):
            what = f"has {len(rpm)} values, but torque_nm has {len(torque)}"
            yield "rpm", None, what, "one for each torque"
        elif self.type != "table" and len(torque) > 1:
            yield "torque", None, f"has {len(torque)} values", "one value, or a table with rpm"
        back = np.flatnonzero(np.diff(rpm) <= 0.0)
        if back.size:
            yield "rpm", int(back[0]) + 1, "is not above the value before it", "rising values"

    @property
    def turns_evenly(self) -> bool:
        """Whether the driver turns at a given, even speed."""
        return self.type == "speed"
