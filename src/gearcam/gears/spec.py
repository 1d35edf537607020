"""What a design says of a gear pair: the pair, the rack and nothing computed."""

from __future__ import annotations

from dataclasses import dataclass

from gearcam.display import Brief
from gearcam.quantities import ANGLE, COUNT, LENGTH, NUMBER, TEXT, param

RIM = 2.7
"""Rim beyond the roots, in modules, where the design gives none: 1.2 tooth depths."""


@dataclass(frozen=True, kw_only=True)
class Rack:
    """The basic rack as it is asked for; heights in modules.

    What is left out takes its default of `BasicRack`, or what fits to the values given (see
    `settle_rack`).

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
        doc="tooth height above the pitch curve, in modules; default 1, other where given values "
        "leave no room for it",
    )
    dedendum: float | None = param(
        NUMBER,
        default=None,
        gt=0.1,
        le=2.5,
        doc="depth below the pitch curve, in modules; default 1.25, other where given values leave "
        "no room for it",
    )
    tip_radius: float | None = param(
        NUMBER,
        default=None,
        ge=0,
        le=1,
        doc="rounding of the cutter's tip, in modules; default 0.38, less where it does not fit",
    )


@dataclass(frozen=True, kw_only=True)
class BasicRack:
    """The basic rack as it is used; the defaults are the common full-depth rack.

    The tip radius is the largest that leaves a land: 0.38 leaves a straight flank to 0.999968
    modules.

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

    def yielded(self, asked: Rack) -> dict[str, float]:
        """Return the defaults that gave way to what is `asked` for: their values, by name."""
        return {
            name: default
            for name in ("addendum", "dedendum", "tip_radius")
            if getattr(asked, name) is None
            and getattr(self, name) != (default := getattr(BasicRack, name))
        }


@dataclass(frozen=True, kw_only=True)
class StepsSpec:
    """Stepped wheels: each step is cut for itself, its teeth moved along the pitch curve.

    The teeth of a non-circular wheel cannot follow a helix by twisting: every place of the
    centrode bends differently. Steps of the same height, the teeth of each moved on by `offset`
    along both centrodes, take turns in the mesh as those of a helical wheel do.

    Examples
    --------
    >>> import gearcam as gc
    >>> gc.StepsSpec(count=3).count
    3
    """

    count: int = param(
        COUNT, default=1, ge=1, le=100, doc="steps over the width; 1 for spur wheels"
    )
    offset: float | None = param(
        LENGTH,
        default=None,
        ge=-1e4,
        le=1e4,
        doc="way of each step's teeth along the pitch curves against the one below; the pitch over "
        "the steps if left out",
    )


@dataclass(frozen=True, kw_only=True)
class PairSpec(Brief):
    """Exactly one of centre distance and module is given; the other is solved.

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
        doc="whether wheel 2 is a wheel beside wheel 1, or a ring around it",
    )
    center_distance: float | None = param(
        LENGTH, default=None, gt=0, le=1e6, doc="distance of the shafts"
    )
    module: float | None = param(LENGTH, default=None, gt=0, le=1e4, doc="module L/(pi*z)")
    teeth: tuple[int, int] = param(
        COUNT, ge=3, le=10000, doc="tooth counts, driver first; a closed ring has the more"
    )
    x: float = param(
        NUMBER, default=0.0, ge=-1, le=1, doc="profile shift in modules: + on wheel 1, - on wheel 2"
    )
    backlash: float = param(
        LENGTH, default=0.0, ge=0, le=1e4, doc="backlash along the pitch curve, of both wheels"
    )
    face_width: float = param(LENGTH, default=10.0, gt=0, le=1e5, doc="width of the wheels")


@dataclass(frozen=True, kw_only=True)
class RingSpec:
    """The metal around the teeth of a ring, and the pinion cutter that cuts them.

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
        doc="outside of the ring: a circle, or parallel to the roots",
    )
    rim: float | None = param(
        LENGTH,
        default=None,
        gt=0,
        le=1e6,
        doc="least metal outside the roots; 2.7 modules if left out",
    )
    outer_diameter: float | None = param(
        LENGTH, default=None, gt=0, le=1e6, doc="diameter of a round outside, in place of the rim"
    )
    cutter_teeth: float | None = param(
        NUMBER,
        default=None,
        ge=3,
        le=10000,
        doc="teeth of the pinion cutter, whole or not; if left out, as many as leave room for the "
        "mate's tips",
    )

    def least_rim(self, roots: float, module: float) -> float:
        """Return the least metal outside the roots.

        Parameters
        ----------
        roots : float, mm
            Largest distance of the roots from the axis.
        module : float, mm
            Module.

        Returns
        -------
        float, mm
            Not positive where a round outside would reach the roots.
        """
        if self.outer_diameter is not None:
            return 0.5 * self.outer_diameter - roots
        return self.rim if self.rim is not None else RIM * module


@dataclass(frozen=True, kw_only=True)
class Finish:
    """What is taken off the toothed edge of a wheel as it is made.

    Parameters
    ----------
    clearance : float, mm
        Everywhere along the normal.
    tip_rounding : float, mm
        Radius of the rounded edges of the tips.
    """

    clearance: float = 0.0
    tip_rounding: float = 0.0
