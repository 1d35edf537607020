"""Workshop drawings read back: every size is the part's own, and all formats say the same."""

from __future__ import annotations

import re
import xml.etree.ElementTree as ET
from collections import Counter
from collections.abc import Iterator
from dataclasses import replace
from functools import cache

import numpy as np
import pypdfium2
import pytest
from ezdxf.entities.dimension import Dimension
from ezdxf.lldxf.encoding import decode_dxf_unicode

from gearcam.base.errors import DesignError, InfeasibleError
from gearcam.base.inches import files_in
from gearcam.base.numerals import decimal
from gearcam.export.dxf import DxfStyle
from gearcam.export.dxf_read import measure_dxf, read_dxf
from gearcam.export.sheet_dxf import sheet_dxf
from gearcam.export.sheet_pdf import POINT, sheet_pdf
from gearcam.export.sheet_svg import sheet_svg
from gearcam.kinds.gear_pair.drawings import pair_drawing
from gearcam.kinds.gear_pair.sheet import pair_sheet
from gearcam.numeric.arrays import as_pairs, bounds
from gearcam.numeric.pose import Pose
from gearcam.parts.blank import WheelBlank
from gearcam.parts.body import Hub, Mark, Opening, Part
from gearcam.parts.make import make_part
from gearcam.parts.openings import Workpiece
from gearcam.parts.shapes import Circle
from gearcam.pictures.drawings import Drawing, Feature, reach
from gearcam.pictures.drawings import Path as Chain
from gearcam.sheets.paper import Heading
from gearcam.sheets.sheet import CAPITAL, Sheet
from gearcam.sheets.spec import DrawingSpec
from gearcam.sheets.tiles import OVERLAP, PAGE, WINDOW, tiles
from helpers_built import built
from helpers_contour import disc_contour, edges, gear_contour
from helpers_pairs import PROFILES
from helpers_sampling import chosen
from helpers_sheets import faults as lint
from helpers_sheets import sheet_of

STYLE = DxfStyle(tolerance=1e-3)
R12 = DxfStyle(tolerance=1e-3, curves="lines", version="R12")
FACTS = {"module": "5 mm", "teeth": "36", "pressure angle": "20 deg", "density": "7850 kg/m^3"}
TITLE = 'Nägel & "Draht" <fast>'
HEADING = Heading(title=TITLE, notes=DrawingSpec(), number=None)
SPACE = {"s": "http://www.w3.org/2000/svg"}


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
    return " ".join(text.text for text in sheet.words)


def faults(data: bytes, expected: list[float], text: str) -> list[float]:
    """The true sizes that are neither measured in a file nor, for radii, written beside a leader,
    and the measured ones that are not true."""
    found, missing = measured(data), []
    for size in expected:
        near = [value for value in found if abs(value - size) < 1e-6]
        if near:
            found.remove(near[0])
        elif not {f"R{decimal(size)}", f"(R{decimal(size)}", f"Ø{decimal(size)},"} & {
            *text.split()
        }:
            missing.append(size)
    return missing + found


@pytest.fixture(scope="module", params=chosen(list(WHEELS), "plain", "d"))
def wheel(request: pytest.FixtureRequest) -> tuple[Part, list[float], Sheet]:
    make, sizes = WHEELS[request.param]
    part = make()
    return part, [*sizes, *outline_sizes(part)], sheet_of(part, FACTS, TITLE)


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
    return pair_sheet(pair(), 47.8, FACTS, HEADING, pitch_radius=23.9)


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
    sheet = sheet_of(keyed(40.002), FACTS, TITLE)
    missing = faults(sheet_dxf(sheet, STYLE), true, told(sheet))
    assert sorted(missing) == pytest.approx([40.0, 40.002, 43.3, 43.302])


def test_the_pair_tells_its_centre_distance_in_any_pose() -> None:
    for phi in (0.0, 0.7):
        drawing = pair(phi)
        points = fine_points(plain()) @ [1.0, 1j]
        placed = np.concatenate([points * np.exp(-1j * phi), points * np.exp(1j * phi) + 47.8])
        expected = [47.8, 23.9, float(np.ptp(np.real(placed))), float(np.ptp(np.imag(placed)))]
        sheet = pair_sheet(drawing, 47.8, FACTS, HEADING, pitch_radius=23.9)
        data = sheet_dxf(sheet, STYLE)
        assert faults(data, expected, "") == []
        assert measure_dxf(data, drawing.contours) <= 1e-3


def test_the_texts_of_dimensions_are_what_they_measure(
    wheel: tuple[Part, list[float], Sheet], data: bytes
) -> None:
    """In the file as in the sheet, given as texts: at most three decimals, no idle zeros."""
    found = [one for one in read_dxf(data).modelspace() if isinstance(one, Dimension)]
    assert {one.dxf.text for one in found} <= {one.label for one in wheel[2].dimensions}
    for one in found:
        (number,) = re.findall(
            r"(?<![M\d.])\d+\.?\d*(?! x)(?=\D|$)", re.sub(r"\bhole \d+ |, .*", "", one.dxf.text)
        )
        assert float(number) == pytest.approx(float(one.get_measurement()), abs=5e-4)  # type: ignore[arg-type]
        assert one.dxf.actual_measurement == pytest.approx(float(one.get_measurement()))  # type: ignore[arg-type]
        assert not re.search(r"\d\.\d{4}|\.\d*0\b|\.$", number)
        (shown,) = (text for text in one.get_geometry_block() if text.dxftype() == "TEXT")  # type: ignore[union-attr]
        assert shown.dxf.text == one.dxf.text


Shown = Counter[tuple[str, float]]
"""How often a text of a height is there."""


def in_svg(sheet: Sheet) -> Shown:
    texts = root_of(sheet).iterfind(".//s:text", SPACE)
    return Counter(
        (text.text or "", round(CAPITAL * float(text.get("font-size", "")), 2)) for text in texts
    )


def in_dxf(sheet: Sheet, data: bytes) -> Shown:
    document = read_dxf(data)
    blocks = [
        one.get_geometry_block() for one in document.modelspace() if isinstance(one, Dimension)
    ]
    texts = [one for space in (document.modelspace(), *blocks) for one in space or ()]
    return Counter(
        (
            decode_dxf_unicode(one.plain_text()),  # type: ignore[attr-defined]
            round(one.dxf.height * sheet.scale, 2),
        )
        for one in texts
        if one.dxftype() == "TEXT"
    )


def in_pdf(sheet: Sheet) -> list[str]:
    page = pypdfium2.PdfDocument(sheet_pdf([sheet], TITLE))[0]
    assert page.get_size() == pytest.approx([POINT * side for side in sheet.size], abs=1e-3)
    words = page.get_textpage().get_text_range()
    return sorted("".join(words.split()))


def test_all_formats_say_the_same_in_the_same_heights(
    wheel: tuple[Part, list[float], Sheet], data: bytes
) -> None:
    sheet = wheel[2]
    own = Counter((text.text, round(text.height, 2)) for text in sheet.words)
    assert in_svg(sheet) == own
    assert in_dxf(sheet, data) == own
    assert in_dxf(sheet, sheet_dxf(sheet, R12)) == own
    assert in_pdf(sheet) == sorted("".join("".join(text.text for text in sheet.words).split()))


def test_a_pdf_refuses_letters_that_its_font_does_not_have() -> None:
    with pytest.raises(InfeasibleError, match="cannot show"):
        sheet_pdf([sheet_of(plain(), title="Łódź")], "t")


def test_the_same_sheet_is_the_same_pdf() -> None:
    one, other = (sheet_pdf([sheet_of(plain())], TITLE) for _ in range(2))
    assert one == other
    assert b"/CreationDate (D:2000" in one


def test_hatches_are_entities_with_the_loops_of_the_section(
    wheel: tuple[Part, list[float], Sheet], data: bytes
) -> None:
    (hatch,) = read_dxf(data).query("HATCH")
    assert len(hatch.paths) == len(wheel[2].hatches[0].loops)  # type: ignore[attr-defined]
    lines = [one for one in wheel[2].drawn_lines if one.layer == "HATCH"]
    assert len(lines) > 5
    old = read_dxf(sheet_dxf(wheel[2], R12))
    assert len(old.query('LINE[layer=="HATCH"]')) == len(lines)


def test_the_dxf_has_its_layers_and_styles(sheets: list[Sheet], data: bytes) -> None:
    for sheet, file in zip(sheets, (data, pair_file()), strict=True):
        document = read_dxf(file)
        used = {entity.dxf.layer for entity in document.modelspace()}
        assert {"DIMENSION", "TEXT", "CENTERLINE", "FRAME"} <= used
        assert all(layer in document.layers for layer in used)
        style = document.dimstyles.get("SHEET")
        assert style.dxf.dimtxt * style.dxf.dimscale * sheet.scale == pytest.approx(2.5)
        assert document.header["$INSUNITS"] == 4
        dashed = document.linetypes.get("ACAD_ISO02W100")
        assert document.header["$LTSCALE"] * sheet.scale == pytest.approx(0.25)
        assert dashed.pattern_tags.tags[0].value == 15.0 or len(dashed.pattern_tags.tags) > 2


def test_r12_has_lines_and_texts_instead(wheel: tuple[Part, list[float], Sheet]) -> None:
    sheet = wheel[2]
    data = sheet_dxf(sheet, R12)
    assert data.isascii()
    document = read_dxf(data)
    kinds = Counter(entity.dxftype() for entity in document.modelspace())
    assert document.acad_release == "R12"
    assert kinds["DIMENSION"] == 0
    assert kinds["SOLID"] == sum(1 for _ in sheet.blacks)
    assert measure_dxf(data, edges(wheel[0])) <= 1e-3


def root_of(sheet: Sheet) -> ET.Element:
    return ET.fromstring(sheet_svg(sheet))


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


def test_the_svg_shows_the_sizes_at_scale(wheel: tuple[Part, list[float], Sheet]) -> None:
    part, sizes, sheet = wheel
    root = root_of(sheet)
    texts = " ".join(words for words, _ in in_svg(sheet))
    for size in sizes:
        assert re.search(rf"(?<![\d.]){re.escape(f'{size:.3f}'.rstrip('0').rstrip('.'))}\b", texts)
    outline = root.find(".//s:path[@class='outline']", SPACE)
    assert outline is not None
    points = np.array(re.findall(r"-?[\d.]+", outline.get("d", "")), dtype=float).reshape(-1, 2)
    assert np.ptp(points, axis=0) / sheet.scale == pytest.approx(
        np.ptp(fine_points(part), axis=0), abs=0.05
    )


def test_nothing_is_wrong_with_them(sheets: list[Sheet]) -> None:
    for sheet in sheets:
        assert [*lint(sheet)] == []


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
    shown = [words for words, _ in in_dxf(wheel[2], data)]
    assert TITLE in shown
    assert "7850 kg/m^3" in shown


def test_a_stepped_part_shows_its_steps() -> None:
    steps = (disc_contour(30.0), disc_contour(24.0))
    part = Part(name="step", contours=steps, width=10.0, hub=Hub(diameter=12.0, back=3.0))
    sheet = sheet_of(part)
    data = sheet_dxf(sheet, STYLE)
    expected = [*outline_sizes(part), 10.0, 3.0, 13.0, 12.0]
    assert expected[:2] == pytest.approx([48.0, 10.0], abs=1e-7)
    assert faults(data, expected, told(sheet)) == []
    edges = read_dxf(data).modelspace().query('LWPOLYLINE[layer=="EDGE"]')
    tops = [float(point[1]) for edge in edges for point in edge.get_points()]  # type: ignore[attr-defined]
    for top in (30.0, 24.0, 6.0, -6.0, -24.0, -30.0):
        assert min(abs(one - top) for one in tops) < 2e-3


def pages(size: complex) -> list[Sheet]:
    corners = np.array([0.0, size.real, size, 1j * size.imag])
    shape = Chain(points=corners.astype(complex))
    return [*tiles(Drawing(name="gear1", features=(Feature(layer="OUTLINE", shape=shape),)), "t")]


def shown_on(page: Sheet) -> np.ndarray:
    """What is shown of the part, as the corners of its window, mm of the part."""
    return np.array(WINDOW) + page.corner


@pytest.mark.parametrize(("size", "count"), [(100.0 + 80.0j, 1), (300.0 + 300.0j, 4)])
def test_prints_show_everything_at_full_size(size: complex, count: int) -> None:
    made = pages(size)
    assert len(made) == count
    assert {(one.scale, one.size) for one in made} == {(1.0, PAGE)}
    shown = np.concatenate([shown_on(one) for one in made])
    low, high = bounds(shown)
    assert min(low.real, low.imag) < -4.0
    assert min((high - size).real, (high - size).imag) > 4.0


def test_neighbouring_pages_show_a_strip_twice_with_marks_in_its_middle() -> None:
    one, right, below, _ = pages(300.0 + 300.0j)
    assert (shown_on(one)[1] - shown_on(right)[0]).real == pytest.approx(OVERLAP)
    assert (shown_on(below)[1] - shown_on(one)[0]).imag == pytest.approx(OVERLAP)
    marks = [f.shape.center for f in one.features if hasattr(f.shape, "center")]  # type: ignore[union-attr]
    shared = [
        mark
        for mark in marks
        if all(
            (low.real < mark.real < high.real) and (low.imag < mark.imag < high.imag)
            for low, high in map(shown_on, (one, right))
        )
    ]
    assert len(shared) == 2


@pytest.mark.parametrize(
    ("units", "count", "length", "words"),
    [("mm", 11, 100.0, "100 mm"), ("inch", 17, 101.6, "4 in")],
)
def test_the_ruler_of_a_print_is_true(units: str, count: int, length: float, words: str) -> None:
    """As drawn in the PDF, in points."""
    with files_in(units):
        page = pypdfium2.PdfDocument(sheet_pdf(pages(100.0 + 80.0j), "t", WINDOW))[0]
    boxes = [one.get_bounds() for one in page.get_objects()]
    ticks = [left for left, low, right, high in boxes if right - left < 2.0 and high - low < 12.0]
    assert len(ticks) == count
    assert max(ticks) - min(ticks) == pytest.approx(length * POINT, abs=0.01)
    shown = page.get_textpage().get_text_range()
    assert "row 1 of 1, column 1 of 1" in shown
    assert words in shown


@pytest.mark.parametrize(
    ("profile", "told", "titles"),
    [("groove_cam", "36.025", {"inner, mm", "outer, mm"}), ("tappet", "10", {"radius, mm"})],
)
def test_cams_have_a_table_of_their_radii(profile: str, told: str, titles: set[str]) -> None:
    (sheet,) = built(PROFILES / f"{profile}.toml").sheets
    shown = {text.text for text in sheet.texts}
    assert {"angle, deg", told, "350"} | titles <= shown
    assert [*lint(sheet)] == []


def broken(sheet: Sheet) -> Iterator[tuple[str, Sheet]]:
    """Sheets with a fault, and a word of what the lint must say."""
    text, other = sheet.texts[0], sheet.texts[1]
    moved = replace(other, place=text.place)
    yield "lies on", replace(sheet, texts=[*sheet.texts, moved])
    yield (
        "outside the frame",
        replace(sheet, texts=[*sheet.texts, replace(other, place=sheet.corner)]),
    )
    yield "height", replace(sheet, texts=[replace(text, height=2.6), *sheet.texts[1:]])
    yield (
        "a line of",
        replace(
            sheet,
            texts=[*sheet.texts, replace(other, place=complex(reach(sheet.features[0].shape)[0]))],
        ),
    )
    yield "dimensioned twice", replace(sheet, dimensions=[*sheet.dimensions, sheet.dimensions[0]])
    text = next(one for one in sheet.texts if one.text == "A-A")
    beside = replace(text, text="x", place=text.place + (0.5 * text.width + 2.5) * sheet.unit)
    yield "reads on as", replace(sheet, texts=[*sheet.texts, beside])
    wide = max(sheet.dimensions, key=lambda one: one.value * (one.kind == "linear"))
    line = complex(wide.lines[-1] @ [0.8, 0.2])
    near = replace(text, text="(1)", height=2.5, place=line + 0.8j * sheet.unit)
    yield "on '(1)'", replace(sheet, texts=[*sheet.texts, near])
    cell = line + np.array([-3.0 - 2.0j, 3.0 - 2.0j, 3.0 + 3.0j, -3.0 + 3.0j]) * sheet.unit
    frame = Feature(layer="DIMENSION", shape=Chain(points=cell.astype(np.complex128)))
    yield "tolerance frame", replace(sheet, features=[*sheet.features, frame])


def test_the_lint_finds_faults() -> None:
    sheet = sheet_of(plain())
    for word, bad in broken(sheet):
        assert [one for one in lint(bad) if word in one], word


ALL = sorted(str(path.relative_to(PROFILES)) for path in PROFILES.rglob("*.toml"))


@pytest.mark.parametrize(
    "name", chosen(ALL, "ellipse.toml", "groove_cam.toml", "cylinder_cam.toml", "shop_order.toml")
)
def test_nothing_is_wrong_with_the_drawings_of_profiles(name: str) -> None:
    """The lint over all profiles of which parts are made."""
    try:
        sheets = getattr(built(PROFILES / name), "sheets", ())
    except (DesignError, InfeasibleError):
        return  # refused, as the files of the parts are
    for sheet in sheets:
        assert [*lint(sheet)] == [], sheet.name


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
        ("circular", ("teeth", "module", "pressure angle", "addendum", "dedendum",
                      "backlash, given", "backlash of the wheels", "face width", "profile shift",
                      "centrode length", "cutter", "mates with")),
    ],
)  # fmt: skip
def test_the_table_tells_what_the_part_is_made_by(profile: str, rows: tuple[str, ...]) -> None:
    made = built(PROFILES / f"{profile}.toml").files("drawing-svg")
    text = next(iter(made.values())).decode()
    assert [row for row in rows if f">{row}</text>" not in text] == []
