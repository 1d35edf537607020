"""A cam with its follower in motion: the model of a design, its motion and its forces."""

from __future__ import annotations

import math
from dataclasses import replace
from functools import cached_property, partial
from typing import TYPE_CHECKING, Any, Final

import numpy as np

from gearcam.base.errors import DesignError, InfeasibleError, MissingExtraError, Problem
from gearcam.base.findings import limit_of
from gearcam.base.numerals import FEW, formatted
from gearcam.cams.spec import POINTED
from gearcam.dynamics.follower import ElasticFollower, damping_of
from gearcam.dynamics.follower_checks import MOVING
from gearcam.dynamics.follower_motion import settle
from gearcam.dynamics.periodic import Periodic, elastic_jump, keeping_stiffness
from gearcam.kinds.under_load import UnderLoad
from gearcam.mechanics.follower_loads import DrivenMotion
from gearcam.mechanics.hertz import line_stiffness
from gearcam.mechanics.statics import Statics, solve
from gearcam.numeric.arrays import distinct
from gearcam.numeric.narrowing import neighbours, summits
from gearcam.numeric.piecewise import with_both_sides

if TYPE_CHECKING:
    from collections.abc import Sequence

    from gearcam.dynamics.follower_motion import Turn
    from gearcam.kinds.cam.result import CamResult
    from gearcam.mechanics.follower_loads import Loads
    from gearcam.mechanics.mass import MassSpec
    from gearcam.numeric.arrays import Array, Mask

_EVEN: Final = 720
"""Even steps of a turn at which means are taken."""

_PER_PERIOD: Final = 12
"""Places in the fastest natural period at which extremes are looked for."""

_MOST: Final = 20_000
"""Largest number of places."""

_LEFT: Final = 1e-5
"""What a spring that is solved for leaves above the least contact force, over the load, and ten
tolerances at least: so does one in six digits."""

_NARROW: Final = 1e-8
"""Width, over the turn, to which an extreme is narrowed."""

_APART: Final = 1e-12
"""Knots that are nearer to each other, over a turn, are one."""


def demand(design: Any) -> None:
    """Refuse a design whose dynamics are not known, and a missing extra.

    Parameters
    ----------
    design : CamDesign
        The design.

    Raises
    ------
    DesignError
        If mass, speed or a stiffness is missing, or the cam slides.
    MissingExtraError
        If scipy is not installed.
    """
    dynamics = design.dynamics
    behind = any(one.of == "train" for one in design.mass)
    blunt = design.follower.type in ("flat", *POINTED)
    flat = f"a {design.follower.type} follower has no radius that the formula of Hertz needs"
    on_cam = [one for one in design.mass if one.of == "follower"]
    lacks = "is missing: a mass behind the train needs the stiffness of"
    slides = "a cam that slides to and fro has no constant speed: it has no dynamics here"
    still = "is missing: dynamics need the speed of the cam"
    train = dynamics.train_key(oscillating=design.follower.oscillating)
    contact = "dynamics.contact_stiffness_n_mm"
    translates = design.form == "translating"
    cases = (
        (translates, "cam.form", slides, "another form"),
        (not translates and design.drive.speed is None, "drive.speed_rpm", still,
         "a speed above 0"),
        (not on_cam, "mass", "is missing: dynamics need the mass of the follower",
         '[[mass]] with of = "follower"'),
        (behind and dynamics.train is None, train, f"{lacks} the train", "a number above 0"),
        (behind and dynamics.contact_stiffness is None, contact, f"{lacks} the contact too",
         'a number above 0, or "hertz"'),
        (dynamics.contact_stiffness == "hertz" and blunt, contact, flat, "a number above 0"),
    )  # fmt: skip
    problems = [
        Problem(what, file=design.source, key=key, allowed=near)
        for wrong, key, what, near in cases
        if wrong
    ]
    if problems:
        raise DesignError(problems)
    MissingExtraError.unless("scipy", what="dynamics", extra="dynamics")


class MovingCam:
    """A cam with its follower in motion.

    Parameters
    ----------
    result : CamResult
        The cam.

    Raises
    ------
    DesignError, InfeasibleError
        If its dynamics or its loads are not known.
    """

    def __init__(self, result: CamResult) -> None:
        demand(result.design)
        program = result.program
        for one in program.hard:
            if not one.slight:
                what = f"the velocity jumps {result.driver.place(one.theta)}: so does the follower"
                near = "a law without jumps of velocity"
                raise InfeasibleError(what, where="motion", nearest=near)
        self.result, self.spec = result, result.design.dynamics
        self.under = UnderLoad(result)
        self._rigid: Loads = self.under.loads
        self.speed = float(result.design.drive.speed or 0.0)  # rad/s
        self.held = len(result.touches) > 1

    @property
    def lift_unit(self) -> tuple[float, str]:
        """The unit of lifts over that inside, and its name."""
        return self.result.cam.motions[0].follower.lift_unit

    @property
    def timed(self) -> dict[str, float]:
        """Velocity and further derivatives in time over those by the angle, by their names."""
        return self.result.cam.motions[0].timed_scales(self.speed)

    @property
    def rise(self) -> float:
        """The whole lift, mm or rad."""
        return float(np.ptp(self.result.program.range))

    @property
    def elastic(self) -> bool:
        """Whether train or contact are elastic."""
        return self.spec.elastic

    def groups(self) -> list[Sequence[MassSpec]]:
        """Return the masses on the cam, and those behind the train, if there are any."""
        masses = self.result.design.mass
        behind = [one for one in masses if one.of == "train"]
        return [[one for one in masses if one.of != "train"], *([behind] if behind else [])]

    @cached_property
    def solved(self) -> dict[str, float]:
        """What springs that are solved for need to keep the elastic follower on its cam.

        Without friction, at the speed of the drive, with the least contact force that the check
        `near-jump` asks for; as for a rigid follower where it is rigid, or pressed from above or
        held.

        Raises
        ------
        InfeasibleError
            If none does that is softer than the train.
        """
        loads = self._rigid
        if not (self.elastic and loads.solved) or self.held or loads.side < 0.0:
            return loads.solved
        (what,) = loads.solved
        without = self._follower(self._with({what: 0.0}))
        share = limit_of(MOVING, "near-jump", self.result.design.limits)
        left = max(_LEFT, 10.0 * self.spec.tolerance) * without.sizes[0]
        if what == "preload":
            lack = left - Periodic(without).spare(share)
            found = lack / (1.0 - share) / without.rest_share
        else:
            found = keeping_stiffness(without, share, left) - without.spring
        if math.isinf(found):
            spring = next(k for k, one in enumerate(loads.springs) if one.solved)
            told = "no stiffness softer than the train keeps the elastic follower on the cam, with "
            told += f"{formatted(share, FEW)} of the mean contact force at least"
            raise InfeasibleError(told, where=f"spring[{spring}]", nearest="more preload")
        return {what: max(0.0, found)}

    def _with(self, solved: dict[str, float]) -> Loads:
        springs = [one.with_solved(solved) for one in self._rigid.springs]
        return replace(self._rigid, springs=springs)

    @cached_property
    def loads(self) -> Loads:
        """What acts on the follower, with springs as solved."""
        return self._with(self.solved)

    @cached_property
    def follower(self) -> ElasticFollower:
        """The elastic follower."""
        return self._follower(self.loads)

    @property
    def knots(self) -> Array:
        """Where lift or loads are not smooth, over the turn, rad."""
        program, given = self.result.program, self._rigid.given
        found = [program.knots, *(np.asarray(one.knots) for one in given)]
        if any(one.against for one in given):
            found.append(np.array([one.start for one in program.stretches]))
        knots = distinct(*found)
        knots = knots[knots < program.period - _APART]
        knots = knots[np.diff(knots, prepend=0.0) > _APART * program.period]
        return np.concatenate([[0.0], knots, [program.period]])

    def _follower(self, loads: Loads) -> ElasticFollower:
        first, *behind = (replace(loads, masses=one, given=(), springs=()) for one in self.groups())
        preload = sum(float(one.force) for one in loads.springs)

        def acting(x: Array) -> Array:
            motion = loads.motion(x)
            on_cam = [first.still(motion)] if behind else []
            return np.array([*on_cam, loads.still(motion) - sum(on_cam) + preload])

        masses = tuple(one.inertia for one in (first, *behind))
        stiffness, ratios = self._springs(bool(behind))
        pairs = zip(ratios, stiffness, masses, strict=True)
        return ElasticFollower(
            masses=masses,
            stiffness=stiffness,
            damping=tuple(damping_of(*pair) for pair in pairs),
            spring=sum(float(one.rate) for one in loads.springs),
            damper=loads.damper,
            speed=self.speed,
            lift=self.result.program.derivatives,
            loads=acting,
            knots=self.knots,
            side=loads.side,
            held=self.held,
        )

    def _springs(self, two: bool) -> tuple[tuple[float, ...], tuple[float, ...]]:
        """Return stiffnesses from the cam on, and their damping ratios."""
        train, contact = self.spec.train, self.contact_stiffness
        of_train, of_contact = self.spec.damping_ratio
        if two and train and contact:
            return (contact, train), (of_contact, of_train)
        soft = sum(1.0 / one for one in (train, contact) if one)
        return (1.0 / soft,), (of_train if train else of_contact,)

    @cached_property
    def contact_stiffness(self) -> float | None:
        """Stiffness of the contact along the lift, N/mm or N mm/rad; the mean of the turn."""
        given = self.spec.contact_stiffness
        if given is None:
            return None
        x = self.result.program.period * np.arange(_EVEN) / _EVEN
        touch = self.result.touches[0]
        motion = self._rigid.motion(x)
        push, _ = touch.push(motion, self._rigid.support, 0.0)
        if isinstance(given, str):
            statics = self.under.statics(x, np.ones_like(x))
            force, bent = np.nanmean(statics.force), statics.curvature
            bent = float(np.mean(bent[np.isfinite(bent) & (bent > 0.0)]))
            radii = float(np.abs(push.at).mean()), touch.radius
            width, material = self.result.contact_width, self.result.design.material
            given = line_stiffness(float(force), bent, radii, width, material)
        return given * float(np.mean(push.plain**2))

    @cached_property
    def periodic(self) -> Periodic:
        """The motion that never leaves the cam."""
        return Periodic(self.follower)

    @cached_property
    def jump(self) -> float | None:
        """Lowest speed at which the elastic follower leaves its cam, rad/s (see `elastic_jump`)."""
        return None if self.held else elastic_jump(self.follower)

    @cached_property
    def turn(self) -> Turn:
        """The last turn of the integrated motion."""
        periodic, spec = self.periodic, self.spec
        start = periodic.start
        if not self.held and self.follower.side * periodic.forces[0] <= 0.0:
            start = np.zeros_like(start)
            start[0::2] = self.follower.rest(np.zeros(1))[:, 0]
        return settle(
            self.follower, start, turns=spec.turns, method=spec.method, tolerance=spec.tolerance
        )

    @cached_property
    def places(self) -> Array:
        """Angles of the facts, rad: both sides of knots and switches, and where extremes are."""
        period = self.result.program.period
        count = _EVEN
        if self.elastic:
            count = int(min(max(_EVEN, _PER_PERIOD * self.follower.periods), _MOST))
        even = period * np.arange(count + 1.0) / count
        x = self._beside(even)
        narrow = _NARROW * period
        _, found, _ = summits(lambda places: self.at(places).sought, self.at(x).sought,
                              *neighbours(x), narrow)  # fmt: skip
        return distinct(x, found)

    @property
    def rows(self) -> Array:
        """Angles of the table, rad: each degree, both sides of knots and switches."""
        return self._beside(self.result.program.period * np.arange(361.0) / 360.0)

    def _beside(self, even: Array) -> Array:
        even[-1] = np.nextafter(even[-1], 0.0)
        flights = self.turn.flights if self.elastic else ()
        switches = [x for one in flights for x in (one.start, one.end)]
        return with_both_sides(even, np.append(self.knots, switches))

    def at(self, x: Array) -> Moment:
        """Return what is at angles (n,), rad."""
        return Moment(self, x)


class Moment:
    """A follower in motion, at angles of its cam.

    Parameters
    ----------
    moving : MovingCam
        The cam.
    x : (n,) array, rad
        The angles.
    """

    def __init__(self, moving: MovingCam, x: Array) -> None:
        self.moving, self.x = moving, x
        self.rigid = moving.loads.motion(x)

    @cached_property
    def _states(self) -> tuple[Array, Mask]:
        return self.moving.turn.states(self.x)

    @property
    def contact(self) -> Mask:
        """Where the follower is on its cam."""
        if not self.moving.elastic:
            return ~self.statics.lifted
        return self._states[1]

    @cached_property
    def motions(self) -> list[DrivenMotion]:
        """The motion of each mass."""
        if not self.moving.elastic:
            return [self.rigid]
        states, contact = self._states
        found = self.moving.follower.accelerations(self.x, states, contact)
        return [
            DrivenMotion(
                self.x, self.rigid.s + states[2 * k], self.rigid.ds + states[2 * k + 1], one
            )
            for k, one in enumerate(found)
        ]

    @cached_property
    def dwells(self) -> list[tuple[float, float, float]]:
        """Ends of each dwell, and the farthest that an elastic follower is from rest in it."""
        found, program = [], self.moving.result.program
        for one in program.stretches if self.moving.elastic else ():
            inside = (self.x >= one.start) & (self.x < one.end)
            if one.kind == "dwell" and inside.any():
                x = self.x[inside]
                follower = self.moving.follower
                apart = self._states[0][follower.last, inside] - follower.rest(x)[-1]
                found.append((one.start, one.end, float(np.abs(apart).max())))
        return found

    def place(self, index: int) -> str:
        """Return an angle in words."""
        return self.moving.result.driver.place(float(self.x[index]))

    @cached_property
    def statics(self) -> Statics:
        """The forces, with that of the moving follower along the lift."""
        moving, loads = self.moving, self.moving.loads
        design, total = moving.result.design, loads.total_load(self.rigid)
        if moving.elastic:
            pressing = sum(
                replace(loads, masses=masses).pressing(motion)
                for masses, motion in zip(moving.groups(), self.motions, strict=True)
            )
            force = np.where(self.contact, moving.follower.contact_force(self._states[0]), 0.0)
            total = replace(total, against=force, resultant=np.asarray(pressing))
        share = partial(moving.result.follower_spec.dragged, design.friction)
        return solve(moving.result.touches, loads, self.rigid, share, total)

    @cached_property
    def normal(self) -> Array:
        """Normal force of the cam, N: 0 in flight, nan where friction locks the follower."""
        statics = self.statics
        return np.where(self.contact & ~statics.lifted, statics.force, 0.0)

    @property
    def pressure(self) -> Array:
        """Contact pressure, MPa: 0 in flight, infinite on an edge."""
        return np.where(self.contact, self.moving.under.pressure(self.statics), 0.0)

    @property
    def torque(self) -> Array:
        """Torque of the cam, N mm: 0 in flight."""
        return np.where(self.contact, self.statics.torque, 0.0)

    @property
    def sought(self) -> Array:
        """What is looked for where it is largest, (q, n)."""
        pressure = np.where(np.isinf(self.pressure), np.nan, self.pressure)
        acceleration = np.abs(self.motions[-1].d2s)
        found = np.stack(
            [self.normal, -self.normal, self.torque, -self.torque, pressure, acceleration]
        )
        return np.where(np.isnan(found), -np.inf, found)
