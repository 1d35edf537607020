"""Flanks of ncgears and of gearcam, point by point, and motions of other packages: `make peers`.

Both programs build closed laws ``phi2 = phi1 + harmonics`` with the same rack. The vertices of the
outlines of ncgears lie on the flanks of gearcam within a millionth of a module. Tips and roots are
not compared: they depend on the cutter, not on the law. The exit code is 1 if a case does not
agree, if both build fewer than twenty cases, or if ncgears builds one that gearcam does not; also
if natural frequencies of openTorsion or a flying follower of EXUDYN differ (see `dynamics_cases`).
"""

from __future__ import annotations

import math
import sys
import time

import numpy as np
import shapely
from numpy.typing import NDArray

import dynamics_cases
import gearcam
import peers
from gearcam.base.errors import InfeasibleError
from gearcam.gears.pair import Gear
from gearcam.gears.spec import PairSpec
from gearcam.kinds.gear_pair.design import GearPairDesign, PairOutputSpec
from gearcam.laws.ratio.formula import Formula

Array = NDArray[np.float64]
Harmonics = tuple[tuple[int, float, float], ...]

AGREE = 1e-6
"""Largest distance allowed, in modules."""

CHORD = 1e-7
"""Chord error of the outlines of gearcam, in modules."""

BAND = 0.75
"""Distance from the centrode, in modules, within which all teeth have flanks."""

EVERY = 7
"""Every seventh vertex is measured: some dozens on each flank."""

FEWEST = 20

CASES: tuple[tuple[int, Harmonics], ...] = (
    (30, ()),
    (40, ((1, 0.0, -0.05),)),
    (40, ((1, 0.0, -0.1),)),
    (40, ((1, 0.0, 0.15),)),
    (50, ((1, 0.0, -0.2),)),
    (60, ((1, 0.0, -0.3),)),
    (40, ((1, 0.1, 0.0),)),
    (50, ((1, 0.1, -0.1),)),
    (36, ((2, 0.0, -0.03),)),
    (48, ((2, 0.0, -0.05),)),
    (60, ((2, 0.0, 0.08),)),
    (60, ((2, 0.03, 0.03),)),
    (60, ((3, 0.0, -0.02),)),
    (60, ((3, 0.02, 0.01),)),
    (72, ((4, 0.0, -0.01),)),
    (50, ((1, 0.0, -0.1), (2, 0.0, 0.02))),
    (50, ((1, 0.05, -0.1), (2, 0.01, 0.0))),
    (60, ((1, 0.0, -0.1), (3, 0.0, 0.01))),
    (25, ((1, 0.0, -0.05),)),
    (31, ((1, 0.0, -0.1),)),
    (47, ((1, 0.0, 0.12), (2, 0.0, -0.02))),
    (80, ((1, 0.0, -0.25), (2, 0.0, 0.03))),
)
"""Number of teeth and harmonics of phi2: (k, cosine and sine coefficients in rad)."""


def law_of(harmonics: Harmonics) -> peers.Law:
    """Return phi2 and its derivatives for ncgears."""

    def derivatives(phi: Array) -> tuple[Array, Array, Array, Array]:
        rows = [phi.copy(), np.ones_like(phi), np.zeros_like(phi), np.zeros_like(phi)]
        for k, a, b in harmonics:
            cosine, sine = np.cos(k * phi), np.sin(k * phi)
            even, odd = a * cosine + b * sine, b * cosine - a * sine
            for row, value in zip(rows, (even, k * odd, -k * k * even, -(k**3) * odd), strict=True):
                row += value
        return rows[0], rows[1], rows[2], rows[3]

    return peers.Law(formula(harmonics), 0.0, derivatives)


def formula(harmonics: Harmonics) -> str:
    """Return phi2 for gearcam."""
    terms = [f" + {a!r}*(cos({k}*phi1) - 1) + {b!r}*sin({k}*phi1)" for k, a, b in harmonics]
    return "phi1" + "".join(terms)


def farthest(points: Array, gear: Gear) -> float:
    """Return the largest distance of points near the centrode from the outline of gearcam, mm."""
    centrode = shapely.LinearRing(gear.centrode(np.linspace(0.0, 2.0 * math.pi, 20001)[:-1]))
    outline = shapely.LinearRing(gear.outline)
    for ring in (centrode, outline):
        shapely.prepare(ring)
    places = shapely.points(points[::EVERY])
    near = places[shapely.distance(centrode, places) < BAND * gear.pair.module]
    return float(shapely.distance(outline, near).max())


def ours(text: str, teeth: int) -> tuple[Gear, Gear]:
    """Return both wheels of gearcam with module 1 mm."""
    design = GearPairDesign(
        name="peer",
        law=Formula(phi2=text),
        pair=PairSpec(module=1.0, teeth=(teeth, teeth)),
        output=PairOutputSpec(chord_tolerance=CHORD),
    )
    return gearcam.build(design).gears


def motions() -> bool:
    """Compare motions, print a line for each, and return whether they agree."""
    made = dynamics_cases.against_peers()
    for result in made:
        verdict = "agree" if result.passed else "DIFFER"
        print(f"{result.title[5:]}: {result.found}  {verdict}", flush=True)
    return all(result.passed for result in made)


def main() -> int:
    """Compare all cases and print a line for each."""
    moved, agreed, bad = motions(), 0, 0
    for teeth, harmonics in CASES:
        text, start = formula(harmonics), time.perf_counter()
        made = peers.outlines(law_of(harmonics), 1.0, teeth)
        if isinstance(made, str):
            print(f"z = {teeth:3d}  {text}: ncgears fails: {made}", flush=True)
            continue
        try:
            gears = ours(text, teeth)
        except InfeasibleError as error:
            print(f"z = {teeth:3d}  {text}: gearcam refuses: {error}", flush=True)
            bad += 1
            continue
        # ncgears measures angles clockwise
        off = max(
            farthest(points * [1, -1], gear) for points, gear in zip(made, gears, strict=True)
        )
        verdict = "agree" if off <= AGREE else "DIFFER"
        agreed, bad = agreed + (off <= AGREE), bad + (off > AGREE)
        seconds = time.perf_counter() - start
        print(f"z = {teeth:3d}  {off:.1e} modules  {verdict}  {seconds:4.0f} s  {text}", flush=True)
    print(f"{agreed} agree within {AGREE:g} modules, {bad} do not")
    return 0 if moved and agreed >= FEWEST and not bad else 1


if __name__ == "__main__":
    sys.exit(main())
