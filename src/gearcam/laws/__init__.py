"""Ratio laws of gear pairs: ``gearcam.laws.Ellipse(eccentricity=0.3)``.

``dir(gearcam.laws)`` lists them; ``help(gearcam.laws.Ellipse)`` explains one, with an example and
its source. In a design file they are the table ``[law]``. Motion laws of cams are in
``gearcam.motion_laws``.

Examples
--------
>>> import gearcam as gc
>>> law = gc.laws.Ellipse(eccentricity=0.3)
>>> pair = gc.PairSpec(teeth=(30, 30), center_distance=120.0)  # mm
>>> result = gc.build(gc.GearPairDesign(name="ellipse", law=law, pair=pair))
>>> round(result.facts["pair.ratio"]["max"], 6)  # (1 + 0.3)/(1 - 0.3)
1.857143
"""

from __future__ import annotations

from typing import TYPE_CHECKING

from gearcam.base.registry import classes_in, lazy_names

if TYPE_CHECKING:
    from gearcam.laws.ratio import *  # noqa: F403


def _classes() -> dict[str, type]:
    from gearcam.laws.ratio import LAWS

    return classes_in(LAWS)


def _sources() -> dict[type, str]:
    from gearcam.laws.entry import cited
    from gearcam.laws.ratio import LAWS

    return cited(LAWS.values())


if not TYPE_CHECKING:  # type checkers then find misspelt names
    __getattr__, __dir__ = lazy_names("there is no law", _classes, sources=_sources)
