"""Sheets: workshop drawings, dimensioned, of each wheel and of the assembled pair.

`sheet` holds what a sheet is made of, `paper` chooses paper and scale and draws frame, table and
title block, `extent` measures outlines, `board` finds free places for dimensions, `wheel` and
`pair` draw the two kinds of sheet. Exporters see sheets only.
"""

from gearcam.sheets.pair import pair_sheet
from gearcam.sheets.sheet import (
    CENTERLINE,
    DIMENSION,
    EDGE,
    FRAME,
    HIDDEN,
    TEXT,
    LinearDimension,
    RoundDimension,
    Sheet,
    Strokes,
    Text,
    strokes,
    text_box,
)
from gearcam.sheets.wheel import wheel_sheet

__all__ = [
    "CENTERLINE",
    "DIMENSION",
    "EDGE",
    "FRAME",
    "HIDDEN",
    "TEXT",
    "LinearDimension",
    "RoundDimension",
    "Sheet",
    "Strokes",
    "Text",
    "pair_sheet",
    "strokes",
    "text_box",
    "wheel_sheet",
]
