"""Workshop drawings of a pair: tables of the wheels, and the sheet of both wheels assembled.

The sheet shows the pair, its centrodes and the pitch point at the driver angle of the drawing from
which it is made. The *pitch point* is where the driver's centrode crosses the line of centres.

Depends on drawings and sheets.
"""

from __future__ import annotations

from collections.abc import Mapping
from typing import TYPE_CHECKING, Final

import numpy as np

from gearcam.base.numerals import shown
from gearcam.numeric.arrays import Array
from gearcam.numeric.contour import Contour
from gearcam.pictures.drawings import CENTER, OUTLINE, Circle, Drawing, reach
from gearcam.sheets.board import FIRST_LEVEL, LEVEL, OVERHANG, Board
from gearcam.sheets.extent import true_points
from gearcam.sheets.paper import begin, finish, sheet_rows
from gearcam.sheets.sheet import CENTERLINE, Sheet, fine

if TYPE_CHECKING:
    from gearcam.kinds.gear_pair.result import GearPairResult

LEFT: Final = 24.0
RIGHT: Final = 20.0
ABOVE: Final = 14.0
"""Space for dimensions beside and above the wheels, mm of paper."""

POINT: Final = 2.0
"""Diameter of the ring around the pitch point, mm of paper."""

LEVELS: Final = 3
"""Linear dimensions below the wheels."""

_PAIR_ROWS: Final = ("pair.module_mm", "pair.teeth", "pair.ratio", "pair.travel_per_turn_mm")
_RACK_ROWS: Final = (
    "pair.rack.pressure_angle_deg", "pair.rack.addendum", "pair.rack.dedendum",
    "pair.backlash_mm", "pair.face_width_mm", "steps.count",
)  # fmt: skip
_GEAR_ROWS: Final = (
    "profile_shift", "centrode.length_mm", "cutter", "clearance_mm", "tip_rounding_mm",
    "density_kg_m3", "mass.mass_kg", "mass.centroid_mm", "mass.unbalance_g_mm",
)  # fmt: skip
"""Facts in the tables of drawings."""


def rows_of(number: int) -> tuple[str, ...]:
    """Return the names of the facts in the table of a wheel's drawing, by its `number`."""
    own = [f"gears.{number}.{name}" for name in _GEAR_ROWS]
    return (f"gears.{number}.teeth", "pair.module_mm", *_RACK_ROWS, *own)


def sheet_of(result: GearPairResult) -> Sheet:
    """Return the workshop drawing of the assembled pair of a `result`."""
    pose = result.design.output.pose
    radius = float(abs(result.pair.rolling.tracks[0].frames(np.array([pose])).p[0]))
    rows = {"law": result.design.law_type}
    rows |= sheet_rows(result.facts, (*_PAIR_ROWS, *_RACK_ROWS))
    rows["drawn at phi1"] = f"{shown(np.degrees(pose))} deg"
    title = result.design.name
    return pair_sheet(result.drawing, result.pair.shift, rows, title, pitch_radius=radius)


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
        The pair with its centrodes (see `gearcam.kinds.gear_pair.drawn.pair_drawing`).
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
    reached = np.vstack([points, *([shaft, 0.0] for shaft in shafts)])
    low, high = reached.min(axis=0), reached.max(axis=0)
    below = FIRST_LEVEL + LEVEL * LEVELS
    room = np.array([LEFT, below]), np.array([RIGHT, ABOVE])
    board = begin(high - low, room, low, len(facts) + 2)
    _views(board, drawing, shafts)
    _sizes(board, points, center_distance, pitch_radius, float(low[0]))
    place = np.array([pitch_radius, 0.0])
    board.draw(CENTERLINE, Circle(center=place, diameter=POINT * board.unit))
    board.label(place, "pitch point")
    for number, shaft in enumerate(shafts, start=1):
        board.label(np.array([shaft, 0.0]), f"gear{number}")
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
    over, boxes = OVERHANG * board.unit, [reach(one) for one in _outlines(drawing)]
    for shaft, corners in zip(shafts, boxes, strict=False):
        low, high = float(corners[:, 1].min()), float(corners[:, 1].max())
        board.line(CENTERLINE, (shaft, low - over), (shaft, high + over))
    xs = np.append(np.concatenate(boxes)[:, 0], shafts)
    board.line(CENTERLINE, (float(xs.min()) - over, 0.0), (float(xs.max()) + over, 0.0))


def _sizes(
    board: Board, points: Array, center_distance: float, pitch_radius: float, beside: float
) -> None:
    """Draw the linear dimensions: pitch radius, centre distance, overall sizes left of `beside`."""
    unit = board.unit
    left, low, right, high = points[[*points.argmin(axis=0), *points.argmax(axis=0)]]
    levels = [float(low[1]) - (FIRST_LEVEL + LEVEL * level) * unit for level in range(LEVELS)]
    board.linear((0.0, 0.0), (pitch_radius, 0.0), levels.pop(0))
    if center_distance:
        board.linear((0.0, 0.0), (center_distance, 0.0), levels.pop(0))
    board.linear(left, right, levels.pop(0))
    board.linear(low, high, beside - FIRST_LEVEL * unit, vertical=True)
