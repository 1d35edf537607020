"""A kind of design and everything that it does: one object, in the module `design` of its folder.

A kind must have how its designs are read (`gearcam.designs.kind.DesignKind`) and their result; all
else is optional. What is only needed at times is given by its place (`gearcam.base.registry`), so
that a build imports only what it needs.
"""

from __future__ import annotations

from collections.abc import Callable, Mapping
from dataclasses import dataclass, field
from typing import TYPE_CHECKING, Any, Final, cast

from gearcam.base.facts import Facts
from gearcam.base.registry import deferred
from gearcam.designs import kind as reading
from gearcam.designs.kind import DesignKind

if TYPE_CHECKING:
    from gearcam.designs.design import Design
    from gearcam.pictures.charts import Chart
    from gearcam.pictures.scenes import Scene
    from gearcam.sheets.sheet import Sheet

Files = dict[str, bytes]
"""Contents by file name."""

FileMaker = Callable[[Any, dict[str, Any]], Files]
"""``maker(result, measured)`` returns contents by file name, and adds groups of facts measured on
them to `measured`. Paragraphs of its docstring list the names of the files (``Files: ...``) and say
what they hold."""

ChartMaker = Callable[[Any], "Chart | None"]
"""``maker(result)`` returns a chart, or None if there is nothing to show."""


_PLAIN_ADVICE: Final = deferred("gearcam.results.advice:Advice")


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
    sheets : callable
        ``sheets(result)`` returns the workshop drawings of kinds that are not made of plates.
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
    sheets: Callable[[Any], tuple[Sheet, ...]] = lambda _: ()
    advice: Callable[[], Any] = _PLAIN_ADVICE
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
