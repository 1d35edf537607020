"""The motion in the design of a cam, for all kinds whose designs have one."""

from __future__ import annotations

from typing import Final

from gearcam.base.registry import deferred
from gearcam.designs.kind import Main
from gearcam.kinds.cam.motion import TITLE, examine_motion, homes, motion_document, words

_DESCRIBED: Final = "gearcam.kinds.cam.describe"

MOTION: Final = Main(
    title=TITLE,
    examine=examine_motion,
    document=motion_document,
    table=deferred(f"{_DESCRIBED}:known"),
    homes=homes,
    schema=deferred(f"{_DESCRIBED}:schema"),
    template=deferred(f"{_DESCRIBED}:lines"),
    laws=deferred(f"{_DESCRIBED}:laws"),
    words=words,
)
