"""What is shown, as data: drawings with layers, charts, moving scenes; and SVG and HTML as text.

Inputs are parts, in mm, and arrays of numbers with the labels of their axes. Writers of files
(`gearcam.export`), the report and the live view take these data.

Depends on parts and numeric.
"""
