"""Blanks: what parts have beside their teeth and cam profiles.

Whatever turns on a shaft may have the same. Of a pair most values are given once for both wheels,
or twice, driver first; 0 means that there is none. A *keyway* is cut into the bore; its depth
counts from the bore's circle, at the middle of the keyway, as in shaft standards. A *D-shaped bore*
has a flat, or two that are parallel. A `shaft` has the sizes of the bore of a motor, a standard
`keyway` those of its key. Bores, keyways and bolt holes may have a tolerance class; they are made
with their nominal size. *Hubs* are raised on the faces: front is +z. *Lightening holes* lie between
hub and rim and are as large as the rim allows. In a *stop slot* runs a pin of the housing, which
limits the travel of an open wheel. *Clearance* is taken off the outline all around, and if
`clearance_bores` is set, off bores, bolt holes and slots too.

Refused when a design is read: sizes that contradict each other, and sizes without those that belong
to them.

Depends on quantities, fits and shafts only.
"""

from __future__ import annotations

from collections.abc import Collection, Iterator
from dataclasses import dataclass, field, fields, make_dataclass, replace
from fractions import Fraction
from typing import TYPE_CHECKING, Any, ClassVar, Final, Self, get_type_hints

from gearcam.base.display import ShortRepr
from gearcam.base.numerals import formatted
from gearcam.base.quantities import (
    ANGLE,
    COUNT,
    DENSITY,
    LENGTH,
    LONGEST,
    NONE,
    TEXT,
    allowance,
    fixed,
    param,
    params_of,
    positive_length,
)
from gearcam.base.rules import Breach, Rule, Values, below, excludes, needs, only_with
from gearcam.parts.fits import FitSize, Fitted
from gearcam.parts.shafts import DIN_6885, KEYWAYS, MOTOR_SHAFTS, SMALLEST, keyway_of

KIND: Final = "parts"
"""The checks of parts."""

_FOLLOWING: Final = (
    "bore_diameter", "keyway_width", "bore_flat", "bore_across_flats", "bolt_diameter", "stop_pin",
)  # fmt: skip
"""Sizes of openings for a shaft, a bolt or a pin."""

_COMMON: Final = ("timing_marks", "mark_diameter", "clearance_bores", "rotation_arrow")
"""Given once for both wheels."""

_SERVES: Final = {
    "keyway_width": ("bore_diameter",),
    "keyway_depth": ("bore_diameter", "keyway_width"),
    "keyway": ("bore_diameter",),
    "keyway_angle": ("keyway_width", "keyway", "bore_flat", "bore_across_flats", "shaft"),
    "bore_flat": ("bore_diameter",),
    "bore_across_flats": ("bore_diameter",),
    "hub_front": ("hub_diameter",),
    "hub_back": ("hub_diameter",),
    "bolt_circle": ("bolts",),
    "bolt_diameter": ("bolts",),
    "bolt_angle": ("bolts",),
    "rim": ("lightening_holes",),
    "web": ("lightening_holes",),
    "set_screw": ("hub_diameter",),
    "set_screw_angle": ("set_screw",),
}
"""What says more of something else, which it needs."""

OPENING_RULES: Final = (
    *(
        needs(name, *others, one=name == "keyway_angle", serves=True)
        for name, others in _SERVES.items()
    ),
    needs("set_screw", "bore_diameter", "shaft", one=True, serves=True),
    needs("keyway_width", "keyway_depth"),
    below("keyway_width", "bore_diameter", why="is as wide as the bore"),
    excludes("keyway", "keyway_width", "keyway_depth",
             allowed="keyway alone, or keyway_width_mm with keyway_depth_mm"),
    excludes("bore_flat", "keyway_width", "keyway"),
    excludes("bore_across_flats", "bore_flat", "keyway_width", "keyway"),
    below("bore_across_flats", "bore_diameter", why="is as wide as the bore"),
    excludes("shaft", "bore_diameter", "bore_flat", "bore_across_flats", "keyway_width", "keyway",
             allowed="shaft alone, or the sizes of the bore without it"),
    needs("hub_diameter", "hub_front", "hub_back", one=True),
    needs("bolts", "bolt_circle", "bolt_diameter"),
)  # fmt: skip
"""Rules for bore, hub and holes."""

TAPPED: Final = {
    "M2": 1.6, "M2.5": 2.05, "M3": 2.5, "M4": 3.3, "M5": 4.2, "M6": 5.0, "M8": 6.8, "M10": 8.5,
    "M12": 10.2, "#4-40": 2.26, "#6-32": 2.71, "#8-32": 3.45, "#10-24": 3.8, "#10-32": 4.04,
    "1/4-20": 5.11, "5/16-18": 6.53, "3/8-16": 7.94,
}  # fmt: skip
"""Tapping drills of threads, mm: coarse ones of ISO 2306, and usual ones of the unified thread
(numbers 43, 36, 29, 25, 21 and 7, letter F, 5/16 in)."""


def thread_diameter(size: str) -> float:
    """Return the nominal diameter of a thread, mm, by its `size` in `TAPPED`."""
    word = size.partition("-")[0]
    if word[0] == "M":
        return float(word[1:])
    return 25.4 * (0.06 + 0.013 * int(word[1:]) if word[0] == "#" else float(Fraction(word)))


def serving(names: Collection[str]) -> set[str]:
    """Return the names of the values that say more of some things, at any remove."""
    found = {name for name, others in _SERVES.items() if not {*names}.isdisjoint(others)}
    return found if found <= {*names} else serving({*names, *found})


def widening_rules(*openings: str) -> tuple[Rule, ...]:
    """Return the rules for ``clearance_bores`` of a blank that may have some `openings`."""
    return (
        needs("clearance_bores", "clearance", serves=True),
        needs("clearance_bores", *openings, one=True, serves=True),
        Rule(_widened_fits),
    )


def _widened_fits(values: Values) -> Iterator[Breach]:
    """Yield sizes that would be widened though their tolerance class says how wide they are."""
    for name in _FOLLOWING if values["clearance_bores"].given else ():
        size = values[name].right if name in values else None
        if isinstance(size, FitSize):
            what = f"would widen {values[name].text}, which has a tolerance class"
            rule = f"without {values['clearance_bores'].key}, or a size without a class"
            yield "clearance_bores", None, what, rule


def _length(*, doc: str, default: float | None = 0.0, **more: Any) -> Any:
    """Return a length; 0 means that there is nothing to measure."""
    bounds = {"ge": 0, "le": LONGEST, "zero_is_none": True}
    return param(LENGTH, default=default, doc=doc, **{**bounds, **more})


def _flag(*, doc: str, default: bool = False) -> Any:
    return param(TEXT, default=default, doc=doc)


def _word(*words: str, doc: str) -> Any:
    return param(TEXT, default=NONE, choices=(NONE, *words), zero_is_none=True, doc=doc)


def _angle(*, doc: str) -> Any:
    return param(ANGLE, default=0.0, ge=-360, le=360, doc=f"{doc} in the part's frame")


def _count(*, doc: str, le: int) -> Any:
    return param(COUNT, default=0, ge=0, le=le, zero_is_none=True, doc=doc)


ZERO_MARK: Final = "whether a mark in the front face shows where the follower begins its motion"
"""Meaning of a key."""


@dataclass(frozen=True, kw_only=True)
class ShaftBlank(ShortRepr, Fitted):
    """Bore, hub, holes and marks of what turns on a shaft, mm and rad; 0 or None means none.

    Parameters
    ----------
    stop_pin, timing_marks, mark_diameter, clearance, clearance_bores, tip_rounding
        They belong to edges that are cut, and to teeth.

    Examples
    --------
    >>> import gearcam as gc
    >>> blank = gc.CylinderBlank(bore_diameter=16.0, hub_diameter=30.0, hub_front=10.0)
    >>> blank.bore_reach
    8.0
    """

    bore_diameter: float | None = _length(
        default=None, example=20, doc="diameter of the bore; no bore if left out", fit=True
    )
    shaft: str = _word(
        *MOTOR_SHAFTS, doc="motor for whose shaft the bore is; shafts differ: measure yours"
    )
    keyway: str = _word(
        DIN_6885, doc="standard keyway: width and depth by the bore, DIN 6885-1, the width with JS9"
    )
    keyway_width: float = _length(doc="width of the keyway", fit=True)
    keyway_depth: float = _length(doc="depth of the keyway from the bore's circle, at its middle")
    keyway_angle: float = _angle(doc="direction of the keyway, or of a flat")
    bore_flat: float = _length(doc="D-shaped bore: flat to opposite side, more than half the bore")
    bore_across_flats: float = _length(doc="bore with two flats: from one to the other")
    bolts: int = _count(doc="number of bolt holes", le=100)
    bolt_circle: float = _length(doc="diameter of the bolt circle")
    bolt_diameter: float = _length(doc="diameter of each bolt hole", fit=True)
    bolt_angle: float = _angle(doc="direction of the first bolt hole")
    hub_diameter: float = _length(doc="diameter of the hub, larger than the bore with its keyway")
    hub_front: float = _length(doc="height of the hub on the front face (+z)")
    hub_back: float = _length(doc="height of the hub on the back face")
    set_screw: str = _word(
        *TAPPED,
        doc="set screw in the middle of the hub (of the one in front if there are two), made with "
        "its tapping drill",
    )
    set_screw_angle: float = _angle(doc="direction of the set screw, from the keyway or the flat")
    lightening_holes: int = _count(doc="number of round lightening holes", le=36)
    rim: float | None = _length(
        default=None,
        example=6,
        doc="least metal between lightening holes and the edge or groove around them; if left out "
        "2.7 modules, two thirds of the thickness of a cam, or the depth of a groove",
    )
    web: float | None = _length(
        default=None,
        example=5,
        doc="least metal between lightening holes, and from them to bore, hub and bolt holes; the "
        "rim if left out",
    )
    chamfer: float = _length(
        doc="chamfer of the edges of both faces, at 45 deg: of outline, hub and bore", le=100
    )
    rotation_arrow: bool = _flag(doc="whether an arrow in the front face shows how the part turns")
    zero_mark: bool = _flag(doc=ZERO_MARK)
    density: float | None = param(
        DENSITY,
        default=None,
        gt=0,
        le=1e5,
        example=7850,
        doc="density, for mass, centre of mass, unbalance and inertia",
    )
    stop_pin: float = fixed(0.0)
    timing_marks: bool = fixed(False)
    mark_diameter: float | None = fixed(None)
    clearance: float = fixed(0.0)
    clearance_bores: bool = fixed(False)
    tip_rounding: float = fixed(0.0)

    @property
    def sized(self) -> Self:
        """The blank with the sizes of its shaft and of its keyway in place of their names."""
        sizes: dict[str, Any] = dict(MOTOR_SHAFTS.get(self.shaft, {}))
        if self.keyway == DIN_6885 and (key := keyway_of(self.bore_diameter or 0.0)):
            sizes |= {"keyway_width": key.hub_width, "keyway_depth": key.hub_depth}
        return replace(self, shaft=NONE, keyway=NONE, **sizes) if sizes else self

    @property
    def bore(self) -> float:
        """Diameter of the bore, mm; 0 without one."""
        return self.sized.bore_diameter or 0.0

    @property
    def bore_reach(self) -> float:
        """Largest radius of the bore, mm: at the corners of its keyway, or its own."""
        sized = self.sized
        if not sized.bore_diameter or not sized.keyway_width:
            return 0.5 * (sized.bore_diameter or 0.0)
        floor = 0.5 * sized.bore_diameter + sized.keyway_depth
        return float((floor**2 + 0.25 * sized.keyway_width**2) ** 0.5)

    @property
    def plain(self) -> bool:
        """Whether it has a round bore, and nothing else that is made."""
        sized = self.sized
        flats = (sized.keyway_width, sized.bore_flat, sized.bore_across_flats)
        rest = (self.bolts, self.hub_diameter, self.chamfer, self.lightening_holes)
        return not any((*flats, *rest, self.rotation_arrow, self.zero_mark))

    @property
    def widening(self) -> float:
        """By how much bores, bolt holes and stop slots are widened, mm."""
        return 2.0 * self.clearance if self.clearance_bores else 0.0

    @property
    def widened(self) -> Self:
        """The blank with the widened sizes of its bore, bolt holes and stop slot.

        A keyway keeps its depth, which counts from the widened bore.
        """
        sized = self.sized
        if not self.clearance_bores:  # it may be fixed, and then cannot be replaced
            return sized
        sizes = {name: getattr(sized, name) for name in _FOLLOWING}
        wider = {name: size + self.widening for name, size in sizes.items() if size}
        return replace(sized, clearance_bores=False, **wider)

    rules = OPENING_RULES

    def problems(self) -> Iterator[Breach]:
        """Yield what is wrong by reading: field, None, message, allowed."""
        half, reach = 0.5 * self.bore, 2.0 * self.bore_reach
        if self.bore and self.bore_flat and not half < self.bore_flat < self.bore:
            rule = f"above {formatted(half)} and below the bore's {formatted(self.bore)} mm"
            yield "bore_flat", None, "the flat is not within the bore", rule
        if self.keyway == DIN_6885 and self.bore and keyway_of(self.bore) is None:
            what = f"the standard has no keyway in a bore of {formatted(self.bore)} mm"
            rule = f"bores from {formatted(SMALLEST)} to {formatted(KEYWAYS[-1].largest)} mm"
            yield "keyway", None, what, rule
        if self.hub_diameter and self.hub_diameter <= reach:
            rule = f"above {formatted(reach)} mm, the diameter across the bore"
            yield "hub_diameter", None, "the bore is as large as the hub", rule
        if 0.0 < self.bore <= TAPPED.get(self.set_screw, 0.0):
            narrow = [f'"{name}"' for name, drill in TAPPED.items() if drill < self.bore]
            rule = ", ".join(narrow) or "a larger bore"
            yield "set_screw", None, "the hole of the screw is as wide as the bore", rule


@dataclass(frozen=True, kw_only=True)
class CylinderBlank(ShaftBlank):
    """Bore, hub, holes, marks and material of a cam in space.

    Attributes
    ----------
    stop_pin, timing_marks, mark_diameter, clearance, clearance_bores, tip_rounding
        They belong to edges that are cut, and to teeth.

    Examples
    --------
    >>> import gearcam as gc
    >>> gc.CylinderBlank(bore_diameter=20.0, density=7850.0)
    CylinderBlank(bore_diameter=20, density=7850)
    """

    without: ClassVar[str] = "a cam in space has what parts on shafts have, and no edge that is cut"
    """Why it does not have what other blanks have."""


@dataclass(frozen=True, kw_only=True)
class WheelBlank(ShaftBlank):
    """Bore, hub, holes, marks and edges of one wheel, mm and rad; 0 or None means none.

    Attributes
    ----------
    zero_mark
        A wheel has timing marks.

    Examples
    --------
    >>> import gearcam as gc
    >>> blank = gc.WheelBlank(bore_diameter=16.0, keyway_width=5.0, keyway_depth=2.3)
    >>> round(blank.bore_reach, 3)
    10.599
    """

    zero_mark: bool = fixed(False)
    stop_pin: float = _length(doc="diameter of the stop pin, which runs in a slot of an open wheel")
    timing_marks: bool = _flag(default=True, doc="whether timing marks face each other at phi1 = 0")
    mark_diameter: float | None = positive_length(
        example=1, doc="diameter of the timing marks; 0.4 modules if left out"
    )
    clearance: float = allowance(doc="what is taken off the toothed edge, along its normal")
    clearance_bores: bool = _flag(
        doc="whether bores, bolt holes and stop slots are widened by the clearance too"
    )
    tip_rounding: float = _length(doc="radius of the rounded tip edges of the teeth", le=100)

    rules = (
        *OPENING_RULES,
        *widening_rules("bore_diameter", "shaft", "bolts", "stop_pin"),
        only_with(("mark_diameter",), "timing_marks", True),
    )


@dataclass(frozen=True, kw_only=True)
class RowBlank(ShortRepr, Fitted):
    """A row of mounting holes in what slides.

    Attributes
    ----------
    height : float or None, mm
        Of what they are in; each has its own.
    """

    height: float | None = fixed(None)
    bolts: int = _count(doc="number of mounting holes in a row", le=100)
    bolt_diameter: float = _length(doc="diameter of each mounting hole", fit=True)
    bolt_spacing: float | None = positive_length(
        example=60, doc="distance of the holes in the row, centred on the length"
    )
    bolt_height: float | None = positive_length(
        example=10, doc="from the back, the edge opposite to the profile, to the row of holes"
    )

    rules = (
        needs("bolts", "bolt_diameter", "bolt_height"),
        *(needs(f"bolt_{size}", "bolts") for size in ("diameter", "height", "spacing")),
    )

    @property
    def places(self) -> dict[str, float]:
        """Keys that place the row, and that of its room, with their values, mm."""
        sizes = {
            "bolt_spacing_mm": self.bolt_spacing,
            "bolt_height_mm": self.bolt_height,
            "height_mm": self.height,
        }
        return {key: size for key, size in sizes.items() if size is not None}

    def problems(self) -> Iterator[Breach]:
        """Yield contradictions: field, index, message, what is allowed."""
        if self.bolts > 1 and self.bolt_spacing is None:
            yield "bolt_spacing", None, "is missing beside bolts", "bolts with bolt_spacing_mm"
        if self.bolts == 1 and self.bolt_spacing is not None:
            message, rule = "a single bolt has no distance to another", "2 bolts or more"
            yield "bolt_spacing", None, message, rule


def _both(name: str, hint: Any, default: Any) -> tuple[str, Any, Any]:
    """Return a field of `WheelBlank` as `make_dataclass` takes it, with a value for each wheel."""
    made = params_of(WheelBlank)[name]
    if name not in _COMMON:
        made, hint = replace(made, both=True), tuple[hint, hint]
        default = None if default is None else (default, default)
    return name, hint, field(default=default, metadata={"param": made})


if TYPE_CHECKING:

    class _BothWheels:
        __dataclass_fields__: ClassVar[dict[str, Any]]

        def __init__(self, **sizes: tuple[float | None, float | None] | float | None) -> None: ...

        def __getattr__(self, name: str) -> Any: ...

else:
    _BothWheels = make_dataclass(
        "_BothWheels",
        [
            _both(one.name, get_type_hints(WheelBlank)[one.name], one.default)
            for one in fields(WheelBlank)
            if one.init
        ],
        bases=(Fitted,),
        frozen=True,
        kw_only=True,
    )


class Blank(ShortRepr, _BothWheels):
    """Bores, hubs, holes, marks and edges of both wheels, each value given once or driver first.

    Examples
    --------
    >>> import gearcam as gc
    >>> blank = gc.Blank(bore_diameter=(10.0, 12.0), tip_rounding=(0.1, 0.1))
    >>> blank.wheel(2).bore_diameter
    12.0
    """

    def wheel(self, number: int) -> WheelBlank:
        """Return what is wanted of one wheel: `number` 1 is the driver."""
        values = {one.name: getattr(self, one.name) for one in fields(self)}
        own = {name: v[number - 1] if isinstance(v, tuple) else v for name, v in values.items()}
        return WheelBlank(**own)

    rules = WheelBlank.rules

    def problems(self) -> Iterator[Breach]:
        """Yield what is wrong by reading: field, wheel, message, allowed."""
        for number in (1, 2):
            for name, _, message, rule in self.wheel(number).problems():
                yield name, number - 1, message, rule
