"""Workshop drawings read back: every size is the part's own, and everything can be read."""

from __future__ import annotations

import re
import xml.etree.ElementTree as ET
from collections import Counter
from dataclasses import replace
from functools import cache
from itertools import combinations

import numpy as np
import pytest
from ezdxf.entities.dimension import Dimension
from ezdxf.lldxf.encoding import decode_dxf_unicode

from gearcam.export.dxf import DxfStyle
from gearcam.export.dxf_read import measure_dxf, read_dxf
from gearcam.export.sheet_dxf import sheet_dxf
from gearcam.export.sheet_svg import sheet_svg
from gearcam.kinds.gear_pair.drawings import pair_drawing
from gearcam.kinds.gear_pair.sheet import pair_sheet
from gearcam.numeric.arrays import as_pairs
from gearcam.numeric.pose import Pose
from gearcam.parts.blank import WheelBlank
from gearcam.parts.body import Hub, Mark, Opening, Part
from gearcam.parts.make import make_part
from gearcam.parts.openings import Workpiece
from gearcam.parts.shapes import Circle
from gearcam.pictures.drawings import Drawing, reach
from gearcam.pictures.drawings import Path as Chain
from gearcam.sheets import wheel_sheet
from gearcam.sheets.sheet import Sheet
from helpers_built import built
from helpers_contour import disc_contour, edges, gear_contour
from helpers_pairs import PROFILES
from helpers_sampling import chosen

STYLE = DxfStyle(tolerance=1e-3)
R12 = DxfStyle(tolerance=1e-3, curves="lines", version="R12")
FACTS = {"module": "5 mm", "teeth": "36", "pressure angle": "20 deg", "density": "7850 kg/m^3"}
TITLE = 'Nägel & "Draht" <fast>'
SPACE = {"s": "http://www.w3.org/2000/svg"}
ACROSS, CAPITAL = 0.6, 0.72
"""Width of a letter and height of a capital over the font's size."""


def keyed(bore: float = 40.0) -> Part:
    """A wheel with everything: keyway, bolts, two single holes, hubs on both sides, a mark."""
    blank = WheelBlank(
        bore_diameter=bore, keyway_width=12.0, keyway_depth=3.3, keyway_angle=0.5, bolts=4,
        bolt_circle=56.0, bolt_diameter=6.6, hub_diameter=70.0, hub_front=15.0, hub_back=5.0,
    )  # fmt: skip
    mark = Mark(center=complex(70.0, 12.0), diameter=2.0, depth=0.5)
    made = make_part(
        "gear1",
        [gear_contour()],
        50.0,
        blank,
        Workpiece(name="wheel 1", wheel=1, rim=13.5),
        lambda: mark,
    )
    holes = [((10.0, 50.0), 20.0), ((-60.0, 3.0), 9.0)]
    more = [
        Opening(kind="HOLE", shape=Circle(center=complex(*at), diameter=size), name="hole")
        for at, size in holes
    ]
    return replace(made, openings=(*made.openings, *more))


@cache
def plain() -> Part:
    blank = WheelBlank(bore_diameter=20.0, timing_marks=False)
    contour = gear_contour(24, 2.0, squash=(1.0, 1.0))
    return make_part("gear2", [contour], 12.0, blank, Workpiece(name="wheel 2", wheel=2, rim=5.4))


def d_bore() -> Part:
    blank = WheelBlank(bore_diameter=12.0, bore_flat=10.5, keyway_angle=-2.0)
    return make_part(
        "gear1", [disc_contour(30.0)], 8.0, blank, Workpiece(name="wheel 1", wheel=1, rim=5.4)
    )


def fine_points(part: Part) -> np.ndarray:
    """Points on the true curve, a hundred for each of its dense ones: arcs with their tangents."""
    found = []
    for run in edges(part)[-1].runs:
        start, end = run.points[:-1], run.points[1:]
        way = end - start
        # the arc that leaves the first point along its tangent and meets the second
        half = np.angle(way * np.conj(run.tangents[:-1]))
        u = np.linspace(0.0, 1.0, 100, endpoint=False)[:, None]
        ratio = u * np.sinc(u * half / np.pi) / np.sinc(half / np.pi)
        found.append((start + way * ratio * np.exp(1j * half * (u - 1.0))).ravel())
        found.append(run.points[-1:])
    values = np.concatenate(found)
    return np.column_stack([np.real(values), np.imag(values)])


def outline_sizes(part: Part) -> list[float]:
    """Largest sizes in x and y, farthest and nearest distance from the axis; of a circle one."""
    points = fine_points(part)
    reach = np.hypot(*points.T)
    if np.ptp(reach) < 1e-6:
        return [2.0 * float(reach.max())]
    return [*np.ptp(points, axis=0).tolist(), float(reach.max()), float(reach.min())]


KEYED = [
    *(40.0, 12.0, 43.3),  # bore, keyway, from the keyway's floor to the far side
    *(6.6, 56.0, 20.0, 9.0, 2.0),  # bolts, their circle, single holes, mark
    *(70.0, 50.0, 15.0, 5.0, 70.0),  # hub, width, both lengths of the hub, all together
]
WHEELS = {
    "keyed": (keyed, KEYED),
    "plain": (plain, [20.0, 12.0]),
    "d": (d_bore, [12.0, 10.5, 8.0]),
}


def measured(data: bytes) -> list[float]:
    found = [one for one in read_dxf(data).modelspace() if isinstance(one, Dimension)]
    return sorted(float(one.get_measurement()) for one in found)  # type: ignore[arg-type]


def told(sheet: Sheet) -> str:
    """All that can be read on a sheet."""
    return " ".join([*(one.text.text for one in sheet.drawn), *(text.text for text in sheet.texts)])


def faults(data: bytes, expected: list[float], text: str) -> list[float]:
    """The true sizes that are neither measured in a file nor, for radii, written beside a leader,
    and the measured ones that are not true."""
    found, missing = measured(data), []
    for size in expected:
        near = [value for value in found if abs(value - size) < 1e-6]
        if near:
            found.remove(near[0])
        elif f"R{size:.3f}".rstrip("0").rstrip(".") not in text:
            missing.append(size)
    return missing + found


@pytest.fixture(scope="module", params=chosen(list(WHEELS), "plain", "d"))
def wheel(request: pytest.FixtureRequest) -> tuple[Part, list[float], Sheet]:
    make, sizes = WHEELS[request.param]
    part = make()
    return part, [*sizes, *outline_sizes(part)], wheel_sheet(part, FACTS, TITLE)


def pair(phi: float = 0.3) -> Drawing:
    angle = np.linspace(0.0, 2 * np.pi, 400, endpoint=False)
    ring = Chain(points=np.asarray(23.9 * np.exp(1j * angle), dtype=np.complex128))
    part = plain()
    poses = Pose(-phi), Pose(phi, 47.8)
    return pair_drawing([part, part], 47.8, [ring, ring], poses=poses)


@pytest.fixture(scope="module")
def data(wheel: tuple[Part, list[float], Sheet]) -> bytes:
    return sheet_dxf(wheel[2], STYLE)


@cache
def pair_page() -> Sheet:
    return pair_sheet(pair(), 47.8, FACTS, TITLE, pitch_radius=23.9)


@cache
def pair_file() -> bytes:
    return sheet_dxf(pair_page(), STYLE)


@pytest.fixture(scope="module")
def sheets(wheel: tuple[Part, list[float], Sheet]) -> list[Sheet]:
    return [wheel[2], pair_page()]


def test_every_dimension_is_the_parts_own(
    wheel: tuple[Part, list[float], Sheet], data: bytes
) -> None:
    part, sizes, sheet = wheel
    assert faults(data, sizes, told(sheet)) == []
    assert measure_dxf(data, edges(part)) <= 1e-3


def test_a_wrong_bore_is_caught() -> None:
    """The control: the sheet of a part with another bore does not hold the true sizes."""
    true = [*KEYED, *outline_sizes(keyed())]
    sheet = wheel_sheet(keyed(40.002), FACTS, TITLE)
    missing = faults(sheet_dxf(sheet, STYLE), true, told(sheet))
    assert sorted(missing) == pytest.approx([40.0, 40.002, 43.3, 43.302])


def test_the_pair_tells_its_centre_distance_in_any_pose() -> None:
    for phi in (0.0, 0.7):
        drawing = pair(phi)
        points = fine_points(plain()) @ [1.0, 1j]
        placed = np.concatenate([points * np.exp(-1j * phi), points * np.exp(1j * phi) + 47.8])
        expected = [47.8, 23.9, float(np.ptp(np.real(placed))), float(np.ptp(np.imag(placed)))]
        sheet = pair_sheet(drawing, 47.8, FACTS, TITLE, pitch_radius=23.9)
        data = sheet_dxf(sheet, STYLE)
        assert faults(data, expected, "") == []
        assert measure_dxf(data, drawing.contours) <= 1e-3


def test_the_texts_of_dimensions_are_what_they_measure(
    wheel: tuple[Part, list[float], Sheet], data: bytes
) -> None:
    """In the file as in the sheet: at most three decimals, no idle zeros."""
    document, shown = read_dxf(data), []
    for one in document.modelspace():
        block = one.get_geometry_block() if isinstance(one, Dimension) else None
        found = [text for text in block or () if text.dxftype() == "MTEXT"]
        shown += [text.plain_text().replace("%%c", "Ø") for text in found]  # type: ignore[attr-defined]
    assert sorted(shown) == sorted(one.text.text for one in wheel[2].drawn)
    for text in shown:
        assert not re.search(r"\d\.\d{4}|\.\d*0\b|\.$", text)


def test_the_dxf_has_its_layers_and_styles(sheets: list[Sheet], data: bytes) -> None:
    for sheet, file in zip(sheets, (data, pair_file()), strict=True):
        document = read_dxf(file)
        used = {entity.dxf.layer for entity in document.modelspace()}
        assert {"DIMENSION", "TEXT", "CENTERLINE", "FRAME"} <= used
        assert all(layer in document.layers for layer in used)
        style = document.dimstyles.get("SHEET")
        assert style.dxf.dimtxt * style.dxf.dimscale * sheet.scale == pytest.approx(2.5)
        assert document.header["$INSUNITS"] == 4


def test_r12_has_lines_and_texts_instead(wheel: tuple[Part, list[float], Sheet]) -> None:
    sheet = wheel[2]
    data = sheet_dxf(sheet, R12)
    assert data.isascii()
    document = read_dxf(data)
    kinds = Counter(entity.dxftype() for entity in document.modelspace())
    assert document.acad_release == "R12"
    assert kinds["DIMENSION"] == 0
    assert kinds["SOLID"] == sum(len(one.heads) for one in sheet.drawn)
    texts = [decode_dxf_unicode(one.dxf.text).replace("%%c", "Ø") for one in document.query("TEXT")]
    assert {one.text.text for one in sheet.drawn} <= set(texts)
    assert TITLE in texts
    assert measure_dxf(data, edges(wheel[0])) <= 1e-3


def root_of(sheet: Sheet) -> ET.Element:
    return ET.fromstring(sheet_svg(sheet))


Box = tuple[float, float, float, float]


def boxes(root: ET.Element) -> list[tuple[str, Box]]:
    """Texts with their boxes on the page, y downwards."""
    found = []
    for text in root.iterfind(".//s:text", SPACE):
        x, y, size = (float(text.get(name, "")) for name in ("x", "y", "font-size"))
        words = text.text or ""
        wide, tall = ACROSS * size * len(words), CAPITAL * size
        start = {"start": 0.0, "middle": -0.5 * wide, "end": -wide}[text.get("text-anchor", "")]
        box = (x + start, y - tall, x + start + wide, y)
        if text.get("transform"):
            box = (x - tall, y - start - wide, x, y - start)
        found.append((words, box))
    return found


def test_the_svg_is_paper_in_its_true_size(sheets: list[Sheet]) -> None:
    for sheet in sheets:
        root, (wide, tall) = root_of(sheet), sheet.size
        assert (root.get("width"), root.get("height")) == (f"{wide:g}mm", f"{tall:g}mm")
        assert root.get("viewBox") == f"0 0 {wide:g} {tall:g}"
        for path in root.iterfind(".//s:path", SPACE):
            numbers = np.array(re.findall(r"-?[\d.]+", path.get("d", "")), dtype=float)
            points = numbers.reshape(-1, 2)
            assert (points >= 0.0).all()
            assert (points <= [wide, tall]).all()
        for circle in root.iterfind(".//s:circle", SPACE):
            x, y, r = (float(circle.get(name, "")) for name in ("cx", "cy", "r"))
            assert min(x, y, wide - x, tall - y) > r


def test_the_svg_shows_the_sizes_at_scale(wheel: tuple[Part, list[float], Sheet]) -> None:
    part, sizes, sheet = wheel
    root = root_of(sheet)
    texts = " ".join(words for words, _ in boxes(root))
    for size in sizes:
        assert re.search(rf"(?<![\d.]){re.escape(f'{size:.3f}'.rstrip('0').rstrip('.'))}\b", texts)
    outline = root.find(".//s:path[@class='outline']", SPACE)
    assert outline is not None
    points = np.array(re.findall(r"-?[\d.]+", outline.get("d", "")), dtype=float).reshape(-1, 2)
    assert np.ptp(points, axis=0) / sheet.scale == pytest.approx(
        np.ptp(fine_points(part), axis=0), abs=0.05
    )
    if sheet.name == "gear1" and len(sizes) > 10:
        bolts = root.findall(".//s:circle[@class='hole']", SPACE)
        assert float(bolts[0].get("r", "")) == pytest.approx(3.3 * sheet.scale, abs=1e-3)


def test_no_text_lies_on_another(sheets: list[Sheet]) -> None:
    for sheet in sheets:
        found = boxes(root_of(sheet))
        assert len(found) > 20
        wide, tall = sheet.size
        for words, box in found:
            assert min(box[0], box[1], wide - box[2], tall - box[3]) > 0.0, words
        for (first, a), (second, b) in combinations(found, 2):
            apart = a[2] <= b[0] or b[2] <= a[0] or a[3] <= b[1] or b[3] <= a[1]
            assert apart, (first, second)


def test_no_line_of_the_views_runs_through_the_text_of_a_dimension(sheets: list[Sheet]) -> None:
    """Linear dimensions stand outside the views; leaders are put where there is room."""
    for sheet in sheets:
        outline = [one for one in sheet.features if one.layer.endswith("OUTLINE")]
        points = np.concatenate([sheet.on_paper(reach(one.shape)) for one in outline])
        points = as_pairs(points) * [1.0, -1.0] + [0.0, sheet.size[1]]
        for words, (left, top, right, low) in boxes(root_of(sheet)):
            inside = (points > [left, top]).all(axis=1) & (points < [right, low]).all(axis=1)
            assert not inside.any(), words


def test_the_rows_of_the_table_line_up(sheets: list[Sheet]) -> None:
    for sheet in sheets:
        texts = {text.text: sheet.on_paper(np.array([text.place]))[0] for text in sheet.texts}
        labels = as_pairs(np.array([texts[label] for label in FACTS]))
        values = as_pairs(np.array([texts[value] for value in FACTS.values()]))
        assert np.ptp(labels[:, 0]) < 1e-9
        assert np.ptp(values[:, 0]) < 1e-9
        assert labels[:, 1] == pytest.approx(values[:, 1], abs=1e-9)
        assert -np.diff(labels[:, 1]) == pytest.approx(5.0)


def test_special_letters_survive(wheel: tuple[Part, list[float], Sheet], data: bytes) -> None:
    assert TITLE in [words for words, _ in boxes(root_of(wheel[2]))]
    texts = [one.plain_text() for one in read_dxf(data).query("TEXT")]  # type: ignore[attr-defined]
    assert TITLE in texts
    assert "7850 kg/m^3" in texts


def test_a_stepped_part_shows_its_steps() -> None:
    steps = (disc_contour(30.0), disc_contour(24.0))
    part = Part(name="step", contours=steps, width=10.0, hub=Hub(diameter=12.0, back=3.0))
    sheet = wheel_sheet(part, {}, "t")
    data = sheet_dxf(sheet, STYLE)
    expected = [*outline_sizes(part), 10.0, 3.0, 13.0, 12.0]
    assert expected[:2] == pytest.approx([48.0, 10.0], abs=1e-7)
    assert faults(data, expected, told(sheet)) == []
    edges = read_dxf(data).modelspace().query('LWPOLYLINE[layer=="EDGE"]')
    tops = {round(float(point[1]), 6) for edge in edges for point in edge.get_points()}  # type: ignore[attr-defined]
    assert {30.0, 24.0, 6.0, -6.0, -24.0, -30.0} == tops


@pytest.mark.parametrize(
    ("profile", "rows"),
    [
        (
            "lathe_slide",
            ("follower", "roller radius", "offset", "lift", "prime radius", "cam turns",
             "pressure angle, rise", "pressure angle, return", "density", "mass", "unbalance"),
        ),
        (
            "valve_lever",
            ("follower", "pivot distance", "face offset", "lift", "base radius", "cam turns"),
        ),
        ("circular", ("teeth", "module", "pressure angle", "addendum", "dedendum", "backlash",
                      "face width", "profile shift", "centrode length", "cutter")),
    ],
)  # fmt: skip
def test_the_table_tells_what_the_part_is_made_by(profile: str, rows: tuple[str, ...]) -> None:
    made = built(PROFILES / f"{profile}.toml").files("drawing-svg")
    text = next(iter(made.values())).decode()
    assert [row for row in rows if f">{row}</text>" not in text] == []
