"""A yoke cam: a disc between two flat faces, or two rollers, of one follower.

Both are touched at every angle where the lifts half a turn apart add up to the same (see
`gearcam.laws.half_turns`): the cam then has a constant *breadth* between faces, or its pitch curve
a constant *diameter* through the axis, the distance of the rollers. One profile is its only wall;
the second face is touched by it half a turn later.

Refused: what disc cams refuse.

Depends on disc.
"""

from __future__ import annotations

from dataclasses import dataclass

from gearcam.cams.disc import DiscCam


@dataclass(frozen=True, eq=False, kw_only=True)
class YokeCam(DiscCam):
    """A disc cam whose follower goes around it (see the module)."""

    @property
    def breadth(self) -> float:
        """Distance of both faces, or of the rollers' centres, mm."""
        return 2.0 * self.mechanism.start + sum(self.program.range)

    @property
    def face_width(self) -> float | None:
        """Least width of a flat face, mm, without a margin: as far as it is touched, either way."""
        place = self.contact_place
        return None if place is None else 2.0 * place.largest


def make_yoke(cam: DiscCam) -> YokeCam:
    """Return a disc cam as one that its follower goes around.

    Parameters
    ----------
    cam : DiscCam
        Its lift of two opposite half turns, its follower, which rises with it, translating and
        without an offset.

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
