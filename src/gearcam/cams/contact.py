"""Where a follower touches its cam: pressure angle, turning and speed of the contact, exactly.

Computed with jets, so that every quantity also has its exact derivative (see
`gearcam.cams.followers`).
"""

from __future__ import annotations

from dataclasses import dataclass

from gearcam.numeric.jets import Jet, atan


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
