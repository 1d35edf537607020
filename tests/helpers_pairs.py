"""Pairs built through the public way, assembled in the plane, and made wrong on purpose."""

from __future__ import annotations

import math
from collections.abc import Sequence
from dataclasses import replace
from functools import cache
from typing import Any

import numpy as np
import shapely

import gearcam
from arch import rules
from gearcam.gears.contact import DRIVE, FlankPairs
from gearcam.gears.pair import Gear
from gearcam.gears.spec import PairSpec, Rack, RingSpec
from gearcam.gears.track import Wheel
from gearcam.kinds.gear_pair.design import GearPairDesign, PairOutputSpec
from gearcam.kinds.gear_pair.result import GearPairResult
from gearcam.meshing import assembly as errors_of
from gearcam.meshing.errors import Running, Runs
from gearcam.meshing.study import Setup
from gearcam.numeric.arrays import Array
from gearcam.parts.blank import Blank
from helpers_built import built

PROFILES = rules.ROOT / "profiles"

OVERCLOSURE = math.radians(0.005)
"""By which a driver is turned too far, so that flanks in contact overlap."""


def job(
    law: Any,
    teeth: tuple[int, int],
    *,
    module: float | None = None,
    distance: float | None = None,
    tolerance: float | None = None,
    rack: Rack | None = None,
    bores: tuple[float, float] | None = None,
    limits: dict[str, float] | None = None,
    files: tuple[str, ...] = ("csv",),
    x: float = 0.0,
    backlash: float = 0.0,
    internal: bool = False,
    ring: RingSpec | None = None,
) -> GearPairResult:
    """Return the shared result of a design made in Python; lengths in mm, limits in inner units."""
    if module is None and distance is None:
        module = 1.0
    return built(
        GearPairDesign(
            name="sample",
            law=law,
            pair=PairSpec(
                type="internal" if internal else "external",
                center_distance=distance,
                module=module,
                teeth=teeth,
                x=x,
                backlash=backlash,
            ),
            ring=ring or RingSpec(),
            rack=rack or Rack(),
            blank=Blank(bore_diameter=bores),
            limits=limits or {},
            output=PairOutputSpec(files=files, chord_tolerance=tolerance),
        )
    )


@cache
def profile(name: str, tolerance: float | None = None) -> GearPairResult:
    """Return the shared result of a file in ``profiles/``, at another tolerance if one is given."""
    design = gearcam.load(PROFILES / f"{name}.toml")
    assert isinstance(design, GearPairDesign)
    if tolerance is None:
        return built(design)
    return job(
        design.law,
        design.pair.teeth,
        module=design.pair.module,
        distance=design.pair.center_distance,
        tolerance=tolerance,
        rack=design.rack,
    )


def explained(made: GearPairResult) -> float:
    """Overlap that two chord errors explain: a lens of that depth on each of four flank pairs.

    A lens of depth d between flanks of relative curvature k has the area (4/3)*d*sqrt(2*d/k);
    flanks are no flatter than a circle of the centre distance.
    """
    depth = made.gear1.profile.tolerance + made.gear2.profile.tolerance
    return 4 * (4 / 3) * depth * math.sqrt(2 * depth * made.pair.center_distance)


class Assembly:
    """Two outlines on their shafts, turned to any phase and clipped to the zone of mesh."""

    def __init__(self, made: GearPairResult, outlines: tuple[np.ndarray, np.ndarray] | None = None):
        self.law = made.law
        self.distance = made.pair.center_distance
        first, second = outlines or (made.gear1.outline, made.gear2.outline)
        self.one, self.two = first @ [1, 1j], second @ [1, 1j]
        self.reach = 4.0 * made.pair.module
        self.rolling = made.pair.rolling

    def at(self, phi: float, lead: float = 0.0) -> tuple[Any, Any]:
        """Both wheels near the pitch point at phi1 = `phi`, the driven one ahead by `lead`."""
        pitch = float(abs(self.rolling.tracks[0].frames(np.array([phi])).p[0]))
        zone = (pitch - self.reach, -4 * self.reach, pitch + self.reach, 4 * self.reach)
        turned = (
            self.one * np.exp(-1j * phi),
            self.two * np.exp(1j * (float(self.law.phi2(phi)) + lead)) + self.distance,
        )
        polygons = [shapely.Polygon(np.stack([z.real, z.imag], axis=1)) for z in turned]
        return shapely.clip_by_rect(polygons[0], *zone), shapely.clip_by_rect(polygons[1], *zone)

    def overlap(self, phi: float, lead: float = 0.0) -> float:
        """Area that both wheels cover, mm^2."""
        return float(shapely.intersection(*self.at(phi, lead)).area)


PHASES = np.arange(0.0, 360.0, 1.0) * math.pi / 180.0


def shifted(pairs: FlankPairs, tooth: int, by: float, wheel: Wheel = 1) -> FlankPairs:
    """The pairs with both flanks of a tooth of a closed wheel moved along its pitch curve."""
    wheels = list(pairs.wheels)
    flanks, teeth = wheels[wheel - 1].flanks, wheels[wheel - 1].toothing.teeth
    sf = flanks.sf.copy()
    sf[[tooth - 1, teeth + tooth - 1]] += by
    wheels[wheel - 1] = replace(wheels[wheel - 1], flanks=replace(flanks, sf=sf))
    return replace(pairs, wheels=(wheels[0], wheels[1]))


def moved(setup: Setup, tooth: int, by: float, wheel: Wheel = 1) -> Setup:
    """The pair with a tooth of a closed wheel moved along its pitch curve, outline and flanks."""
    turning, toothing = setup.turning, setup.pairs[DRIVE].wheels[wheel - 1].toothing
    halves = turning.driver if wheel == 1 else turning.driven
    place = toothing.track.angle(toothing.tooth_places[tooth - 1 : tooth])
    angle = by / float(np.abs(toothing.frames(place).p[0]))
    points = halves.points.copy()
    for half in np.flatnonzero(halves.teeth == tooth):
        own = slice(halves.starts[half], halves.starts[half + 1])
        points[own] *= np.exp(-1j * angle if toothing.track.clockwise else 1j * angle)
    pairs = {side: shifted(each, tooth, by, wheel) for side, each in setup.pairs.items()}
    made = replace(
        turning, **{"driver" if wheel == 1 else "driven": replace(halves, points=points)}
    )
    return replace(setup, pairs=pairs, turning=made)


@cache
def dense_flank(gear: Gear, tooth: int, sigma: int, points: int = 6001) -> np.ndarray:
    """Points of a flank, root first, as complex numbers in the wheel's frame."""
    flanks, toothing = gear.profile.flanks, gear.toothing
    number = tooth - 1 + (0 if sigma > 0 else toothing.teeth)
    reach = np.linspace(flanks.lowest[number], flanks.highest[number], points)
    sf = flanks.sf[number]
    frames = toothing.frames(toothing.track.angle(sf - sigma * reach))
    return toothing.flank_points(frames, np.full(points, sf), np.full(points, float(sigma)))


def dense_touch(
    made: GearPairResult, side: int, phi1: float, phi2: float, distance: complex, *, internal: bool
) -> float:
    """The driven wheel's turn at first touch, by dense points of all flanks near the pitch point.

    Seen from the driven shaft; a ring turns as its wheel does, which is clockwise.
    """
    z, hand = made.pair.teeth, 1 if internal else -1
    near = round(float(made.pair.rolling.tracks[0].arc_length(phi1)) / made.gear1.toothing.pitch)
    ahead = []
    for j in range(near - 2, near + 3):
        k = j if side > 0 else j - 1
        one = dense_flank(made.gear1, j % z[0] + 1, side) * np.exp(-1j * phi1) + hand * distance
        two = dense_flank(made.gear2, k % z[1] + 1, -side) * np.exp(-1j * hand * phi2)
        order = np.argsort(np.abs(two))
        radius = np.abs(two)[order]
        inside = (np.abs(one) >= radius[0]) & (np.abs(one) <= radius[-1])
        if np.count_nonzero(inside) < 3:
            continue
        # angles about the middle of the mate, far from the cut of the angle
        middle = np.exp(-1j * np.angle(two.mean()))
        mate = np.interp(np.abs(one)[inside], radius, np.angle(two * middle)[order])
        turn = np.angle(one[inside] * middle) - mate
        ahead.append((hand * side * turn).max())
    return -side * max(ahead)


def run(
    steps: Sequence[errors_of.Gears], width: float, assembly: errors_of.Assembly, phi1: Array
) -> Running:
    """Return how one assembly of wheels, of stepped ones those of each step, runs."""
    return Runs(steps=steps, width=width, phi1=phi1).of(assembly)
