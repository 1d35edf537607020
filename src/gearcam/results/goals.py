"""Goals of a design: facts that are to be least or largest, which must be facts that it has."""

from __future__ import annotations

from collections.abc import Mapping
from typing import Any

from gearcam.base.errors import DesignError, Problem
from gearcam.base.near_names import near_names
from gearcam.designs.faults import show


def goals_of(design: Any) -> Mapping[str, float]:
    """Return 1 of facts that are to be least, -1 of those that are to be largest, by name."""
    goal = getattr(design, "goal", None)
    return {} if goal is None else goal.signs


def demand_facts(goals: Mapping[str, float], facts: Mapping[str, float | str]) -> None:
    """Refuse goals that are no numbers among facts.

    Parameters
    ----------
    goals : mapping of str to float
        See `goals_of`.
    facts : mapping of str to float or str
        As of `gearcam.results.result.Result.record`.

    Raises
    ------
    DesignError
        With the nearest names.
    """
    numbers = [name for name, value in facts.items() if isinstance(value, int | float)]
    unknown = [name for name in goals if name not in numbers]
    if unknown:
        raise DesignError([_no_goal(name, goals[name], numbers, facts) for name in unknown])


def _no_goal(
    name: str, sign: float, numbers: list[str], facts: Mapping[str, float | str]
) -> Problem:
    """Return why a goal is not a number among facts."""
    near = near_names(name, numbers)
    message = f"{show(name)} is no fact of this design"
    if name.startswith("accuracy."):
        message, near = f"{show(name)} is an estimated error", []
    elif name in facts:
        message, near = f"{show(name)} is not a number: {show(facts[name])}", []
    allowed = "a number by its name in summary.json; those of a study with output.studies"
    allowed = f"such as {', '.join(near)}" if near else allowed
    return Problem(message, key=f"goal.{'minimize' if sign > 0 else 'maximize'}", allowed=allowed)
