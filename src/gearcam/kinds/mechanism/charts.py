"""The charts of a mechanism.

Velocities and what follows are by time if the master has a speed, else by its angle. Where drives
are compared, every output has a line for each of them.
"""

from __future__ import annotations

from collections.abc import Iterator
from functools import partial
from typing import TYPE_CHECKING, Any, Final

import numpy as np

from gearcam.kinds.mechanism.asked import DEG, RATES
from gearcam.linkages.transmission import ADMISSIBLE, pressure_angle
from gearcam.pictures.charts import Chart, Charts, Limit, Line, MarkedPlace, knot_marks

if TYPE_CHECKING:
    from gearcam.kinds.mechanism.result import MechanismResult

_MOST: Final = 9
"""Most lines of a chart of several drives."""

_STEADY: Final = 1e-9
"""Range of a pressure angle that does not change, rad."""

_WORDS: Final = ("position", *RATES)


def _marks(result: MechanismResult) -> tuple[MarkedPlace, ...]:
    """Return knots, and where intervals that the design asks for begin and end."""
    low, high = result.linkage.span
    ends = [
        MarkedPlace(
            label=f"last bit of {one.on}",
            # one over the end of a cycle ends in the next
            value=DEG * (value if value <= high else value - (high - low)),
        )
        for one, found in zip(result.design.interval, result.intervals, strict=True)
        for value in (found.begin, found.end)
    ]
    return (*knot_marks(DEG * result.linkage.knots, DEG * low, DEG * high), *ends)


def _chart(angle: bool, order: int, result: MechanismResult) -> Chart | None:
    """Return the chart of a derivative of all outputs that are angles, or lengths."""
    drives = result.machines if result.compared else {"": result}
    numbers = [k for k, one in enumerate(result.outputs) if one.angle == angle]
    numbers = numbers[: max(1, _MOST // len(drives))]
    if not numbers:
        return None
    lines = [line for name, other in drives.items() for line in _lines(other, name, numbers, order)]
    outputs = [result.outputs[k] for k in numbers]
    names = ", ".join(
        dict.fromkeys(one.name.removesuffix(".angle").removesuffix(".turn") for one in outputs)
    )
    word = "direction" if angle and not order else _WORDS[order]
    called = f"Angular {word}" if angle and order else word.capitalize()
    return Chart(
        title=f"{called} of {names}",
        x=result.axis,
        y=f"{called.lower()}, {_unit(angle, order, timed=result.speed is not None)}",
        lines=tuple(lines),
        marks=_marks(result),
    )


def _unit(angle: bool, order: int, *, timed: bool) -> str:
    """Return the unit of a derivative by time, or by the master's angle."""
    if not order:
        return "deg" if angle else "mm"
    power = "" if order == 1 else str(order)
    return f"{'rad' if angle else 'mm'}/{'s' if timed else 'rad'}{power}"


def _lines(result: MechanismResult, name: str, numbers: list[int], order: int) -> Iterator[Line]:
    q, curves = result.curves
    for k in numbers:
        one = result.outputs[k]
        scale = (result.speed or 1.0) ** order if order else one.unit[0]
        own = one.stem if len(numbers) > 1 or not name else ""
        label = ", ".join(word for word in (own, name) if word)
        yield Line(label=label, x=DEG * q, y=scale * curves[k][order])


def _path_chart(result: MechanismResult) -> Chart | None:
    """Return the paths of points in the plane."""
    names = [*result.paths]
    if not names:
        return None
    q, _ = result.curves
    lines = []
    for name in names:
        points = np.broadcast_to(np.asarray(result.linkage.track(name, q, 0).c[0]), q.shape)
        lines.append(Line(label=name, x=np.real(points) + 0.0, y=np.imag(points) + 0.0))
    return Chart(title=f"Path of {', '.join(names)}", x="x, mm", y="y, mm", lines=tuple(lines))


def _transmission_chart(result: MechanismResult) -> Chart | None:
    """Return the pressure angles of the dyads in which they change."""
    q, _ = result.curves
    known = result.linkage.at(q, 0)
    dyads = [one.dyad for one in result.transmissions if one.pressure_angle is not None]
    dyads = [one for one in dyads if np.ptp(pressure_angle(known, one)) > _STEADY]
    if not dyads:
        return None
    lines = [
        Line(label=one.joint, x=DEG * q, y=DEG * pressure_angle(known, one) + np.zeros(q.shape))
        for one in dyads
    ]
    given: Any = result.design.limits.get("pressure_angle")
    types = {one.type for one in dyads} & {*ADMISSIBLE}
    limits = {f"limit of {one}": ADMISSIBLE[one].pressure_angle[0] for one in sorted(types)}
    limits = limits if given is None else {"limit": given}
    return Chart(
        title="Pressure angle: 90 deg less the transmission angle",
        x=result.axis,
        y="pressure angle, deg",
        lines=tuple(lines),
        limits=tuple(Limit(label=name, value=DEG * one) for name, one in limits.items()),
        marks=_marks(result),
    )


CHARTS: Final[Charts] = {
    "motion": partial(_chart, False, 0),
    "velocity": partial(_chart, False, 1),
    "acceleration": partial(_chart, False, 2),
    "direction": partial(_chart, True, 0),
    "angular_velocity": partial(_chart, True, 1),
    "angular_acceleration": partial(_chart, True, 2),
    "pressure_angle": _transmission_chart,
    "path": _path_chart,
    "jerk": partial(_chart, False, 3),
    "angular_jerk": partial(_chart, True, 3),
}
"""Charts by name; the report leads with the first three."""
