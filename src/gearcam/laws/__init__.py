"""Transmission-ratio laws, rises and lift programs: what displacement is wanted.

The registries `gearcam.laws.ratio.base.LAWS` and `gearcam.laws.rises.base.RISES` load a law when
it is asked for. Depends on numpy alone.

The parameters of ratio laws are attributes: ``gearcam.laws.Ellipse(eccentricity=0.3)``.
"""

from __future__ import annotations

from gearcam.registry import classes_in, lazy_classes


def _classes() -> dict[str, type]:
    from gearcam.laws.ratio.base import LAWS

    return classes_in(LAWS)


__getattr__, __dir__ = lazy_classes("law", _classes)
