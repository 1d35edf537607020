"""Bores of wheels that reach the roots of their teeth."""

from __future__ import annotations

import math
from collections.abc import Callable
from contextlib import suppress
from typing import Final, TypeAlias

from gearcam.base.errors import Adjustment, InfeasibleError, beyond_limit
from gearcam.base.findings import limit_of
from gearcam.base.numerals import formatted
from gearcam.gears.pair import Gear
from gearcam.gears.subject import KIND
from gearcam.kinds.gear_pair.design import GearPairDesign
from gearcam.laws.ratio.span import angle_text

Bores: TypeAlias = tuple[float | None, float | None]
"""Diameters, mm, of both wheels, including keyways; None of what has no bore."""

_KEY: Final = "blank.bore_diameter_mm"

_SAME: Final = 1e-9
"""Relative difference of the ends of a ratio that is rounding."""


def demand_bore(
    gear: Gear, bores: Bores, design: GearPairDesign, driven: Callable[[], Gear]
) -> None:
    """Refuse a bore that reaches the roots of a wheel, and that of its mate if it does, too.

    Parameters
    ----------
    gear : Gear
        The wheel.
    bores : two float or None, mm
        Bore diameters of both wheels.
    design : GearPairDesign
        The design.
    driven : callable
        ``driven()`` returns the driven wheel, which is made after the driver.

    Raises
    ------
    InfeasibleError
        With the largest bores.
    """
    if not _too_wide(gear, bores):
        return
    wheels = [gear]
    if gear.wheel == 1:
        with suppress(InfeasibleError):
            mate = driven()
            wheels += [mate] * _too_wide(mate, bores)
    names = [f"{_KEY}[{one.wheel - 1}]" for one in wheels]
    # the limit holds for the circle around bore and keyway
    limits = [2.0 * one.least_radius for one in wheels]
    given = [bores[one.wheel - 1] or 0.0 for one in wheels]
    diameters = [design.blank.wheel(one.wheel).bore for one in wheels]
    rim = 2.0 * limit_of(KIND, "thin-rim", design.limits) * gear.pair.module
    # the largest bore that keeps the limit of the rim, or without any that meets the roots
    near = [
        diameters[k] - given[k] + limit - (rim if rim < 0.9 * limit else 0.0)
        for k, limit in enumerate(limits)
    ]
    worst, notes = limits.index(min(limits)), [*map(_room, wheels)]
    where = f"wheel {gear.wheel}, {names[0]}"
    if len(wheels) > 1:
        where = f"wheels 1 and 2, {_KEY}"
        notes.append(f"both take less than {formatted(limits[worst])} mm")
        if diameters[0] == diameters[1]:
            names, near, limits = [_KEY], [min(near)], [limits[worst]]
    if diameters != given:
        notes.append("limits hold for the circle around bore and keyway")
    what = "the bore reaches the root of the teeth"
    adjustments = (
        Adjustment(
            near=dict(zip(names, near, strict=True)),
            far={name: 0.1 * limit for name, limit in zip(names, limits, strict=True)},
        ),
    )
    raise beyond_limit(
        what, where, given[worst], min(limits), "; ".join(notes), adjustments=adjustments
    )


def _too_wide(gear: Gear, bores: Bores) -> bool:
    bore = bores[gear.wheel - 1]
    return bore is not None and 0.5 * bore >= gear.least_radius


def _room(gear: Gear) -> str:
    """Return how wide the bore of a wheel may be, and why its root comes so near to the axis."""
    ends = gear.pair.law.ratio_range
    (place, ratio), (_, other) = ends if gear.wheel == 1 else reversed(ends)
    room = f"wheel {gear.wheel} takes less than {formatted(2.0 * gear.least_radius)} mm"
    if math.isclose(ratio, other, rel_tol=_SAME):
        return room
    return (
        f"{room}: its teeth come nearest to the axis at {angle_text(place)}, where the law's ratio "
        f"is {formatted(ratio)}"
    )
