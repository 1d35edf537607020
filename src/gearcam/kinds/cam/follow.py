"""The other way round: from a given profile and the design's follower to the motion."""

from __future__ import annotations

import math
import os
from pathlib import Path
from typing import TYPE_CHECKING, Any

import numpy as np

from gearcam.errors import DesignError, Problem
from gearcam.numeric.arrays import Array

if TYPE_CHECKING:
    from gearcam.kinds.cam.build import CamResult


_SAGITTA = 0.01
"""Chord error of arcs that are flattened, in the design's chord tolerances."""

_COLUMNS = ("x_mm", "y_mm")


def read_profile(file: str | Path) -> tuple[Array, Array]:
    """Read a closed profile.

    Parameters
    ----------
    file : path
        A DXF file with one closed outline (or one on the layer PROFILE or OUTLINE), or a CSV file
        with the columns x_mm and y_mm.

    Returns
    -------
    vertices : (n, 2) array, mm
        First not repeated.
    bulges : (n,) array
        Of the pieces between them.

    Raises
    ------
    DesignError
        If the file cannot be read, or holds no such profile.
    """
    name = os.fspath(file)
    try:
        if name.lower().endswith(".dxf"):
            from gearcam.export.dxf_read import read_outline

            return read_outline(Path(name).read_bytes())
        from gearcam.laws.columns import read_rows

        vertices, _ = read_rows(name).columns(_COLUMNS)
    except (OSError, ValueError) as error:
        reason = getattr(error, "strerror", None) or str(error)
        rule = "a DXF file with one closed outline, or a CSV file with the columns x_mm, y_mm"
        raise DesignError([Problem(f"is no profile: {reason}", file=name, allowed=rule)]) from error
    if len(vertices) > 1 and np.array_equal(vertices[0], vertices[-1]):
        vertices = vertices[:-1]
    return vertices, np.zeros(len(vertices))


def followed(
    result: CamResult, vertices: Array, bulges: Array
) -> tuple[dict[str, Array], dict[str, Any]]:
    """Run a design's follower on a profile.

    Parameters
    ----------
    result : CamResult
        Follower, size of the cam, and the program to compare with.
    vertices : (n, 2) array, mm
        The profile in the cam's frame, as the design would draw it.
    bulges : (n,) array
        Of its pieces.

    Returns
    -------
    columns : dict of str to (m,) array
        For ``followed.csv``: the lift found, the lift asked for, their difference.
    facts : dict
        For the summary.

    Raises
    ------
    InfeasibleError
        If the follower cannot rest on the profile.
    """
    from gearcam.cams.follow import follow
    from gearcam.kinds.cam.files import cam_angles
    from gearcam.numeric.bulges import flatten_bulges

    design = result.design
    points = flatten_bulges(vertices, bulges, _SAGITTA * result.cam.tolerance)
    side = np.array([-1.0 if design.cam.clockwise else 1.0, 1.0])
    theta = cam_angles(result)
    found = follow(points * side, result.mechanism, theta)
    swings = design.follower.oscillating
    scale, unit = (math.degrees(1.0), "deg") if swings else (1.0, "mm")
    asked = result.program.derivatives(theta, 0)[0]
    difference = scale * (found.lift - asked)
    columns = {
        "theta_deg": np.degrees(theta),
        "s": scale * found.lift,
        "s_asked": scale * asked,
        "difference": difference,
        "error": scale * found.error,
        "contact_x_mm": side[0] * found.contact.real,
        "contact_y_mm": found.contact.imag,
    }
    worst = int(np.abs(difference).argmax())
    facts = {
        "points": len(points),
        "unit": unit,
        "largest_difference": float(difference[worst]),
        "at_deg": math.degrees(theta[worst]),
        "rms_difference": float(np.sqrt(np.mean(difference**2))),
        "error": float(scale * found.error.max()),
    }
    return columns, facts
