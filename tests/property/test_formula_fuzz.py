"""Random formulas: what is typed gives a value or a FormulaError, and values agree with math."""

from __future__ import annotations

import math

import numpy as np
import pytest
from hypothesis import given, settings
from hypothesis import strategies as st

from gearcam.laws.formula_syntax import Expression, FormulaError, parse
from helpers_formulas import NUMPY

WORDS = st.sampled_from(
    [
        *NUMPY,
        "phi1",
        "pi",
        "+",
        "-",
        "*",
        "/",
        "**",
        "(",
        ")",
        "2",
        "0.5",
        "1e3",
        " ",
        "^",
        ",",
        "x",
    ]
)


@given(st.text(max_size=60) | st.lists(WORDS, max_size=25).map("".join))
@settings(max_examples=40, deadline=None)
def test_any_text_is_read_or_refused(text: str) -> None:
    expression = _read(text)
    if isinstance(expression, FormulaError):
        assert str(expression)
        assert expression.column is None or 1 <= expression.column <= len(text) + 1
    else:
        assert np.shape(expression.evaluate(np.array([0.3, 4.0]), NUMPY)) == (2,)


def _read(text: str) -> Expression | FormulaError:
    try:
        return parse(text)
    except FormulaError as error:
        return error


def _grow(inner: st.SearchStrategy[str]) -> st.SearchStrategy[str]:
    return st.one_of(
        st.tuples(inner, st.sampled_from(["+", "-", "*", "/", "**"]), inner).map(
            lambda parts: f"({parts[0]}) {parts[1]} ({parts[2]})"
        ),
        st.tuples(inner, st.sampled_from(["+", "-", "*"]), inner).map(" ".join),
        st.tuples(st.sampled_from(sorted(NUMPY)), inner).map(lambda pair: f"{pair[0]}({pair[1]})"),
        inner.map(lambda text: f"-({text})"),
    )


FORMULAS = st.recursive(
    st.floats(0.01, 9, allow_subnormal=False).map(lambda value: f"{value:.6g}")
    | st.sampled_from(["phi1", "pi", "phi1"]),
    _grow,
    max_leaves=12,
)
MATH = {name: getattr(math, name) for name in NUMPY}


@given(FORMULAS, st.floats(0.01, 6.3))
@settings(max_examples=80, deadline=None)
def test_a_formula_agrees_with_the_same_text_in_math(text: str, angle: float) -> None:
    expression = _read(text)
    if isinstance(expression, FormulaError):
        # only values and exponents can be at fault: the text is well formed
        assert "no finite real value" in expression.what or "exponent" in expression.what
        return
    words = {"__builtins__": {}, "phi1": angle, "pi": math.pi, **MATH}
    try:
        expected = eval(text, words)  # noqa: S307  (the text was made here)
    except (ArithmeticError, ValueError):
        return
    except TypeError:  # a power of a negative number has become complex
        return
    if isinstance(expected, complex) or not abs(expected) < 1e12:
        return
    value = float(expression.evaluate(np.float64(angle), NUMPY))
    assert value == pytest.approx(expected, rel=1e-9, abs=1e-9)
