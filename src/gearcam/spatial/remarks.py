"""What the checks of all cams in space say in the same words.

Depends on walls; numpy only.
"""

from __future__ import annotations

import math
from collections.abc import Iterator

from gearcam.base.findings import Remark
from gearcam.base.numerals import FEW, formatted, shortened
from gearcam.base.readable import readable
from gearcam.laws.program import Program
from gearcam.spatial.extremes import Spot
from gearcam.spatial.walls import RollerWall


def at(theta: float) -> str:
    """Return the cam angle `theta`, rad, as a place in words."""
    return f"at {formatted(math.degrees(theta), 5)} deg"


def smaller_roller(wall: RollerWall) -> str:
    """Return the sentence on the largest roller that does not undercut a `wall`, if there is one.

    It begins with a space.
    """
    most = wall.allowed_radius
    radius = shortened(most, -1.0) if most > 0.0 else 0.0
    return (
        f" A roller_radius_mm of up to {formatted(radius, FEW)} cuts nothing off."
        if radius > 0.0
        else ""
    )


def thin_rib(least: Spot, limit: float) -> Iterator[Remark]:
    """Yield the remark on a rib of the `least` thickness, mm, if this is below the `limit`, mm."""
    if least.value < limit:
        yield Remark(
            f"The rib is about {readable(least.value, 'mm', digits=3)} thick where it is steep.",
            f"rib, {least.place}",
            least.value,
        )


def shocks(program: Program, what: str) -> Iterator[Remark]:
    """Yield the remarks on jumps of the acceleration of a motion.

    Parameters
    ----------
    program : Program
        The motion.
    what : str
        What moves.
    """
    for jump in program.jumps:
        if jump.order == 2:
            told = f"{jump.small}." if jump.slight else f": the {what} vibrates at high speed."
            yield Remark(f"The acceleration jumps{told}", at(jump.theta))
