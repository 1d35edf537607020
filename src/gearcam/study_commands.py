"""Commands of studies: their options from the keys of their settings, and how they are run."""

from __future__ import annotations

import argparse
from collections.abc import Mapping, Sequence
from functools import partial
from typing import Any

from gearcam.base.errors import DesignError, Problem
from gearcam.base.kinds import kind_names, kind_studies
from gearcam.base.quantities import FILE_KEYS, unit_of
from gearcam.commands import Options, add_output, add_summary, each_result, suggest
from gearcam.designs import Design, load
from gearcam.designs.kind import as_written
from gearcam.designs.reader import STDIN
from gearcam.results.kind import KINDS, Kind
from gearcam.results.studies import Study


def add_options(study: Study, parser: argparse.ArgumentParser) -> None:
    """Add the arguments of the command of a study.

    Parameters
    ----------
    study : Study
        The study: each of its settings is an option, of every kind of design that has it.
    parser : ArgumentParser
        What they are added to.
    """
    kinds = _kinds_with(study)
    if study.parallel:
        words = "number of processes of the random assemblies (default: 1)"
        parser.add_argument("--jobs", type=int, metavar="N", help=words)
    number = "+" if study.many else None
    words = f"design file (TOML); {STDIN} is the standard input"
    parser.add_argument("designs", nargs=number, metavar="FILE", help=words)
    add_output(parser)
    add_summary(parser)
    for kind in kinds:
        kind.titles_with([study.table])  # it may be of another package
    told, taken = _told(study.table, kinds), set[str]()
    for kind in kinds:
        _add_settings(kind.studies[study.name], kind, parser, told, taken)


def _kinds_with(study: Study) -> list[Kind]:
    """Return the kinds of design that have a `study`; the first one if it is alike in all."""
    every = {name: kind_studies(name) for name in kind_names()}
    having = [name for name, studies in every.items() if study.name in studies.own]
    having = having or [name for name, studies in every.items() if study.name in studies]
    return [KINDS[name] for name in (having[:1] if study.alike else having)]


def run(study: Study, options: Options) -> int:
    """Run the command of a study.

    Parameters
    ----------
    study : Study
        The study.
    options : mapping of str to value
        Its arguments by name.

    Returns
    -------
    int
        The exit code.
    """
    settings = dict(options)
    files = settings.pop("designs")
    output, debug, as_json = (settings.pop(name) for name in ("output", "debug", "json"))
    del settings["quiet"]
    jobs = settings.pop("jobs", None) or 1
    return each_result(
        files if study.many else [files],
        lambda file: studied(study, load(file), settings),
        study.done,
        lambda result, progress: result.study(study.name, progress, jobs=jobs).write(output),
        debug=debug,
        as_json=as_json,
    )


def _told(table: str, kinds: Sequence[Kind]) -> dict[str, str]:
    """Return what each key of a table means, and of which kinds where not of all alike."""
    meant: dict[str, dict[str, list[str]]] = {}
    for kind in kinds:
        for key, entry in kind.table(table).entries.items():
            meant.setdefault(key, {}).setdefault(entry.param.doc, []).append(kind.name)
    return {
        key: "; ".join(
            doc if len(names) == len(kinds) else f"{' or '.join(names)}: {doc}"
            for doc, names in docs.items()
        )
        for key, docs in meant.items()
    }


def _add_settings(
    study: Study,
    kind: Kind,
    parser: argparse.ArgumentParser,
    told: Mapping[str, str],
    taken: set[str],
) -> None:
    """Add an option for each key of a study's settings, which it overrides, to a `parser`.

    Each is `told` as it is; those that are `taken` it has already, of another kind.
    """
    for key, entry in kind.table(study.table).entries.items():
        if key in taken:
            continue
        taken.add(key)
        words: dict[str, Any] = {"help": told[key]}
        if key == study.argument:
            parser.add_argument(key, metavar=study.metavar or key.upper(), **words)
            continue
        unit = entry.param.quantity.unit.upper()
        if entry.length is not None:
            example = "1,27,..." if entry.base is int else "A,B,..."
            read = partial(_list, entry.base, both=entry.param.both)
            words |= {"type": read, "metavar": example}
        elif entry.base is bool:
            words |= {"action": "store_true", "default": None}
        else:
            name = "FILE" if key in FILE_KEYS else "N" if entry.base is int else "KEY"
            words |= {"type": entry.base, "metavar": unit or name}
        plain = key.removesuffix(entry.param.quantity.suffix).replace("_", "-")
        name = study.options.get(key, plain)
        action = parser.add_argument(f"--{name}", dest=key, **words)
        if choices := entry.param.choices:
            suggest(action, partial(map, str, choices))
    for name, key in study.elsewhere.items():
        if name in taken:
            continue
        taken.add(name)
        unit = unit_of(key).upper()
        words = {"type": float, "metavar": unit, "help": f"another {key}"}
        parser.add_argument(f"--{name}", dest=f"--{name}", **words)


def _list(base: type, text: str, *, both: bool) -> Any:
    """Return the numbers of a list; a single number alone if it may stand for both wheels."""
    try:
        numbers = [base(word.strip()) for word in text.split(",") if word.strip()]
    except ValueError:
        raise argparse.ArgumentTypeError(f'"{text}" is not a list such as 1,27') from None
    return numbers[0] if both and len(numbers) == 1 else numbers


def studied(study: Study, design: Design, options: Options) -> Any:
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
    known = KINDS[design.kind].studies
    if study.name not in known:
        kinds = [kind for kind in KINDS.values() if study.name in kind.studies]
        own = as_written(KINDS[design.kind])
        message = f"this command is for designs of {' or '.join(map(as_written, kinds))}"
        message += f", not for {own}" if " with " in own else ""
        raise DesignError([Problem(message, file=design.source, key="kind", value=design.kind)])
    own = known[study.name].elsewhere
    given = {key: one for key, one in options.items() if one is not None}
    settings = {own.get(key[2:], f"{study.table}.{key}"): one for key, one in given.items()}
    changed = design.with_(settings) if settings else design
    known[study.name].demand(changed)
    return changed
