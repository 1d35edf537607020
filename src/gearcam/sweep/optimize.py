"""The command ``optimize``."""

from __future__ import annotations

import argparse
import time
from collections.abc import Iterator, Mapping, Sequence
from dataclasses import replace
from functools import partial
from pathlib import Path
from typing import Any, Final

import numpy as np

from gearcam.base.errors import DesignError, InfeasibleError, WriteError
from gearcam.base.facts import lined_up, text_of
from gearcam.base.numerals import formatted
from gearcam.commands import GOOD, IMPOSSIBLE, INTERRUPTED, Options, add_output, each
from gearcam.console import complain, infeasible_text, say
from gearcam.designs.design import document_of, path_of, value_at
from gearcam.designs.writing import least_document, toml_text
from gearcam.export.listing import DESIGN, aside
from gearcam.kinds.shared import METHODS
from gearcam.results.goals import demand_facts
from gearcam.sweep.axes import Varied
from gearcam.sweep.command import axes_given, engine_arguments, engine_of, told
from gearcam.sweep.log import Log
from gearcam.sweep.methods import Quest, Spent, minimized, usual
from gearcam.sweep.optimum import FRONT, Trials
from gearcam.sweep.plan import Plan
from gearcam.sweep.rows import Built, measured
from gearcam.sweep.tables import write_tables, written_whole

LOG: Final = "optimize.log"
_STEM: Final = "optimize"

_LOOKS: Final = 16
"""Variants of which one has to be made, so that facts and the price are known."""


def arguments(parser: argparse.ArgumentParser) -> None:
    """Add the arguments of the command to a `parser`."""
    add_output(parser)
    parser.add_argument("file", metavar="FILE", help="design file (TOML)")
    words = "what is varied, as of gearcam sweep; from:to is any number between"
    parser.add_argument(
        "--set", action="append", dest="settings", metavar="KEY=...", default=[], help=words
    )
    for name, what in (("minimize", "least"), ("maximize", "largest")):
        words = f"fact that is to be {what}; repeated for several goals"
        parser.add_argument(f"--{name}", action="append", metavar="FACT", help=words)
    words = f"how to search: {', '.join(METHODS)} (default: by goals and variables)"
    parser.add_argument("--method", choices=METHODS, metavar="METHOD", help=words)
    words = "largest number of variants (default: that of [goal], 200)"
    parser.add_argument("--trials", type=int, metavar="N", help=words)
    parser.add_argument("--seed", type=int, metavar="N", help="of random numbers (default: 1)")
    engine_arguments(parser)


def optimize(options: Options) -> int:
    """Quest the best variants, write them, tables and a page, and return the exit code."""
    work = partial(_optimize, options)
    return each([options["file"]], "optimized", work, debug=options["debug"])


def _optimize(options: Options, file: str) -> int:
    base, axes, _ = axes_given(options)
    given = {name: options[name] for name in ("minimize", "maximize", "method", "trials", "seed")}
    base = base.with_({f"goal.{key}": one for key, one in given.items() if one is not None})
    goal: Any = getattr(base, "goal", None)
    if goal is None or not goal.signs:
        raise DesignError.of("no goal is given", key="goal", allowed="minimize or maximize a fact")
    _demand_variety(axes)
    plan = Plan(base=base, axes=axes, sampling="random", samples=goal.trials, seed=goal.seed)
    price = _price(plan, goal.signs)
    search = Quest(plan.axes, len(goal.signs), goal.trials, goal.seed)
    method, why = (goal.method, "") if goal.method else usual(search, price)
    if method == "scipy" and search.goals > 1:
        message, allowed = '"scipy" searches for one goal', "nsga2 for several, or one goal"
        raise DesignError.of(message, key="goal.method", allowed=allowed)
    engine, folder = engine_of(options), Path(options["output"])
    stopped = False
    head = {**plan.head, "method": method, "goals": _goals(goal.signs)}
    with Log(folder, head, LOG) as log:
        more = f", {len(log)} are there" if len(log) else ""
        reason = f", since {why}" if why else ""
        say(f"{file}: {method}{reason}; {_count(goal.trials)}{more}; {engine.name}")
        start = time.perf_counter()
        with told(file, 0) as progress, engine.session(base) as build:
            trials = Trials(
                plan=plan,
                signs=goal.signs,
                warnings=goal.findings == "warning",
                most=goal.trials,
                log=log,
                build=build,
                progress=progress,
            )
            try:
                minimized(method, search, trials.evaluate)
            except Spent:
                pass
            except KeyboardInterrupt:
                stopped = True
        taken = time.perf_counter() - start
        say(f"  {_count(len(trials.rows))} in {taken:.1f} s, {len(trials.good)} may be taken")
        _, files = write_tables(log, folder, _STEM)
        if stopped and not trials.good:
            return _interrupted()
        try:
            best = trials.best()[:FRONT]
        except InfeasibleError as error:
            complain(infeasible_text(error))
            return IMPOSSIBLE
        files += _write(trials, best, folder)
    for line in lined_up(list(_table(plan, trials, best))):
        say(f"  {line}".rstrip())
    say(f"  written to {folder}: {', '.join(one.name for one in files)}")
    for name in trials.unchanged:
        complain(f"{file}: {name} is the same in all variants: what is varied does not change it")
    return _interrupted() if stopped else GOOD


def _interrupted() -> int:
    """Tell of an interruption and return the exit code."""
    complain("interrupted: the same command goes on")
    return INTERRUPTED


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


def _count(trials: int) -> str:
    return f"{trials} trial{'s' if trials != 1 else ''}"


def _goals(signs: Mapping[str, float]) -> list[str]:
    """Return goals in words."""
    return [f"{'least' if sign > 0 else 'largest'} {name}" for name, sign in signs.items()]


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


def _write(trials: Trials, best: Sequence[Built], folder: Path) -> list[Path]:
    """Write the best designs and the page; return the files.

    Raises
    ------
    WriteError
        If one cannot be written.
    """
    from gearcam.sweep.page import page

    base, files = trials.plan.base, dict[Path, bytes]()
    for number, row in enumerate(best, start=1):
        end = "best" if len(best) == 1 else f"best-{number}"
        goals = (f"{name} = {text_of(row.facts[name])}" for name in trials.signs)
        design = replace(base.with_(row.values), name=f"{base.name}_{end}"[:100])
        comments = [f"trial {row.number} of the search for the best of {base.name}", *goals]
        text = toml_text(least_document(design), comments)
        files[folder / f"{end}.toml"] = text.encode()
    lines = [
        *(f"{axis.key} = {axis.text}" for axis in trials.plan.axes),
        *_goals(trials.signs),
    ]
    files[folder / f"{_STEM}.html"] = page(base, trials.rows, lines, trials.signs)
    for path, content in files.items():
        try:
            former = aside(path, content) if path.suffix == DESIGN else None
            if former is not None:
                path.rename(former)
                say(f"  {former}: kept, what {path.name} was before")
            written_whole(path, lambda part, content=content: part.write_bytes(content))
        except OSError as error:
            raise WriteError(f"{path}: {error.strerror or error}") from error
    return list(files)


def _table(plan: Plan, trials: Trials, best: Sequence[Built]) -> Iterator[tuple[str, ...]]:
    """Yield the rows of a table: goals and values of the given design and of the best."""
    given = measured(plan.base, 0, {})
    heads = ["best"] if len(best) == 1 else [f"best-{k}" for k in range(1, len(best) + 1)]
    shown = best[:4]
    yield ("", "given", *heads[: len(shown)])
    for name in trials.signs:
        yield (name, _cell(given.facts.get(name, "")), *(_cell(one.facts[name]) for one in shown))
    document = document_of(plan.base)
    for axis in plan.axes:
        own = value_at(document, axis.key)
        yield (axis.key, _cell(own), *(_cell(one.values[axis.key]) for one in shown))
    yield ("findings", " ".join(given.findings), *(" ".join(one.findings) for one in shown))


def _cell(value: Any) -> str:
    return formatted(value, 7) if isinstance(value, float) else "" if value is None else str(value)
