"""The command ``sweep``."""

from __future__ import annotations

import argparse
import time
from collections.abc import Callable, Iterator
from contextlib import contextmanager
from typing import Final

from gearcam.base.errors import DesignError
from gearcam.base.numerals import formatted
from gearcam.commands import GOOD, IMPOSSIBLE, INTERRUPTED, Options, add_output, each
from gearcam.console import complain, progress_bar, say
from gearcam.sweeps.asked import GIGABYTES, LIMIT, Asked, asked, engine_of
from gearcam.sweeps.axes import FORM, settings_of
from gearcam.sweeps.engine import Engine
from gearcam.sweeps.plan import MANY
from gearcam.sweeps.sweep import Sweep


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
    words = f"largest time of a variant (default: {LIMIT:g})"
    parser.add_argument("--limit", type=float, metavar="S", default=LIMIT, help=words)
    words = f"largest memory of a process (default: {GIGABYTES:g})"
    parser.add_argument("--memory", type=float, metavar="GB", default=GIGABYTES, help=words)


def engine_given(options: Options) -> Engine:
    """Return the engine that the options of a command choose.

    Raises
    ------
    DesignError
        If an option has a value that is not allowed, or nothing answers at the address.
    """
    names = ("jobs", "scheduler", "limit", "memory")
    return engine_of(**{name: options[name] for name in names}, prefix="--")


def sweep(options: Options) -> int:
    """Build all variants that are missing, write tables and page, and return the exit code."""
    return each([options["file"]], "swept", lambda _: _sweep(options), debug=options["debug"])


def _sweep(options: Options) -> int:
    file = options["file"]
    plan = asked_by(options).plan({name: options[name] for name in ("random", "latin", "seed")})
    if plan.count > MANY and not options["yes"]:
        message = f"the sweep has {plan.count} variants"
        raise DesignError.of(message, allowed=f"at most {MANY}, or --yes")
    with Sweep(plan, engine_given(options), options["output"]) as made:
        there, start, stopped = made.done, time.perf_counter(), False
        more = f", {there} are there" if there else ""
        say(f"{file}: {plan.count} variants{more}; {made.engine.name}")
        with told(file, there) as progress:
            try:
                for _ in made.missing():
                    progress(made.done, plan.count)
            except KeyboardInterrupt:
                stopped = True
        taken = time.perf_counter() - start
        files, tally = made.write(), made.tally
    built = tally.rows - there
    rate = f" in {taken:.1f} s, {formatted(built / taken, 3)} a second" if built else ""
    say(f"  {built} built{rate}; {tally.words}")
    say(f"  written to {made.folder}: {', '.join(one.name for one in files)}")
    if stopped:
        complain(f"interrupted: {tally.rows} of {plan.count} are there; the same command goes on")
        return INTERRUPTED
    return IMPOSSIBLE if tally.refused == tally.rows else GOOD


def asked_by(options: Options) -> Asked:
    """Return what the settings of a command, and the table ``[sweep]`` of its file, ask for.

    Raises
    ------
    DesignError
        If nothing is to be varied, or what is given cannot be read.
    """
    return asked(options["file"], settings_of(options["settings"]), "--set")


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
