"""DXF files read back hold the drawing, in millimetres, and their measured error is true."""

from __future__ import annotations

from dataclasses import replace
from typing import Any

import numpy as np
import pytest
from ezdxf.document import Drawing as Document
from ezdxf.entities.lwpolyline import LWPolyline
from ezdxf.math import bulge_to_arc

import gearcam
from gearcam.export.dxf import DxfStyle, dxf_bytes
from gearcam.export.dxf_read import DxfError, measure_dxf, read_dxf
from gearcam.kinds.gear_pair.drawings import pair_drawing
from gearcam.numeric.pose import Pose
from gearcam.parts.body import Part
from gearcam.parts.marks import timing_mark
from gearcam.pictures.drawings import Drawing, wheel_drawing
from gearcam.pictures.drawings import Path as Chain
from helpers_built import built
from helpers_contour import bore, gear_contour, layers, square_contour
from helpers_sampling import few

TOLERANCE = 1e-3


def style(curves: str = "arcs", version: str = "R2010", tolerance: float = TOLERANCE) -> DxfStyle:
    return DxfStyle(tolerance=tolerance, curves=curves, version=version)


def wheel(tolerance: float = TOLERANCE, teeth: int = 18) -> Part:
    contour = gear_contour(teeth, 5.0, tolerance)
    mark = timing_mark(40.0, 0.0, 5.0, 6.25, 20.0, bore_reach=10.0)
    return Part(name="gear1", contours=(contour,), openings=bore(20.0), width=20.0, marks=(mark,))


@pytest.fixture(scope="module")
def part() -> Part:
    return wheel()


@pytest.fixture(scope="module")
def pair(part: Part) -> Drawing:
    centrode = Chain(points=part.contour.points[::50] * 0.9)
    return pair_drawing([part, part], 95.0, [centrode, centrode])


def outline_of(document: Document) -> LWPolyline:
    """The only outline of a wheel's file."""
    (found,) = document.modelspace().query("LWPOLYLINE")
    assert isinstance(found, LWPolyline)
    return found


def entities(document: Document) -> dict[str, list[str]]:
    found: dict[str, list[str]] = {}
    for entity in document.modelspace():
        found.setdefault(entity.dxf.layer, []).append(entity.dxftype())
    return found


def area(rows: np.ndarray) -> float:
    """Area of a closed bulge polyline: shoelace and circular segments, by ezdxf's own arcs."""
    ends = np.roll(rows, -1, axis=0)
    total = 0.5 * float(np.sum(rows[:, 0] * ends[:, 1] - ends[:, 0] * rows[:, 1]))
    for (x, y, bulge), (u, v, _) in zip(rows.tolist(), ends.tolist(), strict=True):
        if bulge:
            _, start, end, radius = bulge_to_arc((x, y), (u, v), bulge)
            angle = (end - start) % (2 * np.pi)
            total += np.sign(bulge) * 0.5 * radius**2 * (angle - np.sin(angle))
    return total


@pytest.mark.parametrize("curves", ["arcs", "lines"])
def test_a_wheel_file_holds_outline_bore_and_mark(part: Part, curves: str) -> None:
    document = read_dxf(dxf_bytes(wheel_drawing(part), style(curves)))
    assert document.acad_release == "R2010"
    assert document.header["$INSUNITS"] == 4
    assert document.header["$MEASUREMENT"] == 1
    assert entities(document) == {"OUTLINE": ["LWPOLYLINE"], "BORE": ["CIRCLE"], "MARK": ["CIRCLE"]}
    assert outline_of(document).closed
    bore, mark = document.modelspace().query("CIRCLE")
    assert bore.dxf.radius == 10.0
    assert tuple(bore.dxf.center) == (0.0, 0.0, 0.0)
    assert mark.dxf.radius == part.marks[0].diameter / 2
    assert complex(*tuple(mark.dxf.center)[:2]) == part.marks[0].center


def test_the_pair_file_has_a_layer_per_feature_and_its_extents(pair: Drawing) -> None:
    document = read_dxf(dxf_bytes(pair, style()))
    assert entities(document) == {
        "GEAR1_OUTLINE": ["LWPOLYLINE"],
        "GEAR1_BORE": ["CIRCLE"],
        "GEAR1_MARK": ["CIRCLE"],
        "GEAR2_OUTLINE": ["LWPOLYLINE"],
        "GEAR2_BORE": ["CIRCLE"],
        "GEAR2_MARK": ["CIRCLE"],
        "CENTRODE": ["LWPOLYLINE", "LWPOLYLINE"],
        "CENTER": ["LINE"] * 4,
    }
    colours = [document.layers.get(layer).color for layer in layers(pair)]
    assert colours == [1, 1, 5, 1, 1, 5, 8, 8]  # red is cut, blue engraved, grey for reference
    assert document.layers.get("CENTRODE").dxf.linetype == "DASHED"
    widest = max(contour.vertices[:, 0].max() for contour in pair.contours)
    assert document.header["$EXTMAX"][0] == pytest.approx(widest, abs=1e-9)


@pytest.mark.parametrize("curves", ["arcs", "lines"])
@pytest.mark.parametrize("tolerance", [1e-2, 1e-3])
def test_the_measured_error_stays_within_the_tolerance(curves: str, tolerance: float) -> None:
    drawing = wheel_drawing(wheel(tolerance))
    error = measure_dxf(dxf_bytes(drawing, style(curves, tolerance=tolerance)), drawing.contours)
    assert 0.8 * tolerance < error <= tolerance


def polygons(radius: float, teeth: int, chord: float, **size: float) -> dict[str, Any]:
    """Rounded squares: their flanks are mostly straight and end in an arc."""
    return {
        "kind": "gear-pair",
        "name": "polygons",
        "law": {"type": "rounded-polygon", "corners": 4, "corner_radius": radius},
        "pair": {"teeth": [teeth, teeth]} | size,
        "output": {"chord_tolerance_mm": chord},
    }


BENDS: dict[str, dict[str, Any]] = {
    "straight into round": polygons(0.206264, 32, 0.00389068, center_distance_mm=22.3465),
    "a flank 300 times as long as steps of the bend": polygons(
        0.178076, 35, 0.001, module_mm=7.78935
    ),
    "a corner beside a long dwell": {
        "kind": "cam",
        "name": "corner",
        "motion": [
            {"type": "rise", "law": "formula", "formula": "sin(pi*x/2)**2", "travel_mm": 160}
            | {"lift_mm": 3.3},
            {"type": "dwell", "travel_mm": 205},
            {"type": "return", "law": "3-4-5", "travel_mm": 186},
        ],
        "follower": {"type": "point"},
        "cam": {"form": "translating"},
        "blank": {"height_mm": 60},
        "output": {"chord_tolerance_mm": 0.0035},
    },
}


@pytest.mark.parametrize("curves", few(["arcs", "splines"]))
@pytest.mark.parametrize("document", BENDS.values(), ids=BENDS)
def test_long_curves_that_end_in_short_bends_keep_the_tolerance(
    document: dict[str, Any], curves: str
) -> None:
    part = built(gearcam.design(document)).parts[0]
    data = dxf_bytes(wheel_drawing(part), style(curves, tolerance=part.tolerance))
    assert measure_dxf(data, wheel_drawing(part).contours) <= part.tolerance


def test_the_pair_is_measured_in_its_place(pair: Drawing) -> None:
    data = dxf_bytes(pair, style())
    assert measure_dxf(data, pair.contours) <= TOLERANCE
    assert measure_dxf(data, pair.contours[::-1]) > 10


def test_the_arcs_turn_the_right_way(part: Part) -> None:
    """The area with arcs, counted by ezdxf's arcs, is the true one."""
    document = read_dxf(dxf_bytes(wheel_drawing(part), style()))
    rows = np.array(outline_of(document).get_points(format="xyb"))
    runs = np.concatenate([run.points[:-1] for run in part.contour.runs])
    x, y = runs.real, runs.imag
    true = 0.5 * float(np.sum(x * np.roll(y, -1) - y * np.roll(x, -1)))
    assert area(rows) == pytest.approx(true, abs=0.2)
    rows[:, 2] *= -1
    assert abs(area(rows) - true) > 1


@pytest.mark.parametrize("fault", few(["sign", "inches", "dropped", "mirrored"]))
def test_a_fault_in_the_file_is_measured(fault: str) -> None:
    drawing = wheel_drawing(wheel(teeth=12))
    document = read_dxf(dxf_bytes(drawing, style()))
    polyline = outline_of(document)
    rows = np.array(polyline.get_points(format="xyb"))
    longest = int(np.argmax(np.abs(rows[:, 2])))
    if fault == "sign":
        rows[longest, 2] *= -1
    elif fault == "dropped":
        rows = np.delete(rows, longest, axis=0)
    elif fault == "inches":
        rows[:, :2] /= 25.4
    else:
        rows *= [1, -1, -1]
    polyline.set_points(rows.tolist(), format="xyb")
    assert measure_dxf(written(document), drawing.contours) > 3 * TOLERANCE


def written(document: Document) -> bytes:
    import io

    stream = io.StringIO()
    document.write(stream)
    return stream.getvalue().encode()


def test_files_that_do_not_hold_the_drawing_are_refused(part: Part, pair: Drawing) -> None:
    drawing = wheel_drawing(part)
    data = dxf_bytes(drawing, style())
    with pytest.raises(DxfError, match="should hold 1 closed outlines, but holds 2"):
        measure_dxf(dxf_bytes(pair, style()), drawing.contours)
    document = read_dxf(data)
    document.units = 1
    with pytest.raises(DxfError, match="not in mm"):
        measure_dxf(written(document), drawing.contours)
    document = read_dxf(data)
    outline_of(document).closed = False
    with pytest.raises(DxfError, match="closed"):
        measure_dxf(written(document), drawing.contours)
    for damaged in (b"", b"no DXF", data[: len(data) // 2], b"\xff\xfe\x00"):
        with pytest.raises(DxfError):
            read_dxf(damaged)


def test_a_file_that_fails_the_audit_is_refused(part: Part) -> None:
    data = dxf_bytes(wheel_drawing(part), style())
    with pytest.raises(DxfError, match=r"errors \(1\)"):
        read_dxf(data.replace(b"OUTLINE\n", b"OUT*LINE\n"))


def test_straight_sides_stay_straight() -> None:
    square = Part(name="plate", contours=(square_contour(10.0),), width=1.0)
    document = read_dxf(dxf_bytes(wheel_drawing(square), style()))
    rows = outline_of(document).get_points(format="xyb")
    assert rows == [(5.0, 5.0, 0.0), (-5.0, 5.0, 0.0), (-5.0, -5.0, 0.0), (5.0, -5.0, 0.0)]


@pytest.mark.parametrize(
    ("curves", "version"), [("circles", "R2010"), ("arcs", "R14"), ("splines", "R12")]
)
def test_other_styles_are_refused(curves: str, version: str) -> None:
    with pytest.raises(ValueError, match=r"unknown curves|not support splines"):
        style(curves, version)


def test_the_same_drawing_gives_the_same_bytes(part: Part) -> None:
    """In other processes too, see `test_same_bytes`."""
    drawing = wheel_drawing(part)
    assert dxf_bytes(drawing, style()) == dxf_bytes(drawing, style())


def test_a_turned_wheel_is_measured_too(part: Part) -> None:
    from gearcam.pictures.drawings import place

    turned = replace(
        wheel_drawing(part), features=place(wheel_drawing(part).features, Pose(0.7, 3.0 + 4.0j))
    )
    assert measure_dxf(dxf_bytes(turned, style()), turned.contours) <= TOLERANCE
