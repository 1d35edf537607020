"""The wheels of pairs as masses: of a density in their own design, with their parts as made."""

from __future__ import annotations

import cmath
from collections.abc import Iterator, Sequence
from typing import TYPE_CHECKING, Final, NamedTuple

from gearcam.kinds.mechanism.drives import center_of, way_of
from gearcam.linkages.coordinates import NamedCoordinate
from gearcam.linkages.efforts import InertiaForce
from gearcam.linkages.elements import Crank, Element, PushedSlide

if TYPE_CHECKING:
    from gearcam.kinds.mechanism.drives import PlacedDrive
    from gearcam.parts.mass import MassProperties

BODY: Final = ".body"
"""Behind the name of a shaft or a way: the member on it."""

_M2: Final = 1e-6
"""m2 of a mm2."""


class WheelMass(NamedTuple):
    """A wheel or a rack as a mass.

    Attributes
    ----------
    element : Element
        What carries its centre of mass.
    center : str
        Joint in its centre of mass.
    mass : float, kg
        Its mass.
    effort : InertiaForce
        Its inertia.
    """

    element: Element
    center: str
    mass: float
    effort: InertiaForce


def wheel_masses(drives: Sequence[PlacedDrive]) -> Iterator[WheelMass]:
    """Yield the wheels and racks of pairs whose designs give a density.

    Parameters
    ----------
    drives : sequence of PlacedDrive
        Those of a mechanism.
    """
    from gearcam.parts.mass import mass_properties

    for drive in drives:
        if drive.spec.pair is None or drive.result is None:
            continue
        for number, word in enumerate(drive.moved):
            density = drive.result.design.blank.wheel(number + 1).density
            if density is not None:
                found = mass_properties(drive.result.parts[number], density)
                yield _wheel(drive, word, found)


def _wheel(drive: PlacedDrive, word: str, found: MassProperties) -> WheelMass:
    name, placed = f"{drive.spec.name}.{word}", complex(*found.centroid[:2])
    member, center = name + BODY, f"{name}.center of mass"
    if drive.moved[word].along:  # any point of it has its way
        element = PushedSlide(member, name, way_of(name), center)
        inertia = InertiaForce.of_mass(center, found.mass, member)
        return WheelMass(element, center, found.mass, inertia)
    start = cmath.phase(drive.vector(placed))
    element = Crank(member, name, center_of(name), center, abs(placed), start)
    # about its shaft, which stands still
    inertia = InertiaForce.of_turn(NamedCoordinate(name), _M2 * found.inertia, name)
    return WheelMass(element, center, found.mass, inertia)
