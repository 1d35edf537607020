"""The command ``fuzz``."""

from __future__ import annotations

import os
from argparse import ArgumentParser
from pathlib import Path
from typing import Final

from gearcam.console import complain, progress_bar, say, visible
from gearcam.designs.faults import unknown_word
from gearcam.draws.designs import drawn_kinds
from gearcam.errors import DesignError
from gearcam.fuzz.campaign import Campaign, Case, Catch
from gearcam.fuzz.pool import Pool
from gearcam.fuzz.trial import tried
from gearcam.numeric.arguments import whole

QUICK: Final = 40
"""Number of designs in a quick campaign."""

_COUNT: Final = 10_000
"""Number of designs in a campaign."""


def arguments(parser: ArgumentParser) -> None:
    """Add the arguments of the command to a `parser`."""
    words = f"try only {QUICK} designs"
    parser.add_argument("--quick", action="store_true", help=words)
    words = f"number of designs (default: {_COUNT})"
    parser.add_argument("--count", type=int, metavar="N", help=words)
    words = "seed of the random numbers (default: 1)"
    parser.add_argument("--seed", type=int, default=1, metavar="N", help=words)
    words = "kind of design; may be repeated (default: all)"
    parser.add_argument("--kind", action="append", metavar="KIND", help=words)
    words = "try only the design with this number, of each kind; may be repeated"
    parser.add_argument("--only", action="append", type=int, metavar="N", help=words)
    words = "number of processes (default: one for each processor)"
    parser.add_argument(
        "--jobs", dest="processes", type=int, default=os.cpu_count() or 1, metavar="N", help=words
    )


def fuzz(
    output: str,
    *,
    quick: bool,
    count: int | None,
    seed: int,
    kind: list[str] | None,
    only: list[int] | None,
    processes: int,
) -> bool:
    """Try random designs, print statistics, and write those that reveal a bug into a folder.

    Parameters
    ----------
    output : str
        The folder.
    quick : bool
        Whether to try `QUICK` designs only, if `count` is None.
    count : int or None
        Number of designs.
    seed : int
        Seed of the random numbers.
    kind : list of str or None
        Kinds of design; None: all that have random designs.
    only : list of int or None
        Numbers of the designs to try; None: all.
    processes : int
        Number of processes.

    Returns
    -------
    bool
        Whether no bug was found and few designs were refused.

    Raises
    ------
    DesignError
        If a kind is not known, or a number is less than 1.
    """
    known = drawn_kinds()
    strange = [one for one in kind or () if one not in known]
    if strange:
        raise DesignError(
            [unknown_word(one, "is not a kind of design", known, "--kind") for one in strange]
        )
    kinds = tuple(dict.fromkeys(kind or known))
    number = whole("--count", (QUICK if quick else _COUNT) if count is None else count, 1)
    cases = [
        Case(kind=one, seed=seed, index=index)
        for index in only or range(-(-number // len(kinds)))
        for one in kinds
    ][: None if only else number]
    with Pool(tried, min(whole("--jobs", processes, 1), len(cases))) as pool:
        campaign = Campaign(cases=cases, pool=pool)
        try:
            with progress_bar("fuzz") as progress:
                for found in campaign.run(progress):
                    complain(f"{found.case.name}: {found.failure.kind}: {found.failure.words}")
            _save(campaign, Path(output))
        finally:  # also after an interruption
            for line in campaign.lines():
                say(line)
    return campaign.good if only is None else not campaign.found


def _save(campaign: Campaign, folder: Path) -> None:
    """Write the designs that fail; shrink the first one of each kind of failure."""
    told: list[Catch] = []
    for found in campaign.found:
        if not any(found.failure.same(one.failure) for one in told):
            campaign.shrink(found)
            told.append(found)
        say(f"{_saved(found, folder)}: {found.failure.kind}; {found.case.command}")


def _saved(found: Catch, folder: Path) -> Path:
    """Write a failing design, headed by a comment on its failure, and return its path."""
    from gearcam.export.write import write_all

    first = next(iter(found.files))
    words = visible(" ".join(found.failure.words.split()))  # no control characters in comments
    head = f"# {found.failure.kind}: {words}\n# {found.case.command}\n"
    contents = {
        name: ((head if name == first else "") + text).encode()
        for name, text in found.files.items()
    }
    write_all(folder, lambda _: contents, keep=True)
    return folder / first
