"""Workshop drawings of cams in space: face, section, the outside unrolled, a table of the motion.

The outside is seen from outside, with the azimuth in the cam's frame from left to right.
"""

from __future__ import annotations

from collections.abc import Callable, Sequence
from dataclasses import replace
from typing import Final

import numpy as np

from gearcam.base.numerals import decimal
from gearcam.designs.outputs import MESHES
from gearcam.kinds.gridded import STEM, GriddedCam
from gearcam.numeric.arrays import Array
from gearcam.numeric.pose import Pose
from gearcam.parts.body import Opening, Part
from gearcam.parts.openings import fits_of
from gearcam.parts.shapes import Circle
from gearcam.pictures.drawings import Drawing, box, place
from gearcam.sheets.paper import Heading, Values, sheet_rows
from gearcam.sheets.part import part_sheet
from gearcam.sheets.sections import mesh_loops
from gearcam.sheets.sheet import Sheet, column
from gearcam.sheets.wheel import GrooveSizes, Sense, Unrolled, check_runout, upright

_STEPS: Final = 360
_PLACES: Final = 5
"""Largest numbers of cam angles, and of places along the roller, of the solid that is cut."""

_TABLE: Final = 15.0
"""Step of the cam angle in the table of the motion, deg."""

_FINE: Final = 1e-3
"""Chord tolerance of the outline of the face, mm."""


def cam_sheet(
    result: GriddedCam,
    radius: float,
    drawing: Drawing,
    rows: Sequence[str],
    tabled: tuple[str, str, Callable[[Array], Array]],
    texts: tuple[str, str],
    groove: GrooveSizes,
) -> Sheet:
    """Return the sheet of a cam in space.

    Parameters
    ----------
    result : GriddedCam
        The cam.
    radius : float, mm
        Largest radius.
    drawing : Drawing
        Its outside unrolled.
    rows : sequence of str
        Names of the facts in the table of data.
    tabled : (str, str, callable)
        What is tabled, its unit, and its values at cam angles, rad.
    texts : (str, str)
        What is written above the unrolled outside, and what a note says of it.
    groove : GrooveSizes
        The sizes of its groove.

    Returns
    -------
    Sheet

    Raises
    ------
    InfeasibleError
        If it does not fit on a sheet, or run-out is given without a bore.
    """
    design, (_, base, length) = result.design, result.core_size
    outline = Circle(center=0j, diameter=2.0 * radius).contour(_FINE)
    if result.core is not None:
        part = replace(result.core, contours=(outline,))
    else:
        bore = 2.0 * result.turned_bore
        shape = Circle(center=0j, diameter=bore) if bore else None
        fits = fits_of(diameter=design.blank.bore_diameter)
        openings = (Opening(kind="BORE", shape=shape, name="bore", fits=fits),) if shape else ()
        part = Part(name=STEM, contours=(outline,), width=length, openings=openings)
    check_runout(design.drawing, [part])
    steps, places = min(result.solid_steps, _STEPS), min(design.output.wall_points, _PLACES)
    body = result.body if result.carved else result.body_of(steps, places)
    core = result.core and upright(result.core)
    loops = [loop - base for loop in mesh_loops(result.fitted(body, core))]
    low, _ = box(drawing.features)
    unrolled = replace(drawing, features=place(drawing.features, Pose(0.0, -low)))
    theta = np.arange(0.0, 360.0, _TABLE)
    name, own, values = tabled
    unit, text = column(own)
    pairs = zip(theta.tolist(), values(np.radians(theta)).tolist(), strict=True)
    table = [(decimal(angle), text(value)) for angle, value in pairs]
    # the roller runs round a cam against its rotation
    theta_there = "0 to 360" if result.cam.clockwise else "360 to 0"
    title = f"{texts[0]}, azimuth 0 to 360 deg, theta {theta_there} deg"
    files = ["walls.csv"] if "csv" in design.output.files else []
    files += [f"{STEM}.{word}" for word in ("step", *MESHES) if word in design.output.files]
    note = f"{texts[1]} Walls: {', '.join(files) or 'walls.csv (not written with this drawing)'}."
    return part_sheet(
        part,
        sheet_rows(result.facts, rows),
        Heading(title=design.name, notes=design.drawing),
        turning=Sense(zero=0.0, clockwise=result.cam.clockwise),
        values=Values(title=("theta, deg", f"{name}, {unit}"), rows=table),
        unrolled=Unrolled(loops=loops, drawing=unrolled, title=title, note=note, groove=groove),
    )
