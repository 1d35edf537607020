"""The numbers of a study: what its rows come to, for the summary."""

from __future__ import annotations

from typing import TYPE_CHECKING, Any

import numpy as np
from numpy.typing import NDArray

from gearcam.meshing.contact import stretches
from gearcam.meshing.rows import on_side, stepwise_pairs

if TYPE_CHECKING:
    from gearcam.meshing.study import Meshing

Array = NDArray[np.float64]


def numbers(meshing: Meshing) -> dict[str, Any]:
    """Return the numbers of a study, for JSON; what does not exist is left out.

    Parameters
    ----------
    meshing : Meshing
        A study.

    Returns
    -------
    dict
        As described in docs/conventions.md.
    """
    setup = meshing.setup
    pairs = setup.pairs[setup.side]
    turning = setup.turning
    start, end, carrying = stretches(pairs)
    result = {
        "complete": meshing.complete,
        "steps": meshing.asked,
        "steps_done": len(meshing.phi1),
        "advance_deg": float(np.degrees(setup.spec.advance)),
        "penetration_mm": setup.penetration,
        "chord_error_mm": max(turning.driver.chord_error, turning.driven.chord_error),
        "contact_ratio": extent(pairs.contact_ratios),
        "arcs": [
            {"from_deg": float(a), "to_deg": float(b), "pairs": int(n)}
            for a, b, n in zip(np.degrees(start), np.degrees(end), carrying, strict=True)
        ],
    }
    if not turning.rolling.law.feeds:
        result["center_distance_mm"] = turning.distance
    if not meshing.blocks:
        return result
    error, stepwise = meshing.every("error"), pairs_in_contact(meshing)
    touching = np.isfinite(error)
    result |= {
        "pairs_in_contact": extent(stepwise, int),
        "interference_steps": int(np.count_nonzero(meshing.every("interferes"))),
        "agreement": agreement(meshing, stepwise),
    }
    if touching.any():
        unit = "mm" if turning.rolling.law.feeds else "rad"
        result |= {
            f"transmission_error_{unit}_max": float(np.abs(error[touching]).max()),
            f"transmission_error_{unit}_peak_to_peak": float(np.ptp(error[touching])),
        }
    backlash = meshing.every("backlash")
    if np.isfinite(backlash).any():
        result["backlash_mm"] = extent(backlash[np.isfinite(backlash)])
    held = meshing.every("held_back")
    if np.isfinite(held).any():
        result["held_back_gap_mm"] = extent(held[np.isfinite(held)])
    return result


def extent(values: Array | NDArray[np.int64], kind: type = float) -> dict[str, Any]:
    """Return the smallest and the largest of some values.

    Parameters
    ----------
    values : (n,) array
        Not empty.
    kind : type
        Type of the numbers.

    Returns
    -------
    dict
        ``min`` and ``max``.
    """
    return {"min": kind(values.min()), "max": kind(values.max())}


def pairs_in_contact(meshing: Meshing) -> NDArray[np.int64]:
    """Return how many pairs overlap at each phase, as the outlines say.

    Parameters
    ----------
    meshing : Meshing
        A study.

    Returns
    -------
    (n,) int array
    """
    setup = meshing.setup
    return np.concatenate(
        [
            stepwise_pairs(block.overlaps, setup.side, len(block.phi1), setup.noise)
            for block in meshing.blocks
        ]
    )


def agreement(meshing: Meshing, stepwise: NDArray[np.int64]) -> dict[str, Any]:
    """Compare the outlines' overlaps with those that the exact flanks predict.

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
        ``clipped_mm2``: largest difference from the integrated gap elsewhere; ``steps_apart``:
        phases at which outlines and exact flanks, both with the advance, count different pairs.
    """
    inside, clipped, predicted = [0.0], [0.0], []
    for block in meshing.blocks:
        area, lens, closed = (
            dict(zip(keys, values.tolist(), strict=True)) for keys, values in _areas(meshing, block)
        )
        for key, value in lens.items():
            found, plain = area.get(key, 0.0), closed[key]
            if np.isfinite(plain):
                inside.append(abs(found / plain - 1.0))
            else:
                clipped.append(abs(found - value))
        deep = block.lenses.step[block.lenses.depth > meshing.setup.noise]
        predicted.append(np.bincount(deep, minlength=len(block.phi1)))
    apart = np.count_nonzero(stepwise != np.concatenate(predicted))
    return {
        "inside": float(max(inside)),
        "clipped_mm2": float(max(clipped)),
        "steps_apart": int(apart),
    }


def _areas(meshing: Meshing, block: Any) -> list[tuple[list[tuple[int, int]], Array]]:
    """Areas of the facing pairs by (step, half): found, predicted, in closed form."""
    side, driver = meshing.setup.side, meshing.setup.turning.driver
    found, lens = block.overlaps, block.lenses
    good = on_side(found, side)
    halves = (driver.index(2 * lens.pair - (side < 0)) + driver.first).tolist()
    keys = list(zip(lens.step.tolist(), halves, strict=True))
    seen = list(zip(found.step[good].tolist(), found.half[0][good].tolist(), strict=True))
    return [(seen, found.area[good]), (keys, lens.area), (keys, lens.closed)]
