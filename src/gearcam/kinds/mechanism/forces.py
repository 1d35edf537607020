"""The study of the forces in a mechanism's joints, with friction."""

from __future__ import annotations

import math
from functools import cached_property, partial
from typing import TYPE_CHECKING, Any, Final

import numpy as np

from gearcam.base.errors import DesignError, InfeasibleError, Problem
from gearcam.base.facts import Fact, Tree, extent
from gearcam.base.findings import in_order, run_checks
from gearcam.base.numerals import FEW, formatted
from gearcam.kinds.mechanism.asked import DEG
from gearcam.kinds.mechanism.force_checks import CHECKS, JointedMachine
from gearcam.kinds.mechanism.keys import center_of, way_of
from gearcam.kinds.mechanism.loaded import work_of
from gearcam.kinds.mechanism.pressed import contacts_of
from gearcam.kinds.mechanism.torque import CHECKS as TORQUE
from gearcam.kinds.mechanism.torque import DriverEffort
from gearcam.linkages.bonds import FORCES, Bond, ChainDrive, Hinge, SlidingJoint
from gearcam.linkages.efforts import GRAVITY, INERTIA
from gearcam.linkages.friction import GuideFriction
from gearcam.linkages.known import GROUND
from gearcam.linkages.reactions import Reactions, Structure, UnheldError, reactions
from gearcam.numeric import narrowing
from gearcam.numeric.arrays import distinct, runs_of
from gearcam.numeric.gauss import gauss_cells
from gearcam.numeric.piecewise import with_both_sides
from gearcam.pictures.charts import Chart, Line
from gearcam.pictures.scenes import JointForce
from gearcam.results.study import StudyResult

if TYPE_CHECKING:
    from collections.abc import Iterator

    from gearcam.kinds.mechanism.parts.bearing import BearingSpec
    from gearcam.kinds.mechanism.placed import PlacedDrive
    from gearcam.kinds.mechanism.result import MechanismResult
    from gearcam.linkages.friction import Friction
    from gearcam.linkages.linkage import Linkage
    from gearcam.numeric.arrays import Array, Ints, Mask
    from gearcam.pictures.scenes import Scene
    from gearcam.results.study import Progress

_NM: Final = 1e-3
"""N m of a N mm."""

_NARROW: Final = 1e-7
"""Width, over the range, to which an extreme or the end of a locked range is narrowed."""

_HALVINGS: Final = 20
"""Halvings of the share of friction up to which nothing is locked."""

_NOISE: Final = 1e-9
"""Share of the largest value that is 0."""


class JointForces:
    """The forces in the joints of a mechanism.

    Parameters
    ----------
    result : MechanismResult
        The mechanism.

    Raises
    ------
    DesignError
        If a bearing is none.
    InfeasibleError
        If a load does not suit the motion.
    """

    def __init__(self, result: MechanismResult) -> None:
        self.result = result
        demand_no_change_points(result, "forces in joints are")
        self.work = work_of(result.design, result.linkage, result.drives)
        self.structure = Structure.of(self.work.linkage)
        if not self.structure.members:
            what, near = "has no members, and so no joints", "the study of torque: gearcam torque"
            raise InfeasibleError(what, where="drive", nearest=near)
        self.pressing = tuple(contacts_of(result.drives, self.work.linkage))

    @cached_property
    def labels(self) -> dict[Bond, str]:
        """Names of joints, guides and drives in tables."""
        return bond_names(self.structure)

    @cached_property
    def joints(self) -> dict[Hinge | SlidingJoint, str]:
        """Hinges and guides, with their names."""
        return {one: self.labels[one] for one in self.structure.joints}

    @cached_property
    def friction(self) -> dict[Bond, Friction[Any]]:
        """Friction of hinges and guides."""
        design, found = self.result.design, dict[Bond, Any]()
        for bond in self.joints:
            own = design.friction.of(bond)
            if own is not None:
                found[bond] = own
        problems, seen = list[Problem](), set[str]()
        for number, spec in enumerate(design.bearing):
            try:
                found |= self._bearing(spec, again=spec.on in seen)
            except ValueError as error:
                known = ", ".join(dict.fromkeys(map(_named, self.joints)))
                allowed = known if "no members" in str(error) else ""
                what, key = f"{spec.on} {error}", f"bearing[{number}]"
                problems.append(Problem(what, file=design.source, key=key, allowed=allowed))
            seen.add(spec.on)
        if problems:
            raise DesignError(problems)
        return found

    def _bearing(self, spec: BearingSpec, *, again: bool) -> dict[Bond, Friction[Any]]:
        """Return the friction of a single bearing; raise ValueError if it is none."""
        name = spec.on.removesuffix(".shaft")
        own = [one for one in self.joints if _named(one) == name]
        if not own:
            raise ValueError("has no members that meet there")
        if again:
            raise ValueError("has a bearing before")
        guides = [one for one in own if isinstance(one, SlidingJoint)]
        hinges = [one for one in own if isinstance(one, Hinge)]
        sized = spec.radius is not None
        chosen = hinges if hinges and (sized or not guides) else guides
        return {one: spec.of(one, self.result.design.friction) for one in chosen}

    def at(self, q: Array, share: float = 1.0) -> Reactions:
        """Return the forces at the master's angles, with a share of all coefficients of friction.

        Parameters
        ----------
        q : (n,) array, rad
            The angles.
        share : float
            Of the coefficients of the design.

        Raises
        ------
        InfeasibleError
            If a force acts on what no member carries, or is not finite.
        """
        friction = {bond: one.times(share) for bond, one in self.friction.items()}
        try:
            return reactions(
                self.work.linkage,
                self.work.efforts,
                q,
                speed=self.work.speed,
                friction=friction,
                contacts=self.pressing,
            )
        except UnheldError as error:
            what = f"the forces on {error.name} are not known: it is on no member"
            raise InfeasibleError(what, where="load") from error
        except np.linalg.LinAlgError as error:
            what = "the forces are not determined: members are in line or parallel somewhere"
            raise InfeasibleError(what, where="dyad") from error

    def sizes(self, found: Reactions) -> dict[str, Array]:
        """Return the sizes of the forces of joints and guides, (n,), N."""
        return {name: np.abs(found.force(bond)) for bond, name in self.joints.items()}

    def contacts(self, found: Reactions) -> dict[str, Array]:
        """Return the normal forces between cams and followers, (n,), N, by drives."""
        cams = (one.spec.name for one in self.result.drives if one.spec.cam is not None)
        return {name: found.contacts[name] for name in cams}

    def word(self, q: float) -> str:
        """Return a place of the master in words."""
        return self.result.place(q)

    def ranges(self, q: Array, mask: Mask) -> str:
        """Return in words where a `mask` holds, (n,), of rising angles `q`, (n,), rad."""
        if mask.all():
            return "everywhere"
        ends = [[formatted(DEG * float(q[k]), FEW) for k in one] for one in runs_of(mask)]
        words = [low if low == high else f"{low} to {high}" for low, high in ends[:3]]
        more = f" and {len(ends) - 3} more" if len(ends) > 3 else ""
        return f"{self.result.driver[0]} = {', '.join(words)} deg{more}"


def demand_no_change_points(result: MechanismResult, what: str) -> None:
    """Refuse a mechanism with change points, where members are in line.

    Parameters
    ----------
    result : MechanismResult
        The mechanism.
    what : str
        What is not computed for it, in words.

    Raises
    ------
    InfeasibleError
        If it has some.
    """
    for number, one in enumerate(result.linkage.dyads):
        if one.changes:
            where = f"{one.joint}, at {result.degrees(one.changes[0])} deg"
            raise InfeasibleError(
                f"{what} not determined at a change point of {where}",
                where=f"dyad[{number}]",
                nearest="without change points: other lengths",
            )


def _named(bond: Bond) -> str:
    """Return the name of a bond in the design: of a shaft's bearing that of the shaft."""
    return bond.name.removesuffix(center_of("")).removesuffix(way_of("")).removesuffix(".hinge")


def bond_names(structure: Structure) -> dict[Bond, str]:
    """Return the names of joints, guides and drives: with the member where a name has several."""
    names = {
        one: _named(one) if isinstance(one, Hinge | SlidingJoint) else f"{one.name}_drive"
        for one in structure.bonds
    }
    kept = [*names.values()]
    return {
        # a name that ends as columns of others do has its member behind it, too
        one: name
        if kept.count(name) == 1 and not name.endswith(("_x", "_y"))
        else f"{name}_{one.on}"
        for one, name in names.items()
    }


def joint_names(linkage: Linkage) -> dict[Bond, str]:
    """Return the names of the hinges and guides of a linkage (see `bond_names`)."""
    structure = Structure.of(linkage)
    names = bond_names(structure)
    return {one: names[one] for one in structure.joints}


def study_forces(result: MechanismResult, progress: Progress) -> StudyResult:
    """Return the study of the forces in joints (see `gearcam.linkages.reactions`).

    Parameters
    ----------
    result : MechanismResult
        The mechanism.
    progress : callable
        Called with what is computed, the number done and their total.

    Returns
    -------
    StudyResult
        Its rows are those of ``forces.csv``.

    Raises
    ------
    DesignError
        If nothing acts on it, or a bearing is none.
    InfeasibleError
        If the mechanism does not close, or a load is not finite.
    """
    progress("forces", 0, 1)
    with result.stage("forces"):
        joints = JointForces(result)
        q = _places(joints)
        found = joints.at(q)
        _demand_finite(joints, q, found)
        machine = _machine(joints, q, found)
        limits = result.design.limits
        effort = DriverEffort(peak=machine.peak[0], place=machine.peak[1], others={})
        findings = (*run_checks(CHECKS, machine, limits), *run_checks(TORQUE, effort, limits))
    return StudyResult(
        result=result,
        study=result.kind.studies["forces"],
        file="forces.csv",
        table=_columns(joints, q, found),
        group=_facts(joints, q, found, machine),
        study_findings=in_order(findings),
        drawn=partial(_charts, joints, q, found),
        joints=partial(_arrows, result),
    )


def _demand_finite(joints: JointForces, q: Array, found: Reactions) -> None:
    """Refuse forces that are not finite where nothing is locked."""
    every = np.column_stack([found.values, found.moment, found.work])
    wrong = ~np.isfinite(every).all(axis=1) & ~found.locked
    if wrong.any():
        where = joints.word(float(q[wrong][0]))
        raise InfeasibleError(f"the forces are not finite at {where}", where="load")


def _places(joints: JointForces) -> Array:
    """Return the master's angles of the table: even ones, both sides of knots, and extremes."""
    work = joints.work
    x = with_both_sides(work.linkage.even_places(joints.result.design.forces.steps), work.knots)
    known, width = joints.at(x), _NARROW * (x[-1] - x[0])

    def sought(found: Reactions) -> Array:
        contacts = joints.contacts(found).values()
        both = [sign * one for one in (found.moment, *contacts) for sign in (1.0, -1.0)]
        rows = np.stack([*joints.sizes(found).values(), *both])
        return np.where(np.isfinite(rows), rows, -np.inf)

    which, places, values = narrowing.summits(
        lambda q: sought(joints.at(q)), sought(known), *narrowing.neighbours(x), width
    )
    best = [np.flatnonzero(which == number) for number in distinct(which)]
    tops = places[[rows[np.argmax(values[rows])] for rows in best]]
    return distinct(x, tops, _switches(joints, x, known.locked, width))


def _switches(joints: JointForces, x: Array, locked: Mask, width: float) -> Array:
    """Return both sides of where friction begins and ends to lock, near angles `x`."""
    at = np.flatnonzero(locked[1:] != locked[:-1])
    if not at.size:
        return x[:0]

    def function(places: Array, rows: Ints) -> Array:
        del rows
        return joints.at(places.ravel()).locked.reshape(places.shape).astype(float)

    return np.concatenate(narrowing.changes(function, x[at], x[at + 1], width))


def _machine(joints: JointForces, q: Array, found: Reactions) -> JointedMachine:
    """Return the input of the checks."""
    largest, tipping = {}, {}
    for name, sizes in joints.sizes(found).items():
        top = int(np.nanargmax(sizes)) if np.isfinite(sizes).any() else 0
        largest[name] = (float(np.nan_to_num(sizes[top])), joints.word(float(q[top])))
    for bond, name in joints.labels.items():
        one = joints.friction.get(bond)
        if isinstance(one, GuideFriction):
            tips = one.tips(found.carried(bond))
            if tips.any():
                tipping[name] = joints.ranges(q, tips)
    slack = {
        name: joints.ranges(q, found.of(bond)[:, 0] < 0.0)
        for bond, name in joints.labels.items()
        if isinstance(bond, ChainDrive) and (found.carried(bond)[:, 0] < 0.0).any()
    }
    locked, pulled = found.locked, dict[str, tuple[float, str, bool]]()
    held = {
        one.spec.name
        for one in joints.result.drives
        if one.spec.cam is not None and len(one.result.touches) > 1
    }
    for name, force in joints.contacts(found).items():
        off = force < -_NOISE * np.nanmax(np.abs(force), initial=0.0)
        if off.any():
            pulled[name] = (float(-np.nanmin(force)), joints.ranges(q, off), name in held)
    sizes = np.abs(found.moment)
    top = int(np.nanargmax(sizes)) if np.isfinite(sizes).any() else 0
    return JointedMachine(
        peak=(_NM * float(np.nan_to_num(sizes[top])), joints.word(float(q[top]))),
        locked=joints.ranges(q, locked) if locked.any() else "",
        free=_free_share(joints, q[locked]) if locked.any() else 1.0,
        tipping=tipping,
        largest=largest,
        pulled=pulled,
        slack=slack,
    )


def _free_share(joints: JointForces, q: Array) -> float:
    """Return up to which share of all coefficients of friction nothing is locked, rounded down.

    `q` are the angles that the whole of them locks: with less of it no other one is.
    """
    low, high = 0.0, 1.0
    for _ in range(_HALVINGS):
        middle = 0.5 * (low + high)
        low, high = (low, middle) if joints.at(q, middle).locked.any() else (middle, high)
    scale = 10.0 ** (2 - math.floor(math.log10(low))) if low else 1.0
    return math.floor(low * scale) / scale


def _columns(joints: JointForces, q: Array, found: Reactions) -> dict[str, Any]:
    """Return the columns of ``forces.csv``."""
    columns: dict[str, Any] = {
        f"{joints.result.driver[0]}_deg": DEG * q,
        "driver_torque_nm": np.ma.masked_invalid(_NM * found.moment),
    }
    if joints.friction:
        columns["driver_torque_without_friction_nm"] = _NM * found.work
        columns["lost_nm"] = np.ma.masked_invalid(_NM * (found.moment - found.work))
        columns["efficiency"] = np.ma.masked_invalid(_efficiency(found))
    if joints.result.speed is not None:
        columns["power_w"] = columns["driver_torque_nm"] * joints.result.speed
    columns |= _on_wheels(joints, found)
    columns |= {f"{name}_contact_n": force for name, force in joints.contacts(found).items()}
    for bond, name in joints.labels.items():
        own = found.of(bond).T
        if isinstance(bond, Hinge | SlidingJoint):
            force = found.force(bond)
            columns[f"{name}_x_n"], columns[f"{name}_y_n"] = force.real, force.imag
            columns[f"{name}_n"] = np.abs(force)
        if isinstance(bond, SlidingJoint):
            columns[f"{name}_couple_nm"] = _NM * own[1]
        elif not isinstance(bond, Hinge):
            (unknown,), (values,) = bond.unknowns, own
            scale, unit = (1.0, "n") if unknown in FORCES else (_NM, "nm")
            columns[f"{name}_{unit}"] = scale * values
    return {name: np.ma.masked_invalid(values) for name, values in columns.items()}


def _on_wheels(joints: JointForces, found: Reactions) -> dict[str, Array]:
    """Return the moments on wheel 2 of a pair and on its driver, as the study of torque has them.

    With friction, of what its cranks carry; only of one pair that is the master.
    """
    drive = joints.result.drives[0]
    shaft, many = f"{drive.spec.name}.wheel2", len(joints.result.drives) > 1
    own = [one for one in joints.structure.bonds if getattr(one, "shaft", "") == shaft]
    if "wheel2" not in drive.moved or many or not own:
        return {}
    rate = found.known.rate(shaft)
    side = float(np.sign(rate.mean()))
    moment = side * np.sum([found.of(one)[:, 0] for one in own], axis=0)
    turned = np.abs(rate / found.known.rate(f"{drive.spec.name}.wheel1"))
    return {"wheel1_torque_nm": _NM * moment * turned, "wheel2_torque_nm": _NM * moment}


def _efficiency(found: Reactions) -> Array:
    """Return the efficiency at each place: nan where the moment changes its sense, or is locked."""
    with np.errstate(divide="ignore", invalid="ignore"):
        ratio = found.work / found.moment
        ratio = np.where(found.moment < 0.0, 1.0 / ratio, ratio)
    return np.where(ratio > 0.0, ratio, np.nan)


def _facts(joints: JointForces, q: Array, found: Reactions, machine: JointedMachine) -> Tree:
    """Return the facts of the study."""
    tree: Tree = {"torque_nm": _moment(joints, q, found)}
    if joints.friction and not found.locked.any():
        useful, driven, size = _works(joints)
        if useful > _NOISE * size:
            value = useful / driven
            tree["efficiency"] = Fact(value, "efficiency over the range", unit="", shown=True)
    tree["joints"] = {
        name: {
            "largest_n": Fact(
                machine.largest[name][0],
                f"largest force at {name}, of {bond.by} on {bond.on}",
                place=f"at {machine.largest[name][1]}",
                shown=True,
            )
        }
        for bond, name in joints.joints.items()
    }
    tree["cams"] = {
        name: {"contact_n": _contact(joints, name, q, force)}
        for name, force in joints.contacts(found).items()
        if not np.isnan(force).all()
    } or None
    tree["locked"] = bool(found.locked.any())
    tree["error"] = Fact(found.apart, "moment by reactions less that by virtual work", unit="")
    return tree | {"assumptions": Fact(_assumed(joints), "assumed", shown=True)}


def _works(joints: JointForces) -> tuple[float, float, float]:
    """Return the driver's work over the range without friction, with it, and by size, N mm."""
    cells = joints.work.cells
    places, weights = (one.ravel() for one in gauss_cells(cells[:-1], cells[1:]))
    found = joints.at(places)
    sums = (weights @ one for one in (found.work, found.moment, np.abs(found.work)))
    useful, driven, size = map(float, sums)
    return useful, driven, size


def _contact(joints: JointForces, name: str, q: Array, force: Array) -> Fact:
    most, least = int(np.nanargmax(force)), int(np.nanargmin(force))
    place = f"least at {joints.word(float(q[least]))}, largest at {joints.word(float(q[most]))}"
    label = f"normal force between the cam {name} and its follower"
    return Fact(extent(float(force[least]), float(force[most])), label, place=place, shown=True)


def _moment(joints: JointForces, q: Array, found: Reactions) -> Fact:
    values = _NM * found.moment
    if np.isnan(values).all():
        return Fact("none", "moment of the driver: friction locks it everywhere", shown=True)
    least, largest = int(np.nanargmin(values)), int(np.nanargmax(values))
    low, high = float(values[least]), float(values[largest])
    noise = _NOISE * max(abs(low), abs(high))
    label = "moment of the driver" + (", with friction" if joints.friction else "")
    place = f"least at {joints.word(float(q[least]))}, largest at {joints.word(float(q[largest]))}"
    return Fact(extent(low, high), label, place=place, shown=True, noise=noise)


def _assumed(joints: JointForces) -> str:
    """Return what is left out, in words."""
    plain = [name for one, name in joints.joints.items() if one not in joints.friction]
    words = ["no friction"] if len(plain) == len(joints.joints) else []
    if plain and not words:
        words = [f"no friction in {', '.join(plain)}"]
    parts = {one.part for one in joints.work.efforts}
    if joints.result.speed is None:
        words.append("at rest, without inertia")
    if INERTIA not in parts:
        words.append("no masses")
    if GRAVITY not in parts:
        words.append("no gravity")
    drives = joints.result.drives
    if joints.friction:
        sorts = {"teeth": "pair", "cams": "cam"}
        rubbing = [
            name for name, key in sorts.items() if any(key == one.spec.key for one in drives)
        ]
        words += [f"no friction of {' and '.join(rubbing)}"] if rubbing else []
    if any(_loaded(drive) for drive in drives):
        words.append("no loads, springs and masses of the cams' own designs")
    return ", ".join(words) or "the driver turns evenly"


def _loaded(drive: PlacedDrive) -> bool:
    """Return whether something acts on the follower of a drive in the cam's own design."""
    tables = ("load", "spring", "mass")
    design = drive.result.design if drive.spec.cam is not None else None
    return any(getattr(design, title, ()) for title in tables)


def _arrows(result: MechanismResult, scene: Scene) -> Iterator[JointForce]:
    """Yield the forces in joints and guides at the places of a scene."""
    joints = JointForces(result)
    q = np.radians(scene.places)
    q[-1] = np.nextafter(joints.work.linkage.span[1], q[0])
    found = joints.at(q)
    for bond, name in joints.joints.items():
        point = found.known.place(bond.place)
        yield JointForce(name=name, point=point, force=found.force(bond))


def _charts(joints: JointForces, q: Array, found: Reactions) -> dict[str, Chart]:
    """Return charts of the forces over the range, and hodographs."""
    x, axis = DEG * q, joints.result.axis
    lines = tuple(Line(label=name, x=x, y=values) for name, values in joints.sizes(found).items())
    charts = {
        "joints": Chart(title="Forces in joints and guides", x=axis, y="force, N", lines=lines)
    }
    if joints.friction:
        both = (
            Line(label="with friction", x=x, y=_NM * found.moment),
            Line(label="without", x=x, y=_NM * found.work),
        )
        title = "Moment of the driver"
        charts["torque_friction"] = Chart(title=title, x=axis, y="moment, N m", lines=both)
    for bond, name in joints.joints.items():
        if isinstance(bond, Hinge):
            force = found.force(bond)
            frames = {"in the machine": 1.0 + 0j} | {
                f"on {one}": found.known.direction(one)
                for one in (bond.on, bond.by)
                if one != GROUND
            }
            turned = {label: force * np.conj(way) for label, way in frames.items()}
            charts[f"hodograph_{name}"] = Chart(
                title=f"Force at {name}, of {bond.by} on {bond.on}, over its direction",
                x="along x, N",
                y="along y, N",
                equal=True,
                lines=tuple(
                    Line(label=label, x=one.real, y=one.imag) for label, one in turned.items()
                ),
            )
    return charts
