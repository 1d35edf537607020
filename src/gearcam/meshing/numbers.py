"""Summary numbers of a meshing study."""

from __future__ import annotations

from typing import Any

import numpy as np

from gearcam.base.facts import extent
from gearcam.gears.contact import DRIVE
from gearcam.meshing.edges import known_to
from gearcam.meshing.harmonics import harmonics, too_few
from gearcam.meshing.study import Meshing
from gearcam.numeric.arrays import Array, Ints, Mask

WHOLE = 1e-9
"""Rounding of whole turns given in degrees, in turns."""


def numbers(meshing: Meshing) -> dict[str, Any]:
    """Return the summary numbers of a study; numbers that do not exist are left out.

    Parameters
    ----------
    meshing : Meshing
        A study.

    Returns
    -------
    dict
        Ready for JSON; docs/summary.md explains the names.
    """
    setup = meshing.setup
    pairs = setup.pairs[setup.side]
    turning = setup.turning
    start, end, carrying = pairs.arcs.stretches
    result = {
        "complete": meshing.complete,
        "steps": meshing.asked,
        "steps_done": len(meshing.phi1),
        "overclosure_deg": float(np.degrees(setup.spec.overclosure)),
        "penetration_mm": setup.penetration,
        "chord_error_mm": max(turning.driver.chord_error, turning.driven.chord_error),
        "contact_ratio": _extent(pairs.arcs.ratios),
        "arcs": [
            {"from_deg": float(a), "to_deg": float(b), "pairs": int(n)}
            for a, b, n in zip(np.degrees(start), np.degrees(end), carrying, strict=True)
        ],
    }
    if turning.rolling.guide.turns:
        result["center_distance_mm"] = abs(turning.distance)
    if not meshing.blocks:
        return result
    stepwise = pairs_in_contact(meshing)
    result |= {
        "pairs_in_contact": _extent(stepwise),
        "interference_steps": int(np.count_nonzero(meshing.every("interferes"))),
        "edge_steps": int(np.count_nonzero(meshing.every("edge"))),
        "agreement": agreement(meshing, stepwise),
        **transmission(meshing),
    }
    if setup.bodies is not None:
        result |= _of_solids(meshing)
    for name in ("backlash", "held_back_gap"):
        found = meshing.every(name)
        found = found[np.isfinite(found)]
        if found.size:
            result[f"{name}_mm"] = _extent(found)
    return result


def _of_solids(meshing: Meshing) -> dict[str, Any]:
    """Return the overlap of solids, and the length of teeth on which they bear at a phase."""
    rows = meshing.columns
    volume, bearing = rows["overlap_mm3"], rows["overlap_to_z_mm"] - rows["overlap_from_z_mm"]
    result: dict[str, Any] = {
        "overlap_max_mm3": float(volume.filled(0.0).max(initial=0.0)),
        "overlap_sum_mm3": float(volume.sum()),
    }
    bears = meshing.on_side & ~np.ma.getmaskarray(bearing)
    if bears.any():
        result["bearing_length_mm"] = _extent(bearing.data[bears])
    return result


def transmission(meshing: Meshing) -> dict[str, Any]:
    """Return the mean lag of the driven wheel and its transmission error.

    Parameters
    ----------
    meshing : Meshing
        A study.

    Returns
    -------
    dict
        ``lag_mm``, the lag behind the nominal position along the pitch curve with the backlash
        taken up; ``transmission_error``, the deviation from its mean; what is at most its
        ``known_to``, the rounding, is 0.
    """
    setup, lead, along = meshing.setup, meshing.every("lead"), meshing.every("along")
    touching = np.isfinite(lead)
    if not touching.any():
        return {}
    unit = setup.turning.rolling.guide.unit
    least = rounding(meshing)
    error: dict[str, Any] = {
        "unit": unit,
        "known_to": least,
        "mean_lag": _without_noise(-lead[touching].mean(), least),
        "peak_to_peak": _without_noise(np.ptp(lead[touching]), least),
    }
    reason = without_harmonics(meshing, touching)
    if reason:
        error["no_harmonics"] = reason
    else:
        start, end = setup.stretch
        turns = round((end - start) / (2.0 * np.pi))
        teeth = setup.pairs[DRIVE].wheels[0].toothing.teeth
        error["harmonics"] = harmonics(lead, start, turns, teeth, least)
    return {"lag_mm": _extent((0.0 - lead * along)[touching]), "transmission_error": error}


def without_harmonics(meshing: Meshing, touching: Mask) -> str:
    """Return why a study has no harmonics; an empty string if it has them.

    Parameters
    ----------
    meshing : Meshing
        A study.
    touching : (n,) bool array
        Phases at which anything touches.

    Returns
    -------
    str
        Reason and remedy.
    """
    spec, pairs = meshing.setup.spec, meshing.setup.pairs[DRIVE]
    teeth = pairs.wheels[0].toothing.teeth
    turns = (meshing.setup.stretch[1] - meshing.setup.stretch[0]) / (2.0 * np.pi)
    if not pairs.closed:
        return "the driver does not turn all around"
    if round(turns) < 1 or abs(turns - round(turns)) > WHOLE:
        return "the study does not cover whole turns of the driver"
    if spec.teeth is not None or not meshing.complete:
        return "not every phase was studied"
    if not touching.all():
        return "in some phases nothing touches"
    return too_few(meshing.asked, teeth * round(turns))


def rounding(meshing: Meshing) -> float:
    """Return to how much the lead of a study is known at all phases, rad (for a rack mm)."""
    setup = meshing.setup
    return float(known_to(setup.pairs[setup.side], meshing.phi1).max())


def _without_noise(value: float, least: float) -> float:
    return 0.0 if abs(value) <= least else float(value)


def _extent(values: Array | Ints) -> dict[str, float]:
    return extent(values.min().item(), values.max().item())


def pairs_in_contact(meshing: Meshing) -> Ints:
    """Return the number of pairs whose outlines overlap at each phase, (n,)."""
    rows = meshing.columns
    good = meshing.on_side & (rows["depth_mm"].filled(0.0) > meshing.setup.noise)
    if meshing.setup.faces:  # on tilted axes the middle may be clear
        good = meshing.on_side & (rows["overlap_mm3"].filled(0.0) > 0.0)
    return np.bincount(rows["step"].data[good].astype(np.int64), minlength=len(meshing.phi1))


def agreement(meshing: Meshing, stepwise: Ints) -> dict[str, Any]:
    """Return differences of the outlines' overlaps from those predicted by the exact flanks.

    Parameters
    ----------
    meshing : Meshing
        A study.
    stepwise : (n,) int array
        Pairs that overlap at each phase.

    Returns
    -------
    dict
        ``inside``: largest relative difference of the area from the closed form where that holds;
        ``clipped_mm2``: largest difference from the integrated depth elsewhere; ``steps_apart``:
        phases at which outlines and exact flanks, both with the overclosure, give different pairs.
    """
    area, predicted, closed = (
        meshing.columns[name] for name in ("area_mm2", "predicted_mm2", "closed_mm2")
    )
    noise = meshing.setup.noise
    clipped = np.abs(area - predicted)[np.ma.getmaskarray(closed)]
    found = [
        np.bincount(block.patches.step, block.patches.depth > noise, minlength=len(block.phi1))
        for block in meshing.blocks
    ]
    return {
        "inside": float(np.abs(area / closed - 1.0).filled(0.0).max(initial=0.0)),
        "clipped_mm2": float(clipped.filled(0.0).max(initial=0.0)),
        "steps_apart": int(np.count_nonzero(stepwise != np.concatenate(found))),
    }
