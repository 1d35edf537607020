"""The numbers of a follower on its cam: where it stands at zero lift, and what it can reach.

Points of the plane are complex numbers, mm. Fixed frame: the cam's axis is the origin; a
translating follower moves along ``+y``; the pivot of an oscillating one is at ``(d, 0)``, and
``Psi``, the angle between its arm and the line from pivot to cam, grows with the lift (the arm
turns clockwise). The *position* of a follower is what its lift is added to:

==================== ==========================================================
translating round    height of the centre, ``s0 = sqrt(prime^2 - e^2)``
translating flat     height of the face, the base radius
oscillating round    ``Psi0 = arccos((d^2 + l^2 - prime^2)/(2*d*l))``
oscillating flat     ``Psi0 = arcsin((base + f)/d)``, the face f nearer the cam
==================== ==========================================================

A roller *below* the axis, the second on one follower, has a negative position; all formulas of the
first hold for it as they stand.

A cam that *slides* moves along ``-x`` by its way ``u = slide*theta``, so that a whole way is one
turn: what is said of cam angles holds, and a `Driver` tells the way to people. (People see the
mirror image, which moves along ``+x``.) Its follower translates along ``+y`` turned by a *tilt*,
counter-clockwise, or its arm points from the pivot at ``(-d, p)`` towards ``+x``:

==================== ==========================================================
translating round    the lift itself, ``C = i*exp(i*tilt)*s``
oscillating round    ``Psi0 = -arcsin(p/l)``, ``C = -d + i*p + l*exp(i*Psi)``
==================== ==========================================================

Refused: followers that cannot touch the cam at zero lift.

Sources: 000 section 3.4.2 (3.14), (3.15); section 3.4.3 (3.28).
"""

from __future__ import annotations

import cmath
import math
from dataclasses import dataclass, replace

import numpy as np

from gearcam.cams.spec import CamSpec, FollowerSpec
from gearcam.display import Brief
from gearcam.errors import InfeasibleError, Way
from gearcam.numerals import shown
from gearcam.numeric.arrays import Array, Plane


@dataclass(frozen=True, kw_only=True)
class Driver(Brief):
    """How the place of a cam is told to people.

    Parameters
    ----------
    symbol, unit, per : str
        Of its angle or way, as in the names of columns; what derivatives are taken by.
    called : str
        What it is.
    scale : float
        Angle or way, in the unit, of one rad.
    rate : float
        What one rad is of what derivatives are taken by.
    """

    symbol: str
    unit: str
    per: str
    called: str
    scale: float
    rate: float

    @property
    def turn(self) -> float:
        """What is gone when a program is over, in the unit."""
        return 2.0 * math.pi * self.scale

    @property
    def column(self) -> str:
        """The name of its column."""
        return f"{self.symbol}_{self.unit}"

    def told(self, theta: float) -> str:
        """Return an angle, rad, as people are told, with its unit: rounding shows as nothing."""
        return f"{shown(self.scale * theta, scale=self.turn)} {self.unit}"

    def seen(self, theta: float) -> str:
        """Return a place for people."""
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
        Its kind.
    start : float, mm or rad
        Position at zero lift.
    radius : float, mm
        Of a round face; 0 of a point or a flat one.
    offset : float, mm
        e, of a translating follower's axis.
    arm, pivot : float, mm
        l and d of an oscillating follower.
    face_offset : float, mm
        f of an oscillating flat follower.
    slide : float, mm/rad
        Way of a cam that slides; 0 of one that turns.
    tilt : float, rad
        Of a translating follower's way over a cam that slides.
    height : float, mm
        p, of the pivot over a cam that slides.
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
        """How the cam's place is told to people."""
        if not self.slide:
            return TURNING
        return Driver(
            symbol="u", unit="mm", per="mm", called="way", scale=self.slide, rate=self.slide
        )

    def sliding_centre(self, position: Array) -> Plane:
        """Return centres of a round follower over a cam that slides, in the fixed frame."""
        if not self.oscillating:
            return np.asarray(1j * cmath.exp(1j * self.tilt) * position, dtype=np.complex128)
        arm = self.arm * np.exp(1j * position)
        return np.asarray(complex(-self.pivot, self.height) + arm, dtype=np.complex128)

    @property
    def lever(self) -> float:
        """What turns a lift into millimetres: 1, or the arm (of a flat face the pivot's way)."""
        return (self.arm or self.pivot) if self.oscillating else 1.0

    @property
    def outward(self) -> tuple[float, str]:
        """What turns a lift, mm or rad, into what people are told, and the unit: mm or deg."""
        return (math.degrees(1.0), "deg") if self.oscillating else (1.0, "mm")

    @property
    def motion_scales(self) -> dict[str, float]:
        """Names of what people are told of the motion, and what makes them of inner units.

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
        """Whether a round follower stands below the axis, and comes nearer as it rises."""
        return not (self.flat or self.slide) and self.start < 0.0

    @property
    def away(self) -> int:
        """Whether a rise moves it away from the metal (1) or to it (-1).

        To it at a wall outside the pitch curve, whose radius is negative, or below the axis.
        """
        return -1 if self.below != (self.radius < 0.0) else 1

    @property
    def least(self) -> float:
        """Distance from the axis to a round follower's centre or to a flat face, at zero lift.

        The cam turns.
        """
        if not self.oscillating:
            return self.start if self.flat else math.hypot(self.offset, self.start)
        if self.flat:
            return self.pivot * math.sin(self.start) - self.face_offset
        # the law of cosines by half the angle: beside a long arm a short pivot's would be below 0
        half = math.sqrt(self.pivot * self.arm) * math.sin(0.5 * self.start)
        return math.hypot(self.pivot - self.arm, 2.0 * half)


def make_mechanism(follower: FollowerSpec, cam: CamSpec) -> Mechanism:
    """Return the numbers of a follower on its cam.

    Parameters
    ----------
    follower : FollowerSpec
        The follower.
    cam : CamSpec
        The cam; prime or base radius as the follower asks.

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
                "the follower's axis passes the prime circle",
                where="follower.offset_mm",
                value=abs(follower.offset),
                limit=size,
                unit="mm",
                nearest="the limit, either way, is the prime radius",
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
    return Mechanism(start=swing(pivot, arm, size), arm=arm, pivot=pivot, **kind)


def position_at(mechanism: Mechanism, size: float) -> float:
    """Return the position, mm or rad, at which a follower stands at a distance from the axis.

    Parameters
    ----------
    mechanism : Mechanism
        The follower on a cam that turns.
    size : float, mm
        From the axis to its centre, or to its flat face.

    Raises
    ------
    ValueError
        If it does not reach there.
    """
    m = mechanism
    if not m.oscillating:
        return size if m.flat else math.sqrt((size - m.offset) * (size + m.offset))
    return math.asin((size + m.face_offset) / m.pivot) if m.flat else swing(m.pivot, m.arm, size)


def swing(pivot: float, arm: float, size: float) -> float:
    """Return Psi, rad, at which an arm's end stands at a distance from the cam's axis.

    Parameters
    ----------
    pivot, arm, size : float, mm
        From the axis to the pivot, from there to the arm's end, from this to the axis: sides of a
        triangle.
    """
    # half the angle from the sides, with parentheses (after Kahan) that keep all digits where the
    # triangle is nearly flat
    small, large = sorted([pivot, arm])
    apart = large - small
    half = math.atan2(
        math.sqrt((size - apart) * (size + apart)),
        math.sqrt((small - (size - large)) * (small + (size + large))),
    )
    return 2.0 * half


def make_sliding_mechanism(follower: FollowerSpec, way: float) -> Mechanism:
    """Return the numbers of a follower over a cam that slides.

    Parameters
    ----------
    follower : FollowerSpec
        The follower, round.
    way : float, mm
        How far the cam slides.

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
            nearest="the limit is the arm, excluded",
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
    """Return the error of a size that is not between what the parts allow."""
    limit, least = low if size <= low else high, max(low, 0.0)
    if high > 0.0:  # from the limit that the size passes to the middle of what is allowed
        near = least if size <= least else high
        ways = (Way(near={key: near}, far={key: 0.5 * (least + high)}), *ways)
    return InfeasibleError(
        what,
        where=key,
        value=size,
        limit=limit,
        unit="mm",
        nearest=f"{parts} allow {shown(least)} to {shown(high)} mm, both excluded",
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
