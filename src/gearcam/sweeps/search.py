"""The best of a family from Python: ``gearcam.optimize``, of which the command is a caller.

    import gearcam as gc

    found = gc.optimize(
        "profiles/ellipse.toml", {"law.eccentricity": "0.1:0.5"}, minimize="pair.ratio.max", jobs=2
    )
    found.best[0].values, found.designs[0], found.columns["pair.ratio.max"]

Inputs: as of `gearcam.sweeps.sweep`, where ``"from:to"`` is any number between; goals, which are
facts by their names; a method, the largest number of trials and a seed. What is not given is that
of the design's table ``[goal]``.

Outputs: the best variants (of one goal one; of several those that no other one surpasses in all of
them), their designs, a row for each trial, columns; the files that the command writes.

With a folder each trial is written to its ``optimize.log``: the same search goes on from there.

Refused before anything is built, but for the one variant that shows which facts there are: goals
that are no facts, keys with one value only, goals that are varied, methods that do not fit.
"""

from __future__ import annotations

import os
import weakref
from collections.abc import Callable, Mapping, Sequence
from contextlib import AbstractContextManager, suppress
from dataclasses import replace
from pathlib import Path
from typing import Any, Final, Self

import numpy as np

from gearcam.base.display import cut
from gearcam.base.errors import DesignError, WriteError
from gearcam.base.facts import text_of
from gearcam.base.processes import end_if_unguarded
from gearcam.designs.design import Design, path_of
from gearcam.designs.writing import least_document, toml_text
from gearcam.export.listing import DESIGN, aside
from gearcam.numeric.columns import Columns
from gearcam.results.goals import demand_facts
from gearcam.sweeps.asked import GIGABYTES, LIMIT, Asked, asked, engine_of
from gearcam.sweeps.axes import Varied
from gearcam.sweeps.engine import Engine
from gearcam.sweeps.kept import Kept, RowStore
from gearcam.sweeps.log import Log
from gearcam.sweeps.methods import Quest, Spent, minimized, usual
from gearcam.sweeps.optimum import FRONT, Trials
from gearcam.sweeps.plan import Plan
from gearcam.sweeps.rows import Built, measured
from gearcam.sweeps.sweep import Progress
from gearcam.sweeps.tables import columns_of, made_folder, write_tables, written_whole

LOG: Final = "optimize.log"
_STEM: Final = "optimize"

_LOOKS: Final = 16
"""Variants of which one has to be made, so that facts and the price are known."""


def goals_for(what: Asked, given: Mapping[str, Any]) -> Asked:
    """Return what is asked for, with goals and settings in the place of those of the design.

    Parameters
    ----------
    what : Asked
        The design, and what is varied.
    given : mapping of str to value
        Keys of the table ``[goal]``; None where not given.

    Raises
    ------
    DesignError
        If there is no goal, or a value is not allowed.
    """
    settings = {f"goal.{key}": one for key, one in given.items() if one is not None}
    base = what.base.with_(settings)
    goal: Any = getattr(base, "goal", None)
    if goal is None or not goal.signs:
        raise DesignError.of("no goal is given", key="goal", allowed="minimize or maximize a fact")
    _demand_variety(what.axes)
    return replace(what, base=base)


class Optimum(AbstractContextManager["Optimum"]):
    """A search for the best variants of a design.

    Parameters
    ----------
    what : Asked
        What is varied, of a design with goals (see `goals_for`).
    engine : Engine
        What builds variants.
    folder : path, optional
        Folder of the log; without one trials are kept in memory.

    Raises
    ------
    DesignError
        If a goal is no fact, the method does not fit, or the folder has the log of another search.
    WriteError
        If the log cannot be written.

    Examples
    --------
    >>> import gearcam as gc
    >>> keys = {"pair.face_width_mm": [8, 10, 12]}
    >>> goal = {"minimize": "gears.0.size_mm.2", "method": "random", "trials": 6}
    >>> found = gc.optimize(gc.load("profiles/ellipse.toml"), keys, **goal, jobs=1)
    >>> found.best[0].values
    {'pair.face_width_mm': 8}
    """

    def __init__(
        self, what: Asked, engine: Engine, folder: str | os.PathLike[str] | None = None
    ) -> None:
        goal: Any = getattr(what.base, "goal", None)
        self.goal, self.engine = goal, engine
        self.plan = Plan(
            base=what.base,
            axes=what.axes,
            sampling="random",
            samples=goal.trials,
            seed=goal.seed,
        )
        price = _price(self.plan, goal.signs)
        self._quest = Quest(self.plan.axes, len(goal.signs), goal.trials, goal.seed)
        self.method, self.why = (goal.method, "") if goal.method else usual(self._quest, price)
        if self.method == "scipy" and self._quest.goals > 1:
            message, allowed = '"scipy" searches for one goal', "nsga2 for several, or one goal"
            raise DesignError.of(message, key="goal.method", allowed=allowed)
        head = {**self.plan.head, "method": self.method, "goals": _goals(goal.signs)}
        self.folder = None if folder is None else Path(folder)
        self._there: RowStore = Kept() if folder is None else Log(folder, head, LOG)
        weakref.finalize(self, self._there.close)
        self.trials = self._new(None, None)

    def __repr__(self) -> str:
        goals = ", ".join(_goals(self.goal.signs))
        return cut(f'<Optimum of "{self.plan.base.name}": {len(self.rows)} trials; {goals}>')

    def __exit__(self, *_: object) -> None:
        self.close()

    def close(self) -> None:
        """Close the log: the search is not run any more."""
        self._there.close()

    def _new(self, build: Any, progress: Progress | None) -> Trials:
        return Trials(
            plan=self.plan,
            signs=self.goal.signs,
            warnings=self.goal.findings == "warning",
            most=self.goal.trials,
            log=self._there,
            build=build,
            progress=progress,
        )

    def run(self, progress: Progress | None = None) -> Self:
        """Search until all trials are used, from the beginning; known trials are not built again.

        Parameters
        ----------
        progress : callable, optional
            Called with the number of trials so far and their largest number.

        Returns
        -------
        Optimum
            This one.

        Raises
        ------
        MissingExtraError
            If the library of the method is not installed.
        """
        with self.engine.session(self.plan.base) as build:
            self.trials = self._new(build, progress)
            with suppress(Spent):
                minimized(self.method, self._quest, self.trials.evaluate)
        return self

    @property
    def there(self) -> int:
        """Number of trials that are there."""
        return len(self._there)

    @property
    def rows(self) -> list[Built]:
        """The trials so far, in the order in which they were asked for."""
        return self.trials.rows

    @property
    def best(self) -> list[Built]:
        """The best trials, twenty at most: of one goal one.

        Raises
        ------
        InfeasibleError
            If none may be taken: each is refused or has errors.
        """
        return self.trials.best()[:FRONT]

    @property
    def designs(self) -> list[Design]:
        """The designs of the best trials, named after them."""
        base, best = self.plan.base, self.best
        return [
            replace(base.with_(row.values), name=f"{base.name}_{end}"[:100])
            for row, end in zip(best, _ends(best), strict=True)
        ]

    @property
    def columns(self) -> Columns:
        """Arrays (n,) by name with a value for each trial (see `Sweep.columns`)."""
        return columns_of(self._there)

    def write(
        self,
        folder: str | os.PathLike[str] | None = None,
        kept: Callable[[Path, Path], Any] | None = None,
    ) -> list[Path]:
        """Write ``optimize.csv``, with pyarrow Parquet, the best designs, ``optimize.html``.

        Parameters
        ----------
        folder : path, optional
            Where; the folder of the log by default.
        kept : callable, optional
            ``kept(file, former)`` is called for a design file that was changed by hand and is kept
            under another name.

        Returns
        -------
        list of path
            The files.

        Raises
        ------
        DesignError
            If there is no folder.
        InfeasibleError
            If no trial may be taken; the tables are written then.
        WriteError
            If a file cannot be written.
        """
        place = made_folder(self.folder if folder is None else folder)
        _, files = write_tables(self._there, place, _STEM)
        for path, content in self._contents(place).items():
            try:
                former = aside(path, content) if path.suffix == DESIGN else None
                if former is not None:
                    path.rename(former)
                    if kept is not None:
                        kept(path, former)
                written_whole(path, lambda part, content=content: part.write_bytes(content))
            except OSError as error:
                raise WriteError(f"{path}: {error.strerror or error}") from error
            files.append(path)
        return files

    def _contents(self, folder: Path) -> dict[Path, bytes]:
        """Return the best designs and the page, by their files."""
        from gearcam.sweeps.page import page

        files: dict[Path, bytes] = {}
        best = self.best
        for row, design, end in zip(best, self.designs, _ends(best), strict=True):
            goals = (f"{name} = {text_of(row.facts[name])}" for name in self.goal.signs)
            comments = [
                f"trial {row.number} of the search for the best of {self.plan.base.name}",
                *goals,
            ]
            text = toml_text(least_document(design), comments)
            files[folder / f"{end}.toml"] = text.encode()
        lines = [
            *(f"{axis.key} = {axis.text}" for axis in self.plan.axes),
            *_goals(self.goal.signs),
        ]
        files[folder / f"{_STEM}.html"] = page(self.plan.base, self.rows, lines, self.goal.signs)
        return files


def optimize(
    design: Design | str | os.PathLike[str],
    keys: Mapping[str, Any] | None = None,
    *,
    minimize: str | Sequence[str] | None = None,
    maximize: str | Sequence[str] | None = None,
    findings: str | None = None,
    method: str | None = None,
    trials: int | None = None,
    seed: int | None = None,
    jobs: int | None = None,
    client: Any = None,
    limit: float = LIMIT,
    memory: float = GIGABYTES,
    folder: str | os.PathLike[str] | None = None,
    progress: Progress | None = None,
) -> Optimum:
    """Search the best variants of a design, as the command ``gearcam optimize`` does.

    In a script it has to stand under ``if __name__ == "__main__":``, since other processes read the
    script.

    Parameters
    ----------
    design : Design or path
        A design, or a design file, whose tables ``[sweep]`` and ``[goal]`` count too.
    keys : mapping of str to value, optional
        What is varied, as of `sweep`; ``"from:to"`` is any number between.
    minimize, maximize : str or sequence of str, optional
        Facts that are to be least, and those that are to be largest.
    findings : {"error", "warning"}, optional
        What the best must not have: errors, or warnings either.
    method : {"scipy", "nsga2", "tpe", "random"}, optional
        How to search; by goals and keys by default. All but the last need ``gearcam[optimize]``.
    trials : int, optional
        Largest number of variants; 200 by default.
    seed : int, optional
        Of random numbers; 1 by default.
    jobs, client, limit, memory, progress
        As of `sweep`.
    folder : path, optional
        Folder of the log ``optimize.log``, from which the same search goes on.

    Returns
    -------
    Optimum
        With the `best` rows, their `designs`, and `columns` of all trials.

    Raises
    ------
    DesignError
        If a goal is no fact of the design, or an argument is not allowed.
    MissingExtraError
        If the library of the method is not installed.
    WriteError
        If the log cannot be written.

    Examples
    --------
    >>> import gearcam as gc
    >>> keys = {"law.eccentricity": [0.3, 0.4, 0.2]}
    >>> goal = {"minimize": "pair.ratio.max", "method": "random", "trials": 6}
    >>> found = gc.optimize("profiles/ellipse.toml", keys, **goal, jobs=1)
    >>> [row.values["law.eccentricity"] for row in found.best]
    [0.2]
    """
    end_if_unguarded()
    given: dict[str, Any] = {"findings": findings, "method": method, "trials": trials, "seed": seed}
    for name, facts in (("minimize", minimize), ("maximize", maximize)):
        given[name] = [*facts] if isinstance(facts, tuple) else facts
    what = goals_for(asked(design, keys), given)
    engine = engine_of(jobs=jobs, client=client, limit=limit, memory=memory)
    return Optimum(what, engine, folder).run(progress)


def _ends(best: Sequence[Built]) -> list[str]:
    """Return the names of the best."""
    return ["best"] if len(best) == 1 else [f"best-{k}" for k in range(1, len(best) + 1)]


def _goals(signs: Mapping[str, float]) -> list[str]:
    """Return goals in words."""
    return [f"{'least' if sign > 0 else 'largest'} {name}" for name, sign in signs.items()]


def _demand_variety(axes: Sequence[Varied]) -> None:
    """Refuse a search in which nothing differs, or in which keys of the search itself do.

    Raises
    ------
    DesignError
        With what may be varied.
    """
    own = [axis.key for axis in axes if path_of(axis.key)[0] == "goal"]
    if own:
        raise DesignError.of("a goal is not varied", key=own[0], allowed="other keys of the design")
    if all(len(axis.values) == 1 for axis in axes):
        message = f"{axes[0].key} has one value" if len(axes) == 1 else "each key has one value"
        raise DesignError.of(message, allowed="several values, or a range from:to")


def _price(plan: Plan, signs: dict[str, float]) -> float:
    """Return the time of a variant, s, and refuse goals that are no facts.

    Raises
    ------
    DesignError
        If a goal is no fact.
    """
    random = np.random.default_rng(plan.seed)
    points = np.vstack([np.full((1, len(plan.axes)), 0.5), random.random((_LOOKS, len(plan.axes)))])
    for point in points:
        values = plan.at(point)
        row = measured(plan.base, 0, values)
        if row.made:
            demand_facts(signs, row.facts)
            return measured(plan.base, 0, values).time_s
    return 0.0
