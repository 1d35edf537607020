"""The globoidal cam of the reference values, and the indexer of the profiles."""

from __future__ import annotations

import math
from typing import Any

import gearcam as gc
from gearcam.base.tolerances import DEFAULT
from gearcam.laws.indexing import index_program
from gearcam.laws.motion import MOTION_LAWS
from gearcam.spatial.envelope import Roller
from gearcam.spatial.globoidal import GloboidalCam
from helpers_pairs import PROFILES

INDEX = math.radians(120.0)

DESIGN = gc.load(PROFILES / "globoidal_indexer.toml").with_({"output.files": ["csv"]})


def indexer(law: str = "modified-sine", **more: Any) -> GloboidalCam:
    """Eight stops, 120 degrees, centre distance 100 mm, rollers of 8 mm between 44.5 and 58 mm."""
    stops = more.get("stops", 8)
    given: dict[str, Any] = {
        "program": index_program(
            MOTION_LAWS[law].parameters(), INDEX, 2.0 * math.pi / stops, DEFAULT
        ),
        "distance": 100.0,
        "stops": stops,
        "roller": Roller(radius=8.0),
        "top": 44.5,
        "reach": 58.0,
        "floor": math.hypot(58.0, 8.0) + 0.5,
        "length": 46.0,
    }
    return GloboidalCam(**given | more)


def reference() -> GloboidalCam:
    """Centre distance 80 mm, roller 10 mm, six stops in 120 degrees."""
    return indexer(stops=6, distance=80.0, roller=Roller(radius=10.0), top=38.0, reach=55.0)
