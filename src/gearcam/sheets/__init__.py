"""Sheets: dimensioned workshop drawings of each wheel and of the assembled pair.

`sheet` defines the elements of a sheet, `paper` selects paper and scale and draws frame, table and
title block, `extent` measures outlines, `board` places dimensions where there is space, `wheel` and
`pair` draw the two types of sheet. Exporters use sheets only.
"""

from gearcam.sheets.pair import pair_sheet
from gearcam.sheets.wheel import wheel_sheet

__all__ = ["pair_sheet", "wheel_sheet"]
