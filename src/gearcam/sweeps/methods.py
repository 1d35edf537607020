"""Where an optimizer looks next: methods of kept libraries behind one interface.

A variant is a point of the unit cube: each axis maps its share to a value (`Varied.at`). A method
gets ``evaluate(points)``, which builds variants and returns their goals, which are to be least, and
how far they break what must not be broken: 0 of those that may be taken. It runs until `evaluate`
raises `Spent`. It asks for whole generations, so that what it does depends on its seed only, not
on how many processes build.

======== ==========================================================================
random   anything, without a library: a Latin hypercube
nsga2    optuna's NSGA-II: several goals (Deb et al., 2002)
tpe      optuna's tree-structured Parzen estimator: one goal with choices; dear designs
scipy    one goal: differential evolution, then a simplex (Nelder, Mead)
======== ==========================================================================

All take whole numbers and choices. scipy's methods get one number: the goal, or where something is
broken more than any goal. So they need no derivatives, which findings and refusals do not have.
Choices have their order as listed there, which may mean nothing. For one goal over whole numbers
and choices both scipy and tpe come nearer with the same trials than NSGA-II, which needs thousands.
"""

from __future__ import annotations

from collections.abc import Callable, Sequence
from typing import Any, Final, NamedTuple

import numpy as np

from gearcam.base.errors import MissingExtraError
from gearcam.numeric.arrays import Array
from gearcam.sweeps.axes import Varied
from gearcam.sweeps.plan import latin_hypercube

GENERATION: Final = 24
"""Variants that are asked for at once."""

NONE: Final = 1e12
"""Goal of variants that cannot be made."""

_EVOLVED: Final = 0.4
"""Share of the trials that differential evolution may use."""

_EVOLVED_MIXED: Final = 0.6
"""The same where some values are whole numbers or choices, for which a simplex does little."""

_SIMPLEX: Final = 0.03
"""First size of the simplex, as a share of the ranges."""

Evaluate = Callable[[Array], tuple[Array, Array]]
"""``evaluate(points)`` of (n, d) points returns goals, (n, m), and violations, (n,)."""


class Spent(Exception):  # noqa: N818
    """All trials are used."""


class Quest(NamedTuple):
    """What a method needs.

    Parameters
    ----------
    axes : sequence of d Varied
        What is varied.
    goals : int
        Number of goals.
    trials : int
        Largest number of variants.
    seed : int
        Of random numbers.
    """

    axes: Sequence[Varied]
    goals: int
    trials: int
    seed: int

    @property
    def choices(self) -> bool:
        """Whether some values have no order."""
        return not all(is_ordered(axis) for axis in self.axes)

    @property
    def mixed(self) -> bool:
        """Whether some values are whole numbers or choices."""
        return any(len(axis.values) > 1 for axis in self.axes)


def is_ordered(axis: Varied) -> bool:
    """Return whether the values of an axis are numbers."""
    return not axis.values or all(
        isinstance(one, int | float) and not isinstance(one, bool) for one in axis.values
    )


def usual(search: Quest, price: float) -> tuple[str, str]:
    """Return the method for a search, and why.

    Parameters
    ----------
    search : Quest
        What is sought.
    price : float, s
        Time of one variant.
    """
    if search.goals > 1:
        return "nsga2", "there are several goals"
    if search.trials <= _FEW and search.choices:
        return "tpe", "some values are choices"
    if search.trials <= _FEW and search.mixed and price > _DEAR:
        return "tpe", f"a variant takes {price:.2g} s"
    return "scipy", "there is one goal"


_DEAR: Final = 0.5
"""Time of a variant from which a method that thinks longer is worth it, s."""

_FEW: Final = 1000
"""Number of trials up to which its time stays small."""


def minimized(method: str, search: Quest, evaluate: Evaluate) -> None:
    """Quest until all trials are used.

    Parameters
    ----------
    method : str
        One of those above.
    search : Quest
        What is sought.
    evaluate : callable
        Builds variants; raises `Spent` after the last.

    Raises
    ------
    MissingExtraError
        If its library is not installed.
    Spent
        At the end.
    """
    _METHODS[method](method, search, evaluate)


def _random(_: str, search: Quest, evaluate: Evaluate) -> None:
    points = latin_hypercube(search.trials, len(search.axes), search.seed)
    for first in range(0, search.trials, GENERATION):
        evaluate(points[first : first + GENERATION])
    raise Spent


def _optuna(method: str, search: Quest, evaluate: Evaluate) -> None:
    try:
        import optuna
    except ImportError:
        raise MissingExtraError(f"searches by {method}", "optimize") from None
    optuna.logging.set_verbosity(optuna.logging.ERROR)
    sampler: Any = (
        optuna.samplers.NSGAIISampler(population_size=GENERATION, seed=search.seed)
        if method == "nsga2"
        else optuna.samplers.TPESampler(seed=search.seed)
    )
    directions: Any = ["minimize"] * search.goals
    study = optuna.create_study(sampler=sampler, directions=directions)
    many = GENERATION if method == "nsga2" else GENERATION // 4
    while True:
        trials = [study.ask() for _ in range(many)]
        points = np.array([[_suggested(one, axis) for axis in search.axes] for one in trials])
        for trial, goals, broken in zip(trials, *evaluate(points), strict=True):
            trial.set_constraint("broken", float(broken))
            study.tell(trial, [float(one) for one in np.minimum(goals, NONE)])


def _suggested(trial: Any, axis: Varied) -> float:
    """Return the share of a value that a trial of optuna suggests for an axis."""
    count = len(axis.values)
    if not count:
        return trial.suggest_float(axis.key, 0.0, 1.0)
    if is_ordered(axis):
        return (trial.suggest_int(axis.key, 0, count - 1) + 0.5) / count
    return (trial.suggest_categorical(axis.key, list(range(count))) + 0.5) / count


def _scipy(method: str, search: Quest, evaluate: Evaluate) -> None:
    try:
        from scipy import optimize
    except ImportError:
        raise MissingExtraError(f"searches by {method}", "optimize") from None
    library: Any = optimize  # its types are narrower than what it takes
    best, least, largest = np.full(len(search.axes), 0.5), np.inf, 0.0

    def merit(points: Array) -> Array:
        """Return one number of each point: the goal, or above all goals what is broken."""
        nonlocal best, least, largest
        goals, broken = evaluate(points)
        goal = goals[:, 0]
        largest = max(largest, *np.abs(goal[goal < NONE]), 0.0)
        found = np.where(broken > 0.0, 2.0 * largest + 1.0 + np.minimum(broken, NONE), goal)
        if found.min() < least:
            best, least = points[np.argmin(found)], float(found.min())
        return found

    several = max(GENERATION, 4 * len(best))
    evolved = (_EVOLVED_MIXED if search.mixed else _EVOLVED) * search.trials
    library.differential_evolution(
        lambda points: merit(points.T),
        [(0.0, 1.0)] * len(best),
        rng=search.seed,
        popsize=several,
        init=latin_hypercube(several, len(best), search.seed),
        maxiter=max(1, int(evolved / several) - 1),
        vectorized=True,
        updating="deferred",
        polish=False,
        tol=1e-8,
    )
    size = _SIMPLEX
    while True:
        corners = np.clip(best + size * np.vstack([np.zeros(len(best)), np.eye(len(best))]), 0, 1)
        library.minimize(
            lambda point: merit(np.clip(point, 0.0, 1.0)[None])[0],
            best,
            method="Nelder-Mead",
            options={"initial_simplex": corners, "xatol": 1e-7, "fatol": 0.0, "maxfev": 10**9},
        )
        size = -0.5 * size


_METHODS: Final[dict[str, Callable[[str, Quest, Evaluate], None]]] = {
    "random": _random,
    "nsga2": _optuna,
    "tpe": _optuna,
    "scipy": _scipy,
}

METHODS_KNOWN: Final = tuple(_METHODS)
"""Names of the methods."""
