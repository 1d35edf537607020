"""The package ncgears from PyPI, on the law of the nail machine and on a law that it can build.

Its engine gets samples of the law computed beforehand, so that its time includes neither the
evaluation of the formula nor drawings.
"""

from __future__ import annotations

import math
import tempfile
import time
from collections.abc import Callable
from dataclasses import dataclass
from pathlib import Path

import numpy as np
from ncgears.engine import generate_geometry, load_engine_config
from numpy.typing import NDArray

Array = NDArray[np.float64]
SAMPLES = 8192
"""The default of ncgears for laws given as formulas."""
SAMPLES_PER_RADIAN = 110
"""The default of ncgears."""


@dataclass(frozen=True)
class Law:
    """phi2 and three derivatives over one turn, from `start`, where they must be smooth."""

    name: str
    start: float
    derivatives: Callable[[Array], tuple[Array, Array, Array, Array]]


@dataclass(frozen=True)
class Attempt:
    """The outcome of one call: run time, and a message or the result."""

    seconds: float
    built: bool
    outcome: str


def nail_machine(start: float) -> Law:
    """Two cosine phases: ratio 1.6, 0.4, 1.6 at 0, 160, 360 degrees."""
    first, turn = math.radians(160), 2 * math.pi

    def derivatives(phi: Array) -> tuple[Array, Array, Array, Array]:
        whole = np.floor(phi / turn)
        x = phi - turn * whole
        falling = x < first
        width = np.where(falling, first, turn - first)
        origin = np.where(falling, 0.0, first)
        w = math.pi / width
        half = np.where(falling, 0.6, -0.6)
        angle = w * (x - origin)
        return (
            turn * whole + x + half / w * np.sin(angle),
            1.0 + half * np.cos(angle),
            -half * w * np.sin(angle),
            -half * w * w * np.cos(angle),
        )

    return Law("nail machine, two phases", start, derivatives)


def even_swing() -> Law:
    """The sinusoidal law phi2 = phi1 - 0.6*sin(phi1): ratios from 0.4 to 1.6, without knots."""

    def derivatives(phi: Array) -> tuple[Array, Array, Array, Array]:
        sine, cosine = 0.6 * np.sin(phi), 0.6 * np.cos(phi)
        return phi - sine, 1.0 - cosine, sine, cosine

    return Law("phi1 - 0.6*sin(phi1)", 0.0, derivatives)


def attempt(law: Law, module: float, teeth: int) -> Attempt:
    """Time the generation of both outlines by ncgears with the default rack of gearcam."""
    seconds, made = _generated(law, module, teeth)
    if isinstance(made, str):
        return Attempt(seconds, built=False, outcome=made)
    return Attempt(seconds, built=True, outcome=f"{len(made[0])} and {len(made[1])} points")


def outlines(law: Law, module: float, teeth: int) -> tuple[Array, Array] | str:
    """Return both outlines of ncgears, (n, 2), mm, or its error message."""
    return _generated(law, module, teeth)[1]


def _generated(law: Law, module: float, teeth: int) -> tuple[float, tuple[Array, Array] | str]:
    """Return the run time in s, without sampling the law, and both outlines or the error."""
    with tempfile.TemporaryDirectory() as folder:
        path = _sampled(law, Path(folder))
        start = time.perf_counter()
        try:
            result = generate_geometry(_config(path, law, module, teeth), SAMPLES_PER_RADIAN)
        except (ValueError, RuntimeError) as error:
            return time.perf_counter() - start, str(error)
        seconds = time.perf_counter() - start
    return seconds, (np.asarray(result.drive_outline), np.asarray(result.driven_outline))


def _sampled(law: Law, folder: Path) -> Path:
    """Write the samples of a law into a file and return its path."""
    phi = law.start + 2 * math.pi * np.arange(SAMPLES) / SAMPLES
    angle, *rates = law.derivatives(phi)
    columns = np.column_stack([phi, angle - angle[0], *rates])
    path = folder / "transmission.csv"
    np.savetxt(
        path, columns, delimiter=",", header="phi,psi,psi1,psi2,psi3", comments="", fmt="%.17g"
    )
    return path


def _config(path: Path, law: Law, module: float, teeth: int) -> object:
    return load_engine_config(
        input_flag="--transmission-csv",
        input_path=path,
        name="peer",
        description=law.name,
        teeth=teeth,
        module=module,
        pressure_angle_deg=20.0,
        addendum_factor=1.0,
        dedendum_factor=1.25,
        fillet_factor=0.38,
        clearance=0.0,
        max_backlash_deg=None,
        domain_start=law.start,
        domain_end=law.start + 2 * math.pi,
        active_start=law.start,
        active_end=law.start + 2 * math.pi,
        period=2 * math.pi,
        cycle_delta=2 * math.pi,
        open_=False,
        extra_arguments=(),
    )
