"""Errors of mounting and making: those that a design gives, each alone, and at random.

An *assembly* is a pair with its errors: the change of the centre distance, the eccentricities and
errors of pitch of both wheels, and the tilt of the driver's axis. A measured outline takes the
place of a wheel's own flanks, and has its errors of making. On tilted axes the section at a height
z over the middle of the face width is the plane pair with its shafts moved by z times the tilt, so
that flanks touch first at one of the faces; the sections' own change, of second order in the tilt,
is left out.

Refused: an error of teeth or shafts that a pair does not have, or that is larger than its teeth.
"""

from __future__ import annotations

import math
from collections.abc import Iterator, Mapping
from dataclasses import dataclass, field, replace
from typing import TYPE_CHECKING, Final

import numpy as np

from gearcam.base.display import ShortRepr
from gearcam.base.errors import InfeasibleError
from gearcam.gears.contact import Mounting
from gearcam.gears.pair import Gear
from gearcam.meshing.settings import ErrorsSpec
from gearcam.numeric.arrays import Array

if TYPE_CHECKING:  # outlines need more than numpy
    from gearcam.meshing.half_teeth import HalfTeeth

Gears = tuple[Gear, Gear]

_SHARE: Final = 0.25
"""Largest error of pitch, in pitches."""


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
        """Whether wheel 2's teeth are alike, so that one turn of the driver is like the next."""
        return self.outlines[1] is None and not self.mounting(0.0).turns_differ

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
        return Mounting(
            distance=distance + outward * self.center + height * self.lean(distance),
            eccentric=self.eccentric,
            pitch=self.pitch,
        )

    def lean(self, distance: float) -> complex:
        """Return how far the driven shaft moves along x and y for each mm of height.

        Parameters
        ----------
        distance : float, mm
            Position of the driven frame; negative for a ring.
        """
        return complex(math.copysign(1.0, distance) * self.tilt.real, self.tilt.imag)

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


def demand(gears: Gears, assembly: Assembly, spec: ErrorsSpec | None = None) -> None:
    """Refuse errors of teeth and shafts that a pair does not have.

    Parameters
    ----------
    gears : (Gear, Gear)
        The wheels.
    assembly : Assembly
        Their errors.
    spec : ErrorsSpec, optional
        Their tolerances.

    Raises
    ------
    InfeasibleError
        If there is one.
    """
    for gear, errors in zip(gears, assembly.pitch, strict=True):
        numbers = gear.toothing.numbers[gear.toothing.whole]
        missing = sorted(set(errors) - set(numbers))
        if missing:
            raise InfeasibleError(
                f"the file has an error of pitch of a tooth that wheel {gear.wheel} does not have",
                where="errors.file",
                value=float(missing[0]),
                nearest=f"its teeth are {numbers[0]} to {numbers[-1]}",
            )
        largest = max(map(abs, errors.values()), default=0.0)
        _demand_below_pitch(gear, "file", largest)
        if spec is not None:
            _demand_below_pitch(gear, "pitch_tolerance_mm", spec.pitch_tolerance)
    if gears[0].pair.on_rack:
        tolerances = (0.0, 0.0) if spec is None else spec.eccentricity_tolerance
        for key, size in (
            ("eccentricity_mm", abs(assembly.eccentric[1])),
            ("eccentricity_tolerance_mm", tolerances[1]),
        ):
            if size:
                raise InfeasibleError(
                    "a rack has no shaft, and so no eccentricity",
                    where=f"errors.{key}[1]",
                    value=size,
                    unit="mm",
                    nearest="give 0 for wheel 2",
                )


def _demand_below_pitch(gear: Gear, key: str, error: float) -> None:
    """Refuse an error of pitch that brings a tooth into the place of the next."""
    limit = _SHARE * math.pi * gear.pair.module
    if error > limit:
        raise InfeasibleError(
            f"an error of pitch of wheel {gear.wheel} is larger than a quarter of the pitch",
            where=f"errors.{key}",
            value=error,
            limit=limit,
            unit="mm",
            nearest="give errors in mm",
        )


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


def random_assemblies(spec: ErrorsSpec, gears: Gears, middle: Assembly) -> Iterator[Assembly]:
    """Yield the random assemblies of a design's tolerances.

    Parameters
    ----------
    spec : ErrorsSpec
        Tolerances and their distribution; the same `seed` gives the same assemblies.
    gears : (Gear, Gear)
        The wheels.
    middle : Assembly
        The errors to which random ones are added.

    Yields
    ------
    Assembly
    """
    random = np.random.default_rng(spec.seed)

    def within(tolerance: float, count: int = 1) -> Array:
        if spec.distribution == "uniform":
            return random.uniform(-tolerance, tolerance, count)
        return random.normal(0.0, tolerance / 3.0, count)

    for _ in range(spec.assemblies):
        (center,) = within(spec.center_tolerance)
        tilt = [float(within(tolerance)[0]) for tolerance in spec.tilt_tolerance]
        moved = [
            abs(within(tolerance)[0]) * np.exp(1j * random.uniform(0.0, 2.0 * math.pi))
            for tolerance in spec.eccentricity_tolerance
        ]
        one, two = (at + complex(by) for at, by in zip(middle.eccentric, moved, strict=True))
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
            eccentric=(one, two),
            pitch=(pitch[0], pitch[1]) if spec.pitch_tolerance else middle.pitch,
        )
