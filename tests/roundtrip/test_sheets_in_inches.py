"""Workshop drawings in inches beside those in mm, each read back from its files."""

from __future__ import annotations

import math
import re
import xml.etree.ElementTree as ET
from collections import Counter
from collections.abc import Iterator
from functools import cache
from typing import Any

import numpy as np
import pypdfium2
import pytest
from ezdxf import bbox
from ezdxf.entities.dimension import Dimension
from ezdxf.lldxf.encoding import decode_dxf_unicode

import gearcam
from gearcam.base.inches import files_in
from gearcam.export.dxf_read import measure_dxf, read_dxf
from gearcam.kinds.cam.calipers import caliper_table
from gearcam.sheets.sheet import SERIES
from helpers_built import built
from helpers_contour import edges
from helpers_pairs import PROFILES
from helpers_sampling import chosen
from helpers_sheets import faults

INCH = 25.4
ROUNDED = 0.5e-4 + 0.5e-3 / INCH + 1e-9
"""Largest difference of a size in ten-thousandths of an inch and one in thousandths of a mm, in."""

CHANGES: dict[str, dict[str, Any]] = {
    "shop_order": {},
    "inch_pair": {
        "blank.bore_diameter_mm": ["12 H7", "12 JS6"],
        "blank.keyway_width_mm": "4 P9",
        "blank.chamfer_mm": 0.5,
        "blank.set_screw": "M3",
        "drawing.runout_mm": 0.03,
        "drawing.profile_tolerance_mm": 0.02,
    },
    "ellipse": {},
    "log_spiral": {"blank.stop_pin_mm": 3},
    "gate_rack": {},
    "groove_cam": {"drawing.surface": "Ra 1.6"},
    "plate_cam_oscillating": {},
    "translating_cam": {},
    "yoke_cam": {},
    "cylinder_cam": {},
    "ordered_drum": {},
    "globoidal_indexer": {},
}
R12 = {"output.dxf_version": "R12", "output.dxf_curves": "lines"}
NAMES = chosen(list(CHANGES), "inch_pair", "translating_cam", "cylinder_cam")

RENAMED = {"module": "diametral pitch", "mm, deg": "inch, deg"}
"""Texts that differ in more than a unit and numbers."""

TOKEN = re.compile(
    r"(?:hole |tooth |space |gear)\d+|\d+ x |[a-zA-Z]+\d+(?= \()|M\d+|theta = 0"
    r"|-?[\d.]+ (?:to [\d.]+ )?deg|[\d.]+°|[\d.]+ g mm"
    r"|(?P<number>-?\d+\.?\d*(?:e-?\d+)?)|[^\d\s-]+|-"
)
"""What is the same in every unit, or a number."""

LENGTHS = re.compile(r"\d in\b|Ø|\bX |^Chamfer")
"""What cells with lengths have in them."""

OF_LENGTHS = re.compile(
    r", mm$|^(?:mark|arrow|slot, width|slot, mid|max\.|min\.|profile of|circular run-out)"
)
"""What the cells on their left, or above them, have."""


@cache
def results(name: str) -> tuple[Any, Any]:
    """The same design with files in mm and in inches."""
    design = gearcam.load(PROFILES / f"{name}.toml").with_(CHANGES[name])
    return tuple(built(design.with_({"output.units": units})) for units in ("mm", "inch"))  # type: ignore[return-value]


class Page:
    """The texts of a drawing as a program shows them."""

    def __init__(self, data: bytes) -> None:
        found = ET.fromstring(data).findall(".//{http://www.w3.org/2000/svg}text")
        self.texts = [one.text or "" for one in found]
        starts = [one.get("text-anchor") == "start" for one in found]
        self.drawn = [text for text, start in zip(self.texts, starts, strict=True) if not start]
        """Texts in the views."""
        at = [(float(one.get("x", "")), float(one.get("y", ""))) for one in found]
        self.placed = [
            (*place, text)
            for place, text, start in zip(at, self.texts, starts, strict=True)
            if start
        ]
        self.cells = [(self._label(x, y), text) for x, y, text in self.placed]
        """Texts of tables and notes, each behind its column's title, or what is on its left."""

    def _label(self, x: float, y: float) -> str:
        for other, _, text in self.placed:
            if other == x and re.search(r"^\w+, (mm|in|deg)$", text):
                return text
        left = [(other, text) for other, up, text in self.placed if up == y and other < x]
        return max(left)[1] if left else ""

    def column(self, title: str) -> list[float]:
        """The numbers of a column of a table."""
        return [float(text) for label, text in self.cells if label == title != text]

    @property
    def rows(self) -> list[tuple[str, str]]:
        """Its cells without those of the table of a plate, which is at other places in inches."""
        plate = any(label.startswith("x, ") for label, _ in self.cells)
        return [one for one in self.cells if not (plate and re.search(", (mm|in)$", one[0]))]


def parted(text: str) -> tuple[list[str], list[float]]:
    """The words of a text, with # for each number, and the numbers."""
    found = [*TOKEN.finditer(text)]
    words = ["#" if one["number"] else one[0] for one in found]
    return words, [float(one["number"]) for one in found if one["number"]]


def same(mm: float, inch: float) -> bool:
    """Whether lengths are the same; small ones have two digits."""
    return abs(mm / INCH - inch) <= (
        max(ROUNDED, 0.06 * abs(inch)) if abs(inch) < 1e-3 else ROUNDED
    )


def wrong(label: str, mm: str, inch: str) -> bool:
    """Whether a text in inches is not that in mm."""
    if label == "module":
        return not math.isclose(float(inch) * float(mm.split()[0]), INCH, rel_tol=3e-4)
    if re.fullmatch(r"\d+:\d+", mm):  # longer texts may need another scale
        return not re.fullmatch(r"\d+:\d+", inch)
    if mm in RENAMED:
        return inch != RENAMED[mm]
    if " to " in mm and " to " not in inch:  # rounded to the same
        inch = re.sub(r"^([\d.]+)", r"\1 to \1", inch)
    mm = re.sub(r"(?<!g )\bmm\b", "in", mm)
    (words, sizes), (others, values) = parted(mm), parted(inch)
    if words != others:
        return True
    lengths = bool(LENGTHS.search(mm) or OF_LENGTHS.search(label))
    return not all(map(same, sizes, values)) if lengths else sizes != values


@pytest.mark.parametrize("name", NAMES)
def test_every_length_is_that_in_mm(name: str) -> None:
    files = [one.files("drawing-svg") for one in results(name)]
    assert files[0].keys() == files[1].keys()
    for stem, data in files[0].items():
        mm, inch = Page(data), Page(files[1][stem])
        for (label, text), (_, other) in zip(mm.rows, inch.rows, strict=True):
            assert not wrong(label, text, other), (label, text, other)
        # leaders may go elsewhere
        drawn = [sorted(map(parted, one.drawn)) for one in (mm, inch)]
        for (words, sizes), (others, values) in zip(*drawn, strict=True):
            assert words == others
            assert all(map(same, sizes, values)), (words, sizes, values)


@pytest.mark.parametrize("name", NAMES)
def test_all_formats_say_the_same(name: str) -> None:
    _, result = results(name)
    old = built(result.design.with_(R12)) if name in ("inch_pair", "groove_cam") else None
    svg, pdf = (result.files(f"drawing-{kind}") for kind in ("svg", "pdf"))
    dxf = [one.files("drawing-dxf") for one in filter(None, (result, old))]
    for sheet in result.sheets:
        stem = f"{sheet.name}_drawing"
        shown = Counter(Page(svg[f"{stem}.svg"]).texts)
        for one in dxf:
            document = read_dxf(one[f"{stem}.dxf"])
            spaces = [document.modelspace(), *blocks(document)]
            found = [one for space in spaces for one in space if one.dxftype() == "TEXT"]
            assert Counter(decode_dxf_unicode(one.plain_text()) for one in found) == shown
            assert {round(one.dxf.height * sheet.scale * INCH, 6) for one in found} <= {*SERIES}
        words = pypdfium2.PdfDocument(pdf[f"{stem}.pdf"])[0].get_textpage().get_text_range()
        own = Counter("".join("".join(shown.elements()).split()))
        assert Counter("".join(words.split())) == own


def blocks(document: Any) -> Iterator[Any]:
    for one in document.modelspace():
        if isinstance(one, Dimension):
            yield one.get_geometry_block()


def of_part(entities: Any) -> list[Any]:
    return [one for one in entities if re.search("(OUTLINE|BLANK|WALL|BORE|HOLE)$", one.dxf.layer)]


@pytest.mark.parametrize("name", NAMES)
def test_the_dxf_is_in_inches(name: str) -> None:
    """Coordinates, styles, and what a program measures."""
    files = [one.files("drawing-dxf") for one in results(name)]
    for sheet in results(name)[1].sheets:
        there, here = (read_dxf(one[f"{sheet.name}_drawing.dxf"]) for one in files)
        assert here.header["$INSUNITS"] == 1
        shapes = (one.modelspace().query("LWPOLYLINE CIRCLE LINE HATCH") for one in (there, here))
        sizes = [np.array(bbox.extents(of_part(some)).size) for some in shapes]
        assert sizes[0] / INCH == pytest.approx(sizes[1], rel=1e-9)
        unit = 1.0 / sheet.scale / INCH
        assert here.header["$LTSCALE"] == pytest.approx(0.25 * unit)
        style = here.dimstyles.get("SHEET").dxf
        assert (style.dimscale, style.dimdec) == (pytest.approx(unit), 4)
        for hatch in here.query("HATCH"):
            (line,) = hatch.pattern.lines  # type: ignore[attr-defined]
            assert line.offset.magnitude == pytest.approx(2.0 * unit)
        for one in here.modelspace():
            if not isinstance(one, Dimension):
                continue
            size = float(one.get_measurement())  # type: ignore[arg-type]
            assert one.dxf.actual_measurement == pytest.approx(size)
            _, numbers = parted(one.dxf.text)
            assert numbers[0] == pytest.approx(size, abs=0.51e-4)


def test_the_outline_is_as_true_as_in_mm() -> None:
    _, result = results("inch_pair")
    with files_in("inch"):
        for part, data in zip(result.parts, result.files("drawing-dxf").values(), strict=False):
            assert measure_dxf(data, edges(part)) <= 1e-3


def test_r12_says_that_it_is_in_inches() -> None:
    result = built(results("inch_pair")[1].design.with_(R12))
    for data in result.files("drawing-dxf").values():
        assert data.startswith(b"999\nlengths are in inches\n")


@pytest.mark.parametrize("name", NAMES)
def test_nothing_is_wrong_with_them(name: str) -> None:
    for sheet in results(name)[1].sheets:
        assert [*faults(sheet)] == []


def test_the_heights_of_a_plate_are_at_round_places() -> None:
    _, result = results("translating_cam")
    page = Page(result.files("drawing-svg")["cam_drawing.svg"])
    table = caliper_table(result, 0.2 * INCH)
    for name, column in table.items():
        title = f"{name.split('_')[-2]}, in"
        assert page.column(title) == pytest.approx(column / INCH, abs=0.51e-4)
