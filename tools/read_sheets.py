"""Read workshop drawings back from other programs: texts, their heights, decimals and prefixes.

SVG is read in a browser, as its texts and the heights of capitals in the font that it takes; DXF in
LibreCAD, which prints a PDF of lines, and in FreeCAD, as the texts and distances that its importer
makes. LibreCAD draws letters as lines: each text of a drawing is looked for among these lines as
the same text drawn alone is, in any place, direction and size, and its size tells its height. So a
text with another decimal or prefix is not found.

Run: python tools/read_sheets.py [PROFILE ...], by default all in profiles/. Programs that are not
there are left out. FreeCAD measures dimensions anew: of these the distances are compared.
"""

from __future__ import annotations

import json
import os
import shutil
import subprocess
import sys
from collections import Counter
from dataclasses import dataclass, field
from pathlib import Path
from tempfile import TemporaryDirectory
from typing import Any

import numpy as np

import gearcam
from gearcam.base.errors import GearcamError
from gearcam.export.dxf import DxfStyle, document_text
from gearcam.export.sheet_dxf import STYLE, sheet_dxf
from gearcam.export.sheet_svg import sheet_svg
from gearcam.sheets.sheet import Sheet

ROOT = Path(__file__).resolve().parents[1]
TALL = 10.0
"""Height of the texts that are drawn alone, mm."""

MANY = 40
"""Texts on a drawing of texts alone: more would be too small to compare."""

CLOSE = 0.02
"""Largest distance of points of letters, over their height, that are the same."""

_FREECAD = """
import json, os, FreeCAD, Import
params = FreeCAD.ParamGet("User parameter:BaseApp/Preferences/Mod/Draft")
params.SetBool("dxfUseLegacyImporter", False)
params.SetBool("dxfShowDialog", False)
params.SetBool("dxftext", True)
found = {}
for name in json.loads(os.environ["SHEETS"]):
    document = FreeCAD.newDocument("d")
    Import.readDXF(name, document.Name)
    made = document.Objects
    found[name] = {
        "texts": [text for one in made for text in getattr(one, "LabelText", ())],
        "distances": [float(one.Distance) for one in made if hasattr(one, "Distance")],
    }
    FreeCAD.closeDocument(document.Name)
open(os.environ["FOUND"], "w").write(json.dumps(found))
"""

_BROWSER = """
const found = [];
const canvas = document.createElement('canvas').getContext('2d');
for (const text of document.querySelectorAll('svg text')) {
  const style = getComputedStyle(text);
  canvas.font = `1000px ${style.fontFamily}`;
  const capital = canvas.measureText('H').actualBoundingBoxAscent / 1000;
  found.push([text.textContent, parseFloat(style.fontSize) * capital]);
}
return found;
"""


@dataclass
class Report:
    """What was read: numbers of texts, largest error of a height, and what differs."""

    texts: int = 0
    height_off: float = 0.0
    differing: list[str] = field(default_factory=list)

    def take(self, sheet: str, height: float | None, wanted: float, words: str) -> None:
        """Count a text; a `height` of None means that it was not found."""
        self.texts += 1
        if height is None:
            self.differing.append(f"{sheet}: {words!r}")
        else:
            self.height_off = max(self.height_off, abs(height / wanted - 1.0))

    def __str__(self) -> str:
        """Return the figures as a line."""
        off = f"heights within {100.0 * self.height_off:.2f} %"
        return f"{self.texts} texts, {off}, {len(self.differing)} differ" + "".join(
            f"\n  {one}" for one in self.differing[:20]
        )


def in_browser(sheets: dict[str, Sheet], driver: Any) -> Report:
    """Read sheets as SVG in a browser that selenium controls."""
    report = Report()
    with TemporaryDirectory() as folder:
        for name, sheet in sheets.items():
            page = Path(folder) / "sheet.html"
            page.write_bytes(b"<!doctype html><meta charset=utf-8>" + sheet_svg(sheet))
            driver.get(page.as_uri())
            shown = [(words, height) for words, height in driver.execute_script(_BROWSER)]
            for text in sheet.words:
                near = [one for one in shown if one[0] == text.text]
                height = min((h for _, h in near), key=lambda h: abs(h - text.height), default=None)
                report.take(name, height, text.height, text.text)
            extra = Counter(words for words, _ in shown) - Counter(one.text for one in sheet.words)
            report.differing += [f"{name}: {words!r} is more" for words in extra]
    return report


def in_freecad(sheets: dict[str, Sheet]) -> Report:
    """Read sheets as DXF in FreeCAD: texts exactly, linear dimensions as distances."""
    report = Report()
    with TemporaryDirectory() as folder:
        files = {name: f"{folder}/{k}.dxf" for k, name in enumerate(sheets)}
        for name, file in files.items():
            Path(file).write_bytes(sheet_dxf(sheets[name], DxfStyle(tolerance=1e-3)))
        script, found = Path(folder) / "read.py", Path(folder) / "found.json"
        script.write_text(_FREECAD)
        place = {**os.environ, "SHEETS": json.dumps([*files.values()]), "FOUND": str(found)}
        subprocess.run(["freecadcmd", str(script)], env=place, capture_output=True, check=False)
        read = json.loads(found.read_text())
    for name, file in files.items():
        texts = Counter(read[file]["texts"])
        measured = [one for one in sheets[name].dimensions if one.kind in ("linear", "vertical")]
        labels = [one.text for one in sheets[name].dimensions if one.kind == "label"]
        for text in (*sheets[name].texts, *labels):
            report.take(name, text.height if texts[text.text] else None, text.height, text.text)
            texts[text.text] -= 1
        for one in measured:
            wanted = abs(one.points[2] - one.points[1])  # it measures from point to point
            off = min((abs(value - wanted) for value in read[file]["distances"]), default=1.0)
            report.take(name, 1.0 if off < 1e-5 else None, 1.0, one.label)
    return report


def printed(data: bytes, folder: Path) -> list[np.ndarray]:
    """Return the lines of a DXF file as LibreCAD prints them, in order: points, in mm."""
    import pypdfium2
    import pypdfium2.raw as raw

    file = folder / "sheet.dxf"
    file.write_bytes(data)
    words = f"xvfb-run -a librecad dxf2pdf -m -a -p 1189x841 -f 0,0,0,0 {file}"
    subprocess.run(words.split(), cwd=folder, capture_output=True, check=False)
    page = pypdfium2.PdfDocument(file.with_suffix(".pdf").read_bytes())[0]
    return [line for one in page.get_objects((raw.FPDF_PAGEOBJ_PATH,)) for line in _lines(one, raw)]


def _lines(one: Any, raw: Any) -> list[np.ndarray]:
    from ctypes import byref, c_float

    lines: list[list[complex]] = []
    x, y = c_float(), c_float()
    a, b, c, d, e, f = one.get_matrix().get()
    for number in range(raw.FPDFPath_CountSegments(one.raw)):
        segment = raw.FPDFPath_GetPathSegment(one.raw, number)
        raw.FPDFPathSegment_GetPoint(segment, byref(x), byref(y))
        if raw.FPDFPathSegment_GetType(segment) == raw.FPDF_SEGMENT_MOVETO:
            lines.append([])
        at = a * x.value + c * y.value + e, b * x.value + d * y.value + f
        lines[-1].append(complex(*at))
    return [np.array(line) for line in lines]


def marks(lines: list[np.ndarray]) -> np.ndarray:
    """Return first, middle and last point of lines, (n, 3)."""
    ways = [np.append(0.0, np.cumsum(np.abs(np.diff(line)))) for line in lines]
    return np.array(
        [
            np.interp([0.0, 0.5 * way[-1], way[-1]], way, line)
            for way, line in zip(ways, lines, strict=True)
        ]
    )


Alone = dict[tuple[str, float], np.ndarray]


def drawn_alone(texts: list[tuple[str, float]], folder: Path) -> Alone:
    """Return the marks of texts of the height 1 as LibreCAD draws them."""
    flag, edge = 777.0, ("A", 1.0)
    padded = [edge, *texts, edge]  # what touches the edge of the paper may be cut

    def fill(document: Any) -> None:
        document.styles.add(STYLE, font="arial.ttf")
        space = document.modelspace()
        for number, (text, squeeze) in enumerate(padded):
            there = {"style": STYLE, "width": squeeze}
            made = space.add_text(text, height=TALL, dxfattribs=there)
            made.set_placement((0.0, -2.0 * TALL * number))
            space.add_line((-flag, -2.0 * TALL * number), (0.0, -2.0 * TALL * number))

    lines = printed(document_text("R2010", fill).encode(), folder)
    wide = max(abs(line[-1] - line[0]) for line in lines)
    found, own = [], []
    for line in lines:
        if len(line) == 2 and abs(line[1] - line[0]) > 0.999 * wide:
            found.append(marks(own) * flag / wide / TALL)
            own = []
        else:
            own.append(line)
    return dict(zip(texts, found[1:-1], strict=True))


def height_of(alone: np.ndarray, lines: np.ndarray, wanted: float) -> float | None:
    """Return the height of a text among lines that is nearest to that which is `wanted`."""
    count = len(alone)
    if len(lines) < count:
        return None
    own = alone.ravel() - alone.mean()
    parts = np.lib.stride_tricks.sliding_window_view(lines, count, axis=0)
    parts = parts.transpose(0, 2, 1).reshape(len(lines) - count + 1, -1)
    parts = parts - parts.mean(axis=1, keepdims=True)
    scale = parts @ np.conj(own) / (np.abs(own) ** 2).sum()
    off = np.abs(parts - scale[:, None] * own).max(axis=1)
    same = off < CLOSE * np.abs(scale)
    heights = np.abs(scale[same])
    return min(heights.tolist(), key=lambda one: abs(one - wanted), default=None)


def in_librecad(sheets: dict[str, Sheet], drawn: dict[str, Sheet] | None = None) -> Report:
    """Read sheets as DXF in LibreCAD, by the lines of its letters; those `drawn` may be others."""
    report = Report()
    with TemporaryDirectory() as name:
        folder = Path(name)
        texts = sorted({(text.text, text.squeeze) for one in sheets.values() for text in one.words})
        alone: Alone = {}
        for first in range(0, len(texts), MANY):
            alone |= drawn_alone(texts[first : first + MANY], folder)
        for name, sheet in sheets.items():
            shown = (drawn or sheets)[name]
            lines = printed(sheet_dxf(shown, DxfStyle(tolerance=1e-3)), folder)
            flat = np.concatenate(lines)
            # the frame is the outermost: it tells what a mm of paper is in the print
            size = np.ptp(np.real(flat)) / (sheet.size[0] - 30.0)
            found = marks(lines)
            for text in sheet.words:
                wanted = text.height * size
                height = height_of(alone[text.text, text.squeeze], found, wanted)
                near = height is not None and abs(height / wanted - 1.0) < 0.1
                report.take(name, height if near else None, wanted, text.text)
    return report


def sheets_of(names: list[str]) -> dict[str, Sheet]:
    """Return the sheets of profiles by their names; those that are refused are left out."""
    found: dict[str, Sheet] = {}
    for name in names:
        try:
            result = gearcam.build(gearcam.load(name))
            made = getattr(result, "sheets", ())
        except GearcamError:
            continue
        found |= {f"{Path(name).stem} {sheet.name}": sheet for sheet in made}
    return found


def main() -> None:
    """Read the sheets of profiles in each program that is there."""
    names = sys.argv[1:] or sorted(map(str, (ROOT / "profiles").glob("*.toml")))
    sheets = sheets_of(names)
    print(f"{len(sheets)} sheets")
    if shutil.which("librecad") and shutil.which("xvfb-run"):
        print("LibreCAD:", in_librecad(sheets))
    if shutil.which("freecadcmd"):
        print("FreeCAD:", in_freecad(sheets))
    if shutil.which("chromium") and shutil.which("chromedriver"):
        driver = browser()
        print("browser:", in_browser(sheets, driver))
        driver.quit()


def browser() -> Any:
    """Return a browser without a window."""
    from selenium.webdriver import Chrome, ChromeOptions, ChromeService

    options = ChromeOptions()
    options.binary_location = shutil.which("chromium") or ""
    for word in ("--headless=new", "--no-sandbox", "--disable-background-networking"):
        options.add_argument(word)
    return Chrome(options=options, service=ChromeService(shutil.which("chromedriver")))


if __name__ == "__main__":
    main()
