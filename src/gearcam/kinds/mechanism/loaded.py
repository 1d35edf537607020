"""What acts on a mechanism: its loads, masses and springs, and the wheels of its pairs as masses.

Wheels have a density in their own design, and the parts as made.
"""

from __future__ import annotations

import cmath
from collections.abc import Iterator, Sequence
from dataclasses import replace
from typing import TYPE_CHECKING, Final, NamedTuple

from gearcam.kinds.mechanism.keys import center_of, way_of
from gearcam.kinds.mechanism.names import acted_on, acting, tables_of
from gearcam.kinds.mechanism.parts.action import LoadedLinkage
from gearcam.linkages.coordinates import NamedCoordinate
from gearcam.linkages.efforts import GRAVITY, SPRINGS, InertiaForce, force_on
from gearcam.linkages.elements import Crank, Element, PushedSlide
from gearcam.linkages.work import VirtualWork

if TYPE_CHECKING:
    from gearcam.kinds.mechanism.design import MechanismDesign
    from gearcam.kinds.mechanism.placed import PlacedDrive
    from gearcam.linkages.linkage import Linkage
    from gearcam.parts.mass import MassProperties

BODY: Final = ".body"
"""Behind the name of a shaft or a way: the member on it."""

_M2: Final = 1e-6
"""m2 of a mm2."""


def work_of(
    design: MechanismDesign, linkage: Linkage, drives: Sequence[PlacedDrive]
) -> VirtualWork:
    """Return what acts on a mechanism.

    Parameters
    ----------
    design : MechanismDesign
        The design.
    linkage : Linkage
        Its linkage.
    drives : sequence of PlacedDrive
        Its drives; pairs whose designs give a density have masses.

    Returns
    -------
    VirtualWork

    Raises
    ------
    InfeasibleError
        If a load begins before the slide's whole travel, or its table does not reach over the
        master's range.
    """
    tables, wheels = tables_of(design), list(_wheel_masses(drives))
    acted = acted_on(tables)
    points = [point for (_, k), one in acting(tables) for point in one.points(acted, k)]
    points += [one.element for one in wheels]
    whole = replace(linkage, elements=(*linkage.elements, *points))
    on = LoadedLinkage(whole, acted, design.drive[0].speed, design.gravity.pull)
    efforts = [effort for (_, k), one in acting(tables) for effort in one.efforts(on, k)]
    for wheel in wheels:
        efforts.append(wheel.effort)
        if on.pull:
            efforts.append(force_on(wheel.center, wheel.mass * on.pull, GRAVITY))
    efforts.sort(key=lambda one: one.part == SPRINGS)  # last, behind all that has a mass
    return VirtualWork(whole, efforts, on.speed, tuple(on.knots))


class _WheelMass(NamedTuple):
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


def _wheel_masses(drives: Sequence[PlacedDrive]) -> Iterator[_WheelMass]:
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


def _wheel(drive: PlacedDrive, word: str, found: MassProperties) -> _WheelMass:
    name, placed = f"{drive.spec.name}.{word}", complex(*found.centroid[:2])
    member, center = name + BODY, f"{name}.center of mass"
    if drive.moved[word].along:  # any point of it has its way
        element = PushedSlide(member, name, way_of(name), center)
        inertia = InertiaForce.of_mass(center, found.mass, member)
        return _WheelMass(element, center, found.mass, inertia)
    start = cmath.phase(drive.vector(placed))
    element = Crank(member, name, center_of(name), center, abs(placed), start)
    # about its shaft, which stands still
    inertia = InertiaForce.of_turn(NamedCoordinate(name), _M2 * found.inertia, name)
    return _WheelMass(element, center, found.mass, inertia)
