"""Splines, R12 and openings in DXF files, read back by ezdxf and by a small reader of its own."""

from __future__ import annotations

import io
import math
from collections.abc import Sequence
from typing import Any

import numpy as np
import pytest
from ezdxf.entities.polyline import Polyline
from ezdxf.entities.spline import Spline

from gearcam.export.dxf import DxfStyle, dxf_bytes
from gearcam.export.dxf_read import DxfError, measure_dxf, read_dxf
from gearcam.kinds.gear_pair.drawings import pair_drawing
from gearcam.numeric import splines
from gearcam.numeric.arcs import fit_closed
from gearcam.numeric.arrays import as_pairs
from gearcam.numeric.contour import Contour, Run
from gearcam.numeric.pose import Pose
from gearcam.parts.blank import WheelBlank
from gearcam.parts.body import Opening, Part
from gearcam.parts.openings import bore as bore_of
from gearcam.parts.shapes import Circle, Loop
from gearcam.pictures.drawings import placed, wheel_drawing
from helpers_cams import cam
from helpers_contour import bore, gear_contour
from witness.distance import distances

TOLERANCE = 1e-3


def wheel(teeth: int = 18) -> Part:
    contour = gear_contour(teeth, 5.0, TOLERANCE)
    keyed = WheelBlank(bore_diameter=20.0, keyway_width=6.0, keyway_depth=2.8)
    hole = Circle(center=complex(20.0, 5.0), diameter=6.0)
    openings = (
        Opening(kind="BORE", shape=bore_of(keyed), name="bore"),
        Opening(kind="HOLE", shape=hole, name="hole"),
    )
    return Part(name="gear1", contours=(contour,), openings=openings, width=8.0)


def groups(data: bytes) -> list[tuple[int, str]]:
    """Codes and values of a DXF file, by nothing but its text."""
    lines = data.decode("ascii").splitlines()
    return [(int(code), value.strip()) for code, value in zip(lines[::2], lines[1::2], strict=True)]


def spline_points(data: bytes, count: int = 40) -> list[np.ndarray]:
    """Dense points of every spline, by de Boor's rule on what the file holds."""
    found = []
    for entity in read_dxf(data).modelspace():
        if isinstance(entity, Spline):
            poles = np.array(entity.control_points)[:, :2]
            found.append(de_boor(poles, np.array(entity.knots), count))
    return found


def de_boor(poles: np.ndarray, knots: np.ndarray, count: int) -> np.ndarray:
    """Points of a cubic B-spline, `count` to each span."""
    points = []
    for k in range(3, len(poles)):
        if knots[k] == knots[k + 1]:
            continue
        for u in np.linspace(knots[k], knots[k + 1], count):
            d = [poles[j + k - 3] for j in range(4)]
            for r in range(1, 4):
                for j in range(3, r - 1, -1):
                    low, high = knots[j + k - 3], knots[j + 1 + k - r]
                    a = (u - low) / (high - low)
                    d[j] = (1 - a) * d[j - 1] + a * d[j]
            points.append(d[3])
    return np.array(points)


def test_splines_stay_within_the_tolerance() -> None:
    from shapely import LinearRing

    part = wheel()
    data = dxf_bytes(wheel_drawing(part), DxfStyle(tolerance=TOLERANCE, curves="splines"))
    assert measure_dxf(data, [part.contour]) <= TOLERANCE
    found = spline_points(data)
    assert len(found) == len(part.contour.runs)
    dense = as_pairs(np.concatenate([run.points[:-1] for run in part.contour.runs]))
    away = distances(np.vstack(found), LinearRing(dense))
    assert 0.2 * TOLERANCE < away.max() <= TOLERANCE
    for one, two in zip(found, [*found[1:], found[0]], strict=True):
        assert one[-1] == pytest.approx(two[0], abs=1e-14)


def test_what_is_measured_of_long_cubics_is_their_own_error() -> None:
    """A cam's cubics are long, and an arc through three of their points leaves them visibly."""
    from shapely import LinearRing

    contour = cam("roller", "3-4-5", tolerance=TOLERANCE).contour
    drawing = wheel_drawing(Part(name="cam", contours=(contour,), width=8.0))
    data = dxf_bytes(drawing, DxfStyle(tolerance=TOLERANCE, curves="splines"))
    found = np.vstack(spline_points(data, 300))
    dense = as_pairs(np.concatenate([run.points[:-1] for run in contour.runs]))
    ways = distances(found, LinearRing(dense)), distances(dense, LinearRing(found))
    true = max(float(way.max()) for way in ways)
    assert measure_dxf(data, [contour]) == pytest.approx(true, abs=0.01 * TOLERANCE)


def test_splines_need_fewer_points_at_fine_tolerances() -> None:
    """The error of a cubic falls with the fourth power of its length, that of biarcs the third."""
    contour, tolerance = gear_contour(18, 5.0, 1e-5), 1e-5
    poles = sum(len(one.poles) for one in splines.fit_splines(contour.runs, tolerance))
    arcs = len(fit_closed(contour.runs, tolerance)[0])
    assert poles < 1.05 * arcs < 0.2 * len(contour.vertices)


def test_a_spline_that_leaves_the_curve_is_seen(monkeypatch: pytest.MonkeyPatch) -> None:
    """Control: one pole moved by 20 um is found, and a file with a spline less is refused."""
    from gearcam.export import dxf

    part, style = wheel(), DxfStyle(tolerance=TOLERANCE, curves="splines")
    good = splines.fit_splines

    def bad(runs: Sequence[Run], tolerance: float) -> list[splines.Spline]:
        made = good(runs, tolerance)
        poles = made[7].poles.copy()
        poles[1] += 0.02 + 0.02j
        made[7] = splines.Spline(poles=poles, breaks=made[7].breaks)
        return made

    monkeypatch.setattr(dxf, "fit_splines", bad)
    assert measure_dxf(dxf_bytes(wheel_drawing(part), style), [part.contour]) > 3 * TOLERANCE
    monkeypatch.undo()
    document = read_dxf(dxf_bytes(wheel_drawing(part), style))
    space = document.modelspace()
    space.delete_entity(list(space.query("SPLINE"))[5])
    stream = io.StringIO()
    document.write(stream)
    with pytest.raises(DxfError, match="closed outlines"):
        measure_dxf(stream.getvalue().encode(), [part.contour])


def test_a_chain_with_a_gap_is_refused() -> None:
    contour = wheel().contour
    lost = Contour(
        dense=lambda: contour.runs[:-1],
        points=contour.points,
        tolerance=TOLERANCE,
        chord_error=0.0,
    )
    part = Part(name="gear1", contours=(lost,), width=8.0)
    with pytest.raises(ValueError, match="do not join"):
        dxf_bytes(wheel_drawing(part), DxfStyle(tolerance=TOLERANCE, curves="splines"))


@pytest.mark.slow
def test_a_pair_of_splines_is_measured_wheel_by_wheel() -> None:
    part = wheel(12)
    drawing = pair_drawing([part, part], 95.0, poses=(Pose(-0.4), Pose(0.3, 95.0)))
    data = dxf_bytes(drawing, DxfStyle(tolerance=TOLERANCE, curves="splines"))
    assert measure_dxf(data, drawing.contours) <= TOLERANCE
    assert measure_dxf(data, drawing.contours[::-1]) > 10


@pytest.mark.parametrize("curves", ["lines", "arcs"])
def test_r12_holds_nothing_that_old_machines_do_not_know(curves: str) -> None:
    part = wheel()
    data = dxf_bytes(
        wheel_drawing(part), DxfStyle(tolerance=TOLERANCE, curves=curves, version="R12")
    )
    pairs = groups(data)
    version = pairs.index((9, "$ACADVER")) + 1
    assert pairs[version] == (1, "AC1009")
    start = pairs.index((2, "ENTITIES"))
    kinds = {value for code, value in pairs[start:] if code == 0}
    assert kinds == {"POLYLINE", "VERTEX", "SEQEND", "CIRCLE", "ENDSEC", "EOF"}
    assert measure_dxf(data, [part.contour]) <= TOLERANCE
    lines = [e for e in read_dxf(data).modelspace().query("POLYLINE") if isinstance(e, Polyline)]
    assert [e.dxf.layer for e in lines] == ["OUTLINE", "BORE"]
    if curves == "lines":
        assert len(lines[0].vertices) == len(part.contour.vertices)


def test_a_keyed_bore_is_one_closed_line_of_exact_arcs() -> None:
    part = wheel()
    for version in ("R2010", "R12"):
        data = dxf_bytes(wheel_drawing(part), DxfStyle(tolerance=TOLERANCE, version=version))
        (loop,) = read_dxf(data).modelspace().query('*[layer=="BORE"]')
        points: Any = loop.points() if version == "R12" else loop.get_points()  # type: ignore[attr-defined]
        assert len(list(points)) == 5
        (hole,) = read_dxf(data).modelspace().query('*[layer=="HOLE"]')
        assert hole.dxf.radius == 3.0
        assert tuple(hole.dxf.center)[:2] == (20.0, 5.0)


def test_turning_moves_loops_and_joints_along() -> None:
    part = wheel()
    loop = part.openings[0].shape
    moved = placed(loop, Pose(math.pi / 2, 1.0 + 2.0j))
    assert isinstance(moved, Loop)
    assert isinstance(loop, Loop)
    assert moved.points == pytest.approx(1.0 + 2.0j + 1j * loop.points, abs=1e-12)
    assert moved.moments.area == pytest.approx(loop.moments.area, rel=1e-12)
    turned = placed(part.contour, Pose(0.3))
    assert isinstance(turned, Contour)
    assert [run.joints for run in turned.runs] == [run.joints for run in part.contour.runs]


def test_a_plain_bore_stays_a_circle() -> None:
    part = Part(name="p", contours=(gear_contour(18, 5.0),), openings=bore(20.0), width=8.0)
    data = dxf_bytes(wheel_drawing(part), DxfStyle(tolerance=TOLERANCE))
    (circle,) = read_dxf(data).modelspace().query("CIRCLE")
    assert circle.dxf.layer == "BORE"
    assert circle.dxf.radius == 10.0
