"""A design whose motion is a measured profile: the lift of its follower on it."""

from __future__ import annotations

import math
from collections.abc import Iterator, Mapping, Sequence
from typing import TYPE_CHECKING, Any, Final

import numpy as np

from gearcam.base.errors import beyond_limit
from gearcam.base.facts import Fact, Tree
from gearcam.base.numerals import FEW, formatted
from gearcam.cams.measured import MeasuredProfile, demand_reached
from gearcam.cams.placing import make_follower
from gearcam.designs.faults import Fault
from gearcam.laws.columns import degrees

if TYPE_CHECKING:
    from gearcam.base.tolerances import Tolerances
    from gearcam.designs.kind import Examined
    from gearcam.kinds.cam.result import CamResult
    from gearcam.laws.program import Program

_FORMS: Final = ("disc", "conjugate")
"""Forms of cams whose first profile may have been measured."""

_AGREES: Final = 0.1
"""Largest distance of the circle of a design from that of the profile, mm, which the lift takes up:
a caliper is not further off."""


def measured_faults(found: Examined, document: Mapping[str, Any], form: str) -> Iterator[Fault]:
    """Yield what a measured profile does not go with.

    Parameters
    ----------
    found : Examined
        The valid tables.
    document : mapping
        All tables as in the file.
    form : str
        The form of the cam.
    """
    motion = found.parts.get("motion")
    if not getattr(motion, "of_radii", False):
        return
    drive = document.get("drive")
    asked = [
        (title, key)
        for title in ("cam", "follower")
        if isinstance(table := document.get(title), Mapping)
        for key, value in table.items()
        if value == "solve"
    ]
    if form not in _FORMS:
        allowed = f"""kind = "cam" with cam.form = {" or ".join(f'"{one}"' for one in _FORMS)}"""
        message = f"gives the radii of a profile, which a {form} cam does not have"
        yield Fault(("motion", "file"), message, getattr(motion, "file", None), allowed)
    for where in asked:
        yield Fault(where, "the measured profile gives it", "solve", "a length")
    if isinstance(drive, Mapping) and drive.get("polydyne") is True:
        message = "would change the measured profile"
        yield Fault(("drive", "polydyne"), message, True, "leave it out")


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

    kind = design.follower.type
    key = (
        f"follower.{kind.replace('domed', 'dome')}_radius_mm" if kind in ("roller", "domed") else ""
    )
    demand_reached(profile, place, key, tolerance)
    name = "base_radius" if cam.prime_radius is None else "prime_radius"
    inside = profile.follower.radius if cam.prime_radius is None else 0.0
    value, own = getattr(cam, name), profile.circle - inside
    if abs(value - own) > max(_AGREES, tolerance):
        least = int(np.argmin(given.y))
        what = "the measured profile has another size"
        note = (
            f"the limit is its own, the least radius is {formatted(float(given.y[least]))} mm in "
        )
        note += f"line {given.lines[least]}; for a cam of another size take the lift of motion.csv"
        raise beyond_limit(what, f"cam.{name}_mm", value, own, note, near=round(own, 2))
    return profile.standing(tolerance)


def measured_facts(result: CamResult) -> Tree | None:
    """Return how far the finished profile is from the radii that were measured."""
    motion: Any = result.design.motion
    if isinstance(motion, Sequence) or not getattr(motion, "of_radii", False):
        return None
    from gearcam.cams.caliper import caliper

    given = motion.given(oscillating=False)
    off = caliper(result.cam.walls[0], given.x) - given.y
    worst = int(np.argmax(np.abs(off)))
    place = f"at {formatted(math.degrees(given.x[worst]), FEW, scale=360.0)} deg"
    return {
        "radii": len(given.x),
        "largest_mm": Fact(
            float(off[worst]), "largest distance from the measured radii", place=place, shown=True
        ),
        "rms_mm": Fact(float(np.sqrt(np.mean(off**2))), "the same, rms", shown=True),
    }
