"""Errors of mounting and making: what they do to the transmission, each alone and all together.

An *assembly* is a pair with its errors: the change of the centre distance, the eccentricities and
errors of pitch of both wheels, and the tilt of the driver's axis. Nothing is linearised: flanks are
brought into contact where their errors have put them (see `gearcam.gears.contact`). An eccentric
wheel's teeth turn about a centre that is not theirs; wheels with an error of pitch touch with the
tooth that is furthest ahead. A measured outline takes the place of a wheel's own flanks, and has
its errors of making. On tilted axes the section at a height z over the middle of the face
width is the plane pair with its shafts moved by z times the tilt, so that flanks touch first at one
of the faces; the sections' own change, of second order in the tilt, is left out.

The *cycle* is the turn of the driver, or the turns after which the same teeth meet again. Over it
an assembly has a transmission error, a least backlash, and a least contact ratio: that of each pair
of teeth alone, the arc along which its flanks would touch if no other pair were ahead.

Refused: an error with which the wheels no longer reach each other.
"""

from __future__ import annotations

import math
from collections.abc import Callable, Iterator, Mapping
from dataclasses import dataclass, field, replace
from functools import cached_property
from typing import TYPE_CHECKING, Final

import numpy as np

from gearcam.base.display import ShortRepr
from gearcam.base.errors import InfeasibleError
from gearcam.gears.contact import (
    COAST,
    DRIVE,
    FlankPairs,
    Mounting,
    flank_pairs,
    turns_of_cycle,
)
from gearcam.gears.pair import Gear
from gearcam.meshing.contact import contacts
from gearcam.meshing.edges import first_touch, known_to, to_pitch_line
from gearcam.meshing.harmonics import harmonics, too_few
from gearcam.meshing.settings import ErrorsSpec
from gearcam.numeric.arrays import Array, Mask
from gearcam.numeric.roots import bracketed_root

if TYPE_CHECKING:  # outlines need more than numpy
    from gearcam.meshing.half_teeth import HalfTeeth

Gears = tuple[Gear, Gear]

_NARROW: Final = 1e-3
"""Width of the bracket of a largest error, as a share of it."""

_FARTHEST: Final = 1000
"""Largest multiple of an error at which its largest value is sought."""


@dataclass(frozen=True, eq=False, kw_only=True)
class Assembly(ShortRepr):
    """The errors of a pair.

    Parameters
    ----------
    center : float, mm
        Added to the centre distance; for a rack, its distance from the design position.
    eccentric : (complex, complex), mm
        Offset of the teeth of both wheels from their shafts, in the wheel's frame.
    pitch : (mapping of int to float, mapping of int to float), mm
        Errors of teeth along the pitch curve, by number.
    tilt : complex, rad
        Of the driver's axis: in the plane of the axes, positive if they part towards the front, and
        across it.
    outlines : (HalfTeeth or None, HalfTeeth or None)
        Measured outlines in the place of the wheels' own.
    """

    center: float = 0.0
    eccentric: tuple[complex, complex] = (0j, 0j)
    pitch: tuple[Mapping[int, float], Mapping[int, float]] = field(default_factory=lambda: ({}, {}))
    tilt: complex = 0j
    outlines: tuple[HalfTeeth | None, HalfTeeth | None] = (None, None)

    def times(self, factor: float) -> Assembly:
        """Return the assembly with all errors but outlines multiplied by a `factor`."""
        one, two = ({k: factor * v for k, v in errors.items()} for errors in self.pitch)
        return replace(
            self,
            center=factor * self.center,
            eccentric=(factor * self.eccentric[0], factor * self.eccentric[1]),
            pitch=(one, two),
            tilt=factor * self.tilt,
        )

    @property
    def none(self) -> bool:
        """Whether there are no errors."""
        moved = self.center or self.tilt or any(self.eccentric) or any(self.pitch)
        return not (moved or self.measured)

    @property
    def alike(self) -> bool:
        """Whether the teeth of a wheel are alike, so that one turn is like the next."""
        return not (self.measured or self.mounting(0.0).turns_differ)

    @property
    def measured(self) -> bool:
        """Whether an outline was measured."""
        return any(outline is not None for outline in self.outlines)

    def mounting(self, distance: float, height: float = 0.0) -> Mounting:
        """Return how the pair is mounted.

        Parameters
        ----------
        distance : float, mm
            Position of the driven frame without errors; negative for a ring.
        height : float, mm
            Over the middle of the face width, on tilted axes.
        """
        outward = math.copysign(1.0, distance)
        move = height * complex(outward * self.tilt.real, self.tilt.imag)
        return Mounting(
            distance=distance + outward * self.center + move,
            eccentric=self.eccentric,
            pitch=self.pitch,
        )

    def mountings(self, distance: float, low: float, high: float) -> list[Mounting]:
        """Return how the pair is mounted where it touches first: on tilted axes at both faces.

        Parameters
        ----------
        distance : float, mm
            See `mounting`.
        low, high : float, mm
            Heights of the faces over the middle of the face width.
        """
        return [self.mounting(distance, z) for z in ((low, high) if self.tilt else (0.0,))]


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
    driving : tuple of FlankPairs
        The driving side, on tilted axes in both faces.
    known_to : float, rad, for a rack mm
        Rounding of `lead`.
    unit : str
        Unit of `lead`.
    noise : float, mm
        Rounding of `backlash`.
    measured : bool
        Whether an outline was measured: its contact ratio is not known.
    """

    phi1: Array
    lead: Array
    backlash: Array
    driving: tuple[FlankPairs, ...]
    known_to: float
    unit: str
    noise: float
    measured: bool = False

    @property
    def contact_ratio(self) -> float | None:
        """Least contact ratio of all pairs of teeth on the driving side; None if not known."""
        if self.measured:
            return None
        return min(float(one.contact_ratios.min()) for one in self.driving)

    @cached_property
    def peak_to_peak(self) -> float:
        """Transmission error, peak to peak, rad (mm): infinite where something does not touch."""
        if not np.isfinite(self.lead).all():
            return math.inf
        error = float(np.ptp(self.lead))
        return error if error > self.known_to else 0.0

    @property
    def least_backlash(self) -> float:
        """Least backlash, mm; negative if the wheels cannot be assembled without force."""
        return float(self.backlash.min())

    @property
    def error(self) -> Array:
        """Lag behind the nominal position without its mean, (n,), rad (mm): the error."""
        lag = np.where(np.isfinite(self.lead), -self.lead, np.nan)
        error = lag - float(np.nanmean(lag))
        return np.where(np.abs(error) <= self.known_to, 0.0, error)


def demand(gears: Gears, assembly: Assembly) -> None:
    """Refuse errors of teeth and shafts that a pair does not have.

    Parameters
    ----------
    gears : (Gear, Gear)
        The wheels.
    assembly : Assembly
        Their errors.

    Raises
    ------
    InfeasibleError
        If there is one.
    """
    for gear, errors in zip(gears, assembly.pitch, strict=True):
        toothing = gear.toothing
        missing = sorted(set(errors) - set(toothing.numbers[toothing.whole]))
        if missing:
            raise InfeasibleError(
                f"the file has an error of pitch of a tooth that wheel {gear.wheel} does not have",
                where="errors.file",
                value=float(missing[0]),
                nearest=f"its teeth are 1 to {toothing.teeth}",
            )
    if gears[0].pair.on_rack and assembly.eccentric[1]:
        raise InfeasibleError(
            "a rack has no shaft, and so no eccentricity",
            where="errors.eccentricity_mm[1]",
            value=abs(assembly.eccentric[1]),
            unit="mm",
            nearest="give 0 for wheel 2",
        )


def cycle(gears: Gears, steps: int, *, alike: bool) -> Array:
    """Return driver angles over a turn, or over the turns of a cycle.

    Parameters
    ----------
    gears : (Gear, Gear)
        The wheels.
    steps : int
        Number of angles in a turn, or in the travel of an open pair.
    alike : bool
        Whether the teeth of a wheel are alike, so that one turn is like the next.

    Returns
    -------
    (n,) array, rad
    """
    pairs = flank_pairs(gears, DRIVE)
    turns = 1 if alike else turns_of_cycle(gears)
    return np.linspace(0.0, pairs.travel * turns, steps * turns, endpoint=not pairs.closed)


def run(gears: Gears, width: float, assembly: Assembly, phi1: Array) -> Running:
    """Return how an assembly runs.

    Parameters
    ----------
    gears : (Gear, Gear)
        The wheels.
    width : float, mm
        Their face width.
    assembly : Assembly
        Their errors.
    phi1 : (n,) array, rad
        Driver angles.

    Returns
    -------
    Running

    Raises
    ------
    InfeasibleError
        If nothing touches at any of these angles.
    """
    mountings = assembly.mountings(gears[0].pair.shift, -0.5 * width, 0.5 * width)
    sections = [
        {side: flank_pairs(gears, side, mounting) for side in (DRIVE, COAST)}
        for mounting in mountings
    ]
    driving = tuple(section[DRIVE] for section in sections)
    if assembly.measured:
        lead, back = _of_outlines(gears, assembly, mountings, sections, phi1)
    else:
        lead, back = (
            first_of([section[side] for section in sections], phi1)[0] for side in (DRIVE, COAST)
        )
    if not np.isfinite(lead).any():
        raise InfeasibleError(
            "with these errors the wheels do not reach each other",
            where="errors",
            nearest="give smaller errors",
        )
    along = to_pitch_line(driving[0], phi1)
    rounding = max(float(known_to(one, phi1).max()) for one in driving)
    return Running(
        phi1=phi1,
        lead=lead,
        backlash=(back - lead) * along,
        driving=driving,
        known_to=rounding,
        unit=driving[0].guide.unit,
        noise=2.0 * rounding * float(np.abs(along).max()),
        measured=assembly.measured,
    )


def _of_outlines(
    gears: Gears,
    assembly: Assembly,
    mountings: list[Mounting],
    sections: list[dict[int, FlankPairs]],
    phi1: Array,
) -> list[Array]:
    """Return the leads of both sides of wheels of which an outline was measured."""
    from gearcam.meshing.half_teeth import half_teeth
    from gearcam.meshing.measured import outline_leads
    from gearcam.meshing.overlap import Turning

    one, two = (
        (half_teeth(gear.profile) if outline is None else outline).moved(
            gear.toothing, pitch, eccentric
        )
        for gear, outline, pitch, eccentric in zip(
            gears, assembly.outlines, assembly.pitch, assembly.eccentric, strict=True
        )
    )
    turnings = [
        Turning(rolling=gears[0].pair.rolling, driver=one, driven=two, distance=mounting.distance)
        for mounting in mountings
    ]
    return [
        -side
        * np.max(
            [
                -side * outline_leads(turning, section[side], phi1)
                for turning, section in zip(turnings, sections, strict=True)
            ],
            axis=0,
        )
        for side in (DRIVE, COAST)
    ]


def first_of(sections: list[FlankPairs], phi1: Array) -> tuple[Array, Mask]:
    """Return the lead at first contact of a side in any of some sections.

    Parameters
    ----------
    sections : list of FlankPairs
        The side in each of them.
    phi1 : (n,) array, rad
        Phases.

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


def given(spec: ErrorsSpec) -> Assembly:
    """Return the errors that a design gives, without its tolerances.

    Parameters
    ----------
    spec : ErrorsSpec
        The settings.

    Returns
    -------
    Assembly
    """
    one, two = (
        size * complex(math.cos(angle), math.sin(angle))
        for size, angle in zip(spec.eccentricity, spec.eccentricity_angle, strict=True)
    )
    return Assembly(
        center=spec.center, eccentric=(one, two), pitch=spec.pitch_errors, tilt=complex(*spec.tilt)
    )


def alone(assembly: Assembly) -> dict[str, Assembly]:
    """Return each of the errors of an assembly alone.

    Parameters
    ----------
    assembly : Assembly
        All errors.

    Returns
    -------
    dict of str to Assembly
        By name, those that are not 0.
    """
    one, two = assembly.eccentric
    first, second = assembly.pitch
    every = {
        "center": Assembly(center=assembly.center),
        "eccentricity1": Assembly(eccentric=(one, 0j)),
        "eccentricity2": Assembly(eccentric=(0j, two)),
        "pitch1": Assembly(pitch=(first, {})),
        "pitch2": Assembly(pitch=({}, second)),
        "tilt": Assembly(tilt=assembly.tilt),
        "outline1": Assembly(outlines=(assembly.outlines[0], None)),
        "outline2": Assembly(outlines=(None, assembly.outlines[1])),
    }
    there = (
        *(assembly.center, one, two, any(first.values()), any(second.values()), assembly.tilt),
        *(outline is not None for outline in assembly.outlines),
    )
    return {name: each for (name, each), some in zip(every.items(), there, strict=True) if some}


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
        still does, and None if the pair does not keep it without the error.
    """
    if excess(0.0) >= 0.0:
        return None
    low, high = 0.0, 1.0
    while excess(high) < 0.0:
        low, high = high, 2.0 * high
        if high > _FARTHEST:
            return math.inf
    while not low and high > 1.0 / _FARTHEST:
        if excess(0.5 * high) < 0.0:
            low = 0.5 * high
        else:
            high *= 0.5

    def values(factor: Array) -> Array:
        return np.array([excess(float(one)) for one in np.atleast_1d(factor)])

    tolerance = _NARROW * high
    found = float(bracketed_root(values, [low], [high], tolerance)[0])
    # the nearer end of the last bracket may lie beyond the limit
    return found if excess(found) < 0.0 else max(low, found - tolerance)


def random_assemblies(spec: ErrorsSpec, gears: Gears) -> Iterator[Assembly]:
    """Yield the random assemblies of a design's tolerances.

    Parameters
    ----------
    spec : ErrorsSpec
        Errors, tolerances and their distribution; the same `seed` gives the same assemblies.
    gears : (Gear, Gear)
        The wheels.

    Yields
    ------
    Assembly
    """
    middle, random = given(spec), np.random.default_rng(spec.seed)

    def within(tolerance: float, count: int = 1) -> Array:
        if spec.distribution == "uniform":
            return random.uniform(-tolerance, tolerance, count)
        return random.normal(0.0, tolerance / 3.0, count)

    for _ in range(spec.trials):
        (center,) = within(spec.center_tolerance)
        tilt = [float(within(tolerance)[0]) for tolerance in spec.tilt_tolerance]
        moved = [
            abs(within(tolerance)[0]) * np.exp(1j * random.uniform(0.0, 2.0 * math.pi))
            for tolerance in spec.eccentricity_tolerance
        ]
        pitch = [
            {
                number: errors.get(number, 0.0) + error
                for number, error in zip(
                    gear.toothing.numbers,
                    within(spec.pitch_tolerance, len(gear.toothing.numbers)).tolist(),
                    strict=True,
                )
            }
            for gear, errors in zip(gears, middle.pitch, strict=True)
        ]
        yield replace(
            middle,
            center=middle.center + float(center),
            tilt=middle.tilt + complex(*tilt),
            eccentric=(
                middle.eccentric[0] + complex(moved[0]), middle.eccentric[1] + complex(moved[1]),
            ),
            pitch=(pitch[0], pitch[1]) if spec.pitch_tolerance else middle.pitch,
        )  # fmt: skip


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
