"""What console and pages say of every design file: few digits, and one spelling of each unit."""

from __future__ import annotations

import re
from collections.abc import Iterator
from typing import Any

import pytest

from gearcam.base.readable import labelled
from gearcam.report.data import chart_data
from helpers_built import built
from helpers_pairs import PROFILES
from helpers_sampling import chosen

NAMES = sorted(path.stem for path in PROFILES.glob("*.toml"))

SOME = chosen(NAMES, *(set(NAMES[::3]) - {"rotary_table"}))
"""Of two globoidal cams one is enough."""

DIGITS = 5

NUMBER = re.compile(r"(?<![\w.])-?(\d+\.?\d*)(?:e[-+]?\d+)?(?![\w.]*\d)")

QUANTITIES = (
    "um mm m km um2 mm2 cm2 m2 mm3 cm3 dm3 m3 deg urad mrad rad krad Mrad arcsec rpm mN N kN MN "
    "N_mm N_m kN_m kPa MPa GPa mJ J kJ mW W kW us ms s Hz kHz mg g kg t g_mm kg_mm g_mm2 kg_mm2 "
    "kg_cm2 kg_m2 %"
).replace("_", "\N{NO-BREAK SPACE}")
UNIT = {one.replace("\N{NO-BREAK SPACE}", " ") for one in QUANTITIES.split(" ")}
"""Units, spelt in the one way; a rate is one of them or 1, over another."""

OTHERS = {"", "modules", "teeth", "addenda", "turns", "rows", "points", "phases", "square mm"}

MISSPELT = re.compile(
    r"\d ?(?:°|µm|Nm\b|Nmm\b)|\^|²|³|·|/s\^|mm/s/s|\bdegrees?\b|\d ?(?:sec|kgs)\b"
)


def spelt(unit: str) -> bool:
    """Whether a unit is spelt as all are."""
    above, slash, below = unit.partition("/")
    if not slash:
        return unit in UNIT | OTHERS
    power = re.fullmatch(r"(s|rad|mm|m|deg|modules|um)([23]?)", below)
    return (above in UNIT or above == "1") and power is not None


def texts(result: Any) -> Iterator[tuple[str, str]]:
    """What people read of a result, with where it stands."""
    yield from (("headline", one) for one in result.facts.headline)
    for fact in result.facts.quantities():
        for text in (fact.text, fact.limit, fact.place):
            if not fact.name.startswith("accuracy.how."):
                yield fact.name, text
    for one in result.findings:
        yield from ((one.code, text) for text in (one.where, one.text, one.limit_text, one.message))


def charts(result: Any) -> Iterator[dict[str, Any]]:
    scene = result.scene()
    driver = scene.driver if scene else ""
    return (chart_data(name, result.chart(name), driver) for name in result.charts)


@pytest.mark.parametrize("name", SOME)
def test_numbers_have_few_digits(name: str) -> None:
    """Unless they are counts, or stand in the file, or are to be typed into it."""
    file = PROFILES / f"{name}.toml"
    given = {float(one[0]) for one in NUMBER.finditer(file.read_text("utf-8"))}
    long = [
        f"{where}: {one[0]} in {text!r}"
        for where, text in texts(built(file))
        for one in NUMBER.finditer(
            re.sub(r"[\w\[\].]+ = \[?[-\d., ]+|[A-Za-z_]\w*\.[\w.]+", "", text)
        )
        if "." in one[1] and len(one[1].replace(".", "").lstrip("0")) > DIGITS
        if abs(float(one[0])) not in given
    ]
    assert long == []


@pytest.mark.parametrize("name", SOME)
def test_units_have_one_spelling(name: str) -> None:
    result = built(PROFILES / f"{name}.toml")
    units = {one.unit for one in result.facts.quantities()} | {one.unit for one in result.findings}
    units |= {labelled(one[axis])[1] for one in charts(result) for axis in "xy"}
    assert {one for one in units if not spelt(one)} == set()
    assert [text for _, text in texts(result) if MISSPELT.search(text)] == []


@pytest.mark.parametrize("name", SOME)
def test_what_is_always_shown_is_between_a_tenth_and_ten_thousand(name: str) -> None:
    """As far as there is a unit for it: the numbers of a range by the largest."""
    for one in built(PROFILES / f"{name}.toml").facts.shown():
        text, _, unit = one.text.rpartition(" ") if " " in one.text else (one.text, "", "")
        if unit not in UNIT - {"deg", "rpm", "%"} or not isinstance(one.value, float):
            continue
        size = abs(float(text.split()[0]))
        assert size == 0.0 or 0.1 <= size <= 1e4 or len(text.strip("-0.")) <= 2, one.text


def test_other_spellings_would_be_seen() -> None:
    for wrong in ("mm/s^2", "m/s²", "Nm", "°", "µm", "deg/sec", "mm/rad^3"):
        assert not spelt(wrong)
    assert all(map(MISSPELT.search, ("28.15°", "12 Nm", "3 mm/s^2")))
    assert not MISSPELT.search("12.5 N m at 30 deg")
    assert all(map(spelt, ("m/s2", "km/s3", "N m", "N m/rad", "1/m", "mm/rad", "um", "")))
