"""Files of the path of a tool on a machine with a rotary axis."""

from __future__ import annotations

import math
from collections.abc import Callable, Iterator, Mapping
from typing import TYPE_CHECKING, Any, Final

import numpy as np

from gearcam.base.numerals import formatted
from gearcam.base.quantities import RPM
from gearcam.numeric.arrays import Array
from gearcam.spatial.milling import PLUNGE

if TYPE_CHECKING:
    from gearcam.kinds.spatial_cam.build import SpatialCamResult

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
    LinuxCNC and grbl with a fourth axis; its head says tool, blank and zero point. Y only if it is
    needed.
    """
    from gearcam.export.gcode import gcode_bytes

    path, tool = result.rotary, result.design.tool
    spindle = tool.spindle / RPM.factor
    notes, crosswise = [*_notes(result)], path.crosswise
    return {
        "cam.nc": gcode_bytes(
            _moves(result), _per_minute(result), spindle, notes, crosswise=crosswise
        )
    }


def _notes(result: SpatialCamResult) -> Iterator[str]:
    """Yield what a machinist must know before he starts."""
    design, path, cam = result.design, result.rotary, result.cam
    size, tool, bore = design.cam, design.tool, design.blank.bore
    end, outside = (formatted(2.0 * one, 6) for one in path.tool)
    cone = math.degrees(cam.tool.half_angle)
    angle = f"{outside} mm at the outside of the cam, half angle {formatted(cone, 6)} deg"
    shape = f"{end} mm at its end, {angle}" if cone else f"{end} mm"
    yield f"gearcam: {design.name}"
    yield f"tool: end mill, {shape}, cutting over its end"
    hollow = f", bore {formatted(2.0 * bore)} mm" if bore else ""
    yield (
        f"blank: cylinder {formatted(size.outer_diameter)} mm, length {formatted(size.length)} mm"
        f"{hollow}"
    )
    if size.walls != "both":
        yield f"only the walls are cut: turn the rest down to {formatted(2.0 * cam.floor)} mm"
    yield "zero: X at the lower face of the cam, Y and Z on its axis, A anywhere"
    yield "X+ towards the upper face, Z+ away from the axis, tool along Z"
    yield (
        "A+ by the right hand about X is the way of the tool round the cam; the cam turns the other"
        " way"
    )
    yield f"axes: {'X Y Z A' if path.crosswise else 'X Z A, Y locked at 0'}"
    yield (
        f"passes in depth: {path.layers}, turns: {path.turns}, left on walls at most "
        f"{formatted(1e3 * path.rest, 3)} um"
    )
    yield (
        f"feed {formatted(_MINUTE * tool.feed)} mm/min at the outside of the cam, "
        f"{formatted(_MINUTE * PLUNGE * tool.feed)} mm/min into the metal"
    )


MILLED: Final[Mapping[str, Callable[..., dict[str, bytes]]]] = {
    "tool-path": _tool_path,
    "gcode": _gcode,
}
"""What makes these files, by format."""
