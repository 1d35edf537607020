"""STEP files hold each piece of an outline as one face, in mm, with the volume of the part.

They are read twice: by the kernel's own reader, which measures, and as text, by a reader of a few
lines that knows nothing of the kernel.
"""

from __future__ import annotations

import math
import re
import sys
from collections import Counter
from collections.abc import Sequence
from contextlib import nullcontext
from dataclasses import replace
from pathlib import Path

import numpy as np
import pytest

from gearcam.base.errors import GearcamError, MissingExtraError
from gearcam.export import step, step_shapes
from gearcam.export.step import step_bytes
from gearcam.numeric.arrays import as_pairs
from gearcam.numeric.contour import Run
from gearcam.numeric.pose import UNMOVED, Pose
from gearcam.numeric.splines import Spline, fit_splines
from gearcam.parts.body import Hub, Mark, Opening, Part
from gearcam.parts.shapes import Circle
from gearcam.parts.solids import SolidError
from helpers_contour import bore, disc_contour, gear_contour, square_contour
from helpers_step import (
    KEYED,
    StepSolid,
    corners,
    entities,
    floor_radius,
    keyed_area,
    keyed_bore,
    one_run,
    pieces,
    plate,
    read_step,
    spline_area,
)

TOLERANCE = 1e-5


def written(part: Part, tolerance: float = TOLERANCE) -> bytes:
    return step_bytes([(part, UNMOVED)], part.name, tolerance)


def read(part: Part, tolerance: float = TOLERANCE) -> StepSolid:
    (solid,) = read_step(written(part, tolerance))
    return solid


@pytest.fixture(scope="module")
def gear() -> Part:
    keyed = Opening(kind="BORE", shape=keyed_bore(), name="bore")
    return plate(gear_contour(36, 5.0), 20.0, openings=(keyed,))


@pytest.fixture(scope="module")
def gear_file(gear: Part) -> bytes:
    return written(gear)


@pytest.fixture(scope="module")
def gear_solid(gear_file: bytes) -> StepSolid:
    (solid,) = read_step(gear_file)
    return solid


def test_each_piece_of_an_outline_is_one_face(
    gear: Part, gear_file: bytes, gear_solid: StepSolid
) -> None:
    curved, straight = pieces(gear.contour)
    assert (curved, straight) == (144, 72)
    assert gear_solid.faces == {"bspline": curved, "cylinder": 4, "plane": straight + 2 + 2}
    found = entities(gear_file)
    assert len(found["ADVANCED_FACE"]) == 216 + 6 + 2
    radii = sorted(float(each.rpartition(",")[2]) for each in found["CYLINDRICAL_SURFACE"])
    assert radii == pytest.approx([floor_radius(), *3 * [KEYED[0]]], rel=1e-12)
    assert len(found["B_SPLINE_SURFACE_WITH_KNOTS"]) == 144
    assert len(found["CLOSED_SHELL"]) == len(found["MANIFOLD_SOLID_BREP"]) == 1


def test_runs_are_cut_at_their_joints() -> None:
    disc = disc_contour(40.0)
    assert read(plate(disc)).faces == {"bspline": 3, "plane": 2}
    assert read(plate(one_run(disc))).faces == {"bspline": 3, "plane": 2}
    # the control: what is no joint is not cut, and one closed piece is one closed face
    assert read(plate(one_run(disc, joints=False))).faces == {"bspline": 1, "plane": 2}
    # nor is a piece without length a face
    doubled = one_run(disc, doubled=True)
    assert [len(piece.points) for piece in doubled.runs[0].pieces][1] == 2
    assert read(plate(doubled)).faces == {"bspline": 3, "plane": 2}


def test_a_piece_that_is_left_out_is_missed() -> None:
    contour = gear_contour(12, 5.0)
    first, second, *others = contour.runs
    joined = Run(
        points=np.concatenate([first.points[:-1], second.points]),
        tangents=np.concatenate([first.tangents[:-1], second.tangents]),
    )
    fewer = plate(replace(contour, dense=lambda: (joined, *others)))
    curved, straight = pieces(contour)
    assert sum(read(fewer, 1e-3).faces.values()) == curved + straight + 2 - 1


def test_faces_stay_whole_with_hub_marks_and_openings() -> None:
    """The bore goes through plate and hubs as one face; the tools touch no flank."""
    contour = gear_contour(12, 5.0)
    part = plate(
        contour,
        openings=bore(8.0),
        hub=Hub(diameter=20.0, front=3.0, back=2.0),
        marks=(Mark(center=complex(15.0, 0.0), diameter=2.0, depth=0.5),),
    )
    curved, straight = pieces(contour)
    # cylinders: bore, two hubs, mark; planes: two of the plate, two of the hubs, the mark's floor
    assert read(part).faces == {"bspline": curved, "cylinder": 4, "plane": straight + 5}


def test_the_volume_is_the_parts(gear: Part, gear_solid: StepSolid) -> None:
    assert gear_solid.volume == pytest.approx(gear.volume, rel=1e-6)
    # what is left of the difference is the fit's: through the file nothing is lost
    exact = gear.width * (spline_area(gear.contour, TOLERANCE) - keyed_area())
    assert gear_solid.volume == pytest.approx(exact, rel=1e-11)
    assert exact != pytest.approx(gear.volume, rel=1e-8)
    # the control: a coarse fit is seen
    small = plate(gear_contour(12, 5.0))
    assert read(small, 1e-2).volume != pytest.approx(small.volume, rel=1e-6)


def test_planes_and_cylinders_are_exact() -> None:
    solid = read(plate(square_contour(40.0), openings=bore(20.0)))
    assert solid.volume == pytest.approx(6.0 * (1600.0 - 100.0 * math.pi), rel=1e-12)
    assert solid.faces == {"cylinder": 1, "plane": 6}


def test_a_disc_is_within_its_tolerance() -> None:
    volume = read(plate(disc_contour(40.0))).volume
    assert volume == pytest.approx(9600.0 * math.pi, abs=6.0 * 80.0 * math.pi * TOLERANCE)
    assert volume != pytest.approx(9600.0 * math.pi, rel=1e-9)


def test_hub_keyway_holes_and_mark_are_exact() -> None:
    keyed = Opening(kind="BORE", shape=keyed_bore(), name="bore")
    hole = Opening(
        kind="HOLE", shape=Circle(center=complex(-17.0, 15.0), diameter=3.0), name="hole"
    )
    mark = Mark(center=complex(16.0, 15.0), diameter=4.0, depth=0.5)
    hub = Hub(diameter=30.0, front=4.0, back=3.0)
    part = plate(square_contour(40.0), openings=(keyed, hole), hub=hub, marks=(mark,))
    disc = math.pi * 15.0**2 - keyed_area()
    flat = 1600.0 - keyed_area() - math.pi * 1.5**2
    exact = 6.0 * flat + 7.0 * disc - 0.5 * math.pi * 2.0**2
    solid = read(part)
    assert solid.volume == pytest.approx(exact, rel=1e-12)
    assert part.volume == pytest.approx(exact, rel=1e-12)
    # bore 3, keyway, hole, two hubs, mark; square 4, plate 2, keyway 2, hubs 2, mark
    assert solid.faces == {"cylinder": 8, "plane": 11}
    assert solid.bounds[:, 2] == pytest.approx([-3.0, 10.0], abs=1e-6)
    # the control: each of them is in the volume
    for less in ({"marks": ()}, {"hub": None}, {"openings": (keyed,)}, {"openings": (hole,)}):
        assert read(replace(part, **less)).volume != pytest.approx(exact, rel=1e-5)


def test_the_mark_is_in_the_upper_face() -> None:
    bare = plate(square_contour(40.0))
    marked = replace(bare, marks=(Mark(center=complex(10.0, 0.0), diameter=4.0, depth=1.0),))
    lost = math.pi * 4.0
    # the centre of mass moves away from what was taken at x = 10 and z = 5.5
    moved = read(marked).center - [0.0, 0.0, 3.0]
    assert moved == pytest.approx(np.array([-10.0, 0.0, -2.5]) * lost / (9600.0 - lost), abs=1e-9)


def test_steps_are_solids_of_one_product() -> None:
    low, high = gear_contour(12, 5.0), gear_contour(12, 5.0, angle=0.3)
    part = Part(
        name="gear2",
        contours=(low, high),
        width=10.0,
        openings=bore(8.0),
        hub=Hub(diameter=20.0, front=3.0, back=2.0),
        marks=(Mark(center=complex(14.0, 0.0), diameter=2.0, depth=0.5),),
    )
    data = written(part)
    below, above = read_step(data)
    assert below.name == above.name == "gear2"
    assert len(entities(data)["PRODUCT"]) == 1
    assert [below.bounds[0, 2], below.bounds[1, 2]] == pytest.approx([-2.0, 5.0], abs=1e-6)
    assert [above.bounds[0, 2], above.bounds[1, 2]] == pytest.approx([5.0, 13.0], abs=1e-6)
    ring, mark = math.pi * (10.0**2 - 4.0**2), 0.5 * math.pi
    for solid, contour, hub, lost in ((below, low, 2.0, 0.0), (above, high, 3.0, mark)):
        exact = 5.0 * (contour.moments.area - 16.0 * math.pi) + hub * ring - lost
        assert solid.volume == pytest.approx(exact, rel=1e-6)
        curved, straight = pieces(contour)
        more = 1 if lost else 0
        assert solid.faces == {
            "bspline": curved,
            "cylinder": 2 + more,
            "plane": straight + 3 + more,
        }


def test_the_file_says_millimetres(gear: Part, gear_file: bytes, gear_solid: StepSolid) -> None:
    dense = as_pairs(np.concatenate([run.points for run in gear.contour.runs]))
    low, high = dense.min(axis=0), dense.max(axis=0)
    assert gear_solid.bounds[0] == pytest.approx([*low, 0.0], abs=1e-4)
    assert gear_solid.bounds[1] == pytest.approx([*high, 20.0], abs=1e-4)
    units = re.findall(rb"LENGTH_UNIT\(\)\s*NAMED_UNIT\(\*\)\s*SI_UNIT\((.*?)\)", gear_file)
    assert units == [b".MILLI.,.METRE."]
    head = re.sub(rb"\n *", b"", gear_file[:1000])
    assert b"FILE_NAME('gear1.step','1970-01-01T00:00:00'," in head
    assert b"FILE_SCHEMA(('AUTOMOTIVE_DESIGN" in head
    # the control: the reader heeds the unit
    metres = gear_file.replace(b"SI_UNIT(.MILLI.,.METRE.)", b"SI_UNIT($,.METRE.)")
    assert read_step(metres)[0].bounds == pytest.approx(1000.0 * gear_solid.bounds, abs=0.1)


def test_corners_stand_where_the_outline_has_them(gear: Part, gear_file: bytes) -> None:
    ends = as_pairs(np.array([run.points[0] for run in gear.contour.runs]))
    found = corners(gear_file)
    for z in (0.0, 20.0):
        flat = found[np.abs(found[:, 2] - z) < 1e-12][:, :2]
        near = np.hypot(*(flat[:, None] - ends[None]).transpose(2, 0, 1)).min(axis=0)
        assert near.max() < 1e-10
    assert len(np.unique(found.round(9), axis=0)) == 2 * (216 + 6)


def test_an_assembly_puts_parts_where_they_belong() -> None:
    hole = Opening(kind="HOLE", shape=Circle(center=complex(12.0, 5.0), diameter=6.0), name="hole")
    one, two = plate(disc_contour(20.0)), plate(square_contour(40.0), openings=(hole,))
    two = replace(two, name="gear2")
    angle, offset = 0.7, (80.0, -3.0)
    data = step_bytes([(one, UNMOVED), (two, Pose(angle, complex(*offset)))], "pair", TOLERANCE)
    still, turned = read_step(data)
    assert (still.name, turned.name) == ("gear1", "gear2")
    products = [each.split(",")[0] for each in entities(data)["PRODUCT"]]
    assert Counter(products) == Counter(["'pair'", "'gear1'", "'gear2'"])
    assert still.bounds == pytest.approx(read(one).bounds, abs=1e-9)
    first = two.contour.moments.first - hole.shape.moments.first
    area = two.contour.moments.area - hole.shape.moments.area
    place = first / area * complex(math.cos(angle), math.sin(angle)) + complex(*offset)
    assert turned.center == pytest.approx([place.real, place.imag, 3.0], abs=1e-9)
    half = 20.0 * (math.cos(angle) + math.sin(angle))
    box = np.array([[-half, -half, -3.0], [half, half, 3.0]])
    assert turned.bounds - [*offset, 3.0] == pytest.approx(box, abs=1e-6)
    assert turned.volume == pytest.approx(two.volume, rel=1e-12)
    # one part for itself is moved just so, without an assembly
    alone = step_bytes([(two, Pose(angle, complex(*offset)))], "gear2", TOLERANCE)
    assert "NEXT_ASSEMBLY_USAGE_OCCURRENCE" not in entities(alone)
    assert read_step(alone)[0].center == pytest.approx(turned.center, abs=1e-10)
    # the control: turned the other way it is elsewhere
    wrong = step_bytes([(two, Pose(-angle, complex(*offset)))], "gear2", TOLERANCE)
    assert read_step(wrong)[0].center != pytest.approx(turned.center, abs=0.1)


def test_a_part_that_comes_twice_is_one_product() -> None:
    part = plate(square_contour(40.0))
    data = step_bytes([(part, UNMOVED), (part, Pose(shift=50.0))], "row", 1e-5)
    assert len(entities(data)["MANIFOLD_SOLID_BREP"]) == 1
    assert len(entities(data)["PRODUCT"]) == 2
    assert [solid.center[0] for solid in read_step(data)] == pytest.approx([0.0, 50.0], abs=1e-9)


@pytest.mark.parametrize(
    "name", ["it's \\ all", "Zahnrad größer's", "Ω\N{GEAR}\N{GRINNING FACE}", "é" * 100, "a\nb"]
)
def test_names_of_every_kind(name: str) -> None:
    part = replace(plate(square_contour(40.0)), name=name)
    other = replace(part, name=f"{name}2")
    data = step_bytes([(part, UNMOVED), (other, UNMOVED)], name, TOLERANCE)
    assert (rb"\X4\000003A9" in data) is (name[0] == "Ω")
    assert [solid.name for solid in read_step(data)] == [name, f"{name}2"]
    assert b"gearcam-" not in data
    assert (rb"FILE_NAME('Zahnrad gr\X2\00F600DF\X0\er''s.step'," in data) is (name[-1] == "s")


def test_the_same_parts_give_the_same_bytes() -> None:
    steps = Part(
        name="gear2",
        contours=(square_contour(40.0), disc_contour(18.0)),
        width=6.0,
        openings=bore(8.0),
        hub=Hub(diameter=12.0, front=2.0),
    )
    assert written(steps) == written(steps)
    square = plate(square_contour(30.0))
    items = [(square, UNMOVED), (square, Pose(shift=50.0))]
    first = step_bytes(items, "pair", TOLERANCE)
    # the kernel counts assemblies through the process: past nine a number gets longer
    assert all(step_bytes(items, "pair", TOLERANCE) == first for _ in range(50))
    uses = entities(first)["NEXT_ASSEMBLY_USAGE_OCCURRENCE"]
    assert [use.split(",")[0] for use in uses] == ["'1'", "'2'"]
    # the control: what changes is seen
    assert step_bytes([items[0], (square, Pose(1e-6, 50.0))], "pair", TOLERANCE) != first


def test_without_numbering_the_bytes_would_change(monkeypatch: pytest.MonkeyPatch) -> None:
    monkeypatch.setattr(step, "_USE", re.compile("nothing of the kind"))
    part = plate(square_contour(40.0))
    items = [(part, UNMOVED), (part, Pose(shift=50.0))]
    assert step_bytes(items, "pair", TOLERANCE) != step_bytes(items, "pair", TOLERANCE)


def test_settings_left_by_others_do_not_matter() -> None:
    part = plate(square_contour(40.0))
    first = written(part)
    assert step_shapes.occt.Interface_Static.SetCVal_s("write.step.unit", "INCH")
    assert step_shapes.occt.Interface_Static.SetCVal_s("xstep.cascade.unit", "M")
    assert written(part) == first
    assert step_shapes.occt.Interface_Static.SetCVal_s("xstep.cascade.unit", "M")
    assert read_step(first)[0].volume == pytest.approx(9600.0, rel=1e-12)


def test_nothing_is_printed_and_nothing_is_left(
    capfd: pytest.CaptureFixture[str], monkeypatch: pytest.MonkeyPatch, tmp_path: Path
) -> None:
    monkeypatch.chdir(tmp_path)
    for variable in ("TMPDIR", "TMP", "TEMP"):
        monkeypatch.setenv(variable, str(tmp_path))
    part = plate(gear_contour(12, 5.0), openings=bore(8.0))
    read_step(step_bytes([(part, UNMOVED), (part, UNMOVED)], "pair", TOLERANCE))
    for broken in (b"", b"no STEP", written(part)[:5000]):
        with pytest.raises(ValueError, match="no STEP file"):
            read_step(broken)
    assert capfd.readouterr() == ("", "")
    assert list(tmp_path.iterdir()) == []
    # the control: the kernel does speak where it may
    monkeypatch.setattr(step, "_silent", nullcontext)
    written(part)
    assert capfd.readouterr() != ("", "")


def test_a_missing_library_is_named_and_no_parts_are_refused(
    monkeypatch: pytest.MonkeyPatch,
) -> None:
    monkeypatch.setitem(sys.modules, "OCP", None)
    message = r'^STEP files need a library that is not installed: pip install "gearcam\[step\]"$'
    with pytest.raises(MissingExtraError, match=message) as caught:
        written(plate(square_contour(40.0)))
    assert isinstance(caught.value, GearcamError)
    assert isinstance(caught.value, ImportError)
    monkeypatch.undo()
    with pytest.raises(ValueError, match="needs at least one part"):
        step_bytes([], "nothing", TOLERANCE)


def moved_pole(amount: float, monkeypatch: pytest.MonkeyPatch) -> None:
    """Let the first fit have a pole beside its place."""
    left = [amount]

    def fit(runs: Sequence[Run], tolerance: float) -> list[Spline]:
        made = fit_splines(runs, tolerance)
        poles = made[0].poles.copy()
        poles[len(poles) // 2] += left.pop() * made[0].poles[0] / 20.0 if left else 0.0
        return [Spline(poles=poles, breaks=made[0].breaks), *made[1:]]

    monkeypatch.setattr(step_shapes, "fit_splines", fit)


def test_a_moved_pole_is_found(monkeypatch: pytest.MonkeyPatch) -> None:
    part = plate(disc_contour(20.0))
    moved_pole(0.1, monkeypatch)
    with pytest.raises(SolidError, match="gear1: the solid's volume is"):
        written(part)
    # the control: it is the move that is found, not the fit that was replaced
    moved_pole(0.0, monkeypatch)
    assert read(part).volume == pytest.approx(part.volume, rel=1e-6)


def test_an_outline_that_a_hole_crosses_is_invalid() -> None:
    circle = Circle(center=complex(20.0, 0.0), diameter=6.0)
    across = Opening(kind="HOLE", shape=circle, name="hole")
    with pytest.raises(SolidError, match="gear1: the solid is invalid"):
        written(plate(square_contour(40.0), openings=(across,)))


@pytest.mark.parametrize(("diameter", "count"), [(50.0, 4), (60.0, 0)])
def test_a_solid_in_pieces_or_none_is_refused(diameter: float, count: int) -> None:
    mark = Mark(center=0j, diameter=diameter, depth=7.0)
    with pytest.raises(SolidError, match=f"gear1: the solid consists of {count} pieces"):
        written(plate(square_contour(40.0), marks=(mark,)))


def test_errors_of_the_kernel_become_ours_and_others_stay(monkeypatch: pytest.MonkeyPatch) -> None:
    monkeypatch.setattr(step_shapes, "_line", lambda *_: step_shapes.occt.gp_Dir(0.0, 0.0, 0.0))
    with pytest.raises(SolidError, match="gear1: the solid could not be made"):
        written(plate(square_contour(40.0)))
    monkeypatch.setattr(step_shapes, "_line", lambda *_: 1 / 0)
    with pytest.raises(ZeroDivisionError):
        written(plate(square_contour(40.0)))
