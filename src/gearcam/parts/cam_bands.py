"""The solid of a cam in space as bands, its walls and ramps as B-splines.

The turn is cut into sectors where the lift is not smooth, where the ramp beside the floor vanishes,
and so that none is longer than a quarter turn. In each the exact points of the walls and ramps are
interpolated, so many that those half-way between differ by less than the tolerance. A sector has
the same cam angles in a wall and its ramp, so that these share their edges.

The velocity must not jump: the walls would have a gap. Depends on spatial, numeric and bands.
"""

from __future__ import annotations

import math
from collections.abc import Callable, Iterator
from dataclasses import replace
from itertools import pairwise
from typing import Final

import numpy as np

from gearcam.numeric.arrays import Array, distinct, divided
from gearcam.numeric.nets import SplineNet
from gearcam.numeric.roots import bracketed_root
from gearcam.parts.bands import Band, BandedBody, FlatBand, RoundBand, SplineBand
from gearcam.spatial.cam import SpatialCam, SpatialWall
from gearcam.spatial.surface import Cylinder, ramp, ramp_width

TOLERANCE: Final = 5e-6
"""Distance of exact points from the B-splines that is aimed at, mm."""

_QUARTER: Final = 0.5 * math.pi
"""Longest sector, rad."""

_LOOKED: Final = 64
"""Places between knots at which it is looked whether a ramp vanishes."""

_NONE: Final = 1e-10
"""Width of a ramp that is none, over the radius of the blank."""

_APART: Final = 1e-5
"""Least length of a sector, rad."""

_FIRST: Final = (9, 5)
"""Points along a sector and across it that are tried first."""

_MOST: Final = (1025, 129)
"""Largest numbers of them."""

_SHARE: Final = 0.5
"""Share of the tolerance that the error in one direction may use."""

_SPARE: Final = 1.3
"""By how much the error is overestimated when numbers are chosen."""

_Grid = Callable[[Array, int], Array]
"""Points (n, m, 3) at n cam angles and m even places across, from ring to ring."""


def cam_bands(
    cam: SpatialCam, blank: Cylinder, name: str, volume: tuple[float, float]
) -> BandedBody:
    """Return the solid of a cam as bands.

    Parameters
    ----------
    cam : SpatialCam
        The cam; its walls must not be undercut.
    blank : Cylinder
        What it is made from.
    name : str
        Name of the part.
    volume : (float, float), mm^3
        Its volume, from elsewhere, and how far it may be off.

    Returns
    -------
    BandedBody
    """
    cuts = _cuts(cam)
    made = {wall.side: _fitted(wall, cuts) for wall in cam.walls}
    splines = {side: bands for side, (bands, _) in made.items()}
    return BandedBody(
        name=name,
        bands=tuple(_bands(cam, blank, splines)),
        rising=cam.clockwise,
        error=max(error for _, error in made.values()),
        volume=volume[0],
        volume_error=volume[1],
    )


def _bands(
    cam: SpatialCam, blank: Cylinder, splines: dict[int, tuple[SplineBand, SplineBand]]
) -> Iterator[Band]:
    """Yield the bands from the bore over the upper face to the lower one."""
    outside, floor = RoundBand(radius=cam.outer_radius), RoundBand(radius=cam.floor)
    if blank.bore:
        yield RoundBand(radius=blank.bore)
    yield FlatBand(height=blank.length)
    if cam.apart:  # the wall of the lower roller is the upper one of the rib
        yield floor
        yield from _upwards(splines[-1])
        yield outside
        yield from splines[1]
        yield floor
    else:
        if 1 in splines:
            yield outside
            yield from splines[1]
        yield floor
        if -1 in splines:
            yield from _upwards(splines[-1])
            yield outside
    yield FlatBand(height=0.0)


def _upwards(bands: tuple[SplineBand, SplineBand]) -> Iterator[SplineBand]:
    """Yield a wall and its ramp in the other direction: from the floor to the edge."""
    for band in reversed(bands):
        yield SplineBand(
            sectors=tuple(
                None if net is None else replace(net, points=net.points[:, ::-1])
                for net in band.sectors
            )
        )


def _cuts(cam: SpatialCam) -> Array:
    """Return the ends of sectors, rad, from 0 to a turn."""
    program = cam.program
    jumps = [jump.theta for jump in program.jumps]
    phases = [place for one in program.stretches for place in (one.start, one.end)]
    given = np.mod([*jumps, *phases], program.period)
    ends = _apart(np.array([0.0, program.period]), given.tolist())
    zeros = [
        zero
        for wall in cam.walls
        for pair in pairwise(program.cuts_between(0.0, program.period).tolist())
        for zero in _vanishing(wall, *pair)
    ]
    ends = _apart(ends, zeros)
    # a face that is a point at both ends is not read well: two points are cut apart
    none, inside = (
        np.all([_width(wall, theta) == 0.0 for wall in cam.walls], axis=0)
        for theta in (ends, 0.5 * (ends[:-1] + ends[1:]))
    )
    least = 1 + (none[:-1] & none[1:] & ~inside)
    counts = np.maximum(np.ceil(np.diff(ends) / _QUARTER - 1e-9).astype(int), least)
    return divided(ends, counts)


def _apart(ends: Array, more: list[float]) -> Array:
    """Return the ends of sectors with those of others that are not next to one of them."""
    for place in sorted(more):
        if np.abs(ends - place).min() > _APART:
            ends = distinct(ends, [place])
    return ends


def _vanishing(wall: SpatialWall, low: float, high: float) -> list[float]:
    """Return the cam angles between two knots at which a ramp changes its side."""
    theta = np.linspace(low, high, _LOOKED + 2)[1:-1]
    width = _width(wall, theta)
    change = np.flatnonzero(width[:-1] * width[1:] < 0.0)
    found = [float(one) for one in theta[width == 0.0]] if width.any() else []
    if len(change):
        sign = np.sign(width[change + 1])
        found += bracketed_root(
            lambda x: sign * ramp_width(wall, x), theta[change], theta[change + 1], 1e-14
        ).tolist()
    return found


def _width(wall: SpatialWall, theta: Array) -> Array:
    """Return the widths of a ramp, mm; 0 where it is none."""
    width = ramp_width(wall, theta)
    return np.where(np.abs(width) < _NONE * wall.cam.outer_radius, 0.0, width)


def _fitted(wall: SpatialWall, cuts: Array) -> tuple[tuple[SplineBand, SplineBand], float]:
    """Return a wall and its ramp, from the edge to the floor, and their error, mm."""
    mirror = np.array([1.0, wall.cam.hand, 1.0])
    grids: tuple[_Grid, _Grid] = (
        lambda theta, count: mirror * wall.grid(theta, count).points[:, ::-1],
        lambda theta, count: mirror * ramp(wall, theta, count)[:, ::-1],
    )
    spans = list(pairwise(cuts.tolist()))
    ramped = [bool(_width(wall, np.linspace(*span, _LOOKED)).any()) for span in spans]
    counts, places = [_FIRST[0]] * len(spans), [_FIRST[1]] * len(grids)
    while True:
        nets = [
            [
                _net(grid, span, count, across) if there or not number else None
                for span, count, there in zip(spans, counts, ramped, strict=True)
            ]
            for number, (grid, across) in enumerate(zip(grids, places, strict=True))
        ]
        misses = np.array(
            [[_misses(net, grid) for net in row] for row, grid in zip(nets, grids, strict=True)]
        )
        last = counts, places
        counts = _more(counts, misses[..., 0].max(axis=0), _MOST[0])
        places = _more(places, misses[..., 1].max(axis=1), _MOST[1])
        if (counts, places) == last:
            outer, inner = (SplineBand(sectors=tuple(row)) for row in nets)
            return (outer, inner), float(misses[..., 2].max())


def _more(counts: list[int], misses: Array, most: int) -> list[int]:
    """Return numbers of points that suffice, where the errors are of fourth order in the step."""
    short = np.clip(misses / (_SHARE * TOLERANCE), 1.0, 2.0**4)
    wanted = np.minimum(np.ceil(np.array(counts) * (_SPARE * short) ** 0.25), most)
    return np.where(short > 1.0, wanted, counts).astype(int).tolist()


def _net(grid: _Grid, span: tuple[float, float], count: int, places: int) -> SplineNet:
    theta = np.linspace(*span, count)
    return SplineNet(points=grid(theta, places), along=theta, across=np.linspace(0.0, 1.0, places))


def _misses(net: SplineNet | None, grid: _Grid) -> tuple[float, float, float]:
    """Return the largest distances, mm, half-way between points along, across, and anywhere."""
    if net is None:
        return 0.0, 0.0, 0.0
    theta = np.linspace(net.along[0], net.along[-1], 2 * len(net.along) - 1)
    across = np.linspace(0.0, 1.0, 2 * len(net.across) - 1)
    miss = np.linalg.norm(net.at(theta, across) - grid(theta, len(across)), axis=-1)
    return float(miss[1::2, ::2].max()), float(miss[::2, 1::2].max()), float(miss.max())
