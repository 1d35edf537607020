"""Where a follower touches its cam: pressure angle, turning and speed of the contact, exactly.

Computed with jets, so that every quantity also has its exact derivative. Relative to the cam a
round follower's centre has the velocity ``A + i*B`` in axes that turn with ``-beta``; the tangent
of the pitch curve is at the angle ``alpha - beta``, and the curve runs clockwise:

==================== =================== ============================= =============
follower             A                   B                             beta
==================== =================== ============================= =============
translating          ``s0 + s``          ``s' - e``                    ``theta``
oscillating          ``d*sin(Psi)``      ``l*(1 + s') - d*cos(Psi)``   ``theta + Psi``
translating, sliding ``k*cos(tilt)``     ``s' - k*sin(tilt)``          ``-tilt``
oscillating, sliding ``k*cos(Psi)``      ``l*s' - k*sin(Psi)``         ``-Psi``
==================== =================== ============================= =============

(k is the travel per rad of a cam that slides.)

``alpha = arctan(B/A)`` is the pressure angle, ``w = hypot(A, B)`` the speed of the centre and
``turning = beta' - alpha'`` the angular rate of the normal; the pitch curve's curvature is
``turning/w`` (positive for a convex curve), and the profile, a roller's radius r inside it, is
traced at the speed ``w - r*turning``. Where that is negative the profile is undercut.

A flat face is a support line: at the angle ``beta`` its distance from the axis is ``h(theta)``, it
touches ``g = h'/beta'`` along its tangent, and the profile is traced at the speed ``h*beta' + g'``.

Sources: 000 eqs. (3.17), (3.21), (3.26), (3.30), (3.33), section 3.4.4; derived anew.
"""

from __future__ import annotations

from dataclasses import dataclass

from gearcam.cams.mechanism import Mechanism
from gearcam.numeric.jets import Jet, atan, cos, sin, sqrt


@dataclass(frozen=True, eq=False, kw_only=True)
class Contact:
    """The contact at some cam angles, jets in theta.

    Parameters
    ----------
    across, along : Jet
        Velocities whose ratio is the tangent of the pressure angle.
    turning : Jet
        Angular rate of the profile's normal.
    pitch_speed : Jet, mm/rad
        Speed of the centre along the pitch curve; for a flat face equal to `speed`.
    speed : Jet, mm/rad
        Speed of the contact along the profile, negative where it is undercut.
    place : Jet, mm
        For a flat face: position of the contact along the face, from the parallel to the
        follower's axis through the cam's axis, or from the pivot; zero for round followers.
    """

    across: Jet
    along: Jet
    turning: Jet
    pitch_speed: Jet
    speed: Jet
    place: Jet

    @property
    def pressure(self) -> Jet:
        """Signed pressure angle, rad."""
        return atan(self.across / self.along)


def contact(mechanism: Mechanism, s: Jet, ds: Jet, d2s: Jet) -> Contact:
    """Return the contact of a follower.

    Parameters
    ----------
    mechanism : Mechanism
        The follower.
    s, ds, d2s : Jet
        Lift and its first two derivatives, mm or rad, each with its own slope.

    Returns
    -------
    Contact
    """
    position = s + mechanism.start
    if mechanism.flat:
        swings = mechanism.oscillating
        return (_swinging_face if swings else _sliding_face)(mechanism, position, ds, d2s)
    if mechanism.slide:
        k, swings = mechanism.slide, mechanism.oscillating
        angle, angle_slope = (position, ds) if swings else (0.0 * s + mechanism.tilt, 0.0 * ds)
        a, b = k * cos(angle), mechanism.lever * ds - k * sin(angle)
        a_slope, b_slope = -k * sin(angle) * angle_slope, mechanism.lever * d2s - a * angle_slope
        beta_slope = -1.0 * angle_slope
    elif mechanism.oscillating:
        d, arm = mechanism.pivot, mechanism.arm
        sine, cosine = d * sin(position), d * cos(position)
        a, b = sine, arm * (1.0 + ds) - cosine
        a_slope, b_slope, beta_slope = cosine * ds, arm * d2s + sine * ds, 1.0 + ds
    else:
        a, b = position, ds - mechanism.offset
        a_slope, b_slope, beta_slope = ds, d2s, 0.0 * ds + 1.0
    square = a * a + b * b
    turning = beta_slope - (a * b_slope - b * a_slope) / square
    speed = sqrt(square)
    return Contact(
        across=b,
        along=a,
        turning=turning,
        pitch_speed=speed,
        speed=speed - mechanism.radius * turning,
        place=0.0 * s,
    )


def _sliding_face(mechanism: Mechanism, height: Jet, ds: Jet, d2s: Jet) -> Contact:  # noqa: ARG001
    """000 section 3.4.4: contact at s', radius of curvature base + s + s''."""
    speed = height + d2s
    return Contact(
        across=0.0 * ds,
        along=0.0 * ds + 1.0,
        turning=0.0 * ds + 1.0,
        pitch_speed=speed,
        speed=speed,
        place=ds,
    )


def _swinging_face(mechanism: Mechanism, psi: Jet, ds: Jet, d2s: Jet) -> Contact:
    """Return the contact of a swinging face: it touches at ``t = d*cos(Psi)/(1 + s')``."""
    sine, cosine = mechanism.pivot * sin(psi), mechanism.pivot * cos(psi)
    turning = 1.0 + ds
    rise = cosine * ds
    rise_slope = cosine * d2s - sine * (ds * ds)
    along_slope = (rise_slope * turning - rise * d2s) / (turning * turning)
    speed = (sine - mechanism.face_offset) * turning + along_slope
    place = cosine / turning
    return Contact(
        across=0.0 * place - mechanism.face_offset,
        along=place,
        turning=turning,
        pitch_speed=speed,
        speed=speed,
        place=place,
    )
