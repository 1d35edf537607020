"""The study of a mechanism's balance: shaking force and moment, harmonics, counterweights."""

from __future__ import annotations

import cmath
from dataclasses import replace
from functools import partial
from typing import TYPE_CHECKING, Any, Final, NamedTuple

import numpy as np

from gearcam.base.errors import DesignError, Problem
from gearcam.base.facts import Fact, Tree
from gearcam.base.readable import readable
from gearcam.kinds.mechanism.asked import DEG
from gearcam.kinds.mechanism.loaded import work_of
from gearcam.kinds.mechanism.rotors import hinges_on_frame, rotor_facts, rotors_of, weight_facts
from gearcam.linkages.balance import (
    Shaking,
    counterweights,
    harmonics,
    shaking,
    with_counterweights,
)
from gearcam.linkages.efforts import InertiaForce
from gearcam.numeric import narrowing
from gearcam.numeric.arrays import distinct
from gearcam.numeric.piecewise import with_both_sides
from gearcam.pictures.charts import Chart, Line
from gearcam.results.study import StudyResult

if TYPE_CHECKING:
    from gearcam.kinds.mechanism.result import MechanismResult
    from gearcam.linkages.work import VirtualWork
    from gearcam.numeric.arrays import Array, Plane
    from gearcam.results.study import Progress

_NM: Final = 1e-3
"""N m of a N mm."""

_NARROW: Final = 1e-7
"""Width, over the range, to which an extreme is narrowed."""

_SAMPLES: Final = 1024
"""Even steps of a cycle for harmonics and counterweights."""

_NONE: Final = 1e-9
"""Share of the largest force that is none."""


def demand(design: Any) -> None:
    """Refuse a design without a mass, or without a speed.

    Parameters
    ----------
    design : MechanismDesign
        The design.

    Raises
    ------
    DesignError
        If it is so.
    """
    if design.drive[0].speed is None:
        what, key, near = "is missing: inertia depends on it", "drive[0].speed_rpm", "above 0"
    elif not design.mass and not any(one.pair or one.cam for one in design.drive):
        what, key, near = "no member has a mass", "mass", "a table [[mass]]"
    else:
        return
    raise DesignError([Problem(what, file=design.source, key=key, allowed=near)])


class Weighted(NamedTuple):
    """A mechanism with counterweights.

    Attributes
    ----------
    members : tuple of str
        The members that have them.
    unbalances : (m,) complex array, kg mm
        Mass times place in the frame of each.
    work : VirtualWork
        What acts with them.
    """

    members: tuple[str, ...]
    unbalances: Plane
    work: VirtualWork


def study_balance(result: MechanismResult, progress: Progress) -> StudyResult:
    """Return the study of the balance of a mechanism (see `gearcam.linkages.balance`).

    Parameters
    ----------
    result : MechanismResult
        The mechanism.
    progress : callable
        Called with what is computed, the number done and their total.

    Returns
    -------
    StudyResult
        Its rows are those of ``balance.csv``.

    Raises
    ------
    DesignError
        If nothing has a mass, a speed is missing, or a member cannot have a counterweight.
    """
    demand(result.design)
    progress("balance", 0, 1)
    with result.stage("balance"):
        work = work_of(result.design, result.linkage, result.drives)
        weighted = _weighted(result, work) if result.design.balance.counterweights else None
        even = work.linkage.even_places(result.design.balance.steps)
        x = with_both_sides(even, work.knots)
        if not any(isinstance(one, InertiaForce) for one in work.efforts):
            what, near = "nothing has a mass", "[[mass]], or density_kg_m3 of wheels or cams"
            raise DesignError([Problem(what, file=result.design.source, key="mass", allowed=near)])
        rotors = rotors_of(result, work, x)
        every = [work] if weighted is None else [work, weighted.work]
        q = distinct(x, *(_tops(one, x) for one in every))
        found = _shaking(work, q)
        left = None if weighted is None else _shaking(weighted.work, q)
    told = {one.spec.name: rotor_facts(one, float(work.speed or 0.0)) for one in rotors}
    return StudyResult(
        result=result,
        study=result.kind.studies["balance"],
        file="balance.csv",
        table=_columns(result, q, found, left),
        group=_facts(result, work, q, found, (weighted, left)) | ({"rotors": told} if told else {}),
        drawn=partial(_charts, result, q, found, left),
    )


def _shaking(work: VirtualWork, q: Array) -> Shaking:
    return shaking(work.linkage, work.efforts, q, float(work.speed or 0.0))


def _tops(work: VirtualWork, q: Array) -> Array:
    """Return where force and moment are largest, between angles too."""

    def rows(x: Array) -> Array:
        found = _shaking(work, x)
        return np.stack([np.abs(found.force), np.abs(found.moment)])

    width = _NARROW * (q[-1] - q[0])
    _, places, _ = narrowing.summits(rows, rows(q), *narrowing.neighbours(q), width)
    return places


def _samples(work: VirtualWork) -> Array:
    """Return even steps of a cycle, or of the range."""
    low, high = work.linkage.span
    return low + (high - low) * np.arange(_SAMPLES) / _SAMPLES


def _weighted(result: MechanismResult, work: VirtualWork) -> Weighted:
    """Return the counterweights that are asked for."""
    spec, members = result.design.balance, result.design.balance.counterweights or ()
    hinged = hinges_on_frame(result.linkage)
    source, near = result.design.source, ", ".join(hinged)
    problems = [
        Problem(
            f"{name} is no member that turns about a fixed hinge",
            file=source,
            key=f"balance.counterweights[{number}]",
            allowed=near,
        )
        for number, name in enumerate(members)
        if name not in hinged
    ]
    if problems:
        raise DesignError(problems)
    even, speed = _samples(work), float(work.speed or 0.0)
    way = None if spec.direction is None else cmath.exp(1j * spec.direction)
    force = _shaking(work, even).force
    weights = counterweights(work.linkage, members, force, even, speed, direction=way)
    none = _NONE * np.abs(force).max() / (1e-3 * speed**2)  # with which they would do nothing
    weights = np.where(np.abs(weights) > none, weights, 0.0)
    # the force that is left does not depend on the radius
    linkage, more = with_counterweights(work.linkage, members, weights, spec.radius or 1.0)
    return Weighted(
        members, weights, replace(work, linkage=linkage, efforts=[*work.efforts, *more])
    )


def _columns(
    result: MechanismResult, q: Array, found: Shaking, left: Shaking | None
) -> dict[str, Any]:
    """Return the columns of ``balance.csv``."""
    columns = {f"{result.driver[0]}_deg": DEG * q, **_force_columns("force", found.force)}
    columns["moment_nm"] = _NM * found.moment
    if left is not None:
        columns |= _force_columns("balanced", left.force)
        if result.design.balance.radius is not None:
            columns["balanced_moment_nm"] = _NM * left.moment
    return columns


def _force_columns(name: str, force: Plane) -> dict[str, Any]:
    return {f"{name}_x_n": force.real, f"{name}_y_n": force.imag, f"{name}_n": np.abs(force)}


def _largest(result: MechanismResult, q: Array, values: Any, label: str, unit: str) -> Fact:
    top = int(np.abs(values).argmax())
    place = f"at {result.place(float(q[top]))}"
    return Fact(float(np.abs(values[top])), label, place=place, unit=unit, shown=True)


def _facts(
    result: MechanismResult,
    work: VirtualWork,
    q: Array,
    found: Shaking,
    balanced: tuple[Weighted | None, Shaking | None],
) -> Tree:
    """Return the facts of the study."""
    tree: Tree = {
        "force_n": _largest(result, q, found.force, "largest shaking force", "N"),
        "moment_nm": _largest(result, q, _NM * found.moment, "largest shaking moment", "N m"),
    }
    if work.linkage.closed:
        tree["harmonics"] = _harmonic_facts(result, work)
    weighted, left = balanced
    if weighted is None or left is None:
        return tree
    tree["counterweights"] = {
        name: weight_facts(
            complex(one),
            result.design.balance.radius,
            f"counterweight of {name}",
            "in its frame",
            "its mass",
            f"the hinge of {name}",
        )
        for name, one in zip(weighted.members, weighted.unbalances.tolist(), strict=True)
    }
    none = _NONE * np.abs(found.force).max()
    force = np.where(np.abs(left.force) > none, left.force, 0.0)
    tree["balanced_n"] = _largest(result, q, force, "shaking force left with them", "N")
    if result.design.balance.radius is not None:
        radius = readable(result.design.balance.radius, "mm")
        label = f"shaking moment with them, as points at {radius}"
        tree["balanced_moment_nm"] = _largest(result, q, _NM * left.moment, label, "N m")
    return tree


def _harmonic_facts(result: MechanismResult, work: VirtualWork) -> list[Tree]:
    """Return the amplitudes of the harmonics of the cycle: their cosines and sines."""
    force = _shaking(work, _samples(work)).force
    every = [harmonics(part, result.design.balance.harmonics) for part in (force.real, force.imag)]
    return [
        {
            "order": order,
            **{
                f"force_{axis}_{wave}_n": float(every[k][order, number])
                for k, axis in enumerate("xy")
                for number, wave in enumerate(("cos", "sin"))
            },
        }
        for order in range(1, result.design.balance.harmonics + 1)
    ]


def _charts(
    result: MechanismResult, q: Array, found: Shaking, left: Shaking | None
) -> dict[str, Chart]:
    """Return the shaking force over its direction, and force and moment over the range."""
    x, axis, every = DEG * q, result.axis, {"as designed": found}
    if left is not None:
        every["with counterweights"] = left
    timed = result.design.balance.radius is not None
    return {
        "shaking": Chart(
            title="Shaking force over its direction",
            x="along x, N",
            y="along y, N",
            equal=True,
            lines=tuple(
                Line(label=name, x=one.force.real, y=one.force.imag) for name, one in every.items()
            ),
        ),
        "shaking_force": Chart(
            title="Shaking force",
            x=axis,
            y="force, N",
            lines=tuple(Line(label=name, x=x, y=np.abs(one.force)) for name, one in every.items()),
        ),
        "shaking_moment": Chart(
            title="Shaking moment about the machine's origin",
            x=axis,
            y="moment, N m",
            lines=tuple(
                Line(label=name, x=x, y=_NM * one.moment)
                for name, one in every.items()
                if one is found or timed
            ),
        ),
    }
