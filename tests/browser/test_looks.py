"""A page on a laptop, a phone and paper, in light and dark, and for those who do not see it."""

from __future__ import annotations

import base64
import re
from collections.abc import Callable
from pathlib import Path
from typing import Any

import pytest
from selenium.webdriver import ActionChains, Chrome, Keys
from selenium.webdriver.common.by import By

import gearcam
from gearcam.report.page import document, page
from gearcam.results.advice import remedies
from helpers_browser import LAPTOP, PHONE, complaints, go, open_page, settle, unfold, until
from helpers_pairs import PROFILES

NAIL = "nail_machine_two_phase"
TEXT, SHAPE = 4.5, 3.0
"""Least contrast of text and of what shows a shape or a control (WCAG 2.2, 1.4.3 and 1.4.11)."""

BuildOutput = Callable[[str], Path]


def luminance(colour: str) -> float:
    """Relative luminance of ``#rrggbb`` (WCAG 2.2)."""
    parts = [int(colour[k : k + 2], 16) / 255.0 for k in (1, 3, 5)]
    linear = [c / 12.92 if c <= 0.04045 else ((c + 0.055) / 1.055) ** 2.4 for c in parts]
    return 0.2126 * linear[0] + 0.7152 * linear[1] + 0.0722 * linear[2]


def contrast(one: str, other: str) -> float:
    low, high = sorted((luminance(one), luminance(other)))
    return (high + 0.05) / (low + 0.05)


@pytest.mark.parametrize("scheme", ["light", "dark"])
def test_colours_stand_out(scheme: str, browser: Chrome, page_of: BuildOutput) -> None:
    open_page(browser, page_of("groove_cam"), prefers_color_scheme=scheme)
    source = page_of("groove_cam").read_text("utf-8")
    names = set(re.findall(r"--([a-z]+(?:-[a-z0-9]+)*): #", source))
    script = """
    const style = getComputedStyle(document.documentElement);
    return arguments[0].map((name) => style.getPropertyValue(`--${name}`));
    """
    values = browser.execute_script(script, sorted(names))
    colour = {name: value.strip() for name, value in zip(sorted(names), values, strict=True)}
    assert (
        luminance(colour["ground"]) > 0.5
        if scheme == "light"
        else luminance(colour["ground"]) < 0.1
    )
    lines = [f"line-{k}" for k in range(1, 7)]
    for name in ("text", "muted", "accent", "error", "warning", "note", "limit"):
        assert min(contrast(colour[name], colour[on]) for on in ("ground", "page")) >= TEXT, name
    assert contrast(colour["on-accent"], colour["accent"]) >= TEXT
    for name in (*lines, "edge", "ink-1", "ink-2", "ink-3", "contact", "pitch", "centrode"):
        assert contrast(colour[name], colour["ground"]) >= SHAPE, name
    for k in (1, 2, 3):
        for name in (f"ink-{k}", "contact", "pitch", "centrode"):
            assert contrast(colour[name], colour[f"fill-{k}"]) >= SHAPE, name


@pytest.mark.parametrize(("name", "size"), [(NAIL, LAPTOP), (NAIL, PHONE), ("groove_cam", PHONE)])
def test_nothing_is_wider_than_the_window(
    name: str, size: tuple[int, int], browser: Chrome, page_of: BuildOutput
) -> None:
    open_page(browser, page_of(name), size)
    unfold(browser)
    wide = "const e = document.scrollingElement; return [e.scrollWidth, e.clientWidth]"
    assert browser.execute_script(wide) == [size[0], size[0]]


def test_on_a_phone_tables_are_whole_and_their_numbers_in_one_piece(
    browser: Chrome, page_of: BuildOutput
) -> None:
    open_page(browser, page_of("ring_ellipse"), PHONE)  # with the longest name that is solved
    unfold(browser)
    frames = """
    return [...document.querySelectorAll("section > details > .wide, #accuracy table")]
        .map((one) => [one.scrollWidth, one.clientWidth]);
    """
    widths = browser.execute_script(frames)
    assert len(widths) == 2
    assert all(within <= frame for within, frame in widths)
    pieces = """
    return [...document.querySelectorAll(".number")].map((one) => {
        const range = document.createRange();
        range.selectNodeContents(one);
        return [one.textContent, range.getClientRects().length];
    });
    """
    numbers = browser.execute_script(pieces)
    assert any("e-" in text for text, _ in numbers)
    assert {lines for _, lines in numbers} == {1}


@pytest.mark.parametrize(
    ("name", "leading"),
    [
        (NAIL, ["ratio", "pressure_angle", "contact_ratio"]),
        ("groove_cam", ["lift", "pressure_angle", "curvature"]),
    ],
)
def test_the_page_leads_with_what_decides_and_the_rest_is_folded(
    name: str, leading: list[str], browser: Chrome, page_of: BuildOutput
) -> None:
    document = open_page(browser, page_of(name), (1600, 1000))
    titles = {chart["name"]: chart["title"] for chart in document["charts"]}
    heads = browser.find_elements(By.CSS_SELECTOR, "h1, h2, h3, summary")
    seen = [one.text for one in heads if one.is_displayed() and one.tag_name != "summary"]
    decides = [document["title"], "Parts in motion", "Main numbers", "Findings"]
    decides += [titles[one] for one in leading]
    assert seen == [*decides, "Facts", "Accuracy", "Files"]
    folded = browser.find_elements(By.CSS_SELECTOR, "main details")
    assert not any(one.get_attribute("open") for one in folded)
    # numbers, picture and charts are side by side, and all three charts in the window
    charts = [one.rect for one in browser.find_elements(By.CSS_SELECTOR, "#charts > figure")]
    assert len({one["x"] for one in charts}) == 1
    assert charts[-1]["y"] + charts[-1]["height"] < 1000
    numbers, parts = (browser.find_element(By.ID, one).rect for one in ("main", "parts"))
    assert numbers["x"] + numbers["width"] < parts["x"]
    assert parts["x"] + parts["width"] < charts[0]["x"]
    browser.find_element(By.CSS_SELECTOR, "nav [href='#charts']").click()
    settle(browser)
    assert not any(one.get_attribute("open") for one in folded)
    browser.find_element(By.CSS_SELECTOR, "nav [href='#facts']").click()
    until(lambda: browser.find_element(By.CSS_SELECTOR, "#facts table").is_displayed())


def test_charts_of_studies_that_a_design_asks_for_are_in_sight(
    browser: Chrome, tmp_path: Path
) -> None:
    keys = {"output.studies": ["mesh"], "meshing.steps": 24}
    result = gearcam.build(gearcam.load(PROFILES / "ellipse.toml").with_(keys))
    path = tmp_path / "studied.html"
    path.write_bytes(page(document(result)))
    charts = open_page(browser, path)["charts"]
    studied = [one["title"] for one in charts if one["name"].startswith("mesh.")]
    assert studied
    figures = browser.find_elements(By.CSS_SELECTOR, "#charts > figure, #further > figure")
    titles = [one.find_element(By.TAG_NAME, "h3").text for one in figures]
    assert titles == [*(one["title"] for one in charts[:3]), *studied]
    for figure in figures:
        browser.execute_script("arguments[0].scrollIntoView()", figure)
        until(lambda figure=figure: figure.find_elements(By.TAG_NAME, "canvas"))
    folded = browser.find_element(By.CSS_SELECTOR, "#further details")
    assert len(folded.find_elements(By.TAG_NAME, "figure")) == len(charts) - len(titles)
    assert folded.text == f"{len(charts) - len(titles)} more charts"
    assert complaints(browser) == []


def test_a_page_without_moving_parts_shows_its_charts(
    browser: Chrome, page_of: BuildOutput
) -> None:
    source = page_of(NAIL)
    data = open_page(browser, source)
    still = source.with_name("still.html")
    still.write_bytes(page(data | {"scene": None}))
    charts = open_page(browser, still)["charts"]
    figures = browser.find_elements(By.CSS_SELECTOR, "#charts > figure, #further > figure")
    assert len(figures) == 3
    for figure in figures:
        browser.execute_script("arguments[0].scrollIntoView()", figure)
        until(lambda figure=figure: figure.find_elements(By.TAG_NAME, "canvas"))
    assert not browser.find_elements(By.ID, "motion")
    browser.execute_cdp_cmd("Page.printToPDF", {})
    until(lambda: len(browser.find_elements(By.CLASS_NAME, "uplot")) == len(charts))
    assert complaints(browser) == []


def test_paper_shows_all_charts_facts_and_errors(browser: Chrome, page_of: BuildOutput) -> None:
    document = open_page(browser, page_of(NAIL))
    script = """
    window.seen = [];
    const open = () => [...document.querySelectorAll("main details")].map((one) => one.open);
    const plots = () => document.querySelectorAll(".uplot").length;
    for (const name of ["beforeprint", "afterprint"]) {
        addEventListener(name, () => seen.push([open(), plots()]));
    }
    """
    browser.execute_script(script)
    browser.execute_cdp_cmd("Page.printToPDF", {})
    until(lambda: browser.execute_script("return seen.length === 2"))
    (paper, plots), (after, _) = browser.execute_script("return seen")
    # charts, facts but those by name, accuracy, files
    assert paper == [True, True, False, True, True]
    assert plots == len(document["charts"])
    assert not any(after)


def test_a_box_of_another_shape_is_drawn_before_it_is_shown(
    browser: Chrome, page_of: BuildOutput
) -> None:
    open_page(browser, page_of("groove_cam"))
    script = """
    const [done, canvas] = [arguments[0], document.getElementById("parts")];
    Object.assign(canvas.style, { width: "220px", height: "310px" });
    const tell = () => done([canvas.width, canvas.height, getComputedStyle(canvas).objectFit]);
    requestAnimationFrame(() => requestAnimationFrame(tell)); // the frame between is shown
    """
    # what is shown without being drawn, as on paper, keeps its proportions
    assert browser.execute_async_script(script) == [218, 308, "contain"]  # within the border


@pytest.mark.slow
@pytest.mark.parametrize("size", [LAPTOP, PHONE])
def test_remedies_stand_under_the_verdict_with_what_is_known_of_them(
    size: tuple[int, int], browser: Chrome, page_of: BuildOutput, built: Callable[[str], Any]
) -> None:
    open_page(browser, page_of("undercut_cam"), size)
    found = remedies(built("undercut_cam")).found
    told = [one.text for one in browser.find_elements(By.CSS_SELECTOR, "header #remedies li")]
    assert told == [f"{one.text} {one.notes}".strip() for one in found]
    assert any("still fails" in one for one in told)
    tops = [browser.find_element(By.ID, one).rect["y"] for one in ("verdict", "remedies", "moving")]
    assert tops == sorted(tops)
    assert tops[2] < size[1]


def test_on_a_phone_the_bar_stays_in_sight(browser: Chrome, page_of: BuildOutput) -> None:
    open_page(browser, page_of(NAIL), PHONE)
    browser.execute_script("document.getElementById('facts').scrollIntoView()")
    top = "return document.getElementById('controls').getBoundingClientRect().top"
    assert browser.execute_script(top) == 0


def test_all_that_is_worked_has_a_name(browser: Chrome, page_of: BuildOutput) -> None:
    open_page(browser, page_of(NAIL))
    unfold(browser)
    nodes: list[dict[str, Any]] = browser.execute_cdp_cmd("Accessibility.getFullAXTree", {})[
        "nodes"
    ]
    found: dict[str, list[str]] = {}
    for node in nodes:
        if not node["ignored"]:
            role = node["role"]["value"]
            found.setdefault(role, []).append(node.get("name", {}).get("value", ""))
    for role in (
        "button",
        "slider",
        "checkbox",
        "combobox",
        "image",
        "link",
        "region",
        "navigation",
    ):
        assert found[role], role
        assert all(found[role]), role
    assert (len(found["main"]), len(found["banner"])) == (1, 1)
    assert len(found["image"]) >= 7  # the parts and the charts
    assert len(set(found["button"])) == len(found["button"])


def test_tab_leads_from_the_picture_to_its_controls(browser: Chrome, page_of: BuildOutput) -> None:
    open_page(browser, page_of(NAIL))
    keys = ActionChains(browser).send_keys(Keys.TAB).send_keys(Keys.ENTER)
    keys.perform()
    order = []
    for _ in range(5):
        ActionChains(browser).send_keys(Keys.TAB).perform()
        order.append(browser.switch_to.active_element.get_attribute("id"))
    assert order in (
        ["parts", "play", "place", "speed", "fit"],
        ["play", "place", "speed", "fit", "mesh"],
    )


def test_paper_is_light_without_controls_and_leaves_no_trace(
    browser: Chrome, page_of: BuildOutput
) -> None:
    open_page(browser, page_of(NAIL), prefers_color_scheme="dark")
    until(lambda: browser.find_elements(By.CLASS_NAME, "uplot"))
    script = """
    window.seen = [];
    const pen = document.getElementById("parts").getContext("2d");
    const width = () => [...document.querySelectorAll(".uplot")].map((one) => one.clientWidth);
    const tell = () => seen.push([pen.getImageData(2, 2, 1, 1).data[0], width()]);
    tell();
    addEventListener("beforeprint", tell);
    addEventListener("afterprint", tell);
    """
    browser.execute_script(script)
    printed = browser.execute_cdp_cmd("Page.printToPDF", {})["data"]
    assert base64.b64decode(printed)[:5] == b"%PDF-"
    until(lambda: browser.execute_script("return seen.length === 3"))
    before, paper, after = browser.execute_script("return seen")
    assert (before[0] < 60, paper[0], after[0]) == (True, 255, before[0])
    assert after[1][: len(before[1])] == before[1]
    assert paper[1] == [640, *[312] * (len(paper[1]) - 1)]  # the first over both columns
    browser.execute_cdp_cmd("Emulation.setEmulatedMedia", {"media": "print"})
    for name in ("controls", "options"):
        assert not browser.find_element(By.ID, name).is_displayed()


@pytest.mark.slow
def test_another_document_keeps_place_view_and_choices(
    browser: Chrome, page_of: BuildOutput
) -> None:
    document = open_page(browser, page_of(NAIL))
    other = open_page(browser, page_of("ring_ellipse"))
    go(browser, 123.0)
    browser.find_element(By.ID, "nearer").click()
    box = browser.find_element(By.CSS_SELECTOR, "#seen input")
    box.click()
    shown = "return [gearcam.place, arguments[0].checked, arguments[0].isConnected]"
    browser.execute_script("gearcam.show(arguments[0])", document)
    settle(browser)
    assert browser.execute_script(shown, box) == [123.0, False, True]
    assert browser.find_element(By.ID, "parts").get_attribute("class") == "near"
    assert browser.title == browser.find_element(By.TAG_NAME, "h1").text == document["title"]
    draft = {key: other[key] for key in ("title", "scene")}
    draft["scene"] = {**other["scene"], "contacts": {}}
    draft["blocks"] = {"verdict": other["blocks"]["verdict"]}
    browser.execute_script("gearcam.show(arguments[0])", draft)
    settle(browser)
    assert browser.execute_script(shown, box) == [123.0, False, True]
    assert browser.find_element(By.TAG_NAME, "h1").text == other["title"]
    assert len(browser.find_elements(By.CLASS_NAME, "chart")) == len(document["charts"])
    assert complaints(browser) == []


def test_what_a_document_tells_is_no_markup(
    browser: Chrome, tmp_path: Path, page_of: BuildOutput
) -> None:
    document = open_page(browser, page_of("groove_cam"))
    bad = "</script><script>window.bad = 1</script><img src=x onerror='window.bad = 1'>"
    document["title"] = document["scene"]["title"] = document["scene"]["driver"] = bad
    contacts = document["scene"]["contacts"]
    document["scene"]["contacts"] = {bad + name: one for name, one in contacts.items()}
    for chart in document["charts"]:
        chart["title"] = chart["y"] = chart["lines"][0]["label"] = bad
    path = tmp_path / "bad.html"
    path.write_bytes(page(document))
    open_page(browser, path)
    assert browser.title == bad
    assert browser.execute_script("return window.bad") is None
    for told in (".chart h3", ".chart .unit", ".chart .legend li", "#side option", "#told"):
        assert "</script>" in browser.find_element(By.CSS_SELECTOR, told).text


COVERED = """
const covered = [];
for (const one of document.querySelectorAll("#rest > section")) {
  if (!one.clientHeight) continue;
  one.scrollIntoView({ block: "center" });
  const { left, top, width, height } = one.getBoundingClientRect();
  for (const share of [0.1, 0.35, 0.5, 0.65, 0.9]) {
    const seen = document.elementFromPoint(left + share * width, top + Math.min(0.5 * height, 200));
    if (!one.contains(seen)) covered.push(`${one.id} at ${share} by ${seen?.id}`);
  }
}
return covered;
"""


@pytest.mark.parametrize("size", [(1500, 950), (1100, 800), PHONE])
@pytest.mark.parametrize("name", [NAIL, "plate_cam_oscillating"])
def test_no_block_is_covered_by_another(
    name: str, size: tuple[int, int], browser: Chrome, page_of: BuildOutput
) -> None:
    open_page(browser, page_of(name), size)
    assert browser.execute_script(COVERED) == []
