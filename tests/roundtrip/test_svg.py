"""The picture is well-formed, to scale, complete, and its caption stands clear of the wheels."""

from __future__ import annotations

import importlib
import re
from typing import Any

import numpy as np
import pytest

from gearcam.export.svg import svg_bytes
from gearcam.kinds.gear_pair.drawings import pair_drawing
from gearcam.numeric.arrays import as_complex
from gearcam.parts.body import Part
from gearcam.parts.marks import timing_mark
from gearcam.pictures.drawings import Drawing, Path
from helpers_contour import bore, gear_contour
from helpers_curves import distances

etree: Any = importlib.import_module("lxml.etree")

SPACE = {"s": "http://www.w3.org/2000/svg"}


@pytest.fixture(scope="module")
def drawing() -> Drawing:
    contour = gear_contour(36, 5.0, squash=(1.0, 0.7))
    angle = np.linspace(0, 2 * np.pi, 400, endpoint=False)
    centrode = Path(points=90 * np.cos(angle) + 63j * np.sin(angle))
    parts = [
        Part(
            name=f"gear{k + 1}", contours=(contour,), openings=bore(40.0), width=50.0,
            marks=(timing_mark(85.0, k * np.pi, 5.0, 6.25, 50.0),),
        )
        for k in range(2)
    ]  # fmt: skip
    return pair_drawing(parts, 190.0, [centrode, centrode])


@pytest.fixture(scope="module")
def root(drawing: Drawing) -> Any:
    notes = ("centre distance 190 mm", "module 4.92299 mm", "teeth 36 : 36")
    return etree.fromstring(svg_bytes(drawing, title='Nails & "wire" <fast>', notes=notes))


def box(root: Any) -> tuple[float, float, float, float]:
    left, top, width, height = (float(v) for v in root.get("viewBox").split())
    return left, top, width, height


def polygon(root: Any, name: str) -> np.ndarray:
    data = root.find(f".//s:path[@class='{name}']", SPACE).get("d")
    assert re.fullmatch(r"M[-0-9. ]+Z", data)
    return np.array(data[1:-1].split(), dtype=float).reshape(-1, 2)


def test_the_outlines_are_where_they_belong(root: Any, drawing: Drawing) -> None:
    """In mm, y downwards, within the thinning; the second wheel at the centre distance."""
    for name, contour in zip(("gear1-outline", "gear2-outline"), drawing.contours, strict=True):
        drawn = as_complex(polygon(root, name) * [1, -1])
        away = distances(contour.points, drawn, np.zeros(len(drawn)))
        assert 1e-4 < away.max() < 0.0051
        assert len(drawn) < len(contour.vertices)


def test_every_feature_is_there(root: Any) -> None:
    found = [element.get("class") for element in root.iterfind(".//*[@class]")]
    wheels = [f"gear{k}-{kind}" for k in (1, 2) for kind in ("outline", "bore", "mark")]
    assert found == [*wheels, "centrode", "centrode", "center", "center"]
    assert all(p.get("stroke-dasharray") for p in root.iterfind(".//*[@class='centrode']"))
    marks = [float(root.find(f".//*[@class='gear{k}-mark']").get("cx")) for k in (1, 2)]
    assert 0 < marks[0] < 85 < 105 < marks[1] < 190
    bore = root.find(".//*[@class='gear2-bore']")
    assert (bore.get("cx"), bore.get("cy"), bore.get("r")) == ("190", "0", "20")


def test_the_caption_says_what_it_is_and_stays_clear(root: Any) -> None:
    first, second = root.findall(".//s:text", SPACE)
    assert first.text == root.find("s:title", SPACE).text == 'Nails & "wire" <fast>'
    assert second.text == "centre distance 190 mm, module 4.92299 mm, teeth 36 : 36"
    lowest = max(polygon(root, f"gear{k}-outline")[:, 1].max() for k in (1, 2))
    left, top, width, height = box(root)
    for text in (first, second):
        size, base = float(text.get("font-size")), float(text.get("y"))
        assert base - size > lowest
        assert base + 0.3 * size < top + height
        assert float(text.get("x")) + 0.6 * size * len(text.text) < left + width


def test_everything_lies_inside_the_view_box(root: Any) -> None:
    left, top, width, height = box(root)
    for k in (1, 2):
        points = polygon(root, f"gear{k}-outline")
        assert (points > [left, top]).all()
        assert (points < [left + width, top + height]).all()
    ground = root.find("s:rect", SPACE)
    assert ground.get("fill") == "#ffffff"
    assert float(ground.get("width")) == width
    assert int(root.get("width")) / int(root.get("height")) == pytest.approx(
        width / height, rel=1e-2
    )


def test_the_file_is_lean_and_repeatable(drawing: Drawing) -> None:
    data = svg_bytes(drawing, title="a")
    assert len(data) < 100_000
    assert data == svg_bytes(drawing, title="a")
    assert not re.search(rb"\d\.\d{5}|\de-\d|-0[ \"]", data)


def test_a_long_title_is_made_smaller(drawing: Drawing) -> None:
    root = etree.fromstring(svg_bytes(drawing, title="x" * 300))
    (text,) = root.findall(".//s:text", SPACE)
    left, _, width, _ = box(root)
    assert float(text.get("x")) + 0.6 * float(text.get("font-size")) * 300 < left + width


def test_nothing_is_not_drawn() -> None:
    with pytest.raises(ValueError, match="nothing to draw"):
        svg_bytes(Drawing(name="empty", features=()), title="a")
