"""Lifts of cams that move an elastic follower exactly as a program says, at one speed.

The mass of a follower on a train (k, c), with a spring (ks, cs) behind it, follows a lift s if the
cam's lift is ``y = s + v`` with

    c*W*v' + k*v = m*W^2*s'' + cs*W*s' + ks*s =: k*q

so that without damping ``v = q``: a *polydyne* cam, of any motion law. Constant loads shift the
mass, and do not change its motion. With a damper v is the periodic solution, by collocation in
small cells as in `gearcam.dynamics.periodic`; its derivatives follow from ``v' = (q - v)*k/(c*W)``.
The second derivative of the cam's lift has the fourth of the program, so that the jerk must not
jump.

Sources: Dudley (1948), Stoddart (1953) for polynomials; here for every program.
"""

from __future__ import annotations

import math
from dataclasses import dataclass, replace
from typing import Final

import numpy as np

from gearcam.base.display import ShortRepr
from gearcam.base.errors import InfeasibleError
from gearcam.dynamics.periodic import NODES, passing
from gearcam.laws.program import Program
from gearcam.numeric.arrays import Array
from gearcam.numeric.chebyshev import Expansion, expand
from gearcam.numeric.jets import Jet
from gearcam.numeric.piecewise import Piece, Piecewise

_CELLS: Final = 720
"""Cells of a turn, at least."""

_SMALL: Final = 0.3
"""Largest width of a cell over the way in which the damper lets v follow."""

_EXACT: Final = 1e-13
"""Error of the expansion of v, relative."""

_SMOOTH: Final = 3
"""Derivative of the program that must not jump."""


@dataclass(frozen=True, kw_only=True)
class Train(ShortRepr):
    """A follower of one mass on an elastic train, on a cam that turns evenly.

    Parameters
    ----------
    mass, stiffness, damping : float
        The mass, and the train before it.
    spring, damper : float
        Stiffness and damping between mass and frame.
    speed : float, rad/s
        Of the cam.
    """

    mass: float
    stiffness: float
    damping: float
    spring: float
    damper: float
    speed: float


def polydyne(program: Program, train: Train) -> Program:
    """Return the lift of a cam that moves the mass of a train as a program says.

    Parameters
    ----------
    program : Program
        The motion of the mass.
    train : Train
        What is between it and the cam.

    Raises
    ------
    InfeasibleError
        If the jerk of the program jumps.
    """
    if program.continuity < _SMOOTH:
        first = next(one for one in program.jumps if one.order <= _SMOOTH)
        name = ("velocity", "acceleration", "jerk")[first.order - 1]
        what = f"a polydyne cam needs a motion without jumps of the jerk: its {name} jumps at "
        what += f"{math.degrees(first.theta):.6g} deg"
        near = 'law = "4-5-6-7" or "5-6-7-8-9"'
        raise InfeasibleError(what, where="motion", nearest=near)
    bent = _Bent(program, train, _lagging(program, train) if train.damping else None)
    pieces = tuple(
        Piece(bent, parameters=(float(number),)) for number in range(len(program.knots) - 1)
    )
    lift = Piecewise(knots=program.knots, pieces=pieces, offsets=np.zeros(len(pieces)))
    return replace(program, lift=lift, errors=bent.errors)


@dataclass(frozen=True)
class _Bent(ShortRepr):
    """The lift of the cam in its pieces: ``y = s + v``."""

    program: Program
    train: Train
    lagging: Expansion | None

    def __call__(self, x: Jet, number: Array | float) -> Jet:
        at, order = np.atleast_1d(x.c[0]), x.order
        piece = np.broadcast_to(np.rint(number).astype(int), at.shape)
        s = self.program.lift.on_pieces(piece, at, order + 2)
        q = _forced(self.train, s)
        v = q if self.lagging is None else self._lag(self.lagging(at), q)
        size = [math.factorial(k) for k in range(order + 1)]
        return Jet([(one + two) / k for one, two, k in zip(s, v, size, strict=False)])

    def _lag(self, v: Array, q: Array) -> Array:
        """Return v and its derivatives from its value, and q with its own."""
        found = [v]
        for value in q[:-1]:
            found.append(_rate(self.train) * (value - found[-1]))
        return np.array(found)

    @property
    def errors(self) -> tuple[float, ...]:
        """Errors of the lift and of its derivatives."""
        grown = 1.0 + self.train.spring / self.train.stiffness
        rate = 0.0 if self.lagging is None else _rate(self.train)
        size = 0.0 if self.lagging is None else float(np.abs(self.lagging.coefficients).max())
        return tuple(
            grown * one + _EXACT * size * rate**order
            for order, one in enumerate(self.program.errors)
        )


def _rate(train: Train) -> float:
    return train.stiffness / (train.damping * train.speed)


def _forced(train: Train, s: Array) -> Array:
    """Return q and derivatives from the lift and its derivatives, two more."""
    force = train.mass * train.speed**2 * s[2:] + train.damper * train.speed * s[1:-1]
    return (force + train.spring * s[:-2]) / train.stiffness


def _lagging(program: Program, train: Train) -> Expansion:
    """Return the periodic solution of ``v' = rate*(q - v)``."""
    rate, knots = _rate(train), program.knots
    widest = min(program.period / _CELLS, _SMALL / rate)
    counts = np.ceil(np.diff(knots) / widest).astype(int).tolist()
    parts = zip(knots[:-1].tolist(), knots[1:].tolist(), counts, strict=True)
    edges = np.concatenate(
        [*(np.linspace(low, high, n + 1)[:-1] for low, high, n in parts), knots[-1:]]
    )

    def put(low: Array, width: Array) -> tuple[Array, Array]:
        """Share of v that is left behind a cell, and what q in it adds."""
        x = low[:, None] + width[:, None] * NODES
        piece = np.searchsorted(knots[1:-1], low + 0.5 * width, side="right")
        s = program.lift.on_pieces(np.repeat(piece, len(NODES)), x.ravel(), 2)
        left, inward = passing(np.array([[-rate]]), np.array([[rate]]), width)
        q = _forced(train, s).reshape(x.shape)
        return left[:, 0, 0], np.einsum("ng,ng->n", inward[:, :, 0, 0], q)

    left, added = put(edges[:-1], np.diff(edges))
    values = [0.0]
    for share, more in zip(left.tolist(), added.tolist(), strict=True):
        values.append(share * values[-1] + more)
    decay = np.cumprod([1.0, *left])
    at_edges = np.array(values) + values[-1] / (1.0 - decay[-1]) * decay  # as after a turn

    def lag(x: Array) -> Array:
        cell = np.clip(edges.searchsorted(x, side="right") - 1, 0, len(edges) - 2)
        left, added = put(edges[cell], x - edges[cell])
        return left * at_edges[cell] + added

    return expand(lag, knots, _EXACT)
