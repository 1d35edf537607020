"""What acts on a mechanism: its loads, masses and springs, and the wheels of its pairs as masses.

Wheels have a density in their own design, and the parts as made.
"""

from __future__ import annotations

import cmath
from collections.abc import Iterator, Sequence
from dataclasses import replace
from typing import TYPE_CHECKING, Final

from gearcam.kinds.mechanism.keys import center_of, way_of
from gearcam.kinds.mechanism.names import acted_on, acting, tables_of
from gearcam.kinds.mechanism.parts.action import LoadedLinkage
from gearcam.linkages.coordinates import MemberTurn
from gearcam.linkages.efforts import GRAVITY, SPRINGS, InertiaForce, force_on
from gearcam.linkages.elements import Crank, Element, PushedSlide
from gearcam.linkages.work import VirtualWork

if TYPE_CHECKING:
    from gearcam.kinds.mechanism.design import MechanismDesign
    from gearcam.kinds.mechanism.placed import PlacedDrive
    from gearcam.linkages.linkage import Linkage

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
    tables, wheels = tables_of(design), list(_wheels(drives))
    acted = acted_on(tables)
    points = [point for (_, k), one in acting(tables) for point in one.points(acted, k)]
    points += [element for element, *_ in wheels]
    whole = replace(linkage, elements=(*linkage.elements, *points))
    on = LoadedLinkage(whole, acted, design.drive[0].speed, design.gravity.pull)
    efforts = [effort for (_, k), one in acting(tables) for effort in one.efforts(on, k)]
    for _, center, mass, inertia in wheels:
        efforts += inertia
        if on.pull:
            efforts.append(force_on(center, mass * on.pull, GRAVITY))
    efforts.sort(key=lambda one: one.part == SPRINGS)  # last, behind all that has a mass
    return VirtualWork(whole, efforts, on.speed, tuple(on.knots))


def _wheels(
    drives: Sequence[PlacedDrive],
) -> Iterator[tuple[Element, str, float, list[InertiaForce]]]:
    """Yield wheels and racks with a density: an element, their centre of mass, mass and inertia."""
    from gearcam.parts.mass import mass_properties

    for drive in drives:
        if drive.spec.pair is None or drive.result is None:
            continue
        for number, (word, moved) in enumerate(drive.moved.items()):
            density = drive.result.design.blank.wheel(number + 1).density
            if density is None:
                continue
            mass = mass_properties(drive.result.parts[number], density)
            name = f"{drive.spec.name}.{word}"
            member, center = name + BODY, f"{name}.center of mass"
            inertia = [InertiaForce.of_mass(center, mass.mass, member)]
            if moved.along:  # any point of it has its way
                element = PushedSlide(member, name, way_of(name), center)
            else:
                off = drive.vector(complex(*mass.centroid[:2]))
                start = cmath.phase(off)
                element = Crank(member, name, center_of(name), center, abs(off), start)
                own = mass.inertia - mass.mass * abs(off) ** 2  # about its centre of mass
                inertia.append(InertiaForce.of_turn(MemberTurn(member), _M2 * own, member))
            yield element, center, mass.mass, inertia
