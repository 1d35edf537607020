"""What is wrong with the parameters of a rise is said with what is allowed."""

from __future__ import annotations

from pathlib import Path
from typing import Any

import pytest

from claims.motion import MOTION_CLAIMS
from gearcam.base.errors import InfeasibleError
from gearcam.base.tolerances import DEFAULT
from gearcam.designs.table import table_of
from gearcam.designs.validate import faults_of, rule_faults
from gearcam.laws.columns import ColumnsError, read_rows
from gearcam.laws.motion import MOTION_LAWS
from gearcam.laws.motion.formula import FormulaRise
from gearcam.laws.motion.points import BSplineRise, TableRise
from gearcam.laws.motion.polynomials import Polynomial
from gearcam.laws.motion.scca import Scca

EVEN = (0.0, 0.25, 0.5, 0.75, 1.0)


def told(parameters: Any) -> list[tuple[str, int | None, str, str]]:
    return list(parameters.problems())


def only(parameters: Any) -> tuple[str, int | None, str, str]:
    found = told(parameters)
    assert len(found) == 1, found
    return found[0]


@pytest.mark.parametrize(
    ("law", "key", "value", "allowed"),
    [
        ("constant-acceleration", "q", 0.0, "a number from 0.0001 to 0.9999"),
        ("constant-acceleration", "q", 1.0, "a number from 0.0001 to 0.9999"),
        ("trapezoidal-velocity", "q", 0.51, "a number from 0.0001 to 0.5"),
        ("sine-trapezoidal-velocity", "q", -0.1, "a number from 0.0001 to 0.5"),
        ("trapezoidal-acceleration", "q", 0.26, "a number from 0.0001 to 0.25"),
        ("b-spline", "degree", 6, "a whole number from 3 to 5"),
        ("scca", "b", 1.1, "a number from 0 to 1"),
    ],
)
def test_numbers_out_of_range_are_told(law: str, key: str, value: float, allowed: str) -> None:
    known = table_of("motion", MOTION_LAWS[law].parameters)
    faults = [f for f in faults_of(known, {key: value}, home=lambda *_: "") if f.path[-1] == key]
    assert [fault.message for fault in faults] == [f"{value} is out of range"]
    assert faults[0].allowed == allowed


def test_every_rise_can_be_read_from_a_file() -> None:
    for entry in MOTION_LAWS.values():
        known = table_of("motion", entry.parameters)
        for claim in MOTION_CLAIMS[entry.name].values:
            written = known.outward(vars(claim.parameters))
            assert list(faults_of(known, written, home=lambda *_: "")) == []
            again = entry.parameters(**known.inward(written))
            assert again == claim.parameters
            assert told(again) == [] if hasattr(again, "problems") else True


def test_sectors_must_fill_the_angle() -> None:
    field, _, message, rule = only(Scca(b=0.25, c=0.5, d=0.3))
    assert (field, message) == ("d", "b + c + d is 1.05")
    assert rule == "b + c + d = 1; with this b and c, d is 0.25"
    assert only(Scca(b=0.8, c=0.5, d=0.0))[3] == "b + c + d = 1"
    assert told(Scca(b=1 / 3, c=1 / 3, d=1 / 3)) == []
    field, _, message, rule = only(Scca(b=1e-7, c=0.5, d=0.5 - 1e-7))
    assert (field, message, rule) == ("b", "this sector is too narrow", "0, or at least 0.0001")


def test_polynomials_have_an_end() -> None:
    assert told(Polynomial(start=(0.0,) * 8, end=(0.0,) * 8)) == []
    field, _, message, rule = only(Polynomial(start=(0.0,) * 9, end=()))
    assert (field, message) == ("start", "9 derivatives are given")
    assert rule == "at most 8 at an end"


def test_control_values_run_from_corner_to_corner() -> None:
    field, index, message, rule = only(BSplineRise(control=(0.1, 0.0, 0.0, 1.0, 1.0)))
    assert (field, index, rule) == ("control", 0, "0")
    assert message == "the first control value is not 0"
    assert only(BSplineRise(control=(0.0, 0.0, 0.0, 1.0, 0.9)))[1:3] == (
        4,
        "the last control value is not 1",
    )
    assert only(BSplineRise(control=EVEN, degree=5))[2:] == (
        "5 control values are given",
        "6 to 500 control values for degree 5",
    )


@pytest.mark.parametrize(
    ("table", "field", "index", "message"),
    [
        (TableRise(x=EVEN, y=EVEN[1:]), "y", None, "4 values, but x has 5"),
        (TableRise(x=(0.0, 1.0), y=(0.0, 1.0)), "x", None, "has 2 points"),
        (TableRise(x=(0.1, 0.5, 1.0), y=(0.0, 0.5, 1.0)), "x", 0, "the first x is 0.1, not 0"),
        (TableRise(x=(0.0, 0.5, 0.9), y=(0.0, 0.5, 1.0)), "x", 2, "the last x is 0.9, not 1"),
        (TableRise(x=(0.0, 0.5, 1.0), y=(0.2, 0.5, 1.0)), "y", 0, "the first y is 0.2, not 0"),
        (TableRise(x=(0.0, 0.5, 1.0), y=(0.0, 0.5, 2.0)), "y", 2, "the last y is 2, not 1"),
        (TableRise(x=(0.0, 0.5, 0.5, 1.0), y=(0.0, 0.5, 0.6, 1.0)), "x", 2, "x does not rise"),
        (TableRise(x=(0.0, 0.5, 0.5000001, 1.0), y=EVEN[1:]), "y", 0, "the first y is 0.25, not 0"),
    ],
)
def test_points_that_make_no_rise_are_told(
    table: TableRise, field: str, index: int | None, message: str
) -> None:
    assert told(table)[0][:3] == (field, index, message)
    where = f"motion.{field}" + ("" if index is None else f"[{index}]")
    with pytest.raises(InfeasibleError) as caught:
        table.build(DEFAULT)
    assert str(caught.value).startswith(f"{message} ({where})")


@pytest.mark.parametrize(
    ("given", "key", "message"),
    [
        ({"x": EVEN, "y": EVEN, "file": "a.csv"}, "x", "is given beside file"),
        ({}, "", "neither file nor x is given"),
        ({"x": EVEN}, "", "neither file nor y is given"),
        ({"y": EVEN}, "", "neither file nor x is given"),
    ],
)
def test_points_are_given_once(given: dict[str, Any], key: str, message: str) -> None:
    fault, *_ = rule_faults(table_of("motion", TableRise), given, [], ("motion", 0))
    assert "".join(map(str, fault.path[2:])) == key
    assert message in fault.message


def test_typed_digits_of_the_corners_are_overlooked() -> None:
    rise = TableRise(x=(0.0, 0.5, 1.0 - 1e-10), y=(1e-10, 0.4, 1.0)).build(DEFAULT)
    assert float(rise.function(0.0)) == 0.0
    assert rise.function.knots[-1] == 1.0


@pytest.mark.parametrize(
    ("text", "message"),
    [
        ("", "is empty"),
        ("a,b\n0,0\n", "line 1: the columns are a, b: none is x or y"),
        ("x,y,x\n0,0,0\n", "line 1: x is given 2 times"),
        ("x,y\n0,0\n0.5,abc\n1,1\n", "line 3: 'abc' is not a number"),
        ("x,y\n0,0\n0.5\n1,1\n", "line 3: '' is not a number"),
        ("x,y\n0,0\n# why\n0.5,inf\n1,1\n", "line 4: 'inf' is not finite"),
        ("x,y\n", "has 0 points"),
        ("x,y\n0,0\n\n0.5,0.5\n0.4,0.6\n1,1\n", "line 5: x does not rise"),
        ("x,y\n0,0\n0.5,0.5\n2,1\n", "line 4: the last x is 2, not 1"),
    ],
)
def test_files_that_hold_no_rise_are_told(tmp_path: Path, text: str, message: str) -> None:
    file = tmp_path / "points.csv"
    file.write_text(text)
    field, index, found, _ = told(TableRise(file=str(file)))[0]
    assert (field, index, found) == ("file", None, message)
    with pytest.raises(InfeasibleError, match=r"motion\.file"):
        TableRise(file=str(file)).build(DEFAULT)


def test_files_that_cannot_be_read_are_told(tmp_path: Path) -> None:
    with pytest.raises(ColumnsError, match="cannot be read: there is no such file"):
        read_rows(str(tmp_path / "none.csv"))
    (tmp_path / "picture.csv").write_bytes(b"\xff\xd8\x00\x81")
    with pytest.raises(ColumnsError, match="not a text file in UTF-8"):
        read_rows(str(tmp_path / "picture.csv"))


def test_a_formula_that_cannot_be_read_is_told() -> None:
    field, _, message, allowed = only(FormulaRise(formula="x**2*phi"))
    assert field == "formula"
    assert message == "column 6: unknown name 'phi' (did you mean x?)"
    assert allowed.startswith("x, pi, numbers")
    assert told(FormulaRise(formula="x**2")) == []


@pytest.mark.parametrize(
    ("formula", "says"),
    [
        ("2*x", "the formula must give 1 at x = 1 (motion.formula); value 2, limit 1; "),
        ("x + 1", "the formula must give 0 at x = 0 (motion.formula); value 1, limit 0; "),
        ("0.5", "the formula must give 0 at x = 0 (motion.formula); value 0.5, limit 0; "),
        ("1/(x - 0.3)", "S is not "),
        ("sqrt((x - 0.5)**2)", "S is not smooth (motion.formula, x = 0.5)"),
        ("sqrt((x - 0.37)**2)**3", "its acceleration S'' is not smooth (motion.formula, x = 0.37)"),
        ("x**1.5", "S is not smooth (motion.formula, x = 0)"),
        ("x**5.5", "its velocity S' cannot be computed (motion.formula, x = 0); "),
        ("log(x)", "S is not "),
        ("sqrt(x - 0.5)", "S is not finite (motion.formula, x = "),
    ],
)
def test_a_formula_that_makes_no_rise_is_refused(formula: str, says: str) -> None:
    with pytest.raises(InfeasibleError) as caught:
        FormulaRise(formula=formula).build(DEFAULT)
    assert str(caught.value).startswith(says)


@pytest.mark.parametrize("formula", ["2*x", "x + 1", "cos(pi*x)", "0.5*x - 3"])
def test_the_formula_that_is_named_works(formula: str) -> None:
    with pytest.raises(InfeasibleError) as caught:
        FormulaRise(formula=formula).build(DEFAULT)
    named = caught.value.nearest.removeprefix("this one does: ")
    rise = FormulaRise(formula=named).build(DEFAULT)
    assert float(rise.function(1.0)) == 1.0


def test_a_constant_has_no_formula_to_name() -> None:
    with pytest.raises(InfeasibleError, match="it is the same at both ends"):
        FormulaRise(formula="0.5").build(DEFAULT)
