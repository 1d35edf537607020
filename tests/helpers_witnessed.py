"""Pairs that the witnesses are held against: gearcam's outlines beside the raw law."""

from __future__ import annotations

from dataclasses import dataclass
from functools import cache
from typing import Any

import numpy as np

from gearcam.base.tolerances import DEFAULT
from gearcam.gears.cutter import choose_cutter
from gearcam.gears.flank import Curve, Toothing, trace
from gearcam.gears.outline import Outline, build_outline
from gearcam.gears.rolling import roll
from gearcam.gears.spec import BasicRack
from gearcam.gears.track import Wheel
from gearcam.laws.ratio.ellipse import Ellipse
from gearcam.laws.ratio.phases import Phases
from gearcam.laws.ratio.span import Lobes
from witness import laws
from witness.kinematics import Basic, Rolling


@dataclass(frozen=True)
class Case:
    """One pair: gearcam's law and the witness's, and its size."""

    law: Any
    witness: laws.Law
    teeth: int
    distance: float | None = None
    module: float | None = None


CASES = {
    "ellipse": Case(Ellipse(eccentricity=0.3), laws.ellipse(0.3), 40, module=2.0),
    "two phases": Case(
        Phases(shape="cosine", knots=tuple(np.radians([0, 160, 360])), ratios=(1.6, 0.4, 1.6)),
        laws.NAIL_TWO,
        36,
        distance=180.0,
    ),
    "three phases": Case(
        Phases(
            shape="cosine",
            knots=tuple(np.radians([0, 160, 270, 360])),
            ratios=(1.6, 0.4, "solve", 1.6),
        ),
        laws.NAIL_THREE,
        36,
        distance=180.0,
    ),
}


@cache
def toothings(name: str) -> tuple[Toothing, Toothing]:
    """Both wheels of a case before their outlines."""
    case = CASES[name]
    rolling = roll(
        case.law.build(Lobes(1, 1), DEFAULT),
        teeth=(case.teeth, case.teeth),
        center_distance=case.distance,
        module=case.module,
        tolerances=DEFAULT,
    )
    module = rolling.tracks[0].length / (np.pi * case.teeth)

    def toothing(wheel: Wheel) -> Toothing:
        track = rolling.tracks[wheel - 1]
        concave = -float(track.curvature_extremes[1].min())
        cutter = choose_cutter(BasicRack(), module, concave)
        return Toothing(track=track, wheel=wheel, teeth=case.teeth, cutter=cutter)

    return toothing(1), toothing(2)


@cache
def outline(name: str, wheel: Wheel, tolerance: float = 1e-4) -> Outline:
    """The outline of a wheel."""
    pair = toothings(name)
    mate = pair[2 - wheel]
    return build_outline(pair[wheel - 1], mate, tolerance, DEFAULT)


@cache
def kinematics(name: str) -> tuple[Rolling, Basic]:
    """The witness's own centrodes, and the rack at the module that they give."""
    case = CASES[name]
    unit = Rolling(case.witness, 1.0).length
    distance = case.distance
    if distance is None:
        distance = (case.module or 1.0) * np.pi * case.teeth / unit
    rolling = Rolling(case.witness, distance)
    return rolling, Basic(rolling.length / (np.pi * case.teeth))


@cache
def cut_points(name: str, wheel: Wheel, per_row: int = 64) -> np.ndarray:
    """Points on flanks, fillets and root lands, what the cutter leaves, (n, 2), mm."""
    made = outline(name, wheel)
    rows = np.flatnonzero(made.rows.kind != Curve.TIP)
    start, end = made.rows.start[rows], made.rows.end[rows]
    phi = start + np.linspace(0.0, 1.0, per_row)[:, None] * (end - start)
    index = np.broadcast_to(rows, phi.shape).ravel()
    points, _ = trace(made.toothing, made.rows, index, phi.ravel())
    return np.stack([points.real, points.imag], axis=1)
