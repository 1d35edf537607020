"""Results of a study at some phases, and the rows of ``meshing.csv``."""

from __future__ import annotations

from collections.abc import Callable
from dataclasses import dataclass
from typing import Any

import numpy as np

from gearcam.meshing.contact import Contacts, contact_columns
from gearcam.meshing.overlap import Overlaps, Turning
from gearcam.meshing.patches import Patches
from gearcam.meshing.solids import SolidOverlaps
from gearcam.numeric.arrays import Array, Mask


@dataclass(frozen=True, eq=False, kw_only=True)
class Block:
    """Results of some phases of a study.

    Parameters
    ----------
    first : int
        Number of the first phase.
    phi1, phi2 : (n,) arrays, rad
        Driver and nominal driven angles.
    lead : (n,) array, rad
        The driven wheel's turn from its nominal position at first contact on the side pressed
        together (for a rack its travel, mm); not finite where nothing touches.
    along : (n,) array, mm/rad
        Arcs along the pitch curve per such turn.
    backlash : (n,) array, mm
        Free travel of the driven wheel between both contacts, along the pitch curve.
    edge : (n,) bool array
        Whether an edge touches first.
    held_back_gap : (n,) array, mm
        Distance of the flanks when the driver is held back by the overclosure.
    overlaps : Overlaps
        Overlaps of the outlines, with the driver ahead.
    solids : SolidOverlaps or None
        The same of the solids, if asked for.
    contacts : Contacts
        Exact ones, without overclosure.
    patches : Patches
        Predicted overlaps.
    interferes : (n,) bool array
        Whether flanks overlap that should not, or more deeply than the overclosure explains.
    """

    first: int
    phi1: Array
    phi2: Array
    lead: Array
    along: Array
    backlash: Array
    edge: Mask
    held_back_gap: Array
    overlaps: Overlaps
    solids: SolidOverlaps | None
    contacts: Contacts
    patches: Patches
    interferes: Mask


def on_side(found: Overlaps, side: int) -> Mask:
    """Return which overlaps are of facing half-teeth of a side.

    Parameters
    ----------
    found : Overlaps
        Pieces.
    side : {-1, +1}
        sigma of the driver's half-teeth.

    Returns
    -------
    (n,) bool array
    """
    return found.facing & (found.half[0] % 2 == (side < 0))


def columns_of(blocks: list[Block], turning: Turning, side: int) -> dict[str, Array]:
    """Return the rows of a study: one per phase and pair that overlaps or is in contact.

    Parameters
    ----------
    blocks : list of Block
        Results, in order.
    turning : Turning
        The wheels.
    side : {-1, +1}
        sigma of the driver's flanks pressed together.

    Returns
    -------
    dict of str to (n,) array
        Columns by name; values that do not exist are masked.
    """
    parts = [_columns(block, turning, side) for block in blocks]
    if not parts:
        return {}
    return {name: np.ma.concatenate([part[name] for part in parts]) for name in parts[0]}


def _columns(block: Block, turning: Turning, side: int) -> dict[str, Array]:
    overlaps, exact, patch, solid = block.overlaps, block.contacts, block.patches, block.solids
    wheels = turning.driver, turning.driven
    keys = [
        (overlaps.step, *overlaps.half),
        *(
            (each.step, *(wheel.of_pair(each.pair, side) for wheel in wheels))
            for each in (exact, patch)
        ),
    ]
    if solid is not None:
        keys.append((solid.step, *solid.half))
    every, where = np.unique(
        np.hstack([np.stack(key) for key in keys]), axis=1, return_inverse=True
    )
    step, one, two = every
    rows = np.split(where.ravel(), np.cumsum([len(key[0]) for key in keys])[:-1])
    size = every.shape[1]

    def column(number: int, values: Array) -> Any:
        result = np.ma.array(np.zeros(size), mask=True)
        result[rows[number]] = np.ma.masked_invalid(values)
        return result

    return {
        "step": (block.first + step).astype(float),
        "phi1_deg": np.degrees(block.phi1[step]),
        "phi2_deg": np.degrees(block.phi2[step]),
        "tooth1": turning.driver.tooth(one).astype(float),
        "tooth2": turning.driven.tooth(two).astype(float),
        "side": np.where(one % 2 == 0, 1.0, -1.0),
        "facing": turning.face(block.phi1[step], one, two).astype(float),
        "carries": np.isin(np.arange(size), rows[1]).astype(float),
        "area_mm2": column(0, overlaps.area).filled(0.0),
        "predicted_mm2": column(2, patch.area),
        "closed_mm2": column(2, patch.closed),
        "depth_mm": column(0, overlaps.depth),
        "length_mm": column(0, overlaps.length),
        "patch_from_mm": column(0, overlaps.radius[0]),
        "patch_to_mm": column(0, overlaps.radius[1]),
        **{
            name: column(1, values)
            for name, values in contact_columns(exact, turning.distance).items()
        },
        f"lag_{turning.rolling.guide.unit}": np.ma.masked_invalid(0.0 - block.lead[step]),
        "backlash_mm": np.ma.masked_invalid(block.backlash[step]),
        "held_back_gap_mm": block.held_back_gap[step],
        **({} if solid is None else _solid_columns(solid, column)),
    }


def _solid_columns(solid: SolidOverlaps, column: Callable[[int, Array], Any]) -> dict[str, Array]:
    """Return the columns of overlaps of solids; `column` places the values in their rows."""
    low, high = solid.extents
    return {
        "overlap_mm3": column(3, solid.volume).filled(0.0),
        "overlap_from_z_mm": column(3, low),
        "overlap_to_z_mm": column(3, high),
    }
