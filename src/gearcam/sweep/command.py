"""The command ``sweep``."""

from __future__ import annotations

import argparse
import time
from collections.abc import Callable, Iterator
from contextlib import contextmanager
from pathlib import Path
from typing import Any, Final

from gearcam.base.errors import DesignError
from gearcam.base.numerals import formatted
from gearcam.commands import GOOD, IMPOSSIBLE, INTERRUPTED, Options, add_output, each
from gearcam.console import complain, progress_bar, say
from gearcam.designs.design import Design, load
from gearcam.designs.sweep_tables import family_of
from gearcam.sweep.axes import FORM, Varied, axes_of, settings_of
from gearcam.sweep.engine import MEMORY, SECONDS, Engine, run
from gearcam.sweep.log import Log
from gearcam.sweep.plan import MANY, Plan, flattened
from gearcam.sweep.pool import Processes, default_jobs
from gearcam.sweep.tables import Tally, write_tables, written_whole

_TITLE: Final = "sweep"
_SETTINGS: Final = ("random", "latin", "seed")
"""Keys of ``[sweep]`` that are not keys of the design."""


def arguments(parser: argparse.ArgumentParser) -> None:
    """Add the arguments of the command to a `parser`."""
    add_output(parser)
    parser.add_argument("file", metavar="FILE", help="design file (TOML)")
    words = f"what a key gets: {FORM}; repeated, all combinations"
    parser.add_argument(
        "--set", action="append", dest="settings", metavar="KEY=...", default=[], help=words
    )
    words = "draw N random samples instead of all combinations"
    parser.add_argument("--random", type=int, metavar="N", help=words)
    words = "draw N samples of a Latin hypercube"
    parser.add_argument("--latin", type=int, metavar="N", help=words)
    parser.add_argument("--seed", type=int, metavar="N", help="seed of samples (default: 1)")
    engine_arguments(parser)
    words = f"sweep more than {MANY} variants"
    parser.add_argument("--yes", action="store_true", help=words)


def engine_arguments(parser: argparse.ArgumentParser) -> None:
    """Add the arguments that choose an engine to a `parser`."""
    words = "number of processes (default: all cores)"
    parser.add_argument("--jobs", type=int, metavar="N", help=words)
    words = "use the workers of a dask scheduler at this address, such as tcp://host:8786"
    parser.add_argument("--scheduler", metavar="ADDRESS", help=words)
    words = f"largest time of a variant (default: {SECONDS:g})"
    parser.add_argument("--limit", type=float, metavar="S", default=SECONDS, help=words)
    words = f"largest memory of a process (default: {MEMORY / 2**30:g})"
    parser.add_argument("--memory", type=float, metavar="GB", default=MEMORY / 2**30, help=words)


def engine_of(options: Options) -> Engine:
    """Return the engine that the options of a command choose.

    Raises
    ------
    DesignError
        If an option has a value that is not allowed, or nothing answers at the address.
    """
    for name in ("jobs", "limit", "memory"):
        value = options[name]
        if value is not None and not value > 0:
            raise DesignError.of("is not above 0", key=f"--{name}", value=value, allowed="above 0")
    seconds, memory = options["limit"], int(options["memory"] * 2**30)
    if options["scheduler"]:
        from gearcam.sweep.cluster import Cluster

        return Cluster(address=options["scheduler"], seconds=seconds, memory=memory)
    return Processes(jobs=options["jobs"] or default_jobs(), seconds=seconds, memory=memory)


def sweep(options: Options) -> int:
    """Build all variants that are missing, write tables and page, and return the exit code."""
    return each([options["file"]], "swept", lambda _: _sweep(options), debug=options["debug"])


def _sweep(options: Options) -> int:
    plan = plan_of(options)
    if plan.count > MANY and not options["yes"]:
        message = f"the sweep has {plan.count} variants"
        raise DesignError.of(message, allowed=f"at most {MANY}, or --yes")
    engine, folder = engine_of(options), Path(options["output"])
    stopped = False
    with Log(folder, plan.head) as log:
        there = len(log)
        more = f", {there} are there" if there else ""
        say(f"{options['file']}: {plan.count} variants{more}; {engine.name}")
        start = time.perf_counter()
        with told(options["file"], there) as progress:
            try:
                run(plan, log, engine, progress)
            except KeyboardInterrupt:
                stopped = True
        taken = time.perf_counter() - start
        tally, files = write_tables(log, folder)
        files += _page(plan, log, folder, tally)
    built = tally.rows - there
    rate = f" in {taken:.1f} s, {formatted(built / taken, 3)} a second" if built else ""
    say(f"  {built} built{rate}; {_counts(tally)}")
    say(f"  written to {folder}: {', '.join(one.name for one in files)}")
    if stopped:
        complain(f"interrupted: {tally.rows} of {plan.count} are there; the same command goes on")
        return INTERRUPTED
    return IMPOSSIBLE if tally.refused == tally.rows else GOOD


def _counts(tally: Tally) -> str:
    words = f"{tally.refused} refused, {tally.wrong} with errors"
    return f"{words}, {tally.faults} by faults of gearcam" if tally.faults else words


def _page(plan: Plan, log: Log, folder: Path, tally: Tally) -> list[Path]:
    """Write the page of the rows that are there; return its file, none of too many rows.

    Raises
    ------
    WriteError
        If it cannot be written.
    """
    if not tally.rows or tally.rows > _DRAWN:
        return []
    from gearcam.sweep.page import PAGE, page

    how = "all combinations" if plan.sampling == "grid" else f"{plan.sampling} samples"
    lines = [
        *(f"{axis.key} = {axis.text}" for axis in plan.axes),
        f"{how}; {tally.rows} of {plan.count} built; {_counts(tally)}",
    ]
    content = page(plan.base, log.rows(), lines)
    written_whole(folder / PAGE, lambda path: path.write_bytes(content))
    return [folder / PAGE]


def plan_of(options: Options) -> Plan:
    """Return the plan of the command's options and the table ``[sweep]`` of its file.

    Raises
    ------
    DesignError
        If nothing is to be varied, or what is given cannot be read.
    """
    base, axes, given = axes_given(options)
    given |= {name: options[name] for name in _SETTINGS if options[name] is not None}
    for name in ("random", "latin"):
        if given[name] is not None and not (isinstance(given[name], int) and given[name] > 0):
            raise DesignError.of(
                "is not a number of samples", key=name, value=given[name], allowed="1 or more"
            )
    if given["random"] and given["latin"]:
        raise DesignError.of("random and latin are both given", allowed="one of them")
    sampling: Any = next((name for name in ("random", "latin") if given[name]), "grid")
    seed = 1 if given["seed"] is None else given["seed"]
    return Plan(
        base=base,
        axes=axes,
        sampling=sampling,
        samples=given[sampling] if sampling != "grid" else 0,
        seed=seed,
    )


def axes_given(options: Options) -> tuple[Design, tuple[Varied, ...], dict[str, Any]]:
    """Return the design of a command's file, what is varied, and the other keys of ``[sweep]``.

    Parameters
    ----------
    options : mapping
        With ``file`` and ``settings``, which come before those of the file.

    Raises
    ------
    DesignError
        If nothing is to be varied, or what is given cannot be read.
    """
    file = options["file"]
    base, table = load(file), dict(family_of(file).get(_TITLE, {}))
    given = {name: table.pop(name, None) for name in _SETTINGS}
    axes = {one.key: one for one in axes_of(flattened(table), _TITLE)}
    axes |= {one.key: one for one in axes_of(settings_of(options["settings"]))}
    if not axes:
        raise DesignError.of("nothing is to be varied", allowed="--set KEY=..., or a table [sweep]")
    return base, tuple(axes.values()), given


_DRAWN: Final = 100_000
"""Largest number of variants that a page shows."""

_EVERY: Final = 10.0
"""Seconds between lines of progress where there is no terminal."""


@contextmanager
def told(file: str, there: int) -> Iterator[Callable[[int, int], None]]:
    """Yield a callback that shows progress, with the rate and the time left.

    Parameters
    ----------
    file : str
        Name of the design file.
    there : int
        Number of rows that were there before.
    """
    start = last = time.perf_counter()
    with progress_bar(file) as bar:

        def show(done: int, total: int) -> None:
            nonlocal last
            now = time.perf_counter()
            rate = (done - there) / max(now - start, 1e-9)
            words = f"{formatted(rate, 3)} a second, {_clock((total - done) / rate)} left"
            if bar is not None:
                bar(words, done, total)
            elif now - last > _EVERY:
                last = now
                complain(f"  {done} of {total}, {words}")

        yield show


def _clock(seconds: float) -> str:
    minutes, rest = divmod(round(seconds), 60)
    hours, minutes = divmod(minutes, 60)
    return (
        f"{hours} h {minutes} min"
        if hours
        else f"{minutes} min {rest} s"
        if minutes
        else f"{rest} s"
    )
