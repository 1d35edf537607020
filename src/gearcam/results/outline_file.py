"""Closed outlines that people measured or drew, read from DXF and CSV files."""

from __future__ import annotations

import numpy as np

from gearcam.base.errors import DesignError, Problem
from gearcam.base.reading import UnreadableError, read
from gearcam.laws.columns import LARGEST, read_rows
from gearcam.numeric.arrays import Array, Plane, as_complex

_COLUMNS = ("x_mm", "y_mm")


def read_closed(
    file: str, *, what: str, outer: bool = False, also: str = ""
) -> tuple[Plane, Array]:
    """Return a closed outline.

    Parameters
    ----------
    file : str
        A DXF file with one closed outline (or one on the layer PROFILE, OUTLINE or INNER), or a CSV
        file with the columns x_mm and y_mm.
    what : str
        What it should be, for messages: "a profile".
    outer : bool
        Whether to take the outline on the layer OUTER rather than INNER.
    also : str
        What else would be allowed, for messages.

    Returns
    -------
    outline : (n,) complex array, mm
        First not repeated.
    bulges : (n,) array
        Bulges of the pieces between them.

    Raises
    ------
    DesignError
        If the file cannot be read, or does not contain such an outline.
    """
    try:
        if file.lower().endswith(".dxf"):
            from gearcam.export.dxf_read import read_outline

            return read_outline(read(file, LARGEST), outer=outer)
        vertices, _ = read_rows(file).columns(_COLUMNS)
    except (UnreadableError, ValueError) as error:
        rule = "a DXF file with one closed outline, or a CSV file with the columns x_mm, y_mm"
        raise DesignError(
            [Problem(f"not {what}: {error}", file=file, allowed=rule + also)]
        ) from error
    return straight(vertices)


def straight(vertices: Array) -> tuple[Plane, Array]:
    """Return a closed outline of points, and the bulges between them: none.

    Parameters
    ----------
    vertices : (n, 2) array, mm
        The points; the last may repeat the first.

    Returns
    -------
    outline : (n,) complex array, mm
        First not repeated.
    bulges : (n,) array
        Zeros.
    """
    outline = as_complex(vertices)
    outline = outline[:-1] if np.array_equal(outline[:1], outline[-1:]) else outline
    return outline, np.zeros(len(outline))
