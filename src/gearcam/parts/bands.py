"""A solid around an axis as bands: planes, cylinders and B-splines, for exact solids.

A *band* goes once around the axis, between two *rings*; each begins at the ring at which the one
before ends. From the bore up over the upper face, down the outside and back over the lower face
they enclose the solid. Bands of B-splines are cut into *sectors*, the same ones in all bands, where
the surface is not smooth. Depends on numeric; numpy only.
"""

from __future__ import annotations

from dataclasses import dataclass

from gearcam.base.display import ShortRepr
from gearcam.numeric.nets import SplineNet
from gearcam.parts.body import Part


@dataclass(frozen=True, kw_only=True)
class FlatBand(ShortRepr):
    """A plane across the axis at a `height`, mm: a ring, or a disc."""

    height: float


@dataclass(frozen=True, kw_only=True)
class RoundBand(ShortRepr):
    """A cylinder about the axis of a `radius`, mm."""

    radius: float


@dataclass(frozen=True, eq=False, kw_only=True)
class SplineBand(ShortRepr):
    """B-splines, one in each sector.

    Parameters
    ----------
    sectors : tuple of SplineNet or None
        Their rows follow each other around the axis, their columns go from the first ring to the
        second. None: both rings are one there. The ends of a sector may be points.
    """

    sectors: tuple[SplineNet | None, ...]


Band = FlatBand | RoundBand | SplineBand


@dataclass(frozen=True, eq=False, kw_only=True)
class BandedBody(ShortRepr):
    """A solid that bands enclose.

    Parameters
    ----------
    name : str
        Name of the product in a file.
    bands : tuple of Band
        The bands. With a bore the last is joined to the first; without one both are discs.
    rising : bool
        Whether azimuths rise from sector to sector.
    error : float, mm
        Largest distance of the true surface from the B-splines that was measured.
    volume : float, mm^3
        The volume that the solid must have.
    volume_error : float, mm^3
        By how much it may differ.
    core : Part or None
        A round part within it, whose openings, hubs, marks and chamfers it has.
    """

    name: str
    bands: tuple[Band, ...]
    rising: bool
    error: float
    volume: float
    volume_error: float
    core: Part | None = None
