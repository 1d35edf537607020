"""The command ``compare``."""

from __future__ import annotations

import argparse
from collections.abc import Sequence
from pathlib import Path

from gearcam.base.errors import InfeasibleError
from gearcam.compare.page import PAGE, document
from gearcam.compare.table import lines
from gearcam.compare.variants import MOST, settings_of, variants_of
from gearcam.console import infeasible_text, say
from gearcam.export.write import write_all
from gearcam.report.page import page


def arguments(parser: argparse.ArgumentParser) -> None:
    """Add the arguments of the command to a `parser`."""
    parser.add_argument("files", nargs="+", metavar="FILE", help="design files (TOML) of one kind")
    words = "compare these values of a key; when repeated, all combinations"
    words += f" (at most {MOST} variants)"
    given = {"dest": "settings", "metavar": "KEY=VALUE,...", "default": []}
    parser.add_argument("--set", action="append", help=words, **given)
    words = "list all facts by name and mark those that differ"
    parser.add_argument("--all", dest="every", action="store_true", help=words)


def compare(files: Sequence[str], settings: Sequence[str], output: str, *, every: bool) -> str:
    """Print how variants differ, and write a page that compares them.

    Parameters
    ----------
    files : sequence of str
        Design files of one kind.
    settings : sequence of str
        Settings as typed, such as ``pair.module_mm=2,3``.
    output : str
        The output folder.
    every : bool
        Whether to print all facts, not only those that differ.

    Returns
    -------
    str
        ``refused`` if a variant cannot be made, else the worst severity of a finding.

    Raises
    ------
    DesignError
        See `gearcam.compare.variants.variants_of`.
    WriteError
        If a file cannot be written.
    """
    variants = variants_of(files, settings_of(settings))
    for line in lines(variants, every=every):
        say(line)
    refused = [one for one in variants if one.refusal is not None]
    for one in refused:
        say(f"{one.label}: cannot be made")
        error = one.refusal
        say(infeasible_text(error) if isinstance(error, InfeasibleError) else f"  {error}")
    if len(refused) < len(variants):
        designs = dict.fromkeys(one.result.design.name for one in variants)
        title = ", ".join(designs) if len(designs) > 1 else f"{next(iter(designs))}, variants"
        made = page(document(variants, title))
        write_all(output, lambda _: {PAGE: made}, keep=True)
        say(f"written to {Path(output) / PAGE}")
    worst = {found.severity for one in variants if not one.refusal for found in one.result.findings}
    return "refused" if refused else next((s for s in ("error", "warning") if s in worst), "")
