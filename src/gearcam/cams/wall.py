"""Walls of a cam: where one side of its follower's pitch motion cuts, trimmed.

A cam is a list of walls of one *pitch motion*: a lift program that moves a follower. A disc cam has
one wall, inside the pitch curve; a groove has one on either side.

Nothing is computed before it is asked for. Everything is computed for a cam that turns
counter-clockwise; only contours and drawn curves are mirrored for the other direction.

Refused: profiles that cross themselves so that what is left cannot be told.

Depends on curve, measures, loops, trim, lost and numeric.
"""

from __future__ import annotations

import math
from collections.abc import Callable
from dataclasses import dataclass, replace
from functools import cached_property

import numpy as np

from gearcam.cams.contact import Contact
from gearcam.cams.curve import CamCurve, ProfileSegments, begun, segments
from gearcam.cams.loops import without_small_loops
from gearcam.cams.lost import lost_lift
from gearcam.cams.measures import Extreme, Range, Size, over_the_end, range_of, size_of, undercut
from gearcam.cams.mechanism import Mechanism
from gearcam.cams.trim import Corner, crossing_chords, demand_joined, star_shaped, trimmed
from gearcam.display import Brief
from gearcam.facts import Fact
from gearcam.laws.program import Program
from gearcam.numeric.arrays import Array, Plane
from gearcam.numeric.bulges import as_complex, as_pairs
from gearcam.numeric.contour import Contour
from gearcam.numeric.jets import Jet
from gearcam.numeric.sampling import Sampler

CHORD_TOLERANCE = 1e-3
"""Chord tolerance where the design gives none, mm."""

_TURN = [(0.0, 2.0 * math.pi)]
"""The whole turn, as stretches of it."""

OVERSAMPLING = 8
"""Dense points per chord: their own chord error is 1/64 of the polygon's."""


@dataclass(frozen=True, eq=False, kw_only=True)
class PitchMotion(Brief):
    """A follower that a lift moves against a cam.

    Parameters
    ----------
    program : Program
        The lift asked for.
    mechanism : Mechanism
        The follower.
    clockwise : bool
        Whether the cam turns clockwise.
    tolerance : float, mm
        Chord error of contours.
    key : str
        What names of its files and facts end in; empty of a cam's only one.
    called : str
        What people call what is cut.
    """

    program: Program
    mechanism: Mechanism
    clockwise: bool = False
    tolerance: float = CHORD_TOLERANCE
    key: str = ""
    called: str = "profile"

    @cached_property
    def curve(self) -> CamCurve:
        """The curves of the cam as it turns counter-clockwise."""
        return CamCurve(program=self.program, mechanism=self.mechanism)

    @property
    def total_lift(self) -> Fact:
        """From the lowest to the highest lift, for people."""
        low, high = self.program.range
        scale, unit = self.mechanism.outward
        return Fact(scale * (high - low), "lift", unit=unit)

    @cached_property
    def _ranges(self) -> dict[tuple[str, str], Range | None]:
        """The ranges that were asked for, by what is told of and the kind of phase."""
        return {}

    def _range(self, what: str, pick: Callable[[Contact], Jet], kind: str) -> Range | None:
        """Return the range of what to `pick` over a turn or all phases of a `kind`, found once."""
        if (what, kind) not in self._ranges:
            stretches = self.program.phases(kind) if kind else _TURN
            self._ranges[what, kind] = range_of(self.curve, pick, stretches)
        return self._ranges[what, kind]

    def pressure(self, kind: str) -> Range | None:
        """Return the signed pressure angles, rad, over all phases of a `kind` (rise, return)."""
        return self._range("pressure angle", lambda contact: contact.pressure, kind)

    def pitch_curvature(self, kind: str = "") -> Range | None:
        """Return the pitch curve's curvature, 1/mm, over a turn or all phases of a `kind`.

        None of a flat follower, whose profile is its pitch curve (see `face_radius`), and where
        there is no such phase.
        """
        if self.mechanism.flat:
            return None
        return self._range("curvature", lambda contact: contact.turning / contact.pitch_speed, kind)

    @cached_property
    def contact_place(self) -> Range | None:
        """Where a flat face is touched, mm (see `gearcam.cams.contact.Contact`)."""
        if not self.mechanism.flat:
            return None
        return range_of(self.curve, lambda contact: contact.place, _TURN)

    def motion(self, theta: Array) -> dict[str, Array]:
        """Return the motion and the contact at cam angles.

        Parameters
        ----------
        theta : (n,) array, rad
            Cam angles; at a knot the values after it count.

        Returns
        -------
        dict of str to (n,) array
            ``s, ds, d2s, d3s`` in mm or rad, ``pressure`` in rad, ``rho_pitch`` in mm, infinite
            where straight.
        """
        s, ds, d2s, d3s = self.program.derivatives(theta, 3)
        found = self.curve.contact(theta, 0)
        return {
            "s": s,
            "ds": ds,
            "d2s": d2s,
            "d3s": d3s,
            "pressure": found.pressure.c[0] + np.zeros_like(s),
            "rho_pitch": _radii(found.pitch_speed, found.turning) + np.zeros_like(s),
        }


def _radii(speed: Jet, turning: Jet) -> Array:
    """Return radii of curvature, infinite where straight."""
    turn = turning.c[0]
    with np.errstate(divide="ignore", invalid="ignore"):
        return np.where(turn == 0.0, np.inf, speed.c[0] / turn)


@dataclass(frozen=True, eq=False, kw_only=True)
class _Kept:
    """What trimming leaves: as `drawn`, in a `sampler`, and `corners` of an unmirrored cam."""

    drawn: ProfileSegments
    sampler: Sampler
    corners: tuple[Corner, ...]


@dataclass(frozen=True, eq=False, kw_only=True)
class Wall(PitchMotion):
    """A wall: the parallel of the pitch curve at the follower's radius, or what a face envelops.

    Parameters
    ----------
    side : {1, -1}
        Whether the metal lies inside the pitch curve, as in a disc cam, or outside it; then it is
        a follower that is pressed outwards that loses lift.
    of : PitchMotion or None
        The motion whose pitch curve it has, where it is not the only one that has it.
    """

    side: int = 1
    of: PitchMotion | None = None

    @cached_property
    def curve(self) -> CamCurve:
        """The wall's curves as the cam turns counter-clockwise: outside at a negative depth."""
        radius = self.side * self.mechanism.radius
        return CamCurve(program=self.program, mechanism=replace(self.mechanism, radius=radius))

    def pitch_curvature(self, kind: str = "") -> Range | None:
        """Return what is promised (see `PitchMotion`)."""
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
        found = self.curve.contact(theta, 0)
        return self.side * _radii(found.speed, found.turning) + np.zeros_like(theta)

    @cached_property
    def profile_radius(self) -> tuple[float, float]:
        """Smallest convex and smallest concave radius of the profile, mm; a corner has radius 0.

        Infinite where there is no convex or no concave part.
        """
        if self.face_radius is not None:
            convex, concave = self.face_radius.low.value, math.inf
        else:
            found, radius = self.pitch_curvature(), self.mechanism.radius
            low, high = (found.low.value, found.high.value) if found else (0.0, 0.0)
            if self.side < 0:
                low, high = -high, -low
            convex = 1.0 / high - radius if high > 0.0 else math.inf
            concave = -1.0 / low + radius if low < 0.0 else math.inf
            for jump in self.program.hard:
                if (
                    self.curve.mechanism.away * (jump.after - jump.before) > 0.0
                ):  # it rolls about its own centre
                    concave = min(concave, radius)
                else:
                    convex = 0.0
        return (0.0 if self.corners else max(convex, 0.0)), concave

    @cached_property
    def face_radius(self) -> Range | None:
        """Radius of curvature of a flat follower's profile, mm, negative where undercut."""
        if not self.mechanism.flat:
            return None
        return range_of(self.curve, lambda contact: contact.speed / contact.turning, _TURN)

    @cached_property
    def undercut(self) -> list[tuple[float, float]]:
        """Cam angles, rad, between which the profile runs backwards."""
        return undercut(self.curve)

    @property
    def undercut_ranges(self) -> list[tuple[float, float]]:
        """The same for people: one that goes on over the end of the turn ends beyond it."""
        joined = over_the_end(self.undercut, self.program.closed)
        ends = (parts[0][1] + (2.0 * math.pi if len(parts) > 1 else 0.0) for parts in joined)
        return [(parts[-1][0], end) for parts, end in zip(joined, ends, strict=True)]

    @cached_property
    def _kept(self) -> _Kept:
        whole = segments(self.curve, self.curve.mechanism.radius)
        kept, corners, left = without_small_loops(whole, self.undercut, self._reach)
        drawn, sampler = self._sampled(self._drawn(kept))
        if left or not star_shaped(*sampler.probes, slides=self.program.open):
            kept, more = trimmed(kept, left, self.tolerance)
            starts = set(kept.states(np.arange(len(kept.start)), kept.start)[0].tolist())
            corners = (*(corner for corner in corners if corner.after in starts), *more)
            drawn, sampler = self._sampled(self._drawn(kept))
        if corners:
            demand_joined(drawn, self.tolerance)
        corners = tuple(sorted(corners, key=lambda corner: corner.before))
        return _Kept(drawn=drawn, sampler=sampler, corners=corners)

    @property
    def _reach(self) -> float:
        """The size of the cam, mm, of which small lengths are parts."""
        m = self.mechanism
        return (2.0 * math.pi * m.slide or m.least) + self.program.range[1] * m.lever

    def _drawn(self, kept: ProfileSegments) -> ProfileSegments:
        return replace(begun(kept), curve=replace(self.curve, mirrored=self.clockwise))

    def _sampled(self, drawn: ProfileSegments) -> tuple[ProfileSegments, Sampler]:
        """Return a curve cut so that its sampler's probes see how it turns, and that sampler."""
        while True:
            sampler = Sampler(curves=drawn, tolerance=self.tolerance, closed=self.program.closed)
            before, drawn = drawn, drawn.resolved(*sampler.probes, self.tolerance)
            if drawn is before:
                return drawn, sampler

    @property
    def drawn(self) -> ProfileSegments:
        """What trimming leaves, mirrored if the cam turns clockwise; it begins at a corner."""
        return self._kept.drawn

    @property
    def corners(self) -> tuple[Corner, ...]:
        """Where trimming has left corners, as the cam turns counter-clockwise."""
        return self._kept.corners

    @cached_property
    def lost(self) -> tuple[Extreme, ...]:
        """Largest lift, mm or rad, that each corner costs, with its cam angle, rad."""
        side = self.curve.mechanism.away
        return tuple(
            lost_lift(self.program, self.mechanism, corner, side) for corner in self.corners
        )

    @cached_property
    def shortfall(self) -> float:
        """Largest lift that trimming costs, mm or rad."""
        return max((loss.value for loss in self.lost), default=0.0)

    @cached_property
    def size(self) -> Size:
        """Perimeter and area of the profile."""
        return size_of(self.drawn)

    @property
    def cubics_missed(self) -> float:
        """The area between the profile and cubics through its dense points, mm^2, at most."""
        return self.sampler.dense(OVERSAMPLING).missed(self.sampler.at)

    @property
    def nearest_flat(self) -> float:
        """Least distance of the axis from the inside of a straight piece, mm; inf without one."""
        if not self.mechanism.flat:
            return math.inf
        kept = self.drawn
        inside = np.flatnonzero(kept.jump & (kept.start < 0.0) & (kept.end > 0.0))
        return float(np.abs(kept.at(inside, np.zeros(len(inside)))[0]).min(initial=math.inf))

    @property
    def sampler(self) -> Sampler:
        """The profile with the density of points that the tolerance asks for."""
        return self._kept.sampler

    @cached_property
    def contour(self) -> Contour:
        """The profile, counter-clockwise, proved to be a simple curve about the axis."""
        made = self._contour(self.sampler)
        points = as_complex(made.vertices)
        seen_whole = bool(np.all((np.conj(points) * np.roll(points, -1)).imag > 0.0))
        if not seen_whole and not made.polygon.is_valid:
            raise crossing_chords(self.called, self.sampler, self._contour)
        return made

    @property
    def outline(self) -> Array:
        """Vertices of the profile before clearance, (n, 2), mm, counter-clockwise, cam's frame."""
        return self.contour.vertices

    @cached_property
    def pitch_contour(self) -> Contour:
        """The pitch curve, counter-clockwise; of a flat or pointed follower the profile."""
        if self.mechanism.flat or self.mechanism.radius == 0.0:
            return self.contour
        return self._contour(self._pitch_sampler)

    @property
    def _pitch_sampler(self) -> Sampler:
        return self._sampled(self._drawn(segments(self.curve, 0.0)))[1]

    def _contour(self, sampler: Sampler) -> Contour:
        _, points, error = sampler.chords
        clockwise = not self.clockwise  # theta draws against the cam's turning
        return Contour(
            dense=lambda: sampler.dense(OVERSAMPLING).runs(clockwise),
            vertices=as_pairs(points[::-1] if clockwise else points),
            tolerance=self.tolerance,
            chord_error=error,
        )

    def places(self, count: int) -> tuple[Array, Plane, Plane]:
        """Return points of the profile at `count` even cam angles of a turn (see `places_at`)."""
        return self.places_at(2.0 * math.pi * np.arange(count) / (count - self.program.open))

    def places_at(self, theta: Array) -> tuple[Array, Plane, Plane]:
        """Return points of the profile at cam angles, where they are left by trimming.

        Parameters
        ----------
        theta : (m,) array, rad
            Cam angles, any number of turns.

        Returns
        -------
        theta : (n,) array, rad
            Those at which a point is left.
        points, normals : (n,) complex arrays, mm and 1
            Touched at those angles, with the outward normals of the metal.
        """
        kept = self.drawn
        turn = 2.0 * math.pi
        # an open curve ends with its last place
        within = np.minimum(theta, np.nextafter(turn, 0)) if self.program.open else theta % turn
        sweeps = np.flatnonzero(~kept.jump)
        inside = (kept.start[sweeps] <= within[:, None]) & (within[:, None] < kept.end[sweeps])
        left = inside.any(axis=1)
        index = sweeps[inside.argmax(axis=1)][left]
        points, tangents = kept.at(index, within[left])
        # drawn against the cam's turning, the metal lies to the right, mirrored to the left
        return theta[left], points, tangents * self.side * (-1j if self.clockwise else 1j)
