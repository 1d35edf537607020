"""The data that a page draws, ready for JSON.

Lengths are in mm, rotations in rad, positions of the driver in the unit of its axis; points are
flat lists ``x0, y0, x1, y1, ...``. Numbers are rounded far below the resolution of screens and
prints; NaN and infinity become null.
"""

from __future__ import annotations

import math
from collections.abc import Sequence
from dataclasses import asdict, replace
from typing import Any, Final

import numpy as np

from gearcam.base.inches import changes_in, unit_in
from gearcam.base.readable import UnitScale, column, labelled, readable, scale_of
from gearcam.numeric.arrays import Array, Plane, as_pairs
from gearcam.numeric.pose import SpacePose
from gearcam.pictures import drawings
from gearcam.pictures.charts import Chart, Handle
from gearcam.pictures.scenes import (
    SAGITTA,
    ColouredCurve,
    ContactPoints,
    JointForce,
    MovingBody,
    Scene,
    extent,
    handles_of,
)

_MM: Final = 4
"""Decimals of lengths, mm: a tenth of a micrometre."""

_RAD: Final = 7
"""Decimals of rotations, rad: less than a tenth of a micrometre at a radius of 1 m."""

_SHARE: Final = 4
"""Decimals of shares of a force."""

_OF_TIME: Final = 9
"""Significant digits of the last time of a scene: between all places some time passes."""

_ENDS: Final = 12
"""Significant digits of the ends of an axis."""

_DIGITS: Final = 6
"""Significant digits of the largest value of a chart; the others have as many decimals, or as many
digits on a logarithmic axis."""


def scene_data(scene: Scene) -> dict[str, Any]:
    """Return the data of a scene.

    Parameters
    ----------
    scene : Scene
        The moving parts.

    Returns
    -------
    dict
        ``title``; ``driver``, the label of its axis; ``places``; ``closed``; ``start``; ``box``,
        the bounding box of all places as left, bottom, right, top; ``pitch``, flat points or null;
        ``contacts`` by name, each with ``start``, ``x``, ``y``, ``fx``, ``fy`` and ``teeth`` or
        null; ``forces``, each with ``name``, ``x``, ``y``, and ``fx`` and ``fy``, shares of the
        largest of all forces, null where there is none; ``largest_force``, that of them as text, or
        null; ``bodies``, each with ``name`` and ``called``, ``link`` (whether it is a link of a
        machine), ``metal`` and ``floor`` (closed chains, filled by the even-odd rule), ``plates``
        (index in ``metal`` of the first chain of each of several plates), ``lines`` (``layer``,
        ``points``, ``closed``, ``dashed``), ``turn``, ``x`` and ``y`` (one number if constant),
        ``teeth`` (``[first, last]`` vertices of ``metal[0]``) or null, and ``names`` (``text``,
        ``x`` and ``y`` in the body's frame) and ``handles`` (x and y by name); ``coloured``, each
        with ``body``, ``points`` and ``values`` by label; ``scales`` by label, each with
        ``least``, ``largest``, both as texts ``told``, the second with its unit, and where that is:
        ``place`` of the driver, ``body``, ``x`` and ``y`` on it; ``times``, seconds from the first
        place, or null; ``solids`` by name, those that do not move as the body of their name: each
        with ``axis``, ``turn``, ``x``, ``y`` and ``z``; ``eye`` and ``up``, directions of the first
        view of solids.
    """
    names = dict.fromkeys(name for one in scene.coloured for name in one.values)
    sizes = [np.abs(one.force[np.isfinite(one.force)]).max(initial=0.0) for one in scene.forces]
    largest = max(map(float, sizes), default=0.0)
    return {
        "title": scene.title,
        "driver": scene.driver,
        "places": _rounded(scene.places, _MM),
        "closed": scene.closed,
        "start": scene.start,
        "box": [round(value, _MM) for value in extent(scene)],
        "bodies": [_body(body) for body in scene.bodies],
        "contacts": {name: _contacts(one) for name, one in scene.contacts.items()},
        "pitch": None if scene.pitch is None else _flat(scene.pitch),
        "forces": [_force(one, largest) for one in scene.forces],
        "largest_force": readable(largest, "N") if largest else None,
        "coloured": [_coloured(one) for one in scene.coloured],
        "scales": {name: _scale(name, scene.coloured) for name in names},
        "times": None if scene.times is None else _digits(scene.times - scene.times[0], _OF_TIME),
        "solids": {name: _solid(pose) for name, pose in scene.in_space.items()},
        "eye": list(scene.eye),
        "up": list(scene.up),
    }


def _solid(pose: SpacePose) -> dict[str, Any]:
    shift = {name: _steady(one, _MM) for name, one in zip("xyz", pose.shift.T, strict=True)}
    return {"axis": list(pose.axis), "turn": _steady(pose.turn, _RAD), **shift}


def _body(body: MovingBody) -> dict[str, Any]:
    metal, floor, lines = [], [], []
    edges = []
    for feature in body.features:
        kind = feature.kind
        for points, closed in drawings.chains(feature.shape, SAGITTA):
            flat = _flat(points)
            solid = kind in (*drawings.FILLED, *drawings.THROUGH)
            if kind == drawings.OUTER_WALL or feature.metal:
                floor.append(flat)
            elif solid and closed:
                if kind in drawings.FILLED:
                    edges.append(len(metal))
                metal.append(flat)
            else:
                dashed = kind in drawings.DASHED
                lines.append({"layer": kind, "points": flat, "closed": closed, "dashed": dashed})
    return {
        "name": body.name,
        "called": body.called,
        "link": any(feature.kind == drawings.MEMBER for feature in body.features),
        "metal": metal,
        "plates": [0, *edges[1:]],  # openings may be drawn before the first edge
        "floor": floor,
        "lines": lines,
        "turn": _steady(body.pose.turn, _RAD),
        "x": _steady(np.real(body.pose.shift), _MM),
        "y": _steady(np.imag(body.pose.shift), _MM),
        "teeth": None if body.teeth is None else body.teeth.tolist(),
        "names": [
            {"text": text, "x": round(at.real, _MM), "y": round(at.imag, _MM)}
            for text, at in body.names
        ],
        "handles": {
            name: [round(at.real, _MM), round(at.imag, _MM)]
            for name, at in handles_of(body).items()
        },
    }


def _force(one: JointForce, largest: float) -> dict[str, Any]:
    shares = one.force / (largest or 1.0)
    return {
        "name": one.name,
        "x": _rounded(one.point.real, _MM),
        "y": _rounded(one.point.imag, _MM),
        "fx": _rounded(shares.real, _SHARE),
        "fy": _rounded(shares.imag, _SHARE),
    }


def _contacts(contacts: ContactPoints) -> dict[str, Any]:
    return {
        "start": contacts.start.tolist(),
        "x": _rounded(contacts.point.real, _MM),
        "y": _rounded(contacts.point.imag, _MM),
        "fx": _rounded(contacts.force.real, _DIGITS),
        "fy": _rounded(contacts.force.imag, _DIGITS),
        "teeth": None if contacts.teeth is None else contacts.teeth.tolist(),
    }


def _coloured(curve: ColouredCurve) -> dict[str, Any]:
    values = {name: _digits(one) for name, one in curve.values.items()}
    return {"body": curve.body, "points": _flat(curve.points), "values": values}


def _scale(name: str, curves: Sequence[ColouredCurve]) -> dict[str, Any]:
    """Return the scale of a quantity on all curves, from its least to its largest value."""
    those = [one for one in curves if name in one.values]
    highest = max(those, key=lambda one: float(np.nanmax(one.values[name])))
    k = int(np.nanargmax(highest.values[name]))
    x, y = _flat(highest.points[k : k + 1])
    lowest = min(float(np.nanmin(one.values[name])) for one in those)
    ends = lowest, float(highest.values[name][k])
    least, largest = _digits(np.array(ends))
    to = scale_of(max(map(abs, ends)), labelled(name)[1])
    low, high = column([to.factor * one for one in ends], to.unit)
    return {
        "told": [low, f"{high} {to.unit}".rstrip()],
        "least": least,
        "largest": largest,
        "place": round(float(highest.places[k]), _MM),
        "body": highest.body,
        "x": x,
        "y": y,
    }


def chart_data(name: str, chart: Chart, driver: str, units: str = "mm") -> dict[str, Any]:
    """Return the data of a chart, its axes in units that are easy to read.

    The axis of the driver keeps its own, as the parts move over it.

    Parameters
    ----------
    name : str
        Its name among the charts of the result.
    chart : Chart
        The chart.
    driver : str
        Label of the driver's axis; a chart over this axis has a cursor that moves with the parts.
    units : {"mm", "inch"}
        Unit of lengths on the axes but that of the driver.

    Returns
    -------
    dict
        ``name``, ``title``, ``x`` and ``y`` (axis labels), ``log`` (the logarithmic axes),
        ``equal`` (whether both axes have one scale), ``moves`` (whether it has a cursor), ``range``
        (of the vertical axis, including the limits near the lines), ``ends`` (of both axes, with
        margins), ``lines`` (``label``, ``x``, ``y``, ``dots``), ``limits`` (``label``, ``value``,
        ``seen``: whether it is within the range), ``marks`` on the horizontal axis (``label``,
        ``value``), ``handles`` (``x``, ``y`` and ``keys``, the changes of numbers by key for a unit
        of each axis), ``own``, the unit of the values in Python, and ``factor`` of the vertical
        axis.
    """
    moves, own = chart.x == driver, labelled(chart.y)[1]
    chart, factor = _in_easy_units(chart, across=not moves, units=units)
    low, high = chart.range
    across, up = (_significant if axis in chart.log else _digits for axis in "xy")
    return {
        "name": name,
        "title": chart.title,
        "x": chart.x,
        "y": chart.y,
        "log": chart.log,
        "equal": chart.equal,
        "moves": moves,
        "own": own,
        "factor": factor,
        "range": [low, high],
        # the last tick is at the end, not beyond it
        "ends": [[float(f"{one:.{_ENDS}g}") for one in ends] for ends in chart.ends],
        "lines": [
            {"label": one.label, "x": across(one.x), "y": up(one.y), "dots": one.dots}
            for one in chart.lines
        ],
        "limits": [
            {"label": one.label, "value": one.value, "seen": low <= one.value <= high}
            for one in chart.limits
        ],
        "marks": [{"label": one.label, "value": one.value} for one in chart.marks],
        "handles": [asdict(one) for one in chart.handles],
    }


def _in_easy_units(chart: Chart, *, across: bool, units: str) -> tuple[Chart, float]:
    """Return a chart with its axes in units that are easy to read, and the factor of the vertical.

    Parameters
    ----------
    chart : Chart
        A chart.
    across : bool
        Whether the unit of the horizontal axis may change. Axes of one scale have one unit.
    units : str
        Unit of lengths.
    """

    def scale(size: float, unit: str) -> UnitScale:
        own, factor = unit_in(unit) if units == "inch" else (unit, 1.0)
        return UnitScale(own, factor) if own != unit else scale_of(size, unit)

    sizes = [max(map(abs, chart.ends[0])), max(map(abs, chart.range))]
    own = [labelled(label)[1] for label in (chart.x, chart.y)]
    if chart.equal:
        sizes = [max(sizes)] * 2
        across = own[0] == own[1]
    x = scale(sizes[0], own[0]) if across else UnitScale(own[0])
    y = scale(sizes[1], own[1]) if across or not chart.equal else UnitScale(own[1])
    if (x.factor, y.factor) == (1.0, 1.0):
        return chart, 1.0
    keys = changes_in if units == "inch" else dict
    changed = replace(
        chart,
        x=_relabelled(chart.x, x),
        y=_relabelled(chart.y, y),
        lines=tuple(replace(one, x=x.factor * one.x, y=y.factor * one.y) for one in chart.lines),
        limits=tuple(replace(one, value=y.times(one.value)) for one in chart.limits),
        marks=tuple(replace(one, value=x.times(one.value)) for one in chart.marks),
        handles=tuple(_scaled(replace(one, keys=keys(one.keys)), x, y) for one in chart.handles),
    )
    return changed, y.factor


def _scaled(one: Handle, x: UnitScale, y: UnitScale) -> Handle:
    """Return a handle on axes in other units."""
    keys = {key: (by / x.factor, up / y.factor) for key, (by, up) in one.keys.items()}
    return Handle(x=x.times(one.x), y=y.times(one.y), keys=keys)


def _relabelled(label: str, to: UnitScale) -> str:
    """Return the label of an axis with another unit."""
    words, unit = labelled(label)
    return f"{words}, {to.unit}" if unit else label


def _steady(values: Array, decimals: int) -> list[float | None] | float:
    return _rounded(values, decimals) if np.ptp(values) else round(float(values[0]), decimals)


def _flat(points: Plane) -> list[float | None]:
    return _rounded(as_pairs(points).ravel(), _MM)


def _digits(values: Array, digits: int = _DIGITS) -> list[float | None]:
    """Return values, rounded to the decimals that the largest needs."""
    sizes = np.abs(values[np.isfinite(values)])
    size = float(sizes.max(initial=0.0))
    return _rounded(values, digits - math.ceil(math.log10(size)) if size else 0)


def _significant(values: Array) -> list[float | None]:
    """Return values for a logarithmic axis, each rounded by itself; null if not positive."""
    return [
        float(f"{one:.{_DIGITS}g}") if 0.0 < one < math.inf else None for one in values.tolist()
    ]


def _rounded(values: Array, decimals: int) -> list[float | None]:
    rounded = np.round(np.asarray(values, dtype=float), decimals) + 0.0  # no -0
    if np.isfinite(rounded).all():
        return rounded.tolist()
    return [value if math.isfinite(value) else None for value in rounded.tolist()]
