"""The site of these pages; `make docs` builds it in build/docs."""

from __future__ import annotations

import re
from functools import partial
from pathlib import Path
from typing import TYPE_CHECKING
from xml.etree import ElementTree as ET

import gearcam

if TYPE_CHECKING:
    from docutils import nodes
    from sphinx.application import Sphinx
    from sphinx.writers.html5 import HTML5Translator

DOCS = Path(__file__).parent
EXAMPLES = "examples"
"""Folder of the site with reports and design files of what the index shows."""

CARD = re.compile(r"\[(!\[[^\]]*\]\([^)]*\))\]\(\.\./profiles/(\w+)\.toml\)([^|\n]*)\|")
"""A picture of the index that leads to its design file: picture, name, title."""

LETTERS = 17
"""Size of letters in formulas, pixels."""

WAYS = "Each picture leads to its report, which moves; below it is the design file:"

project = "gearcam"
author = "the gearcam authors"
copyright = f"2026 {author}"  # noqa: A001  (sphinx reads this name)
version = release = gearcam.__version__

extensions = ["myst_parser"]
myst_enable_extensions = ["dollarmath"]
smartquotes = False
myst_heading_anchors = 4  # anchors as git hosts make them

html_math_renderer = "drawn"
html_theme = "furo"
html_title = f"gearcam {version}"
html_static_path = ["site.css"]
html_css_files = ["site.css"]


def shelves(text: str) -> str:
    """Return the index with its lists of links as the menu: a hidden toctree for each section."""
    trees = []
    start, end = "```{toctree}\n:hidden:", "```"
    for part in re.split(r"^## ", text, flags=re.MULTILINE)[1:]:
        caption = part.partition("\n")[0]
        pages = re.findall(r"^- .*?\]\(([\w/-]+)\.md\)", part, re.MULTILINE)
        if pages:
            trees.append("\n".join([start, f":caption: {caption}", "", *pages, end]))
    return "\n\n".join([text, *trees])


def cards(text: str) -> str:
    """Return the index whose pictures lead to a report and a design file, both in the site."""

    def card(found: re.Match[str]) -> str:
        picture, name, title = found[1], found[2], found[3].strip()
        page, file = (f"{EXAMPLES}/{name}.{end}" for end in ("html", "toml"))
        words = f'{title}<br><a href="{page}">report</a>, <a href="{file}">design file</a>'
        return f'<a href="{page}">{picture}</a><br>{words} |'

    text = text.replace("Each picture leads to the design file that made it:", WAYS)
    return CARD.sub(card, text)


def examples() -> list[str]:
    """Return the names of the profiles that the index shows."""
    return [found[2] for found in CARD.finditer((DOCS / "index.md").read_text("utf-8"))]


def write_examples(folder: Path) -> None:
    """Write reports and design files of the examples into a folder of the site."""
    from gearcam.report.file import solids_shown
    from gearcam.report.page import document, page

    folder.mkdir(exist_ok=True)
    for name in examples():
        file = DOCS.parent / "profiles" / f"{name}.toml"
        result = gearcam.build(gearcam.load(file))
        content = page(document(result), solids=solids_shown(result))
        (folder / f"{name}.html").write_bytes(content)
        (folder / file.name).write_bytes(file.read_bytes())


def set_formula(part: HTML5Translator, node: nodes.Element, *, block: bool) -> None:
    """Write a formula as a drawing, which needs no script, no network and no font of the reader."""
    import ziamath
    from docutils import nodes

    ziamath.config.svg2 = False  # letters as paths: no names that are there twice in a page
    text = node.astext()
    formula = ziamath.Latex(text, size=LETTERS, color="currentColor", inline=not block)
    drawn = formula.svgxml()
    drawn.set("style", f"vertical-align: {formula.getyofst():.2f}px")
    drawn.set("role", "img")
    drawn.set("aria-label", text)
    svg = ET.tostring(drawn, encoding="unicode")
    part.body.append(f'<div class="formula">{svg}</div>' if block else svg)
    raise nodes.SkipNode


def inside(text: str, folder: Path) -> str:
    """Return a page whose links to files outside of the site are their paths in the repository."""

    def path(found: re.Match[str]) -> str:
        target = (folder / found[2].partition("#")[0]).resolve()
        if target.is_relative_to(DOCS):
            return found[0]
        return f"{found[1]} (`{target.relative_to(DOCS.parent)}`)"

    return re.sub(r"(?<!!)\[([^\]]+)\]\((\.\.?/[^)\s]+)\)", path, text)


def setup(app: Sphinx) -> None:
    """Change pages as they are read."""

    def read(_: Sphinx, name: str, source: list[str]) -> None:
        text = cards(shelves(source[0])) if name == "index" else source[0]
        source[0] = inside(text, (DOCS / name).parent)

    def finish(app: Sphinx, problem: Exception | None) -> None:
        if problem is None:
            write_examples(Path(app.outdir) / EXAMPLES)

    app.connect("source-read", read)
    app.connect("build-finished", finish)
    inline, block = (partial(set_formula, block=one) for one in (False, True))
    app.add_html_math_renderer("drawn", (inline, None), (block, None))
