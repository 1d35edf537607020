"""Where a cutter stands on a wheel when it has rolled the arc length s.

From the raw law: arc length and driven angle by Gauss quadrature on short panels (20 nodes each,
exact to rounding for these laws), its inverse by Newton's method inside the panel.
"""

from __future__ import annotations

from dataclasses import dataclass
from functools import cached_property
from typing import Any

import numpy as np
from numpy.typing import NDArray

from witness.laws import Law

Array = NDArray[np.floating[Any]]
_NODES, _WEIGHTS = np.polynomial.legendre.leggauss(20)


@dataclass(frozen=True, eq=False)
class Frames:
    """Pitch point, unit tangent (towards growing s) and outward unit normal, each (n, 2)."""

    point: Array
    tangent: Array
    normal: Array


@dataclass(frozen=True, eq=False)
class Rolling:
    """Both centrodes of a closed pair: a law, a centre distance in mm; mate -1 is a ring."""

    law: Law
    distance: float
    mate: int = 1
    panels: int = 64

    @cached_property
    def _edges(self) -> Array:
        parts = [np.linspace(*piece.span(np), self.panels + 1)[:-1] for piece in self.law]
        return np.append(np.concatenate(parts), self.law[-1].span(np)[1])

    @cached_property
    def _sums(self) -> tuple[Array, Array]:
        """Arc length and driven angle at the edges of the panels."""
        low, high = self._edges[:-1], self._edges[1:]
        arcs, angles = self._panel(np.arange(len(low)), low, high)
        return tuple(np.concatenate([[0.0], np.cumsum(part)]) for part in (arcs, angles))  # pyright: ignore[reportReturnType]

    def _panel(self, panel: NDArray[np.int64], low: Array, high: Array) -> tuple[Array, Array]:
        half = (high - low) / 2
        phi = (low + half)[:, None] + half[:, None] * _NODES
        i, _, r, dr = self._radii(np.repeat(panel[:, None], len(_NODES), axis=1), phi)
        return half * (np.hypot(r, dr) @ _WEIGHTS), half * (i @ _WEIGHTS)

    def _radii(self, panel: NDArray[np.int64], phi: Array) -> tuple[Array, Array, Array, Array]:
        """i, i', r1, r1' with the law's piece that the panel belongs to."""
        i, di = np.empty_like(phi), np.empty_like(phi)
        for k, piece in enumerate(self.law):
            mine = panel // self.panels == k
            i[mine], di[mine], _ = piece.ratio(phi[mine], np)
        rest = 1 + self.mate * i
        return i, di, self.distance * i / rest, self.distance * di / rest**2

    @property
    def length(self) -> float:
        """Length of either centrode, mm."""
        return float(self._sums[0][-1])

    def _angles(self, s: Array) -> tuple[NDArray[np.int64], Array, Array, Array]:
        """Panel, phi1, phi2 and whole turns at arc lengths of any size."""
        turn = np.floor(s / self.length)
        rest = s - turn * self.length
        arcs, driven = self._sums
        panel = np.clip(np.searchsorted(arcs, rest, side="right") - 1, 0, len(arcs) - 2)
        low, high = self._edges[panel], self._edges[panel + 1]
        phi = low + (high - low) * (rest - arcs[panel]) / (arcs[panel + 1] - arcs[panel])
        for _ in range(4):
            _, _, r, dr = self._radii(panel, phi)
            phi = phi - (arcs[panel] + self._panel(panel, low, phi)[0] - rest) / np.hypot(r, dr)
        return panel, phi, driven[panel] + self._panel(panel, low, phi)[1], turn

    def angles(self, s: Array) -> Array:
        """Driver angles, rad, at arc lengths within one turn."""
        return self._angles(np.asarray(s, dtype=float))[1]

    def frames(self, wheel: int, s: Array) -> Frames:
        """The frames of wheel 1 or 2 in its own coordinates, at arc lengths s in mm."""
        panel, phi, driven, turn = self._angles(np.asarray(s, dtype=float))
        i, _, r, dr = self._radii(panel, phi)
        if wheel == 1:
            angle, radius, slope, spin = phi, r, dr, np.ones_like(phi)
        elif self.mate < 0:  # a ring, around its shaft as the driver is around its own
            angle = driven + turn * self._sums[1][-1]
            radius, slope, spin = self.distance + r, dr, i
        else:
            driven = driven + turn * self._sums[1][-1]
            angle, radius, slope, spin = np.pi - driven, self.distance - r, -dr, -i
        outward = np.stack([np.cos(angle), np.sin(angle)], axis=-1)
        around = np.stack([-outward[..., 1], outward[..., 0]], axis=-1)
        tangent = slope[..., None] * outward + (radius * spin)[..., None] * around
        tangent /= np.linalg.norm(tangent, axis=-1, keepdims=True)
        side = 1.0 if wheel == 1 else -1.0
        normal = side * np.stack([tangent[..., 1], -tangent[..., 0]], axis=-1)
        return Frames(radius[..., None] * outward, tangent, normal)


@dataclass(frozen=True)
class Basic:
    """The basic rack; lengths in modules but for the module itself, angles in rad."""

    module: float
    alpha: float = np.pi / 9
    addendum: float = 1.0
    dedendum: float = 1.25
    tip_radius: float = 0.38

    def space(self, wheel: int, k: int) -> float:
        """Arc length of the middle of the space that follows tooth k (counted from 1), mm."""
        return (k - 0.5 if wheel == 1 else k) * np.pi * self.module
