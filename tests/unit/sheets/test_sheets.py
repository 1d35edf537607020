"""Sheets choose paper and scale, find room, and say in the table what they cannot show."""

from __future__ import annotations

import math
from collections.abc import Sequence
from dataclasses import fields
from xml.etree import ElementTree as ET

import numpy as np
import pytest

from gearcam import PairDrawingSpec, build, load
from gearcam.base.errors import DesignError, InfeasibleError
from gearcam.base.facts import Facts
from gearcam.base.numerals import decimal
from gearcam.export.dxf_read import read_dxf
from gearcam.kinds.gear_pair.drawings import pair_drawing
from gearcam.kinds.gear_pair.sheet import pair_sheet
from gearcam.numeric.pose import Pose
from gearcam.parts.body import Mark, Opening, Part
from gearcam.parts.shapes import Circle, Loop
from gearcam.pictures.drawings import OUTLINE, Drawing, Path, placed
from gearcam.sheets import paper
from gearcam.sheets.board import Board
from gearcam.sheets.dimensions import Measure, leader
from gearcam.sheets.paper import Heading, Values, area_of, choose, scale_words, sheet_rows
from gearcam.sheets.part import part_sheet
from gearcam.sheets.sheet import Sheet, Text, fine, text_width
from gearcam.sheets.spec import DrawingSpec
from helpers_contour import disc_contour, gear_contour, square_contour
from helpers_sheets import faults, heading, sheet_of


def part(radius: float, openings: tuple[Opening, ...] = (), width: float = 5.0) -> Part:
    contour = disc_contour(radius, 1e-3)
    return Part(name="gear1", contours=(contour,), width=width, openings=openings)


def hole(x: float, y: float, diameter: float) -> Opening:
    return Opening(kind="HOLE", shape=Circle(center=complex(x, y), diameter=diameter), name="h")


def empty() -> Board:
    area = -50.0 - 50.0j, 50.0 + 50.0j
    return Board(name="b", scale=1.0, paper="A4", size=(100.0, 100.0), corner=area[0], area=area)


@pytest.mark.parametrize(
    ("value", "text"),
    [(180.0, "180"), (0.5, "0.5"), (1.23456, "1.235"), (-0.0001, "0"), (100.0, "100")],
)
def test_numbers_have_no_idle_digits(value: float, text: str) -> None:
    assert decimal(value) == text


def test_tolerances_are_never_rounded_to_nothing() -> None:
    assert [fine(value) for value in (0.001, 0.00033, 1e-8, 0.02)] == [
        "0.001", "0.00033", "0.00000001", "0.02",
    ]  # fmt: skip


def views(sheet: Sheet) -> np.ndarray:
    """Corners of the outlines on the paper."""
    found = [one.shape for one in sheet.features if one.layer.endswith(OUTLINE)]
    points = [sheet.on_paper(one.vertices) for one in found]  # type: ignore[union-attr]
    return np.array([np.vstack(points).min(axis=0), np.vstack(points).max(axis=0)])


@pytest.mark.parametrize(
    ("radius", "width", "scale", "paper"),
    [
        (500.0, 60.0, 0.2, "A3"),
        (4.0, 2.0, 5.0, "A4"),
        (20.0, 5.0, 2.0, "A4"),
        (5e5, 1e3, 2e-4, "A3"),
    ],
)
def test_a_fitting_scale_is_chosen(radius: float, width: float, scale: float, paper: str) -> None:
    sheet = sheet_of(part(radius, width=width), {"a": "b"})
    assert (sheet.scale, sheet.paper) == (pytest.approx(scale), paper)
    low, high = area_of(sheet.paper)
    corners = views(sheet)
    assert (corners[0] > low).all()
    assert (corners[1] < high).all()
    assert np.ptp(corners, axis=0) == pytest.approx(2 * radius * scale, rel=1e-3)


def test_scales_are_written_as_the_standard_does() -> None:
    words = [scale_words(scale) for scale in (10.0, 1.0, 0.5, 0.02)]
    assert words == ["10:1", "1:1", "1:2", "1:50"]


def test_long_tables_take_the_larger_paper() -> None:
    assert choose(10.0 + 10.0j, 20.0 + 20.0j, 10)[0] == "A4"
    assert choose(10.0 + 10.0j, 20.0 + 20.0j, 40)[0] == "A3"
    with pytest.raises(InfeasibleError, match="do not fit on a sheet"):
        choose(1e12 + 1.0j, 20.0 + 20.0j, 10)


def test_very_long_tables_have_lower_rows() -> None:
    facts = {f"row {k}": str(k) for k in range(80)}
    sheet = sheet_of(part(20.0), facts)
    heights = {text.text: sheet.on_paper(np.array([text.place]))[0].imag for text in sheet.texts}
    assert heights["row 79"] > 42.0
    assert heights["row 0"] < 287.0
    assert min(text.height for text in sheet.texts) == 1.8
    assert not [*faults(sheet)]


@pytest.mark.parametrize("title", ["x" * 100, "a\nb\tc"])
def test_long_names_stay_in_their_cells(title: str) -> None:
    sheet = sheet_of(part(20.0), {"l" * 80: "v" * 40}, title)
    shown = " ".join(title.split())
    (found,) = (text for text in sheet.texts if text.text == shown)
    assert found.width <= 78.0
    assert not [one for one in faults(sheet) if "squeezed" not in one]


def test_even_holes_are_a_pattern_and_others_have_numbers() -> None:
    ring = [hole(20 * math.cos(a), 20 * math.sin(a), 3.0) for a in np.radians([30, 150, 270])]
    sheet = sheet_of(part(40.0, (*ring, hole(30.0, 5.0, 4.0), hole(-29.0, 5.0, 4.0))))
    rows = dict(sheet.rows)
    assert rows["3 x Ø3"] == "on Ø40, at 30 deg"
    assert rows["hole 1 Ø4"] == "X 30  Y 5"
    assert rows["hole 2 Ø4"] == "X -29  Y 5"
    labels = {one.label for one in sheet.dimensions}
    assert {"3 x Ø3", "Ø40", "hole 1 Ø4", "hole 2 Ø4"} <= labels


def test_holes_that_are_nearly_even_are_no_pattern() -> None:
    ring = [hole(20 * math.cos(a), 20 * math.sin(a), 3.0) for a in np.radians([30, 150, 270.01])]
    rows = dict(sheet_of(part(40.0, tuple(ring))).rows)
    assert set(rows) == {"hole 1 Ø3", "hole 2 Ø3", "hole 3 Ø3"}


def test_a_stop_slot_is_told() -> None:
    bend = math.tan(math.pi / 8)
    # an arc of radius 20 and width 2, from 0 to 90 deg
    points = np.array([21.0, 21.0j, 19.0j, 19.0])
    shape = Loop(points=points, bulges=np.array([bend, 1.0, -bend, 1.0]))
    sheet = sheet_of(part(40.0, (Opening(kind="SLOT", shape=shape, name="s"),)))
    rows = dict(sheet.rows)
    assert rows["slot, mid radius"] == "20"
    assert rows["slot, ends at"] == "0, 90 deg"
    assert "slot R1" in [one.label for one in sheet.dimensions]


def test_a_rack_has_no_axis() -> None:
    square = square_contour(30.0)
    moved = placed(square, Pose(shift=100.0))
    rack = Part(name="gear2", contours=(moved,), width=4.0)  # type: ignore[arg-type]
    sheet = sheet_of(rack)
    assert sorted(one.value for one in sheet.dimensions) == pytest.approx([4.0, 30.0, 30.0])
    lines = [one.shape for one in sheet.features if one.layer == "CENTERLINE"]
    assert len(lines) == 1  # that of the section


def test_what_has_no_room_goes_into_the_table() -> None:
    marks = tuple(
        Mark(center=complex(x, y), diameter=0.5, depth=0.2)
        for x in np.linspace(-9, 9, 7)
        for y in np.linspace(-9, 9, 7)
    )
    crowded = Part(name="gear1", contours=(disc_contour(40.0),), width=5.0, marks=marks)
    sheet = sheet_of(crowded)
    shown = sum(one.label.startswith("mark ") for one in sheet.dimensions)
    assert sum(label.startswith("mark ") for label, _ in sheet.rows) == len(marks)
    assert 0 < shown < len(marks)
    assert not [*faults(sheet)]


def test_narrow_dimensions_have_their_text_and_arrows_outside() -> None:
    board = empty()
    pairs = [Measure(0.0, 2.0), Measure(0.0, 40.0)]
    board.measure(pairs, 0.0)
    narrow, wide = board.dimensions
    assert narrow.text.box(1.0)[0].real > 40.0  # beyond what crosses it
    assert narrow.heads[0][1].real < 0.0
    assert wide.text.place == pytest.approx(20.0 + 1j * (-19.0 + 1.0))
    assert wide.heads[0][1].real > 0.0


def test_a_size_that_follows_from_others_is_in_parentheses() -> None:
    board = empty()
    board.measure([Measure(0.0, 30.5, aside=True)], 0.0)
    assert board.dimensions[0].label == "(30.5)"


def test_dimensions_know_their_values() -> None:
    ring = leader(
        Circle(center=3.0 + 4.0j, diameter=5.0), math.pi / 2, 6.0, "Ø5 max", "diameter", 1.0
    )
    assert (ring.value, ring.label) == (5.0, "Ø5 max")
    assert ring.points == pytest.approx((3.0 + 1.5j, 3.0 + 6.5j))
    assert ring.heads[0][0] == pytest.approx(3.0 + 6.5j)


def test_upright_texts_have_upright_boxes() -> None:
    low, high = Text(text="abcd", place=0j, upright=True).box(1.0)
    assert (high - low).imag > (high - low).real


def test_widths_are_those_of_the_font() -> None:
    """Against the metrics of reportlab, in the same letters."""
    from reportlab.pdfbase.pdfmetrics import stringWidth

    for text in ("Ø25 H7 (+0.021/0)", "ISO 2768-mK", "±0.018", "über 30°"):
        assert text_width(text, 2.5) == pytest.approx(stringWidth(text, "Helvetica", 2.5 / 0.718))


KEYS = {
    "part_number": "G-1024", "material": "C45E", "heat_treatment": "hardened", "surface": "Ra 1.6",
    "general_tolerances": "ISO 2768-mK", "revision": "B", "author": "A. Maker",
    "approved_by": "B. Checker", "owner": "Example Works", "date": "2030-01-31",
}  # fmt: skip


def test_every_key_of_the_drawing_is_printed() -> None:
    bore = (Opening(kind="BORE", shape=Circle(center=0j, diameter=8.0), name="bore"),)
    made = heading(**KEYS, runout=0.03, profile_tolerance=0.015)
    sheet = part_sheet(part(30.0, bore), {}, made)
    shown = [text.text for text in sheet.words]
    assert {*KEYS.values(), "0.03", "0.015"} - {*shown} == set()
    assert not [*faults(sheet)]
    names = {one.name for one in fields(DrawingSpec)}
    assert names == {*KEYS, "runout", "profile_tolerance"}


def test_several_parts_number_themselves() -> None:
    one = Heading(title="t", notes=DrawingSpec(part_number="G-7"), number=1, of=2)
    both = PairDrawingSpec(part_number=("A", "B"), material=("C45E", "POM"))
    own = Heading(title="t", notes=both, number=1, of=2)
    assert one.part_number == "G-7-2"
    assert (own.part_number, both.of("material", 1)) == ("B", "POM")
    assert both.of("part_number", None) == "A + B"
    first = PairDrawingSpec(part_number=("A", ""), material=("", ""))
    assert (first.of("part_number", None), first.of("material", None)) == ("A + -", "")
    assert Heading(title="t", notes=first, number=0, of=2).part_number == "A"
    assert not [*first.problems()]


@pytest.mark.parametrize(
    ("key", "value", "told"),
    [
        ("date", "31.1.2030", "is not a date"),
        ("date", "20300131", "is not a date"),
        ("surface", "smooth", "is not a surface texture"),
        ("author", "x" * 61, "is too long for its cell"),
        ("owner", "", "is empty"),
        ("runout_mm", 0.0, "allowed"),
    ],
)
def test_wrong_keys_are_refused(key: str, value: object, told: str) -> None:
    with pytest.raises(DesignError, match=told):
        load("profiles/ellipse.toml").with_({f"drawing.{key}": value})


def test_run_out_needs_a_bore() -> None:
    design = load("profiles/ellipse.toml").with_({"drawing.runout_mm": 0.02})
    with pytest.raises(InfeasibleError, match="no part has one"):
        _ = build(design).sheets


def test_a_table_of_values_has_all_its_rows() -> None:
    rows = [(str(k), f"{k}.5") for k in range(25)]
    sheet = part_sheet(
        part(20.0), {"a": "b"}, heading(), values=Values(title=("x", "y"), rows=rows)
    )
    shown = [text.text for text in sheet.texts]
    assert {f"{k}.5" for k in range(25)} <= {*shown}
    assert shown.count("x") == 3
    assert not [*faults(sheet)]


def circles(count: int = 360) -> list[Path]:
    angle = np.linspace(0.0, 2 * np.pi, count, endpoint=False)
    return [Path(points=np.asarray(30.0 * np.exp(1j * angle), dtype=np.complex128))] * 2


def pair(phi: float = 0.2) -> Drawing:
    wheel = Part(name="g", contours=(gear_contour(30, 2.0, squash=(1.0, 1.0)),), width=5.0)
    poses = Pose(-phi), Pose(phi, 60.0)
    return pair_drawing([wheel, wheel], 60.0, circles(), poses=poses)


def test_the_pitch_point_is_marked() -> None:
    sheet = pair_sheet(pair(), 60.0, {}, heading(), pitch_radius=30.0)
    rings = [one.shape for one in sheet.features if one.layer == "CENTERLINE"]
    (ring,) = (shape for shape in rings if isinstance(shape, Circle))
    assert ring.center == pytest.approx(30.0, abs=2e-3)
    assert "pitch point" in [text.text for text in sheet.words]
    values = [one.value for one in sheet.dimensions]
    assert {30.0, 60.0} <= set(values)


def test_a_pair_with_a_rack_has_no_centre_distance() -> None:
    made = heading(general_tolerances="ISO 2768-mK")
    sheet = pair_sheet(pair(), 0.0, {}, made, ("G-1", "G-2"), pitch_radius=30.0)
    values = [one.value for one in sheet.dimensions]
    assert 60.0 not in values
    outer = [one.shape for one in sheet.features if one.layer.endswith(OUTLINE)]
    back = max(one.points.real.max() for one in outer)  # type: ignore[union-attr]
    assert back == pytest.approx(values[1], abs=2e-3)
    assert {"G-1", "G-2"} <= {text.text for text in sheet.words}
    told = "ISO 2768-mK holds for the distance from axis to back of the rack too."
    assert told in " ".join(text.text for text in sheet.texts)


def test_the_shaft_of_an_open_ring_may_lie_beside_its_outline() -> None:
    """Its centre line is on the paper, and the height is measured left of it."""
    ring = placed(disc_contour(20.0, 1e-3), Pose(shift=90.0))
    parts = [part(30.0), Part(name="gear2", contours=(ring,), width=5.0)]  # type: ignore[arg-type]
    sheet = pair_sheet(pair_drawing(parts, -60.0), -60.0, {}, heading(), pitch_radius=30.0)
    (height,) = (one for one in sheet.dimensions if one.kind == "vertical")
    assert height.value == pytest.approx(60.0, abs=2e-3)
    assert sheet.corner.real < height.points[0].real < -60.0
    lines = [one.shape for one in sheet.features if one.layer == "CENTERLINE"]
    assert min(line.points.real.min() for line in lines if isinstance(line, Path)) < -60.0


def test_every_row_of_a_sheet_is_a_fact_of_some_design(monkeypatch: pytest.MonkeyPatch) -> None:
    """Rows of what a design does not have are left out: a misspelt name would never be missed."""
    asked, known = set[str](), set[str]()

    def rows(facts: Facts, names: Sequence[str]) -> dict[str, str]:
        asked.update(names)
        known.update(facts)
        return sheet_rows(facts, names)

    monkeypatch.setattr(paper, "sheet_rows", rows)
    changes = {
        "stepped_ellipse": {
            "blank.density_kg_m3": 7850.0,
            "blank.tip_rounding_mm": 0.01,
            "pair.x": 0.1,
        },
        "feeder": {},
        "ellipse": {"output.files": ["drawing-svg"]},  # with what is measured
        "rounded_square": {"output.files": ["drawing-svg"]},  # with eight spans
        "lathe_slide": {"blank.clearance_mm": 0.01},
        "plate_cam_oscillating": {"blank.density_kg_m3": 7850.0, "blank.clearance_mm": 0.01},
        "plate_cam_offset_roller": {},
        "tappet": {},
        "groove_cam": {"follower.roller2_radius_mm": 7.0},
        "valve_lever": {},
    }
    for name, change in changes.items():
        build(load(f"profiles/{name}.toml").with_(change)).files("drawing-svg")
    assert len(asked) > 25
    assert asked - known == set()


@pytest.mark.parametrize("name", ["ellipse", "tappet"])
def test_drawings_are_of_the_kind_that_is_asked_for(name: str) -> None:
    made = build(load(f"profiles/{name}.toml"))
    for file, data in made.files("drawing-dxf").items():
        assert file.endswith("_drawing.dxf")
        assert len(list(read_dxf(data).modelspace())) > 20
    for file, data in made.files("drawing-svg").items():
        assert file.endswith("_drawing.svg")
        assert ET.fromstring(data).tag.endswith("svg")
    for file, data in made.files("drawing-pdf").items():
        assert file.endswith("_drawing.pdf")
        assert data.startswith(b"%PDF")
