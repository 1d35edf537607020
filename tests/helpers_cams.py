"""Cams of every kind of follower with sizes that suit each other, and what is measured of them."""

from __future__ import annotations

import math
from collections.abc import Sequence
from dataclasses import dataclass
from typing import Any

import numpy as np
import shapely
from numpy.typing import NDArray

from gearcam.base.tolerances import DEFAULT
from gearcam.cams.disc import CHORD_TOLERANCE, DiscCam, make_cam
from gearcam.cams.followers import Arm, Face, FlatArm, FlatStem, Follower, Round, Stem
from gearcam.cams.placing import make_follower
from gearcam.cams.spec import CamSpec, FollowerSpec
from gearcam.laws.motion import MOTION_LAWS
from gearcam.laws.phases_of_lift import DwellPhase, Phase, ReturnPhase, RisePhase
from gearcam.laws.program import Program, make_program
from witness.cam_sweep import Follower as Witness

Array = NDArray[np.float64]
Plane = Any
"""A complex array: the stubs cannot follow products with matrices."""

TURN = 2.0 * math.pi
QUARTERS = (90.0, 90.0, 90.0, 90.0)

SWINGING = {"motion": "oscillating", "pivot_distance": 100.0}

SPECS: dict[str, tuple[dict[str, Any], dict[str, Any]]] = {
    "point": ({"type": "point", "offset": 5.0}, {"prime_radius": 30.0}),
    "roller": ({"type": "roller", "roller_radius": 6.0}, {"prime_radius": 30.0}),
    "roller, offset": (
        {"type": "roller", "roller_radius": 6.0, "offset": 8.0},
        {"prime_radius": 30.0},
    ),
    "roller, offset back": (
        {"type": "roller", "roller_radius": 6.0, "offset": -8.0},
        {"prime_radius": 30.0},
    ),
    "domed": ({"type": "domed", "dome_radius": 60.0, "offset": 3.0}, {"base_radius": 60.0}),
    "flat": ({"type": "flat"}, {"base_radius": 40.0}),
    "swinging point": ({"type": "point", "arm": 90.0, **SWINGING}, {"prime_radius": 40.0}),
    "swinging roller": (
        {"type": "roller", "roller_radius": 8.0, "arm": 90.0, **SWINGING},
        {"prime_radius": 40.0},
    ),
    "swinging dome": (
        {"type": "domed", "dome_radius": 50.0, "arm": 110.0, **SWINGING},
        {"base_radius": 40.0},
    ),
    "swinging face": ({"type": "flat", **SWINGING}, {"base_radius": 40.0}),
    "swinging face, near": (
        {"type": "flat", "face_offset": 7.0, **SWINGING},
        {"base_radius": 40.0},
    ),
    "swinging face, far": (
        {"type": "flat", "face_offset": -7.0, **SWINGING},
        {"base_radius": 40.0},
    ),
}
"""One cam of each kind, by name: what the follower and the cam are given, mm."""

KINDS = list(SPECS)


def law(name: str, **parameters: Any) -> Any:
    """Return the parameters of a rise."""
    return MOTION_LAWS[name].parameters(**parameters)


def rise(name: str, degrees: float, lift: float, *, swings: bool = False, **more: Any) -> RisePhase:
    """Return a rise of a lift in mm, or in degrees where it `swings`."""
    return RisePhase(angle=math.radians(degrees), law=law(name, **more), **_lift(lift, swings))


def back(
    name: str, degrees: float, lift: float | None = None, *, swings: bool = False, **more: Any
) -> ReturnPhase:
    """Return a return, by all that was risen where no lift is given."""
    given = {} if lift is None else _lift(lift, swings)
    return ReturnPhase(angle=math.radians(degrees), law=law(name, **more), **given)


def _lift(lift: float, swings: bool) -> dict[str, Any]:
    return {"lift": math.radians(lift) if swings else lift}


def dwell(degrees: float) -> DwellPhase:
    """Return a dwell."""
    return DwellPhase(angle=math.radians(degrees))


def program(phases: Sequence[Phase], *, swings: bool = False) -> Program:
    """Return the program of some phases."""
    return make_program(phases, DEFAULT, oscillating=swings)


def there_and_back(
    name: str, lift: float, degrees: Sequence[float] = QUARTERS, *, swings: bool = False
) -> Program:
    """Return a rise, a dwell, a return and a dwell; a dwell of no angle is left out."""
    up, top, down, bottom = degrees
    phases: list[Phase] = [rise(name, up, lift, swings=swings)]
    if top:
        phases.append(dwell(top))
    phases.append(back(name, down))
    if bottom:
        phases.append(dwell(bottom))
    return program(phases, swings=swings)


def follower_of(kind: str, **changed: float) -> Any:
    """Return the follower of a kind; `changed` are other sizes of the follower or the cam."""
    follower, cam = (dict(given) for given in SPECS[kind])
    for name, value in changed.items():
        (cam if name in ("prime_radius", "base_radius") else follower)[name] = value
    return make_follower(FollowerSpec(**follower), CamSpec(**cam))


@dataclass(frozen=True)
class Sizes:
    """A follower over a cam that turns, as numbers for formulas: what it has not is 0."""

    flat: bool
    oscillating: bool
    start: float
    radius: float = 0.0
    offset: float = 0.0
    arm: float = 0.0
    pivot: float = 0.0
    face_offset: float = 0.0

    @property
    def round(self) -> Round:
        if self.oscillating:
            pivot = complex(self.pivot)
            return Arm(start=self.start, radius=self.radius, arm=self.arm, pivot=pivot)
        return Stem(start=self.start, radius=self.radius, offset=self.offset)

    @property
    def follower(self) -> Follower:
        if not self.flat:
            return self.round
        if self.oscillating:
            return FlatArm(start=self.start, pivot=self.pivot, offset=self.face_offset)
        return FlatStem(start=self.start, offset=self.offset)


def sizes_of(follower: Any) -> Sizes:
    """Return the numbers of a follower."""
    flat, swings = isinstance(follower, Face), follower.angular
    more = {
        "radius": follower.radius,
        "offset": 0.0 if swings else follower.offset,
        "arm": getattr(follower, "arm", 0.0),
        "pivot": complex(getattr(follower, "pivot", 0.0)).real,
        "face_offset": follower.offset if flat and swings else 0.0,
    }
    return Sizes(flat=flat, oscillating=swings, start=follower.start, **more)


def witness_of(kind: str, **changed: float) -> Witness:
    """Return the same follower for the witness, which knows nothing of the package."""
    given: dict[str, Any] = {**SPECS[kind][0], **SPECS[kind][1], **changed}
    radius = given.get("roller_radius", 0.0) + given.get("dome_radius", 0.0)
    size = given["prime_radius"] if "prime_radius" in given else given["base_radius"] + radius
    return Witness(
        size=size,
        flat=given["type"] == "flat",
        swings="motion" in given,
        radius=radius,
        offset=given.get("offset", 0.0),
        arm=given.get("arm", 0.0),
        pivot=given.get("pivot_distance", 0.0),
        face=given.get("face_offset", 0.0),
    )


def lever(made: DiscCam) -> float:
    """Return mm of contact for a unit of lift, to measure both motions alike."""
    m = sizes_of(made.follower)
    return (m.arm or m.pivot) if m.oscillating else 1.0


def cam(
    kind: str,
    rise_law: str = "cycloidal",
    lift: float = 10.0,
    degrees: Sequence[float] = QUARTERS,
    *,
    clockwise: bool = False,
    tolerance: float = CHORD_TOLERANCE,
    **changed: float,
) -> DiscCam:
    """Return a cam of a kind; `lift` in mm, or in degrees of an arm."""
    found = follower_of(kind, **changed)
    motion = there_and_back(rise_law, lift, degrees, swings=found.angular)
    return make_cam(motion, found, clockwise=clockwise, tolerance=tolerance)


def dense(made: DiscCam) -> Plane:
    """Return the points of the contour's runs, seen as if the cam turned counter-clockwise."""
    points = np.concatenate([run.points for run in made.contour.runs])
    return -np.conj(points) if made.clockwise else points


def pieces_of(made: DiscCam) -> list[Plane]:
    """Return the points of each smooth piece, seen as if the cam turned counter-clockwise."""
    runs = [run.points for whole in made.contour.runs for run in whole.pieces]
    return [-np.conj(points) for points in runs] if made.clockwise else runs


def corners_of(made: DiscCam) -> Plane:
    """Return the vertices of the polygon, seen as if the cam turned counter-clockwise."""
    points = made.contour.points
    return -np.conj(points) if made.clockwise else points


def angles(count: int, shift: float = 0.3) -> Array:
    """Return even cam angles over a turn, away from round places."""
    return (np.arange(count, dtype=np.float64) + shift) * (TURN / count)


def resting(made: DiscCam, theta: Array, margin: float = 0.0) -> NDArray[np.bool_]:
    """Whether the follower rests on a corner at cam angles, or within a margin of such."""
    found = np.zeros(theta.shape, dtype=bool)
    for corner in made.corners:
        width = (corner.after - corner.before) % TURN
        found |= (theta - corner.before + margin) % TURN <= width + 2.0 * margin
    return found


def stiffness(made: DiscCam, theta: Array) -> Array:
    """Return the lift, mm or rad, that a mm of metal gives along the normal of the contact."""
    place: Any = made.curve.contact(theta, 0).place.c[0]
    along = np.cos(made.motion(theta)["pressure"])
    m = sizes_of(made.follower)
    if not m.oscillating:
        return 1.0 / along
    if m.flat:
        # perpendicular to the face, whatever its offset
        return 1.0 / place
    return 1.0 / (m.arm * along)


def close(contour: Any, region: Any, chord: float) -> None:
    """Demand that a contour encloses a region within its chords, whose tolerance is in mm."""
    off = shapely.symmetric_difference(contour.polygon, region).area
    assert off < 3.0 * chord * region.length + 1e-9
