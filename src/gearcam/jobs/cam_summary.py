"""The summary of a cam: one JSON document that says what was made and how exact it is."""

from __future__ import annotations

import math
from collections.abc import Mapping
from typing import TYPE_CHECKING, Any

import numpy as np

from gearcam.cams.measures import Range
from gearcam.jobs.summary import (
    CHORD_HOW,
    FORMAT,
    dxf_how,
    kerf_entry,
    listed,
    versions,
)

if TYPE_CHECKING:
    from gearcam.jobs.cam import CamJob


def summarize(
    job: CamJob, files: Mapping[str, str | None], extras: dict[str, Any]
) -> dict[str, Any]:
    """Return the summary of a job.

    Parameters
    ----------
    job : CamJob
        A built design.
    files : mapping of str to str or None
        Files beside the summary, each with the hash of the design that it was made from.
    extras : dict
        What exporters measured: ``dxf``, ``solids``, ``curvature``, ``followed``.

    Returns
    -------
    dict
        For JSON; what does not exist is left out.
    """
    findings = [finding.as_dict() for finding in job.findings]
    return {
        "format": FORMAT,
        "name": job.design.name,
        "kind": job.design.kind,
        **kerf_entry(job.design.output.kerf),
        "motion": _motion(job),
        "cam": _cam(job),
        **_part(job),
        **listed(job.design_hash, files),
        "findings": findings,
        "accuracy": _accuracy(job, extras),
        **{name: extras[name] for name in ("solids", "curvature", "followed") if name in extras},
        "timings_s": {name: round(value, 6) for name, value in job.timings.items()},
        "versions": versions(),
    }


def _motion(job: CamJob) -> dict[str, Any]:
    """Lift in mm or deg; what jumps has a peak, what is infinite has none."""
    program = job.program
    swings = job.design.follower.oscillating
    scale = math.degrees(1.0) if swings else 1.0
    low, high = program.range
    names = ("peak_velocity", "peak_acceleration", "peak_jerk")
    known = zip(names, program.peaks[: program.continuity + 1], strict=False)
    return {
        "unit": "deg" if swings else "mm",
        "lift": {"min": scale * low, "max": scale * high},
        "continuity": program.continuity,
        **{name: scale * value for name, value in known},
    }


def _cam(job: CamJob) -> dict[str, Any]:
    design, cam, mechanism = job.design, job.cam, job.mechanism
    swings = mechanism.oscillating
    made: dict[str, Any] = {
        "form": design.cam.form,
        "follower": f"{design.follower.motion} {design.follower.type}",
        "rotation": design.cam.rotation,
        "prime_radius_mm": mechanism.least,
        "base_radius_mm": mechanism.least - mechanism.radius,
        "thickness_mm": design.cam.thickness,
        "pressure_angle_deg": _pressure(job),
        "curvature": _curvature(job),
        "undercut": [[math.degrees(low), math.degrees(high)] for low, high in cam.undercut_ranges],
    }
    if swings:
        made["start_angle_deg"] = math.degrees(mechanism.start)
    if cam.corners:
        made["lost_lift_deg" if swings else "lost_lift_mm"] = (
            math.degrees(cam.shortfall) if swings else cam.shortfall
        )
    if cam.contact_place is not None:
        made["contact_mm"] = _ends(cam.contact_place)
    made["profile"] = _profile(job)
    return made


def _profile(job: CamJob) -> dict[str, Any]:
    """Return the sizes of the profile as made: with clearance those of its parallel."""
    cam, contour, clearance = job.cam, job.contour, job.design.blank.clearance
    reach = np.hypot(*contour.vertices.T)
    least = min(float(reach.min()), cam.nearest_flat - clearance)
    common = {
        "chord_error_mm": contour.chord_error,
        "vertices": len(contour.vertices),
        "radius_mm": {"min": least, "max": float(reach.max())},
    }
    if clearance:
        return {"clearance_mm": clearance, "area_mm2": contour.moments.area, **common}
    return {
        "perimeter_mm": cam.size.perimeter,
        "area_mm2": cam.size.area,
        "least_vertices": cam.sampler.least,
        **common,
    }


def _ends(found: Range, scale: float = 1.0) -> dict[str, float]:
    return {"min": scale * found.low.value, "max": scale * found.high.value}


def _pressure(job: CamJob) -> dict[str, Any]:
    made: dict[str, Any] = {}
    for kind in ("rise", "return"):
        found = job.cam.pressure(kind)
        if found is not None:
            made[f"{kind}_max"] = math.degrees(found.largest)
            made[kind] = _ends(found, math.degrees(1.0))
    return made


def _curvature(job: CamJob) -> dict[str, float]:
    """Smallest radii: of any sign, and of the convex and concave parts of the profile."""
    cam = job.cam
    convex, concave = cam.profile_radius
    made = {"profile_min_mm": min(convex, concave)}
    whole = cam.pitch_curvature()
    made["pitch_min_mm"] = min(convex, concave) if whole is None else 1.0 / whole.largest
    for kind in ("rise", "return"):
        found = cam.pitch_curvature(kind)
        if found is not None:
            made[f"pitch_{kind}_min_mm"] = 1.0 / found.largest
    made |= {"profile_convex_min_mm": convex, "profile_concave_min_mm": concave}
    return {name: value for name, value in made.items() if math.isfinite(value)}


def _part(job: CamJob) -> dict[str, Any]:
    """Return what is known of a cam as a part, if one is ordered."""
    if not job.ordered:
        return {}
    from gearcam.parts.mass import mass_properties

    (tool,) = job.part_subject.tools
    made: dict[str, Any] = {
        "tool": tool.as_dict(),
        "openings": [opening.as_dict() for opening in job.part.openings],
    }
    if job.design.blank.density is not None:
        made["mass"] = mass_properties(job.part, job.design.blank.density).as_dict()
    found = {name: value for name, value in made.items() if value}
    return {"part": found} if found else {}


def _accuracy(job: CamJob, extras: dict[str, Any]) -> dict[str, Any]:
    """Error estimates, and how each was made."""
    reach = float(np.abs(job.profile.vertices).max())
    values: dict[str, Any] = {
        "profile_mm": 16.0 * np.finfo(float).eps * reach,
        "chord_mm": job.contour.chord_error,
    }
    how = {
        "profile_mm": "rounding of closed forms at the largest radius",
        "chord_mm": CHORD_HOW,
    }
    if not job.design.blank.clearance:
        size = job.cam.size
        values |= {"perimeter_mm": size.perimeter_error, "area_mm2": size.area_error}
        quadrature = "Gauss-Legendre quadrature with half the cells, and rounding"
        how |= {"perimeter_mm": quadrature, "area_mm2": quadrature}
    dxf = extras.get("dxf")
    if dxf is not None:
        values["dxf_mm"] = dxf["error_mm"]
        how["dxf_mm"] = dxf_how(job.design.output.kerf, dxf["curves"])
    return {**values, "how": how}
