"""Stepped wheels: layers of the same pair, the teeth of each offset along the pitch curves.

Both centrodes have the same arc length, so teeth offset by equal arcs on both wheels still mesh.
"""

from __future__ import annotations

from dataclasses import replace

from gearcam.base.errors import InfeasibleError, Way
from gearcam.gears.pair import GearPair
from gearcam.gears.spec import StepsSpec


def leads(pair: GearPair, spec: StepsSpec) -> tuple[float, ...]:
    """Return the tooth offsets of the steps, mm along the pitch curves.

    Parameters
    ----------
    pair : GearPair
        The lowest step.
    spec : StepsSpec
        Count and offset.

    Returns
    -------
    tuple of float
        Reduced to one pitch, since whole pitches change nothing; the first is 0.

    Raises
    ------
    InfeasibleError
        If the wheels are open.
    """
    if spec.count > 1 and not pair.closed:
        raise InfeasibleError(
            "open wheels and racks cannot be stepped: their end teeth would leave the blank",
            where="steps.count",
            value=spec.count,
            limit=1,
            nearest="open wheels have one step",
            ways=(Way(near={"steps.count": 1}),),
        )
    pitch = pair.toothings[0].pitch
    offset = pitch / spec.count if spec.offset is None else spec.offset
    return tuple(number * offset % pitch for number in range(spec.count))


def stepped(pair: GearPair, moved: float) -> GearPair:
    """Return the pair with its teeth offset by `moved`, mm (see `leads`)."""
    if moved == 0.0:
        return pair
    first, second = (replace(toothing, moved=moved) for toothing in pair.toothings)
    return replace(pair, toothings=(first, second))
