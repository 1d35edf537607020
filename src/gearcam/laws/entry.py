"""What all laws share: registry entries, what they cite, and the variable of their formulas."""

from __future__ import annotations

from collections.abc import Callable, Iterable, Mapping
from dataclasses import dataclass
from typing import Any, Final

from gearcam.base.display import ShortRepr

TYPED: Final = 1e-9
"""Error, in rad or relative, of a number typed with few digits: it is corrected silently."""

NO_JUMPS: Final = "a change within a few arc seconds counts as a jump"
"""Note in messages about functions that are not smooth but may only be steep."""


VARIABLE: Final = "phi1"
"""Name of the angle of the driver, rad, in formulas."""

Function = Callable[[Any], Any]
"""A Python function of a float array or a float; it returns as many values."""

Functions = Function | tuple[Function, ...]
"""A function, or a tuple of a function and its first derivatives in order."""


@dataclass(frozen=True, kw_only=True)
class Axis(ShortRepr):
    """The variable and the interval of a formula.

    Parameters
    ----------
    name : str
        Name of the values, such as ``phi2``.
    low, high : float
        The interval.
    place : callable
        ``place(x)`` returns a place as text for messages.
    variable : str
        Name of the variable in formulas.
    remedy : str
        Alternative to a function that is not smooth, for messages.
    series : bool
        Whether long Taylor series are needed, which only harmonics give accurately.
    """

    name: str
    low: float = 0.0
    high: float
    place: Callable[[float], str]
    variable: str = VARIABLE
    remedy: str = ""
    series: bool = False


@dataclass(frozen=True, kw_only=True)
class LawEntry:
    """A law in a registry.

    Parameters
    ----------
    name : str
        Name in design files.
    example : object
        Example parameters of the law: a dataclass with a ``build`` method.
    doc, continuity, source : str
        Description, order of continuity and citation, one line each.
    """

    name: str
    example: Any
    doc: str
    continuity: str
    source: str

    @property
    def parameters(self) -> type[Any]:
        """The class of the parameters."""
        return type(self.example)


SOURCES: Final[Mapping[str, str]] = {
    "de Boor": "C. de Boor: A Practical Guide to Splines. Springer, New York, 1978",
    "Duca, Buium, Paraoaru": "C. D. Duca, Fl. Buium, G. Paraoaru: Mecanisme (Mechanisms; in "
    'Romanian). Textbook, "Gh. Asachi" Technical University, Iasi, 2003',
    "Litvin, Fuentes": "F. L. Litvin, A. Fuentes: Gear Geometry and Applied Theory, 2nd edition. "
    "Cambridge University Press, 2004",
    "Neklutin": "C. N. Neklutin: Mechanisms and Cams for Automatic Machines. American Elsevier, "
    "New York, 1969",
    "Niculescu": "M. Niculescu: Cercetari privind proiectarea si generarea angrenajelor "
    "necirculare cu aplicabilitate in industria metalurgica (Design and generation of "
    "non-circular gears for the metallurgical industry; in Romanian). Summary of the doctoral "
    'thesis, "Dunarea de Jos" University, Galati, 2017',
    "Norton": "R. L. Norton: Cam Design and Manufacturing Handbook, 2nd edition. Industrial Press, "
    "New York, 2009",
}
"""Author, title, place and year, by what citations begin with: ``Norton`` in ``Norton, ch. 3``."""


def cited(entries: Iterable[LawEntry]) -> dict[type, str]:
    """Return where laws come from, by the classes of their parameters: citation, then titles."""
    return {
        one.parameters: "\n".join(
            [one.source, *(text for name, text in SOURCES.items() if name in one.source)]
        )
        for one in entries
    }
