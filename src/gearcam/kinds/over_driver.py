"""Charts of a cam over its angle or travel."""

from __future__ import annotations

from collections.abc import Callable, Iterator, Sequence
from functools import partial
from typing import TYPE_CHECKING

import numpy as np

from gearcam.laws.phases_of_lift import (
    DwellPhase,
    Phase,
    ReturnPhase,
    RisePhase,
    SegmentPhase,
    angles_of,
    levels,
)
from gearcam.pictures.charts import Chart, Handle, knot_marks

if TYPE_CHECKING:
    from gearcam.kinds.loaded_cam import LoadedCam
    from gearcam.mechanics.driver_axis import DriverAxis


def over_driver(result: LoadedCam) -> Callable[..., Chart]:
    """Return what makes charts over the cam angle or travel, with marks at knots of the motion.

    Parameters
    ----------
    result : LoadedCam
        The cam.

    Returns
    -------
    callable
        A `Chart` that still takes its title, y axis, lines and limits.
    """
    driver = result.driver
    knots = knot_marks(driver.scale * np.asarray(result.program.knots), 0.0, driver.whole)
    return partial(Chart, x=driver.label, marks=knots)


def lift_handles(
    driver: DriverAxis,
    lift_unit: tuple[float, str],
    phases: Sequence[Phase] | object,
    *,
    half: bool = False,
) -> Iterator[Handle]:
    """Yield handles on a chart of the lift, at the ends of rises, returns and dwells.

    Parameters
    ----------
    driver : DriverAxis
        The horizontal axis.
    lift_unit : (float, str)
        Scale and unit of the lift there.
    phases : sequence of Phase
        Of the motion; one of another form has no handles.
    half : bool
        Whether they are those of half a turn.
    """
    if not isinstance(phases, Sequence):
        return
    scale, unit = lift_unit
    span = "angle_deg" if driver.label.endswith("deg") else "travel_mm"
    end, whole = 0.0, driver.whole / driver.scale
    ways = angles_of(phases, 0.5 * whole if half else whole)
    for k, (phase, way, lift) in enumerate(zip(phases, ways, levels(phases)[1:], strict=True)):
        end += way
        keys: dict[str, tuple[float, float]] = {}
        if k + 1 < len(phases):  # the next phase gives what this one takes
            keys = {f"motion[{k}].{span}": (1.0, 0.0), f"motion[{k + 1}].{span}": (-1.0, 0.0)}
        match phase:
            case ReturnPhase():
                keys[f"motion[{k}].lift_{unit}"] = 0.0, -1.0
            case RisePhase():
                keys[f"motion[{k}].lift_{unit}"] = 0.0, 1.0
            case SegmentPhase():
                keys[f"motion[{k}].to_{unit}"] = 0.0, 1.0
            case DwellPhase():
                pass
        yield Handle(x=driver.scale * end, y=scale * lift, keys=keys)
