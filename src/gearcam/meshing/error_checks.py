"""The checks of a study of errors; importing this module registers them."""

from __future__ import annotations

import math
from collections.abc import Iterator
from typing import Final

import numpy as np

from gearcam.base.findings import Remark, check
from gearcam.base.numerals import FEW, formatted
from gearcam.base.quantities import ARCSEC, Param
from gearcam.meshing.errors import Running
from gearcam.meshing.settings import ERRORS

TRANSMISSION: Final = "transmission-error"
"""Code of the check whose limit decides how large an error may be."""

_LIMIT: Final = (
    "transmission_error",
    Param(ARCSEC, gt=0, le=360000, doc="largest transmission error, peak to peak, with errors"),
    600.0 * ARCSEC.factor,
)


@check(TRANSMISSION, kind=ERRORS, limit=_LIMIT, relation="at most")
def transmission_error(together: Running, limit: float) -> Iterator[Remark]:
    """Warn of a large transmission error with all errors together; not of a rack.

    Looks at: transmission error of the driven wheel, peak to peak, over the cycle.
    """
    error = together.peak_to_peak
    if together.unit == "rad" and limit < error < math.inf:
        yield Remark(
            "With its errors the driven wheel is far from its nominal position.",
            "all errors together",
            error / ARCSEC.factor,
        )


@check("jams", kind=ERRORS, relation="at least", severity="error", unit="mm")
def jams(together: Running, limit: float) -> Iterator[Remark]:  # noqa: ARG001
    """Report a pair that its errors press together: its backlash is negative.

    Looks at: least backlash over the cycle, all errors together.
    """
    if together.jams:
        yield Remark(
            "With its errors the pair jams: give it more backlash or a larger centre distance.",
            _place(together, int(np.argmin(together.backlash))),
            together.least_backlash,
            limit=0.0,
        )


@check("interference", kind=ERRORS, relation="at most", severity="error", unit="mm")
def interference(together: Running, limit: float) -> Iterator[Remark]:  # noqa: ARG001
    """Report wheels that their errors press into each other beside their flanks.

    Looks at: overlap of whole outlines over the cycle, with tips, roots and fillets, in the middle
    of the backlash; all errors together.
    """
    if together.interference is not None and not together.jams:
        phi1, depth = together.interference
        yield Remark(
            "With its errors tips reach into roots or fillets of the other wheel.",
            f"phi1 = {formatted(math.degrees(phi1), FEW)} deg",
            depth,
            limit=0.0,
        )


@check("contact-ratio", kind=ERRORS, relation="at least")
def contact_ratio(together: Running, limit: float) -> Iterator[Remark]:  # noqa: ARG001
    """Warn of a contact ratio below 1: tips and edges drive in turn with flanks.

    Looks at: least contact ratio of all pairs of teeth, all errors together.
    """
    ratio = together.contact_ratio
    if ratio is not None and ratio < 1.0:
        yield Remark(
            "With its errors a pair of teeth parts before the next one meets.",
            "all errors together",
            ratio,
            limit=1.0,
        )


@check("nothing-touches", kind=ERRORS, severity="error", unit="phases")
def nothing_touches(together: Running, limit: float) -> Iterator[Remark]:  # noqa: ARG001
    """Report phases in which the errors keep all teeth apart.

    Looks at: contact of flanks and their edges at each phase.
    """
    apart = ~np.isfinite(together.lead)
    if apart.any():
        yield Remark(
            "With these errors nothing touches in some phases.",
            f"first at {_place(together, int(np.argmax(apart)))}",
            float(np.count_nonzero(apart)),
        )


def _place(together: Running, phase: int) -> str:
    return f"phi1 = {formatted(math.degrees(together.phi1[phase]), FEW)} deg"
