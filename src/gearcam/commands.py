"""What a command is, and the commands of studies."""

from __future__ import annotations

import argparse
from collections.abc import Callable, Mapping
from dataclasses import dataclass
from functools import partial
from typing import Any

from gearcam.base.errors import DesignError, Problem
from gearcam.designs.design import Design
from gearcam.results.kind import KINDS, Kind, Study


@dataclass(frozen=True)
class Command:
    """A command.

    Parameters
    ----------
    name : str
        Name on the command line.
    doc : str
        One line of help: what it does and which files it writes.
    run : callable
        ``run(options)`` does the work, prints the outcome and returns the exit code.
    arguments : callable
        ``arguments(parser)`` adds its files and options to a parser.
    """

    name: str
    doc: str
    run: Callable[[Mapping[str, Any]], int]
    arguments: Callable[[argparse.ArgumentParser], None] = lambda _: None


def study_arguments(study: Study, kind: Kind, parser: argparse.ArgumentParser) -> None:
    """Add the options of a study's command: one for each key of its settings, which it overrides.

    Parameters
    ----------
    study : Study
        The study.
    kind : Kind
        A kind of design that has it.
    parser : ArgumentParser
        Receives the options.
    """
    for key, entry in kind.table(study.table).entries.items():
        words: dict[str, Any] = {"help": entry.param.doc}
        if key == study.argument:
            parser.add_argument(key, metavar=study.metavar or key.upper(), **words)
            continue
        unit = entry.param.quantity.unit.upper()
        if entry.length is not None:
            example = "1,27,..." if entry.base is int else "A,B,..."
            words |= {"type": partial(_list, entry.base), "metavar": example}
        else:
            words |= {"type": entry.base, "metavar": unit or ("N" if entry.base is int else "KEY")}
        name = study.options.get(key, key.removesuffix("_deg"))
        parser.add_argument(f"--{name}", dest=key, **words)


def _list(base: type, text: str) -> list[Any]:
    try:
        return [base(word.strip()) for word in text.split(",") if word.strip()]
    except ValueError:
        raise argparse.ArgumentTypeError(f'"{text}" is not a list such as 1,27') from None


def studied(study: Study, design: Design, options: Mapping[str, Any]) -> Any:
    """Return the design of a study's command, with the given settings.

    Parameters
    ----------
    study : Study
        The study.
    design : Design
        The design read from a file.
    options : mapping of str to value
        Settings by key; None where not given.

    Returns
    -------
    Design
        Of the same kind.

    Raises
    ------
    DesignError
        If designs of this kind have no such study, or a value is not allowed.
    """
    kinds = [kind.name for kind in KINDS.values() if study.name in kind.studies]
    if design.kind not in kinds:
        message = f"this command is for designs of kind {' or '.join(kinds)}"
        raise DesignError([Problem(message, file=design.source, key="kind", value=design.kind)])
    given = {f"{study.table}.{key}": one for key, one in options.items() if one is not None}
    changed = design.with_(given) if given else design
    study.demand(changed)
    return changed
