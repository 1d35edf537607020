"""The other way round: from a given profile and the design's follower to the motion."""

from __future__ import annotations

import os
from collections.abc import Mapping
from pathlib import Path
from typing import Any

import numpy as np
from numpy.typing import ArrayLike

from gearcam.cams.follow import follow
from gearcam.cams.spec import FOLLOWED
from gearcam.cams.wall import Wall
from gearcam.errors import DesignError, Problem
from gearcam.facts import Fact
from gearcam.findings import Finding, run_checks
from gearcam.laws.columns import LARGEST, read_rows
from gearcam.numeric.arguments import points
from gearcam.numeric.arrays import Array
from gearcam.numeric.bulges import flatten_bulges
from gearcam.reading import UnreadableError, read

_SAGITTA = 0.01
"""Chord error of arcs that are flattened, in the design's chord tolerances."""

_COLUMNS = ("x_mm", "y_mm")


def read_profile(file: str | Path | ArrayLike, wall: Wall) -> tuple[Array, Array]:
    """Read a closed profile.

    Parameters
    ----------
    file : path or (n, 2) array, mm
        A DXF file with one closed outline (or one on the layer PROFILE, OUTLINE or INNER), or a CSV
        file with the columns x_mm and y_mm; or the points themselves.
    wall : Wall
        Which it is: one outside a pitch curve is on the layer OUTER.

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
    if not isinstance(file, str | os.PathLike):
        vertices = _open(points("profile", file))
        return vertices, np.zeros(len(vertices))
    name = os.fspath(file)
    try:
        if name.lower().endswith(".dxf"):
            from gearcam.export.dxf_read import read_outline

            return read_outline(read(name, LARGEST), outer=wall.side < 0)
        vertices, _ = read_rows(name).columns(_COLUMNS)
    except (UnreadableError, ValueError) as error:
        rule = "a DXF file with one closed outline, or a CSV file with the columns x_mm, y_mm"
        raise DesignError([Problem(f"is no profile: {error}", file=name, allowed=rule)]) from error
    vertices = _open(vertices)
    return vertices, np.zeros(len(vertices))


def _open(vertices: Array) -> Array:
    """Return vertices without a last one that repeats the first."""
    return vertices[:-1] if np.array_equal(vertices[:1], vertices[-1:]) else vertices


def followed(
    wall: Wall, vertices: Array, bulges: Array, theta: Array, limits: Mapping[str, float]
) -> tuple[dict[str, Array], dict[str, Any], tuple[Finding, ...]]:
    """Run a cam's follower on a profile.

    Parameters
    ----------
    wall : Wall
        Its follower, as wide as a groove, the size of the cam, and the program to compare with.
    vertices : (n, 2) array, mm
        The profile in the cam's frame, as the design would draw it.
    bulges : (n,) array
        Of its pieces.
    theta : (m,) array, rad
        Cam angles.
    limits : mapping of str to float
        Of the design.

    Returns
    -------
    columns : dict of str to (m,) array
        For ``followed.csv``: the lift found, the lift asked for, their difference.
    facts : dict
        What was found.
    findings : tuple of Finding
        Of the checks.

    Raises
    ------
    InfeasibleError
        If the follower cannot rest on the profile.
    """
    outline = flatten_bulges(vertices, bulges, _SAGITTA * wall.tolerance)
    mechanism = wall.curve.mechanism
    driver = mechanism.driver
    mirrored = wall.clockwise and not mechanism.slide
    side = np.array([-1.0 if mirrored else 1.0, 1.0])
    found = follow(outline * side, mechanism, theta, wall.tolerance)
    scale, unit = mechanism.outward
    asked = wall.program.derivatives(theta, 0)[0]
    difference = scale * (found.lift - asked)
    columns = {
        driver.column: driver.scale * theta,
        "s": scale * found.lift,
        "s_asked": scale * asked,
        "difference": difference,
        "error": scale * found.error,
        "contact_x_mm": side[0] * found.contact.real,
        "contact_y_mm": found.contact.imag,
    }
    worst = int(np.abs(difference).argmax())
    facts = {
        "points": len(outline),
        "unit": unit,
        "largest_difference": Fact(
            float(difference[worst]),
            "largest difference from the program",
            place=driver.seen(float(theta[worst])),
            unit=unit,
            shown=True,
        ),
        f"at_{driver.unit}": driver.scale * float(theta[worst]),
        "rms_difference": float(np.sqrt(np.mean(difference**2))),
        "error": Fact(
            float(scale * found.error.max()), "error of the profile's chords", unit=unit, shown=True
        ),
    }
    return columns, facts, run_checks(FOLLOWED, (wall, found), limits)
