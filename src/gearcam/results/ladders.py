"""Convergence ladders: one stage of a design computed at increasing resolution.

A *ladder* repeats a computation at several *levels*, from coarse to fine: numbers of intervals,
points on a flank, chord tolerances. The result at one level is a *rung*. Its error is the deviation
from a closed form if there is one, else from a level finer than all others, which is computed once
and not timed. The folder of a kind defines its ladders (see `gearcam.designs.kind`);
`gearcam.results.accuracy` measures them.

Depends on results, solids and numeric.
"""

from __future__ import annotations

from collections.abc import Callable, Mapping, Sequence
from dataclasses import dataclass, field
from typing import TYPE_CHECKING, Any, Final

import numpy as np

from gearcam.numeric.arrays import Array
from gearcam.numeric.chebyshev import FIRST_CUTS, Expansion, expand
from gearcam.numeric.sampling import Sampler

if TYPE_CHECKING:
    from gearcam.results.parts import PartsResult

INTERVALS: Final = (1.0, 2.0, 4.0, 8.0, 16.0, 32.0, 64.0, float(FIRST_CUTS), 2.0 * FIRST_CUTS)
"""Numbers of intervals of expansions; the program starts with the last but one."""

EXPANSION_ORDER: Final = 10.0
"""Order of an integral by expansions of degree 8: the symmetric Gauss-Chebyshev nodes integrate one
degree more exactly."""

CHORD_ORDER: Final = 2.0
"""Order of chords: the sagitta of a chord of length l is ``kappa*l^2/8``."""

COARSER: Final = (64.0, 16.0, 4.0, 1.0, 0.25, 0.0625)
"""Chord tolerances as multiples of the design's."""

BEYOND: Final = 1.0 / 64.0
"""Chord tolerance of the reference as a part of the finest: it changes the error of a rung by this
part, and the order by one hundredth."""

ROUNDING: Final = 64.0 * np.finfo(float).eps
"""Rounding error relative to the size of a quantity."""

_PLACES: Final = 997
"""Number of places at which functions are compared: a prime, to avoid the ends of intervals."""

SHARES: Final = np.array([1, 3, 5, 7, 8, 9, 11, 13, 15]) / 16.0
"""Relative places on a chord at which its distance from the curve is measured."""


@dataclass(frozen=True, eq=False, kw_only=True)
class Ladder:
    """A stage at increasing resolution.

    Parameters
    ----------
    refined : str
        What a level counts or is, with its unit: ``intervals``, ``chord tolerance, mm``.
    measured : str
        The quantity whose error is measured.
    unit : str
        Unit of the error.
    levels : sequence of float
        From coarse to fine.
    own : float or None
        The level that the program uses; None if it uses none of them.
    order : float or None
        Expected order of convergence in the number of points; None if there is none.
    rounding : float
        Rounding error, in the unit of the error: below it there is no order.
    make : callable
        ``make(level)`` does the computation that is timed.
    measure : callable
        ``measure(made)`` returns the error of the result of `make` and its number of points.
    by : str
        Name of the method of `make`, if there are others.
    others : mapping of str to callable
        Other methods by name, like `make`: they are measured beside it.
    """

    refined: str
    measured: str
    unit: str
    levels: Sequence[float]
    own: float | None
    order: float | None
    rounding: float
    make: Callable[[float], Any]
    measure: Callable[[Any], tuple[float, int]]
    by: str = ""
    others: Mapping[str, Callable[[float], Any]] = field(default_factory=dict)

    @property
    def methods(self) -> dict[str, Callable[[float], Any]]:
        """Its own method, and the others."""
        return {self.by: self.make, **self.others}


Ladders = Mapping[str, Callable[[Any], Ladder]]
"""Functions that return the ladders of a result, by the name of the stage.

One with a method `suits` is for some designs only.
"""


def suits(make: Callable[[Any], Ladder], design: Any) -> bool:
    """Return whether a ladder is one of a design's.

    Parameters
    ----------
    make : callable
        Of `Ladders`.
    design : Design
        The design.
    """
    asked = getattr(make, "suits", None)
    return asked is None or bool(asked(design))


def integral_ladder(
    function: Callable[[Array], Array],
    knots: Array,
    exact: Callable[[Array], Array] | None,
    *,
    size: float,
    measured: str,
    unit: str,
) -> Ladder:
    """Return the ladder of an integral by Chebyshev expansions, as the program computes them.

    Parameters
    ----------
    function : callable
        The integrand, smooth between the knots.
    knots : (n,) array
        In increasing order.
    exact : callable or None
        The integral in closed form, up to a constant; None: a finer level is the reference.
    size : float
        Factor of the integral.
    measured, unit : str
        As in a `Ladder`.

    Returns
    -------
    Ladder
        Its error is the largest over the whole range; the integrals start at 0.
    """
    ends = float(knots[0]), float(knots[-1])
    x = np.linspace(*ends, _PLACES)

    def make(level: float) -> Expansion:
        return expand(function, knots, np.inf, cuts=int(level)).antiderivative()

    truth = exact or make(4.0 * INTERVALS[-1])
    values = truth(x) - truth(x[:1])

    def measure(integral: Expansion) -> tuple[float, int]:
        intervals = integral.knots.size - 1
        return size * float(np.abs(integral(x) - values).max()), 9 * intervals

    return Ladder(
        refined="intervals",
        measured=measured,
        unit=unit,
        levels=INTERVALS,
        own=float(FIRST_CUTS),
        order=EXPANSION_ORDER,
        rounding=ROUNDING * size * float(np.abs(values).max()),
        make=make,
        measure=measure,
    )


def tolerances_around(used: float, finest: float = 0.0, coarsest: float = np.inf) -> list[float]:
    """Return chord tolerances, mm, around the one that is `used`, from `coarsest` to `finest`."""
    return [part * used for part in COARSER if finest <= part * used <= coarsest]


def outline_ladder(
    used: float,
    levels: Sequence[float],
    samplers: Callable[[float], Sequence[Sampler]],
    *,
    measured: str,
    reach: float,
) -> Ladder:
    """Return the ladder of the largest distance of outlines from their chords.

    Parameters
    ----------
    used : float, mm
        The chord tolerance that the program uses.
    levels : sequence of float
        Chord tolerances, mm, from coarse to fine.
    samplers : callable
        ``samplers(tolerance)`` returns the outlines with their chords, computed.
    measured : str
        As in a `Ladder`.
    reach : float, mm
        Largest distance of the outlines from their origin.

    Returns
    -------
    Ladder
    """

    def measure(outlines: Sequence[Sampler]) -> tuple[float, int]:
        distances = [chord_distance(sampler) for sampler in outlines]
        return max(off for off, _ in distances), sum(count for _, count in distances)

    return _over_chords(used, levels, samplers, measure, measured, "mm", reach)


def _over_chords(
    used: float,
    levels: Sequence[float],
    make: Callable[[float], Any],
    measure: Callable[[Any], tuple[float, int]],
    measured: str,
    unit: str,
    size: float,
) -> Ladder:
    """Return a ladder over chord tolerances of a quantity of a `size`."""
    return Ladder(
        refined="chord tolerance, mm",
        measured=measured,
        unit=unit,
        levels=levels,
        own=used,
        order=CHORD_ORDER,
        rounding=ROUNDING * size,
        make=make,
        measure=measure,
    )


def chord_distance(sampler: Sampler) -> tuple[float, int]:
    """Return the largest distance of a curve from its chords, mm, and the number of chords.

    Parameters
    ----------
    sampler : Sampler
        The curve with its chords; the distance is measured at nine places of each chord.

    Returns
    -------
    (float, int)
    """
    places, points, _ = sampler.chords
    ends = np.append(points, points[:1]) if sampler.closed else points
    chord = np.diff(ends)
    j = places[:-1] + np.diff(places) * SHARES[:, None]
    offset = sampler.at(j.ravel())[0].reshape(j.shape) - ends[:-1]
    distance = np.abs(np.imag(offset * np.conj(chord))) / np.abs(chord)
    return float(distance.max()), len(chord)


def limit_ladder(
    used: float,
    make: Callable[[float], tuple[Array, int]],
    *,
    levels: Sequence[float],
    measured: str,
    unit: str,
    beyond: float = BEYOND,
) -> Ladder:
    """Return the ladder of numbers that converge as the chord tolerance decreases.

    Parameters
    ----------
    used : float, mm
        The chord tolerance that the program uses.
    make : callable
        ``make(tolerance)`` returns the numbers and the number of points they are computed from.
    levels : sequence of float
        Chord tolerances, mm, from coarse to fine.
    measured, unit : str
        As in a `Ladder`.
    beyond : float
        Chord tolerance of the reference, as a part of the finest.

    Returns
    -------
    Ladder
        Its error is the largest of all numbers.
    """
    limit, _ = make(beyond * levels[-1])

    def measure(computed: tuple[Array, int]) -> tuple[float, int]:
        values, points = computed
        return float(np.abs(values - limit).max()), points

    size = float(np.abs(limit).max())
    return _over_chords(used, levels, make, measure, measured, unit, size)


_STEPS: Final = (8, 4, 2, 1)
"""Steps of the coarser levels of a solid from a grid over those of the design."""


def grid_ladder(result: Any, least: int, *, finer: bool) -> Ladder:
    """Return the ladder of the volume of a solid that is made from a grid of wall points.

    Places along the roller are refined with the cam angles, so that the error falls with the number
    of points. The truth is extrapolated from a level twice as fine as the finest and from that one.

    Parameters
    ----------
    result : Result
        With ``solid_steps``, ``mesh_of(steps, places)`` and the key ``output.wall_points``.
    least : int
        Least number of cam angles of a level.
    finer : bool
        Whether one level is finer than the design.

    Returns
    -------
    Ladder
    """
    own, places = result.solid_steps, result.design.output.wall_points
    levels = sorted({max(least, own // part) for part in _STEPS})
    if finer:
        levels.append(2 * own)

    def make(level: float) -> Any:
        return result.mesh_of(int(level), max(2, 1 + round((places - 1) * level / own)))

    finest = levels[-1]
    close, closer = make(finest).volume, make(2 * finest).volume
    truth = closer + (closer - close) / 3.0

    def measure(made: Any) -> tuple[float, int]:
        return abs(made.volume - truth), len(made.vertices)

    return Ladder(
        refined="cam angles",
        measured="volume of the solid",
        unit="mm3",
        levels=levels,
        own=float(own),
        order=1.0,
        rounding=ROUNDING * truth,
        make=make,
        measure=measure,
    )


def solid_ladder(result: PartsResult, used: float, levels: Sequence[float]) -> Ladder:
    """Return the ladder of the volumes of a design's solids.

    Parameters
    ----------
    result : PartsResult
        The result of a design with the key ``output.chord_tolerance_mm``.
    used : float, mm
        The chord tolerance that the program uses.
    levels : sequence of float
        Chord tolerances, mm, from coarse to fine.

    Returns
    -------
    Ladder
        The parts of each level are made once, and not timed again.
    """
    from gearcam.parts.solids import solid

    parts: dict[float, Any] = {}

    def make(tolerance: float) -> tuple[Array, int]:
        if tolerance not in parts:
            parts[tolerance] = result.with_chords(tolerance).parts
        meshes = [solid(part) for part in parts[tolerance]]
        return np.array([mesh.volume for mesh in meshes]), sum(len(one.triangles) for one in meshes)

    return limit_ladder(used, make, levels=levels, measured="volume of solids", unit="mm3")
