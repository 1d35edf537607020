"""Plane linkages to any number of digits, from triangles solved by their angles.

The parts are known by their names and sizes. Derivatives are those that mpmath takes
numerically of the positions.
"""

from __future__ import annotations

from collections.abc import Callable, Mapping
from typing import Any

from mpmath import mp

Place = Any
"""A joint: a complex number. A member or a guide: its origin and its direction, an angle."""

Ways = Mapping[str, Callable[[Any], Any]]
"""What shafts and cylinders do over the driver's angle."""


def unit(angle: Any) -> Any:
    return mp.expj(angle)


def places(linkage: Any, ways: Ways, q: Any) -> dict[str, Place]:
    """All joints, members, guides and slides of a linkage at one angle of the driver."""
    known: dict[str, Place] = {"ground": (mp.mpc(0), mp.mpf(0))}
    for part in linkage.elements:
        _PARTS[type(part).__name__](part, known, ways, q)
    return known


def _shaft(part: Any, known: dict[str, Place], ways: Ways, q: Any) -> None:
    known[part.name] = ways[part.name](q)


def _point(part: Any, known: dict[str, Place], ways: Ways, q: Any) -> None:
    del ways, q
    origin, angle = known[part.on]
    known[part.name] = origin + unit(angle) * mp.mpmathify(complex(part.at))


def _guide(part: Any, known: dict[str, Place], ways: Ways, q: Any) -> None:
    del ways, q
    origin, angle = known[part.on]
    at = origin + unit(angle) * mp.mpmathify(complex(part.at))
    known[part.name] = at, angle + mp.mpf(part.direction)


def _crank(part: Any, known: dict[str, Place], ways: Ways, q: Any) -> None:
    del ways, q
    angle = known[part.shaft] + mp.mpf(part.start)
    known[part.name] = known[part.center], angle
    known[part.joint] = known[part.center] + part.length * unit(angle)


def derivatives(linkage: Any, ways: Ways, name: str, q: float, order: int) -> list[complex]:
    """A joint's place and its derivatives by the driver's angle."""
    with mp.workdps(50):
        found = mp.diffs(lambda x: places(linkage, ways, x)[name], mp.mpf(q), order)
        return [complex(one) for one in found]


def _dyad(dyad: Any, known: dict[str, Place], ways: Ways, q: Any) -> None:
    del ways, q
    sizes, sign = dyad.lengths, dyad.sign
    first = mp.mpf(float(sizes.first)) + (known[dyad.driven] if dyad.driven else 0)
    second = mp.mpf(sizes.second)
    beta, gammas = mp.mpf(sizes.beta), (mp.mpf(sizes.gamma1), mp.mpf(sizes.gamma2))
    one, two = known[dyad.first], known[dyad.second]
    lengths = first, second
    angles = _ANGLES[dyad.type](one, two, lengths, beta, gammas, sign)
    joint = _joint(dyad.type, one, two, lengths, angles)
    known[dyad.joint] = joint
    for name, end, angle in zip(dyad.members, (one, two), angles, strict=True):
        # of a member that slides: where its line meets the guide
        begin = _crossing(end, (joint, angle)) if isinstance(end, tuple) else end
        known[name] = begin, angle


def _crossing(one: Any, two: Any) -> Any:
    """Where two lines meet, each given by a point and an angle."""
    ways = [unit(line[1]) for line in (one, two)]
    rows = mp.matrix([[mp.re(ways[0]), -mp.re(ways[1])], [mp.im(ways[0]), -mp.im(ways[1])]])
    gap = two[0] - one[0]
    return one[0] + ways[0] * mp.lu_solve(rows, mp.matrix([mp.re(gap), mp.im(gap)]))[0]


def _rrr(one: Any, two: Any, lengths: Any, beta: Any, gammas: Any, sign: float) -> Any:
    del beta, gammas
    (first, second), way = lengths, two - one
    far, middle = abs(way), mp.arg(way)
    inner = mp.acos((first**2 + far**2 - second**2) / (2 * first * far))
    outer = mp.acos((second**2 + far**2 - first**2) / (2 * second * far))
    return middle + sign * inner, middle + mp.pi - sign * outer


def _to_line(joint: Any, guide: Any, rod: Any, across: Any, sign: float) -> Any:
    """Direction of a rod from a joint to a line beside a guide."""
    origin, angle = guide
    height = mp.im((origin - joint) * unit(-angle)) + across
    rise = mp.asin(height / rod)
    return angle + (rise if sign > 0 else mp.pi - rise)


def _rrt(one: Any, two: Any, lengths: Any, beta: Any, gammas: Any, sign: float) -> Any:
    del beta
    across = lengths[1] * mp.sin(gammas[1])
    return _to_line(one, two, lengths[0], across, sign), two[1] + gammas[1]


def _trr(one: Any, two: Any, lengths: Any, beta: Any, gammas: Any, sign: float) -> Any:
    del beta
    across = lengths[0] * mp.sin(gammas[0])
    return one[1] + gammas[0], _to_line(two, one, lengths[1], across, sign)


def _guide_of(begin: Any, pin: Any, arm: Any, turn: Any, sign: float) -> Any:
    """Direction of a guide through a joint, at the distance of a turned arm from a pin."""
    far = abs(pin - begin)
    # the pin is beside the guide, by this angle seen from its begin
    beside = mp.asin(-arm * mp.sin(turn) / far)
    return mp.arg(pin - begin) - (beside if sign > 0 else mp.pi - beside)


def _rtr1(one: Any, two: Any, lengths: Any, beta: Any, gammas: Any, sign: float) -> Any:
    del gammas
    angle = _guide_of(one, two, lengths[1], beta, sign)
    return angle, angle + beta


def _rtr2(one: Any, two: Any, lengths: Any, beta: Any, gammas: Any, sign: float) -> Any:
    del gammas
    angle = _guide_of(two, one, lengths[0], -beta, sign)
    return angle - beta, angle


def _trt(one: Any, two: Any, lengths: Any, beta: Any, gammas: Any, sign: float) -> Any:
    del lengths, beta, sign
    return one[1] + gammas[0], two[1] + gammas[1]


def _rtt(one: Any, two: Any, lengths: Any, beta: Any, gammas: Any, sign: float) -> Any:
    del one, lengths, sign
    return two[1] + gammas[1] - beta, two[1] + gammas[1]


def _ttr(one: Any, two: Any, lengths: Any, beta: Any, gammas: Any, sign: float) -> Any:
    del two, lengths, sign
    return one[1] + gammas[0], one[1] + gammas[0] + beta


_ANGLES: Mapping[str, Callable[..., Any]] = {
    "RRR": _rrr,
    "RRT": _rrt,
    "TRR": _trr,
    "RTR1": _rtr1,
    "RTR2": _rtr2,
    "TRT": _trt,
    "RTT": _rtt,
    "TTR": _ttr,
}


def _joint(kind: str, one: Any, two: Any, lengths: Any, angles: Any) -> Any:
    """The middle joint from the members' angles: from the end that has a rod, or between lines."""
    if kind in ("RRR", "RRT", "RTT", "RTR2"):
        return one + lengths[0] * unit(angles[0])
    if kind in ("TRR", "TTR", "RTR1"):
        return two + lengths[1] * unit(angles[1])
    lines = [
        (guide[0] + length * unit(angle), guide[1])
        for guide, length, angle in zip((one, two), lengths, angles, strict=True)
    ]
    return _crossing(*lines)


_PARTS: Mapping[str, Callable[..., None]] = {
    "GivenMotion": _shaft,
    "MemberPoint": _point,
    "GuideLine": _guide,
    "Crank": _crank,
    "Dyad": _dyad,
}
