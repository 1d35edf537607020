"""A design whose motion is a measured profile: the lift of its follower on it."""

from __future__ import annotations

import math
from typing import TYPE_CHECKING, Any, Final

import numpy as np

from gearcam.base.errors import beyond_limit
from gearcam.base.facts import Fact, Tree
from gearcam.base.numerals import FEW, formatted
from gearcam.cams.caliper import caliper
from gearcam.cams.measured import MeasuredProfile, demand_reached
from gearcam.cams.placing import make_follower
from gearcam.laws.columns import degrees

if TYPE_CHECKING:
    from gearcam.base.tolerances import Tolerances
    from gearcam.cams.wall import Wall
    from gearcam.laws.columns import Given
    from gearcam.laws.program import Program

_ENDS: Final = {"roller": "follower.roller_radius_mm", "domed": "follower.dome_radius_mm"}
"""Keys of the radius of a round end, by its type."""

_AGREES: Final = 0.1
"""Largest distance of the circle of a design from that of the profile, mm, which the lift takes up:
a caliper is not further off."""


def measured_lift(design: Any, tolerances: Tolerances) -> Program:
    """Return the lift of the follower of a design on the profile that its motion gives.

    Parameters
    ----------
    design : CamDesign
        With a motion of radii.
    tolerances : Tolerances
        Internal accuracy.

    Raises
    ------
    InfeasibleError
        If the follower does not reach the profile, or the circle of the design is not its own.
    """
    motion, cam, given = design.motion, design.cam, design.motion.given(oscillating=False)
    tolerance = motion.radius_tolerance or 0.0
    profile = MeasuredProfile(
        curve=motion.program(tolerances),
        count=len(given.x),
        follower=make_follower(design.follower, cam),
        clockwise=cam.clockwise,
    )

    def place(angle: float) -> str:
        turns = (given.x - angle + math.pi) % (2.0 * math.pi) - math.pi
        row = int(np.argmin(np.abs(turns)))
        return f"line {given.lines[row]}, at {degrees(float(given.x[row]))}"

    demand_reached(profile, place, _ENDS.get(design.follower.type, ""), tolerance)
    name = "base_radius" if cam.prime_radius is None else "prime_radius"
    inside = profile.follower.radius if cam.prime_radius is None else 0.0
    value, own = getattr(cam, name), profile.circle - inside
    if abs(value - own) > max(_AGREES, tolerance):
        least = int(np.argmin(given.y))
        what, line = "the measured profile has another size", given.lines[least]
        note = f"the limit is its own: its least radius, in line {line}, is "
        note += (
            f"{formatted(float(given.y[least]))} mm; for another size give the lift of motion.csv"
        )
        raise beyond_limit(what, f"cam.{name}_mm", value, own, note, near=round(own, 2))
    return profile.standing(tolerance)


def measured_facts(given: Given, wall: Wall) -> Tree:
    """Return how far a wall is from the radii that were `given`."""
    off = caliper(wall, given.x) - given.y
    worst = int(np.argmax(np.abs(off)))
    place = f"at {formatted(math.degrees(given.x[worst]), FEW, scale=360.0)} deg"
    return {
        "radii": len(given.x),
        "largest_mm": Fact(
            float(off[worst]), "largest distance from the measured radii", place=place, shown=True
        ),
        "rms_mm": Fact(float(np.sqrt(np.mean(off**2))), "the same, rms", shown=True),
    }
