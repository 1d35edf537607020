"""The command of the fuzzer: ``python -m fuzz``."""

from __future__ import annotations

import os
from argparse import ArgumentParser, ArgumentTypeError
from collections.abc import Sequence
from datetime import UTC, datetime
from pathlib import Path
from typing import Final

from commit import commit
from fuzz.campaign import Campaign, Case, Catch
from fuzz.pool import Pool
from fuzz.score import BEGIN, END, Score, lacks_marks, publish
from fuzz.trial import tried
from gearcam.console import complain, progress_bar, say, visible
from gearcam.version import __version__
from random_designs.designs import MAKERS

QUICK: Final = 40
"""Number of designs in a quick campaign."""

_COUNT: Final = 10_000
"""Number of designs in a campaign."""


def main(words: Sequence[str] | None = None) -> int:
    """Try random designs, print statistics, and save those that reveal a bug.

    Parameters
    ----------
    words : sequence of str, optional
        Arguments; those of the process if left out.

    Returns
    -------
    int
        1 if a bug was found or too many designs were refused, else 0.
    """
    given = _parser().parse_args(words)
    kinds = tuple(dict.fromkeys(given.kind or MAKERS))
    number = given.count or (QUICK if given.quick else _COUNT)
    cases = [
        Case(kind=one, seed=given.seed, index=index)
        for index in given.only or range(-(-number // len(kinds)))
        for one in kinds
    ][: None if given.only else number]
    with Pool(tried, min(given.jobs, len(cases))) as pool:
        campaign = Campaign(cases=cases, pool=pool)
        try:
            with progress_bar("fuzz") as progress:
                for found in campaign.run(progress):
                    complain(f"{found.case.name}: {found.failure.kind}: {found.failure.words}")
            if given.score:
                _publish(campaign, given.score, partial=bool(given.quick or given.only))
            _save(campaign, Path(given.output))
        finally:  # also after an interruption
            for line in campaign.lines():
                say(line)
    return int(bool(campaign.found) if given.only else not campaign.good)


def _parser() -> ArgumentParser:
    parser = ArgumentParser(prog="python -m fuzz", description="Test gearcam with random designs.")
    words = f"try only {QUICK} designs"
    parser.add_argument("--quick", action="store_true", help=words)
    words = f"number of designs (default: {_COUNT})"
    parser.add_argument("--count", type=_positive, metavar="N", help=words)
    words = "seed of the random numbers (default: 1)"
    parser.add_argument("--seed", type=int, default=1, metavar="N", help=words)
    words = "kind of design; may be repeated (default: all)"
    parser.add_argument("--kind", action="append", choices=[*MAKERS], help=words)
    words = "try only the design with this number, of each kind; may be repeated"
    parser.add_argument("--only", action="append", type=int, metavar="N", help=words)
    words = "number of processes (default: one for each processor)"
    parser.add_argument(
        "--jobs", type=_positive, default=os.cpu_count() or 1, metavar="N", help=words
    )
    words = "page that the score is written to, if designs of all kinds are tried, without --quick"
    parser.add_argument("--score", type=_page, metavar="PAGE", help=words)
    words = "where designs that reveal a bug are saved (default: output/fuzz)"
    parser.add_argument("-o", "--output", default="output/fuzz", metavar="DIR", help=words)
    return parser


def _positive(word: str) -> int:
    """Return a whole number above 0."""
    number = int(word)
    if number < 1:
        raise ValueError(word)
    return number


def _page(word: str) -> Path:
    """Return the path of a page with the marks, seen before anything is tried."""
    path = Path(word)
    try:
        lacking = lacks_marks(path.read_text("utf-8"))
    except (OSError, UnicodeDecodeError) as error:
        raise ArgumentTypeError(f"{word}: cannot be read: {error}") from error
    if lacking:
        raise ArgumentTypeError(f"{word}: it needs one line {BEGIN}, and below it {END}")
    return path


def _publish(campaign: Campaign, page: Path, *, partial: bool) -> None:
    """Write the score into a page, unless only some designs were asked for."""
    if partial or {case.kind for case in campaign.cases} != {*MAKERS}:
        say(f"{page}: not changed; only designs of all kinds, without --quick, are published")
        return
    day = datetime.now(UTC).date()
    score = Score(campaign=campaign, version=__version__, commit=commit(), day=day)
    publish(page, score.block())
    say(f"{page}: score written")


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
    from gearcam.export.write import writing

    first = next(iter(found.files))
    words = visible(" ".join(found.failure.words.split()))  # no control characters in comments
    head = f"# {found.failure.kind}: {words}\n# {found.case.command}\n"
    contents = {
        name: ((head if name == first else "") + text).encode()
        for name, text in found.files.items()
    }
    with writing(folder) as replace:
        replace(contents)
    return folder / first
