"""Files for lasers are seen in a browser, and are hairlines for everything else."""

from __future__ import annotations

from pathlib import Path
from typing import Any

import pytest
from selenium.webdriver import Chrome

from gearcam.export.cut_svg import HAIRLINE, cut_svg
from gearcam.parts.blank import WheelBlank
from gearcam.parts.make import make_part
from gearcam.parts.openings import Workpiece
from gearcam.pictures.drawings import wheel_drawing
from helpers_contour import gear_contour

WIDTHS = """
const found = new Set();
for (const one of document.querySelectorAll("path")) {
  const style = getComputedStyle(one);
  found.add(style.strokeWidth + " " + style.vectorEffect + " " + style.stroke);
}
return [...found].sort();
"""
RED, BLUE = "rgb(255, 0, 0)", "rgb(0, 0, 255)"


@pytest.fixture
def widths(browser: Chrome, tmp_path: Path) -> dict[str, Any]:
    """Width, effect and colour of all lines, by the medium that shows them."""
    place = Workpiece(name="wheel 1", wheel=1, rim=10.0)
    blank = WheelBlank(bore_diameter=8.0, mark_diameter=1.0)
    part = make_part("gear1", [gear_contour(18, 4.0)], 5.0, blank, place)
    file = tmp_path / "cut.svg"
    file.write_bytes(cut_svg([wheel_drawing(part)], "one"))
    browser.get(file.as_uri())
    found = {}
    for medium in ("screen", "print"):
        browser.execute_cdp_cmd("Emulation.setEmulatedMedia", {"media": medium, "features": []})
        found[medium] = browser.execute_script(WIDTHS)
    browser.execute_cdp_cmd("Emulation.setEmulatedMedia", {"media": "", "features": []})
    return found


def test_lines_are_a_pixel_wide_on_a_screen_and_hairlines_in_print(widths: dict[str, Any]) -> None:
    effect = {"screen": "1px non-scaling-stroke", "print": f"{HAIRLINE}px none"}
    for medium, words in effect.items():
        assert {one.rpartition(" rgb")[0] for one in widths[medium]} == {words}
        assert {f"rgb{one.rpartition(' rgb')[2]}" for one in widths[medium]} <= {RED, BLUE}
