"""Sheets of wheels: teeth as ISO 2203 has them, tooth 1, the tip diameter, the mate, the files."""

from __future__ import annotations

import numpy as np
import pytest

import gearcam as gc
from gearcam.pictures.drawings import CENTRODE, Path
from gearcam.sheets.sheet import CENTERLINE, EDGE, Sheet
from helpers_pairs import profile
from helpers_sheets import faults

PINION = 2.0 * np.array([8.75, 10.0, 11.0])
"""Radii at roots, pitch curve and tips of 20 teeth of module 2."""


def notes(sheet: Sheet) -> str:
    return " ".join(text.text for text in sheet.texts)


def levels(sheet: Sheet, layer: str) -> set[float]:
    """Heights of the lines along the axis in the section."""
    paths = [one.shape for one in sheet.features if one.layer == layer]
    lines = [one.points for one in paths if isinstance(one, Path) and len(one.points) == 2]
    found = [line[0].imag for line in lines if line.real.min() > 22.0 and np.ptp(line.imag) == 0.0]
    return {*np.round(found, 4).tolist()}


def test_teeth_are_shown_whole_in_the_section() -> None:
    sheet = profile("gate_rack").sheets[0]
    root, pitch, tip = PINION.tolist()
    (hatch,) = sheet.hatches
    cut = np.concatenate(hatch.loops)
    assert np.abs(cut.imag).max() == pytest.approx(root, abs=1e-3)
    edges = levels(sheet, EDGE)
    for side in (1.0, -1.0):
        assert min(abs(side * root - y) for y in edges) < 1e-3
        assert min(abs(side * tip - y) for y in edges) < 1e-3
        assert min(abs(side * pitch - y) for y in levels(sheet, CENTERLINE)) < 1e-3
    curves = [one.shape for one in sheet.features if one.layer == CENTRODE]
    assert [np.ptp(np.abs(one.points)) < 1e-9 for one in curves] == [True]  # type: ignore[union-attr]


@pytest.mark.parametrize("name", ["ring_ellipse", "furnace_door", "stepped_ellipse"])
def test_no_tooth_is_hatched(name: str) -> None:
    """Of rings, open and stepped wheels: the metal ends at a parallel of the centrode."""
    result = profile(name)
    for gear, sheet, path in zip(result.gears, result.sheets, result.centrode_paths, strict=False):
        depth = gear.toothing.cutter.dedendum
        ends = {float(y) for loop in sheet.hatches[0].loops for y in np.round(loop.imag, 9)}
        near = min(abs(y) for y in ends if abs(abs(y) - crossing(path)) < 1.5 * depth)
        away = np.abs(path.points - 1j * near).min()
        assert away == pytest.approx(depth, rel=2e-3), name
        assert [*faults(sheet)] == []


def crossing(path: Path) -> float:
    """The height at which a centrode crosses the plane above its axis."""
    above = path.points[path.points.imag > 0.0]
    return float(above.imag[np.argmin(np.abs(above.real))])


def test_round_wheels_have_the_diameter_of_their_tips_once() -> None:
    sheet = profile("gate_rack").sheets[0]
    (tips,) = (one for one in sheet.dimensions if abs(one.value - 2.0 * PINION[2]) < 1e-6)
    assert tips.label == "Ø44"
    assert not [one.label for one in sheet.dimensions if "max" in one.label]


@pytest.mark.parametrize("name", ["shop_order", "gate_rack"])
def test_tooth_1_and_the_sense_of_counting_are_those_of_the_measures(name: str) -> None:
    result = profile(name)
    for number, sheet in enumerate(result.sheets[:2]):
        gear = result.gears[number]
        table = gear.flank_points(2)
        points = np.asarray(table["x_mm"] + 1j * table["y_mm"])
        outer = table["point"] == 2
        first, second = (points[outer & (table["tooth"] == one)].mean() for one in (1, 2))
        (label,) = (one for one in sheet.dimensions if one.label == "tooth 1")
        assert abs(label.points[-1] - first) < 0.1 * result.pair.module
        turn = (first.conjugate() * (second - first)).imag
        sense = "counter-clockwise" if turn > 0.0 else "clockwise"
        if name == "gate_rack" and number:
            sense = "upwards" if (second - first).imag > 0.0 else "downwards"
        assert f"Teeth are counted {sense} from tooth 1" in notes(sheet)


def test_the_mate_and_the_file_of_the_outline_are_named() -> None:
    design = gc.load("profiles/stepped_ellipse.toml")
    changes = {"drawing.part_number": ["G-1", "G-2"], "output.files": ["dxf", "drawing-svg"]}
    made = gc.build(design.with_(changes))
    first = made.sheets[0]
    assert dict(first.rows)["mates with"] == "G-2, 24 teeth"
    files = made.files("dxf")
    assert {"gear1_step1.dxf", "gear1_step4.dxf"} <= {*files}
    assert "Outline: gear1_step1.dxf to gear1_step4.dxf, chord" in notes(first)
    kerf = made.design.with_({"output.kerf_mm": 0.2, "steps.count": 1})
    told = notes(gc.build(kerf).sheets[1])
    assert "Outline: gear2.dxf, moved by half the kerf of 0.2 mm, chord" in told
    other = design.with_({"output.files": ["drawing-svg"], "steps.count": 1})
    assert "Outline: gear1.dxf (not written with this drawing)" in notes(gc.build(other).sheets[0])


def test_marks_have_their_centres_in_the_table() -> None:
    result = profile("shop_order")
    for part, sheet, other in zip(result.parts, result.sheets, ("gear2", "gear1"), strict=False):
        (at,) = (text.split() for label, text in sheet.rows if label.startswith("mark Ø"))
        (mark,) = part.marks
        found = complex(float(at[1]), float(at[3]))
        assert abs(found - mark.center) < 1e-3
        assert dict(sheet.rows)["mates with"] == f"{other}, 32 teeth"
    rack = profile("gate_rack")
    assert dict(rack.sheets[1].rows)["arrow, place by the DXF"].endswith(" deep")


def test_prints_have_the_centrode_and_files_to_cut_do_not() -> None:
    result = profile("gate_rack")
    kinds = [{one.layer for one in drawing.features} for drawing in result.printed]
    assert all(CENTRODE in layers for layers in kinds)
    assert not any(one.layer == CENTRODE for plate in result.to_cut for one in plate.features)


@pytest.mark.parametrize(("name", "number", "count"), [("limacon", 1, 8), ("ellipse", 0, 4)])
def test_all_spans_are_in_the_table(name: str, number: int, count: int) -> None:
    made = gc.build(gc.load(f"profiles/{name}.toml").with_({"output.files": ["drawing-svg"]}))
    sheet = made.sheets[number]
    spans = made.gears[number].measuring.spans
    shown = {value for label, value in sheet.rows if label.startswith("span ")}
    assert len([label for label, _ in sheet.rows if label.startswith("span ")]) == count
    assert len({*spans.place.tolist()}) == count
    assert {float(value.split()[0]) for value in shown} <= {*np.round(spans.reading, 3).tolist()}
    assert "Measures over pins, chords and spans are nominal." in notes(sheet)


def test_spans_that_are_too_many_for_a_sheet_are_counted(monkeypatch: pytest.MonkeyPatch) -> None:
    monkeypatch.setattr("gearcam.kinds.gear_pair.sheet.MOST_SPANS", 3)
    made = gc.build(gc.load("profiles/ellipse.toml").with_({"output.files": ["drawing-svg"]}))
    assert dict(made.data(1))["spans"] == "4 places, in measures.csv"
    assert not [label for label in made.data(1) if label.startswith("span ")]
