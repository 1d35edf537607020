"""Laws put into their places: a function over a turn made of laws on the unit square.

The places of all phases that follow one law are evaluated together, a return that runs it backwards
among them: that is the law placed from the phase's end, with a width below zero.
"""

from __future__ import annotations

from collections.abc import Sequence
from dataclasses import dataclass

import numpy as np

from gearcam.numeric.arrays import Array, Ints
from gearcam.numeric.piecewise import Pieces, Piecewise, members


@dataclass(frozen=True, kw_only=True)
class PlacedPiece:
    """A piece of a law in its place: ``base + scale*S((theta - origin)/width)``.

    Parameters
    ----------
    law : Piecewise or None
        S over the unit interval; None for zero.
    part : int
        Number of the law's piece.
    end : float, rad
        Where the piece ends in its place.
    origin, width : float, rad
        Where the law's interval begins, and its width; below zero where it runs backwards.
    base, scale : float
        Value at the law's zero, and for its one.
    """

    law: Piecewise | None
    part: int
    end: float
    origin: float
    width: float
    base: float
    scale: float


@dataclass(frozen=True, eq=False, kw_only=True)
class PlacedLaws(Pieces):
    """A function made of laws in their places (see `Pieces`); its knots are angles, rad.

    Parameters
    ----------
    laws : tuple of m Piecewise or None
        Each once.
    law, part : (n,) arrays of int
        Number of the law, and of its piece, that counts between two knots.
    origin, per_width, base, scale : (n,) arrays
        How it is placed (see `PlacedPiece`); the width's reciprocal.
    """

    laws: tuple[Piecewise | None, ...]
    law: Ints
    part: Ints
    origin: Array
    per_width: Array
    base: Array
    scale: Array

    def on_pieces(self, index: Ints, x: Array, order: int) -> Array:
        """Return function and derivatives by given pieces (see `Pieces.on_pieces`)."""
        law, part = self.law[index], self.part[index]
        factor, per_width = self.scale[index], self.per_width[index]
        share = (x - self.origin[index]) * per_width
        result = np.empty((order + 1, x.size))
        for number, here in members(law, len(self.laws)):
            shape = self.laws[number]
            values = 0.0 if shape is None else shape.on_pieces(part[here], share[here], order)
            result[:, here] = values
        for values in result:
            values *= factor
            factor = factor * per_width
        result[0] += self.base[index]
        return result


def placed(places: Sequence[PlacedPiece]) -> PlacedLaws:
    """Return the function that laws make in their places.

    Parameters
    ----------
    places : sequence of PlacedPiece
        In rising order, from zero on without gaps.

    Returns
    -------
    PlacedLaws
    """
    laws = {id(place.law): place.law for place in places}
    numbers = {key: number for number, key in enumerate(laws)}
    return PlacedLaws(
        knots=np.array([0.0, *(place.end for place in places)]),
        laws=tuple(laws.values()),
        law=np.array([numbers[id(place.law)] for place in places]),
        part=np.array([place.part for place in places]),
        origin=np.array([place.origin for place in places]),
        per_width=1.0 / np.array([place.width for place in places]),
        base=np.array([place.base for place in places]),
        scale=np.array([place.scale for place in places]),
    )
