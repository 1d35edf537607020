"""Sizes of a cam that a design asks for: the smallest cam that keeps its limits.

A design asks with the word "solve" in the place of a size. Its *solution* has the sizes, in whole
millionths of a millimetre on the safe side: the cam with these sizes has no finding about the
limits that it was solved for. Among all cams that keep them it has the smallest profile, or what
``[goal]`` names. Sizes are sought within ``[bounds]``, by default from a hundredth of the follower
and its lift to a hundred times that.

Refused: limits that no sizes keep, with the least change of a limit that helps; a lift whose
velocity falls at once.
"""

from __future__ import annotations

import math
from collections.abc import Iterator, Mapping, Sequence
from contextlib import suppress
from dataclasses import dataclass, replace
from functools import partial
from typing import TYPE_CHECKING, Any, Final

import numpy as np

from gearcam.base.display import ShortRepr
from gearcam.base.errors import DesignError, InfeasibleError
from gearcam.base.findings import CHECKS, limit_of
from gearcam.base.numerals import decimal, formatted, shortened
from gearcam.cams.checks import KIND, pressure_limits
from gearcam.cams.placing import followers_of
from gearcam.cams.sizing import (
    SIZES,
    Load,
    Measured,
    SizeLimits,
    Sizing,
    smallest,
    smallest_from,
)
from gearcam.kinds.cam.design import CamDesign
from gearcam.kinds.cam.forms.base import CHORD_TOLERANCE, lift_program
from gearcam.kinds.cam.tables import GOALS
from gearcam.kinds.under_load import largest_pressure, loads_of
from gearcam.mechanics.force_checks import FORCES  # with its checks, which have the limits
from gearcam.parts.checks import KIND as PARTS_KIND

if TYPE_CHECKING:
    from gearcam.kinds.cam.made import MadeCam
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

_PRINTED: Final = 9
"""Digits of a limit that has to give: all of its thousandths."""

_KEPT: Final = ("pressure-angle", "jamming", "sharp-profile", "undercut")
"""Checks whose limits a solution keeps."""

_LIMITS: Final = {
    "rise": ("pressure_angle_deg", "deg", "the pressure angle"),
    "back": ("pressure_angle_deg", "deg", "the pressure angle"),
    "convex": ("profile_radius_mm", "mm", "the least convex radius of the profile"),
    "hollow": ("tool_diameter_mm", "mm", "twice the least concave radius"),
    "wall": ("wall_mm", "mm", "the wall around the bore"),
    "contact": ("contact_pressure_mpa", "MPa", "the contact pressure"),
}
"""Key, unit and words of limits, by the names of excesses."""

_ANGLES: Final = ("rise", "back")
"""Names of the excesses of pressure angles."""

_WORDS: Final = {
    "rise": "pressure angle on the rise",
    "back": "pressure angle on the return",
    "convex": "least convex radius",
    "hollow": "tool",
    "wall": "wall around the bore",
    "contact": "contact pressure",
    "pivot": "pivot beside the cam",
    "reach": "reach of the follower",
    "undercut": "undercut",
    "roller": "roller of half the prime radius",
}
"""Limits in words, by the names of excesses."""

_FREE: Final = "the goal alone"
"""What decides where no limit does."""

_GOALS: Final = dict(zip(GOALS, ("size", "pressure", "rise", "back", "convex"), strict=True))

_ASIDE: Final = 10.0
"""Default range of an offset, over the size of the follower with its lift."""

_TRIES: Final = 24
"""Steps from the smallest cam to one with room, each half as long as the next."""

_SLIGHT: Final = 1e-6
"""Excess of the end of a search, from which the steps to a cam with room lead."""

_ROUNDS: Final = 6
_AGREED: Final = 1e-5
"""Largest number of searches under a contact pressure, and sizes, mm, in which they agree."""

_NARROWEST: Final = 1e-9
"""Least width of a range, mm: both ends may be one."""

_MORE: Final = (0.0, 1e-4, 1e-3, 4e-3, 1.6e-2)
"""What a limit that has to give gets beyond its excess until there is a solution."""

_BEYOND: Final = 1.005
"""Contact pressure that can be kept, over the least."""

_FAR: Final = 0.5
"""Share of the default range beyond which only the range keeps a cam from growing."""

_USUAL: Final = (0.01, 0.03)
"""Range of a usual cam, over the largest of the default range."""

_AROUND: Final = 0.8
_GRID: Final = 81
"""Range, in sizes of the solution, and places of the chart of the region."""

_DECIDES: Final = 1e-6
"""Excess from which a limit decides on the size."""


Found = tuple[dict[str, float], dict[str, float]]
"""All sizes, mm, by the names of `SIZES`: the smallest cam, and one that has room."""


@dataclass(frozen=True, eq=False, kw_only=True)
class Solution(ShortRepr):
    """The sizes that a design asked for.

    Parameters
    ----------
    task : Task
        What was asked for.
    design : CamDesign
        The design with them.
    sizes : mapping of str to float, mm
        By their keys.
    deciding : tuple of str
        What would exceed its limit with a smaller cam, in words.
    """

    task: Task
    design: CamDesign
    sizes: Mapping[str, float]
    deciding: tuple[str, ...]


def solved(result: MadeCam, *, advise: bool = True) -> Solution:
    """Return the solution of a design that asks for sizes.

    Parameters
    ----------
    result : MadeCam
        Of the design.
    advise : bool
        Whether a refusal has to name a limit with which there is a solution.

    Returns
    -------
    Solution

    Raises
    ------
    InfeasibleError
        If no sizes within the bounds keep the limits.
    """
    task = Task(result, advise=advise)
    _demand_smooth_ends(task)
    found = task.found()
    if task.pressure:
        task, found = _pressed(result, task, found)
    best, inner = found
    # towards the cams that keep the limits with room, until the checks agree in whole digits
    for share in (0.0, *(2.0**-k for k in range(_TRIES, -1, -1))):
        between = {name: best[name] + share * (inner[name] - best[name]) for name in best}
        sizes = {key: round(size, _DIGITS) for key, size in task.by_key(between).items()}
        try:
            design = _sized(result.design, sizes)
        except DesignError:  # rounded to a size that no follower can have
            continue
        if task.keeps(type(result)(design, result.tolerances)):
            excess = task.measured(best).excess.items()
            close = (name for name, one in excess if one.max() > -_DECIDES)
            words = (*(_WORDS[name] for name in close), *task.at_bounds(best))
            deciding = tuple(dict.fromkeys(words)) or (_FREE,)
            return Solution(task=task, design=design, sizes=sizes, deciding=deciding)
    raise InfeasibleError(
        "no sizes that keep all limits could be confirmed",
        where=task.keys[0],
        nearest="give this size, or its range in [bounds]",
    )


def _demand_smooth_ends(task: Task) -> None:
    """Refuse a lift whose velocity falls at once: the profile has a corner whatever its size."""
    hard = task.program.hard
    falls = [jump for jump in hard if jump.after < jump.before and not jump.slight]
    if falls:
        at = formatted(math.degrees(falls[0].theta))
        raise InfeasibleError(
            "no sizes keep the profile from being undercut: the velocity falls at once",
            where=f"motion, at {at} deg",
            nearest="a law whose velocity is 0 at both ends, such as cycloidal, or a given size",
        )


def _sized(design: CamDesign, sizes: Mapping[str, float]) -> CamDesign:
    """Return a design with its sizes, mm, by their keys; their ranges have no effect any more."""
    return design.with_({**sizes, "bounds": {}})


def _pressed(result: MadeCam, task: Task, found: Found) -> tuple[Task, Found]:
    """Return the task under a limit of the contact pressure, and what it finds.

    Weights of a swinging follower depend on its place: the loads are those on the last cam, until
    it does not change.
    """
    for _ in range(_ROUNDS):
        before = task.by_key(found[0])
        cam = type(result)(_sized(result.design, before), result.tolerances)
        most = largest_pressure(cam) if task.sizing.load is None else math.inf
        if most <= task.pressure:
            break  # the other limits keep it
        if math.isinf(cam.follower.bend):
            raise InfeasibleError(
                "no sizes keep the limit: the contact pressure of a pointed follower is unbounded",
                where="limits.contact_pressure_mpa",
                nearest="a roller or a domed follower, or no limit",
            )
        task = Task(result, _load_on(cam, task.pressure), advise=task.advise)
        found = task.found()
        after = task.by_key(found[0])
        if all(abs(after[key] - before[key]) < _AGREED for key in after):
            break
    return task, found


def _load_on(cam: MadeCam, most: float) -> Load:
    """Return what a cam carries under a largest pressure, MPa."""
    design, width = cam.design, cam.contact_width
    return Load(
        total_load=loads_of(cam).total_load,
        friction=design.friction,
        dragged=np.vectorize(partial(design.follower.dragged, design.friction), otypes=[float]),
        most=math.pi * width * most**2 / design.material.contact_modulus,
        knots=np.concatenate([np.zeros(0), *(one.knots for one in design.load)]),
    )


def alone(result: MadeCam, key: str, more: Mapping[str, Any] | None = None) -> float | None:
    """Return the value of one size, mm, with which a cam keeps all limits; None if there is none.

    Parameters
    ----------
    result : MadeCam
        Of a cam that does not.
    key : str
        The key of the size.
    more : mapping, optional
        Other changes of the design.
    """
    asked = result.solved.with_({key: "solve"} | dict(more or {}))
    try:
        return solved(type(result)(asked, result.tolerances), advise=False).sizes[key]
    except (DesignError, InfeasibleError):
        return None


class Task:
    """What is asked for, and under which limits.

    Parameters
    ----------
    result : MadeCam
        Of the design.
    load : Load, optional
        What the cam has to move, where the contact pressure is limited.
    advise : bool
        Whether a refusal has to name a limit with which there is a solution.
    """

    def __init__(self, result: MadeCam, load: Load | None = None, *, advise: bool = True) -> None:
        self.result, self.advise, design = result, advise, result.design
        self.design, self.program = design, lift_program(design, result.tolerances)
        program = self.program
        self.pressure = float(limit_of(FORCES, "contact-pressure", design.limits))
        self.keys = design.asked
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
            slender="roller" in self.unknown
            and design.bounds.roller_radius is None
            and self.kind.has_centre,
            load=load,
            goal=self._goal(),
        )

    def found(self) -> Found:
        """Return the smallest cam, and one that keeps the limits with room.

        Raises
        ------
        InfeasibleError
            If no sizes keep the limits.
        """
        found = smallest(self.sizing, self.known, self.unknown)
        if self._kept(found):
            return found
        best, names, excess = self._freed(self.measured(found[0]))
        if excess <= 0.0:  # the limits can be kept, only the search ended too early
            found = smallest_from(self.sizing, self.known, self.unknown, best)
            if self._kept(found):
                return found
        raise self._refused(names, best, max(excess, 0.0))

    def _kept(self, found: Found) -> bool:
        """Return whether the limits are kept, but for what a step to a cam with room removes."""
        best, inner = found
        return bool(self.measured(best).worst[0] <= _SLIGHT or self.measured(inner).worst[0] < 0.0)

    def by_key(self, sizes: Mapping[str, float]) -> dict[str, float]:
        """Return the sizes that are asked for, mm, by their keys; given by the names of `SIZES`."""
        return {key: sizes[name] for key, name in self.names.items()}

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
            low, high = given or (-_ASIDE * scale, _ASIDE * scale)
        else:
            low, high = given or (_LEAST * scale, _MOST * scale)
            low = max(low, _LEAST * min(scale, high))
        return low, max(high, low + _NARROWEST)

    def at_bounds(self, sizes: Mapping[str, float]) -> Iterator[str]:
        """Yield which sizes are at an end of their range, in words.

        Raises
        ------
        InfeasibleError
            If only the default range keeps the cam from growing without end.
        """
        for key, name in self.names.items():
            ends, size = self.unknown[name], sizes[name]
            plain = key.split(".")[1]
            given = getattr(self.design.bounds, plain.removesuffix("_mm")) is not None
            far = name == "radius" and self.sizing.goal[0] != "size" and not given
            if far and size > _FAR * ends[1]:
                raise InfeasibleError(
                    f"the best cam is the largest: nothing but the default range, up to "
                    f"{decimal(ends[1], 0)} mm, limits it",
                    where=f"bounds.{plain}",
                    nearest=f"a range in [bounds], such as {plain} = "
                    f"[{', '.join(formatted(shortened(one * ends[1], 1.0, 2)) for one in _USUAL)}]",
                )
            end = min(ends, key=lambda end, size=size: abs(size - end))
            if abs(size - end) > _DECIDES * max(map(abs, ends)):
                continue
            if given:
                yield f"{plain} at its bound {formatted(end)} mm"
            else:
                yield f"the default range of {plain} ([bounds] sets another)"

    def _limits(self) -> SizeLimits:
        design, limits = self.design, self.design.limits
        largest = pressure_limits(self.kind, limit_of(KIND, "pressure-angle", limits))
        jams = limit_of(KIND, "jamming", limits)
        blank: Any = design.blank
        bore, chords = blank.bore, design.output.chord_tolerance or CHORD_TOLERANCE
        margin = blank.clearance + chords  # what the outline may be inside the profile
        return SizeLimits(
            rise=min(largest["rise"], self.kind.jamming_limit if math.isnan(jams) else jams),
            back=largest["return"],
            convex=limit_of(KIND, "sharp-profile", limits),
            hollow=0.5 * limit_of(PARTS_KIND, "tool-too-large", limits),
            wall=0.5 * bore + limit_of(PARTS_KIND, "thin-wall", limits) + margin if bore else 0.0,
        )

    def _goal(self) -> tuple[str, float]:
        signs = self.design.goal.signs or {next(iter(GOALS)): 1.0}
        ((named, sign),) = signs.items()
        return _GOALS[named], sign

    def keeps(self, result: MadeCam) -> bool:
        """Return whether a cam has no finding about the limits.

        Parameters
        ----------
        result : MadeCam
            Of a design with all sizes.
        """
        try:
            cam, limits = result.cam, self.design.limits
            for code in _KEPT:
                if any(True for _ in CHECKS[KIND, code].run(cam, limit_of(KIND, code, limits))):
                    return False
            blank: Any = self.design.blank
            if self.pressure and largest_pressure(result) > self.pressure:
                return False
            walls = blank.bore and result.part_subject
            return not walls or not any(
                CHECKS[PARTS_KIND, "thin-wall"].run(
                    walls, limit_of(PARTS_KIND, "thin-wall", limits)
                )
            )
        except InfeasibleError:
            return False

    def _freed(self, found: Measured) -> tuple[dict[str, float], tuple[str, ...], float]:
        """Return the cam that keeps all limits but some, their names, and its excess over them.

        Raises
        ------
        InfeasibleError
            If more limits have to give.
        """
        beyond = [name for name, one in found.excess.items() if one.max() > _SLIGHT]
        for names in self._ways(beyond):
            freed = replace(self.sizing, free=names)
            best, _ = smallest(freed, self.known, self.unknown)
            kept = self.measured(best, freed)
            if kept.worst[0] <= _SLIGHT and math.isfinite(kept.goal[0]):
                return best, names, float(kept.goal[0])
        raise InfeasibleError(
            "no sizes within their ranges keep all limits",
            where=self.keys[0],
            nearest="wider ranges in [bounds], a smaller lift, or more angle for it",
        )

    def _ways(self, beyond: Sequence[str]) -> Iterator[tuple[str, ...]]:
        """Yield which limits may give: one, or both pressure angles where one is not enough."""
        same = self.sizing.limits.rise == self.sizing.limits.back
        for name in _LIMITS:
            if name in beyond and not (same and name in _ANGLES):
                yield (name,)
        if any(name in beyond for name in _ANGLES):
            yield _ANGLES

    def _refused(
        self, names: tuple[str, ...], sizes: Mapping[str, float], excess: float
    ) -> InfeasibleError:
        """Return the refusal that names which limit has to give, so that an excess is kept.

        It names a value only if there is a solution with it.
        """
        key, unit, words = _LIMITS[names[0]]
        pair = self.sizing.limits.rise != self.sizing.limits.back and names[0] in _ANGLES
        if pair:
            words += " of rises" if names[0] == "rise" else " of returns"
        for more in _MORE:
            least, limit = self._limit_at(names[0], sizes, excess + more)
            value: Any = least
            if pair:
                value = [
                    self._limit_at(name, sizes, (excess + more) * (name in names))[0]
                    for name in _ANGLES
                ]
            if not self.advise:
                break
            other = self.design.with_({f"limits.{key}": value})
            with suppress(InfeasibleError):
                solved(type(self.result)(other, self.result.tolerances), advise=False)
                break
        else:
            return InfeasibleError(
                f"no sizes keep all limits: {words} is too much to ask for",
                where=f"limits.{key}",
                nearest="another limit, or wider ranges in [bounds]",
            )
        shown = [formatted(one, _PRINTED) for one in (value if pair else [value])]
        near = f"[{', '.join(shown)}]" if pair else shown[0]
        return InfeasibleError(
            f"no sizes keep all limits: {words} would be {formatted(least, _PRINTED)}",
            where=f"limits.{key}",
            value=least,
            limit=limit,
            unit=unit,
            nearest=f"{key} = {near} can be kept",
        )

    def _limit_at(
        self, name: str, sizes: Mapping[str, float], excess: float
    ) -> tuple[float, float]:
        """Return the value of a limit that an excess keeps, on the safe side, and the limit."""
        limits, roller = self.sizing.limits, sizes["roller"]
        safe = 1e-3
        if name in ("rise", "back"):
            limit = limits.rise if name == "rise" else limits.back
            least = math.degrees(math.atan(math.tan(limit) * (1.0 + excess)))
            return math.ceil(least / safe) * safe, math.degrees(limit)
        if name == "contact":
            # the least is that of a cam without end
            least = _BEYOND * self.pressure * math.sqrt(1.0 + excess)
            return float(math.ceil(least)), self.pressure
        if name == "convex" and not self.kind.has_centre:
            by_size = replace(self.sizing, goal=("size", 1.0))  # of which the excess is a share
            size = float(self.measured(sizes, by_size).goal[0])
            value, limit = limits.convex - size * excess, limits.convex
        elif name == "convex":
            value, limit = (roller + limits.convex) / (1.0 + excess) - roller, limits.convex
        elif name == "hollow":
            value = 2.0 * ((limits.hollow - roller) / (1.0 + excess) + roller)
            limit = 2.0 * limits.hollow
        else:
            limit = limit_of(PARTS_KIND, "thin-wall", self.design.limits)
            value = limit - limits.wall * excess
        return math.floor(value / safe) * safe, limit


def region(solution: Solution) -> Chart | None:
    """Return the chart of the sizes that keep each limit; None unless two are solved for."""
    from gearcam.pictures.charts import Chart, Line

    if len(solution.sizes) != 2:
        return None
    task = solution.task
    first, second = sorted(task.names, key=lambda key: task.names[key] == "radius")
    chosen = solution.sizes
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
