"""A formula reads as written, computes for every type of variable, and can do nothing else."""

from __future__ import annotations

import math
import time

import numpy as np
import pytest

from gearcam.base.errors import GearcamError
from gearcam.laws.formula_syntax import MAX_LENGTH, MAX_NESTING, FormulaError, parse
from gearcam.numeric import jets
from gearcam.numeric.jets import Jet
from helpers_formulas import NUMPY

X = 0.7


@pytest.mark.parametrize(
    ("text", "value"),
    [
        ("phi1 - 0.08*sin(2*phi1)", X - 0.08 * math.sin(2 * X)),
        ("-phi1**-2", -(X**-2)),
        ("2**3**2", 512.0),
        ("(2**3)**2", 64.0),
        ("8/4/2", 1.0),
        ("1 - 2 - 3", -4.0),
        ("2 + + 3 - -1", 6.0),
        ("1/(1 + 0.3*cos(2*phi1))", 1 / (1 + 0.3 * math.cos(2 * X))),
        ("phi1\n  + pi\t/ 2", X + math.pi / 2),
        ("1.5e-3 + .5 + 2.", 2.5015),
        ("  (( phi1 ))  ", X),
        ("phi1**0.5", X**0.5),
        ("2**phi1", 2**X),
        ("phi1**phi1", X**X),
        ("asin(phi1) + acos(phi1)", math.pi / 2),
        ("log(exp(phi1)) + atan(tan(phi1)) + sqrt(phi1**2)", 3 * X),
        ("cosh(phi1)**2 - sinh(phi1)**2 - tanh(phi1)", 1 - math.tanh(X)),
        ("7", 7.0),
    ],
)
def test_a_formula_has_the_value_of_its_text(text: str, value: float) -> None:
    assert float(parse(text).evaluate(X, NUMPY)) == pytest.approx(value, rel=1e-14)
    assert parse(text).text == text


def test_arrays_and_jets_keep_their_type_even_for_a_constant() -> None:
    grid = np.linspace(0.1, 0.9, 5)
    for text in ("phi1**2 * sin(phi1)", "3*pi", "exp(-phi1)/phi1"):
        values = parse(text).evaluate(grid, NUMPY)
        jet = parse(text).evaluate(Jet.variable(grid, 3), jets.FUNCTIONS)
        assert values.shape == grid.shape
        assert isinstance(jet, Jet)
        np.testing.assert_allclose(jet.c[0], values, rtol=1e-14)
    assert parse("3*pi").is_constant
    assert not parse("0*phi1").is_constant


def test_jets_and_arrays_know_the_same_functions() -> None:
    assert set(jets.FUNCTIONS) == set(NUMPY)


def test_outside_its_domain_a_formula_gives_nan_or_inf_without_a_warning() -> None:
    grid = np.array([-1.0, 0.0, 1.0])
    assert np.isnan(parse("log(phi1)").evaluate(grid, NUMPY)[0])
    assert np.isinf(parse("1/phi1").evaluate(grid, NUMPY)[1])


@pytest.mark.parametrize(
    ("text", "column", "words"),
    [
        ("phi1^2", 5, "**"),
        ("2 phi1", 3, "operator is missing"),
        ("2(phi1)", 2, "operator is missing"),
        ("phi1(2)", 5, "operator is missing"),
        ("1 + sine(phi1)", 5, "did you mean sin"),
        ("phi + 1", 1, "did you mean phi1"),
        ("Sin(phi1)", 1, "did you mean sin"),
        ("arcsin(phi1)", 1, "did you mean asin"),
        ("ln(phi1)", 1, "did you mean log"),
        ("sin phi1", 5, "parentheses"),
        ("sin", 4, "too early"),
        ("sin()", 4, "empty"),
        ("sin(phi1, 2)", 9, "one argument"),
        ("1,5*phi1", 2, "point"),
        ("(phi1", 1, "never closed"),
        ("phi1)", 5, "never opened"),
        ("* 2", 1, "missing before"),
        ("2 * / 3", 5, "missing before"),
        ("(2 + )", 6, "missing before"),
        ("2 +", 4, "too early"),
        ("phi1 = 2", 6, "right side"),
        ("phi1 < 2", 6, "unexpected sign"),
        ("phi1 // 2", 7, "missing before"),
        ("phi1 % 2", 6, "unexpected sign"),
        ("phi1 \N{MINUS SIGN} 2", 6, "typographic minus"),
        ("30\N{DEGREE SIGN}", 3, "radians"),
        ("007", 1, "begins with a zero"),
        ("0x10", 2, "unknown name"),
        ("1_000", 2, "unknown name"),
        ("1j", 2, "unknown name"),
        ("1e999", 1, "too large"),
        ("1/0", 1, "no finite real value"),
        ("phi1 + log(0)", 8, "no finite real value"),
        ("phi1 + (-8)**(1/3)", 8, "no finite real value"),
        ("phi1 + exp(1000)", 8, "no finite real value"),
        ("phi1**1000", 7, "exponent"),
        ("9**9**9**9", 7, "exponent"),
        ("phi1.real", 5, "unexpected sign"),
        ("phi1[0]", 5, "round parentheses"),
        ("'a'", 1, "unexpected sign"),
        ("phi1; 2", 5, "unexpected sign"),
        ("phi1 # 2", 6, "unexpected sign"),
        ("a\0b", 1, "unknown name"),
        ("1\0", 2, "U+0000"),
    ],
)
def test_what_is_wrong_is_told_by_its_column(text: str, column: int, words: str) -> None:
    with pytest.raises(FormulaError) as caught:
        parse(text)
    assert caught.value.column == column
    assert words in str(caught.value)
    assert str(caught.value).startswith(f"column {column}: ")


@pytest.mark.parametrize("variable", ["theta", "q", "u", "phi1"])
@pytest.mark.parametrize(
    ("text", "words"),
    [
        ("", "allowed: {}, pi, numbers"),
        ("1 + ?", "allowed: {}, pi, numbers"),
        ("sin(pi)(2)", "operator is missing"),
        ("(sin)({})", "parentheses: sin({})"),
        ("sin {}", "parentheses: sin({})"),
        ("sin(2*omega)", "allowed: {}, pi, numbers"),
        ("2*phi", "did you mean {}?"),
        ("2*x", "did you mean {}?"),
        ("2*Theta1 + \N{GREEK SMALL LETTER PHI}", "allowed: {}, pi, numbers"),
        ("\N{GREEK SMALL LETTER THETA}", "did you mean {}?"),
    ],
)
def test_messages_name_the_variable_of_the_place(text: str, words: str, variable: str) -> None:
    with pytest.raises(FormulaError) as caught:
        parse(text.format(variable), variable)
    assert words.format(variable) in str(caught.value)
    for other in {"phi1", "theta"} - {variable}:
        assert other not in str(caught.value)


def test_the_angle_of_pairs_is_answered_with_that_of_cams() -> None:
    for other, variable in (("phi1", "theta"), ("theta", "phi1"), ("t", "q"), ("q", "x")):
        with pytest.raises(FormulaError) as caught:
            parse(f"5*(1 - cos({other}))", variable)
        assert caught.value.hint == f"did you mean {variable}?"


@pytest.mark.parametrize(
    "text",
    [
        "__import__('os').system('true')",
        "().__class__",
        "lambda: 1",
        "phi1 if phi1 else 1",
        "[phi1 for phi1 in (1,)]",
        "phi1 or 1",
        "not phi1",
        "f'{phi1}'",
        "phi1 := 2",
        "sin(*phi1)",
        "sin(x=phi1)",
        "sin.__call__(phi1)",
        "pi(2)",
        "eval(phi1)",
        "True",
        "None",
        "await phi1",
        "...",
        "{}",
        "phi1 @ phi1",
        "phi1 & 1",
        "~1",
        "print",
        "sin + 1",
        "(sin)(phi1)",
        "sin(cos)",
        "-",
        "()",
        "",
        "   \n ",
    ],
)
def test_nothing_but_arithmetic_gets_through(text: str) -> None:
    with pytest.raises(FormulaError) as caught:
        parse(text)
    assert isinstance(caught.value, GearcamError)
    assert isinstance(caught.value, ValueError)


@pytest.mark.parametrize(
    "text",
    [
        "9" * MAX_LENGTH,
        "9**" * 500 + "9",
        "(" * 900 + "1" + ")" * 900,
        "(" * (MAX_NESTING + 1) + "1" + ")" * (MAX_NESTING + 1),
        "sin(" * 400 + "phi1" + ")" * 400,
        "phi1**99**9",
        "1+" * MAX_LENGTH + "1",
    ],
)
def test_costly_formulas_are_refused_at_once(text: str) -> None:
    start = time.process_time()
    with pytest.raises(FormulaError):
        parse(text)
    assert time.process_time() - start < 0.5


def test_a_part_that_is_written_twice_is_computed_once() -> None:
    calls = []

    def sine(x: np.ndarray) -> np.ndarray:
        calls.append(x)
        return np.sin(x)

    x = np.array([0.3, 1.1])
    text = "sin(2*phi1)**2 + sin(2*phi1)*sin(phi1*2) - 1/(sin(2*phi1))"
    found = parse(text).evaluate(x, {"sin": sine})
    s = np.sin(2 * x)
    np.testing.assert_allclose(found, s**2 + s * s - 1 / s, rtol=1e-15)
    assert len(calls) == 2
    # zeros of both signs are two numbers
    assert math.isnan(parse("1/(0*phi1 + 0) + 1/(phi1*(-0))").evaluate(x, NUMPY)[0])


def test_long_formulas_within_the_limits_are_computed() -> None:
    assert parse("1+" * (MAX_LENGTH // 2 - 2) + "phi1").evaluate(1.0, NUMPY) == MAX_LENGTH // 2 - 1
    assert parse("-" * (MAX_LENGTH - 4) + "phi1").evaluate(1.0, NUMPY) == 1.0
    assert parse("(" * MAX_NESTING + "phi1" + ")" * MAX_NESTING).evaluate(2.0, NUMPY) == 2.0
    assert parse("phi1**" * 300 + "1").evaluate(1.0, NUMPY) == 1.0
