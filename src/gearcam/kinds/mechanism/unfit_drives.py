"""Drives that cannot be the master or replace another one, and keys that they have in vain."""

from __future__ import annotations

from collections.abc import Iterator
from typing import TYPE_CHECKING

from gearcam.designs.faults import Fault, show
from gearcam.kinds.mechanism.names import is_read
from gearcam.kinds.mechanism.tables import MachineDrive

if TYPE_CHECKING:
    from gearcam.designs.kind import Examined
    from gearcam.kinds.mechanism.tables import CompareSpec


def problems(found: Examined) -> Iterator[Fault]:
    """Yield what is wrong with the drives of a mechanism, and with those to compare.

    Parameters
    ----------
    found : Examined
        The valid tables.
    """
    drives, compared = (found.parts.get(title, ()) for title in ("drive", "compare"))
    yield from _sliding("drive", drives)
    yield from _sliding("compare", compared)
    for number, one in enumerate(drives):
        yield from _without_effect(number, one)
    if drives and drives[0].slide is not None:
        what = f"{show(drives[0].slide)} has no angle over which the motion could be given"
        allowed = "a first drive with pair, cam or even = true, and the slide behind it"
        yield Fault(("drive", 0, "slide"), what, drives[0].slide, allowed)
    if drives and is_read("drive", found):
        for number, one in enumerate(compared):
            yield from _not_comparable(number, one, drives[0])


def _sliding(
    title: str, drives: tuple[MachineDrive, ...] | tuple[CompareSpec, ...]
) -> Iterator[Fault]:
    """Yield cams without an angle over which motion could be given."""
    for number, one in enumerate(drives):
        if getattr(getattr(one.cam, "cam", None), "form", "") == "translating":
            what = f"the cam {show(getattr(one.cam, 'name', ''))} slides: it has no shaft"
            yield Fault((title, number, "cam"), what, None, "a cam that turns")


def _without_effect(number: int, one: MachineDrive) -> Iterator[Fault]:
    """Yield keys that a drive is given in vain."""
    if not number or one.slide is not None:
        why = "the first drive is the master" if not number else "its formula is in the master's q"
        for key, value, usual in (("ratio", one.ratio, 1), ("phase_deg", one.phase, 0.0)):
            if value != usual:
                yield Fault(("drive", number, key), f"has no effect: {why}", value, f"{usual:g}")
    if number and one.speed is not None:
        what = "has no effect: the speed is that of the first drive"
        yield Fault(("drive", number, "speed_rpm"), what, None, "the key in the first drive")


def _not_comparable(number: int, one: CompareSpec, master: MachineDrive) -> Iterator[Fault]:
    """Yield that a drive to compare does not have the shafts of the first drive."""
    if one.even:
        if master.pair is None:
            what = "cannot replace the first drive, which is not a pair"
            yield Fault(("compare", number, "even"), what, True, "where a pair is the master")
        return
    own = MachineDrive(name=master.name, pair=one.pair, cam=one.cam)
    if one.key and own.shafts != master.shafts:
        what = f"does not have the shafts of {master.name}: {', '.join(master.shafts)}"
        allowed = "a drive of the same sort; an even shaft stands beside a pair with even = true"
        yield Fault(("compare", number, one.key), what, allowed=allowed)
