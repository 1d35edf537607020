"""Workshop drawings of a pair: tables of the wheels, and the sheet of both wheels assembled.

The sheet shows the pair, its centrodes and the pitch point at the driver angle of the drawing from
which it is made. The *pitch point* is where the driver's centrode crosses the line of centres.

Depends on drawings and sheets.
"""

from __future__ import annotations

from collections.abc import Iterable, Mapping, Sequence
from typing import Final

import numpy as np

from gearcam.base.inches import file_unit
from gearcam.gears.pair import Gear
from gearcam.kinds.gear_pair.drawings import centrode_path
from gearcam.numeric.arrays import bounds
from gearcam.numeric.contour import Contour
from gearcam.parts.shapes import extremes, true_points
from gearcam.pictures.drawings import CENTER, OUTLINE, Circle, Drawing, reach
from gearcam.sheets.board import FIRST_LEVEL, LEVEL, OVERHANG, Board
from gearcam.sheets.dimensions import Measure
from gearcam.sheets.paper import NO_VALUES, Heading, begin, finish
from gearcam.sheets.part import ABOVE, LEFT
from gearcam.sheets.sheet import CENTERLINE, Sheet, fine
from gearcam.sheets.wheel import Teeth

RIGHT: Final = 20.0
"""Space for dimensions on the right of the wheels, mm of paper."""

POINT: Final = 2.0
"""Diameter of the ring around the pitch point, mm of paper."""

LEVELS: Final = 3
"""Linear dimensions below the wheels."""

_RACK_ROWS: Final = (
    "pair.rack.pressure_angle_deg", "pair.rack.addendum", "pair.rack.dedendum",
    "pair.backlash_mm", "mesh.backlash_mm", "pair.face_width_mm", "steps.count",
)  # fmt: skip
PAIR_ROWS: Final = (
    "pair.module_mm", "pair.teeth", "pair.ratio", "pair.travel_per_turn_mm", *_RACK_ROWS,
)  # fmt: skip
_GEAR_ROWS: Final = (
    "profile_shift", "centrode.length_mm", "cutter", "clearance_mm", "tip_rounding_mm",
    "density_kg_m3", "mass.mass_kg", "mass.centroid_mm", "mass.unbalance_g_mm",
    "measuring.pin_diameter_mm", "measuring.over_pins_mm", "measuring.chord_mm",
    "measuring.chord_depth_mm", "measuring.constant_chord_mm", "measuring.constant_chord_depth_mm",
)  # fmt: skip
"""Facts in the tables of drawings."""


MOST_SPANS: Final = 16
"""Largest number of spans that the table of a wheel has."""


def wheel_rows(number: int, facts: Iterable[str]) -> tuple[str, ...]:
    """Return the names of those of all `facts` in the table of a wheel, by its `number`."""
    rows = [f"gears.{number}.{name}" for name in _GEAR_ROWS]
    spans = spans_of(number, facts)
    shown = spans if len(spans) <= MOST_SPANS else []
    return (f"gears.{number}.teeth", "pair.module_mm", *_RACK_ROWS, *rows, *shown)


def spans_of(number: int, facts: Iterable[str]) -> list[str]:
    """Return the names of those of all `facts` that are spans of a wheel, by its `number`."""
    return [name for name in facts if name.startswith(f"gears.{number}.") and "span_mm" in name]


def teeth_of(gear: Gear, end: float) -> Teeth:
    """Return the teeth of a `gear` whose centrode ends at the driver angle `end`, rad."""
    height = float(gear.profile.tip_height.max())
    middle, way = _first(gear)
    return Teeth(
        pitch=centrode_path(gear, end),
        root=centrode_path(gear, end, -gear.toothing.cutter.dedendum),
        tip=centrode_path(gear, end, height),
        first=middle + height * gear.toothing.turn * way,
    )


def counted(gear: Gear) -> str:
    """Return in words how the teeth of a `gear` are counted, seen from the front."""
    middle, way = _first(gear)
    sense = "upwards" if way.imag > 0.0 else "downwards"
    if not gear.toothing.track.slides:
        sense = "counter-clockwise" if (middle.conjugate() * way).imag > 0.0 else "clockwise"
    return f"Teeth are counted {sense} from tooth 1; space 1 follows it."


def _first(gear: Gear) -> tuple[complex, complex]:
    """Return the middle of tooth 1 on the centrode, mm, and the tangent there, as s rises."""
    toothing = gear.toothing
    place = toothing.tooth_places[toothing.numbers.index(1)]
    frames = toothing.frames(toothing.track.angle(np.array([place])))
    return complex(frames.p[0]), complex(frames.t[0])


def pair_sheet(
    drawing: Drawing,
    center_distance: float,
    facts: Mapping[str, str],
    heading: Heading,
    names: Sequence[str] = ("gear1", "gear2"),
    *,
    pitch_radius: float,
) -> Sheet:
    """Return the sheet of the assembled pair.

    Parameters
    ----------
    drawing : Drawing
        The pair with its centrodes (see `gearcam.kinds.gear_pair.drawings.pair_drawing`).
    center_distance : float, mm
        Position of the second shaft on x, with the first at 0: negative for a ring; 0 for a rack.
    facts : mapping of str to str
        Rows of the parameter table.
    heading : Heading
        What the title block says.
    names : two str
        What the wheels are called, driver first.
    pitch_radius : float, mm
        Distance of the pitch point from the driver's axis.

    Returns
    -------
    Sheet
        With the name of the drawing.

    Raises
    ------
    InfeasibleError
        If it is too large for the smallest scale.
    """
    ones = sorted((f for f in drawing.features if f.kind == OUTLINE), key=lambda one: one.layer)
    # the driver's first
    outlines = [one.shape for one in ones if isinstance(one.shape, Contour | Circle)]
    points = true_points(outlines)
    shafts = (0.0, center_distance) if center_distance else (0.0,)
    # the shaft of an open ring lies beside its outline
    low, high = bounds(np.append(points, shafts))
    below = FIRST_LEVEL + LEVEL * LEVELS
    room = complex(LEFT, below), complex(RIGHT, ABOVE)
    board = begin(drawing.name, high - low, room, low, len(facts) + 2, 0.0)
    _views(board, drawing, outlines, shafts)
    left, lowest, right, highest = extremes(points)
    across = [Measure(0.0, pitch_radius, aside=True), Measure(left, right, aside=True)]
    across.append(Measure(0.0, center_distance or right))  # of a rack, to its back
    board.measure(across, lowest.imag)
    board.measure([Measure(lowest, highest, aside=True)], low.real, vertical=True)
    board.draw(CENTERLINE, Circle(center=pitch_radius, diameter=POINT * board.unit))
    board.label(pitch_radius, "pitch point")
    for place, name in zip((0.0, center_distance or 0.5 * (right + highest)), names, strict=True):
        board.label(place, name)
    tolerance = max(contour.tolerance for contour in drawing.contours)
    notes = [
        f"Chord tolerance of the outlines: {fine(tolerance)} {file_unit().name}.",
        "Chain lines: centrodes; they touch at the pitch point.",
        "Make each wheel from its own drawing and file.",
    ]
    if tolerances := heading.notes.general_tolerances:
        where = "centre distance" if center_distance else "distance from axis to back of the rack"
        notes.append(f"{tolerances} holds for the {where} too.")
    return finish(board, heading, facts, notes, NO_VALUES)


def _views(
    board: Board, drawing: Drawing, outlines: list[Contour | Circle], shafts: tuple[float, ...]
) -> None:
    for feature in drawing.features:
        if feature.kind != CENTER:
            board.draw(feature.layer, feature.shape)
    over, reached = OVERHANG * board.unit, [reach(one) for one in outlines]
    for shaft, points in zip(shafts, reached, strict=False):
        low, high = bounds(points)
        start, end = complex(shaft, low.imag - over), complex(shaft, high.imag + over)
        board.line(CENTERLINE, start, end)
    low, high = bounds(np.append(np.concatenate(reached), shafts))
    board.line(CENTERLINE, low.real - over, high.real + over)
