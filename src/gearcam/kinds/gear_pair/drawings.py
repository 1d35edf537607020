"""Drawings of a gear pair: its centrodes, the assembled pair, and workshop drawings.

The sheet of the pair shows both wheels, their centrodes and the pitch point at the driver angle of
the drawing from which it is made. The *pitch point* is where the driver's centrode crosses the line
of centres.

Depends on drawings and sheets.
"""

from __future__ import annotations

from collections.abc import Mapping, Sequence
from typing import Final

import numpy as np

from gearcam.gears.pair import Gear
from gearcam.numeric.arrays import Plane, bounds
from gearcam.numeric.contour import Contour
from gearcam.numeric.pose import Pose
from gearcam.parts.body import Part
from gearcam.parts.shapes import extremes, true_points
from gearcam.pictures.drawings import (
    CENTER,
    CENTRODE,
    CROSS_SIZE,
    OUTLINE,
    Circle,
    Cross,
    Drawing,
    Feature,
    Path,
    part_features,
    place,
    reach,
)
from gearcam.sheets.board import FIRST_LEVEL, LEVEL, OVERHANG, Board
from gearcam.sheets.paper import begin, finish
from gearcam.sheets.sheet import CENTERLINE, Sheet, fine

LEFT: Final = 24.0
RIGHT: Final = 20.0
ABOVE: Final = 14.0
"""Space for dimensions beside and above the wheels, mm of paper."""

POINT: Final = 2.0
"""Diameter of the ring around the pitch point, mm of paper."""

LEVELS: Final = 3
"""Linear dimensions below the wheels."""

_RACK_ROWS: Final = (
    "pair.rack.pressure_angle_deg", "pair.rack.addendum", "pair.rack.dedendum",
    "pair.backlash_mm", "pair.face_width_mm", "steps.count",
)  # fmt: skip
PAIR_ROWS: Final = (
    "pair.module_mm", "pair.teeth", "pair.ratio", "pair.travel_per_turn_mm", *_RACK_ROWS,
)  # fmt: skip
_GEAR_ROWS: Final = (
    "profile_shift", "centrode.length_mm", "cutter", "clearance_mm", "tip_rounding_mm",
    "density_kg_m3", "mass.mass_kg", "mass.centroid_mm", "mass.unbalance_g_mm",
)  # fmt: skip
"""Facts in the tables of drawings."""


_POINTS: Final = 720
"""Intervals of a centrode that is drawn."""


def wheel_rows(number: int) -> tuple[str, ...]:
    """Return the names of the facts in the table of a wheel's drawing, by its `number`."""
    rows = [f"gears.{number}.{name}" for name in _GEAR_ROWS]
    return (f"gears.{number}.teeth", "pair.module_mm", *_RACK_ROWS, *rows)


def centrode_path(gear: Gear, end: float) -> Path:
    """Return the centrode of a `gear` as a chain in its own frame, to the driver angle `end`."""
    closed = gear.toothing.closed
    phi1 = np.linspace(0.0, end, _POINTS + 1)[: -1 if closed else None]
    return Path(points=gear.toothing.frames(phi1).p, closed=closed)


def pair_drawing(
    parts: Sequence[Part],
    center_distance: float,
    centrodes: Sequence[Path] = (),
    *,
    poses: tuple[Pose, Pose] | None = None,
) -> Drawing:
    """Return the drawing of the assembled pair.

    By default phi1 = 0: wheel 1 in its own frame, wheel 2 shifted by the centre distance.

    Parameters
    ----------
    parts : two Part
        Driver first.
    center_distance : float, mm
        Position of the second shaft on x, negative for a ring; 0 for a rack, which has none.
    centrodes : sequence of Path
        In the wheels' own frames, driver first; may be empty.
    poses : two Pose, optional
        Where the wheels are.

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
    poses = poses or (Pose(), Pose(shift=center_distance))
    features: list[Feature] = []
    numbered = enumerate(zip(parts, poses, strict=True), start=1)
    # drawn later means on top: a wheel in its ring
    for number, (part, pose) in sorted(numbered, key=lambda one: not one[1][0].inner):
        features += place(part_features(part), pose, prefix=f"GEAR{number}_")
    for path, pose in zip(centrodes, poses, strict=False):
        features += place([Feature(layer=CENTRODE, shape=path)], pose)
    size = CROSS_SIZE * (abs(center_distance) or float(np.ptp(parts[0].contour.vertices)))
    for shaft in (0.0, center_distance) if center_distance else (0.0,):
        cross = Cross(center=shaft, size=size)
        features.append(Feature(layer=CENTER, shape=cross))
    return Drawing(name="pair", features=tuple(features))


def pair_sheet(
    drawing: Drawing,
    center_distance: float,
    facts: Mapping[str, str],
    title: str,
    *,
    pitch_radius: float,
) -> Sheet:
    """Return the sheet of the assembled pair.

    Parameters
    ----------
    drawing : Drawing
        The pair with its centrodes (see `pair_drawing`).
    center_distance : float, mm
        Position of the second shaft on x, with the first at 0: negative for a ring; 0 for a rack.
    facts : mapping of str to str
        Rows of the parameter table.
    title : str
        First line of the title block.
    pitch_radius : float, mm
        Distance of the pitch point from the driver's axis.

    Returns
    -------
    Sheet
        With the name of the drawing.

    Raises
    ------
    ValueError
        If the drawing has no outline, or is too large for the smallest scale.
    """
    if not drawing.contours:
        raise ValueError(f"{drawing.name}: nothing to draw")
    outlines = _outlines(drawing)
    points = true_points(outlines)
    shafts = (0.0, center_distance) if center_distance else (0.0,)
    # the shaft of an open ring lies beside its outline
    low, high = bounds(np.append(points, shafts))
    below = FIRST_LEVEL + LEVEL * LEVELS
    room = complex(LEFT, below), complex(RIGHT, ABOVE)
    board = begin(high - low, room, low, len(facts) + 2)
    _views(board, drawing, shafts)
    _sizes(board, points, center_distance, pitch_radius, low.real)
    board.draw(CENTERLINE, Circle(center=pitch_radius, diameter=POINT * board.unit))
    board.label(pitch_radius, "pitch point")
    for number, shaft in enumerate(shafts, start=1):
        board.label(shaft, f"gear{number}")
    tolerance = max(contour.tolerance for contour in drawing.contours)
    notes = [
        f"Chord tolerance of the outlines: {fine(tolerance)} mm.",
        "Dashed: centrodes; they touch at the pitch point.",
        "Make each wheel from its own drawing and file.",
    ]
    return finish(board, name=drawing.name, title=title, facts=facts, notes=notes)


def _outlines(drawing: Drawing) -> list[Contour | Circle]:
    """Return the outlines of both wheels, the driver's first."""
    ones = sorted((f for f in drawing.features if f.kind == OUTLINE), key=lambda one: one.layer)
    return [one.shape for one in ones if isinstance(one.shape, Contour | Circle)]


def _views(board: Board, drawing: Drawing, shafts: tuple[float, ...]) -> None:
    for feature in drawing.features:
        if feature.kind != CENTER:
            board.draw(feature.layer, feature.shape)
    over, reached = OVERHANG * board.unit, [reach(one) for one in _outlines(drawing)]
    for shaft, points in zip(shafts, reached, strict=False):
        low, high = bounds(points)
        start, end = complex(shaft, low.imag - over), complex(shaft, high.imag + over)
        board.line(CENTERLINE, start, end)
    low, high = bounds(np.append(np.concatenate(reached), shafts))
    board.line(CENTERLINE, low.real - over, high.real + over)


def _sizes(
    board: Board, points: Plane, center_distance: float, pitch_radius: float, beside: float
) -> None:
    """Draw the linear dimensions: pitch radius, centre distance, overall sizes left of `beside`."""
    unit = board.unit
    left, low, right, high = extremes(points)
    levels = [low.imag - (FIRST_LEVEL + LEVEL * level) * unit for level in range(LEVELS)]
    board.linear(0.0, pitch_radius, levels.pop(0))
    if center_distance:
        board.linear(0.0, center_distance, levels.pop(0))
    board.linear(left, right, levels.pop(0))
    board.linear(low, high, beside - FIRST_LEVEL * unit, vertical=True)
