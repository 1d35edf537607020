"""A disc that rolls along an outline: where it touches, and where it touches two points at once.

The centre of a disc that touches a smooth run outside (or, with a negative radius, inside) moves
along the run's parallel. Around a convex corner it moves along an arc; at a concave corner the
parallels are joined through the corner itself. Together these form one closed chain, which may
cross itself; the boundary of its region of positive winding number is the actual path of the disc
(see `gearcam.numeric.crossings`). All computations use cubics through dense points with their exact
tangents. Discs that have no single path around are refused.

Depends on numeric.
"""

from __future__ import annotations

import math
from dataclasses import dataclass, replace
from functools import cached_property
from typing import Final

import numpy as np

from gearcam.base.errors import InfeasibleError
from gearcam.base.numerals import formatted
from gearcam.numeric.arrays import Array, Ints, Mask, Plane, in_groups
from gearcam.numeric.contour import Contour, Run
from gearcam.numeric.crossings import Chain, remaining, rows_between
from gearcam.numeric.hermite import on_cubics

_SMOOTH: Final = 1e-9
"""Gap between parallels, in tolerances, below which their runs join without a corner."""

_DENSE: Final = 1 / 40
"""Chord error of dense points over the tolerance."""

_BESIDE: Final = 0.1
"""Least distance of new ends of a run from its inner points, in steps."""


@dataclass(frozen=True, eq=False)
class Touched:
    """A part of a run between two positions, which are fractional indices of its points.

    Parameters
    ----------
    run : Run
        The run; for an arc around a corner the arc itself.
    by : float, mm
        Distance of the disc's centre from it: 0 for an arc, which is already its path.
    low, high : float
        The positions.
    corner : complex or None, mm
        For an arc: the corner that the disc touches.
    """

    run: Run
    by: float
    low: float
    high: float
    corner: complex | None = None

    def place(self, at: float) -> tuple[complex, complex]:
        """Return point and unit tangent at a position, on the cubic between its neighbours."""
        p, t = self.run.points, self.run.tangents
        k = min(max(int(at), 0), len(p) - 2)
        share = np.array([at - k])
        points, tangents = on_cubics(p[k : k + 2], t[k : k + 2], np.array([0]), share)
        return complex(points[0]), complex(tangents[0])

    def touched(self, at: float) -> complex:
        """Return the point that the disc touches at a position."""
        return self.place(at)[0] if self.corner is None else self.corner

    @property
    def backwards(self) -> bool:
        """Whether the disc's centre moves backwards: its radius exceeds the radius of curvature."""
        run = self.parallel
        along = np.conj(run.tangents[1:] + run.tangents[:-1])
        return float((np.diff(run.points) * along).real.sum()) < 0.0

    @cached_property
    def parallel(self) -> Run:
        """The path of the disc's centre."""
        return self.as_run(self.by)

    def as_run(self, by: float) -> Run:
        """Return the parallel of the stretch at the distance `by`, mm, as a run."""
        inner = np.arange(math.floor(self.low) + 1, math.ceil(self.high))
        # points right next to an end would only amplify errors of interpolated tangents
        inner = inner[(inner - self.low > _BESIDE) & (self.high - inner > _BESIDE)]
        ends = [self.place(self.low), self.place(self.high)]
        p = np.concatenate([[ends[0][0]], self.run.points[inner], [ends[1][0]]])
        t = np.concatenate([[ends[0][1]], self.run.tangents[inner], [ends[1][1]]])
        places = np.concatenate([[self.low], inner, [self.high]])
        joints = [int(np.argmin(np.abs(places - joint))) for joint in self.run.joints]
        inside = tuple(joint for joint in dict.fromkeys(joints) if 0 < joint < len(p) - 1)
        return Run(points=p - 1j * by * t, tangents=t, joints=inside)


def roll(contour: Contour, radius: float) -> list[tuple[Touched, Touched, complex | None]]:
    """Return the stretches of a contour that a rolling disc touches.

    Parameters
    ----------
    contour : Contour
        The outline.
    radius : float, mm
        Radius of the disc, outside positive, inside negative.

    Returns
    -------
    list of (Touched, Touched, complex or None), mm
        Counter-clockwise: each stretch, the next one, and the centre of the disc that touches both
        at once; None where one ends as the next begins.

    Raises
    ------
    InfeasibleError
        If the disc is too large to roll around.
    """
    pieces, closing = _pieces(contour, radius)
    middles = _Middles.of(pieces)
    chain = middles.chain(closing)
    # slivers that rounding leaves between nearly coincident parallels
    least = _SMOOTH * contour.tolerance * float(np.abs(np.diff(chain.points)).sum())
    rings = [ring for ring in remaining(middles, [chain])[0] if abs(ring.area) > least]
    if len(rings) != 1 or rings[0].area < 0.0:
        raise too_far(contour, radius)
    touched: list[Touched] = []
    centers: list[complex | None] = []
    for branch in rings[0].branches:
        before = len(touched)
        for k, low, high in zip(*rows_between(middles, [branch])[:3], strict=True):
            if low < high:
                touched.append(replace(pieces[k], low=float(low), high=float(high)))
                centers.append(None)
        if rings[0].crossed and len(touched) > before:  # a branch may be a point
            point, tangent = touched[-1].place(touched[-1].high)
            centers[-1] = point - 1j * touched[-1].by * tangent
    if any(part.backwards for part in touched):
        raise too_far(contour, radius)
    return list(zip(touched, touched[1:] + touched[:1], centers, strict=True))


def _pieces(contour: Contour, radius: float) -> tuple[list[Touched], dict[int, complex]]:
    """Return runs and arcs around convex corners, in order, and concave corners after some."""
    runs = [_densified(run, radius, contour.tolerance) for run in contour.runs]
    made: list[Touched] = []
    closing: dict[int, complex] = {}
    for run, following in zip(runs, [*runs[1:], runs[0]], strict=True):
        made.append(Touched(run, radius, 0.0, len(run.points) - 1.0))
        corner, before = complex(run.points[-1]), complex(run.tangents[-1])
        behind = complex(following.tangents[0])
        turn = float(np.angle(behind / before))
        if turn * radius > _SMOOTH * contour.tolerance:
            arc = arc_run(corner, radius, -1j * before, -1j * behind, contour.tolerance)
            made.append(Touched(arc, 0.0, 0.0, len(arc.points) - 1.0, corner))
        elif turn * radius < -_SMOOTH * contour.tolerance:
            closing[len(made) - 1] = corner
    return made, closing


@dataclass(frozen=True, eq=False, kw_only=True)
class _Middles:
    """Paths of the disc's centre, as `gearcam.numeric.sampling.Curves` over positions on pieces.

    `first` are the indices of the pieces' first points; `points`, `tangents` and `by` are of all.
    """

    start: Array
    end: Array
    corner: Mask
    first: Ints
    points: Plane
    tangents: Plane
    by: Array

    @classmethod
    def of(cls, pieces: list[Touched]) -> _Middles:
        """Return the path of the centre along some pieces."""
        size = np.array([len(piece.run.points) for piece in pieces])
        return cls(
            start=np.zeros(len(pieces)),
            end=size - 1.0,
            corner=np.zeros(len(pieces), dtype=bool),  # smooth as far as needed here
            first=np.cumsum(size) - size,
            points=np.concatenate([piece.run.points for piece in pieces]),
            tangents=np.concatenate([piece.run.tangents for piece in pieces]),
            by=np.repeat([piece.by for piece in pieces], size),
        )

    @property
    def breaks(self) -> tuple[Ints, Array]:
        """None: not needed here."""
        return np.zeros(0, dtype=np.int64), np.zeros(0)

    def at(self, index: Ints, parameter: Array) -> tuple[Plane, Plane]:
        """Return points, mm, and unit tangents of pieces at positions."""
        first = self.first[index]
        step = np.clip(parameter, 0.0, self.end[index] - 1.0).astype(np.int64)
        points, tangents = on_cubics(self.points, self.tangents, first + step, parameter - step)
        return points - 1j * self.by[first] * tangents, tangents

    def chain(self, closing: dict[int, complex]) -> Chain:
        """Return the chain through all dense points and the corners after some pieces."""
        curve = np.repeat(np.arange(len(self.end)), self.end.astype(np.int64) + 1)
        low = np.arange(len(curve)) - self.first[curve].astype(np.float64)
        high = np.minimum(low + 1.0, self.end[curve])
        # through a corner the path leads from the end of one run to the start of the next
        behind = np.array(list(closing), dtype=np.int64)
        at = np.append(self.first, len(curve))[behind + 1]
        return Chain(
            curve=np.insert(curve, at, (behind + 1) % len(self.end)),
            low=np.insert(low, at, 0.0),
            high=np.insert(high, at, 0.0),
            points=np.insert(
                self.points - 1j * self.by * self.tangents, at, list(closing.values())
            ),
        )


def arc_run(center: complex, radius: float, start: complex, end: complex, tolerance: float) -> Run:
    """Return an arc about a centre from one outward normal to the next.

    Parameters
    ----------
    center : complex, mm
        Its centre.
    radius : float, mm
        Positive if the arc is convex outwards, negative if inwards.
    start, end : complex
        Outward unit normals of the outline at its ends.
    tolerance : float, mm
        Tolerance of the outline.

    Returns
    -------
    Run
        With dense points.
    """
    turn = float(np.angle(end / start))
    count = max(8, math.ceil(abs(turn) / math.sqrt(8.0 * _DENSE * tolerance / abs(radius))))
    spokes = start * np.exp(1j * turn * np.linspace(0.0, 1.0, count + 1))
    spokes[-1] = end
    tangents = 1j * spokes * math.copysign(1.0, turn * radius)
    return Run(points=center + radius * spokes, tangents=tangents)


def _densified(run: Run, radius: float, tolerance: float) -> Run:
    """Return a run with more points where its parallel would have too few."""
    p, t = run.points, run.tangents
    turn = np.abs(np.angle(t[1:] * np.conj(t[:-1])))
    bow = 0.125 * turn * (np.abs(np.diff(p)) + abs(radius) * turn)
    parts = np.maximum(np.ceil(np.sqrt(bow / (_DENSE * tolerance))), 1.0).astype(np.int64)
    if (parts == 1).all():
        return run
    step, place = in_groups(parts)
    points, tangents = on_cubics(p, t, step, place / parts[step])
    first = np.append(0, np.cumsum(parts))
    joints = tuple(int(first[joint]) for joint in run.joints)
    return Run(points=np.append(points, p[-1]), tangents=np.append(tangents, t[-1]), joints=joints)


def too_far(contour: Contour, radius: float) -> InfeasibleError:
    """Return the refusal of a disc of `radius`, mm, on a `contour`."""
    side = "outside" if radius > 0 else "inside"
    what = f"a disc of this radius that rolls {side} leaves no simple outline"
    where = f"an outline of {formatted(np.ptp(contour.points.real))} mm"
    return InfeasibleError(what, where=where, value=abs(radius), unit="mm")
