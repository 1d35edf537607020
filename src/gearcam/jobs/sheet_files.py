"""Workshop drawings of a job: which facts stand in their tables, and their files."""

from __future__ import annotations

import math
from typing import TYPE_CHECKING

import numpy as np

from gearcam.gears.pair import Gear

if TYPE_CHECKING:
    from gearcam.drawings import Drawing
    from gearcam.export.dxf import DxfStyle
    from gearcam.jobs.gear_pair import GearPairJob
    from gearcam.parts.blank import WheelBlank
    from gearcam.parts.part import Part


def sheet_files(job: GearPairJob, pair: Drawing, style: DxfStyle, ending: str) -> dict[str, bytes]:
    """Return the workshop drawings of both wheels and of the pair.

    Parameters
    ----------
    job : GearPairJob
        With its parts.
    pair : Drawing
        The assembled pair.
    style : DxfStyle
        How DXF is written.
    ending : {"svg", "dxf"}
        The kind of file.

    Returns
    -------
    dict of str to bytes
        Contents by file name.
    """
    from gearcam.export.sheet_dxf import sheet_dxf
    from gearcam.export.sheet_svg import sheet_svg
    from gearcam.sheets import pair_sheet, wheel_sheet

    phi1 = np.array([job.design.output.pose])
    radius = float(abs(job.pair.rolling.tracks[0].frames(phi1).p[0]))
    title = job.design.name
    sheets = [
        wheel_sheet(part, wheel_facts(job, gear), title)
        for part, gear in zip(job.parts, job.gears, strict=True)
    ]
    sheets.append(pair_sheet(pair, job.pair.shift, pair_facts(job), title, pitch_radius=radius))
    return {
        f"{sheet.name}_drawing.{ending}": sheet_svg(sheet)
        if ending == "svg"
        else sheet_dxf(sheet, style)
        for sheet in sheets
    }


def _common(job: GearPairJob) -> dict[str, str]:
    rack, pair = job.pair.rack, job.design.pair
    facts = {
        "module": f"{job.pair.module:.6g} mm",
        "pressure angle": f"{math.degrees(rack.pressure_angle):.6g} deg",
        "addendum": f"{rack.addendum:.6g} modules",
        "dedendum": f"{rack.dedendum:.6g} modules",
        "backlash": f"{pair.backlash:.6g} mm",
        "face width": f"{pair.face_width:.6g} mm",
    }
    if job.design.helix.steps > 1:
        facts["steps"] = f"{job.design.helix.steps}"
    return facts


def wheel_facts(job: GearPairJob, gear: Gear) -> dict[str, str]:
    """Return the rows of a wheel's table: `job`, `gear`."""
    blank, toothing = job.design.blank.wheel(gear.wheel), gear.toothing
    facts = {"teeth": f"{toothing.teeth}", **_common(job)}
    shift = job.design.pair.x if gear.wheel == 1 else -job.design.pair.x
    if shift:
        facts["profile shift"] = f"{shift:+.6g} modules"
    facts["centrode length"] = f"{toothing.length:.6g} mm"
    facts["cutter"] = toothing.cutter.kind
    if blank.clearance:
        facts["clearance"] = f"{blank.clearance:.6g} mm"
    if blank.tip_rounding:
        facts["tip rounding"] = f"R{blank.tip_rounding:.6g}"
    return facts | weight_facts(job.parts[gear.wheel - 1], blank)


def weight_facts(part: Part, blank: WheelBlank) -> dict[str, str]:
    """Return the rows of a `part`'s table on its mass, if its `blank` has a density."""
    from gearcam.parts.mass import mass_properties

    if blank.density is None:
        return {}
    found = mass_properties(part, blank.density)
    return {
        "density": f"{blank.density:.6g} kg/m3",
        "mass": f"{found.mass:.4g} kg",
        "centroid X, Y": f"{found.centroid[0]:.3f}, {found.centroid[1]:.3f}",
        "unbalance": f"{found.unbalance:.5g} g mm",
    }


def pair_facts(job: GearPairJob) -> dict[str, str]:
    """Return the rows of the table of a `job`'s pair."""
    low, high = (value for _, value in job.law.ratio_range)
    facts = {"law": job.design.law_type, "teeth": f"{job.pair.teeth[0]} : {job.pair.teeth[1]}"}
    facts |= _common(job)
    if not job.pair.on_rack:
        facts["ratio i21"] = f"{low:.5g} to {high:.5g}"
    facts["drawn at phi1"] = f"{math.degrees(job.design.output.pose):.6g} deg"
    return facts
