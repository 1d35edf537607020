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
"""Designs of a quick campaign."""

_COUNT: Final = 10_000
"""Designs of a campaign."""


def arguments(parser: ArgumentParser) -> None:
    """Add what the command takes to a `parser`."""
    words = f"try {QUICK} designs only"
    parser.add_argument("--quick", action="store_true", help=words)
    words = f"how many designs are tried; {_COUNT} where left out"
    parser.add_argument("--count", type=int, metavar="N", help=words)
    words = "which designs: others for another seed"
    parser.add_argument("--seed", type=int, default=1, metavar="N", help=words)
    words = "designs of this kind only; several times for several"
    parser.add_argument("--kind", action="append", metavar="KIND", help=words)
    words = "only the design of this number, of each kind; several times for several"
    parser.add_argument("--only", action="append", type=int, metavar="N", help=words)
    words = "processes; as many as the machine has where left out"
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
    """Try random designs, say what comes of them, and write those that fail into a folder.

    Parameters
    ----------
    output : str
        The folder.
    quick : bool
        Whether a few do.
    count : int or None
        How many.
    seed : int
        Which.
    kind : list of str or None
        Kinds of design; all that can be drawn if None.
    only : list of int or None
        Numbers of single designs.
    processes : int
        How many try designs at once.

    Returns
    -------
    bool
        Whether nothing failed and few were refused.

    Raises
    ------
    DesignError
        If a kind is not known, or a count is none.
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
        finally:  # of a campaign that was interrupted, too
            for line in campaign.lines():
                say(line)
    return campaign.good if only is None else not campaign.found


def _save(campaign: Campaign, folder: Path) -> None:
    """Write what has failed, the first of each kind of failure made small."""
    told: list[Catch] = []
    for found in campaign.found:
        if not any(found.failure.same(one.failure) for one in told):
            campaign.shrink(found)
            told.append(found)
        say(f"{_saved(found, folder)}: {found.failure.kind}; {found.case.command}")


def _saved(found: Catch, folder: Path) -> Path:
    """Write a failing design with its story before it, and return its file."""
    from gearcam.export.write import write_all

    first = next(iter(found.files))
    words = visible(" ".join(found.failure.words.split()))  # a comment holds no other
    head = f"# {found.failure.kind}: {words}\n# {found.case.command}\n"
    contents = {
        name: ((head if name == first else "") + text).encode()
        for name, text in found.files.items()
    }
    write_all(folder, lambda _: contents, keep=True)
    return folder / first
