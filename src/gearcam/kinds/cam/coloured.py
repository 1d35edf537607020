"""What the profiles of a cam are coloured by in the moving picture: values along them."""

from __future__ import annotations

from typing import TYPE_CHECKING, Final

import numpy as np

from gearcam.numeric.arrays import Array
from gearcam.numeric.piecewise import with_both_sides
from gearcam.pictures.scenes import ColouredCurve

if TYPE_CHECKING:
    from gearcam.cams.statics import Touch
    from gearcam.kinds.cam.build import CamResult
    from gearcam.laws.program import Program
    from gearcam.numeric.arrays import Plane

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
        from gearcam.kinds.cam.forces import COLOURS, TITLES

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


def _along(touch: Touch, x: Array) -> tuple[Plane, Array]:
    """Return points of contact at positions `x` (n,), nan where none is left, and pressure angles.

    Points are in mm in the frame of the cam, angles in rad.
    """
    wall, at = touch.wall, x + touch.across
    points = np.full(x.shape, complex(np.nan, np.nan))
    points[wall.touched(at)] = wall.places_at(at)[1]
    return points, wall.motion(at)["pressure"]
