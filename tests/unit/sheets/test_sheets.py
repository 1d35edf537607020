"""Sheets choose paper and scale, find room, and say in the table what they cannot show."""

from __future__ import annotations

import math
from collections.abc import Sequence
from xml.etree import ElementTree as ET

import numpy as np
import pytest

from gearcam import build, load
from gearcam.base.errors import InfeasibleError
from gearcam.base.facts import Facts
from gearcam.base.numerals import decimal
from gearcam.export.dxf_read import read_dxf
from gearcam.kinds.gear_pair.drawings import pair_drawing
from gearcam.kinds.gear_pair.sheet import pair_sheet
from gearcam.numeric.pose import Pose
from gearcam.parts.body import Mark, Opening, Part
from gearcam.parts.shapes import Circle, Loop
from gearcam.pictures.drawings import OUTLINE, Drawing, Feature, Path, placed
from gearcam.sheets import paper, wheel_sheet
from gearcam.sheets.board import Board
from gearcam.sheets.paper import area_of, choose, scale_words, sheet_rows
from gearcam.sheets.sheet import (
    LinearDimension,
    RoundDimension,
    Sheet,
    Text,
    as_drawn,
    fine,
    text_box,
)
from helpers_contour import disc_contour, gear_contour, square_contour


def part(radius: float, openings: tuple[Opening, ...] = (), width: float = 5.0) -> Part:
    contour = disc_contour(radius, 1e-3)
    return Part(name="gear1", contours=(contour,), width=width, openings=openings)


def hole(x: float, y: float, diameter: float) -> Opening:
    return Opening(kind="HOLE", shape=Circle(center=complex(x, y), diameter=diameter), name="h")


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
    sheet = wheel_sheet(part(radius, width=width), {"a": "b"}, "t")
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
    sheet = wheel_sheet(part(20.0), facts, "t")
    heights = {text.text: sheet.on_paper(np.array([text.place]))[0].imag for text in sheet.texts}
    assert heights["row 79"] > 34.0
    assert heights["row 0"] < 287.0
    assert min(text.height for text in sheet.texts) > 1.0


@pytest.mark.parametrize("title", ["x" * 300, "a\nb\tc"])
def test_long_names_stay_in_their_cells(title: str) -> None:
    sheet = wheel_sheet(part(20.0), {"l" * 80: "v" * 90}, title)
    shown = " ".join(title.split())
    (found,) = (text for text in sheet.texts if text.text == shown)
    for text in sheet.texts:
        low, high = (sheet.on_paper(np.array([corner]))[0] for corner in text_box(text, sheet.unit))
        assert low.real > 20.0
        assert high.real < sheet.size[0] - 10.0
    assert found.height <= 4.0


def test_even_holes_are_a_pattern_and_others_have_letters() -> None:
    ring = [hole(20 * math.cos(a), 20 * math.sin(a), 3.0) for a in np.radians([30, 150, 270])]
    sheet = wheel_sheet(part(40.0, (*ring, hole(30.0, 5.0, 4.0), hole(-29.0, 5.0, 4.0))), {}, "t")
    rows = dict(sheet.rows)
    assert rows["3 x Ø3"] == "on Ø40, at 30 deg"
    assert rows["H1 Ø4"] == "X 30  Y 5"
    assert rows["H2 Ø4"] == "X -29  Y 5"
    labels = {one.label for one in sheet.dimensions}
    assert {"3 x Ø3", "Ø40", "H1 Ø4", "H2 Ø4"} <= labels


def test_holes_that_are_nearly_even_are_no_pattern() -> None:
    ring = [hole(20 * math.cos(a), 20 * math.sin(a), 3.0) for a in np.radians([30, 150, 270.01])]
    rows = dict(wheel_sheet(part(40.0, tuple(ring)), {}, "t").rows)
    assert set(rows) == {"H1 Ø3", "H2 Ø3", "H3 Ø3"}


def test_a_stop_slot_is_told() -> None:
    bend = math.tan(math.pi / 8)
    # an arc of radius 20 and width 2, from 0 to 90 deg
    points = np.array([21.0, 21.0j, 19.0j, 19.0])
    shape = Loop(points=points, bulges=np.array([bend, 1.0, -bend, 1.0]))
    sheet = wheel_sheet(part(40.0, (Opening(kind="SLOT", shape=shape, name="s"),)), {}, "t")
    rows = dict(sheet.rows)
    assert rows["slot, mid radius"] == "20"
    assert rows["slot, ends at"] == "0, 90 deg"
    (found,) = (one for one in sheet.dimensions if one.prefix == "slot ")
    assert found.label == "slot R1"


def test_a_rack_has_no_axis() -> None:
    square = square_contour(30.0)
    moved = placed(square, Pose(shift=100.0))
    rack = Part(name="gear2", contours=(moved,), width=4.0)  # type: ignore[arg-type]
    sheet = wheel_sheet(rack, {}, "t")
    assert sorted(one.value for one in sheet.dimensions) == pytest.approx([4.0, 30.0, 30.0])
    assert not [one for one in sheet.features if one.layer == "CENTERLINE"]


def test_what_has_no_room_goes_into_the_table() -> None:
    marks = tuple(
        Mark(center=complex(x, y), diameter=0.5, depth=0.2)
        for x in np.linspace(-25, 25, 12)
        for y in np.linspace(-25, 25, 12)
    )
    crowded = Part(name="gear1", contours=(disc_contour(40.0),), width=5.0, marks=marks)
    sheet = wheel_sheet(crowded, {}, "t")
    shown = sum(one.prefix == "mark " for one in sheet.dimensions)
    listed = sum(label == "mark" for label, _ in sheet.rows)
    assert shown + listed == len(marks)
    assert 0 < shown < len(marks)
    boxes = [text_box(one.text, sheet.unit) for one in sheet.drawn]
    for k, (low, high) in enumerate(boxes):
        for other_low, other_high in boxes[:k]:
            gaps = other_low - high, low - other_high
            assert max(max(gap.real, gap.imag) for gap in gaps) >= 0.0


def test_narrow_dimensions_have_their_text_and_arrows_outside() -> None:
    area = -50.0 - 50.0j, 50.0 + 50.0j
    board = Board(scale=1.0, area=area)
    board.linear(0.0, 2.0, -10.0)
    board.linear(0.0, 40.0, -20.0)
    narrow, wide = (as_drawn(one, 1.0) for one in board.dimensions)
    assert text_box(narrow.text, 1.0)[0].real > 2.0
    assert narrow.heads[0][1].real < 0.0
    assert wide.text.place == pytest.approx(20.0 + 1j * (-20.0 + 0.8))
    assert wide.heads[0][1].real > 0.0


def test_dimensions_know_their_values() -> None:
    at = 3.0 + 4.0j
    line = LinearDimension(first=0j, second=at, line=at, place=at, vertical=True, prefix="Ø")
    assert (line.value, line.label) == (4.0, "Ø4")
    ring = RoundDimension(center=at, radius=2.5, angle=math.pi / 2, suffix=" max")
    assert (ring.value, ring.label) == (5.0, "Ø5 max")
    assert ring.edge == pytest.approx(3.0 + 6.5j)
    inside = as_drawn(ring, 1.0)
    assert len(inside.heads) == 2
    assert inside.lines[0] == pytest.approx(np.array([3.0 + 1.5j, 3.0 + 6.5j]))


def test_upright_texts_have_upright_boxes() -> None:
    low, high = text_box(Text(text="abcd", place=0j, upright=True), 1.0)
    assert (high - low).imag > (high - low).real


def circles(count: int = 360) -> list[Path]:
    angle = np.linspace(0.0, 2 * np.pi, count, endpoint=False)
    return [Path(points=np.asarray(30.0 * np.exp(1j * angle), dtype=np.complex128))] * 2


def pair(phi: float = 0.2) -> Drawing:
    wheel = Part(name="g", contours=(gear_contour(30, 2.0, squash=(1.0, 1.0)),), width=5.0)
    poses = Pose(-phi), Pose(phi, 60.0)
    return pair_drawing([wheel, wheel], 60.0, circles(), poses=poses)


def test_the_pitch_point_is_marked() -> None:
    sheet = pair_sheet(pair(), 60.0, {}, "t", pitch_radius=30.0)
    rings = [one.shape for one in sheet.features if one.layer == "CENTERLINE"]
    (ring,) = (shape for shape in rings if isinstance(shape, Circle))
    assert ring.center == pytest.approx(30.0, abs=2e-3)
    assert "pitch point" in [text.text for text in sheet.texts]
    values = [one.value for one in sheet.dimensions]
    assert {30.0, 60.0} <= set(values)


def test_a_pair_with_a_rack_has_no_centre_distance() -> None:
    sheet = pair_sheet(pair(), 0.0, {}, "t", pitch_radius=30.0)
    assert 60.0 not in [one.value for one in sheet.dimensions]
    names = [text.text for text in sheet.texts]
    assert "gear1" in names
    assert "gear2" not in names


def test_the_shaft_of_an_open_ring_may_lie_beside_its_outline() -> None:
    """Its centre line is on the paper, and the height is measured left of it."""
    ring = placed(disc_contour(20.0, 1e-3), Pose(shift=90.0))
    parts = [part(30.0), Part(name="gear2", contours=(ring,), width=5.0)]  # type: ignore[arg-type]
    sheet = pair_sheet(pair_drawing(parts, -60.0), -60.0, {}, "t", pitch_radius=30.0)
    (height,) = (
        one for one in sheet.dimensions if isinstance(one, LinearDimension) and one.vertical
    )
    assert height.value == pytest.approx(60.0, abs=2e-3)
    assert sheet.corner.real < height.line.real < -60.0
    lines = [one.shape for one in sheet.features if one.layer == "CENTERLINE"]
    assert min(line.points.real.min() for line in lines if isinstance(line, Path)) < -60.0


def test_nothing_is_not_drawn() -> None:
    mark = Feature(layer="MARK", shape=Circle(center=0j, diameter=1.0))
    with pytest.raises(ValueError, match="nothing to draw"):
        pair_sheet(Drawing(name="empty", features=(mark,)), 60.0, {}, "t", pitch_radius=30.0)


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


def test_the_side_view_of_a_groove_has_both_walls() -> None:
    made = build(load("profiles/groove_cam.toml"))
    features = wheel_sheet(made.parts[0], {}, "groove").features
    hidden = [
        one.shape.points for one in features if isinstance(one.shape, Path) and one.kind == "HIDDEN"
    ]
    level = [points[0].imag for points in hidden if np.ptp(points.imag) == 0.0]
    walls = [one.vertices[:, 1] for one in made.profiles]
    bore = [-8.0, 8.0]
    ends = [end for y in walls for end in (y.min(), y.max())]
    assert sorted(level) == pytest.approx(sorted(ends + bore), abs=2e-3)
