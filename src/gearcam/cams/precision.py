"""The precision of a cam mechanism: how errors of its sizes move the follower.

A cam is made for a follower, and then runs with sizes that differ a little. It keeps touching:
along the outward normal n of the metal at the point of contact, cam and follower move by the same
amount. With ``g = n . dX/dp``, X being the follower's surface there and p its position, an error of
a size q moves the follower by

    dp/dq = -(n . dX/dq)/g,

an error of the profile, metal in excess along the normal, by ``1/g``, and an error of the cam's
angle by ``s'``. For a round follower ``g = lever*cos(alpha)``: errors grow with the pressure angle.
Which point touches does not matter to first order, so that curvature is not in it; what is left is
of second order in the errors.

The lift is that in the fixed frame, not set to zero again after assembly. For a cam with several
walls the follower rests on one of them; sizes between its two rollers move it on the second wall.
Where a profile is trimmed, it rests on a corner: nothing is said there.

Combined, errors of several sizes move it at most by the sum of their absolute deviations, the worst
case; the root of the sum of squares is what independent errors rarely exceed.

Sources: 000 section 3.6, (3.119); derived anew, as its sensitivities are not those of a contact.

Depends on cam, wall and measures; numpy only.
"""

from __future__ import annotations

from collections.abc import Callable, Mapping
from typing import Final, NamedTuple

import numpy as np

from gearcam.cams.cam import Cam
from gearcam.cams.measures import Extreme
from gearcam.cams.wall import Wall
from gearcam.numeric.arrays import Array, distinct
from gearcam.numeric.piecewise import with_both_sides

Function = Callable[[dict[str, Array]], Array]
"""Of sensitivities (n,) by size; nan where it is not known."""

_AT_ONCE: Final = 33
"""Angles between two neighbours of a largest value, of which the best has the next neighbours."""

_ZOOMS: Final = 6
"""How often: from a degree to below 1e-7 deg. The value is exact to the square of that."""

_PLACES: Final = 720
"""Angles of a turn among which a largest value is sought first."""


def sensitivities(wall: Wall, linked: Mapping[str, float], theta: Array) -> dict[str, Array]:
    """Return how errors move a follower that rests on a wall.

    Parameters
    ----------
    wall : Wall
        The wall.
    linked : mapping of str to float
        Position per unit of what links the wall's follower to the first (see `Cam.linked`).
    theta : (n,) array, rad or mm
        Cam angles, or travels; at a knot the values after it count.

    Returns
    -------
    dict of str to (n,) array
        By size, mm or rad: ``profile``, of metal in excess; ``cam_angle``, or ``travel``, of the
        cam on its shaft or slide; those of the follower. nan where trimming leaves no point of
        contact.
    """
    s, ds = wall.program.derivatives(theta, 1)
    position = wall.follower.start + s
    points, tangents = wall.curve.trace(theta, s, ds)
    turn, shift = wall.carrier.frame(theta)
    normals = wall.side * 1j * tangents * turn
    by_position, by_size = wall.follower.along_normal(position, points * turn + shift, normals)
    touched = np.where(wall.on_edge(theta), np.nan, 1.0)
    with np.errstate(divide="ignore", invalid="ignore"):
        moved = {"profile": 1.0 / by_position} | {
            name: -value / by_position for name, value in by_size.items()
        }
    driver = wall.carrier.driver.called.replace(" ", "_")
    moved |= {driver: ds} | {name: np.full_like(ds, value) for name, value in linked.items()}
    return {name: touched * value + 0.0 for name, value in moved.items()}


def added(values: Mapping[str, Array], errors: Mapping[str, float]) -> Array:
    """Return the deviation in the worst case: the sum of the absolute values of all.

    Parameters
    ----------
    values : mapping of str to (n,) array
        Sensitivities by size.
    errors : mapping of str to float
        Errors of some of them, mm or rad.

    Returns
    -------
    (n,) array, mm or rad
    """
    return sum(
        (np.abs(values[name]) * error for name, error in errors.items()), start=_zero(values)
    )


def rooted(values: Mapping[str, Array], errors: Mapping[str, float]) -> Array:
    """Return the root of the sum of squares of all deviations.

    Parameters
    ----------
    values, errors
        See `added`.

    Returns
    -------
    (n,) array, mm or rad
    """
    squares = ((values[name] * error) ** 2 for name, error in errors.items())
    return np.sqrt(sum(squares, start=_zero(values)))


def _zero(values: Mapping[str, Array]) -> Array:
    return 0.0 * next(iter(values.values()))


COMBINED: Final = {"worst-case": added, "root-of-squares": rooted}
"""How deviations by several sizes are combined."""


class Largest(NamedTuple):
    """The largest absolute value of a function over the cycle of a cam, and where."""

    wall: Wall
    extreme: Extreme

    @property
    def value(self) -> float:
        """The value."""
        return self.extreme.value

    @property
    def place(self) -> str:
        """The place as text."""
        at = self.wall.carrier.driver.place(self.extreme.theta)
        return f"{at}, {self.wall.called}" if self.wall.key else at


def largest(cam: Cam, function: Function) -> Largest | None:
    """Return the largest absolute value of a function of the sensitivities over the cycle.

    Parameters
    ----------
    cam : Cam
        The cam, all walls of which are looked at.
    function : callable
        ``function(values)`` of `sensitivities`.

    Returns
    -------
    Largest or None
        None if it is known nowhere.
    """
    found = [
        Largest(wall, extreme)
        for wall in cam.walls
        for extreme in [_largest(wall, cam.linked(wall), function)]
        if extreme is not None
    ]
    return max(found, key=lambda one: one.value, default=None)


def _largest(wall: Wall, linked: Mapping[str, float], function: Function) -> Extreme | None:
    program = wall.program
    even = np.linspace(0.0, program.period, _PLACES + 1)
    x, found = with_both_sides(even, np.asarray(program.cuts)), None
    x[-1] = np.nextafter(program.period, 0.0)
    for _ in range(1 + _ZOOMS):
        values = np.abs(function(sensitivities(wall, linked, x)))
        known = np.where(np.isfinite(values), values, -1.0)
        best = int(known.argmax())
        if known[best] < 0.0:
            return None
        found = Extreme(theta=float(x[best]), value=float(known[best]))
        low, high = x[max(best - 1, 0)], x[min(best + 1, len(x) - 1)]
        x = distinct(np.linspace(low, high, _AT_ONCE), x[best : best + 1])
    return found


class LiftError(NamedTuple):
    """What the check looks at: the largest deviation with all tolerances, and the wanted one."""

    found: Largest
    wanted: float
    combined: str
