"""Sheets: dimensioned workshop drawings.

`sheet` defines the elements of a sheet, `paper` selects paper and scale and draws frame, table and
title block, `board` places dimensions where there is space, `wheel`
draws the sheet of a part. Exporters use sheets only.
"""

from gearcam.sheets.wheel import wheel_sheet

__all__ = ["wheel_sheet"]
