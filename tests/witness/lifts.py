"""Lifts once more, from the text of a design, in as many digits as mpmath is told to keep.

Every rise is written out by its textbook: polynomials by their coefficients, the families with
straight parts by their accelerations, which are integrated sector by sector, splines by the
equations that define them. Numbers of a design are taken as the doubles that they are.
"""

from __future__ import annotations

import re
from collections.abc import Callable, Mapping, Sequence
from dataclasses import dataclass
from itertools import pairwise
from math import comb, factorial
from typing import Any

import mpmath

from witness.series import Series, cos, exp, sin

mp: Any = mpmath.mp
Number = Any
Shape = Callable[[Number], list[Number]]
"""Value and three derivatives at a place."""


@dataclass(frozen=True)
class Piece:
    """A smooth piece between two places, with value and three derivatives."""

    low: Number
    high: Number
    shape: Shape


def polynomial(coefficients: Sequence[Number], place: Number = 0) -> Shape:
    """A polynomial in powers of the distance from a place."""

    def shape(x: Number) -> list[Number]:
        t = x - place
        return [
            mp.fsum(
                factorial(j) // factorial(j - k) * c * t ** (j - k)
                for j, c in enumerate(coefficients)
                if j >= k
            )
            for k in range(4)
        ]

    return shape


def formula(text: str, variable: str) -> Callable[[Any], Any]:
    """A formula as a function of numbers, or of power series."""
    names = {"sin": sin, "cos": cos, "exp": exp, "pi": mp.pi, "mpf": mp.mpf}
    numbers = _exact_numbers(text)
    code = compile(numbers, text, "eval")
    return lambda x: eval(code, {"__builtins__": {}}, {**names, variable: x})  # noqa: S307  (a test's own text)


def expanded(function: Callable[[Any], Any]) -> Shape:
    """A function of power series with its derivatives."""
    return lambda x: function(Series.variable(x)).derivatives


def _exact_numbers(text: str) -> str:
    """Wrap decimal numbers, so that they are the doubles that they are read as."""
    return re.sub(r"(?<![\w.])(\d+\.\d*(?:[eE][-+]?\d+)?|\d+[eE][-+]?\d+)", r"mpf(\1)", text)


# --- rises by their accelerations -----------------------------------------------------------------


def _sectors(rows: Sequence[tuple[Number, str, Number, Number]]) -> list[Piece]:
    """Integrate sectors (width, kind, first, second) twice, and scale to 1.

    ``line`` goes from the first to the second value; ``wave`` is ``first*sin(second + w*t)`` with w
    so that it covers the quarter or half of a wave named by its kind.
    """
    made, place, v, s = [], mp.mpf(0), mp.mpf(0), mp.mpf(0)
    for width, kind, a, b in rows:
        if width == 0:
            continue
        if kind == "line":
            shape = polynomial([s, v, a / 2, (b - a) / width / 6], place)
        else:
            w = (mp.pi if kind == "half" else mp.pi / 2) / width
            shape = _wave(place, s, v, a, b, w)
        made.append(Piece(place, place + width, shape))
        place += width
        s, v, *_ = shape(place)
    total = s
    return [Piece(one.low, one.high, _scaled(one.shape, 1 / total)) for one in made]


def _wave(place: Number, s: Number, v: Number, a: Number, b: Number, w: Number) -> Shape:
    def shape(x: Number) -> list[Number]:
        t = x - place
        sine, cosine = mp.sin(b + w * t), mp.cos(b + w * t)
        return [
            s + v * t + a / w * t * mp.cos(b) - a / w**2 * (sine - mp.sin(b)),
            v + a / w * (mp.cos(b) - cosine),
            a * sine,
            a * w * cosine,
        ]

    return shape


def _scaled(shape: Shape, factor: Number) -> Shape:
    return lambda x: [factor * value for value in shape(x)]


def _scca(b: Number, c: Number, d: Number) -> list[Piece]:
    total, half = b + c + d, mp.pi / 2
    b, c, d = b / total, c / total, d / total
    rows = [
        (b / 2, "quarter", 1, mp.mpf(0)), (c / 2, "line", 1, 1), (d / 2, "quarter", 1, half),
        (d / 2, "quarter", -1, mp.mpf(0)), (c / 2, "line", -1, -1), (b / 2, "quarter", -1, half),
    ]  # fmt: skip
    return _sectors(rows)


def _whole(*coefficients: Number) -> list[Piece]:
    return [Piece(mp.mpf(0), mp.mpf(1), polynomial([mp.mpf(c) for c in coefficients]))]


def _two_ended(start: Sequence[float], end: Sequence[float]) -> list[Piece]:
    """The polynomial of least degree with given derivatives at both ends, by its equations."""
    ends = [[0, *start], [1, *end]]
    count = sum(map(len, ends))
    rows, right = mp.matrix(count, count), mp.matrix(count, 1)
    row = 0
    for x, values in enumerate(ends):
        for k, value in enumerate(values):
            for j in range(k, count):
                power = 1 if x or j == k else 0
                rows[row, j] = mp.mpf(factorial(j) // factorial(j - k) * power)
            right[row] = mp.mpf(value)
            row += 1
    return _whole(*mp.lu_solve(rows, right))


def _spline(x: Sequence[Number], y: Sequence[Number], start: Any, end: Any) -> list[Piece]:
    """Quintics through points with given slopes at both ends, C4 at all points between."""
    count = len(x) - 1
    rows, right = mp.matrix(6 * count, 6 * count), mp.matrix(6 * count, 1)
    row = 0

    def tell(terms: Mapping[int, Number], value: Number) -> None:
        nonlocal row
        for column, factor in terms.items():
            rows[row, column] = factor
        right[row] = value
        row += 1

    for k in range(count):
        width = x[k + 1] - x[k]
        tell({6 * k: mp.mpf(1)}, y[k])
        tell({6 * k + j: width**j for j in range(6)}, y[k + 1])
        if k + 1 < count:
            for order in range(1, 5):
                terms = {6 * k + j: comb(j, order) * width ** (j - order) for j in range(order, 6)}
                tell(terms | {6 * (k + 1) + order: mp.mpf(-1)}, mp.mpf(0))
    last = 6 * (count - 1)
    width = x[-1] - x[-2]
    for order in (1, 2):
        tell({order: mp.mpf(factorial(order))}, mp.mpf(start[order - 1]))
        slopes = {
            last + j: factorial(order) * comb(j, order) * width ** (j - order)
            for j in range(order, 6)
        }
        tell(slopes, mp.mpf(end[order - 1]))
    found = mp.lu_solve(rows, right)
    return [
        Piece(x[k], x[k + 1], polynomial([found[6 * k + j] for j in range(6)], x[k]))
        for k in range(count)
    ]


def _b_spline(control: Sequence[float], degree: int) -> list[Piece]:
    """Cox and de Boor, its derivatives as B-splines of differences."""
    values, spans = [mp.mpf(c) for c in control], len(control) - degree

    def de_boor(points: list[Number], p: int, span: int, u: Number) -> Number:
        knots = [mp.mpf(min(max(k - p, 0), spans)) for k in range(len(points) + p + 1)]
        index = span + p
        d = [points[index - p + j] for j in range(p + 1)]
        for r in range(1, p + 1):
            for j in range(p, r - 1, -1):
                low, high = knots[index - p + j], knots[index + 1 + j - r]
                share = (u - low) / (high - low)
                d[j] = (1 - share) * d[j - 1] + share * d[j]
        return d[p]

    levels, p = [values], degree
    for _ in range(3):
        points = levels[-1]
        knots = [min(max(k - p, 0), spans) for k in range(len(points) + p + 1)]
        levels.append(
            [
                p * (b - a) / (knots[i + p + 1] - knots[i + 1])
                for i, (a, b) in enumerate(pairwise(points))
            ]
        )
        p -= 1

    def on_span(span: int) -> Shape:
        return lambda x: [
            de_boor(points, degree - k, span, x * spans) * spans**k
            for k, points in enumerate(levels)
        ]

    return [Piece(mp.mpf(n) / spans, mp.mpf(n + 1) / spans, on_span(n)) for n in range(spans)]


_WIDTHS = {"modified-trapezoid": (0.25, 0.5, 0.25), "modified-sine": (0.25, 0, 0.75)}
_SECTORS: dict[str, Callable[[Number, Number, Number], Any]] = {
    "harmonic": lambda _, h, o: [(h, "quarter", 1, mp.pi / 2), (h, "quarter", -1, o)],
    "cycloidal": lambda _, h, o: [(h, "half", 1, o), (h, "half", -1, o)],
    "constant-acceleration": lambda q, *_: [
        (q, "line", 1 / q, 1 / q), (1 - q, "line", -1 / (1 - q), -1 / (1 - q))
    ],
    "trapezoidal-velocity": lambda q, *_: [
        (q, "line", 1, 1), (1 - 2 * q, "line", 0, 0), (q, "line", -1, -1)
    ],
    "sine-trapezoidal-velocity": lambda q, _, o: [
        (q, "half", 1, o), (1 - 2 * q, "line", 0, 0), (q, "half", -1, o)
    ],
    "trapezoidal-acceleration": lambda q, h, _: [
        (q, "line", 0, 1), (h - 2 * q, "line", 1, 1), (2 * q, "line", 1, -1),
        (h - 2 * q, "line", -1, -1), (q, "line", -1, 0),
    ],
}  # fmt: skip
"""Widths and accelerations by the share q, a half, and zero."""


def rise(phase: Mapping[str, Any]) -> list[Piece]:
    """S over 0 to 1 of the law of a phase."""
    name = phase["law"]
    powers = {
        "constant-velocity": (0, 1), "2-3": (0, 0, 3, -2), "3-4-5": (0, 0, 0, 10, -15, 6),
        "4-5-6-7": (0, 0, 0, 0, 35, -84, 70, -20),
        "5-6-7-8-9": (0, 0, 0, 0, 0, 126, -420, 540, -315, 70),
        "3-4-5-6": (0, 0, 0, 8, -12, 6, -1),
    }  # fmt: skip
    if name in powers:
        return _whole(*powers[name])
    if name in _SECTORS:
        q = mp.mpf(phase.get("q", 0.5 if name == "constant-acceleration" else 0.125))
        return _sectors(_SECTORS[name](q, mp.mpf(1) / 2, mp.mpf(0)))
    if name in _WIDTHS or name == "scca":
        return _scca(*map(mp.mpf, _WIDTHS.get(name) or [phase[key] for key in "bcd"]))
    if name == "polynomial":
        return _two_ended(phase["start"], phase["end"])
    if name == "b-spline":
        return _b_spline(phase["control"], phase.get("degree", 4))
    if name == "table":
        x, y = ([mp.mpf(value) for value in phase[key]] for key in "xy")
        return _spline(x, y, phase.get("start", (0, 0)), phase.get("end", (0, 0)))
    given = formula(phase["formula"], "x")
    low, high = given(mp.mpf(0)), given(mp.mpf(1))
    whole = _scaled(expanded(lambda x: given(x) - low), 1 / (high - low))
    return [Piece(mp.mpf(0), mp.mpf(1), whole)]


# --- a turn ---------------------------------------------------------------------------------------


def _placed(piece: Piece, origin: Number, width: Number, base: Number, scale: Number) -> Piece:
    def shape(theta: Number) -> list[Number]:
        value, *slopes = piece.shape((theta - origin) / width)
        rates = (scale * one / width**k for k, one in enumerate(slopes, 1))
        return [base + scale * value, *rates]

    low, high = sorted(origin + width * end for end in (piece.low, piece.high))
    return Piece(low, high, shape)


def _quintic(start: list[Number], end: list[Number], width: Number) -> list[Number]:
    """Powers of the distance from the start with value and two derivatives at both ends."""
    rows, right = mp.matrix(6, 6), mp.matrix([*start, *end])
    for k in range(3):
        rows[k, k] = mp.mpf(factorial(k))
        for j in range(k, 6):
            rows[3 + k, j] = factorial(j) // factorial(j - k) * width ** (j - k)
    return list(mp.lu_solve(rows, right))


def lift(design: Mapping[str, Any]) -> list[Piece]:
    """The lift of a design over a turn, rad, or a travel, mm."""
    motion, swings = design["motion"], design["follower"].get("motion") == "oscillating"
    unit, scale = ("deg", mp.pi / 180) if swings else ("mm", mp.mpf(1))
    turn = 2 * mp.pi
    if not isinstance(motion, list):
        shape = expanded(formula(motion["lift"], "theta"))
        return [Piece(turn * k / 16, turn * (k + 1) / 16, shape) for k in range(16)]
    sliding = design["cam"].get("form") == "translating"
    phases, key = list(motion), "travel_mm" if sliding else "angle_deg"
    for name, place in (("run_in_mm", 0), ("run_out_mm", len(phases) + 1)):
        if sliding and design["cam"].get(name):
            phases.insert(min(place, len(phases)), {"type": "dwell", key: design["cam"][name]})
    told = [mp.mpf(p[key]) for p in phases if p[key] != "rest"]
    whole = mp.mpf(180 if design["cam"].get("form") == "yoke" else 360)
    if len(told) < len(phases):
        rest = whole - mp.fsum(told)
        told = [rest if p[key] == "rest" else mp.mpf(p[key]) for p in phases]
    share = turn / mp.fsum(told) * (mp.mpf(1) / 2 if design["cam"].get("form") == "yoke" else 1)
    if sliding:
        share = mp.mpf(1)
    state = [mp.mpf(0)] * 4
    if phases[0]["type"] == "segment" and not sliding:  # it leaves as the last phase ends
        state = _run(phases, told, share, (unit, scale), state)[-1].shape(turn)
    made = _run(phases, told, share, (unit, scale), state)
    if design["cam"].get("form") == "yoke":
        made += [_opposite(one, made[-1].shape(mp.pi)[0]) for one in made]
    return made


def _opposite(piece: Piece, total: Number) -> Piece:
    def shape(theta: Number) -> list[Number]:
        value, *slopes = piece.shape(theta - mp.pi)
        return [total - value, *(-one for one in slopes)]

    return Piece(piece.low + mp.pi, piece.high + mp.pi, shape)


def _run(
    phases: Sequence[Mapping[str, Any]],
    told: Sequence[Number],
    share: Number,
    given: tuple[str, Number],
    state: list[Number],
) -> list[Piece]:
    """The pieces of phases, one after the other; the first leaves with a state."""
    made: list[Piece] = []
    place, height, (unit, scale) = mp.mpf(0), mp.mpf(0), given
    for phase, angle in zip(phases, told, strict=True):
        width, kind, top = angle * share, phase["type"], height
        if kind == "segment":
            top = mp.mpf(phase[f"to_{unit}"]) * scale
            names = f"end_velocity_{unit}_per_rad", f"end_acceleration_{unit}_per_rad2"
            ends = [top, *(mp.mpf(phase.get(name, 0)) * scale for name in names)]
            powers = _quintic([height, *state[1:3]], ends, width)
            pieces = [Piece(place, place + width, polynomial(powers, place))]
        elif kind == "dwell":
            pieces = [Piece(place, place + width, polynomial([height], place))]
        else:
            change = mp.mpf(phase[f"lift_{unit}"]) * scale if f"lift_{unit}" in phase else height
            top = height + change if kind == "rise" else height - change
            where = place, width, height, top - height
            if phase["law"] == "3-4-5-6" and kind == "return":
                where = place + width, -width, top, height - top
            placed = (_placed(one, *where) for one in rise(phase))
            pieces = sorted(placed, key=lambda one: one.low)
        made += pieces
        place, height = place + width, top
        state = pieces[-1].shape(place)
    return made
