"""The command ``optimize``."""

from __future__ import annotations

import argparse
import time
from collections.abc import Iterator, Sequence
from functools import partial
from pathlib import Path
from typing import Any

from gearcam.base.errors import InfeasibleError
from gearcam.base.facts import lined_up
from gearcam.base.numerals import formatted
from gearcam.commands import GOOD, IMPOSSIBLE, INTERRUPTED, Options, add_output, each
from gearcam.console import complain, infeasible_text, say
from gearcam.designs.design import own_document, value_at
from gearcam.kinds.shared import METHODS
from gearcam.sweeps.command import asked_by, engine_arguments, engine_given, told
from gearcam.sweeps.rows import Built, measured
from gearcam.sweeps.search import Optimum, goals_for


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
    """Search for the best variants, write them, tables and a page, and return the exit code."""
    work = partial(_optimize, options)
    return each([options["file"]], "optimized", work, debug=options["debug"])


def _optimize(options: Options, file: str) -> int:
    names = ("minimize", "maximize", "method", "trials", "seed")
    what = goals_for(asked_by(options), {name: options[name] for name in names})
    with Optimum(what, engine_given(options), options["output"]) as search:
        more = f", {search.there} are there" if search.there else ""
        reason = f", since {search.why}" if search.why else ""
        count = _count(search.goal.trials)
        say(f"{file}: {search.method}{reason}; {count}{more}; {search.engine.name}")
        start, stopped = time.perf_counter(), False
        with told(file, 0) as progress:
            try:
                search.run(progress)
            except KeyboardInterrupt:
                stopped = True
        taken, good = time.perf_counter() - start, len(search.trials.good)
        say(f"  {_count(len(search.rows))} in {taken:.1f} s, {good} may be taken")
        try:
            files, best = search.write(kept=_say_kept), search.best
        except InfeasibleError as error:
            if stopped:
                return _interrupted()
            complain(infeasible_text(error))
            return IMPOSSIBLE
    for line in lined_up(list(_table(search, best))):
        say(f"  {line}".rstrip())
    say(f"  written to {search.folder}: {', '.join(one.name for one in files)}")
    for name in search.trials.unchanged:
        complain(f"{file}: {name} is the same in all variants: what is varied does not change it")
    return _interrupted() if stopped else GOOD


def _say_kept(path: Path, former: Path) -> None:
    say(f"  {former}: kept, what {path.name} was before")


def _interrupted() -> int:
    """Tell of an interruption and return the exit code."""
    complain("interrupted: the same command goes on")
    return INTERRUPTED


def _count(trials: int) -> str:
    return f"{trials} trial{'s' if trials != 1 else ''}"


def _table(search: Optimum, best: Sequence[Built]) -> Iterator[tuple[str, ...]]:
    """Yield the rows of a table: goals and values of the given design and of the best."""
    plan = search.plan
    given = measured(plan.base, 0, {})
    heads = ["best"] if len(best) == 1 else [f"best-{k}" for k in range(1, len(best) + 1)]
    shown = best[:4]
    yield ("", "given", *heads[: len(shown)])
    for name in search.goal.signs:
        yield (name, _cell(given.facts.get(name, "")), *(_cell(one.facts[name]) for one in shown))
    document = own_document(plan.base)
    for axis in plan.axes:
        own = value_at(document, axis.key)
        yield (axis.key, _cell(own), *(_cell(one.values[axis.key]) for one in shown))
    yield ("findings", " ".join(given.findings), *(" ".join(one.findings) for one in shown))


def _cell(value: Any) -> str:
    return formatted(value, 7) if isinstance(value, float) else "" if value is None else str(value)
