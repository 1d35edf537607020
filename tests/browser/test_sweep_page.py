"""The page of a sweep in a browser."""

from __future__ import annotations

import json
import re
from dataclasses import replace
from itertools import pairwise
from pathlib import Path
from typing import Any

import numpy as np
import pytest
from selenium.webdriver import ActionChains, Chrome
from selenium.webdriver.common.by import By
from selenium.webdriver.common.keys import Keys
from selenium.webdriver.remote.webelement import WebElement
from selenium.webdriver.support.select import Select

import gearcam as gc
from gearcam.sweeps.page import page
from gearcam.sweeps.rows import Built, measured
from helpers_browser import PHONE, open_page, settle, unfold, until
from helpers_sweep import BASE


@pytest.fixture(scope="module")
def rows() -> list[Built]:
    places = np.linspace(0.05, 0.5, 10)
    made = [
        measured(BASE, k, {"law.eccentricity": round(float(e), 3)}) for k, e in enumerate(places)
    ]
    return [*made, measured(BASE, 10, {"law.eccentricity": 3.0})]


@pytest.fixture
def opened(browser: Chrome, rows: list[Built], tmp_path: Path) -> Chrome:
    file = tmp_path / "sweep.html"
    file.write_bytes(page(BASE, rows, ["law.eccentricity = 0.05:0.5:0.05"]))
    open_page(browser, file)
    return browser


def text(browser: Chrome, place: str) -> str:
    return browser.find_element(By.ID, place).text


def file_of(browser: Chrome) -> str:
    """Return the design file of the variant that is shown, which is folded."""
    (found,) = until(lambda: browser.find_elements(By.CSS_SELECTOR, "#variant pre"))
    return str(found.get_property("textContent"))


def front(browser: Chrome) -> list[str]:
    """Return the first column of the front, read at once: the page may draw it anew meanwhile."""
    return browser.execute_script(
        "return [...document.querySelectorAll('#front tr td:first-child')]"
        ".map((cell) => cell.textContent)"
    )


def drawn(browser: Chrome, place: str) -> int:
    """Return how many pixels of a canvas are not empty."""
    return browser.execute_script(
        "const one = document.getElementById(arguments[0]);"
        "const all = one.getContext('2d').getImageData(0, 0, one.width, one.height).data;"
        "let count = 0; for (let k = 3; k < all.length; k += 4) count += all[k] > 0;"
        "return count;",
        place,
    )


def test_all_charts_are_drawn_without_complaint(opened: Chrome) -> None:
    assert drawn(opened, "points") > 500
    assert drawn(opened, "axes") > 500
    assert "11 of 11 variants are kept" in text(opened, "shown")
    assert "refused" in text(opened, "shown")
    assert opened.find_elements(By.CSS_SELECTOR, "#spreads canvas")
    assert not opened.get_log("browser")


@pytest.mark.slow
def test_a_range_on_an_axis_keeps_its_variants(opened: Chrome) -> None:
    axes = opened.find_element(By.ID, "axes")
    opened.execute_script("arguments[0].scrollIntoView({block: 'center'})", axes)
    count = len(opened.find_elements(By.CSS_SELECTOR, "#choice input:checked"))
    left = -axes.size["width"] / 2 + axes.size["width"] / count / 2
    # the first axis is the eccentricity, up to 3; its lower half has all but the refused one
    ActionChains(opened).move_to_element_with_offset(
        axes, int(left), 20
    ).click_and_hold().move_by_offset(0, 140).release().perform()
    until(lambda: "10 of 11" in text(opened, "shown"))
    ActionChains(opened).move_to_element_with_offset(axes, int(left), 40).click().perform()
    until(lambda: "11 of 11" in text(opened, "shown"))


def end(browser: Chrome, fact: str, word: str) -> WebElement:
    """The end of a range on the axis of a fact, by its label, at ``least`` or at ``most``."""
    return browser.find_element(By.CSS_SELECTOR, f"[aria-label='{fact}, at {word}']")


@pytest.mark.slow
def test_the_ends_of_a_range_are_moved_by_keys(opened: Chrome) -> None:
    """Eccentricities are 0.05 to 0.5, and 3, which is refused: the axis is 2.95 long."""
    most, least = (end(opened, "eccentricity", word) for word in ("most", "least"))
    reached = set()
    for _ in range(60):
        ActionChains(opened).send_keys(Keys.TAB).perform()
        reached.add(opened.execute_script("return document.activeElement.ariaLabel"))
    assert {f"eccentricity, at {word}" for word in ("least", "most")} <= reached
    for keys, kept, value in (
        ([Keys.PAGE_DOWN], "10 of 11", 2.705),
        ([Keys.ARROW_UP, Keys.ARROW_RIGHT, Keys.ARROW_DOWN], "10 of 11", 2.7345),
        ([Keys.HOME], "1 of 11", 0.05),
        ([Keys.END], "11 of 11", 3.0),
    ):
        most.send_keys(*keys)
        until(
            lambda value=value: (
                float(most.get_attribute("aria-valuenow") or "nan") == pytest.approx(value)
            )
        )
        until(lambda kept=kept: f"{kept} variants are kept" in text(opened, "shown"))
    least.send_keys(Keys.PAGE_UP)  # to 0.345
    until(lambda: "5 of 11" in text(opened, "shown"))
    assert float(most.get_attribute("aria-valuemin") or "") == pytest.approx(0.345)
    assert least.get_attribute("aria-valuetext") == "0.345"
    most.send_keys(Keys.HOME)  # not beyond the other end
    until(lambda: "0 of 11" in text(opened, "shown"))
    least.send_keys(Keys.ESCAPE)
    until(lambda: "11 of 11" in text(opened, "shown"))


def test_an_end_of_a_range_is_dragged(opened: Chrome) -> None:
    most = end(opened, "eccentricity", "most")
    opened.execute_script("arguments[0].scrollIntoView({block: 'center'})", most)
    ActionChains(opened).click_and_hold(most).move_by_offset(0, 60).release().perform()
    until(lambda: "10 of 11" in text(opened, "shown"))
    low, high = opened.execute_script("return ranges.get('law.eccentricity')")
    assert low == pytest.approx(0.05)
    assert 1.5 < high < 2.8
    ActionChains(opened).click(most).perform()  # takes the focus only
    assert opened.execute_script("return ranges.get('law.eccentricity')") == [low, high]
    assert opened.switch_to.active_element == most


def test_a_click_shows_a_design_file_that_makes_these_facts(
    opened: Chrome, rows: list[Built]
) -> None:
    Select(opened.find_element(By.ID, "y")).select_by_value("pair.center_distance_mm")
    place: list[float] = opened.execute_script("return places().at(6)")
    points = opened.find_element(By.ID, "points")
    ActionChains(opened).move_to_element_with_offset(
        points, int(place[0] - points.size["width"] / 2), int(place[1] - points.size["height"] / 2)
    ).click().perform()
    written = file_of(opened)
    design = gc.loads(written)
    assert design.name == f"{BASE.name}_6"
    built: dict[str, Any] = gc.build(design).record()
    assert {**built, "name": BASE.name} == rows[6].facts
    assert f"gearcam build {BASE.name}_6.toml" in text(opened, "variant")


@pytest.mark.slow
def test_a_range_is_moved_and_all_are_kept_again(opened: Chrome) -> None:
    axes = opened.find_element(By.ID, "axes")
    opened.execute_script("arguments[0].scrollIntoView({block: 'center'})", axes)
    count = len(opened.find_elements(By.CSS_SELECTOR, "#choice input:checked"))
    left = int(-axes.size["width"] / 2 + axes.size["width"] / count / 2)
    mouse = ActionChains(opened).move_to_element_with_offset(axes, left, 100)
    mouse.click_and_hold().move_by_offset(0, 30).release().perform()
    before = opened.execute_script("return [...ranges.values()][0]")
    mouse = ActionChains(opened).move_to_element_with_offset(axes, left, 110)
    mouse.click_and_hold().move_by_offset(0, -60).release().perform()
    after = opened.execute_script("return [...ranges.values()][0]")
    assert after[0] > before[0]
    assert after[1] - after[0] == pytest.approx(before[1] - before[0])
    opened.find_element(By.ID, "all").click()
    until(lambda: "11 of 11" in text(opened, "shown"))


def test_the_front_is_that_of_the_variants_that_are_kept(opened: Chrome, rows: list[Built]) -> None:
    unfold(opened)
    Select(opened.find_element(By.NAME, "pair.ratio.min")).select_by_value("-1")
    until(lambda: front(opened) == ["0"])
    opened.execute_script("ranges.set('law.eccentricity', [0.22, 1]); draw()")
    until(lambda: front(opened) == ["4"])
    ratios = [float(row.facts["pair.ratio.min"]) for row in rows[4:10]]
    assert max(ratios) == ratios[0]


def test_refused_variants_are_crosses_at_the_edge(opened: Chrome) -> None:
    around = opened.execute_script(
        "const [x, y] = places().at(10).map(Math.round);"
        "return [...byId('points').getContext('2d').getImageData(x - 4, y - 4, 9, 9).data]"
    )
    red, green, blue, _ = np.array(around).reshape(-1, 4).T
    assert np.max(red - np.maximum(green, blue)) > 80


def test_shares_of_a_distribution(browser: Chrome, tmp_path: Path) -> None:
    values = np.random.default_rng(3).normal(size=157).round(3)
    made = [
        Built(number=k, values={"k": k}, facts={"a": float(value)})
        for k, value in enumerate(values)
    ]
    file = tmp_path / "spread.html"
    file.write_bytes(page(BASE, made, []))
    open_page(browser, file)
    figures = browser.find_elements(By.CSS_SELECTOR, "#spreads figure")
    words = next(one.text for one in figures if one.text.startswith("a\n"))
    found = [float(one) for one in re.findall(r"%: ([-.e\d]+)", words)]
    expected = np.percentile(values, [5, 25, 50, 75, 95])
    np.testing.assert_allclose(found, expected, rtol=1e-5, atol=1e-6)


def test_words_are_axes_and_stand_in_the_file(browser: Chrome, tmp_path: Path) -> None:
    teeth = [[30, 30], [41, 41], [24, 24]]
    made = [measured(BASE, k, {"pair.teeth": one}) for k, one in enumerate(teeth)]
    file = tmp_path / "words.html"
    file.write_bytes(page(BASE, made, []))
    open_page(browser, file)
    assert not browser.get_log("browser")
    assert browser.find_element(By.ID, "x").get_attribute("value") == "pair.teeth"
    least = end(browser, "teeth, pair", "least")
    first = least.get_attribute("aria-valuetext")
    least.send_keys(Keys.ARROW_UP)  # by one word
    until(lambda: "2 of 3" in text(browser, "shown"))
    assert least.get_attribute("aria-valuetext") != first
    least.send_keys(Keys.HOME)
    browser.find_element(By.ID, "number").send_keys("2", Keys.ENTER)
    written = file_of(browser)
    built: dict[str, Any] = gc.build(gc.loads(written)).record()
    assert {**built, "name": BASE.name} == made[2].facts


def test_a_single_variant_is_shown(browser: Chrome, rows: list[Built], tmp_path: Path) -> None:
    file = tmp_path / "one.html"
    file.write_bytes(page(BASE, rows[:1], []))
    open_page(browser, file)
    assert not browser.get_log("browser")
    assert "eccentricity" in text(browser, "variant")
    assert not browser.find_element(By.ID, "points").is_displayed()


def test_the_longest_name_is_cut(browser: Chrome, tmp_path: Path) -> None:
    base = replace(BASE, name="n" * 100)
    file = tmp_path / "name.html"
    file.write_bytes(page(base, [Built(number=123456, values={"law.eccentricity": 0.2})], []))
    open_page(browser, file)
    written = file_of(browser)
    assert gc.loads(written).name == "n" * 80 + "_123456"


@pytest.mark.slow
def test_a_choice_by_chance_has_all_values_of_a_grid(browser: Chrome, tmp_path: Path) -> None:
    made = [
        Built(number=k, values={"a": k // 10, "b": k % 10}, facts={"c": float(k)})
        for k in range(50_000)
    ]
    file = tmp_path / "grid.html"
    file.write_bytes(page(BASE, made, []))
    open_page(browser, file)
    drawn_ones = np.array(browser.execute_script("return some(1, 2000)"))
    assert len(set(drawn_ones)) == 2000
    assert np.ptp(drawn_ones) > 49_000
    counts = np.bincount(drawn_ones % 10, minlength=10)
    assert counts.min() > 140  # of 200, standard deviation 13
    assert counts.max() < 260


def test_the_front_is_that_of_all_pairs(browser: Chrome, tmp_path: Path) -> None:
    random = np.random.default_rng(5)
    values = np.tile(random.normal(size=(150, 2)).round(2), (2, 1))  # equal ones are both best
    made = [
        Built(
            number=k,
            values={"law.eccentricity": float(k)},
            facts={"a": float(a), "b": float(b)},
            errors=int(k % 7 == 0),
        )
        for k, (a, b) in enumerate(values)
    ]
    file = tmp_path / "front.html"
    file.write_bytes(page(BASE, made, [], {"a": 1.0, "b": -1.0}))
    open_page(browser, file)
    good = [k for k in range(300) if k % 7]
    best = {
        k
        for k in good
        if not any(
            values[j, 0] <= values[k, 0]
            and values[j, 1] >= values[k, 1]
            and tuple(values[j]) != tuple(values[k])
            for j in good
        )
    }
    assert {int(one) for one in front(browser)} == best
    unfold(browser)
    Select(browser.find_element(By.NAME, "b")).select_by_value("")
    settle(browser)
    least = min(values[k, 0] for k in good)
    assert {int(one) for one in front(browser)} == {k for k in good if values[k, 0] == least}


def test_it_is_read_on_a_phone_and_in_the_dark(
    browser: Chrome, rows: list[Built], tmp_path: Path
) -> None:
    file = tmp_path / "sweep.html"
    file.write_bytes(page(BASE, rows, []))
    open_page(browser, file, PHONE, prefers_color_scheme="dark")
    unfold(browser)
    wide = browser.execute_script("return document.documentElement.scrollWidth")
    assert wide <= PHONE[0]
    assert drawn(browser, "points") > 200
    # the axes scroll where their numbers need more room than the screen has
    step, numbers = browser.execute_script(
        "const pen = byId('axes').getContext('2d'), axes = picked();"
        "return [byId('axes').clientWidth / axes.length, axes.flatMap((one) =>"
        "  [one.low, one.high].map((value) => pen.measureText(word(one, value)).width))]"
    )
    assert max(numbers) < step - 6
    last = browser.find_elements(By.CSS_SELECTOR, "#ends > *")[-1]
    last.send_keys(Keys.PAGE_DOWN)  # the focus brings it into view
    assert 0 < last.rect["x"] - browser.execute_script("return scrollX") < PHONE[0]


@pytest.mark.slow
def test_a_hundred_thousand_variants_open(browser: Chrome, tmp_path: Path) -> None:
    made = [
        Built(number=k, values={"law.eccentricity": k / 1e5}, facts={"a": (k * 37 % 1000) / 7.0})
        for k in range(100_000)
    ]
    file = tmp_path / "many.html"
    file.write_bytes(page(BASE, made, []))
    assert len(json.dumps(open_page(browser, file)["numbers"])) > 100_000
    until(lambda: "100000 of 100000 variants are kept, 10000 are drawn" in text(browser, "shown"))


GOALS = {"pair.ratio.max": -1.0, "mesh.contact_ratio.forward.least": -1.0}


@pytest.fixture(scope="module")
def sought(rows: list[Built], tmp_path_factory: pytest.TempPathFactory) -> Path:
    """The page of a search for the largest ratio and the largest contact ratio."""
    file = tmp_path_factory.mktemp("sought") / "optimize.html"
    file.write_bytes(page(BASE, rows, [], GOALS))
    return file


def test_two_goals_are_the_axes_with_their_front_and_its_best_named(
    browser: Chrome, sought: Path
) -> None:
    open_page(browser, sought)
    assert not browser.get_log("browser")
    assert [browser.find_element(By.ID, one).get_attribute("value") for one in "xy"] == [*GOALS]
    best = front(browser)
    assert best[0] == "9"  # the largest eccentricity has the largest ratio
    assert len(best) > 3
    named = browser.execute_script("return [...names].map(([k, name]) => [sweep.numbers[k], name])")
    assert dict(named)[9] == "largest ratio i21"
    assert {name for _, name in named} == {
        "largest ratio i21",
        "largest contact ratio, forward",
        "nearest to both",
    }
    # the edge of what can be had: from one to the next one level and one upright stroke
    ink = browser.execute_script(
        "const [a, b] = front.slice(0, 2).map((k) => places().at(k));"
        "const far = [[0.5 * (a[0] + b[0]), a[1]], [b[0], 0.5 * (a[1] + b[1])]];"
        "const near = (x, y) => [...byId('points').getContext('2d')"
        "  .getImageData(x - 2, y - 2, 5, 5).data].filter((_, k) => k % 4 === 3);"
        "return far.map(([x, y]) => Math.max(...near(x, y)));"
    )
    assert min(ink) > 200


def test_a_design_of_the_front_is_one_click_from_its_file(
    browser: Chrome, sought: Path, rows: list[Built], tmp_path: Path
) -> None:
    open_page(browser, sought)
    behaviour = {"behavior": "allow", "downloadPath": str(tmp_path)}
    browser.execute_cdp_cmd("Browser.setDownloadBehavior", behaviour)
    links = browser.find_elements(By.CSS_SELECTOR, "#front a")
    assert len(links) == len(front(browser))
    links[0].click()
    saved = until(lambda: [*tmp_path.glob("*.toml")])[0]
    assert saved.name == f"{BASE.name}_9.toml"
    built: dict[str, Any] = gc.build(
        until(lambda: saved.stat().st_size and gc.load(saved))
    ).record()
    assert {**built, "name": BASE.name} == rows[9].facts


def test_the_best_have_pictures_to_one_scale(browser: Chrome, sought: Path) -> None:
    open_page(browser, sought)
    boxes = browser.execute_script(
        "return [...document.querySelectorAll('#front svg')].map((one) => {"
        "  const { width, height } = one.getBBox(); return [width, height]; })"
    )
    assert len(boxes) == len(front(browser))
    widths = [width for width, _ in boxes]
    assert max(widths) == pytest.approx(132, abs=2)
    assert widths == sorted(widths, reverse=True)  # a larger eccentricity is a larger pair
    assert widths[-1] < widths[0] - 2
    assert len(browser.find_elements(By.CSS_SELECTOR, "#variant svg path")) >= 2


def test_a_sweep_without_goals_shows_some_variants(opened: Chrome) -> None:
    buttons = opened.find_elements(By.CSS_SELECTOR, "#pictured button")
    assert len(buttons) == 10  # all that can be made
    buttons[4].click()
    assert opened.find_element(By.ID, "number").get_attribute("value") == "4"
    assert buttons[4].text == "4: eccentricity 0.25"


def test_labels_are_words_with_units_and_numbers_have_five_digits(
    browser: Chrome, sought: Path
) -> None:
    open_page(browser, sought)
    heads = [one.text for one in browser.find_elements(By.CSS_SELECTOR, "#front th")]
    assert heads[:5] == [
        "variant",
        "to one scale",
        "largest ratio i21",
        "least contact ratio, forward",
        "eccentricity",
    ]
    options = [one.text for one in Select(browser.find_element(By.ID, "y")).options]
    assert {"largest pressure angle, deg", "thinnest tip, mm"} <= set(options)
    assert not [one for one in options if "_" in one or re.search(r"\w\.\w", one)]
    column = [one.text for one in browser.find_elements(By.CSS_SELECTOR, "#front td:nth-child(4)")]
    assert {len(one) for one in column} == {6}  # 1.6543: zeros at the end are kept
    facts = browser.find_element(By.CSS_SELECTOR, "#variant .facts").text
    for number in re.findall(r"-?\d+\.\d+", facts):
        assert len(number.lstrip("-0.").replace(".", "")) <= 5, number


def test_numbers_at_axes_are_round_and_do_not_touch(browser: Chrome, sought: Path) -> None:
    for size in ((1500, 950), PHONE):
        open_page(browser, sought, size)
        across, up = browser.execute_script(
            "const { x, y, across, up } = places();"
            "const pen = byId('points').getContext('2d');"
            "const few = byId('points').clientWidth < 500 ? 4 : 6;"
            "const told = (one, place, most) => ticks(one, most).map(([value, text]) =>"
            "  [place(value), pen.measureText(text).width, text]);"
            "return [told(x, across, few), told(y, up)]"
        )
        assert len(across) >= 3
        assert len(up) >= 3
        for (left, wide, _), (right, width, _) in pairwise(across):
            assert left + 0.5 * wide < right - 0.5 * width
        assert all(lower - 12 > upper for (lower, *_), (upper, *_) in pairwise(up))
        assert max(len(text) for _, _, text in [*across, *up]) <= 4
    tenths = browser.execute_script("return ticks({ low: 0.05, high: 0.75, words: [] }, 8)")
    assert [text for _, text in tenths] == [f"0.{k}" for k in range(1, 8)]


def test_values_are_in_the_unit_of_their_axis(browser: Chrome, tmp_path: Path) -> None:
    made = [
        Built(number=k, values={"k": k}, facts={"a_mm_s2": 1e5 * k, "b": float(-k)})
        for k in range(1, 4)
    ]
    file = tmp_path / "units.html"
    file.write_bytes(page(BASE, made, [], {"a_mm_s2": 1.0, "b": 1.0}))
    open_page(browser, file)
    assert [one.text for one in browser.find_elements(By.CSS_SELECTOR, "#front th")][1] == "a, m/s2"
    cells = browser.find_elements(By.CSS_SELECTOR, "#front td:nth-child(2)")
    assert [one.text for one in cells] == ["100", "200", "300"]
