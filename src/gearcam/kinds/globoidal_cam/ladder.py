"""The solid of a globoidal cam at rising resolution (see `gearcam.results.ladders`)."""

from __future__ import annotations

from functools import partial
from typing import Final

from gearcam.results.ladders import Ladders, grid_ladder

_LEAST: Final = 72
"""Least number of cam angles of a level."""

LADDERS: Final[Ladders] = {"solid": partial(grid_ladder, least=_LEAST, finer=False)}
"""What `gearcam accuracy` can measure."""
