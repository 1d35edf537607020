"""Walls of a cam: the trimmed edges that one side of its follower's pitch motion cuts.

A cam has walls of one *pitch motion*: a lift program that moves a follower. A disc cam has one
wall, inside the pitch curve; a groove has one on either side.

Values are computed when first used, for a cam that turns counter-clockwise; only contours and drawn
curves are mirrored for the other direction.

Refused: profiles that cross themselves and cannot be trimmed.

Depends on curve, measures, trim, lost and numeric.
"""

from __future__ import annotations

import math
from collections.abc import Callable
from dataclasses import dataclass, replace
from functools import cached_property

import numpy as np

from gearcam.base.display import ShortRepr
from gearcam.base.facts import Fact
from gearcam.cams.carriers import ROTATING, Carrier
from gearcam.cams.curve import CamCurve, ProfileSegments, begun, segments
from gearcam.cams.followers import Contact, Follower
from gearcam.cams.measures import Extreme, Range, Size, over_the_end, range_of, size_of, undercut
from gearcam.cams.trim import (
    Corner,
    crossing_chords,
    lost_lift,
    star_shaped,
    trimmed,
    without_tiny_loops,
)
from gearcam.laws.displacement import Jump
from gearcam.laws.program import Program
from gearcam.numeric.arrays import Array, Ints, Mask, Plane
from gearcam.numeric.contour import Contour
from gearcam.numeric.jets import Jet
from gearcam.numeric.sampling import Sampler

CHORD_TOLERANCE = 1e-3
"""Default chord tolerance, mm."""

OVERSAMPLING = 8
"""Dense points per chord: their own chord error is 1/64 of the polygon's."""


@dataclass(frozen=True, eq=False, kw_only=True)
class PitchMotion(ShortRepr):
    """The motion of a follower with a lift, on a cam.

    Parameters
    ----------
    program : Program
        The given lift.
    follower : Follower
        The follower.
    carrier : Carrier
        Motion of the cam.
    clockwise : bool
        Whether the cam turns clockwise.
    tolerance : float, mm
        Chord error of contours.
    key : str
        Ending of names of its files and facts; empty for a cam's only motion.
    called : str
        Name of the cut edge in messages.
    """

    program: Program
    follower: Follower
    carrier: Carrier = ROTATING
    clockwise: bool = False
    tolerance: float = CHORD_TOLERANCE
    key: str = ""
    called: str = "profile"

    @property
    def ending(self) -> str:
        """What its key adds to names of files and columns; empty for a cam's only motion."""
        return f"_{self.key}" if self.key else ""

    @property
    def hand(self) -> float:
        """1 of a cam that turns counter-clockwise, -1 of one that is mirrored in the y axis."""
        return -1.0 if self.clockwise else 1.0

    @cached_property
    def pitch_curve(self) -> CamCurve:
        """The pitch curve, or the profile below a face, of the cam turning counter-clockwise."""
        return CamCurve(program=self.program, follower=self.follower, carrier=self.carrier)

    @property
    def motion_scales(self) -> dict[str, float]:
        """Names of the motion's columns in output, with factors from internal units.

        The lift and its first three derivatives, in this order.
        """
        (scale, unit), driver = self.follower.lift_unit, self.carrier.driver
        names = ("lift_{}", "velocity_{}_per_{}", "acceleration_{}_per_{}2", "jerk_{}_per_{}3")
        return {name.format(unit, driver.per): scale for name in names}

    def timed_scales(self, speed: float | None) -> dict[str, float]:
        """Return names of derivatives by time, with factors from those by the driver's position.

        Parameters
        ----------
        speed : float or None, rad/s or mm/s
            Speed of the cam; without one there are none.
        """
        if speed is None:
            return {}
        (scale, unit), names = self.follower.lift_unit, ("velocity", "acceleration", "jerk")
        powers = zip(names, ("s", "s2", "s3"), (1, 2, 3), strict=True)
        return {f"{name}_{unit}_{per}": scale * speed**order for name, per, order in powers}

    @property
    def total_lift(self) -> Fact:
        """Total lift, from the lowest to the highest, in the unit of output."""
        low, high = self.program.range
        scale, unit = self.follower.lift_unit
        return Fact(scale * (high - low), "lift", unit=unit)

    @property
    def _whole(self) -> list[tuple[float, float]]:
        """The whole turn or travel, as a list of stretches."""
        return [(0.0, self.program.period)]

    @cached_property
    def _ranges(self) -> dict[tuple[str, str], Range | None]:
        """Cached ranges, by quantity and kind of phase."""
        return {}

    def _range(self, what: str, pick: Callable[[Contact], Jet], kind: str) -> Range | None:
        """Return the range of `pick` over a turn or all phases of a `kind`, cached."""
        if (what, kind) not in self._ranges:
            stretches = self.program.phases(kind) if kind else self._whole
            self._ranges[what, kind] = range_of(self.pitch_curve, pick, stretches)
        return self._ranges[what, kind]

    def pressure(self, kind: str) -> Range | None:
        """Return the signed pressure angles, rad, over all phases of a `kind` (rise, return)."""
        return self._range("pressure angle", lambda contact: contact.pressure, kind)

    def pitch_curvature(self, kind: str = "") -> Range | None:
        """Return the pitch curve's curvature, 1/mm, over a turn or all phases of a `kind`.

        None for a flat follower, whose profile is its pitch curve (see `face_radius`), and if there
        is no such phase.
        """
        if not self.follower.has_centre:
            return None
        return self._range("curvature", lambda contact: contact.turning / contact.pitch_speed, kind)

    @cached_property
    def contact_place(self) -> Range | None:
        """Range of the contact along a flat face, mm (see `gearcam.cams.followers.Contact`)."""
        if self.follower.has_centre:
            return None
        return range_of(self.pitch_curve, lambda contact: contact.place, self._whole)

    def motion(self, theta: Array) -> dict[str, Array]:
        """Return the motion and the contact at cam angles.

        Parameters
        ----------
        theta : (n,) array, rad
            Cam angles; at a knot the values after it are returned.

        Returns
        -------
        dict of str to (n,) array
            ``s, ds, d2s, d3s`` in mm or rad, ``pressure`` in rad, ``rho_pitch`` in mm, infinite
            where straight.
        """
        s, ds, d2s, d3s = self.program.derivatives(theta, 3)
        contact = self.pitch_curve.contact(theta, 0)
        return {
            "s": s,
            "ds": ds,
            "d2s": d2s,
            "d3s": d3s,
            "pressure": contact.pressure.c[0] + np.zeros_like(s),
            "rho_pitch": _radii(contact.pitch_speed, contact.turning) + np.zeros_like(s),
        }


def _radii(speed: Jet, turning: Jet) -> Array:
    """Return radii of curvature, infinite where straight."""
    turn = turning.c[0]
    with np.errstate(divide="ignore", invalid="ignore"):
        return np.where(turn == 0.0, np.inf, speed.c[0] / turn)


@dataclass(frozen=True, eq=False, kw_only=True)
class _Kept:
    """The trimmed profile: as `drawn`, in a `sampler`, and `corners` of the unmirrored cam."""

    drawn: ProfileSegments
    sampler: Sampler
    corners: tuple[Corner, ...]


@dataclass(frozen=True, eq=False, kw_only=True)
class Wall(PitchMotion):
    """A wall: the parallel of the pitch curve at the follower's radius, or the envelope of a face.

    Parameters
    ----------
    side : {1, -1}
        Whether the metal lies inside the pitch curve, as in a disc cam, or outside it; then a
        follower pressed outwards loses lift.
    of : PitchMotion or None
        The motion of its pitch curve, if shared with another wall.
    """

    side: int = 1
    of: PitchMotion | None = None

    @cached_property
    def curve(self) -> CamCurve:
        """The untrimmed wall, of the cam turning counter-clockwise."""
        return replace(self.pitch_curve, inset=self.side * self.follower.radius)

    def pitch_curvature(self, kind: str = "") -> Range | None:
        """Return the pitch curve's curvature, 1/mm, of a `kind` (see `PitchMotion`)."""
        return (self.of or super()).pitch_curvature(kind)

    def radii(self, theta: Array) -> Array:
        """Return radii of curvature before trimming, mm.

        Parameters
        ----------
        theta : (n,) array, rad
            Cam angles; at a knot the values after it count.

        Returns
        -------
        (n,) array
            Positive where the metal is convex, infinite where straight.
        """
        contact = self.curve.contact(theta, 0)
        return self.side * _radii(contact.speed, contact.turning) + np.zeros_like(theta)

    @cached_property
    def profile_radius(self) -> tuple[float, float]:
        """Smallest convex and smallest concave radius of the profile, mm; an edge has radius 0.

        Infinite where there is no convex or no concave part. Jumps of the velocity that are too
        small to matter are left out.
        """
        if self.face_radius is not None:
            convex, concave = self.face_radius.low.value, math.inf
        else:
            whole, radius = self.pitch_curvature(), self.follower.radius
            low, high = (whole.low.value, whole.high.value) if whole else (0.0, 0.0)
            if self.side < 0:
                low, high = -high, -low
            convex = 1.0 / high - radius if high > 0.0 else math.inf
            concave = -1.0 / low + radius if low < 0.0 else math.inf
            for jump in self.program.hard:
                if jump.slight:
                    continue
                # an arc about the roller's centre, or an edge
                if self.curve.lift_sign * (jump.after - jump.before) > 0.0:
                    concave = min(concave, radius)
                else:
                    convex = 0.0
        return (0.0 if self.edges else max(convex, 0.0)), concave

    @cached_property
    def face_radius(self) -> Range | None:
        """Radius of curvature of a flat follower's profile, mm, negative where undercut."""
        if self.follower.has_centre:
            return None
        return range_of(self.curve, lambda contact: contact.speed / contact.turning, self._whole)

    @cached_property
    def undercut(self) -> list[tuple[float, float]]:
        """Cam angles, rad, between which the profile runs backwards."""
        return undercut(self.curve)

    @property
    def undercut_ranges(self) -> list[tuple[float, float]]:
        """The same for output: a stretch across the end of the turn ends beyond it.

        Without velocity jumps that are too small to matter.
        """
        return [(low, high) for low, high in self._stretches if not self._slight(low, high)]

    @cached_property
    def _stretches(self) -> list[tuple[float, float]]:
        joined = over_the_end(self.undercut, self.program)
        ends = (parts[0][1] + (self.program.period if len(parts) > 1 else 0.0) for parts in joined)
        return [(parts[-1][0], end) for parts, end in zip(joined, ends, strict=True)]

    def _slight(self, low: float, high: float) -> bool:
        """Return whether an undercut stretch is a velocity jump too small to matter."""
        return low == high and self.program.slight(low)

    def undercut_at(self, corner: Corner) -> list[tuple[float, float]]:
        """Return the undercut stretches that trimming cuts away at a corner, for output."""
        return [pair for pair in self._stretches if self._rides(corner, np.array([pair[0]]))[0]]

    def _rides(self, corner: Corner, theta: Array) -> Mask:
        """Return where a follower is between the two sides of a corner, at cam angles (n,)."""
        turn = self.program.period
        return np.mod(theta - corner.before, turn) <= (corner.after - corner.before) % turn

    @cached_property
    def _kept(self) -> _Kept:
        whole = segments(self.curve)
        kept, corners, left = without_tiny_loops(whole, self.undercut, self._reach)
        drawn, sampler = self._sampled(self._drawn(kept))
        if left or not star_shaped(*sampler.probes, slides=self.program.open):
            kept, more = trimmed(kept, left, self.tolerance)
            starts = set(kept.states(np.arange(len(kept.start)), kept.start)[0].tolist())
            corners = (*(corner for corner in corners if corner.after in starts), *more)
            drawn, sampler = self._sampled(self._drawn(kept))
        corners = tuple(sorted(corners, key=lambda corner: corner.before))
        return _Kept(drawn=drawn, sampler=sampler, corners=corners)

    @property
    def _reach(self) -> float:
        """The size of the cam, mm, as a scale of small lengths."""
        size = self.follower.prime_radius if self.carrier.around else self.program.period
        return size + self.program.range[1] * self.follower.lever

    def _drawn(self, kept: ProfileSegments) -> ProfileSegments:
        return replace(begun(kept), curve=replace(kept.curve, mirrored=self.clockwise))

    def _sampled(self, drawn: ProfileSegments) -> tuple[ProfileSegments, Sampler]:
        """Return a curve divided so that the probes of its sampler resolve it, and that sampler."""
        while True:
            sampler = Sampler(curves=drawn, tolerance=self.tolerance, closed=self.program.closed)
            before, drawn = drawn, drawn.resolved(sampler.probes[1])
            if drawn is before:
                return drawn, sampler

    @property
    def drawn(self) -> ProfileSegments:
        """The trimmed profile, mirrored if the cam turns clockwise; it begins at a corner."""
        return self._kept.drawn

    @property
    def corners(self) -> tuple[Corner, ...]:
        """Corners left by trimming, for the cam that turns counter-clockwise."""
        return self._kept.corners

    @cached_property
    def edges(self) -> tuple[Corner, ...]:
        """The corners on which the follower rides.

        All but those of velocity jumps that are too small to matter.
        """

        def slight(corner: Corner) -> bool:
            cut = self.undercut_at(corner)
            return bool(cut) and all(self._slight(*pair) for pair in cut)

        return tuple(corner for corner in self.corners if not slight(corner))

    @cached_property
    def lost(self) -> tuple[Extreme, ...]:
        """Largest lost lift, mm or rad, of each edge, with its cam angle, rad."""
        return tuple(lost_lift(self.curve, corner) for corner in self.edges)

    def bent_by(self, jump: Jump) -> tuple[float, float]:
        """Return how far a velocity jump bends the profile, rad, and the lift that is lost, mm.

        Parameters
        ----------
        jump : Jump
            One of `Program.hard`, too small to matter.
        """
        at, speeds = np.full(2, jump.theta), np.array([jump.before, jump.after])
        sides, lost = [self.curve.trace(at, self.program.derivatives(at, 0)[0], speeds)[1]], 0.0
        for corner in self.corners:
            if (jump.theta, jump.theta) in self.undercut_at(corner):
                places = np.array([corner.before, corner.after])
                sides.append(self.curve.trace(places, *self.program.derivatives(places, 1))[1])
                lost = self.follower.lever * lost_lift(self.curve, corner).value
        bends = [abs(float(np.angle(after / before))) for before, after in sides]
        return max(bends), lost

    def on_edge(self, theta: Array) -> Mask:
        """Return where the follower rides on an edge, at cam angles (n,), any number of turns."""
        riding = [self._rides(corner, theta) for corner in self.edges]
        return np.any([np.zeros(theta.shape, dtype=bool), *riding], axis=0)

    @cached_property
    def shortfall(self) -> float:
        """Largest lift lost by trimming, mm or rad."""
        return max((loss.value for loss in self.lost), default=0.0)

    @cached_property
    def size(self) -> Size:
        """Perimeter and area of the profile."""
        return size_of(self.drawn)

    @property
    def cubics_missed(self) -> float:
        """Bound of the area between the profile and cubics through its dense points, mm^2."""
        return self.sampler.dense(OVERSAMPLING).missed(self.sampler.at)

    @property
    def nearest_flat(self) -> float:
        """Least distance of the axis from the inside of a straight piece, mm; inf without one."""
        if self.follower.has_centre:
            return math.inf
        kept = self.drawn
        inside = np.flatnonzero(kept.jump & (kept.start < 0.0) & (kept.end > 0.0))
        return float(np.abs(kept.at(inside, np.zeros(len(inside)))[0]).min(initial=math.inf))

    @property
    def sampler(self) -> Sampler:
        """The profile with the density of points that the tolerance needs."""
        return self._kept.sampler

    @cached_property
    def contour(self) -> Contour:
        """The profile, counter-clockwise, verified to be a simple curve around the axis."""
        contour = self._contour(self.sampler)
        points = contour.points
        seen_whole = bool(np.all((np.conj(points) * np.roll(points, -1)).imag > 0.0))
        if not seen_whole and not contour.polygon.is_valid:
            raise crossing_chords(self.called, self.sampler, self._contour)
        return contour

    @property
    def outline(self) -> Array:
        """Vertices of the profile before clearance, (n, 2), mm, counter-clockwise, cam's frame."""
        return self.contour.vertices

    @cached_property
    def pitch_contour(self) -> Contour:
        """The pitch curve, counter-clockwise; for a flat or pointed follower the profile."""
        if self.follower.radius == 0.0:
            return self.contour
        return self._contour(self._pitch_sampler)

    @property
    def _pitch_sampler(self) -> Sampler:
        return self._sampled(self._drawn(segments(self.pitch_curve)))[1]

    def _contour(self, sampler: Sampler) -> Contour:
        _, points, error = sampler.chords
        clockwise = not self.clockwise  # the curve runs opposite to the cam's rotation
        return Contour(
            dense=lambda: sampler.dense(OVERSAMPLING).runs(clockwise),
            points=points[::-1] if clockwise else points,
            tolerance=self.tolerance,
            chord_error=error,
        )

    def places(self, count: int) -> tuple[Array, Plane, Plane]:
        """Return points of the profile at `count` even cam angles of a turn (see `places_at`)."""
        return self.places_at(self.program.period * np.arange(count) / (count - self.program.open))

    def places_at(self, theta: Array) -> tuple[Array, Plane, Plane]:
        """Return points of the profile at cam angles, as far as trimming leaves them.

        Parameters
        ----------
        theta : (m,) array, rad
            Cam angles, any number of turns.

        Returns
        -------
        theta : (n,) array, rad
            Angles at which a point is left.
        points, normals : (n,) complex arrays, mm and 1
            Points of contact at those angles, with the outward normals of the metal.
        """
        kept, (left, index, within) = self.drawn, self._sweeps_at(theta)
        points, tangents = kept.at(index, within)
        # opposite to the rotation the metal lies to the right, mirrored to the left
        return theta[left], points, tangents * self.side * (-1j if self.clockwise else 1j)

    def touched(self, theta: Array) -> Mask:
        """Return where trimming leaves the point of contact, at cam angles (n,), any turns."""
        return self._sweeps_at(theta)[0]

    def _sweeps_at(self, theta: Array) -> tuple[Mask, Ints, Array]:
        """Return where a point is left, and there the segments with the angles within them."""
        kept, turn = self.drawn, self.program.period
        # an open curve ends with its last point
        within = np.minimum(theta, np.nextafter(turn, 0)) if self.program.open else theta % turn
        sweeps = np.flatnonzero(~kept.jump)
        inside = (kept.start[sweeps] <= within[:, None]) & (within[:, None] < kept.end[sweeps])
        left = np.asarray(inside.any(axis=1))
        return left, sweeps[inside.argmax(axis=1)][left], within[left]
