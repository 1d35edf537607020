"""The ends of open wheels: where their teeth stop, and the body that carries them.

The blank ends half a pitch beyond both ends of the centrode: on wheel 1 in the middle of a space,
on wheel 2 in the middle of a tooth; a rack may end half a pitch earlier, in a gap. From there the
outline follows the normal to below the roots, then runs straight to a hub around the shaft; a ring,
whose metal is outside, has an outer arc.
"""

from __future__ import annotations

import math
from copy import deepcopy
from dataclasses import replace
from itertools import pairwise

import numpy as np

from gearcam.base.adjustments import Adjustment
from gearcam.base.errors import InfeasibleError, beyond_limit
from gearcam.gears.flank import Curve, Rows, Toothing
from gearcam.gears.flank_ends import TipEnds
from gearcam.gears.spec import Bar, RingSpec
from gearcam.numeric.arrays import Plane
from gearcam.numeric.contour import Run

_BELOW = 1.0
"""Depth of the end faces below the roots, in modules."""

_GAP = 0.1
"""Least free angle between the two ends of a wheel, rad."""

_WHOLE = 350.0
"""Travel of a wheel, deg, above which no tooth count helps."""

_MORE = 1.001
"""Factor, clear of rounding, by which a named remedy exceeds the least rim or diameter, or stays
below the largest travel."""

_HIGHER = 4.0
"""Largest height of a bar that is tried, over the least."""

_HUB = 0.6
"""Radius of the hub over the smallest root radius."""


def cut_ends(toothing: Toothing, rows: Rows, tips: TipEnds) -> Rows:
    """Cut the chain of an open wheel at the ends of its blank.

    Parameters
    ----------
    toothing : Toothing
        The wheel.
    rows : Rows
        All curves from the first to the last tooth formed.
    tips : TipEnds
        Ends of its flanks.

    Returns
    -------
    Rows
        From half a pitch before the start of the centrode to half a pitch after its end.
    """
    start, end = toothing.track.angle(toothing.ends)
    if toothing.wheel == 1 or toothing.in_gap:
        first, last = toothing.numbers[0], toothing.numbers[-1]
        outside = ((rows.tooth == first) & (rows.sigma > 0.0)) | (rows.tooth == last)
        kept = rows.select(np.flatnonzero(~outside))
    else:
        lead = rows.select(np.array([len(rows.kind) - 1]))
        z = len(toothing.numbers)
        kept = Rows.joined(
            [
                replace(
                    lead,
                    start=tips.foot[z : z + 1],
                    end=tips.foot[:1],
                    low=tips.height[z : z + 1],
                    high=tips.height[:1],
                    tooth=np.array(toothing.numbers[:1]),
                ),
                rows,
            ]
        )
    return _shortened(kept, float(start), float(end))


def _shortened(rows: Rows, start: float, end: float) -> Rows:
    """Begin the first row, a land or tip, at `start` and end the last at `end`.

    A space that has lost its land is left uncut: its fillets already meet there.
    """
    chain = deepcopy(rows)
    chain.corner[0] = True
    ends = (0, start, chain.start, chain.low), (-1, end, chain.end, chain.high)
    for row, place, cut, height in ends:
        span = rows.end[row] - rows.start[row]
        if rows.kind[row] >= Curve.LAND and span > 0.0:
            share = min(max((place - rows.start[row]) / span, 0.0), 1.0)
            cut[row] = rows.start[row] + share * span
            height[row] = rows.low[row] + share * (rows.high[row] - rows.low[row])
    return chain


def body_runs(
    toothing: Toothing, toothed: Plane, tolerance: float, parts: int, back: RingSpec | Bar | None
) -> tuple[Run, ...]:
    """Return the body outline from the last tooth to the first: around the shaft, or behind a ring.

    Parameters
    ----------
    toothing : Toothing
        The wheel.
    toothed : (n,) complex array, mm
        Its teeth, counter-clockwise.
    tolerance : float, mm
        Chord error of the arc.
    parts : int
        Dense points per chord.
    back : RingSpec or Bar
        Outside of a ring, or the bar of a rack.

    Returns
    -------
    tuple of Run
        End face, arm, hub (a ring: its outside), arm, end face, counter-clockwise; a rack has
        straight lines around its back.

    Raises
    ------
    InfeasibleError
        If the ends meet, since the wheel turns by a full turn or more; if a ring has no metal for
        its end faces, or its outside is not round.
    """
    frames = toothing.frames(toothing.track.angle(toothing.ends))
    depth = toothing.cutter.dedendum + _BELOW * toothing.pitch / math.pi
    inner = frames.p - depth * toothing.turn * frames.t
    inner = inner if toothing.wheel == 1 else inner[::-1]
    first, last = complex(toothed[0]), complex(toothed[-1])
    if toothing.track.slides:
        height = back.height if isinstance(back, Bar) else None
        far = _back(toothed, inner, depth, height)
        corners = [complex(far, point.imag) for point in (inner[1], inner[0])]
        chain = [last, inner[1], *corners, inner[0], first]
        return tuple(_line(start, end) for start, end in pairwise(chain))
    # counter-clockwise around its metal, the teeth of a ring run clockwise around the shaft
    span = float(np.angle(toothed[1:] / toothed[:-1]).sum())
    span += float(np.angle(inner[1] / last) - np.angle(inner[0] / first))
    radius, sweep = _HUB * min(abs(toothed).min(), abs(inner).min()), 2.0 * math.pi - span
    if span < 0.0:
        roots, faces = float(abs(toothed).max()), float(abs(inner).max())
        ring = back if isinstance(back, RingSpec) else RingSpec()
        radius = _outside(ring, roots, faces, toothing.pitch / math.pi)
        sweep = span = -span
    if span >= 2.0 * math.pi - _GAP:
        name = ("driver", "driven wheel")[toothing.wheel - 1]
        key = ("law.driver_travel_deg", "law.driven_travel_deg")[toothing.wheel - 1]
        angles = toothing.track.rotation(np.array([0.0, toothing.track.around]))
        travel = math.degrees(angles[1] - angles[0])
        limit = travel * (2.0 * math.pi - _GAP) / span
        out = [Adjustment(near={key: limit / _MORE}, far={key: 0.8 * limit})]
        if toothing.wheel == 1:  # a spiral, or a knot that is solved, follows the driven wheel
            out.append(Adjustment(far={"law.driven_travel_deg": 0.8 * limit}))
        what = f"the ends of the {name} meet behind its shaft"
        where = f"wheel {toothing.wheel}"
        note = f"the value is the travel of the {name}; its end teeth need the rest"
        more_teeth = travel / limit if travel < _WHOLE else 0.0
        raise beyond_limit(
            what, where, travel, limit, note, adjustments=out, unit="deg", more_teeth=more_teeth
        )
    hub = radius * inner / np.abs(inner)
    chords = max(2, math.ceil(sweep / math.sqrt(8.0 * tolerance / radius)))
    turn = np.exp(1j * sweep * np.linspace(0.0, 1.0, chords * parts + 1))
    arc = hub[1] * turn
    arc[-1] = hub[0]
    return (
        _line(last, inner[1]),
        _line(inner[1], hub[1]),
        Run(points=arc, tangents=1j * arc / radius),
        _line(hub[0], inner[0]),
        _line(inner[0], first),
    )


def _back(toothed: Plane, inner: Plane, depth: float, height: float | None) -> float:
    """Return where the back of a rack is, mm along x; of a given height over its tips.

    A height that leaves no metal below the roots is refused.
    """
    if height is None:
        return float(toothed.real.max()) + depth
    tips = float(toothed.real.min())
    least = max(float(toothed.real.max()), float(inner.real.max())) - tips
    if height <= least:
        what = "the bar of the rack leaves its end faces, a module deep, no metal"
        key, near = "bar.height_mm", _MORE * least
        # its holes may need more
        higher = (Adjustment(near={key: near}, far={key: _HIGHER * least}),)
        raise beyond_limit(what, key, height, least, near=near, adjustments=higher, unit="mm")
    return tips + height


def _outside(ring: RingSpec, roots: float, faces: float, module: float) -> float:
    """Return the outer radius of an open ring, mm, from the radii of its roots and end faces.

    An outside that is not round, or leaves no metal for the end faces, is refused.
    """
    if ring.outer != "round":
        what = "the outside can follow the roots of a closed ring only"
        note = 'use outer = "round" for an open ring'
        raise InfeasibleError(
            what,
            where="ring.outer",
            nearest=note,
            adjustments=(Adjustment(near={"ring.outer": "round"}),),
        )
    rim, least = ring.least_rim(roots, module), max(_BELOW * module, faces - roots)
    if rim >= least:
        return roots + rim
    key, value, limit = "ring.rim_mm", rim, least
    if ring.outer_diameter is not None:
        key, value, limit = "ring.outer_diameter_mm", ring.outer_diameter, 2.0 * (roots + least)
    what = "the outside of the open ring leaves its end faces, a module deep, no metal"
    note = "the limit is the size that the end faces just reach"
    raise beyond_limit(what, f"wheel 2, {key}", value, limit, note, near=_MORE * limit)


def _line(start: complex, end: complex) -> Run:
    return Run(points=np.array([start, end]), tangents=np.full(2, (end - start) / abs(end - start)))
