"""A yoke cam: a disc between two flat faces, or two rollers, of one follower.

Both touch the cam at every angle if lifts half a turn apart have a constant sum (see
`gearcam.laws.half_turns`): then the cam has a constant *breadth* between faces, or its pitch curve
a constant *diameter* through the axis, the distance of the rollers. The profile is its only wall;
it touches the second face half a turn later. Refused: as for disc cams.

Depends on disc.
"""

from __future__ import annotations

from dataclasses import dataclass

from gearcam.cams.disc import DiscCam


@dataclass(frozen=True, eq=False, kw_only=True)
class YokeCam(DiscCam):
    """A disc cam whose follower encloses it (see the module)."""

    @property
    def breadth(self) -> float:
        """Distance of both faces, or of the rollers' centres, mm."""
        return 2.0 * self.mechanism.start + sum(self.program.range)

    @property
    def face_width(self) -> float | None:
        """Least width of a flat face, mm, without margin: twice the contact's largest offset."""
        place = self.contact_place
        return None if place is None else 2.0 * place.largest


def make_yoke(cam: DiscCam) -> YokeCam:
    """Return a yoke cam from a disc cam.

    Parameters
    ----------
    cam : DiscCam
        With a lift of two opposite half turns, and a translating follower without offset.

    Returns
    -------
    YokeCam
    """
    return YokeCam(
        program=cam.program,
        mechanism=cam.mechanism,
        clockwise=cam.clockwise,
        tolerance=cam.tolerance,
    )
