"""The volume of a cam: from cubics, from a mesh, and by subtracting rollers from a blank."""

from __future__ import annotations

from functools import cache
from itertools import pairwise
from typing import Any

import manifold3d
import mpmath
import numpy as np

import gearcam
from cam_profiles import DEGREES, KIND, LAW, LIFT
from gearcam.parts.solids import solid
from helpers_cams import witness_of
from methods import Case, Method
from witness.cam_sweep import Exact, Motion

mp: Any = mpmath.mp
WIDTH = 12.0
TOLERANCES = (1e-2, 1e-3, 1e-4, 1e-5)
_PHASES = ("rise", "dwell", "return", "dwell")


@cache
def _design(tolerance: float) -> Any:
    follower = witness_of(KIND)
    motion = [
        {"type": name, "angle_deg": angle} for name, angle in zip(_PHASES, DEGREES, strict=True)
    ]
    motion[0] |= {"law": LAW, "lift_mm": LIFT}
    motion[2] |= {"law": LAW}
    return gearcam.design(
        {
            "kind": "cam",
            "name": "solid",
            "motion": motion,
            "follower": {
                "type": "roller",
                "motion": "translating",
                "roller_radius_mm": follower.radius,
                "offset_mm": follower.offset,
            },
            "cam": {"form": "disc", "prime_radius_mm": follower.size, "thickness_mm": WIDTH},
            "output": {"files": ["stl"], "chord_tolerance_mm": tolerance},
        }
    )


def _truth() -> float:
    """Return the volume, mm3, from area and length of the pitch curve by Steiner's formula."""
    with mp.workdps(30):
        exact = Exact(witness_of(KIND), Motion(LAW, LIFT, DEGREES))
        knots = [mp.radians(mp.mpf(one)) for one in np.cumsum([0.0, *DEGREES])]
        area, length = mp.mpf(0), mp.mpf(0)
        for ends in pairwise(knots):
            area -= (
                mp.quad(lambda t: (mp.conj(exact.pitch(t)) * mp.diff(exact.pitch, t)).imag, ends)
                / 2
            )
            length += mp.quad(lambda t: abs(mp.diff(exact.pitch, t)), ends)
        radius = mp.mpf(exact.follower.radius)
        return float(WIDTH * (area - radius * length + mp.pi * radius**2))


def volume() -> Case:
    """Return the case of the volume of a plate cam."""
    truth = _truth()
    follower, motion = witness_of(KIND), Motion(LAW, LIFT, DEGREES)
    blank = follower.size + LIFT + 5.0

    def chords(tolerance: float) -> float:
        return solid(gearcam.build(_design(tolerance)).parts[0]).volume

    def cubics(tolerance: float) -> float:
        return WIDTH * gearcam.build(_design(tolerance)).parts[0].contour.moments.area

    def boolean(count: float) -> float:
        theta = np.arange(count) * (2.0 * np.pi / count)
        position = float(follower.start(mp)) + motion(theta, np)
        centres = follower.centre(position, np) * np.exp(-1j * theta)
        sides = int(4 * count)
        roller = manifold3d.Manifold.cylinder(WIDTH + 2.0, follower.radius, -1.0, sides)
        cutters = [roller.translate((z.real, z.imag, -1.0)) for z in centres]
        left = manifold3d.Manifold.cylinder(WIDTH, blank, -1.0, sides)
        parts = manifold3d.Manifold.batch_boolean([left, *cutters], manifold3d.OpType.Subtract)
        return max(part.volume() for part in parts.decompose())  # without the ring and scraps

    name, level = "profile", "chord tolerance, mm"
    return Case(
        name="solid_volume",
        title="Volume of a solid",
        what="the volume",
        unit="mm3",
        methods=[
            Method(f"{name}, cubics times the width", level, TOLERANCES, cubics),
            Method(f"{name}, extruded mesh", level, TOLERANCES, chords, -1.0),
            Method("boolean sweep of solids", "cam angles", (32, 48, 64, 96), boolean, 2.0),
        ],
        own=name,
        error=lambda found: abs(found - truth),
        rounding=1e-9,
        note=f"The cam above, {WIDTH:g} mm wide, built from the design, against quadrature in 30 "
        "digits. Volume and mass in summaries come from cubics, STL files contain meshes. The "
        "rollers of the sweep are prisms with four sides per cam angle.",
    )


def cases() -> list[Case]:
    """Return all cases."""
    return [volume()]
