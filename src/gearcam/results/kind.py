"""A kind of design and everything that it does: one object, in the module ``kind`` of its folder.

A kind must have how its designs are read (`gearcam.designs.kind.DesignKind`) and their result; all
else is optional. What is only needed at times is given by its place (`gearcam.base.registry`), so
that a build imports only what it needs.
"""

from __future__ import annotations

from collections.abc import Callable, Mapping
from dataclasses import dataclass, field
from typing import TYPE_CHECKING, Any, Final, cast

from gearcam.base.brought import group_of
from gearcam.base.facts import Facts
from gearcam.base.registry import ExtensibleMapping, deferred
from gearcam.designs import kind as reading
from gearcam.designs.kind import DesignKind

if TYPE_CHECKING:
    from gearcam.designs.design import Design
    from gearcam.pictures.charts import Chart
    from gearcam.pictures.scenes import Scene

Files = dict[str, bytes]
"""Contents by file name."""

FileMaker = Callable[[Any, dict[str, Any]], Files]
"""``maker(result, measured)`` returns contents by file name, and adds groups of facts measured on
them to `measured`. Paragraphs of its docstring list the names of the files (``Files: ...``) and say
what they hold."""

ChartMaker = Callable[[Any], "Chart | None"]
"""``maker(result)`` returns a chart, or None if there is nothing to show."""


def _anything(_: Design) -> None:
    """Allow all settings; a function of the module, so that studies can be pickled."""


_PLAIN_ADVICE: Final = deferred("gearcam.results.advice:Advice")


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
    settings: type | None = None

    def __repr__(self) -> str:
        return f'<Study "{self.name}">'


def studies_of(kind: str, *studies: Study) -> ExtensibleMapping[Study]:
    """Return the studies of a `kind` of design by name, to which packages may add."""
    return ExtensibleMapping({one.name: one for one in studies}, group_of(kind, "studies"))


@dataclass(frozen=True, eq=False, repr=False, kw_only=True)
class Kind(DesignKind):
    """A kind of design with all that it does (the other parameters are those of `DesignKind`).

    Parameters
    ----------
    facts : callable
        ``facts(result)`` returns its facts.
    files : mapping of str to FileMaker
        What makes the files of each format, by the names in `formats`.
    charts : mapping of str to ChartMaker
        Charts by name; the report leads with the first three.
    scene : callable
        ``scene(result, places)`` returns the moving parts at so many positions of the driver.
    advice : callable
        ``advice()`` returns how remedies are searched for (see `gearcam.results.advice.Advice`).
    studies : mapping of str to Study
        Studies by name; each is a command, too.
    ladders : mapping of str to callable
        Stages at increasing resolution (see `gearcam.results.ladders`).
    public : mapping of str to type
        Classes for designs written in Python, by name.
    cut : bool
        Whether its files hold parts to cut; those of others are not said to be ready for that.
    """

    facts: Callable[[Any], Facts] = lambda _: Facts({})
    files: Mapping[str, FileMaker] = field(default_factory=dict)
    charts: Mapping[str, ChartMaker] = field(default_factory=dict)
    scene: Callable[[Any, int], Scene | None] = lambda *_: None
    advice: Callable[[], Any] = _PLAIN_ADVICE
    studies: ExtensibleMapping[Study] = field(default_factory=ExtensibleMapping[Study])
    ladders: Mapping[str, Callable[[Any], Any]] = field(default_factory=dict)
    public: Mapping[str, type] = field(default_factory=dict)
    cut: bool = True

    def __reduce__(self) -> tuple[Any, ...]:
        return _named, (self.name,)


def _named(name: str) -> Kind:
    return KINDS[name]


KINDS: Final = cast("Mapping[str, Kind]", reading.KINDS)
"""The kinds by name, each imported when it is used."""


def kind_of(design: Design) -> Kind:
    """Return the kind of a `design`."""
    return KINDS[design.kind]
