"""The file format ``report``, for every kind of design, its solids, and the page in a notebook."""

from __future__ import annotations

from collections.abc import Mapping
from typing import TYPE_CHECKING, Any, Final

from gearcam.base.errors import GearcamError
from gearcam.base.inches import told
from gearcam.results.parts import Files

if TYPE_CHECKING:
    from gearcam.results.result import Result

CHORDS: Final = 0.02
"""Chord error of the solids shown, mm: finer ones look the same and make the page heavier."""

_FRAME: Final = "border:0;width:100%;height:min(85vh,760px);resize:vertical"
"""Style of a page in a notebook: parts and first charts in sight, the rest by scrolling."""


def report_files(result: Result, measured: Mapping[str, Any]) -> Files:
    """Return the page of a result, with facts measured on the files before it.

    Files: report.html.

    One page for the browser, which needs no network: the parts in motion, charts, solids, findings,
    facts, accuracy, and links to the other files.

    Parameters
    ----------
    result : Result
        Of any kind with reports.
    measured : mapping
        Facts measured on the files before it, by group.

    Returns
    -------
    dict of str to bytes
        The page by its name.
    """
    from gearcam.report.page import PAGE, document, page

    return {PAGE: page(document(result, measured), solids=solids_shown(result))}


def solids_shown(result: Result) -> dict[str, str]:
    """Return a view of the solids of a result, assembled.

    Parameters
    ----------
    result : Result
        Of any kind with reports.

    Returns
    -------
    dict
        ``view``, a page of its own; or ``refusal``, why there is none; empty without solids.
    """
    from gearcam.export.mesh import view_page

    refusal = ""
    # small teeth refuse the chords of the view: then those of the design are shown
    for chords in (CHORDS, 0.0):
        try:
            solids = result.standing(chords)
            return {"view": view_page(solids)} if solids else {}
        except GearcamError as error:
            refusal = str(told(error, result.design.units))
    return {"refusal": refusal}


def framed(result: Result) -> str:
    """Return the page of a `result`, without solids, as an HTML frame for a notebook."""
    from html import escape

    from gearcam.report.page import document, page

    shown = escape(page(document(result, seek=False)).decode())
    return (
        f'<iframe title="{escape(result.design.name)}" style="{_FRAME}" srcdoc="{shown}"></iframe>'
    )
