"""Drawings: what an exporter of flat files sees.

A *drawing* is a list of *features*; a feature is a shape on a *layer*. Layers end in the kind of
what they hold: OUTLINE, BORE, MARK, CENTRODE, CENTER; a pair's layers begin with the wheel, such as
``GEAR1_OUTLINE``. *Placing* turns and shifts shapes without changing them otherwise.

Refused: a pair of other than two parts.

Depends on parts and numeric, numpy only.
"""

from __future__ import annotations

import cmath
from collections.abc import Iterable, Sequence
from dataclasses import dataclass, replace
from typing import Final

import numpy as np
from numpy.typing import NDArray

from gearcam.numeric.contour import Contour, Run
from gearcam.parts import Part

Array = NDArray[np.float64]

OUTLINE: Final = "OUTLINE"
BORE: Final = "BORE"
MARK: Final = "MARK"
CENTRODE: Final = "CENTRODE"
CENTER: Final = "CENTER"

CROSS_SIZE: Final = 0.04
"""Size of a centre's cross, in centre distances."""


@dataclass(frozen=True, eq=False, kw_only=True)
class Circle:
    """A full circle: its `center` (2,), mm, and its `diameter`, mm."""

    center: Array
    diameter: float


@dataclass(frozen=True, eq=False, kw_only=True)
class Path:
    """A chain of straight pieces: points (n, 2), mm; if closed, the first is not repeated."""

    points: Array
    closed: bool = True


@dataclass(frozen=True, eq=False, kw_only=True)
class Cross:
    """An upright cross: its `center` (2,), mm, and its whole `size`, mm."""

    center: Array
    size: float


Shape = Contour | Circle | Path | Cross


@dataclass(frozen=True, eq=False, kw_only=True)
class Feature:
    """A shape on a layer."""

    layer: str
    shape: Shape

    @property
    def kind(self) -> str:
        """What the layer holds: its name without the wheel."""
        return self.layer.rpartition("_")[2]


@dataclass(frozen=True, eq=False, kw_only=True)
class Drawing:
    """A `name` and its `features`, in drawing order."""

    name: str
    features: tuple[Feature, ...]

    @property
    def contours(self) -> tuple[Contour, ...]:
        """The outlines, in order."""
        return tuple(f.shape for f in self.features if isinstance(f.shape, Contour))

    @property
    def layers(self) -> tuple[str, ...]:
        """The layers in use, in order of first use."""
        return tuple(dict.fromkeys(feature.layer for feature in self.features))


def placed(shape: Shape, angle: float, offset: tuple[float, float]) -> Shape:
    """Turn a shape about the origin, then shift it.

    Parameters
    ----------
    shape : Contour or Circle or Path or Cross
        In its own frame; crosses stay upright.
    angle : float, rad
        Counter-clockwise.
    offset : (2,) tuple, mm
        Shift after the turn.

    Returns
    -------
    Contour or Circle or Path or Cross
        The same object where nothing moves.
    """
    if angle == 0 and offset == (0.0, 0.0):
        return shape
    turn, shift = cmath.exp(1j * angle), complex(*offset)

    def move(points: Array, by: complex = shift) -> Array:
        values = np.ascontiguousarray(points, dtype=np.float64).view(np.complex128)
        return (values * turn + by).view(np.float64)

    match shape:
        case Contour():
            runs = tuple(
                Run(points=move(run.points), tangents=move(run.tangents, 0)) for run in shape.runs
            )
            return replace(shape, runs=runs, vertices=move(shape.vertices))
        case Path():
            return replace(shape, points=move(shape.points))
        case _:
            return replace(shape, center=move(shape.center))


def place(
    features: Iterable[Feature], angle: float, offset: tuple[float, float], prefix: str = ""
) -> tuple[Feature, ...]:
    """Return features placed (see `placed`), a prefix before their layers."""
    return tuple(
        Feature(layer=prefix + feature.layer, shape=placed(feature.shape, angle, offset))
        for feature in features
    )


def part_features(part: Part) -> tuple[Feature, ...]:
    """Return outline, bore and marks of a part, in its own frame."""
    features = [Feature(layer=OUTLINE, shape=part.contour)]
    if part.bore_diameter is not None:
        bore = Circle(center=np.zeros(2), diameter=part.bore_diameter)
        features.append(Feature(layer=BORE, shape=bore))
    for mark in part.marks:
        circle = Circle(center=mark.center, diameter=mark.diameter)
        features.append(Feature(layer=MARK, shape=circle))
    return tuple(features)


def wheel_drawing(part: Part) -> Drawing:
    """Draw one part in its own frame, on the layers OUTLINE, BORE and MARK."""
    return Drawing(name=part.name, features=part_features(part))


def pair_drawing(
    parts: Sequence[Part],
    center_distance: float,
    centrodes: Sequence[Array] = (),
    *,
    name: str = "pair",
    closed: tuple[bool, bool] = (True, True),
) -> Drawing:
    """Draw the assembled pair at phi1 = 0.

    Wheel 1 stands as it is, wheel 2 is shifted by the centre distance.

    Parameters
    ----------
    parts : two Part
        Driver first.
    center_distance : float, mm
        Distance of the shafts; 0 for a rack, which has none.
    centrodes : sequence of (n, 2) arrays, mm
        In the wheels' own frames, driver first; may be empty.
    name : str
        The drawing's name.
    closed : (bool, bool)
        Whether each centrode is closed.

    Returns
    -------
    Drawing

    Raises
    ------
    ValueError
        If there are not two parts, or centrodes for another number of wheels.
    """
    if len(parts) != 2 or len(centrodes) not in (0, 2):
        raise ValueError("a pair takes two parts, and two centrodes or none")
    offsets = ((0.0, 0.0), (float(center_distance), 0.0))
    features: list[Feature] = []
    for number, (part, offset) in enumerate(zip(parts, offsets, strict=True), start=1):
        features += place(part_features(part), 0.0, offset, prefix=f"GEAR{number}_")
    for points, offset, whole in zip(centrodes, offsets, closed, strict=False):
        path = Path(points=np.asarray(points, dtype=np.float64), closed=whole)
        features += place([Feature(layer=CENTRODE, shape=path)], 0.0, offset)
    size = CROSS_SIZE * (center_distance or float(np.ptp(parts[0].contour.vertices)))
    for offset in offsets if center_distance else offsets[:1]:
        cross = Cross(center=np.array(offset), size=size)
        features.append(Feature(layer=CENTER, shape=cross))
    return Drawing(name=name, features=tuple(features))
