"""What a kind of design says of each of its studies, in ``STUDIES`` of its folder.

It imports neither the kind nor what the study computes: the help of the command line needs it.
"""

from __future__ import annotations

import textwrap
from collections.abc import Callable, Mapping
from dataclasses import dataclass, field
from typing import TYPE_CHECKING, Any

from gearcam.base.errors import DesignError

if TYPE_CHECKING:
    from gearcam.designs.design import Design


def _anything(_: Design) -> None:
    """Allow all settings; a function of the module, so that studies can be pickled."""


@dataclass(frozen=True, eq=False, repr=False, kw_only=True)
class Study:
    """A study: a further computation on a result, such as meshing.

    It has settings, a table of the design, and computes rows, facts, findings, charts and points
    for the moving picture. It runs by its command, from Python, or as a part of a design that names
    it in ``output.studies``: then summary, report, hash and `compare` include it.

    Parameters
    ----------
    name : str
        Name of its command, and in ``output.studies``.
    key : str
        Its key in ``summary.json``.
    doc : str
        One line of help: what it does and which files it writes.
    done : str
        Past participle for messages, such as ``meshed``.
    table : str
        Title of the table of its settings in a design; the command has an option for each key.
    compute : callable
        ``compute(result, progress)`` reports its progress and returns its outcome, a
        `StudyResult`; the settings are those of the design, but for those that a method of its
        results gives by name.
    options : mapping of str to str
        Names of options that differ from those of their keys.
    argument : str
        Key that is given on the command line without an option, after the design file.
    metavar : str
        What stands for it in the usage.
    demand : callable
        ``demand(design)`` refuses settings that the keys alone allow, before anything is built.
    elsewhere : mapping of str to str
        Further options, and the dotted keys of numbers of other tables that they override.
    alike : bool
        Whether its settings are the same in all kinds that have it.
    repeats : tuple of str
        Codes of findings of the design that the study gives anew.
    many : bool
        Whether its command takes several design files.
    parallel : bool
        Whether ``compute(result, progress, jobs)`` takes a number of processes.
    returns : str
        What rows, facts and charts its outcome has, in a sentence or two.
    example : str
        Lines of Python as typed, with ``>>>``, and their answers; profiles are beside.
    settings : type, optional
        The class of that table: of a study of another package, whose table has the study's name.
        Else a field of the design says it.
    """

    name: str
    key: str
    doc: str
    done: str
    table: str
    compute: Callable[..., Any]
    options: Mapping[str, str] = field(default_factory=dict)
    argument: str = ""
    metavar: str = ""
    demand: Callable[[Design], None] = _anything
    elsewhere: Mapping[str, str] = field(default_factory=dict)
    alike: bool = True
    repeats: tuple[str, ...] = ()
    many: bool = True
    parallel: bool = False
    returns: str = ""
    example: str = ""
    settings: type | None = None

    @property
    def help(self) -> str:
        """What it does, with which settings, what it returns, and an example."""
        words = [
            f"{self.name}: {self.doc}",
            f"Settings: the table [{self.table}] of the design (docs/reference/keys.md).",
            f"Returns: {self.returns}" if self.returns else "",
        ]
        lines = [one for text in words for one in textwrap.wrap(text, 92)]
        return "\n".join([*lines, "", *self.example.splitlines()])

    def processes(self, jobs: int) -> dict[str, int]:
        """Return the arguments of `compute` for a number of processes.

        Raises
        ------
        DesignError
            If it is not above 0, or the study takes one only.
        """
        if isinstance(jobs, bool) or not isinstance(jobs, int) or jobs < 1:
            raise DesignError.of(
                "is not a number of processes", key="jobs", value=jobs, allowed="1 or more"
            )
        if jobs > 1 and not self.parallel:
            message = f"the study {self.name} takes one process"
            raise DesignError.of(message, key="jobs", value=jobs, allowed="1")
        return {"jobs": jobs} if self.parallel else {}

    def __repr__(self) -> str:
        return f'<Study "{self.name}">'
