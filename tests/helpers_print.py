"""Pages as they are printed: by the browser to PDF, read by pdfium as text and as pictures.

Canvases are printed as drawings, so that what they write is text too.
"""

from __future__ import annotations

import base64
import ctypes
from collections.abc import Iterator
from dataclasses import dataclass
from itertools import combinations
from typing import Any, Final

import numpy as np
import pypdfium2
from pypdfium2 import raw
from selenium.webdriver import Chrome

POINT: Final = 72 / 25.4
"""Points in a millimetre."""

PAPERS: Final = {"A4": (210.0, 297.0), "Letter": (215.9, 279.4)}
"""Width and height, mm."""

ASTRAY: Final = 20.0
"""From the next letter, points: the letters of a ligature that pdfium has not placed."""

CLEAR: Final = 1.0
"""What two words may share, points."""

FINE: Final = 2.0
"""Pixels in a point, of the pictures of pages."""

Box = tuple[float, float, float, float]
"""Left, bottom, right and top, points."""

_Sign = tuple[str, Box, Box]


@dataclass(frozen=True)
class Word:
    """Characters that stand side by side, in the box of their ink.

    `rows` are the bottom and the top of the line, which all its words share.
    """

    text: str
    box: Box
    rows: tuple[float, float]


@dataclass(frozen=True)
class Row:
    """Words on one line."""

    text: str
    bottom: float
    top: float


@dataclass(frozen=True)
class Sheet:
    """One printed page: its words in the order of printing, its colours, and their luminance."""

    size: tuple[float, float]
    words: list[Word]
    colours: np.ndarray[Any, Any]
    picture: np.ndarray[Any, Any]

    @property
    def rows(self) -> list[Row]:
        """The lines from above; of columns side by side the first one comes first."""
        found: list[list[Word]] = []
        for word in sorted(self.words, key=lambda one: (-round(one.rows[0]), one.box[0])):
            if found and abs(found[-1][0].rows[0] - word.rows[0]) < 2.0:
                found[-1].append(word)
            else:
                found.append([word])
        return [Row(" ".join(one.text for one in row), *row[0].rows) for row in found]

    def ink(self, box: Box) -> np.ndarray[Any, Any]:
        """The luminance of what is in a box."""
        left, bottom, right, top = (round(FINE * one) for one in box)
        high = self.picture.shape[0]
        return self.picture[max(0, high - top) : high - bottom, max(0, left) : right]


def printed(browser: Chrome, paper: str, margin: float) -> list[Sheet]:
    """Print the page that is open on a paper, with margins in mm on all sides."""
    width, height = PAPERS[paper]
    inches = dict.fromkeys(
        ("marginTop", "marginBottom", "marginLeft", "marginRight"), margin / 25.4
    )
    sizes = {"paperWidth": width / 25.4, "paperHeight": height / 25.4}
    done = browser.execute_cdp_cmd("Page.printToPDF", inches | sizes)
    document = pypdfium2.PdfDocument(base64.b64decode(done["data"]))
    try:
        return [_sheet(document[k]) for k in range(len(document))]
    finally:
        document.close()


def _sheet(page: Any) -> Sheet:
    text = page.get_textpage()
    words = [*_words(text)]
    text.close()
    colours = page.render(scale=FINE).to_numpy()[:, :, :3].astype(float)[:, :, ::-1] / 255.0
    linear = np.where(colours <= 0.04045, colours / 12.92, ((colours + 0.055) / 1.055) ** 2.4)
    picture = linear @ np.array([0.2126, 0.7152, 0.0722])
    return Sheet(page.get_size(), words, colours, picture)


def _words(text: Any) -> Iterator[Word]:
    """Yield runs of characters: a space, or another line, ends one."""
    run: list[_Sign] = []
    for sign in _signs(text):
        if run and (sign is None or not _beside(run[-1][2], sign[2])):
            yield _word(run)
            run = []
        if sign is not None:
            run.append(sign)
    if run:
        yield _word(run)


def _signs(text: Any) -> list[_Sign | None]:
    """Characters with the boxes of their ink and of their place; None of spaces.

    The letters of a ligature, whose boxes pdfium does not place, have those of the next letter.
    White letters, the halos of names in pictures, are left out.
    """
    signs: list[_Sign | None] = []
    after: tuple[Box, Box] | None = None
    for k in reversed(range(text.count_chars())):
        sign = chr(raw.FPDFText_GetUnicode(text.raw, k))
        if sign.isspace() or sign == "\x02":  # pdfium's sign of a hyphen at the end of a line
            signs.append(None)
            continue
        if _is_white(raw.FPDFText_GetTextObject(text.raw, k)):
            continue
        ink, place = text.get_charbox(k), text.get_charbox(k, loose=True)
        if after and ink == place and abs(ink[1] - after[0][1]) > ASTRAY:
            ink, place = after
        after = ink, place
        signs.append((sign, ink, place))
    return signs[::-1]


def _is_white(letter: Any) -> bool:
    parts = [ctypes.c_uint() for _ in range(4)]
    raw.FPDFPageObj_GetFillColor(letter, *parts)
    return all(one.value == 255 for one in parts[:3])


def _beside(one: Box, other: Box) -> bool:
    on = abs(other[1] - one[1]) < 1.0
    return one == other or (on and abs(other[0] - one[2]) < 2.0)


def _word(run: list[_Sign]) -> Word:
    left, bottom, right, top = zip(*(one for _, one, _ in run), strict=True)
    box = min(left), min(bottom), max(right), max(top)
    return Word("".join(sign for sign, _, _ in run), box, (run[0][2][1], run[0][2][3]))


def shared(one: Box, other: Box) -> float:
    """The smaller of width and height that two boxes share, points; 0 or less if they are apart."""
    wide = min(one[2], other[2]) - max(one[0], other[0])
    high = min(one[3], other[3]) - max(one[1], other[1])
    return min(wide, high)


def overlaps(sheet: Sheet) -> list[tuple[str, str]]:
    """Words that lie on other words."""
    return [
        (one.text, other.text)
        for one, other in combinations(sheet.words, 2)
        if shared(one.box, other.box) > CLEAR
    ]


def outside(sheet: Sheet, margin: float) -> list[str]:
    """What lies outside the margins, in mm: words and ink."""
    edge = margin * POINT - 0.6  # half a pixel of the page
    width, height = sheet.size
    limits = (edge, edge, width - edge, height - edge)

    def out(box: Box) -> bool:
        return box[0] < limits[0] or box[1] < limits[1] or box[2] > limits[2] or box[3] > limits[3]

    found = [one.text for one in sheet.words if out(one.box)]
    frame = sheet.picture.copy()
    inner = max(0, int(FINE * edge) - 1)
    frame[inner : frame.shape[0] - inner, inner : frame.shape[1] - inner] = 1.0
    return found + (["ink"] if frame.min() < 0.9 else [])


def filled(sheet: Sheet, margin: float) -> float:
    """The share of a page's height within its margins that is above the lowest ink."""
    rows = np.flatnonzero((sheet.picture < 0.9).any(axis=1))
    edge = FINE * margin * POINT
    if not rows.size:
        return 0.0
    return float((rows[-1] - edge) / (sheet.picture.shape[0] - 2.0 * edge))


def found(sheet: Sheet, text: str, start: int = 0) -> tuple[Box, int] | None:
    """The box of a text among the words from a place on, and the place after it; None without."""
    wanted = "".join(text.split())
    for first in range(start, len(sheet.words)):
        k, run = first, ""
        while k < len(sheet.words) and len(run) < len(wanted) and wanted.startswith(run):
            run += sheet.words[k].text
            k += 1
        if run == wanted:
            boxes = [one.box for one in sheet.words[first:k]]
            left, bottom, right, top = zip(*boxes, strict=True)
            return (min(left), min(bottom), max(right), max(top)), k
    return None
