"""What may help where a cam is refused or has errors: a larger cam, a smaller roller or lift."""

from __future__ import annotations

from collections.abc import Callable, Iterator, Mapping
from typing import TYPE_CHECKING, Any, Final

from gearcam.advice import kerf_paths
from gearcam.designs.design import value_at
from gearcam.errors import InfeasibleError, Way
from gearcam.kinds.cam.design import CAM_FORMATS

if TYPE_CHECKING:
    from gearcam.advice import Search
    from gearcam.result import Result

_LARGER: Final = 5.0
_SMALLER: Final = 0.05
"""How far a cam grows and a roller or a lift shrinks in the search, over what is given."""


_ALSO: Final[Mapping[str, Callable[[Any], object]]] = {
    "csv": lambda result: result.angles,
    "tool-path": lambda result: result.form.paths(result, result.design.output.tool_radius),
    "dxf": kerf_paths,
    "cut-svg": kerf_paths,
    "curvature": lambda result: result.files("curvature"),
}
"""What refuses some of the files, by their kinds, where the profiles can be drawn."""


def _demand(kind: str) -> Callable[[Any], object]:
    """Return what refuses files of a kind for which all profiles are drawn."""
    return lambda result: (result.profiles, kind in _ALSO and _ALSO[kind](result))


FILE_DEMANDS: Final[Mapping[str, Callable[[Any], object]]] = {
    kind: _demand(kind) for kind in CAM_FORMATS
}
"""What refuses, by their kinds, files of cams that can be made."""


def seek(search: Search, refusal: InfeasibleError | None) -> None:
    """Lead a `search` for remedies: what a `refusal` names, then other sizes."""
    search.follow([*(refusal.ways if refusal else ()), *_sizes(search.document)])


def hopeless(_: Result) -> bool:
    """Whether a changed design cannot do, which nothing tells without building it."""
    return False


def _sizes(document: Mapping[str, Any]) -> Iterator[Way]:
    """Yield ways to a cam that is larger for its follower and its lifts."""
    larger = ("cam.prime_radius_mm", "cam.base_radius_mm", "cam.prime_radius2_mm")
    larger += ("follower.roller_distance_mm",)
    smaller = ("follower.roller_radius_mm", "follower.roller2_radius_mm")
    sizes = dict.fromkeys(larger, _LARGER) | dict.fromkeys(smaller, _SMALLER)
    for key, factor in sizes.items():
        given = value_at(document, key)
        if given:
            # a larger cam needs a larger blank
            blank = value_at(document, "cam.outer_diameter_mm") if factor > 1.0 else None
            room = {"cam.outer_diameter_mm": factor * blank} if blank else {}
            yield Way(far={key: factor * given, **room})
    motion = document["motion"]
    lifts = {
        f"motion[{number}].{key}": _SMALLER * value
        for number, phase in enumerate([] if isinstance(motion, dict) else motion)
        for key, value in phase.items()
        if key.startswith(("lift_", "to_", "velocity_", "acceleration_")) and value
    }
    if lifts:
        yield Way(far=lifts)
