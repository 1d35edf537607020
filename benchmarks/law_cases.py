"""Meshing studies of all laws against that of the ellipse."""

from __future__ import annotations

from functools import partial
from typing import Any

import numpy as np

import gearcam
from cases import load
from gearcam.meshing.numbers import numbers
from gearcam.meshing.study import study
from measuring import Result, in_turns, table

DESIGN = """
kind = "gear-pair"
name = "law"
law = {{ {law} }}
pair = {{ module_mm = 2, teeth = [40, 40] }}
output = {{ files = ["csv"] }}
"""
ELLIPSE = "ellipse"
LAWS = {
    ELLIPSE: "eccentricity = 0.3",
    "constant": "",
    "phases": "knots_deg = [0, 160, 360], ratios = [1.6, 0.4, 1.6]",
    "three-phase-polynomial": "knots_deg = [0, 160, 270, 360], lowest = 0.6",
    "multispeed": 'ratios = [0.8, "solve"], angles_deg = [120, 120], transition_deg = 60',
    "fourier": 'of = "ratio", cosines = [0.2, 0.1], sines = [0.05]',
    "eccentric-circle": "eccentricity = 0.3",
    "limacon": "eccentricity = 0.25",
    "lobed": "eccentricity = 0.1, lobes = [2, 2]",
    "bspline": "radii = [1.0, 1.2, 1.0, 0.8]",
    "rounded-polygon": "corners = 4, corner_radius = 0.16666666666666666",
    "formula": 'phi2 = "phi1 - 0.08*sin(2*phi1)"',
    "motion": 'slide = "1 - cos(phi1 + 0.3*sin(phi1))'
    ' + 3*(1 - sqrt(1 - (sin(phi1 + 0.3*sin(phi1))/3)**2))", rod = 3',
}
ROWS = 361
NOTE = """\
360 steps over a turn, 40 : 40 teeth, module 2 mm. The times include the numbers of the summary, not
the wheels, which exist before. All laws alternate with the ellipse. The table has 361 rows of the
ellipse's ratio. The spiral, an open pair, and the rack are not comparable. Times relative to the
ellipse: {listed}."""


def against_ellipse(tries: int = 5) -> Result:
    """(h) The study of every closed law against that of the ellipse."""
    laws = {name: f'type = "{name}", {rest}'.rstrip(", ") for name, rest in LAWS.items()}
    laws[f"table of {ROWS} rows"] = _table(0.3)
    timings = in_turns({name: _study(law) for name, law in laws.items()}, tries)
    own = next(timing for timing in timings if timing.name == ELLIPSE)
    ratios = {timing.name: timing.over(own) for timing in timings}
    slowest = max(ratios, key=lambda name: ratios[name])
    return Result(
        title="(h) Meshing studies of all laws against that of the ellipse",
        asked="no law takes more than twice the ellipse's time",
        found=f"at most {ratios[slowest]:.2f} times, {slowest}",
        passed=ratios[slowest] <= 2.0,
        body=[
            *table(timings),
            "",
            NOTE.format(listed=", ".join(f"{name} {ratio:.2f}" for name, ratio in ratios.items())),
        ],
    )


def _study(law: str) -> partial[object]:
    design = load(DESIGN.format(law=law))
    job = gearcam.build(design)
    return partial(_numbers, job.gears, design.meshing)


def _numbers(gears: Any, spec: Any) -> object:
    return numbers(study(gears, spec))


def _table(e: float) -> str:
    """Return even rows of ``i = (1 - e^2)/(1 + e^2 + 2*e*cos(phi1))``, an ellipse."""
    angles = np.linspace(0.0, 360.0, ROWS)
    waves = np.cos(np.radians(angles))
    ratios = (1.0 - e * e) / (1.0 + e * e + 2.0 * e * waves)
    return f'type = "table", phi1_deg = {angles.tolist()}, ratio = {ratios.tolist()}'
