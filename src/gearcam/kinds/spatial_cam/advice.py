"""What helps a cam in space that is refused or has errors."""

from __future__ import annotations

from gearcam.kinds.sizes import SizeAdvice


class SpatialAdvice(SizeAdvice):
    """Remedies of cams in space by their sizes."""

    larger = ("cam.outer_diameter_mm",)
