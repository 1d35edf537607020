"""The geometry of a follower on its cam: its position at zero lift, and its range.

Points of the plane are complex numbers, mm. Fixed frame: the cam's axis is the origin; a
translating follower moves along ``+y``; the pivot of an oscillating one is at ``(d, 0)``, and
``Psi``, the angle between its arm and the line from pivot to cam, grows with the lift (the arm
turns clockwise). The *position* of a follower at zero lift, to which the lift is added, is:

==================== ==========================================================
translating round    height of the centre, ``s0 = sqrt(prime^2 - e^2)``
translating flat     height of the face, the base radius
oscillating round    ``Psi0 = arccos((d^2 + l^2 - prime^2)/(2*d*l))``
oscillating flat     ``Psi0 = arcsin((base + f)/d)``, the face f nearer the cam
==================== ==========================================================

A roller *below* the axis, the second on one follower, has a negative position; the formulas of the
first are valid for it unchanged.

A cam that *slides* moves along ``-x`` by its travel ``u = slide*theta``, so that the whole travel
is one turn: statements about cam angles stay valid, and a `Driver` converts to travel for output.
(Output is the mirror image, which moves along ``+x``.) Its follower translates along ``+y`` turned
by a *tilt*, counter-clockwise, or its arm points from the pivot at ``(-d, p)`` towards ``+x``:

==================== ==========================================================
translating round    the lift itself, ``C = i*exp(i*tilt)*s``
oscillating round    ``Psi0 = -arcsin(p/l)``, ``C = -d + i*p + l*exp(i*Psi)``
==================== ==========================================================

Refused: followers that cannot touch the cam at zero lift.

Sources: 000 section 3.4.2 (3.14), (3.15); section 3.4.3 (3.28).
"""

from __future__ import annotations

import math
from dataclasses import dataclass, replace
from functools import cached_property

from gearcam.base.display import Brief
from gearcam.base.errors import InfeasibleError, Way
from gearcam.base.numerals import shown
from gearcam.cams.carriers import Carrier, Rotating, Sliding
from gearcam.cams.followers import Arm, FlatArm, FlatStem, Follower, Round, Stem, swing
from gearcam.cams.spec import CamSpec, FollowerSpec


@dataclass(frozen=True, kw_only=True)
class Driver(Brief):
    """Name and unit of a cam's angle or travel in output.

    Parameters
    ----------
    symbol, unit, per : str
        Symbol and unit of angle or travel, as in names of columns; unit of the variable of
        derivatives.
    called : str
        Its name in words.
    scale : float
        Angle or travel, in the unit, per rad.
    rate : float
        Variable of derivatives per rad.
    """

    symbol: str
    unit: str
    per: str
    called: str
    scale: float
    rate: float

    @property
    def turn(self) -> float:
        """Whole turn or travel, in the unit."""
        return 2.0 * math.pi * self.scale

    @property
    def column(self) -> str:
        """The name of its column."""
        return f"{self.symbol}_{self.unit}"

    def told(self, theta: float) -> str:
        """Return an angle, rad, as text with its unit, with rounding shown as 0."""
        return f"{shown(self.scale * theta, scale=self.turn)} {self.unit}"

    def seen(self, theta: float) -> str:
        """Return a position as text."""
        return f"at {self.told(theta)}"


TURNING = Driver(
    symbol="theta", unit="deg", per="rad", called="cam angle", scale=math.degrees(1.0), rate=1.0
)
"""A cam that turns."""


@dataclass(frozen=True, kw_only=True)
class Mechanism(Brief):
    """A follower and the cam's axis, turning counter-clockwise; or a cam that slides along ``-x``.

    Parameters
    ----------
    flat, oscillating : bool
        Type of the follower.
    start : float, mm or rad
        Position at zero lift.
    radius : float, mm
        Radius of a round face; 0 for a point or a flat face.
    offset : float, mm
        e, offset of a translating follower's axis.
    arm, pivot : float, mm
        l and d of an oscillating follower.
    face_offset : float, mm
        f of an oscillating flat follower.
    slide : float, mm/rad
        Travel per rad of a cam that slides; 0 for one that turns.
    tilt : float, rad
        Tilt of a translating follower's direction over a cam that slides.
    height : float, mm
        p, height of the pivot over a cam that slides.
    """

    flat: bool
    oscillating: bool
    start: float
    radius: float = 0.0
    offset: float = 0.0
    arm: float = 0.0
    pivot: float = 0.0
    face_offset: float = 0.0
    slide: float = 0.0
    tilt: float = 0.0
    height: float = 0.0

    @property
    def driver(self) -> Driver:
        """Name and unit of the cam's angle or travel in output."""
        if not self.slide:
            return TURNING
        return Driver(
            symbol="u", unit="mm", per="mm", called="travel", scale=self.slide, rate=self.slide
        )

    @cached_property
    def follower(self) -> Follower:
        """The follower itself."""
        if self.flat:
            if self.oscillating:
                return FlatArm(start=self.start, pivot=self.pivot, offset=self.face_offset)
            return FlatStem(start=self.start, offset=self.offset)
        start, radius = self.start, abs(self.radius)
        if not self.oscillating:
            return Stem(start=start, radius=radius, offset=self.offset, tilt=self.tilt)
        pivot, hand = (complex(-self.pivot, self.height), -1) if self.slide else (self.pivot, 1)
        return Arm(start=start, radius=radius, arm=self.arm, pivot=complex(pivot), hand=hand)

    @property
    def centred(self) -> Round:
        """The follower, if it has a centre.

        Raises
        ------
        TypeError
            If it is flat.
        """
        if not isinstance(self.follower, Round):
            raise TypeError("a flat face has no centre")
        return self.follower

    @cached_property
    def carrier(self) -> Carrier:
        """What the cam does beneath it."""
        return Sliding(self.slide) if self.slide else Rotating()

    @property
    def lever(self) -> float:
        """Factor from lift to millimetres: 1, or the arm (for a flat face the pivot distance)."""
        return (self.arm or self.pivot) if self.oscillating else 1.0

    @property
    def outward(self) -> tuple[float, str]:
        """Factor from lift, mm or rad, to its unit in output, and that unit: mm or deg."""
        return (math.degrees(1.0), "deg") if self.oscillating else (1.0, "mm")

    @property
    def motion_scales(self) -> dict[str, float]:
        """Names of the motion's columns in output, with factors from internal units.

        The lift and its first three derivatives, in this order.
        """
        (scale, unit), driver = self.outward, self.driver
        names = ("lift_{}", "velocity_{}_per_{}", "acceleration_{}_per_{}2", "jerk_{}_per_{}3")
        return {
            name.format(unit, driver.per): scale / driver.rate**order
            for order, name in enumerate(names)
        }

    @property
    def below(self) -> bool:
        """Whether a round follower is below the axis, and comes nearer to it as it rises."""
        return not (self.flat or self.slide) and self.start < 0.0

    @property
    def away(self) -> int:
        """Whether a rise moves it away from the metal (1) or towards it (-1).

        Towards it at a wall outside the pitch curve, whose radius is negative, or below the axis.
        """
        return -1 if self.below != (self.radius < 0.0) else 1

    @property
    def least(self) -> float:
        """Distance from the axis to a round follower's centre or to a flat face, at zero lift.

        For a cam that turns.
        """
        return self.follower.distance(self.start)


def make_mechanism(follower: FollowerSpec, cam: CamSpec) -> Mechanism:
    """Return the geometry of a follower on its cam.

    Parameters
    ----------
    follower : FollowerSpec
        The follower.
    cam : CamSpec
        The cam, with the prime or base radius that the follower needs.

    Returns
    -------
    Mechanism

    Raises
    ------
    InfeasibleError
        If the follower cannot touch the cam at zero lift.
    """
    kind = {"flat": follower.flat, "oscillating": follower.oscillating, "radius": follower.radius}
    size = cam.prime_radius
    if size is None:
        size = _given(cam.base_radius, "a prime or base radius") + follower.radius
    if not follower.oscillating:
        if follower.flat:
            return Mechanism(start=size, offset=follower.offset, **kind)
        if not abs(follower.offset) < size:
            raise InfeasibleError(
                "the follower's axis misses the prime circle",
                where="follower.offset_mm",
                value=abs(follower.offset),
                limit=size,
                unit="mm",
                nearest="the offset, to either side, must be below the prime radius",
                ways=(
                    Way(
                        near={"follower.offset_mm": math.copysign(size, follower.offset)},
                        far={"follower.offset_mm": 0.0},
                    ),
                ),
            )
        made = Mechanism(start=0.0, offset=follower.offset, **kind)
        return replace(made, start=position_at(made, size))
    pivot = _given(follower.pivot_distance, "a pivot distance")
    if follower.flat:
        return _swinging_face(follower, size, pivot)
    arm = _given(follower.arm, "an arm")
    low, high = abs(pivot - arm), pivot + arm
    if not low < size < high:
        what, parts = "the arm cannot reach the prime circle", "arm and pivot"
        key, least = "follower.pivot_distance_mm", abs(arm - size)
        near = least if pivot <= least else arm + size
        way = Way(near={key: near}, far={key: max(arm, size)})
        raise _out_of_reach(what, "cam.prime_radius_mm", parts, size, low, high, way)
    return Mechanism(start=float(swing(pivot, arm, size)), arm=arm, pivot=pivot, **kind)


def position_at(mechanism: Mechanism, size: float) -> float:
    """Return the position, mm or rad, of a follower at a given distance from the axis.

    Parameters
    ----------
    mechanism : Mechanism
        The follower on a cam that turns.
    size : float, mm
        From the axis to its centre, or to its flat face.

    Raises
    ------
    ValueError
        If it cannot reach there.
    """
    m = mechanism
    if not m.oscillating:
        return size if m.flat else math.sqrt((size - m.offset) * (size + m.offset))
    return (
        math.asin((size + m.face_offset) / m.pivot)
        if m.flat
        else float(swing(m.pivot, m.arm, size))
    )


def make_sliding_mechanism(follower: FollowerSpec, way: float) -> Mechanism:
    """Return the geometry of a follower over a cam that slides.

    Parameters
    ----------
    follower : FollowerSpec
        The follower, round.
    way : float, mm
        Travel of the cam.

    Returns
    -------
    Mechanism

    Raises
    ------
    InfeasibleError
        If the arm does not reach the height of zero lift.
    """
    kind = {"flat": False, "radius": follower.radius, "slide": way / (2.0 * math.pi)}
    if not follower.oscillating:
        return Mechanism(oscillating=False, start=0.0, tilt=follower.axis or 0.0, **kind)
    arm, height = _given(follower.arm, "an arm"), follower.pivot_height or 0.0
    if not abs(height) < arm:
        raise InfeasibleError(
            "the arm does not reach down to zero lift"
            if height > 0.0
            else "the arm does not reach up to zero lift",
            where="follower.pivot_height_mm",
            value=height,
            limit=math.copysign(arm, height),
            unit="mm",
            nearest="the pivot height must be below the arm length, the limit",
            ways=(
                Way(
                    near={"follower.pivot_height_mm": math.copysign(arm, height)},
                    far={"follower.pivot_height_mm": 0.0},
                ),
            ),
        )
    pivot = _given(follower.pivot_distance, "a pivot distance")
    start = -math.asin(height / arm)
    return Mechanism(oscillating=True, start=start, arm=arm, pivot=pivot, height=height, **kind)


def _out_of_reach(
    what: str, key: str, parts: str, size: float, low: float, high: float, *ways: Way
) -> InfeasibleError:
    """Return the error for a size outside the range that the parts allow."""
    limit, least = low if size <= low else high, max(low, 0.0)
    if high > 0.0:  # from the limit that the size exceeds to the middle of the allowed range
        near = least if size <= least else high
        ways = (Way(near={key: near}, far={key: 0.5 * (least + high)}), *ways)
    return InfeasibleError(
        what,
        where=key,
        value=size,
        limit=limit,
        unit="mm",
        nearest=f"{parts} allow sizes between {shown(least)} and {shown(high)} mm",
        ways=ways,
    )


def _given(value: float | None, what: str) -> float:
    if value is None:
        raise ValueError(f"this follower needs {what}")
    return value


def _swinging_face(follower: FollowerSpec, size: float, pivot: float) -> Mechanism:
    reach = size + follower.face_offset
    if not abs(reach) < pivot:
        low, high = -pivot - follower.face_offset, pivot - follower.face_offset
        what, parts = "the face cannot touch the base circle", "pivot and face offset"
        way = Way(far={"follower.face_offset_mm": 0.0})
        raise _out_of_reach(what, "cam.base_radius_mm", parts, size, low, high, way)
    return Mechanism(
        flat=True,
        oscillating=True,
        start=math.asin(reach / pivot),
        pivot=pivot,
        face_offset=follower.face_offset,
    )
