"""Drawings: the data of exporters of flat files.

A *drawing* is a list of *features*; a feature is a shape on a *layer*. Layers end in the type of
their shapes: OUTLINE, BORE, HOLE, SLOT, INNER (inner teeth), MARK, CENTRODE, CENTER; a pair's
layers begin with the wheel, such as ``GEAR1_OUTLINE``. A cam's outline is its PROFILE; PITCH, PRIME
and FOLLOWER are for reference, TOOL is the path of a cutter's centre, and LABEL a part's name. The
walls of a groove are on INNER and OUTER, a groove with ends on GROOVE, and the edge of its blank on
BLANK. The links of a machine are on MEMBER, its guides and pivots on GROUND, the paths of its
points on PATH, and the machine at other places on GHOST. *Placing* turns and shifts shapes.

The *kerf*, the width of a cut, is not part of the geometry: it moves the paths of a drawing for
cutting, whose layers then end in ``_KERF``. Such a drawing holds only what is cut or engraved.

Refused: a kerf that is too wide for an opening or an outline.

Depends on parts and numeric, numpy only.
"""

from __future__ import annotations

from collections.abc import Iterable, Iterator
from dataclasses import dataclass, replace
from typing import Final

import numpy as np

from gearcam.base.display import ShortRepr
from gearcam.base.errors import beyond_limit
from gearcam.base.numerals import formatted
from gearcam.numeric.arrays import Plane, bounds
from gearcam.numeric.contour import Contour
from gearcam.numeric.pose import UNMOVED, Pose
from gearcam.parts.body import Part
from gearcam.parts.shapes import Circle, Loop

OUTLINE: Final = "OUTLINE"
BORE: Final = "BORE"
HOLE: Final = "HOLE"
SLOT: Final = "SLOT"
GROOVE: Final = "GROOVE"
INNER: Final = "INNER"
OUTER_WALL: Final = "OUTER"
BLANK: Final = "BLANK"
MARK: Final = "MARK"
CENTRODE: Final = "CENTRODE"
CENTER: Final = "CENTER"
PROFILE: Final = "PROFILE"
PITCH: Final = "PITCH"
PRIME: Final = "PRIME"
FOLLOWER: Final = "FOLLOWER"
TOOL: Final = "TOOL"
LABEL: Final = "LABEL"
MEMBER: Final = "MEMBER"
GROUND: Final = "GROUND"
TRACE: Final = "PATH"
GHOST: Final = "GHOST"

OUTER: Final = (OUTLINE, PROFILE, BLANK)
THROUGH: Final = (BORE, HOLE, SLOT, INNER, GROOVE)
"""Types that are cut: around the part, and right through it."""

ENGRAVED: Final = (MARK, LABEL)
"""Types that are marked on a part before it is cut."""

FILLED: Final = (*OUTER, FOLLOWER, MEMBER)
"""Types whose closed shapes are drawn filled, each with the openings that follow it."""

DASHED: Final = (CENTRODE, PITCH, PRIME, TRACE)
"""Types that are drawn dashed."""

KERF: Final = "_KERF"
"""Ending of layers with cutting paths instead of edges of the part."""

CLOSED: Final = (
    *OUTER,
    INNER,
    GROOVE,
    OUTER_WALL,
    PITCH,
    TOOL,
    *(kind + KERF for kind in (*OUTER, BORE, SLOT, INNER, GROOVE)),
)
"""Ends of layers whose closed curves are contours."""

CROSS_SIZE: Final = 0.04
"""Size of a centre cross, in centre distances."""


@dataclass(frozen=True, eq=False, kw_only=True)
class Path(ShortRepr):
    """A polyline: complex points (n,), mm; if closed, the first is not repeated."""

    points: Plane
    closed: bool = True


@dataclass(frozen=True, eq=False, kw_only=True)
class Cross(ShortRepr):
    """An upright cross: its `center`, complex, mm, and its whole `size`, mm."""

    center: complex
    size: float


Shape = Contour | Circle | Loop | Path | Cross


@dataclass(frozen=True, eq=False, kw_only=True)
class Feature(ShortRepr):
    """A `shape` on a `layer`; `metal` if the part lies inside it, as inside an outline."""

    layer: str
    shape: Shape
    metal: bool = False

    @property
    def kind(self) -> str:
        """Type of the layer: its name without wheel and kerf."""
        return self.layer.removesuffix(KERF).rpartition("_")[2]


@dataclass(frozen=True, eq=False, kw_only=True)
class Drawing(ShortRepr):
    """A `name` and its `features`, in drawing order; if not `cut`, all of it is for reference."""

    name: str
    features: tuple[Feature, ...]
    cut: bool = True

    @property
    def contours(self) -> tuple[Contour, ...]:
        """The outlines, in order."""
        return tuple(f.shape for f in self.features if isinstance(f.shape, Contour))


def placed(shape: Shape, pose: Pose) -> Shape:
    """Return a shape in its place.

    Parameters
    ----------
    shape : Contour or Circle or Loop or Path or Cross
        In its own frame; crosses stay upright.
    pose : Pose
        Where it is.

    Returns
    -------
    Contour or Circle or Loop or Path or Cross
        The same object if nothing moves.
    """
    if pose == UNMOVED:
        return shape

    match shape:
        case Contour():
            return shape.placed(pose)
        case Path() | Loop():
            return replace(shape, points=pose.apply(shape.points))
        case _:
            return replace(shape, center=complex(pose.apply(shape.center)))


def mirrored(shape: Shape) -> Shape:
    """Return the mirror image of a `shape` in the x axis; of a contour its polygon, as a path."""
    match shape:
        case Contour(points=points):
            return Path(points=np.conj(points)[::-1])
        case Path(points=points):
            return replace(shape, points=np.conj(points))
        case Loop(points=points, bulges=bulges):
            # a bulge belongs to the piece behind its point
            return replace(shape, points=np.conj(points)[::-1], bulges=np.roll(bulges[::-1], -1))
        case _:
            return replace(shape, center=shape.center.conjugate())


def reach(shape: Shape) -> Plane:
    """Return points, complex, mm, with the same bounding box as a `shape`."""
    match shape:
        case Contour(points=points) | Path(points=points) | Loop(points=points):
            return points
        case Circle(center=center, diameter=size) | Cross(center=center, size=size):
            corner = 0.5 * size * (1 + 1j)
            return np.array([center - corner, center + corner])


def box(features: Iterable[Feature]) -> tuple[complex, complex]:
    """Return the lower left and the upper right corner of `features`, complex, mm."""
    return bounds(np.concatenate([reach(feature.shape) for feature in features]))


def chains(shape: Shape, sagitta: float) -> Iterator[tuple[Plane, bool]]:
    """Yield the polylines of a `shape`, chord error at most `sagitta`, mm, and if they close."""
    match shape:
        case Path(points=points, closed=closed):
            yield points, closed
        case Cross(center=center, size=size):
            for arm in (0.5 * size, 0.5j * size):
                yield np.array([center - arm, center + arm], dtype=np.complex128), False
        case _:
            yield shape.polyline(sagitta), True


def chained(*features: Feature) -> tuple[Feature, ...]:
    """Return features with the polygons of their contours as paths."""
    return tuple(
        replace(one, shape=Path(points=one.shape.points)) if isinstance(one.shape, Contour) else one
        for one in features
    )


def place(features: Iterable[Feature], pose: Pose, prefix: str = "") -> tuple[Feature, ...]:
    """Return features placed (see `placed`), with a prefix before their layers."""
    return tuple(
        replace(feature, layer=prefix + feature.layer, shape=placed(feature.shape, pose))
        for feature in features
    )


def part_features(part: Part, step: int = 0, outline: str = OUTLINE) -> tuple[Feature, ...]:
    """Return the `outline` of a `step`, openings and pockets of a `part`, in its own frame."""
    layer = part.steps[step]
    walls: dict[int, Feature] = {}  # two below each other may share an edge
    for recess in part.recesses:
        walls[id(recess.edge)] = Feature(layer=OUTER_WALL, shape=recess.edge)
    for recess in part.recesses:
        for one in recess.openings:
            walls[id(one.shape)] = Feature(layer=INNER, shape=one.shape, metal=True)
    return (
        Feature(layer=outline, shape=layer.edge),
        *walls.values(),
        *(Feature(layer=opening.kind, shape=opening.shape) for opening in layer.openings),
        *(Feature(layer=MARK, shape=one.edge) for one in part.engraved),
    )


def cut_drawing(drawing: Drawing, kerf: float) -> Drawing:
    """Return a drawing with cutting paths instead of edges.

    Parameters
    ----------
    drawing : Drawing
        Drawing of one part.
    kerf : float, mm
        Width of the cut; 0 leaves the drawing as it is.

    Returns
    -------
    Drawing
        Outlines moved outwards and openings inwards by half the kerf, true parallels, on layers
        that end in ``_KERF``, and what is engraved; nothing else, as a machine may cut all lines.

    Raises
    ------
    InfeasibleError
        If an opening, or its keyway, is not wider than the kerf, or if no path around an outline is
        possible. A path that cannot follow an outline into every corner is allowed.
    """
    if not kerf:
        return drawing
    where = f"{drawing.name}, output.kerf_mm"
    tolerance = drawing.contours[0].tolerance
    return replace(
        drawing,
        features=tuple(
            one
            if one.kind in ENGRAVED
            else Feature(layer=one.layer + KERF, shape=_path(one, kerf, tolerance, where))
            for one in drawing.features
            if one.kind in (*OUTER, *THROUGH, *ENGRAVED)
        ),
    )


def _path(feature: Feature, kerf: float, tolerance: float, where: str) -> Shape:
    """Return the path of the cutter's centre for the edge of a `feature`."""
    from gearcam.parts.parallel import followed, moved, sized

    match feature.shape:
        case Circle(diameter=diameter) as circle if feature.kind in OUTER:
            return replace(circle, diameter=diameter + kerf)
        case Circle(diameter=diameter) as circle if diameter > kerf:
            return replace(circle, diameter=diameter - kerf)
        case Circle(center=center, diameter=diameter):
            x, y = center.real, center.imag
            what = (
                f"the {feature.kind.lower()} at x = {formatted(x)}, y = {formatted(y)} mm is not "
                "wider than the kerf"
            )
            note = f"a kerf below {formatted(diameter)} mm, or a larger {feature.kind.lower()}"
            raise beyond_limit(what, where, kerf, diameter, note)
        case Loop() as loop:
            inner = loop.contour(tolerance)
            there = f"{feature.kind.lower()} of {where}"
            return sized(lambda size: followed(inner, -0.5 * size), kerf, there, "kerf")
        case Contour() as edge:
            side = -0.5 if feature.kind in THROUGH else 0.5
            return sized(lambda size: moved(edge, side * size), kerf, where, "kerf")
        case shape:
            raise ValueError(f"{feature.layer}: a {type(shape).__name__} is not cut")


def wheel_drawing(part: Part, step: int = 0) -> Drawing:
    """Return a `part`, or a `step` of it, in its own frame: outline, openings, marks."""
    name = part.name if len(part.contours) == 1 else f"{part.name}_step{step + 1}"
    return Drawing(name=name, features=part_features(part, step))
