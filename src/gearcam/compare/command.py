"""The command ``compare``."""

from __future__ import annotations

import argparse
from collections.abc import Sequence
from pathlib import Path

from gearcam.base.errors import InfeasibleError
from gearcam.commands import FINDINGS, GOOD, IMPOSSIBLE, Options, add_output, each
from gearcam.compare.page import PAGE, document
from gearcam.compare.table import lines
from gearcam.compare.variants import MOST, Variant, settings_of, variants_of
from gearcam.console import infeasible_text, say
from gearcam.export.write import writing
from gearcam.report.page import page


def arguments(parser: argparse.ArgumentParser) -> None:
    """Add the arguments of the command to a `parser`."""
    add_output(parser)
    parser.add_argument("files", nargs="+", metavar="FILE", help="design files (TOML) of one kind")
    words = "compare these values of a key; when repeated, all combinations"
    words += f" (at most {MOST} variants)"
    given = {"dest": "settings", "metavar": "KEY=VALUE,...", "default": []}
    parser.add_argument("--set", action="append", help=words, **given)
    words = "list all facts by name and mark those that differ"
    parser.add_argument("--all", dest="every", action="store_true", help=words)


def compare(options: Options) -> int:
    """Print how variants differ, write a page that compares them, and return the exit code."""
    files = options["files"]

    def work(_: str) -> int:
        return _compare(variants_of(files, settings_of(options["settings"])), options)

    return each([" ".join(files)], "compared", work, debug=options["debug"])


def _compare(variants: Sequence[Variant], options: Options) -> int:
    for line in lines(variants, every=options["every"]):
        say(line)
    refused = [one for one in variants if one.refusal is not None]
    for one in refused:
        say(f"{one.label}: cannot be made")
        error = one.refusal
        say(infeasible_text(error) if isinstance(error, InfeasibleError) else f"  {error}")
    if len(refused) < len(variants):
        designs = dict.fromkeys(one.result.design.name for one in variants)
        title = ", ".join(designs) if len(designs) > 1 else f"{next(iter(designs))}, variants"
        content = page(document(variants, title))
        with writing(options["output"]) as replace:
            replace({PAGE: content})
        say(f"written to {Path(options['output']) / PAGE}")
    if refused:
        return IMPOSSIBLE
    findings = [finding for one in variants for finding in one.result.findings]
    return FINDINGS if any(one.severity == "error" for one in findings) else GOOD
