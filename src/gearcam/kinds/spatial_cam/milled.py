"""Files of the path of a tool on a machine with a rotary axis."""

from __future__ import annotations

import math
from collections.abc import Callable, Iterator, Mapping
from typing import TYPE_CHECKING, Any, Final

import numpy as np

from gearcam.base.numerals import formatted
from gearcam.base.quantities import RPM
from gearcam.numeric.arrays import Array
from gearcam.spatial.milling import DECIMALS, PLUNGE

if TYPE_CHECKING:
    from gearcam.kinds.spatial_cam.result import SpatialCamResult

_MINUTE: Final = 60.0


def _moves(result: SpatialCamResult) -> Array:
    """Return the moves in mm and deg."""
    return result.rotary.moves * [1.0, 1.0, 1.0, math.degrees(1.0)]


def _per_minute(result: SpatialCamResult) -> Array:
    """Return the inverse times of the moves, 1/min; 0 of rapid moves."""
    times = result.rotary.times(result.design.tool)
    return np.divide(_MINUTE, times, out=np.zeros_like(times), where=times > 0.0)


def _tool_path(result: SpatialCamResult, _: Any) -> dict[str, bytes]:
    """Return the path of an end mill on a rotary axis, as a table.

    Files: rotary_path.csv.

    Moves of a milling machine whose tool is vertical, with the cam along X: turn is the number of
    the turn round the cam, 0 between turns; X_mm is along the cam's axis from its lower face, Y_mm
    across, Z_mm the height of the tool's end above the axis, A_deg the azimuth of the tool on the
    cam, by the right hand about X, inverse_time_per_min one over the duration, 0 of rapid moves.
    """
    from gearcam.export.table import table_bytes

    path, moves = result.rotary, _moves(result).T
    columns = {"turn": path.turn, "X_mm": moves[0], "Y_mm": moves[1], "Z_mm": moves[2]}
    columns["A_deg"] = moves[3]
    columns["inverse_time_per_min"] = _per_minute(result)
    return {"rotary_path.csv": table_bytes(columns)}


def _gcode(result: SpatialCamResult, _: Any) -> dict[str, bytes]:
    """Return the path of an end mill on a rotary axis, as a program.

    Files: cam.nc.

    The moves of rotary_path.csv as G-code, in mm and inverse time (G93), for controllers such as
    LinuxCNC and grbl with a fourth axis; its head says tool, blank, zero point and start. Y only if
    it is needed.
    """
    from gearcam.export.gcode import RotaryProgram, gcode_bytes

    path, tool = result.rotary, result.design.tool
    program = RotaryProgram(
        moves=_moves(result),
        per_minute=_per_minute(result),
        decimals=DECIMALS,
        spindle=None if tool.spindle is None else tool.spindle / RPM.factor,
        crosswise=path.crosswise,
        wrapped=tool.rotary == "wrapped",
        notes=[*_work(result), *_zero(result), *_sense(result), *_cutting(result), *_start(result)],
    )
    return {"cam.nc": gcode_bytes(program)}


def _work(result: SpatialCamResult) -> Iterator[str]:
    """Yield what is made from what, with which tool."""
    path, cam, size = result.rotary, result.cam, result.solved.cam
    bore, half_angle = 0.5 * result.design.blank.bore, cam.tool.half_angle
    end, outside = (formatted(2.0 * one) for one in path.tool)
    roller = formatted(2.0 * cam.roller.radius_at(cam.outer_radius))
    cone = f" at the outside of the cam, half angle {formatted(math.degrees(half_angle))} deg"
    yield f"Cylinder cam {result.design.name}, by gearcam."
    if half_angle:
        yield f"Tool: conical end mill, cutting over its end, {end} mm there, {outside} mm{cone}."
    else:
        yield f"Tool: end mill, cutting over its end, diameter {end} mm."
    yield f"Roller: diameter {roller} mm{cone if half_angle else ''}."
    hollow = f", bore {formatted(2.0 * bore)} mm" if bore else ""
    outer, length = formatted(size.outer_diameter), formatted(size.length)
    yield f"Blank: cylinder of {outer} mm, length {length} mm{hollow}."
    if size.walls != "both":
        floor = formatted(2.0 * cam.floor)
        yield "Only the way of the roller is cut."
        yield f"What is beyond it may be turned down to {floor} mm."


def _zero(result: SpatialCamResult) -> Iterator[str]:
    """Yield where the zero of the program is, and how it is found."""
    path, cam, length = result.rotary, result.cam, result.solved.cam.length
    yield f"Axes: {'X, Y, Z and A' if path.crosswise else 'X, Z and A. Lock Y at Y0'}."
    yield "The cam lies along X, its upper face towards X+. The tool is along Z."
    yield "X0 is the lower face of the cam, Y0 and Z0 are its axis."
    yield "A0 may be anywhere on the blank: there the roller is at cam angle 0."
    yield "Touch off with this tool, in G54, without tool length offset."
    yield f"Its end on top of the blank is at Z{formatted(cam.outer_radius)}."
    # a cone has no side of one radius
    side = 0.0 if cam.tool.half_angle else path.tool[0]
    part = "side" if side else "axis"
    lower, upper = formatted(-side + 0.0), formatted(length + side)
    yield f"Its {part} at the lower face is at X{lower}, at the upper face at X{upper}."
    if side:
        beside = formatted(cam.outer_radius + side)
        yield f"Its side at the side of the blank is at Y{beside} or Y-{beside}."
    else:
        yield "Its axis above that of the blank is at Y0."


def _sense(result: SpatialCamResult) -> Iterator[str]:
    """Yield how A turns, how far, and which wall is climb-milled."""
    path, sides = result.rotary, result.cam.sides
    yield "Seen from X+, A+ turns the cam clockwise."
    yield "Try it, the tool up: from A0 to A10 the top of the cam goes to Y+."
    yield "If it goes to Y-, reverse A in the settings of the machine."
    most = formatted(math.degrees(float(path.moves[-1, 3])), 9)
    if result.design.tool.rotary == "wrapped":
        yield "A stays below 360 and goes on at 0: the axis must be wrapped."
    else:
        yield f"A grows from 0 to {most}: the axis must not be wrapped."
    if len(sides) > 1:
        yield "M3 climb-mills the wall on the X- side of the tool, not that on X+."
    elif 1 in sides:
        yield "The wall is on the X+ side of the tool: M3 does not climb-mill it."
    else:
        yield "The wall is on the X- side of the tool: M3 climb-mills it."


def _cutting(result: SpatialCamResult) -> Iterator[str]:
    """Yield passes, accuracy and speeds."""
    from gearcam.export.gcode import RUN_UP

    path, tool = result.rotary, result.design.tool
    left, cut = (formatted(math.ceil(1e4 * one) / 10.0) for one in (path.left, path.cut))
    yield f"Passes in depth: {path.layers}. Turns of A: {path.turns}."
    yield f"At most {left} um are left on a wall, by a true machine."
    yield f"At most {cut} um are cut into a wall, by a true machine."
    yield (
        f"Feed: {formatted(_MINUTE * tool.feed)} mm/min at the outside of the cam, "
        f"{formatted(_MINUTE * PLUNGE * tool.feed)} mm/min into the metal."
    )
    if tool.spindle is None:
        yield "Spindle: no speed is given. The program stops for you to start it."
    else:
        yield f"Spindle: {formatted(tool.spindle / RPM.factor)} rpm, reached within {RUN_UP} s."


def _start(result: SpatialCamResult) -> Iterator[str]:
    """Yield what must be so before the start."""
    moves = result.rotary.moves
    x, y, z = (formatted(one, 9) for one in moves[0, :3])
    low, high = (formatted(one, 9) for one in (moves[:, 0].min(), moves[:, 0].max()))
    yield "Start: home the machine. Z0 of the machine must be its top."
    yield f"The tool rises there, goes to X{x} Y{y}, then down to Z{z}."
    yield f"Its axis stays from X{low} to X{high}: keep chuck and centre clear."
    yield "If the machine is not homed no start is safe."
    yield f"Then stand the tool above X{x} Y{y} by hand, at Z{z} or higher,"
    yield "and take out both lines with G53."


MILLED: Final[Mapping[str, Callable[..., dict[str, bytes]]]] = {
    "tool-path": _tool_path,
    "gcode": _gcode,
}
"""What makes these files, by format."""
