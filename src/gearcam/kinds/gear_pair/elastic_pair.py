"""A pair with elastic wheels under its loads: every phase with the stress of all roots."""

from __future__ import annotations

import math
from dataclasses import dataclass, replace
from typing import TYPE_CHECKING, Any, Final, NamedTuple

import numpy as np

from gearcam.base.display import ShortRepr
from gearcam.base.errors import InfeasibleError
from gearcam.kinds.gear_pair.forces import PairUnderLoad
from gearcam.meshing.edges import first_touch
from gearcam.results.study import silent

if TYPE_CHECKING:
    from collections.abc import Sequence

    from gearcam.kinds.gear_pair.result import GearPairResult
    from gearcam.mechanics.wheel_load import WheelLoadSpec
    from gearcam.meshing.contact import Contacts
    from gearcam.numeric.arrays import Array, Ints
    from gearcam.results.study import Progress
    from gearcam.stress.checks import CertifiedRoot
    from gearcam.stress.cycle import LoadedCycle
    from gearcam.stress.elastic import PlaneModuli
    from gearcam.stress.influence import Influence
    from gearcam.stress.region import Region

ROOTS: Final = ("tension", "compression")
"""Rows of stresses in roots."""

_NEAR: Final = 0.05
"""Largest gap at which edges are looked for at first, in modules: twice as large while the wheels
close by more."""

_FAR: Final = 1.0
"""Gap beyond which they are not, in modules: no tooth bends so far."""

_OF_SECTOR: Final = 4e-3
"""Relative error of a stress that a sector has instead of the wheel: 0.2 % of tension and 0.4 % of
compression were the most."""

_LARGE: Final = 120
"""Number of teeth above which a stress is certified on a sector: the rest does not matter to it."""

_BESIDE: Final = 2
"""Teeth of the sector on both sides of those that are loaded."""

_DEPTH: Final = 5.0
"""Metal of the sector below the roots, in modules."""

_NO_LOAD: Final = 1e-9
"""Share of the largest load below which a phase has none."""


@dataclass(frozen=True, eq=False, kw_only=True)
class Entries(ShortRepr):
    """A pair under load at e entries, which are phases, or each contact of a phase by itself.

    Parameters
    ----------
    phi1, load : (e,) arrays, rad and N mm
        Phase, and load on the driven element.
    lag, bent : (e,) arrays, rad
        Lag of the driven element behind its nominal place, and how much of it is elastic.
    stiffness : (e,) array, N mm/(mm rad)
        Derivative of the load by the lag, per width.
    step : (k,) int array
        Entry of each contact.
    teeth : (2, k) int array
        Tooth numbers.
    force, half_width, curvature : (k,) arrays, N/mm, mm and 1/mm
        Normal force per width, and the contact.
    friction : (k,) array
        Force along the flank over the normal force (see `LoadedTeeth.friction`).
    edge : (k,) bool array
        Whether the end of a flank touches.
    points, directions : (2, k) complex arrays, mm and 1
        Point and normal force on each wheel, in its own frame.
    roots : ((2, e, t), (2, e, t)) arrays, MPa
        Tension and compression in the roots of each tooth of both wheels.
    numbers : ((t,), (t,)) int arrays
        Numbers of these teeth.
    """

    phi1: Array
    load: Array
    lag: Array
    bent: Array
    stiffness: Array
    step: Ints
    teeth: Ints
    force: Array
    half_width: Array
    curvature: Array
    friction: Array
    edge: Any
    points: Any
    directions: Any
    roots: tuple[Array, Array]
    numbers: tuple[Ints, Ints]

    @property
    def worst(self) -> tuple[Array, Array]:
        """The larger of tension and compression, (e, t), MPa, of both wheels."""
        first, second = (np.maximum(one[0], -one[1]) for one in self.roots)
        return first, second

    @property
    def pairs(self) -> Ints:
        """Number of contacts that carry in each entry, (e,)."""
        made: Ints = np.bincount(self.step[self.force > 0.0], minlength=len(self.phi1))
        return made

    @property
    def share(self) -> Array:
        """Share of each contact of the forces of its entry, (k,)."""
        sums = np.bincount(self.step, self.force, len(self.phi1))
        made: Array = self.force / sums[self.step]
        return made


class FlankTouch(NamedTuple):
    """Contacts of the flanks of one side.

    Attributes
    ----------
    points : Contacts
        The k contacts.
    gain, friction : (k,) arrays, mm and 1
        See `TouchingTeeth`.
    """

    points: Contacts
    gain: Array
    friction: Array


class SolvedSide(NamedTuple):
    """The pair with flanks of one side under load.

    Attributes
    ----------
    phi1, load : (e,) arrays, rad and N mm
        Phases, and the load on the driven element.
    sign : float
        1 if the driving flanks carry, -1 if the coast flanks do: the driven element is then ahead.
    behind : (e,) array, rad
        By how much it lags where its flanks just touch.
    cycle : LoadedCycle
        Forces and stresses.
    """

    phi1: Array
    load: Array
    sign: float
    behind: Array
    cycle: LoadedCycle


class ElasticPair:
    """A pair with elastic wheels.

    Parameters
    ----------
    result : GearPairResult
        The pair.
    progress : Progress
        Told of the wheels done.
    loads : sequence of WheelLoadSpec, optional
        In place of those of its design.

    Raises
    ------
    DesignError, InfeasibleError
        If a load does not fit, or the wheels cannot be held so.
    """

    def __init__(
        self,
        result: GearPairResult,
        progress: Progress = silent,
        loads: Sequence[WheelLoadSpec] | None = None,
    ) -> None:
        from gearcam.stress.elastic import PlaneModuli
        from gearcam.stress.region import region_of, tooth_spans

        self.result, self.under = result, PairUnderLoad(result, loads)
        self._progress = progress
        self.spec = result.design.stress
        held = self.spec.held_diameter or (None, None)
        self.regions: tuple[Region, ...] = tuple(
            region_of(part, one) for part, one in zip(result.parts, held, strict=True)
        )
        self.moduli: tuple[PlaneModuli, ...] = tuple(
            PlaneModuli(
                young=young,
                poisson=poisson,
                plane="stress" if self.spec.plane == "stress" else "strain",
            )
            for young, poisson in result.design.material.elasticity
        )
        self.spans = tuple(map(tooth_spans, self.regions, result.gears))
        self._wheels: dict[int, tuple[Influence, Influence]] = {}

    @property
    def width(self) -> float:
        """Face width, mm."""
        return self.under.width

    def wheels(self, side: int) -> tuple[Influence, Influence]:
        """Return what forces on the flanks of a `side`, 0 or 1, do to both wheels."""
        from gearcam.stress.influence import influence, loaded_flanks

        if side not in self._wheels:
            made = []
            flanks = self.under.sides[0][side].wheels
            for region, (numbers, spans), gear, one, moduli in zip(
                self.regions, self.spans, self.result.gears, flanks, self.moduli, strict=True
            ):
                self._progress("elastic wheels", len(made), len(self.regions))
                ends = loaded_flanks(region, gear, one.sigma, numbers)
                module = self.result.pair.module
                made.append(influence(region, module, numbers, spans, ends, moduli))
            self._wheels[side] = (made[0], made[1])
        return self._wheels[side]

    def entries(self, phi1: Array) -> Entries:
        """Return the pair under load at driver angles.

        Phases without load, and those in which no teeth carry or friction locks them, are left out.

        Parameters
        ----------
        phi1 : (n,) array, rad
            Driver angles.

        Raises
        ------
        InfeasibleError
            If nothing is left.
        """
        forces = self.under.loaded(phi1).forces
        load = np.where(forces.driven, forces.load, self.under.without_friction(phi1))
        most, teeth = np.nanmax(np.abs(load), initial=0.0), forces.teeth
        # friction and journals: what the load is over the moment of the normal forces
        step, gain = teeth.points.step, np.abs(teeth.gain[1])
        moment = np.bincount(step, forces.of_teeth * gain, len(phi1))[step]
        with np.errstate(divide="ignore", invalid="ignore"):  # without load
            gain = gain * np.abs(forces.load[step]) / moment
        found = []
        for side, sign in ((1, 1.0), (0, -1.0)):
            rows = np.flatnonzero(sign * load > _NO_LOAD * most)
            at = np.flatnonzero(np.isin(step, rows))
            points = replace(teeth.points.take(at), step=np.searchsorted(rows, step[at]))
            touch = FlankTouch(points, gain[at], teeth.friction[at])
            if len(rows):
                found += self._of_side(side, phi1[rows], sign * load[rows], touch)
        if not found:
            what, near = (
                "no teeth carry: there is no stress",
                "a load above 0, and teeth in contact",
            )
            raise InfeasibleError(what, where="load", nearest=near)
        return _joined(found)

    def _of_side(self, side: int, phi1: Array, load: Array, touch: FlankTouch) -> list[SolvedSide]:
        """Return the pair with flanks of one side under loads, which are above 0."""
        from gearcam.meshing.about_to_touch import about_to_touch
        from gearcam.stress.cycle import loaded_cycle, touching_teeth
        from gearcam.stress.sharing import ContactWidths

        pairs, wheels = self.under.sides[0][side], self.wheels(side)
        found = touch.points
        module, near = self.result.pair.module, _NEAR
        edges = self.spec.edges and not self.spec.alone
        about = about_to_touch(pairs, phi1, found, near * module) if edges else None
        steps = found.step if about is None else np.append(found.step, about.step)
        touched = np.isin(np.arange(len(phi1)), steps)
        if not touched.all():  # nothing drives at some of them
            if not touched.any():
                return []
            left = replace(found, step=(np.cumsum(touched) - 1)[found.step])
            return self._of_side(side, phi1[touched], load[touched], touch._replace(points=left))
        lead, _ = first_touch(pairs, phi1, found)
        widths = ContactWidths(
            material=self.result.design.material,
            local=sum(1.0 / (math.pi * one.along_edge) for one in self.moduli),
            spread=wheels[0].spread,
        )
        while True:
            touching = touching_teeth(pairs, phi1, *touch, about)
            rows = touching.step if self.spec.alone else np.arange(len(phi1))
            if self.spec.alone:
                touching = replace(touching, step=np.arange(len(rows)))
            cycle = loaded_cycle(wheels, touching, load[rows] / self.width, widths)
            closed = float((touching.lever * cycle.sharing.lag[touching.step]).max())
            if about is None or closed < near * module or near > _FAR:
                sign = 1.0 if side else -1.0
                return [SolvedSide(phi1[rows], sign * load[rows], sign, -lead[rows], cycle)]
            near *= 2.0
            about = about_to_touch(pairs, phi1, found, near * module)

    def _around(self, wheel: int, tooth: int, loaded: Ints) -> tuple[Region, tuple[float, float]]:
        """Return the region of a wheel, of a large one the sector around some teeth; and a tooth's.

        The second are s from the middle of the root before the tooth to that after it.
        """
        from gearcam.stress.sector import sector

        region, gear = self.regions[wheel - 1], self.result.gears[wheel - 1]
        numbers, spans = self.spans[wheel - 1]
        own = spans[int(np.flatnonzero(numbers == tooth)[0])]
        whole = region, (float(own[0]), float(own[1]))
        if gear.toothing.teeth <= _LARGE or not gear.toothing.closed:
            return whole
        rows = np.flatnonzero(np.isin(numbers, [tooth, *loaded.tolist()]))
        half = len(numbers) // 2
        away = (rows - rows[0] + half) % len(numbers) - half
        low, high = rows[0] + away.min() - _BESIDE, rows[0] + away.max() + _BESIDE
        ends = spans[low % len(numbers), 0], spans[high % len(numbers), 1]
        try:
            part = sector(region, *ends, _DEPTH * self.result.pair.module)
        except ValueError:  # an opening is near
            return whole
        first, last = part.teeth.nearest(region.teeth.at(own)[0]).tolist()
        return part, (first, last)

    def certified(self, entries: Entries, wheel: int, tooth: int, entry: int) -> CertifiedRoot:
        """Return the certified stress of a wheel at an entry.

        Parameters
        ----------
        entries : Entries
            The pair under load.
        wheel, tooth : int
            The wheel, and the tooth that is looked at.
        entry : int
            Number of the entry.

        Returns
        -------
        CertifiedRoot

        Raises
        ------
        InfeasibleError
            If the contact is too wide for the flank, or the wheel has no fillets.
        """
        from gearcam.stress.certify import certified
        from gearcam.stress.checks import CertifiedRoot
        from gearcam.stress.hertz_load import hertz_load

        module, material = self.result.pair.module, self.result.design.material
        here = np.flatnonzero((entries.step == entry) & (entries.force > 0.0))
        here = here[np.argsort(-entries.force[here])]
        region, within = self._around(wheel, tooth, entries.teeth[wheel - 1, here])
        flank_loads = [
            hertz_load(
                region,
                complex(entries.points[wheel - 1, k]),
                complex(entries.directions[wheel - 1, k]),
                float(entries.force[k]),
                curvature=float(entries.curvature[k]),
                material=material,
                friction=float(entries.friction[k]),
            )
            for k in here
        ]
        made = certified(
            region,
            module,
            flank_loads[0],
            self.moduli[wheel - 1],
            others=flank_loads[1:],
            within=within,
            tolerance=self.spec.tolerance,
        )
        if region is not self.regions[wheel - 1]:
            made = replace(made, error=made.error + _OF_SECTOR)
        strength = material.yield_strength
        return CertifiedRoot(
            wheel=wheel,
            tooth=tooth,
            phi1=float(entries.phi1[entry]),
            force=float(entries.force[here].sum()) * self.width,
            share=float(entries.share[here[0]]),
            loaded=tooth in entries.teeth[wheel - 1, here],
            certificate=made,
            yields=None if strength is None else strength[wheel - 1],
        )


def _joined(found: list[SolvedSide]) -> Entries:
    """Return the entries of both sides, in order of their phases."""
    phi1, load, signs, behind, cycles = zip(*found, strict=True)
    bent = [one.sharing.lag for one in cycles]
    lag = [b + sign * e for b, sign, e in zip(behind, signs, bent, strict=True)]
    angle = np.concatenate(phi1)
    order = np.argsort(angle, kind="stable")
    place = np.argsort(order)  # of each entry, among the ordered ones
    starts = np.cumsum([0, *map(len, phi1)])
    step = [
        place[start + one.touching.step] for start, one in zip(starts[:-1], cycles, strict=True)
    ]
    at = np.argsort(np.concatenate(step), kind="stable")

    def entries(values: list[Array]) -> Array:
        return np.concatenate(values)[order]

    def teeth(values: list[Any]) -> Any:
        return np.concatenate(values, axis=-1)[..., at]

    roots = [
        np.stack([entries([getattr(one.roots[w], name) for one in cycles]) for name in ROOTS])
        for w in (0, 1)
    ]
    return Entries(
        phi1=angle[order],
        load=entries(list(load)),
        lag=entries(lag),
        bent=entries(bent),
        stiffness=entries([one.sharing.stiffness for one in cycles]),
        step=np.concatenate(step)[at],
        teeth=teeth([one.touching.teeth for one in cycles]),
        force=teeth([one.force for one in cycles]),
        half_width=teeth([one.half_width for one in cycles]),
        curvature=teeth([one.touching.curvature for one in cycles]),
        friction=teeth([one.touching.friction for one in cycles]),
        edge=teeth([one.touching.edge for one in cycles]),
        points=teeth([one.touching.points for one in cycles]),
        directions=teeth([one.touching.directions for one in cycles]),
        roots=(roots[0], roots[1]),
        numbers=(cycles[0].roots[0].numbers, cycles[0].roots[1].numbers),
    )
