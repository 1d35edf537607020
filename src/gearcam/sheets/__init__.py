"""Sheets: workshop drawings, dimensioned, of each wheel and of the assembled pair.

`sheet` holds what a sheet is made of, `paper` chooses paper and scale and draws frame, table and
title block, `extent` measures outlines, `board` finds free places for dimensions, `wheel` and
`pair` draw the two kinds of sheet. Exporters see sheets only.
"""

from gearcam.sheets.pair import pair_sheet
from gearcam.sheets.wheel import wheel_sheet

__all__ = ["pair_sheet", "wheel_sheet"]
