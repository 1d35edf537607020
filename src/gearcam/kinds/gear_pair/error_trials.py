"""Random assemblies of a gear pair: each within the tolerances of ``[errors]``.

A *trial* is one assembly with its errors, and how it runs: transmission error, least backlash,
whether it jams. Inputs are the tolerances of the design, its `trials` and `seed`: the same seed
gives the same assemblies, in any number of processes. Outputs are a row for each (columns in mm,
deg, and rad or, of a rack, mm), percentiles of the transmission error, and their histogram.

An assembly in which nothing touches somewhere has no transmission error: its cells are empty, and
it counts as one above all others in percentiles. One that jams counts in them as any other: its
transmission error is that of its driving flanks alone, as if the coast flanks could overlap.
"""

from __future__ import annotations

import math
from collections.abc import Callable, Iterator, Sequence
from dataclasses import dataclass, replace
from typing import TYPE_CHECKING, Any, Final, NamedTuple

import numpy as np

from gearcam.base.display import ShortRepr
from gearcam.base.errors import InfeasibleError
from gearcam.base.facts import Fact, Tree, extent
from gearcam.base.numerals import formatted
from gearcam.base.processes import in_order
from gearcam.meshing.assembly import random_assemblies
from gearcam.meshing.errors import Runs
from gearcam.pictures.charts import Chart, Line

if TYPE_CHECKING:
    from gearcam.kinds.gear_pair.result import GearPairResult
    from gearcam.meshing.assembly import Assembly
    from gearcam.numeric.arrays import Array

_BARS: Final = 40


class Outcome(NamedTuple):
    """How a random assembly runs.

    Parameters
    ----------
    error : float, rad, of a rack mm
        Transmission error, peak to peak: infinite where nothing touches somewhere.
    backlash : float, mm
        Least backlash.
    jams : bool
        Whether it cannot be assembled without force.
    """

    error: float
    backlash: float
    jams: bool


@dataclass(frozen=True, eq=False, kw_only=True)
class AssemblyTrials(ShortRepr):
    """The random assemblies that were tried.

    Parameters
    ----------
    assemblies : sequence of Assembly
        Their errors.
    outcomes : sequence of Outcome
        How they run: of fewer, if it was interrupted.
    unit : str
        Unit of their transmission errors.
    measured : bool
        Whether an outline of a wheel was measured.
    """

    assemblies: Sequence[Assembly]
    outcomes: Sequence[Outcome]
    unit: str
    measured: bool = False

    @property
    def done(self) -> int:
        """Number of assemblies that were tried."""
        return len(self.outcomes)

    @property
    def table(self) -> dict[str, Array]:
        """Columns with a row for each assembly: its errors, and how it runs."""
        assemblies = self.assemblies[: self.done]
        columns: dict[str, Any] = {
            "number": range(1, self.done + 1),
            f"transmission_error_{self.unit}": _missing([one.error for one in self.outcomes]),
            "least_backlash_mm": _missing([one.backlash for one in self.outcomes]),
            "jams": [one.jams for one in self.outcomes],
            "center_mm": [one.center for one in assemblies],
            "tilt_in_plane_deg": [math.degrees(one.tilt.real) for one in assemblies],
            "tilt_across_deg": [math.degrees(one.tilt.imag) for one in assemblies],
        }
        for wheel in (0, 1):
            offset = np.array([one.eccentric[wheel] for one in assemblies], dtype=complex)
            columns[f"eccentricity{wheel + 1}_mm"] = np.abs(offset)
            columns[f"eccentricity{wheel + 1}_deg"] = np.degrees(np.angle(offset))
        for wheel in (0, 1):
            for tooth in sorted({tooth for one in assemblies for tooth in one.pitch[wheel]}):
                errors = [one.pitch[wheel].get(tooth, 0.0) for one in assemblies]
                columns[f"pitch{wheel + 1}_tooth{tooth}_mm"] = errors
        return {
            name: one if np.ma.isMaskedArray(one) else np.asarray(one, dtype=float)
            for name, one in columns.items()
        }

    def facts(self, percentiles: Sequence[float]) -> Tree:
        """Return counts, and the errors that so many percent of the assemblies do not exceed."""
        errors = np.array([one.error for one in self.outcomes])
        touching = np.isfinite(errors)
        jam = sum(one.jams for one in self.outcomes)
        tree: Tree = {
            "count": self.done,
            "jam": Fact(jam, "assemblies that jam", shown=True),
            "apart": Fact(
                int(np.count_nonzero(~touching)),
                "assemblies in which nothing touches somewhere",
                shown=not touching.all(),
            ),
        }
        least = {
            share: float(np.percentile(errors, share, method="inverted_cdf"))
            for share in sorted(percentiles)
        }
        whose = "the assemblies (those that jam too)" if jam else "the assemblies"
        tree[f"transmission_error_{self.unit}"] = {
            f"p{formatted(share).replace('.', '_')}": Fact(
                value,
                f"transmission error of {formatted(share)} % of {whose}, at most",
                unit=self.unit,
                shown=True,
            )
            for share, value in least.items()
            if math.isfinite(value)
        } or None
        if touching.any():
            backlash = np.array([one.backlash for one in self.outcomes])[touching]
            tree["backlash_mm"] = extent(float(backlash.min()), float(backlash.max()))
        return tree

    @property
    def charts(self) -> dict[str, Chart]:
        """The histogram of transmission errors, if there are any."""
        errors = np.array([one.error for one in self.outcomes])
        found = errors[np.isfinite(errors)]
        if not len(found):
            return {}
        counts, edges = np.histogram(found, min(_BARS, 5 + math.isqrt(len(found))))
        # a stepped line with two points at each edge
        heights = np.concatenate([[0.0], np.repeat(counts, 2), [0.0]])
        chart = Chart(
            title="Transmission error of random assemblies",
            x=f"transmission error, peak to peak, {self.unit}",
            y="assemblies",
            lines=(Line(label="assemblies", x=np.repeat(edges, 2), y=heights),),
        )
        return {"trials": chart}


def tried(
    result: GearPairResult,
    runs: Runs,
    every: Assembly,
    jobs: int,
    report: Callable[[int], None],
) -> Iterator[tuple[Assembly, Outcome]]:
    """Yield the random assemblies of a design and how they run, in their order.

    Parameters
    ----------
    result : GearPairResult
        The pair.
    runs : Runs
        What they have in common.
    every : Assembly
        The errors that the design gives, to which random ones are added.
    jobs : int
        Number of processes.
    report : callable
        Told the number of those that are done.

    Yields
    ------
    assembly, outcome

    Raises
    ------
    DesignError
        If the design cannot be sent to processes.
    """
    plain = replace(every, outlines=(None, None))  # outlines are sent once
    assemblies = list(random_assemblies(result.design.errors, result.gears, plain))
    answers = (
        map(_of(runs, every.outlines), assemblies)
        if jobs == 1
        else in_order(_outcomes, (result, every.outlines, runs.phi1), assemblies, jobs)
    )
    for number, one in enumerate(assemblies):
        report(number)
        yield one, next(answers)


def _outcomes(common: tuple[GearPairResult, Any, Array]) -> Callable[[Assembly], Outcome]:
    """Return the function that tries an assembly, for a process."""
    result, outlines, phi1 = common
    runs = Runs(steps=result.steps, width=result.design.pair.face_width, phi1=phi1)
    return _of(runs, outlines)


def _of(runs: Runs, outlines: Any) -> Callable[[Assembly], Outcome]:
    def outcome(assembly: Assembly) -> Outcome:
        try:
            found = runs.of(replace(assembly, outlines=outlines))
        except InfeasibleError:
            return Outcome(math.inf, math.inf, jams=False)
        return Outcome(found.peak_to_peak, found.least_backlash, jams=found.jams)

    return outcome


def _missing(values: Sequence[float]) -> Array:
    """Return values of which those that are not finite are missing."""
    return np.ma.masked_invalid(np.array(values, dtype=float))
