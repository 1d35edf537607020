"""The checks of the study of a mechanism's torque; importing this module registers them."""

from __future__ import annotations

import math
from collections.abc import Iterator, Mapping
from dataclasses import dataclass
from typing import Final, NamedTuple

from gearcam.base.display import ShortRepr
from gearcam.base.findings import Remark, check
from gearcam.base.numerals import formatted
from gearcam.base.quantities import TORQUE as NEWTON_METRES
from gearcam.base.quantities import Param

TORQUE: Final = "torque of a mechanism"
"""Name of the subject of its checks."""

_LESS: Final = 0.99
"""Share of the driver's moment that is less than it."""


class Pull(NamedTuple):
    """The most with which a mechanism pulls a follower off a cam that does not hold it.

    Attributes
    ----------
    cam : str
        Where the cam is in the design.
    size : float
        Of the pull, above 0.
    unit : str
        N, or N m of an oscillating follower.
    place : str
        Where it is, in words.
    """

    cam: str
    size: float
    unit: str
    place: str


@dataclass(frozen=True, kw_only=True)
class DriverEffort(ShortRepr):
    """The largest moment that the driver of a mechanism exerts, and those behind other drives.

    Parameters
    ----------
    peak : float, N m
        The largest size of the moment.
    place : str
        Where it is, in words.
    others : mapping of str to float, N m
        The same behind other drives, by their names.
    gain : str
        How a pair multiplies the moment there, as a sentence; empty without one.
    pulls : tuple of Pull
        Of followers that the mechanism pulls off their cams.
    """

    peak: float
    place: str
    others: Mapping[str, float]
    gain: str = ""
    pulls: tuple[Pull, ...] = ()


_LIMIT: Final = (
    "drive_torque",
    Param(NEWTON_METRES, ge=0, le=1e9, doc="largest torque of the mechanism's drive; 0: no limit"),
    0.0,
)


@check(
    "drive-torque",
    kind=TORQUE,
    limit=_LIMIT,
    relation="at most",
    severity=("note", "warning"),
    unit="N m",
)
def drive_torque(effort: DriverEffort, limit: float) -> Iterator[Remark]:
    """Warn if the mechanism needs more torque than its drive has; tell if another drive needs less.

    Looks at: the largest moment of the driver, and of each drive that is compared; behind a pair
    that of an even shaft, if none is.
    """
    if limit and effort.peak > limit / NEWTON_METRES.factor:
        what = "The mechanism needs more torque than its drive has."
        yield Remark(what, effort.place, effort.peak, "warning")
    for name, other in effort.others.items():
        if other < _LESS * effort.peak:
            times = formatted(effort.peak / other, 3) if other > 0.0 else "many"
            message = (
                f"The driver exerts up to {formatted(effort.peak, 5)} N m, {times} times the "
                f"{formatted(other, 5)} N m of the same mechanism behind {name!r}."
                f"{effort.gain}"
            )
            yield Remark(message, effort.place, effort.peak, limit=math.inf)


@check("lift-off", kind=TORQUE, severity="note")
def lift_off(effort: DriverEffort, limit: float) -> Iterator[Remark]:  # noqa: ARG001
    """Tell where a mechanism pulls a follower off its cam, which must be held there.

    Looks at: what each follower exerts in its lift, of cams with one wall, without the springs and
    loads of the cam's own design.
    """
    for pull in effort.pulls:
        message = (
            f"The machine pulls the follower off its cam, with up to {formatted(pull.size, 5)} "
            f"{pull.unit}. A spring in the cam's own design must hold it, or a groove or conjugate "
            "cams."
        )
        yield Remark(message, f"{pull.cam}, {pull.place}", pull.size, unit=pull.unit)
