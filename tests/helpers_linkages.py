"""Plane linkages of the text books, the laws that drive them, and numbers known to twelve digits.

The numbers in `values/linkages` were computed with 60 digits from other formulas, their
derivatives as numerical derivatives of the positions.
"""

from __future__ import annotations

import csv
from collections.abc import Mapping, Sequence
from itertools import pairwise
from math import pi
from pathlib import Path
from typing import Any

import numpy as np
import pytest

from gearcam.linkages.dyads import Lengths
from gearcam.linkages.elements import Crank, Dyad, Element, GivenMotion, GuideLine, Law, MemberPoint
from gearcam.linkages.linkage import Linkage, in_order
from gearcam.numeric import jets
from gearcam.numeric.arrays import Array
from gearcam.numeric.jets import Jet

TURN = 2.0 * pi

_VALUES = Path(__file__).parent / "values" / "linkages"

_PRINTED = 1e-11
"""Relative accuracy of twelve digits."""

_ROUNDED = 1e-13
"""Rounding, as a share of the largest number of a column."""


def rows(name: str) -> list[dict[str, str]]:
    """Rows of a table of values."""
    with (_VALUES / f"{name}.csv").open(encoding="utf-8", newline="") as file:
        return list(csv.DictReader(file))


def column(table: Sequence[Mapping[str, str]], name: str) -> Array:
    """One column of a table, as numbers."""
    return np.array([float(row[name]) for row in table])


def agree(
    found: Array | float, printed: Array | float, scale: float = 0.0, relative: float = _PRINTED
) -> None:
    """Assert that numbers agree with printed ones, or with `scale` to rounding where that is more.

    Without a scale, the largest of the printed numbers is it.
    """
    wanted = np.asarray(printed, dtype=float)
    room = relative * np.abs(wanted) + _ROUNDED * max(scale, float(np.abs(wanted).max()))
    off = np.abs(np.asarray(found) - wanted) / room
    assert np.all(off <= 1.0), f"{np.nanmax(off)} times the room, of {wanted.ravel()[off.argmax()]}"


def angles_agree(found: Array, printed_deg: Array | float) -> None:
    """Assert that angles in rad agree with printed ones in degrees, but for whole turns."""
    wanted = np.radians(printed_deg)
    apart = np.asarray(found) - wanted
    agree(apart - TURN * np.round(apart / TURN), np.zeros_like(apart), scale=100.0 * pi)


def state(place: complex, speed: complex, acceleration: complex, order: int = 2) -> Jet:
    """Jet of ``place + speed*t + acceleration*t^2/2`` at t = 0."""
    return Jet([np.array([place]), speed, 0.5 * acceleration, *[0.0] * (order - 2)][: order + 1])


def variable(q: Array, order: int) -> Jet:
    """The driver itself: a shaft that turns evenly."""
    return Jet.variable(q, order)


def turned(sign: float) -> Law:
    """A shaft that turns by `sign` times the driver's angle."""
    return lambda q, order: Jet.variable(q, order) * sign


def phases(knots_deg: Sequence[float], ratios: Sequence[float]) -> Law:
    """The turn of wheel 2 of a pair whose ratio goes in cosine steps; also over several turns."""
    knots = np.radians(knots_deg)

    def law(q: Array, order: int) -> Jet:
        whole = TURN * np.floor(np.asarray(q) / TURN) if knots[-1] >= TURN - 1e-9 else 0.0 * q
        rest, found, begun = q - whole, [], 0.0
        for (begin, end), (first, last) in zip(pairwise(knots), pairwise(ratios), strict=True):
            mean, half, rate = 0.5 * (first + last), 0.5 * (first - last), pi / (end - begin)
            x = Jet.variable(rest - begin, order)
            found.append(x * mean + jets.sin(x * rate) * (half / rate) + begun)
            begun += mean * (end - begin)
        piece = np.clip(np.searchsorted(knots, rest, "right") - 1, 0, len(found) - 1)
        full = [[np.broadcast_to(c, rest.shape) for c in one.c] for one in found]
        values = [np.choose(piece, [one[k] for one in full]) for k in range(order + 1)]
        return Jet([values[0] + begun * np.round(whole / TURN), *values[1:]])

    return law


TWO_PHASES = (0.0, 160.0, 360.0), (1.6, 0.4, 1.6)
THREE_PHASES = (0.0, 160.0, 270.0, 360.0), (1.6, 0.4, 1.06, 1.6)
"""Knots in degrees and ratios of the nail machine's pairs."""


def linkage(
    *elements: Element, knots_deg: Sequence[float] = (0.0, 360.0), closed: bool = True
) -> Linkage:
    """Linkage of parts in any order, behind an even drive ``q`` if they have no other."""
    parts = list(elements)
    if not any(isinstance(one, GivenMotion) for one in parts):
        parts.append(GivenMotion("q", variable))
    return Linkage(in_order(parts), np.radians(knots_deg), closed)


def four_bar(
    crank: float = 40.0,
    coupler: float = 120.0,
    rocker: float = 90.0,
    base: float = 110.0,
    sign: float = 1.0,
    keeps: str = "branch",
) -> Linkage:
    """Four-bar with a point P of its coupler at 60 mm, +35 deg from BC."""
    return linkage(
        MemberPoint("A", 0j),
        MemberPoint("D", complex(base)),
        Crank("crank", "q", "A", "B", crank),
        Dyad(
            "RRR", "B", "D", "C", ("coupler", "rocker"), Lengths(coupler, rocker), sign, keeps=keeps
        ),
        MemberPoint("P", 60.0 * np.exp(1j * np.radians(35.0)), "coupler"),
    )


def crank_slider(
    crank: float,
    rod: float,
    height: float = 0.0,
    *,
    law: Law = variable,
    start: float = 0.0,
    keeps: str = "branch",
    knots_deg: Sequence[float] = (0.0, 360.0),
) -> Linkage:
    """Crank-slider; the slide's place along +x is ``slide.guide2``."""
    return linkage(
        GivenMotion("q", law),
        MemberPoint("O", 0j),
        GuideLine("bed", 1j * height, 0.0),
        Crank("crank", "q", "O", "pin", crank, start),
        Dyad("RRT", "pin", "bed", "slide", ("rod", "ram"), Lengths(rod, 0.0), keeps=keeps),
        knots_deg=knots_deg,
    )


def swinging_guide(crank: float, distance: float, *more: Element) -> Linkage:
    """Crank whose pin moves a block along a guide that swings about (0, -distance)."""
    return linkage(
        MemberPoint("O", 0j),
        MemberPoint("pivot", -1j * distance),
        Crank("crank", "q", "O", "pin", crank),
        Dyad("RTR1", "pivot", "pin", "block", ("guide", "slide"), Lengths(0.0, 0.0)),
        *more,
    )


def derivatives(made: Linkage, name: str, degrees: Array, order: int) -> list[Array]:
    """One quantity and its derivatives at angles of the driver in degrees."""
    return made.track(name, np.radians(degrees), order).derivatives()


def halve_products_of_speeds(monkeypatch: pytest.MonkeyPatch) -> None:
    """Break jets: the factor 2 of Coriolis is lost, places and speeds stay right."""
    multiplied = Jet.__mul__

    def halved(self: Jet, other: Any) -> Jet:
        found = multiplied(self, other)
        if isinstance(other, Jet) and self.order >= 2:
            lost = 0.5 * np.asarray(self.c[1]) * other.c[1]
            return Jet([*found.c[:2], found.c[2] - lost, *found.c[3:]])
        return found

    monkeypatch.setattr(Jet, "__mul__", halved)
