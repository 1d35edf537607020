"""What acts on a mechanism: its loads, masses and springs, and its wheels and cams as masses.

Wheels and cams have a density in their own design, and the parts as made.
"""

from __future__ import annotations

import cmath
from collections.abc import Iterator, Sequence
from dataclasses import replace
from typing import TYPE_CHECKING, Final, NamedTuple

from gearcam.kinds.mechanism.keys import center_of, way_of
from gearcam.kinds.mechanism.names import acted_on, acting, tables_of
from gearcam.kinds.mechanism.parts.acted import LoadedLinkage
from gearcam.linkages.coordinates import MemberTurn
from gearcam.linkages.efforts import GRAVITY, SPRINGS, InertiaForce, force_on
from gearcam.linkages.elements import Crank, Element, PushedSlide
from gearcam.linkages.work import VirtualWork
from gearcam.results.nested import within

if TYPE_CHECKING:
    from gearcam.kinds.mechanism.design import MechanismDesign
    from gearcam.kinds.mechanism.placed import PlacedDrive
    from gearcam.linkages.linkage import Linkage
    from gearcam.parts.body import Stack

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
        Its drives; wheels, racks and cams whose designs give a density have masses.

    Returns
    -------
    VirtualWork

    Raises
    ------
    InfeasibleError
        If a load begins before the slide's whole travel, or its table does not reach over the
        master's range.
    """
    tables, bodies = tables_of(design), list(_weighed(drives))
    acted = acted_on(tables)
    points = [point for (_, k), one in acting(tables) for point in one.points(acted, k)]
    points += [element for element, *_ in bodies]
    whole = replace(linkage, elements=(*linkage.elements, *points))
    on = LoadedLinkage(whole, acted, design.drive[0].speed, design.gravity.pull)
    efforts = [effort for (_, k), one in acting(tables) for effort in one.efforts(on, k)]
    for _, center, mass, inertia in bodies:
        efforts += inertia
        if on.pull:
            efforts.append(force_on(center, mass * on.pull, GRAVITY))
    efforts.sort(key=lambda one: one.part == SPRINGS)  # last, behind all that has a mass
    return VirtualWork(whole, efforts, on.speed, tuple(on.knots))


class HeavyBody(NamedTuple):
    """What a drive moves and that has a density: a wheel, a rack, a plate, the cams on its shaft.

    Attributes
    ----------
    drive : PlacedDrive
        The drive.
    word : str
        What moves it (see `MachineDrive.shafts`).
    shape : Stack
        Its parts as made.
    density : float, kg/m3
        Of the material.
    """

    drive: PlacedDrive
    word: str
    shape: Stack
    density: float

    @property
    def name(self) -> str:
        """Name of its shaft or slide."""
        return f"{self.drive.spec.name}.{self.word}"


def heavy_bodies(drives: Sequence[PlacedDrive]) -> Iterator[HeavyBody]:
    """Yield the wheels, racks and cams of drives whose designs give a density.

    Parameters
    ----------
    drives : sequence of PlacedDrive
        The drives.

    Raises
    ------
    InfeasibleError
        If a part cannot be made.
    """
    from gearcam.parts.body import Stack

    for number, drive in enumerate(drives):
        if drive.result is None or drive.spec.in_space:  # whose axis lies in the plane
            continue
        blank, cam = drive.result.design.blank, drive.spec.cam is not None
        with within(f"drive[{number}].{drive.spec.key}"):
            for wheel, word in enumerate([*drive.moved][: 1 if cam else None]):
                density = blank.density if cam else blank.wheel(wheel + 1).density
                if density is not None:
                    parts = drive.result.parts if cam else drive.result.parts[wheel : wheel + 1]
                    heights = drive.result.form.heights() if cam else (0.0,)
                    shape = Stack(name=word, parts=parts, heights=heights)
                    yield HeavyBody(drive, word, shape, density)


def _weighed(
    drives: Sequence[PlacedDrive],
) -> Iterator[tuple[Element, str, float, list[InertiaForce]]]:
    """Yield what has a density: an element, the centre of mass, mass and inertia."""
    from gearcam.parts.mass import mass_properties

    for body in heavy_bodies(drives):
        drive, name = body.drive, body.name
        mass = mass_properties(body.shape, body.density)
        member, center = name + BODY, f"{name}.center of mass"
        inertia = [InertiaForce.of_mass(center, mass.mass, member)]
        if drive.moved[body.word].along:  # any point of it has its way
            element = PushedSlide(member, name, way_of(name), center)
        else:
            off = drive.vector(complex(*mass.centroid[:2]))
            start = cmath.phase(off)
            element = Crank(member, name, center_of(name), center, abs(off), start)
            own = mass.inertia - mass.mass * abs(off) ** 2  # about its centre of mass
            inertia.append(InertiaForce.of_turn(MemberTurn(member), _M2 * own, member))
        yield element, center, mass.mass, inertia
