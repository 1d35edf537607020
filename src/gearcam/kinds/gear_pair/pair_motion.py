"""A pair as a machine: its inertia, what resists, and its motion with rigid teeth."""

from __future__ import annotations

import math
from dataclasses import dataclass
from functools import cached_property
from typing import TYPE_CHECKING, Any, Final

import numpy as np

from gearcam.base.errors import InfeasibleError
from gearcam.base.facts import Fact, Tree, extent
from gearcam.base.findings import Finding, run_checks
from gearcam.base.quantities import TORQUE
from gearcam.dynamics.machine import PairMachine
from gearcam.dynamics.tabled import Tabled
from gearcam.kinds.gear_pair.forces import PairUnderLoad, extreme_fact
from gearcam.kinds.machine_motion import MachineRun, speed_powers
from gearcam.laws.ratio.span import angle_text
from gearcam.meshing.contact import contacts
from gearcam.meshing.settings import DYNAMIC_FORCES
from gearcam.numeric.arrays import distinct
from gearcam.numeric.chebyshev import NotSmoothError
from gearcam.numeric.piecewise import with_both_sides
from gearcam.numeric.roots import bracketed_root

if TYPE_CHECKING:
    from collections.abc import Callable

    from gearcam.gears.contact import FlankPairs
    from gearcam.kinds.gear_pair.result import GearPairResult
    from gearcam.meshing.force_checks import LoadedPair
    from gearcam.numeric.arrays import Array
    from gearcam.pictures.charts import Chart

_KILO: Final = TORQUE.factor
"""N mm of a N m."""

_M2: Final = 1e-6
"""m2 of a mm2."""

_PER_TOOTH: Final = 24
"""Places for each tooth of the driver at which changes of friction are looked for."""

_CLOSE: Final = 1e-13
"""Width to which they are narrowed, over the turn or travel."""

_PROBES: Final = 97
"""Places at which loads are looked at."""

_REPEATS: Final = 1e-6
"""Difference of a load in another turn, over the largest, that is rounding."""

_EXACT: Final = 1e-11
"""Error of tables over the largest value."""

_OF_CONTACTS: Final = 1e-9
"""The same with friction: that of places of contact."""


def inertias(result: GearPairResult) -> tuple[float, float]:
    """Return the moments of inertia of all that turns with each shaft, kg m2.

    Parameters
    ----------
    result : GearPairResult
        The pair; wheels without a density have none.
    """
    from gearcam.parts.mass import mass_properties

    given = result.design.dynamics.inertia
    if given is not None:
        return given
    found = [0.0, 0.0]
    for number, part in enumerate(result.parts):
        density = result.design.blank.wheel(number + 1).density
        if density is not None:
            found[number] = _M2 * mass_properties(part, density).inertia
    return found[0], found[1]


def machine_of(under: PairUnderLoad, inertia: tuple[float, float], speed: float) -> PairMachine:
    """Return a pair as a machine.

    Parameters
    ----------
    under : PairUnderLoad
        The pair with its loads.
    inertia : (float, float), kg m2
        Of both shafts.
    speed : float, rad/s
        A usual speed of the driver.

    Raises
    ------
    InfeasibleError
        If friction locks the pair, or the load is no polynomial of the speed.
    """
    guide, friction = under.result.pair.rolling.guide, under.result.design.friction
    rubs = any((friction.flank, friction.rolling, *friction.journals))

    def load(phi1: Array, omega: float) -> Array:
        return under.given(phi1, omega) / _KILO

    knots = np.concatenate([[0.0], under.knots(back=rubs, forth=rubs), [under.travel]])
    if rubs:
        knots = distinct(knots, _turns_of_friction(under, knots))
    if under.turns:
        _demand_period(under, load, speed)
    coefficients = speed_powers(load, np.linspace(0.0, under.travel, _PROBES), speed)

    def rows(phi1: Array) -> Array:
        _, ratio, slope = (guide.scale * one for one in guide.law.derivatives(phi1, 2))
        more = [_taken(under, phi1, sign) for sign in (1.0, -1.0)] if rubs else []
        return np.stack([ratio, slope, *more, *coefficients(phi1)])

    try:
        exact = _OF_CONTACTS if rubs else _EXACT
        tabled = Tabled(rows, knots, exact, closed=under.turns)
    except NotSmoothError as error:
        what = f"ratio or load is {'not smooth' if error.finite else 'not finite'}"
        raise InfeasibleError(f"{what} at {angle_text(error.place)}", where="load") from error
    return PairMachine(rows=tabled, knots=knots, driver=inertia[0], driven=inertia[1], rubs=rubs)


def _demand_period(
    under: PairUnderLoad, load: Callable[[Array, float], Array], speed: float
) -> None:
    """Refuse a load over phi2 that does not repeat with each turn of the driver."""
    x = np.linspace(0.0, under.travel, _PROBES)
    first, second = load(x, speed), load(x + under.travel, speed)
    if np.abs(second - first).max() > _REPEATS * np.abs(first).max():
        what = "a load does not repeat with every turn of the driver, as the motion does"
        near = "over phi1, or over whole turns of the driven wheel in a turn"
        raise InfeasibleError(what, where="load", nearest=near)


def _turns_of_friction(under: PairUnderLoad, knots: Array) -> Array:
    """Return where the sliding of a contact changes its direction, rad.

    Backlash moves these places away from the pitch point.
    """
    count = _PER_TOOTH * under.result.pair.teeth[0]
    x = with_both_sides(np.linspace(0.0, under.travel, count + 1), knots)
    roots = [_reversals(pairs, x) for both in under.sides for pairs in both]
    return np.concatenate(roots)


def _reversals(pairs: FlankPairs, x: Array) -> Array:
    """Return where contacts of a side cease to slide, between neighbouring angles `x`."""
    found = contacts(pairs, x)
    order = np.lexsort((found.step, found.pair))
    step, pair, sliding = found.step[order], found.pair[order], found.sliding[order]
    beside = (np.diff(pair) == 0) & (np.diff(step) == 1)
    at = np.flatnonzero(beside & (sliding[:-1] * sliding[1:] < 0.0))

    def own(phi1: Array) -> Array:
        """Return the sliding of each of these contacts at an angle."""
        there = contacts(pairs, phi1)
        row = np.flatnonzero(there.pair == pair[at][there.step])
        made = np.full(phi1.shape, np.nan)
        made[there.step[row]] = there.sliding[row]
        return made

    ends = sliding[at], sliding[at + 1]
    return bracketed_root(own, x[step[at]], x[step[at + 1]], _CLOSE * x[-1], ends)


def _taken(under: PairUnderLoad, phi1: Array, sign: float) -> Array:
    """Return by how much the driver's torque per load exceeds the ratio, (n,).

    Parameters
    ----------
    under : PairUnderLoad
        The pair.
    phi1 : (n,) array, rad
        Driver angles.
    sign : {1, -1}
        Whether the teeth drive the load, or are driven by it.
    """
    forces = under.forces(phi1, np.full(phi1.shape, sign))
    if forces.locked.any():
        where = angle_text(float(phi1[forces.locked][0]))
        what = f"friction locks the pair at {where}"
        raise InfeasibleError(what, where="friction", nearest="less friction")
    return sign * np.nan_to_num(forces.lost)  # 0 where no flanks touch


class MovingPair(PairUnderLoad):
    """A pair whose teeth carry the torque of its motion.

    Parameters
    ----------
    result : GearPairResult
        The pair.
    torque : callable
        ``torque(phi1)``: of the teeth on the driven wheel, N m, at driver angles (n,).
    """

    def __init__(self, result: GearPairResult, torque: Callable[[Array], Array]) -> None:
        super().__init__(result)
        self._torque = torque

    def _given(self, phi1: Array) -> Array:
        """Return the torque of the teeth on the driven wheel, N mm."""
        return _KILO * self._torque(phi1)


@dataclass(frozen=True, eq=False, kw_only=True)
class PairRun(MachineRun):
    """A pair with the motor and the run of its design.

    Parameters
    ----------
    result : GearPairResult
        The pair.
    machine : PairMachine
        The pair as a machine, without a flywheel.
    """

    result: GearPairResult
    machine: PairMachine

    def mesh_torque(self, phi1: Array) -> Array:
        """Return the torque of the teeth on the driven wheel at driver angles, (n,), N m."""
        motion = self.rigid
        phi1 = np.maximum(
            phi1, motion.ends[0]
        )  # from rest it begins a little after its first angle
        row, omega = motion.rows(phi1), motion.speed(phi1)
        machine = self.machine.with_flywheel(self.flywheel)
        return np.asarray(machine.mesh_torque(row, omega, motion.driving(phi1, omega))[0])

    @cached_property
    def _mesh_range(self) -> list[float]:
        """Largest torque of the teeth against and with the driven wheel's motion, N m."""
        return self.largest(lambda phi1: np.outer([-1.0, 1.0], self.mesh_torque(phi1)))

    @cached_property
    def loaded(self) -> LoadedPair:
        """The forces of the teeth at the places of the table, and where they are most."""
        moving = MovingPair(self.result, self.mesh_torque)
        return moving.loaded(distinct(self.places, self._most(moving)))

    def _most(self, moving: MovingPair) -> Array:
        """Return angles, rad, at which the teeth may have most, in each turn."""
        (low, high), period = self.motion.ends, self.machine.period
        if self.motion.stopped is not None and high < period:
            return self.places
        turns = period * np.arange(math.ceil(high / period))
        every = np.add.outer(turns, moving.places()).ravel()
        return every[(every >= low) & (every <= high)]

    def columns(self) -> dict[str, Array]:
        """Return the columns of ``dynamics.csv``."""
        columns = super().columns()
        phi1, omega = self.places, columns.pop("omega_rad_s")
        phi2, ratio = self.result.pair.rolling.guide.motion(phi1)
        at = np.searchsorted(self.loaded.forces.phi1, phi1)
        tooth = self.loaded.forces.largest(self.loaded.forces.of_teeth)[at]
        first = {name: columns.pop(name) for name in ("t_s", "phi1_deg")}
        return {
            **first,
            "phi2_deg": np.degrees(phi2),
            "omega1_rad_s": omega,
            "omega2_rad_s": ratio * omega,
            **columns,
            "torque_mesh_nm": self.mesh_torque(phi1),
            "normal_n": np.ma.masked_invalid(tooth),
        }

    def findings(self) -> tuple[Finding, ...]:
        """Return the findings of the motion, and of the forces of the teeth."""
        found = super().findings()
        return found + run_checks(DYNAMIC_FORCES, self.loaded, self.design.limits)

    def facts(self, columns: Any) -> Tree:
        """Return the facts of the study."""
        forces, friction = self.loaded.forces, self.design.friction
        below, above = self._mesh_range
        row, without = forces.teeth.points.step, friction.left_out
        return super().facts(columns) | {
            "mesh_torque_nm": Fact(
                extent(-below, above),
                "torque of the teeth on the driven wheel",
                unit="N m",
                shown=True,
            ),
            "normal_n": extreme_fact(
                self.loaded, forces.of_teeth, "normal force of a tooth", "N", row
            ),
            "bearing_n": extreme_fact(
                self.loaded, np.abs(forces.bearing), "force on either bearing", "N"
            ),
            "pressure_mpa": extreme_fact(
                self.loaded, self.loaded.pressure, "contact pressure (Hertz)", "MPa", row
            ),
            "shares": Fact("equal", "load on teeth that carry together", shown=True),
            "friction": Fact(", ".join(without), "friction left out", shown=True)
            if without
            else None,
        }

    def charts(self, columns: Any) -> dict[str, Chart]:
        """Return the charts of the study."""
        charts = super().charts(columns)
        teeth = {"on the driven wheel": columns["torque_mesh_nm"]}
        force = {"largest of a tooth": np.ma.filled(columns["normal_n"], np.nan)}
        charts["mesh_torque"] = self.chart(columns, "Torque of the teeth", "torque, N m", teeth)
        charts["normal"] = self.chart(columns, "Normal force", "normal force, N", force)
        return charts
