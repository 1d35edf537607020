"""Sizes of a cam that a design asks for: the smallest cam that keeps its limits.

A design asks with the word "solve" in the place of a size. Its *solution* has the sizes, in whole
millionths of a millimetre on the safe side: the cam with these sizes has no finding about the
limits that it was solved for. Among all cams that keep them it has the smallest profile, or what
``[goal]`` names. Sizes are sought within ``[bounds]``, by default from a hundredth of the follower
and its lift to a hundred times that.

Refused: limits that no sizes keep, with the least change of a limit that helps.
"""

from __future__ import annotations

import math
from collections.abc import Mapping
from dataclasses import dataclass, replace
from typing import TYPE_CHECKING, Any, Final

import numpy as np

from gearcam.base.display import ShortRepr
from gearcam.base.errors import DesignError, InfeasibleError
from gearcam.base.findings import CHECKS, limit_of
from gearcam.base.numerals import formatted
from gearcam.cams.checks import KIND
from gearcam.cams.placing import followers_of
from gearcam.cams.sizing import SIZES, Measured, SizeLimits, Sizing, smallest
from gearcam.designs.design import document_of
from gearcam.kinds.cam.design import CamDesign, unknowns
from gearcam.kinds.cam.forms.base import lift_program
from gearcam.kinds.cam.tables import GOALS
from gearcam.parts.checks import KIND as PARTS_KIND

if TYPE_CHECKING:
    from gearcam.kinds.cam.build import CamResult
    from gearcam.laws.program import Program
    from gearcam.numeric.arrays import Array
    from gearcam.pictures.charts import Chart

_NAMES: Final = {
    "cam.prime_radius_mm": "radius",
    "cam.base_radius_mm": "radius",
    "follower.offset_mm": "offset",
    "follower.pivot_distance_mm": "pivot",
    "follower.arm_mm": "arm",
    "follower.roller_radius_mm": "roller",
}
"""Sizes by their keys."""

_LEAST: Final = 0.01
_MOST: Final = 100.0
"""Default range of a size, over the size of the follower with its lift."""

_DIGITS: Final = 6
"""Digits of solved sizes, after the point of a millimetre."""

_KEPT: Final = ("pressure-angle", "jamming", "sharp-profile", "undercut")
"""Checks whose limits a solution keeps."""

_PRESSURE: Final = ("pressure_angle_deg", "the pressure angle", ("rise", "back"))
_LIMITS: Final = {
    "rise": _PRESSURE,
    "back": _PRESSURE,
    "convex": ("profile_radius_mm", "the least convex radius of the profile", ("convex",)),
    "hollow": ("tool_diameter_mm", "twice the least concave radius", ("hollow",)),
    "wall": ("wall_mm", "the wall around the bore", ("wall",)),
}
"""Key and words of limits, and what they limit, by the names of excesses."""

_WORDS: Final = {
    "rise": "pressure angle on the rise",
    "back": "pressure angle on the return",
    "convex": "least convex radius",
    "hollow": "tool",
    "wall": "wall around the bore",
    "pivot": "pivot beside the cam",
    "reach": "reach of the follower",
    "undercut": "undercut",
}
"""Limits in words, by the names of excesses."""

_GOALS: Final = dict(zip(GOALS, ("size", "pressure", "convex"), strict=True))

_ASIDE: Final = 10.0
"""Default range of an offset, over the size of the follower with its lift."""

_TRIES: Final = 24
"""Steps from the smallest cam to one with room, each half as long as the next."""

_SLIGHT: Final = 1e-6
"""Excess of the end of a search, from which the steps to a cam with room lead."""

_AROUND: Final = 0.8
_GRID: Final = 81
"""Range, in sizes of the solution, and places of the chart of the region."""

_DECIDES: Final = 1e-6
"""Excess from which a limit decides on the size."""


@dataclass(frozen=True, eq=False, kw_only=True)
class Solution(ShortRepr):
    """The sizes that a design asked for.

    Parameters
    ----------
    design : CamDesign
        The design with them.
    sizes : mapping of str to float, mm
        By their keys.
    deciding : tuple of str
        What would exceed its limit with a smaller cam, in words.
    """

    design: CamDesign
    sizes: Mapping[str, float]
    deciding: tuple[str, ...]


def solved(result: CamResult) -> Solution:
    """Return the solution of a design that asks for sizes.

    Parameters
    ----------
    result : CamResult
        Of the design.

    Returns
    -------
    Solution

    Raises
    ------
    InfeasibleError
        If no sizes within the bounds keep the limits.
    """
    task = Task(result.design, lift_program(result.design, result.tolerances))
    best, inner = smallest(task.sizing, task.known, task.unknown)
    found = task.measured(best)
    if found.worst[0] > _SLIGHT:
        raise task.refusal(found)
    # towards the cams that keep the limits with room, until the checks agree in whole digits
    for share in (0.0, *(2.0**-k for k in range(_TRIES, -1, -1))):
        sizes = {
            key: round(best[name] + share * (inner[name] - best[name]), _DIGITS)
            for key, name in task.names.items()
        }
        design = result.design.with_(sizes)
        if task.keeps(type(result)(design, result.tolerances)):
            close = (name for name, one in found.excess.items() if one.max() > -_DECIDES)
            deciding = tuple(dict.fromkeys(_WORDS[name] for name in close))
            return Solution(design=design, sizes=sizes, deciding=deciding)
    raise InfeasibleError(
        "no sizes that keep all limits could be confirmed",
        where=task.keys[0],
        nearest="give this size, or its range in [bounds]",
    )


def alone(result: CamResult, key: str) -> float | None:
    """Return the value of one size, mm, with which a cam keeps all limits; None if there is none.

    Parameters
    ----------
    result : CamResult
        Of a cam that does not.
    key : str
        The key of the size.
    """
    asked = result.solved.with_({key: "solve"})
    try:
        return solved(type(result)(asked, result.tolerances)).sizes[key]
    except (DesignError, InfeasibleError):
        return None


class Task:
    """What is asked for, and under which limits.

    Parameters
    ----------
    design : CamDesign
        The design.
    program : Program
        Its lift.
    """

    def __init__(self, design: CamDesign, program: Program) -> None:
        self.design, self.program = design, program
        self.keys = unknowns(document_of(design))
        self.names = {key: _NAMES[key] for key in self.keys}
        follower, cam = design.follower, design.cam
        self.kind, _ = followers_of(follower, dict.fromkeys(SIZES, np.ones(1)))
        given = {
            "radius": cam.prime_radius or cam.base_radius,
            "offset": follower.offset,
            "pivot": follower.pivot_distance,
            "arm": follower.arm,
            "roller": follower.roller_radius or follower.dome_radius,
        }
        asked = self.names.values()
        self.known = {
            name: float(value or 0.0) for name, value in given.items() if name not in asked
        }
        self.unknown = {name: self._range(key) for key, name in self.names.items()}
        self.sizing = Sizing(
            spec=follower,
            program=program,
            limits=self._limits(),
            beside="pivot" in self.unknown,
            from_base=cam.base_radius is not None and self.kind.has_centre,
            goal=self._goal(),
        )

    def measured(self, sizes: Mapping[str, float], sizing: Sizing | None = None) -> Measured:
        """Return what is measured of one candidate.

        Parameters
        ----------
        sizes : mapping of str to float, mm
            By the names of `SIZES`.
        sizing : Sizing, optional
            With other limits or another goal.
        """
        columns = {name: np.array([value]) for name, value in sizes.items()}
        return (sizing or self.sizing).measured(columns)

    def _scale(self) -> float:
        """Return the size of the follower with its lift, mm."""
        low, high = self.program.range
        lengths = (value for name, value in self.known.items() if name != "offset")
        longest = max(lengths, default=0.0)
        if not self.kind.angular:
            return (high - low) + abs(self.known.get("offset", 0.0)) + longest
        if not longest:
            raise InfeasibleError(
                "no length of the swinging follower is given: any cam could be made smaller",
                where=self.keys[0],
                nearest="give one of its lengths",
            )
        return longest * (1.0 + high - low)

    def _range(self, key: str) -> tuple[float, float]:
        """Return the range in which a size is sought, mm."""
        name = key.split(".")[1].removesuffix("_mm")
        given, scale = getattr(self.design.bounds, name), self._scale()
        if name == "offset":
            return given or (-_ASIDE * scale, _ASIDE * scale)
        low, high = given or (_LEAST * scale, _MOST * scale)
        return max(low, _LEAST * min(scale, high)), high

    def _limits(self) -> SizeLimits:
        design, limits = self.design, self.design.limits
        largest = min(
            usual_limit if math.isnan(given := limit_of(KIND, code, limits)) else given
            for code, usual_limit in (
                ("pressure-angle", self.kind.pressure_limit),
                ("jamming", self.kind.jamming_limit),
            )
        )
        blank: Any = design.blank
        bore = blank.bore
        return SizeLimits(
            rise=largest,
            back=largest,
            convex=limit_of(KIND, "sharp-profile", limits),
            hollow=0.5 * limit_of(PARTS_KIND, "tool-too-large", limits),
            wall=0.5 * bore + limit_of(PARTS_KIND, "thin-wall", limits) if bore else 0.0,
        )

    def _goal(self) -> tuple[str, float]:
        goal = self.design.goal
        named = goal.maximize or goal.minimize or next(iter(GOALS))
        return _GOALS[named], -1.0 if goal.maximize else 1.0

    def keeps(self, result: CamResult) -> bool:
        """Return whether a cam has no finding about the limits.

        Parameters
        ----------
        result : CamResult
            Of a design with all sizes.
        """
        try:
            cam, limits = result.cam, self.design.limits
            for code in _KEPT:
                if any(True for _ in CHECKS[KIND, code].run(cam, limit_of(KIND, code, limits))):
                    return False
            blank: Any = self.design.blank
            walls = blank.bore and result.part_subject
            return not walls or not any(
                CHECKS[PARTS_KIND, "thin-wall"].run(
                    walls, limit_of(PARTS_KIND, "thin-wall", limits)
                )
            )
        except InfeasibleError:
            return False

    def refusal(self, found: Measured) -> InfeasibleError:
        """Return the refusal of limits that no sizes keep, with one that helps.

        Parameters
        ----------
        found : Measured
            The candidate that is beyond them by the least.
        """
        beyond = {
            _LIMITS[name]
            for name, one in found.excess.items()
            if one.max() > _SLIGHT and name in _LIMITS
        }
        for key, words, names in sorted(beyond):
            freed = replace(self.sizing, free=names)
            best, _ = smallest(freed, self.known, self.unknown)
            kept = self.measured(best, freed)
            if kept.worst[0] > _SLIGHT or not math.isfinite(kept.goal[0]):
                continue
            least, limit = self._limit_at(names[0], best, float(kept.goal[0]))
            return InfeasibleError(
                f"no sizes keep all limits: {words} would be {formatted(least, 4)}",
                where=f"limits.{key}",
                value=least,
                limit=limit,
                unit=key.rsplit("_", 1)[1],
                nearest=f"{key} = {formatted(least, 4)} can be kept",
            )
        return InfeasibleError(
            "no sizes within their ranges keep all limits",
            where=self.keys[0],
            nearest="wider ranges in [bounds], a smaller lift, or more angle for it",
        )

    def _limit_at(
        self, name: str, sizes: Mapping[str, float], excess: float
    ) -> tuple[float, float]:
        """Return the value of a limit that an excess keeps, on the safe side, and the limit."""
        limits, roller = self.sizing.limits, sizes["roller"]
        safe = 1e-3
        if name in ("rise", "back"):
            least = math.degrees(math.atan(math.tan(limits.rise) * (1.0 + excess)))
            return math.ceil(least / safe) * safe, math.degrees(limits.rise)
        if name == "convex":
            value, limit = (roller + limits.convex) / (1.0 + excess) - roller, limits.convex
        elif name == "hollow":
            value = 2.0 * ((limits.hollow - roller) / (1.0 + excess) + roller)
            limit = 2.0 * limits.hollow
        else:
            limit = limit_of(PARTS_KIND, "thin-wall", self.design.limits)
            value = limit - limits.wall * excess
        return math.floor(value / safe) * safe, limit


def region(result: CamResult) -> Chart | None:
    """Return the chart of the sizes that keep each limit; None unless two are solved for.

    Parameters
    ----------
    result : CamResult
        Of a design that asks for sizes.
    """
    from gearcam.pictures.charts import Chart, Line

    if result.solution is None or len(result.solution.sizes) != 2:
        return None
    task = Task(result.design, result.program)
    first, second = sorted(task.names, key=lambda key: task.names[key] == "radius")
    chosen = result.solution.sizes
    reach = _AROUND * max(abs(chosen[first]), abs(chosen[second]))
    places = [
        np.linspace(max(low, chosen[key] - reach), min(high, chosen[key] + reach), _GRID)
        for key, (low, high) in ((key, task.unknown[task.names[key]]) for key in (first, second))
    ]
    x, y = np.meshgrid(*places, indexing="ij")
    sizes = {name: np.full(x.size, value) for name, value in task.known.items()}
    sizes |= {task.names[first]: x.ravel(), task.names[second]: y.ravel()}
    found = task.sizing.measured(sizes, coarse=True)
    lines = [
        Line(label="chosen", x=np.array([chosen[first]]), y=np.array([chosen[second]]), dots=True)
    ]
    for name, excess in found.excess.items():
        edge = _edge(places[1], excess.max(axis=0).reshape(x.shape))
        if np.isfinite(edge).sum() > 1:
            lines.append(Line(label=_WORDS[name], x=places[0], y=edge))
    return Chart(
        title="Sizes at their limits: the cam must be above all lines",
        x=first,
        y=second,
        lines=tuple(lines),
    )


def _edge(y: Array, excess: Array) -> Array:
    """Return above which y an excess, (n, m), stays at 0 or less; nan if nowhere or everywhere."""
    beyond = excess > 0.0
    last = len(y) - 1 - np.argmax(beyond[:, ::-1], axis=1)
    inside = beyond.any(axis=1) & (last < len(y) - 1)
    row, low = np.arange(len(excess)), np.minimum(last, len(y) - 2)
    before, after = excess[row, low], excess[row, low + 1]
    with np.errstate(all="ignore"):
        share = np.where(np.isfinite(before), before / (before - after), 1.0)
    return np.where(inside, y[low] + share * (y[low + 1] - y[low]), np.nan)
