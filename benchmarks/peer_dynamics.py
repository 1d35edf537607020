"""Shafts by the package openTorsion and a follower that leaves its cam by EXUDYN, both from PyPI.

Units of shafts: kg m2, N m/rad, rad/s; of followers: N, mm, s, and N s2/mm for masses.
"""

from __future__ import annotations

import math
from collections.abc import Callable, Sequence
from dataclasses import dataclass
from typing import Any

import exudyn
import numpy as np
from exudyn.itemInterface import (
    MarkerNodeCoordinate,
    Node1D,
    NodeGenericODE1,
    NodePointGround,
    ObjectConnectorCoordinateSpringDamper,
    ObjectGenericODE1,
    ObjectMass1D,
    SensorNode,
    SensorObject,
)
from numpy.typing import NDArray
from opentorsion import Assembly, Disk, ElasticGear, Shaft

Array = NDArray[np.float64]

_FIXED = 1e12
"""Moment of inertia of what stands still, over those of what vibrates."""

_STEPS = 2000
"""Least number of steps in a turn; the error decides about more."""


def pair_frequency(inertia: tuple[float, float], ratio: float, stiffness: float) -> float:
    """Return the natural frequency of two shafts whose teeth have a stiffness at the driven one."""
    driver = ElasticGear(0, 0.0, 1.0)
    # openTorsion counts the stiffness of teeth at the driver
    driven = ElasticGear(1, 0.0, 1.0 / ratio, k=stiffness * ratio**2, c=0.0, parent=driver)
    disks = [Disk(node, one) for node, one in enumerate(inertia)]
    train = Assembly([], disks, elastic_gear_elements=[driver, driven])
    return float(train.modal_analysis()[0][-1])


def chain_frequencies(inertia: Sequence[float], stiffness: Sequence[float]) -> Array:
    """Return the natural frequencies of disks between two walls, rising; shafts from wall on."""
    wall = _FIXED * max(inertia)
    disks = [Disk(node, one) for node, one in enumerate([wall, *inertia, wall])]
    shafts = [Shaft(node, node + 1, k=one) for node, one in enumerate(stiffness)]
    return Assembly(shafts, disks).modal_analysis()[0][4::2]


@dataclass(frozen=True)
class Train:
    """Two masses on a cam: springs before each, with dampers, and a spring behind the last."""

    masses: tuple[float, float]
    stiffness: tuple[float, float]
    damping: tuple[float, float]
    spring: float
    preload: float
    lift: Callable[[float], tuple[float, float]]
    """Lift and its derivative at an angle of the cam, rad."""
    speed: float
    """Of the cam, rad/s."""


@dataclass(frozen=True)
class LastTurn:
    """The last of some turns, at the steps of the integration."""

    angle: Array
    """rad"""
    force: Array
    """Contact force, N."""
    left: Array
    """Where it leaves the cam, rad."""
    met: Array
    """Where it meets it again, rad."""
    impact: Array
    """Speeds there, mm/s."""


class _Contact:
    """A spring with a damper that only presses, between a cam and a mass.

    In flight its end, which has no mass, relaxes; its distance from the cam is a state of its own.
    """

    def __init__(self, train: Train, mass: int, gap: int) -> None:
        self._train, self._mass, self._gap = train, mass, gap
        self._k, self._c = train.stiffness[0], train.damping[0]

    def press(self, time: float, place: float, rate: float) -> float:
        """Return the force of the spring as if in contact."""
        lift, slope = self._train.lift(self._train.speed * time)
        return self._k * (lift - place) + self._c * (self._train.speed * slope - rate)

    def force(self, system: Any, time: float, *given: float) -> float:
        """Return what pulls the mass to the cam: user function of a spring of EXUDYN."""
        _, place, rate, _, _, _ = given
        gap = system.GetNodeOutput(self._gap, exudyn.OutputVariableType.Coordinates)
        return 0.0 if gap > 0.0 else min(0.0, -self.press(time, place, rate))

    def opening(self, system: Any, time: float, _: int, gap: Array) -> list[float]:
        """Return how fast the end leaves the cam: user function of a state of EXUDYN."""
        kind = exudyn.OutputVariableType
        place = system.GetNodeOutput(self._mass, kind.Coordinates)
        rate = system.GetNodeOutput(self._mass, kind.Coordinates_t)
        press = self.press(time, place, rate)
        return [0.0 if gap[0] <= 0.0 < press else -(press + self._k * gap[0]) / self._c]


def flown(train: Train, turns: int, tolerance: float) -> LastTurn:
    """Return the last of some turns; the first begins at rest under the preload."""
    container = exudyn.SystemContainer()
    system = container.AddSystem()
    contact, sensors = _assembled(system, train)
    _integrate(system, math.tau * turns / train.speed, turns * _STEPS, tolerance)
    read = [np.asarray(system.GetSensorStoredData(one)) for one in sensors]
    time, begin = read[0][:, 0], math.tau * (turns - 1) / train.speed
    kept = time >= begin
    pull, apart, place, rate = (one[kept, 1] for one in read)
    angle = train.speed * (time[kept] - begin)
    press = np.array([contact.press(*one) for one in zip(time[kept], place, rate, strict=True)])
    off = ((apart > 0.0) | (press <= 0.0)).astype(int)
    leaves, meets = (np.flatnonzero(np.diff(off) == one) for one in (1, -1))
    return LastTurn(
        angle=angle,
        force=-pull,
        left=_zeros(angle, press, leaves),
        met=_zeros(angle, apart, meets),
        impact=press[meets + 1] / train.damping[0],
    )


def _assembled(system: Any, train: Train) -> tuple[_Contact, list[Any]]:
    """Fill the system, and return the contact and the sensors.

    They tell force and gap of the contact, place and speed of the first mass.
    """
    bent = -train.preload / train.stiffness[0]
    rest = bent, bent - train.preload / train.stiffness[1]
    one, two = (
        system.AddNode(Node1D(referenceCoordinates=[0.0], initialCoordinates=[x])) for x in rest
    )
    still = {"referenceCoordinates": [0.0], "initialCoordinates": [0.0]}
    gap = system.AddNode(NodeGenericODE1(**still, numberOfODE1Coordinates=1))
    for node, mass in zip((one, two), train.masses, strict=True):
        system.AddObject(ObjectMass1D(mass=mass, nodeNumber=node))
    frame, first, last = (
        system.AddMarker(MarkerNodeCoordinate(nodeNumber=node, coordinate=0))
        for node in (system.AddNode(NodePointGround()), one, two)
    )

    def spring(*between: Any, **values: Any) -> Any:
        made = ObjectConnectorCoordinateSpringDamper(markerNumbers=list(between), **values)
        return system.AddObject(made)

    contact = _Contact(train, one, gap)
    touch = spring(frame, first, springForceUserFunction=contact.force)
    spring(first, last, stiffness=train.stiffness[1], damping=train.damping[1])
    spring(frame, last, stiffness=train.spring, offset=-train.preload / train.spring)
    system.AddObject(ObjectGenericODE1(nodeNumbers=[gap], rhsUserFunction=contact.opening))
    kind, kept = exudyn.OutputVariableType, {"storeInternal": True}
    sensors = [
        SensorObject(objectNumber=touch, outputVariableType=kind.Force, **kept),
        SensorNode(nodeNumber=gap, outputVariableType=kind.Coordinates, **kept),
        SensorNode(nodeNumber=one, outputVariableType=kind.Coordinates, **kept),
        SensorNode(nodeNumber=one, outputVariableType=kind.Coordinates_t, **kept),
    ]
    told = [system.AddSensor(sensor) for sensor in sensors]
    system.Assemble()
    return contact, told


def _integrate(system: Any, end: float, steps: int, tolerance: float) -> None:
    """Integrate to a time, s."""
    settings = exudyn.SimulationSettings()
    time = settings.timeIntegration
    time.endTime, time.numberOfSteps = end, steps
    time.automaticStepSize, time.minimumStepSize = True, 1e-16
    time.relativeTolerance, time.absoluteTolerance = tolerance, 1e-2 * tolerance
    settings.solution.file.write = False
    settings.solution.sensors.writePeriod = 1e-15  # every step
    exudyn.config.printToConsole = False
    system.SolveDynamic(settings, solverType=exudyn.DynamicSolverType.DOPRI5)


def _zeros(x: Array, y: Array, steps: NDArray[np.intp]) -> Array:
    """Return where y, linear in each step, is 0."""
    width, rise = np.diff(x)[steps], np.diff(y)[steps]
    return x[steps] - y[steps] * width / rise
