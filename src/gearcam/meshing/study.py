"""The meshing study: exact contact, first contact and stepwise overlap, by phases.

At each phase the driven wheel is first turned until it touches, as in a machine: this takes up the
backlash. Then the driver is turned ahead by a small angle, and the outlines are intersected. The
exact flanks predict which pairs must overlap, by how much, and how far the driven wheel could turn.
The outlines are computed anew, so finely that the chord errors of both add up to at most a
hundredth of the penetration. An interrupted study keeps the phases done.
"""

from __future__ import annotations

import math
from collections.abc import Callable
from dataclasses import dataclass, field, replace
from functools import cached_property
from typing import Any

import numpy as np

from gearcam.base.errors import ABOVE, InfeasibleError, beyond_limit
from gearcam.base.numerals import formatted
from gearcam.gears.contact import COAST, DRIVE, FlankPairs, Mounting, flank_pairs
from gearcam.gears.outline import Outline
from gearcam.gears.pair import FINEST, Gear, GearPair
from gearcam.meshing.assembly import Assembly, demand
from gearcam.meshing.contact import contacts
from gearcam.meshing.edges import first_touch, to_pitch_line
from gearcam.meshing.errors import first_of
from gearcam.meshing.half_teeth import half_teeth
from gearcam.meshing.overlap import Overlaps, Turning
from gearcam.meshing.patches import patches
from gearcam.meshing.rows import Block, columns_of, on_side
from gearcam.meshing.settings import MeshingSpec
from gearcam.meshing.solids import Bodies, PrismMaker, bodies
from gearcam.numeric.arrays import Array, Mask

Progress = Callable[[str, int, int], None]

SHARE = 1.0 / 200.0
"""Chord error of each outline over the penetration: a hundredth for both together."""

_MOST = 1e7
"""Largest number of chords of a studied outline: more half-teeth would not fit into memory."""

BLOCK = 120
"""Phases studied at once: few enough to report progress, many enough to be fast."""

DEEPER = 1.6
"""Depth of overlap, over that explained by the overclosure, above which flanks interfere.

Depths are computed for patches that end in points: for a strip as long as its flanks, as between
closely fitting flanks in a ring, the result is 1.5 times the true depth."""

_BESIDE = 0.15
"""Range studied with `teeth`, before and after the teeth's arcs of contact, in pitches."""

_STOP = 1e-7
"""Share of the travel by which given degrees may pass a stop: rounding."""


@dataclass(frozen=True, eq=False, kw_only=True)
class Condition:
    """The errors of a pair, and how to make its solids.

    Parameters
    ----------
    errors : Assembly
        Its errors.
    prisms : callable or None
        Makes prisms; None without solids.
    low, high : float, mm
        Heights over the middle of the face width between which the teeth extend.
    """

    errors: Assembly = field(default_factory=Assembly)
    prisms: PrismMaker | None = None
    low: float = 0.0
    high: float = 0.0

    def bodies(self, turning: Turning) -> Bodies | None:
        """Return the solids of mounted wheels, if asked for."""
        if self.prisms is None:
            return None
        lean = self.errors.lean(turning.distance.real)
        return bodies(turning, self.prisms, lean, self.low, self.high)


AS_DESIGNED = Condition()
"""Without errors and solids."""


@dataclass(frozen=True, eq=False, kw_only=True)
class Setup:
    """A pair as mounted for a study.

    Parameters
    ----------
    spec : MeshingSpec
        Settings.
    pairs : mapping of int to FlankPairs
        Both sides; on tilted axes in the middle of the face width.
    turning : Turning
        The outlines.
    side : {-1, +1}
        The side pressed together by the overclosure.
    stretch : (float, float), rad
        First and last driver angle of the study.
    penetration : float, mm
        Smallest penetration of a full contact: overclosure times lever arm.
    lever : float, mm
        Largest lever arm of the driver.
    faces : mapping of int to list of FlankPairs
        Both sides in both faces of wheels on tilted axes, which touch first there; else empty.
    bodies : Bodies or None
        The solids, if asked for.
    """

    spec: MeshingSpec
    pairs: dict[int, FlankPairs]
    turning: Turning
    side: int
    stretch: tuple[float, float]
    penetration: float
    lever: float
    faces: dict[int, list[FlankPairs]] = field(default_factory=dict)
    bodies: Bodies | None = None

    @property
    def noise(self) -> float:
        """Depth of overlap that chord errors alone may cause, mm."""
        return 1.5 * (self.turning.driver.chord_error + self.turning.driven.chord_error)


@dataclass(frozen=True, eq=False, kw_only=True)
class Meshing:
    """A finished or interrupted study.

    Parameters
    ----------
    setup : Setup
        The pair as mounted.
    phi1 : (n,) array, rad
        The phases done.
    asked : int
        Number of phases asked for.
    blocks : list of Block
        Results, block by block.
    """

    setup: Setup
    phi1: Array
    asked: int
    blocks: list[Block] = field(default_factory=list)

    @property
    def sides(self) -> tuple[FlankPairs, FlankPairs]:
        """Pairs of flanks of the coast and driving side."""
        return self.setup.pairs[COAST], self.setup.pairs[DRIVE]

    @property
    def complete(self) -> bool:
        """Whether every phase was studied."""
        return len(self.phi1) == self.asked

    @cached_property
    def columns(self) -> dict[str, Any]:
        """Rows of ``meshing.csv``: one per phase and pair of half-teeth that touch or should."""
        return columns_of(self.blocks, self.setup.turning, self.setup.side)

    @property
    def on_side(self) -> Mask:
        """Mask of the rows of facing half-teeth of the side pressed together."""
        rows = self.columns
        return (rows["facing"].data > 0.0) & (rows["side"].data == self.setup.side)

    def every(self, name: str) -> Array:
        """Return the field `name` of all blocks, concatenated."""
        if not self.blocks:
            return np.empty(0)
        return np.concatenate([getattr(block, name) for block in self.blocks])


def study(
    gears: tuple[Gear, Gear],
    spec: MeshingSpec,
    progress: Progress | None = None,
    designed: tuple[FlankPairs, ...] = (),
    condition: Condition = AS_DESIGNED,
) -> Meshing:
    """Return the meshing study of a pair.

    Parameters
    ----------
    gears : (Gear, Gear)
        The wheels.
    spec : MeshingSpec
        Settings.
    progress : callable, optional
        Called with ``"meshing"``, the phases done and their number.
    designed : tuple of FlankPairs
        Both sides of the pair as designed, if already computed.
    condition : Condition
        Errors and solids.

    Returns
    -------
    Meshing
        The phases done, if interrupted.

    Raises
    ------
    InfeasibleError
        If the wheels do not reach each other, or the overclosure is too small to be resolved.
    """
    return run(mount(gears, spec, designed, condition), progress)


def run(setup: Setup, progress: Progress | None = None) -> Meshing:
    """Return the study of a pair as mounted (see `study`)."""
    phi1 = phases(setup.spec, setup.pairs[setup.side])
    blocks: list[Block] = []
    try:
        for start in range(0, len(phi1), BLOCK):
            if progress is not None:
                progress("meshing", start, len(phi1))
            blocks.append(_block(setup, phi1[start : start + BLOCK], start))
    except KeyboardInterrupt:
        pass
    done = sum(len(block.phi1) for block in blocks)
    return Meshing(setup=setup, phi1=phi1[:done], asked=len(phi1), blocks=blocks)


def mount(
    gears: tuple[Gear, Gear],
    spec: MeshingSpec,
    designed: tuple[FlankPairs, ...] = (),
    condition: Condition = AS_DESIGNED,
) -> Setup:
    """Return a mounted pair, with outlines as fine as the overclosure needs.

    Parameters
    ----------
    gears : (Gear, Gear)
        The wheels.
    spec : MeshingSpec
        Settings.
    designed : tuple of FlankPairs
        Both sides of the pair as designed, if already computed.
    condition : Condition
        Errors and solids.

    Returns
    -------
    Setup

    Raises
    ------
    InfeasibleError
        If the wheels do not reach each other, or the overclosure is too small to be resolved.
    """
    pair = gears[0].pair
    middle, *faces = _mountings(gears, spec, condition)
    pairs = {
        one.side: one
        for one in designed
        if condition.errors.none and one.distance == middle.distance
    }
    pairs = pairs or {side: flank_pairs(gears, side, middle) for side in (DRIVE, COAST)}
    side = DRIVE if spec.overclosure > 0.0 else COAST
    grid = np.linspace(0.0, pairs[side].travel, 20 * len(pairs[side].numbers))
    levers = contacts(pairs[side], grid).lever[0]
    if not levers.size:
        levers = np.abs(pair.rolling.tracks[0].frames(np.zeros(1)).p.real)
    penetration = abs(spec.overclosure) * float(levers.min())
    both = [
        half_teeth(outline).moved(outline.toothing, errors, offset)
        for outline, errors, offset in zip(
            _outlines(gears, spec, penetration), middle.pitch, middle.eccentric, strict=True
        )
    ]
    for gear, wheel in zip(gears, both, strict=True):
        if not wheel.sound:
            what = "the teeth are too few and too deep to be divided into half-teeth"
            note = "use more teeth or a smaller x; build and check do accept such wheels"
            raise InfeasibleError(
                what, where=f"wheel {gear.wheel}", value=float(gear.toothing.teeth), nearest=note
            )
    turning = Turning(
        rolling=pair.rolling,
        driver=both[0],
        driven=both[1],
        distance=middle.distance,
        moved=gears[0].toothing.moved,
    )
    return Setup(
        spec=spec,
        pairs=pairs,
        turning=turning,
        side=side,
        stretch=stretch(spec, pairs[side]),
        penetration=penetration,
        lever=float(levers.max()),
        faces={side: [flank_pairs(gears, side, face) for face in faces] for side in pairs if faces},
        bodies=condition.bodies(turning),
    )


def _mountings(gears: tuple[Gear, Gear], spec: MeshingSpec, condition: Condition) -> list[Mounting]:
    """Return how the pair is mounted in the middle of its width; if tilted also at both faces."""
    demand(gears, condition.errors)
    pair = gears[0].pair
    distance, depth = _distance(pair, spec), 2.0 * pair.rack.addendum * pair.module
    mountings = [condition.errors.mounting(distance)]
    if condition.errors.tilt:
        mountings += condition.errors.mountings(distance, condition.low, condition.high)
    apart = max(abs(abs(one.distance) - abs(distance)) for one in mountings)
    if not pair.on_rack and apart >= depth:
        where = "errors.tilt_deg" if condition.errors.tilt else "errors.center_mm"
        what = f"with this error the teeth are up to {formatted(apart, 3)} mm out of mesh"
        note = f"the teeth reach {formatted(depth, 3)} mm into each other"
        raise InfeasibleError(what, where=where, nearest=note)
    return mountings


def stretch(spec: MeshingSpec, pairs: FlankPairs) -> tuple[float, float]:
    """Return the first and last driver angle of a study, rad.

    Parameters
    ----------
    spec : MeshingSpec
        Settings.
    pairs : FlankPairs
        Either side.

    Returns
    -------
    start, end : float, rad
    """
    if spec.end is not None:
        return spec.start, spec.end
    if pairs.closed:
        return spec.start, spec.start + pairs.travel / pairs.turns
    return spec.start, pairs.travel


def phases(spec: MeshingSpec, pairs: FlankPairs) -> Array:
    """Return the phases of a study, rad.

    Parameters
    ----------
    spec : MeshingSpec
        Settings.
    pairs : FlankPairs
        The side pressed together.

    Returns
    -------
    (n,) array
        All phases, or with `teeth` those with these teeth in or near contact.

    Raises
    ------
    InfeasibleError
        If there are none, or the range leaves the travel of open wheels or a rack.
    """
    first, last = stretch(spec, pairs)
    if not last > first:
        what = f"the study ends at {formatted(np.degrees(last))} deg before it begins"
        note = f"give a start below {formatted(np.degrees(last))} deg"
        raise InfeasibleError(what, where="meshing.from_deg", nearest=note)
    phi1 = np.linspace(first, last, spec.steps, endpoint=not pairs.closed)
    if not pairs.closed:
        _demand_travel(first, last, pairs.travel)
    if spec.teeth is None:
        return phi1
    track = pairs.track
    wanted = np.isin(pairs.wheels[0].number(pairs.numbers), spec.teeth)
    start, end = (track.arc_length(edge[wanted]) for edge in (pairs.arcs.start, pairs.arcs.end))
    apart = track.arc_length(phi1)[:, None] - start
    margin = _BESIDE * pairs.pitch
    if pairs.closed:
        apart = np.mod(apart + margin, track.length) - margin
    inside = (apart >= -margin) & (apart <= end - start + margin)
    chosen = phi1[inside.any(axis=1)]
    if not chosen.size:
        angles = np.degrees(track.angle(0.5 * (start + end)))
        note = (
            "they are in contact near phi1 = "
            + ", ".join(f"{formatted(angle, 4)}" for angle in angles)
            + " deg; use more steps or another range"
        )
        raise InfeasibleError(
            "these teeth are in contact in none of the phases", where="meshing.teeth", nearest=note
        )
    return chosen


def _demand_travel(first: float, last: float, travel: float) -> None:
    """Refuse phases beyond the ends of travel of open wheels and racks."""
    early = first < -_STOP * travel
    if early or last > (1.0 + _STOP) * travel:
        what = "the study leaves the travel of the pair"
        where = f"meshing.{'from' if early else 'to'}_deg"
        limit = 0.0 if early else float(np.degrees(travel))
        note = f"the travel lies between 0 and {formatted(np.degrees(travel), 8)} deg"
        raise beyond_limit(what, where, float(np.degrees(first if early else last)), limit, note)


def _outlines(
    gears: tuple[Gear, Gear], spec: MeshingSpec, penetration: float
) -> tuple[Outline, Outline]:
    """Return outlines that resolve a penetration, mm; refuse an overclosure too small for that."""
    pair = gears[0].pair
    tolerance = min(SHARE * penetration, pair.chord_tolerance(None))
    one, two = (replace(gear.profile, tolerance=tolerance, most=_MOST) for gear in gears)
    if tolerance == pair.chord_tolerance(None):
        return one, two
    chords = max(one.sampler.least, two.sampler.least)
    lost, many = FINEST * pair.module / tolerance, (chords / _MOST) ** 2
    if max(lost, many) <= 1.0:
        return one, two
    reason = (
        "the overlap would be lost in rounding"
        if lost > many
        else f"outlines that resolve the overlap would need {formatted(chords, 2)} chords"
    )
    least = float(np.degrees(spec.overclosure)) * max(lost, many)
    what, note = (
        f"the driver is turned ahead too little: {reason}",
        f"{formatted(ABOVE * least, 3)} deg is enough",
    )
    raise beyond_limit(
        what, "meshing.overclosure_deg", float(np.degrees(spec.overclosure)), least, note
    )


def _distance(pair: GearPair, spec: MeshingSpec) -> float:
    """Position of wheel 2's frame as mounted, mm along x (see `Guide`)."""
    if spec.center_distance is None:
        return pair.shift
    if pair.on_rack:
        what = "a rack has no shaft, and so no centre distance"
        where = "meshing.center_distance_mm"
        note = "leave it out: the rack is in its design position"
        raise InfeasibleError(
            what, where=where, value=spec.center_distance, unit="mm", nearest=note
        )
    depth = 2.0 * pair.rack.addendum * pair.module
    least, most = max(0.0, pair.center_distance - depth), pair.center_distance + depth
    if not least < spec.center_distance < most:
        what = (
            "the mounted centre distance is so far from the design distance that the teeth do not "
            "mesh"
        )
        limit = least if spec.center_distance <= least else most
        note = f"use a distance between {formatted(least)} and {formatted(most)} mm"
        raise beyond_limit(what, "meshing.center_distance_mm", spec.center_distance, limit, note)
    return math.copysign(spec.center_distance, pair.shift)


def _block(setup: Setup, phi1: Array, first: int) -> Block:
    """Return the results of some phases; `first` is the number of the first of them."""
    spec, turning, side = setup.spec, setup.turning, setup.side
    touching = {s: contacts(setup.pairs[s], phi1) for s in (DRIVE, COAST)}
    first_touches = {
        s: first_touch(setup.pairs[s], phi1, found)
        if not setup.faces
        else first_of(setup.faces[s], phi1)
        for s, found in touching.items()
    }
    first_lead, edge = first_touches[side]
    lead = np.where(np.isfinite(first_lead), first_lead, 0.0)
    ahead = turning.overlaps(phi1, spec.overclosure, lead)
    held = turning.flank_distance(side, phi1, -spec.overclosure, lead)
    along = to_pitch_line(setup.pairs[side], phi1)
    backlash = (first_touches[COAST][0] - first_touches[DRIVE][0]) * along
    # the overclosure would hide negative backlash from the outlines
    interferes = backlash < -setup.noise
    interferes[ahead.step[ahead.depth > explained(setup, ahead)]] = True
    return Block(
        first=first,
        phi1=phi1,
        phi2=turning.rolling.law.phi2(phi1),
        lead=first_lead,
        along=along,
        backlash=backlash,
        edge=edge,
        held_back_gap=held,
        overlaps=ahead,
        solids=setup.bodies and setup.bodies.overlaps(phi1, spec.overclosure, lead),
        contacts=touching[side],
        patches=patches(setup.pairs[side], phi1, spec.overclosure, lead),
        interferes=interferes,
    )


def explained(setup: Setup, found: Overlaps) -> Array:
    """Return the depth of overlaps that overclosure and chord errors explain.

    Parameters
    ----------
    setup : Setup
        The pair as mounted.
    found : Overlaps
        Pieces.

    Returns
    -------
    (n,) array, mm
    """
    deepest = DEEPER * abs(setup.spec.overclosure) * setup.lever
    return np.where(on_side(found, setup.side), deepest, 0.0) + setup.noise
