"""Laws of the transmission ratio, motion laws and lift programs.

The registries `gearcam.laws.ratio.LAWS` and `gearcam.laws.motion.MOTION_LAWS` load a law
when it is used. Depends on numpy only.

The parameters of ratio laws are attributes: ``gearcam.laws.Ellipse(eccentricity=0.3)``.

Examples
--------
>>> import gearcam as gc
>>> gc.laws.Ellipse(eccentricity=0.3)
Ellipse(eccentricity=0.3, lobes=None)
"""

from __future__ import annotations

from typing import TYPE_CHECKING

from gearcam.base.registry import classes_in, lazy_names

if TYPE_CHECKING:
    from gearcam.laws.ratio import *  # noqa: F403


def _classes() -> dict[str, type]:
    from gearcam.laws.ratio import LAWS

    return classes_in(LAWS)


if not TYPE_CHECKING:  # type checkers then find misspelt names
    __getattr__, __dir__ = lazy_names("there is no law", _classes)
