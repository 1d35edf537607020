"""Changes that may help if a cam is refused or has errors: a larger cam, smaller rollers, lifts."""

from __future__ import annotations

from collections.abc import Callable, Iterator, Mapping
from contextlib import suppress
from dataclasses import replace
from types import MappingProxyType
from typing import TYPE_CHECKING, Any, Final

import numpy as np

from gearcam.base.errors import Adjustment, InfeasibleError
from gearcam.base.findings import limit_of
from gearcam.base.numerals import shortened
from gearcam.cams.checks import KIND
from gearcam.designs.design import value_at
from gearcam.kinds.cam.hints import gentler, grown
from gearcam.kinds.cam.tables import CAM_FORMATS
from gearcam.parts.checks import KIND as PARTS_KIND
from gearcam.results.advice import Advice, kerf_paths

if TYPE_CHECKING:
    from gearcam.results.advice import Search

_LARGER: Final = 100.0
"""How far a cam grows in the search, over what its follower and its lift reach."""

_SMALLER: Final = 0.01
"""How far a roller or a lift shrinks in it, over what is given."""


_ALSO: Final[Mapping[str, Callable[[Any], object]]] = {
    "csv": lambda result: result.angles,
    "tool-path": lambda result: result.form.paths(result.design.output.tool_radius),
    "dxf": kerf_paths,
    "cut-svg": kerf_paths,
    "curvature": lambda result: result.files("curvature"),
}
"""Checks of single file formats, which may refuse a file although the profiles can be drawn."""


def _demand(kind: str) -> Callable[[Any], object]:
    """Return the check of a file format for which all profiles are drawn."""
    return lambda result: (result.profiles, kind in _ALSO and _ALSO[kind](result))


class CamAdvice(Advice):
    """Remedies of cams: changes that a refusal names, then other sizes."""

    file_demands = MappingProxyType({kind: _demand(kind) for kind in CAM_FORMATS})

    def seek(self, search: Search, refusal: InfeasibleError | None) -> None:
        """Guide a `search` by changes that a `refusal` names, then by other sizes."""
        if search.result.design.asked:
            return  # the refusal of a size that is solved for names what has to give
        first = _walled(search, refusal) if refusal else _of_errors(search)
        search.follow([*first, *_sizes(search)])

    def moves(self, design: Any, other: Any) -> bool:
        """Return whether the `other` design has another lift than the `design`."""
        return bool(design.motion != other.motion)


def _walled(search: Search, refusal: InfeasibleError) -> Iterator[Adjustment]:
    """Yield the adjustments of a refusal; a bore begins where its wall is thick enough."""
    wall = 2.0 * limit_of(PARTS_KIND, "thin-wall", search.result.design.limits)
    for adjustment in refusal.adjustments:
        bore = [*adjustment.far] == ["blank.bore_diameter_mm"] and not adjustment.near
        if bore and refusal.limit is not None and wall < 0.9 * refusal.limit:
            yield replace(adjustment, near={"blank.bore_diameter_mm": refusal.limit - wall})
        else:
            yield adjustment


def _of_errors(search: Search) -> Iterator[Adjustment]:
    """Yield the smallest radii without jamming, and for a flat face with the least profile radius.

    The radius of a profile below a flat face is ``base + s + s''``, 0 at the border of undercut.
    """
    result: Any = search.result
    if "jamming" in search.codes:
        least = [gentler(result, "jamming", number) for number in range(len(result.cam.motions))]
        yield Adjustment(
            near={key: size for changes in least for key, size in (changes or {}).items()}
        )
    if "undercut" in search.codes and (base := result.cam.least_base_radius) is not None:
        base += limit_of(KIND, "sharp-profile", result.design.limits)
        yield Adjustment(near=grown(search.document, "cam.base_radius_mm", shortened(base, 1.0)))


def _sizes(search: Search) -> Iterator[Adjustment]:
    """Yield adjustments to a larger cam, a smaller roller and smaller lifts."""
    document, far = search.document, _LARGER * _reach(search)
    larger = ("cam.prime_radius_mm", "cam.base_radius_mm", "cam.prime_radius2_mm")
    for key in (*larger, "follower.roller_distance_mm"):
        if 0.0 < (value_at(document, key) or 0.0) < far:
            yield Adjustment(far=grown(document, key, far), doubling=True)
    for key in ("follower.roller_radius_mm", "follower.roller2_radius_mm"):
        if given := value_at(document, key):
            yield Adjustment(far={key: _SMALLER * given}, doubling=True)
    motion = document["motion"]
    lifts = {
        f"motion[{number}].{key}": _SMALLER * value
        for number, phase in enumerate([] if isinstance(motion, dict) else motion)
        for key, value in phase.items()
        if key.startswith(("lift_", "to_", "velocity_", "acceleration_")) and value
    }
    if lifts:
        yield Adjustment(far=lifts, doubling=True)


def _reach(search: Search) -> float:
    """Return how far a follower and its lift reach, mm."""
    result: Any = search.result
    follower = result.solved.follower
    lift = 0.0
    with suppress(InfeasibleError):
        lift = float(np.ptp(result.program.range)) * (
            follower.arm or follower.pivot_distance or 1.0
        )
    sizes = (follower.radius, abs(follower.offset), follower.arm, follower.pivot_distance)
    return lift + sum(size or 0.0 for size in sizes)
