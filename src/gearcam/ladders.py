"""Ladders: one stage of a design computed at rising resolution, to see what exactness costs.

A *ladder* makes the same thing at several *levels*, coarse to fine: numbers of intervals, points on
a flank, chord tolerances. What was made at a level is a *rung*; its error is told against a closed
form where there is one, else against a level beyond the finest, which is made once and not timed.
The folder of a kind makes its ladders (see `gearcam.designs.kind`); what climbs them is
`gearcam.studies.accuracy`.

Depends on results, solids and numeric.
"""

from __future__ import annotations

from collections.abc import Callable, Mapping, Sequence
from dataclasses import dataclass
from typing import TYPE_CHECKING, Any, Final

import numpy as np

from gearcam.numeric.arrays import Array
from gearcam.numeric.chebyshev import FIRST_CUTS, Expansion, expand
from gearcam.numeric.sampling import Sampler

if TYPE_CHECKING:
    from gearcam.result import Result
    from gearcam.solids import Mesh

INTERVALS: Final = (1.0, 2.0, 4.0, 8.0, 16.0, 32.0, 64.0, float(FIRST_CUTS), 2.0 * FIRST_CUTS)
"""Numbers of intervals of expansions; the program begins with the last but one."""

EXPANSION_ORDER: Final = 10.0
"""Order of an integral by expansions of degree 8: Gauss-Chebyshev nodes, which lie evenly about
the middle, integrate one degree more than they carry."""

CHORD_ORDER: Final = 2.0
"""Order of chords: a chord of length l is off by ``kappa*l^2/8``."""

COARSER: Final = (64.0, 16.0, 4.0, 1.0, 0.25, 0.0625)
"""Chord tolerances in the design's own."""

BEYOND: Final = 1.0 / 64.0
"""Chord tolerance of what others are held against, in the finest: it spoils a rung's error by as
much, which moves the order by a hundredth."""

_PLACES: Final = 997
"""Places at which two functions are compared: a prime, so that no grid of intervals hides one."""

_SHARES: Final = np.array([1, 3, 5, 7, 8, 9, 11, 13, 15]) / 16.0
"""Places inside a chord at which its distance is measured."""


@dataclass(frozen=True, eq=False, kw_only=True)
class Ladder:
    """A stage at rising resolution.

    Parameters
    ----------
    refined : str
        What a level is, with its unit: ``intervals``, ``chord tolerance, mm``.
    measured : str
        What the error is of.
    unit : str
        Of the error.
    levels : sequence of float
        From coarse to fine.
    own : float or None
        The level that the program itself takes; None where it takes none of them.
    order : float
        With which power of the number of points the error falls.
    rounding : float
        Error, in its unit, that is rounding: below it no order is told.
    make : callable
        ``make(level)`` does the work that is timed.
    measure : callable
        ``measure(made)`` returns the error of what was made and its number of points.
    """

    refined: str
    measured: str
    unit: str
    levels: Sequence[float]
    own: float | None
    order: float
    rounding: float
    make: Callable[[float], Any]
    measure: Callable[[Any], tuple[float, int]]


Ladders = Mapping[str, Callable[[Any], Ladder]]
"""What makes each ladder of a kind from its result, by the name of the stage."""


def integral_ladder(
    function: Callable[[Array], Array],
    knots: Array,
    exact: Callable[[Array], Array] | None,
    *,
    size: float,
    measured: str,
    unit: str,
) -> Ladder:
    """Return the ladder of an integral by Chebyshev expansions, as the program makes them.

    Parameters
    ----------
    function : callable
        The integrand, smooth between the knots.
    knots : (n,) array
        Rising.
    exact : callable or None
        The integral in closed form, any constant; None: the finest level stands for it.
    size : float
        What the integral is multiplied by.
    measured, unit : str
        Those of the ladder.

    Returns
    -------
    Ladder
        The error is the largest over the whole range, the integrals being 0 at its beginning.
    """
    ends = float(knots[0]), float(knots[-1])
    x = np.linspace(*ends, _PLACES)

    def make(level: float) -> Expansion:
        made = expand(function, knots, np.inf, cuts=int(level))
        return made.antiderivative()

    truth = exact or make(4.0 * INTERVALS[-1])
    values = truth(x) - truth(x[:1])

    def measure(made: Expansion) -> tuple[float, int]:
        points = made.knots.size - 1
        return size * float(np.abs(made(x) - values).max()), 9 * points

    return Ladder(
        refined="intervals",
        measured=measured,
        unit=unit,
        levels=INTERVALS,
        own=float(FIRST_CUTS),
        order=EXPANSION_ORDER,
        rounding=64.0 * np.finfo(float).eps * size * float(np.abs(values).max()),
        make=make,
        measure=measure,
    )


def tolerances_around(own: float, finest: float = 0.0, coarsest: float = np.inf) -> list[float]:
    """Return chord tolerances, mm, around the design's `own`, from `coarsest` to `finest`."""
    return [part * own for part in COARSER if finest <= part * own <= coarsest]


def chord_distance(sampler: Sampler) -> tuple[float, int]:
    """Return how far a curve is from its chords, mm, at nine places in each, and their number.

    Parameters
    ----------
    sampler : Sampler
        With its chords; what it says of their error itself is not asked.

    Returns
    -------
    (float, int)
    """
    places, points, _ = sampler.chords
    ends = np.append(points, points[:1]) if sampler.closed else points
    chord = np.diff(ends)
    j = places[:-1] + np.diff(places) * _SHARES[:, None]
    away = sampler.at(j.ravel())[0].reshape(j.shape) - ends[:-1]
    off = np.abs(np.imag(away * np.conj(chord))) / np.abs(chord)
    return float(off.max()), len(chord)


def limit_ladder(
    own: float,
    make: Callable[[float], Any],
    told: Callable[[Any], tuple[Array, int]],
    *,
    levels: Sequence[float],
    measured: str,
    unit: str,
    beyond: float = BEYOND,
) -> Ladder:
    """Return the ladder of numbers that depend on a chord tolerance, against their limit.

    Parameters
    ----------
    own : float, mm
        The design's chord tolerance.
    make : callable
        ``make(tolerance)`` does the work.
    told : callable
        ``told(made)`` returns the numbers and how many points they were made from.
    levels : sequence of float
        Chord tolerances, mm, from coarse to fine.
    measured, unit : str
        Those of the ladder.
    beyond : float
        Chord tolerance of the limit, in the finest.

    Returns
    -------
    Ladder
        The error is the largest of the numbers.
    """
    limit = told(make(beyond * levels[-1]))[0]

    def measure(made: Any) -> tuple[float, int]:
        values, points = told(made)
        return float(np.abs(values - limit).max()), points

    return Ladder(
        refined="chord tolerance, mm",
        measured=measured,
        unit=unit,
        levels=levels,
        own=own,
        order=CHORD_ORDER,
        rounding=64.0 * np.finfo(float).eps * float(np.abs(limit).max()),
        make=make,
        measure=measure,
    )


def solid_ladder(result: Result, own: float, levels: Sequence[float]) -> Ladder:
    """Return the ladder of the volumes of a design's solids.

    Parameters
    ----------
    result : Result
        Of a design whose chord tolerance is a key of its output.
    own : float, mm
        The program's own chord tolerance.
    levels : sequence of float
        Chord tolerances, mm, from coarse to fine.

    Returns
    -------
    Ladder
        Parts are made once a level, and are not timed again.
    """
    from gearcam.solids import solid

    parts: dict[float, Any] = {}

    def make(tolerance: float) -> list[Mesh]:
        if tolerance not in parts:
            design = result.design.with_({"output.chord_tolerance_mm": tolerance})
            parts[tolerance] = type(result)(design, result.tolerances).parts
        return [solid(part) for part in parts[tolerance]]

    def told(made: list[Mesh]) -> tuple[Array, int]:
        return np.array([mesh.volume for mesh in made]), sum(len(mesh.triangles) for mesh in made)

    return limit_ladder(own, make, told, levels=levels, measured="volume of solids", unit="mm3")
