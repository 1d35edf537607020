"""Rises: S over phi on the unit square, each in the registry `rises.base.RISES`.

Their parameters are attributes: ``gearcam.rises.Cycloidal()``.
"""

from __future__ import annotations

from gearcam.registry import classes_in, lazy_classes


def _classes() -> dict[str, type]:
    from gearcam.laws.rises.base import RISES

    return classes_in(RISES)


__getattr__, __dir__ = lazy_classes("rise", _classes)
