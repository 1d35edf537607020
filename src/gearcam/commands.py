"""What a kind of design adds to the command line, and what commands share."""

from __future__ import annotations

import argparse
from collections.abc import Callable, Mapping
from dataclasses import dataclass
from typing import Any

from gearcam.designs.design import Design
from gearcam.errors import DesignError, Problem
from gearcam.result import Progress
from gearcam.written import Written


@dataclass(frozen=True, kw_only=True)
class Command:
    """A command on design files of one kind.

    Parameters
    ----------
    name : str
        As it is typed.
    done : str
        What has been done with a file then: ``meshed``.
    doc : str
        What it does, and what it writes.
    arguments : callable
        ``arguments(parser)`` adds its options to a parser.
    adapt : callable
        ``adapt(design, options)`` returns the design that it works on, or refuses another kind.
    run : callable
        ``run(result, output, options, progress)`` does the work and writes its files.
    many : bool
        Whether it takes several design files.
    """

    name: str
    done: str
    doc: str
    arguments: Callable[[argparse.ArgumentParser], None]
    adapt: Callable[[Design, Mapping[str, Any]], Design]
    run: Callable[[Any, str, Mapping[str, Any], Progress | None], Written]
    many: bool = True


def demand_new_name(design: Design, file: str, names: dict[str, str]) -> None:
    """Refuse a second design that would be written over the first one of the same call.

    Parameters
    ----------
    design : Design
        From a `file`.
    file : str
        Where it came from.
    names : dict of str to str
        Files by the names of their designs; that of this one is added.

    Raises
    ------
    DesignError
        If another file's design has the name.
    """
    before = names.setdefault(design.name.casefold(), file)
    if before != file:
        message = f'"{design.name}" is taken by {before} in this call'
        raise DesignError([Problem(message, file=file, key="name", value=design.name)])
