"""Pictures and tables as text: SVG and HTML.

A picture has a view box in millimetres with y downwards, strokes scaled to its size, a white
background and a caption below. `gearcam.export.svg` draws machines, `outlines` plain outlines.

Depends on numerals.
"""

from __future__ import annotations

import base64
from collections.abc import Callable, Iterable, Sequence
from functools import partial
from typing import TYPE_CHECKING, Any, Final
from xml.sax.saxutils import escape

from gearcam.base.numerals import decimal

if TYPE_CHECKING:
    from gearcam.base.facts import Facts, NamedFact

PIXELS: Final = 960
"""Default width of a picture, pixels."""

SHOWN: Final = 560
"""Largest height of a picture above a table, pixels."""

TALLEST: Final = 1.25
"""Largest height of a drawing relative to its width; a narrower one has room on both sides."""

MARGIN: Final = 0.04
"""Margin relative to the width of the drawing."""

FILLS: Final = ("#cfe0f2", "#f8e0c6", "#dcebd3")
INKS: Final = ("#27598c", "#a35f22", "#4d7a34")
"""Fills and strokes of wheel 1, of wheel 2 or a follower, and of the second of two cams."""

CENTRODE_INK: Final = "#5a5a5a"
TEXT_INK: Final = "#222222"
GROUND: Final = "#ffffff"

GLYPH: Final = 0.6
"""Upper estimate of the width of a letter relative to the font size."""

_number: Final = partial(decimal, decimals=4)

Corners = tuple[complex, complex]
"""Lower left and upper right corner, mm."""


def svg_document(attributes: str, title: str, elements: Iterable[str]) -> bytes:
    """Return an SVG file, UTF-8: root `attributes`, a `title`, and `elements` as lines."""
    lines = [
        '<?xml version="1.0" encoding="UTF-8"?>',
        f'<svg xmlns="http://www.w3.org/2000/svg" {attributes}>',
        f"<title>{escape(title)}</title>",
        *elements,
        "</svg>",
    ]
    return ("\n".join(lines) + "\n").encode()


def with_room(low: complex, high: complex) -> Corners:
    """Return the corners of a drawing with room on both sides if it is tall.

    Parameters
    ----------
    low, high : complex, mm
        Its lower left and upper right corner.

    Returns
    -------
    (low, high)
    """
    room = max(0.0, (high - low).imag / TALLEST - (high - low).real) / 2.0
    return low - room, high + room


def picture(
    lines: Sequence[str], corners: Corners, elements: Callable[[float], Iterable[str]]
) -> str:
    """Return a picture with its caption.

    Parameters
    ----------
    lines : sequence of str
        Lines of the caption; the first, in bold, is the title.
    corners : (low, high)
        Corners of the drawing, mm, y upwards.
    elements : callable
        ``elements(pixel)`` returns SVG elements; `pixel` is the size of a pixel, mm.

    Returns
    -------
    str
        SVG.
    """
    low, high = with_room(*corners)
    width = (high - low).real
    margin, pixel = MARGIN * width, width / PIXELS
    size = min(20 * pixel, width / (GLYPH * max([1, *map(len, lines)])))
    caption = size * 1.4 * len(lines)
    left, top = low.real - margin, -high.imag - margin
    whole = width + 2 * margin
    tall = (high - low).imag + 2 * margin + caption + 0.5 * margin
    view = " ".join(_number(value) for value in (left, top, whole, tall))
    base = -low.imag + margin + size
    ground = f'x="{_number(left)}" y="{_number(top)}"'
    ground += f' width="{_number(whole)}" height="{_number(tall)}" fill="{GROUND}"'
    sheet = f'viewBox="{view}" width="{PIXELS}" height="{round(PIXELS * tall / whole)}"'
    drawn = [
        f"<rect {ground}/>",
        f'<g stroke-linejoin="round" stroke-width="{_number(1.2 * pixel)}">',
        *elements(pixel),
        "</g>",
        *_caption(lines, low.real, base, size),
    ]
    return svg_document(f'{sheet} role="img"', lines[0], drawn).decode()


def _caption(lines: Sequence[str], left: float, base: float, size: float) -> list[str]:
    texts = []
    for row, line in enumerate(lines):
        place = f'x="{_number(left)}" y="{_number(base + 1.4 * size * row)}"'
        font = f'font-family="sans-serif" font-size="{_number(size)}" fill="{TEXT_INK}"'
        weight = ' font-weight="bold"' if row == 0 else ""
        texts.append(f"<text {place} {font}{weight}>{escape(line)}</text>")
    return texts


def outlines(
    lines: Sequence[str],
    closed: Sequence[Any],
    dashed: Sequence[Any] = (),
    *,
    wheel: int = 1,
    axis: bool = True,
) -> str:
    """Return a picture of the area inside outlines.

    Parameters
    ----------
    lines : sequence of str
        Lines of the caption; the first, in bold, is the title.
    closed : sequence of (n,) complex array, mm
        The outline and the openings in it.
    dashed : sequence of (n,) complex array, mm
        Open curves, drawn dashed.
    wheel : {1, 2}
        Wheel whose colours are used.
    axis : bool
        Whether to mark the origin with a cross.

    Returns
    -------
    str
        SVG.
    """
    points = [point for chain in (*closed, *dashed) for point in chain.tolist()] + [0j] * axis
    x, y = [point.real for point in points], [point.imag for point in points]
    low, high = complex(min(x), min(y)), complex(max(x), max(y))
    ink, fill = INKS[wheel - 1], FILLS[wheel - 1]

    def elements(pixel: float) -> Iterable[str]:
        area = "".join(f"M{_steps(chain)}Z" for chain in closed)
        yield f'<path fill="{fill}" fill-rule="evenodd" stroke="{ink}" d="{area}"/>'
        line = f'fill="none" stroke="{CENTRODE_INK}"'
        dash = f'stroke-dasharray="{_number(7 * pixel)} {_number(4 * pixel)}"'
        yield from (f'<path {line} {dash} d="M{_steps(chain)}"/>' for chain in dashed)
        if axis:
            arm = _number(12 * pixel)
            cross = f"M-{arm} 0 {arm} 0M0 -{arm} 0 {arm}"
            yield f'<path fill="none" stroke="{TEXT_INK}" d="{cross}"/>'

    return picture(lines, (low, high), elements)


def _steps(chain: Any) -> str:
    return " ".join(f"{_number(point.real)} {_number(-point.imag)}" for point in chain.tolist())


def page(drawn: str, facts: Facts, remarks: Sequence[str] = ()) -> str:
    """Return a picture and facts as HTML.

    Parameters
    ----------
    drawn : str
        The picture as SVG text; may be empty.
    facts : Facts
        The facts; if some are marked as shown, the others are folded below.
    remarks : sequence of str
        Remarks listed below the facts.

    Returns
    -------
    str
        HTML.
    """
    first, every = list(facts.shown()), list(facts.quantities())
    parts = [_image(drawn)] if drawn else []
    if facts.headline:
        parts.append(f"<p><b>{escape(', '.join(facts.headline))}</b></p>")
    parts.append(_table(first or every))
    if remarks:
        parts.append(f"<ul>{''.join(f'<li>{escape(one)}</li>' for one in remarks)}</ul>")
    if first and len(every) > len(first):
        more = f"<summary>all {len(every)} facts, by name</summary>{_table(every, named=True)}"
        parts.append(f"<details>{more}</details>")
    return f"<div>{''.join(parts)}</div>"


def refusal(title: str, error: Exception) -> str:
    """Return the message that `title` cannot be made because of `error`, as HTML."""
    why = escape(str(error).replace("; ", "\n"))
    return f"<div><p><b>{escape(title)} cannot be made</b></p><pre>{why}</pre></div>"


def refusal_picture(title: str, error: Exception) -> str:
    """Return the same message as a picture (see `refusal`)."""
    lines = [f"{title} cannot be made", *str(error).replace("; ", "\n").splitlines()]
    return picture(lines, (0j, complex(PIXELS)), lambda _: ())


def _image(drawn: str) -> str:
    """Return a picture as an ``img`` element, independent of styles and ids of the page."""
    data = base64.b64encode(drawn.encode()).decode()
    style = f"max-width:100%;max-height:{SHOWN}px"
    return f'<img alt="" style="{style}" src="data:image/svg+xml;base64,{data}"/>'


def _table(rows: Sequence[NamedFact], *, named: bool = False) -> str:
    cells = [
        (one.name if named else one.meaning, one.text, one.limit, one.place)
        for one in rows
        if one.text
    ]
    used = [any(column) for column in zip(*cells, strict=True)]
    lines = (
        "".join(
            f'<td style="text-align:left">{escape(cell)}</td>'
            for cell, there in zip(row, used, strict=True)
            if there
        )
        for row in cells
    )
    return f"<table>{''.join(f'<tr>{line}</tr>' for line in lines)}</table>"
