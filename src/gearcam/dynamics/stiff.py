"""The stiff model of a pair: rigid wheels, teeth as a spring with a damper, and backlash.

The driven wheel *lags* by ``e = Phi(phi1) - phi2`` behind its nominal place. With the backlash b,
an angle of the driven wheel, the teeth are bent by ``g = e - s*b/2`` on their driving flanks (s =
1, e > b/2) or coast flanks (s = -1, e < -b/2); between these they are apart. The stiffness K and
the backlash change with the driver's angle. Lagrange's equations with ``w2 = i*w1 - e'`` are::

    J2*a2 = Q - M2                                   Q = K*g + c*g', 0 apart
    J1*a1 = M1 - (kappa - s*b'/2)*Q - K'*g^2/2       g' = e' - s*b'*w1/2
    e''   = i*a1 + i'*w1^2 - a2

Friction makes the driver's torque kappa*Q instead of i*Q; kappa depends on which way Q acts. With
the potential energy ``V = K*g^2/2``::

    d(T + V)/dt = M1*w1 - M2*w2 - c*g'^2 - (kappa - i)*Q*w1

States are the time, w1, e, e' and three works: of the motor, on the load, and lost. Integrated over
phi1, so that w1 must stay above 0: a machine whose speed falls to a small part of that at the start
*stalls*. Time and w1 are integrated as differences from an even turning, since tolerances are
relative: a small part of w1 may be all of a vibration.
"""

from __future__ import annotations

import math
import time
from collections.abc import Callable
from dataclasses import dataclass, field, replace
from functools import cached_property
from itertools import pairwise
from typing import Any, Final, NamedTuple

import numpy as np
from numpy.typing import ArrayLike

from gearcam.base.display import ShortRepr
from gearcam.base.errors import InfeasibleError
from gearcam.dynamics.integrate import Integrator, Mode, Motion, Switch
from gearcam.dynamics.motion import residue
from gearcam.dynamics.tabled import Tabled
from gearcam.numeric.arrays import Array, distinct

_HAIR: Final = 1e-9
"""How far beyond its limit a contact ends or begins, over the backlash."""

_STALLED: Final = 1e-4
"""Speed at which the machine stalls, over that at the start."""

_DIFFERENCE: Final = 1e-6
"""Relative change of a speed by which a torque is differentiated."""

_PLACES: Final = 512
"""Places of a turn at which scales and frequencies are found."""

_OF_STEP: Final = 0.05
"""Tolerance of a step over that of the run: twenty impacts then leave the lag right to five
times the tolerance of the backlash."""

_PILOT: Final = 300.0
"""Natural periods of the stretch from which the run time is foretold; a quarter turn at most."""

MOST_PERIODS: Final = 1e7
"""Largest number of natural periods of a run."""

DRIVE, APART, COAST, MESH, STALL = "drive", "apart", "coast", "mesh", "stalled"
"""Modes: teeth on their driving flanks, apart, on coast flanks; without any backlash; at rest."""


class StiffState(NamedTuple):
    """Where and how a run begins.

    Attributes
    ----------
    phi1, w1 : float, rad and rad/s
        Angle and speed of the driver.
    lag, slip : float, rad and rad/s
        e and its derivative by time.
    """

    phi1: float
    w1: float
    lag: float
    slip: float = 0.0


@dataclass(frozen=True, eq=False, kw_only=True)
class StiffPair(ShortRepr):
    """A pair with elastic teeth in a machine.

    Parameters
    ----------
    table : Tabled
        Over phi1: i, i', K (N m/rad), K', b (rad), b'; with friction also kappa for Q > 0 and for
        Q < 0.
    inertia : (float, float), kg m2
        Of all that turns with each shaft; that of the driver does not matter at an even speed.
    damping : float, N m s/rad
        c.
    motor : callable or None
        ``motor(phi1, w1)``: torque on the driver, N m; also of speeds that are not reached. None if
        the driver turns evenly: then it is what that takes.
    load : callable
        ``load(phi1, w2)``: torque against the driven shaft's motion, N m.
    """

    table: Tabled
    inertia: tuple[float, float]
    damping: float
    motor: Callable[[float, float], float] | None
    load: Callable[[float, float], float]

    @property
    def _inertias(self) -> tuple[float, float]:
        """Both moments of inertia; that of a driver that turns evenly is infinite."""
        return (math.inf if self.motor is None else self.inertia[0]), self.inertia[1]

    @cached_property
    def places(self) -> Array:
        """Even places of a turn or travel, rad, without its end if closed."""
        table = self.table
        return np.linspace(table.low, table.low + table.period, _PLACES, endpoint=not table.closed)

    def frequency(self, phi1: ArrayLike) -> Array:
        """Return the natural frequency, rad/s, at driver angles: ``sqrt(K*(1/J2 + i^2/J1))``."""
        ratio, _, stiffness = self.table.at(phi1)[:3]
        j1, j2 = self._inertias
        return np.sqrt(stiffness * (1.0 / j2 + ratio**2 / j1))

    def damped(self, ratio: float) -> StiffPair:
        """Return the pair with a damping, by its `ratio` to the critical one.

        ``c = 2*ratio*sqrt(K/(1/J2 + i^2/J1))``, its mean over a turn.
        """
        of_ratio, _, stiffness = self.table.at(self.places)[:3]
        j1, j2 = self._inertias
        critical = 2.0 * np.sqrt(stiffness / (1.0 / j2 + of_ratio**2 / j1))
        return replace(self, damping=ratio * float(critical.mean()))

    def rigid_torque(self, phi1: float, w1: float) -> float:
        """Return the torque of the mesh on the driven wheel, N m, if teeth were rigid.

        Parameters
        ----------
        phi1, w1 : float, rad and rad/s
            Angle and speed of the driver.
        """
        ratio, slope = self.table(phi1)[:2]
        j1, j2 = self.inertia
        load = self.load(phi1, ratio * w1)
        inert = j2 * slope * w1 * w1
        if self.motor is None:
            return load + inert
        a1 = (self.motor(phi1, w1) - ratio * (load + inert)) / (j1 + j2 * ratio * ratio)
        return load + j2 * ratio * a1 + inert

    def resting(self, phi1: float, w1: float, torque: float | None = None) -> StiffState:
        """Return the start in which the teeth carry a torque, N m, and do not slip.

        Parameters
        ----------
        phi1, w1 : float, rad and rad/s
            Angle and speed of the driver.
        torque : float, N m
            On the driven wheel; by default that of rigid teeth.

        Returns
        -------
        StiffState
        """
        if torque is None:
            torque = self.rigid_torque(phi1, w1)
        _, _, stiffness, _, backlash = self.table(phi1)[:5]
        return StiffState(phi1, w1, torque / stiffness + math.copysign(0.5 * backlash, torque))

    @cached_property
    def _parted(self) -> bool:
        return bool((self.table.at(self.places)[4] > 0.0).any())

    def _mode_of(self, phi1: float, lag: float) -> str:
        if not self._parted:
            return MESH
        half = 0.5 * self.table(phi1)[4]
        return APART if abs(lag) <= half else DRIVE if lag > 0.0 else COAST

    def energy(self, phi1: float, state: ArrayLike) -> float:
        """Return kinetic and potential energy, J.

        Parameters
        ----------
        phi1 : float, rad
            Driver angle.
        state : (4 or more,) array
            Time, w1, e and e'.
        """
        _, w1, lag, slip = np.asarray(state, dtype=float)[:4].tolist()
        ratio, _, stiffness, _, backlash = self.table(phi1)[:5]
        bent = max(abs(lag) - 0.5 * backlash, 0.0)
        j1, j2 = self.inertia
        if self.motor is None:
            j1 = 0.0  # its energy does not change
        return 0.5 * (j1 * w1 * w1 + j2 * (ratio * w1 - slip) ** 2 + stiffness * bent * bent)

    def _modes(self, speed: float) -> dict[str, Mode]:
        """Return the modes of a run that begins with a speed, rad/s."""
        table, floor = self.table, _STALLED * speed
        hair = _HAIR * float(table.at(self.places)[4].max())
        stall = Switch(lambda _, y: y[1] + speed - floor, STALL, 0.0, dips=False)
        last = {STALL: Mode(lambda *_: [0.0] * 7, last=True)}

        def side(sign: float, of: float, to: str) -> Switch:
            """Return the switch at a flank: `of` is 1 for teeth that touch, -1 for teeth apart."""

            def holds(x: float, y: Any) -> float:
                return of * (sign * float(y[2]) - 0.5 * table(x)[4])

            return Switch(holds, to, hair)

        if not self._parted:
            return {MESH: self._mode(0.0, True, speed, (stall,)), **last}
        drive = self._mode(1.0, True, speed, (side(1.0, 1.0, APART), stall))
        coast = self._mode(-1.0, True, speed, (side(-1.0, 1.0, APART), stall))
        either = side(1.0, -1.0, DRIVE), side(-1.0, -1.0, COAST), stall
        return {DRIVE: drive, COAST: coast, APART: self._mode(0.0, False, speed, either), **last}

    def _mode(self, sign: float, touches: bool, speed: float, switches: Any) -> Mode:
        """Return the equations of a mode; `speed` is that of the start."""
        table, motor, load, (j1, j2) = self.table, self.motor, self.load, self._inertias
        c, half, even = float(self.damping), 0.5 * sign, 1.0 / speed
        floor = 0.1 * _STALLED * speed  # in trial steps it may be less

        def touching(x: float, y: Any) -> list[float]:
            _, w, e, v, _, _, _ = y.tolist()
            w = max(w + speed, floor)
            i, di, k, dk, b, db, *rubs = table(x)
            g, moved = e - half * b, half * db
            closing = v - moved * w
            q = k * g + c * closing
            lost = (rubs[1 if q < 0.0 else 0] - i) * q if rubs else 0.0
            w2 = i * w - v
            m2 = load(x, w2)
            resisting = (i - moved) * q + lost + 0.5 * dk * g * g
            m1 = resisting if motor is None else motor(x, w)
            a1 = (m1 - resisting) / j1
            slip = i * a1 + di * w * w - (q - m2) / j2
            r = 1.0 / w
            lost += c * closing * closing * r
            return [r - even, a1 * r, v * r, slip * r, m1, m2 * w2 * r, lost]

        def apart(x: float, y: Any) -> list[float]:
            _, w, _, v, _, _, _ = y.tolist()
            w = max(w + speed, floor)
            i, di = table(x)[:2]
            m1, w2 = 0.0 if motor is None else motor(x, w), i * w - v
            m2 = load(x, w2)
            a1 = m1 / j1
            r = 1.0 / w
            return [
                r - even,
                a1 * r,
                v * r,
                (i * a1 + di * w * w + m2 / j2) * r,
                m1,
                m2 * w2 * r,
                0.0,
            ]

        def pace(x: float, y: Any) -> float:
            w = max(float(y[1]) + speed, floor)
            i, _, k = table(x)[:3]
            softness = 1.0 / j2 + i * i / j1
            step = _DIFFERENCE * w
            by_motor = abs(motor(x, w + step) - motor(x, w)) / (step * j1) if motor else 0.0
            by_load = abs(load(x, i * w + step) - load(x, i * w)) / (step * j2)
            return max(math.sqrt(k * softness), c * softness, by_motor, by_load) / w

        if touches:
            return Mode(touching, switches, pace)
        return Mode(apart, switches)

    def _scales(self, start: StiffState) -> tuple[float, ...]:
        """Return sizes of the parts of the state: below them, tolerances are absolute."""
        stiffness, backlash = self.table.at(self.places)[[2, 4]]
        torque = max(abs(self.rigid_torque(x, start.w1)) for x in self.places.tolist())
        pace = float(self.frequency(self.places).max())
        half = 0.5 * float(backlash.max())
        lag = max(half + torque / float(stiffness.min()), abs(start.lag), abs(start.slip) / pace)
        lag = lag or start.w1 / pace  # nothing acts
        energy = self.energy(start.phi1, (0.0, start.w1, start.lag, start.slip))
        return (1.0 / pace, lag * pace, lag, lag * pace, *3 * (energy,))

    def periods(self, start: StiffState, end: float) -> float:
        """Return the number of natural periods of a run at the speed of its start.

        Parameters
        ----------
        start, end : StiffState and float, rad
            As of `run`.
        """
        mean = float(self.frequency(self.places).mean())
        return mean * (end - start.phi1) / start.w1 / (2.0 * math.pi)

    def run(
        self,
        start: StiffState,
        end: float,
        *,
        knots: ArrayLike = (),
        method: str = "auto",
        rtol: float = 1e-6,
        keep: float | None = None,
        passed: Callable[[float], None] = lambda _: None,
    ) -> StiffRun:
        """Return the motion from a start to a driver angle.

        Parameters
        ----------
        start : StiffState
            The start.
        end : float, rad
            Driver angle of the end.
        knots : (k,) array, rad
            Places of one turn at which the table, or the load, is not smooth.
        method : str
            Of `METHODS`.
        rtol : float
            Tolerance; a step has a twentieth of it.
        keep : float, rad
            From where on the motion is kept; from the start by default.
        passed : callable
            Told of the knots passed.

        Returns
        -------
        StiffRun

        Raises
        ------
        InfeasibleError
            If the run has too many natural periods or switches, or cannot be integrated.
        """
        count = self.periods(start, end)
        if count > MOST_PERIODS:
            raise InfeasibleError(
                "too many natural periods of the teeth",
                where="dynamics.turns",
                value=count,
                limit=MOST_PERIODS,
                nearest="fewer turns, a higher speed, or rigid wheels",
            )
        scales = self._scales(start)
        part = _OF_STEP * rtol
        integrate = Integrator(method=method, rtol=part, atol=tuple(part * s for s in scales))
        motion = integrate(
            self._modes(start.w1),
            (
                self._mode_of(start.phi1, start.lag),
                (0.0, 0.0, start.lag, start.slip, 0.0, 0.0, 0.0),
            ),
            self._knots(knots, start.phi1, end),
            keep=start.phi1 if keep is None else keep,
            passed=passed,
        )
        return StiffRun(pair=self, start=start, motion=motion)

    def forecast(self, start: StiffState, end: float, **settings: Any) -> float:
        """Return about how many seconds a run will take, from a short stretch of it.

        Parameters
        ----------
        start, end, **settings
            As of `run`.
        """
        table, whole = self.table, end - start.phi1
        length = whole * min(1.0, _PILOT / max(self.periods(start, end), 1.0))
        length = min(length, 0.25 * table.period)
        middle, last = start.phi1 + 0.5 * length, start.phi1 + length
        knots = [*np.asarray(settings.pop("knots", ())).tolist(), middle]
        times: list[float] = []

        def passed(x: float) -> None:
            if x >= middle:
                times.append(time.perf_counter())

        self.run(start, last, **settings | {"knots": knots, "passed": passed, "keep": math.inf})
        return (times[-1] - times[0]) * whole / (last - middle) if len(times) > 1 else 0.0

    def _knots(self, knots: ArrayLike, low: float, high: float) -> list[float]:
        """Return the knots of one turn, repeated, between two places and with these."""
        knots, period = np.asarray(knots, dtype=float), self.table.period
        if self.table.closed:
            first = self.table.low + (knots - self.table.low) % period
            turns = np.arange(
                math.floor((low - self.table.low) / period),
                math.ceil((high - self.table.low) / period) + 1.0,
            )
            knots = distinct(first) + period * turns[:, None]
        inner = distinct(knots)
        near = 1e-12 * max(abs(low), abs(high), period)
        inner = inner[(inner > low + near) & (inner < high - near)]
        return [low, *inner.tolist(), high]


class LostContact(NamedTuple):
    """A stretch of the driver's angle without contact.

    Attributes
    ----------
    low, high : float, rad
        Its ends.
    onto : str
        Flanks onto which the teeth fall, `DRIVE` or `COAST`; empty if the run ends before.
    impact : float, rad/s
        Speed at which they do, of the driven wheel relative to its place at contact.
    """

    low: float
    high: float
    onto: str
    impact: float


@dataclass(frozen=True, eq=False, kw_only=True)
class StiffRun(ShortRepr):
    """A motion of the stiff model.

    Parameters
    ----------
    pair : StiffPair
        The pair.
    start : StiffState
        How it began.
    motion : Motion
        The motion: time and w1 less those of an even turning, e, e', and the works.
    """

    pair: StiffPair
    start: StiffState
    motion: Motion = field(repr=False)

    def states(self, phi1: ArrayLike) -> Array:
        """Return the states, (7, n), at driver angles, rad, (n,), within the part that is kept.

        Time (s), w1 (rad/s), e (rad), e' (rad/s), works of the motor, on the load, and lost (J).
        """
        phi1 = np.asarray(phi1, dtype=float)
        return self._with_even(phi1, self.motion.at(phi1))

    def _with_even(self, phi1: Array | float, states: Array) -> Array:
        made = states.copy()
        made[0] += (phi1 - self.start.phi1) / self.start.w1
        made[1] += self.start.w1
        return made

    @cached_property
    def end(self) -> Array:
        """The states at the end, (7,)."""
        return self._with_even(self.motion.place, self.motion.end)

    @property
    def stalled(self) -> tuple[float, float] | None:
        """Driver angle, rad, at which the machine stalled, and the torque, N m, that it lacks."""
        if self.motion.mode != STALL:
            return None
        place, pair = self.motion.place, self.pair
        ratio = pair.table(place)[0]
        driving = pair.motor(place, 0.0) if pair.motor else 0.0
        return place, ratio * pair.load(place, 0.0) - driving

    @cached_property
    def residue(self) -> float:
        """What the balance of works and energy leaves (see `gearcam.dynamics.motion.residue`)."""
        motor, load, lost = self.end[4:].tolist()
        before = self.pair.energy(self.start.phi1, (0.0, *self.start[1:]))
        after = self.pair.energy(self.motion.place, self.end)
        return residue((before, motor), (after, load, lost))

    def difference(self, other: StiffRun, steps: int = 720) -> tuple[float, float]:
        """Return the largest differences from another run: of the lag, rad, and of w1, rad/s.

        Parameters
        ----------
        other : StiffRun
            Of the same machine.
        steps : int
            Number of even steps of what both have kept, at which they are compared.
        """
        low = max(one.motion.pieces[0].low for one in (self, other))
        high = min(one.motion.place for one in (self, other))
        x = np.linspace(low, high, steps + 1)
        apart = np.abs(self.motion.at(x) - other.motion.at(x)).max(axis=1)
        return float(apart[2]), float(apart[1])

    @cached_property
    def lost_contact(self) -> list[LostContact]:
        """Arcs without contact in the part that is kept."""
        motion = self.motion
        first = motion.pieces[0].low
        ends = [(first, "", motion.modes([first])[0])]
        ends += [one for one in motion.switches if one[0] > first]
        ends.append((motion.place, motion.mode, ""))
        arcs = []
        for (low, _, mode), (high, _, onto) in pairwise(ends):
            if mode == APART:
                arcs.append(LostContact(low, high, onto, self._impact(high, onto)))
        return arcs

    def _impact(self, place: float, onto: str) -> float:
        sign = {DRIVE: 0.5, COAST: -0.5}.get(onto)
        if sign is None:
            return 0.0
        _, w1, _, slip = self.states([place])[:4, 0].tolist()
        return abs(slip - sign * self.pair.table(place)[5] * w1)

    def at(self, phi1: ArrayLike) -> dict[str, Array]:
        """Return the motion at driver angles, rad, (n,), within the part that is kept.

        Returns
        -------
        dict of str to (n,) array
            time (s), w1, w2 (rad/s), lag (rad), slip (rad/s), bent (rad), mesh (N m, on the driven
            wheel), driver (N m, what it takes on the driver), lost (N m, at the driver), motor,
            load (N m).
        """
        phi1 = np.asarray(phi1, dtype=float)
        pair = self.pair
        t, w1, lag, slip = self.states(phi1)[:4]
        ratio, _, stiffness, by_angle, backlash, backlash_slope, *rubs = pair.table.at(phi1)
        modes = self.motion.modes(phi1)
        sign = np.array([{DRIVE: 1.0, COAST: -1.0}.get(one, 0.0) for one in modes])
        touch = np.array([one in (DRIVE, COAST, MESH) for one in modes])
        bent = np.where(touch, lag - 0.5 * sign * backlash, 0.0)
        closing = slip - 0.5 * sign * backlash_slope * w1
        mesh = np.where(touch, stiffness * bent + pair.damping * closing, 0.0)
        kappa = np.where(mesh < 0.0, rubs[1], rubs[0]) if rubs else ratio
        w2, places = ratio * w1 - slip, phi1.tolist()
        if pair.motor is None:
            moved = 0.5 * sign * backlash_slope
            motor = (kappa - moved) * mesh + 0.5 * by_angle * bent**2
        else:
            pace = zip(places, w1.tolist(), strict=True)
            motor = np.array([pair.motor(*one) for one in pace])
        return {
            "time": t,
            "w1": w1,
            "w2": w2,
            "lag": lag,
            "slip": slip,
            "bent": bent,
            "mesh": mesh,
            "driver": kappa * mesh,
            "lost": (kappa - ratio) * mesh + touch * pair.damping * closing**2 / w1,
            "motor": motor,
            "load": np.array([pair.load(*one) for one in zip(places, w2.tolist(), strict=True)]),
        }
