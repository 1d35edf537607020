"""What errors of mounting and making do to the transmission.

Nothing is linearised: flanks are brought into contact where the errors of an assembly (see
`gearcam.meshing.assembly`) have put them. An eccentric wheel's teeth turn about a centre that is
not theirs; wheels with an error of pitch touch with the tooth that is furthest ahead.

The *cycle* is the turn of the driver, or the turns after which the same teeth meet again. Over it
an assembly has a transmission error, a least backlash, and a least contact ratio: that of each pair
of teeth alone, the arc along which its flanks would touch if no other pair were ahead.

Refused: an error with which the wheels no longer reach each other.
"""

from __future__ import annotations

import math
from collections.abc import Callable, Mapping, Sequence
from dataclasses import dataclass
from functools import cached_property
from typing import TYPE_CHECKING, Final

import numpy as np

from gearcam.base.display import ShortRepr
from gearcam.base.errors import InfeasibleError
from gearcam.gears.contact import COAST, DRIVE, FlankPairs, Mounting, flank_pairs, turns_of_cycle
from gearcam.meshing.assembled import AssembledSide
from gearcam.meshing.assembly import Assembly, Gears
from gearcam.meshing.contact import contacts
from gearcam.meshing.edges import first_touch
from gearcam.meshing.harmonics import harmonics, too_few
from gearcam.numeric.arrays import Array, Mask
from gearcam.numeric.roots import bracketed_root

if TYPE_CHECKING:  # outlines need more than numpy
    from gearcam.meshing.overlap import Turning

_NARROW: Final = 1e-3
"""Width of the bracket of a largest error, as a share of it."""

_FARTHEST: Final = 1000.0
"""Largest multiple of an error at which its largest value is sought."""

_SMALLEST: Final = 1e-6
"""Smallest, below which it is 0."""


@dataclass(frozen=True, eq=False, kw_only=True)
class Running(ShortRepr):
    """How an assembly runs.

    Parameters
    ----------
    phi1 : (n,) array, rad
        Driver angles over the cycle.
    lead : (n,) array, rad, for a rack mm
        The driven wheel's turn from its nominal position, driven forward; infinite where nothing
        touches.
    backlash : (n,) array, mm
        Free travel of the driven wheel between both contacts, along the pitch curve.
    sections : tuple
        The wheels at the heights at which they may touch first.
    known_to : float, rad, for a rack mm
        How well `lead` is known: rounding, and chords of measured outlines.
    unit : str
        Unit of `lead`.
    noise : float, mm
        How well `backlash` is known: rounding, and chords of measured outlines.
    measured : bool
        Whether an outline was measured: its contact ratio is not known.
    """

    phi1: Array
    lead: Array
    backlash: Array
    sections: tuple[_Section, ...]
    known_to: float
    unit: str
    noise: float
    measured: bool = False

    @property
    def driving(self) -> tuple[FlankPairs, ...]:
        """The driving side of each section."""
        return tuple(section.sides[DRIVE] for section in self.sections)

    @property
    def contact_ratio(self) -> float | None:
        """Least contact ratio of all pairs of teeth on the driving side; None if not known."""
        if self.measured:
            return None
        return min(float(one.arcs.ratios.min()) for one in self.driving)

    @cached_property
    def peak_to_peak(self) -> float:
        """Transmission error, peak to peak, rad (mm): infinite where something does not touch."""
        if not np.isfinite(self.lead).all():
            return math.inf
        error = float(np.ptp(self.lead))
        return error if error > self.known_to else 0.0

    @property
    def least_backlash(self) -> float:
        """Least backlash, mm."""
        return float(self.backlash.min())

    @property
    def jams(self) -> bool:
        """Whether the wheels cannot be assembled without force, for their flanks."""
        return self.least_backlash < -self.noise

    @cached_property
    def interference(self) -> tuple[float, float] | None:
        """Where whole outlines overlap most: driver angle, rad, and how far, mm; or None.

        How far the driven wheel would have to turn for them to part, along the pitch curve, when it
        has no room to either side: flanks, tips, roots and fillets.
        """
        lead, back = _of_side([section.outline_lead for section in self.sections])
        room = (back - lead) * self.sections[0].phases[DRIVE].along
        chords = 2.0 * max(section.chord_error for section in self.sections)
        least = int(np.argmin(room))
        if room[least] >= -self.noise - chords / self.sections[0].cosine:
            return None
        return float(self.phi1[least]), -float(room[least])

    @property
    def error(self) -> Array:
        """Lag behind the nominal position without its mean, (n,), rad (mm): the error."""
        lag = np.where(np.isfinite(self.lead), -self.lead, np.nan)
        error = lag - float(np.nanmean(lag))
        return np.where(np.abs(error) <= self.known_to, 0.0, error)


def cycle(gears: Gears, steps: int, *, alike: bool) -> Array:
    """Return driver angles over a turn, or over the turns of a cycle.

    Parameters
    ----------
    gears : (Gear, Gear)
        The wheels.
    steps : int
        Number of angles in a turn, or in the travel of an open pair.
    alike : bool
        Whether wheel 2's teeth are alike, so that one turn of the driver is like the next.

    Returns
    -------
    (n,) array, rad
    """
    pairs = flank_pairs(gears, DRIVE)
    turns = 1 if alike else turns_of_cycle(gears)
    return np.linspace(0.0, pairs.travel * turns, steps * turns, endpoint=not pairs.closed)


@dataclass(frozen=True, eq=False, kw_only=True)
class Runs(ShortRepr):
    """How assemblies of a pair run; what is the same for all of them is computed once.

    Parameters
    ----------
    steps : sequence of (Gear, Gear)
        The wheels; of stepped wheels those of each step.
    width : float, mm
        Face width of all steps.
    phi1 : (n,) array, rad
        Driver angles.
    """

    steps: Sequence[Gears]
    width: float
    phi1: Array

    def of(self, assembly: Assembly) -> Running:
        """Return how an assembly runs.

        Parameters
        ----------
        assembly : Assembly
            Its errors.

        Returns
        -------
        Running

        Raises
        ------
        InfeasibleError
            If nothing touches at any of these angles.
        """
        sections = tuple(
            _Section(gears, assembly, mounting, self._phases[number])
            for number, gears in enumerate(self.steps)
            for mounting in assembly.mountings(gears[0].pair.shift, *self._heights(number))
        )
        first, measured = sections[0], assembly.measured
        lead, back = _of_side(
            [section.outline_lead if measured else section.lead for section in sections]
        )
        if not np.isfinite(lead).any():
            raise InfeasibleError(
                "with these errors the wheels do not reach each other",
                where="errors",
                nearest="give smaller errors",
            )
        along = first.phases[DRIVE].along
        least, most = float(np.abs(along).min()), float(np.abs(along).max())
        rounding = max(float(section.known_to.max()) for section in sections)
        chords = first.chord_error / first.cosine if measured else 0.0
        return Running(
            phi1=self.phi1,
            lead=lead,
            backlash=(back - lead) * along,
            sections=sections,
            known_to=rounding + chords / least,
            unit=first.phases[DRIVE].designed.guide.unit,
            noise=2.0 * (rounding * most + chords),
            measured=measured,
        )

    def _heights(self, number: int) -> tuple[float, float]:
        """Return the heights of both faces of a step over the middle of the face width, mm."""
        count = len(self.steps)
        return self.width * (number / count - 0.5), self.width * ((number + 1) / count - 0.5)

    @cached_property
    def _phases(self) -> list[dict[int, AssembledSide]]:
        return [
            {side: AssembledSide(gears=gears, side=side, phi1=self.phi1) for side in (DRIVE, COAST)}
            for gears in self.steps
        ]


def _of_side(leads: Sequence[Callable[[int], Array]]) -> list[Array]:
    """Return the leads at first contact of both sides in any of some sections."""
    return [
        -side * np.max([-side * lead(side) for lead in leads], axis=0) for side in (DRIVE, COAST)
    ]


@dataclass(frozen=True, eq=False)
class _Section:
    """Two wheels at a height, mounted.

    Parameters
    ----------
    gears : (Gear, Gear)
        The wheels.
    assembly : Assembly
        Their errors.
    mounting : Mounting
        Where they are.
    phases : mapping of int to AssembledSide
        Both sides at the driver angles.
    """

    gears: Gears
    assembly: Assembly
    mounting: Mounting
    phases: Mapping[int, AssembledSide]

    @cached_property
    def sides(self) -> dict[int, FlankPairs]:
        """Both sides."""
        return {side: flank_pairs(self.gears, side, self.mounting) for side in (DRIVE, COAST)}

    @cached_property
    def outlines(self) -> Turning:
        """The outlines, the measured ones in the place of the wheels' own."""
        from gearcam.meshing.half_teeth import half_teeth
        from gearcam.meshing.overlap import Turning

        one, two = (
            (half_teeth(gear.profile) if outline is None else outline).moved(
                gear.toothing, pitch, eccentric
            )
            for gear, outline, pitch, eccentric in zip(
                self.gears,
                self.assembly.outlines,
                self.mounting.pitch,
                self.mounting.eccentric,
                strict=True,
            )
        )
        rolling = self.gears[0].pair.rolling
        return Turning(rolling=rolling, driver=one, driven=two, distance=self.mounting.distance)

    @property
    def chord_error(self) -> float:
        """Chord errors of both outlines, mm."""
        return self.outlines.driver.chord_error + self.outlines.driven.chord_error

    @property
    def cosine(self) -> float:
        """Cosine of the pressure angle."""
        return math.cos(self.gears[0].toothing.cutter.alpha)

    @property
    def known_to(self) -> Array:
        """To how much leads are known, rad (for a rack mm), at each of the driver angles."""
        return self.phases[DRIVE].rounding.of(self.sides[DRIVE])

    def lead(self, side: int) -> Array:
        """Return the leads at first contact of flanks."""
        return self.phases[side].leads(self.mounting)

    def outline_lead(self, side: int) -> Array:
        """Return the leads at first contact of outlines."""
        from gearcam.meshing.measured import outline_leads

        return outline_leads(self.outlines, self.sides[side], self.phases[side].phi1)


def first_of(sections: list[FlankPairs], phi1: Array) -> tuple[Array, Mask]:
    """Return the lead at first contact of a side in any of some sections.

    Parameters
    ----------
    sections : list of FlankPairs
        The side in each of them.
    phi1 : (n,) array, rad
        AssembledSide.

    Returns
    -------
    lead, edge : (n,) arrays
        See `gearcam.meshing.edges.first_touch`.
    """
    side = sections[0].side
    leads, edges = zip(
        *(first_touch(one, phi1, contacts(one, phi1)) for one in sections), strict=True
    )
    first = np.argmax([-side * lead for lead in leads], axis=0), np.arange(len(phi1))
    return np.stack(leads)[first], np.stack(edges)[first]


def largest(excess: Callable[[float], float]) -> float | None:
    """Return the largest factor of an error that keeps a limit.

    Parameters
    ----------
    excess : callable
        ``excess(factor)`` of the error: below 0 if the error times the factor keeps the limit.

    Returns
    -------
    float or None
        To a thousandth, on the side that keeps it; infinite if a thousand times the error
        still does, 0 if not even a millionth of it does, and None if the pair does not keep it
        without the error.
    """
    if excess(0.0) >= 0.0:
        return None
    low, high = 0.5, 1.0
    while excess(high) < 0.0:
        if high == _FARTHEST:
            return math.inf
        low, high = high, min(2.0 * high, _FARTHEST)
    while excess(low) >= 0.0:
        low, high = 0.5 * low, low
        if high < _SMALLEST:
            return 0.0

    def values(factor: Array) -> Array:
        return np.array([excess(float(one)) for one in np.atleast_1d(factor)])

    tolerance = _NARROW * high
    found = float(bracketed_root(values, [low], [high], tolerance)[0])
    # the nearer end of the last bracket may lie beyond the limit
    return found if excess(found) < 0.0 else max(low, found - tolerance)


def of_error(running: Running, gears: Gears) -> list[dict[str, float]] | str:
    """Return the harmonics of a transmission error over whole turns of the driver.

    Parameters
    ----------
    running : Running
        A whole cycle.
    gears : (Gear, Gear)
        The wheels.

    Returns
    -------
    list of dict, or str
        Of the lag (see `gearcam.meshing.harmonics`), the largest first; or why there are none.
    """
    if not all(gear.toothing.closed for gear in gears):
        return "the wheels do not turn all around"
    if not np.isfinite(running.lead).all():
        return "in some phases nothing touches"
    count, teeth = len(running.phi1), gears[0].toothing.teeth
    turns = round(running.phi1[-1] * count / (count - 1) / (2.0 * math.pi))
    reason = too_few(count // turns, teeth)
    if reason:
        return reason
    found = harmonics(running.error, 0.0, turns, teeth, running.known_to, between=True)
    return sorted(found, key=lambda one: -one["amplitude"])
