"""The meshing study: exact contact, first touch and stepwise overlap side by side, by phases.

At every phase the driven wheel is first turned until it touches, as in a machine: this takes up the
backlash. Then the driver is turned ahead by a small angle, and the outlines are intersected; the
exact flanks say which pairs must overlap, how much, and how far the driven wheel could turn. The
outlines are made anew, so fine that the chord errors of both together are at most a hundredth of
the penetration. An interruption keeps the phases done.
"""

from __future__ import annotations

import math
from collections.abc import Callable
from dataclasses import dataclass, field, replace
from functools import cached_property
from typing import Any

import numpy as np

from gearcam.errors import ABOVE, InfeasibleError
from gearcam.gears.contact import COAST, DRIVE, FlankPairs, flank_pairs
from gearcam.gears.outline import Outline
from gearcam.gears.pair import FINEST, Gear, GearPair
from gearcam.meshing.contact import contacts
from gearcam.meshing.edges import first_touch, to_pitch_line
from gearcam.meshing.half_teeth import half_teeth
from gearcam.meshing.overlap import Overlaps, Turning
from gearcam.meshing.patches import patches
from gearcam.meshing.phases import phases, stretch
from gearcam.meshing.rows import Block, columns_of, on_side
from gearcam.meshing.settings import MeshingSpec
from gearcam.numerals import shown
from gearcam.numeric.arrays import Array, Mask

Progress = Callable[[str, int, int], None]

SHARE = 1.0 / 200.0
"""Chord error of each outline over the penetration: both together are a hundredth."""

_MOST = 1e7
"""Chords of a studied outline: of more, its half-teeth do not fit into memory."""

BLOCK = 120
"""Phases that are studied at once: few enough for progress, many enough to be fast."""

DEEPER = 1.6
"""Depth of overlap, over what the overclosure explains, from which flanks count as interfering.

Depths are told as if patches ended in points: of one as long as its flanks, a strip between flanks
that hug each other as in a ring, it is 1.5 times what it is."""


@dataclass(frozen=True, eq=False, kw_only=True)
class Setup:
    """A pair as mounted for a study.

    Parameters
    ----------
    spec : MeshingSpec
        Settings.
    pairs : mapping of int to FlankPairs
        Both sides.
    turning : Turning
        The outlines.
    side : {-1, +1}
        The side that the overclosure presses together.
    stretch : (float, float), rad
        Driver angles between which the pair is studied.
    penetration : float, mm
        Smallest penetration of a full contact: overclosure times lever.
    lever : float, mm
        Largest lever of the driver.
    """

    spec: MeshingSpec
    pairs: dict[int, FlankPairs]
    turning: Turning
    side: int
    stretch: tuple[float, float]
    penetration: float
    lever: float

    @property
    def noise(self) -> float:
        """Depth of overlap that the chords alone may cause, mm."""
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
        What was found, block by block.
    """

    setup: Setup
    phi1: Array
    asked: int
    blocks: list[Block] = field(default_factory=list)

    @property
    def sides(self) -> tuple[FlankPairs, FlankPairs]:
        """The pairs of flanks that hold back and those that drive."""
        return self.setup.pairs[COAST], self.setup.pairs[DRIVE]

    @property
    def complete(self) -> bool:
        """Whether every phase was studied."""
        return len(self.phi1) == self.asked

    @cached_property
    def columns(self) -> dict[str, Any]:
        """The rows of ``meshing.csv``: one a phase and pair of half-teeth that touch or should."""
        return columns_of(self.blocks, self.setup.turning, self.setup.side)

    @property
    def on_side(self) -> Mask:
        """Which rows are of facing half-teeth of the side that is pressed together."""
        rows = self.columns
        return (rows["facing"].data > 0.0) & (rows["side"].data == self.setup.side)

    def every(self, name: str) -> Array:
        """Return a field of all blocks, end to end, by its `name`."""
        if not self.blocks:
            return np.empty(0)
        return np.concatenate([getattr(block, name) for block in self.blocks])


def study(
    gears: tuple[Gear, Gear],
    spec: MeshingSpec,
    progress: Progress | None = None,
    designed: tuple[FlankPairs, ...] = (),
) -> Meshing:
    """Study a pair.

    Parameters
    ----------
    gears : (Gear, Gear)
        The wheels.
    spec : MeshingSpec
        Settings.
    progress : callable, optional
        Called with ``"meshing"``, the phases done and their number.
    designed : tuple of FlankPairs
        Both sides of the pair as designed, where they are known already.

    Returns
    -------
    Meshing
        Of the phases done where it was interrupted.

    Raises
    ------
    InfeasibleError
        If the wheels do not reach each other, or the overclosure is too small to be shown.
    """
    return run(mount(gears, spec, designed), progress)


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
    gears: tuple[Gear, Gear], spec: MeshingSpec, designed: tuple[FlankPairs, ...] = ()
) -> Setup:
    """Put a pair on its shafts, with outlines as fine as the overclosure asks for.

    Parameters
    ----------
    gears : (Gear, Gear)
        The wheels.
    spec : MeshingSpec
        Settings.
    designed : tuple of FlankPairs
        Both sides of the pair as designed, where they are known already.

    Returns
    -------
    Setup

    Raises
    ------
    InfeasibleError
        If the wheels do not reach each other, or the overclosure is too small to be shown.
    """
    pair = gears[0].pair
    distance = _distance(pair, spec)
    pairs = {one.side: one for one in designed if one.distance == distance}
    pairs = pairs or {side: flank_pairs(gears, side, distance) for side in (DRIVE, COAST)}
    side = DRIVE if spec.overclosure > 0.0 else COAST
    grid = np.linspace(0.0, pairs[side].travel, 20 * len(pairs[side].numbers))
    levers = contacts(pairs[side], grid).lever[0]
    if not levers.size:
        levers = np.abs(pair.rolling.tracks[0].frames(np.zeros(1)).p.real)
    penetration = abs(spec.overclosure) * float(levers.min())
    both = [half_teeth(outline) for outline in _outlines(gears, spec, penetration)]
    for gear, wheel in zip(gears, both, strict=True):
        if not wheel.sound:
            raise InfeasibleError(
                "the teeth are too few and too deep to be told apart",
                where=f"wheel {gear.wheel}",
                value=float(gear.toothing.teeth),
                nearest="more teeth or a smaller x; build and check look at such wheels",
            )
    turning = Turning(
        rolling=pair.rolling,
        driver=both[0],
        driven=both[1],
        distance=distance,
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
    )


def _outlines(
    gears: tuple[Gear, Gear], spec: MeshingSpec, penetration: float
) -> tuple[Outline, Outline]:
    """Return the outlines that show a penetration, mm; refuse an overclosure too small for that."""
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
        else f"outlines that show the overlap would take {shown(chords, 2)} chords"
    )
    least = float(np.degrees(spec.overclosure)) * max(lost, many)
    raise InfeasibleError(
        f"the overclosure is so small that {reason}",
        where="meshing.overclosure_deg",
        value=float(np.degrees(spec.overclosure)),
        limit=least,
        unit="deg",
        nearest=f"{shown(ABOVE * least, 3)} deg is enough",
    )


def _distance(pair: GearPair, spec: MeshingSpec) -> float:
    """Place of wheel 2's frame as mounted, mm along x (see `Guide`)."""
    if spec.center_distance is None:
        return pair.shift
    if pair.on_rack:
        raise InfeasibleError(
            "a rack has no shaft",
            where="meshing.center_distance_mm",
            value=spec.center_distance,
            unit="mm",
            nearest="leave it out: the rack stands as designed",
        )
    depth = 2.0 * pair.rack.addendum * pair.module
    least, most = max(0.0, pair.center_distance - depth), pair.center_distance + depth
    if not least < spec.center_distance < most:
        raise InfeasibleError(
            "the wheels are mounted so far from their designed distance that their teeth do not "
            "mesh",
            where="meshing.center_distance_mm",
            value=spec.center_distance,
            limit=least if spec.center_distance <= least else most,
            unit="mm",
            nearest=f"between {shown(least)} and {shown(most)} mm",
        )
    return math.copysign(spec.center_distance, pair.shift)


def _block(setup: Setup, phi1: Array, first: int) -> Block:
    """Study some phases; `first` is the number of the first of them."""
    spec, turning, side = setup.spec, setup.turning, setup.side
    touching = {s: contacts(setup.pairs[s], phi1) for s in (DRIVE, COAST)}
    first_touches = {s: first_touch(setup.pairs[s], phi1, found) for s, found in touching.items()}
    first_lead, edge = first_touches[side]
    lead = np.where(np.isfinite(first_lead), first_lead, 0.0)
    ahead = turning.overlaps(phi1, spec.overclosure, lead)
    held = turning.flank_distance(side, phi1, -spec.overclosure, lead)
    along = to_pitch_line(setup.pairs[side], phi1)
    backlash = (first_touches[COAST][0] - first_touches[DRIVE][0]) * along
    # too little room for both sides is hidden from the outlines by the overclosure
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
        contacts=touching[side],
        patches=patches(setup.pairs[side], phi1, spec.overclosure, lead),
        interferes=interferes,
    )


def explained(setup: Setup, found: Overlaps) -> Array:
    """Return up to which depth overlaps are explained by the overclosure and by chords.

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
