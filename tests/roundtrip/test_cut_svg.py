"""Files for lasers, read by nothing but their text: true size, order, colours, nothing overlaps."""

from __future__ import annotations

import itertools
import math
import re
from dataclasses import dataclass, replace
from functools import cache
from typing import Any
from xml.etree import ElementTree as ET

import numpy as np
import pytest
import shapely
from numpy.typing import NDArray

from gearcam.export.cut_svg import cut_svg
from gearcam.export.laser_sheet import GAP, labelled, nested, strokes, text_width
from gearcam.kinds.cam.result import CamResult
from gearcam.kinds.gear_pair.result import GearPairResult
from gearcam.numeric.arrays import as_pairs, bounds
from gearcam.numeric.contour import Contour
from gearcam.parts.blank import Blank, WheelBlank
from gearcam.parts.body import Mark, Part
from gearcam.parts.make import make_part
from gearcam.parts.openings import Workpiece
from gearcam.pictures.drawings import Drawing, Feature, cut_drawing, wheel_drawing
from helpers_contour import disc_contour, gear_contour, square_contour
from helpers_files import ROLLER, read
from helpers_pairs import profile
from helpers_sampling import few
from witness.distance import distances

SVG = "{http://www.w3.org/2000/svg}"
RED, BLUE = "#ff0000", "#0000ff"
KERF = 0.2


@dataclass(frozen=True)
class Line:
    """A path: its group, colour and width, its class, its points with y upwards."""

    group: str
    colour: str
    width: float
    layer: str
    points: NDArray[np.complex128]
    closed: bool

    @property
    def region(self) -> shapely.Polygon:
        assert self.closed
        return shapely.Polygon([(z.real, z.imag) for z in self.points])


@dataclass(frozen=True)
class Sheet:
    size: tuple[float, float]
    lines: tuple[Line, ...]

    def regions(self, kind: str) -> list[shapely.Polygon]:
        return [line.region for line in self.lines if line.layer.startswith(kind)]


def arc(start: complex, end: complex, radius: float, sweep: bool) -> np.ndarray:
    """Points of a small arc as SVG defines it, y downwards; its start left out."""
    half = 0.5 * abs(end - start)
    assert half <= radius * (1 + 1e-6)
    up = math.sqrt(max(radius**2 - half**2, 0.0))
    side = 1j * (end - start) / abs(end - start) * (1 if sweep else -1)
    center = 0.5 * (start + end) + up * side
    turn = np.angle((end - center) / (start - center))
    assert (turn > 0) == sweep
    count = math.ceil(abs(turn) * math.sqrt(radius / 8e-5)) + 1
    return center + (start - center) * np.exp(1j * turn * np.arange(1, count + 1) / count)


def points_of(data: str) -> tuple[NDArray[np.complex128], bool]:
    """Read path data of the commands M, L, A and Z."""
    made: list[NDArray[np.complex128]] = []
    closed = False
    for word, rest in re.findall(r"([MLAZ])([^MLAZ]*)", data):
        numbers = [float(one) for one in rest.split()]
        if word == "A":
            rx, ry, tilt, large, sweep, x, y = numbers
            assert (rx == ry, tilt, large) == (True, 0, 0)
            made.append(arc(complex(made[-1][-1]), complex(x, y), rx, bool(sweep)))
        elif word == "Z":
            closed = True
        else:
            made.append(np.array([complex(*numbers)]))
    return np.concatenate(made), closed


def sheet_of(data: bytes) -> Sheet:
    root = ET.fromstring(data)
    left, top, wide, tall = (float(one) for one in root.attrib["viewBox"].split())
    assert (left, top) == (0, 0)
    assert root.attrib["width"] == f"{wide:.12g}mm"
    assert root.attrib["height"] == f"{tall:.12g}mm"
    lines = []
    for group in root.findall(f"{SVG}g"):
        assert group.attrib["fill"] == "none"
        for path in group:
            assert path.tag == f"{SVG}path"
            points, closed = points_of(path.attrib["d"])
            lines.append(
                Line(
                    group.attrib["id"],
                    group.attrib["stroke"],
                    float(group.attrib["stroke-width"]),
                    path.attrib["class"],
                    1j * tall + np.conj(points),
                    closed,
                )
            )
    return Sheet((wide, tall), tuple(lines))


def marked(contour: Contour, name: str = "gear1", **sizes: Any) -> Part:
    """A part that is not its own mirror image."""
    blank = WheelBlank(
        bore_diameter=20.0, keyway_width=6.0, keyway_depth=2.8, keyway_angle=0.7, bolts=1,
        bolt_circle=36.0, bolt_diameter=5.0, bolt_angle=2.0, stop_pin=3.0, **sizes,
    )  # fmt: skip
    mark = Mark(center=complex(0.0, 16.0), diameter=1.2, depth=0.5)
    place = Workpiece(name="wheel 1", wheel=1, rim=5.4, travel=0.8)
    return make_part(name, [contour], 5.0, blank, place, lambda: mark)


@cache
def part() -> Part:
    return marked(gear_contour(18, 4.0))


def demand_same(got: shapely.Polygon, wanted: shapely.Polygon, tolerance: float) -> None:
    for one, other in ((got, wanted), (wanted, got)):
        assert distances(shapely.get_coordinates(one), other.boundary).max() <= tolerance
    assert abs(got.area - wanted.area) < tolerance * wanted.length


@pytest.mark.parametrize("kerf", few([KERF, 0.0]))
def test_one_part_is_drawn_in_its_size_and_not_mirrored(kerf: float) -> None:
    drawing = cut_drawing(wheel_drawing(part()), kerf)
    sheet = sheet_of(cut_svg([drawing], "one", kerf))
    (outer,) = sheet.regions("outline")
    shift = np.subtract(part().contour.polygon.bounds[:2], outer.bounds[:2]) - 0.5 * kerf
    tolerance = 2 * part().tolerance

    def there(one: shapely.Polygon) -> shapely.Polygon:
        return shapely.affinity.translate(one, *shift)

    demand_same(there(outer), part().contour.polygon.buffer(0.5 * kerf, quad_segs=256), tolerance)
    for kind in ("BORE", "HOLE", "SLOT"):
        (got,) = sheet.regions(kind.lower())
        (opening,) = [one for one in part().openings if one.kind == kind]
        assert not isinstance(opening.shape, Contour)
        edge = shapely.Polygon(as_pairs(opening.shape.polyline(1e-5)))
        demand_same(there(got), edge.buffer(-0.5 * kerf, quad_segs=256), tolerance)
        mirrored = shapely.affinity.scale(got, -1.0, origin=outer.centroid)
        assert there(mirrored).symmetric_difference(edge).area > 0.3 * edge.length
    (mark,) = sheet.regions("mark")
    assert mark.area == pytest.approx(math.pi * 0.6**2, rel=1e-3)
    x, y = np.array(mark.centroid.coords[0]) + shift
    assert (x, y) == pytest.approx((0.0, 16.0), abs=1e-4)
    names = {line.layer for line in sheet.lines}
    end = "_kerf" if kerf else ""
    assert names == {"mark", *(f"{kind}{end}" for kind in ("outline", "bore", "hole", "slot"))}
    size = np.ptp(outer.boundary.coords, axis=0)
    assert np.array(sheet.size) == pytest.approx(size + 2.0, abs=2e-3)


def test_engraving_comes_first_and_outlines_last() -> None:
    drawings = nested([labelled(wheel_drawing(part())), labelled(wheel_drawing(part()))])
    lines = sheet_of(cut_svg(drawings, "two")).lines
    assert [group for group, _ in itertools.groupby(lines, lambda line: line.group)] == [
        "engrave", "cut-inner", "cut-outer",
    ]  # fmt: skip
    for line in lines:
        engraved = line.layer in ("mark", "label")
        assert line.group == ("engrave" if engraved else f"cut-{_side(line.layer)}")
        assert line.colour == (BLUE if engraved else RED)
        assert 0.0 < line.width <= 0.0254
        assert line.closed == (line.layer != "label")
    counts = {kind: sum(line.layer == kind for line in lines) for kind in ("outline", "bore")}
    assert counts == {"outline": 2, "bore": 2}


def _side(layer: str) -> str:
    return "outer" if layer == "outline" else "inner"


def test_half_circles_keep_their_centres() -> None:
    """In two arcs: the centre of one would lie off by the root of a rounded radius."""
    data = cut_svg([wheel_drawing(part())], "one").decode()
    found = re.search(r'class="slot" d="([^"]+)"', data)
    assert found is not None
    assert found.group(1).count("A") == 6


@pytest.mark.parametrize("tolerance", [1e-2, 1e-3, 1e-5])
def test_curves_stay_within_the_tolerance(tolerance: float) -> None:
    contour = gear_contour(9, 4.0, tolerance)
    plain = make_part(
        "gear1",
        [contour],
        5.0,
        WheelBlank(timing_marks=False),
        Workpiece(name="wheel 1", wheel=1, rim=10.8),
    )
    sheet = sheet_of(cut_svg([wheel_drawing(plain)], "one"))
    (line,) = sheet.lines
    dense = as_pairs(np.concatenate([run.points[:-1] for run in contour.runs]))
    shift = dense.min(axis=0) - np.array(line.region.bounds[:2])
    off = distances(dense - shift, line.region.boundary)
    allowed = 1.1 * tolerance + 2e-5  # of the chords of the arcs here, and of the shift
    assert off.max() <= allowed
    assert off.max() > 0.2 * tolerance


SHAPES = {
    "one": [gear_contour(18, 4.0)],
    "two wheels": [gear_contour(18, 4.0), gear_contour(12, 4.0)],
    "many": [*(disc_contour(4.0 + 3 * k) for k in range(7)), *[square_contour(21.0)] * 5],
}


@pytest.mark.parametrize("name", SHAPES)
def test_nested_parts_keep_a_gap_and_the_sheet_is_tight(name: str) -> None:
    plain = WheelBlank(timing_marks=False)
    place = Workpiece(name="wheel 1", wheel=1, rim=5.4)
    parts = [make_part(f"gear{k}", [one], 5.0, plain, place) for k, one in enumerate(SHAPES[name])]
    sheet = sheet_of(cut_svg(nested([labelled(wheel_drawing(one)) for one in parts]), name))
    outlines = sheet.regions("outline")
    assert len(outlines) == len(parts)
    for one, other in itertools.combinations(outlines, 2):
        assert one.distance(other) >= GAP - 1e-3
    box = shapely.union_all(outlines).bounds
    labels: Any = np.concatenate([one.points for one in sheet.lines if one.layer == "label"])
    low = min(box[0], labels.real.min()), min(box[1], labels.imag.min())
    assert low == pytest.approx((1.0, 1.0), abs=2e-3)
    assert box[2:] == pytest.approx(np.array(sheet.size) - 1.0, abs=2e-3)
    taken = sum(outline.area for outline in outlines)
    assert taken > 0.45 * math.prod(sheet.size)


def strokes_of(sheet: Sheet) -> shapely.MultiLineString:
    lines = [line.points for line in sheet.lines if line.layer == "label"]
    return shapely.MultiLineString([[(z.real, z.imag) for z in line] for line in lines])


def test_names_stand_on_their_parts_clear_of_all_edges() -> None:
    drawing = labelled(cut_drawing(wheel_drawing(part()), KERF))
    sheet = sheet_of(cut_svg([drawing], "one"))
    name = strokes_of(sheet)
    (outer,) = sheet.regions("outline")
    assert outer.contains(name)
    for line in sheet.lines:
        if line.layer != "label":
            assert line.region.boundary.distance(name) > 0.9
    left, low, right, high = name.bounds
    assert 1.5 <= high - low <= 5.0
    assert (right - left) / (high - low) == pytest.approx(text_width("GEAR 1"), abs=0.35)


def test_names_without_room_stand_below() -> None:
    thin = make_part(
        "gear2_step1", [disc_contour(4.0)], 5.0,
        WheelBlank(timing_marks=False, bore_diameter=6.0),
        Workpiece(name="wheel 2", wheel=2, rim=2.7),
    )  # fmt: skip
    drawing = labelled(wheel_drawing(thin))
    sheet = sheet_of(cut_svg([drawing], "one"))
    name, (outline,) = strokes_of(sheet), sheet.regions("outline")
    _, low, _, high = name.bounds
    assert outline.bounds[1] - high == pytest.approx(3.0, abs=1e-3)
    assert high - low == pytest.approx(1.5)
    both = sheet_of(cut_svg(nested([drawing, drawing]), "two"))
    assert min(one.distance(strokes_of(both)) for one in both.regions("outline")) >= 2.99


def test_letters_read_as_they_should() -> None:
    """A G opens to the right, a 4 has its corner at the left; every name of a part has letters."""
    (g,) = strokes("G", 6.0, 10.0 + 20.0j)
    assert bounds(g) == pytest.approx((10.0 + 20.0j, 14.0 + 26.0j))
    for name in ("GEAR 1234567890", "STEP", "CAM"):
        right = max(line.real.max() for line in strokes(name, 3.0, 0j))
        assert right <= text_width(name) * 3.0 + 1e-9
    with pytest.raises(KeyError):
        strokes("Q", 1.0, 0j)


def test_what_has_no_outline_is_not_cut() -> None:
    mark = Feature(layer="MARK", shape=part().marks[0].edge)
    with pytest.raises(ValueError, match="nothing to cut"):
        cut_svg([Drawing(name="gear1", features=(mark,))], "none")


def test_a_pair_has_a_file_for_each_wheel_and_one_for_both() -> None:
    design = profile("ellipse").design

    output = replace(design.output, chord_tolerance=0.01, kerf=KERF)
    made = GearPairResult(
        replace(design, output=output, blank=Blank(bore_diameter=(8.0, 6.0)))
    ).files("cut-svg", {})
    assert set(made) == {"gear1_cut.svg", "gear2_cut.svg", "cut.svg"}
    assert "half the kerf of 0.2 mm" in made["cut.svg"].decode()
    sheets = {name: sheet_of(data) for name, data in made.items()}
    areas = [sheets[f"gear{k}_cut.svg"].regions("outline_kerf")[0].area for k in (1, 2)]
    both = [outline.area for outline in sheets["cut.svg"].regions("outline_kerf")]
    assert both == pytest.approx(areas, rel=1e-5)
    bores = [region.area for region in sheets["cut.svg"].regions("bore_kerf")]
    assert bores == pytest.approx([math.pi * 3.9**2, math.pi * 2.9**2], rel=1e-4)
    assert not [line for line in sheets["gear1_cut.svg"].lines if line.layer == "label"]
    assert [line for line in sheets["cut.svg"].lines if line.layer == "label"]


@pytest.mark.parametrize("kerf", [0.0, KERF])
def test_a_cam_is_cut_without_its_pitch_curve(kerf: float) -> None:

    design = read(ROLLER)
    job = CamResult(replace(design, output=replace(design.output, kerf=kerf)))
    made = job.files("cut-svg", {})
    assert set(made) == {"cam_cut.svg", "cut.svg"}
    (line,) = sheet_of(made["cam_cut.svg"]).lines
    size = job.cam.walls[0].size
    wanted = size.area + 0.5 * kerf * size.perimeter + math.pi * (0.5 * kerf) ** 2
    assert line.region.area == pytest.approx(wanted, abs=2e-3 * size.perimeter)
    assert line.group == "cut-outer"


def test_stepped_wheels_have_a_file_for_each_step() -> None:
    design = profile("stepped_ellipse").design
    output = replace(design.output, chord_tolerance=0.02)
    steps = replace(design.steps, count=2)
    made = GearPairResult(replace(design, steps=steps, output=output)).files("cut-svg", {})
    wheels = [f"gear{wheel}_step{step}_cut.svg" for wheel in (1, 2) for step in (1, 2)]
    assert set(made) == {*wheels, "cut.svg"}
    assert len(sheet_of(made["cut.svg"]).regions("outline")) == 4
