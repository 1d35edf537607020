"""The site of these pages; `make docs` builds it in build/docs."""

from __future__ import annotations

import re
from pathlib import Path
from typing import TYPE_CHECKING

import gearcam

if TYPE_CHECKING:
    from sphinx.application import Sphinx

DOCS = Path(__file__).parent

project = "gearcam"
author = "the gearcam authors"
copyright = f"2026 {author}"  # noqa: A001  (sphinx reads this name)
version = release = gearcam.__version__

extensions = ["myst_parser"]
myst_enable_extensions = ["dollarmath"]
smartquotes = False
myst_heading_anchors = 4  # anchors as git hosts make them

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
        trees.append("\n".join([start, f":caption: {caption}", "", *pages, end]))
    return "\n\n".join([text, *trees])


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
        text = shelves(source[0]) if name == "index" else source[0]
        source[0] = inside(text, (DOCS / name).parent)

    app.connect("source-read", read)
