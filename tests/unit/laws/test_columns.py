"""CSV files are read once, with commas or semicolons, and never with a comma taken for a point."""

from __future__ import annotations

import math
import tracemalloc
from collections.abc import Sequence
from pathlib import Path
from typing import Any

import numpy as np
import pytest

from gearcam import build, load
from gearcam.base.errors import InfeasibleError
from gearcam.base.inches import text_in
from gearcam.base.tolerances import DEFAULT
from gearcam.laws.columns import ColumnsError, FromFile, files_in, read_rows
from gearcam.laws.motion.points import TableRise
from gearcam.laws.motion_table import MotionTable
from gearcam.laws.ratio.base import RatioLaw
from gearcam.laws.ratio.formula import Formula
from gearcam.laws.ratio.span import ONE_LOBE
from gearcam.laws.ratio.table import TableLaw
from gearcam.meshing.settings import ErrorsSpec
from gearcam.results.outline_file import read_closed
from helpers_sampling import few

POINTS = "x,y\n0,0\n0.25,0.125\n0.75,0.875\n1,1\n"


def written(folder: Path, text: str) -> str:
    file = folder / "points.csv"
    file.write_text(text, encoding="utf-8")
    return str(file)


@pytest.mark.parametrize(
    ("text", "note"),
    [
        (POINTS, ""),
        (POINTS.replace(",", ";"), "read with semicolons between columns"),
        (
            POINTS.replace(",", ";").replace(".", ","),
            "read with semicolons and decimal commas",
        ),
        (
            "# measured\nx ; why ; y\n0;a, b;0\n,25;1.2.3;0,125\n0,75;;8,75e-1\n1;;1\n",
            "read with semicolons and decimal commas",
        ),
        (POINTS.replace(",", "\t"), "read with tabs between columns"),
        (POINTS.replace(",", "\t").replace(".", ","), "read with tabs and decimal commas"),
        ("\ufeff" + POINTS.replace(",", ";"), "read with semicolons between columns"),
        (
            "\ufeffsep=;\n" + POINTS.replace(",", ";").replace(".", ","),
            "read with semicolons and decimal commas",
        ),
        ("sep=,\n" + POINTS.replace("x,y", "x,y,a;b"), ""),
        ('x,y,note\n0,0,"a;b"\n0.25,0.125\n0.75,0.875,,\n1,1\n', ""),
    ],
)
def test_separators_that_are_clear_are_read_and_told(tmp_path: Path, text: str, note: str) -> None:
    rows = read_rows(written(tmp_path, text))
    found, lines = rows.columns(("y", "x"))
    expected = [[0.0, 0.0], [0.125, 0.25], [0.875, 0.75], [1.0, 1.0]]
    np.testing.assert_array_equal(found, expected)
    assert rows.note == note
    assert np.diff(lines).tolist() == [1, 1, 1]


@pytest.mark.parametrize(
    ("text", "message"),
    [
        ("x,y\n0,0\n0,5,0,5\n1,1\n", "line 3: 4 values for 2 columns; use a decimal point"),
        ("x,y\n0,0\n0.5,0,5\n1,1\n", "line 3: 3 values for 2 columns; use a decimal point"),
        ('x,y\n0,0\n"0,5",0.5\n1,1\n', "line 3: '0,5' is not a number; use a decimal point"),
        ("x;y\n0;0\n0,5;0.5\n1;1\n", "line 3: '0,5' is not a number; use a decimal point"),
        ("x;y\n0;0\n1.000,5;0\n1;1\n", "line 3: '1.000,5' is not a number"),
        ("x;y,z\n0;0,1\n", "line 1: the columns are x;y, z: none is x or y"),
        ("x y\n0 0\n", "line 1: the columns are x y; commas, semicolons or tabs separate them"),
        ("sep=|\nx|y\n", "line 1: the columns are sep=|; commas, semicolons or tabs separate them"),
        ("x,y\n0,0\n0.5,1_0\n1,1\n", "line 3: '1_0' is not a number"),
        ("x,y\n0,0\n0.5,\u0661\n1,1\n", "line 3: '\u0661' is not a number"),
    ],
)
def test_what_is_not_clear_is_refused(tmp_path: Path, text: str, message: str) -> None:
    with pytest.raises(ColumnsError) as caught:
        read_rows(written(tmp_path, text)).columns(("x", "y"))
    assert str(caught.value) == message


@pytest.mark.parametrize(
    ("head", "factors"),
    [
        ("theta_deg,lift_mm", (1.0, 1.0)),
        ("theta_rad,lift_in", (180.0 / math.pi, 25.4)),
        ("theta_deg,lift_inch", (1.0, 25.4)),
        ("theta_arcmin,lift_um", (1 / 60, 1e-3)),
        ("theta_deg,lift_mil", (1.0, 0.0254)),
        ("theta_deg,lift_ft", (1.0, 304.8)),
        ("theta_deg,lift_m", (1.0, 1e3)),
        ("theta_radians,lift_thou", (180.0 / math.pi, 0.0254)),
    ],
)
def test_a_column_is_in_the_unit_of_its_name(
    tmp_path: Path, head: str, factors: tuple[float, float]
) -> None:
    rows = read_rows(written(tmp_path, f"{head}\n0.5,3.0\n-2.0,0.25\n"))
    found, _ = rows.columns(("theta_deg", "lift_mm"))
    expected = np.array([[0.5, 3.0], [-2.0, 0.25]]) * factors
    np.testing.assert_allclose(found, expected, rtol=1e-15)


@pytest.mark.parametrize("head", ["theta_deg,lift_foo", "theta_deg,lift_deg"])
def test_a_unit_that_is_not_known_is_refused_by_name(tmp_path: Path, head: str) -> None:
    rows = read_rows(written(tmp_path, f"{head}\n0,1\n"))
    name = head.split(",")[1]
    told = rf"the columns are .*{name}: none is lift_mm; names may end in cm, .*\bin, .*\bmm, "
    with pytest.raises(ColumnsError, match=told) as caught:
        rows.columns(("theta_deg", "lift_mm"))
    # these are not keys, and stay
    assert text_in(str(caught.value)) == str(caught.value).replace("lift_mm", "lift_in")


@pytest.mark.parametrize(
    ("head", "words"),
    [
        ("theta_deg,lift (mm)", "write theta_deg,lift_mm"),
        ("theta_deg,lift [in]", "write theta_deg,lift_in"),
        ("Theta_Deg,Lift_MM,Note", "write theta_deg,lift_mm,Note"),
        ("theta (\N{DEGREE SIGN});lift/\N{MICRO SIGN}m", "write theta_deg;lift_um"),
        ("theta deg\tlift mm", "write theta_deg\tlift_mm"),
        ("THETA,LIFT", "write theta_deg,lift_mm, if THETA is in deg and LIFT is in mm"),
        ("theta_deg,lift", "write theta_deg,lift_mm, if lift is in mm"),
    ],
)
def test_names_that_are_misspelt_are_answered_with_the_line_to_write(
    tmp_path: Path, head: str, words: str
) -> None:
    rows = read_rows(written(tmp_path, f"{head}\n0{between(head)}1\n"))
    with pytest.raises(ColumnsError) as caught:
        rows.columns(("theta_deg", "lift_mm"))
    assert str(caught.value) == f"line 1: the columns are {', '.join(rows.cells[0])}; {words}"
    header = words.removeprefix("write ").partition(", if ")[0]
    table = read_rows(written(tmp_path, f"{header}\n0{between(head)}1\n"))
    found, _ = table.columns(("theta_deg", "lift_mm"))
    assert found.shape == (1, 2)


def between(head: str) -> str:
    """What separates the cells of a line of names."""
    return next(one for one in "\t;," if one in head)


@pytest.mark.parametrize(
    ("head", "words"),
    [
        ("theta_deg,lift_in,lift_cm", "lift_in and lift_cm are the same quantity"),
        ("theta_deg,lift_mm,lift_in", "lift_mm and lift_in are the same quantity"),
        ("theta_deg,lift_mm,Lift (in)", r"lift_mm and Lift \(in\) are the same quantity"),
        ("theta_rad,theta_deg,lift_mm", "theta_rad and theta_deg are the same quantity"),
        ("theta_deg,lift_mm,lift_mm", "lift_mm is given 2 times"),
    ],
)
def test_two_columns_of_one_quantity_are_not_chosen_from(
    tmp_path: Path, head: str, words: str
) -> None:
    rows = read_rows(written(tmp_path, f"{head}\n0,1,2.54\n"))
    with pytest.raises(ColumnsError, match=f"line 1: {words}"):
        rows.columns(("theta_deg", "lift_mm"))


def test_two_kinds_of_values_of_a_law_are_not_chosen_from(tmp_path: Path) -> None:
    rows = "".join(f"{60 * k},1,{60 * k}\n" for k in range(7))
    file = written(tmp_path, f"phi1_deg,ratio,phi2_rad\n{rows}")
    ((_, _, told, _),) = TableLaw(file=file).problems()
    assert told == "line 1: ratio and phi2_rad: leave one of them"


def test_a_file_in_utf_16_is_named(tmp_path: Path) -> None:
    file = tmp_path / "points.csv"
    file.write_bytes(POINTS.replace(",", "\t").encode("utf-16"))
    with pytest.raises(ColumnsError, match="it is in UTF-16: save it in UTF-8"):
        read_rows(str(file))


def test_every_reader_of_columns_takes_other_units(tmp_path: Path) -> None:
    """The same numbers, once in inches and radians, once in mm and degrees."""
    theta = np.linspace(0.0, 2.0 * math.pi, 37)
    table = np.column_stack([theta, 0.2 * (1.0 - np.cos(theta)), theta + 0.3 * np.sin(theta)])

    def file(head: str, scales: Sequence[float]) -> str:
        rows = [",".join(map(repr, row)) for row in (table * scales).tolist()]
        return written(tmp_path, "\n".join([head, *rows]))

    def lifts(file: str) -> Any:
        return MotionTable(file=file).program(DEFAULT).derivatives(np.array([1.0, 4.0]), 0)

    def ratios(file: str) -> Any:
        return TableLaw(file=file).points[2]

    def outline(file: str) -> Any:
        return read_closed(file, what="an outline")[0]

    def pitches(file: str) -> Any:
        return ErrorsSpec(file=file).pitch_errors[0][7]

    deg = 180.0 / math.pi
    for read, head, in_mm, scales in (
        (lifts, "theta_rad,lift_in,z", "theta_deg,lift_mm,z", (deg, 25.4, 1.0)),
        (ratios, "phi1_rad,z,phi2_rad", "phi1_deg,z,phi2_deg", (deg, 1.0, deg)),
        (outline, "x_in,z,y_um", "x_mm,z,y_mm", (25.4, 1.0, 1e-3)),
    ):
        values = [read(file(head, (1.0, 1.0, 1.0))), read(file(in_mm, scales))]
        np.testing.assert_allclose(*values, rtol=1e-12)
    assert pitches(written(tmp_path, "wheel,tooth,pitch_um\n1,7,12\n")) == 0.012


RATIOS = "phi1_deg,ratio\n" + "".join(f"{60 * k},1\n" for k in range(7))


def test_a_table_reads_its_file_once(tmp_path: Path) -> None:
    law = TableLaw(file=written(tmp_path, RATIOS))
    rise = TableRise(file=str(tmp_path / "rise.csv"))
    (tmp_path / "rise.csv").write_text(POINTS.replace("0,0\n", "0,1e-10\n"), encoding="utf-8")
    assert not [*law.problems(), *rise.problems()]
    for name in ("points.csv", "rise.csv"):
        (tmp_path / name).unlink()
    assert not [*law.problems(), *rise.problems()]
    assert float(law.build(ONE_LOBE, DEFAULT).phi2(1.0)) == pytest.approx(1.0, abs=1e-15)
    made = rise.build(DEFAULT)
    assert float(made.function(0.25)) == pytest.approx(0.125, abs=1e-15)
    assert float(made.function(0.0)) == 0.0
    assert rise.points[0][0].tolist() == [0.0, 1e-10]


@pytest.mark.parametrize("note", ["", "read with semicolons and decimal commas"])
def test_how_a_file_was_read_is_told_with_the_facts(tmp_path: Path, note: str) -> None:
    table, design = (
        Path(f"profiles/measured.{ending}").read_text(encoding="utf-8")
        for ending in ("csv", "toml")
    )
    table = table.replace(",", ";").replace(".", ",") if note else table
    (tmp_path / "measured.csv").write_text(table, encoding="utf-8")
    (tmp_path / "measured.toml").write_text(design, encoding="utf-8")
    facts = build(load(tmp_path / "measured.toml")).facts
    told = [one.value for one in facts.shown() if one.meaning == "measured.csv"]
    assert told == [note] * bool(note)


def test_rows_are_found_wherever_their_parameters_stand(tmp_path: Path) -> None:
    law = TableLaw(file=written(tmp_path, RATIOS))
    (rows,) = files_in((1, "a", (law, TableLaw(phi1=(0.0,), ratio=(1.0,)))))
    assert rows is law.rows
    assert rows.cells[0] == ["phi1_deg", "ratio"]
    assert rows.file == law.file
    assert isinstance(law, FromFile)
    assert TableLaw(phi1=(0.0,), ratio=(1.0,)).rows is None


@pytest.mark.parametrize("count", few([100_000, 1_000_000]))
def test_many_rows_are_refused_before_they_are_taken_apart(count: int, tmp_path: Path) -> None:
    """Its lines take 38 times the memory of the text, lists of their cells 55 times more."""
    text = "phi1_deg,ratio\n" + "1,2\n" * count
    many = written(tmp_path, text)
    tracemalloc.start()
    try:
        with pytest.raises(ColumnsError, match=f"has {count} rows; up to 20000 are read"):
            read_rows(many)
        peak = tracemalloc.get_traced_memory()[1]
    finally:
        tracemalloc.stop()
    assert peak < 45 * len(text)


ANGLES = tuple(math.radians(30.0 * k) for k in range(13))
WAVE = tuple(1.0 + 0.2 * math.cos(angle) for angle in ANGLES)


@pytest.mark.parametrize(
    ("phi1", "message"),
    [
        ({4: 60.0}, "60 deg follows 90 deg"),
        ({4: 90.0}, "90 deg is given twice"),
        ({4: 90.0003}, "90.0003 deg follows 90 deg"),
        ({4: 90.0004}, ""),
    ],
)
def test_angles_of_a_ratio_rise_by_a_second_of_arc(
    tmp_path: Path, phi1: dict[int, float], message: str
) -> None:
    angles = [math.radians(phi1.get(k, 30.0 * k)) for k in range(13)]
    told = [one[:3] for one in TableLaw(phi1=tuple(angles), ratio=WAVE).problems()]
    assert told == ([("phi1", 4, message)] if message else [])
    lines = (
        f"{math.degrees(angle)!r},{value!r}\n" for angle, value in zip(angles, WAVE, strict=True)
    )
    file = written(tmp_path, "phi1_deg,ratio\n" + "".join(lines))
    said = [one[2] for one in TableLaw(file=file).problems()]
    assert [message in one for one in said] == [True] * bool(message)


def ratio_values(name: str, angles: np.ndarray) -> np.ndarray:
    wave = np.cos(angles)
    return {"ratio": 1.0 + 0.2 * wave, "r1": 1.0 + 0.1 * wave}.get(
        name, angles + 0.2 * np.sin(angles)
    )


@pytest.mark.parametrize("name", ["ratio", "r1", "phi2"])
@pytest.mark.parametrize("first", [30.0, 10.0, -90.0, 360.0])
def test_a_table_of_a_closed_pair_may_begin_at_any_angle(name: str, first: float) -> None:
    """The law is that of the same table from the first angle on, turned by it."""
    steps = np.radians(np.arange(0.0, 361.0, 5.0))
    values = ratio_values(name, steps + math.radians(first))

    def law(start: float) -> RatioLaw:
        given: dict[str, Any] = {"phi1": tuple(steps + start), name: tuple(values)}
        return TableLaw(**given).build(ONE_LOBE, DEFAULT)

    one, turned = law(0.0), law(math.radians(first))
    places = np.linspace(0.0, 2.0 * math.pi, 50)
    back = places - math.radians(first)
    np.testing.assert_allclose(
        turned.derivatives(places, 2)[1:], one.derivatives(back, 2)[1:], atol=1e-10
    )
    assert float(turned.phi2(0.0)) == pytest.approx(0.0, abs=1e-12)


def test_a_table_of_an_open_pair_says_what_to_subtract() -> None:
    steps = np.radians(np.arange(10.0, 111.0, 5.0))
    law = TableLaw(phi1=tuple(steps), ratio=tuple(1.0 + 0.1 * steps), driven_travel=1.0)
    with pytest.raises(InfeasibleError, match="subtract 10 deg from all its angles"):
        law.build(ONE_LOBE, DEFAULT)


@pytest.mark.parametrize("last", ["6.2831853", "6.2832", "6.28318"])
@pytest.mark.parametrize("name", ["ratio", "phi2_rad"])
def test_a_turn_of_a_law_in_radians_may_be_rounded(tmp_path: Path, name: str, last: str) -> None:
    steps = np.linspace(0.0, 2.0 * math.pi, 73)
    values = ratio_values(name, steps).tolist()
    rows = [f"{a!r},{b!r}\n" for a, b in zip(steps.tolist(), values, strict=True)]
    end = last if name == "phi2_rad" else repr(values[-1])
    file = written(tmp_path, "".join([f"phi1_rad,{name}\n", *rows[:-1], f"{last},{end}\n"]))
    law = TableLaw(file=file).build(ONE_LOBE, DEFAULT)
    given: dict[str, Any] = {"phi1": tuple(steps), name.removesuffix("_rad"): tuple(values)}
    exact = TableLaw(**given)
    places = np.linspace(0.0, 2.0 * math.pi, 50)
    found, right = law.phi2(places), exact.build(ONE_LOBE, DEFAULT).phi2(places)
    np.testing.assert_allclose(found, right, atol=2e-5 if name == "phi2_rad" else 1e-11)


def test_a_table_that_ends_beside_its_lobe_is_refused(tmp_path: Path) -> None:
    rows = "".join(f"{10 * k},1\n" for k in range(1, 37))
    with pytest.raises(InfeasibleError, match="value 360 deg, limit 370 deg"):
        TableLaw(file=written(tmp_path, f"phi1_deg,ratio\n{rows}")).build(ONE_LOBE, DEFAULT)
    short = rows.replace("360,1\n", "369.99,1\n")
    with pytest.raises(InfeasibleError, match=r"value 369\.99 deg, limit 370 deg"):
        TableLaw(file=written(tmp_path, f"phi1_deg,ratio\n{short}")).build(ONE_LOBE, DEFAULT)


@pytest.mark.parametrize("name", ["ratio", "r1"])
@pytest.mark.parametrize("scale", [1e-320, 1e-101, 1e-99, 1e99, 1e101, 1e307])
@pytest.mark.filterwarnings("error")
def test_ratios_and_radii_at_any_scale_that_has_a_square(name: str, scale: float) -> None:
    """Beyond it they are refused; within it the law is that of scale 1."""
    values = tuple(scale * value for value in WAVE)
    given: list[Any] = [{name: values, "phi1": ANGLES}, {name: f"{scale!r}*(1 + 0.2*cos(phi1))"}]
    for law, plain in zip(given, (TableLaw, Formula), strict=True):
        if not 1e-100 < scale < 1e100:
            size = "small" if scale < 1.0 else "large"
            with pytest.raises(InfeasibleError, match=f"{name} is too {size} for computing"):
                plain(**law).build(ONE_LOBE, DEFAULT)
            continue
        one: dict[str, Any] = (
            {name: WAVE, "phi1": ANGLES} if "phi1" in law else {name: "1 + 0.2*cos(phi1)"}
        )
        found, right = (plain(**each).build(ONE_LOBE, DEFAULT) for each in (law, one))
        places = np.linspace(0.0, 6.0, 31)
        np.testing.assert_allclose(found.phi2(places), right.phi2(places), atol=1e-12)
