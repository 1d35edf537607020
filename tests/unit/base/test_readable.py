"""Numbers with units as people read them: cases, and what is true of any number."""

from __future__ import annotations

import math
from decimal import Decimal

import pytest
from hypothesis import given
from hypothesis import strategies as st

from gearcam.base.numerals import FEW, formatted
from gearcam.base.readable import (
    LEAST,
    MOST,
    against,
    bare,
    column,
    labelled,
    number,
    readable,
    scale_of,
)

CASES = [
    # what is made: to 0.001 mm and 0.01 deg, in five digits
    (41.9607072, "mm", "41.961 mm"),
    (279.351234, "mm", "279.35 mm"),
    (0.75722123, "mm", "0.7572 mm"),
    (1185.2212, "mm", "1185.2 mm"),
    (28.154512, "deg", "28.15 deg"),
    (252.542123, "deg", "252.54 deg"),
    (0.0098785812, "deg", "0.009879 deg"),
    (-5.0902123, "mm", "-5.090 mm"),
    # all else: four, five where it begins with 1
    (2376.3412, "MPa", "2376 MPa"),
    (1.85714286, "", "1.8571"),
    (0.93737512, "", "0.9374"),
    (0.99999999, "", "1.0000"),
    # what somebody wrote
    (0.0, "mm", "0 mm"),
    (-0.0, "N", "0 N"),
    (0.05, "mm", "0.05 mm"),
    (160.00000000000003, "deg", "160 deg"),
    (20000.0, "N", "20 kN"),
    (0.1 + 0.2, "mm", "0.3 mm"),
    # counts
    (176414, "", "176414"),
    (8, "teeth", "8 teeth"),
    (0, "", "0"),
    # units
    (566943.12, "mm/s3", "566.9 m/s3"),
    (4.536123e8, "mm/s3", "453.6 km/s3"),
    (123456.789, "mm/s2", "123.46 m/s2"),
    (0.05469341, "mm", "54.69 um"),
    (0.0201234, "N m", "20.12 N mm"),
    (19530.912, "N", "19.531 kN"),
    (23456.789, "MPa", "23.46 GPa"),
    (3098081.2, "mm3", "3098 cm3"),
    (1.712345e-5, "rad", "17.123 urad"),
    (0.000412345, "kg m2", "4.123 kg cm2"),
    (84401.612, "deg/s3", "1473.1 rad/s3"),
    (0.03012345, "1/mm", "30.12 1/m"),
    (0.0092523123, "mm/mm3", "9.252 um/mm3"),
    (12345.678, "1/rad", "12346 1/rad"),
    (0.0341234, "arcsec", "0.03412 arcsec"),
    (7850.0, "kg/m3", "7850 kg/m3"),
    # beyond all units
    (1.2642123e-12, "mm", "1.264e-12 mm"),
    (-3.21e-125, "", "-3.210e-125"),
    (2.7182818e200, "", "2.718e200"),
]


@pytest.mark.parametrize(("value", "unit", "told"), CASES)
def test_numbers_as_engineers_write_them(value: float, unit: str, told: str) -> None:
    assert readable(value, unit) == told


@pytest.mark.parametrize(
    ("value", "unit", "error", "told"),
    [
        (2376.3412, "MPa", 47.0, "2400 MPa"),
        (0.3123456, "mm", 0.001, "0.312 mm"),
        (0.3123456, "mm", 0.00101, "0.31 mm"),
        (0.0546934, "mm", 0.0003, "55 um"),
        (41.5, "mm", 1.0, "42 mm"),  # as somebody wrote it, but not known to that
        (3.0, "mm", 50.0, "0 mm"),
        (-3.0, "mm", 50.0, "0 mm"),
        (0.0, "mm", 50.0, "0 mm"),
        (12.3456, "", 1e-12, "12.346"),
    ],
)
def test_no_digit_is_finer_than_the_stated_error(
    value: float, unit: str, error: float, told: str
) -> None:
    assert readable(value, unit, error=error) == told


@pytest.mark.parametrize("value", [math.nan, math.inf, -math.inf])
def test_what_is_no_number_is_refused(value: float) -> None:
    for tell in (number, readable, lambda one: column([1.0, one])):
        with pytest.raises(ValueError, match="can be shown"):
            tell(value)


def test_columns_line_up() -> None:
    assert column([9.5, 10.25, 0.0]) == ("9.50", "10.25", "0.00")
    assert column([47.8341, 1086.112], "N m") == ("47.8", "1086.1")
    assert column([41.96071, 45.0], "mm") == ("41.961", "45.000")
    assert column([3, 12]) == ("3", "12")
    # a small number keeps two digits, noise none
    assert column([-0.00488585, 12.00491], "mm") == ("-0.0049", "12.005")
    assert column([1e-9, 12.00491], "mm") == ("0.000", "12.005")
    assert column([41.96071, 45.0], "mm", error=0.02) == ("42.0", "45.0")


def test_a_value_looks_unlike_the_limit_that_it_breaks() -> None:
    assert against(31.99999987, 32.0, "deg", kept=True) == ("32.00 deg", "32 deg")
    assert against(32.00000013, 32.0, "deg", kept=False) == ("32.0000001 deg", "32 deg")
    assert against(0.0, 0.01, "mm", kept=False) == ("0 mm", "0.01 mm")
    assert against(0.00494123, 0.01, "mm", kept=True) == ("4.941 um", "10 um")
    assert against(12.5, None, "mm", kept=True) == ("12.5 mm", "")
    assert against(None, 2.0, kept=True) == ("", "2")


def test_units_of_one_scale() -> None:
    assert scale_of(0.0, "mm").unit == scale_of(0.1, "mm").unit == scale_of(9999.0, "mm").unit
    assert scale_of(10000.0, "mm").unit == "m"
    assert scale_of(-0.02, "N m").unit == "N mm"
    assert scale_of(1e9, "kg/m3").unit == "kg/m3"
    assert scale_of(1e9, "").unit == ""


def test_labels_and_bare_numbers() -> None:
    assert labelled("sliding, forward, mm/rad") == ("sliding, forward", "mm/rad")
    assert labelled("ratio i21") == ("ratio i21", "")
    assert (bare("2.500"), bare("2.000e-12"), bare("200")) == ("2.5", "2e-12", "200")


NUMBERS = st.floats(
    allow_nan=False, allow_infinity=False, min_value=-1e200, max_value=1e200, allow_subnormal=False
)
UNITS = st.sampled_from(["", "mm", "deg", "N m", "mm/s3", "deg/s2", "1/rad", "kg m2", "rad"])
ERRORS = st.one_of(st.just(0.0), st.floats(min_value=1e-12, max_value=1e6))


def last_digit(text: str) -> Decimal:
    """The value of a unit in the last place of a number as text."""
    return Decimal(1).scaleb(int(Decimal(text).as_tuple().exponent))


@given(value=NUMBERS, unit=UNITS, error=ERRORS)
def test_what_is_told_is_the_number(value: float, unit: str, error: float) -> None:
    """Within half of its last digit, which is no finer than the error, and in few digits."""
    text = number(value, unit, error=error)
    told = Decimal(text)
    step = last_digit(text)
    if told and "." not in text:  # zeros at the end of a whole number are not known
        step = max(step, Decimal(10) ** (Decimal(repr(value)).adjusted() - 3))
    if error:
        step = max(step, Decimal(10) ** math.ceil(math.log10(error) - 1e-9))
    assert abs(told - Decimal(repr(value))) <= Decimal("0.5001") * step
    digits = text.partition("e")[0].lstrip("-").replace(".", "").lstrip("0")
    if abs(told) < 1e5 or "e" in text:
        assert len(digits) <= 5
    if error and "." in text and "e" not in text:
        assert last_digit(text) >= Decimal(repr(error)) * Decimal("0.999999")


@given(value=NUMBERS, unit=UNITS)
def test_a_unit_does_not_change_the_number(value: float, unit: str) -> None:
    to = scale_of(value, unit)
    text, _, told = readable(value, unit).partition(" ")
    assert told in (to.unit, unit)  # a short decimal keeps its unit
    factor = to.factor if told == to.unit else 1.0
    assert float(text) == pytest.approx(factor * value, rel=5e-4)
    assert scale_of(abs(value) * to.factor, to.unit).factor == 1.0 or not (
        LEAST <= abs(value) * to.factor < MOST
    )


@given(values=st.lists(st.floats(min_value=1e-3, max_value=1e4), min_size=1, max_size=5))
def test_numbers_of_a_column_have_the_same_decimals(values: list[float]) -> None:
    large = [one for one in values if one >= 0.02 * max(values)]
    decimals = {len(text.partition(".")[2]) for text in column(large, "N")}
    assert len(decimals) == 1


def test_numbers_for_messages_have_five_digits_and_no_exponent() -> None:
    assert formatted(169.814321, FEW) == "169.81"
    assert formatted(100000.0, FEW) == "100000"
    assert formatted(123456.7, FEW) == "123460"
    assert formatted(44.82351) == "44.8235"  # what may be typed
    assert formatted(1e-7) == "1e-07"
