"""The checks of a study of errors; importing this module registers them."""

from __future__ import annotations

import math
from collections.abc import Iterator
from typing import Final

import numpy as np

from gearcam.base.findings import Remark, check
from gearcam.base.numerals import formatted
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


@check(TRANSMISSION, kind=ERRORS, limit=_LIMIT)
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


@check("jams", kind=ERRORS, severity="error", unit="mm")
def jams(together: Running, limit: float) -> Iterator[Remark]:  # noqa: ARG001
    """Report a pair that its errors press together: its backlash is negative.

    Looks at: least backlash over the cycle, all errors together.
    """
    least = together.least_backlash
    if least < -together.noise:
        angle = math.degrees(together.phi1[int(np.argmin(together.backlash))])
        yield Remark(
            "With its errors the pair jams: give it more backlash or a larger centre distance.",
            f"phi1 = {formatted(angle)} deg",
            least,
            limit=0.0,
        )


@check("nothing-touches", kind=ERRORS, severity="error", unit="phases")
def nothing_touches(together: Running, limit: float) -> Iterator[Remark]:  # noqa: ARG001
    """Report phases in which the errors keep all teeth apart.

    Looks at: contact of flanks and their edges at each phase.
    """
    apart = ~np.isfinite(together.lead)
    if apart.any():
        angle = math.degrees(together.phi1[int(np.argmax(apart))])
        yield Remark(
            "With these errors nothing touches in some phases.",
            f"first at phi1 = {formatted(angle)} deg",
            float(np.count_nonzero(apart)),
            limit=math.inf,
        )
