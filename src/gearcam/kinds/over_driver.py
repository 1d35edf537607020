"""Charts of a cam over its angle or travel."""

from __future__ import annotations

from collections.abc import Callable
from functools import partial
from typing import TYPE_CHECKING

import numpy as np

from gearcam.pictures.charts import Chart, knot_marks

if TYPE_CHECKING:
    from gearcam.kinds.loaded_cam import LoadedCam


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
