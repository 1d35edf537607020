"""The studies of globoidal cams, and the solid at rising resolution (`gearcam.results.ladders`)."""

from __future__ import annotations

from functools import partial
from typing import Final

from gearcam.kinds.shared import accuracy_study
from gearcam.results.ladders import Ladders, grid_ladder

_LEAST: Final = 72
"""Least number of cam angles of a level."""

LADDERS: Final[Ladders] = {"solid": partial(grid_ladder, least=_LEAST, finer=False)}
"""What `gearcam accuracy` can measure."""


STUDIES: Final = {one.name: one for one in (accuracy_study(),)}
"""Studies by name."""
