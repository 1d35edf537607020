"""The reference cylinder cam and others of its sort."""

from __future__ import annotations

import math
import random
from collections.abc import Iterator
from itertools import count, islice
from typing import Any

import manifold3d
import numpy as np

from gearcam.base.errors import InfeasibleError
from gearcam.base.tolerances import DEFAULT
from gearcam.laws.motion import MOTION_LAWS
from gearcam.laws.phases_of_lift import DwellPhase, ReturnPhase, RisePhase
from gearcam.laws.program import Program, make_program
from gearcam.numeric.mesh import Mesh
from gearcam.spatial.cam import SpatialCam, SpatialWall
from gearcam.spatial.envelope import Roller
from gearcam.spatial.guides import Straight, SwingArm
from gearcam.spatial.make import make_cylinder
from gearcam.spatial.spec import CylinderSpec, SpatialFollower
from witness.roller_in_space import TURN, Mechanism, Swept

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


def undercut_cam(seed: int) -> SpatialCam | None:
    """A random cam whose roller is larger than a wall allows, as of plane cams; or None."""
    d = random.Random(seed)
    radius, law = 10.0 ** d.uniform(1.0, 2.0), d.choice(["cycloidal", "3-4-5", "modified-sine"])
    depth, height, arm = (radius * d.uniform(*ends) for ends in ((0.1, 0.4), (0.3, 1.4), (1.2, 3)))
    swings, made = seed % 2 == 1, MOTION_LAWS[law].parameters()
    rise, back = (math.radians(d.uniform(45.0, 130.0)) for _ in range(2))
    pause = d.uniform(0.2, 0.8) * (TURN - rise - back)
    phases = (
        RisePhase(angle=rise, law=made, lift=height / arm if swings else height),
        DwellPhase(angle=pause),
        ReturnPhase(angle=back, law=made),
        DwellPhase(angle=TURN - rise - back - pause),
    )
    motion = make_program(phases, DEFAULT, oscillating=swings)
    inner, scale = radius - depth, arm if swings else 1.0
    _, first, second = scale * np.array(motion.derivatives(np.linspace(0.0, TURN, 721), 2))
    bends = (inner**2 + first**2) ** 1.5 / (inner * np.maximum(np.abs(second), 1e-9))
    size = float(bends.min()) * d.uniform(1.0, 1.8)
    cone = math.atan(0.5 * size / depth * d.random()) if seed % 3 == 0 else 0.0
    follower = SpatialFollower(
        motion="oscillating" if swings else "translating",
        roller_radius=size,
        cone=min(cone, 0.3),
        arm=arm if swings else None,
    )
    walls = ("both", "upper", "lower")[seed % 4 if seed % 4 < 3 else 0]
    length = 2.0 * (height + size + radius)
    cylinder = CylinderSpec(
        outer_diameter=2.0 * radius,
        length=length,
        lowest=0.5 * (length - height),
        groove_depth=depth,
        roller_clearance=0.02 * size * d.random(),
        walls=walls,
    )
    try:
        cam = make_cylinder(motion, follower, cylinder, 0.0)
    except InfeasibleError:
        return None
    return cam if cam.undercut else None


def undercut_cams(number: int) -> Iterator[SpatialCam]:
    """The first random undercut cams, so many."""
    found = (cam for cam in map(undercut_cam, count()) if cam is not None)
    return islice(found, number)


def swept(wall: SpatialWall) -> Swept:
    """What the tool of a cam leaves of a wall."""
    cam, tool = wall.cam, wall.cam.tool
    shift = -0.5 * wall.side * cam.apart

    def center(at: Any) -> tuple[Any, Any]:
        point, _ = cam.guide.placed(cam.program.derivatives(at.ravel(), 0)[0])
        y, z = (point[0, :, k].reshape(at.shape) for k in (1, 2))
        return y, z + shift

    aside = np.abs(center(np.linspace(0.0, TURN, 721))[0]).max()
    roller = Mechanism(center, tool.radius, tool.at, tool.half_angle, cam.floor)
    return Swept(roller, wall.side, 1.01 * float(aside))


def slice_way(wall: SpatialWall, left: Swept, theta: float, x: float) -> float:
    """How far a slice goes until it rests, at most to the end of the lift, mm or rad."""
    cam, (low, high) = wall.cam, wall.cam.program.range
    lift = cam.program.derivatives(np.array([theta]), 0)[0]

    def moved(way: float) -> tuple[float, float]:
        point, _ = cam.guide.placed(lift + wall.side * way)
        return float(point[0, 0, 1]), float(point[0, 0, 2])

    most = high - lift[0] if wall.side > 0 else lift[0] - low
    return left.way(theta, x, moved, float(most))


def solid(made: Mesh) -> Any:
    """A closed surface as an object of manifold3d."""
    found = manifold3d.Manifold(manifold3d.Mesh64(made.vertices, made.triangles.astype(np.uint64)))
    assert found.status() == manifold3d.Error.NoError
    return found
