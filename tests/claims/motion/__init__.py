"""What motion laws must give: the ``CLAIMS`` of every module here, one for each module of laws."""

from __future__ import annotations

import importlib
import pkgutil

from claims.claim import MotionClaims

MOTION_CLAIMS: dict[str, MotionClaims] = {}
for _module in sorted(found.name for found in pkgutil.iter_modules(__path__)):
    MOTION_CLAIMS |= importlib.import_module(f"{__name__}.{_module}").CLAIMS
