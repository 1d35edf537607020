"""What is drawn of a cam: charts, the scene and what colours it.

A chart is over cam angle or travel. In the scene the parts move over a turn or travel with the
follower, and profiles are coloured by values along them.
"""

from __future__ import annotations

import math
from collections.abc import Iterator
from functools import partial
from typing import TYPE_CHECKING, Any, Final

import numpy as np

from gearcam.base.findings import limit_of
from gearcam.base.numerals import FEW, formatted
from gearcam.cams.checks import KIND, pressure_limits
from gearcam.cams.wall import PitchMotion, Wall
from gearcam.kinds.cam.result import pressure_column, rho_column
from gearcam.kinds.over_driver import lift_handles, over_driver
from gearcam.laws.phases_of_lift import fill_half
from gearcam.numeric.arrays import Array
from gearcam.numeric.piecewise import with_both_sides
from gearcam.numeric.pose import Pose
from gearcam.parts.checks import KIND as PARTS_KIND
from gearcam.pictures.charts import Chart, Charts, Handle, Limit, Line
from gearcam.pictures.drawings import (
    CENTER,
    FOLLOWER,
    place,
)
from gearcam.pictures.scenes import PLACES, ColouredCurve, ContactPoints, MovingBody, Scene, still

if TYPE_CHECKING:
    from gearcam.cams.touch import WallTouch
    from gearcam.kinds.cam.result import CamResult
    from gearcam.laws.program import Program
    from gearcam.numeric.arrays import Plane

_TIMES: Final = 6.0
"""Largest curvature drawn, in curvatures below which nine tenths of all lie, or that of the roller:
an undercut or nearly sharp profile has no largest one, and would leave no room for the rest."""


def _of_time(name: str, result: CamResult) -> Chart | None:
    drive = result.design.drive
    timed = result.cam.motions[0].timed_scales(drive.speed)
    for column in timed:
        if column.startswith(name):
            unit = column.removeprefix(f"{name}_").replace("_", "/", 1)
            table = result.motion_of_turn
            return over_driver(result)(
                title=f"{name.capitalize()} of the follower at {drive.named}",
                y=f"{name}, {unit}",
                lines=(Line(label=name, x=table[result.driver.column], y=table[column]),),
            )
    return None


def _of_lift(name: str, result: CamResult) -> Chart:
    table = result.motion_of_turn
    column = next(column for column in table if column.startswith(name))
    unit = column.removeprefix(f"{name}_").replace("_per_", "/")
    lines = [Line(label=name, x=table[result.driver.column], y=table[column])]
    given = result.program.given
    if given is not None and name == "lift":
        theta, lift = given.T
        x, y = result.driver.scale * theta, result.follower.lift_unit[0] * lift
        lines.append(Line(label="given points, before smoothing", x=x, y=y, dots=True))
    title = f"{name.capitalize()} of the follower"
    handles = _lift_handles(result) if name == "lift" else ()
    return over_driver(result)(
        title=title, y=f"{name}, {unit}", lines=(*lines,), handles=(*handles,)
    )


def _lift_handles(result: CamResult) -> Iterator[Handle]:
    phases = result.design.motion
    half = result.form.half_turns and isinstance(phases, tuple) and fill_half(phases)
    return lift_handles(result.driver, result.follower.lift_unit, phases, half=half)


def _pressure_angle(result: CamResult) -> Chart | None:
    table = result.motion_of_turn
    if not any(np.any(table[pressure_column(one)]) for one in result.cam.motions):
        return None
    given = limit_of(KIND, "pressure-angle", result.design.limits)
    found = pressure_limits(result.follower, given)
    same = found["rise"] == found["return"]
    limits = {"limit" if same else f"limit, {kind}": one for kind, one in found.items()}
    return over_driver(result)(
        title="Pressure angle",
        y="pressure angle, deg",
        lines=tuple(
            Line(
                label=f"cam {one.key}" if one.key else "pressure angle",
                x=table[result.driver.column],
                y=table[pressure_column(one)],
            )
            for one in result.cam.motions
        ),
        limits=tuple(
            Limit(label=label, value=sign * math.degrees(one))
            for label, one in limits.items()
            for sign in (1.0, -1.0)
        ),
    )


def _radii(result: CamResult) -> dict[str, str]:
    """Return the columns of radii of the motion's table, by labels."""
    pitches = {
        f"pitch curve{f' of cam {one.key}' if one.key else ''}": rho_column("pitch", one)
        for one in result.cam.motions
    }
    walls = {
        f"{one.called} before trimming" if one.undercut else one.called: rho_column("profile", one)
        for one in result.cam.walls
    }
    return pitches | walls


def _curvature(result: CamResult) -> Chart:
    table, radius = result.motion_of_turn, result.follower.radius
    with np.errstate(divide="ignore"):
        lines = {label: 1.0 / table[name] for label, name in _radii(result).items()}
    if not result.follower.has_centre:
        del lines["pitch curve"]
    bent = np.abs(np.concatenate([*lines.values()]))
    bent = bent[np.isfinite(bent) & (bent > 0.0)]
    usual = _TIMES * float(np.percentile(bent, 90)) if bent.size else 0.0
    largest = max(usual, 1.0 / radius if radius else 0.0)
    tool = limit_of(PARTS_KIND, "tool-too-large", result.design.limits)
    limits = []
    if tool and any(math.isfinite(wall.profile_radius[1]) for wall in result.cam.walls):
        label = f"concave limit for a tool of {formatted(tool, FEW)} mm"
        limits.append(Limit(label=label, value=-2.0 / tool))
    rollers = {one.side / one.follower.radius: one for one in result.cam.walls if radius}
    for value, wall in rollers.items():
        what = "convex" if wall.side > 0 else "concave"
        limits.append(Limit(label=f"roller ({what} pitch curve)", value=value))
    return over_driver(result)(
        title="Curvature (positive: convex)",
        y="curvature, 1/mm",
        lines=tuple(
            Line(
                label=label if seen.all() else f"{label}, peaks outside this chart",
                x=table[result.driver.column],
                y=np.where(seen, values, np.nan),
            )
            for label, values in lines.items()
            for seen in (np.abs(values) <= largest,)
        ),
        limits=tuple(limits),
    )


_DERIVED: Final = ("velocity", "acceleration", "jerk")


def _sizes(result: CamResult) -> Chart | None:
    if result.solution is None:
        return None
    from gearcam.kinds.cam.solve import region

    return region(result.solution)


CHARTS: Final[Charts] = {
    "sizes": _sizes,
    "lift": partial(_of_lift, "lift"),
    "pressure_angle": _pressure_angle,
    "curvature": _curvature,
    **{name: partial(_of_lift, name) for name in _DERIVED},
    **{f"{name}_in_time": partial(_of_time, name) for name in _DERIVED},
}
"""Functions that return the charts by name; the report leads with the first three."""


PRESSURE_ANGLE: Final = "pressure angle, deg"


def coloured(result: CamResult, theta: Array) -> tuple[ColouredCurve, ...]:
    """Return the pressure angle along each profile, and forces if the design asks for them.

    Parameters
    ----------
    result : CamResult
        The cam.
    theta : (n,) array, rad or mm
        Positions of the driver over its turn or travel; with forces those of their study.

    Returns
    -------
    tuple of ColouredCurve
        For each place where the cam presses on its follower, as designed, before clearance. The
        pressure angle has no sign; it is left out where it is zero everywhere. Values end at the
        corners that trimming leaves, and at jumps of the velocity.
    """
    program, scale = result.program, result.driver.scale
    x, wall, forces = _within(theta, program), np.zeros(0), dict[str, Array]()
    study = result.studies.get("forces")
    if study is not None:
        from gearcam.kinds.follower_forces import COLOURS, TITLES

        x, wall = result.places_under_load, study.columns["wall"]
        forces = {TITLES[name][1]: study.columns[name] for name in COLOURS}
    names = [part.name for part in result.parts]
    jumps = np.searchsorted(x, [jump.theta for jump in program.hard])
    curves = []
    for number, touch in enumerate(result.cam.touches):
        points, pressure = _along(touch, x)
        values = {PRESSURE_ANGLE: np.degrees(np.abs(pressure))}
        values |= {
            name: _largest(np.where(wall == number + 1, one, np.nan), len(x))
            for name, one in forces.items()
        }
        seen = {name: np.where(np.isnan(points), np.nan, one) for name, one in values.items()}
        curve = ColouredCurve(
            body=names[min(number, len(names) - 1)],
            places=scale * np.insert(x, jumps, np.nan),
            points=np.insert(points, jumps, np.nan),
            values={
                name: np.insert(one, jumps, np.nan)
                for name, one in seen.items()
                if (one > 0.0).any()
            },
        )
        curves.append(curve)
    return tuple(one for one in curves if one.values)


def _largest(values: Array, count: int) -> Array:
    """Return values at rising positions; of a cam that slides to and fro the larger of both."""
    return values if len(values) == count else np.fmax(values[:count], values[count:][::-1])


def _within(theta: Array, program: Program) -> Array:
    """Return positions that end before the end of the turn, on both sides of knots."""
    end = np.nextafter(program.period, 0.0)
    return with_both_sides(np.append(theta[:-1], end), np.asarray(program.knots))


def _along(touch: WallTouch, x: Array) -> tuple[Plane, Array]:
    """Return points of contact at positions `x` (n,), nan where none is left, and pressure angles.

    Points are in mm in the frame of the cam, angles in rad.
    """
    wall, at = touch.wall, x + touch.across
    points = np.full(x.shape, complex(np.nan, np.nan))
    points[wall.touched(at)] = wall.places_at(at)[1]
    return points, wall.motion(at)["pressure"]


def scene(result: CamResult, places: int = PLACES) -> Scene:
    """Return cam and follower: the drawing of the cam, divided into rigid bodies.

    Parameters
    ----------
    result : CamResult
        The cam.
    places : int
        Steps of the driver.

    Returns
    -------
    Scene
        As designed, before clearance; without contact where the follower rests on a corner.
    """
    motion = result.cam.motions[0]
    driver, carrier = motion.carrier.driver, motion.carrier
    output: Any = result.design.output
    pose = output.pose if carrier.around else output.place
    theta = np.linspace(0.0, motion.program.period, places + 1)
    moving, drawn = (_pose(motion, at) for at in (theta, np.array([pose])))
    back = Pose(float(drawn.turn[0]), complex(drawn.shift[0])).inverse
    shown = result.drawing.features
    plates = [one for one in shown if one.kind not in (CENTER, FOLLOWER)]
    follower = MovingBody(
        name="follower",
        called="follower",
        features=tuple(one for one in shown if one.kind == FOLLOWER),
        pose=_carried(motion, theta, pose),
    )
    several = len(result.parts) > 1
    cams = [
        MovingBody(
            name=part.name,
            called=f"cam {number}" if several else "cam",
            features=place(
                [one for one in plates if not several or one.layer.startswith(part.name.upper())],
                back,
            ),
            pose=moving,
        )
        for number, part in enumerate(result.parts, start=1)
    ]
    fixed = still(tuple(one for one in shown if one.kind == CENTER), theta)
    return Scene(
        title=result.design.name,
        driver=driver.label,
        places=driver.scale * theta,
        closed=not result.program.open,
        start=driver.scale * (pose % (2.0 * math.pi) if carrier.around else pose),
        bodies=(*cams, follower, fixed),
        contacts=_contacts(result, theta, moving),
        coloured=coloured(result, theta),
    )


def _pose(motion: PitchMotion, theta: Array) -> Pose:
    """Return the pose of the cam at cam angles, rad."""
    carrier = motion.carrier
    return _mirrored(motion, Pose(carrier.rate * theta, carrier.frame(theta)[1]))


def _carried(motion: PitchMotion, theta: Array, pose: float) -> Pose:
    """Return the pose of a follower that is drawn at the cam angle `pose`, at cam angles, rad."""
    lift = motion.program.derivatives(theta, 0)[0] - float(motion.program.derivatives(pose, 0)[0])
    return _mirrored(motion, Pose(*motion.follower.moved(lift)))


def _mirrored(motion: PitchMotion, pose: Pose) -> Pose:
    """Return a pose, mirrored in the y-axis if the cam turns clockwise."""
    return Pose(-pose.turn, -np.conj(pose.shift)) if motion.clockwise else pose


def _contacts(result: CamResult, theta: Array, pose: Pose) -> dict[str, ContactPoints]:
    """Return points of contact on each wall, or on both sides of a cam in a yoke."""

    def found(wall: Wall, ahead: float = 0.0) -> ContactPoints:
        asked = theta + ahead
        left, points, normals = wall.places_at(asked)
        there = pose[np.searchsorted(asked, left)]
        return ContactPoints(
            start=np.searchsorted(left, np.append(asked, np.inf)),
            point=there.apply(points),
            force=normals * there.rotation,
        )

    if result.form.half_turns:  # the upper side touches a point half a turn after the lower side
        (profile,) = result.cam.walls
        return {"upper side": found(profile), "lower side": found(profile, math.pi)}
    return {wall.called: found(wall) for wall in result.cam.walls}
