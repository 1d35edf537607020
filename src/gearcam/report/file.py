"""The kind of file ``report``, of every kind of design."""

from __future__ import annotations

from collections.abc import Mapping
from typing import TYPE_CHECKING, Any

if TYPE_CHECKING:
    from gearcam.export.shared import Files
    from gearcam.result import Result


def report_files(result: Result, measured: Mapping[str, Any]) -> Files:
    """Return the page of a `result`, with what was `measured` on the files before it."""
    from gearcam.report.page import PAGE, document, page
    from gearcam.report.solids import solids_shown

    return {PAGE: page(document(result, measured), solids=solids_shown(result))}
