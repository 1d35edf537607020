"""Sheets: dimensioned workshop drawings.

`spec` has the table ``[drawing]``, `sheet` defines the elements of a sheet, `dimensions` how
dimensions are drawn, `paper` selects paper and scale and draws frame, tables and title block,
`board` places dimensions where there is space, `sections` cuts parts, `symbols` draws tolerance
frames, `wheel` has the data of a part's sheet, `callouts` what stands on leaders, `part` draws the
sheet, `tiles` outlines at full size on several pages. Exporters use sheets only.
"""
