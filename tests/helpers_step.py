"""For tests of STEP files: exact parts, and a reader of their text that knows no CAD kernel."""

from __future__ import annotations

import math
import re
from dataclasses import replace

import numpy as np

from gearcam.numeric.contour import Contour, Run
from gearcam.numeric.splines import fit_splines
from gearcam.parts.body import Part
from gearcam.parts.shapes import Loop
from helpers_splines import cubics

KEYED = 10.0, 2.5, 12.8
"""Radius of a bore, half the width of its keyway, and where that ends, mm."""

DENT = 0.25
"""Bulge of the keyway's floor, which bows into the opening: an arc that turns right."""


def keyed_bore() -> Loop:
    """Three arcs, of at most a half circle, and a keyway upwards, its floor an arc."""
    radius, half, top = KEYED
    x, y = half, math.sqrt(radius**2 - half**2)
    begin = math.atan2(y, -half)
    angles = np.linspace(begin, 2 * math.pi + math.atan2(y, half), 4)
    arcs = radius * np.column_stack([np.cos(angles), np.sin(angles)])
    vertices = np.vstack([arcs, [[x, top], [-x, top]]])
    bend = math.tan((angles[1] - angles[0]) / 4)
    return Loop(vertices=vertices, bulges=np.array([bend, bend, bend, 0.0, -DENT, 0.0]))


def keyed_area() -> float:
    """Circle, less the segment above the chord between the walls, and the keyway from there on."""
    radius, half, top = KEYED
    y = math.sqrt(radius**2 - half**2)
    keyway = 2 * half * (top - y) - segment(half, floor_radius())
    return math.pi * radius**2 - segment(half, radius) + keyway


def floor_radius() -> float:
    """Of the keyway's floor, mm, from its half chord and sagitta."""
    half = KEYED[1]
    return half * (1 + DENT**2) / (2 * DENT)


def segment(half: float, radius: float) -> float:
    """Area between a circle and the chord of a half length, mm^2."""
    return radius**2 * math.asin(half / radius) - half * math.sqrt(radius**2 - half**2)


def plate(contour: Contour, width: float = 6.0, **wanted: object) -> Part:
    return Part(name="gear1", contours=(contour,), width=width, **wanted)  # type: ignore[arg-type]


def one_run(contour: Contour, *, joints: bool = True, doubled: bool = False) -> Contour:
    """The runs of a smooth outline as one, joints where they met, perhaps with a piece of 0 mm."""
    ends = np.cumsum([len(run.points) - 1 for run in contour.runs])[:-1].tolist()
    points, tangents = (
        np.vstack([*(values[:-1] for values in each), each[-1][-1:]])
        for each in (
            [run.points for run in contour.runs],
            [run.tangents for run in contour.runs],
        )
    )
    if doubled:
        points, tangents = (np.insert(v, ends[0], v[ends[0]], axis=0) for v in (points, tangents))
        ends = [ends[0], *(end + 1 for end in ends)]
    run = Run(points=points, tangents=tangents, joints=tuple(ends) if joints else ())
    return replace(contour, dense=lambda: (run,))


def pieces(contour: Contour) -> tuple[int, int]:
    """How many pieces are curved and how many straight: these have one tangent."""
    straight = [
        bool(np.ptp(piece.tangents, axis=0).max() < 1e-9)
        for run in contour.runs
        for piece in run.pieces
    ]
    return len(straight) - sum(straight), sum(straight)


def spline_area(contour: Contour, tolerance: float) -> float:
    """Area inside the fitted cubics, integrated exactly (degree 5) from their Bezier points."""
    place, weight = np.polynomial.legendre.leggauss(3)
    t, s = 0.5 * (1 + place), 0.5 * (1 - place)
    basis = np.stack([s**3, 3 * s * s * t, 3 * s * t * t, t**3])
    slopes = 3 * np.stack([s * s, 2 * s * t, t * t])
    total = 0.0
    # all at once, as the file's: how many are fitted together decides on lengths that are tried
    for spline in fit_splines([piece for run in contour.runs for piece in run.pieces], tolerance):
        x, y = np.moveaxis(cubics(spline), 2, 0)
        swept = (x @ basis) * (np.diff(y) @ slopes) - (y @ basis) * (np.diff(x) @ slopes)
        total += 0.25 * float((swept @ weight).sum())
    return total


def entities(data: bytes) -> dict[str, list[str]]:
    """What stands between the brackets of each simple entity, by kind."""
    text = re.sub(r"\n *", "", data.decode("ascii"))
    found: dict[str, list[str]] = {}
    for kind, inside in re.findall(r"#\d+ = (\w+)\((.*?)\);", text):
        found.setdefault(kind, []).append(inside)
    return found


def corners(data: bytes) -> np.ndarray:
    """The places of all vertices, (n, 3), in the file's numbers."""
    text = re.sub(r"\n *", "", data.decode("ascii"))
    points = dict(re.findall(r"#(\d+) = CARTESIAN_POINT\('',\((.*?)\)\);", text))
    used = re.findall(r"VERTEX_POINT\('',#(\d+)\)", text)
    return np.array([[float(number) for number in points[key].split(",")] for key in used])
