"""The page of variants: each has one colour, stands out when pointed at, and nothing is cut off."""

from __future__ import annotations

from pathlib import Path

import pytest
from selenium.webdriver import ActionChains, Chrome
from selenium.webdriver.common.by import By

from gearcam.compare.page import document
from gearcam.compare.variants import variants_of
from gearcam.report.page import page
from helpers_browser import complaints, open_page, settle
from helpers_pairs import PROFILES

WIDE = (1500, 950)
MANY = 12
SETTINGS = {
    "law.eccentricity": [round(0.02 * (k + 1), 2) for k in range(MANY)],
    "output.chord_tolerance_mm": [0.02],
}
INKS = """
const style = getComputedStyle(document.documentElement);
return [1, 2, 3, 4, 5, 6].map((k) => style.getPropertyValue(`--line-${k}`).trim());
"""
COUNT = """
const [plot, colour] = arguments;
const canvas = plot.querySelector("canvas");
const { data } = canvas.getContext("2d").getImageData(0, 0, canvas.width, canvas.height);
const wanted = [1, 3, 5].map((k) => parseInt(colour.slice(k, k + 2), 16));
let count = 0;
for (let k = 0; k < data.length; k += 4) {
  count += data[k + 3] === 255 && wanted.every((one, n) => Math.abs(data[k + n] - one) < 3);
}
return count;
"""


DASHED = """
const { page } = gearcam;
const poses = gearcam.poses();
const found = [];
const root = new DOMParser().parseFromString(gearcam.svg(), "image/svg+xml");
for (const way of root.querySelectorAll("g > path")) {
  // the outlines of the second variant, which are not filled
  const at = (way.getAttribute("transform") ?? "").match(/translate\\((\\S+) /);
  if (!at || way.getAttribute("fill") !== "none" || !way.getAttribute("d").endsWith("Z")) continue;
  if (way.getAttribute("d").length < 2000) continue;
  const one = poses.find((pose) => Math.abs(pose.x - Number(at[1])) < 1e-3);
  const dashes = way.getAttribute("stroke-dasharray");
  found.push([one.name, dashes ? [9, 3] : []]);
}
return found;
"""


@pytest.fixture(scope="module")
def path(tmp_path_factory: pytest.TempPathFactory) -> Path:
    variants = variants_of([str(PROFILES / "ellipse.toml")], SETTINGS)
    made = tmp_path_factory.mktemp("variants") / "compare.html"
    made.write_bytes(page(document(variants, "ellipse, variants")))
    return made


def looks(browser: Chrome, where: str) -> list[tuple[str, bool]]:
    """Colour of each variant's sample, and whether it has a mark."""
    samples = browser.find_elements(By.CSS_SELECTOR, f"{where} [data-variant] .sample")
    return [
        (
            str(one.get_attribute("class")).replace("sample", "").split()[0],
            bool(one.find_elements(By.CSS_SELECTOR, ".mark, rect")),
        )
        for one in samples
    ]


def test_a_variant_has_one_colour_in_header_charts_and_picture(browser: Chrome, path: Path) -> None:
    open_page(browser, path, WIDE)
    wanted = [(f"line-{k % 6 + 1}", k >= 6) for k in range(MANY)]
    assert looks(browser, "header") == wanted
    figures = browser.find_elements(By.CSS_SELECTOR, "#charts > figure, #further > figure")
    for number in range(len(figures)):
        assert looks(browser, f"#charts > figure:nth-of-type({number + 1})") == wanted
    inks = browser.execute_script(INKS)
    drawn = browser.execute_script("return gearcam.svg()")
    for k, ink in enumerate(inks):
        variants = [one for one in range(MANY) if one % 6 == k]
        assert drawn.count(f'stroke="{ink}"') >= 2 * len(variants), ink
    assert complaints(browser) == []


def test_dashes_tell_what_a_line_is(browser: Chrome, path: Path) -> None:
    """As often as a variant has lines; each dash once, below the variants."""
    charts = open_page(browser, path, WIDE)["charts"]
    (angles,) = (one for one in charts if one["name"] == "pressure_angle")
    figure = browser.find_elements(By.CSS_SELECTOR, "#charts > figure")[charts.index(angles)]
    told = figure.find_elements(By.CSS_SELECTOR, ".legend li.what")
    assert [one.text for one in told] == ["driving forward", "driving backward"]
    dashes = [
        one.find_element(By.CSS_SELECTOR, "path").get_attribute("stroke-dasharray") for one in told
    ]
    assert dashes == ["", "9 3"]
    rows = figure.find_elements(By.CSS_SELECTOR, ".legend li[data-variant]")
    assert [len(one.find_elements(By.TAG_NAME, "output")) for one in rows] == [2] * MANY


def test_the_variant_pointed_at_stands_out(browser: Chrome, path: Path) -> None:
    open_page(browser, path, WIDE)
    inks = browser.execute_script(INKS)
    plot = browser.find_element(By.CSS_SELECTOR, "#charts .plot")

    def seen() -> list[int]:
        settle(browser)
        return [browser.execute_script(COUNT, plot, one) for one in inks]

    before = seen()
    rows = browser.find_elements(By.CSS_SELECTOR, "header [data-variant]")
    ActionChains(browser).move_to_element(rows[3]).perform()
    after = seen()
    assert after[3] > 0.4 * before[3]  # its marked namesake stands back
    assert all(
        few < 0.2 * many for k, (few, many) in enumerate(zip(after, before, strict=True)) if k != 3
    )
    assert len(browser.find_elements(By.CSS_SELECTOR, ".chosen")) >= 4
    ActionChains(browser).move_to_element(browser.find_element(By.TAG_NAME, "h1")).perform()
    assert seen() == before


def test_nothing_is_cut_off(browser: Chrome, path: Path) -> None:
    open_page(browser, path, WIDE)
    (frame,) = browser.find_elements(By.CSS_SELECTOR, "#facts > .wide")
    assert frame.get_property("scrollWidth") == frame.get_property("clientWidth")
    wide = "const e = document.scrollingElement; return [e.scrollWidth, e.clientWidth]"
    assert browser.execute_script(wide) == [WIDE[0], WIDE[0]]


def test_members_of_a_variant_differ_in_dashes_in_the_picture(browser: Chrome, path: Path) -> None:
    open_page(browser, path, WIDE)
    drawn = browser.execute_script(DASHED)
    assert {name for name, _ in drawn} == {"gear1", "gear2"}
    for name, dashes in drawn:
        assert dashes == ([] if name == "gear1" else [9, 3])
    rows = browser.find_elements(By.CSS_SELECTOR, "#seen .member")
    assert [one.text.strip() for one in rows] == ["driver", "driven wheel"]
    told = [one.find_element(By.TAG_NAME, "path").get_attribute("stroke-dasharray") for one in rows]
    assert told == ["", "9 3"]
