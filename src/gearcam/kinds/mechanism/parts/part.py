"""What is asked of every part of a mechanism, and what a part may ask of the others.

A part is a table of the file, such as ``[[crank]]``, and one class: its keys, what it adds to the
linkage, what may be asked of it, how it is drawn, and how its refusals read.
"""

from __future__ import annotations

import math
from collections.abc import Iterator, Mapping
from typing import TYPE_CHECKING, Any

from gearcam.base.errors import InfeasibleError
from gearcam.base.numerals import formatted
from gearcam.kinds.mechanism.asked import Output
from gearcam.kinds.mechanism.keys import WithNames
from gearcam.kinds.mechanism.parts.setting import Setting

if TYPE_CHECKING:
    from gearcam.kinds.mechanism.parts.picture import Picture
    from gearcam.linkages.closing import NotClosingError
    from gearcam.linkages.coordinates import PointWay
    from gearcam.linkages.elements import Element
    from gearcam.linkages.linkage import Linkage

Tree = dict[str, Any]


class MachinePart(WithNames):
    """A part of a mechanism: the table of its file is the part.

    Its fields are its keys; those made by `gearcam.kinds.mechanism.keys.named` say what it gives
    and needs. All parts are asked by these methods, each of which has an answer for parts that it
    does not concern; `where` is the place of the table in the design, such as ``crank[0]``.
    """

    # --- the linkage -----------------------------------------------------------------------------

    def elements(self, setting: Setting, where: str) -> Iterator[Element]:
        """Yield what it adds to the linkage.

        Parameters
        ----------
        setting : Setting
            What it stands on.
        where : str
            Place of its table.

        Raises
        ------
        InfeasibleError
            If it does not suit what it stands on.
        """
        raise NotImplementedError

    def standing(self) -> Mapping[str, complex]:
        """Return where joints and shafts of it are that stand still, by name, mm."""
        return {}

    def period(self) -> int:
        """Return after how many turns of its shaft it is where it was, if others move with it."""
        return 1

    def demand(self, linkage: Linkage, where: str) -> None:
        """Refuse what it cannot do.

        Parameters
        ----------
        linkage : Linkage
            The whole, whose positions are not known yet.
        where : str
            Place of its table.

        Raises
        ------
        InfeasibleError
            If it cannot.
        """

    def chosen(self, element: Element, linkage: Linkage, q: float) -> Element:
        """Return one of its elements in the position that is asked for.

        Parameters
        ----------
        element : Element
            As `elements` made it.
        linkage : Linkage
            The whole.
        q : float, rad
            The master's angle there.
        """
        return element

    def refusal(self, error: NotClosingError, linkage: Linkage, where: str) -> InfeasibleError:
        """Return why one of its elements does not close over the master's whole range.

        Parameters
        ----------
        error : NotClosingError
            What the linkage tells.
        linkage : Linkage
            The whole.
        where : str
            Place of its table.
        """
        return InfeasibleError(not_closing(error), where=where)

    # --- what may be asked -----------------------------------------------------------------------

    def outputs(self) -> Mapping[str, tuple[Output, ...]]:
        """Return the quantities that its names stand for, but for joints and directions."""
        return {}

    def usual(self, *, last: bool) -> Iterator[tuple[int, str]]:
        """Yield what is given where a design does not say, with a rank: only the first is given.

        Parameters
        ----------
        last : bool
            Whether it is the last part of its sort.

        Yields
        ------
        int, str
            0: a slide or a point; 1: a direction; 2: another direction. The name of the output.
        """
        return ((0, name) for name, several in self.outputs().items() if len(several) == 1)

    def facts(self, result: Any, number: int) -> Iterator[tuple[str, str, Tree]]:
        """Yield facts about a machine: a group, a name in it, and the facts.

        Parameters
        ----------
        result : MechanismResult
            The mechanism.
        number : int
            Of the table, from 0.
        """
        return iter(())

    def called(self) -> str:
        """Return what it is in the headline; empty if that does not name it."""
        return ""

    # --- what acts on it -------------------------------------------------------------------------

    def ways(self) -> Mapping[str, PointWay]:
        """Return the ways along guides of what loads may push, by name."""
        return {}

    def unturned(self) -> Mapping[str, str]:
        """Return members that keep their direction, each with a joint that has its way."""
        return {}

    # --- pictures --------------------------------------------------------------------------------

    def sizes(self) -> tuple[float, ...]:
        """Return lengths of links, above 0, mm, which the widths of links suit."""
        return ()

    def traced(self) -> tuple[str, ...]:
        """Return points whose paths are drawn, whether they are asked for or not."""
        return ()

    def guided(self) -> Iterator[tuple[str, str]]:
        """Yield guides along which it slides, and the quantities that are its places on them."""
        return ((one.guide, one.slide) for one in self.ways().values())

    def draw(self, picture: Picture) -> None:
        """Draw what moves."""

    def stand(self, picture: Picture) -> None:
        """Draw what stands still: its guides and pivots."""


def not_closing(error: NotClosingError) -> str:
    """Return what does not close, and where it does, in words."""
    found = error.closing
    ranges = [[in_degrees(end) for end in one] for one in found.ranges]
    where = "it does from " + ", and from ".join(f"{a} to {b} deg" for a, b in ranges)
    if not ranges:
        where = "at no angle of the master"
    return f"{found.element.gives[0]} does not close over the whole range: {where}"


def in_degrees(angle: float) -> str:
    """Return an angle as text in degrees; what is left of 0 by rounding is 0."""
    found = math.degrees(angle)
    return formatted(0.0 if abs(found) < 1e-6 else found, 8)
