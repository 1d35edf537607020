"""The motion of a machine with rigid members, and what is shown of it: of pairs and mechanisms."""

from __future__ import annotations

import math
from dataclasses import dataclass, replace
from functools import cached_property, partial
from typing import TYPE_CHECKING, Any, Final

import numpy as np

from gearcam.base.display import ShortRepr
from gearcam.base.errors import DesignError, InfeasibleError, MissingExtraError, Problem
from gearcam.base.facts import Fact, Tree, extent
from gearcam.base.findings import Finding, run_checks
from gearcam.base.numerals import formatted
from gearcam.base.quantities import RPM
from gearcam.base.readable import readable
from gearcam.dynamics.checks import MovingMachine
from gearcam.dynamics.motors import ConstantMotor, motor_of
from gearcam.dynamics.regime import even_torque, flywheel, regime
from gearcam.dynamics.rigid import RigidMotion, RigidRun
from gearcam.dynamics.settings import COAST, DYNAMICS, REGIME, START, TURNS
from gearcam.numeric.arrays import distinct
from gearcam.numeric.narrowing import neighbours, summits
from gearcam.numeric.piecewise import with_both_sides
from gearcam.numeric.roots import bracketed_root
from gearcam.pictures.charts import Chart, Line, MarkedPlace, knot_marks
from gearcam.pictures.scenes import PLACES
from gearcam.results.study import StudyResult

if TYPE_CHECKING:
    from collections.abc import Callable, Mapping

    from gearcam.dynamics.machine import Machine
    from gearcam.dynamics.motion import MachineMotion
    from gearcam.dynamics.motors import Motor
    from gearcam.dynamics.settings import DynamicsSpec
    from gearcam.mechanics.motor import MotorSpec
    from gearcam.numeric.arrays import Array
    from gearcam.results.result import Result

_FINER: Final = 1e-3
"""Tolerance of a rigid machine over that of the design, 1e-12 at least."""

_LEAST_TOLERANCE: Final = 1e-12

_HIGHEST: Final = 4
"""Highest degree of a polynomial in the speed that a load may be."""

_NOTHING: Final = 1e-9
"""Moment of inertia over the largest that is 0."""

_SAME: Final = 1e-9
"""Difference of loads, or of speeds, over the largest that is rounding."""

_UNTIL_REST: Final = 100
"""Largest number of turns of a machine that coasts."""

_ROWS: Final = 100_000
"""Largest number of even steps of the table."""

_NARROW: Final = 1e-9
"""Width, over a period, to which an extreme is narrowed."""

_RUN_UP: Final = 0.99
"""Mean speed, over that of the regime, at which a machine has run up."""


def demand(design: Any, speed: float | None, key: str) -> None:
    """Refuse a run that has neither a motor nor a speed, or an unfit one.

    Parameters
    ----------
    design : Design
        With the tables ``[dynamics]`` and ``[motor]``.
    speed : float or None, rad/s
        Mean speed of the driver.
    key : str
        Its key.

    Raises
    ------
    DesignError
        If the run cannot be.
    MissingExtraError
        If scipy is not installed.
    """
    problem = _problem(design.motor, design.dynamics.run, speed, key)
    if problem is not None:
        raise DesignError([replace(problem, file=design.source)])
    MissingExtraError.unless("scipy", what="dynamics", extra="dynamics")


def _problem(motor: MotorSpec, run: str, speed: float | None, key: str) -> Problem | None:
    """Return what is wrong with a run, or None."""
    missing = "is missing: "
    if run == REGIME and motor.type in ("none", "spring"):
        what = f'"{motor.type}": such a machine has no regime'
        return Problem(
            what, key="motor.type", allowed='a motor, or run = "start", "turns", "coast"'
        )
    if run == REGIME and motor.type == "constant" and motor.torque is not None:
        what = "a motor of an even torque has no regime of its own"
        near = f"left out, with {key}: then it is the mean of the load"
        return Problem(what, key="motor.torque_nm", allowed=near)
    made = motor_of(motor)
    if run == REGIME and motor.type == "table" and made is not None and not made.settles:
        what = "such a motor has no regime of its own: its torque does not fall"
        near = "less at the highest speed than at all others"
        return Problem(what, key="motor.torque_nm", allowed=near)
    if run in (START, TURNS) and motor.type == "constant" and motor.torque is None:
        return Problem(
            missing + "the motor has no torque", key="motor.torque_nm", allowed="a torque"
        )
    if run == START and motor.turns_evenly:
        what = '"start": a driver that turns evenly does not start'
        return Problem(what, key="dynamics.run", allowed="with another motor than speed")
    evenly = motor.turns_evenly or (motor.type == "constant" and run == REGIME)
    if speed is None and (evenly or run in (TURNS, COAST)):
        return Problem(missing + "the speed of the driver", key=key, allowed="a speed above 0")
    if motor.irregularity is not None and run != REGIME:
        what = f'is that of a regime, not of run = "{run}"'
        return Problem(what, key="motor.irregularity", allowed='left out, or run = "regime"')
    if motor.flywheel == "solve" and run != REGIME:
        what = f'"solve": a flywheel is found for a regime, not for run = "{run}"'
        return Problem(what, key="motor.flywheel_kg_m2", allowed='a number, or run = "regime"')
    if motor.flywheel == "solve" and motor.turns_evenly:
        what = '"solve": a driver that turns evenly needs no flywheel'
        return Problem(what, key="motor.flywheel_kg_m2", allowed="a motor of another type")
    return None


def usual_speed(motor: MotorSpec, speed: float | None) -> float:
    """Return a usual speed of a driver, rad/s.

    Parameters
    ----------
    motor : MotorSpec
        Its motor.
    speed : float or None, rad/s
        Its mean speed, which is taken if it is given.
    """
    made = motor_of(motor)
    return speed or (made.scale if made is not None else 0.0) or 1.0


def speed_powers(
    load: Callable[[Array, float], Array], places: Array, speed: float
) -> Callable[[Array], Array]:
    """Return the coefficients of a load as a polynomial of the driver's speed.

    Parameters
    ----------
    load : callable
        ``load(phi, omega)`` at angles (n,), rad, and a speed, rad/s.
    places : (m,) array, rad
        Where the degree of the polynomial is looked for.
    speed : float, rad/s
        A usual speed.

    Returns
    -------
    callable
        ``function(phi) -> (degree + 1, n) array``, the lowest power first.

    Raises
    ------
    InfeasibleError
        If the load is no polynomial of a low degree.
    """
    shares = np.linspace(0.15, 1.9, 8)
    found = np.array([load(places, float(share * speed)) for share in shares])
    fits = np.polynomial.polynomial
    for degree in range(_HIGHEST + 1):
        fit = fits.polyfit(shares, found, degree)
        if np.abs(found - fits.polyval(shares, fit).T).max() <= _SAME * np.abs(found).max():
            break
    else:
        what = f"a load is no polynomial of the speed, of degree {_HIGHEST} or less"
        near = "such as 200 + 3*v or 0.1*v**2, of a pair 0.5*omega2"
        raise InfeasibleError(what, where="load", nearest=near)
    speeds = speed * (1.0 - np.cos(np.pi * (np.arange(degree + 1) + 0.5) / (degree + 1)))
    to_powers = np.linalg.inv(np.vander(speeds, increasing=True))
    # powers that the polynomial does not have are rounding
    sizes = np.abs(fit).max(axis=1)
    to_powers[sizes <= _SAME * sizes.max()] = 0.0
    return lambda phi: to_powers @ np.array([load(phi, float(one)) for one in speeds])


@dataclass(frozen=True, eq=False, kw_only=True)
class MachineRun(ShortRepr):
    """A machine with the motor and the run of its design.

    Parameters
    ----------
    machine : Machine
        The machine, without a flywheel.
    design : Design
        With ``dynamics`` and ``motor``.
    speed : float or None, rad/s
        Mean speed of the driver.
    place : callable
        ``place(phi)`` returns an angle of the driver in words.
    axis : str
        That angle as the axis of charts.
    symbol : str
        Its symbol in columns.
    """

    machine: Machine
    design: Any
    speed: float | None
    place: Callable[[float], str]
    axis: str
    symbol: str

    @property
    def spec(self) -> DynamicsSpec:
        """The table ``[dynamics]``."""
        return self.design.dynamics

    @cached_property
    def motor(self) -> Motor | None:
        """The motor; None at an even speed."""
        return ConstantMotor() if self.spec.run == COAST else motor_of(self.design.motor)

    @cached_property
    def _found(self) -> tuple[float, RigidMotion]:
        given = self.design.motor.flywheel
        if given == "solve":
            (_, low), (_, high) = self.machine.inertia_ends
            usual = 0.5 * (low + high) or 1.0
            return flywheel(self._moving, self.design.motor.irregularity, usual)
        return given, self._moving(given)

    @property
    def flywheel(self) -> float:
        """The flywheel, given or found, kg m2."""
        return self._found[0]

    @property
    def motion(self) -> MachineMotion:
        """The motion that is shown."""
        return self.rigid

    @cached_property
    def rigid(self) -> RigidMotion:
        """The motion with rigid members; a regime is that of one turn.

        Raises
        ------
        InfeasibleError
            If there is no regime, or the motor's table does not reach over the speeds.
        """
        motion = self._found[1]
        least, largest = motion.speeds[0][1], motion.speeds[1][1]
        if self.spec.run == START or motion.stopped is not None:
            least = 0.0
        low, high = (0.0, math.inf) if motion.motor is None else motion.motor.known
        for found, end, beyond in ((least, low, low - least), (largest, high, largest - high)):
            if beyond > _SAME * max(largest, low):
                what = "the motor's table does not reach over the speeds of the driver"
                raise InfeasibleError(
                    what,
                    where="motor.rpm",
                    value=found / RPM.factor,
                    limit=end / RPM.factor,
                    unit="rpm",
                    nearest="rows up to the speeds that are reached, or down to a torque of 0",
                )
        return motion

    def _moving(self, inertia: float) -> RigidMotion:
        """Return the motion with a flywheel, kg m2."""
        self._demand_turns()
        machine, spec = self.machine.with_flywheel(inertia), self.spec
        usual = _UNTIL_REST if spec.run == COAST else 3
        periods = (spec.turns or (usual if machine.closed else 1)) / machine.turns
        if self.motor is None:
            knots = machine.knots_over(periods) if spec.run == TURNS else machine.knots
            return RigidMotion(machine=machine, motor=None, knots=knots, even=self.speed or 0.0)
        (least_at, least), (_, largest) = machine.inertia_ends
        if least <= _NOTHING * largest:
            what = "nothing of the machine has inertia"
            if largest > 0.0:
                what = "nothing that has inertia moves here: the speed would be infinite"
            near = "a flywheel, or inertia of the driver"
            raise InfeasibleError(what, where=self.place(least_at), nearest=near)
        run = self._run(machine, self.motor)
        if spec.run == START:
            return run.from_rest(periods)
        if spec.run in (TURNS, COAST):
            return run.from_speed(self.speed or 0.0, periods)
        if self.motor.settles:
            return regime(run)
        return even_torque(run, self.speed or 0.0)

    def _run(self, machine: Machine, motor: Motor) -> RigidRun:
        return RigidRun(
            machine=machine,
            motor=motor,
            scale=motor.scale or self.speed or self._guessed(machine),
            rtol=max(_FINER * self.spec.tolerance, _LEAST_TOLERANCE),
        )

    @cached_property
    def run_up(self) -> float | None:
        """Time, s, after which a machine from rest has nearly the mean speed of its regime.

        The mean of the last period; None of other runs, and if there is no regime or it is not
        reached.
        """
        motion, motor = self.motion, self.motor
        machine, (low, high) = motion.machine, motion.ends
        starts = self.spec.run == START and machine.closed and motion.stopped is None
        if not starts or motor is None or not motor.settles:
            return None
        try:
            longest = regime(self._run(machine, motor)).lasts / _RUN_UP
        except InfeasibleError:
            return None

        def slow(phi: Array) -> Array:
            return motion.time(phi) - motion.time(phi - machine.period) - longest

        # a start is slower than the regime at every angle, and faster after every period
        ends = np.append(np.arange(low + machine.period, high, machine.period), high)
        found = slow(ends)
        if found[-1] > 0.0:
            return None
        at = int(np.argmax(found <= 0.0))
        before = max(at - 1, 0)
        place = bracketed_root(slow, ends[[before]], ends[[at]], _NARROW * machine.period)
        return float(motion.time(place)[0])

    def _demand_turns(self) -> None:
        """Refuse a regime, or turns, of a machine that has a travel."""
        if self.machine.closed:
            return
        steady = self.spec.run == REGIME and self.motor is not None
        if not steady and (self.spec.turns or 1) == 1:
            return
        what = "a machine with a travel has no turns"
        key, near = "dynamics.turns", "1"
        if steady:
            what = '"regime": a machine with a travel has none'
            key, near = "dynamics.run", '"start", or "turns" from drive.speed_rpm'
        raise DesignError([Problem(what, file=self.design.source, key=key, allowed=near)])

    def _guessed(self, machine: Machine) -> float:
        """Return a speed that the motor reaches in a turn from rest without load, rad/s."""
        low = float(machine.knots[0])
        torque = float(abs(self.motor.torque(low, 0.0))) if self.motor else 0.0
        return math.sqrt(2.0 * torque * machine.period / machine.inertia(machine.rows(low))) or 1.0

    @cached_property
    def places(self) -> Array:
        """The driver's angles of the table, rad: even steps, and both sides of knots."""
        low, high = self.motion.ends
        count = max(2, min(_ROWS, math.ceil(self._turned * self.spec.steps)) + 1)
        return with_both_sides(np.linspace(low, high, count), self.motion.knots)

    @property
    def _turned(self) -> float:
        """By how many turns the driver turns; of a travel which share of it."""
        low, high = self.motion.ends
        return self.machine.turns * (high - low) / self.machine.period

    @property
    def pace(self) -> Array | None:
        """Angles of the driver, degrees, and the time, s, of a turn that repeats or a whole travel.

        None of other motions, (n, 2) otherwise.
        """
        once = self.spec.run == REGIME or not self.machine.closed
        if not once or self.motion.stopped is not None:
            return None
        phi = np.linspace(*self.motion.ends, PLACES + 1)
        return np.stack([np.degrees(phi), self.motion.time(phi)], axis=1)

    def columns(self) -> dict[str, Array]:
        """Return the columns of ``dynamics.csv`` that all machines have."""
        phi, motion = self.places, self.motion
        omega = motion.speed(phi)
        driving, load, lost = motion.torques(phi)
        return {
            "t_s": motion.time(phi),
            f"{self.symbol}_deg": np.degrees(phi),
            "omega_rad_s": omega,
            "inertia_kg_m2": np.asarray(motion.machine.inertia(motion.machine.rows.at(phi))),
            "torque_motor_nm": driving,
            "torque_load_nm": load,
            **({"torque_lost_nm": lost} if np.any(lost) else {}),
            "power_w": driving * omega,
        }

    @property
    def _words(self) -> str:
        """The run in words."""
        if self.motor is None:
            return "the driver turns evenly"
        if self.spec.run == REGIME and self.machine.turns > 1:
            return f"the regime: the {self.machine.turns} turns that repeat"
        return _WORDS[self.spec.run]

    def _jump(self) -> float:
        """Return by how much a formula of a load jumps where a period ends, at the driver, N m."""
        whole = any(one.formula is not None and one.start is None for one in self.design.load)
        if not (whole and self.machine.closed):
            return 0.0
        low, high = self.machine.knots[[0, -1]]
        ends = np.array([low, high - _NARROW * self.machine.period])
        loads = self.machine.load(self.machine.rows.at(ends), self.motion.mean_speed) + 0.0 * ends
        jump = float(np.diff(loads)[0])
        return jump if abs(jump) > 1e3 * _NARROW * np.abs(loads).max() else 0.0

    def largest(self, functions: Callable[[Array], Array]) -> list[float]:
        """Return the largest value of each of some functions, also between rows.

        Parameters
        ----------
        functions : callable
            ``functions(phi) -> (m, n) array`` at rising angles of the driver (n,), rad.
        """
        x, width = distinct(self.places, self.motion.places), _NARROW * self.machine.period
        samples = functions(x)
        which, _, values = summits(functions, samples, *neighbours(x), width)
        return [float(values[which == number].max()) for number in range(len(samples))]

    def _driven(self, phi: Array) -> Array:
        """Return the torque of the motor with both signs, N m, and its power, W, (3, n)."""
        driving = self.motion.torques(phi)[0]
        return np.stack([-driving, driving, driving * self.motion.speed(phi)])

    def findings(self) -> tuple[Finding, ...]:
        """Return the findings of the motion."""
        moving = MovingMachine(
            motion=self.motion,
            wanted=self.design.motor.irregularity if self.spec.run == REGIME else None,
            tolerance=self.spec.tolerance,
            place=self.place,
            jump=self._jump(),
        )
        return run_checks(DYNAMICS, moving, self.design.limits)

    def facts(self, columns: Mapping[str, Array]) -> Tree:
        """Return the facts that all machines have.

        Parameters
        ----------
        columns : mapping of str to (n,) array
            See `columns`.
        """
        motion, spec = self.motion, self.spec
        steady = spec.run == REGIME
        works = dict(zip(("motor", "load", "lost"), motion.works, strict=True))
        below, above, power = self.largest(self._driven)
        worked = f"{readable(works['motor'], 'J')} in, {readable(works['load'], 'J')} on loads"
        if works["lost"]:
            worked += f", {readable(works['lost'], 'J')} lost"
        turn = "run" if not steady else "turn" if self.machine.turns == 1 else "period"
        whole = abs(motion.lasts) > 0.0 and motion.stopped is None
        return {
            "run": Fact(spec.run, "motion", text=self._words, shown=True),
            "motor": Fact(self.design.motor.type, "motor", shown=True),
            "speed_rpm": self._speeds(),
            "irregularity": Fact(
                motion.irregularity,
                "irregularity, (max - min)/mean",
                at_most=self.design.motor.irregularity,
                unit="",
                shown=True,
            )
            if steady and motion.motor is not None
            else None,
            "flywheel_kg_m2": self._flywheel(),
            f"{turn}_s": Fact(
                motion.lasts, f"time of a {turn}" if steady else "time", unit="s", shown=True
            ),
            "runup_s": Fact(
                self.run_up,
                "time of the run-up",
                place=f"until the mean speed is {_RUN_UP:.0%} of the regime's",
                unit="s",
                shown=True,
            )
            if self.run_up is not None
            else None,
            "inertia_kg_m2": Fact(
                extent(*(one for _, one in motion.machine.inertia_ends)),
                "moment of inertia at the driver",
                unit="kg m2",
                shown=True,
            ),
            "torque_motor_nm": Fact(extent(-below, above), "torque of the motor", shown=True),
            "power_w": {
                "mean": Fact(works["motor"] / motion.lasts, "mean power", unit="W", shown=True),
                "peak": Fact(power, "largest power", unit="W", shown=True),
            }
            if whole
            else None,
            "works_j": Fact(works, f"works of a {turn}", text=worked, unit="", shown=True),
            "gained_j": motion.gained,
            "stopped_deg": None if motion.stopped is None else math.degrees(motion.stopped),
            "rows": Fact(
                len(columns["t_s"]),
                "rows of dynamics.csv",
                place=f"{formatted(_ROWS / self._turned, 4)} steps of a turn, not {spec.steps}",
                unit="",
                shown=True,
            )
            if self._turned * spec.steps > _ROWS
            else None,
            "energy_residue": Fact(motion.residue, "works and energy balance to", unit=""),
        }

    def _speeds(self) -> Tree:
        """Return the speeds as facts: an even one, those of a regime, or of another run."""
        motion, ends = self.motion, np.array(self.motion.ends)
        (slow_at, slow), (fast_at, fast) = motion.speeds
        if motion.motor is None:
            return {"mean": _rpm(slow, "speed of the driver", "")}
        if self.spec.run == REGIME:
            return {
                "mean": _rpm(motion.mean_speed, "mean speed", "half of least and largest"),
                "over_time": _rpm(np.ptp(ends) / motion.lasts, "mean speed over time", ""),
                "min": _rpm(slow, "least speed", self.place(slow_at)),
                "max": _rpm(fast, "largest speed", self.place(fast_at)),
            }
        first, last = motion.speed(ends).tolist()
        if motion.stopped is not None:
            last = 0.0
        return {
            "first": _rpm(0.0 if self.spec.run == START else first, "speed at the start", ""),
            "last": _rpm(last, "speed at the end", self.place(float(ends[1]))),
            "max": _rpm(fast, "largest speed", self.place(fast_at)),
        }

    def _flywheel(self) -> Fact | None:
        """Return the flywheel as a fact."""
        if not self.design.motor.flywheel:
            return None
        found = self.design.motor.flywheel == "solve"
        label = "least flywheel for this irregularity" if found else "flywheel"
        return Fact(self.flywheel, label, unit="kg m2", shown=True)

    def charts(self, columns: Mapping[str, Array]) -> dict[str, Chart]:
        """Return the charts that all machines have.

        Parameters
        ----------
        columns : mapping of str to (n,) array
            See `columns`.
        """
        torques = {
            "motor": columns["torque_motor_nm"],
            "loads, at the driver": columns["torque_load_nm"],
        }
        if "torque_lost_nm" in columns:
            torques["losses"] = columns["torque_lost_nm"]
        omega = columns["omega_rad_s" if "omega_rad_s" in columns else "omega1_rad_s"]
        speed, starts = {"speed": omega / RPM.factor}, self.spec.run == START
        inertia = {"moment of inertia": columns["inertia_kg_m2"]}
        return {
            "speed": self.chart(columns, "Speed of the driver", "speed, rpm", speed),
            **({"run_up": self._run_up_chart(columns["t_s"], speed["speed"])} if starts else {}),
            "torques": self.chart(columns, "Torques at the driver", "torque, N m", torques),
            "inertia": self.chart(
                columns, "Moment of inertia at the driver", "moment of inertia, kg m2", inertia
            ),
        }

    def study(self, result: Result, more: Tree) -> StudyResult:
        """Return the study of the motion.

        Parameters
        ----------
        result : Result
            The design.
        more : Tree
            Facts of its kind, besides.
        """
        with result.stage("motion"):
            columns, findings = self.columns(), self.findings()
        return StudyResult(
            result=result,
            study=result.kind.studies["dynamics"],
            file="dynamics.csv",
            table=columns,
            group=self.facts(columns) | more,
            study_findings=findings,
            drawn=partial(self.charts, columns),
            pace=self.pace,
        )

    def _run_up_chart(self, time: Array, rpm: Array) -> Chart:
        """Return the chart of a start over time."""
        mark = () if self.run_up is None else (MarkedPlace(label="run up", value=self.run_up),)
        lines = (Line(label="speed", x=time, y=rpm),)
        return Chart(title="Run-up", x="time, s", y="speed, rpm", lines=lines, marks=mark)

    def chart(
        self, columns: Mapping[str, Array], title: str, y: str, lines: Mapping[str, Array]
    ) -> Chart:
        """Return a chart over the driver's angle.

        Parameters
        ----------
        columns : mapping of str to (n,) array
            See `columns`.
        title, y : str
            Its title and axis.
        lines : mapping of str to (n,) array
            Its lines by their labels.
        """
        x = columns[f"{self.symbol}_deg"]
        marks = knot_marks(np.degrees(self.machine.knots), float(x[0]), float(x[-1]))
        made = tuple(Line(label=label, x=x, y=values) for label, values in lines.items())
        return Chart(title=title, x=self.axis, y=y, lines=made, marks=marks)


def _rpm(omega: float, label: str, place: str) -> Fact:
    return Fact(float(omega / RPM.factor), label, place=place, unit="rpm", shown=True)


_WORDS: Final = {
    REGIME: "the regime: the turn that repeats",
    START: "from rest",
    TURNS: "from the speed of the drive",
    COAST: "coasting from the speed of the drive",
}
"""Runs in words."""
