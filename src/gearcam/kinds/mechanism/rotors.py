"""Rotors of a mechanism: the weights in two planes that balance what turns together."""

from __future__ import annotations

import cmath
import math
from typing import TYPE_CHECKING, Any, Final, NamedTuple

import numpy as np

from gearcam.base.errors import DesignError, Problem
from gearcam.base.facts import Fact, Tree
from gearcam.base.numerals import FEW, formatted
from gearcam.kinds.mechanism.loaded import BODY, HeavyBody, heavy_bodies
from gearcam.linkages.balance import MILLI, two_planes
from gearcam.linkages.bonds import Hinge
from gearcam.linkages.coordinates import NamedCoordinate
from gearcam.linkages.efforts import InertiaForce
from gearcam.linkages.known import GROUND
from gearcam.linkages.reactions import Structure
from gearcam.numeric import narrowing
from gearcam.parts.mass import products_of_inertia

if TYPE_CHECKING:
    from collections.abc import Sequence

    from gearcam.kinds.mechanism.design import RotorSpec
    from gearcam.kinds.mechanism.result import MechanismResult
    from gearcam.linkages.efforts import Effort
    from gearcam.linkages.known import Known
    from gearcam.linkages.linkage import Linkage
    from gearcam.linkages.work import VirtualWork
    from gearcam.numeric.arrays import Array, Plane

_TURNED: Final = 1e-9
"""Angle that is none, rad: between parts that turn together, and between near places."""

_MOVED: Final = 1e-6
"""Distance of two axes, or way of a centre of mass, that is none, mm."""

_NONE: Final = 1e-9
"""Distance of a centre of mass from the axis that is none, mm, and share of an unbalance."""


class Rotor(NamedTuple):
    """What a rotor's parts are without weights.

    Attributes
    ----------
    spec : RotorSpec
        Its table.
    unbalance : complex, kg mm
        Mass times place of all parts, in the frame of the first one.
    lever : complex, kg mm2
        Sum of the unbalances times their places along the axis.
    none : float, kg mm
        Unbalance that is rounding.
    bend : float
        Largest second derivative of its direction by the master's angle: 1 if it turns with that.
    """

    spec: RotorSpec
    unbalance: complex
    lever: complex
    none: float
    bend: float


def hinges_on_frame(linkage: Linkage) -> dict[str, Hinge]:
    """Return the members of a `linkage` that turn about a fixed hinge, with that."""
    bonds = Structure.of(linkage).bonds
    return {one.on: one for one in bonds if isinstance(one, Hinge) and one.by == GROUND}


class _Part:
    """A member, wheel or cam that turns about a fixed axis, at angles of the master."""

    def __init__(
        self, known: Known, hinge: Hinge, efforts: Sequence[Effort], body: HeavyBody | None
    ) -> None:
        self.name, self.body = hinge.on.removesuffix(BODY), body
        self.axis, self.direction = known.place(hinge.place), known.direction(hinge.on)
        if body is not None:  # the frame of the wheel or the cam itself
            turn = np.asarray(known.jet(body.name).c[0]) + body.drive.spec.turn
            self.direction = np.exp(1j * turn)
        self.masses = [
            (one.amount / MILLI, known.place(one.coordinate.name) - self.axis)
            for one in efforts
            if isinstance(one, InertiaForce) and one.member == hinge.on
            if isinstance(one.coordinate, NamedCoordinate)
        ]

    def wrong(self, first: _Part) -> str:
        """Return why it cannot be on a rotor whose first part is another one; empty if it can."""
        if not self.masses:
            return f"{self.name} has no mass"
        angle = self.direction * first.direction.conj()
        if np.abs(self.axis - first.axis).max() > _MOVED or _changes(angle, _TURNED):
            return f"{self.name} does not turn with {first.name} about one axis"
        own = [place * self.direction.conj() for _, place in self.masses]
        if any(_changes(one, _MOVED) for one in own):
            return f"a centre of mass of {self.name} does not turn with it"
        return ""

    def unbalance(self, frame: Plane) -> complex:
        """Return its mass times place, kg mm, in a frame that turns with it."""
        return sum(complex(mass * (place * frame.conj())[0]) for mass, place in self.masses)

    def products(self, frame: Plane) -> complex:
        """Return its own products of inertia in that frame, kg mm2; 0 of what has no thickness."""
        if self.body is None:
            return 0j
        own = products_of_inertia(self.body.shape, self.body.density)
        if self.body.drive.spec.mirror:  # its own y axis is reversed, and z looks away
            own = -own.conjugate()
        return own * complex(self.direction[0] * frame[0].conj())


def _changes(values: Plane, none: float) -> bool:
    return float(np.abs(values - values[0]).max()) > none


def rotors_of(result: MechanismResult, work: VirtualWork, q: Array) -> list[Rotor]:
    """Return the rotors of a mechanism.

    Parameters
    ----------
    result : MechanismResult
        The mechanism.
    work : VirtualWork
        What acts on it.
    q : (n,) array, rad
        The master's angles, at which parts are compared.

    Raises
    ------
    DesignError
        If parts do not turn together about a fixed axis, or have no mass.
    """
    if not result.design.rotor:
        return []
    hinges = {one.removesuffix(BODY): hinge for one, hinge in hinges_on_frame(work.linkage).items()}
    bodies = {one.name: one for one in heavy_bodies(result.drives)}
    known = work.linkage.at(q, 0)
    parts, problems = dict[str, _Part](), list[Problem]()
    for number, spec in enumerate(result.design.rotor):
        for place, name in enumerate(spec.parts):
            what, near = "", ", ".join(hinges)
            if name not in hinges:
                what = f"{name} is no member about a fixed hinge, and no wheel or cam of a density"
            else:
                parts[name] = _Part(known, hinges[name], work.efforts, bodies.get(name))
                what = parts[name].wrong(parts.get(spec.parts[0], parts[name]))
                near = "parts with a mass, on one shaft"
            if what:
                key = f"rotor[{number}].parts[{place}]"
                problems.append(Problem(what, file=result.design.source, key=key, allowed=near))
    if problems:
        raise DesignError(problems)
    return [
        _rotor(one, [parts[name] for name in one.parts], _bend(work, hinges[one.parts[0]].on, q))
        for one in result.design.rotor
    ]


def _rotor(spec: RotorSpec, parts: list[_Part], bend: float) -> Rotor:
    frame = parts[0].direction
    each = [one.unbalance(frame) for one in parts]
    levers = [z * own for z, own in zip(spec.places, each, strict=True)]
    levers += [one.products(frame) for one in parts]
    masses = sum(mass for one in parts for mass, _ in one.masses)
    none = _NONE * (masses + sum(abs(one) for one in each))
    return Rotor(spec, sum(each), sum(levers), none, bend)


def _bend(work: VirtualWork, member: str, q: Array) -> float:
    """Return the largest second derivative of a member's direction, between places too."""

    def rows(x: Array) -> Array:
        found = work.linkage.at(x, 2).frame(member).direction.derivatives()[2]
        return np.abs(found + np.zeros(x.shape))[None]

    _, _, values = narrowing.summits(rows, rows(q), *narrowing.neighbours(q), _TURNED)
    return float(values.max())


def rotor_facts(rotor: Rotor, speed: float) -> Tree:
    """Return the facts of a rotor: its unbalance, and the weights against it.

    Parameters
    ----------
    rotor : Rotor
        The rotor.
    speed : float, rad/s
        Of the master.
    """
    spec, name = rotor.spec, f"rotor {rotor.spec.name}"
    frame, middle = f"in the frame of {spec.parts[0]}", 0.5 * sum(spec.planes)
    width = abs(spec.planes[1] - spec.planes[0])
    static = _rounded(rotor.unbalance, rotor.none)
    couple = _rounded(rotor.lever - middle * rotor.unbalance, rotor.none * width)
    about = f"{name}: couple unbalance about the middle of its planes"
    tree: Tree = {
        "frame": spec.parts[0],
        "static_kg_mm": _vector(static, f"{name}: static unbalance", frame, "kg mm"),
        "static_angle_deg": _degrees(static),
        "couple_kg_mm2": _vector(couple, about, frame, "kg mm2"),
        "couple_angle_deg": _degrees(couple),
        "weights": [],
    }
    carried = two_planes(rotor.unbalance, rotor.lever, spec.planes)
    for place, one in zip(spec.planes, carried, strict=True):
        weight, label = _rounded(-one, rotor.none), f"{name}: weight at {formatted(place, FEW)} mm"
        own = weight_facts(weight, spec.radius, label, frame, f"{label}, its mass", "the axis")
        force = MILLI * speed**2 * rotor.bend * abs(weight)
        own["force_n"] = Fact(force, f"{label}, its largest force", unit="N", shown=True)
        tree["weights"].append({"place_mm": place, **own})
    return tree


def _rounded(vector: complex, none: float) -> complex:
    """Return a vector whose components are 0 where they are not above rounding."""
    x, y = (part if abs(part) > none else 0.0 for part in (vector.real, vector.imag))
    return complex(x, y)


def _degrees(vector: complex) -> float:
    return math.degrees(cmath.phase(vector)) % 360.0


def _vector(vector: complex, label: str, frame: str, unit: str) -> Fact:
    place = f"at {formatted(_degrees(vector), FEW)} deg {frame}"
    return Fact(abs(vector), label, place=place, unit=unit, shown=True)


def weight_facts(
    weight: complex, radius: float | None, label: str, frame: str, mass: str, center: str
) -> dict[str, Any]:
    """Return the facts of a weight on what turns.

    Parameters
    ----------
    weight : complex, kg mm
        Mass times place.
    radius : float or None, mm
        Its distance from the axis, for its mass.
    label, frame, mass, center : str
        In words: what it is, in which frame its angle is, what its mass is called, and from where
        its distance counts.
    """
    return {
        "unbalance_kg_mm": _vector(weight, f"{label}, mass times distance", frame, "kg mm"),
        "angle_deg": _degrees(weight),
        "mass_kg": radius
        and Fact(
            abs(weight) / radius,
            f"{mass} at {formatted(radius, FEW)} mm from {center}",
            unit="kg",
            shown=True,
        ),
    }
