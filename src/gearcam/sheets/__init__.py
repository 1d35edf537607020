"""Sheets: dimensioned workshop drawings.

`spec` has the table ``[drawing]``, `sheet` defines the elements of a sheet, `dimensions` how
dimensions are drawn, `paper` selects paper and scale and draws frame, tables and title block,
`board` places dimensions where there is space, `sections` cuts parts, `symbols` draws tolerance
frames, `part` draws the sheet of a part, `turned` that of a cam in space, `tiles` outlines at full
size on several pages. Exporters use sheets only.
"""
