"""The motion of a pair whose teeth are elastic: stiffness, backlash, vibration, impacts."""

from __future__ import annotations

import math
from dataclasses import dataclass
from functools import cached_property
from typing import TYPE_CHECKING, Any, Final

import numpy as np

from gearcam.base.errors import InfeasibleError
from gearcam.base.facts import Fact, Tree, extent
from gearcam.base.findings import Finding, run_checks
from gearcam.base.numerals import formatted
from gearcam.base.quantities import ARCSEC, RPM
from gearcam.base.readable import readable
from gearcam.dynamics.checks import VibratingTeeth
from gearcam.dynamics.machine import TURN, least_and_largest
from gearcam.dynamics.mesh_stiffness import Smooth, backlash_angle, mesh_stiffness
from gearcam.dynamics.motion import MachineMotion
from gearcam.dynamics.settings import COAST as COASTING
from gearcam.dynamics.settings import VIBRATION
from gearcam.dynamics.stiff import APART, COAST, StiffPair
from gearcam.dynamics.tabled import Tabled
from gearcam.kinds.gear_pair.pair_motion import MovingPair, PairRun
from gearcam.kinds.gear_pair.stress import elasticity
from gearcam.mechanics.wheel_load import WheelLoadSpec
from gearcam.numeric.arrays import distinct
from gearcam.numeric.narrowing import neighbours, peaks, summits
from gearcam.pictures.charts import Chart, Line, MarkedPlace
from gearcam.results.study import silent

if TYPE_CHECKING:
    from gearcam.dynamics.machine import PairMachine
    from gearcam.dynamics.settings import PairDynamicsSpec
    from gearcam.dynamics.stiff import LostContact, StiffRun
    from gearcam.kinds.gear_pair.elastic_pair import ElasticPair
    from gearcam.numeric.arrays import Array, Ints
    from gearcam.results.study import Progress

_PER_TOOTH: Final = 10
"""Phases for each tooth of the driver at which the stiffness is computed."""

_EXACT: Final = 1e-9
"""Error of tables, over the largest value."""

_IN_STEP: Final = np.array([0.2, 0.4, 0.6, 0.8, 1.0])
"""Places within a step of the integration at which largest and least values are looked for."""

_LONG: Final = 5.0
"""Run time, s, above which its estimate is printed."""

_JUMPS: Final = 0.05
"""Error of the smooth stiffness, over its mean, above which it is printed."""

_NARROW: Final = 1e-6
"""Width, over the last angle, to which the peaks of a vibration are narrowed."""

_LINES: Final = 4096
"""Points in time of a turn from which the spectrum is computed."""


@dataclass(frozen=True, eq=False, kw_only=True)
class ElasticMotion(MachineMotion):
    """The last turn of a run with elastic teeth.

    Parameters
    ----------
    machine, motor, knots
        See `MachineMotion`; switches are knots too.
    run : StiffRun
        The motion.
    turned : float, rad
        By how much the driver has turned before: angles are those of the last turn.
    """

    run: StiffRun
    turned: float

    def at(self, phi: Array) -> dict[str, Array]:
        """Return the motion at angles (n,), rad (see `StiffRun.at`)."""
        return self.run.at(phi + self.turned)

    def states(self, phi: Array) -> Array:
        """Return the states at angles (n,), rad (see `StiffRun.states`)."""
        return self.run.states(phi + self.turned)

    @cached_property
    def places(self) -> Array:
        """Some places of each step of the integration, rad."""
        pieces = self.run.motion.pieces
        low, high = (np.array([getattr(one, end) for one in pieces]) for end in ("low", "high"))
        inside = (low + np.outer(_IN_STEP, high - low)).T.ravel() - self.turned
        return np.concatenate([self.knots[:1], np.minimum(inside, self.knots[-1])])

    @cached_property
    def values(self) -> dict[str, Array]:
        """The motion there (see `StiffRun.at`)."""
        return self.at(self.places)

    def speed(self, phi: Array) -> Array:
        """Return speeds of the driver, rad/s, at angles (n,)."""
        return self.states(phi)[1]

    def time(self, phi: Array) -> Array:
        """Return times, s, at angles (n,)."""
        first = self.states(self.knots[:1])[0]
        return self.states(phi)[0] - first

    def torques(self, phi: Array) -> tuple[Array, Array, Array]:
        """Return torques of motor, load and losses at the driver, N m, at angles (n,)."""
        found = self.at(phi)
        load = found["load"] * found["w2"] / found["w1"]
        return found["motor"], load, found["lost"]

    @cached_property
    def speeds(self) -> tuple[tuple[float, float], tuple[float, float]]:
        """Least and largest speed of the driver, each as (angle, rad/s)."""

        def both(phi: Array) -> Array:
            return np.outer([-1.0, 1.0], self.speed(phi))

        x = self.places
        which, places, values = summits(both, both(x), *neighbours(x), _NARROW * x[-1])
        return least_and_largest(places, np.where(which == 0, -values, values))

    @cached_property
    def works(self) -> tuple[float, float, float]:
        """Work of the motor, on the loads, and lost, J."""
        motor, load, lost = np.diff(self.states(np.array(self.ends)))[4:, 0].tolist()
        return motor, load, lost

    @cached_property
    def gained(self) -> float:
        """By how much the energy is larger at the end of the turn, J."""
        first, last = self.states(np.array(self.ends)).T
        return self.run.pair.energy(self.ends[1], last) - self.run.pair.energy(self.ends[0], first)

    @property
    def residue(self) -> float:
        """What the balance of works and energy of the whole run leaves, as a share."""
        return self.run.residue

    @cached_property
    def stopped(self) -> float | None:
        """Where the driver stopped, rad."""
        return self.run.stalled[0] - self.turned if self.run.stalled else None

    @property
    def lost_contact(self) -> list[LostContact]:
        """Arcs without contact."""
        found = self.run.lost_contact
        return [
            one._replace(low=one.low - self.turned, high=one.high - self.turned) for one in found
        ]

    def modes(self, phi: Array) -> list[str]:
        """Return the modes at angles (n,), rad."""
        return self.run.motion.modes(phi + self.turned)


@dataclass(frozen=True, eq=False, kw_only=True)
class ElasticRun(PairRun):
    """A pair with elastic teeth, with the motor and the run of its design.

    Parameters
    ----------
    progress : Progress
        Told of wheels and turns.
    """

    progress: Progress = silent

    @property
    def _settings(self) -> PairDynamicsSpec:
        return self.design.dynamics

    @cached_property
    def _nominal(self) -> float:
        """Mean size of the torque on the driven wheel with rigid teeth, N m."""
        low, high = self.rigid.ends
        phi1 = np.linspace(low, min(high, low + self.machine.period), 721)
        mean = float(np.abs(super().mesh_torque(phi1)).mean())
        if not mean > 0.0:
            what = "the teeth carry nothing: their stiffness under load is not known"
            raise InfeasibleError(what, where="load", nearest="a load, or rigid = true")
        return mean

    @cached_property
    def stiffness(self) -> Smooth:
        """Stiffness of the mesh over the driver's angle, N m/rad, at the nominal torque."""
        result, travel = self.result, self.machine.period
        count = _PER_TOOTH * result.pair.teeth[0]
        phi1 = travel * (np.arange(count) + 0.5) / count
        given = self._settings.stiffness
        if given is not None:
            pairs = result.subject.sides[1]
            width = result.design.pair.face_width
            samples = mesh_stiffness(pairs, phi1, given, width, self._nominal)
        else:
            samples = self._by_elements(phi1)
        return Smooth(phi1, samples, travel if self.machine.closed else None, positive=True)

    @cached_property
    def _elements(self) -> ElasticPair:
        """The wheels as finite elements, under the nominal torque."""
        from gearcam.kinds.gear_pair.elastic_pair import ElasticPair

        load = WheelLoadSpec(torque=1e3 * self._nominal)
        return ElasticPair(self.result, self.progress, (load,))

    def _by_elements(self, phi1: Array) -> Array:
        """Return the stiffness by finite elements at driver angles, (n,), N m/rad."""
        entries = self._elements.entries(phi1)
        if len(entries.phi1) < len(phi1):
            what = "teeth carry nothing at some phases: their stiffness is not known"
            raise InfeasibleError(what, where="pair", nearest="a larger contact ratio")
        return 1e-3 * np.abs(entries.load) / entries.bent

    @cached_property
    def backlash(self) -> Smooth:
        """Angle of the driven wheel between its flanks, rad, over the driver's angle."""
        places = self.stiffness.places
        made = backlash_angle(self.result.subject.sides, places)
        return Smooth(places, made, self.stiffness.period)

    @cached_property
    def pair(self) -> StiffPair:
        """The pair with elastic teeth."""
        machine: PairMachine = self.rigid.machine  # type: ignore[assignment]
        stiff, apart = self.stiffness, self.backlash

        def rows(phi1: Array) -> Array:
            row = machine.rows.at(phi1)
            rubs = [row[0] + one for one in row[2:4]] if machine.rubs else []
            x = np.mod(phi1, machine.period) if machine.closed else phi1
            mesh = [one(x, order) for one in (stiff, apart) for order in (0, 1)]
            mesh[2] = np.maximum(mesh[2], 0.0)
            return np.stack([*row[:2], *mesh, *rubs])

        def load(phi1: float, w2: float) -> float:
            row = machine.rows(phi1)
            return machine.driven_load(row, w2 / row[0])

        knots = stiff.knots
        knots = knots[(knots > machine.knots[0]) & (knots < machine.knots[-1])]
        inertia = machine.driver + machine.flywheel, machine.driven
        table = Tabled(rows, distinct(machine.knots, knots), _EXACT, closed=machine.closed, cuts=1)
        made = StiffPair(
            table=table,
            inertia=inertia,
            damping=0.0,
            motor=None if self.rigid.motor is None else self.rigid.motor.torque,
            load=load,
        )
        return made.damped(self._settings.damping_ratio)

    @cached_property
    def _runs(self) -> tuple[StiffRun, StiffRun]:
        """The run, and the same with a tenth of the tolerance."""
        rigid, spec = self.rigid, self._settings
        low, high = rigid.ends
        if self.machine.closed:
            usual = math.ceil((high - low) / self.machine.period) if spec.run == COASTING else 3
            high = low + self.machine.period * (spec.turns or usual)
        start = self.pair.resting(low, float(rigid.speed(np.array([low]))[0]))
        settings: dict[str, Any] = {
            "knots": self.machine.knots,
            "method": spec.method,
            "keep": max(low, high - self.machine.period),
        }
        about = self.pair.forecast(start, high, rtol=spec.tolerance, **settings)
        told = f", about {formatted(2.3 * about, 2)} s" if about > _LONG else ""
        turns = round(100.0 * (high - low) / self.machine.period)

        def passed(phi1: float) -> None:
            done = round(100.0 * (phi1 - low) / self.machine.period)
            self.progress(f"hundredths of turns{told}", done, turns)

        def made(rtol: float) -> StiffRun:
            run = self.pair.run(start, high, rtol=rtol, passed=passed, **settings)
            if run.motion.pieces:
                return run
            # it stalled before what is kept
            kept: dict[str, Any] = {"keep": max(low, run.motion.place - self.machine.period)}
            return self.pair.run(start, high, rtol=rtol, **settings | kept)

        return made(spec.tolerance), made(0.1 * spec.tolerance)

    @property
    def motion(self) -> ElasticMotion:
        """The last turn with elastic teeth."""
        return self._last_turn

    @cached_property
    def _last_turn(self) -> ElasticMotion:
        run = self._runs[0]
        pieces, high = run.motion.pieces, run.motion.place
        low = max(pieces[0].low, high - self.machine.period)
        knots = self.machine.knots_over(math.ceil(high / self.machine.period) + 1)
        knots = np.concatenate([knots, [place for place, _, _ in run.motion.switches]])
        inner = knots[(knots > low) & (knots < high)]
        turned = self.machine.period * math.floor(low / self.machine.period + 1e-9)
        return ElasticMotion(
            machine=self.rigid.machine,
            motor=self.rigid.motor,
            run=run,
            knots=distinct(inner, [low, high]) - turned,
            turned=turned,
        )

    def mesh_torque(self, phi1: Array) -> Array:
        """Return the torque of the teeth on the driven wheel at driver angles, (n,), N m."""
        return self.motion.at(phi1)["mesh"]

    def _most(self, moving: MovingPair) -> Array:
        """Return angles, rad, at which the teeth may have most: also those of their vibrations."""
        torque, x = np.abs(self.motion.values["mesh"]), self.motion.places
        summit = np.flatnonzero((torque[1:-1] >= torque[:-2]) & (torque[1:-1] > torque[2:]))

        def carried(phi1: Array, _: Ints) -> Array:
            return np.abs(self.mesh_torque(phi1.ravel())).reshape(phi1.shape)

        found, _ = peaks(carried, x[summit], x[summit + 2], _NARROW * x[-1])
        return np.append(super()._most(moving), found)

    def columns(self) -> dict[str, Array]:
        """Return the columns of ``dynamics.csv``."""
        columns = super().columns()
        found = self.motion.at(self.places)
        nominal = self.result.pair.rolling.guide.nominal(self.places)
        columns["phi2_deg"] = np.degrees(nominal - found["lag"])
        columns["omega2_rad_s"] = found["w2"]
        modes = self.motion.modes(self.places)
        sides = {APART: 0, COAST: -1}
        return columns | {
            "lag_rad": found["lag"],
            "contact": np.array([sides.get(one, 1) for one in modes]),
        }

    @cached_property
    def tooth_frequency(self) -> tuple[Array, Array]:
        """Places of the turn, rad, and the frequency of the teeth there over the natural one."""
        low, high = self.motion.ends
        phi1 = np.linspace(low, high, 721)
        pairs = self.result.subject.sides[1]
        x = np.mod(phi1, self.machine.period) if self.machine.closed else phi1
        step = 1e-4 * self.machine.period
        ends = np.clip([x - step, x + step], 0.0, self.machine.period)
        way = np.diff([pairs.track.arc_length(one) for one in ends], axis=0) / np.diff(ends, axis=0)
        passing = way[0] * self.motion.speed(phi1) / pairs.pitch
        return phi1, 2.0 * math.pi * passing / self.pair.frequency(x)

    def findings(self) -> tuple[Finding, ...]:
        """Return the findings of the motion, the forces of the teeth, and their vibration."""
        phi1, ratio = self.tooth_frequency
        teeth = VibratingTeeth(
            lost=self.motion.lost_contact,
            phi1=phi1,
            ratio=ratio,
            speed=self.motion.mean_speed,
            place=self.place,
        )
        found = super().findings()
        if COAST not in self.motion.modes(self.places):  # dampers pull a little where teeth part
            found = tuple(one for one in found if one.code != "torque-reversal")
        return found + run_checks(VIBRATION, teeth, self.design.limits)

    def facts(self, columns: Any) -> Tree:
        """Return the facts of the study."""
        run, (lag, speed) = self.motion.run, self._runs[0].difference(self._runs[1])
        natural = self.pair.frequency(self.pair.places) / TURN
        behind, ahead = self.largest(lambda phi: np.outer([1.0, -1.0], self.motion.states(phi)[2]))
        arcs = self.motion.lost_contact
        given = self._settings.stiffness is not None
        source = "given" if given else "by finite elements"
        stiffness = self.pair.table.at(self.pair.places)[2]
        mean, error = float(stiffness.mean()), self.stiffness.error
        jumps = f", jumps by {formatted(error, 2)}" if error > _JUMPS * mean else ""
        lost = f"{len(arcs)} arcs, {formatted(math.degrees(_sum(arcs)), 4)} deg together"
        return super().facts(columns) | {
            **({} if given else elasticity(self._elements)),
            "run": Fact(self.spec.run, "motion", text=self._words, shown=True),
            "stiffness_nm_rad": Fact(
                extent(float(stiffness.min()), float(stiffness.max())),
                f"stiffness of the mesh, {source}",
                place=f"under {readable(self._nominal, 'N m')}, mean {formatted(mean, 4)}{jumps}",
                unit="N m/rad",
                shown=True,
            ),
            "natural_frequency_hz": Fact(
                extent(float(natural.min()), float(natural.max())),
                "natural frequency of the mesh",
                unit="Hz",
                shown=True,
            ),
            "lag_arcsec": Fact(
                extent(-ahead / ARCSEC.factor, behind / ARCSEC.factor),
                "lag of the driven wheel",
                place="from the middle of the backlash",
                unit="arcsec",
                shown=True,
                error=lag / ARCSEC.factor,
            ),
            "damping_ratio": self._settings.damping_ratio,
            "method": self._settings.method,
            "switches": len(run.motion.switches),
            "contact_lost_deg": [[math.degrees(one.low), math.degrees(one.high)] for one in arcs]
            or None,
            "impact_rad_s": Fact(
                max(one.impact for one in arcs),
                "hardest impact of the teeth",
                place=lost,
                unit="rad/s",
                shown=True,
            )
            if arcs
            else None,
            "error": {
                "lag_arcsec": Fact(lag / ARCSEC.factor, "lag known to", unit="arcsec", shown=True),
                "speed_rpm": speed / RPM.factor,
            },
        }

    @property
    def _words(self) -> str:
        turns = self.spec.turns or 3
        if not self.machine.closed:
            return super()._words
        if self.spec.run == COASTING:
            return f"elastic teeth, the last turn; {super()._words}"
        return f"elastic teeth, the last of {turns} turns; {super()._words}"

    def charts(self, columns: Any) -> dict[str, Chart]:
        """Return the charts of the study."""
        charts = super().charts(columns)
        fine, values = {"phi1_deg": np.degrees(self.motion.places)}, self.motion.values
        mesh, lag = {"on the driven wheel": values["mesh"]}, {"lag": values["lag"] / ARCSEC.factor}
        charts["mesh_torque"] = self.chart(fine, "Torque of the teeth", "torque, N m", mesh)
        charts["lag"] = self.chart(fine, "Lag of the driven wheel", "lag, arcsec", lag)
        charts["spectrum"] = self._spectrum()
        hits = [one for one in self.motion.lost_contact if one.onto]
        if hits:
            at = np.degrees([one.high for one in hits])
            dots = Line(label="impacts", x=at, y=np.array([one.impact for one in hits]), dots=True)
            charts["impacts"] = Chart(
                title="Impacts in the backlash", x=self.axis, y="speed, rad/s", lines=(dots,)
            )
        return charts

    def _spectrum(self) -> Chart:
        """Return the chart of the lag over frequency, in the last turn."""
        motion = self.motion
        (low, high), count = motion.ends, _LINES
        fine = np.linspace(low, high, 4 * count)
        even = np.linspace(0.0, motion.lasts, count, endpoint=False)
        phi1 = np.interp(even, motion.time(fine) - motion.time(fine[:1]), fine)
        lag = motion.states(phi1)[2] / ARCSEC.factor
        found = 2.0 * np.abs(np.fft.rfft(lag)) / count
        hz = np.arange(len(found)) / motion.lasts
        kept = slice(1, count // 4)
        natural = float(self.pair.frequency(self.pair.places).mean()) / TURN
        teeth = self.result.pair.teeth[0] * self.machine.period / TURN / motion.lasts
        return Chart(
            title="Spectrum of the lag over a turn",
            x="frequency, Hz",
            y="amplitude, arcsec",
            lines=(Line(label="lag", x=hz[kept], y=found[kept]),),
            marks=(
                MarkedPlace(label="mean natural frequency", value=natural),
                MarkedPlace(label="teeth per second", value=teeth),
            ),
            log="y",
        )


def _sum(arcs: list[LostContact]) -> float:
    """Return the length of arcs, rad."""
    return sum(one.high - one.low for one in arcs)
