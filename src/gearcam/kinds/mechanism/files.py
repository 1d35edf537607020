"""From the result of a mechanism to the contents of its files: one function a format."""

from __future__ import annotations

import math
from collections.abc import Callable, Mapping
from typing import TYPE_CHECKING, Any, Final

from gearcam.base.numerals import formatted
from gearcam.report.file import report_files

if TYPE_CHECKING:
    from gearcam.kinds.mechanism.build import MechanismResult

Files = dict[str, bytes]


def _tables(result: MechanismResult, _: Any) -> Files:
    """Return the motion as a table.

    Files: motion.csv, comparison.csv, intervals.csv.

    The master's angle in degrees, and for each output its value and its derivatives by that angle,
    in rad; with a speed also those by time. Where drives are compared, strokes, largest velocities,
    accelerations and jerks behind each. The intervals that are asked for, behind each drive.
    """
    from gearcam.export.table import table_bytes

    files = {"motion.csv": table_bytes(result.motion())}
    if result.design.compare:
        from gearcam.kinds.mechanism.comparison import comparison

        files["comparison.csv"] = table_bytes(comparison(result))
    if result.design.interval:
        files["intervals.csv"] = table_bytes(result.interval_table())
    return files


def _dxf(result: MechanismResult, _: Any) -> Files:
    """Return the paths of points as DXF.

    Files: paths.dxf.

    The paths of the points, and of the joints that are asked for, 1:1 in mm and within the chord
    tolerance, each on a layer of its own, NAME_PATH; with the machine at its pose: members, drawn
    symbolically, on MEMBER and MEMBER_BORE, guides and pivots on GROUND, the wheels or the cam on
    theirs. All is grey, for reference: widths and bores of members are not for cutting, and the
    wheels are those of the pair without their kerf.
    """
    from gearcam.export.dxf import DxfStyle, dxf_bytes
    from gearcam.kinds.mechanism.drawn import CHORDS, paths_drawing

    tolerance = result.design.output.chord_tolerance or CHORDS
    style = DxfStyle(tolerance=tolerance, curves="lines", version="R2010")
    return {"paths.dxf": dxf_bytes(paths_drawing(result), style)}


def _svg(result: MechanismResult, _: Any) -> Files:
    """Return a picture of the machine.

    Files: poses.svg.

    The machine at its pose with the names of joints and members, the paths of its points, dashed,
    and its members at other angles of the master, which are written beside them; not for cutting.
    """
    from gearcam.export.svg import svg_bytes
    from gearcam.kinds.mechanism.drawn import legend, picture
    from gearcam.kinds.mechanism.scene import shown_at

    drawing, labels = picture(result)
    place = f"{result.driver[0]} = {formatted(math.degrees(shown_at(result)))} deg"
    notes = (*result.facts.headline, f"drawn at {place}")
    data = svg_bytes(
        drawing, title=result.design.name, notes=notes, labels=labels, legend=legend(result)
    )
    return {"poses.svg": data}


FILES: Final[Mapping[str, Callable[..., Files]]] = {
    "csv": _tables,
    "dxf": _dxf,
    "svg": _svg,
    "report": report_files,
}
"""What makes the files of each format: contents by name."""
