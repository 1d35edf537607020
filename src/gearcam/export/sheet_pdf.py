"""PDF of workshop drawings: paper at full size, with real text in the standard font Helvetica.

Dates and identifiers are left out: the same sheet gives the same bytes.

Refused: letters that the standard font does not have.

Depends on sheets and drawings; reportlab only inside the functions.
"""

from __future__ import annotations

import io
from collections.abc import Iterable
from typing import Any, Final

import numpy as np

from gearcam.base.errors import InfeasibleError
from gearcam.numeric.arrays import Plane, as_pairs
from gearcam.sheets.sheet import CAPITAL, RULE, Box, DrawnLine, Sheet, Text

POINT: Final = 72.0 / 25.4
"""Points in a millimetre."""


def sheet_pdf(sheets: Iterable[Sheet], title: str, window: Box | None = None) -> bytes:
    """Return sheets as the pages of a PDF.

    Parameters
    ----------
    sheets : iterable of Sheet
        One for each page.
    title : str
        Title of the document.
    window : complex, complex, mm of paper, optional
        Corners of what is shown of lines, except those of tables and rulers.

    Returns
    -------
    bytes
        The same for the same sheets.

    Raises
    ------
    InfeasibleError
        If a text has letters that the font does not have.
    """
    from reportlab.pdfgen.canvas import Canvas

    stream = io.BytesIO()
    canvas = Canvas(stream, invariant=True, pageCompression=1)
    canvas.setTitle(title)
    canvas.setCreator("gearcam")
    for sheet in sheets:
        wide, tall = sheet.size
        canvas.setPageSize((POINT * wide, POINT * tall))
        canvas.scale(POINT, POINT)
        canvas.setLineJoin(1)
        canvas.saveState()
        if window:
            low, size = window[0], window[1] - window[0]
            path = canvas.beginPath()
            path.rect(low.real, low.imag, size.real, size.imag)
            canvas.clipPath(path, 0)
        drawn_lines = list(sheet.drawn_lines)
        _drawn(canvas, [one for one in drawn_lines if one.kind != RULE])
        canvas.restoreState()
        _drawn(canvas, [one for one in drawn_lines if one.kind == RULE])
        for black in sheet.blacks:
            _path(canvas, black, closed=True, fill=True)
        for text in sheet.words:
            _text(canvas, sheet, text)
        canvas.showPage()
    canvas.save()
    return stream.getvalue()


def _drawn(canvas: Any, drawn_lines: Iterable[DrawnLine]) -> None:
    for line in drawn_lines:
        canvas.setLineWidth(line.width)
        canvas.setDash(line.dashes)
        _path(canvas, line.points, closed=line.closed, fill=False)
    canvas.setDash([])


def _path(canvas: Any, points: Plane, *, closed: bool, fill: bool) -> None:
    path = canvas.beginPath()
    first, *rest = as_pairs(points).tolist()
    path.moveTo(*first)
    for point in rest:
        path.lineTo(*point)
    if closed:
        path.close()
    canvas.drawPath(path, int(not fill), int(fill))


def _text(canvas: Any, sheet: Sheet, text: Text) -> None:
    try:
        text.text.encode("cp1252")
    except UnicodeEncodeError as error:
        what = f"a PDF cannot show {text.text[error.start : error.end]!r} of {text.text!r}"
        note = "drawing-svg and drawing-dxf, or letters of western Europe"
        raise InfeasibleError(what, where="output.files", nearest=note) from error
    at = complex(sheet.on_paper(np.array([text.place]))[0])
    canvas.saveState()
    canvas.translate(at.real, at.imag)
    canvas.rotate(90.0 if text.upright else 0.0)
    canvas.scale(text.squeeze, 1.0)
    canvas.setFont("Helvetica", text.height / CAPITAL)
    (canvas.drawCentredString if text.anchor == "middle" else canvas.drawString)(0, 0, text.text)
    canvas.restoreState()
