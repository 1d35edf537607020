"""The reference cylinder cam and others of its sort."""

from __future__ import annotations

import math
from typing import Any

import manifold3d
import numpy as np

from gearcam.base.tolerances import DEFAULT
from gearcam.laws.motion.base import MOTION_LAWS
from gearcam.laws.phases_of_lift import DwellPhase, ReturnPhase, RisePhase
from gearcam.laws.program import Program, make_program
from gearcam.parts.solids import Mesh
from gearcam.spatial.cam import SpatialCam
from gearcam.spatial.envelope import Roller
from gearcam.spatial.guides import Straight, SwingArm
from gearcam.spatial.surface import Surface

RISE = math.radians(120.0)
PAUSE = math.radians(60.0)
SPANS = (RISE, PAUSE, RISE, PAUSE)


def program(lift: float = 30.0, law: str = "cycloidal", *, oscillating: bool = False) -> Program:
    """Rise, dwell, return, dwell: 120, 60, 120 and 60 degrees."""
    made = MOTION_LAWS[law].parameters()
    phases = (
        RisePhase(angle=RISE, law=made, lift=lift),
        DwellPhase(angle=PAUSE),
        ReturnPhase(angle=RISE, law=made),
        DwellPhase(angle=PAUSE),
    )
    return make_program(phases, DEFAULT, oscillating=oscillating)


def reference(half_angle: float = 0.0, height: float = 0.0, **more: Any) -> SpatialCam:
    """Lift 30 mm, roller 8 mm at the outer radius of 40 mm, depth 12 mm."""
    given: dict[str, Any] = {
        "program": program(),
        "guide": Straight(height=height),
        "roller": Roller(radius=8.0, at=40.0, half_angle=half_angle),
        "inner": 28.0,
        "floor": 28.0,
        "outer_radius": 40.0,
    }
    return SpatialCam(**given | more)


def swinging() -> SpatialCam:
    """The same roller on an arm of 60 mm that swings by 30 degrees, modified sine."""
    swing = math.radians(30.0)
    distance = 58.97777478867
    arm = SwingArm(
        length=60.0, distance=distance, start=-0.5 * swing, height=60.0 * math.sin(-swing / 2)
    )
    return reference(program=program(swing, "modified-sine", oscillating=True), guide=arm)


def solid(made: Mesh | Surface) -> Any:
    """A closed surface as an object of manifold3d."""
    found = manifold3d.Manifold(manifold3d.Mesh64(made.vertices, made.triangles.astype(np.uint64)))
    assert found.status() == manifold3d.Error.NoError
    return found


def enclosed(made: Surface) -> float:
    """Volume of a surface, mm^3."""
    return Mesh(vertices=made.vertices, triangles=made.triangles).volume
