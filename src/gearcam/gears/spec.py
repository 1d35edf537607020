"""Parameters of a gear pair as a design gives them: pair, rack, ring, steps; nothing computed."""

from __future__ import annotations

from collections.abc import Iterator
from dataclasses import dataclass

from gearcam.base.display import ShortRepr
from gearcam.base.quantities import (
    ANGLE,
    COUNT,
    LENGTH,
    NUMBER,
    TEXT,
    WHEELS,
    param,
    positive_length,
)
from gearcam.base.rules import Breach, exactly_one, excludes, only_with

RIM = 2.7
"""Default rim beyond the roots, in modules: 1.2 tooth depths."""

MOST_TEETH = 3000
"""Largest number of teeth of a wheel, and of a pinion cutter."""

LARGEST_MODULE = 1e3
"""Largest module, mm."""


@dataclass(frozen=True, kw_only=True)
class Rack:
    """The basic rack that a design asks for; heights in modules.

    A value that is None takes the default of `BasicRack`, or less if the given values leave no room
    for it (see `settle_rack`).

    Examples
    --------
    >>> import gearcam as gc
    >>> import math
    >>> round(gc.Rack(pressure_angle=math.radians(25)).pressure_angle, 4)
    0.4363
    """

    pressure_angle: float = param(
        ANGLE, default=0.3490658503988659, ge=5, le=35, doc="pressure angle of the rack"
    )
    addendum: float | None = param(
        NUMBER,
        default=None,
        gt=0.1,
        le=2,
        example=1,
        doc="tooth height above the pitch curve, in modules; 1 if left out, or what the other "
        "values leave room for",
    )
    dedendum: float | None = param(
        NUMBER,
        default=None,
        gt=0.1,
        le=2.5,
        example=1.25,
        doc="tooth depth below the pitch curve, in modules; 1.25 if left out, or what the other "
        "values leave room for",
    )
    tip_radius: float | None = param(
        NUMBER,
        default=None,
        ge=0,
        le=1,
        example=0.38,
        doc="tip radius of the cutter, in modules; 0.38 if left out, or less where it does not fit",
    )


@dataclass(frozen=True, kw_only=True)
class BasicRack:
    """The basic rack that is used; the defaults are the common full-depth rack.

    A tip radius of 0.38 is the largest that leaves a land: the flank is straight to a depth of
    0.999968 modules.

    Parameters
    ----------
    pressure_angle : float, rad
        Pressure angle.
    addendum, dedendum, tip_radius : float
        Height above and depth below the pitch curve, rounding of the cutter's tip, in modules.
    """

    pressure_angle: float = 0.3490658503988659
    addendum: float = 1.0
    dedendum: float = 1.25
    tip_radius: float = 0.38

    def yielded(self, given: Rack) -> dict[str, float]:
        """Return the defaults that had to change beside the `given` values: default by name."""
        return {
            name: default
            for name in ("addendum", "dedendum", "tip_radius")
            if getattr(given, name) is None
            and getattr(self, name) != (default := getattr(BasicRack, name))
        }


@dataclass(frozen=True, kw_only=True)
class StepsSpec:
    """Stepped wheels: layers of equal width whose teeth are offset along the pitch curves.

    A non-circular wheel cannot be twisted into a helical one, because the curvature of its centrode
    varies. In stepped wheels the teeth of each layer are moved by `offset` along both centrodes, so
    that the layers mesh one after the other, as the teeth of helical wheels do.

    Examples
    --------
    >>> import gearcam as gc
    >>> gc.StepsSpec(count=3).count
    3
    """

    count: int = param(
        COUNT, default=1, ge=1, le=100, doc="number of steps over the width; 1 gives spur wheels"
    )
    offset: float | None = param(
        LENGTH,
        default=None,
        ge=-1e4,
        le=1e4,
        example=1.5,
        doc="offset of each step's teeth from those of the step below, along the pitch curves; the "
        "pitch divided by the number of steps if left out",
    )

    def problems(self) -> Iterator[Breach]:
        """Yield an offset of a single step: field, index, message, what is allowed."""
        if self.count == 1 and self.offset is not None:
            yield "offset", None, "is given, but there is one step", "with a count of 2 or more"


@dataclass(frozen=True, kw_only=True)
class PairSpec(ShortRepr):
    """Size and teeth of a pair: centre distance or module is given, the other is solved.

    Examples
    --------
    >>> import gearcam as gc
    >>> pair = gc.PairSpec(teeth=(20, 30), center_distance=100.0)
    >>> pair.teeth, pair.face_width
    ((20, 30), 10.0)
    """

    type: str = param(
        TEXT,
        default="external",
        choices=("external", "internal"),
        doc="external: wheel 2 is beside wheel 1; internal: it is a ring around wheel 1",
    )
    center_distance: float | None = positive_length(doc="centre distance")
    module: float | None = param(
        LENGTH,
        default=None,
        gt=0,
        le=LARGEST_MODULE,
        example=2.5,
        doc="module, L/(pi*z) with the length L of a pitch curve",
    )
    teeth: tuple[int, int] = param(
        COUNT,
        ge=3,
        le=MOST_TEETH,
        order=WHEELS,
        doc="numbers of teeth, driver first; a ring that turns fully has more than its pinion",
    )
    x: float = param(
        NUMBER,
        default=0.0,
        ge=-1,
        le=1,
        doc="profile shift in modules: +x on wheel 1, -x on wheel 2",
    )
    backlash: float = param(
        LENGTH,
        default=0.0,
        ge=0,
        le=1e4,
        doc="backlash along the pitch curve, of both wheels together",
    )
    face_width: float = positive_length(default=10.0, doc="face width of the wheels")

    rules = (exactly_one("center_distance", "module", note="the other is computed"),)


@dataclass(frozen=True, kw_only=True)
class RingSpec:
    """The rim of a ring, and the pinion cutter for its teeth.

    Examples
    --------
    >>> import gearcam as gc
    >>> gc.RingSpec(outer_diameter=130.0).outer
    'round'
    """

    outer: str = param(
        TEXT,
        default="round",
        choices=("round", "follow"),
        doc="outside of the ring: a circle (round), or parallel to the roots (follow)",
    )
    rim: float | None = positive_length(
        example=6, doc="least rim outside the roots; 2.7 modules if left out"
    )
    outer_diameter: float | None = positive_length(
        example=130, doc="outer diameter of a round ring, instead of rim_mm"
    )
    cutter_teeth: float | None = param(
        NUMBER,
        default=None,
        ge=3,
        le=MOST_TEETH,
        example=30,
        doc="teeth of the pinion cutter, not necessarily whole; if left out, a number that leaves "
        "room for the tips of wheel 1",
    )

    rules = (
        excludes("outer_diameter", "rim"),
        only_with(["outer_diameter"], "outer", "round"),
    )

    def least_rim(self, roots: float, module: float) -> float:
        """Return the least rim outside the roots.

        Parameters
        ----------
        roots : float, mm
            Largest distance of the roots from the axis.
        module : float, mm
            Module.

        Returns
        -------
        float, mm
            0 or less where a round ring of this diameter would cut into the roots.
        """
        if self.outer_diameter is not None:
            return 0.5 * self.outer_diameter - roots
        return self.rim if self.rim is not None else RIM * module


@dataclass(frozen=True, kw_only=True)
class Bar(ShortRepr):
    """The metal behind the teeth of a rack: its height and its ends."""

    height: float | None = positive_length(
        example=20,
        doc="height of a rack from its back to the highest tip; if left out the back "
        "is a module below the roots",
    )
    ends: str = param(
        TEXT,
        default="tooth",
        choices=("tooth", "gap"),
        doc="where a rack ends: in the middle of a tooth, half a pitch beyond its travel, or in "
        "the middle of a gap, after whole teeth; its end face then meets the line of centres at "
        "phi1 = 0, as a timing mark would",
    )


@dataclass(frozen=True, kw_only=True)
class Finish:
    """Clearance and rounding of the toothed edge of a wheel.

    Parameters
    ----------
    clearance : float, mm
        Taken off everywhere, along the normal.
    tip_rounding : float, mm
        Radius of the rounded tip edges.
    """

    clearance: float = 0.0
    tip_rounding: float = 0.0
