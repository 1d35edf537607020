"""The solids of a page: a view of them where they stand, which opens when it is asked for."""

from __future__ import annotations

from typing import TYPE_CHECKING, Final

from gearcam.base.errors import GearcamError
from gearcam.designs.kind import KINDS

if TYPE_CHECKING:
    from gearcam.results.result import Result

CHORDS: Final = 0.02
"""Chord error of the solids shown, mm: finer ones look the same and make the page heavier."""


def solids_shown(result: Result) -> dict[str, str]:
    """Return a view of the solids of a result, assembled.

    Parameters
    ----------
    result : Result
        Of any kind with reports.

    Returns
    -------
    dict
        ``view``, a page of its own; or ``refusal``, why there is none.
    """
    from gearcam.export.mesh import view_page

    refusal = ""
    # small teeth refuse the chords of the view: then those of the design are shown
    for chords in (CHORDS, 0.0):
        try:
            fine = (result.design.output.chord_tolerance or 0.0) < chords
            shown = result.with_chords(chords) if fine else result
            return {"view": view_page(KINDS[result.design.kind].room("files").assembled(shown))}
        except GearcamError as error:
            refusal = str(error)
    return {"refusal": refusal}
