"""Drawings of a cam: its parts with pitch curves and follower, and the paths of a cutter."""

from __future__ import annotations

from collections.abc import Sequence
from dataclasses import replace
from typing import Final

import numpy as np

from gearcam.base.errors import InfeasibleError
from gearcam.cams.wall import PitchMotion, Wall
from gearcam.numeric.contour import Contour
from gearcam.numeric.pose import UNMOVED, Pose
from gearcam.parts.body import Part
from gearcam.parts.parallel import moved, sized
from gearcam.parts.shapes import Circle
from gearcam.pictures.drawings import (
    BLANK,
    CENTER,
    CROSS_SIZE,
    FOLLOWER,
    PITCH,
    PRIME,
    PROFILE,
    Cross,
    Drawing,
    Feature,
    Path,
    Shape,
    part_features,
    place,
)

TOOL_RADIUS: Final = "output.tool_radius_mm"
"""The key of a cutter's radius."""


def cutter_way(edge: Contour, radius: float, *, side: int = 1) -> Contour:
    """Return the path of a cutter's centre along an edge.

    Parameters
    ----------
    edge : Contour
        The edge to cut.
    radius : float, mm
        Radius of the cutter; 0 if not given.
    side : {1, -1}
        Outside or inside the edge.

    Returns
    -------
    Contour

    Raises
    ------
    InfeasibleError
        If there is no radius, or it leaves no simple path.
    """
    if not radius:
        note = "the default is the radius of a round follower; this follower has none"
        raise InfeasibleError(
            "the path of a cutter needs the cutter's radius", where=TOOL_RADIUS, nearest=note
        )
    return sized(lambda by: moved(edge, side * by), radius, TOOL_RADIUS, "radius of the cutter")


def cam_drawing(
    part: Part,
    pitch: Contour | Path | None,
    prime_radius: float | None,
    follower: Sequence[Shape] = (),
    *,
    pose: Pose = UNMOVED,
    outline: str = PROFILE,
) -> Drawing:
    """Return the drawing of a moved cam with its pitch curve, prime circle and follower.

    Parameters
    ----------
    part : Part
        The cam.
    pitch : Contour, Path or None
        Its pitch curve, in the part's frame; None if that is the profile.
    prime_radius : float, mm, or None
        Radius of the prime circle, for a flat follower of the base circle; None without one.
    follower : sequence of Shape
        The follower in its position; may be empty.
    pose : Pose
        Where the cam is.
    outline : str
        Layer of the part's outline.

    Returns
    -------
    Drawing
        With the name of the part.
    """
    moving = list(part_features(part, outline=outline))
    if pitch is not None:
        moving.append(Feature(layer=PITCH, shape=pitch))
    features = list(place(moving, pose))
    if prime_radius is not None:
        circle = Circle(center=0j, diameter=2.0 * prime_radius)
        features.append(Feature(layer=PRIME, shape=circle))
    features += [Feature(layer=FOLLOWER, shape=shape) for shape in follower]
    cross = Cross(center=0j, size=CROSS_SIZE * float(np.ptp(part.contour.vertices)))
    features.append(Feature(layer=CENTER, shape=cross))
    return Drawing(name=part.name, features=tuple(features))


def plate(
    part: Part, wall: Wall, prime: float, follower: Sequence[Shape] = (), *, angle: float = 0.0
) -> Drawing:
    """Return a drawing of a plate, its outline a wall, with the pitch curve (see `cam_drawing`)."""
    pitch = None if wall.pitch_contour is part.contour else wall.pitch_contour
    return cam_drawing(part, pitch, prime, follower, pose=Pose(angle))


def follower(motion: PitchMotion, theta: float, reach: float) -> list[Shape]:
    """Return a follower in its position at a cam angle.

    Parameters
    ----------
    motion : PitchMotion
        Its motion.
    theta : float, rad
        The cam angle.
    reach : float, mm
        Largest radius of the cam, for the size of symbols.

    Returns
    -------
    list of Shape
        In the fixed frame.
    """
    touching, hand = motion.follower, motion.hand
    position = touching.start + float(motion.program.derivatives(theta, 0)[0])
    reach = 1.2 * reach

    def path(*points: complex) -> Path:
        return Path(points=np.array([complex(hand * z.real, z.imag) for z in points]), closed=False)

    found = motion.contact_place
    wide = 0.2 * reach + (found.largest if found is not None else 0.0)
    lines, discs = touching.symbol(position, reach, wide)
    circles = [
        Circle(center=complex(hand * center.real, center.imag), diameter=2.0 * radius)
        for center, radius in discs
    ]
    return [*circles, *(path(*line) for line in lines)]


def grooved(
    part: Part, walls: Sequence[Wall], follower: Sequence[Shape] = (), *, angle: float = 0.0
) -> Drawing:
    """Return a drawing of a disc with a groove, whose first wall is inside (see `cam_drawing`)."""
    pitch, least = walls[0].pitch_contour, walls[0].follower.prime_radius
    drawing = cam_drawing(part, pitch, least, follower, pose=Pose(angle), outline=BLANK)
    # a circle stays a circle in files
    edge = Circle(center=0j, diameter=2.0 * part.contour.reach)
    blank, *others = drawing.features
    return replace(drawing, features=(replace(blank, shape=edge), *others))
