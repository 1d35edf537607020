"""The summary of a build: one JSON document that says what was made and how exact it is."""

from __future__ import annotations

import math
import platform
import sys
from collections.abc import Mapping
from typing import TYPE_CHECKING, Any

import numpy as np

from gearcam import __version__

if TYPE_CHECKING:
    from gearcam.gears.pair import Gear
    from gearcam.jobs.gear_pair import GearPairJob


FORMAT = 2
"""Version of the summary's layout."""

CHORD_HOW = (
    "largest distance of the curve from a chord: measured at 13 places, or, "
    "where the curvature hardly changes, from the tangents at its ends"
)
"""How a sampler knows its chord error."""


def summarize(
    job: GearPairJob, files: Mapping[str, str | None], extras: dict[str, Any]
) -> dict[str, Any]:
    """Return the summary of a job.

    Parameters
    ----------
    job : GearPairJob
        A built design.
    files : mapping of str to str or None
        Files beside the summary, each with the hash of the design that it was made from.
    extras : dict
        What exporters measured: ``dxf``, ``solids``; the numbers of a ``meshing`` study.

    Returns
    -------
    dict
        For JSON; what does not exist is left out.
    """
    findings = [finding.as_dict() for finding in job.findings]
    pair = job.pair
    given = job.design.pair.center_distance
    solved: dict[str, float] = dict(pair.law.solved)
    low, high = pair.law.ratio_range[0][1], pair.law.ratio_range[1][1]
    size = pair.center_distance
    facts: dict[str, Any] = {"center_distance_mm": size, "ratio": {"min": low, "max": high}}
    if pair.on_rack:
        radius = {"min": size * low, "max": size * high}
        facts = {"way_per_turn_mm": size * pair.law.lobes.advance, "radius_mm": radius}
        solved["mm_per_unit_of_r1"] = size
    elif given is None:
        solved["center_distance_mm"] = size
    else:
        solved["module_mm"] = pair.module
    return {
        "format": FORMAT,
        "name": job.design.name,
        "kind": job.design.kind,
        "pair": {
            "module_mm": pair.module,
            "teeth": list(pair.teeth),
            "face_width_mm": job.design.pair.face_width,
            "x": job.design.pair.x,
            "backlash_mm": job.design.pair.backlash,
            "rack": _rack(job),
            **facts,
            "solved": solved,
        },
        **kerf_entry(job.design.output.kerf),
        "gears": [_gear(job, gear) for gear in job.gears],
        **listed(job.design_hash, files),
        "findings": findings,
        "accuracy": _accuracy(job, extras),
        **_helix(job),
        **{name: extras[name] for name in ("solids", "meshing") if name in extras},
        "timings_s": {name: round(value, 6) for name, value in job.timings.items()},
        "versions": versions(),
    }


def listed(design: str, files: Mapping[str, str | None]) -> dict[str, Any]:
    """Return what a summary says of the files beside it: those of its own design, and stale ones.

    Parameters
    ----------
    design : str
        Hash of the design that the summary describes.
    files : mapping of str to str or None
        By name the hash of the design that each was made from; None where it is not known.

    Returns
    -------
    dict
        ``design``, ``files``, and ``stale`` if there are any.
    """
    stale = {name: made for name, made in files.items() if made != design}
    current = {name: design for name in files if name not in stale}
    return {"design": design, "files": current, **({"stale": stale} if stale else {})}


def kerf_entry(kerf: float) -> dict[str, float]:
    """Return what a summary says of the `kerf`, mm, that paths of cutting files allow for."""
    return {"kerf_mm": kerf} if kerf else {}


def _rack(job: GearPairJob) -> dict[str, Any]:
    """Return the basic rack as it was used, and the defaults that yielded to given values."""
    rack = job.pair.rack
    yielded = rack.yielded(job.design.rack)
    return {
        "pressure_angle_deg": math.degrees(rack.pressure_angle),
        "addendum": rack.addendum,
        "dedendum": rack.dedendum,
        "tip_radius": rack.tip_radius,
        **({"yielded": yielded} if yielded else {}),
    }


def _helix(job: GearPairJob) -> dict[str, Any]:
    from gearcam.gears.helix import leads

    ways = leads(job.pair, job.design.helix)
    return {"helix": {"steps": len(ways), "moved_mm": list(ways)}} if len(ways) > 1 else {}


def _gear(job: GearPairJob, gear: Gear) -> dict[str, Any]:
    cutter, radius = gear.toothing.cutter, gear.convex_radius
    blank = job.design.blank.wheel(gear.wheel)
    tool = {"cutter_pitch_radius_mm": 1.0 / cutter.kc} if cutter.kind == "pinion" else {}
    tool["cutter_tip_radius_mm"] = cutter.tip_radius
    return {
        "name": gear.name,
        "teeth": gear.toothing.teeth,
        "centrode": {
            "length_mm": gear.toothing.length,
            **({"min_convex_radius_mm": radius} if math.isfinite(radius) else {}),
            "max_concave_curvature_per_mm": gear.concave_curvature,
            "closed": gear.toothing.closed,
        },
        "cutter": cutter.kind,
        **tool,
        "undercut_teeth": list(gear.profile.undercut_teeth),
        "tip_thickness_min_mm": float(gear.profile.tip_thickness.min()),
        "root_radius_min_mm": gear.least_radius,
        **({"bore_diameter_mm": blank.bore} if job.bores[gear.wheel - 1] else {}),
        **({"clearance_mm": blank.clearance} if blank.clearance else {}),
        "outline": {
            "vertices": len(gear.outline),
            "least_vertices": gear.profile.sampler.least,
            "area_mm2": gear.profile.area,
            "chord_error_mm": gear.profile.chord_error,
        },
        **_part(job, gear),
    }


def _part(job: GearPairJob, gear: Gear) -> dict[str, Any]:
    """Return what is known of a wheel as a part, if parts are ordered."""
    if not job.ordered:
        return {}
    from gearcam.parts.mass import mass_properties

    part, density = job.parts[gear.wheel - 1], job.design.blank.wheel(gear.wheel).density
    found = job.parts_subject.tools[gear.wheel - 1].as_dict()
    made: dict[str, Any] = {"tool": found} if found else {}
    made["openings"] = [opening.as_dict() for opening in part.openings]
    if density is not None:
        made["mass"] = mass_properties(part, density).as_dict()
    return {name: value for name, value in made.items() if value}


def _accuracy(job: GearPairJob, extras: dict[str, Any]) -> dict[str, Any]:
    """Error estimates, and how each was made."""
    rolling, law = job.pair.rolling, job.law
    reach = max(float(np.hypot(*gear.outline.T).max()) for gear in job.gears)
    dxf = extras.get("dxf")
    values: dict[str, Any] = {
        "law": law.error,
        "closure_rad": abs(law.closure_error),
        "arc_length_mm": rolling.arc_error,
        "flank_mm": rolling.arc_error + reach * law.error + 8.0 * np.finfo(float).eps * reach,
        "chord_mm": max(gear.profile.chord_error for gear in job.gears),
    }
    how = {
        "law": "rad of the driven angle: against Gauss-Legendre quadrature of the ratio",
        "closure_rad": "miss of the driven angle over a lobe",
        "arc_length_mm": "last Chebyshev coefficients over all intervals, and rounding",
        "flank_mm": "arc length, and the law's error and rounding at the largest radius",
        "chord_mm": CHORD_HOW,
    }
    if dxf is not None:
        values["dxf_mm"] = dxf["error_mm"]
        how["dxf_mm"] = dxf_how(job.design.output.kerf, dxf["curves"])
    return {**values, "how": how}


def dxf_how(kerf: float, curves: str) -> str:
    """Return how the errors of DXF files were found: with a `kerf`, mm, and of which `curves`."""
    what = "the edge, or its parallel at half the kerf" if kerf else "the curve"
    return f"files read back ({curves}), against {what}, both ways"


def versions() -> dict[str, str]:
    """Return versions of what made the numbers: the program, Python, libraries loaded so far."""
    found = {"gearcam": __version__, "python": platform.python_version()}
    for name in ("numpy", "shapely", "ezdxf", "manifold3d", "trimesh"):
        module = sys.modules.get(name)
        if module is not None and hasattr(module, "__version__"):
            found[name] = str(module.__version__)
    return found
