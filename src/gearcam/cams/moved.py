"""Error estimates of cam results by perturbing their inputs.

The error of a result depends on its conditioning, for which there is no general formula over all
laws and followers. So cam angles, knots and coefficients of the lift and sizes of the follower are
perturbed by a few units of the last digit, lift and derivatives by their known errors, and the
result is computed again. The estimate is the largest change in a few trials, at cam angles all over
the turn.

Depends on curve, followers, lost, wall and laws; numpy only.
"""

from __future__ import annotations

import math
from collections.abc import Callable, Sequence
from dataclasses import dataclass, fields, replace
from functools import cached_property
from typing import Any, Final

import numpy as np

from gearcam.base.display import Brief
from gearcam.cams.curve import CamCurve
from gearcam.cams.followers import Follower
from gearcam.cams.lost import resting
from gearcam.cams.wall import PitchMotion, Wall
from gearcam.laws.program import Program
from gearcam.numeric.arrays import Array, Ints, Plane
from gearcam.numeric.jets import Jet

_LENGTHS, _ANGLES, _COEFFICIENTS = (n * float(np.finfo(float).eps) for n in (4, 4, 2.5))
"""Relative perturbations, in roundings: of sizes of the follower; of cam angles, since knots are
sums; of coefficients of the lift."""

_SIZES: Final = 11
"""Number of factors drawn for sizes: more than any follower has."""

_TRIES: Final = 4

_PLACES: Final = 256
_FEWEST: Final = 3
"""Number of cam angles over all phases, and least number between cuts of the lift, with ends."""

Quantity = Callable[[CamCurve, Array, Array], Array | Plane]
"""``quantity(curve, theta, found)``: a result at cam angles, rad, from lift and derivatives."""


@dataclass(frozen=True, eq=False)
class _State:
    """Cam angles, rad, lift with three derivatives there, and factors of the sizes."""

    theta: Array
    found: Array
    factors: Array

    def of(self, curve: CamCurve, quantity: Quantity) -> Array | Plane:
        inset, *factors = self.factors.tolist()
        follower = scaled(curve.follower, factors)
        moved = replace(curve, follower=follower, inset=curve.inset * inset)
        return quantity(moved, self.theta, self.found)


def scaled(follower: Follower, factors: Sequence[float]) -> Follower:
    """Return a follower with sizes times `factors`, of a complex size one for each part."""
    more, sizes = iter(factors), dict[str, Any]()
    for field in fields(follower):
        size = getattr(follower, field.name)
        if isinstance(size, complex):
            sizes[field.name] = complex(size.real * next(more), size.imag * next(more))
        elif isinstance(size, float):
            sizes[field.name] = size * next(more)
    return replace(follower, **sizes)


@dataclass(frozen=True, eq=False)
class Moved(Brief):
    """A lift with perturbed numbers.

    Parameters
    ----------
    program : Program
        The lift.
    """

    program: Program

    @cached_property
    def _places(self) -> tuple[Ints, Array]:
        """Pieces of the lift, and cam angles in them, at knots once for each side."""
        cuts, knots = self.program.cuts, self.program.knots
        index = np.searchsorted(knots, 0.5 * (cuts[:-1] + cuts[1:])) - 1
        # the same number for all phases, so that a divided one leaves enough to the others
        share = np.diff(cuts) / np.diff(knots)[index]
        counts = np.maximum(_FEWEST, (_PLACES // (len(knots) - 1) * share).astype(int))
        stretches = zip(cuts[:-1], cuts[1:], counts, strict=True)
        return np.repeat(index, counts), np.concatenate([np.linspace(*one) for one in stretches])

    def _states(self, index: Ints, theta: Array) -> list[_State]:
        """Return the state at cam angles, first unperturbed and then perturbed."""
        lift, draw = self.program.lift, np.random.default_rng(0)

        def signs(shape: tuple[int, ...]) -> Array:
            return draw.uniform(-1.0, 1.0, shape)

        def moved(values: Array, step: float = _COEFFICIENTS) -> Array:
            return values * (1.0 + step * signs(values.shape))

        made = [_State(theta, lift.on_pieces(index, theta, 3), np.ones(_SIZES))]
        off = np.array(self.program.errors)[:, None]
        for _ in range(_TRIES):
            places = moved(theta, _ANGLES)
            found = lift.on_pieces(index, places, 3, moved)
            found += off * np.sign(signs(found.shape))
            made.append(_State(places, found, moved(np.ones(_SIZES), _LENGTHS)))
        return made

    @cached_property
    def _turn(self) -> list[_State]:
        return self._states(*self._places)

    @cached_property
    def lift(self) -> list[float]:
        """Errors of the lift, mm or rad, and of its first three derivatives, per rad and so on."""
        own, *others = self._turn
        return np.max(
            [np.abs(one.found - own.found).max(axis=1) for one in others], axis=0
        ).tolist()

    def error(self, curve: CamCurve, quantity: Quantity) -> float:
        """Return the largest error of a quantity over the turn.

        Parameters
        ----------
        curve : CamCurve
            Curve of the cam, with the lift.
        quantity : callable
            Angles without a value are ignored.

        Returns
        -------
        float
        """
        return float(_changes(self._turn, curve, quantity).max())

    def errors_at(self, theta: Array, curve: CamCurve, quantity: Quantity) -> Array:
        """Return the errors of a quantity at cam angles.

        Parameters
        ----------
        theta : (n,) array, rad
            Cam angles.
        curve : CamCurve
            Curve of the cam, with the lift.
        quantity : callable
            Such as `profile_point`.

        Returns
        -------
        (n,) array
        """
        index = np.searchsorted(self.program.knots[1:-1], theta, side="right")
        return _changes(self._states(index, theta), curve, quantity)


def _changes(states: list[_State], curve: CamCurve, quantity: Quantity) -> Array:
    """Return the largest change of a quantity at each angle, 0 where it has no value."""
    with np.errstate(divide="ignore", invalid="ignore"):
        own, *others = (one.of(curve, quantity) for one in states)
        changes = np.max([np.abs(one - own) for one in others], axis=0)
    return np.where(np.isfinite(changes), changes, 0.0)


def pressure_angle(curve: CamCurve, theta: Array, found: Array) -> Array:
    """Return the pressure angle, rad (see `Quantity`)."""
    return _array(curve.contact_of(found, 0).pressure, theta)


def pitch_curvature(curve: CamCurve, theta: Array, found: Array) -> Array:
    """Return the pitch curve's curvature, 1/mm (see `Quantity`)."""
    contact = curve.contact_of(found, 0)
    return _array(contact.turning / contact.pitch_speed, theta)


def face_radius(curve: CamCurve, theta: Array, found: Array) -> Array:
    """Return the radius of curvature of the envelope of a face, mm (see `Quantity`)."""
    contact = curve.contact_of(found, 0)
    return _array(contact.speed / contact.turning, theta)


def contact_place(curve: CamCurve, theta: Array, found: Array) -> Array:
    """Return the position of the contact along a face, mm (see `Quantity`)."""
    return _array(curve.contact_of(found, 0).place, theta)


def profile_point(curve: CamCurve, theta: Array, found: Array) -> Plane:
    """Return points of the profile, mm (see `Quantity`)."""
    return curve.trace(theta, found[0], found[1])[0]


def _speed(curve: CamCurve, theta: Array, found: Array) -> Array:
    return _array(curve.contact_of(found, 0).speed, theta)


def _array(values: Jet, theta: Array) -> Array:
    return np.asarray(values.c[0]) + np.zeros_like(theta)


def undercut_error(moved: Moved, wall: Wall) -> float:
    """Return the error of the ends of a wall's undercut stretches, rad.

    Parameters
    ----------
    moved : Moved
        Its lift.
    wall : Wall
        Undercut or not.

    Returns
    -------
    float
        At least that of knots; 0 if nothing is undercut.
    """
    ends = np.unique(wall.undercut)
    slopes = wall.curve.contact(ends).speed.derivatives()[1]
    inside = ~np.isin(ends, wall.program.knots)
    off = moved.errors_at(ends, wall.curve, _speed)[inside] / np.abs(slopes[inside])
    return float(max(off.max(initial=0.0), _ANGLES * ends.max(initial=0.0)))


def lost_lift_error(moved: Moved, wall: Wall) -> float:
    """Return the error of the lift lost by trimming, mm or rad.

    Parameters
    ----------
    moved : Moved
        Its lift.
    wall : Wall
        Trimmed or not.

    Returns
    -------
    float
        From the gap between both sides of a corner, and the angle at which they cross.
    """
    worst, curve = 0.0, wall.curve
    points, misses = _corner_errors(moved, wall)
    for corner, loss in zip(wall.corners, wall.lost, strict=True):
        off = misses[np.abs(points - corner.point).argmin()]
        theta = Jet([np.array([loss.theta])])
        # a perturbed corner may be out of the follower's reach: then it has no lift
        with np.errstate(invalid="ignore"):
            lifts = [
                resting(curve.follower, curve.carrier, complex(point), curve.lift_sign)(
                    theta
                ).derivatives()[0]
                for point in (corner.point, *(corner.point + off), *(corner.point - off))
            ]
        change = float(np.nanmax(np.abs(np.subtract(lifts[1:], lifts[0])), initial=0.0))
        worst = max(worst, change + moved.lift[0])
    return worst


def _corner_errors(moved: Moved, wall: Wall) -> tuple[Plane, Plane]:
    """Return the corners left by trimming, and their errors in two directions, (n, 2), mm.

    Each side has an error along its normal, by which the corner moves along the other side.
    """
    drawn = replace(wall.drawn, curve=wall.curve)
    number = np.flatnonzero(drawn.corner)
    (points, after), (ends, before) = (
        drawn.at(number, drawn.start[number]),
        drawn.at(number - 1, drawn.end[number - 1]),
    )
    theta = drawn.states(number, drawn.start[number])[0]
    off = np.abs(points - ends) + 2.0 * _normal_errors(moved, wall, theta)
    crossing = np.maximum(np.abs((np.conj(before) * after).imag), off / wall.size.perimeter)
    return points, (off / crossing * [before, after]).T


def _normal_errors(moved: Moved, wall: Wall, theta: Array) -> Array:
    """Return position errors of a wall along its normal, mm, at cam angles (n,), rad."""
    s, ds = wall.program.derivatives(theta, 1)
    normals = -1j * wall.curve.trace(theta, s, ds)[1]

    def height(curve: CamCurve, places: Array, found: Array) -> Array:
        return (np.conj(normals) * profile_point(curve, places, found)).real

    return moved.errors_at(theta, wall.curve, height)


def play_error(moved: Moved, motion: PitchMotion, walls: tuple[Wall, ...], theta: float) -> float:
    """Return the error of the lost motion between walls, mm or rad.

    Parameters
    ----------
    moved : Moved
        Their lift.
    motion : PitchMotion
        Their motion.
    walls : tuple of Wall
        Walls that hold the follower.
    theta : float, rad
        Cam angle of the largest lost motion.

    Returns
    -------
    float
        Position errors of the walls there, converted to lift.
    """
    place = np.array([theta])
    off = sum(float(_normal_errors(moved, wall, place)[0]) for wall in walls)
    slant = float(motion.pitch_curve.contact(place, 0).pressure.derivatives()[0][0])
    return off / (math.cos(slant) * motion.follower.lever)
