"""Remedies: changes of a design with which it was built, and nothing was refused or an error.

What a refusal or a finding suggests is not told before it has been followed: each change is made
in the design's own keys, the design is built through the same steps, wheels, checks and parts, and
the change is kept if it is not refused, what was an error is gone, and no other error has come.
"""

from __future__ import annotations

import math
import re
import time
from collections.abc import Iterator, Mapping
from dataclasses import dataclass, field
from functools import cached_property
from typing import TYPE_CHECKING, Any, Final, cast

from gearcam.design.spec import changed, document_of, value_at
from gearcam.errors import DesignError, InfeasibleError, Way

if TYPE_CHECKING:
    from gearcam.design import Design
    from gearcam.findings import Finding
    from gearcam.jobs.gear_pair import GearPairJob
    from gearcam.jobs.job import Job

Changes = Mapping[str, object]

PATIENCE: Final = 6.0
"""Seconds after which a search is given up."""

_MOST: Final = 400
"""Most teeth of a wheel that are tried: beyond them nobody is helped."""

_LIKELY: Final = 1.5
"""How many times more teeth are tried first where an error does not tell."""

_SHARE: Final = 0.6
"""Part of the time that tooth counts may take where there are other ways."""

_PARTS: Final = 40
"""Steps between the near and the far end of a way."""

_INSIDE: Final = 1e-3
"""Part of the way by which a limit is kept."""

_OF_TEETH: Final = frozenset({"contact-ratio", "undercut"})
"""Findings that more teeth or a smaller swing may lift."""

_EDGES: Final = (
    Way(far={"blank.tip_rounding_mm": 0.0}),
    Way(far={"blank.clearance_mm": 0.0}),
)
"""Ways to edges as they are cut."""

_LARGER: Final = 5.0
_SMALLER: Final = 0.05
"""How far a cam grows and a roller or a lift shrinks in the search, over what is given."""


@dataclass(frozen=True, kw_only=True)
class Remedy:
    """A change with which a design was built, free of errors.

    Parameters
    ----------
    changes : mapping of str to value
        Values by dotted keys of the design file, in its units.
    less : mapping of str to value
        The next smaller change, with which it was not; empty where none was tried.
    design : GearPairDesign or CamDesign
        The changed design.
    """

    changes: Changes
    less: Changes = field(default_factory=dict)
    design: Design


@dataclass(frozen=True, kw_only=True)
class Remedies:
    """What a search for remedies found.

    Parameters
    ----------
    found : tuple of Remedy
        Each another way out.
    tried : tuple of str
        Keys that were changed in the search.
    gave_up : bool
        Whether the time was over before all ways were tried to their end.
    seconds : float
        The time that it was given.
    """

    found: tuple[Remedy, ...] = ()
    tried: tuple[str, ...] = ()
    gave_up: bool = False
    seconds: float = PATIENCE


def remedies(
    job: Job, refusal: InfeasibleError | None = None, *, patience: float = PATIENCE
) -> Remedies:
    """Search for changes that make a design buildable and free of errors.

    Parameters
    ----------
    job : Job
        The job of the design.
    refusal : InfeasibleError, optional
        How it was refused; found by building it where left out.
    patience : float, s
        Time after which no other build is begun.

    Returns
    -------
    Remedies
        Empty where the design is not refused and has no error.
    """
    errors: list[Finding] = []
    if refusal is None:
        try:
            errors = [finding for finding in job.findings if finding.severity == "error"]
        except InfeasibleError as error:
            refusal = error
    elif not refusal.ways and not refusal.more_teeth and _builds(job):
        return Remedies(seconds=patience)  # a study was refused, not the design
    search = _Search(job, frozenset(error.code for error in errors), patience)
    if refusal is None and not errors:
        return Remedies(seconds=patience)
    ways = list(refusal.ways if refusal else ())
    if job.design.kind == "cam":
        ways += _larger_cam(search.document)
    else:
        factor = refusal.more_teeth if refusal else _LIKELY * bool(search.codes & _OF_TEETH)
        ways += _of_a_pair(search, refusal, factor)
        if factor:
            search.until = search.begin + patience * (_SHARE if ways else 1.0)
            search.more_teeth(factor)
            search.until = search.begin + patience
    for way in ways:
        if not search.along(way) and (both := _for_both(way)) is not None:
            search.along(both)
    return Remedies(
        found=tuple(search.found),
        tried=tuple(search.tried),
        gave_up=search.gave_up,
        seconds=patience,
    )


def _builds(job: Job) -> bool:
    """Whether the design is not refused when it is built."""
    try:
        _ = job.findings
    except InfeasibleError:
        return False
    return True


class _Search:
    """A search within a time: what was tried, and what was found."""

    def __init__(self, job: Job, codes: frozenset[str], patience: float) -> None:
        self.job, self.codes = job, codes
        self.begin = time.perf_counter()
        self.until = self.begin + patience
        self.found: list[Remedy] = []
        self.tried: dict[str, None] = {}
        self.gave_up = False

    @cached_property
    def document(self) -> dict[str, Any]:
        """What a file of the design would hold."""
        return document_of(self.job.design)

    def over(self) -> bool:
        """Whether the time is over; then a search is given up."""
        over = time.perf_counter() > self.until
        self.gave_up |= over
        return over

    def cures(self, changes: Changes) -> bool:
        """Whether the changed design builds, without the errors and without others."""
        self.tried |= dict.fromkeys(changes)
        try:
            other = type(self.job)(changed(self.job.design, changes), self.job.tolerances)
            if self._hopeless(other):
                return False
            findings = other.findings
        except (InfeasibleError, DesignError):
            return False
        return all(
            finding.severity != "error" and finding.code not in self.codes for finding in findings
        )

    def _hopeless(self, other: Job) -> bool:
        """Whether the flanks alone already forbid what is asked, which takes no outline to know."""
        if other.design.kind == "cam":
            return False
        from gearcam.gears.bound import contact_bound

        return contact_bound(*cast("GearPairJob", other).pair.toothings) < 1.0

    def keep(self, changes: Changes, less: Changes | None = None) -> None:
        """Write a remedy down."""
        design = changed(self.job.design, changes)
        self.found.append(Remedy(changes=changes, less=less or {}, design=design))

    def along(self, way: Way) -> bool:
        """Find the smallest change along a way; whether there is one."""
        if self.over():
            return False
        near = {key: way.near.get(key, value_at(self.document, key)) for key in way.far or way.near}
        if any(value is None for value in near.values()):
            return False
        if way.far and _between(near, way.far, 1.0) == _between(near, {}, 0.0):
            return False  # it is there already
        if way.near:
            first = _between(near, way.far, _INSIDE) if way.far else _tidy(near)
            if self.cures(first):
                self.keep(first)
                return True
        low, high = 0, _PARTS if way.far else 0
        while high and not self.over() and not self.cures(_between(near, way.far, high / _PARTS)):
            high //= 2
        if not high or self.over():
            return False
        while high - low > 1 and not self.over():
            middle = (low + high) // 2
            does = self.cures(_between(near, way.far, middle / _PARTS))
            low, high = (low, middle) if does else (middle, high)
        ends = [_between(near, way.far, part / _PARTS) for part in (high, low)]
        self.keep(ends[0], ends[1] if low else None)
        return True

    def more_teeth(self, factor: float) -> None:
        """Find the fewest teeth in the same ratio, `factor` times as many being likely."""
        given: tuple[int, int] = self.job.design.pair.teeth
        common = math.gcd(*given)

        def teeth(k: int) -> Changes:
            return {"pair.teeth": [count // common * k for count in given]}

        low, most = common, _MOST * common // max(given)
        high = max(low + 1, math.ceil(low * factor * (1.0 - 1e-9)))
        while high <= most and not self.over() and not self.cures(teeth(high)):
            low, high = high, min(2 * high, most) if high < most else most + 1
        if high > most or self.over():
            return
        middle = high - 1  # the guess is often right
        while high - low > 1 and not self.over():
            low, high = (low, middle) if self.cures(teeth(middle)) else (middle, high)
            middle = (low + high) // 2
        self.keep(teeth(high), teeth(low))
        module = self.job.design.pair.module
        if module is not None and not self.over():
            small = {"pair.module_mm": float(f"{module * common / high:.6g}")}
            if self.cures({**teeth(high), **small}):
                self.keep({**teeth(high), **small})


def _for_both(way: Way) -> Way | None:
    """Return a way of one wheel's blank as one of both, None where it is none."""
    keys = [*way.near, *way.far]
    if not keys or not all(re.fullmatch(r"blank\.\w+\[\d\]", key) for key in keys):
        return None
    near, far = ({key[:-3]: end for key, end in ends.items()} for ends in (way.near, way.far))
    return Way(near=near, far=far)


def _between(near: Changes, far: Changes, share: float) -> dict[str, object]:
    """Return values between two ends, numbers of ten digits."""
    return {key: _mixed(value, far.get(key, value), share) for key, value in near.items()}


def _tidy(value: Any) -> Any:
    """Write numbers in ten digits."""
    if isinstance(value, Mapping):
        return {key: _tidy(item) for key, item in value.items()}
    if isinstance(value, list):
        return [_tidy(item) for item in value]
    return float(f"{value:.10g}") if isinstance(value, float) else value


def _mixed(near: Any, far: Any, share: float) -> Any:
    if isinstance(near, list):
        ends = far if isinstance(far, list) else [far] * len(near)
        return [_mixed(a, b, share) for a, b in zip(near, ends, strict=True)]
    if isinstance(near, bool | str) or isinstance(far, bool | str):
        return near
    return _tidy(float(near + share * (far - near)))


def _milder(search: _Search) -> Iterator[Way]:
    """Yield ways to a law that swings less."""
    law, teeth = search.document["law"], search.job.design.pair.teeth
    mean = teeth[0] / teeth[1]
    far: dict[str, object] = {}
    for key in ("eccentricity", "cosines", "sines"):
        if key in law:
            far[f"law.{key}"] = 0.0
    if "ratios" in law and "driven_travel_deg" not in law:
        # arcs that close, mixed with the even turn, which closes, close
        far["law.ratios"] = mean
    if far:
        yield Way(far=far)


def _of_a_pair(search: _Search, refusal: InfeasibleError | None, factor: float) -> Iterator[Way]:
    """Yield ways of a pair beside more teeth and what its refusal names."""
    if refusal is None:
        yield from _ways_of_errors(search)
    elif not refusal.ways and not factor:
        yield from _other_ratios(search)
        yield from _EDGES
    if factor:
        yield from _milder(search)


def _other_ratios(search: _Search) -> Iterator[Way]:
    """Yield the nearest teeth with which one wheel turns a whole number of times for the other."""
    z1, z2 = search.job.design.pair.teeth
    yield Way(near={"pair.teeth": [z1, max(1, round(z2 / z1)) * z1]})
    yield Way(near={"pair.teeth": [max(1, round(z1 / z2)) * z2, z2]})


def _ways_of_errors(search: _Search) -> Iterator[Way]:
    """Yield the ways out of a pair's findings that are errors."""
    if search.codes & _OF_TEETH:
        addendum = value_at(search.document, "rack.addendum")
        if addendum is not None and addendum < 1.0:
            yield Way(far={"rack.addendum": 1.0})
        if search.document["pair"]["x"]:
            yield Way(far={"pair.x": 0.0})
        yield from _EDGES


def _larger_cam(document: Mapping[str, Any]) -> Iterator[Way]:
    """Yield ways to a cam that is larger for its follower and its lifts."""
    sizes = (("cam.prime_radius_mm", _LARGER), ("cam.base_radius_mm", _LARGER))
    for key, factor in (*sizes, ("follower.roller_radius_mm", _SMALLER)):
        given = value_at(document, key)
        if given:
            yield Way(far={key: factor * cast("float", given)})
    lifts = {
        f"motion[{number}].{key}": _SMALLER * value
        for number, phase in enumerate(document["motion"])
        for key, value in phase.items()
        if key.startswith(("lift_", "to_", "velocity_", "acceleration_")) and value
    }
    if lifts:
        yield Way(far=lifts)
