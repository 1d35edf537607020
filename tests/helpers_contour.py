"""Exact test contours: gear-like closed curves with corners, known in closed form.

An involute gear with radial root sides and sharp root corners, squashed by a linear map: the
flanks, tips and roots of the squashed wheel are no circular arcs, the radial sides stay straight,
and points and tangents are still exact to rounding. Nothing here comes from the code under test
but the two containers.
"""

from __future__ import annotations

from collections.abc import Callable
from itertools import pairwise

import numpy as np

from gearcam.numeric.contour import Contour, Run
from gearcam.parts.body import Opening, Part
from gearcam.parts.shapes import Circle
from gearcam.pictures.drawings import Drawing

Curve = Callable[[np.ndarray], tuple[np.ndarray, np.ndarray]]
"""Parameter (n,) to complex points and complex vectors along the curve, of any length."""


def arc(centre: complex, radius: float, start: float, end: float) -> Curve:
    """A circular arc from angle `start` to `end`, over u in [0, 1]."""

    def curve(u: np.ndarray) -> tuple[np.ndarray, np.ndarray]:
        angle = start + (end - start) * u
        spoke = radius * np.exp(1j * angle)
        return centre + spoke, 1j * spoke * (end - start)

    return curve


def line(start: complex, end: complex) -> Curve:
    """A straight piece."""
    return lambda u: (start + (end - start) * u, np.full(u.shape, end - start, dtype=complex))


def involute(base: float, origin: float, roll_start: float, roll_end: float, hand: int) -> Curve:
    """The involute of a circle of radius `base`, unwinding to the left (+1) or right (-1)."""

    def curve(u: np.ndarray) -> tuple[np.ndarray, np.ndarray]:
        roll = roll_start + (roll_end - roll_start) * u
        turn = base * np.exp(1j * (origin + hand * roll))
        return turn * (1 - 1j * hand * roll), turn * np.sign(roll_end - roll_start)

    return curve


def involute_gear(teeth: int, module: float) -> list[Curve]:
    """The six smooth pieces of each tooth, counter-clockwise, 20 degrees, sharp root corners."""
    alpha = np.radians(20.0)
    pitch, tip, root = teeth * module / 2, (teeth / 2 + 1) * module, (teeth / 2 - 1.25) * module
    base = pitch * np.cos(alpha)
    start = max(root, base)
    roll = [np.sqrt((radius / base) ** 2 - 1) for radius in (start, tip)]
    half = np.pi / (2 * teeth) + np.tan(alpha) - alpha
    grow = [t - np.arctan(t) for t in roll]
    pieces: list[Curve] = []
    for k in range(teeth):
        centre, step = 2 * np.pi * k / teeth, 2 * np.pi / teeth
        low, high = half - grow[0], half - grow[1]
        foot = [radius * np.exp(1j * (centre - low)) for radius in (root, start)]
        out = [radius * np.exp(1j * (centre + low)) for radius in (start, root)]
        if start > root:
            pieces.append(line(foot[0], foot[1]))
        pieces.append(involute(base, centre - half, roll[0], roll[1], 1))
        pieces.append(arc(0, tip, centre - high, centre + high))
        pieces.append(involute(base, centre + half, roll[1], roll[0], -1))
        if start > root:
            pieces.append(line(out[0], out[1]))
        pieces.append(arc(0, root, centre + low, centre + step - low))
    return pieces


def sample(curve: Curve, allowed: float) -> tuple[Run, np.ndarray]:
    """Sample a piece so that no chord is farther than `allowed` from it; give the chords' bows."""
    count = 1
    while True:
        u = np.linspace(0.0, 1.0, 2 * count + 1)
        points, slopes = curve(u)
        chord = points[2::2] - points[:-2:2]
        bow = np.abs(np.imag((points[1::2] - points[:-2:2]) * np.conj(chord))) / np.abs(chord)
        if bow.max() <= allowed:
            units = np.exp(1j * np.angle(slopes[::2]))
            return Run(points=points[::2], tangents=units), bow
        count = int(np.ceil(count * max(1.05, np.sqrt(bow.max() / allowed))))


def as_pairs(values: np.ndarray) -> np.ndarray:
    """Complex (n,) to (n, 2)."""
    return np.column_stack([np.real(values), np.imag(values)])


def squashed(curve: Curve, squash: tuple[float, float], angle: float) -> Curve:
    """Scale x and y after a turn by `angle`, so that no symmetry is left by accident."""

    def flat(values: np.ndarray) -> np.ndarray:
        return squash[0] * np.real(values) + 1j * squash[1] * np.imag(values)

    def mapped(u: np.ndarray) -> tuple[np.ndarray, np.ndarray]:
        points, slopes = (value * np.exp(1j * angle) for value in curve(u))
        return flat(points), flat(slopes)

    return mapped


def contour_of(pieces: list[Curve], tolerance: float) -> Contour:
    """Chain pieces into a contour; dense to 1/50 of the tolerance, vertices to the tolerance."""
    runs, points, worst = [], [], 0.0
    for piece in pieces:
        dense, _ = sample(piece, tolerance / 50)
        coarse, bow = sample(piece, tolerance)
        runs.append(dense)
        points.append(coarse.points[:-1])
        worst = max(worst, float(bow.max()))
    return Contour(
        dense=lambda: tuple(runs),
        points=np.concatenate(points),
        tolerance=tolerance,
        chord_error=worst,
    )


def gear_contour(
    teeth: int = 36,
    module: float = 5.0,
    tolerance: float = 1e-3,
    squash: tuple[float, float] = (1.0, 0.8),
    angle: float = 0.1,
) -> Contour:
    """A squashed involute wheel as a contour (see the module's docstring)."""
    pieces = [squashed(piece, squash, angle) for piece in involute_gear(teeth, module)]
    return contour_of(pieces, tolerance)


def disc_contour(radius: float, tolerance: float = 1e-3) -> Contour:
    """A full circle made of three runs."""
    cuts = np.linspace(0.0, 2 * np.pi, 4)
    pieces = [arc(0, radius, a, b) for a, b in pairwise(cuts)]
    return contour_of(pieces, tolerance)


def square_contour(side: float, tolerance: float = 1e-3) -> Contour:
    """A square about the origin: four straight runs."""
    half = side / 2
    corners = [
        complex(half, half),
        complex(-half, half),
        complex(-half, -half),
        complex(half, -half),
    ]
    pieces = [line(a, b) for a, b in zip(corners, corners[1:] + corners[:1], strict=True)]
    return contour_of(pieces, tolerance)


def plate(cut: list[Curve], half_mouth: float) -> Contour:
    """A square of 40 mm with a cut in its upper side, about x = 0, given from right to left."""
    pieces = [
        line(-20 - 20j, 20 - 20j),
        line(20 - 20j, 20 + 20j),
        line(20 + 20j, half_mouth + 20j),
        *cut,
        line(-half_mouth + 20j, -20 + 20j),
        line(-20 + 20j, -20 - 20j),
    ]
    return contour_of(pieces, 1e-3)


def bore(diameter: float) -> tuple[Opening, ...]:
    """A round bore about the origin."""
    return (Opening(kind="BORE", shape=Circle(center=0j, diameter=diameter), name="bore"),)


def layers(drawing: Drawing) -> list[str]:
    """The layers in use, in order of first use."""
    return list(dict.fromkeys(feature.layer for feature in drawing.features))


def edges(part: Part) -> list[Contour]:
    """The outlines of a part that are no circles."""
    return [edge for edge in part.contours if isinstance(edge, Contour)]
