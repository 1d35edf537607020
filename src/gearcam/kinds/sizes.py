"""Remedies of cams by their sizes: a larger cam, a smaller roller, a smaller lift."""

from __future__ import annotations

from collections.abc import Iterator, Mapping
from typing import TYPE_CHECKING, Any, ClassVar, Final

from gearcam.base.adjustments import Adjustment
from gearcam.base.quantities import LONGEST
from gearcam.designs.design import value_at
from gearcam.results.advice import Advice

if TYPE_CHECKING:
    from gearcam.base.adjustments import Changes
    from gearcam.base.errors import InfeasibleError
    from gearcam.results.advice import Search

LARGER: Final = 100.0
"""How far a cam grows in the search."""

_SMALLER: Final = 0.01
"""How far a roller or a lift shrinks in it, over what is given."""

_LIFTS: Final = ("lift_", "to_", "velocity_", "acceleration_")
"""Beginnings of keys of a phase that shrink together."""


class SizeAdvice(Advice):
    """Remedies of cams: changes that a refusal names, then other sizes, then smaller lifts."""

    larger: ClassVar[tuple[str, ...]] = ()
    """Keys of sizes with which the cam grows."""

    smaller: ClassVar[tuple[str, ...]] = ("follower.roller_radius_mm",)
    """Keys of rollers."""

    def seek(self, search: Search, refusal: InfeasibleError | None) -> None:
        """Guide a `search` by changes that a `refusal` names, then by other sizes."""
        named = self.named(search, refusal) if refusal else self.of_errors(search)
        search.follow([*named, *self.sizes(search), *self.milder(search.document)])

    def named(self, search: Search, refusal: InfeasibleError) -> Iterator[Adjustment]:  # noqa: ARG002
        """Yield the adjustments that a `refusal` names in a `search`."""
        yield from refusal.adjustments

    def of_errors(self, search: Search) -> Iterator[Adjustment]:  # noqa: ARG002
        """Yield adjustments for findings that are errors."""
        yield from ()

    def grown(self, document: Mapping[str, Any], key: str, size: float) -> Changes:  # noqa: ARG002
        """Return the changes that give the cam of a `document` another `size` at its `key`."""
        return {key: size}

    def farthest(self, search: Search, size: float) -> float:  # noqa: ARG002
        """Return up to which size, mm, a cam of a `size` is made in a `search`."""
        return min(LARGER * size, LONGEST)

    def sizes(self, search: Search) -> Iterator[Adjustment]:
        """Yield larger cams and smaller rollers."""
        document = search.document
        for key in self.larger:
            given = value_at(document, key)
            if isinstance(given, float) and 0.0 < given < (far := self.farthest(search, given)):
                yield Adjustment(far=self.grown(document, key, far), size=True)
        for key in self.smaller:
            given = value_at(document, key)
            if isinstance(given, float) and given:
                yield Adjustment(far={key: _SMALLER * given}, size=True)

    def milder(self, document: Mapping[str, Any]) -> Iterator[Adjustment]:
        """Yield milder motions: smaller lifts."""
        motion = document["motion"]
        lifts = {
            f"motion[{number}].{key}": _SMALLER * value
            for number, phase in enumerate([] if isinstance(motion, dict) else motion)
            for key, value in phase.items()
            if key.startswith(_LIFTS) and value
        }
        if lifts:
            yield Adjustment(far=lifts, size=True)

    def moves(self, changes: Changes, design: Any) -> bool:  # noqa: ARG002
        """Return whether a `design` moves differently with `changes`."""
        return any(key.startswith(("motion", "index")) for key in changes)

    def resized(self, changes: Changes, design: Any) -> bool:  # noqa: ARG002
        """Return whether a `design` has another size with `changes`."""
        return any(key in self.larger for key in changes)
