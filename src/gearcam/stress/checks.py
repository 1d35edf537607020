"""The checks of a pair's study of stress; importing this module registers them."""

from __future__ import annotations

from collections.abc import Iterator
from dataclasses import dataclass
from typing import TYPE_CHECKING

import numpy as np

from gearcam.base.display import ShortRepr
from gearcam.base.findings import Remark, check
from gearcam.base.numerals import formatted
from gearcam.base.quantities import ARCSEC, NUMBER, Param
from gearcam.laws.ratio.span import angle_text
from gearcam.meshing import force_checks as force_checks  # one check is of both studies
from gearcam.meshing.drive_checks import ranges_text
from gearcam.meshing.settings import STRESS
from gearcam.numeric.arrays import Array, Ints, Mask

if TYPE_CHECKING:
    from gearcam.stress.certify import Certificate


@dataclass(frozen=True, kw_only=True)
class CertifiedRoot(ShortRepr):
    """The certified stress of a wheel at a phase.

    Parameters
    ----------
    wheel, tooth : int
        The wheel, and its loaded tooth.
    phi1 : float, rad
        The phase.
    force : float, N
        Sum of the normal forces on the wheel.
    share : float
        Of the largest of them.
    certificate : Certificate
        The stress.
    yields : float or None, MPa
        Yield stress of the wheel.
    """

    wheel: int
    tooth: int
    phi1: float
    force: float
    share: float
    certificate: Certificate
    yields: float | None

    @property
    def safety(self) -> float | None:
        """Yield stress over the von Mises stress; None without a yield stress."""
        return None if self.yields is None else self.yields / self.certificate.von_mises

    @property
    def where(self) -> str:
        """The place in words."""
        return f"wheel {self.wheel}, tooth {self.tooth}, {angle_text(self.phi1)}"


@dataclass(frozen=True, eq=False, kw_only=True)
class StressedPair(ShortRepr):
    """A pair under load, with the stress of its roots.

    Parameters
    ----------
    phi1 : (n,) array, rad
        Phases.
    lag : (n,) array, rad
        Lag of the driven wheel; nan where nothing carries.
    step : (k,) int array
        Phase of each contact.
    pressure : (k,) array, MPa
        Contact pressure; nan on an edge, and where nothing carries.
    on_edge : (n,) bool array
        Where the end of a flank carries.
    certified : tuple of CertifiedRoot
        Certified stresses.
    yields : float or None, MPa
        The lower yield stress.
    unstated : (m,) array, rad
        Phases with a load at which no teeth carry, or friction locks them.
    held : str
        What was held where a wheel has no bore, in words; empty otherwise.
    """

    phi1: Array
    lag: Array
    step: Ints
    pressure: Array
    on_edge: Mask
    certified: tuple[CertifiedRoot, ...]
    yields: float | None
    unstated: Array
    held: str = ""

    def place_of(self, contact: int) -> str:
        """Return the phase of a contact in words."""
        return angle_text(float(self.phi1[self.step[contact]]))

    @property
    def edge_stretches(self) -> str:
        """Where the ends of flanks carry, in words."""
        rows = np.flatnonzero(self.on_edge)
        groups = np.split(rows, np.flatnonzero(np.diff(rows) > 1) + 1)
        return ranges_text([(float(self.phi1[x[0]]), float(self.phi1[x[-1]])) for x in groups])


@check(
    "root-stress",
    kind=STRESS,
    limit=("root_safety", Param(NUMBER, gt=0, doc="least safety of roots against yield"), 1.5),
    relation="at least",
    severity=("warning", "error"),
)
def root_stress(pair: StressedPair, limit: float) -> Iterator[Remark]:
    """Warn of a tooth root that may yield.

    It is an error where the safety is below 1.

    Looks at: yield stress over the certified von Mises stress of the roots, less its error.
    """
    for one in pair.certified:
        if one.safety is None:
            continue
        sure = one.safety / (1.0 + one.certificate.error)
        if sure < limit:
            yield Remark(
                f"The root of this tooth has a von Mises stress of "
                f"{formatted(one.certificate.von_mises, 4)} MPa.",
                one.where,
                sure,
                severity="error" if sure < 1.0 else "warning",
            )


@check("loaded-edge", kind=STRESS)
def loaded_edge(pair: StressedPair, limit: float) -> Iterator[Remark]:  # noqa: ARG001
    """Warn of tips that press on a flank with their edge, since teeth bend under the load.

    Looks at: which pairs of teeth carry that touch on an edge.
    """
    if pair.on_edge.any():
        yield Remark(
            "Teeth bend, so that the edge of the next tooth's tip carries, too: tip relief avoids "
            "it. The pressure there is not stated.",
            pair.edge_stretches,
        )


@check("unstated-stress", kind=STRESS)
def unstated_stress(pair: StressedPair, limit: float) -> Iterator[Remark]:  # noqa: ARG001
    """Warn of phases whose stress is not stated.

    Looks at: phases with a load at which neither flanks nor edges touch, or friction locks.
    """
    if pair.unstated.size:
        first = angle_text(float(pair.unstated[0]))
        yield Remark(
            "No teeth carry here, or friction locks them: these phases are in no largest value.",
            f"{first}, and {pair.unstated.size - 1} more phases",
        )


@check("stress-error", kind=STRESS, relation="at most", unit="%")
def stress_error(pair: StressedPair, limit: float) -> Iterator[Remark]:  # noqa: ARG001
    """Warn of a stress whose error is not as small as was asked for.

    Looks at: estimated errors of certified stresses.
    """
    for one in pair.certified:
        if not one.certificate.reached:
            yield Remark(
                "The stress is not known as well as was asked for: the mesh would be too large.",
                one.where,
                100.0 * one.certificate.error,
                limit=100.0 * one.certificate.tolerance,
            )


@check(
    "loaded-error",
    kind=STRESS,
    limit=(
        "loaded_error",
        Param(ARCSEC, ge=0, doc="largest lag of the driven wheel under load; 0: no limit"),
        0.0,
    ),
    relation="at most",
    unit="arcsec",
)
def loaded_error(pair: StressedPair, limit: float) -> Iterator[Remark]:
    """Warn of a large transmission error under load.

    Looks at: lag of the driven wheel, largest less smallest.
    """
    if not limit or np.isnan(pair.lag).all():
        return
    found = float(np.nanmax(pair.lag) - np.nanmin(pair.lag))
    if found > limit:
        place = angle_text(float(pair.phi1[int(np.nanargmax(pair.lag))]))
        message = "The lag of the driven wheel changes much over the turn."
        yield Remark(message, place, found / ARCSEC.factor, limit=limit / ARCSEC.factor)


@check("corner-stress", kind=STRESS, severity="note")
def corner_stress(pair: StressedPair, limit: float) -> Iterator[Remark]:  # noqa: ARG001
    """Note sharp corners, beside which no stress can be given.

    Looks at: re-entrant corners of the outlines with the teeth.
    """
    for wheel in sorted({one.wheel for one in pair.certified if one.certificate.corners}):
        yield Remark(
            "At sharp corners the stress of an elastic wheel has no limit: none is given beside "
            "them.",
            f"wheel {wheel}",
        )


@check("held", kind=STRESS, severity="note")
def held(pair: StressedPair, limit: float) -> Iterator[Remark]:  # noqa: ARG001
    """Note what holds a wheel without a bore: the lag depends on it.

    Looks at: bores, and held_diameter_mm.
    """
    if pair.held:
        yield Remark(f"A wheel has no bore: it is held on {pair.held}. The lag depends on it.")
