"""What helps a globoidal cam that is refused or has errors."""

from __future__ import annotations

from collections.abc import Iterator, Mapping
from typing import TYPE_CHECKING, Any, Final

from gearcam.base.adjustments import Adjustment
from gearcam.base.numerals import shortened
from gearcam.kinds.sizes import SizeAdvice

if TYPE_CHECKING:
    from gearcam.results.advice import Search

_LARGEST: Final = 350.0
"""Largest index angle, deg."""


class GloboidalAdvice(SizeAdvice):
    """Remedies of globoidal cams by their sizes."""

    larger = ("cam.center_distance_mm",)
    smaller = ("turret.roller_radius_mm",)

    def milder(self, document: Mapping[str, Any]) -> Iterator[Adjustment]:  # noqa: ARG002
        """Yield a motion that takes a larger part of the turn."""
        yield Adjustment(far={"index.angle_deg": _LARGEST}, size=True)

    def of_errors(self, search: Search) -> Iterator[Adjustment]:
        """Yield the length from which on a roller presses in both directions."""
        for one in search.result.checked_without_hints:
            if one.code == "loose-turret" and one.limit is not None:
                yield Adjustment(near={"cam.length_mm": shortened(one.limit, 1.0)})
