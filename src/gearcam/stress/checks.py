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
from gearcam.base.readable import readable
from gearcam.laws.ratio.span import angle_text
from gearcam.meshing import force_checks as force_checks  # one check is of both studies
from gearcam.meshing.drive_checks import rows_text
from gearcam.meshing.settings import STRESS
from gearcam.numeric.arrays import Array, Ints

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
    loaded : bool
        Whether the tooth is among those that carry.
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
    loaded: bool
    certificate: Certificate
    yields: float | None

    @property
    def safety(self) -> float | None:
        """Yield stress over the largest stress along the edge; None without a yield stress.

        At the faces of a wheel nothing acts across, and this is the von Mises stress; in the middle
        of a wide wheel that is smaller (see `PlaneModuli.equivalent`).
        """
        return None if self.yields is None else self.yields / self.largest

    @property
    def largest(self) -> float:
        """The larger of tension and compression along the edge, MPa."""
        peaks = (self.certificate.tension, self.certificate.compression)
        return max(abs(one.stress) for one in peaks)

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
        Lag of the driven wheel.
    step : (k,) int array
        Phase of each contact.
    pressure : (k,) array, MPa
        Contact pressure; nan on an edge, and where nothing carries.
    edge_share : (n,) array
        Share of the load that the end of a flank carries.
    certified : tuple of CertifiedRoot
        Certified stresses.
    yielding : float, MPa
        Contact pressure at which either wheel first yields; infinite if unknown.
    unstated : (m,) array, rad
        Phases with a load at which no teeth carry, or friction locks them.
    held : str
        What was held where a wheel has no bore, in words; empty otherwise.
    """

    phi1: Array
    lag: Array
    step: Ints
    pressure: Array
    edge_share: Array
    certified: tuple[CertifiedRoot, ...]
    yielding: float
    unstated: Array
    held: str = ""

    @property
    def shares(self) -> str:
        """How teeth share the load, in words (see `Pressed`)."""
        return ", with the shares of elastic teeth,"

    def place_of(self, contact: int) -> str:
        """Return the phase of a contact in words."""
        return angle_text(float(self.phi1[self.step[contact]]))

    @property
    def edge_stretches(self) -> str:
        """Where the ends of flanks carry, in words."""
        return rows_text(self.phi1, self.edge_share != 0.0)


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

    Looks at: yield stress over the largest certified stress along the edge of the roots, less its
    error.
    """
    for one in pair.certified:
        if one.safety is None:
            continue
        sure = one.safety / (1.0 + one.certificate.error)
        if sure < limit:
            stress = readable(one.largest, "MPa", error=one.certificate.error * abs(one.largest))
            yield Remark(
                f"The root of this tooth has a stress of {stress}, within "
                f"{formatted(100.0 * one.certificate.error, 2)} %, which is taken off the safety.",
                one.where,
                sure,
                severity="error" if sure < 1.0 else "warning",
            )


@check("loaded-edge", kind=STRESS, severity="note", unit="%")
def loaded_edge(pair: StressedPair, limit: float) -> Iterator[Remark]:  # noqa: ARG001
    """Note tips that press on a flank with their edge, since teeth bend under the load.

    Looks at: which pairs of teeth carry that touch on an edge.
    """
    if pair.edge_share.any():
        yield Remark(
            "Teeth bend, so that the edge of the next tooth's tip carries up to this share of the "
            "load. The pressure there is not stated.",
            pair.edge_stretches,
            100.0 * float(pair.edge_share.max()),
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
    found = float(np.ptp(pair.lag))
    if limit and found > limit:
        place = angle_text(float(pair.phi1[int(pair.lag.argmax())]))
        message = "The lag of the driven wheel changes much over the turn."
        yield Remark(message, place, found / ARCSEC.factor, limit=limit / ARCSEC.factor)


@check("unloaded-root", kind=STRESS, severity="note")
def unloaded_root(pair: StressedPair, limit: float) -> Iterator[Remark]:  # noqa: ARG001
    """Note certified teeth that carry nothing at their phase.

    Looks at: the teeth in contact at the phases that are certified.
    """
    for one in pair.certified:
        if not one.loaded:
            yield Remark("This tooth carries nothing at this phase: its neighbours do.", one.where)


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
        yield Remark(f"A wheel has no bore: they are held on {pair.held}. The lag depends on it.")
