"""The file format ``report``, for every kind of design, and the page in a notebook."""

from __future__ import annotations

from collections.abc import Mapping
from typing import TYPE_CHECKING, Any, Final

if TYPE_CHECKING:
    from gearcam.export.shared import Files
    from gearcam.results.result import Result

_FRAME: Final = "border:0;width:100%;height:min(85vh,760px);resize:vertical"
"""Style of a page in a notebook: parts and first charts in sight, the rest by scrolling."""


def report_files(result: Result, measured: Mapping[str, Any]) -> Files:
    """Return the page of a `result`, with what was `measured` on the files before it.

    Files: report.html.

    One page for the browser, which needs no network: the parts in motion, charts, solids, findings,
    facts, accuracy, and links to the other files.

    Parameters
    ----------
    result : Result
        Of any kind with reports.
    measured : mapping
        What was measured on the files before it.

    Returns
    -------
    dict of str to bytes
        The page by its name.
    """
    from gearcam.report.page import PAGE, document, page
    from gearcam.report.solids import solids_shown

    return {PAGE: page(document(result, measured), solids=solids_shown(result))}


def framed(result: Result) -> str:
    """Return the page of a `result`, without solids, as an HTML frame for a notebook."""
    from html import escape

    from gearcam.report.page import document, page

    shown = escape(page(document(result, seek=False)).decode())
    return (
        f'<iframe title="{escape(result.design.name)}" style="{_FRAME}" srcdoc="{shown}"></iframe>'
    )
